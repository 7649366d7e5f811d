"""Mutants of the kernel are told by proofs where those break, and explained where the table names them."""

from __future__ import annotations

import re
from functools import cache

import pytest

from tests.kernel.constant_proofs import PROOFS
from tests.tools.evidence.c_sites import HEADER, Mutant, schemata
from tests.tools.evidence.kernel_explained import TABLE, Rule, at_equality, changed, rules, told_by_proof


@cache
def mutants():
    """The mutants of the header, which take a second to be found."""
    return schemata(HEADER.read_text(encoding="utf-8"))[1]


def test_every_explanation_matches_a_mutant_of_the_header():
    for rule in rules():
        mine = [mutant for mutant in mutants() if re.fullmatch(rule.functions, mutant.function)]
        for change in rule.changes:
            assert any(Rule("", rule.functions, (change,)).explains(mutant) for mutant in mine), (rule, change)


def test_every_function_named_in_an_explanation_has_mutants():
    functions = {mutant.function for mutant in mutants()}
    for rule in rules():
        assert any(re.fullmatch(rule.functions, function) for function in functions), rule
        assert rule.reason.endswith("."), rule


def test_every_constant_whose_mutants_are_excused_by_room_has_a_derivation():
    for rule in rules():
        if rule.reason.startswith("Room:"):
            for mutant in mutants():
                if re.fullmatch(rule.functions, mutant.function):
                    assert mutant.function.removeprefix("HC_") in PROOFS


def test_table_of_kernel_mutants_is_a_file_beside_its_module():
    assert TABLE.is_file()


@pytest.mark.parametrize(
    ("before", "after", "comparison"),
    [
        ("a > 0 && b < 1", "(a > 0 && b <= 1)", ("b < 1", "b <= 1")),
        ("a > 0 && b < 1", "(a >= 0 && b < 1)", ("a > 0", "a >= 0")),
        ("!(f(a) > 0 && b)", "(!(f(a) >= 0 && b))", ("f(a) > 0", "f(a) >= 0")),
        ("a > 0 && b < 1", "(a > 0 || b < 1)", ("a > 0 && b < 1", "(a > 0 || b < 1)")),
        ("a > 0 && b < 1", "0", ("a > 0 && b < 1", "0")),
        ("a > 0", "(a >= 0)", ("a > 0", "a >= 0")),
        ("1.5", "3.0", ("1.5", "3.0")),
    ],
)
def test_the_comparison_that_a_mutant_changes_is_found(before, after, comparison):
    assert changed(Mutant(1, "f", before, after)) == comparison


def test_mutant_that_makes_a_comparison_strict_is_recognised_as_differing_only_at_equality():
    assert at_equality(Mutant(1, "f", "a >= 0 && b", "(a > 0 && b)"))
    assert not at_equality(Mutant(1, "f", "a == 0", "(a != 0)"))
    assert not at_equality(Mutant(1, "f", "a > 0 && b < 1", "0"))
    assert not at_equality(Mutant(1, "f", "a > 2", "(a > 3)"))


def test_mutant_of_the_decision_program_is_killed_by_the_proved_rule_for_all_signs():
    several = "HC_{}(inflection_beyond_B, rises_B)"
    assert told_by_proof(Mutant(1, "hc_certified", several.format("AND"), f"({several.format('OR')})")) == "rule"
    assert told_by_proof(Mutant(1, "hc_certified", "HC_GT(b, least)", "(HC_GE(b, least))")) == "rule"
    assert told_by_proof(Mutant(1, "hc_tilted", "HC_GT(l, HC_SET(0.0))", "(HC_GE(l, HC_SET(0.0)))")) is None


def test_mutant_of_a_constant_is_killed_by_the_derivation_of_that_constant():
    (half, twice) = (mutant for mutant in mutants() if mutant.function == "HC_u_12")
    assert (told_by_proof(half), told_by_proof(twice)) == ("derivation", "derivation")
    assert {told_by_proof(mutant) for mutant in mutants() if mutant.function == "HC_greatest_l"} == {None}
