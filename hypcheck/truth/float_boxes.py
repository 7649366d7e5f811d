"""Certificates over boxes of changes for many rows at once, in float64 intervals.

The proofs are those of box_proofs.py. Each end of an interval is rounded outward after each operation, so that every
certificate here is a proof. Rows without a certificate, near contact or with very stiff sizes, are left to the 256 bits
of box_certificate.py.

Overflow gives NaN, and a comparison with NaN gives no proof. numpy computes only sums, products, quotients and roots,
which IEEE 754 rounds correctly, so that the next floats on both sides bound the exact result.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.arithmetic import dot
from hypcheck.geometry.pair import COLUMNS, SIZES
from hypcheck.geometry.rows import Floats, Mask, Rows
from hypcheck.truth.box_proofs import SHARES, BoxKind, Form, Goal, Margin, Place, stays_clear, stays_off
from hypcheck.truth.nearest_tilted import multipliers

LEAST = -46
"""Changes below 2^LEAST are not tried: there float64 intervals tell nothing."""

_LADDER = np.ldexp(np.exp2(np.arange(8) / 8), np.arange(LEAST, 0)[:, None]).ravel()
"""The changes that are tried, ascending: eight to an octave."""


@dataclass(frozen=True, eq=False, slots=True)
class Enclosures:
    """An interval for each of n numbers, with ends (n,); NaN if nothing is known about a number."""

    low: Floats
    high: Floats

    __array_ufunc__: ClassVar[None] = None  # so that an array on the left leaves the operation to this class

    def __add__(self, other: Number) -> Enclosures:
        other = _enclosed(other)
        return Enclosures(_down(self.low + other.low), _up(self.high + other.high))

    def __neg__(self) -> Enclosures:
        return Enclosures(-self.high, -self.low)

    def __sub__(self, other: Number) -> Enclosures:
        return self + -_enclosed(other)

    def __rsub__(self, other: Number) -> Enclosures:
        return _enclosed(other) + -self

    def __mul__(self, other: Number) -> Enclosures:
        other = _enclosed(other)
        one, two = self.low * other.low, self.low * other.high
        three, four = self.high * other.low, self.high * other.high
        low = np.minimum(np.minimum(one, two), np.minimum(three, four))
        return Enclosures(_down(low), _up(np.maximum(np.maximum(one, two), np.maximum(three, four))))

    def __truediv__(self, other: Number) -> Enclosures:
        other = _enclosed(other)
        across_zero = (other.low <= 0) & (other.high >= 0)
        low = np.where(across_zero, -np.inf, _down(1 / other.high))
        return self * Enclosures(low, np.where(across_zero, np.inf, _up(1 / other.low)))

    def __rtruediv__(self, other: Number) -> Enclosures:
        return _enclosed(other) / self

    def __pow__(self, power: int) -> Enclosures:
        if power != 2:
            raise ValueError("only squares are needed")
        largest = self.size
        least = np.where((self.low <= 0) & (self.high >= 0), 0.0, np.minimum(np.abs(self.low), np.abs(self.high)))
        return Enclosures(np.maximum(_down(least * least), 0.0), _up(largest * largest))

    __radd__, __rmul__ = __add__, __mul__

    @property
    def size(self) -> Floats:
        """The largest absolute value in each."""
        return np.asarray(np.maximum(np.abs(self.low), np.abs(self.high)))

    def root(self) -> Enclosures:
        """Return the square root; negative numbers in an interval are ignored, since they cannot occur."""
        return Enclosures(np.maximum(_down(np.sqrt(np.maximum(self.low, 0.0))), 0.0), _up(np.sqrt(self.high)))


Number: TypeAlias = Enclosures | Floats | float


def _enclosed(value: Number) -> Enclosures:
    """Return the value as enclosures; a float encloses itself."""
    return value if isinstance(value, Enclosures) else Enclosures(np.asarray(value), np.asarray(value))


def _down(values: Floats) -> Floats:
    """Return the next floats below."""
    return np.asarray(np.nextafter(values, -np.inf))


def _up(values: Floats) -> Floats:
    """Return the next floats above."""
    return np.asarray(np.nextafter(values, np.inf))


Vectors = list[Any]
"""Three numbers of n rows each, floats or enclosures."""

KIND = BoxKind(
    between=Enclosures,
    root=Enclosures.root,
    low=lambda enclosure: enclosure.low,
    high=lambda enclosure: enclosure.high,
    size=lambda enclosure: enclosure.size,
    safe=1 + 2.0**-40,
    nothing=1e-300,  # lengths are about 1
    tiny=2.0**-30,
)
"""Float64 intervals."""

_AT_ONCE = 4096
"""Rows of one pass, which bounds memory."""


@dataclass(frozen=True, eq=False, slots=True)
class Boxes:
    """Sizes (4, n) at their best corner for a goal, the ends (6, n) of centres and axes, and the goals (n,)."""

    sizes: Floats
    low: Floats
    high: Floats
    side: Floats
    leave: Mask

    def __getitem__(self, chosen: Mask | NDArray[np.intp]) -> Boxes:
        return Boxes(
            self.sizes[:, chosen], self.low[:, chosen], self.high[:, chosen], self.side[chosen], self.leave[chosen]
        )

    @property
    def middle(self) -> Floats:
        """Centres and axes in the middle, rounded."""
        return self.low / 2 + self.high / 2

    @property
    def radii(self) -> Floats:
        """Upper bounds of the distances from the rounded middle to the ends."""
        middle = self.middle
        return _up(np.maximum(self.high - middle, middle - self.low))


def lower_ends(rows: Rows, goals: Sequence[Goal]) -> Floats:
    """Return for each row (n, 10) a change that is proved not to attain its goal: float64 (n,); 0 if none is proved.

    It is a power of 2^(1/8) below 1, and nearly the largest that one certificate excludes.
    """
    parts = [slice(start, start + _AT_ONCE) for start in range(0, len(rows), _AT_ONCE)]
    return np.concatenate([_lower_ends(rows[part], goals[part]) for part in parts]) if parts else np.empty(0)


def _lower_ends(rows: Rows, goals: Sequence[Goal]) -> Floats:
    """Search the largest proved change among the steps of _LADDER; for few rows many steps are tried at a time."""
    low, high = np.full(len(rows), -1), np.full(len(rows), len(_LADDER))
    active = np.arange(len(rows))
    while len(active):
        between = np.arange(1, max(2, _AT_ONCE // (16 * len(active))))
        tried = low[active, None] + between * (high - low)[active, None] // (between[-1] + 1)
        tried = np.clip(tried, low[active, None] + 1, high[active, None] - 1)
        owners = np.repeat(active, len(between))
        proved = excluded(rows[owners], [goals[owner] for owner in owners.tolist()], _LADDER[tried.ravel()])
        proved = proved.reshape(tried.shape)
        low[active] = np.where(proved, tried, low[active, None]).max(axis=1)
        above = (tried > low[active, None]) & ~proved
        high[active] = np.where(above, tried, high[active, None]).min(axis=1)
        active = active[high[active] - low[active] > 1]
    return np.where(low >= 0, _LADDER[np.maximum(low, 0)], 0.0)


def excluded(rows: Rows, goals: Sequence[Goal], changes: Floats, cuts: int = 0) -> Mask:
    """Return a mask of rows with certificates that no change up to `changes` (n,), each below 1, attains the goal."""
    with np.errstate(all="ignore"):
        return _certified(_boxes(_normalised(rows), goals, changes), cuts)


def _normalised(rows: Rows) -> Rows:
    """Return the same pairs scaled so that lengths and axes are about 1; NaN if float64 does not hold these exactly."""
    exponents = np.empty(rows.shape, dtype=np.int64)
    for part in (slice(0, len(COLUMNS)), slice(len(COLUMNS), None)):
        exponents[:, part] = np.frexp(np.abs(rows[:, part]).max(axis=1))[1][:, None]
    scaled = np.ldexp(rows, -exponents)
    return np.where(np.ldexp(scaled, exponents) == rows, scaled, np.nan)


def _boxes(rows: Rows, goals: Sequence[Goal], change: Floats) -> Boxes:
    """Make the boxes of all changes of the rows up to `change` (n,), rounded outward."""
    signs = np.array([goal.sizes for goal in goals], dtype=np.float64).reshape(-1, len(SIZES)).T
    grown, shrunk = _up(1 + change), _down(1 - change)
    sizes = rows[:, : len(SIZES)].T
    moved = np.where(signs > 0, _up(sizes * grown), _down(sizes * shrunk))
    rest = rows[:, len(SIZES) :].T
    reach = np.where(rest == 0, 0.0, _up(np.abs(rest) * change))
    low, high = (np.where(reach == 0, rest, end) for end in (_down(rest - reach), _up(rest + reach)))
    side = np.array([int(goal.side) for goal in goals], dtype=np.float64)
    return Boxes(moved, low, high, side, np.array([goal.leave for goal in goals], dtype=np.bool_))


def _certified(boxes: Boxes, cuts: int) -> Mask:
    """Return a mask of the goals proved not to be attained in their boxes, (n,); a box is cut up to `cuts` times."""
    held = np.ones(len(boxes.side), dtype=np.bool_)
    owners = np.arange(len(boxes.side))
    for left in range(cuts, -1, -1):
        proved, pull = _held(boxes)
        if not left:
            held[owners[~proved]] = False
            break
        boxes, owners, pull = boxes[~proved], owners[~proved], pull[:, ~proved]
        if not len(owners):
            break
        boxes, owners = _halves(boxes, pull), np.concatenate([owners, owners])
    return held


def _halves(boxes: Boxes, pull: Floats) -> Boxes:
    """Return the two halves of each box, cut across the number that loosens the bounds most."""
    middle, chosen = boxes.middle, np.argmax(np.abs(pull) * boxes.radii, axis=0)
    cut = chosen == np.arange(len(pull))[:, None]
    return Boxes(
        np.concatenate([boxes.sizes] * 2, axis=1),
        np.concatenate([boxes.low, np.where(cut, middle, boxes.low)], axis=1),
        np.concatenate([np.where(cut, middle, boxes.high), boxes.high], axis=1),
        np.concatenate([boxes.side] * 2),
        np.concatenate([boxes.leave] * 2),
    )


def _held(boxes: Boxes) -> tuple[Mask, Floats]:
    """Return a mask of goals that one certificate excludes in a box, (n,), and slopes of the margin, (6, n)."""
    sign = np.where(boxes.leave, -1.0, 1.0)
    pull = sign * np.stack(_margin_at(boxes.sizes, boxes.middle, boxes.side).derivatives())
    worst = _margin_at(boxes.sizes, np.where(pull > 0, boxes.high, boxes.low), boxes.side)
    proved = np.zeros(len(sign), dtype=np.bool_)
    for chosen in (np.flatnonzero(boxes.leave), np.flatnonzero(~boxes.leave)):
        if len(chosen):
            X, C = ([part[chosen] for part in vector] for vector in (worst.X, worst.C))
            proved[chosen] = _proved(boxes[chosen], worst.at[chosen], X, C)
    return proved, pull


def _margin_at(sizes: Floats, rest: Floats, side: Floats) -> Margin:
    """Return the margins of n rows."""
    form, C, v = Form(list(sizes), np.sqrt), rest[:3], list(rest[3:])
    hint, at, nearest = multipliers(sizes, C, rest[3:]), np.zeros(len(side)), C
    for share in SHARES:
        M, adjugate, minors = form.pencil(hint * share, v)
        definite = (at == 0) & (hint * side > 0) & (np.min(minors, axis=0) > 0)
        X = [dot(row, [dot(line, list(C)) for line in M]) / minors[2] for row in adjugate]
        at, nearest = np.where(definite, hint * share, at), np.where(definite, np.stack(X), nearest)
    return Margin(form, list(C), v, list(nearest), at, np.where(at == 0, side, at))


def _proved(boxes: Boxes, at: Floats, X: list[Floats], C: list[Floats]) -> Mask:
    """Mark the goals that certificates of the worst corners exclude; all goals leave a side, or all reach one."""
    points = [_enclosed(part) for part in boxes.middle]
    whole = [Enclosures(low, high) for low, high in zip(boxes.low, boxes.high, strict=True)]
    form = Form([_enclosed(size) for size in boxes.sizes], KIND.root)
    place = Place(KIND, form, (points[:3], points[3:]), (whole[:3], whole[3:]), list(boxes.radii))
    if boxes.leave[0]:
        return np.asarray(stays_clear(place, at))
    plain, axis = Form(list(boxes.sizes), np.sqrt), list(boxes.middle[3:])
    q = [-boxes.side * part for part in plain.gradient(X)]
    width = plain.width(axis, q)
    step = [part / width for part in plain.sigma_times(axis, q)]
    bend = plain.gradient(step)
    turn = -dot(bend, C) / dot(bend, step)
    shares = np.ones(len(turn)), (1 + np.minimum(np.abs(at * width), 1)) / 2, np.clip(turn, 0, 1)
    return np.asarray(stays_off(place, boxes.side, q, shares))
