"""An error is one sentence that can be shown anywhere, whatever it quotes."""

from __future__ import annotations

import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.errors import HypcheckError, InputError
from hypcheck.messages import LONGEST, sentence
from hypcheck.record.integrity import DamagedError


@given(st.text())
def test_the_text_of_an_error_is_one_printable_line(text):
    shown = str(InputError(f"row 3: alpha is {text!s}; it must be a number"))
    assert shown.isprintable()
    assert shown.startswith("row 3: alpha is")
    assert shown.endswith("; it must be a number")


@pytest.mark.parametrize("character", ["a", "\U0010ffff", "\x1b", " ", "é"])
@pytest.mark.parametrize("length", [LONGEST - 20, LONGEST, 2 * LONGEST, 1_000_000])
def test_the_text_of_a_long_error_is_shortened_in_the_middle(character, length):
    shown = str(InputError(f"beginning {character * length} end"))
    assert len(shown) <= LONGEST
    assert shown.startswith("beginning")
    assert shown.endswith("end")


def test_the_text_of_a_short_printable_error_is_unchanged():
    assert sentence("α is 0; it must be > 0") == "α is 0; it must be > 0"


def test_errors_keep_their_text_and_attributes_when_pickled():
    error = pickle.loads(pickle.dumps(DamagedError("it is damaged", 17)))  # noqa: S301 - our own
    assert isinstance(error, HypcheckError)
    assert (str(error), error.at, error.exit_code) == ("it is damaged", 17, 2)
