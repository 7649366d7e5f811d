"""Answers learnt by heart, kept too long, or wrong for a few rows that nothing distinguishes."""

from __future__ import annotations

from functools import cache
from zlib import crc32

import numpy as np

import hypcheck
from hypcheck.runs.cases import first_unfrozen
from hypcheck.runs.plan import ConformancePlan
from hypcheck.vectors import frozen
from hypcheck.vectors.families import FAMILIES
from tests.tools.mutants.exactly import position, signs
from tests.tools.mutants.expectation import wrong

DEFAULTS = ConformancePlan(("any",))


@cache
def _frozen():
    """The answers to the frozen vectors, by the bytes of the row."""
    known = {}
    for name in frozen.NAMES:
        file = frozen.load(name)
        known.update(zip(map(bytes, file.rows), file.positions.tolist(), strict=True))
    return known


@cache
def _with_default_seed():
    """The answers to the frozen vectors and to the rows that the default options generate."""
    known = dict(_frozen())
    for family in FAMILIES.values():
        count = first_unfrozen(family, DEFAULTS.seed) + DEFAULTS.count * family.times
        rows = family.rows(DEFAULTS.seed, count)
        known.update(zip(map(bytes, rows), hypcheck.classify(rows).tolist(), strict=True))
    return known


_remembered: dict[tuple[str, ...], int] = {}


def _but_for_one_in(many, rows):
    """Right answers, but for one row in so many."""
    answers = position(rows)
    hit = np.array([crc32(bytes(row)) % many == 0 for row in rows], dtype=bool)
    return np.where(hit, np.where(answers == 0, 1, 0), answers).astype(np.int8)


def _recalled(rows, known):
    return np.array([known.get(bytes(row), 0) for row in rows], dtype=np.int8)


@wrong()
def frozen_vectors(rows):
    """The frozen vectors are looked up, everything else is contact."""
    return _recalled(rows, _frozen())


@wrong()
def default_seed(rows):
    """The frozen vectors and the default seed's rows are looked up; the rest, as of the search, is contact."""
    return _recalled(rows, _with_default_seed())


@wrong()
def nearest_in_a_table(rows):
    """The position is read from a table over r and z of the surface's own scale, 64 cells to α and to γ."""
    alpha, gamma, b, _, x, y, z = rows.T
    r, height = np.round(64 * np.hypot(x, y) / alpha) / 64, np.round(64 * np.abs(z) / gamma) / 64
    wall = np.sqrt(1 + height * height)
    slope = np.sqrt(1 + (alpha * height / gamma / wall) ** 2)
    return signs((r - wall) * alpha > b * slope, (wall - r) * alpha > b * slope)


@wrong()
def remembered_to_six_digits(rows):
    """Answers are kept, and looked up by the row to six significant digits."""
    answers = position(rows)
    keys = [tuple(f"{value:.6g}" for value in row) for row in rows.tolist()]
    return np.array([_remembered.setdefault(*each) for each in zip(keys, answers, strict=True)], dtype=np.int8)


@wrong()
def one_row_in_a_thousand(rows):
    """One row in a thousand, by a checksum of the row and always the same, gets another answer."""
    return _but_for_one_in(1000, rows)


@wrong(asked=("--count", "4000"), luck=True)
def one_row_in_ten_thousand(rows):
    """One row in ten thousand, by a checksum of the row, gets another answer; the default count has about two."""
    return _but_for_one_in(10_000, rows)
