"""The nearest-point oracle: the position of a pair from the distance of the spheroid's centre to the hyperboloid.

In space scaled so that the spheroid is a unit ball, the pair is apart if the distance from its centre to the
hyperboloid is over 1, on the side where the centre is; else in contact (docs/mathematics.md, "Nearest point and
clearance"). The distance comes from its Lagrange dual, which has no duality gap: every value of the dual is a lower
bound, so no answer rests on an iteration having converged. Nothing is shared with the other oracles.

`nearest` answers for one pair, exactly, without numpy; `clearances` and `positions` for arrays, in double-double
arithmetic with an error bound first. Both round the clearance to the same float64.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypcheck.truth.nearest_exact import STAGES, Nearest, Point, nearest

if TYPE_CHECKING:
    from hypcheck.geometry.rows import Rows
    from hypcheck.truth.nearest_batch import NearestBatch, NearestPositions

__all__ = ["STAGES", "Nearest", "Point", "clearances", "nearest", "positions"]


def clearances(rows: Rows) -> NearestBatch:
    """The clearances and positions of rows (n, 7). Raises InputError about the first invalid row."""
    from hypcheck.truth import nearest_batch  # noqa: PLC0415 (numpy is loaded for arrays alone, not for one pair)

    return nearest_batch.clearances(rows)


def positions(rows: Rows) -> NearestPositions:
    """The positions and tangencies of rows (n, 7), not their clearances: faster near contact. Raises InputError too."""
    from hypcheck.truth import nearest_batch  # noqa: PLC0415

    return nearest_batch.positions(rows)
