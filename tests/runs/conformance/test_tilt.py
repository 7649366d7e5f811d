"""`verify SPEC` with implementations that take tilted spheroids: questions, judging, and the record."""

from __future__ import annotations

import json
from fractions import Fraction

import numpy as np
import pytest
from msgspec import structs

from hypcheck.cli.main import main
from hypcheck.errors import Exit, InputError, RunOutcome
from hypcheck.geometry.pair import Position
from hypcheck.implementations.description import Description
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.session import Answered
from hypcheck.record import Recorder, read
from hypcheck.record.fields import as_json, decoded, numbers_of
from hypcheck.record.lines import GroupLine, ImplementationLine
from hypcheck.record.progress import SavedResult
from hypcheck.runs import judge
from hypcheck.runs.cases import CaseChunk, Pace, cases_of_chunk
from hypcheck.runs.conformance import add_exit_codes, run_conformance
from hypcheck.runs.judge import Criterion, Status
from hypcheck.runs.plan import ConformancePlan, invalid_rows, planned_cases, planned_size, steps_of
from hypcheck.runs.results import CasesResult, JudgingRules, PendingRetest
from hypcheck.runs.resume import restored_result, saved_result
from hypcheck.runs.retest import RetestStep, retest
from hypcheck.runs.tally import EMPTY
from hypcheck.vectors import frozen
from hypcheck.vectors.families import FAMILIES, TILTED_FAMILIES
from tests.runs import leaning
from tests.support.judging import ends_of, wrong_cases
from tests.support.records import GrowingText, unanswered_case, worst_case
from tests.support.tilted_fractions import exact_position

pytestmark = [pytest.mark.usefixtures("text_reports"), pytest.mark.slow]

SPEC = "python:tests.runs.leaning:"
LEANING = "tilted-uniform"
FEW_AGAIN = Pace(single_rows=60)
BESIDE = (2.0, 5.0, 1.0, 0.5, 2.5, 0.0, 0.0, 1.0, 0.0, 1.0)
"""In contact."""


TAKES_TILT = {"tilt": True, "refuses": True}


def verified(out, spec, *options, count):
    code = main(["verify", spec, "--out", str(out), "--count", count, *options, "--isolate", "off"])
    return code, read(out)  # these implementations answer by hypcheck


@pytest.fixture
def gate(tmp_path, built_in):
    return lambda function, *options, count="9": verified(
        tmp_path, built_in(function, **TAKES_TILT), *options, count=count
    )


def by_family(record):
    return {line.family: line for line in record.of(GroupLine)}


def test_a_right_implementation_of_tilted_spheroids_passes_on_upright_and_tilted_families(gate):
    code, record = gate(leaning.exact, "--families", f"ring,{LEANING}")
    found = by_family(record)
    assert code == 0
    assert set(found) == {"ring", LEANING, "invalid", "tilted-invalid"}
    assert set(found[LEANING].counts) <= {"right", "skipped"}
    (line,) = record.of(ImplementationLine)
    assert line.declared.tilt is line.used.tilt is True
    assert line.retest.asked > 30


def test_implementation_that_answers_an_axis_without_direction_is_wrong_only_on_tilted_invalid_rows(
    gate,
):
    code, record = gate(leaning.refuses_upright_rows_alone, "--families", "ring", count="0")
    found = by_family(record)
    assert code == 1
    assert found["invalid"].counts == {"refused": found["invalid"].asked}
    assert found["tilted-invalid"].asked == len(frozen.load("tilted-invalid").cases)
    assert found["tilted-invalid"].failing == ["wrong"]
    assert found["tilted-invalid"].faults
    for fault in found["tilted-invalid"].faults:
        assert not any(map(float.fromhex, fault.axis))
        assert fault.reason == "answered 0; a row with an invalid axis_x and axis_y and axis_z must be refused: 127"


def test_tilted_invalid_rows_are_tested_only_if_refuses_and_tilt_are_declared():
    found = [each.family for each in invalid_rows(Description("any", refuses=True, tilt=True))]
    assert found == ["invalid", "tilted-invalid"]
    assert [each.family for each in invalid_rows(Description("any", refuses=True))] == ["invalid"]
    assert invalid_rows(Description("any", tilt=True)) == ()


