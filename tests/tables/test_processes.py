"""A long table has the same answers and errors by several processes as by one."""

from __future__ import annotations

import json
import os
import signal
from itertools import chain

import numpy as np
import pytest

from hypcheck.answers import classify_table
from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS
from hypcheck.processes import in_order
from hypcheck.tables import Route
from hypcheck.tables.chunk import CHUNK

ROWS = 5 * CHUNK + 7


@pytest.fixture
def rows():
    found = np.tile([2.0, 17.8, 0.25, 0.15, 0.0, 0.0, 0.0], (ROWS, 1))
    found[:, 4:] = np.random.default_rng(1).uniform(-3, 3, (ROWS, 3))
    return found


@pytest.fixture
def classify(tmp_path):
    """A function that classifies a table with so many workers, from the second chunk on, and returns the output."""

    def run(source, kind, workers):
        target = tmp_path / f"answers-{workers}.{kind}"
        classify_table(Route(str(source), source.suffix[1:], str(target), kind), mark=False, workers=workers, alone=1)
        return target.read_bytes()

    return run


@pytest.mark.parametrize(("kind", "target"), [("npy", "npy"), ("npy", "csv"), ("csv", "csv"), ("jsonl", "jsonl")])
def test_classify_with_two_workers_writes_the_same_answers_as_with_one(rows, classify, tmp_path, kind, target):
    source = tmp_path / f"rows.{kind}"
    if kind == "npy":
        np.save(source, rows)
    else:
        source.write_text(text_of(rows, kind))
    assert classify(source, target, 2) == classify(source, target, 1)


def text_of(rows, kind):
    if kind == "csv":
        return "\n".join([",".join(COLUMNS), *(",".join(map(repr, row)) for row in rows.tolist()), ""])
    return "".join(json.dumps(dict(zip(COLUMNS, row, strict=True))) + "\n" for row in rows.tolist())


def test_the_first_bad_row_is_reported_even_if_later_rows_have_other_faults(rows, classify, tmp_path):
    source = tmp_path / "rows.csv"
    bad = 2 * CHUNK + 3
    rows[bad, 2] = -0.25
    lines = text_of(rows, "csv").splitlines()
    lines[bad + CHUNK] += ",8"
    lines[-1] = "\udcff"
    source.write_bytes("\n".join(lines).encode("utf-8", "surrogateescape"))
    said = []
    for workers in (1, 2):
        with pytest.raises(InputError) as told:
            classify(source, "csv", workers)
        said.append(str(told.value))
        assert sorted(path.name for path in tmp_path.iterdir()) == ["rows.csv"]
    assert said[0] == said[1]
    assert f"row {bad + 1} (line {bad + 2}): b is -0.25" in said[0]


def double(number):
    if number == 40:
        raise InputError("40 is too much")
    return 2 * number


def killed_elsewhere(number):
    """Kills every process but the one that the task names."""
    if number[0] != os.getpid():
        os.kill(os.getpid(), signal.SIGKILL)
    return number[1]


def failing(some):
    yield from some
    raise InputError("no more")


def test_results_and_errors_of_workers_come_in_the_order_of_tasks():
    assert list(in_order(double, range(30), 2, 3)) == [2 * number for number in range(30)]
    assert list(in_order(double, range(2), 2, 3)) == [0, 2]
    for tasks, said in ((chain(range(35), range(40, 90)), "40 is too much"), (failing(range(35)), "no more")):
        found = []
        with pytest.raises(InputError, match=said):
            found.extend(in_order(double, tasks, 2, 3))  # keeps what came before the error
        assert found[:35] == [2 * number for number in range(35)]


def test_task_whose_worker_is_killed_is_done_by_the_parent_process():
    tasks = [(os.getpid(), number) for number in range(20)]
    assert list(in_order(killed_elsewhere, tasks, 2, 3)) == list(range(20))
