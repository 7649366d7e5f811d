"""The plan of a benchmark: its options, and how much it measures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from hypcheck.errors import InputError
from hypcheck.implementations.session import Limits
from hypcheck.messages import suggestion

REFERENCE = "table-2-float64"
"""All ratios are relative to the time of this method: the paper's own formula in numpy, which runs everywhere."""

TILTED_REFERENCE = "eigh"
"""The reference if spheroids are tilted: numpy.linalg.eigh and the dual function, as one writes it in numpy."""

PASSAGE_REFERENCE = "passage-exact"
"""The reference for sweeps: the exact decision in Python's integers."""

POSITION, PASSAGE = "position", "passage"
"""The two subjects for which a run compares methods: one position, with any question about it, or a sweep."""

MAX_SLOWDOWN = 1.1
"""The slowdown that a baseline allows by default."""

RESTARTS = 3
"""How often a SPEC that crashes or hangs is restarted: enough to find one row at fault, which fails the run."""


@dataclass(frozen=True, slots=True)
class Amounts:
    """The amounts of work of a full or a quick run.

    A fast method answers `judged` rows of each workload, and `timed` rows make a timed batch; a sample of a batch lasts
    at least `sample_s` seconds. `cell` rows fill a cell of a stability map, and a map of places has `map_lines` lines.
    The procedures answer `bodies` positions along flights. `most_triangles` bounds the meshes. `memory` says whether
    memory is measured.
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
    rounds in each of `processes` fresh processes. `baseline` is a record to compare with: a method's time relative to
    the reference may be `max_slowdown` times the time there.

    `kernel`, `forest` and `scenes` each select a run that measures one subject only: the fast path against its targets,
    a walker's step among many trees, the savings of the kernels of these scenes. `tilted` compares methods for tilted
    spheroids; so does a scene whose mover is tilted. `question` is "passage" if methods for sweeps are compared.

    Files go into `folder`, also the library `compiled` of methods in C, if there is one. `missing` is the software that
    methods need and that is not available here; `foreign` are the methods of the SPECs (bench/contenders.py).
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
        choices = (self.kernel, self.forest, bool(self.scenes))
        alone = [name for name, is_given in zip(whats, choices, strict=True) if is_given]
        more = len(alone) > 1 or ((self.kernel or self.forest) and (self.chosen or self.tilted))
        if more:
            raise InputError(f"{alone[0]} measures only {whats[alone[0]]}; leave out the other choices")
        if self.question == PASSAGE and alone:
            raise InputError(f"--question passage compares methods for sweeps; leave out {alone[0]}")

    @property
    def everyday(self) -> bool:
        """Whether the run is about positions of upright spheroids; only these have maps, meshes and claims."""
        return not self.tilted and self.question == POSITION

    @property
    def whole(self) -> bool:
        """Whether the run measures everything, which takes minutes: no choice was made, and it is not quick."""
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
        """The plan in the form of the record's header."""
        shown = {name: value for name, value in asdict(self).items() if name not in _FOUND_OUT}
        baseline = None if self.baseline is None else str(self.baseline)
        return {"command": "bench", **shown, "baseline": baseline, "reference": self.reference}


_FOUND_OUT = ("limits", "folder", "compiled", "missing", "foreign")
"""Fields that are not options of a user."""


def chosen_names(names: Sequence[str], patterns: Sequence[str], noun: str) -> list[str]:
    """Return the names that match a pattern, in the order of `names`; all names if there is no pattern.

    Raises InputError for a pattern that matches nothing.
    """
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in names):
            raise InputError(f"there is no {noun} {pattern!r}; {suggestion(pattern, names)}")
    return [name for name in names if not patterns or any(fnmatchcase(name, pattern) for pattern in patterns)]
