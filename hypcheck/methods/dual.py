"""The dual form as a method: the best λ by a search that cannot cancel, then the sign of φ there.

φ(λ) + 1 is a lower bound of the squared distance for every λ between the poles, so a claim of clear is as good as the
evaluation of φ; how λ was found matters for false contacts alone (docs/mathematics.md, "The dual form").
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.evaluation import outputs
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.program import cut
from hypcheck.methods.formula import Sizes, in_chunks
from hypcheck.methods.method import Answers
from hypcheck.pairs import COLUMNS, SIZES
from hypcheck.rows import Rows

Floats = NDArray[Any]
Mask = NDArray[np.bool_]


DISTANCES = ("lambda_", "A_plus_lambda", "B_minus_lambda")
"""What the search hands to the formula, by the formula's own names."""

_PHI = cut(FORMULAS["dual"].program, DISTANCES, ("phi",))
"""The dual form from the distances of λ to 0, −A and B on, which the search knows better than λ itself tells them."""


def dual_positions(rows: Rows, precision: str) -> Answers:
    """Positions by the dual form with everything, the search included, in one float format; int8 (n,)."""
    return in_chunks(len(rows), lambda part: _sides(dict(zip(COLUMNS, rows[part].T, strict=True)), precision))


def dual_by_scene(precision: str, sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
    """The same for many centres and one α, γ, b, d."""
    fixed = dict(zip(SIZES, sizes, strict=True))
    return in_chunks(len(x), lambda part: _sides({**fixed, "x": x[part], "y": y[part], "z": z[part]}, precision))


def searched(rows: Rows, precision: str) -> dict[str, Floats]:
    """The columns in a float format, and the distances of the best λ that is found in it: (n,) each."""
    return _searched(dict(zip(COLUMNS, rows.T, strict=True)), precision)


def _searched(columns: Mapping[str, Floats | float], precision: str) -> dict[str, Floats]:
    with np.errstate(all="ignore"):
        rounded = {name: np.asarray(columns[name], dtype=precision) for name in COLUMNS}
        return {**rounded, **dict(zip(DISTANCES, _best_multiplier(**rounded), strict=True))}


def _sides(columns: Mapping[str, Floats | float], precision: str) -> Answers:
    found = _searched(columns, precision)
    (phi,) = outputs(_PHI, float_arithmetic(precision), found, ("phi",))
    return np.where(phi > 0, np.sign(found["lambda_"]), 0).astype(np.int8)


def _best_multiplier(
    alpha: Floats, gamma: Floats, b: Floats, d: Floats, x: Floats, y: Floats, z: Floats
) -> tuple[Floats, Floats, Floats]:
    """About the λ at which φ is largest, for each row, with A + λ and B − λ.

    F = φ' = (a r/(A+λ))² − (c z/(B−λ))² − 1 falls from one pole to the other. The centre's side of the hyperboloid is
    the sign of F(0) and tells on which side of 0 the root lies; the sign half way tells whether it is nearer to 0 or
    to the pole. That distance is the unknown, found by bisection, first of its exponent, and the two other distances
    are sums of it, so that nothing cancels.
    """
    one, two = alpha.dtype.type(1), alpha.dtype.type(2)
    a, c = alpha / b, gamma / d
    r, z = np.hypot(x / b, y / b), np.abs(z / d)
    A, B, ar, cz = a * a, c * c, a * r, c * z

    def falls(to_a: Floats, to_b: Floats) -> Mask:
        left, right = ar / to_a, cz / to_b
        return np.asarray(left * left <= right * right + one, dtype=np.bool_)

    inside = falls(A, B)
    pole, other = np.where(inside, A, B), np.where(inside, B, A)
    half = pole / two

    def to_poles(distance: Floats, from_zero: Mask) -> tuple[Floats, Floats]:
        """A + λ and B − λ of the point at this distance from 0, or from the pole."""
        to_pole = np.where(from_zero, pole - distance, distance)
        to_other = other + np.where(from_zero, distance, pole - distance)
        return np.where(inside, to_pole, to_other), np.where(inside, to_other, to_pole)

    def past_root(distance: Floats, from_zero: Mask) -> Mask:
        """Whether going from 0 towards the pole, the root lies behind the point at this distance from 0 or the pole."""
        return falls(*to_poles(distance, from_zero)) ^ inside

    near_zero = past_root(half, np.ones(half.shape, dtype=bool))
    low, high = half * np.finfo(half.dtype).tiny, half
    for step in range(np.finfo(half.dtype).nmant + 14):
        middle = np.sqrt(low) * np.sqrt(high) if step < 10 else (low + high) / two
        move_low = past_root(middle, near_zero) ^ near_zero
        low, high = np.where(move_low, middle, low), np.where(move_low, high, middle)
    size = np.where(near_zero, high, pole - high)
    return (np.where(inside, -size, size), *to_poles(high, near_zero))
