"""The writer of a record: one run at a time holds the folder, and appends one JSON object a line.

One run at a time in a folder: the system keeps the lock, and gives it back however the run ends.

The file that a record grows in: lines are added at its end, and now and then all of it is exchanged at once.

The record of a run: one JSON object a line, from which every report is made.

The first line is a header, the last a footer; a file without its footer was interrupted and is read as truncated.
Numbers that must come back exactly are hexadecimal strings; infinity is the string "inf".
"""

from __future__ import annotations

import os
import platform
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, BinaryIO, TextIO

from msgspec import UNSET

from hypcheck.errors import InputError
from hypcheck.processes import interrupts_deferred
from hypcheck.record.fields import RecordLine, as_json, plain
from hypcheck.record.integrity import sealed
from hypcheck.record.lines import (
    SCHEMA,
    FooterLine,
    HeaderLine,
    ImplementationLine,
    Machine,
    NotStartedLine,
    SettingsPart,
)
from hypcheck.record.progress import ProgressLine
from hypcheck.record.reader import Record
from hypcheck.version import VERSION


class FolderInUseError(InputError):
    """Another process has the folder."""


@contextmanager
def folder_locked(folder: Path) -> Iterator[None]:
    """While it lasts no other process owns the folder. Raises FolderInUseError where one does.

    Where the system has no locks for folders (Windows, some networks), nobody is refused.
    """
    place = None if sys.platform == "win32" else os.open(folder, os.O_RDONLY)
    try:
        if place is not None and not _locked(place):
            raise FolderInUseError(f"{folder}: another run is writing its record there; wait for it, or end it")
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


class GrowingFile:
    """A context manager. Whatever moment the program is killed at, the file holds what stood there or what was new.

    Raises OSError where the system refuses; the file is then as it was, but for a line that may be cut off. A folder
    that somebody removed is made again.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._beside = path.with_name(path.name + ".new")
        self._file: BinaryIO | None = None

    def __enter__(self) -> GrowingFile:
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


@dataclass(frozen=True)
class Provenance:
    """What the headers of some runs say besides: the sha256 of files under test and of our own, and the settings."""

    files: Mapping[str, str] | None = None
    program: str | None = None
    settings: SettingsPart | None = None


class Recorder:
    """Writes a record line by line; each line is flushed, so that an interrupted run keeps what it finished.

    `provenance` is told in the header. `carried` are lines of the record
    that is gone on with, which are there from the first moment on. Interrupts wait while a line is written, so that
    none is ever written twice, or by half with another behind it.
    """

    def __init__(
        self,
        stream: TextIO | GrowingFile,
        options: Mapping[str, Any],
        provenance: Provenance | None = None,
        carried: Sequence[RecordLine] = (),
    ) -> None:
        self._stream = stream
        self._started = datetime.now(timezone.utc)
        self._began = time.monotonic()  # the clock may be set meanwhile
        self._lines = [line for line in carried if not isinstance(line, ProgressLine)]
        self._progress = next((line for line in carried if isinstance(line, ProgressLine)), None)
        self._place = len(self._lines)
        self._ending: tuple[FooterLine, ...] = ()
        self._check = 0
        self._header = header(options, self._started, provenance)
        if isinstance(stream, GrowingFile):
            self._renew()
        else:
            self._write(self._header)

    @property
    def goes_on(self) -> bool:
        """Whether there is something of a gating run that it could go on from."""
        return self._progress is not None or self.concluded > 0

    @property
    def concluded(self) -> int:
        """How many implementations under test have been asked to their end, or could not be started."""
        return sum(isinstance(line, (ImplementationLine, NotStartedLine)) for line in self._lines)

    @property
    def lines(self) -> tuple[RecordLine, ...]:
        """What was added so far."""
        return tuple(self._lines)

    def add(self, line: RecordLine) -> None:
        """Add one line."""
        self._write(line)
        self._lines.append(line)

    def keep(self, progress: ProgressLine) -> None:
        """Let a line of progress stand behind what is recorded, in place of the one before; in a file alone."""
        if isinstance(self._stream, GrowingFile):
            self._progress, self._place = progress, len(self._lines)
            self._renew()

    def close(self, exit_code: int) -> Record:
        """Write the footer; the record as it would be read back."""
        seconds = time.monotonic() - self._began
        footer = FooterLine(lines=len(self._lines) + 2, exit_code=exit_code, seconds=seconds)
        self._ending = (footer,)
        if self._progress is None:
            self._write(footer)
        else:
            self._progress = None
            self._renew()
        return Record(self._header, tuple(self._lines), footer)

    def settle(self, path: Path) -> None:
        """Let the file that grew take another place; what somebody removed meanwhile is written anew."""
        if isinstance(self._stream, GrowingFile):
            if not self._stream.is_there:
                self._renew()
            self._stream.move(path)

    def _write(self, line: RecordLine) -> None:
        with interrupts_deferred():
            data, self._check = sealed(as_json(line), self._check)
            if isinstance(self._stream, GrowingFile):
                self._stream.write(data)
            else:
                self._stream.write(data.decode())
                self._stream.flush()

    def _renew(self) -> None:
        """Write all lines anew."""
        if not isinstance(self._stream, GrowingFile):
            raise TypeError("only a file can be renewed")
        progress = [] if self._progress is None else [self._progress]
        data, check = b"", 0
        for line in (self._header, *self._lines[: self._place], *progress, *self._lines[self._place :], *self._ending):
            text, check = sealed(as_json(line), check)
            data += text
        with interrupts_deferred():
            self._stream.renew(data)
            self._check = check


def header(options: Mapping[str, Any], started: datetime, provenance: Provenance | None = None) -> HeaderLine:
    """The first line: versions, machine and options, and what is known of the run's provenance."""
    known = provenance or Provenance()
    return HeaderLine(
        schema=SCHEMA,
        hypcheck=VERSION,
        started=started.isoformat(timespec="seconds"),
        python=platform.python_version(),
        versions=_versions(),
        machine=Machine(
            system=platform.system(),
            architecture=platform.machine(),
            processor=_processor(),
            cores=os.cpu_count(),
        ),
        options=plain(options),
        files=UNSET if known.files is None else dict(known.files),
        program=UNSET if known.program is None else known.program,
        settings=UNSET if known.settings is None else known.settings,
    )


def _versions() -> dict[str, str]:
    """The versions of the libraries a run can use, read from their metadata: asking the modules would load them."""
    found = {}
    for name in ("numpy", "sympy", "mpmath", "python-fcl", "coal", "click", "matplotlib"):
        with suppress(PackageNotFoundError):
            found[name] = version(name)
    return found


def _processor() -> str:
    try:
        with Path("/proc/cpuinfo").open(encoding="utf-8") as stream:
            for line in stream:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or "unknown"
