"""The first stages of a specialised kernel: lines of fixed λ, the centre's side, thresholds at a fixed height.

All of them work on R = x² + y² and Z = z² (`zz` in programs) of the centre (x, y, z), in the kernel's units. A =
(α/b)², B = (γ/d)², P = R/b² and Q = Z/d². λ is the argument of the dual function, whose poles are −A and B. u is the
unit roundoff of the format, and δ the relative error of one operation.

The centre's side is all that is left to decide about a clear spheroid, and it is enough for the answer "no" to a
one-sided question. The centre is outside where R > α² + (α²/γ²) Z. Each side of this comparison carries at most 5
factors (1+δ), |δ| ≤ u, so the answer is right for inputs changed by 5u at most; the centre of a clear spheroid is a
whole radius from the surface.

Lines. A fixed λ proves "clear" for every centre beyond its line, at the price of two products and a comparison. For λ
in (0, B)

    P/(A+λ) − Q/(B−λ) > 1 + 1/λ   is   R > b² (A+λ)(1 + 1/λ) + (b²/d²) (A+λ)/(B−λ) Z   and proves exterior,

and for μ in (0, A), λ = −μ,

    Q/(B+μ) − P/(A−μ) > 1/μ − 1   is   R < b² (A−μ)(1 − 1/μ) + (b²/d²) (A−μ)/(B+μ) Z   and proves interior

(docs/mathematics.md, "A line is a proof"). The constants are exact rationals, moved by MARGIN to the safe side and
rounded to that side once. A setting gets the lines that decide most centres of its region, and only lines that decide
enough of them (WORTH).

Why MARGIN is enough. Both sides are sums of positive terms (a negative intercept stands on the other side, as a lift).
x, y and z may carry one rounding each, on entry; the square doubles it and adds one, a sum or product adds one: R and Z
carry at most 4 and 3 factors (1+δ), |δ| ≤ u, R + lift 5, and intercept + slope·Z at most 5. The sides therefore differ
from what the constants say by less than (1+u)^5/(1−u)^5 < 1 + 11u; MARGIN is 16u. A coordinate whose square underflows
changes a side by less than 2^least of the format, which the constants, kept above 2^(least/2), do not notice at 5u.
An overflow of R alone means far outside, one of slope·Z alone far inside, and both compare false. Where Z itself
overflows, slope·Z need not be larger than R if the slope is below 1: such a line asks that Z is finite.

Thresholds. At a fixed height two thresholds on R are enough: exterior beyond one, interior below the other. The
exterior positions are an up-set when R grows, the interior ones when it falls (docs/mathematics.md), so each threshold
is one real number. It is found by halving an interval of exact decisions until it is narrower than a rounding of the
format, and rounded to nearest. R carries at most 4 factors (1+δ), |δ| ≤ u (x and y may be rounded on entry), the
threshold one and what is left of the interval less than one: an answer is right for x and y changed by 3u.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

import numpy as np

from hypcheck.derivation.evaluation import outputs
from hypcheck.derivation.float_arithmetic import FloatFormat, float_arithmetic
from hypcheck.derivation.program import Program, program_of
from hypcheck.geometry.pair import Lengths, Position, Sizes
from hypcheck.geometry.rows import Floats, Mask
from hypcheck.kernel import integers
from hypcheck.kernel.specialise.settings import ScaledSetting

RADIAL, AXIAL = "radial_unit", "axial_unit"
"""Names of the powers of two by which a kernel multiplies x and y, and z, where it scales lengths."""

_ONE = Fraction(1)
UNSCALED = ScaledSetting(_ONE, _ONE, _ONE, _ONE, _ONE, _ONE)
"""A setting that needs no scaling. Its `entry` rounds as often as that of any other: powers of two round nothing."""


def entry(scaled: ScaledSetting) -> tuple[Program, dict[str, float]]:
    """Return the program from x, y, z to R, zz and height = |z|, and the constants that it also reads."""
    constants = {
        name: float(value) for name, value in ((RADIAL, scaled.radial), (AXIAL, scaled.axial)) if value != _ONE
    }
    lines = []
    across, up = ("x", "y"), "z"
    if RADIAL in constants:
        lines += [f"x_scaled = x * {RADIAL}", f"y_scaled = y * {RADIAL}"]
        across = ("x_scaled", "y_scaled")
    if AXIAL in constants:
        lines.append(f"z_scaled = z * {AXIAL}")
        up = "z_scaled"
    lines += [f"xx = {across[0]} * {across[0]}", f"yy = {across[1]} * {across[1]}", "R = xx + yy"]
    lines += [f"zz = {up} * {up}", f"height = abs {up}"]
    return program_of("entry", ("x", "y", "z", *constants), "\n".join(lines)), constants


CENTRE = program_of(
    "centre",
    ("R", "zz", "waist", "opening"),
    """
    spread = opening * zz
    surface = waist + spread
    outside = R > surface
    """,
)
"""The program that computes `outside`: whether R is greater than that of the hyperboloid at this height."""


def centre_constants(scaled: ScaledSetting, form: FloatFormat) -> dict[str, float]:
    """Return α² and α²/γ² in the kernel's units. Raises OverflowError if one leaves the format."""
    exact: dict[str, Fraction] = {
        "waist": scaled.A * scaled.bb,
        "opening": scaled.A * scaled.bb / (scaled.B * scaled.dd),
    }
    return {name: form.rounded(value) for name, value in exact.items()}


