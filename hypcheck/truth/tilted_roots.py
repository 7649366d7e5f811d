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

**How they are found.** f and g are integer polynomials from the definitions of the matrices, and no root of f is
approximated: roots are counted by Sturm's theorem on either side of an enclosure of R, which holds no other root of f
or g; that R is a root of f too says their greatest common divisor. A multiple root of f is one number, and rational.
A pattern that the table does not list is an error of ours, never an answer.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from itertools import combinations, combinations_with_replacement, pairwise
from types import MappingProxyType

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth.polynomial_roots import root_exponents, roots_between, squarefree, sturm_chain
from hypcheck.truth.polynomials import Polynomial, common_divisor, primitive, quotient, value
from hypcheck.truth.roots import multiplicities, word_of


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


@dataclass(frozen=True, slots=True)
class TiltedRoots:
    """What the roots say. `below` and `above` are the patterns of the two sides, outward."""

    position: Position
    tangent: bool
    below: str
    above: str


def classify_tilted_by_roots(pair: Pair, table: Mapping[str, Side] = MEANING) -> TiltedRoots:
    """The position of a pair that is not upright, by the table.

    Raises AssertionError, naming the pair, where the pattern is not in the table: an error of ours.
    """
    lengths = pair.lengths
    f, g = characteristic(lengths), poles(lengths)
    below, above = side_pattern(_mirrored(f), _mirrored(g)), side_pattern(f, g)
    sides = table.get(below), table.get(above)
    if None in sides or sides.count(Side.NEITHER) == 0:
        raise AssertionError(f"the roots form a pattern that is not possible: {below} | {above}, for {pair}")
    tangent = Side.TANGENT in sides
    if Side.CLEAR not in sides:
        return TiltedRoots(Position.CONTACT, tangent, below, above)
    clear = Position.EXTERIOR if sides[1] is Side.CLEAR else Position.INTERIOR
    return TiltedRoots(clear, tangent, below, above)


def admissible() -> frozenset[str]:
    """Every pattern of one side that the signs of f allow: by exact reasoning, and without the table."""
    patterns: set[str] = set()
    for number in (1, 3):
        for places in combinations_with_replacement(_PLACES, number):
            if END in places or places.count(BEYOND) % 2 == 1:
                patterns.update(map(word_of, multiplicities(places, (END,))))
    return frozenset(patterns)


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
    V = sum(part * part for part in v)
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


def _mirrored(f: Polynomial) -> Polynomial:
    """f(−λ), with the sign of f at 0."""
    return tuple(-number if power % 2 else number for power, number in zip(range(len(f) - 1, -1, -1), f, strict=True))


def side_pattern(f: Polynomial, g: Polynomial) -> str:
    """The pattern of the roots of f above 0, outward, beside R, the least root of g there."""
    poles, factors = squarefree(g), list(_factors(f))
    shared = [common_divisor(factor, poles) for factor, _ in factors]
    low, high = _about_least_root(
        poles, [quotient(factor, common) for (factor, _), common in zip(factors, shared, strict=True)]
    )
    multiple = next((Fraction(-factor[1], factor[0]) for factor, times in factors if times > 1), None)
    places: list[tuple[str, int]] = []
    for place, start, end in ((INNER, Fraction(0), low), (BEYOND, high, None)):
        if place is BEYOND:
            at = [times for (_, times), both in zip(factors, shared, strict=True) if roots_between(both, low, high)]
            places += [(END, times) for times in at]
        if multiple is not None and start < multiple and (end is None or multiple < end):
            (simple, _), (_, times) = factors[0], factors[-1]
            places += [(place, 1)] * roots_between(simple, start, multiple)
            places += [(place, times), *[(place, 1)] * roots_between(simple, multiple, end)]
        else:
            places += [(place, times) for factor, times in factors for _ in range(roots_between(factor, start, end))]
    return word_of(places)


def _factors(f: Polynomial) -> Iterator[tuple[Polynomial, int]]:
    """Squarefree factors of f and how often it has their roots; the first is of the simple ones, (1,) for none."""
    layers = [*_layers(f), (1,)]
    for times, (layer, beyond) in enumerate(pairwise(layers), 1):
        exactly = quotient(layer, beyond)
        if times == 1 or len(exactly) > 1:
            yield exactly, times


def _layers(f: Polynomial) -> Iterator[Polynomial]:
    """Squarefree polynomials, the k-th with the roots that f has k times at least: of f, gcd(f, f′), and so on."""
    while len(f) > 1:
        yield squarefree(f)
        common = sturm_chain(f)[-1]
        f = common if common[0] > 0 else tuple(-number for number in common)


def _about_least_root(f: Polynomial, others: Sequence[Polynomial]) -> tuple[Fraction, Fraction]:
    """An open interval about the least root above 0 of a squarefree f, with no other root of f and none of the others.

    No other polynomial has that root. Its exponent is found first, since roots may be 10³⁰⁰ apart.
    """

    def no_root(low: Fraction, high: Fraction) -> Fraction:
        """A number of [low, high) that is no root of f, which has three at most."""
        return next(number for step in range(4) if value(f, number := low + (high - low) * step / 4))

    def of_exponent(exponent: int) -> Fraction:
        return no_root(Fraction(2) ** exponent, Fraction(2) ** (exponent + 1))

    def meets(other: Polynomial) -> bool:
        return not value(other, low) or not value(other, high) or roots_between(other, low, high) > 0

    below, above = root_exponents(f)
    below -= 1
    while above - below > 1:
        exponent = (below + above) // 2
        below, above = (below, exponent) if roots_between(f, Fraction(0), of_exponent(exponent)) else (exponent, above)
    low, high = of_exponent(below), of_exponent(above)
    while roots_between(f, low, high) > 1 or any(map(meets, others)):
        middle = no_root((low + high) / 2, high)
        low, high = (low, middle) if roots_between(f, low, middle) else (middle, high)
    return low, high
