"""A diagnosis: wrong answers are counted by the causes that explain them; some causes are then confirmed.

In each chunk, every wrong answer is compared with the answer of each cause's rule at the same row. The causes that give
the same answer form a set, and wrong answers are counted by set. Some right answers are compared too: a right answer at
a row where a rule is wrong denies that rule. Diagnoses of parts add up in any order, like tallies.

At the end a cause is accepted if hardly any right answer contradicts it. An implementation may have several
faults, so each wrong answer is counted for one cause; the cause that explains most of the answers that are left comes
first. A whole rule comes first if it explains more than the others together. Then come the causes about places that are
wrong in exact arithmetic, then the causes about rounding, then whole rules for the rest. Answers that no cause explains
are unexplained.

Where floats are often right by luck, and where roundings may give any answer, right answers deny little. A cause of
this kind is accepted only if it explains most of the answers that are left, or if wrong answers are much more frequent
at its rows than elsewhere.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from msgspec import structs

from hypcheck.geometry.pair import Groups
from hypcheck.geometry.rows import Layout, Positions, Rows
from hypcheck.implementations.description import QUESTIONS
from hypcheck.implementations.domain import Domain, claimed
from hypcheck.record.fields import Extended, Unsigned, numbers_of, row_fields, row_of
from hypcheck.record.progress import Explained, Place, Tally, WorstCase
from hypcheck.runs import judge
from hypcheck.runs.causes import SILENT, AnsweredRows, Answers, Cause, Scope
from hypcheck.runs.formula_errors import TILTED_FORMULA_ERRORS, UPRIGHT_FORMULA_ERRORS
from hypcheck.runs.judge import Criterion, Mistake, Status, WrongCase
from hypcheck.runs.place_causes import PLACES, ROOT_CAUSES, WIDER_ROUNDINGS
from hypcheck.runs.sweep_causes import SWEEP_CAUSES
from hypcheck.vectors import frozen
from hypcheck.vectors.families import is_extreme
from hypcheck.vectors.invalid_rows import INVALID_CONTENTS

PLACE_CAUSES: tuple[Cause, ...] = (*PLACES, *ROOT_CAUSES, *WIDER_ROUNDINGS)
"""The causes about places of upright spheroids."""

CAUSES: tuple[Cause, ...] = (*PLACE_CAUSES, *UPRIGHT_FORMULA_ERRORS, *TILTED_FORMULA_ERRORS, *SWEEP_CAUSES)
"""All causes; a set of them is a number with a bit for each, in this order."""

_BITS = {cause.name: bit for bit, cause in enumerate(CAUSES)}

WITNESSES = 256
"""The number of right answers of a chunk, evenly chosen, that are compared with the rules."""

MIXED = 0.25
"""A cause about every row is accepted only if it explains at least this share of the answers that are left for it."""

PLACED = 0.5
"""Causes about places are accepted together if they explain this share of the wrong answers."""

ROUNDED = 0.9
"""Causes about rounding are accepted together if they explain this share of the answers that are left for them."""

LIFT = 4.0
"""Else wrong answers must be this many times as frequent at a cause's rows as at others: it may be chance otherwise."""

CERTAIN = 200
"""The number of right answers that may be luck which contradict a cause as much as one that cannot be luck."""

RIGHT = "right"
"""Among the counts of right answers that deny a cause, the count of all right answers."""

FAILING = (Status.WRONG, Status.UNDECIDED)
"""The statuses of the wrong answers that a diagnosis is about."""


def kept_case(case: WrongCase, place: Place, name: str, layout: Layout, error: float) -> WorstCase:
    """Make the record's struct of a wrong answer at that place with that id; `error` is its size if that is known."""
    return WorstCase(
        place=place,
        case=name,
        **row_fields(case.row, layout),
        truth=int(case.truth),
        answer=case.answer,
        mistake=case.mistake.value,
        status=case.status.value,
        error=Unsigned(error),
        time=case.time,
    )


