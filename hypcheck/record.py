"""The record of a run: one JSON object a line, from which every report is made.

The first line is a header, the last a footer; a file without its footer was interrupted and is read as truncated.
Numbers that must come back exactly are hexadecimal strings; infinity is the string "inf".

History of SCHEMA: 1.0.0, the first; 1.1.0 adds the lines of a benchmark, and null for a range of a domain that was not
declared.
"""

from __future__ import annotations

import json
import math
import os
import platform
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NoReturn, TextIO

from hypcheck.errors import InputError
from hypcheck.version import VERSION

SCHEMA = "1.1.0"

Line = dict[str, Any]


@dataclass(frozen=True)
class Record:
    """A record as read: its header, its lines between header and footer, and its footer (None: truncated)."""

    header: Line
    lines: tuple[Line, ...]
    footer: Line | None

    def of(self, kind: str) -> list[Line]:
        """The lines of one kind, in order."""
        return [line for line in self.lines if line["type"] == kind]


class Recorder:
    """Writes a record line by line; each line is flushed, so that an interrupted run keeps what it finished."""

    def __init__(self, stream: TextIO, options: Mapping[str, Any]) -> None:
        self._stream = stream
        self._started = datetime.now(timezone.utc)
        self._lines: list[Line] = []
        self._header = plain(header(options, self._started))
        self._write(self._header)

    def add(self, kind: str, /, **fields: Any) -> None:  # noqa: ANN401  a line holds whatever JSON can
        """Add one line of a kind."""
        line = plain({"type": kind, **fields})
        self._write(line)
        self._lines.append(line)

    def close(self, exit_code: int) -> Record:
        """Write the footer; the record as it would be read back."""
        seconds = (datetime.now(timezone.utc) - self._started).total_seconds()
        footer: Line = {"type": "footer", "lines": len(self._lines) + 2, "exit_code": exit_code, "seconds": seconds}
        self._write(footer)
        return Record(self._header, tuple(self._lines), footer)

    def _write(self, line: Line) -> None:
        self._stream.write(json.dumps(line, ensure_ascii=False, allow_nan=False) + "\n")
        self._stream.flush()


def header(options: Mapping[str, Any], started: datetime) -> Line:
    """The first line: versions, machine and options."""
    return {
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
        "options": dict(options),
    }


def read(path: Path) -> Record:
    """The record in a file. Raises InputError naming file, line and what is wrong with it."""
    try:
        with path.open(encoding="utf-8") as stream:
            lines = list(_lines(stream, path))
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text: {error.reason} at byte {error.start}") from None
    if not lines or lines[0].get("type") != "header":
        raise InputError(f"{path}: line 1 is no header; a record begins with one")
    schema = str(lines[0].get("schema"))
    readable = SCHEMA.partition(".")[0]
    if schema.partition(".")[0] != readable:
        raise InputError(f"{path}: has schema {schema}; this version reads {readable}.x")
    complete = lines[-1].get("type") == "footer"
    if complete and lines[-1].get("lines") != len(lines):
        raise InputError(f"{path}: has {len(lines)} lines, but its footer counts {lines[-1].get('lines')}")
    return Record(lines[0], tuple(lines[1:-1] if complete else lines[1:]), lines[-1] if complete else None)


def _lines(stream: Iterable[str], path: Path) -> Iterator[Line]:
    for number, text in enumerate(stream, start=1):
        try:
            line = json.loads(text, parse_constant=_refuse)
        except ValueError as error:
            if number > 1 and not text.endswith("\n"):
                return  # the line that was being written when the run was interrupted
            raise InputError(f"{path}: line {number} is no JSON: {error}") from None
        if not isinstance(line, dict) or not isinstance(line.get("type"), str):
            raise InputError(f"{path}: line {number} is no object with a type")
        yield line


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is no number of JSON; infinities are the strings inf and -inf")


def plain(value: Any) -> Any:  # noqa: ANN401  any value that a line holds
    """The value as JSON has it: infinities as the strings "inf" and "-inf", mappings and sequences likewise."""
    if isinstance(value, float):
        if math.isfinite(value):
            return value
        return str(value)
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return value


def _versions() -> dict[str, str]:
    """The versions of the libraries a run can use, read from their metadata: asking the modules would load them."""
    found = {}
    for name in ("numpy", "sympy", "mpmath", "python-fcl", "click", "matplotlib"):
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
