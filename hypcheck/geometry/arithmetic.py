"""Plain arithmetic that belongs to no oracle and to no kernel.

First signs, then vectors of three numbers and 3×3 matrices, of integers, rationals, intervals or arrays; then rational
numbers: roots, powers of two, few bits, and bisection.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import count, pairwise
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mpmath import mpf


def sign_of(number: Fraction | int) -> int:
    """The sign: 1, 0 or −1."""
    return (number > 0) - (number < 0)


def sign_with_root(u: Fraction | int, v: Fraction | int, w: Fraction | int) -> int:
    """The sign of u + v √w, w > 0 or v = 0."""
    if u >= 0 and v >= 0:
        return int(u > 0 or v > 0)
    if u <= 0 and v <= 0:
        return -1
    return sign_of(u * u - v * v * w) * (1 if u > 0 else -1)


def changes_of_sign(numbers: Iterable[int]) -> int:
    """The number of changes of sign in a sequence, without zeros."""
    signs = [number > 0 for number in numbers if number]
    return sum(one != other for one, other in pairwise(signs))


Vector = Sequence[Any]
Matrix = Sequence[Vector]


def dot(p: Vector, q: Vector) -> Any:  # noqa: ANN401 - a number of the vectors' kind
    """p·q."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p: Vector, q: Vector) -> list[Any]:
    """p × q."""
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def times(matrix: Matrix, vector: Vector) -> list[Any]:
    """The product of a matrix and a vector."""
    return [dot(row, vector) for row in matrix]


def adjugate(matrix: Matrix) -> list[list[Any]]:
    """The adjugate of a symmetric matrix."""
    first, second, third = matrix
    return [cross(second, third), cross(third, first), cross(first, second)]


def precisions(start: int = 1) -> Iterator[int]:
    """Numbers of bits, each twice the previous one, without end."""
    return (start << doubling for doubling in count())


def root_of(value: Fraction, bits: int, *, upward: bool = False) -> Fraction:
    """√value, exact if it is rational, else to about `bits` bits; with `upward` never less than the root."""
    root = Fraction(math.isqrt(value.numerator), math.isqrt(value.denominator))
    if root * root == value:
        return root
    shift = bits + max(0, value.denominator.bit_length() - value.numerator.bit_length()) // 2 + 1
    scaled = value.numerator * (1 << 2 * shift) // value.denominator
    return Fraction(math.isqrt(scaled) + (1 if upward else 0), 1 << shift)


def floor_root(square: Fraction, bits: int) -> Fraction:
    """√square rounded down to about `bits` bits."""
    shift = max(0, bits + (square.denominator.bit_length() - square.numerator.bit_length()) // 2 + 1)
    return Fraction(math.isqrt((square.numerator << 2 * shift) // square.denominator), 1 << shift)


def exponent_of(value: Fraction) -> int:
    """An e with 2^(e−1) < value < 2^(e+1), of a value > 0."""
    return value.numerator.bit_length() - value.denominator.bit_length()


def power_of_two(exponent: int) -> Fraction:
    """2^exponent, in a tenth of the time of a power of fractions."""
    return Fraction(1 << exponent) if exponent >= 0 else Fraction(1, 1 << -exponent)


def power_near(low: Fraction, high: Fraction) -> Fraction:
    """A power of two about midway between two exponents, strictly between low and high > 4 low."""
    # 2^(e−1) < value < 2^(e+1) for the exponent e of a value: e(low) + 1 ≤ k ≤ e(high) − 1 is strictly between.
    first, last = exponent_of(low) + 1, exponent_of(high) - 1
    return power_of_two((first + last) // 2)


def last(holds: Callable[[int], bool], low: int, high: int) -> int:
    """The last number from low to high − 1 for which `holds`, by bisection; it holds for low, and not for high."""
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


def octave(reached: Callable[[Fraction], bool], step: int = 1) -> int:
    """The exponent k < 0 with 2^(k + 1) reached and 2^k not; 1 is reached, and so are all numbers above such a one.

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
    """top/bottom, bottom > 0, cut off after about `bits` significant bits."""
    shift = bits + bottom.bit_length() - abs(top).bit_length()
    whole = (top << shift) // bottom if shift >= 0 else top // (bottom << -shift)
    return Fraction(whole, 1 << shift) if shift >= 0 else Fraction(whole << -shift)


def rounded(value: Fraction, bits: int) -> Fraction:
    """`value` to `bits` significant bits."""
    unit = power_of_two(exponent_of(value) - bits)
    return Fraction(round(value / unit)) * unit


def rounded_toward(number: Fraction, infinity: float) -> float:
    """The nearest float64 that is not beyond the number on the side away from `infinity`; ±inf is one."""
    try:
        near = float(number)
    except OverflowError:
        near = math.inf if number > 0 else -math.inf
    wrong_side = near > number if infinity < 0 else near < number
    return math.nextafter(near, infinity) if wrong_side else near


def fraction(number: mpf) -> Fraction:
    """The exact value of a number of mpmath, whose mantissa is stored without its sign."""
    size = Fraction(int(number.man)) * power_of_two(int(number.exp))
    return -size if number < 0 else size
