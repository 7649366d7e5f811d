"""The ends of the float formats: where an intermediate of the paper's Table 2 overflows or underflows.

With a = α/b and c = γ/d about 2^k (one of them, or both) the intermediates grow like these powers of 2^k:

    one ratio    A, B, c0, c1, c2: 2 · c1 c2, c2², c0²: 4 · c2³, c1³, c2 c1 c0: 6 · c2³ c0, (c2 c1)²: 8
    both         A, B, c2: 2 · c0, c1: 4 · c2³: 6 · c0²: 8 · c2 c1 c0, c2³ c0: 10 · (c2 c1)², c1³: 12

and b², x0², y0² like the square of the common unit whatever the ratios are. So the rows take k = limit/power for every
power and both limits of the format, a few octaves to each side.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hypcheck.casebook import double_roots
from hypcheck.casebook.draw import Draw, Integers, Maker, exponent, in_turn, ldexp, to_bits, turns
from hypcheck.casebook.everyday import all_regimes
from hypcheck.casebook.exactly import AXIAL_COLUMNS, RADIAL_COLUMNS
from hypcheck.casebook.family import Family
from hypcheck.casebook.placing import Sizes, around, beside, heights, offsets, sizes
from hypcheck.casebook.tangency import exactly, two_points_on_an_axis
from hypcheck.rows import Rows


@dataclass(frozen=True, slots=True)
class Format:
    """A binary float format: `bits` of significand, normal numbers in ±[2^lowest, 2^highest)."""

    bits: int
    lowest: int
    highest: int


FORMATS = {
    "float16": Format(11, -14, 16),
    "float32": Format(24, -126, 128),
    "float64": Format(53, -1022, 1024),
}
POWERS = (2, 4, 6, 8, 10, 12)
GROUPS = (RADIAL_COLUMNS, AXIAL_COLUMNS)


def _limits(draw: Draw, n: int, form: Format) -> Integers:
    """Exponents near the format's limits in turn: overflow, underflow, and down to where subnormals end."""
    over = form.highest + draw.integers(n, -3, 3)
    under = form.lowest - draw.integers(n, -3, form.bits + 1)
    return np.where(turns(n, True, False), over, under)