def measured_worst(explained: Explained, question: str) -> WorstCase:
    """Measure the error of the worst of some wrong answers, and return it with this error."""
    worst, exponent, least = explained.worst, float(explained.exponent), float(explained.worst.error)
    mistake, status = Mistake(worst.mistake), Status(worst.status)
    case = WrongCase(0, row_of(worst), worst.truth, worst.answer, mistake, status, exponent, worst.time, least)
    return structs.replace(worst, error=Unsigned(judge.measured(case, question)))


def _joined(parts: Sequence[Explained]) -> Explained:
    """Add one part or more, and keep the worst answer: that with the largest error, then the first place."""
    worst = min(parts, key=lambda explained: (-explained.exponent, explained.worst.place))
    return structs.replace(worst, cases=sum(explained.cases for explained in parts))


def merged(parts: Iterable[Explained]) -> list[Explained]:
    """Add the parts with the same set of causes. The result is sorted by set; the order of the parts has no effect."""
    by_set: dict[int, list[Explained]] = {}
    for explained in parts:
        by_set.setdefault(int(explained.causes, 16), []).append(explained)
    return [_joined(by_set[causes]) for causes in sorted(by_set)]


def with_diagnosis(
    tally: Tally,
    answered: AnsweredRows,
    wrong: Sequence[WrongCase],
    right: Sequence[int],
    named: Sequence[tuple[Place, str]],
) -> Tally:
    """Return a tally to which the diagnosis of its answers is added.

    `answered` are the tested rows. `wrong` are the wrong cases, `named` their places and ids, and `right` the indices
    of the right answers.
    """
    failing = [
        (case, place_and_name) for case, place_and_name in zip(wrong, named, strict=True) if case.status in FAILING
    ]
    if not failing:
        return tally
    witnesses = list(right[:: max(1, -(-len(right) // WITNESSES))])
    right_per_witness = len(right) / len(witnesses) if witnesses else 0.0
    places = [case.index for case, _ in failing]
    part = answered.part(places + witnesses)
    sets, denied = [0] * len(failing), {RIGHT: len(right)}
    for bit, cause in enumerate(CAUSES):
        if cause.subject != answered.subject:
            continue
        answers = cause.rule(part)
        for place in np.flatnonzero(answers[: len(failing)] == part.given[: len(failing)]).tolist():
            sets[place] |= 1 << bit
        against = (
            _exposed(cause, answered.part(witnesses)) if cause.rounds else _against(cause, part, answers, len(failing))
        )
        if against:
            denied[cause.name] = round(against * right_per_witness)
    by_set: dict[int, list[tuple[WrongCase, tuple[Place, str]]]] = {}
    for causes, one in zip(sets, failing, strict=True):
        by_set.setdefault(causes, []).append(one)
    layout = answered.criterion.layout
    explained = [_explained(causes, by_set[causes], layout) for causes in sorted(by_set)]
    return structs.replace(tally, explained=explained, denied=dict(sorted(denied.items())))


def _explained(causes: int, some: Sequence[tuple[WrongCase, tuple[Place, str]]], layout: Layout) -> Explained:
    """Make the record's struct of wrong answers with the same set of causes; it has their number and the worst one."""
    case, (place, name) = min(some, key=lambda one: (-one[0].exponent, one[1][0]))
    worst = kept_case(case, place, name, layout, case.least)
    return Explained(causes=f"{causes:x}", cases=len(some), worst=worst, exponent=Extended(case.exponent))


def _against(cause: Cause, answered: AnsweredRows, answers: Answers, first: int = 0) -> int:
    """Count the given answers, from the index `first` on, that contradict a rule which gives `answers`.

    An answer that cannot be right by luck counts CERTAIN times more.
    """
    other = (answers != SILENT) & (answers != answered.given)
    other[:first] = False
    certain = 0 if cause.certain is None or not other.any() else int((other & cause.certain(answered)).sum())
    return int(other.sum()) + CERTAIN * certain


def _exposed(cause: Cause, answered: AnsweredRows) -> int:
    """Count these right answers at rows where a cause about rounding would explain another answer."""
    exposed = np.zeros(len(answered.rows), dtype=bool)
    for answer in (-1, 0, 1):
        other = replace(answered, given=np.full(len(answered.rows), answer, dtype=np.int8))
        exposed |= (cause.rule(other) == answer) & (answered.given != answer)
    return int(exposed.sum())


@dataclass(frozen=True, slots=True)
class CountedCause:
    """An accepted cause (None: unexplained), the number of its wrong answers in each family, and the worst of them."""

    cause: Cause | None
    families: Mapping[str, int]
    worst: Explained

    @property
    def cases(self) -> int:
        """The number of wrong answers."""
        return sum(self.families.values())


@dataclass
class _Left:
    """Wrong answers that no cause has taken yet, by family and set of causes; and the answers taken by causes."""

    explained: dict[tuple[str, int], Explained]
    taken: list[CountedCause] = field(default_factory=list)

    @property
    def total(self) -> int:
        """The number of wrong answers that are left."""
        return sum(explained.cases for explained in self.explained.values())

    def number(self, *some: Cause) -> int:
        """Count the wrong answers that at least one of these causes explains."""
        bits = _bits(some)
        return sum(explained.cases for (_, causes), explained in self.explained.items() if causes & bits)

    def take_each(self, some: Sequence[Cause], *, least: float = 0.0, in_order: bool = False) -> None:
        """Let each cause take the answers that it explains: the cause with most answers first, or the causes in order.

        End at the first cause that explains less than the share `least` of the answers that are left.
        """
        waiting = list(some)
        while waiting and self.total:
            cause = waiting[0] if in_order else max(waiting, key=self.number)
            if self.number(cause) < least * self.total:
                return
            self.take(cause)
            waiting.remove(cause)

    def take(self, cause: Cause | None) -> None:
        """Take the wrong answers that a cause explains; None takes all."""
        bits = None if cause is None else _bits([cause])
        taken = {key: explained for key, explained in self.explained.items() if bits is None or key[1] & bits}
        families: Counter[str] = Counter()
        for key, explained in taken.items():
            families[key[0]] += explained.cases
            del self.explained[key]
        if taken:
            self.taken.append(CountedCause(cause, families, _joined(list(taken.values()))))


def _bits(some: Iterable[Cause]) -> int:
    """Return a set of causes as a number with one bit for each cause."""
    return sum(1 << _BITS[cause.name] for cause in some)


CLEAN = 16
"""The number of frozen vectors of each family without a wrong answer that rule causes out."""


def causes_of(
    tallies: Mapping[str, Tally], clean: Sequence[str], criterion: Criterion, domain: Domain
) -> list[CountedCause]:
    """Return the accepted causes of a whole run, those with most wrong answers first, unexplained answers last.

    `clean` are the tested families without a wrong answer.
    """
    by_subject: dict[str, dict[str, Tally]] = {}
    for family, tally in tallies.items():
        if tally.explained:
            numbers = numbers_of(tally.explained[0].worst)
            by_subject.setdefault(criterion.layout.subject(numbers), {})[family] = tally
    if not by_subject:
        return []
    explaining = {int(explained.causes, 16) for tally in tallies.values() for explained in tally.explained}
    suspects = [cause for cause in CAUSES if any(causes & _bits([cause]) for causes in explaining)]
    denied: Counter[str] = Counter()
    for answered in _right_answers(clean, criterion, domain):
        for cause in suspects:
            if cause.subject == answered.subject and not cause.rounds:
                denied[cause.name] += _against(cause, answered, cause.rule(answered))
    named: dict[str, list[CountedCause]] = {}
    for part in by_subject.values():
        for one in _accepted(part, denied):
            named.setdefault(one.cause.name if one.cause else "", []).append(one)
    return sorted(
        map(_in_all_families, named.values()),
        key=lambda counted: (counted.cause is None, -counted.cases, _BITS[counted.cause.name] if counted.cause else 0),
    )


def _right_answers(clean: Sequence[str], criterion: Criterion, domain: Domain) -> Iterator[AnsweredRows]:
    """Yield the frozen vectors of these families that lie in the domain, with the right answers as the given ones."""
    layout = QUESTIONS[criterion.question].layout
    by_groups: dict[Groups, list[tuple[Rows, Positions]]] = {}
    for family in clean:
        if family in INVALID_CONTENTS or family not in frozen.ALL_NAMES:
            continue
        family_vectors = frozen.load(family)
        inside = claimed(family_vectors.rows, domain, criterion.precision, extreme=is_extreme(family), layout=layout)
        rows = family_vectors.rows[inside][:: max(1, len(inside) // CLEAN)]
        truth = family_vectors.positions[inside][:: max(1, len(inside) // CLEAN)]
        by_groups.setdefault(layout.groups(rows), []).append((rows, truth))
    for some in by_groups.values():
        rows, truth = (
            np.ascontiguousarray(np.vstack([one for one, _ in some])),
            np.concatenate([one for _, one in some]),
        )
        right_answers = judge.expected(truth, criterion.question)
        yield AnsweredRows(rows, truth, right_answers, criterion)


def _in_all_families(some: list[CountedCause]) -> CountedCause:
    """Add what one cause explains in the families of several subjects."""
    families: Counter[str] = Counter()
    for counted in some:
        families.update(counted.families)
    return CountedCause(some[0].cause, dict(sorted(families.items())), _joined([counted.worst for counted in some]))


def _accepted(tallies: Mapping[str, Tally], elsewhere: Mapping[str, int]) -> list[CountedCause]:
    """Return the accepted causes for the families of one subject, in the order in which they took their answers.

    `elsewhere` has the number of right answers of other families that contradict each cause.
    """
    denied = Counter(elsewhere)
    for tally in tallies.values():
        denied.update(tally.denied)
    left = _Left(
        {
            (family, int(explained.causes, 16)): explained
            for family, tally in tallies.items()
            for explained in tally.explained
        }
    )

    def of(scope: Scope) -> list[Cause]:
        """Return the causes of this scope that explain some wrong answer, and that right answers hardly contradict."""
        some = ((cause, left.number(cause)) for cause in CAUSES if cause.scope is scope)
        return [
            cause for cause, number in some if number and (cause.rounds or denied[cause.name] <= cause.slack * number)
        ]

    def stands_out(cause: Cause, others: Sequence[Cause]) -> bool:
        """Return whether wrong answers are much more frequent at its rows than at rows that no other cause explains."""
        inside, outside = left.number(cause), left.total - left.number(*others)
        right = denied[RIGHT] - denied[cause.name]
        return inside * (outside + right) > LIFT * outside * (inside + denied[cause.name])

    everywhere, places, rounding = of(Scope.EVERYWHERE), of(Scope.PLACE), of(Scope.ROUNDING)
    known = [*places, *rounding]
    first = max(everywhere, key=left.number, default=None)
    # If only a few families were tested, nothing may deny a rule; causes about places explain as much then.
    if first is not None and left.number(first) > max(MIXED * left.total, left.number(*known)):
        left.take(first)
    if left.number(*known) < PLACED * left.total:  # another fault exists, and may be wrong there by chance
        places = [cause for cause in places if cause.slack < 1 or stands_out(cause, known)]
    left.take_each(places)
    if left.number(*rounding) < ROUNDED * left.total:
        rounding = [cause for cause in rounding if stands_out(cause, rounding)]
    left.take_each(rounding, in_order=True)
    left.take_each(everywhere, least=MIXED)
    left.take(None)
    return left.taken
