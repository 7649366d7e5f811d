"""The kernel in numpy: the stages of the compiled one over chunks, with the arithmetic printed from the same programs.

half planes of the scene     printed/chunks.py plane and parallel_lines, in single precision; where these leave too
                             many rows, two_lines; scene_lines.py makes their constants
discriminant and its bound   printed/chunks.py certified
integers                     integers.py

Tilted rows of ten have a stage in floats, printed/tilted.py. It proves an answer with a multiplier, an argument of the
dual function. Any multiplier is safe, and a good one leaves fewer rows to integers.py.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS, REFUSED, TILTED_COLUMNS, Axis, Pair, Position, Sizes
from hypcheck.geometry.rows import (
    CANNOT_SAY,
    PAIRS,
    SWEEPS,
    Columns,
    Floats,
    Indices,
    Mask,
    Positions,
    Rows,
    invalid,
    parts_of,
    tilted_rows,
    upright_mask,
)
from hypcheck.kernel import integers, scene_lines
from hypcheck.kernel.choice import Question, answers_to
from hypcheck.kernel.printed import chunks, tilted
from hypcheck.kernel.programs.certified import CONSTANTS
from hypcheck.kernel.programs.lines import CAP
from hypcheck.kernel.programs.lines import FLOAT32_CAP as CAP_OF_SINGLES
from hypcheck.kernel.programs.tilted import CONSTANTS as TILTED_CONSTANTS
from hypcheck.kernel.scene_lines import SceneLines

CHUNK = 8192
"""How many rows are computed at a time: the buffers of a chunk stay in the cache, and the calls of ufuncs are few."""

LINES_CHUNK = 1 << 15
"""How many rows the lines get at a time: they need fewer buffers, and smaller ones."""

LINES_FROM = 1 << 14
"""A scene's half planes are made if there are at least so many centres: fewer do not repay that."""

TOO_MANY_LEFT = LINES_CHUNK // 100
"""If one line for each side leaves more rows of a chunk, two lines are used from then on."""

TILTED_CHUNK = 2048
"""How many tilted rows are computed at a time: some ninety buffers of a chunk stay in the cache."""

_TURNS, _SETTLED = 8, 1e-6
"""The most steps of Newton's method, and the relative change at which it ends: as in core/parts/platform.h."""


Number = TypeVar("Number", np.float32, np.float64)


def positions(rows: Rows) -> Positions:
    """Return the exact position of every row, int8 (n,), 127 for invalid ones.

    Rows are float64 (n, 7) or (n, 10) as in geometry/rows.py.
    """
    if PAIRS.has_axis(rows):
        return _positions_of_ten(rows)
    result = np.empty(len(rows), dtype=np.int8)
    buffers = Buffers(chunks.CERTIFIED_BUFFERS, min(CHUNK, len(rows)), np.float64)
    for start in range(0, len(rows), CHUNK):
        part = rows[start : start + CHUNK]
        _certified(part, buffers, result[start : start + CHUNK])
    return result


def _positions_of_ten(rows: Rows) -> Positions:
    """Return the exact positions of rows of ten, 127 for invalid ones."""
    result = np.empty(len(rows), dtype=np.int8)
    upright = upright_mask(rows)
    tilted_places = np.flatnonzero(~upright)
    for start in range(0, len(tilted_places), TILTED_CHUNK):
        part = tilted_places[start : start + TILTED_CHUNK]
        result[part] = _tilted_positions(rows[part])
    if upright.any():
        answers = positions(rows[upright, : len(COLUMNS)])
        answers[invalid(rows[upright])] = REFUSED
        result[upright] = answers
    return result


