"""The workloads of a benchmark: rows on which methods are compared, of upright and tilted spheroids and of sweeps.

Some are timed and judged, the others only judged. A workload's rows depend only on its name, the seed and their place:
a call for fewer rows returns the first rows of a call for more (vectors/draw.py). Pairs of tilted spheroids whose
nearest point is not unique are in none of them, because there the estimated error, which rests on derivatives, is too
large.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial
from math import radians, tan
from typing import Any

import numpy as np

from hypcheck.bench.plan import PASSAGE, BenchPlan
from hypcheck.errors import InputError
from hypcheck.geometry.pair import SIZES
from hypcheck.geometry.rows import PAIRS, SWEEPS, Floats, Layout, Rows, tilted_rows
from hypcheck.kernel.specialise.settings import REACH, Setting, settings_of
from hypcheck.scene.model import FREE, SceneModel, is_tilted
from hypcheck.scene.reading import read_scene
from hypcheck.vectors import frozen
from hypcheck.vectors.draw import Draw, in_turn
from hypcheck.vectors.families import FAMILIES, SWEEP_FAMILIES, family_of
from hypcheck.vectors.family import BLOCK
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
"""The first rows for a seed, as many as are asked for."""


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
        """The number of rows on which a fast method is judged."""
        return plan.amounts.judged // self.share


def scene_of(rows: Rows, layout: Layout = PAIRS) -> tuple[float, float, float, float] | None:
    """α, γ, b, d if all rows share them, and the axis if the rows have one; else None."""
    places = slice(len(SIZES), len(layout.upright))
    if not len(rows) or (np.delete(rows, places, axis=1) != np.delete(rows[0], places)).any():
        return None
    alpha, gamma, b, d = rows[0, :4].tolist()
    return alpha, gamma, b, d


_Block = Callable[[Draw, int, int], Rows]
"""Rows of a block: from its random numbers, its size, and the number of rows before it."""


def _in_blocks(make: _Block, width: int, *stream: str) -> _Rows:
    """Rows in blocks, each with its random stream: a call for fewer rows gives the first rows of a call for more."""

    def rows(seed: int, count: int) -> Rows:
        numbers = range(-(-count // BLOCK))
        blocks = [make(Draw(*stream, 1, seed, number), BLOCK, number * BLOCK) for number in numbers]
        return np.ascontiguousarray(np.concatenate([np.empty((0, width)), *blocks])[:count])

    return rows


def _families(*names: str) -> _Block:
    """Rows of several families with one layout, taken from the families in turn."""
    make = in_turn(*(family_of(name).make for name in names))
    return lambda draw, n, _before: make(draw, n)


def _in_turn(stream: str, *names: str) -> _Rows:
    """As _families, with random numbers from the stream of that name."""
    return _in_blocks(_families(*names), len(family_of(names[0]).columns), stream, *names)


def _in_cycle(values: Sequence[Any], n: int, before: int) -> Floats:
    """The values of `n` rows that take these values or tuples in turn, after `before` earlier rows."""
    return np.array(values)[(before + np.arange(n)) % len(values)]


def _near_contact(draw: Draw, n: int, before: int) -> Rows:
    return near(draw, Sizes(*_in_cycle(NEAR_SCENES, n, before).T), NEAR_GAPS)


def near(draw: Draw, size: Sizes, gaps: tuple[int, int]) -> Rows:
    """Centres on either side of the surface, one radius plus or minus m 2^e away, with e in the range `gaps`."""
    n = len(size.b)
    near_the_waist = draw.words(n) >> np.uint64(63) == 0
    height = draw.unit(n) * np.where(near_the_waist, np.minimum(size.c, 8.0), size.c)
    gap = draw.signs(n) * draw.log_uniform(n, *gaps)
    # Inside, a ball can touch only a throat that is wider than the ball.
    side = np.where(size.a >= 1, draw.signs(n), 1.0)
    return centred(draw, size, *beside_surface(size.a, size.c, height, side * (1 + gap)))


def _by_name(*workloads: Workload) -> dict[str, Workload]:
    return {workload.name: workload for workload in workloads}


WORKLOADS = _by_name(
    Workload(
        "uniform",
        "uniform around the tower",
        "A quadcopter's body, uniform in the box |x|, |y| ≤ 4 m, |z| ≤ 17.8 m about the paper's cooling tower.",
        FAMILIES["tower-body"].rows,
    ),
    Workload(
        "flight",
        "along random flights",
        "Positions asked for along the paper's random flights in the tower, 32 consecutive rows a flight, so that "
        "neighbours resemble each other.",
        FAMILIES["flight"].rows,
    ),
    Workload(
        "near-contact",
        "near contact",
        "Six pairs of bodies in turn, at distances from touching that are log-uniform from 1e-17 to 0.5 spheroid "
        "radii, apart and overlapping, outside and inside; sizes differ from row to row.",
        _in_blocks(_near_contact, 7, "bench-near-contact"),
    ),
    Workload(
        "ring",
        "on the ring and next to it",
        "Half clear positions where Δ = 0 exactly, half within 1e-12 to 1e-2 radii of such (docs/mathematics.md).",
        _in_turn("bench", "ring", "ring-neighbourhood"),
        timed=False,
    ),
    Workload(
        "zero-coefficient",
        "where c1 or c2 is 0",
        "Positions at which one of the coefficients vanishes exactly, which the paper's Proposition 5 forgets.",
        FAMILIES["coefficient-zero"].rows,
        timed=False,
    ),
    Workload(
        "ladder",
        "a ladder of ulps beside tangency",
        "Exact tangencies of many sizes with one length moved by 1, 2, 4 … 2⁴⁰ ulp, both ways.",
        FAMILIES["tangent-ladder"].rows,
        timed=False,
    ),
)
"""Those of upright spheroids, by name, in the order of the record."""

SWEEP_SHARE = 6
"""A sweep takes about a millisecond to decide, so a sixth of the rows of other workloads is judged."""


def _frozen_sweeps(_seed: int, count: int, *, tilted: bool) -> Rows:
    return frozen_sweeps(tilted)[:count].copy()


@cache
def frozen_sweeps(tilted: bool) -> Rows:
    """The frozen sweeps of upright or of tilted spheroids, all families in turn."""
    groups = frozenset({"end", "axis"} if tilted else {"end"})
    families = [frozen.load(name).rows for name in frozen.SWEEP_NAMES if SWEEP_FAMILIES[name].groups == groups]
    places = np.concatenate([np.arange(len(rows)) for rows in families])
    return np.concatenate(families)[np.argsort(places, kind="stable")]


def _sweep_workload(name: str, title: str, text: str, rows: _Rows, *, timed: bool = False) -> Workload:
    return Workload(name, title, text, rows, timed, SWEEP_SHARE, SWEEPS)


SWEEP_WORKLOADS = _by_name(
    _sweep_workload(
        "tower",
        "down through the tower's waist",
        "A quadcopter's body straight down through the waist of the paper's cooling tower and out, about as near "
        "to the wall as it may come (the family way-tower).",
        _in_turn("bench-ways", "way-tower"),
        timed=True,
    ),
    _sweep_workload(
        "anywhere",
        "anywhere about the waist",
        "Both ends uniform in a box about the waist; sizes differ from row to row (the family way-anywhere).",
        _in_turn("bench-ways", "way-anywhere"),
        timed=True,
    ),
    _sweep_workload(
        "tunnelling",
        "steps that are too long",
        "Straight through a wall, through the whole waist, past the surface from far away: both ends are mostly "
        "clear and contact is between (the families way-tunnelling, way-across and way-long).",
        _in_turn("bench-ways", "way-tunnelling", "way-across", "way-long"),
    ),
    _sweep_workload(
        "grazing",
        "grazing or nearly so",
        "Tangent at one instant or at an end, or by 2⁻⁵⁰ to 2⁻³ of the size from it (the families way-near-graze, "
        "way-grazing and way-end).",
        _in_turn("bench-ways", "way-near-graze", "way-grazing", "way-end"),
    ),
    _sweep_workload(
        "frozen",
        "the frozen sweeps",
        "The certified vectors of sweeps of upright spheroids, all 19 families in turn (cases/way-*.json).",
        partial(_frozen_sweeps, tilted=False),
    ),
)
"""Those of sweeps of upright spheroids, by name, in the order of the record."""

PITCH = 20.0
"""Degrees by which the quadcopter is tilted along x in the workload of one axis."""

TILTED_SHARE = 4
"""To estimate a row's distance to another position takes ten milliseconds: a quarter of the rows is judged."""


