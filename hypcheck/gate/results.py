"""What came of a part of a run: a value that can be sent, kept and added to others in any order."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hypcheck import tally
from hypcheck.gate.chunks import Chunk
from hypcheck.methods.faults import Outcome
from hypcheck.record.lines import Retest
from hypcheck.tally import Tally


@dataclass(frozen=True, slots=True)
class PendingRetest:
    """Cases that were answered and are to be asked again before they are judged.

    `indices` (n,) are theirs in the chunk, ascending, and `answers`, int8 (n,), what was answered at first.
    """

    chunk: Chunk
    indices: NDArray[np.intp]
    answers: NDArray[np.int8]


NO_RETEST = Retest(asked=0, within=0, beyond=0)


@dataclass(frozen=True)
class Result:
    """What came of some cases: a tally for each family, and `open` cases that no tally counts yet.

    `outcomes` are all ways in which questions ended; `excusing` the numbers of the known failures that excused
    something, `named` the cases that known failures name and that were asked.
    """

    tallies: Mapping[str, Tally] = field(default_factory=dict)
    open: tuple[PendingRetest, ...] = ()
    again: Retest = NO_RETEST
    outcomes: frozenset[Outcome] = frozenset()
    excusing: frozenset[int] = frozenset()
    named: frozenset[str] = frozenset()

    @property
    def cases(self) -> int:
        """How many it speaks of: asked, skipped and open."""
        counted = sum(sum(tally.counts.values()) for tally in self.tallies.values())
        return counted + sum(len(each.indices) for each in self.open)

    @property
    def broke_protocol_throughout(self) -> bool:
        """Whether no row was ever answered, and every one that was asked ended as PROTOCOL."""
        return self.outcomes - {Outcome.NOT_RUN} == {Outcome.PROTOCOL}


def merged(results: Iterable[Result]) -> Result:
    """The result of all cases of these results; in whatever order they come, but for the order of the open ones."""
    parts = tuple(results)
    tallies: dict[str, list[Tally]] = {}
    for part in parts:
        for family, each in part.tallies.items():
            tallies.setdefault(family, []).append(each)
    return Result(
        tallies={family: tally.merged(some) if len(some) > 1 else some[0] for family, some in tallies.items()},
        open=tuple(each for part in parts for each in part.open),
        again=_added(part.again for part in parts),
        outcomes=frozenset().union(*(part.outcomes for part in parts)),
        excusing=frozenset().union(*(part.excusing for part in parts)),
        named=frozenset().union(*(part.named for part in parts)),
    )


def _added(retests: Iterable[Retest]) -> Retest:
    counts = ((each.asked, each.within, each.beyond) for each in retests)
    asked, within, beyond = map(sum, zip((0, 0, 0), *counts, strict=True))
    return Retest(asked=asked, within=within, beyond=beyond)
