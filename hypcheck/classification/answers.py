"""Answers about many rows: the same as about each pair alone, without the proofs."""

from __future__ import annotations

import numpy as np

from hypcheck.classification.agreement import require_agreement
from hypcheck.pairs import REFUSED, Pair
from hypcheck.rows import Rows
from hypcheck.tables.chunk import Answers, Chunk
from hypcheck.truth import batch, exact, nearest


def answers(rows: Rows) -> Answers:
    """Position, tangency and clearance of every row (n, 7); float64 (n, 7) in, (n,) each out.

    Raises InputError about the first invalid row, DisagreementError where two oracles contradict each other.
    """
    measured = nearest.clearances(rows)
    # What the filter proves is never a tangency: λ proves a gap, and two points of the spheroid strictly on either side
    # of the hyperboloid prove that it passes through the spheroid's inside.
    positions = batch.filtered(rows)
    tangent = np.zeros(len(rows), dtype=np.bool_)
    for index in np.flatnonzero(positions == batch.UNDECIDED).tolist():
        decision = exact.decide(Pair.from_row(rows[index].tolist()).lengths)
        positions[index], tangent[index] = decision.position, decision.tangent
    doubtful = (measured.position != positions) | ((measured.clearance == 0) != tangent)
    for index in np.flatnonzero(doubtful).tolist():
        require_agreement(
            tuple(rows[index].tolist()),
            (int(positions[index]), bool(tangent[index])),
            (int(measured.position[index]), float(measured.clearance[index])),
        )
    return Answers(positions, tangent, measured.clearance)


def answers_of_chunk(chunk: Chunk) -> Answers:
    """The answers about a chunk of a table, 127 for its refused rows. Raises DisagreementError as answers."""
    if not chunk.refused.any():
        return answers(chunk.rows)
    asked = ~chunk.refused
    found = answers(chunk.rows[asked])
    count = len(chunk.rows)
    marked = Answers(np.full(count, REFUSED, dtype=np.int8), np.zeros(count, dtype=np.bool_), np.full(count, np.nan))
    marked.positions[asked], marked.tangent[asked] = found.positions, found.tangent
    marked.clearance[asked] = found.clearance
    return marked
