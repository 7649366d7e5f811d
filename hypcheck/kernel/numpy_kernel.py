"""The kernel in numpy: the stages of the compiled one over chunks, with the arithmetic printed from the same programs.

half planes of the scene     printed/chunks.py plane and parallel_lines, in single precision; where these leave too
                             many rows, two_lines; scene_lines.py makes their constants
discriminant and its bound   printed/chunks.py certified
integers                     integers.py
rows whose axis leans        numpy_tilted.py
"""

from __future__ import annotations

from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS, REFUSED, TILTED_COLUMNS, Axis, Pair, Sizes
from hypcheck.geometry.rows import (
    CANNOT_SAY,
    WAYS,
    Columns,
    Floats,
    Indices,
    Mask,
    Positions,
    Rows,
    invalid,
    tilted_rows,
)
from hypcheck.kernel import integers, numpy_tilted, scene_lines
from hypcheck.kernel.choice import POSITION_OF, Question
from hypcheck.kernel.printed import chunks
from hypcheck.kernel.programs.certified import CONSTANTS
from hypcheck.kernel.programs.lines import CAP
from hypcheck.kernel.programs.lines import FLOAT32_CAP as CAP_OF_SINGLES
from hypcheck.kernel.scene_lines import SceneLines

CHUNK = 8192
"""Rows at a time: the buffers of one chunk stay in the cache, and the calls of ufuncs are few."""

LINES_CHUNK = 1 << 15
"""The same for the lines, which need fewer buffers and smaller ones."""

LINES_FROM = 1 << 14
"""Centres from which a scene's half planes are worth their making."""

TOO_MANY_LEFT = LINES_CHUNK // 100
"""Of a chunk, by one line a side: then it is two."""


Number = TypeVar("Number", np.float32, np.float64)


def positions(rows: Rows) -> Positions:
    """The exact position of every row, int8 (n,), 127 for invalid ones; float64 (n, 7) or (n, 10) as in rows.py."""
    if rows.shape[1] == len(TILTED_COLUMNS):
        return _positions_of_ten(rows)
    result = np.empty(len(rows), dtype=np.int8)
    buffers = Buffers(chunks.CERTIFIED_BUFFERS, min(CHUNK, len(rows)), np.float64)
    for start in range(0, len(rows), CHUNK):
        part = rows[start : start + CHUNK]
        _certified(part, buffers, result[start : start + CHUNK])
    return result


def _positions_of_ten(rows: Rows) -> Positions:
    result = np.empty(len(rows), dtype=np.int8)
    leaning = numpy_tilted.leaning(rows)
    if leaning.any():
        result[leaning] = numpy_tilted.positions(rows[leaning])
    if not leaning.all():
        upright = rows[~leaning]
        found = positions(upright[:, : len(COLUMNS)])
        found[invalid(upright)] = REFUSED
        result[~leaning] = found
    return result


def positions_of_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats, axis: Axis | None = None) -> Positions:
    """The exact position of every centre (x, y, z), float64 (n,) each, for valid α, γ, b, d and axis; int8 (n,).

    All are 127 where the axis has no direction.
    """
    result = np.empty(len(x), dtype=np.int8)
    if axis is not None and not (axis[:2] == (0, 0) and 0 < abs(axis[2]) < np.inf):
        for start in range(0, len(x), CHUNK):
            part = slice(start, start + CHUNK)
            result[part] = positions(tilted_rows(sizes, (x[part], y[part], z[part]), axis))
        return result
    lines = scene_lines.lines_of(sizes, z) if len(x) >= LINES_FROM else None
    with np.errstate(all="ignore"):
        left = np.arange(len(x)) if lines is None else _by_lines(lines, (x, y, z), result)
    for start in range(0, len(left), CHUNK):
        rest = left[start : start + CHUNK]
        rows = np.empty((len(rest), 7))
        rows[:, :4], rows[:, 4], rows[:, 5], rows[:, 6] = sizes, x[rest], y[rest], z[rest]
        result[rest] = positions(rows)
    return result


def fill_valid_scene(
    sizes: Sizes,  # noqa: ARG001
    columns: Columns,  # noqa: ARG001
    out: Positions,  # noqa: ARG001
    threads: int | None = None,  # noqa: ARG001
    axis: Axis | None = None,  # noqa: ARG001
) -> bool:
    """As classify.Kernel has it; never, because nothing is gained here."""
    return False


def prepared(sizes: Sizes, like: Columns, axis: Axis | None = None) -> bytes:  # noqa: ARG001
    """As classify.Kernel has it; nothing is kept."""
    return b""


def answer_rows(rows: Rows, question: Question, threads: int | None = None) -> tuple[Positions, int]:  # noqa: ARG001
    """As classify.Kernel has it; always one thread."""
    return _answers(positions(rows), question)


def answer_scene(
    sizes: Sizes,
    columns: Columns,
    question: Question,
    threads: int | None = None,  # noqa: ARG001 - numpy holds the interpreter too often for threads to pay
    axis: Axis | None = None,
) -> tuple[Positions, int]:
    """As classify.Kernel has it; always one thread."""
    return _answers(positions_of_scene(sizes, *columns, axis), question)


