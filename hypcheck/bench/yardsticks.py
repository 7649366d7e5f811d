"""Defines a target of the fast path's speed, and what targets are measured with: rows, the slowest row, and clocks.

targets.toml lists the targets. Each is a ratio to a ceiling that is measured in the same rounds: reading the rows, the
plain formula in C, a product of long integers, an empty call, or another method.

The rows are of one scene, the paper's cooling tower: anywhere, next to contact, and beside the ends of a hyperboloid
that ends. A call from Python is a statement that is repeated; the time of an empty loop is subtracted.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from time import thread_time_ns
from timeit import Timer
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hypcheck
from hypcheck import toml
from hypcheck.bench.c_library import TOWER_SIZES, CBaseline, c_baselines
from hypcheck.bench.workloads import near, tilted_near
from hypcheck.geometry.rows import Columns, Floats, Rows
from hypcheck.kernel.choice import choice
from hypcheck.record.measurements import KernelLine
from hypcheck.runs.timing import (
    Clocked,
    Samples,
    TimingEntry,
    estimate,
    rate_text,
    thread_clocked,
    times_as_fast,
    times_as_long,
)
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.families import FAMILIES
from hypcheck.vectors.random_pairs import Sizes


@dataclass(frozen=True, slots=True)
class KernelTarget:
    """A target: `wanted` is a least number, or a greatest one if `at_most`; `text` describes it.

    The measured number is a ratio to a ceiling. The ceiling is the time of work that no implementation can avoid,
    measured in the same rounds. So the ratio depends on the code, and as little as possible on the machine and on other
    programs. `mine` and `other` name the two among the samples of a group, and `says` is the sentence about them.
    """

    name: str
    text: str
    wanted: float
    at_most: bool = False
    mine: str = ""
    other: str = ""
    says: str = ""

    def line(self, measured: list[float], says: str) -> KernelLine:
        """Return the record's line: the median over rounds, with its 95 % interval.

        Missed means: by the whole interval.
        """
        ratio = estimate([measured])
        met = ratio.low <= self.wanted if self.at_most else ratio.high >= self.wanted
        return KernelLine(
            name=self.name,
            target=self.text,
            wanted=self.wanted,
            measured=ratio.median,
            ci95=(ratio.low, ratio.high),
            met=met,
            says=says,
        )

    def of(self, samples: Mapping[str, Samples]) -> KernelLine:
        """Return the line about how many times as fast mine is as the other.

        As long, if the target is an upper bound.
        """
        mine, other = samples[self.mine], samples[self.other]
        says = self.says.format(
            mine=rate_text(mine),
            other=rate_text(other),
            mine_ns=f"{mine.median_ns:.3g} ns",
            other_ns=f"{other.median_ns:.3g} ns",
            name=other.name,
            samples=samples,
            level=choice().level,
            kernel=choice().kernel,
        )
        return self.line((times_as_long if self.at_most else times_as_fast)(mine, other), says)


def listed() -> dict[str, Any]:
    """Return the content of targets.toml; it must not be changed."""
    return toml.shipped("hypcheck.bench", "targets.toml")


def target(name: str) -> KernelTarget:
    """Return the target of that name; it must be listed in targets.toml."""
    entry = dict(listed()["targets"][name])
    at_most = "at_most" in entry
    return KernelTarget(name, entry.pop("text"), entry.pop("at_most" if at_most else "at_least"), at_most, **entry)


def lines(samples: Mapping[str, Samples], *names: str) -> Iterator[KernelLine]:
    """Return the lines of these targets, which compare two of the samples."""
    return (target(name).of(samples) for name in names)


@dataclass(frozen=True, slots=True)
class Measuring:
    """How a run measures its targets: the folder for what it compiles, and whether it is quick."""

    folder: Path
    quick: bool

    @property
    def rounds(self) -> int:
        """The number of rounds of most groups; where a round is short, three times as many."""
        return QUICK_ROUNDS if self.quick else ROUNDS

    @property
    def baselines(self) -> list[CBaseline]:
        """The compiled programs in C. Raises UnavailableError if there is no compiler."""
        return c_baselines(self.folder)


ROUNDS, QUICK_ROUNDS = 15, 7


SEED = 1


DISTINCT = 1_000_000
"""The number of different rows. A longer array repeats them, because to draw ten million takes longer than to measure
them."""


def uniform_columns(count: int) -> Columns:
    """Return centres uniform in the box |x|, |y| ≤ 4 m, |z| ≤ 17.8 m about the tower (the workload "uniform")."""
    rows = FAMILIES["tower-body"].rows(SEED, min(count, DISTINCT))
    x, y, z = (np.resize(column, count) for column in rows[:, 4:].T)
    return x, y, z


TOUCHING = (-52, -50)
"""The exponents of distances of touching rows from contact: 2e-16 to 2e-15 radii, before numbers are rounded."""


def _towers(count: int) -> Floats:
    """Return the sizes of the scene in each of `count` rows."""
    return np.tile(TOWER_SIZES, (count, 1))


def touching_columns(count: int) -> Columns:
    """Return centres within about 1e-15 radii of contact, on both sides of the wall and all over it."""
    x, y, z = near(Draw("bench-touching", 1, SEED), Sizes(*_towers(count).T), TOUCHING)[:, 4:].T
    return np.ascontiguousarray(x), np.ascontiguousarray(y), np.ascontiguousarray(z)


def tower_rows(columns: Columns) -> Rows:
    """Return the rows (n, 7) of these centres in the scene of TOWER_SIZES."""
    return np.column_stack([*(np.full(len(columns[0]), size) for size in TOWER_SIZES), *columns])


def axes(count: int) -> Floats:
    """Return axes in all directions, (n, 3)."""
    return np.random.Generator(np.random.PCG64(SEED)).normal(size=(count, 3))


def touching_rows(count: int) -> Rows:
    """Return rows of the tower's body tilted in all directions, within about 1e-15 radii of contact: (n, 10)."""
    x, y, z = axes(count).T
    return tilted_near(Draw("bench-touching", 1, SEED), _towers(count), (x, y, z), TOUCHING)


