"""The bar of long work: its rate and the time left, also of a resumed run; nothing in a pipe."""

from __future__ import annotations

import io
import re
from types import SimpleNamespace

import numpy as np
import pytest

from hypcheck.cli import running
from hypcheck.cli.main import main
from hypcheck.cli.running import watched


class Screen(io.StringIO):
    """A terminal."""

    def isatty(self):  # noqa: D102 - as every stream has it
        return True

    @property
    def shown(self):
        """The text of the line after each change."""
        return [line.strip() for line in re.split(r"\r|\x1b\[\?25[lh]", self.getvalue()) if line.strip()]


@pytest.fixture
def screen(monkeypatch):
    found = Screen()
    monkeypatch.setattr(running, "sys", SimpleNamespace(stderr=found))
    return found


@pytest.fixture
def clock(monkeypatch):
    """A list whose only element is the time."""
    now = [100.0]
    monkeypatch.setattr(running.time, "monotonic", lambda: now[0])
    return now


def test_the_progress_bar_shows_the_rate_and_the_time_left(screen, clock):
    with watched(1000, "work", "cases") as pace:
        for _ in range(4):
            clock[0] += 1
            pace.advance(10)
        assert screen.shown[-1].endswith("4%  10 cases a second, 0:01:36 left")


def test_a_progress_bar_whose_total_grows_shows_the_share_of_the_new_total(screen, clock):
    with watched(100, "work", "cases") as pace:
        pace.expect(300)
        for _ in range(4):
            clock[0] += 1
            pace.advance(50)
        assert screen.shown[-1].endswith("50%  50 cases a second, 0:00:04 left")


def test_the_rate_of_the_progress_bar_leaves_out_steps_done_before_a_resume(screen, clock):
    with watched(100_000_000, "work", "cases", done=90_000_000) as pace:
        assert "90%" in screen.shown[-1]
        clock[0] += 2
        pace.advance(1000)
        assert screen.shown[-1].endswith("90%  500 cases a second, 5:33:18 left")


def test_the_rate_of_the_progress_bar_may_count_another_unit_than_its_steps(screen, clock):
    with watched(5_000, "read", "rows") as pace:
        clock[0] += 10
        pace.advance(500, 30_000_000)
        assert screen.shown[-1].endswith("10%  3.0 million rows a second, 0:01:30 left")


def test_a_progress_bar_of_unknown_length_shows_no_time_left(screen, clock):
    with watched(None, "read", "rows") as pace:
        clock[0] += 10
        pace.advance(500, 70)
        assert screen.shown[-1].endswith("7 rows a second")


def test_classify_shows_a_progress_bar_on_a_terminal(screen, tmp_path):
    np.save(tmp_path / "rows.npy", np.tile([2.0, 1.0, 0.5, 0.5, 4.0, 0.0, 0.0], (20_000, 1)))
    for kind in ("npy", "csv"):
        words = ["classify", "--input", str(tmp_path / "rows.npy"), "--output", str(tmp_path / f"out.{kind}")]
        assert main(words) == 0
        assert screen.shown[-1].startswith("classify")
        assert "100%" in screen.shown[-1]
        assert screen.shown[-1].endswith("rows a second")
