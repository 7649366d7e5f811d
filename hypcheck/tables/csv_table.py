"""Comma-separated tables (RFC 4180): seven columns found by name, every row kept as it was written; and flights.

A row's own text goes to the output untouched, with four cells added, so all other columns stay as they are. Blank lines
are left out; line ends become those of the header; a byte order mark stays.

A table of flights has the corners of polylines, a row each, with the columns x, y, z. More columns may say the heading,
and the mover's axis, on the segment that begins at a corner, and with `flight` which rows belong together. Other
columns are not read.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import chain, islice, tee
from operator import itemgetter
from typing import NoReturn

import numpy as np

from hypcheck.errors import InputError, NothingJudgedError
from hypcheck.geometry.pair import AXIS, CENTER, NO_DIRECTION
from hypcheck.geometry.rows import Floats, Layout, Rows
from hypcheck.tables.chunk import (
    CHUNK,
    Answers,
    Cell,
    RowPlaces,
    Sink,
    Table,
    TableChunk,
    UnreadChunk,
    check_names,
    columns_of,
    layout_of,
    read_values,
    valid_rows,
    with_answers,
)
from hypcheck.tables.numbers import CHARACTERS, is_number, number_of_text, shown
from hypcheck.tables.streams import BYTE_ORDER_MARK, Reader, TextBlock, TextLines, Writer, open_input


class _Records:
    """The records of a CSV text; `text` is the last record as it was written, `line` the line where it begins."""

    def __init__(self, reader: Reader) -> None:
        self.name = reader.name
        self.line = 0
        self.text = ""
        self._lines = TextLines(reader)
        lines = self._lines.each
        first = next(lines, "")
        self.byte_order_mark = BYTE_ORDER_MARK if first.startswith(BYTE_ORDER_MARK) else ""
        # The parser reads one copy of the lines; the lines that it took for a record are then taken from the other.
        parsed, self._written = tee(chain([first.removeprefix(BYTE_ORDER_MARK)], lines))
        self._parser = csv.reader(parsed, strict=True)
        self._lines_taken = 0
        self._lines_skipped = 0

    @property
    def at_block(self) -> bool:
        """Whether the next records may be a block."""
        return self._lines.at_block(self._lines_taken)

    def block(self) -> TextBlock | None:
        """Return the next block if it has no quotes, so that every line is a record; else None."""
        block = self._lines.block(self._lines_taken, avoiding=b'"')
        if block is not None:
            self._lines_taken += block.count
            self._lines_skipped += block.count
        return block

    def next(self) -> list[str] | None:
        """Read the cells of the next record that is not blank, None at the end. Raises InputError on broken quoting."""
        while (record := self._parsed()) is not None:
            begin, self._lines_taken = self._lines_taken, self._lines_skipped + self._parser.line_num
            self.line = begin + 1
            count = self._lines_taken - begin
            self.text = next(self._written) if count == 1 else "".join(islice(self._written, count))
            if len(record) > 1 or (record and not record[0].isspace()):
                return record
        return None

    def _parsed(self) -> list[str] | None:
        """Parse the next record; None at the end. Raises InputError on broken quoting."""
        try:
            return next(self._parser, None)
        except csv.Error as error:
            where = f"{self.name}, line {self._lines_taken + 1}"
            raise InputError(f"{where}: {_explained(str(error))}") from None


def _explained(error: str) -> str:
    """Say an error of the csv module in plain words."""
    if "field larger" in error:
        return f"a cell is longer than {csv.field_size_limit()} characters; a quote may have been left open"
    if "unexpected end of data" in error:
        return "the text ends inside quotes that begin here; the file may have been cut off"
    if "new-line character" in error:
        return "a row has a carriage return in it; lines must end with LF or CRLF"
    return f"{error}; a cell in quotes must end with a quote and a comma"


def read_csv(reader: Reader, *, mark: bool) -> Table:
    """Open the table in `reader`. Raises InputError: now about the header, about a row while the chunks are read.

    With `mark` a row whose value is not a number, or not allowed, is marked as refused; a row with too few or too many
    cells is an error all the same.
    """
    records = _Records(reader)
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
    columns = columns_of(names)
    chunks = _chunks(records, len(names), {column: names.index(column) for column in columns}, mark=mark)
    return Table(chunks, records.byte_order_mark + text.rstrip("\r\n"), line_end, columns)


@contextmanager
def write_csv(writer: Writer, table: Table) -> Iterator[Sink]:
    """Write rows with four or five cells more: a row's own text if the table has text, else its numbers."""
    end = table.line_end
    header = table.header if table.header is not None else ",".join(table.columns)
    writer.write(f"{header},{','.join(table.added)}{end}".encode())
    yield Sink(partial(_render, end), writer.write)


