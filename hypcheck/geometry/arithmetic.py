"""Plain arithmetic that belongs to no oracle and to no kernel: signs, rounding to one side, vectors of three numbers.

Numbers of vectors and of 3×3 matrices are integers, rationals, intervals or arrays.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any


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


def rounded_toward(number: Fraction, infinity: float) -> float:
    """The nearest float64 that is not beyond the number on the side away from `infinity`; ±inf is one."""
    try:
        near = float(number)
    except OverflowError:
        near = math.inf if number > 0 else -math.inf
    wrong_side = near > number if infinity < 0 else near < number
    return math.nextafter(near, infinity) if wrong_side else near


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
