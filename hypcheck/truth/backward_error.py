"""The backward error of an answer about a pair: the least relative change of the numbers that makes it right.

The backward error is the infimum of the ε for which changing each number by a relative ε at most makes the answer
right. changes.py decides whether one ε is enough. For an upright pair one exact decision suffices, so that bisection
finds the error itself: nothing is linearised and nothing is sampled. For any other pair some changes are proved to be
enough, and some sizes of change are proved not to be; for sizes between them neither is proved: the error is bracketed.
Callers need not distinguish the two cases.

Runs judge many answers, and most wrong answers have large errors: `lower_ends` proves lower bounds of many errors at
once, in float64 (float_boxes.py), and `quick_bracket` begins with them.

`flip_exponents` gives, for many rows, floor(log2) of the least relative change that leads to another position. For
upright rows it uses exact positions of changed float64 rows: positions are monotone in every number (changes.py), so
that one known corner of the box of changes is best. Floats do not hold the corner of the box of relative changes 2^k.
So two corners are tested, one a little inside of that box and one a little outside: a flip at the inner corner implies
a flip at 2^k, and no flip at the outer corner implies none at 2^k, since flips are monotone in every change. These
changes are 2^k (1 ∓ 2⁻⁸); each product is rounded once, by 2⁻⁵³ of itself at most, so that for k ≥ LEAST every change
stays on its side of 2^k. Exact numbers decide the rows that flip only between the two corners, one row in a hundred,
and rows with a distance below 2^LEAST.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.arithmetic import octave, power_of_two, rounded, rounded_toward
from hypcheck.geometry.pair import COLUMNS, TILTED_COLUMNS, Pair, Position
from hypcheck.geometry.rows import Floats, Mask, Positions, Rows, upright_mask
from hypcheck.truth import exact, float_boxes, float_filter
from hypcheck.truth.box_proofs import Goal
from hypcheck.truth.changes import BITS, CUTS, Flip, UprightFlip, goal_of
from hypcheck.truth.ended_error import EndedFlip
from hypcheck.truth.exact import Decision

AnyFlip = Flip | EndedFlip
"""The flip of a pair of any kind."""


@dataclass(frozen=True, slots=True)
class Bracket:
    """Two proved ends of a backward error, inf twice where no change up to 1 is enough."""

    lower: float
    upper: float


DIGITS = 4
"""Significant digits of the backward error of an answer about an upright pair, rounded up."""

RATIO = Fraction(5, 4)
"""A bracket is refined until its upper end is at most this many times the lower."""

STEPS = 8
"""How often a bracket that first derivatives did not make narrow enough is halved."""


def _flip(pair: Pair, truth: Decision, answer: Position) -> AnyFlip | float:
    """Return the change that makes an answer right; or the backward error if it is known directly: 0 or inf.

    The error is 0 for a right answer and for the limit of right answers (the truth is a tangency from that side). It is
    inf for the answer "exterior" about a centre on the hyperboloid's axis: no relative change up to 1 brings this
    centre outside.
    """
    if answer in (truth.position, truth.limit_of):
        return 0.0
    if pair.has_ends:
        ended = EndedFlip(pair, truth.position, answer)
        return 0.0 if ended.free else ended
    goal = goal_of(truth.position, answer)
    on_axis = pair.x == pair.y == 0
    if on_axis and goal == Goal(Position.EXTERIOR, leave=False):
        return math.inf
    return UprightFlip(pair, goal) if pair.is_upright else Flip(pair, goal)


def tolerated(pair: Pair, truth: Decision, answers: Iterable[Position], change: Fraction) -> bool | None:
    """Decide whether a relative change up to `change` makes one of the wrong answers right; None if undecided."""
    if change == 0:
        return False
    flips = [_flip(pair, truth, answer) for answer in answers]
    if 0.0 in flips:
        return True
    searched = [flip for flip in flips if not isinstance(flip, float)]
    if change >= 1:
        return bool(searched)
    if all(flip.sharp for flip in searched):
        return any(flip.reached(change) for flip in searched)
    if all(flip.excluded(change, cuts=0) for flip in searched):  # most wrong answers have large errors
        return False
    if any(flip.reached(change) for flip in searched):
        return True
    return False if all(flip.excluded(change, 2 * CUTS) for flip in searched) else None


def bracket(pair: Pair, truth: Decision, answer: Position, cuts: int = CUTS, steps: int = STEPS) -> Bracket:
    """Return a bracket of the backward error of an answer to a valid pair; inf if no change up to 1 is enough.

    The upper end is at most RATIO times the lower if first derivatives describe the changes well (small changes of the
    surfaces), and often in other cases; it is 1 if no smaller change was found. Fewer `cuts` of a box and fewer `steps`
    of halving take less time.
    """
    flip = _flip(pair, truth, answer)
    if isinstance(flip, float):
        return Bracket(flip, flip)
    high = _reached_end(flip)
    low, high = _excluded_end(flip, high)
    if low:
        low, high = _narrowed(flip, cuts, steps, (low, high))
    return Bracket(rounded_toward(low, -math.inf), rounded_toward(high, math.inf))


def quick_bracket(pair: Pair, truth: Decision, answer: Position) -> Bracket:
    """Bracket the error as `bracket` does, in less time: for an upright pair both ends are the error to DIGITS digits.

    For other pairs it is narrower if the error is large: float64 proves the lower end if it can.
    """
    flip = _flip(pair, truth, answer)
    if isinstance(flip, float):
        return Bracket(flip, flip)
    if isinstance(flip, EndedFlip):
        return bracket(pair, truth, answer)
    if flip.sharp:
        error = _bisected(flip)
        return Bracket(error, error)
    low = lower_ends([pair], [truth], [[answer]])[0] or lower_end(pair, truth, answer)
    if low in (0, math.inf):
        return bracket(pair, truth, answer)
    high = flip.reached_above(Fraction(low), RATIO)
    steps = low * np.exp2(np.arange(1, 1 + int(8 * math.log2(high / Fraction(low)))) / 8)
    steps = steps[(steps < 1) & (steps >= 2.0**float_boxes.LEAST)]
    if high > RATIO * Fraction(low) and len(steps):
        rows = np.array([[*pair.row[:7], *pair.axis]] * len(steps))
        proved = float_boxes.excluded(rows, [flip.goal] * len(steps), steps, cuts=_QUICK_CUTS)
        low = float(steps[proved].max(initial=low))
    return Bracket(low, rounded_toward(high, math.inf))


_QUICK_CUTS = 5


def lower_end(pair: Pair, truth: Decision, answer: Position) -> float:
    """Return a lower bound of the error, proved with 256 bits, which a small error needs; 0 if none is found.

    For an upright pair the error to DIGITS digits.
    """
    flip = _flip(pair, truth, answer)
    if isinstance(flip, float):
        return flip
    if flip.sharp:
        return _bisected(flip)
    return rounded_toward(_excluded_end(flip, flip.estimate())[0], -math.inf)


def lower_ends(pairs: Sequence[Pair], truths: Sequence[Decision], answers: Sequence[Sequence[Position]]) -> list[float]:
    """Return a lower bound, proved in float64, of the least error of several answers to each pair; 0 if none is found.

    No bound is searched for an upright pair, for which `tolerated` takes little time, or if the hyperboloid ends. The
    bound is inf if no change up to 1 is enough.
    """
    ends = [math.inf] * len(pairs)
    owners, goals = [], []
    for place, (pair, truth, some) in enumerate(zip(pairs, truths, answers, strict=True)):
        if pair.is_upright or pair.has_ends:
            ends[place] = 0.0
            continue
        for flip in (_flip(pair, truth, answer) for answer in some):
            if isinstance(flip, Flip):
                owners.append(place)
                goals.append(flip.goal)
            elif isinstance(flip, float):
                ends[place] = min(ends[place], flip)
    for place, end in zip(owners, float_boxes.lower_ends(_tens([pairs[k] for k in owners]), goals), strict=True):
        ends[place] = min(ends[place], float(end))
    return ends


def _tens(pairs: Sequence[Pair]) -> Rows:
    """Return the pairs' ten numbers, (n, 10)."""
    return np.array([(*pair.row[:7], *pair.axis) for pair in pairs]).reshape(len(pairs), len(TILTED_COLUMNS))


