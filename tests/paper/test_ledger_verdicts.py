"""Every verdict of the ledger agrees with independent work, and a different verdict is not confirmed."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import hypcheck
from hypcheck.derivation.links import printed
from hypcheck.derivation.pencil import symbol
from hypcheck.derivation.printed_equations import check, printed_claims
from hypcheck.derivation.proofs import decisions
from hypcheck.geometry.pair import Position
from hypcheck.paper.ledger import checks, statements
from hypcheck.paper.ledger import entry as entry_module
from hypcheck.paper.ledger.book import REASONS, coverage, entries, equation, sentences, statement
from hypcheck.paper.ledger.counts import BENCH
from hypcheck.paper.ledger.entry import (
    DEFINITION,
    FALSE,
    KINDS,
    MISPRINT,
    NOT_CHECKABLE,
    PROVED,
    QUESTION,
    VERDICTS,
    Evidence,
    LedgerEntry,
    by_chain,
    with_counterexample,
    without_counterexample,
)
from hypcheck.paper.ledger.points import Point, Statement, facts, facts_in_order

NUMBERS = [*map(str, range(1, 22)), "A.1", "A.2a", "A.2b", "A.3", "A.4", "A.5", "A.6", "22", "23"]
"""Of all displayed equations, as tests/derivation/test_printed.py has them, too."""

OTHERWISE = {
    "(11)": MISPRINT,
    "(12)": MISPRINT,
    "A.2b": MISPRINT,
    "Section 4, regime": MISPRINT,
    "Proposition 3.1": FALSE,
    "Proposition 3.2": FALSE,
    "Proposition 3, proof: roots": FALSE,
    "Proposition 3, proof: signs": FALSE,
    "Proposition 5.1": FALSE,
    "Proposition 5.2": FALSE,
    "Table 1": FALSE,
    "Table 1, caption": FALSE,
    "Table 2": FALSE,
    "Table 3": FALSE,
    "Section 4, contact": FALSE,
    "Table 4": FALSE,
    "Table 4, caption": FALSE,
    "Section 3.1, operations": FALSE,
    "Tables 1–3 of [10]": NOT_CHECKABLE,
    "Section 3.2, pitch": FALSE,
    "Section 4, discriminant": FALSE,
    "Table 4, purpose": FALSE,
    "Table 5, equal steps": QUESTION,
    "Section 3.2, maximum height": QUESTION,
    "Section 2, respectively": MISPRINT,
    "Proposition 3.1, wording": MISPRINT,
    "Proposition 5, regime": MISPRINT,
    "Section 3.1, f in (12)": MISPRINT,
    "Section 4, unit of t": MISPRINT,
    **dict.fromkeys(
        ("(1)", "(3)", "(4)", "(6)", "(9)", "(15)", "(20)", "(22)", "A.3", "A.6"),
        DEFINITION,
    ),
    **dict.fromkeys(
        (
            "Table 5",
            "Table 5, reason",
            "Abstract; 3.1, speed",
            "Section 1, spheres",
            "Section 1, convex",
            "Section 2, in practice",
            "Section 3.1, [13]",
            "Section 3.1, roots",
            "Table 5, t = 0.1",
            "Section 3.1, heights",
            "Section 3.1, other methods",
            "Section 3.2, heights",
            "Section 3.2, distance",
            "Section 3.2, l and g1",
            "Section 4, look-ahead",
            "Section 4, trees of volumes",
            "Section 5",
        ),
        NOT_CHECKABLE,
    ),
}
"""What is known not to be proved, from the paper, its checks by others and the clock; all else is."""


def test_every_numbered_statement_of_the_paper_is_in_the_ledger():
    numbered = [f"({number})" for number in range(1, 24)]
    numbered += ["Theorem 1", "Remark 2", "Remark 4", "Remark 6"]
    numbered += ["Proposition 3.1", "Proposition 3.2", "Proposition 5.1", "Proposition 5.2"]
    numbered += [f"Table {number}" for number in range(1, 6)] + ["Table 4, caption"]
    numbered += [f"A.{number}" for number in ("1", "2a", "2b", "3", "4", "5", "6")]
    found = {entry.number for entry in entries()}
    assert set(numbered) <= found
    assert len(found) == len(entries())


def test_each_verdict_is_the_known_one_and_is_confirmed():
    for entry in entries():
        assert entry.verdict == OTHERWISE.get(entry.number, PROVED), entry.number
        assert entry.confirmed, [evidence.text for evidence in entry.evidence if not evidence.holds]
        assert entry.why, entry.number
        assert entry.follows, entry.number
        assert entry.statement, entry.number
        assert {evidence.kind for evidence in entry.evidence} <= set(KINDS), entry.number


def test_false_statements_rest_on_witnesses_and_proved_ones_on_none():
    for entry in entries():
        witnesses = [witness for evidence in entry.evidence for witness in evidence.witnesses]
        counted = {"Section 3.1, operations", "Section 3.2, pitch"}
        if entry.verdict == FALSE and entry.number not in counted:
            assert witnesses, entry.number
            assert all(witness.holds for witness in witnesses), entry.number
        if entry.verdict == PROVED:
            assert not witnesses, entry.number
        if entry.verdict == NOT_CHECKABLE:
            assert not entry.evidence, entry.number


FALSE_STATEMENTS = [
    statements.PROPOSITION_3_1,
    statements.PROPOSITION_3_2,
    statements.THREE_POSITIVE_ROOTS,
    statements.ALL_POSITIVE,
    statements.PROPOSITION_5_1,
    statements.PROPOSITION_5_2,
    statements.PROCEDURE_2A,
    statements.CONTACT_MEANS_NOT_POSITIVE,
]


def rule_of_all_sizes(facts):
    """The position by the rule that, as is proved, the program "coefficients" uses."""
    (decision,) = decisions("coefficients")
    return decision.rule(*(facts.delta, facts.c1, facts.c2), *(getattr(facts, name) for name in decision.letters[3:]))


TRUE_STATEMENTS = [
    statements.REMARK_4,
    statements.REMARK_6,
    statements.REPAIRED_3,
    statements.REPAIRED_5,
    Statement(
        "the position is that of the coefficient rule for all sizes",
        lambda _: True,
        lambda facts: rule_of_all_sizes(facts) == facts.position,
    ),
    statements.CONTACT_IF_TALL,
]


def named(statement: Statement) -> str:
    return statement.text


@pytest.mark.parametrize("statement", TRUE_STATEMENTS, ids=named)
def test_a_true_statement_that_is_called_false_is_not_confirmed(statement):
    entry = LedgerEntry(
        "X", "2", statement.text, FALSE, "so they say", "nothing", lambda: (with_counterexample(statement),)
    )
    assert not entry.confirmed
    assert "nothing found among" in entry.evidence[0].text
    assert without_counterexample(statement).holds


@pytest.mark.parametrize("statement", FALSE_STATEMENTS, ids=named)
def test_a_false_statement_that_is_called_proved_is_not_confirmed(statement):
    evidence = (by_chain("rule"), without_counterexample(statement))
    assert not LedgerEntry("X", "2", statement.text, PROVED, "so they say", "nothing", lambda: evidence).confirmed
    assert with_counterexample(statement).holds


def test_a_verdict_needs_evidence_unless_nothing_can_be_checked():
    entry = LedgerEntry("X", "2", "so it is", PROVED, "because", "nothing")
    assert not entry.confirmed
    assert replace(entry, verdict=NOT_CHECKABLE).confirmed
    assert not replace(entry, verdict=NOT_CHECKABLE, grounds=lambda: (Evidence("count", "1", holds=True),)).confirmed
    assert set(VERDICTS) == {PROVED, DEFINITION, MISPRINT, FALSE, QUESTION, NOT_CHECKABLE}


@pytest.mark.parametrize(
    "number",
    [pytest.param(each, marks=[pytest.mark.thorough] * (place % 3 > 0)) for place, each in enumerate(NUMBERS)],
)
def test_altered_equation_of_the_paper_loses_its_verdict(number):
    claims = tuple(claim for claim in printed_claims() if claim.number == number)
    (first, derived), *others = claims[0].pairs
    altered = replace(claims[0], pairs=((first + symbol("x0") ** 2 / 7, derived), *others))
    checked = check((altered, *claims[1:]))
    entry = equation(checked)
    if entry.verdict != MISPRINT:
        assert checked.verdict == "misprint"
        assert not entry.confirmed
    repaired = tuple(replace(claim, pairs=tuple((right, right) for _, right in claim.pairs)) for claim in claims)
    assert equation(check(repaired)).confirmed == (entry.verdict != MISPRINT)


def test_a_wrong_equation_that_chains_rest_on_makes_them_fail(monkeypatch):
    assert all(part.holds for part in printed("10"))
    assert statement("Theorem 1").confirmed
    monkeypatch.setattr(entry_module, "printed", lambda number: (replace(printed(number)[0], left=symbol("x0")),))
    assert not statement("Theorem 1").confirmed


def test_corrections_of_false_statements_are_the_repaired_ones():
    corrections = {entry.number: entry.correction for entry in entries()}
    assert "the ring" in corrections["Proposition 3.1"]
    assert "not (c2 < 0 and c1 > 0)" in corrections["Proposition 5.1"]
    assert corrections["Section 4, regime"] == "a ≥ 1, where a = α/b"


def test_only_entries_with_the_verdict_false_say_where_the_error_is_harmless():
    for entry in entries():
        assert bool(entry.harmless) == (entry.verdict == FALSE), entry.number


def test_the_printed_proposition_5_is_true_where_b_exceeds_a_plus_1_and_false_where_they_are_equal():
    very_tall = [facts for facts in facts_in_order() if facts.point.a > 1 and facts.B > facts.A + 1]
    assert len(very_tall) > 500
    assert all(statements.PROPOSITION_5_1.says(facts) for facts in very_tall)
    border = facts(Point(Fraction(4, 3), Fraction(5, 3), Fraction(0), Fraction(0)))  # B = A + 1 and c2 = 0
    assert border.B == border.A + 1
    assert not statements.PROPOSITION_5_1.says(border)


@pytest.mark.parametrize(
    ("case", "clear"), [(checks.REMARK_4, Position.INTERIOR), (checks.REMARK_6, Position.EXTERIOR)]
)
def test_irrational_pairs_with_the_same_cubic_have_the_positions_of_their_float64_roundings(case, clear):
    """Their lengths are irrational; the exact position of lengths rounded to float64 is that of the pair itself."""
    for pair, position in zip(case[0], (clear, Position.CONTACT), strict=True):
        a, c, r, z = (math.sqrt(getattr(pair, name)) for name in "ABPQ")
        assert hypcheck.classify([[a, c, 1, 1, r, 0, z]]).tolist() == [position]


def test_every_sentence_of_the_paper_names_ledger_rows_or_a_reason_and_every_row_has_a_sentence():
    numbers = {entry.number for entry in entries()}
    named = {row for sentence in sentences() for row in sentence.rows}
    assert named == numbers
    for sentence in sentences():
        assert bool(sentence.rows) != bool(sentence.reason), sentence
        assert sentence.reason in {"", *REASONS}, sentence
    assert len({(sentence.section, sentence.words) for sentence in sentences()}) == len(sentences())
    assert f"{len(sentences())} sentences" in coverage()


def test_ledger_and_reference_report_agree_about_bench():
    """Verdicts of claims as words, false contacts rounded to whole percents."""
    report = (Path(__file__).parents[2] / "reports/reference/bench/README.md").read_text(encoding="utf-8")
    claims = dict(re.findall(r"(?m)^- Section ([^\n]*)\n((?:  - .*\n)+)", report))
    for key, opening in (("operations", "3.1: in Table 2"), ("roots", "3.1: coefficients"), ("hull_first", "4: Δ")):
        (found,) = (verdicts for title, verdicts in claims.items() if title.startswith(opening))
        told = re.findall(r"\*\*(.*?)\*\*.*? in (numpy|C)", found)
        assert len(told) == 2
        said = re.findall(r"(does not hold|inconclusive|holds) in (numpy|C)", BENCH[key])
        assert said == told, key
    for key, shape in (("spheres", "sphere"), ("cylinders", "cylinder")):
        shares = [
            re.search(rf"bounding {shape} in the spheroid's place, {where}: ([\d.]+) %", report)[1]
            for where in ("uniform", "flight")
        ]
        assert re.findall(r"(\d+) %", BENCH[key]) == [f"{float(share):.0f}" for share in shares]
