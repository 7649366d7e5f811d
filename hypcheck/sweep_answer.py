"""The answer about one sweep, the straight motion of a spheroid between two positions: contact or none, and a proof.

The passage is decided exactly, and its certificate is checked by code that shares nothing with the code that found it.
Loads no numpy.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from hypcheck.answer import DisagreementError
from hypcheck.geometry.pair import TILTED_SWEEP_COLUMNS, WITHOUT_ENDS
from hypcheck.geometry.rows import SWEEPS
from hypcheck.messages import counted
from hypcheck.tables.numbers import equals_text, exact_text, readable_text
from hypcheck.truth.certificate import PassageCertificate, check_passage
from hypcheck.truth.prove import prove_passage
from hypcheck.truth.swept import Passage, passage


@dataclass(frozen=True, slots=True)
class SweepAnswer:
    """The answer about a sweep.

    row: sizes, the two centres, and the axis where the spheroid has one; behind an axis, heights where it ends.
    passage: the exact decision. first: two neighbouring float64 that the time of the first contact lies between, or 0
    twice; None without contact. certificate: proves `first`, and was checked; None if the surfaces touch only at an
    irrational time, and if the hyperboloid ends.
    """

    row: tuple[float, ...]
    passage: Passage
    first: tuple[float, float] | None
    certificate: PassageCertificate | None


def sweep_answer(row: Sequence[float]) -> SweepAnswer:
    """Decide and prove a row of sizes, two centres and, if it has these, an axis and heights.

    Raises InputError for a row that is not valid, DisagreementError if the proof does not hold.
    """
    if SWEEPS.has_heights(row):
        sweep = passage_of_row(row)
        return SweepAnswer(tuple(row), sweep, (sweep.first_lower, sweep.first_upper) if sweep.hit else None, None)
    try:
        sweep, first, certificate = prove_passage(row)
    except ValueError:  # an irrational time has no certificate
        sweep = passage(row[:4], row[4:7], row[7:10], row[10:] or None)
        return SweepAnswer(tuple(row), sweep, (sweep.first_lower, sweep.first_upper), None)
    if not check_passage(row, certificate, first):
        raise DisagreementError(
            f"the proof found for the sweep {tuple(row)} does not hold; please report this, it is a fault of hypcheck"
        )
    return SweepAnswer(tuple(row), sweep, first, certificate)


def passage_of_row(row: Sequence[float]) -> Passage:
    """The decision of a sweep: sizes, two centres, perhaps an axis, perhaps heights. Raises InputError."""
    axis, heights = row[10 : len(TILTED_SWEEP_COLUMNS)], row[len(TILTED_SWEEP_COLUMNS) :]
    z_min, z_max, solid = heights or WITHOUT_ENDS
    return passage(row[:4], row[4:7], row[7:10], axis or None, z_min=z_min, z_max=z_max, solid=solid)


def sweep_as_json(answer: SweepAnswer) -> str:
    """The answer as one JSON object on one line, rationals as strings such as "3/2"."""
    return json.dumps(
        {
            "hit": int(answer.passage.hit),
            "label": _label(answer),
            "grazes": answer.passage.grazes,
            "first": answer.first,
            "start": answer.passage.start.label,
            "end": answer.passage.end.label,
            "proof": None if answer.certificate is None else _proof_as_json(answer.certificate),
        }
    )


def _label(answer: SweepAnswer) -> str:
    return "contact" if answer.passage.hit else "clear"


def _proof_as_json(certificate: PassageCertificate) -> dict[str, Any]:
    time, root = certificate.time, certificate.double_root
    return {
        "pieces": [list(map(exact_text, piece)) for piece in certificate.pieces],
        "time": None if time is None else exact_text(time),
        "points": [list(map(exact_text, point)) for point in certificate.points],
        "double_root": None if root is None else exact_text(root),
    }


def sweep_as_text(answer: SweepAnswer) -> str:
    """The answer as lines of text, without an end of line after the last: contact or clear, first contact, proof."""
    sweep = answer.passage
    lines = [_label(answer) + ", only touched for an instant" * sweep.grazes]
    if answer.first is not None:
        lower, upper = answer.first
        lines.append(f"first      contact between the times {lower!r} and {upper!r}; 0 is the start, 1 the end")
    lines.append(f"ends       {sweep.start.label} at the start, {sweep.end.label} at the end")
    proof = [_BESIDE_ENDS] if SWEEPS.has_heights(answer.row) else list(_proof_lines(answer.certificate))
    return "\n".join([*lines, f"proof      {proof[0]}", *(f"{'':11}{line}" for line in proof[1:])])


_BESIDE_ENDS = "none is written if the hyperboloid ends: the times are decided in integers (docs/motion.md)."

_MOST_PIECES = 4
"""The text shows so many pieces of a proof."""


def _proof_lines(certificate: PassageCertificate | None) -> Iterator[str]:
    if certificate is None:
        yield "none in rational numbers: the surfaces touch only at an irrational time"
        return
    for at, end in certificate.pieces[:_MOST_PIECES]:
        yield f"λ {equals_text(at)} proves the sweep clear up to the time {readable_text(end)};"
    if more := len(certificate.pieces[_MOST_PIECES:]):
        until = readable_text(certificate.pieces[-1][1])
        yield f"{counted(more, 'piece')} more up to the time {until} (--json has all);"
    if certificate.time is None:
        yield "so it is clear all along: det(S + λH) > 0 on the piece of each λ (docs/motion.md)."
        return
    time = readable_text(certificate.time)
    if certificate.double_root is not None:
        yield f"at the time {time} the surfaces touch: m {equals_text(certificate.double_root)} is a double root."
        return
    yield f"at the time {time} the spheroid has these points, on both sides of the hyperboloid or on it:"
    yield ", ".join(f"({', '.join(map(readable_text, point))})" for point in certificate.points) + "."