def estimate(pair: Pair, truth: Decision, answer: Position) -> float:
    """Estimate the backward error fast, to rank answers; for an upright pair it is the error to DIGITS digits.

    For other pairs it is an estimate from derivatives at the row, without a proof.
    """
    flip = _flip(pair, truth, answer)
    if isinstance(flip, float):
        return flip
    return _bisected(flip) if flip.sharp else float(flip.estimate())


def exponent(pair: Pair, truth: Decision, answer: Position) -> float:
    """Return log2 of the estimated backward error; for an upright pair floor(log2) of the exact one, which is fast.

    −inf for 0, inf for inf.
    """
    flip = _flip(pair, truth, answer)
    if not isinstance(flip, float) and flip.sharp:
        return octave(flip.reached)
    error = flip if isinstance(flip, float) else float(flip.estimate())
    return math.log2(error) if error else -math.inf


def excluded_at_once(pairs: Sequence[Pair], goals: Sequence[Goal], changes: Sequence[float]) -> list[bool]:
    """Mark the pairs for which float64 proves that no change up to `changes` attains a goal; False is undecided."""
    held = float_boxes.excluded(_tens(pairs), goals, np.array(changes))
    return [bool(proved) and not pair.is_upright for proved, pair in zip(held, pairs, strict=True)]


