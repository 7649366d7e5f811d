"""The reference of the nearest-point oracle: the clearance in high precision by another route, and rows to ask."""

from __future__ import annotations

import math

import numpy as np
from mpmath import mp, mpf

from hypcheck.geometry.pair import Pair
from tests.support.inside import nearest


def reference(row):
    """The clearance, and the nearest point's distances from the axis and the waist plane in the caller's units, as mpf.

    With T = tan θ the distance to (r, |z|) is stationary where a r cos θ + c |z| cot θ = a² + c², and the left side
    falls steadily as θ grows: so the root is unique and a bracket holds it whatever the iteration does.
    """
    spread = max(abs(math.frexp(value)[1]) for value in row)
    with mp.workprec(400 if spread < 60 else 400 + 6 * spread):
        alpha, gamma, b, d, x, y, z = (mpf(value) for value in row)
        a, c, r, height = alpha / b, gamma / d, mp.sqrt(x * x + y * y) / b, abs(z) / d
        T = _tangent(a * r, c * height, a * a + c * c)
        rho, zeta = a * mp.sqrt(1 + T * T), c * T
        return mp.sqrt((r - rho) ** 2 + (height - zeta) ** 2) - 1, rho * b, zeta * d


def _tangent(p, q, W):
    if q == 0:
        return mpf(0) if p <= W else mp.sqrt((p / W) ** 2 - 1)
    if p == 0:
        return q / W

    def rest(T):
        return p / mp.sqrt(1 + T * T) + q / T - W

    low, high = _bracket(rest)
    T, step = (low + high) / 2, mp.inf
    while abs(step) > T * mpf(2) ** -(mp.prec // 2 + 20):  # quadratic: the next one would be the last
        low, high = (T, high) if rest(T) > 0 else (low, T)
        newton = T + rest(T) / (p * T / mp.sqrt(1 + T * T) ** 3 + q / T**2)
        target = newton if low < newton < high else (low + high) / 2
        step, T = target - T, target
    return T


def _bracket(rest):
    """Neighbouring powers of two on both sides of the root of a decreasing function."""
    low, high = -1, 1
    while rest(mpf(2) ** low) < 0:
        low *= 2
    while rest(mpf(2) ** high) > 0:
        high *= 2
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if rest(mpf(2) ** middle) > 0 else (low, middle)
    return mpf(2) ** low, mpf(2) ** high


def ulps(value, truth):
    """The error of a float64 in units of its last place; inf is 0 off where it has to be."""
    with mp.workprec(20000):
        if math.isinf(value):
            return 0.0 if value > 0 and truth >= mpf(2) ** 1024 * (1 - mpf(2) ** -54) else math.inf
        return float(abs(mpf(value) - truth) / mpf(math.ulp(value)))


def mixed_rows(count, seed, span=6):
    """Rows of every regime and centre, sizes to 2^±span, clearances from 1e-16 up; about a third on integers."""
    rng = np.random.default_rng(seed)
    a, c, b, d = (2.0 ** rng.uniform(-span, span, (count, 4))).T
    tangent = rng.choice((-1, 1), count) * 2.0 ** rng.uniform(-12, 4, count)
    rho, zeta = a * np.hypot(1, tangent), c * tangent
    length = np.hypot(rho / a**2, zeta / c**2)
    away = rng.choice((-1, 1), count) * (1 + rng.choice((-1, 1), count) * 2.0 ** rng.uniform(-53, 2, count))
    r, z, turn = rho * (1 + away / a**2 / length), zeta * (1 - away / c**2 / length), rng.uniform(0, 7, count)
    rows = np.stack((a * b, c * d, b, d, r * b * np.cos(turn), r * b * np.sin(turn), z * d), axis=1)
    rows[::3] = rng.integers(1, 7, rows[::3].shape)
    rows[1::30, 4:6] = 0.0  # on the axis
    rows[2::30, 6] = 0.0  # in the waist plane
    rows[3::30, 5:] = 0.0  # the same on integers, where many are tangent
    return rows


def mismatches(batch, rows):
    """How many rows of a batch differ from the single answers, clearance to the bit."""
    single = [nearest(Pair.from_row(row)) for row in rows.tolist()]
    wrong = batch.clearance != np.array([one.clearance for one in single])
    wrong |= batch.position != np.array([one.position for one in single])
    return int(wrong.sum())
