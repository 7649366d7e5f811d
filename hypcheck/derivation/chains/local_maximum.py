"""The local maximum decides: the shortest rule for every size, and that the program is it."""

from __future__ import annotations

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.chains.all_sizes import program_is_the_rule
from hypcheck.derivation.links import Chain, Link, identity, known, sign
from hypcheck.derivation.pencil import LAMBDA


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
