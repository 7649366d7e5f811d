"""Other ways to decide: the dual form, the roots of g, a sphere or a cylinder about the spheroid, eigenvectors.

A = (α/b)² and B = (γ/d)², as in the paper; −A and B are the poles of the dual function φ(λ), and g is its cubic.

The dual form searches the best λ without cancellation, and takes the sign of φ there. φ(λ) + 1 is a lower bound of the
squared distance for every λ between the poles, so an answer "clear" is as good as the evaluation of φ; the search
matters only for false contacts (docs/mathematics.md, "The dual form").

The roots of g decide as follows, for all sizes (docs/mathematics.md, "Root patterns and relative position"). There are
three real roots, and the two lower ones lie together in one of (−∞, −A], [−A, 0), (0, B] and [B, ∞): exterior if that
is (0, B], interior if it is [−A, 0). Their mean lies in the same interval. It is never B or −A, while for every centre
in the plane of the waist or on the axis one of the roots is. A double root does not count as two, so the ring, where B
is a double root, reads as contact. The roots come from the closed form for three real roots (an arc cosine and two
cosines if Δ > 0, which section 3.1 of the paper attributes to its reference [13]), from numpy.roots (eigenvalues of the
companion matrix, one call for each row), and from mpmath.polyroots at a given number of digits; without convergence the
answer is "cannot say".

The sphere and the cylinder are circumscribed, so "clear" is right (for the cylinder except for rounding), and contact
often is not. The sphere has the radius max(b, d), the cylinder the radius b, the half height d and an axis parallel to
that of the hyperboloid.

Tilted spheroids, rows (n, 10), are decided as one would write it without certificates. Eigenvectors turn the pair
into a unit ball about the origin and a surface with three poles, x²/A1 + y²/A2 − z²/B = 1 (docs/mathematics.md,
"General position"); then the greatest value of the dual function decides. The roots of det(S + λH) beside its poles
decide as well. Plain floats err near contact.
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
from hypcheck.geometry.pair import COLUMNS, UPRIGHT, Axis, Sizes
from hypcheck.geometry.rows import CANNOT_SAY, Columns, Floats, Mask, Positions, Rows
from hypcheck.implementations.method import Answers, ByColumns
from hypcheck.kernel import numpy_kernel
from hypcheck.kernel.in_use import kernel

AnyFloats = NDArray[Any]


DISTANCES = ("lambda_", "A_plus_lambda", "B_minus_lambda")
"""The distances that the search gives to the formula, by the formula's names."""

_PHI = cut(FORMULAS["dual"].program, DISTANCES, ("phi",))
"""The dual form from the distances of λ to 0, −A and B, which the search knows more accurately than λ itself."""


def dual(precision: str) -> ByColumns:
    """Return the dual form on columns, with all computation including the search in one float format."""

    def sides(columns: Mapping[str, Any]) -> Answers:
        values = searched(columns, precision)
        (phi,) = outputs(_PHI, float_arithmetic(precision), values, ("phi",))
        return np.where(phi > 0, np.sign(values["lambda_"]), 0).astype(np.int8)

    return sides


def searched(columns: Mapping[str, Any], precision: str) -> dict[str, AnyFloats]:
    """Return the columns in a float format, and the distances of the best λ that is found in it: (n,) each."""
    with np.errstate(all="ignore"):
        rounded = {name: np.asarray(columns[name], dtype=precision) for name in COLUMNS}
        return {**rounded, **dict(zip(DISTANCES, _best_multiplier(**rounded), strict=True))}