def _one_axis(draw: Draw, n: int, _before: int) -> Rows:
    return tilted_rows(TOWER + BODY, _in_the_box(draw, n), (tan(radians(PITCH)), 0.0, 1.0))


def _an_axis_each(draw: Draw, n: int, _before: int) -> Rows:
    axes = _axes_up_to_45_degrees(draw, n)
    return tilted_rows(TOWER + BODY, _in_the_box(draw, n), axes)


def _axes_up_to_45_degrees(draw: Draw, n: int) -> Vectors:
    """Axes that are tilted by up to 45° to any side."""
    cosine, sine = draw.circle(n)
    tangent = draw.unit(n)
    return tangent * cosine, tangent * sine, np.ones(n)


def _in_the_box(draw: Draw, n: int) -> Vectors:
    """Centres uniform in the box of the workload "uniform"."""
    alpha, gamma = TOWER
    return (
        draw.between(n, -2 * alpha, 2 * alpha),
        draw.between(n, -2 * alpha, 2 * alpha),
        draw.between(n, -gamma, gamma),
    )


def _tilted_near_contact(draw: Draw, n: int, before: int) -> Rows:
    return _tilted_near(draw, _in_cycle(NEAR_SCENES, n, before), anywhere(draw, n))


def _tilted_near(draw: Draw, sizes: Floats, axis: Vectors) -> Rows:
    """Centres on either side of the surface, one radius plus or minus m 2^e from a point of it, with e in NEAR_GAPS."""
    n = len(sizes)
    height = draw.signs(n) * draw.unit(n)
    gap = draw.signs(n) * draw.log_uniform(n, *NEAR_GAPS)
    return beside(draw, Sizes(*sizes.T), height, axis, draw.signs(n) * (1 + gap))


