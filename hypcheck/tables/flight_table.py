"""Flights as CSV: the corners of a polyline, a row each, with the columns x, y, z.

More columns may say the heading, and the mover's axis, on the segment that begins at a corner, and with `flight` which
rows belong together. Other columns are not read.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import AXIS, CENTER, NO_DIRECTION
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.tables.numbers import number_of_text, shown
from hypcheck.tables.streams import BYTE_ORDER_MARK, open_input

HEADING, FLIGHT = "heading", "flight"


@dataclass(frozen=True)
class FlightTable:
    """Flights of a file: `names`, corners (T, 3) each, and per segment, of all one after the other, what is given.

    `headings` (n,) and `axes` (n, 3) are None where the file has none.
    """

    names: list[str]
    paths: list[Rows]
    headings: Floats | None
    axes: Rows | None


def read_flights(path: str) -> FlightTable:
    """The flights of a CSV file, or of standard input for "-". Raises InputError naming the line."""
    with open_input(path) as reader:
        content, name = reader.read(), reader.name
    try:
        lines = content.decode("utf-8").removeprefix(BYTE_ORDER_MARK).splitlines(keepends=True)
    except UnicodeDecodeError as error:
        raise InputError(f"{name} is not UTF-8: byte {error.start} is wrong") from None
    records = csv.reader(lines, strict=True)
    try:
        header = [cell.strip() for cell in next(records, [])]
        rows = [(records.line_num, cells) for cells in records if cells]
    except csv.Error as error:
        raise InputError(f"{name}, line {records.line_num}: {error}") from None
    numbers = _columns_of(header, name)
    if not rows:
        raise InputError(f"{name} has no rows; a flight needs one at least")
    values = np.array([_numbers(cells, header, numbers, f"{name}, line {line}") for line, cells in rows])
    groups = [cells[header.index(FLIGHT)].strip() if FLIGHT in header else "" for _, cells in rows]
    return _split(values, numbers, groups)


def _columns_of(header: list[str], name: str) -> list[str]:
    """The columns of numbers that are read. Raises InputError."""
    if not header:
        raise InputError(f"{name} is empty; its first line must name the columns {', '.join(CENTER)}")
    twice = next((title for title in header if title and header.count(title) > 1), None)
    if twice is not None:
        raise InputError(f"{name}: column {shown(twice)} stands twice; it must stand once")
    wanted = (*CENTER, *(AXIS if set(AXIS) & set(header) else ()))
    missing = [title for title in wanted if title not in header]
    if missing:
        raise InputError(
            f"{name}: the first line has no column {', '.join(missing)}; a flight needs {', '.join(CENTER)}, and an "
            f"axis {', '.join(AXIS)}"
        )
    return [*wanted, *([HEADING] if HEADING in header else [])]


def _numbers(cells: list[str], header: list[str], columns: list[str], where: str) -> list[float]:
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
    """The rows, flight by flight; those of one flight follow each other."""
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
