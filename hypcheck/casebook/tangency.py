"""Exact tangencies and other double roots, and what lies a hair's breadth beside them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hypcheck.casebook import double_roots
from hypcheck.casebook.double_roots import DoubleRoots
from hypcheck.casebook.draw import Draw, Floats, Maker, exponent, in_turn, ldexp, stepped
from hypcheck.casebook.exactly import Mask, gather, in_metres, to_rows, triples, turned, wholes_of_any_length
from hypcheck.casebook.family import Family
from hypcheck.rows import Rows

ULPS = 40
"""Near misses lie 1, 2, 4 … 2^ULPS ulp away."""


def exactly(construction: Callable[[Draw, int], tuple[Rows, Mask]]) -> Maker:
    """The generator of a construction of rows and which of them are usable."""
    return lambda draw, n: in_metres(draw, gather(draw, n, construction))


def _touching(construction: Callable[[Draw, int], DoubleRoots], *, outer: bool, tangent: bool) -> Maker:
    """The generator of those double roots that are wanted."""

    def attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
        found = construction(draw, n)
        return found.rows, found.usable & (found.outer == outer) & (found.tangent == tangent)

    return exactly(attempt)


def two_points(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Tangencies at two points, c² < a."""
    return double_roots.waist_roots(draw, n, ring=False)


def two_points_on_an_axis(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """The same with the centre on the x or y axis."""
    return double_roots.waist_roots_on_an_axis(draw, n, ring=False)


tangent = in_turn(
    _touching(double_roots.by_ratios, outer=True, tangent=True),
    _touching(double_roots.by_angle, outer=False, tangent=True),
    exactly(double_roots.osculations),
    exactly(double_roots.throat_circles),
    exactly(two_points),
    exactly(double_roots.waist_points),
    _touching(double_roots.by_angle, outer=True, tangent=True),
    _touching(double_roots.by_ratios, outer=False, tangent=True),
    exactly(two_points_on_an_axis),
)

degenerate_crossing = in_turn(
    _touching(double_roots.by_angle, outer=False, tangent=False),  # nodes of the throat
    _touching(double_roots.by_angle, outer=True, tangent=False),  # nodes of the groove and isolated points
    exactly(double_roots.cusps),
    _touching(double_roots.by_ratios, outer=True, tangent=False),
)


def ulps_away(draw: Draw, rows: Rows) -> Rows:
    """The rows with one length each, any but a zero, moved by 1, 2, 4 … or 2^ULPS ulp to either side.

    Fewer where so many would be more than about 2⁻⁸ radii, so that no row is carried right through the surface.
    """
    n = len(rows)
    alpha, _, b, d, x, y, z = np.abs(rows).T
    reach = np.maximum(exponent(np.maximum(np.maximum(alpha, x), y) / b), exponent(z / d))
    most = np.minimum(ULPS, 52 - 8 - 1 - reach)
    steps = ldexp(draw.signs(n), draw.integers(n, 0, ULPS) % (most + 1)).astype(np.int64)
    chosen = draw.integers(n, 0, rows.shape[1] - 1)
    index = np.arange(n)
    chosen = np.where(rows[index, chosen] == 0, chosen % 4, chosen)
    moved = rows.copy()
    moved[index, chosen] = stepped(rows[index, chosen], steps)
    return moved


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

        return exactly(attempt)

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


def on_surface(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """The centre on the surface: r/α and z/γ are hypotenuse/leg and other leg/leg of one triple."""
    leg, other, hypotenuse = triples(draw, n, 12)
    x, y, turn = turned(draw, n)
    unit, tall = wholes_of_any_length(draw, n, 12), wholes_of_any_length(draw, n, 12)
    b, d = wholes_of_any_length(draw, n, 24), wholes_of_any_length(draw, n, 24)
    return to_rows(
        radial=(leg * unit * turn, b, hypotenuse * unit * x, hypotenuse * unit * y),
        axial=(leg * tall, d, other * tall),
    )


FAMILIES = (
    Family(
        name="tangent",
        version=1,
        title="exactly tangent, in every way there is",
        source="double roots of g placed at will: at a point from inside and outside, along a circle, "
        "at two points, osculating",
        purpose="Δ is 0 exactly, and tangency is contact: the answer every float formula gets by luck",
        game="a character at rest against a wall flickers between free and stuck",
        drone="the limit of the keep-out volume itself counts as clear",
        regimes="all four",
        make=tangent,
    ),
    Family(
        name="near-tangent-outside",
        version=1,
        title="just clear of the outside, or just not",
        source="exact exterior tangencies moved by 1, 2, 4 … 2⁴⁰ ulp, or along the normal by 1e-15 to 1e-3 radii",
        purpose="measures how near to contact a program can still tell; backward errors show here first",
        game="sliding along a trunk stutters, or sinks into it",
        drone="a planned clearance of a millimetre is none",
        regimes="all four",
        make=near_tangent(outer=True),
    ),
    Family(
        name="near-tangent-inside",
        version=1,
        title="just clear of the inside, or just not",
        source="exact interior tangencies moved by 1, 2, 4 … 2⁴⁰ ulp, or along the normal by 1e-15 to 1e-3 radii",
        purpose="measures how near to contact a program can still tell from within, where two negative roots meet",
        game="a flyer hugging the shell from inside leaves it",
        drone="an inspection drone's last millimetre to the shell is answered by chance",
        regimes="all four",
        make=near_tangent(outer=False),
    ),
    Family(
        name="degenerate-crossing",
        version=1,
        title="double roots that are no tangency",
        source="docs/mathematics.md, root patterns: curves with a node, an isolated point or a cusp",
        purpose="Δ = 0 and a real double root, yet the surfaces cross: reading tangency off Δ alone is wrong",
        game="an overlap is taken for a touch, and pushed out the wrong way",
        drone="a collision is logged as a graze",
        regimes="a < 1 or c² < a",
        make=degenerate_crossing,
    ),
    Family(
        name="degenerate-neighbourhood",
        version=1,
        title="beside double roots that are no tangency",
        source="rows of the family degenerate-crossing with one length moved by 1, 2, 4 … 2⁴⁰ ulp",
        purpose="Δ changes its sign here but the answer does not: Δ > 0 with three roots of one sign is contact",
        game="a deep overlap reads as clear on one side of nowhere",
        drone="a collision in progress is accepted as a valid movement",
        regimes="a < 1 or c² < a",
        make=degenerate_neighbourhood,
    ),
    Family(
        name="on-surface",
        version=1,
        title="centres exactly on the surface",
        source="rational points of the hyperboloid from Pythagorean triples",
        purpose="the distance is 0 and so is the nearest-point multiplier: code that divides by either breaks",
        game="a spawn point on the surface makes an object explode or vanish",
        drone="a waypoint marked on the shell itself is answered with NaN",
        regimes="all four",
        make=exactly(on_surface),
    ),
)
