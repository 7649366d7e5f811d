"""Spheroids whose axis has any direction: rows of ten numbers, with the traps that a tilt adds.

First the placing of the spheroid (beside a point of the surface, along M⁻¹ times the normal there), and rows that need
only this. Then exact coincidences: tangencies and other double roots, twins and rings, and rows near to them.

**Double roots.** M is the matrix of the spheroid, D = diag(1/α², 1/α², −1/γ²). Let n̂ = (n1, 0, n3)/N be a normal, the
axis v̂ = (p n̂ + q ê)/S with ê ⟂ n̂ of length 1, and Σ = M⁻¹ = b² I + (d² − b²) v̂ v̂ᵀ. With b q = f c4 S and d p = f s4 S

    n̂ᵀ Σ n̂ = (b q/S)² + (d p/S)² = (f h4)²,    Σ n̂ = f² (h4² n̂ + (s4² q/p − c4² p/q) ê).

With α n1 = w h5 and γ |n3| = w s5 the surface has the normal n̂ at X = (w h5²/(n1 c5), 0, −w s5²/(n3 c5)). So with the
centre X ± Σ n̂/(f h4) the surfaces touch at X, and the quartic of the pair (truth/pencil.py) has the double root
λ = ± w c5/(f h4 N). All is rational if (n1, n3, N), (p, q, S), (c4, s4, h4), (c5, s5, h5) and the two numbers of ê are
legs and hypotenuses. The pair is tangent if and only if M + λD is positive semidefinite there. At last the pair is
turned by a rational angle about the hyperboloid's axis.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hypcheck import toml
from hypcheck.geometry.arithmetic import dot
from hypcheck.geometry.pair import TILTED_COLUMNS
from hypcheck.geometry.rows import Floats, Mask, Rows
from hypcheck.vectors import coincidences
from hypcheck.vectors.double_roots import (
    ULPS,
    BigIntegers,
    big_integers_of_any_length,
    gather,
    gathered,
    in_lowest_terms,
    one_moved,
    triples,
    turned,
)
from hypcheck.vectors.draw import Draw, Maker, circle_at, in_turn, ldexp, stepped, turns
from hypcheck.vectors.random_pairs import (
    BODY,
    TOWER,
    Sizes,
    each_with_one_number_changed,
    heights,
    nearly_touching,
    offsets,
    sizes,
    sizes_of_all_regimes,
)

Vectors = tuple[Floats, Floats, Floats]
"""x, y, z, each (n,)."""


def anywhere(draw: Draw, n: int) -> Vectors:
    """Draw unit vectors in every direction, some in the planes of the coordinates."""
    up = draw.between(n, -1, 1)
    cosine, sine = draw.circle(n)
    across = np.sqrt(1 - up * up)
    return across * cosine, across * sine, up


def beside(draw: Draw, size: Sizes, height: Floats, axis: Vectors, offset: Floats, *, on_x_axis: bool = False) -> Rows:
    """Make rows whose centre is `offset` radii from the surface's point at `height` (in γ), outward positive.

    The direction is M⁻¹ n, n being the normal there and M the spheroid's matrix: with offset ±1 the spheroid touches
    the surface in that point, though it may cross it elsewhere.
    """
    n = len(height)
    cosine, sine = (draw.signs(n), np.zeros(n)) if on_x_axis else draw.circle(n)
    return beside_at(size, (cosine, sine), height, axis, offset)


def beside_at(size: Sizes, direction: tuple[Floats, Floats], height: Floats, axis: Vectors, offset: Floats) -> Rows:
    """Make rows as beside does, for the surface's point in this direction (cosine, sine) from the axis."""
    cosine, sine = direction
    radius = np.sqrt(1 + height * height)
    point = (size.alpha * radius * cosine, size.alpha * radius * sine, size.gamma * height)
    normal = (radius * cosine / size.alpha, radius * sine / size.alpha, -height / size.gamma)
    return touching(size, axis, point, normal, offset)


def touching(size: Sizes, axis: Vectors, point: Vectors, normal: Vectors, factor: Floats) -> Rows:
    """Make rows whose centre is `factor` times as far from the point as where the spheroid touches a plane there.

    The plane goes through the point, at right angles to the normal; the centre is on the side of the normal.
    """
    length = np.sqrt(dot(axis, axis))
    unit = (axis[0] / length, axis[1] / length, axis[2] / length)
    along = dot(normal, unit)
    across = [n - along * v for n, v in zip(normal, unit, strict=True)]
    reach = [size.b * size.b * q + size.d * size.d * along * v for q, v in zip(across, unit, strict=True)]
    half = np.sqrt(dot(normal, reach))
    return stack(size, [p + factor * w / half for p, w in zip(point, reach, strict=True)], axis)


