"""All proof chains by name, and the chains of the rules that hold for every size.

- Theorem 1: dividing x, y by b and z by d changes no position, and makes the spheroid the unit sphere.
- The rule without hypothesis: the bodies are clear if g > 0 somewhere between −A and B, and only then. φ is the
  Lagrange dual of the squared distance to the hyperboloid H (docs/mathematics.md). Letters: A = (α/b)², B = (γ/d)²,
  P = (x0² + y0²)/b² and Q = (z0/d)²; C = (x_c, y_c, z_c) is the scaled centre, h(X) = (x² + y²)/A − z²/B − 1 is 0 on
  H, and u = A + λ and v = B − λ are positive for −A < λ < B.
- The coefficient rule and the local maximum decide for every size, and the programs that answer by them do so.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import sympy

from hypcheck.derivation import pencil, root_chains
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.links import PHI, Chain, FiniteCases, Link, chain, identity, known, link, sign
from hypcheck.derivation.pencil import GENERIC_CUBIC, LAMBDA, XC, YC, ZC, A, B, P, Q, X, Y, Z, read, symbol
from hypcheck.derivation.proofs import proofs_of
from hypcheck.derivation.root_chains import positions_chain, procedure_1, proposition_3, proposition_5, roots_chain


def theorem_1() -> Chain:
    """Return the chain of Theorem 1. Its map is X̄ = A·X with the matrix A = diag(1/b, 1/b, 1/d) of equation (9)."""
    scaling = sympy.diag(1 / pencil.SMALL_B, 1 / pencil.SMALL_B, 1 / pencil.SMALL_D)
    return chain(
        "Theorem 1",
        "The spheroid's position relative to the hyperboloid is the unit sphere's relative to the scaled one.",
        link(
            "X̄ = A·X is one-to-one: A = diag(1/b, 1/b, 1/d) has a determinant above 0.",
            identity("det A = 1/(b²·d)", scaling.det()),
            sign("1/(b²·d) > 0", "b d"),
        ),
        link(
            "The hyperboloid's equation, with its values inside and outside, becomes (7).",
            identity("h(A⁻¹·X̄) = x²/(α/b)² + y²/(α/b)² − z²/(γ/d)² − 1", pencil.scaled(pencil.hyperboloid())),
        ),
        link(
            "The spheroid's equation becomes (8), that of a unit sphere. So points in common go to points in "
            "common, and inside stays inside.",
            identity("e(A⁻¹·X̄) = (x − x0/b)² + (y − y0/b)² + (z − z0/d)² − 1", pencil.scaled(pencil.spheroid())),
        ),
        link(
            "The roots stay the same too: the determinant of the pencil changes by a constant factor.",
            known("Theorem 1 divides the pencil's determinant by the constant 1/(b⁴d²)"),
        ),
    )


S_LEMMA = "S-lemma (Yakubovich 1971; Pólik and Terlaky, SIAM Review 49 (2007) 371–418)"

_U, _V = A + LAMBDA, B - LAMBDA
_OF_CENTRE = {P: XC**2 + YC**2, Q: ZC**2}
_SURFACE = (X**2 + Y**2) / A - Z**2 / B - 1
_SQUARED_DISTANCE = (X - XC) ** 2 + (Y - YC) ** 2 + (Z - ZC) ** 2
_SLOPE = sympy.diff(PHI, LAMBDA)
_NEAREST = {X: A * XC / _U, Y: A * YC / _U, Z: B * ZC / _V}


def rule_chain() -> Chain:
    """Return the chain of the rule for all sizes: the sign of g between its poles tells the position."""
    return chain(
        "rule",
        "For all a, c > 0: exterior ⟺ g(λ) > 0 for some λ in (0, B); interior ⟺ g(λ) > 0 for some λ in (−A, 0); "
        "contact ⟺ neither.",
        _weak_duality(),
        _attained_inside(),
        link(
            "φ is concave, so it has one largest value: where φ' = 0, or at a pole. At −A only if P = 0, at B only if "
            "Q = 0: else φ' is positive near −A, negative near B.",
            identity("φ''(λ) = −2·A·P/u³ − 2·B·Q/v³", sympy.diff(PHI, LAMBDA, 2), u=_U, v=_V),
            sign("−2·A·P/u³ − 2·B·Q/v³ ≤ 0", "A B u v", "P Q"),
            identity("u²·φ' at −A = A·P", sympy.cancel(_SLOPE * _U**2).subs(LAMBDA, -A)),
            identity("v²·φ' at B = −B·Q", sympy.cancel(_SLOPE * _V**2).subs(LAMBDA, B)),
            sign("A·P > 0", "A P"),
            sign("−B·Q < 0", "B Q"),
        ),
        _attained_at_minus_A(),
        _attained_at_B(),
        _s_lemma(),
        _sides(),
        link(
            "The ball is clear exactly if dist > 1, so exactly if φ > 0 somewhere between the poles; and there g has "
            "the sign of φ.",
            known("g(λ) = (A + λ)(B − λ)·φ(λ)"),
            sign("u·v > 0", "u v"),
            reason="identity",
        ),
        _no_fourth_position(),
    )


def _weak_duality() -> Link:
    """Return the link that φ(λ) + 1 is a lower bound of the squared distance for every λ in (−A, B)."""
    whole = _SQUARED_DISTANCE + LAMBDA * _SURFACE
    return link(
        "Every λ in (−A, B) bounds the distance: for X on H, where h = 0, |X − C|² ≥ φ(λ) + 1.",
        identity(
            "|X − C|² + λ·h(X) = u/A·((x − A·x_c/u)² + (y − A·y_c/u)²) + v/B·(z − B·z_c/v)² + φ + 1",
            whole,
            u=_U,
            v=_V,
            phi=PHI.subs(_OF_CENTRE),
        ),
        sign("u/A > 0", "u A"),
        sign("v/B > 0", "v B"),
        reason="identity",
    )


def _attained_inside() -> Link:
    """Return the link that the bound is attained where φ' = 0."""
    distance = (_SQUARED_DISTANCE + LAMBDA * _SURFACE).subs(_NEAREST)
    return link(
        "Where φ' = 0 the bound is attained: the minimiser X = (A·x_c/u, A·y_c/u, B·z_c/v) lies on H.",
        identity("φ'(λ) = A·P/u² − B·Q/v² − 1", _SLOPE, u=_U, v=_V),
        identity("h(X) = A·P/u² − B·Q/v² − 1", _SURFACE.subs(_NEAREST), u=_U, v=_V, **_centre()),
        identity("|X − C|² + λ·h(X) = φ + 1", distance, phi=PHI.subs(_OF_CENTRE)),
    )


