"""What one run of verify is asked to do, and the cases it works on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from hypcheck.casebook.families import case_id, select
from hypcheck.casebook.family import Family
from hypcheck.judge import DEFAULT_TOLERANCE
from hypcheck.pairs import Pair
from hypcheck.rows import Positions, Rows
from hypcheck.tally import Place
from hypcheck.truth import exact
from hypcheck.truth.exact import Decision

ALL_BUT_EXTREME: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Plan:
    """Options of a run.

    `families` are names and globs (none: all but the extreme ones); `count` rows of each family are asked of the exact
    and the nearest-point oracle, and `judged` of them of every method; `roots` and `meshes` rows in all go to the two
    slow oracles, and `exact_formulas` rows of each family through every formula in exact arithmetic. `workers` 1 means
    this process.
    """

    families: tuple[str, ...] = ALL_BUT_EXTREME
    oracles: tuple[str, ...] = ("exact", "nearest", "roots", "mesh")
    count: int = 400
    judged: int = 400
    seed: int = 1
    roots: int = 1500
    meshes: int = 2000
    exact_formulas: int = 60
    workers: int = 2
    tolerance: Fraction = DEFAULT_TOLERANCE

    @property
    def complete(self) -> bool:
        """Whether this is the whole default run, whose findings must be exactly the known ones."""
        default = Plan()
        enough = min(self.count, self.exact_formulas) >= default.exact_formulas
        return enough and (self.families, self.seed) == (default.families, default.seed)


@dataclass(frozen=True)
class Batch:
    """The cases of one family: rows (n, 7), the exact decisions, and their positions as int8 (n,)."""

    family: Family
    seed: int
    rows: Rows
    decisions: tuple[Decision, ...]
    positions: Positions

    def head(self, count: int) -> Batch:
        """The first `count` cases."""
        return replace(self, rows=self.rows[:count], decisions=self.decisions[:count], positions=self.positions[:count])

    def name(self, index: int) -> str:
        """The id by which a case can be asked for again."""
        return case_id(self.family, self.seed, index)

    def place(self, index: int) -> Place:
        """Where a case stands in the family."""
        return 1, index


def chosen_families(plan: Plan) -> tuple[Family, ...]:
    """The families of the plan. Raises InputError naming one that does not exist."""
    return select(plan.families)


def batches(plan: Plan, families: Sequence[Family]) -> tuple[Batch, ...]:
    """The cases of every family, decided exactly."""
    return tuple(_batch(family, plan) for family in families)


def _batch(family: Family, plan: Plan) -> Batch:
    rows = family.rows(plan.seed, plan.count)
    decisions = tuple(exact.decide(Pair.from_row(row).lengths) for row in rows.tolist())
    positions = np.array([decision.position for decision in decisions], dtype=np.int8)
    return Batch(family, plan.seed, rows, decisions, positions)
