"""How much a process grows while a method answers a batch: each in a process of its own."""

from __future__ import annotations

import ctypes
import gc
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from hypcheck.bench.accuracy import timed_rows
from hypcheck.bench.contenders import contenders
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.processes import one_each
from hypcheck.record.measurements import Memory

ON = "uniform"


def lines(plan: BenchPlan, names: Sequence[str]) -> Iterator[Memory]:
    """A line for each of the methods, as they come."""
    for _, line in one_each(_line, [(plan, name) for name in names], plan.workers):
        yield line


def _line(task: tuple[BenchPlan, str]) -> Memory:
    plan, name = task
    contender = contenders(plan)[name]
    rows = timed_rows(plan, contender, WORKLOADS[ON])
    first = contender.load()
    first.answer(rows[:1])  # what is loaded when it is called for the first time is no part of answering
    first.close()
    way = contender.load()
    before = forget_peak()
    ready = way.batch(rows)
    if ready is not None:
        ready.answers()
    grown = peak() - before
    way.close()
    return Memory(method=name, rows=len(rows), peak_bytes=max(0, grown))


def forget_peak() -> int:
    """The peak from now on, which is what is resident now where the system lets go of it (Linux).

    What was freed goes back to the system first: answers that are put where something else was do not show.
    """
    gc.collect()
    with suppress(OSError, AttributeError, TypeError):
        ctypes.CDLL(None).malloc_trim(0)
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    return peak()


def peak() -> int:
    """The largest resident size so far, in bytes."""
    with suppress(OSError, StopIteration):
        status = Path("/proc/self/status").read_text(encoding="ascii", errors="replace").splitlines()
        words = next(line for line in status if line.startswith("VmHWM:")).split()
        return int(words[1]) * 1024
    import resource  # noqa: PLC0415 - not on Windows, nor needed on Linux

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
