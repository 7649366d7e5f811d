"""Answers about many rows, equal to those about single pairs but without proofs; and about a whole table.

A table is answered a chunk at a time. One process reads the lines and writes the answers in order. Of a long table,
other processes read the numbers and answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hypcheck.answer import ended_clearance_of, require_agreement
from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, REFUSED, TILTED_COLUMNS, Pair
from hypcheck.geometry.rows import PAIRS, Mask, Positions, Rows, require_valid, upright_mask
from hypcheck.kernel.classify import classify
from hypcheck.kernel.in_use import kernel
from hypcheck.processes import in_order, usable_processors
from hypcheck.tables import Route
from hypcheck.tables.chunk import Answers, SweepAnswers, Table, TableAnswers, TableChunk, UnreadChunk
from hypcheck.tables.csv_table import read_csv, write_csv
from hypcheck.tables.jsonl_table import read_jsonl, write_jsonl
from hypcheck.tables.npy_table import read_npy, write_npy
from hypcheck.tables.streams import open_input, replace_output, same_file
from hypcheck.truth import exact, float_filter, nearest_rows
from hypcheck.truth.nearest import NearestStage
from hypcheck.truth.swept import passage_of_row


def answers(rows: Rows) -> TableAnswers:
    """Compute position, tangency and clearance (n,) of every row, float64 (n, 7), (n, 10) or (n, 13).

    Raises InputError about the first invalid row, DisagreementError if two oracles disagree about a row.
    """
    if PAIRS.has_heights(rows):
        return _answers_between_ends(rows)
    measured = nearest_rows.clearances(rows)
    positions, tangent = _decided(rows, measured.stage == NearestStage.DOUBLE_DOUBLE)
    doubtful = (measured.position != positions) | ((measured.clearance == 0) != tangent)
    for index in np.flatnonzero(doubtful).tolist():
        require_agreement(
            tuple(rows[index].tolist()),
            (int(positions[index]), bool(tangent[index])),
            (int(measured.position[index]), float(measured.clearance[index])),
        )
    return TableAnswers(positions, tangent, measured.clearance)


def _answers_between_ends(rows: Rows) -> TableAnswers:
    """Answer rows with heights: rows whose heights are infinite together, the others one by one."""
    require_valid(rows)
    answered = answers(np.ascontiguousarray(rows[:, : len(TILTED_COLUMNS)]))
    for index in np.flatnonzero(np.isfinite(rows[:, 10:12]).any(axis=1)).tolist():
        pair = Pair.from_row(rows[index].tolist())
        decision = exact.decide(pair.lengths)
        answered.positions[index], answered.tangent[index] = decision.position, decision.tangent
        answered.clearance[index] = ended_clearance_of(pair, decision)
    return answered


def _decided(rows: Rows, certain: Mask) -> tuple[Positions, Mask]:
    """Decide positions and tangencies without distances; return both, (n,).

    The filter never proves a tangency: λ proves a gap, and two points of the spheroid strictly on either side of the
    hyperboloid prove that it passes through the spheroid's inside. Of tilted rows the kernel decides those that are
    `certain` to be no tangencies.
    """
    positions, tangent = np.full(len(rows), float_filter.UNDECIDED, np.int8), np.zeros(len(rows), dtype=np.bool_)
    upright = upright_mask(rows)
    positions[upright] = float_filter.filtered(rows[upright, : len(COLUMNS)])
    tilted = ~upright & certain
    if tilted.any():
        positions[tilted] = kernel().answer_rows(rows[tilted], "position", 1)[0]
    for index in np.flatnonzero(positions == float_filter.UNDECIDED).tolist():
        decision = exact.decide(Pair.from_row(rows[index].tolist()).lengths)
        positions[index], tangent[index] = decision.position, decision.tangent
    return positions, tangent


_READ = {"csv": read_csv, "jsonl": read_jsonl, "npy": read_npy}
_WRITE = {"csv": write_csv, "jsonl": write_jsonl, "npy": write_npy}

MOST_WORKERS = 4
"""The most processes that answer, so that memory stays small on any machine."""

CHUNKS_WITHOUT_WORKERS = 64
"""The number of chunks that this process answers before it starts others: a short table is not worth their start."""

Advance = Callable[[int, int], object]
"""A function that is called with a number of bytes that were read and a number of rows that were answered."""


@contextmanager
def _no_progress(_size: int | None) -> Iterator[Advance]:
    """Show no progress."""
    yield lambda _bytes, _rows: None


def classify_table(
    route: Route,
    *,
    mark: bool,
    watch: Callable[[int | None], AbstractContextManager[Advance]] = _no_progress,
    workers: int | None = None,
    alone: int = CHUNKS_WITHOUT_WORKERS,
    margin: float | None = None,
) -> None:
    """Write the answers about every row of the table at `route.source` to `route.target`.

    With `margin`, a length, the answers also have the position with this margin; a table of sweeps raises InputError.

    `watch` is given the length of the source in bytes (None for a stream), and yields an Advance, a function for
    progress. A row that is not a valid query raises InputError, or with `mark` is marked as refused (127). `workers`
    processes answer; None: one for each processor. This process answers the first `alone` chunks itself.

    The output appears when it is complete. After an error, the target is as it was before. Raises InputError if a file
    cannot be opened, read or written, NothingJudgedError if the table has no rows, and what answers() raises.
    """
    if same_file(route.source, route.target):
        raise InputError(f"--output {route.target} is the input itself; name another file")
    many = min(MOST_WORKERS, usable_processors()) if workers is None else workers
    with open_input(route.source, patient=True) as reader:
        table = replace(_READ[route.source_format](reader, mark=mark), margin=margin is not None)
        with (
            replace_output(route.target) as writer,
            _WRITE[route.target_format](writer, table) as sink,
            watch(reader.size()) as advance,
            closing(
                in_order(partial(_answer_chunk, sink.render, margin), table.chunks, many, _alone(table, alone))
            ) as rendered,
        ):
            noted = 0
            for data, rows in rendered:
                sink.add(data)
                advance(reader.taken - noted, rows)
                noted = reader.taken


def _alone(table: Table, alone: int) -> int:
    """Return the number of chunks before other processes start: 1 if rows have more columns, which take longer."""
    return alone if table.columns == COLUMNS else 1


def _answer_chunk(
    render: Callable[[TableChunk, Answers], bytes], margin: float | None, unread: UnreadChunk
) -> tuple[bytes, int]:
    """Answer a chunk; return the text to write for it, and its number of rows."""
    chunk = unread()
    if chunk.layout.has_end and margin is not None:
        raise InputError("--margin is for positions; x1, y1, z1 make the rows sweeps, so leave one of them out")
    chunk_answers = _sweeps_of_chunk(chunk) if chunk.layout.has_end else _answers_of_chunk(chunk, margin)
    return render(chunk, chunk_answers), len(chunk.rows)


def _sweeps_of_chunk(chunk: TableChunk) -> SweepAnswers:
    """Answer a chunk of sweeps; the answer is 127 for its refused rows."""
    sweeps = [passage_of_row(row) for row in chunk.rows[~chunk.refused].tolist()]
    return SweepAnswers(
        _spread(chunk, [sweep.hit for sweep in sweeps], np.int8(REFUSED)),
        _spread(chunk, [sweep.first_lower for sweep in sweeps], np.nan),
        _spread(chunk, [sweep.first_upper for sweep in sweeps], np.nan),
    )


def _answers_of_chunk(chunk: TableChunk, margin: float | None) -> TableAnswers:
    """Answer a chunk of pairs; the answer is 127 for its refused rows. Raises DisagreementError as answers()."""
    rows = chunk.rows[~chunk.refused]
    valid = answers(rows)
    return TableAnswers(
        _spread(chunk, valid.positions, np.int8(REFUSED)),
        _spread(chunk, valid.tangent, np.False_),
        _spread(chunk, valid.clearance, np.nan),
        None if margin is None else _spread(chunk, classify(rows, margin=margin), np.int8(REFUSED)),
    )


def _spread(chunk: TableChunk, values: ArrayLike, otherwise: ArrayLike) -> NDArray[Any]:
    """Put the values of the valid rows of a chunk in their places, and `otherwise` in those of refused rows, (n,)."""
    spread = np.full(len(chunk.rows), otherwise)
    spread[~chunk.refused] = values
    return spread
