"""Lines across the border of contact, for a directed search: one pair, and its spheroid in many sizes.

A line begins with a spheroid that touches, and its size is multiplied: a larger one is in contact, a smaller one is
clear. A search asks where on the line an implementation's answer changes (runs/border_search.py). The rungs of a line
are numbered, so that a row has a case id like any other: row i of the family is rung i mod RUNGS of line i div RUNGS.
The pairs are those of a lattice, as in strata.py, of other random shifts.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.kernel.classify import classify
from hypcheck.vectors import strata
from hypcheck.vectors.draw import Draw, Integers
from hypcheck.vectors.family import BLOCK, Family

RUNGS_ON_A_SIDE = 64
RUNGS = 2 * RUNGS_ON_A_SIDE
"""Rungs of a line: first those that are clear, then those in contact, each from the border outwards."""

NEAREST_OCTAVE, FARTHEST_OCTAVE = -48, 0
"""The size of a rung differs by 2^NEAREST_OCTAVE to 2^FARTHEST_OCTAVE of itself from that which touches."""

_LEAST, _MOST = 2.0**-12, 1 + 2.0**-20
"""Between these factors of its size a spheroid begins to touch: it was made to, but may reach the surface elsewhere."""

LINES = 1 << strata.BITS
"""Lines of one lattice."""


@dataclass(frozen=True)
class LineFamily(Family):
    """The rungs of all lines of a seed, line after line."""

    def rungs(self, seed: int, lattice: int, lines: Integers, rungs: Integers) -> Rows:
        """The rows of these lines of a lattice, (n,), at these rungs, (n,)."""
        rows, jitter = _lines(self.name, self.version, seed, lattice, self.tilted)
        return _resized(rows[lines], _changes(rungs, jitter[lines]))

    def _blocks(self, seed: int, first: int, last: int) -> Rows:
        return np.concatenate([self._block(seed, number) for number in range(first, last)])

    def _block(self, seed: int, number: int) -> Rows:
        lattice, start = divmod(number * BLOCK, LINES * RUNGS)
        places = start + np.arange(BLOCK)
        return self.rungs(seed, lattice, places // RUNGS, places % RUNGS)


def _not_alone(draw: Draw, n: int) -> Rows:
    raise NotImplementedError(f"{n} rows of {draw} are made line by line")


SEARCHED = {
    "search": LineFamily("search", _not_alone, times=10),
    "tilted-search": LineFamily("tilted-search", _not_alone, times=10, tilted=True),
}
"""The families whose rows a directed search chooses, by name; `times` counts the rows that it asks."""


@lru_cache(8)
def _lines(name: str, version: int, seed: int, number: int, tilted: bool) -> tuple[Rows, Floats]:
    """The lines of a lattice: rows that are just clear, and the share of a rung by which its rungs lie farther out."""
    points = strata.lattice(Draw(name, version, seed, number), LINES)
    rows = (strata.tilted_at if tilted else strata.upright_at)(points, np.zeros(LINES))
    return _resized(rows, _touch(rows) - 1), points[6]


def _touch(rows: Rows) -> Floats:
    """The largest factor of each spheroid's size at which it is clear, (n,)."""
    # To halve bit patterns halves the logarithm at first, and the factor itself at the end.
    below, above = (np.full(len(rows), factor).view(np.int64) for factor in (_LEAST, _MOST))
    while (above - below).max(initial=0) > 1:
        middle = below + (above - below) // 2
        touches = np.asarray(classify(_resized(rows, middle.view(np.float64) - 1))) == Position.CONTACT
        below, above = np.where(touches, below, middle), np.where(touches, middle, above)
    return np.asarray(below.view(np.float64))


def _resized(rows: Rows, change: Floats) -> Rows:
    """The rows with a spheroid that is larger by this share of itself."""
    resized = rows.copy()
    resized[:, 2:4] += rows[:, 2:4] * change[:, None]
    return resized


def _changes(rungs: Integers, jitter: Floats) -> Floats:
    """By what share of itself the size at these rungs differs from that which touches."""
    change = strata.octaves(_share(rungs, jitter), NEAREST_OCTAVE, FARTHEST_OCTAVE)
    return np.asarray(np.where(rungs < RUNGS_ON_A_SIDE, -change, change))


def _share(rungs: Integers, jitter: Floats) -> Floats:
    return np.asarray((rungs % RUNGS_ON_A_SIDE + jitter) / RUNGS_ON_A_SIDE)


def octaves_of(name: str, seed: int, lines: Integers, rungs: Integers) -> Floats:
    """How far off contact these rungs of these lines of a searched family are, (n,).

    As a share of the octaves from NEAREST_OCTAVE to FARTHEST_OCTAVE.
    """
    family, shares = SEARCHED[name], np.empty(len(lines))
    for lattice in sorted({*(lines // LINES).tolist()}):
        some = lines // LINES == lattice
        _, jitter = _lines(name, family.version, seed, lattice, family.tilted)
        shares[some] = _share(rungs[some], jitter[lines[some] % LINES])
    return shares
