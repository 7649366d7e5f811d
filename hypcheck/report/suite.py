"""A test suite and its cases, as junit.xml has them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from hypcheck.report.failure import Failure


@dataclass(frozen=True, slots=True)
class Trouble:
    """Why a case did not pass: `tag` is "failure", "error" or "skipped"; `kind` and `message` are one line each."""

    tag: str
    kind: str
    message: str
    details: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Case:
    """A test case; `output` are lines of its system-out.

    Its name does not depend on how it ended. Times are whole milliseconds, so that sums add up; None: not measured.
    """

    name: str
    trouble: Trouble | None = None
    output: tuple[str, ...] = ()
    milliseconds: int | None = None


@dataclass(frozen=True, slots=True)
class Suite:
    """A named group of cases."""

    name: str
    cases: tuple[Case, ...]

    def count(self, tag: str) -> int:
        """How many of its cases ended in that trouble."""
        return sum(case.trouble is not None and case.trouble.tag == tag for case in self.cases)

    @property
    def milliseconds(self) -> int | None:
        """The time of all cases that have one; None where none has."""
        return total(case.milliseconds for case in self.cases)


def total(times: Iterable[int | None]) -> int | None:
    """The sum of the times that were measured; None where none was."""
    known = [time for time in times if time is not None]
    return sum(known) if known else None


def details(failed: Iterable[Failure]) -> Iterator[str]:
    """Each failure with its case and how to look at it."""
    for each in failed:
        place = f" ({each.place})" if each.place else ""
        yield f"case {each.case}{place}: {each.message}" if each.case else each.message
        if each.replay:
            yield f"replay: {each.replay}"
