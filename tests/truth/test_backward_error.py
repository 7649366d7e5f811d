"""The backward error: hand-worked distances, and that the number found is where the answer flips."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hypcheck.geometry.pair import Pair, Position
from tests.support.inside import Decision, corner, decide, exponent, lower_ends, position, quick_bracket, tolerated
from tests.support.pairs import grid_pairs, ordinary_pairs, pairs

POSITIONS = st.sampled_from(list(Position))


def error(row: tuple[float, ...], answer: Position) -> float:
    pair = Pair.from_row(row)
    ends = quick_bracket(pair, decide(pair.lengths), answer)
    assert ends.lower == ends.upper
    return ends.upper


@pytest.mark.parametrize(
    ("row", "answer", "expected", "why"),
    [
        ((1, 2, 1, 1, 2.5, 0, 0), Position.CONTACT, 1 / 9, "2.5 (1−ε) = (1 + 1)(1+ε)"),
        ((3, 3, 1, 1, 1, 0, 0), Position.CONTACT, 1 / 5, "3 (1−ε) = (1 + 1)(1+ε)"),
        ((2, 5, 1, 1, 2.5, 0, 0), Position.EXTERIOR, 1 / 11, "2.5 (1+ε) = (2 + 1)(1−ε)"),
        ((2, 1, 1, 1, 1.5, 0, 0), Position.INTERIOR, 1 / 9, "2 (1+ε) = 1.5 (1−ε) + (1−ε)"),
        ((2, 5, 1, 1, 3, 0, 0), Position.EXTERIOR, 0, "a tangency from outside"),
        ((2, 5, 1, 1, 3, 0, 0), Position.INTERIOR, 1 / 3, "2 (1+ε) = (3 + 1)(1−ε), though a tangency from outside"),
        ((2, 1, 1, 1, 1, 0, 0), Position.INTERIOR, 0, "a tangency from inside"),
        ((2, 1, 1, 1, 0, 0, 3), Position.EXTERIOR, math.inf, "on the axis nothing is outside"),
    ],
)
def test_backward_errors_equal_values_worked_out_by_hand(row, answer, expected, why):
    assert error(row, answer) == pytest.approx(expected, rel=2e-4), why


@pytest.mark.slow
@given(pairs, POSITIONS)
def test_changing_lengths_by_the_backward_error_makes_the_answer_right(pair, answer):
    truth = decide(pair.lengths)
    found = quick_bracket(pair, truth, answer).upper
    assume(0 < found < 1 and found > 1e-300)
    assert tolerated(pair, truth, [answer], Fraction(found)) is True
    assert tolerated(pair, truth, [answer], Fraction(found) * Fraction(9999, 10000)) is False


@given(grid_pairs, POSITIONS)
def test_exponent_of_the_backward_error_is_the_floor_of_its_logarithm_to_base_2(pair, answer):
    truth = decide(pair.lengths)
    octave = exponent(pair, truth, answer)
    found = quick_bracket(pair, truth, answer).upper
    if not math.isfinite(octave):
        assert found == (0 if octave < 0 else math.inf)
    else:
        assert 2.0**octave <= found <= 2.0 ** (octave + 1)


@given(ordinary_pairs, st.fractions(0, Fraction(9, 10)), st.fractions(0, Fraction(9, 10)), st.sampled_from([-1, 1]))
def test_if_a_change_reaches_a_clear_position_every_larger_change_reaches_it(pair, first, second, side):
    """A larger change towards a clear position never loses it: the corner is the best of the box."""
    toward = Position(side)
    less, more = sorted((first, second))
    if position(corner(pair.lengths, less, toward)) is toward:
        assert position(corner(pair.lengths, more, toward)) is toward


@pytest.mark.slow
@given(ordinary_pairs, st.lists(st.fractions(-1, 1), min_size=7, max_size=7), st.sampled_from([-1, 1]))
def test_some_change_within_a_bound_reaches_a_position_only_if_the_corner_of_the_bound_reaches_it(pair, shares, side):
    toward, box = Position(side), Fraction(1, 4)
    changed = [Fraction(value) * (1 + box * share) for value, share in zip(pair.row, shares, strict=True)]
    denominators = math.lcm(*(value.denominator for value in changed))
    alpha, gamma, b, d, x, y, z = (int(value * denominators) for value in changed)
    inside = type(pair.lengths)(alpha, b, x, y, gamma, d, z)
    if position(inside) is toward:
        assert position(corner(pair.lengths, box, toward)) is toward


def test_lower_ends_are_computed_in_floats_only_for_tilted_pairs_without_ends_and_are_0_for_others():
    row, clear = (1.0, 2.0, 0.5, 0.25, 2.0, 0.0, 0.0), Decision(Position.EXTERIOR)
    pairs_ = [Pair(*row, *more) for more in ((), (1.0, 0.0, 1.0), (1.0, 0.0, 1.0, -1.0, 1.0, 0.0))]
    upright, tilted, ended = lower_ends(pairs_, [clear] * 3, [[Position.CONTACT]] * 3)
    assert upright == ended == 0
    assert 0 < tilted < 0.25  # a change of every length by a quarter brings the spheroid into contact
