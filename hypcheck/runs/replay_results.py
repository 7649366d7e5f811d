"""The result of a replay as text at a terminal, and as one JSON object for a program."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import Any

from hypcheck.answer import kind_as_text
from hypcheck.geometry.pair import REFUSED, Pair, Position
from hypcheck.geometry.rows import CANNOT_SAY, Row
from hypcheck.implementations.description import Description
from hypcheck.proof_text import proof_as_json, proof_lines
from hypcheck.record import plain
from hypcheck.runs.causes import Cause
from hypcheck.runs.intermediates import FormulaChoice, FormulaComparison, Intermediate, number_text
from hypcheck.runs.replay import ProvedTruth, Replay
from hypcheck.tables.numbers import hex_of
from hypcheck.truth import passage_error
from hypcheck.truth.passage_error import SWEEP_ANSWERS, sweep_in_radii
from hypcheck.truth.swept import Passage

DIGITS = 17
"""Digits of the numbers in the JSON table of values. They are texts, because exact ones need not fit float64."""


def replay_as_json(replay: Replay) -> str:
    """Return a replay as one JSON object on one line; numbers that JSON cannot express are "inf", "-inf" and "nan".

    For a sweep it has the time of the answer in place of causes and values of a formula.
    """
    judgement = replay.judgement
    more: dict[str, Any] = {"time": judgement.time, "radii_off": judgement.radii}
    if not replay.used.asked.layout.has_end:
        causes = [_cause_json(cause, replay.used.language) for cause in replay.causes]
        more = {"causes": causes, "values": None if replay.choice is None else _choice_json(replay.choice)}
    return json.dumps(
        plain(
            {
                "case": replay.case.name,
                "row": replay.case.row,
                "row_hex": [hex_of(value) for value in replay.case.row],
                "truth": None if replay.truth is None else _truth_json(replay.truth),
                "spec": replay.spec,
                "declared": _claims_json(replay.declared),
                "used": _claims_json(replay.used),
                "tolerance_u": float(replay.criterion.tolerance),
                "status": judgement.status.value,
                "answer": judgement.answer,
                "reason": judgement.reason,
                "mistake": None if judgement.mistake is None else judgement.mistake.value,
                "backward_error": judgement.error,
                "backward_error_u": judgement.error_u,
                "skipped": replay.skipped,
                **more,
            }
        ),
        allow_nan=False,
    )


def _cause_json(cause: Cause, language: str) -> dict[str, Any]:
    remedy = cause.remedy_in(language)
    return {"cause": cause.name, "sentence": cause.sentence, "remedy": remedy, "claim": cause.claim or None}


def _truth_json(truth: ProvedTruth | Passage) -> dict[str, Any]:
    if isinstance(truth, Passage):
        return {
            "hit": truth.hit,
            "first": [truth.first_lower, truth.first_upper] if truth.hit else None,
            "grazes": truth.grazes,
            "start": truth.start.label,
            "end": truth.end.label,
        }
    decision = truth.decision
    return {
        "position": int(decision.position),
        "label": decision.position.label,
        "tangent": decision.tangent,
        "kind": None if truth.kind is None else truth.kind.value,
        "flips": {position.label: distance for position, distance in truth.flips.items()},
        "proof": proof_as_json(truth.pair, truth.certificate),
    }


def _claims_json(description: Description) -> dict[str, Any]:
    """Return the name, question and precision of an implementation, for JSON."""
    return {"name": description.name, "question": description.question, "precision": description.precision}


def _choice_json(choice: FormulaChoice) -> dict[str, Any]:
    """Return the values of a formula on the row, for JSON."""
    compared, content = choice.comparison, {"why": choice.why, "own": choice.own}
    if compared is None:
        return content
    return {
        **content,
        "formula": compared.formula.name,
        "question": compared.formula.question,
        "format": compared.format,
        "answer": compared.answer,
        "exact_answer": compared.exact_answer,
        "first_wrong": compared.first_wrong,
        "culprit": compared.culprit,
        "table": [_value(value) for value in compared.values.values()],
    }


def _value(intermediate: Intermediate) -> dict[str, Any]:
    """Return one value of a formula, for JSON."""
    return {
        "name": intermediate.name,
        "operation": intermediate.operation,
        "value": intermediate.value
        if isinstance(intermediate.value, bool)
        else number_text(intermediate.value, DIGITS),
        "exact": intermediate.exact
        if isinstance(intermediate.exact, bool)
        else number_text(intermediate.exact, DIGITS),
        "error_u": intermediate.error_u,
    }


_LABEL = 12
_FIRST, _CULPRIT, _OTHER = ">>", " >", " !"


def replay_lines(
    replay: Replay, ledger: Callable[[str], tuple[str, str, str]], *, values: bool = True
) -> Iterator[str]:
    """Yield the whole replay, line by line; without `values`, only a formula that SPEC itself evaluates is shown.

    `ledger` gives the verdict on a claim of the paper, the claim in words, and its correction, by the claim's number.
    """
    case = replay.case
    yield from _titled("case", case.name)
    for name, value in zip(replay.used.asked.layout.columns(len(case.row)), case.row, strict=True):
        yield f"{name:{_LABEL}}{repr(value).removesuffix('.0'):24}{hex_of(value)}"
    if replay.truth is None:
        yield from _titled(
            "truth", f"invalid row ({' and '.join(case.at_fault)}), which must be refused with {REFUSED}"
        )
    elif isinstance(replay.truth, Passage):
        yield from _sweep_lines(replay.truth, case.row)
    else:
        yield from _truth_lines(replay.truth)
    yield ""
    yield from _judgement_lines(replay)
    for cause in replay.causes:
        yield from _cause_lines(cause, replay.used.language, ledger)
    if replay.choice is not None and isinstance(replay.truth, ProvedTruth):
        yield ""
        if values or replay.choice.own or replay.choice.comparison is None:
            yield from _choice_lines(replay.choice, replay.truth.decision.position, replay.used.name)
        else:
            yield from _titled(
                "values", f"--values shows those of {replay.choice.comparison.formula.name}, {replay.choice.why}"
            )


def _sweep_lines(truth: Passage, row: Row) -> Iterator[str]:
    yield from _titled("length", f"{sweep_in_radii(row):.6g} spheroid radii")
    yield from _titled(
        "truth", SWEEP_ANSWERS[int(truth.hit)] + (", only touched for an instant" if truth.grazes else "")
    )
    yield from _titled("ends", f"{truth.start.label} at the start, {truth.end.label} at the end")
    if truth.hit:
        yield from _titled("first", f"contact between the times {truth.first_lower!r} and {truth.first_upper!r}")


def _truth_lines(truth: ProvedTruth) -> Iterator[str]:
    decision = truth.decision
    yield from _titled("truth", f"{decision.position.label}{', tangent' if decision.tangent else ''}")
    if truth.kind is not None:
        yield from _titled("kind", kind_as_text(truth.kind))
    if truth.pair.is_upright:
        yield from _titled("regime", _regime(truth.pair))
    for position, distance in truth.flips.items():
        yield from _titled("flips", f"to {position.label} {_change(distance)}")
    yield from _titled("proof", *proof_lines(truth.pair, truth.certificate))


def _regime(pair: Pair) -> str:
    """Return a sentence about the conditions of Propositions 3 and 5 that the pair meets, decided exactly."""
    alpha, gamma, b, d = map(Fraction, pair.row[:4])
    wide = f"α/b = {float(alpha / b):.4g} {'≥' if alpha >= b else '<'} 1"
    ratio, square = alpha / b, (gamma / d) ** 2
    bent = f"(γ/d)² = {float(square):.4g} {'≥' if square >= ratio else '<'} α/b"
    stated = [name for name, holds in (("3", square >= ratio), ("5", alpha >= b)) if holds]
    return f"{wide}, {bent}; {'stated by Proposition ' + ' and '.join(stated) if stated else 'outside both regimes'}"


def _cause_lines(cause: Cause, language: str, ledger: Callable[[str], tuple[str, str, str]]) -> Iterator[str]:
    """Yield the lines about a cause: its sentence, the claim of the paper with the ledger's verdict, the remedy."""
    yield from _titled("cause", cause.sentence)
    if cause.claim:
        verdict, claim, correction = ledger(cause.claim)
        yield from _titled("claim", f"{cause.claim}, {verdict}: {claim}", f"right: {correction}")
    yield from _titled("fix", cause.remedy_in(language))


