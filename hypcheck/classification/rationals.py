"""Exact rationals as text."""

from __future__ import annotations

from decimal import Context, Decimal
from fractions import Fraction

_SHORT = 24
_DIGITS = Context(prec=17, Emin=-(10**6), Emax=10**6)
_BITS = 10_000
_PLACES = (
    3_000  # 10**_PLACES has fewer bits than _BITS, and Python writes no integer of more than 4300 digits by itself
)


def exact(value: Fraction) -> str:
    """`value` as "3" or "-3/2", whatever its length."""
    top = _digits(value.numerator)
    return top if value.denominator == 1 else f"{top}/{_digits(value.denominator)}"


def readable(value: Fraction) -> str:
    """`value` for a person: exact where that is short, else to 17 digits with a sign that it was rounded."""
    if value.numerator.bit_length() + value.denominator.bit_length() < 4 * _SHORT and len(exact(value)) <= _SHORT:
        return exact(value)
    return f"≈ {_DIGITS.divide(Decimal(value.numerator), Decimal(value.denominator))}"


def relation(value: Fraction) -> str:
    """`value` after an equals sign: "= 3/2", or "≈ 0.33333333333333333" where it is rounded."""
    text = readable(value)
    return text if text.startswith("≈") else f"= {text}"


def _digits(number: int) -> str:
    if number < 0:
        return "-" + _digits(-number)
    if number.bit_length() < _BITS:
        return str(number)
    high, low = divmod(number, 10**_PLACES)
    return _digits(high) + str(low).zfill(_PLACES)
