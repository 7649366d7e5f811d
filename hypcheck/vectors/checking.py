"""The check of vector files: each is read strictly, its metadata is compared, and every label is proved.

Each label is proved, or computed again by an oracle that did not make it. Position and tangency follow only from the
certificate (truth/certificate.py, with shows_crossing: rational arithmetic). The roots give the kind of an upright
pair, the nearest point the clearance. Labels are made by the exact decision, which shares no code with these checks.
Distances to other answers rest on exact decisions and are computed again; for tilted spheroids each end of the bracket
is proved again. The flags are computed again, too (labels.py). For a sweep, answer and first contact follow only from
the certificate (truth/certificate.py).

This program checks a flag by its own definition, but readers use the definition in the file, so both must agree. The
description of a family of this program must be that of its generator's version. If the version is older, or the family
is not of this program, the right description is not known here, and the description is not compared.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import chain

from hypcheck.errors import NothingJudgedError
from hypcheck.geometry.pair import Pair, Position
from hypcheck.tables.numbers import decimal_of, shown_json
from hypcheck.tables.strict_json import read_document
from hypcheck.truth import exact, least
from hypcheck.truth.backward_error import excluded_at_once, is_bracket
from hypcheck.truth.certificate import check_certificate, check_passage, contact_at
from hypcheck.truth.changes import goal_of
from hypcheck.truth.exact import Decision
from hypcheck.truth.nearest import nearest
from hypcheck.truth.roots import classify_by_roots
from hypcheck.truth.swept import passage_of_row
from hypcheck.vectors import frozen
from hypcheck.vectors.cases import (
    StoredCertificate,
    Vector,
    cases_of,
)
from hypcheck.vectors.draw import Row
from hypcheck.vectors.format import CaseFile, Content, FlagFacts, Metadata
from hypcheck.vectors.invalid_rows import InvalidRow, columns_at_fault
from hypcheck.vectors.labels import flags_of, flips, shows_crossing, sweep_flags


@dataclass(frozen=True, slots=True)
class LabelFault:
    """A wrong label: the line of its case (0 if it was not read from a file), its id, and the error."""

    line: int
    case: str
    sentence: str


def faults_of(file: CaseFile) -> list[LabelFault]:
    """Find every wrong label of a file of cases, in order; of rows to refuse, each wrong claim about faulty columns."""
    sentences_of_cases: Iterable[Iterator[str]]
    if file.content.refused:
        sentences_of_cases = (_wrong_columns(case, file.content.columns) for case in file.cases)
    else:
        sentences_of_cases = (_of_sweeps if file.content.about_sweeps else _of_positions)(file)
    return [
        LabelFault(line, case.id, sentence)
        for (line, case), sentences in zip(file.numbered_cases(), sentences_of_cases, strict=True)
        for sentence in sentences
    ]


def _wrong_columns(case: InvalidRow, columns: tuple[str, ...]) -> Iterator[str]:
    """Yield a sentence if the columns that a refused row names are not those at fault."""
    actual = columns_at_fault(case.row, columns)
    if actual != case.columns:
        claim = f"columns {', '.join(case.columns)} are said to be at fault"
        yield f"{claim}, but {', '.join(actual) or 'none'} is"


def _of_positions(file: CaseFile) -> Iterator[Iterator[str]]:
    """Yield for each case of a file of pairs the sentences about its wrong labels."""
    content, cases = file.content, file.cases
    pairs = [Pair.from_row(case.row) for case in cases]
    truths = [exact.decide(pair.lengths) for pair in pairs]
    flags = flags_of(content, [case.row for case in cases], truths)
    proved = _proved_lower_ends(cases if content.tilted else ()) or [set()] * len(cases)
    unproved = _unproved_by_rule if content.ended else _unproved
    for case, pair, truth, held, ends in zip(cases, pairs, truths, flags, proved, strict=True):
        yield chain(unproved(case, pair, truth), _wrong_measures(case, content, pair, truth, ends, held))


def _unproved(case: Vector, pair: Pair, _truth: Decision) -> Iterator[str]:
    """Yield a sentence if the certificate does not prove the position, or the tangency."""
    contact = case.position is Position.CONTACT
    claim = f"{case.position.label}, tangent" if case.tangent else case.position.label
    if not check_certificate(pair, case.certificate):
        yield f"the certificate does not prove {claim}"
    elif case.tangent != (contact and case.witness.double_root is not None):
        yield f"the certificate is not one of a pair that is {claim}"
    elif contact and not case.tangent and not shows_crossing(case.row, case.witness.offsets):
        yield "the certificate proves contact, but does not rule tangency out"


def _unproved_by_rule(case: Vector, pair: Pair, truth: Decision) -> Iterator[str]:
    """Yield sentences as _unproved does, for a hyperboloid that ends.

    A contact may have no certificate. Then the exact decision must confirm it. The least value of truth/least.py must
    not contradict any position.
    """
    other = least.position(pair)
    claim = f"{case.position.label}, tangent" if case.tangent else case.position.label
    by_rule = case.witness == StoredCertificate() and case.position is Position.CONTACT
    if not by_rule and not check_certificate(pair, case.certificate):
        yield f"the certificate does not prove {claim}"
    if (truth.position, truth.tangent) != (case.position, case.tangent):
        yield f"the label is {claim}; the exact decision is {truth.position.label}{', tangent' * truth.tangent}"
    if other not in (None, case.position):
        yield f"position is {case.position.label}; the least value says {other.label}"


def _wrong_measures(
    case: Vector, content: Content, pair: Pair, truth: Decision, proved: set[Position], flags: Sequence[str]
) -> Iterator[str]:
    """Yield a sentence for each measure of the case that is wrong: kind, clearance, flips, flags.

    `proved` are the positions whose lower bound of the flip is proved already; `flags` are the right flags.
    """
    if not content.tilted and (kind := classify_by_roots(pair).kind) is not case.kind:
        was, now = (named.value if named else None for named in (case.kind, kind))
        yield f"kind is {was}; the roots say {now}"
    if case.clearance is not None and (measured := nearest(pair).clearance) != case.clearance:
        yield f"clearance is {decimal_of(case.clearance)}; the nearest point says {decimal_of(measured)}"
    if (truth.position, truth.tangent) != (case.position, case.tangent):
        return  # its flips are to other positions
    wrong = _wrong_brackets(case, pair, truth, proved) if content.tilted else _wrong_flips(case, content, pair, truth)
    yield from wrong
    yield from _wrong_flags(case, flags)


def _wrong_flips(case: Vector, content: Content, pair: Pair, truth: Decision) -> Iterator[str]:
    """Yield a sentence for each wrong flip distance of an upright pair."""
    for position, distance in flips(content, pair, truth).items():
        stated, right = case.flips[position].upper, distance.upper
        if stated != right:
            yield f"the flip to {position.label} is {decimal_of(stated)}; it is {decimal_of(right)}"


def _wrong_brackets(case: Vector, pair: Pair, truth: Decision, proved: set[Position]) -> Iterator[str]:
    """Yield a sentence for each flip of a tilted pair whose bracket cannot be proved again."""
    for other, ends in case.flips.items():
        if not is_bracket(pair, truth, other, ends, cuts=0, lower_holds=other in proved):
            bracket_text = f"{decimal_of(ends.lower)} … {decimal_of(ends.upper)}"
            yield f"the flip to {other.label} is {bracket_text}; no proof of both ends is found"


def _proved_lower_ends(cases: Sequence[Vector]) -> list[set[Position]]:
    """Prove lower bounds of flips in float64, of all cases together, which is fast.

    Returns for each case the positions to which the lower bound is proved.
    """
    proved: list[set[Position]] = [set() for _ in cases]
    brackets = [
        (index, other, ends.lower)
        for index, case in enumerate(cases)
        for other, ends in case.flips.items()
        if other is not case.position and 0 < ends.lower < 1
    ]
    if not brackets:
        return proved
    goals = [goal_of(cases[index].position, other) for index, other, _ in brackets]
    pairs = [Pair.from_row(cases[index].row) for index, *_ in brackets]
    for (index, other, _), holds in zip(
        brackets, excluded_at_once(pairs, goals, [low for *_, low in brackets]), strict=True
    ):
        if holds:
            proved[index].add(other)
    return proved


def _of_sweeps(file: CaseFile) -> Iterator[Iterator[str]]:
    """Yield for each case of a file of sweeps the sentences about its wrong labels."""
    return map(_ended_sweep_sentences if file.content.ended else _sweep_sentences, file.cases)


def _sweep_sentences(case: Vector) -> Iterator[str]:
    """Yield a sentence for each wrong label of a sweep beside a hyperboloid without ends."""
    if not check_passage(case.row, case.passage_certificate, case.first):
        if case.first is None:
            yield "the certificate does not prove that the sweep is clear"
        elif contact_at(case.row, case.passage_certificate) is None:
            yield "the certificate does not prove contact at its time"
        else:
            times_text = f"{decimal_of(case.first[0])} … {decimal_of(case.first[1])}"
            yield f"the certificate does not prove that the first contact is at {times_text}"
    yield from _wrong_flags(case, sweep_flags(case.row, case.first, case.passage_certificate))


_TIMES = 16
"""Number of pieces into which a sweep beside a hyperboloid that ends is cut; the least value is asked at their ends."""

_SLACK = 2.0**-30
"""The test uses a spheroid that is smaller or larger by this part, so that a rounded centre does not matter."""


def _ended_sweep_sentences(case: Vector) -> Iterator[str]:
    """Yield a sentence for each wrong label of a sweep beside a hyperboloid that ends.

    Compare with a new exact decision, and at some times with the least value.
    """
    truth = passage_of_row(case.row)
    first = (truth.first_lower, truth.first_upper) if truth.hit else None
    if first != case.first:
        yield f"first is {_bounds_text(case.first)}; the exact decision says {_bounds_text(first)}"
    until = case.first[0] if case.first else 1.0
    times = [place / _TIMES for place in range(_TIMES + 1) if place / _TIMES < until or case.first is None]
    for time in times:
        if _least_at(case.row, time, 1 - _SLACK) is Position.CONTACT:
            yield f"the sweep is said to be clear at t {time!r}; the least value says contact"
    if case.first and _least_at(case.row, case.first[1], 1 + _SLACK) not in (None, Position.CONTACT):
        yield f"there is no contact at t {case.first[1]!r}, the least value says"


def _bounds_text(first: tuple[float, float] | None) -> str:
    """Write the bounds of a first contact for a message."""
    return "null" if first is None else " … ".join(map(decimal_of, first))


def _least_at(row: Row, time: float, scale: float) -> Position | None:
    """Return the position at a time of a sweep with b and d scaled, by the least value; None if it is undecided."""
    alpha, gamma, b, d, *others = row
    centre = [start + time * (end - start) for start, end in zip(others[:3], others[3:6], strict=True)]
    return least.position(Pair.from_row((alpha, gamma, b * scale, d * scale, *centre, *others[6:])))


def _wrong_flags(case: Vector, flags: Sequence[str]) -> Iterator[str]:
    """Yield a sentence if the flags of the case are not the right ones."""
    if set(flags) != set(case.flags):
        yield f"flags are {', '.join(case.flags) or 'none'}; they are {', '.join(flags) or 'none'}"


def wrong_description(head: Metadata) -> Iterator[str]:
    """Yield a sentence for each wrong description of a known family in a file; `made_by` is not compared."""
    known = frozen.head_of(head.name) if head.name in frozen.ALL_NAMES else None
    if known is None or head.version < known.version:
        return
    for name, stated, right in _differences(head, replace(known, made_by=head.made_by)):
        yield f"family.{name} is {stated}; of {head.name} it is {right}"


def wrong_meanings(flags: Mapping[str, FlagFacts], known: Mapping[str, FlagFacts]) -> Iterator[str]:
    """Yield a sentence for each flag that a file describes in other words than `known`."""
    for flag, facts in flags.items():
        for name, stated, right in _differences(facts, known[flag]):
            yield f"the {name} of the flag {flag} is {stated}; it is {right}"


def _differences(there: Metadata | FlagFacts, known: Metadata | FlagFacts) -> Iterator[tuple[str, str, str]]:
    """Yield the name of each differing field, with the file's text, cut if it is long, and the right text in full."""
    for field in fields(known):
        stated, right = getattr(there, field.name), getattr(known, field.name)
        if stated != right:
            yield field.name, shown_json(stated), json.dumps(right, ensure_ascii=False)


