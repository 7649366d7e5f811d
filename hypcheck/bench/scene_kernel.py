"""A scene's kernel in C as bench asks it: all centres by a call for each pair of sizes, or a call for each row."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hypcheck.bench.contenders.c_library import compile_c
from hypcheck.kernel.emission.kernel import emitted
from hypcheck.kernel.specialise.plan import Plan
from hypcheck.rows import Positions, Rows

_ONE_BY_ONE = """
void one_by_one(size_t n, const double *rows, int8_t *positions);
void one_by_one(size_t n, const double *rows, int8_t *positions)
{
    void (*volatile asked)(size_t, const double *, int8_t *) = hypcheck_classify;
    for (size_t i = 0; i < n; i++) asked(1, rows + 7 * i, positions + i);
}
"""
"""What a program in C does that has one question at a time; the compiler cannot see what it calls."""


@dataclass(frozen=True)
class SceneKernel:
    """The kernel, compiled and loaded."""

    library: ctypes.CDLL

    def batch(self, tables: Sequence[Rows]) -> Callable[[], Positions]:
        """Asks all rows by one call a table; the rows of a table have the same sizes."""
        found = np.zeros(sum(map(len, tables)), dtype=np.int8)
        kept, calls, start = [], [], 0
        for rows in tables:
            part = found[start : start + len(rows)]
            parts = (rows[0, :4].copy(), *np.ascontiguousarray(rows[:, 4:].T), part)
            pointers = [ctypes.c_void_p(each.ctypes.data) for each in parts]
            kept.append(parts)
            calls.append((pointers[0], ctypes.c_size_t(len(rows)), *pointers[1:]))
            start += len(rows)

        def work(_kept: object = kept) -> Positions:
            for call in calls:
                self.library.hypcheck_classify_scene(*call)
            return found

        return work

    def single(self, rows: Rows) -> Callable[[], Positions]:
        """Asks all rows by one call each, from C."""
        queries, found = np.ascontiguousarray(rows), np.zeros(len(rows), dtype=np.int8)
        pointers = [ctypes.c_void_p(each.ctypes.data) for each in (queries, found)]

        def work(_kept: object = queries) -> Positions:
            self.library.one_by_one(ctypes.c_size_t(len(found)), *pointers)
            return found

        return work


def built(plan: Plan, folder: Path) -> SceneKernel:
    """The plan's kernel, made in a folder of its own. Raises UnavailableError where there is no C compiler."""
    folder.mkdir()
    code, library = folder / "kernel.c", folder / "kernel.so"
    code.write_text(emitted(plan, "c", ["hypcheck", "emit"]) + _ONE_BY_ONE, encoding="utf-8")
    compile_c(code, library)
    return SceneKernel(ctypes.CDLL(str(library)))
