"""`hypcheck bench --kernel`: every target of the fast path's speed, each a line "kernel" of the record.

The kernels are compared with plain numpy expressions (Table 2 with powers, and with products), with numpy.roots and
FCL, and with one call for one pair. A target that cannot be measured here becomes a line "absent".
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from time import thread_time_ns
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hypcheck
from hypcheck.bench import compiled_targets, tilted_targets
from hypcheck.bench.compiled_targets import TOWER_SIZES, uniform_columns
from hypcheck.bench.timing import (
    Clocked,
    KernelTarget,
    TimingEntry,
    clocked_calls,
    measured_samples,
    rate_text,
    thread_clocked,
    times_as_fast,
)
from hypcheck.errors import UnavailableError
from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.implementations.alternatives import numpy_roots
from hypcheck.implementations.meshes import FCL, SceneMesh, height_of, scene_mesh
from hypcheck.kernel import numpy_kernel
from hypcheck.kernel.choice import choice
from hypcheck.kernel.scalar import exact_position
from hypcheck.record import Recorder
from hypcheck.record.measurements import AbsentLine, KernelLine


def with_powers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> NDArray[np.int8]:
    """Whether each centre is exterior, with `**2` and `**3` as in the paper's formula; it proves nothing."""
    alpha, gamma, b, d = sizes
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    c0 = -A * B
    P, Q = (x**2 + y**2) / b**2, (z / d) ** 2
    c1 = c0 + A - B + B * P - A * Q
    c2 = A - B + 1 - P - Q
    delta = -4 * c2**3 * c0 + (c2 * c1) ** 2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2
    return np.asarray((delta > 0) & (c2 < 0) & (c1 > 0)).view(np.int8)


