"""How a run ended, in one sentence; what fails it and what does not. The goldens show the failures of many runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from msgspec import structs

from hypcheck.record import read
from hypcheck.record.measurements import MethodLine
from hypcheck.report.model import timing_totals
from hypcheck.report.verdict import failures, verdict
from tests.report import bench_lines, record_samples
from tests.report.bench_lines import bench_record
from tests.report.record_samples import CRASHED, DISAGREEMENT, DRIFT, EXACT_WRONG, UNPROVED, group, sample


def of(*extra, exit_code=0, body=None):
    return record_samples.record([*(record_samples.lines() if body is None else body), *extra], exit_code)


EXACT_ABSTAINS = group("fast", "float64", "tangent", {"abstained": 2, "right": 3}, exact=True)
BENCHMARK_HELD = (
    "HELD: 11 methods compared on 3 workloads, 10 of them timed; each of the 2 that promise to be exact was right on"
    " every row; 1 ratio held to the baseline's, 0 of them slower than allowed; 2 of 2 targets of the kernels met;"
    " a walker's step timed in 2 forests of up to 1,000,000 trees; 1 scene timed against Table 2."
)
TRUNCATED = "TRUNCATED: the record has no end; the run was interrupted and is not a pass."


@pytest.mark.parametrize(
    ("record", "sentence"),
    [
        (of(), record_samples.HELD),
        (
            of(body=[record_samples.oracle("exact", "ring", {"proved": 20})]),
            "HELD: 20 cases asked of exact and of no other oracle.",
        ),
        (bench_record(), BENCHMARK_HELD),
    ],
)
def test_a_run_without_failures_has_the_verdict_passed(record, sentence):
    """Wrong answers of the paper's formulas, of methods that promise nothing, and claims that do not hold are none."""
    assert failures(record) == []
    assert (verdict(record).passed, verdict(record).sentence) == (True, sentence)


@pytest.mark.parametrize(
    ("line", "code", "says"),
    [
        (DISAGREEMENT, 6, "1 disagreement of oracles"),
        (UNPROVED, 6, "1 failed proof"),
        (
            EXACT_WRONG,
            1,
            (
                "fast promises to be exact, but 1 of 5 cases ended as wrong;"
                " tangent/1/1/0 is contact; answered: exterior (false-clear, wrong by 0 u)"
            ),
        ),
        (EXACT_ABSTAINS, 1, "fast promises to be exact, but 2 of 5 cases ended as abstained"),
        (CRASHED, 1, "theirs: 2 of 5 cases ended as crash"),
        (DRIFT, 1, "table-2 errs on uniform inside its stated regimes; see uniform/1/1/4"),
    ],
)
def test_each_kind_of_failure_is_enough_to_fail_a_run(line, code, says):
    record = of(line, exit_code=code)
    assert len(failures(record)) == 1
    assert (verdict(record).passed, verdict(record).sentence) == (False, f"FAILED with exit code {code}: {says}.")


@pytest.mark.parametrize(
    ("extra", "code", "sentence"),
    [
        ((), None, TRUNCATED),
        ((UNPROVED,), None, f"{TRUNCATED} What was finished has already failed: 1 failed proof."),
        ((), 130, "FAILED with exit code 130: interrupted."),
        ((UNPROVED,), 130, "FAILED with exit code 130: interrupted; 1 failed proof."),
        ((), 70, "FAILED with exit code 70: an internal error of hypcheck."),
        ((), 6, "FAILED with exit code 6: the oracles or a proof contradict each other."),
        ((), 3, "FAILED with exit code 3: slower than the baseline allows."),
        ((), 99, "FAILED with exit code 99: no line of the record says why."),
        ((UNPROVED,), 0, "CONTRADICTORY: the record ends with exit code 0, but holds 1 failed proof."),
    ],
)
def test_a_run_that_is_truncated_or_whose_exit_code_contradicts_its_lines_has_not_passed(extra, code, sentence):
    found = verdict(of(*extra, exit_code=code))
    assert (found.passed, found.sentence) == (False, sentence)


def changed(kind, **changes):
    """The lines of a benchmark with the first of a kind changed."""
    first, body = bench_lines.line(kind), bench_lines.lines()
    body[body.index(first)] |= changes
    return body


UNMEASURED = [line for line in bench_lines.lines() if line["type"] != "comparison"]


