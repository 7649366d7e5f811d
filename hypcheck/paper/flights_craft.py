"""The quadcopter of a scene as Procedures 2.a and 2.b have it: a body, four equal rotors, one sine and cosine for all.

The paper's section 3.2 puts rotor i at the angle g_i = g1 + (i − 1) π/2 and, by equation (15), an eighth of a turn on.
So a part's `angle` is g_i − heading + 45°, and with (T1, T2) of g1 the four rotors need no more (rotor_listings.py).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hypcheck.casebook.draw import Floats
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.hoisting import loop_body
from hypcheck.derivation.repaired_formulas import REPAIRED
from hypcheck.errors import InputError
from hypcheck.paper.flights_circle import Direction, any_angle, turned
from hypcheck.scene.model import Hyperboloid, Part, Scene, Span

Mask = NDArray[np.bool_]
Point = tuple[Floats, Floats, Floats]

SHORTEST, LONGEST = 1e-6, 1e6
"""Lengths of bodies: Δ, of degree 12 in their ratios, is far from overflow then."""

FARTHEST = 1e12
"""Coordinates of places, whose squares and fourth powers occur."""

ROTORS = 4
_FORMAT = "float64"


@dataclass(frozen=True, slots=True)
class Craft:
    """A quadcopter in a tower; positions are counted from the tower's centre.

    `sizes` are α, γ, b, d of the body, `rotor` α, γ, b_s, d_s of a rotor, `arm` is l, `height` the tower's, and
    `ahead` the angle from the heading to g1, in degrees.
    """

    sizes: tuple[float, float, float, float]
    rotor: tuple[float, float, float, float]
    arm: float
    ahead: float
    height: Span | None

    def rotors(self, at: Point, heading: Direction) -> Point:
        """The centres of all first rotors, then of all second ones, and so on, by equation (15); (4 n,) each."""
        x, y, z = (np.tile(column, ROTORS) for column in at)
        cosine, sine = self.arms(heading)
        return x + self.arm * cosine, y + self.arm * sine, z

    def arms(self, heading: Direction) -> Direction:
        """The directions of the arms, (√2/2) (T1(g_i), T2(g_i)), in the order of `rotors`."""
        cosine, sine = turned(heading, self.offset)
        half = np.sqrt(2.0) / 2
        along, aside = half * (cosine - sine), half * (cosine + sine)
        return np.concatenate([along, -aside, -along, aside]), np.concatenate([aside, along, -aside, -along])

    @property
    def offset(self) -> Direction:
        """The cosine and the sine of g1 − heading."""
        return any_angle(np.array(self.ahead))


class Procedures:
    """Procedures 2.a and 2.b in float64, as printed or `repaired`, with what the sizes decide taken out of the loop."""

    def __init__(self, craft: Craft, *, repaired: bool = False) -> None:
        arithmetic = float_arithmetic(_FORMAT)
        alpha, gamma, b, d = craft.sizes
        _, _, small_b, small_d = craft.rotor
        body = {"alpha": alpha, "gamma": gamma, "b": b, "d": d}
        rotor = {"alpha": alpha, "gamma": gamma, "b_s": small_b, "d_s": small_d, "l": craft.arm}
        known, end = (REPAIRED, "-repaired") if repaired else (FORMULAS, "")
        hull, small = known[f"procedure-2b{end}"].program, known[f"procedure-2a{end}"].program
        self._offset = craft.offset
        self._body = loop_body(hull, arithmetic, body, ("delta", "unclear" if repaired else "touching", "inside"))
        self._rotors = loop_body(small, arithmetic, rotor, ("valid",))

    def discriminant(self, at: Point) -> Floats:
        """Δ of the body's cubic, equation (13)."""
        return np.asarray(self._body(dict(zip("xyz", at, strict=True)))[0])

    def ask(self, at: Point, heading: Direction) -> tuple[Mask, Mask]:
        """Procedure 2.b: whether a position is a valid one, and whether the rotors were asked, as printed for Δ ≤ 0."""
        _, asked, valid = self._body(dict(zip("xyz", at, strict=True)))
        if asked.any():
            some = np.flatnonzero(asked)
            x, y, z = (column[some] for column in at)
            valid[some] = self.ask_rotors((x, y, z), (heading[0][some], heading[1][some]))
        return valid, asked

    def ask_rotors(self, at: Point, heading: Direction) -> Mask:
        """Procedure 2.a: whether all four rotors are found to be interior."""
        cosine, sine = turned(heading, self._offset)
        (valid,) = self._rotors({**dict(zip("xyz", at, strict=True)), "cosine": cosine, "sine": sine})
        return np.asarray(valid)


