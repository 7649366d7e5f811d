"""Invalid rows, which implementations must refuse: how their files are made, read, written and checked."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hypcheck import strict
from hypcheck.geometry.pair import AXIS, ENDS, HEIGHTS, REFUSED, SIZES, trouble_with
from hypcheck.geometry.rows import PAIRS, SWEEPS, Layout, Rows, layout_with
from hypcheck.strict import StrictTable
from hypcheck.tables.numbers import shown_json
from hypcheck.tables.strict_json import JsonDocument
from hypcheck.vectors.draw import Row
from hypcheck.vectors.format import (
    CONTENTS,
    CaseFile,
    Content,
    FlagFacts,
    a_number,
    described,
    file_of,
    json_text,
    numbers_text,
    object_text,
)

INVALID_CONTENTS = {
    content.name.replace("refusals", "invalid"): content for content in CONTENTS.values() if content.refused
}
"""The files of rows without an answer by name, and the content of each."""

EXPECTED = "refused"
_FIELDS = ("id", "row", "bits", "expected", "columns")
_BITS = re.compile(r"[0-9a-f]{16}", re.ASCII)
_WORDS = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}
_SOUND = {
    PAIRS: (
        (1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0),
        (2.0, 17.8, 0.25, 0.15, 0.5, -1.25, 3.0),
        (4.0, 4.0, 1.0, 1.0, 4.0, 0.0, 0.5),
    ),
    SWEEPS: (
        (1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0, 4.0, 0.5, 1.0),
        (2.0, 17.8, 0.25, 0.15, 0.5, -1.25, 3.0, -0.5, 1.0, -2.0),
        (4.0, 4.0, 1.0, 1.0, 9.0, 0.0, 0.5, -9.0, 1.0, 0.5),
    ),
}
"""Valid rows, one of each position: exterior, interior, contact. Invalid rows are made of them by bad numbers."""

_SIGN = 1 << 63
_NANS = {
    "nan": 0x7FF8 << 48,
    "−nan": 0xFFF8 << 48,
    "payload": (0x7FF8 << 48) + 0x1234,
    "signalling": (0x7FF0 << 48) + 1,
}


@dataclass(frozen=True, slots=True)
class InvalidRow:
    """An invalid row: the 64 bits of its numbers, and the faulty columns, in their order."""

    id: str
    bits: tuple[int, ...]
    columns: tuple[str, ...]

    @property
    def row(self) -> Row:
        """The numbers; a NaN may lose its payload."""
        return tuple(rows_from_bits([self.bits])[0].tolist())

    @property
    def answer(self) -> int:
        """The code with which it must be refused."""
        return REFUSED


class InvalidRowFile(CaseFile):
    """A file of invalid rows."""

    @property
    def rows(self) -> Rows:
        """The rows, float64 (n, as many as the content's columns), to the bit."""
        return rows_from_bits([case.bits for case in self.cases])


def rows_from_bits(bits: Sequence[Sequence[int]]) -> Rows:
    """Make rows, (n, numbers of a row), of these 64-bit words."""
    return np.asarray(bits, dtype=np.uint64).reshape(len(bits), -1).view(np.float64)


def columns_at_fault(row: Row, names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the columns with values that are not allowed; of an axis without a direction all three."""
    values = dict(zip(names, row, strict=True))
    faults = [name for name, value in values.items() if name not in HEIGHTS and trouble_with(name, value) is not None]
    if AXIS[0] in values and not any(values[name] for name in AXIS):
        faults += AXIS
    if ENDS[0] in values:
        low, high = (values[name] for name in ENDS)
        numbers = [name for name in ENDS if math.isnan(values[name])]
        faults += numbers or ENDS[: 2 * (not low < high)]
        faults += HEIGHTS[2:] if values["solid"] not in (0, 1) else ()
    return tuple(faults)


def invalid_rows(name: str) -> InvalidRowFile:
    """Make the file of that name anew."""
    content = INVALID_CONTENTS[name]
    cases = []
    bad = _bad_ended_rows if content.ended else _bad_tilted_rows if content.tilted else _bad_rows
    for number, bits in enumerate(dict.fromkeys(bad(layout_with(content.groups)))):
        row = tuple(rows_from_bits([bits])[0].tolist())
        cases.append(InvalidRow(f"{name}-{number:04d}", bits, columns_at_fault(row, content.columns)))
    return InvalidRowFile(described(name, f"hypcheck cases freeze {name}"), content, tuple(cases))


def _bad_rows(layout: Layout) -> Iterator[tuple[int, ...]]:
    """Yield rows with a bad number in each column, every kind of NaN in each, several bad numbers that might cancel."""
    sound, width = [_bits(row) for row in _SOUND[layout]], len(layout.upright)
    for place, name in enumerate(layout.upright):
        for turn, word in enumerate(_bad_words(name, _SOUND[layout][place % 3][place])):
            yield _replaced(sound[(place + turn) % 3], {place: word})
    for turn, word in enumerate(_NANS.values()):
        for place in range(width):
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
        for place in range(4, width - 3):  # both ends of a sweep
            yield _replaced(row, {place: infinite, place + 3: infinite})  # the step is ∞ − ∞
            yield _replaced(row, {place: infinite, place + 3: infinite ^ _SIGN})
            yield _replaced(row, {place: nan, place + 3: nan})  # at rest, if NaN were equal to itself
    yield (0,) * width
    yield (nan,) * width
    yield (infinite,) * width
    yield (infinite ^ _SIGN,) * width


def _bad_tilted_rows(layout: Layout) -> Iterator[tuple[int, ...]]:
    """Yield rows with an axis of zeros, one or more bad numbers in the axis, bad numbers before a valid axis."""
    sound = [(*_bits(row), *_bits(axis)) for row, axis in zip(_SOUND[layout], _AXES, strict=True)]
    width = len(layout.upright)
    axis_places = range(width, width + len(AXIS))
    nan, infinite, minus = _NANS["nan"], _word(math.inf), _word(-math.inf)
    for row in sound:
        for zeros in ((0, 0, 0), (_SIGN, 0, 0), (0, _SIGN, _SIGN), (_SIGN, _SIGN, _SIGN)):
            yield _replaced(row, dict(zip(axis_places, zeros, strict=True)))
        for place in axis_places:
            for word in (infinite, minus, *_NANS.values()):
                yield _replaced(row, {place: word})
            others = {other: 0 for other in axis_places if other != place}
            for word in (nan, infinite):
                yield _replaced(row, {place: word, **others})
        for word in (nan, infinite, minus):
            yield _replaced(row, dict.fromkeys(axis_places, word))
        yield _replaced(row, {width: infinite, width + 1: minus})
        for place in range(width):
            yield _replaced(row, {place: nan})
        for place in range(len(SIZES)):
            yield _replaced(row, {place: 0})
            yield _replaced(row, {place: row[place] ^ _SIGN})
        yield _replaced(row, {2: 0, **dict.fromkeys(axis_places, 0)})
    yield (0,) * len(row)
    yield (nan,) * len(row)
    yield (infinite,) * len(row)


def _bad_ended_rows(layout: Layout) -> Iterator[tuple[int, ...]]:
    """Yield rows with ends in wrong order or equal, NaN for an end, `solid` other than 0 and 1, then other faults."""
    sound = [
        (*_bits(row), *_bits(axis), *_bits(heights))
        for row, axis, heights in zip(_SOUND[layout], _AXES, _HEIGHTS, strict=True)
    ]
    infinite, minus = _word(math.inf), _word(-math.inf)
    axis, ends, solid = ([layout.ended.index(name) for name in group] for group in (AXIS, ENDS, HEIGHTS[2:]))
    last = layout.ended.index(AXIS[0]) - 1
    for row in sound:
        low, high = (row[place] for place in ends)
        for words in ((high, low), (high, high), (0, _SIGN), (infinite, infinite), (minus, minus), (infinite, minus)):
            yield _replaced(row, dict(zip(ends, words, strict=True)))
        for place in (*ends, *solid):
            for word in _NANS.values():
                yield _replaced(row, {place: word})
        for value in (0.5, 2.0, -1.0, 5e-324, math.inf, -math.inf):
            yield _replaced(row, dict.fromkeys(solid, _word(value)))
        yield _replaced(row, dict.fromkeys(ends, _NANS["nan"]))
        yield _replaced(row, dict.fromkeys(axis, 0))
        yield _replaced(row, {0: 0})
        yield _replaced(row, {last: infinite, ends[1]: infinite})
    yield (0,) * len(sound[0])
    yield (_NANS["nan"],) * len(sound[0])


_HEIGHTS = ((-1.0, 2.0, 0.0), (-17.75, 17.75, 1.0), (-math.inf, 0.5, 0.0))
_AXES = ((3.0, 4.0, 12.0), (0.0, 0.0, 1.0), (-1.0, 0.5, 0.0))


def _bad_words(name: str, value: float) -> Iterator[int]:
    """Yield the bits of bad numbers for a column in which `value` is valid."""
    yield from (_word(math.inf), _word(-math.inf))
    if name in SIZES:
        yield from (0, _SIGN, _word(-value), _word(-math.ulp(0.0)), _word(-sys.float_info.max))


def _bits(row: Row) -> tuple[int, ...]:
    """Return the 64-bit words of a row's numbers."""
    return tuple(np.asarray(row, dtype=np.float64).view(np.uint64).tolist())


def _word(value: float) -> int:
    """Return the 64-bit word of a number."""
    return int(np.float64(value).view(np.uint64))


def _replaced(row: tuple[int, ...], words: dict[int, int]) -> tuple[int, ...]:
    """Return the words of a row with some of them replaced, by column."""
    return tuple(words.get(place, word) for place, word in enumerate(row))


def invalid_row_text(case: InvalidRow) -> str:
    """Return the text of one case, an object on one line."""
    return object_text(
        {
            "id": json_text(case.id),
            "row": numbers_text(case.row),
            "bits": json_text([f"{word:016x}" for word in case.bits]),
            "expected": json_text(EXPECTED),
            "columns": json_text(case.columns),
        }
    )


def invalid_rows_of(document: JsonDocument) -> InvalidRowFile:
    """Read the file of invalid rows of a document. Raises InputError if it is not such a document."""
    file = file_of(document, _FIELDS, _invalid_row)
    return InvalidRowFile(file.head, file.content, file.cases, file.flags, file.lines)


def _invalid_row(name: str, table: StrictTable, content: Content, _flags: Mapping[str, FlagFacts]) -> InvalidRow:
    """Read a case of an invalid row. Raises InputError."""
    names = content.columns
    table.required("expected", strict.one_of(EXPECTED))
    columns = table.required("columns", strict.list_with("a list"))
    if not columns or columns != [column for column in names if column in columns]:
        table.refuse(f"columns is {shown_json(columns)}; it must name one or more of {', '.join(names)}")
    wanted = strict.list_with(f"a list of {len(names)}", len(names), len(names))
    values, words = table.required("row", wanted), table.required("bits", wanted)
    bits = tuple(_checked_bits(table, *column) for column in zip(names, values, words, strict=True))
    return InvalidRow(name, bits, tuple(columns))


def _checked_bits(table: StrictTable, name: str, value: object, word: object) -> int:
    """Read the bits of a number, which must agree with its value. Raises InputError."""
    number = _WORDS[value] if isinstance(value, str) and value in _WORDS else table.check(name, value, a_number)
    if not isinstance(word, str) or not _BITS.fullmatch(word):
        table.refuse(f"the bits of {name} are {shown_json(word)}; they must be 16 hexadecimal digits")
    bits = int(word, 16)
    if (bits & ~_SIGN <= _word(math.inf)) if math.isnan(number) else (bits != _word(number)):
        table.refuse(f"the bits of {name} are {word}, which is not {shown_json(value)}")
    return bits
