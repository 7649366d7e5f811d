"""The bracket of the backward error against errors worked by hand, those of upright pairs, and sampled changes."""

from __future__ import annotations

import itertools
import math
import random
from fractions import Fraction

import pytest
import sympy

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth.box_proofs import Form
from hypcheck.vectors import frozen
from tests.support.inside import Decision, bracket, decide, estimate, quick_bracket, tolerated
from tests.support.inside import position as exact_position
from tests.tools.oracle_agreement import rows
from tests.truth.tilted_cases import SYMMETRIC

EXTERIOR, CONTACT, INTERIOR = Position.EXTERIOR, Position.CONTACT, Position.INTERIOR
STEP = 2.0**-20


def decided(row):
    return decide(Pair.from_row(row).lengths)


@pytest.mark.parametrize(
    ("row", "answer", "error"),
    [
        # A needle across the x axis, at the waist: x − b = α at contact, where x, b and α change.
        ([1, 4, 0.125, 0.25, 1.125 + STEP, 0, 0, 0, 1, 0], CONTACT, STEP / (2.25 + STEP)),
        ([1, 4, 0.125, 0.25, 1.125 - STEP, 0, 0, 0, 1, 0], EXTERIOR, STEP / (2.25 - STEP)),
        ([1, 4, 0.125, 0.25, 1.25, 0, 0, 0, 1, 0], CONTACT, 0.125 / 2.375),
        # x + b = α from within.
        ([1, 4, 0.125, 0.25, 0.875 - STEP, 0, 0, 0, 1, 0], CONTACT, STEP / (2 - STEP)),
        ([1, 4, 0.125, 0.25, 0.875 + STEP, 0, 0, 0, 1, 0], INTERIOR, STEP / (2 + STEP)),
        # With its centre on the wall it is clear on a side where b and α, and x, change by b/2 together.
        ([1, 4, 0.125, 0.25, 1, 0, 0, 0, 1, 0], EXTERIOR, 0.125 / 2.125),
        ([1, 4, 0.125, 0.25, 1, 0, 0, 0, 1, 0], INTERIOR, 0.125 / 2.125),
        # The same needle along x: x − d = α.
        ([1, 4, 0.0625, 0.125, 1.125 + STEP, 0, 0, -7, 0, 0], CONTACT, STEP / (2.25 + STEP)),
        ([1, 4, 0.0625, 0.125, 0.875 - STEP, 0, 0, -7, 0, 0], CONTACT, STEP / (2 - STEP)),
    ],
)
def test_bracket_of_a_tilted_backward_error_holds_the_value_worked_out_by_hand(row, answer, error):
    found = bracket(Pair.from_row(row), decided(row), answer)
    assert found.lower <= error <= found.upper <= 1.25 * found.lower
    for share, expected in ((0.7, False), (1.3, True)):
        assert tolerated(Pair.from_row(row), decided(row), [answer], Fraction(error * share)) is expected


@pytest.mark.parametrize(
    ("row", "answer"),
    [
        ((1, 4, 0.125, 0.25, 3, 1, 2, 1, 2, 3), CONTACT),
        ((3, 4, 1.25, 1.25, 4.75, 0, 4, 0, 0, 1, -1, 3, 0), CONTACT),
        ((3, 4, 1.25, 1.25, 4.25, 0, 4, 0, 0, 1, -1, 3, 0), EXTERIOR),
    ],
)
def test_change_between_the_ends_of_a_bracket_is_neither_tolerated_nor_refused(row, answer):
    """A tilted pair, and two beside a rim: no single decision tells of all changes up to one."""
    pair, truth = Pair.from_row(row), decided(row)
    found = bracket(pair, truth, answer)
    for change, expected in ((found.lower, False), ((found.lower + found.upper) / 2, None), (found.upper, True)):
        assert tolerated(pair, truth, [answer], Fraction(change)) is expected


