"""The ledger's entries about what the text says beside its formulas: slips of words, and what the models leave out."""

from __future__ import annotations

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.links import known, printed
from hypcheck.derivation.pencil import symbol
from hypcheck.geometry.pair import Position
from hypcheck.paper.ledger import entry
from hypcheck.paper.ledger.entry import (
    FALSE,
    MISPRINT,
    NOT_CHECKABLE,
    PROVED,
    Evidence,
    LedgerEntry,
    by_chain,
    without_counterexample,
)
from hypcheck.paper.ledger.leaning import first_change


def prose() -> tuple[LedgerEntry, ...]:
    """Slips of words first, then small truths that the text states, then what the models leave open."""
    return (
        *_slips_of_section_2(),
        *_later_slips(),
        *_truths_of_section_2(),
        *_later_truths(),
        *_movements(),
        *_left_open(),
    )


def _same(text: str, left: sympy.Expr, right: sympy.Expr) -> Evidence:
    return Evidence("identity", text, sympy.simplify(left - right) == 0)


def _slips_of_section_2() -> tuple[LedgerEntry, ...]:
    return (
        LedgerEntry(
            "Section 2, respectively",
            "2",
            "“S and H, respectively defined by (7) and (8)”",
            MISPRINT,
            "(7) defines H and (8) defines S",
            "read “H and S”",
            lambda: (
                Evidence("identity", "(7) is the hyperboloid", all(part.holds for part in printed("7"))),
                Evidence("identity", "(8) is the sphere", all(part.holds for part in printed("8"))),
            ),
            "H and S, respectively defined by (7) and (8)",
        ),
        LedgerEntry(
            "Proposition 3.1, wording",
            "2",
            "“if and only Δ > 0, c2 < 0, and c1 > 0”",
            MISPRINT,
            "a word is missing; the proof ends with “is equivalent to the fact that the spheroid is exterior”",
            "read “if and only if”; what that says is false all the same (Proposition 3.1)",
            lambda: (Evidence("text", "the proposition beside the end of its proof", holds=True),),
            "if and only if",
        ),
        LedgerEntry(
            "Proposition 5, regime",
            "2",
            "α/b > 1, where Remark 6 calls the condition of Proposition 5 α/b ≥ 1, and Tables 3 and 4 ask for ≥ 1",
            MISPRINT,
            "one of the two is meant; the proposition put right holds for α/b ≥ 1",
            "use ≥ 1",
            lambda: (
                Evidence("text", "Proposition 5 beside Remark 6 and the captions of Tables 3 and 4", holds=True),
                by_chain("Proposition 5, repaired"),
                without_counterexample(entry.REPAIRED_5),
            ),
            "α/b ≥ 1",
        ),
    )


def _roots_of_f() -> tuple[Evidence]:
    factor = known("det(λH + S) = (A + λ)·g(λ)/(A²·B)")
    degree = sympy.degree(pencil.cubic().g, pencil.LAMBDA)
    return (Evidence("identity", factor.text, factor.holds and degree == 3),)


def _later_slips() -> tuple[LedgerEntry, ...]:
    return (
        LedgerEntry(
            "Section 3.1, f in (12)",
            "3.1",
            "“the roots of the polynomial f given in (12)”",
            MISPRINT,
            "(12) is g, a cubic; f is given in (11) and has one root more, −a²",
            "read “f given in (11)”; the roots of g decide",
            _roots_of_f,
            "the roots of the polynomial f given in (11)",
        ),
        LedgerEntry(
            "Section 4, unit of t",
            "4",
            "“t = 0.1 m/s”",
            MISPRINT,
            "t is a response time; Table 5 has it in seconds",
            "read 0.1 s",
            lambda: (Evidence("text", "the sentence beside the head of Table 5", holds=True),),
            "t = 0.1 s",
        ),
        LedgerEntry(
            "Section 4, which procedure",
            "4",
            "non-valid movements are detected with Procedure 2.a in the rules of flight, with Procedure 2.b "
            "before Table 5",
            MISPRINT,
            "one of the two is meant; Table 5 counts executions of 2.b",
            "in the paper's tower it makes no difference inside: both are right there (Tables 3 and 4)",
            lambda: (Evidence("text", "the last rule of flight beside the paragraph before Table 5", holds=True),),
            "Procedure 2.b",
        ),
    )


