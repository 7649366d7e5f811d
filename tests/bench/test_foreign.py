"""Implementations of SPECs in bench: measured beside the built-in methods, by their own clock, and with a baseline."""

from __future__ import annotations

from dataclasses import replace

import pytest
from msgspec import structs

import hypcheck
from hypcheck.bench.baseline import alike, speeds_of
from hypcheck.bench.contenders import contenders, foreign_contenders, foreign_method
from hypcheck.bench.loaded import RunningForeign
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.implementations import implementation
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Limits, StartError
from hypcheck.implementations.spec import parse_spec
from hypcheck.record.fields import decoded
from hypcheck.record.lines import NotStartedLine
from hypcheck.record.measurements import AccuracyLine, ComparisonLine, MethodLine, RefusedLine, SpeedLine
from hypcheck.runs.timing import TimingEntry, TimingRefusedError, measure
from tests.bench.test_run import ended
from tests.report import bench_lines
from tests.tools.miniatures import QUICK, command, compiled

ROWS = WORKLOADS["uniform"].rows(1, 50)
pytestmark = pytest.mark.usefixtures("text_reports")


@pytest.fixture(autouse=True, scope="module")
def without_isolation():
    """SUBJECT answers by hypcheck's own kernel, which isolation hides from a program under test."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HYPCHECK_ISOLATE", "off")
        yield


SUBJECT = """
import numpy as np
from hypcheck import classify as exact

hypcheck = {{"name": "subject"}}


def classify(rows):
    for _ in range({times}):
        answers = exact(rows)
    return {answers}
"""


def subject(folder, times=1, answers="answers"):
    path = folder / f"subject_{times}.py"
    path.write_text(SUBJECT.format(times=times, answers=answers), encoding="utf-8")
    return f"python:{path}:classify"


def opened(spec):
    return RunningForeign(open_implementation(spec, Limits()), parse_spec(spec).kind)


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return f"library:{compiled('right', tmp_path_factory.mktemp('library') / 'right.so', '-shared', '-fPIC')}"


def test_a_python_spec_is_timed_in_its_worker(tmp_path):
    way = opened(subject(tmp_path))
    for ready in (way.batch(ROWS), way.single(ROWS[:4])):
        took, checksum = ready.run(3)
        assert took > 0
        assert checksum == ready.answers().sum(dtype=int)
        assert ready.timed_by == "worker"
    assert way.empty(ROWS, "single") is None
    way.close()


def test_a_library_is_timed_in_its_worker_which_also_times_a_call_without_rows(library):
    way = opened(library)
    assert way.batch(ROWS).timed_by == "worker"
    assert way.single(ROWS[:4]).run(50)[0] > 0
    empty = way.empty(ROWS, "single")
    took, checksum = empty.ready.run(1000)
    assert took > 0
    assert checksum == 0
    assert way.empty(ROWS, "batch") is None
    way.close()


def test_a_command_that_implements_the_time_protocol_is_timed_by_its_own_clock():
    way = opened(command("right", "binary"))
    assert way.batch(ROWS).timed_by == "time protocol"
    assert way.batch(ROWS).run(2)[0] > 0
    way.close()


def test_times_from_a_command_with_a_wrong_checksum_are_refused():
    way = opened(command("miscounts_time", "binary"))
    ready = way.batch(ROWS)
    with pytest.raises(TimingRefusedError, match="timed with the checksum"):
        ready.run(1)
    (found,) = measure([TimingEntry("it", ready.rows, ready.run)], 2)
    assert "timed with the checksum" in found.refused
    assert found.samples_ns == []
    way.close()


def test_times_from_a_command_that_reports_far_too_little_time_are_refused(monkeypatch):
    monkeypatch.setattr(implementation, "_SLACK_NS", 10**9)
    way = opened(command("boasts", "binary"))
    with pytest.raises(TimingRefusedError, match=r"says that it took 3,000 ns for what took [\d,]+ ns by our clock"):
        way.batch(ROWS).run(3)
    way.close()


def test_time_of_a_command_without_a_clock_is_reduced_by_that_of_a_one_row_question():
    way = opened(command("right"))
    ready, empty = way.batch(ROWS), way.empty(ROWS, "batch")
    assert ready.timed_by == "process"
    assert ready.run(2)[0] > 0
    assert empty.ready.rows == 1
    assert way.single(ROWS) is None
    way.close()


def test_a_built_in_method_that_is_a_spec_is_measured_in_this_process():
    method = foreign_method("builtin:nearest-point", Limits(), [])
    (found,) = foreign_contenders([method], Limits())
    assert (found.name, found.tier) == ("nearest-point", "numpy")
    assert found.load().answer(ROWS).tolist() == hypcheck.classify(ROWS).tolist()


def test_two_specs_with_the_same_name_are_distinguished(tmp_path):
    first, second = subject(tmp_path), subject(tmp_path, times=2)
    one = foreign_method(first, Limits(), [])
    other = foreign_method(second, Limits(), [one.name])
    assert (one.name, other.name) == ("subject", f"subject ({second})")
    found = contenders(BenchPlan(methods=("fast-numpy",), foreign=(one, other)))
    assert list(found)[-2:] == [one.name, other.name]
    assert found[one.name].tier == "foreign"


def test_a_slow_spec_is_judged_and_timed_on_fewer_rows_than_a_quick_one(tmp_path):
    quick = foreign_method(subject(tmp_path), Limits(), [])
    slow = foreign_method(subject(tmp_path, times=300), Limits(), [])
    assert slow.timed < quick.timed
    assert slow.judged < quick.judged


def waiting(folder, seconds):
    """A SPEC that waits before it answers, as `seconds` says of the number of the question and that of its rows."""
    path = folder / "waiting.py"
    text = f"""
