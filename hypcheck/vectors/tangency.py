"""Families of exact tangencies and other double roots, and of the ring, with rows beside them.

Beside a tangency there is a hair's breadth, and a ladder of ulps: every power of two from 1 to 2⁴⁰, on both sides, one
after the other. On the ring Δ = 0 though nothing touches; where c² = a the sphere has the groove's own curvature.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hypcheck.geometry.rows import Floats, Mask, Rows
from hypcheck.vectors import double_roots
from hypcheck.vectors.double_roots import (
    ULPS,
    DoubleRoots,
    big_integers_of_any_length,
    gather,
    in_metres,
    one_moved,
    to_rows,
    triples,
    turned,
)
from hypcheck.vectors.draw import Draw, Integers, Maker, exponent, in_turn, ldexp, stepped, turns
from hypcheck.vectors.random_pairs import beside_surface, centred, sizes


def exact_maker(construction: Callable[[Draw, int], tuple[Rows, Mask]]) -> Maker:
    """The generator of a construction of rows and which of them are usable."""
    return lambda draw, n: in_metres(draw, gather(draw, n, construction))


def _touching(construction: Callable[[Draw, int], DoubleRoots], *, outer: bool, tangent: bool) -> Maker:
    """The generator of those double roots that are wanted."""

    def attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
        found = construction(draw, n)
        return found.rows, found.usable & (found.outer == outer) & (found.tangent == tangent)

    return exact_maker(attempt)


def two_points(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Tangencies at two points, c² < a."""
    return double_roots.waist_roots(draw, n, ring=False)


