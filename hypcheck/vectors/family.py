"""A family of cases: its generator of rows, its description, and the labelled and proved cases of its file.

The rows of a generator depend on nothing but (name, version, seed, index).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from importlib import resources
from typing import Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from hypcheck import toml
from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, Pair, Position
from hypcheck.geometry.rows import PAIRS, Layout, Positions, Rows
from hypcheck.truth.certificate import Certificate
from hypcheck.truth.kinds import Kind
from hypcheck.vectors.draw import Draw, Maker

MARK = "@"
"""In the name of a family for given sizes, what stands before the sizes."""

BLOCK = 1024
"""Rows with a random stream of their own, so that any block can be made alone and in any order."""

TOGETHER = 16
"""Blocks that a generator makes at one go, where it can: numpy's overhead is shared, and all still fits the cache."""


@dataclass(frozen=True, kw_only=True)
class Metadata:
    """What a file says of its family: the name, the version of its generator, and the command that made the file.

    `title`, `source` (where the idea comes from, or how the rows are made) and `purpose` (what a wrong program does
    here) are for people, as are `game` and `drone`: what a wrong answer here means to either. `regimes`: which
    hyperboloids it visits, by a = α/b and c = γ/d. `extreme`: as in Family.
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


@cache
def descriptions() -> dict[str, dict[str, str]]:
    """The texts of descriptions.toml by name."""
    text = resources.files("hypcheck.vectors").joinpath("descriptions.toml").read_text(encoding="utf-8")
    return toml.parsed(text, "descriptions.toml")


def described(name: str, made_by: str, *, version: int = 1, extreme: bool = False) -> Metadata:
    """What a file of that name says, with the texts of descriptions.toml; one for given sizes has those of its trap."""
    texts = {"regimes": "all four", **descriptions()[name.partition(MARK)[0]]}
    return Metadata(name=name, version=version, extreme=extreme, made_by=made_by, **texts)


Row = tuple[float, ...]


@dataclass(frozen=True)
class Family:
    """One trap, and a generator of rows that lead into it; descriptions.toml says what it is for.

    `name`: kebab-case; `version`: of the generator, raised by every change of its output, since both are part of the
    case ids. `extreme`: lengths near the end of a float format, so the family is taken only when it is asked for.
    `by_place`: the generator works place by place, so that it can make several blocks at one go. `movement`: so many
    consecutive rows follow one object from moment to moment; 1 where none do. `layout` says what rows are about, a
    position or a way. `tilted`: they have three numbers more, the axis of the spheroid behind the others.
    """

    name: str
    make: Maker = field(repr=False)
    version: int = 1
    extreme: bool = False
    by_place: bool = False
    movement: int = 1
    tilted: bool = False
    layout: Layout = PAIRS

    def described(self, made_by: str) -> Metadata:
        """What a file of the family says of it, if that command made it."""
        return described(self.name, made_by, version=self.version, extreme=self.extreme)

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the numbers of a row."""
        return self.layout.tilted if self.tilted else self.layout.upright

    def block(self, seed: int, number: int) -> Rows:
        """Rows number·BLOCK to (number + 1)·BLOCK − 1 of the seed: float64 (BLOCK, len(columns)), all valid."""
        return self.make(Draw(self.name, self.version, seed, number), BLOCK)

    def columns_between(self, seed: int, start: int, stop: int) -> NDArray[np.float64]:
        """Rows start to stop − 1 of the seed by columns, (len(columns), stop − start); those before are not made."""
        columns = np.empty((len(self.columns), stop - start))
        together = TOGETHER if self.by_place else 1
        for first in range(start // BLOCK, -(-stop // BLOCK), together):
            last = min(first + together, -(-stop // BLOCK))
            made = self._blocks(seed, first, last).T
            begin, end = max(start, first * BLOCK), min(stop, last * BLOCK)
            columns[:, begin - start : end - start] = made[:, begin - first * BLOCK : end - first * BLOCK]
        return columns

    def row(self, seed: int, index: int) -> Row:
        """Row `index` of the seed."""
        number, place = divmod(index, BLOCK)
        return tuple(self.block(seed, number)[place].tolist())

    def _blocks(self, seed: int, first: int, last: int) -> Rows:
        if last == first + 1:
            return self.block(seed, first)
        names = [(self.name, self.version, seed, number) for number in range(first, last)]
        return self.make(Draw.of_blocks(names), (last - first) * BLOCK)

    def rows(self, seed: int, count: int) -> Rows:
        """The first `count` rows of the seed: float64 (count, len(columns)), all valid.

        A shorter call gives the beginning of a longer one. Raises InputError for a negative seed or count.
        """
        if seed < 0 or count < 0:
            raise InputError(f"seed is {seed} and count is {count}; neither may be negative")
        return np.ascontiguousarray(self.columns_between(seed, 0, count).T)


SCHEMA = "1.0.0"
"""The version of the files' schemas, such as cases/schema/vectors-1.0.0.json."""

TILTED_SCHEMA = "1.1.0"
"""The version of the schemas of files about tilted spheroids."""

WAY_SCHEMA = "1.2.0"
"""The version of the schemas of files about ways; a reader refuses any other than these three."""

Offset = tuple[Fraction, Fraction, Fraction]


@dataclass(frozen=True, slots=True)
class StoredCertificate:
    """A certificate as files hold it: one of a multiplier λ, a double root m, and points.

    Points are offsets (s, t, w) from the spheroid's centre in its semi-axes, so that s² + t² + w² ≤ 1 says that
    (x + b s, y + b t, z + d w) belongs to the spheroid, and short numbers do.
    """

    multiplier: Fraction | None = None
    offsets: tuple[Offset, ...] = ()
    double_root: Fraction | None = None

    def certificate(self, pair: Pair, position: Position) -> Certificate:
        """The certificate of that claim, its points in the caller's coordinates."""
        _, _, b, d, x, y, z = map(Fraction, pair.row)
        points = tuple((x + b * s, y + b * t, z + d * w) for s, t, w in self.offsets)
        return Certificate(position, multiplier=self.multiplier, points=points, double_root=self.double_root)


@dataclass(frozen=True, slots=True)
class Vector:
    """A case: a valid row (−0.0 included, as it was given), its labels, and what proves them.

    `clearance` is in spheroid radii, to within an ulp, inf beyond float64. `flips` has the distance to each other
    position as truth/flip.py measures it. `flags` are names out of flags.FLAGS.
    """

    id: str
    row: Row
    position: Position
    tangent: bool
    kind: Kind
    clearance: float
    flips: Mapping[Position, float]
    witness: StoredCertificate
    flags: tuple[str, ...] = ()

    @property
    def pair(self) -> Pair:
        """The row as a query."""
        return Pair.from_row(self.row)


@dataclass(frozen=True, slots=True)
class FlagFacts:
    """What a flag says of a case, and the kind of defect that cases with it find."""

    meaning: str
    bug_type: str


Case = TypeVar("Case", bound="LabelledCase")


class LabelledCase(Protocol):
    """What the cases of all files with answers have."""

    @property
    def id(self) -> str:
        """Its name, its own for ever."""
        ...

    @property
    def row(self) -> Row:
        """The numbers that are asked about."""
        ...

    @property
    def flags(self) -> tuple[str, ...]:
        """The names of what is special about it."""
        ...


@dataclass(frozen=True)
class CaseFile(Generic[Case]):
    """A file of cases. `lines` are the lines on which they stood where it was read, for messages."""

    head: Metadata
    flags: Mapping[str, FlagFacts]
    cases: tuple[Case, ...]
    lines: tuple[int, ...] = field(default=(), compare=False, repr=False)


class VectorFile(CaseFile[Vector]):
    """A file about positions of upright spheroids."""

    @property
    def rows(self) -> Rows:
        """The rows, float64 (n, 7)."""
        return rows_of([case.row for case in self.cases])

    @property
    def positions(self) -> Positions:
        """The right answers, int8 (n,)."""
        return np.asarray([case.position for case in self.cases], dtype=np.int8)


def rows_of(rows: list[Row]) -> Rows:
    """The rows as one array, float64 (n, 7)."""
    return np.asarray(rows, dtype=np.float64).reshape(len(rows), len(COLUMNS))