def _best_multiplier(
    alpha: AnyFloats, gamma: AnyFloats, b: AnyFloats, d: AnyFloats, x: AnyFloats, y: AnyFloats, z: AnyFloats
) -> tuple[AnyFloats, AnyFloats, AnyFloats]:
    """Return approximately the λ at which φ is largest, for each row, with A + λ and B − λ.

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
        """Return a + λ and B − λ of the point at this distance from 0, or from the pole."""
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


def trigonometric_roots(format_name: str) -> ByColumns:
    """Return the trigonometric form on columns, with all computation in one float format."""
    ready = Evaluator(_LISTED, float_arithmetic(format_name), _CUBIC)
    return lambda columns: _root_sides(*ready(columns))


def _root_sides(A: Any, B: Any, c0: Any, c1: Any, c2: Any, delta: NDArray[Any]) -> NDArray[np.int8]:  # noqa: ANN401
    """Return positions (n,) from A, B, the coefficients of g and Δ, by the two lower roots of the closed form."""
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


def delta_with_powers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats, Floats]:
    """Return Δ, c1 and c2 of many centres, (n,) each, with `**2` and `**3` as in equations (13) and (14) of the paper.

    This is the formula as one writes it in numpy, and is not certified.
    """
    alpha, gamma, b, d = sizes
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    c0 = -A * B
    P, Q = (x**2 + y**2) / b**2, (z / d) ** 2
    c1 = c0 + A - B + B * P - A * Q
    c2 = A - B + 1 - P - Q
    delta = -4 * c2**3 * c0 + (c2 * c1) ** 2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2
    return delta, c1, c2


def numpy_roots(rows: Rows) -> Answers:
    """Return positions (n,) by numpy.roots; a root is real if its imaginary part is 0."""
    A, B, c0, c1, c2 = _COEFFICIENTS(dict(zip(COLUMNS, rows.T, strict=True)))
    answers = np.zeros(len(rows), dtype=np.int8)
    for place, coefficients in enumerate(np.column_stack([np.ones(len(rows)), c2, c1, c0])):
        if not np.isfinite(coefficients).all():
            answers[place] = CANNOT_SAY
            continue
        values = np.roots(coefficients)
        if len(values) == 3 and (not np.iscomplexobj(values) or not values.imag.any()):
            lowest, middle, _ = np.sort(values.real)
            answers[place] = _side(lowest, middle, A[place], B[place])
    return answers


def mpmath_roots(rows: Rows, digits: int) -> Answers:
    """Return positions (n,) by mpmath.polyroots; a root is real if polyroots returns it as real."""
    return np.array([_mpmath_position(row, digits) for row in rows.tolist()], dtype=np.int8)


def _mpmath_position(row: list[float], digits: int) -> int:
    """Return the position of a row by mpmath's roots at so many decimal digits."""
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
    """Return the position that the two lower of three real roots prove."""
    mean = (lowest + middle) / 2
    if lowest == middle:
        return 0
    if lowest > 0 and mean < B:
        return 1
    return -1 if middle < 0 and mean > -A else 0


def bounding_sphere(rows: Rows) -> Answers:
    """Return positions (n,) of the sphere, which no axis turns, exact, so that all errors are due to the shape."""
    spheres = rows[:, : len(COLUMNS)].copy()
    spheres[:, 2:4] = np.maximum(rows[:, 2], rows[:, 3])[:, np.newaxis]
    return numpy_kernel.positions(spheres)


def bounding_sphere_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats, _axis: Axis = UPRIGHT) -> Answers:
    """Return positions of the sphere for many centres and one α, γ, b, d."""
    alpha, gamma, b, d = sizes
    return numpy_kernel.positions_of_scene((alpha, gamma, max(b, d), max(b, d)), x, y, z)


def bounding_cylinder(columns: Mapping[str, Any]) -> NDArray[np.int8]:
    """Return positions (n,) of the cylinder on columns, in plain floats.

    The hyperboloid's radius grows with |z|, so it is widest at the cylinder's farther end, and narrowest at its nearer
    end or, if that lies between the two, in the plane of the waist.
    """
    alpha, gamma, b, d, x, y, z = (columns[name] for name in COLUMNS)
    r, height = np.hypot(x, y), np.abs(z)
    widest = alpha * np.hypot(1.0, (height + d) / gamma)
    narrowest = alpha * np.hypot(1.0, np.maximum(height - d, 0.0) / gamma)
    return np.asarray((r - b > widest).astype(np.int8) - (r + b < narrowest).astype(np.int8))


TURNS = 56
"""How often the interval of λ is bisected, down to neighbouring floats: some dual functions are greatest at a pole."""


def by_eigenvectors(rows: Rows, turns: int = TURNS) -> Positions:
    """Return positions of rows (n, 10) by numpy.linalg.eigh, and the dual function's greatest value.

    By bisection for its slope, which is safe from any start. Uncertified: near contact it is sometimes wrong.
    """
    with np.errstate(all="ignore"):
        return _by_dual(*_eigenbasis(rows[:, :4], rows[:, 7:]), rows[:, 4:7], turns)


def by_eigenvectors_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats, axis: Axis) -> Positions:
    """As by_eigenvectors, for many centres of one spheroid, whose eigenvectors are found once."""
    with np.errstate(all="ignore"):
        return _by_dual(*_eigenbasis(np.array([sizes]), np.array([axis])), np.column_stack([x, y, z]), TURNS)


