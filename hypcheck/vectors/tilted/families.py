"""Families of spheroids whose axis may point anywhere: rows of ten numbers, with the traps that a tilt adds.

First where the spheroid is put (beside a point of the surface, along M⁻¹ times the normal there), then rows that need
no more than that, then the families, those of exact coincidences (coincidences.py) among them.
"""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.rows import Floats, Rows
from hypcheck.vectors.draw import Draw, circle_at, in_turn, ldexp, turns
from hypcheck.vectors.family import Family
from hypcheck.vectors.random_pairs import Sizes, all_regimes, heights, offsets, sizes
from hypcheck.vectors.scenes import BODY, TOWER
from hypcheck.vectors.tilted import coincidences

Vectors = tuple[Floats, Floats, Floats]
"""x, y, z, each (n,)."""


def anywhere(draw: Draw, n: int) -> Vectors:
    """Unit vectors in every direction, some in the planes of the coordinates."""
    up = draw.between(n, -1, 1)
    cosine, sine = draw.circle(n)
    across = np.sqrt(1 - up * up)
    return across * cosine, across * sine, up


def beside(draw: Draw, size: Sizes, height: Floats, axis: Vectors, offset: Floats, *, on_x_axis: bool = False) -> Rows:
    """Rows whose centre is `offset` radii from the surface's point at `height` (in γ), outward positive.

    The way is M⁻¹ n, n being the normal there: with offset ±1 the spheroid touches the surface in that point, though it
    may cross it elsewhere.
    """
    n = len(height)
    cosine, sine = (draw.signs(n), np.zeros(n)) if on_x_axis else draw.circle(n)
    radius = np.sqrt(1 + height * height)
    point = (size.alpha * radius * cosine, size.alpha * radius * sine, size.gamma * height)
    normal = (radius * cosine / size.alpha, radius * sine / size.alpha, -height / size.gamma)
    length = np.sqrt(_dot(axis, axis))
    unit = (axis[0] / length, axis[1] / length, axis[2] / length)
    along = _dot(normal, unit)
    across = [n - along * v for n, v in zip(normal, unit, strict=True)]
    way = [size.b * size.b * q + size.d * size.d * along * v for q, v in zip(across, unit, strict=True)]
    half = np.sqrt(_dot(normal, (way[0], way[1], way[2])))
    return stack(size, [p + offset * w / half for p, w in zip(point, way, strict=True)], axis)


def _dot(one: Vectors, other: Vectors) -> Floats:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def stack(size: Sizes, centre: list[Floats], axis: Vectors) -> Rows:
    """The rows of these columns, without negative zeros."""
    return np.stack([size.alpha, size.gamma, size.b, size.d, *centre, *axis], axis=1) + 0.0


def _ordinary(draw: Draw, n: int) -> tuple[Sizes, Floats]:
    """Sizes of every regime, and heights in γ."""
    size = sizes(draw, *all_regimes(draw, n))
    return size, heights(draw, size.c) / size.c * draw.signs(n)


def _nearly(draw: Draw, n: int, low: int = -52, high: int = -4) -> Floats:
    """±1, and a little more or less."""
    return draw.signs(n) * (1 + draw.signs(n) * draw.log_uniform(n, low, high))


def uniform(draw: Draw, n: int) -> Rows:
    """All regimes, all directions, centres all around the surface."""
    size, height = _ordinary(draw, n)
    return beside(draw, size, height, anywhere(draw, n), offsets(draw, n))


def tower(draw: Draw, n: int) -> Rows:
    """The paper's body beside the wall of its tower, leaning up to 45° from the vertical to any side."""
    size = Sizes(*(np.full(n, value) for value in TOWER + BODY))
    cosine, sine = draw.circle(n)
    lean = draw.unit(n)
    axis = (lean * cosine, lean * sine, np.ones(n))
    offset = draw.signs(n) * (1 + draw.between(n, -0.75, 0.75) * turns(n, 1.0, 0.25, 2.0**-10))
    return beside(draw, size, draw.between(n, -1, 1), axis, offset)


def near_contact(draw: Draw, n: int) -> Rows:
    """From 2⁻⁵² to 2⁻⁴ radii off contact, everywhere."""
    size, height = _ordinary(draw, n)
    return beside(draw, size, height, anywhere(draw, n), _nearly(draw, n))


