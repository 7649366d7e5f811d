"""Targets of the calls from Python: compared with the C function that they call, and with other methods.

A call cannot be cheaper than a call of an empty C function; with arrays, of one that takes these arrays. Batches are
compared with the sum of two times: the C function on the same rows, called from C, and one empty call; without out=
also the allocation of an array. One pair in plain Python is compared with the plain formula in plain Python, which is
not certified; ten million rows with the same formula in numpy, and rows of a hundred thousand with numpy.roots and FCL.

No form of a call's arguments may cost much more than contiguous float64 arrays. Users have whole numbers, numpy
scalars, lists, float32, columns of an array of points, rows in Fortran order, or an axis for each row. Each form is
timed together with the cheapest form of the same question, in the same rounds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from statistics import median
from time import thread_time_ns
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hypcheck
from hypcheck.bench import yardsticks
from hypcheck.bench.c_library import TOWER_SIZES
from hypcheck.bench.yardsticks import (
    KernelTarget,
    Measuring,
    lines,
    statement,
    threaded,
    tower_rows,
    uniform_columns,
    without_loop,
)
from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import Columns, Floats, Positions, Rows, tilted_rows
from hypcheck.implementations.alternatives import delta_with_powers, numpy_roots
from hypcheck.implementations.meshes import FCL, height_of, scene_mesh
from hypcheck.kernel import numpy_kernel
from hypcheck.kernel.choice import choice
from hypcheck.kernel.compiled_kernel import extension
from hypcheck.kernel.scalar import exact_position
from hypcheck.record.measurements import KernelLine
from hypcheck.runs.timing import (
    Clocked,
    Samples,
    TimingEntry,
    clocked_calls,
    clocked_in_c,
    measured_samples,
    rate_text,
    times_as_fast,
)


def with_powers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> NDArray[np.int8]:
    """Whether each centre is exterior, with `**2` and `**3` as in the paper's formula; it is not certified."""
    delta, c1, c2 = delta_with_powers(sizes, x, y, z)
    return np.asarray((delta > 0) & (c2 < 0) & (c1 > 0)).view(np.int8)


