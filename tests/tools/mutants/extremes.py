"""Exact, but for intermediates that leave a float format's range."""

from __future__ import annotations

import numpy as np

from hypcheck.implementations.alternatives import dual
from hypcheck.implementations.method import on_rows
from tests.tools.mutants.exactly import position
from tests.tools.mutants.expectation import EXTREME, NO_TOLERANCE, wrong

TINY = np.finfo(np.float64).tiny


def _delta(rows):
    """Δ in float64."""
    alpha, gamma, b, d, x, y, z = rows.T
    with np.errstate(all="ignore"):
        A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2
        c2, c1, c0 = A - B + 1 - P - Q, -A * B + A - B + B * P - A * Q, -A * B
        return -4 * c2**3 * c0 + (c2 * c1) ** 2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2


@wrong()
def squares_in_float64(rows):
    """Contact where a length's square is infinite or 0 in float64."""
    with np.errstate(all="ignore"):
        squares = rows * rows
    lost = ~np.isfinite(squares) | ((squares == 0) & (rows != 0))
    return np.where(lost.any(axis=1), 0, position(rows)).astype(np.int8)


@wrong(asked=EXTREME)
def discriminant_in_float64(rows):
    """Contact where the float64 Δ is infinite or NaN."""
    return np.where(np.isfinite(_delta(rows)), position(rows), 0).astype(np.int8)


@wrong()
def range_of_float32(rows):
    """Contact where a length is beyond the range of float32, though its 53 bits are kept."""
    beyond = (np.abs(rows) > 3.4e38) | ((np.abs(rows) < 1.2e-38) & (rows != 0))
    return np.where(beyond.any(axis=1), 0, position(rows)).astype(np.int8)


@wrong(asked=EXTREME)
def small_is_zero(rows):
    """Coordinates below 1e-30 are taken for 0."""
    changed = np.array(rows)
    coordinates = changed[:, 4:]
    coordinates[np.abs(coordinates) < 1e-30] = 0
    return position(changed)


@wrong(asked=(*EXTREME, *NO_TOLERANCE))
def small_squares_are_zero(rows):
    """Coordinates whose square is 0 in float64 are taken for 0."""
    changed = np.array(rows)
    coordinates = changed[:, 4:]
    coordinates[np.abs(coordinates) < 1.5e-162] = 0
    return position(changed)


@wrong(asked=EXTREME)
def dual_form_in_float64(rows):
    """The dual form in plain float64, which overflows, with no range declared."""
    return on_rows(dual("float64"))(rows)


@wrong(claim=("--domain", '{"ratio": [0, 1e300], "magnitude": [0, 1e300]}'), asked=EXTREME)
def claims_everything(rows):
    """The same where all of float64 is claimed: no other family goes so far."""
    return on_rows(dual("float64"))(rows)


@wrong(asked=EXTREME)
def nan_is_clear(rows):
    """Exact, unless the float64 Δ is NaN: "if Δ ≤ 0 then contact, else …" calls that exterior."""
    return np.where(np.isnan(_delta(rows)), 1, position(rows)).astype(np.int8)


@wrong(asked=EXTREME)
def products_flushed_to_zero(rows):
    """Coordinates whose square is subnormal are taken for 0, as hardware does that flushes to 0."""
    changed = np.array(rows)
    coordinates = changed[:, 4:]
    with np.errstate(all="ignore"):
        coordinates[coordinates * coordinates < TINY] = 0
    return position(changed)
