"""The table of root patterns: from the places and multiplicities of the roots of g to what they mean.

After [10], re-derived; its text was not consulted (docs/mathematics.md, "Root patterns and relative position"). With
the roots' signs and multiplicities alone the table can be read too, literally, but then some patterns fall together.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from enum import Enum
from itertools import chain, combinations_with_replacement, groupby, product
from types import MappingProxyType

from hypcheck.truth.kinds import Kind

COMPLEX = "complex"
"""The word of a pattern for a pair of complex roots."""


class Place(Enum):
    """Where a root stands to −A, 0 and B; 0 itself is never a root, since g(0) = −A B."""

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


def pattern_of(places: Iterable[tuple[Place, int]]) -> str:
    """The word of PATTERNS for the places and multiplicities of the real roots of a cubic, in ascending order."""
    roots = list(places)
    words = [place.value + _EXPONENT[multiplicity] for place, multiplicity in roots]
    if sum(multiplicity for _, multiplicity in roots) == 1:
        words.append(COMPLEX)
    return " ".join(words)


def admissible() -> frozenset[str]:
    """Every pattern that the signs of g allow: by exact reasoning, and without the table.

    g(0) < 0, g(−A) and g(B) are < 0 or roots, g(+∞) > 0 and g(−∞) < 0. So the number of roots above 0 is odd; that of
    roots above B too, if B is none; that of roots below −A is even, if −A is none. Nothing else is needed: −A is a root
    only if P = 0 and B only if Q = 0, and what is left of g is then a quadratic with the same signs elsewhere.
    """
    found: set[str] = set()
    for number in (1, 3):
        for places in combinations_with_replacement(Place, number):
            positive = sum(place in (Place.OUTER, Place.AT_B, Place.ABOVE) for place in places)
            if (
                positive % 2 == 1
                and (Place.AT_B in places or places.count(Place.ABOVE) % 2 == 1)
                and (Place.AT_MINUS_A in places or places.count(Place.BELOW) % 2 == 0)
            ):
                found.update(_multiplicities(places))
    return frozenset(found)


_COMPOSITIONS = {1: ((1,),), 2: ((1, 1), (2,)), 3: ((1, 1, 1), (1, 2), (2, 1), (3,))}


def _multiplicities(places: Iterable[Place]) -> Iterator[str]:
    """All ways for roots in the same open interval to fall together; those at a point are one root."""
    choices = []
    for place, group in groupby(places):
        count = len(list(group))
        ways = ((count,),) if place in (Place.AT_MINUS_A, Place.AT_B) else _COMPOSITIONS[count]
        choices.append([[(place, multiplicity) for multiplicity in way] for way in ways])
    for choice in product(*choices):
        yield pattern_of(chain.from_iterable(choice))


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
