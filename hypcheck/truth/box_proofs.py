"""The proofs that one certificate holds for every centre and axis of a box, in enclosures of any kind.

With s and h the two surfaces' equations and φ_λ = min over X of s(X) + λ h(X), a clear pair stays clear where φ_λ > 0
for one λ. A pair stays off a side where one point of the spheroid, given by the spheroid's centre and axis, does. Both
are bounded by their value in the middle of the box and their derivatives over the box. The bounds are sharper for
smaller boxes: the derivatives of sup φ_λ are those of s + λh at the nearest point, where each number enters s or h
alone, so that the best corner and the best certificate belong together.

First what a change is to achieve (`Goal`) and the form of a pair in numbers of any kind with + − · / and a square root.
An enclosure is an interval of mpmath (box_certificate.py), or float64 intervals of many rows (float_boxes.py); then
every statement holds for each row. A comparison with NaN gives no proof.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from hypcheck.geometry.arithmetic import adjugate, cross, dot
from hypcheck.geometry.pair import Position

Signs = tuple[int, ...]
Number = Any
"""A number of one kind."""

Vector = list[Any]
"""Three numbers of one kind."""


@dataclass(frozen=True, slots=True)
class Goal:
    """The goal of a change: the row's position becomes `side`, or, with `leave`, is no longer `side`."""

    side: Position
    leave: bool

    @property
    def sign(self) -> int:
        """Whether φ on that side has to grow (+1) or to fall (−1)."""
        return -1 if self.leave else 1

    @property
    def sizes(self) -> Signs:
        """The directions in which changes of α, γ, b, d help: up or down."""
        wide, tall = (-1, 1) if self.side is Position.EXTERIOR else (1, -1)
        return tuple(self.sign * part for part in (wide, tall, -1, -1))


class Form:
    """The two surfaces for fixed sizes, in numbers of one kind, such as intervals; centre C and axis v are given later.

    Intervals give proofs (box_certificate.py, float_boxes.py); plain numbers only find good places for them. `root` is
    the square root of a number of that kind.

    Σ = M⁻¹ = b² I + (d² − b²) v vᵀ/(v·v) replaces M wherever possible: its entries change with the axis as much as the
    spheroid does, the entries of M much more if the spheroid is thin.
    """

    def __init__(self, sizes: Vector, root: Callable[[Any], Any]) -> None:
        alpha, gamma, b, d = sizes
        self.root = root
        self.D = [1 / alpha**2, 1 / alpha**2, -1 / gamma**2]
        self.b2, self.d2 = b**2, d**2

    def hyperboloid(self, X: Vector) -> Number:
        """Return h(X), the left side of the hyperboloid's equation h = 0."""
        return self.D[0] * X[0] ** 2 + self.D[1] * X[1] ** 2 + self.D[2] * X[2] ** 2 - 1

    def gradient(self, X: Vector) -> Vector:
        """Return half the gradient of the quadratic form h at X, which is D X."""
        return [a * b for a, b in zip(self.D, X, strict=True)]

    def sigma(self, v: Vector) -> list[Vector]:
        """Return the matrix Σ for the axis v."""
        factor = (self.d2 - self.b2) / dot(v, v)
        return [[(i == j) * self.b2 + factor * v[i] * v[j] for j in range(3)] for i in range(3)]

    def sigma_times(self, v: Vector, q: Vector) -> Vector:
        """Return Σ q, from the parts of q along v and across."""
        along = self.d2 * dot(v, q) / dot(v, v)
        return [self.b2 * p + along * part for p, part in zip(across(v, q), v, strict=True)]

    def width(self, v: Vector, q: Vector) -> Number:
        """Return √(qᵀ Σ q): the spheroid's half width along q, times |q|."""
        aside = cross(v, q)
        return self.root((self.b2 * squares(aside) + self.d2 * dot(v, q) ** 2) / squares(v))

    def by_axis(self, v: Vector, q: Vector, n: Vector) -> Vector:
        """Return the derivatives of nᵀ Σ q by the axis."""
        square = dot(v, v)
        q_part, n_part = (self.d2 - self.b2) * dot(v, n) / square, (self.d2 - self.b2) * dot(v, q) / square
        return [q_part * a + n_part * b for a, b in zip(across(v, q), across(v, n), strict=True)]

    def pencil(self, at: Number, v: Vector) -> tuple[list[Vector], list[Vector], Vector]:
        """Return M, the adjugate of M + λD, and its leading minors, the determinant last; `at` is λ."""
        square = dot(v, v)
        excess = (1 / self.d2 - 1 / self.b2) / square
        M = [[(i == j) / self.b2 + excess * v[i] * v[j] for j in range(3)] for i in range(3)]
        G = [[M[i][j] + (i == j) * at * self.D[i] for j in range(3)] for i in range(3)]
        adjoint = adjugate(G)
        return M, adjoint, [G[0][0], adjoint[2][2], dot(G[0], adjoint[0])]

    def nearest(self, at: Number, C: Vector, v: Vector) -> tuple[Vector, list[Vector]] | None:
        """Return X with (1 + λ Σ D) X = C and the matrix's inverse; None unless M + λD is proved positive definite."""
        M, adjoint, minors = self.pencil(at, v)
        if not all(part > 0 for part in minors):  # for an interval: each of its numbers
            return None
        inverse = [[dot(row, column) / minors[2] for column in M] for row in adjoint]
        return [dot(row, C) for row in inverse], inverse


