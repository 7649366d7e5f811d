"""Other ways to decide: the dual form, the roots of g, and a sphere or a cylinder about the spheroid.

The dual form searches the best λ without cancellation, and takes the sign of φ there. φ(λ) + 1 is a lower bound of the
squared distance for every λ between the poles, so an answer "clear" is as good as the evaluation of φ; the search
matters only for false contacts (docs/mathematics.md, "The dual form").

The roots of g decide as follows, for all sizes (docs/mathematics.md, "Root patterns and relative position"). There are
three real roots, and the two lower ones lie together in one of (−∞, −A], [−A, 0), (0, B] and [B, ∞): exterior if that
is (0, B], interior if it is [−A, 0). Their mean lies in the same interval, and is never B or −A, which one of them is
for every centre in the plane of the waist or on the axis. A double root does not count as two, so the ring, where B is
a double root, reads as contact. The roots come from the closed form for three real roots (an arc cosine and two cosines
if Δ > 0, which section 3.1 of the paper attributes to its reference [13]), from numpy.roots (eigenvalues of the
companion matrix, one call for each row), and from mpmath.polyroots at a given number of digits; without convergence the
answer is "cannot say".

The sphere and the cylinder are circumscribed, so "clear" is right (for the cylinder except for rounding), and contact
often is not. The sphere has the radius max(b, d), the cylinder the radius b, the half height d and an axis parallel to
that of the hyperboloid.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.evaluation import Evaluator, outputs
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.program import cut
from hypcheck.geometry.pair import COLUMNS, SIZES, Sizes
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Mask, Rows
from hypcheck.implementations.method import Answers, ByRows, ByScene, in_chunks
from hypcheck.kernel import numpy_kernel

AnyFloats = NDArray[Any]


DISTANCES = ("lambda_", "A_plus_lambda", "B_minus_lambda")
"""The distances that the search gives to the formula, by the formula's names."""

_PHI = cut(FORMULAS["dual"].program, DISTANCES, ("phi",))
"""The dual form from the distances of λ to 0, −A and B, which the search knows more accurately than λ itself."""


def dual_positions(rows: Rows, precision: str) -> Answers:
    """Positions by the dual form, with all computation including the search in one float format; int8 (n,)."""
    return in_chunks(len(rows), lambda part: _dual_sides(dict(zip(COLUMNS, rows[part].T, strict=True)), precision))


def dual_by_scene(precision: str, sizes: Sizes, x: AnyFloats, y: AnyFloats, z: AnyFloats) -> Answers:
    """Positions by the dual form for many centres and one α, γ, b, d."""
    fixed = dict(zip(SIZES, sizes, strict=True))
    return in_chunks(len(x), lambda part: _dual_sides({**fixed, "x": x[part], "y": y[part], "z": z[part]}, precision))


def searched(rows: Rows, precision: str) -> dict[str, AnyFloats]:
    """The columns in a float format, and the distances of the best λ that is found in it: (n,) each."""
    return _searched(dict(zip(COLUMNS, rows.T, strict=True)), precision)


def _searched(columns: Mapping[str, AnyFloats | float], precision: str) -> dict[str, AnyFloats]:
    with np.errstate(all="ignore"):
        rounded = {name: np.asarray(columns[name], dtype=precision) for name in COLUMNS}
        return {**rounded, **dict(zip(DISTANCES, _best_multiplier(**rounded), strict=True))}


def _dual_sides(columns: Mapping[str, AnyFloats | float], precision: str) -> Answers:
    found = _searched(columns, precision)
    (phi,) = outputs(_PHI, float_arithmetic(precision), found, ("phi",))
    return np.where(phi > 0, np.sign(found["lambda_"]), 0).astype(np.int8)


