"""The evenness of a run's rows: the width of a fault near contact that the run can miss, and the tested coincidences.

A fault in a slice of one coordinate, such as |z|/γ between 0.50 and 0.51, is visible only in a row near contact within
the slice. So a run reports the greatest width of a slice with fewer than three such rows, and of a slice of two
coordinates without any.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import combinations
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import Floats, Indices, Mask, Rows
from hypcheck.implementations.description import Description
from hypcheck.kernel.classify import classify
from hypcheck.record.lines import SlicesPart
from hypcheck.runs.border_search import SearchStep, far_numbers, first_near_rows, first_of, rows_at
from hypcheck.runs.cases import frozen_count
from hypcheck.runs.plan import ConformancePlan, chosen_families, rows_of, searches
from hypcheck.runs.results import JudgingRules
from hypcheck.vectors import crossed
from hypcheck.vectors.border_lines import HIGHEST, RATIO_OCTAVES, RUNGS, STRATA_FARTHEST, STRATA_NEAREST, octaves_of

DISTANCE = "distance to contact"


def _distance_octaves(rows: Rows) -> Floats:
    """Return log2 of each spheroid's distance from contact, (n,); NaN outside the range of the strata.

    The distance is the relative change of size at which contact begins or ends; bisection finds it.
    """
    low, high = np.full(len(rows), STRATA_NEAREST - 1.0), np.full(len(rows), STRATA_FARTHEST + 1.0)
    touching = np.asarray(classify(rows)) == Position.CONTACT
    grown = np.where(touching, -1.0, 1.0)

    def changes(octave: Floats) -> Mask:
        """Return whether contact begins or ends at this change of size."""
        resized = rows.copy()
        resized[:, 2:4] *= (1 + grown * np.exp2(octave))[:, None]
        return np.asarray((np.asarray(classify(resized)) == Position.CONTACT) != touching)

    known = changes(high)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        beyond = changes(middle)
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return np.where(known, high, np.nan)


COORDINATES: Mapping[str, Callable[[Rows], Floats]] = MappingProxyType(
    {
        "|z|/γ": lambda rows: np.abs(rows[:, 6]) / rows[:, 1] / HIGHEST,
        "c/a": lambda rows: _share_of_octaves(
            rows[:, 1] / rows[:, 3] * rows[:, 2] / rows[:, 0], -RATIO_OCTAVES, RATIO_OCTAVES
        ),
        "d/b": lambda rows: _share_of_octaves(rows[:, 3] / rows[:, 2]),
        "α/b": lambda rows: _share_of_octaves(rows[:, 0] / rows[:, 2], -3, 7),
        "azimuth": lambda rows: np.arctan2(rows[:, 5], rows[:, 4]) / (2 * np.pi) + 0.5,
        DISTANCE: lambda rows: (_distance_octaves(rows) - STRATA_NEAREST) / (STRATA_FARTHEST - STRATA_NEAREST),
        "lean": lambda rows: np.cos(np.arctan2(np.hypot(rows[:, 7], rows[:, 8]), np.abs(rows[:, 9]))),
        "heading": lambda rows: np.arctan2(rows[:, 8], rows[:, 7]) / np.pi % 1,
    }
)
"""The coordinates on which a narrow fault may depend, as functions of rows; each is 0 to 1 in the tested range.

Upright rows have the first six.

