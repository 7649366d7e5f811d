"""The result of a run does not depend on the executor, on the order of its tasks, or on interruptions."""

from __future__ import annotations

import json
import random
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import replace
from itertools import accumulate

import numpy as np
import pytest
from msgspec import structs

from hypcheck.implementations.session import Allowance, Limits, Outcome, StartError
from hypcheck.isolation.launch import Isolation
from hypcheck.record.fields import as_json, decoded
from hypcheck.record.lines import Retest
from hypcheck.record.progress import SavedResult, SavedState
from hypcheck.runs import cases, results, tally
from hypcheck.runs.executors import execution_here, execution_in_pool
from hypcheck.runs.known_failures import KnownFailure
from hypcheck.runs.results import CasesResult, merged_result
from hypcheck.runs.resume import restored_result, restored_state, saved_result, saved_state
from hypcheck.runs.retest import RetestStep
from hypcheck.runs.schedule import ImplementationOpener, RunState, perform_steps, perform_task
from tests.runs import crashing
from tests.runs.crashing import steps_of
from tests.support.records import unanswered_case, worst_case

RIGHT = ImplementationOpener("builtin:table-2-float32", Limits())
DIES = ImplementationOpener("python:tests.runs.faulty:dies_on_the_axis", Limits(restarts=2))
KNOWN = (KnownFailure(None, "ring", float("inf"), "the ring"), KnownFailure("uniform/1/1/75", None, 9.0, "near"))


class Shuffled(Executor):
    """Makes one call after the other, any of those that wait."""

    def __init__(self, seed):
        self._random = random.Random(seed)  # noqa: S311
        self._waiting = []
        self._thread = ThreadPoolExecutor(1)

    def submit(self, function, /, **arguments):
        """Put a call in line."""
        self._waiting.append((future := Future(), function, arguments))
        self._thread.submit(self._call_one)
        return future

    def _call_one(self):
        future, function, arguments = self._waiting.pop(self._random.randrange(len(self._waiting)))
        if future.set_running_or_notify_cancel():
            future.set_result(function(**arguments))


def shuffled(it, rules, seed):
    with execution_here(it, rules) as performing:
        return replace(performing, executor=Shuffled(seed), workers=4)


PACE = cases.Pace(chunk_rows=256, retest_after=750, single_rows=60)
"""Chunks and rounds small enough that a test has many."""


def rules_of(implementation):
    return replace(crashing.rules_of(implementation), known=KNOWN)


def in_this_process(some, it, rules, begun=None):
    with execution_here(it, rules) as performing:
        yield from perform_steps(some, performing, begun or RunState(it.allowance))


def last(some):
    *_, (_, state) = some
    return state


def read_back(state):
    """The state as it comes back from JSON."""
    return restored_state(decoded(json.loads(json.dumps(as_json(saved_state(state)), allow_nan=False)), SavedState))


def test_an_implementation_that_describes_itself_otherwise_in_each_process_is_refused(tmp_path):
    (tmp_path / "subject.py").write_text(
        "import os\nhypcheck = {'name': 'x', 'version': str(os.getpid())}\ndef f(rows):\n    return [0] * len(rows)\n"
    )
    opening = ImplementationOpener(f"python:{tmp_path / 'subject.py'}:f", Limits(isolation=Isolation("off")))
    with opening.open() as first, pytest.raises(StartError, match="declares another description in each process"):
        replace(opening, declared=first.declared).open()


def test_results_of_tasks_can_be_merged_in_any_order():
    with RIGHT.open() as it:
        rules = rules_of(it)
        some = [
            step for step in steps_of(["ring-neighbourhood", "ring"], 375, PACE) if not isinstance(step, RetestStep)
        ]
        parts = [perform_task(step, it, rules, it.allowance).result for step in some]
    whole = saved_result(replace(merged_result(parts), pending=()))
    assert len(parts) == 8
    assert whole.tallies["ring-neighbourhood"].counts["wrong"] > 100
    assert whole.excusing == [0]
    for seed in range(4):
        mixed = [parts[place] for place in np.random.default_rng(seed).permutation(len(parts))]
        together = merged_result([merged_result(mixed[:3]), merged_result(mixed[3:])])
        assert saved_result(replace(together, pending=())) == whole


