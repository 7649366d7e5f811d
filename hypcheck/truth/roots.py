"""The roots oracle: the order of the roots of det(S + λH), 0, and the ends of the interval where M + λD is definite.

M and D are the upper 3×3 parts of the matrices S and H, f(λ) = det(S + λH) and g(λ) = det(M + λD). L and R are the
roots of g next to 0, below and above it; between them M + λD is positive definite. There φ = f/g is concave; the pair
is exterior if and only if φ > 0 somewhere on (0, R), interior if and only if it is on (L, 0), and touches from that
side where sup φ = 0 there.

**The signs of f.** Let L and R be simple roots of g. f(0) < 0; f ≤ 0 at L and R, where M + λD is singular and
semidefinite; f > 0 at ±∞. So the number of roots above 0 is odd, 1 or 3, and that of roots beyond R is odd unless R is
one; the same holds below 0 with L. An upright pair (after [10], re-derived; its text was not consulted) has A + λ as a
factor of f and twice of g, L = −A and R = B; what is left of f is a multiple of the cubic of equation (12)
(docs/mathematics.md, "Root patterns and relative position"), and below 0 all these numbers are even. That leaves SIDES,
for the side of R, and its mirror image, for the side of L: paper/ledger/checks.py enumerates it independently.

**What they mean.** On (0, R) φ begins with −1 and has the sign of f. A simple root there makes φ > 0 beyond it: clear.
At a double root the concave φ has its maximum 0: tangent. With none, φ < 0 on (0, R), and sup φ is 0 only if φ tends to
0 at R: if R is at least a double root of f, since it is a simple root of g. Then the pair is tangent, else in contact.
For an upright pair both sides together give the kind: PATTERNS. That table can also be read literally, by the roots'
signs and multiplicities alone; some patterns then fall together.

**How they are found.** f and g are integer polynomials from the definitions of the matrices, and no root is
approximated: the roots of f are counted by Sturm's theorem on either side of R, which is rational or a root of a
quadratic; there the signs of polynomials are exact. A multiple root of f is one number, and rational. A pattern that is
not in a table is an error of this program, never an answer.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction
from itertools import combinations, pairwise
from types import MappingProxyType

from hypcheck.geometry.arithmetic import changes_of_sign, sign_of, sign_with_root
from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth.kinds import Kind
from hypcheck.truth.polynomials import (
    Polynomial,
    linear_factor,
    polynomial_product,
    primitive,
    quotient,
    remainder,
    scaled,
    squarefree,
    sturm_chain,
)

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
    """Write the entry of PATTERNS for the real roots of a cubic, ascending places and multiplicities."""
    roots = [(place.value, multiplicity) for place, multiplicity in places]
    pair = f" {COMPLEX}" if sum(multiplicity for _, multiplicity in roots) == 1 else ""
    return word_of(roots) + pair


def word_of(roots: Iterable[tuple[str, int]]) -> str:
    """Write places of roots, each with its multiplicity as an exponent."""
    return " ".join(place + _EXPONENT[multiplicity] for place, multiplicity in roots)


def of_both_sides(below: Roots, above: Roots) -> list[tuple[RootPlace, int]]:
    """Return the roots of an upright pair in ascending order, from the roots below and above 0."""
    return [(_BELOW[place], times) for place, times in reversed(below)] + [
        (_ABOVE[place], times) for place, times in above
    ]


_BELOW = {INNER: RootPlace.INNER, END: RootPlace.AT_MINUS_A, BEYOND: RootPlace.BELOW}
_ABOVE = {INNER: RootPlace.OUTER, END: RootPlace.AT_B, BEYOND: RootPlace.ABOVE}


def same_signs(pattern: str, possible: Iterable[Kind]) -> tuple[Kind, ...]:
    """Return those of the possible kinds that have a pattern of the same signs and multiplicities."""
    signs = _signs(pattern)
    return tuple(kind for kind in possible if signs in _SIGNS[kind])


def _signs(pattern: str) -> tuple[str, ...]:
    """Reduce a pattern to signs and multiplicities: "(0,B) B²" and "(0,B)² >B" both become ("+", "+²")."""
    signs = []
    for word in pattern.split():
        place = word.rstrip("²³")
        sign = "−" if "−A" in place else "+"
        signs.append(word if word == COMPLEX else sign + word[len(place) :])
    return tuple(sorted(signs))


_SIGNS = {kind: frozenset(map(_signs, patterns)) for kind, patterns in PATTERNS.items()}


@dataclass(frozen=True, slots=True)
class RootReport:
    """The result of the roots oracle. `below` and `above` are the patterns of the two sides of 0, outward.

    For an upright pair, `pattern` has the places and multiplicities of the real roots of its cubic in the table's form.
    `literal_kinds` is what signs and multiplicities alone leave possible for these sizes, without comparing any root
    with −A or B; `literal` is the position that they have in common, or None if it is ambiguous.
    """

    position: Position
    tangent: bool
    below: str
    above: str
    kind: Kind | None = None
    pattern: str = ""
    literal: Position | None = None
    literal_kinds: tuple[Kind, ...] = ()

    @property
    def complex_pair(self) -> bool:
        """Whether two roots of an upright pair are complex."""
        return self.pattern.endswith(COMPLEX)


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
        """Return the invariants of a pair, exactly."""
        lengths = pair.lengths
        q, t = lengths.b**2, lengths.d**2
        return cls(
            A=Fraction(lengths.alpha**2, q),
            B=Fraction(lengths.gamma**2, t),
            P=Fraction(lengths.x**2 + lengths.y**2, q),
            Q=Fraction(lengths.z**2, t),
        )


def classify_by_roots(pair: Pair) -> RootReport:
    """Return the position of a pair by the roots, and the kind of an upright one.

    Raises AssertionError, naming the pair, if the pattern is not in the table: an error of this program.
    """
    try:
        if pair.is_upright:
            return classify_invariants(Invariants.of(pair))
        return _position(*roots_outward(characteristic(pair.lengths), *poles(pair.lengths)))
    except AssertionError as error:
        raise AssertionError(f"{error}, for {pair}") from error


def classify_invariants(pair: Invariants) -> RootReport:
    """Classify an upright pair given by its invariants, which need not come from float64 numbers, by its roots."""
    roots = _upright_roots(pair)
    pattern = pattern_of(of_both_sides(*roots))
    occurs = _occurs(pair)
    possible = [kind for kind in Kind if occurs[kind.occurs]]
    kind, report = KIND_OF.get(pattern), _position(*roots)
    if kind not in possible or (kind.position, kind.tangent) != (report.position, report.tangent):
        raise AssertionError(f"the roots of g form a pattern that is not possible: {pattern}")
    literal_kinds = same_signs(pattern, possible)
    literal = {other.position for other in literal_kinds}
    return replace(
        report,
        kind=kind,
        pattern=pattern,
        literal=literal.pop() if len(literal) == 1 else None,
        literal_kinds=literal_kinds,
    )


def _position(roots_below: Roots, roots_above: Roots) -> RootReport:
    """Return the report of a pair with these roots. Raises AssertionError for an impossible pattern."""
    below, above = word_of(roots_below), word_of(roots_above)
    sides = MEANING.get(below), MEANING.get(above)
    if None in sides or sides.count(Side.NEITHER) == 0:
        raise AssertionError(f"the roots form a pattern that is not possible: {below} | {above}")
    position = Position.CONTACT
    if Side.CLEAR in sides:
        position = Position.EXTERIOR if sides[1] is Side.CLEAR else Position.INTERIOR
    return RootReport(position, Side.TANGENT in sides, below, above)


def _occurs(pair: Invariants) -> dict[str, bool]:
    """Decide which conditions of Kind.occurs hold: a < 1 ⟺ A < 1, and c² < a ⟺ B² < A."""
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
    """Return a positive multiple of g in coprime integers, from the definition.

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
    """Return the places and multiplicities of the distinct real roots of the cubic, in ascending order."""
    return of_both_sides(*_upright_roots(pair))


