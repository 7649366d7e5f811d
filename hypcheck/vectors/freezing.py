"""The frozen files made anew: old cases stay as they are, with the ids they have; new rows are added after them.

A family's file has the first rows of seed SEED, as many as COUNTS says, each once. Where a new version of a generator
makes other rows, these are added too: no copy of a case ever loses its meaning. Vector files of generated rows are made
in the same way.
"""

from __future__ import annotations

import os
import re
import struct
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from hypcheck.answer import DisagreementError
from hypcheck.errors import InputError
from hypcheck.geometry.rows import PAIRS, Layout, Rows
from hypcheck.tables.streams import writing
from hypcheck.vectors import cancellation
from hypcheck.vectors import frozen as refusals
from hypcheck.vectors.families import ALL, WAY_FAMILIES, case_id, parse_case_id
from hypcheck.vectors.family import CaseFile, Family, LabelledCase, Row, described
from hypcheck.vectors.file_types import FileType, type_of_rows
from hypcheck.vectors.frozen import AnyVector, InvalidRowFile, invalid_rows_text, read_invalid_rows
from hypcheck.vectors.labels import LabelFault, faults_of_invalid_rows

SEED = 1

COUNTS = {
    "forest-type-1": 120,
    "forest-type-2": 120,
    "tower-body": 120,
    "tower-rotors": 120,
    "flight": 128,
    "uniform": 160,
    "far-centers": 120,
    "giant-spheroids": 120,
    "tiny-spheroids": 120,
    "float32-exact": 160,
    "float16-exact": 160,
    "small-integers": 240,
    "symmetric-images": 160,
    "one-number-changed": 168,
    "tangent": 270,
    "near-tangent-outside": 240,
    "near-tangent-inside": 240,
    "degenerate-crossing": 120,
    "degenerate-neighbourhood": 160,
    "on-surface": 120,
    "tangent-ladder": 492,
    "ring": 240,
    "ring-neighbourhood": 240,
    "osculation": 240,
    "near-axis": 200,
    "coefficient-zero": 240,
    "axis": 160,
    "waist": 160,
    "regime-borders": 240,
    "out-of-regime": 240,
    "stiff-radial": 160,
    "stiff-axial": 160,
    "stiff-both": 160,
    "whole-domain": 240,
    "extreme-float16": 180,
    "extreme-float32": 180,
    "extreme-float64": 180,
    "extreme-subnormal": 120,
    "extreme-magnitude": 120,
    "extreme-hair": 60,
}
"""Rows of each family: more where the traps are, few where proofs are long."""

TILTED_COUNTS = {
    "tilted-uniform": 160,
    "tilted-tower": 160,
    "tilted-near-contact": 200,
    "tilted-tangent": 200,
    "tilted-near-tangent": 240,
    "tilted-crossing": 120,
    "tilted-symmetric": 200,
    "tilted-sphere": 120,
    "tilted-upright": 120,
    "tilted-slight": 180,
    "tilted-twins": 180,
    "tilted-ring": 200,
    "tilted-stiff": 180,
    "tilted-axis-length": 160,
    "tilted-small-integers": 200,
    "extreme-tilted": 120,
}
"""The same of the families of tilted spheroids."""

WAY_COUNTS = {name: 40 if family.tilted else 108 for name, family in WAY_FAMILIES.items()}
"""The same of the families of ways."""

_NUMBER = re.compile(r".*-([0-9]+)", re.ASCII)

NAMES = (*COUNTS, cancellation.NAME, *TILTED_COUNTS, *WAY_COUNTS, *refusals.INVALID_CONTENTS)

Progress = Callable[[str], object]


def freeze(names: Iterable[str], folder: Path, done: Progress = lambda _: None) -> None:
    """Write the files of these names to a folder, keeping the cases that are there; `done` is called with each name.

    Raises InputError where a name is unknown, the folder is none or a file there is not as it must be, and
    DisagreementError, writing nothing, where a label does not stand its own check.
    """
    wanted = list(dict.fromkeys(names))
    for name in wanted:
        if name not in NAMES:
            raise InputError(f"there are no frozen vectors {name!r}; there are {', '.join(NAMES)}")
    if not folder.is_dir():
        raise InputError(f"{folder} is no folder; create it, or name another folder with --into")
    for name in wanted:
        path = folder / f"{name}.json"
        text = _text(name, path)
        with writing(str(path)) as writer:
            writer.write(text.encode())
        done(name)


def _text(name: str, path: Path) -> str:
    if name in refusals.INVALID_CONTENTS:
        invalid = frozen_invalid_rows(read_invalid_rows(str(path)) if path.exists() else None, name)
        _require_no_faults(faults_of_invalid_rows(invalid))
        return invalid_rows_text(invalid)
    kind = _type_of(name)
    file = frozen(name, _before(name, path, kind))
    _require_no_faults(kind.faults(file))
    return kind.text(file)


def _type_of(name: str) -> FileType[Any]:
    family = ALL.get(name)
    return type_of_rows() if family is None else type_of_rows(family.layout, tilted=family.tilted)


def frozen(name: str, before: CaseFile[Any] | None = None) -> CaseFile[Any]:
    """The file of that name; the cases of an earlier one keep their ids and places, and their labels if they are slow.

    Labels of positions of upright spheroids are made quickly: all of them are made anew.
    """
    kind = _type_of(name)
    old = before.cases if before else ()
    cases = extended(name, _named(old), [tuple(row) for row in planned(name).tolist()])
    kept = () if kind is type_of_rows() else old
    return kind.assembled(refusals.head_of(name), (*kept, *kind.labelled(cases[len(kept) :])))


