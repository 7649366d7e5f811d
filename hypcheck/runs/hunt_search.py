"""The search of a hunt: first rows of all strata, then local search and further rows in turn.

A stratum is a thin set of rows on a surface where wrong answers are likely (hunt_surfaces.py). Each family of vectors
is a stratum: tangencies and other double roots (Δ = 0), the ring, vanishing coefficients, the axis, the waist, the
borders of the regimes, long ratios. The other strata are the crossings of four surfaces, z = 0, r = 0, a = 1 and
c² = a, with each other and with the border of contact: rows on them and very close to them. An implementation with
fixed sizes is tested only with their families; one that takes heights first with hyperboloids that end.

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

from hypcheck.geometry.pair import NO_GROUPS, Groups
from hypcheck.geometry.rows import PAIRS, SWEEPS, FixedSizes, Floats, Layout, Mask, Row, Rows, as_wide, fits, invalid
from hypcheck.runs.hunt import ClusterKey, Hunt
from hypcheck.runs.hunt_surfaces import (
    EXPONENTS,
    SIZE,
    SURFACES,
    border_factors,
    columns_of,
    crossing,
    moved,
    movers_of,
    movers_within,
)
from hypcheck.vectors.draw import Draw, Family, Integers, stepped
from hypcheck.vectors.families import ENDED_FAMILIES, ENDED_SWEEP_FAMILIES, FAMILIES, SWEEP_FAMILIES, TILTED_FAMILIES
from hypcheck.vectors.fixed_sizes import families_for

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
"""The sets of columns that a neighbour multiplies by one factor, by the groups of a row.

If the set holds all lengths of one unit, or an axis, the answer is the same in exact arithmetic; only roundings change.
"""

CROSSING_BLOCK = 96
"""The number of rows of a crossing that are made at a time: to move them to the border takes longer than to test
them."""

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
    """Return all strata for an implementation that takes these groups, families of vectors first.

    For fixed sizes and for sweeps there are only the families for them.
    """
    families = [family for family in _FAMILIES.values() if fits(family.groups, taken)]
    if "end" in taken:
        return tuple(map(_of_sweeps, families))
    if settings:
        return tuple(map(_of_family, families_for(settings)))
    crossings = [names for size in (1, 2, 3) for names in combinations(SURFACES, size) if movers_within(names)]
    return (*map(_of_family, families), *map(_of_crossing, crossings))


def _of_family(family: Family) -> HuntStratum:
    """Return the stratum of a family of pairs."""
    return HuntStratum(f"the family {family.name}", family.block)


def _of_sweeps(family: Family) -> HuntStratum:
    """Return the stratum of a family of sweeps, with small blocks."""

    def rows(seed: int, number: int) -> Rows:
        return family.columns_between(seed, number * SWEEPS_TOGETHER, (number + 1) * SWEEPS_TOGETHER).T

    return HuntStratum(f"the family {family.name}", rows)


def _of_crossing(surfaces: tuple[str, ...]) -> HuntStratum:
    """Return the stratum of rows on these surfaces at the border of contact."""
    name = f"contact beside {' and '.join(surfaces)}"
    return HuntStratum(name, lambda seed, number: crossing(Draw(name, VERSION, seed, number), CROSSING_BLOCK, surfaces))


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
    """Rows (n, 7, 10, 13 or 16) to test.

    `owners` (n,) are the numbers of the climbers to which they belong, `ladders` (n,) the numbers of their ladders.
    A row on no ladder has a ladder of its own. The rungs of a ladder are ordered away from the border: the last with a
    wrong answer is the worst.
    """

    rows: Rows
    owners: Integers
    ladders: Integers


RUNGS = 4 ** np.arange(EXPONENTS // 2, dtype=np.int64)
"""The distances of a ladder's rungs from the border, in ulp of the factor."""


