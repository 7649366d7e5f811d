"""A written table is read by readers that are not hypcheck's: it has all values, and the right answers."""

from __future__ import annotations

import csv
import io
import itertools
import json
import math
import re
import warnings

import numpy as np

from hypcheck.geometry.pair import AXIS, COLUMNS, REFUSED, Pair
from hypcheck.tables.chunk import ADDED
from tests.support import inside

MOST = 12
"""Rows whose answers are looked at."""

_DECIMAL = re.compile(r"[ \t]*[-+]?([0-9]+\.?|[0-9]*\.[0-9]+)([eE][-+]?[0-9]+)?[ \t]*")


def require_agreement(kind: str, given: bytes, answers: bytes) -> None:
    """Raise AssertionError where a table of that kind and what was written of it do not belong together."""
    {"csv": _csv, "jsonl": _jsonl, "npy": _npy}[kind](given, answers)


def _csv(given: bytes, answers: bytes) -> None:
    (names, *rows), (header, *written) = map(_cells, (given, answers))
    assert header == [*names, *ADDED]
    assert [row[: -len(ADDED)] for row in written] == rows
    stripped = [name.strip() for name in names]
    columns = [stripped.index(column) for column in _columns(stripped)]
    for row, out in itertools.islice(zip(rows, written, strict=True), MOST):
        values = [row[column] for column in columns]
        numbers = map(float, values) if all(map(_DECIMAL.fullmatch, values)) else (math.nan,)
        assert out[-len(ADDED)] == str(_right(numbers)), out


def _columns(names) -> tuple[str, ...]:
    """Those that say what is asked: with the axis where a table has it."""
    return (*COLUMNS, *AXIS) if {*AXIS} <= {*names} else COLUMNS


def _cells(text: bytes) -> list[list[str]]:
    records = csv.reader(io.StringIO(text.decode("utf-8-sig"), newline=""))
    return [cells for cells in records if len(cells) > 1 or "".join(cells).strip()]


def _jsonl(given: bytes, answers: bytes) -> None:
    rows, written = map(_objects, (given, answers))
    assert [{name: row[name] for name in row if name not in ADDED} for row in written] == rows
    for row, out in itertools.islice(zip(rows, written, strict=True), MOST):
        values = [row[name] for name in _columns(row)]
        assert out["position"] == _right(values if {*map(type, values)} <= {int, float} else (math.nan,)), out


def _objects(text: bytes) -> list[dict]:
    lines = filter(str.strip, text.decode("utf-8-sig").split("\n"))
    return [
        json.loads(line, parse_int=lambda digits: int(digits) if len(digits) < 309 else float(digits)) for line in lines
    ]


def _npy(given: bytes, answers: bytes) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about headers as Python 2 wrote them
        rows, written = (np.load(io.BytesIO(data), allow_pickle=False) for data in (given, answers))
    assert (written.dtype, written.shape) == (np.int8, rows.shape[:1])
    assert written[:MOST].tolist() == [_right(row) for row in rows[:MOST].tolist()]


def _right(numbers) -> int:
    """The answer about a row, REFUSED where it is none."""
    row = [float(number) for number in numbers]
    valid = all(map(math.isfinite, row)) and min(row[:4]) > 0 and (len(row) == len(COLUMNS) or any(row[7:]))
    if not valid:
        return REFUSED
    pair = Pair.from_row(row)
    return int(inside.position(pair.lengths))
