"""The row that a CASE on the command line names: a case's id, seven numbers, or a case that a record has kept."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from hypcheck.casebook.families import parse_case_id
from hypcheck.casebook.family import BLOCK
from hypcheck.casebook.fixed_sizes import MARK
from hypcheck.casebook.frozen import refusals
from hypcheck.casebook.frozen.showing import refusal_of, vector_of
from hypcheck.errors import InputError
from hypcheck.methods.spec import begins_as_spec
from hypcheck.pairs import COLUMNS, Pair, trouble_with
from hypcheck.record import read
from hypcheck.record.reader import file_of
from hypcheck.replay.recorded import recorded_cases
from hypcheck.tables.numbers import number_of_text

_RECORDED = re.compile(r"(.+):([0-9]+)", re.ASCII | re.DOTALL)
_HEXADECIMAL = re.compile(r"[ \t]*[+-]?0x", re.ASCII | re.IGNORECASE)

Row = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Case:
    """A row to be replayed, and what it is called; the seven numbers may be what no pair has."""

    name: str
    row: Row

    @property
    def at_fault(self) -> tuple[str, ...]:
        """The columns that keep the row from being a pair, so that it must be refused; none of a valid row."""
        return tuple(name for name, value in zip(COLUMNS, self.row, strict=True) if trouble_with(name, value))


def case_of(text: str) -> Case:
    """The case that `text` names: ring-0007, ring/1/42/7, "2,5,1,1,3,0,0" in decimals or 0x1p+1 …, or RECORD:N.

    RECORD:N is the N-th case of a record.jsonl, or of its run's folder, as reports number them (recorded_cases). The
    row is as it was asked: a zero keeps its sign. Raises InputError saying what is wrong with the text.
    """
    if begins_as_spec(text):
        raise InputError(f"CASE is {text!r}, which names an implementation; replay takes CASE SPEC, minimise SPEC CASE")
    recorded = _RECORDED.fullmatch(text)
    if recorded is not None:
        return _from_record(Path(recorded[1]), int(recorded[2][:19]))
    if "," in text and MARK not in text:  # the names of families for given sizes have commas
        return Case("the given row", _given(text))
    if "/" in text:
        case = parse_case_id(text)
        block, place = divmod(case.index, BLOCK)
        return Case(text, tuple(case.family.block(case.seed, block)[place].tolist()))
    if text.startswith(f"{refusals.NAME}-"):
        return Case(text, refusal_of(text).row)
    return Case(text, vector_of(text).row)


def _from_record(path: Path, number: int) -> Case:
    kept = recorded_cases(read(file_of(path)))
    if not 1 <= number <= len(kept):
        there = f"they are 1 to {len(kept)}" if kept else "it has none"
        raise InputError(f"{path} has no case {number}; {there}")
    case = kept[number - 1].case
    try:
        row = tuple(float.fromhex(value) for value in case.row)
    except OverflowError:
        raise InputError(f"{path}: case {number} has a number that is too large for float64") from None
    return Case(case.case, row)


def _given(text: str) -> Row:
    """Seven valid numbers, each of them decimal or hexadecimal."""
    parts = text.split(",")
    if len(parts) != len(COLUMNS):
        raise InputError(f"the row {text!r} has {len(parts)} numbers; it must have 7: {', '.join(COLUMNS)}")
    row = tuple(_number(name, part) for name, part in zip(COLUMNS, parts, strict=True))
    Pair.from_row(row)
    return row


def _number(name: str, text: str) -> float:
    try:
        return float.fromhex(text) if _HEXADECIMAL.match(text) else number_of_text(name, text)
    except OverflowError:
        raise InputError(f"{name} is {text.strip()!r}, which is too large for float64") from None
    except ValueError as trouble:
        why = f"{name} is {text!r}; it must be a number such as 2.5 or 0x1.4p+1"
        raise InputError(why if _HEXADECIMAL.match(text) else str(trouble)) from None