def horizontal(draw: Draw, n: int) -> Rows:
    """Near contact, the axis horizontal."""
    size, height = _ordinary(draw, n)
    cosine, sine = draw.circle(n)
    return beside(draw, size, height, (cosine, sine, np.zeros(n)), _nearly(draw, n))


def through_the_centre(draw: Draw, n: int) -> Rows:
    """Near contact but for a last turn: the axis points to the hyperboloid's centre."""
    rows = near_contact(draw, n)
    rows[:, 7:] = np.where((rows[:, 4:7] != 0).any(axis=1)[:, None], rows[:, 4:7], 1.0)
    return rows


def in_meridian_plane(draw: Draw, n: int) -> Rows:
    """Near contact, centre and axis in one plane with the hyperboloid's axis: y = 0 or x = 0 in both."""
    size, height = _ordinary(draw, n)
    up, across = circle_at(draw.unit(n))
    axis = (across * draw.signs(n), np.zeros(n), up)
    rows = beside(draw, size, height, axis, _nearly(draw, n), on_x_axis=True)
    swap = draw.signs(n) < 0
    rows[:, [4, 5]] = np.where(swap[:, None], rows[:, [5, 4]], rows[:, [4, 5]])
    rows[:, [7, 8]] = np.where(swap[:, None], rows[:, [8, 7]], rows[:, [7, 8]])
    return rows


def at_the_waist(draw: Draw, n: int) -> Rows:
    """Uniform, but the centre in the plane of the waist."""
    rows = uniform(draw, n)
    rows[:, 6] = 0.0
    return rows


def spheres(draw: Draw, n: int) -> Rows:
    """b = d: the axis means nothing."""
    size, height = _ordinary(draw, n)
    size = Sizes(size.alpha, size.c * size.b, size.b, size.b)
    return beside(draw, size, height, anywhere(draw, n), _nearly(draw, n))


def upright(draw: Draw, n: int) -> Rows:
    """The axis (0, 0, s), of any length and either sign."""
    size, height = _ordinary(draw, n)
    rows = beside(draw, size, height, (np.zeros(n), np.zeros(n), np.ones(n)), _nearly(draw, n))
    rows[:, 9] = draw.signs(n) * draw.log_uniform(n, -60, 60)
    return rows


def slight(draw: Draw, n: int) -> Rows:
    """Near contact, the axis off the vertical or off the horizontal by 2⁻¹⁰⁷⁴ to 2⁻¹."""
    size, height = _ordinary(draw, n)
    cosine, sine = draw.circle(n)
    little = np.where(turns(n, True, True, True, False), draw.log_uniform(n, -60, 0), draw.log_uniform(n, -1074, -60))
    standing = turns(n, True, True, False)
    across, up = np.where(standing, little, 1.0), np.where(standing, 1.0, little)
    return beside(draw, size, height, (across * cosine, across * sine, up * draw.signs(n)), _nearly(draw, n))


def stiff(draw: Draw, n: int) -> Rows:
    """Near contact, ratios of sizes up to 2²⁷, about 10⁸."""
    size = sizes(draw, draw.log_uniform(n, -14, 14), draw.log_uniform(n, -14, 14), units=(-13, 13))
    height = draw.signs(n) * draw.log_uniform(n, -20, 4)
    return beside(draw, size, height, anywhere(draw, n), _nearly(draw, n))


def any_length(draw: Draw, n: int) -> Rows:
    """Near contact, the axis as short and as long as float64 allows."""
    rows = near_contact(draw, n)
    length = draw.integers(n, -1073, 1023)
    rows[:, 7:] = ldexp(rows[:, 7:], np.where(turns(n, True, True, False), length, turns(n, -1073, 1023))[:, None])
    return rows + 0.0


def small_integers(draw: Draw, n: int) -> Rows:
    """Whole numbers as a person types them: sizes to 6, centres to 12, axes to 2."""
    whole = [draw.integers(n, 1, 6) for _ in range(4)] + [draw.integers(n, -12, 12) for _ in range(3)]
    axis = [draw.integers(n, -2, 2) for _ in range(3)]
    zero = (axis[0] == 0) & (axis[1] == 0) & (axis[2] == 0)
    return np.stack([*whole, np.where(zero, 1, axis[0]), *axis[1:]], axis=1).astype(np.float64)


