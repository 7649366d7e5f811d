"""Make the frozen files again: old cases do not change and keep their ids; new rows are added after them.

A family's file has the first rows of seed SEED, as many as the table of families says, each once. If a new version of a
generator makes other rows, these are added too, so that old ids stay valid. Vector files of generated rows are made in
the same way.
"""

from __future__ import annotations

import os
import re
import struct
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from hypcheck.answer import DisagreementError
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Groups
from hypcheck.geometry.rows import Rows
from hypcheck.tables.streams import replace_output
from hypcheck.vectors import cancellation
from hypcheck.vectors.cases import Vector, cases_text, read_cases
from hypcheck.vectors.checking import faults_of
from hypcheck.vectors.draw import Family, Row
from hypcheck.vectors.families import ALL, WORST_CANCELLATION, case_id, parse_case_id
from hypcheck.vectors.format import CaseFile, Content, Metadata, content_with, described
from hypcheck.vectors.frozen import ALL_NAMES, head_of
from hypcheck.vectors.invalid_rows import INVALID_CONTENTS, InvalidRow, InvalidRowFile, invalid_rows
from hypcheck.vectors.labels import labelled

SEED = 1

_NUMBER = re.compile(r".*-([0-9]+)", re.ASCII)

Progress = Callable[[str], object]


def freeze(names: Iterable[str], folder: Path, done: Progress = lambda _: None) -> None:
    """Write the files of these names to a folder, keeping its existing cases; `done` is called with each name.

    Raises InputError if a name is unknown, the folder does not exist or a file in it is not valid. Raises
    DisagreementError, and writes no file, if a label fails its check.
    """
    wanted = list(dict.fromkeys(names))
    for name in wanted:
        if name not in ALL_NAMES:
            raise InputError(f"there are no frozen vectors {name!r}; there are {', '.join(ALL_NAMES)}")
    if not folder.is_dir():
        raise InputError(f"{folder} is not a folder; create it, or name another folder with --into")
    earlier = {name: _earlier(name, folder / f"{name}.json") for name in wanted}  # all, before one is replaced
    for name, before in earlier.items():
        text = _text(name, before)
        with replace_output(str(folder / f"{name}.json")) as writer:
            writer.write(text.encode())
        done(name)


def _earlier(name: str, path: Path) -> CaseFile | None:
    """Read the existing file of that name; None if there is none. Raises InputError if it is not valid."""
    before = read_cases(str(path), _content_of(name)) if path.exists() else None
    if before is not None and before.head.name != name:
        raise InputError(f"{path} is of the family {before.head.name!r}; it must be of {name!r}")
    return before


def _text(name: str, before: CaseFile | None) -> str:
    """Make the text of the file of that name, all labels checked. Raises DisagreementError."""
    file = frozen_invalid_rows(name, before) if name in INVALID_CONTENTS else frozen(name, before)
    for fault in faults_of(file):
        raise DisagreementError(
            f"the label made for {fault.case} fails its check: {fault.sentence}; please report this, it is a "
            "fault of hypcheck"
        )
    return cases_text(file)


def _content_of(name: str) -> Content:
    """Return the content of the frozen file of that name."""
    if name in INVALID_CONTENTS:
        return INVALID_CONTENTS[name]
    family = ALL.get(name)
    return content_of_family(family) if family else content_with()


def content_of_family(family: Family) -> Content:
    """Return the content of files with rows of a family."""
    return content_with(family.groups)


def frozen(name: str, before: CaseFile | None = None) -> CaseFile:
    """Make the file of that name. Cases of an earlier file keep their ids, places, and labels that are slow to make.

    Labels of positions of upright spheroids are fast: all of them are made again.
    """
    content = _content_of(name)
    old = before.cases if before else ()
    cases = extended(name, _named(old), [tuple(row) for row in planned(name).tolist()])
    kept_cases = () if content is content_with() else old
    return assembled(head_of(name), content, (*kept_cases, *labelled(content, cases[len(kept_cases) :])))


