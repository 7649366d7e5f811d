"""Local search: from a wrong answer to worse ones next to it, by a pattern search with halving steps.

A climber stands on a row. Its neighbours have one of the six unknowns multiplied by 1 ± step (the logarithms of the
sizes are what is searched), or stand on one of the surfaces exactly. Where floats fail they mostly do so in a thin
layer at the border of contact, which a plain step would leave; so each neighbour is asked as it is and also brought to
the border, and a ladder of ever larger steps off it is asked: the farthest rung with a wrong answer counts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hypcheck.casebook.draw import Draw, Integers
from hypcheck.hunt.border import MOVERS, border_factors, columns_of, ladders
from hypcheck.rows import Rows, invalid

Row = tuple[float, ...]

FIRST_STEP = 0.5
LAST_STEP = 2.0**-44

_MOVES = [
    (0,),
    (1,),
    (2,),
    (3,),
    (4, 5),
    (6,),
    (0, 2, 4, 5),  # the radial and the axial unit: nothing changes but the rounding
    (1, 3, 6),
]


@dataclass(slots=True)
class Climber:
    """Where a search stands: the row, its backward error, and the step that is tried next."""

    row: Row
    error: float
    step: float = FIRST_STEP

    @property
    def resting(self) -> bool:
        """Whether nothing worse was found down to the last step, or nothing can be."""
        return self.step < LAST_STEP or not 0 < self.error < math.inf


@dataclass(frozen=True, slots=True)
class Neighbours:
    """Rows (n, 7) to be asked; the climber that each belongs to, and its ladder (a row on none is one of its own).

    The rungs of a ladder follow each other away from the border: of those with a wrong answer the last is the worst.
    """

    rows: Rows
    owners: Integers
    ladders: Integers


def neighbours(draw: Draw, climbers: Sequence[Climber]) -> Neighbours:
    """All that the climbers want to know next."""
    with np.errstate(all="ignore"):  # what leaves float64 is not valid, and is not asked
        around = [_around(climber) for climber in climbers]
    rows = np.concatenate(around)
    owners = np.repeat(np.arange(len(climbers)), [len(part) for part in around])
    valid = ~invalid(rows)
    rows, owners = rows[valid], owners[valid]
    mask = columns_of(np.asarray(list(MOVERS))[draw.integers(len(rows), 0, len(MOVERS) - 1)])
    rungs, numbers = ladders(rows, mask, border_factors(rows, mask, draw.signs(len(rows)) > 0))
    rungs, numbers = rungs[~invalid(rungs)], numbers[~invalid(rungs)]
    return Neighbours(
        np.concatenate([rows, rungs]),
        np.concatenate([owners, owners[numbers // 2]]),
        np.concatenate([np.arange(len(rows)), len(rows) + numbers]),
    )


def _around(climber: Climber) -> Rows:
    """The row itself, its neighbours one step away, and its images on the four surfaces."""
    rows = np.repeat(np.array([climber.row]), 1 + 2 * len(_MOVES) + 4, axis=0)
    for number, columns in enumerate(_MOVES):
        rows[1 + 2 * number, columns] *= 1 + climber.step
        rows[2 + 2 * number, columns] /= 1 + climber.step
    axis, waist, throat, groove = rows[-4:]
    axis[4:6] = 0
    waist[6] = 0
    throat[0] = throat[2]
    groove[1] = groove[3] * np.sqrt(groove[0] / groove[2])
    return rows
