"""The way between two positions: whether a spheroid that moves along a segment meets contact, exactly, and when first.

The centre is C(t) = C0 + t (C1 − C0), 0 ≤ t ≤ 1. In t, x² + y² and z² are polynomials of degree 2, c1 and c2 too, and Δ
is one of degree 8 at most, with rational coefficients. Its roots are all that matters (docs/motion.md):

- the position changes only through a tangency, and a tangency has Δ = 0. So between two neighbouring roots of Δ the
  position is constant, and one exact decision between them finds it;
- at a root with the same clear position on both sides there is a tangency (the spheroid grazes the surface), unless the
  double root of g is the ring's. That one needs z = 0: where z varies it is zero at one rational t, which is decided
  exactly; where z = 0 all along, the position depends on x² + y² alone, monotonically, so the spheroid can graze only
  where x² + y² is least: at one rational t again;
- Δ is not 0 for every t unless nothing moves.

Roots are counted by Sturm's theorem in integers; nothing is rounded.
"""

from __future__ import annotations

import math
import reprlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.errors import InputError
from hypcheck.geometry.pair import AXIS, CENTER, COLUMNS, NO_DIRECTION, SIZES, Lengths, Position, trouble_with
from hypcheck.messages import counted, escaped
from hypcheck.truth import exact
from hypcheck.truth.polynomial_roots import (
    Interval,
    Polynomial,
    narrowed,
    polynomial_product,
    polynomial_sum,
    primitive,
    roots_from_0_to_1,
    value,
)

Rational = float | Fraction
"""A float64, taken as an exact value, or a fraction."""


@dataclass(frozen=True, slots=True)
class Passage:
    """What happens on the way: the positions at both ends, and the first contact.

    `first` encloses the time t of the first contact, 0 ≤ t ≤ 1, in an open interval or as a single number (twice); None
    where the way is clear. `grazes`: all contact is tangency, from one and the same side; a spheroid that is smaller by
    any part at all is clear.
    """

    start: Position
    end: Position
    first: Interval | None
    grazes: bool = False

    @property
    def clear(self) -> bool:
        """Whether there is no contact from beginning to end."""
        return self.first is None

    @property
    def hit(self) -> bool:
        """Whether there is contact somewhere on the way, its two ends included."""
        return self.first is not None

    @property
    def first_lower(self) -> float:
        """The largest float64 that is not above the time of first contact's enclosure; NaN where there is none."""
        return math.nan if self.first is None else rounded(self.first[0], -math.inf)

    @property
    def first_upper(self) -> float:
        """The least float64 that is not below the enclosure; NaN where there is none."""
        return math.nan if self.first is None else rounded(self.first[1], math.inf)


@dataclass(frozen=True, slots=True)
class _Journey:
    """Sizes and a way in integers, radial and axial lengths each in their own unit: (start, step) by coordinate."""

    alpha: int
    b: int
    gamma: int
    d: int
    x: tuple[int, int]
    y: tuple[int, int]
    z: tuple[int, int]

    def position(self, time: Fraction) -> Position:
        """The exact position at a rational time."""
        return exact.position(self.at(time))

    def at(self, time: Fraction) -> Lengths:
        """The pair at a rational time."""
        n, m = time.numerator, time.denominator
        x, y, z = (start * m + step * n for start, step in (self.x, self.y, self.z))
        return Lengths(self.alpha * m, self.b * m, x, y, self.gamma * m, self.d * m, z)


def passage(
    sizes: Sequence[Rational],
    start: Sequence[Rational],
    end: Sequence[Rational],
    axis: Sequence[Rational] | None = None,
) -> Passage:
    """What happens between two positions of a spheroid: sizes α, γ, b, d; centres (x, y, z) from the hyperboloid's.

    `axis` is any vector along the spheroid's axis of revolution, which keeps its direction on the way; vertical where
    it is None. Exact for every valid value, in every regime. Raises InputError where a size is not finite and > 0, a
    coordinate not finite, an axis without direction, or their number not 4, 3, 3 and 3.
    """
    if axis is not None and _leans(sizes, checked_axis(axis)):
        raise InputError("a way of a spheroid whose axis leans cannot be decided yet")
    journey = _journey(sizes, start, end)
    here, there = journey.position(Fraction(0)), journey.position(Fraction(1))
    if not any(step for _, step in (journey.x, journey.y, journey.z)):
        met = (Fraction(0), Fraction(0)) if here is Position.CONTACT else None
        return Passage(here, there, met, met is not None and exact.decide(journey.at(Fraction(0))).tangent)
    delta = _discriminant(journey)
    times = roots_from_0_to_1(delta)
    gaps = [None if time is None else journey.position(time) for time in _between(times)]
    before = [here if gap is None else gap for gap in gaps[:-1]]
    after = [there if gap is None else gap for gap in gaps[1:]]
    meetings = [
        time
        for time, left, right in zip(times, before, after, strict=True)
        if _meets(journey, delta, time, left, right)
    ]
    grazes = bool(meetings) and Position.CONTACT not in gaps
    if here is Position.CONTACT:
        return Passage(here, there, (Fraction(0), Fraction(0)), grazes)
    return Passage(here, there, narrowed(delta, *meetings[0]) if meetings else None, grazes)


def _meets(journey: _Journey, delta: Polynomial, time: Interval, before: Position, after: Position) -> bool:
    """Whether the spheroid is in contact at a root of Δ, given the positions just before and just after."""
    if before is not after or before is Position.CONTACT:
        return True  # contact is a closed condition, and the only way from one clear position to the other
    low, high = time
    special = low if low == high else _special_time(journey)
    if low <= special <= high and value(delta, special) == 0:
        return journey.position(special) is Position.CONTACT
    return any(journey.z)


