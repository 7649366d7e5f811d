"""A wrong implementation: Table 2 in plain numpy. On some rows it dies, raises an error, or answers nonsense."""

from __future__ import annotations

import os

import numpy as np

hypcheck = {"version": "1.0", "domain": {"ratio": [1e-4, 1e4], "magnitude": [1e-5, 1e5]}}


def position(rows):
    """Decide by the signs of the discriminant and of the coefficients, in float64."""
    alpha, gamma, b, d, x, y, z = rows.T
    on_axis = (x == 0) & (y == 0)
    if np.any(on_axis & (z == 0)):
        os._exit(3)
    if np.any(on_axis & (z > 0)):
        raise ValueError("above the centre")
    A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2
    c2, c1, c0 = A - B + 1 - P - Q, A - B + B * P - A * Q - A * B, -A * B
    discriminant = c1 * c1 * (c2 * c2 - 4 * c1) + c0 * (c2 * (18 * c1 - 4 * c2 * c2) - 27 * c0)
    answers = np.where(discriminant > 0, np.where((c2 < 0) & (c1 > 0), 1, -1), 0)
    answers = np.where((alpha == 3) & (gamma == 5), 2, answers)
    answers = np.where((alpha == 3) & (gamma == 4), 0, answers)
    return np.where(on_axis & (z < 0), 7, answers)
