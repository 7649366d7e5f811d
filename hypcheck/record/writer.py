"""The writer of a record: one run at a time owns the folder, and appends one JSON object a line.

Nothing is written before the run has a first result: a run that is refused leaves its folder as it was.

The first line is a header, the last a footer; a file without its footer was interrupted and is read as truncated.
Numbers that must come back exactly are hexadecimal strings; infinity is the string "inf". The system keeps the lock of
the folder and releases it however the run ends. Lines are added at the end of the file, and at times the whole file is
replaced at once.
"""

from __future__ import annotations

import os
import platform
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import datetime, timezone
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, BinaryIO

from hypcheck.errors import InputError, system_reason
from hypcheck.processes import interrupts_deferred
from hypcheck.record.fields import RecordLine, as_json, plain
from hypcheck.record.integrity import sealed
from hypcheck.record.lines import (
    SCHEMA,
    FooterLine,
    GroupLine,
    HeaderLine,
    ImplementationLine,
    IsolationPart,
    Machine,
    NotStartedLine,
    SettingsPart,
    UnavailableLine,
)
from hypcheck.record.measurements import AbsentLine, CompilerLine, MethodLine, WorkloadLine
from hypcheck.record.progress import ProgressLine
from hypcheck.record.reader import Record
from hypcheck.version import VERSION

if sys.platform != "win32":
    import fcntl


class FolderInUseError(InputError):
    """Another run is writing to the folder."""


@contextmanager
def folder_locked(folder: Path) -> Iterator[None]:
    """Own the folder within the block. Raises FolderInUseError if another process owns it.

    If the system has no locks for folders (Windows, some networks), every process gets it.
    """
    place = None if sys.platform == "win32" else os.open(folder, os.O_RDONLY)
    try:
        if place is not None and not _locked(place):
            raise FolderInUseError(f"{folder}: another run is writing its record there; wait for it, or end it")
        yield
    finally:
        if place is not None:
            os.close(place)  # this releases the lock


