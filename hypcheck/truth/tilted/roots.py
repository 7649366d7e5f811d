"""The roots oracle in general position: the roots of det(S + λH) beside 0 and the ends of where M + λD is definite.

M and D are the upper 3×3 parts of the matrices S and H. g(λ) = det(M + λD) has three simple real roots, two of them
negative. Between L, the greater negative one, and R, the positive one, M + λD is positive definite. On (L, R) the
quotient φ = f/g of f(λ) = det(S + λH) is concave; the pair is exterior if and only if φ > 0 somewhere on (0, R),
interior if and only if it is on (L, 0), and touches from that side where sup φ = 0 there.

**The signs of f.** f(0) < 0; f ≤ 0 at L and R, where M + λD is singular and semidefinite; f > 0 at ±∞. So the number
of roots above 0 is odd, 1 or 3, and that of roots beyond R is odd unless R is one; the same holds below 0 with L. What
that leaves is PATTERNS, for the side of R, and its mirror image, for the side of L: `admissible` enumerates it anew.

**What they mean.** On (0, R) φ begins with −1 and has the sign of f. A simple root there makes φ > 0 beyond it: clear.
A double one is where φ, being concave, has its maximum 0: tangent. With none, φ < 0 on (0, R), and sup φ is 0 only if φ
tends to 0 at R: if R is a root of f twice at least, since it is one of g once. Then the pair is tangent, else in
contact.

Everything is exact: f and g are integer polynomials from the definitions of the matrices, their common and multiple
roots come from gcds, and all are enclosed by Sturm's theorem (polynomial_roots.py). A pattern that the table does not
list is an error of ours, never an answer. Upright spheroids and spheres are the upright roots oracle's.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import combinations, combinations_with_replacement, groupby, pairwise, product
from types import MappingProxyType

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth.polynomial_roots import (
    Interval,
    Polynomial,
    common_divisor,
    enclosed,
    isolate,
    primitive,
    quotient,
    squarefree,
    sturm_chain,
)
from hypcheck.truth.roots import classify_by_roots


class Side(Enum):
    """What the roots on one side of 0 say of that side."""

    CLEAR = "clear"
    TANGENT = "tangent"
    NEITHER = "neither"


INNER, END, BEYOND = "(0,R)", "R", ">R"
_PLACES = (INNER, END, BEYOND)

PATTERNS: Mapping[Side, tuple[str, ...]] = MappingProxyType(
    {
        Side.CLEAR: ("(0,R) (0,R) R", "(0,R) (0,R) >R", "(0,R) R >R", "(0,R) R²"),
        Side.TANGENT: ("(0,R)² R", "(0,R)² >R", "R² >R", "R³"),
        Side.NEITHER: ("R", ">R", "R >R >R", "R >R²", ">R >R >R", ">R² >R", ">R >R²", ">R³"),
    }
)
"""The table: the places of the roots on one side, outward, a multiplicity as an exponent, for each meaning."""

MEANING: Mapping[str, Side] = MappingProxyType({word: side for side, words in PATTERNS.items() for word in words})

_EXPONENT = ("", "", "²", "³")
_COMPOSITIONS = {1: ((1,),), 2: ((1, 1), (2,)), 3: ((1, 1, 1), (1, 2), (2, 1), (3,))}


@dataclass(frozen=True, slots=True)
class TiltedRoots:
    """What the roots say. `below` and `above` are the patterns of the two sides, outward; "" of an upright pair."""

    position: Position
    tangent: bool
    below: str
    above: str


def position(pair: Pair) -> Position:
    """The position alone."""
    return classify_tilted_by_roots(pair).position


def classify_tilted_by_roots(pair: Pair, table: Mapping[str, Side] = MEANING) -> TiltedRoots:
    """The position of any valid pair, by the table.

    Raises AssertionError, naming the pair, where the pattern is not in the table: an error of ours.
    """
    if pair.is_upright:
        report = classify_by_roots(pair.upright)
        return TiltedRoots(report.position, report.tangent, "", "")
    lengths = pair.lengths
    f, g = characteristic(lengths), poles(lengths)
    below, above = _sides(f, g)
    found = table.get(below), table.get(above)
    if None in found or found.count(Side.NEITHER) == 0:
        raise AssertionError(f"the roots form a pattern that is not possible: {below} | {above}, for {pair}")
    tangent = Side.TANGENT in found
    if Side.CLEAR not in found:
        return TiltedRoots(Position.CONTACT, tangent, below, above)
    clear = Position.EXTERIOR if found[1] is Side.CLEAR else Position.INTERIOR
    return TiltedRoots(clear, tangent, below, above)


def admissible() -> frozenset[str]:
    """Every pattern of one side that the signs of f allow: by exact reasoning, and without the table."""
    found: set[str] = set()
    for number in (1, 3):
        for places in combinations_with_replacement(_PLACES, number):
            if END in places or places.count(BEYOND) % 2 == 1:
                found.update(_multiplicities(places))
    return frozenset(found)


def _multiplicities(places: Sequence[str]) -> Iterator[str]:
    """All ways for roots in the same open interval to fall together; those at R are one root."""
    choices = []
    for place, group in groupby(places):
        count = len(list(group))
        ways = ((count,),) if place == END else _COMPOSITIONS[count]
        choices.append([[(place, multiplicity) for multiplicity in way] for way in ways])
    for choice in product(*choices):
        yield _word(root for part in choice for root in part)


def _word(roots: Iterable[tuple[str, int]]) -> str:
    return " ".join(place + _EXPONENT[multiplicity] for place, multiplicity in roots)


def characteristic(lengths: Lengths) -> Polynomial:
    """A positive multiple of det(S + λH), λ in a positive unit of its own, primitive."""
    S, H = _matrices(lengths)
    return _pencil(S, H)


def poles(lengths: Lengths) -> Polynomial:
    """A positive multiple of det(M + λD), in the same unit, primitive."""
    S, H = _matrices(lengths)
    return _pencil([row[:3] for row in S[:3]], H[:3])


def _matrices(lengths: Lengths) -> tuple[list[list[int]], list[int]]:
    """S times b² d² v·v, and the diagonal of H times α² γ²: the quotient of both factors is the unit of λ."""
    p, s, q, t = lengths.alpha**2, lengths.gamma**2, lengths.b**2, lengths.d**2
    v, C = lengths.axis, (lengths.x, lengths.y, lengths.z)
    V = sum(each * each for each in v)
    M = [[(i == j) * t * V + (q - t) * v[i] * v[j] for j in range(3)] for i in range(3)]
    shift = [-sum(M[i][j] * C[j] for j in range(3)) for i in range(3)]
    last = -sum(shift[i] * C[i] for i in range(3)) - q * t * V
    return [*([*M[i], shift[i]] for i in range(3)), [*shift, last]], [s, s, -p, -p * s]


def _pencil(S: list[list[int]], H: list[int]) -> Polynomial:
    """det(S + λ diag(H)): its coefficients are sums of principal minors of S times products of entries of H."""
    size = len(H)
    coefficients = [0] * (size + 1)
    for number in range(size + 1):
        for chosen in combinations(range(size), number):
            factor = 1
            for place in chosen:
                factor *= H[place]
            rest = [place for place in range(size) if place not in chosen]
            coefficients[size - number] += factor * _determinant([[S[i][j] for j in rest] for i in rest])
    return primitive(coefficients)


def _determinant(matrix: list[list[int]]) -> int:
    if not matrix:
        return 1
    return sum(
        (-1) ** j * first * _determinant([[*row[:j], *row[j + 1 :]] for row in matrix[1:]])
        for j, first in enumerate(matrix[0])
        if first
    )


def _sides(f: Polynomial, g: Polynomial) -> tuple[str, str]:
    """The patterns of the roots of f on either side of 0, outward, beside the nearest roots of g there."""
    factors = _factors(f, g)
    roots = [(interval, each) for each in factors for interval in isolate(each.polynomial, (), narrow=False)]
    roots = _apart(roots)
    below = [factor for interval, factor in roots if interval[1] <= 0]
    return _side(below[::-1]), _side([factor for _, factor in roots[len(below) :]])


@dataclass(frozen=True, slots=True)
class _Factor:
    """A squarefree polynomial whose roots have one meaning: whether they are roots of g, and how often of f."""

    polynomial: Polynomial
    is_pole: bool
    multiplicity: int


def _factors(f: Polynomial, g: Polynomial) -> list[_Factor]:
    """Factors of f and g without a common root, which have all of their roots."""
    found, poles = [], squarefree(g)
    for multiplicity, (layer, beyond) in enumerate(pairwise([*_layers(f), (1,)]), 1):
        exactly = quotient(layer, beyond)
        common = common_divisor(exactly, poles)
        poles = quotient(poles, common)
        found += [_Factor(common, True, multiplicity), _Factor(quotient(exactly, common), False, multiplicity)]
    return [each for each in (*found, _Factor(poles, True, 0)) if len(each.polynomial) > 1]


def _apart(roots: list[tuple[Interval, _Factor]]) -> list[tuple[Interval, _Factor]]:
    """The enclosures narrowed until they are disjoint, in order; this ends, because no two factors share a root."""
    bits = 4
    while True:
        roots = sorted(roots, key=lambda each: each[0])
        close = {place for place in range(1, len(roots)) if roots[place - 1][0][1] > roots[place][0][0]}
        if not close:
            return roots
        bits *= 2
        roots = [
            (enclosed(factor.polynomial, *interval, bits) if {place, place + 1} & close else interval, factor)
            for place, (interval, factor) in enumerate(roots)
        ]


def _side(roots: Sequence[_Factor]) -> str:
    """The pattern of one side: the meanings of its roots, outward."""
    end = next(place for place, root in enumerate(roots) if root.is_pole)
    places = [INNER] * end + [END] + [BEYOND] * (len(roots) - end - 1)
    return _word((place, root.multiplicity) for place, root in zip(places, roots, strict=True) if root.multiplicity)


def _layers(f: Polynomial) -> list[Polynomial]:
    """Squarefree polynomials, the k-th with the roots that f has k times at least: of f, gcd(f, f′), and so on."""
    found = []
    while len(f) > 1:
        found.append(squarefree(f))
        common = sturm_chain(f)[-1]
        f = common if common[0] > 0 else tuple(-each for each in common)
    return found
