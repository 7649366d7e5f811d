"""Where an implementation claims to be right; rows elsewhere are skipped, not judged."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.rows import Rows

REGIMES = ("a>=1", "c2>=a")
"""The paper's hypotheses: α/b ≥ 1, and (γ/d)² ≥ α/b."""

NORMAL_RANGE: dict[str, tuple[float, float]] = {
    "float16": (2.0**-14, 65504.0),
    "bfloat16": (2.0**-126, (2 - 2.0**-7) * 2.0**127),
    "float32": (2.0**-126, (2 - 2.0**-23) * 2.0**127),
    "float64": (2.0**-1022, float(np.finfo(np.float64).max)),
}
"""The least and the greatest normal number of each format; wider formats hold every float64 as a normal number."""

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Domain:
    """The rows a method speaks of: every regime named holds, α/b and γ/d lie in `ratio`, lengths in `magnitude`.

    Bounds are inclusive. The least magnitude is one of semi-axes: a coordinate may be as near to 0 as it likes, for a
    centre close to the axis or to the waist is nothing out of the ordinary. Undeclared, the domain is every regime,
    ratios from 1e-8 to 1e8 and magnitudes from 1e-6 to 1e6. Raises InputError where a regime is unknown or a range is
    empty.
    """

    regimes: tuple[str, ...] = ()
    ratio: tuple[float, float] = (1e-8, 1e8)
    magnitude: tuple[float, float] = (1e-6, 1e6)

    def __post_init__(self) -> None:
        for regime in self.regimes:
            if regime not in REGIMES:
                raise InputError(f"the domain names the regime {regime!r}; it must be one of {', '.join(REGIMES)}")
        for name, (low, high) in (("ratio", self.ratio), ("magnitude", self.magnitude)):
            if not 0 <= low <= high:
                raise InputError(f"the domain's {name} is [{low}, {high}]; it must be two numbers with 0 ≤ low ≤ high")

    def holds(self, rows: Rows) -> Mask:
        """A mask (n,) of the rows inside the domain."""
        alpha, gamma, b, d = rows[:, :4].T
        with np.errstate(over="ignore", under="ignore"):
            inside = _between(alpha / b, self.ratio) & _between(gamma / d, self.ratio)
        least, greatest = self.magnitude
        inside &= (rows[:, :4] >= least).all(axis=1) & (np.abs(rows) <= greatest).all(axis=1)
        for regime in self.regimes:
            inside &= in_regime(rows, regime)
        return inside


EVERYWHERE = Domain(ratio=(0.0, np.inf), magnitude=(0.0, np.inf))


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
    return np.asarray((_between(np.abs(rows), limits) | (rows == 0)).all(axis=1))


def _between(values: NDArray[np.float64], limits: tuple[float, float]) -> Mask:
    return np.asarray((values >= limits[0]) & (values <= limits[1]))
