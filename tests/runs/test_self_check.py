"""A self-check as a whole: its exit code and its reports, and the exit code for each error that it can find."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner

from hypcheck.cli.verify import verify
from hypcheck.derivation import printed_equations
from hypcheck.derivation import proofs as derivation_proofs
from hypcheck.geometry.pair import Position
from hypcheck.implementations import builtin
from hypcheck.record import read
from hypcheck.record.fields import as_json
from hypcheck.record.lines import DriftLine, OracleLine, TimingLine
from hypcheck.runs import oracles, self_check
from tests.support.shared_folders import made_once

SMALL = ["--count", "6", "--workers", "1", "--families", "ring,tangent"]
MORE = ["--count", "6", "--families", "ring,tangent,tower-body"]
UNMESHED = ["--oracles", "exact,nearest,roots"]
"""For errors that have nothing to do with meshes, on which a small run spends most of its time."""


def ended(tmp_path, *options):
    result = CliRunner().invoke(verify, ["--self", "--out", str(tmp_path), *SMALL, *options], standalone_mode=False)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result


def exit_code(tmp_path):
    return read(tmp_path / "record.jsonl").footer.exit_code


@pytest.fixture(scope="module")
def derived(tmp_path_factory):
    """The derivation, made once for all tests here, because it is the same in every run."""

    def make(folder):
        (folder / "derived").write_bytes(pickle.dumps(self_check.derivation()))

    made = made_once(tmp_path_factory, "derivation", make) / "derived"
    return pickle.loads(made.read_bytes())  # noqa: S301 - it was written a moment ago


def shorten(monkeypatch, derived):
    equations, proofs = derived
    monkeypatch.setattr(printed_equations, "check_equations", lambda: equations)
    monkeypatch.setattr(derivation_proofs, "prove_formulas", lambda: proofs)
    monkeypatch.setattr(self_check, "TIMING_ROUNDS", 1)
    monkeypatch.setattr(self_check, "TIMED_ROWS", 10)


@pytest.fixture(scope="module")
def whole(tmp_path_factory, derived):
    """The folder of a run without errors, with all its reports."""
    folder = tmp_path_factory.mktemp("whole")
    with pytest.MonkeyPatch.context() as patch:
        shorten(patch, derived)
        ended(folder, *MORE)
    return folder


@pytest.fixture(autouse=True)
def quick(monkeypatch, derived, text_reports):
    shorten(monkeypatch, derived)


def test_self_check_ends_with_0_and_writes_its_reports(whole):
    assert exit_code(whole) == 0
    files = {path.name for path in whole.iterdir()}
    assert files >= {"record.jsonl", "summary.json", "report.md", "junit.xml", "report.html", "map.svg"}
    summary = json.loads((whole / "summary.json").read_text(encoding="utf-8"))
    assert summary["exit_code"] == 0
    assert set(summary["oracles"]) == {"exact", "nearest", "roots", "mesh"}


def test_undisturbed_small_run_ends_with_0(tmp_path):
    ended(tmp_path)
    assert exit_code(tmp_path) == 0


@pytest.mark.parametrize("name", ["exact", "nearest", "roots", "mesh"])
def test_wrong_oracle_ends_the_run_with_6_and_its_case_is_printed(tmp_path, monkeypatch, name):
    """The oracle says contact for exterior cases."""
    right = oracles.ORACLES[name]

    def lying(rows):
        given = list(right.ask(rows))
        return [
            replace(opinion, position=Position.CONTACT) if opinion.position is Position.EXTERIOR else opinion
            for opinion in given
        ]

    monkeypatch.setitem(oracles.ORACLES, name, replace(right, ask=lying))
    result = ended(tmp_path, *([] if name == "mesh" else UNMESHED))
    assert exit_code(tmp_path) == 6
    disagreeing = [line for line in read(tmp_path / "record.jsonl").of(OracleLine) if line.disagreeing]
    assert {line.oracle for line in disagreeing} == {name}
    case = disagreeing[0].disagreements[0].case
    assert any(line.disagreements[0].case in result.output for line in disagreeing), case


def test_oracle_with_wrong_tangencies_ends_the_run_with_6(tmp_path, monkeypatch):
    right = oracles.ORACLES["nearest"]

    def lying(rows):
        return [replace(opinion, tangent=False) for opinion in right.ask(rows)]

    monkeypatch.setitem(oracles.ORACLES, "nearest", replace(right, ask=lying))
    ended(tmp_path, *UNMESHED)
    assert exit_code(tmp_path) == 6


def test_refused_certificate_ends_the_run_with_6(tmp_path, monkeypatch):
    monkeypatch.setattr("hypcheck.truth.certificate.check_certificate", lambda pair, certificate: False)
    ended(tmp_path, *UNMESHED)
    assert exit_code(tmp_path) == 6


def test_wrong_exact_method_ends_the_run_with_1(tmp_path, monkeypatch):
    methods = dict(builtin.builtin_methods())
    methods["fast"] = replace(methods["fast"], answer=lambda rows: np.zeros(len(rows), dtype=np.int8))
    monkeypatch.setattr(self_check, "builtin_methods", lambda: methods)
    ended(tmp_path)
    assert exit_code(tmp_path) == 1


def test_unknown_finding_ends_the_run_with_1(tmp_path, monkeypatch):
    monkeypatch.setattr(self_check.findings, "known_findings", lambda: ())
    ended(tmp_path, *UNMESHED)
    assert exit_code(tmp_path) == 1
    assert any("not a known finding" in line.sentence for line in read(tmp_path / "record.jsonl").of(DriftLine))


def test_formula_without_a_valid_proof_ends_the_run_with_6(tmp_path, monkeypatch):
    _, right = self_check.derivation()
    monkeypatch.setattr(derivation_proofs, "prove_formulas", lambda: (replace(right[0], holds=False), *right[1:]))
    ended(tmp_path, *UNMESHED)
    assert exit_code(tmp_path) == 6


@pytest.mark.thorough
def test_same_seed_gives_the_same_record_except_for_times(whole, tmp_path):
    def lines(folder):
        return [
            {key: value for key, value in as_json(line).items() if key != "seconds"}
            for line in read(folder / "record.jsonl").lines
            if not isinstance(line, TimingLine)
        ]

    ended(tmp_path, *MORE, "--workers", "2")
    assert lines(whole) == lines(tmp_path)
