"""Whole numbers of the command line: large ones with an exponent, others refused in one sentence."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.cli.options import integer_of
from hypcheck.implementations.description import Description
from hypcheck.runs.cases import family_chunks, searched_chunks
from hypcheck.runs.plan import ConformancePlan, planned_size, searches
from hypcheck.vectors.families import select


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("0", 0),
        ("007", 7),
        ("1e9", 10**9),
        ("1E+9", 10**9),
        ("2.5e6", 2_500_000),
        ("12.0", 12),
        ("1_000_000", 10**6),
        ("9223372036854775807", 2**63 - 1),
        ("1e99", 10**99),
    ],
)
def test_integer_option_reads_whole_numbers_with_exponents_exactly(text, number):
    assert integer_of(text) == number


@pytest.mark.parametrize(
    "text", ["", " ", "1.5", "1e-1", "-1", "+1", "1__0", "_1", "1_", "e9", "1e", "1e999", "0x10", "٣", "inf", "1" * 30]
)
def test_integer_option_refuses_texts_that_are_not_whole_numbers(text):
    assert integer_of(text) is None


@given(st.integers(0, 10**19 - 1))
def test_integer_option_reads_digits_with_and_without_underscores_as_python_does(number):
    assert integer_of(str(number)) == number
    assert integer_of(f"{number:_}") == number


@pytest.mark.slow
@pytest.mark.parametrize("families", [(), ("ring", "tower-body"), ("extreme-*",)])
def test_planned_size_is_the_number_of_rows_in_all_chunks_of_the_run(families):
    plan = ConformancePlan(("builtin:fast",), families=families, count=70_000)
    chosen = select(families, None) if families else select()
    some = [chunk for family in chosen for chunk in family_chunks(family, plan.seed, plan.count * family.times)]
    followed = () if families else searches(plan, Description("any"))
    assert planned_size(plan) == sum(map(len, [*some, *(() if families else searched_chunks()), *followed]))


def test_planned_size_of_a_huge_run_is_computed_without_its_chunks():
    assert planned_size(ConformancePlan(("builtin:fast",), families=("ring",), count=10**15)) > 10**15
