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
from dataclasses import fields, replace
from pathlib import Path
from typing import TypeVar

from hypcheck.answer import DisagreementError
from hypcheck.errors import InputError
from hypcheck.geometry.rows import PAIRS, WAYS, Layout, Rows
from hypcheck.tables.streams import writing
from hypcheck.vectors import cancellation
from hypcheck.vectors import frozen as refusals
from hypcheck.vectors.families import FAMILIES, TILTED_FAMILIES, WAY_FAMILIES, case_id, parse_case_id
from hypcheck.vectors.family import BLOCK, Family, FamilyDescription, Metadata, Row, Vector, VectorFile
from hypcheck.vectors.flags import FLAGS, TILTED_FLAGS, WAY_FLAGS
from hypcheck.vectors.format import read_vectors, vectors_text
from hypcheck.vectors.frozen import InvalidRowFile, invalid_rows_text, read_invalid_rows
from hypcheck.vectors.labels import LabelFault, faults_of_invalid_rows, faults_of_vectors, labelled
from hypcheck.vectors.tilted.format import TiltedVector, TiltedVectorFile, read_tilted_vectors, tilted_vectors_text
from hypcheck.vectors.tilted.labels import faults_of_tilted, labelled_tilted
from hypcheck.vectors.ways.format import WayFile, WayVector, read_ways, ways_text
from hypcheck.vectors.ways.labels import faults_of_ways, labelled_ways

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

NAMES = (*COUNTS, cancellation.NAME, *TILTED_COUNTS, *WAY_COUNTS, *refusals.INVALID_METADATA)

Progress = Callable[[str], object]
File = TypeVar("File", VectorFile, TiltedVectorFile, WayFile)


def freeze(names: Iterable[str], folder: Path, tell: Progress = lambda _: None) -> None:
    """Write the files of these names to a folder, keeping the cases that are there; `tell` hears of each that is done.

    Raises InputError where a name is unknown, the folder is none or a file there is not as it must be, and
    DisagreementError, writing nothing, where a label does not stand its own check.
    """
    wanted = list(dict.fromkeys(names))
    for name in wanted:
        if name not in NAMES:
            raise InputError(f"there are no frozen vectors {name!r}; there are {', '.join(NAMES)}")
    if not folder.is_dir():
        raise InputError(f"{folder} is no folder; make it, or name another with --into")
    for name in wanted:
        path = folder / f"{name}.json"
        text = _text(name, path)
        with writing(str(path)) as writer:
            writer.write(text.encode())
        tell(name)


def _text(name: str, path: Path) -> str:
    if name in refusals.INVALID_METADATA:
        invalid = frozen_invalid_rows(read_invalid_rows(str(path)) if path.exists() else None, name)
        _require_no_faults(faults_of_invalid_rows(invalid))
        return invalid_rows_text(invalid)
    if name in TILTED_COUNTS:
        tilted = frozen_tilted(name, _before(name, path, read_tilted_vectors))
        _require_no_faults(faults_of_tilted(tilted))
        return tilted_vectors_text(tilted)
    if name in WAY_COUNTS:
        ways = frozen_ways(name, _before(name, path, read_ways))
        _require_no_faults(faults_of_ways(ways))
        return ways_text(ways)
    file = frozen(name, _before(name, path, read_vectors))
    _require_no_faults(faults_of_vectors(file))
    return vectors_text(file)


def frozen(name: str, before: VectorFile | None = None) -> VectorFile:
    """The file of that name, labelled anew; the cases of an earlier one keep their ids and places."""
    head = (
        cancellation.METADATA
        if name == cancellation.NAME
        else metadata_of(FAMILIES[name], f"hypcheck cases freeze {name}")
    )
    named = [(case.id, case.row) for case in before.cases] if before else []
    return assembled(head, labelled(extended(name, named, [tuple(row) for row in planned(name).tolist()])))


def frozen_tilted(name: str, before: TiltedVectorFile | None = None) -> TiltedVectorFile:
    """The file about tilted spheroids of that name; the cases of an earlier one are kept with their labels."""
    family = TILTED_FAMILIES[name]
    kept = before.cases if before else ()
    wanted = [tuple(row) for row in family.rows(SEED, TILTED_COUNTS[name]).tolist()]
    added = extended(name, [(case.id, case.row) for case in kept], wanted)[len(kept) :]
    return assembled_tilted(metadata_of(family, f"hypcheck cases freeze {name}"), (*kept, *labelled_tilted(added)))


def frozen_ways(name: str, before: WayFile | None = None) -> WayFile:
    """The file about ways of that name; the cases of an earlier one are kept with their labels."""
    family = WAY_FAMILIES[name]
    kept = before.cases if before else ()
    wanted = [tuple(row) for row in family.rows(SEED, WAY_COUNTS[name]).tolist()]
    added = extended(name, [(case.id, case.row) for case in kept], wanted)[len(kept) :]
    return assembled_ways(metadata_of(family, f"hypcheck cases freeze {name}"), (*kept, *labelled_ways(added)))


def planned(name: str) -> Rows:
    """The rows that a file must have, float64 (n, 7), some of them perhaps twice."""
    return cancellation.worst_rows() if name == cancellation.NAME else FAMILIES[name].rows(SEED, COUNTS[name])


def metadata_of(family: Family, made_by: str) -> Metadata:
    """What a file says of a family."""
    described = {each.name: getattr(family, each.name) for each in fields(FamilyDescription)}
    return Metadata(**described, made_by=made_by)


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


def assembled(head: Metadata, cases: Iterable[Vector]) -> VectorFile:
    """A file of these cases, with the meaning of the flags that they have."""
    kept = tuple(cases)
    used = {flag for case in kept for flag in case.flags}
    return VectorFile(head, {name: facts for name, facts in FLAGS.items() if name in used}, kept)


