"""An answer for a program: one JSON object whose rationals are exact strings, "3/2"."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from hypcheck.classification.rationals import exact
from hypcheck.classification.witness import Squares, height, reach
from hypcheck.pairs import Pair, Position
from hypcheck.truth.certificate import Certificate

if TYPE_CHECKING:
    from hypcheck.classification.answer import Answer


def answer_as_json(answer: Answer) -> str:
    """The object, on one line. An infinite clearance is the string "inf", for which JSON has no number."""
    decision = answer.decision
    return json.dumps(
        {
            "position": int(decision.position),
            "label": decision.position.label,
            "tangent": decision.tangent,
            "clearance": answer.clearance if answer.clearance != float("inf") else "inf",
            "kind": decision.kind.value,
            "proof": proof_as_json(answer.pair, answer.certificate),
        }
    )


def proof_as_json(pair: Pair, certificate: Certificate) -> dict[str, Any]:
    """A certificate of what is claimed of a pair, and the numbers that check it."""
    squares = Squares.of(pair)
    if certificate.multiplier is not None:
        outside = certificate.position is Position.EXTERIOR
        return {
            "by": "multiplier",
            "lambda": exact(certificate.multiplier),
            "between": ["0", exact(squares.B)] if outside else [exact(-squares.A), "0"],
            **_squares(squares),
            "g": exact(squares.g(certificate.multiplier)),
        }
    if certificate.double_root is not None:
        return {
            "by": "double root",
            "m": exact(certificate.double_root),
            "third_root": exact(squares.third_root(certificate.double_root)),
            **_squares(squares),
        }
    return {"by": "points", "points": [_point(pair, point) for point in certificate.points]}


def _point(pair: Pair, point: tuple[Fraction, Fraction, Fraction]) -> dict[str, str]:
    named = dict(zip(("x", "y", "z"), map(exact, point), strict=True))
    return named | {"h": exact(height(pair, point)), "s": exact(reach(pair, point))}


def _squares(squares: Squares) -> dict[str, str]:
    return {"A": exact(squares.A), "B": exact(squares.B), "P": exact(squares.P), "Q": exact(squares.Q)}
