"""A record read as a whole."""

from __future__ import annotations

import os
from pathlib import Path

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


def read(path: Path) -> Record:
    """The record in a file, truncated where it was cut off anywhere behind its first line.

    Raises DamagedError, an InputError that names the byte and what is wrong there, where it is not as it was written,
    and InputError where it is no record that this program reads.
    """
    with reading(str(path)) as reader:
        scan = Scan(reader)
        lines = list(scan)
    return Record(lines[0], tuple(lines[1:-1] if scan.footer else lines[1:]), scan.footer)
