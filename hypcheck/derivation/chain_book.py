"""All chains by name: Propositions 3 and 5 and Procedure 1 repaired, the rules for every size, and what they need.

- Proposition 3, repaired: for (γ/d)² ≥ α/b, which is B² ≥ A, exterior by Δ, c2 and c1, and the ring.
- Procedure 1, repaired: in the plane of the waist r > a + 1 decides; elsewhere there is no ring.
- Proposition 5, repaired: for α/b ≥ 1, which is A ≥ 1, interior by Δ, c2, c1, and the positions that the printed
  condition drops.
- The coefficient rule and the local maximum decide for every size, and the programs that answer by them do so.
"""

from __future__ import annotations

from functools import cache
from itertools import product

import sympy

from hypcheck.derivation import pencil, root_chains
from hypcheck.derivation.decisions import SIGNS
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.links import GENERIC_CUBIC, Chain, FiniteCases, Link, identity, known, sign
from hypcheck.derivation.pencil import LAMBDA, A, B, P, Q, symbol
from hypcheck.derivation.proofs import proofs_of
from hypcheck.derivation.root_chains import positions_chain, roots_chain
from hypcheck.derivation.rule_chain import rule_chain, theorem_1


def proposition_3() -> Chain:
    """Both directions, and what Δ ≤ 0 leaves."""
    return Chain(
        "Proposition 3, repaired",
        "For (γ/d)² ≥ α/b: exterior ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring (z0 = 0, g'(B) = 0, A < B²). Δ ≤ 0 means "
        "contact or the ring.",
        (
            _not_all_beyond_B(),
            root_chains.true_of_patterns(
                "So exterior ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring.",
                lambda roots: not (roots.crowded and roots.all_positive),
                lambda roots: ((roots.delta > 0 and roots.all_positive) or roots.ring) == (roots.position > 0),
            ),
            root_chains.no_contact_but_the_ring(),
        ),
        needs=("rule", "roots", "positions"),
    )


def _not_all_beyond_B() -> Link:
    return Link(
        "Three different positive roots are not all at least B, at B + u, B + v and B + w: their product A·B would "
        "exceed B³, against B² = A + k with k ≥ 0. So the lower two lie in (0, B], and g > 0 between them.",
        "sign",
        (
            sign("(B + u)·(B + v)·(B + w) − B³ > 0", "B v w", "u"),
            identity("A·B − B³ = −B·(B² − A)", A * B - B**3),
            sign("−B·k ≤ 0", "B", "k"),
        ),
    )


def procedure_1() -> Chain:
    """Both cases of the procedure put right."""
    return Chain(
        "Procedure 1, repaired",
        "For (γ/d)² ≥ α/b: exterior ⟺ E > 0 and E² > 4·A where Q = 0, with E = P − A − 1; elsewhere Δ > 0, c2 < 0 and "
        "c1 > 0.",
        (
            *_in_the_plane_of_the_waist(),
            Link(
                "In lengths E > 0 and E² > 4·A say r > a + 1: with r = a + 1 + t, E² − 4·A is positive exactly where t "
                "is, for r > 0.",
                "identity",
                (
                    identity(
                        "E² − 4·A = t·(t + 2)·(t + 2·a)·(t + 2·a + 2)",
                        ((symbol("a") + 1 + symbol("t")) ** 2 - symbol("a") ** 2 - 1) ** 2 - 4 * symbol("a") ** 2,
                    ),
                ),
            ),
            Link(
                "Where Q > 0 there is no ring, since g(B) = −B·Q·(A + B) < 0 leaves no root at B; Proposition 3, "
                "repaired, says the rest.",
                "identity",
                (identity("g(B) = −B·Q·(A + B)", pencil.cubic().g.subs(LAMBDA, B)),),
            ),
        ),
        needs=("rule", "Proposition 3, repaired"),
    )


