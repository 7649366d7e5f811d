"""A sum of two floats and what its rounding left out: exact, since float64 sums lose a float64 (Knuth's TwoSum)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def two_sum(left: Floats, right: Floats) -> tuple[Floats, Floats]:
    """left + right rounded, and the exact rest; NaN where the sum leaves float64."""
    total = left + right
    back = total - left
    return total, (left - (total - back)) + (right - back)
