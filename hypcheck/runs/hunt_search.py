"""The search of a hunt: first rows of thin strata, then local search and further strata rows in turn.

A stratum is a thin set of rows on which a case distinction about the pair changes. Each family of vectors is a stratum:
tangencies and other double roots (Δ = 0), the ring, vanishing coefficients, the axis, the waist, the borders of the
regimes, long ratios. The other strata are the crossings of four surfaces, z = 0, r = 0, a = 1 and c² = a, with each
other and with the border of contact: rows on them and very close to them. An implementation with fixed sizes is tested
only with their families; one that takes heights first with hyperboloids that end.

Rows are brought to the border of contact by bisection on exact positions. The position is monotone in every input
(docs/mathematics.md, "Monotone in every input"), so it changes at most twice along a factor on one length, or on x and
y together.

Local search goes from a wrong answer to worse ones, as a pattern search with halving steps. The neighbours of a row
have one of the six unknowns multiplied by 1 ± step (the search space is logarithmic), or lie exactly on a surface.
Floats mostly fail in a thin layer at the border of contact, and a plain step would leave it. So each neighbour is
tested, and also moved to the border. From there a ladder leads away in growing steps; its farthest wrong rung counts. A
sweep is moved there by the spheroid's size: contact is monotone in it (truth/passage_error.py).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS, HEIGHTS, NO_GROUPS, Groups
from hypcheck.geometry.rows import (
    PAIRS,
    SWEEPS,
    FixedSizes,
    Floats,
    Layout,
    Mask,
    Positions,
    Rows,
    as_wide,
    fits,
    invalid,
)
from hypcheck.runs.hunt import ClusterKey, Hunt
from hypcheck.runs.judge import truth_of
from hypcheck.vectors.draw import Draw, Integers, ldexp, stepped
from hypcheck.vectors.families import ENDED_FAMILIES, ENDED_SWEEP_FAMILIES, FAMILIES, SWEEP_FAMILIES, TILTED_FAMILIES
from hypcheck.vectors.family import Family
from hypcheck.vectors.fixed_sizes import families_for
from hypcheck.vectors.random_pairs import Sizes, centred, heights, offsets

MOVERS: dict[str, tuple[int, ...]] = {
    "radius": (4, 5),
    "height": (6,),
    "alpha": (0,),
    "gamma": (1,),
    "b": (2,),
    "d": (3,),
}
"""The unknowns of a pair with their columns; multiplied by one factor, each can reach the border of contact."""

END_MOVERS: dict[str, tuple[int, ...]] = {"lower end": (10,), "upper end": (11,)}
"""The same of the heights between which a hyperboloid ends."""

SIZE = (2, 3)
"""The columns of b and d, which are the size of the spheroid together."""

REACH = 2.0**12
"""Factors from 1/REACH to REACH are tried."""

EXPONENTS = 46
"""Rows are moved up to 2^(EXPONENTS − 1) ulp of the factor away from the border."""

RUNGS = 4 ** np.arange(EXPONENTS // 2, dtype=np.int64)
"""The rungs of a ladder, in ulp of the factor."""


def columns_of(movers: NDArray[np.str_], columns: Sequence[str] = COLUMNS) -> Mask:
    """The columns that the named movers multiply, as a mask (n, len(columns))."""
    mask = np.zeros((len(movers), len(columns)), dtype=np.bool_)
    for name, places in _movers_of(columns).items():
        mask[np.ix_(movers == name, places)] = True
    return mask


def _movers_of(columns: Sequence[str]) -> dict[str, tuple[int, ...]]:
    """The movers of rows with these columns: the unknowns that can be changed."""
    return MOVERS if set(HEIGHTS).isdisjoint(columns) else MOVERS | END_MOVERS


def moved(rows: Rows, mask: Mask, factor: Floats) -> Rows:
    """The rows with the masked columns multiplied by each row's factor; numbers beyond float64 become infinite."""
    with np.errstate(all="ignore"):
        return np.where(mask, rows * factor[:, None], rows)