def _named(cases: Iterable[LabelledCase]) -> list[tuple[str, Row]]:
    return [(case.id, case.row) for case in cases]


def planned(name: str) -> Rows:
    """The rows that a file must have, float64 (n, as many numbers as a row has), some of them perhaps twice."""
    if name == cancellation.NAME:
        return cancellation.worst_rows()
    (count,) = (counts[name] for counts in (COUNTS, TILTED_COUNTS, WAY_COUNTS) if name in counts)
    return ALL[name].rows(SEED, count)


def extended(name: str, before: list[tuple[str, Row]], rows: Iterable[Row]) -> list[tuple[str, Row]]:
    """Ids and rows, then those rows that are not among them, with the next ids. Rows are compared to the bit."""
    cases = list(before)
    known = {_bits(row) for _, row in before}
    number = _next_number(case for case, _ in before)
    for row in rows:
        if _bits(row) not in known:
            known.add(_bits(row))
            cases.append((f"{name}-{number:04d}", row))
            number += 1
    return cases


def _next_number(ids: Iterable[str]) -> int:
    """The number after the greatest of these ids; generated ones, which have slashes, do not count."""
    found = (_NUMBER.fullmatch(name) for name in ids if "/" not in name)
    return 1 + max((int(match.group(1)) for match in found if match), default=-1)


def generated_case(name: str) -> AnyVector:
    """The generated case of that id, labelled and proved. Raises InputError where there is none."""
    case = parse_case_id(name)
    row = case.family.row(case.seed, case.index)
    kind = type_of_rows(case.family.layout, tilted=case.family.tilted)
    found: list[AnyVector] = kind.labelled([(case_id(case.family, case.seed, case.index), row)])
    return found[0]


def generated_text(family: Family, seed: int, count: int) -> str:
    """A vector file of the first rows of a family's seed, with generated ids."""
    named = [(case_id(family, seed, index), tuple(row)) for index, row in enumerate(family.rows(seed, count).tolist())]
    head = family.described(f"hypcheck cases generate {family.name} --seed {seed} --count {count}")
    kind = type_of_rows(family.layout, tilted=family.tilted)
    return kind.text(kind.assembled(head, kind.labelled(named)))


def frozen_invalid_rows(before: InvalidRowFile | None = None, name: str = refusals.INVALID_NAME) -> InvalidRowFile:
    """The file of rows that must be refused; those of an earlier one keep their ids and places."""
    kept = before.cases if before else ()
    known = {case.bits for case in kept}
    number = _next_number(case.id for case in kept)
    made = refusals.invalid_rows(name)
    added = [case for case in made.cases if case.bits not in known]
    renamed = (replace(case, id=f"{name}-{number + place:04d}") for place, case in enumerate(added))
    return InvalidRowFile(made.head, (*kept, *renamed), made.content)


def _before(name: str, path: Path, kind: FileType[Any]) -> CaseFile[Any] | None:
    """The file that is there. Raises InputError where it is of another family."""
    if not path.exists():
        return None
    before = kind.read(str(path))
    if before.head.name != name:
        raise InputError(f"{path} is of the family {before.head.name!r}; it must be of {name!r}")
    return before


def _bits(row: Row) -> bytes:
    return struct.pack(f"<{len(row)}d", *row)


def _require_no_faults(faults: list[LabelFault]) -> None:
    if faults:
        worst = faults[0]
        raise DisagreementError(
            f"the label made for {worst.case} fails its check: {worst.sentence}; please report this, it is a "
            "fault of hypcheck"
        )


def require_keepable(path: str, *, tilted: bool = False, layout: Layout = PAIRS) -> None:
    """Check before a long hunt that rows can be added to this file. Raises InputError as `keep_rows` would."""
    _found_before(path, "", tilted=tilted, layout=layout)
    folder = Path(path).resolve().parent
    if not folder.is_dir():
        raise InputError(f"cannot write {path}: there is no folder {folder}")
    if not os.access(folder, os.W_OK):
        raise InputError(f"cannot write {path}: permission denied")


def keep_rows(path: str, rows: Sequence[Row], made_by: str, *, tilted: bool = False, layout: Layout = PAIRS) -> int:
    """Add those rows to a vector file that it lacks, labelled and proved, and return their number.

    All rows have the numbers of the layout; with `tilted` those of an axis too, and the file is one of tilted
    spheroids. A new file names `made_by` as the command that made it. Cases of an existing file stay as they are.
    Raises InputError if the file is no such vector file, or cannot be written.
    """
    kind, before = type_of_rows(layout, tilted=tilted), _found_before(path, made_by, tilted=tilted, layout=layout)
    known = _named(before.cases)
    added = kind.labelled(extended(before.head.name, known, rows)[len(known) :])
    with writing(path) as writer:
        writer.write(kind.text(kind.assembled(before.head, (*before.cases, *added))).encode())
    return len(added)


def _found_before(path: str, made_by: str, *, tilted: bool, layout: Layout) -> CaseFile[Any]:
    """The file that is there, an empty one if there is none. Raises InputError if its rows are others."""
    kind = type_of_rows(layout, tilted=tilted)
    if not Path(path).exists():
        return kind.assembled(described("found", made_by), ())
    before = kind.read(path)
    width = len(layout.tilted if tilted else layout.upright)
    if before.cases and len(before.cases[0].row) != width:
        numbers = len(before.cases[0].row)
        raise InputError(f"{path} has rows of {numbers} numbers; it must have rows of {width}, to add these")
    return before