def _centre() -> dict[str, sympy.Expr]:
    """Return the expressions of the centre's coordinates by their names in the formulas."""
    return {name.name: value for name, value in _OF_CENTRE.items()}


def _attained_at_minus_A() -> Link:
    """Return the link that the bound is attained if the supremum of φ is at −A."""
    on_axis = {XC: 0, YC: 0}
    height = B * ZC / (A + B)
    circle = {X: symbol("rho"), Y: 0, Z: height}
    radius = {"rho": sympy.sqrt(A * (1 + height**2 / B))}
    distance = _SQUARED_DISTANCE.subs(on_axis).subs(circle).subs(symbol("rho"), radius["rho"])
    return link(
        "If P = 0, φ falls all the way from −A, and the bound is attained there: on a circle of H at height B·z_c/(A + "
        "B).",
        identity("φ' without P = −B·Q/v² − 1", _SLOPE.subs(P, 0), v=_V),
        sign("−B·Q/v² − 1 < 0", "B v", "Q"),
        identity("h on the circle = 0", _SURFACE.subs(circle).subs(symbol("rho"), radius["rho"])),
        identity("|X − C|² on the circle = A + A·z_c²/(A + B)", distance),
        identity("φ(−A) + 1 without P = A + A·Q/(A + B)", (PHI.subs(P, 0) + 1).subs(LAMBDA, -A)),
        reason="identity",
    )


def _attained_at_B() -> Link:
    """Return the link about the points that attain the bound if the supremum of φ is at B.

    The points lie in the half plane y = 0, x ≥ 0 of the centre (r, 0, 0). The letter k is A·P − (A + B)².
    """
    r, zeta = symbol("r"), symbol("zeta")
    rho = A * r / (A + B)
    height = sympy.sqrt(B * (rho**2 / A - 1))
    in_waist = {XC: r, YC: 0, ZC: 0}
    points = {X: rho, Y: 0, Z: zeta}
    distance = _SQUARED_DISTANCE.subs(in_waist).subs(points).subs(zeta, height)
    return link(
        "If Q = 0 and φ' ≥ 0 up to B, which is A·P = (A + B)² + k with k ≥ 0, the bound is attained at B: in two "
        "points of H, at x = A·r/(A + B), r² = P.",
        identity("φ'(B) without Q = A·P/(A + B)² − 1", _SLOPE.subs(Q, 0).subs(LAMBDA, B)),
        identity("z²/B = A·P/(A + B)² − 1", height**2 / B, P=r**2),
        sign("((A + B)² + k)/(A + B)² − 1 ≥ 0", "A B", "k"),
        identity("h in the points = 0", _SURFACE.subs(points).subs(zeta, height)),
        identity("|X − C|² in the points = P·B/(A + B) − B", distance, P=r**2),
        identity("φ(B) + 1 without Q = P·B/(A + B) − B", (PHI.subs(Q, 0) + 1).subs(LAMBDA, B)),
        reason="identity",
    )


