"""Families of extreme sizes: long ratios, the ends of the ordinary ranges, and the ends of the float formats.

- Long ratios: α/b, γ/d or both from 2¹⁰ to 2⁴⁰, about 1e3 to 1e12.
- Sizes and ratios up to the ends of the ordinary ranges: every implementation without declared ranges is tested with
  these.
- The ends of the float formats: an intermediate of the paper's Table 2 overflows or underflows.

For the last, let a = α/b or c = γ/d, or both, be about 2^k. Then the intermediates, named as in Table 2, grow like
these powers of 2^k:

    one ratio    A, B, c0, c1, c2: 2 · c1 c2, c2², c0²: 4 · c2³, c1³, c2 c1 c0: 6 · c2³ c0, (c2 c1)²: 8
    both         A, B, c2: 2 · c0, c1: 4 · c2³: 6 · c0²: 8 · c2 c1 c0, c2³ c0: 10 · (c2 c1)², c1³: 12

and b², x0², y0² grow like the square of the unit of b, x, y, whatever the ratios are. So the rows have k near
limit/power, within a few exponents, for every power and both limits of the format.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from hypcheck.derivation.float_arithmetic import FLOAT_FORMATS, FloatFormat
from hypcheck.geometry.rows import Floats, Mask, Rows, within
from hypcheck.vectors import double_roots, tilted
from hypcheck.vectors.coincidences import exact_maker
from hypcheck.vectors.double_roots import AXIAL_COLUMNS, RADIAL_COLUMNS, gathered
from hypcheck.vectors.draw import Draw, Integers, Maker, exponent, in_turn, ldexp, to_bits, turns
from hypcheck.vectors.random_pairs import Sizes, around, beside, heights, nearly_touching, offsets, sizes_of_all_regimes

STIFF_RATIOS = (10, 40)
"""Exponents of 2. Ratios beyond 1e8 are outside the domain that an implementation has unless it declares more."""

PLAIN = (-2, 6)


def stiff(*, radial: bool, axial: bool) -> Maker:
    """Return the generator of log-uniform ratios, long ones of the radial lengths, of the axial lengths or of both.

    Half of the centres are within 2.5 radii of the surface, half nearly one radius from it.
    """

    def make(draw: Draw, n: int) -> Rows:
        a = draw.log_uniform(n, *(STIFF_RATIOS if radial else PLAIN))
        c = draw.log_uniform(n, *(STIFF_RATIOS if axial else PLAIN))
        (alpha, b), (gamma, d) = _split(draw, a), _split(draw, c)
        hair = 1 + draw.signed(n, -30, -3)
        offset = np.where(turns(n, True, False), offsets(draw, n), draw.signs(n) * hair)
        return beside(draw, Sizes(alpha, gamma, b, d), heights(draw, c), offset)

    return make


def _split(draw: Draw, ratio: Floats) -> tuple[Floats, Floats]:
    """Draw two lengths with this ratio, about equally far from 1 metre on a logarithmic scale."""
    short = ldexp(draw.log_uniform(len(ratio), -1, 1), -(exponent(ratio) // 2))
    return ratio * short, short


LENGTHS, DOMAIN_RATIOS = 20, 27
"""Exponents of 2: semi-axes from 2⁻²⁰ to 2²⁰, ratios from 2⁻²⁷ to 2²⁷; rows beyond the ordinary ranges are left out."""

TENS = np.asarray([1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6])
"""The powers of ten in the ordinary range, both ends among them, as a person types them."""


@gathered
def whole_domain(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make rows with ratios and sizes log-uniform over the ordinary ranges, all around the surface or near contact.

    Half of the second ratios are independent of the first, the others are within 2⁴ of it.
    """
    octave = draw.integers(n, -DOMAIN_RATIOS, DOMAIN_RATIOS - 1)
    other = np.where(
        turns(n, True, False), draw.integers(n, -DOMAIN_RATIOS, DOMAIN_RATIOS - 1), octave + draw.integers(n, -4, 3)
    )
    (alpha, b), (gamma, d) = _lengths(draw, octave), _lengths(draw, other)
    size = Sizes(alpha, gamma, b, d)
    hair = nearly_touching(draw, n, -40, -3)
    offset = np.where(turns(n, True, True, False, False), offsets(draw, n), hair)
    rows = beside(draw, size, _heights(draw, size), offset)
    return rows, within(rows)


