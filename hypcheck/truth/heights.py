"""The oracle of heights: whether some horizontal plane cuts both surfaces where they meet (sections.py).

Nothing is shared with the other oracles where the hyperboloid has no ends: there is no pencil S + λH here, and no
distance. Where it ends, the exact decision asks sections.py too, after the pencil.
"""

from __future__ import annotations

from hypcheck.geometry.pair import Pair, Position
from hypcheck.truth.sections import Sections


def position(pair: Pair) -> Position:
    """The exact position of a pair."""
    lengths = pair.lengths
    sections, ends = Sections.of(lengths), [end for end in (lengths.low, lengths.high) if end is not None]
    if not sections.wall_misses(lengths.low, lengths.high):
        return Position.CONTACT
    if lengths.solid and not all(sections.disc_misses(end) for end in ends):
        return Position.CONTACT
    R, p, s = lengths.x**2 + lengths.y**2, lengths.alpha**2, lengths.gamma**2
    outside = R * s > p * (s + lengths.z**2)
    between = (lengths.low is None or lengths.low <= lengths.z) and (lengths.high is None or lengths.z <= lengths.high)
    return Position.INTERIOR if between and not outside else Position.EXTERIOR
