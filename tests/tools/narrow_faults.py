"""How many narrow faults `hypcheck verify` rejects: `python -m tests.tools.narrow_faults [--seed N] [--count 4000]`.

A fault is an implementation that is right but in a slice: 0.3 to 1 % of the range of one coordinate, or 3 to 10 % of
each of two. There it is wrong by 1e-9 to 1e-5: one number or both sizes of the spheroid are changed by that share, or
all lengths go through float32. Faults are drawn from a seed that is new unless it is given, so that no family can be
made for them. A fault is rejected if a row that a run asks has an answer that is wrong beyond the tolerance.

`--without` leaves out families, as `--without strata,tilted-strata` does: the share that others reject. `search` is
the directed search.
"""

from __future__ import annotations

import random
import secrets
from dataclasses import dataclass
from fractions import Fraction

import click
import numpy as np

from hypcheck import classify
from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import Rows, within
from hypcheck.runs.border_search import MOST, SearchStep, first_of, rows_at, searched
from hypcheck.runs.cases import family_chunks, frozen_vectors
from hypcheck.runs.judge import Criterion, Status
from hypcheck.runs.spread import COORDINATES, UPRIGHT
from hypcheck.runs.tally import STATUS_CODES
from hypcheck.vectors.families import select
from tests.support.inside import decide, tolerated

TOLERANCE = Fraction(8, 1 << 53)
NAMES = ("alpha", "gamma", "b", "d", "x", "y", "z")


@dataclass(frozen=True, slots=True)
class Fault:
    """A slice, as the range of one coordinate or of two, and what is done to rows in it."""

    tilted: bool
    slices: tuple[tuple[str, float, float], ...]
    columns: tuple[int, ...]
    error: float

    def __str__(self) -> str:
        where = " and ".join(f"{name} {low:.4f} to {high:.4f}" for name, low, high in self.slices)
        names = " and ".join(NAMES[column] for column in self.columns)
        what = f"{names} changed by {self.error:+.1e}" if self.columns else "float32"
        return f"{'tilted' if self.tilted else 'upright'}, {where}: {what}"

    def inputs(self, rows: Rows) -> Rows:
        """The rows that are answered in place of these."""
        inside = np.ones(len(rows), dtype=np.bool_)
        for name, low, high in self.slices:
            places = COORDINATES[name](rows)
            inside &= (places >= low) & (places < high)
        changed = rows.copy()
        if not self.columns:
            changed[:, :7] = rows[:, :7].astype(np.float32)
        for column in self.columns:
            changed[:, column] *= 1 + self.error
        return np.where(inside[:, None], changed, rows)


def drawn(stream: random.Random) -> Fault:
    """One fault."""
    tilted = stream.random() < 1 / 3
    names = tuple(COORDINATES) if tilted else UPRIGHT
    if stream.random() < 0.5:
        slices = (_slice(stream, stream.choice(names), 0.003, 0.01),)
    else:
        slices = tuple(_slice(stream, name, 0.03, 0.1) for name in stream.sample(names, 2))
    columns = stream.choice([(), (2, 3), *((column,) for column in range(7))])
    error = stream.choice((-1, 1)) * 10 ** stream.uniform(-9, -5)
    return Fault(tilted, slices, columns, error)


def _slice(stream: random.Random, name: str, narrowest: float, widest: float) -> tuple[str, float, float]:
    width = stream.uniform(narrowest, widest)
    low = stream.uniform(0, 1 - width)
    return name, low, low + width


def asked(count: int, without: frozenset[str], *, tilted: bool) -> Rows:
    """The rows of a run by default, but for the number of generated ones; upright or tilted ones."""
    parts = []
    for family in select(taken=frozenset({"axis"})):
        if ("axis" in family.groups) is tilted and family.name not in without:
            for chunk in family_chunks(family, 1, count * family.times):
                if chunk.seed is None:
                    parts.append(frozen_vectors(family.name).rows)
                else:
                    parts.append(family.columns_between(chunk.seed, chunk.start, chunk.stop).T)
    rows = np.concatenate(parts)
    return rows[within(rows[:, :7])]


def rejected(fault: Fault, rows: Rows, right: np.ndarray) -> bool:
    """Whether an answer to one of these rows is wrong beyond the tolerance."""
    return _beyond(rows, answers_of(fault, rows), right)


def rejected_by_search(fault: Fault, count: int) -> bool:
    """Whether the directed search of a run, which follows the answers, asks a row whose answer is."""
    step = SearchStep("tilted-search" if fault.tilted else "search", 1, min(10 * count, MOST))
    found = False

    def ask(numbers: np.ndarray) -> np.ndarray:
        nonlocal found
        rows = rows_at(step.family, step.seed, numbers)
        answers, right = answers_of(fault, rows), np.asarray(classify(rows))
        found = found or _beyond(rows, answers, right)
        return np.where(answers == right, STATUS_CODES[Status.RIGHT], STATUS_CODES[Status.WRONG])

    searched(len(step), first_of(Criterion()), ask)
    return found


def answers_of(fault: Fault, rows: Rows) -> np.ndarray:
    """The answers of an implementation with this fault."""
    return np.asarray(classify(np.ascontiguousarray(fault.inputs(rows))))


def _beyond(rows: Rows, answers: np.ndarray, right: np.ndarray) -> bool:
    for place in np.flatnonzero(answers != right).tolist():
        pair = Pair.from_row(tuple(rows[place].tolist()))
        if not tolerated(pair, decide(pair.lengths), [Position(int(answers[place]))], TOLERANCE):
            return True
    return False


@click.command()
@click.option("--seed", type=int, help="Of the faults; a new one by default.")
@click.option("--faults", default=60, show_default=True)
@click.option("--count", default=400, show_default=True, help="As that of verify.")
@click.option("--without", default="", help="Families that are left out.")
def main(seed: int | None, faults: int, count: int, without: str) -> None:
    """Draw faults, and print which escape and the share that is rejected."""
    seed = secrets.randbelow(1 << 32) if seed is None else seed
    stream = random.Random(seed)  # noqa: S311 - nothing secret is drawn
    left_out = frozenset(without.split(","))
    rows = {tilted: asked(count, left_out, tilted=tilted) for tilted in (False, True)}
    right = {tilted: np.asarray(classify(rows[tilted])) for tilted in rows}
    caught = 0
    for fault in (drawn(stream) for _ in range(faults)):
        found = rejected(fault, rows[fault.tilted], right[fault.tilted])
        found = found or ("search" not in left_out and rejected_by_search(fault, count))
        caught += found
        if not found:
            click.echo(f"escaped: {fault}")
    click.echo(f"{caught} of {faults} faults of seed {seed} rejected, {caught / faults:.0%}")


if __name__ == "__main__":
    main()
