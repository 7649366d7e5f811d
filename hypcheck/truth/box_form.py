"""The two surfaces over boxes of changes: what a change is to achieve, and the formulas of its proofs.

The formulas are in numbers of any kind with + − · / and a square root: intervals of mpmath (box_certificate.py) and of
float64 (float_boxes.py), and plain numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from hypcheck.geometry.pair import Position
from hypcheck.truth.vectors import adjugate, cross, dot

Signs = tuple[int, ...]
Number = Any
"""A number of one kind."""

Vector = list[Any]
"""Three numbers of one kind."""


@dataclass(frozen=True, slots=True)
class Goal:
    """What a change is to achieve: the row's position becomes `side`, or, with `leave`, is no longer `side`."""

    side: Position
    leave: bool

    @property
    def sign(self) -> int:
        """Whether φ on that side has to grow (+1) or to fall (−1)."""
        return -1 if self.leave else 1

    @property
    def sizes(self) -> Signs:
        """Which way α, γ, b, d help: up or down."""
        wide, tall = (-1, 1) if self.side is Position.EXTERIOR else (1, -1)
        return tuple(self.sign * part for part in (wide, tall, -1, -1))


class Form:
    """The two surfaces for fixed sizes, in numbers of one kind, such as intervals; centre C and axis v are given later.

    Intervals prove (box_certificate.py, float_boxes.py); plain numbers point the way. `root` is the square root of a
    number of that kind.

    Σ = M⁻¹ = b² I + (d² − b²) v vᵀ/(v·v) stands for M wherever it can: its entries change with the axis as much as the
    spheroid does, those of M much more where the spheroid is thin.
    """

    def __init__(self, sizes: Vector, root: Callable[[Any], Any]) -> None:
        alpha, gamma, b, d = sizes
        self.root = root
        self.D = [1 / alpha**2, 1 / alpha**2, -1 / gamma**2]
        self.b2, self.d2 = b**2, d**2

    def hyperboloid(self, X: Vector) -> Number:
        """h."""
        return self.D[0] * X[0] ** 2 + self.D[1] * X[1] ** 2 + self.D[2] * X[2] ** 2 - 1

    def gradient(self, X: Vector) -> Vector:
        """Half the gradient of h, D X."""
        return [a * b for a, b in zip(self.D, X, strict=True)]

    def sigma(self, v: Vector) -> list[Vector]:
        """Σ."""
        factor = (self.d2 - self.b2) / dot(v, v)
        return [[(i == j) * self.b2 + factor * v[i] * v[j] for j in range(3)] for i in range(3)]

    def sigma_times(self, v: Vector, q: Vector) -> Vector:
        """Σ q, from the parts of q along v and across."""
        along = self.d2 * dot(v, q) / dot(v, v)
        return [self.b2 * p + along * part for p, part in zip(across(v, q), v, strict=True)]

    def width(self, v: Vector, q: Vector) -> Number:
        """√(qᵀ Σ q): how far the spheroid reaches along q, times |q|."""
        aside = cross(v, q)
        return self.root((self.b2 * squares(aside) + self.d2 * dot(v, q) ** 2) / squares(v))

    def by_axis(self, v: Vector, q: Vector, n: Vector) -> Vector:
        """The derivatives of nᵀ Σ q by the axis."""
        square = dot(v, v)
        q_part, n_part = (self.d2 - self.b2) * dot(v, n) / square, (self.d2 - self.b2) * dot(v, q) / square
        return [q_part * a + n_part * b for a, b in zip(across(v, q), across(v, n), strict=True)]

    def pencil(self, at: Number, v: Vector) -> tuple[list[Vector], list[Vector], Vector]:
        """M, the adjugate of M + λD, and its leading minors, the determinant last."""
        square = dot(v, v)
        excess = (1 / self.d2 - 1 / self.b2) / square
        M = [[(i == j) / self.b2 + excess * v[i] * v[j] for j in range(3)] for i in range(3)]
        G = [[M[i][j] + (i == j) * at * self.D[i] for j in range(3)] for i in range(3)]
        adjoint = adjugate(G)
        return M, adjoint, [G[0][0], adjoint[2][2], dot(G[0], adjoint[0])]

    def nearest(self, at: Number, C: Vector, v: Vector) -> tuple[Vector, list[Vector]] | None:
        """X with (1 + λ Σ D) X = C and the matrix's inverse; None where M + λD is not shown to be positive definite."""
        M, adjoint, minors = self.pencil(at, v)
        if not all(part > 0 for part in minors):  # of an interval: each of its numbers
            return None
        inverse = [[dot(row, column) / minors[2] for column in M] for row in adjoint]
        return [dot(row, C) for row in inverse], inverse


def squares(p: Vector) -> Number:
    """p·p, not below 0."""
    return p[0] ** 2 + p[1] ** 2 + p[2] ** 2


def across(v: Vector, q: Vector) -> Vector:
    """The part of q across v, (v × q) × v/(v·v)."""
    square = squares(v)
    return [part / square for part in cross(cross(v, q), v)]