def _upright_roots(pair: Invariants) -> tuple[Roots, Roots]:
    """Return the roots of an upright pair's cubic below and above 0, outward."""
    return roots_outward(coefficients(pair), linear_factor(-pair.A), linear_factor(pair.B))


def characteristic(lengths: Lengths) -> Polynomial:
    """Return a positive multiple of det(S + λH), λ in a positive unit of its own, primitive."""
    S, H = _matrices(lengths)
    return _pencil(S, H)


def poles(lengths: Lengths) -> tuple[Polynomial, Polynomial]:
    """Return multiples of factors of det(M + λD), in the unit of `characteristic`, of which L and R are roots.

    −α²/b² is a root, its vectors are perpendicular to both axes. The quotient has a root on either side of 0, and L is
    the one nearer to 0 of those below.
    """
    S, H = _matrices(lengths)
    square = sum(number * number for number in lengths.axis)
    linear = linear_factor(Fraction(-(lengths.d**2) * square, lengths.gamma**2))
    quadratic = quotient(_pencil([row[:3] for row in S[:3]], H[:3]), linear)
    return linear if _sign(linear, quadratic, -1) < 0 else quadratic, quadratic


def _matrices(lengths: Lengths) -> tuple[list[list[int]], list[int]]:
    """Return S times b² d² v·v, and the diagonal of H times α² γ²; the quotient of both factors is the unit of λ."""
    p, s, q, t = lengths.alpha**2, lengths.gamma**2, lengths.b**2, lengths.d**2
    v, C = lengths.axis, (lengths.x, lengths.y, lengths.z)
    V = sum(part * part for part in v)
    M = [[(i == j) * t * V + (q - t) * v[i] * v[j] for j in range(3)] for i in range(3)]
    shift = [-sum(M[i][j] * C[j] for j in range(3)) for i in range(3)]
    last = -sum(shift[i] * C[i] for i in range(3)) - q * t * V
    return [*([*M[i], shift[i]] for i in range(3)), [*shift, last]], [s, s, -p, -p * s]


