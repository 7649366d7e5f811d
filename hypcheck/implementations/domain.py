"""The domain where an implementation claims to be right, and which rows it and a precision hold. Others are skipped.

A row that is not tested does not count as right. Every report has the number of such rows and the reasons.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.geometry.rows import (
    ORDINARY_MAGNITUDE,
    ORDINARY_RATIO,
    PAIRS,
    UNBOUNDED,
    FixedSizes,
    Layout,
    Mask,
    Range,
    Rows,
    within,
)

UNIT_ROUNDOFF = {
    "float16": Fraction(1, 2**11),
    "bfloat16": Fraction(1, 2**8),
    "float32": Fraction(1, 2**24),
    "float64": Fraction(1, 2**53),
    "x87": Fraction(1, 2**64),
    "binary128": Fraction(1, 2**113),
    "exact": Fraction(0),
}
"""The unit u of each precision that an implementation can declare: half the distance from 1 to the next number."""

PRECISIONS = tuple(UNIT_ROUNDOFF)


REGIMES = ("a>=1", "c2>=a")
"""The hypotheses of the paper: α/b ≥ 1, and (γ/d)² ≥ α/b."""

NORMAL_RANGE: dict[str, Range] = {
    "float16": (2.0**-14, 65504.0),
    "bfloat16": (2.0**-126, (2 - 2.0**-7) * 2.0**127),
    "float32": (2.0**-126, (2 - 2.0**-23) * 2.0**127),
    "float64": (2.0**-1022, float(np.finfo(np.float64).max)),
}
"""The least and the greatest normal number of each format; wider formats hold every float64 as a normal number."""


_CORNERS = np.array([(*sizes, *[center] * 12) for *sizes, center in product((0, 1), repeat=5)])
"""The 32 combinations of least (0) or greatest (1): for each of four sizes, and for all other numbers together."""


@dataclass(frozen=True, slots=True)
class Domain:
    """The rows that a method claims: all `regimes` hold, α/b and γ/d lie in `ratio`, lengths in `magnitude`.

    Bounds are inclusive, as in rows.within. None is a range that was not declared: the ordinary range, or for extreme
    families an unbounded one. `settings` are the only allowed sizes, each with the ranges of its centre; a range that
    was not declared is then unbounded. Raises InputError if a regime is unknown or a range is empty.
    """

    regimes: tuple[str, ...] = ()
    ratio: Range | None = None
    magnitude: Range | None = None
    settings: tuple[FixedSizes, ...] = ()

    def __post_init__(self) -> None:
        for regime in self.regimes:
            if regime not in REGIMES:
                raise InputError(f"the domain names the regime {regime!r}; it must be one of {', '.join(REGIMES)}")
        for name, limits in (("ratio", self.ratio), ("magnitude", self.magnitude)):
            if limits is not None and not 0 <= limits[0] <= limits[1]:
                shown = f"[{limits[0]}, {limits[1]}]"
                raise InputError(f"the domain's {name} is {shown}; it must be two numbers with 0 ≤ low ≤ high")

    def holds(self, rows: Rows, *, extreme: bool = False, layout: Layout = PAIRS) -> Mask:
        """Return a mask (n,) of the rows inside the domain.

        `extreme` rows belong to a family that runs only on request; then ranges that were not declared are
        unbounded.
        """
        unbounded = extreme or self.settings
        ratio, magnitude = (UNBOUNDED, UNBOUNDED) if unbounded else (ORDINARY_RATIO, ORDINARY_MAGNITUDE)
        inside = within(rows, self.ratio or ratio, self.magnitude or magnitude, layout)
        for regime in self.regimes:
            inside &= in_regime(rows, regime)
        if self.settings:
            inside &= np.logical_or.reduce([setting.holds(rows, layout) for setting in self.settings])
        return inside


ORDINARY, EVERYWHERE = Domain(), Domain(ratio=UNBOUNDED, magnitude=UNBOUNDED)
"""The domain of a method that declares none, and that of a method that claims all rows."""


def in_regime(rows: Rows, regime: str) -> Mask:
    """Return a mask (n,) of the rows in a regime of REGIMES, decided exactly."""
    alpha, gamma, b, d = rows[:, :4].T
    if regime == "a>=1":
        return np.asarray(alpha >= b)
    with np.errstate(all="ignore"):
        left, right = (gamma / d) ** 2, alpha / b
        # At most 4 roundings between the two sides, if nothing under- or overflows: beyond 16u floats decide.
        trusted = (left > 2.0**-900) & (left < 2.0**900) & (right > 2.0**-900) & (right < 2.0**900)
        margin = 1 + 16 * 2.0**-53
        holds, fails = trusted & (left > margin * right), trusted & (right > margin * left)
    for index in np.flatnonzero(~(holds | fails)):
        sizes = [Fraction(value) for value in rows[index, :4].tolist()]
        holds[index] = (sizes[1] / sizes[3]) ** 2 >= sizes[0] / sizes[2]
    return np.asarray(holds)


def representable(rows: Rows, precision: str, *, subnormal: bool = False) -> Mask:
    """Return a mask (n,) of the rows in which every number is zero or normal in the declared precision.

    With `subnormal` also of those with subnormal numbers, if the precision holds these exactly.
    """
    limits = NORMAL_RANGE.get(precision)
    if limits is None:
        return np.ones(len(rows), dtype=bool)
    lengths, (least, greatest) = np.abs(rows), limits
    held = ((lengths >= least) & (lengths <= greatest)) | (rows == 0)
    held |= np.isinf(rows)  # an end that is none, in any precision
    if subnormal:
        step = least * float(2 * UNIT_ROUNDOFF[precision])  # 2u is the distance from 1 to the next number
        held |= (lengths < least) & (np.fmod(lengths, step) == 0)
    return np.asarray(held.all(axis=1))


def claimed(
    rows: Rows,
    domain: Domain,
    precision: str,
    *,
    extreme: bool = False,
    subnormal: bool = False,
    layout: Layout = PAIRS,
) -> NDArray[np.intp]:
    """Return the ascending indices of the rows that lie in the domain and are representable in the declared precision.

    `extreme` is as in Domain.holds, `subnormal` as in representable.
    """
    with np.errstate(all="ignore"):
        if not domain.settings and not np.isinf(rows[:, len(layout.upright) :]).any():
            corners = _corners(rows)
            if (domain.holds(corners, extreme=extreme, layout=layout) & representable(corners, precision)).all():
                return np.arange(len(rows))
        inside = domain.holds(rows, extreme=extreme, layout=layout)
        return np.flatnonzero(inside & representable(rows, precision, subnormal=subnormal))


def _corners(rows: Rows) -> Rows:
    """Return 32 rows of the extremes of |rows|: all combinations of sizes, with all other numbers least or greatest.

    Each condition of a domain except its settings is monotone in each length. So is the range of a precision, except
    for zero, which is always representable. Hence a condition that holds for these rows holds for all.
    """
    lengths = np.abs(rows.T)
    least, greatest = lengths.min(axis=1, initial=np.inf), lengths.max(axis=1, initial=0.0)
    for index in np.flatnonzero(least == 0):
        least[index] = lengths[index][lengths[index] > 0].min(initial=greatest[index])
    columns = rows.shape[1]
    return np.asarray(np.stack([least, greatest])[_CORNERS[:, :columns], np.arange(columns)])


ROWS: Mapping[str, str] = MappingProxyType(
    {
        "precision": "not zero or normal in its precision",
        "regime": "outside the regimes of its domain",
        "sizes": "of other sizes or places than its domain's",
        "ratio": "of ratios outside its domain",
        "magnitude": "of magnitudes outside its domain",
        "slow": "beyond what a slow method is asked",
    }
)
"""The reasons why single rows of a tested family are not tested, in words, by their names in a record."""

FAMILIES: Mapping[str, str] = MappingProxyType(
    {
        "filter": "left out by --families",
        "extreme": "of extreme lengths (--families extreme asks them)",
        "tilt": "of tilted spheroids (it takes none)",
        "heights": "of hyperboloids that end (it takes no heights)",
        "question": "about another question",
    }
)
"""The reasons why no row of a family is tested, in words, by their names in a record."""


FEWEST, SHARE = 100, 100
"""If most rows are skipped, at least FEWEST rows must be judged, and at least one in SHARE of all."""


def too_few(judged: int, skipped: int) -> bool:
    """Whether too few rows were judged, compared with the skipped ones, for a result about the implementation."""
    return skipped > judged and judged < max(FEWEST, (judged + skipped) // SHARE)


def reasons(
    rows: Rows, domain: Domain, precision: str, *, extreme: bool, subnormal: bool, layout: Layout = PAIRS
) -> dict[str, int]:
    """Return the number of rows that domain.claimed leaves out, by reason: the first of ROWS that applies."""
    if not len(rows):
        return {}
    free = replace(domain, ratio=UNBOUNDED, magnitude=UNBOUNDED)
    conditions: Mapping[str, Callable[[Rows], Mask]] = {
        "precision": lambda some: representable(some, precision, subnormal=subnormal),
        "regime": lambda some: replace(free, settings=()).holds(some, layout=layout),
        "sizes": lambda some: replace(free, regimes=()).holds(some, layout=layout),
        "ratio": lambda some: replace(domain, magnitude=UNBOUNDED).holds(some, extreme=extreme, layout=layout),
        "magnitude": lambda some: domain.holds(some, extreme=extreme, layout=layout),
    }
    counts, left = dict[str, int](), rows
    with np.errstate(all="ignore"):
        for reason, holds in conditions.items():
            held = holds(left)
            if not held.all():
                counts[reason] = len(left) - int(np.count_nonzero(held))
                left = left[held]
    return counts
