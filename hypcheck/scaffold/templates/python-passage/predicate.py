"""The predicate under test: a function of many rows at once, called by hypcheck in a process of its own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# What it claims. With "times": True, classify returns the times too; with "tilt": True it is asked about spheroids that
# are tilted: rows are (n, 13) then, and tilted answers all of them.
hypcheck = {
    "protocol": 1,
    "name": "@NAME@",
    "version": "0.0.0",
    "language": "python",
    "precision": "float64",
    "question": "passage",
}


def classify(
    rows: NDArray[np.float64],
) -> NDArray[np.int8] | tuple[NDArray[np.int8], NDArray[np.float64]]:
    """Hits, int8 (n,), and times, to rows of alpha, gamma, b, d, x0, y0, z0, x1, y1, z1, float64 (n, 10)."""
    with np.errstate(all="ignore"):
        times = predicate(*rows.T) if rows.shape[1] == 10 else tilted(*rows.T)
    hits = np.asarray(times >= 0, dtype=np.int8)
    return (hits, times) if hypcheck.get("times") else hits


def predicate(*columns: NDArray[np.float64]) -> NDArray[np.float64]:
    """When each spheroid, on its way from (x0, y0, z0) at time 0 to (x1, y1, z1) at time 1, first touches the surface.

    The spheroid has semi-axes b, b, d, the surface is x²/α² + y²/α² − z²/γ² = 1. Times from 0 to 1; NaN where it is
    clear all the way. Replace this with your predicate, or with a call of it. The stub takes the spheroid for its
    centre: right where that goes through the wall, though late, and wrong where only the body touches it.
    """
    alpha, gamma, _, _, x0, y0, z0, x1, y1, z1 = columns
    x, y, z = x0 / alpha, y0 / alpha, z0 / gamma
    u, v, w = (x1 - x0) / alpha, (y1 - y0) / alpha, (z1 - z0) / gamma
    p, q, r = u * u + v * v - w * w, x * u + y * v - z * w, x * x + y * y - z * z - 1
    root = np.sqrt(q * q - p * r)  # p t² + 2 q t + r = 0
    s = -(q + np.copysign(root, q))
    first, last = np.fmin(s / p, r / s), np.fmax(s / p, r / s)
    chosen = np.where((first >= 0) & (first <= 1), first, last)
    return np.where((chosen >= 0) & (chosen <= 1), chosen, np.nan)


def tilted(*columns: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same with the spheroids' axes of revolution, axis_x, axis_y, axis_z, after the other columns.

    They are vectors of any length and sign, the same all the way. The stub ignores them.
    """
    return predicate(*columns[:10])
