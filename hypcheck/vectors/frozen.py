"""The frozen vectors that travel with the package: a file of certified cases for each family, and invalid rows.

Files are read on demand. Ids are permanent: a row keeps its id even if its generator changes. This module loads numpy,
but neither sympy nor mpmath.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from hypcheck.errors import InputError
from hypcheck.messages import suggestion
from hypcheck.tables.streams import PACKED, open_input
from hypcheck.vectors.cases import read_cases
from hypcheck.vectors.draw import Family
from hypcheck.vectors.families import (
    ALL,
    ENDED_FAMILIES,
    ENDED_SWEEP_FAMILIES,
    FAMILIES,
    SWEEP_FAMILIES,
    TILTED_FAMILIES,
    WORST_CANCELLATION,
)
from hypcheck.vectors.format import CaseFile, Metadata, described


def _files_of(families: Mapping[str, Family]) -> tuple[str, ...]:
    """Return the names of the families that have frozen rows."""
    return tuple(name for name, family in families.items() if family.frozen)


NAMES = (*_files_of(FAMILIES), WORST_CANCELLATION)
"""The files of upright spheroids with answers; INVALID_CONTENTS names those of rows without."""

TILTED_NAMES = _files_of(TILTED_FAMILIES)
"""The files of tilted spheroids with answers."""

SWEEP_NAMES = _files_of(SWEEP_FAMILIES)
"""The files of sweeps with answers; if a name begins with tilted, its rows have an axis."""

ENDED_NAMES = _files_of(ENDED_FAMILIES)
"""The files of hyperboloids that end with answers, of upright and tilted spheroids."""

ENDED_SWEEP_NAMES = _files_of(ENDED_SWEEP_FAMILIES)
"""The files of sweeps beside hyperboloids that end, with answers."""

ALL_NAMES = (
    *(*NAMES, "invalid"),
    *(*TILTED_NAMES, "tilted-invalid"),
    *(*SWEEP_NAMES, "way-invalid", "tilted-way-invalid"),
    *(*ENDED_NAMES, "ended-invalid"),
    *(*ENDED_SWEEP_NAMES, "ended-way-invalid"),
)
"""All files, in the order in which they are listed."""


def head_of(name: str) -> Metadata:
    """Return the metadata of the frozen file of that name."""
    return described(name, f"hypcheck cases freeze {name}", ALL.get(name))


def folder() -> Path:
    """Return the folder of the files: in the installed package, or beside it in a source tree."""
    package = Path(__file__).resolve().parents[1]
    inside = package / "cases"
    return inside if inside.is_dir() else package.parent / "cases"


def path_of(name: str) -> Path:
    """Return the path of the file of that name, which is packed in a wheel. Raises InputError for an unknown name."""
    if name not in ALL_NAMES:
        raise InputError(f"there are no frozen vectors {name!r}; {suggestion(name, ALL_NAMES)}")
    path = folder() / f"{name}.json"
    packed = path.with_name(path.name + PACKED)
    return packed if packed.exists() else path


_HEAD = 1 << 16
"""The number of bytes at the start of a file that surely hold its head."""


@cache
def count_of(name: str) -> int:
    """Read the number of frozen cases of that name from the head of their file; `load` refuses a wrong number.

    Raises InputError if there are no cases of that name, or their file cannot be read.
    """
    try:
        with open_input(str(path_of(name))) as file:
            match = re.search(rb'^"count": (\d+),$', file.read(_HEAD), re.MULTILINE)
    except InputError:
        match = None
    return int(match[1]) if match else len(load(name).cases)


@cache
def load(name: str) -> CaseFile:
    """Read the frozen cases of that name. Raises InputError if there are none, or their file is not valid."""
    return read_cases(str(path_of(name)))
