"""The roots oracle: the places of the roots of det(S + λH) beside 0 and the ends of where M + λD is definite.

M and D are the upper 3×3 parts of the matrices S and H, f(λ) = det(S + λH) and g(λ) = det(M + λD). L and R are the
roots of g next to 0, below and above it; between them M + λD is positive definite. There φ = f/g is concave; the pair
is exterior if and only if φ > 0 somewhere on (0, R), interior if and only if it is on (L, 0), and touches from that
side where sup φ = 0 there.

What patterns there are and what they mean is in root_patterns.py.

**How they are found.** f and g are integer polynomials from the definitions of the matrices, and no root of f is
approximated: roots are counted by Sturm's theorem on either side of R, or of an enclosure of R that holds no other root
of f or g where R is irrational; that R is a root of f too says their greatest common divisor. A multiple root of f is
one number, and rational. A pattern that a table does not list is a fault of this program, never an answer.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, pairwise

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth.kinds import Kind
from hypcheck.truth.polynomial_roots import root_exponents, roots_between, squarefree, sturm_chain
from hypcheck.truth.polynomials import (
    Polynomial,
    common_divisor,
    divided_by_root,
    linear_factor,
    polynomial_product,
    primitive,
    quotient,
    value,
)
from hypcheck.truth.root_patterns import (
    BEYOND,
    COMPLEX,
    END,
    INNER,
    KIND_OF,
    MEANING,
    RootPlace,
    Roots,
    Side,
    of_both_sides,
    pattern_of,
    same_signs,
    word_of,
)


@dataclass(frozen=True, slots=True)
class RootReport:
    """What the roots say. `below` and `above` are the patterns of the two sides, outward.

    Of an upright pair, `pattern` is the places and multiplicities of the real roots of its cubic as the table writes
    them. `literal_kinds` is what signs and multiplicities alone leave possible for these sizes, without comparing any
    root with −A or B; `literal` is the one position they have in common, or None: ambiguous.
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
        """The invariants of a pair, exactly."""
        lengths = pair.lengths
        q, t = lengths.b**2, lengths.d**2
        return cls(
            A=Fraction(lengths.alpha**2, q),
            B=Fraction(lengths.gamma**2, t),
            P=Fraction(lengths.x**2 + lengths.y**2, q),
            Q=Fraction(lengths.z**2, t),
        )


def classify_by_roots(
    pair: Pair, kinds: Mapping[str, Kind] = KIND_OF, sides: Mapping[str, Side] = MEANING
) -> RootReport:
    """The position of a pair by the roots, and the kind of an upright one. `kinds` and `sides` are the tables.

    Raises AssertionError, naming the pair, where the pattern is not in the table: an error of ours.
    """
    try:
        if pair.is_upright:
            return classify_invariants(Invariants.of(pair), kinds, sides)
        f, g = characteristic(pair.lengths), poles(pair.lengths)
        return _position(*roots_outward(f, g, g), sides)
    except AssertionError as error:
        raise AssertionError(f"{error}, for {pair}") from error


def classify_invariants(
    pair: Invariants, kinds: Mapping[str, Kind] = KIND_OF, sides: Mapping[str, Side] = MEANING
) -> RootReport:
    """The same for an upright pair given by its invariants, which need not be those of float64 numbers."""
    roots = _upright_roots(pair)
    pattern = pattern_of(of_both_sides(*roots))
    occurs = _occurs(pair)
    possible = [kind for kind in Kind if occurs[kind.occurs]]
    kind, found = kinds.get(pattern), _position(*roots, sides)
    if kind not in possible or (kind.position, kind.tangent) != (found.position, found.tangent):
        raise AssertionError(f"the roots of g form a pattern that is not possible: {pattern}")
    literal_kinds = same_signs(pattern, possible)
    literal = {other.position for other in literal_kinds}
    return replace(
        found,
        kind=kind,
        pattern=pattern,
        literal=literal.pop() if len(literal) == 1 else None,
        literal_kinds=literal_kinds,
    )


def _position(
    roots_below: Iterable[tuple[str, int]], roots_above: Iterable[tuple[str, int]], table: Mapping[str, Side]
) -> RootReport:
    below, above = word_of(roots_below), word_of(roots_above)
    sides = table.get(below), table.get(above)
    if None in sides or sides.count(Side.NEITHER) == 0:
        raise AssertionError(f"the roots form a pattern that is not possible: {below} | {above}")
    position = Position.CONTACT
    if Side.CLEAR in sides:
        position = Position.EXTERIOR if sides[1] is Side.CLEAR else Position.INTERIOR
    return RootReport(position, Side.TANGENT in sides, below, above)


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
    """The places and multiplicities of the distinct real roots of the cubic, in ascending order."""
    return of_both_sides(*_upright_roots(pair))


def _upright_roots(pair: Invariants) -> tuple[Roots, Roots]:
    return roots_outward(coefficients(pair), linear_factor(-pair.A), linear_factor(pair.B))


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


def roots_outward(f: Polynomial, g_below: Polynomial, g_above: Polynomial) -> tuple[Roots, Roots]:
    """The real roots of f below 0 and above it, outward, beside the root next to 0 of each of two polynomials."""
    factors = tuple(_factors(f))
    return _side(factors, g_below, -1), _side(factors, g_above, 1)


def _side(factors: Sequence[tuple[Polynomial, int]], g: Polynomial, sign: int) -> Roots:
    """The roots of one side, outward; R is the root of g next to 0 there."""
    if len(g) == 2:
        near = far = Fraction(-g[1], g[0])
        at_end = [len(factor) > 1 and not value(factor, near) for factor, _ in factors]
    else:
        poles = squarefree(g)
        shared = [common_divisor(factor, poles) for factor, _ in factors]
        others = [quotient(factor, common) for (factor, _), common in zip(factors, shared, strict=True)]
        near, far = _about_root(poles, others, sign)
        at_end = [roots_between(both, *sorted((near, far))) > 0 for both in shared]
    multiple = next((Fraction(-factor[1], factor[0]) for factor, times in factors if times > 1), None)
    counted = [
        divided_by_root(factor, near) if both and near == far else factor
        for (factor, _), both in zip(factors, at_end, strict=True)
    ]

    def count(factor: Polynomial, start: Fraction, end: Fraction | None) -> int:
        return roots_between(factor, start, end) if sign > 0 else roots_between(factor, end, start)

    places: Roots = []
    for place, start, end in ((INNER, Fraction(0), near), (BEYOND, far, None)):
        if place is BEYOND:
            places += [(END, times) for (_, times), both in zip(factors, at_end, strict=True) if both]
        if multiple is not None and abs(start) < sign * multiple and (end is None or sign * multiple < abs(end)):
            simple, (_, times) = counted[0], factors[-1]
            places += [(place, 1)] * count(simple, start, multiple)
            places += [(place, times), *[(place, 1)] * count(simple, multiple, end)]
        else:
            for factor, (_, times) in zip(counted, factors, strict=True):
                places += [(place, times)] * count(factor, start, end)
    return places


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


def _about_root(f: Polynomial, others: Sequence[Polynomial], sign: int) -> tuple[Fraction, Fraction]:
    """Two numbers, the nearer to 0 first, about the root of f next to 0 on one side.

    Between them there is no other root of f, which is squarefree, and none of the others, which do not have that root.
    Its exponent is found first, since roots may be 10³⁰⁰ apart.
    """
    if sign < 0:
        low, high = _about_root(_mirrored(f), [_mirrored(other) for other in others], 1)
        return -low, -high

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
