"""The time that an implementation is given."""

from __future__ import annotations

import time

STEP = 0.25
"""What of a longer time between two looks counts: for the rest of it we were not there."""


class Clock:
    """Counts the seconds for which we have listened, or could have; whoever waits looks at it several times a second.

    It stands still while we are stopped ourselves (Ctrl-Z, a debugger, a machine that sleeps or has no time for us).
    What came meanwhile could not be read, so that it is no delay of whoever was asked.
    """

    def __init__(self) -> None:
        self._counted, self._looked = 0.0, time.monotonic()

    def now(self) -> float:
        """Seconds since the beginning."""
        looked = time.monotonic()
        self._counted += min(looked - self._looked, STEP)
        self._looked = looked
        return self._counted
