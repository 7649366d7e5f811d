"""The mesh oracle: FCL asked about one-sided meshes of the surface, fine enough by proof (docs/mesh-oracle.md).

It says clear, contact or undecided, and never a wrong word: bounds proved without FCL settle the pair, and FCL, asked
about the very mesh that shows it, must say the same. FCL knows no sides; the side is the exact sign of F(C).
"""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.pairs import Pair, Position
from hypcheck.truth.mesh_fcl import availability, distance_to_mesh, require_fcl, ribbon
from hypcheck.truth.mesh_refine import RESOLUTION, Outcome, Refinement, refine
from hypcheck.truth.mesh_window import meridian_of

__all__ = ["MeshVerdict", "availability", "verdict"]


@dataclass(frozen=True, slots=True)
class MeshVerdict:
    """What the meshes say of one pair.

    `position` is None where undecided, and then `reason` is the sentence why. `lower` and `upper` are proved bounds
    on the distance from the spheroid's centre to the surface, in spheroid radii (clearance + 1); a clear pair's are
    seldom tight, and beyond 5/4 radii they are 5/4 and inf. `levels` counts the rounds of cutting, the
    uncut window being the first, `triangles` what FCL was asked about; both are 0 where the window is empty.
    """

    outcome: Outcome
    position: Position | None
    levels: int
    triangles: int
    lower: float
    upper: float
    reason: str | None = None


def verdict(pair: Pair) -> MeshVerdict:
    """The position of any valid pair, or undecided. Raises UnavailableError where FCL cannot be imported."""
    require_fcl()
    meridian = meridian_of(pair)
    refinement = refine(meridian)
    if refinement.outcome is Outcome.UNDECIDED:
        return _undecided(refinement, 0, _why_open(refinement))
    vertices, triangles = ribbon(refinement.facets)
    distance = distance_to_mesh(vertices, triangles)
    if not (distance > 1.0 if refinement.outcome is Outcome.CLEAR else distance <= 1.0):
        reason = f"FCL's distance {distance!r} to the mesh does not bear out the proved {refinement.outcome.value}"
        return _undecided(refinement, len(triangles), reason)
    return MeshVerdict(
        outcome=refinement.outcome,
        position=Position.CONTACT if refinement.outcome is Outcome.CONTACT else Position(meridian.side),
        levels=refinement.levels,
        triangles=len(triangles),
        lower=refinement.lower,
        upper=refinement.upper,
    )


def _undecided(refinement: Refinement, triangles: int, reason: str) -> MeshVerdict:
    return MeshVerdict(
        Outcome.UNDECIDED, None, refinement.levels, triangles, refinement.lower, refinement.upper, reason
    )


def _why_open(refinement: Refinement) -> str:
    if refinement.upper - refinement.lower <= RESOLUTION:
        return f"the distance is within {RESOLUTION:.1e} radii of 1: a tangency, or as near as float64 meshes tell"
    return f"too many cells stay open at level {refinement.levels}: the surfaces run close along an arc"
