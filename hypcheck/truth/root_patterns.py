"""The tables of the roots oracle: the possible patterns of roots of det(S + λH), and their meanings (roots.py).

f(λ) = det(S + λH) and g(λ) = det(M + λD), M and D the upper 3×3 parts of the matrices S and H; L and R are the roots of
g next to 0, below and above it.

**The signs of f.** Let L and R be simple roots of g. f(0) < 0; f ≤ 0 at L and R, where M + λD is singular and
semidefinite; f > 0 at ±∞. So the number of roots above 0 is odd, 1 or 3, and that of roots beyond R is odd unless R is
one; the same holds below 0 with L. An upright pair (after [10], re-derived; its text was not consulted) has A + λ as a
factor of f and twice of g, L = −A and R = B; what is left of f is a multiple of the cubic of equation (12)
(docs/mathematics.md, "Root patterns and relative position"), and below 0 all these numbers are even. That leaves SIDES,
for the side of R, and its mirror image, for the side of L: `sides_by_signs` enumerates it independently.

**What they mean.** On (0, R) φ begins with −1 and has the sign of f. A simple root there makes φ > 0 beyond it: clear.
At a double root the concave φ has its maximum 0: tangent. With none, φ < 0 on (0, R), and sup φ is 0 only if φ tends to
0 at R: if R is at least a double root of f, since it is a simple root of g. Then the pair is tangent, else in contact.
For an upright pair both sides together give the kind: PATTERNS. That table can also be read literally, by the roots'
signs and multiplicities alone; some patterns then fall together.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from enum import Enum
from itertools import chain, combinations_with_replacement, groupby, product
from types import MappingProxyType
from typing import TypeVar

from hypcheck.truth.kinds import Kind

COMPLEX = "complex"
"""The word of a pattern for a pair of complex roots."""

Roots = list[tuple[str, int]]
"""Places of roots, each with its multiplicity."""


class Side(Enum):
    """The meaning of the roots on one side of 0 for this side."""

    CLEAR = "clear"
    TANGENT = "tangent"
    NEITHER = "neither"


INNER, END, BEYOND = "(0,R)", "R", ">R"
_PLACES = (INNER, END, BEYOND)

SIDES: Mapping[Side, tuple[str, ...]] = MappingProxyType(
    {
        Side.CLEAR: ("(0,R) (0,R) R", "(0,R) (0,R) >R", "(0,R) R >R", "(0,R) R²", "(0,R) (0,R)", "(0,R) R"),
        Side.TANGENT: ("(0,R)² R", "(0,R)² >R", "R² >R", "R³", "(0,R)²", "R²"),
        Side.NEITHER: (
            *("R", ">R", "R >R >R", "R >R²", ">R >R >R", ">R² >R", ">R >R²", ">R³"),
            *("", "R >R", ">R >R", ">R²"),
        ),
    }
)
"""The places of the roots on one side, outward, a multiplicity as an exponent, for each meaning; odd numbers first."""

MEANING: Mapping[str, Side] = MappingProxyType({word: side for side, words in SIDES.items() for word in words})


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
    """The entry of PATTERNS for the real roots of a cubic, given as places and multiplicities in ascending order."""
    roots = [(place.value, multiplicity) for place, multiplicity in places]
    pair = f" {COMPLEX}" if sum(multiplicity for _, multiplicity in roots) == 1 else ""
    return word_of(roots) + pair


def word_of(roots: Iterable[tuple[str, int]]) -> str:
    """Places of roots, each with its multiplicity as an exponent."""
    return " ".join(place + _EXPONENT[multiplicity] for place, multiplicity in roots)


def of_both_sides(below: Roots, above: Roots) -> list[tuple[RootPlace, int]]:
    """The roots of an upright pair in ascending order, from the roots below and above 0."""
    return [(_BELOW[place], times) for place, times in reversed(below)] + [
        (_ABOVE[place], times) for place, times in above
    ]


_BELOW = {INNER: RootPlace.INNER, END: RootPlace.AT_MINUS_A, BEYOND: RootPlace.BELOW}
_ABOVE = {INNER: RootPlace.OUTER, END: RootPlace.AT_B, BEYOND: RootPlace.ABOVE}


def sides_by_signs(*numbers: int) -> Iterator[list[tuple[str, int]]]:
    """The roots of one side, outward, that the signs of f allow: exact reasoning, without the table.

    The number of roots on a side is one of `numbers`. The number beyond R has the same parity, unless R is a root.
    """
    for number in numbers:
        for places in combinations_with_replacement(_PLACES, number):
            if END in places or (places.count(BEYOND) - number) % 2 == 0:
                yield from multiplicities(places, (END,))


def admissible() -> frozenset[str]:
    """Every pattern of an upright pair that the signs allow: one root or three, an odd number of them above 0."""
    return frozenset(
        pattern_of(of_both_sides(below, above))
        for numbers in ((0, 1), (0, 3), (2, 1))
        for below, above in product(*(tuple(sides_by_signs(number)) for number in numbers))
    )


_COMPOSITIONS = {1: ((1,),), 2: ((1, 1), (2,)), 3: ((1, 1, 1), (1, 2), (2, 1), (3,))}


Place = TypeVar("Place")


def multiplicities(places: Iterable[Place], points: Container[Place]) -> Iterator[list[tuple[Place, int]]]:
    """Every grouping of roots in one open interval into multiple roots; roots at one of the `points` are one root."""
    choices = []
    for place, group in groupby(places):
        count = len(list(group))
        groups = ((count,),) if place in points else _COMPOSITIONS[count]
        choices.append([[(place, multiplicity) for multiplicity in sizes] for sizes in groups])
    for choice in product(*choices):
        yield list(chain.from_iterable(choice))


def same_signs(pattern: str, possible: Iterable[Kind]) -> tuple[Kind, ...]:
    """Those of the possible kinds that have a pattern of the same signs and multiplicities."""
    signs = _signs(pattern)
    return tuple(kind for kind in possible if signs in _SIGNS[kind])


def _signs(pattern: str) -> tuple[str, ...]:
    """The signs and multiplicities of a pattern, without places: "(0,B) B²" and "(0,B)² >B" both become ("+", "+²")."""
    signs = []
    for word in pattern.split():
        place = word.rstrip("²³")
        sign = "−" if "−A" in place else "+"
        signs.append(word if word == COMPLEX else sign + word[len(place) :])
    return tuple(sorted(signs))


_SIGNS = {kind: frozenset(map(_signs, patterns)) for kind, patterns in PATTERNS.items()}
