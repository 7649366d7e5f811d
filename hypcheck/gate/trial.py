"""One implementation on some cases: asked, judged, every case with its status; and asked again later."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck import judge
from hypcheck.casebook.families import is_extreme
from hypcheck.gate.cases import Piece
from hypcheck.gate.known_failures import KnownFailure
from hypcheck.judge import Criterion, Status, WrongCase
from hypcheck.methods.domain import Domain, representable
from hypcheck.methods.faults import Outcome
from hypcheck.methods.implementation import Implementation
from hypcheck.rows import CANNOT_SAY, Positions, Rows

FAULTS_KEPT = 5
"""Cases without an answer that a group keeps with the reason; its counts are always exact."""

AGAIN_EACH = 32
"""Cases of each piece that are asked again at least; of large pieces, one in a hundred."""

AGAIN_AT_MOST = 100_000
"""Cases kept in all for asking again."""

AGAIN_ALONE = 64
"""Of these, cases asked one by one."""


@dataclass
class Tally:
    """What came of one family so far: the parts to be merged into one line of the record."""

    family: str
    parts: list[tuple[Piece, NDArray[np.intp], NDArray[Any], list[WrongCase]]] = field(default_factory=list)
    skipped: int = 0
    faults: list[dict[str, Any]] = field(default_factory=list)


@dataclass
class Sample:
    """Cases to be asked again: rows, exact positions, first answers, and where each status is kept."""

    rows: list[Rows] = field(default_factory=list)
    truth: list[Positions] = field(default_factory=list)
    answers: list[NDArray[np.int8]] = field(default_factory=list)
    homes: list[tuple[NDArray[Any], int, Tally, str]] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.homes)


@dataclass(frozen=True)
class Judge:
    """How answers are judged, and which failures are known; `used` collects the entries that excused something."""

    criterion: Criterion
    domain: Domain
    known: Sequence[KnownFailure]
    used: set[int] = field(default_factory=set)

    def excuses(self, case: str, family: str, error_u: float) -> bool:
        """Whether a known failure covers this wrong answer; every entry that does counts as used."""
        covering = [number for number, entry in enumerate(self.known) if entry.covers(case, family, error_u)]
        self.used.update(covering)
        return bool(covering)


def ask(implementation: Implementation, piece: Piece, rules: Judge, tally: Tally, sample: Sample) -> None:
    """Ask the cases of a piece that lie in the domain; add what came of them to the tally, and some to the sample."""
    criterion = rules.criterion
    claimed = rules.domain.holds(piece.rows, extreme=is_extreme(piece.family))
    places = np.flatnonzero(claimed & representable(piece.rows, criterion.precision))
    if implementation.most is not None:
        places = places[: implementation.most]
    tally.skipped += len(piece.rows) - len(places)
    rows, truth = np.ascontiguousarray(piece.rows[places]), piece.positions[places]
    answered = implementation.classify(rows)
    answers = np.where(answered.answered, answered.answers, CANNOT_SAY).astype(np.int8)
    wrong = judge.wrong_cases(rows, truth, answers, criterion)
    status = np.where(answers == CANNOT_SAY, Status.ABSTAINED.value, Status.RIGHT.value).astype(object)
    for outcome in Outcome:
        if outcome is not Outcome.ANSWERED:
            status[answered.status == outcome] = outcome.label
    for case in wrong:
        status[case.index] = _status(case, piece, int(places[case.index]), rules)
    for index in sorted(answered.reasons)[: FAULTS_KEPT - len(tally.faults)]:
        tally.faults.append(
            {
                "case": piece.name(int(places[index])),
                "row": [value.hex() for value in rows[index].tolist()],
                "status": str(status[index]),
                "reason": answered.reasons[index],
            }
        )
    tally.parts.append((piece, places, status, wrong))
    _keep(sample, tally, piece, places, rows, truth, answers, status)


def _status(case: WrongCase, piece: Piece, place: int, rules: Judge) -> str:
    if case.status is not Status.WRONG or not rules.known:
        return case.status.value
    error_u = judge.in_units(judge.measured(case, rules.criterion.question), rules.criterion.unit)
    return Status.EXCUSED.value if rules.excuses(piece.name(place), piece.family, error_u) else case.status.value


def _keep(  # the parallel arrays of one piece
    sample: Sample,
    tally: Tally,
    piece: Piece,
    places: NDArray[np.intp],
    rows: Rows,
    truth: Positions,
    answers: NDArray[np.int8],
    status: NDArray[Any],
) -> None:
    """Keep the last cases (the tail of a vector loop is there) and others spread over the piece."""
    wanted = min(max(AGAIN_EACH, len(rows) // 100 + 1), len(rows), AGAIN_AT_MOST - len(sample))
    if wanted <= 0:
        return
    chosen = np.unique(np.append(np.linspace(0, len(rows) - 1, wanted).astype(np.intp), len(rows) - 1))
    chosen = chosen[np.isin(status[chosen], _ANSWERED)]
    sample.rows.append(rows[chosen])
    sample.truth.append(truth[chosen])
    sample.answers.append(answers[chosen])
    sample.homes += [(status, index, tally, piece.name(int(places[index]))) for index in chosen.tolist()]


_ANSWERED = [each.value for each in (Status.RIGHT, Status.TOLERATED, Status.WRONG, Status.EXCUSED, Status.ABSTAINED)]


@dataclass(frozen=True, slots=True)
class Again:
    """What asking again came to: cases asked, and those answered differently, within the tolerance and beyond it."""

    asked: int
    within: int
    beyond: int


def ask_again(implementation: Implementation, sample: Sample, rules: Judge, seed: int) -> Again:
    """Ask the sample in another order, in other batch sizes and in a fresh process; mark what has changed."""
    if not len(sample):
        return Again(0, 0, 0)
    order = np.random.Generator(np.random.Philox(seed)).permutation(len(sample))
    rows, truth = np.concatenate(sample.rows)[order], np.concatenate(sample.truth)[order]
    before = np.concatenate(sample.answers)[order]
    implementation.fresh()
    within, beyond = 0, 0
    for start, stop, batch in _batches(len(rows)):
        part = np.ascontiguousarray(rows[start:stop])
        answered = implementation.classify(part, batch=batch)
        for offset in np.flatnonzero(answered.answered & (answered.answers != before[start:stop])).tolist():
            place = start + offset
            pair = np.array([before[place], answered.answers[offset]], dtype=np.int8)
            if _both_fit(rows[place], truth[place], pair, rules.criterion):
                within += 1
                continue
            beyond += 1
            status, index, tally, name = sample.homes[int(order[place])]
            status[index] = Status.NONDETERMINISTIC.value
            reason = f"answered {pair[0]} at first and {pair[1]} when asked again, in another order and batch"
            if len(tally.faults) < FAULTS_KEPT:
                row = [value.hex() for value in rows[place].tolist()]
                tally.faults.append({"case": name, "row": row, "status": str(status[index]), "reason": reason})
        for offset in np.flatnonzero(~answered.answered).tolist():
            status, index, tally, name = sample.homes[int(order[start + offset])]
            outcome = Outcome(int(answered.status[offset])).label
            status[index] = outcome
            if len(tally.faults) < FAULTS_KEPT:
                row = [value.hex() for value in part[offset].tolist()]
                reason = f"when asked again: {answered.reasons.get(offset, '')}"
                tally.faults.append({"case": name, "row": row, "status": outcome, "reason": reason})
    return Again(len(rows), within, beyond)


def _batches(n: int) -> list[tuple[int, int, int | None]]:
    """Where to cut n cases: some alone, half of the rest in odd batches, the others in full ones."""
    alone = min(AGAIN_ALONE, n)
    middle = alone + (n - alone) // 2
    return [(0, alone, 1), (alone, middle, 7), (middle, n, None)]


def _both_fit(row: NDArray[np.float64], truth: int, pair: NDArray[np.int8], criterion: Criterion) -> bool:
    """Whether both answers are right or tolerated, so that rounding may explain the change."""
    if CANNOT_SAY in pair:
        return False
    twice = np.stack([row, row])
    judged = judge.wrong_cases(twice, np.array([truth, truth], dtype=np.int8), pair, criterion)
    return all(case.status is Status.TOLERATED for case in judged)
