"""Damaged input gives a value or one sentence; `make soak` reads a million more. The fuzz itself is tested too."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.tools.fuzz import running
from tests.tools.fuzz.bombs import bombs
from tests.tools.fuzz.judging import judged, stop_hangs, trouble_with
from tests.tools.fuzz.readers import FAULTY, READERS
from tests.tools.fuzz.running import Patience, run

CORPUS = sorted(path for path in (Path(__file__).parent / "corpus").glob("*/*"))
BOMBS = bombs()


@pytest.fixture(autouse=True, scope="module")
def _stopped():
    stop_hangs()


@pytest.mark.parametrize("path", CORPUS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_inputs_that_once_failed_no_longer_fail(path):
    verdict = judged(READERS[path.parent.name].read, path.read_bytes())
    assert verdict.kind != "finding", verdict.says


@pytest.mark.parametrize("name", BOMBS)
def test_reading_a_damaged_input_never_takes_long(name):
    reader, data = BOMBS[name]
    verdict = judged(READERS[reader].read, data)
    assert verdict.kind != "finding", verdict.says


@pytest.mark.parametrize("name", READERS)
def test_every_reader_reads_its_undamaged_inputs(name):
    kinds = {judged(READERS[name].read, data, 60.0).kind for data in READERS[name].seeds()}
    assert "value" in kinds
    assert "finding" not in kinds


def test_fuzz_finds_no_fault_in_any_reader_with_800_inputs():
    tally = run(800, seed=2, names=tuple(READERS), processes=2)
    assert tally.count >= 760
    assert not tally.findings, tally.findings[0]
    assert not tally.failed
    asked_often = [kinds for kinds in tally.kinds.values() if kinds.total() >= 8]  # a plot takes long, and gets one
    assert len(asked_often) >= len(READERS) - 1
    assert all(kinds["refused"] for kinds in asked_often)
    assert sum(kinds["value"] for kinds in tally.kinds.values()) > 100


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("raises", "KeyError"),
        ("speaks in colours", r"says '\\x1b'"),
        ("loops", "hang: it was stopped"),
        ("takes a gigabyte", "MemoryError"),
        ("sleeps", "hang: it had to be killed"),
        ("dies", "the process ended with 3"),
    ],
)
def test_fuzz_finds_a_faulty_reader(name, says):
    assert name in FAULTY
    tally = run(1, seed=1, names=(name,), processes=1, stuck=6.0 if name == "sleeps" else 60.0)
    assert tally.failed
    assert re.search(says, tally.findings[0].says), tally.findings


def test_timeout_counts_for_one_input_not_for_a_batch(monkeypatch):
    now = 0.0
    monkeypatch.setattr(running.time, "monotonic", lambda: now)
    patience = Patience(60.0)
    for place in range(5):
        now += 50.0
        assert not patience.ends(place)
    now += 61.0
    assert patience.ends(4)
    patience.renew()
    assert not patience.ends(4)


def test_fuzz_finds_a_reader_that_leaks_memory():
    tally = run(400, seed=1, names=("keeps",), processes=1)
    assert not tally.findings
    assert tally.failed


@pytest.mark.parametrize(
    "text", ["", " ", "two\nlines", "\x1b[31m", "\u202e", "\ud800", "x" * 1001, "a Traceback (most"]
)
def test_fuzz_recognises_a_message_that_is_no_sentence(text):
    assert trouble_with(text)
    assert trouble_with("row 3 (line 4): alpha is 0; it must be greater than 0") is None
