"""The replay of a way: what happens on it, the answer and its time, and how wrong they are; as text and as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import REFUSED, Position, trouble_with_row
from hypcheck.geometry.rows import CANNOT_SAY, PAIRS, WAYS
from hypcheck.implementations.description import Description, claimed
from hypcheck.implementations.implementation import Implementation
from hypcheck.record import plain
from hypcheck.runs import judge
from hypcheck.runs.judge import Criterion, Status
from hypcheck.runs.judges import judge_of
from hypcheck.runs.passages import LABELS, passage_of, radii_off, way_in_radii
from hypcheck.runs.replay import REPEATED_ROWS, ReplayCase, ReplayJudgement, refused
from hypcheck.runs.replay_results import case_head, titled
from hypcheck.runs.score import score
from hypcheck.runs.tally import STATUSES
from hypcheck.tables.numbers import hex_of
from hypcheck.truth import passage_error
from hypcheck.truth.swept import Passage
from hypcheck.vectors.families import is_extreme


@dataclass(frozen=True, slots=True)
class WayReplay:
    """The result of a replay; `truth` is None for an invalid row.

    `time` is that of the answer, if it has one, and `radii` how far off it is.
    """

    case: ReplayCase
    spec: str
    declared: Description
    used: Description
    criterion: Criterion
    truth: Passage | None
    judgement: ReplayJudgement
    time: float | None = None
    radii: float = 0.0
    skipped: str | None = None


def replay_way(case: ReplayCase, implementation: Implementation, criterion: Criterion) -> WayReplay:
    """Ask and judge. Raises InputError if the row is no way, or leans and the implementation takes no axis.

    An invalid row is asked if it is one of the frozen ones, and the implementation promises to refuse such rows.
    """
    declared, used = implementation.declared, implementation.description
    row = case.row
    if case.layout is PAIRS or len(row) not in (len(WAYS.upright), len(WAYS.tilted)):
        raise InputError(f"{case.name} is no way between two positions, and {used.name} answers {used.question!r}")
    trouble = trouble_with_row(row, WAYS.upright)
    if trouble is not None and case.layout is None:
        raise InputError(f"{case.name}: {trouble}")
    if len(row) == len(WAYS.tilted) and not used.tilt:
        raise InputError(f'{case.name} has an axis, but {used.name} takes none; its description must say "tilt": true')
    known = (case, str(implementation.spec), declared, used, criterion)
    if trouble is not None:
        return WayReplay(*known, None, refused(case, implementation))
    judgement, time = _judged(implementation, row, criterion)
    radii = 0.0 if time is None or not passage_of(row).hit else radii_off(row, time)
    rows = np.array([row])
    inside = claimed(rows, used.domain, criterion.precision, extreme=is_extreme(case.name), layout=WAYS)
    outside = "the row lies outside the implementation's domain, or its precision cannot hold it"
    return WayReplay(*known, passage_of(row), judgement, time, radii, None if len(inside) else outside)


def _judged(
    implementation: Implementation, row: tuple[float, ...], criterion: Criterion
) -> tuple[ReplayJudgement, float | None]:
    """The judged answer to the row alone, and its time; NONDETERMINISTIC if it changes in a batch of many copies."""
    asked, rows = judge_of("passage"), np.array([row])
    scored = score(rows, asked.truth(rows), implementation.classify(rows, batch=1), criterion)
    answer, time = int(scored.answers[0]), None if scored.times is None else float(scored.times[0])
    time = time if answer == 1 else None
    if not scored.answered[0]:
        return ReplayJudgement(STATUSES[scored.status[0]], None, scored.reasons.get(0, "")), None
    found = ReplayJudgement(STATUSES[scored.status[0]], answer)
    for case in scored.judged():
        error = asked.measured(case, criterion)
        in_units = judge.in_units(error, criterion.unit)
        found = ReplayJudgement(case.status, answer, mistake=case.mistake, error=error, error_u=in_units)
    again = implementation.classify(np.repeat(rows, REPEATED_ROWS, axis=0), batch=REPEATED_ROWS)
    if (~again.answered | (again.answers != answer)).any():
        reason = f"answers {answer} when asked alone, and otherwise when asked {REPEATED_ROWS} times at once"
        return ReplayJudgement(Status.NONDETERMINISTIC, answer, reason, found.mistake, found.error, found.error_u), time
    return found, time


def way_replay_as_json(done: WayReplay) -> str:
    """The object on one line; numbers that JSON cannot express are texts."""
    truth, judgement = done.truth, done.judgement
    told: dict[str, Any] = {
        "case": done.case.name,
        "row": done.case.row,
        "row_hex": [hex_of(value) for value in done.case.row],
        "truth": None if truth is None else _told(truth),
        "spec": done.spec,
        "declared": {"name": done.declared.name, "question": done.declared.question},
        "used": {"name": done.used.name, "question": done.used.question},
        "tolerance_u": float(done.criterion.tolerance),
        "status": judgement.status.value,
        "answer": judgement.answer,
        "time": done.time,
        "radii_off": done.radii,
        "reason": judgement.reason,
        "mistake": None if judgement.mistake is None else judgement.mistake.value,
        "backward_error": judgement.error,
        "backward_error_u": judgement.error_u,
        "skipped": done.skipped,
    }
    return json.dumps(plain(told), allow_nan=False)


def _told(truth: Passage) -> dict[str, Any]:
    return {
        "hit": truth.hit,
        "first": [truth.first_lower, truth.first_upper] if truth.hit else None,
        "grazes": truth.grazes,
        "start": Position(truth.start).label,
        "end": Position(truth.end).label,
    }


def way_replay_lines(done: WayReplay) -> Iterator[str]:
    """The whole replay, line by line."""
    judgement = done.judgement
    yield from case_head(done.case, WAYS.columns(len(done.case.row)))
    yield from _truth(done)
    yield ""
    yield from titled("asked", f"{done.used.name} ({done.spec}): {done.used.question}, {done.used.precision}")
    if judgement.answer is not None:
        yield from titled("answer", _answer(judgement.answer, done.time))
    yield from titled("judged", _judgement(done))
    if done.skipped is not None:
        yield from titled("note", f"verify skips this case: {done.skipped}")


def _truth(done: WayReplay) -> Iterator[str]:
    truth = done.truth
    if truth is None:
        columns = ", ".join(done.case.at_fault)
        yield from titled("truth", f"invalid row ({columns}), which must be refused with {REFUSED}")
        return
    yield from titled("length", f"{way_in_radii(done.case.row):.6g} spheroid radii")
    yield from titled("truth", LABELS[int(truth.hit)] + (", only touched for an instant" if truth.grazes else ""))
    yield from titled("ends", f"{Position(truth.start).label} at the start, {Position(truth.end).label} at the end")
    if truth.hit:
        yield from titled("first", f"contact between the times {truth.first_lower!r} and {truth.first_upper!r}")


def _answer(answer: int, time: float | None) -> str:
    said = {CANNOT_SAY: "cannot say", REFUSED: "refused", **LABELS}.get(answer, "")
    return f"{answer}, {said}" + ("" if time is None else f", first at {time!r}")


def _judgement(done: WayReplay) -> str:
    """The status, and how wrong the answer is: by the size, or by the way between its time and the first contact."""
    judgement, parts = done.judgement, [done.judgement.status.value]
    if judgement.mistake is not None and done.radii and done.truth is not None and done.truth.hit:
        parts.append(f"{judgement.mistake.value} by {done.radii:.4g} spheroid radii of the way")
    elif judgement.mistake is not None:
        error = passage_error.tolerance(done.case.row, done.criterion.tolerance, done.criterion.unit)
        parts.append(
            f"a {judgement.mistake.value}: b and d would have to change by {judgement.error:.4g} of themselves "
            f"(tolerated: {float(error):.4g})"
        )
    return "; ".join([*parts, *([judgement.reason] if judgement.reason else [])])
