"""Targets of the calls from Python: compared with the C function that they call, and with functions that do nothing.

A call cannot be cheaper than a call of an empty C function. A call with arrays cannot be cheaper than an empty C
function that takes these arrays and returns them. Batches are compared with the sum of two times: the C function on the
same rows, called from C, and one empty call; without out= also the allocation of an array. One pair in plain Python is
compared with the plain formula in plain Python, which is not certified.

No form of a call's arguments may cost much more than contiguous float64 arrays. Users have whole numbers, numpy
scalars, lists, float32, columns of an array of points, rows in Fortran order, or an axis for each row. Each form is
timed together with the cheapest form of the same question, in the same rounds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from time import thread_time_ns
from timeit import Timer

import numpy as np

import hypcheck
from hypcheck.bench import compiled_targets
from hypcheck.bench.c_library import TOWER_SIZES, c_baselines
from hypcheck.bench.compiled_targets import (
    Form,
    KernelTarget,
    forms,
    most_times,
    target,
    tower_rows,
    uniform_columns,
)
from hypcheck.geometry.rows import Floats, Positions, tilted_rows
from hypcheck.kernel.choice import choice
from hypcheck.kernel.compiled_kernel import extension
from hypcheck.kernel.scalar import exact_position
from hypcheck.record.measurements import KernelLine
from hypcheck.runs import timing

CALLS, TEN = 1000, 10
BATCHES, MANY = (1_000, 10_000, 100_000), 10_000_000
LOOP = "an empty loop over the same calls is taken off"

BATCH_TARGETS = {
    "fresh": "batch",
    "in place": "batch, out=",
    "rows": "batch of rows",
    "rows in place": "batch of rows, out=",
}
"""The targets of a batch, by what is called: each is listed for each number of rows."""


def batches(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Targets of batches that stay in the cache."""
    for count in BATCHES:
        yield from batch(folder, count, 3 * rounds)


def batch(folder: Path, count: int, rounds: int) -> Iterator[KernelLine]:
    """Targets of a batch, with the cost of a new array's first access. MANY rows come from memory, only as a scene."""
    columns, out = uniform_columns(count), np.zeros(count, dtype=np.int8)
    library, large = c_baselines(folder)[0], count == MANY
    scene = partial(hypcheck.classify_scene, TOWER_SIZES, *columns, threads=1 if large else None)
    take, new = partial(extension().take, TOWER_SIZES, *columns, out), partial(np.empty, count, np.dtype(np.int8))
    entries = [
        timing.TimingEntry("in C", count, timing.clocked_in_c(library.of_scene(columns, out), out, thread_time_ns)),
        timing.TimingEntry("fresh", count, timing.thread_clocked(scene)),
        timing.TimingEntry("in place", count, timing.thread_clocked(partial(scene, out))),
        timing.TimingEntry("array", 1, statement("new()", new=new)),
        timing.TimingEntry("empty", 1, statement("take()", take=take)),
        timing.TimingEntry("first touch", count, statement("new().fill(1)", new=new)),
    ]
    if not large:
        rows = tower_rows(columns)
        entries += [
            timing.TimingEntry(
                "rows in C", count, timing.clocked_in_c(library.of_rows(rows, out), out, thread_time_ns)
            ),
            timing.TimingEntry("rows", count, timing.thread_clocked(partial(hypcheck.classify, rows))),
            timing.TimingEntry(
                "rows in place", count, timing.thread_clocked(partial(hypcheck.classify, rows, out=out))
            ),
        ]
    samples = timing.measured_samples(entries, rounds)
    for work, name in BATCH_TARGETS.items():
        if work in samples:
            least = samples["rows in C" if work.startswith("rows") else "in C"]
            array_ns = samples["array"].samples_ns if work in ("fresh", "rows") else [0.0] * len(least.samples_ns)
            sample_times = zip(
                samples[work].samples_ns, least.samples_ns, samples["empty"].samples_ns, array_ns, strict=True
            )
            says = (
                f"{timing.rate_text(samples[work])}; in C: {timing.rate_text(least)}"
                f"; an empty call: {samples['empty'].median_ns:.3g} ns"
                f"; a new array: {samples['array'].median_ns:.3g} ns,"
                f" with its first touch: {samples['first touch'].median_ns:.3g} ns a row"
            )
            yield target(f"{name}, {count:.0e}".replace("e+0", "e")).line(
                [(in_c + (empty + array) / count) / mine for mine, in_c, empty, array in sample_times], says
            )


