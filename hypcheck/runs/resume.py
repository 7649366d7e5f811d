"""`--resume`: write the progress of a run as a line of its record, and restore the state of a run from such a line.

Only a run with the same options, files and versions may be resumed.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, astuple, dataclass
from datetime import datetime, timezone
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from msgspec import UNSET, structs
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.implementations.description import Description
from hypcheck.implementations.session import Allowance, Outcome
from hypcheck.record import Record, Recorder, RecordLine, plain
from hypcheck.record.fields import as_json, decoded
from hypcheck.record.lines import DescriptionPart, HeaderLine, ImplementationLine, NotStartedLine
from hypcheck.record.progress import PendingCases, ProgressLine, SavedAllowance, SavedResult, SavedState
from hypcheck.record.writer import Provenance, header
from hypcheck.runs.cases import PACE, CaseChunk, Pace
from hypcheck.runs.consistency import require_lines, require_state
from hypcheck.runs.fingerprint import code_fingerprint
from hypcheck.runs.plan import ConformancePlan, rules_of, steps_of
from hypcheck.runs.results import CasesResult, PendingRetest
from hypcheck.runs.schedule import RunState

FREE_OPTIONS = ("workers", "cluster")
"""Options that may differ, because the result does not depend on them."""

LIBRARIES = ("numpy", "mpmath", "sympy")
"""Libraries whose version a result may depend on."""

Json = dict[str, Any]


def recorded_description(description: Description) -> DescriptionPart:
    """Return an implementation's description as the record has it."""
    content = asdict(description)
    for name in ("tilt", "times", "heights"):
        if not content[name]:  # older records lack this key
            del content[name]
    for setting in content["domain"]["settings"]:
        if setting["axis"] is None:
            del setting["axis"]
    return decoded(content, DescriptionPart)


class ProgressWriter:
    """Writes the progress of one implementation, number `number` of the run with `cases` cases, into the record."""

    def __init__(self, recorder: Recorder, number: int, declared: Description, cases: int, pace: Pace = PACE) -> None:
        self._recorder, self._pace = recorder, pace
        self._number, self._declared, self._cases = number, recorded_description(declared), cases
        self._due = time.monotonic() + pace.progress_s

    def offer(self, state: RunState) -> None:
        """Write the state if enough time has passed since it was last written."""
        if time.monotonic() >= self._due:
            began = time.monotonic()
            self.keep(state)
            now = time.monotonic()
            self._due = now + max(self._pace.progress_s, self._pace.progress_share * (now - began))

    def keep(self, state: RunState) -> None:
        """Write the state. Raises OSError if it cannot be written, and leaves the record as it was."""
        self._recorder.keep(
            ProgressLine(
                number=self._number,
                declared=self._declared,
                cases=self._cases,
                state=saved_state(state),
                program=code_fingerprint(),
            )
        )


@dataclass(frozen=True)
class ResumedRun:
    """The part of a run that its record holds: the lines to keep, and the state of the next implementation.

    The lines are those of finished implementations, and the progress line of the next one if there is one. Without a
    progress line the state is None, and the implementation is tested from its first case.
    """

    carried: tuple[RecordLine, ...] = ()
    state: RunState | None = None

    def done(self, cases: int) -> int:
        """Return the number of tested cases, if each implementation has `cases` cases."""
        finished = [line for line in self.carried if isinstance(line, (ImplementationLine, NotStartedLine))]
        return len(finished) * cases + (self.state.total.cases if self.state else 0)


def require_same_run(
    record: Record, file: Path, plan: ConformancePlan, options: Mapping[str, Any], files: Mapping[str, str]
) -> None:
    """Raise InputError, naming the difference, if the record in `file` is not of a run with the same options and files.

    `options` are the options of this run; `files` holds the sha256 of the files that its SPECs name.
    """
    before, now = record.header, header(options, datetime.now(timezone.utc), Provenance(files))
    if not {"specs", "max_abstained"} <= before.options.keys():
        command = "bench" if before.options.get("command") == "bench" else "verify without SPEC"
        raise InputError(
            f"{file} cannot be resumed: it is the record of a run of `{command}`, which always begins from its start"
        )
    there, here = _compared(before), _compared(now)
    for what in {**there, **here}:
        _require_same(there.get(what), here.get(what), what, file)
    ended = [line.spec for line in finished_part(record)[0] if isinstance(line, (ImplementationLine, NotStartedLine))]
    _require_same(ended, list(plan.specs[: len(ended)]), "the list of finished implementations", file)


def resume(record: Record, file: Path, plan: ConformancePlan, cases: int) -> ResumedRun:
    """Return the part of the run that the record holds, from which it continues. Each implementation has `cases` cases.

    Raises InputError if the unfinished implementation has another description now, or the record contradicts itself;
    StartError if the implementation does not start.
    """
    carried, begun = finished_part(record)
    with _contradictions_of(file):
        _require_carried(carried, plan)
    if begun is None:
        return ResumedRun(carried)
    if begun.number >= len(plan.specs):
        raise InputError(f"{file} cannot be resumed: its progress is of an implementation after the last one")
    _require_same(begun.program, code_fingerprint(), "the sha256 of hypcheck's own files", file)
    _require_same(begun.cases, cases, "the number of cases", file)
    with plan.opener(begun.number).open() as implementation:
        before, now = as_json(begun.declared), as_json(recorded_description(implementation.declared))
        used = implementation.description
    for key in {**before, **now}:
        _require_same(before.get(key), now.get(key), f"the {key} that {plan.specs[begun.number]} declares", file)
    with _contradictions_of(file):
        state = restored_state(begun.state)
        require_state(state, steps_of(plan, used), plan, rules_of(plan, used))
    return ResumedRun((*carried, begun), state)