def test_implementation_that_ignores_the_axis_is_wrong_only_on_tilted_spheroids_and_the_record_has_the_axis(
    gate, tmp_path
):
    code, record = gate(leaning.upright, "--families", f"ring,{LEANING}")
    found = by_family(record)
    assert code == 1
    assert set(found["ring"].counts) <= {"right", "skipped"}
    assert found[LEANING].counts["wrong"] > 0
    for case in found[LEANING].worst:
        row = tuple(map(float.fromhex, numbers_of(case)))
        assert len(row) == 10
        assert exact_position(row) == case.truth != case.answer
        assert float(case.backward_error_u) > 8
    assert f'"axis": ["{found[LEANING].worst[0].axis[0]}"' in (tmp_path / "record.jsonl").read_text("utf-8")


def test_fault_about_a_tilted_spheroid_affects_only_its_case_and_is_recorded_with_its_axis(tmp_path):
    code, record = verified(tmp_path, f"{SPEC}raises_far_over", "--families", LEANING, count="0")
    faults = [fault for line in record.of(GroupLine) for fault in line.faults if fault.status == "error"]
    assert code == 1
    assert faults
    assert by_family(record)[LEANING].counts["right"] > len(faults)
    for fault in faults:
        axis_x, _, axis_z = map(float.fromhex, numbers_of(fault)[7:])
        assert axis_x > abs(axis_z)
        assert "no heading" in fault.reason


def test_the_progress_of_a_run_counts_every_case_of_an_implementation_with_tilt(built_in):
    steps, more = [], []
    plan = ConformancePlan((built_in(leaning.exact, **TAKES_TILT),), ("ring", "tilted-ring"), count=3, pace=FEW_AGAIN)
    run_conformance(plan, Recorder(GrowingText(), {}), RunOutcome(), steps.append, expect=more.append)
    assert more == [sum(len(frozen.load(name).cases) for name in ("invalid", "tilted-invalid"))]
    assert sum(steps) == planned_size(plan) + sum(more)


@pytest.mark.thorough
def test_the_frozen_vectors_of_tilted_spheroids_are_counted_by_their_distance(gate):
    code, record = gate(leaning.upright, "--families", "tilted-tangent,tilted-slight", count="3")
    found = by_family(record)
    assert code == 1
    assert sum(found["tilted-tangent"].octaves["-inf"].values()) == found["tilted-tangent"].asked - 3
    counted = {float(key): sum(each.values()) for key, each in found["tilted-slight"].octaves.items()}
    assert sum(counted.values()) == found["tilted-slight"].asked - 3
    cases = frozen.load("tilted-slight").cases
    near = [case for case in cases if case.position and case.flips[Position.CONTACT].lower < 2.0**-40]
    assert len(near) <= sum(number for exponent, number in counted.items() if exponent < -40)


def test_an_implementation_without_tilt_gets_no_family_of_tilted_spheroids():
    plan = ConformancePlan(("builtin:fast",), families=("*",), count=5)
    upright, tilted = (planned_cases(plan, Description("any", tilt=tilt)).keys() for tilt in (False, True))
    assert not upright & TILTED_FAMILIES.keys()
    assert tilted == upright | TILTED_FAMILIES.keys()
    alone = ConformancePlan(("builtin:fast",), families=("tilted-*",))
    assert planned_cases(alone, Description("plain")) == {}
    with pytest.raises(InputError, match=r"tilted-\*: these are families of tilted spheroids, and plain takes none"):
        steps_of(alone, Description("plain"))


def test_naming_families_of_tilted_spheroids_for_an_implementation_without_tilt_is_a_usage_error(tmp_path, capsys):
    for families, sentence in (
        (LEANING, f"--families names {LEANING}, a family of tilted spheroids, and fast takes none; leave it out"),
        ("tilted-u*", "tilted-u*: these are families of tilted spheroids, and fast takes none"),
    ):
        assert main(["verify", "builtin:fast", "--families", families, "--out", str(tmp_path)]) == 2
        assert sentence in capsys.readouterr().err


def test_record_of_an_implementation_without_tilt_has_no_field_about_tilt(tmp_path):
    assert main(["verify", "builtin:fast", "--families", "ring", "--count", "5", "--out", str(tmp_path)]) == 0
    _, *lines = map(json.loads, (tmp_path / "record.jsonl").read_text().splitlines())
    text = json.dumps([{key: value for key, value in line.items() if key != "not_asked"} for line in lines])
    assert "tilt" not in text
    assert "axis" not in text


