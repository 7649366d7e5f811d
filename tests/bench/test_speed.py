"""Samples become lines of the record: impossible samples are dropped, and too short times recorded as unmeasured."""

from __future__ import annotations

import pytest
from msgspec import UNSET, structs

from hypcheck.bench import run, speed
from hypcheck.bench.baseline import speeds_of
from hypcheck.bench.contenders import contenders
from hypcheck.bench.plan import REFERENCE, BenchPlan
from hypcheck.bench.speed import REFERENCE_AGAIN, Measurement
from hypcheck.errors import Exit, RunOutcome
from hypcheck.record import Recorder
from hypcheck.record.fields import decoded
from hypcheck.record.measurements import SpeedLine, UnmeasuredLine
from hypcheck.runs.timing import Samples
from tests.report import bench_lines
from tests.support.records import GrowingText

WHERE = ("uniform", "single")


def parts(name, samples, calls=()):
    """What two processes measured of a method, a call that does nothing already taken off."""
    key = (name, *WHERE)
    return key, [
        Measurement(key, Samples(name, 10, 5, 0, list(samples)), 0.0, "worker", tuple(calls)) for _ in range(2)
    ]


def lines(*found):
    reference = [parts(name, [100.0, 101.0, 102.0]) for name in (REFERENCE, REFERENCE_AGAIN)]
    return list(speed.speed_lines(dict([*reference, *found]), REFERENCE))


def of(found, kind, name):
    return [line for line in found if isinstance(line, kind) and line.method == name]


def test_a_negative_time_sample_is_dropped_and_counted():
    """30 ns were taken off each; one of the calls was much shorter, as no call can be that does the work."""
    found = lines(parts("theirs", [20.0, -29.0, 21.0, 22.0, 21.0, 21.0, 21.0], [30.0] * 7))
    (line,) = of(found, SpeedLine, "theirs")
    assert line.samples_ns == [[20.0, 21.0, 22.0, 21.0, 21.0, 21.0]] * 2
    assert line.dropped == 2
    assert (line.median_ns, line.ratio) == (21.0, pytest.approx(0.2, rel=0.03))
    assert of(found, SpeedLine, REFERENCE)[0].dropped is UNSET


@pytest.mark.parametrize("samples", [[-3.0, 2.0, -1.0, 4.0], [0.01, 0.0, -0.02, 0.0], [12.0, 12.0, 11.9, 12.1]])
def test_a_time_as_short_as_an_empty_call_is_not_measured_with_a_reason(samples):
    found = lines(parts("theirs", samples, [200.0, 210.0, 190.0, 205.0]))
    assert of(found, SpeedLine, "theirs") == []
    (line,) = of(found, UnmeasuredLine, "theirs")
    assert (line.workload, line.mode) == WHERE
    assert "cannot be distinguished from that of a call that does nothing, 202 ns (190 to 210)" in line.reason


def test_a_time_without_an_empty_call_to_subtract_is_always_recorded():
    assert len(of(lines(parts("theirs", [0.5, 0.6])), SpeedLine, "theirs")) == 1


def test_a_speed_that_only_the_baseline_has_makes_the_comparison_inconclusive(tmp_path):
    before = list(lines(parts("fast-numpy", [20.0, 21.0], [3.0, 3.1])))
    after = list(lines(parts("fast-numpy", [-1.0, 0.2], [3.0, 3.1])))
    plan = BenchPlan(methods=("fast-numpy",), baseline=tmp_path)
    for now, inconclusive in ((before, 0), (after, 1)):
        outcome = RunOutcome()
        recorder = Recorder(GrowingText(), plan.options)
        state = run.MethodsRun(plan, recorder, outcome, contenders(plan), speeds=now)
        state.compare(speeds_of(before), lambda steps: None)
        assert outcome.codes == ({Exit.INCONCLUSIVE} if inconclusive else set())


def test_impossible_times_in_an_old_baseline_are_not_compared():
    """It wrote 0.01 ns where an empty call was no shorter, and gated 46 millionths to 17,900."""
    line = decoded({**bench_lines.speed("theirs", "uniform", "single", 0.01, 10_000.0)}, SpeedLine)
    lost = structs.replace(line, samples_ns=[[0.01, 0.01, 7.0]])
    kept = structs.replace(line, mode="batch", samples_ns=[[5.0, 6.0]])
    known = speeds_of([lost, kept])
    assert list(known.speeds) == [("theirs", "uniform", "batch")]
