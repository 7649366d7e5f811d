"""One certificate that holds for every centre and axis of a box: proof that no change in it makes an answer right.

With s and h the two surfaces' equations and φ_λ = min over X of s(X) + λ h(X), a clear pair stays clear where φ_λ > 0
for one λ. A pair stays off a side where one point of the spheroid, given by the spheroid's centre and axis, does. Both
are bounded by their value in the middle of the box and their derivatives over the box, in intervals (mpmath, 256 bits).
They are as sharp as the box is small: the derivatives of sup φ_λ are those of s + λh at the nearest point, where each
number enters s or h alone, so that the best corner and the best certificate belong together. A box too large for one
certificate is cut in halves along the number that costs most.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mpmath import MPContext, MPIntervalContext, mpf
from mpmath.ctx_iv import ivmpf

from hypcheck.geometry.pair import Position
from hypcheck.truth.tilted.nearest import multiplier

Row = tuple[Fraction, ...]
Signs = tuple[int, ...]
Intervals = list[ivmpf]

iv, plain = MPIntervalContext(), MPContext()
iv.prec = plain.prec = 256


@dataclass(frozen=True, slots=True)
class Goal:
    """What a change is to achieve: the row's position becomes `side`, or, with `leave`, is no longer `side`."""

    side: Position
    leave: bool

    @property
    def sign(self) -> int:
        """Whether φ on that side has to grow (+1) or to fall (−1)."""
        return -1 if self.leave else 1

    @property
    def sizes(self) -> Signs:
        """Which way α, γ, b, d help: up or down."""
        wide, tall = (-1, 1) if self.side is Position.EXTERIOR else (1, -1)
        return tuple(self.sign * each for each in (wide, tall, -1, -1))


Box = list[tuple[Fraction, Fraction]]
"""The centre's coordinates and the axis's, each from the first number to the second."""


class Form:
    """The two surfaces for fixed sizes, in numbers of one kind, such as intervals; centre C and axis v are given later.

    Intervals prove; plain numbers of as many bits point the way. Other kinds serve as well: float64 intervals of many
    rows (float_boxes.py), and floats, for a hint.

    Σ = M⁻¹ = b² I + (d² − b²) v vᵀ/(v·v) stands for M wherever it can: its entries change with the axis as much as the
    spheroid does, those of M much more where the spheroid is thin.
    """

    def __init__(self, sizes: Intervals, root: Callable[[Any], Any] = iv.sqrt) -> None:
        alpha, gamma, b, d = sizes
        self.root = root
        self.D = [1 / alpha**2, 1 / alpha**2, -1 / gamma**2]
        self.b2, self.d2 = b**2, d**2

    def hyperboloid(self, X: Intervals) -> ivmpf:
        """h."""
        return self.D[0] * X[0] ** 2 + self.D[1] * X[1] ** 2 + self.D[2] * X[2] ** 2 - 1

    def gradient(self, X: Intervals) -> Intervals:
        """Half the gradient of h, D X."""
        return [a * b for a, b in zip(self.D, X, strict=True)]

    def sigma(self, v: Intervals) -> list[Intervals]:
        """Σ."""
        factor = (self.d2 - self.b2) / dot(v, v)
        return [[(i == j) * self.b2 + factor * v[i] * v[j] for j in range(3)] for i in range(3)]

    def sigma_times(self, v: Intervals, q: Intervals) -> Intervals:
        """Σ q, from the parts of q along v and across."""
        along = self.d2 * dot(v, q) / dot(v, v)
        return [self.b2 * p + along * each for p, each in zip(across(v, q), v, strict=True)]

    def width(self, v: Intervals, q: Intervals) -> ivmpf:
        """√(qᵀ Σ q): how far the spheroid reaches along q, times |q|."""
        aside = cross(v, q)
        return self.root((self.b2 * squares(aside) + self.d2 * dot(v, q) ** 2) / squares(v))

    def by_axis(self, v: Intervals, q: Intervals, n: Intervals) -> Intervals:
        """The derivatives of nᵀ Σ q by the axis."""
        square = dot(v, v)
        q_part, n_part = (self.d2 - self.b2) * dot(v, n) / square, (self.d2 - self.b2) * dot(v, q) / square
        return [q_part * a + n_part * b for a, b in zip(across(v, q), across(v, n), strict=True)]

    def pencil(self, at: ivmpf, v: Intervals) -> tuple[list[Intervals], list[Intervals], Intervals]:
        """M, the adjugate of M + λD, and its leading minors, the determinant last."""
        square = dot(v, v)
        excess = (1 / self.d2 - 1 / self.b2) / square
        M = [[(i == j) / self.b2 + excess * v[i] * v[j] for j in range(3)] for i in range(3)]
        G = [[M[i][j] + (i == j) * at * self.D[i] for j in range(3)] for i in range(3)]
        adjugate = [cross(G[1], G[2]), cross(G[2], G[0]), cross(G[0], G[1])]
        return M, adjugate, [G[0][0], adjugate[2][2], dot(G[0], adjugate[0])]

    def nearest(self, at: ivmpf, C: Intervals, v: Intervals) -> tuple[Intervals, list[Intervals]] | None:
        """X with (1 + λ Σ D) X = C and the matrix's inverse; None where M + λD is not shown to be positive definite."""
        M, adjugate, minors = self.pencil(at, v)
        if not all(each > 0 for each in minors):  # of an interval: each of its numbers
            return None
        inverse = [[dot(row, column) / minors[2] for column in M] for row in adjugate]
        return [dot(row, C) for row in inverse], inverse