def is_bracket(
    pair: Pair,
    truth: Decision,
    answer: Position,
    ends: Bracket,
    cuts: int = CUTS,
    *,
    lower_holds: bool = False,
) -> bool:
    """Decide whether proofs are found that the backward error of an answer lies between these ends.

    `lower_holds` says that the lower end is already proved, for example by excluded_at_once.
    """
    flip = _flip(pair, truth, answer)
    if isinstance(flip, float):
        return ends == Bracket(flip, flip)
    low, high = ends.lower, ends.upper
    if not 0 <= low <= high <= 1 or high == 0:
        return False
    below = lower_holds or low == 0 or (low < 1 and flip.excluded(Fraction(low), cuts))
    return below and (high == 1 or flip.reached(Fraction(high)))


def _bisected(flip: AnyFlip) -> float:
    """Return the error of a sharp flip, rounded up to DIGITS significant digits."""
    low = power_of_two(octave(flip.reached))  # the distance is not 0
    high = 2 * low
    for _ in range(math.ceil(DIGITS * math.log2(10))):
        middle = (low + high) / 2
        low, high = (low, middle) if flip.reached(middle) else (middle, high)
    return float(high) or math.ulp(0.0)  # a distance below the least float64 is still not 0


def _reached_end(flip: AnyFlip) -> Fraction:
    """Return a change that reaches the goal, at most 9/8 times a change that was not found to reach it."""
    missed = rounded(flip.estimate(), BITS)
    high, step = rounded(missed * Fraction(11, 10), BITS), 2
    while high < 1 and not flip.reached(high):
        missed, high, step = high, high * step, step * step
    high = min(high, Fraction(1))  # at 1 the sizes vanish, and any goal within reach is attained before
    while high > Fraction(9, 8) * missed:
        middle = _between(missed, high)
        missed, high = (missed, middle) if flip.reached(middle) else (middle, high)
    return high


def _excluded_end(flip: AnyFlip, high: Fraction) -> tuple[Fraction, Fraction]:
    """Return a change below `high` that one certificate excludes (0 if none is found), and `high`."""
    low, step = rounded(high * Fraction(4, 5), BITS), 2
    while not flip.excluded(low, cuts=0):
        low, step = low / step, step * step
        if step > _LARGEST_STEP:
            return Fraction(0), high
    return low, high


_LARGEST_STEP = 2**128


def _narrowed(flip: AnyFlip, cuts: int, steps: int, ends: tuple[Fraction, Fraction]) -> tuple[Fraction, Fraction]:
    """Return the two ends, narrowed by at most `steps` bisections."""
    low, high = ends
    doubtful = high
    for _ in range(steps):
        if high <= RATIO * low or doubtful <= low * Fraction(33, 32):
            break
        middle = _between(low, doubtful)
        if flip.excluded(middle, cuts):
            low = middle
        elif flip.reached(middle):
            high = doubtful = middle
        else:
            doubtful = middle
    return low, high


