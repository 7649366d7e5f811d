"""The frozen vectors: certified cases that travel with the package, a file a family, read when they are asked for.

Their ids are for ever: a row keeps the id it was given, whatever becomes of the generator that made it. Loads numpy,
neither sympy nor mpmath.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from hypcheck.casebook.families import FAMILIES
from hypcheck.casebook.frozen import cancellation, refusals
from hypcheck.casebook.frozen.model import VectorFile
from hypcheck.casebook.frozen.reading import read_vectors
from hypcheck.casebook.frozen.refusals import RefusalFile, read_refusals
from hypcheck.errors import InputError
from hypcheck.rows import Positions, Rows
from hypcheck.suggesting import advice

NAMES = (*FAMILIES, cancellation.NAME)
"""The files of cases with answers; refusals.NAME is the one of rows without."""


@dataclass(frozen=True, slots=True)
class FrozenRows:
    """The cases of a file as arrays: their ids, rows (n, 7) and right answers, int8 (n,)."""

    ids: tuple[str, ...]
    rows: Rows
    positions: Positions


def folder() -> Path:
    """Where the files are: in the installed package, or beside it in a source tree."""
    package = Path(__file__).resolve().parents[1]
    inside = package / "cases"
    return inside if inside.is_dir() else package.parent / "cases"


def path_of(name: str) -> Path:
    """The file of that name, NAMES or refusals.NAME. Raises InputError where there is none of that name."""
    known = (*NAMES, refusals.NAME)
    if name not in known:
        raise InputError(f"there are no frozen vectors {name!r}; {advice(name, known)}")
    return folder() / f"{name}.json"


@cache
def load(name: str) -> VectorFile:
    """The frozen cases of that name. Raises InputError where there are none, or their file is not as it must be."""
    if name == refusals.NAME:
        raise InputError(f"the rows of {name!r} have no answers; they must be refused")
    return read_vectors(str(path_of(name)))


@cache
def load_refusals() -> RefusalFile:
    """The frozen rows that must be refused. Raises InputError where their file is not as it must be."""
    return read_refusals(str(path_of(refusals.NAME)))


def frozen_rows(name: str) -> FrozenRows:
    """The rows and right answers of the frozen cases of that name. Raises InputError as load does."""
    file = load(name)
    return FrozenRows(tuple(case.id for case in file.cases), file.rows, file.positions)
