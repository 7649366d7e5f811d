"""Scenes for tests of plans and kernels: the tower that hypcheck installs, and any number of random ones."""

from __future__ import annotations

import math
import random
from fractions import Fraction

from hypcheck.geometry.pair import Lengths, Position
from hypcheck.scene.model import QUESTIONS, UPRIGHT, Hyperboloid, Mover, Region, SceneModel, Span
from tests.support.inside import position


def scene(sizes=(2.0, 17.8, 0.25, 0.15), question="position", **spans):
    """One hyperboloid at the origin and one mover."""
    alpha, gamma, b, d = sizes
    return SceneModel("a scene", question, (Hyperboloid("h", alpha, gamma),), Mover(b, d), Region(**spans))


WALKER = Mover(0.3, 0.9)
TREES = (
    Hyperboloid("trunk wider than the walker", 0.61, 6.0, (5.0, -3.25, 0.375), Span(-0.9, 5.0)),
    Hyperboloid("narrower one", 0.14, 10.0, (-4.5, 2.0, 0.0), Span(-0.9, 5.0)),
)
"""One tree of each type of the paper's section 3.1, at different levels of the ground."""

HILLS = SceneModel("hills", "position", TREES, WALKER, Region(Span(-20, 20), Span(-20, 20), Span(-0.5, 1.5)))
PLAIN = SceneModel("plain", "exterior", TREES, WALKER, Region(Span(-20, 20), Span(-20, 20), Span(0.0, 0.0)))
"""The walker among them where the ground rises and falls, and where it does not."""


def extreme_scene(seed):
    """Sizes up to where a format ends and beyond, with or without an end of the region."""
    draw = random.Random(seed)  # noqa: S311 - nothing is secret
    most = draw.choice([12, 25, 50, 100])
    sizes = tuple(10 ** draw.uniform(-most, most) for _ in range(4))
    z = draw.choice([None, Span(-sizes[1], sizes[1]), Span(sizes[1], sizes[1]), Span(0.0, 0.0)])
    return scene(sizes, draw.choice(QUESTIONS), z=z)


def random_scene(seed):
    """Sizes of many ratios in metres, every regime and border, with an open, bounded or fixed height."""
    draw = random.Random(seed)  # noqa: S311 - nothing is secret

    def length(low, high):
        return float(f"{10 ** draw.uniform(low, high):.{draw.choice([1, 3, 16])}g}")

    alpha, gamma, wide = length(-3, 4), length(-3, 4), draw.choice([1.5, 4, 7])
    b, d = (min(1e6, max(1e-6, size * 10 ** draw.uniform(-wide, wide))) for size in (alpha, gamma))
    if draw.random() < 0.2:
        d = gamma / math.sqrt(alpha / b)
    height = length(-2, 3)
    z = draw.choice([None, None, Span(-height, height), Span(height, height), Span(0.0, 0.0)])
    x = draw.choice([None, None, None, Span(alpha / 2, 3 * alpha)])
    return scene((alpha, gamma, b, d), draw.choice(QUESTIONS), x=x, y=x, z=z)


def truth_beside(body, semi_axes, axis, centre):
    """The exact position of one spheroid, its centre in the scene's coordinates, beside a hyperboloid that may end."""
    offset = [Fraction(there) - Fraction(here) for there, here in zip(centre, body.center, strict=True)]
    heights = (-math.inf, math.inf) if body.height is None else body.height.ends
    row = (body.alpha, body.gamma, *semi_axes, *offset, *axis, *heights, body.solid)
    return position(Lengths.of(row, body.axis))


def truth_in(scene, centre, axis=UPRIGHT):
    """The exact answer about all hyperboloids of a scene, each asked, for a mover without parts."""
    said = {truth_beside(body, (scene.mover.b, scene.mover.d), axis, centre) for body in scene.hyperboloids}
    return next(each for each in (Position.CONTACT, Position.INTERIOR, Position.EXTERIOR) if each in said)
