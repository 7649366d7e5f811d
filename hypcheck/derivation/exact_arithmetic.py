"""Exact arithmetic: rationals, and numbers p + q√h over them, with signs that are decided and never estimated.

One square root is all a formula here takes (the local maximum of g), so a second, different root is refused.
Division by zero and the root of a negative number give UNDEFINED, which like NaN goes through every operation and
makes every comparison false: a straight-line program evaluates also the branch that it will not select.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from hypcheck.derivation.evaluation import Arithmetic


class Undefined:
    """The value of an operation that has none."""

    def _undefined(self, *_others: object) -> Undefined:
        return self

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = _undefined
    __neg__ = __abs__ = _undefined

    def _false(self, _other: object) -> bool:
        return False

    __lt__ = __le__ = __gt__ = __ge__ = _false

    def __eq__(self, _other: object) -> bool:
        return False

    def __ne__(self, _other: object) -> bool:
        return True

    def __hash__(self) -> int:
        return id(self)

    def __repr__(self) -> str:
        return "undefined"


UNDEFINED = Undefined()


@dataclass(frozen=True, slots=True, eq=False)
class Surd:
    """The number p + q√h: p and q rational, q ≠ 0, and h > 0 rational and not the square of a rational.

    It is therefore irrational, never zero, and equal to another exactly when p and q are. `surd` makes one.
    """

    p: Fraction
    q: Fraction
    h: Fraction

    def __add__(self, other: object) -> Fraction | Surd | Undefined:
        parts = self._parts(other)
        return NotImplemented if parts is None else surd(self.p + parts[0], self.q + parts[1], self.h)

    def __mul__(self, other: object) -> Fraction | Surd | Undefined:
        parts = self._parts(other)
        if parts is None:
            return NotImplemented
        p, q = parts
        return surd(self.p * p + self.q * q * self.h, self.p * q + self.q * p, self.h)

    __radd__ = __add__
    __rmul__ = __mul__

    def __neg__(self) -> Surd:
        return Surd(-self.p, -self.q, self.h)

    def __abs__(self) -> Surd:
        return self if self.sign > 0 else -self

    def __sub__(self, other: Any) -> Any:
        return NotImplemented if self._parts(other) is None else self + -other

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    def __truediv__(self, other: Any) -> Any:
        if isinstance(other, Surd):
            return self * other.reciprocal
        return NotImplemented if self._parts(other) is None else self * (1 / Fraction(other))

    def __rtruediv__(self, other: Any) -> Any:
        return self.reciprocal * other

    @property
    def reciprocal(self) -> Fraction | Surd:
        """1 over it, by the conjugate: p² − q²h is not zero, since h is not a square."""
        norm = self.p**2 - self.q**2 * self.h
        return Surd(self.p / norm, -self.q / norm, self.h)

    @property
    def sign(self) -> int:
        """+1 or −1: the sign of the larger of |p| and |q|√h, found from their squares."""
        larger = self.p if self.p**2 > self.q**2 * self.h else self.q
        return 1 if larger > 0 else -1

    def __lt__(self, other: object) -> bool:
        sign = self._compare(other)
        return NotImplemented if sign is None else sign < 0

    def __gt__(self, other: object) -> bool:
        sign = self._compare(other)
        return NotImplemented if sign is None else sign > 0

    def __le__(self, other: object) -> bool:
        sign = self._compare(other)
        return NotImplemented if sign is None else sign <= 0

    def __ge__(self, other: object) -> bool:
        sign = self._compare(other)
        return NotImplemented if sign is None else sign >= 0

    def __eq__(self, other: object) -> bool:
        sign = self._compare(other)
        return NotImplemented if sign is None else sign == 0

    def __hash__(self) -> int:
        return hash((self.p, self.q, self.h))

    def _compare(self, other: object) -> int | None:
        """The sign of self − other, or None where `other` is of another type."""
        parts = self._parts(other)
        return None if parts is None else sign_of(surd(self.p - parts[0], self.q - parts[1], self.h))

    def _parts(self, other: object) -> tuple[Fraction, Fraction] | None:
        if isinstance(other, Surd):
            if other.h != self.h:
                raise ValueError(f"√{self.h} and √{other.h} do not lie in one quadratic field")
            return other.p, other.q
        if isinstance(other, (int, Fraction)):
            return Fraction(other), Fraction(0)
        return None


def surd(p: Fraction, q: Fraction, h: Fraction) -> Fraction | Surd:
    """p + q√h, as a Fraction where q is 0; `h` must be no square of a rational."""
    return Surd(p, q, h) if q else p


def sign_of(number: Fraction | Surd) -> int:
    """+1, 0 or −1."""
    if isinstance(number, Surd):
        return number.sign
    return (number > 0) - (number < 0)


def square_root(number: Any) -> Fraction | Surd | Undefined:
    """The root of a rational, exact; UNDEFINED below zero. Raises TypeError for the root of an irrational number."""
    if isinstance(number, Undefined):
        return UNDEFINED
    rational = Fraction(number)
    if rational < 0:
        return UNDEFINED
    root = Fraction(math.isqrt(rational.numerator), math.isqrt(rational.denominator))
    return root if root * root == rational else Surd(Fraction(0), Fraction(1), rational)


def _divide(dividend: Any, divisor: Any) -> Any:
    return UNDEFINED if divisor == 0 else dividend / divisor


def _select(condition: bool, yes: Any, no: Any) -> Any:
    return yes if condition else no


EXACT = Arithmetic(
    name="exact",
    convert=Fraction,
    operations={
        "add": operator.add,
        "sub": operator.sub,
        "mul": operator.mul,
        "div": _divide,
        "neg": operator.neg,
        "abs": abs,
        "sqrt": square_root,
        "gt": operator.gt,
        "lt": operator.lt,
        "ge": operator.ge,
        "le": operator.le,
        "eq": operator.eq,
        "ne": operator.ne,
        "and": operator.and_,
        "or": operator.or_,
        "not": operator.not_,
        "select": _select,
    },
)
"""Inputs may be int, Fraction or float (its exact value)."""
