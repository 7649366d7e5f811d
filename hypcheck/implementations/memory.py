"""The processes that a program started, daemons included, and their memory, watched from outside.

What a foreign program starts and lets go of: a daemon in a session of its own is in no group that we could end.

It keeps the environment that its program was given, though, and there a mark tells whose it is. Only Linux shows us
environments; elsewhere what detaches itself outlives the run.

The memory of a program and of everything that it started, looked at from outside.

An address-space limit would be simpler, but kills what reserves much and uses little: sanitizers, Go, the JVM.
"""

from __future__ import annotations

import os
import secrets
import signal
import subprocess
import time
from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import NamedTuple

from hypcheck.implementations.session import FaultError, Outcome

GUARD = """
exec >&- 2>&-
(
    while sleep "$3"; do
        read -r line < /proc/$PPID/stat || exit
        set -- "$1" "$2" "$3" "$4" ${line##*) }
        if [ "$5" = T ] && [ "${54}" = "$4" ]; then
            [ "$seen" ] && kill -s CONT "$PPID"
            seen=1
        else
            seen=
        fi
    done
) &
read -r _
kill -s KILL -- "-$1"
grep -ls "$2" /proc/[0-9]*/environ | while IFS=/ read -r _ _ each _; do kill -s KILL "$each"; done
kill -s KILL 0
"""
"""For a shell that leads a group: it reads until its standard input ends, which only we hold open, and then kills the
group $1, whoever has the mark $2, and itself.

Meanwhile it looks at us every $3 seconds. If it finds us stopped by the signal number $4 twice in turn, it lets us go
on: the program may have sent it, and nobody else might ever undo it. The field `exit_code` of a `stat`, the 52nd, tells
which signal stopped a process, until its parent has taken note of that, as a shell does at a terminal, where somebody
can undo it (Linux 5.17 and later; earlier it is 0, and nothing is undone). Ctrl-Z is another signal.
"""

LOOK = 5
"""Seconds between two looks of a guard."""

_ROUNDS = 5
"""Looks for who was started while others were ended."""


def new_environment_mark() -> str:
    """The name of a variable for an environment; with those of others it can stand in one."""
    return f"HYPCHECK_{secrets.token_hex(16)}"


def end_marked(mark: str) -> None:
    """Kill all processes that have the mark and that we may kill."""
    for _ in range(_ROUNDS):
        found = list(_marked(mark))
        for process in found:
            with suppress(OSError):
                os.kill(process, signal.SIGKILL)
        if not found:
            return


def is_marked(process: int, mark: str) -> bool:
    """Whether the environment of a process has the mark; never of another user's, or where the system does not tell."""
    try:
        with open(f"/proc/{process}/environ", "rb") as file:
            return f"{mark}=".encode() in file.read()
    except OSError:  # it ended meanwhile, or is another's
        return False


def _marked(mark: str) -> Iterator[int]:
    try:
        names = os.listdir("/proc")
    except OSError:
        return
    yield from (int(name) for name in names if name.isdigit() and is_marked(int(name), mark))


_SOONEST = 0.05
_SHARE = 20
_FASTEST = 8 << 30
"""Between two looks pass 50 ms, and 20 times what a look takes: it costs 5 % of one core at most. Nor is it looked
before memory can have grown to the limit, by so many bytes a second, which is more than a system can clear."""


class _ProcessMemory(NamedTuple):
    """A process of the system: `started` tells it from a later one of the same number; `resident` is in bytes."""

    number: int
    parent: int
    group: int
    session: int
    started: int
    resident: int

    @property
    def identity(self) -> tuple[int, int]:
        return self.number, self.started


class MemoryWatch:
    """Looks now and then at the memory of a program's processes, and raises a FaultError where it is beyond the limit.

    Its processes are those of the group and session that `leader` leads, those whose environment has the `mark` that
    it was given, what any of these started, and whatever was one of them before, though its parent has ended since.
    """

    def __init__(self, leader: int, mark: str, limit: int) -> None:
        self._leader = leader
        self._mark = mark
        self._limit = limit
        self._next = time.monotonic() + _SOONEST
        self._known: dict[tuple[int, int], bool] = {}

    def look(self, now: float) -> None:
        """Look, if it is time to; `now` is time.monotonic()."""
        if now < self._next:
            return
        used = self.used()
        after = time.monotonic()
        self._next = after + max(_SOONEST, _SHARE * (after - now), (self._limit - used) / _FASTEST)
        if used > self._limit:
            reason = f"memory: its processes grew to {used / 2**30:.2f} GiB, beyond {self._limit / 2**30:.2f} GiB"
            raise FaultError(Outcome.CRASH, reason, fatal=True)

    def used(self) -> int:
        """Bytes that its processes hold; 0 where the system does not tell.

        What they share counts once where the sum of all that is resident is beyond the limit: to tell that, the system
        goes through every page.
        """
        ours = list(self._ours(list(_all_processes())))
        resident = sum(each.resident for each in ours)
        return resident if resident <= self._limit else sum(map(_proportional, ours))

    def _ours(self, found: list[_ProcessMemory]) -> Iterator[_ProcessMemory]:
        known = self._known
        self._known = {each.identity: known[each.identity] for each in found if each.identity in known}
        children: dict[int, list[_ProcessMemory]] = {}
        for each in found:
            children.setdefault(each.parent, []).append(each)
        todo = [each for each in found if self._is_ours(each)]
        while todo:
            each = todo.pop()
            yield each
            for child in children.pop(each.number, ()):
                if not self._known[child.identity]:
                    self._known[child.identity] = True
                    todo.append(child)

    def _is_ours(self, each: _ProcessMemory) -> bool:
        """Whether a process is one of its processes, as far as it tells itself. Asked once: its environment stays."""
        if each.identity not in self._known:
            self._known[each.identity] = is_marked(each.number, self._mark)
        if self._leader in {each.group, each.session}:
            self._known[each.identity] = True
        return self._known[each.identity]


def _all_processes() -> Iterable[_ProcessMemory]:
    return _by_proc() if os.path.exists("/proc/self/stat") else _by_ps()


def _by_proc() -> Iterator[_ProcessMemory]:
    page = os.sysconf("SC_PAGE_SIZE")
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", "rb") as file:
                stat = file.read()
        except OSError:  # it ended meanwhile, or is hidden from us
            continue
        fields = stat[stat.rfind(b")") + 2 :].split()  # the name before ")" may hold anything
        parent, group, session, started, pages = (int(fields[place]) for place in (1, 2, 3, 19, 21))
        yield _ProcessMemory(int(name), parent, group, session, started, pages * page)


def _by_ps() -> Iterator[_ProcessMemory]:
    """For systems without /proc, such as macOS; ps counts in KiB."""
    try:
        listing = subprocess.run(
            ("ps", "-A", "-o", "pid=", "-o", "ppid=", "-o", "pgid=", "-o", "rss="),  # noqa: S607 - not everywhere in the same place
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            check=False,
        ).stdout
    except OSError:
        return
    for line in listing.splitlines():
        if len(fields := line.split()) == 4:
            number, parent, group, kib = map(int, fields)
            yield _ProcessMemory(number, parent, group, 0, 0, kib << 10)


def _proportional(each: _ProcessMemory) -> int:
    """Bytes that a process holds, of each page that others hold too its share; all that is resident where not told."""
    try:
        with open(f"/proc/{each.number}/smaps_rollup", "rb") as file:
            for line in file:
                if line.startswith(b"Pss:"):
                    return int(line.split()[1]) << 10
    except OSError:  # it ended meanwhile, is not ours to look into, or the system is too old
        pass
    return each.resident
