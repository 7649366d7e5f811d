"""Exact answers to rows that were rounded first, or to a spheroid grown or shrunk by a little."""

from __future__ import annotations

import numpy as np

from tests.tools.mutants.exactly import position
from tests.tools.mutants.expectation import NO_TOLERANCE, right, wrong

U = 2.0**-53
FLOAT32 = ("--precision", "float32")


def _significant(rows, bits):
    """The rows rounded to so many significant bits, in any range."""
    mantissas, exponents = np.frexp(rows)
    return np.ldexp(np.rint(np.ldexp(mantissas, bits)), exponents - bits)


def _grown(rows, part):
    """The rows with b and d grown by this part of themselves."""
    changed = np.array(rows)
    changed[:, 2:4] *= 1 + part
    return changed


def _through_text(rows, form):
    """The rows printed and read again."""
    return np.array([float(format(value, form)) for value in rows.ravel().tolist()]).reshape(rows.shape)


@wrong()
def reads_float32(rows):
    """Claims float64, and stores the row in float32."""
    return position(_significant(rows, 24))


@wrong(claim=FLOAT32)
def reads_float16(rows):
    """Claims float32, and stores the row with the 11 bits of float16."""
    return position(_significant(rows, 11))


@wrong(claim=FLOAT32)
def reads_bfloat16(rows):
    """Claims float32, and stores the row with the 8 bits of bfloat16."""
    return position(_significant(rows, 8))


@wrong()
def reads_48_bits(rows):
    """Claims float64, and loses 5 of its 53 bits."""
    return position(_significant(rows, 48))


@wrong(asked=NO_TOLERANCE)
def reads_52_bits(rows):
    """Claims float64, and loses the last of its bits."""
    return position(_significant(rows, 52))


@wrong()
def z_in_float32(rows):
    """z alone is stored in float32."""
    changed = np.array(rows)
    changed[:, 6] = _significant(rows[:, 6], 24)
    return position(changed)


@wrong()
def b_in_float32(rows):
    """b alone is stored in float32."""
    changed = np.array(rows)
    changed[:, 2] = _significant(rows[:, 2], 24)
    return position(changed)


@wrong()
def millimetres(rows):
    """Lengths are rounded to a thousandth."""
    changed = np.round(rows, 3)
    changed[:, :4] = np.maximum(changed[:, :4], 1e-3)
    return position(changed)


@wrong()
def whole_coordinates(rows):
    """x and y are taken for integers."""
    changed = np.array(rows)
    changed[:, 4:6] = np.trunc(rows[:, 4:6])
    return position(changed)


@wrong()
def nanometres(rows):
    """Coordinates are rounded to 1e-9."""
    changed = np.array(rows)
    small = np.abs(rows[:, 4:]) < 1e6
    changed[:, 4:][small] = np.round(rows[:, 4:][small], 9)
    return position(changed)


@wrong()
def six_digits(rows):
    """The row goes through a text with six significant digits, as %g prints it."""
    return position(_through_text(rows, ".6g"))


@wrong()
def fifteen_digits(rows):
    """The row goes through a text with fifteen significant digits, two short of what tells float64 apart."""
    return position(_through_text(rows, ".15g"))


@wrong(asked=NO_TOLERANCE)
def sixteen_digits(rows):
    """The row goes through a text with sixteen significant digits, one short of what tells float64 apart."""
    return position(_through_text(rows, ".16g"))


@wrong()
def micrometres_in_32_bits(rows):
    """Lengths are micrometres in signed integers of 32 bits, which wrap."""
    whole = np.maximum(np.rint(rows * 1e6), np.where(np.arange(7) < 4, 1, -np.inf))
    wrapped = (whole + 2.0**31) % 2.0**32 - 2.0**31
    wrapped[:, :4] = np.maximum(wrapped[:, :4], 1)
    return position(wrapped)


