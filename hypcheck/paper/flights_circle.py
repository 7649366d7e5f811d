"""Points of the unit circle by + − × ÷ √ alone, so that a flight is the same to the byte on every machine.

The polynomials are those of fdlibm's __kernel_sin and __kernel_cos (Sun Microsystems, 1993), good to less than an ulp
for angles up to π/4.
"""

from __future__ import annotations

import math

import numpy as np

from hypcheck.casebook.draw import Floats

EIGHTH = math.pi / 4

_SINE = (
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
)
_COSINE = (
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
)

Direction = tuple[Floats, Floats]
"""Cosine and sine."""


def small_angle(angle: Floats) -> Direction:
    """(cosine, sine) of angles up to π/4 in size, in radians."""
    square = angle * angle
    return 1 - 0.5 * square + square * square * _polynomial(_COSINE, square), (
        angle + angle * square * _polynomial(_SINE, square)
    )


def any_angle(degrees: Floats) -> Direction:
    """(cosine, sine) of angles in degrees; exact for multiples of 90."""
    quarters = np.rint(degrees / 90)
    cosine, sine = small_angle((degrees - 90 * quarters) * (EIGHTH / 45))
    return quarter_turns(cosine, sine, quarters.astype(np.int64))


def quarter_turns(cosine: Floats, sine: Floats, quarters: np.typing.NDArray[np.int64]) -> Direction:
    """The direction turned by so many quarters, counterclockwise."""
    odd = quarters % 2 == 1
    cosine, sine = np.where(odd, -sine, cosine), np.where(odd, cosine, sine)
    back = quarters // 2 % 2 == 1
    return np.where(back, -cosine, cosine), np.where(back, -sine, sine)


def turned(direction: Direction, by: Direction) -> Direction:
    """A direction turned by another, of length 1 again."""
    (cosine, sine), (other_cosine, other_sine) = direction, by
    ahead, aside = cosine * other_cosine - sine * other_sine, sine * other_cosine + cosine * other_sine
    length = np.sqrt(ahead * ahead + aside * aside)
    return ahead / length, aside / length


def _polynomial(coefficients: tuple[float, ...], at: Floats) -> Floats:
    result = np.full_like(at, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        result = result * at + coefficient
    return result
