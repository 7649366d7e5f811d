"""The files with answers by type: how each is read, written, labelled and checked.

There are three types: positions of upright spheroids, positions of spheroids that lean, and ways.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic

from hypcheck.geometry.rows import PAIRS, WAYS, Layout
from hypcheck.tables.strict_json import JsonDocument, read_document
from hypcheck.vectors import format as upright
from hypcheck.vectors.family import Case, CaseFile, FlagFacts, Metadata, Row, Vector, VectorFile
from hypcheck.vectors.flags import FLAGS, TILTED_FLAGS, WAY_FLAGS
from hypcheck.vectors.labels import LabelFault, faults_of_vectors, labelled
from hypcheck.vectors.tilted import format as tilted
from hypcheck.vectors.tilted.labels import faults_of_tilted, labelled_tilted
from hypcheck.vectors.ways import format as ways
from hypcheck.vectors.ways.labels import faults_of_ways, labelled_ways


@dataclass(frozen=True, slots=True)
class FileType(Generic[Case]):
    """A type of files.

    `made` is the file of a head, flags and cases, `of_document` the one that a document is, `text` its document.
    `labelled` are cases from ids and rows, and `faults` the wrong labels of a file. `known` are the flags that a case
    may have.
    """

    made: Callable[[Metadata, Mapping[str, FlagFacts], tuple[Case, ...]], CaseFile[Case]]
    of_document: Callable[[JsonDocument, str], CaseFile[Case]]
    text: Callable[[Any], str]
    labelled: Callable[[Iterable[tuple[str, Row]]], list[Case]]
    faults: Callable[[Any], list[LabelFault]]
    known: Mapping[str, FlagFacts]

    def read(self, path: str) -> CaseFile[Case]:
        """The file at `path`. Raises InputError where it is not wholly as the schema demands."""
        return self.of_document(read_document(path), path)

    def assembled(self, head: Metadata, cases: Sequence[Case]) -> CaseFile[Case]:
        """A file of these cases, with the meaning of the flags that they have."""
        used = {flag for case in cases for flag in case.flags}
        return self.made(head, {name: facts for name, facts in self.known.items() if name in used}, tuple(cases))


UPRIGHT: FileType[Vector] = FileType(
    made=VectorFile,
    of_document=upright.vectors_of,
    text=upright.vectors_text,
    labelled=labelled,
    faults=faults_of_vectors,
    known=FLAGS,
)
TILTED: FileType[tilted.TiltedVector] = FileType(
    made=tilted.TiltedVectorFile,
    of_document=tilted.tilted_vectors_of,
    text=tilted.tilted_vectors_text,
    labelled=labelled_tilted,
    faults=faults_of_tilted,
    known=TILTED_FLAGS,
)
OF_WAYS: FileType[ways.WayVector] = FileType(
    made=ways.WayFile,
    of_document=ways.ways_of,
    text=ways.ways_text,
    labelled=labelled_ways,
    faults=faults_of_ways,
    known=WAY_FLAGS,
)


def type_of_rows(layout: Layout = PAIRS, *, tilted: bool = False) -> FileType[Any]:
    """The type of files about rows with that layout, and with an axis where `tilted` is true."""
    if layout is WAYS:
        return OF_WAYS
    return TILTED if tilted else UPRIGHT


def type_of_content(content: str) -> FileType[Any]:
    """The type of files whose content has answers and is called that."""
    if content in (upright.WAYS, upright.TILTED_WAYS):
        return OF_WAYS
    return TILTED if content == upright.TILTED_POSITIONS else UPRIGHT
