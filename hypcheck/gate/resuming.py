"""From the record of an interrupted run to what a run goes on from, if it is the same run."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from hypcheck.errors import InputError
from hypcheck.gate.plan import GatePlan
from hypcheck.gate.progress import Progress, fingerprints, opening_of
from hypcheck.record import Line, plain, read
from hypcheck.record.reading import interrupted_in
from hypcheck.record.writing import PROGRESS, header

FREE = ("workers", "cluster")
"""Options that may differ: the result is the same with any."""

LIBRARIES = ("numpy", "mpmath", "sympy")
"""Those whose versions a result may depend on."""


@dataclass(frozen=True)
class Resumed:
    """What `file` holds of a run: lines to begin with, and the progress that is the last of them.

    Without progress a run goes on from its beginning. `exit_code` is that of a finished run, None of others.
    """

    file: Path
    carried: tuple[Line, ...]
    progress: Progress | None
    exit_code: int | None = None


def resume(path: Path, plan: GatePlan, options: Mapping[str, Any], cases: int) -> Resumed:
    """What is to be gone on with; `path` is a record, or the folder of a run. Nothing is changed.

    Raises InputError where the record cannot be read, or options, versions, cases, the implementation or its files are
    not those of its run, saying what differs; StartError where the implementation cannot be started.
    """
    file = interrupted_in(path)
    record = read(file)
    _require_same_run(record.header, header(options, datetime.now(timezone.utc)), file)
    if record.footer is not None:
        return Resumed(file, (), None, int(record.footer["exit_code"]))
    place = max((place for place, line in enumerate(record.lines) if line["type"] == PROGRESS), default=None)
    if place is None:
        return Resumed(file, (), None)
    progress = Progress.of_line(record.lines[place], str(file))
    _require_same_implementation(progress, plan, cases, file)
    return Resumed(file, record.lines[: place + 1], progress)


def _require_same_run(before: Line, now: Line, file: Path) -> None:
    parts = {"options": FREE, "versions": (), "machine": ("processor", "cores")}
    for name in ("schema", "hypcheck", "python"):
        _require_same(before.get(name), now[name], name, file)
    for part, free in parts.items():
        there, here = before.get(part), json.loads(json.dumps(plain(now[part])))
        if not isinstance(there, dict):
            raise InputError(f"{file} cannot be resumed: its header has no {part}")
        for key in {**there, **here}:
            if key not in free and (part != "versions" or key in LIBRARIES):
                title = f"--{key.replace('_', '-')}" if part == "options" and key != "specs" else key
                _require_same(there.get(key), here.get(key), title, file)


def _require_same_implementation(progress: Progress, plan: GatePlan, cases: int, file: Path) -> None:
    if not 0 <= progress.number < len(plan.specs):
        raise InputError(f"{file} cannot be resumed: its progress is of implementation {progress.number}")
    _require_same(progress.cases, cases, "the number of cases", file)
    files = fingerprints(plan, progress.number)
    for path in {**progress.files, **files}:
        _require_same(progress.files.get(path), files.get(path), f"the sha256 of {path}", file)
    with opening_of(plan, progress.number).open() as implementation:
        declared = plain(asdict(implementation.declared))
    for key in declared:
        title = f"the {key} that {plan.specs[progress.number]} declares"
        _require_same(progress.declared.get(key), json.loads(json.dumps(declared[key])), title, file)


def _require_same(before: object, now: object, what: str, file: Path) -> None:
    if before != now:
        raise InputError(f"{file} cannot be resumed: {what} was {_shown(before)}, and is {_shown(now)} now")


def _shown(value: object) -> str:
    return "not there" if value is None else json.dumps(value, ensure_ascii=False)
