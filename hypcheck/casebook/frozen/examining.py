"""Checking files, whatever they hold: each is read strictly, then its head is compared and every label put to proof."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from hypcheck.casebook import vectors
from hypcheck.casebook.frozen import refusals
from hypcheck.casebook.frozen.checking import Fault, faults_of_refusals, faults_of_vectors
from hypcheck.casebook.frozen.heads import wrong_meanings, wrong_story
from hypcheck.casebook.frozen.reading import REFUSALS, content_of, vectors_of
from hypcheck.casebook.frozen.refusals import refusals_of
from hypcheck.casebook.frozen.scanning import Document, scan
from hypcheck.errors import NothingJudgedError


@dataclass(frozen=True, slots=True)
class Report:
    """What became of a file: how many cases it has, what is wrong at its head, and every wrong label."""

    path: str
    count: int
    head: tuple[HeadFault, ...]
    faults: tuple[Fault, ...]


@dataclass(frozen=True, slots=True)
class HeadFault:
    """What a file says wrongly before its cases, and on which line."""

    line: int
    sentence: str


def shipped() -> list[str]:
    """The paths of the frozen files, all of which must be there."""
    return [str(vectors.path_of(name)) for name in (*vectors.NAMES, refusals.NAME)]


def examine(paths: Iterable[str]) -> Iterator[Report]:
    """A report on each file in turn.

    Raises InputError where one is not wholly as its schema demands, NothingJudgedError where it has no cases.
    """
    for path in paths:
        document = scan(path)
        if content_of(document, path) == REFUSALS:
            bad = refusals_of(document, path)
            head = _head_faults(document, "family", wrong_story(bad.head))
            report = Report(path, len(bad.cases), head, tuple(faults_of_refusals(bad)))
        else:
            file = vectors_of(document, path)
            head = _head_faults(document, "family", wrong_story(file.head))
            head += _head_faults(document, "flags", wrong_meanings(file.flags))
            report = Report(path, len(file.cases), head, tuple(faults_of_vectors(file)))
        if not report.count:
            raise NothingJudgedError(f"{path} has no cases; nothing was checked")
        yield report


def _head_faults(document: Document, member: str, sentences: Iterable[str]) -> tuple[HeadFault, ...]:
    return tuple(HeadFault(document.members[member][0].line, sentence) for sentence in sentences)
