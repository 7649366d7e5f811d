"""Executors: errors of tasks are raised by their futures, and a pool that ends cancels what waits."""

from __future__ import annotations

import pytest

from hypcheck.implementations.implementation import Crashed
from hypcheck.implementations.session import Allowance, Outcome
from hypcheck.runs.executors import SerialExecutor


def test_an_error_of_a_task_is_raised_by_its_future_and_not_where_it_is_submitted():
    with SerialExecutor() as executor:
        failed, done = executor.submit(int, "no number"), executor.submit(int, "7")
        with pytest.raises(ValueError, match="no number"):
            failed.result()
        assert done.result() == 7


def test_stand_in_for_an_implementation_that_kills_workers_reports_a_crash_for_every_row():
    allowance = Allowance(1, 2, "", None)
    crashed = Crashed(16, "it ended the worker", Allowance(5, 5, "", None))
    crashed.allowance = allowance
    answered = crashed.classify([[1.0] * 7] * 3)
    assert (crashed.max_rows, crashed.allowance) == (16, allowance)
    assert not answered.answered.any()
    assert answered.count(Outcome.CRASH) == 3
    assert set(answered.reasons.values()) == {"it ended the worker"}
