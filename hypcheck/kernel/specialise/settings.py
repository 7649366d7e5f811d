"""The settings of a scene: one spheroid beside one hyperboloid, its region, sample centres, float format and scale.

The region is where the spheroid's centre can be, seen from the hyperboloid's. Sample centres are the same ones every
time, spread over the region, or around the surface where the region is open. Lengths are scaled by powers of two where
their squares could leave the format.
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
"""What an arm is multiplied by, since its end is computed by a rounded sine and cosine."""


@dataclass(frozen=True, slots=True)
class Setting:
    """`sizes` are α, γ, b, d; `box` the region of the centre as seen from the hyperboloid's, `cut` the wall's heights.

    `axis` is that of the spheroid's revolution, FREE where each query names one, None where it is upright.
    `cut` is None unless the box reaches beyond these; every query is compared with it. `uses` names the pairs of
    the scene that have these sizes.
    """

    sizes: Sizes
    box: Region
    cut: Span | None
    uses: tuple[str, ...]
    axis: Point | Literal["free"] | None = None

    @property
    def spans(self) -> dict[str, list[float]]:
        """The ends of each coordinate of the centre that is limited, by name, as JSON has them."""
        return {name: [span.low, span.high] for name, span in zip("xyz", self.box.spans, strict=True) if span}

    @property
    def named_axis(self) -> dict[str, Any]:
        """The axis by its name, as JSON has it; empty where the spheroid is upright."""
        return {} if self.axis is None else {"axis": self.axis if self.axis == FREE else list(self.axis)}

    @property
    def inner_and_outer(self) -> tuple[Sizes, Sizes]:
        """The sizes; of a tilted spheroid, with the largest ball in it for it, and with the smallest about it."""
        if self.axis is None:
            return self.sizes, self.sizes
        alpha, gamma, b, d = self.sizes
        return (alpha, gamma, min(b, d), min(b, d)), (alpha, gamma, max(b, d), max(b, d))


def settings_of(scene: SceneModel) -> tuple[Setting, ...]:
    """One setting for each combination of sizes in the scene, in the scene's order; pairs of the same sizes share one.

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
    """The axis that a kernel has to know: None where all is upright, or all are balls, the same along every axis."""
    balls = mover.b == mover.d and all(part.b == part.d for part in mover.parts)
    return mover.axis if is_tilted(mover.axis) and not balls else None


def position_of_box(setting: Setting) -> Position | None:
    """The one position that the whole box has, if it has one.

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
    return integers.upright_position(Pair.from_row((*setting.inner_and_outer[1], *centre)).lengths)


def _least(span: Span | None) -> float:
    """The least |v| of a span; 0 where there is none."""
    return 0.0 if span is None or span.holds(0) else min(abs(span.low), abs(span.high))


def farthest(span: Span) -> float:
    """The greatest |v| of a span."""
    return max(abs(span.low), abs(span.high))


def _pairs(scene: SceneModel) -> Iterator[Setting]:
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
    """The region seen from the hyperboloid, wider by `arm`, and the height that the kernel must still test."""
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
    """The span from `origin`, as far wider as an arm reaches.

    Rounding is monotone, so a caller's own rounded differences lie in it; SWING covers the roundings of a turned arm.
    """
    if span is None:
        return None
    wider = Fraction(arm) * SWING
    return Span(
        float(Fraction(span.low) - Fraction(origin) - wider), float(Fraction(span.high) - Fraction(origin) + wider)
    )


def _joined(one: Setting, other: Setting) -> Setting:
    x, y, z = (_hull(left, right) for left, right in zip(one.box.spans, other.box.spans, strict=True))
    return Setting(one.sizes, Region(x, y, z), _hull(one.cut, other.cut), (*one.uses, *other.uses), one.axis)


def _hull(one: Span | None, other: Span | None) -> Span | None:
    if one is None or other is None:
        return None
    return Span(min(one.low, other.low), max(one.high, other.high))


COUNT = 4096
LARGEST = 2.0**1021
"""Beyond it no centre lies, whatever the sizes: a span's width is then a number of float64."""

REACH = 2.0
"""How far around the surface centres lie where the region leaves an axis open: in waist radii and heights γ."""


def centres(setting: Setting) -> tuple[Floats, Floats, Floats]:
    """x, y, z, (COUNT,) each: a rank-one lattice, which fills the box evenly and needs no random numbers."""
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
    return Span(*(max(-LARGEST, min(end, LARGEST)) for end in (span.low, span.high)))


FORMATS = ("float32", "float64")
"""The formats that a kernel computes in."""


def format_of(precision: str) -> FloatFormat:
    """The format by its name; raises InputError."""
    if precision not in FORMATS:
        raise InputError(f"the precision is {precision!r}; a kernel computes in {' or '.join(FORMATS)}")
    return FLOAT_FORMATS[precision]


ORDINARY = {"float32": Fraction(2) ** 16, "float64": Fraction(2) ** 100}
"""Semi-axes between this and its reciprocal have squares, and products of squares, well inside the format."""


ROOM = 2**10


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
    """The squares of the sizes, scaled where the format asks for it (Theorem 1 allows any two factors).

    A program may flush subnormal numbers to zero. A coordinate that is lost then moves the spheroid by less than
    2^least, which b and d larger by a share u / ROOM hold, as they are 2^least ROOM / u at least. And α and γ are
    normal numbers, for which no other number is taken. Raises OverflowError where a size is smaller, or a factor is no
    number of the format.
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
