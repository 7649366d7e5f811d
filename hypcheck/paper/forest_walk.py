"""A walk among trees that obeys Procedure 1 in float32, as a game would, and the exact verdict on each of its steps.

Every step is asked about before it is made, at the position it leads to, of all trees that stand at that height. Steps
beyond the scene's region are refused without asking.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hypcheck.casebook.draw import Draw
from hypcheck.errors import InputError
from hypcheck.paper.flights_circle import any_angle, turned
from hypcheck.paper.forest_trees import Mask, Places, Procedure1, Trees
from hypcheck.scene.model import Region, Walk

VERSION = 1
"""Of the walk: raised whenever other words come to be drawn."""

CHUNK = 256
"""Steps judged at a time."""


@dataclass(frozen=True, slots=True)
class Steps:
    """The steps that were tried, in order: from `start` to `end`, (n, 3); `edge` and `refused` say which were not made.

    `refused` are those that Procedure 1 in float32 did not allow.
    """

    start: Places
    end: Places
    edge: Mask
    refused: Mask

    @property
    def made(self) -> Mask:
        """Which steps were made."""
        return ~(self.edge | self.refused)


@dataclass(frozen=True, slots=True)
class Verdicts:
    """What is true of the tried steps within the region, for each of them and each tree, (n, m).

    `asked`: the tree stands at that height, so its answer counts; `exterior`: exactly so; `line`: one line proves it;
    `single` and `double`: Table 2 in float32 and float64 allows the step; `repaired_single`, `repaired_double`:
    Procedure 1 put right does.
    """

    asked: Mask
    exterior: Mask
    line: Mask
    single: Mask
    double: Mask
    repaired_single: Mask
    repaired_double: Mask


def walk(
    trees: Trees, rules: Walk, region: Region, steps: int, seed: int, advance: Callable[[int], object] = lambda _: None
) -> Steps:
    """Try so many steps, telling `advance` of each. Raises InputError where the walk would begin outside the region."""
    if not bool(_inside(region, np.array([rules.start]))[0]):
        raise InputError(f"the walk starts at {list(rules.start)}, outside the scene's region")
    words = Draw("forest-walk", VERSION, seed).words(2 * steps).reshape(steps, 2)
    shares = (words[:, 0] >> np.uint64(11)).astype(np.float64) * 2.0**-53
    wander, recover = (2 * shares - 1) * rules.largest_turn, np.where(words[:, 1] & np.uint64(1) == 0, 1.0, -1.0)
    turns = any_angle(wander), any_angle(wander + recover * rules.refused_turn)
    procedure, heading = Procedure1(trees, "float32"), any_angle(np.array(rules.heading))
    start, end = np.empty((steps, 3)), np.empty((steps, 3))
    edge, refused = np.zeros(steps, dtype=np.bool_), np.zeros(steps, dtype=np.bool_)
    here, stopped = np.array(rules.start), False
    for step in range(steps):
        cosine, sine = turns[int(stopped)]
        heading = turned(heading, (cosine[step], sine[step]))
        start[step], end[step] = here, here + rules.step * np.array([*heading, 0.0])
        tried = end[step : step + 1]
        edge[step] = not _inside(region, tried)[0]
        refused[step] = not edge[step] and not (procedure.valid(tried) | ~trees.modelled(tried)).all()
        stopped = bool(edge[step] or refused[step])
        if not stopped:
            here = end[step]
        advance(1)
    return Steps(start, end, edge, refused)


def judged(trees: Trees, at: Places) -> Verdicts:
    """What is true of a walker at these places."""
    procedures = (
        Procedure1(trees, precision, repaired=repaired).valid
        for repaired in (False, True)
        for precision in ("float32", "float64")
    )
    parts = [at[place : place + CHUNK] for place in range(0, len(at), CHUNK)]
    none = np.empty((0, len(trees.sizes)), dtype=np.bool_)

    def of_all(ask: Callable[[Places], Mask]) -> Mask:
        return np.concatenate([none, *(ask(part) for part in parts)])

    return Verdicts(*map(of_all, (trees.modelled, trees.exterior, trees.proved_by_line, *procedures)))


def _inside(region: Region, at: Places) -> Mask:
    inside = np.ones(len(at), dtype=np.bool_)
    for column, span in zip(at.T, (region.x, region.y, region.z), strict=True):
        if span is not None:
            inside &= (column >= span.low) & (column <= span.high)
    return inside
