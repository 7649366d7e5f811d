"""The progress of long work: a bar with the rate and the time left on a terminal, nothing in a pipe.

If the terminal is closed, the work goes on without a bar.
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
    """Writes to a terminal; once that is closed, writes are dropped and raise no error."""

    def __init__(self, terminal: TextIO) -> None:
        super().__init__()
        self._terminal = terminal

    def isatty(self) -> bool:
        """Whether the stream is a terminal."""
        return self._terminal.isatty()

    def write(self, text: str) -> int:
        """Write the text, or drop it if the terminal is closed."""
        try:
            return self._terminal.write(text)
        except OSError:
            self._escape()
            return len(text)

    def flush(self) -> None:
        """Write what is buffered, or drop it if the terminal is closed."""
        try:
            self._terminal.flush()
        except OSError:
            self._escape()

    def _escape(self) -> None:
        """Send what is buffered to the null device: Python would try to write it again as it ends."""
        with suppress(OSError):
            null = os.open(os.devnull, os.O_WRONLY)
            os.dup2(null, self._terminal.fileno())
            os.close(null)


_UPDATE_SECONDS, _FIRST_RATE_SECONDS = 0.1, 1.0
"""Seconds between two updates of a bar, and until it shows a rate."""


def is_terminal(stream: TextIO | None) -> bool:
    """Whether a stream is a terminal; a stream whose descriptor was closed is None."""
    return stream is not None and stream.isatty()


def in_colour() -> bool:
    """Whether standard output is a terminal with colours that are not switched off (https://no-color.org)."""
    return is_terminal(sys.stdout) and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def summary_options() -> dict[str, Any]:
    """Arguments of summary_lines: on a terminal the lines are cut to its width, and coloured; in a pipe neither."""
    from hypcheck.report.terminal import WIDTH

    return {"colour": in_colour(), "width": WIDTH if is_terminal(sys.stdout) else None}


@contextmanager
def watched(length: int | None, label: str, unit: str = "", done: int = 0) -> Iterator[ShownPace]:
    """A bar of `length` steps (None if unknown), of which some were `done` before; `unit` names what a rate counts."""
    if length == 0 or not is_terminal(sys.stderr):
        yield ShownPace(None, unit)
        return
    with click.progressbar(
        map(str, repeat("")) if length is None else None,  # click asks it for a length, and it has none
        length=length,
        label=label,
        file=cast("TextIO", DetachableTerminal(sys.stderr)),
        show_eta=False,
        item_show_func=lambda text: text,
    ) as bar:
        bar.update(done)
        yield ShownPace(bar, unit)


class ShownPace:
    """Updates a bar ten times a second, and shows the rate beside it, and the time left at that rate.

    Without a bar nothing is shown.
    """

    def __init__(self, bar: ProgressBar[Any] | None, unit: str) -> None:
        self._bar = bar
        self.unit = unit
        self._begun = self._shown = time.monotonic()
        self._steps = self._units = self._waiting = 0

    def name(self, label: str, unit: str) -> None:
        """Begin another stage, with its label and unit."""
        self.unit = unit
        if self._bar is not None:
            self._bar.label = label

    def expect(self, more: int) -> None:
        """Make the bar longer by so many steps, or shorter."""
        if self._bar is not None and self._bar.length is not None:
            self._bar.length += more

    def advance(self, steps: int, units: int | None = None) -> None:
        """Take note of steps that are done, and of how many `units`, if a step is not one unit."""
        if self._bar is None:
            return
        self._waiting += steps
        self._units += steps if units is None else units
        now, length = time.monotonic(), self._bar.length
        last = length is not None and self._bar.pos + self._waiting >= length
        if now < self._shown + _UPDATE_SECONDS and not last:
            return
        self._shown = now
        self._steps += self._waiting
        elapsed, waiting, self._waiting = now - self._begun, self._waiting, 0
        if elapsed < _FIRST_RATE_SECONDS and not last:
            self._bar.update(waiting)
            return
        text = [f"{_per_second(self._units / max(elapsed, 1e-9))} {self.unit} a second"] if self.unit else []
        if length is not None and not last and self._steps:
            left = length - self._bar.pos - waiting
            text.append(f"{_clock(left * elapsed / self._steps)} left")
        self._bar.update(waiting, ", ".join(text))


def _per_second(rate: float) -> str:
    return f"{rate / 1e6:.1f} million" if rate >= 1e6 else f"{rate:,.0f}"


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{rest:02}"
