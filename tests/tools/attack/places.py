"""Rows around the borders of the three positions, and scenes around the lines that decide them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hypcheck.vectors.families import FAMILIES


@dataclass(frozen=True)
class Scene:
    """One spheroid at many centres."""

    name: str
    sizes: tuple[float, float, float, float]
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    axis: tuple[float, float, float] | None = None

    @property
    def rows(self) -> np.ndarray:
        """The same as rows, (n, 7), or (n, 10) with an axis."""
        sizes, axis = (np.tile(each or (), (len(self.x), 1)) for each in (self.sizes, self.axis))
        return np.column_stack([sizes, self.x, self.y, self.z, axis])


def families(seed: int, count: int) -> Iterator[tuple[str, np.ndarray]]:
    """Every family of the casebook, the extreme ones in smaller number: their integers have thousands of digits."""
    for family in FAMILIES.values():
        yield "families", family.rows(seed, count // 20 if family.extreme else count)


def sizes(random: np.random.Generator, count: int) -> np.ndarray:
    """α, γ, b, d of all four regimes: ordinary, stiff, next to a = 1 and to c² = a, small numbers: (count, 4)."""
    spread = np.array([1, 4, 12, 30])[random.integers(0, 4, count)]
    b, d = np.exp2(random.uniform(-4, 4, (2, count)))
    a, c = np.exp2(random.uniform(-1, 1, (2, count)) * spread)
    near = random.integers(0, 6, count)
    tiny = 1 + random.choice([-1, 0, 1], count) * np.exp2(random.uniform(-52, -4, count))
    a = np.where(near == 0, tiny, a)
    c = np.where(near == 1, np.sqrt(a) * tiny, c)
    found = np.column_stack([a * b, c * d, b, d])
    whole = near == 2
    found[whole] = random.integers(1, 13, (whole.sum(), 4))
    return found


def offsets(random: np.random.Generator, count: int) -> np.ndarray:
    """Relative distances from contact of either sign, 0 and 1e-17 … 1."""
    size = 10.0 ** -random.choice([0, 2, 4, 6, 8, 10, 11, 12, 13, 14, 14.5, 15, 15.3, 15.6, 16, 17], count)
    return size * random.uniform(-2, 2, count)


def beside(random: np.random.Generator, some: np.ndarray, count: int, reach: float = 3.0) -> np.ndarray:
    """Centres almost one radius from a point of the surface, along its normal, on either side: (count, 3)."""
    alpha, gamma, b, d = some.T
    a, c = alpha / b, gamma / d
    slope = np.where(random.integers(0, 4, count) == 0, 0.0, np.sinh(random.uniform(-reach, reach, count)))
    rho, zeta = a * np.sqrt(1 + slope * slope), c * slope
    across, along = rho / (a * a), -zeta / (c * c)
    length = np.hypot(across, along)
    step = random.choice([-1.0, 1.0], count) * (1 + offsets(random, count)) / length
    r, z = (rho + across * step) * b, (zeta + along * step) * d
    turn = random.uniform(0, 2 * np.pi, count) * (random.integers(0, 3, count) > 0)
    return np.column_stack([r * np.cos(turn), r * np.sin(turn), z])


def near_contact(random: np.random.Generator, count: int) -> np.ndarray:
    """Rows of any sizes whose centres are beside the surface: (count, 7)."""
    some = sizes(random, count)
    return np.column_stack([some, beside(random, some, count)])


def on_the_ring(random: np.random.Generator, count: int) -> np.ndarray:
    """Rows within a few units in the last place, or a little more, of the ring where Δ vanishes: (count, 7)."""
    some = sizes(random, count)
    alpha, gamma, b, d = some.T
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    r = b * np.sqrt((A + B) * (B + 1) / B) * (1 + offsets(random, count))
    z = np.where(random.integers(0, 2, count) == 0, 0.0, d * offsets(random, count) * 1e-4)
    return np.column_stack([some, r, np.zeros(count), z])


def grid(random: np.random.Generator, count: int) -> np.ndarray:
    """Small whole numbers and halves: true tangencies and rings, about one row in a thousand: (count, 7)."""
    whole = random.integers(1, 13, (count, 4))
    centre = random.integers(-28, 29, (count, 3)) / 2
    centre[random.integers(0, 2, count) == 0, 1] = 0
    return np.column_stack([whole, centre]).astype(float)


def scenes(random: np.random.Generator, count: int, size: int) -> Iterator[Scene]:
    """Scenes with centres beside the surface at all heights, in a high band, at one height, at the waist, on the axis.

    The last two are also so near the origin that squares underflow.
    """
    for number in range(count):
        four = sizes(random, 1)
        some = np.repeat(four, size, axis=0)
        centres = beside(random, some, size, reach=float(random.uniform(0.05, 3)))
        style = number % 5
        if style == 1:
            centres[:, 2] = np.abs(centres[:, 2]) + np.abs(centres[:, 2]).max()
            centres[:, :2] *= _edge_scale(four[0], centres, random)[:, None]
        elif style == 2:
            centres[:, 2] = centres[0, 2]
            centres[:, :2] *= _edge_scale(four[0], centres, random)[:, None]
        elif style == 3:
            centres[:, 2] *= random.choice([0.0, 1e-200, 1e-9, 1e-3], size)
        elif style == 4:
            four[0, [0, 1]] = four[0, [2, 3]] * random.choice([1.0, 1.0, 0.5, 2.0], 2)  # a = 1 more often than not
            centres = random.uniform(-1, 1, (size, 3)) * random.choice([1e-300, 1e-200, 1e-160, 1e-9, 1.0])
            centres[::2, :2] = 0.0
        x, y, z = np.ascontiguousarray(centres.T)
        yield Scene(f"scene-{number}-{style}", tuple(four[0].tolist()), x, y, z)


def wild_scenes(random: np.random.Generator, count: int, size: int) -> Iterator[Scene]:
    """Scenes of any sizes at all, with centres of any magnitude: what the choice of lines must survive."""
    for number in range(count):
        spread = random.choice([1, 5, 20, 60, 110, 300, 1000])
        four = np.exp2(random.uniform(-spread, spread, 4))
        reach = np.array([four[0] + four[2], four[0] + four[2], four[1] + four[3]])
        with np.errstate(all="ignore"):
            centres = random.uniform(-1, 1, (size, 3)) * reach * random.choice([1e-300, 1e-9, 1, 1, 30, 1e9, 1e200])
        centres[~np.isfinite(centres)] = 1.0
        centres[:: random.integers(1, 9), random.integers(0, 3)] = 0.0
        yield Scene(f"wild-{number}", tuple(four.tolist()), *np.ascontiguousarray(centres.T))


def on_the_lines(random: np.random.Generator, count: int, size: int) -> Iterator[Scene]:
    """Scenes whose heights are those at which the kernel's lines touch the border, and centres a few units from it."""
    for number in range(count):
        four = sizes(random, 1)[0]
        top = float(np.exp2(random.uniform(-3, 5)) * max(four[1], four[3]))
        high = _short(1.0625 * top)
        middle = _short(0.55 * high)
        special = [top, middle, high, middle / np.sqrt(2), np.sqrt((middle**2 + high**2) / 2), 0.0]
        z = random.choice(special, size)
        z[:: max(1, size // 1024)] = top  # so that every sample of heights sees it, and none that is higher
        z = np.minimum(z, top)
        centres = np.column_stack([np.ones(size), np.zeros(size), z])
        x = _edge_scale(four, centres, random, units=60)
        yield Scene(f"lines-{number}", tuple(four.tolist()), x, np.zeros(size), z)


def far(random: np.random.Generator, count: int) -> np.ndarray:
    """Rows whose centres are 2^60 radii away and more, up to the limits of float64: (count, 7).

    On the axis, in the plane of the waist, along the cone that the surface approaches, and anywhere. One half has sizes
    of all regimes, the other also sizes of any magnitude at which floats may decide, and beyond.
    """
    some = sizes(random, count)
    wild = random.integers(0, 2, count) == 0
    spread = random.choice([60.0, 100.0, 300.0], count)
    some[wild] *= np.exp2(random.uniform(-1, 1, (count, 1)) * spread[:, None])[wild]
    some[wild, 1] *= np.exp2(random.uniform(-99, 99, count))[wild]
    some[wild, 3] *= np.exp2(random.uniform(-99, 99, count))[wild]
    return np.column_stack([some, _far_centres(random, some, count)])


def far_scenes(random: np.random.Generator, count: int, size: int) -> Iterator[Scene]:
    """Scenes with such centres; a third of them has most heights nearby, so that lines are made for those."""
    for number in range(count):
        four = far(random, 1)[0, :4]
        centres = _far_centres(random, np.repeat(four[None], size, axis=0), size)
        if number % 3 == 0:
            near = random.integers(0, 8, size) > 0
            centres[near, 2] = random.uniform(-4, 4, near.sum()) * four[1]
        yield Scene(f"far-{number}", tuple(four.tolist()), *np.ascontiguousarray(centres.T))


def _far_centres(random: np.random.Generator, some: np.ndarray, count: int) -> np.ndarray:
    alpha, gamma, b, d = some.T
    style = random.integers(0, 4, count)
    away = np.exp2(random.uniform(60, random.choice([130.0, 200.0, 520.0, 1020.0], count)))
    turn = random.uniform(0, 2 * np.pi, count) * (random.integers(0, 3, count) > 0)
    with np.errstate(all="ignore"):
        r = np.where(style == 3, b * np.exp2(random.uniform(60, 1020, count)), b * away)
        z = np.where(style == 3, d * away, r * (gamma / alpha) * (1 + offsets(random, count)))
        r, z = np.where(style == 0, 0.0, r), np.where(style == 0, d * away, np.where(style == 1, 0.0, z))
    r, z = (np.nan_to_num(each, nan=np.finfo(np.float64).max) for each in (r, z))  # infinities become the greatest too
    return np.column_stack([r * np.cos(turn), r * np.sin(turn), z * random.choice([-1.0, 1.0], count)])


def _short(value: float) -> float:
    mantissa, exponent = np.frexp(value)
    return float(np.ldexp(np.floor(mantissa * 2**26), exponent - 26))


def _edge_scale(four: np.ndarray, centres: np.ndarray, random: np.random.Generator, units: int = 0) -> np.ndarray:
    """Factors that bring each centre's radius to one of the two borders at its height, or within `units` of 2⁻⁵³."""
    alpha, gamma, b, d = four
    A, B, Q = (alpha / b) ** 2, (gamma / d) ** 2, (centres[:, 2] / d) ** 2
    side = random.choice([-1.0, 1.0], len(Q))
    low, high = np.zeros(len(Q)), np.where(side > 0, min(np.sqrt(A), B), np.sqrt(A))
    for _ in range(60):
        middle = (low + high) / 2
        with np.errstate(all="ignore"):
            rising = A / middle**2 > 1 + Q * (A + B) / (B - side * middle) ** 2
        low, high = np.where(rising, middle, low), np.where(rising, high, middle)
    at = side * low
    with np.errstate(all="ignore"):
        edge = np.sqrt(np.maximum((A + at) * (1 + 1 / at) + Q * (A + at) / (B - at), 0))
    shift = random.integers(-units, units + 1, len(Q)) * 2.0**-53 if units else offsets(random, len(Q))
    radius = np.hypot(centres[:, 0], centres[:, 1])
    with np.errstate(all="ignore"):
        scale = b * edge * (1 + shift) / radius
    return np.where(np.isfinite(scale), scale, 1.0)
