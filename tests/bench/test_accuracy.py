"""Accuracy in bench: errors are counted by the row's distance to another position."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from hypcheck.bench.accuracy import NEAREST, MethodAnswers, WorkloadTruth, accuracy_line, reliable_above
from hypcheck.bench.contenders import contenders
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.geometry.rows import CANNOT_SAY
from tests.support import inside
from tests.support.inside import flip_exponents

INF = math.inf


@pytest.fixture(scope="module")
def truth():
    workload = WORKLOADS["near-contact"]
    rows = workload.rows(5, 120)
    return WorkloadTruth(workload, rows, inside.positions(rows), flip_exponents(rows))


@pytest.fixture(scope="module")
def contender():
    return contenders(BenchPlan())["fast-numpy"]


def answered(truth, answers):
    return MethodAnswers("fast-numpy", truth.workload.name, np.arange(len(truth.rows)), answers, "", "")


def test_right_answers_have_no_error_in_bench(contender, truth):
    found = accuracy_line(contender, answered(truth, truth.positions), truth)
    assert (found.asked, found.wrong, found.abstained) == (120, 0, 0)
    assert (found.reliable_above, found.worst) == (0.0, [])
    assert sum(number for _, number, _ in found.octaves) == 120


def test_accuracy_line_counts_missing_answers_as_abstained_and_not_as_wrong(contender, truth):
    answers = truth.positions.copy()
    answers[:7] = CANNOT_SAY
    found = accuracy_line(contender, answered(truth, answers), truth)
    assert (found.wrong, found.abstained) == (0, 7)
    assert found.reliable_above > 0


def test_accuracy_line_of_a_method_that_never_answers_has_reliable_above_inf(contender, truth):
    found = accuracy_line(contender, answered(truth, np.full_like(truth.positions, CANNOT_SAY)), truth)
    assert (found.wrong, found.reliable_above) == (0, INF)


def test_accuracy_line_counts_a_wrong_answer_by_the_exponent_of_its_distance(contender, truth):
    place = int(np.flatnonzero(truth.positions == 1)[0])
    answers = truth.positions.copy()
    answers[place] = 0
    found = accuracy_line(contender, answered(truth, answers), truth)
    assert (found.wrong, found.false_contact, found.false_clear, found.wrong_side) == (1, 1, 0, 0)
    assert [octave for octave, _, wrong in found.octaves if wrong] == [int(truth.exponents[place])]
    (worst,) = found.worst
    assert [float.fromhex(value) for value in worst.row] == truth.rows[place].tolist()
    assert (worst.truth, worst.answer, worst.case) == (1, 0, f"near-contact/{place}")
    assert 2.0 ** truth.exponents[place] <= worst.flip_distance <= 2.0 ** (truth.exponents[place] + 1)


def test_accuracy_line_judges_yes_or_no_answers_by_the_question_of_the_method(contender, truth):
    one_sided = replace(contender, question="exterior")
    answers = (truth.positions == 1).astype(np.int8)
    assert accuracy_line(one_sided, answered(truth, answers), truth).wrong == 0
    found = accuracy_line(one_sided, answered(truth, 1 - answers), truth)
    assert found.wrong == 120
    assert found.false_clear == np.count_nonzero(truth.positions == 0)
    assert found.wrong_side == np.count_nonzero(truth.positions == -1)


@pytest.mark.parametrize(
    ("octaves", "wrong", "edge"),
    [
        ([-1, -2, -3], [], 0.0),
        ([-1, -2, -3], [0], INF),
        ([-1, -2, -3], [2], 2.0**-2),
        ([-1, -2, -INF], [2], NEAREST),
        ([-1, -9, -20], [2], 2.0**-19),
        ([-INF, -INF], [0], INF),
        ([-1] * 1000 + [-5] * 1000, [1000], 2.0**-5),
        ([-1] * 1000 + [-5] * 1000, [1000, 1001, 1002], 2.0**-4),
        ([-1] * 600 + [-5] * 600, [0], INF),  # all together would be few enough
        ([-1] * 1000 + [-5] * 1000, [0, 1, 1000], INF),
    ],
)
def test_reliable_above_is_the_least_distance_beyond_which_one_in_1000_is_wrong(octaves, wrong, edge):
    mask = np.zeros(len(octaves), dtype=bool)
    mask[wrong] = True
    assert reliable_above(np.array(octaves, dtype=float), mask) == edge
