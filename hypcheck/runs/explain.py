"""The explanation of a cause of wrong answers: what it is, why, its symptoms, its remedy, and an example row.

The row is a frozen vector, the shortest one of the first family that shows the cause. Its truth is proved; the wrong
answer is the answer of the cause's rule at this row. For causes about rounding it is an answer that roundings of
float64 can give.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.rows import Floats, Mask, Row
from hypcheck.implementations.description import QUESTIONS
from hypcheck.messages import suggestion
from hypcheck.runs import judge
from hypcheck.runs.causes import AnsweredRows, Cause, Scope
from hypcheck.runs.diagnosis import CAUSES
from hypcheck.runs.judge import Criterion
from hypcheck.tables.numbers import decimals_of
from hypcheck.truth.passage_error import passage_of
from hypcheck.vectors.families import is_extreme
from hypcheck.vectors.frozen import NAMES, SWEEP_NAMES, TILTED_NAMES, load

BY_ID: Mapping[str, Cause] = {cause.name: cause for cause in CAUSES}

_FIRST = {
    "upright": ("small-integers", "ring", "out-of-regime", "coefficient-zero", "tangent", "degenerate-crossing"),
    "tilted": ("tilted-small-integers",),
    "way": ("way-small-integers",),
}
"""The families that are searched first for a row of a cause, by the cause's subject: their rows are short."""

_ROUNDING_FIRST = ("near-tangent-outside", "near-tangent-inside", "ring-neighbourhood", "near-axis")
"""The families that are searched first for causes about rounding. Short rows seldom show these: their floats are
exact."""

_NAMES = {"upright": NAMES, "tilted": TILTED_NAMES, "way": SWEEP_NAMES}

_PRECISIONS = {"float64-for-more": "binary128"}
"""The precision in which a cause is shown, if that is not float64."""

_SHOWN_BY = {"out-of-range": "extreme-float64"}
"""The family that was made to show a cause; it is searched first."""

_SWEEPS = 40
"""The number of sweeps of a family that are searched for a row: to decide one takes milliseconds."""

_ABOUT = {
    "upright": "upright spheroids",
    "tilted": "tilted spheroids",
    "way": "the sweep between two positions",
}

_SHOWN = {
    Scope.PLACE: "at rows of one kind: elsewhere its answers are right",
    Scope.ROUNDING: "where roundings decide: the same code is right in exact arithmetic",
    Scope.EVERYWHERE: "at every row where it makes a difference: most wrong answers of a run have this cause then",
}


@dataclass(frozen=True, slots=True)
class Witness:
    """A row with its case id, its truth, and the wrong answer of a cause there, with a time if it is a sweep."""

    case: str
    row: Row
    truth: int
    answer: int
    time: float | None = None


def cause_with_id(name: str) -> Cause:
    """Return the cause with this id. Raises InputError if there is none."""
    if name not in BY_ID:
        near = suggestion(name, BY_ID, otherwise="")
        hint = near if near.strip().startswith("did you mean") else "`hypcheck explain` lists all"
        raise InputError(f"there is no cause {name!r}; {hint}")
    return BY_ID[name]


def witness_of(cause: Cause) -> Witness:
    """Return a frozen vector at which the cause gives a wrong answer."""
    first: tuple[str, ...] = _ROUNDING_FIRST if cause.rounds else _FIRST[cause.subject]
    first = (_SHOWN_BY[cause.name],) if cause.name in _SHOWN_BY else first
    others = [name for name in _NAMES[cause.subject] if name not in first]
    for name in (*first, *(name for name in others if not is_extreme(name)), *filter(is_extreme, others)):
        witness = _witness_in(cause, name)
        if witness is not None:
            return witness
    raise AssertionError(f"no frozen vector shows the cause {cause.name}")  # tests explain every cause


def _witness_in(cause: Cause, name: str) -> Witness | None:
    """Return the shortest row of a family at which the cause gives a wrong answer; None if there is none."""
    vectors, sweeps = load(name), cause.subject == "way"
    count = _SWEEPS if sweeps else len(vectors.rows)
    rows, truth = vectors.rows[:count], vectors.positions[:count]
    criterion = Criterion("passage" if sweeps else "position", _PRECISIONS.get(cause.name, "float64"))
    ids = {tuple((row + 0.0).tolist()): name for row, name in zip(rows, vectors.ids, strict=False)}
    witnesses: list[Witness] = []
    for answered in _possible_answers(rows, truth, criterion):
        answers = cause.rule(answered)
        for place in np.flatnonzero((answers == answered.given) & _is_wrong(answered)).tolist():
            time = None if answered.times is None or answered.given[place] != 1 else float(answered.times[place])
            row = tuple((answered.rows[place] + 0.0).tolist())  # no −0
            witnesses.append(Witness(ids[row], row, int(answered.truth[place]), int(answers[place]), time))
    return min(witnesses, key=lambda witness: len(decimals_of(witness.row)), default=None)


