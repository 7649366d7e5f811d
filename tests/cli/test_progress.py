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
from hypcheck.processes import Stage


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


BARS = {
    "rate and time left": ((1000, "cases"), 0, 0, [(1, (10,))] * 4, "4%  10 cases a second, 0:01:36 left"),
    "a total that grows": ((100, "cases"), 0, 300, [(1, (50,))] * 4, "50%  50 cases a second, 0:00:04 left"),
    "steps before a resume": (
        (100_000_000, "cases"), 90_000_000, 0, [(2, (1000,))], "90%  500 cases a second, 5:33:18 left"
    ),
    "another unit than steps": (
        (5000, "rows"), 0, 0, [(10, (500, 30_000_000))], "10%  3.0 million rows a second, 0:01:30 left"
    ),
    "an unknown length": ((None, "rows"), 0, 0, [(10, (500, 70))], "7 rows a second"),
}  # fmt: skip
"""The total and its unit, what is done and what more is expected before, seconds and steps, and the bar behind them."""


@pytest.mark.parametrize(("work", "done", "more", "steps", "shown"), BARS.values(), ids=BARS)
def test_a_progress_bar_shows_the_share_the_rate_and_the_time_left(screen, clock, work, done, more, steps, shown):
    total, unit = work
    with watched(total, "work", unit, done=done) as pace:
        if done:
            assert shown[:3] in screen.shown[-1]
        if more:
            pace.expect(more)
        for seconds, advanced in steps:
            clock[0] += seconds
            pace.advance(*advanced)
        assert screen.shown[-1].endswith(shown)


def test_a_progress_bar_has_the_title_of_the_stage_that_runs(screen, clock):
    def step(advance):
        clock[0] += 1
        advance(1)

    running.run_stages([Stage("first part", 1, step), Stage("second part", 3, step)])
    titles = [line.split("  ")[0] for line in screen.shown if "%" in line]
    assert titles[-2:] == ["first part", "second part"]


def test_classify_shows_a_progress_bar_on_a_terminal(screen, tmp_path):
    np.save(tmp_path / "rows.npy", np.tile([2.0, 1.0, 0.5, 0.5, 4.0, 0.0, 0.0], (20_000, 1)))
    for kind in ("npy", "csv"):
        words = ["classify", "--input", str(tmp_path / "rows.npy"), "--output", str(tmp_path / f"out.{kind}")]
        assert main(words) == 0
        assert screen.shown[-1].startswith("classify")
        assert "100%" in screen.shown[-1]
        assert screen.shown[-1].endswith("rows a second")
