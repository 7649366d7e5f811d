"""The resources of a process: memory, handles, threads, processes, files; and whether any of them grows."""

from __future__ import annotations

import contextlib
import gc
import os
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from statistics import median

SLOPE = 32 << 10
"""Bytes of resident memory that a round may leave behind."""

LEAST = 8 << 20
"""Bytes of growth that are noise of the allocator, however few the rounds."""


@dataclass(frozen=True, slots=True)
class Sample:
    """What this process holds between two rounds. `strays` are processes with our mark and zombies, by command line."""

    resident: int
    handles: int
    threads: int
    children: int
    strays: tuple[str, ...]
    files: tuple[str, ...]


def sample(mark: str, folders: Sequence[Path]) -> Sample:
    """Now; `mark` is in the environment of every process that was started, `folders` are where nothing may be left."""
    gc.collect()
    status = Path("/proc/self/statm").read_text().split()
    children, strays = _processes(mark.encode())
    return Sample(
        resident=int(status[1]) * os.sysconf("SC_PAGE_SIZE"),
        handles=len(os.listdir("/proc/self/fd")),
        threads=len(os.listdir("/proc/self/task")),
        children=children,
        strays=strays,
        files=tuple(sorted(str(path) for folder in folders for path in folder.iterdir())),
    )


def _processes(mark: bytes) -> tuple[int, tuple[str, ...]]:
    """Our living children, and what is marked and neither this process nor a child, or dead and not waited for."""
    children, strays = 0, []
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):  # it may end meanwhile
            state, parent = folder.joinpath("stat").read_text(errors="replace").rpartition(")")[2].split()[:2]
            ours = int(parent) == os.getpid()
            if state == "Z":
                strays += [f"zombie {folder.name}"] if ours else []
            elif ours:
                children += 1
            elif folder.name != str(os.getpid()) and mark in folder.joinpath("environ").read_bytes():
                strays.append(folder.joinpath("cmdline").read_text().replace("\0", " ").strip() or folder.name)
    return children, tuple(sorted(strays))


def growth(values: Sequence[float]) -> float:
    """The growth from one value to the next: the median of all pairs' slopes (Theil, Sen), which outliers leave be."""
    return median((second - first) / (j - i) for (i, first), (j, second) in combinations(enumerate(values), 2))


def faults(samples: Sequence[Sample]) -> list[str]:
    """A sentence for everything that grew or was left; the first quarter of the samples is warming up."""
    kept = samples[len(samples) // 4 :]
    if len(kept) < 3:
        return [f"{len(kept)} samples after warming up; at least 3 are needed to tell"]
    found = []
    slope = growth([each.resident for each in kept])
    allowed = max(SLOPE, LEAST / len(kept))
    if slope > allowed:
        found.append(f"resident memory grows by {slope / 1024:.1f} KiB a round; {allowed / 1024:.1f} are allowed")
    for name in ("handles", "threads", "children"):
        counts = [getattr(each, name) for each in kept]
        if counts[-1] > counts[0] or growth(counts) > 0:
            found.append(f"{name} grow from {counts[0]} to {counts[-1]}, {max(counts)} at most")
    found += [f"left after a round: {stray}" for each in samples for stray in each.strays]
    found += [f"left in a folder: {file}" for file in samples[-1].files]
    return list(dict.fromkeys(found))