def assembled_tilted(head: Metadata, cases: Iterable[TiltedVector]) -> TiltedVectorFile:
    """A file of these cases, with the meaning of the flags that they have."""
    kept = tuple(cases)
    used = {flag for case in kept for flag in case.flags}
    return TiltedVectorFile(head, {name: facts for name, facts in TILTED_FLAGS.items() if name in used}, kept)


def assembled_ways(head: Metadata, cases: Iterable[WayVector]) -> WayFile:
    """A file of these cases, with the meaning of the flags that they have."""
    kept = tuple(cases)
    used = {flag for case in kept for flag in case.flags}
    return WayFile(head, {name: facts for name, facts in WAY_FLAGS.items() if name in used}, kept)


def generated_case(name: str) -> Vector | TiltedVector | WayVector:
    """The generated case of that id, labelled and proved. Raises InputError where there is none."""
    case = parse_case_id(name)
    block, place = divmod(case.index, BLOCK)
    row = tuple(case.family.block(case.seed, block)[place].tolist())
    named = [(case_id(case.family, case.seed, case.index), row)]
    if case.family.layout is WAYS:
        return labelled_ways(named)[0]
    return labelled_tilted(named)[0] if case.family.tilted else labelled(named)[0]


def generated_text(family: Family, seed: int, count: int) -> str:
    """A vector file of the first rows of a family's seed, with generated ids."""
    named = [(case_id(family, seed, index), tuple(row)) for index, row in enumerate(family.rows(seed, count).tolist())]
    head = metadata_of(family, f"hypcheck cases generate {family.name} --seed {seed} --count {count}")
    if family.layout is WAYS:
        return ways_text(assembled_ways(head, labelled_ways(named)))
    if family.tilted:
        return tilted_vectors_text(assembled_tilted(head, labelled_tilted(named)))
    return vectors_text(assembled(head, labelled(named)))


def frozen_invalid_rows(before: InvalidRowFile | None = None, name: str = refusals.INVALID_NAME) -> InvalidRowFile:
    """The file of rows that must be refused; those of an earlier one keep their ids and places."""
    kept = before.cases if before else ()
    known = {case.bits for case in kept}
    number = _next_number(case.id for case in kept)
    made = refusals.invalid_rows(name)
    added = [case for case in made.cases if case.bits not in known]
    renamed = (replace(case, id=f"{name}-{number + place:04d}") for place, case in enumerate(added))
    return InvalidRowFile(made.head, (*kept, *renamed), made.content)


def _before(name: str, path: Path, read: Callable[[str], File]) -> File | None:
    """The file that is there. Raises InputError where it is of another family."""
    if not path.exists():
        return None
    before = read(str(path))
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
    if layout is WAYS:
        _ways_before(path, "", tilted=tilted)
    elif Path(path).exists():
        read_tilted_vectors(path) if tilted else read_vectors(path)
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
    if layout is WAYS:
        return _keep_ways(path, rows, made_by, tilted=tilted)
    return _keep_tilted(path, rows, made_by) if tilted else _keep_upright(path, rows, made_by)


def _keep_upright(path: str, rows: Sequence[Row], made_by: str) -> int:
    before = read_vectors(path) if Path(path).exists() else VectorFile(_found_metadata(made_by), {}, ())
    known = [(case.id, case.row) for case in before.cases]
    added = labelled(extended(before.head.name, known, rows)[len(known) :])
    with writing(path) as writer:
        writer.write(vectors_text(assembled(before.head, (*before.cases, *added))).encode())
    return len(added)


def _keep_tilted(path: str, rows: Sequence[Row], made_by: str) -> int:
    before = read_tilted_vectors(path) if Path(path).exists() else TiltedVectorFile(_found_metadata(made_by), {}, ())
    known = [(case.id, case.row) for case in before.cases]
    added = labelled_tilted(extended(before.head.name, known, rows)[len(known) :])
    with writing(path) as writer:
        writer.write(tilted_vectors_text(assembled_tilted(before.head, (*before.cases, *added))).encode())
    return len(added)


def _keep_ways(path: str, rows: Sequence[Row], made_by: str, *, tilted: bool) -> int:
    before = _ways_before(path, made_by, tilted=tilted)
    known = [(case.id, case.row) for case in before.cases]
    added = labelled_ways(extended(before.head.name, known, rows)[len(known) :])
    with writing(path) as writer:
        writer.write(ways_text(assembled_ways(before.head, (*before.cases, *added))).encode())
    return len(added)


def _ways_before(path: str, made_by: str, *, tilted: bool) -> WayFile:
    """The file about ways that is there, an empty one if there is none. Raises InputError if its rows are others."""
    if not Path(path).exists():
        return WayFile(_found_metadata(made_by), {}, ())
    before = read_ways(path)
    width = len(WAYS.tilted if tilted else WAYS.upright)
    if before.cases and len(before.cases[0].row) != width:
        numbers = len(before.cases[0].row)
        raise InputError(f"{path} has rows of {numbers} numbers; it must have rows of {width}, to add these")
    return before


def _found_metadata(made_by: str) -> Metadata:
    return Metadata(
        name="found",
        version=1,
        title="rows that an implementation answered wrongly",
        source="own; the strata of hypcheck's vectors, and local search from there",
        purpose="an implementation was wrong here; it should stay right once it is corrected",
        game="as wrong as the game that uses the implementation",
        drone="as wrong as the drone that uses the implementation",
        regimes="those of the wrong answers",
        extreme=False,
        made_by=made_by,
    )
