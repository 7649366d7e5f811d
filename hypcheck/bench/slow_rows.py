"""The slowest row that a search finds: from families that floats leave, moved a little where it made a row slower.

Sizes and coordinates stay within the magnitudes of a scene. Every row is asked SAME times in one call, by the processor
time of this thread.
"""

from __future__ import annotations

from collections.abc import Iterator
from time import thread_time_ns

import numpy as np

import hypcheck
from hypcheck.bench.compiled_targets import SEED, TOWER_SIZES, touching_columns
from hypcheck.bench.timing import KernelTarget
from hypcheck.geometry.rows import Rows
from hypcheck.record.measurements import KernelLine
from hypcheck.vectors.families import FAMILIES

FROM = ("tangent", "osculation", "ring", "ring-neighbourhood", "near-axis", "degenerate-crossing", "small-integers")
EACH, SAME, KEPT, TURNS, NEIGHBOURS = 120, 64, 8, 6, 6
LEAST, MOST = 2.0**-30, 2.0**30
"""Of every size, and of every coordinate but 0."""

SLOWEST = KernelTarget(
    "slowest row", "the slowest row that a search finds, to the median row within 1e-15 of contact", 16.0, at_most=True
)
"""Lengths of a scene have up to 96 bits: that is 16 times the 70 products of limbs that fixed point takes."""


def slowest_row(rounds: int) -> Iterator[KernelLine]:
    """Search, then measure the row that was found beside rows near contact."""
    row = found_row()
    columns = touching_columns(EACH)
    near = np.column_stack([*(np.full(EACH, size) for size in TOWER_SIZES), *columns])
    usual = [float(np.median([cost(each) for each in near])) for _ in range(rounds)]
    slow = [cost(row) for _ in range(rounds)]
    numbers = ", ".join(repr(float(value)) for value in row)
    says = f"{np.median(slow):.4g} ns: {numbers}; the median row near contact: {np.median(usual):.4g} ns"
    yield SLOWEST.line([a / b for a, b in zip(slow, usual, strict=True)], says)


def found_row() -> Rows:
    """The slowest row of the families, and of what came of the slowest ones; the same rows are tried each time."""
    random = np.random.Generator(np.random.PCG64(SEED))
    rows = _of_a_scene(np.concatenate([FAMILIES[name].rows(SEED, EACH) for name in FROM]))
    kept = _slowest(rows)
    for _ in range(TURNS):
        kept = _slowest(_of_a_scene(np.concatenate([kept, *(_moved(random, kept) for _ in range(NEIGHBOURS))])))
    return np.asarray(kept[0])


def cost(row: Rows) -> float:
    """Nanoseconds of the row: the least of three calls, since what disturbs a call makes it longer."""
    rows, out = np.tile(row, (SAME, 1)), np.zeros(SAME, dtype=np.int8)
    took = []
    for _ in range(3):
        started = thread_time_ns()
        hypcheck.classify(rows, out=out, threads=1)
        took.append(thread_time_ns() - started)
    return min(took) / SAME


def _slowest(rows: Rows) -> Rows:
    order = np.argsort([-cost(row) for row in rows], kind="stable")
    return np.asarray(rows[order[:KEPT]])


def _of_a_scene(rows: Rows) -> Rows:
    sizes = np.abs(rows)
    inside = (sizes >= LEAST) & (sizes <= MOST)
    inside[:, 4:] |= rows[:, 4:] == 0
    return np.asarray(rows[inside.all(axis=1)])


def _moved(random: np.random.Generator, rows: Rows) -> Rows:
    """Each row with one number moved by some ulps, or by a power of two if it is a coordinate."""
    moved = rows.copy()
    for row in moved:
        place = int(random.integers(0, 7))
        if place >= 4 and random.integers(0, 2):
            row[place] *= 2.0 ** -int(random.integers(0, 25))
        else:
            row[place] += int(random.integers(-4, 5)) * np.spacing(row[place])
    return moved
