"""The processes that a program started, daemons included: their memory and their waiting times.

A daemon in a session of its own is in no group that can be killed. It keeps the environment of its program, though, and
a mark in that shows whose it is. Only Linux shows environments; on other systems a daemon outlives the run.

A limit of the address space would be simpler, but kills programs that reserve much and use little: sanitizers, Go, the
JVM.
"""

from __future__ import annotations

import os
import secrets
import signal
import subprocess
import time
from collections.abc import Iterable, Iterator
from contextlib import suppress
from glob import glob
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
"""The program of a guard, a shell that leads a group of its own. It reads until its standard input ends, which only
hypcheck holds open; then it kills the group $1, all processes with the mark $2, and itself.

Meanwhile it checks hypcheck every $3 seconds. If two checks in a row find it stopped by the signal number $4, the guard
continues it: the program may have sent the signal, and nobody else might undo it. The 52nd field of `stat` is the
signal that stopped a process, until its parent has read it, as a shell at a terminal does, where a person can continue
it (since Linux 5.17; before that it is 0, and nothing is undone). Ctrl-Z sends another signal.
"""

LOOK = 5
"""Seconds between two checks of a guard."""

_ROUNDS = 5
"""The number of searches for processes that were started while others were killed."""


def new_environment_mark() -> str:
    """Return the name of an environment variable; several marks may be in one environment."""
    return f"HYPCHECK_{secrets.token_hex(16)}"


def end_marked(mark: str) -> None:
    """Kill all processes with the mark, as far as permissions allow."""
    for _ in range(_ROUNDS):
        processes = list(_marked(mark))
        for process in processes:
            with suppress(OSError):
                os.kill(process, signal.SIGKILL)
        if not processes:
            return


def is_marked(process: int, mark: str) -> bool:
    """Whether the environment of a process has the mark; False if the system does not show it."""
    try:
        with open(f"/proc/{process}/environ", "rb") as file:
            return f"{mark}=".encode() in file.read()
    except OSError:  # it ended meanwhile, or belongs to another user
        return False


def _marked(mark: str) -> Iterator[int]:
    """Yield the numbers of all processes with the mark."""
    try:
        names = os.listdir("/proc")
    except OSError:
        return
    yield from (int(name) for name in names if name.isdigit() and is_marked(int(name), mark))


_SOONEST = 0.05
_SHARE = 20
_FASTEST = 8 << 30
"""Between two checks pass at least 50 ms, and 20 times the processor time of a check, so that they take at most 5 % of
one core. There is no check before memory can reach the limit at so many bytes a second, faster than a system can clear
it."""


class _ProcessMemory(NamedTuple):
    """A process of the system. A later one with the same `number` has another `started`; `resident` is in bytes."""

    number: int
    parent: int
    group: int
    session: int
    started: int
    resident: int

    @property
    def identity(self) -> tuple[int, int]:
        """What tells this process from a later one with the same number."""
        return self.number, self.started


