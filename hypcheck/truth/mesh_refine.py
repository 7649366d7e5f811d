"""Cutting the meridian into cells until bounds decide whether the surface comes within one radius of C."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from hypcheck.truth.mesh_cells import SLACK, Bounds, Cell, Segment, bounds_of, cell_of, halves
from hypcheck.truth.mesh_window import REACH, UNIT, Meridian, window_of

REACH_RADII = REACH / UNIT
RESOLUTION = 4 * SLACK
"""Where the bounds come this close to each other (7·10⁻¹⁵ radii) and to 1, finer cells would tell nothing more."""

MOST_CELLS = 1 << 14
"""Cells kept at most on one level. A tangency of fourth order (c² = a at the waist), the highest there is, opens about
4,000 at the resolution; the limit keeps the time of a query bounded."""


class Outcome(Enum):
    """What a mesh can say of a pair: it has sides only by the sign of F(C), so it names none."""

    CLEAR = "clear"
    CONTACT = "contact"
    UNDECIDED = "undecided"


@dataclass(frozen=True, slots=True)
class Refinement:
    """The proved outcome, the mesh that shows it (facets in the meridian plane) and bounds on the distance in radii.

    The mesh of a clear pair is the near one over the whole window, each cell at the size at which it was settled; that
    of a contact the far one over the cells that were open. `levels` counts the rounds of cutting, the first being 1.
    """

    outcome: Outcome
    facets: tuple[Segment, ...]
    levels: int
    lower: float
    upper: float


def refine(meridian: Meridian) -> Refinement:
    """Cut open cells in halves, level by level, until all are beyond one radius, or one proves contact, or neither.

    Ends always: the bounds of a cell are at most 62 u and twice its length apart (u = 2⁻⁵³: 2 SLACK, and what SLACK
    covers at most), which is below RESOLUTION = 64 u long before the length has shrunk to one step of e, 2⁻⁶³ radii.
    """
    outside = meridian.side >= 0
    window = window_of(meridian)
    cells = [] if window is None else [cell_of(meridian, *window)]
    settled: list[Segment] = []
    settled_lower, upper, levels = REACH_RADII, float("inf"), 0
    while cells:
        levels += 1
        judged = [(cell, bounds_of(cell, outside=outside)) for cell in cells]
        lower = min(settled_lower, *(bounds.lower for _, bounds in judged))
        upper = min(upper, *(bounds.upper for _, bounds in judged))
        if upper <= 1.0:
            return Refinement(Outcome.CONTACT, _facets(cells, chords=not outside), levels, lower, upper)
        cells = [cell for cell, bounds in judged if bounds.lower <= 1.0]
        if cells and (upper - lower <= RESOLUTION or len(cells) > MOST_CELLS):
            return Refinement(Outcome.UNDECIDED, (), levels, lower, upper)
        beyond = [(cell, bounds) for cell, bounds in judged if bounds.lower > 1.0]
        settled.extend(_facets((cell for cell, _ in beyond), chords=outside))
        settled_lower = min(settled_lower, _least(bounds for _, bounds in beyond))
        cells = [half for cell in cells for half in halves(meridian, cell)]
    return Refinement(Outcome.CLEAR, tuple(settled), levels, settled_lower, upper)


def _facets(cells: Iterable[Cell], *, chords: bool) -> tuple[Segment, ...]:
    return tuple(segment for cell in cells for segment in (cell.chord if chords else cell.tangents))


def _least(bounds: Iterable[Bounds]) -> float:
    return min((each.lower for each in bounds), default=float("inf"))
