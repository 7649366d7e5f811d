"""The programs of the first stage for one orientation: half spaces that prove a position of a leaning spheroid.

In the basis in which both matrices are diagonal, with P1, P2 and Q the squares of the centre's components,

    exterior positions are the union over λ in (0, B) of   P1 + β P2 > κ + ν Q,
        β = (A1+λ)/(A2+λ),   κ = (A1+λ)(1 + 1/λ),   ν = (A1+λ)/(B−λ);

for interior ones the sign of the comparison is turned, and λ = −μ with μ in (0, min(A1, A2)). So those that are not
exterior form a convex set, as do those that are not interior. A plane under corners that are not exterior is a proof,
as a chord is for upright spheroids (lines.py): the part of 0 ≤ Q ≤ Q_most with P1 + a P2 ≤ K + M Q is the hull of its
corners on the two P axes and of what lies below them in P1 and P2, or above them in Q; likewise the other side.

The components are computed with an error. With |C| ≤ max(b, d) √N, N = P1 + P2 + Q, the rounded component is within
η √N of the exact one, η = max(b, d) Σ (4u |r| + e) over the row r of the basis, known within e; so each square is
within ζ N, ζ = 2η + η² + 2u, and a test with a, K, M decides what the plane with

    1 ± z, a ± z, K, M ∓ z,        z ≥ (1 + a + M) ζ,

says of the exact squares. core/parts/tilted_scene.h chooses a, K, M so that this is a plane that was proved. u = 2⁻⁵²
covers every rounding mode. The comparison's own roundings, 2 on the left and 2 on the right of positive terms, are in
lines.MARGIN, and so is underflow, where K ≥ LEAST_CONSTANT and a, M ≤ GREATEST_SLOPE. |C|² summed over a block is below
CAP = 2⁴⁰⁰; with sizes in 2^±100 no product overflows then, and NaN is not below it.
"""

from __future__ import annotations

from hypcheck.derivation.program import program_of
from hypcheck.kernel.programs.lines import SIDES, U

BASIS = ("r1_x", "r1_y", "r2_x", "r2_y", "r2_z", "r3_x", "r3_y", "r3_z")
PLACES = (0, 1, 2)
"""Plane 0 of a side serves all heights, or planes 1 and 2 serve the lower and the upper ones."""

PLANE_CONSTANTS = tuple(f"{part}_{side}_{place}" for side in SIDES for place in PLACES for part in "aKM")

CONSTANTS = {
    "unit": U,
    "more_than": 1 + 2.0**-40,
    "lost": 2.0**-1000,
    "least_ratio": 2.0**-20,
    "greatest_ratio": 2.0**20,
    "greatest_zeta": 2.0**-10,
}

_COMPONENTS = """
    xx = x * x
    yy = y * y
    zz = z * z
    radius = xx + yy
    distance = radius + zz
    x1 = r1_x * x
    y1 = r1_y * y
    c1 = x1 + y1
    x2 = r2_x * x
    y2 = r2_y * y
    xy2 = x2 + y2
    z2 = r2_z * z
    c2 = xy2 + z2
    x3 = r3_x * x
    y3 = r3_y * y
    xy3 = x3 + y3
    z3 = r3_z * z
    c3 = xy3 + z3
    P1 = c1 * c1
    P2 = c2 * c2
    Q = c3 * c3
    in_reach = Q <= reach
"""

_ANSWERS = """
    contact_in_reach = is_under and is_above
    contact = contact_in_reach and in_reach
    clear = exterior or interior
    decided = clear or contact
"""

_NAMES = {"beyond": "exterior", "within": "interior", "under": "is_under", "above": "is_above"}
_JOINED = {"beyond": "or", "within": "or", "under": "and", "above": "and"}


def _plane(side: str, place: int, name: str) -> str:
    return f"""
    part_{side}_{place} = a_{side}_{place} * P2
    place_{side}_{place} = P1 + part_{side}_{place}
    rise_{side}_{place} = M_{side}_{place} * Q
    line_{side}_{place} = K_{side}_{place} + rise_{side}_{place}
    {name} = place_{side}_{place} {SIDES[side]} line_{side}_{place}
"""


_INPUTS = ("x", "y", "z", "reach", *BASIS, *PLANE_CONSTANTS)

ONE_PLANE = program_of("one-plane", _INPUTS, _COMPONENTS, *(_plane(side, 0, _NAMES[side]) for side in SIDES), _ANSWERS)
"""From x, y, z and the scene's constants to `exterior`, `interior` and `decided`, where `distance` < CAP."""

TWO_PLANES = program_of(
    "two-planes",
    _INPUTS,
    _COMPONENTS,
    *(_plane(side, place, f"{_NAMES[side]}_{place}") for side in SIDES for place in (1, 2)),
    *(f"{_NAMES[side]} = {_NAMES[side]}_1 {_JOINED[side]} {_NAMES[side]}_2" for side in SIDES),
    _ANSWERS,
)
"""The same with two planes a side: more work a row, and fewer rows left."""
