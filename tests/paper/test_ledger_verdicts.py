"""Every verdict is what independent work says it is, and another verdict in its place would not be confirmed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hypcheck.derivation.links import printed
from hypcheck.derivation.plain_text import symbol
from hypcheck.derivation.printed import check, check_equations
from hypcheck.derivation.printed_equations import printed_claims
from hypcheck.paper.ledger import entries, procedures, statements
from hypcheck.paper.ledger.entry import (
    FALSE,
    KINDS,
    MISPRINT,
    NOT_CHECKABLE,
    PROVED,
    VERDICTS,
    Entry,
    Evidence,
    by_chain,
    with_counterexample,
    without_counterexample,
)
from hypcheck.paper.ledger.equations import equation
from hypcheck.paper.ledger.search import Statement

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
    "Table 5": NOT_CHECKABLE,
    "Abstract; 3.1, speed": NOT_CHECKABLE,
    "Section 3.1, other methods": NOT_CHECKABLE,
    "Section 5": NOT_CHECKABLE,
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
        if entry.verdict == FALSE and entry.number != "Section 3.1, operations":  # counted, not searched
            assert witnesses, entry.number
            assert all(witness.holds for witness in witnesses), entry.number
        if entry.verdict == PROVED and not entry.number.startswith("Remark"):
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
    procedures.PROCEDURE_2A,
    procedures.CONTACT_MEANS_NOT_POSITIVE,
]
TRUE_STATEMENTS = [
    statements.REMARK_4,
    statements.REMARK_6,
    statements.REPAIRED_3,
    statements.REPAIRED_5,
    statements.ALL_SIZES,
    procedures.CONTACT_IF_TALL,
]


def named(statement: Statement) -> str:
    return statement.text


@pytest.mark.parametrize("statement", TRUE_STATEMENTS, ids=named)
def test_a_true_statement_that_is_called_false_is_not_confirmed(statement):
    entry = Entry("X", "2", statement.text, FALSE, "so they say", "nothing", lambda: (with_counterexample(statement),))
    assert not entry.confirmed
    assert "nothing found among" in entry.evidence[0].text
    assert without_counterexample(statement).holds


@pytest.mark.parametrize("statement", FALSE_STATEMENTS, ids=named)
def test_a_false_statement_that_is_called_proved_is_not_confirmed(statement):
    evidence = (by_chain("rule"), without_counterexample(statement))
    assert not Entry("X", "2", statement.text, PROVED, "so they say", "nothing", lambda: evidence).confirmed
    assert with_counterexample(statement).holds


def test_a_verdict_needs_evidence_unless_nothing_can_be_checked():
    entry = Entry("X", "2", "so it is", PROVED, "because", "nothing")
    assert not entry.confirmed
    assert replace(entry, verdict=NOT_CHECKABLE).confirmed
    assert not replace(entry, verdict=NOT_CHECKABLE, grounds=lambda: (Evidence("count", "1", holds=True),)).confirmed
    assert set(VERDICTS) == {PROVED, MISPRINT, FALSE, NOT_CHECKABLE}


@pytest.mark.parametrize("number", [checked.number for checked in check_equations()])
def test_an_altered_equation_does_not_keep_its_verdict(number):
    claims = tuple(claim for claim in printed_claims() if claim.number == number)
    (first, derived), *others = claims[0].pairs
    altered = replace(claims[0], pairs=((first + symbol("x0") ** 2 / 7, derived), *others))
    checked = check((altered, *claims[1:]))
    entry = equation(checked)
    if entry.verdict == PROVED:
        assert checked.verdict == "misprint"
        assert not entry.confirmed
    repaired = tuple(replace(claim, pairs=tuple((right, right) for _, right in claim.pairs)) for claim in claims)
    assert equation(check(repaired)).confirmed == (entry.verdict == PROVED)


def test_an_equation_that_chains_rest_on_would_be_seen_to_fail(monkeypatch):
    from hypcheck.paper.ledger import propositions

    assert all(part.holds for part in printed("10"))
    monkeypatch.setattr(propositions, "printed", lambda number: (replace(printed(number)[0], left=symbol("x0")),))
    assert not all(entry.confirmed for entry in propositions.propositions())


def test_corrections_of_false_statements_are_the_repaired_ones():
    corrections = {entry.number: entry.correction for entry in entries()}
    assert "the ring" in corrections["Proposition 3.1"]
    assert "not (c2 < 0 and c1 > 0)" in corrections["Proposition 5.1"]
    assert corrections["Section 4, regime"] == "a ≥ 1, where a = α/b"
