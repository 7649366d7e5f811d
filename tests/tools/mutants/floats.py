"""Right formulas in plain floats, which round; and fewer bits, or fewer steps, than were claimed."""

from __future__ import annotations

from unittest.mock import patch

import numpy as np

from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.formulas import answers as evaluated
from hypcheck.geometry.pair import COLUMNS
from hypcheck.implementations import alternatives
from hypcheck.implementations.alternatives import dual
from hypcheck.implementations.method import on_rows
from tests.support.inside import numpy_kernel
from tests.tools.mutants.exactly import position, signs
from tests.tools.mutants.expectation import NO_TOLERANCE, wrong

FLOAT32 = ("--precision", "float32")


def _plain(name, rows, precision="float64"):
    """A formula of the paper, or after it, with every operation rounded."""
    return evaluated(FORMULAS[name], float_arithmetic(precision), dict(zip(COLUMNS, rows.T, strict=True)))


def _scaled(rows):
    """A, B, P, Q in float64."""
    alpha, gamma, b, d, x, y, z = rows.T
    return (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2


def _by_bisection(rows, steps):
    """The dual form in float64 with λ from so many bisections of (0, B) and (−A, 0)."""
    A, B, P, Q = _scaled(rows)
    inside = P * B < B * A + Q * A
    low, high = np.where(inside, -A, 0), np.where(inside, 0, B)
    with np.errstate(all="ignore"):
        for _ in range(steps):
            middle = (low + high) / 2
            rising = P * A / (A + middle) ** 2 > Q * B / (B - middle) ** 2 + 1
            low, high = np.where(rising, middle, low), np.where(rising, high, middle)
        clear = P * low / (A + low) - Q * low / (B - low) - 1 - low > 0
    return np.where(clear, np.sign(low), 0).astype(np.int8)


@wrong()
def dual_form_in_float32(rows):
    """Claims float64, and computes the dual form in float32."""
    return on_rows(dual("float32"))(rows)


@wrong(claim=FLOAT32)
def dual_form_in_float16(rows):
    """Claims float32, and computes the dual form in float16."""
    return on_rows(dual("float16"))(rows)


@wrong(claim=("--precision", "x87"))
def x87_in_name_only(rows):
    """Claims x87, and computes the dual form in float64."""
    return on_rows(dual("float64"))(rows)


@wrong(claim=("--precision", "exact"))
def exact_in_name_only(rows):
    """Claims to be exact, and computes the dual form in float64."""
    return on_rows(dual("float64"))(rows)


@wrong(asked=NO_TOLERANCE)
def dual_form_rounded(rows):
    """The dual form in float64: backward stable, and not exact."""
    return on_rows(dual("float64"))(rows)


@wrong()
def table_2_formula(rows):
    """Signs of Δ and of the coefficients of Table 2 in float64, for all regimes."""
    return _plain("coefficients", rows)


@wrong()
def hessian_without_fallback(rows):
    """The Hessian discriminant in float64, trusted even where it is next to 0."""
    return _plain("hessian", rows)


@wrong()
def shared_without_fallback(rows):
    """The Hessian discriminant with one cancellation shared, in float64, trusted everywhere."""
    return _plain("shared", rows)


@wrong()
def local_maximum(rows):
    """The sign of g at its local maximum, in float64."""
    return _plain("local-maximum", rows)


@wrong(claim=FLOAT32)
def nan_is_clear(rows):
    """Exact, unless the float32 Δ of Table 2 is NaN: "if Δ ≤ 0 then contact, else …" calls that clear."""
    (delta,) = _float32_delta(rows)
    side = np.sign(rows[:, 4] ** 2 + rows[:, 5] ** 2 - rows[:, 0] ** 2 * (1 + (rows[:, 6] / rows[:, 1]) ** 2))
    return np.where(np.isnan(delta), side, position(rows)).astype(np.int8)


@wrong(claim=FLOAT32)
def nan_is_contact(rows):
    """Exact, unless the float32 Δ of Table 2 is NaN: "if Δ > 0 then clear, else …" calls that contact."""
    (delta,) = _float32_delta(rows)
    return np.where(np.isnan(delta), 0, position(rows)).astype(np.int8)


def _float32_delta(rows):
    from hypcheck.derivation.evaluation import outputs

    inputs = dict(zip(COLUMNS, rows.T, strict=True))
    return outputs(FORMULAS["table-2"].program, float_arithmetic("float32"), inputs, ("delta",))


@wrong()
def roots_by_angles(rows):
    """The roots of g by the trigonometric formula in float64, then counted between −A, 0 and B."""
    A, B, P, Q = _scaled(rows)
    c2, c1, c0 = A - B + 1 - P - Q, -A * B + A - B + B * P - A * Q, -A * B
    p, q = c1 - c2 * c2 / 3, 2 * c2**3 / 27 - c2 * c1 / 3 + c0
    with np.errstate(all="ignore"):
        angle = np.arccos(3 * q / (2 * p) * np.sqrt(-3 / p)) / 3
        roots = [2 * np.sqrt(-p / 3) * np.cos(angle - 2 * np.pi * k / 3) - c2 / 3 for k in range(3)]
        outside = sum((root > 0) & (root <= B) for root in roots)
        inside = sum((root < 0) & (root >= -A) for root in roots)
    return signs(outside >= 1, inside >= 1)


@wrong()
def roots_by_eigenvalues(rows):
    """The roots of g as eigenvalues; a pair with imaginary parts below 1e-9 counts as real."""
    A, B, P, Q = _scaled(rows)
    companion = np.zeros((len(rows), 3, 3))
    companion[:, 0] = -np.column_stack([A - B + 1 - P - Q, -A * B + A - B + B * P - A * Q, -A * B])
    companion[:, 1, 0] = companion[:, 2, 1] = 1
    roots = np.linalg.eigvals(companion)
    real = np.abs(roots.imag) < 1e-9
    outside = (real & (roots.real > 0) & (roots.real < B[:, None])).sum(axis=1)
    inside = (real & (roots.real < 0) & (roots.real > -A[:, None])).sum(axis=1)
    return signs(outside >= 1, inside >= 1)


@wrong()
def search_of_20_steps(rows):
    """The dual form with λ from 20 bisections of (0, B) and (−A, 0)."""
    return _by_bisection(rows, 20)


def _with_bounds(rows, part):
    """The fast path in numpy with this part of its error bounds."""
    units = {name: part * value for name, value in numpy_kernel.CONSTANTS.items() if name.startswith("u_")}
    with patch.object(numpy_kernel, "CONSTANTS", numpy_kernel.CONSTANTS | units):
        return numpy_kernel.positions(np.ascontiguousarray(rows))


@wrong()
def bound_of_zero(rows):
    """The fast path with error bounds of 0: floats decide everything but an exact 0."""
    return _with_bounds(rows, 0.0)


@wrong()
def bound_a_thousandth(rows):
    """The fast path with a thousandth of its error bounds."""
    return _with_bounds(rows, 1 / 1024)


@wrong(asked=NO_TOLERANCE)
def reassociated(rows):
    """The dual form in float64 with its sum taken in another order, (Pλ/(A+λ) − λ) − (1 + Qλ/(B−λ))."""
    _, _, P, Q = _scaled(rows)
    multiplier, to_A, to_B = alternatives._best_multiplier(*rows.T)
    with np.errstate(all="ignore"):
        phi = (P * (multiplier / to_A) - multiplier) - (1 + Q * (multiplier / to_B))
    return np.where(phi > 0, np.sign(multiplier), 0).astype(np.int8)


@wrong()
def search_of_60_steps(rows):
    """The dual form with λ from 60 bisections of (0, B) and (−A, 0): λ is exact to the last bit, A + λ is not."""
    return _by_bisection(rows, 60)


@wrong()
def newton_of_8_steps(rows):
    """The dual form with λ from 8 steps of Newton's method, held between the poles."""
    A, B, P, Q = _scaled(rows)
    inside = P * B < B * A + Q * A
    low, high = np.where(inside, -A, 0), np.where(inside, 0, B)
    at = (low + high) / 2
    with np.errstate(all="ignore"):
        for _ in range(8):
            slope = P * A / (A + at) ** 2 - Q * B / (B - at) ** 2 - 1
            bend = -2 * P * A / (A + at) ** 3 - 2 * Q * B / (B - at) ** 3
            at = np.clip(at - slope / bend, low + (at - low) / 8, high - (high - at) / 8)
        clear = P * at / (A + at) - Q * at / (B - at) - 1 - at > 0
    return np.where(clear, np.sign(at), 0).astype(np.int8)