def _eigenbasis(sizes: Floats, axes: Floats) -> tuple[Floats, Floats]:
    """Return the poles −B, then A1 and A2 with the nearer one last, (n, 3), and matrices (n, 3, 3).

    A matrix takes a centre to its components in the directions in which both bodies' matrices are diagonal.
    """
    b, d = sizes[:, 2, None, None], sizes[:, 3, None, None]
    unit = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    along = unit[:, :, None] * unit[:, None, :]
    root = b * np.eye(3) + (d - b) * along  # M^(-1/2)
    values, vectors = np.linalg.eigh(root @ (_diagonal(sizes)[:, :, None] * root))
    inverse = np.eye(3) / b + (1 / d - 1 / b) * along
    return 1 / values, np.swapaxes(vectors, 1, 2) @ inverse


def _diagonal(sizes: Floats) -> Floats:
    """Return the diagonal of D = diag(1/α², 1/α², −1/γ²), (n, 3)."""
    alpha, gamma = sizes[:, 0], sizes[:, 1]
    return np.column_stack([alpha**-2, alpha**-2, -(gamma**-2)])


def _by_dual(poles: Floats, turned: Floats, centres: Floats, turns: int) -> Positions:
    """Return the positions (n,) by the sign of the dual function at its maximum, found by `turns` bisections."""
    squares = (turned @ centres[:, :, None])[:, :, 0] ** 2
    low, high = (np.broadcast_to(-poles[:, k], len(centres)) for k in (2, 0))
    for _ in range(turns):
        middle = (low + high) / 2
        rising = (poles * squares / (poles + middle[:, None]) ** 2).sum(axis=1) > 1
        low, high = np.where(rising, middle, low), np.where(rising, high, middle)
    at = (low + high) / 2
    phi = at * (squares / (poles + at[:, None])).sum(axis=1) - 1 - at
    return np.where(phi > 0, np.sign(at), 0).astype(np.int8)


def by_roots(rows: Rows) -> Positions:
    """Return positions of rows (n, 10) by the roots of det(S + λH), which numpy.linalg.eigvals finds.

    A root counts as real if its computed imaginary part is 0.

    Exterior: two different roots between 0 and B. Interior: two between −min(A1, A2) and 0.
    """
    sizes, centre, axes = rows[:, :4], rows[:, 4:7], rows[:, 7:]
    b, d = sizes[:, 2, None, None], sizes[:, 3, None, None]
    unit = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    quadratic = np.eye(3) / b**2 + (1 / d**2 - 1 / b**2) * unit[:, :, None] * unit[:, None, :]  # M
    linear = (quadratic @ centre[:, :, None])[:, :, 0]
    inverse = 1 / np.column_stack([_diagonal(sizes), -np.ones(len(rows))])  # of H
    pencil = np.empty((len(rows), 4, 4))
    pencil[:, :3, :3], pencil[:, 3, 3] = quadratic, (linear * centre).sum(axis=1) - 1
    pencil[:, :3, 3] = pencil[:, 3, :3] = -linear
    roots = np.linalg.eigvals(-inverse[:, :, None] * pencil)
    poles = np.linalg.eigvals(-inverse[:, :3, None] * quadratic).real
    nearest = [np.where(poles * side > 0, np.abs(poles), np.inf).min(axis=1) for side in (1, -1)]
    sides = [_pair_below(side * roots, pole) for side, pole in zip((1, -1), nearest, strict=True)]
    return sides[0].astype(np.int8) - sides[1].astype(np.int8)


def _pair_below(roots: NDArray[Any], pole: Floats) -> Positions:
    """Whether two different real roots lie between 0 and the pole, (n,)."""
    real = np.where((roots.imag == 0) & (roots.real > 0), roots.real, np.inf)
    lowest, second = np.sort(real, axis=1)[:, :2].T
    return np.asarray((lowest < second) & (second <= pole))


def upright(rows: Rows) -> Answers:
    """Return positions (n,) as if the spheroid stood upright, exact, so that every error is due to its axis."""
    return kernel().answer_rows(np.ascontiguousarray(rows[:, : len(COLUMNS)]), "position", 1)[0]


def upright_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats, _axis: Axis) -> Answers:
    """As upright, for many centres of one spheroid."""
    columns: Columns = (x, y, z)
    return kernel().answer_scene(sizes, columns, "position", 1)[0]
