"""Rational constructions of pairs whose g has a double root m, as rows that float64 holds exactly.

They are tangencies, and crossings with a node, an isolated point or a cusp. In the space of Theorem 1 the spheroid is
the unit ball, the hyperboloid has the semi-axes a = α/b and c = γ/d, and the centre is (x, y, z) with r² = x² + y².
There let g(λ) = (λ − m)²(λ − n). The roots' product a²c² gives n = a²c²/m², and then g(−a²) = −a² r² (a² + c²) and
g(c²) = −c² z² (a² + c²) (docs/mathematics.md, "Where the roots are") give the centre:

    r² = (a² + m)² (m² + c²) / (m² (a² + c²)),   z² = (c² − m)² (a² − m²) / (m² (a² + c²)).

Let sin² = (a² − m²)/(a² + c²). Then z = sin · (c² − m)/m, and a² cos² − c² sin² = m². The normal of the surface at the
root's point is (cos, −sin), across the axis and along it. The pair is a tangency if −a² ≤ m ≤ c², except on the ring;
for other m the sphere crosses the surface elsewhere, but g still has the double root.

m² + c² and a² + c² are sums of two squares, so r² is one: it has rational x and y for any rational a, c and m, whether
r is rational or not. The only condition is that (a² − m²)(a² + c²) is a square; for any a and c it is a square for
infinitely many m.

Arrays of Python integers (dtype object) have no overflow, so a formula is written once, for a whole block. The radial
lengths (α, b, x, y) and the axial lengths (γ, d, z) each have their own unit (pair.Lengths), so a rational construction
becomes a row of integers by clearing denominators, and any power of two may be the unit. If the integers need more than
the 53 bits of float64, the construction is drawn again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.rows import Floats, Mask, Rows
from hypcheck.vectors.draw import Draw, Integers, Maker, exponent, ldexp, stepped

BigIntegers = NDArray[np.object_]

RADIAL_COLUMNS = [0, 2, 4, 5]
AXIAL_COLUMNS = [1, 3, 6]
ULPS = 40
"""Rows near to exact ones have a number that is moved by 1, 2, 4 … 2^ULPS ulp."""

ATTEMPTS = 1000
"""Attempts after which `gather` gives up. The rarest rows are 1 in 50, which takes some dozens of attempts a block."""


def big_integers(draw: Draw, n: int, low: int, high: int) -> BigIntegers:
    """Draw Python integers from low to high, both included."""
    return draw.integers(n, low, high).astype(object)


def big_integers_of_any_length(draw: Draw, n: int, bits: int) -> BigIntegers:
    """Draw Python integers ≥ 1 of at most `bits` bits; every number of bits is equally likely."""
    return np.floor(draw.log_uniform(n, 0, bits)).astype(np.int64).astype(object)


def roots(values: BigIntegers) -> BigIntegers:
    """Return ⌊√value⌋ of each integer ≥ 0."""
    return np.asarray(np.frompyfunc(math.isqrt, 1, 1)(values), dtype=object)


def triples(draw: Draw, n: int, most: int) -> tuple[BigIntegers, BigIntegers, BigIntegers]:
    """Draw Pythagorean triples (leg, other leg, hypotenuse): i² − j² and 2ij in either order, i² + j²; i ≤ 2·most."""
    j = big_integers(draw, n, 1, most)
    i = j + big_integers(draw, n, 1, most)
    one, other = i * i - j * j, 2 * i * j
    swap = draw.signs(n) < 0
    return np.where(swap, other, one), np.where(swap, one, other), i * i + j * j


def turned(draw: Draw, n: int) -> tuple[BigIntegers, BigIntegers, BigIntegers]:
    """Draw x, y and √(x² + y²), all integers: a direction, for half of the rows that of the x axis."""
    x, y, radius = triples(draw, n, 4)
    on_axis = draw.signs(n) < 0
    return np.where(on_axis, 1, x), np.where(on_axis, 0, y), np.where(on_axis, 1, radius)


def in_lowest_terms(numbers: Sequence[BigIntegers]) -> list[BigIntegers]:
    """Divide the numbers of each row by their greatest common divisor."""
    shared = np.maximum(reduce(np.gcd, numbers), 1)
    return [number // shared for number in numbers]


def to_rows(radial: Sequence[BigIntegers], axial: Sequence[BigIntegers]) -> tuple[Rows, Mask]:
    """Make rows of `radial` α, b, x, y and `axial` γ, d, z, each group divided by its greatest common divisor.

    Returns a mask, too, of the rows that float64 holds exactly and whose sizes are > 0.
    """
    rows = np.empty((len(radial[0]), 7))
    exact = np.ones(len(rows), dtype=np.bool_)
    for columns, lengths in ((RADIAL_COLUMNS, radial), (AXIAL_COLUMNS, axial)):
        reduced = np.stack(in_lowest_terms(lengths))
        rows[:, columns] = reduced.T.astype(np.float64)
        exact &= np.asarray(abs(reduced) <= 2**53).all(axis=0) & np.asarray(reduced[:2] > 0).all(axis=0)
    return rows, exact


def gather(draw: Draw, n: int, attempt: Callable[[Draw, int], tuple[Rows, Mask]]) -> Rows:
    """Gather n rows in as many attempts as needed; each attempt returns rows and a mask of the wanted ones."""
    parts: list[Rows] = []
    missing = n
    for _ in range(ATTEMPTS):
        rows, wanted = attempt(draw, max(2 * missing, 256))
        parts.append(rows[wanted][:missing])
        missing -= len(parts[-1])
        if missing == 0:
            return np.concatenate(parts)
    raise AssertionError(f"{ATTEMPTS} attempts of a construction left {missing} of {n} rows to be found")


def gathered(attempt: Callable[[Draw, int], tuple[Rows, Mask]]) -> Maker:
    """Return the generator that gathers the wanted rows of a construction, as `gather` does."""
    return lambda draw, n: gather(draw, n, attempt)


def in_metres(draw: Draw, rows: Rows) -> Rows:
    """Write the same pairs in other coordinates: any signs, x and y swapped or not, both groups of lengths about 1."""
    n = len(rows)
    rows = rows.copy()
    for column in (4, 5, 6):
        rows[:, column] *= draw.signs(n)
    swap = draw.signs(n) < 0
    rows[:, 4:6] = np.where(swap[:, None], rows[:, 5:3:-1], rows[:, 4:6])
    for columns in (RADIAL_COLUMNS, AXIAL_COLUMNS):
        lengths = np.abs(rows[:, columns])
        greatest = lengths.max(axis=1)
        least = np.where(lengths == 0, greatest[:, None], lengths).min(axis=1)
        unit = draw.integers(n, -3, 3) - (exponent(greatest) + exponent(least)) // 2
        rows[:, columns] = ldexp(rows[:, columns], unit[:, None])
    return rows + 0.0


def one_moved(draw: Draw, rows: Rows, steps: Integers) -> Rows:
    """Move one nonzero number of each row by `steps` ulps, (n,)."""
    n = len(rows)
    chosen, index = draw.integers(n, 0, rows.shape[1] - 1), np.arange(n)
    chosen = np.where(rows[index, chosen] == 0, chosen % 4, chosen)
    moved = rows.copy()
    moved[index, chosen] = stepped(rows[index, chosen], steps)
    return moved


@dataclass(frozen=True, slots=True)
class DoubleRoots:
    """n rows with a double root m, and masks (n,) of them.

    `usable`: the row is valid and exact. `outer`: m > 0, so that the spheroid is outside if it touches. `tangent`: it
    touches, which is −a² ≤ m ≤ c². `sine` is sin of the module's docstring, in floats. In a tangency z is ≥ 0.
    """

    rows: Rows
    usable: Mask
    outer: Mask
    tangent: Mask
    sine: Floats


def by_ratios(draw: Draw, n: int, most: int = 12) -> DoubleRoots:
    """Make double roots for any rational a and c with terms up to `most`, and a rational τ.

    With e = a² + c²: m = a (e − τ²)/(e + τ²), sin = 2aτ/(e + τ²) and, with i² = −1,
    x + i y = (a² + m)(m + i c)(a + i c)/(m e).
    """
    a_top, a_bottom, c_top, c_bottom, t_top, t_bottom = (big_integers(draw, n, 1, most) for _ in range(6))
    # With a = p/unit, c = q/unit and τ = t/unit, all denominators are powers of `unit`.
    unit, p, q = a_bottom * c_bottom, a_top * c_bottom, c_top * a_bottom
    e = p * p + q * q
    t_top = t_top * np.maximum(roots(e) // 4, 1)  # τ about √e, where m changes its sign
    less, more = e * t_bottom**2 - t_top**2, e * t_bottom**2 + t_top**2  # m = a·less/more
    size = abs(less)
    a_and_m = p * more + unit * less  # has the sign of a² + m
    c_less_m = q * q * more - unit * p * less  # has the sign of c² − m
    rows, exact = to_rows(
        radial=(
            p * size * more * e,
            unit * size * more * e,
            abs(a_and_m * (p * p * less - q * q * more)),
            abs(a_and_m * 2 * p * q * t_bottom**2 * e),
        ),
        axial=(q * size * more, unit * size * more, abs(2 * t_top * t_bottom * c_less_m)),
    )
    return DoubleRoots(
        rows=rows,
        usable=exact,  # to_rows refuses m = 0, where the sizes are 0
        outer=np.asarray(less > 0),
        tangent=np.where(less > 0, c_less_m >= 0, a_and_m >= 0),
        sine=(2 * p * t_top * t_bottom / more).astype(np.float64),
    )


def by_angle(draw: Draw, n: int, bits: int = 7) -> DoubleRoots:
    """Make double roots as by_ratios does, with a rational normal too: the centre's distance from the axis is rational.

    Any whole numbers i, j, v, w and any rational (cos, sin) give a pair: m = ±i/j, a cos + c sin = v/w and
    a cos − c sin = m² w/v, or the same with −c for c. The point of the surface is (a² cos, c² sin)/|m|, across the axis
    and along it, and the centre is one normal away from it.
    """
    f, h, hypotenuse = triples(draw, n, 4)  # cos and sin over the hypotenuse
    i, j = big_integers(draw, n, 1, 9), big_integers(draw, n, 1, 9)
    v, w = big_integers_of_any_length(draw, n, bits), big_integers_of_any_length(draw, n, bits)
    outer = np.arange(n) % 2 == 0
    side = np.where(outer, 1, -1).astype(object)
    s, t, unit = (i * w) ** 2, (j * v) ** 2, j * j * v * w  # m² w/v = s/unit, v/w = t/unit
    total, difference = s + t, abs(s - t)  # a = total/(2 unit cos), c = difference/(2 unit sin)
    radius = total**2 * hypotenuse**2 * j + side * 4 * unit**2 * f * f * i
    height = difference**2 * hypotenuse**2 * j - side * 4 * unit**2 * h * h * i
    x, y, turn = turned(draw, n)
    rows, exact = to_rows(
        radial=(
            2 * unit * i * hypotenuse**2 * total * turn,
            4 * unit**2 * f * i * hypotenuse * turn,
            abs(radius) * x,
            abs(radius) * y,
        ),
        axial=(2 * unit * i * hypotenuse**2 * difference, 4 * unit**2 * h * i * hypotenuse, abs(height)),
    )
    tangent = np.where(outer, height >= 0, radius >= 0)
    return DoubleRoots(rows, exact, outer, tangent, (h / hypotenuse).astype(np.float64))


def cusps(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make rows with a triple root m = w² above c², for rational w and t such that σ and η are rational.

    σ² = t² − 1 and η² = w² t⁴ + 1. So t is hypotenuse/leg of one Pythagorean triple, and w t² is leg/other leg of
    another. Then a = w² t, c = w/t, x + i y = (1 + i w t)³/η with i² = −1, and z = w σ³/(t η).
    """
    leg, other, hypotenuse = triples(draw, n, 7)
    p, q, g = triples(draw, n, 7)
    e, f = p * leg, q * hypotenuse  # w t = e/f
    return to_rows(
        radial=(
            p * p * leg**3 * g,
            q * q * hypotenuse**3 * g,
            abs(f * (f * f - 3 * e * e)),
            abs(e * (3 * f * f - e * e)),
        ),
        axial=(p * leg**3 * g, q * hypotenuse**3 * g, p * q * other**3),
    )


