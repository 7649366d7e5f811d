"""Tallies: each case is in the bin of its sizes and place, and parts add up to the whole in any order."""

from __future__ import annotations

import math
from collections import Counter
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from msgspec import UNSET, structs

from hypcheck.geometry.rows import CANNOT_SAY, SWEEPS
from hypcheck.implementations.session import Answered, Outcome
from hypcheck.record.fields import Histogram
from hypcheck.runs import judge, tally
from hypcheck.runs.judge import Criterion
from hypcheck.runs.score import score
from hypcheck.runs.tally import EMPTY
from tests.support import inside
from tests.support.records import unanswered_case, worst_case

CRITERION = Criterion(tolerance=Fraction(0))
ROW = (2.0, 17.8, 0.25, 0.15, 1.0, 0.0, 0.0)


def rows_near_contact(n):
    rng = np.random.default_rng(4)
    rows = np.column_stack([np.tile([2.0, 17.8, 0.25, 0.15], (n, 1)), rng.uniform(1, 3, n), rng.uniform(0, 1, (n, 2))])
    rows[::3, 4] += 1
    return rows


class Numbered:
    """Cases that are named and placed by their numbers."""

    def name(self, index):
        """The id of a case."""
        return f"case-{index}"

    def place(self, index):
        """Where it stands."""
        return 1, index


def answered(rows, numbers):
    """Every third of the rows answered otherwise than is right, some without an answer."""
    truth = inside.positions(rows)
    answers = np.where(numbers % 3 == 0, np.where(truth == 0, 1, 0), truth).astype(np.int8)
    status = np.full(len(rows), Outcome.ANSWERED, dtype=np.int8)
    status[numbers % 7 == 1], status[numbers % 49 == 2] = Outcome.CRASH, Outcome.TIMEOUT
    lost = np.flatnonzero(status != Outcome.ANSWERED)
    answers[lost] = CANNOT_SAY
    return Answered(answers, status, dict.fromkeys(lost.tolist(), "why"))


def tallied(rows, start=0, stop=None):
    """The tally of a stretch of the rows; some exponents are known."""
    numbers = np.arange(len(rows))[start:stop]
    part = rows[start:stop]
    exponents = np.floor(numbers[numbers < 50] / 9.0)
    scored = score(part, inside.positions(part), answered(part, numbers), CRITERION)
    return scored.tally(Numbered(), numbers, exponents, left_out={"precision": 3})


def test_answers_are_counted_by_what_is_true_and_by_what_was_answered():
    truth = np.array([1, 1, 0, 0, -1, -1], dtype=np.int8)
    answers = np.array([1, 0, 0, CANNOT_SAY, -1, CANNOT_SAY], dtype=np.int8)
    answered = np.array([True, True, True, True, True, False])
    assert tally.answer_counts(truth, answers, answered) == {
        "1": {"0": 1, "1": 1},
        "0": {"0": 1, "2": 1},
        "-1": {"-1": 1, "none": 1},
    }


def test_histogram_bins_equal_the_counts_of_a_plain_loop():
    rng = np.random.default_rng(4)
    rows = 2.0 ** rng.uniform(-9, 9, (500, 7))
    amiss = rng.random(500) < 0.3
    for found, key in (
        (
            tally.by_size(rows, amiss),
            lambda r: (math.floor(math.log2(r[0] / r[2])), math.floor(math.log2(r[1] / r[3]))),
        ),
        (
            tally.by_place(rows, amiss),
            lambda r: (min(63, int(8 * math.hypot(r[4], r[5]) / r[0])), min(63, int(8 * abs(r[6]) / r[1]))),
        ),
    ):
        asked = Counter(map(key, rows.tolist()))
        wrong = Counter(key(row) for row, bad in zip(rows.tolist(), amiss, strict=True) if bad)
        assert found.as_lists() == [[*at, asked[at], wrong[at]] for at in sorted(asked)]