def _best_multiplier(
    alpha: AnyFloats, gamma: AnyFloats, b: AnyFloats, d: AnyFloats, x: AnyFloats, y: AnyFloats, z: AnyFloats
) -> tuple[AnyFloats, AnyFloats, AnyFloats]:
    """Approximately the λ at which φ is largest, for each row, with A + λ and B − λ.

    F = φ' = (a r/(A+λ))² − (c z/(B−λ))² − 1 decreases from one pole to the other. The side of the centre is the sign of
    F(0), and shows on which side of 0 the root lies; the sign half way shows whether the root is nearer to 0 or to the
    pole. The distance to that end is found by bisection, first of its exponent. The two other distances are sums of it,
    so that nothing cancels.
    """
    one, two = alpha.dtype.type(1), alpha.dtype.type(2)
    a, c = alpha / b, gamma / d
    r, z = np.hypot(x / b, y / b), np.abs(z / d)
    A, B, ar, cz = a * a, c * c, a * r, c * z

    def falls(to_a: AnyFloats, to_b: AnyFloats) -> Mask:
        left, right = ar / to_a, cz / to_b
        return np.asarray(left * left <= right * right + one, dtype=np.bool_)

    inside = falls(A, B)
    pole, other = np.where(inside, A, B), np.where(inside, B, A)
    half = pole / two

    def to_poles(distance: AnyFloats, from_zero: Mask) -> tuple[AnyFloats, AnyFloats]:
        """A + λ and B − λ of the point at this distance from 0, or from the pole."""
        to_pole = np.where(from_zero, pole - distance, distance)
        to_other = other + np.where(from_zero, distance, pole - distance)
        return np.where(inside, to_pole, to_other), np.where(inside, to_other, to_pole)

    def past_root(distance: AnyFloats, from_zero: Mask) -> Mask:
        """Whether the root lies beyond the point at this distance from 0 or from the pole, seen from 0."""
        return falls(*to_poles(distance, from_zero)) ^ inside

    near_zero = past_root(half, np.ones(half.shape, dtype=bool))
    low, high = half * np.finfo(half.dtype).tiny, half
    for step in range(np.finfo(half.dtype).nmant + 14):
        middle = np.sqrt(low) * np.sqrt(high) if step < 10 else (low + high) / two
        move_low = past_root(middle, near_zero) ^ near_zero
        low, high = np.where(move_low, middle, low), np.where(move_low, high, middle)
    size = np.where(near_zero, high, pole - high)
    return (np.where(inside, -size, size), *to_poles(high, near_zero))


_CUBIC = ("A", "B", "c0", "c1", "c2", "delta")
_LISTED = FORMULAS["table-2"].program
"""All three methods use the coefficients of Table 2, so that only the roots differ."""

_STEPS, _EXTRA_BITS = 200, 200
"""With polyroots' default of 50 steps and 10 bits most cubics of the tower do not converge; its error asks for more."""

_COEFFICIENTS = Evaluator(_LISTED, float_arithmetic("float64"), _CUBIC[:-1])


def trigonometric_roots(format_name: str) -> ByRows:
    """A function from rows to positions by the trigonometric form, with all computation in one float format."""
    ready = Evaluator(_LISTED, float_arithmetic(format_name), _CUBIC)

    def answers(rows: Rows) -> Answers:
        return in_chunks(len(rows), lambda part: _root_sides(*ready(dict(zip(COLUMNS, rows[part].T, strict=True)))))

    return answers


def trigonometric_roots_by_scene(format_name: str) -> ByScene:
    """Positions by the trigonometric form for many centres and one α, γ, b, d."""
    ready = Evaluator(_LISTED, float_arithmetic(format_name), _CUBIC)

    def answers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
        fixed = dict(zip(SIZES, sizes, strict=True))
        return in_chunks(len(x), lambda part: _root_sides(*ready({**fixed, "x": x[part], "y": y[part], "z": z[part]})))

    return answers


def _root_sides(A: Any, B: Any, c0: Any, c1: Any, c2: Any, delta: NDArray[Any]) -> NDArray[np.int8]:  # noqa: ANN401
    number = delta.dtype.type
    with np.errstate(all="ignore"):
        third = c2 / number(3)
        square = third * third - c1 / number(3)
        size = np.sqrt(square)
        angle = np.arccos(np.clip((third * (third * third - c1 / number(2)) + c0 / number(2)) / (square * size), -1, 1))
        turn = number(2 * np.pi)
        lowest = number(-2) * size * np.cos(angle / number(3)) - third
        middle = number(-2) * size * np.cos((angle - turn) / number(3)) - third
        mean = (lowest + middle) / number(2)
        exterior = (delta > 0) & (lowest > 0) & (mean < B)
        interior = (delta > 0) & (middle < 0) & (mean > -A)
    return np.asarray(exterior.astype(np.int8) - interior.astype(np.int8))


