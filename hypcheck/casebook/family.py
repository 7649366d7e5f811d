"""A family of cases: what it is for, and a generator whose rows depend on nothing but (name, version, seed, index)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from hypcheck.casebook.draw import Draw, Maker
from hypcheck.errors import InputError
from hypcheck.pairs import COLUMNS
from hypcheck.rows import Rows

BLOCK = 1024
"""Rows made at a time. Each block has a random stream of its own, so any block can be made alone and in any order."""


@dataclass(frozen=True)
class Family:
    """One trap, and a generator of rows that lead into it.

    `name`: kebab-case; `version`: of the generator, raised by every change of its output, since both are part of the
    case ids. `title`, `source` (where the idea comes from) and `purpose` (what a wrong program does here) are for
    people, as are `game` and `drone`: what a wrong answer here means to either. `extreme`: lengths near the end of a
    float format, so the family is taken only when it is asked for. `regimes`: which hyperboloids it visits, by
    a = α/b and c = γ/d.
    """

    name: str
    version: int
    title: str
    source: str
    purpose: str
    game: str
    drone: str
    regimes: str
    make: Maker = field(repr=False)
    extreme: bool = False

    def block(self, seed: int, number: int) -> Rows:
        """Rows number·BLOCK to (number + 1)·BLOCK − 1 of the seed: float64 (BLOCK, 7), all valid."""
        return self.make(Draw(self.name, self.version, seed, number), BLOCK)

    def rows(self, seed: int, count: int) -> Rows:
        """The first `count` rows of the seed: float64 (count, 7), columns as in pairs.COLUMNS, all valid.

        A shorter call gives the beginning of a longer one. Raises InputError for a negative seed or count.
        """
        if seed < 0 or count < 0:
            raise InputError(f"seed is {seed} and count is {count}; neither may be negative")
        rows = np.empty((count, len(COLUMNS)))
        for start in range(0, count, BLOCK):
            part = rows[start : start + BLOCK]
            part[:] = self.block(seed, start // BLOCK)[: len(part)]
        return rows