|z|/γ is up to HIGHEST; c/a, where c = γ/d and a = α/b, and the other ratios are in octaves.
"""

UPRIGHT = tuple(COORDINATES)[:6]

ROWS_OF_ONE = 3
"""The number of tested rows in each slice of one coordinate that has the reported width."""

MOST = 40_000
"""The most rows of a family and a seed from which evenness is computed: more would not make a slice wider."""

_HALVINGS = 13
"""The number of steps of the bisection for a distance."""

_FAMILIES = {"search": "strata", "tilted-search": "tilted-strata"}
"""The family of lattices near contact, for each directed search. The rows of both lie in the same region."""

_FINEST = 256
"""The most parts into which a range is divided: no slice of two coordinates is reported as narrower than two parts."""


def slices_of(plan: ConformancePlan, used: Description, rules: JudgingRules) -> dict[str, SlicesPart]:
    """Compute the evenness of each family of lattices near contact, and of each search at all distances.

    Rows that a search tests in any case count with the family. Families without a tested row are left out.
    """
    slices = {}
    steps = {_FAMILIES[step.family]: step for step in searches(plan, used)}
    first = first_of(rules.criterion)
    for family in chosen_families(plan, used):
        if family.name in _FAMILIES.values():
            rows = _asked(rules, family.name, np.concatenate([*rows_of(plan, family, MOST)]))
            if family.name in steps:
                beside = first_near_rows(steps[family.name], first)
                rows = np.concatenate([rows, _asked(rules, steps[family.name].family, beside)])
            if len(rows):
                slices[family.name] = evenness(rows, tuple(COORDINATES) if "axis" in family.groups else UPRIGHT)
    for step in steps.values():
        numbers = far_numbers(step, first)
        inside = rules.asked_of(step.family, rows_at(step.family, step.seed, numbers))[0]
        if len(inside):
            slices[step.family] = _evenness_of_far(step, numbers[inside])
    return slices


def _asked(rules: JudgingRules, family: str, rows: Rows) -> Rows:
    """Return those of the rows that the run tests."""
    return rows[rules.asked_of(family, rows)[0]]


def evenness(rows: Rows, names: tuple[str, ...]) -> SlicesPart:
    """Compute the evenness of the rows near contact in the ranges of these coordinates, which include DISTANCE."""
    places = np.stack([COORDINATES[name](rows) for name in names])
    places = places[:, np.isfinite(places[names.index(DISTANCE)])]
    one = max(_widest(np.sort(some[(some >= 0) & (some <= 1)])) for some in places)
    return SlicesPart(coordinates=list(names), rows=places.shape[1], one=one, two=_side(places))


def _evenness_of_far(step: SearchStep, numbers: Indices) -> SlicesPart:
    """Compute the evenness of a search over all distances, on the side of contact that was tested less evenly."""
    line, rung = np.divmod(numbers, RUNGS)
    octaves = octaves_of(step.family, step.seed, line, rung)
    sides = [octaves[(rung < RUNGS // 2) == clear] for clear in (True, False)]
    one = max(_widest(np.sort(some)) for some in sides)
    return SlicesPart(coordinates=[DISTANCE], rows=len(numbers), one=one, two=1)


def _share_of_octaves(ratio: Floats, low: int = -RATIO_OCTAVES, high: int = RATIO_OCTAVES) -> Floats:
    """Map log2 of a ratio linearly: `low` to 0, `high` to 1."""
    return np.asarray((np.log2(ratio) - low) / (high - low))


def _widest(sorted_places: NDArray[np.float64]) -> float:
    """Return the width of the widest slice of [0, 1] with fewer than ROWS_OF_ONE of the places in it."""
    every = np.concatenate([[0.0], sorted_places, [1.0]])
    if len(every) <= ROWS_OF_ONE:
        return 1.0
    return float((every[ROWS_OF_ONE:] - every[:-ROWS_OF_ONE]).max())


def _side(places: NDArray[np.float64]) -> float:
    """Return twice the side of the smallest square cells, in a plane of two coordinates, that all hold a row.

    A slice of this width contains a cell at any place.
    """
    parts = _FINEST
    while parts > 1 and not all(_is_full(a, b, parts) for a, b in combinations(places, 2)):
        parts = parts - 1 - parts // 32
    return min(1.0, 2 / parts)


def _is_full(a: NDArray[np.float64], b: NDArray[np.float64], parts: int) -> bool:
    """Return whether each of parts × parts square cells of [0, 1)² holds a point (a, b)."""
    inside = (a >= 0) & (a < 1) & (b >= 0) & (b < 1)
    cells = np.floor(a[inside] * parts).astype(np.int64) * parts + np.floor(b[inside] * parts).astype(np.int64)
    return len(np.unique(cells)) == parts * parts


def crossed_of(plan: ConformancePlan, used: Description) -> dict[str, tuple[int, int]]:
    """Return, for each family that crosses coincidences, the numbers of tested and of compatible triples."""
    return {
        family.name: crossed.asked(family.name, max(frozen_count(family.name), plan.count * family.times), 3)
        for family in chosen_families(plan, used)
        if family.name in crossed.FACTORS
    }
