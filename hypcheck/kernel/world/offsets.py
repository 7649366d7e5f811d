"""Exact positions from a hyperboloid's centre, though the difference of two floats is rounded.

A centre seen from another is x − x₀, and that is no float64 as a rule. Its rounding error, though, is one, and is known
(TwoSum): where it is 0 the difference is exact and the fast path answers. Elsewhere the difference lies between two
neighbouring floats. The exterior positions are an up-set when |x| and |y| grow and |z| falls, the interior ones when
|x| and |y| fall and |z| grows: when the two extreme corners of that box have one position, it is the answer; else the
exact difference is taken in integers.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel import integers
from hypcheck.kernel.classify import classify
from hypcheck.kernel.world.sums import two_sum
from hypcheck.pairs import Lengths, to_integers
from hypcheck.rows import Positions, Rows

Floats = NDArray[np.float64]


def positions(sizes: Rows, centres: Rows, origins: Rows) -> Positions:
    """The exact position of each mover, int8 (n,): sizes (n, 4), and both centres (n, 3) in the scene's coordinates."""
    with np.errstate(all="ignore"):
        offset, error = two_sum(centres, -origins)
    beyond = np.logical_not((np.abs(offset) < np.finfo(np.float64).max).all(axis=1))  # no float64, or none above it
    result = classify(np.concatenate([sizes, np.where(beyond[:, None], 0.0, offset)], axis=1))
    rounded = np.flatnonzero((error != 0).any(axis=1) & ~beyond)
    if len(rounded):
        result[rounded] = _between(sizes[rounded], offset[rounded], centres[rounded], origins[rounded])
    for index in np.flatnonzero(beyond).tolist():
        result[index] = exact_position(sizes[index].tolist(), centres[index].tolist(), origins[index].tolist())
    return result


def _between(sizes: Rows, offset: Floats, centres: Rows, origins: Rows) -> Positions:
    size = np.abs(offset)
    less, more = np.nextafter(size, 0.0), np.nextafter(size, np.inf)
    outermost = classify(np.concatenate([sizes, more[:, :2], less[:, 2:]], axis=1))
    innermost = classify(np.concatenate([sizes, less[:, :2], more[:, 2:]], axis=1))
    result = outermost.copy()
    for index in np.flatnonzero(outermost != innermost).tolist():
        result[index] = exact_position(sizes[index].tolist(), centres[index].tolist(), origins[index].tolist())
    return result


def exact_position(sizes: list[float], centre: list[float], origin: list[float]) -> int:
    """The position about the exact difference of two centres, in integers."""
    alpha, gamma, b, d = sizes
    x, y, z = (Fraction(there) - Fraction(here) for there, here in zip(centre, origin, strict=True))
    radial = to_integers((Fraction(alpha), Fraction(b), x, y))
    axial = to_integers((Fraction(gamma), Fraction(d), z))
    return int(integers.position(Lengths(radial[0], radial[1], radial[2], radial[3], *axial)))
