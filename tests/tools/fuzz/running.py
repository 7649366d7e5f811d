"""Many inputs in processes of their own: hanging ones are killed, memory is limited, and every finding is kept."""

from __future__ import annotations

import ctypes
import fnmatch
import gc
import multiprocessing
import os
import re
import resource
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from pathlib import Path
from random import Random

from tests.tools.fuzz.judging import judged, stop_hangs
from tests.tools.fuzz.mutating import mutated
from tests.tools.fuzz.readers import FAULTY, READERS

ALL = {**READERS, **FAULTY}

BATCH = 200
"""Inputs that a process is given at a time."""

STUCK = 60.0
"""Seconds at one input after which a process is killed: something there cannot be stopped from within."""

MEMORY = 512 << 20
"""Bytes of address space that reading may take beyond what a process has when it begins."""

GROWTH = 48 << 20
"""Bytes by which a process may grow in resident memory between its first inputs and its last."""


@dataclass(frozen=True, slots=True)
class Finding:
    """An input that ended as none may, by its number, and what is wrong."""

    reader: str
    number: int
    says: str
    data: bytes


@dataclass
class Tally:
    """What became of the inputs of all readers, the findings, and the processes' growth in bytes."""

    kinds: dict[str, Counter[str]] = field(default_factory=dict)
    seconds: Counter[str] = field(default_factory=Counter)
    findings: list[Finding] = field(default_factory=list)
    growth: list[int] = field(default_factory=list)

    @property
    def count(self) -> int:
        """Inputs so far."""
        return sum(sum(kinds.values()) for kinds in self.kinds.values())

    @property
    def failed(self) -> bool:
        """Whether anything ended as it may not."""
        return bool(self.findings) or any(growth > GROWTH for growth in self.growth)


def input_of(name: str, seed: int, number: int) -> bytes:
    """The input of that number: the same always."""
    reader = ALL[name]
    random = Random(f"{seed}/{name}/{number}")  # noqa: S311 - nothing secret
    return reader.finish(mutated(random.choice(reader.seeds()), random, reader.seeds()), random)


def batches(count: int, names: tuple[str, ...]) -> Iterator[tuple[str, int, int]]:
    """Which numbers of which reader make up `count` inputs, in the readers' shares, mixed."""
    whole = sum(ALL[name].share for name in names)
    parts = []
    for name in names:
        inputs = max(1, count * ALL[name].share // whole)
        parts += [
            ((start + 0.5) / inputs, name, start, min(inputs, start + BATCH)) for start in range(0, inputs, BATCH)
        ]
    for _, name, start, stop in sorted(parts):
        yield name, start, stop


def run(count: int, seed: int, names: tuple[str, ...], processes: int, tell=lambda _: None, stuck=STUCK) -> Tally:
    """Read that many inputs; `tell` is given the tally after every batch. A process is killed after `stuck` seconds."""
    tally, waiting = Tally({name: Counter() for name in names}), batches(count, names)
    workers = [_Worker(seed, names, stuck) for _ in range(processes)]
    idle = list(workers)
    while True:
        while idle and (batch := next(waiting, None)):
            idle.pop().give(batch)
        busy = [worker for worker in workers if worker.batch]
        if not busy:
            break
        ready = wait([worker.ends for worker in busy], timeout=1.0)
        for worker in busy:
            if worker.ends in ready or worker.stuck:
                worker.take(tally)
                tell(tally)
                idle += [worker] if worker.batch is None else []
    tally.growth += [worker.leave() for worker in workers]
    return tally


class Patience:
    """Knows whether something has stood still for so many seconds, by where it was whenever that was asked."""

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self.renew()

    def renew(self) -> None:
        """It begins something else."""
        self._place, self._since = None, time.monotonic()

    def ends(self, place: int) -> bool:
        """Whether it has stood at this place for too long."""
        if place != self._place:
            self._place, self._since = place, time.monotonic()
        return time.monotonic() > self._since + self._seconds


class _Worker:
    """One process, begun again where it is lost."""

    def __init__(self, seed: int, names: tuple[str, ...], patience: float) -> None:
        self._seed, self._names, self._patience = seed, names, Patience(patience)
        self.batch: tuple[str, int, int] | None = None
        self._begin()

    def _begin(self) -> None:
        context = multiprocessing.get_context("spawn")
        self.ends, theirs = context.Pipe()
        self._at = context.Value("q", -1, lock=False)
        self._process = context.Process(target=_serve, args=(theirs, self._at, self._seed, self._names), daemon=True)
        self._process.start()
        theirs.close()

    def give(self, batch: tuple[str, int, int]) -> None:
        """Let it read a batch."""
        self.batch = batch
        self._patience.renew()
        self.ends.send(batch)

    @property
    def stuck(self) -> bool:
        """Whether it has been at one input for too long."""
        return self._patience.ends(self._at.value)

    def take(self, tally: Tally) -> None:
        """Take what it found; where it is lost, note the input it was lost with and go on behind that."""
        name, _, stop = self.batch or ("", 0, 0)
        try:
            kinds, seconds, findings = self._heard()
        except EOFError:
            number, says = self._lost()
            tally.findings.append(Finding(name, number, says, input_of(name, self._seed, number)))
            self._begin()
            if number + 1 < stop:
                self.give((name, number + 1, stop))
            else:
                self.batch = None
            return
        tally.kinds[name] += kinds
        tally.seconds[name] += seconds
        tally.findings += findings
        self.batch = None

    def _heard(self):
        if self.stuck and not self.ends.poll():
            raise EOFError
        return self.ends.recv()

    def _lost(self) -> tuple[int, str]:
        """The number of the input that it was lost with, and how; it is ended."""
        self._process.join(0 if self.stuck else 5)
        number, code = self._at.value, self._process.exitcode
        self._process.kill()
        self._process.join()
        return number, "hang: it had to be killed" if code is None else f"the process ended with {code}"

    def leave(self) -> int:
        """Let it go; by how many bytes it grew."""
        self.ends.send(None)
        grown = self.ends.recv()
        self._process.join()
        return int(grown)


def _serve(ends: Connection, at, seed: int, names: tuple[str, ...]) -> None:
    stop_hangs()
    _warm(names)
    _bound_memory()
    first = 0
    while batch := ends.recv():
        name, start, stop = batch
        before = time.perf_counter()
        kinds, findings = Counter(), []
        for number in range(start, stop):
            at.value = number
            data = input_of(name, seed, number)
            verdict = judged(ALL[name].read, data, ALL[name].seconds)
            kinds[verdict.kind] += 1
            if verdict.kind == "finding":
                findings.append(Finding(name, number, verdict.says, data))
        ends.send((kinds, time.perf_counter() - before, findings))
        first = first or resident()
    ends.send(resident() - (first or resident()))


def _warm(names: tuple[str, ...]) -> None:
    """Everything that is loaded or computed once is loaded and computed before memory is bounded and measured."""
    for name in set(names) & set(READERS):
        for data in READERS[name].seeds():
            judged(READERS[name].read, data, 60.0)


def _bound_memory() -> None:
    limit = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE") + MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (limit, resource.getrlimit(resource.RLIMIT_AS)[1]))


def resident() -> int:
    """Bytes of this process in memory, but for patterns that Python keeps, and for what was freed and not given back.

    Of that glibc keeps more the longer a process has run, in pieces between those that are used.
    """
    re.purge()
    fnmatch._compile_pattern.cache_clear()
    gc.collect()
    give_back = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if give_back is not None:
        give_back(0)
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
