"""One run at a time in a folder: the system keeps the lock, and gives it back however the run ends."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hypcheck.errors import InputError


class OwnedError(InputError):
    """Another process has the folder."""


@contextmanager
def owning(folder: Path) -> Iterator[None]:
    """While it lasts no other process owns the folder. Raises OwnedError where one does.

    Where the system has no locks for folders (Windows, some networks), nobody is refused.
    """
    place = None if sys.platform == "win32" else os.open(folder, os.O_RDONLY)
    try:
        if place is not None and not _locked(place):
            raise OwnedError(f"{folder}: another run is writing its record there; wait for it, or end it")
        yield
    finally:
        if place is not None:
            os.close(place)  # which gives the lock back


def _locked(place: int) -> bool:
    """Take the lock of an open folder; whether it could be had."""
    if sys.platform != "win32":
        import fcntl  # noqa: PLC0415 - there is none on Windows

        try:
            fcntl.flock(place, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        except OSError:
            return True
    return True
