"""Another question answered than the one that was asked: other bodies, fewer points, a first approximation."""

from __future__ import annotations

import numpy as np

from tests.tools.mutants.exactly import position, signs
from tests.tools.mutants.expectation import wrong


def _clear(side, distance):
    """±1 on its side of the surface where the distance exceeds 1 radius, else 0."""
    return np.where(distance > 1, np.sign(side), 0).astype(np.int8)


def _scaled(rows):
    """a, c, r and |z|, in spheroid radii."""
    alpha, gamma, b, d, x, y, z = rows.T
    return alpha / b, gamma / d, np.hypot(x, y) / b, np.abs(z / d)


def _height_above(r, z, a, c):
    """h = r²/a² − z²/c² − 1, positive outside."""
    return (r / a) ** 2 - (z / c) ** 2 - 1


@wrong()
def cylinder(rows):
    """The hyperboloid is a cylinder of radius α."""
    a, _, r, _ = _scaled(rows)
    return _clear(r - a, np.abs(r - a))


@wrong()
def cone(rows):
    """The hyperboloid is the cone it approaches."""
    a, c, r, z = _scaled(rows)
    return _clear(r / a - z / c, np.abs(c * r - a * z) / np.hypot(a, c))


@wrong()
def axis_distance(rows):
    """The spheroid is clear of the axis, so it is clear."""
    _, _, r, _ = _scaled(rows)
    return signs(r > 1, np.zeros(len(rows), dtype=bool))


@wrong()
def centre_alone(rows):
    """The centre decides; the spheroid has no size."""
    a, c, r, z = _scaled(rows)
    return np.sign(_height_above(r, z, a, c)).astype(np.int8)


@wrong()
def slice_at_the_centre(rows):
    """The surface's radius at the centre's height is compared with r ± b."""
    a, c, r, z = _scaled(rows)
    wall = a * np.sqrt(1 + (z / c) ** 2)
    return _clear(r - wall, np.abs(r - wall))


@wrong()
def six_points(rows):
    """The ends of the spheroid's axes must lie on one side."""
    a, c, r, z = _scaled(rows)
    ends = [(r - 1, z), (r + 1, z), (r, z - 1), (r, z + 1), (np.hypot(r, 1), z)]
    height = np.array([_height_above(across, along, a, c) for across, along in ends])
    return signs((height > 0).all(axis=0), (height < 0).all(axis=0))


@wrong()
def many_points(rows):
    """A hundred points of the spheroid's outline must lie on one side."""
    a, c, r, z = _scaled(rows)
    angles = np.linspace(0, 2 * np.pi, 100)[:, None]
    height = _height_above(r + np.cos(angles), z + np.sin(angles), a, c)
    return signs((height > 0).all(axis=0), (height < 0).all(axis=0))


@wrong()
def bounding_box(rows):
    """The spheroid is the box around it, in the plane through the axis."""
    a, c, r, z = _scaled(rows)
    nearest = _height_above(np.maximum(r - 1, 0), z + 1, a, c)
    farthest = _height_above(r + 1, np.maximum(z - 1, 0), a, c)
    return signs((r > 1) & (nearest > 0), farthest < 0)


@wrong()
def first_order_distance(rows):
    """The distance is |h| over the length of its gradient."""
    a, c, r, z = _scaled(rows)
    height = _height_above(r, z, a, c)
    with np.errstate(invalid="ignore", divide="ignore"):
        return _clear(height, np.abs(height) / (2 * np.hypot(r / a**2, z / c**2)))


@wrong()
def radial_distance(rows):
    """The distance is measured along the ray from the origin through the centre."""
    a, c, r, z = _scaled(rows)
    with np.errstate(invalid="ignore", divide="ignore"):
        stretch = 1 / np.sqrt((r / a) ** 2 - (z / c) ** 2)
        distance = np.abs(1 - stretch) * np.hypot(r, z)
    return _clear(_height_above(r, z, a, c), np.where(np.isnan(distance), 2, distance))


@wrong()
def two_sheets(rows):
    """The hyperboloid of two sheets, z²/γ² − r²/α² = 1, seen from its centre."""
    a, c, r, z = _scaled(rows)
    wall = c * np.sqrt(1 + (r / a) ** 2)
    return _clear(wall - z, np.abs(wall - z))


@wrong()
def ellipsoid(rows):
    """z²/γ² has a plus sign: the surface is a spheroid too."""
    a, c, r, z = _scaled(rows)
    height = (r / a) ** 2 + (z / c) ** 2 - 1
    return _clear(height, np.abs(height) / (2 * np.hypot(r / a**2, z / c**2) + 1e-300))


@wrong()
def one_fixed_line(rows):
    """λ = √A, or −√A, is the only one that is tried."""
    a, c, r, z = _scaled(rows)
    A, B = a * a, c * c
    with np.errstate(invalid="ignore", divide="ignore"):
        outside, inside = (r * r * m / (A + m) - z * z * m / (B - m) - 1 - m for m in (a, -a))
    return signs((outside > 0) & (a < B), (inside > 0) & (a > 1))


@wrong()
def early_exit_beyond_the_waist(rows):
    """Clear where r > a + 1, whatever the height; exact elsewhere."""
    a, _, r, _ = _scaled(rows)
    return np.where(r > a + 1, 1, position(rows)).astype(np.int8)


@wrong()
def early_exit_on_a_bounding_ball(rows):
    """Clear where the wall at the centre's height is farther than the spheroid's longer semi-axis; exact elsewhere."""
    alpha, gamma, b, d, x, y, z = rows.T
    beyond = np.hypot(x, y) - alpha * np.hypot(1, z / gamma)
    return np.where(np.abs(beyond) > np.maximum(b, d), np.sign(beyond), position(rows)).astype(np.int8)
