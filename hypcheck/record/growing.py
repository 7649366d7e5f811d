"""The file that a record grows in: lines are added at its end, and now and then all of it is exchanged at once."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO


class Growing:
    """A context manager. Whatever moment the program is killed at, the file holds what stood there or what was new.

    Raises OSError where the system refuses; the file is then as it was, but for a line that may be cut off. A folder
    that somebody removed is made again.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._beside = path.with_name(path.name + ".new")
        self._file: BinaryIO | None = None

    def __enter__(self) -> Growing:
        return self

    def __exit__(self, *_: object) -> None:
        if self._file is not None:
            self._file.close()

    def write(self, data: bytes) -> None:
        """Add to the end, so that it is there should this process end at once."""
        if self._file is None:
            raise ValueError("a record is renewed before anything is added to it")
        self._file.write(data)
        self._file.flush()

    def renew(self, data: bytes) -> None:
        """Let `data` take the place of all that stands there, when it is on the disk."""
        self._path.parent.mkdir(parents=True, exist_ok=True)
        file = _new_file(self._beside)
        try:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
            self._beside.replace(self._path)
        except OSError:
            with suppress(OSError):
                file.close()
            with suppress(OSError):
                self._beside.unlink()
            raise
        before, self._file = self._file, file
        if before is not None:
            with suppress(OSError):  # what could not be written of a line was written anew
                before.close()

    @property
    def is_there(self) -> bool:
        """Whether what was written stands in its place: nobody removed it, or put something else there."""
        try:
            return self._file is not None and os.path.samestat(os.fstat(self._file.fileno()), self._path.stat())
        except OSError:
            return False

    def move(self, path: Path) -> None:
        """Take another place, for good."""
        self._path.replace(path)


def _new_file(path: Path) -> BinaryIO:
    """A file that was not there before, to be added to; what a killed run left in its place is removed.

    A link that somebody planted there is not followed. Raises OSError, also where one is planted at this very moment.
    """
    path.unlink(missing_ok=True)
    how = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
    return os.fdopen(os.open(path, how, 0o666), "ab")
