"""An invisible wall seen closely: where Procedure 1 in float32 reports contact about a place where a phantom stood."""

from __future__ import annotations

from typing import Any

import numpy as np

from hypcheck.casebook.draw import Floats
from hypcheck.paper.forest_trees import Procedure1, Trees
from hypcheck.paper.forest_walk import CHUNK

CELLS = 121


def wall(trees: Trees, place: Floats, half: float) -> dict[str, Any]:
    """The answers over a square about a place at its height, as lines of letters from the least y to the greatest.

    e: exterior to every tree, c: not; upper case where float32 says the other. x runs along a line.
    """
    steps = np.linspace(-half, half, CELLS)
    y, x = np.meshgrid(place[1] + steps, place[0] + steps, indexing="ij")
    at = np.stack([x.ravel(), y.ravel(), np.full(x.size, place[2])], axis=1)
    procedure, free, told = Procedure1(trees, "float32"), [], []
    for first in range(0, len(at), CHUNK):
        part = at[first : first + CHUNK]
        asked = trees.modelled(part)
        free.append((trees.exterior(part) | ~asked).all(axis=1))
        told.append((procedure.valid(part) | ~asked).all(axis=1))
    truth, answer = np.concatenate(free), np.concatenate(told)
    letters = np.where(truth, np.where(answer, "e", "E"), np.where(answer, "C", "c")).reshape(CELLS, CELLS)
    return {
        "center": place.tolist(),
        "half": half,
        "wrong": int(np.count_nonzero(truth != answer)),
        "points": int(truth.size),
        "lines": ["".join(line) for line in letters.tolist()],
    }
