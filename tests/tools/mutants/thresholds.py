"""Comparisons with a threshold where there is none, and what is made of Δ = 0. All in whole numbers, so exact."""

from __future__ import annotations

import numpy as np

from tests.tools.mutants import exactly
from tests.tools.mutants.exactly import delta_terms, position
from tests.tools.mutants.expectation import NO_TOLERANCE, wrong

BILLION = 10**9


def _against(limit):
    """Δ less a limit, given as a function of the terms and the sum of |terms|; everything is multiplied by 1e12."""

    def delta(t, k0, k1, k2):
        parts = delta_terms(k0, k1, k2)
        return 10**12 * sum(parts) - limit(t, sum(abs(part) for part in parts))

    return delta


def _zero(t, k0, k1, k2):
    return exactly.delta(t, k0, k1, k2) == 0


@wrong()
def delta_above_1e_9(rows):
    """Δ > 1e-9 is asked for."""
    return position(rows, delta=_against(lambda t, size: 1000 * t.U**6))


@wrong()
def delta_above_minus_1e_9(rows):
    """Δ > −1e-9 is enough."""
    return position(rows, delta=_against(lambda t, size: -1000 * t.U**6))


@wrong()
def delta_relative(rows):
    """Δ must exceed 1e-12 of the sum of its terms' magnitudes."""
    return position(rows, delta=_against(lambda t, size: size))


@wrong()
def delta_relative_below(rows):
    """Δ > −1e-12 of the sum of its terms' magnitudes is enough."""
    return position(rows, delta=_against(lambda t, size: -size))


@wrong()
def coefficients_beyond_1e_9(rows):
    """c1 > 1e-9 and c2 < −1e-9 are asked for."""

    def decide(t, k1, k2, delta):
        return exactly.decide(t, k1, k2, delta, positive=lambda *_: (BILLION * k2 < -t.U) & (BILLION * k1 > t.U**2))

    return position(rows, decide=decide)


@wrong()
def coefficients_up_to_1e_9(rows):
    """c1 > −1e-9 and c2 < 1e-9 are enough."""

    def decide(t, k1, k2, delta):
        return exactly.decide(t, k1, k2, delta, positive=lambda *_: (BILLION * k2 < t.U) & (BILLION * k1 > -(t.U**2)))

    return position(rows, decide=decide)


@wrong()
def ring_of_some_width(rows):
    """On the waist g'(B) counts as 0 up to 1e-6 B²: contact beside a two-point tangency is called clear."""

    def ring(t, k1, k2):
        slope = 3 * t.B * t.B + 2 * k2 * t.B + k1
        return (t.Q == 0) & (abs(slope) * 10**6 <= t.B * t.B) & (t.A * t.U < t.B * t.B)

    return position(rows, ring=ring)


@wrong(asked=NO_TOLERANCE)
def tangency_is_clear(rows):
    """Δ ≥ 0 for Δ > 0; in whole numbers Δ ≥ 0 is Δ + 1 > 0."""
    return position(rows, delta=lambda t, k0, k1, k2: exactly.delta(t, k0, k1, k2) + 1)


@wrong(asked=NO_TOLERANCE)
def tangency_from_outside_is_exterior(rows):
    """Tangencies from outside are called clear, those from inside contact."""
    return np.maximum(position(rows), tangency_is_clear(rows))


@wrong(asked=NO_TOLERANCE)
def tangency_from_inside_is_interior(rows):
    """Tangencies from inside are called clear, those from outside contact."""
    return np.minimum(position(rows), tangency_is_clear(rows))


@wrong()
def tangency_is_interior(rows):
    """Every tangency is called interior."""
    return np.where(position(rows) == tangency_is_clear(rows), position(rows), -1).astype(np.int8)


@wrong()
def double_root_is_clear(rows):
    """Δ = 0 is called exterior, wherever the double root lies."""

    def decide(t, k1, k2, delta):
        return np.where(delta == 0, 1, exactly.decide(t, k1, k2, delta)).astype(np.int8)

    return position(rows, decide=decide)


@wrong()
def vanishing_c1_is_contact(rows):
    """c1 = 0 is called contact."""

    def decide(t, k1, k2, delta):
        return np.where(k1 == 0, 0, exactly.decide(t, k1, k2, delta)).astype(np.int8)

    return position(rows, decide=decide)


@wrong()
def vanishing_c2_is_contact(rows):
    """c2 = 0 is called contact."""

    def decide(t, k1, k2, delta):
        return np.where(k2 == 0, 0, exactly.decide(t, k1, k2, delta)).astype(np.int8)

    return position(rows, decide=decide)


@wrong()
def tangency_is_exterior(rows):
    """Every tangency is called exterior."""
    return np.where(position(rows) == tangency_is_clear(rows), position(rows), 1).astype(np.int8)


@wrong()
def axis_within_1e_9(rows):
    """Centres less than 1e-9 b from the axis are taken to be on it."""
    changed = np.array(rows)
    changed[np.hypot(rows[:, 4], rows[:, 5]) < 1e-9 * rows[:, 2], 4:6] = 0
    return position(changed)


@wrong()
def waist_within_1e_6(rows):
    """Centres less than 1e-6 d from the plane of the waist are taken to be in it."""
    changed = np.array(rows)
    changed[np.abs(rows[:, 6]) < 1e-6 * rows[:, 3], 6] = 0
    return position(changed)


@wrong()
def equal_within_1e_12(rows):
    """α is taken for b where they differ by less than 1e-12 of themselves."""
    changed = np.array(rows)
    alike = np.abs(rows[:, 0] - rows[:, 2]) < 1e-12 * rows[:, 2]
    changed[alike, 0] = rows[alike, 2]
    return position(changed)


@wrong()
def ring_of_1e_9(rows):
    """Clear positions less than 1e-9 from the ring, of its radius, are called contact."""
    alpha, gamma, b, d, x, y, z = rows.T
    a, c = alpha / b, gamma / d
    ring = b * np.hypot(1, c) * np.hypot(1, a / c)
    beside = (np.abs(np.hypot(x, y) - ring) < 1e-9 * ring) & (np.abs(z) < 1e-9 * d)
    return np.where(beside, 0, position(rows)).astype(np.int8)
