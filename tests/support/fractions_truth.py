"""Expected positions that share no code with hypcheck: decisions in fractions, and pairs whose clearance is known."""

from __future__ import annotations

import math
import random
from fractions import Fraction

from hypothesis import assume
from hypothesis import strategies as st


def sign(value):
    return (value > 0) - (value < 0)


def sign_with_root(u, v, square):
    """The sign of u + v √square, for rationals."""
    if square == 0:
        return sign(u)
    if sign(u) * sign(v) >= 0:
        return sign(u) or sign(v)
    return sign(u) * sign(u * u - v * v * square)


def exact_position(row):
    """The position of a row of rationals: the side on which g has its local maximum, if it is positive there.

    g is positive somewhere between its poles −A and B exactly when it is at its local maximum λ = (−c2 − √D)/3, where
    9 g(λ) = −2 D λ + 9 c0 − c1 c2 (the remainder of g by its derivative); its position is then the sign of λ.
    """
    alpha, gamma, b, d, x, y, z = map(Fraction, row)
    A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2
    c2, c1, c0 = A - B + 1 - P - Q, -A * B + A - B + B * P - A * Q, -A * B
    D = c2 * c2 - 3 * c1
    if D <= 0 or sign_with_root(3 * A - c2, -1, D) <= 0 or sign_with_root(3 * B + c2, 1, D) <= 0:
        return 0
    if sign_with_root(2 * D * c2 + 27 * c0 - 3 * c1 * c2, 2 * D, D) <= 0:
        return 0
    return sign_with_root(-c2, -1, D)


def grown(row, factor):
    """The row with its spheroid grown about its centre."""
    alpha, gamma, b, d, x, y, z = map(Fraction, row)
    return (alpha, gamma, b * factor, d * factor, x, y, z)


def tangent_row(cosine, sine, k, v, steps):
    """A row at `steps` (signed, outwards) along the unit normal from a rational point, and its exact position.

    None where that point is not the nearest one, or where float64 does not hold the row. docs/mathematics.md, "Exact
    tangent vectors": the foot is nearest as long as −A ≤ steps/k ≤ B, and the clearance is then |steps| − 1.
    """
    u = 1 / (k * k * v)
    u, v = min(u, v), max(u, v)
    if u == v:
        return None
    a, c = (u + v) / (2 * cosine), (v - u) / (2 * sine)
    if not -a * a <= steps / k <= c * c:
        return None
    radial = (a, Fraction(1), a * a * k * cosine + steps * cosine)
    axial = (c, Fraction(1), c * c * k * sine - steps * sine)
    alpha, b, x = (value * math.lcm(*(each.denominator for each in radial)) for value in radial)
    gamma, d, z = (value * math.lcm(*(each.denominator for each in axial)) for value in axial)
    row = (alpha, gamma, b, d, x, Fraction(0), z)
    if any(abs(value) > 2**900 or Fraction(float(value)) != value for value in row):
        return None
    return tuple(map(float, row)), sign(steps) if abs(steps) > 1 else 0


TRIPLES = [(3, 4, 5), (5, 12, 13), (8, 15, 17), (7, 24, 25), (20, 21, 29)]


def near_contact_rows(count):
    """Rows with a known clearance of 1e-8 to 1e-1 radii, gap and shape drawn with a fixed seed."""
    draw, rows = random.Random(20), []  # noqa: S311
    while len(rows) < count:
        cosine, sine, hypotenuse = draw.choice(TRIPLES)
        k, v = (draw.choice([1, 3, 5]) * Fraction(2) ** draw.randint(-span, span) for span in (10, 18))
        steps = draw.choice([1, -1]) * (1 + draw.choice([1, -1]) * Fraction(1, 2 ** draw.randint(3, 26)))
        found = tangent_row(Fraction(cosine, hypotenuse), Fraction(sine, hypotenuse), k, v, steps)
        if found is not None:
            rows.append(found)
    return rows


@st.composite
def tangent_rows(draw, gap):
    first, second, hypotenuse = draw(st.sampled_from(TRIPLES))
    if draw(st.booleans()):
        first, second = second, first
    k, v = (
        draw(st.sampled_from([1, 3, 5])) * Fraction(2) ** draw(st.integers(*span)) for span in ((-10, 10), (-18, 18))
    )
    found = tangent_row(Fraction(first, hypotenuse), Fraction(second, hypotenuse), k, v, draw(gap))
    assume(found is not None)
    return found


def steps_at(exponents):
    """Steps of 1 ± 2⁻ⁿ, outwards and inwards."""
    return st.builds(
        lambda n, up, out: out * (1 + up * Fraction(1, 2**n)),
        exponents,
        st.sampled_from([1, -1]),
        st.sampled_from([1, -1]),
    )


def everyday(lowest=-6, highest=6):
    """Positive floats over decades, and signed ones or 0."""
    size = st.builds(lambda m, e: m * 10.0**e, st.floats(1, 10), st.integers(lowest, highest - 1))
    return size, st.one_of(size, size.map(lambda v: -v), st.just(0.0))


def rows_of(size, coordinate):
    """Rows of sizes and centre coordinates."""
    return st.tuples(size, size, size, size, coordinate, coordinate, coordinate)
