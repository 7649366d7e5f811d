"""A replay for a person at a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hypcheck.casebook.frozen.texts import hex_of
from hypcheck.classification.text import kind_as_text, proof_lines
from hypcheck.methods.description import Description
from hypcheck.pairs import COLUMNS, REFUSED, Position
from hypcheck.replay.choosing import Choice
from hypcheck.replay.intermediates import Comparison, Intermediate
from hypcheck.replay.numbers import said
from hypcheck.replay.run import Judgement, Replay, Truth
from hypcheck.rows import CANNOT_SAY

_LABEL = 12
_FIRST, _CULPRIT, _OTHER = ">>", " >", " !"


def replay_lines(done: Replay) -> Iterator[str]:
    """The whole replay, line by line."""
    yield from _titled("case", done.case.name)
    for name, value in zip(COLUMNS, done.case.row, strict=True):
        yield f"{name:{_LABEL}}{repr(value).removesuffix('.0'):24}{hex_of(value)}"
    if done.truth is None:
        yield from _titled("truth", f"no pair, for {' and '.join(done.case.at_fault)}: to be refused with {REFUSED}")
    else:
        yield from _truth_lines(done.truth)
    yield ""
    yield from _judgement_lines(done)
    if done.choice is not None and done.truth is not None:
        yield ""
        yield from _choice_lines(done.choice, done.truth.decision.position, done.used.name)


def _truth_lines(truth: Truth) -> Iterator[str]:
    decision = truth.decision
    yield from _titled("truth", f"{decision.position.label}{', tangent' if decision.tangent else ''}")
    yield from _titled("kind", kind_as_text(decision.kind))
    for position, distance in truth.flips.items():
        yield from _titled("flips", f"to {position.label} {_change(distance)}")
    yield from _titled("proof", *proof_lines(truth.pair, truth.certificate))


def _judgement_lines(done: Replay) -> Iterator[str]:
    used, declared = done.used, done.declared
    yield from _titled("asked", f"{used.name} ({done.spec}): {_claims(used)}")
    if _claims(declared) != _claims(used):
        yield from _titled("declared", _claims(declared))
    if done.judgement.answer is not None:
        yield from _titled("answer", answer_said(done.judgement.answer, done.criterion.question))
    yield from _titled("judged", _judged(done.judgement, float(done.criterion.tolerance)))
    if done.skipped is not None:
        yield from _titled("note", f"verify skips this case: {done.skipped}")


def _claims(description: Description) -> str:
    return f"{description.question}, {description.precision}"


def _judged(judgement: Judgement, tolerance: float) -> str:
    parts = [judgement.status.value]
    if judgement.mistake is not None:
        parts.append(
            f"a {judgement.mistake.value} with backward error {judgement.error:.4g}, {judgement.error_u:.4g} u"
            f" (tolerated: {tolerance:g} u)"
        )
    if judgement.reason:
        parts.append(judgement.reason)
    return "; ".join(parts)


def answer_said(answer: int, question: str) -> str:
    """An answer to a question in words, with the number that was given."""
    if answer == CANNOT_SAY:
        return f"{answer}, cannot say"
    if answer == REFUSED:
        return f"{answer}, refused"
    if question == "position":
        return f"{answer:+d}, {Position(answer).label}" if answer else f"0, {Position(0).label}"
    return f"{answer}, {'' if answer else 'not '}{question}"


def _choice_lines(choice: Choice, truth: Position, asked: str) -> Iterator[str]:
    compared = choice.comparison
    if compared is None:
        yield from _titled("values", f"none: {choice.why}")
        return
    formula = compared.formula
    other = () if choice.own else (f"these are not the values of {asked} itself, whose steps cannot be shown",)
    yield from _titled("values", f"of {formula.name}, {choice.why};", f"{formula.name} is {formula.title}", *other)
    yield ""
    yield from _table(compared)
    yield ""
    about = () if choice.own else (f"about {formula.name}, not about {asked}:",)
    yield from _titled("finding", *about, *finding(compared, truth))


def _table(compared: Comparison) -> Iterator[str]:
    head = ("", "name", "computed as", compared.format, "exact", "error in u")
    rows = [head, *(_row(compared, each) for each in compared.values)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(head))]
    for row in rows:
        cells = [
            text.rjust(width) if column == len(head) - 1 else text.ljust(width)
            for column, (text, width) in enumerate(zip(row, widths, strict=True))
        ]
        yield "  ".join(cells).rstrip()


def _row(compared: Comparison, each: Intermediate) -> Sequence[str]:
    error = "" if each.error_u is None else f"{each.error_u:.3g}"
    return (_mark(compared, each), each.name, each.operation, said(each.value), said(each.exact), error)


def _mark(compared: Comparison, each: Intermediate) -> str:
    if each.name == compared.first_wrong:
        return _FIRST
    if each.name == compared.culprit:
        return _CULPRIT
    return _OTHER if each.decided_otherwise else ""


def finding(compared: Comparison, truth: Position) -> Iterator[str]:
    """What the two columns say about the formula, in a sentence or two."""
    question = compared.formula.question
    if compared.first_wrong is None:
        yield f"every decision of {compared.formula.name} in {compared.format} is that of exact arithmetic"
    else:
        wrong = compared[compared.first_wrong]
        decided = f"is {said(wrong.value)}, in exact arithmetic {said(wrong.exact)}"
        yield f"{_FIRST} {wrong.name} ({wrong.operation}) {decided}"
        if compared.culprit is not None:
            number = compared[compared.culprit]
            yield f"{_CULPRIT} for {number.name} is {said(number.value)}, where {said(number.exact)} is exact"
    rounded, exactly = (answer_said(answer, question) for answer in (compared.answer, compared.exact_answer))
    name = compared.formula.name
    yield f"the answer of {name} in {compared.format}: {rounded}; in exact arithmetic: {exactly}"
    right = int(truth) if question == "position" else int(truth is Position[question.upper()])
    if compared.exact_answer != right:
        fault = "the formula is at fault, and not rounding alone"
        yield f"{name} errs in exact arithmetic too: {fault}; truth: {truth.label}"


def _change(distance: float) -> str:
    if distance == 0:
        return "by an arbitrarily small change"
    if distance == float("inf"):
        return "by no relative change up to 1"
    return f"if each number may change by a relative {distance:.4g}"


def _titled(title: str, *lines: str) -> Iterator[str]:
    for index, line in enumerate(lines):
        yield f"{'' if index else title:{_LABEL}}{line}"
