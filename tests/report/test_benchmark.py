"""Reports of a benchmark: what fails it, what does not, and how it ended."""

from __future__ import annotations

import json
from xml.etree import ElementTree

import pytest

from hypcheck.report import junit, markdown, summary, terminal
from hypcheck.report.verdict import failures, verdict
from tests.report import bench_lines
from tests.report.bench_lines import bench_record
from tests.report.test_schemas import SUMMARY
from tests.support.records import violations


def lines(kind, **changes):
    """The sample's lines with the first of a kind changed."""
    body = json.loads(json.dumps(bench_lines.lines()))
    line = next(line for line in body if line["type"] == kind and line.get("method", "fast") == "fast")
    line.update(changes)
    return body


REFUSED = {
    "type": "refused",
    "method": "numpy-roots",
    "workload": "flight",
    "mode": "batch",
    "reason": "its checksum was 3 and then 4",
}


def test_benchmark_without_failures_has_passed():
    said = verdict(bench_record())
    assert said.passed
    assert said.sentence == (
        "HELD: 11 methods compared on 3 workloads, 10 of them timed; right on every row: fast (7,520) and rational"
        " (7,520); 1 ratio held to the baseline's, 0 of them slower than allowed; 2 of 2 targets of the kernels met; a"
        " walker's step timed in 2 forests of up to 1,000,000 trees; 1 scene timed against Table 2."
    )


def test_an_exact_method_that_erred_fails_the_benchmark():
    worst = [{**bench_lines.accuracy("x", "uniform", 1)["worst"][0], "truth": -1, "answer": 1}]
    (failure,) = failures(bench_record(lines("accuracy", wrong=2, abstained=1, worst=worst), 1))
    assert (failure.subject, failure.name, failure.group, failure.kind) == ("measurement", "fast", "uniform", "wrong")
    assert failure.message == (
        "fast promises to be exact, but of 2,500 answers 2 wrong and 1 not told; uniform/1/1/7 is interior;"
        " answered: exterior"
    )
    assert failure.replay.startswith("hypcheck classify --alpha 1.0")


def test_errors_of_methods_that_promise_nothing_do_not_fail_the_benchmark():
    assert failures(bench_record()) == []


@pytest.mark.parametrize(
    ("body", "code", "sentence"),
    [
        (lines("comparison", verdict="slower", change=1.4), 3, "FAILED with exit code 3: 1 failed measurement."),
        (
            lines("comparison", verdict="inconclusive"),
            4,
            (
                "INCONCLUSIVE, exit code 4: 1 comparison too noisy to tell. "
                "A quieter machine or more --processes would tell."
            ),
        ),
        ([*bench_lines.lines(), REFUSED], 1, "FAILED with exit code 1: 1 failed measurement."),
        (lines("comparison", verdict="slower"), 0, "CONTRADICTORY: the record ends with exit code 0, but holds"),
        ([], 0, "NOTHING was asked"),
    ],
)
def test_a_benchmark_that_is_slower_or_too_noisy_has_not_passed(body, code, sentence):
    said = verdict(bench_record(body, code))
    assert not said.passed
    assert said.sentence.startswith(sentence)


@pytest.mark.parametrize(
    ("kind", "changes", "failing"),
    [
        ("kernel", {"met": False, "measured": 0.5, "ci95": [0.4, 0.6]}, "slower"),
        ("kernel", {"met": False, "measured": 0.75, "ci95": [0.6, 0.85]}, "inconclusive"),  # 0.8 was wanted
        ("kernel", {"met": False, "ci95": None, "measured": 0.5}, "slower"),
    ],
)
def test_a_missed_target_fails_the_run_or_is_inconclusive_within_the_noise(kind, changes, failing):
    body = [line for line in lines(kind, **changes) if line["type"] != "comparison"]
    (failure,) = failures(bench_record(body, 4))
    assert failure.kind == failing
    assert "certified, batch misses its target" in failure.message
    root = ElementTree.fromstring(junit.render(bench_record(body, 4)))  # noqa: S314 - just written
    assert [each.get("name") for each in root.iter("testcase") if each.find("failure") is not None] == [
        "certified, batch: queries a second against the plain formula"
    ]


@pytest.mark.parametrize("found", ["does not hold", "inconclusive"])
def test_claim_about_cost_that_does_not_hold_does_not_fail_the_benchmark(found):
    body = [line for line in lines("cost", verdict=found) if line["type"] != "comparison"]
    assert failures(bench_record(body)) == []
    assert verdict(bench_record(body)).passed


def test_comparison_that_does_not_gate_is_no_failure_and_is_not_counted():
    record = bench_record(lines("comparison", verdict="slower", gates=False))
    assert failures(record) == []
    assert "held to the baseline's" not in verdict(record).sentence
    assert "| (slower) |" in markdown.render(record).decode()


