"""The sweep between two positions: whether a spheroid moved along a segment meets contact, exactly, and when first.

The centre is C(t) = C0 + t (C1 − C0), 0 ≤ t ≤ 1; the axis keeps its direction. Steps (`steps`) decide most sweeps: each
step is a piece that one multiplier proves clear, and the exact decision looks for contact after the last piece. The
roots of a critical polynomial in t decide every sweep (docs/motion.md). Of an upright spheroid it is the discriminant Δ
of the cubic, of degree 8 at most; of a tilted one that of the quartic, of degree 12:

- the position changes only through a tangency, and a tangency has Δ = 0. So between two neighbouring roots of Δ the
  position is constant, and one exact decision between them finds it;
- at a root with the same clear position on both sides there is a tangency (the spheroid grazes the surface), unless the
  multiple root is the ring's. The possible places of the ring are known exactly (`touches` of a sweep);
- Δ of an upright sweep is not 0 for every t unless nothing moves; of a tilted one another polynomial takes its place.

Roots are isolated by Descartes' rule of signs in integers; nothing is rounded.
"""

from __future__ import annotations

import math
import reprlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.arithmetic import rounded_toward, shortened
from hypcheck.geometry.pair import (
    AXIS,
    CENTER,
    COLUMNS,
    NO_DIRECTION,
    SIZES,
    SWEEP_COLUMNS,
    TILTED_SWEEP_COLUMNS,
    UPRIGHT,
    WITHOUT_ENDS,
    Lengths,
    Position,
    trouble_with,
    trouble_with_heights,
)
from hypcheck.messages import counted, escaped
from hypcheck.truth import ended_sweeps
from hypcheck.truth.ended_sweeps import EndedSweep, first_contact, grazes
from hypcheck.truth.polynomials import Interval, Polynomial, narrowed, roots_from_0_to_1, value
from hypcheck.truth.sweep import StraightSweep, piece

WIDTH_BITS = 60
"""The enclosure of a first contact is at most 2^−60 of it wide."""

MOST_STEPS = 64
SHORTEST = Fraction(1, 2**240)
"""A step below this, or so many steps, says that steps decide nothing here."""

_STEP_BITS = 40

_NEAR = Fraction(1, 2**20)
"""Where some contact is known, an earlier one is looked for behind steps shorter than this part of their time."""

Piece = tuple[Fraction, Fraction]
"""A multiplier, and the time up to which it proves the spheroid clear, from where the piece before ends, or from 0."""


@dataclass(frozen=True, slots=True)
class Steps:
    """Pieces of a sweep that begins clear, without gaps from 0; `contact` is a time of contact that is no tangency.

    `contact` is None if the sweep is clear up to 1. The first contact lies between the end of the last piece and
    `contact`.
    """

    pieces: tuple[Piece, ...]
    contact: Fraction | None

    @property
    def until(self) -> Fraction:
        """The time up to which the spheroid is clear."""
        return self.pieces[-1][1]


def steps(sweep: StraightSweep, bits: int | None = WIDTH_BITS) -> Steps | None:
    """Return the steps of a sweep that begins clear, or None if they do not decide it.

    The first contact is enclosed to 2^−bits of itself; without `bits` any contact ends the search.
    """
    pencil, time = sweep.pencil, Fraction(0)
    pieces: list[Piece] = []
    contact = Fraction(1) if _crosses(sweep, Fraction(1)) else None
    while len(pieces) < MOST_STEPS and not _narrow(time, contact, bits):
        multiplier, step = _step(sweep, pencil, time)
        if step is None or time + step >= 1:
            return Steps((*pieces, (multiplier, Fraction(1))), None)
        if step < SHORTEST * time:
            return None
        time += step
        pieces.append((multiplier, time))
        beyond = time + step / 2
        if beyond < (contact or 1) and (contact is None or step < _NEAR * time) and _crosses(sweep, beyond):
            contact = beyond
    return Steps(tuple(pieces), contact) if _narrow(time, contact, bits) else None


