"""One certificate for every centre and axis of a box: it proves that no change in the box makes an answer right.

The proofs (box_proofs.py) are in intervals of mpmath, with 256 bits. A box too large for one certificate is cut in
halves along the number that loosens the bounds most.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from mpmath import MPContext, MPIntervalContext, mpf
from mpmath.ctx_iv import ivmpf

from hypcheck.geometry.arithmetic import cross, dot
from hypcheck.truth.box_proofs import BoxKind, Form, Goal, Place, squares, stays_clear, stays_off
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


_SHARES = (Fraction(1), 1 - Fraction(1, 1 << 20), Fraction(1, 2))
"""Shares of the λ hinted at that are tried where M + λD is not seen to be definite there."""


class State:
    """The margin on the goal's side and its derivatives at one row, in plain numbers, without a proof.

    Where φ is largest on the goal's side, the margin is that maximum. Elsewhere λ is 0 and the margin φ₀ = −1, and the
    derivatives are those of h at the centre, which has to change its sign first.
    """

    def __init__(self, sizes: Row, rest: Row, goal: Goal) -> None:
        self.sizes, self.side = sizes, int(goal.side)
        self.form = Form([_number(plain, size) for size in sizes], plain.sqrt)
        self.C, self.v = _centre_and_axis(plain, rest)
        hint, nearest = multiplier((*sizes, *rest)), None
        for share in _SHARES if hint * self.side > 0 else ():
            self.at = _number(plain, hint * share)
            nearest = self.form.nearest(self.at, self.C, self.v)
            if nearest is not None:
                break
        self.at = plain.mpf(0) if nearest is None else self.at
        self.X = self.C if nearest is None else nearest[0]
        self.n = self.form.gradient(self.X)
        self.factor = 2 * (self.side if nearest is None else self.at)

    def value(self) -> mpf:
        """The margin: λ² nᵀ Σ n − 1 + λ h(X)."""
        return (self.at * self.form.width(self.v, self.n)) ** 2 - 1 + self.at * self.form.hyperboloid(self.X)

    def derivatives(self) -> list[mpf]:
        """The margin's derivatives by the centre and the axis."""
        by_axis = self.form.by_axis(self.v, self.n, self.n)
        return [*(self.factor * part for part in self.n), *(-(self.at**2) * part for part in by_axis)]

    def size_derivatives(self) -> list[mpf]:
        """The margin's derivatives by the logarithms of the sizes."""
        terms = [self.factor * a * b for a, b in zip(self.n, self.X, strict=True)]
        square = 2 * self.at**2 / dot(self.v, self.v)
        thick = square * self.form.b2 * squares(cross(self.v, self.n))
        along = square * self.form.d2 * dot(self.v, self.n) ** 2
        return [terms[0] + terms[1], terms[2], thick, along]


def certified(sizes: Row, box: Box, goal: Goal, cuts: int) -> bool:
    """Whether it is proved that the goal is not attained with these sizes, centres and axes."""
    middle, radii = tuple((low + high) / 2 for low, high in box), [(high - low) / 2 for low, high in box]
    pull = [goal.sign * slope for slope in State(sizes, middle, goal).derivatives()]
    corner = tuple(high if slope > 0 else low for slope, (low, high) in zip(pull, box, strict=True))
    worst = State(sizes, corner, goal)
    if _held(worst, goal, middle, radii):
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


def _held(worst: State, goal: Goal, middle: Row, radii: list[Fraction]) -> bool:
    """Whether the certificate of the worst corner excludes the goal in the whole box."""
    points, reach = [_number(iv, part) for part in middle], [_number(iv, part) for part in radii]
    whole = [part + iv.mpf([-1, 1]) * radius for part, radius in zip(points, reach, strict=True)]
    form = Form([_number(iv, part) for part in worst.sizes], iv.sqrt)
    place = Place(KIND, form, (points[:3], points[3:]), (whole[:3], whole[3:]), [KIND.high(part) for part in reach])
    if goal.leave:
        return bool(stays_clear(place, worst.at))
    return bool(stays_off(place, worst.side, [-worst.side * part for part in worst.n], _shares_of_radius(worst)))


def _shares_of_radius(worst: State) -> Iterator[mpf]:
    """The shares of a radius to try along Σq: all, the middle to the hyperboloid, or up to where h turns before."""
    form, one, q = worst.form, plain.mpf(1), [-worst.side * part for part in worst.n]
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
    numbers = [_number(context, number) for number in row]
    return numbers[:3], numbers[3:]


def _number(context: MPContext | MPIntervalContext, number: Fraction) -> ivmpf | mpf:
    return context.mpf(number.numerator) / number.denominator
