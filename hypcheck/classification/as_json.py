"""An answer for a program: one JSON object whose rationals are exact strings, "3/2"."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

from hypcheck.classification.answer import Answer
from hypcheck.classification.rationals import exact
from hypcheck.classification.witness import Squares, height, reach
from hypcheck.pairs import Position


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
            "proof": _proof(answer),
        }
    )


def _proof(answer: Answer) -> dict[str, Any]:
    squares = Squares.of(answer.pair)
    certificate = answer.certificate
    if certificate.multiplier is not None:
        outside = answer.decision.position is Position.EXTERIOR
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
    return {"by": "points", "points": [_point(answer, point) for point in certificate.points]}


def _point(answer: Answer, point: tuple[Fraction, Fraction, Fraction]) -> dict[str, str]:
    named = dict(zip(("x", "y", "z"), map(exact, point), strict=True))
    return named | {"h": exact(height(answer.pair, point)), "s": exact(reach(answer.pair, point))}


def _squares(squares: Squares) -> dict[str, str]:
    return {"A": exact(squares.A), "B": exact(squares.B), "P": exact(squares.P), "Q": exact(squares.Q)}