def _judgement_lines(replay: Replay) -> Iterator[str]:
    used, declared, judgement = replay.used, replay.declared, replay.judgement
    yield from _titled("asked", f"{used.name} ({replay.spec}): {_claim_lines(used)}")
    if _claim_lines(declared) != _claim_lines(used):
        yield from _titled("declared", _claim_lines(declared))
    if judgement.answer is not None:
        time = "" if judgement.time is None else f", first at {judgement.time!r}"
        yield from _titled("answer", answer_said(judgement.answer, replay.criterion.question) + time)
    words = (judgement.status.value, _mistake(replay), judgement.reason)
    yield from _titled("judged", "; ".join(part for part in words if part))
    if replay.skipped is not None:
        yield from _titled("note", f"verify skips this case: {replay.skipped}")


def _claim_lines(description: Description) -> str:
    """Return the question and the precision of an implementation, as text."""
    return f"{description.question}, {description.precision}"


def _mistake(replay: Replay) -> str:
    """Return the error of an answer in words; "" if the answer is right.

    For a sweep the error is the change of size, or the part of the sweep between its time and the first contact.
    """
    judgement, criterion = replay.judgement, replay.criterion
    if judgement.mistake is None:
        return ""
    if judgement.radii:
        return f"{judgement.mistake.value} by {judgement.radii:.4g} spheroid radii of the sweep"
    if isinstance(replay.truth, Passage):
        tolerated = passage_error.tolerance(replay.case.row, criterion.tolerance, criterion.unit)
        return (
            f"a {judgement.mistake.value}: b and d would have to change by {judgement.error:.4g} of themselves "
            f"(tolerated: {float(tolerated):.4g})"
        )
    return (
        f"a {judgement.mistake.value} with backward error {judgement.error:.4g}, {judgement.error_u:.4g} u "
        f"(tolerated: {float(criterion.tolerance):g} u)"
    )