_SHARES = (Fraction(1), 1 - Fraction(1, 1 << 20), Fraction(1, 2))
"""Shares of the λ hinted at that are tried where M + λD is not seen to be definite there."""


class State:
    """The margin on the goal's side and its derivatives at one row, in plain numbers, which prove nothing.

    Where φ is largest on the goal's side, the margin is that maximum. Elsewhere λ is 0 and the margin φ₀ = −1, and the
    derivatives are those of h at the centre, which has to change its sign first.
    """

    def __init__(self, sizes: Row, rest: Row, goal: Goal) -> None:
        self.sizes, self.side = sizes, int(goal.side)
        self.form = Form([_number(plain, each) for each in sizes], plain.sqrt)
        self.C, self.v = _centre_and_axis(plain, rest)
        hint, found = multiplier((*sizes, *rest)), None
        for share in _SHARES if hint * self.side > 0 else ():
            self.at = _number(plain, hint * share)
            found = self.form.nearest(self.at, self.C, self.v)
            if found is not None:
                break
        self.at = plain.mpf(0) if found is None else self.at
        self.X = self.C if found is None else found[0]
        self.n = self.form.gradient(self.X)
        self.factor = 2 * (self.side if found is None else self.at)

    def value(self) -> mpf:
        """The margin: λ² nᵀ Σ n − 1 + λ h(X)."""
        return (self.at * self.form.width(self.v, self.n)) ** 2 - 1 + self.at * self.form.hyperboloid(self.X)

    def derivatives(self) -> list[mpf]:
        """The margin's derivatives by the centre and the axis."""
        by_axis = self.form.by_axis(self.v, self.n, self.n)
        return [*(self.factor * each for each in self.n), *(-(self.at**2) * each for each in by_axis)]

    def size_derivatives(self) -> list[mpf]:
        """The margin's derivatives by the logarithms of the sizes."""
        terms = [self.factor * a * b for a, b in zip(self.n, self.X, strict=True)]
        square = 2 * self.at**2 / dot(self.v, self.v)
        thick = square * self.form.b2 * squares(cross(self.v, self.n))
        along = square * self.form.d2 * dot(self.v, self.n) ** 2
        return [terms[0] + terms[1], terms[2], thick, along]


