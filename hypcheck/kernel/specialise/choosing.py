"""Which lines a setting gets: those that decide most centres of its region, and no more than pay for themselves."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import isqrt

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.evaluation import outputs
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.kernel.specialise.formats import Format
from hypcheck.kernel.specialise.lines import Line, line_at
from hypcheck.kernel.specialise.scale import Scaled
from hypcheck.pairs import Position

WORTH = 0.05
"""Share of all centres that a line has to decide, beyond those before it, to be worth its four operations."""

MOST_LINES = 2
"""Lines a side at most."""

Mask = NDArray[np.bool_]
Floats = NDArray[np.float64]


def lines_for(
    side: Position, scaled: Scaled, form: Format, R: Floats, zz: Floats, first_number: int
) -> tuple[tuple[Line, ...], Mask]:
    """The lines of a side for centres with these R and zz, (n,) each, and a mask of the centres they decide."""
    decided = np.zeros(len(R), dtype=bool)
    chosen: list[Line] = []
    while len(chosen) < MOST_LINES:
        number = first_number + len(chosen)
        tried = [(line, beyond(line, form, R, zz)) for line in _candidates(side, scaled, form, number)]
        if not tried:
            break
        line, mask = max(tried, key=lambda pair: int((pair[1] & ~decided).sum()))
        if (mask & ~decided).sum() < WORTH * len(R):
            break
        chosen.append(line)
        decided |= mask
    return tuple(chosen), decided


def beyond(line: Line, form: Format, R: Floats, zz: Floats) -> Mask:
    """Which centres the line decides, computed as the kernel does."""
    inputs = {"R": R, "zz": zz, **line.constants}
    (mask,) = outputs(line.program, float_arithmetic(form.name), inputs, (line.holds,))
    return np.asarray(mask, dtype=bool)


def _candidates(side: Position, scaled: Scaled, form: Format, number: int) -> Iterator[Line]:
    """Lines at λ around √A, and as near to the pole as half of it."""
    sign, pole = (1, scaled.B) if side is Position.EXTERIOR else (-1, scaled.A)
    root = _few_bits(Fraction(isqrt(int(scaled.A * 2**64)) or 1, 2**32))
    multipliers = {min(root * Fraction(2) ** power, _few_bits(pole / 2)) for power in range(-6, 7)}
    for multiplier in sorted(multipliers):
        line = line_at(sign * multiplier, scaled, form, number)
        if line is not None:
            yield line


def _few_bits(value: Fraction) -> Fraction:
    """The value with four significant bits, rounded down: a number that a person can read."""
    exponent = value.numerator.bit_length() - value.denominator.bit_length() - 3
    step = Fraction(2) ** exponent
    return value // step * step