def whole_domain(draw: Draw, n: int) -> Rows:
    """All that float64 holds: all lengths scaled by one power of two, to below the least normal number and beyond."""
    size = sizes(draw, draw.log_uniform(n, -6, 6), draw.log_uniform(n, -6, 6), units=(-3, 3))
    rows = beside(draw, size, draw.between(n, -2, 2), anywhere(draw, n), _nearly(draw, n, high=0))
    unit = np.where(turns(n, True, False), draw.integers(n, -1064, -1000), draw.integers(n, 900, 1008))
    rows[:, :7] = ldexp(rows[:, :7], unit[:, None])
    return np.concatenate([np.maximum(rows[:, :4], 5e-324), rows[:, 4:]], axis=1) + 0.0


TILTED_FAMILIES = (
    Family(
        name="tilted-uniform",
        version=1,
        title="ordinary sizes, axes in every direction, centres all around the surface",
        source="the four regimes of α/b against 1 and (γ/d)² against α/b in turn, directions uniform on the sphere",
        purpose="nothing special: a program that fails here has a plain error, or takes the spheroid for upright",
        game="anything that leans collides with air, or with nothing",
        drone="a pitching drone is answered as one that hovers",
        regimes="all four",
        make=uniform,
        tilted=True,
    ),
    Family(
        name="tilted-tower",
        version=1,
        title="the paper's quadcopter, pitching beside the wall of its tower",
        source="section 3.2 of the paper speaks of pitch and does not model it; axes up to 45° from the vertical",
        purpose="the answer of the upright spheroid is wrong for some percent of these rows",
        game="a vehicle that banks clips the wall that it seemed to miss",
        drone="leaning into the movement brings a rotor into the wall",
        regimes="α ≥ b and (γ/d)² ≥ α/b, the tower's",
        make=tower,
        tilted=True,
    ),
    Family(
        name="tilted-near-contact",
        version=1,
        title="from 2⁻⁵² to 2⁻⁴ radii off contact, axes in every direction",
        source="centres beside a point of the surface along M⁻¹ times the normal, where that point touches",
        purpose="measures how near to contact a program can still tell; eigenvectors lose digits here first",
        game="sliding along a wall on a slope stutters, or sinks into it",
        drone="a planned clearance of a millimetre is none",
        regimes="all four",
        make=near_contact,
        tilted=True,
    ),
    Family(
        name="tilted-tangent",
        version=1,
        title="exactly tangent, from inside and outside",
        source="rational rotations, Pythagorean triples for normal, axis and sizes: every number exact",
        purpose="f has a rational double root, and tangency is contact: a float answers it by luck",
        game="a leaning character at rest against a wall flickers between free and stuck",
        drone="the limit of the keep-out volume itself counts as clear",
        regimes="α > b and α < b",
        make=coincidences.tangent,
        tilted=True,
    ),
    Family(
        name="tilted-near-tangent",
        version=1,
        title="exact tangencies with one number moved by 1, 2, 4 … 2⁴⁰ ulp",
        source="tilted-tangent, one of the sizes, of the centre or of the axis moved",
        purpose="the last digits of each of the ten numbers decide",
        game="contact depends on where in the world the level is built",
        drone="an axis rounded to single precision changes the answer",
        regimes="α > b and α < b",
        make=coincidences.near_tangent,
        tilted=True,
    ),
    Family(
        name="tilted-crossing",
        version=1,
        title="a double root of f, but the surfaces cross",
        source="the construction of tilted-tangent, where the spheroid crosses the surface in its point of contact",
        purpose="a discriminant of 0 is not tangency: the double root may lie outside (λ₋, λ₊)",
        game="a ball pressed into a groove counts as resting on it",
        drone="a crossing taken for the limit of clearance",
        regimes="α > b and α < b",
        make=coincidences.crossing,
        tilted=True,
    ),
    Family(
        name="tilted-symmetric",
        version=1,
        title="axis horizontal, through the centre, or in the meridian plane; or the centre in the waist's plane",
        source="near contact, or uniform in the waist's plane",
        purpose="the quartic has a root at a pole, a component of the eigenbasis vanishes, a quotient is 0/0",
        game="a log that lies on the ground is not hit",
        drone="flying straight at the tower, pitching, is the ordinary case",
        regimes="all four",
        make=in_turn(in_meridian_plane, horizontal, through_the_centre, at_the_waist),
        tilted=True,
    ),
    Family(
        name="tilted-sphere",
        version=1,
        title="a sphere with any axis: the axis means nothing",
        source="b = d, near contact, axes in every direction",
        purpose="the answer is that of the seven numbers; a program that divides by 1/d² − 1/b² fails",
        game="a ball that spins changes its place",
        drone="a round body's answer depends on its heading",
        regimes="all four",
        make=spheres,
        tilted=True,
    ),
    Family(
        name="tilted-upright",
        version=1,
        title="axis (0, 0, s), of any length and either sign: upright",
        source="near contact, s from ±2⁻⁶⁰ to ±2⁶⁰",
        purpose="the answer is that of the seven numbers; a program that divides by the horizontal part fails",
        game="an object placed upright in the editor is lost",
        drone="hovering fails, pitching works",
        regimes="all four",
        make=upright,
        tilted=True,
    ),
    Family(
        name="tilted-slight",
        version=1,
        title="off the vertical or off the horizontal by 2⁻¹⁰⁷⁴ to 2⁻¹",
        source="near contact, such axes",
        purpose="the difference to the upright or horizontal answer is all that is asked; squares underflow",
        game="an object upright but for a rounding flickers",
        drone="the hovering drone's noise in pitch decides",
        regimes="all four",
        make=slight,
        tilted=True,
    ),
    Family(
        name="tilted-twins",
        version=1,
        title="the nearest point is not unique: two touch at once, or are as near as each other",
        source="pairs of points of contact, found by a search of small integers; the centre at the origin with α = b; "
        "centre and axis in one plane near the origin; the first two moved by ulps",
        purpose="an iteration converges to a saddle between the two, or to neither",
        game="a barrel jams in a throat without touching",
        drone="descending into the tower, both sides are near at once",
        regimes="all four",
        make=coincidences.twins,
        tilted=True,
    ),
    Family(
        name="tilted-ring",
        version=1,
        title="the ring, tilted: f has a double root at a pole, though nothing touches",
        source="small integers found by a search, with rational eigenvalues and the centre on an axis of symmetry; "
        "turned, scaled, three of four moved by ulps",
        purpose="the discriminant is 0 or changes its sign in free air",
        game="an invisible wall around the pillar",
        drone="an evasive manoeuvre where nothing is",
        regimes="α > b and α < b",
        make=coincidences.ring,
        tilted=True,
    ),
    Family(
        name="tilted-stiff",
        version=1,
        title="ratios of sizes up to 10⁸, near contact, axes in every direction",
        source="a = α/b, c = γ/d and b/d log-uniform",
        purpose="the 2×2 eigenproblem loses half of its digits before anything else is computed",
        game="a spear misses the pillar that it pierces",
        drone="a wire is not seen by a body in pitch",
        regimes="all four",
        make=stiff,
        tilted=True,
    ),
    Family(
        name="tilted-axis-length",
        version=1,
        title="near contact, axes as short and as long as float64 allows",
        source="tilted-near-contact, the axis times 2⁻¹⁰⁷³ to 2¹⁰²³",
        purpose="the length of the axis means nothing, but its square underflows or overflows",
        game="an axis computed from a cross product of small edges is lost",
        drone="a quaternion that is not normalised is refused or misread",
        regimes="all four",
        make=any_length,
        tilted=True,
    ),
    Family(
        name="tilted-small-integers",
        version=1,
        title="whole numbers as a person types them",
        source="sizes from 1 to 6, centres from −12 to 12, axes from −2 to 2",
        purpose="tangencies, rings, symmetric axes and centres on the surface abound",
        game="the first try of a user fails",
        drone="the first test of an integrator fails",
        regimes="all four",
        make=small_integers,
        tilted=True,
    ),
    Family(
        name="extreme-tilted",
        version=1,
        title="all lengths at the ends of float64, axes in every direction",
        source="ordinary pairs times 2⁻¹⁰⁶⁴ … 2⁻¹⁰⁰⁰ or 2⁹⁰⁰ … 2¹⁰⁰⁸",
        purpose="squares underflow and overflow; the answer does not change but for the rounding of subnormals",
        game="a scale factor that ran away is not seen",
        drone="units mixed up by powers of ten give an answer all the same",
        regimes="all four",
        extreme=True,
        make=whole_domain,
        tilted=True,
    ),
)
