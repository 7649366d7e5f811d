"""The lines of a record as structs, their fields in the order in which they are written (docs/record-lines.md).

Reading a record gives these structs, and the published schema is made from them. Fields that a later version adds to a
line are left out. A field that is UNSET is missing: other runs have it, or the record is older than the field.

History of SCHEMA: 1.0.0, the first; 1.1.0 adds the lines of a benchmark, and null for a range of a domain that was not
declared; 1.2.0 adds a checksum to each line, and of a benchmark the conditions and what is absent, compiled or refused;
1.3.0 adds the progress of a gating run that is interrupted, the sha256 of the files under test, and of a benchmark
scenes and forests; 1.4.0 adds to the header the settings of a run and the sha256 of the program's own files; 1.5.0
adds the axis of tilted spheroids, and that an implementation takes them; 1.6.0 adds the question passage, the end of a
way, times of first contact with the mistakes late and early, the axis of fixed sizes in a domain, and in a benchmark
the end of a way and the kinds sampling and advancement; 1.7.0 adds to the header how implementations were isolated, and
the causes of wrong answers; 1.8.0 adds why rows and families were not asked, and how many fresh rows were; 1.9.0
adds heights of hyperboloids that end, that an implementation takes them, and how evenly a run asked; 1.10.0 adds how
often each answer was given where each was right.
"""

from __future__ import annotations

from typing import Annotated, Any

from msgspec import UNSET, Meta, UnsetType, field

from hypcheck.record import fields

SCHEMA = "1.10.0"
"""The version of the records that are written."""


class Machine(fields.LinePart, frozen=True, kw_only=True):
    """The machine of a run."""

    system: str
    architecture: str
    processor: str
    cores: int | None


class WeakenedPart(fields.LinePart, frozen=True, kw_only=True):
    """An option with which a run fails less or asks less than by default; `source`: settings file or command line."""

    option: str
    value: str
    default: str
    source: str


class SettingsPart(fields.LinePart, frozen=True, kw_only=True):
    """The settings file of a run (None: none was used), and the options that weaken its gate."""

    file: str | None
    weakened: list[WeakenedPart]


class IsolationPart(fields.LinePart, frozen=True, kw_only=True):
    """How implementations were isolated: the mode (auto, on or off), the means, and why others are missing."""

    mode: str
    means: list[str]
    missing: list[str]


class HeaderLine(fields.RecordLine, frozen=True, kw_only=True):
    """The first line: versions, machine and options of a run.

    Some runs add `files`, the sha256 of the files under test by path, since 1.3.0; `program`, that of the program's own
    files, and `settings`, since 1.4.0; `isolation`, since 1.7.0; `not_hashed`, what the implementations start besides
    the files, since 1.8.0.
    """

    schema: Annotated[str, Meta(pattern=r"^1\.[0-9]+\.[0-9]+$")]
    hypcheck: str
    started: str
    python: str
    versions: dict[str, str]
    machine: Machine
    options: dict[str, Any]
    files: dict[str, str] | UnsetType = UNSET
    program: str | UnsetType = UNSET
    settings: SettingsPart | UnsetType = UNSET
    isolation: IsolationPart | UnsetType = UNSET
    not_hashed: list[str] | UnsetType = UNSET


class FooterLine(fields.RecordLine, frozen=True, kw_only=True):
    """The last line, without which a record is truncated; `lines` counts the lines of the file."""

    lines: fields.Count
    exit_code: int
    seconds: float


class UnavailableLine(fields.RecordLine, frozen=True, kw_only=True):
    """An oracle that could not be asked, and why."""

    oracle: str
    reason: str


class EquationLine(fields.RecordLine, frozen=True, kw_only=True):
    """A displayed formula of the paper, and the verdict on it."""

    number: str
    holds: bool
    verdict: Annotated[str, fields.one_of("holds", "misprint", "false")]
    statement: str
    finding: str
    correction: str


class ProofLine(fields.RecordLine, frozen=True, kw_only=True):
    """A quantity of a formula, and whether it is proved to be right."""

    formula: str
    quantity: str
    holds: bool
    statement: str


class DisagreementPart(fields.LinePart, frozen=True, kw_only=True):
    """A case where an oracle and the exact decision disagree."""

    oracle: str
    case: str
    row: fields.Row
    end: fields.Centre | UnsetType = UNSET
    axis: fields.Axis | UnsetType = UNSET
    heights: fields.Heights | UnsetType = UNSET
    exact: str
    opinion: str


