"""The directed search of a run: it follows an implementation's answers to where they change, beside the true border."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hypcheck import classify
from hypcheck.cli.main import main
from hypcheck.geometry.rows import within
from hypcheck.implementations.builtin import methods
from hypcheck.implementations.description import Description, parse_domain
from hypcheck.record import read
from hypcheck.record.lines import GroupLine, ImplementationLine
from hypcheck.runs.border_search import SearchStep as Step
from hypcheck.runs.border_search import far_numbers, first_near_rows, first_of, rows_at, searched
from hypcheck.runs.judge import Criterion, Status
from hypcheck.runs.plan import ConformancePlan, searches
from hypcheck.runs.tally import STATUS_CODES
from hypcheck.vectors.border_lines import RUNGS, RUNGS_ON_A_SIDE
from hypcheck.vectors.families import family_of, parse_case_id
from tests.support.inside import float_filter

RIGHT, WRONG = STATUS_CODES[Status.RIGHT], STATUS_CODES[Status.WRONG]
HALF = RUNGS_ON_A_SIDE


def narrow(rows):
    """Escapes every family by default: c/a in one part of a hundred of its range, d grown by 1.5e-8."""
    rows = np.array(rows)
    alpha, gamma, b, d = rows[:, :4].T
    octave = np.log2(gamma / d * b / alpha)
    inside = (octave > 8.4520) & (octave < 8.6460)
    rows[inside, 3] *= 1 + 1.5e-8
    return classify(rows)


def numbers_asked(rows, status, first=0):
    found = []

    def ask(numbers):
        found.append(numbers)
        return status(numbers)

    searched(rows, first, ask)
    return found


def test_search_tests_the_requested_number_of_rows_and_none_twice():
    for rows in (1, 7, 100, 4000):
        for status in (RIGHT, WRONG, STATUS_CODES[Status.ABSTAINED], STATUS_CODES[Status.SKIPPED]):
            some = np.concatenate(numbers_asked(rows, lambda numbers, status=status: np.full(len(numbers), status)))
            assert len(some) == len(set(some.tolist())) == rows


def test_search_finds_the_rung_from_which_on_answers_are_right():
    """On the clear side of one line answers are wrong up to rung 37: its other rungs need not all be asked."""
    line = 2 * (400 // 32) + 3  # not a far one, which come first

    def status(numbers):
        return np.where((numbers // RUNGS == line) & (numbers % RUNGS <= 37), WRONG, RIGHT)

    asked = np.concatenate(numbers_asked(400, status))
    rungs = asked[asked // RUNGS == line] % RUNGS
    assert {37, 38, HALF} <= set(rungs.tolist())
    assert len(rungs) < 16


@pytest.mark.parametrize(("name", "width"), [("search", 7), ("tilted-search", 10)])
def test_rungs_of_a_line_are_clear_on_one_side_of_contact_and_in_contact_on_the_other(name, width):
    rows = family_of(name).rows(3, 64 * RUNGS)
    assert rows.shape == (64 * RUNGS, width)
    positions = float_filter.positions(rows).reshape(64, 2, HALF)
    assert (positions[:, 0] != 0).mean() > 0.97
    assert (positions[:, 1, 3:] == 0).mean() > 0.99
    ratio = rows[:, 2].reshape(64, RUNGS)
    nearest = np.abs(ratio[:, HALF] / ratio[:, 0] - 1)
    assert np.all(nearest < 2.0**-45)
    assert np.all(ratio[:, 2 * HALF - 1] > 1.4 * ratio[:, 0])
    assert np.all(ratio[:, HALF - 1] < 0.6 * ratio[:, 0])


def test_case_of_a_search_is_replayed_by_its_id():
    case = parse_case_id("search/1/5/4711")
    (row,) = rows_at("search", 5, np.array([4711]))
    assert case.family.row(case.seed, case.index) == tuple(row.tolist())
    far = parse_case_id(f"tilted-search/1/5/{10**30}")
    assert within(np.array([far.family.row(far.seed, far.index)[:7]])).all()


def test_search_begins_farther_out_for_a_coarser_precision_and_at_rung_0_for_exact_precision():
    rungs = [first_of(Criterion(precision=name)) for name in ("exact", "binary128", "float64", "float32", "float16")]
    assert rungs == sorted(rungs)
    assert rungs[0] == 0
    assert rungs[-1] < HALF


def test_first_question_of_a_search_contains_all_rows_that_do_not_depend_on_answers():
    step = Step("search", 4, 800)
    (first, *_) = numbers_asked(800, lambda numbers: np.full(len(numbers), WRONG))
    expected = [tuple(row) for row in rows_at("search", 4, far_numbers(step, 0)).tolist()]
    expected += [tuple(row) for row in first_near_rows(step, 0).tolist()]
    assert sorted(expected) == sorted(tuple(row) for row in rows_at("search", 4, first).tolist())


@pytest.fixture
def run(tmp_path, monkeypatch, text_reports):
    monkeypatch.chdir(tmp_path)

    def verify(*options):
        code = main(["verify", *options, "--out", "out"])
        record = read(Path("out"))
        return code, {line.family: line for line in record.of(GroupLine)}, record

    return verify


@pytest.mark.parametrize("families", ["few", pytest.param("all", marks=pytest.mark.thorough)])
def test_narrow_fault_that_escapes_every_family_is_found_by_the_search_and_replayed(
    families, run, built_in, request, capsys
):
    if families == "few":
        request.getfixturevalue("few_families")
    code, groups, _ = run(built_in(narrow))
    assert code == 1
    assert [family for family, line in groups.items() if line.failing] == ["search"]
    case = groups["search"].worst[0]
    assert case.status == "wrong"
    assert main(["replay", case.case, "builtin:narrow"]) == 1
    assert "search" in capsys.readouterr().out


@pytest.mark.usefixtures("few_families")
def test_search_uses_the_seed_of_the_fresh_rows_and_reports_it(run, capsys):
    _, groups, record = run("builtin:fast", "--count", "8", "--fresh", "20261127")
    assert (groups["search"].asked, groups["search"].fresh) == (80, 80)
    (line,) = record.of(ImplementationLine)
    assert line.slices["search"].coordinates == ["distance to contact"]
    assert "a directed search followed upright spheroids from clear to contact" in capsys.readouterr().out


@pytest.mark.usefixtures("few_families")
def test_search_sends_a_slow_implementation_as_many_rows_as_it_takes_and_counts_the_others(run, built_in, monkeypatch):
    spec = built_in(narrow)
    method = methods()["narrow"]
    monkeypatch.setitem(methods(), "narrow", replace(method, max_rows=30))
    search = run(spec, "--count", "8")[1]["search"]
    assert (search.counts["skipped"], search.not_asked) == (50, {"slow": 50})
    assert search.asked == sum(search.counts.values()) - 50 == 30


@pytest.mark.usefixtures("few_families")
def test_search_is_the_same_twice_and_left_out_where_families_are_named_or_sizes_fixed(run):
    once, again = (run("builtin:fast", "--count", "4", "--seed", "9")[1]["search"] for _ in range(2))
    assert once == again
    assert "search" not in run("builtin:fast", "--families", "ring", "--count", "4")[1]
    plan, used = ConformancePlan(("builtin:fast",)), Description("any")
    sizes = parse_domain('{"settings": [{"sizes": [2, 5, 1, 0.5], "z": [-9, 9]}]}')
    assert [step.family for step in searches(plan, used)] == ["search"]
    assert searches(plan, replace(used, domain=sizes)) == ()


def test_kernel_answers_rows_of_the_border_search_as_the_exact_decision_does():
    rows = rows_at("search", 2, np.arange(0, 900 * RUNGS, 31))
    assert np.array_equal(classify(rows), float_filter.positions(rows))
