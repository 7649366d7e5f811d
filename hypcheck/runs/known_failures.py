"""A project's list of known failures, in TOML: cases, families and causes whose errors are excused, with reasons.

    [[known_failure]]
    case = "ring-0007"              # or: family = "ring", of which it excuses the rows that stay; or: cause = "ring"
    max_u = 1e6                     # the largest backward error that is excused, in units u; none: any
    reason = "the ring; fixed in 2.0"

A fresh row is excused only by a cause or by its own id: if a family excused it, an implementation that is right only
for the rows that stay would pass. A cause excuses an answer if its rule gives the same answer; it must have a `max_u`,
which may be inf. Only causes about places and roundings can be known failures: if a rule about every row were excused,
nothing would be tested.

An entry that no longer excuses a case fails the run too. An entry whose case, family or cause does not exist is
refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from hypcheck import strict, toml
from hypcheck.errors import InputError
from hypcheck.messages import suggestion
from hypcheck.record import Record
from hypcheck.record.lines import CauseLine, DriftLine, GroupLine, ImplementationLine
from hypcheck.runs.cases import frozen_vectors
from hypcheck.runs.causes import AnsweredRows, Cause, Scope
from hypcheck.runs.diagnosis import CAUSES
from hypcheck.strict import StrictTable
from hypcheck.tables.streams import replace_output
from hypcheck.vectors import frozen
from hypcheck.vectors.families import family_of, parse_case_id
from hypcheck.vectors.invalid_rows import INVALID_CONTENTS

_SUBJECTS = ("case", "family", "cause")
_KEYS = (*_SUBJECTS, "max_u", "reason")


@dataclass(frozen=True, slots=True)
class KnownFailure:
    """One entry: a case id, a family or the id of a cause, the largest excused error in units u, and the reason."""

    case: str | None
    family: str | None
    max_u: float
    reason: str
    cause: str | None = None

    @property
    def subject(self) -> str:
        """The subject of the entry in messages."""
        return next(f"{key} {name}" for key in _SUBJECTS if (name := getattr(self, key)) is not None)

    def names(self, case: str, family: str, *, fresh: bool) -> bool:
        """Return whether this entry names the case, or its family if the case is not fresh.

        If it does, it excuses a wrong answer to the case up to the error `max_u`.
        """
        return case == self.case or (family == self.family and not fresh)


@cache
def excusable_causes() -> Mapping[str, tuple[Cause, ...]]:
    """Return the causes that an entry may name, by id: the causes about places and roundings."""
    names = dict.fromkeys(cause.name for cause in CAUSES if cause.scope is not Scope.EVERYWHERE)
    return {name: tuple(cause for cause in CAUSES if cause.name == name) for name in names}


def entries_about(
    known: Sequence[KnownFailure], cases: Sequence[tuple[int, str]], family: str, answered: AnsweredRows, *, fresh: bool
) -> list[list[int]]:
    """Return, for each case of a family, the numbers of the entries about it: their places in `known`.

    A case is given as its index among the tested rows and its id.
    """
    numbers = [
        [number for number, entry in enumerate(known) if entry.names(name, family, fresh=fresh)] for _, name in cases
    ]
    if not cases:
        return numbers
    part = answered.part([index for index, _ in cases])
    for number, entry in enumerate(known):
        for cause in excusable_causes().get(entry.cause or "", ()):
            if cause.subject == answered.subject:
                for place in np.flatnonzero(cause.rule(part) == part.given).tolist():
                    numbers[place].append(number)
    return numbers


def read_known_failures(path: Path) -> tuple[KnownFailure, ...]:
    """Return the entries of a file. Raises InputError naming the file, the line, the entry, and the allowed values."""
    try:
        text = toml.text_of(str(path))
    except FileNotFoundError:
        raise InputError(f"cannot read {path}: no such file or directory") from None
    top = strict.table_of(text, str(path), "the file", ("known_failure",))
    return tuple(map(_entry, top.tables("known_failure", _KEYS, "an array of tables, [[known_failure]]")))


def _entry(table: StrictTable) -> KnownFailure:
    """Read one entry. Raises InputError about anything that is wrong in it."""
    named = {key: table.optional(key, strict.text, None) for key in _SUBJECTS}
    subjects = [(key, name) for key, name in named.items() if name is not None]
    if len(subjects) != 1:
        table.refuse(f"{table.title} must name either a case or a family or a cause")
    reason, max_u = table.required("reason", _reason), table.optional("max_u", _units, None)
    ((key, name),) = subjects
    try:
        _REQUIRE[key](name)
    except InputError as error:
        table.refuse(f"{table.title}: {error}", key)
    if key == "cause" and max_u is None:
        table.refuse(f"{table.title} names a cause and has no max_u; say how far off it may be, inf for any distance")
    return KnownFailure(named["case"], named["family"], math.inf if max_u is None else max_u, reason, named["cause"])


def _reason(value: object) -> str:
    """Check that a value is a text that is not blank, and return it. Raises ValueError with what it must be."""
    if not isinstance(value, str) or not value.strip():
        raise ValueError("a text that says why it is known")
    return value


_units = strict.number_with("a number of units u, 0 or more", 0, infinite=True)


_FROZEN_ID = re.compile(r"(?P<family>.+)-\d+", re.ASCII)


def _require_case(name: str) -> None:
    """Raise InputError if there is no case with this id."""
    if "/" in name:
        parse_case_id(name)
        return
    match = _FROZEN_ID.fullmatch(name)
    family = match["family"] if match else name
    if family not in frozen.ALL_NAMES or family in INVALID_CONTENTS:
        raise InputError(f"there is no case {name!r}; {suggestion(family, _families(), otherwise='cases are of')}")
    ids = frozen_vectors(family).ids
    if name not in ids:
        raise InputError(
            f"there is no case {name!r}; those of {family} are {ids[0]} to {ids[-1]}; {suggestion(name, ids, most=1)}"
        )


def _require_family(name: str) -> None:
    """Raise InputError if there is no family of this name."""
    if name not in _families():
        family_of(name)  # one for given sizes


def _require_cause(name: str) -> None:
    """Raise InputError if there is no cause with this id, or if it may not be excused."""
    if name in excusable_causes():
        return
    if any(cause.name == name for cause in CAUSES):
        raise InputError(
            f"the cause {name!r} is about every row: with it excused nothing would be tested; name cases instead"
        )
    raise InputError(f"there is no cause {name!r} that may be known; {suggestion(name, excusable_causes())}")


_REQUIRE: Mapping[str, Callable[[str], None]] = {
    "case": _require_case,
    "family": _require_family,
    "cause": _require_cause,
}
"""The checks by key: each raises InputError if there is no case, family or cause of that name, or it cannot be
excused."""


def _families() -> tuple[str, ...]:
    """Return the names of the families of valid rows."""
    return tuple(name for name in frozen.ALL_NAMES if name not in INVALID_CONTENTS)


def render(entries: Iterable[KnownFailure]) -> str:
    """Return the text of a file with these entries."""
    return "\n".join(_rendered(entry) for entry in entries)


def _rendered(entry: KnownFailure) -> str:
    """Return the text of one entry."""
    names = ((key, getattr(entry, key)) for key in _SUBJECTS)
    lines = [f"{key} = {_quoted(name)}" for key, name in names if name is not None]
    if entry.max_u != float("inf") or entry.cause is not None:
        lines.append(f"max_u = {entry.max_u!r}")
    return "\n".join(["[[known_failure]]", *lines, f"reason = {_quoted(entry.reason)}", ""])


def _quoted(text: str) -> str:
    """Return a text as a string of TOML."""
    escaped = "".join(c if c.isprintable() and c not in '"\\' else f"\\U{ord(c):08x}" for c in text)
    return f'"{escaped}"'


def no_longer_failing(
    entries: Sequence[KnownFailure], used: AbstractSet[int], asked_cases: AbstractSet[str], subjects: AbstractSet[str]
) -> list[str]:
    """Return a sentence for each entry that excused no case, though its case, family or the cause's subject was tested.

    `used` are the numbers of the entries that excused a case; `asked_cases` are the families and case ids that were
    tested, `subjects` the subjects of all tested families (causes.subject_of), none if only some families were tested.
    """

    def was_asked(entry: KnownFailure) -> bool:
        """Return whether the run tested what the entry names."""
        about = {cause.subject for cause in excusable_causes().get(entry.cause or "", ())}
        return entry.case in asked_cases or entry.family in asked_cases or bool(about & subjects)

    return [
        f"the {entry.subject} no longer fails, but is listed as a known failure ({entry.reason})"
        for number, entry in enumerate(entries)
        if number not in used and was_asked(entry)
    ]


_BY_UPDATE = "not explained yet; recorded by --update"

_WITHIN_OCTAVE = 2
"""The worst error of a cause is known to within a factor of 2: another of its answers may be nearly twice as wrong."""


def update(path: Path, record: Record) -> str:
    """Rewrite the file from a run of all families, and return a sentence about it.

    Entries that still excuse a case stay, others are removed. A new entry names a cause if a cause that may be excused
    explains the answers, because it then excuses fresh rows too; else it names a family. Each new entry has the worst
    error of the run. A person must write the reasons of the new entries.
    """
    failing: dict[str, float] = {}
    for line in record.of(GroupLine):
        errors = [float(case.backward_error_u) for case in line.worst if case.status in ("wrong", "excused")]
        if errors:
            failing[line.family] = max(errors)
    entries = [entry for entry in _listed(path) if _stays(entry, failing, record)]
    causes = {line.cause: line for line in record.of(CauseLine) if line.cause in excusable_causes()}
    others = {family for line in record.of(CauseLine) if line.cause not in causes for family in line.families}
    known = {(entry.family, entry.cause) for entry in entries}
    entries += [
        KnownFailure(None, family, _rounded_up(error), _BY_UPDATE)
        for family, error in failing.items()
        if (family, None) not in known and family in others
    ]
    entries += [
        KnownFailure(None, None, _rounded_up(_WITHIN_OCTAVE * float(line.worst.backward_error_u)), _BY_UPDATE, cause)
        for cause, line in causes.items()
        if (None, cause) not in known
    ]
    with replace_output(str(path)) as writer:
        writer.write(render(entries).encode())
    return f"{path}: {len(entries)} known failures"


def _listed(path: Path) -> Iterator[KnownFailure]:
    """Yield the entries of the file, each subject once; none if there is no file yet."""
    return iter({entry.subject: entry for entry in (read_known_failures(path) if path.exists() else ())}.values())


def _stays(entry: KnownFailure, failing: Mapping[str, float], record: Record) -> bool:
    """Return whether an entry excused a case of some implementation in this run."""
    if entry.family is not None:
        return entry.family in failing
    obsolete = sum(f"the {entry.subject} no longer fails" in line.sentence for line in record.of(DriftLine))
    return obsolete < len(record.of(ImplementationLine))


def _rounded_up(error: float) -> float:
    """Return a number a little above the error, with few digits."""
    return float(f"{error:.2e}") * 1.01
