"""Cases that an algorithm must distinguish: exact tangencies, other double roots, the ring, and borders of regimes.

Next to tangencies there are rows at tiny distances, and ladders of ulps: every power of two from 1 to 2⁴⁰, on both
sides, one after the other. On the ring Δ = 0, but nothing touches; if c² = a, the sphere has the same curvature as the
groove. The borders are those of regimes, planes and lines of symmetry, and vanishing coefficients.

The letters below: a = α/b, c = γ/d. In a formula x, y are in units of b, and z in units of d, as in the space of
Theorem 1, where the spheroid is the unit ball; r = √(x² + y²). The cubic is g(λ) = λ³ + c2 λ² + c1 λ + c0, c0 = −a²c²
(docs/mathematics.md), and Δ its discriminant. With a < 1 the ball is wider than the throat, the hole at the waist; with
c² < a it is too round for the groove, the hollow around the waist. A regime is one of the four combinations of a < 1 or
not with c² < a or not.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from hypcheck.geometry.rows import Floats, Mask, Rows
from hypcheck.vectors import double_roots, random_pairs
from hypcheck.vectors.double_roots import (
    ULPS,
    DoubleRoots,
    big_integers,
    big_integers_of_any_length,
    gather,
    in_metres,
    one_moved,
    to_rows,
    triples,
    turned,
)
from hypcheck.vectors.draw import Draw, Integers, Maker, exponent, in_turn, ldexp, stepped, turns


def exact_maker(construction: Callable[[Draw, int], tuple[Rows, Mask]]) -> Maker:
    """Return the generator of the usable rows of a construction, which returns rows and a mask of the usable ones."""
    return lambda draw, n: in_metres(draw, gather(draw, n, construction))


def reach(rows: Rows) -> Integers:
    """Return the e for which the largest of α/b, |x|/b, |y|/b and |z|/d is from 2^e to 2^(e + 1), (n,).

    So a relative change δ of one of these lengths moves spheroid and surface by at most about 2^(e + 1) δ radii. γ is
    left out, because it moves the surface by no more than r and α together.
    """
    alpha, _, b, d, x, y, z = np.abs(rows).T
    return np.maximum(exponent(np.maximum(np.maximum(alpha, x), y) / b), exponent(z / d))


def _touching(
    construction: Callable[[Draw, int], DoubleRoots], *, outer: bool, tangent: bool = True, farthest: float = np.inf
) -> Maker:
    """Return the generator of double roots, tangencies or not, outer or not, with a `reach` of at most `farthest`."""

    def attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
        tangencies = construction(draw, n)
        usable = tangencies.usable & (tangencies.outer == outer) & (tangencies.tangent == tangent)
        rows = np.where(usable[:, None], tangencies.rows, 1.0)
        return rows, usable & (reach(rows) <= farthest)

    return exact_maker(attempt)


tangent = in_turn(
    _touching(double_roots.by_ratios, outer=True),
    _touching(double_roots.by_angle, outer=False),
    exact_maker(double_roots.osculations),
    exact_maker(double_roots.throat_circles),
    exact_maker(partial(double_roots.waist_roots, ring=False)),
    exact_maker(double_roots.waist_points),
    _touching(double_roots.by_angle, outer=True),
    _touching(double_roots.by_ratios, outer=False),
    exact_maker(partial(double_roots.waist_roots_on_an_axis, ring=False)),
)

degenerate_crossing = in_turn(
    _touching(double_roots.by_angle, outer=False, tangent=False),  # nodes of the throat
    _touching(double_roots.by_angle, outer=True, tangent=False),  # nodes of the groove and isolated points
    exact_maker(double_roots.cusps),
    _touching(double_roots.by_ratios, outer=True, tangent=False),
)


def ulps_away(draw: Draw, rows: Rows) -> Rows:
    """Move one nonzero length of each row by 1, 2, 4 … or 2^ULPS ulp to either side.

    The steps are fewer if they would exceed about 2⁻⁸ radii, so that no row is moved through the whole surface.
    """
    n = len(rows)
    most = np.minimum(ULPS, 52 - 8 - 1 - reach(rows))
    return one_moved(draw, rows, ldexp(draw.signs(n), draw.integers(n, 0, ULPS) % (most + 1)).astype(np.int64))


def near_tangent(*, outer: bool) -> Maker:
    """Return the generator of rows near tangencies from one side.

    Half of the tangencies are moved by ulps, half along the normal by 2⁻⁵⁰ to 2⁻⁹ radii, out or in.
    """

    def beside(construction: Callable[[Draw, int], DoubleRoots]) -> Maker:
        def attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
            tangencies = construction(draw, n)
            usable = tangencies.usable & (tangencies.outer == outer) & tangencies.tangent
            rows = np.where(usable[:, None], tangencies.rows, 1.0)
            along = _along_the_normal(rows, tangencies.sine, _small(draw, n), outer=outer)
            by_ulps = draw.signs(n) < 0
            return np.where(by_ulps[:, None], ulps_away(draw, rows), along), usable

        return exact_maker(attempt)

    return in_turn(beside(double_roots.by_ratios), beside(double_roots.by_angle))


def _small(draw: Draw, n: int) -> Floats:
    """Return steps from 2⁻⁵⁰ to 2⁻⁹ radii, of either sign."""
    return draw.signed(n, -50, -9)


def _along_the_normal(rows: Rows, sine: Floats, step: Floats, *, outer: bool) -> Rows:
    """Move each centre, which has z ≥ 0, by `step` radii away from the point that it touches.

    The normal there is (√(1 − sine²), −sine), across the axis and along it. `outer`: the spheroid is outside.
    """
    _, _, b, d, x, y, z = rows.T
    cosine = np.sqrt(1 - sine * sine)
    away = step if outer else -step
    radius = np.sqrt(x * x + y * y)
    stretch = np.where(radius > 0, away * cosine * b / np.where(radius > 0, radius, 1), 0)
    moved = rows.copy()
    moved[:, 4] = x + x * stretch
    moved[:, 5] = y + y * stretch
    moved[:, 6] = z - away * sine * d
    return moved


def degenerate_neighbourhood(draw: Draw, n: int) -> Rows:
    """Move degenerate crossings by ulps: both sides are in contact, though Δ changes its sign."""
    return ulps_away(draw, degenerate_crossing(draw, n))


@exact_maker
def on_surface(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Put centres on the surface: r/a and z/c are hypotenuse/leg and other leg/leg of one Pythagorean triple."""
    leg, other, hypotenuse = triples(draw, n, 12)
    x, y, turn = turned(draw, n)
    unit, tall = big_integers_of_any_length(draw, n, 12), big_integers_of_any_length(draw, n, 12)
    b, d = big_integers_of_any_length(draw, n, 24), big_integers_of_any_length(draw, n, 24)
    return to_rows(
        radial=(leg * unit * turn, b, hypotenuse * unit * x, hypotenuse * unit * y),
        axial=(leg * tall, d, other * tall),
    )


