"""Sweeps beside a hyperboloid that ends: whether, and when, a spheroid on a sweep meets its wall or its discs.

Contact begins and ends when the spheroid E touches the wall or a disc without crossing it. The point of touch is

- on the wall between its ends: E is tangent to the whole hyperboloid, and the discriminant of F is 0 (sweep.py). Where
  it is 0 at all times, F has fewer roots still (below);
- on a rim: the circle just touches the ellipse of its plane, and Δ of the cubic g at that height is 0 (sections.py);
- within a disc: its plane is tangent to E, and k at that height is 0.

All of these are polynomials in the time t: the coefficients of g, and k, are quadratic in the centre and so in t. An
end of a tilted hyperboloid is at a height w √U, so that their coefficients are numbers u + v √U; then the product with
the conjugate polynomial is taken. Between two neighbouring roots of them all nothing changes, and one exact decision
finds it.

Enclosures of roots are narrowed step by step. Roots whose enclosures meet count as one cluster. A cluster between two
clear times is clear if a larger spheroid that contains E at all times of the cluster is clear. If this cannot be shown,
E touches for an instant, or a spheroid larger by 2^−_BITS[-1] of itself does; both count as contact.

**Where F has a double root at all times**, the point x(t) that belongs to it, on both surfaces, stays a point of touch
for all complex t. The derivative of e(x(t), t) = 0 says that the normal there is at right angles to the sweep's
direction u. So x(t), which moves, runs along the contour of the hyperboloid and that of E in this direction: both
bodies have one cylinder of tangents in common, and the centre goes along its axis. The planes of the two contours keep
their directions, and meet the cylinder in two points, x(t) and another, real or not. So S + λH has a kernel of
dimension two for the double root, which holds the direction n from one to the other, and no more as long as the root
is double. Two points of touch appear, or vanish, where they coincide: there the root is threefold. Others do where
another root becomes double. Either way F has fewer different roots than at most times (`root_changes`). As long as it
has not, the two points move continuously, and pass an end of the wall on its rim.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from hypcheck.geometry.arithmetic import QuadraticSurd
from hypcheck.geometry.pair import Position
from hypcheck.truth import exact
from hypcheck.truth.polynomials import (
    Interval,
    Polynomial,
    common_divisor,
    enclosures,
    polynomial_product,
    primitive,
    quotient,
    roots_from_0_to_1,
    squarefree,
)
from hypcheck.truth.sections import Sections
from hypcheck.truth.sweep import InTime, StraightSweep, norm_of

_BITS = (60, 120, 240)
"""Bits of the enclosures of roots, tried in this order until all clusters are decided.

