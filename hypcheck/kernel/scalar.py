"""One pair, without numpy: hypcheck.position, the compiled function where there is one and plain Python otherwise."""

from __future__ import annotations

from collections.abc import Callable

from hypcheck.geometry.pair import Pair
from hypcheck.kernel import integers
from hypcheck.kernel.choice import choice, compiled
from hypcheck.kernel.printed.scalars import FARTHEST, GREATEST, LEAST, SLACK, single


def exact_position(alpha: float, gamma: float, b: float, d: float, x: float, y: float, z: float, /) -> int:
    """The exact position of one pair: +1 exterior, 0 contact (tangency included), −1 interior.

    alpha, gamma, b, d are the semi-axes and x, y, z the centre, in one unit, by position. Raises InputError naming a
    number that is no float64 or not finite, or a semi-axis that is not greater than 0.
    """
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
    return position_by_integers(alpha, gamma, b, d, x, y, z)


def position_by_integers(*numbers: float) -> int:
    """The same by integers alone, after a look at each number."""
    return int(integers.position(Pair.from_row(numbers).lengths))


def _looked_at(*numbers: float) -> int:
    """What the compiled function asks where its arguments are no floats, or no valid pair."""
    return int(compiled().position(*Pair.from_row(numbers).row))


def _position() -> Callable[[float, float, float, float, float, float, float], int]:
    if choice().kernel == "numpy":
        return exact_position
    module = compiled()
    module.set_slow_position(_looked_at)
    function: Callable[[float, float, float, float, float, float, float], int] = module.position
    return function


position = _position()
"""exact_position, by the kernel that choice() names."""
