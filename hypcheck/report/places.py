"""Each failure of a run with its place in the code under test, for formats that show failures beside the code.

The file follows from SPEC and the record. The line of a Python function is the one thing that no record holds: it is
looked up in the file, and only if that is still the file that was asked (by its sha256).
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from hypcheck.errors import InputError
from hypcheck.implementations.spec import Spec, is_file, parse_spec
from hypcheck.messages import sentence
from hypcheck.record import Record
from hypcheck.record.reader import FILE
from hypcheck.report.model import under_test
from hypcheck.report.verdict import INCONCLUSIVE, Failure, ended_badly, failures
from hypcheck.runs.fingerprint import sha256


@dataclass(frozen=True, slots=True)
class Place:
    """A file, relative to the working directory where it lies under it, and a line from 1; None: it is not known."""

    file: str
    line: int | None = None


@dataclass(frozen=True, slots=True)
class PlacedFailure:
    """A failure, its place, and a fingerprint that a later run of the same code repeats and no other failure has."""

    failure: Failure
    place: Place
    fingerprint: str

    @property
    def rule(self) -> str:
        """What it breaks, in one word for programs: implementation/wrong."""
        return sentence(f"{self.failure.subject}/{self.failure.kind}")

    @property
    def message(self) -> str:
        """What happened, and the command that shows it."""
        replay = f"; replay: {self.failure.replay}" if self.failure.replay else ""
        return sentence(f"{self.failure.message}{replay}")

    @property
    def certain(self) -> bool:
        """Whether it is known to be a failure, and not only too noisy to tell."""
        return self.failure.kind != INCONCLUSIVE


UNKNOWN = Place(FILE)
"""The place of what no file of the code under test is known for: the record, since readers require a place."""


def placed_failures(record: Record) -> list[PlacedFailure]:
    """Every failure of a run, worst first; a run that ended badly has that as its first."""
    failed = failures(record)
    ended = ended_badly(record, failed)
    known = dict(_places(record))
    found, seen = [], dict[str, int]()
    for failure in [*([ended] if ended else []), *failed]:
        name = "\0".join((failure.subject, failure.name, failure.group, failure.kind))
        seen[name] = seen.get(name, 0) + 1
        digest = hashlib.sha256(f"{name}\0{seen[name]}".encode("utf-8", "replace")).hexdigest()
        place = known.get(failure.name, UNKNOWN) if failure.subject == "implementation" else UNKNOWN
        found.append(PlacedFailure(failure, place, digest))
    return found


def _places(record: Record) -> Iterator[tuple[str, Place]]:
    """The place of each implementation under test for which one is known, by its name in reports."""
    hashes = record.header.files or {}
    for tested in under_test(record):
        try:
            spec = parse_spec(tested.line.spec)
        except InputError:  # a record may hold any text
            continue
        file = _file(spec, hashes)
        if file is not None:
            yield tested.name, Place(_relative(file), _line(spec, file, hashes.get(file)))


def _file(spec: Spec, hashes: Mapping[str, str]) -> str | None:
    """The file of an implementation: of a command the first argument that names one, else its program if a path."""
    first, *arguments = spec.words
    match spec.kind:
        case "library":
            return str(Path(first))
        case "python" if is_file(first):
            return str(Path(first))
        case "python":
            module = first.replace(".", "/")
            ends = (f"/{module}.py", f"/{module}/__init__.py")
            return next((path for path in hashes if Path(path).as_posix().endswith(ends)), None)
        case "command":
            files = [str(Path(word)) for word in arguments] + ([str(Path(first))] if os.sep in first else [])
            return next((path for path in files if path in hashes), None)
        case _:
            return None


def _relative(file: str) -> str:
    """The file relative to the working directory, where it lies under it, with forward slashes."""
    here = Path.cwd()
    path = Path(file)
    return (path.relative_to(here) if path.is_relative_to(here) else path).as_posix()


def _line(spec: Spec, file: str, told: str | None) -> int | None:
    """The line of a Python function in its file; None if the file is another now, or does not define it by name."""
    if spec.kind != "python" or told is None or sha256(Path(file)) != told:
        return None
    name = re.escape(spec.words[1])
    text = Path(file).read_text(encoding="utf-8", errors="replace")
    found = re.search(
        rf"^[ \t]*(?:async[ \t]+def|def|class)[ \t]+{name}\b|^{name}[ \t]*(?::[^=\n]*)?=", text, re.MULTILINE
    )
    return None if found is None else text.count("\n", 0, found.start()) + 1
