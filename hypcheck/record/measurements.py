"""The lines of a benchmark, since 1.1.0. Flip distances are absolute, not in units u; ratios over 1 are slower.

Intervals are at 95 %. A value is None if a single method or a single run cannot give it.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import UNSET, Meta, UnsetType

from hypcheck.record import fields

Mode = Annotated[str, fields.one_of("batch", "single", "build")]
"""Many rows a call, one row a call, or the building of a mesh."""

Octave = tuple[int | Annotated[str, Meta(pattern="^-inf$")], fields.Count, fields.Count]
"""The floor of log2 of a distance to the other answer ("-inf": an exact tangency), cases asked, and wrong."""

Grid = tuple[float, float, fields.Count]
"""The first, the last, and how many."""

Load = tuple[fields.Amount, fields.Amount, fields.Amount] | None
"""How many processes wanted a processor, averaged over 1, 5 and 15 minutes."""


class MethodLine(fields.RecordLine, frozen=True, kw_only=True):
    """A method that was measured."""

    method: str
    title: str
    tier: Annotated[str, fields.one_of("C", "numpy", "python", "FCL", "foreign")]
    kind: Annotated[
        str,
        fields.one_of(
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
    question: fields.Question
    exact: bool
    amortised: Annotated[str, fields.one_of("build once", "build each")] | None
    accuracy_only: bool
    note: str


class WorkloadLine(fields.RecordLine, frozen=True, kw_only=True):
    """Rows that methods are asked; `scene`: α, γ, b, d if all rows share them."""

    workload: str
    title: str
    text: str
    rows: fields.Count
    seed: int
    timed: bool | UnsetType = UNSET
    scene: fields.Sizes | UnsetType | None = UNSET


class AbsentLine(fields.RecordLine, frozen=True, kw_only=True):
    """Something that is not installed, so that the methods that need it are left out; since 1.2.0."""

    what: str
    reason: str


class CompilerLine(fields.RecordLine, frozen=True, kw_only=True):
    """The compiler of the methods in C; since 1.2.0."""

    program: str
    version: str
    flags: list[str]


class ConditionsLine(fields.RecordLine, frozen=True, kw_only=True):
    """The conditions of the measurement, since 1.2.0; None if the system does not report them."""

    governor: str | None
    processors: fields.Count
    load_before: Load
    load_after: Load


class UnmeasuredLine(fields.RecordLine, frozen=True, kw_only=True):
    """A method that could not be timed here, which does not fail the run; since 1.4.0."""

    method: str
    workload: str
    mode: Mode
    reason: str


class RefusedLine(fields.RecordLine, frozen=True, kw_only=True):
    """A method that is not timed because its answers were wrong, which fails the run; since 1.2.0."""

    method: str
    workload: str
    mode: Mode
    reason: str


class Mistaken(fields.LinePart, frozen=True, kw_only=True):
    """A wrong answer that is kept; since 1.6.0, `axis` is that of a tilted spheroid, and `end` that of a way.

    Of a way the row's centre is its start, and the flip distance is the change of the spheroid's size.
    """

    case: str
    row: fields.Row
    end: fields.Centre | UnsetType = UNSET
    axis: fields.Axis | UnsetType = UNSET
    heights: fields.Heights | UnsetType = UNSET
    truth: fields.Truth
    answer: int
    flip_distance: fields.Unsigned


class AccuracyLine(fields.RecordLine, frozen=True, kw_only=True):
    """A method's answers on a workload; at distances above `reliable_above`, at most 1 in 1000 is wrong."""

    method: str
    workload: str
    asked: fields.Count
    wrong: fields.Count
    false_clear: fields.Count
    false_contact: fields.Count
    wrong_side: fields.Count
    abstained: fields.Count
    octaves: list[Octave]
    reliable_above: fields.Unsigned
    worst: Annotated[list[Mistaken], Meta(max_length=3)]

    def __post_init__(self) -> None:
        for number, (octave, cases, wrong) in enumerate(self.octaves):
            fields.require_places(() if isinstance(octave, str) else (octave,), f"octaves[{number}]")
            fields.require_counts(cases, wrong, f"octaves[{number}]")


class SpeedLine(fields.RecordLine, frozen=True, kw_only=True):
    """A method's time on a workload: nanoseconds a row, a call or a mesh; the rounds of each process.

    `dropped`, since 1.4.0: samples left out because the empty call, which is subtracted, took as long.
    """

    method: str
    workload: str
    mode: Mode
    rows: fields.Count
    loops: fields.Count
    samples_ns: Annotated[list[Annotated[list[float], Meta(min_length=1)]], Meta(min_length=1)]
    dropped: fields.Count | UnsetType = UNSET
    median_ns: float
    ci95_ns: fields.Interval
    ratio: fields.Amount | None
    ratio_ci95: fields.Interval | None
    checksum: int | None
    empty_ns: float | None
    timed_by: str


class NoiseLine(fields.RecordLine, frozen=True, kw_only=True):
    """One method compared with itself; a difference below `floor` means nothing in this run."""

    workload: str
    mode: Mode
    ratio: fields.Amount | None
    ratio_ci95: fields.Interval | None
    floor: fields.Amount


