"""How simple a row is to read, and the simplest rows there are."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from functools import lru_cache
from itertools import product

import numpy as np

from hypcheck.rows import Rows

Row = tuple[float, ...]
Complexity = tuple[int, int, int]

DIGITS = range(1, 17)
"""Significant digits to which a number is tried to be rounded; 17 are the number itself."""

LARGEST_SUM = 1e15
"""Sums of sizes beyond this are not told apart."""


@lru_cache(maxsize=1 << 16)
def characters(value: float) -> int:
    """The length of the shortest decimal text that reads back as `value` (2, 0.5, 1e-7, 3e6); 0 for a zero."""
    if value == 0:
        return 0
    number = Decimal(repr(value)).normalize()
    digits, leading = len(number.as_tuple().digits), number.adjusted()
    last = leading - digits + 1  # the power of ten of the last digit
    plain = max(leading, 0) + 1 + (1 - last if last < 0 else 0)
    scientific = digits + (digits > 1) + len(f"e{leading}")
    return (value < 0) + min(plain, scientific)


def complexity(row: Sequence[float]) -> Complexity:
    """What is less for a simpler row: the characters of all its numbers, those of the longest, the sum of the sizes."""
    lengths = [characters(value) for value in row]
    return sum(lengths), max(lengths), int(min(sum(map(abs, row)), LARGEST_SUM))


def simpler_than(rows: Iterable[Row], limit: Complexity) -> Rows:
    """The different valid rows below a complexity, float64 (n, 7), the simplest first."""
    found = {row: complexity(row) for row in set(rows) if _valid(row)}
    chosen = sorted((row for row in found if found[row] < limit), key=lambda row: (found[row], row))
    return np.array(chosen, dtype=np.float64).reshape(-1, 7)


def rounded(value: float) -> Iterator[float]:
    """`value` to 1, 2, 3 … significant digits: the nearest, and its neighbours to both sides."""
    for digits in DIGITS:
        text = f"{value:.{digits - 1}e}"
        unit = float(f"1{text[text.index('e') :]}") / 10 ** (digits - 1)
        for steps in (0, 1, -1):
            yield float(f"{float(text) + steps * unit:.{digits - 1}e}")


def simplest_below(limit: Complexity) -> Rows:
    """The rows of small whole numbers and halves, one length of each unit 1, below a complexity; the simplest first."""
    rows, complexities = _simplest()
    return rows[: bisect_left(complexities, limit)]


@lru_cache(maxsize=1)
def _simplest() -> tuple[Rows, list[Complexity]]:
    sizes = [(1.0, 1.0), *((float(size), 1.0) for size in range(2, 7)), *((1.0, float(size)) for size in range(2, 7))]
    far, near = [half / 2 for half in range(17)], [0.0, 0.5, 1.0, 1.5, 2.0, 3.0]
    rows = simpler_than(
        (
            (alpha, gamma, b, d, x, y, z)
            for (alpha, b), (gamma, d), x, y, z in product(sizes, sizes, far, near, near)
            if y <= x
        ),
        (99, 99, 99),
    )
    return rows, [complexity(row) for row in rows.tolist()]


def _valid(row: Row) -> bool:
    return all(map(math.isfinite, row)) and min(row[:4]) > 0