def positions_of_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats, axis: Axis | None = None) -> Positions:
    """Return the exact position of every centre (x, y, z), float64 (n,) each, for valid α, γ, b, d and axis; int8 (n,).

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
        left = np.arange(len(x)) if lines is None else by_lines(lines, (x, y, z), result)
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
    """As in_use.Kernel has it; never, because nothing is gained here."""
    return False


def prepared(sizes: Sizes, like: Columns, axis: Axis | None = None) -> bytes:  # noqa: ARG001
    """As in_use.Kernel has it; nothing is kept."""
    return b""


def answer_rows(rows: Rows, question: Question, threads: int | None = None) -> tuple[Positions, int]:  # noqa: ARG001
    """As in_use.Kernel has it; always one thread."""
    return _answers(positions(rows), question)


def answer_scene(
    sizes: Sizes,
    columns: Columns,
    question: Question,
    threads: int | None = None,  # noqa: ARG001 - numpy holds the interpreter too often for threads to pay
    axis: Axis | None = None,
) -> tuple[Positions, int]:
    """As in_use.Kernel has it; always one thread."""
    return _answers(positions_of_scene(sizes, *columns, axis), question)


def answer_ended(rows: Rows, threads: int | None = None) -> Positions:
    """As in_use.Kernel has it: by the position without ends and the spheroid's greatest reach up and down.

    A difference that is rounded lies on the same side of r as the exact one, or is r, because r is a float64.
    """
    refused = invalid(rows)
    whole, _ = answer_rows(np.ascontiguousarray(rows[:, : len(TILTED_COLUMNS)]), "position", threads)
    lengths, _, heights = parts_of(rows)
    z, r, ends = lengths[:, 6:7], lengths[:, 2:4].max(axis=1, keepdims=True), heights[:, :2]
    with np.errstate(over="ignore", invalid="ignore"):  # what is no number compares false
        depth = (z - ends) * (1, -1)
        between, beyond = (depth > r).all(axis=1), (depth < -r).any(axis=1)
    beyond |= (whole == Position.EXTERIOR) & (heights[:, 2] != 0)
    positions = np.where(between, whole, CANNOT_SAY)
    positions[beyond] = Position.EXTERIOR
    positions[refused] = REFUSED
    return positions.astype(np.int8)


def answer_sweeps(rows: Rows) -> tuple[Positions, Floats]:
    """As in_use.Kernel.answer_sweeps, but only from the ends: the answer is 2 if both are clear and equal.

    Through an opening a sweep may change its side without contact.
    """
    others = [*range(len(SWEEPS.upright), rows.shape[1])]
    both = (np.ascontiguousarray(rows[:, [0, 1, 2, 3, *centre, *others]]) for centre in ((4, 5, 6), (7, 8, 9)))
    start, end = (answer_ended(ends) if SWEEPS.has_heights(rows) else positions(ends) for ends in both)
    hit = (start == 0) | (end == 0)
    sure = (start != CANNOT_SAY) & (end != CANNOT_SAY) & ((rows[:, -1] != 0) if SWEEPS.has_heights(rows) else True)
    hits = np.where(hit | (sure & (start != end)), 1, CANNOT_SAY).astype(np.int8)
    hits[invalid(rows, SWEEPS)] = REFUSED
    return hits, np.where((start == 0) & (hits == 1), 0.0, np.nan)


def _answers(known: Positions, question: Question) -> tuple[Positions, int]:
    """Return the answers to a question from positions, and how many rows are invalid."""
    return answers_to(question, known), int(np.count_nonzero(known == REFUSED))


class Buffers(Generic[Number]):
    """Memory for the intermediate values of one chunk, used again for every chunk."""

    def __init__(self, counts: tuple[int, int], rows: int, number: type[Number]) -> None:
        self._numbers: list[NDArray[Number]] = [np.empty(rows, dtype=number) for _ in range(counts[0])]
        self._truths: list[Mask] = [np.empty(rows, dtype=np.bool_) for _ in range(counts[1])]
        self._rows = rows

    def of(self, rows: int) -> tuple[list[NDArray[Number]], list[Mask]]:
        """Return arrays for a chunk of so many rows."""
        if rows == self._rows:
            return self._numbers, self._truths
        return [buffer[:rows] for buffer in self._numbers], [buffer[:rows] for buffer in self._truths]


def by_lines(lines: SceneLines, columns: Columns, result: Positions) -> Indices:
    """Fill in the answers that the scene's half planes prove, and return the places of the other rows."""
    numbers, truths = chunks.PLANE_BUFFERS[0] + chunks.PARALLEL_LINES_BUFFERS[0], chunks.PARALLEL_LINES_BUFFERS[1]
    singles = Buffers((numbers, truths), LINES_CHUNK, np.float32)
    doubles = Buffers(chunks.TWO_LINES_BUFFERS, LINES_CHUNK, np.float64)
    left: list[Indices] = []
    few_left = True
    for start in range(0, len(result), LINES_CHUNK):
        x, y, z = (column[start : start + LINES_CHUNK] for column in columns)
        answers, rest = result[start : start + LINES_CHUNK], None
        if few_left and lines.parallel is not None:
            rest = by_parallel_lines(lines.parallel, (x, y, z), singles, answers)
            few_left = rest is None or len(rest) <= TOO_MANY_LEFT
        if rest is None:
            rest = by_two_lines(lines.two, (x, y, z), doubles, answers)
        if len(rest):
            left.append(rest + start)
    return np.concatenate(left) if left else np.empty(0, dtype=np.intp)


