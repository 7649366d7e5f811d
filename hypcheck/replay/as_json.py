"""A replay for a program: one JSON object."""

from __future__ import annotations

import json
from typing import Any

from hypcheck.casebook.frozen.texts import hex_of
from hypcheck.classification.as_json import proof_as_json
from hypcheck.methods.description import Description
from hypcheck.record import plain
from hypcheck.replay.choosing import Choice
from hypcheck.replay.intermediates import Comparison, Intermediate
from hypcheck.replay.numbers import said
from hypcheck.replay.run import Judgement, Replay, Truth

DIGITS = 17
"""Of numbers in the table of values, which are texts: exact ones need not fit float64."""


def replay_as_json(done: Replay) -> str:
    """The object, on one line; numbers that JSON has not are the strings "inf", "-inf" and "nan"."""
    return json.dumps(
        plain(
            {
                "case": done.case.name,
                "row": done.case.row,
                "row_hex": [hex_of(value) for value in done.case.row],
                "truth": None if done.truth is None else _truth(done.truth),
                "spec": done.spec,
                "declared": _claims(done.declared),
                "used": _claims(done.used),
                "tolerance_u": float(done.criterion.tolerance),
                **_judgement(done.judgement),
                "skipped": done.skipped,
                "values": None if done.choice is None else _choice(done.choice),
            }
        ),
        allow_nan=False,
    )


def _truth(truth: Truth) -> dict[str, Any]:
    decision = truth.decision
    return {
        "position": int(decision.position),
        "label": decision.position.label,
        "tangent": decision.tangent,
        "kind": decision.kind.value,
        "flips": {position.label: distance for position, distance in truth.flips.items()},
        "proof": proof_as_json(truth.pair, truth.certificate),
    }


def _claims(description: Description) -> dict[str, Any]:
    return {"name": description.name, "question": description.question, "precision": description.precision}


def _judgement(judgement: Judgement) -> dict[str, Any]:
    return {
        "status": judgement.status.value,
        "answer": judgement.answer,
        "reason": judgement.reason,
        "mistake": None if judgement.mistake is None else judgement.mistake.value,
        "backward_error": judgement.error,
        "backward_error_u": judgement.error_u,
    }


def _choice(choice: Choice) -> dict[str, Any]:
    compared = choice.comparison
    return {"why": choice.why, "own": choice.own, **({} if compared is None else _comparison(compared))}


def _comparison(compared: Comparison) -> dict[str, Any]:
    return {
        "formula": compared.formula.name,
        "question": compared.formula.question,
        "format": compared.format,
        "answer": compared.answer,
        "exact_answer": compared.exact_answer,
        "first_wrong": compared.first_wrong,
        "culprit": compared.culprit,
        "table": [_value(each) for each in compared.values],
    }


def _value(each: Intermediate) -> dict[str, Any]:
    return {
        "name": each.name,
        "operation": each.operation,
        "value": each.value if isinstance(each.value, bool) else said(each.value, DIGITS),
        "exact": each.exact if isinstance(each.exact, bool) else said(each.exact, DIGITS),
        "error_u": each.error_u,
    }
