"""The settings of a scene: a setting is one spheroid beside one hyperboloid, and the region of the spheroid's centre.

The region says where the spheroid's centre can be, relative to the centre of the hyperboloid. A setting also has sample
centres, which are the same every time: they are spread over the region or, where it is open, around the surface.
Lengths are scaled by powers of two where their squares could leave the float format.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from sys import float_info
from typing import Any, Literal

import numpy as np

from hypcheck.derivation.float_arithmetic import FLOAT_FORMATS, FloatFormat, power_of_two_near
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair, Position, Sizes
from hypcheck.geometry.rows import Floats
from hypcheck.kernel import integers
from hypcheck.scene.model import FREE, Hyperboloid, Mover, MoverPart, Point, Region, SceneModel, Span, is_tilted

SWING = 1 + Fraction(1, 2**40)
"""The length of an arm is multiplied by this, since its end is computed with a rounded sine and cosine."""


@dataclass(frozen=True, slots=True)
class Setting:
    """One spheroid beside one hyperboloid: their `sizes` α, γ, b, d, and where the spheroid can be.

    `box` is the region of the spheroid's centre, relative to the hyperboloid's. `cut` is the interval of heights of the
    wall if the box reaches beyond it, else None; each query is compared with it. `axis` is the spheroid's axis of
    revolution, FREE if each query names one, None if it is upright. `uses` names the pairs of the scene that have these
    sizes.
    """

    sizes: Sizes
    box: Region
    cut: Span | None
    uses: tuple[str, ...]
    axis: Point | Literal["free"] | None = None

    @property
    def spans(self) -> dict[str, list[float]]:
        """For each coordinate of the centre that is limited, by name: its least and its greatest value, for JSON."""
        return {name: [span.low, span.high] for name, span in zip("xyz", self.box.spans, strict=True) if span}

    @property
    def named_axis(self) -> dict[str, Any]:
        """The axis, as the entry "axis" of a JSON object; no entry if the spheroid is upright."""
        return {} if self.axis is None else {"axis": self.axis if self.axis == FREE else list(self.axis)}

    @property
    def inner_and_outer(self) -> tuple[Sizes, Sizes]:
        """The sizes twice: of a tilted spheroid, with the largest ball in it, and with the smallest ball about it."""
        if self.axis is None:
            return self.sizes, self.sizes
        alpha, gamma, b, d = self.sizes
        return (alpha, gamma, min(b, d), min(b, d)), (alpha, gamma, max(b, d), max(b, d))


def settings_of(scene: SceneModel) -> tuple[Setting, ...]:
    """Return one setting for each combination of sizes in the scene, in its order; pairs of equal sizes share one.

    A pair whose heights never meet the region is left out: no query can reach it. Raises InputError where
    a hyperboloid is tilted or has flat ends.
    """
    _require_printable(scene)
    settings: dict[Sizes, Setting] = {}
    for setting in _pairs(scene):
        known = settings.get(setting.sizes)
        settings[setting.sizes] = setting if known is None else _joined(known, setting)
    return tuple(settings.values())


def _require_printable(scene: SceneModel) -> None:
    """Raise InputError about the first hyperboloid that is tilted or has flat ends."""
    for body in scene.hyperboloids:
        if is_tilted(body.axis):
            raise InputError(
                f"no kernel is made: the hyperboloid {body.name!r} has the axis {list(body.axis)}, and a kernel counts "
                "centres and the mover's axis in a frame in which the hyperboloid is upright; make one for that frame "
                "and convert each query into it, or use hypcheck.Scene, which is exact in any frame"
            )
        if body.solid and body.height is not None:
            raise InputError(
                f"no kernel is made for pairs: the hyperboloid {body.name!r} is solid, and such a kernel knows no flat "
                "ends (that of a whole scene does: hypcheck emit --whole)"
            )


def axis_of(mover: Mover) -> Point | Literal["free"] | None:
    """Return the axis that a kernel must know: None if all is upright, or if all are balls, which have no axis."""
    balls = mover.b == mover.d and all(part.b == part.d for part in mover.parts)
    return mover.axis if is_tilted(mover.axis) and not balls else None


def position_of_box(setting: Setting) -> Position | None:
    """Return the position that all centres in the box have, or None if they may have different ones.

    The exterior positions are an up-set when |x| and |y| grow and |z| falls, the interior ones when |x| and |y| fall
    and |z| grows (docs/mathematics.md): one exact decision at the least favourable corner of the box is a proof. Where
    the spheroid is tilted, that is tested with the smallest ball about it.
    """
    x, y, z = setting.box.spans
    if z is not None and _at(setting, (_least(x), _least(y), farthest(z))) is Position.EXTERIOR:
        return Position.EXTERIOR
    if x is not None and y is not None and _at(setting, (farthest(x), farthest(y), _least(z))) is Position.INTERIOR:
        return Position.INTERIOR
    return None


def _at(setting: Setting, centre: tuple[float, float, float]) -> Position:
    """Return the exact position at a centre; of a tilted spheroid, that of the smallest ball about it."""
    return integers.upright_position(Pair.from_row((*setting.inner_and_outer[1], *centre)).lengths)


def _least(span: Span | None) -> float:
    """Return the least |v| in a span; 0 if there is no span."""
    return 0.0 if span is None or span.holds(0) else min(abs(span.low), abs(span.high))


def farthest(span: Span) -> float:
    """Return the greatest |v| in a span."""
    return max(abs(span.low), abs(span.high))


def _pairs(scene: SceneModel) -> Iterator[Setting]:
    """Yield a setting for each hyperboloid and each of the mover and its parts whose heights meet the region."""
    mover = scene.mover
    bodies = {"the mover": MoverPart(mover.b, mover.d, 0.0)}
    bodies.update((f"part {number}", part) for number, part in enumerate(mover.parts, start=1))
    for hyperboloid in scene.hyperboloids:
        for name, body in bodies.items():
            box, cut = _box(scene, hyperboloid, body.arm)
            if box is not None:
                sizes = (hyperboloid.alpha, hyperboloid.gamma, body.b, body.d)
                yield Setting(sizes, box, cut, (f"{name} and {hyperboloid.name}",), axis_of(mover))


def _box(scene: SceneModel, hyperboloid: Hyperboloid, arm: float) -> tuple[Region | None, Span | None]:
    """Return the region relative to the hyperboloid, wider by `arm`, and the heights that the kernel must test.

    The heights are None if no test is needed. Both are None if no query can reach the hyperboloid.
    """
    region, centre = scene.region, hyperboloid.center
    x = _moved(region.x, centre[0], arm)
    y = _moved(region.y, centre[1], arm)
    # a tilted mover's arm points up or down
    z = _moved(region.z, centre[2], arm if is_tilted(scene.mover.axis) else 0.0)
    height = hyperboloid.height
    if height is None:
        return Region(x, y, z), None
    if hyperboloid.axis[2] < 0:  # it counts downwards
        height = Span(-height.high, -height.low)
    if z is not None and height.low <= z.low and z.high <= height.high:
        return Region(x, y, z), None
    low, high = height.low, height.high
    if z is not None:
        low, high = max(low, z.low), min(high, z.high)
    if low > high:
        return None, None
    return Region(x, y, Span(low, high) if isfinite(low) and isfinite(high) else None), height


def _moved(span: Span | None, origin: float, arm: float) -> Span | None:
    """Return the span relative to `origin`, wider by the arm at both ends; None if there is no span.

    Rounding is monotone, so a caller's own rounded differences lie in it; SWING covers the roundings of a turned arm.
    """
    if span is None:
        return None
    wider = Fraction(arm) * SWING
    return Span(
        float(Fraction(span.low) - Fraction(origin) - wider), float(Fraction(span.high) - Fraction(origin) + wider)
    )


def _joined(one: Setting, other: Setting) -> Setting:
    """Return one setting for two settings of the same sizes: its box and its heights hold those of both."""
    x, y, z = (_hull(left, right) for left, right in zip(one.box.spans, other.box.spans, strict=True))
    return Setting(one.sizes, Region(x, y, z), _hull(one.cut, other.cut), (*one.uses, *other.uses), one.axis)


def _hull(one: Span | None, other: Span | None) -> Span | None:
    """Return the shortest span that holds both; None, without limits, if one of them is None."""
    if one is None or other is None:
        return None
    return Span(min(one.low, other.low), max(one.high, other.high))


COUNT = 4096
"""How many sample centres a setting has."""

LARGEST = 2.0**1021
"""No coordinate of a sample centre is larger, whatever the sizes: so the width of a span is finite in float64."""

REACH = 2.0
"""Where the region is open, sample centres lie up to so many times α + b (x, y) or γ + d (z) from the centre."""


def centres(setting: Setting) -> tuple[Floats, Floats, Floats]:
    """Return x, y, z of the sample centres, (COUNT,) each: a rank-one lattice, which fills the box evenly.

    It needs no random numbers.
    """
    alpha, gamma, b, d = setting.sizes
    across = Span(-REACH * (alpha + b), REACH * (alpha + b))
    up = Span(-REACH * (gamma + d), REACH * (gamma + d))
    index = np.arange(COUNT)
    spans = [_held(own or default) for own, default in zip(setting.box.spans, (across, across, up), strict=True)]
    # Powers of the root of x⁴ = x + 1 give the evenest lattice in three dimensions.
    shares = [((0.5 + index * step) % 1.0) for step in (0.8191725133961645, 0.6710436067037893, 0.5497004779019703)]
    x, y, z = (span.low + (span.high - span.low) * share for span, share in zip(spans, shares, strict=True))
    return np.asarray(x), np.asarray(y), np.asarray(z)


def _held(span: Span) -> Span:
    """Return the span, with ends that are at most LARGEST in size."""
    return Span(*(max(-LARGEST, min(end, LARGEST)) for end in (span.low, span.high)))


FORMATS = ("float32", "float64")
"""The formats that a kernel computes in."""


def format_of(precision: str) -> FloatFormat:
    """Return the format of this name. Raises InputError for another name than those in FORMATS."""
    if precision not in FORMATS:
        raise InputError(f"the precision is {precision!r}; a kernel computes in {' or '.join(FORMATS)}")
    return FLOAT_FORMATS[precision]


ORDINARY = {"float32": Fraction(2) ** 16, "float64": Fraction(2) ** 100}
"""By format: semi-axes between this and its reciprocal need no scaling; squares and their products stay inside it."""


ROOM = 2**10
"""b and d are so large that a coordinate that is flushed to zero is worth at most u / ROOM of them (`scaled`)."""


@dataclass(frozen=True, slots=True)
class ScaledSetting:
    """A setting's squares, exactly, in the units of the kernel: radial lengths times `radial`, axial times `axial`.

    A = (α/b)² and B = (γ/d)² have no unit. `bb` and `dd` are b² and d². The factors are powers of two, so that a
    kernel's products by them round nothing; they are 1 where nothing has to be scaled.
    """

    A: Fraction
    B: Fraction
    bb: Fraction
    dd: Fraction
    radial: Fraction
    axial: Fraction


def scaled(sizes: Sizes, form: FloatFormat) -> ScaledSetting:
    """Return the squares of the sizes, scaled where the format needs it (Theorem 1 allows any two factors).

    A program may flush subnormal numbers to zero. A coordinate that is lost then moves the spheroid by less than
    2^least. Since b and d are at least 2^least ROOM / u, the spheroid with b and d larger by a share u / ROOM contains
    the moved one. α and γ are normal numbers, so they are not flushed. Raises OverflowError if a size is smaller, or if
    a factor is not a number of the format.
    """
    alpha, gamma, b, d = map(Fraction, sizes)
    limit = ORDINARY[form.name]
    radial = Fraction(1) if all(1 / limit < length < limit for length in (alpha, b)) else 1 / power_of_two_near(b)
    axial = Fraction(1) if all(1 / limit < length < limit for length in (gamma, d)) else 1 / power_of_two_near(d)
    for unit in (radial, axial):
        form.rounded(unit)
    least = Fraction(2) ** (form.least + form.bits) * ROOM
    if min(b, d) < least or min(alpha, gamma) < Fraction(float_info.min):
        raise OverflowError(
            f"b and d must be above {float(least):.2g} in {form.name}, alpha and gamma above {float_info.min:.2g}: "
            "a program may flush smaller numbers to zero"
        )
    return ScaledSetting((alpha / b) ** 2, (gamma / d) ** 2, (b * radial) ** 2, (d * axial) ** 2, radial, axial)