def _in_the_plane_of_the_waist() -> tuple[Link, ...]:
    e, u, v = symbol("E"), symbol("u"), symbol("v")
    return (
        Link(
            "Where Q = 0, g is (λ − B) times a quadratic. So in (0, B), where λ − B < 0, g > 0 exactly where the "
            "quadratic is negative.",
            "identity",
            (identity("g = (λ − B)·(λ² − E·λ + A)", pencil.cubic().g.subs(Q, 0), E=P - A - 1),),
        ),
        Link(
            "If E > 0 and E² > 4·A, the quadratic has two different roots u and u + v, u, v > 0, of sum E and of "
            "product A; between them it is negative. The smaller has u² < A ≤ B², so part of that is in (0, B): "
            "exterior.",
            "sign",
            (
                identity("(λ − u)·(λ − u − v) = λ² − (2·u + v)·λ + u·(u + v)", (LAMBDA - u) * (LAMBDA - u - v)),
                sign("u·(u + v) − u² > 0", "u v"),
                sign("(2·u + v)² − 4·u·(u + v) > 0", "u v"),
            ),
        ),
        Link(
            "If E = −h ≤ 0, all terms of the quadratic are ≥ 0 for λ = s > 0, and one is > 0; if E² ≤ 4·A, it is a "
            "square and k = A − E²/4 ≥ 0. So it is nowhere negative in (0, B): not exterior.",
            "sign",
            (
                sign("s² + h·s + A > 0", "A s", "h"),
                identity("(λ − E/2)² + A − E²/4 = λ² − E·λ + A", (LAMBDA - e / 2) ** 2 + A - e**2 / 4),
            ),
        ),
    )


def proposition_5() -> Chain:
    """Both directions, and the patterns that the printed statement leaves out."""
    return Chain(
        "Proposition 5, repaired",
        "For α/b ≥ 1: interior ⟺ Δ > 0 and not (c2 < 0 and c1 > 0). Δ ≤ 0 means contact or the ring.",
        (
            _two_negative(),
            _not_both_beyond_minus_A(),
            root_chains.true_of_patterns(
                "So interior ⟺ Δ > 0 and not (c2 < 0 and c1 > 0).",
                lambda roots: not (roots.crowded and not roots.all_positive),
                lambda roots: (roots.delta > 0 and not roots.all_positive) == (roots.position < 0),
            ),
            root_chains.no_contact_but_the_ring(),
            _dropped(),
        ),
        needs=("rule", "roots", "positions"),
    )


def _two_negative() -> Link:
    r1, r2, s = root_chains.ROOTS
    return Link(
        "Δ > 0 and not (c2 < 0 and c1 > 0): not all roots are positive, by Vieta; none is 0; and the product A·B > 0 "
        "makes two of them negative.",
        "sign",
        (
            *root_chains.positive_roots_have_signs().parts,
            identity("−c0 = r1·r2·s", r1 * r2 * s),
            sign("A·B > 0", "A B"),
        ),
    )


def _not_both_beyond_minus_A() -> Link:
    return Link(
        "They are not both at most −A, at −A − u and −A − v: the third, A·B over their product, would be below B, with "
        "A = 1 + k, k ≥ 0. So both lie in [−A, 0), and g > 0 between them.",
        "sign",
        (sign("B − (1 + k)·B/((1 + k + u)·(1 + k + v)) > 0", "B v", "k u"),),
    )


def _dropped() -> Link:
    """With c0 = −r, r > 0."""
    p, q, r = (symbol(name) for name in "pqr")
    generic = pencil.discriminant_of_cubic()
    c2, c1, c0 = (symbol(name) for name in ("c2", "c1", "c0"))
    return Link(
        "Of these interior positions the printed [c2 > 0, c1 ≠ 0] or [c2 < 0, c1 < 0] drops those with c2 = 0 > c1 and "
        "those with c1 = 0 < c2, and no others: c2 = 0 ≤ c1 = q and c1 = 0 ≥ c2 = −p have Δ < 0 (as Δ(c2, c1, c0), c0 "
        "= −r).",
        "case split",
        (
            FiniteCases(
                "the printed condition and not (c2 < 0 and c1 > 0) differ ⟺ c2 = 0 or c1 = 0",
                tuple(product(SIGNS, repeat=2)),
                only_zeros_are_dropped,
            ),
            identity("Δ(0, q, −r) = −4·q³ − 27·r²", generic.subs({c2: 0, c1: q, c0: -r})),
            sign("−4·q³ − 27·r² < 0", "r", "q"),
            identity("Δ(−p, 0, −r) = −4·p³·r − 27·r²", generic.subs({c1: 0, c2: -p, c0: -r})),
            sign("−4·p³·r − 27·r² < 0", "r", "p"),
        ),
    )


