"""The file that a record grows in: lines are added at its end, and now and then all of it is exchanged at once."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path


class Growing:
    """A context manager. Whatever moment the program is killed at, the file holds what stood there or what was new.

    Raises OSError where the system refuses; the file is then as it was, but for a line that may be cut off.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file = path.open("ab")

    def __enter__(self) -> Growing:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def empty(self) -> None:
        """Forget what stands there."""
        self._file.truncate(0)

    def write(self, data: bytes) -> None:
        """Add to the end, so that it is there should this process end at once."""
        self._file.write(data)
        self._file.flush()

    def renew(self, data: bytes) -> None:
        """Let `data` take the place of all that stands there, when it is on the disk."""
        beside = self._path.with_name(self._path.name + ".new")
        try:
            with beside.open("wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
        except OSError:
            with suppress(OSError):
                beside.unlink()
            raise
        with suppress(OSError):  # what could not be written of a line is written anew
            self._file.close()
        beside.replace(self._path)
        self._file = self._path.open("ab")
