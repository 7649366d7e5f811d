"""Medians of ratios with honest intervals: the percentile bootstrap over processes, and over rounds inside them.

Samples come in rounds of several fresh processes. Rounds of one process share what that process happened to be given
(addresses, a core), so processes are drawn first, then rounds inside each drawn one: an interval from rounds alone
would take twenty looks at one accident for twenty accidents. The draws are of a fixed seed, so the same samples always
give the same interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

DRAWS = 2000
CONFIDENCE = 0.95
_SEED = 20_230_917

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
    """Round by round, how often longer than the reference: processes and rounds of both go together in order."""
    return [
        [mine / theirs for mine, theirs in zip(own, other, strict=False) if theirs > 0]
        for own, other in zip(samples, reference, strict=False)
    ]


def resampled_medians(samples: Samples, seed: int = _SEED) -> NDArray[np.float64]:
    """The medians of DRAWS resamples: (DRAWS,)."""
    parts = [np.asarray(part, dtype=np.float64) for part in samples if len(part)]
    if not parts:
        raise ValueError("there is no sample")
    generator = np.random.Generator(np.random.PCG64(seed))
    rounds = max(map(len, parts))
    table = np.stack([np.pad(part, (0, rounds - len(part))) for part in parts])
    lengths = np.array([len(part) for part in parts])
    drawn = generator.integers(0, len(parts), (DRAWS, len(parts)))
    shares = generator.random((DRAWS, len(parts), rounds))
    picked = table[drawn[..., None], np.floor(shares * lengths[drawn][..., None]).astype(np.int64)]
    if (lengths < rounds).any():  # a process that was cut short has fewer rounds
        picked = np.where(np.arange(rounds) < lengths[drawn][..., None], picked, np.nan)
        return np.asarray(np.nanmedian(picked.reshape(DRAWS, -1), axis=1))
    return np.asarray(np.median(picked.reshape(DRAWS, -1), axis=1))
