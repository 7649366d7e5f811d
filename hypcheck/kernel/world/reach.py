"""How far from a hyperboloid's axis a mover can be in contact with it: beyond, it is exterior, and nothing is asked.

A spheroid at height z occupies heights z − d … z + d and reaches b from its centre. The surface is nowhere wider in
that range than ρ = α √(1 + ((|z| + d)/γ)²), so a centre farther than ρ + b from the axis touches nothing and is
outside. That is formed in floats with eight roundings at most, on positive terms: OUTWARD, far more than 8u, covers
them, and the rounding of a distance that is compared with it; LEAST covers what underflows.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel.world.bodies import Bodies
from hypcheck.scene.model import Mover, Span

OUTWARD = 1 + 2.0**-40
LEAST = 2.0**-1000

Floats = NDArray[np.float64]


def reaches(bodies: Bodies, mover: Mover, height: Span | None) -> Floats:
    """The reach of each hyperboloid for centres in this span of the scene's z, (m,); inf where they have no end."""
    level = bodies.origins[:, 2]
    with np.errstate(all="ignore"):
        most = np.full(len(level), np.inf)
        if height is not None:
            most = np.maximum(np.abs(height.low - level), np.abs(height.high - level)) * OUTWARD
        share = (np.minimum(most, bodies.tall * OUTWARD) + mover.d) / bodies.shapes[:, 1]
        return np.asarray((bodies.shapes[:, 0] * np.sqrt(1 + share * share) + mover.b) * OUTWARD + LEAST)


def in_reach(bodies: Bodies, mover: Mover, centre: tuple[float, float, float]) -> NDArray[np.int64]:
    """The hyperboloids that a mover at this very place can touch."""
    x, y, z = centre
    far = reaches(bodies, mover, Span(z, z))
    with np.errstate(all="ignore"):
        distance = np.hypot(x - bodies.origins[:, 0], y - bodies.origins[:, 1])
    return np.flatnonzero(~(distance > far))
