"""Kinds: the names of all relations between the two surfaces, one for each row of the table of root patterns.

Only data, shared by the oracles that give more than a position. The table (docs/mathematics.md, "Root patterns and
relative position") is after [10], re-derived; its text was not consulted. A = (α/b)², B = (γ/d)², a = √A, c = √B, r and
z are the distances of the centre from the axis and from the plane of the waist after Theorem 1 of the paper (where the
spheroid is the unit ball), and the roots are those of g, equation (12).

Two words of geometry: the hyperboloid's *throat* is its narrowest circle, of radius a, which the ball can be too wide
to pass (a < 1); its *groove* is the hollow around that circle seen from outside, of radius of curvature c²/a, which the
ball can be too round to fit (c² < a).
"""

from __future__ import annotations

from enum import Enum, unique

from hypcheck.geometry.pair import Position


@unique
class Kind(Enum):
    """The relation of the two surfaces. The value is the name that files and reports use; it never changes.

    `position`: the position of pairs of this kind. `limit_of`: for a tangency, the clear position to which an
    arbitrarily small change of the sizes leads. `contact_set`: the common points of the surfaces. `occurs`: for which
    hyperboloids; "always" means for every a and c. `roots`: the pattern of roots of g for this kind; roots that are not
    named lie at B or above. `description`: one plain sentence.
    """

    position: Position
    limit_of: Position | None
    contact_set: str
    occurs: str
    roots: str
    description: str

    def __new__(
        cls,
        name: str,
        position: Position,
        limit_of: Position | None,
        contact_set: str,
        occurs: str,
        roots: str,
        description: str,
    ) -> Kind:
        """Return a member with the columns of the table as attributes; its value is only the name."""
        member = object.__new__(cls)
        member._value_ = name
        member.position, member.limit_of, member.contact_set = position, limit_of, contact_set
        member.occurs, member.roots, member.description = occurs, roots, description
        return member

    @property
    def tangent(self) -> bool:
        """Whether the surfaces touch without crossing: the clearance is exactly 0."""
        return self.limit_of is not None

    INTERIOR = (
        "interior",
        Position.INTERIOR,
        None,
        "nothing",
        "always",
        "two distinct in (−A, 0), or −A and one in (−A, 0) when r = 0",
        "The spheroid lies inside the hyperboloid and does not touch it.",
    )
    INTERIOR_TANGENT_POINT = (
        "interior-tangent-point",
        Position.CONTACT,
        Position.INTERIOR,
        "1 point",
        "always",
        "double in (−A, 0)",
        "The spheroid touches the hyperboloid from inside at one point.",
    )
    INTERIOR_TANGENT_CIRCLE = (
        "interior-tangent-circle",
        Position.CONTACT,
        Position.INTERIOR,
        "1 circle",
        "a ≤ 1",
        "double at −A (only when r = 0)",
        "The spheroid, centred on the axis, lies in the throat like a ball in a funnel and touches along a circle.",
    )
    CROSSING_THROAT_TWO_CURVES = (
        "crossing-throat-two-curves",
        Position.CONTACT,
        None,
        "2 curves",
        "a < 1",
        "two distinct below −A, or −A and one below when r = 0",
        "The spheroid is too wide for the throat and cuts it in two curves round the axis (circles if r = 0).",
    )
    CROSSING_THROAT_NODE = (
        "crossing-throat-node",
        Position.CONTACT,
        None,
        "1 curve with a node",
        "a < 1",
        "double below −A",
        "The two curves round the throat have come together in a point where the curve crosses itself.",
    )
    CROSSING_ONE_CURVE = (
        "crossing-one-curve",
        Position.CONTACT,
        None,
        "1 curve",
        "always",
        "a complex pair",
        "The surfaces cross in one closed curve.",
    )
    EXTERIOR = (
        "exterior",
        Position.EXTERIOR,
        None,
        "nothing",
        "always",
        "two distinct in (0, B), or one in (0, B), one at B and one above B when z = 0",
        "The spheroid lies outside the hyperboloid and does not touch it.",
    )
    EXTERIOR_RING = (
        "exterior-ring",
        Position.EXTERIOR,
        None,
        "nothing",
        "c² > a",
        "simple in (0, B), double at B (only when z = 0)",
        "The spheroid lies outside and does not touch, though the discriminant is 0 as at a tangency.",
    )
    EXTERIOR_TANGENT_POINT = (
        "exterior-tangent-point",
        Position.CONTACT,
        Position.EXTERIOR,
        "1 point",
        "always",
        "double in (0, B)",
        "The spheroid touches the hyperboloid from outside at one point.",
    )
    EXTERIOR_TANGENT_TWO_POINTS = (
        "exterior-tangent-two-points",
        Position.CONTACT,
        Position.EXTERIOR,
        "2 points",
        "c² < a",
        "double at B, simple above B (only when z = 0)",
        "The spheroid, in the plane of the waist, rests on both flanks of the groove, touching each at one point.",
    )
    EXTERIOR_TANGENT_OSCULATING = (
        "exterior-tangent-osculating",
        Position.CONTACT,
        Position.EXTERIOR,
        "1 point",
        "c² = a",
        "triple at B (only when z = 0)",
        "The spheroid touches the bottom of the groove at one point and has the groove's own curvature there.",
    )
    CROSSING_GROOVE_TWO_CURVES = (
        "crossing-groove-two-curves",
        Position.CONTACT,
        None,
        "2 curves",
        "c² < a",
        "three distinct above B, or B and two above when z = 0",
        "The spheroid is too round for the groove and cuts it in two curves, neither of them round the axis.",
    )
    CROSSING_GROOVE_ISOLATED_POINT = (
        "crossing-groove-isolated-point",
        Position.CONTACT,
        None,
        "1 curve and 1 isolated point",
        "c² < a",
        "double above B, simple above that",
        "The spheroid cuts the groove in a curve and touches the flank away from its centre at one more point.",
    )
    CROSSING_GROOVE_NODE = (
        "crossing-groove-node",
        Position.CONTACT,
        None,
        "1 curve with a node",
        "c² < a",
        "double above B, simple at B or between B and that",
        "The two curves in the groove have come together in a point where the curve crosses itself.",
    )
    CROSSING_GROOVE_CUSP = (
        "crossing-groove-cusp",
        Position.CONTACT,
        None,
        "1 curve with a cusp",
        "c² < a",
        "triple above B",
        "The surfaces cross in one curve that has a cusp: the border between a node and an isolated point.",
    )