def _render(end: str, chunk: TableChunk, answers: Answers) -> bytes:
    """Write the rows of a chunk with their answers as CSV."""
    texts = chunk.texts if chunk.texts is not None else [",".join(map(repr, row)) for row in chunk.rows.tolist()]
    return with_answers(texts, answers, _cell_text, [","] * len(answers.names), end)


def _cell_text(cell: Cell) -> str:
    """Write an added cell as CSV; None is empty."""
    return "" if cell is None else str(cell).lower()


def _chunks(records: _Records, width: int, places_of: Mapping[str, int], *, mark: bool) -> Iterator[UnreadChunk]:
    """Yield the chunks of a table, plain blocks as a whole. Raises InputError, NothingJudgedError without rows."""
    columns, pick = tuple(places_of), itemgetter(*places_of.values())
    count = 0
    while True:
        while (block := records.block()) is not None:
            places = RowPlaces(records.name, count, range(block.first, block.first + block.count))
            yield partial(_chunk_of_block, block, width, pick, places, columns, mark=mark)
            count += block.count
        lines: list[int] = []
        cells: list[tuple[str, ...]] = []
        texts: list[str] = []
        places = RowPlaces(records.name, count, lines)
        while len(texts) < CHUNK and (record := records.next()) is not None:
            lines.append(records.line)
            if len(record) != width:
                yield partial(_broken, cells, texts, places, record, width, columns, mark=mark)
                return
            cells.append(pick(record))
            texts.append(records.text.rstrip("\r\n"))
            if records.at_block:
                break
        if not texts:
            break
        yield partial(_chunk, cells, texts, places, columns, mark=mark)
        count += len(texts)
    if count == 0:
        raise NothingJudgedError(f"{records.name} has no rows below its header; nothing was answered")


def _chunk_of_block(
    block: TextBlock,
    width: int,
    pick: Callable[[list[str]], tuple[str, ...]],
    places: RowPlaces,
    columns: Sequence[str],
    *,
    mark: bool,
) -> TableChunk:
    """Read the rows of a block that has no quotes, so that every comma in it separates two cells.

    `pick` takes the cells of the wanted columns; `mark` is as in read_csv.
    """
    texts = block.plain_lines()
    records = [text.split(",") for text in texts]
    for index, record in enumerate(records):
        if len(record) != width:
            _broken([pick(good) for good in records[:index]], texts, places, record, width, columns, mark=mark)
    return _chunk(list(map(pick, records)), texts, places, columns, mark=mark)


def _broken(
    cells: Sequence[tuple[str, ...]],
    texts: list[str],
    places: RowPlaces,
    record: list[str],
    width: int,
    columns: Sequence[str],
    *,
    mark: bool,
) -> NoReturn:
    """Raise InputError about the first invalid row, or else about the record of another width after these rows."""
    _chunk(cells, texts, places, columns, mark=mark)
    noun = "cell" if len(record) == 1 else "cells"
    raise InputError(f"{places.of(len(cells))}: {len(record)} {noun}; the header has {width}")


def _chunk(
    cells: Sequence[tuple[str, ...]], texts: list[str], places: RowPlaces, columns: Sequence[str], *, mark: bool
) -> TableChunk:
    """Make a chunk of the cells of rows; read them one by one if they are not all valid."""
    layout = layout_of(columns)
    rows = _rows_if_valid(cells, columns, layout)
    if rows is not None:
        return TableChunk(rows, np.zeros(len(rows), dtype=np.bool_), texts, layout)
    named = (dict(zip(columns, row, strict=True)) for row in cells)
    return TableChunk(*read_values(named, number_of_text, places, mark=mark, layout=layout), texts, layout)


