"""What Python sees: the kernels against numpy expressions, numpy.roots and FCL, and one call about one pair."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from time import thread_time_ns
from typing import Any

import numpy as np

import hypcheck
from hypcheck.bench.kernel.expressions import with_powers, with_products
from hypcheck.bench.kernel.rows import SIZES, uniform
from hypcheck.bench.kernel.target import Target, measured, rate, times_as_fast, worked
from hypcheck.bench.rounds import Clocked, Entry, clocked_calls
from hypcheck.kernel import numpy_path
from hypcheck.kernel.choice import choice
from hypcheck.kernel.scalar import exact_position
from hypcheck.methods.engines import FCL
from hypcheck.methods.roots import by_numpy
from hypcheck.methods.scene_mesh import SceneMesh, built, height_of
from hypcheck.record.measurements import Kernel
from hypcheck.rows import Rows

MANY, CALLS, FEW = 10_000_000, 1000, 200
TRIANGLES = 2000
LOOP = "an empty loop over the same calls is taken off"

POWERS = "the numpy expression with ** 2 and ** 3; 1e7 rows"
PRODUCTS = "the numpy expression with products for powers; 1e7 rows"
TARGETS = {
    "numpy, powers": Target("numpy, powers", f"classify_scene, one thread, against {POWERS}", 30.0),
    "numpy, products": Target("numpy, products", f"classify_scene, one thread, against {PRODUCTS}", 30.0),
    "fallback, powers": Target("fallback, powers", f"the numpy kernel against {POWERS}", 8.0),
    "fallback, products": Target("fallback, products", f"the numpy kernel against {PRODUCTS}", 8.0),
}
ROOTS = Target("numpy.roots", "classify_scene of 1e5 rows, one thread, against numpy.roots", 1000.0)
FCL_QUERY = Target(
    "FCL", "classify_scene of 1e5 rows, one thread, against FCL's distance to a mesh built before", 1000.0
)
ONE_CALL = Target("one pair", "nanoseconds of hypcheck.position from Python", 60.0, at_most=True)
PLAIN_CALL = Target(
    "one pair, plain Python", "nanoseconds of the same without the compiled kernel", 1500.0, at_most=True
)


def against_numpy(rounds: int) -> Iterator[Kernel]:
    """Ten million rows: both numpy expressions and both kernels, as one calls them."""
    columns = uniform(MANY)
    work = {
        "kernel": partial(hypcheck.classify_scene, SIZES, *columns, threads=1),
        "fallback": partial(numpy_path.positions_of_scene, SIZES, *columns),
        "powers": partial(with_powers, SIZES, *columns),
        "products": partial(with_products, SIZES, *columns),
    }
    if choice().kernel == "numpy":
        del work["kernel"]
    found = measured([Entry(name, MANY, worked(call), loops=1) for name, call in work.items()], rounds)
    for target in TARGETS.values():
        mine, other = target.name.split(", ")
        if (own := found.get("kernel" if mine == "numpy" else mine)) is not None:
            says = f"{rate(own)}; the expression: {rate(found[other])}"
            yield target.line(times_as_fast(own, found[other]), says)


def against_others(rounds: int) -> Iterator[Kernel]:
    """numpy.roots and FCL a row, beside a hundred thousand rows of the kernel."""
    columns = uniform(100_000)
    rows = np.column_stack([*(np.full(FEW, size) for size in SIZES), *(column[:FEW] for column in columns)])
    entries = [
        Entry("kernel", 100_000, worked(partial(hypcheck.classify_scene, SIZES, *columns, threads=1))),
        Entry("numpy.roots", FEW, worked(partial(by_numpy, rows))),
    ]
    trouble = FCL.trouble()
    if trouble is None:
        mesh = built(FCL, "point", SIZES, height_of(SIZES, rows), TRIANGLES)
        entries.append(Entry("FCL", FEW, _queries(mesh, rows)))
    found = measured(entries, rounds)
    for target in (ROOTS, FCL_QUERY):
        if (other := found.get(target.name)) is not None:
            says = f"{rate(found['kernel'])} on {choice().kernel}; {target.name}: {rate(other)}"
            yield target.line(times_as_fast(found["kernel"], other), says)


def one_call(rounds: int) -> Iterator[Kernel]:
    """One pair at a time, from a loop in Python whose own time is taken off."""
    rows = list(zip(*(column[:CALLS].tolist() for column in _as_columns()), strict=True))
    entries = [
        Entry("empty", CALLS, _loop(None, rows)),
        Entry("plain", CALLS, _loop(exact_position, rows)),
        *([Entry("compiled", CALLS, _loop(hypcheck.position, rows))] if choice().kernel == "compiled" else []),
    ]
    found = measured(entries, 3 * rounds)
    for target, name in ((ONE_CALL, "compiled"), (PLAIN_CALL, "plain")):
        if name in found:
            each = zip(found[name].samples_ns, found["empty"].samples_ns, strict=True)
            net = [mine - empty for mine, empty in each]
            says = f"with the loop {found[name].median_ns:.3g} ns, the loop alone {found['empty'].median_ns:.3g} ns"
            yield target.line(net, f"{says}: {LOOP}")


def _as_columns() -> Sequence[Any]:
    x, y, z = uniform(CALLS)
    return [*(np.full(CALLS, size) for size in SIZES), x, y, z]


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
    """The engine's queries alone, in the units of its mesh."""
    touches, centres = mesh.touches, (rows[:, 4:] / np.array(mesh.unit)).tolist()
    if touches is None:
        raise AssertionError("FCL refused the mesh")

    return clocked_calls(touches, centres, thread_time_ns)
