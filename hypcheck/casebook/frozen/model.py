"""What a vector file holds: a family's description, what its flags mean, and cases with labels and proofs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np

from hypcheck.casebook.family import Story
from hypcheck.pairs import COLUMNS, Pair, Position
from hypcheck.rows import Positions, Rows
from hypcheck.truth.certificate import Certificate
from hypcheck.truth.kinds import Kind

SCHEMA = "1.0.0"
"""The version of the files' schema, cases/schema/vectors-1.0.0.json; a reader refuses any other."""

Row = tuple[float, ...]
Offset = tuple[Fraction, Fraction, Fraction]


@dataclass(frozen=True, slots=True)
class Witness:
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
    witness: Witness
    flags: tuple[str, ...] = ()

    @property
    def pair(self) -> Pair:
        """The row as a query."""
        return Pair.from_row(self.row)


@dataclass(frozen=True, kw_only=True)
class Head(Story):
    """What a file says of its family: its story, and the command that made the file."""

    made_by: str


@dataclass(frozen=True, slots=True)
class FlagFacts:
    """What a flag says of a case, and the kind of defect that cases with it find."""

    meaning: str
    bug_type: str


@dataclass(frozen=True)
class VectorFile:
    """A file of cases. `lines` are the lines on which they stood where it was read, for messages."""

    head: Head
    flags: Mapping[str, FlagFacts]
    cases: tuple[Vector, ...]
    lines: tuple[int, ...] = field(default=(), compare=False, repr=False)

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
