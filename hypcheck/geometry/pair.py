"""One query: a circular hyperboloid of one sheet, a spheroid, and the three positions they can have.

The hyperboloid is x²/α² + y²/α² − z²/γ² = 1 (equation (1) of the paper), centred at the origin; the spheroid has
semi-axes b, b, d and centre (x, y, z) (equation (4)). Its axis of revolution is vertical, or is given by three
numbers more. All numbers are float64 and are taken as exact values.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from fractions import Fraction
from types import MappingProxyType
from typing import Any, TypeAlias

from hypcheck.errors import InputError

SIZES = ("alpha", "gamma", "b", "d")
CENTER = ("x", "y", "z")
COLUMNS = SIZES + CENTER
AXIS = ("axis_x", "axis_y", "axis_z")
"""Any finite vector ≠ 0 along the spheroid's axis of revolution; its length and its sign mean nothing."""

TILTED_COLUMNS = COLUMNS + AXIS
"""The names of the ten numbers of a tilted spheroid beside a hyperboloid."""

START, END = ("x0", "y0", "z0"), ("x1", "y1", "z1")
SWEEP_COLUMNS = SIZES + START + END
"""The names of the ten numbers of a straight sweep: the spheroid's centre goes from (x0, y0, z0) to (x1, y1, z1)."""

TILTED_SWEEP_COLUMNS = SWEEP_COLUMNS + AXIS
"""The names of the thirteen numbers of a sweep of a tilted spheroid, whose axis keeps its direction."""

ENDS = ("z_min", "z_max")
HEIGHTS = (*ENDS, "solid")
"""The heights between which the hyperboloid ends, in its own frame, and whether flat ends belong to it: 0 or 1."""

GROUPS: Mapping[str, tuple[str, ...]] = MappingProxyType({"end": END, "axis": AXIS, "heights": HEIGHTS})
"""The groups of columns that a row can have besides the seven numbers, by name, in the order of the columns."""

Groups: TypeAlias = frozenset[str]
"""Names out of GROUPS."""

NO_GROUPS: Groups = frozenset()
ALL_GROUPS: Groups = frozenset(GROUPS)

UPRIGHT = (0.0, 0.0, 1.0)
"""The axis of an upright spheroid, where rows have the columns of an axis."""

WITHOUT_ENDS = (-math.inf, math.inf, 0.0)
"""The heights of a hyperboloid without ends, where rows have the columns of heights."""

NO_DIRECTION = "axis_x, axis_y, axis_z are 0, 0, 0; an axis must have a direction"
RADIAL = ("alpha", "b", "x", "y")
AXIAL = ("gamma", "d", "z")

Sizes = tuple[float, float, float, float]
"""α, γ, b, d of one pair."""

Axis = tuple[float, float, float]
"""axis_x, axis_y, axis_z of one spheroid."""

Heights = tuple[float, float, float]
"""z_min, z_max, solid of one hyperboloid."""

Vector = tuple[int, int, int]

_VERTICAL: tuple[Vector, Vector] = ((0, 0, 1), (0, 0, 1))


class Position(IntEnum):
    """The relative position: outside the hyperboloid, in contact with it (tangency included), or inside."""

    EXTERIOR = 1
    CONTACT = 0
    INTERIOR = -1

    @property
    def label(self) -> str:
        """The position's name in lower case, as files and reports print it."""
        return self.name.lower()


REFUSED = 127
"""The answer code of an invalid row, if the caller wants invalid rows to be marked."""


