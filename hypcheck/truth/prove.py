"""The search for the witness that certificate.py checks, rational and as short as the case allows.

A witness always exists (docs/mathematics.md, "A certificate for every answer"), and every search below doubles its
precision until the claim holds exactly, so each one ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import count

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth import exact
from hypcheck.truth.certificate import Certificate, Point
from hypcheck.truth.exact import Cubic, Decision
from hypcheck.truth.passage_certificate import PairAtTime


def prove(pair: Pair, decision: Decision | None = None) -> Certificate:
    """A certificate for the exact answer about a pair (`decision`, where the caller has it already)."""
    lengths = pair.lengths
    decision = decision or exact.decide(lengths)
    if decision.tangent:
        return Certificate(decision.position, double_root=double_root(lengths))
    if decision.position is Position.CONTACT:
        return Certificate(decision.position, points=points(pair, lengths))
    return Certificate(decision.position, multiplier=_multiplier(exact.cubic(lengths)))


def double_root(lengths: Lengths) -> Fraction:
    """The double root of g of a tangency."""
    g = exact.cubic(lengths)
    h = g.n2 * g.n2 - 3 * g.n3 * g.n1
    return Fraction(9 * g.n3 * g.n0 - g.n1 * g.n2, 2 * h) if h else Fraction(-g.n2, 3 * g.n3)


def _multiplier(g: Cubic) -> Fraction:
    """The local maximum of g, rounded to the fewest bits (a power of two of them) at which g is still positive."""
    h = g.n2 * g.n2 - 3 * g.n3 * g.n1
    for bits in precisions():
        shift = max(0, bits + 8 - h.bit_length() // 2)
        root = Fraction(math.isqrt(h << 2 * shift), 1 << shift)
        top = g.n1 / (root - g.n2) if g.n2 < 0 else -(g.n2 + root) / (3 * g.n3)  # the form that does not cancel
        at = _round(top, bits)
        u, v = at.numerator, at.denominator
        inside = u < 0 or u * g.t < v * g.s  # below 0, g > 0 means λ > −A: g(−A) ≤ 0, and g rises up to there
        if inside and ((g.n3 * u + g.n2 * v) * u + g.n1 * v * v) * u + g.n0 * v**3 > 0:
            return at
    raise AssertionError("unreachable: the precisions do not end")


def points(pair: Pair | PairAtTime, lengths: Lengths) -> tuple[Point, ...]:
    """The centre and a point of the spheroid on the other side of the hyperboloid (or the centre alone, on it)."""
    alpha, gamma, b, d, x, y, z = map(Fraction, pair.row)

    def side(point: Point) -> int:
        u, v, w = point
        height = (u * u + v * v) / (alpha * alpha) - w * w / (gamma * gamma) - 1
        return (height > 0) - (height < 0)

    def in_spheroid(point: Point) -> bool:
        u, v, w = point
        return ((u - x) ** 2 + (v - y) ** 2) / (b * b) + (w - z) ** 2 / (d * d) <= 1

    center = (x, y, z)
    start = side(center)
    if start == 0:
        return (center,)
    for point in _candidates(pair, lengths, outward=start < 0):
        if side(point) in (0, -start) and in_spheroid(point):
            return (center, point)
    raise AssertionError("unreachable: the candidates do not end")


def _candidates(pair: Pair | PairAtTime, lengths: Lengths, outward: bool) -> Iterator[Point]:
    """Points of the spheroid's plane through the axis, first the simple ones, then ever nearer to the best one."""
    _, _, b, d, x, y, z = map(Fraction, pair.row)
    radius = _root(x * x + y * y, 30, upward=True)

    def moved(across: Fraction, along: Fraction) -> Point:
        """The centre moved by these parts of b and d: away from the axis and to the waist, or the other way."""
        to_waist = min(abs(z), along * d) if outward else -along * d
        height = z - to_waist if z >= 0 else z + to_waist
        if not radius:
            return (across * b, Fraction(0), height)
        stretch = 1 + across * b / radius if outward else max(1 - across * b / radius, Fraction(0))
        return (x * stretch, y * stretch, height)

    for fifths in ((5, 0), (0, 5), (4, 3), (3, 4)):  # Pythagorean triples: on the spheroid, or within
        yield moved(Fraction(fifths[0], 5), Fraction(fifths[1], 5))
    if outward and abs(z) < d:  # right out from the waist, where a spheroid a little too wide for the throat sticks out
        yield moved(1 - (z / d) ** 2, Fraction(1))
    for bits in precisions(start=8):
        near = _near_surface(lengths, bits)
        if near is None:
            continue
        stretch, height = near
        # From the centre through the nearest point, and on by ever smaller shares of the way.
        for beyond in (Fraction(1, 1 << bits // 2), Fraction(1, 1 << bits)):
            along = 1 + beyond
            w = z + d * (height - z / d) * along
            widened = 1 + (stretch - 1) * along
            yield (x * widened, y * widened, w) if radius else (b * stretch * along, Fraction(0), w)


def _near_surface(lengths: Lengths, bits: int) -> tuple[Fraction, Fraction] | None:
    """About the hyperboloid's nearest point to the centre, in spheroid radii: its radius and its height.

    The radius is given as a multiple of the centre's, except on the axis. None where `bits` is too few to tell.
    """
    p, q, s, t = lengths.alpha**2, lengths.b**2, lengths.gamma**2, lengths.d**2
    A, B, z = Fraction(p, q), Fraction(s, t), Fraction(lengths.z, lengths.d)
    P = Fraction(lengths.x**2 + lengths.y**2, q)
    if P == 0:  # a circle of nearest points
        height = B * z / (A + B)
        return _root(A * (1 + height * height / B), bits), height
    if z == 0 and A * P >= (A + B) ** 2:  # two nearest points, one above and one below
        return A / (A + B), _root(B * (A * P / (A + B) ** 2 - 1), bits)
    at = _multiplier_of_nearest(lengths, bits)
    return (A / (A + at), z * B / (B - at)) if at is not None else None


def _multiplier_of_nearest(lengths: Lengths, bits: int) -> Fraction | None:
    """The root of F(t) = A P/(A+t)² − B Q/(B−t)² − 1 to `bits` bits of its distance to 0 and to the pole it nears.

    With t = −A m/n or t = B m/n, 0 ≤ m < n, the sign of F is that of a difference of integers.
    """
    p, q, s, t = lengths.alpha**2, lengths.b**2, lengths.gamma**2, lengths.d**2
    R, S = lengths.x**2 + lengths.y**2, lengths.z**2

    def falls_toward_A(m: int, n: int) -> bool:
        other = s * q * n + p * t * m
        return R * (n * other) ** 2 <= p * (n - m) ** 2 * (other * other + s * S * (q * n) ** 2)

    def falls_toward_B(m: int, n: int) -> bool:
        other = p * t * n + s * q * m
        return p * R * s * (t * n * (n - m)) ** 2 <= other * other * (s * (n - m) ** 2 + S * n * n)

    inside = falls_toward_A(0, 1)

    def too_far(share: Fraction) -> bool:
        m, n = share.numerator, share.denominator
        return not falls_toward_A(m, n) if inside else falls_toward_B(m, n)

    # The share's odds, 2^j : 1, first; then the share itself between two of them.
    step, low = 1, 0
    direction = -1 if too_far(_odds(0)) else 1
    while too_far(_odds(low + direction * step)) is (direction < 0):
        low += direction * step
        step *= 2
        if step > 64 * bits:
            return None
    low, high = sorted((low, low + direction * step))
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if too_far(_odds(middle)) else (middle, high)
    share = _bisect(too_far, _odds(low), _odds(high), bits)
    return share * (Fraction(-p, q) if inside else Fraction(s, t))


def _odds(exponent: int) -> Fraction:
    """The share whose odds are 2^exponent to 1."""
    odds = Fraction(2) ** exponent
    return odds / (odds + 1)


def _bisect(too_far: Callable[[Fraction], bool], low: Fraction, high: Fraction, steps: int) -> Fraction:
    for _ in range(steps):
        middle = (low + high) / 2
        low, high = (low, middle) if too_far(middle) else (middle, high)
    return (low + high) / 2


def precisions(start: int = 1) -> Iterator[int]:
    """Numbers of bits, each twice the one before, without end."""
    return (start << doubling for doubling in count())


def _root(value: Fraction, bits: int, *, upward: bool = False) -> Fraction:
    """√value, exact where that is rational, else to about `bits` bits; with `upward` never less than the root."""
    root = Fraction(math.isqrt(value.numerator), math.isqrt(value.denominator))
    if root * root == value:
        return root
    shift = bits + max(0, value.denominator.bit_length() - value.numerator.bit_length()) // 2 + 1
    scaled = value.numerator * (1 << 2 * shift) // value.denominator
    return Fraction(math.isqrt(scaled) + (1 if upward else 0), 1 << shift)


def _round(value: Fraction, bits: int) -> Fraction:
    """`value` to `bits` significant bits."""
    exponent = abs(value.numerator).bit_length() - value.denominator.bit_length() - bits
    unit = Fraction(2) ** exponent
    return round(value / unit) * unit
