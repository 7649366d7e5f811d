"""The plan of a benchmark: its options, and the workloads (rows) on which methods are compared.

Three workloads are timed and judged, three only judged. A workload's rows depend only on its name, the seed and their
place; a shorter call returns the first rows of a longer one (vectors/draw.py).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import SIZES
from hypcheck.geometry.rows import PAIRS, Layout, Rows
from hypcheck.implementations.session import Limits
from hypcheck.messages import suggestion
from hypcheck.vectors.draw import Draw, in_turn
from hypcheck.vectors.families import FAMILIES
from hypcheck.vectors.family import BLOCK
from hypcheck.vectors.random_pairs import Sizes, beside_surface, centred
from hypcheck.vectors.scenes import BODY, ROTOR, TOWER

REFERENCE = "table-2-float64"
"""All ratios are relative to the time of this method: the paper's own formula in numpy, which runs everywhere."""

TILTED_REFERENCE = "eigh"
"""The same where spheroids lean: numpy.linalg.eigh and the dual function, as one writes it in numpy."""

PASSAGE_REFERENCE = "passage-exact"
"""The same of ways: the exact decision in Python's integers."""

POSITION, PASSAGE = "position", "passage"
"""What a run compares methods for: one position, whatever the question about it, or the way between two."""

MAX_SLOWDOWN = 1.1
"""The slowdown that a baseline allows by default."""

RESTARTS = 3
"""Restarts of a SPEC that crashes or hangs: enough to find one row at fault, which fails the run."""


@dataclass(frozen=True, slots=True)
class Amounts:
    """The amounts of work of a full or a quick run.

    `judged` rows of each workload are asked of a fast method, and `timed` rows make a timed batch; a sample of a batch
    lasts at least `sample_s` seconds. `cell` rows fill a cell of a stability map, and a map of places has `map_lines`
    lines. `bodies` positions along flights are asked of the procedures. `most_triangles` bounds the meshes. `memory`
    says whether memory is measured.
    """

    judged: int
    timed: int
    sample_s: float
    cell: int
    map_lines: int
    bodies: int
    most_triangles: int
    memory: bool


FULL = Amounts(
    judged=12_000,
    timed=49_152,
    sample_s=0.008,
    cell=48,
    map_lines=61,
    bodies=16_384,
    most_triangles=100_000,
    memory=True,
)
QUICK = Amounts(
    judged=1_500, timed=16_384, sample_s=0.002, cell=8, map_lines=31, bodies=4_096, most_triangles=1_000, memory=False
)


@dataclass(frozen=True, slots=True)
class BenchPlan:
    """Options of a benchmark.

    `specs` name implementations to measure beside the built-in methods; `methods` and `workloads` are names and globs
    (none: all). `amounts` are the amounts of work; a `quick` run leaves out what takes long. Times come from `rounds`
    rounds in each of `processes` fresh processes. `baseline` is a record to compare with: a method may be
    `max_slowdown` times slower against the reference than there.

    `kernel`, `forest` and `scenes` measure one thing only: the fast path against its targets, a walker's step among
    many trees, the savings of these scenes. `tilted` compares methods for spheroids whose axis leans; so does a scene
    whose mover leans. `question` is "passage" where methods for ways are compared.

    Files go into `folder`, also the library `compiled` of methods in C, if there is one. `missing` are needs of methods
    that are not available here, and `foreign` are the methods of the SPECs (bench/foreign.py).
    """

    specs: tuple[str, ...] = ()
    methods: tuple[str, ...] = ()
    workloads: tuple[str, ...] = ()
    quick: bool = False
    amounts: Amounts = FULL
    seed: int = 1
    processes: int = 5
    rounds: int = 5
    workers: int = 2
    baseline: Path | None = None
    max_slowdown: float = MAX_SLOWDOWN
    kernel: bool = False
    forest: bool = False
    tilted: bool = False
    question: str = POSITION
    scenes: tuple[str, ...] = ()
    folder: Path = Path()
    compiled: Path | None = None
    foreign: tuple[Any, ...] = ()
    missing: tuple[str, ...] = ()
    limits: Limits = field(default_factory=lambda: Limits(restarts=RESTARTS))

    def __post_init__(self) -> None:
        whats = {"--kernel": "the fast path", "--forest": "a walker's step", "--scene": "scenes"}
        given = (self.kernel, self.forest, bool(self.scenes))
        alone = [name for name, is_given in zip(whats, given, strict=True) if is_given]
        more = len(alone) > 1 or ((self.kernel or self.forest) and (self.chosen or self.tilted))
        if more:
            raise InputError(f"{alone[0]} measures {whats[alone[0]]} and nothing else; it goes with no other choice")
        if self.question == PASSAGE and (alone or self.tilted):
            other = "--tilted" if self.tilted else alone[0]
            raise InputError(f"--question passage compares methods for ways of upright spheroids; leave out {other}")

    @property
    def everyday(self) -> bool:
        """Whether it is about positions of upright spheroids, for which there are maps, meshes and claims besides."""
        return not self.tilted and self.question == POSITION

    @property
    def whole(self) -> bool:
        """Whether the run measures everything, which takes minutes: nothing was chosen, and it is not quick."""
        return not self.quick and not self.chosen and self.everyday

    @property
    def chosen(self) -> bool:
        """Whether implementations, methods, workloads or an earlier record were named."""
        return bool(self.specs or self.methods or self.workloads or self.baseline)

    @property
    def reference(self) -> str:
        """The method that all ratios of this run are relative to."""
        if self.question == PASSAGE:
            return PASSAGE_REFERENCE
        return TILTED_REFERENCE if self.tilted else REFERENCE

    @property
    def options(self) -> dict[str, Any]:
        """The plan as the record's header has it."""
        shown = {name: value for name, value in asdict(self).items() if name not in _FOUND_OUT}
        baseline = None if self.baseline is None else str(self.baseline)
        return {"command": "bench", **shown, "baseline": baseline, "reference": self.reference}