@pytest.mark.parametrize("scale", [1e-300, 1.0, 1e300])
def test_histogram_by_place_counts_centres_of_any_magnitude(scale):
    rows = np.array([[1.0, 1, 1, 1, 1.5, 2, 0.25], [1.0, 1, 1, 1, 0, 0, 1e9]]) * [1, 1, 1, 1, scale, scale, 1]
    rows[:, 0] = scale
    assert tally.by_place(rows, np.array([True, False])).as_lists() == [[0, 63, 1, 0], [20, 2, 1, 1]]


def test_sparse_and_dense_histograms_give_the_same_counts():
    rng = np.random.default_rng(5)
    rows = np.ones((3000, 7))
    rows[:, :4] = np.ldexp(1.0, rng.integers(-500, 500, (3000, 4)).astype(np.int32))
    amiss = rng.random(3000) < 0.5
    found = tally.by_size(rows, amiss)
    assert found == tally.added(tally.by_size(rows[i::3], amiss[i::3]) for i in range(3))
    assert found.table[:, 2:].sum(axis=0).tolist() == [3000, amiss.sum()]
    assert found.as_lists() == sorted(found.as_lists())
    assert Histogram.of_lists(found.as_lists()) == found
    assert tally.added([]) == Histogram()


def line_of(tallied):
    """The line about an implementation under test."""
    return tally.group_line(tallied, "family", CRITERION, method="mine", title="mine", spec="python:mine:f", failing=[])


def test_tallies_of_parts_add_up_to_the_whole_in_any_order():
    rows = rows_near_contact(300)
    whole = tallied(rows)
    cuts = [0, 1, 90, 91, 200, 300]
    parts = [tallied(rows, *cut) for cut in pairwise(cuts)]
    rng = np.random.default_rng(6)
    expected = line_of(whole)
    expected.counts["skipped"] *= len(parts)
    expected.not_asked["precision"] *= len(parts)
    assert expected.counts["wrong"] > 50
    for _ in range(5):
        order = rng.permutation(len(parts))
        first = tally.merged_tally(parts[i] for i in order[:2])
        total = tally.merged_tally([tally.merged_tally(parts[i] for i in order[2:]), first])
        assert line_of(total) == expected
    assert tally.merged_tally([]) == EMPTY


def test_tally_keeps_the_cases_with_the_largest_errors():
    rows = rows_near_contact(120)
    answers = answered(rows, np.arange(120)).answers
    wrong = np.flatnonzero((answers != CANNOT_SAY) & (answers != inside.positions(rows)))
    assert len(wrong) > 20
    errors = sorted((judge.about_error_of(rows[n].tolist(), int(answers[n]), "position") for n in wrong), reverse=True)
    assert [case.error for case in tallied(rows).worst] == errors[:3]


def test_tally_keeps_wrong_before_tolerated_answers_and_the_first_of_equal_ones():
    def case(number, status, error):
        return worst_case((1, number), f"case-{number}", ROW, 0, 1, "false-clear", status, error)

    kept = [case(0, "tolerated", 9.0), case(1, "wrong", 1.0), case(2, "wrong", 2.0), case(3, "wrong", 1.0)]
    merged = tally.merged_tally([structs.replace(EMPTY, worst=[case]) for case in kept])
    assert [case.place[1] for case in merged.worst] == [2, 1, 3]
    assert Histogram() != [[]]


def test_tally_keeps_a_case_of_each_status_however_many_others_came_first():
    faults = [unanswered_case((1, n), f"case-{n}", ROW, "error", "why") for n in range(20)]
    faults += [
        unanswered_case((1, 20 + n), f"case-{20 + n}", ROW, name, "why") for n, name in enumerate(("crash", "timeout"))
    ]
    tallied = tally.merged_tally([structs.replace(EMPTY, faults=[fault]) for fault in reversed(faults)])
    assert Counter(fault.status for fault in tallied.faults) == {"error": 5, "crash": 1, "timeout": 1}
    shown = [(fault.case, fault.status) for fault in line_of(tallied).faults]
    assert shown == [*((f"case-{n}", "error") for n in range(3)), ("case-20", "crash"), ("case-21", "timeout")]
    faults += [
        unanswered_case((1, n), f"case-{n}", ROW, name, "why") for n, name in ((22, "not-run"), (23, "protocol"))
    ]
    shown = [fault.status for fault in line_of(structs.replace(EMPTY, faults=faults)).faults]
    assert shown == ["error", "crash", "timeout", "not-run", "protocol"]