def stack(size: Sizes, centre: list[Floats], axis: Vectors) -> Rows:
    """Make the rows of these columns, without negative zeros."""
    return np.stack([size.alpha, size.gamma, size.b, size.d, *centre, *axis], axis=1) + 0.0


Shapes = Callable[[Draw, int], tuple[Sizes, Floats]]
"""The type of a function that draws sizes, and heights in γ of points of the surface."""

Axes = Callable[[Draw, int], Vectors]
"""The type of a function that draws axes, of any length."""


def _ordinary(draw: Draw, n: int) -> tuple[Sizes, Floats]:
    """Draw sizes of every regime, and heights in γ."""
    size = sizes_of_all_regimes(draw, n)
    return size, heights(draw, size.c) / size.c * draw.signs(n)


def near_surface(
    shapes: Shapes = _ordinary, axes: Axes = anywhere, offsets: Callable[[Draw, int], Floats] = nearly_touching
) -> Maker:
    """Return the generator of rows beside the surface: it draws sizes and heights first, then axes, then offsets."""

    def make(draw: Draw, n: int) -> Rows:
        size, height = shapes(draw, n)
        return beside(draw, size, height, axes(draw, n), offsets(draw, n))

    return make


uniform = near_surface(offsets=offsets)
"""The generator of rows in all regimes, with axes in all directions and centres all around the surface."""

near_contact = near_surface()
"""The generator of rows 2⁻⁵² to 2⁻⁴ radii off contact, all over the surface."""


def tower(draw: Draw, n: int) -> Rows:
    """Make rows of the paper's body beside the wall of its tower, tilted up to 45° from the vertical to any side."""
    size = Sizes(*(np.full(n, value) for value in TOWER + BODY))
    cosine, sine = draw.circle(n)
    lean = draw.unit(n)
    axis = (lean * cosine, lean * sine, np.ones(n))
    offset = draw.signs(n) * (1 + draw.between(n, -0.75, 0.75) * turns(n, 1.0, 0.25, 2.0**-10))
    return beside(draw, size, draw.between(n, -1, 1), axis, offset)