def only_zeros_are_dropped(c2: int, c1: int) -> bool:
    """Whether the repaired and the printed condition differ at these signs exactly if one of them is 0."""
    printed = (c2 > 0 and c1 != 0) or (c2 < 0 and c1 < 0)
    repaired = not (c2 < 0 and c1 > 0)
    return (printed != repaired) == (0 in (c2, c1))


PROGRAMS = ("coefficients", "hessian", "shared")
"""The formulas that decide by this rule."""


def all_sizes() -> Chain:
    """Without c² ≥ a and a ≥ 1: which three positive roots, and which two negative ones, mean a clear position."""
    return Chain(
        "all sizes",
        "For all a, c > 0: exterior ⟺ Δ > 0, c2 < 0, c1 > 0 and not (c2 < −3B and g'(B) > 0), or the ring; interior ⟺ "
        "Δ > 0, not (c2 < 0 and c1 > 0), c2 < 3A and g'(−A) > 0.",
        (
            _all_beyond_B(),
            _two_below_B(),
            _both_above_minus_A(),
            _both_beyond_minus_A(),
            root_chains.true_of_patterns(
                "So the rule holds; among patterns with Δ > 0 the two inequalities at B, or at −A, tell the crowded "
                "ones.",
                lambda _: True,
                lambda roots: _by_rule(roots) == roots.position,
            ),
            *map(program_is_the_rule, PROGRAMS),
        ),
        needs=("rule", "roots", "positions"),
    )


def _by_rule(roots: root_chains.Pattern) -> int:
    if roots.ring or (roots.delta > 0 and roots.all_positive and not roots.crowded):
        return 1
    return -1 if roots.delta > 0 and not roots.all_positive and not roots.crowded else 0


def _at(place: str) -> dict[str, object]:
    """c2 and g' of three roots named by their distances to −A or to B."""
    r1, r2, s = root_chains.ROOTS
    u, v, w, t = (symbol(name) for name in "uvwt")
    roots = {
        "beyond B": (B + u, B + v, B + w),
        "about B": (B - u, B - v, B + w),
        "above −A": (-A + u, -A + v, t),
        "beyond −A": (-A - u, -A - v, t),
    }[place]
    values = dict(zip((r1, r2, s), roots, strict=True))
    pole = B if place.endswith("B") else -A
    c2, _, _ = root_chains.coefficients_of_roots()
    return {
        "c2": c2.subs(values, simultaneous=True),
        "slope": root_chains.slope_of_roots(pole).subs(values, simultaneous=True),
    }


def _all_beyond_B() -> Link:
    at = _at("beyond B")
    return Link(
        "Three different roots B + u, B + v, B + w, none below B, have c2 < −3B and g'(B) > 0: a crossing, not "
        "exterior.",
        "sign",
        (
            identity("g'(λ) = 3·λ² + 2·c2·λ + c1", GENERIC_CUBIC.diff(LAMBDA)),
            identity("c2 + 3·B = −(u + v + w)", at["c2"] + 3 * B),
            sign("−(u + v + w) < 0", "v w", "u"),
            identity("g'(B) = u·v + v·w + w·u", at["slope"]),
            sign("u·v + v·w + w·u > 0", "v w", "u"),
        ),
    )


