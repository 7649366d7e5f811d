"""The record of a run: one JSON object a line, from which every report is made.

The first line is a header, the last a footer; a file without its footer was interrupted and is read as truncated.
Numbers that must come back exactly are hexadecimal strings; infinity is the string "inf".
"""

from __future__ import annotations

import os
import platform
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, TextIO

from hypcheck.processes import interrupts_deferred
from hypcheck.record.fields import Line, as_json, decoded, plain
from hypcheck.record.growing import Growing
from hypcheck.record.lines import SCHEMA, Footer, Header, Implementation, NotStarted
from hypcheck.record.progress import Progress
from hypcheck.record.reader import Record
from hypcheck.record.sealing import sealed
from hypcheck.version import VERSION


class Recorder:
    """Writes a record line by line; each line is flushed, so that an interrupted run keeps what it finished.

    `optional` are the fields of the header that not every run has, such as `files`. `carried` are lines of the record
    that is gone on with, which are there from the first moment on. Interrupts wait while a line is written, so that
    none is ever written twice, or by half with another behind it.
    """

    def __init__(
        self,
        stream: TextIO | Growing,
        options: Mapping[str, Any],
        optional: Mapping[str, Any] | None = None,
        carried: Sequence[Line] = (),
    ) -> None:
        self._stream = stream
        self._started = datetime.now(timezone.utc)
        self._began = time.monotonic()  # the clock may be set meanwhile
        self._lines = [line for line in carried if not isinstance(line, Progress)]
        self._progress = next((line for line in carried if isinstance(line, Progress)), None)
        self._place = len(self._lines)
        self._ending: tuple[Footer, ...] = ()
        self._check = 0
        self._header = header(options, self._started, optional)
        if isinstance(stream, Growing):
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
        return sum(isinstance(line, (Implementation, NotStarted)) for line in self._lines)

    @property
    def lines(self) -> tuple[Line, ...]:
        """What was added so far."""
        return tuple(self._lines)

    def add(self, line: Line) -> None:
        """Add one line."""
        self._write(line)
        self._lines.append(line)

    def keep(self, progress: Progress) -> None:
        """Let a line of progress stand behind what is recorded, in place of the one before; in a file alone."""
        if isinstance(self._stream, Growing):
            self._progress, self._place = progress, len(self._lines)
            self._renew()

    def close(self, exit_code: int) -> Record:
        """Write the footer; the record as it would be read back."""
        seconds = time.monotonic() - self._began
        footer = Footer(lines=len(self._lines) + 2, exit_code=exit_code, seconds=seconds)
        self._ending = (footer,)
        if self._progress is None:
            self._write(footer)
        else:
            self._progress = None
            self._renew()
        return Record(self._header, tuple(self._lines), footer)

    def settle(self, path: Path) -> None:
        """Let the file that grew take another place; what somebody removed meanwhile is written anew."""
        if isinstance(self._stream, Growing):
            if not self._stream.is_there:
                self._renew()
            self._stream.move(path)

    def _write(self, line: Line) -> None:
        with interrupts_deferred():
            data, self._check = sealed(as_json(line), self._check)
            if isinstance(self._stream, Growing):
                self._stream.write(data)
            else:
                self._stream.write(data.decode())
                self._stream.flush()

    def _renew(self) -> None:
        """Write all lines anew."""
        if not isinstance(self._stream, Growing):
            raise TypeError("only a file can be renewed")
        progress = [] if self._progress is None else [self._progress]
        data, check = b"", 0
        for line in (self._header, *self._lines[: self._place], *progress, *self._lines[self._place :], *self._ending):
            text, check = sealed(as_json(line), check)
            data += text
        with interrupts_deferred():
            self._stream.renew(data)
            self._check = check


def header(options: Mapping[str, Any], started: datetime, optional: Mapping[str, Any] | None = None) -> Header:
    """The first line: versions, machine and options, and the `optional` fields that are there."""
    fields = {
        "type": "header",
        "schema": SCHEMA,
        "hypcheck": VERSION,
        "started": started.isoformat(timespec="seconds"),
        "python": platform.python_version(),
        "versions": _versions(),
        "machine": {
            "system": platform.system(),
            "architecture": platform.machine(),
            "processor": _processor(),
            "cores": os.cpu_count(),
        },
        "options": plain(options),
        **(optional or {}),
    }
    return decoded(fields, Header)


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