An enclosure is at most 2^−bits of the sweep long, and so short that within it the spheroid moves by at most 2^−bits of
its size, however long the sweep is.
"""

START, END = Fraction(0), Fraction(1)


@dataclass(frozen=True)
class EndedSweep:
    """The sweep of a spheroid beside a hyperboloid that ends; or of smaller spheroids (`parts`) that move within it.

    With `parts` there is contact when the spheroid is in contact and its parts are not all clear on one side.
    """

    whole: StraightSweep
    parts: tuple[StraightSweep, ...] = ()

    def meets(self, time: Fraction) -> bool:
        """Decide whether there is contact at a rational time."""
        if self.whole.position(time) is not Position.CONTACT:
            return False
        return not self.parts or not _clear_on_one_side(part.position(time) for part in self.parts)

    def clear(self, first: Fraction, last: Fraction) -> bool:
        """Decide whether larger spheroids, which contain the moving ones, prove no contact between two times."""
        middle, half = (first + last) / 2, (last - first) / 2
        if _larger(self.whole, middle, half) is not Position.CONTACT:
            return True
        return bool(self.parts) and _clear_on_one_side(_larger(part, middle, half) for part in self.parts)

    @cached_property
    def critical(self) -> list[Polynomial]:
        """Polynomials in t, one of which is 0 wherever contact begins or ends."""
        polynomials: list[Polynomial] = []
        for sweep in (self.whole, *self.parts):
            polynomials += [sweep.root_changes(), *_at_ends(sweep, sides=bool(self.parts))]
        return polynomials

    def clusters(self, bits: int) -> list[Interval]:
        """Return disjoint intervals, shorter than 2^-bits spheroids, with all times at which contact begins or ends."""
        longest = max(_radii(sweep) for sweep in (self.whole, *self.parts))
        return _clusters(self.critical, bits + math.ceil(longest).bit_length())


def _clear_on_one_side(positions: Iterator[Position]) -> bool:
    """Decide whether all positions are the same, and not contact."""
    sides = set(positions)
    return len(sides) == 1 and Position.CONTACT not in sides


def _larger(sweep: StraightSweep, middle: Fraction, half: Fraction) -> Position:
    """Return the position of a spheroid that contains the moving one at all times about one.

    A spheroid moved by a vector is contained in the unmoved one enlarged by the vector's length in radii.
    """
    lengths, radii = sweep.at(middle), _radii(sweep) * half
    if not radii:
        return exact.position(lengths)
    bits = radii.denominator.bit_length() - radii.numerator.bit_length() - 1  # 2^−bits ≥ radii
    unit, more = (1 << bits, 1) if bits > 0 else (1, 1 << -bits)
    return exact.position(replace(lengths.finer(unit), b=lengths.b * (unit + more), d=lengths.d * (unit + more)))


def _radii(sweep: StraightSweep) -> Fraction:
    """Return an upper bound of the sweep's length in radii of the spheroid in the sweep's direction."""
    start, (u, v, w) = sweep.start, map(abs, sweep.step)
    if sweep.is_upright and start.upward == (0, 0, 1):
        return Fraction(u + v, start.b) + Fraction(w, start.d)
    return Fraction(u + v + w, min(start.b, start.d))


def first_contact(sweep: EndedSweep) -> Interval | None:
    """Return an enclosure of the time of first contact; None if there is no contact."""
    if sweep.meets(START):
        return START, START
    if not sweep.whole.moves or _clear_in_pieces(sweep):
        return None
    first: Interval | None = None
    for bits in _BITS:
        first, certain = _first_of(sweep, sweep.clusters(bits))
        if certain:
            break
    return first


def meets(sweep: EndedSweep) -> bool:
    """Decide whether there is contact: the result of first_contact, but faster if some time shows contact."""
    return any(sweep.meets(Fraction(time, 4)) for time in (0, 4, 2, 1, 3)) or first_contact(sweep) is not None


def grazes(sweep: StraightSweep) -> bool:
    """Decide whether all contact on a sweep with contact is a touch."""
    critical = EndedSweep(sweep).critical
    gaps = (time for time in _gaps(_clusters(critical, _BITS[0])) if time is not None)
    if any(_is_deep(sweep, time) for time in (START, END, *gaps)):
        return False
    # Where a cluster holds two roots, the contact between them lasts less than any gap that was asked.
    roots = [START, *(end for root in roots_from_0_to_1(_with_all_roots(critical)) for end in root), END]
    return not any(_is_deep(sweep, (low + high) / 2) for low, high in zip(roots[::2], roots[1::2], strict=True))


def _is_deep(sweep: StraightSweep, time: Fraction) -> bool:
    """Decide whether there is contact at a time that is not a touch."""
    return sweep.position(time) is Position.CONTACT and not sweep.tangent(time)


def _with_all_roots(polynomials: Sequence[Polynomial]) -> Polynomial:
    """Return a primitive polynomial, not 0, with the roots of all, each of them simple."""
    product: Polynomial = (1,)
    for f in map(squarefree, polynomials):
        product = polynomial_product(product, quotient(f, primitive(common_divisor(product, f))))
    return primitive(product)


def _clear_in_pieces(sweep: EndedSweep) -> bool:
    """Decide whether each quarter of the sweep is proved clear as a whole."""
    return all(sweep.clear(Fraction(place, 4), Fraction(place + 1, 4)) for place in range(4))


def _clusters(critical: Sequence[Polynomial], bits: int) -> list[Interval]:
    """Return disjoint intervals in order that hold all roots in [0, 1]: enclosures that overlap, or meet, are one."""
    clusters: list[Interval] = []
    for low, high in sorted(time for f in critical for time in enclosures(f, bits)):
        if clusters and low <= clusters[-1][1]:
            clusters[-1] = (clusters[-1][0], max(high, clusters[-1][1]))
        else:
            clusters.append((low, high))
    return clusters


def _gaps(clusters: Sequence[Interval]) -> list[Fraction | None]:
    """Return a time before the first cluster, between each and the next, and after the last; None if there is none."""
    ends = [START, *(high for _, high in clusters)]
    begins = [*(low for low, _ in clusters), END]
    return [None if low >= high else (low + high) / 2 for low, high in zip(ends, begins, strict=True)]


def _first_of(sweep: EndedSweep, clusters: Sequence[Interval]) -> tuple[Interval | None, bool]:
    """Find the first cluster of critical times with contact in it or just after it; return whether it is certain, too.

    None if there is no contact. The start of the sweep must be clear.
    """
    for (low, high), behind in zip(clusters, _gaps(clusters)[1:], strict=True):
        if low == high:
            if sweep.meets(low):
                return (low, high), True
        elif (behind is None and sweep.meets(END)) or not sweep.clear(low, high):
            return (low, high), behind is not None and sweep.meets(behind)
        if behind is not None and sweep.meets(behind):
            return (low, high), True
    return None, True


def _at_ends(sweep: StraightSweep, *, sides: bool) -> Iterator[Polynomial]:
    """Yield polynomials that are 0 where E touches a rim or an end's plane; with `sides`, where its centre is in it."""
    sections = [Sections.of(sweep.at(Fraction(time)), over_content=False) for time in range(3)]
    unit = sections[0].unit
    whole = math.isqrt(unit)
    root: Any = whole if whole * whole == unit else QuadraticSurd(0, 1, unit)  # type: ignore[arg-type]  # for speed

    def through(polynomials: Iterable[Polynomial], height: int) -> InTime:
        """Return the quadratic in t, doubled, that at 0, 1, 2 has the values of these polynomials at a height."""
        values = (of.value(f, height) for of, f in zip(sections, polynomials, strict=True))
        start, here, there = (even + odd * root for even, odd in values)
        return InTime((there - 2 * here + start, 4 * here - there - 3 * start, 2 * start))

    for height in (sweep.start.low, sweep.start.high):
        if height is None:
            continue
        yield from _where_touched(*(through((of.cubic[k] for of in sections), height) for k in range(4)))
        yield from _zeros(through((of.inside for of in sections), height))
        if sides:
            yield from _zeros(through((of.above for of in sections), height))


def _where_touched(c3: InTime, c2: InTime, c1: InTime, c0: InTime) -> Iterator[Polynomial]:
    """Yield polynomials that are 0 where the circle just touches the ellipse.

    Far away the circle misses E, so that Δ > 0 or c0 = c1 = 0 there (sections.py). Where one of them is 0 at all times,
    what is left therefore is not.
    """
    if any(c0.f):
        yield from _zeros(exact.cubic_discriminant(c3, c2, c1, c0))
        return
    for f in (c2 * c2 - c3 * c1 * 4, c1, c2):
        yield from _zeros(f)


def _zeros(f: InTime) -> list[Polynomial]:
    """Return a list with a polynomial that is 0 wherever f is; an empty list if that is a constant, 0 or not."""
    norm = norm_of(f.f)
    return [norm] if len(norm) > 1 else []