@pytest.mark.parametrize(("name", "number", "answer"), [("symmetric", 8, INTERIOR), ("twins", 4, CONTACT)])
def test_bracket_of_a_backward_error_begins_at_0_if_no_lower_end_is_proved(name, number, answer):
    """Neither float64 nor one certificate excludes a change: nearest points are two by symmetry, or all around."""
    row = frozen.load(f"tilted-{name}").cases[number].row
    found = quick_bracket(Pair.from_row(row), decided(row), answer)
    assert found.lower == 0 < found.upper < 1
    assert found == bracket(Pair.from_row(row), decided(row), answer)
    assert tolerated(Pair.from_row(row), decided(row), [answer], Fraction(found.upper)) is True


def test_bracket_with_a_vertical_axis_holds_the_exact_error_of_the_upright_pair():
    for _, row in rows(["near", "grid"], 6, seed=3):
        pair = Pair.from_row(row[:7])
        truth = decide(pair.lengths)
        for answer in set(Position) - {truth.position}:
            found = bracket(Pair(*row[:7], 0.0, 0.0, 2.0), Decision(truth.position, truth.limit_of), answer)
            error = quick_bracket(pair, truth, answer).upper
            assert found.lower <= error * (1 + 1e-4)
            assert error <= found.upper * (1 + 1e-4)


def test_bracket_of_a_small_tilted_backward_error_is_narrow():
    narrow = 0
    for family, row in rows(["near", "slight", "stiff"], 40, seed=4):
        truth = decided(row)
        found = bracket(Pair.from_row(row), truth, CONTACT) if truth.position is not CONTACT else None
        if found is not None and found.upper < 1e-6:
            assert found.upper <= 1.25 * found.lower, (family, row)
            narrow += 1
    assert narrow >= 3


@pytest.mark.thorough
def test_no_sampled_change_within_the_lower_end_makes_the_answer_right():
    draw = random.Random(5)  # noqa: S311
    for _, row in rows(["uniform", "near", "stiff"], 6, seed=6):
        truth = decided(row)
        for answer in set(Position) - {truth.position}:
            low = Fraction(bracket(Pair.from_row(row), truth, answer).lower)
            goal = (lambda found, here=truth: found is not here.position) if answer is CONTACT else answer.__eq__
            for change in (low, min(low, 1)) * 8 if math.isfinite(low) and low > 0 else ():
                signs = [draw.choice((-1, 1, draw.uniform(-1, 1))) for _ in row]
                changed = [Fraction(a) * (1 + Fraction(s) * change) for a, s in zip(row, signs, strict=True)]
                assert not goal(exact_position(Lengths.of(changed)))


def test_right_answers_and_limits_of_right_answers_have_the_backward_error_0():
    for row, position, limit_of in SYMMETRIC:
        truth = decided(row)
        for answer in (position, limit_of or position):
            found = bracket(Pair.from_row(row), truth, answer)
            assert (found.lower, found.upper) == (0, 0)
            assert tolerated(Pair.from_row(row), truth, [answer], Fraction(1, 2**60)) is True


def test_centre_on_the_axis_of_the_hyperboloid_is_never_exterior():
    row = [1, 1, 0.5, 0.25, 0, 0, 3, 1, 2, 3]
    found = bracket(Pair.from_row(row), decided(row), EXTERIOR)
    assert (found.lower, found.upper) == (math.inf, math.inf)
    assert tolerated(Pair.from_row(row), decided(row), [EXTERIOR], Fraction(1)) is False
    assert estimate(Pair.from_row(row), decided(row), EXTERIOR) == math.inf


def test_answer_is_tolerated_if_one_of_several_accepted_answers_is_within_the_tolerance():
    row = [1, 4, 0.125, 0.25, 1.125 - STEP, 0, 0, 0, 1, 0]  # in contact, and STEP away from exterior
    assert tolerated(Pair.from_row(row), decided(row), [INTERIOR], Fraction(STEP)) is False
    assert tolerated(Pair.from_row(row), decided(row), [INTERIOR, EXTERIOR], Fraction(STEP)) is True
    assert tolerated(Pair.from_row(row), decided(row), [EXTERIOR], Fraction(0)) is False
    assert tolerated(Pair.from_row(row), decided(row), [EXTERIOR], Fraction(1)) is True
    assert estimate(Pair.from_row(row), decided(row), EXTERIOR) == pytest.approx(STEP / (2.25 - STEP), rel=0.05)


