"""Rows (n, 13), whose hyperboloids end: what the kernel's bounds tell, and the rest in exact integers.

The rest is decided by truth/ends.py, the only exact decision about ends that there is.
"""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.pair import REFUSED, Lengths, Position
from hypcheck.geometry.rows import CANNOT_SAY, Positions, Rows
from hypcheck.kernel.choice import Question
from hypcheck.kernel.classify import kernel
from hypcheck.truth import exact


def answer_ended_rows(rows: Rows, question: Question, threads: int | None = None) -> tuple[Positions, int]:
    """Answers for C-contiguous rows (n, 13) as kernel().answer_rows has them: 127 for invalid rows, and how many."""
    positions = kernel().answer_ended(rows, threads)
    for index in np.flatnonzero(positions == CANNOT_SAY).tolist():
        positions[index] = exact.position(Lengths.of(rows[index].tolist()))
    refused = positions == REFUSED
    if question != "position":
        positions = np.where(refused, REFUSED, positions == Position[question.upper()]).astype(np.int8)
    return positions, int(refused.sum())