def test_result_does_not_depend_on_the_order_in_which_tasks_finish():
    some = steps_of(["uniform", "ring", "flight"], 500, PACE)
    assert {(step.number, step.part) for step in some if isinstance(step, RetestStep)} >= {
        (0, 0),
        (0, 1),
        (0, 2),
        (1, 0),
    }
    with RIGHT.open() as it:
        rules = rules_of(it)
        begun = RunState(it.allowance)
        expected = last(in_this_process(some, it, rules, begun))
        assert expected.total.retest.asked > 300
        assert not expected.total.pending
        for seed in range(2):
            assert saved_state(last(perform_steps(some, shuffled(it, rules, seed), begun))) == saved_state(expected)


def test_every_pending_case_is_retested_in_one_part_of_one_round():
    some = steps_of(["uniform", "flight"], 1250, PACE)
    with RIGHT.open() as it:
        rules = rules_of(it)
        left = [
            perform_task(step, it, rules, it.allowance).result.pending
            for step in some
            if isinstance(step, cases.CaseChunk)
        ]
        total = last(in_this_process(some, it, rules)).total
    assert total.retest.asked == sum(len(each.indices) for found in left for each in found)
    assert not total.pending


@pytest.mark.thorough
def test_restarts_are_counted_in_the_order_of_steps():
    """Cases on the axis end the process: the first few do, and all others are not run."""
    some = steps_of(["tower-body", "axis", "tower-rotors"], 375, PACE)
    with DIES.open() as it:
        rules = rules_of(it)
        begun = RunState(it.allowance)
        expected = last(in_this_process(some, it, rules, begun))
        counts = {family: each.counts for family, each in expected.total.tallies.items()}
        assert counts["tower-body"]["right"] > 350
        assert counts["axis"]["crash"] == 3
        assert set(counts["tower-rotors"]) == {"not-run"}
        assert "2 restarts are used up" in expected.left.over
        assert saved_state(last(perform_steps(some, shuffled(it, rules, 1), begun))) == saved_state(expected)
        with execution_in_pool(2, DIES, rules, it) as performing:
            assert saved_state(last(perform_steps(some, performing, begun))) == saved_state(expected)


def test_run_resumed_from_any_state_gives_the_result_of_an_unbroken_run():
    some = steps_of(["flight", "ring", "uniform"], 625, PACE)
    with RIGHT.open() as it:
        rules = rules_of(it)
        passed = [state for _, state in in_this_process(some, it, rules)]
        asked = [len(step) if isinstance(step, cases.CaseChunk) else 0 for step in some]
        assert [state.total.cases for state in passed] == list(accumulate(asked))
        for pause in (3, len(some) - 2):
            read = read_back(passed[pause])
            assert saved_state(read) == saved_state(passed[pause])
            assert saved_state(last(in_this_process(some, it, rules, read))) == saved_state(passed[-1])


def _but_for_bins(state):
    """The state as JSON without bins, of which there are so many that a run of this size has not seen them all."""
    state = as_json(saved_state(state))
    for each in state["total"]["tallies"].values():
        del each["size_bins"], each["place_bins"]
    return state


def test_saved_state_does_not_grow_with_the_run():
    some = steps_of(["uniform"], 9000, PACE)
    with RIGHT.open() as it:
        passed = [state for _, state in in_this_process(some, it, rules_of(it))]
    sizes = [len(json.dumps(_but_for_bins(state))) for state in passed]
    quarter = len(sizes) // 4
    assert quarter >= 9
    assert max(sizes[-quarter:]) < 1.1 * max(sizes[quarter : 2 * quarter])


