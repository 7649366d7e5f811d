"""A tilted quadcopter, which Procedure 2.b does not model: the errors of answers about its upright body.

A quadcopter flies ahead by tilting: its axis makes the angle `degrees` with the vertical, in the direction of the
movement. Its rotors tilt with it, in the plane through the body's centre perpendicular to the axis. When it goes up,
down or turns in place, it is upright. The sines and the rotors' places are rounded once, as for an upright quadcopter;
the resulting numbers are decided exactly. A spheroid lies within the ball of its longer semi-axis. If that ball is
interior, the spheroid is interior for every tilt; only other spheroids are decided with their axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import Position, Sizes
from hypcheck.geometry.rows import Columns, Floats, Mask
from hypcheck.kernel.classify import classify_scene
from hypcheck.paper.flights import Moves
from hypcheck.paper.motion import VerdictCounts, headed, of, or_all_four, positions
from hypcheck.paper.quadcopter import ROTORS, Craft, Direction, any_angle
from hypcheck.vectors.draw import Draw


def tilted_interior(sizes: Sizes, at: Columns, axis: Columns) -> Mask:
    """Return a mask of the interior spheroids, decided exactly, (n,); each has a centre and an axis."""
    alpha, gamma, b, d = sizes
    longest = max(b, d)
    inside = np.asarray(classify_scene((alpha, gamma, longest, longest), *at) == Position.INTERIOR)
    near = np.flatnonzero(~inside)
    inside[near] = positions(sizes, of(at, near), *of(axis, near)) == Position.INTERIOR
    return inside


@dataclass(frozen=True, slots=True)
class Tilt:
    """Quadcopters tilted by an angle with this cosine and sine towards horizontal directions; arrays (n,)."""

    toward: Direction
    cosine: float
    sine: float

    @classmethod
    def by(cls, degrees: float, toward: Direction) -> Tilt:
        """Return the tilt by `degrees` from the vertical."""
        cosine, sine = any_angle(np.array(degrees))
        return cls(toward, float(cosine), float(sine))

    @property
    def axis(self) -> Columns:
        """The axes of revolution."""
        return self.sine * self.toward[0], self.sine * self.toward[1], np.full_like(self.toward[0], self.cosine)

    def tilted(self, along: Floats, aside: Floats) -> Columns:
        """Return what horizontal vectors (along, aside) of the upright craft become when it tilts about its side.

        The part towards the tilt, (along, aside)·toward, is shortened by the cosine and goes down by the sine.
        """
        ahead, beside = self.toward
        forward, across = along * ahead + aside * beside, aside * ahead - along * beside
        shortened = forward * self.cosine
        return shortened * ahead - across * beside, shortened * beside + across * ahead, -self.sine * forward

    def of(self, indices: NDArray[np.int64]) -> Tilt:
        """Return the tilts at these indices."""
        return Tilt(headed(self.toward, indices), self.cosine, self.sine)


def valid_tilted(craft: Craft, at: Columns, heading: Direction, tilt: Tilt) -> tuple[Mask, Mask]:
    """Return masks of the valid positions, where the body or every rotor is interior, and of interior bodies."""

    def all_rotors(near: NDArray[np.int64]) -> Mask:
        arms, four = craft.arms(headed(heading, near)), tilt.of(np.tile(near, ROTORS))
        offsets = four.tilted(craft.arm * arms[0], craft.arm * arms[1])
        x, y, z = (np.tile(column, ROTORS) + offset for column, offset in zip(of(at, near), offsets, strict=True))
        return tilted_interior(craft.rotor, (x, y, z), four.axis)

    body = tilted_interior(craft.sizes, at, tilt.axis)
    return or_all_four(body, all_rotors), body


@dataclass(slots=True)
class PitchVerdicts(VerdictCounts):
    """Counts of answers at the ends of horizontal moves, compared with exact answers about the tilted craft.

    `moves` is the number of moves that Procedure 2.b tested, `wrong` the number of its wrong answers, `dangerous` the
    number of moves that it accepts although the tilted craft is not valid. `body_wrong` and `body_dangerous` are the
    same counts for only the body: an upright body is interior where a tilted one is not, or the reverse.
    """

    moves: int = 0
    wrong: int = 0
    dangerous: int = 0
    body_wrong: int = 0
    body_dangerous: int = 0

    def watch(self, craft: Craft, degrees: float, moves: Moves) -> None:
        """Count the results of a draw of many flights."""
        some = moves.tested[~moves.vertical[moves.tested]]
        (x, y, z), heading = of(moves.end, some), headed(moves.before, some)
        move = x - moves.start[0][some], y - moves.start[1][some]
        back = move[0] * heading[0] + move[1] * heading[1] < 0
        toward = np.where(back, -heading[0], heading[0]), np.where(back, -heading[1], heading[1])
        valid, body = valid_tilted(craft, (x, y, z), heading, Tilt.by(degrees, toward))
        upright = np.asarray(classify_scene(craft.sizes, x, y, z) == Position.INTERIOR)
        accepted = moves.accepted[some]
        self.moves += len(some)
        self._count("wrong", accepted != valid)
        self._count("dangerous", accepted & ~valid)
        self._count("body_wrong", upright != body)
        self._count("body_dangerous", upright & ~body)


CENTRES = 20_000
"""The number of tested centres near the wall."""

VERSION = 1
"""Version of the centres near the wall, raised whenever they are other ones."""


def near_wall(craft: Craft, degrees: float, seed: int, count: int = CENTRES) -> dict[str, Any]:
    """Count the body's positions near the wall that a tilt changes, a tilt in any direction and one radially outward.

    Heights are uniform over the tower's (from −γ to γ where it has no end), distances from the axis uniform within ±b
    of the wall's. A change is `dangerous` if the upright body is clear and the tilted one is not.
    """
    draw = Draw("tower-pitch", VERSION, seed)
    alpha, gamma, b, _ = craft.sizes
    low, high = (-gamma, gamma) if craft.height is None else (craft.height.low, craft.height.high)
    z = draw.between(count, low, high)
    x = alpha * np.sqrt(1 + (z / gamma) ** 2) + draw.between(count, -b, b)
    at = (x, np.zeros_like(x), z)
    upright = classify_scene(craft.sizes, *at)
    outward = np.ones_like(x), np.zeros_like(x)
    counts: dict[str, Any] = {"centres": count}
    for name, toward in (("anywhere", any_angle(draw.between(count, -180.0, 180.0))), ("outward", outward)):
        tilted = positions(craft.sizes, at, *Tilt.by(degrees, toward).axis)
        changed = upright != tilted
        counts[name] = {
            "changed": int(np.count_nonzero(changed)),
            "dangerous": int(np.count_nonzero(changed & (tilted == Position.CONTACT))),
        }
    return counts
