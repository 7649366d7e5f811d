"""Foreign text is shown without anything that a terminal, a parser or an encoding would obey."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.messages import counted, escaped, json_trouble, shortened
from tests.report import record_samples


@given(record_samples.FOREIGN)
def test_escaped_text_is_printable_and_printable_text_is_unchanged(foreign):
    assert escaped(foreign).isprintable()
    assert escaped(escaped(foreign)) == escaped(foreign)


@pytest.mark.parametrize(
    ("foreign", "shown"),
    [
        ("λ² − 1", "λ² − 1"),
        ("a\nb\t\u2028 c\x85", "a b c"),
        ("\x1b[31m\x00\x7f\x8d", "\\x1b[31m\\x00\\x7f\\x8d"),
        ("\u202e\ufffe\ud800", "\\u202e\\ufffe\\ud800"),
        ("  a   b ", "a b"),
    ],
)
def test_invisible_characters_are_shown_as_escapes(foreign, shown):
    assert escaped(foreign) == shown


@given(st.text(), st.integers(1, 60))
def test_escaped_text_is_at_most_as_long_as_its_width(foreign, width):
    shown = escaped(foreign, width)
    assert shown.isprintable()
    assert len(shown) <= width
    assert shown == shortened(escaped(foreign), width)


def test_shortened_text_ends_with_an_ellipsis():
    assert [shortened("abc def", width) for width in (7, 6, 5, 2)] == ["abc def", "abc d…", "abc…", "a…"]


def test_counted_writes_the_noun_in_the_singular_only_for_1():
    assert [counted(number, "row") for number in (0, 1, 2, 5600)] == ["0 rows", "1 row", "2 rows", "5,600 rows"]
    assert [counted(number, "box", "boxes") for number in (1, 2)] == ["1 box", "2 boxes"]


@pytest.mark.parametrize(("text", "trouble"), [('"a\nb"', "invalid control character"), ('"a', "unterminated string")])
def test_json_trouble_leaves_out_the_trailing_at_of_the_json_error(text, trouble):
    with pytest.raises(json.JSONDecodeError) as caught:
        json.loads(text)
    assert json_trouble(caught.value) == trouble
