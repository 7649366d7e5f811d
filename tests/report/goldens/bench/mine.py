"""The dual form by bisection in float32: a method to measure beside others."""

from __future__ import annotations

import numpy as np

hypcheck = {"precision": "float32"}


def position(rows):
    """Decide by the best of 30 halvings of each half of the interval."""
    alpha, gamma, b, d, x, y, z = rows.astype(np.float32).T
    A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2
    inside = P * B < B * A + Q * A
    low, high = np.where(inside, -A, 0), np.where(inside, 0, B)
    with np.errstate(all="ignore"):
        for _ in range(30):
            middle = (low + high) / 2
            rising = P * A / (A + middle) ** 2 > Q * B / (B - middle) ** 2 + 1
            low, high = np.where(rising, middle, low), np.where(rising, high, middle)
        clear = P * low / (A + low) - Q * low / (B - low) - 1 - low > 0
    return np.where(clear, np.sign(low), 0).astype(np.int8)