class MemoryLine(fields.RecordLine, frozen=True, kw_only=True):
    """The bytes by which a fresh process grows while it answers `rows`."""

    method: str
    rows: fields.Count
    peak_bytes: fields.Count


class StabilityLine(fields.RecordLine, frozen=True, kw_only=True):
    """Wrong answers over sizes: bins [floor of 2 log10(α/b), floor of 2 log10(γ/d), asked, wrong]."""

    method: str
    precision: str
    bins: list[fields.Bin]

    def __post_init__(self) -> None:
        fields.require_possible("bins", self.bins)


class Scenery(fields.LinePart, frozen=True, kw_only=True):
    """The sizes of a scene."""

    alpha: float
    gamma: float
    b: float
    d: float


class PlacesLine(fields.RecordLine, frozen=True, kw_only=True):
    """Where a method is wrong in a half plane: a text for each z; "." right, c false clear, w false contact, s side."""

    method: str
    scene: Scenery
    r: Grid
    z: Grid
    wrong: list[Annotated[str, Meta(pattern="^[.cws]+$")]]
    region: Annotated[str, fields.one_of("whole", "ring")]


class ConvergenceLine(fields.RecordLine, frozen=True, kw_only=True):
    """A mesh of so many triangles: its times, its deviation in spheroid radii, and its wrong answers."""

    method: str
    triangles: fields.Count
    build_ns: fields.Amount
    query_ns: fields.Amount
    deviation: fields.Amount
    asked: fields.Count
    wrong: fields.Count


class BoundingLine(fields.RecordLine, frozen=True, kw_only=True):
    """A shape around the spheroid; `overlap`: d/b, asked, false contacts, median excess clearance in radii."""

    shape: Annotated[str, fields.one_of("sphere", "cylinder")]
    workload: str
    asked: fields.Count
    false_contact: fields.Count
    false_clear: fields.Count
    overlap: list[tuple[float, fields.Count, fields.Count, float | None]]

    def __post_init__(self) -> None:
        for number, (_, cases, wrong, _) in enumerate(self.overlap):
            fields.require_counts(cases, wrong, f"overlap[{number}]")


class Compared(fields.LinePart, frozen=True, kw_only=True):
    """One side of a claim about cost: operations counted, times measured."""

    name: str
    operations: fields.Counts | None
    median_ns: fields.Amount | None
    ratio: fields.Amount | None
    ratio_ci95: fields.Interval | None


class CostLine(fields.RecordLine, frozen=True, kw_only=True):
    """A claim of the paper about cost, and the verdict on it."""

    claim: str
    scene: str
    compared: list[Compared]
    verdict: Annotated[str, fields.one_of("holds", "does not hold", "inconclusive")]
    says: str


class KernelLine(fields.RecordLine, frozen=True, kw_only=True):
    """A target of a kernel's speed, and whether it is met."""

    name: str
    target: str
    wanted: float
    measured: float
    ci95: fields.Interval | None
    met: bool
    says: str


class ForestLine(fields.RecordLine, frozen=True, kw_only=True):
    """The cost of a walker's step among so many trees; since 1.3.0."""

    method: str
    title: str
    exact: bool
    trees: fields.Count
    triangles: fields.Count | None
    asked: fields.Count
    wrong: fields.Count
    build_s: fields.Amount
    step_ns: fields.Amount
    ci95_ns: fields.Interval | None
    ratio: fields.Amount | None
    ratio_ci95: fields.Interval | None


class Shares(fields.LinePart, frozen=True, kw_only=True):
    """The share of a scene's centres that each stage of its kernel decides."""

    always: Annotated[float, Meta(ge=0, le=1)]
    thresholds: Annotated[float, Meta(ge=0, le=1)]
    lines: Annotated[float, Meta(ge=0, le=1)]
    discriminant: Annotated[float, Meta(ge=0, le=1)]
    search: Annotated[float, Meta(ge=0, le=1)]


class SceneTimes(fields.LinePart, frozen=True, kw_only=True):
    """Nanoseconds a row of three kernels, and the ratio of the scene's kernel to each of the others."""

    kernel_ns: fields.Amount
    printed_ns: fields.Amount
    certified_ns: fields.Amount
    by_printed: fields.Amount | None
    by_printed_ci95: fields.Interval | None
    by_certified: fields.Amount | None
    by_certified_ci95: fields.Interval | None


class SceneLine(fields.RecordLine, frozen=True, kw_only=True):
    """The kernel of a scene: what each stage decides, and what it saves; since 1.3.0."""

    scene: str
    question: str
    precision: str
    settings: fields.Count
    rows: fields.Count
    wrong: fields.Count
    shares: Shares
    batch: SceneTimes
    single: SceneTimes


class ComparisonLine(fields.RecordLine, frozen=True, kw_only=True):
    """Ratios to the reference method in this run and in the baseline; `gates`: whether they decide the exit code."""

    method: str
    workload: str
    mode: Mode
    before: float
    after: float
    change: float
    ci95: fields.Interval | None
    verdict: Annotated[str, fields.one_of("same", "faster", "slower", "inconclusive")]
    allowed: float
    gates: bool = True
