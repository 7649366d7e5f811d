"""Families of random pairs of every size, and the placing of spheroids that other families use.

Sizes come from the ratios a = α/b and c = γ/d, centres from their distance to the surface. Heights, radii and offsets
are in spheroid radii, that is, in the space of Theorem 1 of the paper, where the spheroid is the unit ball and the
hyperboloid has the semi-axes a, a, c. Nothing here is exact, and nothing needs to be.

The families: uniform, far, giant, tiny, mirrored, rows exact in the short float formats, and one pair repeated with one
of its seven numbers changed, which reveals values that a program keeps from the previous row. Then the paper's scenes:
the forest of section 3.1, the cooling tower of sections 3.2 and 4, its rotors and flights.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.geometry.pair import COLUMNS
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.vectors.draw import Draw, Maker, circle_at, ldexp, stepped, to_bits, turns

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
    """Draw sizes with about the ratios a = α/b and c = γ/d, b and d log-uniform in 2^units."""
    b, d = draw.log_uniform(len(a), *units), draw.log_uniform(len(a), *units)
    return Sizes(a * b, c * d, b, d)


def stack(size: Sizes, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Rows:
    """Make the rows of these columns, without negative zeros; each column is contiguous in memory."""
    columns = np.empty((7, len(size.b)))
    for index, column in enumerate((size.alpha, size.gamma, size.b, size.d, x, y, z)):
        np.add(column, 0.0, out=columns[index])
    return columns.T


def centred(draw: Draw, size: Sizes, radius: Floats, height: Floats) -> Rows:
    """Make rows with the centre at this distance from the axis and from the waist, at any azimuth, above or below."""
    n = len(radius)
    cosine, sine = draw.circle(n)
    across = size.b * radius
    return stack(size, across * cosine, across * sine, size.d * height * draw.signs(n))


def beside(draw: Draw, size: Sizes, height: Floats, offset: Floats) -> Rows:
    """Make rows with the centre `offset` from the surface's point at `height`, along the normal, outward positive."""
    return centred(draw, size, *beside_surface(size.a, size.c, height, offset))


def beside_surface(a: Floats, c: Floats, height: Floats, offset: Floats) -> tuple[Floats, Floats]:
    """Return the radius and height of the centre of `beside`; nothing overflows if a, c and a·height/c do not."""
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
    """Draw heights, in d: half within two γ of the waist, half within eight d of it."""
    n = len(c)
    share = draw.unit(n)
    return np.asarray(share * np.where(draw.words(n) >> np.uint64(63) == 0, 2 * c, 8.0))


def offsets(draw: Draw, n: int) -> Floats:
    """Draw offsets uniform in ±2.5 radii: every position occurs where the surface is flat enough to allow it."""
    return draw.between(n, -2.5, 2.5)


def nearly_touching(draw: Draw, n: int, low: int = -52, high: int = -4) -> Floats:
    """Draw offsets ±1, each changed by a relative 2^low to 2^high, up or down."""
    return draw.signs(n) * (1 + draw.signed(n, low, high))


def around(draw: Draw, size: Sizes) -> Rows:
    """Make rows all around the surface, with `heights` and `offsets`."""
    return beside(draw, size, heights(draw, size.c), offsets(draw, len(size.b)))


def all_regimes(draw: Draw, n: int) -> tuple[Floats, Floats]:
    """Draw a and c of the four regimes in turn: a in [2⁻⁴, 1) or [1, 2⁶), c²/a in [2⁻⁶, 1) or [1, 2⁸)."""
    a = np.where(turns(n, True, True, False, False), draw.log_uniform(n, 0, 6), draw.log_uniform(n, -4, 0))
    bend = np.where(turns(n, True, False), draw.log_uniform(n, 0, 8), draw.log_uniform(n, -6, 0))
    return a, np.sqrt(a * bend)


def sizes_of_all_regimes(draw: Draw, n: int, units: tuple[int, int] = UNITS) -> Sizes:
    """Draw sizes with the ratios of all_regimes, b and d log-uniform in 2^units."""
    return sizes(draw, *all_regimes(draw, n), units)


def uniform(draw: Draw, n: int) -> Rows:
    """Make rows in all regimes with centres all around the surface."""
    return around(draw, sizes_of_all_regimes(draw, n))


def far_centers(draw: Draw, n: int) -> Rows:
    """Make rows with centres 2⁴ to 2²⁷ radii up the surface, where it is nearly a cone."""
    a, c = all_regimes(draw, n)
    size = sizes(draw, a, c, units=(-10, -8))
    return beside(draw, size, draw.log_uniform(n, 4, 27) * np.minimum(1, c / a), offsets(draw, n))


