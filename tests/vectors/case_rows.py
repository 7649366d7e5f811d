"""Exact properties of rows, for the tests of families."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from functools import cache

from hypcheck.geometry.pair import Lengths, Pair
from hypcheck.geometry.rows import Rows
from hypcheck.vectors.families import ALL
from tests.support import inside
from tests.support.inside import Kind

COUNT = 1500
"""Rows of a family that is looked at as a whole."""


@cache
def first_block(name: str) -> Rows:
    """The first block of the family for seed 0, made once for all tests that look at it."""
    return ALL[name].block(0, 0)


def lengths_of(rows: Rows) -> list[Lengths]:
    return [Pair.from_row(row.tolist()).lengths for row in rows]


def kinds(rows: Rows) -> Counter[Kind]:
    return Counter(inside.decide(lengths).kind for lengths in lengths_of(rows))


def fractions(rows: Rows) -> list[tuple[Fraction, ...]]:
    return [tuple(map(Fraction, row)) for row in rows.tolist()]


def ratios(rows: Rows) -> list[tuple[Fraction, Fraction]]:
    """Exact a and c."""
    return [(alpha / b, gamma / d) for alpha, gamma, b, d, *_ in fractions(rows)]
