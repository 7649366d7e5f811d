"""The exact decision about any ellipsoid and any quadric: a proof of each answer, and points where there is contact."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.geometry.pair import Pair, Position
from hypcheck.vectors import frozen
from tests.support import quadrics
from tests.support.inside import Certificate, proves, surfaces
from tests.support.inside import position as exact_position

QUADRICS = {
    "cone": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 0]],
    "elliptic cylinder": [[1, 0, 0, 0], [0, 3, 0, 0], [0, 0, 0, 0], [0, 0, 0, -1]],
    "paraboloid": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, -1], [0, 0, -1, 0]],
    "saddle": [[1, 0, 0, 0], [0, -2, 0, 0], [0, 0, 0, -1], [0, 0, -1, 0]],
    "ellipsoid": [[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 3, 0], [0, 0, 0, -1]],
    "hyperboloid of one sheet": [[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, -1, 0], [0, 0, 0, -1]],
    "hyperboloid of two sheets": [[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]],
    "two planes": [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]],
    "plane": [[0, 0, 0, 1], [0, 0, 0, 0], [0, 0, 0, 0], [1, 0, 0, 0]],
}


def product(first, second):
    return [[sum(a * b for a, b in zip(row, column, strict=True)) for column in zip(*second, strict=True)]
            for row in first]  # fmt: skip


def congruent(form, change):
    """The form of a surface after X̃ = change · Ỹ."""
    return product([list(column) for column in zip(*change, strict=True)], product(form, change))


def drawn(draw, size):
    """A random affine map, and its inverse by the adjugate."""
    while True:
        linear = [[Fraction(draw.randint(-8, 8), 4) for _ in range(3)] for _ in range(3)]
        (a, b, c), (d, e, f), (g, h, i) = linear
        determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
        if determinant:
            break
    way = [Fraction(draw.randint(-12, 12), 8) for _ in range(3)]
    linear = [[size * entry for entry in row] for row in linear]
    inverse = [[e * i - f * h, c * h - b * i, b * f - c * e],
               [f * g - d * i, a * i - c * g, c * d - a * f],
               [d * h - e * g, b * g - a * h, a * e - b * d]]  # fmt: skip
    inverse = [[entry / (size * determinant) for entry in row] for row in inverse]
    back = [-sum(a * b for a, b in zip(row, way, strict=True)) for row in inverse]
    last = [Fraction(0)] * 3 + [Fraction(1)]
    return (
        [*([*row, part] for row, part in zip(linear, way, strict=True)), last],
        [*([*row, part] for row, part in zip(inverse, back, strict=True)), last],
    )


def case(draw, kind):
    """S and H, and the map from the unit ball to the solid."""
    ball = [[Fraction(i == j) * (-1 if i == 3 else 1) for j in range(4)] for i in range(4)]
    there, back = drawn(draw, Fraction(1, draw.choice((1, 4, 16, 64))))
    turned, _ = drawn(draw, Fraction(draw.choice((1, 2)), 4))
    return congruent(ball, back), congruent(QUADRICS[kind], turned), there


BALL = np.random.default_rng(5).normal(size=(2000, 3))
BALL /= np.linalg.norm(BALL, axis=1, keepdims=True)


def extremes(form):
    """Points of the unit ball about where a quadratic form is least and greatest, by search around the best ones."""
    form = np.array([[float(entry) for entry in row] for row in form])
    rng = np.random.default_rng(6)
    found = []
    for sign in (1, -1):
        points = np.concatenate([BALL, BALL * 0.6, BALL * 0.2])
        for radius in 0.5 ** np.arange(2, 40):
            high = np.column_stack([points, np.ones(len(points))])
            values = sign * np.einsum("ni,ij,nj->n", high, form, high)
            best = points[np.argsort(values)[:4]]
            around = (best[:, None] + radius * rng.normal(size=(4, 60, 3))).reshape(-1, 3)
            around /= np.maximum(np.linalg.norm(around, axis=1, keepdims=True), 1)
            points = np.concatenate([best, around])
        high = np.column_stack([points, np.ones(len(points))])
        found.append(points[np.argmin(sign * np.einsum("ni,ij,nj->n", high, form, high))] * (1 - 2.0**-40))
    return found


def image(change, point):
    high = [*map(Fraction, point.tolist()), Fraction(1)]
    return tuple(sum(a * b for a, b in zip(row, high, strict=True)) for row in change[:3])


@pytest.mark.parametrize("kind", QUADRICS)
def test_position_of_random_ellipsoids_is_proved_by_its_multiplier_or_by_points_on_both_sides(kind):
    draw, seen = random.Random(len(kind)), set()  # noqa: S311
    for _ in range(16):
        S, H, there = case(draw, kind)
        position, at = quadrics.position(S, H), quadrics.multiplier(S, H)
        if position is Position.CONTACT:
            points = tuple(image(there, point) for point in extremes(congruent(H, there)))
            assert proves(S, H, Certificate(position, points=points)), (S, H)
        else:
            assert proves(S, H, Certificate(position, multiplier=at)), (S, H)
        seen.add(position)
    assert seen == set(Position)


CYLINDER = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0], [0, 0, 0, -4]]
"""Of radius 2."""
PLANE = [[0, 0, 0, 1], [0, 0, 0, 0], [0, 0, 0, 0], [1, 0, 0, -4]]
"""x = 2."""


@pytest.mark.parametrize(
    ("x", "beside", "position"),
    [
        (4, CYLINDER, Position.EXTERIOR),
        (3, CYLINDER, Position.CONTACT),
        (2, CYLINDER, Position.CONTACT),
        (1, CYLINDER, Position.CONTACT),
        (Fraction(1, 2), CYLINDER, Position.INTERIOR),
        (0, PLANE, Position.INTERIOR),
        (1, PLANE, Position.CONTACT),
        (4, PLANE, Position.EXTERIOR),
    ],
)
def test_unit_ball_beside_a_cylinder_or_a_plane_is_clear_only_where_they_do_not_touch(x, beside, position):
    ball = [[1, 0, 0, -x], [0, 1, 0, 0], [0, 0, 1, 0], [-x, 0, 0, x * x - 1]]
    assert quadrics.position(ball, beside) is position


def test_contact_of_a_ball_is_decided_even_if_the_first_entry_of_a_tried_matrix_is_0():
    """The ellipsoid 4x² + 2y² + z² = 1 goes through the ball that touches x = 0 at its centre."""
    ball = [[1, 0, 0, -1], [0, 1, 0, 0], [0, 0, 1, 0], [-1, 0, 0, 0]]
    ellipsoid = [[-4, 0, 0, 0], [0, -2, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]
    assert quadrics.position(ball, ellipsoid) is Position.CONTACT


def test_a_positive_determinant_is_not_taken_for_a_proof_if_two_pivots_are_negative():
    """(a, c, r, z) = (2, ½, 4, 0) crosses, and f(−8) > 0."""
    assert quadrics.position(*surfaces(Pair(2, 0.5, 1, 1, 4, 0, 0))) is Position.CONTACT


def test_position_of_frozen_pairs_is_that_of_the_decision_about_spheroids():
    for name in (*frozen.NAMES, *frozen.TILTED_NAMES):
        for each in frozen.load(name).cases[::397]:
            pair = Pair.from_row(each.row)
            assert quadrics.position(*surfaces(pair)) is exact_position(pair.lengths), each.id
