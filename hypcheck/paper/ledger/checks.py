"""The checks that claims.toml names: small identities, the table of root patterns, pairs with one cubic."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import chain, combinations_with_replacement, groupby, product
from math import inf

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.links import known
from hypcheck.derivation.pencil import read, symbol
from hypcheck.derivation.printed_equations import check, equality, printed_claims
from hypcheck.geometry.pair import UPRIGHT, Pair, Position
from hypcheck.paper.ledger import points, statements
from hypcheck.paper.ledger.entry import Evidence, by_printed, described, signs, with_counterexample
from hypcheck.proofs.build import pattern_table
from hypcheck.truth import exact
from hypcheck.truth.certificate import check_certificate
from hypcheck.truth.kinds import Kind
from hypcheck.truth.prove import prove
from hypcheck.truth.roots import BEYOND, END, INNER, PATTERNS, RootPlace, of_both_sides, pattern_of


def _same(text: str, left: sympy.Expr, right: sympy.Expr) -> Evidence:
    """Return evidence that two expressions are equal; `text` states it."""
    return Evidence("identity", text, sympy.simplify(left - right) == 0)


def discriminant_and_coefficients() -> Evidence:
    """Return evidence that (13) is the discriminant and (14) the coefficients."""
    product = known("Δ is the product of the squared differences of the roots")
    return Evidence("identity", product.text, product.holds and by_printed("(13) and (14)").holds)


def listed_patterns(patterns: Mapping[Kind, Sequence[str]] = PATTERNS) -> Evidence:
    """Return evidence that the hand-written table of root patterns has the patterns that signs allow, each once."""
    listed = sorted(chain.from_iterable(patterns.values()))
    allowed = sorted(admissible())
    wrong = sorted(set(listed) ^ set(allowed)) or (["a pattern twice"] if listed != allowed else [])
    text = f"{len(listed)} patterns are listed, the {len(allowed)} that can occur"
    return Evidence("exhaustive", f"the table is wrong in {', '.join(wrong)}" if wrong else text, not wrong)


def sides_by_signs(*numbers: int) -> Iterator[list[tuple[str, int]]]:
    """Yield the roots of one side, outward, that the signs of f allow: exact reasoning, without the table.

    The number of roots on a side is one of `numbers`. The number beyond R has the same parity, unless R is a root.
    """
    for number in numbers:
        for places in combinations_with_replacement((INNER, END, BEYOND), number):
            if END in places or (places.count(BEYOND) - number) % 2 == 0:
                yield from _multiplicities(places)


def admissible() -> frozenset[str]:
    """Return every root pattern of an upright pair that the signs allow.

    There are one or three roots, an odd number of them above 0.
    """
    return frozenset(
        pattern_of(of_both_sides(below, above))
        for numbers in ((0, 1), (0, 3), (2, 1))
        for below, above in product(*(tuple(sides_by_signs(number)) for number in numbers))
    )


_COMPOSITIONS = {1: ((1,),), 2: ((1, 1), (2,)), 3: ((1, 1, 1), (1, 2), (2, 1), (3,))}


def _multiplicities(places: Iterable[str]) -> Iterator[list[tuple[str, int]]]:
    """Yield every grouping of the roots in one open interval into multiple roots; roots at R are one root."""
    choices = []
    for place, group in groupby(places):
        count = len(list(group))
        groups = ((count,),) if place == END else _COMPOSITIONS[count]
        choices.append([[(place, multiplicity) for multiplicity in sizes] for sizes in groups])
    for choice in product(*choices):
        yield list(chain.from_iterable(choice))


def patterns_in_coq(patterns: Mapping[Kind, Sequence[str]] = PATTERNS) -> Evidence:
    """Return evidence that Coq's table of root patterns equals the hand-written one."""
    ours = {(kind.value, _meaning(kind), pattern) for kind, listed in patterns.items() for pattern in listed}
    coqs = [
        (kind, meaning, pattern_of((_PLACES[place], count) for place, count in roots))
        for kind, meaning, roots in pattern_table()
    ]
    return Evidence("coq", "proofs/RootPatterns.v has the same rows", len(coqs) == len(ours) and set(coqs) == ours)


