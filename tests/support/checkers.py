"""The certificates of frozen cases as deciders: a case is answered as it is labelled where its certificate proves that.

Fractions and points are read from the JSON of the case as cases/README.md says; hypcheck's checkers prove them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

from hypcheck.geometry.pair import WITHOUT_ENDS, Position
from tests.support.corpus import Questions, row_of
from tests.support.inside import Certificate, PassageCertificate, certificate_place, check_certificate, check_passage

NOT_PROVED = 99
"""The answer where a certificate does not prove the label: no decider may give it."""


def fraction(value: str | None) -> Fraction | None:
    return None if value is None else Fraction(value)


def points_from(
    center: Iterable[Fraction], units: Iterable[Fraction], offsets: list[list[str]]
) -> Iterator[tuple[Any, ...]]:
    """The points that are these multiples of the units away from a centre."""
    frame = list(zip(center, units, strict=True))
    for offset in offsets:
        yield tuple(start + unit * Fraction(part) for (start, unit), part in zip(frame, offset, strict=True))


def check_positions(questions: Questions) -> list[int]:
    """The position of each case, or NOT_PROVED."""
    return [case["position"] if proves_position(case) else NOT_PROVED for case in questions.cases]


def proves_position(case: dict[str, Any]) -> bool:
    row, given = row_of(case), case["certificate"]
    b, d = Fraction(row[2]), Fraction(row[3])
    center = map(Fraction, row[4:7])
    points = points_from(center, (b, b, d if len(row) == 7 else b), given.get("points", []))
    at, m = fraction(given.get("multiplier")), fraction(given.get("double_root"))
    certificate = Certificate(Position(case["position"]), at, tuple(points), m)
    return check_certificate(SimpleNamespace(row=row, axis=row[7:] or (0, 0, 1), heights=WITHOUT_ENDS), certificate)


def check_ways(questions: Questions) -> list[int]:
    """The answer of each case about a way, or NOT_PROVED."""
    return [int(case["hit"]) if proves_passage(case) else NOT_PROVED for case in questions.cases]


def proves_passage(case: dict[str, Any]) -> bool:
    row, given = row_of(case), case["certificate"]
    pieces = tuple((Fraction(multiplier), Fraction(end)) for multiplier, end in given["pieces"])
    time, b = fraction(given["time"]), Fraction(row[2])
    first = case["first"] and tuple(map(float.fromhex, case["first_hex"]))
    if time is None:
        return check_passage(row, PassageCertificate(pieces), first)
    points = points_from(certificate_place(row, time).row[4:], (b, b, b), given["points"])
    return check_passage(row, PassageCertificate(pieces, time, tuple(points), fraction(given["double_root"])), first)
