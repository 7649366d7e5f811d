"""The line of progress, since 1.3.0: how far a gating run is, and what it goes on from."""

from __future__ import annotations

from typing import Annotated

from msgspec import UNSET, Meta, UnsetType

from hypcheck.record.fields import (
    Axis,
    Count,
    InvalidAxis,
    InvalidRow,
    LinePart,
    Mistake,
    RecordLine,
    Row,
    Truth,
    Unsigned,
    one_of,
    require_octaves,
    require_possible,
)
from hypcheck.record.lines import DescriptionPart, Retest

Total = Annotated[int, Meta(ge=0, le=1 << 60)]
"""A count that fits into int64, and so do sums of a few: a run has fewer cases."""

Totals = dict[str, Total]
Label = Annotated[str, one_of("answered", "error", "crash", "timeout", "protocol", "not-run")]
Place = tuple[Annotated[int, Meta(ge=0, le=1)], Total]
"""0 and the number of a frozen vector in its family, or 1 and that of a generated row."""

SavedBin = Annotated[list[Annotated[int, Meta(ge=-(1 << 60), le=1 << 60)]], Meta(min_length=4, max_length=4)]
"""As a Bin, of numbers that fit into int64."""


class SavedAllowance(LinePart, frozen=True, kw_only=True):
    """What the implementation may still cost. `over` says why it is asked no more; empty while it is."""

    restarts: Total
    faults: Total = 0
    over: str = ""
    hangs: Total | None = None


class PendingCases(LinePart, frozen=True, kw_only=True):
    """Cases that were answered and wait for their retest.

    `chunk`: the family, the seed (None: frozen vectors), the first case, the one behind the last, and how many are
    measured. `indices`: stretches [first, last + 1) within the chunk. `answers`: an int8 each, as hexadecimal digits.
    """

    chunk: tuple[str, Total | None, Total, Total, Total]
    indices: list[tuple[Total, Total]]
    answers: Annotated[str, Meta(pattern="^([0-9a-f]{2})*$")]


class SavedAnswer(LinePart, frozen=True, kw_only=True):
    """A wrong or tolerated answer that is kept; `error` is its backward error."""

    place: Place
    case: str
    row: Row
    axis: Axis | UnsetType = UNSET
    truth: Truth
    answer: Annotated[int, Meta(ge=-128, le=127)]
    mistake: Mistake
    status: str
    error: Unsigned


class SavedFault(LinePart, frozen=True, kw_only=True):
    """A case that ended without an answer that counts."""

    place: Place
    case: str
    row: InvalidRow
    axis: InvalidAxis | UnsetType = UNSET
    status: str
    reason: str


class SavedTally(LinePart, frozen=True, kw_only=True):
    """A family so far, as a group has it; `dangerous`: its false clears beyond the tolerance."""

    asked: Total
    counts: Totals
    mistakes: Totals
    dangerous: Total
    octaves: dict[str, Totals]
    size_bins: list[SavedBin]
    place_bins: list[SavedBin]
    worst: list[SavedAnswer]
    faults: list[SavedFault]

    def __post_init__(self) -> None:
        require_octaves(self.octaves)
        require_possible("size_bins", self.size_bins)
        require_possible("place_bins", self.place_bins)


class SavedResult(LinePart, frozen=True, kw_only=True):
    """The cases that are done: a tally for each family, and `open` cases that no tally counts yet.

    `outcomes` are all ways in which questions ended; `excusing` the numbers of the known failures that excused
    something, `named` the cases that known failures name and that were asked.
    """

    tallies: dict[str, SavedTally]
    open: list[PendingCases]
    again: Retest
    outcomes: list[Label]
    excusing: list[Total]
    named: list[str]


class SavedState(LinePart, frozen=True, kw_only=True):
    """How many steps are done, what the implementation may still cost, and the result so far."""

    done: Total
    left: SavedAllowance
    total: SavedResult


class ProgressLine(RecordLine, frozen=True, kw_only=True):
    """Of a run with SPEC that did not finish: what it goes on from.

    `number` is the place, from 0, of the implementation that is asked among those of the run, `declared` what it says
    of itself, and `cases` how many it is asked in all. `program` is the sha256 of our own files: what a step is, and so
    what a number of them comes to, may change between two commits.
    """

    number: Count
    declared: DescriptionPart
    cases: Count
    state: SavedState
    program: str | None = None