def _tilted_workload(name: str, title: str, text: str, make: _Block, *, timed: bool = True) -> Workload:
    return Workload(name, title, text, _in_blocks(make, 10, "bench-tilted", name), timed, TILTED_SHARE)


TILTED_WORKLOADS = _by_name(
    _tilted_workload(
        "one-axis",
        "tilted one way around the tower",
        f"A quadcopter's body that is tilted by {PITCH:g}° along x, uniform in the box |x|, |y| ≤ 4 m, |z| ≤ 17.8 m "
        "about the paper's cooling tower.",
        _one_axis,
    ),
    _tilted_workload(
        "an-axis-each",
        "an axis each around the tower",
        "The same body in the same box; each row is tilted to any side, by up to 45°.",
        _an_axis_each,
    ),
    _tilted_workload(
        "near-contact",
        "near contact",
        "Six pairs of bodies in turn, axes in all directions, at distances from touching that are log-uniform from "
        "1e-17 to 0.5 spheroid radii, apart and overlapping, outside and inside.",
        _tilted_near_contact,
    ),
    _tilted_workload(
        "all-sizes",
        "near contact, of all sizes",
        "From 2⁻⁵² to 2⁻⁴ radii off contact, sizes of all four regimes (the family tilted-near-contact).",
        _families("tilted-near-contact"),
        timed=False,
    ),
    _tilted_workload(
        "stiff",
        "of very different sizes",
        "Near contact with ratios of sizes up to 1e8, and axes that are almost vertical or horizontal "
        "(the families tilted-stiff and tilted-slight).",
        _families("tilted-stiff", "tilted-slight"),
        timed=False,
    ),
)
"""Those of tilted spheroids, by name, in the order of the record."""


def _pitched(names: Sequence[str]) -> _Block:
    """Sweeps of these families in turn, each with an axis that is tilted to any side, by up to 45°."""
    make = _families(*names)

    def rows(draw: Draw, n: int, before: int) -> Rows:
        return np.column_stack([make(draw, n, before), *_axes_up_to_45_degrees(draw, n)])

    return rows


def _tilted_sweep_workload(name: str, title: str, text: str, make: _Block, *, timed: bool = False) -> Workload:
    return _sweep_workload(name, title, text, _in_blocks(make, 13, "bench-tilted-sweeps", name), timed=timed)


