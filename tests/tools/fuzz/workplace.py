"""The folder in which a process reads damaged input."""

from __future__ import annotations

import atexit
import contextlib
import os
import shutil
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from tests.tools.fuzz import seeds


@cache
def folder() -> Path:
    """A folder of this process, in memory if the system offers that."""
    memory = Path("/dev/shm")  # noqa: S108 - a folder of our own is made in it
    path = Path(tempfile.mkdtemp(prefix="hypcheck-fuzz-", dir=memory if os.access(memory, os.W_OK) else None))
    atexit.register(shutil.rmtree, path, ignore_errors=True)
    return path


def kept(data: bytes, name: str) -> Path:
    """A file with these bytes."""
    path = folder() / name
    path.write_bytes(data)
    return path


@contextlib.contextmanager
def at_home() -> Iterator[None]:
    """In a folder where there is a record.jsonl and nothing else."""
    before, path = Path.cwd(), folder() / "home"
    if not path.exists():
        path.mkdir()
        (path / "record.jsonl").write_bytes(seeds.records()[0])
    os.chdir(path)
    try:
        yield
    finally:
        os.chdir(before)
