"""Families at the borders of an argument's cases: regimes, planes and lines of symmetry, vanishing coefficients."""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.rows import Mask, Rows
from hypcheck.vectors.double_roots import big_integers, big_integers_of_any_length, to_rows, triples, turned
from hypcheck.vectors.draw import Draw, in_turn, ldexp, stepped, turns
from hypcheck.vectors.random_pairs import UNITS, Sizes, all_regimes, around, centred, heights, offsets, sizes
from hypcheck.vectors.tangency import exact_maker


def near_axis(draw: Draw, n: int) -> Rows:
    """a = 1 ± 2⁻⁵⁰ … 2⁻³, r and z as small as a − 1 and √|a − 1| are, or 0: the ball all but fills the throat."""
    gap = draw.log_uniform(n, -50, -3)
    a = 1 + np.where(turns(n, True, False), gap, -gap)
    c = draw.log_uniform(n, -2, 7)
    radius = np.where(turns(n, False, True, True), gap * draw.between(n, 0, 2), 0.0)
    height = np.where(turns(n, True, True, True, False), np.sqrt(gap) * draw.between(n, 0, 3) * np.sqrt(1 + c * c), 0)
    return centred(draw, sizes(draw, a, c), radius, height)


def axis(draw: Draw, n: int) -> Rows:
    """x = y = 0, at the origin, at heights near the one where the ball begins to fit, and anywhere."""
    a, c = all_regimes(draw, n)
    fits = np.sqrt(np.maximum((a * a + c * c) * (1 - a * a), 0)) / a
    hair = 1 + draw.signs(n) * draw.log_uniform(n, -50, -1)
    kind = turns(n, 0, 1, 1, 2, 2)
    height = np.where(kind == 0, 0.0, np.where(kind == 1, fits * hair, heights(draw, c)))
    return centred(draw, sizes(draw, a, c), np.zeros(n), height)


def waist(draw: Draw, n: int) -> Rows:
    """z = 0: near r = a − 1, a + 1 and the radius where a sphere too round for the groove leaves it, or anywhere."""
    a, c = all_regimes(draw, n)
    both_flanks = np.sqrt((a * a + c * c) * (1 + 1 / (c * c)))
    hair = draw.signs(n) * draw.log_uniform(n, -50, -1)
    anywhere = 3 * a * draw.unit(n)
    places = [np.abs(a - 1) + hair, a + 1 + hair, both_flanks * (1 + hair), a + offsets(draw, n), anywhere]
    radius = np.choose(turns(n, *range(len(places))), places)
    return centred(draw, sizes(draw, a, c), np.abs(radius), np.zeros(n))


def regime_borders(draw: Draw, n: int) -> Rows:
    """a = 1 and c² = a, exactly or one ulp of a size to either side, centres all around the surface."""
    aim = turns(n, True, False)
    b = draw.log_uniform(n, *UNITS)
    top, bottom = draw.integers(n, 1, 4095).astype(np.float64), draw.integers(n, 1, 4095).astype(np.float64)
    units = ldexp(1, draw.integers(n, -14, -10)), ldexp(1, draw.integers(n, -10, -6))
    size = Sizes(
        alpha=np.where(aim, b, top * top * units[0]),
        gamma=np.where(aim, draw.log_uniform(n, *UNITS), top * units[1]),
        b=np.where(aim, b, bottom * bottom * units[0]),
        d=np.where(aim, draw.log_uniform(n, *UNITS), bottom * units[1]),
    )
    rows = around(draw, size)
    # Six in a row: α and γ each exact, one ulp up, one ulp down; γ makes no difference to a = 1.
    ulps = turns(n, 0, 0, 1, 1, -1, -1)
    column = np.where(aim | (draw.signs(n) < 0), 0, 1)
    index = np.arange(n)
    rows[index, column] = stepped(rows[index, column], ulps)
    return rows


