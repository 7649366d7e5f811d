"""How far from a hyperboloid's axis a mover can be in contact with it: beyond, it is exterior, and nothing is asked.

A spheroid at height z occupies heights z − d … z + d and reaches b from its centre. The surface is nowhere wider in
that range than ρ = α √(1 + ((|z| + d)/γ)²), so a centre farther than ρ + b from the axis touches nothing and is
outside. That is formed in floats with eight roundings at most, on positive terms: OUTWARD, far more than 8u, covers
them, and the rounding of a distance that is compared with it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hypcheck.scene.model import Scene, Span

OUTWARD = 1 + 2.0**-40

Floats = NDArray[np.float64]


def reaches(scene: Scene) -> Floats:
    """The reach of each hyperboloid over the heights that the scene allows, (m,); inf where they have no end."""
    height, mover = scene.region.z, scene.mover
    found = np.empty(len(scene.hyperboloids))
    for index, body in enumerate(scene.hyperboloids):
        most = min(_most(height, body.center[2]), _most(body.height, 0.0))
        with np.errstate(over="ignore"):
            share = np.float64(most + mover.d) / body.gamma
            found[index] = (body.alpha * np.sqrt(1 + share * share) + mover.b) * OUTWARD
    return found


def _most(span: Span | None, origin: float) -> float:
    """The greatest distance of a height in the span from the origin; inf where there is no span."""
    return np.inf if span is None else max(abs(span.low - origin), abs(span.high - origin)) * OUTWARD
