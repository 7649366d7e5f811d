"""Vectors of three numbers and 3×3 matrices, of integers, rationals or intervals: no method of any oracle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

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
