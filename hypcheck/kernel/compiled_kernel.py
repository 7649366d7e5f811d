"""The compiled kernel over numpy arrays: whole columns without a copy, parts of large ones on threads."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from functools import cache, partial
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import UPRIGHT, Axis, Sizes
from hypcheck.geometry.rows import Columns, Floats, Positions, Rows
from hypcheck.kernel.choice import NUMBER_OF, Question, compiled, most_threads

ROWS_A_THREAD = 1 << 20
"""Fewer rows are not worth a thread: to start one takes as long as some 10⁵ rows."""

BLOCK = 64
"""The kernel takes so many rows at once: a part has a whole number of such blocks."""

KEPT = 16
"""How many bytes keep the answers of a block."""

_SCALARS = (np.float32, np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64)
"""numpy's scalar types that C reads directly; np.float64 is a float."""


@cache
def extension() -> ModuleType:
    """Return the extension module, after giving it numpy's array type."""
    module = compiled()
    samples = tuple(kind(77) for kind in _SCALARS)
    module.use_arrays(np.ndarray, np.empty, np.dtype(np.int8), 2 * ROWS_A_THREAD - 1, samples)
    return module


def prepared(sizes: Sizes, like: Columns, axis: Axis | None = None) -> bytes:
    """As in_use.Kernel has it: a hypcheck_scene of core/parts/contract.h."""
    columns = (np.require(column, np.float64, ["C", "A"]) for column in like)
    scene: bytes = extension().prepare(sizes, axis or UPRIGHT, *columns)
    return scene


def answer_rows(rows: Rows, question: Question, threads: int | None = None) -> tuple[Positions, int]:
    """As in_use.Kernel has it."""
    ask, number, answers = compiled().ask, NUMBER_OF[question], np.empty(len(rows), dtype=np.int8)
    return answers, _by_row(partial(ask, number), rows, (answers,), threads)


def _by_row(ask: Callable[..., int], rows: Rows, outputs: Sequence[NDArray[Any]], threads: int | None) -> int:
    """Call `ask` for parts of the rows; it fills arrays with a place for each row. Return the sum of its results."""
    aligned = rows if rows.flags.aligned else rows.copy()

    def part(start: int, stop: int) -> int:
        return ask(aligned[start:stop], *(output[start:stop] for output in outputs))

    return in_parts(part, len(rows), threads)


def answer_scene(
    sizes: Sizes, columns: Columns, question: Question, threads: int | None = None, axis: Axis | None = None
) -> tuple[Positions, int]:
    """As in_use.Kernel has it."""
    answers = np.empty(len(columns[0]), dtype=np.int8)
    return answers, fill_scene(sizes, columns, answers, question, threads, axis)


def fill_scene(
    sizes: Sizes,
    columns: Columns,
    answers: Positions,
    question: Question,
    threads: int | None = None,
    axis: Axis | None = None,
) -> int:
    """Write the answers of answer_scene into a contiguous array; return how many rows are invalid."""
    ask, number = extension().ask_scene, NUMBER_OF[question]
    own_axis = () if axis is None else (axis,)

    def part(start: int, stop: int) -> int:
        return int(ask(number, sizes, *(column[start:stop] for column in columns), answers[start:stop], *own_axis))

    return in_parts(part, len(answers), threads)


def fill_valid_scene(
    sizes: Sizes, columns: Columns, out: Positions, threads: int | None = None, axis: Axis | None = None
) -> bool:
    """Fill a contiguous array with positions if all centres are valid, or leave it unchanged and return False.

    It must not overlap the columns. The answers of a thread are kept as bits until all threads have ended.
    """
    core, own_axis = extension(), () if axis is None else (axis,)
    kept: NDArray[np.int8] = np.empty(-(-len(out) // BLOCK) * KEPT, dtype=np.int8)

    def part(start: int, stop: int) -> int:
        these = kept[start // BLOCK * KEPT : -(-stop // BLOCK) * KEPT]
        return int(core.keep_scene(0, sizes, *(column[start:stop] for column in columns), these, *own_axis))

    def write(start: int, stop: int) -> int:
        core.spread(kept[start // BLOCK * KEPT : -(-stop // BLOCK) * KEPT], out[start:stop])
        return 0

    if in_parts(part, len(out), threads):
        return False
    in_parts(write, len(out), threads)
    return True


def answer_sweeps(rows: Rows) -> tuple[Positions, Floats]:
    """As in_use.Kernel has it."""
    hits, times = np.empty(len(rows), dtype=np.int8), np.empty(len(rows))
    _by_row(lambda *part: compiled().passage(*part) or 0, rows, (hits, times), None)
    return hits, times


def answer_ended(rows: Rows, threads: int | None = None) -> Positions:
    """As in_use.Kernel has it."""
    positions = np.empty(len(rows), dtype=np.int8)
    _by_row(lambda *part: compiled().classify_ended(*part) or 0, rows, (positions,), threads)
    return positions


NEAR_NUMBERS = 11
"""How many numbers the kernel gives for each row beside its position: hypcheck_near in core/parts/contract.h."""


def near_rows(rows: Rows, threads: int | None = None) -> tuple[Positions, Floats]:
    """Return positions (n,), 127 for invalid ones, and the results (n, 11) for contiguous rows (n, 7)."""
    positions, numbers = np.empty(len(rows), dtype=np.int8), np.empty((len(rows), NEAR_NUMBERS))
    _by_row(compiled().clearance, rows, (positions, numbers), threads)
    return positions, numbers


def in_parts(part: Callable[[int, int], int], count: int, threads: int | None) -> int:
    """Return the sum of part(start, stop) over equal parts, the first in this thread and each other in one of its own.

    An exception of a part is raised here after all parts have ended.
    """
    number = 1
    if threads is not None:
        number = max(1, min(threads, count // BLOCK))
    elif count // ROWS_A_THREAD > 1:
        number = min(most_threads(), count // ROWS_A_THREAD)
    bounds = [count * k // number // BLOCK * BLOCK for k in range(number)] + [count]
    results, troubles = [0] * number, list[BaseException]()

    def run(k: int) -> None:
        try:
            results[k] = part(bounds[k], bounds[k + 1])
        except BaseException as trouble:  # noqa: BLE001 - it is raised where the answers are waited for
            troubles.append(trouble)

    others = [threading.Thread(target=run, args=(k,), name=f"hypcheck-{k}") for k in range(1, number)]
    for thread in others:
        thread.start()
    run(0)
    for thread in others:
        thread.join()
    if troubles:
        raise troubles[0]
    return sum(results)