def craft_of(scene: Scene) -> Craft:
    """The quadcopter of a scene. Raises InputError where Procedures 2.a and 2.b are not about such a scene."""
    if len(scene.hyperboloids) != 1:
        raise InputError(f"the scene {scene.name!r} has {len(scene.hyperboloids)} hyperboloids; a tower is one alone")
    (tower,) = scene.hyperboloids
    require_ordinary(scene)
    _require_regime(scene, tower)
    first = _first_of_four(scene)
    return Craft(
        sizes=(tower.alpha, tower.gamma, scene.mover.b, scene.mover.d),
        rotor=(tower.alpha, tower.gamma, first.b, first.d),
        arm=first.arm,
        ahead=first.angle - 45,
        height=tower.height,
    )


def require_ordinary(scene: Scene) -> None:
    """Raise InputError where lengths are so long or short, or places so far, that what is printed overflows."""
    for body in (*scene.hyperboloids, scene.mover, *scene.mover.parts):
        for name in ("alpha", "gamma", "b", "d"):
            length = getattr(body, name, 1.0)
            if not SHORTEST <= length <= LONGEST:
                raise InputError(
                    f"the scene {scene.name!r}: {name} is {length!r}; a simulation takes lengths from {SHORTEST:g} "
                    f"to {LONGEST:g}"
                )

    for what, value in _places(scene):
        if abs(value) > FARTHEST:
            raise InputError(
                f"the scene {scene.name!r}: {what} is at {value!r}; a simulation takes places as far as {FARTHEST:g}"
            )


def _places(scene: Scene) -> Iterator[tuple[str, float]]:
    """Every coordinate that a simulation begins with or is bounded by, and what is there."""
    for body in scene.hyperboloids:
        yield from ((f"the centre of {body.name!r}", value) for value in body.center)
        yield from _ends(f"the height of {body.name!r}", body.height)
    for span in (scene.region.x, scene.region.y, scene.region.z):
        yield from _ends("the region", span)
    if scene.flight is not None:
        start = scene.flight.start
        yield from _ends("the flights' start", start.z)
        yield "the flights' start", start.radius or start.margin or 0.0
    if scene.walk is not None:
        yield from (("the walk's start", value) for value in scene.walk.start)


def _ends(what: str, span: Span | None) -> Iterator[tuple[str, float]]:
    if span is not None:
        yield from ((what, value) for value in (span.low, span.high))


def _require_regime(scene: Scene, tower: Hyperboloid) -> None:
    if tower.alpha < scene.mover.b:
        raise InputError(
            f"the scene {scene.name!r}: alpha = {tower.alpha!r} is less than the mover's b = {scene.mover.b!r}; "
            "Procedures 2.a and 2.b ask for alpha/b >= 1 (Proposition 5)"
        )


def _first_of_four(scene: Scene) -> Part:
    """The first rotor; raises InputError unless there are four, equal, and each a quarter of a turn from the last."""
    parts = scene.mover.parts
    if len(parts) != ROTORS or not _equal(parts) or not _quarters(parts):
        raise InputError(
            f"the scene {scene.name!r}: equations (15) to (21) are of four equal rotors; the mover must have four "
            "parts of the same b, d and arm, each 90 degrees from the one before"
        )
    return parts[0]


def _equal(parts: Sequence[Part]) -> bool:
    return len({(part.b, part.d, part.arm) for part in parts}) == 1


def _quarters(parts: Sequence[Part]) -> bool:
    return all((part.angle - parts[0].angle - 90 * place) % 360 == 0 for place, part in enumerate(parts))