@dataclass(frozen=True, slots=True)
class Pair:
    """A valid query: sizes finite and > 0, centre finite, axis finite and not 0, z_min < z_max, no negative zero.

    All lengths are in one unit, the axis in any. Without an axis the spheroid is upright, without heights the
    hyperboloid has no ends. Construction from anything else raises InputError, which names the column and the value.
    """

    alpha: float
    gamma: float
    b: float
    d: float
    x: float
    y: float
    z: float
    axis_x: float = 0.0
    axis_y: float = 0.0
    axis_z: float = 1.0
    z_min: float = -math.inf
    z_max: float = math.inf
    solid: float = 0.0

    def __post_init__(self) -> None:
        trouble = trouble_with_row((*self._seven, *self.axis, *self.heights))
        if trouble is not None:
            raise InputError(trouble)
        for name in TILTED_COLUMNS + HEIGHTS:
            object.__setattr__(self, name, float(getattr(self, name)) + 0.0)  # + 0.0 turns −0.0 into 0.0

    @classmethod
    def from_row(cls, row: Iterable[float]) -> Pair:
        """Make the pair of a row of seven numbers, of ten with an axis, or of thirteen with an axis and heights."""
        return cls(*row)

    @property
    def row(self) -> tuple[float, ...]:
        """The numbers in the order of COLUMNS, followed by those of the axis unless it is UPRIGHT.

        If the hyperboloid ends, axis and heights follow in any case.
        """
        if self.has_ends:
            return self._seven + self.axis + self.heights
        return self._seven if self.axis == UPRIGHT else self._seven + self.axis

    @property
    def _seven(self) -> tuple[float, ...]:
        return (self.alpha, self.gamma, self.b, self.d, self.x, self.y, self.z)

    @property
    def heights(self) -> Heights:
        """The heights between which the hyperboloid ends, and 1.0 if flat ends belong to it."""
        return (self.z_min, self.z_max, self.solid)

    @property
    def has_ends(self) -> bool:
        """Whether the hyperboloid ends at one of the heights."""
        return self.z_min != -math.inf or self.z_max != math.inf

    @property
    def without_ends(self) -> Pair:
        """The same pair with the whole hyperboloid."""
        return replace(self, **dict(zip(HEIGHTS, WITHOUT_ENDS, strict=True))) if self.has_ends else self

    @property
    def axis(self) -> Axis:
        """A vector along the spheroid's axis of revolution."""
        return (self.axis_x, self.axis_y, self.axis_z)

    @property
    def is_upright(self) -> bool:
        """Whether this is the question about an upright spheroid: the axis is vertical, or the spheroid a sphere."""
        return (self.axis_x == 0 and self.axis_y == 0) or self.b == self.d

    @property
    def upright(self) -> Pair:
        """The same question without an axis, of a pair that is_upright."""
        return self if self.axis == UPRIGHT else Pair.from_row((*self._seven, *UPRIGHT, *self.heights))

    @property
    def lengths(self) -> Lengths:
        """The pair in integers, as Lengths describes."""
        return Lengths.of((*self._seven, *self.axis, *self.heights))


@dataclass(frozen=True, slots=True)
class Lengths:
    """A pair in exact integers: α, b, x, y in one unit, γ, d, z in another, which for tilted spheroids is the same.

    The position of an upright pair depends only on the ratios within each group (Theorem 1 of the paper scales space by
    1/b, 1/b, 1/d), so each group may have its own unit. That of a tilted one depends on all ratios, and on the
    direction of the axis but not on its length. Every float64 or rational pair can be written so without rounding.

    `upward` is a vector along the hyperboloid's axis, in a unit of its own. Where it is not vertical, all lengths are
    in one unit. `low` and `high` are the heights along it between which the hyperboloid ends, in the unit of z; None is
    infinite. `solid` says that flat ends belong to it.
    """

    alpha: int
    b: int
    x: int
    y: int
    gamma: int
    d: int
    z: int
    axis: Vector = (0, 0, 1)
    upward: Vector = (0, 0, 1)
    low: int | None = None
    high: int | None = None
    solid: bool = False

    @classmethod
    def of(cls, row: Sequence[float | Fraction], upward: Sequence[float | Fraction] = UPRIGHT) -> Lengths:
        """Make the integers of seven valid numbers, float64 or rational; an axis may follow them, and then heights."""
        (lengths,) = cls.at_centers(row[:4], (row[4:7],), row[7:10] or UPRIGHT, upward, row[10:] or WITHOUT_ENDS)
        return lengths

    @classmethod
    def at_centers(
        cls,
        sizes: Sequence[float | Fraction],
        centers: Sequence[Sequence[float | Fraction]],
        axis: Sequence[float | Fraction],
        upward: Sequence[float | Fraction],
        heights: Sequence[float | Fraction],
    ) -> list[Lengths]:
        """Make the integers of valid numbers about one spheroid at some centres, all in the same units."""
        alpha, gamma, b, d = sizes
        radial, axial = [alpha, b], [gamma, d]
        for x, y, z in centers:
            radial += (x, y)
            axial.append(z)
        axial += [end for end in heights[:2] if end not in (-math.inf, math.inf)]
        if upward[0] == upward[1] == 0 and (axis[0] == axis[1] == 0 or b == d):
            (p, q, *across), (s, t, *along), axes = to_integers(radial), to_integers(axial), _VERTICAL
        else:
            together, axes = reduced(radial + axial), (reduced(axis), reduced(upward))
            (p, q, *across), (s, t, *along) = together[: len(radial)], together[len(radial) :]
        ends, low, high = along[len(centers) :], None, None
        if ends:
            low = None if heights[0] == -math.inf else ends[0]
            high = None if heights[1] == math.inf else ends[-1]
            low, high = counted_along(axes[1], upward, low, high)
        solid = bool(ends and heights[2])
        places = zip(across[::2], across[1::2], along, strict=False)  # the ends are behind the heights of centres
        return [cls(p, q, x, y, s, t, z, *axes, low, high, solid) for x, y, z in places]

    def finer(self, factor: int, step: Vector = (0, 0, 0)) -> Lengths:
        """Return the same pair in units that are `factor` times as fine, its centre moved by a step in these units."""
        (u, v, w), low, high = step, self.low, self.high
        low, high = None if low is None else low * factor, None if high is None else high * factor
        radial = (self.alpha * factor, self.b * factor, self.x * factor + u, self.y * factor + v)
        axial = (self.gamma * factor, self.d * factor, self.z * factor + w)
        return Lengths(*radial, *axial, self.axis, self.upward, low, high, self.solid)

    @property
    def has_ends(self) -> bool:
        """Whether the hyperboloid ends at one of the heights."""
        return self.low is not None or self.high is not None

    @property
    def is_upright(self) -> bool:
        """Whether the axes of both are parallel, or the spheroid is a sphere."""
        (a, b, c), (u, v, w) = self.axis, self.upward
        return (b * w == c * v and c * u == a * w and a * v == b * u) or self.b == self.d


