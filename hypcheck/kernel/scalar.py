"""One pair, without numpy: hypcheck.position, the compiled function where there is one and plain Python otherwise."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Sequence
from typing import Protocol

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.pair import (
    AXIS,
    COLUMNS,
    UPRIGHT,
    Lengths,
    Pair,
    Position,
    trouble_with_heights,
    trouble_with_row,
)
from hypcheck.kernel import integers, tilted_integers
from hypcheck.kernel.choice import choice, compiled
from hypcheck.kernel.printed.scalars import FARTHEST, GREATEST, LEAST, SLACK, single
from hypcheck.messages import escaped


class PositionFunction(Protocol):
    """What hypcheck.position is: exact_position, or the compiled function that answers the same."""

    def __call__(
        self,
        alpha: float,
        gamma: float,
        b: float,
        d: float,
        x: float,
        y: float,
        z: float,
        /,
        *,
        axis: Sequence[float] | None = None,
        z_min: float = -math.inf,
        z_max: float = math.inf,
        solid: bool = False,
    ) -> int:
        """As exact_position."""


@in_default_environment
def exact_position(
    alpha: float,
    gamma: float,
    b: float,
    d: float,
    x: float,
    y: float,
    z: float,
    /,
    *,
    axis: Sequence[float] | None = None,
    z_min: float = -math.inf,
    z_max: float = math.inf,
    solid: bool = False,
) -> int:
    """The exact position of one pair: +1 exterior, 0 contact (tangency included), −1 interior.

    alpha, gamma, b, d are the semi-axes and x, y, z the centre, in one unit, by position. `axis` is any finite vector
    ≠ 0 along the spheroid's axis of revolution, of any length; without it the spheroid is upright. The hyperboloid ends
    at the heights `z_min` and `z_max`; with `solid`, flat ends belong to it. Raises InputError naming a number that is
    no float64 or not finite, a semi-axis that is not greater than 0, what is no axis, or heights that are none.
    """
    if z_min != -math.inf or z_max != math.inf or solid:
        return _ended_position((alpha, gamma, b, d, x, y, z), axis, (z_min, z_max, solid), exact_position)
    if axis is not None:
        return int(tilted_integers.position(_valid_row((alpha, gamma, b, d, x, y, z), axis)))
    if (
        type(alpha) is type(gamma) is type(b) is type(d) is type(x) is type(y) is type(z) is float
        and (LEAST < b < GREATEST and LEAST < d < GREATEST)
        and (alpha > 0 and gamma > 0)
    ):
        A, B, BB, P_plus_Q, c1, e1, c2, e2, delta_3, E = single(alpha, gamma, b, d, x, y, z)
        if LEAST < A < GREATEST and LEAST < B < GREATEST and P_plus_Q < FARTHEST:
            if delta_3 < -E:
                return 0
            if delta_3 > E:  # three roots; under c² > a three positive ones, under a > 1 two negative ones decide
                if c2 < -e2 and c1 > e1:
                    if BB > SLACK * A:
                        return 1
                elif (c2 > e2 or c1 < -e1) and A > SLACK:
                    return -1
    return int(integers.position(Pair.from_row((alpha, gamma, b, d, x, y, z)).lengths))


def _ended_position(
    numbers: Sequence[float], axis: Sequence[float] | None, heights: Sequence[float], whole: PositionFunction
) -> int:
    """The position where the hyperboloid ends; `whole` gives that without ends. Raises InputError."""
    trouble = trouble_with_heights(heights)
    if trouble is not None:
        raise InputError(trouble)
    without = Position(whole(*numbers, axis=axis))
    lengths = Lengths.of(_valid_row(numbers, UPRIGHT if axis is None else axis) + [float(h) for h in heights])
    if not lengths.has_ends:
        return without
    from hypcheck.truth import ends  # noqa: PLC0415 - hyperboloids that end alone need it

    return int(ends.position(lengths, without))


def _valid_row(numbers: Sequence[float], axis: object) -> list[float]:
    """The row of ten. Raises InputError where it is none."""
    values = axis.tolist() if hasattr(axis, "tolist") else axis
    if not isinstance(values, (list, tuple)) or len(values) != len(AXIS):
        raise InputError(f"axis is {escaped(reprlib.repr(axis), 60)}; it must be three numbers: {', '.join(AXIS)}")
    row = [*numbers, *values]
    trouble = trouble_with_row(row)
    if trouble is not None:
        raise InputError(trouble)
    return [float(each) for each in row]


@in_default_environment
def _looked_at(
    *numbers: float,
    axis: Sequence[float] | None = None,
    z_min: float = -math.inf,
    z_max: float = math.inf,
    solid: bool = False,
) -> int:
    """What the compiled function asks where its arguments are no floats, no valid pair, or say that it ends."""
    if z_min != -math.inf or z_max != math.inf or solid:
        return _ended_position(numbers, axis, (z_min, z_max, solid), compiled().position)
    if axis is None:
        return int(compiled().position(*Pair.from_row(numbers).row))
    row = _valid_row(numbers, axis)
    return int(compiled().position(*row[: len(COLUMNS)], axis=row[len(COLUMNS) :]))


def _position() -> PositionFunction:
    if choice().kernel == "numpy":
        return exact_position
    module = compiled()
    module.set_slow_position(_looked_at)
    function: PositionFunction = module.position
    return function


position = _position()
"""exact_position, by the kernel that choice() names."""
