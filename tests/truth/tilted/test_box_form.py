"""The forms of two surfaces that certificates over boxes are made of: against matrices of fractions."""

from __future__ import annotations

from fractions import Fraction

import pytest

from hypcheck.truth.tilted import box_certificate
from hypcheck.truth.tilted.box_certificate import Form, across, iv, plain
from tests.truth.tilted.cases import random_rows

ROWS = [[Fraction(round(each * 64), 64) for each in row] for row in random_rows(12, seed=9)]


def times(matrix, vector):
    return [sum(a * b for a, b in zip(row, vector, strict=True)) for row in matrix]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b, strict=True))


def inverse_of_M(row, v=None):
    b, d, v = row[2], row[3], row[7:] if v is None else v
    return [[(i == j) * b**2 + (d**2 - b**2) * v[i] * v[j] / dot(v, v) for j in range(3)] for i in range(3)]


def exact_root(value):
    return plain.sqrt(plain.mpf(value.numerator) / value.denominator)


@pytest.mark.parametrize("row", ROWS)
def test_a_form_has_the_matrices_of_both_surfaces(row):
    form = Form(row[:4], exact_root)
    X, v, q = row[4:7], row[7:], [Fraction(1, 3), Fraction(-2), Fraction(5, 7)]
    D = [1 / row[0] ** 2, 1 / row[0] ** 2, -1 / row[1] ** 2]
    sigma = inverse_of_M(row)
    assert form.hyperboloid(X) == sum(a * x * x for a, x in zip(D, X, strict=True)) - 1
    assert form.gradient(X) == [a * x for a, x in zip(D, X, strict=True)]
    assert form.sigma(v) == sigma
    assert form.sigma_times(v, q) == times(sigma, q)
    square = dot(q, times(sigma, q))
    assert abs(form.width(v, q) ** 2 - plain.mpf(square.numerator) / square.denominator) < 1e-60
    at = Fraction(2, 9)
    M, adjugate, minors = form.pencil(at, v)
    assert [times(M, [sigma[i][j] for i in range(3)]) for j in range(3)] == [
        [i == j for i in range(3)] for j in range(3)
    ]
    G = [[M[i][j] + (i == j) * at * D[i] for j in range(3)] for i in range(3)]
    assert [times(G, column) for column in adjugate] == [[(i == j) * minors[2] for i in range(3)] for j in range(3)]
    assert minors[0] == G[0][0]
    assert minors[1] == G[0][0] * G[1][1] - G[0][1] ** 2


@pytest.mark.parametrize("row", ROWS)
def test_derivatives_by_the_axis_are_those_of_the_quadratic_form(row):
    form, v = Form(row[:4], exact_root), row[7:]
    n, q = [Fraction(3, 4), Fraction(1), Fraction(-2, 5)], [Fraction(1, 3), Fraction(-2), Fraction(5, 7)]
    step = Fraction(1, 10**12)
    for place, found in enumerate(form.by_axis(v, q, n)):
        ends = [[each + way * step * (k == place) for k, each in enumerate(v)] for way in (-1, 1)]
        low, high = (dot(n, times(inverse_of_M(row, end), q)) for end in ends)
        assert float(found) == pytest.approx(float((high - low) / (2 * step)), rel=1e-9, abs=1e-12)
    assert dot(across(v, q), v) == 0


@pytest.mark.parametrize("radius", [Fraction(1, 1000), Fraction(1, 4), Fraction(1)])
@pytest.mark.parametrize("row", ROWS)
def test_a_reach_holds_the_nearest_point_of_every_pair_of_the_box(row, radius):
    """X(λ) with (1 + λ Σ D) X = C, for the corners of a box of centres and axes; a wide box may have none."""
    at = Fraction(1, 50)
    sizes, C, v = row[:4], row[4:7], row[7:]
    form = Form([iv.mpf(each.numerator) / each.denominator for each in sizes])
    number = lambda each: iv.mpf(each.numerator) / each.denominator  # noqa: E731 - short
    wide = lambda each: number(each) + iv.mpf([-1, 1]) * number(radius)  # noqa: E731
    found = form.nearest(number(at), list(map(number, C)), list(map(number, v)))
    assert found is not None
    X0, inverse = found
    reach = box_certificate._reach(form, number(at), list(map(wide, C)), list(map(wide, v)), X0, inverse)
    assert reach is not None or radius > Fraction(1, 1000)
    if reach is None:
        return
    D = [1 / row[0] ** 2, 1 / row[0] ** 2, -1 / row[1] ** 2]
    middle = [plain.mpf(each.mid.a) for each in X0]
    farthest = [plain.mpf(0)] * 3
    for signs in range(64):
        ways = [radius if signs >> k & 1 else -radius for k in range(6)]
        sigma = inverse_of_M(row, [a + b for a, b in zip(v, ways[3:], strict=True)])
        A = [[(i == j) + at * sigma[i][j] * D[j] for j in range(3)] for i in range(3)]
        X = solved(A, [a + b for a, b in zip(C, ways[:3], strict=True)])
        off = [abs(plain.mpf(x.numerator) / x.denominator - m) for x, m in zip(X, middle, strict=True)]
        assert all(a <= b for a, b in zip(off, reach, strict=True))
        farthest = [max(a, b) for a, b in zip(off, farthest, strict=True)]
    assert all(b < 20 * max(farthest) for b in reach) or radius > Fraction(1, 1000)


def solved(A, right):
    def determinant(m):
        return dot(m[0], [m[1][1] * m[2][2] - m[1][2] * m[2][1], m[1][2] * m[2][0] - m[1][0] * m[2][2],
                          m[1][0] * m[2][1] - m[1][1] * m[2][0]])  # fmt: skip

    whole = determinant(A)
    replaced = [[[right[i] if j == k else A[i][j] for j in range(3)] for i in range(3)] for k in range(3)]
    return [determinant(each) / whole for each in replaced]
