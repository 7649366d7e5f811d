"""Lines: a fixed λ is a proof of clear for every centre beyond it, at the price of two products and a comparison.

With R = x² + y² and Z = z², for λ in (0, B)

    P/(A+λ) − Q/(B−λ) > 1 + 1/λ   is   R > b² (A+λ)(1 + 1/λ) + (b²/d²) (A+λ)/(B−λ) Z   and proves exterior,

and for μ in (0, A), λ = −μ,

    Q/(B+μ) − P/(A−μ) > 1/μ − 1   is   R < b² (A−μ)(1 − 1/μ) + (b²/d²) (A−μ)/(B+μ) Z   and proves interior

(docs/mathematics.md, "A line is a proof"). The constants are exact rationals, moved by MARGIN to the safe side and
rounded to that side once.

Why MARGIN covers. Both sides are sums of positive terms (a negative intercept stands on the other side, as a lift).
x, y and z may carry one rounding each, on entry; the square doubles it and adds one, a sum or product adds one: R and Z
carry at most 4 and 3 factors (1+δ), |δ| ≤ u, R + lift 5, and intercept + slope·Z at most 5. The sides therefore differ
from what the constants say by less than (1+u)^5/(1−u)^5 < 1 + 11u; MARGIN is 16u. A coordinate whose square underflows
changes a side by less than 2^least of the format, which the constants, kept above 2^(least/2), do not notice at 5u.
An overflow of R alone means far outside, one of slope·Z alone far inside, and both compare false.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from hypcheck.derivation.listing import program_of
from hypcheck.derivation.program import Program
from hypcheck.kernel.specialise.formats import Format
from hypcheck.kernel.specialise.scale import Scaled
from hypcheck.pairs import Position

MARGIN = 16
"""Units u by which the constants are moved to the safe side."""


@dataclass(frozen=True)
class Line:
    """A line of one side. The program's inputs are R, zz and the constants' names; its step `holds` is the proof."""

    side: Position
    multiplier: Fraction
    program: Program
    holds: str
    constants: dict[str, float]


def line_at(multiplier: Fraction, scaled: Scaled, form: Format, number: int) -> Line | None:
    """The line of this λ; None where its constants leave the format, or where no centre is beyond it.

    Raises ValueError for a λ that is not strictly between the poles, or is 0.
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
    inputs = ("R", "zz", *constants)
    return Line(side, multiplier, program_of(holds, inputs, _listing(side, constants, number)), holds, constants)


def _constants(side: Position, intercept: Fraction, slope: Fraction, form: Format, number: int) -> dict[str, float]:
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
    lines = [f"rise_{number} = slope_{number} * zz"]
    right, left = f"rise_{number}", "R"
    if f"intercept_{number}" in constants:
        lines.append(f"border_{number} = intercept_{number} + rise_{number}")
        right = f"border_{number}"
    if f"lift_{number}" in constants:
        lines.append(f"lifted_{number} = R + lift_{number}")
        left = f"lifted_{number}"
    lines.append(f"beyond_line_{number} = {left} {'>' if side is Position.EXTERIOR else '<'} {right}")
    return "\n".join(lines)