def _rows_if_valid(cells: Sequence[tuple[str, ...]], columns: Sequence[str], layout: Layout) -> Rows | None:
    """Return the rows if all of them are valid, else None."""
    flat = list(chain.from_iterable(cells))
    if "".join(flat).encode().translate(None, CHARACTERS):
        return None
    try:
        numbers = np.fromiter(map(float, flat), dtype=np.float64, count=len(flat))
    except ValueError:
        return None
    return valid_rows(numbers, columns, layout)


HEADING, FLIGHT = "heading", "flight"


@dataclass(frozen=True)
class FlightTable:
    """Flights of a file: the name and the `paths`, corners (T, 3), of each, and headings and axes of all segments.

    `headings` (n,) and `axes` (n, 3) are None where the file has none.
    """

    names: list[str]
    paths: list[Rows]
    headings: Floats | None
    axes: Rows | None


def read_flights(path: str) -> FlightTable:
    """Read the flights of a CSV file, or of standard input for "-". Raises InputError naming the line."""
    with open_input(path) as reader:
        records = _Records(reader)
        header = [cell.strip() for cell in records.next() or []]
        columns = _flight_columns(header, reader.name)
        values, groups = [], []
        while (cells := records.next()) is not None:
            values.append(_numbers(cells, header, columns, f"{reader.name}, line {records.line}"))
            groups.append(cells[header.index(FLIGHT)].strip() if FLIGHT in header else "")
    if not values:
        raise InputError(f"{reader.name} has no rows; a flight needs one at least")
    return _split(np.array(values), columns, groups)


def _flight_columns(header: list[str], name: str) -> list[str]:
    """Return the columns of numbers that are read. Raises InputError."""
    if not header:
        raise InputError(f"{name} is empty; its first line must name the columns {', '.join(CENTER)}")
    twice = next((title for title in header if title and header.count(title) > 1), None)
    if twice is not None:
        raise InputError(f"{name}: duplicate column {shown(twice)}")
    wanted = (*CENTER, *(AXIS if set(AXIS) & set(header) else ()))
    missing = [title for title in wanted if title not in header]
    if missing:
        raise InputError(
            f"{name}: the first line has no column {', '.join(missing)}; a flight needs {', '.join(CENTER)}, and an "
            f"axis {', '.join(AXIS)}"
        )
    return [*wanted, *([HEADING] if HEADING in header else [])]


def _numbers(cells: list[str], header: list[str], columns: list[str], where: str) -> list[float]:
    """Read the numbers of a flight's row. Raises InputError."""
    if len(cells) != len(header):
        raise InputError(f"{where}: there are {len(cells)} cells; there must be {len(header)}, as in the first line")
    try:
        numbers = [number_of_text(title, cells[header.index(title)]) for title in columns]
    except ValueError as trouble:
        raise InputError(f"{where}: {trouble}") from None
    axis = numbers[len(CENTER) : len(CENTER) + len(AXIS)]
    if AXIS[0] in columns and not any(axis):
        raise InputError(f"{where}: {NO_DIRECTION}")
    return numbers


def _split(values: Rows, columns: list[str], groups: list[str]) -> FlightTable:
    """Split rows into flights; the rows of a flight follow each other."""
    begins = [place for place, group in enumerate(groups) if place == 0 or group != groups[place - 1]]
    spans = list(zip(begins, [*begins[1:], len(groups)], strict=True))
    segments = [place for begin, end in spans for place in range(begin, max(end - 1, begin + 1))]
    beside = values[segments]
    return FlightTable(
        [groups[begin] for begin, _ in spans],
        [values[begin:end, : len(CENTER)] for begin, end in spans],
        beside[:, -1] if HEADING in columns else None,
        beside[:, len(CENTER) : len(CENTER) + len(AXIS)] if AXIS[0] in columns else None,
    )