def squares(p: Vector) -> Number:
    """Return the squared length of p; as an interval it does not reach below 0."""
    return p[0] ** 2 + p[1] ** 2 + p[2] ** 2


def across(v: Vector, q: Vector) -> Vector:
    """Return the part of q across v, (v × q) × v/(v·v)."""
    square = squares(v)
    return [part / square for part in cross(cross(v, q), v)]


@dataclass(frozen=True, slots=True)
class Margin:
    """The margin on a side and its derivatives at one row, in plain numbers: it finds places for proofs.

    Where φ is largest on that side, λ = `at` and the margin is that maximum, X being the nearest point. Elsewhere λ is
    0, X the centre, and the margin φ₀ = −1; the derivatives are those of h at the centre, which has to change its sign
    first: `weight` is λ, or the side where λ is 0.
    """

    form: Form
    C: Vector
    v: Vector
    X: Vector
    at: Number
    weight: Number

    @property
    def n(self) -> Vector:
        """D X."""
        return self.form.gradient(self.X)

    def value(self) -> Number:
        """Return the margin: λ² nᵀ Σ n − 1 + λ h(X)."""
        return (self.at * self.form.width(self.v, self.n)) ** 2 - 1 + self.at * self.form.hyperboloid(self.X)

    def derivatives(self) -> Vector:
        """Return the margin's derivatives by the centre and the axis."""
        n = self.n
        by_axis = self.form.by_axis(self.v, n, n)
        return [*(2 * self.weight * part for part in n), *(-(self.at**2) * part for part in by_axis)]

    def size_derivatives(self) -> Vector:
        """Return the margin's derivatives by the logarithms of the sizes."""
        n = self.n
        terms = [2 * self.weight * a * b for a, b in zip(n, self.X, strict=True)]
        square = 2 * self.at**2 / dot(self.v, self.v)
        thick = square * self.form.b2 * squares(cross(self.v, n))
        along = square * self.form.d2 * dot(self.v, n) ** 2
        return [terms[0] + terms[1], terms[2], thick, along]


SHARES = (1.0, 1 - 2.0**-20, 0.5)
"""Factors of the hinted λ, tried in this order until M + λD is seen to be definite."""


@dataclass(frozen=True, slots=True)
class BoxKind:
    """The operations of one kind of enclosure.

    `between` makes an enclosure from two ends, `root` takes its square root; `low`, `high` and `size`, the largest
    absolute value, return plain numbers. `safe` is a factor that exceeds the rounding of a sum of a few positive
    products of plain numbers, `nothing` exceeds the loss by underflow, `tiny` is a small factor that still changes a
    product.
    """

    between: Callable[[Any, Any], Any]
    root: Callable[[Any], Any]
    low: Callable[[Any], Any]
    high: Callable[[Any], Any]
    size: Callable[[Any], Any]
    safe: Number
    nothing: Number
    tiny: Number

    def exactly(self, number: Number) -> Number:
        """Return the enclosure of a plain number."""
        return self.between(number, number)


@dataclass(frozen=True, slots=True)
class Place:
    """A box: the form of its sizes, its middle and its whole range (centre and axis); `radii` reach to its ends."""

    kind: BoxKind
    form: Form
    middle: tuple[Vector, Vector]
    whole: tuple[Vector, Vector]
    radii: Vector

    def spread(self, slopes: Iterable[Number]) -> Number:
        """Return a bound of a function's change from the middle to any place in the box."""
        terms = [self.kind.size(slope) * radius for slope, radius in zip(slopes, self.radii, strict=True)]
        return self.kind.safe * sum(terms[1:], terms[0]) + self.kind.nothing


