"""Targets beside hyperboloids that end: what ends cost, and how many rows of each family C leaves open.

Rows are those of the paper's tower between z −17.8 and 17.8, each timed beside the same rows without ends.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from hypcheck.bench.c_library import TOWER_SIZES
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Positions, Rows
from hypcheck.kernel.compiled_kernel import answer_ended, answer_rows, answer_ways
from hypcheck.record.measurements import KernelLine
from hypcheck.runs.timing import KernelTarget, TimingEntry, measured_samples, rate_text, thread_clocked, times_as_long
from hypcheck.vectors.families import ENDED_FAMILIES, ENDED_SWEEP_FAMILIES

SEED = 1
PACED = 20_000
ORDINARY, NEAR = 20_000, 2_000
"""Rows of each ordinary family, and of each family near a rim, a flat end or the wall."""

END = 17.8
FAR_AWAY = 1e4

OPEN = KernelTarget("left open, ordinary", "rows and ways beside ends of families named uniform", 1e-4, at_most=True)
OPEN_NEAR = KernelTarget(
    "left open, near an end", "rows and ways beside ends, the family with most of them", 0.01, at_most=True
)


def paces(rounds: int) -> Iterator[KernelLine]:
    """Rows whose ends are far away, and rows near the rim, upright and tilted."""
    random = np.random.Generator(np.random.PCG64(SEED))
    around = random.uniform((-4, -4, -20), (4, 4, 20), (PACED, 3))
    turn, off = random.uniform(0, 2 * math.pi, PACED), random.uniform(-0.4, 0.4, PACED)
    radius = TOWER_SIZES[0] * math.hypot(1, END / TOWER_SIZES[1]) + off
    level = END + random.uniform(-0.3, 0.3, PACED)
    rim = np.stack([radius * np.cos(turn), radius * np.sin(turn), level], axis=1)
    for kind, axes, width in (
        ("upright", np.tile([0.0, 0.0, 1.0], (PACED, 1)), 7),
        ("tilted", random.uniform(-1, 1, (PACED, 3)), 10),
    ):
        whole = np.ascontiguousarray(_rows(around, axes, FAR_AWAY)[:, :width])
        far, near = _rows(around, axes, FAR_AWAY), _rows(rim, axes, END)
        entries = [
            TimingEntry("whole", PACED, thread_clocked(partial(_answered, whole))),
            TimingEntry("far", PACED, thread_clocked(partial(answer_ended, far, 1))),
            TimingEntry("near", PACED, thread_clocked(partial(answer_ended, near, 1))),
        ]
        found = measured_samples(entries, rounds)
        for name, text, wanted in (("far", "ends far away", 1.3), ("near", "ends near the rim", 6.0)):
            target = KernelTarget(
                f"{text}, {kind}", "a row, to one in the same scene without ends", wanted, at_most=True
            )
            says = f"{rate_text(found[name])}; without ends {rate_text(found['whole'])}"
            yield target.line(times_as_long(found[name], found["whole"]), says)


def _answered(rows: Rows) -> Positions:
    return answer_rows(rows, "position", 1)[0]


def _rows(centres: Floats, axes: Floats, end: float) -> Rows:
    n = len(centres)
    ends = np.tile([-end, end, 0.0], (n, 1))
    return np.ascontiguousarray(np.column_stack([np.tile(TOWER_SIZES, (n, 1)), centres, axes, ends]))


def left_open(_rounds: int) -> Iterator[KernelLine]:
    """How many rows and ways of each family C answers with 2, which Python then decides exactly."""
    counts = {name: _open_share(name) for name in (*ENDED_FAMILIES, *ENDED_SWEEP_FAMILIES)}
    for target, ordinary in ((OPEN, True), (OPEN_NEAR, False)):
        some = {name: share for name, share in counts.items() if name.endswith("uniform") is ordinary}
        n = ORDINARY if ordinary else NEAR
        told = ", ".join(f"{name} {round(share * n)}" for name, share in some.items() if share) or "none of any family"
        yield target.line([max(some.values())], f"of {n:,} of each of {len(some)} families: {told}")


def _open_share(name: str) -> float:
    ways = name in ENDED_SWEEP_FAMILIES
    family = ENDED_SWEEP_FAMILIES[name] if ways else ENDED_FAMILIES[name]
    rows = np.ascontiguousarray(family.rows(SEED, ORDINARY if name.endswith("uniform") else NEAR))
    answers = answer_ways(rows)[0] if ways else answer_ended(rows, 1)
    return float((answers == CANNOT_SAY).mean())