def with_products(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> NDArray[np.int8]:
    """As with_powers, with products instead of powers; numpy computes powers by a function of the C library."""
    alpha, gamma, b, d = sizes
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    c0, bb, dd = -A * B, b * b, d * d
    P, Q = (x * x + y * y) / bb, z * z / dd
    c1 = c0 + A - B + B * P - A * Q
    c2 = A - B + 1 - P - Q
    c21 = c2 * c1
    delta = -4 * c2 * c2 * c2 * c0 + c21 * c21 + 18 * c21 * c0 - 4 * c1 * c1 * c1 - 27 * c0 * c0
    return np.asarray((delta > 0) & (c2 < 0) & (c1 > 0)).view(np.int8)


def textbook(alpha: float, gamma: float, b: float, d: float, x: float, y: float, z: float) -> int:
    """Decide by the paper's Table 2 in plain Python, without error bounds: 1 if the spheroid is exterior, else 0."""
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


EXPRESSIONS = {
    "powers": "the numpy expression with ** 2 and ** 3",
    "products": "the numpy expression with products for powers",
}


@dataclass(frozen=True, slots=True)
class TimesAsFast:
    """A target "`times` times as fast as an expression", as a share of it, or of the possible factor if that is less.

    If the system has large pages for the expression's temporaries, the expression may be so fast that even a loop that
    only reads the rows is not `times` as fast.
    """

    mine: str
    name: str
    subject: str
    times: float
    ceiling: str
    share: float

    def line(self, expression: str, samples: Mapping[str, Samples], says: str) -> KernelLine:
        """Return the record's line about the expression of that name."""
        own, other, least = (samples[name] for name in (self.mine, expression, self.ceiling))
        gains, most = times_as_fast(own, other), times_as_fast(least, other)
        reached = [gain / min(self.times, self.share * limit) for gain, limit in zip(gains, most, strict=True)]
        limit = f"or {self.share} of what {self.ceiling} allows, if that is less"
        text = f"{self.subject}, of {self.times:g} times the speed of {EXPRESSIONS[expression]}, {limit}; 1e7 rows"
        words = f"{rate_text(own)}; the expression: {rate_text(other)}, {median(gains):.3g} times as long"
        words += f"; {self.ceiling} the rows: {rate_text(least)}{says}"
        return KernelTarget(f"{self.name}, {expression}", text, 1.0).line(reached, words)


def numpy_targets() -> tuple[TimesAsFast, ...]:
    """Return the targets against numpy expressions that targets.toml lists."""
    return tuple(TimesAsFast(**entry) for entry in yardsticks.listed()["times_as_fast"])


CHUNK = 1 << 13


def copied(columns: Columns) -> NDArray[np.signedinteger]:
    """Round all numbers to single precision in numpy, a chunk at a time: the first step of any float32 work on them."""
    buffer, places = np.empty((len(columns), CHUNK), dtype=np.float32), range(0, len(columns[0]), CHUNK)
    for start in places:
        for column, into in zip(columns, buffer, strict=True):
            part = column[start : start + CHUNK]
            np.copyto(into[: len(part)], part, casting="same_kind")
    return np.array([len(places)])


LARGE_PAGES = Path("/sys/kernel/mm/transparent_hugepage/enabled")


def large_pages(setting: Path = LARGE_PAGES) -> str:
    """Return a sentence about the system's setting of large pages for the temporaries of an expression."""
    try:
        text = setting.read_text(encoding="ascii")
    except (OSError, UnicodeDecodeError):
        return "large pages for temporaries: not reported by this system"
    chosen = text.partition("[")[2].partition("]")[0]
    words = {"always": "always", "madvise": "where asked for, as numpy does for 4 MB and more", "never": "never"}
    return f"large pages for temporaries: {words.get(chosen, 'not reported by this system')}"


def against_numpy(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of ten million rows: both numpy expressions and both kernels, as a user calls them; limits."""
    columns = uniform_columns(MOST)
    work: dict[str, Callable[[], NDArray[np.signedinteger]]] = {
        "copying": partial(copied, columns),
        "kernel": partial(hypcheck.classify_scene, TOWER_SIZES, *columns, threads=1),
        "fallback": partial(numpy_kernel.positions_of_scene, TOWER_SIZES, *columns),
        "powers": partial(with_powers, TOWER_SIZES, *columns),
        "products": partial(with_products, TOWER_SIZES, *columns),
    }
    compiled = choice().kernel == "compiled"
    if not compiled:
        del work["kernel"]
    entries = [replace(entry, loops=1) for entry in threaded(MOST, work)]
    if compiled:
        entries.append(TimingEntry("reading", MOST, run.baselines[0].read(columns), loops=1))
    samples = measured_samples(entries, 3 if run.quick else 9)
    for times in numpy_targets():
        if times.mine in samples:
            for expression in EXPRESSIONS:
                yield times.line(expression, samples, f"; {large_pages()}")


TRIANGLES = 2000


def fcl_queries(rows: Rows) -> Clocked:
    """Return FCL's queries with a mesh that was built before, a row at a time, in the units of its mesh."""
    mesh = scene_mesh(FCL, "point", TOWER_SIZES, height_of(TOWER_SIZES, rows), TRIANGLES)
    touches, centres = mesh.touches, (rows[:, 4:] / np.array(mesh.unit)).tolist()
    if touches is None:
        raise AssertionError("FCL refused the mesh")
    return clocked_calls(touches, centres, thread_time_ns)


ONE_BY_ONE = 200
"""How many rows a method gets that is called for each row."""


def against_others(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of a hundred thousand rows of the kernel against numpy.roots and FCL, a row at a time."""
    columns = uniform_columns(100_000)
    rows = tower_rows(columns)[:ONE_BY_ONE]
    entries = [
        *threaded(100_000, {"kernel": partial(hypcheck.classify_scene, TOWER_SIZES, *columns, threads=1)}),
        *threaded(ONE_BY_ONE, {"numpy.roots": partial(numpy_roots, rows)}),
    ]
    if FCL.trouble() is None:
        entries.append(TimingEntry("FCL", ONE_BY_ONE, fcl_queries(rows)))
    samples = measured_samples(entries, run.rounds)
    yield from lines(samples, *(name for name in ("numpy.roots", "FCL") if name in samples))


CALLS, TEN = 1000, 10


BATCHES, MOST = (1_000, 10_000, 100_000), 10_000_000


def batches(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of batches that stay in the cache, and of one from memory."""
    for count in BATCHES:
        yield from _batch(run, count, 3 * run.rounds)
    yield from _batch(run, MOST, run.rounds)


def _batch(run: Measuring, count: int, rounds: int) -> Iterator[KernelLine]:
    """Yield targets of a batch, with the cost of a new array's first access.

    MOST rows come from memory, only as a scene.
    """
    columns, out = uniform_columns(count), np.zeros(count, dtype=np.int8)
    library, large = run.baselines[0], count == MOST
    scene = partial(hypcheck.classify_scene, TOWER_SIZES, *columns, threads=1 if large else None)
    take, new = partial(extension().take, TOWER_SIZES, *columns, out), partial(np.empty, count, np.dtype(np.int8))
    entries = [
        TimingEntry("in C", count, clocked_in_c(library.of_scene(columns, out), out, thread_time_ns)),
        *threaded(count, {"fresh": scene, "in place": partial(scene, out)}),
        TimingEntry("array", 1, statement("new()", new=new)),
        TimingEntry("empty", 1, statement("take()", take=take)),
        TimingEntry("first touch", count, statement("new().fill(1)", new=new)),
    ]
    if not large:
        rows = tower_rows(columns)
        entries += [
            TimingEntry("rows in C", count, clocked_in_c(library.of_rows(rows, out), out, thread_time_ns)),
            *threaded(
                count,
                {
                    "rows": partial(hypcheck.classify, rows),
                    "rows in place": partial(hypcheck.classify, rows, out=out),
                },
            ),
        ]
    samples = measured_samples(entries, rounds)
    for name, entry in yardsticks.listed()["batches"].items():
        if (work := entry["mine"]) in samples:
            yield _batch_line(name, entry, count, samples, samples["rows in C" if work.startswith("rows") else "in C"])


def _batch_line(
    name: str, entry: Mapping[str, Any], count: int, samples: Mapping[str, Samples], in_c: Samples
) -> KernelLine:
    """Return the record's line about a batch of `count` rows by one Python call, named as entry["mine"].

    The target compares its time for a row with that of the C function (`in_c`), plus the cost of an empty call and, if
    the call makes a new array, of that, spread over the rows.
    """
    rows = f"{count:.0e}".replace("e+0", "e")
    mine, empty, array = samples[entry["mine"]], samples["empty"], samples["array"]
    made = array.samples_ns if entry["mine"] in ("fresh", "rows") else [0.0] * len(array.samples_ns)
    times = zip(mine.samples_ns, in_c.samples_ns, empty.samples_ns, made, strict=True)
    says = (
        f"{rate_text(mine)}; in C: {rate_text(in_c)}; an empty call: {empty.median_ns:.3g} ns; a new array: "
        f"{array.median_ns:.3g} ns, with its first touch: {samples['first touch'].median_ns:.3g} ns a row"
    )
    return KernelTarget(f"{name}, {rows}", f"{entry['text']}; {rows} rows", entry["at_least"][rows]).line(
        [(least + (call + new) / count) / own for own, least, call, new in times], says
    )


def ten_centres(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of a batch so small that a call dominates its cost."""
    out = np.empty(TEN, dtype=np.int8)
    names = dict(zip(("sizes", "x", "y", "z"), (TOWER_SIZES, *uniform_columns(TEN)), strict=True))
    arrays, with_out = "ask(sizes, x, y, z)", "ask(sizes, x, y, z, out)"
    take, ask, nothing = extension().take, hypcheck.classify_scene, extension().nothing
    calls = {
        "loop": statement("pass"),
        "nothing": statement(arrays, ask=nothing, **names),
        "take": statement(with_out, ask=take, out=None, **names),
        "take out": statement(with_out, ask=take, out=out, **names),
        "fresh": statement(arrays, ask=ask, **names),
        "in place": statement(with_out, ask=ask, out=out, **names),
    }
    entries = [TimingEntry(name, 1, call) for name, call in calls.items()]
    samples = without_loop(measured_samples(entries, 3 * run.rounds))
    yield from lines(samples, "ten centres", "ten centres, out=")


def one_call(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of calls about one pair in a Python loop; the time of the empty loop is subtracted."""
    rows = [tuple(row) for row in tower_rows(uniform_columns(CALLS)).tolist()]
    loop = "for alpha, gamma, b, d, x, y, z in rows:"
    functions: dict[str, object] = {"plain": exact_position, "textbook": textbook}
    if choice().kernel == "compiled":
        functions |= {"position": hypcheck.position, "nothing": extension().nothing}
    ask = f"{loop} ask(alpha, gamma, b, d, x, y, z)"
    calls = {name: statement(ask, rows=rows, ask=function) for name, function in functions.items()}
    calls["loop"] = statement(f"{loop} pass", rows=rows)
    samples = without_loop(
        measured_samples([TimingEntry(name, CALLS, call) for name, call in calls.items()], 3 * run.rounds)
    )
    yield from lines(samples, *(["one pair"] if "position" in functions else []), "one pair, plain Python")


def forms_of_one_pair(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of hypcheck.position with the kinds of numbers that programs have."""
    numbers, kinds = (2, 18, 1, 2, 3, 4, 5), (np.float32, np.float64, np.int64)
    names = {kind.__name__: tuple(map(kind, numbers)) for kind in kinds}
    yield from _calls("one pair", "one pair", {"position": hypcheck.position, **names}, run)


def forms_of_ten_centres(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of classify_scene of ten centres, so that the call dominates the cost."""
    columns = uniform_columns(TEN)
    points = np.column_stack(columns)
    names: dict[str, object] = {
        "scene": hypcheck.classify_scene,
        "sizes": TOWER_SIZES,
        "scalars": tuple(map(np.float32, TOWER_SIZES)),
        "array": np.array(TOWER_SIZES),
        "points": points,
        **dict(zip("xyz", columns, strict=True)),
        **dict(zip("uvw", points.T, strict=True)),
        "single": [column.astype(np.float32) for column in columns],
        "whole": [column.astype(np.int64) for column in columns],
        "lists": [list(column) for column in columns],
    }
    yield from _calls("ten centres", "ten centres", names, run)


def forms_of_ten_rows(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of the forms of calls about ten rows, for positions and for clearances."""
    rows = tower_rows(uniform_columns(TEN))
    names = {"rows": rows, "fortran": np.asfortranarray(rows), "strided": np.repeat(rows, 2, axis=0)[::2]}
    names |= {"single": rows.astype(np.float32), "list": rows.tolist()}
    for subject, call in (("ten rows", hypcheck.classify), ("ten clearances", hypcheck.clearance)):
        yield from _calls(subject, "rows", {**names, "classify": call}, run)


def _calls(subject: str, table: str, names: dict[str, object], run: Measuring) -> Iterator[KernelLine]:
    """Return the lines of the forms of a call that targets.toml lists in a table."""
    calls = yardsticks.listed()["forms"][table]
    entries = [TimingEntry("loop", 1, statement("pass"))]
    entries += [TimingEntry(form, 1, statement(text, **names)) for form, (text, _) in calls.items()]
    samples = without_loop(measured_samples(entries, 3 * run.rounds))
    usual = next(iter(calls.values()))[0]
    texts = {form: f"{text}, to {usual}" for form, (text, _) in calls.items()}
    times = {form: most for form, (_, most) in calls.items()}
    return _forms(subject, texts, times, samples, "{mine_ns}; {name} {other_ns}: an empty loop is taken off")


def _forms(
    subject: str,
    texts: Mapping[str, str],
    times: Mapping[str, float],
    samples: Mapping[str, Samples],
    says: str = "{mine}; {name}: {other}",
) -> Iterator[KernelLine]:
    """Return the lines of the forms of a call, each compared with the first, which is the cheapest.

    `times` says how many times as long a form may take.
    """
    usual, *others = texts
    return (
        KernelTarget(f"{subject}, {form}", texts[form], times[form], True, form, usual, says).of(samples)
        for form in others
    )


MILLION, EACH_AXIS = 1_000_000, 20_000


def forms_of_many(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of the forms of a million centres or rows, from memory."""
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
    yield from _many("a million centres", centres, MILLION, run)
    yield from _many("a million rows", of_rows, MILLION, run)


def forms_of_an_axis_each(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of centres with an axis each, upright or tilted, against upright rows.

    Tilted rows are measured in other forms too.
    """
    columns = uniform_columns(EACH_AXIS)
    upright, tilted = np.tile([0.0, 0.0, 1.0], (EACH_AXIS, 1)), yardsticks.axes(EACH_AXIS)
    ask, ask_rows = partial(hypcheck.classify_scene, TOWER_SIZES, *columns), hypcheck.classify
    ten = tilted_rows(TOWER_SIZES, columns, (*tilted.T,))
    beside_upright = {
        "upright rows": partial(ask_rows, tower_rows(columns)),
        "all upright": partial(ask, axis=upright),
        "all tilted": partial(ask_rows, ten),
    }
    yield from _many("an axis each", beside_upright, EACH_AXIS, run)
    in_other_forms = {
        "rows of ten": partial(ask_rows, ten),
        "tilted": partial(ask, axis=tilted),
        "Fortran": partial(ask_rows, np.asfortranarray(ten)),
    }
    yield from _many("an axis each", in_other_forms, EACH_AXIS, run)


def _many(
    subject: str, calls: Mapping[str, Callable[[], Positions]], count: int, run: Measuring
) -> Iterator[KernelLine]:
    """Return the lines of the forms of a call about many rows."""
    samples = measured_samples(threaded(count, calls), run.rounds)
    texts = dict.fromkeys(calls, f"a row, to one of {next(iter(calls))}")
    return _forms(subject, texts, yardsticks.listed()["many"][subject], samples)