def test_killed_worker_process_does_not_change_the_result():
    some = steps_of(["tower-body"], 1500, PACE)
    with RIGHT.open() as it:
        rules = rules_of(it)
        begun = RunState(it.allowance)
        expected = last(in_this_process(some, it, rules, begun))
        with execution_in_pool(2, RIGHT, rules, it) as performing:
            found = perform_steps(some, performing, begun)
            next(found)
            performing.executor.processes[0].kill()
            assert saved_state(last(found)) == saved_state(expected)


def test_implementation_with_another_description_in_each_process_is_refused(tmp_path):
    (tmp_path / "fickle.py").write_text(
        "import os\nhypcheck = {'name': f'by {os.urandom(8).hex()}'}\n\n\ndef f(rows):\n    return [0] * len(rows)\n"
    )
    fickle = ImplementationOpener(f"python:{tmp_path / 'fickle.py'}:f", Limits())
    with (
        fickle.open() as it,
        pytest.raises(StartError, match="declares another description"),
        execution_in_pool(2, fickle, rules_of(it), it) as performing,
    ):
        last(perform_steps(steps_of(["ring"], 10, PACE), performing, RunState(it.allowance)))


LIMITS = Allowance(20, 100)


@pytest.mark.parametrize(
    ("left", "task", "expected"),
    [
        (Allowance(20, 100, hangs=None), replace(LIMITS, restarts=15), Allowance(15, 100, hangs=None)),
        (Allowance(5, 100), replace(LIMITS, restarts=15, last="it died"), Allowance(0, 100)),
        (Allowance(20, 71), replace(LIMITS, faults=30), Allowance(20, 1)),
        (Allowance(20, 100), replace(LIMITS, hangs=1), Allowance(20, 100, hangs=1)),
        (Allowance(20, 100, hangs=None), replace(LIMITS, hangs=1), Allowance(20, 100, hangs=None)),
        (Allowance(9, 9, "enough"), replace(LIMITS, over="more"), Allowance(9, 9, "enough")),
        (Allowance(9, 9), Allowance(0, 100, "20 restarts are used up"), Allowance(0, 9, "20 restarts are used up")),
        (
            Allowance(4, 100),
            replace(LIMITS, restarts=15, last="it died"),
            Allowance(0, 100, "not asked: 20 restarts are used up; the last row at fault: it died"),
        ),
        (
            Allowance(20, 60, hangs=None),
            replace(LIMITS, faults=30, last="it raised"),
            Allowance(20, 0, "not asked: 110 rows before were at fault; the last: it raised", hangs=None),
        ),
        (
            Allowance(20, 60),
            replace(LIMITS, faults=30, last="it raised"),
            Allowance(20, 0, "not asked: 110 rows before were at fault and none was answered; the last: it raised"),
        ),
    ],
)
def test_task_that_exhausts_the_restart_limits_is_the_last_that_counts(left, task, expected):
    assert left.after(task, LIMITS) == expected


def dies_of(rows):
    """Source of an implementation that dies of these rows and answers all others, wrongly."""
    return (
        "import os\n\nimport numpy as np\n\n"
        f"ROWS = np.frombuffer(bytes.fromhex({rows.tobytes().hex()!r})).reshape(-1, 7)\n\n\n"
        "def f(rows):\n    if (rows[:, None] == ROWS).all(axis=2).any():\n        os._exit(3)\n"
        "    return np.zeros(len(rows), dtype=np.int8)\n"
    )


