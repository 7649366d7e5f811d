"""A terminal that may be closed while somebody's work goes on in it.

How far long work is: a bar with the rate and the time left where a person is watching, nothing in a pipe.
"""

from __future__ import annotations

import io
import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import repeat
from typing import TYPE_CHECKING, Any, TextIO, cast

import click

if TYPE_CHECKING:
    from click._termui_impl import ProgressBar


class DetachableTerminal(io.TextIOBase):
    """Writes to a terminal while it is there, and then to nowhere: a bar that nobody can see is no reason to end."""

    def __init__(self, terminal: TextIO) -> None:
        super().__init__()
        self._terminal = terminal

    def isatty(self) -> bool:
        """As the terminal has it."""
        return self._terminal.isatty()

    def write(self, text: str) -> int:
        """Write it, if anybody can still see it."""
        try:
            return self._terminal.write(text)
        except OSError:
            self._leave()
            return len(text)

    def flush(self) -> None:
        """Let it be seen."""
        try:
            self._terminal.flush()
        except OSError:
            self._leave()

    def _leave(self) -> None:
        """Let what is held back, which Python would try to write once more as it ends, go to nowhere."""
        with suppress(OSError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self._terminal.fileno())
            os.close(nowhere)


_SOONEST, _FIRST = 0.1, 1.0
"""Seconds between two looks of a bar, and until it foretells anything."""


def is_terminal(stream: TextIO | None) -> bool:
    """Whether a person may be watching; a stream whose descriptor was closed is None."""
    return stream is not None and stream.isatty()


def in_colour() -> bool:
    """Whether standard output shows colours, and nobody wants none (https://no-color.org)."""
    return is_terminal(sys.stdout) and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def in_lines() -> dict[str, Any]:
    """How standard output shows a summary: cut to a width and perhaps in colour on a terminal, whole in a pipe."""
    from hypcheck.report.terminal import WIDTH

    return {"colour": in_colour(), "width": WIDTH if is_terminal(sys.stdout) else None}


@contextmanager
def watched(length: int | None, label: str, unit: str = "", done: int = 0) -> Iterator[Pace]:
    """A bar of so many steps, of which some were `done` before.

    `length` is None where it is not known, `unit` what is counted in a second, where many pass.
    """
    if length == 0 or not is_terminal(sys.stderr):
        yield Pace(None, unit)
        return
    with click.progressbar(
        map(str, repeat("")) if length is None else None,  # it has no length, by which click knows of none
        length=length,
        label=label,
        file=cast("TextIO", DetachableTerminal(sys.stderr)),
        show_eta=False,
        item_show_func=lambda said: said,
    ) as bar:
        bar.update(done)
        yield Pace(bar, unit)


class Pace:
    """Moves a bar now and then, and shows beside it what passes in a second, and the time left at that rate.

    Where there is no bar nothing is shown.
    """

    def __init__(self, bar: ProgressBar[Any] | None, unit: str) -> None:
        self._bar = bar
        self.unit = unit
        self._begun = self._shown = time.monotonic()
        self._steps = self._things = self._waiting = 0

    def name(self, label: str, unit: str) -> None:
        """From here on it is something else that is done."""
        self.unit = unit
        if self._bar is not None:
            self._bar.label = label

    def advance(self, steps: int, things: int | None = None) -> None:
        """Take note of steps that are done; of how many `things`, where a step is not one of them."""
        if self._bar is None:
            return
        self._waiting += steps
        self._things += steps if things is None else things
        now, length = time.monotonic(), self._bar.length
        last = length is not None and self._bar.pos + self._waiting >= length
        if now < self._shown + _SOONEST and not last:
            return
        self._shown = now
        self._steps += self._waiting
        elapsed, waiting, self._waiting = now - self._begun, self._waiting, 0
        if elapsed < _FIRST and not last:
            self._bar.update(waiting)
            return
        said = [f"{_per_second(self._things / max(elapsed, 1e-9))} {self.unit} a second"] if self.unit else []
        if length is not None and not last and self._steps:
            left = length - self._bar.pos - waiting
            said.append(f"{_clock(left * elapsed / self._steps)} left")
        self._bar.update(waiting, ", ".join(said))


def _per_second(rate: float) -> str:
    return f"{rate / 1e6:.1f} million" if rate >= 1e6 else f"{rate:,.0f}"


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{rest:02}"
