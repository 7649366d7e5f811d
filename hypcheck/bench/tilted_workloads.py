"""Workloads of spheroids that lean: rows of ten numbers, and those that a scene with a leaning mover asks.

The tower's quadcopter with one axis and with an axis a row, several pairs of bodies near contact, and rows on which
floats err, which are only judged. To estimate a row's distance to another position takes ten milliseconds, so that a
quarter of the rows of other workloads is judged. Pairs whose nearest point is not unique are in none of them, because
there the estimate, which rests on derivatives, is too large.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from math import radians, tan

import numpy as np

from hypcheck.bench.plan import NEAR_GAPS, NEAR_SCENES, PASSAGE, WORKLOADS, BenchPlan, Workload
from hypcheck.bench.way_workloads import WAY_WORKLOADS
from hypcheck.errors import InputError
from hypcheck.geometry.rows import Floats, Rows, tilted_rows
from hypcheck.kernel.specialise.settings import REACH, Setting, settings_of
from hypcheck.scene.model import FREE, SceneModel, leans
from hypcheck.scene.reading import read_scene
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.families import TILTED_FAMILIES
from hypcheck.vectors.family import BLOCK
from hypcheck.vectors.random_pairs import Sizes
from hypcheck.vectors.scenes import BODY, TOWER
from hypcheck.vectors.tilted.families import Vectors, anywhere, beside

PITCH = 20.0
"""Degrees by which the quadcopter leans along x in the workload of one axis."""

SHARE = 4

_Block = Callable[[Draw, int, int], Rows]
"""Rows of a block: from its random numbers, its size, and the number of rows before it."""


def _rows(name: str, make: _Block) -> Callable[[int, int], Rows]:
    """Blocks with a random stream each, so that a shorter call gives the beginning of a longer one."""

    def rows(seed: int, count: int) -> Rows:
        numbers = range(-(-count // BLOCK))
        blocks = [make(Draw("bench-tilted", name, 1, seed, number), BLOCK, number * BLOCK) for number in numbers]
        return np.ascontiguousarray(np.concatenate([np.empty((0, 10)), *blocks])[:count])

    return rows


def _one_axis(draw: Draw, n: int, _before: int) -> Rows:
    return tilted_rows(TOWER + BODY, _in_the_box(draw, n), (tan(radians(PITCH)), 0.0, 1.0))


def _an_axis_each(draw: Draw, n: int, _before: int) -> Rows:
    cosine, sine = draw.circle(n)
    lean = draw.unit(n)  # up to 45°
    return tilted_rows(TOWER + BODY, _in_the_box(draw, n), (lean * cosine, lean * sine, np.ones(n)))


def _in_the_box(draw: Draw, n: int) -> Vectors:
    """Centres uniform in the box of the workload "uniform"."""
    alpha, gamma = TOWER
    return (
        draw.between(n, -2 * alpha, 2 * alpha),
        draw.between(n, -2 * alpha, 2 * alpha),
        draw.between(n, -gamma, gamma),
    )


def _near_contact(draw: Draw, n: int, before: int) -> Rows:
    scenes = np.array(NEAR_SCENES)
    return _near(draw, Sizes(*scenes[(before + np.arange(n)) % len(scenes)].T), anywhere(draw, n))


def _near(draw: Draw, size: Sizes, axis: Vectors) -> Rows:
    """Centres at one radius from a point of the surface, plus or minus m 2^e with e in NEAR_GAPS, on either side."""
    n = len(size.b)
    height = draw.signs(n) * draw.unit(n)
    gap = draw.signs(n) * draw.log_uniform(n, *NEAR_GAPS)
    return beside(draw, size, height, axis, draw.signs(n) * (1 + gap))


def _of_families(*names: str) -> _Block:
    families = [family for name in names for family in (TILTED_FAMILIES[name],)]

    def make(draw: Draw, n: int, _before: int) -> Rows:
        rows = np.empty((n, 10))
        for turn, family in enumerate(families):
            rows[turn :: len(families)] = family.make(draw, len(range(turn, n, len(families))))
        return rows

    return make


def _workload(name: str, title: str, text: str, make: _Block, *, timed: bool = True) -> Workload:
    return Workload(name, title, text, _rows(name, make), timed, SHARE)


TILTED_WORKLOADS = {
    workload.name: workload
    for workload in (
        _workload(
            "one-axis",
            "leaning one way around the tower",
            f"A quadcopter's body that leans by {PITCH:g}° along x, uniform in the box |x|, |y| ≤ 4 m, |z| ≤ 17.8 m "
            "about the paper's cooling tower.",
            _one_axis,
        ),
        _workload(
            "an-axis-each",
            "an axis each around the tower",
            "The same body in the same box; each row leans to any side, by up to 45°.",
            _an_axis_each,
        ),
        _workload(
            "near-contact",
            "near contact",
            "Six pairs of bodies in turn, axes in all directions, at distances from touching that are log-uniform from "
            "1e-17 to 0.5 spheroid radii, apart and overlapping, outside and inside.",
            _near_contact,
        ),
        _workload(
            "all-sizes",
            "near contact, of all sizes",
            "From 2⁻⁵² to 2⁻⁴ radii off contact, sizes of all four regimes (the family tilted-near-contact).",
            _of_families("tilted-near-contact"),
            timed=False,
        ),
        _workload(
            "stiff",
            "of very different sizes",
            "Near contact with ratios of sizes up to 1e8, and axes that almost stand or lie (the families tilted-stiff "
            "and tilted-slight).",
            _of_families("tilted-stiff", "tilted-slight"),
            timed=False,
        ),
    )
}
"""By name, in the order of the record."""


def workloads_of(plan: BenchPlan) -> dict[str, Workload]:
    """The workloads that the plan can choose from, by name."""
    if plan.scenes:
        return scene_workloads(*plan.scenes)
    if plan.question == PASSAGE:
        return WAY_WORKLOADS
    return TILTED_WORKLOADS if plan.tilted else WORKLOADS


def leaning_scenes(names: tuple[str, ...]) -> list[str]:
    """The scenes whose mover leans, or may. Raises InputError for a scene that does not exist."""
    return [name for name in names if leans(read_scene(name).mover.axis)]


@cache
def scene_workloads(name: str) -> dict[str, Workload]:
    """The workloads of a scene whose mover leans.

    Raises InputError if a hyperboloid leans as well, or if nothing is ever asked in the scene.
    """
    scene = read_scene(name)
    lean = next((body for body in scene.hyperboloids if leans(body.axis)), None)
    if lean is not None:
        raise InputError(
            f"the scene {scene.name!r} is not measured: the hyperboloid {lean.name!r} leans, and rows of ten numbers "
            "are about upright ones"
        )
    settings = settings_of(scene)
    if not settings:
        raise InputError(f"the scene {scene.name!r} is not measured: no hyperboloid's height meets its region")
    region, near = partial(_in_region, scene, settings), partial(_near_in_scene, scene, settings)
    axis = "an axis each, in all directions" if scene.mover.axis == FREE else "the mover's axis"
    known = (
        _workload("region", f"in the scene {scene.name}", f"Centres uniform in the scene's region, {axis}.", region),
        _workload(
            "near-contact",
            "near contact",
            f"The scene's bodies, {axis}, at distances from touching that are log-uniform from 1e-17 to 0.5 spheroid "
            "radii.",
            near,
        ),
    )
    return {each.name: each for each in known}


def _axes_of(scene: SceneModel, draw: Draw, n: int) -> Vectors:
    if scene.mover.axis == FREE:
        return anywhere(draw, n)
    x, y, z = (np.full(n, float(each)) for each in scene.mover.axis)
    return x, y, z


def _sizes_in_turn(settings: tuple[Setting, ...], n: int, before: int) -> Floats:
    """α, γ, b, d of the settings in turn, (n, 4)."""
    return np.array([each.sizes for each in settings])[(before + np.arange(n)) % len(settings)]


def _in_region(scene: SceneModel, settings: tuple[Setting, ...], draw: Draw, n: int, before: int) -> Rows:
    sizes = _sizes_in_turn(settings, n, before)
    ends = np.array([_ends(each) for each in settings])[(before + np.arange(n)) % len(settings)]
    centre = [low + (high - low) * draw.unit(n) for low, high in np.transpose(ends, (1, 2, 0))]
    return np.column_stack([sizes, *centre, *_axes_of(scene, draw, n)]) + 0.0


def _ends(setting: Setting) -> list[tuple[float, float]]:
    """The least and the greatest x, y, z of a centre; where the region is open, about the surface."""
    alpha, gamma, b, d = setting.sizes
    open_ends = (REACH * (alpha + b), REACH * (alpha + b), REACH * (gamma + d))
    return [
        (-far, far) if span is None else (span.low, span.high)
        for span, far in zip(setting.box.spans, open_ends, strict=True)
    ]


def _near_in_scene(scene: SceneModel, settings: tuple[Setting, ...], draw: Draw, n: int, before: int) -> Rows:
    return _near(draw, Sizes(*_sizes_in_turn(settings, n, before).T), _axes_of(scene, draw, n))
