"""The dual function of the nearest-point problem at rational λ, in integers: nothing here is rounded.

With T = K α² + b² L and Z = K γ² − d² L, λ = L/K lies in (−A, B) if T, Z > 0, and the dual function D and its
derivative F (docs/mathematics.md, "Nearest point and clearance") are quotients of integers over T Z. D is concave and
its supremum over (−A, B) is the squared distance from the spheroid's centre to the hyperboloid, in spheroid radii.
"""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.pairs import Pair


@dataclass(frozen=True, slots=True)
class Squares:
    """The squares of a pair's lengths: α², b², R = x² + y² in one unit, γ², d², z² in another."""

    alpha: int
    b: int
    R: int
    gamma: int
    d: int
    z: int

    @classmethod
    def of(cls, pair: Pair) -> Squares:
        """The squares, exactly, without the powers of two that all three of a group share."""
        lengths = pair.lengths
        radial = _reduced(lengths.alpha**2, lengths.b**2, lengths.x**2 + lengths.y**2)
        axial = _reduced(lengths.gamma**2, lengths.d**2, lengths.z**2)
        return cls(*radial, *axial)


@dataclass(frozen=True, slots=True)
class Dual:
    """D and F at λ = L/K: D = value/(K T Z), F = slope/(T Z)². T and Z are b² K (A + λ) and d² K (B − λ)."""

    L: int
    K: int
    T: int
    Z: int
    value: int
    slope: int


def dual(squares: Squares, L: int, K: int) -> Dual:
    """The dual function and its derivative at λ = L/K, K > 0; λ must lie in (−A, B)."""
    T = K * squares.alpha + L * squares.b
    Z = K * squares.gamma - L * squares.d
    product = T * Z
    value = L * (K * (squares.R * Z - squares.z * T) - product)
    slope = K * K * (squares.alpha * squares.R * Z * Z - squares.gamma * squares.z * T * T) - product * product
    return Dual(L, K, T, Z, value, slope)


def newton_step(squares: Squares, at: Dual) -> int:
    """The step F/|F′| of Newton's iteration from λ, in units of 1/K, rounded down."""
    curvature = squares.alpha * squares.R * squares.b * at.Z**3 + squares.gamma * squares.z * squares.d * at.T**3
    return at.slope * at.T * at.Z // (2 * at.K * at.K * curvature)


def tangency(squares: Squares) -> Dual | None:
    """The dual at its maximum if that maximum is exactly 1 and inside (−A, B): the surfaces touch. None if they do not.

    There D = 1 and F = 0, which suffices, as D is concave: that is what is tested. Such a λ is a double root of the
    cubic g of docs/mathematics.md, and no triple one, as D is strictly concave if it has a maximum inside. The double
    root of a cubic is the rational function of its coefficients that is tried here; its denominator is, up to a square,
    twice the square of the distance to the third root, hence positive.
    """
    alpha, b, R, gamma, d, z = squares.alpha, squares.b, squares.R, squares.gamma, squares.d, squares.z
    n3 = b * d
    n2 = alpha * d - gamma * b + b * d - R * d - z * b
    n1 = alpha * (d - gamma - z) + gamma * (R - b)
    n0 = -alpha * gamma
    numerator, denominator = 9 * n0 * n3 - n1 * n2, 2 * (n2 * n2 - 3 * n1 * n3)
    if denominator <= 0 or not -alpha * denominator < b * numerator or not d * numerator < gamma * denominator:
        return None
    at = dual(squares, numerator, denominator)
    return at if at.slope == 0 and at.value == at.K * at.T * at.Z else None


def _reduced(first: int, second: int, third: int) -> tuple[int, int, int]:
    """The three divided by the largest power of two that divides all."""
    union = first | second | third
    shift = (union & -union).bit_length() - 1
    return first >> shift, second >> shift, third >> shift
