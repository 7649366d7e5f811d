"""How far an answer is from being right: the least relative change of the inputs that makes it right.

The exterior positions are an up-set: a pair stays exterior when α falls, γ grows, b or d falls, |x| or |y| grows, |z|
falls; the interior ones likewise with α, γ, x, y, z the other way round (docs/mathematics.md, "Monotone in every
input"). So among all relative changes of at most ε the best for a target is one known corner of the box, and the
distance is found by bisection on exact decisions: nothing is linearised and nothing is sampled.
"""

from __future__ import annotations

import math
from fractions import Fraction

from hypcheck.pairs import Lengths, Position
from hypcheck.truth import exact
from hypcheck.truth.exact import Decision


def corner(lengths: Lengths, change: Fraction, toward: Position) -> Lengths:
    """The corner of the box of relative changes up to `change` that is nearest to `toward`; farthest, if that is < 0.

    |change| < 1; `toward` is EXTERIOR or INTERIOR. Lengths are scaled by the denominator of `change`, which leaves the
    ratios alone.
    """
    grown, shrunk = change.denominator + change.numerator, change.denominator - change.numerator
    wide, tall = (shrunk, grown) if toward is Position.EXTERIOR else (grown, shrunk)
    return Lengths(
        alpha=lengths.alpha * wide,
        b=lengths.b * shrunk,
        x=lengths.x * tall,
        y=lengths.y * tall,
        gamma=lengths.gamma * tall,
        d=lengths.d * shrunk,
        z=lengths.z * wide,
    )


def makes_right(lengths: Lengths, truth: Position, answer: Position, change: Fraction) -> bool:
    """Whether a relative change of at most `change` (< 1) of each input can make the wrong `answer` right."""
    if answer is not Position.CONTACT:
        return exact.position(corner(lengths, change, answer)) is answer
    # "Equals contact" is not monotone (a corner can pass right through), "is no longer the truth" is. From exterior
    # the corner opposite to the exterior one has α, b, d and z grown, γ, x and y shrunk.
    return exact.position(_away(lengths, change, truth)) is not truth


def _away(lengths: Lengths, change: Fraction, truth: Position) -> Lengths:
    """The corner farthest from `truth`: the box's other end, with every change reversed."""
    return corner(lengths, -change, truth)


def backward_error(lengths: Lengths, truth: Decision, answer: Position, digits: int = 4) -> float:
    """The infimum of the relative changes that make `answer` right, rounded up to `digits` significant digits.

    0 when the answer is right, or the limit of right answers (`truth` is a tangency from that side); inf when no
    change up to 1 is enough, which only the answer "exterior" for a centre on the axis can be.
    """
    octave = flip_exponent(lengths, truth, answer)
    if not math.isfinite(octave):
        return 0.0 if octave < 0 else math.inf
    low, high = _power_of_two(int(octave)), _power_of_two(int(octave) + 1)
    for _ in range(math.ceil(digits * math.log2(10))):
        middle = (low + high) / 2
        if makes_right(lengths, truth.position, answer, middle):
            high = middle
        else:
            low = middle
    return float(high) or math.ulp(0.0)  # a distance below the least float64 is still not 0


def flip_exponent(lengths: Lengths, truth: Decision, answer: Position, guess: int = -10) -> float:
    """floor(log2) of the backward error: −inf for 0, inf for inf; cheap where `guess` is near.

    The exponent k returned has 2^k ≤ backward error ≤ 2^(k+1): exact decisions at both ends say so.
    """
    if answer is truth.position or truth.kind.limit_of is answer:
        return -math.inf
    if answer is Position.EXTERIOR and lengths.x == lengths.y == 0:
        return math.inf

    def reached(exponent: int) -> bool:
        # At 2^0 the sizes vanish; every flip but the one excluded above happens before.
        return exponent >= 0 or makes_right(lengths, truth.position, answer, _power_of_two(exponent))

    step, low = 1, min(guess, -1)
    while reached(low):  # terminates: the distance is not 0
        low -= step
        step *= 2
    high = min(low + step, 0)
    while not reached(high):
        low, high, step = high, min(high + 2 * step, 0), 2 * step
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if reached(middle) else (middle, high)
    return low


def _power_of_two(exponent: int) -> Fraction:
    return Fraction(1 << exponent) if exponent >= 0 else Fraction(1, 1 << -exponent)
