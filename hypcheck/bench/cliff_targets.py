"""Targets of the forms in which a call may be written: none costs much more than contiguous float64 arrays.

A user has whole numbers, numpy's scalars, lists, float32, columns of an array of points, rows in Fortran's order, or an
axis for each row. Each form is timed beside the same question in the cheapest one, in the same rounds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial

import numpy as np

import hypcheck
from hypcheck.bench import compiled_targets
from hypcheck.bench.c_library import TOWER_SIZES
from hypcheck.bench.call_targets import statement, without_loop
from hypcheck.bench.compiled_targets import tower_rows, uniform_columns
from hypcheck.geometry.rows import Positions, tilted_rows
from hypcheck.record.measurements import KernelLine
from hypcheck.runs.timing import KernelTarget, TimingEntry, measured_samples, rate_text, thread_clocked, times_as_long

TEN, MANY, CACHED = 10, 1_000_000, 20_000

_SCALARS = (np.float32, np.float64, np.int64)

Form = tuple[str, float]
"""A statement that calls, and how many times as long as the first of its table it may take."""

PAIR_FORMS: Mapping[str, Form] = {
    "floats": ("position(2.0, 18.0, 0.25, 0.15, 3.0, 4.0, 5.0)", 1),
    "ints": ("position(2, 18, 1, 2, 3, 4, 5)", 3),
    "numpy floats": ("position(*float64)", 3),
    "numpy float32": ("position(*float32)", 3),
    "numpy ints": ("position(*int64)", 3),
}

TEN_FORMS: Mapping[str, Form] = {
    "contiguous": ("scene(sizes, x, y, z)", 1),
    "one int among the sizes": ("scene((2, 17.8, 0.25, 0.15), x, y, z)", 3),
    "sizes of numpy's scalars": ("scene(scalars, x, y, z)", 3),
    "sizes in an array": ("scene(array, x, y, z)", 3),
    "ints for columns": ("scene(sizes, x, 1, 5)", 3),
    "strided columns": ("scene(sizes, u, v, w)", 3),
    "whole numbers": ("scene(sizes, *whole)", 3),
    "lists": ("scene(sizes, *lists)", 5),
    "float32": ("scene(sizes, *single)", 5),
    "points (n, 3)": ("scene(sizes, points)", 3),
    "axis with an int": ("scene(sizes, x, y, z, axis=(0, 0, 1))", 3),
}

ROW_FORMS: Mapping[str, Form] = {
    "contiguous": ("classify(rows)", 1),
    "Fortran": ("classify(fortran)", 3),
    "strided": ("classify(strided)", 3),
    "float32": ("classify(single)", 5),
    "list": ("classify(list)", 5),
}


def forms_of_one_pair(rounds: int) -> Iterator[KernelLine]:
    """hypcheck.position with the numbers that a program has."""
    numbers = (2, 18, 1, 2, 3, 4, 5)
    names = {kind.__name__: tuple(map(kind, numbers)) for kind in _SCALARS}
    yield from _lines("one pair", PAIR_FORMS, {"position": hypcheck.position, **names}, rounds)


def forms_of_ten_centres(rounds: int) -> Iterator[KernelLine]:
    """classify_scene of ten centres, so that the cost is that of the call."""
    columns = uniform_columns(TEN)
    points = np.column_stack(columns)
    names: dict[str, object] = {**dict(zip("xyz", columns, strict=True)), "points": points}
    names |= dict(zip("uvw", points.T, strict=True))
    names |= {"sizes": TOWER_SIZES, "scalars": tuple(map(np.float32, TOWER_SIZES)), "array": np.array(TOWER_SIZES)}
    names |= {"single": [column.astype(np.float32) for column in columns], "lists": [list(each) for each in columns]}
    names |= {"whole": [column.astype(np.int64) for column in columns], "scene": hypcheck.classify_scene}
    yield from _lines("ten centres", TEN_FORMS, names, rounds)


def forms_of_ten_rows(rounds: int) -> Iterator[KernelLine]:
    """The same of rows, of positions and of clearances."""
    rows = tower_rows(uniform_columns(TEN))
    names = {"rows": rows, "fortran": np.asfortranarray(rows), "strided": np.repeat(rows, 2, axis=0)[::2]}
    names |= {"single": rows.astype(np.float32), "list": rows.tolist()}
    for subject, call in (("ten rows", hypcheck.classify), ("ten clearances", hypcheck.clearance)):
        yield from _lines(subject, ROW_FORMS, {**names, "classify": call}, rounds)


def _lines(subject: str, forms: Mapping[str, Form], names: dict[str, object], rounds: int) -> Iterator[KernelLine]:
    entries = [TimingEntry("loop", 1, statement("pass"))]
    entries += [TimingEntry(form, 1, statement(text, **names)) for form, (text, _) in forms.items()]
    net = without_loop(measured_samples(entries, 3 * rounds))
    usual, *others = forms
    for form in others:
        text, wanted = forms[form]
        target = KernelTarget(f"{subject}, {form}", f"{text}, to {forms[usual][0]}", wanted, at_most=True)
        says = f"{np.median(net[form]):.3g} ns; {usual} {np.median(net[usual]):.3g} ns: an empty loop is taken off"
        yield target.line((net[form] / net[usual]).tolist(), says)


def forms_of_many(rounds: int) -> Iterator[KernelLine]:
    """A million centres, or rows, from memory."""
    columns, out = uniform_columns(MANY), np.zeros(MANY, dtype=np.int8)
    points, rows = np.column_stack(columns), tower_rows(columns)
    ask = partial(hypcheck.classify_scene, TOWER_SIZES, out=out, threads=1)
    wide = [np.repeat(column, 2)[::2] for column in columns]  # of which twice the memory is read
    centres = {
        "contiguous": partial(ask, *columns),
        "points (n, 3)": partial(ask, points),
        "columns of points": partial(ask, *points.T),
        "every other number": partial(ask, *wide),
        "float32": partial(ask, *(column.astype(np.float32) for column in columns)),
    }
    ask_rows = partial(hypcheck.classify, out=out, threads=1)
    of_rows = {"contiguous": partial(ask_rows, rows), "Fortran": partial(ask_rows, np.asfortranarray(rows))}
    wanted = dict.fromkeys(centres, 1.5) | {"every other number": 4.0}
    yield from _many("a million centres", centres, wanted, MANY, rounds)
    yield from _many("a million rows", of_rows, dict.fromkeys(of_rows, 1.5), MANY, rounds)


def forms_of_an_axis_each(rounds: int) -> Iterator[KernelLine]:
    """Centres with an axis each, beside upright rows where all are upright, and beside rows of ten where they lean.

    The proof about a row that leans takes four times the arithmetic of an upright one, whatever form it comes in.
    """
    columns = uniform_columns(CACHED)
    upright, leaning = np.tile([0.0, 0.0, 1.0], (CACHED, 1)), compiled_targets.axes(CACHED)
    rows = tower_rows(columns)
    ask, ask_rows = partial(hypcheck.classify_scene, TOWER_SIZES, *columns), hypcheck.classify
    upright_work = {"upright rows": partial(ask_rows, rows), "all upright": partial(ask, axis=upright)}
    yield from _many("an axis each", upright_work, {"all upright": 1.5}, CACHED, rounds)
    ten = tilted_rows(TOWER_SIZES, columns, (*leaning.T,))
    leaning_work = {
        "rows of ten": partial(ask_rows, ten),
        "leaning": partial(ask, axis=leaning),
        "Fortran": partial(ask_rows, np.asfortranarray(ten)),
    }
    yield from _many("an axis each", leaning_work, dict.fromkeys(leaning_work, 1.5), CACHED, rounds)


def _many(
    subject: str, work: Mapping[str, Callable[[], Positions]], wanted: Mapping[str, float], count: int, rounds: int
) -> Iterator[KernelLine]:
    found = measured_samples([TimingEntry(form, count, thread_clocked(call)) for form, call in work.items()], rounds)
    usual, *others = work
    for form in others:
        target = KernelTarget(f"{subject}, {form}", f"a row, to one of {usual}", wanted[form], at_most=True)
        says = f"{rate_text(found[form])}; {usual}: {rate_text(found[usual])}"
        yield target.line(times_as_long(found[form], found[usual]), says)