def long_ratios(form: Format) -> Maker:
    """Ratios that bring each intermediate to the limits of the format."""

    def make(draw: Draw, n: int) -> Rows:
        octave = _limits(draw, n, form) // np.repeat(turns(-(-n // 2), *POWERS), 2)[:n]
        ratio = ldexp(draw.mantissas(n), octave)
        plain = draw.log_uniform(n, -2, 3)
        group = turns(n, 0, 1, 2, 2, 2)  # five in turn beside twice six above, so that all combinations come
        a, c = np.where(group == 1, plain, ratio), np.where(group == 0, plain, ratio * draw.between(n, 0.5, 2))
        b, d = ldexp(draw.mantissas(n), -(exponent(a) // 2)), ldexp(draw.mantissas(n), -(exponent(c) // 2))
        size = Sizes(a * b, c * d, b, d)
        height = np.minimum(heights(draw, c), ldexp(c, np.full(n, form.highest // 4)))
        rows = beside(draw, size, height, offsets(draw, n))
        rows[:, 4:6] *= np.where(draw.signs(n) > 0, 1, 1 + draw.signs(n) * draw.log_uniform(n, -20, -1))[:, None]
        return fitted(rows, form)

    return make


def long_units(form: Format) -> Maker:
    """Ordinary ratios in units so large or small that a length, or its square, comes to the limits of the format."""

    def make(draw: Draw, n: int) -> Rows:
        rows = around(draw, sizes(draw, *all_regimes(draw, n), units=(-1, 1)))
        octave = _limits(draw, n, form) // turns(n, 2, 2, 1, 1)
        group = turns(n, 0, 1, 2, 2, 2)
        for number, columns in enumerate(GROUPS):
            shift = np.where(group == 1 - number, 0, octave)
            rows[:, columns] = _shifted(rows[:, columns], shift, form)
        return fitted(rows, form)

    return make


def short_coordinates(form: Format) -> Maker:
    """Ordinary sizes, and x, y or z so small that P, Q or the coordinate's square comes to the lower limit."""

    def make(draw: Draw, n: int) -> Rows:
        rows = around(draw, sizes(draw, *all_regimes(draw, n), units=(-1, 1)))
        under = np.asarray(form.lowest - draw.integers(n, -3, form.bits + 1))
        for columns, chosen in (([4, 5], turns(n, True, False)), ([6], turns(n, False, True))):
            largest = np.abs(rows[:, columns]).max(axis=1)
            shift = np.where(chosen & (largest > 0), np.maximum(under // 2, form.lowest) - exponent(largest), 0)
            rows[:, columns] = ldexp(rows[:, columns], shift[:, None])
        return fitted(rows, form)

    return make


def fitted(rows: Rows, form: Format) -> Rows:
    """The rows in the format's own normal numbers: each group in a unit that fits, rounded, small coordinates 0."""
    rows = rows.copy()
    for columns in GROUPS:
        rows[:, columns] = to_bits(_shifted(rows[:, columns], np.zeros(len(rows), dtype=np.int64), form), form.bits)
    coordinates = rows[:, 4:]
    coordinates[np.abs(coordinates) < math.ldexp(1, form.lowest)] = 0
    return rows


def _shifted(lengths: Rows, shift: Integers, form: Format) -> Rows:
    """One group of lengths times 2^shift, or as near to that as keeps it within the format; sizes come first."""
    most = form.highest - 2 - exponent(np.abs(lengths).max(axis=1))
    least = form.lowest - exponent(lengths[:, :2].min(axis=1))
    return ldexp(lengths, np.minimum(np.maximum(shift, least), most)[:, None])


def subnormal(draw: Draw, n: int) -> Rows:
    """One group of lengths, or both, among the subnormal numbers of float16, float32 or float64, in turn."""
    rows = around(draw, sizes(draw, *all_regimes(draw, n), units=(-1, 1)))
    group = turns(n, *range(4))
    for number, columns in enumerate(GROUPS):
        lengths = rows[:, columns]
        for turn, form in enumerate(FORMATS.values()):
            grid = form.lowest - form.bits + 1
            first = draw.integers(n, grid + 1, form.lowest - 1) - exponent(lengths[:, 1])
            steps = np.rint(ldexp(lengths, (first - grid)[:, None]))
            steps[:, :2] = np.maximum(steps[:, :2], 1)
            chosen = (np.arange(n) % 3 == turn) & (group != 1 - number)
            lengths = np.where(chosen[:, None], ldexp(steps, np.full(steps.shape, grid)), lengths)
        rows[:, columns] = lengths
    return rows + 0.0


def magnitudes(draw: Draw, n: int) -> Rows:
    """Ordinary ratios in units of 1e±150 and beyond, the same or opposite for the two groups of lengths."""
    rows = around(draw, sizes(draw, *all_regimes(draw, n), units=(-1, 1)))
    far = draw.integers(n, 499, 1000), draw.integers(n, 499, 1000)
    sides = turns(n, 1, -1, 1, -1), turns(n, 1, -1, -1, 1)
    for columns, distance, side in zip(GROUPS, far, sides, strict=True):
        rows[:, columns] = ldexp(rows[:, columns], (distance * side)[:, None])
    return rows + 0.0


def hair(draw: Draw, n: int) -> Rows:
    """Exact tangencies in the waist or on the axis with one coordinate 2⁻²⁰⁰ … 2⁻¹⁰⁰⁰ in place of 0."""
    rows = _touching_on_zero(draw, n)
    zero = rows[:, 4:] == 0
    # The first zero at or after a random one of x, y, z: there is always one.
    place = draw.integers(n, 0, 2)
    index = np.arange(n)
    for _ in range(2):
        place = np.where(zero[index, place], place, (place + 1) % 3)
    rows[index, 4 + place] = draw.signs(n) * draw.log_uniform(n, -1000, -200)
    return rows


_touching_on_zero = in_turn(
    exactly(double_roots.waist_points),
    exactly(double_roots.throat_circles),
    exactly(double_roots.osculations),
    exactly(two_points_on_an_axis),
)


def _in_format(name: str, game: str, drone: str) -> Family:
    return Family(
        name=f"extreme-{name}",
        version=1,
        title=f"every intermediate of Table 2 at the ends of {name}",
        source=f"the paper, Table 2, and the limits of {name}; all numbers are 0 or normal in {name}",
        purpose="an intermediate is infinite, 0 or NaN, and NaN compares like contact: clear pairs are refused",
        game=game,
        drone=drone,
        regimes="all four",
        make=in_turn(long_ratios(FORMATS[name]), long_units(FORMATS[name]), short_coordinates(FORMATS[name])),
        extreme=True,
    )


FAMILIES = (
    _in_format(
        "float16",
        game="half-precision culling breaks at sizes of every room",
        drone="a neural accelerator's arithmetic breaks at sizes of every hangar",
    ),
    _in_format(
        "float32",
        game="between planets and ants in one engine everything reads as contact",
        drone="a tower in millimetres and a drone in kilometres: units mixed by mistake, and no warning",
    ),
    _in_format(
        "float64",
        game="a generated world runs away and takes the collision test with it",
        drone="a wrong unit or a corrupted field gives an answer where it should give none",
    ),
    Family(
        name="extreme-subnormal",
        version=1,
        title="lengths among the subnormal numbers",
        source="numbers that are subnormal in float16, float32 and float64, in turn",
        purpose="processors that flush subnormals to 0 divide by it; a valid size becomes an invalid one",
        game="the same scene works on one console and not on the other",
        drone="the flight computer flushes to 0 what the simulator on the desk does not",
        regimes="all four",
        make=subnormal,
        extreme=True,
    ),
    Family(
        name="extreme-magnitude",
        version=1,
        title="lengths of 1e±150 and beyond",
        source="ordinary ratios, each group of lengths in a unit of its own",
        purpose="the answer depends on the ratios alone, yet b² overflows or vanishes and P with it",
        game="scaled scenes answer differently from the same scenes unscaled",
        drone="a map in other units answers differently from the same map in metres",
        regimes="all four",
        make=magnitudes,
        extreme=True,
    ),
    Family(
        name="extreme-hair",
        version=1,
        title="tangencies missed by a coordinate of 1e-60 to 1e-300",
        source="exact tangencies of the family tangent with a coordinate that is not quite 0",
        purpose="the square of that coordinate decides and is lost in every sum; no λ in floats proves these answers",
        game="nothing that a player would see: these rows tell exact programs from careful ones",
        drone="nothing that shows in flight: these rows tell exact programs from careful ones",
        regimes="all four",
        make=hair,
        extreme=True,
    ),
)
