"""Proposition 5, repaired: for α/b ≥ 1, which is A ≥ 1, interior by Δ, c2, c1, and what the printed condition drops."""

from __future__ import annotations

from itertools import product

from hypcheck.derivation import pencil
from hypcheck.derivation.chains import cubics, positions
from hypcheck.derivation.decisions import SIGNS
from hypcheck.derivation.links import Cases, Chain, Link, identity, sign
from hypcheck.derivation.plain_text import symbol


def proposition_5() -> Chain:
    """Both directions, and the patterns that the printed statement leaves out."""
    return Chain(
        "Proposition 5, repaired",
        "For α/b ≥ 1: interior ⟺ Δ > 0 and not (c2 < 0 and c1 > 0). Δ ≤ 0 means contact or the ring.",
        (
            _two_negative(),
            _not_both_beyond_minus_A(),
            positions.put_together(
                "So interior ⟺ Δ > 0 and not (c2 < 0 and c1 > 0).",
                lambda roots: not (roots.crowded and not roots.all_positive),
                lambda roots: (roots.delta > 0 and not roots.all_positive) == (roots.position < 0),
            ),
            positions.no_contact_but_the_ring(),
            _dropped(),
        ),
        needs=("rule", "roots", "positions"),
    )


def _two_negative() -> Link:
    r1, r2, s = cubics.ROOTS
    return Link(
        "Δ > 0 and not (c2 < 0 and c1 > 0): not all roots are positive, by Vieta; none is 0; and the product A·B > 0 "
        "makes two of them negative.",
        "sign",
        (*cubics.positive_roots_have_signs().parts, identity("−c0 = r1·r2·s", r1 * r2 * s), sign("A·B > 0", "A B")),
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
            Cases(
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
