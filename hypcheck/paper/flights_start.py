"""Where flights start, and whether each of these places is one where the quadcopter may be."""

from __future__ import annotations

import numpy as np

from hypcheck.casebook.draw import Floats
from hypcheck.errors import InputError
from hypcheck.kernel.classify import classify
from hypcheck.pairs import Position
from hypcheck.paper.flights_craft import Craft
from hypcheck.scene.model import Start


def rims(craft: Craft, start: Start, z: Floats) -> Floats:
    """The radius of the disc that a flight starts in, at each height (n,)."""
    if start.margin is None:
        return np.full(z.shape, start.radius)
    alpha, gamma, _, _ = craft.sizes
    ratio = z / gamma
    return np.maximum(alpha * np.sqrt(1 + ratio * ratio) - start.margin, 0)


def require_valid_start(scene: str, craft: Craft, start: Start) -> None:
    """Raise InputError unless, wherever a flight starts and heads, the body is interior or all four rotors are."""
    _, _, b, d = craft.sizes
    _, _, small_b, small_d = craft.rotor
    if not _interior(craft, start, b, d, 0.0) and not _interior(craft, start, small_b, small_d, craft.arm):
        disc = f"radius = {start.radius!r}" if start.margin is None else f"margin = {start.margin!r}"
        raise InputError(
            f"the scene {scene!r}: [flight.start] {disc} has flights start where neither the body nor all four rotors "
            "are inside the tower; a smaller radius, or a larger margin, leaves them room"
        )


def _interior(craft: Craft, start: Start, b: float, d: float, beyond: float) -> bool:
    """Whether a spheroid is interior everywhere on the rims of the discs, and `beyond` them (≥ 0, outwards).

    With its centre at radius r and height z it is interior iff r + b √(1 − w²/d²) < R(z + w) for all |w| ≤ d; the
    wall's radius R is even and convex. Where r is the same at all heights, the height nearest the waist decides. Where
    r is R less something, R(z + w) − R(z) counts: over z, convexity makes it least at the top for w < 0, at the bottom
    for w > 0, so both ends decide. A margin greater than R leaves r the same, and at the ends only greater than that.
    """
    alpha, gamma, _, _ = craft.sizes
    low, high = start.z.low, start.z.high
    heights = np.array([low, high, min(max(low, 0.0), high)])
    rows = [(alpha, gamma, b, d, r, 0.0, z) for r, z in zip(rims(craft, start, heights) + beyond, heights, strict=True)]
    return bool((classify(rows) == Position.INTERIOR).all())
