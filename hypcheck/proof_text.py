"""A certificate about a pair, or a sweep, as JSON and as lines of text, with the numbers that check it by hand.

docs/mathematics.md, "A certificate for every answer", explains the numbers. S and H are the matrices of the spheroid
and of the hyperboloid. A = (α/b)², B = (γ/d)², P = (x² + y²)/b² and Q = (z/d)² determine the position of an upright
pair, and g is its cubic (equation (12) of the paper). λ is a multiplier and m a double root, as in
truth/certificate.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from hypcheck.geometry.pair import Pair, Position
from hypcheck.messages import counted
from hypcheck.tables.numbers import equals_text, exact_text, readable_text
from hypcheck.truth.certificate import Certificate, PassageCertificate, Piece, Point, pivots, surfaces
from hypcheck.truth.pencil import quartic


def is_rule(certificate: Certificate) -> bool:
    """Return whether only the exact rule proves a contact with a hyperboloid that ends, without a witness."""
    return certificate.position is Position.CONTACT and not certificate.points and certificate.double_root is None


@dataclass(frozen=True, slots=True)
class PairSquares:
    """A = (α/b)², B = (γ/d)², P = (x²+y²)/b² and Q = (z/d)² of a pair. Its position depends on nothing else."""

    A: Fraction
    B: Fraction
    P: Fraction
    Q: Fraction

    @classmethod
    def of(cls, pair: Pair) -> PairSquares:
        """Compute the four numbers of a pair exactly."""
        alpha, gamma, b, d, x, y, z = map(Fraction, pair.row[:7])
        return cls((alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2)

    def g(self, at: Fraction) -> Fraction:
        """Evaluate the cubic of equation (12) of the paper, as repaired."""
        A, B, P, Q = self.A, self.B, self.P, self.Q
        return (A + at) * (B - at) * (P + Q - 1 - at) - A * P * (B - at) - B * Q * (A + at)

    def third_root(self, double: Fraction) -> Fraction:
        """Return the third root of g, if `double` is a double root.

        The sum of all three roots is −c2, where c2 is the coefficient of λ² in g.
        """
        return self.B + self.P + self.Q - self.A - 1 - 2 * double


def height_of_point(pair: Pair, point: Point) -> Fraction:
    """Compute h = (x²+y²)/α² − z²/γ² − 1 of a point: above 0 outside the hyperboloid, below 0 inside, 0 on it."""
    u, v, w = point
    alpha, gamma = Fraction(pair.alpha), Fraction(pair.gamma)
    return (u * u + v * v) / (alpha * alpha) - (w / gamma) ** 2 - 1


def reach_of_point(pair: Pair, point: Point) -> Fraction:
    """Compute s, the squared distance of a point from the spheroid's centre in spheroid radii: at most 1 inside."""
    offset = [coordinate - Fraction(center) for coordinate, center in zip(point, (pair.x, pair.y, pair.z), strict=True)]
    axis = [Fraction(number) for number in pair.axis]
    square = sum((number * number for number in offset), Fraction(0))
    along = sum((a * b for a, b in zip(offset, axis, strict=True)), Fraction(0)) ** 2 / sum(
        number * number for number in axis
    )
    return (square - along) / Fraction(pair.b) ** 2 + along / Fraction(pair.d) ** 2


def proof_as_json(pair: Pair, certificate: Certificate) -> dict[str, Any]:
    """Return a certificate about a pair, and the numbers that check it, as values for JSON.

    The key "by" names the kind of proof. "rule in the height" has no numbers: it is a contact with a hyperboloid that
    ends, at which no rational point can be named. The exact rule in the height decided it in integers, and there is
    nothing to check by hand.
    """
    if certificate.points:
        return {"by": "points", "points": [_point_as_json(pair, point) for point in certificate.points]}
    if certificate.pieces:
        return {"by": "pieces", "pieces": [_piece_as_json(piece) for piece in certificate.pieces]}
    if certificate.multiplier is not None:
        numbers = _numbers_of_multiplier(pair, certificate.position, certificate.multiplier)
        return {"by": "multiplier", "lambda": exact_text(certificate.multiplier), **numbers}
    if certificate.double_root is not None:
        numbers = _numbers_of_double_root(pair, certificate.double_root)
        return {"by": "double root", "m": exact_text(certificate.double_root), **numbers}
    return {"by": "rule in the height"}


def _numbers_of_multiplier(pair: Pair, position: Position, at: Fraction) -> dict[str, Any]:
    """Return the numbers that check a multiplier λ = `at`, for JSON.

    For an upright pair they are the interval in which λ must lie, A, B, P, Q and g(λ); for a tilted one the pivots of
    S + λH. There are none if the hyperboloid ends.
    """
    if pair.has_ends:
        return {}
    if not pair.is_upright:
        return {"pivots": list(map(exact_text, _pivots(pair, at, 4)))}
    squares = PairSquares.of(pair)
    between = (Fraction(0), squares.B) if position is Position.EXTERIOR else (-squares.A, Fraction(0))
    return {"between": list(map(exact_text, between)), **_squares_as_json(squares), "g": exact_text(squares.g(at))}


