"""The derivation of each constant of the header holds with it; that of a bound fails with half of it and with twice."""

from __future__ import annotations

import re
from fractions import Fraction

import pytest

from tests.kernel.compiling import HEADER
from tests.kernel.constant_proofs import PROOFS, widths

DEFINED = dict(re.findall(r"#define HC_(\w+) (-?[\d.]+(?:e[+-]?\d+)?)\b", HEADER.read_text(encoding="utf-8")))


@pytest.mark.parametrize("name", PROOFS)
def test_the_derivation_of_each_constant_holds_with_its_value_in_the_header(name):
    assert PROOFS[name](Fraction(float(DEFINED[name])))


@pytest.mark.parametrize("name", [name for name in PROOFS if name.startswith("u_") or name == "rounded"])
def test_the_derivation_of_each_bound_fails_with_half_and_with_twice_its_value(name):
    value = Fraction(float(DEFINED[name]))
    assert not PROOFS[name](value / 2)
    assert not PROOFS[name](value * 2)


@pytest.mark.parametrize("name", ["fixed_coefficient", "fixed_pole", "fixed_delta", "fixed_middle", "WIDEST"])
def test_the_derivation_of_each_integer_constant_fails_with_one_less_and_one_more(name):
    value = int(DEFINED[name])
    assert not PROOFS[name](Fraction(value - 1))
    assert not PROOFS[name](Fraction(value + 1))


def test_the_header_defines_the_vector_width_of_every_instruction_set():
    assert sorted(widths()) == [1, 2, 2, 4, 8]


@pytest.mark.parametrize(
    ("name", "beyond"),
    [
        ("less_sure", 1.0),
        ("greatest_l", 2.0**75),
        ("lost", 2.0**-1022),
        ("least_height", 2.0**-500),
        ("greatest_height", 2.0**205),
        ("less_than", 1.0),
        ("FARTHEST_SWEEP", 2.0**200),
        ("GREATEST_SLACK", 1.0),
        ("MOST_GROWN", 122),
        ("SEEN", 128),
        ("least_offset", 2.0**-1023),
        ("CUT_BITS", 192),
        ("TANGENCY_BITS", 64),
        ("HAIR", 2.0**-30),
    ],
)
def test_the_derivation_of_each_limit_fails_beyond_the_range_that_it_covers(name, beyond):
    assert not PROOFS[name](Fraction(beyond))
