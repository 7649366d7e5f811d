"""The last two sections of the derivation: a quadcopter's rotors (section 3.2 of the paper) and its Appendix A."""

from __future__ import annotations

from hypcheck.derivation.links import Chain, Link, identity, printed
from hypcheck.derivation.printed_equations import rotor_meanings


def rotors() -> Chain:
    """Equations (15) to (21)."""
    return Chain(
        "The rotors",
        "Four spheroids of semi-axes b_s, b_s, d_s at the ends of arms of length l. One cosine and one sine serve all "
        "four: g_i = g_1 + (i − 1)·π/2 only exchanges T1 and T2 and turns signs.",
        (
            Link("Their centres, equations (15) and (18).", "identity", (*printed("15"), *printed("18"))),
            Link("Scaled by 1/b_s and 1/d_s, equations (16) and (17).", "identity", (*printed("16"), *printed("17"))),
            Link(
                "Their coefficients, equations (19) to (21).",
                "identity",
                (*printed("19"), *printed("20"), *printed("21")),
            ),
        ),
    )


def appendix() -> Chain:
    """Appendix A with the stray + l of its second display left out."""
    c1 = rotor_meanings()["c1"]
    repaired = identity(
        "c1(g_i) = (α/b_s)²·(1 − (γ/d_s)² − (z0/d_s)²) + (γ/d_s)²·((x0² + y0² + l²)/b_s² − 1) + "
        "(γ/d_s)²·(l·√2·(T1(g_i)·x0 + T2(g_i)·y0)/b_s²)",
        c1,
        **{name: rotor_meanings()[name] for name in ("T1", "T2")},
    )
    return Chain(
        "Appendix A",
        "The same, step by step: (15) put into (14), and what turns with g_i parted from what does not.",
        (
            Link("c1 in x_i, y_i, z_i, and by (18).", "identity", (*printed("A.1"), *printed("A.2a"))),
            Link("The paper prints l² + l here; + l is too much.", "identity", (repaired,)),
            Link(
                "Parted into A1, A2 and C(g_i).",
                "identity",
                tuple(part for number in ("A.3", "A.4", "A.5", "A.6") for part in printed(number)),
            ),
            Link("Named B1 and B2, equations (22) and (23).", "identity", (*printed("22"), *printed("23"))),
        ),
    )