import time
import numpy as np

asked = []


def classify(rows):
    asked.append(len(rows))
    with open({str(folder / "asked")!r}, "a") as file:
        print(len(rows), file=file)
    time.sleep({seconds})
    return np.ones(len(rows), dtype=np.int8)
"""
    path.write_text(text, encoding="utf-8")
    return f"python:{path}:classify"


def test_an_interruption_of_the_speed_trial_does_not_make_a_spec_look_slow(tmp_path):
    """Each second batch is interrupted for 50 ms."""
    spec = waiting(tmp_path, "0.05 * (len(asked) % 2)")
    assert foreign_method(spec, Limits(), []).timed > 10_000


def test_the_speed_trial_sends_a_batch_to_a_slow_spec_twice_at_most(tmp_path):
    """Once to warm up, and once to take the time."""
    found = foreign_method(waiting(tmp_path, "0.01 * len(rows)"), Limits(), [])
    assert found.timed == 1
    assert (tmp_path / "asked").read_text().split() == ["1", "64", "64"]


def test_spec_with_a_baseline_is_timed_on_as_many_rows_as_in_the_baseline(tmp_path):
    other = foreign_method(subject(tmp_path), Limits(), [])
    line = decoded(bench_lines.speed("one", "uniform", "batch", 20.0, 10.0), SpeedLine)
    asked = {("uniform", "batch"): 53, ("flight", "batch"): 50, ("uniform", "single"): 256}
    before = speeds_of(
        structs.replace(line, workload=workload, mode=mode, rows=rows) for (workload, mode), rows in asked.items()
    )
    assert [each.timed for each in alike(before, [replace(other, name="one"), other])] == [53, other.timed]


def test_a_spec_that_never_answers_is_refused_after_one_timeout(tmp_path):
    path = tmp_path / "never.py"
    path.write_text("def classify(rows):\n    while True:\n        pass\n", encoding="utf-8")
    with pytest.raises(StartError, match=r"does not answer its first question, about one row: no answer within 0\.7 s"):
        foreign_method(f"python:{path}:classify", QUICK, [])


SMALL = ["--workloads", "uniform", "--methods", "fast-numpy"]
ONE_PROCESS = [*SMALL, "--processes", "1"]
"""Where speeds are not compared."""


@pytest.fixture(scope="module")
def before(tmp_path_factory):
    folder = tmp_path_factory.mktemp("before")
    code, record = ended(folder / "out", *SMALL, subject(folder))
    return code, record, folder / "out" / "record.jsonl"


def test_a_spec_is_judged_and_timed_like_the_built_in_methods(before):
    code, record, _ = before
    assert code == 0
    (judged,) = [line for line in record.of(AccuracyLine) if line.method == "subject"]
    assert judged.wrong == 0
    timed = [line for line in record.of(SpeedLine) if line.method == "subject"]
    assert {line.mode for line in timed} == {"batch", "single"}
    assert {line.timed_by for line in timed} == {"worker"}
    assert [line.kind for line in record.of(MethodLine)][-1] == "foreign"


def test_bench_ends_with_3_if_a_spec_is_slower_than_its_baseline(before, tmp_path):
    *_, baseline = before
    slower = subject(tmp_path, times=60)
    code, record = ended(tmp_path / "out", *SMALL, "--baseline", str(baseline), "--max-slowdown", "1.5", slower)
    compared = {(line.method, line.mode): line for line in record.of(ComparisonLine) if line.gates}
    assert compared["subject", "batch"].verdict == "slower"
    assert compared["subject", "batch"].change > 5
    assert code == 3
    assert {line.method for line in record.of(ComparisonLine)} == {"subject", "fast-numpy"}


def test_unchanged_spec_is_not_slower_than_its_baseline(before, tmp_path):
    *_, baseline = before
    code, record = ended(
        tmp_path / "out", *SMALL, "--baseline", str(baseline), "--max-slowdown", "1.5", subject(tmp_path)
    )
    assert "slower" not in {line.verdict for line in record.of(ComparisonLine) if line.change < 1.5}
    assert code in (0, 4) or max(line.change for line in record.of(ComparisonLine) if line.gates) > 1.5


def test_bench_ends_with_5_and_measures_the_rest_if_a_spec_cannot_be_started(tmp_path):
    code, record = ended(tmp_path / "out", *ONE_PROCESS, f"python:{tmp_path / 'nowhere.py'}:classify")
    assert code == 5
    assert record.of(NotStartedLine)
    assert record.of(SpeedLine)


def test_bench_records_a_spec_that_fails_on_rows_and_ends_with_1(tmp_path):
    code, record = ended(
        tmp_path / "out", *ONE_PROCESS, subject(tmp_path, answers="answers if len(rows) < 9 else 1 / 0")
    )
    assert code == 1
    refused = record.of(RefusedLine)
    assert refused
    assert all("ZeroDivisionError" in line.reason for line in refused)
    assert all("; the row is 2.0, 17.8, 0.25, 0.15, " in line.reason for line in refused)
    assert "subject" not in {line.method for line in record.of(SpeedLine)}


def test_bench_refuses_a_spec_whose_answers_change_between_judging_and_timing(tmp_path):
    folder = tmp_path / "marks"
    folder.mkdir()
    spec = subject(tmp_path, answers=f"np.roll(answers, len(os.listdir({str(folder)!r})))")
    path = tmp_path / "subject_1.py"
    begun = f"import os\nopen(os.path.join({str(folder)!r}, str(os.getpid())), 'w').close()\n"
    path.write_text(begun + path.read_text(encoding="utf-8"), encoding="utf-8")
    code, record = ended(tmp_path / "out", *ONE_PROCESS, spec)
    assert code == 1
    reasons = {line.reason for line in record.of(RefusedLine) if line.method == "subject"}
    assert reasons == {"its answers, when it was about to be timed, were not those that were judged"}
