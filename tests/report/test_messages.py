"""Numbers, lists and rows as reports show them."""

from __future__ import annotations

import math
import shlex

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.messages import counted
from hypcheck.report.messages import classify_command, figure, from_hex, listed, short_row
from tests.report import record_samples


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (math.inf, "∞"),
        (0.8, "0.8"),
        (0.0012345, "0.00123"),
        (0.00012345, "1.2e-4"),
        (12.345, "12.3"),
        (999.4, "999"),
        (999.9, "1,000"),
        (4823.0, "4,820"),
        (999999.0, "1,000,000"),
        (3.14e6, "3.1e6"),
        (9.007e15, "9.0e15"),
        (5e-324, "4.9e-324"),
    ],
)
def test_figures_have_three_digits(value, text):
    assert figure(value) == text


@pytest.mark.parametrize(
    ("items", "text"), [([], ""), (["a"], "a"), (["a", "b"], "a and b"), (list("abc"), "a, b and c")]
)
def test_lists_are_written_as_in_a_sentence(items, text):
    assert listed(items) == text


def test_counts_have_their_noun():
    assert [counted(number, "case") for number in (0, 1, 5600)] == ["0 cases", "1 case", "5,600 cases"]


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=7, max_size=7))
def test_a_row_survives_the_record_and_the_command(row):
    assert list(from_hex(record_samples.hexes(row))) == row
    words = shlex.split(classify_command(row))
    assert words[2:10:2] == ["--alpha", "--gamma", "--b", "--d"]
    assert [float(word) for word in (*words[3:10:2], *words[11:])] == row


def test_a_short_row_has_six_digits():
    assert (
        short_row((2.0, 17.8, 0.25, 1 / 3, -3.0, 0.0, 1e-9))
        == "alpha 2, gamma 17.8, b 0.25, d 0.333333, centre (-3, 0, 1e-09)"
    )
