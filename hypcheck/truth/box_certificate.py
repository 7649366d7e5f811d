"""One certificate that holds for every centre and axis of a box: proof that no change in it makes an answer right.

The proofs (box_proofs.py) are in intervals of mpmath, with 256 bits. A box too large for one certificate is cut in
halves along the number that costs most.
"""

from __future__ import annotations

from fractions import Fraction

from mpmath import MPContext, MPIntervalContext, mpf
from mpmath.ctx_iv import ivmpf

from hypcheck.truth.box_proofs import BoxKind, Form, Goal, Margin, Place
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


def margin(sizes: Row, rest: Row, goal: Goal) -> Margin:
    """The margin on the goal's side of a row in plain numbers of 256 bits: its sizes, and its centre and axis."""
    form = Form([_number(plain, size) for size in sizes], plain.sqrt)
    hint = _number(plain, multiplier((*sizes, *rest)))
    return Margin(form, int(goal.side), hint, *_centre_and_axis(plain, rest))


def certified(sizes: Row, box: Box, goal: Goal, cuts: int) -> bool:
    """Whether the goal is shown not to be attained with these sizes, centres and axes."""
    middle, radii = tuple((low + high) / 2 for low, high in box), [(high - low) / 2 for low, high in box]
    pull = [goal.sign * slope for slope in margin(sizes, middle, goal).derivatives()]
    corner = tuple(high if slope > 0 else low for slope, (low, high) in zip(pull, box, strict=True))
    if margin(sizes, corner, goal).excluded(_place(sizes, middle, radii), leave=goal.leave):
        return True
    if not cuts:
        return False
    cost = [abs(slope) * float(radius) for slope, radius in zip(pull, radii, strict=True)]
    cut = max(range(6), key=lambda index: cost[index])
    low, high = box[cut]
    halves = [(low, middle[cut]), (middle[cut], high)]
    if pull[cut] > 0:
        halves.reverse()  # the more doubtful half first
    return all(certified(sizes, [*box[:cut], half, *box[cut + 1 :]], goal, cuts - 1) for half in halves)


def _place(sizes: Row, middle: Row, radii: list[Fraction]) -> Place:
    """A box in intervals."""
    points, reach = [_number(iv, part) for part in middle], [_number(iv, part) for part in radii]
    whole = [part + iv.mpf([-1, 1]) * radius for part, radius in zip(points, reach, strict=True)]
    form = Form([_number(iv, part) for part in sizes], iv.sqrt)
    return Place(KIND, form, (points[:3], points[3:]), (whole[:3], whole[3:]), [KIND.high(part) for part in reach])


def _centre_and_axis(context: MPContext | MPIntervalContext, row: Row) -> tuple[Intervals, Intervals]:
    numbers = [_number(context, number) for number in row]
    return numbers[:3], numbers[3:]


def _number(context: MPContext | MPIntervalContext, number: Fraction) -> ivmpf | mpf:
    return context.mpf(number.numerator) / number.denominator
