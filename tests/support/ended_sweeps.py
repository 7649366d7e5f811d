"""Ways beside hyperboloids that end, drawn: through the neighbourhood of a rim, and past the whole of a tower."""

from __future__ import annotations

import numpy as np


def near_a_rim(seed, count, *, tilted=False, hair=-30):
    """Ways through a place from 2^`hair` to 1/2 radii off contact with a rim: (n, 16), every second pair solid.

    Every other one goes along the plane that separates the spheroid from the rim, so that it is nearest there.
    """
    random = np.random.default_rng(seed)
    sizes, axis = _sizes(random, count), _axes(random, count, tilted=tilted)
    alpha, gamma, b, d = sizes.T
    height, azimuth, turn = random.uniform(-2, 2, count) * gamma, *random.uniform(0, np.pi, (2, count))
    radius = alpha * np.hypot(1, height / gamma)
    level = np.stack([np.cos(2 * azimuth), np.sin(2 * azimuth)], axis=1)
    rim = np.column_stack([radius[:, None] * level, height])
    normal = np.column_stack([np.cos(turn)[:, None] * level, np.sin(turn)])
    unit = axis / np.linalg.norm(axis, axis=1)[:, None]
    along = (normal * unit).sum(axis=1)[:, None] * unit
    shift = (b * b)[:, None] * (normal - along) + (d * d)[:, None] * along
    hairs = 1 + random.choice([-1, 1], count) * np.exp2(random.uniform(hair, -1, count))
    place = rim + shift * (hairs / np.sqrt((normal * shift).sum(axis=1)))[:, None]
    step = random.normal(size=(count, 3)) * np.stack([b, b, d], axis=1) * np.exp2(random.uniform(-3, 4, count))[:, None]
    step[::2] -= ((step * normal).sum(axis=1)[:, None] * normal)[::2]
    share = random.uniform(0, 1, count)[:, None]
    return _with_ends(random, sizes, (place - share * step, place + (1 - share) * step), axis, height)


def past_a_tower(seed, count, *, tilted=False):
    """Ways between two places all about the upper end of a tower: (n, 16), every second pair solid."""
    random = np.random.default_rng(seed)
    sizes, axis = _sizes(random, count), _axes(random, count, tilted=tilted)
    alpha, gamma, b, d = sizes.T
    height = random.uniform(-2, 2, count) * gamma
    spread = np.stack([alpha + b, alpha + b, d], axis=1)
    places = random.normal(size=(2, count, 3)) * 2 * spread + [0, 0, 1] * height[None, :, None]
    return _with_ends(random, sizes, places, axis, height)


def _sizes(random, count):
    return np.exp2(random.uniform(-3, 3, (count, 4)))


def _axes(random, count, *, tilted):
    return random.normal(size=(count, 3)) if tilted else np.tile([0.0, 0.0, 1.0], (count, 1))


def _with_ends(random, sizes, places, axis, height):
    """The rows, half of them mirrored at z = 0; the lower end may be missing."""
    count = len(sizes)
    low = height - sizes[:, 1] * np.exp2(random.uniform(-3, 2, count))
    low[random.uniform(size=count) < 0.4] = -np.inf
    rows = np.column_stack([sizes, *places, axis, low, height, np.arange(count) // 2 % 2])
    down = random.uniform(size=count) < 0.5
    rows[np.ix_(down, [6, 9, 12])] *= -1
    rows[np.ix_(down, [13, 14])] = -rows[np.ix_(down, [14, 13])]
    return np.ascontiguousarray(rows + 0.0)