def ten_centres(rounds: int) -> Iterator[KernelLine]:
    """Targets of a batch so small that a call dominates its cost."""
    out = np.empty(TEN, dtype=np.int8)
    names = dict(zip(("sizes", "x", "y", "z"), (TOWER_SIZES, *uniform_columns(TEN)), strict=True))
    take, ask = extension().take, hypcheck.classify_scene
    entries = [
        timing.TimingEntry("loop", 1, statement("pass")),
        timing.TimingEntry("nothing", 1, statement("ask(sizes, x, y, z)", ask=extension().nothing, **names)),
        timing.TimingEntry("take", 1, statement("ask(sizes, x, y, z, out)", ask=take, out=None, **names)),
        timing.TimingEntry("take out", 1, statement("ask(sizes, x, y, z, out)", ask=take, out=out, **names)),
        timing.TimingEntry("fresh", 1, statement("ask(sizes, x, y, z)", ask=ask, **names)),
        timing.TimingEntry("in place", 1, statement("ask(sizes, x, y, z, out)", ask=ask, out=out, **names)),
    ]
    net = without_loop(timing.measured_samples(entries, 3 * rounds))
    for subject, name, least in (("ten centres", "fresh", "take"), ("ten centres, out=", "in place", "take out")):
        says = (
            f"{np.median(net[name]):.3g} ns; an empty call that takes the arrays {np.median(net[least]):.3g} ns, one "
            f"that does not look at them {np.median(net['nothing']):.3g} ns: {LOOP}"
        )
        yield target(subject).line((net[name] / net[least]).tolist(), says)


def statement(text: str, **names: object) -> timing.Clocked:
    """A Python statement with these names, repeated the requested number of times; it has no sum."""
    bound = "; ".join(f"{name} = values[{name!r}]" for name in names)
    timer = Timer(text, bound or "pass", thread_time_ns, {"values": names})
    return lambda repeat: (int(timer.timeit(repeat)), 0)


def without_loop(samples: Mapping[str, timing.Samples]) -> dict[str, Floats]:
    """The samples, without the time of the empty loop in the same round."""
    loop = np.array(samples["loop"].samples_ns)
    return {name: np.array(timed.samples_ns) - loop for name, timed in samples.items()}


def textbook(alpha: float, gamma: float, b: float, d: float, x: float, y: float, z: float) -> int:
    """Table 2 in plain Python, 1 for exterior: the coefficients and the discriminant, without error bounds."""
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
    """Targets of calls about one pair in a Python loop; the time of the empty loop is subtracted."""
    rows = [tuple(row) for row in tower_rows(uniform_columns(CALLS)).tolist()]
    loop = "for alpha, gamma, b, d, x, y, z in rows:"
    ask = f"{loop} ask(alpha, gamma, b, d, x, y, z)"
    functions: dict[str, object] = {"plain": exact_position, "textbook": textbook}
    if choice().kernel == "compiled":
        functions |= {"position": hypcheck.position, "nothing": extension().nothing}
    entries = [timing.TimingEntry("loop", CALLS, statement(f"{loop} pass", rows=rows))]
    entries += [
        timing.TimingEntry(name, CALLS, statement(ask, rows=rows, ask=function)) for name, function in functions.items()
    ]
    net = without_loop(timing.measured_samples(entries, 3 * rounds))
    for subject, name, least in (("one pair", "position", "nothing"), ("one pair, plain Python", "plain", "textbook")):
        if name in net:
            says = f"{np.median(net[name]):.3g} ns, {least} {np.median(net[least]):.3g} ns: {LOOP}"
            yield target(subject).line((net[name] / net[least]).tolist(), says)


MILLION, EACH_AXIS = 1_000_000, 20_000

_SCALARS = (np.float32, np.float64, np.int64)


def forms_of_one_pair(rounds: int) -> Iterator[KernelLine]:
    """Targets of hypcheck.position with the kinds of numbers that programs have."""
    numbers = (2, 18, 1, 2, 3, 4, 5)
    names = {kind.__name__: tuple(map(kind, numbers)) for kind in _SCALARS}
    yield from _lines("one pair", forms("one pair"), {"position": hypcheck.position, **names}, rounds)


def forms_of_ten_centres(rounds: int) -> Iterator[KernelLine]:
    """Targets of classify_scene of ten centres, so that the call dominates the cost."""
    columns = uniform_columns(TEN)
    points = np.column_stack(columns)
    names: dict[str, object] = {**dict(zip("xyz", columns, strict=True)), "points": points}
    names |= dict(zip("uvw", points.T, strict=True))
    names |= {"sizes": TOWER_SIZES, "scalars": tuple(map(np.float32, TOWER_SIZES)), "array": np.array(TOWER_SIZES)}
    names |= {
        "single": [column.astype(np.float32) for column in columns],
        "lists": [list(column) for column in columns],
    }
    names |= {"whole": [column.astype(np.int64) for column in columns], "scene": hypcheck.classify_scene}
    yield from _lines("ten centres", forms("ten centres"), names, rounds)