def giant_spheroids(draw: Draw, n: int) -> Rows:
    """Make rows with a and c in [2⁻¹⁶, 2⁻²): compared with the spheroid the hyperboloid is a double cone."""
    return around(draw, sizes(draw, draw.log_uniform(n, -16, -2), draw.log_uniform(n, -16, -2)))


def tiny_spheroids(draw: Draw, n: int) -> Rows:
    """Make rows with a and c in [2¹⁰, 2²⁰): insects about towers; contact takes a thousandth of the scene or less."""
    return around(draw, sizes(draw, draw.log_uniform(n, 10, 20), draw.log_uniform(n, 10, 20), units=(-16, -6)))


def exact_in(bits: int, least: float) -> Maker:
    """Return the generator of rows of a float format: `bits` significant bits, no coordinate but 0 below `least`."""

    def make(draw: Draw, n: int) -> Rows:
        a, c = all_regimes(draw, n)
        size = sizes(draw, a, c, units=(-4, 2))
        coarse = Sizes(*(to_bits(length, bits) for length in (size.alpha, size.gamma, size.b, size.d)))
        rows = to_bits(around(draw, coarse), bits)
        return np.where(np.abs(rows) < least, 0.0, rows)

    return make


def small_integers(draw: Draw, n: int) -> Rows:
    """Make rows of small whole numbers, as a person types them: tangencies and other coincidences are frequent.

    Each pair is followed by three others of the same numbers: its centre turned, both groups of sizes swapped, and α
    and b doubled. Half of the zeros are negative.
    """
    count = -(-n // 4)
    size = _equal_sizes(draw, *(draw.integers(count, 1, high).astype(np.float64) for high in (12, 12, 4, 4)))
    x, y, z = (draw.integers(count, 0, high) * draw.signs(count) for high in (14, 14, 10))
    y = np.where(draw.words(count) >> np.uint64(63) == 0, 0.0, y)
    z = np.where(draw.integers(count, 0, 3) == 0, 6 * z, z)
    row = stack(size, *_equal_coordinates(draw, size, x, y, z))
    quartet = np.repeat(row, 4, axis=0)
    quartet[1::4, 4:] = row[:, [6, 4, 5]]
    quartet[2::4, :4] = row[:, [1, 0, 3, 2]]
    quartet[3::4, [0, 2]] = 2 * row[:, [0, 2]]
    rows = quartet[:n]
    for column in range(4, 7):
        rows[:, column] = np.where(rows[:, column] == 0, 0.0 * draw.signs(n), rows[:, column])
    return rows


def _equal_sizes(draw: Draw, alpha: Floats, gamma: Floats, b: Floats, d: Floats) -> Sizes:
    """Leave half of the sizes as they are; in the others make two, two pairs or all four equal, or all of them 1."""
    kind = draw.integers(len(b), 0, 11)
    ball, crossed = (kind >= 6) & (kind <= 9), kind == 11
    one = np.where(kind == 9, 1.0, b)
    waist = np.where((kind >= 8) & (kind <= 10), one, np.where(crossed, d, alpha))
    flare = np.where((kind >= 7) & (kind <= 9), waist, np.where(kind == 10, d, np.where(crossed, b, gamma)))
    return Sizes(waist, flare, one, np.where(ball, one, d))


def _equal_coordinates(draw: Draw, size: Sizes, x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats, Floats]:
    """Leave half of the centres as they are; in the others make two or three coordinates equal, or z ±γ or ±d."""
    kind, sign = draw.integers(len(x), 0, 9), draw.signs(len(x))
    y = np.where((kind == 5) | (kind == 6), sign * x, y)
    z = np.where((kind == 6) | (kind == 7), x, z)
    return x, y, np.where(kind == 8, sign * size.gamma, np.where(kind == 9, sign * size.d, z))


def symmetric_images(draw: Draw, n: int) -> Rows:
    """Make sixteen images of a pair in consecutive rows: x, y swapped, signs turned (−0.0 included), other units."""
    pairs = -(-n // 16)
    a, c = all_regimes(draw, pairs)
    side = nearly_touching(draw, pairs, -40, -2)
    size = sizes(draw, a, c)
    rows = np.repeat(beside(draw, size, draw.unit(pairs) * 2 * np.maximum(c, 1), side), 16, axis=0)[:n]
    image = np.arange(n) % 16
    for column, bit in ((4, 1), (5, 2), (6, 4)):
        rows[:, column] = np.where(image & bit != 0, -rows[:, column], rows[:, column])
    swapped = image & 8 != 0
    rows[:, 4:6] = np.where(swapped[:, None], rows[:, 5:3:-1], rows[:, 4:6])
    radial, axial = ((0, 2, 4, 5), 3), ((1, 3, 6), -2)
    for columns, step in (radial, axial):
        for column in columns:
            rows[:, column] = ldexp(rows[:, column], np.where(swapped, step, 0))
    return rows


TURN = 2 * len(COLUMNS)
"""The number of consecutive rows of one pair: as it is, α changed, α as it was but for an ulp, γ changed, and so on."""


def one_number_changed(draw: Draw, n: int) -> Rows:
    """Repeat pairs that are 2⁻¹⁴ to 2⁻⁶ radii from contact, and change one number from row to row.

    A number changes by 1/16 of itself or more, so that many rows are on the other side of contact.
    """
    pairs = -(-n // TURN)
    size = sizes_of_all_regimes(draw, pairs)
    offset = nearly_touching(draw, pairs, -14, -6)
    rows = np.repeat(beside(draw, size, heights(draw, size.c), offset), TURN, axis=0)[:n]
    return changed_in_turn(rows, by_sixteenths(draw, rows), range(len(COLUMNS)))


def by_sixteenths(draw: Draw, rows: Rows) -> Rows:
    """Multiply all numbers of each row by one factor that differs from 1 by 1/16 or more."""
    n = len(rows)
    return np.asarray(rows * (1 + draw.signed(n, -4, 0))[:, None])


def repeated(pairs: Rows, columns: Sequence[int], n: int, centres: int = 6) -> Rows:
    """Repeat each pair 2·len(columns) times, n rows in all, with b/64 in place of zeros, which no factor changes.

    `centres` is the number of columns of coordinates, from column 4 on, in which zeros are replaced.
    """
    places = pairs[:, 4 : 4 + centres]
    full = np.where(places == 0, pairs[:, 2:3] / 64, places)
    pairs = np.concatenate([pairs[:, :4], full, pairs[:, 4 + centres :]], axis=1)
    return np.repeat(pairs, 2 * len(columns), axis=0)[:n]


def each_with_one_number_changed(draw: Draw, pairs: Rows, columns: Sequence[int], n: int, centres: int = 6) -> Rows:
    """Repeat each pair, or sweep, and change one number from row to row, n rows in all."""
    rows = repeated(pairs, columns, n, centres)
    return changed_in_turn(rows, by_sixteenths(draw, rows), columns)


def changed_in_turn(rows: Rows, others: Rows, columns: Sequence[int]) -> Rows:
    """Change one number from each row to the next; each 2·len(columns) consecutive rows are equal before.

    In every second row a column has the number of `others`, one column after the other; from then on it is an ulp
    larger than before.
    """
    place = np.full(rows.shape[1], len(columns))
    place[list(columns)] = np.arange(len(columns))
    turn = (np.arange(len(rows)) % (2 * len(columns)))[:, None]
    ulp_up = stepped(rows, np.ones(rows.shape, dtype=np.int64))
    changed_now = (turn % 2 == 1) & (place == turn // 2)
    return np.where(changed_now, others, np.where(place < turn // 2, ulp_up, rows))


TOWER = (2.0, 17.8)
BODY = (0.25, 0.15)
ROTOR = (0.1, 0.05)
ARM = 0.135
"""Distance of a rotor's centre from the body's, metres. The paper does not print it; this one fits its Table 5."""

FLIGHT_STEPS = 32


def _metres(draw: Draw, n: int, low: int, high: int) -> Floats:
    """Draw whole centimetres from low to high, in metres, as a person would write a size down."""
    return draw.integers(n, low, high) / 100.0


def _walker(draw: Draw, n: int) -> tuple[Floats, Floats]:
    """Draw b and d of a person: 50 to 90 cm across, 1.4 to 2 m tall."""
    return _metres(draw, n, 25, 45), _metres(draw, n, 70, 100)


def _trunk(draw: Draw, b: Floats, d: Floats, alpha: Floats) -> Sizes:
    """Draw trunks of waist α that widen slowly enough for (γ/d)² ≥ α/b, with a margin for roundings."""
    least = d * np.sqrt(np.maximum(alpha / b, 1.0))
    return Sizes(alpha, least * draw.between(len(b), 1.02, 4), b, d)


def forest_type_1(draw: Draw, n: int) -> Rows:
    """Make rows with trunks wider than the walker, who is within 2 m of the height of the trunk's waist."""
    b, d = _walker(draw, n)
    size = _trunk(draw, b, d, b * draw.between(n, 1, 6))
    return beside(draw, size, draw.between(n, 0, 2) / d, offsets(draw, n))


def forest_type_2(draw: Draw, n: int) -> Rows:
    """Make rows with trunks narrower than the walker; in a third she is so high that even such a trunk is as wide."""
    b, d = _walker(draw, n)
    size = _trunk(draw, b, d, b * draw.between(n, 0.2, 0.99))
    aloft = draw.places(n) % 3 == 0
    height = np.where(aloft, size.c / size.a * draw.between(n, 1, 2.5), draw.between(n, 0, 2) / d)
    return beside(draw, size, height, np.where(aloft, -1, 1) * np.abs(offsets(draw, n)))


def _in_tower(n: int, mover: tuple[float, float], x: Floats, y: Floats, z: Floats) -> Rows:
    """Make the rows of a mover (b, d) with these centres in the paper's tower."""
    alpha, gamma, b, d = (np.full(n, value) for value in TOWER + mover)
    return stack(Sizes(alpha, gamma, b, d), x, y, z)


def _box(draw: Draw, n: int) -> tuple[Floats, Floats, Floats]:
    """Draw centres uniform in a box that holds the tower."""
    return draw.between(n, -4, 4), draw.between(n, -4, 4), draw.between(n, -TOWER[1], TOWER[1])


def tower_body(draw: Draw, n: int) -> Rows:
    """Make rows of the quadcopter's body, uniform in a box that holds the tower."""
    return _in_tower(n, BODY, *_box(draw, n))


def _radius(z: Floats) -> Floats:
    """Return the tower's radius at height z."""
    ratio = z / TOWER[1]
    return np.asarray(TOWER[0] * np.sqrt(1 + ratio * ratio))


def tower_rotors(draw: Draw, n: int) -> Rows:
    """Make rows of a body's four rotors, equation (15), one after the other; half of the bodies are near contact."""
    bodies = -(-n // 4)
    x, y, z = _box(draw, bodies)
    cosine, sine = draw.circle(bodies)
    radius = _radius(z) + draw.between(bodies, -0.3, 0.3)
    by_the_wall = np.arange(bodies) % 2 == 0
    x, y = np.where(by_the_wall, radius * cosine, x), np.where(by_the_wall, radius * sine, y)
    ahead, aside = draw.circle(bodies)  # (15) is a step of l at g₁ + π/4, and a quarter turn from rotor to rotor
    x = np.stack([x + ARM * ahead, x - ARM * aside, x - ARM * ahead, x + ARM * aside], axis=1).ravel()
    y = np.stack([y + ARM * aside, y + ARM * ahead, y - ARM * aside, y - ARM * ahead], axis=1).ravel()
    return _in_tower(n, ROTOR, x[:n], y[:n], np.repeat(z, 4)[:n])


def flight(draw: Draw, n: int) -> Rows:
    """Make rows of the positions to which random flights move (section 4, FLIGHT_STEPS moves each).

    Moves that the flight refuses are included.

    A move of v·t (5–10 m/s, 0.1–0.3 s) goes straight, up or down, or aside by at most π/4; where it would leave the
    tower, the quadcopter stays and turns by π/2. Half of the flights keep near the wall.
    """
    flights = -(-n // FLIGHT_STEPS)
    ahead, aside = draw.circle(flights)
    z = draw.between(flights, -TOWER[1], TOWER[1])
    radius = np.where(np.arange(flights) % 2 == 0, draw.between(flights, 0, 1.7), _radius(z) - 0.4)
    cosine, sine = draw.circle(flights)
    x, y = radius * cosine, radius * sine
    step = draw.between(flights, 5, 10) * draw.between(flights, 0.1, 0.3)
    places = np.empty((3, flights, FLIGHT_STEPS))
    for move in range(FLIGHT_STEPS):
        chance, sense = draw.unit(flights), draw.signs(flights)
        turn_cosine, turn_sine = circle_at(np.where(chance < 0.5, draw.between(flights, -0.414, 0.414), 0.0))
        ahead, aside = ahead * turn_cosine - aside * turn_sine, ahead * turn_sine + aside * turn_cosine
        vertical = chance >= 0.75
        sense = np.where(np.abs(z + sense * step) > TOWER[1], -sense, sense)
        to = (
            np.where(vertical, x, x + step * ahead),
            np.where(vertical, y, y + step * aside),
            np.where(vertical, z + sense * step, z),
        )
        places[:, :, move] = to
        valid = np.sqrt(to[0] * to[0] + to[1] * to[1]) < _radius(to[2]) - 0.26
        x, y, z = (np.where(valid, after, before) for after, before in zip(to, (x, y, z), strict=True))
        ahead, aside = np.where(valid, ahead, -sense * aside), np.where(valid, aside, sense * ahead)
    return _in_tower(n, BODY, *places.reshape(3, -1)[:, :n])
