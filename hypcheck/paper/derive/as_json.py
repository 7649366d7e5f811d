"""The output of `hypcheck derive` for programs: one JSON object with a published schema; a rational is "-33/4"."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import sympy

from hypcheck.derivation.formulas import Cost
from hypcheck.derivation.links import Chain, FiniteCases, Identity, Link, Part, Sign
from hypcheck.derivation.program import Operations
from hypcheck.paper.derive.content import Selection
from hypcheck.paper.derive.latex import formula
from hypcheck.paper.ledger.entry import Evidence, LedgerEntry
from hypcheck.paper.ledger.points import PointWitness, TiltedWitness
from hypcheck.proof_text import proof_as_json
from hypcheck.version import VERSION

SCHEMA = "1.4.0"


def lines(chosen: Selection) -> Iterator[str]:
    """Yield the object, indented."""
    yield json.dumps(document(chosen), ensure_ascii=False, indent=1)


def document(chosen: Selection) -> dict[str, Any]:
    """Return the object; parts that were not requested are missing."""
    parts: dict[str, Any] = {}
    if "derivation" in chosen.parts:
        parts["derivation"] = list(map(_chain, chosen.sections))
    if "propositions" in chosen.parts or chosen.claim is not None:
        parts["propositions"] = list(map(_chain, chosen.chains))
    if "ledger" in chosen.parts or chosen.claim is not None:
        parts["ledger"] = list(map(_entry, chosen.entries))
    if "costs" in chosen.parts:
        parts["costs"] = list(map(_cost, chosen.costs))
    failing = list(chosen.failing)
    return {
        "hypcheck": VERSION,
        "schema": SCHEMA,
        "sympy": sympy.__version__,
        "agrees": not failing,
        "failing": failing,
        **parts,
    }


def _fields(value: object, *names: str) -> dict[str, Any]:
    """Return the fields of those names: a tuple as a list, an empty text as null."""
    fields = {name: getattr(value, name) for name in names}
    return {
        name: list(field) if isinstance(field, tuple) else field or None if isinstance(field, str) else field
        for name, field in fields.items()
    }


def _chain(chain: Chain) -> dict[str, Any]:
    return {**_fields(chain, "name", "statement", "needs", "holds"), "links": list(map(_link, chain.links))}


def _link(link: Link) -> dict[str, Any]:
    return {**_fields(link, "statement", "reason", "cites", "holds"), "parts": list(map(_part, link.parts))}


def _part(part: Part) -> dict[str, Any]:
    shown = {"text": part.text, "latex": formula(part.text), "holds": part.holds}
    if isinstance(part, Identity):
        return {"kind": "identity", **shown}
    if isinstance(part, Sign):
        return {"kind": "sign", **shown, "positive": list(part.positive), "nonnegative": list(part.nonnegative)}
    assert isinstance(part, FiniteCases)  # noqa: S101 - tells the type checker what is left
    return {"kind": "cases", **shown, "cases": len(part.cases)}


def _entry(entry: LedgerEntry) -> dict[str, Any]:
    named = ("number", "section", "statement", "verdict", "confirmed", "why", "proved_by", "printed", "correction")
    return {
        **_fields(entry, *named, "harmless", "faults", "follows"),
        "evidence": list(map(_evidence, entry.evidence)),
    }


def _evidence(evidence: Evidence) -> dict[str, Any]:
    return {
        **_fields(evidence, "kind", "text", "holds", "chain"),
        "witnesses": list(map(_witness, evidence.witnesses)),
        "leaning": list(map(_tilted, evidence.tilted)),
    }


def _witness(witness: PointWitness) -> dict[str, Any]:
    facts, pair = witness.facts, witness.facts.point.pair
    point = {name: str(getattr(facts.point, name)) for name in ("a", "c", "r", "z")}
    numbers = {name: str(getattr(facts, name)) for name in ("delta", "c2", "c1", "c0")}
    return {
        "shows": witness.shows,
        "row": list(pair.row),
        **point,
        **numbers,
        "position": int(facts.position),
        "certified": witness.holds,
        "proof": proof_as_json(pair, witness.certificate),
    }


def _tilted(witness: TiltedWitness) -> dict[str, Any]:
    certificate = witness.certificate
    return {
        "shows": witness.shows,
        "row": list(witness.pair.row),
        "position": int(certificate.position),
        "upright_position": int(witness.vertical.position),
        "certified": witness.holds,
        "proof": proof_as_json(witness.pair, certificate),
        "upright_proof": proof_as_json(witness.upright, witness.vertical),
    }


def _cost(cost: Cost) -> dict[str, Any]:
    return {
        **_fields(cost, "name", "title", "source"),
        "scene": _operations(cost.scene),
        "query": _operations(cost.query),
        "query_divisions_by_fixed": cost.by_fixed,
    }


def _operations(operations: Operations) -> dict[str, int]:
    return {**asdict(operations), "rounded": operations.rounded}