def _truths_of_section_2() -> tuple[LedgerEntry, ...]:
    b, d = sympy.symbols("b d", positive=True)
    lambda_ = pencil.LAMBDA
    scaling, matrix = sympy.diag(1 / b, 1 / b, 1 / d), sympy.diag(1 / b**2, 1 / b**2, 1 / d**2)
    cubic = pencil.cubic()
    mirrored = -(lambda_**3) + cubic.c2 * lambda_**2 - cubic.c1 * lambda_ + cubic.c0
    return (
        LedgerEntry(
            "Theorem 1, proof",
            "2",
            "A is regular, A = Aᵀ and A⁻¹·E·A⁻¹ = I; F takes common points to common points, and back",
            PROVED,
            "A is diagonal without a 0",
            "the proof of Theorem 1 is right",
            lambda: (
                Evidence(
                    "identity",
                    "A⁻¹·E·A⁻¹ = I",
                    bool(scaling.inv() * matrix * scaling.inv() == sympy.eye(3) and scaling == scaling.T),
                ),
                by_chain("Theorem 1"),
            ),
        ),
        LedgerEntry(
            "Proposition 3, proof: Descartes",
            "2",
            "g(−λ) = −λ³ + c2·λ² − c1·λ + c0 with c0 < 0, and its changes of sign bound the negative roots of g",
            PROVED,
            "the substitution is an identity, c0 = −AB, and the rest is Descartes' rule of signs, a known theorem",
            "where all roots are real the bound is their number",
            lambda: (
                _same("g(−λ)", sympy.expand(cubic.g.subs(lambda_, -lambda_)), sympy.expand(mirrored)),
                _same("c0 = −AB", sympy.expand(cubic.c0), -pencil.A * pencil.B),
            ),
        ),
    )


def _later_truths() -> tuple[LedgerEntry, ...]:
    angle = sympy.Symbol("g", real=True)
    cosine, sine, alpha, gamma, z = sympy.cos(angle), sympy.sin(angle), *map(symbol, ("α", "γ", "z0"))
    return (
        LedgerEntry(
            "Section 3.2, T1 and T2",
            "3.2",
            "T1² + T2² = 2",
            PROVED,
            "cos² + sin² = 1, twice",
            "use it as printed",
            lambda: (_same("T1² + T2² = 2", (cosine - sine) ** 2 + (cosine + sine) ** 2, sympy.Integer(2)),),
        ),
        LedgerEntry(
            "Section 3.2, shape",
            "3.2",
            "a hyperboloid's shape is not similar at all heights",
            PROVED,
            "its radius R at height z has R² − α² = α²·z²/γ²",
            "a distance to it still decides: the oracle of the nearest point does (docs/mathematics.md)",
            lambda: (
                _same(
                    "R² − α² = α²·z²/γ²",
                    (alpha * sympy.sqrt(1 + z**2 / gamma**2)) ** 2 - alpha**2,
                    (alpha * z / gamma) ** 2,
                ),
            ),
        ),
        LedgerEntry(
            "Section 4, probabilities",
            "4",
            "straight 0.25, up or down 0.25, a turn 0.5",
            PROVED,
            "they add up to 1",
            "the rule after a refusal is no fourth chance: it follows a draw",
            lambda: (Evidence("count", "0.25 + 0.25 + 0.5 = 1", 0.25 + 0.25 + 0.5 == 1),),
        ),
    )


def _movements() -> tuple[LedgerEntry, ...]:
    b, d = sympy.symbols("b d", positive=True)
    x, y, z, angle = sympy.symbols("x y z g", real=True)
    cosine, sine = sympy.cos(angle), sympy.sin(angle)
    turned = ((x * cosine - y * sine) ** 2 + (x * sine + y * cosine) ** 2) / b**2 + z**2 / d**2
    tilted = sympy.expand((x * cosine - z * sine) ** 2 / b**2 + y**2 / b**2 + (x * sine + z * cosine) ** 2 / d**2)
    mixed = tilted.coeff(x, 1).coeff(z, 1)
    return (
        LedgerEntry(
            "Section 3, yaw and throttle",
            "3.2",
            "displacements along the axes and rotations in the xy-plane keep the model: (4) with another centre",
            PROVED,
            "a spheroid about the z-axis is the same after a turn about that axis",
            "the body needs no heading; the rotors need one cosine and one sine",
            lambda: (_same("(x² + y²)/b² + z²/d² after a turn", turned, (x**2 + y**2) / b**2 + z**2 / d**2),),
        ),
        LedgerEntry(
            "Section 3.2, pitch",
            "3.2",
            "pitch, the UAV's tilt forward and backward, is one of the movements of the modelled UAV",
            FALSE,
            "pitch is not modelled: a tilted spheroid has a term x·z, with the factor sin(2g)·(1/d² − 1/b²), which no "
            "equation (4) has, and the answer may be another",
            "read “pitch” as the movement ahead; `hypcheck simulate tower --pitch DEGREES` counts the answers that the "
            "upright body gets wrong",
            lambda: (
                _same("the coefficient of x·z", mixed, sympy.sin(2 * angle) * (1 / d**2 - 1 / b**2)),
                Evidence("identity", "it is not 0", sympy.simplify(mixed) != 0),
                _changed_by_leaning(),
            ),
            "the movements are ahead or back, yaw, and throttle, with the spheroid upright",
            harmless=(
                "where the tilt is 0 or b = d, and in section 4, whose rules of flight have straight "
                "movements and no tilt"
            ),
        ),
    )


