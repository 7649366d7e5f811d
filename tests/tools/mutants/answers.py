"""Answers that hardly look at the row, or say something other than what was found."""

from __future__ import annotations

from zlib import crc32

import numpy as np

from tests.tools.mutants.exactly import lengths, position, terms
from tests.tools.mutants.expectation import wrong


@wrong()
def exterior_always(rows):
    """+1, whatever is asked."""
    return np.ones(len(rows), dtype=np.int8)


@wrong()
def contact_always(rows):
    """0, whatever is asked."""
    return np.zeros(len(rows), dtype=np.int8)


@wrong()
def interior_always(rows):
    """−1, whatever is asked."""
    return np.full(len(rows), -1, dtype=np.int8)


@wrong()
def cannot_say_always(rows):
    """2, whatever is asked."""
    return np.full(len(rows), 2, dtype=np.int8)


@wrong()
def cannot_say_when_it_is_hard(rows):
    """2 where the spheroid touches: never wrong, and no use."""
    answers = position(rows)
    return np.where(answers == 0, 2, answers).astype(np.int8)


@wrong()
def sides_swapped(rows):
    """Exterior is called interior and interior exterior."""
    return -position(rows)


@wrong()
def never_exterior(rows):
    """Exterior is called contact."""
    return np.minimum(position(rows), 0)


@wrong()
def never_interior(rows):
    """Interior is called contact."""
    return np.maximum(position(rows), 0)


@wrong()
def contact_is_interior(rows):
    """Contact is called interior: only exterior positions are right."""
    return np.where(position(rows) == 1, 1, -1).astype(np.int8)


@wrong()
def contact_is_exterior(rows):
    """Contact is called exterior."""
    return np.where(position(rows) == -1, -1, 1).astype(np.int8)


@wrong()
def side_of_x(rows):
    """The sign of x is answered: the formula is still missing."""
    return np.sign(rows[:, 4]).astype(np.int8)


@wrong(claim=("--question", "exterior"))
def position_for_exterior(rows):
    """Claims to answer whether it is exterior, 1 or 0, and answers +1, 0 or −1."""
    return position(rows)


@wrong(claim=("--question", "interior"))
def exterior_for_interior(rows):
    """Claims to answer whether it is interior, and answers whether it is exterior."""
    return position(rows) == 1


@wrong(claim=("--question", "contact"))
def clear_for_contact(rows):
    """Claims to answer whether there is contact, and answers whether it is clear."""
    return position(rows) != 0


@wrong(claim=("--question", "interior"))
def not_exterior_for_interior(rows):
    """Claims to answer whether it is interior, and answers whether it is not exterior."""
    return position(rows) != 1


@wrong(claim=("--question", "contact"))
def overlap_of_the_boxes(rows):
    """Claims to answer whether there is contact, and answers whether the centre is within b of the waist."""
    t = terms(lengths(rows))
    return np.asarray(t.P < t.A + t.U, dtype=bool)


@wrong()
def by_lot(rows):
    """One of the three answers, chosen by a checksum of the row."""
    return np.array([crc32(bytes(row)) % 3 - 1 for row in rows], dtype=np.int8)
