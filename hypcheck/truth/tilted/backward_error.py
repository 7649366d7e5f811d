"""How far an answer about a tilted spheroid is from being right, between two proved ends.

The backward error is the infimum of the ε for which changing each of the ten numbers by a relative ε at most makes the
answer right. Positions are monotone in the four sizes (a larger spheroid contains the smaller one; {h > 0} grows when α
falls or γ grows), so that among their changes one corner is best; in centre and axis they are not monotone. So the
error is bracketed:

- from above by a change: a corner of the box of changes at which an exact decision finds the answer right;
- from below by certificates that hold over the whole box (box_certificate.py), the sizes at their best corner.

With a vertical axis, and of a sphere, positions are monotone, and one corner tells: both ends meet as near as wanted.

Runs judge many answers, most of them wrong by far: `lower_ends` proves that of many rows at once, in float64
(float_boxes.py), and `quick_bracket` begins there.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

import numpy as np

from hypcheck.geometry.pair import TILTED_COLUMNS, Lengths, Pair, Position
from hypcheck.truth import backward_error as upright
from hypcheck.truth import exact
from hypcheck.truth.backward_error import Bracket
from hypcheck.truth.exact import Decision
from hypcheck.truth.tilted import float_boxes
from hypcheck.truth.tilted.box_certificate import Goal, Row, Signs, State, certified
from hypcheck.truth.tilted.nearest import fraction

RATIO = Fraction(5, 4)
"""A bracket is refined until its upper end is at most this many times the lower."""

CUTS = 3
"""How often a box may be cut along any line from the whole to its smallest part, where one certificate fails."""

STEPS = 8
"""How often a bracket that first derivatives did not make narrow enough is halved."""


def goal_of(truth: Position, answer: Position) -> Goal:
    """What makes a wrong answer right: on the way from a clear position to contact it is enough to leave the first."""
    return Goal(truth, leave=True) if answer is Position.CONTACT else Goal(answer, leave=False)


def _goal(row: Sequence[float], truth: Decision, answer: Position) -> Goal | float:
    """The goal of an answer; the backward error itself where that is known at once: 0 or inf.

    It is 0 for a right answer and for the limit of right answers (the truth is a tangency from that side). No relative
    change up to 1 brings a centre on the hyperboloid's axis outside.
    """
    if answer in (truth.position, truth.limit_of):
        return 0.0
    goal = goal_of(truth.position, answer)
    return math.inf if goal == Goal(Position.EXTERIOR, leave=False) and row[4] == row[5] == 0 else goal


def reached(row: Sequence[float], goal: Goal, change: Fraction) -> bool:
    """Whether a corner of the box of changes up to `change` (< 1) is found that attains the goal: proof from above."""
    if _stays_upright(row):
        return _reached_upright(row, goal, change)
    return _attained(_corners(tuple(map(Fraction, row)), goal, change), goal)


def excluded(row: Sequence[float], goal: Goal, change: Fraction, cuts: int = CUTS) -> bool:
    """Whether certificates are found that no change up to `change` (< 1) attains the goal: proof from below."""
    if _stays_upright(row):
        return not _reached_upright(row, goal, change)
    start = tuple(map(Fraction, row))
    sizes = _moved(start[:4], goal.sizes, change)
    box = [(each - abs(each) * change, each + abs(each) * change) for each in start[4:]]
    return certified(sizes, box, goal, cuts)


def _stays_upright(row: Sequence[float]) -> bool:
    """Whether the pair is an upright one at the best corner, too: its axis is vertical, or b and d change alike."""
    return row[7] == row[8] == 0 or row[2] == row[3]


def _reached_upright(row: Sequence[float], goal: Goal, change: Fraction) -> bool:
    """Whether a change attains the goal where positions are monotone in all numbers: one corner of the box tells."""
    other = Position.CONTACT if goal.leave else goal.side
    return upright.makes_right(Pair.from_row(row[:7]).lengths, goal.side, other, change)


def tolerated(row: Sequence[float], truth: Decision, answers: Iterable[Position], change: Fraction) -> bool | None:
    """Whether a relative change up to `change` makes one of the wrong answers right; None where neither is proved."""
    if change == 0:
        return False
    found = [_goal(row, truth, answer) for answer in answers]
    if 0.0 in found:
        return True
    goals = [goal for goal in found if isinstance(goal, Goal)]
    if change >= 1:
        return bool(goals)
    if all(excluded(row, goal, change, cuts=0) for goal in goals):  # most wrong answers are wrong by far
        return False
    if any(reached(row, goal, change) for goal in goals):
        return True
    return False if all(excluded(row, goal, change, 2 * CUTS) for goal in goals) else None


def bracket(row: Sequence[float], truth: Decision, answer: Position, cuts: int = CUTS, steps: int = STEPS) -> Bracket:
    """The backward error of an answer to a row of ten valid float64 numbers; inf where no change up to 1 is enough.

    The upper end is at most RATIO times the lower where first derivatives tell (changes that do not bend the surfaces
    much), and often elsewhere; it is 1 where no smaller change was found. Fewer `cuts` of a box and fewer `steps` of
    halving take less time.
    """
    goal = _goal(row, truth, answer)
    if isinstance(goal, float):
        return Bracket(goal, goal)
    high = _reached_end(row, goal)
    low, high = _excluded_end(row, goal, high)
    if low:
        low, high = _narrowed(row, goal, cuts, steps, (low, high))
    return Bracket(_rounded(low, -math.inf), _rounded(high, math.inf))


def lower_ends(
    rows: Sequence[Sequence[float]], truths: Sequence[Decision], answers: Sequence[Sequence[Position]]
) -> list[float]:
    """A lower end, proved in float64, of the least error of several answers to each row; 0 where none is found.

    The rows are of ten valid numbers, neither upright nor spheres. inf where no change up to 1 is enough.
    """
    ends = [math.inf] * len(rows)
    owners, goals = [], []
    for place, (row, truth, some) in enumerate(zip(rows, truths, answers, strict=True)):
        for answer in some:
            goal = _goal(row, truth, answer)
            if isinstance(goal, float):
                ends[place] = min(ends[place], goal)
            else:
                owners.append(place)
                goals.append(goal)
    asked = np.array([rows[place] for place in owners]).reshape(len(owners), len(TILTED_COLUMNS))
    for place, end in zip(owners, float_boxes.lower_ends(asked, goals).tolist(), strict=True):
        ends[place] = min(ends[place], end)
    return ends


def lower_end(row: Sequence[float], truth: Decision, answer: Position) -> float:
    """A lower end for which 256 bits are taken, as for an answer wrong by little; 0 where none is found."""
    goal = _goal(row, truth, answer)
    if isinstance(goal, float):
        return goal
    return _rounded(_excluded_end(row, goal, _estimate(tuple(map(Fraction, row)), goal))[0], -math.inf)


def quick_bracket(row: Sequence[float], truth: Decision, answer: Position) -> Bracket:
    """As `bracket`, in less time and narrower where the error is large: float64 proves the lower end where it can."""
    if _stays_upright(row):
        return bracket(row, truth, answer)
    low = lower_ends([row], [truth], [[answer]])[0] or lower_end(row, truth, answer)
    if low in (0, math.inf):
        return bracket(row, truth, answer)
    goal = goal_of(truth.position, answer)
    high = _reached_above(row, goal, Fraction(low))
    steps = low * np.exp2(np.arange(1, 1 + int(8 * math.log2(high / Fraction(low)))) / 8)
    steps = steps[(steps < 1) & (steps >= 2.0**float_boxes.LEAST)]
    if high > RATIO * Fraction(low) and len(steps):
        held = float_boxes.excluded(np.array([row] * len(steps)), [goal] * len(steps), steps, cuts=_QUICK_CUTS)
        low = float(steps[held].max(initial=low))
    return Bracket(low, _rounded(high, math.inf))


_QUICK_CUTS = 5


def _reached_above(row: Sequence[float], goal: Goal, low: Fraction) -> Fraction:
    """A change above `low` that is reached, nearly the least one; 1 where none is found."""
    start, high = tuple(map(Fraction, row)), _short(low * Fraction(17, 16))
    patterns = tuple(_pointed(_moved(start[:4], goal.sizes, high), start[4:], goal, high))
    while high < 1 and not _reached_at(start, goal, high, patterns):
        high = _short(high * Fraction(9, 8))
    high, change = min(high, Fraction(1)), _short(low * RATIO)
    while change < high and not _reached_at(start, goal, change, _PATTERNS):
        change = _short(change * RATIO)
    return min(high, change)


def _reached_at(start: Row, goal: Goal, change: Fraction, patterns: Iterable[Signs]) -> bool:
    """Whether a corner of these signs attains the goal."""
    sizes = _moved(start[:4], goal.sizes, change)
    return _attained(((*sizes, *_moved(start[4:], signs, change)) for signs in patterns), goal)


def _attained(rows: Iterable[Row], goal: Goal) -> bool:
    """Whether one of these rows attains the goal, by exact decisions."""
    return any((exact.position(Lengths.of(each)) is goal.side) is not goal.leave for each in rows)


def estimate(row: Sequence[float], truth: Decision, answer: Position) -> float:
    """About the backward error, as derivatives at the row tell: fast, and no proof. It ranks answers."""
    goal = _goal(row, truth, answer)
    return goal if isinstance(goal, float) else float(_estimate(tuple(map(Fraction, row)), goal))


def excluded_at_once(rows: Sequence[Sequence[float]], goals: Sequence[Goal], changes: Sequence[float]) -> list[bool]:
    """Where float64 proves that no change up to `changes` attains a goal; False says nothing."""
    asked = np.array(rows).reshape(len(rows), len(TILTED_COLUMNS))
    held = float_boxes.excluded(asked, goals, np.array(changes))
    return [bool(each) and not _stays_upright(row) for each, row in zip(held, rows, strict=True)]


def is_bracket(
    row: Sequence[float],
    truth: Decision,
    answer: Position,
    ends: Bracket,
    cuts: int = CUTS,
    *,
    lower_holds: bool = False,
) -> bool:
    """Whether proofs are found that the backward error of an answer lies between these ends.

    `lower_holds` says that the lower end is proved already, as by excluded_at_once.
    """
    goal = _goal(row, truth, answer)
    if isinstance(goal, float):
        return ends == Bracket(goal, goal)
    low, high = ends.lower, ends.upper
    if not 0 <= low <= high <= 1 or high == 0:
        return False
    below = lower_holds or low == 0 or (low < 1 and excluded(row, goal, Fraction(low), cuts))
    return below and (high == 1 or reached(row, goal, Fraction(high)))


def _reached_end(row: Sequence[float], goal: Goal) -> Fraction:
    """A change that is reached, less than 9/8 of one that is not found to be."""
    missed = _short(_estimate(tuple(map(Fraction, row)), goal))
    high, step = _short(missed * Fraction(11, 10)), 2
    while high < 1 and not reached(row, goal, high):
        missed, high, step = high, high * step, step * step
    high = min(high, Fraction(1))  # at 1 the sizes vanish, and any goal within reach is attained before
    while high > Fraction(9, 8) * missed:
        middle = _between(missed, high)
        missed, high = (missed, middle) if reached(row, goal, middle) else (middle, high)
    return high


def _excluded_end(row: Sequence[float], goal: Goal, high: Fraction) -> tuple[Fraction, Fraction]:
    """A change below `high` that one certificate excludes, 0 where none is found; and `high`."""
    low, step = _short(high * Fraction(4, 5)), 2
    while not excluded(row, goal, low, cuts=0):
        low, step = low / step, step * step
        if step > _LARGEST_STEP:
            return Fraction(0), high
    return low, high


_LARGEST_STEP = 2**128


def _narrowed(
    row: Sequence[float], goal: Goal, cuts: int, steps: int, ends: tuple[Fraction, Fraction]
) -> tuple[Fraction, Fraction]:
    """The ends brought nearer to each other, by so many halvings at most."""
    low, high = ends
    doubtful = high
    for _ in range(steps):
        if high <= RATIO * low or doubtful <= low * Fraction(33, 32):
            break
        middle = _between(low, doubtful)
        if excluded(row, goal, middle, cuts):
            low = middle
        elif reached(row, goal, middle):
            high = doubtful = middle
        else:
            doubtful = middle
    return low, high


def _between(low: Fraction, high: Fraction) -> Fraction:
    """A short number between two, midway by their logarithms when they are far apart."""
    ratio = high / low
    if ratio > 4:
        return low * (1 << (math.floor(ratio).bit_length() - 1) // 2)
    return (low + high) / 2


def _short(value: Fraction) -> Fraction:
    """About a value > 0, in 12 bits: a number that float64 holds, where it is not too small for that."""
    exponent = value.numerator.bit_length() - value.denominator.bit_length() - 12
    unit = Fraction(1 << exponent) if exponent >= 0 else Fraction(1, 1 << -exponent)
    return round(value / unit) * unit


def _rounded(value: Fraction, toward: float) -> float:
    """`value` as float64, rounded toward an infinity."""
    near = float(value)
    exactly = Fraction(near)
    wrong = exactly > value if toward < 0 else exactly < value
    return math.nextafter(near, toward) if wrong else near


def _moved(numbers: Row, signs: Signs, change: Fraction) -> Row:
    return tuple(each * (1 + sign * change) for each, sign in zip(numbers, signs, strict=True))


def _corners(row: Row, goal: Goal, change: Fraction) -> Iterator[Row]:
    """Corners of the box of changes: the one that derivatives point to, then those of all sign patterns."""
    sizes = _moved(row[:4], goal.sizes, change)
    tried = set()
    for pattern in itertools.chain(_pointed(sizes, row[4:], goal, change), _PATTERNS):
        signs = tuple(sign if each else 0 for sign, each in zip(pattern, row[4:], strict=True))
        if signs not in tried:
            tried.add(signs)
            yield (*sizes, *_moved(row[4:], signs, change))


_PATTERNS = tuple(itertools.product((1, -1), repeat=6))


def _pointed(sizes: Row, rest: Row, goal: Goal, change: Fraction) -> Iterator[Signs]:
    """The signs of the derivatives of φ at the row, and again at the corner that these point to."""
    signs: Signs = (0,) * 6
    for _ in range(2):
        state = State(sizes, _moved(rest, signs, change), goal)
        signs = tuple(goal.sign * (1 if each > 0 else -1) for each in state.derivatives())
        yield signs


def _estimate(row: Row, goal: Goal) -> Fraction:
    """The change that derivatives at the row promise to be enough, at most 1/2, and > 0."""
    state = State(row[:4], row[4:], goal)
    value = abs(state.value())
    moves = [size * fraction(each) for size, each in zip(row[4:], state.derivatives(), strict=True)]
    rate = sum(map(abs, (*moves, *map(fraction, state.size_derivatives()))), Fraction(0))
    estimate = fraction(value) / rate if rate else Fraction(1)
    return min(estimate, Fraction(1, 2)) if estimate else Fraction(1, 1 << 10_000)
