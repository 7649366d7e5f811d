"""Turning in place: the position of an arm's part relative to the hyperboloid during a whole turn, by proved bounds.

The part's centre goes along an arc of radius l about the mover's centre (x0, y0, z0), at one height. Only its squared
distance from the axis changes, R(t) = x0² + y0² + l² + 2 l e(t), with

    e(t) = x0 cos(θ + t) + y0 sin(θ + t),  t from 0 to the angle of the turn.

At a fixed height an exterior spheroid stays exterior if R grows, and an interior one stays interior if R falls
(docs/mathematics.md, "Monotone in every input"). So the least R of the turn decides whether the part is always
exterior, the largest R whether it is always interior; otherwise there is contact on the turn. e(t) is ρ cos(t − t*), ρ²
= x0² + y0²: over less than half a turn its extremes are at the ends, or ±ρ where its slope has changed its sign in
between. Sines, cosines and roots are enclosed between rationals, and so is R; the answer is given if it is the same at
both ends of the enclosures.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction

from mpmath import MPContext, MPIntervalContext
from mpmath.ctx_iv import ivmpf

from hypcheck.errors import InputError
from hypcheck.geometry.arithmetic import fraction, root_of
from hypcheck.geometry.pair import Lengths, Position, to_integers
from hypcheck.messages import escaped
from hypcheck.truth import exact
from hypcheck.truth.swept import Rational, checked, checked_sequence

PRECISIONS = (128, 512, 2048)
"""Bits with which enclosures are made, each tried where the one before does not tell."""

WHOLE_TURN = 6.5
"""An angle that is more than a whole turn: the arc is the circle."""

_PIECE = Fraction(1, 2)
"""Radians: far below half a turn."""

Enclosure = tuple[Fraction, Fraction]


def turning(
    sizes: Sequence[Rational],
    center: Sequence[Rational],
    arm: Rational,
    direction: Sequence[Rational],
    angle: float,
) -> Position | None:
    """Return the position of a part during a turn: EXTERIOR or INTERIOR at all times, or CONTACT if there is contact.

    `sizes` are α, γ and the part's b, d; `center` is the mover's, from the hyperboloid's; the arm points into the
    `direction` (x, y) ≠ (0, 0) of any length at first, and turns by `angle` (radians, counterclockwise, finite). None
    where 2048 bits cannot tell: the turn then comes to a tangency to within 10⁻⁶⁰⁰. Raises InputError where a number is
    not finite, a size not > 0, the arm < 0 or the direction (0, 0).
    """
    rationals = checked(sizes, center)
    length, ahead, aside, _ = _checked_turn(arm, direction, angle)
    for bits in PRECISIONS:
        least, largest = squared_distances(rationals[4], rationals[5], length, (ahead, aside), angle, bits)
        position = _all_along(rationals, least, largest, bits)
        if position is not None:
            return position
    return None


def _checked_turn(arm: Rational, direction: Sequence[Rational], angle: float) -> tuple[Fraction, ...]:
    """Return the arm, both parts of the direction and the angle as fractions. Raises InputError."""
    ahead, aside = checked_sequence("direction", ("x", "y"), direction)
    for name, number in (("arm", arm), ("direction", ahead), ("direction", aside), ("angle", angle)):
        if isinstance(number, bool) or not isinstance(number, (int, float, Fraction)):
            raise InputError(f"{name} is {escaped(repr(number), 60)}; it must be a number")
        if isinstance(number, float) and not math.isfinite(number):
            raise InputError(f"{name} is {number!r}; it must be finite")
    if arm < 0 or not (ahead or aside):
        what = f"arm is {arm!r}; it must be 0 or more" if arm < 0 else "direction is (0, 0); it must lead somewhere"
        raise InputError(what)
    return tuple(Fraction(number) for number in (arm, ahead, aside, angle))


def squared_distances(
    x: Fraction, y: Fraction, arm: Fraction, direction: tuple[Fraction, Fraction], angle: float, bits: int
) -> tuple[Enclosure, Enclosure]:
    """Return enclosures of the least and of the largest R of the turn."""
    reach = _root(x * x + y * y, bits)
    if abs(angle) >= WHOLE_TURN:
        extremes = [(-reach[1], -reach[0]), reach]
    else:
        pieces = [_extremes(left, right, reach) for left, right in _pieces(x, y, direction, angle, bits)]
        extremes = [
            (min(low[0] for low, _ in pieces), min(low[1] for low, _ in pieces)),
            (max(high[0] for _, high in pieces), max(high[1] for _, high in pieces)),
        ]
    base = x * x + y * y + arm * arm
    least, largest = ((base + 2 * arm * low, base + 2 * arm * high) for low, high in extremes)
    return least, largest


State = tuple[Enclosure, Enclosure]
"""e and its slope at one time."""


def _pieces(
    x: Fraction, y: Fraction, direction: tuple[Fraction, Fraction], angle: float, bits: int
) -> Iterator[tuple[State, State]]:
    """Yield e and e′ at both ends of each piece of the turn."""
    context, plain = MPIntervalContext(), MPContext()
    context.prec = plain.prec = bits

    def enclosed(number: Fraction) -> ivmpf:
        return context.mpf(number.numerator) / number.denominator

    length = context.sqrt(enclosed(direction[0] ** 2 + direction[1] ** 2))
    along = enclosed(x * direction[0] + y * direction[1]) / length
    across = enclosed(y * direction[0] - x * direction[1]) / length
    whole = Fraction(angle)
    count = max(1, math.ceil(abs(whole) / _PIECE))

    def state(number: int) -> State:
        time = enclosed(whole * number / count)
        cosine, sine = context.cos(time), context.sin(time)
        slope = across * cosine - along * sine
        return _fractions(plain, along * cosine + across * sine), _fractions(plain, slope if whole >= 0 else -slope)

    last = state(0)
    for number in range(1, count + 1):
        here = state(number)
        yield last, here
        last = here


def _extremes(left: State, right: State, reach: Enclosure) -> tuple[Enclosure, Enclosure]:
    """Return enclosures of the least and the largest e over one piece."""
    (e0, slope0), (e1, slope1) = left, right
    high = _summit(e0, e1, slope0, slope1, reach)
    low = _negative(_summit(_negative(e0), _negative(e1), _negative(slope0), _negative(slope1), reach))
    return low, high


def _summit(e0: Enclosure, e1: Enclosure, slope0: Enclosure, slope1: Enclosure, reach: Enclosure) -> Enclosure:
    """Enclose the largest ρ cos over less than half a turn: ρ if the slope turns from + to −, else at an end."""
    ends = (max(e0[0], e1[0]), max(e0[1], e1[1]))
    if slope0[0] > 0 > slope1[1]:
        return reach
    if slope0[1] <= 0 or slope1[0] >= 0:
        return ends
    return ends[0], max(ends[1], reach[1])


def _all_along(rationals: tuple[Fraction, ...], least: Enclosure, largest: Enclosure, bits: int) -> Position | None:
    """Return the position on the whole turn, CONTACT if there is contact, None if the enclosures do not tell."""

    def at(squared: Fraction, *, up: bool) -> Position:
        return _position(rationals, _root(squared, bits)[up])

    if at(least[0], up=False) is Position.EXTERIOR:
        return Position.EXTERIOR
    if at(largest[1], up=True) is Position.INTERIOR:
        return Position.INTERIOR
    met = at(least[1], up=True) is not Position.EXTERIOR and at(largest[0], up=False) is not Position.INTERIOR
    return Position.CONTACT if met else None


def _position(rationals: tuple[Fraction, ...], radius: Fraction) -> Position:
    """Return the exact position at this distance from the axis."""
    alpha, gamma, b, d, _, _, z = rationals
    wide, thick, far = to_integers((alpha, b, radius))
    tall, thin, high = to_integers((gamma, d, z))
    return exact.position(Lengths(wide, thick, far, 0, tall, thin, high))


def _root(square: Fraction, bits: int) -> Enclosure:
    """Return an enclosure of the square root, to about `bits` bits; a negative number counts as 0."""
    square = max(square, Fraction(0))
    return root_of(square, bits), root_of(square, bits, upward=True)


def _fractions(context: MPContext, enclosure: ivmpf) -> Enclosure:
    """Return the ends of an interval of mpmath, exactly."""
    low, high = (context.mpf(end) for end in (enclosure.a, enclosure.b))
    return fraction(low), fraction(high)


def _negative(enclosure: Enclosure) -> Enclosure:
    """Return the enclosure of the negative number."""
    return -enclosure[1], -enclosure[0]
