"""How vector files write numbers: shortest decimals, hexadecimal floats as C prints them, rationals as "p/q"."""

from __future__ import annotations

import math
import re
from decimal import Decimal, InvalidOperation
from fractions import Fraction

from hypcheck.tables.numbers import Literal

_ZEROS = re.compile(r"\.?0+(?=p)")
_RATIONAL = re.compile(r"(-?)(0|[1-9][0-9]*)(?:/([1-9][0-9]*))?", re.ASCII)
_LONGEST = 100_000
"""Characters of a rational. Shipped ones have 1,236 at most; reading takes a time that grows with the square."""
_PLACES = 4000
_SHIFT: int = 10**_PLACES
"""Python turns no text of more than 4300 digits into an integer by itself, so a longer one goes by pieces."""


def decimal_of(value: float) -> str:
    """The shortest decimal that float64 reads back as `value`, as JSON; an infinity or NaN is a string."""
    return repr(value) if math.isfinite(value) else f'"{value}"'


def hex_of(value: float) -> str:
    """`value` exactly, as C's %a has it and strtod reads it: 0x1.8p+1, -0x0p+0; inf and nan by name."""
    return _ZEROS.sub("", value.hex())


def is_shortest(number: float | int) -> bool:
    """Whether a number read from a file (Literal or int) has the digits of the shortest decimal of its float64.

    Notation is free, so that 2, 2.0 and 20e-1 are the same; a digit too many or too few is not.
    """
    text = number.text if isinstance(number, Literal) else str(number)
    try:
        value = float(text)
    except OverflowError:
        return False
    try:
        return math.isfinite(value) and Decimal(text) == Decimal(repr(value))
    except InvalidOperation:  # of a zero, or what rounds to it, with an exponent that even Decimal cannot hold
        return False


def rational_of(text: str) -> Fraction:
    """The rational that `text` writes as "p" or "p/q" in lowest terms. Raises ValueError for any other text."""
    if len(text) > _LONGEST:
        raise ValueError(f"must have at most {_LONGEST} digits")
    match = _RATIONAL.fullmatch(text)
    if match is None:
        raise ValueError("must be an integer or p/q, such as -3/4")
    sign, top, bottom = match.groups()
    numerator, denominator = _whole(top), _whole(bottom or "1")
    if math.gcd(numerator, denominator) != 1 or (bottom == "1") or (sign and not numerator):
        raise ValueError("must be in lowest terms, such as -3/4")
    return Fraction(-numerator if sign else numerator, denominator)


def _whole(digits: str) -> int:
    if len(digits) <= _PLACES:
        return int(digits)
    return _whole(digits[:-_PLACES]) * _SHIFT + int(digits[-_PLACES:])
