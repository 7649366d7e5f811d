"""Rows (n, 13), whose hyperboloids end: the position without ends, then what bounds tell about the ends, then the rest.

The kernel decides without ends. The spheroid reaches no farther up or down than its greater semi-axis: where it
therefore lies between the ends that position holds, and beyond an end it is exterior. What is left is decided in exact
integers by truth/ends.py, which is the only decision about ends that is known.
"""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.pair import REFUSED, TILTED_COLUMNS, Lengths, Position
from hypcheck.geometry.rows import Mask, Positions, Rows, invalid, parts_of
from hypcheck.kernel.choice import Question
from hypcheck.kernel.classify import kernel
from hypcheck.truth import ends


def answer_ended_rows(rows: Rows, question: Question, threads: int | None = None) -> tuple[Positions, int]:
    """Answers for C-contiguous rows (n, 13) as kernel().answer_rows has them: 127 for invalid rows, and how many."""
    refused = invalid(rows)
    positions, _ = kernel().answer_rows(np.ascontiguousarray(rows[:, : len(TILTED_COLUMNS)]), "position", threads)
    positions[refused] = REFUSED
    beyond, left = _by_reach(rows, positions)
    positions[beyond] = Position.EXTERIOR
    for index in np.flatnonzero(left & ~refused).tolist():
        lengths = Lengths.of(rows[index].tolist())
        positions[index] = ends.position(lengths, Position(int(positions[index])))
    if question != "position":
        asked = Position[question.upper()]
        positions = np.where(refused, REFUSED, positions == asked).astype(np.int8)
    return positions, int(refused.sum())


def _by_reach(rows: Rows, positions: Positions) -> tuple[Mask, Mask]:
    """Which valid rows lie surely beyond an end or outside a solid, and in which bounds do not tell.

    z ∓ r and its distance from an end are within 3u (|z| + r + |end|) of what they stand for.
    """
    lengths, _, heights = parts_of(rows)
    z, r, solid = lengths[:, 6:7], lengths[:, 2:4].max(axis=1, keepdims=True), heights[:, 2]
    ends_at = heights[:, :2]
    with np.errstate(over="ignore", invalid="ignore"):  # what is no number compares false
        depth = (z - ends_at) * (1, -1)
        reach = r + 4 * 2.0**-53 * (np.abs(z) + r + np.where(np.isinf(ends_at), 0, np.abs(ends_at)))
        between, beyond = (depth > reach).all(axis=1), (depth < -reach).any(axis=1)
    beyond |= (positions == Position.EXTERIOR) & (solid != 0)
    return np.asarray(beyond & (positions != REFUSED)), np.asarray(~(between | beyond))