_PLACES = {
    "Below": RootPlace.BELOW,
    "AtMinusA": RootPlace.AT_MINUS_A,
    "Inner": RootPlace.INNER,
    "Outer": RootPlace.OUTER,
    "AtB": RootPlace.AT_B,
    "Above": RootPlace.ABOVE,
}


def _meaning(kind: Kind) -> str:
    """Return Coq's name for the position of a kind."""
    side = {Position.EXTERIOR: "Outside", Position.INTERIOR: "Inside"}
    if kind.limit_of is not None:
        return f"Touches{side[kind.limit_of]}"
    return f"Clear{side[kind.position]}" if kind.position in side else "Crosses"


REMARK_4 = (
    (points.SquaredRatios("1", "3", "9/32", "175/32"), points.SquaredRatios("2/5", "15/2", "147/1580", "44/79")),
    ("-3/4", "-1/2", "8"),
)
REMARK_6 = (
    (points.SquaredRatios("12/5", "5/2", "1683/245", "3/98"), points.SquaredRatios("12", "1/2", "91/5", "3/10")),
    ("1", "2", "3"),
)
"""For each remark two pairs, the first clear and the second in contact, and the roots of their common cubic g."""


def same_cubic_of_interior_and_contact() -> Evidence:
    """Return evidence that no function of g distinguishes an interior pair from one in contact (Remark 4)."""
    return _same_cubic(REMARK_4, Position.INTERIOR, lambda pair: pair.B**2 >= pair.A)


def same_cubic_of_exterior_and_contact() -> Evidence:
    """Return evidence that no function of g distinguishes an exterior pair from one in contact (Remark 6)."""
    return _same_cubic(REMARK_6, Position.EXTERIOR, lambda pair: pair.A >= 1)


def _same_cubic(
    case: tuple[tuple[points.SquaredRatios, points.SquaredRatios], tuple[str, str, str]],
    clear: Position,
    regime: Callable[[points.SquaredRatios], bool],
) -> Evidence:
    """Return evidence that g does not determine the position in a regime: two pairs with the same g.

    `case` has a clear pair, a pair in contact, and the roots of their g.
    """
    pairs, roots = case
    first, second, third = map(Fraction, roots)
    expected = (-(first + second + third), first * second + first * third + second * third, -first * second * third)
    holds = all(regime(pair) and points.coefficients(pair) == expected for pair in pairs)
    positions = tuple(_position_by_roots(first, second, pair) for pair in pairs)
    labels = "; ".join(f"{pair}: {position.label}" for pair, position in zip(pairs, positions, strict=True))
    text = f"g = (λ − {first})(λ − {second})(λ − {third}) for {labels}".replace("− -", "+ ").replace("-", "−")
    return Evidence("identity", text, holds and positions == (clear, Position.CONTACT))


def _position_by_roots(low: Fraction, high: Fraction, pair: points.SquaredRatios) -> Position:
    """Return the position of a pair whose g has these two least roots: g > 0 between them, and above the third.

    The third is at least B, so only these matter (docs/mathematics.md, "The rule that needs no hypothesis").
    """
    if max(low, Fraction(0)) < min(high, pair.B):
        return Position.EXTERIOR
    return Position.INTERIOR if max(low, -pair.A) < min(high, Fraction(0)) else Position.CONTACT


@cache
def _c2_of_12() -> points.Rational:
    """Return the coefficient of λ² that (12) prints, in a, c, x_c, y_c and z_c."""
    (claim,) = (claim for claim in printed_claims() if claim.number == "12")
    ((right, _),) = claim.pairs
    letters = (pencil.SMALL_A, pencil.SMALL_C, pencil.XC, pencil.YC, pencil.ZC)
    return points.rational(letters, sympy.Poly(right, pencil.LAMBDA).coeff_monomial(pencil.LAMBDA**2))


def by_12(facts: points.PointFacts) -> points.PointFacts:
    """Return the facts of a pair if g were the cubic that (12) prints; the position is unchanged."""
    point = facts.point
    return points.with_c2(facts, _c2_of_12()(point.a, point.c, point.r, 0, point.z))


