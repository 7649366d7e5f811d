"""From the record of an interrupted run to what a run goes on from, if it is the same run."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from hypcheck.errors import InputError
from hypcheck.gate.consistency import require_lines, require_state
from hypcheck.gate.ourselves import own_sha256
from hypcheck.gate.plan import GatePlan
from hypcheck.gate.progress import Progress
from hypcheck.gate.run import known_failures_of, rules_of, steps_of
from hypcheck.gate.schedule import State
from hypcheck.record import Line, Record, plain
from hypcheck.record.fields import as_json
from hypcheck.record.lines import Implementation, NotStarted
from hypcheck.record.lines import Progress as ProgressLine
from hypcheck.record.writer import header

FREE = ("workers", "cluster")
"""Options that may differ: the result is the same with any."""

LIBRARIES = ("numpy", "mpmath", "sympy")
"""Those whose versions a result may depend on."""


@dataclass(frozen=True)
class Resumed:
    """What a record holds of a run: lines to begin with, and the state that the next implementation is in.

    The lines are of implementations that were asked to their end, with the line of progress of the next one behind
    them if there is one; otherwise the state is None, and it is asked from its beginning.
    """

    carried: tuple[Line, ...] = ()
    state: State | None = None

    def done(self, cases: int) -> int:
        """How many cases were asked, where each implementation is asked so many."""
        finished = [line for line in self.carried if isinstance(line, (Implementation, NotStarted))]
        return len(finished) * cases + (self.state.total.cases if self.state else 0)


def require_same_run(
    record: Record, file: Path, plan: GatePlan, options: Mapping[str, Any], files: Mapping[str, str]
) -> None:
    """Raise InputError, saying what differs, where the record in `file` is not one of a run of this kind.

    `options` are those of the run now, and `files` the sha256 of those that its SPECs name.
    """
    before, now = as_json(record.header), as_json(header(options, datetime.now(timezone.utc), {"files": files}))
    if not {"specs", "max_abstained"} <= before["options"].keys():
        command = "bench" if before["options"].get("command") == "bench" else "verify without SPEC"
        raise InputError(f"{file} cannot be resumed: it is the record of a run of `{command}`, which begins anew")
    for name in ("schema", "hypcheck", "python"):
        _require_same(before.get(name), now[name], name, file)
    for part, free in {"options": FREE, "versions": (), "machine": ("processor", "cores"), "files": ()}.items():
        there, here = before.get(part) or {}, json.loads(json.dumps(plain(now[part])))
        for key in {**there, **here}:
            if key not in free and (part != "versions" or key in LIBRARIES):
                _require_same(there.get(key), here.get(key), _title(part, key), file)
    spoken = [line.spec for line in finished_part(record)[0] if isinstance(line, (Implementation, NotStarted))]
    _require_same(spoken, list(plan.specs[: len(spoken)]), "those that were asked to their end", file)


def resume(record: Record, file: Path, plan: GatePlan, cases: int) -> Resumed:
    """What the run of the plan goes on with, whose implementations are asked so many cases each.

    Raises InputError where the implementation that was being asked says something else of itself, or the line of
    progress cannot be read; StartError where it cannot be started.
    """
    carried, progress = finished_part(record)
    with _told_of(file):
        _require_carried(carried, plan)
    if progress is None:
        return Resumed(carried)
    begun = Progress.of_line(progress, str(file))
    if begun.number >= len(plan.specs):
        raise InputError(f"{file} cannot be resumed: it goes on with an implementation behind the last one")
    _require_same(begun.program, own_sha256(), "the sha256 of hypcheck's own files", file)
    _require_same(begun.cases, cases, "the number of cases", file)
    with plan.opening(begun.number).open() as implementation:
        declared = json.loads(json.dumps(plain(asdict(implementation.declared))))
        used = implementation.description
    for key in declared:
        title = f"the {key} that {plan.specs[begun.number]} declares"
        _require_same(begun.declared.get(key), declared[key], title, file)
    with _told_of(file):
        require_state(begun.state, steps_of(plan, used), plan, rules_of(plan, used, known_failures_of(plan)))
    return Resumed((*carried, progress), begun.state)


@contextmanager
def _told_of(file: Path) -> Iterator[None]:
    """Whatever contradicts itself in the record is an InputError that names its file."""
    try:
        yield
    except ValueError as error:
        raise InputError(f"{file} cannot be resumed: what it says cannot be: {error}") from None


def _require_carried(carried: Sequence[Line], plan: GatePlan) -> None:
    """Raise ValueError where lines about an implementation that was asked to its end cannot be true."""
    lines: list[Line] = []
    for line in carried:
        lines.append(line)
        if isinstance(line, Implementation):
            require_lines(lines, line, plan)
        if isinstance(line, (Implementation, NotStarted)):
            lines = []


def finished_part(record: Record) -> tuple[tuple[Line, ...], ProgressLine | None]:
    """The lines of implementations that were asked to their end, and the progress of the next one if it is kept.

    A record is written in order, so what stands before the last such implementation belongs to it and those before it.
    Behind it may stand lines of one that was not asked to its end: all that counts of it is the progress.
    """
    ends = [
        place
        for place, line in enumerate(record.lines)
        if isinstance(line, NotStarted) or (isinstance(line, Implementation) and line.finished is not False)
    ]
    before = record.lines[: ends[-1] + 1] if ends else ()
    kept = [line for line in record.of(ProgressLine) if line.number == len(ends)]
    return tuple(line for line in before if not isinstance(line, ProgressLine)), kept[-1] if kept else None


def _title(part: str, key: str) -> str:
    if part == "files":
        return f"the sha256 of {key}"
    return f"--{key.replace('_', '-')}" if part == "options" and key != "specs" else key


def _require_same(before: object, now: object, what: str, file: Path) -> None:
    if before != now:
        raise InputError(f"{file} cannot be resumed: {what} was {_shown(before)}, and is {_shown(now)} now")


def _shown(value: object) -> str:
    return "not there" if value is None else json.dumps(value, ensure_ascii=False)
