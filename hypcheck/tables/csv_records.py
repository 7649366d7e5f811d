"""The records of a CSV text (RFC 4180), each with the very text that it was written as."""

from __future__ import annotations

import csv
from itertools import chain, islice, tee

from hypcheck.errors import InputError
from hypcheck.tables.lines import BYTE_ORDER_MARK, Block, Lines
from hypcheck.tables.streams import Reader


class Records:
    """A CSV text, record by record: `text` and `line` (of its beginning) are those of the record last read."""

    def __init__(self, reader: Reader) -> None:
        self.name = reader.name
        self.line = 0
        self.text = ""
        self._lines = Lines(reader)
        lines = self._lines.each
        first = next(lines, "")
        self.byte_order_mark = BYTE_ORDER_MARK if first.startswith(BYTE_ORDER_MARK) else ""
        # The parser runs over one copy of the lines; what it took for a record is then taken from the other.
        parsed, self._written = tee(chain([first.removeprefix(BYTE_ORDER_MARK)], lines))
        self._parser = csv.reader(parsed, strict=True)
        self._lines_taken = 0
        self._lines_skipped = 0

    @property
    def at_block(self) -> bool:
        """Whether the next records may be a block."""
        return self._lines.at_block(self._lines_taken)

    def block(self) -> Block | None:
        """The next records as a block without quotes, in which every line is one; None where they are none."""
        block = self._lines.block(self._lines_taken, avoiding=b'"')
        if block is not None:
            self._lines_taken += block.count
            self._lines_skipped += block.count
        return block

    def next(self) -> list[str] | None:
        """The cells of the next record that is not blank, None at the end. Raises InputError on broken quoting."""
        while (record := self._parsed()) is not None:
            begin, self._lines_taken = self._lines_taken, self._lines_skipped + self._parser.line_num
            self.line = begin + 1
            count = self._lines_taken - begin
            self.text = next(self._written) if count == 1 else "".join(islice(self._written, count))
            if len(record) > 1 or (record and not record[0].isspace()):
                return record
        return None

    def _parsed(self) -> list[str] | None:
        try:
            return next(self._parser, None)
        except csv.Error as error:
            where = f"{self.name}, line {self._lines_taken + 1}"
            raise InputError(f"{where}: {_explained(str(error))}") from None


def _explained(error: str) -> str:
    """What the csv module's own words mean."""
    if "field larger" in error:
        return f"a cell is longer than {csv.field_size_limit()} characters; a quote may have been left open"
    if "unexpected end of data" in error:
        return "the text ends inside quotes that begin here; the file may have been cut off"
    if "new-line character" in error:
        return "a carriage return stands within a row; lines must end with LF or CRLF"
    return f"{error}; what stands in quotes must end with a quote and a comma"