_MISLED_BY_12 = (
    points.Statement(
        "by (12) and Proposition 3 as printed exterior ⟹ exterior",
        statements.tall,
        lambda facts: (
            statements.exterior(facts) or not (by_12(facts).delta > 0 and statements.three_positive(by_12(facts)))
        ),
    ),
    points.Statement(
        "by (12) and Proposition 5 as printed interior ⟹ interior",
        statements.wider,
        lambda facts: (
            statements.interior(facts) or not (by_12(facts).delta > 0 and statements.printed_interior(by_12(facts)))
        ),
    ),
)


def misled_by_12() -> Evidence:
    """Return evidence that (12) misleads: pairs in contact that a printed proposition calls clear, in its regime."""
    evidence = with_counterexample(*_MISLED_BY_12)
    answers = ("exterior by Proposition 3", "interior by Proposition 5")
    text = "; ".join(
        f"{described(witness.facts)}; with (12) as printed {signs(by_12(witness.facts))}: {answer}"
        for witness, answer in zip(evidence.witnesses, answers, strict=False)
    )
    return replace(evidence, text=text or evidence.text)


def regime_of_section_4() -> Evidence:
    """Return evidence that section 4 means a ≥ 1 by the regime (a/b) ≥ 1 of Proposition 5, because a is α/b by (12)."""
    meaning = read("α/b")
    checked = check((equality("Section 4", "regime = a/b", a=meaning, regime=meaning),))
    printed_as = read("a/b").subs(pencil.SMALL_A, meaning) == read("α/b²")
    right = checked.verdict == "misprint" and checked.correction == "regime = a" and printed_as
    return Evidence("identity", checked.finding, bool(right))


def roots_of_f() -> Evidence:
    """Return evidence that f has one more root than the cubic g."""
    factor = known("det(λH + S) = (A + λ)·g(λ)/(A²·B)")
    degree = sympy.degree(pencil.cubic().g, pencil.LAMBDA)
    return Evidence("identity", factor.text, factor.holds and degree == 3)


def scaling_of_the_spheroid() -> Evidence:
    """Return evidence that the scaling makes the spheroid's matrix the unit matrix, and is symmetric."""
    b, d = sympy.symbols("b d", positive=True)
    scaling, matrix = sympy.diag(1 / b, 1 / b, 1 / d), sympy.diag(1 / b**2, 1 / b**2, 1 / d**2)
    unit = scaling.inv() * matrix * scaling.inv() == sympy.eye(3)
    return Evidence("identity", "A⁻¹·E·A⁻¹ = I", bool(unit and scaling == scaling.T))


def mirrored_cubic() -> Evidence:
    """Return evidence that g(−λ) is as stated in the proof of Proposition 3."""
    cubic, at = pencil.cubic(), pencil.LAMBDA
    mirrored = -(at**3) + cubic.c2 * at**2 - cubic.c1 * at + cubic.c0
    return _same("g(−λ)", sympy.expand(cubic.g.subs(at, -at)), sympy.expand(mirrored))


def constant_of_the_cubic() -> Evidence:
    """Return evidence that c0 is −AB, and so is below 0."""
    return _same("c0 = −AB", sympy.expand(pencil.cubic().c0), -pencil.A * pencil.B)


_ANGLE = sympy.Symbol("g", real=True)
_COSINE, _SINE = sympy.cos(_ANGLE), sympy.sin(_ANGLE)


def squares_of_t1_and_t2() -> Evidence:
    """Return evidence that T1² + T2² of equation (15) is 2."""
    return _same("T1² + T2² = 2", (_COSINE - _SINE) ** 2 + (_COSINE + _SINE) ** 2, sympy.Integer(2))


def radius_at_a_height() -> Evidence:
    """Return evidence that the hyperboloid is wider farther from its waist: its shape is not similar at all heights."""
    alpha, gamma, z = map(symbol, ("α", "γ", "z0"))
    radius = alpha * sympy.sqrt(1 + z**2 / gamma**2)
    return _same("R² − α² = α²·z²/γ²", radius**2 - alpha**2, (alpha * z / gamma) ** 2)


def probabilities() -> Evidence:
    """Return evidence that the probabilities of the rules of flight add up to 1."""
    return Evidence("count", "0.25 + 0.25 + 0.5 = 1", 0.25 + 0.25 + 0.5 == 1)


_SEMI_AXES = sympy.symbols("b d", positive=True)
_PLACE = sympy.symbols("x y z", real=True)


