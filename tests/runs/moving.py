"""Implementations of the question passage: right ones, and some with one fault each."""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import SWEEPS, invalid
from tests.support.inside import passage_of

hypcheck = {"name": "moving", "question": "passage", "tilt": True, "times": True, "refuses": True}


def exact(rows):
    """Right, by integers; a row that is none is refused."""
    bad = invalid(rows, SWEEPS)
    hits, times = np.full(len(rows), REFUSED, dtype=np.int8), np.full(len(rows), np.nan)
    found = [passage_of(tuple(row)) for row in rows[~bad].tolist()]
    hits[~bad], times[~bad] = [each.hit for each in found], [each.first_lower for each in found]
    return hits, times


def upright(rows):
    """The answer about the spheroid that stands upright in its place."""
    standing = rows.copy()
    standing[:, 10:] = 0.0, 0.0, 1.0
    hits, times = exact(standing)
    return np.where(invalid(rows, SWEEPS), REFUSED, hits).astype(np.int8), times


def clear_from_infinity(rows):
    """A way that begins or ends at infinity, or nowhere, is answered as clear, since no time compares."""
    hits, times = exact(rows)
    lost = ~np.isfinite(rows[:, 4:10]).all(axis=1)
    return np.where(lost, 0, hits).astype(np.int8), times
