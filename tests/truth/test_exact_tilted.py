"""The exact decision of tilted pairs against definitions, hand-worked pairs, and the upright decision."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from sympy import ZZ
from sympy.polys.rings import ring

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Lengths, Pair, Position
from tests.support.inside import Decision, decide, exact, quartic, sign_with_root
from tests.support.inside import position as exact_position
from tests.truth.tilted_cases import SYMMETRIC, TANGENT, TOUCHING_AND_CROSSING, WITNESSES, grown, random_rows


def test_quartic_is_the_determinant_of_the_pencil():
    _, p, s, q, t, x, y, z, v_x, v_y, v_z, at = ring("p s q t x y z v_x v_y v_z lambda", ZZ)
    axis, V = (v_x, v_y, v_z), v_x**2 + v_y**2 + v_z**2
    R, Z = x**2 + y**2, z**2
    # Seen from the centre, S is diag(M, −1) and H is D with DC beside it, and CᵀDC − 1 in the corner. The first three
    # rows are multiplied by q t V and by p, p, s; the last by p s.
    factors = (p, p, s)
    rows = [[((i == j) * t * V + (q - t) * axis[i] * axis[j]) * factors[i] for j in range(3)] for i in range(3)]
    for i, sign in enumerate((1, 1, -1)):
        rows[i][i] += sign * at * q * t * V
        rows[i].append(sign * at * q * t * V * (x, y, z)[i])
    rows.append([at * s * x, at * s * y, -at * p * z, at * (R * s - Z * p - p * s) - p * s])
    c, W = v_z**2, v_x**2 + v_y**2
    g1, g2 = t * W + q * c, q * W + t * c
    E = p * s * V + at * (s * g1 - p * g2) - at**2 * q * t * V
    T, N = (x * v_x + y * v_y) * z * v_z, x * v_y - y * v_x
    G = -(1 + at) * E + at * (R * s - Z * p) * V - at**2 * (R * g2 + Z * g1 + 2 * (q - t) * T)
    F = (p + q * at) * G - (q - t) * N**2 * at**2 * (s - q * at)
    # F is p² q² s t V det(S + λH), and the rows were multiplied by p² s (q t V)³ p s in all.
    assert determinant(rows) == F * p * s * q * t**2 * V**2


def test_quartic_of_integers_is_the_determinant_of_the_pencil():
    for row in random_rows(30):
        lengths = Lengths.of(row)
        F = quartic(lengths)
        p, s, q, t = (Fraction(each) ** 2 for each in (lengths.alpha, lengths.gamma, lengths.b, lengths.d))
        V = sum(each * each for each in lengths.axis)
        for at in (Fraction(-3, 7), Fraction(2, 5), Fraction(11, 3)):
            expected = determinant(pencil(lengths, at)) * p * p * q * q * s * t * V
            found = [F.f4, F.f3, F.f2, F.f1, F.f0]
            assert sum(c * (at * F.side) ** (4 - i) for i, c in enumerate(found)) == expected


def pencil(lengths, at):
    p, s, q, t = (Fraction(each) ** 2 for each in (lengths.alpha, lengths.gamma, lengths.b, lengths.d))
    v, center = lengths.axis, (lengths.x, lengths.y, lengths.z)
    V = sum(each * each for each in v)
    M = [[(i == j) / q + (1 / t - 1 / q) * v[i] * v[j] / V for j in range(3)] for i in range(3)]
    shift = [-sum(M[i][j] * center[j] for j in range(3)) for i in range(3)]
    last = -sum(shift[i] * center[i] for i in range(3)) - 1 - at
    D = (1 / p, 1 / p, -1 / s)
    rows = [[M[i][j] + (i == j) * at * D[i] for j in range(3)] + [shift[i]] for i in range(3)]
    return [*rows, [*shift, last]]


def determinant(matrix):
    if len(matrix) == 1:
        return matrix[0][0]
    return sum(
        (-1) ** j * matrix[0][j] * determinant([row[:j] + row[j + 1 :] for row in matrix[1:]])
        for j in range(len(matrix))
    )


def test_a_tangency_from_a_rational_rotation_is_tangent_and_a_slightly_smaller_spheroid_is_clear():
    assert {side for _, side in TANGENT} == {Position.EXTERIOR, Position.INTERIOR}
    step = Fraction(1, 2**200)
    for row, side in TANGENT:
        decision = decide(Lengths.of(row))
        assert decision.position is Position.CONTACT
        assert decision.limit_of is side
        assert exact_position(Lengths.of(grown(row, 1 - step))) is side
        assert exact_position(Lengths.of(grown(row, 1 + step))) is Position.CONTACT


def test_a_spheroid_that_touches_at_one_point_and_crosses_elsewhere_is_not_tangent():
    """The multiplier of that point is a double root beyond ℓ."""
    draw = np.random.default_rng(3)
    crossing = 0
    for row in TOUCHING_AND_CROSSING:
        alpha, gamma, b, d, *rest = map(float, row)
        ball = draw.normal(size=(20000, 3))
        ball /= np.linalg.norm(ball, axis=1, keepdims=True)
        axis = np.array(rest[3:]) / np.linalg.norm(rest[3:])
        points = np.array(rest[:3]) + b * ball + (d - b) * np.outer(ball @ axis, axis)
        heights = (points**2 * (1 / alpha**2, 1 / alpha**2, -1 / gamma**2)).sum(axis=1) - 1
        if heights.min() < -1e-3 and heights.max() > 1e-3:
            crossing += 1
            assert decide(Lengths.of(row)) == Decision(Position.CONTACT)
    assert crossing == len(TOUCHING_AND_CROSSING) > 20


@pytest.mark.parametrize(("row", "position", "why"), WITNESSES)
def test_exact_positions_of_tilted_pairs_equal_those_worked_out_by_hand(row, position, why):
    assert exact_position(Pair.from_row(row).lengths) is position, why


@pytest.mark.parametrize(("row", "position", "limit_of"), SYMMETRIC)
def test_double_root_at_a_pole_is_a_tangency_unless_a_simple_root_lies_before_it(row, position, limit_of):
    decision = decide(Pair.from_row(row).lengths)
    assert decision == Decision(position, limit_of)


def test_pair_refuses_an_axis_without_direction():
    with pytest.raises(InputError, match="must have a direction"):
        Pair(1, 1, 1, 1, 0, 0, 0, 0.0, -0.0, 0.0)


def test_lengths_and_axis_are_integers_in_the_largest_unit_that_divides_them():
    row = [1.0, 2.0, 3.0, 5.0, 7.0, -8.0, 9.0, 3.0, 5.0, -7.0]
    found = Lengths.of(row)
    assert (found.alpha, found.y, found.axis) == (1, -8, (3, 5, -7))
    for lengths, axis in ((8.0, 1.0), (0.125, 4.0), (2.0**-1000, 2.0**900)):
        assert Lengths.of([*(each * lengths for each in row[:7]), *(each * axis for each in row[7:])]) == found


@pytest.mark.parametrize("w", [1, 2, 9, 10**30 + 1])
def test_the_sign_of_a_number_with_a_root_is_exact(w):
    for u in (-(10**15), -4, -3, -1, 0, 1, 3, 4, 10**15):
        for r in (-3, -1, 0, 1, 3):
            value = u if not r else (1 if r > 0 else -1) if (r > 0) == (u > 0) or not u else None
            if value is None:
                larger = u * u - r * r * w
                value = (larger > 0) - (larger < 0) if u > 0 else (larger < 0) - (larger > 0)
            assert sign_with_root(u, r, w) == (value > 0) - (value < 0), (u, r)


def test_signs_of_derivatives_at_the_end_of_the_interval_equal_those_computed_to_400_bits():
    with mpmath.workprec(400):
        for row in random_rows(60, seed=4):
            F = quartic(Lengths.of(row))
            end = (F.e1 + mpmath.sqrt(F.e1**2 + 4 * F.e0 * F.e2)) / (2 * F.e2)
            expected = []
            for order in (1, 2, 3):
                derived = [math.comb(4 - k, order) * each for k, each in enumerate(F.coefficients) if 4 - k >= order]
                expected.append(int(mpmath.sign(mpmath.polyval(derived, end))))
            assert exact._signs_at_second(F) == expected


@pytest.mark.parametrize(
    ("coefficients", "expected"),
    [((1, 0, 0, 0, -1), -256), ((1, -10, 35, -50, 24), 144), ((1, 0, -2, 0, 1), 0), ((4, 0, 0, 0, 1), 4**3 * 256)],
)
def test_discriminants_of_quartics_with_known_roots(coefficients, expected):
    """1, −1, i, −i; 1 to 4; 1, 1, −1, −1; and 256 a³e³ where only these are not 0."""
    assert exact.quartic_discriminant(*coefficients) == 27 * expected