MARGIN = 16
"""By so many units u the constants of a line are moved to the safe side."""


@dataclass(frozen=True)
class ProvedLine:
    """A line that proves the position `side`: where the step `holds` of the program is true.

    `multiplier` is λ. The inputs of `program` are R, zz and the names of the constants.
    """

    side: Position
    multiplier: Fraction
    program: Program
    holds: str
    constants: dict[str, float]


def line_at(multiplier: Fraction, scaled: ScaledSetting, form: FloatFormat, number: int) -> ProvedLine | None:
    """Return the line of this λ; None if its constants leave the format, or if no centre is beyond it.

    `number` ends the names of its steps and constants. Raises ValueError for a λ that is not strictly between the
    poles, or is 0.
    """
    if not -scaled.A < multiplier < scaled.B or multiplier == 0:
        raise ValueError(f"λ = {multiplier} is not in (−A, 0) or (0, B)")
    side = Position.EXTERIOR if multiplier > 0 else Position.INTERIOR
    to_a, to_b = scaled.A + multiplier, scaled.B - multiplier
    intercept = scaled.bb * to_a * (1 + 1 / multiplier)
    slope = scaled.bb / scaled.dd * to_a / to_b
    try:
        constants = _constants(side, intercept, slope, form, number)
    except OverflowError:
        return None
    if not all(2.0 ** (form.least / 2) < value < 2.0 ** (form.greatest / 2) for value in constants.values()):
        return None
    holds = f"beyond_line_{number}"
    if side is Position.INTERIOR and slope < 1:
        constants[f"most_{number}"] = form.rounded(Fraction(2) ** form.greatest * (1 - form.unit))
    inputs = ("R", "zz", *constants)
    return ProvedLine(side, multiplier, program_of(holds, inputs, _listing(side, constants, number)), holds, constants)


def _constants(
    side: Position, intercept: Fraction, slope: Fraction, form: FloatFormat, number: int
) -> dict[str, float]:
    """Return the intercept, or the lift, and the slope of a line, moved to the safe side and rounded once."""
    more, less = 1 + MARGIN * form.unit, 1 - MARGIN * form.unit
    if side is Position.EXTERIOR:
        values = {"intercept": form.rounded(intercept * more, "up"), "slope": form.rounded(slope * more, "up")}
    elif intercept > 0:
        values = {"intercept": form.rounded(intercept * less, "down"), "slope": form.rounded(slope * less, "down")}
    elif intercept < 0:
        values = {"lift": form.rounded(-intercept * more, "up"), "slope": form.rounded(slope * less, "down")}
    else:
        values = {"slope": form.rounded(slope * less, "down")}
    return {f"{name}_{number}": value for name, value in values.items()}