def spheroid_after_a_turn() -> Evidence:
    """Return evidence that a turn about the axis leaves the spheroid as it is."""
    (b, d), (x, y, z) = _SEMI_AXES, _PLACE
    turned = ((x * _COSINE - y * _SINE) ** 2 + (x * _SINE + y * _COSINE) ** 2) / b**2 + z**2 / d**2
    return _same("(x² + y²)/b² + z²/d² after a turn", turned, (x**2 + y**2) / b**2 + z**2 / d**2)


def _mixed_term() -> sympy.Expr:
    """Return the coefficient of x·z in the equation of a spheroid that is tilted."""
    (b, d), (x, y, z) = _SEMI_AXES, _PLACE
    ahead, up = x * _COSINE - z * _SINE, x * _SINE + z * _COSINE
    return sympy.expand(ahead**2 / b**2 + y**2 / b**2 + up**2 / d**2).coeff(x, 1).coeff(z, 1)


def tilted_spheroid() -> Evidence:
    """Return evidence that the equation of a tilted spheroid has a term x·z, which equation (4) never has."""
    b, d = _SEMI_AXES
    return _same("the coefficient of x·z", _mixed_term(), sympy.sin(2 * _ANGLE) * (1 / d**2 - 1 / b**2))


def tilted_spheroid_is_another() -> Evidence:
    """Return evidence that the coefficient of x·z of a tilted spheroid is not 0."""
    return Evidence("identity", "it is not 0", sympy.simplify(_mixed_term()) != 0)


def changed_by_tilt() -> Evidence:
    """Return the simplest pairs in the regime of Procedures 2.a and 2.b whose position changes when they are tilted."""
    searches = (
        points.first_change(
            Position.INTERIOR, Position.CONTACT, "dangerous: the upright body is clear, the tilted one is not"
        ),
        points.first_change(
            Position.CONTACT, Position.INTERIOR, "needless: the upright body is refused, the tilted one is clear"
        ),
    )
    witnesses = tuple(search.found for search in searches if search.found is not None)
    text = (
        "; ".join(item.text for item in witnesses)
        or f"nothing found among {sum(item.tried for item in searches):,} pairs"
    )
    return Evidence(
        "search", text, len(witnesses) == len(searches) and all(item.holds for item in witnesses), tilted=witnesses
    )


def missed_by_the_centres_height() -> Evidence:
    """Return the simplest pairs in the regime of Procedures 2.a and 2.b that a test by the centre's height gets wrong.

    One pair has its centre above z_max, where no test is made, and meets the wall; one has its centre below z_max, and
    meets only the infinite continuation of the wall.
    """
    witnesses = (_above_the_end(), _below_the_end())
    shows = ("above it, in contact with the wall", "not above it, interior; in contact without the end")
    text = "; ".join(f"{_with_end(pair)} {what}" for pair, what in zip(witnesses, shows, strict=True))
    proofs = (prove(pair, exact.decide(pair.lengths)) for pair in witnesses)
    proved = all(check_certificate(pair, proof) for pair, proof in zip(witnesses, proofs, strict=True))
    return Evidence("search", text, proved)


def _above_the_end() -> Pair:
    """Find the simplest pair whose centre is above the wall's end and that is in contact with the wall."""
    pairs = (_ending(row, row[6] - 1) for row in points.quadcopter_pairs(points.LARGEST))
    decided = ((pair, exact.decide(pair.lengths)) for pair in pairs)
    return next(pair for pair, decision in decided if decision.position is Position.CONTACT and not decision.tangent)


def _below_the_end() -> Pair:
    pairs = (_ending((*row[:6], -row[6]), -row[6]) for row in points.quadcopter_pairs(points.LARGEST))
    return next(
        pair
        for pair in pairs
        if exact.position(pair.lengths) is Position.INTERIOR
        and exact.position(pair.without_ends.lengths) is Position.CONTACT
    )


def _ending(row: Sequence[float], height: float) -> Pair:
    """Return the upright pair whose wall ends at this height."""
    return Pair.from_row((*row, *UPRIGHT, -inf, height, 0.0))


def _with_end(pair: Pair) -> str:
    """Return the pair in words: "α = 3, γ = 1, b = 3, d = 2, C = (1, 0, 1), z_max = 0:"."""
    return f"{points.sizes_and_centre(pair)}, z_max = {pair.z_max:g}:".replace("-", "−")
