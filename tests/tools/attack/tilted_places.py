"""Rows of tilted spheroids around the borders of the positions, and scenes with one axis.

Everything is computed in float64, which is accurate enough to come near a border; the truth is decided afterwards.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tests.tools.attack.places import Scene, offsets, sizes


def axes(random: np.random.Generator, turn: np.ndarray) -> np.ndarray:
    """Axes of every kind and of any length: (n, 3).

    Any direction, in the meridian plane at `turn`, across it, horizontal, almost upright, almost horizontal, of small
    whole numbers, and with numbers of very different magnitude.
    """
    count = len(turn)
    found = random.normal(size=(count, 3))
    style = random.integers(0, 9, count)
    lean = random.uniform(-1.6, 1.6, count)
    tiny = np.exp2(-random.uniform(1, 60, count))
    meridian = np.column_stack([np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)])
    across = np.column_stack([-np.sin(turn), np.cos(turn), np.zeros(count)])
    for number, some in ((0, meridian), (1, across), (2, found * [1, 1, 0]), (3, across + meridian * tiny[:, None])):
        found[style == number] = some[style == number]
    found[style == 4, :2] *= tiny[style == 4, None]
    found[style == 5, 2] *= tiny[style == 5]
    found[style == 6] = random.integers(-3, 4, ((style == 6).sum(), 3))
    found[style == 7] *= np.exp2(random.uniform(-300, 300, ((style == 7).sum(), 3)))
    with np.errstate(over="ignore"):
        found *= np.exp2(random.choice([0, 0, 0, 39, -39, 41, -41, 1000, -1040], count))[:, None]
    found = np.nan_to_num(found)  # infinities become the greatest numbers
    found[~(found != 0).any(axis=1)] = [1.0, 0.0, 1.0]
    return found


def basis(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of sizes and axes (n, 7): 1/A1, 1/A2, −1/B in falling order (n, 3), and what takes their coordinates to C."""
    alpha, gamma, b, d, *axis = rows.T
    with np.errstate(all="ignore"):
        v = np.stack(axis, axis=1) / np.abs(np.stack(axis, axis=1)).max(axis=1, keepdims=True)
        v /= np.sqrt((v * v).sum(axis=1, keepdims=True))
    root = b[:, None, None] * np.eye(3) + (d - b)[:, None, None] * v[:, :, None] * v[:, None, :]  # M^(-1/2)
    diagonal = np.stack([alpha**-2, alpha**-2, -(gamma**-2)], axis=1)
    values, vectors = np.linalg.eigh(root @ (diagonal[:, :, None] * root))
    return values[:, ::-1], (root @ vectors)[:, :, ::-1]


def near_contact(random: np.random.Generator, count: int, one: bool = False) -> np.ndarray:
    """Rows whose centres are almost one radius from a point of the surface, along its normal: (count, 10).

    With `one` all have the same sizes and the same axis.
    """
    turn = random.uniform(0, 2 * np.pi, count) * (random.integers(0, 3, count) > 0)
    if one:
        some, axis = np.repeat(sizes(random, 1), count, axis=0), np.repeat(axes(random, turn[:1]), count, axis=0)
    else:
        some, axis = sizes(random, count), axes(random, turn)
    alpha, gamma, b, d = some.T
    slope = np.where(random.integers(0, 4, count) == 0, 0.0, np.sinh(random.uniform(-3, 3, count)))
    rho, zeta = alpha * np.sqrt(1 + slope * slope), gamma * slope
    point = np.column_stack([rho * np.cos(turn), rho * np.sin(turn), zeta])
    normal = point * np.column_stack([alpha**-2, alpha**-2, -(gamma**-2)])
    with np.errstate(all="ignore"):
        v = axis / np.abs(axis).max(axis=1, keepdims=True)
        v /= np.sqrt((v * v).sum(axis=1, keepdims=True))
    along = (v * normal).sum(axis=1, keepdims=True) * v
    way = (b * b)[:, None] * (normal - along) + (d * d)[:, None] * along
    step = random.choice([-1.0, 1.0], count) * (1 + offsets(random, count)) / np.sqrt((way * normal).sum(axis=1))
    return np.nan_to_num(np.column_stack([some, point + step[:, None] * way, axis]))


def at_a_pole(random: np.random.Generator, count: int) -> np.ndarray:
    """Rows beside those where a pole is a double root, and the pair clear all the same: (count, 10)."""
    turn = random.uniform(0, 2 * np.pi, count)
    some, axis = sizes(random, count), axes(random, turn)
    axis[::2, random.integers(0, 3)] = 0.0
    axis[~(axis != 0).any(axis=1)] = [1.0, 0.0, 0.0]
    values, back = basis(np.column_stack([some, axis]))
    with np.errstate(all="ignore"):
        A1, A2, B = 1 / values[:, 0], 1 / values[:, 1], -1 / values[:, 2]
        share = random.uniform(0, 1, count) * (random.integers(0, 3, count) > 0)
        tiny = offsets(random, count) * 1e-4 * (random.integers(0, 2, count) > 0)
        edge = np.sqrt(1 + offsets(random, count))
        outer = [(A1 + B) * np.sqrt(share / A1) * edge, (A2 + B) * np.sqrt((1 - share) / A2) * edge, tiny]
        height = random.uniform(0, 3, count) * (random.integers(0, 3, count) > 0)
        inner = [tiny, (A2 - A1) * np.sqrt((1 + B * (height / (B + A1)) ** 2) / A2) * edge, height]
        coordinates = np.where(random.integers(0, 2, count) == 0, np.stack(outer), np.stack(inner)).T
        centre = (back @ coordinates[:, :, None])[:, :, 0]
    centre[~np.isfinite(centre)] = 1.0
    return np.column_stack([some, centre, axis])


