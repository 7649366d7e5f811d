"""The numpy kernel's first stage, in single precision: exact where its lines touch the border; most centres decided."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from tests.support import inside
from tests.support.inside import numpy_kernel, positions_of_scene, scene_lines
from tests.tools.attack.places import Scene, sizes

TOWER = (2.0, 17.8, 0.25, 0.15)
COUNT = 1 << 14
UNITS = 200
"""How far from a threshold, in units of 2⁻²⁴."""


def touching(four: tuple[float, ...], seed: int) -> Scene:
    """Centres within a few units of float32 from the border, at heights where the lines of the scene come near it."""
    random = np.random.default_rng(seed)
    top = 1.5 * four[1]
    lines = scene_lines.lines_of(four, np.linspace(0, top, COUNT))
    assert lines is not None
    assert lines.parallel is not None
    T = (top * np.linspace(0, 1, 2000)) ** 2
    heights, radii = [], []
    for side, name, slope in ((1, "beyond", "outer"), (-1, "within", "inner")):
        line = lines.parallel[f"K_{name}"] + lines.parallel[f"M_{slope}"] * T
        edge = np.array([edge_of(four, each, side) for each in T])
        with np.errstate(invalid="ignore"):
            nearest = T[np.argmin(np.where(np.isfinite(line), np.abs(edge - line), np.inf))]
        some = np.clip(nearest * (1 + 1e-2 * random.uniform(-1, 1, COUNT // 2) ** 3), 0, top**2)
        some[::3] = random.choice([0.0, top**2], len(some[::3]))  # where the chords begin and end
        heights.append(np.sqrt(some))
        radii.append(np.sqrt(np.maximum([edge_of(four, each, side) for each in some], 0)))
    z, r = np.concatenate(heights), np.concatenate(radii)
    x = r * (1 + random.integers(-UNITS, UNITS + 1, len(r)) * 2.0**-24)
    return Scene("parallel", four, x, np.zeros(len(x)), z)


def edge_of(four: tuple[float, ...], T: float, side: int) -> float:
    """R of the border at that T."""
    alpha, gamma, b, d = four
    A, B, Q = (alpha / b) ** 2, (gamma / d) ** 2, T / d**2
    at = side * scene_lines.multiplier(four, T, side)
    return b * b * ((A + at) * (1 + 1 / at) + Q * (A + at) / (B - at))


@cache
def near() -> tuple[Scene, ...]:
    """Such centres for ten scenes."""
    return tuple(touching(four, seed) for seed, four in enumerate(SCENES[:10]))


def wrong(scene: Scene) -> int:
    """How many of the centres the first stage alone answers, and answers wrong."""
    lines = scene_lines.lines_of(scene.sizes, scene.z)
    assert lines is not None
    answers = np.full(len(scene.z), 99, np.int8)
    columns = scene.x, scene.y, scene.z
    for start in range(0, COUNT, 1024):  # so that one chunk in which too much is left does not end the stage
        part = slice(start, start + 1024)
        rest = numpy_kernel.by_lines(lines, (columns[0][part], columns[1][part], columns[2][part]), answers[part])
        answers[start + rest] = 99
    return int(((answers != 99) & (answers != inside.positions(scene.rows))).sum())


SCENES = [TOWER, *(tuple(some) for some in sizes(np.random.default_rng(2), 60).tolist())]
SCENES = [four for four in SCENES if max(four) < 1e4 and min(four) > 1e-4]


def test_parallel_lines_decide_no_centre_near_contact_wrongly():
    assert len(SCENES) > 20
    assert [wrong(scene) for scene in near()] == [0] * 10
    for scene in near()[:4]:
        assert (positions_of_scene(scene.sizes, scene.x, scene.y, scene.z) == inside.positions(scene.rows)).all()


@pytest.mark.parametrize("margin", [0.0, -scene_lines.FLOAT32_MARGIN])
def test_parallel_lines_without_their_margin_decide_centres_near_contact_wrongly(margin, monkeypatch):
    """The rows above are near enough to tell a margin that is too small."""
    scenes = near()
    monkeypatch.setattr(scene_lines, "FLOAT32_MARGIN", margin)
    assert any(wrong(scene) for scene in scenes)


@pytest.fixture
def tower():
    return np.random.default_rng(3).uniform(-4, 4, (3, numpy_kernel.LINES_CHUNK))


def lines_left(columns, four=TOWER):
    """The places that are left of one chunk."""
    lines = scene_lines.lines_of(four, columns[2])
    answers = np.zeros(len(columns[0]), np.int8)
    with np.errstate(all="ignore"):
        return numpy_kernel.by_lines(lines, tuple(columns), answers)


def test_parallel_lines_decide_most_centres(tower):
    assert len(lines_left(tower)) < 0.005 * len(tower[0])


@pytest.mark.parametrize("value", [1e17, 1e200, -np.inf, np.nan])
@pytest.mark.parametrize("column", [0, 1, 2])
def test_a_centre_beyond_single_precision_is_answered_exactly_by_later_stages(column, value, tower):
    tower[column, 7] = value
    rows = np.column_stack([np.tile(TOWER, (len(tower[0]), 1)), *tower])
    expected = np.full(len(rows), 127)
    valid = np.isfinite(rows).all(axis=1)
    expected[valid] = inside.positions(rows[valid])
    assert (positions_of_scene(TOWER, *tower) == expected).all()


@pytest.mark.parametrize("unit", [1e-12, 1e12])
def test_a_scene_beyond_single_precision_has_lines_in_double_precision(unit, tower):
    four = tuple(unit * size for size in TOWER)
    lines = scene_lines.lines_of(four, unit * tower[2])
    assert lines is not None
    assert lines.parallel is None
    assert len(lines_left(unit * tower, four)) < 0.005 * len(tower[0])


def test_a_multiplier_parallel_to_a_chord_is_never_0_where_a_line_has_no_constant():
    """With A = B = 1 a chord of slope 1 is parallel to the tangent of λ = 0."""
    for side in (1, -1):
        assert scene_lines.parallel_multiplier((1.0, 1.0, 1.0, 1.0), (0.5, 1.0), 1.0, side) > 0