def by_parallel_lines(
    constants: dict[str, float], columns: Columns, buffers: Buffers[np.float32], result: Positions
) -> Indices | None:
    """As by_lines for one chunk, in single precision; None, with nothing filled in, if a centre is too large."""
    numbers, truths = buffers.of(len(result))
    R, T = chunks.plane(*columns, numbers[: chunks.PLANE_BUFFERS[0]])
    if not (np.maximum.reduce(T) <= constants["reach"] and np.maximum.reduce(R) < CAP_OF_SINGLES):  # so with NaN
        return None
    decided = chunks.parallel_lines(R, T, constants, numbers[chunks.PLANE_BUFFERS[0] :], truths)
    return _filled_in(*decided, result)


def by_two_lines(
    constants: dict[str, float], columns: Columns, buffers: Buffers[np.float64], result: Positions
) -> Indices:
    """Fill in the answers that two lines a side prove, in double precision, and return the places of the other rows."""
    sums, exterior, interior, decided = chunks.two_lines(*columns, constants, *buffers.of(len(result)))
    rest = _filled_in(exterior, interior, decided, result)
    return rest if sums.max() < CAP else np.arange(len(result))  # so with NaN


def _filled_in(exterior: Mask, interior: Mask, decided: Mask, result: Positions) -> Indices:
    """Fill in the answers that floats decide in a chunk, and return the places of the other rows. Changes `decided`."""
    np.subtract(exterior.view(np.int8), interior.view(np.int8), out=result)
    return np.flatnonzero(np.logical_not(decided, out=decided))


def _certified(rows: Rows, buffers: Buffers[np.float64], result: Positions) -> None:
    """Fill in the positions of one chunk of rows."""
    alpha, gamma, b, d, x, y, z = np.ascontiguousarray(rows.T)
    with np.errstate(all="ignore"):
        numbers, truths = buffers.of(len(rows))
        exterior, interior, decided = chunks.certified(alpha, gamma, b, d, x, y, z, CONSTANTS, numbers, truths)
    rest = _filled_in(exterior, interior, decided, result)
    _by_integers(rows, rest, result, lambda row: integers.upright_position(Pair.from_row(row).lengths))


def _by_integers(rows: Rows, places: Indices, result: Positions, position: Callable[[list[float]], Position]) -> None:
    """Fill in the positions at the places that floats leave, 127 for invalid rows."""
    if len(places):
        refused = invalid(rows[places])
        result[places[refused]] = REFUSED
        for place in places[~refused]:
            result[place] = position(rows[place].tolist())