def _special_time(journey: _Journey) -> Fraction:
    """The one time at which the root can be the ring's; where z = 0 all along, the one at which it is a tangency."""
    if journey.z[1]:
        return Fraction(-journey.z[0], journey.z[1])
    across = journey.x[1] ** 2 + journey.y[1] ** 2
    return Fraction(-journey.x[0] * journey.x[1] - journey.y[0] * journey.y[1], across)


def _discriminant(journey: _Journey) -> Polynomial:
    """N⁴ Δ as a polynomial in t, over the gcd of its coefficients. N, c0, c1, c2 are those of exact.Cubic."""
    p, q, s, t = journey.alpha**2, journey.b**2, journey.gamma**2, journey.d**2
    radius, height = polynomial_sum(_square(journey.x), _square(journey.y)), _square(journey.z)
    n3, n0 = (q * t,), (-p * s,)
    n2 = polynomial_sum(((p + q) * t - s * q,), polynomial_product((-t,), radius), polynomial_product((-q,), height))
    n1 = polynomial_sum((p * (t - s) - s * q,), polynomial_product((s,), radius), polynomial_product((-p,), height))
    square2, square1 = polynomial_product(n2, n2), polynomial_product(n1, n1)
    return primitive(
        polynomial_sum(
            polynomial_product(square1, square2),
            polynomial_product((-4,), polynomial_product(n3, polynomial_product(n1, square1))),
            polynomial_product(n0, polynomial_product((18,), polynomial_product(n3, polynomial_product(n1, n2)))),
            polynomial_product(n0, polynomial_product((-4,), polynomial_product(n2, square2))),
            polynomial_product((-27 * n3[0] ** 2,), polynomial_product(n0, n0)),
        )
    )


def _square(coordinate: tuple[int, int]) -> Polynomial:
    """(start + step t)²."""
    start, step = coordinate
    return (step * step, 2 * start * step, start * start)


def _between(times: Sequence[Interval]) -> Iterator[Fraction | None]:
    """A time before the first root, one between each root and the next, one after the last; None where there is none.

    None comes at an end alone, where 0 or 1 is a root.
    """
    last = Fraction(0)
    for low, high in times:
        yield None if low == high == 0 else (last + low) / 2
        last = high
    yield None if last == 1 and times[-1][0] == 1 else (last + 1) / 2


def rounded(number: Fraction, toward: float) -> float:
    """The nearest float64 that is not beyond the number on the side away from `toward`."""
    near = float(number)
    wrong_side = near > number if toward < 0 else near < number
    return math.nextafter(near, toward) if wrong_side else near


def _journey(sizes: Sequence[Rational], start: Sequence[Rational], end: Sequence[Rational]) -> _Journey:
    alpha, gamma, b, d, x0, y0, z0 = checked(sizes, start)
    x1, y1, z1 = checked(sizes, end)[len(SIZES) :]
    a, w, x, u, y, v = integers(alpha, b, x0, x1 - x0, y0, y1 - y0)
    c, h, z, s = integers(gamma, d, z0, z1 - z0)
    return _Journey(a, w, c, h, (x, u), (y, v), (z, s))


def checked(sizes: Sequence[Rational], center: Sequence[Rational]) -> tuple[Fraction, ...]:
    """α, γ, b, d, x, y, z as fractions. Raises InputError naming the first that cannot be."""
    numbers = (*checked_sequence("the sizes", SIZES, sizes), *checked_sequence("a centre", CENTER, center))
    return tuple(_exact(name, number) for name, number in zip(COLUMNS, numbers, strict=True))


def checked_axis(axis: Sequence[Rational]) -> tuple[Fraction, ...]:
    """axis_x, axis_y, axis_z as fractions. Raises InputError where they cannot be, or are all 0."""
    found = tuple(map(_exact, AXIS, checked_sequence("the axis", AXIS, axis)))
    if not any(found):
        raise InputError(NO_DIRECTION)
    return found


def _leans(sizes: Sequence[Rational], axis: tuple[Fraction, ...]) -> bool:
    """Whether the axis matters: it is not vertical, and the spheroid is no sphere."""
    _, _, b, d = checked_sequence("the sizes", SIZES, sizes)
    return any(axis[:2]) and b != d


def checked_sequence(subject: str, names: Sequence[str], values: object) -> tuple[Rational, ...]:
    """The values, one for each name. Raises InputError where they are more, fewer, or no sequence."""
    wanted = f"there must be {len(names)}: {', '.join(names)}"
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise InputError(f"{subject}: {escaped(reprlib.repr(values), 60)} is no sequence of numbers; {wanted}")
    found = tuple(values)
    if len(found) != len(names):
        raise InputError(f"{subject}: {counted(len(found), 'number')} in {escaped(reprlib.repr(found), 60)}; {wanted}")
    return found


def _exact(name: str, number: Rational) -> Fraction:
    if isinstance(number, Fraction):
        if name in SIZES and number <= 0:
            raise InputError(f"{name} is {number}; a semi-axis must be greater than 0")
        return number
    trouble = trouble_with(name, number)
    if trouble is not None:
        raise InputError(trouble)
    return Fraction(number)


def integers(*numbers: Fraction) -> tuple[int, ...]:
    """The numbers multiplied by one positive number that makes each an integer."""
    unit = math.lcm(*(number.denominator for number in numbers))
    return tuple(int(number * unit) for number in numbers)
