"""The verdict follows from the lines of a record, and names every failure."""

from __future__ import annotations

import pytest

from hypcheck.report.model import implementations, oracle_totals, timing_totals
from hypcheck.report.verdict import failures, verdict
from tests.report import record_samples


def of(*extra, exit_code=0, body=None):
    return record_samples.record([*(record_samples.lines() if body is None else body), *extra], exit_code)


DISAGREEMENT = record_samples.oracle(
    "nearest", "tangent", {"exact": 5}, cases=[record_samples.disagreement("nearest", "tangent/1/1/3")]
)
UNPROVED = {"type": "proof", "formula": "hessian", "quantity": "delta_3", "holds": False, "statement": "it is 3Δ"}
EXACT_WRONG = record_samples.group(
    "fast",
    "float64",
    "tangent",
    {"right": 4, "wrong": 1},
    [record_samples.worst("tangent/1/1/0", "wrong", 0.0, answer=1, truth=0, mistake="false-clear")],
    exact=True,
)
EXACT_ABSTAINS = record_samples.group("fast", "float64", "tangent", {"abstained": 2, "right": 3}, exact=True)
CRASHED = record_samples.group("theirs", "float32", "tangent", {"crash": 2, "right": 3})
DRIFT = {"type": "drift", "sentence": "table-2 errs on uniform inside its stated regimes; see uniform/1/1/4"}
TRUNCATED = "TRUNCATED: the record has no end; the run was interrupted and is no pass."


def test_run_without_failures_has_passed():
    found = verdict(of())
    assert found.passed
    assert found.sentence == record_samples.HELD
    assert failures(of()) == []


def test_verdict_of_a_run_with_a_single_oracle_claims_no_agreement():
    body = [record_samples.oracle("exact", "ring", {"proved": 20})]
    assert verdict(of(body=body)).sentence == "HELD: 20 cases asked of exact and of no other oracle."


def test_wrong_answers_of_the_papers_formulas_do_not_fail_the_run():
    body = [
        line
        for line in record_samples.lines()
        if line["type"] in ("finding", "equation") or not line.get("exact", True)
    ]
    assert {line["type"] for line in body} == {"finding", "equation", "group"}
    assert any("wrong" in line.get("counts", {}) for line in body)
    assert verdict(of(body=body)).passed


@pytest.mark.parametrize(
    ("line", "code", "says", "case"),
    [
        (DISAGREEMENT, 6, "1 disagreement of oracles", "tangent/1/1/3"),
        (UNPROVED, 6, "1 failed proof", None),
        (EXACT_WRONG, 1, "1 implementation failure", "tangent/1/1/0"),
        (EXACT_ABSTAINS, 1, "1 implementation failure", None),
        (CRASHED, 1, "1 implementation failure", None),
        (DRIFT, 1, "1 drift from what is known", None),
    ],
)
def test_verdict_names_each_failure_with_its_case_and_replay_command(line, code, says, case):
    record = of(line, exit_code=code)
    assert verdict(record).sentence == f"FAILED with exit code {code}: {says}."
    assert not verdict(record).passed
    (failure,) = failures(record)
    assert failure.case == case
    assert (failure.replay is None) == (case is None)


def test_the_replay_of_a_failure_is_the_command_that_decides_its_row():
    (failure,) = failures(of(EXACT_WRONG))
    assert "tangent/1/1/0 is contact; answered: exterior (false-clear, wrong by " in failure.message
    assert failure.replay == "hypcheck classify --alpha 1.0 --gamma 2.0 --b 1.0 --d 1.0 --center 2.5 -0.0 0.0"


def test_verdict_counts_several_failures_from_worst_to_least():
    record = of(DRIFT, EXACT_WRONG, UNPROVED, DISAGREEMENT, DISAGREEMENT, exit_code=6)
    assert verdict(record).sentence == (
        "FAILED with exit code 6: 2 disagreements of oracles, 1 failed proof, 1 implementation failure and"
        " 1 drift from what is known."
    )


def test_verdict_counts_disagreements_that_the_record_did_not_keep():
    line = record_samples.oracle(
        "roots", "tangent", {"signs suffice": 50}, cases=[record_samples.disagreement("roots")] * 20, disagreeing=33
    )
    assert "33 disagreements of oracles" in verdict(of(line, exit_code=6)).sentence
    assert sum(failure.count for failure in failures(of(line))) == 33


