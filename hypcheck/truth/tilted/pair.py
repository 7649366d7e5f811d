"""One query in general position: the seven numbers of an upright one and the axis of the spheroid.

The spheroid is (X − C)ᵀ M (X − C) = 1 with M = I/b² + (1/d² − 1/b²) v vᵀ/(v·v), where v = (axis_x, axis_y, axis_z) is
any finite vector ≠ 0 along its axis of revolution; its length and its sign mean nothing. M is rational in the ten
float64 numbers, which are taken as exact values.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, TILTED_COLUMNS, Lengths, Pair, trouble_with_row

Row = tuple[float, float, float, float, float, float, float, float, float, float]
Vector = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class TiltedPair:
    """A valid query: sizes finite and > 0, centre finite, axis finite and not 0, no negative zero.

    Lengths are in the caller's one unit, the axis in any. Raises InputError (naming the column and the value) on
    construction from anything else.
    """

    alpha: float
    gamma: float
    b: float
    d: float
    x: float
    y: float
    z: float
    axis_x: float
    axis_y: float
    axis_z: float

    def __post_init__(self) -> None:
        trouble = trouble_with_row(self.row)
        if trouble is not None:
            raise InputError(trouble)
        for name, value in zip(TILTED_COLUMNS, self.row, strict=True):
            object.__setattr__(self, name, float(value) + 0.0)  # + 0.0 turns −0.0 into 0.0

    @classmethod
    def from_row(cls, row: Iterable[float]) -> TiltedPair:
        """The pair of a row alpha, gamma, b, d, x, y, z, axis_x, axis_y, axis_z."""
        return cls(*row)

    @property
    def row(self) -> Row:
        """The ten numbers in the order of TILTED_COLUMNS."""
        return (self.alpha, self.gamma, self.b, self.d, self.x, self.y, self.z, self.axis_x, self.axis_y, self.axis_z)

    @property
    def axis(self) -> tuple[float, float, float]:
        """The vector along the spheroid's axis of revolution."""
        return (self.axis_x, self.axis_y, self.axis_z)

    @property
    def upright(self) -> Pair | None:
        """The same query with seven numbers, where it has one: the axis is vertical, or the spheroid is a sphere."""
        if (self.axis_x == 0 and self.axis_y == 0) or self.b == self.d:
            return Pair(*self.row[:7])
        return None

    @property
    def lengths(self) -> TiltedLengths:
        """The same pair in integers: see TiltedLengths."""
        return TiltedLengths.of(self.row)


def pair_of(row: Sequence[float]) -> Pair | TiltedPair:
    """The pair of seven numbers, or of ten; an upright pair wherever that is the same query. Raises InputError."""
    if len(row) == len(COLUMNS):
        return Pair.from_row(row)
    pair = TiltedPair.from_row(row)
    return pair.upright or pair


@dataclass(frozen=True, slots=True)
class TiltedLengths:
    """A pair in exact integers: the seven lengths in one common unit, the axis in another."""

    alpha: int
    gamma: int
    b: int
    d: int
    x: int
    y: int
    z: int
    axis: Vector

    @classmethod
    def of(cls, row: Sequence[float | Fraction]) -> TiltedLengths:
        """The integers of ten valid numbers, float64 or rational."""
        alpha, gamma, b, d, x, y, z = _integers(row[:7])
        axis_x, axis_y, axis_z = _integers(row[7:])
        return cls(alpha, gamma, b, d, x, y, z, (axis_x, axis_y, axis_z))

    @property
    def upright(self) -> Lengths | None:
        """The upright pair's integers, where the axis is vertical or the spheroid is a sphere."""
        if (self.axis[0] == 0 and self.axis[1] == 0) or self.b == self.d:
            return Lengths(self.alpha, self.b, self.x, self.y, self.gamma, self.d, self.z)
        return None


def _integers(values: Sequence[float | Fraction]) -> tuple[int, ...]:
    """The values over the largest number of which all are integer multiples, up to an odd factor; not all are 0."""
    multiples, _ = over_one_denominator(values)
    union = 0
    for multiple in multiples:
        union |= multiple
    shift = (union & -union).bit_length() - 1
    return tuple(multiple >> shift for multiple in multiples)


def over_one_denominator(values: Sequence[float | Fraction]) -> tuple[list[int], int]:
    """Numbers as integers over their least common denominator, and that."""
    ratios = [value.as_integer_ratio() for value in values]
    unit = math.lcm(*(denominator for _, denominator in ratios))
    return [numerator * (unit // denominator) for numerator, denominator in ratios], unit
