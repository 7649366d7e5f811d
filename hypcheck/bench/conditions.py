"""Under which conditions times are taken: what a reader of a record wants to know before believing them."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path


def governor() -> str | None:
    """What sets the processor's frequency, where the system tells: at other than "performance" times wander."""
    with suppress(OSError):
        return Path("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor").read_text(encoding="utf-8").strip()
    return None


def load() -> tuple[float, float, float] | None:
    """How many processes wanted a processor, on average of 1, 5 and 15 minutes, where the system tells."""
    with suppress(OSError, AttributeError):
        short, middle, long = (round(average, 2) for average in os.getloadavg())
        return short, middle, long
    return None
