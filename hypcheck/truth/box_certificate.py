"""One certificate for every centre and axis of a box: it proves that no change in the box makes an answer right.

The proofs (box_proofs.py) are in intervals of mpmath, with 256 bits. A box too large for one certificate is cut in
halves along the number that loosens the bounds most.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from mpmath import MPContext, MPIntervalContext, mpf
from mpmath.ctx_iv import ivmpf

from hypcheck.geometry.arithmetic import dot
from hypcheck.truth.box_proofs import SHARES, BoxKind, Form, Goal, Margin, Place, stays_clear, stays_off
from hypcheck.truth.nearest import multiplier

Row = tuple[Fraction, ...]
Intervals = list[ivmpf]

iv, plain = MPIntervalContext(), MPContext()
iv.prec = plain.prec = 256

KIND = BoxKind(
    between=lambda low, high: iv.mpf([low, high]),
    root=iv.sqrt,
    low=lambda enclosure: plain.mpf(enclosure.a),
    high=lambda enclosure: plain.mpf(enclosure.b),
    size=lambda enclosure: max(abs(plain.mpf(enclosure.a)), abs(plain.mpf(enclosure.b))),
    safe=1 + plain.mpf(2) ** -200,
    nothing=0,
    tiny=plain.mpf(2) ** -200,
)
"""Intervals of mpmath. Plain numbers have as many bits, and no limits of exponents."""

Box = list[tuple[Fraction, Fraction]]
"""The centre's coordinates and the axis's, each from the first number to the second."""


def margin_at(sizes: Row, rest: Row, goal: Goal) -> Margin:
    """Return the margin on the goal's side at one row."""
    form, (C, v) = Form([_number(plain, size) for size in sizes], plain.sqrt), _centre_and_axis(plain, rest)
    hint = multiplier((*sizes, *rest))
    for share in SHARES if hint * goal.side > 0 else ():
        at = _number(plain, hint * Fraction(share))
        nearest = form.nearest(at, C, v)
        if nearest is not None:
            return Margin(form, C, v, nearest[0], at, at)
    return Margin(form, C, v, C, plain.mpf(0), int(goal.side))


def certified(sizes: Row, box: Box, goal: Goal, cuts: int) -> bool:
    """Decide whether it is proved that the goal is not attained with these sizes, centres and axes."""
    middle, radii = tuple((low + high) / 2 for low, high in box), [(high - low) / 2 for low, high in box]
    pull = [goal.sign * slope for slope in margin_at(sizes, middle, goal).derivatives()]
    corner = tuple(high if slope > 0 else low for slope, (low, high) in zip(pull, box, strict=True))
    if _held(sizes, margin_at(sizes, corner, goal), goal, middle, radii):
        return True
    if not cuts:
        return False
    cost = [abs(slope) * float(radius) for slope, radius in zip(pull, radii, strict=True)]
    cut = max(range(6), key=lambda index: cost[index])
    low, high = box[cut]
    halves = [(low, middle[cut]), (middle[cut], high)]
    if pull[cut] > 0:
        halves.reverse()  # the half with the smaller margin first
    return all(certified(sizes, [*box[:cut], half, *box[cut + 1 :]], goal, cuts - 1) for half in halves)


def _held(sizes: Row, worst: Margin, goal: Goal, middle: Row, radii: list[Fraction]) -> bool:
    """Decide whether the certificate of the worst corner excludes the goal in the whole box."""
    points, reach = [_number(iv, part) for part in middle], [_number(iv, part) for part in radii]
    whole = [part + iv.mpf([-1, 1]) * radius for part, radius in zip(points, reach, strict=True)]
    form = Form([_number(iv, part) for part in sizes], iv.sqrt)
    place = Place(KIND, form, (points[:3], points[3:]), (whole[:3], whole[3:]), [KIND.high(part) for part in reach])
    if goal.leave:
        return bool(stays_clear(place, worst.at))
    side = int(goal.side)
    direction = [-side * part for part in worst.n]
    return bool(stays_off(place, side, direction, _shares_of_radius(worst, direction)))


def _shares_of_radius(worst: Margin, q: Intervals) -> Iterator[mpf]:
    """Yield the parts of a radius to try along Σq, the direction of the spheroid's point that is farthest along q.

    They are 1, the middle between the nearest point of the hyperboloid and 1, and the place, if it is before 1, from
    which on h no longer falls.
    """
    form, one = worst.form, plain.mpf(1)
    width = form.width(worst.v, q)
    if not width:  # at the hyperboloid's centre h falls or rises in no direction
        return
    yield one
    yield (1 + min(abs(worst.at * width), one)) / 2
    step = [part / width for part in form.sigma_times(worst.v, q)]
    bend = form.gradient(step)
    turn = -dot(bend, worst.C) / (dot(bend, step) or one)
    if 0 < turn < 1:
        yield turn


def _centre_and_axis(context: MPContext | MPIntervalContext, row: Row) -> tuple[Intervals, Intervals]:
    """Convert six rationals to the context's numbers: the centre and the axis."""
    numbers = [_number(context, number) for number in row]
    return numbers[:3], numbers[3:]


def _number(context: MPContext | MPIntervalContext, number: Fraction) -> ivmpf | mpf:
    """Convert a rational to a number of the context, or an interval."""
    return context.mpf(number.numerator) / number.denominator