def forms_of_ten_rows(rounds: int) -> Iterator[KernelLine]:
    """Targets of the forms of calls about ten rows, for positions and for clearances."""
    rows = tower_rows(uniform_columns(TEN))
    names = {"rows": rows, "fortran": np.asfortranarray(rows), "strided": np.repeat(rows, 2, axis=0)[::2]}
    names |= {"single": rows.astype(np.float32), "list": rows.tolist()}
    for subject, call in (("ten rows", hypcheck.classify), ("ten clearances", hypcheck.clearance)):
        yield from _lines(subject, forms("rows"), {**names, "classify": call}, rounds)


def _lines(subject: str, calls: Mapping[str, Form], names: dict[str, object], rounds: int) -> Iterator[KernelLine]:
    entries = [timing.TimingEntry("loop", 1, statement("pass"))]
    entries += [timing.TimingEntry(form, 1, statement(text, **names)) for form, (text, _) in calls.items()]
    net = without_loop(timing.measured_samples(entries, 3 * rounds))
    usual, *others = calls
    for form in others:
        text, wanted = calls[form]
        form_target = KernelTarget(f"{subject}, {form}", f"{text}, to {calls[usual][0]}", wanted, at_most=True)
        says = f"{np.median(net[form]):.3g} ns; {usual} {np.median(net[usual]):.3g} ns: an empty loop is taken off"
        yield form_target.line((net[form] / net[usual]).tolist(), says)


def forms_of_many(rounds: int) -> Iterator[KernelLine]:
    """Targets of the forms of a million centres or rows, from memory."""
    columns, out = uniform_columns(MILLION), np.zeros(MILLION, dtype=np.int8)
    points, rows = np.column_stack(columns), tower_rows(columns)
    ask = partial(hypcheck.classify_scene, TOWER_SIZES, out=out, threads=1)
    wide = [np.repeat(column, 2)[::2] for column in columns]  # its memory traffic is twice as large
    centres = {
        "contiguous": partial(ask, *columns),
        "points (n, 3)": partial(ask, points),
        "columns of points": partial(ask, *points.T),
        "every other number": partial(ask, *wide),
        "float32": partial(ask, *(column.astype(np.float32) for column in columns)),
    }
    ask_rows = partial(hypcheck.classify, out=out, threads=1)
    of_rows = {"contiguous": partial(ask_rows, rows), "Fortran": partial(ask_rows, np.asfortranarray(rows))}
    yield from _many("a million centres", centres, MILLION, rounds)
    yield from _many("a million rows", of_rows, MILLION, rounds)


def forms_of_an_axis_each(rounds: int) -> Iterator[KernelLine]:
    """Targets of centres with an axis each, upright or tilted, against upright rows; tilted ones in other forms too."""
    columns = uniform_columns(EACH_AXIS)
    upright, tilted = np.tile([0.0, 0.0, 1.0], (EACH_AXIS, 1)), compiled_targets.axes(EACH_AXIS)
    ask, ask_rows = partial(hypcheck.classify_scene, TOWER_SIZES, *columns), hypcheck.classify
    ten = tilted_rows(TOWER_SIZES, columns, (*tilted.T,))
    beside_upright = {
        "upright rows": partial(ask_rows, tower_rows(columns)),
        "all upright": partial(ask, axis=upright),
        "all tilted": partial(ask_rows, ten),
    }
    yield from _many("an axis each", beside_upright, EACH_AXIS, rounds)
    in_other_forms = {
        "rows of ten": partial(ask_rows, ten),
        "tilted": partial(ask, axis=tilted),
        "Fortran": partial(ask_rows, np.asfortranarray(ten)),
    }
    yield from _many("an axis each", in_other_forms, EACH_AXIS, rounds)


def _many(subject: str, work: Mapping[str, Callable[[], Positions]], count: int, rounds: int) -> Iterator[KernelLine]:
    samples = timing.measured_samples(
        [timing.TimingEntry(form, count, timing.thread_clocked(call)) for form, call in work.items()], rounds
    )
    usual, *others = work
    for form in others:
        wanted = most_times(subject)[form]
        form_target = KernelTarget(f"{subject}, {form}", f"a row, to one of {usual}", wanted, at_most=True)
        says = f"{timing.rate_text(samples[form])}; {usual}: {timing.rate_text(samples[usual])}"
        yield form_target.against(samples[form], samples[usual], says)
