"""One mover beside one hyperboloid, both in the scene's coordinates, without arrays: what a step of a walk costs."""

from __future__ import annotations

from math import inf, nextafter
from sys import float_info

from hypcheck.kernel.scalar import position
from hypcheck.kernel.world.offsets import exact_position

GREATEST = float_info.max
"""A difference of centres from here on has no float64 above it."""

Body = tuple[float, float, float, float, float, float, float]
"""α, γ, the centre x, y, z, and the lowest and highest modelled z, of a hyperboloid."""


def position_beside(body: Body, b: float, d: float, x: float, y: float, z: float) -> int:
    """The exact position of a spheroid at (x, y, z): as offsets.positions has it, of one pair."""
    alpha, gamma, there_x, there_y, there_z, _, _ = body
    across, along, up = x - there_x, y - there_y, z - there_z
    # TwoSum: what each difference has lost; 0 where it is exact.
    back_x, back_y, back_z = across + there_x, along + there_y, up + there_z
    if (
        (x - back_x) == (there_x - (back_x - across))
        and (y - back_y) == (there_y - (back_y - along))
        and (z - back_z) == (there_z - (back_z - up))
    ):
        return position(alpha, gamma, b, d, across, along, up)
    across, along, up = abs(across), abs(along), abs(up)
    if not (across < GREATEST and along < GREATEST and up < GREATEST):
        return exact_position([alpha, gamma, b, d], [x, y, z], [there_x, there_y, there_z])
    outermost = position(alpha, gamma, b, d, nextafter(across, inf), nextafter(along, inf), nextafter(up, 0.0))
    innermost = position(alpha, gamma, b, d, nextafter(across, 0.0), nextafter(along, 0.0), nextafter(up, inf))
    if outermost == innermost:
        return outermost
    return exact_position([alpha, gamma, b, d], [x, y, z], [there_x, there_y, there_z])