class MemoryWatch:
    """Checks the memory of a program's processes now and then, and raises FaultError if it exceeds the limit.

    These are the processes of the group and the session of `leader`, those with the `mark` in their environment, all
    children of these, and all processes that were among them before, even if their parents have ended.
    """

    def __init__(self, leader: int, mark: str, limit: int) -> None:
        self._leader = leader
        self._mark = mark
        self._limit = limit
        self._next_check = time.monotonic() + _SOONEST
        self._belongs: dict[tuple[int, int], bool] = {}  # by a process' identity: whether it belongs to the program
        self._waits_ns: dict[str, int] = {}

    def look(self, now: float) -> None:
        """Check the memory if the next check is due; `now` is time.monotonic(). Raises FaultError above the limit."""
        if now < self._next_check:
            return
        before = time.thread_time()
        used = self.used()
        took = time.thread_time() - before
        self._next_check = time.monotonic() + max(_SOONEST, _SHARE * took, (self._limit - used) / _FASTEST)
        if used > self._limit:
            reason = f"memory: its processes grew to {used / 2**30:.2f} GiB, beyond {self._limit / 2**30:.2f} GiB"
            raise FaultError(Outcome.CRASH, reason, fatal=True)

    def waited(self) -> float:
        """Return the longest time in seconds that a thread of the program waited for a processor since the last call.

        0 if the system does not tell.
        """
        before, self._waits_ns = self._waits_ns, {}
        for (number, _), ours in self._belongs.items():
            for path in glob(f"/proc/{number}/task/*/schedstat") if ours else ():
                with suppress(OSError, IndexError), open(path, "rb") as file:  # it may end meanwhile
                    self._waits_ns[path] = int(file.read().split()[1])
        return (
            max((waited - before[path] for path, waited in self._waits_ns.items() if path in before), default=0) / 1e9
        )

    def used(self) -> int:
        """Return the bytes that the program's processes use, with their page tables.

        Return 0 if the system does not report them.

        If their sum exceeds the limit, shared pages count once. The system needs to visit every page for that.
        """
        ours = list(self._ours(list(_all_processes())))
        tables = sum(_bytes_in(f"/proc/{process.number}/status", b"VmPTE:") or 0 for process in ours)
        resident = sum(process.resident for process in ours)
        return tables + (resident if tables + resident <= self._limit else sum(map(_proportional, ours)))

    def _ours(self, processes: list[_ProcessMemory]) -> Iterator[_ProcessMemory]:
        """Yield the processes that belong to the program, of all processes of the system."""
        known = self._belongs
        self._belongs = {
            process.identity: known[process.identity] for process in processes if process.identity in known
        }
        children: dict[int, list[_ProcessMemory]] = {}
        for candidate in processes:
            children.setdefault(candidate.parent, []).append(candidate)
        candidates = [process for process in processes if self._is_ours(process)]
        while candidates:
            candidate = candidates.pop()
            yield candidate
            for child in children.pop(candidate.number, ()):
                if not self._belongs[child.identity]:
                    self._belongs[child.identity] = True
                    candidates.append(child)

    def _is_ours(self, process: _ProcessMemory) -> bool:
        """Whether a process belongs to the program by its group, session or mark; checked once for each process."""
        if process.identity not in self._belongs:
            self._belongs[process.identity] = is_marked(process.number, self._mark)
        if self._leader in {process.group, process.session}:
            self._belongs[process.identity] = True
        return self._belongs[process.identity]


def _all_processes() -> Iterable[_ProcessMemory]:
    """Return all processes of the system."""
    return _by_proc() if os.path.exists("/proc/self/stat") else _by_ps()


def _by_proc() -> Iterator[_ProcessMemory]:
    """Yield the processes that Linux shows in /proc."""
    page = os.sysconf("SC_PAGE_SIZE")
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", "rb") as file:
                stat = file.read()
        except OSError:  # it ended meanwhile, or is hidden
            continue
        fields = stat[stat.rfind(b")") + 2 :].split()  # the name before ")" may hold anything
        parent, group, session, started, pages = (int(fields[place]) for place in (1, 2, 3, 19, 21))
        yield _ProcessMemory(int(name), parent, group, session, started, pages * page)


def _by_ps() -> Iterator[_ProcessMemory]:
    """Yield the processes on systems without /proc, such as macOS; ps counts in KiB."""
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


def _proportional(process: _ProcessMemory) -> int:
    """Return the bytes that a process uses, with its share of shared pages.

    If the share is not known, return all resident bytes.
    """
    proportional = _bytes_in(f"/proc/{process.number}/smaps_rollup", b"Pss:")
    return process.resident if proportional is None else proportional


def _bytes_in(path: str, name: bytes) -> int | None:
    """Return the bytes in a line of a file of /proc, which counts in KiB; None if the system does not report them."""
    try:
        with open(path, "rb") as file:
            return next((int(line.split()[1]) << 10 for line in file if line.startswith(name)), None)
    except OSError:  # the process ended meanwhile, belongs to another user, or the system is too old
        return None
