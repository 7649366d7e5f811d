"""Targets of the calls from Python: beside the C function they call, and beside functions that do nothing.

A call cannot be cheaper than one of an empty C function, nor one with arrays cheaper than an empty C function that
takes these arrays and gives them back. Batches are compared with both together: the C function about the same rows,
called in C, and one empty call; without out= also the making of an array. One pair in plain Python is compared with the
plain formula in plain Python, which proves nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from time import thread_time_ns

import numpy as np

import hypcheck
from hypcheck.bench.compiled_targets import TOWER_SIZES, c_baselines, uniform_columns
from hypcheck.bench.timing import (
    Clocked,
    KernelTarget,
    TimingEntry,
    measured_samples,
    rate_text,
    thread_clocked,
)
from hypcheck.geometry.rows import Columns, Positions
from hypcheck.kernel.choice import choice
from hypcheck.kernel.compiled_kernel import extension
from hypcheck.kernel.scalar import exact_position
from hypcheck.record.measurements import KernelLine

CALLS, TEN = 1000, 10
BATCHES, MANY = (1_000, 10_000, 100_000), 10_000_000
WANTED = {1_000: 0.7, 10_000: 0.85}
"""Of batches so small that setting the interpreter free and looking at the arguments shows."""

LOOP = "an empty loop over the same calls is taken off"

ONE_CALL = KernelTarget("one pair", "hypcheck.position, to an empty C call of seven floats", 2.0, at_most=True)
PLAIN_CALL = KernelTarget(
    "one pair, plain Python",
    "hypcheck.position without the compiled kernel, to Table 2 in plain Python, uncertified",
    2.6,
    at_most=True,
)
TEN_CENTRES = KernelTarget(
    "ten centres", "classify_scene, to an empty C call that takes the same arrays", 5.0, at_most=True
)
TEN_IN_PLACE = KernelTarget(
    "ten centres, out=", "classify_scene with out=, to an empty C call that takes the same arrays", 5.0, at_most=True
)

_BATCH = "one thread, of the speed of the C function and one empty call{made}; {count:.0e} rows"


def _batch_targets(count: int) -> dict[str, KernelTarget]:
    says = {made: _BATCH.format(count=count, made=made).replace("e+0", "e") for made in ("", " and one new array")}
    return {
        work: KernelTarget(
            f"{name}, {count:.0e}".replace("e+0", "e"),
            f"{call}, {says['' if work.endswith('place') else ' and one new array']}",
            WANTED.get(count, 0.95),
        )
        for work, name, call in (
            ("fresh", "batch", "classify_scene"),
            ("in place", "batch, out=", "classify_scene with out="),
            ("rows", "batch of rows", "classify of rows (n, 7)"),
            ("rows in place", "batch of rows, out=", "classify of rows (n, 7) with out="),
        )
    }


def batches(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Batches that stay in the cache."""
    for count in BATCHES:
        yield from _batch(folder, count, 3 * rounds)


