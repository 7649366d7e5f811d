"""The recorded cases again: the number that each has in its record, and the command that shows it."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hypcheck.judge import DEFAULT_TOLERANCE
from hypcheck.methods.limits import Limits
from hypcheck.record import Record
from hypcheck.record.lines import Fault, Group, WrongAnswer
from hypcheck.replay.recorded import recorded_cases
from hypcheck.report.text import classify_command, from_hex

_LIMITS = ("startup_timeout", "timeout", "memory")


@dataclass(frozen=True)
class Replays:
    """The cases of one record: `numbers` by the identity of a case, `options` that judge as the run did."""

    numbers: Mapping[int, int]
    options: tuple[str, ...]

    @classmethod
    def of(cls, record: Record) -> Replays:
        """Those of a record."""
        numbers = {id(each.case): each.number for each in recorded_cases(record)}
        return cls(numbers, tuple(_options(record.header.options)))

    def place(self, case: WrongAnswer | Fault) -> str:
        """Where the case stands, as `hypcheck replay` reads it beside the record: record.jsonl:7."""
        return f"record.jsonl:{self.numbers[id(case)]}"

    def command(self, group: Group, case: WrongAnswer | Fault) -> str:
        """The command that replays a case of a gated implementation, or decides and proves one of our own methods'."""
        if not group.tested:
            return classify_command(from_hex(case.row))
        return shlex.join(["hypcheck", "replay", str(case.case), str(group.spec), *self.options])


def tolerance_of(options: Mapping[str, Any]) -> float | None:
    """The tolerance of a run in units u, None where its options, of which the schema says nothing, have no number."""
    tolerance = options.get("tolerance")
    return float(tolerance) if isinstance(tolerance, (int, float)) else None


def _options(options: Mapping[str, Any]) -> list[str]:
    """Options of the run that are not the usual ones and change what a replay shows."""
    said = [f"--{name}={options[name]}" for name in ("precision", "question") if options.get(name) is not None]
    tolerance = tolerance_of(options)
    if tolerance is not None and tolerance != DEFAULT_TOLERANCE:
        said.append(f"--tolerance={tolerance:g}")
    limits, usual = options.get("limits"), Limits()
    limits = limits if isinstance(limits, dict) else {}
    unusual = [name for name in _LIMITS if name in limits and limits[name] != getattr(usual, name)]
    return said + [f"--{name.replace('_', '-')}={limits[name]}" for name in unusual]