def _changed_by_leaning() -> Evidence:
    """Simplest pairs in the regime of Procedures 2.a and 2.b whose position is another once they lean."""
    searches = (
        first_change(
            Position.INTERIOR, Position.CONTACT, "dangerous: the upright body is clear, the one that leans is not"
        ),
        first_change(
            Position.CONTACT, Position.INTERIOR, "needless: the upright body is refused, the one that leans is clear"
        ),
    )
    found = tuple(search.found for search in searches if search.found is not None)
    text = (
        "; ".join(each.text for each in found) or f"nothing found among {sum(each.tried for each in searches):,} pairs"
    )
    return Evidence("search", text, len(found) == len(searches) and all(each.holds for each in found), leaning=found)


_OPEN = (
    (
        "Section 1, convex",
        "1",
        "previous methods consider only convex bodies",
        "[3]–[9] were not read",
        "meshes need no convex bodies (docs/mesh-oracle.md)",
    ),
    (
        "Section 2, in practice",
        "2",
        "the most used hyperboloids have α/b ≥ 1 or (γ/d)² ≥ α/b; those of architecture are large",
        "no count of hyperboloids in use is given",
        "the coefficient rule for all sizes needs no such condition (docs/mathematics.md)",
    ),
    (
        "Section 3.1, heights",
        "3.1",
        "a trunk is a hyperboloid, and the walker stays within its height",
        "(1) has no end; trunks have one, and the paper gives no height",
        (
            "ask no tree whose height does not hold the walker's centre, and give such a question no answer, as "
            "`hypcheck simulate forest` does; near an end the trunk's end face is not modelled"
        ),
    ),
    (
        "Section 3.2, heights",
        "3.2",
        "the tower bounds the flight up to its maximum height, and Figure 2's towers are bounded by hyperboloids",
        "(1) has no end; the tower's height is not given, nor are the sizes of Figure 2's towers",
        "`hypcheck simulate tower` assumes |z| ≤ 17.8 m and says so",
    ),
    (
        "Section 3.2, distance",
        "3.2",
        "methods by distance are adequate only where the shape is similar at all heights",
        "“adequate” has no measure",
        "the nearest point of a hyperboloid decides exactly (docs/mathematics.md, “Nearest point and clearance”)",
    ),
    (
        "Section 3.2, l and g1",
        "3.2",
        "(15) places the rotors by l and g1, and Figure 3 has them apart and inside the body",
        (
            "neither l nor g1 is given anywhere; rotors with b_s = 0.1 are apart and inside a body with b = "
            "0.25 only if "
            "0.1414 ≤ l ≤ 0.15"
        ),
        (
            "`hypcheck simulate tower` fits l = 0.135, at which neighbours overlap: l·√2 = 0.191 < 2·b_s = 0.2; "
            "docs/simulate.md has 0.1415 and 0.15 beside it"
        ),
    ),
    (
        "Section 4, trees of volumes",
        "4",
        "trees of spheres and spheroids are simple to implement and suitable for efficient minimum computation",
        "[14, 15] were not read, and “simple” has no measure",
        "Procedure 2.b is such a tree of two levels; see Table 4 and Section 4, cost",
    ),
)
"""What the models leave open: number, section, statement, why it is not checkable, what follows."""


def _left_open() -> tuple[LedgerEntry, ...]:
    return tuple(
        LedgerEntry(number, section, statement, NOT_CHECKABLE, why, follows)
        for number, section, statement, why, follows in _OPEN
    )
