"""The line of progress, since 1.3.0: the finished part of a conformance run, so that it can be resumed."""

from __future__ import annotations

from typing import Annotated

from msgspec import UNSET, Meta, UnsetType, field

from hypcheck.record import fields
from hypcheck.record.lines import DescriptionPart, Retest

Total = Annotated[int, Meta(ge=0, le=1 << 60)]
"""A count that fits into int64, as do sums of a few; no run has more cases."""

Totals = dict[str, Total]
Label = Annotated[str, fields.one_of("answered", "error", "crash", "timeout", "protocol", "not-run")]
Place = tuple[Annotated[int, Meta(ge=0, le=2)], Total]
"""0 and the number of a frozen vector in its family, or 1 and that of a generated row; 2 of one of a large seed."""


class SavedAllowance(fields.LinePart, frozen=True, kw_only=True):
    """Restarts, faults and hangs that an implementation may still have; `over`: why it is not asked any more."""

    restarts: Total
    faults: Total = 0
    over: str = ""
    hangs: Total | None = None


class PendingCases(fields.LinePart, frozen=True, kw_only=True):
    """Cases that were answered and wait for their retest.

    `chunk`: the family, the seed (None: frozen vectors), the first case, the one after the last, and how many are
    measured. `indices`: stretches [first, last + 1) within the chunk. `answers`: an int8 each, as hexadecimal digits;
    `times`: a little-endian float64 each.
    """

    chunk: tuple[str, Total | None, Total, Total, Total]
    indices: list[tuple[Total, Total]]
    answers: Annotated[str, Meta(pattern="^([0-9a-f]{2})*$")]
    times: Annotated[str, Meta(pattern="^([0-9a-f]{16})*$")] | UnsetType = UNSET


class WorstCase(fields.LinePart, frozen=True, kw_only=True):
    """A wrong or tolerated answer that is kept; `error` is its backward error."""

    place: Place
    case: str
    row: fields.Row
    end: fields.Centre | UnsetType = UNSET
    axis: fields.Axis | UnsetType = UNSET
    heights: fields.Heights | UnsetType = UNSET
    truth: fields.Truth
    answer: Annotated[int, Meta(ge=-128, le=127)]
    mistake: fields.Mistake
    status: str
    error: fields.Unsigned
    time: float | None = None


class UnansweredCase(fields.LinePart, frozen=True, kw_only=True):
    """A case that ended without an answer that counts."""

    place: Place
    case: str
    row: fields.InvalidRow
    end: fields.InvalidCentre | UnsetType = UNSET
    axis: fields.InvalidAxis | UnsetType = UNSET
    heights: fields.Heights | UnsetType = UNSET
    status: str
    reason: str


class Explained(fields.LinePart, frozen=True, kw_only=True):
    """Wrong answers that the same causes explain, these as a number with a bit for each, and the worst of them.

    Of that, `error` is a lower end that is proved, 0 where there is none, and `exponent` floor(log2) of the error.
    """

    causes: Annotated[str, Meta(pattern="^[0-9a-f]+$", max_length=256)]
    cases: Annotated[int, Meta(ge=1, le=1 << 60)]
    worst: WorstCase
    exponent: fields.Extended


class Tally(fields.LinePart, frozen=True, kw_only=True):
    """The tally of a family so far, as in a group line; `dangerous`: false clears beyond the tolerance."""

    asked: Total
    counts: Totals
    mistakes: Totals
    dangerous: Total
    octaves: dict[str, Totals]
    size_bins: fields.Histogram
    place_bins: fields.Histogram
    worst: list[WorstCase]
    faults: list[UnansweredCase]
    explained: list[Explained] = field(default_factory=list)
    denied: Totals = field(default_factory=dict)
    fresh: Total = 0
    not_asked: Totals = field(default_factory=dict)
    answers: dict[fields.TruthKey, dict[fields.AnswerKey, Total]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        fields.require_octaves(self.octaves)


class SavedResult(fields.LinePart, frozen=True, kw_only=True):
    """The result so far: a tally for each family, and `open` cases that no tally counts yet.

    `outcomes`: all ways in which questions ended; `excusing`: the numbers of known failures that excused something;
    `named`: asked cases that known failures name.
    """

    tallies: dict[str, Tally]
    pending: list[PendingCases] = field(name="open")
    retest: Retest = field(name="again")
    outcomes: list[Label]
    excusing: list[Total]
    named: list[str]


class SavedState(fields.LinePart, frozen=True, kw_only=True):
    """The steps that are done, the allowance that is left, and the result so far."""

    done: Total
    left: SavedAllowance
    total: SavedResult


class ProgressLine(fields.RecordLine, frozen=True, kw_only=True):
    """The state of a run with SPEC that did not finish, from which --resume continues.

    `number`: the place, from 0, of the implementation among those of the run; `declared`: its description; `cases`: how
    many it is asked in all. `program`: the sha256 of hypcheck's files, since a step may mean something else in another
    version.
    """

    number: fields.Count
    declared: DescriptionPart
    cases: fields.Count
    state: SavedState
    program: str | None = None
