"""Rows that are no valid query, each with the columns that are at fault: the file `invalid`."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hypcheck.casebook.frozen.model import Head, Row, rows_of
from hypcheck.casebook.frozen.reading import REFUSALS, cases_of, head_of, listed, number_of
from hypcheck.casebook.frozen.scanning import Document, Place, scan
from hypcheck.casebook.frozen.writing import document_text, json_text, numbers_text, object_text
from hypcheck.errors import InputError
from hypcheck.pairs import COLUMNS, SIZES, trouble_with
from hypcheck.rows import Rows
from hypcheck.tables.numbers import shown_json

NAME = "invalid"
EXPECTED = "refused"
HEAD = Head(
    name=NAME,
    version=1,
    title="rows that must be refused",
    source="semi-axes that are 0, negative, infinite or NaN, centres that are infinite or NaN, alone and together",
    purpose="squares hide a sign, comparisons with NaN are false, and 0/0 reads as contact: a bad row gets an answer",
    game="a corrupted object collides with everything, or with nothing",
    drone="a sensor's NaN is answered as clear",
    regimes="none",
    extreme=False,
    made_by=f"hypcheck cases freeze {NAME}",
)
CASE_FIELDS = ("id", "row", "bits", "expected", "columns")

_BITS = re.compile(r"[0-9a-f]{16}", re.ASCII)
_WORDS = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}
_SOUND = (
    (1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0),
    (2.0, 17.8, 0.25, 0.15, 0.5, -1.25, 3.0),
    (4.0, 4.0, 1.0, 1.0, 4.0, 0.0, 0.5),
)
"""Valid rows, one of each position: exterior, interior, contact. In what follows something of theirs is made bad."""

_SIGN = 1 << 63
_NANS = {
    "nan": 0x7FF8 << 48,
    "−nan": 0xFFF8 << 48,
    "payload": (0x7FF8 << 48) + 0x1234,
    "signalling": (0x7FF0 << 48) + 1,
}


@dataclass(frozen=True, slots=True)
class Refusal:
    """A bad row: the 64 bits of its seven numbers, and the columns that are at fault, in the order of COLUMNS."""

    id: str
    bits: tuple[int, ...]
    columns: tuple[str, ...]

    @property
    def row(self) -> Row:
        """The seven numbers; a NaN may lose its payload on the way."""
        return tuple(rows_from_bits([self.bits])[0].tolist())


@dataclass(frozen=True)
class RefusalFile:
    """The file of such rows. `lines` are the lines on which they stood where it was read, for messages."""

    head: Head
    cases: tuple[Refusal, ...]
    lines: tuple[int, ...] = field(default=(), compare=False, repr=False)

    @property
    def rows(self) -> Rows:
        """The rows, float64 (n, 7), to the bit."""
        return rows_from_bits([case.bits for case in self.cases])


def rows_from_bits(bits: Sequence[Sequence[int]]) -> Rows:
    """Rows (n, 7) of these 64-bit words."""
    return np.asarray(bits, dtype=np.uint64).reshape(len(bits), len(COLUMNS)).view(np.float64)


def columns_at_fault(row: Row) -> tuple[str, ...]:
    """The columns whose values are not allowed."""
    return tuple(name for name, value in zip(COLUMNS, row, strict=True) if trouble_with(name, value) is not None)


def refusals() -> RefusalFile:
    """The file, made anew."""
    unlike = dict.fromkeys(_bad_rows())
    cases = []
    for number, bits in enumerate(unlike):
        row = tuple(rows_from_bits([bits])[0].tolist())
        cases.append(Refusal(f"{NAME}-{number:04d}", bits, columns_at_fault(row)))
    return RefusalFile(HEAD, tuple(cases))


def _bad_rows() -> Iterator[tuple[int, ...]]:
    """One bad number in each column, every kind of NaN in each, then several bad numbers that might cancel."""
    sound = [_bits(row) for row in _SOUND]
    for place, name in enumerate(COLUMNS):
        for turn, word in enumerate(_bad_words(name, _SOUND[place % 3][place])):
            yield _replaced(sound[(place + turn) % 3], {place: word})
    for turn, word in enumerate(_NANS.values()):
        for place in range(len(COLUMNS)):
            yield _replaced(sound[(place + turn) % 3], {place: word})
    nan, infinite = _NANS["nan"], _word(math.inf)
    for row in sound:
        sign = {place: row[place] ^ _SIGN for place in range(4)}
        yield _replaced(row, {0: sign[0], 2: sign[2]})  # α/b as before
        yield _replaced(row, {1: sign[1], 3: sign[3]})  # γ/d as before
        yield _replaced(row, sign)
        yield _replaced(row, {0: 0, 2: 0})  # α/b = 0/0
        yield _replaced(row, {1: 0, 3: 0})
        yield _replaced(row, {0: infinite, 2: infinite})
        yield _replaced(row, {1: infinite, 3: infinite})
        yield _replaced(row, {4: infinite, 5: infinite ^ _SIGN})
        yield _replaced(row, {2: infinite, 4: infinite})
        yield _replaced(row, {4: nan, 5: nan, 6: nan})
    yield (0,) * 7
    yield (nan,) * 7
    yield (infinite,) * 7
    yield (infinite ^ _SIGN,) * 7


def _bad_words(name: str, value: float) -> Iterator[int]:
    yield from (_word(math.inf), _word(-math.inf))
    if name in SIZES:
        yield from (0, _SIGN, _word(-value), _word(-math.ulp(0.0)), _word(-sys.float_info.max))


def _bits(row: Row) -> tuple[int, ...]:
    return tuple(rows_of([row]).view(np.uint64)[0].tolist())


def _word(value: float) -> int:
    return int(np.float64(value).view(np.uint64))


def _replaced(row: tuple[int, ...], words: dict[int, int]) -> tuple[int, ...]:
    return tuple(words.get(place, word) for place, word in enumerate(row))


def refusals_text(file: RefusalFile) -> str:
    """The whole document."""
    return document_text(REFUSALS, file.head, None, map(refusal_text, file.cases))


def refusal_text(case: Refusal) -> str:
    """One case, an object on one line."""
    return object_text(
        {
            "id": json_text(case.id),
            "row": numbers_text(case.row),
            "bits": json_text([f"{word:016x}" for word in case.bits]),
            "expected": json_text(EXPECTED),
            "columns": json_text(case.columns),
        }
    )


def read_refusals(path: str) -> RefusalFile:
    """The file of bad rows at `path`. Raises InputError where it is not wholly as the schema demands."""
    return refusals_of(scan(path), path)


def refusals_of(document: Document, path: str) -> RefusalFile:
    """The file of bad rows that a document is. Raises InputError where it is none."""
    head, _ = head_of(document, path, REFUSALS)
    cases = cases_of(document, path, head.name, CASE_FIELDS, _refusal)
    return RefusalFile(head, cases, tuple(place.line for place, _ in document.cases))


def _refusal(place: Place, fields: dict[str, Any]) -> Refusal:
    if fields["expected"] != EXPECTED:
        raise InputError(f"{place}: expected is {shown_json(fields['expected'])}; it must be {EXPECTED!r}")
    columns = listed(place, "columns", fields["columns"])
    if not columns or columns != [name for name in COLUMNS if name in columns]:
        raise InputError(f"{place}: columns is {shown_json(columns)}; it must name one or more of {', '.join(COLUMNS)}")
    numbers = listed(place, "row", fields["row"], len(COLUMNS))
    words = listed(place, "bits", fields["bits"], len(COLUMNS))
    bits = tuple(_checked_bits(place, *each) for each in zip(COLUMNS, numbers, words, strict=True))
    return Refusal(fields["id"], bits, tuple(columns))


def _checked_bits(place: Place, name: str, value: Any, word: Any) -> int:  # noqa: ANN401 - JSON
    number = _WORDS[value] if isinstance(value, str) and value in _WORDS else number_of(place, name, value)
    if not isinstance(word, str) or not _BITS.fullmatch(word):
        raise InputError(f"{place}: the bits of {name} are {shown_json(word)}; they must be 16 hexadecimal digits")
    bits = int(word, 16)
    if (bits & ~_SIGN <= _word(math.inf)) if math.isnan(number) else (bits != _word(number)):
        raise InputError(f"{place}: the bits of {name} are {word}, which is not {shown_json(value)}")
    return bits
