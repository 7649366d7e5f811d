"""Progress of a long run for a person: in place on a terminal, otherwise a line a minute."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import TypeVar

import click

T = TypeVar("T")

EVERY = 60.0
"""Seconds between two lines of a log."""


def progress_line(says: Callable[[T], str], every: float = EVERY) -> Callable[[T], None]:
    """What tells of a run whenever it is called with how the run stands."""
    begun = told = time.monotonic()
    watched = sys.stderr.isatty()

    def tell(stands: T) -> None:
        nonlocal told
        now = time.monotonic()
        if watched:
            click.echo(f"\r{says(stands)} ", nl=False, err=True)
        elif now >= told + every:
            told = now
            click.echo(f"{now - begun:.0f} s: {says(stands)}", err=True)

    return tell
