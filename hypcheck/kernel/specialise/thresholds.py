"""At a fixed height two thresholds on R = x² + y² are all there is: exterior beyond one, interior below the other.

The exterior positions are an up-set when R grows, the interior ones when it falls (docs/mathematics.md), so each
threshold is one real number. It is found by halving an interval of exact decisions until it is narrower than a rounding
of the format, and rounded to nearest. R carries at most 4 factors (1+δ), |δ| ≤ u (x and y may be rounded on entry), the
threshold one and what is left of the interval less than one: an answer is right for x and y changed by 3u.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.kernel import integers
from hypcheck.kernel.specialise.formats import Format
from hypcheck.kernel.specialise.scale import Scaled
from hypcheck.kernel.specialise.settings import Sizes
from hypcheck.pairs import Lengths, Position

BACKWARD_BOUND = Fraction(3)

_Test = Callable[[Fraction], bool]


@dataclass(frozen=True, slots=True)
class Thresholds:
    """Exterior where R > `outer`, interior where R < `inner`; `inner` is None where no centre is interior."""

    height: float
    outer: float
    inner: float | None


def thresholds(sizes: Sizes, height: float, scaled: Scaled, form: Format) -> Thresholds:
    """The thresholds at a height. Raises OverflowError where one leaves the format."""

    def exterior(x: Fraction) -> bool:
        return _position(sizes, x, height) is Position.EXTERIOR

    def not_interior(x: Fraction) -> bool:
        return _position(sizes, x, height) is not Position.INTERIOR

    def rounded(x: Fraction) -> float:
        return form.rounded((x * scaled.radial) ** 2)

    least = Fraction(2) ** (form.least // 2) / scaled.radial
    outer = rounded(_first(exterior, Fraction(sizes[0]) + Fraction(sizes[2]), least, form))
    if not_interior(Fraction(0)):
        return Thresholds(height, outer, None)
    return Thresholds(height, outer, rounded(_first(not_interior, Fraction(sizes[0]), least, form)))


def _first(holds: _Test, start: Fraction, least: Fraction, form: Format) -> Fraction:
    """About the least x > 0 from which on it holds, within a relative u/4; it does at some x.

    Raises OverflowError where that is below `least`.
    """
    high = start
    while not holds(high):
        high *= 2
    low = high / 2
    while low and holds(low):
        if low < least:
            raise OverflowError(f"a border so near to the axis has no square in {form.name}")
        high, low = low, low / 2
    while high - low > high * form.unit / 4:
        middle = (low + high) / 2
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high


def _position(sizes: Sizes, x: Fraction, z: float) -> Position:
    """The exact position at (x, 0, z)."""
    alpha, gamma, b, d = map(Fraction, sizes)
    radial, axial = _integers(alpha, b, x), _integers(gamma, d, Fraction(z))
    return integers.position(Lengths(radial[0], radial[1], radial[2], 0, *axial))


def _integers(*values: Fraction) -> tuple[int, int, int]:
    unit = max(value.denominator for value in values)  # all are dyadic
    one, two, three = (int(value * unit) for value in values)
    return one, two, three
