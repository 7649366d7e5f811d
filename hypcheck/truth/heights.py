"""The oracle of heights: where a horizontal plane cuts both surfaces, and whether their circles meet there.

With R = x² + y², the plane at height w cuts the hyperboloid in a circle about its axis with r² = α² (1 + w²/γ²), and
the solid of an upright spheroid in a disc with s² = b² (1 − (w − z)²/d²), whose centre is √R from that axis. They meet
if and only if |r − √R| ≤ s, that is Q ≤ 2 √R r with Q(w) = r² − s² + R; so Q ≤ 0 or F ≤ 0 with F = Q² − 4 R r², a
quartic in w. Far above and below both are > 0, and the sign of 2 √R r − Q can change at a root of F alone, where circle
and disc meet. Hence the pair is in contact if and only if F has a real root, else on the side of the spheroid's centre.
Sturm's theorem counts the roots, in integers. Nothing is shared with the other oracles: there is no pencil here, and no
distance.
"""

from __future__ import annotations

import itertools
import math

from hypcheck.geometry.pair import Pair, Position

Polynomial = list[int]
"""The highest power first."""


def position(pair: Pair) -> Position:
    """The exact position of an upright pair."""
    lengths = pair.lengths
    p, q, s, t = lengths.alpha**2, lengths.b**2, lengths.gamma**2, lengths.d**2
    R, z = lengths.x**2 + lengths.y**2, lengths.z
    a, b, c = p * t + q * s, -2 * q * s * z, s * (t * (p - q + R) + q * z * z)  # s t Q
    wall = 4 * R * s * t * p * t  # (s t)² 4 R r² is this times w² + s
    if _has_real_root([a * a, 2 * a * b, b * b + 2 * a * c - wall, 2 * b * c, c * c - wall * s]):
        return Position.CONTACT
    return Position.EXTERIOR if R * s > p * (s + z * z) else Position.INTERIOR


def _has_real_root(f: Polynomial) -> bool:
    """Whether the signs at −∞ of Sturm's chain change more often than those at ∞."""
    degree = len(f) - 1
    chain = [f, [(degree - place) * number for place, number in enumerate(f[:-1])]]
    while rest := _remainder(chain[-2], chain[-1]):
        chain.append([-number for number in rest])
    above = [g[0] > 0 for g in chain]
    below = [sign == (len(g) % 2 == 1) for sign, g in zip(above, chain, strict=True)]
    return _changes(below) > _changes(above)


def _remainder(f: Polynomial, g: Polynomial) -> Polynomial:
    """A positive multiple of the remainder, without leading zeros and common factors; empty for 0."""
    while len(f) >= len(g):
        f = [abs(g[0]) * number for number in f]
        factor, tail = f[0] // g[0], [*g, *[0] * (len(f) - len(g))]
        f = [a - factor * b for a, b in zip(f[1:], tail[1:], strict=True)]
    first, common = next((place for place, number in enumerate(f) if number), len(f)), math.gcd(*f)
    return [number // common for number in f[first:]]


def _changes(signs: list[bool]) -> int:
    return sum(one != other for one, other in itertools.pairwise(signs))