END = 17.8


FAR_AWAY = 1e4
"""Heights at which the tower ends, in metres: near rows at its rim, and far from all rows."""


def ended_rows(count: int) -> dict[str, tuple[Rows, Rows, Rows]]:
    """Return rows upright and tilted: without ends, with ends that are far away, and near the rim of ends."""
    random = np.random.Generator(np.random.PCG64(SEED))
    around = random.uniform((-4, -4, -20), (4, 4, 20), (count, 3))
    turn, off = random.uniform(0, 2 * math.pi, count), random.uniform(-0.4, 0.4, count)
    radius = TOWER_SIZES[0] * math.hypot(1, END / TOWER_SIZES[1]) + off
    level = END + random.uniform(-0.3, 0.3, count)
    rim = np.stack([radius * np.cos(turn), radius * np.sin(turn), level], axis=1)
    kinds = {"upright": (np.tile([0.0, 0.0, 1.0], (count, 1)), 7), "tilted": (random.uniform(-1, 1, (count, 3)), 10)}
    return {
        kind: (np.ascontiguousarray(far[:, :width]), far, _with_ends(rim, axes, END))
        for kind, (axes, width) in kinds.items()
        for far in [_with_ends(around, axes, FAR_AWAY)]
    }


def _with_ends(centres: Floats, axes: Floats, end: float) -> Rows:
    """Return rows (n, 13) of the open tower between the heights ±`end`."""
    n = len(centres)
    ends = np.tile([-end, end, 0.0], (n, 1))
    return np.ascontiguousarray(np.column_stack([np.tile(TOWER_SIZES, (n, 1)), centres, axes, ends]))


SLOW_FAMILIES = (
    "tangent",
    "osculation",
    "ring",
    "ring-neighbourhood",
    "near-axis",
    "degenerate-crossing",
    "small-integers",
)


EACH, SAME, KEPT, TURNS, NEIGHBOURS = 120, 64, 8, 6, 6
"""The families that floats leave, and how they are searched: slow rows are moved a little, and kept if slower."""


def found_row() -> Rows:
    """Return the slowest row among the families and the rows derived from their slowest.

    The same rows are tried each time.
    """
    random = np.random.Generator(np.random.PCG64(SEED))
    rows = _of_a_scene(np.concatenate([FAMILIES[name].rows(SEED, EACH) for name in SLOW_FAMILIES]))
    slowest = _slowest(rows)
    for _ in range(TURNS):
        slowest = _slowest(
            _of_a_scene(np.concatenate([slowest, *(_moved(random, slowest) for _ in range(NEIGHBOURS))]))
        )
    return np.asarray(slowest[0])


def cost(row: Rows) -> float:
    """Return the nanoseconds per row of a call with this row SAME times: the least of three calls."""
    rows, out = np.tile(row, (SAME, 1)), np.zeros(SAME, dtype=np.int8)
    took = []
    for _ in range(3):
        started = thread_time_ns()
        hypcheck.classify(rows, out=out, threads=1)
        took.append(thread_time_ns() - started)
    return min(took) / SAME


def _slowest(rows: Rows) -> Rows:
    """Return the slowest of these rows, KEPT at most, the slowest first."""
    order = np.argsort([-cost(row) for row in rows], kind="stable")
    return np.asarray(rows[order[:KEPT]])


def _of_a_scene(rows: Rows) -> Rows:
    """Return the rows whose sizes and nonzero coordinates are within the magnitudes of a scene."""
    sizes = np.abs(rows)
    inside = (sizes >= 2.0**-30) & (sizes <= 2.0**30)
    inside[:, 4:] |= rows[:, 4:] == 0
    return np.asarray(rows[inside.all(axis=1)])


def _moved(random: np.random.Generator, rows: Rows) -> Rows:
    """Return each row with one number moved by some ulps, or by a power of two if it is a coordinate."""
    moved = rows.copy()
    for row in moved:
        place = int(random.integers(0, 7))
        if place >= 4 and random.integers(0, 2):
            row[place] *= 2.0 ** -int(random.integers(0, 25))
        else:
            row[place] += int(random.integers(-4, 5)) * np.spacing(row[place])
    return moved


def threaded(count: int, calls: Mapping[str, Callable[[], NDArray[np.signedinteger]]]) -> list[TimingEntry]:
    """Return calls by name that answer `count` rows each, timed by the processor time of this thread."""
    return [TimingEntry(name, count, thread_clocked(call)) for name, call in calls.items()]


def statement(text: str, **names: object) -> Clocked:
    """Return a Python statement with these names, repeated the requested number of times; it has no sum."""
    bound = "; ".join(f"{name} = values[{name!r}]" for name in names)
    timer = Timer(text, bound or "pass", thread_time_ns, {"values": names})
    return lambda repeat: (int(timer.timeit(repeat)), 0)


def without_loop(samples: Mapping[str, Samples]) -> dict[str, Samples]:
    """Return the samples, without the time of the empty loop in the same round."""
    loop = samples["loop"].samples_ns
    return {
        name: replace(timed, samples_ns=[took - empty for took, empty in zip(timed.samples_ns, loop, strict=True)])
        for name, timed in samples.items()
    }
