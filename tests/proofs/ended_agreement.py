"""The proved checker against truth/certificate.py beside ends: frozen certificates, and others with one thing changed.

Another claim, open for solid, an end elsewhere, a piece left out, a multiplier or a plane's number of another sign or
size, a point left out or moved.
"""

from __future__ import annotations

import copy
import json
import subprocess
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

from hypcheck.geometry.pair import Pair, Position
from hypcheck.proofs.build import BUILT, CHECKER
from hypcheck.tables.numbers import hex_of
from hypcheck.vectors import frozen
from hypcheck.vectors.cases import read_cases
from tests.support.inside import check_certificate

Case = dict[str, Any]


def changed(case: Case) -> Iterator[Case]:
    """The case as it is, then others."""
    yield case
    for position in Position:
        if position != case["position"]:
            yield {**case, "position": int(position)}
    yield _with(case, 12, 1.0 - case["row"][12])
    for place in (10, 11):
        if not isinstance(case["row"][place], str):
            if float(case["row"][10]) < case["row"][6] < float(case["row"][11]):
                yield _with(case, place, case["row"][6])
            yield _with(case, place, float("-inf") if place == 10 else float("inf"))
    for certificate in _certificates(case["certificate"]):
        yield {**case, "certificate": certificate}


def _with(case: Case, place: int, number: float) -> Case:
    other = copy.deepcopy(case)
    other["row"][place] = number if abs(number) != float("inf") else str(number)
    other["hex"][place] = hex_of(number)
    return other


def _certificates(certificate: dict[str, Any]) -> Iterator[dict[str, Any]]:
    if "multiplier" in certificate:
        for factor in (-1, 0, 2, Fraction(1, 64)):
            yield {"multiplier": str(factor * Fraction(certificate["multiplier"]))}
    for place in range(len(certificate.get("pieces", ()))):
        for number in (2, 3):
            for factor in (-1, 0, 2, Fraction(1, 64)):
                pieces = copy.deepcopy(certificate["pieces"])
                pieces[place][number] = str(factor * Fraction(pieces[place][number]))
                yield {"pieces": pieces}
        if len(certificate["pieces"]) > 1:
            yield {"pieces": certificate["pieces"][:place] + certificate["pieces"][place + 1 :]}
    points = certificate.get("points", ())
    for place, point in enumerate(points):
        if len(points) > 1:
            yield {"points": points[:place] + points[place + 1 :]}
        for coordinate in range(3):
            moved = [*point]
            moved[coordinate] = str(Fraction(point[coordinate]) * (1 + Fraction(1, 1 << 10)))
            yield {"points": [*points[:place], moved, *points[place + 1 :]]}


def verdicts(name: str, folder: Path, every: int = 1) -> tuple[list[bool], list[bool]]:
    """What the proved checker, and what Python, says of one frozen certificate in `every`, and of its changes."""
    file = json.loads((frozen.folder() / f"{name}.json").read_text(encoding="utf-8"))
    cases = [other for case in file["cases"][::every] if "rule" not in case["certificate"] for other in changed(case)]
    file["cases"] = [{**case, "id": f"{name}-{place:04}", "tangent": False} for place, case in enumerate(cases)]
    file["count"] = len(cases)
    lines = ",\n".join(json.dumps(case) for case in file.pop("cases"))
    path = folder / f"{name}.json"
    path.write_text(f'{json.dumps(file)[:-1]},\n"cases": [\n{lines}\n]}}\n', encoding="utf-8")
    done = subprocess.run([BUILT / CHECKER, path], capture_output=True, text=True, check=False)
    refused = {line.split()[2].rstrip(":") for line in done.stdout.splitlines() if ", case " in line}
    vectors = read_cases(str(path)).cases
    python = [check_certificate(Pair.from_row(vector.row), vector.certificate) for vector in vectors]
    return [vector.id not in refused for vector in vectors], python