def answer_ways(rows: Rows, threads: int | None = None) -> tuple[Positions, Floats]:  # noqa: ARG001
    """As classify.Kernel has it, by the positions at both ends alone: it cannot say where these are clear and alike."""
    axis = [*range(len(WAYS.upright), rows.shape[1])]
    start, end = (positions(rows[:, [0, 1, 2, 3, *centre, *axis]]) for centre in ((4, 5, 6), (7, 8, 9)))
    hits = np.where((start == 0) | (start != end), 1, CANNOT_SAY).astype(np.int8)
    hits[invalid(rows, WAYS)] = REFUSED
    return hits, np.where((start == 0) & (hits == 1), 0.0, np.nan)


def _answers(found: Positions, question: Question) -> tuple[Positions, int]:
    refused = int(np.count_nonzero(found == REFUSED))
    if question == "position":
        return found, refused
    yes = (found == POSITION_OF[question]).astype(np.int8)
    if refused:
        yes[found == REFUSED] = REFUSED
    return yes, refused


class Buffers(Generic[Number]):
    """Memory for the intermediate values of one chunk, used again for every chunk."""

    def __init__(self, counts: tuple[int, int], rows: int, number: type[Number]) -> None:
        self._numbers: list[NDArray[Number]] = [np.empty(rows, dtype=number) for _ in range(counts[0])]
        self._truths: list[Mask] = [np.empty(rows, dtype=np.bool_) for _ in range(counts[1])]
        self._rows = rows

    def of(self, rows: int) -> tuple[list[NDArray[Number]], list[Mask]]:
        """Arrays for a chunk of so many rows."""
        if rows == self._rows:
            return self._numbers, self._truths
        return [each[:rows] for each in self._numbers], [each[:rows] for each in self._truths]


def _by_lines(lines: SceneLines, columns: Columns, result: Positions) -> Indices:
    """Fill in what the scene's half planes prove, and return the places of the rest."""
    numbers, truths = chunks.PLANE_BUFFERS[0] + chunks.PARALLEL_LINES_BUFFERS[0], chunks.PARALLEL_LINES_BUFFERS[1]
    singles = Buffers((numbers, truths), LINES_CHUNK, np.float32)
    doubles = Buffers(chunks.TWO_LINES_BUFFERS, LINES_CHUNK, np.float64)
    left: list[Indices] = []
    few_left = True
    for start in range(0, len(result), LINES_CHUNK):
        x, y, z = (column[start : start + LINES_CHUNK] for column in columns)
        answers, rest = result[start : start + LINES_CHUNK], None
        if few_left and lines.parallel is not None:
            rest = _by_parallel_lines(lines.parallel, (x, y, z), singles, answers)
            few_left = rest is None or len(rest) <= TOO_MANY_LEFT
        if rest is None:
            rest = _by_two_lines(lines.two, (x, y, z), doubles, answers)
        if len(rest):
            left.append(rest + start)
    return np.concatenate(left) if left else np.empty(0, dtype=np.intp)


def _by_parallel_lines(
    constants: dict[str, float], columns: Columns, buffers: Buffers[np.float32], result: Positions
) -> Indices | None:
    """The same for one chunk, in single precision; None, and nothing is filled in, where a centre has no room in it."""
    numbers, truths = buffers.of(len(result))
    R, T = chunks.plane(*columns, numbers[: chunks.PLANE_BUFFERS[0]])
    if not (np.maximum.reduce(T) <= constants["reach"] and np.maximum.reduce(R) < CAP_OF_SINGLES):  # so with NaN
        return None
    found = chunks.parallel_lines(R, T, constants, numbers[chunks.PLANE_BUFFERS[0] :], truths)
    return _filled_in(*found, result)


def _by_two_lines(
    constants: dict[str, float], columns: Columns, buffers: Buffers[np.float64], result: Positions
) -> Indices:
    sums, exterior, interior, decided = chunks.two_lines(*columns, constants, *buffers.of(len(result)))
    rest = _filled_in(exterior, interior, decided, result)
    return rest if sums.max() < CAP else np.arange(len(result))  # so with NaN


def _filled_in(exterior: Mask, interior: Mask, decided: Mask, result: Positions) -> Indices:
    np.subtract(exterior.view(np.int8), interior.view(np.int8), out=result)
    return np.flatnonzero(np.logical_not(decided, out=decided))


def _certified(rows: Rows, buffers: Buffers[np.float64], result: Positions) -> None:
    """Fill in the positions of one chunk of rows."""
    alpha, gamma, b, d, x, y, z = np.ascontiguousarray(rows.T)
    with np.errstate(all="ignore"):
        numbers, truths = buffers.of(len(rows))
        exterior, interior, decided = chunks.certified(alpha, gamma, b, d, x, y, z, CONSTANTS, numbers, truths)
    np.subtract(exterior.view(np.int8), interior.view(np.int8), out=result)
    if decided.all():
        return
    rest = np.flatnonzero(~decided)
    refused = invalid(rows[rest])
    result[rest[refused]] = REFUSED
    for place in rest[~refused]:
        result[place] = integers.position(Pair.from_row(rows[place].tolist()).lengths)
