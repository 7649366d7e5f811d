"""How large a change gives another answer beside ends: sizes that are known by hand, and the bound of the proof."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from hypcheck.geometry.pair import Pair, Position
from hypcheck.truth.ended_error import EndedFlip, clearance
from tests.support.inside import decide
from tests.support.inside import position as exact_position

EXTERIOR, CONTACT, INTERIOR = Position.EXTERIOR, Position.CONTACT, Position.INTERIOR
HAIR = 2.0**-6
TINY = 2.0**-40
FAR = (-64.0, 64.0)
COINCIDE = 1 - 2.0**-20, 1 + 2.0**-20


def size_of(nearer, farther):
    """The ε with farther (1 − ε) = nearer (1 + ε)."""
    return (farther - nearer) / (farther + nearer)


# row (alpha, gamma, b, d, x, y, z), ends, solid, answer, the least change that gives it, and the share of that which is
# excluded. All balls but those above an end touch at the waist, where α x < α² + γ².
WALLS = [
    # What is beside the wall, outside and inside: x (1 − ε) = (α + b)(1 + ε), and so on.
    ((1, 4, 1, 1, 2 + HAIR, 0, 0), FAR, CONTACT, size_of(2, 2 + HAIR), 0.45),
    ((0.125, 40, 8, 8, 8.125 + HAIR, 0, 0), FAR, CONTACT, size_of(8.125, 8.125 + HAIR), 0.3),
    ((1, 4, 1, 1, 2 - HAIR, 0, 0), FAR, EXTERIOR, size_of(2 - HAIR, 2), 0.3),
    ((0.125, 40, 8, 8, 8.125 - HAIR, 0, 0), FAR, EXTERIOR, size_of(8.125 - HAIR, 8.125), 0.2),
    ((4, 8, 1, 1, 3 - HAIR, 0, 0), FAR, CONTACT, size_of(4 - HAIR, 4), 0.7),
    ((4, 8, 1, 1, 3 + HAIR, 0, 0), FAR, INTERIOR, size_of(4, 4 + HAIR), 0.7),
    # Far from the axis, where the place of the centre is all that counts.
    ((1021, 4096, 1, 1, 0, 1000, 0), FAR, CONTACT, size_of(1001, 1021), 0.9),
    ((1021, 4096, 8, 1, 1000, 0, 0, 3, 0, 0), (-1024, 1024), CONTACT, size_of(1001, 1021), 0.9),
    ((1021, 4096, 1, 8, 0, 1000, 0, 3, 0, 0), (-1024, 1024), CONTACT, size_of(1001, 1021), 0.9),
]
BY_HAND = [
    *((row, ends, solid, *rest) for row, ends, *rest in WALLS for solid in (0, 1)),
    # A flat end: z (1 − ε) = (z_max + d)(1 + ε), or (z + d)(1 + ε) = z_max (1 − ε) within.
    ((8, 8, 1, 1, 0, 0, 2 + HAIR), (-64, 1), 1, CONTACT, size_of(2, 2 + HAIR), 0.35),
    ((8, 8, 1, 1, 0, 0, 2 - HAIR), (-64, 1), 1, EXTERIOR, size_of(2 - HAIR, 2), 0.25),
    ((8, 8, 1, 1, 0, 0, -2 - HAIR), (-1, 64), 1, CONTACT, size_of(2, 2 + HAIR), 0.35),
    ((8, 8, 1, 1, 0, 0, 1 - HAIR), (-64, 2), 1, CONTACT, size_of(2 - HAIR, 2), 0.35),
    ((8, 8, 1, 1, 0, 0, 1 + HAIR), (-64, 2), 1, INTERIOR, size_of(2, 2 + HAIR), 0.25),
    # A mouth that the ball does not touch: the centre goes through it.
    ((8, 8, 1, 1, 0, 0, 1 + HAIR), (-64, 1), 0, INTERIOR, size_of(1, 1 + HAIR), 0.45),
    ((8, 8, 1, 1, 0, 0, 1 - HAIR), (-64, 1), 0, EXTERIOR, size_of(1 - HAIR, 1), 0.45),
    ((8, 8, 1, 1, 0, 0, -1 - HAIR), (-1, math.inf), 0, INTERIOR, size_of(1, 1 + HAIR), 0.45),
    ((8, 8, 1, 1, 0, 0, -1 + HAIR), (-1, math.inf), 0, EXTERIOR, size_of(1 - HAIR, 1), 0.45),
    # So small a ball that its centre is all: it goes through the wall.
    ((1, 1, TINY, TINY, 1 + HAIR, 0, 0), FAR, 0, INTERIOR, size_of(1, 1 + HAIR + TINY), 0.95),
    ((1, 1, TINY, TINY, 0, 1 + HAIR, 0), FAR, 0, INTERIOR, size_of(1, 1 + HAIR + TINY), 0.95),
    ((2, 1, TINY, TINY, 0, 2 - HAIR, 0), FAR, 0, EXTERIOR, size_of(2 - HAIR - TINY, 2), 0.95),
    ((2, 1, TINY, TINY, 2 - HAIR, 0, 0), FAR, 0, EXTERIOR, size_of(2 - HAIR - TINY, 2), 0.95),
]


@pytest.mark.parametrize(("row", "ends", "solid", "answer", "size", "share"), BY_HAND)
def test_least_change_beside_ends_that_makes_an_answer_right_is_between_its_proved_bounds(
    row, ends, solid, answer, size, share
):
    pair = Pair.from_row(map(float, (*row[:7], *(row[7:] or (0, 0, 1)), *ends, solid)))
    truth = exact_position(pair.lengths)
    assert truth is not answer
    flip = EndedFlip(pair, truth, answer)
    below, above = (Fraction(size * factor) for factor in COINCIDE)
    assert flip.reached(above)
    assert not flip.reached(below)
    assert not flip.excluded(above)
    assert flip.excluded(Fraction(size * share))


def shape(semi_axes, axis):
    """A with A Aᵀ = M⁻¹: the spheroid is its centre and A times the unit ball."""
    b, d = semi_axes
    v = np.array(axis) / np.linalg.norm(axis)
    return b * np.eye(3) + (d - b) * np.outer(v, v)


AXES = [(0, 0, 2), (1, 1, 0), (3, 0, 0), (0, 3, 4), (1, 1, 1), (0.01, 0.01, 1), (-5, 2, 0.5)]


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("semi_axes", [(1, 1), (1, 8), (8, 1), (500, 1), (1, 500)])
def test_a_spheroid_with_changed_numbers_lies_within_the_original_one_grown_by_the_bound(axis, semi_axes):
    """The step of the proof that no row of the corpus reaches, which is about an inner number for that reason.

    With T A' u + T C' the points of the changed spheroid, |u| ≤ 1, it says that |A⁻¹ (T A' u + T C' − C)| ≤ 1 + η. Each
    number is changed as far as it may be, up or down as is drawn.
    """
    draw, A = np.random.default_rng(1), shape(semi_axes, axis)
    inverse, centres = np.linalg.inv(A), ((0, 0, 0), (900, 0, 0), (0, -40, 0), (0, 0, 3000), (7, 60, -300))
    for change, centre in product((1 / 100, 2.0**-8, 2.0**-16), centres):
        pair = Pair(2.0, 3.0, *map(float, semi_axes), *map(float, centre), *map(float, axis), 0.0, 1.0)
        bound = float(EndedFlip(pair, EXTERIOR, CONTACT)._growth(Fraction(change)))
        needed = 0.0
        for signs in draw.choice([-1, 1], (8, 10)):
            alpha, gamma, b, d, *rest = 1 + change * signs
            T = np.diag([1 / alpha, 1 / alpha, 1 / gamma])
            L = inverse @ T @ shape(np.array(semi_axes) * (b, d), np.array(axis) * rest[3:])
            m = inverse @ (T @ (np.array(centre) * rest[:3]) - centre)
            ways = [*np.linalg.svd(L)[2], L.T @ m if m.any() else A[0]]
            needed = max(
                needed, *(np.linalg.norm(m + sign * L @ u / np.linalg.norm(u)) for u, sign in product(ways, (1, -1)))
            )
        assert needed <= (1 + bound) * (1 + 1e-12)
        K = 1 if axis == AXES[0] else max(semi_axes) / min(semi_axes)
        v = np.array(axis) / np.linalg.norm(axis)
        lengths = np.sqrt(semi_axes[0] ** -2.0 + (semi_axes[1] ** -2.0 - semi_axes[0] ** -2.0) * v**2)
        grown = (1 + 1.01 * change * K) * (1 + 1.02 * change * K) * (1 + change) / (1 - change) - 1
        proved = grown + 2 * change / (1 - change) * (np.abs(centre) * lengths).sum()
        assert 1 - 1e-9 < bound / proved < 1.0011, "η of the module's docstring, rounded up"


def test_clearance_of_a_tiny_spheroid_is_infinite_if_its_distance_in_radii_exceeds_float64():
    """1e20 away, it is 1e320 radii away; without its heights it is as far."""
    pair = Pair.from_row((1.0, 1.0, 1e-300, 1e-300, 1e20, 0.0, 0.0, 0.0, 0.0, 1.0, -1.0, 1.0, 0.0))
    decision = decide(pair.lengths)
    assert (decision.position, clearance(pair, decision)) == (EXTERIOR, math.inf)