_FOUND_OUT = ("limits", "folder", "compiled", "missing", "foreign")
"""Fields that are no options of a user."""


def chosen_names(names: Sequence[str], patterns: Sequence[str], noun: str) -> list[str]:
    """The names that match a pattern, in their own order; all names without a pattern.

    Raises InputError for a pattern that matches nothing.
    """
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in names):
            raise InputError(f"there is no {noun} {pattern!r}; {suggestion(pattern, names)}")
    return [name for name in names if not patterns or any(fnmatchcase(name, pattern) for pattern in patterns)]


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


@dataclass(frozen=True)
class Workload:
    """`rows(seed, n)` are n of its rows, or all that there are, float64 (n, 7), or (n, 10) of spheroids that lean.

    `timed`: methods are timed on it, not only judged. One in `share` of the rows that a run judges is judged. `layout`
    says what the columns mean.
    """

    name: str
    title: str
    text: str
    rows: Callable[[int, int], Rows]
    timed: bool = True
    share: int = 1
    layout: Layout = PAIRS

    def judged(self, plan: BenchPlan) -> int:
        """The number of rows of it that a fast method is asked."""
        return plan.amounts.judged // self.share


def scene_of(rows: Rows, layout: Layout = PAIRS) -> tuple[float, float, float, float] | None:
    """α, γ, b, d if all rows share them, and the axis where they have one; else None."""
    places = slice(len(SIZES), len(layout.upright))
    if not len(rows) or (np.delete(rows, places, axis=1) != np.delete(rows[0], places)).any():
        return None
    alpha, gamma, b, d = rows[0, :4].tolist()
    return alpha, gamma, b, d


def near_contact(seed: int, count: int) -> Rows:
    """Centres near contact, in the scenes of NEAR_SCENES in turn."""
    scenes, numbers = np.array(NEAR_SCENES), range(-(-count // BLOCK))
    turns = ((number * BLOCK + np.arange(BLOCK)) % len(scenes) for number in numbers)
    blocks = [
        near(Draw("bench-near-contact", 1, seed, number), Sizes(*scenes[turn].T), NEAR_GAPS)
        for number, turn in zip(numbers, turns, strict=True)
    ]
    return np.concatenate([np.empty((0, 7)), *blocks])[:count]


def near(draw: Draw, size: Sizes, gaps: tuple[int, int]) -> Rows:
    """Centres at one radius from the surface, plus or minus m 2^e with e in the range `gaps`, on either side."""
    n = len(size.b)
    near_the_waist = draw.words(n) >> np.uint64(63) == 0
    height = draw.unit(n) * np.where(near_the_waist, np.minimum(size.c, 8.0), size.c)
    gap = draw.signs(n) * draw.log_uniform(n, *gaps)
    # Inside, a ball touches only a throat that is wider than itself.
    side = np.where(size.a >= 1, draw.signs(n), 1.0)
    return centred(draw, size, *beside_surface(size.a, size.c, height, side * (1 + gap)))


def _mixed(*names: str) -> Callable[[int, int], Rows]:
    """Rows of several families in turn."""
    make = in_turn(*(FAMILIES[name].make for name in names))

    def rows(seed: int, count: int) -> Rows:
        blocks = [make(Draw("bench", *names, 1, seed, number), BLOCK) for number in range(-(-count // BLOCK))]
        return np.concatenate([np.empty((0, 7)), *blocks])[:count]

    return rows


WORKLOADS = {
    workload.name: workload
    for workload in (
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
            near_contact,
        ),
        Workload(
            "ring",
            "on the ring and next to it",
            "Half clear positions where Δ = 0 exactly, half within 1e-12 to 1e-2 radii of such (docs/mathematics.md).",
            _mixed("ring", "ring-neighbourhood"),
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
}
"""By name, in the order of the record."""