def counted_along(
    axis: Vector, upward: Sequence[float | Fraction], low: int | None, high: int | None
) -> tuple[int | None, int | None]:
    """Turn heights along `upward` into heights along a parallel `axis`, maybe opposite; None is infinite."""
    if all((a > 0) == (b > 0) for a, b in zip(axis, upward, strict=True)):  # a product may be beyond float64
        return low, high
    return None if high is None else -high, None if low is None else -low


def trouble_with(name: str, value: object) -> str | None:
    """Say why `value` is not valid in column `name`, as the end of a sentence; None if it is valid."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return f"{name} is {value!r}; it must be a number"
    try:
        number = float(value)
    except OverflowError:
        return f"{name} is an integer too large for float64"
    if not math.isfinite(number):
        return f"{name} is {number!r}; it must be finite"
    if name in SIZES and number <= 0:
        return f"{name} is {number!r}; a semi-axis must be greater than 0"
    return None


def trouble_with_axis(axis: Sequence[object]) -> str | None:
    """Say why three values are not an axis, as the end of a sentence; None if they are one."""
    troubles = (trouble_with(name, part) for name, part in zip(AXIS, axis, strict=True))
    return next((trouble for trouble in troubles if trouble), None if any(axis) else NO_DIRECTION)


def trouble_with_heights(heights: Sequence[object]) -> str | None:
    """Say why three values are not valid as z_min, z_max, solid, as the end of a sentence; None if they are."""
    low, high, solid = heights
    for name, value in zip(HEIGHTS, heights, strict=True):
        infinite = value in (-math.inf, math.inf) and name != "solid"
        trouble = None if infinite or (name == "solid" and isinstance(value, bool)) else trouble_with(name, value)
        if trouble is not None:
            return trouble.replace("must be finite", "must be a number or infinite") if name != "solid" else trouble
    if not low < high:  # type: ignore[operator]  # both are numbers
        return f"z_min is {low!r} and z_max is {high!r}; z_min must be less than z_max"
    return None if solid in (0, 1) else f"solid is {solid!r}; it must be 0 or 1"


def trouble_with_row(row: Sequence[object], columns: Sequence[str] = COLUMNS) -> str | None:
    """Say the first trouble with the values of a row, as the end of a sentence; None for a valid row.

    Values of an axis may follow those of these columns, and values of heights may follow those of the axis. By default
    the row is one of seven, ten or thirteen numbers.
    """
    for name, value in zip(columns, row, strict=False):
        trouble = trouble_with(name, value)
        if trouble is not None:
            return trouble
    others = row[len(columns) :]
    trouble = trouble_with_axis(others[:3]) if others else None
    return trouble_with_heights(others[3:]) if trouble is None and len(others) > len(AXIS) else trouble


def to_integers(values: Sequence[float | Fraction]) -> Any:  # noqa: ANN401 - as many integers as values
    """Multiply the values by the least whole number that makes each an integer."""
    return tuple(over_one_denominator(values)[0])


def over_one_denominator(values: Sequence[float | Fraction]) -> tuple[list[int], int]:
    """Return the numbers as integers over their least common denominator, and that denominator."""
    ratios = [value.as_integer_ratio() for value in values]
    unit = math.lcm(*(denominator for _, denominator in ratios))
    return [numerator * (unit // denominator) for numerator, denominator in ratios], unit


def reduced(values: Sequence[float | Fraction]) -> Any:  # noqa: ANN401 - as many integers as values
    """Scale the values to integers that are not all even, by multiplying with a positive number; not all are 0."""
    multiples = to_integers(values)
    union = 0
    for multiple in multiples:
        union |= multiple
    shift = (union & -union).bit_length() - 1
    return tuple(multiple >> shift for multiple in multiples)
