"""Keeping the wrong answers of a hunt: their rows are added to a vector file, labelled and proved."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from hypcheck.errors import InputError
from hypcheck.tables.streams import writing
from hypcheck.vectors.family import Metadata, Row, VectorFile
from hypcheck.vectors.format import read_vectors, vectors_text
from hypcheck.vectors.freezing import assembled, extended
from hypcheck.vectors.labels import labelled


def require_keepable(path: str) -> None:
    """See, before hours are spent, that rows can be kept there. Raises InputError as `keep` would."""
    if Path(path).exists():
        read_vectors(path)
    folder = Path(path).resolve().parent
    if not folder.is_dir():
        raise InputError(f"cannot write {path}: there is no folder {folder}")
    if not os.access(folder, os.W_OK):
        raise InputError(f"cannot write {path}: permission denied")


def keep_rows(path: str, rows: Sequence[Row], made_by: str) -> int:
    """Add the rows that are not there yet to a vector file, labelled and proved; how many these were.

    Where there is no file, one is begun that names `made_by` as the command it is from; the cases of an existing one
    stay as they are. Raises InputError where a file is there that is no vector file, or where it cannot be written.
    """
    before = read_vectors(path) if Path(path).exists() else VectorFile(_head(made_by), {}, ())
    known = [(case.id, case.row) for case in before.cases]
    added = labelled(extended(before.head.name, known, rows)[len(known) :])
    with writing(path) as writer:
        writer.write(vectors_text(assembled(before.head, (*before.cases, *added))).encode())
    return len(added)


def _head(made_by: str) -> Metadata:
    return Metadata(
        name="found",
        version=1,
        title="rows that an implementation answered wrongly",
        source="own; the casebook's strata, and local search from there",
        purpose="an implementation was wrong here; it should stay right once it is mended",
        game="as wrong as the game that the implementation belongs to",
        drone="as wrong as the drone that the implementation belongs to",
        regimes="wherever the wrong answers were",
        extreme=False,
        made_by=made_by,
    )
