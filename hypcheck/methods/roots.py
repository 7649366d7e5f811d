"""Positions from the roots of g, as general-purpose root finders give them: what the coefficients are to replace.

The rule, for every size (docs/mathematics.md, "Root patterns and relative position"): three real roots, of which the
two lower ones lie together in one of (−∞, −A], [−A, 0), (0, B] and [B, ∞); exterior where that is (0, B], interior
where it is [−A, 0). Their mean tells which, and is never B or −A, which one of them is for every centre in the waist's
plane or on the axis. A double root is no two, so the ring, where B is one, reads as contact.

- `trigonometric`: the closed form for three real roots, which takes an arc cosine and two cosines where Δ > 0: the way
  that the paper, in section 3.1, attributes to its reference [13].
- `by_numpy`: numpy.roots, the eigenvalues of the companion matrix, one call a row.
- `by_mpmath`: mpmath.polyroots at a given number of decimal digits; what does not converge is not said.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.evaluation import Evaluator
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.methods.formula import ByRows, ByScene, Floats, Sizes, in_chunks
from hypcheck.methods.method import Answers
from hypcheck.pairs import COLUMNS, SIZES
from hypcheck.rows import CANNOT_SAY, Rows

_CUBIC = ("A", "B", "c0", "c1", "c2", "delta")
_LISTED = FORMULAS["table-2"].program
"""The coefficients are those of Table 2 for all three, so that the roots alone make the difference."""

_STEPS, _EXTRA_BITS = 200, 200
"""With polyroots' own 50 steps and 10 bits most cubics of the tower do not converge; it advises more of both."""

_COEFFICIENTS = Evaluator(_LISTED, float_arithmetic("float64"), _CUBIC[:-1])


def trigonometric(format_name: str) -> ByRows:
    """Positions by the trigonometric form, everything in one float format: a function of rows."""
    ready = Evaluator(_LISTED, float_arithmetic(format_name), _CUBIC)

    def answers(rows: Rows) -> Answers:
        return in_chunks(len(rows), lambda part: _sides(*ready(dict(zip(COLUMNS, rows[part].T, strict=True)))))

    return answers


def trigonometric_by_scene(format_name: str) -> ByScene:
    """The same for many centres and one α, γ, b, d."""
    ready = Evaluator(_LISTED, float_arithmetic(format_name), _CUBIC)

    def answers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
        fixed = dict(zip(SIZES, sizes, strict=True))
        return in_chunks(len(x), lambda part: _sides(*ready({**fixed, "x": x[part], "y": y[part], "z": z[part]})))

    return answers


def _sides(A: Any, B: Any, c0: Any, c1: Any, c2: Any, delta: NDArray[Any]) -> NDArray[np.int8]:  # noqa: ANN401
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


def by_numpy(rows: Rows) -> Answers:
    """Positions (n,) by numpy.roots; a root is real where its imaginary part is 0."""
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


def by_mpmath(rows: Rows, digits: int) -> Answers:
    """Positions (n,) by mpmath.polyroots; a root is real where polyroots says so."""
    return np.array([_by_mpmath(row, digits) for row in rows.tolist()], dtype=np.int8)


def _by_mpmath(row: list[float], digits: int) -> int:
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
