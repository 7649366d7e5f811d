"""Numbers as tables write them; fast and thorough reading accept the same texts."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.tables.numbers import CHARACTERS, Literal, is_number, is_shortest, number_of_json, number_of_text, shown


@pytest.mark.parametrize("text", ["1", "-2.5", "+.5", "5.", "1e3", "1E-3", " 1.0 ", "\t7", "007", "-1e-400", "1" * 400])
def test_valid_decimal_texts_are_accepted_as_numbers(text):
    assert is_number(text)


@pytest.mark.parametrize(
    "text",
    [
        "",
        " ",
        "abc",
        "1_0",
        "0x10",
        "１",
        "٣",
        "1,5",
        "1 2",
        "--1",
        "1e",
        "e5",
        ".",
        "1.2.3",
        "1d5",
        "½",
        "1\n",
        "\xa01",
    ],
)
def test_texts_that_are_no_decimals_are_refused_as_numbers(text):
    assert not is_number(text)
    with pytest.raises(ValueError, match=r"^x is .*; it must be a"):
        number_of_text("x", text)


@given(st.text(CHARACTERS.decode(), max_size=12))
def test_python_float_and_is_number_accept_the_same_texts_of_number_characters(text):
    """Fast reading depends on this: it checks the characters only and leaves the grammar to float()."""
    try:
        float(text)
    except ValueError:
        assert not is_number(text)
    else:
        assert is_number(text)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_decimal_text_of_every_float_is_read_back_as_that_float(value):
    assert number_of_text("x", repr(value)) == value
    assert number_of_json("x", json.loads(repr(value))) == value


def test_number_with_more_digits_than_float64_holds_is_rounded_to_nearest():
    assert number_of_text("x", "9007199254740993") == 2.0**53  # a tie, to even
    assert number_of_text("x", "9007199254740993.0000000000000000000000001") == 2.0**53 + 2
    assert number_of_json("x", 9007199254740995) == 2.0**53 + 4


@pytest.mark.parametrize("value", [True, False, None, "1", [1], {"x": 1}])
def test_json_value_that_is_not_a_number_is_refused_and_quoted_as_json(value):
    with pytest.raises(ValueError, match="it must be a number") as caught:
        number_of_json("x", value)
    assert str(caught.value).startswith(f"x is {json.dumps(value)};")


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("z_max", "high", 'z_max is "high"; it must be a number, "inf" or "-inf"'),
        ("solid", "maybe", 'solid is "maybe"; it must be 0 or 1'),
        ("x", 10**400, "which is too large for float64"),
    ],
)
def test_a_json_value_that_is_neither_a_number_nor_a_known_word_is_refused(name, value, says):
    with pytest.raises(ValueError, match=says):
        number_of_json(name, value)


def test_is_shortest_is_false_for_a_zero_whose_exponent_has_too_many_digits():
    assert is_shortest(Literal("0e9"))
    assert not is_shortest(Literal(f"0e{'9' * 30}"))


def test_message_shows_only_the_beginning_of_a_long_value():
    assert len(shown("a" * 10_000)) < 60
