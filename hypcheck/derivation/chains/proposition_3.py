"""Proposition 3, repaired: for (γ/d)² ≥ α/b, which is B² ≥ A, exterior by Δ, c2 and c1, and the ring."""

from __future__ import annotations

from hypcheck.derivation.chains import positions
from hypcheck.derivation.links import Chain, Link, identity, sign
from hypcheck.derivation.pencil import A, B


def proposition_3() -> Chain:
    """Both directions, and what Δ ≤ 0 leaves."""
    return Chain(
        "Proposition 3, repaired",
        "For (γ/d)² ≥ α/b: exterior ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring (z0 = 0, g'(B) = 0, A < B²). Δ ≤ 0 means "
        "contact or the ring.",
        (
            _not_all_beyond_B(),
            positions.put_together(
                "So exterior ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring.",
                lambda roots: not (roots.crowded and roots.all_positive),
                lambda roots: ((roots.delta > 0 and roots.all_positive) or roots.ring) == (roots.position > 0),
            ),
            positions.no_contact_but_the_ring(),
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
