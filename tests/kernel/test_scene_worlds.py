"""Scenes of many kinds beside exact decisions: what bounds and floats decide is what is decided in integers."""

from __future__ import annotations

from fractions import Fraction
from math import inf

import numpy as np
import pytest

from hypcheck.geometry.pair import UPRIGHT, Position
from hypcheck.scene.model import FREE, Hyperboloid, Mover, MoverPart, SceneModel, Span, places_of_parts
from tests.support.inside import Scene, passage
from tests.support.scenes import truth_in

AXES = [(1.0, 0.0, 1.0), (0.0, 1.0, 2.0), (1.0, 1.0, 1.0), (0.0, -1.0, 0.0), (0.3, -0.4, -0.2)]
"""Tilted in each plane of two coordinates, level, and downwards."""

DOWN = (0.0, 0.0, -2.0)


def axis_of(draw, tilted):
    return AXES[draw.integers(len(AXES))] if tilted else [UPRIGHT, DOWN][draw.integers(2)]


def body_of(draw, unit, *, tilted, ends):
    alpha, gamma = (unit * 2.0 ** draw.uniform(-3, 3, 2)).tolist()
    low, high = sorted((gamma * draw.choice([-1, 1], 2) * 2.0 ** draw.uniform(-4, 1.5, 2)).tolist())
    low, high = (-inf if draw.random() < 0.2 else low), (inf if draw.random() < 0.2 else high)
    center = tuple((unit * np.round(draw.normal(size=3) * draw.choice([0, 1, 300]), draw.choice([1, 12]))).tolist())
    solid = ends and bool(draw.random() < 0.5) and (low, high) != (-inf, inf)
    height = Span(low, high) if ends and (low, high) != (-inf, inf) else None
    return Hyperboloid("h", alpha, gamma, center, height, axis_of(draw, tilted), solid)


def frame_of(axis):
    """A matrix whose rows are unit vectors across the axis, two, and along it."""
    along = np.array(axis) / np.linalg.norm(axis)
    across = np.cross(along, (1, 0, 0) if abs(along[0]) < 0.6 else (0, 1, 0))
    across /= np.linalg.norm(across)
    return np.stack([across, np.cross(along, across), along])


def half_height(semi_axes, axis, way):
    """How far a spheroid reaches along unit vectors, and from its centre to the point that does."""
    v = np.array(axis) / np.linalg.norm(axis)
    b, d = semi_axes
    shift = b * b * way + (d * d - b * b) * (way @ v) * v
    return shift / np.sqrt(way @ shift)


def near(draw, body, mover, axis):
    """A centre from which the mover nearly touches a rim, a disc, the plane of an end or the wall, or crosses it."""
    low, high = (-inf, inf) if body.height is None else body.height.ends
    ends = [end for end in (low, high) if np.isfinite(end)]
    where = draw.choice(["rim", "level rim", "disc", "wall"]) if ends else "wall"
    reach = body.gamma + max(mover.b, mover.d)
    w = draw.choice(ends) if where != "wall" else draw.uniform(max(low, -2 * reach), min(high, 2 * reach))
    r, turn = body.alpha * np.hypot(1, w / body.gamma), draw.choice([draw.uniform(0, 2 * np.pi), 0.0])
    out, sign = np.array([np.cos(turn), np.sin(turn), 0]), draw.choice([-1, 1])
    slope = body.alpha**2 * w / (body.gamma**2 * r)
    normal = {
        "rim": draw.normal(size=3),
        "level rim": sign * out,
        "disc": np.array([0, 0, sign]),
        "wall": sign * (out - [0, 0, slope]),
    }[where]
    point = (r * (draw.uniform(0, 1.2) if where == "disc" else 1)) * out + [0, 0, w]
    frame = frame_of(body.axis)
    normal = frame.T @ normal / np.linalg.norm(normal)
    size = min(mover.b, mover.d)
    off = draw.choice([-1, 1]) * size * draw.choice([0.0, 2.0 ** draw.uniform(-54, -36), 2.0 ** draw.uniform(-30, 1)])
    return (frame.T @ point + body.center + half_height((mover.b, mover.d), axis, normal) + off * normal).tolist()


def world(seed, count, *, tilted_bodies, tilted_mover, ends, free=None):
    """A scene of two hyperboloids, and centres, and axes of a mover that is fixed or free."""
    draw = np.random.default_rng(seed)
    unit = [1.0, 1.0, 2.0**-70, 3e40][seed % 4]
    bodies = tuple(body_of(draw, unit, tilted=tilted_bodies, ends=ends or k > 0) for k in range(2))
    b, d = unit * 2.0 ** (draw.uniform(-3, 2) + draw.choice([-1, 1]) * np.array([0, draw.uniform(0, 4)]))
    fixed = axis_of(draw, tilted_mover)
    free = draw.random() < 0.5 if free is None else free
    mover = Mover(float(b), float(d), axis=FREE if free else fixed)
    axes = [axis_of(draw, tilted_mover and draw.random() < 0.8) if free else fixed for _ in range(count)]
    centres = [near(draw, bodies[draw.integers(2)], mover, axis) for axis in axes]
    return Scene(SceneModel("s", "position", bodies, mover)), np.array(centres), axes, free