def border_factors(rows: Rows, mask: Mask, far: Mask, layout: Layout = PAIRS) -> Floats:
    """The factor just before the position changes or contact on a sweep begins, (n,); NaN if none within REACH.

    If there are two changes, the rows in `far` take the one with the greater factor.
    """
    low, high = np.full(len(rows), 1 / REACH), np.full(len(rows), REACH)
    at_low, at_high = _truths(moved(rows, mask, low), layout), _truths(moved(rows, mask, high), layout)
    changes = (at_low != at_high) & (at_low != UNUSABLE) & (at_high != UNUSABLE)
    rows, mask, far = rows[changes], mask[changes], far[changes]
    at_low, at_high = at_low[changes], at_high[changes]
    # Bisection of bit patterns bisects the logarithm at first, and the factor itself at the end.
    below, above = low[changes].view(np.int64), high[changes].view(np.int64)
    while (above - below).max(initial=0) > 1:
        middle = below + (above - below) // 2
        position = _truths(moved(rows, mask, middle.view(np.float64)), layout)
        before = np.where(far, position != at_high, position == at_low)
        below, above = np.where(before, middle, below), np.where(before, above, middle)
    factors = np.full(len(changes), np.nan)
    factors[changes] = below.view(np.float64)
    return factors


UNUSABLE = 3


def _truths(rows: Rows, layout: Layout) -> Positions:
    """Exact positions, or hits of sweeps; UNUSABLE if a length is outside the range of float64."""
    usable = ~invalid(rows, layout)
    truths = np.full(len(rows), UNUSABLE, dtype=np.int8)
    truths[usable] = truth_of(rows[usable], layout)
    return truths


def beside_border(draw: Draw, rows: Rows, movers: NDArray[np.str_]) -> Rows:
    """The rows, each moved to a border by its mover, then away by a random rung; rows without a border are left out."""
    mask = columns_of(movers)
    factors = border_factors(rows, mask, draw.signs(len(rows)) > 0)
    rungs = ldexp(draw.signs(len(rows)), draw.integers(len(rows), 0, EXPONENTS - 1)).astype(np.int64)
    finite = np.isfinite(factors)
    return moved(rows[finite], mask[finite], stepped(factors[finite], rungs[finite]))