def _locked(place: int) -> bool:
    """Take the lock of an open folder; return whether it was free, or the system has none."""
    try:
        fcntl.flock(place, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True


class GrowingFile:
    """A file that grows, as a context manager. Killed at any moment, it holds its old content or the new one.

    Methods raise OSError, naming the file, if the system fails; the file is then as before, except that a line may be
    cut off. A folder that was removed is made again.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._beside = path.with_name(path.name + ".new")
        self._file: BinaryIO | None = None

    def __enter__(self) -> GrowingFile:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        """Close the file. Raises InputError if data may be lost, unless another error already reports it."""
        try:
            if self._file is not None:
                self._file.close()
        except OSError as error:
            if kind is None:
                raise InputError(f"cannot write {self._path}: {system_reason(error)}") from error

    @contextmanager
    def _errors_name_it(self) -> Iterator[None]:
        """Make an error of the system within the block name this file, not the one beside it, or none."""
        try:
            yield
        except OSError as error:
            error.filename, error.filename2 = str(self._path), None
            raise

    def write(self, data: bytes) -> None:
        """Add to the end; the data survives if this process is killed."""
        if self._file is None:
            raise ValueError("a growing file must be renewed before anything is added to it")
        with self._errors_name_it():
            self._file.write(data)
            self._file.flush()

    def renew(self, data: bytes) -> None:
        """Replace the whole content by `data`, once that is on the disk."""
        with self._errors_name_it():
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
            with suppress(OSError):  # a line that was cut off is in the new file
                before.close()

    @property
    def is_there(self) -> bool:
        """Whether the file is still in its place: it was not removed or replaced."""
        try:
            return self._file is not None and os.path.samestat(os.fstat(self._file.fileno()), self._path.stat())
        except OSError:
            return False

    def move(self, path: Path) -> None:
        """Move the file to its final place."""
        self._path.replace(path)
        self._path = path


def _new_file(path: Path) -> BinaryIO:
    """Open a new file to append to; the file of a killed run in its place is removed.

    A link in its place is not followed. Raises OSError, also if a link is made there at this moment.
    """
    path.unlink(missing_ok=True)
    how = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
    return os.fdopen(os.open(path, how, 0o666), "ab")


@dataclass(frozen=True)
class Provenance:
    """The fields that the headers of some runs have in addition.

    files: the sha256 of the files under test, by path.
    program: the sha256 of hypcheck's own files.
    settings: the settings file, and the options that weaken the gate.
    isolation: how the implementations are isolated.
    not_hashed: what the implementations start besides the files, as far as that is known.
    """

    files: Mapping[str, str] | None = None
    program: str | None = None
    settings: SettingsPart | None = None
    isolation: IsolationPart | None = None
    not_hashed: Sequence[str] | None = None


_WITHOUT_RESULT = (
    AbsentLine,
    CompilerLine,
    ImplementationLine,
    MethodLine,
    NotStartedLine,
    UnavailableLine,
    WorkloadLine,
)
"""Types of lines without an answer: they say what a run will test, what is missing, or what could not be started."""


def is_result(line: RecordLine) -> bool:
    """Decide whether the line has a result of the run."""
    if isinstance(line, GroupLine):
        return line.asked > 0
    if isinstance(line, ProgressLine):
        return bool(line.state.total.pending) or any(tallied.asked for tallied in line.state.total.tallies.values())
    return not isinstance(line, _WITHOUT_RESULT)


class Recorder:
    """Writes a record line by line; each line is flushed, so that an interrupted run keeps what it finished.

    `provenance` goes into the header. `carried` are lines of the record that is resumed, written at once. With `begins`
    nothing is written before the first new result; `begins` is called when that is in the file. Interrupts wait while a
    line is written, so that no line is written twice, or half of one before another.
    """

    def __init__(
        self,
        file: GrowingFile,
        options: Mapping[str, Any],
        provenance: Provenance | None = None,
        carried: Sequence[RecordLine] = (),
        begins: Callable[[], object] | None = None,
    ) -> None:
        self._file = file
        self._begins = begins
        self.begun = False
        """Whether the file has been written."""
        self._started = datetime.now(timezone.utc)
        self._began = time.monotonic()  # the wall clock may be set during the run
        self._lines = [line for line in carried if not isinstance(line, ProgressLine)]
        self._progress = next((line for line in carried if isinstance(line, ProgressLine)), None)
        self._place = len(self._lines)
        self._ending: tuple[FooterLine, ...] = ()
        self._check = 0
        self._header = header(options, self._started, provenance)
        if begins is None:
            self._begin()

    @property
    def has_results(self) -> bool:
        """Whether a result was ever recorded. A run without results does not replace an earlier run."""
        return self.begun or any(map(is_result, self._kept()))

    @property
    def goes_on(self) -> bool:
        """Whether the record has something that --resume could continue."""
        return self.begun and (self._progress is not None or self.concluded > 0)

    @property
    def concluded(self) -> int:
        """The number of implementations under test that are finished or could not be started."""
        return sum(isinstance(line, (ImplementationLine, NotStartedLine)) for line in self._lines)

    @property
    def lines(self) -> tuple[RecordLine, ...]:
        """The lines that were added so far."""
        return tuple(self._lines)

    def add(self, line: RecordLine) -> None:
        """Add one line."""
        if self.begun:
            self._write(line)
        self._lines.append(line)
        if not self.begun and is_result(line):
            self._begin()

    def keep(self, progress: ProgressLine) -> None:
        """Put a line of progress after the recorded lines, in place of the previous one."""
        self._progress, self._place = progress, len(self._lines)
        if self.begun:
            self._renew()
        elif is_result(progress):
            self._begin()

    def close(self, exit_code: int) -> Record:
        """Write the footer, if the file has begun; return the record as it would be read back."""
        seconds = time.monotonic() - self._began
        footer = FooterLine(lines=len(self._lines) + 2, exit_code=exit_code, seconds=seconds)
        self._ending = (footer,)
        finished, self._progress = self._progress, None
        if self.begun and finished is None:
            self._write(footer)
        elif self.begun:
            self._renew()
        return Record(self._header, tuple(self._lines), footer)

    def settle(self, path: Path) -> None:
        """Move the file to its final place; if it has not begun, or was removed during the run, it is written first."""
        if not self.begun:
            self._begin()
        elif not self._file.is_there:
            self._renew()
        self._file.move(path)

    def _begin(self) -> None:
        """Write the file for the first time, and call `begins`."""
        with interrupts_deferred():
            self._renew()
            self.begun = True
            if self._begins is not None:
                self._begins()

    def _kept(self) -> Iterable[RecordLine]:
        """Return the lines between header and footer in their order."""
        progress = [] if self._progress is None else [self._progress]
        return (*self._lines[: self._place], *progress, *self._lines[self._place :])

    def _write(self, line: RecordLine) -> None:
        """Add a line to the file."""
        with interrupts_deferred():
            data, self._check = sealed(as_json(line), self._check)
            self._file.write(data)

    def _renew(self) -> None:
        """Write all lines again."""
        data, check = b"", 0
        for line in (self._header, *self._kept(), *self._ending):
            text, check = sealed(as_json(line), check)
            data += text
        with interrupts_deferred():
            self._file.renew(data)
            self._check = check


LIBRARIES = ("numpy", "sympy", "mpmath", "python-fcl", "coal", "click", "matplotlib")
"""The libraries that a run can use."""


def header(options: Mapping[str, Any], started: datetime, provenance: Provenance | None = None) -> HeaderLine:
    """Make the first line: versions, machine, options and provenance of the run."""
    known = {} if provenance is None else vars(provenance)
    return HeaderLine(
        schema=SCHEMA,
        hypcheck=VERSION,
        started=started.isoformat(timespec="seconds"),
        python=platform.python_version(),
        versions={name: found for name in LIBRARIES if (found := library_version(name)) is not None},
        machine=Machine(
            system=platform.system(),
            architecture=platform.machine(),
            processor=processor_name(),
            cores=os.cpu_count(),
        ),
        options=plain(options),
        **{name: value for name, value in known.items() if value is not None},
    )


@cache
def library_version(name: str) -> str | None:
    """Return the version of a library from its metadata, so that it is not loaded; None if it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def processor_name(listed: Path = Path("/proc/cpuinfo")) -> str:
    """Return the name of the first processor that the system lists; if it lists none, the name that Python has.

    Returns "unknown" if there is neither.
    """
    try:
        with listed.open(encoding="utf-8") as stream:
            for line in stream:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or "unknown"
