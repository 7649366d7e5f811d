"""Rows near contact: evenly spread rows, and lines across the border of contact for a directed search.

**Evenly.** Every narrow slice of a size, a height or a direction has a row: a fault in a narrow range, such as |z|/γ
between 0.50 and 0.51, is visible only in a row within the range and near contact. Random draws leave gaps and clusters.
Here each block of rows is a lattice of 1024 points with a random shift: each coordinate has a row in every 1024th part
of its range, and any two coordinates together are spread as evenly. The seed is the start of the lattice. The height is
the height of the centre, not of the point of contact: a bisection finds the point that belongs to it.

**Lines**: one pair, and its spheroid in many sizes. A line begins with a spheroid that touches, and its size is
multiplied by factors: a larger spheroid is in contact, a smaller one is clear. A search finds where on the line an
implementation's answer changes (runs/border_search.py). The rungs of a line are numbered, so that a row has a case id
like any other: row i of the family is rung i mod RUNGS of line i div RUNGS. The pairs come from a lattice with other
random shifts.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.kernel.classify import classify
from hypcheck.vectors.draw import BLOCK, Draw, Family, Integers, circle_at, exponent, ldexp
from hypcheck.vectors.random_pairs import Sizes
from hypcheck.vectors.tilted import Vectors, beside_at

BITS = 10
"""A lattice has 2^BITS points."""

GENERATOR = (1, 125, 265, 357, 593, 397, 473, 757, 417, 55)
"""Of the lattice; the best powers found for the distance of its points in any two of the first nine coordinates."""

HIGHEST = 2.0
"""|z|/γ of the centre is below it."""

RATIO_OCTAVES = 10
"""c/a and d/b are from 2^−RATIO_OCTAVES to 2^RATIO_OCTAVES."""

STRATA_NEAREST, STRATA_FARTHEST = -40, -30
"""Rows are from 2^STRATA_NEAREST to 2^STRATA_FARTHEST radii off contact."""

_EIGHTH = 0.41421356237309503
"""The tangent of π/8: circle_at spans a quarter of the circle between this and its opposite."""

_HALVINGS = 54


def lattice(draw: Draw, n: int) -> NDArray[np.float64]:
    """The points of a shifted lattice in [0, 1)^10, (10, n); the first 2^k of them are spread evenly too."""
    places = np.arange(n, dtype=np.int64)
    turned = np.zeros(n, dtype=np.int64)
    for bit in range(BITS):
        turned |= ((places >> bit) & 1) << (BITS - 1 - bit)
    steps = turned * np.asarray(GENERATOR, dtype=np.int64)[:, None] % (1 << BITS)
    points = ldexp(steps, np.full(steps.shape, -BITS)) + draw.unit(len(GENERATOR))[:, None]
    return np.asarray(points - np.floor(points))


def octaves(share: Floats, low: int, high: int) -> Floats:
    """Numbers from 2^low to 2^high for shares in [0, 1): evenly over octaves, and evenly within each octave."""
    octave = share * (high - low)
    whole = np.floor(octave)
    return ldexp(1 + (octave - whole), low + whole)


def _around(share: Floats) -> tuple[Floats, Floats]:
    """Directions all around, nearly evenly."""
    quarter = np.floor(share * 4)
    cosine, sine = circle_at(_EIGHTH * (2 * (share * 4 - quarter) - 1))
    return (
        np.select([quarter == 0, quarter == 1, quarter == 2], [cosine, -sine, -cosine], sine),
        np.select([quarter == 0, quarter == 1, quarter == 2], [sine, cosine, -sine], -cosine),
    )


def _near(points: NDArray[np.float64]) -> Floats:
    """The distances of a lattice's rows from contact, in radii; negative numbers are in contact."""
    side, distance = points[5:7]
    outwards = np.where(np.floor(side * 4) % 2 == 0, 1.0, -1.0)
    return np.asarray(outwards * octaves(distance, STRATA_NEAREST, STRATA_FARTHEST))


