"""Comma-separated tables: seven columns found by name, every row kept as it was written.

A row's own text goes to the output untouched, with four cells added, so that no other column is changed in anything.
Blank lines are left out; line ends become those of the header; a byte order mark stays where it was.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import chain
from operator import itemgetter
from typing import NoReturn

import numpy as np

from hypcheck.errors import InputError, NothingJudgedError
from hypcheck.pairs import COLUMNS, REFUSED
from hypcheck.rows import Rows, invalid
from hypcheck.tables.chunk import CHUNK, LABELS, Answers, Chunk, Sink, Table, Unread
from hypcheck.tables.columns import ADDED, check_names
from hypcheck.tables.csv_records import Records
from hypcheck.tables.examine import Places, examine
from hypcheck.tables.lines import Block
from hypcheck.tables.numbers import CHARACTERS, is_number, number_of_text
from hypcheck.tables.streams import Reader, Writer


def read_csv(reader: Reader, *, mark: bool) -> Table:
    """The table in `reader`. Raises InputError: now about the header, about a row while the chunks are read.

    With `mark` a row whose value is no number, or not allowed, is marked as refused; a row with too few or too many
    cells is an error all the same.
    """
    records = Records(reader)
    header = records.next()
    if header is None:
        raise InputError(f"{reader.name} is empty; it must begin with a line of column names")
    names = [name.strip() for name in header]
    where = f"{reader.name}, line {records.line}"
    if all(map(is_number, names)):
        raise InputError(f"{where}: a row of numbers; the first line must hold the names of the columns")
    check_names(names, where)
    text = records.text
    line_end = "\r\n" if text.endswith("\r\n") else "\n"
    chunks = _chunks(records, len(names), [names.index(column) for column in COLUMNS], mark=mark)
    return Table(chunks, records.byte_order_mark + text.rstrip("\r\n"), line_end)


@contextmanager
def write_csv(writer: Writer, table: Table) -> Iterator[Sink]:
    """Rows with four cells more: a row's own text where the table has text, else its seven numbers."""
    end = table.line_end
    header = table.header if table.header is not None else ",".join(COLUMNS)
    writer.write(f"{header},{','.join(ADDED)}{end}".encode())
    yield Sink(partial(_lines, end), writer.write)


def _lines(end: str, chunk: Chunk, answers: Answers) -> bytes:
    texts = chunk.texts if chunk.texts is not None else [",".join(map(repr, row)) for row in chunk.rows.tolist()]
    added = map(_CELLS.__getitem__, zip(answers.positions.tolist(), answers.tangent.tolist(), strict=True))
    rows = zip(texts, added, map(repr, answers.clearance.tolist()), strict=True)
    lines = [f"{text}{cells}{clearance}{end}" for text, cells, clearance in rows]
    for index in np.flatnonzero(chunk.refused).tolist():
        lines[index] = f"{texts[index]},{REFUSED},{LABELS[REFUSED]},,{end}"
    return "".join(lines).encode()


_CELLS = {
    (position, tangent): f",{position},{label},{'true' if tangent else 'false'},"
    for position, label in LABELS.items()
    for tangent in (False, True)
}


def _chunks(records: Records, width: int, columns: list[int], *, mark: bool) -> Iterator[Unread]:
    pick = itemgetter(*columns)
    count = 0
    while True:
        while (block := records.block()) is not None:
            places = Places(records.name, count, range(block.first, block.first + block.count))
            yield partial(_chunk_of_block, block, width, pick, places, mark=mark)
            count += block.count
        lines: list[int] = []
        cells: list[tuple[str, ...]] = []
        texts: list[str] = []
        places = Places(records.name, count, lines)
        while len(texts) < CHUNK and (record := records.next()) is not None:
            lines.append(records.line)
            if len(record) != width:
                yield partial(_broken, cells, texts, places, record, width, mark=mark)
                return
            cells.append(pick(record))
            texts.append(records.text.rstrip("\r\n"))
            if records.at_block:
                break
        if not texts:
            break
        yield partial(_chunk, cells, texts, places, mark=mark)
        count += len(texts)
    if count == 0:
        raise NothingJudgedError(f"{records.name} has no rows below its header; nothing was asked")


def _chunk_of_block(
    block: Block, width: int, pick: Callable[[list[str]], tuple[str, ...]], places: Places, *, mark: bool
) -> Chunk:
    """Without quotes, what stands between two commas is a cell."""
    texts = block.plain_lines()
    records = [text.split(",") for text in texts]
    for index, record in enumerate(records):
        if len(record) != width:
            _broken([pick(good) for good in records[:index]], texts, places, record, width, mark=mark)
    return _chunk(list(map(pick, records)), texts, places, mark=mark)


def _broken(
    cells: Sequence[tuple[str, ...]], texts: list[str], places: Places, record: list[str], width: int, *, mark: bool
) -> NoReturn:
    """Raise InputError about the first of these rows that is bad, or about the record of another width behind them."""
    _chunk(cells, texts, places, mark=mark)
    noun = "cell" if len(record) == 1 else "cells"
    raise InputError(f"{places.of(len(cells))}: {len(record)} {noun}; the header has {width}")


def _chunk(cells: Sequence[tuple[str, ...]], texts: list[str], places: Places, *, mark: bool) -> Chunk:
    rows = _quickly(cells)
    if rows is not None:
        return Chunk(rows, np.zeros(len(rows), dtype=np.bool_), texts)
    return Chunk(*examine(cells, number_of_text, places, mark=mark), texts)


def _quickly(cells: Sequence[tuple[str, ...]]) -> Rows | None:
    """The rows where every one is good, else None."""
    flat = list(chain.from_iterable(cells))
    if "".join(flat).encode().translate(None, CHARACTERS):
        return None
    try:
        numbers = np.fromiter(map(float, flat), dtype=np.float64, count=len(flat))
    except ValueError:
        return None
    rows = numbers.reshape(len(cells), len(COLUMNS))
    return None if invalid(rows).any() else rows