def _numbers_of_double_root(pair: Pair, m: Fraction) -> dict[str, Any]:
    """Return the numbers that check a double root m, for JSON.

    For an upright pair they are the third root of g, and A, B, P, Q; for a tilted one the coefficients of the quartic
    f(λ) = det(S + λH) and the pivots of M + mD, M and D being the upper 3×3 parts of S and H.
    """
    if not pair.is_upright:
        return {
            "f": list(map(exact_text, _quartic(pair))),
            "pivots": list(map(exact_text, _pivots(pair, m, 3))),
        }
    squares = PairSquares.of(pair)
    return {"third_root": exact_text(squares.third_root(m)), **_squares_as_json(squares)}


def _piece_as_json(piece: Piece) -> dict[str, str]:
    low, high = piece.low, piece.high
    return {
        "low": "-inf" if low is None else exact_text(low),
        "high": "inf" if high is None else exact_text(high),
        "lambda": exact_text(piece.multiplier),
        "mu": exact_text(piece.plane),
    }


def _pivots(pair: Pair, at: Fraction, size: int) -> list[Fraction]:
    """Eliminate in S + λH, λ = `at`, and return the pivots of the first `size` rows and columns."""
    S, H = surfaces(pair)
    both = [[a + at * b for a, b in zip(*rows, strict=True)][:size] for rows in zip(S, H, strict=True)][:size]
    return pivots(both)


def _quartic(pair: Pair) -> list[Fraction]:
    """Return the coefficients of f(λ) = det(S + λH) divided by det S, the lowest power first."""
    F = quartic(pair.lengths)
    lowest_first = [coefficient * F.side**power for power, coefficient in enumerate(reversed(F.coefficients))]
    return [Fraction(number, -F.f0) for number in lowest_first]


def _point_as_json(pair: Pair, point: Point) -> dict[str, str]:
    """Return a point with its h (height_of_point) and s (reach_of_point), for JSON."""
    named = dict(zip(("x", "y", "z"), map(exact_text, point), strict=True))
    return named | {"h": exact_text(height_of_point(pair, point)), "s": exact_text(reach_of_point(pair, point))}


def _squares_as_json(squares: PairSquares) -> dict[str, str]:
    return {name: exact_text(getattr(squares, name)) for name in "ABPQ"}


def proof_lines(pair: Pair, certificate: Certificate) -> list[str]:
    """Return a certificate about a pair as lines of text, and how to check it by hand."""
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
_FORMS = "S is the matrix of (X−C)ᵀM(X−C) − 1, H that of (x²+y²)/α² − z²/γ² − 1"
_MATRIX = "M = I/b² + (1/d² − 1/b²)·v·vᵀ/(v·v), v the axis"


def _with_note(lines: list[str]) -> list[str]:
    """Add a line that explains ≈ if a line has it."""
    rounded = any("≈" in line for line in lines)
    return [*lines, *(["≈ marks a rounded number; --json gives all of them exactly."] if rounded else [])]