WORLDS = [
    pytest.param({"tilted_bodies": bodies, "tilted_mover": mover, "ends": ends}, id=f"{bodies} {mover} {ends}")
    for bodies in (False, True)
    for mover in (False, True)
    for ends in (False, True)
]
SEEDED = [
    pytest.param(*kind.values, seed, id=f"{kind.id}-{seed}", marks=[pytest.mark.thorough] * ((number + seed) % 2))
    for number, kind in enumerate(WORLDS)
    for seed in range(4)
]
"""Each kind of world in two units of length, all four together."""


@pytest.mark.parametrize(("kind", "seed"), SEEDED)
def test_positions_in_a_scene_are_the_exact_ones(kind, seed):
    scene, centres, axes, free = world(seed, 30, **kind)
    true = [truth_in(scene.model, centre, axis) for centre, axis in zip(centres.tolist(), axes, strict=True)]
    assert scene.classify(*centres.T, **({"axis": axes} if free else {})).tolist() == true
    for centre, axis, position in zip(centres.tolist(), axes, true, strict=True):
        assert scene.position(*centre, **({"axis": axis} if free else {})) == position


@pytest.mark.parametrize(("kind", "seed"), SEEDED)
def test_scene_passage_of_one_or_many_sweeps_hits_exactly_if_an_exact_passage_does(kind, seed):
    scene, centres, axes, free = world(seed + 100, 4, **kind)
    draw = np.random.default_rng(seed)
    size = np.array([1, 1, 1]) * (scene.model.mover.b + scene.model.mover.d)
    ends = centres + size * draw.normal(size=centres.shape) * 2.0 ** draw.uniform(-6, 2, (len(centres), 1))
    found = scene.passage(centres, ends, **({"axis": axes} if free else {})).hit
    for start, end, axis, hit in zip(centres.tolist(), ends.tolist(), axes, found.tolist(), strict=True):
        true = []
        for body in scene.model.hyperboloids:
            sweep = (
                [Fraction(a) - Fraction(b) for a, b in zip(place, body.center, strict=True)] for place in (start, end)
            )
            low, high = (-inf, inf) if body.height is None else body.height.ends
            sizes = (body.alpha, body.gamma, scene.model.mover.b, scene.model.mover.d)
            true.append(passage(sizes, *sweep, axis, body.axis, z_min=low, z_max=high, solid=body.solid).hit)
        assert hit == any(true)
        assert scene.passage(start, end, **({"axis": axis} if free else {})).hit == any(true)


def test_a_difference_of_centres_that_is_rounded_by_one_unit_is_not_taken_for_exact():
    """The ball's centre is 2⁵³ + 1 from the axis, and it touches at 2⁵³."""
    size = 2.0**53
    body = Hyperboloid("h", size - 2, 4 * size, (-1.0, 0.0, 0.0))
    scene = Scene(SceneModel("s", "position", (body,), Mover(2.0, 2.0)))
    assert scene.position(size, 0.0, 0.0) == Position.EXTERIOR
    assert scene.position(size - 2, 0.0, 0.0) == Position.CONTACT


def test_a_hyperboloid_beyond_all_cells_of_the_grid_is_tested():
    far = 2.0**40
    bodies = tuple(Hyperboloid(f"h {k}", 0.5, 2.0, (x, 0.0, 0.0), Span(-1.0, 1.0)) for k, x in enumerate((0, 4, far)))
    scene = Scene(SceneModel("s", "position", bodies, Mover(0.25, 0.25)))
    assert [scene.position(x, 0.0, 0.0) for x in (far + 0.5, far + 4, 0.5, 2.0)] == [0, 1, 0, 1]
    assert scene.classify([far + 0.5, far + 4, 0.5, 2.0], 0.0, 0.0).tolist() == [0, 1, 0, 1]


def test_a_mover_that_slides_over_a_high_flat_end_touches_it():
    tower = Hyperboloid("tower", 1.0, 4000.0, (0.0, 0.0, 0.0), Span(0.0, 1000.0), solid=True)
    scene = Scene(SceneModel("s", "position", (tower,), Mover(0.5, 0.5)))
    for level, hit in ((1000.5, 1), (np.nextafter(1000.5, 2000), 0)):
        assert scene.passage((-9.0, 0.0, level), (9.0, 0.0, level)).hit == hit


def test_places_of_the_parts_of_a_tilted_mover_do_not_depend_on_the_length_of_the_axis():
    parts = tuple(MoverPart(0.1, 0.1, 2.0, angle) for angle in (0.0, 90.0, 180.0))
    for heading in (0.0, 30.0):
        unit, *others = (places_of_parts(parts, (0.0, 0.0, 0.0), heading, (k, k, k)) for k in (1.0, 2.0, -1.0))
        assert others == pytest.approx(np.array([unit] * 2))
        assert np.linalg.norm(unit, axis=1) == pytest.approx(2.0)
        assert np.abs(np.sum(unit, axis=1)).max() < 1e-12, "across the axis"