def ladders(rows: Rows, mask: Mask, factors: Floats) -> tuple[Rows, Integers]:
    """The rungs of all rows that have a border, and for each rung the number of its ladder.

    Ladder 2i leads outwards from the border of row i, ladder 2i + 1 inwards; rungs are ordered away from the border.
    """
    owners = np.repeat(np.flatnonzero(np.isfinite(factors)), 2 * len(RUNGS))
    steps = np.tile(np.concatenate([RUNGS, -RUNGS]), len(owners) // (2 * len(RUNGS)))
    side = np.arange(len(owners)) // len(RUNGS) % 2
    return moved(rows[owners], mask[owners], stepped(factors[owners], steps)), 2 * owners + side


SURFACES = {"z = 0": "height", "r = 0": "radius", "a = 1": "alpha", "c² = a": "alpha"}
"""The four surfaces, each with the mover that would leave it."""

CROSSING_BLOCK = 96
"""Rows of a crossing that are made at a time: to reach the border costs more than a question."""

SWEEPS_TOGETHER = 24
"""The number of sweeps of a family that are tested at a time: one takes milliseconds to decide."""

VERSION = 1
"""The version of the generator of crossings, part of its seed."""


@dataclass(frozen=True, slots=True)
class HuntStratum:
    """A set of rows: `rows(seed, number)` is its block with that number, of valid rows."""

    name: str
    rows: Callable[[int, int], Rows]


_FAMILIES = ENDED_SWEEP_FAMILIES | SWEEP_FAMILIES | ENDED_FAMILIES | TILTED_FAMILIES | FAMILIES


def strata(settings: tuple[FixedSizes, ...] = (), taken: Groups = NO_GROUPS) -> tuple[HuntStratum, ...]:
    """All strata where these groups are taken, families of vectors first.

    For fixed sizes and for sweeps there are only the families for them.
    """
    families = [family for family in _FAMILIES.values() if fits(family.groups, taken)]
    if "end" in taken:
        return tuple(map(_of_sweeps, families))
    if settings:
        return tuple(map(_of_family, families_for(settings)))
    crossings = [names for size in (1, 2, 3) for names in combinations(SURFACES, size) if _movers(names)]
    return (*map(_of_family, families), *map(_of_crossing, crossings))


def _of_family(family: Family) -> HuntStratum:
    return HuntStratum(f"the family {family.name}", family.block)


def _of_sweeps(family: Family) -> HuntStratum:
    def rows(seed: int, number: int) -> Rows:
        return family.columns_between(seed, number * SWEEPS_TOGETHER, (number + 1) * SWEEPS_TOGETHER).T

    return HuntStratum(f"the family {family.name}", rows)


def _of_crossing(surfaces: tuple[str, ...]) -> HuntStratum:
    name = f"contact beside {' and '.join(surfaces)}"
    return HuntStratum(name, lambda seed, number: crossing(Draw(name, VERSION, seed, number), CROSSING_BLOCK, surfaces))


def crossing(draw: Draw, n: int, surfaces: tuple[str, ...]) -> Rows:
    """At most n rows on these surfaces or very close to them, each at a random distance from the border of contact."""
    size = _sizes(draw, n, surfaces)
    height = heights(draw, size.c) * _slack(draw, n, pinned="z = 0" in surfaces)
    radius = np.abs(size.a + offsets(draw, n)) * _slack(draw, n, pinned="r = 0" in surfaces)
    rows = centred(draw, size, radius, height)
    movers = np.asarray(_movers(surfaces))
    return beside_border(draw, rows, movers[draw.integers(n, 0, len(movers) - 1)])


def _slack(draw: Draw, n: int, *, pinned: bool) -> Floats:
    """Factors for a distance: 1; if `pinned`, randomly 0 (on the surface) or from 2⁻⁵⁰ to 2⁻³."""
    if not pinned:
        return np.ones(n)
    return np.where(draw.signs(n) < 0, 0.0, draw.log_uniform(n, -50, -3))


def _sizes(draw: Draw, n: int, surfaces: tuple[str, ...]) -> Sizes:
    """Sizes of every regime; on the surfaces α = b, or α/b is the square of γ/d, exactly or nearly."""
    top, bottom = np.floor(draw.log_uniform(n, 0, 12)), np.floor(draw.log_uniform(n, 0, 12))
    if "a = 1" in surfaces:
        top = bottom
    units = ldexp(1, draw.integers(n, -14, -10)), ldexp(1, draw.integers(n, -10, -6))
    b, d = bottom * bottom * units[0], bottom * units[1]
    alpha = top * top * units[0] * _nearly_one(draw, n)
    if "c² = a" in surfaces:
        return Sizes(alpha, top * units[1] * _nearly_one(draw, n), b, d)
    return Sizes(alpha, d * draw.log_uniform(n, -8, 10), b, d)


def _nearly_one(draw: Draw, n: int) -> Floats:
    """Factors 1 and 1 ± 2⁻⁵² … 2⁻³, at random."""
    return np.asarray(1 + draw.signs(n) * np.where(draw.signs(n) < 0, 0.0, draw.log_uniform(n, -52, -3)))


def _movers(surfaces: tuple[str, ...]) -> list[str]:
    """The movers that can bring a row to the border without leaving these surfaces."""
    kept = {SURFACES[surface] for surface in surfaces}
    return [mover for mover in ("radius", "height", "alpha") if mover not in kept]


Row = tuple[float, ...]

FIRST_STEP = 0.5
LAST_STEP = 2.0**-44

_SWEEP_MOVES = [(0,), (1,), (2,), (3,), SIZE, (4, 5), (6,), (7, 8), (9,), (4, 5, 7, 8), (6, 9)]

_MOVES: dict[Groups, list[tuple[int, ...]]] = {
    frozenset(groups): moves
    for groups, moves in (
        ((), [(0,), (1,), (2,), (3,), (4, 5), (6,), (0, 2, 4, 5), (1, 3, 6)]),
        (("axis",), [*((column,) for column in range(10)), (0, 1, 2, 3, 4, 5, 6), (7, 8, 9)]),
        (
            ("axis", "heights"),
            [*((column,) for column in range(12)), (0, 2, 4, 5), (1, 3, 6, 10, 11), (7, 8, 9), (6, 10), (6, 11)],
        ),
        (("end",), [*_SWEEP_MOVES, (0, 2, 4, 5, 7, 8), (1, 3, 6, 9)]),
        (("end", "axis"), [*_SWEEP_MOVES, tuple(range(10)), (10,), (11,), (12,), (10, 11, 12)]),
        (
            ("end", "axis", "heights"),
            [*_SWEEP_MOVES, (0, 2, 4, 5, 7, 8), (1, 3, 6, 9, 13, 14), (10,), (11,), (12,), (13,), (14,)],
        ),
    )
}
"""Columns that are multiplied together, by the groups of a row.

Where they are all of a unit of length, or an axis, only the rounding changes.
"""


@dataclass(slots=True)
class Climber:
    """The state of one local search: its row, the backward error of the answer there, and the next step."""

    row: Row
    error: float
    step: float = FIRST_STEP

    @property
    def resting(self) -> bool:
        """Whether no worse answer was found down to the last step, or none can exist."""
        return self.step < LAST_STEP or not 0 < self.error < math.inf


@dataclass(frozen=True, slots=True)
class Neighbours:
    """Rows (n, 7, 10, 13 or 16) to test; for each row the number of its climber and of its ladder, (n,).

    A row on no ladder has a ladder of its own. The rungs of a ladder are ordered away from the border: the last with a
    wrong answer is the worst.
    """

    rows: Rows
    owners: Integers
    ladders: Integers


def neighbours(draw: Draw, climbers: Sequence[Climber], layout: Layout = PAIRS) -> Neighbours:
    """The neighbours of the climbers, rows of this layout."""
    with np.errstate(all="ignore"):  # rows beyond float64 are not valid, and not tested
        around = [_around(climber, layout) for climber in climbers]
    rows = np.concatenate(as_wide(around, layout))
    owners = np.repeat(np.arange(len(climbers)), [len(part) for part in around])
    valid = ~invalid(rows, layout)
    rows, owners = rows[valid], owners[valid]
    rungs, numbers = ladders(rows, *_borders(draw, rows, layout))
    rungs, numbers = rungs[~invalid(rungs, layout)], numbers[~invalid(rungs, layout)]
    return Neighbours(
        np.concatenate([rows, rungs]),
        np.concatenate([owners, owners[numbers // 2]]),
        np.concatenate([np.arange(len(rows)), len(rows) + numbers]),
    )


BROUGHT = 3
"""Neighbours of a sweep that are brought to the border at a time: each takes about 60 decisions of a millisecond."""


def _borders(draw: Draw, rows: Rows, layout: Layout) -> tuple[Mask, Floats]:
    """The columns of each row that a factor can bring to the border of contact, and the factor; NaN if none can."""
    if not layout.has_end:
        movers = list(_movers_of(columns := layout.columns(rows.shape[1])))
        mask = columns_of(np.asarray(movers)[draw.integers(len(rows), 0, len(movers) - 1)], columns)
        return mask, border_factors(rows, mask, draw.signs(len(rows)) > 0)
    mask, factors = np.zeros(rows.shape, dtype=np.bool_), np.full(len(rows), np.nan)
    mask[:, SIZE] = True
    some = draw.integers(min(BROUGHT, len(rows)), 0, len(rows) - 1)
    factors[some] = border_factors(rows[some], mask[some], np.zeros(len(some), dtype=np.bool_), SWEEPS)
    return mask, factors


def _around(climber: Climber, layout: Layout) -> Rows:
    """The row itself, its neighbours one step away, and special rows beside it."""
    row, step = climber.row, climber.step
    moves = _MOVES[layout.groups(row)]
    rows = np.repeat(np.array([row]), 1 + 2 * len(moves), axis=0)
    for number, columns in enumerate(moves):
        rows[1 + 2 * number, columns] *= 1 + step
        rows[2 + 2 * number, columns] /= 1 + step
    special = [_special(row, layout), *([_at_ends(row, layout)] if layout.has_heights(row) else [])]
    return np.concatenate([rows, *special])


def _at_ends(row: Row, layout: Layout) -> Rows:
    """Rows with the centre at each end or half a height beyond; rows without one end or both; rows with other ends."""
    width, d = len(row), row[3]
    low, high = row[-3:-1]
    images = np.repeat(np.array([row]), 8, axis=0)
    for image, height in zip(images, (low, low - d, high, high + d), strict=False):
        image[6] = height
        if layout.has_end:
            image[9] = height + row[9] - row[6]
    images[4, width - 3] = -np.inf
    images[5, width - 2] = np.inf
    images[6, width - 1] = 1 - row[-1]
    images[7, [width - 3, width - 2]] = -np.inf, np.inf
    return images


def _special(row: Row, layout: Layout) -> Rows:
    """The projections of a row onto the four surfaces; for a sweep onto three, and special sweeps beside it."""
    images = np.repeat(np.array([row]), 7 if layout.has_end else 4, axis=0)
    *others, waist, throat, groove = images
    throat[0] = throat[2]
    groove[1] = groove[3] * np.sqrt(groove[0] / groove[2])
    if not layout.has_end:
        (axis,) = others
        axis[4:6], waist[6] = 0, 0
        return images
    back, still, vertical, horizontal = others
    back[4:7], back[7:10] = row[7:10], row[4:7]
    still[7:10] = row[4:7]
    vertical[7:9] = row[4:6]
    horizontal[9] = row[6]
    waist[[6, 9]] = 0
    return images


FIRST_LOOK = 128
"""Rows of each stratum in the first round; whole blocks follow."""

CLIMBERS_TOGETHER = 4
"""The number of climbers, each of another cluster, whose rows are tested together."""

Progress = Callable[[Hunt], object]


def run_hunt(run: Hunt, progress: Progress = lambda _: None, everywhere: Sequence[HuntStratum] | None = None) -> None:
    """Search for wrong answers until the budget is spent, and add them to `run`; call `progress` after each step.

    The rows come from the strata `everywhere`; None: from all strata that the target claims. With a budget of queries
    only, the same plan finds the same answers. An interrupted hunt keeps its findings.
    """
    looking, climbing = _look(run, strata_of(run) if everywhere is None else everywhere), _climb(run)
    in_strata = 0
    while not run.over:
        before = run.asked
        next(looking)
        in_strata += run.asked - before
        progress(run)
        # Local search and strata get half of the rows each, once there is a wrong answer to start from.
        while not run.over and 2 * in_strata > run.asked and next(climbing):
            progress(run)


def strata_of(run: Hunt) -> tuple[HuntStratum, ...]:
    """All strata with rows that the target of a hunt can take."""
    target = run.target
    return strata(target.domain.settings, target.implementation.description.groups)


def _look(run: Hunt, everywhere: Sequence[HuntStratum]) -> Iterator[None]:
    """Test the strata, without end: first some rows of each, then block after block."""
    for stratum in everywhere:
        _take(run, stratum.rows(run.plan.seed, 0)[:FIRST_LOOK], stratum.name)
        if run.over:
            break
    yield
    number = 0
    while True:
        number += 1
        before = run.asked
        for stratum in everywhere:
            _take(run, stratum.rows(run.plan.seed, number), stratum.name)
            yield
        run.nothing_in_domain = run.asked == before


def _take(run: Hunt, rows: Rows, source: str) -> None:
    run.add(run.ask(rows), source)


def _climb(run: Hunt) -> Iterator[bool]:
    """Do a step of some local searches around the worst answers of clusters; False if there is none to continue."""
    climbers: dict[ClusterKey, Climber] = {}
    number = 0
    while True:
        chosen = _climbers(run, climbers)
        if chosen:
            number += 1
            draw = Draw("hunt", run.plan.seed, number)
            around = neighbours(draw, [climbers[key] for key in chosen], run.target.layout)
            cases = run.ask(around.rows, around.ladders)
            for place, key in enumerate(chosen):
                own = [case for case in cases if around.owners[case.index] == place]
                run.add(own, f"local search from {key[-1]}")
                climbers[key].step /= 2
        yield bool(chosen)


def _climbers(run: Hunt, climbers: dict[ClusterKey, Climber]) -> list[ClusterKey]:
    """The climbers for the next step: those with the longest step first, then those with the worst answer.

    A climber is at the worst answer of its cluster. It starts again with the first step if a worse one is found.
    """
    worst_first = sorted(run.clusters.items(), key=lambda item: item[1].worst.rank, reverse=True)
    for key, cluster in worst_first:
        if key not in climbers or cluster.worst.error > climbers[key].error:
            climbers[key] = Climber(cluster.worst.case.row, cluster.worst.error)
    awake = [key for key, _ in worst_first if not climbers[key].resting]
    return sorted(awake, key=lambda key: -climbers[key].step)[:CLIMBERS_TOGETHER]
