"""From rational constructions to rows that float64 holds exactly.

Arrays of Python integers (dtype object) have no overflow, so a formula is written once, for a whole block. The radial
lengths (α, b, x, y) and the axial ones (γ, d, z) have each a unit of their own (pairs.Lengths), so a rational
construction becomes a row of integers by clearing denominators, and any power of two may be the unit. Where the
integers need more than the 53 bits of float64, the construction is drawn anew.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from hypcheck.casebook.draw import Draw, exponent, ldexp
from hypcheck.rows import Rows

Wholes = NDArray[np.object_]
Mask = NDArray[np.bool_]

RADIAL_COLUMNS = [0, 2, 4, 5]
AXIAL_COLUMNS = [1, 3, 6]
ATTEMPTS = 1000
"""The rarest rows wanted are 1 in 50, which takes some dozens of attempts for a block."""


def wholes(draw: Draw, n: int, low: int, high: int) -> Wholes:
    """Python integers from low to high, both included."""
    return draw.integers(n, low, high).astype(object)


def wholes_of_any_length(draw: Draw, n: int, bits: int) -> Wholes:
    """Python integers ≥ 1 of at most `bits` bits, each length as likely as the other."""
    return np.floor(draw.log_uniform(n, 0, bits)).astype(np.int64).astype(object)


def roots(values: Wholes) -> Wholes:
    """⌊√value⌋ of each integer ≥ 0."""
    return np.asarray(np.frompyfunc(math.isqrt, 1, 1)(values), dtype=object)


def triples(draw: Draw, n: int, most: int) -> tuple[Wholes, Wholes, Wholes]:
    """Pythagorean triples (leg, other leg, hypotenuse) from generators up to 2·most."""
    j = wholes(draw, n, 1, most)
    i = j + wholes(draw, n, 1, most)
    one, other = i * i - j * j, 2 * i * j
    swap = draw.signs(n) < 0
    return np.where(swap, other, one), np.where(swap, one, other), i * i + j * j


def turned(draw: Draw, n: int) -> tuple[Wholes, Wholes, Wholes]:
    """x, y and √(x² + y²), all integers: half of them on an axis, half anywhere."""
    x, y, radius = triples(draw, n, 4)
    on_axis = draw.signs(n) < 0
    return np.where(on_axis, 1, x), np.where(on_axis, 0, y), np.where(on_axis, 1, radius)


def to_rows(radial: Sequence[Wholes], axial: Sequence[Wholes]) -> tuple[Rows, Mask]:
    """The rows of α, b, x, y and γ, d, z without common factors, and which of them are exact, with sizes > 0."""
    rows = np.empty((len(radial[0]), 7))
    exact = np.ones(len(rows), dtype=np.bool_)
    for columns, lengths in ((RADIAL_COLUMNS, radial), (AXIAL_COLUMNS, axial)):
        together = np.stack(list(lengths))
        shared = np.maximum(reduce(np.gcd, together), 1)
        reduced = together // shared
        rows[:, columns] = reduced.T.astype(np.float64)
        exact &= np.asarray(abs(reduced) <= 2**53).all(axis=0) & np.asarray(reduced[:2] > 0).all(axis=0)
    return rows, exact


def gather(draw: Draw, n: int, attempt: Callable[[Draw, int], tuple[Rows, Mask]]) -> Rows:
    """n rows out of as many attempts as it takes; each attempt says which of its rows are wanted."""
    found: list[Rows] = [np.empty((0, 7))]
    missing = n
    for _ in range(ATTEMPTS):
        if missing == 0:
            return np.concatenate(found)
        rows, wanted = attempt(draw, max(2 * missing, 256))
        found.append(rows[wanted][:missing])
        missing -= len(found[-1])
    raise AssertionError(f"{ATTEMPTS} attempts of a construction left {missing} of {n} rows to be found")


def in_metres(draw: Draw, rows: Rows) -> Rows:
    """The same pairs in other coordinates: any signs, x and y swapped or not, both groups of lengths about 1."""
    n = len(rows)
    rows = rows.copy()
    for column in (4, 5, 6):
        rows[:, column] *= draw.signs(n)
    swap = draw.signs(n) < 0
    rows[:, 4:6] = np.where(swap[:, None], rows[:, 5:3:-1], rows[:, 4:6])
    for columns in (RADIAL_COLUMNS, AXIAL_COLUMNS):
        lengths = np.abs(rows[:, columns])
        greatest = lengths.max(axis=1)
        least = np.where(lengths == 0, greatest[:, None], lengths).min(axis=1)
        unit = draw.integers(n, -3, 3) - (exponent(greatest) + exponent(least)) // 2
        rows[:, columns] = ldexp(rows[:, columns], unit[:, None])
    return rows + 0.0
