"""The quadcopter of a scene: a body and four equal rotors, Procedures 2.a and 2.b, valid starts of its flights.

The paper's section 3.2 puts rotor i at the angle g_i = g1 + (i − 1) π/2 and, by equation (15), an eighth of a turn on.
So a part's `angle` is g_i − heading + 45°, and (T1, T2) of g1 is enough for all four rotors
(derivation/paper_listings.py).

Points of the unit circle are computed only by + − × ÷ √, so that a flight is the same to the byte on every machine. The
polynomials are those of fdlibm's __kernel_sin and __kernel_cos (Sun Microsystems, 1993), good to less than an ulp for
angles up to π/4.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from hypcheck.derivation.evaluation import loop_body
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, REPAIRED
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Position, Sizes
from hypcheck.geometry.rows import Columns, Floats, Mask
from hypcheck.kernel.classify import classify
from hypcheck.scene.model import Hyperboloid, MoverPart, SceneModel, Span, Start

EIGHTH = math.pi / 4

_SINE = (
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
)
_COSINE = (
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
)

Direction = tuple[Floats, Floats]
"""The cosines and the sines of horizontal directions."""


def small_angle(angle: Floats) -> Direction:
    """Compute the cosine and the sine of angles up to π/4 in size, in radians."""
    square = angle * angle
    return 1 - 0.5 * square + square * square * _polynomial(_COSINE, square), (
        angle + angle * square * _polynomial(_SINE, square)
    )


def any_angle(degrees: Floats) -> Direction:
    """Compute the cosine and the sine of angles in degrees; they are exact for multiples of 90."""
    quarters = np.rint(degrees / 90)
    cosine, sine = small_angle((degrees - 90 * quarters) * (EIGHTH / 45))
    return quarter_turns(cosine, sine, quarters.astype(np.int64))


def quarter_turns(cosine: Floats, sine: Floats, quarters: np.typing.NDArray[np.int64]) -> Direction:
    """Return the direction turned by `quarters` quarter turns, counterclockwise."""
    odd = quarters % 2 == 1
    cosine, sine = np.where(odd, -sine, cosine), np.where(odd, cosine, sine)
    back = quarters // 2 % 2 == 1
    return np.where(back, -cosine, cosine), np.where(back, -sine, sine)


def turned(direction: Direction, by: Direction) -> Direction:
    """Return a direction turned by another, of length 1 again."""
    (cosine, sine), (other_cosine, other_sine) = direction, by
    ahead, aside = cosine * other_cosine - sine * other_sine, sine * other_cosine + cosine * other_sine
    length = np.sqrt(ahead * ahead + aside * aside)
    return ahead / length, aside / length


def _polynomial(coefficients: tuple[float, ...], at: Floats) -> Floats:
    result = np.full_like(at, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        result = result * at + coefficient
    return result


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
    `ahead` the angle from the heading to g1, in degrees. `solid` says that the tower has flat ends.
    """

    sizes: Sizes
    rotor: Sizes
    arm: float
    ahead: float
    height: Span | None
    solid: bool = False

    def rotors(self, at: Columns, heading: Direction) -> Columns:
        """Return the centres of all first rotors, then of all second ones, and so on, by equation (15); (4 n,) each."""
        x, y, z = (np.tile(column, ROTORS) for column in at)
        cosine, sine = self.arms(heading)
        return x + self.arm * cosine, y + self.arm * sine, z

    def arms(self, heading: Direction) -> Direction:
        """Return the directions of the arms, (√2/2) (T1(g_i), T2(g_i)), in the order of `rotors`."""
        cosine, sine = turned(heading, self.offset)
        half = np.sqrt(2.0) / 2
        along, aside = half * (cosine - sine), half * (cosine + sine)
        return np.concatenate([along, -aside, -along, aside]), np.concatenate([aside, along, -aside, -along])

    @property
    def offset(self) -> Direction:
        """The cosine and the sine of g1 − heading."""
        return any_angle(np.array(self.ahead))


class Procedures:
    """Procedures 2.a and 2.b in float64, printed or `repaired`; steps on sizes are done once, before the loop."""

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

    def discriminant(self, at: Columns) -> Floats:
        """Compute Δ of the body's cubic, equation (13)."""
        return np.asarray(self._body(dict(zip("xyz", at, strict=True)))[0])

    def ask(self, at: Columns, heading: Direction) -> tuple[Mask, Mask]:
        """Ask Procedure 2.b; return masks of the valid positions, and of the positions whose rotors were tested.

        The printed procedure tests the rotors if Δ ≤ 0, the repaired one if the body is not interior.
        """
        _, within, valid = self._body(dict(zip("xyz", at, strict=True)))
        if within.any():
            some = np.flatnonzero(within)
            x, y, z = (column[some] for column in at)
            valid[some] = self.ask_rotors((x, y, z), (heading[0][some], heading[1][some]))
        return valid, within

    def ask_rotors(self, at: Columns, heading: Direction) -> Mask:
        """Ask Procedure 2.a; return a mask of the positions at which it finds all four rotors interior."""
        cosine, sine = turned(heading, self._offset)
        (valid,) = self._rotors({**dict(zip("xyz", at, strict=True)), "cosine": cosine, "sine": sine})
        return np.asarray(valid)


