"""The workloads of a benchmark: rows on which methods are compared, of upright and tilted spheroids and of sweeps.

workloads.toml lists them; the rows that are of no family are made here, and so are the workloads of a scene.
Some are timed and judged, the others only judged. A workload's rows depend only on its name, the seed and their place:
a call for fewer rows returns the first rows of a call for more (vectors/draw.py). Pairs of tilted spheroids whose
nearest point is not unique are in none of them, because there the estimated error, which rests on derivatives, is too
large.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from math import radians, tan
from typing import Any

import numpy as np

from hypcheck import toml
from hypcheck.bench.plan import POSITION, BenchPlan
from hypcheck.errors import InputError
from hypcheck.geometry.pair import SIZES
from hypcheck.geometry.rows import PAIRS, Floats, Layout, Rows, tilted_rows
from hypcheck.implementations.description import QUESTIONS
from hypcheck.kernel.specialise.settings import REACH, Setting, settings_of
from hypcheck.scene.model import FREE, SceneModel, is_tilted
from hypcheck.scene.reading import read_scene
from hypcheck.vectors import frozen
from hypcheck.vectors.draw import BLOCK, Draw, in_turn
from hypcheck.vectors.families import FAMILIES, SWEEP_FAMILIES, family_of
from hypcheck.vectors.random_pairs import BODY, ROTOR, TOWER, Sizes, beside_surface, centred
from hypcheck.vectors.tilted import Vectors, anywhere, beside

NEAR_SCENES = (
    (*TOWER, *BODY),
    (*TOWER, *ROTOR),
    (0.6, 3.0, 0.35, 0.85),  # a trunk wider than the walker
    (0.2, 2.0, 0.35, 0.9),  # a trunk narrower than the walker
    (30.0, 65.0, 0.01, 0.01),  # a large tower and a 1 cm drone: where Δ overflows in float32
    (5.0, 2.0, 1.0, 1.0),  # (γ/d)² < α/b: outside the regime of the paper's Proposition 3
)
"""α, γ, b, d of the pairs of bodies that the workload near contact uses in turn."""

NEAR_GAPS = (-57, -2)
"""Distances from contact, in spheroid radii, are m 2^e with 1 ≤ m < 2 and e of this range: 1e-17 to 0.5."""


_Rows = Callable[[int, int], Rows]
"""A function from a seed and a number to so many rows, the first ones of that seed."""

SWEEP_SHARE = 6
"""A sweep takes about a millisecond to decide, so a sixth of the rows of other workloads is judged."""

TILTED_SHARE = 4
"""To estimate a row's distance to another position takes ten milliseconds: a quarter of the rows is judged."""


@dataclass(frozen=True)
class Workload:
    """`rows(seed, n)` are n of its rows, or all if it has fewer, float64 (n, columns of the layout).

    `timed`: methods are timed on it, not only judged. One in `share` of the rows that a run judges is judged. `layout`
    says what the columns mean.
    """

    name: str
    title: str
    text: str
    rows: _Rows
    timed: bool = True
    share: int = 1
    layout: Layout = PAIRS

    def judged(self, plan: BenchPlan) -> int:
        """Return the number of rows on which a fast method is judged."""
        return plan.amounts.judged // self.share


def scene_of(rows: Rows, layout: Layout = PAIRS) -> tuple[float, float, float, float] | None:
    """Return α, γ, b, d if all rows share them, and the axis if the rows have one; else None."""
    places = slice(len(SIZES), len(layout.upright))
    if not len(rows) or (np.delete(rows, places, axis=1) != np.delete(rows[0], places)).any():
        return None
    alpha, gamma, b, d = rows[0, :4].tolist()
    return alpha, gamma, b, d


_Block = Callable[[Draw, int, int], Rows]
"""A function to the rows of a block from its random numbers, its size, and the number of rows before it."""


