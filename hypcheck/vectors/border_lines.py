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
"""The vector that generates the lattice: its points are i · GENERATOR / 2^BITS modulo 1, for i below 2^BITS.

The numbers are the powers of 125. Of all bases, 125 was found to keep the points farthest apart in any two of the
first nine coordinates.
"""

HIGHEST = 2.0
"""|z|/γ of the centre is below it."""

RATIO_OCTAVES = 10
"""c/a and d/b, with a = α/b and c = γ/d, are from 2^−RATIO_OCTAVES to 2^RATIO_OCTAVES."""

STRATA_NEAREST, STRATA_FARTHEST = -40, -30
"""Rows are from 2^STRATA_NEAREST to 2^STRATA_FARTHEST radii off contact."""

_EIGHTH = 0.41421356237309503
"""The tangent of π/8: circle_at spans a quarter of the circle between this and its opposite."""

_HALVINGS = 54


def lattice(draw: Draw, n: int) -> NDArray[np.float64]:
    """Return n points of a lattice in [0, 1)^10 with a random shift, (10, n); the first 2^k are spread evenly too."""
    places = np.arange(n, dtype=np.int64)
    turned = np.zeros(n, dtype=np.int64)
    for bit in range(BITS):
        turned |= ((places >> bit) & 1) << (BITS - 1 - bit)
    steps = turned * np.asarray(GENERATOR, dtype=np.int64)[:, None] % (1 << BITS)
    points = ldexp(steps, np.full(steps.shape, -BITS)) + draw.unit(len(GENERATOR))[:, None]
    return np.asarray(points - np.floor(points))


def octaves(share: Floats, low: int, high: int) -> Floats:
    """Map numbers in [0, 1) to 2^low … 2^high: evenly over the octaves, and evenly within each octave."""
    octave = share * (high - low)
    whole = np.floor(octave)
    return ldexp(1 + (octave - whole), low + whole)


def _around(share: Floats) -> tuple[Floats, Floats]:
    """Map numbers in [0, 1) to directions all around, nearly evenly; return their cosines and sines."""
    quarter = np.floor(share * 4)
    cosine, sine = circle_at(_EIGHTH * (2 * (share * 4 - quarter) - 1))
    return (
        np.select([quarter == 0, quarter == 1, quarter == 2], [cosine, -sine, -cosine], sine),
        np.select([quarter == 0, quarter == 1, quarter == 2], [sine, cosine, -sine], -cosine),
    )


def _near(points: NDArray[np.float64]) -> Floats:
    """Return the distances of a lattice's rows from contact, in radii; negative ones mean contact."""
    side, distance = points[5:7]
    outwards = np.where(np.floor(side * 4) % 2 == 0, 1.0, -1.0)
    return np.asarray(outwards * octaves(distance, STRATA_NEAREST, STRATA_FARTHEST))


