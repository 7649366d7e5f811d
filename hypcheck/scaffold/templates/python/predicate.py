"""The predicate under test: a function of many rows at once, called by hypcheck in a process of its own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# What it claims. "question" may be position (+1 exterior, 0 contact, -1 interior), exterior, interior or contact
# (1 yes, 0 no). Table 2 claims to be right where (gamma/d)² ≥ alpha/b; without "domain" all sizes are asked.
# With "tilt": True it is asked about tilted spheroids: rows are (n, 10) then, and tilted answers all of them.
hypcheck = {
    "protocol": 1,
    "name": "@NAME@",
    "version": "0.0.0",
    "language": "python",
    "precision": "float64",
    "question": "exterior",
    "domain": {"regimes": ["c2>=a"]},
}


def classify(rows: NDArray[np.float64]) -> NDArray[np.int8]:
    """Answers, int8 (n,), to rows of alpha, gamma, b, d, x, y, z, float64 (n, 7)."""
    with np.errstate(all="ignore"):
        return predicate(*rows.T) if rows.shape[1] == 7 else tilted(*rows.T)


def predicate(*columns: NDArray[np.float64]) -> NDArray[np.int8]:
    """Whether each spheroid with semi-axes b, b, d and centre (x, y, z) is exterior to x²/α² + y²/α² − z²/γ² = 1.

    Replace this with your predicate, or with a call of it. The stub is Table 2 (Procedure 1) of "Algorithms for
    Determining Relative Position between Spheroids and Hyperboloids with One Sheet": right in the paper's scenes, wrong
    on the ring, where its discriminant vanishes far from the surface.
    """
    alpha, gamma, b, d, x, y, z = columns
    A = (alpha / b) * (alpha / b)
    B = (gamma / d) * (gamma / d)
    c0 = -(A * B)
    C = c0 + A - B

    P = (x * x + y * y) / (b * b)
    Q = (z / d) * (z / d)
    c1 = C + B * P - A * Q
    c2 = A - B + 1 - P - Q
    delta = -4 * (c2 * c2 * c2) * c0 + (c2 * c1) * (c2 * c1) + 18 * c2 * c1 * c0 - 4 * (c1 * c1 * c1) - 27 * (c0 * c0)
    return np.asarray((delta > 0) & (c2 < 0) & (c1 > 0), dtype=np.int8)


def tilted(*columns: NDArray[np.float64]) -> NDArray[np.int8]:
    """The same with the spheroids' axes of revolution, axis_x, axis_y, axis_z, after the other columns.

    They are vectors of any length and sign, upright where axis_x = axis_y = 0. The stub ignores them: wrong as soon as
    a spheroid is tilted.
    """
    return predicate(*columns[:7])
