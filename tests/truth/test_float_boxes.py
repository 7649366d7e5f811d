"""Lower ends of the backward error that float64 intervals prove, against exact decisions and the frozen brackets."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth import float_boxes
from hypcheck.vectors import frozen
from tests.support.inside import decide, goal_of, lower_ends, quick_bracket
from tests.support.tilted_fractions import exact_position
from tests.tools.oracle_agreement import rows

FAMILIES = ("tilted-uniform", "tilted-near-contact", "tilted-tangent", "tilted-stiff", "tilted-twins", "extreme-tilted")


def tilted_cases(name):
    return [case for case in frozen.load(name).cases if any(case.row[7:9]) and case.row[2] != case.row[3]]


@pytest.mark.parametrize("name", FAMILIES)
def test_lower_end_never_exceeds_a_proved_sufficient_change_and_is_positive_for_large_errors(name):
    cases = tilted_cases(name)
    compared = found = 0
    for answer in Position:
        some = [case for case in cases if case.position is not answer]
        truths = [decide(Lengths.of(case.row)) for case in some]
        ends = lower_ends([Pair.from_row(case.row) for case in some], truths, [[answer]] * len(some))
        for case, end in zip(some, ends, strict=True):
            assert end <= case.flips[answer].upper
            if 1e-9 < case.flips[answer].lower < 1:
                compared += 1
                found += end > case.flips[answer].lower / 2
    assert compared > 20
    assert found >= 0.85 * compared


def test_no_sampled_change_within_the_lower_end_makes_the_answer_right():
    draw = random.Random(5)  # noqa: S311
    for _, row in rows(["uniform", "near", "stiff"], 12, seed=7):
        truth = decide(Lengths.of(row))
        for answer in set(Position) - {truth.position}:
            (end,) = lower_ends([Pair.from_row(row)], [truth], [[answer]])
            if end in (0, math.inf):  # nothing is proved, the answer needs no change, or none is enough
                continue
            low = Fraction(end)
            for _ in range(8):
                signs = [Fraction(draw.choice((-1, 1, draw.uniform(-1, 1)))) for _ in row]
                position = exact_position([Fraction(a) * (1 + s * low) for a, s in zip(row, signs, strict=True)])
                assert position == truth.position if answer is Position.CONTACT else position != answer


def test_lower_ends_of_many_rows_equal_those_computed_row_by_row():
    cases = tilted_cases("tilted-symmetric")[:40]
    goals = [goal_of(case.position, Position(1 if case.position is not Position.EXTERIOR else 0)) for case in cases]
    array = np.array([case.row for case in cases])
    together = float_boxes.lower_ends(array, goals)
    assert together.tolist() == [float_boxes.lower_ends(array[i : i + 1], goals[i : i + 1])[0] for i in range(40)]
    assert np.count_nonzero(together) > 30


def test_quick_bracket_overlaps_the_frozen_one_and_is_narrow_for_small_errors():
    narrow = 0
    cases = tilted_cases("tilted-uniform")[:4] + tilted_cases("tilted-near-contact")[:6]
    for case in cases:
        truth = decide(Lengths.of(case.row))
        for answer, known in case.flips.items():
            found = quick_bracket(Pair.from_row(case.row), truth, answer)
            assert found.lower <= known.upper
            assert known.lower <= found.upper
            if found.upper < 1e-6:
                narrow += 1
                assert found.upper <= 1.26 * found.lower
    assert narrow >= 3
