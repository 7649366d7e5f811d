"""The exact decision where the hyperboloid ends: a wall between two heights, open or with flat ends, in integers.

In the hyperboloid's frame W = {h = 0, z_min ≤ z ≤ z_max} is the wall, K = {h ≤ 0, z_min ≤ z ≤ z_max} the body, E the
closed solid spheroid.

- Open: contact if and only if E meets W; else interior if the centre lies in K, exterior if not.
- Solid: contact if and only if E meets W or one of the two discs in which K ends; else E lies in K or is disjoint from
  it, and the centre says which.

E meets W only where it meets the whole hyperboloid. So the position without ends comes first, and sections.py is
asked about the wall only where that is contact and E reaches beyond an end.
"""

from __future__ import annotations

from hypcheck.geometry.pair import Lengths, Position
from hypcheck.truth.pencil import side_of_center
from hypcheck.truth.sections import Sections


def position(lengths: Lengths, whole: Position) -> Position:
    """The exact position; `whole` is that without ends."""
    return Position.CONTACT if _meet(lengths, whole) else _side(lengths)


def limit_of(lengths: Lengths, whole: Position, whole_limit: Position | None) -> Position | None:
    """The clear position that a smaller spheroid would have where a contact is no more than a touch, else None.

    `whole_limit` is the same without ends, where the position is `whole`.
    """
    sections = Sections.of(lengths)
    if whole is Position.CONTACT and _between(sections, lengths):
        return whole_limit
    if lengths.solid and any(sections.disc_crosses(end) for end, _ in _ends(lengths)):
        return None
    if whole is Position.CONTACT:
        lowest, highest = sections.reach_in_heights
        low = lowest if lengths.low is None else lengths.low
        high = highest if lengths.high is None else lengths.high
        if sections.wall_crosses(low, high):
            return None
    return _side(lengths)


def _meet(lengths: Lengths, whole: Position) -> bool:
    """Whether E meets W or, if the body is solid, one of the discs."""
    if whole is Position.EXTERIOR or (whole is Position.INTERIOR and not lengths.solid):
        return False
    sections = Sections.of(lengths)
    if whole is Position.CONTACT:
        if _between(sections, lengths):
            return True
        if not _beyond(sections, lengths) and not sections.wall_misses(lengths.low, lengths.high):
            return True
    return lengths.solid and not all(sections.disc_misses(end) for end, _ in _ends(lengths))


def _ends(lengths: Lengths) -> list[tuple[int, int]]:
    """The finite ends, each with the direction from the body out through it."""
    return [(end, outward) for end, outward in ((lengths.low, -1), (lengths.high, 1)) if end is not None]


def _between(sections: Sections, lengths: Lengths) -> bool:
    """Whether all of E lies between the ends."""
    return all(
        sections.sign(sections.above, end) * outward > 0 and sections.sign(sections.inside, end) <= 0
        for end, outward in _ends(lengths)
    )


def _beyond(sections: Sections, lengths: Lengths) -> bool:
    """Whether all of E lies below or above both ends."""
    return any(
        sections.sign(sections.above, end) * outward < 0 and sections.sign(sections.inside, end) < 0
        for end, outward in _ends(lengths)
    )


def _side(lengths: Lengths) -> Position:
    """Interior if the centre lies in the body, else exterior."""
    sections = Sections.of(lengths)
    inside = side_of_center(lengths) <= 0 and all(
        sections.sign(sections.above, end) * outward >= 0 for end, outward in _ends(lengths)
    )
    return Position.INTERIOR if inside else Position.EXTERIOR
