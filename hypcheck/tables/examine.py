"""The slow and thorough reading of a chunk's values, for when the fast one found something amiss."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.pairs import COLUMNS
from hypcheck.rows import Rows

Value = TypeVar("Value")


@dataclass(frozen=True, slots=True)
class Places:
    """Where the rows of a chunk stand: in which file, after how many rows, on which of its lines (from 1)."""

    name: str
    rows_before: int
    lines: Sequence[int]

    def of(self, index: int) -> str:
        """How a message names a row of the chunk."""
        return f"{self.name}, row {self.rows_before + index + 1} (line {self.lines[index]})"


def examine(
    values: Iterable[Sequence[Value]],
    number_of: Callable[[str, Value], float],
    places: Places,
    *,
    mark: bool,
) -> tuple[Rows, NDArray[np.bool_]]:
    """The rows (n, 7), and which of them are refused, (n,).

    `number_of(column, value)` raises ValueError with the end of a sentence that begins with the row's place. Without
    `mark` the first such row raises InputError; with it the row becomes NaN and is refused.
    """
    rows: list[list[float]] = []
    refused: list[bool] = []
    for index, row in enumerate(values):
        try:
            rows.append([number_of(name, value) for name, value in zip(COLUMNS, row, strict=True)])
            refused.append(False)
        except ValueError as trouble:  # noqa: PERF203 - each row has its own
            if not mark:
                raise InputError(f"{places.of(index)}: {trouble}") from None
            rows.append([math.nan] * len(COLUMNS))
            refused.append(True)
    return np.array(rows, dtype=np.float64).reshape(len(rows), len(COLUMNS)), np.array(refused, dtype=np.bool_)