@wrong()
def far_origin(rows):
    """Coordinates are kept relative to an origin 10 km away, along x and z."""
    changed = np.array(rows)
    for column in (4, 6):
        changed[:, column] = (rows[:, column] + 1e4) - 1e4
    return position(changed)


@wrong()
def grown_by_1e_10(rows):
    """The spheroid is grown by 1e-10 of itself, to be on the safe side."""
    return position(_grown(rows, 1e-10))


@wrong()
def shrunk_by_1e_10(rows):
    """The spheroid is shrunk by 1e-10 of itself, against false alarms."""
    return position(_grown(rows, -1e-10))


@wrong()
def grown_by_64_u(rows):
    """The spheroid is grown by 64 units of rounding."""
    return position(_grown(rows, 64 * U))


@wrong()
def shrunk_by_64_u(rows):
    """The spheroid is shrunk by 64 units of rounding."""
    return position(_grown(rows, -64 * U))


@wrong(asked=NO_TOLERANCE)
def grown_by_4_u(rows):
    """The spheroid is grown by 4 units of rounding."""
    return position(_grown(rows, 4 * U))


@wrong(asked=NO_TOLERANCE)
def shrunk_by_4_u(rows):
    """The spheroid is shrunk by 4 units of rounding."""
    return position(_grown(rows, -4 * U))


@wrong()
def skin_of_a_nanometre(rows):
    """The spheroid has a skin of 1e-9 about it, whatever its size."""
    changed = np.array(rows)
    changed[:, 2:4] += 1e-9
    return position(changed)


@wrong(asked=NO_TOLERANCE)
def radius_rounded_once(rows):
    """r = hypot(x, y) is rounded to float64; all that follows is exact."""
    changed = np.array(rows)
    changed[:, 4], changed[:, 5] = np.hypot(rows[:, 4], rows[:, 5]), 0
    return position(changed)


@wrong(asked=NO_TOLERANCE)
def ratios_rounded_once(rows):
    """α/b, γ/d, x/b, y/b and z/d are rounded to float64; all that follows is exact."""
    alpha, gamma, b, d, x, y, z = rows.T
    one = np.ones(len(rows))
    return position(np.column_stack([alpha / b, gamma / d, one, one, x / b, y / b, z / d]))


@right(claim=FLOAT32)
def float32_read_exactly_judged(rows):
    """Claims float32, stores the row in it, and errs by half a unit at most in each length."""
    return position(_significant(rows, 24))


@right(claim=("--precision", "float16"))
def float16_read_exactly_judged(rows):
    """Claims float16, stores the row with its bits, and is exact from there on."""
    return position(_significant(rows, 11))


@right()
def turned_by_45_degrees(rows):
    """The centre is turned about the axis first, at the cost of a rounding or two of r."""
    x, y = rows[:, 4], rows[:, 5]
    changed = np.array(rows)
    changed[:, 4], changed[:, 5] = (x - y) * np.sqrt(0.5), (x + y) * np.sqrt(0.5)
    return position(changed)


@right()
def grown_by_2_u(rows):
    """The spheroid is grown by two units of rounding, which the tolerance of 8 covers."""
    return position(_grown(rows, 2 * U))


@wrong()
def r_in_float32(rows):
    """r = hypot(x, y) is stored in float32."""
    changed = np.array(rows)
    changed[:, 4], changed[:, 5] = _significant(np.hypot(rows[:, 4], rows[:, 5]), 24), 0
    return position(changed)


@wrong()
def exponents_ignored(rows):
    """The row goes through a text, which is read up to the letter e: 1.5e-05 is 1.5."""
    return position(np.array([float(repr(value).split("e")[0]) for value in rows.ravel().tolist()]).reshape(rows.shape))


@right()
def reciprocals(rows):
    """1/b and 1/d are rounded once, and multiplied with; all that follows is exact."""
    alpha, gamma, b, d, x, y, z = rows.T
    one = np.ones(len(rows))
    across, along = 1 / b, 1 / d
    return position(np.column_stack([alpha * across, gamma * along, one, one, x * across, y * across, z * along]))
