"""The frozen vectors as a run asks them: read once, or taken from the process that has read them already."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hypcheck.casebook import vectors
from hypcheck.pairs import Position
from hypcheck.rows import Positions, Rows

_SMALLEST = 1e-300
"""Distances below are too near to where floats end for a frozen vector to say them well enough."""


@dataclass(frozen=True, slots=True)
class Frozen:
    """The vectors of a family: ids, rows (n, 7), positions, int8 (n,), and of each its octave, float64 (n,).

    An octave is floor(log2) of the distance to the nearest other position; NaN where the vector cannot tell it.
    """

    ids: tuple[str, ...]
    rows: Rows
    positions: Positions
    octaves: NDArray[np.float64]


_READ: dict[str, Frozen] = {}


def frozen(name: str) -> Frozen:
    """The vectors of a family. Raises InputError where it has none."""
    if name not in _READ:
        found = vectors.frozen_rows(name)
        octaves = np.array([_octave(vector.position, vector.flips) for vector in vectors.load(name).cases])
        _READ[name] = Frozen(found.ids, found.rows, found.positions, octaves)
    return _READ[name]


def read_here() -> Mapping[str, Frozen]:
    """All that were read by this process, for another one to take: a file is read slowly, being checked."""
    return dict(_READ)


def take(some: Mapping[str, Frozen]) -> None:
    """Read these no more."""
    _READ.update(some)


def _octave(position: Position, flips: Mapping[Position, float]) -> float:
    """From distances that are rounded up: above 2^k, and 2^(k+1) at most. NaN where floats end."""
    nearest = min(flips.values()) if position is Position.CONTACT else flips[Position.CONTACT]
    if nearest == 0:
        return -math.inf
    if nearest < _SMALLEST:
        return math.nan
    mantissa, exponent = math.frexp(nearest)
    return exponent - (2 if mantissa == 0.5 else 1) if math.isfinite(nearest) else nearest
