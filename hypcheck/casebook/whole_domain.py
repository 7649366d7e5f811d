"""Sizes and ratios up to the ends of the ordinary ranges: everything that is asked of whoever declares no range."""

from __future__ import annotations

import numpy as np

from hypcheck.casebook.draw import Draw, Floats, Integers, ldexp, turns
from hypcheck.casebook.exactly import Mask, gather
from hypcheck.casebook.family import Family
from hypcheck.casebook.placing import Sizes, beside, offsets
from hypcheck.ranges import within
from hypcheck.rows import Rows

LENGTHS, RATIOS = 20, 27
"""Exponents of 2: semi-axes from 2⁻²⁰ to 2²⁰, ratios from 2⁻²⁷ to 2²⁷; what of them is beyond the ends is left out."""

TENS = np.asarray([1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6])
"""The powers of ten in the ordinary range, both ends among them, as a person types them."""


def whole_domain(draw: Draw, n: int) -> Rows:
    """Ratios and sizes log-uniform over the ordinary ranges, centres all around the surface or a hair off contact."""
    return gather(draw, n, _attempt)


def _attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Half of the second ratios have nothing to do with the first; the others are like it, within 2⁴ of it."""
    octave = draw.integers(n, -RATIOS, RATIOS - 1)
    other = np.where(turns(n, True, False), draw.integers(n, -RATIOS, RATIOS - 1), octave + draw.integers(n, -4, 3))
    (alpha, b), (gamma, d) = _lengths(draw, octave), _lengths(draw, other)
    size = Sizes(alpha, gamma, b, d)
    hair = draw.signs(n) * (1 + draw.signs(n) * draw.log_uniform(n, -40, -3))
    offset = np.where(turns(n, True, True, False, False), offsets(draw, n), hair)
    rows = beside(draw, size, _heights(draw, size), offset)
    return rows, within(rows)


def _lengths(draw: Draw, octave: Integers) -> tuple[Floats, Floats]:
    """Two lengths with a ratio of about 2^octave, in any unit that leaves room for both, or two powers of ten."""
    n = len(octave)
    room = 2 * LENGTHS - np.abs(octave)
    unit = np.floor(draw.unit(n) * room).astype(np.int64) - LENGTHS + np.maximum(-octave, 0)
    upper, lower = ldexp(draw.mantissas(n), octave + unit), ldexp(draw.mantissas(n), unit)
    typed = draw.integers(n, 0, 3) == 0
    first, second = (TENS[draw.integers(n, 0, len(TENS) - 1)] for _ in range(2))
    return np.where(typed, first, upper), np.where(typed, second, lower)


def _heights(draw: Draw, size: Sizes) -> Floats:
    """A quarter about the waist, a quarter within 2γ, and half aloft.

    That is where a surface narrower at its waist than the spheroid is about as wide as it, or anywhere up to 2⁸ γ.
    """
    n = len(size.b)
    share = draw.unit(n)
    aloft = np.where(size.a < 1, size.c / size.a * (0.5 + 8 * share), size.c * draw.log_uniform(n, -8, 8))
    kind = draw.integers(n, 0, 3)
    return np.asarray(np.choose(np.minimum(kind, 2), [8 * share, 2 * size.c * share, aloft]))


FAMILIES = (
    Family(
        name="whole-domain",
        version=1,
        title="sizes and ratios up to the ends of what everybody is asked",
        source="semi-axes in 1e-6 … 1e6, α/b and γ/d in 1e-8 … 1e8, some of them exactly at the ends",
        purpose="limits that were not declared, thresholds in metres, tables that end: right for common sizes alone",
        game="an ant beside a mountain, in one scene: the ant walks into it",
        drone="a map in kilometres and a sensor in micrometres are both taken at their word, and one of them is lost",
        regimes="all four",
        make=whole_domain,
    ),
)
