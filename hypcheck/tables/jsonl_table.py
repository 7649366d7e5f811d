"""JSON lines (RFC 8259, one object a line): seven keys found by name, every line kept as it was written.

A line's own text goes to the output unchanged except for its closing brace, before which four keys are added. Blank
lines are left out; line ends become LF.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import chain
from math import inf, isfinite
from operator import itemgetter

import numpy as np

from hypcheck.errors import InputError, NothingJudgedError
from hypcheck.geometry.pair import AXIS, COLUMNS, END, ENDS, HEIGHTS
from hypcheck.geometry.rows import PAIRS, Layout, Rows
from hypcheck.messages import json_trouble
from hypcheck.tables.chunk import (
    CHUNK,
    Answers,
    Cell,
    RowPlaces,
    Sink,
    Table,
    TableChunk,
    UnreadChunk,
    added_to,
    check_names,
    columns_of,
    layout_of,
    read_values,
    valid_rows,
    with_answers,
)
from hypcheck.tables.numbers import Literal, number_of_json, shown_json
from hypcheck.tables.streams import BYTE_ORDER_MARK, Reader, TextBlock, TextLines, Writer
from hypcheck.tables.strict_json import strict_decoder


def read_jsonl(reader: Reader, *, mark: bool) -> Table:
    """Open the table in `reader`. Raises InputError while the chunks are read.

    With `mark` a row whose value is not a number, or not allowed, is marked as refused; a line that is
    not a JSON object, or lacks a key, is an error all the same.
    """
    return Table(_chunks(reader, mark=mark))


@contextmanager
def write_jsonl(writer: Writer, _table: Table) -> Iterator[Sink]:
    """Write objects with four or five keys more: a row's own object if the table has text, else one of its numbers."""
    yield Sink(_render, writer.write)


def _render(chunk: TableChunk, answers: Answers) -> bytes:
    """Write the objects of a chunk with their answers as JSON lines."""
    texts = chunk.texts if chunk.texts is not None else [_object(row, chunk.layout) for row in chunk.rows.tolist()]
    marks = [f', "{name}": ' for name in answers.names]
    return with_answers([text[:-1] for text in texts], answers, _cell_text, marks, "}\n")


def _cell_text(cell: Cell) -> str:
    """Write an added cell as JSON."""
    return json.dumps(str(cell) if cell == inf else cell)  # JSON has no number for infinity


def _object(row: list[float], layout: Layout) -> str:
    """Return the JSON object of a row; null replaces a number that JSON cannot express (in a refused row)."""
    named = zip(layout.base + AXIS + HEIGHTS, row, strict=False)
    return json.dumps({name: _json_number(name, value) for name, value in named})


def _json_number(name: str, value: float) -> float | str | None:
    """Return a number as JSON has it: an infinite end is a text, any other infinity or NaN is null."""
    return value if isfinite(value) else str(value) if name in ENDS and value == value else None  # noqa: PLR0124 - NaN


_DECODER, _LITERAL_DECODER = strict_decoder(), strict_decoder(Literal)
_BLANKS = " \t\r\n"


def _chunks(reader: Reader, *, mark: bool) -> Iterator[UnreadChunk]:
    """Yield the chunks of the table, plain blocks as a whole. Raises InputError."""
    lines, number, count, layout = TextLines(reader), 0, 0, PAIRS
    while True:
        while (block := lines.block(number)) is not None:
            number += block.count
            places = RowPlaces(reader.name, count, range(block.first, block.first + block.count))
            layout = layout if count else _layout_of(block.plain_lines()[0])
            yield partial(_chunk_of_block, block, places, layout, mark=mark)
            count += block.count
        texts, numbers = [], []
        for line in lines.each:
            number += 1
            text = line.strip(_BLANKS) if number > 1 else line.removeprefix(BYTE_ORDER_MARK).strip(_BLANKS)
            if text:
                texts.append(text)
                numbers.append(number)
            if len(texts) == CHUNK or (texts and lines.at_block(number)):
                break
        if not texts:
            break
        layout = layout if count else _layout_of(texts[0])
        yield partial(_chunk, texts, RowPlaces(reader.name, count, numbers), layout, mark=mark)
        count += len(texts)
    if count == 0:
        raise NothingJudgedError(f"{reader.name} has no rows; nothing was answered")


def _layout_of(text: str) -> Layout:
    """Return the layout of the first row, which all rows must have; PAIRS if the text is not a row (reported later)."""
    try:
        return layout_of(columns_of(_DECODER.decode(text)))
    except (ValueError, TypeError, AttributeError, RecursionError):
        return PAIRS


def _chunk_of_block(block: TextBlock, places: RowPlaces, layout: Layout, *, mark: bool) -> TableChunk:
    """Make the chunk of a plain block."""
    return _chunk([line.rstrip(_BLANKS) for line in block.plain_lines()], places, layout, mark=mark)


def _chunk(texts: list[str], places: RowPlaces, layout: Layout, *, mark: bool) -> TableChunk:
    """Make a chunk of lines; read them one by one if they are not all valid."""
    rows = _rows_if_valid(texts, layout)
    if rows is not None:
        return TableChunk(rows, np.zeros(len(rows), dtype=np.bool_), texts, layout)
    values = _values_of_layout(texts, places, layout)
    return TableChunk(*read_values(values, number_of_json, places, mark=mark, layout=layout), texts, layout)


def _values_of_layout(texts: Sequence[str], places: RowPlaces, layout: Layout) -> Iterator[dict[str, object]]:
    """Yield the values of each line by column. Raises InputError about a line with an end where others have none."""
    for index, text in enumerate(texts):
        values = _values(text, places.of(index))
        if (END[0] in values) != layout.has_end:
            end = f"{'no' if layout.has_end else 'an'} end {', '.join(END)}"
            raise InputError(f"{places.of(index)}: {end}, unlike the first row; all rows have an end, or none has")
        yield values


def _rows_if_valid(texts: Sequence[str], layout: Layout) -> Rows | None:
    """Return the rows if all of them are valid, and have the same columns; else None."""
    try:
        objects = list(map(_DECODER.decode, texts))
        names = set(map(tuple, objects))  # one element where all rows have the same keys in one order
        (columns,) = set(map(columns_of, names))
        if layout_of(columns) != layout or not all(map(frozenset(added_to(columns)).isdisjoint, names)):
            return None
        flat = list(chain.from_iterable(map(itemgetter(*columns), objects)))
        if not set(map(type, flat)) <= {float, int}:
            return None
        numbers = np.fromiter(map(float, flat), dtype=np.float64, count=len(flat))
    except (ValueError, TypeError, LookupError, AttributeError, OverflowError, RecursionError):
        return None
    return valid_rows(numbers, columns, layout)


def _values(text: str, where: str) -> dict[str, object]:
    """Return the values of a line by column, numbers as Literal or int. Raises InputError if it is no such object."""
    try:
        row = _LITERAL_DECODER.decode(text)
    except json.JSONDecodeError as error:
        cut = " (the line may have been cut off)" if error.pos >= len(text) else ""
        raise InputError(f"{where}: not JSON at character {error.pos + 1}: {json_trouble(error)}{cut}") from None
    except RecursionError:
        raise InputError(f"{where}: nested too deeply; it must be one flat object") from None
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None
    if not isinstance(row, dict):
        raise InputError(f"{where}: {shown_json(row)} is not an object; it must be one, with {', '.join(COLUMNS)}")
    check_names(list(row), where, noun="key")
    return {name: row[name] for name in columns_of(row)}
