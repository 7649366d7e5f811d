"""A record read as a whole."""

from __future__ import annotations

import os
import shlex
from pathlib import Path

from hypcheck.errors import InputError
from hypcheck.record.model import Record
from hypcheck.record.scanning import Scan
from hypcheck.tables.streams import reading

FILE = "record.jsonl"
"""The record's name in the folder of a run."""

GROWING = "record.jsonl.part"
"""Its name while the run goes on, and after one that was killed."""


def file_of(path: Path) -> Path:
    """The file of a record, which may be named by the folder of its run."""
    return path / FILE if os.path.isdir(path) else path  # is_dir() raises where a name is too long


def interrupted_in(path: Path) -> Path:
    """The file of a record to go on with: in the folder of a run, that of one that was killed goes before."""
    return path / GROWING if (path / GROWING).is_file() else file_of(path)


def file_and_newer(path: Path) -> tuple[Path, str]:
    """As file_of, and a sentence about a newer run in its folder that has not finished; empty where there is none.

    Raises InputError where the newer run is the only one.
    """
    file = file_of(path)
    growing = file.with_name(GROWING)
    if file.name != FILE or not growing.is_file():
        return file, ""
    goes_on = f"its command with --resume {shlex.quote(str(file.parent))} goes on with it where it names a SPEC"
    newer = f"{growing} is of a newer run, which was killed or is still at work; {goes_on}"
    if not file.exists():
        raise InputError(f"{file} is not there; {newer}")
    return file, newer


def read(path: Path) -> Record:
    """The record in a file, truncated where it was cut off anywhere behind its first line.

    Raises DamagedError, an InputError that names the byte and what is wrong there, where it is not as it was written,
    and InputError where it is no record that this program reads.
    """
    with reading(str(path)) as reader:
        scan = Scan(reader)
        lines = list(scan)
    return Record(lines[0], tuple(lines[1:-1] if scan.footer else lines[1:]), scan.footer)