@pytest.mark.parametrize("spread", [1, 5, 400, 10**6])
def test_pairs_of_numbers_are_counted_however_far_they_are_apart(spread):
    draw = np.random.default_rng(spread)
    first, second = draw.integers(-spread, spread + 1, (2, 3000))
    amiss = draw.random(3000) < 0.3
    found = tally._counted(first, second, amiss).as_lists()
    cases = Counter(zip(first.tolist(), second.tolist(), strict=True))
    wrong = Counter(zip(first[amiss].tolist(), second[amiss].tolist(), strict=True))
    assert found == [[*pair, count, wrong[pair]] for pair, count in sorted(cases.items())]


@pytest.mark.parametrize("unit", [1.0, 1e-200, 1e200])
def test_places_are_eighths_of_the_hyperboloids_sizes(unit):
    rows = np.array(
        [[10, 5, 1, 1, 3, 4, -2], [10, 5, 1, 1, -4, 3, 2], [10, 5, 1, 1, 0, 0, 0], [1, 1, 1, 1, 0, 5e3, 9e3]]
    )
    found = tally.by_place(rows * unit, np.array([True, False, False, False])).as_lists()
    assert found == [[0, 0, 1, 0], [4, 3, 2, 1], [tally.FAR, tally.FAR, 1, 0]]


def test_rows_with_one_size_or_several_are_counted_in_bins_by_the_octaves_of_their_sizes():
    rows = np.array([[8.0, 1, 1, 3, 0, 0, 0], [8.0, 1, 1, 3, 9, 9, 9]])
    amiss = np.array([True, False])
    assert tally.by_size(rows, amiss).as_lists() == [[3, -2, 2, 1]]
    rows[1, 3] = 0.9
    assert tally.by_size(rows, amiss).as_lists() == [[3, -2, 1, 1], [3, 0, 1, 0]]


def test_radii_of_places_count_both_coordinates_alike():
    assert tally._radius(np.array([[1.0, 1, 1, 1, 4, 3, 0], [1.0, 1, 1, 1, -12, 5, 0]])).tolist() == [5, 13]


def test_rows_of_one_scene_are_in_one_size_bin_wherever_their_spheroids_are():
    rows = np.array([[2.0, 16.0, 0.25, 0.5, x, 0.0, 0.0] for x in (1.0, 2.0, 3.0)])
    assert tally.by_size(rows, np.array([True, False, True])).as_lists() == [[3, 5, 3, 2]]


def test_line_of_a_worst_answer_has_the_time_of_a_sweep_and_bounds_of_its_first_contact():
    """A ball of radius 1/2 comes along the x axis from 5 to 1 and meets the throat of radius 1 at 3/2: at 7/8."""
    way = (1.0, 4.0, 0.5, 0.5, 5.0, 0.0, 0.0, 1.0, 0.0, 0.0)
    case = worst_case((1, 0), "mine/0", way, 1, 1, "late", "wrong", 0.25, 0.9375, layout=SWEEPS)
    found = tally.worst_line(case, Criterion("passage", tolerance=Fraction(0)))
    assert (found.case, found.mistake, found.time, found.backward_error) == ("mine/0", "late", 0.9375, 0.25)
    assert found.first[0] <= 0.875 <= found.first[1] < found.first[0] + 1e-9
    still = worst_case((1, 1), "mine/1", way[:7], 1, 0, "false-contact", "wrong", 0.25)
    found = tally.worst_line(still, CRITERION)
    assert (found.case, found.row[4], found.time, found.first) == ("mine/1", (5.0).hex(), UNSET, UNSET)


def test_record_line_has_counts_of_answers_only_for_an_implementation_under_test_that_was_asked():
    whole = tallied(rows_near_contact(30))
    assert line_of(whole).answers
    assert line_of(EMPTY).answers is UNSET
    assert tally.group_line(whole, "family", CRITERION, method="mine", title="mine").answers is UNSET