def test_answers_about_upright_rows_of_ten_numbers_keep_their_exact_backward_error():
    rows = FAMILIES["uniform"].rows(3, 60)
    axes = np.tile([0.0, 0.0, -7.5], (len(rows), 1))
    answers = np.zeros(len(rows), dtype=np.int8)
    truth = judge.exact_positions(rows)
    upright, ten = (wrong_cases(some, truth, answers, Criterion()) for some in (rows, np.column_stack([rows, axes])))
    assert len(upright) > 10
    for one, other in zip(upright, ten, strict=True):
        assert (one.status, one.exponent) == (other.status, other.exponent)
        assert judge.measured(one, "position") == judge.measured(other, "position")


def test_recorded_error_of_a_wrong_answer_about_a_tilted_spheroid_is_a_lower_bound():
    (case,) = wrong_cases(np.array([BESIDE]), np.zeros(1, dtype=np.int8), np.array([1], dtype=np.int8), Criterion())
    low, high = ends_of(case.row, case.answer)
    assert exact_position(BESIDE) == 0
    assert case.status is Status.WRONG
    assert low / 1.25 < judge.measured(case, "position") <= low <= high
    tolerant = Criterion(tolerance=Fraction(high) * 2**53)
    (case,) = wrong_cases(np.array([BESIDE]), np.zeros(1, dtype=np.int8), np.array([1], dtype=np.int8), tolerant)
    assert case.status is Status.TOLERATED
    assert low <= judge.measured(case, "position") <= 1.25 * high


@pytest.mark.thorough
def test_an_undecided_answer_makes_a_run_inconclusive_that_would_have_passed_and_is_shown(gate, tmp_path, capsys):
    code, record = gate(leaning.wrong_where_no_proof_is_found, "--families", "tilted-twins", count="0")
    shown = capsys.readouterr().out
    group = by_family(record)["tilted-twins"]
    assert code == Exit.INCONCLUSIVE
    assert group.counts["undecided"] == 1
    assert group.failing == ["undecided"]
    assert (group.worst[0].case, group.worst[0].status) == (leaning.UNDECIDED, "undecided")
    assert "INCONCLUSIVE, exit code 4: 1 answer undecided: the tolerance lies between the two ends" in shown
    assert leaning.UNDECIDED in (tmp_path / "report.md").read_text("utf-8")
    outcome = RunOutcome()
    add_exit_codes(record.lines, outcome)
    assert outcome.codes == {Exit.INCONCLUSIVE}


class AskedAgain:
    """Answers rightly, and remembers how many numbers the rows had."""

    proven_batch = 1
    scene = False

    def __init__(self):
        self.widths = set()

    def close(self):
        """Nothing to begin afresh."""

    def classify(self, rows, *, batch=None, by_scene=False):
        """The exact answers."""
        self.widths.add(rows.shape[1])
        return Answered.of(judge.exact_positions(rows))


def test_pending_cases_of_upright_and_tilted_spheroids_are_retested_together():
    chunks = [CaseChunk("uniform", 1, 0, 20), CaseChunk(LEANING, 1, 0, 20)]
    some = tuple(PendingRetest(chunk, np.arange(20), cases_of_chunk(chunk).positions) for chunk in chunks)
    subject = AskedAgain()
    result = retest(RetestStep(0, 0, some), subject, JudgingRules(Criterion(), Domain()))
    assert subject.widths == {10}
    assert result.retest.asked == 40
    assert {family: dict(each.counts) for family, each in result.tallies.items()} == {
        "uniform": {"right": 20},
        LEANING: {"right": 20},
    }


def test_saved_state_of_an_interrupted_run_holds_the_axis_of_its_cases():
    worst = worst_case((1, 3), f"{LEANING}/1/1/3", BESIDE, 0, 1, "false-clear", "wrong", 0.25)
    fault = unanswered_case((0, 2), "invalid-0100", (*BESIDE[:7], 0.0, float("nan"), 0.0), "error", "no heading")
    total = CasesResult(tallies={LEANING: structs.replace(EMPTY, asked=2, worst=[worst], faults=[fault])})
    kept = decoded(as_json(saved_result(total)), SavedResult)
    assert kept.tallies[LEANING].worst[0].axis == ((1.0).hex(), (0.0).hex(), (1.0).hex())
    assert restored_result(kept).tallies == total.tallies
