"""The record of an interrupted run is refused if its numbers contradict each other or the plan."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from msgspec import structs

from hypcheck.cli.main import main
from hypcheck.implementations.description import Description
from hypcheck.implementations.session import Limits
from hypcheck.isolation.launch import Isolation
from hypcheck.record import read
from hypcheck.record.fields import as_json, decoded
from hypcheck.record.progress import SavedState
from hypcheck.record.reader import FILE
from hypcheck.runs.cases import Pace
from hypcheck.runs.consistency import MissingCasesError, require_all_tallied, require_lines, require_state
from hypcheck.runs.executors import execution_here
from hypcheck.runs.known_failures import KnownFailure
from hypcheck.runs.plan import ConformancePlan, planned_cases, rules_of, steps_of
from hypcheck.runs.resume import restored_state, saved_state
from hypcheck.runs.schedule import RunState, perform_steps
from hypcheck.runs.tally import EMPTY
from tests.support.records import resealed

KNOWN = (KnownFailure(None, "ring", float("inf"), "the ring"), KnownFailure("axis/1/1/300", None, 9.0, "near"))


PACE = Pace(chunk_rows=64, retest_after=200, single_rows=60)
"""Chunks and rounds small enough that a test has many."""


def plan_of(spec, **options):
    return ConformancePlan(
        (spec,), **{"families": ("ring", "axis"), "count": 200, "limits": Limits(restarts=4), "pace": PACE, **options}
    )


def every_state(plan):
    """Each state of a run of a plan, with the description and the rules that it was judged by."""
    with plan.opener(0).open() as it:
        rules = replace(rules_of(plan, it.description), known=KNOWN)
        with execution_here(it, rules) as performing:
            for _, state in perform_steps(steps_of(plan, it.description), performing, RunState(it.allowance)):
                yield it.description, rules, state


def check(plan, used, rules, content):
    """Raise what a resumed run raises about a state that was read back."""
    require_state(restored_state(decoded(content, SavedState)), steps_of(plan, used), plan, rules)


@pytest.mark.parametrize(
    "plan",
    [
        plan_of("builtin:table-2-float32"),
        plan_of("builtin:table-2-float32", question="contact"),
        plan_of("python:tests.runs.faulty:dies_on_the_axis"),
        plan_of("python:tests.runs.faulty:cannot_say"),
        plan_of("python:tests.runs.faulty:forgetful"),
        plan_of("python:tests.runs.refusing:answers_bad_rows"),
        plan_of(
            "python:tests.runs.leaning:refuses_upright_rows_alone",
            families=("ring", "tilted-ring"),
            limits=Limits(restarts=4, isolation=Isolation("off")),  # it answers by hypcheck
        ),
    ],
    ids=lambda plan: plan.specs[0].rpartition(":")[2],
)
def test_every_saved_state_of_a_run_passes_the_consistency_check(plan):
    kinds = set()
    for used, rules, state in every_state(plan):
        check(plan, used, rules, as_json(saved_state(state)))
        kinds |= {name for tally in state.total.tallies.values() for name in tally.counts}
    require_all_tallied(state.total.tallies, planned_cases(plan, used))
    assert kinds - {"right"}


def leaves(content, *way):
    """The path to every integer of a mapping."""
    parts = content.items() if isinstance(content, dict) else enumerate(content) if isinstance(content, list) else ()
    for name, part in parts:
        yield from leaves(part, *way, name)
    if isinstance(content, int):
        yield way


def _kind(way):
    """The kind of a number: in a tally its field, and whether it is the place of a case."""
    if way[1] != "tallies":
        return way[:2]
    return way[3], "places" if way[3] != "octaves" and way[-1] in (0, 1) else ""


def test_state_with_one_edited_number_is_refused():
    """Except numbers that no other contradicts: restarts left, faults left, retested cases, and places of cases."""
    plan = plan_of("python:tests.runs.faulty:dies_on_the_axis", precision="float32")
    *_, (used, rules, _), (_, _, state) = list(every_state(plan))[:6]
    content = as_json(saved_state(state))
    text = json.dumps(content)
    check(plan, used, rules, json.loads(text))
    believed = set()
    for way in leaves(json.loads(text)):
        for change in (lambda n: n + 1, lambda n: n - 1, lambda _: -5, lambda _: 10**9, lambda _: 10**30):
            edited = json.loads(text)
            part = edited
            for name in way[:-1]:
                part = part[name]
            part[way[-1]] = change(part[way[-1]])
            try:
                check(plan, used, rules, edited)
            except (ValueError, OverflowError):
                continue
            believed.add(_kind(way))
    of_tallies = {("size_bins", "places"), ("place_bins", "places"), ("worst", "places"), ("faults", "places")}
    assert believed <= {("left", "restarts"), ("left", "faults"), ("total", "again"), ("octaves", ""), *of_tallies}


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (lambda state: state.update(done=10**9), "0 cases of axis are tallied, but it has "),
        (lambda state: state.update(done=-5), "Expected `int` >= 0"),
        (lambda state: state["total"]["open"][0].update(indices=[[0, 10**11]]), "which do not match its pending cases"),
        (lambda state: state["total"].update(tallies={}, open=[]), "0 cases of ring are tallied, but it has "),
        (lambda state: state["total"]["tallies"]["ring"]["counts"].update(right=10**12), " cases of ring are tallied"),
        (lambda state: state["left"].update(restarts="many"), "Expected `int`, got `str`"),
        (lambda state: state["total"]["tallies"]["ring"].update(worst=[]), "contradict each other"),
    ],
)
def test_edited_progress_line_is_refused_with_the_reason(edit, said):
    plan = plan_of("builtin:table-2-float32")
    *_, (used, rules, state) = list(every_state(plan))[:7]
    content = as_json(saved_state(state))
    edit(content)
    with pytest.raises(ValueError, match=said):
        check(plan, used, rules, content)


def test_finished_run_without_all_its_cases_ends_with_70():
    cases = planned_cases(plan_of("builtin:fast"), Description("fast"))
    whole = {family: structs.replace(EMPTY, asked=number, counts={"right": number}) for family, number in cases.items()}
    require_all_tallied(whole, cases)
    for tallies in (
        {},
        {**whole, "ring": structs.replace(EMPTY, asked=9, counts={"right": 9})},
        {**whole, "more": structs.replace(EMPTY, asked=1, counts={"right": 1})},
    ):
        with pytest.raises(MissingCasesError, match="this run proves nothing") as caught:
            require_all_tallied(tallies, cases)
        assert caught.value.exit_code == 70


@pytest.mark.usefixtures("text_reports")
def test_run_with_edited_lines_of_a_finished_implementation_is_not_resumed(tmp_path, capsys):
    specs = ["builtin:table-2-float32", "builtin:fast"]
    words = ["verify", *specs, "--families", "ring", "--count", "30", "--out", str(tmp_path)]
    assert main(words) == 1
    record = read(tmp_path / FILE)
    group, _causes, whole = record.lines[:3]
    plan = replace(plan_of(specs[0]), families=("ring",), count=30)
    require_lines([group], whole, plan)
    edited = [record.header, structs.replace(group, failing=[]), whole]
    (tmp_path / FILE).write_bytes(resealed(map(as_json, edited)))
    before = (tmp_path / FILE).read_bytes()
    capsys.readouterr()
    assert main([*words, "--resume", str(tmp_path)]) == 2
    assert "ring fails for [], but by its counts for ['wrong']" in capsys.readouterr().err
    assert Path(tmp_path / FILE).read_bytes() == before
    for field, number in (("asked", 3), ("counts", {"right": group.asked}), ("mistakes", {})):
        with pytest.raises(ValueError, match="ring"):
            require_lines([structs.replace(group, **{field: number})], whole, plan)
