"""Targets of the kernel for spheroids that lean: against the upright kernel, and against numpy.linalg.eigh.

The rows are those of the other targets, about the paper's tower, with axes in all directions. All is measured as one
calls it from Python, with one thread.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np

import hypcheck
from hypcheck.bench.compiled_targets import SEED, TOWER_SIZES, WORDS, c_baselines, uniform_columns
from hypcheck.bench.timing import (
    KernelTarget,
    TimingEntry,
    measured_samples,
    rate_text,
    thread_clocked,
    times_as_fast,
    times_as_long,
)
from hypcheck.geometry.rows import Floats, Rows, tilted_rows
from hypcheck.implementations.alternatives import by_eigenvectors
from hypcheck.kernel.choice import choice
from hypcheck.record.measurements import KernelLine

MANY, CACHED, FEW, WORST = 10_000_000, 100_000, 20_000, 20_000
AXIS = (0.3, 0.1, 0.9)

ONE_AXIS = KernelTarget(
    "one orientation", "classify_scene with an axis, of the speed of the upright one; 1e7 rows", 0.5
)
ONE_AXIS_CACHED = KernelTarget(
    "one orientation, in cache", "classify_scene with an axis, of the speed of the upright one; 1e5 rows", 0.5
)
UPRIGHT = KernelTarget(
    "axis along z",
    "classify of rows (n, 10) with the axis 0, 0, 1, of the speed per byte of rows (n, 7); 1e5 rows",
    0.9,
)
EIGH = KernelTarget(
    "numpy.linalg.eigh",
    "classify of rows (n, 10) with an axis each, against the dual function in numpy; 1e5 rows",
    30.0,
)
TOUCHING = KernelTarget(
    "near contact, leaning",
    f"a leaning row within 1e-15 of contact, in products of integers of {32 * WORDS} bits",
    12.0,
    at_most=True,
)
_TURNS = 30
"""Bisections of numpy's version: enough away from contact, and fewer than it would need there."""


def axes(count: int) -> Floats:
    """Axes in all directions, (n, 3)."""
    return np.random.Generator(np.random.PCG64(SEED)).normal(size=(count, 3))


def touching_rows(count: int) -> Rows:
    """Rows of the tower's body leaning in all directions, within about 1e-15 radii of contact: (n, 10)."""
    random = np.random.Generator(np.random.PCG64(SEED))
    alpha, gamma, b, d = TOWER_SIZES
    turn, height = 2 * np.pi * random.random(count), (2 * random.random(count) - 1) * gamma
    radius = alpha * np.sqrt(1 + (height / gamma) ** 2)
    point = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])
    normal = point * [alpha**-2, alpha**-2, -(gamma**-2)]
    axis = axes(count)
    along = (axis * normal).sum(axis=1, keepdims=True) / (axis * axis).sum(axis=1, keepdims=True) * axis
    way = b * b * (normal - along) + d * d * along
    side = np.where(random.random(count) < 0.5, -1.0, 1.0) * (1 + (2 * random.random(count) - 1) * 1e-15)
    centre = point + (side / np.sqrt((way * normal).sum(axis=1)))[:, None] * way
    return tilted_rows(TOWER_SIZES, (centre[:, 0], centre[:, 1], centre[:, 2]), (*axis.T,))


def one_orientation(rounds: int) -> Iterator[KernelLine]:
    """A scene with an axis beside the same one without."""
    for target, count, more in ((ONE_AXIS, MANY, 1), (ONE_AXIS_CACHED, CACHED, 3)):
        ask = partial(hypcheck.classify_scene, TOWER_SIZES, *uniform_columns(count), threads=1)
        entries = [
            TimingEntry("upright", count, thread_clocked(ask)),
            TimingEntry("leaning", count, thread_clocked(partial(ask, axis=AXIS))),
        ]
        found = measured_samples(entries, more * rounds)
        says = f"{rate_text(found['leaning'])}; upright: {rate_text(found['upright'])}"
        yield target.line(times_as_fast(found["leaning"], found["upright"]), says)


def axis_along_z(rounds: int) -> Iterator[KernelLine]:
    """Rows of ten that are upright beside the same rows of seven."""
    ten = tilted_rows(TOWER_SIZES, uniform_columns(CACHED), (0.0, 0.0, 1.0))
    seven = np.ascontiguousarray(ten[:, :7])
    entries = [
        TimingEntry(name, CACHED, thread_clocked(partial(hypcheck.classify, rows, threads=1)))
        for name, rows in (("seven", seven), ("ten", ten))
    ]
    found = measured_samples(entries, 3 * rounds)
    ratios = [each * ten.shape[1] / seven.shape[1] for each in times_as_fast(found["ten"], found["seven"])]
    yield UPRIGHT.line(ratios, f"{rate_text(found['ten'])}; rows of seven: {rate_text(found['seven'])}")


def an_axis_each(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Rows with an axis each, beside numpy; and rows near contact, beside what integers cost."""
    rows = tilted_rows(TOWER_SIZES, uniform_columns(CACHED), (*axes(CACHED).T,))
    entries = [
        TimingEntry("rows", CACHED, thread_clocked(partial(hypcheck.classify, rows, threads=1))),
        TimingEntry("eigh", FEW, thread_clocked(partial(by_eigenvectors, rows[:FEW], _TURNS))),
        TimingEntry("touching", WORST, thread_clocked(partial(hypcheck.classify, touching_rows(WORST), threads=1))),
        TimingEntry("product", 1, c_baselines(folder, str(choice().level))[0].product()),
    ]
    found = measured_samples(entries, rounds)
    says = f"{rate_text(found['rows'])}; numpy: {rate_text(found['eigh'])}"
    yield EIGH.line(times_as_fast(found["rows"], found["eigh"]), says)
    says = f"{rate_text(found['touching'])}; a product: {found['product'].median_ns:.3g} ns"
    yield TOUCHING.line(times_as_long(found["touching"], found["product"]), says)
