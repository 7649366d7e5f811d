"""Each known mistake about sweeps gives the answers of an implementation with it, and is silent about others."""

from __future__ import annotations

import numpy as np
import pytest

import hypcheck
from hypcheck.runs.causes import SILENT, AnsweredRows
from hypcheck.runs.judge import Criterion
from hypcheck.runs.sweep_causes import SWEEP_CAUSES
from tests.support.fractions_truth import exact_position

SIZES = (2.0, 3.0, 0.25, 0.15)
COUNT = 150
RULES = {cause.name: cause.rule for cause in SWEEP_CAUSES}


def ways(count, seed=7):
    ends = np.random.default_rng(seed).uniform(-4.0, 4.0, (count, 6))
    return np.hstack([np.tile(SIZES, (count, 1)), ends])


ROWS = ways(COUNT)
TRUTH = [hypcheck.passage(row[:4], row[4:7], row[7:]) for row in ROWS.tolist()]
HITS = np.array([each.hit for each in TRUTH], dtype=np.int8)
FIRST = np.array([each.first_lower if each.hit else np.nan for each in TRUTH])
STARTS, ENDS = (
    np.array([exact_position((*SIZES, *row[place : place + 3])) == 0 for row in ROWS.tolist()], dtype=np.int8)
    for place in (4, 7)
)


def answered(given, times=None, rows=ROWS, truth=HITS):
    return AnsweredRows(rows, truth, np.asarray(given, dtype=np.int8), Criterion("passage"), times)


def hits_of(change):
    return [hypcheck.passage(row[:4], row[4:7], row[7:]).hit for row in map(change, ROWS.tolist())]


def test_sweeps_of_these_tests_have_contacts_at_the_start_in_between_and_none():
    assert 5 < STARTS.sum() < 50
    assert 5 < (HITS & ~STARTS & ~ENDS & 1).sum()
    assert 5 < (HITS == 0).sum()


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("only-the-start", STARTS),
        ("only-the-end", ENDS),
        ("only-the-ends", STARTS | ENDS),
        ("way-always-0", np.zeros(COUNT)),
        ("way-always-1", np.ones(COUNT)),
        ("way-x-z", lambda r: [*r[:4], r[6], r[5], r[4], r[9], r[8], r[7]]),
        ("way-b-d", lambda r: [r[0], r[1], r[3], r[2], *r[4:]]),
        ("way-level", lambda r: [*r[:9], r[6]]),
    ],
)
def test_rule_of_a_mistake_gives_the_answers_of_an_implementation_with_it(name, given):
    """A function stands for the exact answers about the rows that it makes of the right ones."""
    given = hits_of(given) if callable(given) else given
    assert RULES[name](answered(given)).tolist() == np.asarray(given, dtype=np.int8).tolist()


def test_positions_tested_for_the_sweep_explain_only_missed_contacts():
    given = STARTS | ENDS
    said = RULES["between-positions"](answered(given))
    missed = (HITS == 1) & (given == 0)
    assert missed.any()
    assert (said[missed] == 0).all()
    assert (said[~missed] == SILENT).all()


def test_causes_of_swapped_columns_do_not_apply_to_tilted_spheroids():
    leaning = np.hstack([ROWS, np.tile([0.0, 0.0, 1.0], (COUNT, 1))])
    assert (RULES["way-x-z"](answered(HITS, rows=leaning)) == SILENT).all()
    assert RULES["only-the-start"](answered(HITS, rows=leaning)).tolist() == STARTS.tolist()


def test_cause_does_not_explain_a_hit_at_a_time_that_its_rule_does_not_give():
    times = np.where(STARTS == 1, 0.0, np.nan)
    assert RULES["only-the-start"](answered(STARTS, times)).tolist() == STARTS.tolist()
    later = RULES["only-the-start"](answered(STARTS, times + 0.5))
    assert (later[STARTS == 1] == SILENT).all()


ON_THE_WAY = (HITS == 1) & (FIRST > 0.01) & (FIRST < 0.45)


def explained(name, times):
    return RULES[name](answered(HITS, times)) == 1


@pytest.mark.slow
def test_cause_times_from_the_end_explains_times_counted_from_the_end_and_no_right_time():
    assert explained("times-from-the-end", 1 - FIRST)[ON_THE_WAY].all()
    assert not explained("times-from-the-end", FIRST)[ON_THE_WAY].any()


@pytest.mark.parametrize(("name", "off"), [("late-times", 1e-4), ("early-times", -1e-4)])
def test_slightly_wrong_times_are_distinguished_by_direction(name, off):
    assert ON_THE_WAY.sum() > 5
    assert explained(name, FIRST + off)[ON_THE_WAY].all()
    for other in (FIRST - off, FIRST, FIRST + 100 * off):
        assert not explained(name, other)[ON_THE_WAY].any()


@pytest.mark.parametrize("later", [0.1, 0.3])
def test_cause_sampled_times_explains_times_of_contact_much_later_than_the_first(later):
    times = FIRST + later
    centres = ROWS[:, 4:7] + times[:, None] * (ROWS[:, 7:] - ROWS[:, 4:7])
    touches = np.zeros(COUNT, dtype=np.bool_)
    for place in np.flatnonzero(ON_THE_WAY):
        touches[place] = exact_position((*SIZES, *centres[place].tolist())) == 0
    assert touches.any()
    assert (ON_THE_WAY & ~touches).any()
    assert (explained("sampled-times", times) & ON_THE_WAY).tolist() == touches.tolist()
    for other in (FIRST, FIRST + 1e-4, FIRST - 0.005):
        assert not explained("sampled-times", other)[ON_THE_WAY].any()


@pytest.mark.parametrize("name", ["times-from-the-end", "late-times", "sampled-times"])
def test_causes_about_times_do_not_apply_to_answers_without_times(name):
    assert (RULES[name](answered(HITS)) == SILENT).all()