def _made(points: NDArray[np.float64], axis: Vectors, off: Floats) -> Rows:
    height, slope, shape, waist, azimuth, side, _, unit = points[:8]
    a, b = octaves(waist, -3, 7), octaves(unit, -1, 1)
    d = b * octaves(shape, -RATIO_OCTAVES, RATIO_OCTAVES)
    size = _centred(a * b, a * octaves(slope, -RATIO_OCTAVES, RATIO_OCTAVES) * d, b, d)
    level = HIGHEST * (2 * height - 1)
    outward = np.where(side < 0.5, 1.0, -1.0)
    foot = _foot(size, level, axis, outward)
    rows = beside_at(size, (np.ones(len(a)), np.zeros(len(a))), foot, axis, outward * (1 + off))
    return _turned(rows, _around(azimuth))


def _centred(*lengths: Floats) -> Sizes:
    """The sizes in units such that the greatest is about as far above 1 as the least is below it: none is extreme."""
    octaves = np.stack([exponent(length) for length in lengths])
    shift = -((octaves.max(axis=0) + octaves.min(axis=0)) // 2)
    return Sizes(*(ldexp(length, shift) for length in lengths))


def _foot(size: Sizes, level: Floats, axis: Vectors, outward: Floats) -> Floats:
    """The height in γ of a point on the surface such that a centre that touches it is at `level`, in γ too."""
    ahead = (np.ones(len(level)), np.zeros(len(level)))
    reach = np.maximum(size.b, size.d) / size.gamma
    low, high = level - reach, level + reach
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        above = beside_at(size, ahead, middle, axis, outward)[:, 6] > level * size.gamma
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return (low + high) / 2


def _turned(rows: Rows, to: tuple[Floats, Floats]) -> Rows:
    """The rows, turned about the hyperboloid's axis until the centres are in these directions."""
    x, y = rows[:, 4].copy(), rows[:, 5].copy()
    radius = np.sqrt(x * x + y * y)
    there = radius > 0
    safe = np.where(there, radius, 1.0)
    cosine = (to[0] * np.where(there, x, 1.0) + to[1] * y) / safe
    sine = (to[1] * np.where(there, x, 1.0) - to[0] * y) / safe
    rows[:, 4], rows[:, 5] = to[0] * radius, to[1] * radius
    rows[:, 7], rows[:, 8] = cosine * rows[:, 7] - sine * rows[:, 8], sine * rows[:, 7] + cosine * rows[:, 8]
    return rows + 0.0


def upright(draw: Draw, n: int) -> Rows:
    """Rows from 2⁻⁴⁰ to 2⁻³⁰ radii off contact, to either side of it, outside and inside; |z| below 2γ."""
    points = lattice(draw, n)
    return upright_at(points, _near(points))


def upright_at(points: NDArray[np.float64], off: Floats) -> Rows:
    """The rows of these points of a lattice, (10, n), `off` radii from contact."""
    zero = np.zeros(len(off))
    return np.ascontiguousarray(_made(points, (zero, zero, np.ones(len(off))), off)[:, :7])


def tilted(draw: Draw, n: int) -> Rows:
    """The same for tilted spheroids, with axes in all directions."""
    points = lattice(draw, n)
    return tilted_at(points, _near(points))


def tilted_at(points: NDArray[np.float64], off: Floats) -> Rows:
    """The rows with axes of these points of a lattice, `off` radii from contact."""
    up = points[8]
    across = np.sqrt(1 - up * up)
    cosine, sine = _around(points[9])
    return _made(points, (across * cosine, across * sine, up), off)


RUNGS_ON_A_SIDE = 64
RUNGS = 2 * RUNGS_ON_A_SIDE
"""Rungs of a line: first those that are clear, then those in contact, each from the border outwards."""

NEAREST_OCTAVE, FARTHEST_OCTAVE = -48, 0
"""The size of a rung differs by 2^NEAREST_OCTAVE to 2^FARTHEST_OCTAVE of itself from that which touches."""

_LEAST, _MOST = 2.0**-12, 1 + 2.0**-20
"""Between these factors of its size a spheroid begins to touch: it was made to, but may reach the surface elsewhere."""

LINES = 1 << BITS
"""Lines of one lattice."""


@dataclass(frozen=True)
class LineFamily(Family):
    """A family whose rows are the rungs of all lines of a seed, line after line."""

    def rungs(self, seed: int, lattice: int, lines: Integers, rungs: Integers) -> Rows:
        """The rows of these lines of a lattice, (n,), at these rungs, (n,)."""
        rows, jitter = _lines(self.name, self.version, seed, lattice)
        return _resized(rows[lines], _changes(rungs, jitter[lines]))

    def _blocks(self, seed: int, first: int, last: int) -> Rows:
        return np.concatenate([self._block(seed, number) for number in range(first, last)])

    def _block(self, seed: int, number: int) -> Rows:
        lattice, start = divmod(number * BLOCK, LINES * RUNGS)
        places = start + np.arange(BLOCK)
        return self.rungs(seed, lattice, places // RUNGS, places % RUNGS)


def _not_alone(draw: Draw, n: int) -> Rows:
    raise NotImplementedError(f"{n} rows of {draw} are made line by line")


SEARCHED = {
    "search": LineFamily("search", _not_alone, times=10),
    "tilted-search": LineFamily("tilted-search", _not_alone, times=10, groups=frozenset({"axis"})),
}
"""The families whose rows a directed search chooses, by name; `times` counts the rows that it asks."""


@lru_cache(8)
def _lines(name: str, version: int, seed: int, number: int) -> tuple[Rows, Floats]:
    """The lines of a lattice: rows that are just clear, and the share of a rung by which their rungs are shifted."""
    points = lattice(Draw(name, version, seed, number), LINES)
    rows = (tilted_at if "axis" in SEARCHED[name].groups else upright_at)(points, np.zeros(LINES))
    return _resized(rows, _touch(rows) - 1), points[6]


def _touch(rows: Rows) -> Floats:
    """The largest factor of each spheroid's size at which it is clear, (n,)."""
    # Bisection of bit patterns bisects the logarithm at first, and the factor itself at the end.
    below, above = (np.full(len(rows), factor).view(np.int64) for factor in (_LEAST, _MOST))
    while (above - below).max(initial=0) > 1:
        middle = below + (above - below) // 2
        touches = np.asarray(classify(_resized(rows, middle.view(np.float64) - 1))) == Position.CONTACT
        below, above = np.where(touches, below, middle), np.where(touches, middle, above)
    return np.asarray(below.view(np.float64))


def _resized(rows: Rows, change: Floats) -> Rows:
    """The rows with spheroids enlarged by this share of their sizes."""
    resized = rows.copy()
    resized[:, 2:4] += rows[:, 2:4] * change[:, None]
    return resized


def _changes(rungs: Integers, jitter: Floats) -> Floats:
    """The relative difference between the size at these rungs and the size that touches."""
    change = octaves(_share(rungs, jitter), NEAREST_OCTAVE, FARTHEST_OCTAVE)
    return np.asarray(np.where(rungs < RUNGS_ON_A_SIDE, -change, change))


def _share(rungs: Integers, jitter: Floats) -> Floats:
    return np.asarray((rungs % RUNGS_ON_A_SIDE + jitter) / RUNGS_ON_A_SIDE)


def octaves_of(name: str, seed: int, lines: Integers, rungs: Integers) -> Floats:
    """The distances of these rungs of these lines of a searched family from contact, (n,).

    As a share of the octaves from NEAREST_OCTAVE to FARTHEST_OCTAVE.
    """
    family, shares = SEARCHED[name], np.empty(len(lines))
    for lattice in sorted({*(lines // LINES).tolist()}):
        some = lines // LINES == lattice
        _, jitter = _lines(name, family.version, seed, lattice)
        shares[some] = _share(rungs[some], jitter[lines[some] % LINES])
    return shares