def two_points_on_an_axis(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """The same with the centre on the x or y axis."""
    return double_roots.waist_roots_on_an_axis(draw, n, ring=False)


tangent = in_turn(
    _touching(double_roots.by_ratios, outer=True, tangent=True),
    _touching(double_roots.by_angle, outer=False, tangent=True),
    exact_maker(double_roots.osculations),
    exact_maker(double_roots.throat_circles),
    exact_maker(two_points),
    exact_maker(double_roots.waist_points),
    _touching(double_roots.by_angle, outer=True, tangent=True),
    _touching(double_roots.by_ratios, outer=False, tangent=True),
    exact_maker(two_points_on_an_axis),
)

degenerate_crossing = in_turn(
    _touching(double_roots.by_angle, outer=False, tangent=False),  # nodes of the throat
    _touching(double_roots.by_angle, outer=True, tangent=False),  # nodes of the groove and isolated points
    exact_maker(double_roots.cusps),
    _touching(double_roots.by_ratios, outer=True, tangent=False),
)


def ulps_away(draw: Draw, rows: Rows) -> Rows:
    """The rows with one length each, any but a zero, moved by 1, 2, 4 … or 2^ULPS ulp to either side.

    Fewer where so many would be more than about 2⁻⁸ radii, so that no row is carried right through the surface.
    """
    n = len(rows)
    most = np.minimum(ULPS, 52 - 8 - 1 - reach(rows))
    return one_moved(draw, rows, ldexp(draw.signs(n), draw.integers(n, 0, ULPS) % (most + 1)).astype(np.int64))


def near_tangent(*, outer: bool) -> Maker:
    """Tangencies of one side, half of them moved by ulps, half along the normal by 2⁻⁵⁰ to 2⁻⁹ radii, out or in."""

    def beside(construction: Callable[[Draw, int], DoubleRoots]) -> Maker:
        def attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
            found = construction(draw, n)
            usable = found.usable & (found.outer == outer) & found.tangent
            rows = np.where(usable[:, None], found.rows, 1.0)
            along = _along_the_normal(rows, found.sine, _small(draw, n), outer=outer)
            by_ulps = draw.signs(n) < 0
            return np.where(by_ulps[:, None], ulps_away(draw, rows), along), usable

        return exact_maker(attempt)

    return in_turn(beside(double_roots.by_ratios), beside(double_roots.by_angle))


def _small(draw: Draw, n: int) -> Floats:
    return draw.signs(n) * draw.log_uniform(n, -50, -9)


def _along_the_normal(rows: Rows, sine: Floats, step: Floats, *, outer: bool) -> Rows:
    """The centre moved by `step` radii away from the point it touches; its radius and height are ≥ 0."""
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
    """Degenerate crossings moved by ulps: contact on both sides, though Δ changes its sign."""
    return ulps_away(draw, degenerate_crossing(draw, n))


def centres_on_surface(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """The centre on the surface: r/α and z/γ are hypotenuse/leg and other leg/leg of one triple."""
    leg, other, hypotenuse = triples(draw, n, 12)
    x, y, turn = turned(draw, n)
    unit, tall = big_integers_of_any_length(draw, n, 12), big_integers_of_any_length(draw, n, 12)
    b, d = big_integers_of_any_length(draw, n, 24), big_integers_of_any_length(draw, n, 24)
    return to_rows(
        radial=(leg * unit * turn, b, hypotenuse * unit * x, hypotenuse * unit * y),
        axial=(leg * tall, d, other * tall),
    )


on_surface = exact_maker(centres_on_surface)


RUNGS = 2 * (ULPS + 1)
"""Consecutive rows of one tangency: 1 ulp up, 1 down, 2 up, 2 down … 2^ULPS up, 2^ULPS down."""

FARTHEST = 52 - 8 - 1 - ULPS
"""The exponent of the longest ratio of a length to b or d at which 2^ULPS ulps of it are within about 2⁻⁸ radii."""


def tangencies(construction: Callable[[Draw, int], DoubleRoots], *, outer: bool) -> Maker:
    """Tangencies of one side, near enough for the whole ladder."""

    def attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
        found = construction(draw, n)
        usable = found.usable & found.tangent & (found.outer == outer)
        rows = np.where(usable[:, None], found.rows, 1.0)
        return rows, usable & (reach(rows) <= FARTHEST)

    return lambda draw, n: in_metres(draw, gather(draw, n, attempt))


def reach(rows: Rows) -> Integers:
    """The exponent of the longest of α/b, |x|/b, |y|/b and |z|/d: what a relative change is multiplied with in radii.

    γ is left out: it moves the surface by no more than r and α together.
    """
    alpha, _, b, d, x, y, z = np.abs(rows).T
    return np.maximum(exponent(np.maximum(np.maximum(alpha, x), y) / b), exponent(z / d))


_starts = in_turn(
    tangencies(double_roots.by_ratios, outer=True),
    tangencies(double_roots.by_angle, outer=False),
    tangencies(double_roots.by_angle, outer=True),
    tangencies(double_roots.by_ratios, outer=False),
)


def ladder(draw: Draw, n: int) -> Rows:
    """RUNGS rows of each tangency in turn, one length of it moved, any but a zero."""
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


def ring_anywhere(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """The ring for any rational a and c."""
    return double_roots.waist_roots(draw, n, ring=True)


def ring_on_an_axis(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """The ring with the centre on the x or y axis."""
    return double_roots.waist_roots_on_an_axis(draw, n, ring=True)


ring = in_turn(exact_maker(ring_anywhere), exact_maker(ring_on_an_axis))


def ring_neighbourhood(draw: Draw, n: int) -> Rows:
    """Up to 2⁻⁴⁰ … 2⁻⁶ radii from the ring, in its plane or out of it; every fourth row has the tower's ratios."""
    tower = turns(n, True, False, False, False)
    a = np.where(tower, 8.0, draw.log_uniform(n, -3, 10))
    c = np.where(tower, 17.8 / 0.15, np.sqrt(a) * draw.log_uniform(n, 1, 8))
    radius = np.sqrt((c * c + 1) * (a * a / (c * c) + 1))
    step = draw.signs(n) * draw.log_uniform(n, -40, -6)
    height = np.where(turns(n, True, True, False), 0.0, draw.log_uniform(n, -40, -6))
    return centred(draw, sizes(draw, a, c), radius + np.where(turns(n, True, False, True), step, 0), height)


def osculation(draw: Draw, n: int) -> Rows:
    """c² = a (1 ± 2⁻⁵⁰ … 2⁻³) and centres near r = a + 1 in or near the plane of the waist.

    Half stand in the plane or above it at random, half one radius (1 ± a hair) off a point of the groove's bottom.
    """
    a = draw.log_uniform(n, -3, 12)
    c = np.sqrt(a * (1 + draw.signs(n) * draw.log_uniform(n, -50, -3)))
    height = np.where(turns(n, True, True, False, False, False), 0.0, draw.log_uniform(n, -24, -1))
    hair = draw.signs(n) * draw.log_uniform(n, -50, -3)
    free = a + 1 + hair, height
    bound = beside_surface(a, c, height, 1 + hair)
    here = turns(n, True, False)
    return centred(draw, sizes(draw, a, c), np.where(here, free[0], bound[0]), np.where(here, free[1], bound[1]))
