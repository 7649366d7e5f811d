"""The distance of a pair whose hyperboloid ends from another answer: by changes of its numbers, and by clearance.

**Changes** of a given size: whether one is found that gives an answer, or it is proved that none does.

A pair changed by ε has α', γ', b', d', C', an axis v' and heights, each number within a relative ε of its own. Scaling
space by T = diag(α/α', α/α', γ/γ') makes the hyperboloid the given one; let δ = 2ε/(1 − ε), more than a quotient of two
such numbers is off. Then heights and the centre's coordinates are off by δ of themselves. With ‖V‖ = √(VᵀMV) and
K = max(b, d)/min(b, d),

- the axis turns by less than 1.01 ε, so that ‖RV‖ ≤ (1 + 1.01 ε K)‖V‖, and ‖TV‖ ≤ (1 + 1.02 ε K)‖V‖ for ε ≤ 0.01;
  where the axis is vertical it does not turn and T keeps the directions of the spheroid's axes, so that K may be 1;
- the semi-axes differ by a factor between 1 − ε and 1 + ε, and ‖TC' − C‖ ≤ δ Σ |C_i| √M_ii.

So the changed spheroid lies in the given one grown by 1 + η, and holds that shrunk by 1 − η,

    η = (1 + 1.01 ε K)(1 + 1.02 ε K)(1 + ε)/(1 − ε) − 1 + δ Σ |C_i| √M_ii.

If the grown spheroid is clear of the longest wall, every changed pair is clear. If the shrunk spheroid has contact with
the shortest wall, every changed pair has contact. For a solid body, disjoint from the longest body means always
disjoint, and inside the shortest body means always inside.

**Clearance.** 1 + clearance is the factor at which the spheroid, scaled about its centre, just touches. Scaled by more
than that it meets the wall or a disc, by less it does not: that is decided exactly. least.py gives a guess of the
factor; if it cannot, bisection of exponents and then of intervals finds the factor.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import ClassVar

from hypcheck.geometry.arithmetic import exponent_of, last, power_of_two, root_of, rounded
from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth import exact, least
from hypcheck.truth.exact import Decision

_LARGEST = Fraction(1, 100)
_LEAST_OCTAVE = -1100
_BITS = 24


@dataclass(frozen=True, slots=True)
class EndedFlip:
    """A pair and an answer that its changes should give: as changes.Flip, for hyperboloids that end."""

    pair: Pair
    truth: Position
    answer: Position
    sharp: ClassVar[bool] = False

    @property
    def free(self) -> bool:
        """Whether the answer is as right as the truth: a centre at an open wall's end height belongs to both sides."""
        pair, sides = self.pair, {self.truth, self.answer}
        return not pair.solid and Position.CONTACT not in sides and pair.z in (pair.z_min, pair.z_max)

    def estimate(self) -> Fraction:
        """Return a power of two that is not excluded, though its half is; or the least power that is tested."""
        return power_of_two(1 + last(lambda exponent: self.excluded(power_of_two(exponent)), _LEAST_OCTAVE, 0))

    def excluded(self, change: Fraction, cuts: int = 0) -> bool:  # noqa: ARG002 - as changes.Flip has it
        """Decide whether it is proved that no change up to this size gives the answer; False is undecided."""
        if change > _LARGEST:
            return False
        off, growth = 2 * change / (1 - change), self._growth(change)
        if self.answer is Position.CONTACT:
            if not self.pair.solid:
                return self._position(1 + growth, off) is not Position.CONTACT
            outside = self._position(1 + growth, off) is Position.EXTERIOR
            return outside or self._position(1 + growth, -off) is Position.INTERIOR
        if self.pair.solid:
            if self.answer is Position.EXTERIOR:
                return self._position(1 - growth, -off) is not Position.EXTERIOR
            return self._position(1 - growth, off) is not Position.INTERIOR
        return self._sure_side(off) not in (None, self.answer) or self._position(1 - growth, -off) is Position.CONTACT

    def reached(self, change: Fraction) -> bool:
        """Decide whether a change of that size is found that gives the answer."""
        return any(exact.position(Lengths.of(row)) is self.answer for row in self._changed(change))

    def _changed(self, change: Fraction) -> Iterator[tuple[Fraction | float, ...]]:
        """Yield the pair with every number changed by that much, in many combinations of directions."""
        pair = self.pair
        size = 1 + change if self.answer is Position.CONTACT else 1 - change
        for a, g, r, h, low, high in product((1 + change, 1 - change), repeat=6):
            ends = (_times(pair.z_min, low), _times(pair.z_max, high))
            if ends[0] < ends[1]:
                yield (
                    *(
                        Fraction(pair.alpha) * a,
                        Fraction(pair.gamma) * g,
                        Fraction(pair.b) * size,
                        Fraction(pair.d) * size,
                    ),
                    *(Fraction(pair.x) * r, Fraction(pair.y) * r, Fraction(pair.z) * h),
                    *(*pair.axis, *ends, pair.solid),
                )

    def _growth(self, change: Fraction) -> Fraction:
        """Return η of the module's docstring for ε = `change`, rounded up."""
        pair = self.pair
        b, d = Fraction(pair.b), Fraction(pair.d)
        v2 = sum((Fraction(part) ** 2 for part in pair.axis), Fraction(0))
        upright = pair.axis_x == pair.axis_y == 0
        K = Fraction(1) if upright or b == d else max(b, d) / min(b, d)
        moved = Fraction(0)
        for part, along in zip((pair.x, pair.y, pair.z), pair.axis, strict=True):
            square = 1 / b**2 + (1 / d**2 - 1 / b**2) * Fraction(along) ** 2 / v2
            moved += abs(Fraction(part)) * root_of(square, _BITS, upward=True)
        turned = (1 + Fraction(101, 100) * change * K) * (1 + Fraction(102, 100) * change * K)
        eta = turned * (1 + change) / (1 - change) - 1 + 2 * change / (1 - change) * moved
        return rounded(eta, _BITS) * Fraction(1001, 1000) if eta else eta

    def _position(self, factor: Fraction, longer: Fraction) -> Position | None:
        """Return the position of the spheroid times `factor` beside a wall longer by `longer`; None if one vanishes."""
        pair = self.pair
        low = _times(pair.z_min, 1 + longer if pair.z_min < 0 else 1 - longer)
        high = _times(pair.z_max, 1 + longer if pair.z_max > 0 else 1 - longer)
        return _scaled_position(pair, factor, (low, high)) if factor > 0 and low < high else None

    def _sure_side(self, off: Fraction) -> Position | None:
        """Return the side of the centre after every relative change up to `off`; None if it can be on both sides."""
        pair = self.pair
        x, y, z = (Fraction(part) for part in (pair.x, pair.y, pair.z))
        outward = (x * x + y * y) / Fraction(pair.alpha) ** 2
        along = (z / Fraction(pair.gamma)) ** 2
        more, less = (1 + off) ** 2, (1 - off) ** 2
        ends = [Fraction(end) for end in (pair.z_min, pair.z_max) if math.isfinite(end)]
        apart = [abs(z - end) > off * (abs(z) + abs(end)) for end in ends]
        between = pair.z_min < z < pair.z_max
        if not between and any(
            room and (z < end) == (end == pair.z_min) for room, end in zip(apart, ends, strict=True)
        ):
            return Position.EXTERIOR
        if outward * less > along * more + 1:
            return Position.EXTERIOR
        return Position.INTERIOR if between and all(apart) and outward * more <= along * less + 1 else None


