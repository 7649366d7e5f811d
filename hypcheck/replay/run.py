"""One case and one implementation: what is true, what it answers, what that is worth, and where its formula errs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hypcheck import judge
from hypcheck.casebook.families import is_extreme
from hypcheck.classification.agreement import DisagreementError
from hypcheck.errors import InputError
from hypcheck.judge import Criterion, Mistake, Status
from hypcheck.methods.description import Description
from hypcheck.methods.domain import representable
from hypcheck.methods.implementation import Implementation
from hypcheck.pairs import REFUSED, Pair, Position
from hypcheck.replay.case import Case
from hypcheck.replay.choosing import Choice, Subject, choose
from hypcheck.rows import CANNOT_SAY, Rows
from hypcheck.score import Score, ended, score
from hypcheck.tally import STATUSES
from hypcheck.truth import exact, flip
from hypcheck.truth.certificate import Certificate, check_certificate
from hypcheck.truth.exact import Decision
from hypcheck.truth.prove import prove

TOGETHER = 33
"""How often the row is asked in one question, once it was answered alone; odd, so that vector loops have a tail."""


@dataclass(frozen=True, slots=True)
class Truth:
    """The exact decision about a pair, its proof, and the distance to each other position as a backward error."""

    pair: Pair
    decision: Decision
    certificate: Certificate
    flips: Mapping[Position, float]


@dataclass(frozen=True, slots=True)
class Judgement:
    """How the case ended. `answer` is None where there was none, and `reason` says why, or what else is to be said.

    `mistake`, `error` (the backward error) and `error_u` (the same in units u) speak of a wrong answer, tolerated or
    not, and are None, 0 and 0 of every other.
    """

    status: Status
    answer: int | None
    reason: str = ""
    mistake: Mistake | None = None
    error: float = 0.0
    error_u: float = 0.0

    @property
    def passes(self) -> bool:
        """Whether it is right or within the tolerance."""
        return self.status in (Status.RIGHT, Status.TOLERATED, Status.REFUSED)


@dataclass(frozen=True, slots=True)
class Replay:
    """What is known of a case under an implementation; `truth` and `choice` are None of a row that is no pair."""

    case: Case
    spec: str
    declared: Description
    used: Description
    criterion: Criterion
    truth: Truth | None
    judgement: Judgement
    skipped: str | None
    choice: Choice | None


def replay(case: Case, implementation: Implementation, criterion: Criterion, formula: str | None) -> Replay:
    """Ask, judge and compare. Raises InputError where the row is no pair and the implementation refuses none.

    Raises DisagreementError where the proof that was found does not hold.
    """
    declared, used = implementation.declared, implementation.description
    rows = np.array([case.row])
    told = (case, str(implementation.spec), declared, used, criterion)
    if case.at_fault:
        if not used.refuses:
            raise InputError(
                f"{case.name} is no pair ({', '.join(case.at_fault)}), and {used.name} does not declare that it refuses"
                " such rows"
            )
        return Replay(*told, None, _refused(implementation, rows), None, None)
    truth = truth_of(Pair.from_row(case.row))
    judgement = _judged(implementation, rows, truth, criterion)
    subject = Subject(implementation.spec, declared, used, _usable(judgement.answer))
    choice = choose(subject, case.row, truth.decision.position, formula)
    return Replay(*told, truth, judgement, _skipped(case, used, criterion), choice)


def truth_of(pair: Pair) -> Truth:
    """Decide, prove, and check the proof. Raises DisagreementError where it does not hold."""
    decision = exact.decide(pair.lengths)
    certificate = prove(pair, decision)
    if certificate.position is not decision.position or not check_certificate(pair, certificate):
        raise DisagreementError(
            f"the proof found for {pair} does not hold; please report this, it is a fault of hypcheck"
        )
    others = (position for position in Position if position is not decision.position)
    flips = {position: flip.backward_error(pair.lengths, decision, position) for position in others}
    return Truth(pair, decision, certificate, flips)


def _usable(answer: int | None) -> int | None:
    return None if answer == CANNOT_SAY else answer


def _judged(implementation: Implementation, rows: Rows, truth: Truth, criterion: Criterion) -> Judgement:
    """The answer to the row alone, judged; another answer to the row asked many times at once is a fault of its own."""
    positions = np.array([truth.decision.position], dtype=np.int8)
    scored = score(rows, positions, implementation.classify(rows, batch=1), criterion)
    alone, answer = _alone(scored), int(scored.answers[0])
    if alone.answer is None:
        return alone
    again = implementation.classify(np.repeat(rows, TOGETHER, axis=0), batch=TOGETHER)
    changed = np.flatnonzero(~again.answered | (again.answers != answer))
    if not len(changed):
        return alone
    place = int(changed[0])
    otherwise = again.reasons.get(place, f"it answers {int(again.answers[place])}")
    reason = f"answers {answer} when asked alone; asked {TOGETHER} times at once, at place {place + 1}: {otherwise}"
    return Judgement(Status.NONDETERMINISTIC, answer, reason, alone.mistake, alone.error, alone.error_u)


def _alone(scored: Score) -> Judgement:
    """The judgement of the one row of a score."""
    status, answer = STATUSES[scored.status[0]], int(scored.answers[0])
    if not scored.answered[0]:
        return Judgement(status, None, scored.reasons.get(0, ""))
    for case in scored.judged():
        error = judge.measured(case, scored.criterion.question)
        in_units = judge.in_units(error, scored.criterion.unit)
        return Judgement(case.status, answer, mistake=case.mistake, error=error, error_u=in_units)
    return Judgement(status, answer)


def _refused(implementation: Implementation, rows: Rows) -> Judgement:
    answered = implementation.classify(rows, batch=1)
    status, answer = STATUSES[ended(answered)[0]], int(answered.answers[0])
    if not answered.answered[0]:
        return Judgement(status, None, answered.reasons.get(0, ""))
    if answer == REFUSED:
        return Judgement(Status.REFUSED, answer)
    return Judgement(Status.WRONG, answer, f"a row that is no pair must be refused with {REFUSED}")


def _skipped(case: Case, used: Description, criterion: Criterion) -> str | None:
    """Why a gating run would not ask the row; None where it would."""
    rows = np.array([case.row])
    if not representable(rows, criterion.precision)[0]:
        return f"a number of the row is neither zero nor normal in {criterion.precision}"
    asked = used.domain.holds(rows, extreme=is_extreme(case.name))[0]
    return None if asked else "the row lies outside the implementation's domain"
