"""The cases that a record keeps with their rows, numbered: what RECORD:N on the command line names."""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.record import Line, Record


@dataclass(frozen=True, slots=True)
class RecordedCase:
    """The `number`-th case of a record, from 1 on: the line of the group it belongs to, and its own fields."""

    number: int
    group: Line
    case: Line


def recorded_cases(record: Record) -> list[RecordedCase]:
    """Every worst case and every fault, in the order of the record; of a group first the worst, then the faults."""
    kept = [(group, case) for group in record.of("group") for case in (*group["worst"], *group.get("faults", ()))]
    return [RecordedCase(number, group, case) for number, (group, case) in enumerate(kept, start=1)]
