"""Medians of ratios with honest intervals: the percentile bootstrap over processes, and over rounds inside them.

Samples come in rounds of several fresh processes. Rounds of one process share what that process happened to be given
(addresses, a core), so processes are drawn first, then rounds inside each drawn one: an interval from rounds alone
would take twenty looks at one accident for twenty accidents. The draws are of a fixed seed, so the same samples always
give the same interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

DRAWS = 2000
CONFIDENCE = 0.95
_SEED = 20_230_917

LEAST_NS = 0.01
"""No sample is as short: a byte of an answer takes longer to write. What is left of a time from which an empty call was
taken off may be, where noise made that call take longer; it says nothing of the work."""

Samples = Sequence[Sequence[float]]
"""A number for each round, for each process."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A median and its 95 % interval."""

    median: float
    low: float
    high: float

    @property
    def half_width(self) -> float:
        """How far the interval reaches from 1 to its farther side, as a factor less 1: 0.02 for 0.98 … 1.01."""
        return max(self.high, 1 / self.low if self.low > 0 else np.inf) - 1


def estimate(samples: Samples) -> Estimate:
    """The median of all samples with the interval of the bootstrap. Raises ValueError where there is no sample."""
    medians = resampled_medians(samples)
    tail = (1 - CONFIDENCE) / 2
    low, high = np.quantile(medians, (tail, 1 - tail))
    middle = float(np.median(np.concatenate([np.asarray(part, dtype=np.float64) for part in samples])))
    return Estimate(middle, min(float(low), middle), max(float(high), middle))


def ratios(samples: Samples, reference: Samples) -> list[list[float]]:
    """Round by round, how often longer than the reference: processes and rounds of both go together in order.

    A round in which either has an impossible sample has no ratio.
    """
    return [
        [mine / theirs for mine, theirs in zip(own, other, strict=False) if min(mine, theirs) > LEAST_NS]
        for own, other in zip(samples, reference, strict=False)
    ]


def resampled_medians(samples: Samples, seed: int = _SEED) -> NDArray[np.float64]:
    """The medians of DRAWS resamples: (DRAWS,). Raises ValueError where there is no sample."""
    parts = [np.asarray(part, dtype=np.float64) for part in samples if len(part)]
    if not parts:
        raise ValueError("there is no sample")
    places, short = _draws(tuple(map(len, parts)), seed)
    picked = np.concatenate(parts)[places]
    if short is not None:
        return np.asarray(np.nanmedian(np.where(short, np.nan, picked), axis=1))
    return np.asarray(np.median(picked, axis=1))


@lru_cache(maxsize=16)
def _draws(lengths: tuple[int, ...], seed: int) -> tuple[NDArray[np.int64], NDArray[np.bool_] | None]:
    """For each resample the places of what it draws, of all samples in a row; and which of these there are not.

    A process that was cut short has fewer rounds. Samples of one run are alike in their numbers, and drawn alike.
    """
    generator = np.random.Generator(np.random.PCG64(seed))
    number, rounds, each = len(lengths), max(lengths), np.array(lengths)
    drawn = generator.integers(0, number, (DRAWS, number))[..., None]
    shares = generator.random((DRAWS, number, rounds))
    starts = np.cumsum(each) - each
    places = (starts[drawn] + np.floor(shares * each[drawn]).astype(np.int64)).reshape(DRAWS, -1)
    missing = (np.arange(rounds) >= each[drawn]).reshape(DRAWS, -1)
    return places, missing if missing.any() else None