def stays_clear(place: Place, multiplier: Number) -> Any:  # noqa: ANN401 - a bool, or one of each row
    """Decide whether φ at this λ is proved > 0 for every centre and axis of the box.

    Its derivatives are 2λ n by the centre and −λ² times those of nᵀ Σ n by the axis, n = D X held fixed there.
    """
    kind, form, (C0, v0), (_, v) = place.kind, place.form, place.middle, place.whole
    at = kind.exactly(multiplier)
    M, adjugate, minors = form.pencil(at, v0)
    definite = (multiplier != 0) & (np.min([kind.low(minor) for minor in minors], axis=0) > 0)
    if not np.any(definite):
        return definite
    inverse = [[dot(row, column) / minors[2] for column in M] for row in adjugate]
    X0 = [dot(row, C0) for row in inverse]
    reach, regular = _reach(place, at, X0, inverse)
    n0 = form.gradient(X0)
    value = (at * form.width(v0, n0)) ** 2 - 1 + at * form.hyperboloid(X0)
    n = form.gradient([a + kind.between(-r, r) for a, r in zip(X0, reach, strict=True)])
    slopes = [*(2 * at * part for part in n), *(at**2 * part for part in form.by_axis(v, n, n))]
    return definite & regular & (kind.low(value) > place.spread(slopes))


def _reach(place: Place, at: Number, X0: Vector, R: list[Vector]) -> tuple[Vector, Any]:
    """Find Δ > 0 such that in the whole box X is within Δ of X0 and M + λD is definite; and whether this is proved.

    With A = 1 + λ Σ D, A X = C, it is enough that |R (C − A X0)| + |1 − R A| Δ < Δ, R being the inverse of A in the
    middle (Rump): then A is regular for every axis of the box, and M + λD definite as it is in the middle.
    """
    kind, form, (C, v) = place.kind, place.form, place.whole
    image, sigma = form.sigma_times(v, form.gradient(X0)), form.sigma(v)
    rest = [C[i] - X0[i] - at * image[i] for i in range(3)]
    columns = [[int(i == j) + at * sigma[i][j] * form.D[j] for i in range(3)] for j in range(3)]
    shift = [kind.size(dot(row, rest)) for row in R]
    defect = [[kind.size(int(i == j) - dot(R[i], columns[j])) for j in range(3)] for i in range(3)]
    farthest, largest = np.max(shift, axis=0), np.max([kind.size(part) for part in X0], axis=0)
    least = (farthest + largest * kind.tiny) * kind.tiny + kind.nothing
    reach, regular = [2 * part + least for part in shift], np.False_
    for _ in range(3):
        needed = [
            kind.safe * (shift[i] + sum(defect[i][j] * reach[j] for j in range(3))) + kind.nothing for i in range(3)
        ]
        regular = regular | np.all([a < b for a, b in zip(needed, reach, strict=True)], axis=0)
        reach = [np.where(regular, b, 2 * a + least)[()] for a, b in zip(needed, reach, strict=True)]
    return reach, regular


def stays_off(place: Place, side: Number, direction: Vector, shares: Iterable[Number]) -> Any:  # noqa: ANN401
    """Decide whether a point of the spheroid is proved off a side for every centre and axis of the box.

    The point is the centre, or C + ρ Σq/√(qᵀΣq), ρ ≤ 1 one of the shares, which turns with the axis and stays in the
    spheroid; for ρ = 1 it is the spheroid's farthest in the fixed direction q.
    """
    kind, form, (_, v0), (C, v) = place.kind, place.form, place.middle, place.whole
    zero = [kind.exactly(0 * radius) for radius in place.radii[:3]]
    q = [kind.exactly(part) for part in direction]
    proved = _crosses(place, side, zero, zero, zero)
    for share in shares:
        if np.all(proved):
            break
        rho = kind.exactly(share)
        scale0, scale = (rho / form.width(axis, q) for axis in (v0, v))
        offset0 = [scale0 * part for part in form.sigma_times(v0, q)]
        offset = [scale * part for part in form.sigma_times(v, q)]
        n = form.gradient([a + b for a, b in zip(C, offset, strict=True)])
        fall = dot(n, offset) * (scale / rho) ** 2 / 2
        by_axis = zip(form.by_axis(v, q, n), form.by_axis(v, q, q), strict=True)
        proved = proved | _crosses(place, side, offset0, offset, [scale * a - fall * b for a, b in by_axis])
    return proved


def _crosses(place: Place, side: Number, offset0: Vector, offset: Vector, by_axis: Vector) -> Any:  # noqa: ANN401
    """Decide whether h at centre + offset is off a side in the whole box; by_axis are the derivatives of half h."""
    form, (C0, _), (C, _) = place.form, place.middle, place.whole
    height = side * form.hyperboloid([a + b for a, b in zip(C0, offset0, strict=True)])
    n = form.gradient([a + b for a, b in zip(C, offset, strict=True)])
    return place.kind.high(height) + place.spread([*(2 * part for part in n), *(2 * part for part in by_axis)]) <= 0
