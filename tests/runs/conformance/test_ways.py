"""Conformance runs of implementations that answer about ways: verdicts, records, reports and what is refused."""

from __future__ import annotations

import json

import numpy as np
import pytest
from msgspec import structs

from hypcheck.cli.main import main
from hypcheck.geometry.rows import SWEEPS
from hypcheck.implementations.description import Description
from hypcheck.implementations.session import Allowance
from hypcheck.record import read
from hypcheck.record.fields import as_json, decoded
from hypcheck.record.lines import GroupLine, ImplementationLine
from hypcheck.record.progress import SavedState
from hypcheck.runs.cases import CaseChunk
from hypcheck.runs.plan import invalid_rows
from hypcheck.runs.results import CasesResult, PendingRetest
from hypcheck.runs.resume import restored_state, saved_state
from hypcheck.runs.schedule import RunState
from hypcheck.runs.tally import EMPTY
from hypcheck.vectors import frozen
from tests.runs import moving
from tests.support.records import unanswered_case, worst_case
from tests.tools.miniatures import function

pytestmark = pytest.mark.usefixtures("text_reports")

FEW = ("--families", "way-tunnelling", "--count", "6")
BY_HYPCHECK = ("--isolate", "off")
"""For functions that answer ways by hypcheck: nothing else here answers them rightly."""
ASKED = len(frozen.load("way-tunnelling").cases) + 6
ROW = (1.0, 2.0, 1.0, 1.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def verified(folder, *words):
    return main(["verify", *words, "--out", str(folder)])


@pytest.mark.thorough
def test_sampled_passage_fails_with_missed_contacts_and_late_times_counted_separately(tmp_path):
    assert verified(tmp_path, "builtin:passage-sampled-4", *FEW) == 1
    (group,) = (line for line in read(tmp_path).of(GroupLine))
    assert group.question == "passage"
    assert group.counts == {"wrong": ASKED}
    assert set(group.mistakes) <= {"false-clear", "late"}
    for case in group.worst:
        assert len(case.row) == 7
        assert len(case.end) == 3
        assert (case.mistake == "late") is bool(case.time)
    (line,) = read(tmp_path).of(ImplementationLine)
    assert line.used.times is True
    summary = json.loads((tmp_path / "summary.json").read_text())
    counted = summary["implementations"][0]["mistakes"]
    assert counted["false-clear"] + counted.get("late", 0) == ASKED
    report = (tmp_path / "report.md").read_text()
    assert "in contact on the sweep" in report


@pytest.mark.slow
def test_right_passage_function_passes_and_repeats_its_times_in_the_retest(tmp_path):
    assert verified(tmp_path, function("passage"), *FEW, *BY_HYPCHECK) == 0
    group, refused = (line for line in read(tmp_path).of(GroupLine))
    assert group.counts == {"right": ASKED}
    assert list(refused.counts) == ["refused"]
    (line,) = read(tmp_path).of(ImplementationLine)
    assert line.retest.asked >= 6
    assert (line.retest.within, line.retest.beyond) == (0, 0)


@pytest.mark.slow
def test_known_failure_of_a_sweep_is_excused_and_fails_the_run_if_it_no_longer_occurs(tmp_path, capsys):
    listed = tmp_path / "known.toml"
    some = [case.id for case in frozen.load("way-still").cases[:3]]
    entries = {"family": ["way-tunnelling", "way-still"], "case": some}
    listed.write_text(
        "".join(
            f'[[known_failure]]\n{kind} = "{name}"\nreason = "four samples"\n'
            for kind, names in entries.items()
            for name in names
        )
    )
    few = ("--families", "way-tunnelling,way-still", "--count", "0", "--known-failures", str(listed))
    assert verified(tmp_path / "out", "builtin:passage-sampled-4", *few) == 1
    groups = {line.family: line for line in read(tmp_path / "out").of(GroupLine)}
    tunnelling, still = groups["way-tunnelling"], groups["way-still"]
    assert tunnelling.counts == {"excused": 108}
    assert tunnelling.failing == []
    assert {case.status for case in tunnelling.worst} == {"excused"}
    assert still.counts == {"right": 108}
    said = capsys.readouterr().out
    assert "the family way-still no longer fails, but is listed as a known failure (four samples)" in said
    assert "the family way-tunnelling no longer" not in said
    for name in some:  # nothing moves, so one sample sees all
        assert f"the case {name} no longer fails" in said


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            ("builtin:passage-exact", "--families", "ring"),
            "--families names ring, which has no cases for the question 'passage'; leave it out, or name an",
        ),
        (
            ("builtin:passage-exact", "--families", "ring-*"),
            "ring-*: none of these families has cases for the question 'passage'",
        ),
        (
            ("builtin:fast", "--families", "way-any*"),
            "none of these families has cases for the question 'position'",
        ),
        (("builtin:fast", "--question", "passage"), 'its description must say "question": "passage"'),
    ],
)
def test_verify_refuses_families_that_do_not_match_the_question(words, sentence, tmp_path, capsys):
    assert verified(tmp_path, *words) == 2
    assert sentence in capsys.readouterr().err


@pytest.mark.slow
def test_invalid_sweeps_are_sent_to_implementations_that_declare_refuses(built_in, tmp_path):
    assert verified(tmp_path, built_in(moving.clear_from_infinity, **moving.hypcheck), *FEW) == 1
    found = {line.family: line for line in read(tmp_path).of(GroupLine)}
    assert found["way-tunnelling"].counts == {"right": ASKED}
    assert found["tilted-way-invalid"].counts["refused"] > 100
    group = found["way-invalid"]
    file = frozen.load("way-invalid")
    assert group.counts["wrong"] == (~np.isfinite(file.rows[:, 4:]).all(axis=1)).sum()
    assert group.faults
    assert all(fault.reason.startswith("answered 0; a row with an invalid ") for fault in group.faults)


def test_invalid_sweeps_are_chosen_by_declared_refuses_tilt_and_heights():
    def chosen(**said):
        return [each.family for each in invalid_rows(Description("any", question="passage", **said))]

    assert chosen(refuses=True, tilt=True) == ["way-invalid", "tilted-way-invalid"]
    assert chosen(refuses=True, tilt=False) == ["way-invalid"]
    assert chosen(refuses=False, tilt=True, heights=True) == []
    assert chosen(refuses=True, tilt=True, heights=True)[2:] == ["ended-way-invalid"]
    assert chosen(refuses=True, tilt=False, heights=True) == ["way-invalid"]


def test_saved_progress_keeps_ends_and_times_of_sweeps():
    worst = worst_case((1, 0), "way-anywhere/1/1/0", ROW, 1, 1, "late", "wrong", 0.5, 0.75, layout=SWEEPS)
    lost = unanswered_case((1, 1), "way-anywhere/1/1/1", (*ROW, 0.0, 3.0, 4.0), "crash", "it crashed", SWEEPS)
    pending = PendingRetest(
        CaseChunk("way-anywhere", 1, 2, 4), np.arange(2), np.array([1, 0], dtype=np.int8), np.array([0.25, np.nan])
    )
    total = CasesResult({"way-anywhere": structs.replace(EMPTY, asked=2, worst=[worst], faults=[lost])}, (pending,))
    state = decoded(as_json(saved_state(RunState(Allowance(1, 1), 1, total))), SavedState)
    back = restored_state(state).total
    assert back.tallies == total.tallies
    np.testing.assert_array_equal(back.pending[0].times, pending.times)
    assert back.pending[0].answers.tolist() == [1, 0]