def _in_blocks(make: _Block, width: int, *stream: str) -> _Rows:
    """Return rows drawn in blocks, each from its own random stream: fewer rows are the first rows of more."""

    def rows(seed: int, count: int) -> Rows:
        numbers = range(-(-count // BLOCK))
        blocks = [make(Draw(*stream, 1, seed, number), BLOCK, number * BLOCK) for number in numbers]
        return np.ascontiguousarray(np.concatenate([np.empty((0, width)), *blocks])[:count])

    return rows


def _families(*names: str) -> _Block:
    """Return rows of several families with one layout, taken from the families in turn."""
    make = in_turn(*(family_of(name).make for name in names))
    return lambda draw, n, _before: make(draw, n)


def _in_cycle(values: Sequence[Any], n: int, before: int) -> Floats:
    """Return the values of `n` rows that take these values or tuples in turn, after `before` earlier rows."""
    return np.array(values)[(before + np.arange(n)) % len(values)]


def _near_contact(draw: Draw, n: int, before: int) -> Rows:
    """Return rows near contact, of NEAR_SCENES in turn."""
    return near(draw, Sizes(*_in_cycle(NEAR_SCENES, n, before).T), NEAR_GAPS)


def near(draw: Draw, size: Sizes, gaps: tuple[int, int]) -> Rows:
    """Return centres on either side of the surface, one radius plus or minus m 2^e away, with e in the range `gaps`."""
    n = len(size.b)
    near_the_waist = draw.words(n) >> np.uint64(63) == 0
    height = draw.unit(n) * np.where(near_the_waist, np.minimum(size.c, 8.0), size.c)
    gap = draw.signs(n) * draw.log_uniform(n, *gaps)
    # Inside, a ball can touch only a throat that is wider than the ball.
    side = np.where(size.a >= 1, draw.signs(n), 1.0)
    return centred(draw, size, *beside_surface(size.a, size.c, height, side * (1 + gap)))


@cache
def frozen_sweeps(groups: frozenset[str]) -> Rows:
    """Return the frozen sweeps of the families whose rows have these groups of columns, all families in turn."""
    families = [frozen.load(name).rows for name in frozen.SWEEP_NAMES if SWEEP_FAMILIES[name].groups == groups]
    places = np.concatenate([np.arange(len(rows)) for rows in families])
    return np.concatenate(families)[np.argsort(places, kind="stable")]


PITCH = 20.0
"""By how many degrees the quadcopter is tilted along x in the workload of one axis."""


def _one_axis(draw: Draw, n: int, _before: int) -> Rows:
    """Return rows around the tower with one axis, that of a pitched quadcopter."""
    return tilted_rows(TOWER + BODY, _in_the_box(draw, n), (tan(radians(PITCH)), 0.0, 1.0))


def _an_axis_each(draw: Draw, n: int, _before: int) -> Rows:
    """Return rows around the tower, each with an axis of its own."""
    axes = _axes_up_to_45_degrees(draw, n)
    return tilted_rows(TOWER + BODY, _in_the_box(draw, n), axes)


def _axes_up_to_45_degrees(draw: Draw, n: int) -> Vectors:
    """Return axes that are tilted by up to 45° to any side."""
    cosine, sine = draw.circle(n)
    tangent = draw.unit(n)
    return tangent * cosine, tangent * sine, np.ones(n)


def _in_the_box(draw: Draw, n: int) -> Vectors:
    """Return centres uniform in the box of the workload "uniform"."""
    alpha, gamma = TOWER
    return (
        draw.between(n, -2 * alpha, 2 * alpha),
        draw.between(n, -2 * alpha, 2 * alpha),
        draw.between(n, -gamma, gamma),
    )


def _tilted_near_contact(draw: Draw, n: int, before: int) -> Rows:
    """Return tilted rows near contact, of NEAR_SCENES in turn."""
    return tilted_near(draw, _in_cycle(NEAR_SCENES, n, before), anywhere(draw, n))


def tilted_near(draw: Draw, sizes: Floats, axis: Vectors, gaps: tuple[int, int] = NEAR_GAPS) -> Rows:
    """Return centres on either side of the surface, one radius ± m 2^e from a point of it, with e in `gaps`."""
    n = len(sizes)
    height = draw.signs(n) * draw.unit(n)
    gap = draw.signs(n) * draw.log_uniform(n, *gaps)
    return beside(draw, Sizes(*sizes.T), height, axis, draw.signs(n) * (1 + gap))


def _pitched(*names: str) -> _Block:
    """Return sweeps of these families in turn, each with an axis that is tilted to any side, by up to 45°."""
    make = _families(*names)

    def rows(draw: Draw, n: int, before: int) -> Rows:
        return np.column_stack([make(draw, n, before), *_axes_up_to_45_degrees(draw, n)])

    return rows


_MADE: Mapping[str, _Block] = {
    "near contact": _near_contact,
    "tilted near contact": _tilted_near_contact,
    "one axis": _one_axis,
    "an axis each": _an_axis_each,
}
"""The functions for rows that are of no family, by the names that workloads.toml has for them."""


@cache
def listed(question: str, *, tilted: bool = False) -> dict[str, Workload]:
    """Return the workloads that workloads.toml lists for a question, by name, in the order of the record."""
    entries = toml.shipped("hypcheck.bench", "workloads.toml")[f"tilted {question}" if tilted else question]
    layout = QUESTIONS[question].layout
    width = len(layout.tilted if tilted else layout.upright)
    share = SWEEP_SHARE if layout.has_end else TILTED_SHARE if tilted else 1
    return {
        name: Workload(name, entry["title"], entry["text"], _rows_of(entry, width), entry["timed"], share, layout)
        for name, entry in entries.items()
    }


def _rows_of(entry: Mapping[str, Any], width: int) -> _Rows:
    """Return the rows of an entry of workloads.toml, which have `width` numbers."""
    if "family" in entry:
        return FAMILIES[entry["family"]].rows
    if "frozen" in entry:
        groups = frozenset(entry["frozen"])
        return lambda _seed, count: frozen_sweeps(groups)[:count].copy()
    if "rows" in entry:
        make = _MADE[entry["rows"]]
    else:
        make = _pitched(*entry["pitched"]) if "pitched" in entry else _families(*entry["families"])
    return _in_blocks(make, width, *entry["stream"])


WORKLOADS = listed(POSITION)
"""The workloads of positions of upright spheroids."""


def tilted_scenes(names: tuple[str, ...]) -> list[str]:
    """Return the scenes whose mover is tilted, or may be. Raises InputError for a scene that does not exist."""
    return [name for name in names if is_tilted(read_scene(name).mover.axis)]


@cache
def scene_workloads(name: str) -> dict[str, Workload]:
    """Return the workloads of a scene whose mover is tilted.

    Raises InputError if a hyperboloid is tilted as well, or if the scene has no query.
    """
    scene = read_scene(name)
    tilted = next((body for body in scene.hyperboloids if is_tilted(body.axis)), None)
    if tilted is not None:
        raise InputError(
            f"the scene {scene.name!r} is not measured: the hyperboloid {tilted.name!r} is tilted, and rows of ten "
            "numbers are about upright ones"
        )
    settings = settings_of(scene)
    if not settings:
        raise InputError(f"the scene {scene.name!r} is not measured: no hyperboloid's height meets its region")
    axis = "an axis each, in all directions" if scene.mover.axis == FREE else "the mover's axis"
    gaps = "at distances from touching that are log-uniform from 1e-17 to 0.5 spheroid radii"
    described: dict[str, tuple[str, str, _Block]] = {
        "region": (
            f"in the scene {scene.name}",
            f"Centres uniform in the scene's region, {axis}.",
            partial(_in_region, scene, settings),
        ),
        "near-contact": (
            "near contact",
            f"The scene's bodies, {axis}, {gaps}.",
            partial(_near_in_scene, scene, settings),
        ),
    }
    return {
        name: Workload(name, title, text, _in_blocks(make, 10, "bench-tilted", name), share=TILTED_SHARE)
        for name, (title, text, make) in described.items()
    }


def _axes_of(scene: SceneModel, draw: Draw, n: int) -> Vectors:
    """Return n axes of the scene's mover, anywhere if its axis is free."""
    if scene.mover.axis == FREE:
        return anywhere(draw, n)
    x, y, z = (np.full(n, float(number)) for number in scene.mover.axis)
    return x, y, z


def _in_region(scene: SceneModel, settings: tuple[Setting, ...], draw: Draw, n: int, before: int) -> Rows:
    """Return rows in the scene's region, of its settings in turn."""
    sizes = _in_cycle([setting.sizes for setting in settings], n, before)
    ends = _in_cycle([_ends(setting) for setting in settings], n, before)
    centre = [low + (high - low) * draw.unit(n) for low, high in np.transpose(ends, (1, 2, 0))]
    return np.column_stack([sizes, *centre, *_axes_of(scene, draw, n)]) + 0.0


def _ends(setting: Setting) -> list[tuple[float, float]]:
    """Return the least and the greatest x, y, z of a centre; where the region is open, bounds around the surface."""
    alpha, gamma, b, d = setting.sizes
    open_ends = (REACH * (alpha + b), REACH * (alpha + b), REACH * (gamma + d))
    return [
        (-far, far) if span is None else (span.low, span.high)
        for span, far in zip(setting.box.spans, open_ends, strict=True)
    ]


def _near_in_scene(scene: SceneModel, settings: tuple[Setting, ...], draw: Draw, n: int, before: int) -> Rows:
    """Return rows of the scene's settings near contact."""
    return tilted_near(draw, _in_cycle([setting.sizes for setting in settings], n, before), _axes_of(scene, draw, n))


def workloads_of(plan: BenchPlan) -> dict[str, Workload]:
    """Return the workloads that the plan can choose from, by name."""
    if plan.scenes:
        return scene_workloads(*plan.scenes)
    return listed(plan.question, tilted=plan.tilted)
