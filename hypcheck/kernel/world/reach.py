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
    bodies, mover = scene.hyperboloids, scene.mover
    alpha, gamma = (np.array([getattr(body, name) for body in bodies]) for name in ("alpha", "gamma"))
    level = np.array([body.center[2] for body in bodies], np.float64)
    most = _most(scene.region.z, level)
    own = np.array(
        [np.inf if body.height is None else max(map(abs, (body.height.low, body.height.high))) for body in bodies]
    )
    with np.errstate(over="ignore"):
        share = (np.minimum(most, own * OUTWARD) + mover.d) / gamma
        return np.asarray((alpha * np.sqrt(1 + share * share) + mover.b) * OUTWARD)


def _most(span: Span | None, level: Floats) -> Floats:
    """The greatest distances of a height in the span from these levels; inf where there is no span."""
    if span is None:
        return np.full(len(level), np.inf)
    return np.asarray(np.maximum(np.abs(span.low - level), np.abs(span.high - level)) * OUTWARD)
