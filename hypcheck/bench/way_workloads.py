"""Workloads of ways: rows of ten numbers, two that are timed, two on which methods err, and the frozen ways."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from hypcheck.bench.plan import Workload
from hypcheck.geometry.rows import WAYS, Rows
from hypcheck.vectors import frozen
from hypcheck.vectors.draw import Draw, in_turn
from hypcheck.vectors.families import WAY_FAMILIES
from hypcheck.vectors.family import BLOCK

SHARE = 6
"""A way takes about a millisecond to decide, so a sixth of the rows of other workloads is judged."""

_WIDTH = len(WAYS.upright)


def _of_families(*names: str) -> Callable[[int, int], Rows]:
    """Ways of several families in turn."""
    make = in_turn(*(WAY_FAMILIES[name].make for name in names))

    def rows(seed: int, count: int) -> Rows:
        blocks = [make(Draw("bench-ways", *names, 1, seed, number), BLOCK) for number in range(-(-count // BLOCK))]
        return np.concatenate([np.empty((0, _WIDTH)), *blocks])[:count]

    return rows


def _frozen(_seed: int, count: int) -> Rows:
    return frozen_ways()[:count].copy()


@cache
def frozen_ways() -> Rows:
    """The frozen ways of upright spheroids, all families in turn."""
    families = [frozen.load_ways(name).rows for name, family in WAY_FAMILIES.items() if not family.tilted]
    places = np.concatenate([np.arange(len(rows)) for rows in families])
    return np.concatenate(families)[np.argsort(places, kind="stable")]


def _workload(name: str, title: str, text: str, rows: Callable[[int, int], Rows], *, timed: bool = False) -> Workload:
    return Workload(name, title, text, rows, timed, SHARE, WAYS)


WAY_WORKLOADS = {
    workload.name: workload
    for workload in (
        _workload(
            "tower",
            "down through the tower's waist",
            "A quadcopter's body straight down through the waist of the paper's cooling tower and out, about as near "
            "to the wall as it may come (the family way-tower).",
            _of_families("way-tower"),
            timed=True,
        ),
        _workload(
            "anywhere",
            "anywhere about the waist",
            "Both ends uniform in a box about the waist; sizes differ from row to row (the family way-anywhere).",
            _of_families("way-anywhere"),
            timed=True,
        ),
        _workload(
            "tunnelling",
            "steps that are too long",
            "Straight through a wall, through the whole waist, past the surface from far away: both ends are mostly "
            "clear and contact is between (the families way-tunnelling, way-across and way-long).",
            _of_families("way-tunnelling", "way-across", "way-long"),
        ),
        _workload(
            "grazing",
            "grazing or nearly so",
            "Tangent at one instant or at an end, or by 2⁻⁵⁰ to 2⁻³ of the size from it (the families way-near-graze, "
            "way-grazing and way-end).",
            _of_families("way-near-graze", "way-grazing", "way-end"),
        ),
        _workload(
            "frozen",
            "the frozen ways",
            "The certified vectors of ways of upright spheroids, all 18 families in turn (cases/way-*.json).",
            _frozen,
        ),
    )
}
"""By name, in the order of the record."""
