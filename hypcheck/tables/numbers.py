"""Numbers as text: read by the same rules on the command line and in every table, and written so that nothing is lost.

A number in text is decimal: an optional sign, ASCII digits with an optional point, an optional exponent, blanks around
it. It is rounded to the nearest float64, as every reader of decimals does. Python's float() takes more ("1_000", digits
of other scripts, "infinity"); none of that is a number here. Rationals are written exactly as "p/q", or for a reader to
17 digits. Vector files hold shortest decimals, hexadecimal floats as C prints them, and rationals.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from decimal import Context, Decimal, InvalidOperation
from fractions import Fraction

from hypcheck.geometry.pair import ENDS, HEIGHTS, SIZES, trouble_with
from hypcheck.messages import escaped

CHARACTERS = b"0123456789+-.eE \t"
"""The characters of numbers: text of these alone that float() accepts is a number by the rules above."""

LONGEST_SHOWN = 40
_DECIMAL = re.compile(r"[ \t]*[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?[ \t]*", re.ASCII)
"""Digits are matched by one group alone, or the time to refuse them would grow with the square of their number."""
_NOT_ZERO = re.compile(r"^[^eE]*[1-9]")
"""A digit other than 0 before the exponent."""
_UNBOUNDED = re.compile(r"\s*[+-]?(nan|inf|infinity)\s*", re.ASCII | re.IGNORECASE)


def number_of_text(name: str, text: str) -> float:
    """Read the float64 nearest to `text`, valid in column `name`. Raises ValueError, a sentence about `name`."""
    if not text.strip():
        raise ValueError(f"{name} is empty; it must be a number")
    if name in HEIGHTS and (height := _WORDS[name].get(text.strip().casefold())) is not None:
        return height
    if _UNBOUNDED.fullmatch(text):
        if name in ENDS:
            raise ValueError(f"{name} is {shown(text)}; it must be a number, inf or -inf")
        raise ValueError(f"{name} is {shown(text)}; it must be finite")
    if not is_number(text):
        raise ValueError(f"{name} is {shown(text)}; it must be a decimal number such as 2.5 or -1e-3")
    return _valid(name, float(text), shown(text.strip(" \t"), quoted=False))


_INFINITE = {"inf": math.inf, "+inf": math.inf, "-inf": -math.inf, "infinity": math.inf, "-infinity": -math.inf}
_WORDS = {"z_min": _INFINITE, "z_max": _INFINITE, "solid": {"true": 1.0, "false": 0.0}}
"""The words that are allowed as a height besides decimal numbers."""


def is_number(text: str) -> bool:
    """Decide whether `text` is written as a number, of whatever value."""
    return _DECIMAL.fullmatch(text) is not None


class Literal(float):
    """A JSON number that keeps its text, so that a message says 1e999 and not inf."""

    text: str

    def __new__(cls, text: str) -> Literal:
        """Make the float64 nearest to `text`, with the text."""
        number = super().__new__(cls, text)
        number.text = text
        return number


def number_of_json(name: str, value: object) -> float:
    """Read the float64 nearest to a JSON number (Literal, float or int), as number_of_text does. Raises ValueError."""
    if name in HEIGHTS and isinstance(value, (str, bool)):
        height = _WORDS[name].get(str(value).casefold() if isinstance(value, bool) else value)
        if height is not None:
            return height
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        right = 'a number, "inf" or "-inf"' if name in ENDS else "0 or 1" if name in HEIGHTS else "a number"
        raise ValueError(f"{name} is {shown_json(value)}; it must be {right}")  # noqa: TRY004 - the value is at fault
    try:
        number = float(value)
    except OverflowError:
        number = float("inf")
    return _valid(name, number, shown_json(value))


def _valid(name: str, number: float, text: str) -> float:
    """Return the number if it is valid in column `name`. Raises ValueError, a sentence about its text."""
    if abs(number) == float("inf"):
        raise ValueError(f"{name} is {text}, which is too large for float64")
    if number == 0 and name in SIZES and _NOT_ZERO.search(text):
        raise ValueError(f"{name} is {text}, which is too small for float64; it must be greater than 0")
    trouble = trouble_with(name, number)
    if trouble is not None:
        demand = trouble.partition("; ")[2]
        raise ValueError(f"{name} is {text}; {demand}")
    return number


def shown(text: str, *, quoted: bool = True) -> str:
    """Return `text` as a message shows it: on one line, quoted unless `quoted` is false, and cut if it is long."""
    cut = text if len(text) <= LONGEST_SHOWN else text[:LONGEST_SHOWN] + "…"
    return repr(cut) if quoted else escaped(cut)


def shown_json(value: object) -> str:
    """Return a JSON value as a message shows it: as JSON writes it, cut if it is long."""
    text = value.text if isinstance(value, Literal) else json.dumps(value, ensure_ascii=False, default=repr)
    return shown(text, quoted=False)


_LONGEST_EXACT = 24
_SEVENTEEN_DIGITS = Context(prec=17, Emin=-(10**6), Emax=10**6)
_DIRECT_BITS = 10_000
_PIECE_DIGITS = 3_000
"""Python writes and reads no integer of more than 4300 digits by itself, so a longer one goes by pieces.

