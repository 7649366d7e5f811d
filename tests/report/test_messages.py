"""Numbers, lists and rows as reports show them."""

from __future__ import annotations

import json
import math
import shlex

import pytest
from hypothesis import given
from hypothesis import strategies as st

import hypcheck
from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.geometry.rows import PAIRS, SWEEPS
from hypcheck.record.lines import DomainPart, FixedSizesPart
from hypcheck.record.reader import line_of
from hypcheck.report.document import Code, Emphasis, Strong, plain
from hypcheck.report.messages import (
    classify_command,
    domain_text,
    figure,
    from_hex,
    implementation_claims,
    listed,
    short_row,
)
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
def test_figures_in_messages_have_three_digits(value, text):
    assert figure(value) == text


@pytest.mark.parametrize(
    ("items", "text"), [([], ""), (["a"], "a"), (["a", "b"], "a and b"), (list("abc"), "a, b and c")]
)
def test_lists_in_messages_are_joined_with_commas_and_and(items, text):
    assert listed(items) == text


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=7, max_size=7))
def test_row_is_read_back_exactly_from_the_record_and_the_classify_command(row):
    assert list(from_hex(record_samples.hexes(row))) == row
    words = shlex.split(classify_command(row))
    assert words[2:10:2] == ["--alpha", "--gamma", "--b", "--d"]
    assert [float(word) for word in (*words[3:10:2], *words[11:])] == row


SEVEN, AXIS, HEIGHTS = (2.0, 17.8, 0.25, 0.15, 2.1, 0.0, 3.0), (1.0, 0.0, 0.5), (-1.0, 2.9, 1.0)
UPRIGHT = (0.0, 0.0, 1.0)


@pytest.mark.parametrize("end", [(), (-9.0, 0.5, 3.0)])
@pytest.mark.parametrize(
    "others", [(), AXIS, (*UPRIGHT, *HEIGHTS), (*AXIS, -math.inf, 2.9, 0.0), (*AXIS, -math.inf, math.inf, 1.0)]
)
def test_the_classify_command_of_a_row_has_all_of_its_numbers(others, end, capsys):
    row = (*(SEVEN if not end else (*SEVEN[:4], 9.0, 0.5, 3.0)), *end, *others)
    command = shlex.split(classify_command(row, SWEEPS if end else PAIRS))
    assert main([*command[1:], "--json"]) in (0, 1)
    answer = json.loads(capsys.readouterr().out)
    if end:
        sweep = hypcheck.passage(row)
        assert (answer["hit"], answer["first"]) == (sweep.hit, [sweep.first_lower, sweep.first_upper])
    else:
        assert answer["position"] == hypcheck.classify([row])[0]


def test_short_text_of_a_row_has_at_most_six_digits_a_number():
    assert short_row((*SEVEN, *AXIS, *HEIGHTS)).endswith("axis (1, 0, 0.5), z_min -1, z_max 2.9, solid 1")
    assert (
        short_row((2.0, 17.8, 0.25, 1 / 3, -3.0, 0.0, 1e-9))
        == "alpha 2, gamma 17.8, b 0.25, d 0.333333, centre (-3, 0, 1e-09)"
    )


def test_a_number_beyond_float64_in_a_record_is_bad_input():
    with pytest.raises(InputError, match="too large for float64 in the row 0x1p\\+0, 0x1p\\+5000"):
        from_hex(["0x1p+0", "0x1p+5000"])


def test_claims_of_an_implementation_tested_on_every_row_do_not_mention_untested_rows():
    line = next(line for line in record_samples.sample("failures") if line.get("name") == "engine")
    some = list(implementation_claims(line_of(line)))
    del line["not_asked"]
    every = list(implementation_claims(line_of(line)))
    assert every == [claim for claim in some if not claim.startswith("not asked: ")]
    assert len(every) == len(some) - 1


def test_text_of_a_domain_names_four_fixed_sizes_and_counts_the_rest():
    sizes = [FixedSizesPart(sizes=(float(n), 2.0, 0.5, 0.25), x=None, y=None, z=None, axis=None) for n in range(1, 7)]
    domain = DomainPart(regimes=[], ratio=None, magnitude=None, settings=sizes)
    assert "(4, 2, 0.5, 0.25) or 2 more" in domain_text(domain)
    assert "5, 2, 0.5" not in domain_text(domain)


def test_plain_text_omits_the_marks_of_strong_emphasised_and_code_parts():
    assert plain(("of ", Strong("all"), " that ", Emphasis(("is ", Code("here"))))) == "of all that is here"