def assembled(head: Metadata, content: Content, cases: Sequence[Vector]) -> CaseFile:
    """Return a file of these cases, with the meaning of the flags that they have."""
    used = {flag for case in cases for flag in case.flags}
    flags = {name: facts for name, facts in content.flags.items() if name in used}
    return CaseFile(head, content, tuple(cases), flags)


def _named(cases: Iterable[Vector]) -> list[tuple[str, Row]]:
    """Return the id and the row of each case."""
    return [(case.id, case.row) for case in cases]


def planned(name: str) -> Rows:
    """Make the rows that a file must have, float64 (n, numbers of a row); some may occur twice."""
    return cancellation.worst_rows() if name == WORST_CANCELLATION else ALL[name].rows(SEED, ALL[name].frozen)


def extended(name: str, before: list[tuple[str, Row]], rows: Iterable[Row]) -> list[tuple[str, Row]]:
    """Return the ids and rows of `before`, then those of `rows` that are new, with the next ids; every bit counts."""
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
    """Return the number after the greatest number of these ids; ids of generated rows, with slashes, are ignored."""
    matches = (_NUMBER.fullmatch(name) for name in ids if "/" not in name)
    return 1 + max((int(match.group(1)) for match in matches if match), default=-1)


def generated_case(name: str) -> tuple[Vector, Content]:
    """Make the generated case of that id, labelled and proved, and the content of its file. Raises InputError."""
    case = parse_case_id(name)
    content = content_of_family(case.family)
    row = case.family.row(case.seed, case.index)
    (result,) = labelled(content, [(case_id(case.family, case.seed, case.index), row)])
    return result, content


def generated_text(family: Family, seed: int, count: int) -> str:
    """Make the text of a vector file of the first `count` rows of a family's seed, with generated ids."""
    named = [(case_id(family, seed, index), tuple(row)) for index, row in enumerate(family.rows(seed, count).tolist())]
    head = described(family.name, f"hypcheck cases generate {family.name} --seed {seed} --count {count}", family)
    content = content_of_family(family)
    return cases_text(assembled(head, content, labelled(content, named)))


def frozen_invalid_rows(name: str, before: CaseFile | None = None) -> InvalidRowFile:
    """Make the file of rows that must be refused; rows of an earlier file keep their ids and places."""
    old_cases: tuple[InvalidRow, ...] = before.cases if before else ()
    known = {case.bits for case in old_cases}
    number = _next_number(case.id for case in old_cases)
    file = invalid_rows(name)
    added = [case for case in file.cases if case.bits not in known]
    renamed = (replace(case, id=f"{name}-{number + place:04d}") for place, case in enumerate(added))
    return InvalidRowFile(file.head, file.content, (*old_cases, *renamed))


def _bits(row: Row) -> bytes:
    """Return the bytes of a row, which distinguish 0.0 and −0.0."""
    return struct.pack(f"<{len(row)}d", *row)


def require_keepable(path: str, groups: Groups) -> None:
    """Check before a long hunt that rows can be added to this file. Raises InputError as `keep_rows` would."""
    if Path(path).exists():
        read_cases(path, content_with(groups))
    folder = Path(path).resolve().parent
    if not folder.is_dir():
        raise InputError(f"cannot write {path}: there is no folder {folder}")
    if not os.access(folder, os.W_OK):
        raise InputError(f"cannot write {path}: permission denied")


def keep_rows(path: str, rows: Sequence[Row], made_by: str, groups: Groups) -> int:
    """Add the rows that a vector file lacks, labelled and proved, and return their number.

    All rows have the columns of `content_with(groups)`, and so has the file. A new file names `made_by` as the command
    that made it. Cases of an existing file do not change. Raises InputError if the file is not a vector file of this
    kind, or cannot be written.
    """
    content = content_with(groups)
    there = Path(path).exists()
    before = read_cases(path, content) if there else CaseFile(described("found", made_by), content, ())
    known = _named(before.cases)
    added = labelled(content, extended(before.head.name, known, rows)[len(known) :])
    with replace_output(path) as writer:
        writer.write(cases_text(assembled(before.head, content, (*before.cases, *added))).encode())
    return len(added)