def large_batches(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """A batch from memory; what the first touch of a new array costs there is said beside it."""
    yield from _batch(folder, MANY, rounds, with_rows=False)


def _batch(folder: Path, count: int, rounds: int, *, with_rows: bool = True) -> Iterator[KernelLine]:
    columns, out = uniform_columns(count), np.zeros(count, dtype=np.int8)
    library, sizes = c_baselines(folder, str(choice().level))[0], np.array(TOWER_SIZES)
    most = {"threads": 1} if count == MANY else {}
    scene = partial(hypcheck.classify_scene, TOWER_SIZES, *columns)
    entries = [
        TimingEntry("in C", count, _in_c(library.of_scene(sizes, *columns, out), out)),
        TimingEntry("fresh", count, thread_clocked(partial(scene, **most))),
        TimingEntry("in place", count, thread_clocked(partial(scene, out, **most))),
        TimingEntry("array", 1, _repeated(partial(np.empty, count, np.dtype(np.int8)))),
        TimingEntry("empty", 1, _repeated(partial(extension().take, TOWER_SIZES, *columns, out))),
        TimingEntry("first touch", count, _repeated(partial(_touched, count))),
    ]
    if with_rows:
        rows = np.column_stack([*(np.full(count, size) for size in TOWER_SIZES), *columns])
        entries += [
            TimingEntry("rows in C", count, _in_c(library.of_rows(rows, out), out)),
            TimingEntry("rows", count, thread_clocked(partial(hypcheck.classify, rows))),
            TimingEntry("rows in place", count, thread_clocked(partial(hypcheck.classify, rows, out=out))),
        ]
    found = measured_samples(entries, rounds)
    for work, target in _batch_targets(count).items():
        if work in found:
            least = found["rows in C" if work.startswith("rows") else "in C"]
            made = found["array"].samples_ns if work in ("fresh", "rows") else [0.0] * len(least.samples_ns)
            each = zip(found[work].samples_ns, least.samples_ns, found["empty"].samples_ns, made, strict=True)
            says = (
                f"{rate_text(found[work])}; in C: {rate_text(least)}; an empty call: {found['empty'].median_ns:.3g} ns"
                f"; a new array: {found['array'].median_ns:.3g} ns,"
                f" with its first touch: {found['first touch'].median_ns:.3g} ns a row"
            )
            yield target.line([(in_c + (empty + array) / count) / mine for mine, in_c, empty, array in each], says)


def _touched(count: int) -> None:
    """A new array whose memory is written once: what a call without out= cannot do without."""
    np.empty(count, dtype=np.int8).fill(1)


def _in_c(work: Callable[[int], None], out: Positions) -> Clocked:
    def run(repeat: int) -> tuple[int, int]:
        started = thread_time_ns()
        work(repeat)
        return thread_time_ns() - started, int(out.sum(dtype=np.int64))

    return run


def _repeated(call: Callable[[], object]) -> Clocked:
    def run(repeat: int) -> tuple[int, int]:
        started = thread_time_ns()
        for _ in range(repeat):
            call()
        return thread_time_ns() - started, 0

    return run


def ten_centres(rounds: int) -> Iterator[KernelLine]:
    """A batch so small that its cost is that of a call."""
    x, y, z = uniform_columns(TEN)
    out = np.empty(TEN, dtype=np.int8)
    take, nothing = extension().take, extension().nothing
    entries = [
        TimingEntry("loop", 1, _scene_loop(None, x, y, z)),
        TimingEntry("nothing", 1, _scene_loop(nothing, x, y, z)),
        TimingEntry("take", 1, _scene_loop(take, x, y, z, None)),
        TimingEntry("take out", 1, _scene_loop(take, x, y, z, out)),
        TimingEntry("fresh", 1, _scene_loop(hypcheck.classify_scene, x, y, z)),
        TimingEntry("in place", 1, _scene_loop(hypcheck.classify_scene, x, y, z, out)),
    ]
    found = measured_samples(entries, 3 * rounds)
    net = {name: _net(each.samples_ns, found["loop"].samples_ns) for name, each in found.items() if name != "loop"}
    for target, name, least in ((TEN_CENTRES, "fresh", "take"), (TEN_IN_PLACE, "in place", "take out")):
        says = (
            f"{np.median(net[name]):.3g} ns; an empty call that takes the arrays {np.median(net[least]):.3g} ns, one "
            f"that does not look at them {np.median(net['nothing']):.3g} ns: {LOOP}"
        )
        yield target.line(_ratios(net[name], net[least]), says)


def _scene_loop(function: Callable[..., object] | None, x: object, y: object, z: object, *out: object) -> Clocked:
    """Calls with the sizes and these arrays, CALLS at a time."""

    def run(repeat: int) -> tuple[int, int]:
        sizes, times = TOWER_SIZES, repeat
        started = thread_time_ns()
        if function is None:
            for _ in range(times):
                pass
        elif out:
            (into,) = out
            for _ in range(times):
                function(sizes, x, y, z, into)
        else:
            for _ in range(times):
                function(sizes, x, y, z)
        return thread_time_ns() - started, 0

    return run


def _net(samples: Sequence[float], empty: Sequence[float]) -> list[float]:
    return [mine - loop for mine, loop in zip(samples, empty, strict=True)]


def _ratios(mine: Sequence[float], other: Sequence[float]) -> list[float]:
    return [one / two for one, two in zip(mine, other, strict=True)]


def textbook(alpha: float, gamma: float, b: float, d: float, x: float, y: float, z: float) -> int:
    """Table 2 in plain Python, 1 for exterior: the coefficients and the discriminant, with no bound of an error."""
    a, c, p, q, r = alpha / b, gamma / d, x / b, y / b, z / d
    A, B, P, Q = a * a, c * c, p * p + q * q, r * r
    AB = A * B
    c1 = A - B - AB + B * P - A * Q
    c2 = A - B + 1.0 - P - Q
    h1, h2, h3 = c2 * c2 - 3.0 * c1, c2 * c1 + 9.0 * AB, c1 * c1 + 3.0 * AB * c2
    delta_3 = 4.0 * h1 * h3 - h2 * h2
    if delta_3 > 0.0 and c2 < 0.0 and c1 > 0.0:
        return 1
    return 0


def one_call(rounds: int) -> Iterator[KernelLine]:
    """One pair at a time, from a loop in Python whose own time is subtracted."""
    rows = list(zip(*(column.tolist() for column in _columns()), strict=True))
    work: dict[str, Callable[..., object] | None] = {"loop": None, "plain": exact_position, "textbook": textbook}
    if choice().kernel == "compiled":
        work |= {"position": hypcheck.position, "nothing": extension().nothing}
    found = measured_samples([TimingEntry(name, CALLS, _loop(each, rows)) for name, each in work.items()], 3 * rounds)
    net = {name: _net(each.samples_ns, found["loop"].samples_ns) for name, each in found.items() if name != "loop"}
    for target, name, least in ((ONE_CALL, "position", "nothing"), (PLAIN_CALL, "plain", "textbook")):
        if name in net:
            says = f"{np.median(net[name]):.3g} ns, {least} {np.median(net[least]):.3g} ns: {LOOP}"
            yield target.line(_ratios(net[name], net[least]), says)


def _columns() -> Columns | Sequence[np.ndarray]:
    return [*(np.full(CALLS, size) for size in TOWER_SIZES), *uniform_columns(CALLS)]


def _loop(function: Callable[..., object] | None, rows: Sequence[tuple[float, ...]]) -> Clocked:
    def run(repeat: int) -> tuple[int, int]:
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
        answers = () if function is None else (function(*row) for row in rows)
        return took, sum(each for each in answers if isinstance(each, int))

    return run
