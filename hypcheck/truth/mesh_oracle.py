"""The mesh oracle: FCL with one-sided meshes of the surface (docs/mesh-oracle.md).

It answers clear, contact or undecided, and is never wrong: bounds found without FCL decide the pair, and FCL, given the
mesh that shows the decision, must agree. The only question to FCL (python-fcl) is the distance of C from a mesh. FCL
knows no sides; the side is the exact sign of the hyperboloid's equation at C.

The bounds for an upright spheroid are proved (mesh_meridian.py). The bounds for other pairs (mesh_wall.py) are proved
if the math library's functions are right within 4 units in the last place.
"""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.geometry.pair import Pair, Position
from hypcheck.truth import mesh_meridian, mesh_wall
from hypcheck.truth.mesh import Measure, MeshOutcome, distance_to_mesh, require_fcl


@dataclass(frozen=True, slots=True)
class MeshVerdict:
    """The answer of the meshes about one pair.

    `position` is None if undecided, and then `reason` is a sentence with the reason. `lower` and `upper` are bounds of
    the distance from the spheroid's centre to the surface, in spheroid radii (clearance + 1). They are proved for an
    upright spheroid and a hyperboloid without ends, else 0 and inf; for a clear pair they are seldom tight, and beyond
    5/4 radii they are 5/4 and inf. `levels` counts the rounds of cutting, `triangles` the triangles given to FCL; both
    are 0 if nothing is near.
    """

    outcome: MeshOutcome
    position: Position | None
    levels: int
    triangles: int
    lower: float
    upper: float
    reason: str | None = None


def verdict(pair: Pair, measure: Measure = distance_to_mesh) -> MeshVerdict:
    """The position of any valid pair, if `measure`, the distance to the mesh, confirms it; else undecided.

    Raises UnavailableError if FCL cannot be imported.
    """
    require_fcl()
    search = (mesh_meridian if pair.is_upright and not pair.has_ends else mesh_wall).refine(pair)
    outcome, reason = search.outcome, search.reason
    for mesh in search.meshes:
        distance = measure(*mesh)
        clear = search.outcome is MeshOutcome.CLEAR
        if not (distance > 1 + search.slack if clear else distance <= 1 - search.slack):
            reason = f"FCL's distance {distance!r} to the mesh does not bear out {search.outcome.value}"
            outcome = MeshOutcome.UNDECIDED
    position = None
    if outcome is not MeshOutcome.UNDECIDED:
        position = Position.CONTACT if outcome is MeshOutcome.CONTACT else _side(pair, search.side)
    count = sum(len(triangles) for _, triangles in search.meshes)
    return MeshVerdict(outcome, position, search.levels, count, search.lower, search.upper, reason or None)


def _side(pair: Pair, sign: int) -> Position:
    """The side of a spheroid that touches nothing: its centre's side, given the sign of the equation at the centre."""
    return Position.INTERIOR if sign <= 0 and pair.z_min <= pair.z <= pair.z_max else Position.EXTERIOR