def _ended_proof_lines(pair: Pair, certificate: Certificate) -> list[str]:
    """Return the lines of a certificate about a pair whose hyperboloid ends."""
    if certificate.points:
        head = "one in the solid body, one not in its inner part" if pair.solid else "h > 0 and h < 0, between the ends"
        first = f"two points of the spheroid (s ≤ 1), {head}, so that they meet:"
        return [first, *_point_lines(pair, certificate.points), f"{_HEIGHT}, s = (X−C)ᵀM(X−C), {_MATRIX}."]
    if certificate.multiplier is not None:
        return [
            f"λ {equals_text(certificate.multiplier)} makes S + λH positive definite, so that the spheroid misses all",
            "of the surface, with or without ends; the heights of the spheroid and its centre say the rest.",
            f"{_FORMS}, {_MATRIX}.",
        ]
    if certificate.pieces:
        count = counted(len(certificate.pieces), "piece")
        return [
            f"the heights are cut into {count}, each with numbers λ and μ for which S + λH + μZ is positive",
            "definite, so that the spheroid misses that part; Z = (z−low)(z−high), or low−z, or z−high:",
            *(_piece_line(piece) for piece in certificate.pieces),
            f"{_FORMS}, {_MATRIX}.",
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
    """Return the lines of a certificate about a tilted pair without ends."""
    if certificate.multiplier is not None:
        at, side = certificate.multiplier, "above" if certificate.multiplier > 0 else "below"
        return _with_note(
            [
                f"λ {equals_text(at)} is {side} 0, and S + λH is positive definite;",
                f"any such λ proves {certificate.position.label}. By hand, elimination leaves pivots above 0:",
                ", ".join(map(readable_text, _pivots(pair, at, 4))),
                f"where {_FORMS},",
                f"{_MATRIX}.",
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
                f"{_FORMS}, D = diag(1/α², 1/α², −1/γ²),",
                f"{_MATRIX}.",
            ]
        )
    by_hand = f"{_HEIGHT}, s = (X−C)ᵀM(X−C), {_MATRIX}."
    return _with_note([*_by_points(pair, certificate.points), by_hand])


def _polynomial(coefficients: list[Fraction]) -> str:
    """Return the text of a polynomial in t; the coefficients begin with the lowest power."""
    powers = ("", "·t", "·t²", "·t³", "·t⁴")
    return " + ".join(
        f"({readable_text(coefficient)}){power}" for coefficient, power in zip(coefficients, powers, strict=True)
    )


def _by_multiplier(pair: Pair, position: Position, at: Fraction) -> list[str]:
    """Return the lines that prove a clear position of an upright pair by a multiplier λ = `at`."""
    squares = PairSquares.of(pair)
    interval = "(0, B)" if position is Position.EXTERIOR else "(−A, 0)"
    return [
        f"λ {equals_text(at)} lies in {interval} and g(λ) {equals_text(squares.g(at))} is above 0;",
        f"any such λ proves {position.label}. By hand:",
        *_definitions(squares),
    ]


def _by_double_root(pair: Pair, m: Fraction) -> list[str]:
    """Return the lines that prove a tangency of an upright pair by a double root m."""
    squares = PairSquares.of(pair)
    interval = "(0, B]" if m > 0 else "[−A, 0)"
    end = f", and the third root, {readable_text(squares.third_root(m))}, is not below B" if m == squares.B else ""
    return [
        f"m {equals_text(m)} is a double root of g in {interval}{end};",
        "this proves that the surfaces touch. By hand, g(m) = g′(m) = 0:",
        *_definitions(squares),
    ]


def _definitions(squares: PairSquares) -> list[str]:
    """Return the lines with g, A, B, P and Q."""
    return [
        "g(t) = (A+t)(B−t)(P+Q−1−t) − A·P·(B−t) − B·Q·(A+t), where",
        f"A = (α/b)² {equals_text(squares.A)}, B = (γ/d)² {equals_text(squares.B)},",
        f"P = (x₀²+y₀²)/b² {equals_text(squares.P)}, Q = (z₀/d)² {equals_text(squares.Q)}, centre (x₀, y₀, z₀).",
    ]


def _by_points(pair: Pair, points: tuple[Point, ...]) -> list[str]:
    """Return the lines that prove a contact by one point on the hyperboloid, or by two points on both sides of it."""
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


def passage_proof_as_json(certificate: PassageCertificate) -> dict[str, Any]:
    """Return a certificate about a sweep as values for JSON."""
    time, root = certificate.time, certificate.double_root
    return {
        "pieces": [list(map(exact_text, piece)) for piece in certificate.pieces],
        "time": None if time is None else exact_text(time),
        "points": [list(map(exact_text, point)) for point in certificate.points],
        "double_root": None if root is None else exact_text(root),
    }


_MOST_PIECES = 4
"""The most pieces of a proof that the text shows."""


def passage_proof_lines(certificate: PassageCertificate | None, *, ended: bool = False) -> Iterator[str]:
    """Yield a certificate about a sweep as lines of text; there is none if the hyperboloid ends."""
    if ended:
        yield "none is written if the hyperboloid ends: the times are decided in integers (docs/motion.md)."
        return
    if certificate is None:
        yield "none in rational numbers: the surfaces touch only at an irrational time"
        return
    for at, end in certificate.pieces[:_MOST_PIECES]:
        yield f"λ {equals_text(at)} proves the sweep clear up to the time {readable_text(end)};"
    if more := len(certificate.pieces[_MOST_PIECES:]):
        until = readable_text(certificate.pieces[-1][1])
        yield f"{counted(more, 'piece')} more up to the time {until} (--json has all);"
    if certificate.time is None:
        yield "so it is clear all along: det(S + λH) > 0 on the piece of each λ (docs/motion.md)."
        return
    time = readable_text(certificate.time)
    if certificate.double_root is not None:
        yield f"at the time {time} the surfaces touch: m {equals_text(certificate.double_root)} is a double root."
        return
    yield f"at the time {time} the spheroid has these points, on both sides of the hyperboloid or on it:"
    yield ", ".join(f"({', '.join(map(readable_text, point))})" for point in certificate.points) + "."
