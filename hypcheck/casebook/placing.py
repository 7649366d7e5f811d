"""Where the spheroid is put: sizes from the ratios a = α/b and c = γ/d, centres by their distance from the surface.

Heights, radii and offsets are in spheroid radii, that is, in the space of Theorem 1 of the paper, where the spheroid
is the unit ball and the hyperboloid has the semi-axes a, a, c. Nothing here is exact; it need not be.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.casebook.draw import Draw, Floats
from hypcheck.rows import Rows

UNITS = (-6, 4)
"""b and d lie in [2⁻⁶, 2⁴) unless a family has a reason: centimetres to the size of a house, in metres."""


@dataclass(frozen=True, slots=True)
class Sizes:
    """Arrays α, γ, b, d, in the caller's units."""

    alpha: Floats
    gamma: Floats
    b: Floats
    d: Floats

    @property
    def a(self) -> Floats:
        """α/b, in floats."""
        return self.alpha / self.b

    @property
    def c(self) -> Floats:
        """γ/d, in floats."""
        return self.gamma / self.d


def sizes(draw: Draw, a: Floats, c: Floats, units: tuple[int, int] = UNITS) -> Sizes:
    """Sizes with about these ratios, b and d log-uniform in 2^units."""
    b, d = draw.log_uniform(len(a), *units), draw.log_uniform(len(a), *units)
    return Sizes(a * b, c * d, b, d)


def stack(size: Sizes, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Rows:
    """The rows of these columns, without negative zeros; each column lies in memory as a whole."""
    columns = np.empty((7, len(size.b)))
    for index, column in enumerate((size.alpha, size.gamma, size.b, size.d, x, y, z)):
        np.add(column, 0.0, out=columns[index])
    return columns.T


def centred(draw: Draw, size: Sizes, radius: Floats, height: Floats) -> Rows:
    """Rows with the centre at this distance from the axis and from the waist, at any azimuth, above or below."""
    n = len(radius)
    cosine, sine = draw.circle(n)
    across = size.b * radius
    return stack(size, across * cosine, across * sine, size.d * height * draw.signs(n))


def beside(draw: Draw, size: Sizes, height: Floats, offset: Floats) -> Rows:
    """Rows with the centre `offset` from the point of the surface at `height`, along the normal, outward positive."""
    return centred(draw, size, *beside_surface(size.a, size.c, height, offset))


def beside_surface(a: Floats, c: Floats, height: Floats, offset: Floats) -> tuple[Floats, Floats]:
    """The radius and height of `beside`; no intermediate overflows while a, c and a·height/c do not."""
    share = height / c
    small = np.minimum(share, 2.0**30)
    stretch = np.where(share > 2.0**30, share, np.sqrt(1 + small * small))
    # The normal is (ρ/a², −ζ/c²), here over the larger of its two parts.
    across, along = 1 / a, share / stretch / c
    larger = np.maximum(across, along)
    across, along = across / larger, along / larger
    length = np.sqrt(across * across + along * along)
    return np.abs(a * stretch + offset * across / length), height - offset * along / length


def heights(draw: Draw, c: Floats) -> Floats:
    """Half within two γ of the waist, half within eight radii of it."""
    n = len(c)
    share = draw.unit(n)
    return np.asarray(share * np.where(draw.words(n) >> np.uint64(63) == 0, 2 * c, 8.0))


def offsets(draw: Draw, n: int) -> Floats:
    """Uniform in ±2.5 radii, so that each position is met wherever the surface is flat enough to allow it."""
    return draw.between(n, -2.5, 2.5)


def around(draw: Draw, size: Sizes) -> Rows:
    """Rows all around the surface, at `heights` and `offsets`."""
    return beside(draw, size, heights(draw, size.c), offsets(draw, len(size.b)))
