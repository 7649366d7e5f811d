"""The paper's scenes: the forest of section 3.1, the cooling tower of sections 3.2 and 4, its rotors and flights."""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.rows import Floats, Rows
from hypcheck.vectors.draw import Draw, circle_at
from hypcheck.vectors.random_pairs import Sizes, beside, offsets, stack

TOWER = (2.0, 17.8)
BODY = (0.25, 0.15)
ROTOR = (0.1, 0.05)
ARM = 0.135
"""Distance of a rotor's centre from the body's, metres. The paper does not print it; this one fits its Table 5."""

FLIGHT_STEPS = 32


def _metres(draw: Draw, n: int, low: int, high: int) -> Floats:
    """Whole centimetres (limits in centimetres), as a person would write a size down."""
    return draw.integers(n, low, high) / 100.0


def _walker(draw: Draw, n: int) -> tuple[Floats, Floats]:
    """b and d of a person: 50 to 90 cm across, 1.4 to 2 m tall."""
    return _metres(draw, n, 25, 45), _metres(draw, n, 70, 100)


def _trunk(draw: Draw, b: Floats, d: Floats, alpha: Floats) -> Sizes:
    """A trunk of waist α that flares slowly enough for (γ/d)² ≥ α/b, with room for every rounding."""
    least = d * np.sqrt(np.maximum(alpha / b, 1.0))
    return Sizes(alpha, least * draw.between(len(b), 1.02, 4), b, d)


def forest_type_1(draw: Draw, n: int) -> Rows:
    """Trunks wider than the walker, who stands within 2 m of the trunk's waist."""
    b, d = _walker(draw, n)
    size = _trunk(draw, b, d, b * draw.between(n, 1, 6))
    return beside(draw, size, draw.between(n, 0, 2) / d, offsets(draw, n))


def forest_type_2(draw: Draw, n: int) -> Rows:
    """Trunks narrower than the walker; a third of the rows is high up, where even such a trunk is wide enough."""
    b, d = _walker(draw, n)
    size = _trunk(draw, b, d, b * draw.between(n, 0.2, 0.99))
    aloft = draw.places(n) % 3 == 0
    height = np.where(aloft, size.c / size.a * draw.between(n, 1, 2.5), draw.between(n, 0, 2) / d)
    return beside(draw, size, height, np.where(aloft, -1, 1) * np.abs(offsets(draw, n)))


def _in_tower(n: int, mover: tuple[float, float], x: Floats, y: Floats, z: Floats) -> Rows:
    alpha, gamma, b, d = (np.full(n, value) for value in TOWER + mover)
    return stack(Sizes(alpha, gamma, b, d), x, y, z)


def _box(draw: Draw, n: int) -> tuple[Floats, Floats, Floats]:
    return draw.between(n, -4, 4), draw.between(n, -4, 4), draw.between(n, -TOWER[1], TOWER[1])


def tower_body(draw: Draw, n: int) -> Rows:
    """The quadcopter's body, uniform in a box that holds the tower."""
    return _in_tower(n, BODY, *_box(draw, n))


def _radius(z: Floats) -> Floats:
    """The tower's radius at height z."""
    ratio = z / TOWER[1]
    return np.asarray(TOWER[0] * np.sqrt(1 + ratio * ratio))


def tower_rotors(draw: Draw, n: int) -> Rows:
    """The four rotors of a body, equation (15), in consecutive rows; half of the bodies are in contact or nearly so."""
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
    """Positions asked for along random flights of FLIGHT_STEPS moves (section 4), refused ones included.

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