def out_of_regime(draw: Draw, n: int) -> Rows:
    """a < 1 or c² < a or both: spheres stuck in the throat, spheres on both flanks of the groove, and clear ones."""
    return in_turn(_throat, _groove, _neither_condition)(draw, n)


def _throat(draw: Draw, n: int) -> Rows:
    """a < 1: up to 1.2 times as far out, and twice as high, as a sphere is stuck."""
    a, c = draw.log_uniform(n, -5, 0) * 0.999, draw.log_uniform(n, -4, 3)
    stuck = np.sqrt((a * a + c * c) * (1 - a * a)) / a
    radius = np.abs(1 - a) * draw.between(n, 0, 1.2)
    return centred(draw, sizes(draw, a, c), radius, stuck * draw.between(n, 0, 2))


def _groove(draw: Draw, n: int) -> Rows:
    """c² < a: from the bottom of the groove to a little beyond where the sphere leaves its flanks."""
    a = draw.log_uniform(n, -3, 8)
    c = np.sqrt(a * draw.log_uniform(n, -8, 0) * 0.99)
    leaves = np.sqrt((a * a + c * c) * (1 + 1 / (c * c)))
    radius = a + 1 + (leaves - a - 1) * draw.between(n, -0.1, 1.5)
    height = np.where(turns(n, True, False), 0.0, c * draw.between(n, 0, 0.5))
    return centred(draw, sizes(draw, a, c), np.abs(radius), height)


def _neither_condition(draw: Draw, n: int) -> Rows:
    """a < 1 and c² < a, centres all around the surface."""
    a = draw.log_uniform(n, -5, 0) * 0.999
    return around(draw, sizes(draw, a, np.sqrt(a * draw.log_uniform(n, -6, 0) * 0.99)))


def second_coefficient_zero(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """c2 = 0: (a − x)(a + x) = c² + y² + z² − 1, split as τ and the rest over τ."""
    unit, t = big_integers(draw, n, 1, 40), big_integers(draw, n, 1, 40)
    c, y, z = big_integers(draw, n, 1, 200), big_integers(draw, n, 0, 60), big_integers(draw, n, 0, 200)
    y, z = np.where(turns(n, True, False), 0, y), np.where(turns(n, True, True, False), z, 0)
    rest = c * c + y * y + z * z - unit * unit
    return to_rows(
        radial=(t * t + rest, 2 * unit * t, abs(t * t - rest), 2 * t * y),
        axial=(c, unit, z),
    )


def first_coefficient_zero(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """c1 = 0: x² + y² = a² e² + 1 with c² e² = c² + z² − 1; both equations split like the one above."""
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


def first_coefficient_zero_for_any_waist(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """c1 = 0 whatever a is: x² + y² = 1 and c² + z² = 1, e = 0 above."""
    alpha, b = big_integers_of_any_length(draw, n, 20), big_integers_of_any_length(draw, n, 10)
    alpha = np.where(turns(n, True, True, False), alpha + b, alpha)
    x, y, turn = turned(draw, n)
    c, z, unit = triples(draw, n, 10)
    level = draw.signs(n) < 0
    return to_rows(
        radial=(alpha * turn, b * turn, b * x, b * y),
        axial=(np.where(level, 1, c), np.where(level, 1, unit), np.where(level, 0, z)),
    )


def both_coefficients_zero(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """c1 = c2 = 0, g = λ³ − a²c²: c² = a, z = 0 and x² + y² = (c² − 1)² + c²; always contact."""
    c, unit = big_integers_of_any_length(draw, n, 12), big_integers_of_any_length(draw, n, 12)
    zero = np.zeros(n, dtype=object)
    return to_rows(radial=(c * c, unit * unit, abs(c * c - unit * unit), c * unit), axial=(c, unit, zero))


coefficient_zero = in_turn(
    exact_maker(second_coefficient_zero),
    exact_maker(first_coefficient_zero),
    exact_maker(first_coefficient_zero_for_any_waist),
    exact_maker(both_coefficients_zero),
)
