"""Double-double arithmetic on numpy arrays: each number is an unevaluated sum high + low with |low| ≤ u·|high|.

u = 2⁻⁵³. Every operation below is within 16u² = 2⁻¹⁰² of the exact result, relative to the result itself, or for sums
relative to |first| + |second|, as long as nothing overflows and only a negligible part underflows. The count of
roundings stands at each operation, in units of u² and to first order; 16 leaves room for the higher orders.

The error-free transformations are those of Knuth (sum) and Dekker (product; numpy has no fused multiply-add).
numpy evaluates one operation at a time in float64, so no compiler can contract or reorder what is written here.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.rows import Floats, Mask

DoubleDouble = tuple[Floats, Floats]

ERROR = 2.0**-102
"""The relative error bound of one operation: 16u²."""

_SPLITTER = 134217729.0  # 2²⁷ + 1: cuts 53 bits into 26 and 26 with a sign


def two_product(first: Floats, second: Floats) -> DoubleDouble:
    """Return the rounded product and its exact rounding error, for |operands| < 2⁹⁹⁶ and a product 0 or > 2⁻⁹⁶⁸."""
    product = first * second
    first_high, first_low = _split(first)
    second_high, second_low = _split(second)
    error = first_high * second_high - product
    error += first_high * second_low
    error += first_low * second_high
    error += first_low * second_low
    return product, error


def two_square(value: Floats) -> DoubleDouble:
    """Return the rounded square and its rounding error; the range is that of two_product."""
    square = value * value
    high, low = _split(value)
    error = high * high - square
    error += 2.0 * (high * low)
    error += low * low
    return square, error


def add(first: DoubleDouble, second: DoubleDouble) -> DoubleDouble:
    """Return the sum. Roundings: 1 in low + low, 2 in adding high + high's error; relative to |first| + |second|."""
    total, error = two_sum(first[0], second[0])
    return two_sum(total, error + (first[1] + second[1]))


def subtract(first: DoubleDouble, second: DoubleDouble) -> DoubleDouble:
    """Return the difference; roundings as in add."""
    return add(first, (-second[0], -second[1]))


def add_float(first: DoubleDouble, second: Floats | float) -> DoubleDouble:
    """Return the sum with a float64; roundings as in add."""
    total, error = two_sum(first[0], second)
    return two_sum(total, error + first[1])


def sum_of(numbers: Sequence[DoubleDouble]) -> DoubleDouble:
    """Return the sum of one or more numbers, added in order; roundings as in add."""
    total, *others = numbers
    for number in others:
        total = add(total, number)
    return total


def multiply(first: DoubleDouble, second: DoubleDouble) -> DoubleDouble:
    """Return the product. Roundings: low × low left out 1, two cross products 2, their sum 2, adding the error 3."""
    product, error = two_product(first[0], second[0])
    return two_sum(product, error + (first[0] * second[1] + first[1] * second[0]))


def square(value: DoubleDouble) -> DoubleDouble:
    """Return the square; roundings as in multiply."""
    product, error = two_square(value[0])
    return two_sum(product, error + 2.0 * (value[0] * value[1]))


def divide(first: DoubleDouble, second: DoubleDouble) -> DoubleDouble:
    """Return the quotient.

    With q the quotient of the high parts, high − q·high is exact. Roundings: q·low 1, low − that 2, the whole remainder
    3, its division by the high part alone 3, the rounding of that 3.
    """
    quotient = first[0] / second[0]
    product, error = two_product(quotient, second[0])
    remainder = ((first[0] - product) - error) + (first[1] - quotient * second[1])
    return two_sum(quotient, remainder / second[0])


def quotient_of_floats(first: Floats, second: Floats) -> DoubleDouble:
    """Return the quotient of two float64: the remainder is exact, its division 1."""
    quotient = first / second
    product, error = two_product(quotient, second)
    return two_sum(quotient, ((first - product) - error) / second)


def square_root(value: DoubleDouble) -> DoubleDouble:
    """Return the square root of a value ≥ 0.

    With s the root of the high part, high − s² is exact. Roundings: the remainder 3, halved by its division by 2s,
    which adds 2; the Newton step itself leaves out remainder²/(8s³), 2.
    """
    root = np.sqrt(value[0])
    product, error = two_square(root)
    remainder = ((value[0] - product) - error) + value[1]
    return two_sum(root, remainder / np.where(root > 0.0, 2.0 * root, 1.0))


def rounds_to_high(value: DoubleDouble, error: Floats) -> Mask:
    """Decide whether every number that is off the value by `error` at most rounds to the value's high part."""
    high, low = value
    reach = 1.001 * error + 2.0**-104 * np.abs(high)  # 2⁻¹⁰⁴ for the rounding of low ± reach
    return np.asarray((high + (low + reach) == high) & (high + (low - reach) == high))


def where(condition: Mask, first: DoubleDouble, second: DoubleDouble) -> DoubleDouble:
    """Return `first` where the condition is true, else `second`."""
    return np.where(condition, first[0], second[0]), np.where(condition, first[1], second[1])


def _split(value: Floats) -> DoubleDouble:
    """Split a value into halves of at most 26 bits, value = high + low, for |value| < 2⁹⁹⁶."""
    scaled = _SPLITTER * value
    high = scaled - (scaled - value)
    return high, value - high