@pytest.mark.parametrize(
    ("body", "code", "sentence"),
    [
        (
            changed("comparison", verdict="slower", change=1.4),
            3,
            "FAILED with exit code 3: fast is slower than the baseline allows (uniform, batch): 1.4 (",
        ),
        (
            changed("comparison", verdict="inconclusive"),
            4,
            "INCONCLUSIVE, exit code 4: 1 comparison too noisy to tell. A quieter machine or more --processes would",
        ),
        (UNMEASURED, 4, "INCONCLUSIVE, exit code 4: 1 comparison too noisy to tell."),  # nothing was compared
        (changed("comparison", verdict="slower"), 0, "CONTRADICTORY: the record ends with exit code 0, but holds"),
    ],
)
def test_a_benchmark_that_is_slower_or_too_noisy_has_not_passed(body, code, sentence):
    found = verdict(bench_record(body, code, {"baseline": "before/record.jsonl"}))
    assert not found.passed
    assert found.sentence.startswith(sentence)


def test_verdict_on_a_benchmark_mentions_once_that_the_only_exact_method_was_right():
    golden = read(Path(__file__).parent / "goldens" / "bench-ways" / "record.jsonl")
    alone = [
        structs.replace(line, exact=line.method == "passage-certified") if isinstance(line, MethodLine) else line
        for line in golden.lines
    ]
    sentence = verdict(replace(golden, lines=alone)).sentence
    assert sentence.startswith("HELD: right on every row and 4,800 times as fast as exact arithmetic (passage-exact): ")
    assert sentence.endswith(": passage-certified; 3 methods compared on 2 workloads, 3 of them timed.")


@pytest.mark.parametrize("body", [[], [group("fast", "float64", "ring", {"skipped": 9}, exact=True)]])
def test_a_run_that_tested_nothing_has_not_passed(body):
    found = verdict(record_samples.record(body))
    assert found.sentence == "NOTHING was asked and nothing was judged: this is not a pass."
    assert not found.passed


@pytest.mark.parametrize(
    ("left_out", "ending"),
    [({}, "u."), ({"not_asked": {"filter": {"ring": 9}}}, "; not asked: 1 family left out by --families.")],
)
def test_the_verdict_on_chosen_families_names_those_that_were_left_out_if_there_are_any(left_out, ending):
    implementation = next(line for line in sample("failures") if line.get("name") == "engine")
    del implementation["not_asked"]
    body = [{**implementation, **left_out, "broke_protocol_throughout": False, "troubles": []}]
    body.append(
        group("engine", "float64", "uniform", {"right": 3}, spec="library:engine.so", failing=["wrong"], faults=[])
    )
    found = verdict(record_samples.record(body, options={"families": ["uniform"]}))
    assert found.sentence.startswith("HELD: engine: 3 judged")
    assert found.sentence.endswith(ending)


def test_an_implementation_that_always_breaks_the_protocol_is_reported_once_and_first():
    implementation = next(line for line in sample("failures") if line.get("name") == "engine")
    reason = "it answered 5; it must be one of -1, 0, 1 or 2"
    fault = next(line["faults"][0] for line in sample("failures") if line.get("faults"))
    fault |= {"status": "protocol", "reason": reason}
    counts = {"protocol": 9}
    line = group("engine", "float64", "ring", counts, spec="library:engine.so", failing=["protocol"], faults=[fault])
    body = [{**implementation, "broke_protocol_throughout": True, "troubles": []}, line]
    sentence = f"engine broke the protocol throughout; {fault['case']}: {reason}"
    assert verdict(record_samples.record(body, 5)).sentence == f"FAILED with exit code 5: {sentence}."
    body[1] = line | {"counts": {"wrong": 2, "protocol": 7}, "failing": ["wrong", "protocol"]}
    counted = f"FAILED with exit code 5: {sentence}; engine: 2 wrong, 7 protocol of 9 cases."
    assert verdict(record_samples.record(body, 5)).sentence == counted


def test_a_method_that_promises_to_be_exact_fails_a_benchmark_by_an_answer_of_which_no_case_was_kept():
    fast = bench_lines.line("accuracy", "fast")
    body = [fast | {"abstained": 3, "worst": []} if line == fast else line for line in bench_lines.lines()]
    (failure,) = failures(bench_record(body, 1))
    assert failure.message == "fast promises to be exact, but of 2,500 answers 3 not told"
    assert (failure.name, failure.case) == ("fast", None)


def test_a_run_with_undecided_answers_and_no_wrong_ones_is_inconclusive():
    line = group("theirs", "float32", "tangent", {"undecided": 2, "right": 3})
    assert verdict(of(line, exit_code=4)).sentence == (
        "INCONCLUSIVE, exit code 4: 2 answers undecided: the tolerance lies between the two ends that are proved of "
        "the backward error."
    )


def test_timing_has_no_ratio_without_a_timing_of_the_reference():
    alone = [line for line in record_samples.lines() if line.get("name") != "plain numpy formula"]
    (fast,) = timing_totals(record_samples.record(alone))
    assert (fast.median_ns, fast.ratio, fast.ratio_range) == (80, None, None)
