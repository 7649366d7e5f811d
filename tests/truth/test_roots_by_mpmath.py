"""mpmath's roots at high precision lie in the proved enclosures; it is asked where all roots are simple."""

from __future__ import annotations

from fractions import Fraction

import mpmath
import pytest
from hypothesis import given

from hypcheck.geometry.pair import Pair
from hypcheck.truth.roots import classify_by_roots
from tests.support.pairs import ordinary_pairs

DIGITS = 40


def real_roots(pair: Pair) -> list[Fraction] | None:
    """The real roots of g to about DIGITS digits, from the paper's (14); None where two are too near to tell."""
    alpha, gamma, b, d, x, y, z = map(Fraction, pair.row)
    A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / b**2, (z / d) ** 2
    exact = (Fraction(1), A - B + 1 - P - Q, -A * B + A - B + B * P - A * Q, -A * B)
    with mpmath.workdps(3 * DIGITS):
        coefficients = [mpmath.mpf(c.numerator) / c.denominator for c in exact]
        try:
            roots = mpmath.polyroots(coefficients, maxsteps=100, extraprec=4 * DIGITS)
        except mpmath.libmp.NoConvergence:  # multiple roots, to which it comes too slowly
            return None
        scale = max(abs(root) for root in roots)
        distances = [abs(p - q) for i, p in enumerate(roots) for q in roots[:i]]
        if min(distances) < scale * mpmath.mpf(10) ** (-DIGITS // 2):
            return None
        real = sorted(root.real for root in roots if abs(root.imag) < scale * mpmath.mpf(10) ** -DIGITS)
        return [Fraction(*(int(part) for part in mpmath.libmp.to_rational(root._mpf_))) for root in real]


@pytest.mark.slow
@given(ordinary_pairs)
def test_roots_by_mpmath_lie_in_the_enclosures(pair):
    found = real_roots(pair)
    if found is None:
        return
    report = classify_by_roots(pair)
    enclosures = sorted((root.lower, root.upper) for root in report.roots)
    assert len(found) == sum(root.multiplicity for root in report.roots)
    for root, (lower, upper) in zip(found, enclosures, strict=True):
        slack = abs(root) * Fraction(1, 10**DIGITS)
        assert lower - slack <= root <= upper + slack
