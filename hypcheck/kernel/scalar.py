"""One pair, without numpy: hypcheck.position, the compiled function where there is one and plain Python otherwise.

distance_at_once gives bounds of its distance by the compiled kernel, as accurate as hypcheck.clearance promises.
"""

from __future__ import annotations

import math
import reprlib
import sys
from array import array
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Protocol, overload

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
from hypcheck.kernel import integers
from hypcheck.kernel.choice import are_apart, choice, compiled
from hypcheck.kernel.printed.scalars import FARTHEST, GREATEST, LEAST, SLACK, single
from hypcheck.messages import escaped

if TYPE_CHECKING:  # it loads numpy, and one pair does without
    from hypcheck.geometry.forms import Answers, Argument


class PositionFunction(Protocol):
    """The type of hypcheck.position: the function below, or the compiled one with the same answers."""

    @overload
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
        margin: float = 0.0,
    ) -> int: ...

    @overload
    def __call__(
        self,
        *pairs: Argument,
        axis: Argument = None,
        z_min: Argument = -math.inf,
        z_max: Argument = math.inf,
        solid: Argument = False,
        margin: float = 0.0,
        **columns: Argument,
    ) -> Answers: ...


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
    """Return the position as PositionFunction does, in plain Python."""
    if z_min != -math.inf or z_max != math.inf or solid:
        return _ended_position((alpha, gamma, b, d, x, y, z), axis, (z_min, z_max, solid), exact_position)
    if axis is not None:
        return int(integers.position(_valid_row((alpha, gamma, b, d, x, y, z), axis)))
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
    return int(integers.upright_position(Pair.from_row((alpha, gamma, b, d, x, y, z)).lengths))


def _ended_position(
    numbers: Sequence[float], axis: Sequence[float] | None, heights: Sequence[float], whole: Callable[..., int]
) -> int:
    """Return the position where the hyperboloid ends; `whole` gives that without ends. Raises InputError."""
    trouble = trouble_with_heights(heights)
    if trouble is not None:
        raise InputError(trouble)
    without = Position(whole(*numbers, axis=axis))
    lengths = Lengths.of(_valid_row(numbers, UPRIGHT if axis is None else axis) + [float(h) for h in heights])
    if not lengths.has_ends:
        return without
    from hypcheck.truth import exact  # noqa: PLC0415 - hyperboloids that end alone need it

    return int(exact.ended_position(lengths, without))


def _valid_row(numbers: Sequence[float], axis: object) -> list[float]:
    """Return the row of ten numbers. Raises InputError if it is not valid."""
    values = axis.tolist() if hasattr(axis, "tolist") else axis
    if not isinstance(values, (list, tuple)) or len(values) != len(AXIS):
        raise InputError(f"axis is {escaped(reprlib.repr(axis), 60)}; it must be three numbers: {', '.join(AXIS)}")
    row = [*numbers, *values]
    trouble = trouble_with_row(row)
    if trouble is not None:
        raise InputError(trouble)
    return [float(number) for number in row]


def distance_at_once(pair: Pair) -> tuple[float, float] | None:
    """Return the distance of an upright pair without ends.

    Return None if C is missing or its bounds are farther apart than promised.

    All other pairs have None too: kernel/clearance.py answers them.
    """
    if choice().kernel == "numpy" or pair.has_ends or not pair.is_upright:
        return None
    position, numbers = array("b", [0]), array("d", [0.0] * 11)
    compiled().clearance(array("d", pair.upright.row), position, numbers)
    _, _, touch_error, low, high, *_ = numbers
    if touch_error == sys.float_info.max or are_apart(low, high, max(pair.b, pair.d)):
        return None
    return low, high


def _plain(number: Argument) -> Argument:
    """Return a scalar of numpy as a number of Python.

    Other values are unchanged. Afterwards C knows numpy's scalar types.
    """
    numpy = sys.modules.get("numpy")  # until something imports it, nothing can be one
    if numpy is None or not isinstance(number, numpy.number):
        return number
    if choice().kernel == "compiled":
        from hypcheck.kernel.compiled_kernel import extension  # noqa: PLC0415 - it loads numpy, which is there

        extension()
    return number.item()


def _are_numbers(values: Iterable[object]) -> bool:
    """Whether all values are numbers, texts or None, of Python's own types."""
    return all(isinstance(value, (int, float, str)) or value is None for value in values)


@in_default_environment
def _looked_at(
    *pairs: Argument,
    axis: Argument = None,
    z_min: Argument = -math.inf,
    z_max: Argument = math.inf,
    solid: Argument = False,
    margin: float = 0.0,
    **columns: Argument,
) -> Answers:
    """Return the exact position of one pair: +1 exterior, 0 contact (tangency included), −1 interior.

    position(alpha, gamma, b, d, x, y, z) are the semi-axes and the centre, in one unit; it loads no numpy. `axis` is
    any finite vector ≠ 0 along the spheroid's axis of revolution, of any length; without it the spheroid is upright.
    The hyperboloid ends at the heights `z_min` and `z_max`; with `solid`, flat ends belong to it. `margin`, a length: a
    spheroid that is not proved to be at least so far away counts as contact. All other forms that classify takes are
    answered as there: many pairs by an array. Raises InputError that names a number that is not a float64 or not
    finite, a semi-axis that is not greater than 0, an invalid axis, or invalid heights.

    >>> position(1, 2, 1, 1, 2.5, 0, 0)
    1
    """
    numbers, heights = tuple(map(_plain, pairs)), tuple(map(_plain, (z_min, z_max, solid)))
    one = len(numbers) == len(COLUMNS) and _are_numbers((*numbers, *heights)) and not columns and not margin
    if not one or len(getattr(axis, "shape", ())) > 1:
        from hypcheck.kernel.classify import classify_at_once  # noqa: PLC0415 - it loads numpy

        return classify_at_once(*pairs, axis=axis, z_min=z_min, z_max=z_max, solid=solid, margin=margin, **columns)
    exactly = compiled().position if choice().kernel == "compiled" else exact_position
    if heights[0] != -math.inf or heights[1] != math.inf or heights[2]:
        return _ended_position(numbers, axis, heights, exactly)
    if axis is None:
        return int(exactly(*Pair.from_row(numbers).row))
    row = _valid_row(numbers, axis)
    return int(exactly(*row[: len(COLUMNS)], axis=row[len(COLUMNS) :]))


_looked_at.__name__ = _looked_at.__qualname__ = "position"


def _position() -> PositionFunction:
    """Return hypcheck.position of the kernel that choice() names."""
    if choice().kernel == "numpy":
        return _looked_at
    module = compiled()
    module.set_slow_position(_looked_at)
    function: PositionFunction = module.position
    return function


position = _position()
"""The function for one position, of the kernel that choice() names."""