10**3000 has 9966 bits, fewer than _DIRECT_BITS, so the high piece of a longer integer is never 0.
"""
_PIECE: int = 10**_PIECE_DIGITS


def exact_text(value: Fraction) -> str:
    """Write `value` as "3" or "-3/2", whatever its length."""
    top = _integer_text(value.numerator)
    return top if value.denominator == 1 else f"{top}/{_integer_text(value.denominator)}"


def readable_text(value: Fraction) -> str:
    """Write `value` for a reader: exact if that is short, else "≈" and 17 digits."""
    if (
        value.numerator.bit_length() + value.denominator.bit_length() < 4 * _LONGEST_EXACT
        and len(exact_text(value)) <= _LONGEST_EXACT
    ):
        return exact_text(value)
    return f"≈ {_SEVENTEEN_DIGITS.divide(Decimal(value.numerator), Decimal(value.denominator))}"


def equals_text(value: Fraction) -> str:
    """Write `value` after an equals sign: "= 3/2", or "≈ 0.33333333333333333" if it is rounded."""
    text = readable_text(value)
    return text if text.startswith("≈") else f"= {text}"


def _integer_text(number: int) -> str:
    """Write an integer of any length."""
    if number < 0:
        return "-" + _integer_text(-number)
    if number.bit_length() < _DIRECT_BITS:
        return str(number)
    high, low = divmod(number, _PIECE)
    return _integer_text(high) + str(low).zfill(_PIECE_DIGITS)


_RATIONAL = re.compile(r"(-?)(0|[1-9][0-9]*)(?:/([1-9][0-9]*))?", re.ASCII)
_LONGEST_RATIONAL = 100_000
"""The longest rational that is read, in characters. Shipped ones have 1,236 at most; time grows with the square."""


def decimal_of(value: float) -> str:
    """Write the shortest decimal that float64 reads back as `value`, as JSON; an infinity or NaN is a string."""
    return repr(value) if math.isfinite(value) else f'"{value}"'


def decimals_of(row: Sequence[float]) -> str:
    """Write the decimals of a row as the command line takes them and reads them back; a zero has no sign."""
    return ",".join(repr(value + 0.0).removesuffix(".0") for value in row)


def hex_of(value: float) -> str:
    """Write `value` exactly, as C's %a writes it and strtod reads it: 0x1.8p+1, -0x0p+0; inf and nan by name."""
    digits, _, exponent = value.hex().partition("p")
    return f"{digits.rstrip('0').rstrip('.')}p{exponent}" if exponent else digits


def is_shortest(number: float | int) -> bool:
    """Decide whether a number read from a file (Literal or int) has the digits of its float64's shortest decimal.

    Notation is free: 2, 2.0 and 20e-1 are all right. A digit too many or too few is not.
    """
    text = number.text if isinstance(number, Literal) else str(number)
    value = float(text)
    try:
        return math.isfinite(value) and (text == repr(value) or Decimal(text) == Decimal(repr(value)))
    except InvalidOperation:  # a zero, or what rounds to it, with an exponent too large even for Decimal
        return False


def rational_of(text: str) -> Fraction:
    """Read a rational, "p" or "p/q" in lowest terms. Raises ValueError, the end of a sentence."""
    if len(text) > _LONGEST_RATIONAL:
        raise ValueError(f"a text of at most {_LONGEST_RATIONAL} digits")
    match = _RATIONAL.fullmatch(text)
    if match is None:
        raise ValueError("an integer or p/q, such as -3/4")
    sign, top, bottom = match.groups()
    numerator, denominator = _integer_of(top), _integer_of(bottom or "1")
    if math.gcd(numerator, denominator) != 1 or (bottom == "1") or (sign and not numerator):
        raise ValueError("in lowest terms, such as -3/4")
    return Fraction(-numerator if sign else numerator, denominator)


def _integer_of(digits: str) -> int:
    """Read an integer of any length."""
    if len(digits) <= _PIECE_DIGITS:
        return int(digits)
    return _integer_of(digits[:-_PIECE_DIGITS]) * _PIECE + int(digits[-_PIECE_DIGITS:])
