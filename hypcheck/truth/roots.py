"""The roots oracle for upright spheroids: the places of the roots of g beside −A, 0 and B, and what they mean.

After [10], re-derived; its text was not consulted. The pencil of the two quadrics' matrices, det(λH + S), is
(A + λ) g(λ) / (A² B) with the cubic g of equation (12) (docs/mathematics.md, "Root patterns and relative position").
Everything is exact and no root is approximated: multiplicities come from gcd(g, g′), roots at −A and B are recognised
and divided out, a multiple root and what it leaves are rational, and simple ones are counted between −A, 0 and B by
Sturm's theorem. A pattern that the table does not list is a fault of this program, never an answer.

The table can also be read literally, by the roots' signs and multiplicities alone; some patterns then fall together.
tilted_roots.py has the same for spheroids whose axis may point anywhere.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from itertools import chain, combinations_with_replacement, groupby, product
from types import MappingProxyType
from typing import TypeVar

from hypcheck.geometry.pair import Pair, Position
from hypcheck.truth.kinds import Kind
from hypcheck.truth.polynomial_roots import roots_between, sturm_chain
from hypcheck.truth.polynomials import Polynomial, divided_by_root, polynomial_product, primitive, value

COMPLEX = "complex"
"""The word of a pattern for a pair of complex roots."""


class RootPlace(Enum):
    """The place of a root relative to −A, 0 and B; 0 itself is never a root, since g(0) = −A B."""

    BELOW = "<−A"
    AT_MINUS_A = "−A"
    INNER = "(−A,0)"
    OUTER = "(0,B)"
    AT_B = "B"
    ABOVE = ">B"


PATTERNS: Mapping[Kind, tuple[str, ...]] = MappingProxyType(
    {
        Kind.INTERIOR: ("(−A,0) (−A,0) B", "(−A,0) (−A,0) >B", "−A (−A,0) B", "−A (−A,0) >B"),
        Kind.INTERIOR_TANGENT_POINT: ("(−A,0)² B", "(−A,0)² >B"),
        Kind.INTERIOR_TANGENT_CIRCLE: ("−A² B", "−A² >B"),
        Kind.CROSSING_THROAT_TWO_CURVES: ("<−A <−A B", "<−A <−A >B", "<−A −A B", "<−A −A >B"),
        Kind.CROSSING_THROAT_NODE: ("<−A² B", "<−A² >B"),
        Kind.CROSSING_ONE_CURVE: ("B complex", ">B complex"),
        Kind.EXTERIOR: ("(0,B) (0,B) B", "(0,B) (0,B) >B", "(0,B) B >B"),
        Kind.EXTERIOR_RING: ("(0,B) B²",),
        Kind.EXTERIOR_TANGENT_POINT: ("(0,B)² B", "(0,B)² >B"),
        Kind.EXTERIOR_TANGENT_TWO_POINTS: ("B² >B",),
        Kind.EXTERIOR_TANGENT_OSCULATING: ("B³",),
        Kind.CROSSING_GROOVE_TWO_CURVES: ("B >B >B", ">B >B >B"),
        Kind.CROSSING_GROOVE_ISOLATED_POINT: (">B² >B",),
        Kind.CROSSING_GROOVE_NODE: ("B >B²", ">B >B²"),
        Kind.CROSSING_GROOVE_CUSP: (">B³",),
    }
)
"""The table: the places of the roots in ascending order, a multiplicity as an exponent, for each kind."""

KIND_OF: Mapping[str, Kind] = MappingProxyType(
    {pattern: kind for kind, patterns in PATTERNS.items() for pattern in patterns}
)
"""The same table, read from the pattern."""

_EXPONENT = ("", "", "²", "³")


def pattern_of(places: Iterable[tuple[RootPlace, int]]) -> str:
    """The word of PATTERNS for the places and multiplicities of the real roots of a cubic, in ascending order."""
    roots = [(place.value, multiplicity) for place, multiplicity in places]
    pair = f" {COMPLEX}" if sum(multiplicity for _, multiplicity in roots) == 1 else ""
    return word_of(roots) + pair


def word_of(roots: Iterable[tuple[str, int]]) -> str:
    """Places of roots, each with its multiplicity as an exponent."""
    return " ".join(place + _EXPONENT[multiplicity] for place, multiplicity in roots)


def admissible() -> frozenset[str]:
    """Every pattern that the signs of g allow: by exact reasoning, and without the table.

    g(0) < 0, g(−A) and g(B) are < 0 or roots, g(+∞) > 0 and g(−∞) < 0. So the number of roots above 0 is odd; that of
    roots above B too, if B is none; that of roots below −A is even, if −A is none. Nothing else is needed: −A is a root
    only if P = 0 and B only if Q = 0, and what is left of g is then a quadratic with the same signs elsewhere.
    """
    patterns: set[str] = set()
    for number in (1, 3):
        for places in combinations_with_replacement(RootPlace, number):
            positive = sum(place in (RootPlace.OUTER, RootPlace.AT_B, RootPlace.ABOVE) for place in places)
            if (
                positive % 2 == 1
                and (RootPlace.AT_B in places or places.count(RootPlace.ABOVE) % 2 == 1)
                and (RootPlace.AT_MINUS_A in places or places.count(RootPlace.BELOW) % 2 == 0)
            ):
                patterns.update(map(pattern_of, multiplicities(places, (RootPlace.AT_MINUS_A, RootPlace.AT_B))))
    return frozenset(patterns)


_COMPOSITIONS = {1: ((1,),), 2: ((1, 1), (2,)), 3: ((1, 1, 1), (1, 2), (2, 1), (3,))}


Place = TypeVar("Place")


def multiplicities(places: Iterable[Place], points: Container[Place]) -> Iterator[list[tuple[Place, int]]]:
    """All ways for roots in the same open interval to fall together; those at one of the `points` are one root."""
    choices = []
    for place, group in groupby(places):
        count = len(list(group))
        ways = ((count,),) if place in points else _COMPOSITIONS[count]
        choices.append([[(place, multiplicity) for multiplicity in way] for way in ways])
    for choice in product(*choices):
        yield list(chain.from_iterable(choice))


def same_signs(pattern: str, possible: Iterable[Kind]) -> tuple[Kind, ...]:
    """Those of the possible kinds that have a pattern of the same signs and multiplicities."""
    signs = _signs(pattern)
    return tuple(kind for kind in possible if signs in _SIGNS[kind])


def _signs(pattern: str) -> tuple[str, ...]:
    """What signs and multiplicities alone keep of a pattern: "(0,B) B²" and "(0,B)² >B" both become ("+", "+²")."""
    signs = []
    for word in pattern.split():
        place = word.rstrip("²³")
        sign = "−" if "−A" in place else "+"
        signs.append(word if word == COMPLEX else sign + word[len(place) :])
    return tuple(sorted(signs))


_SIGNS = {kind: frozenset(map(_signs, patterns)) for kind, patterns in PATTERNS.items()}


@dataclass(frozen=True, slots=True)
class RootReport:
    """What the roots of g say.

    `pattern` is the places and multiplicities of the real ones as the table writes them; with `complex_pair` two roots
    are complex. `literal_kinds` is what signs and multiplicities alone leave possible for these sizes, without
    comparing any root with −A or B; `literal` is the one position they have in common, or None: ambiguous.
    """

    position: Position
    tangent: bool
    kind: Kind
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


def classify_by_roots(pair: Pair, kinds: Mapping[str, Kind] = KIND_OF) -> RootReport:
    """The position and kind of an upright pair, by the roots of g. `kinds` is the table.

    Raises AssertionError, naming the pair, where the pattern is not in the table.
    """
    try:
        return classify_invariants(Invariants.of(pair), kinds)
    except AssertionError as error:
        raise AssertionError(f"{error}, for {pair}") from error


def classify_invariants(pair: Invariants, kinds: Mapping[str, Kind] = KIND_OF) -> RootReport:
    """The same for a pair given by its invariants, which need not be those of float64 numbers."""
    pattern = pattern_of(real_roots(pair))
    occurs = _occurs(pair)
    possible = [kind for kind in Kind if occurs[kind.occurs]]
    kind = kinds.get(pattern)
    if kind not in possible:
        raise AssertionError(f"the roots of g form a pattern that is not possible: {pattern}")
    literal_kinds = same_signs(pattern, possible)
    literal = {other.position for other in literal_kinds}
    return RootReport(
        position=kind.position,
        tangent=kind.tangent,
        kind=kind,
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
    cubic = polynomial_product(polynomial_product(radial, axial), last)
    linear = [p * R * t * axial[i] + s * S * q * radial[i] for i in range(2)]
    return primitive([cubic[0], cubic[1], cubic[2] - linear[0], cubic[3] - linear[1]])


def real_roots(pair: Invariants) -> list[tuple[RootPlace, int]]:
    """The places and multiplicities of the distinct real roots of g, in ascending order."""
    g = coefficients(pair)
    common = sturm_chain(g)[-1]
    if len(common) > 1:  # λ − m or (λ − m)²: the double or triple root m, and then the third one, is rational
        m = Fraction(-common[1], (len(common) - 1) * common[0])
        rest = divided_by_root(divided_by_root(g, m), m)
        roots = Counter((m, m, Fraction(-rest[1], rest[0])))
        return [(_place(x, pair), multiplicity) for x, multiplicity in sorted(roots.items())]
    places = []
    for x in (-pair.A, pair.B):
        if value(g, x) == 0:
            g = divided_by_root(g, x)
            places.append(_place(x, pair))
    bounds = (None, -pair.A, Fraction(0), pair.B, None)
    between = (RootPlace.BELOW, RootPlace.INNER, RootPlace.OUTER, RootPlace.ABOVE)
    for place, low, high in zip(between, bounds, bounds[1:], strict=False):
        places += [place] * roots_between(g, low, high)
    order = list(RootPlace)
    return [(place, 1) for place in sorted(places, key=order.index)]


def _place(x: Fraction, pair: Invariants) -> RootPlace:
    """The place of a rational root, which is not 0."""
    if x < 0:
        return RootPlace.BELOW if x < -pair.A else RootPlace.INNER if x > -pair.A else RootPlace.AT_MINUS_A
    return RootPlace.OUTER if x < pair.B else RootPlace.ABOVE if x > pair.B else RootPlace.AT_B