def answer_said(answer: int, question: str) -> str:
    """Return an answer to a question, as its number and in words."""
    if answer in (CANNOT_SAY, REFUSED):
        return f"{answer}, {'refused' if answer == REFUSED else 'cannot say'}"
    if question == "passage":
        return f"{answer}, {SWEEP_ANSWERS[answer]}"
    if question == "position":
        return f"{answer:+d}, {Position(answer).label}" if answer else f"0, {Position(0).label}"
    return f"{answer}, {'' if answer else 'not '}{question}"


def _choice_lines(choice: FormulaChoice, truth: Position, question: str) -> Iterator[str]:
    compared = choice.comparison
    if compared is None:
        yield from _titled("values", f"none: {choice.why}")
        return
    formula = compared.formula
    other = () if choice.own else (f"these are not the values of {question} itself, whose steps cannot be shown",)
    yield from _titled("values", f"of {formula.name}, {choice.why};", f"{formula.name} is {formula.title}", *other)
    yield ""
    yield from _table(compared)
    yield ""
    about = () if choice.own else (f"about {formula.name}, not about {question}:",)
    yield from _titled("finding", *about, *finding(compared, truth))


def _table(compared: FormulaComparison) -> Iterator[str]:
    """Yield the lines of the table of values."""
    head = ("", "name", "computed as", compared.format, "exact", "error in u")
    rows = [head, *(_row(compared, intermediate) for intermediate in compared.values.values())]
    widths = [max(len(row[column]) for row in rows) for column in range(len(head))]
    for row in rows:
        cells = [text.ljust(width) for text, width in zip(row[:-1], widths, strict=False)]
        yield "  ".join([*cells, row[-1].rjust(widths[-1])]).rstrip()


def _row(compared: FormulaComparison, intermediate: Intermediate) -> Sequence[str]:
    """Return the cells of one value in the table."""
    error = "" if intermediate.error_u is None else f"{intermediate.error_u:.3g}"
    return (
        _mark(compared, intermediate),
        intermediate.name,
        intermediate.operation,
        number_text(intermediate.value),
        number_text(intermediate.exact),
        error,
    )


def _mark(compared: FormulaComparison, intermediate: Intermediate) -> str:
    """Return the mark of a value: the first wrong decision, the number that caused it, or another wrong decision."""
    if intermediate.name == compared.first_wrong:
        return _FIRST
    if intermediate.name == compared.culprit:
        return _CULPRIT
    return _OTHER if intermediate.decided_otherwise else ""


def finding(compared: FormulaComparison, truth: Position) -> Iterator[str]:
    """Yield sentences about the first decision in which floats and exact arithmetic differ, and about both answers."""
    question = compared.formula.question
    if compared.first_wrong is None:
        yield f"every decision of {compared.formula.name} in {compared.format} is the same in exact arithmetic"
    else:
        wrong = compared.values[compared.first_wrong]
        decided = f"is {number_text(wrong.value)}, in exact arithmetic {number_text(wrong.exact)}"
        yield f"{_FIRST} {wrong.name} ({wrong.operation}) {decided}"
        if compared.culprit is not None:
            number = compared.values[compared.culprit]
            exact = number_text(number.exact)
            yield f"{_CULPRIT} for {number.name} is {number_text(number.value)}, where {exact} is exact"
    rounded, exactly = (answer_said(answer, question) for answer in (compared.answer, compared.exact_answer))
    name = compared.formula.name
    yield f"the answer of {name} in {compared.format}: {rounded}; in exact arithmetic: {exactly}"
    right = int(truth) if question == "position" else int(truth is Position[question.upper()])
    if compared.exact_answer != right:
        fault = "the formula is wrong, not only its rounding"
        yield f"{name} errs in exact arithmetic too: {fault}; truth: {truth.label}"


def _change(distance: float | tuple[float, float]) -> str:
    """Return the words for a flip distance, or for its two bounds."""
    if isinstance(distance, tuple):
        low, high = distance
        return _change(low) if low == high else f"{_change(high)}, and not if by {low:.4g} or less"
    if distance == 0:
        return "by an arbitrarily small change"
    if distance == float("inf"):
        return "by no relative change up to 1"
    return f"if each number may change by a relative {distance:.4g}"


def _titled(title: str, *lines: str) -> Iterator[str]:
    """Yield the lines, indented; the title stands before the first."""
    for index, line in enumerate(lines):
        yield f"{'' if index else title:{_LABEL}}{line}"
