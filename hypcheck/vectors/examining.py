"""The check of vector files: each is read strictly, its metadata is compared, and every label is proved.

A label is checked by this program's meaning of its flag and read by the meaning that its file states, so the two must
agree. A family of this program is described in the words of its generator's version. For an earlier version, or for a
family of someone else, nothing is known here, and the description is not compared.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, replace

from hypcheck.errors import NothingJudgedError
from hypcheck.geometry import rows
from hypcheck.tables.numbers import shown_json
from hypcheck.tables.strict_json import JsonDocument, read_document
from hypcheck.vectors import frozen
from hypcheck.vectors.family import FlagFacts, Metadata
from hypcheck.vectors.file_types import type_of_content
from hypcheck.vectors.format import REFUSALS, content_of
from hypcheck.vectors.frozen import invalid_rows_of
from hypcheck.vectors.labels import LabelFault, faults_of_invalid_rows


def wrong_description(head: Metadata) -> Iterator[str]:
    """A sentence for each wrong description of a known family in a file; the command that made it is not compared."""
    known = frozen.head_of(head.name) if head.name in frozen.ALL_NAMES else None
    if known is None or head.version < known.version:
        return
    for name, said, right in _differences(head, replace(known, made_by=head.made_by)):
        yield f"family.{name} is {said}; of {head.name} it is {right}"


def wrong_meanings(flags: Mapping[str, FlagFacts], known: Mapping[str, FlagFacts]) -> Iterator[str]:
    """A sentence for each flag whose description in a file is not the meaning that is checked."""
    for flag, facts in flags.items():
        for name, said, right in _differences(facts, known[flag]):
            yield f"the {name} of the flag {flag} is {said}; it is {right}"


def _differences(there: Metadata | FlagFacts, known: Metadata | FlagFacts) -> Iterator[tuple[str, str, str]]:
    """Names of fields that differ, with what is said there, cut where it is long, and what is right, whole."""
    for each in fields(known):
        said, right = getattr(there, each.name), getattr(known, each.name)
        if said != right:
            yield each.name, shown_json(said), json.dumps(right, ensure_ascii=False)


@dataclass(frozen=True, slots=True)
class FileReport:
    """What became of a file: how many cases it has, what is wrong at its head, and every wrong label."""

    path: str
    count: int
    head: tuple[MetadataFault, ...]
    faults: tuple[LabelFault, ...]


@dataclass(frozen=True, slots=True)
class MetadataFault:
    """What a file says wrongly before its cases, and on which line."""

    line: int
    sentence: str


def shipped_files(*, tilted: bool = True) -> list[str]:
    """The paths of the frozen files, all of which must be there; without `tilted`, those about single upright pairs."""
    names = (*frozen.NAMES, frozen.INVALID_NAME)
    return [str(frozen.path_of(name)) for name in (*names, *(TILTED if tilted else ()))]


TILTED = (*frozen.TILTED_NAMES, frozen.TILTED_INVALID_NAME, *frozen.WAY_NAMES, *frozen.INVALID_NAMES[rows.WAYS])


def examine(paths: Iterable[str]) -> Iterator[FileReport]:
    """A report on each file in turn.

    Raises InputError where one is not wholly as its schema demands, NothingJudgedError where it has no cases.
    """
    for path in paths:
        document = read_document(path)
        content = content_of(document, path)
        if content in REFUSALS:
            bad = invalid_rows_of(document, path)
            head = _metadata_faults(document, "family", wrong_description(bad.head))
            report = FileReport(path, len(bad.cases), head, tuple(faults_of_invalid_rows(bad)))
        else:
            kind = type_of_content(content)
            file = kind.of_document(document, path)
            head = _head_faults(document, file.head, file.flags, kind.known)
            report = FileReport(path, len(file.cases), head, tuple(kind.faults(file)))
        if not report.count:
            raise NothingJudgedError(f"{path} has no cases; nothing was checked")
        yield report


def _head_faults(
    document: JsonDocument, head: Metadata, flags: Mapping[str, FlagFacts], known: Mapping[str, FlagFacts]
) -> tuple[MetadataFault, ...]:
    family = _metadata_faults(document, "family", wrong_description(head))
    return family + _metadata_faults(document, "flags", wrong_meanings(flags, known))


def _metadata_faults(document: JsonDocument, member: str, sentences: Iterable[str]) -> tuple[MetadataFault, ...]:
    return tuple(MetadataFault(document.members[member][0].line, sentence) for sentence in sentences)
