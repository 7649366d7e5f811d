"""The answer about one pair, or about one sweep, with a checked proof; as JSON and as text.

About a pair it is position, kind and clearance. The exact decision and the nearest point both decide every pair. An
answer is given only if they agree and its proof holds. The numbers that check a proof by hand are explained in
docs/mathematics.md, "A certificate for every answer". About a sweep, the straight motion of a spheroid between two
positions, it is contact or none: decided exactly, and its certificate is checked by code that shares nothing with the
code that found it. Loads no numpy, except for distances that are tilted or beside ends.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from typing import Any

from hypcheck.errors import Exit, HypcheckError
from hypcheck.geometry.pair import HEIGHTS, TILTED_COLUMNS, TILTED_SWEEP_COLUMNS, Pair, Position
from hypcheck.kernel.scalar import distance_at_once
from hypcheck.proof_text import is_rule, passage_proof_as_json, passage_proof_lines, proof_as_json, proof_lines
from hypcheck.truth import exact
from hypcheck.truth.certificate import Certificate, PassageCertificate, check_certificate, check_passage
from hypcheck.truth.exact import Decision
from hypcheck.truth.kinds import Kind
from hypcheck.truth.nearest import nearest
from hypcheck.truth.prove import prove, prove_passage
from hypcheck.truth.swept import Passage, passage_of_row


class DisagreementError(HypcheckError):
    """The exact decision and the nearest point contradict each other about a pair, so one of them is wrong."""

    exit_code = Exit.ORACLES_DISAGREE


def require_agreement(row: tuple[float, ...], decided: tuple[int, bool], measured: tuple[int, float]) -> None:
    """Raise DisagreementError unless the decision (position, tangent) and the measure (position, clearance) agree.

    They agree if the positions are equal, and the clearance is 0 exactly for a tangency.
    """
    position, tangent = decided
    if measured[0] == position and (measured[1] == 0) == tangent:
        return
    other = f"by the nearest point {Position(measured[0]).label} with clearance {measured[1]!r}"
    raise _disagreement(row, position, tangent, other)


def _disagreement(row: tuple[float, ...], position: int, tangent: bool, other: str) -> DisagreementError:
    """Return the error that two oracles disagree about a row; `other` is what the second one says."""
    pair = ", ".join(f"{name} {value!r}" for name, value in zip(TILTED_COLUMNS + HEIGHTS, row, strict=False))
    words = f"{Position(position).label}{' (tangent)' if tangent else ''}"
    return DisagreementError(
        f"two oracles disagree about {pair}: by exact decision {words}, {other}; please report this, it is a fault of "
        "hypcheck"
    )


@dataclass(frozen=True, slots=True)
class Answer:
    """The answer about a pair.

    pair: the pair that was asked about.
    decision: its position and tangency, and the kind of an upright pair, decided in integers.
    clearance: in spheroid radii, 0 for a tangency, negative where the surfaces cross.
    certificate: proves the decision, and was checked.
    margin: the length of the margin; None if there is none.
    with_margin: the position with the margin: contact unless a distance of at least the margin is proved; None without.
    """

    pair: Pair
    decision: Decision
    clearance: float
    certificate: Certificate
    margin: float | None = None
    with_margin: Position | None = None


def measured_clearance(pair: Pair, decision: Decision) -> float:
    """Compute the clearance by the nearest point. Raises DisagreementError unless it agrees with the decision."""
    measured = nearest(pair)
    require_agreement(pair.row, (decision.position, decision.tangent), (measured.position, measured.clearance))
    return measured.clearance


def ended_clearance_of(pair: Pair, decision: Decision) -> float:
    """Compute the clearance beside a hyperboloid that ends. Raises DisagreementError if another oracle contradicts."""
    from hypcheck.truth import ended_error, least  # noqa: PLC0415 - they load numpy, which other answers do without

    other = least.position(pair)
    if other not in (None, decision.position):
        raise _disagreement(pair.row, decision.position, decision.tangent, f"by the least value {other.label}")
    return ended_error.clearance(pair, decision)


def answer(pair: Pair, margin: float | None = None) -> Answer:
    """Answer about a pair, with a proof. Raises DisagreementError if oracles disagree, or the proof does not hold.

    A pair whose axis is vertical is answered as an upright pair. With `margin`, a length of 0 or more, the answer also
    has the position with that margin.
    """
    pair = pair.upright if pair.is_upright else pair
    decision = exact.decide(pair.lengths)
    clearance = (ended_clearance_of if pair.has_ends else measured_clearance)(pair, decision)
    certificate = proved(pair, decision)
    if margin is None:
        return Answer(pair, decision, clearance, certificate)
    return Answer(pair, decision, clearance, certificate, margin, _with_margin(pair, decision, margin))


def _with_margin(pair: Pair, decision: Decision, margin: float) -> Position:
    """Return the position with the margin. Raises DisagreementError if it is another clear position."""
    from hypcheck.kernel.classify import classify  # noqa: PLC0415 - it loads numpy, which other answers do without

    position = Position(int(classify(pair.row, margin=margin)))
    if position not in (decision.position, Position.CONTACT):
        raise _disagreement(pair.row, decision.position, decision.tangent, f"with a margin {position.label}")
    return position


def proved(pair: Pair, decision: Decision) -> Certificate:
    """Prove an exact decision, and check the proof. Raises DisagreementError if it does not hold."""
    certificate = prove(pair, decision)
    unproved = not check_certificate(pair, certificate) and not is_rule(certificate)
    if certificate.position is not decision.position or unproved:
        raise _unproved(pair)
    return certificate


def _unproved(pair: Pair) -> DisagreementError:
    """Return the error that the proof about a pair does not hold."""
    return DisagreementError(f"the proof found for {pair} does not hold; please report this, it is a fault of hypcheck")


def answer_as_json(answer: Answer) -> str:
    """Return the answer as one JSON object on one line; rationals are strings such as "3/2", infinity is "inf"."""
    decision, (low, high) = answer.decision, distance_of(answer.pair)
    return json.dumps(
        {
            "position": int(decision.position),
            "label": decision.position.label,
            "tangent": decision.tangent,
            "distance_lower": _as_json(low),
            "distance_upper": _as_json(high),
            "clearance": _as_json(answer.clearance),
            "kind": None if decision.kind is None else decision.kind.value,
            **_margin_as_json(answer),
            "proof": proof_as_json(answer.pair, answer.certificate),
        }
    )


def _margin_as_json(answer: Answer) -> dict[str, Any]:
    """Return the margin and the position with it, for JSON; nothing without a margin."""
    if answer.margin is None or answer.with_margin is None:
        return {}
    return {"margin": answer.margin, "position_with_margin": int(answer.with_margin)}


def _as_json(number: float) -> float | str:
    """Return a number for JSON; infinity is "inf"."""
    return number if number != float("inf") else "inf"


def distance_of(pair: Pair) -> tuple[float, float]:
    """Return a lower and an upper bound of the Euclidean distance, proved, with ten digits; 0 and 0 in contact."""
    low, high = distance_at_once(pair) or _distance_by_arrays(pair)
    low, high = low if low >= 0 else 0.0, high if high >= 0 else float("inf")  # NaN is not known
    return _ten_digits(low, ROUND_FLOOR), _ten_digits(high, ROUND_CEILING)


def _distance_by_arrays(pair: Pair) -> tuple[float, float]:
    """Return the bounds of the distance that the numpy code for many rows finds."""
    from hypcheck.kernel.clearance import clearance  # noqa: PLC0415 - it loads numpy

    near = clearance(pair.row)
    return float(near.distance_lower), float(near.distance_upper)


def _ten_digits(number: float, rounding: str) -> float:
    """Round a bound to ten digits, up or down as `rounding` says; more digits would mean nothing.

    A bound that is rounded down stays at most `number`, one that is rounded up at least, so it is still proved.
    """
    return float(Context(prec=10, rounding=rounding).create_decimal(Decimal(number)))


def answer_as_text(answer: Answer) -> str:
    """Return the answer as lines of text, without a last end of line: position, distance, clearance, kind, proof."""
    decision, clearance = answer.decision, answer.clearance
    radii = f"{repr(clearance).removesuffix('.0')} spheroid {'radius' if clearance == 1 else 'radii'}"
    proof = proof_lines(answer.pair, answer.certificate)
    lines = [
        decision.position.label + ", tangent" * decision.tangent,
        *_margin_lines(answer),
        f"distance   {_distance_as_text(*distance_of(answer.pair))}",
        f"clearance  {radii} ({_meaning(clearance)})",
        *([] if decision.kind is None else [f"kind       {kind_as_text(decision.kind)}"]),
        f"proof      {proof[0]}",
        *(f"{'':11}{line}" for line in proof[1:]),
    ]
    return "\n".join(lines)


def _margin_lines(answer: Answer) -> Iterator[str]:
    """Yield the line about the margin; none without a margin."""
    if answer.margin is None or answer.with_margin is None:
        return
    proof = "is not proved" if answer.with_margin is Position.CONTACT else "is proved"
    length = repr(answer.margin).removesuffix(".0")
    yield f"margin     {answer.with_margin.label}: a distance of at least {length} {proof}"


def _distance_as_text(low: float, high: float) -> str:
    """Return the text of a distance between two bounds."""
    if high == 0:
        return "0"
    if high == float("inf"):
        return f"{low:.9g} or more, in the unit of the lengths"
    known = high - low <= 1e-8 * high
    value = f"{low + (high - low) / 2:.8g}" if known else f"{low:.8g} to {high:.8g}"
    return f"{value}, in the unit of the lengths (proved: from {low!r} to {high!r})"


def _meaning(clearance: float) -> str:
    """Return the words that explain a clearance."""
    if clearance == float("inf"):
        return "too large for float64; scaled about its centre by 1 + clearance, the spheroid would just touch"
    if clearance == -1:
        return "its centre lies on the hyperboloid"
    return "scaled about its centre by 1 + clearance, the spheroid would just touch the hyperboloid"


def kind_as_text(kind: Kind) -> str:
    """Return the name of a kind and its meaning, on one line."""
    return f"{kind.value}: {kind.description[0].lower()}{kind.description[1:].rstrip('.')}"


@dataclass(frozen=True, slots=True)
class SweepAnswer:
    """The answer about a sweep.

    row: sizes, the two centres, and the axis where the spheroid has one; behind an axis, heights where it ends.
    passage: the exact decision. first: two neighbouring float64 between which the time of the first contact lies, or 0
    and 0; None without contact. certificate: proves `first`, and was checked; None if the surfaces touch only at an
    irrational time, and if the hyperboloid ends.
    """

    row: tuple[float, ...]
    passage: Passage
    first: tuple[float, float] | None
    certificate: PassageCertificate | None


def sweep_answer(row: Sequence[float]) -> SweepAnswer:
    """Answer about the sweep of a row (sizes, two centres, perhaps an axis and heights), with a proof.

    Raises InputError for a row that is not valid, DisagreementError if the proof does not hold.
    """
    if _heights_of(row):
        sweep = passage_of_row(row)
        return SweepAnswer(tuple(row), sweep, (sweep.first_lower, sweep.first_upper) if sweep.hit else None, None)
    try:
        sweep, first, certificate = prove_passage(row)
    except ValueError:  # an irrational time has no certificate
        sweep = passage_of_row(row)
        return SweepAnswer(tuple(row), sweep, (sweep.first_lower, sweep.first_upper), None)
    if not check_passage(row, certificate, first):
        raise DisagreementError(
            f"the proof found for the sweep {tuple(row)} does not hold; please report this, it is a fault of hypcheck"
        )
    return SweepAnswer(tuple(row), sweep, first, certificate)


def _heights_of(row: Sequence[float]) -> Sequence[float]:
    """Return the heights at the end of the row of a sweep; an empty sequence if it has none."""
    return row[len(TILTED_SWEEP_COLUMNS) :]


def sweep_as_json(answer: SweepAnswer) -> str:
    """Return the answer as one JSON object on one line, rationals as strings such as "3/2"."""
    return json.dumps(
        {
            "hit": int(answer.passage.hit),
            "label": _hit_label(answer),
            "grazes": answer.passage.grazes,
            "first": answer.first,
            "start": answer.passage.start.label,
            "end": answer.passage.end.label,
            "proof": None if answer.certificate is None else passage_proof_as_json(answer.certificate),
        }
    )


def _hit_label(answer: SweepAnswer) -> str:
    """Return "contact" or "clear"."""
    return "contact" if answer.passage.hit else "clear"


def sweep_as_text(answer: SweepAnswer) -> str:
    """Return the answer as lines of text, without a last end of line: contact or clear, first contact, ends, proof."""
    sweep = answer.passage
    lines = [_hit_label(answer) + ", only touched for an instant" * sweep.grazes]
    if answer.first is not None:
        lower, upper = answer.first
        lines.append(f"first      contact between the times {lower!r} and {upper!r}; 0 is the start, 1 the end")
    lines.append(f"ends       {sweep.start.label} at the start, {sweep.end.label} at the end")
    proof = list(passage_proof_lines(answer.certificate, ended=bool(_heights_of(answer.row))))
    return "\n".join([*lines, f"proof      {proof[0]}", *(f"{'':11}{line}" for line in proof[1:])])
