"""Float arithmetic for programs: each operation is rounded once to one numpy format, over scalars or arrays.

All operands have the one format, constants included, so that no promotion rule of any numpy version matters. numpy
computes binary16 in binary32 and rounds again, which is the correctly rounded result for + − × ÷ √, since
24 ≥ 2·11 + 2; cosines are as good as numpy's. Infinities and NaN raise nothing.

`two_sum` adds two float64 numbers without an error. FloatFormat describes the binary formats, and rounds a rational
number to one of them exactly.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, partial
from typing import Any, Literal

import numpy as np

from hypcheck.derivation.evaluation import OPERATORS, Arithmetic
from hypcheck.geometry.rows import Floats

_OPERATIONS: dict[str, Callable[..., Any]] = {
    **OPERATORS,
    "sqrt": np.sqrt,
    "cos": np.cos,
    "arccos": np.arccos,
    "not": np.logical_not,
    "select": np.where,
}

FORMATS = ("float16", "float32", "float64", "longdouble")


@cache
def float_arithmetic(format_name: str) -> Arithmetic:
    """Return the arithmetic of one of FORMATS; longdouble is whatever numpy has by that name here (x87 on x86-64).

    Inputs are floats, integers or arrays of them, rounded to the format on entry; arrays of that format are taken as
    they are, without a copy. Shapes broadcast, so sizes can be scalars beside arrays of centres.
    Raises ValueError where there is no such format.
    """
    if format_name not in FORMATS:
        raise ValueError(f"{format_name!r} is not one of the formats {', '.join(FORMATS)}")
    return Arithmetic(
        name=format_name,
        convert=partial(np.asarray, dtype=np.dtype(format_name)),
        operations=_OPERATIONS,
        integers=lambda values: np.asarray(values).astype(np.int8),
        guard=partial(np.errstate, all="ignore"),
    )


def unit_roundoff(format_name: str) -> float:
    """Return u, the largest relative error of one rounding to nearest in the format: half the gap after 1."""
    return float(np.finfo(np.dtype(format_name)).eps) / 2


def two_sum(first: Floats, second: Floats | float) -> tuple[Floats, Floats]:
    """Return the rounded sum of float64 numbers, and its rounding error (Knuth's TwoSum).

    The error is a float64 too, and exact: both results together are the exact sum. It is NaN where the sum leaves the
    range of float64.
    """
    total = first + second
    shadow = total - first
    return total, (first - (total - shadow)) + (second - shadow)


Direction = Literal["nearest", "up", "down"]


@dataclass(frozen=True, slots=True)
class FloatFormat:
    """A binary format: significant bits, and the exponents of its normal numbers, 2^least ≤ |v| < 2^(greatest + 1)."""

    name: str
    bits: int
    least: int
    greatest: int

    @property
    def overflow(self) -> int:
        """The exponent of the least power of two beyond the format."""
        return self.greatest + 1

    @property
    def unit(self) -> Fraction:
        """u, the largest relative error of one rounding to nearest."""
        return Fraction(1, 2**self.bits)

    def rounded(self, value: Fraction, direction: Direction = "nearest") -> float:
        """Round `value` to the nearest number of the format, or to the next one up or down.

        Raises OverflowError where a number other than 0 is beyond the normal range of the format.
        """
        if value == 0:
            return 0.0
        exponent = _floor_log2(abs(value))
        if not self.least <= exponent <= self.greatest:
            raise OverflowError(f"a number near 2^{exponent} is not a normal number of {self.name}")
        step = Fraction(2) ** (exponent - self.bits + 1)
        units = value / step
        return float(_whole(units, direction) * step)


FLOAT_FORMATS = {
    float_format.name: float_format
    for float_format in (
        FloatFormat("float16", 11, -14, 15),
        FloatFormat("float32", 24, -126, 127),
        FloatFormat("float64", 53, -1022, 1023),
    )
}
"""By name."""


def power_of_two_near(value: Fraction) -> Fraction:
    """Return the largest power of two that is not above `value` > 0."""
    return Fraction(2) ** _floor_log2(value)


def _whole(value: Fraction, direction: Direction) -> int:
    """Round to a whole number in the direction."""
    if direction == "nearest":
        return round(value)
    return math.ceil(value) if direction == "up" else math.floor(value)


def _floor_log2(value: Fraction) -> int:
    """Return the largest whole n with 2^n ≤ `value`, which is > 0."""
    exponent = value.numerator.bit_length() - value.denominator.bit_length()
    return exponent if Fraction(2) ** exponent <= value else exponent - 1
