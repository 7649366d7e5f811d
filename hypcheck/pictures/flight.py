"""What a picture of a flight shows: numbers that were decided elsewhere, so that a picture decides nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]


@dataclass(frozen=True)
class ShownContact:
    """Where the mover has its first contact on a segment: its centre, and the hyperboloid's number."""

    segment: int
    center: Sequence[float]
    index: int


@dataclass(frozen=True)
class ShownFlight:
    """A flight in a scene.

    `points` (T, 3) are the corners, and `axes` (T - 1, 3) the mover's axis on each segment. `hits` (T - 1,) says which
    segments have contact; `contacts` are the first of some of them. `places` (T - 1, parts, 3) are those of the
    mover's parts, from its centre.

    The flight is cut into k pieces of one length. `lower`, `upper` (k,) are proved bounds of the least distance on
    each, `near` (k,) the hyperboloid that it is from, and `touched` (k,) says where it is 0. `least` is the
    length flown to the least of all, and its bounds.
    """

    points: Numbers
    axes: Numbers
    hits: NDArray[np.bool_]
    contacts: Sequence[ShownContact]
    places: Numbers
    lower: Numbers
    upper: Numbers
    near: NDArray[np.intp]
    touched: NDArray[np.bool_]
    least: tuple[float, float, float]
    summary: str
