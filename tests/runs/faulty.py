"""Implementations with one fault each, for conformance runs; rows float64 (n, 7) → n integers."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import numpy as np

from tests.tools.mutants.exactly import position

_CALLS = [0]
_BEFORE = [np.empty((0, 7)), np.empty(0, dtype=np.int8)]


def exact(rows):
    """Right, by integers, without hypcheck, which no isolated program sees."""
    return position(rows)


def contact_everywhere(rows):
    return np.zeros(len(rows), dtype=np.int8)


def cannot_say(rows):
    return np.full(len(rows), 2, dtype=np.int8)


def cannot_say_above(rows):
    return np.where(rows[:, 6] > 0, 2, exact(rows)).astype(np.int8)


def never_clear_by_a_little(rows):
    """Calls a spheroid grown by 1e-3 in contact: an invisible wall, but never a false clear."""
    grown = np.array(rows)
    grown[:, 2:4] *= 1.001
    return exact(grown)


def too_clear(rows):
    """Calls a spheroid shrunk by 1e-3 clear."""
    shrunk = np.array(rows)
    shrunk[:, 2:4] *= 0.999
    return exact(shrunk)


def forgetful(rows):
    """Answers otherwise after its tenth call."""
    _CALLS[0] += 1
    answers = exact(rows)
    return answers if _CALLS[0] <= 10 else -answers


def dies_on_the_axis(rows):
    if ((rows[:, 4] == 0) & (rows[:, 5] == 0)).any():
        os._exit(3)
    return exact(rows)


def raises_at_the_waist(rows):
    if (rows[:, 6] == 0).any():
        raise ValueError("no waist")
    return exact(rows)


def hangs_on_the_ring(rows):
    if len(rows) and (rows[:, 6] == 0).all():
        time.sleep(60)
    return exact(rows)


def sleeps(rows):
    """For a minute over every question, once there is a file to tell of it."""
    Path(os.environ["GATE_TEST_SIGN"]).touch()
    time.sleep(60)
    return exact(rows)


def too_slow_for_a_glance(rows):
    """Takes a second and a half over some thousand rows."""
    time.sleep(len(rows) * 4e-4)
    return exact(rows)


def refuses(rows):
    valid = np.isfinite(rows).all(axis=1) & (rows[:, :4] > 0).all(axis=1)
    answers = np.full(len(rows), 127, dtype=np.int8)
    answers[valid] = exact(rows[valid])
    return answers


def answers_bad_rows(rows):
    """Says that it refuses, but does not."""
    safe = np.where(np.isfinite(rows), rows, 1.0)
    safe[:, :4] = np.where(safe[:, :4] > 0, safe[:, :4], 1.0)
    return exact(safe)


def carries_over(rows):
    """Eight objects or more that moved by less than 4 m each since the last question keep their answers."""
    before, answers = _BEFORE
    same = len(rows) >= 8 and before.shape == rows.shape and (before[:, :4] == rows[:, :4]).all()
    if not same or (np.abs(before[:, 4:] - rows[:, 4:]) >= 4).any():
        answers = exact(rows)
    _BEFORE[:] = np.array(rows), answers
    return answers


def loses_the_second_thread(rows):
    """Questions of more than 4096 rows are shared by two threads, and what the second found is lost."""
    answers = exact(rows)
    answers[4096:] = 0
    return answers


def slowly_loses_the_second_thread(rows):
    """The same, by one who takes so long over a row that nobody asks for many at a time."""
    time.sleep(len(rows) * 1e-3)
    return loses_the_second_thread(rows)


def forgets_a_little(rows):
    """Every other question about a spheroid that is smaller by a last bit, which rounding explains."""
    _CALLS[0] += 1
    changed = np.array(rows)
    changed[:, 2:4] *= 1 - (2.0**-52 if _CALLS[0] % 2 else 0.0)
    return exact(changed)


def raises_when_asked_alone(rows):
    """A question of one row fails."""
    if len(rows) == 1:
        raise ValueError("one is not enough")
    return exact(rows)


def wrong_now_and_then(rows):
    """Every 20,000th answer of a question is another one; after ten questions there is a file to tell of it."""
    _CALLS[0] += 1
    if _CALLS[0] == 10 and "GATE_TEST_SIGN" in os.environ:
        Path(os.environ["GATE_TEST_SIGN"]).touch()
    answers = exact(rows)
    answers[::20_000] = (answers[::20_000] + 2) % 3 - 1
    return answers


def kills_who_asks(rows):
    """The row in GATE_TEST_KILLS ends the process that asks, not this one, as if the system had no memory left."""
    unlucky = np.frombuffer(bytes.fromhex(os.environ.get("GATE_TEST_KILLS", "")))
    if len(unlucky) and (rows == unlucky).all(axis=1).any():
        os.kill(os.getppid(), signal.SIGKILL)
        time.sleep(5)
    return too_clear(rows)


_seen: set[bytes] = set()


def forgets_what_comes_again(rows):
    """Exact, but a row that came before, in this question or another one, is contact."""
    answers = exact(rows)
    for place, row in enumerate(rows):
        if row.tobytes() in _seen:
            answers[place] = 0
        _seen.add(row.tobytes())
    return answers


def forgets_twins(rows):
    """Exact, but a row that stands in its question already is contact."""
    _seen.clear()
    return forgets_what_comes_again(rows)