def _between(low: Fraction, high: Fraction) -> Fraction:
    """Return a short number between two, midway by their logarithms when they are far apart."""
    ratio = high / low
    if ratio > 4:
        return low * (1 << (math.floor(ratio).bit_length() - 1) // 2)
    return (low + high) / 2


LEAST = -44
INNER, OUTER = 1 - 2.0**-8, 1 + 2.0**-8
SMALLEST, LARGEST = 2.0**-90, 2.0**90
"""Lengths that no change brings out of the range in which floats decide."""

TOWARD_EXTERIOR = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0])
"""Which way α, γ, b, d, x, y, z change: the sizes of the spheroid fall for either clear position, the others turn."""
TOWARD_INTERIOR = np.array([1.0, -1.0, -1.0, -1.0, -1.0, -1.0, 1.0])


def flip_exponents(rows: Rows) -> Floats:
    """Return floor(log2) of each row's flip distance to the nearest other position, (n,); −inf for a tangency.

    For a pair that is not upright it is from an estimate, because a proof takes too long.
    """
    octaves = np.full(len(rows), np.nan)
    upright = upright_mask(rows)
    columns = rows[upright, : len(COLUMNS)]
    octaves[upright] = distance_exponents(columns, float_filter.positions(columns))
    for index in np.flatnonzero(np.isnan(octaves)):
        pair = Pair.from_row(rows[index].tolist())
        truth = exact.decide(pair.lengths)
        others = set(Position) - {truth.position} if truth.position is Position.CONTACT else {Position.CONTACT}
        nearest = min(exponent(pair, truth, other) for other in others)
        octaves[index] = math.floor(nearest) if math.isfinite(nearest) else nearest
    return octaves


def distance_exponents(rows: Rows, positions: Positions) -> Floats:
    """Return flip_exponents of upright rows (n, 7) with these exact positions; NaN where floats cannot decide."""
    lengths = np.abs(rows)
    within = ((lengths >= SMALLEST) & (lengths <= LARGEST) | (lengths == 0)).all(axis=1)
    octaves = np.full(len(rows), np.nan)
    places = np.flatnonzero(within)
    places = places[~_changes_position(rows[places], positions[places], np.full(len(places), LEAST), OUTER)]
    low: NDArray[np.int64] = np.full(len(places), LEAST)
    high: NDArray[np.int64] = np.zeros(len(places), dtype=np.int64)
    while len(places):
        done = high - low == 1
        octaves[places[done]] = low[done]
        places, low, high = places[~done], low[~done], high[~done]
        middle = (low + high) // 2
        nearer = _changes_position(rows[places], positions[places], middle, INNER)
        farther = ~nearer
        farther[farther] = ~_changes_position(rows[places[farther]], positions[places[farther]], middle[farther], OUTER)
        known = nearer | farther
        high, low = np.where(nearer, middle, high)[known], np.where(farther, middle, low)[known]
        places = places[known]
    return octaves


def _changes_position(rows: Rows, positions: Positions, exponents: NDArray[np.int64], factor: float) -> Mask:
    """Decide whether changes of 2^exponent · factor bring each row to another position, (n,)."""
    change = np.ldexp(factor, exponents)[:, None]
    clear, side = positions != Position.CONTACT, (positions == Position.INTERIOR)[:, None]
    # A clear row is changed away from its position, and has flipped if it has another one.
    away = np.where(side, -TOWARD_INTERIOR, -TOWARD_EXTERIOR)
    flipped = np.zeros(len(rows), dtype=np.bool_)
    flipped[clear] = _positions_of_changed(rows[clear], away[clear], change[clear]) != positions[clear]
    for toward, position in ((TOWARD_EXTERIOR, Position.EXTERIOR), (TOWARD_INTERIOR, Position.INTERIOR)):
        rest = np.flatnonzero(~clear & ~flipped)
        flipped[rest] = _positions_of_changed(rows[rest], toward, change[rest]) == position
    return flipped


def _positions_of_changed(rows: Rows, direction: Floats, change: Floats) -> Positions:
    """Return the exact positions of rows of which each number is changed by the relative direction · change."""
    return float_filter.positions(rows * (1 + direction * change))