class OracleLine(fields.RecordLine, frozen=True, kw_only=True):
    """What one oracle answered about one family."""

    oracle: str
    family: str
    asked: fields.Count
    undecided: fields.Count
    stages: fields.Counts
    seconds: fields.Amount
    disagreeing: fields.Count
    disagreements: Annotated[list[DisagreementPart], Meta(max_length=20)]


class FindingLine(fields.RecordLine, frozen=True, kw_only=True):
    """A formula that is wrong in exact arithmetic on a family, inside or outside its stated regimes."""

    formula: str
    family: str
    inside: bool
    cause: str
    asked: fields.Count
    wrong: fields.Count
    first_case: str
    first_row: fields.Row
    reason: str | None


class DriftLine(fields.RecordLine, frozen=True, kw_only=True):
    """A difference between the findings and the known findings."""

    sentence: str


class WrongAnswer(fields.LinePart, frozen=True, kw_only=True):
    """A wrong or tolerated answer that is kept.

    Of a way, since 1.6.0, the row begins with its start and `end` is the other; `time` is a wrong time, `first` are
    bounds of the first contact, and the backward error is that of the spheroid's size, or of a time in radii travelled.
    """

    case: str
    row: fields.Row
    end: fields.Centre | UnsetType = UNSET
    axis: fields.Axis | UnsetType = UNSET
    heights: fields.Heights | UnsetType = UNSET
    truth: fields.Truth
    answer: int
    mistake: fields.Mistake
    status: str
    backward_error: fields.Unsigned
    backward_error_u: fields.Unsigned
    time: float | UnsetType = UNSET
    first: fields.Interval | UnsetType = UNSET


class FaultPart(fields.LinePart, frozen=True, kw_only=True):
    """A case that ended without an answer that counts, and why."""

    case: str
    row: fields.InvalidRow
    end: fields.InvalidCentre | UnsetType = UNSET
    axis: fields.InvalidAxis | UnsetType = UNSET
    heights: fields.Heights | UnsetType = UNSET
    status: str
    reason: str


class GroupLine(fields.RecordLine, frozen=True, kw_only=True):
    """A method and a family; only implementations under test have `spec`, `faults` and `failing`.

    `octaves` are counts by the floor of log2 of the cases' distances to the other answer, `failing` the statuses that
    fail the run. Since 1.8.0, `not_asked` counts the skipped rows by reason, and `fresh` the rows asked that nobody
    knew before the run, of implementations under test. Since 1.10.0, `answers` counts their answers: by what is true,
    then by what was answered.
    """

    method: str
    spec: str | UnsetType = UNSET
    title: str
    exact: bool
    question: fields.Question
    precision: fields.Precision
    family: str
    asked: fields.Count
    fresh: fields.Count | UnsetType = UNSET
    not_asked: fields.Counts | UnsetType = UNSET
    counts: fields.Counts
    mistakes: fields.Counts
    answers: dict[fields.TruthKey, dict[fields.AnswerKey, fields.Count]] | UnsetType = UNSET
    octaves: dict[str, fields.Counts]
    size_bins: list[fields.Bin]
    place_bins: list[fields.Bin]
    worst: Annotated[list[WrongAnswer], Meta(max_length=3)]
    faults: Annotated[list[FaultPart], Meta(max_length=6)] | UnsetType = UNSET
    failing: list[str] | UnsetType = UNSET

    def __post_init__(self) -> None:
        fields.require_octaves(self.octaves)
        fields.require_possible("size_bins", self.size_bins)
        fields.require_possible("place_bins", self.place_bins)

    @property
    def judged(self) -> int:
        """The number of tested cases, without those that the implementation answered with "cannot say"."""
        return self.asked - self.counts.get("abstained", 0)

    @property
    def skipped(self) -> int:
        """The number of cases outside the domain or the precision, which are not tested."""
        return self.counts.get("skipped", 0)

    @property
    def tested(self) -> bool:
        """Whether the line is about an implementation under test, and so names failing statuses."""
        return self.failing is not UNSET