def numpy_roots(rows: Rows) -> Answers:
    """Positions (n,) by numpy.roots; a root is real if its imaginary part is 0."""
    A, B, c0, c1, c2 = _COEFFICIENTS(dict(zip(COLUMNS, rows.T, strict=True)))
    found = np.zeros(len(rows), dtype=np.int8)
    for place, coefficients in enumerate(np.column_stack([np.ones(len(rows)), c2, c1, c0])):
        if not np.isfinite(coefficients).all():
            found[place] = CANNOT_SAY
            continue
        values = np.roots(coefficients)
        if len(values) == 3 and (not np.iscomplexobj(values) or not values.imag.any()):
            lowest, middle, _ = np.sort(values.real)
            found[place] = _side(lowest, middle, A[place], B[place])
    return found


def mpmath_roots(rows: Rows, digits: int) -> Answers:
    """Positions (n,) by mpmath.polyroots; a root is real if polyroots says so."""
    return np.array([_mpmath_position(row, digits) for row in rows.tolist()], dtype=np.int8)


def _mpmath_position(row: list[float], digits: int) -> int:
    import mpmath  # noqa: PLC0415 - where it is not asked for, it is not loaded

    with mpmath.workdps(digits):
        alpha, gamma, b, d, x, y, z = map(mpmath.mpf, row)
        A, B = (alpha / b) ** 2, (gamma / d) ** 2
        P, Q = (x**2 + y**2) / b**2, (z / d) ** 2
        c0 = -A * B
        c1, c2 = c0 + A - B + B * P - A * Q, A - B + 1 - P - Q
        try:
            values = mpmath.polyroots([1, c2, c1, c0], maxsteps=_STEPS, extraprec=_EXTRA_BITS)
        except mpmath.mp.NoConvergence:
            return CANNOT_SAY
        if not all(mpmath.im(value) == 0 for value in values):
            return 0
        lowest, middle, _ = sorted(map(mpmath.re, values))
        return _side(lowest, middle, A, B)


def _side(lowest: Any, middle: Any, A: Any, B: Any) -> int:  # noqa: ANN401 - of any arithmetic
    mean = (lowest + middle) / 2
    if lowest == middle:
        return 0
    if lowest > 0 and mean < B:
        return 1
    return -1 if middle < 0 and mean > -A else 0


def bounding_sphere(rows: Rows) -> Answers:
    """Positions (n,) of the sphere, exact, so that all errors about the spheroid are due to the shape."""
    spheres = rows.copy()
    spheres[:, 2:4] = np.maximum(rows[:, 2], rows[:, 3])[:, np.newaxis]
    return numpy_kernel.positions(spheres)


def bounding_sphere_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
    """Positions of the sphere for many centres and one α, γ, b, d."""
    alpha, gamma, b, d = sizes
    return numpy_kernel.positions_of_scene((alpha, gamma, max(b, d), max(b, d)), x, y, z)


def bounding_cylinder(rows: Rows) -> Answers:
    """Positions (n,) of the cylinder in plain floats."""
    alpha, gamma, b, d, x, y, z = rows.T
    return _cylinder(alpha, gamma, b, d, x, y, z)


def bounding_cylinder_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
    """Positions of the cylinder for many centres and one α, γ, b, d."""
    return _cylinder(*sizes, x, y, z)


def _cylinder(
    alpha: Floats | float,
    gamma: Floats | float,
    b: Floats | float,
    d: Floats | float,
    x: Floats,
    y: Floats,
    z: Floats,
) -> Answers:
    # The hyperboloid's radius grows with |z|, so it is widest at the cylinder's farther end, and narrowest at its
    # nearer end or, if that lies between the two, in the plane of the waist.
    r, height = np.hypot(x, y), np.abs(z)
    widest = alpha * np.hypot(1.0, (height + d) / gamma)
    narrowest = alpha * np.hypot(1.0, np.maximum(height - d, 0.0) / gamma)
    return (r - b > widest).astype(np.int8) - (r + b < narrowest).astype(np.int8)
