"""Verdicts against a baseline compare ratios, never times: slower, faster, same, or inconclusive."""

from __future__ import annotations

import numpy as np
import pytest
from click.testing import CliRunner
from msgspec import structs

from hypcheck.bench.baseline import SpeedChange, change_of, comparisons, gated, read_baseline, require_common, speeds_of
from hypcheck.bench.contenders import contenders
from hypcheck.bench.plan import REFERENCE, BenchPlan
from hypcheck.cli.bench import bench
from hypcheck.errors import InputError
from hypcheck.record import Recorder
from hypcheck.record.fields import decoded
from hypcheck.record.lines import DriftLine
from hypcheck.record.measurements import NoiseLine, SpeedLine
from tests.report import bench_lines
from tests.support.records import GrowingText

KEY = ("mine", "uniform", "batch")


def run(slowness=1.0, machine=1.0, spread=0.01, floor=0.01, seed=0):
    """A run on a machine that takes `machine` times as long for everything, with samples that spread."""
    generator = np.random.default_rng(seed)

    def samples(time):
        return (time * machine * np.exp(generator.normal(0, spread, (5, 5)))).tolist()

    def speed(method, time):
        return structs.replace(speed_of(method, time / 10.0), samples_ns=samples(time))

    noise = NoiseLine(workload="uniform", mode="batch", ratio=1.0, ratio_ci95=(1.0, 1.0), floor=floor)
    return speeds_of([noise, speed(REFERENCE, 10.0), speed("mine", 4.0 * slowness), DriftLine(sentence="odd")])


def speed_of(method, ratio):
    return decoded(bench_lines.speed(method, "uniform", "batch", 10.0 * ratio, 10.0), SpeedLine)


def verdict(before, after, allowed=1.1):
    return change_of(before, after, KEY, REFERENCE).verdict(allowed)


@pytest.mark.parametrize(
    ("before", "after", "allowed", "expected"),
    [
        *(({}, {"slowness": factor}, 1.1, "same") for factor in (1.0, 1.05)),
        *(({}, {"slowness": factor}, 1.1, "slower") for factor in (1.5, 6.0)),
        ({}, {"slowness": 0.5}, 1.1, "faster"),
        ({}, {"machine": 7.0}, 1.1, "same"),
        ({}, {"slowness": 1.1}, 1.1, "inconclusive"),
        ({"floor": 0.6}, {"slowness": 1.5}, 1.1, "inconclusive"),
        ({}, {"slowness": 1.5, "floor": 0.6}, 1.1, "inconclusive"),
        ({}, {"slowness": 1.5}, 2.0, "same"),
    ],
)
def test_verdict_on_two_runs_reports_a_slower_method_but_not_a_slower_machine_or_noise(
    before, after, allowed, expected
):
    assert verdict(run(**before, seed=1), run(**after, seed=2), allowed) == expected


def test_verdict_on_two_runs_of_the_same_method_is_never_slower():
    """Twice the same method, at every noise that there is: equal, or too noisy to tell, but never slower."""
    for spread in (0.001, 0.01, 0.05, 0.2, 0.8):
        for seed in range(8):
            before, after = (
                run(spread=spread, floor=spread, seed=seed),
                run(spread=spread, floor=spread, seed=seed + 99),
            )
            assert verdict(before, after) in ("same", "inconclusive")


@pytest.mark.parametrize(
    ("low", "high", "noise", "expected"),
    [
        (1.2, 1.3, 1.0, "slower"),
        (1.2, 1.3, 1.15, "inconclusive"),
        (1.0, 1.05, 1.0, "same"),
        (1.0, 1.05, 1.1, "inconclusive"),
        (0.5, 0.9, 1.0, "faster"),
        (0.5, 0.95, 1.1, "same"),
    ],
)
def test_speed_change_widens_its_interval_by_the_noise_before_its_verdict(low, high, noise, expected):
    assert SpeedChange(1.0, low, high, noise).verdict(1.1) == expected


def test_comparisons_cover_the_methods_that_both_runs_timed_except_the_reference():
    before, after = run(seed=1), run(2.0, seed=2)
    after.speeds["new", "uniform", "batch"] = structs.replace(after.speeds[KEY], method="new")
    (line,) = comparisons(BenchPlan(), before, after, {"mine"})
    assert (line.method, line.verdict, line.gates, line.allowed) == ("mine", "slower", True, 1.1)
    assert line.change == pytest.approx(2.0)
    assert line.ci95[0] <= line.change <= line.ci95[1]


def test_bench_gates_the_chosen_methods_and_without_a_choice_the_certified_ones():
    everything = contenders(BenchPlan())
    assert gated(BenchPlan(), everything) == {name for name, each in everything.items() if each.kind == "certified"}
    some = BenchPlan(methods=("hessian-float64",))
    assert gated(some, contenders(some)) == {"hessian-float64"}


def test_baseline_without_the_gated_methods_is_refused():
    with pytest.raises(
        InputError, match="--baseline contains no times of the methods that this run compares: other; it has mine"
    ):
        require_common(run(), {"other"})
    require_common(run(), {"other", "mine"})


def recorded(path, lines=(), **options):
    stream = GrowingText()
    recorder = Recorder(stream, {"command": "bench", "reference": REFERENCE, "quick": True, **options})
    for line in lines:
        recorder.add(line)
    recorder.close(0)
    path.write_text(stream.text, encoding="utf-8")
    return BenchPlan(quick=True, baseline=path)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"command": "verify"}, "is a record of another command"),
        ({"reference": "another"}, "its ratios are relative to 'another'"),
        ({"quick": False}, "is of a full run; compare it with another full run"),
        ({}, "has no speed relative to"),
    ],
)
def test_baseline_of_another_kind_of_run_is_refused(tmp_path, options, message):
    plan = recorded(tmp_path / "record.jsonl", **options)
    with pytest.raises(InputError, match=message):
        read_baseline(plan)


def test_baseline_may_be_given_as_the_folder_of_a_run(tmp_path):
    recorded(tmp_path / "record.jsonl", [speed_of("mine", 2.0)])
    found = read_baseline(BenchPlan(quick=True, baseline=tmp_path))
    assert list(found.speeds) == [("mine", "uniform", "batch")]


def test_bench_refuses_an_out_folder_that_would_overwrite_its_baseline(tmp_path):
    path = tmp_path / "record.jsonl"
    recorded(path)
    before = path.read_bytes()
    for named in (path, tmp_path):
        words = ["--quick", "--baseline", str(named), "--out", str(tmp_path)]
        with pytest.raises(InputError, match=r"--out .* would replace --baseline"):
            CliRunner().invoke(bench, words, standalone_mode=False, catch_exceptions=False)
    assert path.read_bytes() == before


def test_a_missing_baseline_record_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"none\.jsonl"):
        read_baseline(BenchPlan(baseline=tmp_path / "none.jsonl"))
    assert read_baseline(BenchPlan()) is None