def _possible_answers(rows: Floats, truth: Any, criterion: Criterion) -> Iterator[AnsweredRows]:  # noqa: ANN401 - Positions
    """Yield, for each possible answer, the rows with this answer given to all; for sweeps also with wrong times."""
    answered = AnsweredRows(np.ascontiguousarray(rows), truth, truth, criterion)
    for answer in (0, 1, -1) if criterion.question == "position" else (0, 1):
        yield replace(answered, given=np.full(len(rows), answer, dtype=np.int8))
    if criterion.layout.has_end:
        first = np.array([passage_of(tuple(row)).first_lower for row in rows.tolist()], dtype=np.float64)
        for times in (1 - first, first + 2.0**-13, first - 2.0**-13):
            within = np.flatnonzero((first > 2.0**-10) & (first < 1 - 2.0**-10))
            answers = np.ones(len(within), dtype=np.int8)
            yield replace(answered.part(within), given=answers, times=np.ascontiguousarray(times[within]))


def _is_wrong(answered: AnsweredRows) -> Mask:
    """Return a mask of the wrong answers; a right hit is wrong if its time is given and wrong."""
    wrong = np.asarray(answered.given != judge.expected(answered.truth, answered.criterion.question))
    return wrong if answered.times is None else ~wrong & (answered.given == 1)


def listed() -> Iterator[str]:
    """Yield the lines that list all causes, grouped by their subjects."""
    width = max(map(len, BY_ID))
    for subject, about in _ABOUT.items():
        yield f"{about}:"
        for cause in CAUSES:
            if cause.subject == subject:
                yield f"  {cause.name:{width}}  {cause.sentence}"
        yield ""
    yield "hypcheck explain ID shows one of them: why it is wrong, how it shows, what to do, and a row that shows it."


def explained(cause: Cause) -> dict[str, Any]:
    """Return the full explanation of a cause, for JSON."""
    return brief(cause) | {
        "why": cause.why,
        "claim": cause.claim or None,
        "recognise": _recognise(cause),
        "witness": _witness_as_json(witness_of(cause)),
    }


def brief(cause: Cause) -> dict[str, Any]:
    """Return a cause in short, as an element of the JSON list."""
    return {"id": cause.name, "about": cause.subject, "sentence": cause.sentence, "remedy": cause.remedy}


def as_json(content: Any) -> str:  # noqa: ANN401 - whatever JSON holds
    """Return the JSON text of an explanation or of a list."""
    return json.dumps(content, ensure_ascii=False, indent=2)


def explained_lines(cause: Cause) -> Iterator[str]:
    """Yield the lines of the full explanation of a cause, for the terminal."""
    shown = witness_of(cause)
    first = None if shown.time is None else passage_of(shown.row).first_lower
    yield f"{cause.name} (a cause of wrong answers about {_ABOUT[cause.subject]})"
    yield ""
    for title, text in (
        ("what", f"{cause.sentence[:1].upper()}{cause.sentence[1:]}."),
        ("why", f"{cause.why}."),
        ("paper", f"{cause.claim}; `hypcheck derive --claim {cause.claim!r}` proves what is wrong" * bool(cause.claim)),
        ("shows", f"{_recognise(cause)}."),
        ("fix", f"{cause.remedy}."),
        ("row", f"{decimals_of(shown.row)}  ({shown.case})"),
        ("", f"{', '.join(_columns(shown.row, cause))}"),
        ("right", _answer_text(shown.truth, first)),
        ("wrong", _answer_text(shown.answer, shown.time)),
        ("look", f"hypcheck replay {shown.case} SPEC"),
    ):
        if text:
            yield f"{title:8}{text}"


def _recognise(cause: Cause) -> str:
    """Return the sentence about the place of wrong answers of this cause."""
    return f"wrong answers lie {_SHOWN[cause.scope]}"


def _answer_text(answer: int, time: float | None) -> str:
    text = f"{answer:+d}" if answer else "0"
    return text if time is None else f"{text}, first at {time!r}"


def _columns(row: Row, cause: Cause) -> tuple[str, ...]:
    """Return the names of the row's columns."""
    question = "passage" if cause.subject == "way" else "position"
    return tuple(QUESTIONS[question].layout.columns(len(row)))


def _witness_as_json(shown: Witness) -> dict[str, Any]:
    times = {} if shown.time is None else {"time": shown.time}
    row = {"row": list(shown.row), "hex": [value.hex() for value in shown.row]}
    return {"case": shown.case, **row, "truth": shown.truth, "answer": shown.answer, **times}