def throat_circles(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make rows on the axis that touch along a circle (m = −a²): z² = (a² + c²)(1 − a²)/a², both factors squares.

    A quarter of the rows has a = 1 and the centre in the waist.
    """
    leg, other, hypotenuse = triples(draw, n, 8)
    near, far, beyond = triples(draw, n, 8)
    fits = np.arange(n) % 4 == 0
    gamma, d = big_integers_of_any_length(draw, n, 20), big_integers_of_any_length(draw, n, 20)
    zero = np.zeros(n, dtype=object)
    return to_rows(
        radial=(np.where(fits, hypotenuse, leg), hypotenuse, zero, zero),
        axial=(
            np.where(fits, gamma, leg * far),
            np.where(fits, d, hypotenuse * near),
            np.where(fits, 0, beyond * other),
        ),
    )


def waist_points(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make rows that touch the circle of the waist, z = 0: r = a + 1 with c² > a, or r = a − 1 with a ≥ 1, in turn."""
    alpha, b, d = (big_integers_of_any_length(draw, n, 26) for _ in range(3))
    outer = np.arange(n) % 2 == 0
    alpha, b = np.where(outer, alpha, np.maximum(alpha, b)), np.where(outer, b, np.minimum(alpha, b))
    reach = np.where(outer, alpha + b, alpha - b)
    gamma = d * (1 + roots(alpha // b)) + big_integers_of_any_length(draw, n, 26)  # (⌊√⌊a⌋⌋ + 1)² > a
    x, y, turn = turned(draw, n)
    return to_rows(radial=(alpha * turn, b * turn, reach * x, reach * y), axial=(gamma, d, np.zeros(n, dtype=object)))


def osculations(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make rows with c² = a, z = 0 and r = a + 1: the ball and the surface have the same curvature where they touch."""
    top, bottom = big_integers_of_any_length(draw, n, 13), big_integers_of_any_length(draw, n, 13)
    x, y, turn = turned(draw, n)
    p, q = top * top, bottom * bottom
    return to_rows(
        radial=(p * turn, q * turn, (p + q) * x, (p + q) * y), axial=(top, bottom, np.zeros(n, dtype=object))
    )


def waist_roots(draw: Draw, n: int, *, ring: bool) -> tuple[Rows, Mask]:
    """Make rows with z = 0 and m = c², for any rational a and c.

    x² + y² = (c² + 1)(a² + c²)/c² = ((c² − a)/c)² + (a + 1)² = ((c² + a)/c)² + (a − 1)².
    With `ring`, c² > a and the ball is clear; otherwise c² < a and it touches at two points.
    """
    a_top, a_bottom, c_top, c_bottom = (big_integers_of_any_length(draw, n, 16) for _ in range(4))
    other = np.asarray(c_top**2 * a_bottom < a_top * c_bottom**2) == ring  # then 1/a and 1/c are on the right side
    a_top, a_bottom = np.where(other, a_bottom, a_top), np.where(other, a_top, a_bottom)
    c_top, c_bottom = np.where(other, c_bottom, c_top), np.where(other, c_top, c_bottom)
    tall, wide = c_top**2 * a_bottom, a_top * c_bottom**2
    unit = c_top * c_bottom
    first = np.arange(n) % 2 == 0
    rows, exact = to_rows(
        radial=(
            a_top * unit,
            a_bottom * unit,
            np.where(first, abs(tall - wide), abs(a_top - a_bottom) * unit),
            np.where(first, (a_top + a_bottom) * unit, tall + wide),
        ),
        axial=(c_top, c_bottom, np.zeros(n, dtype=object)),
    )
    return rows, exact & np.asarray(tall != wide)


def waist_roots_on_an_axis(draw: Draw, n: int, *, ring: bool) -> tuple[Rows, Mask]:
    """Make rows as waist_roots does, centre (r, 0, 0): c² + 1 and (a² + c²)/c² are squares, so r is rational."""
    leg, other, hypotenuse = triples(draw, n, 8)  # c = leg/other
    near, far, beyond = triples(draw, n, 8)  # a/c = far/near
    zero = np.zeros(n, dtype=object)
    rows, exact = to_rows(radial=(leg * far, other * near, hypotenuse * beyond, zero), axial=(leg, other, zero))
    return rows, exact & np.asarray((leg * near > far * other) if ring else (leg * near < far * other))