@gathered
def tilted_whole_domain(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make rows of tilted spheroids with the ratios, sizes and heights of rows of whole_domain."""
    upright = whole_domain(draw, n)
    size = Sizes(*upright[:, :4].T)
    hair = nearly_touching(draw, n, -40, -3)
    offset = np.where(turns(n, True, False), offsets(draw, n), hair)
    rows = tilted.beside(draw, size, upright[:, 6] / size.gamma, tilted.anywhere(draw, n), offset)
    return rows, within(rows)


def _lengths(draw: Draw, octave: Integers) -> tuple[Floats, Floats]:
    """Draw two lengths with a ratio of about 2^octave and both from 2^−LENGTHS to 2^LENGTHS, or two powers of ten."""
    n = len(octave)
    room = 2 * LENGTHS - np.abs(octave)
    unit = np.floor(draw.unit(n) * room).astype(np.int64) - LENGTHS + np.maximum(-octave, 0)
    upper, lower = ldexp(draw.mantissas(n), octave + unit), ldexp(draw.mantissas(n), unit)
    typed = draw.integers(n, 0, 3) == 0
    first, second = (TENS[draw.integers(n, 0, len(TENS) - 1)] for _ in range(2))
    return np.where(typed, first, upper), np.where(typed, second, lower)


def _heights(draw: Draw, size: Sizes) -> Floats:
    """Draw heights, in d: a quarter near the waist, a quarter within 2γ, half high above the waist.

    High means: where a surface narrower at its waist than the spheroid is about as wide as the spheroid, or anywhere up
    to 2⁸ γ.
    """
    n = len(size.b)
    share = draw.unit(n)
    aloft = np.where(size.a < 1, size.c / size.a * (0.5 + 8 * share), size.c * draw.log_uniform(n, -8, 8))
    kind = draw.integers(n, 0, 3)
    return np.asarray(np.choose(np.minimum(kind, 2), [8 * share, 2 * size.c * share, aloft]))


POWERS = (2, 4, 6, 8, 10, 12)
GROUPS = (RADIAL_COLUMNS, AXIAL_COLUMNS)


def _limits(draw: Draw, n: int, form: FloatFormat) -> Integers:
    """Draw exponents near the limits of the format, in turn near overflow and from underflow to the least subnormal."""
    over = form.overflow + draw.integers(n, -3, 3)
    under = form.least - draw.integers(n, -3, form.bits + 1)
    return np.where(turns(n, True, False), over, under)


def long_ratios(form: FloatFormat) -> Maker:
    """Return the generator of ratios that bring each intermediate to the limits of the format."""

    def make(draw: Draw, n: int) -> Rows:
        octave = _limits(draw, n, form) // np.repeat(turns(-(-n // 2), *POWERS), 2)[:n]
        ratio = ldexp(draw.mantissas(n), octave)
        plain = draw.log_uniform(n, -2, 3)
        group = turns(n, 0, 1, 2, 2, 2)  # five in turn with twice six above, so that all combinations occur
        a, c = np.where(group == 1, plain, ratio), np.where(group == 0, plain, ratio * draw.between(n, 0.5, 2))
        b, d = ldexp(draw.mantissas(n), -(exponent(a) // 2)), ldexp(draw.mantissas(n), -(exponent(c) // 2))
        size = Sizes(a * b, c * d, b, d)
        height = np.minimum(heights(draw, c), ldexp(c, np.full(n, form.overflow // 4)))
        rows = beside(draw, size, height, offsets(draw, n))
        rows[:, 4:6] *= np.where(draw.signs(n) > 0, 1, 1 + draw.signed(n, -20, -1))[:, None]
        return fitted(rows, form)

    return make


def long_units(form: FloatFormat) -> Maker:
    """Return the generator of ordinary ratios in a unit that brings a length, or its square, near the limits."""

    def make(draw: Draw, n: int) -> Rows:
        rows = around(draw, sizes_of_all_regimes(draw, n, units=(-1, 1)))
        octave = _limits(draw, n, form) // turns(n, 2, 2, 1, 1)
        group = turns(n, 0, 1, 2, 2, 2)
        for number, columns in enumerate(GROUPS):
            shift = np.where(group == 1 - number, 0, octave)
            rows[:, columns] = _shifted(rows[:, columns], shift, form)
        return fitted(rows, form)

    return make


def short_coordinates(form: FloatFormat) -> Maker:
    """Return the generator of ordinary sizes with x and y, or z, whose squares are near the format's lower limit."""

    def make(draw: Draw, n: int) -> Rows:
        rows = around(draw, sizes_of_all_regimes(draw, n, units=(-1, 1)))
        under = np.asarray(form.least - draw.integers(n, -3, form.bits + 1))
        for columns, chosen in (([4, 5], turns(n, True, False)), ([6], turns(n, False, True))):
            largest = np.abs(rows[:, columns]).max(axis=1)
            shift = np.where(chosen & (largest > 0), np.maximum(under // 2, form.least) - exponent(largest), 0)
            rows[:, columns] = ldexp(rows[:, columns], shift[:, None])
        return fitted(rows, form)

    return make


def fitted(rows: Rows, form: FloatFormat) -> Rows:
    """Round the rows to normal numbers of the format, each group in a unit that fits; small coordinates become 0."""
    rows = rows.copy()
    for columns in GROUPS:
        rows[:, columns] = to_bits(_shifted(rows[:, columns], np.zeros(len(rows), dtype=np.int64), form), form.bits)
    coordinates = rows[:, 4:]
    coordinates[np.abs(coordinates) < math.ldexp(1, form.least)] = 0
    return rows


def _shifted(lengths: Rows, shift: Integers, form: FloatFormat) -> Rows:
    """Multiply a group of lengths by 2^shift, or by the nearest power of 2 that keeps it in the format.

    The first two columns are the sizes, which must stay normal numbers.
    """
    most = form.overflow - 2 - exponent(np.abs(lengths).max(axis=1))
    least = form.least - exponent(lengths[:, :2].min(axis=1))
    return ldexp(lengths, np.minimum(np.maximum(shift, least), most)[:, None])


def subnormal(draw: Draw, n: int) -> Rows:
    """Make rows with one or both groups of lengths among the subnormal numbers of float16, float32, float64 in turn."""
    rows = around(draw, sizes_of_all_regimes(draw, n, units=(-1, 1)))
    group = turns(n, *range(4))
    for number, columns in enumerate(GROUPS):
        lengths = rows[:, columns]
        for turn, form in enumerate(FLOAT_FORMATS.values()):
            grid = form.least - form.bits + 1
            first = draw.integers(n, grid + 1, form.least - 1) - exponent(lengths[:, 1])
            steps = np.rint(ldexp(lengths, (first - grid)[:, None]))
            steps[:, :2] = np.maximum(steps[:, :2], 1)
            chosen = (np.arange(n) % 3 == turn) & (group != 1 - number)
            lengths = np.where(chosen[:, None], ldexp(steps, np.full(steps.shape, grid)), lengths)
        rows[:, columns] = lengths
    return rows + 0.0


def magnitudes(draw: Draw, n: int) -> Rows:
    """Make rows of ordinary ratios in units beyond 1e±150, the same or opposite ones for the two groups of lengths."""
    rows = around(draw, sizes_of_all_regimes(draw, n, units=(-1, 1)))
    far = draw.integers(n, 499, 1000), draw.integers(n, 499, 1000)
    sides = turns(n, 1, -1, 1, -1), turns(n, 1, -1, -1, 1)
    for columns, distance, side in zip(GROUPS, far, sides, strict=True):
        rows[:, columns] = ldexp(rows[:, columns], (distance * side)[:, None])
    return rows + 0.0


def almost_zero(draw: Draw, n: int) -> Rows:
    """Make exact tangencies with z = 0 or on the axis, and replace one coordinate 0 by 2⁻¹⁰⁰⁰ … 2⁻²⁰⁰."""
    rows = _touching_on_zero(draw, n)
    zero = rows[:, 4:] == 0
    # The first zero at or after a random place of x, y, z; there is always a zero.
    place = draw.integers(n, 0, 2)
    index = np.arange(n)
    for _ in range(2):
        place = np.where(zero[index, place], place, (place + 1) % 3)
    rows[index, 4 + place] = draw.signed(n, -1000, -200)
    return rows


_touching_on_zero = in_turn(
    exact_maker(double_roots.waist_points),
    exact_maker(double_roots.throat_circles),
    exact_maker(double_roots.osculations),
    exact_maker(partial(double_roots.waist_roots_on_an_axis, ring=False)),
)


def at_the_ends_of(name: str) -> Maker:
    """Return the generator of rows that bring each intermediate of Table 2 to the limits of a float format.

    All their numbers are 0 or normal numbers of the format.
    """
    form = FLOAT_FORMATS[name]
    return in_turn(long_ratios(form), long_units(form), short_coordinates(form))
