"""A project's list of known failures, in TOML: cases and families that may be wrong, each with a reason.

    [[known_failure]]
    case = "ring-0007"              # or: family = "ring"
    max_u = 1e6                     # the largest backward error that is excused, in units u; none: any
    reason = "the ring; fixed in 2.0"

An entry that no longer excuses a case fails the run too.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hypcheck import toml
from hypcheck.errors import InputError
from hypcheck.record import Record
from hypcheck.record.lines import GroupLine
from hypcheck.tables.streams import writing

_LARGEST = sys.float_info.max
_KEYS = ("case", "family", "max_u", "reason")


@dataclass(frozen=True, slots=True)
class KnownFailure:
    """One entry: a case id or a family, the largest excused error in units u, and why."""

    case: str | None
    family: str | None
    max_u: float
    reason: str

    @property
    def subject(self) -> str:
        """The subject of the entry in messages."""
        return f"case {self.case}" if self.case is not None else f"family {self.family}"

    def names(self, case: str, family: str) -> bool:
        """Whether this entry is about a case of a family. It excuses a wrong answer there up to `max_u`."""
        return case == self.case or family == self.family


def read_known_failures(path: Path) -> tuple[KnownFailure, ...]:
    """The entries of a file. Raises InputError naming the file, the entry, and what would be right."""
    try:
        content = toml.parsed(toml.text_of(str(path)), str(path))
    except FileNotFoundError:
        raise InputError(f"cannot read {path}: no such file or directory") from None
    unknown = [key for key in content if key != "known_failure"]
    entries = content.get("known_failure", [])
    if unknown or not isinstance(entries, list):
        raise InputError(f"{path}: {unknown[0] if unknown else 'known_failure'!s} is not an array of [[known_failure]]")
    return tuple(_entry(item, f"{path}: known failure {number}") for number, item in enumerate(entries, start=1))


def _entry(item: Any, where: str) -> KnownFailure:  # noqa: ANN401  whatever TOML holds
    if not isinstance(item, dict):
        raise InputError(f"{where} is {item!r}; it must be a table with {', '.join(_KEYS)}")
    unknown = [key for key in item if key not in _KEYS]
    if unknown:
        raise InputError(f"{where} has the key {unknown[0]!r}; it may have {', '.join(_KEYS)}")
    case, family, reason = (item.get(key) for key in ("case", "family", "reason"))
    if (case is None) == (family is None):
        raise InputError(f"{where} must name either a case or a family")
    if not isinstance(case if family is None else family, str):
        raise InputError(f"{where} names {case if family is None else family!r}; it must be a text")
    if not isinstance(reason, str) or not reason.strip():
        raise InputError(f"{where} has no reason; each entry must say why it is known")
    max_u = item.get("max_u", float("inf"))
    if isinstance(max_u, bool) or not isinstance(max_u, (int, float)) or not 0 <= max_u or _LARGEST < max_u < math.inf:
        raise InputError(f"{where} has max_u = {max_u!r}; it must be a number of units u, 0 or more")
    return KnownFailure(case, family, float(max_u), reason)


def render(entries: Iterable[KnownFailure]) -> str:
    """The text of a file with these entries."""
    return "\n".join(_rendered(entry) for entry in entries)


def _rendered(entry: KnownFailure) -> str:
    names = (("case", entry.case), ("family", entry.family))
    lines = [f"{key} = {_quoted(name)}" for key, name in names if name is not None]
    if entry.max_u != float("inf"):
        lines.append(f"max_u = {entry.max_u!r}")
    return "\n".join(["[[known_failure]]", *lines, f"reason = {_quoted(entry.reason)}", ""])


def _quoted(text: str) -> str:
    escaped = "".join(c if c.isprintable() and c not in '"\\' else f"\\U{ord(c):08x}" for c in text)
    return f'"{escaped}"'


def no_longer_failing(entries: Sequence[KnownFailure], used: AbstractSet[int], asked: AbstractSet[str]) -> list[str]:
    """A sentence for each entry that excused no case, though its case or family was asked.

    `used` are the numbers of the entries that excused a case; `asked` are the families and case ids that were asked.
    """
    return [
        f"the {entry.subject} no longer fails, but is listed as a known failure ({entry.reason})"
        for number, entry in enumerate(entries)
        if number not in used and (entry.case in asked or entry.family in asked)
    ]


def update(path: Path, record: Record) -> str:
    """Rewrite the file from a run of all families, and return a sentence about it.

    Entries that still excuse a case stay, others are removed. New entries are by family, with the worst error of the
    run, and their reason is to be written by a person.
    """
    kept = {entry.subject: entry for entry in (read_known_failures(path) if path.exists() else ())}
    failing: dict[str, float] = {}
    for line in record.of(GroupLine):
        errors = [float(case.backward_error_u) for case in line.worst if case.status in ("wrong", "excused")]
        if errors:
            failing[line.family] = max(errors)
    entries = [entry for entry in kept.values() if entry.case is not None or entry.family in failing]
    known = {entry.family for entry in entries}
    entries += [
        KnownFailure(None, family, float(f"{error:.2e}") * 1.01, "not explained yet; recorded by --update")
        for family, error in failing.items()
        if family not in known
    ]
    with writing(str(path)) as writer:
        writer.write(render(entries).encode())
    return f"{path}: {len(entries)} known failures"
