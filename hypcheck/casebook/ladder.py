"""A ladder of ulps beside an exact tangency: every power of two from 1 to 2⁴⁰, on both sides, one after the other."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hypcheck.casebook import double_roots
from hypcheck.casebook.double_roots import DoubleRoots
from hypcheck.casebook.draw import Draw, Integers, Maker, exponent, in_turn, ldexp, stepped, turns
from hypcheck.casebook.exactly import Mask, gather, in_metres
from hypcheck.casebook.family import Family
from hypcheck.casebook.tangency import ULPS
from hypcheck.rows import Rows

RUNGS = 2 * (ULPS + 1)
"""Consecutive rows of one tangency: 1 ulp up, 1 down, 2 up, 2 down … 2^ULPS up, 2^ULPS down."""

FARTHEST = 52 - 8 - 1 - ULPS
"""The exponent of the longest ratio of a length to b or d at which 2^ULPS ulps of it are within about 2⁻⁸ radii."""


def tangencies(construction: Callable[[Draw, int], DoubleRoots], *, outer: bool) -> Maker:
    """Tangencies of one side, near enough for the whole ladder."""

    def attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
        found = construction(draw, n)
        usable = found.usable & found.tangent & (found.outer == outer)
        rows = np.where(usable[:, None], found.rows, 1.0)
        return rows, usable & (reach(rows) <= FARTHEST)

    return lambda draw, n: in_metres(draw, gather(draw, n, attempt))


def reach(rows: Rows) -> Integers:
    """The exponent of the longest of α/b, |x|/b, |y|/b and |z|/d: what a relative change is multiplied with in radii.

    γ is left out: it moves the surface by no more than r and α together.
    """
    alpha, _, b, d, x, y, z = np.abs(rows).T
    return np.maximum(exponent(np.maximum(np.maximum(alpha, x), y) / b), exponent(z / d))


_starts = in_turn(
    tangencies(double_roots.by_ratios, outer=True),
    tangencies(double_roots.by_angle, outer=False),
    tangencies(double_roots.by_angle, outer=True),
    tangencies(double_roots.by_ratios, outer=False),
)


def ladder(draw: Draw, n: int) -> Rows:
    """RUNGS rows of each tangency in turn, one length of it moved, any but a zero."""
    count = -(-n // RUNGS)
    start = _starts(draw, count)
    chosen = draw.integers(count, 0, start.shape[1] - 1)
    index = np.arange(count)
    chosen = np.where(start[index, chosen] == 0, chosen % 4, chosen)
    rung = np.arange(n) % RUNGS
    steps = (ldexp(1, rung // 2) * turns(n, 1.0, -1.0)).astype(np.int64)
    rows = np.repeat(start, RUNGS, axis=0)[:n]
    column = np.repeat(chosen, RUNGS)[:n]
    place = np.arange(n)
    rows[place, column] = stepped(rows[place, column], steps)
    return rows


FAMILIES = (
    Family(
        name="tangent-ladder",
        version=1,
        title="1, 2, 4 … 2⁴⁰ ulp beside exactly tangent, both ways",
        source=f"exact tangencies from outside and inside in turn, one length moved; {RUNGS} consecutive rows "
        "are one tangency",
        purpose="the answer must change once, between the two sides, and where it does not tells a program's ulps",
        game="a wall's surface has a grain: sliding along it, the answer flickers",
        drone="how near to the keep-out volume the test can be trusted, in ulps of a coordinate",
        regimes="all four",
        make=ladder,
    ),
)