def craft_of(scene: SceneModel) -> Craft:
    """Return the quadcopter of a scene. Raises InputError if Procedures 2.a and 2.b do not apply to the scene."""
    if len(scene.hyperboloids) != 1:
        raise InputError(
            f"the scene {scene.name!r} has {len(scene.hyperboloids)} hyperboloids; it must have one, the tower"
        )
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
        solid=tower.solid,
    )


def require_ordinary(scene: SceneModel) -> None:
    """Raise InputError if lengths are so long or short, or places so far, that the printed procedures overflow.

    Also raise InputError if anything is tilted, which the printed procedures do not model.
    """
    if scene.tilted:
        raise InputError(
            f"the scene {scene.name!r} has something tilted; simulations fly and walk upright among what is "
            "upright: leave out axis (simulate tower --pitch tilts)"
        )
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
                f"the scene {scene.name!r}: {what} is at {value!r}; a simulation takes coordinates up to {FARTHEST:g}"
            )


def _places(scene: SceneModel) -> Iterator[tuple[str, float]]:
    """Yield every start or limiting coordinate of a simulation, each with a name for messages."""
    for body in scene.hyperboloids:
        yield from ((f"the centre of {body.name!r}", value) for value in body.center)
        yield from _ends(f"the height of {body.name!r}", body.height)
    for span in scene.region.spans:
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


def _require_regime(scene: SceneModel, tower: Hyperboloid) -> None:
    if tower.alpha < scene.mover.b:
        raise InputError(
            f"the scene {scene.name!r}: alpha = {tower.alpha!r} is less than the mover's b = {scene.mover.b!r}; "
            "Procedures 2.a and 2.b ask for alpha/b >= 1 (Proposition 5)"
        )


def _first_of_four(scene: SceneModel) -> MoverPart:
    """Return the first rotor. Raises InputError unless the parts are four equal rotors a quarter turn apart."""
    parts = scene.mover.parts
    if len(parts) != ROTORS or not _equal(parts) or not _quarters(parts):
        raise InputError(
            f"the scene {scene.name!r}: equations (15) to (21) are of four equal rotors; the mover must have four "
            "parts of the same b, d and arm, each 90 degrees from the one before"
        )
    return parts[0]


def _equal(parts: Sequence[MoverPart]) -> bool:
    """Decide whether the parts have the same sizes and arms."""
    return len({(part.b, part.d, part.arm) for part in parts}) == 1


def _quarters(parts: Sequence[MoverPart]) -> bool:
    """Decide whether each part is a quarter turn further than the one before."""
    return all((part.angle - parts[0].angle - 90 * place) % 360 == 0 for place, part in enumerate(parts))


def rims(craft: Craft, start: Start, z: Floats) -> Floats:
    """Return the radius of the disc that a flight starts in, at each height (n,)."""
    if start.margin is None:
        return np.full(z.shape, start.radius)
    alpha, gamma, _, _ = craft.sizes
    ratio = z / gamma
    return np.maximum(alpha * np.sqrt(1 + ratio * ratio) - start.margin, 0)


def require_valid_start(scene: str, craft: Craft, start: Start) -> None:
    """Raise InputError unless the body or all four rotors are interior for every start and heading of a flight."""
    _, _, b, d = craft.sizes
    _, _, small_b, small_d = craft.rotor
    if not _interior(craft, start, b, d, 0.0) and not _interior(craft, start, small_b, small_d, craft.arm):
        disc = f"radius = {start.radius!r}" if start.margin is None else f"margin = {start.margin!r}"
        raise InputError(
            f"the scene {scene!r}: [flight.start] {disc} has flights start where neither the body nor all four rotors "
            "are inside the tower; a smaller radius, or a larger margin, leaves them room"
        )


def _interior(craft: Craft, start: Start, b: float, d: float, beyond: float) -> bool:
    """Decide whether a spheroid is interior everywhere on the rims of the discs, and `beyond` them (≥ 0, outwards).

    With its centre at radius r and height z it is interior iff r + b √(1 − w²/d²) < R(z + w) for all |w| ≤ d; the
    wall's radius R is even and convex. If r is the same at all heights, the height nearest the waist decides. If r is R
    minus a margin, R(z + w) − R(z) decides: as a function of z it is, by convexity, least at the top for w < 0 and at
    the bottom for w > 0, so the two ends decide. A margin greater than R leaves r the same, and at the ends r is at
    least this.
    """
    alpha, gamma, _, _ = craft.sizes
    low, high = start.z.low, start.z.high
    heights = np.array([low, high, min(max(low, 0.0), high)])
    rows = [(alpha, gamma, b, d, r, 0.0, z) for r, z in zip(rims(craft, start, heights) + beyond, heights, strict=True)]
    return bool((classify(rows) == Position.INTERIOR).all())
