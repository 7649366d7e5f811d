"""The whole answer about one pair: position, kind, clearance and a checked proof; as JSON and as text.

Two oracles are asked about every pair, and an answer is given only where they say the same.

The whole answer about one pair: position, kind, clearance and a checked proof. Loads no numpy.

The exact numbers that check a proof by hand (docs/mathematics.md, "A certificate for every answer").

An answer for a program: one JSON object whose rationals are exact strings, "3/2".

An answer for a person: the position first, then what it means, then how to check it by hand.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from hypcheck.errors import Exit, HypcheckError
from hypcheck.geometry.pair import COLUMNS, Pair, Position
from hypcheck.tables.numbers import equals_text, exact_text, readable_text
from hypcheck.truth import exact
from hypcheck.truth.certificate import Certificate, Point, check_certificate
from hypcheck.truth.exact import Decision
from hypcheck.truth.kinds import Kind
from hypcheck.truth.prove import prove


class DisagreementError(HypcheckError):
    """The exact decision and the nearest point contradict each other about a pair: one of them is wrong."""

    exit_code = Exit.ORACLES_DISAGREE


def require_agreement(row: tuple[float, ...], decided: tuple[int, bool], measured: tuple[int, float]) -> None:
    """Raise DisagreementError unless the decision (position, tangent) and the measure (position, clearance) agree.

    They do when the positions are the same and a clearance of 0 means tangency and nothing else.
    """
    position, tangent = decided
    if measured[0] == position and (measured[1] == 0) == tangent:
        return
    pair = ", ".join(f"{name} {value!r}" for name, value in zip(COLUMNS, row, strict=True))
    said = f"{Position(position).label}{' (tangent)' if tangent else ''}"
    raise DisagreementError(
        f"two oracles disagree about {pair}: by exact decision {said}, by the nearest point "
        f"{Position(measured[0]).label} with clearance {measured[1]!r}; please report this, it is a fault of hypcheck"
    )


@dataclass(frozen=True, slots=True)
class Answer:
    """What is known of a pair: the exact decision, its clearance in spheroid radii, and what proves the decision."""

    pair: Pair
    decision: Decision
    clearance: float
    certificate: Certificate


def answer(pair: Pair) -> Answer:
    """Decide, measure and prove. Raises DisagreementError where two oracles, or a proof and its claim, contradict."""
    from hypcheck.truth.nearest import nearest  # noqa: PLC0415 - loads mpmath

    decision = exact.decide(pair.lengths)
    measured = nearest(pair)
    require_agreement(pair.row, (decision.position, decision.tangent), (measured.position, measured.clearance))
    certificate = prove(pair, decision)
    if certificate.position is not decision.position or not check_certificate(pair, certificate):
        raise DisagreementError(
            f"the proof found for {pair} does not hold; please report this, it is a fault of hypcheck"
        )
    return Answer(pair, decision, measured.clearance, certificate)


@dataclass(frozen=True, slots=True)
class PairSquares:
    """A = (α/b)², B = (γ/d)², P = (x²+y²)/b², Q = (z/d)²: all that the position depends on."""

    A: Fraction
    B: Fraction
    P: Fraction
    Q: Fraction

    @classmethod
    def of(cls, pair: Pair) -> PairSquares:
        """Those of a pair."""
        alpha, gamma, b, d, x, y, z = map(Fraction, pair.row)
        return cls((alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2)

    def g(self, at: Fraction) -> Fraction:
        """The cubic of equation (12) of the paper, as repaired."""
        A, B, P, Q = self.A, self.B, self.P, self.Q
        return (A + at) * (B - at) * (P + Q - 1 - at) - A * P * (B - at) - B * Q * (A + at)

    def third_root(self, double: Fraction) -> Fraction:
        """The root of g that is left when `double` is a double one: the three add up to −c2."""
        return self.B + self.P + self.Q - self.A - 1 - 2 * double


def height_of_point(pair: Pair, point: Point) -> Fraction:
    """h = x²/α² + y²/α² − z²/γ² − 1 of a point: above 0 outside the hyperboloid, below 0 inside, 0 on it."""
    u, v, w = point
    alpha, gamma = Fraction(pair.alpha), Fraction(pair.gamma)
    return (u * u + v * v) / (alpha * alpha) - (w / gamma) ** 2 - 1


def reach_of_point(pair: Pair, point: Point) -> Fraction:
    """s, the square of a point's distance from the spheroid's centre in spheroid radii: at most 1 in the spheroid."""
    u, v, w = (
        coordinate - Fraction(center) for coordinate, center in zip(point, (pair.x, pair.y, pair.z), strict=True)
    )
    return (u * u + v * v) / Fraction(pair.b) ** 2 + (w / Fraction(pair.d)) ** 2


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
    squares = PairSquares.of(pair)
    if certificate.multiplier is not None:
        outside = certificate.position is Position.EXTERIOR
        return {
            "by": "multiplier",
            "lambda": exact_text(certificate.multiplier),
            "between": ["0", exact_text(squares.B)] if outside else [exact_text(-squares.A), "0"],
            **_squares(squares),
            "g": exact_text(squares.g(certificate.multiplier)),
        }
    if certificate.double_root is not None:
        return {
            "by": "double root",
            "m": exact_text(certificate.double_root),
            "third_root": exact_text(squares.third_root(certificate.double_root)),
            **_squares(squares),
        }
    return {"by": "points", "points": [_point(pair, point) for point in certificate.points]}


def _point(pair: Pair, point: tuple[Fraction, Fraction, Fraction]) -> dict[str, str]:
    named = dict(zip(("x", "y", "z"), map(exact_text, point), strict=True))
    return named | {"h": exact_text(height_of_point(pair, point)), "s": exact_text(reach_of_point(pair, point))}


def _squares(squares: PairSquares) -> dict[str, str]:
    return {
        "A": exact_text(squares.A),
        "B": exact_text(squares.B),
        "P": exact_text(squares.P),
        "Q": exact_text(squares.Q),
    }


def answer_as_text(answer: Answer) -> str:
    """Several lines, without an end of line after the last."""
    kind = answer.decision.kind
    label = answer.decision.position.label
    lines = [
        f"{label}, tangent" if answer.decision.tangent else label,
        f"clearance  {_radii(answer.clearance)} ({_meaning(answer.clearance)})",
        f"kind       {kind_as_text(kind)}",
        *_titled("proof", proof_lines(answer.pair, answer.certificate)),
    ]
    return "\n".join(lines)


def _radii(value: float) -> str:
    return f"{repr(value).removesuffix('.0')} spheroid {'radius' if value == 1 else 'radii'}"


def _meaning(clearance: float) -> str:
    if clearance == float("inf"):
        return "more than float64 can tell: scaled about its centre by such a factor, the spheroid would just touch"
    if clearance == -1:
        return "its centre lies on the hyperboloid"
    return "scaled about its centre by 1 + clearance, the spheroid would just touch the hyperboloid"


def _titled(title: str, lines: list[str]) -> list[str]:
    return [f"{title if not index else '':11}{line}" for index, line in enumerate(lines)]


def kind_as_text(kind: Kind) -> str:
    """The name of a kind and what it means, on one line."""
    return f"{kind.value}: {kind.description[0].lower()}{kind.description[1:].rstrip('.')}"


def proof_lines(pair: Pair, certificate: Certificate) -> list[str]:
    """A certificate of what is claimed of a pair, and how to check it by hand."""
    if certificate.multiplier is not None:
        lines = _by_multiplier(pair, certificate.position, certificate.multiplier)
    elif certificate.double_root is not None:
        lines = _by_double_root(pair, certificate.double_root)
    else:
        lines = _by_points(pair, certificate.points)
    if any("≈" in line for line in lines):
        lines.append("≈ marks a rounded number; --json gives all of them exactly.")
    return lines


def _by_multiplier(pair: Pair, position: Position, at: Fraction) -> list[str]:
    squares = PairSquares.of(pair)
    interval = "(0, B)" if position is Position.EXTERIOR else "(−A, 0)"
    return [
        f"λ {equals_text(at)} lies in {interval} and g(λ) {equals_text(squares.g(at))} is above 0;",
        f"any such λ proves {position.label}. By hand:",
        *_definitions(squares),
    ]


def _by_double_root(pair: Pair, m: Fraction) -> list[str]:
    squares = PairSquares.of(pair)
    interval = "(0, B]" if m > 0 else "[−A, 0)"
    end = f", and the third root, {readable_text(squares.third_root(m))}, is not below B" if m == squares.B else ""
    return [
        f"m {equals_text(m)} is a double root of g in {interval}{end};",
        "this proves that the surfaces touch. By hand, g(m) = g′(m) = 0:",
        *_definitions(squares),
    ]


def _definitions(squares: PairSquares) -> list[str]:
    return [
        "g(t) = (A+t)(B−t)(P+Q−1−t) − A·P·(B−t) − B·Q·(A+t), where",
        f"A = (α/b)² {equals_text(squares.A)}, B = (γ/d)² {equals_text(squares.B)},",
        f"P = (x₀²+y₀²)/b² {equals_text(squares.P)}, Q = (z₀/d)² {equals_text(squares.Q)}, centre (x₀, y₀, z₀).",
    ]


def _by_points(pair: Pair, points: tuple[Point, ...]) -> list[str]:
    on_it = [point for point in points if height_of_point(pair, point) == 0][:1]
    if on_it:
        lines = ["a point of the spheroid (s ≤ 1) lies on the hyperboloid (h = 0):"]
    else:
        lines = ["two points of the spheroid (s ≤ 1) lie on different sides of the hyperboloid, outside (h > 0) and"]
        lines.append("inside (h < 0), so the surfaces meet:")
    for point in on_it or points:
        h, s = height_of_point(pair, point), reach_of_point(pair, point)
        lines.append(f"({', '.join(map(readable_text, point))}) has s {equals_text(s)} and h {equals_text(h)},")
    lines.append("where h = (x²+y²)/α² − z²/γ² − 1, s = ((x−x₀)²+(y−y₀)²)/b² + (z−z₀)²/d², centre (x₀, y₀, z₀).")
    return lines