def _made(points: NDArray[np.float64], axis: Vectors, off: Floats) -> Rows:
    """Make the rows of these points of a lattice, with these axes, `off` radii from contact, (n, 10)."""
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
    """Scale α, γ, b, d of each row by one power of two: the greatest is about as far above 1 as the least is below."""
    octaves = np.stack([exponent(length) for length in lengths])
    shift = -((octaves.max(axis=0) + octaves.min(axis=0)) // 2)
    return Sizes(*(ldexp(length, shift) for length in lengths))


def _foot(size: Sizes, level: Floats, axis: Vectors, outward: Floats) -> Floats:
    """Find the point of the surface that a spheroid with its centre at height `level` touches; return its height.

    Both heights are in γ. `outward` is 1 for a spheroid outside the surface, −1 for one inside.
    """
    ahead = (np.ones(len(level)), np.zeros(len(level)))
    reach = np.maximum(size.b, size.d) / size.gamma
    low, high = level - reach, level + reach
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        above = beside_at(size, ahead, middle, axis, outward)[:, 6] > level * size.gamma
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return (low + high) / 2


def _turned(rows: Rows, to: tuple[Floats, Floats]) -> Rows:
    """Turn each row about the hyperboloid's axis until its centre is in the direction `to` (cosine, sine)."""
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
    """Make rows 2⁻⁴⁰ to 2⁻³⁰ radii off contact, to either side of it, outside and inside; |z| is below 2γ."""
    points = lattice(draw, n)
    return upright_at(points, _near(points))


def upright_at(points: NDArray[np.float64], off: Floats) -> Rows:
    """Make the rows of these points of a lattice, (10, n), `off` radii from contact."""
    zero = np.zeros(len(off))
    return np.ascontiguousarray(_made(points, (zero, zero, np.ones(len(off))), off)[:, :7])


def tilted(draw: Draw, n: int) -> Rows:
    """Make rows as `upright` does, of tilted spheroids with axes in all directions."""
    points = lattice(draw, n)
    return tilted_at(points, _near(points))


def tilted_at(points: NDArray[np.float64], off: Floats) -> Rows:
    """Make the rows with axes of these points of a lattice, `off` radii from contact."""
    up = points[8]
    across = np.sqrt(1 - up * up)
    cosine, sine = _around(points[9])
    return _made(points, (across * cosine, across * sine, up), off)


RUNGS_ON_A_SIDE = 64
RUNGS = 2 * RUNGS_ON_A_SIDE
"""The number of rungs of a line: first the clear ones, then those in contact, on each side the nearest first."""

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
        """Return the rows of these lines of a lattice, (n,), at these rungs, (n,)."""
        rows, jitter = _lines(self.name, self.version, seed, lattice)
        return _resized(rows[lines], _changes(rungs, jitter[lines]))

    def _blocks(self, seed: int, first: int, last: int) -> Rows:
        return np.concatenate([self._block(seed, number) for number in range(first, last)])

    def _block(self, seed: int, number: int) -> Rows:
        lattice, start = divmod(number * BLOCK, LINES * RUNGS)
        places = start + np.arange(BLOCK)
        return self.rungs(seed, lattice, places // RUNGS, places % RUNGS)


def _not_alone(draw: Draw, n: int) -> Rows:
    """Raise an error: a LineFamily makes its rows line by line, and needs no generator."""
    raise NotImplementedError(f"{n} rows of {draw} are made line by line")


SEARCHED = {
    "search": LineFamily("search", _not_alone, times=10),
    "tilted-search": LineFamily("tilted-search", _not_alone, times=10, groups=frozenset({"axis"})),
}
"""The families whose rows a directed search chooses, by name; `times` counts the rows that it asks."""


@lru_cache(8)
def _lines(name: str, version: int, seed: int, number: int) -> tuple[Rows, Floats]:
    """Return the lines of a lattice: rows that are just clear, and the part of a rung by which rungs are shifted."""
    points = lattice(Draw(name, version, seed, number), LINES)
    rows = (tilted_at if "axis" in SEARCHED[name].groups else upright_at)(points, np.zeros(LINES))
    return _resized(rows, _touch(rows) - 1), points[6]


def _touch(rows: Rows) -> Floats:
    """Find the largest factor by which each spheroid can be multiplied and still is clear, (n,)."""
    # Bisection of bit patterns bisects the logarithm at first, and the factor itself at the end.
    below, above = (np.full(len(rows), factor).view(np.int64) for factor in (_LEAST, _MOST))
    while (above - below).max(initial=0) > 1:
        middle = below + (above - below) // 2
        touches = np.asarray(classify(_resized(rows, middle.view(np.float64) - 1))) == Position.CONTACT
        below, above = np.where(touches, below, middle), np.where(touches, middle, above)
    return np.asarray(below.view(np.float64))


def _resized(rows: Rows, change: Floats) -> Rows:
    """Multiply b and d of each row by 1 + `change`."""
    resized = rows.copy()
    resized[:, 2:4] += rows[:, 2:4] * change[:, None]
    return resized


def _changes(rungs: Integers, jitter: Floats) -> Floats:
    """Return the relative difference between the size at these rungs and the size that touches, (n,)."""
    change = octaves(_share(rungs, jitter), NEAREST_OCTAVE, FARTHEST_OCTAVE)
    return np.asarray(np.where(rungs < RUNGS_ON_A_SIDE, -change, change))


def _share(rungs: Integers, jitter: Floats) -> Floats:
    """Return the place of each rung on its side of the line: from 0, nearest to the border, to 1."""
    return np.asarray((rungs % RUNGS_ON_A_SIDE + jitter) / RUNGS_ON_A_SIDE)


def octaves_of(name: str, seed: int, lines: Integers, rungs: Integers) -> Floats:
    """Return the distances from contact of these rungs of these lines of a searched family, (n,).

    The unit is the whole range of octaves: 0 means 2^NEAREST_OCTAVE, 1 means 2^FARTHEST_OCTAVE.
    """
    family, shares = SEARCHED[name], np.empty(len(lines))
    for lattice in sorted({*(lines // LINES).tolist()}):
        some = lines // LINES == lattice
        _, jitter = _lines(name, family.version, seed, lattice)
        shares[some] = _share(rungs[some], jitter[lines[some] % LINES])
    return shares