def grid(random: np.random.Generator, count: int) -> np.ndarray:
    """Small whole numbers and halves: true tangencies among them: (count, 10)."""
    whole = random.integers(1, 7, (count, 4))
    centre = random.integers(-14, 15, (count, 3)) / 2
    centre[random.integers(0, 2, count) == 0, 1] = 0
    axis = random.integers(-2, 3, (count, 3))
    axis[~(axis != 0).any(axis=1)] = [1, 0, 0]
    return np.column_stack([whole, centre, axis]).astype(float)


def at_the_limits(random: np.random.Generator, count: int) -> np.ndarray:
    """Rows near contact whose squares, b, centre and multiplier are about as large or small as floats may decide."""
    rows = near_contact(random, count)
    unit = np.exp2(random.choice([0, 300, 299, -299, -300, 900, -900], count))
    with np.errstate(all="ignore"):
        for column in (0, 1, 3):
            near = random.integers(0, 3, count) == 0
            rows[near, column] = (rows[:, 2] * np.exp2(random.choice([-27.0, 27.0], count)))[near]
            rows[near, column] *= 1 + random.choice([0, 1e-16, -1e-16, 1e-3, -1e-3], near.sum())
        away = random.integers(0, 4, count) == 0
        rows[away, 4:7] *= np.exp2(random.uniform(0, 60, (away.sum(), 1)))
        rows[:, :7] *= unit[:, None]
    rows[:, :7] = np.clip(np.nan_to_num(rows[:, :7]), -1e308, 1e308)
    rows[:, :4] = np.maximum(rows[:, :4], 5e-324)
    return rows


def far(random: np.random.Generator, count: int) -> np.ndarray:
    """Rows whose centres are 2^45 radii away and more, up to the limits of float64: (count, 10)."""
    rows = near_contact(random, count)
    with np.errstate(all="ignore"):
        rows[:, 4:7] *= np.exp2(random.uniform(45, random.choice([60.0, 130.0, 520.0, 1020.0], count)))[:, None]
    rows[:, 4:7] = np.nan_to_num(rows[:, 4:7])
    return rows


def scenes(random: np.random.Generator, count: int, size: int) -> Iterator[Scene]:
    """Scenes of one axis with centres beside the surface; every third has half of them far or near the origin."""
    for number in range(count):
        rows = near_contact(random, size, one=True)
        if number % 3 == 2:
            rows[::2, 4:7] *= float(random.choice([1e-300, 1e-160, 1e-9, 1e12, 1e40, 1e150]))
        x, y, z = np.ascontiguousarray(rows[:, 4:7].T)
        yield Scene(f"tilted-{number}", tuple(rows[0, :4].tolist()), x, y, z, tuple(rows[0, 7:].tolist()))


def on_the_planes(random: np.random.Generator, count: int, size: int) -> Iterator[Scene]:
    """Scenes whose centres are within units of where the kernel's first half spaces touch the border of contact.

    A half space of one λ touches it where φ(λ) = φ′(λ) = 0: along a line in P1, P2, Q, each a share of P1.
    """
    found = 0
    while found < count:
        four, axis = sizes(random, 1)[0], random.normal(size=3)
        values, back = basis(np.array([[*four, *axis]]))
        A1, A2, B = 1 / values[0, 0], 1 / values[0, 1], -1 / values[0, 2]
        top, side = float(np.exp2(random.uniform(-6, 6)) * B), 1 - 2 * (found % 2)
        at = side * _best_multiplier((A1 + A2) / 2, B, 0.3 * 1.125 * top, side)
        share = random.uniform(0, 1, size)
        with np.errstate(all="ignore"):
            both = share * A1 / (A1 + at) + (1 - share) * A2 / (A2 + at)
            Q = (both * (1 + 1 / at) - 1) / (B / (B - at) ** 2 - both / (B - at))
            whole = 1 + 1 / at + Q / (B - at)
            P1, P2 = share * whole * (A1 + at), (1 - share) * whole * (A2 + at)
            edge = 1 + random.integers(-200, 201, size) * 2.0**-53
            signs = random.choice([-1.0, 1.0], (3, size))
            coordinates = np.stack([np.sqrt(P1) * edge, np.sqrt(P2) * edge, np.sqrt(Q)]) * signs
        there = np.isfinite(coordinates).all(axis=0) & (Q <= top)
        if there.mean() < 0.25:
            continue
        found += 1
        coordinates[:, ~there] = 0.0
        coordinates[2, :: max(1, size // 128)] = np.sqrt(top)  # so that every sample of heights sees it and lower ones
        x, y, z = np.ascontiguousarray(back[0] @ coordinates)
        yield Scene(f"planes-{found}", tuple(four.tolist()), x, y, z, tuple(axis.tolist()))


def _best_multiplier(A: float, B: float, Q: float, side: int) -> float:
    """As hc_best_multiplier of the kernel chooses it (core/parts/scene.h)."""
    weight = Q * (A + B)
    at = float(np.sqrt(A / (1 + weight / (B * B))))
    at = min(at, 0.99 * B) if side > 0 else at
    for _ in range(4):
        inverse, other = 1 / at, 1 / (B - side * at)
        first, second = A * inverse**2, weight * other**2
        moved = at + (first - 1 - second) / (2 * (first * inverse + side * second * other))
        if not 0.25 * at < moved < 4 * at:
            break
        at = min(moved, (at + B) / 2) if side > 0 else moved
    return at
