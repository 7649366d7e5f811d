"""A family of cases: what it is for, and a generator whose rows depend on nothing but (name, version, seed, index)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hypcheck.casebook.draw import Draw, Maker
from hypcheck.errors import InputError
from hypcheck.pairs import COLUMNS
from hypcheck.rows import Rows

BLOCK = 1024
"""Rows with a random stream of their own, so that any block can be made alone and in any order."""

TOGETHER = 16
"""Blocks that a generator makes at one go, where it can: numpy's overhead is shared, and all still fits the cache."""


@dataclass(frozen=True, kw_only=True)
class Story:
    """What is told of a family, where it is made and in its file.

    `name`: kebab-case; `version`: of the generator, raised by every change of its output, since both are part of the
    case ids. `title`, `source` (where the idea comes from, or how the rows are made) and `purpose` (what a wrong
    program does here) are for people, as are `game` and `drone`: what a wrong answer here means to either. `regimes`:
    which hyperboloids it visits, by a = α/b and c = γ/d. `extreme`: lengths near the end of a float format, so the
    family is taken only when it is asked for.
    """

    name: str
    version: int
    title: str
    source: str
    purpose: str
    game: str
    drone: str
    regimes: str
    extreme: bool = False


@dataclass(frozen=True, kw_only=True)
class Family(Story):
    """One trap, and a generator of rows that lead into it.

    `by_place`: the generator works place by place, so that it can make several blocks at one go. `movement`: so many
    consecutive rows follow one object from moment to moment; 1 where none do.
    """

    make: Maker = field(repr=False)
    by_place: bool = False
    movement: int = 1

    def block(self, seed: int, number: int) -> Rows:
        """Rows number·BLOCK to (number + 1)·BLOCK − 1 of the seed: float64 (BLOCK, 7), all valid."""
        return self.make(Draw(self.name, self.version, seed, number), BLOCK)

    def columns_between(self, seed: int, start: int, stop: int) -> NDArray[np.float64]:
        """Rows start to stop − 1 of the seed by columns, float64 (7, stop − start); those before them are not made."""
        columns = np.empty((len(COLUMNS), stop - start))
        together = TOGETHER if self.by_place else 1
        for first in range(start // BLOCK, -(-stop // BLOCK), together):
            last = min(first + together, -(-stop // BLOCK))
            made = self._blocks(seed, first, last).T
            begin, end = max(start, first * BLOCK), min(stop, last * BLOCK)
            columns[:, begin - start : end - start] = made[:, begin - first * BLOCK : end - first * BLOCK]
        return columns

    def _blocks(self, seed: int, first: int, last: int) -> Rows:
        if last == first + 1:
            return self.block(seed, first)
        names = [(self.name, self.version, seed, number) for number in range(first, last)]
        return self.make(Draw.of_blocks(names), (last - first) * BLOCK)

    def rows(self, seed: int, count: int) -> Rows:
        """The first `count` rows of the seed: float64 (count, 7), columns as in pairs.COLUMNS, all valid.

        A shorter call gives the beginning of a longer one. Raises InputError for a negative seed or count.
        """
        if seed < 0 or count < 0:
            raise InputError(f"seed is {seed} and count is {count}; neither may be negative")
        return np.ascontiguousarray(self.columns_between(seed, 0, count).T)
