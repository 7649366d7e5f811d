"""A directed search in a run: it finds where an implementation's answers change on lines across the border of contact.

On a line (vectors/border_lines.py) a spheroid grows: it is clear until it touches, and in contact after that. A line is
divided into rungs by distance from the border. Each side of the border is searched separately for the rung from which
all farther answers are right:

- A few far sides are searched first. Their first rungs are spread evenly over all distances. While answers are right,
  the search of a far side halves the distance to the border.
- The search of a near side begins just beyond the distances from the border at which most wrong answers are tolerated.
  If the answer there is right, the search of this side ends. If it is wrong, even by less than the tolerance, the
  search goes outwards in doubled steps until an answer is right, and then halves the range between the last wrong and
  the first right rung. Its rows are those at which the implementation's border differs from the true one.

Every tested row is judged by the exact truth, like the rows of any family. The run fixes the number of rows: if the
sides of a line need no more rows, new lines begin. The rows depend only on the seed and the answers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from itertools import count, islice

import numpy as np
from msgspec import structs

from hypcheck.geometry.rows import Indices, Rows
from hypcheck.implementations.implementation import Crashed, Implementation
from hypcheck.runs.cases import CaseChunk, ChunkCases
from hypcheck.runs.judge import Criterion, Status, truth_of
from hypcheck.runs.results import CasesResult, JudgingRules, merged_result, result_of_final
from hypcheck.runs.score import score
from hypcheck.runs.tally import EMPTY, STATUS_CODES, StatusCodes
from hypcheck.vectors.border_lines import FARTHEST_OCTAVE, LINES, NEAREST_OCTAVE, RUNGS, RUNGS_ON_A_SIDE, SEARCHED

ROUNDS = 32
"""A search sends half of its rows first, whatever the answers are; after that it sends one in ROUNDS of them at a
time."""

FAR = 32
"""A search has one far line for every FAR of its rows."""

MOST = 40_000
"""The most rows of a search. It holds all its sides in memory."""

_CLEARLY = 4
"""A near side begins at this multiple of the tolerated change. Changes of all numbers of a row may add up."""

_GOLDEN = 0.6180339887498949


@dataclass(frozen=True, slots=True)
class SearchStep:
    """The step of a run that tests `rows` rows of a search; the seed determines the search's lines."""

    family: str
    seed: int
    rows: int

    def __len__(self) -> int:
        return self.rows

    @property
    def chunk(self) -> CaseChunk:
        """All rows that the search may test, as a chunk that gives their names and places."""
        return CaseChunk(self.family, self.seed, 0, -(-self.rows // LINES) * LINES * RUNGS)


@dataclass(slots=True)
class _Side:
    """One side of a line: the `first` tested rung, and the range of rungs in which answers become right.

    Answers at the rung `wrong` and nearer to the border are wrong; at the start `wrong` is the rung before the first
    tested one, where a wrong answer would be tolerated. The answer at the rung `right` is right; `right` is None until
    an answer was right. `next` is the rung to test next;
    None if the search of this side has ended.
    """

    number: int
    wrong: int
    next: int | None
    right: int | None = None
    begun: int = field(init=False)

    def __post_init__(self) -> None:
        self.begun = self.wrong

    def take(self, status: int) -> None:
        """Take the status of the answer at the rung `next`, and choose the rung to test after it."""
        rung = self.next
        self.next = None
        if rung is None or status not in (_RIGHT, _WRONG):
            return
        if status == _RIGHT:
            self.right = rung
        else:
            self.wrong = rung
        if self.right is None:
            further = min(2 * rung - self.begun, RUNGS_ON_A_SIDE - 1)
            self.next = further if further > rung else None
        elif self.right - self.wrong > 1:
            self.next = (self.wrong + self.right) // 2


_RIGHT, _WRONG = STATUS_CODES[Status.RIGHT], STATUS_CODES[Status.WRONG]


def searched(rows: int, first: int, ask: Callable[[Indices], StatusCodes]) -> None:
    """Test `rows` rows of a search that begins at the rung `first`.

    `ask` takes the ascending numbers of rows in the family, and returns the status of each answer. A wrong answer has
    the status wrong, because whether it is tolerated is judged later.
    """
    sides = _sides(first, rows // FAR)
    active: list[_Side] = []
    left = rows
    while left:
        together = at_first(rows) if left == rows else -(-rows // ROUNDS)
        active = active[:left]
        active += islice(sides, max(0, min(left, together) - len(active)))
        active.sort(key=_place)
        status = ask(np.array([_place(side) for side in active], dtype=np.int64))
        left -= len(active)
        for side, ended in zip(active, status.tolist(), strict=True):
            side.take(ended)
        active = [side for side in active if side.next is not None]


def at_first(rows: int) -> int:
    """Return the number of sides that a search of `rows` rows begins with. It leaves rows for the steps that follow."""
    return -(-rows // 2)


def first_near_rows(step: SearchStep, first: int) -> Rows:
    """Return the first rows of the near sides of a search that begins at the rung `first`."""
    sides = islice(_sides(first, step.rows // FAR), at_first(step.rows))
    near = np.array([_place(side) for side in sides][2 * (step.rows // FAR) :], dtype=np.int64)
    return rows_at(step.family, step.seed, near)


def far_numbers(step: SearchStep, first: int) -> Indices:
    """Return the numbers in the family of the rows at which the far sides of a search begin."""
    sides = islice(_sides(first, step.rows // FAR), 2 * (step.rows // FAR))
    return np.array([_place(side) for side in sides], dtype=np.int64)


def _sides(first: int, far: int) -> Iterator[_Side]:
    """Yield the sides of all lines, without end: first `far` far sides, then near sides."""
    begins = far_rungs(first, far)
    for number, begin in enumerate(begins):
        yield _Side(number, first - 1, begin)
    for number in count(len(begins)):
        yield _Side(number, first - 1, first)


def far_rungs(first: int, far: int) -> list[int]:
    """Return the rungs at which the sides of `far` far lines begin: evenly spread from the rung `first` outwards."""
    shares = ((line + side / 2) * _GOLDEN % 1 for line in range(far) for side in (0, 1))
    return [first + int(share * (RUNGS_ON_A_SIDE - first)) for share in shares]


def _place(side: _Side) -> int:
    """Return the number, in its family, of the row that the search of this side tests next."""
    line, half = divmod(side.number, 2)
    return line * RUNGS + half * RUNGS_ON_A_SIDE + (side.next or 0)


def first_of(criterion: Criterion) -> int:
    """Return the rung at which a search begins: most wrong answers at rungs nearer to the border are tolerated."""
    tolerated = float(criterion.tolerance * criterion.unit)
    if not tolerated:
        return 0
    share = (math.log2(_CLEARLY * tolerated) - NEAREST_OCTAVE) / (FARTHEST_OCTAVE - NEAREST_OCTAVE)
    return min(max(0, math.ceil(share * RUNGS_ON_A_SIDE)), RUNGS_ON_A_SIDE - 1)


def rows_at(family: str, seed: int, places: Indices) -> Rows:
    """Return the rows of a searched family with these ascending numbers."""
    lines, rungs = np.divmod(places, RUNGS)
    if not len(places):
        return np.empty((0, len(SEARCHED[family].columns)))
    parts = []
    for lattice in sorted({*(lines // LINES).tolist()}):
        some = lines // LINES == lattice
        parts.append(SEARCHED[family].rungs(seed, lattice, lines[some] % LINES, rungs[some]))
    return np.ascontiguousarray(np.concatenate(parts))


def ask_search(step: SearchStep, implementation: Implementation | Crashed, rules: JudgingRules) -> CasesResult:
    """Perform a search. All its answers are judged at once, without a retest."""
    parts: list[CasesResult] = []
    most = len(step) if implementation.max_rows is None else min(len(step), implementation.max_rows)

    def ask(places: Indices) -> StatusCodes:
        rows = rows_at(step.family, step.seed, places)
        inside, left_out = rules.asked_of(step.family, rows)
        chosen = np.ascontiguousarray(rows[inside])
        answered = implementation.classify(chosen)
        scored = score(chosen, truth_of(chosen, rules.criterion.layout), answered, rules.criterion)
        cases = ChunkCases(step.chunk, chosen, np.ascontiguousarray(chosen.T), scored.truth)
        result = result_of_final(cases, places[inside], scored, rules, left_out=left_out)
        parts.append(replace(result, outcomes=answered.outcomes))
        status = np.full(len(places), STATUS_CODES[Status.SKIPPED], dtype=np.int8)
        status[inside] = scored.status
        return status

    searched(most, first_of(rules.criterion), ask)
    if most < len(step):
        left_out = {"slow": len(step) - most}
        skipped = structs.replace(EMPTY, counts={Status.SKIPPED.value: len(step) - most}, not_asked=left_out)
        parts.append(CasesResult(tallies={step.family: skipped}))
    return merged_result(parts)
