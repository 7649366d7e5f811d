"""The answer about one pair: position, kind, clearance, and a checked proof; as JSON and as text.

The exact decision and the nearest point are asked about every pair. An answer is given only if they agree and its proof
holds. The numbers that check a proof by hand are explained in docs/mathematics.md, "A certificate for every answer".
Loads no numpy, but for distances that are tilted or beside ends.
"""

from __future__ import annotations

import json
import sys
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from typing import Any

from hypcheck.errors import Exit, HypcheckError
from hypcheck.geometry.pair import HEIGHTS, TILTED_COLUMNS, Pair, Position
from hypcheck.kernel.choice import choice, compiled
from hypcheck.messages import counted
from hypcheck.tables.numbers import equals_text, exact_text, readable_text
from hypcheck.truth import exact
from hypcheck.truth.certificate import Certificate, Piece, Point, check_certificate, pivots, surfaces
from hypcheck.truth.exact import Decision
from hypcheck.truth.kinds import Kind
from hypcheck.truth.nearest import nearest
from hypcheck.truth.pencil import quartic
from hypcheck.truth.prove import prove


class DisagreementError(HypcheckError):
    """The exact decision and the nearest point contradict each other about a pair, so one of them is wrong."""

    exit_code = Exit.ORACLES_DISAGREE


def require_agreement(row: tuple[float, ...], decided: tuple[int, bool], measured: tuple[int, float]) -> None:
    """Raise DisagreementError unless the decision (position, tangent) and the measure (position, clearance) agree.

    They agree if the positions are equal, and the clearance is 0 exactly for a tangency.
    """
    position, tangent = decided
    if measured[0] == position and (measured[1] == 0) == tangent:
        return
    other = f"by the nearest point {Position(measured[0]).label} with clearance {measured[1]!r}"
    raise _disagreement(row, position, tangent, other)


def _disagreement(row: tuple[float, ...], position: int, tangent: bool, other: str) -> DisagreementError:
    pair = ", ".join(f"{name} {value!r}" for name, value in zip(TILTED_COLUMNS + HEIGHTS, row, strict=False))
    said = f"{Position(position).label}{' (tangent)' if tangent else ''}"
    return DisagreementError(
        f"two oracles disagree about {pair}: by exact decision {said}, {other}; please report this, it is a fault of "
        "hypcheck"
    )


@dataclass(frozen=True, slots=True)
class Answer:
    """The answer about a pair.

    pair: the pair that was asked about.
    decision: its position and tangency, and the kind of an upright pair, decided in integers.
    clearance: in spheroid radii, 0 for a tangency, negative where the surfaces cross.
    certificate: proves the decision, and was checked.
    margin: a length, or None where none was asked with.
    with_margin: the position where what is not proved to be at least the margin away is contact.
    """

    pair: Pair
    decision: Decision
    clearance: float
    certificate: Certificate
    margin: float | None = None
    with_margin: Position | None = None


def measured_clearance(pair: Pair, decision: Decision) -> float:
    """The clearance by the nearest point, which must agree with the decision. Raises DisagreementError."""
    measured = nearest(pair)
    require_agreement(pair.row, (decision.position, decision.tangent), (measured.position, measured.clearance))
    return measured.clearance


def ended_clearance_of(pair: Pair, decision: Decision) -> float:
    """The clearance beside a hyperboloid that ends. Raises DisagreementError if the least value contradicts."""
    from hypcheck.truth import ended_clearance, least  # noqa: PLC0415 - they load numpy, which other answers do without

    other = least.position(pair)
    if other not in (None, decision.position):
        raise _disagreement(pair.row, decision.position, decision.tangent, f"by the least value {other.label}")
    return ended_clearance.clearance(pair, decision)


def answer(pair: Pair, margin: float | None = None) -> Answer:
    """Decide, measure and prove. Raises DisagreementError where two oracles, or a proof and its claim, contradict.

    A pair with an axis that is an upright one all the same is answered as that. `margin`, a length of 0 or more, asks
    for the position with it besides.
    """
    pair = pair.upright if pair.is_upright else pair
    decision = exact.decide(pair.lengths)
    clearance = (ended_clearance_of if pair.has_ends else measured_clearance)(pair, decision)
    certificate = proved(pair, decision)
    if margin is None:
        return Answer(pair, decision, clearance, certificate)
    return Answer(pair, decision, clearance, certificate, margin, _with_margin(pair, decision, margin))


