"""The frozen cases of `cases/`, read as a stranger reads them: JSON, without any code of hypcheck.

A case asks a question by its row. Its columns are in groups: the sizes and the centre; the end of a straight motion;
the axis; the heights where the hyperboloid ends. What is asked of a decider is a `Questions`: rows of one set of
groups, as columns.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

CASES = Path(__file__).parents[2] / "cases"
GROUPS = {"positions": "", "tilted-positions": "axis", "ways": "end", "tilted-ways": "end axis"}
GROUPS |= {"ended-positions": "axis heights", "ended-ways": "end axis heights"}
"""The content of a file, and the groups of columns that its rows have behind the sizes and the centre."""
REFUSED = {"refusals": "", "tilted-refusals": "axis", "way-refusals": "end", "tilted-way-refusals": "end axis"}
REFUSED |= {"ended-refusals": "axis heights", "ended-way-refusals": "end axis heights"}
"""The same of files whose rows must be refused."""


@dataclass(frozen=True)
class Questions:
    """Rows as columns: sizes (n, 4), centre (n, 3), and what is asked besides, None where it is not.

    `cases` are the frozen cases that the rows are from, if they are. `layout` makes the array of rows that is given.
    """

    sizes: np.ndarray
    center: np.ndarray
    end: np.ndarray | None = None
    axis: np.ndarray | None = None
    heights: np.ndarray | None = None
    cases: tuple[dict[str, Any], ...] = ()
    layout: Callable[[np.ndarray], Any] = field(default=np.ascontiguousarray)

    @classmethod
    def of(cls, rows: Iterable[Iterable[float]], groups: str, cases: Iterable[dict[str, Any]] = ()) -> Questions:
        """The questions that rows of numbers ask, which have these groups."""
        columns = {"sizes": 4, "center": 3, **dict.fromkeys(groups.split(), 3)}
        numbers = np.array(list(rows), dtype=np.float64).reshape(-1, sum(columns.values()))
        parts = np.split(numbers, np.cumsum(list(columns.values()))[:-1], axis=1)
        return cls(**dict(zip(columns, parts, strict=True)), cases=tuple(cases))

    @property
    def groups(self) -> str:
        """The groups of columns that are asked besides sizes and centre."""
        return " ".join(name for name in ("end", "axis", "heights") if getattr(self, name) is not None)

    @property
    def rows(self) -> Any:
        """The rows as files hold them, in the layout that is asked for."""
        every = (self.sizes, self.center, self.end, self.axis, self.heights)
        parts = [part for part in every if part is not None]
        return self.layout(np.concatenate(parts, axis=1))

    def __len__(self) -> int:
        return len(self.sizes)

    def __getitem__(self, chosen: Any) -> Questions:
        parts = {name: getattr(self, name) for name in ("sizes", "center", "end", "axis", "heights")}
        cases = tuple(np.array(self.cases, dtype=object)[chosen]) if self.cases else ()
        return replace(
            self, **{name: part if part is None else part[chosen] for name, part in parts.items()}, cases=cases
        )


@cache
def files() -> dict[str, dict[str, Any]]:
    """Every file of cases, by its name."""
    return {path.stem: json.loads(path.read_text("utf-8")) for path in sorted(CASES.glob("*.json"))}


@cache
def questions(groups: str, *, refused: bool = False) -> Questions:
    """All frozen cases with these groups of columns; those that must be refused, or the others."""
    wanted = REFUSED if refused else GROUPS
    cases = [case for file in files().values() if wanted.get(file["content"]) == groups for case in file["cases"]]
    return Questions.of(map(row_of, cases), groups, cases)


def row_of(case: dict[str, Any]) -> tuple[float, ...]:
    """The numbers of a case, from their bits or their hexadecimal digits."""
    if "bits" in case:
        return tuple(struct.unpack(">d", bytes.fromhex(bits))[0] for bits in case["bits"])
    return tuple(map(float.fromhex, case["hex"]))


def expected(case: dict[str, Any]) -> int:
    """The answer of a case: its position, or 1 for contact on the way and 0 for none."""
    return int(case["hit"]) if "hit" in case else int(case["position"])


def number_of(value: float | str) -> float:
    """A number as files hold it, infinity as a text."""
    return float(value)
