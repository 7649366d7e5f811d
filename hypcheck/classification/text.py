"""An answer for a person: the position first, then what it means, then how to check it by hand."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from hypcheck.classification.rationals import readable, relation
from hypcheck.classification.witness import Squares, height, reach
from hypcheck.pairs import Pair, Position
from hypcheck.truth.certificate import Certificate, Point
from hypcheck.truth.kinds import Kind

if TYPE_CHECKING:
    from hypcheck.classification.answer import Answer


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
    squares = Squares.of(pair)
    interval = "(0, B)" if position is Position.EXTERIOR else "(−A, 0)"
    return [
        f"λ {relation(at)} lies in {interval} and g(λ) {relation(squares.g(at))} is above 0;",
        f"any such λ proves {position.label}. By hand:",
        *_definitions(squares),
    ]


def _by_double_root(pair: Pair, m: Fraction) -> list[str]:
    squares = Squares.of(pair)
    interval = "(0, B]" if m > 0 else "[−A, 0)"
    end = f", and the third root, {readable(squares.third_root(m))}, is not below B" if m == squares.B else ""
    return [
        f"m {relation(m)} is a double root of g in {interval}{end};",
        "this proves that the surfaces touch. By hand, g(m) = g′(m) = 0:",
        *_definitions(squares),
    ]


def _definitions(squares: Squares) -> list[str]:
    return [
        "g(t) = (A+t)(B−t)(P+Q−1−t) − A·P·(B−t) − B·Q·(A+t), where",
        f"A = (α/b)² {relation(squares.A)}, B = (γ/d)² {relation(squares.B)},",
        f"P = (x₀²+y₀²)/b² {relation(squares.P)}, Q = (z₀/d)² {relation(squares.Q)}, centre (x₀, y₀, z₀).",
    ]


def _by_points(pair: Pair, points: tuple[Point, ...]) -> list[str]:
    on_it = [point for point in points if height(pair, point) == 0][:1]
    if on_it:
        lines = ["a point of the spheroid (s ≤ 1) lies on the hyperboloid (h = 0):"]
    else:
        lines = ["two points of the spheroid (s ≤ 1) lie on different sides of the hyperboloid, outside (h > 0) and"]
        lines.append("inside (h < 0), so the surfaces meet:")
    for point in on_it or points:
        h, s = height(pair, point), reach(pair, point)
        lines.append(f"({', '.join(map(readable, point))}) has s {relation(s)} and h {relation(h)},")
    lines.append("where h = (x²+y²)/α² − z²/γ² − 1, s = ((x−x₀)²+(y−y₀)²)/b² + (z−z₀)²/d², centre (x₀, y₀, z₀).")
    return lines
