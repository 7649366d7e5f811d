"""The invalid rows, for an implementation that says it refuses them: each must be answered 127."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from hypcheck.casebook import vectors
from hypcheck.casebook.frozen import refusals
from hypcheck.gate.results import Result
from hypcheck.gate.subject import Subject
from hypcheck.groups import Fault, Tally, merged
from hypcheck.judge import Status
from hypcheck.methods.faults import Outcome
from hypcheck.pairs import REFUSED


@dataclass(frozen=True, slots=True)
class Invalid:
    """All of the invalid rows."""


def ask_invalid(implementation: Subject) -> Result:
    """Ask them all."""
    file = vectors.load_refusals()
    answered = implementation.classify(file.rows)
    labels, faults = [], []
    for index, case in enumerate(file.cases):
        outcome, answer = Outcome(int(answered.status[index])), int(answered.answers[index])
        if outcome is not Outcome.ANSWERED:
            label, reason = outcome.label, answered.reasons.get(index, "")
        elif answer == REFUSED:
            label, reason = Status.REFUSED.value, ""
        else:
            label = Status.WRONG.value
            reason = f"answered {answer}; a row with an invalid {' and '.join(case.columns)} must be refused: {REFUSED}"
        labels.append(label)
        if label != Status.REFUSED.value:
            faults.append(Fault((0, index), case.id, tuple(map(float, case.row)), label, reason))
    told = Tally(asked=len(labels), counts=Counter(labels), faults=tuple(faults))
    return Result(tallies={refusals.NAME: merged([told])}, outcomes=answered.outcomes)
