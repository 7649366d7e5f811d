"""Steps along a way: from a clear time as far as one multiplier λ proves, then on with another.

For a fixed λ the spheroid is clear while a quadratic in t is positive (journey.py). The best λ of one time gives the
step, and the end of the step is the next time. Near a contact that the way runs into, each step leaves about the square
of what was left, so that a few steps enclose the first contact; a way that keeps a distance ends after a few steps as
well. Each step is proved in integers. Where a way only grazes the surface, or ends in tangency, the steps decide
nothing, and the roots of the critical polynomial must tell (swept.py).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.geometry.pair import Position
from hypcheck.truth.journey import Journey, piece, shortened
from hypcheck.truth.polynomial_roots import Polynomial, value

WIDTH_BITS = 60
"""The enclosure of a first contact is at most 2^−60 of it wide."""

MOST_STEPS = 64
SHORTEST = Fraction(1, 2**240)
"""A step below this, or so many steps, says that steps decide nothing here."""

_STEP_BITS = 40

Piece = tuple[Fraction, Fraction]
"""A multiplier, and the time up to which it proves the spheroid clear, from where the piece before ends, or from 0."""


@dataclass(frozen=True, slots=True)
class Steps:
    """Pieces of a way that begins clear, without gap from 0; `contact` is a time of contact that is no tangency.

    None where the way is clear up to 1. The first contact lies between the end of the last piece and `contact`.
    """

    pieces: tuple[Piece, ...]
    contact: Fraction | None

    @property
    def until(self) -> Fraction:
        """The time up to which the spheroid is clear."""
        return self.pieces[-1][1]


def steps(journey: Journey, width_bits: int | None = WIDTH_BITS) -> Steps | None:
    """The steps of a way that begins clear, or None where they decide nothing.

    The enclosure of the first contact is 2^−width_bits of it; as wide as it happens to be where that is None.
    """
    pencil, time = journey.pencil, Fraction(0)
    pieces: list[Piece] = []
    contact = Fraction(1) if _crosses(journey, Fraction(1)) else None
    while len(pieces) < MOST_STEPS and not _narrow(time, contact, width_bits):
        multiplier, step = _step(journey, pencil, time)
        if step is None or time + step >= 1:
            return Steps((*pieces, (multiplier, Fraction(1))), None)
        if step < SHORTEST * time:
            return None
        time += step
        pieces.append((multiplier, time))
        beyond = time + step / 2
        if beyond < (contact or 1) and _crosses(journey, beyond):
            contact = beyond
    return Steps(tuple(pieces), contact) if contact is not None and pieces else None


def _narrow(time: Fraction, contact: Fraction | None, width_bits: int | None) -> bool:
    if contact is None:
        return False
    return width_bits is None or (contact - time) * 2**width_bits <= time


def _crosses(journey: Journey, time: Fraction) -> bool:
    """Whether there is contact at a time that is no tangency."""
    return journey.position(time) is Position.CONTACT and not journey.tangent(time)


def _step(journey: Journey, pencil: Sequence[Polynomial], time: Fraction) -> tuple[Fraction, Fraction | None]:
    """A multiplier that proves the clear position at a time, and how far beyond it does; None without end.

    The first that proves it may do so barely; the next, of twice as many bits, does it as well as any.
    """
    proved = False
    for multiplier in journey.multipliers(time):
        proof = piece(pencil, multiplier)
        if proved or value(proof, time) > 0:
            if proved and value(proof, time) > 0:
                return multiplier, reach(proof, time)
            proved = True
    raise AssertionError("unreachable: the multipliers do not end")


def reach(proof: Polynomial, time: Fraction) -> Fraction | None:
    """A number below the distance to the next root of a quadratic that is positive at a time; None without one."""
    a, b, c = proof
    n, m = time.numerator, time.denominator
    here, slope, bend = (a * n + b * m) * n + c * m * m, (2 * a * n + b * m) * m, a * m * m
    inner = slope * slope - 4 * bend * here
    if inner < 0 or (slope >= 0 and bend >= 0):
        return None
    shift = max(0, 80 - inner.bit_length() // 2)
    bottom = math.isqrt(inner << 2 * shift) + 1 - (slope << shift)  # > √inner − slope
    return shortened(2 * here << shift, bottom, _STEP_BITS)
