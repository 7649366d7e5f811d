"""Writing a vector file: one case a line, always the same bytes for the same content."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

from hypcheck.casebook.frozen.model import SCHEMA, FlagFacts, Head, Vector, VectorFile, Witness
from hypcheck.casebook.frozen.reading import POSITIONS
from hypcheck.casebook.frozen.texts import decimal_of, hex_of
from hypcheck.classification.rationals import exact


def vectors_text(file: VectorFile) -> str:
    """The whole document, ASCII but for the descriptions, with an end of line after every case."""
    return document_text(POSITIONS, file.head, file.flags, [vector_text(case) for case in file.cases])


def document_text(content: str, head: Head, flags: Mapping[str, FlagFacts] | None, cases: Iterable[str]) -> str:
    """A document of cases that are text already; one without flags where `flags` is None."""
    lines = list(cases)
    described = []
    if flags is not None:
        inner = ",\n".join(f"  {json_text(name)}: {json_text(asdict(facts))}" for name, facts in flags.items())
        described = [f'"flags": {{\n{inner}\n}}' if flags else '"flags": {}']
    members = [
        f'"schema": {json_text(SCHEMA)}',
        f'"content": {json_text(content)}',
        f'"family": {json_text(asdict(head))}',
        *described,
        f'"count": {len(lines)}',
        '"cases": [\n' + ",\n".join(lines) + "\n]" if lines else '"cases": []',
    ]
    return "{" + ",\n".join(members) + "}\n"


def vector_text(case: Vector) -> str:
    """One case, an object on one line."""
    flips = ",".join(f'"{position.label}":{decimal_of(distance)}' for position, distance in case.flips.items())
    members = {
        "id": json_text(case.id),
        "row": numbers_text(case.row),
        "hex": json_text([hex_of(value) for value in case.row]),
        "position": str(int(case.position)),
        "tangent": json_text(case.tangent),
        "kind": json_text(case.kind.value),
        "clearance": decimal_of(case.clearance),
        "clearance_hex": json_text(hex_of(case.clearance)),
        "flips": f"{{{flips}}}",
        "certificate": json_text(_certificate(case.witness)),
        "flags": json_text(case.flags),
    }
    return object_text(members)


def object_text(members: Mapping[str, str]) -> str:
    """An object of members that are JSON text already."""
    return "{" + ",".join(f'"{name}":{value}' for name, value in members.items()) + "}"


def numbers_text(row: Iterable[float]) -> str:
    """A list of decimals; infinities and NaN are strings."""
    return f"[{','.join(map(decimal_of, row))}]"


def _certificate(witness: Witness) -> dict[str, Any]:
    if witness.multiplier is not None:
        return {"multiplier": exact(witness.multiplier)}
    if witness.double_root is not None:
        return {"double_root": exact(witness.double_root)}
    return {"points": [[exact(part) for part in point] for point in witness.offsets]}


def json_text(value: Any) -> str:  # noqa: ANN401 - JSON
    """`value` as JSON without blanks."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))