def with_products(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> NDArray[np.int8]:
    """The same with products instead of powers, which numpy computes by a function of the C library."""
    alpha, gamma, b, d = sizes
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    c0, bb, dd = -A * B, b * b, d * d
    P, Q = (x * x + y * y) / bb, z * z / dd
    c1 = c0 + A - B + B * P - A * Q
    c2 = A - B + 1 - P - Q
    c21 = c2 * c1
    delta = -4 * c2 * c2 * c2 * c0 + c21 * c21 + 18 * c21 * c0 - 4 * c1 * c1 * c1 - 27 * c0 * c0
    return np.asarray((delta > 0) & (c2 < 0) & (c1 > 0)).view(np.int8)


MANY, CALLS, FEW = 10_000_000, 1000, 200
TRIANGLES = 2000
LOOP = "an empty loop over the same calls is taken off"

POWERS = "the numpy expression with ** 2 and ** 3; 1e7 rows"
PRODUCTS = "the numpy expression with products for powers; 1e7 rows"
TARGETS = {
    "numpy, powers": KernelTarget("numpy, powers", f"classify_scene, one thread, against {POWERS}", 30.0),
    "numpy, products": KernelTarget("numpy, products", f"classify_scene, one thread, against {PRODUCTS}", 30.0),
    "fallback, powers": KernelTarget("fallback, powers", f"the numpy kernel against {POWERS}", 8.0),
    "fallback, products": KernelTarget("fallback, products", f"the numpy kernel against {PRODUCTS}", 8.0),
}
ROOTS = KernelTarget("numpy.roots", "classify_scene of 1e5 rows, one thread, against numpy.roots", 1000.0)
FCL_QUERY = KernelTarget(
    "FCL", "classify_scene of 1e5 rows, one thread, against FCL's distance to a mesh built before", 1000.0
)
ONE_CALL = KernelTarget("one pair", "nanoseconds of hypcheck.position from Python", 60.0, at_most=True)
PLAIN_CALL = KernelTarget(
    "one pair, plain Python", "nanoseconds of the same without the compiled kernel", 1500.0, at_most=True
)


def against_numpy(rounds: int) -> Iterator[KernelLine]:
    """Ten million rows: both numpy expressions and both kernels, as a user calls them."""
    columns = uniform_columns(MANY)
    work = {
        "kernel": partial(hypcheck.classify_scene, TOWER_SIZES, *columns, threads=1),
        "fallback": partial(numpy_kernel.positions_of_scene, TOWER_SIZES, *columns),
        "powers": partial(with_powers, TOWER_SIZES, *columns),
        "products": partial(with_products, TOWER_SIZES, *columns),
    }
    if choice().kernel == "numpy":
        del work["kernel"]
    found = measured_samples(
        [TimingEntry(name, MANY, thread_clocked(call), loops=1) for name, call in work.items()], rounds
    )
    for target in TARGETS.values():
        mine, other = target.name.split(", ")
        if (own := found.get("kernel" if mine == "numpy" else mine)) is not None:
            says = f"{rate_text(own)}; the expression: {rate_text(found[other])}"
            yield target.line(times_as_fast(own, found[other]), says)


def against_others(rounds: int) -> Iterator[KernelLine]:
    """numpy.roots and FCL for each row, beside a hundred thousand rows of the kernel."""
    columns = uniform_columns(100_000)
    rows = np.column_stack([*(np.full(FEW, size) for size in TOWER_SIZES), *(column[:FEW] for column in columns)])
    entries = [
        TimingEntry(
            "kernel", 100_000, thread_clocked(partial(hypcheck.classify_scene, TOWER_SIZES, *columns, threads=1))
        ),
        TimingEntry("numpy.roots", FEW, thread_clocked(partial(numpy_roots, rows))),
    ]
    trouble = FCL.trouble()
    if trouble is None:
        mesh = scene_mesh(FCL, "point", TOWER_SIZES, height_of(TOWER_SIZES, rows), TRIANGLES)
        entries.append(TimingEntry("FCL", FEW, _queries(mesh, rows)))
    found = measured_samples(entries, rounds)
    for target in (ROOTS, FCL_QUERY):
        if (other := found.get(target.name)) is not None:
            says = f"{rate_text(found['kernel'])} on {choice().kernel}; {target.name}: {rate_text(other)}"
            yield target.line(times_as_fast(found["kernel"], other), says)


def one_call(rounds: int) -> Iterator[KernelLine]:
    """One pair at a time, from a loop in Python whose own time is subtracted."""
    rows = list(zip(*(column[:CALLS].tolist() for column in _as_columns()), strict=True))
    entries = [
        TimingEntry("empty", CALLS, _loop(None, rows)),
        TimingEntry("plain", CALLS, _loop(exact_position, rows)),
        *([TimingEntry("compiled", CALLS, _loop(hypcheck.position, rows))] if choice().kernel == "compiled" else []),
    ]
    found = measured_samples(entries, 3 * rounds)
    for target, name in ((ONE_CALL, "compiled"), (PLAIN_CALL, "plain")):
        if name in found:
            each = zip(found[name].samples_ns, found["empty"].samples_ns, strict=True)
            net = [mine - empty for mine, empty in each]
            says = f"with the loop {found[name].median_ns:.3g} ns, the loop alone {found['empty'].median_ns:.3g} ns"
            yield target.line(net, f"{says}: {LOOP}")


def _as_columns() -> Sequence[Any]:
    x, y, z = uniform_columns(CALLS)
    return [*(np.full(CALLS, size) for size in TOWER_SIZES), x, y, z]


def _loop(function: Callable[..., int] | None, rows: Sequence[tuple[float, ...]]) -> Clocked:
    def run(repeat: int) -> tuple[int, int]:
        total = 0
        started = thread_time_ns()
        if function is None:
            for _ in range(repeat):
                for alpha, gamma, b, d, x, y, z in rows:  # noqa: B007 - what the others do besides calling
                    pass
        else:
            for _ in range(repeat):
                for alpha, gamma, b, d, x, y, z in rows:
                    function(alpha, gamma, b, d, x, y, z)
        took = thread_time_ns() - started
        if function is not None:
            total = sum(function(*row) for row in rows)
        return took, total

    return run


def _queries(mesh: SceneMesh, rows: Rows) -> Clocked:
    """The engine's queries only, in the units of its mesh."""
    touches, centres = mesh.touches, (rows[:, 4:] / np.array(mesh.unit)).tolist()
    if touches is None:
        raise AssertionError("FCL refused the mesh")

    return clocked_calls(touches, centres, thread_time_ns)


ROUNDS, QUICK_ROUNDS = 15, 7
STREAM, QUICK_STREAM = 1_000_000_000, 100_000_000

Group = Callable[[Path, bool], Iterable[KernelLine]]


def run(recorder: Recorder, advance: Callable[[int], object], quick: bool) -> None:
    """Measure every target and add its line; a quick run has fewer rounds and streams a tenth of the rows."""
    with TemporaryDirectory(prefix="hypcheck-kernel-") as folder:
        for group in _groups():
            try:
                for line in group(Path(folder), quick):
                    recorder.add(line)
            except UnavailableError as error:
                recorder.add(AbsentLine(what="C compiler", reason=str(error)))
            advance(1)
    if choice().kernel != "compiled":
        recorder.add(AbsentLine(what="compiled kernel", reason=choice().reason))
    if (trouble := FCL.trouble()) is not None:
        recorder.add(AbsentLine(what=FCL.title, reason=trouble))


def steps() -> int:
    """The number of times that `run` advances."""
    return len(list(_groups()))


def _groups() -> Iterator[Group]:
    if choice().kernel == "compiled":
        yield lambda folder, quick: compiled_targets.from_memory(folder, _rounds(quick))
        yield lambda folder, quick: compiled_targets.in_cache(folder, _rounds(quick))
        yield lambda folder, quick: compiled_targets.threads_in_cache(folder, _rounds(quick))
        yield lambda _folder, quick: compiled_targets.near_contact(_rounds(quick))
        yield lambda _folder, quick: tilted_targets.one_orientation(_rounds(quick))
        yield lambda _folder, quick: tilted_targets.axis_along_z(_rounds(quick))
        yield lambda _folder, quick: tilted_targets.an_axis_each(_rounds(quick))
        yield lambda _folder, quick: compiled_targets.streamed(QUICK_STREAM if quick else STREAM, 1 if quick else 3)
    yield lambda _folder, quick: against_numpy(3 if quick else 9)
    yield lambda _folder, quick: against_others(_rounds(quick))
    yield lambda _folder, quick: one_call(_rounds(quick))


def _rounds(quick: bool) -> int:
    return QUICK_ROUNDS if quick else ROUNDS
