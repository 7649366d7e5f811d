"""The lines of a benchmark, since 1.1.0. Flip distances are absolute, not in units u; ratios over 1 are slower.

Intervals are at 95 %. A value is None if a single method or a single run cannot give it.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import UNSET, Meta, UnsetType

from hypcheck.record.fields import (
    Amount,
    Axis,
    Bin,
    Centre,
    Count,
    Counts,
    Heights,
    Interval,
    LinePart,
    Question,
    RecordLine,
    Row,
    Sizes,
    Truth,
    Unsigned,
    one_of,
    require_counts,
    require_places,
    require_possible,
)

Mode = Annotated[str, one_of("batch", "single", "build")]
"""Many rows a call, one row a call, or the building of a mesh."""

Octave = tuple[int | Annotated[str, Meta(pattern="^-inf$")], Count, Count]
"""The floor of log2 of a distance to the other answer ("-inf": an exact tangency), cases asked, and wrong."""

Grid = tuple[float, float, Count]
"""The first, the last, and how many."""

Load = tuple[Amount, Amount, Amount] | None
"""How many processes wanted a processor, averaged over 1, 5 and 15 minutes."""


class MethodLine(RecordLine, frozen=True, kw_only=True):
    """A method that was measured."""

    method: str
    title: str
    tier: Annotated[str, one_of("C", "numpy", "python", "FCL", "foreign")]
    kind: Annotated[
        str,
        one_of(
            "paper",
            "algebraic",
            "certified",
            "roots",
            "exact",
            "mesh",
            "bounding",
            "sampling",
            "advancement",
            "foreign",
        ),
    ]
    precision: str
    question: Question
    exact: bool
    amortised: Annotated[str, one_of("build once", "build each")] | None
    accuracy_only: bool
    note: str


class WorkloadLine(RecordLine, frozen=True, kw_only=True):
    """Rows that methods are asked; `scene`: α, γ, b, d if all rows share them."""

    workload: str
    title: str
    text: str
    rows: Count
    seed: int
    timed: bool | UnsetType = UNSET
    scene: Sizes | UnsetType | None = UNSET


class AbsentLine(RecordLine, frozen=True, kw_only=True):
    """Something that is not installed, so that the methods that need it are left out; since 1.2.0."""

    what: str
    reason: str


class CompilerLine(RecordLine, frozen=True, kw_only=True):
    """The compiler of the methods in C; since 1.2.0."""

    program: str
    version: str
    flags: list[str]


class ConditionsLine(RecordLine, frozen=True, kw_only=True):
    """The conditions of the measurement, since 1.2.0; None if the system does not report them."""

    governor: str | None
    processors: Count
    load_before: Load
    load_after: Load


class UnmeasuredLine(RecordLine, frozen=True, kw_only=True):
    """A method that could not be timed here, which does not fail the run; since 1.4.0."""

    method: str
    workload: str
    mode: Mode
    reason: str


class RefusedLine(RecordLine, frozen=True, kw_only=True):
    """A method that is not timed because its answers were wrong, which fails the run; since 1.2.0."""

    method: str
    workload: str
    mode: Mode
    reason: str


class Mistaken(LinePart, frozen=True, kw_only=True):
    """A wrong answer that is kept; since 1.6.0, `axis` is that of a tilted spheroid, and `end` that of a way.

    Of a way the row's centre is its start, and the flip distance is the change of the spheroid's size.
    """

    case: str
    row: Row
    end: Centre | UnsetType = UNSET
    axis: Axis | UnsetType = UNSET
    heights: Heights | UnsetType = UNSET
    truth: Truth
    answer: int
    flip_distance: Unsigned


class AccuracyLine(RecordLine, frozen=True, kw_only=True):
    """A method's answers on a workload; at distances above `reliable_above`, at most 1 in 1000 is wrong."""

    method: str
    workload: str
    asked: Count
    wrong: Count
    false_clear: Count
    false_contact: Count
    wrong_side: Count
    abstained: Count
    octaves: list[Octave]
    reliable_above: Unsigned
    worst: Annotated[list[Mistaken], Meta(max_length=3)]

    def __post_init__(self) -> None:
        for number, (octave, asked, wrong) in enumerate(self.octaves):
            require_places(() if isinstance(octave, str) else (octave,), f"octaves[{number}]")
            require_counts(asked, wrong, f"octaves[{number}]")


class SpeedLine(RecordLine, frozen=True, kw_only=True):
    """A method's time on a workload: nanoseconds a row, a call or a mesh; the rounds of each process.

    `dropped`, since 1.4.0: samples left out because the empty call, which is subtracted, took as long.
    """

    method: str
    workload: str
    mode: Mode
    rows: Count
    loops: Count
    samples_ns: Annotated[list[Annotated[list[float], Meta(min_length=1)]], Meta(min_length=1)]
    dropped: Count | UnsetType = UNSET
    median_ns: float
    ci95_ns: Interval
    ratio: Amount | None
    ratio_ci95: Interval | None
    checksum: int | None
    empty_ns: float | None
    timed_by: str


