"""A family of cases: its generator of rows, and the description of it in its vector files.

The rows of a generator depend only on (name, version, seed, index).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hypcheck import toml
from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, NO_GROUPS, Groups
from hypcheck.geometry.rows import Layout, Rows, columns_with, layout_with
from hypcheck.vectors.draw import Draw, Maker

MARK = "@"
"""The prefix before the sizes in the name of a family for fixed sizes."""

BLOCK = 1024
"""Rows with a random stream of their own, so that any block can be made alone and in any order."""

TOGETHER = 16
"""Blocks that a generator makes at one go, where it can: numpy's overhead is shared, and all still fits the cache."""


@dataclass(frozen=True, kw_only=True)
class Metadata:
    """The metadata of a file: the family's name, the version of its generator, and the command that made the file.

    `title`, `source` (the origin of the idea, or how the rows are made) and `purpose` (what a wrong program does here)
    are for people; so are `game` and `drone`, the consequence of a wrong answer for a game or a drone. `regimes`: the
    hyperboloids that occur, by a = α/b and c = γ/d. `extreme`: as in Family.
    """

    name: str
    version: int
    title: str
    source: str
    purpose: str
    game: str
    drone: str
    regimes: str
    extreme: bool
    made_by: str


def descriptions() -> dict[str, dict[str, str]]:
    """The texts of descriptions.toml by name."""
    return toml.shipped("hypcheck.vectors", "descriptions.toml")


def described(name: str, made_by: str, *, version: int = 1, extreme: bool = False) -> Metadata:
    """The metadata of a file of that name, with the texts of descriptions.toml; for fixed sizes the trap's texts."""
    texts = {"regimes": "all four", **descriptions()[name.partition(MARK)[0]]}
    return Metadata(name=name, version=version, extreme=extreme, made_by=made_by, **texts)


Row = tuple[float, ...]


@dataclass(frozen=True)
class Family:
    """A generator of rows for one trap, a kind of case on which programs fail; descriptions.toml has its purpose.

    `name`: kebab-case; `version`: of the generator, raised by every change of its output, since both are part of the
    case ids. `frozen`: the number of frozen rows; it is larger for rows with traps, smaller if proofs are long, 0
    if rows matter in their order alone or are made of those of other families.
    `extreme`: lengths are near the limits of a float format, so the family is used only on request. `by_place`: the
    generator works place by place, so that it can make several blocks at one go. `movement`: the number of consecutive
    rows that follow one object from moment to moment; 1 if none do. `groups` are those that an implementation must
    take: an end if rows are sweeps, an axis if spheroids are tilted, heights if hyperboloids end; rows with heights
    also have an axis, which is vertical if "axis" is not among the groups. `times`: a run tests this many rows for each
    row that it tests of other families.
    """

    name: str
    make: Maker = field(repr=False)
    frozen: int = 0
    version: int = 1
    extreme: bool = False
    by_place: bool = False
    movement: int = 1
    groups: Groups = NO_GROUPS
    times: int = 1

    def described(self, made_by: str) -> Metadata:
        """The metadata of a file of the family that the command `made_by` makes."""
        return described(self.name, made_by, version=self.version, extreme=self.extreme)

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the numbers of a row."""
        return columns_with(self.groups)

    @property
    def layout(self) -> Layout:
        """The layout of the rows."""
        return layout_with(self.groups)

    def block(self, seed: int, number: int) -> Rows:
        """Rows number·BLOCK to (number + 1)·BLOCK − 1 of the seed: float64 (BLOCK, len(columns)), all valid."""
        return self._blocks(seed, number, number + 1)

    def columns_between(self, seed: int, start: int, stop: int) -> NDArray[np.float64]:
        """Rows start to stop − 1 of the seed by columns, (len(columns), stop − start); earlier rows are not made."""
        columns = np.empty((len(self.columns), stop - start))
        together = TOGETHER if self.by_place else 1
        for first in range(start // BLOCK, -(-stop // BLOCK), together):
            last = min(first + together, -(-stop // BLOCK))
            by_column = self._blocks(seed, first, last).T
            begin, end = max(start, first * BLOCK), min(stop, last * BLOCK)
            columns[:, begin - start : end - start] = by_column[:, begin - first * BLOCK : end - first * BLOCK]
        return columns

    def row(self, seed: int, index: int) -> Row:
        """Row `index` of the seed."""
        number, place = divmod(index, BLOCK)
        return tuple(self.block(seed, number)[place].tolist())

    def _blocks(self, seed: int, first: int, last: int) -> Rows:
        names = [(self.name, self.version, seed, number) for number in range(first, last)]
        return self.make(Draw.of_blocks(names), (last - first) * BLOCK)

    def rows(self, seed: int, count: int) -> Rows:
        """The first `count` rows of the seed: float64 (count, len(columns)), all valid.

        A call for fewer rows returns the first rows of a call for more. Raises InputError for a negative seed or count.
        """
        if seed < 0 or count < 0:
            raise InputError(f"seed is {seed} and count is {count}; neither may be negative")
        return np.ascontiguousarray(self.columns_between(seed, 0, count).T)


def rows_of(rows: list[Row]) -> Rows:
    """The rows as one array, float64 (n, 7)."""
    return np.asarray(rows, dtype=np.float64).reshape(len(rows), len(COLUMNS))
