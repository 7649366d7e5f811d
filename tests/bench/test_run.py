"""A run of bench with few methods: its record and its exit code."""

from __future__ import annotations

import json
from dataclasses import replace
from importlib import resources

import pytest
from click.testing import CliRunner

from hypcheck.bench import plan, run
from hypcheck.bench.plan import REFERENCE
from hypcheck.cli.bench import bench
from hypcheck.errors import Exit, InputError, RunOutcome
from hypcheck.implementations.meshes import FCL
from hypcheck.record import SCHEMA, read
from hypcheck.record.fields import as_json
from hypcheck.record.measurements import AccuracyLine, MethodLine, NoiseLine, SpeedLine, WorkloadLine
from tests.bench.test_contenders import contender
from tests.support.records import violations
from tests.support.without_drawing import draw_nothing

SMALL = ["--quick", "--processes", "2", "--rounds", "2", "--workers", "1"]
FEW = replace(plan.QUICK, judged=300, cell=2, map_lines=9, timed=8192)
METHODS = ["--methods", "fast-numpy,table-2-float16,bounding-cylinder"]
RECORD = json.loads(
    resources.files("hypcheck.report").joinpath("schemas", f"record-{SCHEMA}.json").read_text(encoding="utf-8")
)


def ended(folder, *options, amounts=FEW):
    """The exit code and the record of a run on few rows, whose reports are in text alone."""
    with pytest.MonkeyPatch.context() as patch:
        draw_nothing(patch)
        patch.setattr(plan, "QUICK", amounts)
        result = CliRunner().invoke(bench, ["--out", str(folder), *SMALL, *options], standalone_mode=False)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    record = read(folder / "record.jsonl")
    return record.footer.exit_code, record


def test_a_quick_bench_judges_and_times_every_chosen_method_and_its_lines_fit_the_schema(tmp_path):
    """In one test, since the run takes longest."""
    code, record = ended(tmp_path, *METHODS, "--workloads", "uniform,ring")
    assert code == 0
    for line in record.lines:
        assert violations(as_json(line), RECORD, closed=True) == []
    assert violations(as_json(record.header), RECORD, closed=True) == []
    assert record.header.options["command"] == "bench"
    assert record.header.options["reference"] == REFERENCE  # which is added to the chosen methods
    methods = [line.method for line in record.of(MethodLine)]
    assert methods == [REFERENCE, "table-2-float16", "fast-numpy", "bounding-cylinder"]
    assert [line.workload for line in record.of(WorkloadLine)] == ["uniform", "ring"]

    judged = {(line.method, line.workload): line for line in record.of(AccuracyLine)}
    assert len(judged) == 8
    assert judged["fast-numpy", "ring"].wrong == 0
    assert judged[REFERENCE, "ring"].wrong > 0
    assert judged["table-2-float16", "uniform"].reliable_above > judged[REFERENCE, "uniform"].reliable_above

    timed = {(line.method, line.workload, line.mode): line for line in record.of(SpeedLine)}
    assert {key[1] for key in timed} == {"uniform"}
    assert {key[0] for key in timed} == {REFERENCE, "fast-numpy", "bounding-cylinder"}
    assert {key[2] for key in timed} == {"batch", "single"}
    for line in timed.values():  # in every process and round
        assert [len(part) for part in line.samples_ns] == [2, 2]
        low, high = line.ratio_ci95
        assert low <= line.ratio <= high
    alone, in_a_batch = (timed[REFERENCE, "uniform", mode] for mode in ("single", "batch"))
    assert in_a_batch.ratio == 1.0
    assert alone.median_ns > 5 * in_a_batch.median_ns  # a row in a numpy call of its own costs more

    kinds = [line.type for line in record.lines if line.type in ("noise", "speed")]
    assert kinds[:2] == ["noise", "noise"]
    for line in record.of(NoiseLine):
        low, high = line.ratio_ci95
        assert line.floor == pytest.approx(max(high, 1 / low) - 1)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--methods", "tabel-2-float32"], "there is no method 'tabel-2-float32'; did you mean table-2-float32"),
        (["--workloads", "everywhere"], "there is no workload 'everywhere'"),
        (
            ["--max-slowdown", "1.1"],
            "--max-slowdown compares a run with an earlier one; name the earlier one with --baseline",
        ),
        (["--kernel", "--methods", "fast-c"], "--kernel measures only the fast path"),
    ],
)
def test_bench_refuses_an_unknown_method_or_workload_and_writes_nothing(tmp_path, options, message):
    with pytest.raises(InputError, match=message):
        ended(tmp_path, *options)
    assert not list(tmp_path.glob("record*"))


@pytest.mark.parametrize(
    ("amounts", "needs", "titles"),
    [(plan.FULL, FCL.title, ["meshes", "memory"]), (plan.FULL, "", ["memory"]), (plan.QUICK, "", [])],
)
def test_meshes_are_refined_if_a_method_has_one_and_memory_is_measured_unless_the_run_is_quick(amounts, needs, titles):
    chosen = run.MethodsRun(plan.BenchPlan(amounts=amounts), None, RunOutcome(), {"mine": contender(needs=needs)})
    assert [stage.title for stage in chosen.mesh_and_memory_stages] == titles


def test_bench_ends_with_the_exit_code_of_highest_precedence():
    outcome = RunOutcome()
    for code in (4, 3, 1, 5, 6):
        outcome.codes.add(Exit(code))
        assert outcome.exit_code == code
    assert RunOutcome().exit_code == 0