def ladders(rows: Rows, mask: Mask, factors: Floats) -> tuple[Rows, Integers]:
    """Return the rows of the ladders of all rows that have a border, and for each of them the number of its ladder.

    Ladder 2i leads outwards from the border of row i, ladder 2i + 1 inwards; rungs are ordered away from the border.
    """
    owners = np.repeat(np.flatnonzero(np.isfinite(factors)), 2 * len(RUNGS))
    steps = np.tile(np.concatenate([RUNGS, -RUNGS]), len(owners) // (2 * len(RUNGS)))
    side = np.arange(len(owners)) // len(RUNGS) % 2
    return moved(rows[owners], mask[owners], stepped(factors[owners], steps)), 2 * owners + side


def neighbours(draw: Draw, climbers: Sequence[Climber], layout: Layout = PAIRS) -> Neighbours:
    """Return the neighbours of the climbers, rows of this layout."""
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
"""The number of neighbours of sweeps that are moved to the border at a time: each takes 60 decisions of a
millisecond."""


def _borders(draw: Draw, rows: Rows, layout: Layout) -> tuple[Mask, Floats]:
    """Choose for each row the columns to multiply, at random; return them as a mask, and the factors.

    A factor brings its row to the border of contact; it is NaN if none can.
    """
    if not layout.has_end:
        movers = list(movers_of(columns := layout.columns(rows.shape[1])))
        mask = columns_of(np.asarray(movers)[draw.integers(len(rows), 0, len(movers) - 1)], columns)
        return mask, border_factors(rows, mask, draw.signs(len(rows)) > 0)
    mask, factors = np.zeros(rows.shape, dtype=np.bool_), np.full(len(rows), np.nan)
    mask[:, SIZE] = True
    some = draw.integers(min(BROUGHT, len(rows)), 0, len(rows) - 1)
    factors[some] = border_factors(rows[some], mask[some], np.zeros(len(some), dtype=np.bool_), SWEEPS)
    return mask, factors


def _around(climber: Climber, layout: Layout) -> Rows:
    """Return the row itself, its neighbours one step away, and special rows beside it."""
    row, step = climber.row, climber.step
    moves = _MOVES[layout.groups(row)]
    rows = np.repeat(np.array([row]), 1 + 2 * len(moves), axis=0)
    for number, columns in enumerate(moves):
        rows[1 + 2 * number, columns] *= 1 + step
        rows[2 + 2 * number, columns] /= 1 + step
    special = [_special(row, layout), *([_at_ends(row, layout)] if layout.has_heights(row) else [])]
    return np.concatenate([rows, *special])


def _at_ends(row: Row, layout: Layout) -> Rows:
    """Return eight rows with other ends.

    Four have the centre at an end, or d beyond it. The others lack the lower end, the upper end, or both, or are solid
    instead of open (and the other way round).
    """
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
    """Return the projections of a row onto the four surfaces; for a sweep onto three, and special sweeps beside it."""
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
"""The number of rows of each stratum in the first round; whole blocks follow."""

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
    """Return all strata with rows that the target of a hunt can take."""
    target = run.target
    return strata(target.domain.settings, target.implementation.description.groups)


def _look(run: Hunt, everywhere: Sequence[HuntStratum]) -> Iterator[None]:
    """Test the strata, without end: first some rows of each, then block after block. Yield between the steps."""
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
    """Test rows that the source of this name gives, and add the wrong answers to the hunt."""
    run.add(run.ask(rows), source)


def _climb(run: Hunt) -> Iterator[bool]:
    """Do steps of local searches around the worst answers of clusters, without end.

    Yield after each step: whether there was a search to continue.
    """
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
    """Return the climbers for the next step: those with the longest step first, then those with the worst answer.

    A climber is at the worst answer of its cluster. It starts again with the first step if a worse one is found.
    """
    worst_first = sorted(run.clusters.items(), key=lambda item: item[1].worst.rank, reverse=True)
    for key, cluster in worst_first:
        if key not in climbers or cluster.worst.error > climbers[key].error:
            climbers[key] = Climber(cluster.worst.case.row, cluster.worst.error)
    awake = [key for key, _ in worst_first if not climbers[key].resting]
    return sorted(awake, key=lambda key: -climbers[key].step)[:CLIMBERS_TOGETHER]
