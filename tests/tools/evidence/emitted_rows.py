"""Rows at the limits of an emitted kernel's stages: at each, beside it and beyond it, and for the last stage.

The limits are the plan's own: how far out a discriminant or a search answers, and the surface, where no line decides.
The rows are no judges of the answers: `ask_limits` asks the exact truth.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction

import numpy as np

import hypcheck
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Rows
from hypcheck.runs import judge
from hypcheck.scene.model import FREE
from tests.support.inside import AXIAL, RADIAL, ScenePlan, Stages, TiltedSearch
from tests.support.judging import wrong_cases

BLOCK = 300
"""Rows of one kind after another, more than a block of a kernel has."""

JUDGED = 7
"""Of the rows each so many-th is judged; all are asked, by both entries."""

AXES = ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.3, 0.1, 1.0), (-1.0, 2.0, 0.5), (3.0, -4.0, 1e-9), (1e-9, 0.0, -1.0))
"""For a kernel of any axis: upright, level, tilted, and next to both."""

_TURNS = np.array([(1.0, 0.0), (0.0, 1.0), (-0.6, 0.8)])


def limit_rows(stages: Stages, single: bool) -> Iterator[Rows]:
    """Rows of 7, or tables of 10 with one axis each."""
    axis = stages.setting.axis
    for each in AXES if axis == FREE else [axis or ()]:
        centres = np.concatenate([np.column_stack(np.broadcast_arrays(*part)) for part in _parts(stages, each, single)])
        sizes, given = np.array(stages.setting.sizes), np.array(each, float)
        if single:
            with np.errstate(over="ignore"):
                centres = centres.astype(np.float32).astype(np.float64)
        yield np.column_stack([np.tile(sizes, (len(centres), 1)), centres, np.tile(given, (len(centres), 1))])


def _parts(stages: Stages, axis: tuple[float, ...], single: bool) -> Iterator[tuple[Floats, ...]]:
    alpha, gamma, b, d = stages.setting.sizes
    random, decades = np.random.default_rng(5), 17 if single else 155
    spread = np.concatenate([random.uniform(-3, decades, 600), random.uniform(-1, 12, 600)])
    z = gamma * 10.0**spread * random.choice((-1.0, 1.0), len(spread))
    yield from _around(alpha, gamma, b, z, random, single)
    for part in _limits(stages):
        yield from _around(alpha, gamma, b, part, random, single)
        yield np.array([0.0]), np.array([0.0]), part[:, None].ravel()
        yield part, 0 * part, 0 * part
        yield part, 0 * part, part[::-1].copy()
        yield 0 * part, part, np.full(len(part), gamma)
    z = _heights(stages, random)
    for side in (1, -1):
        for turn in _TURNS:
            rho = _tangent(stages, axis, turn, z, side)
            for change in (0.0, 2.0**-52, -(2.0**-52), 2.0**-50, 1e-13, -1e-13, 1e-9, -1e-9, 1e-5, -1e-5, 1e-3, -1e-3):
                moved = rho * (1 + change)
                yield moved * turn[0], moved * turn[1], z
    near = b * np.array([0.0, -0.0, 5e-324, 1e-160, 1e-20, 1e-13, 1e-10, 1e-7, 1e-4])
    for x in near:
        z = gamma * random.uniform(-12, 12, BLOCK)
        yield np.full(BLOCK, x), 0.7 * x * np.ones(BLOCK), z
    yield np.full(2 * BLOCK, 0.0), np.full(2 * BLOCK, 0.0), np.linspace(-1e-3 * d, 1e-3 * d, 2 * BLOCK)
    yield 50 * (alpha + b) * (1 + random.random(2 * BLOCK)), np.zeros(2 * BLOCK), np.zeros(2 * BLOCK)
    yield from _odd(_tangent(stages, axis, _TURNS[0], np.zeros(1), 1)[0], gamma)
    if isinstance(stages.last, TiltedSearch):
        yield from _planes(stages, axis, random)


def _around(
    alpha: float, gamma: float, b: float, z: Floats, random: np.random.Generator, single: bool
) -> Iterator[tuple[Floats, ...]]:
    """Centres at these heights on the surface, a rounding or a radius beside it."""
    with np.errstate(over="ignore"):
        surface = alpha * np.hypot(1.0, z / gamma)
        for ulps in (-3, -1, 0, 1, 2):
            turn = _TURNS[random.integers(0, len(_TURNS), len(z))].T
            rho = surface * (1 + ulps * 2.0 ** (-23 if single else -52))
            yield turn[0] * rho, turn[1] * rho, z
        for share in (-1.2, -0.7, 0.4, 0.9, 1.3):
            rho = np.maximum(surface + share * b, 0)
            yield rho, 0 * rho, z
        rho = surface * random.uniform(0.8, 1.3, len(z))
        yield rho, 0 * rho, z


def _limits(stages: Stages) -> Iterator[Floats]:
    """Coordinates whose squares are at the limits of a stage, a few roundings beside them, and far beyond."""
    factors = np.concatenate([1 + np.arange(-4, 5) * 2.0**-52, [0.25, 0.9, 1.1, 3.0, 1e3]])
    for stage in (stages.discriminant, stages.last):
        for square, unit in () if stage is None else ((stage.widest, RADIAL), (stage.highest, AXIAL)):
            with np.errstate(over="ignore"):
                yield square**0.5 / stages.entry_constants.get(unit, 1.0) * factors


def _heights(stages: Stages, random: np.random.Generator) -> Floats:
    """Heights in the region, at its ends, beside and beyond them."""
    gamma, span = stages.setting.sizes[1], stages.setting.box.z
    low, high = (-2 * gamma, 2 * gamma) if span is None else (span.low, span.high)
    ends = [end * factor for end in (low, high) for factor in (1 - 2.0**-52, 1, 1 + 2.0**-52, 1.5, 3.0, 20.0)]
    return np.concatenate([random.uniform(low, high, 40), [0.0, -0.0], ends])


def _tangent(stages: Stages, axis: tuple[float, ...], turn: Floats, z: Floats, side: int) -> Floats:
    """How far from the hyperboloid's axis contact ends at these heights: halved between answers of the exact kernel.

    For the inner side it is 0 where no centre is interior.
    """
    sizes = np.tile(np.array(stages.setting.sizes), (len(z), 1))
    alpha, gamma, b, d = stages.setting.sizes
    low, high = np.zeros(len(z)), alpha * np.hypot(1, z / gamma) + 3 * (b + d) * (1 + alpha / gamma)
    for _ in range(60):
        middle = (low + high) / 2
        rows = [sizes, middle * turn[0], middle * turn[1], z, np.tile(np.array(axis), (len(z), 1))]
        found = hypcheck.classify(np.ascontiguousarray(np.column_stack(rows)))
        beyond = found == 1 if side > 0 else found != -1
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return high


def _odd(x: float, gamma: float) -> Iterator[tuple[Floats, ...]]:
    """A place that the last stage decides, and each of its coordinates something that is hardly a number."""
    odd = np.array([np.nan, np.inf, -np.inf, -0.0, 5e-324, -5e-324, 1e-160, 1e154, -1e154, 1e308, 0.1 * gamma])
    centre = np.tile(np.array([x, 0.0, 0.0]), (3 * len(odd), 1))
    centre[np.arange(len(centre)), np.repeat(np.arange(3), len(odd))] = np.tile(odd, 3)
    yield tuple(centre.T)


def _planes(stages: Stages, axis: tuple[float, ...], random: np.random.Generator) -> Iterator[tuple[Floats, ...]]:
    """Centres in the planes of the frame, where one component is 0 but for its error: x and y are given, z is found."""
    (alpha, gamma, b, _), search = stages.setting.sizes, stages.last
    assert isinstance(search, TiltedSearch)
    level = np.array(axis[:2]) if any(axis[:2]) else np.array([1.0, 0.0])
    for power in range(-6, 12):
        reach = level * 2.0**power
        z = gamma * np.concatenate([random.uniform(-3, 3, 40), [0.0]])
        tangent = _inverse(alpha, gamma, b, float(np.hypot(*reach)))
        z = np.concatenate([z, tangent, -tangent])
        yield np.full(len(z), reach[0]), np.full(len(z), reach[1]), z
        yield np.full(len(z), -reach[1]), np.full(len(z), reach[0]), z
    if not search.free:
        exact = {name: sum(map(Fraction, value)) for name, value in search.constants.items()}
        across = np.array([-level[1], level[0]]) / np.hypot(*level)
        for rho in np.linspace(0.1 * b, alpha + 1.5 * b, 400):
            x, y = (float(part) for part in rho * across)
            for row in ("r2", "r3"):
                z = -(exact[f"{row}x"] * Fraction(x) + exact[f"{row}y"] * Fraction(y)) / exact[f"{row}z"]
                yield np.array([x]), np.array([y]), np.array([float(z)])


def _inverse(alpha: float, gamma: float, b: float, rho: float) -> Floats:
    """Heights at which the surface is this far out, or up to a radius nearer or farther."""
    near = (rho + b * np.linspace(-1.2, 1.2, 60)) / alpha
    return gamma * np.sqrt(near[near > 1] ** 2 - 1)


def ask_limits(plan: ScenePlan, stages: Stages, ask: Callable[[Rows], np.ndarray]) -> None:
    """Ask the rows of a setting, and raise AssertionError where an answer is not as the head of the kernel promises.

    Beyond the modelled height nothing can be said. Elsewhere an answer is within the bound, or none where the last
    stage cannot decide: so far out that something overflows, or between the bounds of double-double.
    """
    if not stages.searches:
        return
    for rows in limit_rows(stages, plan.format.name == "float32"):
        found = ask(rows)
        _judge(plan, stages, rows[::JUDGED], found[::JUDGED])


def _judge(plan: ScenePlan, stages: Stages, rows: Rows, found: np.ndarray) -> None:
    cut, numbers = stages.setting.cut, np.isfinite(rows).all(axis=1)
    if cut is not None:
        with np.errstate(invalid="ignore"):
            beyond = (rows[:, 6] < cut.low) | (rows[:, 6] > cut.high)
        assert (found[beyond] == CANNOT_SAY).all() or plan.format.name != "float64"
        numbers &= ~beyond
    tilted = isinstance(stages.last, TiltedSearch)
    near = (np.abs(rows[:, 4:7]) < 1e6 * max(stages.setting.sizes)).all(axis=1)
    assert not (found[near & numbers] == CANNOT_SAY).any() or tilted
    kept = numbers & (found != CANNOT_SAY)
    if plan.format.name == "float32":  # what is not near may leave the format on its way in
        kept &= near
    criterion = judge.Criterion(plan.question, plan.format.name, Fraction(8))
    asked, given = rows[kept], found[kept]
    wrong = wrong_cases(asked, judge.exact_positions(asked), given, criterion)
    for case in wrong:
        worst = judge.in_units(judge.measured(case, plan.question), criterion.unit)
        assert worst <= plan.bound_u, (worst, case)
