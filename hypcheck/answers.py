"""Answers about many rows, the same as about each pair alone but without proofs; and about a whole table.

A table is answered a chunk at a time. One process reads the lines and writes the answers in order. Of a long table,
other processes read the numbers and answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager
from functools import partial

import numpy as np

from hypcheck.answer import measured_clearance, require_agreement
from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, REFUSED, TILTED_COLUMNS, Pair
from hypcheck.geometry.rows import Rows, require_valid
from hypcheck.kernel.classify import kernel
from hypcheck.processes import in_order, usable_processors
from hypcheck.tables.chunk import Table, TableAnswers, TableChunk, UnreadChunk
from hypcheck.tables.csv_table import read_csv, write_csv
from hypcheck.tables.jsonl_table import read_jsonl, write_jsonl
from hypcheck.tables.npy_table import read_npy, write_npy
from hypcheck.tables.streams import Route, reading, same_file, writing
from hypcheck.truth import exact, float_filter, nearest
from hypcheck.truth.tilted import nearest_arrays


def answers(rows: Rows) -> TableAnswers:
    """Position, tangency and clearance of every row; float64 (n, 7) or (n, 10) in, (n,) each out.

    Raises InputError about the first invalid row, DisagreementError if two oracles disagree about a row.
    """
    if rows.shape[1] == len(TILTED_COLUMNS):
        return _answers_of_ten(rows)
    measured = nearest.clearances(rows)
    # The filter never proves a tangency: λ proves a gap, and two points of the spheroid strictly on either side of the
    # hyperboloid prove that it passes through the spheroid's inside.
    positions = float_filter.filtered(rows)
    tangent = np.zeros(len(rows), dtype=np.bool_)
    for index in np.flatnonzero(positions == float_filter.UNDECIDED).tolist():
        decision = exact.decide(Pair.from_row(rows[index].tolist()).lengths)
        positions[index], tangent[index] = decision.position, decision.tangent
    doubtful = (measured.position != positions) | ((measured.clearance == 0) != tangent)
    for index in np.flatnonzero(doubtful).tolist():
        require_agreement(
            tuple(rows[index].tolist()),
            (int(positions[index]), bool(tangent[index])),
            (int(measured.position[index]), float(measured.clearance[index])),
        )
    return TableAnswers(positions, tangent, measured.clearance)


def _answers_of_ten(rows: Rows) -> TableAnswers:
    """Those of rows with an axis: upright ones together; of the others pair by pair what floats leave uncertain.

    A certain row is no tangency. Its position is that of the kernel, which knows nothing of distances.
    """
    require_valid(rows)
    count = len(rows)
    found = TableAnswers(np.empty(count, dtype=np.int8), np.zeros(count, dtype=np.bool_), np.empty(count))
    leans = (rows[:, 7:9] != 0).any(axis=1) & (rows[:, 2] != rows[:, 3])
    if not leans.all():
        upright = answers(rows[~leans][:, : len(COLUMNS)])
        found.positions[~leans], found.tangent[~leans] = upright.positions, upright.tangent
        found.clearance[~leans] = upright.clearance
    measured, places = nearest_arrays.distances(rows[leans]), np.flatnonzero(leans)
    certain = places[measured.certain]
    found.positions[certain] = kernel().answer_rows(rows[certain], "position", 1)[0]
    found.tangent[certain], found.clearance[certain] = False, measured.clearance[measured.certain]
    sides = measured.position[measured.certain]
    for place in np.flatnonzero(found.positions[certain] != sides).tolist():
        index = int(certain[place])
        require_agreement(
            tuple(rows[index].tolist()),
            (int(found.positions[index]), False),
            (int(sides[place]), float(found.clearance[index])),
        )
    for index in places[~measured.certain].tolist():
        pair = Pair.from_row(rows[index].tolist())
        decision = exact.decide(pair.lengths)
        found.positions[index], found.tangent[index] = decision.position, decision.tangent
        found.clearance[index] = measured_clearance(pair, decision)
    return found


_READ = {"csv": read_csv, "jsonl": read_jsonl, "npy": read_npy}
_WRITE = {"csv": write_csv, "jsonl": write_jsonl, "npy": write_npy}

MOST_WORKERS = 4
"""Processes that answer, at most: memory stays small on any machine."""

CHUNKS_WITHOUT_WORKERS = 64
"""Chunks that this process answers itself before it starts others, which is not worth it for a short table."""

Advance = Callable[[int, int], object]
"""Takes note of so many bytes read and so many rows answered."""


@contextmanager
def _no_progress(_size: int | None) -> Iterator[Advance]:
    yield lambda _bytes, _rows: None


def classify_table(
    route: Route,
    *,
    mark: bool,
    watch: Callable[[int | None], AbstractContextManager[Advance]] = _no_progress,
    workers: int | None = None,
    alone: int = CHUNKS_WITHOUT_WORKERS,
) -> None:
    """Write the answers about every row of the table at `route.source` to `route.target`.

    `watch` is given the length of the source in bytes (None for a stream), and yields what takes note of progress. A
    row that is no valid query raises InputError, or with `mark` is marked as refused (127). `workers` processes answer;
    None: one for each processor. This process answers the first `alone` chunks itself.

    The output appears when it is complete. After an error, the target is as it was before. Raises InputError if a file
    cannot be opened, read or written, NothingJudgedError if the table has no rows, and what answers() raises.
    """
    if same_file(route.source, route.target):
        raise InputError(f"--output {route.target} is the input itself; name another file")
    many = min(MOST_WORKERS, usable_processors()) if workers is None else workers
    with reading(route.source, patient=True) as reader:
        table = _READ[route.source_format](reader, mark=mark)
        with (
            writing(route.target) as writer,
            _WRITE[route.target_format](writer, table) as sink,
            watch(reader.size()) as advance,
            closing(
                in_order(partial(_answer_chunk, sink.render), table.chunks, many, _alone(table, alone))
            ) as rendered,
        ):
            noted = 0
            for data, rows in rendered:
                sink.add(data)
                advance(reader.taken - noted, rows)
                noted = reader.taken


def _alone(table: Table, alone: int) -> int:
    """Chunks that this process answers before it starts others: to a row that may lean, a process is soon worth it."""
    return alone if table.columns == COLUMNS else 1


def _answer_chunk(render: Callable[[TableChunk, TableAnswers], bytes], unread: UnreadChunk) -> tuple[bytes, int]:
    """What is written about a chunk, and how many rows it has."""
    chunk = unread()
    return render(chunk, _answers_of_chunk(chunk)), len(chunk.rows)


def _answers_of_chunk(chunk: TableChunk) -> TableAnswers:
    """The answers about a chunk of a table, 127 for its refused rows. Raises DisagreementError as answers()."""
    if not chunk.refused.any():
        return answers(chunk.rows)
    valid = ~chunk.refused
    found, count = answers(chunk.rows[valid]), len(chunk.rows)
    positions, tangent = np.full(count, REFUSED, dtype=np.int8), np.zeros(count, dtype=np.bool_)
    clearance = np.full(count, np.nan)
    positions[valid], tangent[valid], clearance[valid] = found.positions, found.tangent, found.clearance
    return TableAnswers(positions, tangent, clearance)