def _s_lemma() -> Link:
    """Return the link that cites the S-lemma and checks its hypothesis on either side of H.

    The hypothesis is that the constraint h ≤ 0, or −h ≤ 0, holds strictly at some point.
    """
    a = symbol("a")
    return link(
        "So the largest φ is dist(C, H)² − 1. The S-lemma says the same in general: |X − C|² ≥ ρ² wherever h ≤ 0 (or "
        "−h ≤ 0) exactly if some λ ≥ 0 (or ≤ 0) has |X − C|² − ρ² + λ·h ≥ 0 everywhere.",
        identity("h(0, 0, 0) = −1", _SURFACE.subs({X: 0, Y: 0, Z: 0})),
        sign("−1 < 0"),
        identity("h(2·a, 0, 0) = 3", _SURFACE.subs({X: 2 * a, Y: 0, Z: 0}).subs(A, a**2)),
        sign("3 > 0"),
        cites=S_LEMMA,
    )


def _sides() -> Link:
    """Return the link that the sign of a λ with φ(λ) > 0 tells the side of the centre."""
    tangent = PHI - PHI.subs(LAMBDA, 0) - _SLOPE.subs(LAMBDA, 0) * LAMBDA
    return link(
        "φ lies below its tangent at 0, which begins at −1 with the slope h(C): φ > 0 at a λ > 0 puts C outside H, at "
        "a λ < 0 inside.",
        identity("φ(0) = −1", PHI.subs(LAMBDA, 0)),
        identity("φ'(0) = P/A − Q/B − 1", _SLOPE.subs(LAMBDA, 0)),
        identity("h(C) = P/A − Q/B − 1", _SURFACE.subs({X: XC, Y: YC, Z: ZC}), **_centre()),
        identity("φ − φ(0) − φ'(0)·λ = −λ²·(P/(A·u) + Q/(B·v))", tangent, u=_U, v=_V),
        sign("−λ²·(P/(A·u) + Q/(B·v)) ≤ 0", "A B u v", "P Q"),
    )


def _no_fourth_position() -> Link:
    """Return the link that a pair is exterior, interior or in contact, and nothing else."""
    line = {X: read("α"), Y: read("α·t"), Z: read("γ·t")}
    reach = (X**2 + Y**2 + Z**2).subs(line)
    return link(
        "There is no fourth position: the ball, being connected, is wholly on one side if it is clear; and H, "
        "connected and without bound, does not fit into a ball.",
        known("the line (α, αt, γt), turned about the axis, lies on the hyperboloid"),
        identity("|(α, α·t, γ·t)|² = α² + (α² + γ²)·t²", reach),
        sign("α² + (α² + γ²)·t² > 0", "alpha gamma"),
        reason="identity",
    )


PROGRAMS = ("coefficients", "hessian", "shared")
"""The formulas that decide by the rule of `all_sizes`."""


def all_sizes() -> Chain:
    """Return the chain of the coefficient rule, which holds for all sizes, without c² ≥ a and a ≥ 1.

    It says which three positive roots, and which two negative ones, mean a clear position.
    """
    return chain(
        "all sizes",
        "For all a, c > 0: exterior ⟺ Δ > 0, c2 < 0, c1 > 0 and not (c2 < −3B and g'(B) > 0), or the ring; interior ⟺ "
        "Δ > 0, not (c2 < 0 and c1 > 0), c2 < 3A and g'(−A) > 0.",
        _all_beyond_B(),
        _two_below_B(),
        _both_above_minus_A(),
        _both_beyond_minus_A(),
        root_chains.true_of_patterns(
            "So the rule holds; among patterns with Δ > 0 the two inequalities at B, or at −A, tell the crowded ones.",
            lambda _: True,
            lambda roots: _by_rule(roots) == roots.position,
        ),
        *map(program_is_the_rule, PROGRAMS),
        needs=("rule", "roots", "positions"),
    )


def _by_rule(roots: root_chains.Pattern) -> int:
    """Return the position that the coefficient rule gives to a pattern of roots: 1, −1 or 0."""
    if roots.ring or (roots.delta > 0 and roots.all_positive and not roots.crowded):
        return 1
    return -1 if roots.delta > 0 and not roots.all_positive and not roots.crowded else 0