@contextmanager
def _contradictions_of(file: Path) -> Iterator[None]:
    """Turn a ValueError about a contradiction in the record into an InputError that names the file."""
    try:
        yield
    except ValueError as error:
        raise InputError(f"{file} cannot be resumed: it contradicts itself: {error}") from None


def _require_carried(carried: Sequence[RecordLine], plan: ConformancePlan) -> None:
    """Raise ValueError if the lines about a finished implementation contradict each other or the plan."""
    about: list[RecordLine] = []
    for line in carried:
        about.append(line)
        if isinstance(line, ImplementationLine):
            require_lines(about, line, plan)
        if isinstance(line, (ImplementationLine, NotStartedLine)):
            about = []


def finished_part(record: Record) -> tuple[tuple[RecordLine, ...], ProgressLine | None]:
    """Return the lines of finished implementations, and the last progress line of the next one, if there is one.

    A record is written in order, so all lines up to the end of the last finished implementation belong to finished
    ones. Lines of an unfinished implementation may follow; of these only the progress counts.
    """
    ends = [
        place
        for place, line in enumerate(record.lines)
        if isinstance(line, NotStartedLine) or (isinstance(line, ImplementationLine) and line.finished is not False)
    ]
    before = record.lines[: ends[-1] + 1] if ends else ()
    progress = [line for line in record.of(ProgressLine) if line.number == len(ends)]
    return tuple(line for line in before if not isinstance(line, ProgressLine)), progress[-1] if progress else None


def _compared(header: HeaderLine) -> Json:
    """Return the values of a header that must be equal in a resumed run, by their names in messages."""
    options = {name: value for name, value in plain(header.options).items() if name not in FREE_OPTIONS}
    return {
        **{name: getattr(header, name) for name in ("schema", "hypcheck", "python")},
        **{name if name == "specs" else f"--{name.replace('_', '-')}": value for name, value in options.items()},
        **{library: header.versions.get(library) for library in LIBRARIES},
        "system": header.machine.system,
        "architecture": header.machine.architecture,
        **{f"the sha256 of {path}": digest for path, digest in (header.files or {}).items()},
    }


def _require_same(before: object, now: object, what: str, file: Path) -> None:
    """Raise InputError if a value was another one when the run began."""
    if before != now:
        raise InputError(f"{file} cannot be resumed: {what} was {_shown(before)}, and is {_shown(now)} now")


def _shown(value: object) -> str:
    """Return a value as text for a message."""
    return "missing" if value is None else json.dumps(value, ensure_ascii=False)


def saved_state(state: RunState) -> SavedState:
    """Return the state in the form of a progress line."""
    left = state.left
    allowance = SavedAllowance(restarts=left.restarts, faults=left.faults, over=left.over, hangs=left.hangs)
    return SavedState(done=state.done, left=allowance, total=saved_result(state.total))


def restored_state(content: SavedState) -> RunState:
    """Restore the state from a line of progress. Raises ValueError if some pending cases do not have one answer each.

    No array is larger than the data that was read. consistency.require_state checks whether the numbers agree.
    """
    return RunState(Allowance(**structs.asdict(content.left)), content.done, restored_result(content.total))


def saved_result(result: CasesResult) -> SavedResult:
    """Return the result in the form of a progress line."""
    return SavedResult(
        tallies=dict(result.tallies),
        pending=[_saved_pending(pending) for pending in result.pending],
        retest=result.retest,
        outcomes=sorted(outcome.label for outcome in result.outcomes),
        excusing=sorted(result.excusing),
        named=sorted(result.named),
    )


def restored_result(content: SavedResult) -> CasesResult:
    """Return the result in a line of progress. Raises as restored_state does."""
    return CasesResult(
        tallies=content.tallies,
        pending=tuple(map(_restored_pending, content.pending)),
        retest=content.retest,
        outcomes=frozenset(outcome for outcome in Outcome if outcome.label in content.outcomes),
        excusing=frozenset(content.excusing),
        named=frozenset(content.named),
    )


def _saved_pending(pending: PendingRetest) -> PendingCases:
    """Return pending cases in the form of a progress line."""
    return PendingCases(
        chunk=astuple(pending.chunk),
        indices=_runs(pending.indices),
        answers=pending.answers.tobytes().hex(),
        times=UNSET if pending.times is None else pending.times.astype("<f8").tobytes().hex(),
    )


def _restored_pending(content: PendingCases) -> PendingRetest:
    """Return pending cases; their indices are made only if there are as many answers."""
    chunk = CaseChunk(*content.chunk)
    answers = np.frombuffer(bytes.fromhex(content.answers), dtype=np.int8)
    ends = [0, *chain.from_iterable(content.indices), len(chunk)]
    ascending = ends == sorted(ends) and all(first < last for first, last in content.indices)
    if not content.indices or not ascending or sum(last - first for first, last in content.indices) != len(answers):
        raise ValueError(f"{chunk.family} has {len(answers)} answers, which do not match its pending cases")
    times = None if content.times is UNSET else np.frombuffer(bytes.fromhex(content.times), dtype="<f8")
    if times is not None and len(times) != len(answers):
        raise ValueError(f"{chunk.family} has {len(times)} times for {len(answers)} answers")
    return PendingRetest(chunk, np.concatenate([np.arange(*run) for run in content.indices]), answers, times)


def _runs(indices: NDArray[np.intp]) -> list[tuple[int, int]]:
    """Divide ascending indices into ranges [first, last + 1)."""
    breaks = np.flatnonzero(np.diff(indices) != 1) + 1
    return [(int(part[0]), int(part[-1]) + 1) for part in np.split(indices, breaks)]
