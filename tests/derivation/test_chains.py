"""Every link of every chain holds, and none holds after a small change of its statement."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest
import sympy

from hypcheck.derivation import links, pencil
from hypcheck.derivation.chain_book import MAKERS, chains, proved
from hypcheck.derivation.links import REASONS, Chain, FiniteCases, Identity, Link, Sign, identity, sign
from hypcheck.derivation.pencil import symbol
from hypcheck.derivation.root_chains import (
    PATTERNS,
    Pattern,
    in_one_interval,
    proposition_3,
    proposition_5,
    roots_chain,
)
from hypcheck.derivation.walk import walk

CHAINS = (
    "Theorem 1",
    "rule",
    "roots",
    "positions",
    "Proposition 3, repaired",
    "Procedure 1, repaired",
    "Proposition 5, repaired",
    "all sizes",
    "local maximum",
    "The two surfaces",
    "Theorem 1: scaling",
    "The two matrices",
    "The pencil and its cubic",
    "The coefficients",
    "g at and between its poles",
    "The discriminant",
    "The roots in numbers",
    "The rotors",
    "Appendix A",
)
"""The names of all chains and of the sections of the derivation."""


@cache
def everything():
    return {chain.name: chain for chain in (*chains().values(), *walk())}


def test_the_list_of_tested_proof_chains_has_all_chains_and_sections():
    assert tuple(everything()) == CHAINS


@pytest.mark.parametrize("name", CHAINS)
def test_every_part_of_every_link_of_a_proof_chain_holds(name):
    chain = everything()[name]
    for link in chain.links:
        assert link.reason in REASONS
        assert (link.reason == "cited theorem") == bool(link.cites)
        for part in link.parts:
            assert part.holds, (link.statement, part.text)
    assert chain.holds


def broken(part):
    """The part with a small mistake in it, in each of a few ways."""
    if isinstance(part, Identity):
        stray = symbol("x0") ** 2 / 7
        matrix = isinstance(part.left, sympy.MatrixBase)
        yield replace(part, left=part.left + stray * sympy.ones(*part.left.shape) if matrix else part.left + stray)
        yield replace(part, right=-part.right + (sympy.ones(*part.right.shape) if matrix else 1))
    elif isinstance(part, Sign):
        yield replace(part, relation={">": "<", "<": ">", "≥": "<", "≤": ">"}[part.relation])
        yield replace(part, expression=-part.expression)
        yield replace(part, expression=part.expression - symbol("x0"))
        if part.positive:
            yield replace(part, positive=(), nonnegative=())
    else:
        yield replace(part, rule=lambda *case: not part.rule(*case))
        yield replace(part, cases=())


@pytest.mark.parametrize("every", [4, pytest.param(1, marks=pytest.mark.thorough)])
@pytest.mark.parametrize("name", CHAINS)
def test_a_mistake_in_any_part_of_a_proof_chain_makes_its_link_and_chain_fail(name, every):
    """To see that an identity fails takes long: they are taken in turn, each with one mistake."""
    chain, identities = everything()[name], 0
    for link in chain.links:
        for part in link.parts:
            mistakes = list(broken(part))
            if isinstance(part, Identity) and every > 1:
                mistakes = mistakes[identities // every % 2 :][:1] if identities % every == 0 else []
                identities += 1
            for mistaken in mistakes:
                assert not mistaken.holds, part.text
                bad = replace(link, parts=tuple(mistaken if each is part else each for each in link.parts))
                assert not bad.holds
                assert not replace(chain, links=tuple(bad if each is link else each for each in chain.links)).holds


def test_a_link_or_a_proof_chain_without_anything_to_check_does_not_hold():
    assert not Link("so it is said", "identity", ()).holds
    assert not Chain("empty", "nothing", ()).holds


def test_a_proof_chain_is_proved_only_if_the_chains_that_it_needs_are():
    assert all(proved(name) for name in chains())
    false = replace(chains()["roots"], links=(Link("1 < 0", "sign", (sign("1 < 0"),)),))
    book = {**chains(), "roots": false}
    assert {name for name in book if not proved(name, book)} == {
        "roots",
        "positions",
        "Proposition 3, repaired",
        "Procedure 1, repaired",
        "Proposition 5, repaired",
        "all sizes",
        "local maximum",
    }


def test_proof_chains_are_listed_after_the_chains_that_they_need():
    seen = set()
    for name, chain in chains().items():
        assert set(chain.needs) <= seen
        seen.add(name)


@pytest.mark.parametrize("coefficient", ["c0", "c1", "c2"])
def test_proof_chains_fail_if_the_cubic_has_a_misprint(monkeypatch, coefficient):
    """The chains rest on the derived cubic: with a misprint in it they fail."""
    right = pencil.cubic()
    wrong = replace(right, **{coefficient: getattr(right, coefficient) + pencil.P * pencil.Q})
    monkeypatch.setattr(pencil, "cubic", lambda: wrong)
    links.identities.cache_clear()
    try:
        assert not all(make().holds for make in MAKERS)
        assert not roots_chain().holds
    finally:
        links.identities.cache_clear()


@pytest.mark.parametrize(
    ("make", "rule"),
    [
        (proposition_3, lambda roots: ((roots.delta > 0 and roots.all_positive) or roots.ring) == (roots.position > 0)),
        (proposition_5, lambda roots: (roots.delta > 0 and not roots.all_positive) == (roots.position < 0)),
    ],
)
def test_the_regime_of_a_proposition_excludes_all_root_patterns_on_which_its_rule_is_wrong(make, rule):
    """The patterns that c² ≥ a, or a ≥ 1, rules out are those on which the rule is wrong."""
    splits = [part.cases for link in make().links for part in link.parts if isinstance(part, FiniteCases)]
    possible = {case[0].name for case in next(cases for cases in splits if isinstance(cases[0][0], Pattern))}
    assert all(rule(pattern) for pattern in PATTERNS if pattern.name in possible)
    assert [pattern.crowded for pattern in PATTERNS if not rule(pattern)] == [True]
    assert not any(pattern.name in possible for pattern in PATTERNS if not rule(pattern))


@pytest.mark.parametrize(("one", "two", "excluded_by"), [(-1, 1, 0), (-3, -1, 1), (1, 3, 2)])
def test_each_condition_of_the_case_split_in_the_chain_roots_is_needed(one, two, excluded_by):
    """Two roots with −A, 0 or B between them are ruled out by one condition alone (A = B = 2)."""
    conditions = [one * two > 0, (one + 2) * (two + 2) >= 0, (one - 2) * (two - 2) >= 0]
    assert [number for number, holds in enumerate(conditions) if not holds] == [excluded_by]
    assert in_one_interval(one, two)
    assert all(in_one_interval(*pair) for pair in ((-3, -2), (-2, -1), (1, 2), (2, 3)))


def test_sign_raises_an_error_for_a_text_that_states_no_sign():
    with pytest.raises(ValueError, match="states no sign"):
        sign("A = B")


def test_identity_checks_the_formula_in_the_text_that_it_shows():
    a, b = symbol("A"), symbol("B")
    assert identity("(A + B)² = A² + 2·A·B + B²", (a + b) ** 2).holds
    assert not identity("(A + B)² = A² + A·B + B²", (a + b) ** 2).holds
    assert identity("u² = A²", a**2, u=a).holds
    assert not identity("u² = A²", b**2, u=a).holds