def test_every_report_names_the_failures_of_a_benchmark():
    record = bench_record([*lines("comparison", verdict="slower", change=1.4), REFUSED], 1)
    text = markdown.render(record).decode()
    assert "**measurement, flight, batch**: numpy-roots is not timed: its checksum was 3 and then 4." in text
    assert "fast is slower than the baseline allows (uniform, batch): 1.4 (0.96 to 1) times its former ratio" in text
    assert text.index("## What failed") < text.index("## Against the baseline") < text.index("## Which method")
    assert "✗ numpy-roots is not timed" in terminal.render(record).decode()
    found = json.loads(summary.render(record))
    assert [(each["subject"], each["kind"]) for each in found["failures"]] == [
        ("measurement", "refused"),
        ("measurement", "slower"),
    ]
    assert violations(found, SUMMARY, closed=True) == []


def test_reports_name_missing_methods_and_how_to_install_them():
    text = terminal.render(bench_record(bench_lines.lines())).decode()
    assert "left out: coal cannot be imported; pip install 'hypcheck[peers]' brings it\n" in text


def test_every_report_names_what_could_not_be_measured_which_does_not_fail_the_run():
    hidden = {
        "type": "unmeasured",
        "method": "fast",
        "workload": "flight",
        "mode": "single",
        "reason": "it is too short",
    }
    body = [{**line, "dropped": 3} if line["type"] == "speed" else line for line in bench_lines.lines()]
    record = bench_record([*body, hidden])
    assert failures(record) == []
    text = terminal.render(record).decode()
    assert "not measured: fast on flight, single: it is too short\n" in text
    assert "samples dropped, no longer than the empty call that is taken off: " in text
    page = markdown.render(record).decode()
    assert "`fast` on flight, single: it is too short" in page
    assert "3 impossible samples dropped" in page
    root = ElementTree.fromstring(junit.render(record))  # noqa: S314 - just written
    (case,) = [each for each in root.iter("testcase") if each.get("name") == "fast on flight, single"]
    assert case.find("skipped").get("message") == "it is too short"


def test_a_run_in_which_nothing_is_compared_with_its_baseline_has_not_passed():
    body = [line for line in bench_lines.lines() if line["type"] != "comparison"]
    record = bench_record(body, 4, {"baseline": "before/record.jsonl"})
    (failure,) = failures(record)
    assert failure.kind == "inconclusive"
    assert verdict(record).sentence.startswith("INCONCLUSIVE, exit code 4: ")


def test_junit_has_suites_for_a_benchmark():
    record = bench_record([*lines("comparison", verdict="slower"), REFUSED], 1)
    root = ElementTree.fromstring(junit.render(record))  # noqa: S314 - just written
    counts = {suite.get("name"): (int(suite.get("tests")), int(suite.get("failures"))) for suite in root}
    assert counts["bench.answers"] == (33, 0)
    assert counts["bench.times"] == (42, 1)
    assert counts["bench.baseline"] == (2, 1)
    assert counts["bench.kernels"] == (2, 0)
    skipped = [case.get("name") for case in root.iter("testcase") if case.find("skipped") is not None]
    assert skipped == ["foreign-adapter on uniform, batch"]


def test_the_summary_of_a_benchmark_has_every_method_and_fits_its_schema():
    found = json.loads(summary.render(bench_record()))
    assert violations(found, SUMMARY, closed=True) == []
    dual = next(each for each in found["methods"] if each["name"] == "dual-numpy-float32")
    assert (dual["tier"], dual["asked"], dual["wrong"], dual["reliable_above"]) == ("numpy", 7520, 1960, 2.0**-24)
    assert dual["workloads"]["uniform"]["false_clear"] == 130
    assert [(each["workload"], each["mode"]) for each in dual["times"]] == [
        ("uniform", "batch"),
        ("flight", "batch"),
        ("near-contact", "batch"),
        ("uniform", "single"),
    ]


def test_the_page_of_a_benchmark_shows_every_type_of_line():
    text = markdown.render(bench_record()).decode()
    for words in (
        "what dual-numpy-float32 is",
        "A drone's way around the tower",
        "`table-2-numpy-float16` | the uniform rows | 2,500 | 1,250 | **250** | 1,000 | 0 | 0 | ∞ | `uniform/1/1/7` |",
        "| `fast` | the uniform rows | batch | 0.111 (0.107 to 0.116) | 2 (1.94 to 2.1) | 5.0e8 | ± 2 % | 10,000 |",
        "| `fcl-sphere` | 1,000 | 0.0045 | 500 | 0 | 949,000 | 2.0e6 |",
        "| sphere | uniform | 0.5 | 200 | 90 | 45 % | 0.2 |",
        "**Procedure 2.b costs less than 2.a (§ 4)**",
        "| the tower | **holds** |",
        r"10 +, 12 \*",
        "| rows, batch | queries a second against the plain formula | 0.8 | 0.8 (0.78 to 0.82) | yes |",
        "| `foreign-adapter` | uniform | batch | 1 | 1.02 | 1.02 (1 to 1.04) | 1.1 | (inconclusive) |",
        "Not there: coal: coal cannot be imported",
        "cc 12.2.0",
    ):
        assert words in text, words
