"""Centres about the ends of a whole scene's hyperboloids, where its kernel answers by bounds or not at all."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import permutations

import numpy as np

from hypcheck.geometry.rows import CANNOT_SAY, Floats, Mask, Positions
from hypcheck.scene.model import Hyperboloid, SceneModel
from tests.support.inside import Scene

COUNT = 100
"""Centres of each kind about each end."""

BOTH = 24
"""Centres where two walls cross at a height about an end of the first."""

ROUNDING = 2.0**-45
"""Lengths are known to about this share where a kernel compares heights with ends (templates/whole.c.tmpl)."""

Ask = Callable[[Floats], Positions]
"""What a kernel answers of x, y, z and the heading, (4, n)."""


def ask_ends(scene: SceneModel, ask: Ask) -> None:
    """Asks about every end, and raises AssertionError where an answer is neither what the scene says nor 2.

    Some centres about ends are answered, and of some nothing is said. Contact is, of a mover without parts, where it
    surely reaches to both sides of a wall at its own height.
    """
    columns = np.concatenate(list(_about(scene)), axis=1)
    right, given = Scene(scene).classify(*columns), ask(columns)
    span = scene.region.z
    if span is not None:
        right = np.where((columns[2] < span.low) | (columns[2] > span.high), CANNOT_SAY, right)
    wrong = (given != right) & (given != CANNOT_SAY)
    assert not wrong.any(), (columns.T[wrong][:3], given[wrong][:3], right[wrong][:3])
    assert {*right.tolist(), CANNOT_SAY} == set(given.tolist())
    if not scene.mover.parts:
        crossing = _crossing(scene, columns)
        assert crossing.any()
        assert (given[crossing] == right[crossing]).all()


def _crossing(scene: SceneModel, columns: Floats) -> Mask:
    """Whether a mover reaches a good deal over both sides of a wall at a height between its ends."""
    crossing = np.zeros(columns.shape[1], bool)
    for body in scene.hyperboloids:
        (x, y, z), level = body.center, columns[2]
        low, high = sorted(ends_of(body)) or (-np.inf, np.inf)
        off = np.hypot(columns[0] - x, columns[1] - y) - body.alpha * np.hypot(1, (level - z) / body.gamma)
        crossing |= (abs(off) < scene.mover.b / 2) & (level > low + 1e-9) & (level < high - 1e-9)
    return crossing


def ends_of(body: Hyperboloid) -> list[float]:
    """The heights of its ends in the scene: its own count from its centre, downwards if its axis points down."""
    span, sense = body.height, np.sign(body.axis[2])
    return [] if span is None else [float(body.center[2] + sense * end) for end in (span.low, span.high)]


def _about(scene: SceneModel) -> Iterator[Floats]:
    random, spheroids = np.random.default_rng(6), [scene.mover, *scene.mover.parts]
    for body in scene.hyperboloids:
        ends = ends_of(body)
        for end in ends:
            known = ROUNDING * (max(map(abs, ends)) + abs(body.center[2]) + scene.mover.d)
            for spheroid in spheroids:
                level = end + _steps(spheroid.d, known, random)
                yield _beside(body, spheroid.b, spheroid.d, level, random)
    for first, second in permutations(scene.hyperboloids, 2):
        for end in ends_of(first):
            level = end + random.uniform(-1, 1, BOTH) * scene.mover.d
            yield _where_walls_cross(first, second, level, random)


def _steps(d: float, known: float, random: np.random.Generator) -> Floats:
    """From an end up or down: less than d, next to d, to 0, and to both within what is known, and far beyond."""
    size = random.choice([0.0, 0.5, 1.0, 1.0, 2.0], COUNT) * d
    change = random.choice([1e-3 * d, 0.4 * d], COUNT) * random.uniform(-1, 1, COUNT)
    next_to = random.choice([0.0, d], COUNT) + known * np.linspace(-1.5, 1.5, COUNT)
    return np.concatenate([random.choice([-1.0, 1.0], COUNT) * (size + change), next_to, -next_to])


def _beside(body: Hyperboloid, b: float, d: float, level: Floats, random: np.random.Generator) -> Floats:
    """Centres on the hyperboloid's axis, and inside, on and outside of its wall, up to beyond reach.

    Some reach the wall at their own height hardly, or at other heights only: contact ends a little beyond b, as the
    wall is steep.
    """
    count, up = len(level), level - body.center[2]
    wall = body.alpha * np.hypot(1, up / body.gamma)
    slope = (body.alpha / body.gamma) ** 2 * abs(up) / wall
    last = np.hypot(b, slope * d)
    off = random.uniform(-1.7, 1.7, count) * b
    hardly = random.choice([-1.0, 1.0], count) * (b + (last - b) * random.uniform(-0.5, 1.2, count))
    kind = random.integers(0, 5, count)
    off = np.select([kind == 0, kind == 1, kind == 2], [-wall, 0 * wall, hardly], off)
    rho, turn = abs(wall + off), random.uniform(0, 2 * np.pi, count)
    x, y = body.center[0] + rho * np.cos(turn), body.center[1] + rho * np.sin(turn)
    return np.stack([x, y, level, random.uniform(0, 360, count)])


def _where_walls_cross(first: Hyperboloid, second: Hyperboloid, level: Floats, random: np.random.Generator) -> Floats:
    """Centres on both walls, where the circles of both at these heights cross; none where they do not."""
    one, other = (body.alpha * np.hypot(1, (level - body.center[2]) / body.gamma) for body in (first, second))
    apart = np.subtract(second.center[:2], first.center[:2])
    length = float(np.hypot(*apart))
    along = (one**2 - other**2 + length**2) / (2 * length)
    crossing = along**2 < one**2
    along, level = along[crossing], level[crossing]
    across = np.sqrt(one[crossing] ** 2 - along**2) * random.choice([-1.0, 1.0], len(along))
    x = first.center[0] + (along * apart[0] - across * apart[1]) / length
    y = first.center[1] + (along * apart[1] + across * apart[0]) / length
    return np.stack([x, y, level, random.uniform(0, 360, len(level))])