class FixedSizesPart(fields.LinePart, frozen=True, kw_only=True):
    """The only sizes that an implementation supports, and the spans of the centre (None: any).

    `axis`, since 1.6.0, is that of a spheroid that leans, "free" where it may be any.
    """

    sizes: fields.Sizes
    x: fields.Span
    y: fields.Span
    z: fields.Span
    axis: tuple[float, float, float] | Annotated[str, fields.one_of("free")] | UnsetType = UNSET


class DomainPart(fields.LinePart, frozen=True, kw_only=True):
    """Where an implementation claims to be right."""

    regimes: list[Annotated[str, fields.one_of("a>=1", "c2>=a")]]
    ratio: fields.Limits
    magnitude: fields.Limits
    settings: list[FixedSizesPart] | UnsetType = UNSET


class DescriptionPart(fields.LinePart, frozen=True, kw_only=True):
    """What an implementation says of itself, or is taken for.

    `tilt`, since 1.5.0, where rows have an axis; `times`, since 1.6.0, where it gives times of first contact;
    `heights`, since 1.9.0, where rows have the heights at which the hyperboloid ends.
    """

    name: str
    version: str
    language: str
    precision: fields.Precision
    question: fields.Question
    domain: DomainPart
    refuses: bool
    binary: bool
    time: bool
    tilt: bool | UnsetType = UNSET
    times: bool | UnsetType = UNSET
    heights: bool | UnsetType = UNSET


class Retest(fields.LinePart, frozen=True, kw_only=True):
    """How many cases were asked again, and how many answers changed within the tolerance and beyond it."""

    asked: fields.Count
    within: fields.Count
    beyond: fields.Count


class SlicesPart(fields.LinePart, frozen=True, kw_only=True):
    """How evenly rows near contact were asked, since 1.9.0, as shares of the range of each coordinate.

    In each slice of one coordinate that is `one` wide, three rows or more were asked; in each slice of any two of them
    that is `two` wide in both, a row or more.
    """

    coordinates: list[str]
    rows: fields.Count
    one: fields.Share
    two: fields.Share


class ImplementationLine(fields.RecordLine, frozen=True, kw_only=True):
    """An implementation under test as a whole; `finished`, since 1.3.0, is false if its run was interrupted.

    `not_asked`, since 1.8.0, are the families of which no row was asked, by reason, with their numbers of rows. Since
    1.9.0 there are `slices` by family, and `crossed`: how many triples of coincidences were asked, and how many go
    together at all.
    """

    spec: str
    name: str
    started: bool = True
    declared: DescriptionPart
    used: DescriptionPart
    restarts: fields.Count
    retest: Retest = field(name="again")
    broke_protocol_throughout: bool
    troubles: list[str]
    not_asked: dict[str, fields.Counts] | UnsetType = UNSET
    slices: dict[str, SlicesPart] | UnsetType = UNSET
    crossed: dict[str, tuple[fields.Count, fields.Count]] | UnsetType = UNSET
    finished: bool | UnsetType = UNSET


class NotStartedLine(fields.RecordLine, frozen=True, kw_only=True, tag="implementation"):
    """An implementation under test that could not be started."""

    spec: str
    name: str
    started: bool = False
    trouble: str


UNEXPLAINED = "unexplained"
"""The cause of wrong answers that no known cause gives."""


class CauseLine(fields.RecordLine, frozen=True, kw_only=True):
    """A cause of wrong answers of an implementation under test, since 1.7.0; `cause` "unexplained" if none is known.

    `claim` is the paper's statement that is the reason, `families` counts the answers, `worst` is the worst of them.
    """

    spec: str
    method: str
    cause: str
    sentence: str
    remedy: str
    claim: str
    cases: fields.Count
    families: fields.Counts
    worst: WrongAnswer


class MapLine(fields.RecordLine, frozen=True, kw_only=True):
    """A method over the half plane of a scene: a text for each z, a letter for each r, upper case where it is wrong."""

    name: str
    method: str
    sizes: fields.Sizes
    r: fields.Interval
    z: fields.Interval
    wrong: fields.Count
    points: fields.Count
    lines: list[Annotated[str, Meta(pattern="^[eciECI]+$")]]


class TimingLine(fields.RecordLine, frozen=True, kw_only=True):
    """A contender on a workload: nanoseconds a row, one value for each round."""

    workload: str
    median_ns: fields.Amount
    name: str
    title: str
    rows: fields.Count
    loops: fields.Count
    samples_ns: Annotated[list[fields.Amount], Meta(min_length=1)]
    checksum: int
