"""The kernel in numpy for rows of ten whose axis leans: floats by a multiplier and its bounds, then integers.

The multiplier proves nothing: any is safe, a good one leaves fewer rows to the integers. The stage after it is printed
from the program of the C kernel (programs/tilted.py).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import Floats, Mask, Positions, Rows, invalid
from hypcheck.kernel import tilted_integers
from hypcheck.kernel.printed import tilted
from hypcheck.kernel.programs.tilted import CONSTANTS

CHUNK = 2048
"""Rows at a time: some ninety buffers of a chunk stay in the cache."""

_TURNS, _SETTLED = 8, 1e-6
"""Newton's turns at most, and the relative change with which it ends: as in core/parts/platform.h."""


def leaning(rows: Rows) -> Mask:
    """A mask (n,) of the rows of ten that are neither upright nor of a sphere."""
    return np.asarray((rows[:, 7:9] != 0).any(axis=1) & (rows[:, 2] != rows[:, 3]))


def positions(rows: Rows) -> Positions:
    """The exact position of every row of ten, int8 (n,), 127 for invalid ones; its axis leans, and it is no sphere."""
    result = np.empty(len(rows), dtype=np.int8)
    for start in range(0, len(rows), CHUNK):
        _classify(rows[start : start + CHUNK], result[start : start + CHUNK])
    return result


def _classify(rows: Rows, result: Positions) -> None:
    columns = np.ascontiguousarray(rows.T)
    with np.errstate(all="ignore"):
        alpha, gamma, b, d, x, y, z, *axis = columns
        row = (alpha, gamma, b, d, x, y, z, *_scaled(np.stack(axis)))
        form = tilted.tilted_form(*row, list(np.empty((tilted.TILTED_FORM_BUFFERS[0], len(rows)))))
        l = _multiplier(form)  # noqa: E741 - the program's name
        numbers = list(np.empty((tilted.TILTED_BUFFERS[0], len(rows))))
        truths = list(np.empty((tilted.TILTED_BUFFERS[1], len(rows)), dtype=np.bool_))
        exterior, interior, decided = tilted.tilted(*row, l, CONSTANTS, numbers, truths)
    np.subtract(exterior.view(np.int8), interior.view(np.int8), out=result)
    rest = np.flatnonzero(~decided)
    refused = invalid(rows[rest])
    result[rest[refused]] = REFUSED
    for place in rest[~refused]:
        result[place] = tilted_integers.position(rows[place].tolist())


def multipliers(rows: Rows) -> Floats:
    """Near the multiplier, in squares of b, where the dual function of each row (n, 10) is greatest: a hint, (n,)."""
    alpha, gamma, b, d, x, y, z, *axis = np.ascontiguousarray(rows.T)
    row = (alpha, gamma, b, d, x, y, z, *_scaled(np.stack(axis)))
    return _multiplier(tilted.tilted_form(*row, list(np.empty((tilted.TILTED_FORM_BUFFERS[0], len(rows))))))


def _scaled(axes: Floats) -> tuple[Floats, Floats, Floats]:
    """Axes of any length, (3, n), with the largest number in [1/2, 1): times a power of two, NaN where not exact."""
    exponents = np.frexp(np.abs(axes).max(axis=0))[1]
    scaled = np.ldexp(axes, -exponents)
    scaled[:, (np.ldexp(scaled, exponents) != axes).any(axis=0)] = np.nan
    vx, vy, vz = scaled
    return vx, vy, vz


def _multiplier(form: Sequence[Floats]) -> Floats:
    """Near the multipliers where the dual functions are greatest: core/parts/tilted_level.h says how."""
    p, s, t, k0, k1, m, radius, height, cross_squared, level = form
    P1 = np.fmax(cross_squared / level, 0)  # 0/0 is 0: the axis leans by less than 2⁻⁵⁰⁰
    root = np.sqrt(k1 * k1 + 4 * k0 * t)
    larger = 0.5 * (np.abs(k1) + root)
    one_pole, other_pole, rising = larger / t, k0 / larger, k1 >= 0
    B, A2 = np.where(rising, one_pole, other_pole), np.where(rising, other_pole, one_pole)
    G, m_plane = s * (radius - P1) - p * height, m - t * P1
    a1, a2, b = p * P1, A2 * np.abs(G + A2 * m_plane) / root, B * np.abs(B * m_plane - G) / root
    least, greatest = -0.999 * np.minimum(p, A2), 0.999 * B
    found: Floats = np.zeros_like(p)
    for _ in range(_TURNS):
        i1, i2, i3 = 1 / (p + found), 1 / (A2 + found), 1 / (B - found)
        S1, S2, T3 = a1 * i1 * i1, a2 * i2 * i2, b * i3 * i3
        S, T = S1 + S2, 1 + T3
        root_S, root_T = np.sqrt(S), np.sqrt(T)
        slope = (S1 * i1 + S2 * i2) * T * root_T + T3 * i3 * S * root_S
        moved = np.fmin(np.fmax(found + (root_S - root_T) * S * T / slope, least), greatest)
        settled = np.abs(moved - found) <= _SETTLED * np.abs(moved)
        found = moved
        if settled.all():
            break
    return found