def _at(place: str) -> dict[str, object]:
    """Return c2 and g' of three roots that are given by their distances to −A or to B, by name.

    `place` selects the three roots: "beyond B", "about B", "above −A" or "beyond −A".
    """
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
    """Return the link about three roots none of which is below B."""
    at = _at("beyond B")
    return link(
        "Three different roots B + u, B + v, B + w, none below B, have c2 < −3B and g'(B) > 0: a crossing, not "
        "exterior.",
        identity("g'(λ) = 3·λ² + 2·c2·λ + c1", GENERIC_CUBIC.diff(LAMBDA)),
        identity("c2 + 3·B = −(u + v + w)", at["c2"] + 3 * B),
        sign("−(u + v + w) < 0", "v w", "u"),
        identity("g'(B) = u·v + v·w + w·u", at["slope"]),
        sign("u·v + v·w + w·u > 0", "v w", "u"),
    )


def _two_below_B() -> Link:
    """Return the link about three positive roots of which two are at most B."""
    at = _at("about B")
    return link(
        "Three different positive roots of which two are at most B, B − u, B − v and B + w, cannot have both: c2 < −3B "
        "means w = u + v + k with k > 0, and then g'(B) < 0. They are exterior.",
        identity("c2 + 3·B = u + v − w", at["c2"] + 3 * B),
        identity("g'(B) = u·v − w·(u + v)", at["slope"]),
        sign("u·v − (u + v + k)·(u + v) < 0", "u k", "v"),
    )


def _both_above_minus_A() -> Link:
    """Return the link about two negative roots in [−A, 0)."""
    at = _at("above −A")
    return link(
        "Two different negative roots −A + u and −A + v in [−A, 0) beside t > 0 have c2 < 3A and g'(−A) > 0: interior.",
        identity("c2 − 3·A = −(A + u + v + t)", at["c2"] - 3 * A),
        sign("−(A + u + v + t) < 0", "A v t", "u"),
        identity("g'(−A) = u·v + (u + v)·(A + t)", at["slope"]),
        sign("u·v + (u + v)·(A + t) > 0", "A v t", "u"),
    )


def _both_beyond_minus_A() -> Link:
    """Return the link about two negative roots at most −A."""
    at = _at("beyond −A")
    return link(
        "Two different roots −A − u and −A − v, none above −A, cannot have both: c2 < 3A means A + t = u + v + k with "
        "k > 0, and then g'(−A) < 0. They cross.",
        identity("c2 − 3·A = u + v − (A + t)", at["c2"] - 3 * A),
        identity("g'(−A) = u·v − (u + v)·(A + t)", at["slope"]),
        sign("u·v − (u + v)·(u + v + k) < 0", "v k", "u"),
    )


def program_is_the_rule(name: str) -> Link:
    """Return the link whose parts are the proofs of the program by that name; `hypcheck verify` records them too."""
    proofs = proofs_of(FORMULAS[name])
    return link(
        f"The program {name} computes these numbers, and decides by this rule.",
        FiniteCases(
            f"{len(proofs)} proofs of the program {name}", tuple((proof,) for proof in proofs), lambda p: p.holds
        ),
    )


def local_maximum() -> Chain:
    """Return the chain of the local maximum: g > 0 somewhere in an interval exactly if it is so at one known place.

    g is not positive at the ends of the interval.
    """
    return chain(
        "local maximum",
        "For all a, c > 0: with h1 = c2² − 3·c1 > 0, λm = (−c2 − √h1)/3 and g(λm) > 0, exterior if 0 < λm < B, "
        "interior if −A < λm < 0; else contact.",
        link(
            "g is not positive at −A, 0 and B; where it is positive between two of them it has a local maximum.",
            known("g(−A) = −AP(A + B)"),
            known("g(0) = −AB"),
            known("g(B) = −BQ(A + B)"),
            sign("−A·P·(A + B) ≤ 0", "A B", "P"),
            sign("−A·B < 0", "A B"),
            sign("−B·Q·(A + B) ≤ 0", "A B", "Q"),
        ),
        link(
            "A cubic that grows has one at most, at the lower zero of g', where g'' < 0; without h1 > 0 it has none.",
            identity("coefficient of λ³ in g = 1", sympy.Poly(pencil.cubic().g, LAMBDA).LC()),
            known("g'(λm) = 0"),
            known("g''(λm) = −2√h1"),
        ),
        program_is_the_rule("local-maximum"),
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
    """Return all chains by name, each after the chains that it needs."""
    return {chain.name: chain for chain in (make() for make in MAKERS)}


def proved(name: str, book: Mapping[str, Chain] | None = None) -> bool:
    """Decide whether every link of the chain by that name holds, and of the chains that it needs.

    `book` has the chains by name; without it they are those of `chains`.
    """
    known = chains() if book is None else book
    return known[name].holds and all(proved(needed, known) for needed in known[name].needs)
