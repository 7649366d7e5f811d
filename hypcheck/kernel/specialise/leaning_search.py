"""What the last stage holds for a spheroid that leans: its frame, or the squares of the sizes, in double-double.

The programs of the stage, and what they prove, are in leaning.py. The frame of a fixed axis is made in rational
numbers, far more precisely than its bound needs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from hypcheck.derivation.evaluation import OPERATORS, Arithmetic, outputs
from hypcheck.geometry.pair import Sizes
from hypcheck.kernel.specialise.leaning import ARITHMETIC_STEPS, FRAME, FRAME_NAMES, GEOMETRIC_STEPS, OMEGA, SIZE_NAMES
from hypcheck.scene.model import Point

DoubleDouble = tuple[float, float]
"""The sum of two float64, the second at most half a unit in the last place of the first."""

_LEAST, _GREATEST = Fraction(1, 2**40), Fraction(2**40)
_LEAST_T, _GREATEST_T = Fraction(1, 2**24), Fraction(2**24)
_LEAST_B, _GREATEST_B = Fraction(1, 2**60), Fraction(2**60)
_FARTHEST = Fraction(2**40)
_NOTHING = Fraction(1, 2**620)
"""Times 2⁴⁰ b, the farthest centre, it is less than LOST."""


@dataclass(frozen=True)
class LeaningSearch:
    """What the stage holds: the frame of a fixed axis, or p, s, t and b where the axis is free, in double-double.

    `most` is above every number of the rows times b, `omega` the bound of their errors. It answers where R ≤ `widest`
    and zz ≤ `highest`.
    """

    constants: Mapping[str, DoubleDouble]
    free: bool
    most: float
    omega: float
    steps: int
    widest: float
    highest: float


def leaning_search(sizes: Sizes, axis: Point | None) -> LeaningSearch:
    """The stage for a spheroid of these sizes and this axis; None: a free one.

    Raises OverflowError where the sizes are too far apart.
    """
    alpha, gamma, b, d = map(Fraction, sizes)
    p, s, t = (alpha / b) ** 2, (gamma / b) ** 2, (d / b) ** 2
    limits = ((p, _LEAST, _GREATEST), (s, _LEAST, _GREATEST), (t, _LEAST_T, _GREATEST_T), (b, _LEAST_B, _GREATEST_B))
    if not all(least <= value <= greatest for value, least, greatest in limits):
        raise OverflowError(
            "where a spheroid leans, alpha/b and gamma/b must be from 2^-20 to 2^20, d/b from 2^-12 to 2^12 and b from "
            "2^-60 to 2^60"
        )
    exact = dict(zip(SIZE_NAMES, (p, s, t, b), strict=True))
    constants = exact if axis is None else frame_of(axis, exact)
    end = float((_FARTHEST * b) ** 2)
    free = axis is None
    return LeaningSearch(
        constants={name: split(value) for name, value in constants.items()},
        free=free,
        most=_most(t) / float(b),
        omega=OMEGA["free" if free else "fixed"],
        steps=GEOMETRIC_STEPS + ARITHMETIC_STEPS,
        widest=end,
        highest=end,
    )


def _most(t: Fraction) -> float:
    """More than every number of the rows, times b, at any axis: each row is a column of an inverse square root of M.

    |rᵢ|² = r̂ᵀ M r̂ for a unit vector r̂ of M's own metric is at most the greatest eigenvalue of M, 1 or 1/t.
    """
    return 2.0 * float(max(Fraction(1), 1 / t))


def frame_of(axis: Point, sizes: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """The frame of an axis, within 2⁻²⁰⁰ of each of its numbers, or within 2⁻⁴⁰⁰ of 0."""
    vx, vy, vz = map(Fraction, axis)
    hx, hy = (vx, vy) if vx or vy else (Fraction(1), Fraction(0))
    values = outputs(FRAME, _PRECISE, {"hx": hx, "hy": hy, "vx": vx, "vy": vy, "vz": vz, **sizes}, FRAME_NAMES)
    return dict(zip(FRAME_NAMES, values, strict=True))


def split(value: Fraction) -> DoubleDouble:
    """The double-double next to a number; 0 where it is so small that LOST covers it."""
    if abs(value) < _NOTHING:
        return 0.0, 0.0
    high = float(value)
    return high, float(value - Fraction(high))


_BITS = 512


def _short(value: Fraction) -> Fraction:
    """The number with some _BITS significant bits."""
    if value == 0:
        return value
    step = Fraction(2) ** (value.numerator.bit_length() - value.denominator.bit_length() - _BITS)
    return round(value / step) * step


def _root(value: Fraction) -> Fraction:
    if value < 0:
        raise AssertionError("a frame takes roots of positive numbers alone")
    if value == 0:
        return value
    half = (value.denominator.bit_length() - value.numerator.bit_length()) // 2 + _BITS
    return Fraction(isqrt(int(value * Fraction(4) ** half))) / Fraction(2) ** half


_PRECISE = Arithmetic(
    name="precise",
    convert=Fraction,
    operations={
        **OPERATORS,
        "mul": lambda one, other: _short(one * other),
        "div": lambda dividend, divisor: _short(dividend / divisor),
        "sqrt": _root,
        "select": lambda condition, yes, no: yes if condition else no,
    },
)