def _two_below_B() -> Link:
    at = _at("about B")
    return Link(
        "Three different positive roots of which two are at most B, B − u, B − v and B + w, cannot have both: c2 < −3B "
        "means w = u + v + k with k > 0, and then g'(B) < 0. They are exterior.",
        "sign",
        (
            identity("c2 + 3·B = u + v − w", at["c2"] + 3 * B),
            identity("g'(B) = u·v − w·(u + v)", at["slope"]),
            sign("u·v − (u + v + k)·(u + v) < 0", "u k", "v"),
        ),
    )


def _both_above_minus_A() -> Link:
    at = _at("above −A")
    return Link(
        "Two different negative roots −A + u and −A + v in [−A, 0) beside t > 0 have c2 < 3A and g'(−A) > 0: interior.",
        "sign",
        (
            identity("c2 − 3·A = −(A + u + v + t)", at["c2"] - 3 * A),
            sign("−(A + u + v + t) < 0", "A v t", "u"),
            identity("g'(−A) = u·v + (u + v)·(A + t)", at["slope"]),
            sign("u·v + (u + v)·(A + t) > 0", "A v t", "u"),
        ),
    )


def _both_beyond_minus_A() -> Link:
    at = _at("beyond −A")
    return Link(
        "Two different roots −A − u and −A − v, none above −A, cannot have both: c2 < 3A means A + t = u + v + k with "
        "k > 0, and then g'(−A) < 0. They cross.",
        "sign",
        (
            identity("c2 − 3·A = u + v − (A + t)", at["c2"] - 3 * A),
            identity("g'(−A) = u·v − (u + v)·(A + t)", at["slope"]),
            sign("u·v − (u + v)·(u + v + k) < 0", "v k", "u"),
        ),
    )


def program_is_the_rule(name: str) -> Link:
    """The proofs of the program, which `hypcheck verify` records too."""
    proofs = proofs_of(FORMULAS[name])
    return Link(
        f"The program {name} computes these numbers, and decides by this rule.",
        "case split",
        (
            FiniteCases(
                f"{len(proofs)} proofs of the program {name}", tuple((proof,) for proof in proofs), lambda p: p.holds
            ),
        ),
    )


def local_maximum() -> Chain:
    """From "g > 0 somewhere between two places where it is not" to one value of g."""
    return Chain(
        "local maximum",
        "For all a, c > 0: with h1 = c2² − 3·c1 > 0, λm = (−c2 − √h1)/3 and g(λm) > 0, exterior if 0 < λm < B, "
        "interior if −A < λm < 0; else contact.",
        (
            Link(
                "g is not positive at −A, 0 and B; where it is positive between two of them it has a local maximum.",
                "sign",
                (
                    known("g(−A) = −AP(A + B)"),
                    known("g(0) = −AB"),
                    known("g(B) = −BQ(A + B)"),
                    sign("−A·P·(A + B) ≤ 0", "A B", "P"),
                    sign("−A·B < 0", "A B"),
                    sign("−B·Q·(A + B) ≤ 0", "A B", "Q"),
                ),
            ),
            Link(
                "A cubic that grows has one at most, at the lower zero of g', where g'' < 0; without h1 > 0 it has "
                "none.",
                "identity",
                (
                    identity("coefficient of λ³ in g = 1", sympy.Poly(pencil.cubic().g, LAMBDA).LC()),
                    known("g'(λm) = 0"),
                    known("g''(λm) = −2√h1"),
                ),
            ),
            program_is_the_rule("local-maximum"),
        ),
        needs=("rule", "roots"),
    )


MAKERS = (
    theorem_1,
    rule_chain,
    roots_chain,
    positions_chain,
    proposition_3,
    procedure_1,
    proposition_5,
    all_sizes,
    local_maximum,
)


@cache
def chains() -> dict[str, Chain]:
    """The chains by name, in an order in which each comes after those it needs."""
    return {chain.name: chain for chain in (make() for make in MAKERS)}


def proved(name: str) -> bool:
    """Whether every link of a chain holds, and of the chains that it needs."""
    chain = chains()[name]
    return chain.holds and all(proved(needed) for needed in chain.needs)