@dataclass(frozen=True, slots=True)
class FileReport:
    """The result of checking a file: the number of cases, the errors in its head, and every wrong label."""

    path: str
    count: int
    head: tuple[MetadataFault, ...]
    faults: tuple[LabelFault, ...]


@dataclass(frozen=True, slots=True)
class MetadataFault:
    """An error in the head of a file, and its line."""

    line: int
    sentence: str


def shipped_files() -> list[str]:
    """Return the paths of all frozen files, which must exist."""
    return [str(frozen.path_of(name)) for name in frozen.ALL_NAMES]


def examine(paths: Iterable[str]) -> Iterator[FileReport]:
    """Check each file in turn and yield its report.

    Raises InputError if a file does not conform to its schema, NothingJudgedError if it has no cases.
    """
    for path in paths:
        document = read_document(path)
        file = cases_of(document)
        if not file.cases:
            raise NothingJudgedError(f"{path} has no cases; nothing was checked")
        wrong = {"family": wrong_description(file.head), "flags": wrong_meanings(file.flags, file.content.flags)}
        head = [
            MetadataFault(document.lines[member,], sentence)
            for member, sentences in wrong.items()
            for sentence in sentences
        ]
        yield FileReport(path, len(file.cases), tuple(head), tuple(faults_of(file)))
