"""A diagnosis: wrong answers counted by the causes that explain them, and the causes that stand once all are counted.

Of each chunk, every wrong answer is compared with what each cause's rule gives at its row. The causes that give that
very answer are a set, and wrong answers are counted by set. Of the right answers some are compared, too: a rule that
errs at their rows is denied by them. Diagnoses of parts add up in any order, like tallies.

At the end a cause stands where hardly any right answer denies it. One that is a whole rule has to give most of the
wrong answers; it is asked first where it gives most of all, and more than the others together. Then come the causes
about places that are wrong in exact arithmetic, then those about rounding, and whole rules for what is left. What none
explains is unexplained.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from hypcheck.geometry.pair import COLUMNS
from hypcheck.geometry.rows import WAYS, Positions, Rows
from hypcheck.implementations.description import QUESTIONS, Domain, claimed
from hypcheck.runs import judge
from hypcheck.runs.causes import PLACES, SILENT, Answers, Asked, Cause, Standing
from hypcheck.runs.judge import Criterion, Status, WrongCase
from hypcheck.runs.leaning_slips import TILTED_SLIPS
from hypcheck.runs.slips import UPRIGHT_SLIPS
from hypcheck.runs.way_slips import WAY_SLIPS
from hypcheck.vectors import frozen
from hypcheck.vectors.families import is_extreme
from hypcheck.vectors.family import MARK
from hypcheck.vectors.invalid_rows import INVALID_CONTENTS

CAUSES: tuple[Cause, ...] = (*PLACES, *UPRIGHT_SLIPS, *TILTED_SLIPS, *WAY_SLIPS)
"""All causes; a set of them is a number with a bit for each, in this order."""

UNEXPLAINED = "unexplained"
"""What stands in place of a cause where none is known."""

_BITS = {cause.name: bit for bit, cause in enumerate(CAUSES)}

WITNESSES = 256
"""The number of right answers of a chunk, evenly chosen, that are compared with the rules."""

MOST = 0.8
"""A whole rule has to give this share of the wrong answers that it should explain."""

ROUNDED = 0.9
"""Roundings have to explain this share of what is left for them: else something else is wrong, and may be so there."""

FAILING = (Status.WRONG, Status.UNDECIDED)
"""The statuses of the wrong answers that a diagnosis is about."""

CasePlace = tuple[int, int]
"""The place of a case in its family: (0, n) for the n-th frozen vector, (1, n) for the n-th generated row."""


@dataclass(frozen=True, slots=True)
class Explained:
    """Wrong answers that the same causes explain: how many, and the worst of them with its place and its id."""

    cases: int
    place: CasePlace
    name: str
    worst: WrongCase

    @property
    def rank(self) -> tuple[float, CasePlace]:
        """The worst first: the largest error, then the first place."""
        return -self.worst.exponent, self.place


def together(parts: Iterable[Explained]) -> Explained:
    """All of these, of which there must be one at least."""
    some = tuple(parts)
    worst = min(some, key=lambda each: each.rank)
    return Explained(sum(each.cases for each in some), worst.place, worst.name, worst.worst)


@dataclass(frozen=True)
class Diagnosis:
    """Wrong answers by the set of causes that explain them, and how many right answers deny each cause, by name."""

    explained: Mapping[int, Explained] = field(default_factory=dict)
    denied: Mapping[str, int] = field(default_factory=dict)


def merged(parts: Iterable[Diagnosis]) -> Diagnosis:
    """The diagnosis of all answers of these, which may come in any order."""
    by_set: dict[int, list[Explained]] = {}
    denied: Counter[str] = Counter()
    for part in parts:
        denied.update(part.denied)
        for causes, each in part.explained.items():
            by_set.setdefault(causes, []).append(each)
    return Diagnosis({causes: together(by_set[causes]) for causes in sorted(by_set)}, dict(sorted(denied.items())))


def diagnose(
    asked: Asked, wrong: Sequence[WrongCase], right: Sequence[int], named: Sequence[tuple[CasePlace, str]]
) -> Diagnosis:
    """The diagnosis of answers to rows: the wrong cases, their places and ids, and the indices of the right answers."""
    failing = [(case, told) for case, told in zip(wrong, named, strict=True) if case.status in FAILING]
    if not failing:
        return Diagnosis()
    witnesses = list(right[:: max(1, -(-len(right) // WITNESSES))])
    share = len(right) / len(witnesses) if witnesses else 0.0
    places = [case.index for case, _ in failing]
    part = _part(asked, places + witnesses)
    sets, denied = [0] * len(failing), dict[str, int]()
    for bit, cause in enumerate(CAUSES):
        if cause.subject != asked.subject:
            continue
        answers = cause.rule(part)
        for place in np.flatnonzero(answers[: len(failing)] == part.given[: len(failing)]).tolist():
            sets[place] |= 1 << bit
        against = _against(answers[len(failing) :], part.given[len(failing) :])
        if against:
            denied[cause.name] = round(against * share)
    by_set: dict[int, list[Explained]] = {}
    for causes, (case, (at, name)) in zip(sets, failing, strict=True):
        by_set.setdefault(causes, []).append(Explained(1, at, name, case))
    return Diagnosis({causes: together(by_set[causes]) for causes in sorted(by_set)}, dict(sorted(denied.items())))


def denials(asked: Asked, suspected: Iterable[Cause]) -> dict[str, int]:
    """How many of these answers, which are all right, deny each of these causes, by name; those that none does."""
    found = {each.name: _against(each.rule(asked), asked.given) for each in suspected if each.subject == asked.subject}
    return {name: number for name, number in found.items() if number}


def suspects(diagnosis: Diagnosis) -> list[Cause]:
    """The causes that explain a wrong answer at least."""
    found = 0
    for causes in diagnosis.explained:
        found |= causes
    return [cause for cause in CAUSES if _has(found, cause)]


def _against(answers: Answers, given: Answers) -> int:
    return int(((answers != SILENT) & (answers != given)).sum())


def _part(asked: Asked, places: list[int]) -> Asked:
    times = None if asked.times is None else asked.times[places]
    rows = np.ascontiguousarray(asked.rows[places])
    return Asked(rows, asked.truth[places], asked.given[places], asked.criterion, times)


@dataclass(frozen=True, slots=True)
class CountedCause:
    """A cause that stands, None where wrong answers are unexplained; their number in each family, and the worst."""

    cause: Cause | None
    families: Mapping[str, int]
    worst: Explained

    @property
    def cases(self) -> int:
        """The number of wrong answers."""
        return sum(self.families.values())


@dataclass
class _Left:
    """Wrong answers that no cause has taken yet, by family and set of causes; `denied` as in Diagnosis."""

    explained: dict[tuple[str, int], Explained]
    denied: Mapping[str, int]

    def number(self, cause: Cause | None = None) -> int:
        """How many a cause explains; all without one."""
        return sum(each.cases for (_, causes), each in self.explained.items() if cause is None or _has(causes, cause))

    def covered(self, some: Sequence[Cause]) -> int:
        """How many one of these causes explains at least."""
        return sum(each.cases for (_, causes), each in self.explained.items() if any(_has(causes, one) for one in some))

    def take(self, cause: Cause | None = None) -> CountedCause | None:
        """What a cause explains, or all, which is no longer left; None if there is nothing."""
        found = {key: each for key, each in self.explained.items() if cause is None or _has(key[1], cause)}
        if not found:
            return None
        families: Counter[str] = Counter()
        for key, each in found.items():
            families[key[0]] += each.cases
            del self.explained[key]
        return CountedCause(cause, dict(families), together(found.values()))


CLEAN = 16
"""The number of frozen vectors of each family without a wrong answer that rule causes out."""


def causes_of(
    diagnoses: Mapping[str, Diagnosis], clean: Sequence[str], criterion: Criterion, domain: Domain
) -> list[CountedCause]:
    """The causes that stand, of the diagnoses of all families; `clean` families were asked and have no wrong answer."""
    suspected = suspects(merged(diagnoses.values()))
    if not suspected:
        return []
    denied: Counter[str] = Counter()
    for asked in _right_answers(clean, criterion, domain):
        denied.update(denials(asked, suspected))
    return findings(diagnoses, criterion, denied)


def _right_answers(clean: Sequence[str], criterion: Criterion, domain: Domain) -> Iterator[Asked]:
    """Frozen vectors of these families in the domain with the right answers to them."""
    layout = QUESTIONS[criterion.question].layout
    widths: dict[int, list[tuple[Rows, Positions]]] = {}
    for family in clean:
        if family in INVALID_CONTENTS or MARK in family:
            continue
        found = frozen.load(family)
        inside = claimed(found.rows, domain, criterion.precision, extreme=is_extreme(family), layout=layout)
        rows = found.rows[inside][:: max(1, len(inside) // CLEAN)]
        truth = found.positions[inside][:: max(1, len(inside) // CLEAN)]
        widths.setdefault(rows.shape[1], []).append((rows, truth))
    for some in widths.values():
        rows, truth = (
            np.ascontiguousarray(np.vstack([one for one, _ in some])),
            np.concatenate([one for _, one in some]),
        )
        given = truth if layout is WAYS else judge.expected(truth, criterion.question)
        yield Asked(rows, truth, given, criterion)


def findings(diagnoses: Mapping[str, Diagnosis], criterion: Criterion, denied: Mapping[str, int]) -> list[CountedCause]:
    """The causes that stand, most wrong answers first, what is unexplained last; `denied` comes from other families."""
    by_subject: dict[str, dict[str, Diagnosis]] = {}
    for family, each in diagnoses.items():
        if each.explained:
            worst = next(iter(each.explained.values())).worst
            by_subject.setdefault(_subject(worst, criterion), {})[family] = each
    found = [each for part in by_subject.values() for each in _findings(part, denied)]
    named: dict[str, list[CountedCause]] = {}
    for one in found:
        named.setdefault(one.cause.name if one.cause else "", []).append(one)
    joined = [_joined(some) for some in named.values()]
    return sorted(
        joined, key=lambda each: (each.cause is None, -each.cases, _BITS[each.cause.name] if each.cause else 0)
    )


def _joined(some: list[CountedCause]) -> CountedCause:
    families: Counter[str] = Counter()
    for each in some:
        families.update(each.families)
    return CountedCause(some[0].cause, dict(sorted(families.items())), together(each.worst for each in some))


def _subject(case: WrongCase, criterion: Criterion) -> str:
    if QUESTIONS[criterion.question].layout is WAYS:
        return "way"
    return "upright" if len(case.row) == len(COLUMNS) else "tilted"


def _findings(diagnoses: Mapping[str, Diagnosis], elsewhere: Mapping[str, int]) -> Iterator[CountedCause]:
    """The causes that stand, of families with rows of one subject."""
    denied = Counter(merged(diagnoses.values()).denied) + Counter(elsewhere)
    left = _Left(
        {(family, causes): each for family, one in diagnoses.items() for causes, each in one.explained.items()}, denied
    )
    everywhere = [cause for cause in CAUSES if cause.standing is Standing.EVERYWHERE and _stands(cause, left)]
    best = max(everywhere, key=left.number, default=None)
    rounding = [cause for cause in CAUSES if cause.standing is Standing.ROUNDING]
    places = [cause for cause in CAUSES if cause.standing is Standing.PLACE and _stands(cause, left)]
    known = [*places, *rounding]
    # A few families may hold nothing that denies a rule: what is known of their places explains as much then.
    if best is not None and left.number(best) >= MOST * left.number() and left.number(best) > left.covered(known):
        yield from _taken(left, best)
    for cause in places if 2 * left.covered(known) >= left.number() else []:  # else something else is wrong, there too
        yield from _taken(left, cause)
    if left.covered(rounding) >= ROUNDED * left.number():
        for cause in rounding:
            yield from _taken(left, cause)
    rest = [cause for cause in everywhere if left.number(cause) >= MOST * left.number() > 0]
    if rest:
        yield from _taken(left, max(rest, key=left.number))
    yield from _taken(left, None)


def _taken(left: _Left, cause: Cause | None) -> Iterator[CountedCause]:
    found = left.take(cause)
    if found is not None:
        yield found


def _stands(cause: Cause, left: _Left) -> bool:
    """Whether it explains something, and right answers hardly deny it."""
    number = left.number(cause)
    return number > 0 and left.denied.get(cause.name, 0) <= cause.slack * number


def _has(causes: int, cause: Cause) -> bool:
    return bool(causes >> _BITS[cause.name] & 1)
