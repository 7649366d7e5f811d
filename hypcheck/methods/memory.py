"""The resident memory of a process group, looked at from outside.

An address-space limit would be simpler, but kills what reserves much and uses little: sanitizers, Go, the JVM.
"""

from __future__ import annotations

import os
import subprocess
import time

from hypcheck.methods.faults import FaultError, Outcome

_SOONEST = 0.05
_SHARE = 20
_FASTEST = 8 << 30
"""Between two looks pass 50 ms, and 20 times what a look takes: it costs 5 % of one core at most. Nor is it looked
before memory can have grown to the limit, by so many bytes a second, which is more than a system can clear."""


class MemoryWatch:
    """Looks now and then at a group's memory, and raises a FaultError where it is beyond the limit."""

    def __init__(self, group: int, limit: int) -> None:
        self._group = group
        self._limit = limit
        self._next = time.monotonic() + _SOONEST

    def look(self, now: float) -> None:
        """Look, if it is time to; `now` is time.monotonic()."""
        if now < self._next:
            return
        used = resident(self._group)
        after = time.monotonic()
        self._next = after + max(_SOONEST, _SHARE * (after - now), (self._limit - used) / _FASTEST)
        if used > self._limit:
            reason = f"memory: its processes grew to {used / 2**30:.2f} GiB, beyond {self._limit / 2**30:.2f} GiB"
            raise FaultError(Outcome.CRASH, reason, fatal=True)


def resident(group: int) -> int:
    """Bytes resident in all processes of a group; 0 where the system does not tell."""
    return _by_proc(group) if os.path.exists("/proc/self/stat") else _by_ps(group)


def _by_proc(group: int) -> int:
    pages = 0
    for name in os.listdir("/proc"):
        if name.isdigit():
            try:
                with open(f"/proc/{name}/stat", "rb") as file:
                    stat = file.read()
            except OSError:  # it ended meanwhile, or is hidden from us
                continue
            fields = stat[stat.rfind(b")") + 2 :].split()  # the name before ")" may hold anything
            if int(fields[2]) == group:
                pages += int(fields[21])
    return pages * os.sysconf("SC_PAGE_SIZE")


def _by_ps(group: int) -> int:
    """For systems without /proc, such as macOS; ps counts in KiB."""
    try:
        listing = subprocess.run(
            ("ps", "-A", "-o", "pgid=", "-o", "rss="),  # noqa: S607 - not everywhere in the same place
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            check=False,
        ).stdout
    except OSError:
        return 0
    pairs = (line.split() for line in listing.splitlines())
    return sum(int(pair[1]) << 10 for pair in pairs if len(pair) == 2 and int(pair[0]) == group)
