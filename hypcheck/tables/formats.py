"""The formats of tables by name, and a table opened for reading beside the one that its answers go to."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from typing import Protocol

from hypcheck.errors import InputError
from hypcheck.tables.chunk import Sink, Table
from hypcheck.tables.csv_table import read_csv, write_csv
from hypcheck.tables.jsonl_table import read_jsonl, write_jsonl
from hypcheck.tables.npy_table import read_npy, write_npy
from hypcheck.tables.route import Route
from hypcheck.tables.streams import Reader, Writer, reading, same_file, writing


class _Read(Protocol):
    def __call__(self, reader: Reader, *, mark: bool) -> Table: ...


class _Open(Protocol):
    def __call__(self, writer: Writer, table: Table, /) -> AbstractContextManager[Sink]: ...


@dataclass(frozen=True, slots=True)
class _Format:
    read: _Read
    write: _Open


_FORMATS = {
    "csv": _Format(read_csv, write_csv),
    "jsonl": _Format(read_jsonl, write_jsonl),
    "npy": _Format(read_npy, write_npy),
}


@contextmanager
def opened(route: Route, *, mark: bool) -> Iterator[tuple[Reader, Table, Sink]]:
    """What is read at one end of `route`, the table in it, and where its answers go at the other.

    The output takes its place when the block ends well; after an error nothing of it is left. Raises InputError where
    either cannot be opened, NothingJudgedError (while its chunks are read) where the table has no rows.
    """
    if same_file(route.source, route.target):
        raise InputError(f"--output {route.target} is the input itself; name another file")
    with reading(route.source) as reader:
        table = _FORMATS[route.source_format].read(reader, mark=mark)
        with writing(route.target) as writer, _FORMATS[route.target_format].write(writer, table) as sink:
            yield reader, table, sink
