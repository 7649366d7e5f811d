"""numpy's .npy files: float64 (n, 7), (n, 10) or (n, 13) in, int8 (n,) out, read in blocks and never unpickled.

Files are not mapped into memory: if another process shortens a mapped file, the next access ends this process with
SIGBUS, and a pipe cannot be mapped.
"""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import IO, cast

import numpy as np
from numpy.lib import format as npy

from hypcheck.errors import InputError, NothingJudgedError
from hypcheck.geometry.pair import AXIS, COLUMNS, HEIGHTS, TILTED_COLUMNS
from hypcheck.geometry.rows import PAIRS, Rows, first_trouble, invalid
from hypcheck.messages import counted
from hypcheck.tables.chunk import CHUNK, Answers, Sink, Table, TableChunk, UnreadChunk
from hypcheck.tables.streams import Reader, Writer

_SHAPES = (
    f"(n, {len(COLUMNS)}): {', '.join(COLUMNS)}, or (n, {len(TILTED_COLUMNS)}): {', '.join(AXIS)} besides, or "
    f"(n, {len(PAIRS.ended)}): {', '.join(HEIGHTS)} behind these"
)
_COPIED_AT_ONCE = 1 << 20
_TOO_LONG = 1 << 63


def read_npy(reader: Reader, *, mark: bool) -> Table:
    """Open the table in `reader`. Raises InputError: now about the header and the length, later about a row.

    With `mark` a row that is not a valid query is marked as refused.
    """
    layout = _layout(reader)
    return Table(_chunks(reader, layout, mark=mark), columns=PAIRS.ended[: layout.width])


@contextmanager
def write_npy(writer: Writer, _table: Table) -> Iterator[Sink]:
    """Write positions, with a margin if one is given, or hits, as one int8 array (n,), when the block ends well.

    Raises InputError.
    """
    # The header comes first and has the count, which is known at the end, and an output may be a pipe.
    with tempfile.TemporaryFile() as file:
        kept, count = Writer(file, "a temporary file"), 0

        def add(data: bytes) -> None:
            nonlocal count
            kept.write(data)
            count += len(data)

        yield Sink(_render, add)
        kept.flush()
        header = {"descr": "|i1", "fortran_order": False, "shape": (count,)}
        npy.write_array_header_1_0(cast("IO[bytes]", writer), header)
        file.seek(0)
        while block := file.read(_COPIED_AT_ONCE):
            writer.write(block)


def _render(_chunk: TableChunk, answers: Answers) -> bytes:
    """Return the integers of the answers as bytes."""
    return answers.integers.tobytes()


@dataclass(frozen=True, slots=True)
class _NpyLayout:
    """The content of a header.

    count, width: the numbers of rows and of columns. type: float64 in a byte order. by_columns: the numbers of a column
    follow each other. begin: the offset of the data in the file.
    """

    count: int
    width: int
    type: np.dtype[np.float64]
    by_columns: bool
    begin: int


def _layout(reader: Reader) -> _NpyLayout:
    """Read the header of a .npy file.

    Raises InputError if its numbers are not float64, its shape is not allowed, or its length does not fit its shape.
    """
    shape, by_columns, stored = _header(reader)
    if stored.kind != "f" or stored.itemsize != 8:
        raise InputError(f"{reader.name} holds {stored}; it must hold float64")
    if max(map(abs, shape), default=0) >= _TOO_LONG:  # Python may refuse to print so long a number
        raise InputError(f"{reader.name} has a number of 2^63 or more in its shape; the shape must be {_SHAPES}")
    if len(shape) != 2 or shape[1] not in PAIRS.widths or shape[0] < 0:
        raise InputError(f"{reader.name} has shape {shape}; it must be {_SHAPES}")
    if shape[0] == 0:
        raise NothingJudgedError(f"{reader.name} has no rows; nothing was answered")
    size = reader.size()
    if size is None:
        if by_columns:
            raise InputError(f"{reader.name} is stored by columns, which a stream cannot be read in; use a file")
    else:
        _require_length(reader.name, size - reader.taken, shape[0], shape[1])
    return _NpyLayout(shape[0], shape[1], cast("np.dtype[np.float64]", stored), by_columns, reader.taken)


_HEADER_READERS = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}


def _header(reader: Reader) -> tuple[tuple[int, ...], bool, np.dtype[np.generic]]:
    """Read the shape, whether numbers are stored by columns, and their type. Raises InputError."""
    file = cast("IO[bytes]", reader)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about headers that Python 2 wrote, which are valid
            version = npy.read_magic(file)
            if version in _HEADER_READERS:
                shape, by_columns, stored = _HEADER_READERS[version](file)
                return shape, by_columns, stored
    except InputError:
        raise
    except Exception as error:  # noqa: BLE001 - numpy evaluates the header's text, which may hold anything
        reason = str(error).partition("\n")[0] or "it cannot be read"
        if reason.startswith("malformed node"):  # the message names an object and its address
            reason = "it has an expression in place of a plain value"
        raise InputError(f"{reader.name} is not a .npy file, or one cut off in its header: {reason}") from None
    raise InputError(f"{reader.name} is a .npy file of version {version[0]}.{version[1]}; it must be 1.0 or 2.0")


def _require_length(name: str, size: int, count: int, width: int) -> None:
    """Raise InputError unless `size` bytes are `count` rows of `width` numbers."""
    needed = count * width * 8
    if size < needed:
        raise _cut_off(name, count, size // (width * 8))
    if size > needed:
        more = f"for {counted(size - needed, 'byte')} after its {counted(count, 'row')}"
        raise InputError(f"{name} goes on {more}; it must hold one array")


def _cut_off(name: str, count: int, have: int) -> InputError:
    """Make the error that the data ends after `have` of `count` rows."""
    says = f"its header says {counted(count, 'row')}, and the data ends after {have} of them"
    return InputError(f"{name} is cut off: {says}")


def _chunks(reader: Reader, layout: _NpyLayout, *, mark: bool) -> Iterator[UnreadChunk]:
    """Yield the chunks of an array. Raises InputError if the data are cut off, or go on after it."""
    for start in range(0, layout.count, CHUNK):
        rows = _rows(reader, layout, start, min(CHUNK, layout.count - start))
        yield partial(_chunk, rows, reader.name, start + 1, mark=mark)
    if reader.size() is None and reader.read(1):
        raise InputError(f"{reader.name} goes on after its {counted(layout.count, 'row')}; it must hold one array")


def _chunk(rows: Rows, name: str, first: int, *, mark: bool) -> TableChunk:
    """Make a chunk of rows. Raises InputError about an invalid one, unless `mark` is set."""
    refused = invalid(rows)
    if not mark and refused.any():
        raise InputError(f"{name}, {first_trouble(rows, first)}")
    return TableChunk(rows, refused, None)


def _rows(reader: Reader, layout: _NpyLayout, start: int, count: int) -> Rows:
    """Read the `count` rows from `start` on. Raises InputError if the file ends too early."""
    width = layout.width
    if layout.by_columns:
        places = [layout.begin + 8 * (column * layout.count + start) for column in range(width)]
        data = b"".join(reader.read_at(place, 8 * count) for place in places)
    else:
        data = reader.read(8 * width * count)
    if len(data) != 8 * width * count:
        raise _cut_off(reader.name, layout.count, start + len(data) // (8 * width))
    values = np.frombuffer(data, dtype=layout.type)
    rows = values.reshape(width, count).T if layout.by_columns else values.reshape(count, width)
    return np.ascontiguousarray(rows, dtype=np.float64)