@pytest.mark.thorough
def test_restarts_that_run_out_over_several_chunks_count_up_to_the_end_of_the_chunk(tmp_path):
    """Two, then three of three that are allowed: the second chunk counts whole, and nothing behind it is asked."""
    some = steps_of(["tower-body"], 1500, PACE)
    drawn = [step for step in some if isinstance(step, cases.CaseChunk) and step.seed is not None]
    places = [(0, 10), (0, 120), (1, 3), (1, 4), (1, 175), (2, 9), (4, 4)]
    rows = np.concatenate([cases.cases_of_chunk(drawn[number]).rows[[index]] for number, index in places])
    (tmp_path / "dies.py").write_text(dies_of(rows))
    dies = ImplementationOpener(f"python:{tmp_path / 'dies.py'}:f", Limits(restarts=3))
    with dies.open() as it:
        rules = rules_of(it)
        begun = RunState(it.allowance)
        passed = [state for _, state in in_this_process(some, it, rules, begun)]
        expected = saved_state(passed[-1])
        (only,) = passed[-1].total.tallies.values()
        assert only.counts["crash"] == 5
        stopped = next(number for number, state in enumerate(passed) if state.left.over)
        assert some[stopped] == drawn[1]
        behind = sum(len(step) for step in some[stopped + 1 :] if isinstance(step, cases.CaseChunk))
        waiting = sum(len(each.indices) for each in passed[stopped].total.pending)
        assert only.counts["not-run"] == behind + waiting
        assert passed[-1].left.over == "not asked: 3 restarts are used up; the last row at fault: " + next(
            fault.reason for fault in only.faults if fault.status == "crash"
        )
        assert saved_state(last(perform_steps(some, shuffled(it, rules, 1), begun))) == expected
        for pause in (stopped - 1, stopped, stopped + 1):
            read = read_back(passed[pause])
            assert saved_state(last(in_this_process(some, it, rules, read))) == expected
        with execution_in_pool(2, dies, rules, it) as performing:
            assert saved_state(last(perform_steps(some, performing, begun))) == expected


def test_implementation_that_never_answered_is_given_up_after_three_hangs_with_any_executor(tmp_path):
    """Several processes find it out at the same time, and the run comes to what one process makes of it."""
    (tmp_path / "hangs.py").write_text("import time\n\n\ndef f(rows):\n    time.sleep(60)\n")
    hangs = ImplementationOpener(f"python:{tmp_path / 'hangs.py'}:f", Limits(timeout=0.3))
    some = steps_of(["tower-body"], 625, PACE)
    with hangs.open() as it:
        begun = RunState(it.allowance)
        expected = last(in_this_process(some, it, rules_of(it), begun))
        with execution_in_pool(2, hangs, rules_of(it), it) as performing:
            found = last(perform_steps(some, performing, begun))
    assert saved_state(found) == saved_state(expected)
    (only,) = found.total.tallies.values()
    assert {name: count for name, count in only.counts.items() if count} == {"timeout": 2, "not-run": only.asked - 2}


def test_merged_result_is_restored_from_its_json():
    fault = unanswered_case(
        (0, 3), "invalid-0003", (float("nan"), float("inf"), -0.0, 1.0, 1.0, 1.0, 1.0), "wrong", "said \ud83d"
    )
    worst = worst_case(
        (2, 2), "a/1/1/2", (1.5, 5e-324, 1.0, 1.0, 0.1, -0.0, 7e9), 0, 1, "false-clear", "wrong", float("inf")
    )
    left = results.PendingRetest(
        cases.CaseChunk("ring", 1, 5, 9, 2), np.array([0, 1, 3]), np.array([1, -1, 2], dtype=np.int8)
    )
    result = CasesResult(
        tallies={"some": structs.replace(tally.EMPTY, asked=3, counts={"wrong": 3}, worst=[worst], faults=[fault])},
        pending=(left,),
        retest=Retest(asked=9, within=2, beyond=1),
        outcomes=frozenset({Outcome.CRASH, Outcome.NOT_RUN}),
        excusing=frozenset({0, 7}),
        named=frozenset({"ring-0007"}),
    )
    again = restored_result(
        decoded(json.loads(json.dumps(as_json(saved_result(result)), allow_nan=False)), SavedResult)
    )
    assert again.tallies == result.tallies
    assert saved_result(again) == saved_result(result)
    for name in ("retest", "outcomes", "excusing", "named"):
        assert getattr(again, name) == getattr(result, name)
    assert again.pending[0].chunk == left.chunk
    assert again.pending[0].indices.tolist() == left.indices.tolist()
    assert again.pending[0].answers.tolist() == left.answers.tolist()