def _narrow(time: Fraction, contact: Fraction | None, bits: int | None) -> bool:
    """Decide whether a time up to which the sweep is clear, and one of contact, are near enough."""
    return contact is not None and (bits is None or (contact - time) * 2**bits <= time)


def _crosses(sweep: StraightSweep, time: Fraction) -> bool:
    """Decide whether there is contact at a time that is not a tangency."""
    return sweep.position(time) is Position.CONTACT and not sweep.tangent(time)


def _step(sweep: StraightSweep, pencil: Sequence[Polynomial], time: Fraction) -> tuple[Fraction, Fraction | None]:
    """Return a multiplier that proves a time clear, and how far beyond it does; None if without limit.

    The first multiplier that proves it may not reach far; the next one, with twice as many bits, reaches nearly as far
    as any.
    """
    proved = False
    for multiplier in sweep.multipliers(time):
        proof = piece(pencil, multiplier)
        if proved or value(proof, time) > 0:
            if proved and value(proof, time) > 0:
                return multiplier, reach(proof, time)
            proved = True
    raise AssertionError("unreachable: the multipliers do not end")


def reach(proof: Polynomial, time: Fraction) -> Fraction | None:
    """Return a lower bound of the distance to the next root of a quadratic positive at a time; None if no root."""
    a, b, c = proof
    n, m = time.numerator, time.denominator
    here, slope, bend = (a * n + b * m) * n + c * m * m, (2 * a * n + b * m) * m, a * m * m
    inner = slope * slope - 4 * bend * here
    if inner < 0 or (slope >= 0 and bend >= 0):
        return None
    shift = max(0, 80 - inner.bit_length() // 2)
    bottom = math.isqrt(inner << 2 * shift) + 1 - (slope << shift)  # > √inner − slope
    return shortened(2 * here << shift, bottom, _STEP_BITS)


Rational = float | Fraction
"""A float64, taken as an exact value, or a fraction."""


@dataclass(frozen=True, slots=True)
class Passage:
    """The result about a sweep: the positions at both ends, and the first contact.

    `first` encloses the time t of the first contact, 0 ≤ t ≤ 1, in an open interval or as a single number (twice); None
    if the sweep is clear. `grazes`: all contact is tangency, from the same side; every smaller spheroid is clear.
    """

    start: Position
    end: Position
    first: Interval | None
    grazes: bool = False

    @property
    def clear(self) -> bool:
        """Whether the whole sweep, its two ends included, is without contact."""
        return self.first is None

    @property
    def hit(self) -> bool:
        """Whether there is contact somewhere on the sweep, its two ends included."""
        return self.first is not None

    @property
    def index(self) -> int:
        """The number of the hyperboloid that is touched first: 0, the only one; −1 if there is no contact."""
        return 0 if self.hit else -1

    @property
    @in_default_environment
    def first_lower(self) -> float:
        """The largest float64 that is not above the enclosure of the first contact; NaN if there is no contact."""
        return math.nan if self.first is None else rounded_toward(self.first[0], -math.inf)

    @property
    @in_default_environment
    def first_upper(self) -> float:
        """The least float64 that is not below the enclosure of the first contact; NaN if there is no contact."""
        return math.nan if self.first is None else rounded_toward(self.first[1], math.inf)


@in_default_environment
def passage(
    sizes: Sequence[Rational],
    start: Sequence[Rational],
    end: Sequence[Rational],
    axis: Sequence[Rational] | None = None,
    upward: Sequence[Rational] | None = None,
    *,
    z_min: float = -math.inf,
    z_max: float = math.inf,
    solid: float = False,
) -> Passage:
    """Decide the passage of a spheroid between two positions: sizes α, γ, b, d; centres from the hyperboloid's.

    `axis` is any vector along the spheroid's axis of revolution, which keeps its direction on the sweep, and `upward`
    any along the hyperboloid's; they are vertical where they are None. The hyperboloid ends at the heights `z_min` and
    `z_max` along its axis; with `solid`, flat ends belong to it. Exact for every valid value, in every regime; where
    the hyperboloid ends, a miss by less than 2^−240 of the spheroid's size counts as contact. Raises InputError where a
    size is not finite and > 0, a coordinate not finite, an axis without direction, z_min not less than z_max, or their
    number not 4, 3, 3, 3 and 3.
    """
    return passage_on(sweep_of(sizes, start, end, axis, upward, (z_min, z_max, solid)))


@in_default_environment
def passage_of_row(row: Sequence[Rational]) -> Passage:
    """Return the passage of a row's sweep. Raises InputError as `passage` does."""
    return passage_on(sweep_of_row(row))


def passage_on(sweep: StraightSweep) -> Passage:
    """Return the first contact of a sweep, if it has contact."""
    if sweep.start.has_ends:
        return beside_ends(sweep)
    return by_steps(sweep) or by_roots(sweep)


def meets(sweep: StraightSweep) -> bool:
    """Decide whether there is contact on a sweep; this is faster than its passage, because no time is enclosed."""
    if sweep.start.has_ends:
        return ended_sweeps.meets(EndedSweep(sweep))
    here, there = sweep.position(Fraction(0)), sweep.position(Fraction(1))
    if here is not there or here is Position.CONTACT:
        return True
    if not sweep.moves:
        return False
    result = steps(sweep, bits=None)
    return by_roots(sweep).hit if result is None else result.contact is not None


def beside_ends(sweep: StraightSweep) -> Passage:
    """Return the passage of a sweep beside a hyperboloid that ends."""
    here, there = sweep.position(Fraction(0)), sweep.position(Fraction(1))
    first = first_contact(EndedSweep(sweep))
    return Passage(here, there, first, first is not None and grazes(sweep))


def by_steps(sweep: StraightSweep) -> Passage | None:
    """Return the passage of a sweep, by steps; None if they do not decide it, or if it begins with a tangency."""
    here, there = sweep.position(Fraction(0)), sweep.position(Fraction(1))
    if not sweep.moves:
        return None
    if here is Position.CONTACT:
        return None if sweep.tangent(Fraction(0)) else Passage(here, there, (Fraction(0), Fraction(0)))
    result = steps(sweep)
    if result is None:
        return None
    return Passage(here, there, None if result.contact is None else (result.until, result.contact))


def by_roots(sweep: StraightSweep) -> Passage:
    """Return the passage of a sweep, by the roots of the critical polynomial, which always decide."""
    here, there = sweep.position(Fraction(0)), sweep.position(Fraction(1))
    if not sweep.moves:
        met = (Fraction(0), Fraction(0)) if here is Position.CONTACT else None
        return Passage(here, there, met, met is not None and sweep.tangent(Fraction(0)))
    critical = sweep.critical()
    times = roots_from_0_to_1(critical)
    between = list(_between(times))
    gaps = [None if time is None else sweep.position(time) for time in between]
    before = [here if gap is None else gap for gap in gaps[:-1]]
    after = [there if gap is None else gap for gap in gaps[1:]]
    meetings = [
        time
        for time, left, right in zip(times, before, after, strict=True)
        if left is not right or left is Position.CONTACT or sweep.touches(critical, time, left)
    ]
    contacts = [time for time, gap in zip(between, gaps, strict=True) if time is not None and gap is Position.CONTACT]
    grazes = bool(meetings or contacts) and all(map(sweep.tangent, contacts))
    if here is Position.CONTACT:
        return Passage(here, there, (Fraction(0), Fraction(0)), grazes)
    return Passage(here, there, narrowed(critical, *meetings[0]) if meetings else None, grazes)


def _between(times: Sequence[Interval]) -> Iterator[Fraction | None]:
    """Yield a time before the first root, between each root and the next, and after the last; None if there is none.

    None occurs only at an end, if 0 or 1 is a root.
    """
    last = Fraction(0)
    for low, high in times:
        yield None if low == high == 0 else (last + low) / 2
        last = high
    yield None if last == 1 and times[-1][0] == 1 else (last + 1) / 2


def sweep_of(
    sizes: Sequence[Rational],
    start: Sequence[Rational],
    end: Sequence[Rational],
    axis: Sequence[Rational] | None = None,
    upward: Sequence[Rational] | None = None,
    heights: Sequence[float] = WITHOUT_ENDS,
) -> StraightSweep:
    """Make the sweep of these numbers, as an upright one if that is equivalent. Raises InputError as `passage` does."""
    trouble = trouble_with_heights(heights)
    if trouble is not None:
        raise InputError(trouble)
    centers = [_required(sizes, center)[len(SIZES) :] for center in (start, end)]
    direction, tower = (checked_axis(UPRIGHT if vector is None else vector) for vector in (axis, upward))
    here, there = Lengths.at_centers(tuple(sizes), centers, direction, tower, heights)
    return StraightSweep(here, (there.x - here.x, there.y - here.y, there.z - here.z))


def sweep_of_row(row: Sequence[Rational], scale: Rational = 1) -> StraightSweep:
    """Make the sweep of a row: sizes, two centres, maybe axis and heights; b and d are multiplied by `scale`.

    Raises InputError as `passage` does.
    """
    (alpha, gamma, b, d), heights = row[:4], row[len(TILTED_SWEEP_COLUMNS) :] or WITHOUT_ENDS
    if scale != 1:
        b, d = Fraction(b) * Fraction(scale), Fraction(d) * Fraction(scale)
    axis = row[len(SWEEP_COLUMNS) : len(TILTED_SWEEP_COLUMNS)] or None
    return sweep_of((alpha, gamma, b, d), row[4:7], row[7:10], axis, None, tuple(map(float, heights)))


def checked(sizes: Sequence[Rational], center: Sequence[Rational]) -> tuple[Fraction, ...]:
    """Return α, γ, b, d, x, y, z as fractions. Raises InputError naming the first that cannot be one."""
    return tuple(Fraction(number) for number in _required(sizes, center))


def _required(sizes: Sequence[Rational], center: Sequence[Rational]) -> tuple[Rational, ...]:
    """Return α, γ, b, d, x, y, z if each has an exact value. Raises InputError naming the first that has none."""
    numbers = (*checked_sequence("the sizes", SIZES, sizes), *checked_sequence("a centre", CENTER, center))
    for name, number in zip(COLUMNS, numbers, strict=True):
        _require(name, number)
    return numbers


def checked_axis(axis: Sequence[Rational]) -> tuple[Fraction, ...]:
    """Return axis_x, axis_y, axis_z as fractions. Raises InputError if they cannot be, or are all 0."""
    numbers = checked_sequence("the axis", AXIS, axis)
    for name, number in zip(AXIS, numbers, strict=True):
        _require(name, number)
    if not any(numbers):
        raise InputError(NO_DIRECTION)
    return tuple(Fraction(number) for number in numbers)


def checked_sequence(subject: str, names: Sequence[str], values: object) -> tuple[Rational, ...]:
    """Return the values, one for each name. Raises InputError where they are more, fewer, or no sequence."""
    wanted = f"there must be {len(names)}: {', '.join(names)}"
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise InputError(f"{subject}: {escaped(reprlib.repr(values), 60)} is not a sequence of numbers; {wanted}")
    numbers = tuple(values)
    if len(numbers) != len(names):
        raise InputError(
            f"{subject}: {counted(len(numbers), 'number')} in {escaped(reprlib.repr(numbers), 60)}; {wanted}"
        )
    return numbers


def _require(name: str, number: Rational) -> None:
    """Raise InputError unless the number is valid in this column."""
    if isinstance(number, Fraction):
        if name in SIZES and number <= 0:
            raise InputError(f"{name} is {number}; a semi-axis must be greater than 0")
    elif (trouble := trouble_with(name, number)) is not None:
        raise InputError(trouble)
