"""Where Δ = 0 though nothing touches, where the sphere has the groove's own curvature, and what lies around both."""

from __future__ import annotations

import numpy as np

from hypcheck.casebook import double_roots
from hypcheck.casebook.draw import Draw, in_turn, turns
from hypcheck.casebook.exactly import Mask
from hypcheck.casebook.family import Family
from hypcheck.casebook.placing import beside_surface, centred, sizes
from hypcheck.casebook.tangency import exactly
from hypcheck.rows import Rows


def ring_anywhere(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """The ring for any rational a and c."""
    return double_roots.waist_roots(draw, n, ring=True)


def ring_on_an_axis(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """The ring with the centre on the x or y axis."""
    return double_roots.waist_roots_on_an_axis(draw, n, ring=True)


ring = in_turn(exactly(ring_anywhere), exactly(ring_on_an_axis))


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


FAMILIES = (
    Family(
        name="ring",
        version=1,
        title="clear, with Δ = 0",
        source="z = 0 and r² = (c² + 1)(a² + c²)/c² with c² > a: the paper's Propositions 3 and 5 call it contact",
        purpose="g has a double root that is no tangency, far from the surface: Procedure 1 refuses a valid movement",
        game="an invisible wall rings the trunk at some distance, just where the ground is level with its waist",
        drone="a level approach is refused in free air, a metre or more from the tower",
        regimes="c² > a",
        make=ring,
    ),
    Family(
        name="ring-neighbourhood",
        version=1,
        title="clear, with Δ next to 0",
        source="10⁻¹² to 10⁻² radii from the ring, in the waist's plane or beside it; the tower's ratios among them",
        purpose="rounding gives the ring a thickness: in float32 it is up to a tenth of a radius",
        game="the invisible wall is thick enough to be met every day",
        drone="the refused region is as wide as the drone's own position noise",
        regimes="c² > a",
        make=ring_neighbourhood,
    ),
    Family(
        name="osculation",
        version=1,
        title="a sphere that fits the groove",
        source="c² = a (1 ± 2⁻⁵⁰ … 2⁻³), centres near r = a + 1 and z = 0",
        purpose="three roots meet at c², so rounding in the coefficients is magnified by its cube root",
        game="a ball resting in a groove of its own curvature jitters",
        drone="docking at a saddle that fits the drone is where the distance is least certain",
        regimes="c² on both sides of a, within 1/8",
        make=osculation,
    ),
)
