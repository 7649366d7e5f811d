"""What Procedure 2.b, whose body is always upright, gets wrong about a quadcopter that leans into its movement.

A quadcopter flies ahead by leaning: its axis makes the angle `degrees` with the vertical, towards where it goes. Its
rotors lean with it, in the plane through the body's centre perpendicular to the axis. Going up, down or turning in
place it is upright. The sines and the rotors' places are rounded once, as those of an upright quadcopter are; the
resulting numbers are decided exactly.

A spheroid lies within the ball of its longer semi-axis. Where that ball is interior, so is the spheroid, however it
leans; only the others are asked with their axes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import Position, Sizes
from hypcheck.geometry.rows import Columns, Floats, Mask, Positions
from hypcheck.kernel.classify import classify, classify_scene
from hypcheck.messages import counted
from hypcheck.paper.flights import Moves
from hypcheck.paper.quadcopter import ROTORS, Craft, Direction, any_angle
from hypcheck.vectors.draw import Draw

CENTRES = 20_000
"""How many centres near the wall are asked about."""

VERSION = 1
"""Of the centres near the wall."""

Indices = NDArray[np.int64]


def leaning_interior(sizes: Sizes, at: Columns, axis: Columns) -> Mask:
    """Which spheroids are interior, exactly, each at a centre and along an axis; (n,)."""
    alpha, gamma, b, d = sizes
    longest = max(b, d)
    inside = np.asarray(classify_scene((alpha, gamma, longest, longest), *at) == Position.INTERIOR)
    near = np.flatnonzero(~inside)
    inside[near] = _positions(sizes, _of(at, near), _of(axis, near)) == Position.INTERIOR
    return inside


def _positions(sizes: Sizes, at: Columns, axis: Columns) -> Positions:
    return classify(np.column_stack([np.tile(sizes, (len(at[0]), 1)), *at, *axis]))


def _of(point: Columns, those: Indices) -> Columns:
    x, y, z = point
    return x[those], y[those], z[those]


@dataclass(frozen=True, slots=True)
class Lean:
    """Quadcopters that lean by an angle with this cosine and sine towards horizontal directions; arrays (n,)."""

    toward: Direction
    cosine: float
    sine: float

    @classmethod
    def by(cls, degrees: float, toward: Direction) -> Lean:
        """Leaning by so many degrees from the vertical."""
        cosine, sine = any_angle(np.array(degrees))
        return cls(toward, float(cosine), float(sine))

    @property
    def axis(self) -> Columns:
        """The axes of revolution."""
        return self.sine * self.toward[0], self.sine * self.toward[1], np.full_like(self.toward[0], self.cosine)

    def tilted(self, along: Floats, aside: Floats) -> Columns:
        """Horizontal vectors (along, aside) of the upright craft, as they are once it leans: a rotation about its side.

        The part towards the lean, (along, aside)·toward, is shortened by the cosine and goes down by the sine.
        """
        ahead, beside = self.toward
        forward, across = along * ahead + aside * beside, aside * ahead - along * beside
        shortened = forward * self.cosine
        return shortened * ahead - across * beside, shortened * beside + across * ahead, -self.sine * forward

    def of(self, those: Indices) -> Lean:
        """Some of them."""
        return Lean((self.toward[0][those], self.toward[1][those]), self.cosine, self.sine)


def valid_leaning(craft: Craft, at: Columns, heading: Direction, lean: Lean) -> tuple[Mask, Mask]:
    """Which positions are valid, the body interior or every rotor, and where the body alone is interior."""
    body = leaning_interior(craft.sizes, at, lean.axis)
    valid = body.copy()
    near = np.flatnonzero(~body)
    arms = craft.arms((heading[0][near], heading[1][near]))
    four = lean.of(np.tile(near, ROTORS))
    ways = four.tilted(craft.arm * arms[0], craft.arm * arms[1])
    x, y, z = (np.tile(column, ROTORS) + way for column, way in zip(_of(at, near), ways, strict=True))
    rotors = leaning_interior(craft.rotor, (x, y, z), four.axis)
    valid[near] = rotors.reshape(ROTORS, -1).all(axis=0)
    return valid, body


@dataclass(slots=True)
class PitchVerdicts:
    """Answers about horizontal moves, each at the move's end, against the exact ones about the craft that leans.

    Of the `moves` that Procedure 2.b was asked about, its answer is `wrong` about so many; it is `dangerous` where it
    accepts and the craft that leans is not valid. `body_wrong` and `body_dangerous` are the same for the body alone:
    an upright body is interior where one that leans is not, or the other way round.
    """

    moves: int = 0
    wrong: int = 0
    dangerous: int = 0
    body_wrong: int = 0
    body_dangerous: int = 0

    def add(self, other: PitchVerdicts) -> None:
        """Count what another has counted as well."""
        for each in fields(self):
            setattr(self, each.name, getattr(self, each.name) + getattr(other, each.name))

    def watch(self, craft: Craft, degrees: float, moves: Moves) -> None:
        """Count what a draw of many flights came to."""
        some = np.flatnonzero((moves.accepted | moves.refused) & ~moves.turning & ~moves.vertical)
        x, y, z = (column[some] for column in moves.end)
        heading = moves.before[0][some], moves.before[1][some]
        way = x - moves.start[0][some], y - moves.start[1][some]
        back = way[0] * heading[0] + way[1] * heading[1] < 0
        toward = np.where(back, -heading[0], heading[0]), np.where(back, -heading[1], heading[1])
        valid, body = valid_leaning(craft, (x, y, z), heading, Lean.by(degrees, toward))
        upright = np.asarray(classify_scene(craft.sizes, x, y, z) == Position.INTERIOR)
        accepted = moves.accepted[some]
        self.moves += len(some)
        self.wrong += int(np.count_nonzero(accepted != valid))
        self.dangerous += int(np.count_nonzero(accepted & ~valid))
        self.body_wrong += int(np.count_nonzero(upright != body))
        self.body_dangerous += int(np.count_nonzero(upright & ~body))


def near_wall(craft: Craft, degrees: float, seed: int) -> dict[str, Any]:
    """How many positions of the body change near the wall as it leans: anywhere, and along the radius, outwards.

    Heights are uniform over the tower's (from −γ to γ where it has no end), distances from the axis uniform within ±b
    of the wall's. A change is `dangerous` where the upright body is clear and the one that leans is not.
    """
    draw = Draw("tower-pitch", VERSION, seed)
    alpha, gamma, b, _ = craft.sizes
    low, high = (-gamma, gamma) if craft.height is None else (craft.height.low, craft.height.high)
    z = draw.between(CENTRES, low, high)
    x = alpha * np.sqrt(1 + (z / gamma) ** 2) + draw.between(CENTRES, -b, b)
    at = (x, np.zeros_like(x), z)
    upright = classify_scene(craft.sizes, *at)
    outward = np.ones_like(x), np.zeros_like(x)
    found: dict[str, Any] = {"centres": CENTRES}
    for name, toward in (("anywhere", any_angle(draw.between(CENTRES, -180.0, 180.0))), ("outward", outward)):
        leaning = _positions(craft.sizes, at, Lean.by(degrees, toward).axis)
        changed = upright != leaning
        found[name] = {
            "changed": int(np.count_nonzero(changed)),
            "dangerous": int(np.count_nonzero(changed & (leaning == Position.CONTACT))),
        }
    return found


def pitch_lines(lean: dict[str, Any]) -> Iterator[str]:
    """The result in words."""
    yield f"Leaning by {lean['degrees']:g} degrees into each movement ahead or back, which Procedure 2.b does not know:"
    total, moves = lean["total"], lean["total"]["moves"]
    for name, what, refused in (
        ("", "its answer is wrong about", "needlessly refused"),
        ("body_", "the body alone is judged wrongly for", "clear only as it leans"),
    ):
        wrong, dangerous = total[f"{name}wrong"], total[f"{name}dangerous"]
        yield f"  of {counted(moves, 'horizontal move')} {what} {wrong:,}{_share(wrong, moves)}:"
        yield f"    {dangerous:,} dangerous, clear only upright; {wrong - dangerous:,} {refused}"
    near = lean["near_wall"]
    yield f"  of {counted(near['centres'], 'centre')} within b of the wall the body's position is another"
    for name, what in (("anywhere", "leaning anywhere"), ("outward", "leaning along the radius, outwards")):
        changed, dangerous = near[name]["changed"], near[name]["dangerous"]
        yield f"    for {changed:,}{_share(changed, near['centres'])}, {what}; {dangerous:,} of these are dangerous"


def _share(part: int, whole: int) -> str:
    return f" ({100 * part / whole:.3f} %)" if whole else ""
