"""The coefficient rule for every size, and that the programs which answer by it are that rule."""

from __future__ import annotations

from hypcheck.derivation.chains import cubics, positions
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.identities import GENERIC_CUBIC
from hypcheck.derivation.links import Cases, Chain, Link, identity, sign
from hypcheck.derivation.pencil import LAMBDA, A, B
from hypcheck.derivation.plain_text import symbol
from hypcheck.derivation.proofs import proofs_of

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
            positions.put_together(
                "So the rule holds; among patterns with Δ > 0 the two inequalities at B, or at −A, tell the crowded "
                "ones.",
                lambda _: True,
                lambda roots: _by_rule(roots) == roots.position,
            ),
            *map(program_is_the_rule, PROGRAMS),
        ),
        needs=("rule", "roots", "positions"),
    )


def _by_rule(roots: positions.Pattern) -> int:
    if roots.ring or (roots.delta > 0 and roots.all_positive and not roots.crowded):
        return 1
    return -1 if roots.delta > 0 and not roots.all_positive and not roots.crowded else 0


def _at(place: str) -> dict[str, object]:
    """c2 and g' of three roots named by their distances to −A or to B."""
    r1, r2, s = cubics.ROOTS
    u, v, w, t = (symbol(name) for name in "uvwt")
    roots = {
        "beyond B": (B + u, B + v, B + w),
        "about B": (B - u, B - v, B + w),
        "above −A": (-A + u, -A + v, t),
        "beyond −A": (-A - u, -A - v, t),
    }[place]
    values = dict(zip((r1, r2, s), roots, strict=True))
    pole = B if place.endswith("B") else -A
    c2, _, _ = cubics.coefficients_of_roots()
    return {
        "c2": c2.subs(values, simultaneous=True),
        "slope": cubics.slope_of_roots(pole).subs(values, simultaneous=True),
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
        (Cases(f"{len(proofs)} proofs of the program {name}", tuple((proof,) for proof in proofs), lambda p: p.holds),),
    )
