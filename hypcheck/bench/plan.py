"""What one run of bench is asked to do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from hypcheck.errors import InputError
from hypcheck.methods.limits import Limits
from hypcheck.suggesting import advice

REFERENCE = "table-2-float64"
"""The method whose time every ratio is relative to: the paper's own formula in numpy, which runs everywhere."""

MAX_SLOWDOWN = 1.1
"""What a baseline allows where nothing else is said."""

RESTARTS = 3
"""Of a SPEC that crashes or hangs: enough to find a row at fault, which fails the run; the rest need not be known."""


@dataclass(frozen=True, slots=True)
class Amounts:
    """How much is done: what makes a run full or quick.

    `judged` rows of each workload are asked of a fast method, `timed` rows make a timed batch; `sample_s` is what a
    sample lasts at least, in a batch; `cell` rows fill a cell of a stability map; a map of places has `map_lines`
    lines; `bodies` positions along flights are asked of the procedures; `most_triangles` bounds the meshes.
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
    """Options of a run.

    `specs` name implementations to be measured beside the built-in methods; `methods` and `workloads` are names and
    globs that choose (none: all). `amounts` say how much is done; a `quick` run leaves out what takes long. Times come
    from `rounds` rounds in each of `processes` fresh processes. `baseline` is a record to be held to: a method may be
    `max_slowdown` times slower against the reference than it was there.

    `kernel`, `forest` and `scenes` measure one thing and nothing else: the fast path against its targets, a walker's
    step among many trees, what these scenes do without.

    What is made on the way goes into `folder`, `compiled` among it: the library of methods in C, where there is one.
    `missing` is what methods may need and is not here, and `foreign` what the SPECs are (contenders/foreign.py).
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
    scenes: tuple[str, ...] = ()
    folder: Path = Path()
    compiled: Path | None = None
    foreign: tuple[Any, ...] = ()
    missing: tuple[str, ...] = ()
    limits: Limits = field(default_factory=lambda: Limits(restarts=RESTARTS))

    def __post_init__(self) -> None:
        alone = [name for name, given in (("--kernel", self.kernel), ("--forest", self.forest)) if given]
        alone += ["--scene"] if self.scenes else []
        if alone and (len(alone) > 1 or self.specs or self.methods or self.workloads or self.baseline):
            what = {"--kernel": "the fast path", "--forest": "a walker's step", "--scene": "scenes"}[alone[0]]
            raise InputError(f"{alone[0]} measures {what} and nothing else; it goes with no other choice")

    @property
    def whole(self) -> bool:
        """Whether everything is measured that takes minutes: nothing was chosen, and there is time."""
        return not (self.quick or self.specs or self.methods or self.workloads or self.baseline)

    @property
    def options(self) -> dict[str, Any]:
        """The plan as the record's header shows it."""
        shown = {name: value for name, value in asdict(self).items() if name not in _FOUND_OUT}
        baseline = None if self.baseline is None else str(self.baseline)
        return {"command": "bench", **shown, "baseline": baseline, "reference": REFERENCE}


_FOUND_OUT = ("limits", "folder", "compiled", "missing", "foreign")
"""What is no option of a user's."""


def chosen(names: Sequence[str], patterns: Sequence[str], noun: str) -> list[str]:
    """The names that the patterns reach, in their own order; all of them without a pattern.

    Raises InputError for a pattern that names nothing.
    """
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in names):
            raise InputError(f"there is no {noun} {pattern!r}; {advice(pattern, names)}")
    return [name for name in names if not patterns or any(fnmatchcase(name, pattern) for pattern in patterns)]