def _pencil(S: list[list[int]], H: list[int]) -> Polynomial:
    """Expand det(S + λ diag(H)): coefficients are sums of principal minors of S times products of entries of H."""
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
    """Return the determinant, by expansion along the first row."""
    if not matrix:
        return 1
    return sum(
        (-1) ** j * first * _determinant([[*row[:j], *row[j + 1 :]] for row in matrix[1:]])
        for j, first in enumerate(matrix[0])
        if first
    )


def roots_outward(f: Polynomial, below: Polynomial, above: Polynomial) -> tuple[Roots, Roots]:
    """Return the real roots of f below and above 0, outward, in order with L and R.

    L and R are roots of `below` and of `above`, which are linear, or quadratic with a root on either side of 0.
    """
    factors = tuple(_factors(f))
    return _side(factors, below, -1), _side(factors, above, 1)


def _side(factors: Sequence[tuple[Polynomial, int]], end: Polynomial, side: int) -> Roots:
    """Return the roots on one side of 0, outward, in order with the root of `end` on that side.

    The changes of sign in a Sturm chain fall by the number of its roots in (low, high], also where high is one.
    """
    (simple, _), *multiple = factors
    chain = sturm_chain(simple)
    signs = [_sign(f, end, side) for f in chain]
    at_zero, at_end = changes_of_sign(f[-1] for f in chain), changes_of_sign(signs)
    at_infinity = changes_of_sign(f[0] if side > 0 or len(f) % 2 else -f[0] for f in chain)
    met = signs[0] == 0
    inner = abs(at_zero - at_end) - (met and side > 0)
    beyond = abs(at_end - at_infinity) - (met and side < 0)
    places = [(INNER, 1)] * inner + [(END, 1)] * met + [(BEYOND, 1)] * beyond
    for factor, times in multiple:
        if side * factor[1] < 0:
            before = abs(at_zero - changes_of_sign(_sign(f, factor) for f in chain))
            places.insert(before, ((END, INNER, BEYOND)[side * _sign(factor, end, side)], times))
    return places


def _sign(f: Polynomial, g: Polynomial, side: int = 1) -> int:
    """Return the sign of f at the root of a linear g, or at the one root of a quadratic g on this side of the other."""
    linear, constant = (0, 0, *remainder(f, g))[-2:]
    if len(g) == 2:
        return sign_of(constant)
    a, b, c = g if g[0] > 0 else scaled(-1, g)
    return sign_with_root(2 * a * constant - b * linear, side * linear, b * b - 4 * a * c)


def _factors(f: Polynomial) -> Iterator[tuple[Polynomial, int]]:
    """Yield squarefree factors of f and how often f has their roots; the first has the simple ones, (1,) for none."""
    layers = [*_layers(f), (1,)]
    for times, (layer, beyond) in enumerate(pairwise(layers), 1):
        exactly = quotient(layer, beyond)
        if times == 1 or len(exactly) > 1:
            yield exactly, times


def _layers(f: Polynomial) -> Iterator[Polynomial]:
    """Yield squarefree polynomials, the k-th with the roots that f has k times or more: of f, gcd(f, f′), and so on."""
    while len(f) > 1:
        yield squarefree(f)
        common = sturm_chain(f)[-1]
        f = common if common[0] > 0 else tuple(-number for number in common)