class NoiseLine(RecordLine, frozen=True, kw_only=True):
    """One method compared with itself; a difference below `floor` means nothing in this run."""

    workload: str
    mode: Mode
    ratio: Amount | None
    ratio_ci95: Interval | None
    floor: Amount


class MemoryLine(RecordLine, frozen=True, kw_only=True):
    """The bytes by which a fresh process grows while it answers `rows`."""

    method: str
    rows: Count
    peak_bytes: Count


class StabilityLine(RecordLine, frozen=True, kw_only=True):
    """Wrong answers over sizes: bins [floor of 2 log10(α/b), floor of 2 log10(γ/d), asked, wrong]."""

    method: str
    precision: str
    bins: list[Bin]

    def __post_init__(self) -> None:
        require_possible("bins", self.bins)


class Scenery(LinePart, frozen=True, kw_only=True):
    """The sizes of a scene."""

    alpha: float
    gamma: float
    b: float
    d: float


class PlacesLine(RecordLine, frozen=True, kw_only=True):
    """Where a method is wrong in a half plane: a text for each z; "." right, c false clear, w false contact, s side."""

    method: str
    scene: Scenery
    r: Grid
    z: Grid
    wrong: list[Annotated[str, Meta(pattern="^[.cws]+$")]]
    region: Annotated[str, one_of("whole", "ring")]


class ConvergenceLine(RecordLine, frozen=True, kw_only=True):
    """A mesh of so many triangles: its times, its deviation in spheroid radii, and its wrong answers."""

    method: str
    triangles: Count
    build_ns: Amount
    query_ns: Amount
    deviation: Amount
    asked: Count
    wrong: Count


class BoundingLine(RecordLine, frozen=True, kw_only=True):
    """A shape around the spheroid; `overlap`: d/b, asked, false contacts, median excess clearance in radii."""

    shape: Annotated[str, one_of("sphere", "cylinder")]
    workload: str
    asked: Count
    false_contact: Count
    false_clear: Count
    overlap: list[tuple[float, Count, Count, float | None]]

    def __post_init__(self) -> None:
        for number, (_, asked, wrong, _) in enumerate(self.overlap):
            require_counts(asked, wrong, f"overlap[{number}]")


class Compared(LinePart, frozen=True, kw_only=True):
    """One side of a claim about cost: operations counted, times measured."""

    name: str
    operations: Counts | None
    median_ns: Amount | None
    ratio: Amount | None
    ratio_ci95: Interval | None


class CostLine(RecordLine, frozen=True, kw_only=True):
    """A claim of the paper about cost, and the verdict on it."""

    claim: str
    scene: str
    compared: list[Compared]
    verdict: Annotated[str, one_of("holds", "does not hold", "inconclusive")]
    says: str


class KernelLine(RecordLine, frozen=True, kw_only=True):
    """A target of a kernel's speed, and whether it is met."""

    name: str
    target: str
    wanted: float
    measured: float
    ci95: Interval | None
    met: bool
    says: str


class ForestLine(RecordLine, frozen=True, kw_only=True):
    """The cost of a walker's step among so many trees; since 1.3.0."""

    method: str
    title: str
    exact: bool
    trees: Count
    triangles: Count | None
    asked: Count
    wrong: Count
    build_s: Amount
    step_ns: Amount
    ci95_ns: Interval | None
    ratio: Amount | None
    ratio_ci95: Interval | None


class Shares(LinePart, frozen=True, kw_only=True):
    """The share of a scene's centres that each stage of its kernel decides."""

    always: Annotated[float, Meta(ge=0, le=1)]
    thresholds: Annotated[float, Meta(ge=0, le=1)]
    lines: Annotated[float, Meta(ge=0, le=1)]
    discriminant: Annotated[float, Meta(ge=0, le=1)]
    search: Annotated[float, Meta(ge=0, le=1)]


class SceneTimes(LinePart, frozen=True, kw_only=True):
    """Nanoseconds a row of three kernels, and the ratio of the scene's kernel to each of the others."""

    kernel_ns: Amount
    printed_ns: Amount
    certified_ns: Amount
    by_printed: Amount | None
    by_printed_ci95: Interval | None
    by_certified: Amount | None
    by_certified_ci95: Interval | None


class SceneLine(RecordLine, frozen=True, kw_only=True):
    """The kernel of a scene: what each stage decides, and what it saves; since 1.3.0."""

    scene: str
    question: str
    precision: str
    settings: Count
    rows: Count
    wrong: Count
    shares: Shares
    batch: SceneTimes
    single: SceneTimes


class ComparisonLine(RecordLine, frozen=True, kw_only=True):
    """Ratios to the reference method in this run and in the baseline; `gates`: whether they decide the exit code."""

    method: str
    workload: str
    mode: Mode
    before: float
    after: float
    change: float
    ci95: Interval | None
    verdict: Annotated[str, one_of("same", "faster", "slower", "inconclusive")]
    allowed: float
    gates: bool = True