def _tilted_positions(rows: Rows) -> Positions:
    """Return the positions of a chunk of rows of ten that are tilted, 127 for invalid ones."""
    result = np.empty(len(rows), dtype=np.int8)
    with np.errstate(all="ignore"):
        row = _columns_of_ten(rows)
        numbers = list(np.empty((tilted.TILTED_BUFFERS[0], len(rows))))
        truths = list(np.empty((tilted.TILTED_BUFFERS[1], len(rows)), dtype=np.bool_))
        decided = tilted.tilted(*row, _multiplier(row), TILTED_CONSTANTS, numbers, truths)
    _by_integers(rows, _filled_in(*decided, result), result, integers.position)
    return result


def multipliers(rows: Rows) -> Floats:
    """Return rough multipliers (n,), in squares of b, at which the dual functions of rows (n, 10) are greatest."""
    return _multiplier(_columns_of_ten(rows))


TenColumns = tuple[Floats, Floats, Floats, Floats, Floats, Floats, Floats, Floats, Floats, Floats]


def _columns_of_ten(rows: Rows) -> TenColumns:
    """Return the columns, (n,) each, with scaled axes."""
    alpha, gamma, b, d, x, y, z, *axis = np.ascontiguousarray(rows.T)
    return alpha, gamma, b, d, x, y, z, *_scaled(np.stack(axis))


def _scaled(axes: Floats) -> tuple[Floats, Floats, Floats]:
    """Return axes (3, n) times powers of two, with the largest number in [1/2, 1); NaN where that is not exact."""
    exponents = np.frexp(np.abs(axes).max(axis=0))[1]
    scaled = np.ldexp(axes, -exponents)
    scaled[:, (np.ldexp(scaled, exponents) != axes).any(axis=0)] = np.nan
    vx, vy, vz = scaled
    return vx, vy, vz


def _multiplier(row: TenColumns) -> Floats:
    """Return rough multipliers at which the dual functions are greatest; core/parts/tilted_level.h explains how."""
    form = tilted.tilted_form(*row, list(np.empty((tilted.TILTED_FORM_BUFFERS[0], len(row[0])))))
    p, s, t, k0, k1, m, radius, height, cross_squared, level = form
    P1 = np.fmax(cross_squared / level, 0)  # 0/0 is 0: the axis is tilted by less than 2⁻⁵⁰⁰
    root = np.sqrt(k1 * k1 + 4 * k0 * t)
    larger = 0.5 * (np.abs(k1) + root)
    one_pole, other_pole, rising = larger / t, k0 / larger, k1 >= 0
    B, A2 = np.where(rising, one_pole, other_pole), np.where(rising, other_pole, one_pole)
    G, m_plane = s * (radius - P1) - p * height, m - t * P1
    a1, a2, b = p * P1, A2 * np.abs(G + A2 * m_plane) / root, B * np.abs(B * m_plane - G) / root
    least, greatest = -0.999 * np.minimum(p, A2), 0.999 * B
    multiplier: Floats = np.zeros_like(p)
    for _ in range(_TURNS):
        i1, i2, i3 = 1 / (p + multiplier), 1 / (A2 + multiplier), 1 / (B - multiplier)
        S1, S2, T3 = a1 * i1 * i1, a2 * i2 * i2, b * i3 * i3
        S, T = S1 + S2, 1 + T3
        root_S, root_T = np.sqrt(S), np.sqrt(T)
        slope = (S1 * i1 + S2 * i2) * T * root_T + T3 * i3 * S * root_S
        moved = np.fmin(np.fmax(multiplier + (root_S - root_T) * S * T / slope, least), greatest)
        settled = np.abs(moved - multiplier) <= _SETTLED * np.abs(moved)
        multiplier = moved
        if settled.all():
            break
    return multiplier
