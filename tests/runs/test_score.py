"""A score: the status of each row, the wrong answers, their mistakes, and the tally of them."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations.session import Answered, Outcome
from hypcheck.runs.judge import Criterion, Mistake, Status
from hypcheck.runs.score import as_slice, score
from hypcheck.runs.tally import STATUSES
from tests.support.records import unanswered_case

OUTSIDE, RING, TOUCH, CROSS, INSIDE = (
    (1.0, 1.0, 1.0, 1.0, 5.0, 0.0, 0.0),
    (1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0),
    (1.0, 1.0, 1.0, 1.0, 2.0, 0.0, 0.0),
    (1.0, 1.0, 1.0, 1.0, 1.5, 0.0, 0.0),
    (3.0, 3.0, 1.0, 1.0, 0.0, 0.0, 0.0),
)
ROWS = np.array([OUTSIDE, RING, TOUCH, CROSS, INSIDE, OUTSIDE, CROSS])
TRUTH = np.array([1, 1, 0, 0, -1, 1, 0], dtype=np.int8)
ANSWERS = np.array([1, 0, 1, 1, 0, CANNOT_SAY, CANNOT_SAY], dtype=np.int8)
"""Right, three kinds of wrong answers, "cannot say", and none."""

ENDED = np.array([*[Outcome.ANSWERED] * 6, Outcome.CRASH], dtype=np.int8)


class Family:
    """Cases that are named by their numbers."""

    def name(self, index):
        """The id of a case."""
        return f"mine/{index}"

    def place(self, index):
        """Where it stands."""
        return 1, index


@pytest.fixture
def scored():
    return score(ROWS, TRUTH, Answered(ANSWERS, ENDED, {6: "it left"}), Criterion(tolerance=Fraction(2)))


def statuses(scored):
    return [STATUSES[code].value for code in scored.status]


def test_score_gives_each_row_one_status(scored):
    assert statuses(scored) == ["right", "wrong", "wrong", "wrong", "wrong", "abstained", "crash"]
    assert scored.answered.tolist() == [True] * 6 + [False]
    assert scored.wrong.tolist() == [1, 2, 3, 4]


def test_wrong_answers_are_counted_by_mistake(scored):
    assert scored.mistakes == {Mistake.FALSE_CONTACT: 2, Mistake.FALSE_CLEAR: 2}
    sides = score(ROWS[:1], TRUTH[:1], Answered.of(np.array([-1], dtype=np.int8)), Criterion())
    assert sides.mistakes == {Mistake.WRONG_SIDE: 1}


def test_answer_yes_to_the_question_contact_is_wrong_for_rows_without_contact():
    answers = Answered.of(np.ones(7, dtype=np.int8))
    assert score(ROWS, TRUTH, answers, Criterion("contact")).wrong.tolist() == [0, 1, 4, 5]


def test_score_judges_only_the_chosen_wrong_answers(scored):
    assert [(case.index, case.answer) for case in scored.judged(np.array([1, 3]))] == [(1, 0), (3, 1)]
    assert [case.status for case in scored.judged()].count(Status.WRONG) == 3  # the tangency flips at once


def test_part_of_a_score_keeps_the_reasons_of_its_rows(scored):
    part = scored.part(np.array([0, 4, 6]))
    assert statuses(part) == ["right", "wrong", "crash"]
    assert (part.wrong.tolist(), part.reasons) == ([1], {2: "it left"})
    assert scored.part(np.arange(3)).reasons == {}


def test_answer_removed_from_a_score_is_no_longer_wrong(scored):
    lost = scored.without({1: (Status.NONDETERMINISTIC, "it changed")})
    assert statuses(lost)[1] == "nondeterministic"
    assert lost.wrong.tolist() == [2, 3, 4]
    assert lost.answers[1] == CANNOT_SAY
    assert scored.answers[1] == 0


def test_a_tally_names_worst_cases_and_faults_by_their_indices_in_the_family(scored):
    indices = np.array([10, 11, 12, 13, 14, 15, 99])
    tally = scored.tally(Family(), indices, np.array([-1.0, -1.0, -np.inf]), left_out={"ratio": 2, "regime": 3})
    counts = {"right": 1, "wrong": 3, "tolerated": 1, "abstained": 1, "crash": 1, "skipped": 5}
    assert (tally.asked, tally.counts) == (7, counts)
    assert tally.mistakes == {"false-contact": 2, "false-clear": 2}
    assert tally.octaves == {"-inf": {"tolerated": 1}, "-1": {"right": 1, "wrong": 1}}
    assert tally.dangerous == 1  # the crossing taken for clear; the tangency is tolerated
    assert tally.size_bins.as_lists() == [[0, 0, 5, 4], [0, 1, 1, 1], [1, 1, 1, 1]]
    assert {case.case for case in tally.worst} == {"mine/11", "mine/13", "mine/14"}
    assert tally.faults == [unanswered_case((1, 99), "mine/99", CROSS, "crash", "it left")]


@pytest.mark.parametrize(
    ("indices", "expected"),
    [
        ([3, 4, 5], slice(3, 6)),
        ([7], slice(7, 8)),
        ([3, 4, 6], None),
        ([2, 3, 5, 6], None),
        ([], None),
        ([0], slice(0, 1)),
    ],
)
def test_consecutive_indices_become_a_slice_and_others_stay(indices, expected):
    numbers = np.array(indices, dtype=np.int64)
    found = as_slice(numbers)
    assert (found is numbers) if expected is None else (found == expected)
