"""A run comes to the same whoever performs its steps, in which order, and wherever it was interrupted."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import accumulate

import numpy as np
import pytest

from hypcheck import tally
from hypcheck.gate import chunks, results, schedule
from hypcheck.gate.known_failures import KnownFailure
from hypcheck.gate.results import Performed, Result, merged
from hypcheck.gate.saved import restored, restored_result, saved, saved_result
from hypcheck.gate.schedule import Again, State, states
from hypcheck.gate.work import Opening, perform
from hypcheck.gate.workers import Here, Workers
from hypcheck.methods.faults import Outcome, StartError
from hypcheck.methods.limits import Limits
from hypcheck.methods.runs import Allowance
from tests.gate import killing
from tests.gate.killing import steps_of

RIGHT = Opening("builtin:table-2-float32", Limits())
DIES = Opening("python:tests.gate.subjects:dies_on_the_axis", Limits(restarts=2))
KNOWN = (KnownFailure(None, "ring", float("inf"), "the ring"), KnownFailure("uniform/1/1/300", None, 9.0, "near"))


class Shuffled:
    """Performs what is in line in any order, each with what was left when it was put there."""

    ahead = 9

    def __init__(self, implementation, rules, seed):
        self._with = implementation, rules
        self._random = np.random.default_rng(seed)
        self._waiting, self._done, self._count = {}, {}, 0

    def submit(self, task, allowance, *, first=False):
        """Put a task in line."""
        self._count += 1
        self._waiting[self._count] = task, allowance
        return self._count

    def result(self, number):
        """Perform tasks until this one is done."""
        while number not in self._done:
            chosen = int(self._random.choice(list(self._waiting)))
            task, allowance = self._waiting.pop(chosen)
            self._done[chosen] = perform(task, *self._with, allowance)
        return self._done.pop(number)


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """Chunks and rounds small enough that a test has many."""
    monkeypatch.setattr(chunks, "SIZE", 1024)
    monkeypatch.setattr(schedule, "ROUND", 3000)


def rules_of(implementation):
    return replace(killing.rules_of(implementation), known=KNOWN)


def last(some):
    *_, (_, state) = some
    return state


def test_results_add_up_in_any_order():
    with RIGHT.open() as it:
        rules = rules_of(it)
        some = [step for step in steps_of(["ring-neighbourhood", "ring"], 1500) if not isinstance(step, Again)]
        parts = [perform(step, it, rules, it.allowance).result for step in some]
    whole = saved_result(merged(parts)) | {"open": []}
    assert len(parts) == 6
    assert whole["tallies"]["ring-neighbourhood"]["counts"]["wrong"] > 100
    assert whole["excusing"] == [0]
    for seed in range(4):
        mixed = [parts[place] for place in np.random.default_rng(seed).permutation(len(parts))]
        assert saved_result(merged([merged(mixed[:3]), merged(mixed[3:])])) | {"open": []} == whole


def test_the_order_in_which_steps_are_performed_makes_no_difference():
    some = steps_of(["uniform", "flight", "ring"], 2500)
    assert {(step.number, step.part) for step in some if isinstance(step, Again)} >= {(0, 0), (0, 1), (0, 2), (1, 0)}
    with RIGHT.open() as it:
        rules = rules_of(it)
        begun = State(it.allowance)
        expected = last(states(some, Here(it, rules), begun))
        assert expected.total.again.asked > 300
        assert not expected.total.open
        for seed in range(3):
            assert saved(last(states(some, Shuffled(it, rules, seed), begun))) == saved(expected)


def test_every_open_case_is_asked_again_in_one_part_of_one_round():
    some = steps_of(["uniform", "flight"], 5000)
    with RIGHT.open() as it:
        rules = rules_of(it)
        left = [perform(step, it, rules, it.allowance).result.open for step in some if isinstance(step, chunks.Chunk)]
        total = last(states(some, Here(it, rules), State(it.allowance))).total
    assert total.again.asked == sum(len(each.indices) for found in left for each in found)
    assert not total.open


def test_restarts_are_used_up_in_order_whoever_is_first():
    """Cases on the axis end the process: the first few do, and all others are not run."""
    some = steps_of(["tower-body", "axis", "tower-rotors"], 1500)
    with DIES.open() as it:
        rules = rules_of(it)
        begun = State(it.allowance)
        expected = last(states(some, Here(it, rules), begun))
        counts = {family: each.counts for family, each in expected.total.tallies.items()}
        assert counts["tower-body"]["right"] > 1000
        assert counts["axis"]["crash"] == 3
        assert set(counts["tower-rotors"]) == {"not-run"}
        assert "2 restarts are used up" in expected.left.over
        assert saved(last(states(some, Shuffled(it, rules, 1), begun))) == saved(expected)
        with Workers(2, DIES, rules, it) as crew:
            assert saved(last(states(some, crew, begun))) == saved(expected)


def test_a_run_goes_on_from_any_state_as_if_it_had_never_paused():
    some = steps_of(["flight", "ring", "uniform"], 2500)
    with RIGHT.open() as it:
        rules = rules_of(it)
        passed = [state for _, state in states(some, Here(it, rules), State(it.allowance))]
        asked = [len(step) if isinstance(step, chunks.Chunk) else 0 for step in some]
        assert [state.total.cases for state in passed] == list(accumulate(asked))
        for pause in (0, 3, len(some) - 2):
            read = restored(json.loads(json.dumps(saved(passed[pause]), allow_nan=False)))
            assert saved(read) == saved(passed[pause])
            assert saved(last(states(some, Here(it, rules), read))) == saved(passed[-1])


def _but_for_bins(state):
    """Of which there are so many that a run of this size has not seen them all."""
    for each in state["total"]["tallies"].values():
        del each["size_bins"], each["place_bins"]
    return state


def test_what_is_kept_of_a_run_does_not_grow_with_it():
    some = steps_of(["uniform"], 36_000)
    with RIGHT.open() as it:
        passed = [state for _, state in states(some, Here(it, rules_of(it)), State(it.allowance))]
    sizes = [len(json.dumps(_but_for_bins(saved(state)))) for state in passed]
    quarter = len(sizes) // 4
    assert quarter >= 9
    assert max(sizes[-quarter:]) < 1.1 * max(sizes[quarter : 2 * quarter])


def test_a_process_of_ours_that_is_killed_costs_nothing():
    some = steps_of(["tower-body"], 6000)
    with RIGHT.open() as it:
        rules = rules_of(it)
        begun = State(it.allowance)
        expected = last(states(some, Here(it, rules), begun))
        with Workers(2, RIGHT, rules, it) as crew:
            found = states(some, crew, begun)
            next(found)
            crew._workers[0].process.kill()
            crew._workers[1].process.kill()
            assert saved(last(found)) == saved(expected)


def test_whoever_describes_itself_otherwise_in_each_process_is_not_gated(tmp_path):
    (tmp_path / "fickle.py").write_text(
        "import os\nhypcheck = {'name': f'by {os.getpid()}'}\n\n\ndef f(rows):\n    return [0] * len(rows)\n"
    )
    fickle = Opening(f"python:{tmp_path / 'fickle.py'}:f", Limits())
    with (
        fickle.open() as it,
        pytest.raises(StartError, match="describes itself otherwise"),
        Workers(2, fickle, rules_of(it), it) as crew,
    ):
        last(states(steps_of(["ring"], 10), crew, State(it.allowance)))


@pytest.mark.parametrize(
    ("granted", "left", "actual", "fits"),
    [
        ((20, 9999, ""), (18, 9999, ""), (20, 9999, ""), True),
        ((20, 9999, ""), (18, 9999, ""), (2, 9999, ""), True),
        ((20, 9999, ""), (18, 9999, ""), (1, 9999, ""), False),
        ((20, 9999, ""), (20, 9000, ""), (20, 1000, ""), True),
        ((20, 9999, ""), (20, 9000, ""), (20, 999, ""), False),
        ((20, 9999, ""), (20, 9999, ""), (20, 9999, "used up"), False),
        ((0, 9999, ""), (0, 9999, "used up"), (0, 9999, ""), True),
        ((1, 9999, ""), (0, 9999, "used up"), (0, 9999, ""), False),
        # Of questions left without an answer before any was answered; None: one was.
        ((20, 9999, "", 3), (20, 9999, "", None), (19, 9999, "", None), True),
        ((20, 9999, "", 3), (18, 9999, "hung", 0), (20, 9999, "", None), False),
        ((20, 9999, "", 3), (18, 9999, "", None), (18, 9999, "", 1), False),
    ],
)
def test_a_result_counts_where_enough_was_left_for_it(granted, left, actual, fits):
    performed = Performed(Result(), Allowance(*granted), Allowance(*left))
    assert performed.fits(Allowance(*actual)) is fits


def test_what_never_answered_is_asked_no_more_after_three_hangs_whoever_asks(tmp_path):
    """Several processes find it out at the same time, and the run comes to what one process makes of it."""
    (tmp_path / "hangs.py").write_text("import time\n\n\ndef f(rows):\n    time.sleep(60)\n")
    hangs = Opening(f"python:{tmp_path / 'hangs.py'}:f", Limits(timeout=0.3))
    some = steps_of(["tower-body"], 2500)
    with hangs.open() as it:
        begun = State(it.allowance)
        expected = last(states(some, Here(it, rules_of(it)), begun))
        with Workers(2, hangs, rules_of(it), it) as crew:
            found = last(states(some, crew, begun))
    assert saved(found) == saved(expected)
    (only,) = found.total.tallies.values()
    assert {name: count for name, count in only.counts.items() if count} == {"timeout": 2, "not-run": only.asked - 2}


def test_a_result_comes_back_from_json():
    fault = tally.Fault(
        (0, 3), "invalid-0003", (float("nan"), float("inf"), -0.0, 1.0, 1.0, 1.0, 1.0), "wrong", "said \ud83d"
    )
    worst = tally.Worst(
        (1, 2), "a/1/1/2", (1.5, 5e-324, 1.0, 1.0, 0.1, -0.0, 7e9), 0, 1, "false-clear", "wrong", float("inf")
    )
    left = results.Open(chunks.Chunk("ring", 1, 5, 9, 2), np.array([0, 1, 3]), np.array([1, -1, 2], dtype=np.int8))
    result = Result(
        tallies={"some": tally.Tally(3, {"wrong": 3}, worst=(worst,), faults=(fault,))},
        open=(left,),
        again=results.Again(9, 2, 1),
        outcomes=frozenset({Outcome.CRASH, Outcome.NOT_RUN}),
        excusing=frozenset({0, 7}),
        named=frozenset({"ring-0007"}),
    )
    again = restored_result(json.loads(json.dumps(saved_result(result), allow_nan=False)))
    assert again.tallies["some"].worst == (worst,)
    assert repr(again.tallies["some"].faults) == repr((fault,))
    assert saved_result(again) == saved_result(result)
    for name in ("again", "outcomes", "excusing", "named"):
        assert getattr(again, name) == getattr(result, name)
    assert again.open[0].chunk == left.chunk
    assert again.open[0].indices.tolist() == left.indices.tolist()
    assert again.open[0].answers.tolist() == left.answers.tolist()
