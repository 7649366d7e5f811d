"""`--resume`: how far a run is, as a line of the record that it keeps, and back to what a run goes on from.

In a state as JSON, numbers that must come back exactly are hexadecimal; infinities are the strings that float() reads.
A run goes on from a record only if it is the same run.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, astuple, dataclass
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.bins import Bins
from hypcheck.errors import InputError
from hypcheck.gate.chunks import Chunk
from hypcheck.gate.consistency import require_lines, require_state
from hypcheck.gate.ourselves import own_sha256
from hypcheck.gate.plan import GatePlan, known_failures_of, rules_of, steps_of
from hypcheck.gate.results import Again, Open, Result
from hypcheck.gate.schedule import State
from hypcheck.methods.faults import Outcome
from hypcheck.methods.runs import Allowance
from hypcheck.pairs import COLUMNS
from hypcheck.record import Line, Record, Recorder, lines, plain
from hypcheck.record.fields import FARTHEST, as_json
from hypcheck.record.lines import Implementation, NotStarted
from hypcheck.record.writer import header
from hypcheck.tally import Fault, Tally, Worst
from hypcheck.visible import shortened

EVERY = 10.0
"""Seconds between two lines of progress, at least: what a killed run may lose."""

SHARE = 100
"""Of the time of a run, what keeping its progress may take: one part of so many."""

FREE = ("workers", "cluster")
"""Options that may differ: the result is the same with any."""

LIBRARIES = ("numpy", "mpmath", "sympy")
"""Those whose versions a result may depend on."""

Json = dict[str, Any]


@dataclass(frozen=True)
class Progress:
    """What a line of progress says.

    `number` is the place, from 0, of the implementation that is asked among those of the plan, `declared` what it says
    of itself, and `cases` how many it is asked in all. `program` is the sha256 of our own files: what a step is, and so
    what a number of them comes to, may change between two commits.
    """

    number: int
    declared: Mapping[str, Any]
    cases: int
    state: State
    program: str | None

    @classmethod
    def of_line(cls, line: lines.Progress, name: str) -> Progress:
        """What the line of a record says. Raises InputError naming the record where it cannot be read."""
        try:
            return cls(line.number, as_json(line.declared), line.cases, restored(line.state), line.program)
        except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
            raise InputError(f"{name}: its line of progress says nothing to go on from: {error!r}") from None


class Keeper:
    """Keeps in a record how far one implementation has been asked; `about` are the fields of the line but its state."""

    def __init__(self, recorder: Recorder, **about: Any) -> None:  # noqa: ANN401  whatever the line holds
        self.recorder = recorder
        self._about = about
        self._due = time.monotonic() + EVERY

    def offer(self, state: State) -> None:
        """Keep the state if it is time to."""
        if time.monotonic() >= self._due:
            began = time.monotonic()
            self.keep(state)
            now = time.monotonic()
            self._due = now + max(EVERY, SHARE * (now - began))

    def keep(self, state: State) -> None:
        """Keep the state. Raises OSError where it cannot be written; the record is then as it was."""
        self.recorder.keep(lines.Progress(**self._about, state=plain(saved(state)), program=own_sha256()))


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
    about: list[Line] = []
    for line in carried:
        about.append(line)
        if isinstance(line, Implementation):
            require_lines(about, line, plan)
        if isinstance(line, (Implementation, NotStarted)):
            about = []


def finished_part(record: Record) -> tuple[tuple[Line, ...], lines.Progress | None]:
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
    kept = [line for line in record.of(lines.Progress) if line.number == len(ends)]
    return tuple(line for line in before if not isinstance(line, lines.Progress)), kept[-1] if kept else None


def _title(part: str, key: str) -> str:
    if part == "files":
        return f"the sha256 of {key}"
    return f"--{key.replace('_', '-')}" if part == "options" and key != "specs" else key


def _require_same(before: object, now: object, what: str, file: Path) -> None:
    if before != now:
        raise InputError(f"{file} cannot be resumed: {what} was {_shown(before)}, and is {_shown(now)} now")


def _shown(value: object) -> str:
    return "not there" if value is None else json.dumps(value, ensure_ascii=False)


def saved(state: State) -> Json:
    """The state as a mapping that JSON can hold."""
    left = {name: getattr(state.left, name) for name in ("restarts", "faults", "over", "hangs")}
    return {"done": state.done, "left": left, "total": saved_result(state.total)}


def restored(content: Json) -> State:
    """The state of such a mapping. Raises ValueError, KeyError, TypeError or AttributeError where it is none.

    Nothing is made larger than what was read; whether the numbers agree is for consistency.require_state to say.
    """
    left = Allowance(**content["left"])
    hangs = 0 if left.hangs is None else left.hangs
    _whole(left.restarts), _whole(left.faults), _whole(hangs), _text(left.over)
    return State(left, _whole(content["done"]), restored_result(content["total"]))


def saved_result(result: Result) -> Json:
    """A result as a mapping that JSON can hold."""
    return {
        "tallies": {family: _saved_tally(tally) for family, tally in result.tallies.items()},
        "open": [
            {"chunk": astuple(each.chunk), "indices": _runs(each.indices), "answers": each.answers.tobytes().hex()}
            for each in result.open
        ],
        "again": asdict(result.again),
        "outcomes": sorted(outcome.label for outcome in result.outcomes),
        "excusing": sorted(result.excusing),
        "named": sorted(result.named),
    }


def restored_result(content: Json) -> Result:
    """The result of such a mapping. Raises as restored does."""
    return Result(
        tallies={_text(family): _restored_tally(tally) for family, tally in content["tallies"].items()},
        open=tuple(map(_restored_open, content["open"])),
        again=Again(**{name: _whole(number) for name, number in content["again"].items()}),
        outcomes=frozenset(Outcome[name.upper().replace("-", "_")] for name in content["outcomes"]),
        excusing=frozenset(map(_whole, content["excusing"])),
        named=frozenset(map(_text, content["named"])),
    )


def _restored_open(content: Json) -> Open:
    """Open cases; their indices are made only where there are as many answers."""
    family, seed, *numbers = content["chunk"]
    chunk = Chunk(_text(family), None if seed is None else _whole(seed), *map(_whole, numbers))
    answers = np.frombuffer(bytes.fromhex(content["answers"]), dtype=np.int8)
    runs = [(_whole(first), _whole(last)) for first, last in content["indices"]]
    ends = [0, *(end for run in runs for end in run), len(chunk)]
    ascending = ends == sorted(ends) and all(first < last for first, last in runs)
    if not runs or not ascending or sum(last - first for first, last in runs) != len(answers):
        raise ValueError(f"{len(answers)} answers of {family} are not to its open cases")
    return Open(chunk, np.concatenate([np.arange(*run) for run in runs]), answers)


def _saved_tally(tally: Tally) -> Json:
    cases = {
        name: [plain({**asdict(case), "row": [value.hex() for value in case.row]}) for case in getattr(tally, name)]
        for name in ("worst", "faults")
    }
    found = {name: getattr(tally, name).as_lists() for name in ("size_bins", "place_bins")}
    counts = {name: getattr(tally, name) for name in ("asked", "counts", "mistakes", "dangerous", "octaves")}
    return {**plain(counts), **found, **cases}


def _restored_tally(content: Json) -> Tally:
    return Tally(
        asked=_whole(content["asked"]),
        counts=_counts(content["counts"]),
        mistakes=_counts(content["mistakes"]),
        dangerous=_whole(content["dangerous"]),
        octaves={str(_octave(octave)): _counts(counts) for octave, counts in content["octaves"].items()},
        size_bins=_bins(content["size_bins"]),
        place_bins=_bins(content["place_bins"]),
        worst=tuple(Worst(**{**_case(case), **_wrong(case)}) for case in content["worst"]),
        faults=tuple(Fault(**{**_case(case), "reason": _text(case["reason"])}) for case in content["faults"]),
    )


def _case(content: Json) -> Json:
    row = tuple(map(float.fromhex, content["row"]))
    place = tuple(map(_whole, content["place"]))
    if len(row) != len(COLUMNS) or len(place) != 2:  # (0 or 1, n): a Place
        raise ValueError(f"a case has {len(row)} numbers and its place {len(place)}")
    texts = {name: _text(content[name]) for name in ("case", "status")}
    return {**content, **texts, "place": place, "row": row}


def _wrong(content: Json) -> Json:
    answers = {name: _whole(content[name], -128, 127) for name in ("truth", "answer")}  # int8
    return {**answers, "mistake": _text(content["mistake"]), "error": _error(content["error"])}


_MOST = 1 << 60
"""No count is larger: one of a run is at most whole.LARGEST_COUNT times the number of families, and fits into int64."""


def _whole(value: object, least: int = 0, most: int = _MOST) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise ValueError(f"{shortened(str(value), 40)} is no whole number from {least} to {most}")
    return value


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{shortened(str(value), 40)} is no text")  # noqa: TRY004 - told as every other damage
    return value


def _error(value: object) -> float:
    error = float(value) if isinstance(value, (int, float, str)) else math.nan
    if not error >= 0:
        raise ValueError(f"{shortened(str(value), 40)} is no backward error")
    return error


def _octave(text: str) -> str:
    if text not in ("inf", "-inf"):
        _whole(int(text), -FARTHEST, FARTHEST)
    return text


def _counts(content: Mapping[str, object]) -> dict[str, int]:
    return {_text(name): _whole(number) for name, number in content.items()}


def _bins(content: list[list[object]]) -> Bins:
    rows = [
        [_whole(first, -FARTHEST, FARTHEST), _whole(second, -FARTHEST, FARTHEST), _whole(cases), _whole(amiss)]
        for first, second, cases, amiss in content
    ]
    return Bins.of_lists(rows)


def _runs(indices: NDArray[np.intp]) -> list[tuple[int, int]]:
    """Ascending indices as stretches [first, last + 1)."""
    breaks = np.flatnonzero(np.diff(indices) != 1) + 1
    return [(int(part[0]), int(part[-1]) + 1) for part in np.split(indices, breaks)]