def certified(sizes: Row, box: Box, goal: Goal, cuts: int) -> bool:
    """Whether the goal is shown not to be attained with these sizes, centres and axes."""
    middle, radii = tuple((low + high) / 2 for low, high in box), [(high - low) / 2 for low, high in box]
    pull = [goal.sign * each for each in State(sizes, middle, goal).derivatives()]
    corner = tuple(high if each > 0 else low for each, (low, high) in zip(pull, box, strict=True))
    worst = State(sizes, corner, goal)
    if (_stays_clear if goal.leave else _stays_off)(worst, middle, radii):
        return True
    if not cuts:
        return False
    cost = [abs(each) * float(radius) for each, radius in zip(pull, radii, strict=True)]
    cut = max(range(6), key=lambda index: cost[index])
    low, high = box[cut]
    halves = [(low, middle[cut]), (middle[cut], high)]
    if pull[cut] > 0:
        halves.reverse()  # the more doubtful half first
    return all(certified(sizes, [*box[:cut], half, *box[cut + 1 :]], goal, cuts - 1) for half in halves)


def _stays_clear(worst: State, middle: Row, radii: list[Fraction]) -> bool:
    """Whether φ at the λ of the worst corner is > 0 for every centre and axis of the box.

    Its derivatives are 2λ n by the centre and −λ² times those of nᵀ Σ n by the axis, n = D X held fixed there.
    """
    form, at = _enclosed_form(worst.sizes), iv.mpf(worst.at)
    C0, v0 = _centre_and_axis(iv, middle)
    found = form.nearest(at, C0, v0) if worst.at else None
    if found is None:
        return False
    X0, inverse = found
    C, v = _over_box(middle, radii)
    reach = _reach(form, at, C, v, X0, inverse)
    if reach is None:
        return False
    n0 = form.gradient(X0)
    value = (at * form.width(v0, n0)) ** 2 - 1 + at * form.hyperboloid(X0)
    n = form.gradient([a + iv.mpf([-r, r]) for a, r in zip(X0, reach, strict=True)])
    slopes = [*(2 * at * each for each in n), *(at**2 * each for each in form.by_axis(v, n, n))]
    return bool(_low(value) > _spread(slopes, radii))


def _reach(form: Form, at: ivmpf, C: Intervals, v: Intervals, X0: Intervals, R: list[Intervals]) -> list[mpf] | None:
    """Δ > 0 such that X is within Δ of X0 over the whole box and M + λD definite there; None where none is found.

    With A = 1 + λ Σ D, A X = C, it is enough that |R (C − A X0)| + |1 − R A| Δ < Δ, R being the inverse of A in the
    middle (Rump): then A is regular for every axis of the box, and M + λD definite as it is in the middle.
    """
    image = form.sigma_times(v, form.gradient(X0))
    rest = [C[i] - X0[i] - at * image[i] for i in range(3)]
    sigma = form.sigma(v)
    columns = [[(i == j) + at * sigma[i][j] * form.D[j] for i in range(3)] for j in range(3)]
    shift = [_size(dot(row, rest)) for row in R]
    defect = [[_size((i == j) - dot(R[i], columns[j])) for j in range(3)] for i in range(3)]
    tiny = plain.mpf(2) ** -200
    least = max(shift) * tiny + max(map(_size, X0)) * tiny**2
    reach = [2 * each + least for each in shift]
    for _ in range(3):
        image_size = [shift[i] + sum(defect[i][j] * reach[j] for j in range(3)) for i in range(3)]
        if all(a * (1 + tiny) < b for a, b in zip(image_size, reach, strict=True)):
            return reach
        reach = [2 * each + least for each in image_size]
    return None


def _stays_off(worst: State, middle: Row, radii: list[Fraction]) -> bool:
    """Whether a point of the spheroid is not on the goal's side for any centre and axis of the box.

    The point is the centre, or C + ρ Σq/√(qᵀΣq), ρ ≤ 1, which turns with the axis and stays in the spheroid; for ρ = 1
    it is the spheroid's farthest in the fixed direction q.
    """
    form, side = _enclosed_form(worst.sizes), worst.side
    C0, v0 = _centre_and_axis(iv, middle)
    C, v = _over_box(middle, radii)
    zero = [iv.mpf(0)] * 3
    if _crosses(form, side, (C0, zero), (C, zero), zero, radii):
        return True
    q = [iv.mpf(-side * each) for each in worst.n]
    return any(
        _crosses(form, side, (C0, way0), (C, way), slopes, radii)
        for way0, way, slopes in (_outward(form, rho, q, v0, v, C) for rho in _shares_of_radius(worst))
    )


