"""The oracle by roots: where the roots of g stand to −A, 0 and B says how the surfaces stand to each other.

After [10], re-derived; its text was not consulted. The pencil of the two quadrics' matrices, det(λH + S), is
(A + λ) g(λ) / (A² B) with the cubic g of equation (12) (docs/mathematics.md, "Root patterns and relative position").
Everything is exact: coefficients and comparisons are rational, multiplicities come from gcd(g, g′), roots at −A and B
are recognised and divided out, the others are enclosed in intervals, and the finished enclosures are proved by changes
of sign before they are believed. A pattern that the table does not list is an error of ours, never an answer.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.pairs import Pair, Position
from hypcheck.truth.kinds import Kind
from hypcheck.truth.roots_isolation import (
    Interval,
    Polynomial,
    divided_by_root,
    isolate,
    linear_factor,
    primitive,
    product,
    prove,
    sturm_chain,
    value,
)
from hypcheck.truth.roots_patterns import COMPLEX, KIND_OF, Place, pattern_of, same_signs


@dataclass(frozen=True, slots=True)
class Root:
    """One distinct real root of g: strictly between `lower` and `upper`, or equal to both where they are equal."""

    lower: Fraction
    upper: Fraction
    multiplicity: int
    place: Place


@dataclass(frozen=True, slots=True)
class RootReport:
    """What the roots of g say. `roots` are the distinct real ones in ascending order, their enclosures disjoint.

    `pattern` is their places and multiplicities as the table writes them; with `complex_pair` two roots are complex.
    `literal_kinds` is what signs and multiplicities alone leave possible for these sizes, without comparing any root
    with −A or B; `literal` is the one position they have in common, or None: ambiguous.
    """

    position: Position
    tangent: bool
    kind: Kind
    roots: tuple[Root, ...]
    pattern: str
    complex_pair: bool
    literal: Position | None
    literal_kinds: tuple[Kind, ...]


@dataclass(frozen=True, slots=True)
class Invariants:
    """All that matters of a pair once space is scaled to make the spheroid the unit sphere (Theorem 1 of the paper).

    A = (α/b)² > 0 and B = (γ/d)² > 0; P = (x² + y²)/b² ≥ 0 and Q = (z/d)² ≥ 0.
    """

    A: Fraction
    B: Fraction
    P: Fraction
    Q: Fraction

    @classmethod
    def of(cls, pair: Pair) -> Invariants:
        """The invariants of a pair, exactly."""
        lengths = pair.lengths
        q, t = lengths.b**2, lengths.d**2
        return cls(
            A=Fraction(lengths.alpha**2, q),
            B=Fraction(lengths.gamma**2, t),
            P=Fraction(lengths.x**2 + lengths.y**2, q),
            Q=Fraction(lengths.z**2, t),
        )


def classify_by_roots(pair: Pair) -> RootReport:
    """The position and kind of a pair, by the roots of g.

    Raises AssertionError, naming the pair, where a proof fails or the pattern is not in the table: an error of ours.
    """
    try:
        return classify_invariants(Invariants.of(pair))
    except AssertionError as error:
        raise AssertionError(f"{error}, for {pair}") from error


def classify_invariants(pair: Invariants) -> RootReport:
    """The same for a pair given by its invariants, which need not be those of float64 numbers."""
    roots = real_roots(pair)
    pattern = pattern_of((root.place, root.multiplicity) for root in roots)
    occurs = _occurs(pair)
    possible = [kind for kind in Kind if occurs[kind.occurs]]
    kind = KIND_OF.get(pattern)
    if kind not in possible:
        raise AssertionError(f"the roots of g form a pattern that is not possible: {pattern}")
    literal_kinds = same_signs(pattern, possible)
    literal = {other.position for other in literal_kinds}
    return RootReport(
        position=kind.position,
        tangent=kind.tangent,
        kind=kind,
        roots=roots,
        pattern=pattern,
        complex_pair=pattern.endswith(COMPLEX),
        literal=literal.pop() if len(literal) == 1 else None,
        literal_kinds=literal_kinds,
    )


def _occurs(pair: Invariants) -> dict[str, bool]:
    """Which of the conditions in Kind.occurs hold: a < 1 ⟺ A < 1, and c² < a ⟺ B² < A."""
    square = pair.B**2
    return {
        "always": True,
        "a < 1": pair.A < 1,
        "a ≤ 1": pair.A <= 1,
        "c² < a": square < pair.A,
        "c² = a": square == pair.A,
        "c² > a": square > pair.A,
    }


def coefficients(pair: Invariants) -> Polynomial:
    """A positive multiple of g in coprime integers, from the definition.

    g(λ) = (A + λ)(B − λ)(P + Q − 1 − λ) − A P (B − λ) − B Q (A + λ), here with A = p/q, P = R/q, B = s/t, Q = S/t and
    multiplied by q² t².
    """
    q = math.lcm(pair.A.denominator, pair.P.denominator)
    t = math.lcm(pair.B.denominator, pair.Q.denominator)
    p, R = int(pair.A * q), int(pair.P * q)
    s, S = int(pair.B * t), int(pair.Q * t)
    radial, axial, last = (q, p), (-t, s), (-q * t, R * t + S * q - q * t)
    cubic = product(product(radial, axial), last)
    linear = [p * R * t * axial[i] + s * S * q * radial[i] for i in range(2)]
    return primitive([cubic[0], cubic[1], cubic[2] - linear[0], cubic[3] - linear[1]])


def real_roots(pair: Invariants) -> tuple[Root, ...]:
    """The distinct real roots of g in ascending order: proved, multiplicities and places exact."""
    g = coefficients(pair)
    known, rest = _divided_by_known_roots(g, (-pair.A, pair.B, *_repeated_root(g)))
    enclosed = isolate(rest, (-pair.A, pair.B))
    prove(rest, enclosed)
    _require_factors(g, known, rest)
    intervals = [((x, x), multiplicity) for x, multiplicity in known.items()]
    intervals += [(interval, 1) for interval in enclosed]
    # Two enclosures may share an end, and a known root may be that end: sorted by their middles they stand in order.
    intervals.sort(key=lambda item: item[0][0] + item[0][1])
    return tuple(
        Root(*interval, multiplicity=multiplicity, place=_place(interval, pair)) for interval, multiplicity in intervals
    )


def _repeated_root(g: Polynomial) -> list[Fraction]:
    """The double or triple root m of a cubic, if it has one, from gcd(g, g′) = λ − m or (λ − m)²."""
    common = sturm_chain(g)[-1]
    degree = len(common) - 1
    return [Fraction(-common[1], degree * common[0])] if degree else []


def _divided_by_known_roots(g: Polynomial, candidates: tuple[Fraction, ...]) -> tuple[dict[Fraction, int], Polynomial]:
    """The multiplicities of those candidates that are roots, and g without these roots; a last linear factor is known.

    The rest has degree 0, 2 or 3, is squarefree when all repeated roots were candidates, and has no candidate as root.
    """
    known: dict[Fraction, int] = {}
    for x in candidates:
        while len(g) > 1 and value(g, x) == 0:
            g = divided_by_root(g, x)
            known[x] = known.get(x, 0) + 1
    if len(g) == 2:
        x = Fraction(-g[1], g[0])
        g = divided_by_root(g, x)
        known[x] = known.get(x, 0) + 1
    return known, g


def _require_factors(g: Polynomial, known: Mapping[Fraction, int], rest: Polynomial) -> None:
    """Raise AssertionError unless g is the product of the known roots' linear factors and the rest."""
    factored = rest
    for x, multiplicity in known.items():
        for _ in range(multiplicity):
            factored = product(factored, linear_factor(x))
    if factored != g:
        raise AssertionError("the roots of g found exactly and the rest do not multiply to g")


def _place(interval: Interval, pair: Invariants) -> Place:
    """The place of the root in an interval that none of −A, 0 and B divides."""
    lower, upper = interval
    if lower == upper and lower in (-pair.A, pair.B):
        return Place.AT_B if lower > 0 else Place.AT_MINUS_A
    if upper <= -pair.A:
        return Place.BELOW
    if lower >= -pair.A and upper <= 0:
        return Place.INNER
    if lower >= 0 and upper <= pair.B:
        return Place.OUTER
    if lower >= pair.B:
        return Place.ABOVE
    raise AssertionError("−A, 0 or B lies inside the enclosure of a root of g")