def _scaled_position(pair: Pair, factor: Fraction, ends: Sequence[float | Fraction]) -> Position:
    """Return the position of the spheroid times `factor` beside a wall with these ends."""
    b, d = factor * Fraction(pair.b), factor * Fraction(pair.d)
    row = (pair.alpha, pair.gamma, b, d, pair.x, pair.y, pair.z, *pair.axis, *ends, pair.solid)
    return exact.position(Lengths.of(row))


def _times(height: float, factor: Fraction) -> float | Fraction:
    """Multiply a height by a factor; an infinite one stays as it is."""
    return Fraction(height) * factor if math.isfinite(height) else height


_GUESSED, _NARROW_BITS = 40, 56
_WIDTH = 2.0**-14
"""The width of the guess: below it, to guess better takes longer than to halve the interval."""
_FARTHEST = 2200


def clearance(pair: Pair, decision: Decision) -> float:
    """Return the clearance in radii, within 2⁻⁵⁴ of 1 + clearance; 0 for a touch, −1 for a centre on the wall."""
    low, high = enclosure(pair, decision)
    try:
        return float((low + high) / 2)
    except OverflowError:
        return math.inf


def enclosure(pair: Pair, decision: Decision) -> tuple[Fraction, Fraction]:
    """Return bounds of the clearance, at most 2⁻⁵⁶ of 1 + clearance apart; for a clear pair none is < 0."""
    if decision.tangent:
        return Fraction(0), Fraction(0)
    low, high = _bracket(pair)
    if low < 1 < high:  # the spheroid itself is decided
        low, high = (low, Fraction(1)) if decision.position is Position.CONTACT else (Fraction(1), high)
    while (high - low) * 2**_NARROW_BITS > high:
        unit = power_of_two(exponent_of(high - low) - 3)
        middle = round((low + high) / 2 / unit) * unit  # exact decisions about short numbers are quick
        low, high = (low, middle) if _meets(pair, middle) else (middle, high)
    return low - 1, high - 1


def _bracket(pair: Pair) -> tuple[Fraction, Fraction]:
    """Find two factors: the spheroid scaled by the first is clear, scaled by the second it is in contact.

    Both are 0 if the centre is on the border.
    """
    guess = least.to_border(pair, width=_WIDTH)
    if math.isfinite(guess.upper) and guess.lower > 0:
        loose = Fraction(1, 2**_GUESSED)
        low = rounded(Fraction(guess.lower) * (1 - loose), _NARROW_BITS)
        high = rounded(Fraction(guess.upper) * (1 + loose), _NARROW_BITS)
        if not _meets(pair, low) and _meets(pair, high):
            return low, high
    if _meets(pair, power_of_two(-_FARTHEST)):
        return Fraction(0), Fraction(0)  # the centre lies on the border
    low = power_of_two(last(lambda exponent: not _meets(pair, power_of_two(exponent)), -_FARTHEST, _FARTHEST))
    return low, 2 * low


def _meets(pair: Pair, factor: Fraction) -> bool:
    """Decide whether the spheroid times `factor` meets the wall or a disc."""
    return _scaled_position(pair, factor, (pair.z_min, pair.z_max)) is Position.CONTACT
