"""The cases that a record keeps with their rows, numbered: what RECORD:N on the command line names."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from hypcheck.errors import InputError
from hypcheck.record import Line, Record
from hypcheck.tables.numbers import shown_json


@dataclass(frozen=True, slots=True)
class RecordedCase:
    """The `number`-th case of a record, from 1 on: the line of the group it belongs to, and its own fields."""

    number: int
    group: Line
    case: Line


def recorded_cases(record: Record) -> list[RecordedCase]:
    """Every worst case and every fault, in the order of the record; of a group first the worst, then the faults.

    Raises InputError where a group has something else in their place.
    """
    kept = [(group, case) for group in record.of("group") for case in _cases(group)]
    return [RecordedCase(number, group, case) for number, (group, case) in enumerate(kept, start=1)]


def _cases(group: Line) -> Iterator[Line]:
    for name in ("worst", "faults"):
        cases = group.get(name, [])
        if not isinstance(cases, list) or not all(isinstance(case, dict) for case in cases):
            raise InputError(f"the record has a group whose {name} is no list of cases: {shown_json(cases)}")
        yield from cases