RUNGS = 2 * (ULPS + 1)
"""The number of consecutive rows of one tangency: 1 ulp up, 1 down, 2 up, 2 down … 2^ULPS up, 2^ULPS down."""

FARTHEST = 52 - 8 - 1 - ULPS
"""The exponent of the longest ratio of a length to b or d at which 2^ULPS ulps of it are within about 2⁻⁸ radii."""


_starts = in_turn(
    _touching(double_roots.by_ratios, outer=True, farthest=FARTHEST),
    _touching(double_roots.by_angle, outer=False, farthest=FARTHEST),
    _touching(double_roots.by_angle, outer=True, farthest=FARTHEST),
    _touching(double_roots.by_ratios, outer=False, farthest=FARTHEST),
)


def ladder(draw: Draw, n: int) -> Rows:
    """Make RUNGS consecutive rows of each tangency; one nonzero length is moved by a different step in each of them."""
    count = -(-n // RUNGS)
    start = _starts(draw, count)
    chosen = draw.integers(count, 0, start.shape[1] - 1)
    index = np.arange(count)
    chosen = np.where(start[index, chosen] == 0, chosen % 4, chosen)
    rung = np.arange(n) % RUNGS
    steps = (ldexp(1, rung // 2) * turns(n, 1.0, -1.0)).astype(np.int64)
    rows = np.repeat(start, RUNGS, axis=0)[:n]
    column = np.repeat(chosen, RUNGS)[:n]
    place = np.arange(n)
    rows[place, column] = stepped(rows[place, column], steps)
    return rows


ring = in_turn(
    exact_maker(partial(double_roots.waist_roots, ring=True)),
    exact_maker(partial(double_roots.waist_roots_on_an_axis, ring=True)),
)


def ring_neighbourhood(draw: Draw, n: int) -> Rows:
    """Make rows 2⁻⁴⁰ … 2⁻⁶ radii from the ring, in its plane or out of it; every fourth has the tower's a and c."""
    tower = turns(n, True, False, False, False)
    a = np.where(tower, 8.0, draw.log_uniform(n, -3, 10))
    c = np.where(tower, 17.8 / 0.15, np.sqrt(a) * draw.log_uniform(n, 1, 8))
    radius = np.sqrt((c * c + 1) * (a * a / (c * c) + 1))
    step = draw.signed(n, -40, -6)
    height = np.where(turns(n, True, True, False), 0.0, draw.log_uniform(n, -40, -6))
    return random_pairs.centred(
        draw, random_pairs.sizes(draw, a, c), radius + np.where(turns(n, True, False, True), step, 0), height
    )


def osculation(draw: Draw, n: int) -> Rows:
    """Make rows with c² = a (1 ± 2⁻⁵⁰ … 2⁻³) and centres near r = a + 1 in or near the plane of the waist.

    Half of the centres have r near a + 1 and any small height; half are nearly one radius away from a point of the
    surface near the waist.
    """
    a = draw.log_uniform(n, -3, 12)
    c = np.sqrt(a * (1 + draw.signed(n, -50, -3)))
    height = np.where(turns(n, True, True, False, False, False), 0.0, draw.log_uniform(n, -24, -1))
    hair = draw.signed(n, -50, -3)
    free = a + 1 + hair, height
    bound = random_pairs.beside_surface(a, c, height, 1 + hair)
    here = turns(n, True, False)
    return random_pairs.centred(
        draw, random_pairs.sizes(draw, a, c), np.where(here, free[0], bound[0]), np.where(here, free[1], bound[1])
    )


def near_axis(draw: Draw, n: int) -> Rows:
    """Make rows with |a − 1| from 2⁻⁵⁰ to 2⁻³, r about |a − 1| or 0, z about √|a − 1| or 0: the ball fits tightly."""
    gap = draw.log_uniform(n, -50, -3)
    a = 1 + np.where(turns(n, True, False), gap, -gap)
    c = draw.log_uniform(n, -2, 7)
    radius = np.where(turns(n, False, True, True), gap * draw.between(n, 0, 2), 0.0)
    height = np.where(turns(n, True, True, True, False), np.sqrt(gap) * draw.between(n, 0, 3) * np.sqrt(1 + c * c), 0)
    return random_pairs.centred(draw, random_pairs.sizes(draw, a, c), radius, height)


def axis(draw: Draw, n: int) -> Rows:
    """Make rows with x = y = 0: at the origin, near the height from which on the ball fits in, and at any height."""
    a, c = random_pairs.all_regimes(draw, n)
    fits = np.sqrt(np.maximum((a * a + c * c) * (1 - a * a), 0)) / a
    hair = 1 + draw.signed(n, -50, -1)
    kind = turns(n, 0, 1, 1, 2, 2)
    height = np.where(kind == 0, 0.0, np.where(kind == 1, fits * hair, random_pairs.heights(draw, c)))
    return random_pairs.centred(draw, random_pairs.sizes(draw, a, c), np.zeros(n), height)


def waist(draw: Draw, n: int) -> Rows:
    """Make rows with z = 0: r is near |a − 1|, a + 1 or the r at which a ball leaves the groove's two sides, or any."""
    a, c = random_pairs.all_regimes(draw, n)
    both_flanks = np.sqrt((a * a + c * c) * (1 + 1 / (c * c)))
    hair = draw.signed(n, -50, -1)
    anywhere = 3 * a * draw.unit(n)
    places = [np.abs(a - 1) + hair, a + 1 + hair, both_flanks * (1 + hair), a + random_pairs.offsets(draw, n), anywhere]
    radius = np.choose(turns(n, *range(len(places))), places)
    return random_pairs.centred(draw, random_pairs.sizes(draw, a, c), np.abs(radius), np.zeros(n))


def regime_borders(draw: Draw, n: int) -> Rows:
    """Make rows with a = 1 or c² = a, exactly or one ulp of a size to either side, centres all around the surface."""
    aim = turns(n, True, False)
    b = draw.log_uniform(n, *random_pairs.UNITS)
    top, bottom = draw.integers(n, 1, 4095).astype(np.float64), draw.integers(n, 1, 4095).astype(np.float64)
    units = ldexp(1, draw.integers(n, -14, -10)), ldexp(1, draw.integers(n, -10, -6))
    size = random_pairs.Sizes(
        alpha=np.where(aim, b, top * top * units[0]),
        gamma=np.where(aim, draw.log_uniform(n, *random_pairs.UNITS), top * units[1]),
        b=np.where(aim, b, bottom * bottom * units[0]),
        d=np.where(aim, draw.log_uniform(n, *random_pairs.UNITS), bottom * units[1]),
    )
    rows = random_pairs.around(draw, size)
    # Six in a row: α and γ each exact, one ulp up, one ulp down; γ does not matter for a = 1.
    ulps = turns(n, 0, 0, 1, 1, -1, -1)
    column = np.where(aim | (draw.signs(n) < 0), 0, 1)
    index = np.arange(n)
    rows[index, column] = stepped(rows[index, column], ulps)
    return rows


def out_of_regime(draw: Draw, n: int) -> Rows:
    """Make rows with a < 1 or c² < a or both: balls stuck in the throat or in the groove, and clear ones."""
    return in_turn(_throat, _groove, _neither_condition)(draw, n)


def _throat(draw: Draw, n: int) -> Rows:
    """Make rows with a < 1: r up to 1.2 |1 − a|, heights up to twice that of a ball that is stuck in the throat."""
    a, c = draw.log_uniform(n, -5, 0) * 0.999, draw.log_uniform(n, -4, 3)
    stuck = np.sqrt((a * a + c * c) * (1 - a * a)) / a
    radius = np.abs(1 - a) * draw.between(n, 0, 1.2)
    return random_pairs.centred(draw, random_pairs.sizes(draw, a, c), radius, stuck * draw.between(n, 0, 2))


def _groove(draw: Draw, n: int) -> Rows:
    """Make rows with c² < a: r from the groove's bottom to a little beyond where the ball leaves both its sides."""
    a = draw.log_uniform(n, -3, 8)
    c = np.sqrt(a * draw.log_uniform(n, -8, 0) * 0.99)
    leaves = np.sqrt((a * a + c * c) * (1 + 1 / (c * c)))
    radius = a + 1 + (leaves - a - 1) * draw.between(n, -0.1, 1.5)
    height = np.where(turns(n, True, False), 0.0, c * draw.between(n, 0, 0.5))
    return random_pairs.centred(draw, random_pairs.sizes(draw, a, c), np.abs(radius), height)


def _neither_condition(draw: Draw, n: int) -> Rows:
    """Make rows with a < 1 and c² < a, centres all around the surface."""
    a = draw.log_uniform(n, -5, 0) * 0.999
    return random_pairs.around(draw, random_pairs.sizes(draw, a, np.sqrt(a * draw.log_uniform(n, -6, 0) * 0.99)))


@exact_maker
def second_coefficient_zero(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make rows with c2 = 0, which is (a − x)(a + x) = c² + y² + z² − 1.

    The first factor is a random rational number, the other one the right side divided by it.
    """
    unit, t = big_integers(draw, n, 1, 40), big_integers(draw, n, 1, 40)
    c, y, z = big_integers(draw, n, 1, 200), big_integers(draw, n, 0, 60), big_integers(draw, n, 0, 200)
    y, z = np.where(turns(n, True, False), 0, y), np.where(turns(n, True, True, False), z, 0)
    rest = c * c + y * y + z * z - unit * unit
    return to_rows(
        radial=(t * t + rest, 2 * unit * t, abs(t * t - rest), 2 * t * y),
        axial=(c, unit, z),
    )


@exact_maker
def first_coefficient_zero(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make rows with c1 = 0, which is x² + y² = (a e)² + 1 for the number e with (c e)² = c² + z² − 1.

    Both equations are solved as in second_coefficient_zero: (c e − z)(c e + z) = c² − 1, and likewise for a e and x.
    """
    c, unit, t = big_integers(draw, n, 1, 60), big_integers(draw, n, 1, 60), big_integers(draw, n, 1, 60)
    f = unit * unit - c * c - t * t  # c e = f/(2 unit t)
    y, u, s = big_integers(draw, n, 0, 60), big_integers(draw, n, 1, 60), big_integers(draw, n, 1, 60)
    k = u * u - y * y - s * s  # a e = k/(2 u s)
    return to_rows(
        radial=(
            abs(k) * 2 * c * t,
            2 * u * s * abs(f),
            abs((s * s + u * u - y * y) * f),
            2 * y * s * abs(f),
        ),
        axial=(2 * c * t, 2 * unit * t, abs(t * t + unit * unit - c * c)),
    )


@exact_maker
def first_coefficient_zero_for_any_waist(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make rows with c1 = 0 whatever a is: x² + y² = 1 and c² + z² = 1, the case e = 0 of first_coefficient_zero."""
    alpha, b = big_integers_of_any_length(draw, n, 20), big_integers_of_any_length(draw, n, 10)
    alpha = np.where(turns(n, True, True, False), alpha + b, alpha)
    x, y, turn = turned(draw, n)
    c, z, unit = triples(draw, n, 10)
    level = draw.signs(n) < 0
    return to_rows(
        radial=(alpha * turn, b * turn, b * x, b * y),
        axial=(np.where(level, 1, c), np.where(level, 1, unit), np.where(level, 0, z)),
    )


@exact_maker
def both_coefficients_zero(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make rows with c1 = c2 = 0: c² = a, z = 0, x² + y² = (c² − 1)² + c². All are in contact, and g = λ³ − a²c²."""
    c, unit = big_integers_of_any_length(draw, n, 12), big_integers_of_any_length(draw, n, 12)
    zero = np.zeros(n, dtype=object)
    return to_rows(radial=(c * c, unit * unit, abs(c * c - unit * unit), c * unit), axial=(c, unit, zero))


coefficient_zero = in_turn(
    second_coefficient_zero, first_coefficient_zero, first_coefficient_zero_for_any_waist, both_coefficients_zero
)


def _little(draw: Draw, n: int) -> Floats:
    """Return numbers ±2⁻¹⁰⁰⁰ … ±2⁻²⁰, half of them beyond ±2⁻⁶⁰, where rounding errors of an angle lie."""
    deep = draw.signs(n) > 0
    return draw.signs(n) * np.where(deep, draw.log_uniform(n, -1000, -60), draw.log_uniform(n, -60, -20))


NEARLY_ZERO = ("x", "y", "z", "xz", "yz", "xy")


def nearly_zero(draw: Draw, n: int) -> Rows:
    """Make pairs with one or two coordinates, those of NEARLY_ZERO in turn, nearly zero compared with the sizes."""
    x_is, y_is, z_is = (turns(n, *(axis in axes for axes in NEARLY_ZERO)) for axis in "xyz")
    a, c = random_pairs.all_regimes(draw, n)
    a = np.where(x_is & y_is, 1 + draw.signed(n, -20, -1), a)
    size = random_pairs.sizes(draw, a, c)
    hair = random_pairs.nearly_touching(draw, n, -40, -3)
    offset = np.where(draw.signs(n) > 0, random_pairs.offsets(draw, n), hair)
    height = np.where(z_is, 0.0, random_pairs.heights(draw, size.c))
    radius, height = random_pairs.beside_surface(size.a, size.c, height, offset)
    cosine, sine = draw.circle(n)
    x = np.where(x_is, _little(draw, n), radius * np.where(y_is, draw.signs(n), cosine))
    y = np.where(y_is, _little(draw, n), radius * np.where(x_is, draw.signs(n), sine))
    z = np.where(z_is, _little(draw, n), height * draw.signs(n))
    return random_pairs.stack(size, size.b * x, size.b * y, size.d * z)
