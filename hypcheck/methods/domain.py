"""Where an implementation claims to be right; rows elsewhere are skipped, not judged."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import product

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.ranges import ORDINARY_MAGNITUDE, ORDINARY_RATIO, UNBOUNDED, FixedSizes, Range, within
from hypcheck.rows import Rows

REGIMES = ("a>=1", "c2>=a")
"""The paper's hypotheses: α/b ≥ 1, and (γ/d)² ≥ α/b."""

NORMAL_RANGE: dict[str, Range] = {
    "float16": (2.0**-14, 65504.0),
    "bfloat16": (2.0**-126, (2 - 2.0**-7) * 2.0**127),
    "float32": (2.0**-126, (2 - 2.0**-23) * 2.0**127),
    "float64": (2.0**-1022, float(np.finfo(np.float64).max)),
}
"""The least and the greatest normal number of each format; wider formats hold every float64 as a normal number."""

Mask = NDArray[np.bool_]

_CORNERS = np.array([(*sizes, center, center, center) for *sizes, center in product((0, 1), repeat=5)])
"""Least or greatest, of four sizes and of the centre."""


@dataclass(frozen=True, slots=True)
class Domain:
    """The rows a method speaks of: every regime named holds, α/b and γ/d lie in `ratio`, lengths in `magnitude`.

    Bounds are inclusive, as ranges.within has them. None is a range that was not declared: the ordinary one, or, where
    more is asked for, every one. `settings` names the only sizes there are, each with the spans of its centre; no range
    holds then that was not declared. Raises InputError where a regime is unknown or a range is empty.
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
                told = f"[{limits[0]}, {limits[1]}]"
                raise InputError(f"the domain's {name} is {told}; it must be two numbers with 0 ≤ low ≤ high")

    def holds(self, rows: Rows, *, extreme: bool = False) -> Mask:
        """A mask (n,) of the rows inside the domain.

        `extreme`: they are of a family that is asked only when it is asked for, so what was not declared is unbounded.
        """
        unbounded = extreme or self.settings
        ratio, magnitude = (UNBOUNDED, UNBOUNDED) if unbounded else (ORDINARY_RATIO, ORDINARY_MAGNITUDE)
        inside = within(rows, self.ratio or ratio, self.magnitude or magnitude)
        for regime in self.regimes:
            inside &= in_regime(rows, regime)
        if self.settings:
            inside &= np.logical_or.reduce([setting.holds(rows) for setting in self.settings])
        return inside


EVERYWHERE = Domain(ratio=UNBOUNDED, magnitude=UNBOUNDED)


def in_regime(rows: Rows, regime: str) -> Mask:
    """A mask (n,) of the rows in a regime of REGIMES, decided exactly."""
    alpha, gamma, b, d = rows[:, :4].T
    if regime == "a>=1":
        return np.asarray(alpha >= b)
    with np.errstate(all="ignore"):
        left, right = (gamma / d) ** 2, alpha / b
        # At most 4 roundings between the two sides, when nothing under- or overflows: outside 16u floats decide.
        trusted = (left > 2.0**-900) & (left < 2.0**900) & (right > 2.0**-900) & (right < 2.0**900)
        margin = 1 + 16 * 2.0**-53
        holds, fails = trusted & (left > margin * right), trusted & (right > margin * left)
    for index in np.flatnonzero(~(holds | fails)):
        sizes = [Fraction(value) for value in rows[index, :4].tolist()]
        holds[index] = (sizes[1] / sizes[3]) ** 2 >= sizes[0] / sizes[2]
    return np.asarray(holds)


def representable(rows: Rows, precision: str) -> Mask:
    """A mask (n,) of the rows whose every number is zero or normal in the declared precision."""
    limits = NORMAL_RANGE.get(precision)
    if limits is None:
        return np.ones(len(rows), dtype=bool)
    lengths = np.abs(rows)
    return np.asarray((((lengths >= limits[0]) & (lengths <= limits[1])) | (rows == 0)).all(axis=1))


def claimed(rows: Rows, domain: Domain, precision: str, *, extreme: bool = False) -> NDArray[np.intp]:
    """The places of the rows that lie in the domain and can be written in the declared precision, ascending.

    `extreme` is as in Domain.holds.
    """
    with np.errstate(all="ignore"):
        if not domain.settings:
            corners = _corners(rows)
            if (domain.holds(corners, extreme=extreme) & representable(corners, precision)).all():
                return np.arange(len(rows))
        return np.flatnonzero(domain.holds(rows, extreme=extreme) & representable(rows, precision))


def _corners(rows: Rows) -> Rows:
    """Rows (32, 7) of the extremes of |rows|: all combinations of sizes, with the least and the greatest centre.

    Each condition of a domain, its settings apart, is monotone in each length, and so is what a precision can write,
    a zero apart, which it always can: what holds of these rows holds of all.
    """
    lengths = np.abs(rows.T)
    least, greatest = lengths.min(axis=1, initial=np.inf), lengths.max(axis=1, initial=0.0)
    for index in np.flatnonzero(least == 0):
        least[index] = lengths[index][lengths[index] > 0].min(initial=greatest[index])
    return np.asarray(np.stack([least, greatest])[_CORNERS, np.arange(7)])
