"""Findings: one upright spheroid about the origin and one triangle, about which an engine is wrong, with a certificate.

With one triangle there is no mesh that could explain the error. With S = diag(b², b², d²) and h(n) = √(nᵀSn), every
direction n gives a lower bound s(n) = (min n·v − h(n)) / |n|, over the corners v, of the signed distance (how far
bodies are apart, or minus the depth by which a move along n separates them at most). So the certificates are:

- a *direction* n with s(n) > 0: the bodies are clear. With any s(n): no distance below it is right, no depth beyond
  −s(n).
- *shares* of the corners, which add up to 1: the point of the triangle with these shares lies inside the spheroid.
  And with it, for a distance that is too large, the point of the spheroid at a direction: their distance is an upper
  bound.

`proved` decides all of that in rationals, where a root is compared by squares. For an engine that is given a hull
only what holds for every body inside the spheroid is claimed.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import sqrt
from pathlib import Path

import msgspec
import numpy as np
from msgspec import Struct

from hypcheck.geometry.rows import Floats

Kind = str
KINDS = ("false contact", "missed contact", "too near", "too far")


class Finding(Struct):
    """An engine's answer about the spheroid b, d about the origin and a triangle.

    `reported` is the signed distance that is wrong, or None where its word contact or clear is. `error_mm` is proved,
    in millimetres at the 2 m tower; `direction` and `shares` are the certificate.
    """

    engine: str
    version: str
    kind: Kind
    b: float
    d: float
    corners: list[list[float]]
    reported: float | None
    direction: list[float]
    shares: list[float]
    error_mm: float
    millimetres: float
    said: str
    proved: str
    file: str
    picture: str


def read_findings(folder: Path) -> list[Finding]:
    """The findings in a folder, none if it has no file of them."""
    path = folder / "findings" / "findings.json"
    return msgspec.json.decode(path.read_bytes(), type=list[Finding]) if path.is_file() else []


def lower_bounds(corners: Floats, b: float, d: float, direction: Floats) -> Floats:
    """s(n) for directions (m, 3), in floats."""
    half = np.sqrt((direction * direction * [b * b, b * b, d * d]).sum(axis=-1))
    return np.asarray(((corners @ direction.T).min(axis=0) - half) / np.linalg.norm(direction, axis=-1))


def best_direction(corners: Floats, b: float, d: float) -> Floats:
    """A direction n with nearly the greatest s(n), which is the signed distance: many are drawn, the best refined."""
    rng = np.random.default_rng(1)
    scale = np.array([b, b, d])
    ways = rng.normal(size=(2000, 3))
    near = nearest_point(corners / scale)
    if near @ near > 0:
        ways[0] = near / scale
    best, spread = ways[np.argmax(lower_bounds(corners, b, d, ways))], 0.5
    best = best / np.linalg.norm(best)
    while spread > 1e-12:
        tries = best + spread * rng.normal(size=(200, 3))
        tries = np.vstack([best, tries / np.linalg.norm(tries, axis=1, keepdims=True)])
        best, spread = tries[np.argmax(lower_bounds(corners, b, d, tries))], spread * 0.7
    return np.asarray(best)


def nearest_point(corners: Floats) -> Floats:
    """The point of a triangle nearest to the origin."""
    return np.asarray(nearest_shares(corners) @ corners)


def nearest_shares(corners: Floats) -> Floats:
    """The shares of the corners in that point."""
    edges = corners[1:] - corners[0]
    gram = edges @ edges.T
    if np.linalg.det(gram) > 0:
        s, t = np.linalg.solve(gram, -edges @ corners[0])
        if s >= 0 and t >= 0 and s + t <= 1:
            return np.array([1 - s - t, s, t])
    found = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        edge = corners[j] - corners[i]
        share = float(np.clip(-(corners[i] @ edge) / (edge @ edge), 0.0, 1.0)) if edge @ edge > 0 else 0.0
        shares = np.zeros(3)
        shares[i], shares[j] = 1 - share, share
        found.append(shares)
    return np.asarray(min(found, key=lambda each: float(np.linalg.norm(each @ corners))))


def proved(finding: Finding) -> bool:
    """Whether the certificate proves at least nine tenths of the error, in rationals."""
    error = Fraction(finding.error_mm) * 9 / 10 / Fraction(finding.millimetres)
    if finding.kind in {"false contact", "too near"}:
        return _direction_proves(finding, error)
    squares, shares = _squares(finding), [Fraction(each) for each in finding.shares]
    if sum(shares) != 1 or min(shares) < 0:
        return False
    point = [_dot(shares, [Fraction(corner[k]) for corner in finding.corners]) for k in range(3)]
    if (
        finding.kind == "missed contact"
    ):  # inside the spheroid that is smaller by a factor of 1 − error / least semi-axis
        factor = 1 - error / Fraction(min(finding.b, finding.d))
        return _inside(point, squares) <= factor * factor
    way = [Fraction(each) for each in finding.direction]
    above = Fraction(sqrt(_dot(squares, [each * each for each in way])) * (1 + 1e-12))  # more than h
    foot = [square * each / above for square, each in zip(squares, way, strict=True)]
    bound = Fraction(finding.reported or 0.0) - error
    apart = [x - y for x, y in zip(point, foot, strict=True)]
    return bound > 0 and _inside(foot, squares) <= 1 and _dot(apart, apart) <= bound * bound


def _direction_proves(finding: Finding, error: Fraction) -> bool:
    """Whether s(n) is at least the error, or greater by that than what the engine reported."""
    way = [Fraction(each) for each in finding.direction]
    least = min(_dot(way, [Fraction(each) for each in corner]) for corner in finding.corners)
    bound = error + (Fraction(finding.reported or 0.0) if finding.kind == "too near" else 0)
    half2, root2 = _dot(_squares(finding), [each * each for each in way]), bound * bound * _dot(way, way)
    return _at_least_roots(least, half2, root2) if bound >= 0 else _root_and(least, root2, half2)


def _squares(finding: Finding) -> list[Fraction]:
    return [Fraction(finding.b) ** 2, Fraction(finding.b) ** 2, Fraction(finding.d) ** 2]


def _dot(first: Sequence[Fraction], second: Sequence[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(first, second, strict=True)), Fraction(0))


def _inside(point: Sequence[Fraction], squares: Sequence[Fraction]) -> Fraction:
    """(x² + y²)/b² + z²/d², which is below 1 inside the spheroid."""
    return _dot([each * each for each in point], [1 / square for square in squares])


def _at_least_roots(value: Fraction, first: Fraction, second: Fraction) -> bool:
    """Whether value ≥ √first + √second."""
    rest = value * value - first - second
    return value >= 0 and rest >= 0 and rest * rest >= 4 * first * second


def _root_and(value: Fraction, first: Fraction, second: Fraction) -> bool:
    """Whether value + √first ≥ √second."""
    rest = second - first - value * value
    if value < 0:
        return rest <= 0 and rest * rest >= 4 * value * value * second
    return rest <= 0 or rest * rest <= 4 * value * value * first