def _with_margin(pair: Pair, decision: Decision, margin: float) -> Position:
    from hypcheck.kernel.classify import classify  # noqa: PLC0415 - it loads numpy, which other answers do without

    found = Position(int(classify(pair.row, margin=margin)))
    if found not in (decision.position, Position.CONTACT):
        raise _disagreement(pair.row, decision.position, decision.tangent, f"with a margin {found.label}")
    return found


def proved(pair: Pair, decision: Decision) -> Certificate:
    """The checked proof of an exact decision. Raises DisagreementError if it does not hold."""
    certificate = prove(pair, decision)
    unproved = not check_certificate(pair, certificate) and not is_rule(certificate)
    if certificate.position is not decision.position or unproved:
        raise _unproved(pair)
    return certificate


def is_rule(certificate: Certificate) -> bool:
    """Whether a contact with a hyperboloid that ends is said without a witness: by the exact rule alone."""
    return certificate.position is Position.CONTACT and not certificate.points and certificate.double_root is None


def _unproved(pair: Pair) -> DisagreementError:
    return DisagreementError(f"the proof found for {pair} does not hold; please report this, it is a fault of hypcheck")


@dataclass(frozen=True, slots=True)
class PairSquares:
    """A = (α/b)², B = (γ/d)², P = (x²+y²)/b² and Q = (z/d)² of a pair. Its position depends on nothing else."""

    A: Fraction
    B: Fraction
    P: Fraction
    Q: Fraction

    @classmethod
    def of(cls, pair: Pair) -> PairSquares:
        """The four numbers of a pair, exact."""
        alpha, gamma, b, d, x, y, z = map(Fraction, pair.row)
        return cls((alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2)

    def g(self, at: Fraction) -> Fraction:
        """The cubic of equation (12) of the paper, as repaired."""
        A, B, P, Q = self.A, self.B, self.P, self.Q
        return (A + at) * (B - at) * (P + Q - 1 - at) - A * P * (B - at) - B * Q * (A + at)

    def third_root(self, double: Fraction) -> Fraction:
        """The third root of g, if `double` is a double root: the sum of all three is −c2."""
        return self.B + self.P + self.Q - self.A - 1 - 2 * double


def height_of_point(pair: Pair, point: Point) -> Fraction:
    """h = (x²+y²)/α² − z²/γ² − 1 of a point: above 0 outside the hyperboloid, below 0 inside, 0 on it."""
    u, v, w = point
    alpha, gamma = Fraction(pair.alpha), Fraction(pair.gamma)
    return (u * u + v * v) / (alpha * alpha) - (w / gamma) ** 2 - 1


def reach_of_point(pair: Pair, point: Point) -> Fraction:
    """s, the squared distance of a point from the spheroid's centre in spheroid radii: at most 1 in the spheroid."""
    way = [coordinate - Fraction(center) for coordinate, center in zip(point, (pair.x, pair.y, pair.z), strict=True)]
    axis = [Fraction(each) for each in pair.axis]
    square = sum((each * each for each in way), Fraction(0))
    along = sum((a * b for a, b in zip(way, axis, strict=True)), Fraction(0)) ** 2 / sum(each * each for each in axis)
    return (square - along) / Fraction(pair.b) ** 2 + along / Fraction(pair.d) ** 2


def answer_as_json(answer: Answer) -> str:
    """The answer as one JSON object on one line, rationals as strings such as "3/2", what is infinite as "inf"."""
    decision, (low, high) = answer.decision, distance_of(answer.pair)
    return json.dumps(
        {
            "position": int(decision.position),
            "label": decision.position.label,
            "tangent": decision.tangent,
            "distance_lower": _as_json(low),
            "distance_upper": _as_json(high),
            "clearance": _as_json(answer.clearance),
            "kind": None if decision.kind is None else decision.kind.value,
            **_margin_as_json(answer),
            "proof": proof_as_json(answer.pair, answer.certificate),
        }
    )


def _margin_as_json(answer: Answer) -> dict[str, Any]:
    if answer.margin is None or answer.with_margin is None:
        return {}
    return {"margin": answer.margin, "position_with_margin": int(answer.with_margin)}


def _as_json(number: float) -> float | str:
    return number if number != float("inf") else "inf"


def distance_of(pair: Pair) -> tuple[float, float]:
    """Proved bounds of the Euclidean distance, in the unit of the lengths, of ten digits: 0 and 0 in contact."""
    low, high = _distance_in_c(pair) or _distance_by_arrays(pair)
    low, high = low if low >= 0 else 0.0, high if high >= 0 else float("inf")  # NaN is not known
    return _ten_digits(low, ROUND_FLOOR), _ten_digits(high, ROUND_CEILING)


def _distance_in_c(pair: Pair) -> tuple[float, float] | None:
    """The same of an upright pair without ends, and without numpy; None where C is not there, or knows it worse."""
    if choice().kernel == "numpy" or pair.has_ends or not pair.is_upright:
        return None
    position, found = array("b", [0]), array("d", [0.0] * 11)
    compiled().clearance(array("d", pair.upright.row), position, found)
    _, _, touch_error, low, high, *_ = found
    return None if touch_error == sys.float_info.max else (low, high)


def _distance_by_arrays(pair: Pair) -> tuple[float, float]:
    from hypcheck.kernel.clearance import clearance  # noqa: PLC0415 - it loads numpy

    near = clearance(pair.row)
    return float(near.distance_lower), float(near.distance_upper)


def _ten_digits(number: float, rounding: str) -> float:
    """The number rounded towards a side, so that the last digits of a guess do not show; no farther than a float."""
    return float(Context(prec=10, rounding=rounding).create_decimal(Decimal(number)))


def proof_as_json(pair: Pair, certificate: Certificate) -> dict[str, Any]:
    """A certificate about a pair, and the numbers that check it, as values for JSON."""
    if pair.has_ends:
        return _ended_proof_as_json(pair, certificate)
    if not pair.is_upright:
        return _tilted_proof_as_json(pair, certificate)
    squares = PairSquares.of(pair)
    if certificate.multiplier is not None:
        outside = certificate.position is Position.EXTERIOR
        return {
            "by": "multiplier",
            "lambda": exact_text(certificate.multiplier),
            "between": ["0", exact_text(squares.B)] if outside else [exact_text(-squares.A), "0"],
            **_squares_as_json(squares),
            "g": exact_text(squares.g(certificate.multiplier)),
        }
    if certificate.double_root is not None:
        return {
            "by": "double root",
            "m": exact_text(certificate.double_root),
            "third_root": exact_text(squares.third_root(certificate.double_root)),
            **_squares_as_json(squares),
        }
    return _points_as_json(pair, certificate.points)


def _ended_proof_as_json(pair: Pair, certificate: Certificate) -> dict[str, Any]:
    """The same where the hyperboloid ends."""
    if certificate.points:
        return _points_as_json(pair, certificate.points)
    if certificate.multiplier is not None:
        return {"by": "multiplier", "lambda": exact_text(certificate.multiplier)}
    if certificate.pieces:
        return {"by": "pieces", "pieces": [_piece_as_json(piece) for piece in certificate.pieces]}
    return {"by": "rule in the height"}


def _piece_as_json(piece: Piece) -> dict[str, str]:
    low, high = piece.low, piece.high
    return {
        "low": "-inf" if low is None else exact_text(low),
        "high": "inf" if high is None else exact_text(high),
        "lambda": exact_text(piece.multiplier),
        "mu": exact_text(piece.plane),
    }


def _tilted_proof_as_json(pair: Pair, certificate: Certificate) -> dict[str, Any]:
    """The same where the axis leans: pivots of S + λH, or the quartic f of a double root and pivots of M + mD."""
    if certificate.multiplier is not None:
        pivots = _pivots(pair, certificate.multiplier, 4)
        return {
            "by": "multiplier",
            "lambda": exact_text(certificate.multiplier),
            "pivots": list(map(exact_text, pivots)),
        }
    if certificate.double_root is not None:
        m = certificate.double_root
        return {
            "by": "double root",
            "m": exact_text(m),
            "f": [exact_text(each) for each in _quartic(pair)],
            "pivots": list(map(exact_text, _pivots(pair, m, 3))),
        }
    return _points_as_json(pair, certificate.points)


def _pivots(pair: Pair, at: Fraction, size: int) -> list[Fraction]:
    """The pivots of the first rows and columns of S + λH."""
    S, H = surfaces(pair)
    both = [[a + at * b for a, b in zip(*rows, strict=True)][:size] for rows in zip(S, H, strict=True)][:size]
    return pivots(both)


def _quartic(pair: Pair) -> list[Fraction]:
    """f(λ) = det(S + λH) over det S, the lowest power first: the whole numbers of truth/pencil.py, so scaled."""
    F = quartic(pair.lengths)
    lowest_first = [each * F.side**power for power, each in enumerate(reversed(F.coefficients))]
    return [Fraction(each, -F.f0) for each in lowest_first]


def _points_as_json(pair: Pair, points: tuple[Point, ...]) -> dict[str, Any]:
    return {"by": "points", "points": [_point_as_json(pair, point) for point in points]}


def _point_as_json(pair: Pair, point: Point) -> dict[str, str]:
    named = dict(zip(("x", "y", "z"), map(exact_text, point), strict=True))
    return named | {"h": exact_text(height_of_point(pair, point)), "s": exact_text(reach_of_point(pair, point))}


def _squares_as_json(squares: PairSquares) -> dict[str, str]:
    return {name: exact_text(getattr(squares, name)) for name in "ABPQ"}


def answer_as_text(answer: Answer) -> str:
    """The answer as lines of text, without an end of line after the last: position, clearance, kind, proof."""
    decision, clearance = answer.decision, answer.clearance
    radii = f"{repr(clearance).removesuffix('.0')} spheroid {'radius' if clearance == 1 else 'radii'}"
    proof = proof_lines(answer.pair, answer.certificate)
    lines = [
        decision.position.label + ", tangent" * decision.tangent,
        *_margin_lines(answer),
        f"distance   {_distance_as_text(*distance_of(answer.pair))}",
        f"clearance  {radii} ({_meaning(clearance)})",
        *([] if decision.kind is None else [f"kind       {kind_as_text(decision.kind)}"]),
        f"proof      {proof[0]}",
        *(f"{'':11}{line}" for line in proof[1:]),
    ]
    return "\n".join(lines)


def _margin_lines(answer: Answer) -> Iterator[str]:
    if answer.margin is None or answer.with_margin is None:
        return
    proof = "is not proved" if answer.with_margin is Position.CONTACT else "is proved"
    length = repr(answer.margin).removesuffix(".0")
    yield f"margin     {answer.with_margin.label}: a distance of at least {length} {proof}"


def _distance_as_text(low: float, high: float) -> str:
    if high == 0:
        return "0"
    if high == float("inf"):
        return f"{low:.9g} or more, in the unit of the lengths"
    known = high - low <= 1e-8 * high
    value = f"{low + (high - low) / 2:.8g}" if known else f"{low:.8g} to {high:.8g}"
    return f"{value}, in the unit of the lengths (proved: from {low!r} to {high!r})"


def _meaning(clearance: float) -> str:
    if clearance == float("inf"):
        return "too large for float64; scaled about its centre by 1 + clearance, the spheroid would just touch"
    if clearance == -1:
        return "its centre lies on the hyperboloid"
    return "scaled about its centre by 1 + clearance, the spheroid would just touch the hyperboloid"


def kind_as_text(kind: Kind) -> str:
    """The name of a kind and its meaning, on one line."""
    return f"{kind.value}: {kind.description[0].lower()}{kind.description[1:].rstrip('.')}"


def proof_lines(pair: Pair, certificate: Certificate) -> list[str]:
    """A certificate about a pair as lines of text, and how to check it by hand."""
    if pair.has_ends:
        return _with_note(_ended_proof_lines(pair, certificate))
    if not pair.is_upright:
        return _tilted_proof_lines(pair, certificate)
    if certificate.multiplier is not None:
        lines = _by_multiplier(pair, certificate.position, certificate.multiplier)
    elif certificate.double_root is not None:
        lines = _by_double_root(pair, certificate.double_root)
    else:
        lines = [*_by_points(pair, certificate.points), f"{_HEIGHT}, s = ((x−x₀)²+(y−y₀)²)/b² + (z−z₀)²/d², {_CENTER}."]
    return _with_note(lines)


_HEIGHT = "where h = (x²+y²)/α² − z²/γ² − 1"
_CENTER = "centre (x₀, y₀, z₀)"


def _with_note(lines: list[str]) -> list[str]:
    rounded = any("≈" in line for line in lines)
    return [*lines, *(["≈ marks a rounded number; --json gives all of them exactly."] if rounded else [])]


_FORMS = "S is the matrix of (X−C)ᵀM(X−C) − 1, H that of (x²+y²)/α² − z²/γ² − 1"


def _ended_proof_lines(pair: Pair, certificate: Certificate) -> list[str]:
    matrix = "M = I/b² + (1/d² − 1/b²)·v·vᵀ/(v·v), v the axis"
    if certificate.points:
        head = "one in the solid body, one not in its inner part" if pair.solid else "h > 0 and h < 0, between the ends"
        first = f"two points of the spheroid (s ≤ 1), {head}, so that they meet:"
        return [first, *_point_lines(pair, certificate.points), f"{_HEIGHT}, s = (X−C)ᵀM(X−C), {matrix}."]
    if certificate.multiplier is not None:
        return [
            f"λ {equals_text(certificate.multiplier)} makes S + λH positive definite, so that the spheroid misses all",
            "of the surface, with or without ends; the heights of the spheroid and its centre say the rest.",
            f"{_FORMS}, {matrix}.",
        ]
    if certificate.pieces:
        count = counted(len(certificate.pieces), "piece")
        return [
            f"the heights are cut into {count}, each with numbers λ and μ for which S + λH + μZ is positive",
            "definite, so that the spheroid misses that part; Z = (z−low)(z−high), or low−z, or z−high:",
            *(_piece_line(piece) for piece in certificate.pieces),
            f"{_FORMS}, {matrix}.",
        ]
    return [
        "no point can be written in rational numbers that shows this contact: it is a touch, or too near to one. The",
        'rule in the height decides it in integers (docs/mathematics.md, "Towers that end").',
    ]


def _piece_line(piece: Piece) -> str:
    low = "−∞" if piece.low is None else readable_text(piece.low)
    high = "∞" if piece.high is None else readable_text(piece.high)
    return f"from {low} to {high}: λ {equals_text(piece.multiplier)}, μ {equals_text(piece.plane)}"


def _tilted_proof_lines(pair: Pair, certificate: Certificate) -> list[str]:
    matrix = "M = I/b² + (1/d² − 1/b²)·v·vᵀ/(v·v), v the axis"
    if certificate.multiplier is not None:
        at, side = certificate.multiplier, "above" if certificate.multiplier > 0 else "below"
        return _with_note(
            [
                f"λ {equals_text(at)} is {side} 0, and S + λH is positive definite;",
                f"any such λ proves {certificate.position.label}. By hand, elimination leaves pivots above 0:",
                ", ".join(map(readable_text, _pivots(pair, at, 4))),
                "where S is the matrix of (X−C)ᵀM(X−C) − 1, H that of (x²+y²)/α² − z²/γ² − 1,",
                f"{matrix}.",
            ]
        )
    if certificate.double_root is not None:
        m, pivots = certificate.double_root, _pivots(pair, certificate.double_root, 3)
        at_pole = "" if all(pivots) else " and f″(m) ≤ 0"
        return _with_note(
            [
                f"m {equals_text(m)} is a double root of f, and M + mD has pivots that are not below 0:",
                ", ".join(map(readable_text, pivots)),
                f"this proves that the surfaces touch. By hand, f(m) = f′(m) = 0{at_pole}, where up to a factor",
                f"f(t) = det(S + tH) = {_polynomial(_quartic(pair))},",
                "S is the matrix of (X−C)ᵀM(X−C) − 1, H that of (x²+y²)/α² − z²/γ² − 1, D = diag(1/α², 1/α², −1/γ²),",
                f"{matrix}.",
            ]
        )
    by_hand = f"{_HEIGHT}, s = (X−C)ᵀM(X−C), {matrix}."
    return _with_note([*_by_points(pair, certificate.points), by_hand])


def _polynomial(coefficients: list[Fraction]) -> str:
    powers = ("", "·t", "·t²", "·t³", "·t⁴")
    return " + ".join(f"({readable_text(each)}){power}" for each, power in zip(coefficients, powers, strict=True))


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
    on_hyperboloid = [point for point in points if height_of_point(pair, point) == 0][:1]
    if on_hyperboloid:
        lines = ["a point of the spheroid (s ≤ 1) lies on the hyperboloid (h = 0):"]
    else:
        lines = [
            "two points of the spheroid (s ≤ 1) lie on different sides of the hyperboloid, outside (h > 0) and",
            "inside (h < 0), so the surfaces meet:",
        ]
    return [*lines, *_point_lines(pair, on_hyperboloid or points)]


def _point_lines(pair: Pair, points: Sequence[Point]) -> list[str]:
    return [
        f"({', '.join(map(readable_text, point))}) has s {equals_text(reach_of_point(pair, point))} and h "
        f"{equals_text(height_of_point(pair, point))},"
        for point in points
    ]
