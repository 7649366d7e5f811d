"""One implementation on one chunk: asked, what is final judged and tallied, the rest kept to be asked again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hypcheck.gate.chunks import Chunk, cases
from hypcheck.gate.results import Open, Result
from hypcheck.gate.rules import Final, Indices, Rules, claimed, final
from hypcheck.gate.subject import Subject
from hypcheck.groups import CODES, FAULTS_KEPT, Codes, Fault
from hypcheck.judge import Status
from hypcheck.methods.asking import Answered
from hypcheck.methods.faults import Outcome
from hypcheck.rows import CANNOT_SAY, Rows

AGAIN_EACH = 32
"""Cases of each chunk that are asked again at least; of large chunks, one in a hundred."""

MOVEMENTS = 8
"""Movements of each chunk that are asked again at least, where its cases follow objects from moment to moment."""

_ANSWERED = (CODES[Status.RIGHT], CODES[Status.ABSTAINED])
_ENDED = np.array(
    [CODES[Status.RIGHT if each is Outcome.ANSWERED else Status(each.label)] for each in Outcome], dtype=np.int8
)


def ask(chunk: Chunk, implementation: Subject, rules: Rules) -> Result:
    """Ask the cases of a chunk that lie in the domain. Most are judged; the last ones stay open, to be asked again."""
    made = cases(chunk)
    indices = claimed(made, rules)[: implementation.most]
    rows = made.rows if len(indices) == len(made.rows) else made.rows[indices]
    answered = implementation.classify(rows)
    status = ended(answered)
    cut = _cut(chunk, indices)
    answers = np.isin(status[cut:], _ANSWERED)
    settled: slice | Indices = slice(cut)
    if not answers.all():
        settled = np.append(np.arange(cut), cut + np.flatnonzero(~answers))
    judged = final(
        Final(
            made,
            indices[settled],
            answered.answers[settled],
            status[settled],
            tuple(_faults(chunk, indices, rows, answered)),
            skipped=len(made.rows) - len(indices),
        ),
        rules,
    )
    kept = np.flatnonzero(answers) + cut
    return replace(judged, open=_open(chunk, indices[kept], answered.answers[kept]), outcomes=answered.outcomes)


def ended(answered: Answered) -> Codes:
    """How each row ended as far as that is known before it is judged: RIGHT where there is an answer to be judged."""
    status = _ENDED.take(answered.status)
    status[(answered.answers == CANNOT_SAY) & answered.answered] = CODES[Status.ABSTAINED]
    return status


def _cut(chunk: Chunk, indices: Indices) -> int:
    """From where on the asked cases stay open: a vector loop's tail is among the last, and so are whole movements."""
    wanted = max(AGAIN_EACH, len(indices) // 100 + 1)
    if chunk.movement > 1:
        wanted = max(wanted, MOVEMENTS * chunk.movement)
    cut = max(0, len(indices) - wanted)
    if chunk.movement > 1 and cut:
        first = chunk.start + int(indices[cut])
        cut = int(np.searchsorted(indices, first - first % chunk.movement - chunk.start))
    return cut


def _open(chunk: Chunk, indices: Indices, answers: Codes) -> tuple[Open, ...]:
    if not len(indices):
        return ()
    first, last = int(indices[0]), int(indices[-1]) + 1
    return (Open(chunk.between(first, last), indices - first, answers),)


def _faults(chunk: Chunk, indices: Indices, rows: Rows, answered: Answered) -> Iterator[Fault]:
    """The first cases of each way to end without an answer, with the reason."""
    for outcome in Outcome:
        if outcome is not Outcome.ANSWERED:
            for place in np.flatnonzero(answered.status == outcome)[:FAULTS_KEPT].tolist():
                index = int(indices[place])
                reason = answered.reasons.get(place, "")
                yield Fault(chunk.place(index), chunk.name(index), tuple(rows[place].tolist()), outcome.label, reason)
