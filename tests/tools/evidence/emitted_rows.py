"""Rows at the limits of an emitted kernel's stages: at each, beside it and beyond it, and for the last stage.

The limits are the plan's own: how far out a discriminant or a search answers, and the surface, where no line decides.
The rows are no judges of the answers: `ask_limits` asks the exact truth.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction

import numpy as np

import hypcheck
from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Mask, Positions, Rows
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

ANSWERS = {
    "position": {"clear": (1, -1), "touching": (0,)},
    "exterior": {"clear": (1,), "touching": ()},
    "contact": {"clear": (0,), "touching": (1,)},
}
"""What says of a spheroid that it is clear, or touches; 0 to the question exterior may rest on the centre's side."""

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
        if stages.setting.cut is None:
            yield from _finest(stages, axis, _far_heights(stages.last))


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
    far = _far_heights(stages.last) if isinstance(stages.last, TiltedSearch) else []
    return np.concatenate([random.uniform(low, high, 40), [0.0, -0.0], ends, far])


def _far_heights(search: TiltedSearch) -> Floats:
    """Heights up to the limit of the search, where its bounds of errors are about as large as what they bound."""
    return search.highest**0.5 * np.array([1e-6, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, -0.3, -0.7, -0.9])


def _tangent(stages: Stages, axis: tuple[float, ...], turn: Floats, z: Floats, side: int) -> Floats:
    """How far from the hyperboloid's axis contact ends at these heights: halved between answers of the exact kernel.

    For the inner side it is 0 where no centre is interior.
    """
    alpha, gamma, b, d = stages.setting.sizes
    high = alpha * np.hypot(1, z / gamma) + 3 * (b + d) * (1 + alpha / gamma)

    def beyond(rho: Floats) -> Mask:
        position = _exact(stages, axis, rho * turn[0], rho * turn[1], z)
        return position == 1 if side > 0 else position != -1

    return _halved(beyond, np.zeros(len(z)), high)


def _exact(stages: Stages, axis: tuple[float, ...], *centre: Floats) -> Positions:
    sizes, given = (np.tile(np.array(each), (len(centre[0]), 1)) for each in (stages.setting.sizes, axis))
    return hypcheck.classify(np.ascontiguousarray(np.column_stack([sizes, *centre, given])))


def _halved(beyond: Callable[[Floats], Mask], low: Floats, high: Floats) -> Floats:
    """The least numbers, but for a rounding, at which `beyond` becomes true."""
    for _ in range(60):
        middle = (low + high) / 2
        is_beyond = beyond(middle)
        low, high = np.where(is_beyond, low, middle), np.where(is_beyond, middle, high)
    return high


def _finest(stages: Stages, axis: tuple[float, ...], z: Floats) -> Iterator[tuple[Floats, ...]]:
    """Centres far out whose clearance is a tiny share of u: y is within contact by a few roundings, x ends it.

    The normal of the surface hardly has an x there, so that roundings of x are much smaller changes than those of y.
    """
    y = _tangent(stages, axis, _TURNS[1], z, 1) * (1 - 2.0**-50)
    x = _halved(lambda x: _exact(stages, axis, x, y, z) == 1, np.zeros(len(z)), 1e-6 * y)
    for power in range(-16, -5):
        for change in np.linspace(-9, 9, 19) * 10.0**power:
            yield x * (1 + change), y, z


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
        yield from _ring(exact, across)


def _ring(exact: dict[str, Fraction], across: Floats) -> Iterator[tuple[Floats, ...]]:
    """Centres next to where the dual function is flat at its pole B, as on the ring of an upright spheroid.

    There the way from the maximum to the pole is as uncertain as it is long.
    """
    shares = [float(exact[f"{row}x"]) * across[0] + float(exact[f"{row}y"]) * across[1] for row in ("r1", "r2")]
    poles, far = [float(exact[name]) for name in ("A1", "A2")], float(exact["B"])
    rho = sum(pole * (share / (pole + far)) ** 2 for pole, share in zip(poles, shares, strict=True)) ** -0.5
    for ulps in range(-40, 41):
        z = 10.0 ** -np.arange(12.0, 32.0, 0.5)
        at = rho * (1 + ulps * 2.0**-52)
        yield np.full(len(z), at * across[0]), np.full(len(z), at * across[1]), z


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
    truth = judge.exact_positions(asked)
    if tilted:
        _judge_proved(plan.question, asked, given, truth)
    for case in wrong_cases(asked, truth, given, criterion):
        worst = judge.in_units(judge.measured(case, plan.question), criterion.unit)
        assert worst <= plan.bound_u, (worst, case)


def _judge_proved(question: str, rows: Rows, given: Positions, truth: Positions) -> None:
    """Answers that rest on a clear spheroid are right, and those that rest on contact if b and d grow by 1 u."""
    clear, touching = (np.isin(given, ANSWERS[question][name]) for name in ("clear", "touching"))
    assert (given == judge.expected(truth, question))[clear].all()
    larger = rows[touching]
    larger[:, 2:4] = np.nextafter(larger[:, 2:4], np.inf)
    assert (judge.exact_positions(larger) == Position.CONTACT).all()
