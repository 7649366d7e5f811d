"""The plain numpy expressions that the kernels are held to: Table 2 as one types it, and with products for powers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Sizes = tuple[float, float, float, float]


def with_powers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> NDArray[np.int8]:
    """Whether each centre is exterior, `**2` and `**3` as they stand in the paper. The paper's formula: no proof."""
    alpha, gamma, b, d = sizes
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    c0 = -A * B
    P, Q = (x**2 + y**2) / b**2, (z / d) ** 2
    c1 = c0 + A - B + B * P - A * Q
    c2 = A - B + 1 - P - Q
    delta = -4 * c2**3 * c0 + (c2 * c1) ** 2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2
    return np.asarray((delta > 0) & (c2 < 0) & (c1 > 0)).view(np.int8)


def with_products(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> NDArray[np.int8]:
    """The same with products in the place of powers, which numpy computes by a function of the C library."""
    alpha, gamma, b, d = sizes
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    c0, bb, dd = -A * B, b * b, d * d
    P, Q = (x * x + y * y) / bb, z * z / dd
    c1 = c0 + A - B + B * P - A * Q
    c2 = A - B + 1 - P - Q
    c21 = c2 * c1
    delta = -4 * c2 * c2 * c2 * c0 + c21 * c21 + 18 * c21 * c0 - 4 * c1 * c1 * c1 - 27 * c0 * c0
    return np.asarray((delta > 0) & (c2 < 0) & (c1 > 0)).view(np.int8)
