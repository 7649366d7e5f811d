"""The cases that a record keeps with their rows, numbered: what RECORD:N on the command line names."""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.record.lines import Fault, Group, WrongAnswer
from hypcheck.record.reader import Record


@dataclass(frozen=True, slots=True)
class RecordedCase:
    """The `number`-th case of a record, from 1 on, and the line of the group it belongs to."""

    number: int
    group: Group
    case: WrongAnswer | Fault


def recorded_cases(record: Record) -> list[RecordedCase]:
    """Every worst case and every fault, in the order of the record; of a group first the worst, then the faults."""
    kept = [(group, case) for group in record.of(Group) for case in (*group.worst, *(group.faults or ()))]
    return [RecordedCase(number, group, case) for number, (group, case) in enumerate(kept, start=1)]