def attains(row, change, answer):
    """Whether a row whose numbers are changed by at most this share has the answer: the corners are looked at.

    Those come first whose axis is changed least, since most answers need no more.
    """
    for turn in sorted(itertools.product((-1, 0, 1), repeat=3), key=lambda turn: sum(map(abs, turn))):
        for signs in itertools.product((-1, 1), repeat=7):
            changed = [Fraction(a) * (1 + s * change) for a, s in zip(row, (*signs, *turn), strict=True)]
            if any(changed[7:]) and exact_position(Lengths.of(changed)) is answer:
                return True
    return False


def test_a_change_as_large_as_the_upper_end_of_a_bracket_makes_the_answer_right():
    asked = 0
    for _, row in rows(["uniform", "near", "stiff", "slight"], 5, seed=8):
        truth = decided(row)
        answer = CONTACT if truth.position is not CONTACT else EXTERIOR
        upper = bracket(Pair.from_row(row), truth, answer).upper
        if upper < 0.25:
            asked += 1
            assert attains(row, Fraction(upper), answer), row
    assert asked >= 3


def test_derivatives_by_the_axis_equal_those_of_sympy():
    """A step of the proof that a box holds: n and q held fixed, Σ = b² + (d² − b²) v vᵀ/v·v."""
    b, d, *v = sympy.symbols("b d v1 v2 v3", positive=True)
    n, q = sympy.Matrix([3, -1, 2]), sympy.Matrix([1, 4, -2])
    axis = sympy.Matrix(v)
    value = (b**2 * n.dot(q)) + (d**2 - b**2) * axis.dot(n) * axis.dot(q) / axis.dot(axis)
    at = {b: 2, d: 5, v[0]: 1, v[1]: 2, v[2]: -2}
    form = Form([Fraction(size) for size in (1, 1, 2, 5)], math.sqrt)
    own = form.by_axis(*([Fraction(part) for part in some] for some in ((1, 2, -2), (1, 4, -2), (3, -1, 2))))
    # Turning the axis to v + ε k changes no length of v at first order only across it: both are taken across v.
    right = [value.diff(part).subs(at) for part in v]
    assert [sympy.nsimplify(part) for part in own] == [sympy.nsimplify(part) for part in right]


@pytest.mark.parametrize("row", [[1, 1, 0.5, 0.25, 1e4, 0, 0, 1, 2, 3], [1, 1, 0.5, 0.25, 300, 1, 0, 1, 2, 3]])
def test_a_bracket_of_a_pair_far_apart_ends_at_1(row):
    assert quick_bracket(Pair.from_row(row), decided(row), CONTACT).upper == 1


@pytest.mark.parametrize(("x", "answer"), [(1.2, EXTERIOR), (0.8, INTERIOR), (1.75, CONTACT)])
def test_a_bracket_is_the_same_in_another_unit_of_length(x, answer):
    row = [1, 4, 0.3, 0.25, x, 0.0, 0.3, 0, 1, 1]
    small = [*(number * 2.0**-20 for number in row[:7]), *row[7:]]
    assert bracket(Pair.from_row(small), decided(small), answer) == bracket(Pair.from_row(row), decided(row), answer)


def test_estimate_for_a_centre_on_the_other_side_uses_only_the_equation_of_the_hyperboloid():
    """The margin is -1 there; (x² + y²)/α² and z²/γ² count four times, for the centre and for the sizes."""
    row = [1, 1, 0.75, 0.25, 0.5, 0.5, 0.5, 1, 2, 3]
    assert decided(row).position is CONTACT
    assert estimate(Pair.from_row(row), decided(row), EXTERIOR) == pytest.approx(1 / (4 * 0.5 + 4 * 0.25))
