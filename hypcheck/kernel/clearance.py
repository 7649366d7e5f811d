"""The public function: clearances, distances and nearest points of many pairs, each between two proved numbers."""

from __future__ import annotations

import math
from typing import Literal

from numpy.typing import ArrayLike

from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.forms import Argument, pairs_of
from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import PAIRS, Rows
from hypcheck.kernel.choice import required
from hypcheck.kernel.clearance_bounds import Clearance, clearances_without_ends


@in_default_environment
def clearance(
    *pairs: Argument,
    axis: ArrayLike | None = None,
    z_min: ArrayLike = -math.inf,
    z_max: ArrayLike = math.inf,
    solid: ArrayLike = False,
    on_invalid: Literal["raise", "flag"] = "raise",
    threads: int | None = None,
    **columns: ArrayLike,
) -> Clearance:
    """The distance, the nearest points and the clearance of every pair, each between two numbers that are proved.

    Pairs are written as in classify: rows, a table, or sizes and centres. One pair of numbers is answered by numbers.
    The first invalid row raises InputError; with on_invalid="flag" such rows have the position 127 and NaN everywhere.

    The clearance is known within 2⁻³⁰ of 1 + clearance, or of 1 where that is greater, unless the spheroid so much
    enlarged leaves float64. The distance is known within 2⁻²⁹ of itself and b or d, unless a spheroid that holds all
    points so near reaches the hyperboloid elsewhere: long ones in a groove, and some tilted ones. Then it lies between
    clearance · min(b, d) and clearance · max(b, d), or nearer. So it does where the hyperboloid ends; there no error of
    the touching point is proved, and a row takes some milliseconds.

    >>> near = clearance(2, 17.8, 0.25, 0.15, [3, 4, 0])
    >>> near.distance_lower <= 2.75 <= near.distance_upper
    True
    >>> near.normal.round(12)
    array([0.6, 0.8, 0. ])
    """
    number = required("position", threads, on_invalid)
    call = pairs_of(pairs, columns, axis, (z_min, z_max, solid))
    queries = call.rows()
    result = clearances(queries, number)
    if on_invalid == "raise" and (result.position == REFUSED).any():
        call.require_valid(queries)
    return result.one if call.single else result


def clearances(queries: Rows, threads: int | None = None) -> Clearance:
    """The same of rows of any width; invalid ones have the position 127 and NaN everywhere."""
    if not PAIRS.has_heights(queries):
        return clearances_without_ends(queries, threads)
    from hypcheck.kernel.clearance_ends import ended_clearances  # noqa: PLC0415 - rows with heights alone need it

    return ended_clearances(queries, threads)