def _shares_of_radius(worst: State) -> Iterator[mpf]:
    """How far to go along Σq: to the end, half way there from the hyperboloid, or to where h turns before the end."""
    form, one, q = worst.form, plain.mpf(1), [-worst.side * each for each in worst.n]
    width = form.width(worst.v, q)
    if not width:  # at the hyperboloid's centre h falls or rises in no direction
        return
    yield one
    yield (1 + min(abs(worst.at * width), one)) / 2
    way = [each / width for each in form.sigma_times(worst.v, q)]
    bend = form.gradient(way)
    turn = -dot(bend, worst.C) / (dot(bend, way) or one)
    if 0 < turn < 1:
        yield turn


def _outward(
    form: Form, rho: mpf, q: Intervals, v0: Intervals, v: Intervals, C: Intervals
) -> tuple[Intervals, Intervals, Intervals]:
    """ρ Σq/√(qᵀΣq) for the middle axis and over the box, and the derivatives of half h there by the axis."""
    scale0, scale = (iv.mpf(rho) / form.width(each, q) for each in (v0, v))
    way0 = [scale0 * each for each in form.sigma_times(v0, q)]
    way = [scale * each for each in form.sigma_times(v, q)]
    n = form.gradient([a + b for a, b in zip(C, way, strict=True)])
    fall = dot(n, way) * (scale / iv.mpf(rho)) ** 2 / 2
    by_axis = zip(form.by_axis(v, q, n), form.by_axis(v, q, q), strict=True)
    return way0, way, [scale * a - fall * b for a, b in by_axis]


def _crosses(
    form: Form,
    side: int,
    middle: tuple[Intervals, Intervals],
    box: tuple[Intervals, Intervals],
    by_axis: Intervals,
    radii: list[Fraction],
) -> bool:
    """Whether h at the centre + a way is not on a side anywhere in the box."""
    height = side * form.hyperboloid([a + b for a, b in zip(*middle, strict=True)])
    n = form.gradient([a + b for a, b in zip(*box, strict=True)])
    return bool(_high(height) + _spread([*(2 * each for each in n), *(2 * each for each in by_axis)], radii) <= 0)


def _enclosed_form(sizes: Row) -> Form:
    return Form([_number(iv, each) for each in sizes])


def _centre_and_axis(context: MPContext | MPIntervalContext, row: Row) -> tuple[Intervals, Intervals]:
    numbers = [_number(context, each) for each in row]
    return numbers[:3], numbers[3:]


def _over_box(middle: Row, radii: list[Fraction]) -> tuple[Intervals, Intervals]:
    numbers = [_number(iv, a) + iv.mpf([-1, 1]) * _number(iv, r) for a, r in zip(middle, radii, strict=True)]
    return numbers[:3], numbers[3:]


def _spread(slopes: Intervals, radii: list[Fraction]) -> mpf:
    """An upper bound of how much a function can change from the middle of a box to anywhere in it."""
    total = iv.mpf(0)
    for slope, radius in zip(slopes, radii, strict=True):
        total += iv.mpf(_size(slope)) * _number(iv, radius)
    return _high(total)


def _number(context: MPContext | MPIntervalContext, number: Fraction) -> ivmpf | mpf:
    return context.mpf(number.numerator) / number.denominator


def _low(enclosure: ivmpf) -> mpf:
    return plain.mpf(enclosure.a)


def _high(enclosure: ivmpf) -> mpf:
    return plain.mpf(enclosure.b)


def _size(enclosure: ivmpf) -> mpf:
    """The largest absolute value in an interval."""
    return max(abs(_low(enclosure)), abs(_high(enclosure)))


def dot(p: Intervals, q: Intervals) -> ivmpf:
    """p·q."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def squares(p: Intervals) -> ivmpf:
    """p·p, not below 0."""
    return p[0] ** 2 + p[1] ** 2 + p[2] ** 2


def across(v: Intervals, q: Intervals) -> Intervals:
    """The part of q across v, (v × q) × v/(v·v)."""
    square = squares(v)
    return [each / square for each in cross(cross(v, q), v)]


def cross(p: Intervals, q: Intervals) -> Intervals:
    """p × q."""
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