def _listing(side: Position, constants: dict[str, float], number: int) -> str:
    """Return the steps of a line's program, for these constants."""
    lines = [f"rise_{number} = slope_{number} * zz"]
    right, left = f"rise_{number}", "R"
    if f"intercept_{number}" in constants:
        lines.append(f"border_{number} = intercept_{number} + rise_{number}")
        right = f"border_{number}"
    if f"lift_{number}" in constants:
        lines.append(f"lifted_{number} = R + lift_{number}")
        left = f"lifted_{number}"
    sign = ">" if side is Position.EXTERIOR else "<"
    if f"most_{number}" in constants:
        lines += [f"below_{number} = {left} {sign} {right}", f"is_finite_{number} = zz <= most_{number}"]
        lines.append(f"beyond_line_{number} = below_{number} and is_finite_{number}")
    else:
        lines.append(f"beyond_line_{number} = {left} {sign} {right}")
    return "\n".join(lines)


WORTH = 0.05
"""The least share of all centres that a line must decide, without those of earlier lines, to be worth its cost."""

MOST_LINES = 2
"""The greatest number of lines for one side."""


def lines_for(
    side: Position, scaled: ScaledSetting, form: FloatFormat, R: Floats, zz: Floats, first_number: int
) -> tuple[tuple[ProvedLine, ...], Mask]:
    """Choose the lines of a side for centres with these R and zz, (n,) each.

    Returns the lines, numbered from `first_number`, and a mask of the centres that they decide.
    """
    decided = np.zeros(len(R), dtype=bool)
    chosen: list[ProvedLine] = []
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


def beyond(line: ProvedLine, form: FloatFormat, R: Floats, zz: Floats) -> Mask:
    """Return a mask of the centres that the line decides, computed as in the kernel."""
    inputs = {"R": R, "zz": zz, **line.constants}
    (mask,) = outputs(line.program, float_arithmetic(form.name), inputs, (line.holds,))
    return np.asarray(mask, dtype=bool)


def _candidates(side: Position, scaled: ScaledSetting, form: FloatFormat, number: int) -> Iterator[ProvedLine]:
    """Yield the lines for λ, or −λ, around √A: √A times powers of two, but at most half of the pole."""
    sign, pole = (1, scaled.B) if side is Position.EXTERIOR else (-1, scaled.A)
    root = _few_bits(Fraction(isqrt(int(scaled.A * 2**64)) or 1, 2**32))
    multipliers = {min(root * Fraction(2) ** power, _few_bits(pole / 2)) for power in range(-6, 7)}
    for multiplier in sorted(multipliers):
        line = line_at(sign * multiplier, scaled, form, number)
        if line is not None:
            yield line


def _few_bits(value: Fraction) -> Fraction:
    """Round a value down to four significant bits, so that a person can read it."""
    exponent = value.numerator.bit_length() - value.denominator.bit_length() - 3
    step = Fraction(2) ** exponent
    return value // step * step


BACKWARD_BOUND = Fraction(3)
"""By so many units u x and y may have to change for the answer of a threshold to be right (Thresholds, above)."""

CENTRE_BOUND = Fraction(5)
"""The same for the answer of the centre's side."""

_Test = Callable[[Fraction], bool]
"""A condition on x."""


@dataclass(frozen=True, slots=True)
class Thresholds:
    """The limits of R at one height: exterior where R > `outer`, interior where R < `inner`, else contact.

    `inner` is None if no centre at this height is interior.
    """

    height: float
    outer: float
    inner: float | None


def thresholds(sizes: Sizes, height: float, scaled: ScaledSetting, form: FloatFormat) -> Thresholds:
    """Compute the thresholds at a height. Raises OverflowError if one leaves the format."""

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


def _first(holds: _Test, start: Fraction, least: Fraction, form: FloatFormat) -> Fraction:
    """Find the least x > 0 from which on the condition holds, within a relative u/4; it must hold for large x.

    Raises OverflowError if that x is below `least`.
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
    """Return the exact position of the spheroid with its centre at (x, 0, z)."""
    alpha, gamma, b, d = sizes
    return integers.upright_position(Lengths.of((alpha, gamma, b, d, x, 0.0, z)))
