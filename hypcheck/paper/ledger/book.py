"""The whole ledger: displayed formulas first, then what the text states, section by section."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from hypcheck.paper.ledger.costs import costs
from hypcheck.paper.ledger.entry import Entry
from hypcheck.paper.ledger.equations import equations, regime_of_section_4
from hypcheck.paper.ledger.flights import flights
from hypcheck.paper.ledger.procedures import procedures
from hypcheck.paper.ledger.propositions import propositions
from hypcheck.paper.ledger.wording import wording

COQ = {
    "(11)": ("UnitBall.determinant_is_cubic", "Paper.equation_11_is_misprinted"),
    "(12)": ("UnitBall.determinant_is_cubic", "Paper.equation_12_is_misprinted"),
    "(14)": ("UnitBall.g_expanded",),
    "Theorem 1": ("Geometry.scaling",),
    "after (12)": ("UnitBall.determinant_is_cubic",),
    "Tables 1–3 of [10], re-derived": (
        "RootPatterns.table_is_complete",
        "RootPatterns.every_row_occurs",
        "RootPatterns.meaning_of_bodies",
    ),
    "Proposition 3.1": ("Paper.proposition_3_1_is_false", "Rule.proposition_3_repaired"),
    "Proposition 3.2": ("Paper.proposition_3_2_is_false", "Rule.no_discriminant"),
    "Proposition 3, proof: roots": ("Paper.roots_in_the_proof_of_3_are_false",),
    "Proposition 3, proof: signs": ("Paper.signs_in_the_proof_of_3_are_false",),
    "Proposition 5.1": (
        "Paper.proposition_5_1_is_false_where_c2_is_0",
        "Paper.proposition_5_1_is_false_where_c1_is_0",
        "Rule.proposition_5_repaired",
    ),
    "Proposition 5.2": ("Paper.proposition_5_2_is_false", "Rule.no_discriminant"),
    "Section 4, contact": (
        "Paper.proposition_5_2_is_false",
        "Paper.caption_of_table_4_is_false",
        "Rule.no_discriminant",
    ),
    "Table 4, caption": ("Paper.caption_of_table_4_is_false",),
}
"""The theorems of hypcheck/proofs that say of a claim what the ledger says."""


@cache
def entries() -> tuple[Entry, ...]:
    """Every entry, in order."""
    stated = (*propositions(), regime_of_section_4(), *procedures(), *costs(), *flights(), *wording())
    ordered = (*equations(), *sorted(stated, key=lambda entry: entry.section))
    return tuple(replace(entry, coq=COQ.get(entry.number, ())) for entry in ordered)