def one_number_changed(draw: Draw, n: int) -> Rows:
    """Make rows as in random_pairs; the three numbers of the axis change, too."""
    columns = range(len(TILTED_COLUMNS))
    make = near_surface(offsets=lambda draw, n: nearly_touching(draw, n, -14, -6))
    rows = make(draw, -(-n // (2 * len(columns))))
    return each_with_one_number_changed(draw, rows, columns, n, centres=3)


def _level(draw: Draw, n: int) -> Vectors:
    """Draw horizontal axes."""
    cosine, sine = draw.circle(n)
    return cosine, sine, np.zeros(n)


def through_the_centre(draw: Draw, n: int) -> Rows:
    """Make rows near contact and replace the axis by one that points to the hyperboloid's centre."""
    rows = near_contact(draw, n)
    rows[:, 7:] = np.where((rows[:, 4:7] != 0).any(axis=1)[:, None], rows[:, 4:7], 1.0)
    return rows


def in_meridian_plane(draw: Draw, n: int) -> Rows:
    """Make rows near contact with centre and axis in one plane with the hyperboloid's axis: y = 0 or x = 0 in both."""
    size, height = _ordinary(draw, n)
    up, across = circle_at(draw.unit(n))
    axis = (across * draw.signs(n), np.zeros(n), up)
    rows = beside(draw, size, height, axis, nearly_touching(draw, n), on_x_axis=True)
    swap = draw.signs(n) < 0
    rows[:, [4, 5]] = np.where(swap[:, None], rows[:, [5, 4]], rows[:, [4, 5]])
    rows[:, [7, 8]] = np.where(swap[:, None], rows[:, [8, 7]], rows[:, [7, 8]])
    return rows


def at_the_waist(draw: Draw, n: int) -> Rows:
    """Make rows as `uniform` does, with the centre in the plane of the waist."""
    rows = uniform(draw, n)
    rows[:, 6] = 0.0
    return rows


symmetric = in_turn(in_meridian_plane, near_surface(axes=_level), through_the_centre, at_the_waist)


def _spheres(draw: Draw, n: int) -> tuple[Sizes, Floats]:
    """Draw sizes and heights as _ordinary does, with b = d."""
    size, height = _ordinary(draw, n)
    return Sizes(size.alpha, size.c * size.b, size.b, size.b), height


spheres = near_surface(_spheres)
"""The generator of rows near contact whose spheroid is a sphere, so that the axis does not matter."""


def vertical(_: Draw, n: int) -> Vectors:
    """Return the axis (0, 0, 1) n times."""
    return np.zeros(n), np.zeros(n), np.ones(n)


def upright(draw: Draw, n: int) -> Rows:
    """Make rows near contact with a vertical axis (0, 0, s), |s| from 2⁻⁶⁰ to 2⁶⁰, of either sign."""
    rows = near_surface(axes=vertical)(draw, n)
    rows[:, 9] = draw.signed(n, -60, 60)
    return rows


def _slight(draw: Draw, n: int) -> Vectors:
    """Draw axes that differ from the vertical or the horizontal by 2⁻¹⁰⁷⁴ to 1."""
    cosine, sine = draw.circle(n)
    little = np.where(turns(n, True, True, True, False), draw.log_uniform(n, -60, 0), draw.log_uniform(n, -1074, -60))
    standing = turns(n, True, True, False)
    across, up = np.where(standing, little, 1.0), np.where(standing, 1.0, little)
    return across * cosine, across * sine, up * draw.signs(n)


slight = near_surface(axes=_slight)
"""The generator of rows near contact with axes that are nearly vertical or horizontal."""


def nearly_along(draw: Draw, n: int) -> Vectors:
    """Draw axes that are horizontal, or differ by 2⁻⁶⁰ to 1 from the horizontal or the vertical, 1 to about 3 long."""
    cosine, sine = draw.circle(n)
    little, flat = draw.log_uniform(n, -60, 0), turns(n, True, True, False)
    across = np.where(flat, 1.0, little) * draw.integers(n, 1, 3)
    up = np.where(flat, np.where(turns(n, True, False), 0.0, little), 1.0) * draw.signs(n)
    return across * cosine, across * sine, up


def _stiff(draw: Draw, n: int) -> tuple[Sizes, Floats]:
    """Draw sizes with ratios up to 2²⁷, about 10⁸, and heights in γ."""
    size = sizes(draw, draw.log_uniform(n, -14, 14), draw.log_uniform(n, -14, 14), units=(-13, 13))
    return size, draw.signed(n, -20, 4)


stiff = near_surface(_stiff)
"""The generator of rows near contact with ratios of sizes up to 2²⁷."""


def any_length(draw: Draw, n: int) -> Rows:
    """Make rows near contact with axes as short and as long as float64 allows."""
    rows = near_contact(draw, n)
    length = draw.integers(n, -1073, 1023)
    rows[:, 7:] = ldexp(rows[:, 7:], np.where(turns(n, True, True, False), length, turns(n, -1073, 1023))[:, None])
    return rows + 0.0


def small_integers(draw: Draw, n: int) -> Rows:
    """Make rows of whole numbers, as a person types them: sizes to 6, centres to ±12, axes to ±2."""
    whole = [draw.integers(n, 1, 6) for _ in range(4)] + [draw.integers(n, -12, 12) for _ in range(3)]
    axis = [draw.integers(n, -2, 2) for _ in range(3)]
    zero = (axis[0] == 0) & (axis[1] == 0) & (axis[2] == 0)
    return np.stack([*whole, np.where(zero, 1, axis[0]), *axis[1:]], axis=1).astype(np.float64)


def nearly_zero(draw: Draw, n: int) -> Rows:
    """Make rows as coincidences.nearly_zero does, with axes in every direction."""
    return np.concatenate([coincidences.nearly_zero(draw, n), np.stack(anywhere(draw, n), axis=1)], axis=1) + 0.0


def _small(draw: Draw, n: int) -> tuple[Sizes, Floats]:
    """Draw sizes and heights within a few powers of two of 1."""
    size = sizes(draw, draw.log_uniform(n, -6, 6), draw.log_uniform(n, -6, 6), units=(-3, 3))
    return size, draw.between(n, -2, 2)


def whole_domain(draw: Draw, n: int) -> Rows:
    """Make rows near the limits of float64: one power of two scales all lengths, also below the least normal number."""
    rows = near_surface(_small, offsets=lambda draw, n: nearly_touching(draw, n, high=0))(draw, n)
    unit = np.where(turns(n, True, False), draw.integers(n, -1064, -1000), draw.integers(n, 900, 1008))
    rows[:, :7] = ldexp(rows[:, :7], unit[:, None])
    return np.concatenate([np.maximum(rows[:, :4], 5e-324), rows[:, 4:]], axis=1) + 0.0


_MARGIN = 1e-6
"""The least absolute value, relative to the largest diagonal element, from which on a pivot has a certain sign."""


def double_roots(draw: Draw, n: int) -> tuple[Rows, Mask, Mask]:
    """Make rows with a double root; return them and masks of the certainly tangent and the certainly not tangent ones.

    The letters are those of the module's docstring.
    """
    n1, n3, N = triples(draw, n, 2)
    p, q, S = triples(draw, n, 2)
    c4, s4, h4 = triples(draw, n, 2)
    s5, c5, h5 = triples(draw, n, 2)
    c, s, K = turned(draw, n)
    upward, side = (draw.signs(n).astype(np.int64).astype(object) for _ in range(2))
    wide, thick = big_integers_of_any_length(draw, n, 16), big_integers_of_any_length(draw, n, 6)
    # w = wide n1 n3 c5 and f = thick h4 p q N K clear all denominators.
    sizes = (
        wide * h5 * n3 * c5,
        wide * s5 * n1 * c5,
        thick * h4 * p * N * K * c4 * S,
        thick * h4 * q * N * K * s4 * S,
    )
    bend = s4 * s4 * q * q - c4 * c4 * p * p
    offset = (
        thick * (n1 * h4 * h4 * p * q * K + bend * c * n3),
        thick * bend * s * N,
        thick * (n3 * h4 * h4 * p * q * K - bend * c * n1),
    )
    centre = (wide * h5 * h5 * n3 + side * offset[0], side * offset[1], -wide * s5 * s5 * n1 + side * offset[2])
    axis = (p * K * n1 + q * c * n3, q * s * N, p * K * n3 - q * c * n1)
    share = (side * wide * n1 * n3 * c5 * c5, thick * h4 * h4 * p * q * N * N * K)  # λ, as a quotient
    tangent, crossing = _definite(sizes, axis, (share[0] / share[1]).astype(np.float64))
    rows, exact = _turned(draw, sizes, centre, axis, upward)
    return rows, exact & tangent, exact & crossing


def _definite(sizes: tuple[BigIntegers, ...], axis: tuple[BigIntegers, ...], at: Floats) -> tuple[Mask, Mask]:
    """Return masks of the rows where b² (M + λD) is certainly positive definite, and where it is certainly indefinite.

    `at` is λ. The signs of the pivots of Gaussian elimination decide.
    """
    alpha, gamma, b, d = (column.astype(np.float64) for column in sizes)
    v = [column.astype(np.float64) for column in axis]
    length = np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    v = [column / length for column in v]
    extra = (b / d) * (b / d) - 1
    D = (at * (b / alpha) * (b / alpha), at * (b / alpha) * (b / alpha), -at * (b / gamma) * (b / gamma))
    G = [[(i == j) * (1 + D[i]) + extra * v[i] * v[j] for j in range(3)] for i in range(3)]
    largest = np.stack([np.abs(G[i][i]) for i in range(3)]).max(axis=0)
    low = np.full(len(at), np.inf)
    with np.errstate(all="ignore"):
        for i in range(3):
            low = np.minimum(low, np.where(low < 0, low, G[i][i] / largest))
            for j in range(i + 1, 3):
                factor = G[j][i] / G[i][i]
                for k in range(3):
                    G[j][k] = G[j][k] - factor * G[i][k]
    return np.asarray(low > _MARGIN), np.asarray(low < -_MARGIN)


def _turned(
    draw: Draw,
    sizes: tuple[BigIntegers, ...],
    centre: tuple[BigIntegers, ...],
    axis: tuple[BigIntegers, ...],
    upward: BigIntegers,
) -> tuple[Rows, Mask]:
    """Turn rows by rational angles about the hyperboloid's axis and reduce them; return a mask of exact ones, too."""
    cosine, sine, radius = turned(draw, len(upward))
    lengths = [
        *(radius * number for number in sizes),
        cosine * centre[0] - sine * centre[1],
        sine * centre[0] + cosine * centre[1],
        radius * centre[2] * upward,
    ]
    axis_parts = [
        cosine * axis[0] - sine * axis[1],
        sine * axis[0] + cosine * axis[1],
        radius * axis[2] * upward,
    ]
    reduced = [*in_lowest_terms(lengths), *in_lowest_terms(axis_parts)]
    exact = np.all([np.abs(number) <= 2**53 for number in reduced], axis=0).astype(np.bool_)
    rows = np.stack([number.astype(np.float64) for number in reduced], axis=1)
    return _anywhere(draw, rows), exact


def _anywhere(draw: Draw, rows: Rows) -> Rows:
    """Write the same pairs in other coordinates: x and y with other signs or swapped, z too, lengths about 1."""
    n = len(rows)
    rows = rows.copy()
    for column in (4, 5, 6):
        sign = draw.signs(n)
        rows[:, column] *= sign
        rows[:, column + 3] *= sign
    swap = (draw.signs(n) < 0)[:, None]
    rows[:, [4, 5, 7, 8]] = np.where(swap, rows[:, [5, 4, 8, 7]], rows[:, [4, 5, 7, 8]])
    greatest = np.frexp(np.abs(rows[:, :7]).max(axis=1))[1]
    rows[:, :7] = ldexp(rows[:, :7], (draw.integers(n, -2, 5) - greatest)[:, None])
    rows[:, 7:] = ldexp(rows[:, 7:], draw.integers(n, -20, 3)[:, None])
    return rows + 0.0


tangent = gathered(lambda draw, n: double_roots(draw, n)[:2])
"""The generator of exact tangencies."""

crossing = gathered(lambda draw, n: double_roots(draw, n)[::2])
"""The generator of double roots that are not tangencies."""


def moved_by_ulps(draw: Draw, rows: Rows) -> Rows:
    """Move one nonzero number of each row by 1, 2, 4 … or 2^ULPS ulp to either side."""
    n = len(rows)
    return one_moved(draw, rows, ldexp(draw.signs(n), draw.integers(n, 0, ULPS)).astype(np.int64))


def near_tangent(draw: Draw, n: int) -> Rows:
    """Make tangencies and move one number of each by ulps."""
    return moved_by_ulps(draw, tangent(draw, n))


def listed(name: str) -> Rows:
    """Read the rows of that name in symmetric_pairs.toml, (n, 10)."""
    return np.asarray(toml.shipped("hypcheck.vectors", "symmetric_pairs.toml")[name], dtype=np.float64)


def _of_list(name: str) -> Maker:
    """Return the generator of listed rows, turned by rational angles and scaled; four of five are moved by ulps."""

    def attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
        rows = listed(name)
        chosen = rows[draw.integers(n, 0, len(rows) - 1)] * 4
        whole = [column.astype(np.int64).astype(object) for column in chosen.T]
        ones = np.ones(n, dtype=np.int64).astype(object)
        return _turned(draw, tuple(whole[:4]), tuple(whole[4:7]), tuple(whole[7:]), ones)

    def make(draw: Draw, n: int) -> Rows:
        rows = gather(draw, n, attempt)
        return np.where(turns(n, True, False, False, False)[:, None], rows, moved_by_ulps(draw, rows))

    return make


ring = _of_list("rings")


def _at_the_origin(draw: Draw, n: int) -> Rows:
    """Make rows with the centre at the origin, α = b or some ulps beside it: points X and −X are equally near."""
    b, d = draw.log_uniform(n, -4, 4), draw.log_uniform(n, -4, 4)
    gamma = draw.log_uniform(n, -4, 4)
    alpha = stepped(b, turns(n, 0, 1, 1, 1) * ldexp(draw.signs(n), draw.integers(n, 0, ULPS)).astype(np.int64))
    cosine, sine = draw.circle(n)
    zero = np.zeros(n)
    return np.stack([alpha, gamma, b, d, zero, zero, zero, cosine, sine, draw.between(n, -2, 2)], axis=1) + 0.0


def _in_both_planes(draw: Draw, n: int) -> Rows:
    """Make rows with centre and axis in the plane y = 0, near the origin: nearest points are pairs, on two sides."""
    b, d = draw.log_uniform(n, -2, 2), draw.log_uniform(n, -2, 2)
    alpha, gamma = b * draw.between(n, 0.8, 1.3), d * draw.log_uniform(n, -1, 3)
    x, z = alpha * draw.between(n, -0.2, 0.2), gamma * draw.between(n, -0.4, 0.4)
    zero = np.zeros(n)
    return np.stack([alpha, gamma, b, d, x, zero, z, draw.between(n, -1, 1), zero, draw.signs(n)], axis=1) + 0.0


twins = in_turn(_of_list("tangent-in-two-points"), _at_the_origin, _in_both_planes)
