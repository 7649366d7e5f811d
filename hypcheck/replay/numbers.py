"""Values of both arithmetics for people: any size, to a few digits, each digit right."""

from __future__ import annotations

import math
from decimal import Context, Decimal
from fractions import Fraction
from typing import Any

import numpy as np

from hypcheck.derivation.exact_arithmetic import Surd

DIGITS = 8
_GUARD = 8

Number = Fraction | Surd


def number_of(value: Any) -> bool | float | Fraction:  # noqa: ANN401 - any scalar of numpy
    """A machine value: a truth value, the exact value of a finite number, or an infinity or NaN as a float."""
    scalar: Any = np.asarray(value)[()]
    if isinstance(scalar, np.bool_):
        return bool(scalar)
    if not np.isfinite(scalar):
        return float(scalar)
    return Fraction(*scalar.as_integer_ratio())


def rational(value: Number, bits: int = 64) -> Fraction:
    """A rational within a relative 2^−bits of the value; the value itself where it is rational."""
    if not isinstance(value, Surd):
        return value
    # p and q√h of one sign cannot cancel. Of two signs, p + q√h = (p² − q²h)/(p − q√h), and p, −q√h have one sign.
    if value.p * value.q < 0:
        return (value.p**2 - value.q**2 * value.h) / rational(Surd(value.p, -value.q, value.h), bits + 1)
    return value.p + value.q * _root(value.h, bits + 1)


def _root(value: Fraction, bits: int) -> Fraction:
    """√value within a relative 2^−bits: isqrt drops less than 1 of an integer of more than bits + 1 bits."""
    # value·4^k with 4^k large enough that its integer part has 2·bits + 4 bits, hence its root bits + 2.
    size = value.numerator.bit_length() - value.denominator.bit_length()
    shift = max(0, (2 * bits + 6 - size) // 2 + 1)
    return Fraction(math.isqrt((value.numerator << 2 * shift) // value.denominator), 1 << shift)


def said(value: object, digits: int = DIGITS) -> str:
    """A value of either arithmetic: yes or no, "undefined", a word for what is not finite, or a number to `digits`."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (Fraction, Surd)):
        return _decimal(rational(value, 4 * digits + _GUARD), digits)
    return str(value)


def _decimal(value: Fraction, digits: int) -> str:
    """A rational to that many digits, without an exponent where that is short, without zeros at the end."""
    context = Context(prec=digits, Emin=-(10**9), Emax=10**9)
    rounded = context.divide(Decimal(value.numerator), Decimal(value.denominator))
    if not rounded:
        return "0"
    exponent = rounded.adjusted()
    if -4 <= exponent < digits:
        return _trimmed(f"{rounded:f}")
    return f"{_trimmed(f'{rounded.scaleb(-exponent, context):f}')}e{exponent}"


def _trimmed(text: str) -> str:
    return text.rstrip("0").rstrip(".") if "." in text else text


def relative_error(value: object, exact: object) -> float | None:
    """|value − exact|/|exact|: 0 where they are equal, inf where exact is 0 or value not finite, None of no numbers."""
    if isinstance(value, bool) or not isinstance(exact, (Fraction, Surd)):
        return None
    if not isinstance(value, Fraction):
        return math.inf
    if exact == 0:
        return 0.0 if value == 0 else math.inf
    error = abs(rational(exact - value) / rational(exact))
    try:
        return float(error) or (math.ulp(0.0) if error else 0.0)
    except OverflowError:
        return math.inf
