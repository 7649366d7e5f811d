"""A sphere or a cylinder about the spheroid, in its place: what is written where a spheroid seems too much trouble.

Both are circumscribed, so whatever they call clear is clear (a cylinder up to the rounding of plain floats), and what
they call contact often is not. The sphere has the radius max(b, d), the cylinder the radius b and the half height d,
its axis parallel to the hyperboloid's.
"""

from __future__ import annotations

import numpy as np

from hypcheck.kernel import numpy_path
from hypcheck.methods.formula import Floats, Sizes
from hypcheck.methods.method import Answers
from hypcheck.rows import Rows


def sphere(rows: Rows) -> Answers:
    """Positions (n,) of the sphere: exact, so that what is wrong about the spheroid is the shape's fault alone."""
    spheres = rows.copy()
    spheres[:, 2:4] = np.maximum(rows[:, 2], rows[:, 3])[:, np.newaxis]
    return numpy_path.positions(spheres)


def sphere_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
    """The same for many centres and one α, γ, b, d."""
    alpha, gamma, b, d = sizes
    return numpy_path.positions_of_scene((alpha, gamma, max(b, d), max(b, d)), x, y, z)


def cylinder(rows: Rows) -> Answers:
    """Positions (n,) of the cylinder in plain floats."""
    alpha, gamma, b, d, x, y, z = rows.T
    return _cylinder(alpha, gamma, b, d, x, y, z)


def cylinder_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
    """The same for many centres and one α, γ, b, d."""
    return _cylinder(*sizes, x, y, z)


def _cylinder(
    alpha: Floats | float,
    gamma: Floats | float,
    b: Floats | float,
    d: Floats | float,
    x: Floats,
    y: Floats,
    z: Floats,
) -> Answers:
    # The hyperboloid's radius grows with |z|, so it is widest at the cylinder's farther end and narrowest at its nearer
    # one, or in the waist's plane where that lies between the two.
    r, height = np.hypot(x, y), np.abs(z)
    widest = alpha * np.hypot(1.0, (height + d) / gamma)
    narrowest = alpha * np.hypot(1.0, np.maximum(height - d, 0.0) / gamma)
    return (r - b > widest).astype(np.int8) - (r + b < narrowest).astype(np.int8)