TILTED_SWEEP_WORKLOADS = _by_name(
    _tilted_sweep_workload(
        "tower",
        "down through the tower's waist, tilted",
        "A quadcopter's body straight down through the waist of the paper's cooling tower and out, tilted to any side "
        "by up to 45° (the family way-tower with an axis).",
        _pitched(["way-tower"]),
        timed=True,
    ),
    _tilted_sweep_workload(
        "anywhere",
        "anywhere about the waist, tilted",
        "Both ends about the waist, axes in all directions; sizes differ from row to row (the family "
        "tilted-way-uniform).",
        _families("tilted-way-uniform"),
        timed=True,
    ),
    _tilted_sweep_workload(
        "tunnelling",
        "steps that are too long, tilted",
        "Straight through a wall, through the whole waist, past the surface from far away, tilted to any side by up to "
        "45° (the families way-tunnelling, way-across and way-long with an axis).",
        _pitched(["way-tunnelling", "way-across", "way-long"]),
    ),
    _tilted_sweep_workload(
        "grazing",
        "grazing or nearly so, tilted",
        "Sweeps that end in a tangency, or whose centre passes a clear place where Δ = 0 (the families tilted-way-end "
        "and tilted-way-ring).",
        _families("tilted-way-end", "tilted-way-ring"),
    ),
    _sweep_workload(
        "frozen",
        "the frozen sweeps of tilted spheroids",
        "The certified vectors of sweeps of tilted spheroids, all 5 families in turn (cases/tilted-way-*.json).",
        partial(_frozen_sweeps, tilted=True),
    ),
)
"""Those of sweeps of tilted spheroids, by name, in the order of the record."""


def tilted_scenes(names: tuple[str, ...]) -> list[str]:
    """The scenes whose mover is tilted, or may be. Raises InputError for a scene that does not exist."""
    return [name for name in names if is_tilted(read_scene(name).mover.axis)]


@cache
def scene_workloads(name: str) -> dict[str, Workload]:
    """The workloads of a scene whose mover is tilted.

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
    region, near = partial(_in_region, scene, settings), partial(_near_in_scene, scene, settings)
    axis = "an axis each, in all directions" if scene.mover.axis == FREE else "the mover's axis"
    return _by_name(
        _tilted_workload(
            "region", f"in the scene {scene.name}", f"Centres uniform in the scene's region, {axis}.", region
        ),
        _tilted_workload(
            "near-contact",
            "near contact",
            f"The scene's bodies, {axis}, at distances from touching that are log-uniform from 1e-17 to 0.5 spheroid "
            "radii.",
            near,
        ),
    )


def _axes_of(scene: SceneModel, draw: Draw, n: int) -> Vectors:
    if scene.mover.axis == FREE:
        return anywhere(draw, n)
    x, y, z = (np.full(n, float(number)) for number in scene.mover.axis)
    return x, y, z


def _in_region(scene: SceneModel, settings: tuple[Setting, ...], draw: Draw, n: int, before: int) -> Rows:
    sizes = _in_cycle([setting.sizes for setting in settings], n, before)
    ends = _in_cycle([_ends(setting) for setting in settings], n, before)
    centre = [low + (high - low) * draw.unit(n) for low, high in np.transpose(ends, (1, 2, 0))]
    return np.column_stack([sizes, *centre, *_axes_of(scene, draw, n)]) + 0.0


def _ends(setting: Setting) -> list[tuple[float, float]]:
    """The least and the greatest x, y, z of a centre; where the region is open, bounds around the surface."""
    alpha, gamma, b, d = setting.sizes
    open_ends = (REACH * (alpha + b), REACH * (alpha + b), REACH * (gamma + d))
    return [
        (-far, far) if span is None else (span.low, span.high)
        for span, far in zip(setting.box.spans, open_ends, strict=True)
    ]


def _near_in_scene(scene: SceneModel, settings: tuple[Setting, ...], draw: Draw, n: int, before: int) -> Rows:
    return _tilted_near(draw, _in_cycle([setting.sizes for setting in settings], n, before), _axes_of(scene, draw, n))


def workloads_of(plan: BenchPlan) -> dict[str, Workload]:
    """The workloads that the plan can choose from, by name."""
    if plan.scenes:
        return scene_workloads(*plan.scenes)
    if plan.question == PASSAGE:
        return TILTED_SWEEP_WORKLOADS if plan.tilted else SWEEP_WORKLOADS
    return TILTED_WORKLOADS if plan.tilted else WORKLOADS
