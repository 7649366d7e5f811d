"""Plain arithmetic that belongs to no oracle and to no kernel.

First signs, then vectors of three numbers and 3×3 matrices, of integers, rationals, intervals or arrays; then rational
numbers: roots, powers of two, few bits, and bisection; and numbers of a quadratic field, p + q√h.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import total_ordering
from itertools import count, pairwise
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mpmath import mpf


def sign_of(number: Fraction | int | QuadraticSurd) -> int:
    """Return the sign: 1, 0 or −1."""
    return (number > 0) - (number < 0)


def sign_with_root(u: Fraction | int, v: Fraction | int, w: Fraction | int) -> int:
    """Return the sign of u + v √w, where w > 0 or v = 0."""
    if u >= 0 and v >= 0:
        return int(u > 0 or v > 0)
    if u <= 0 and v <= 0:
        return -1
    return sign_of(u * u - v * v * w) * (1 if u > 0 else -1)


def changes_of_sign(numbers: Iterable[int]) -> int:
    """Count the changes of sign in a sequence; zeros are left out."""
    signs = [number > 0 for number in numbers if number]
    return sum(one != other for one, other in pairwise(signs))


Vector = Sequence[Any]
Matrix = Sequence[Vector]


def dot(p: Vector, q: Vector) -> Any:  # noqa: ANN401 - a number of the vectors' kind
    """Return the scalar product p·q."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p: Vector, q: Vector) -> list[Any]:
    """Return the vector product p × q."""
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def times(matrix: Matrix, vector: Vector) -> list[Any]:
    """Return the product of a matrix and a vector."""
    return [dot(row, vector) for row in matrix]


def adjugate(matrix: Matrix) -> list[list[Any]]:
    """Return the adjugate of a symmetric matrix."""
    first, second, third = matrix
    return [cross(second, third), cross(third, first), cross(first, second)]


def precisions(start: int = 1) -> Iterator[int]:
    """Yield numbers of bits from `start` on, each twice the previous one, without end."""
    return (start << doubling for doubling in count())


def root_of(value: Fraction, bits: int, *, upward: bool = False) -> Fraction:
    """Return √value, exact if it is rational, else to about `bits` bits, rounded down, or up with `upward`."""
    root = Fraction(math.isqrt(value.numerator), math.isqrt(value.denominator))
    if root * root == value:
        return root
    shift = bits + max(0, value.denominator.bit_length() - value.numerator.bit_length()) // 2 + 1
    scaled = value.numerator * (1 << 2 * shift) // value.denominator
    return Fraction(math.isqrt(scaled) + (1 if upward else 0), 1 << shift)