@pytest.mark.parametrize(
    ("extra", "code", "sentence"),
    [
        ((), None, TRUNCATED),
        (
            (UNPROVED,),
            None,
            f"{TRUNCATED} What was finished has already failed: 1 failed proof.",
        ),
        ((), 130, "FAILED with exit code 130: interrupted."),
        ((UNPROVED,), 130, "FAILED with exit code 130: interrupted; 1 failed proof."),
        ((), 70, "FAILED with exit code 70: an internal error of hypcheck."),
        ((), 6, "FAILED with exit code 6: the oracles or a proof contradict each other."),
        ((), 3, "FAILED with exit code 3: slower than the baseline allows."),
        ((), 99, "FAILED with exit code 99: no line of the record says why."),
        ((UNPROVED,), 0, "CONTRADICTORY: the record ends with exit code 0, but holds 1 failed proof."),
    ],
)
def test_run_that_is_truncated_or_ended_with_another_code_has_not_passed(extra, code, sentence):
    assert verdict(of(*extra, exit_code=code)).sentence == sentence
    assert not verdict(of(*extra, exit_code=code)).passed


def test_a_run_that_asked_nothing_has_not_passed():
    assert verdict(record_samples.record([])).sentence == "NOTHING was asked and nothing was judged: this is no pass."
    assert not verdict(record_samples.record([])).passed
    skipped = [record_samples.group("fast", "float64", "ring", {"skipped": 9}, exact=True)]
    assert not verdict(record_samples.record(skipped)).passed


def test_totals_of_an_oracle_are_sums_over_its_families():
    refused = record_samples.disagreement("exact", opinion="certificate refused")
    body = [
        record_samples.oracle("exact", "ring", {"proved": 7, "certificate refused": 1}, undecided=1, cases=[refused]),
        record_samples.oracle("exact", "tangent", {"proved": 4}),
        record_samples.oracle("mesh", "ring", {"clear": 3, "undecided": 2}, undecided=2),
    ]
    exact, mesh = oracle_totals(record_samples.record(body))
    assert (exact.asked, exact.agreed, exact.undecided, exact.disagreements) == (12, 11, 0, 1)
    assert (mesh.asked, mesh.agreed, mesh.undecided, mesh.disagreements) == (5, 3, 2, 0)
    assert exact.stages == {"certificate refused": 1, "proved": 11}


def test_totals_of_an_implementation_are_sums_over_its_families():
    fast, low, high = implementations(record_samples.record())
    assert (fast.name, fast.exact, fast.asked, fast.worst) == ("fast", True, 40, None)
    assert (low.spec, low.asked) == ("builtin:table-2-float32", 39)
    assert list(low.statuses.items()) == [("right", 28), ("tolerated", 5), ("wrong", 6), ("skipped", 1)]
    assert low.mistakes == {"false-clear": 1, "false-contact": 10}
    assert low.worst is not None
    assert low.worst.case == "ring/1/1/7"  # inf is more than any number
    assert (high.asked, high.statuses) == (20, {"right": 20, "skipped": 20})


def test_ratio_of_two_timings_is_the_median_of_the_ratios_of_each_round():
    fast, plain = timing_totals(record_samples.record())
    assert plain.ratio == 1
    assert fast.ratio == 0.5  # the median of 0.5, 0.9 and 0.4
    assert (fast.least_ns, fast.median_ns, fast.greatest_ns) == (50, 80, 90)
    alone = [line for line in record_samples.lines() if line.get("name") != "plain numpy formula"]
    assert timing_totals(record_samples.record(alone))[0].ratio is None


def test_implementation_that_always_breaks_the_protocol_is_one_failure_of_kind_protocol():
    line = implementation(broke_protocol_throughout=True)
    found = failures(of(line, body=[]))
    assert [(each.kind, each.name, each.message) for each in found] == [
        ("protocol", "theirs", "theirs broke the protocol throughout")
    ]
    assert failures(of(implementation(), body=[])) == []


def implementation(**changes):
    domain = {"regimes": [], "ratio": None, "magnitude": None}
    described = {"question": "position", "precision": "float64", "domain": domain, "refuses": False}
    described |= {"name": "theirs", "version": "1", "language": "c", "binary": True, "time": False}
    return {
        "type": "implementation",
        "spec": "library:theirs.so",
        "name": "theirs",
        "started": True,
        "declared": described,
        "used": described,
        "restarts": 0,
        "broke_protocol_throughout": False,
        "again": {"asked": 0, "within": 0, "beyond": 0},
        "troubles": [],
        **changes,
    }


def test_answers_that_stay_undecided_make_a_run_inconclusive():
    line = record_samples.group("theirs", "float32", "tangent", {"undecided": 2, "right": 3})
    assert verdict(of(line, exit_code=4)).sentence == (
        "INCONCLUSIVE, exit code 4: 2 answers undecided: the tolerance lies between the two ends that are proved of "
        "the backward error."
    )
