"""Binary float formats: their bits and exponents, and exact rounding of a rational number to one of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

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
        """The number of the format next to `value`; raises OverflowError beyond its normal range, 0 aside."""
        if value == 0:
            return 0.0
        exponent = _floor_log2(abs(value))
        if not self.least <= exponent <= self.greatest:
            raise OverflowError(f"a number near 2^{exponent} is no normal number of {self.name}")
        step = Fraction(2) ** (exponent - self.bits + 1)
        units = value / step
        return float(_whole(units, direction) * step)


FLOAT_FORMATS = {
    each.name: each
    for each in (
        FloatFormat("float16", 11, -14, 15),
        FloatFormat("float32", 24, -126, 127),
        FloatFormat("float64", 53, -1022, 1023),
    )
}
"""By name."""


def power_of_two_near(value: Fraction) -> Fraction:
    """The largest power of two that is not above `value` > 0."""
    return Fraction(2) ** _floor_log2(value)


def _whole(value: Fraction, direction: Direction) -> int:
    if direction == "nearest":
        return round(value)
    return math.ceil(value) if direction == "up" else math.floor(value)


def _floor_log2(value: Fraction) -> int:
    exponent = value.numerator.bit_length() - value.denominator.bit_length()
    return exponent if Fraction(2) ** exponent <= value else exponent - 1