def floor_root(square: Fraction, bits: int) -> Fraction:
    """Return √square rounded down to about `bits` bits."""
    shift = max(0, bits + (square.denominator.bit_length() - square.numerator.bit_length()) // 2 + 1)
    return Fraction(math.isqrt((square.numerator << 2 * shift) // square.denominator), 1 << shift)


def exponent_of(value: Fraction) -> int:
    """Return an e with 2^(e−1) < value < 2^(e+1), of a value > 0."""
    return value.numerator.bit_length() - value.denominator.bit_length()


def power_of_two(exponent: int) -> Fraction:
    """Return 2^exponent, in a tenth of the time of a power of fractions."""
    return Fraction(1 << exponent) if exponent >= 0 else Fraction(1, 1 << -exponent)


def power_near(low: Fraction, high: Fraction) -> Fraction:
    """Return a power of two strictly between low and high > 4 low, about midway between their exponents."""
    # 2^(e−1) < value < 2^(e+1) for the exponent e of a value: e(low) + 1 ≤ k ≤ e(high) − 1 is strictly between.
    first, last = exponent_of(low) + 1, exponent_of(high) - 1
    return power_of_two((first + last) // 2)


def last(holds: Callable[[int], bool], low: int, high: int) -> int:
    """Find by bisection the last number from low to high − 1 for which `holds`; it holds for low, and not for high."""
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


def octave(reached: Callable[[Fraction], bool], step: int = 1) -> int:
    """Find the exponent k < 0 for which `reached` is true of 2^(k + 1) and false of 2^k.

    It must be true of 1, and of all numbers above one of which it is true.

    The search begins at −10, in steps that double; the first is `step`.
    """
    low = -10
    while reached(power_of_two(low)):
        low -= step
        step *= 2
    high = min(low + step, 0)
    while high < 0 and not reached(power_of_two(high)):
        low, high, step = high, min(high + 2 * step, 0), 2 * step
    return last(lambda exponent: not reached(power_of_two(exponent)), low, high)


def shortened(top: int, bottom: int, bits: int) -> Fraction:
    """Return top/bottom, bottom > 0, rounded down to about `bits` significant bits."""
    shift = bits + bottom.bit_length() - abs(top).bit_length()
    whole = (top << shift) // bottom if shift >= 0 else top // (bottom << -shift)
    return Fraction(whole, 1 << shift) if shift >= 0 else Fraction(whole << -shift)


def rounded(value: Fraction, bits: int) -> Fraction:
    """Round `value` to the nearest number of about `bits` significant bits."""
    unit = power_of_two(exponent_of(value) - bits)
    return Fraction(round(value / unit)) * unit


def rounded_toward(number: Fraction, infinity: float) -> float:
    """Round a number to float64 towards `infinity`, which is inf or −inf; the result may be infinite."""
    try:
        near = float(number)
    except OverflowError:
        near = math.inf if number > 0 else -math.inf
    wrong_side = near > number if infinity < 0 else near < number
    return math.nextafter(near, infinity) if wrong_side else near


def fraction(number: mpf) -> Fraction:
    """Return the exact value of a number of mpmath, whose mantissa is stored without its sign."""
    size = Fraction(int(number.man)) * power_of_two(int(number.exp))
    return -size if number < 0 else size


@total_ordering
@dataclass(frozen=True, slots=True, eq=False)
class QuadraticSurd:
    """The number p + q√h: p and q rational, q ≠ 0, and h > 0 rational and not the square of a rational.

    It is therefore irrational, never zero, and equal to another exactly when p and q are. `surd` makes one. Where p, q
    and h are integers, sums and products consist of integers again, which is faster.
    """

    p: Fraction
    q: Fraction
    h: Fraction

    def __add__(self, other: object) -> Fraction | QuadraticSurd:
        parts = self._parts(other)
        return NotImplemented if parts is None else surd(self.p + parts[0], self.q + parts[1], self.h)

    def __mul__(self, other: object) -> Fraction | QuadraticSurd:
        parts = self._parts(other)
        if parts is None:
            return NotImplemented
        p, q = parts
        return surd(self.p * p + self.q * q * self.h, self.p * q + self.q * p, self.h)

    __radd__ = __add__
    __rmul__ = __mul__

    def __neg__(self) -> QuadraticSurd:
        return QuadraticSurd(-self.p, -self.q, self.h)

    def __abs__(self) -> QuadraticSurd:
        return self if self.sign > 0 else -self

    def __sub__(self, other: object) -> Fraction | QuadraticSurd:
        parts = self._parts(other)
        return NotImplemented if parts is None else surd(self.p - parts[0], self.q - parts[1], self.h)

    def __rsub__(self, other: object) -> Fraction | QuadraticSurd:
        return -self + other

    def __truediv__(self, other: object) -> Fraction | QuadraticSurd:
        if isinstance(other, QuadraticSurd):
            return self * other.reciprocal
        return self * (1 / Fraction(other)) if isinstance(other, (int, Fraction)) else NotImplemented

    def __rtruediv__(self, other: Fraction | int) -> Fraction | QuadraticSurd:
        return self.reciprocal * other

    def conjugate(self) -> QuadraticSurd:
        """Return p − q√h."""
        return QuadraticSurd(self.p, -self.q, self.h)

    @property
    def reciprocal(self) -> Fraction | QuadraticSurd:
        """The reciprocal, by the conjugate: p² − q²h is not zero, since h is not a square."""
        norm = self.p**2 - self.q**2 * self.h
        return QuadraticSurd(Fraction(self.p, norm), Fraction(-self.q, norm), self.h)

    @property
    def sign(self) -> int:
        """+1 or −1: the sign of the larger of |p| and |q|√h, found from their squares."""
        larger = self.p if self.p**2 > self.q**2 * self.h else self.q
        return 1 if larger > 0 else -1

    def __lt__(self, other: object) -> bool:
        sign = self._compare(other)
        return NotImplemented if sign is None else sign < 0

    def __eq__(self, other: object) -> bool:
        sign = self._compare(other)
        return NotImplemented if sign is None else sign == 0

    def __hash__(self) -> int:
        return hash((self.p, self.q, self.h))

    def _compare(self, other: object) -> int | None:
        """Return the sign of self − other, or None if `other` is of another type."""
        difference = self.__sub__(other)
        if difference is NotImplemented:
            return None
        return difference.sign if isinstance(difference, QuadraticSurd) else sign_of(difference)

    def _parts(self, other: object) -> tuple[Any, Any] | None:
        """Return p and q of a number of this field, or None for another type. Raises ValueError for another field."""
        if isinstance(other, QuadraticSurd):
            if other.h != self.h:
                raise ValueError(f"√{self.h} and √{other.h} do not lie in one quadratic field")
            return other.p, other.q
        if isinstance(other, (int, Fraction)):
            return other, 0
        return None


def surd(p: Fraction, q: Fraction, h: Fraction) -> Fraction | QuadraticSurd:
    """Return p + q√h, as a Fraction if q is 0; `h` must not be the square of a rational."""
    return QuadraticSurd(p, q, h) if q else p


def exact_root(square: Fraction) -> Fraction | QuadraticSurd:
    """Return √square, square ≥ 0, exactly."""
    root = Fraction(math.isqrt(square.numerator), math.isqrt(square.denominator))
    return root if root * root == square else QuadraticSurd(Fraction(0), Fraction(1), square)
