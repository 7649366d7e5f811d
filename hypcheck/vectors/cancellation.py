"""The rows on which rounding errors are worst for a formula that is right in exact arithmetic, found by search.

Each search starts in one family, the stratum, at the rows that the formula gets most wrong, and changes their lengths
at random: by factors near 1, by ulps, by powers of two, to fewer bits. Changed rows with a larger backward error are
kept. A row must meet three conditions: an implementation without a declared domain is judged on it, the formula is
right on it in rationals, and no intermediate overflows or underflows. So cancellation is the only cause of the errors
that the search finds.

The search is the same to the byte on every machine, like the families: integers, ldexp, + − × ÷ √, exact decisions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass

import numpy as np

from hypcheck.derivation.float_arithmetic import unit_roundoff
from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import Rows, within
from hypcheck.truth import backward_error, exact, float_filter
from hypcheck.vectors.draw import Draw, Row, ldexp, rows_of, stepped, to_bits
from hypcheck.vectors.families import FAMILIES, WORST_CANCELLATION
from hypcheck.vectors.labels import DEFEATED, TOLERANCE_U, exactly_right, in_range, leaves_range, wrong_answers

VERSION = 1
SEED = 1
STRATA = (
    *("uniform", "far-centers", "giant-spheroids", "tiny-spheroids", "near-tangent-outside", "near-tangent-inside"),
    *("degenerate-neighbourhood", "ring-neighbourhood", "osculation", "near-axis", "coefficient-zero", "axis", "waist"),
    *("regime-borders", "out-of-regime", "stiff-radial", "stiff-axial", "stiff-both"),
)
BEGINNINGS = 3
"""Searches of each kind: each begins in another block of its stratum."""

BEAM = 4
CHILDREN = 64
ROUNDS = 40
"""Of each round the BEAM worst rows go on, with CHILDREN changed copies each; of each search the worst row stays."""

EXAMINED = 16
"""Rows of a round whose backward error is measured to its digits, out of those in the highest octave."""


@dataclass(frozen=True, slots=True)
class CancellationSearch:
    """A search for rows, in contact or not, on which a formula errs in a format; its first rows are from `stratum`.

    With `contact` the search looks for rows in contact that the formula calls clear, the dangerous mistake; without it
    mostly for clear rows that it calls contact. `precision` is the name of the format, `beginning` the number of the
    block of the stratum that has the first rows.
    """

    formula: str
    precision: str
    contact: bool
    stratum: str
    beginning: int


@dataclass(frozen=True, slots=True)
class Found:
    """A row, and `error`, the backward error of the formula's answer about it."""

    row: Row
    error: float


def searches() -> tuple[CancellationSearch, ...]:
    """Return every search that contributes to the file, in order."""
    return tuple(
        CancellationSearch(formula, precision, contact, stratum, beginning)
        for formula, precision in DEFEATED
        for contact in (True, False)
        for stratum in STRATA
        for beginning in range(BEGINNINGS)
    )


def worst_rows() -> Rows:
    """Run all the searches and return the rows that they find, float64 (n, 7)."""
    candidates = (worst_row(search) for search in searches())
    return rows_of([candidate.row for candidate in candidates if candidate is not None])


def worst_row(search: CancellationSearch) -> Found | None:
    """Run a search and return the worst row that it finds; None if its error is at most TOLERANCE_U units."""
    draw = Draw(WORST_CANCELLATION, VERSION, SEED, *astuple(search))
    best = _worst(FAMILIES[search.stratum].block(SEED, search.beginning), search, [])
    for _ in range(ROUNDS if best else 0):
        parents = np.repeat(rows_of([candidate.row for candidate in best]), CHILDREN, axis=0)
        best = _worst(_changed(draw, parents), search, best)
    least = TOLERANCE_U * unit_roundoff(search.precision)
    return best[0] if best and best[0].error > least else None


def _worst(rows: Rows, search: CancellationSearch, before: Sequence[Found]) -> list[Found]:
    """Return the BEAM worst rows among these and the earlier ones (`before`), each once, the worst first."""
    overflow, underflow = leaves_range(search.formula, search.precision, rows)
    rows = rows[in_range(rows, search.precision) & within(rows) & ~(overflow | underflow)]
    positions = float_filter.positions(rows)
    wanted = (positions == Position.CONTACT) == search.contact
    rows, truths = rows[wanted], [Position(position) for position in positions[wanted].tolist()]
    listed: list[Row] = [tuple(row) for row in rows.tolist()]
    known = {candidate.row for candidate in before}
    wrong = wrong_answers(search.formula, search.precision, rows, truths)
    measured = [
        Found(listed[place], _error(listed[place], wrong[place]))
        for place in _highest_exponent_first({place: (listed[place], excuse) for place, excuse in wrong.items()})
        if listed[place] not in known and exactly_right(search.formula, listed[place], truths[place])
    ]
    unlike = {candidate.row: candidate for candidate in (*before, *measured) if 0 < candidate.error < float("inf")}
    return sorted(unlike.values(), key=lambda candidate: -candidate.error)[:BEAM]


def _highest_exponent_first(wrong: Mapping[int, tuple[Row, Position]]) -> list[int]:
    """Sort the places by the octave of the backward error, the highest first, and return at most EXAMINED of them."""
    octaves = []
    for place, (row, excuse) in wrong.items():
        pair = Pair.from_row(row)
        octaves.append((-backward_error.exponent(pair, exact.decide(pair.lengths), excuse), place))
    return [place for _, place in sorted(octaves)[:EXAMINED]]


def _error(row: Row, excuse: Position) -> float:
    """Estimate the backward error of a wrong answer about a row; `excuse` is a position for which it would be right."""
    pair = Pair.from_row(row)
    return backward_error.estimate(pair, exact.decide(pair.lengths), excuse)


def _changed(draw: Draw, rows: Rows) -> Rows:
    """Return a copy of each row in which one or more random lengths are changed, in one of four ways."""
    n, width = rows.shape
    kind = draw.integers(n, 0, 3)[:, None]
    share = draw.integers(n, 0, 2)[:, None]  # the share of lengths to change: about all, a half, a quarter
    touched = draw.integers(n * width, 0, 3).reshape(n, width) >> (2 - share) == 0
    touched[np.arange(n), draw.integers(n, 0, width - 1)] = True
    near = draw.signs(n * width).reshape(n, width) * ldexp(1, -draw.integers(n, 1, 52))[:, None]
    scaled = rows * (1 + near * draw.unit(n * width).reshape(n, width))
    ulps = stepped(rows, draw.integers(n * width, -64, 64).reshape(n, width))
    shortest = [to_bits(rows, bits) for bits in (3, 6, 12, 24)]
    short = np.choose(draw.integers(n, 0, 3)[:, None], shortest)
    turned = ldexp(rows, draw.integers(n * width, -1, 1).reshape(n, width))
    changed = np.where(kind == 0, scaled, np.where(kind == 1, ulps, np.where(kind == 2, short, turned)))
    return np.where(touched, changed, rows) + 0.0
