"""The paper's Figure 4: flights of 25 positions inside the tower, and Δ along them."""

from __future__ import annotations

from typing import Any

import numpy as np

from hypcheck.casebook.draw import Draw
from hypcheck.paper.flights import VERSION, Moves, fly
from hypcheck.paper.flights_craft import Craft, Point, Procedures
from hypcheck.paper.flights_ways import Ways
from hypcheck.scene.model import Flight

FLIGHTS = 3
POSITIONS = 25


def paths(craft: Craft, flight: Flight, step: float, seed: int) -> tuple[list[dict[str, Any]], Ways]:
    """Three flights of 25 positions each, from the tower's centre, as JSON has them; and exact verdicts on their ways.

    Each has `positions` [x, y, z], `discriminant` (equation (13) at each of them), and how many `executions`, of these
    `touching` (Δ ≤ 0), of the movements `refused`, and draws to `outside_height`.
    """
    tracks: list[list[tuple[float, ...]]] = [[] for _ in range(FLIGHTS)]
    ways = Ways()

    def observe(moves: Moves) -> None:
        ways.watch(craft, moves)
        for place, lane in enumerate(moves.lane.tolist()):
            track = tracks[lane]
            for point, there in ((moves.start, not track), (moves.end, bool(moves.accepted[place]))):
                if there:
                    track.append(tuple(float(column[place]) for column in point))

    draw = Draw("tower-path", VERSION, seed, step)
    tallies = fly(craft, flight, step, POSITIONS - 1, draw, FLIGHTS, observe)
    procedures = Procedures(craft)
    return [
        {
            "positions": [list(position) for position in track],
            "discriminant": procedures.discriminant(_columns(track)).tolist(),
            "executions": int(tallies.executions[lane]),
            "touching": int(tallies.touching[lane]),
            "refused": int(tallies.refused[lane]),
            "outside_height": int(tallies.redrawn[lane]),
        }
        for lane, track in enumerate(tracks)
    ], ways


def _columns(track: list[tuple[float, ...]]) -> Point:
    x, y, z = np.array(track).T
    return x, y, z
