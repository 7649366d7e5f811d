"""A self-check as a whole: its exit code and its reports, and the exit code for each error that it can find."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner

from hypcheck.cli.verify import verify
from hypcheck.derivation.proofs import Proof
from hypcheck.errors import RunOutcome
from hypcheck.geometry.pair import Position
from hypcheck.implementations import builtin
from hypcheck.record import Recorder, read
from hypcheck.record.fields import as_json
from hypcheck.record.lines import DriftLine, GroupLine, OracleLine, TimingLine
from hypcheck.runs import oracles, self_check
from hypcheck.runs.findings import SelfCheckPlan
from tests.report.test_schemas import GrowingText

MORE = ["--count", "6", "--families", "ring,tangent,tower-body"]
PROVED = Proof("hessian", "delta", True, "as if it had been proved")


EVERY = ("exact", "nearest", "roots", "heights", "mesh")


def checked(oracles=("exact", "nearest", "roots"), proof=PROVED, first=400, **parts):
    """The exit code and the lines of a small run whose derivation is over at once, without the map and the timing.

    Errors that have nothing to do with meshes are looked for without these, which would take most of its time. Methods
    and formulas are asked about the `first` cases.
    """
    plan = SelfCheckPlan(
        ("ring", "tangent"), count=6, judged=first, workers=1, oracles=oracles, exact_formulas=min(first, 60)
    )
    outcome = RunOutcome()
    recorder = Recorder(GrowingText(), self_check.options(plan))
    first, *_ = self_check.SelfCheck(plan, recorder, outcome, derive=lambda: ((), (proof,)), **parts).stages()
    first.run(lambda steps: None)
    return outcome.exit_code, recorder.lines


def test_undisturbed_small_run_ends_with_0():
    assert checked(EVERY)[0] == 0


@pytest.mark.parametrize("name", EVERY)
def test_wrong_oracle_ends_the_run_with_6_and_its_case_is_recorded(monkeypatch, name):
    """The oracle says contact for exterior cases."""
    right = oracles.ORACLES[name]

    def lying(rows):
        given = list(right.ask(rows))
        return [
            replace(opinion, position=Position.CONTACT) if opinion.position is Position.EXTERIOR else opinion
            for opinion in given
        ]

    monkeypatch.setitem(oracles.ORACLES, name, replace(right, ask=lying))
    code, lines = checked(EVERY if name == "mesh" else EVERY[:-1])
    assert code == 6
    disagreeing = [line for line in lines if isinstance(line, OracleLine) and line.disagreeing]
    assert {line.oracle for line in disagreeing} == {name}
    assert all(line.disagreements[0].case for line in disagreeing)


def test_oracle_with_wrong_tangencies_ends_the_run_with_6(monkeypatch):
    right = oracles.ORACLES["nearest"]

    def lying(rows):
        return [replace(opinion, tangent=False) for opinion in right.ask(rows)]

    monkeypatch.setitem(oracles.ORACLES, "nearest", replace(right, ask=lying))
    assert checked()[0] == 6


def test_refused_certificate_ends_the_run_with_6(monkeypatch):
    monkeypatch.setattr("hypcheck.runs.oracles.check_certificate", lambda pair, certificate: False)
    assert checked()[0] == 6


def test_wrong_exact_method_ends_the_run_with_1(monkeypatch):
    methods = builtin.methods()
    wrong = replace(methods["fast"], answer=lambda rows: np.zeros(len(rows), dtype=np.int8))
    monkeypatch.setitem(methods, "fast", wrong)
    assert checked(EVERY)[0] == 1


def test_unknown_finding_ends_the_run_with_1():
    code, lines = checked(known=())
    assert code == 1
    assert any("not a known finding" in line.sentence for line in lines if isinstance(line, DriftLine))


def test_formula_without_a_valid_proof_ends_the_run_with_6():
    assert checked(proof=replace(PROVED, holds=False))[0] == 6


@pytest.mark.thorough
def test_same_seed_gives_the_same_record_except_for_times(tmp_path, text_reports):
    """By the command, which ends with 0 and writes its reports, by one worker and by two."""

    def lines(workers):
        folder = tmp_path / workers
        words = ["--self", "--out", str(folder), *MORE, "--workers", workers]
        assert CliRunner().invoke(verify, words).exit_code == 0
        files = {path.name for path in folder.iterdir()}
        assert files >= {"record.jsonl", "summary.json", "report.md", "junit.xml"}
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        assert set(summary["oracles"]) == set(EVERY)
        record = read(folder / "record.jsonl")
        assert summary["exit_code"] == record.footer.exit_code == 0
        return [
            {key: value for key, value in as_json(line).items() if key not in {"seconds", "started", "workers"}}
            for line in record.lines
            if not isinstance(line, TimingLine)
        ]

    assert lines("1") == lines("2")


def test_cases_beyond_the_first_400_of_a_family_are_sent_only_to_the_oracles(tmp_path, text_reports):
    options = [
        "--families",
        "ring",
        "--judged",
        "5",
        "--roots",
        "3",
        "--oracles",
        "exact,roots",
        "--out",
        str(tmp_path),
    ]
    assert CliRunner().invoke(verify, ["--self", "--count", "403", *options]).exit_code == 0
    record = read(tmp_path)
    assert {line.oracle: line.asked for line in record.of(OracleLine)}["exact"] == 403
    groups = [(line.method, line.asked) for line in record.of(GroupLine)]
    assert len(groups) == len(dict(groups))
    assert max(dict(groups).values()) == 5
