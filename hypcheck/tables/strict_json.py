"""Strict JSON: no duplicate key, only finite numbers, only known members; errors name the line.

Python's own reader takes the last of two equal keys, accepts NaN, takes 1e999 for infinity, and forgets where a value
stood. A document with a list of cases is read part by part, each with the line where it begins, numbers with their
text.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

from hypcheck.errors import InputError
from hypcheck.messages import json_trouble
from hypcheck.strict import Origin, StrictTable
from hypcheck.tables.chunk import first_double
from hypcheck.tables.numbers import Literal, shown, shown_json
from hypcheck.tables.streams import BYTE_ORDER_MARK, Reader, TextLines, open_input
from hypcheck.toml import Path, nearest_line

_LONGEST_INTEGER = 400
"""The most digits of an integer that is read as int; longer ones are beyond float64, and Python may refuse them."""


def refused_constant(text: str) -> NoReturn:
    """Raise ValueError, the end of a sentence, for NaN and the infinities."""
    raise ValueError(f"{text} is not JSON; every number must be finite")


def strict_decoder(
    number: Callable[[str], float] | None = None, constant: Callable[[str], float] = refused_constant
) -> json.JSONDecoder:
    """Return a decoder that raises ValueError, the end of a sentence, about text that is not strict JSON.

    `number`, if given, makes a number of its text, except for integers of ordinary length; `constant` makes a number of
    NaN, Infinity and -Infinity.
    """
    if number is None:
        return json.JSONDecoder(object_pairs_hook=_members, parse_constant=constant)

    def integer(text: str) -> float:
        return int(text) if len(text) <= _LONGEST_INTEGER else number(text)

    return json.JSONDecoder(object_pairs_hook=_members, parse_constant=constant, parse_float=number, parse_int=integer)


def _members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Make an object of its members. Raises ValueError for a duplicate key."""
    members = dict(pairs)
    if len(members) < len(pairs):
        double = first_double([name for name, _ in pairs])
        raise ValueError(f"duplicate key {shown(str(double))}")
    return members


CASES = "cases"
LARGEST = 256 << 20
"""The most bytes of a document, which is held in memory: two hundred thousand cases."""

_BLANKS = re.compile(r"[ \t\n\r]*")


class JsonOrigin(Origin):
    """The source of tables of JSON."""

    def shown(self, value: object) -> str:
        """Return a value as JSON writes it, cut if it is long."""
        return shown_json(value)


@dataclass(frozen=True)
class JsonPlace(JsonOrigin):
    """A place, as messages name it: a file, a line of it, and the id of a case."""

    file: str
    line: int
    case: str | None = None

    title = "the case"

    def __str__(self) -> str:
        case = f", case {shown(self.case, quoted=False)}" if self.case is not None else ""
        return f"{self.file}, line {self.line}{case}"

    def where(self, path: Path) -> str:  # noqa: ARG002 - a case is on one line
        """Return the place itself."""
        return str(self)


@dataclass(frozen=True)
class JsonDocument(JsonOrigin):
    """A document: its file, its members except the cases, the line of each, and the cases with their places."""

    file: str
    members: Mapping[str, Any]
    lines: Mapping[Path, int]
    cases: tuple[tuple[JsonPlace, Any], ...]

    title = "the document"

    def where(self, path: Path) -> str:
        """Return the file, and the line where the member begins."""
        line = nearest_line(self.lines, path)
        return self.file if line is None else f"{self.file}, line {line}"

    def table(self, keys: Sequence[str]) -> StrictTable:
        """Return the members, which must be among these keys. Raises InputError."""
        return StrictTable(self, (), self.members, keys)


def read_document(path: str, largest: int = LARGEST) -> JsonDocument:
    """Read the document in the file at `path` ("-" is standard input), of `largest` bytes at most.

    Raises InputError if the file holds no such document.
    """
    with open_input(path) as reader:
        text = "".join(_bounded(reader, largest))
        return _JsonScanner(text.removeprefix(BYTE_ORDER_MARK), reader.name).document()


def _bounded(reader: Reader, largest: int) -> Iterator[str]:
    """Yield the lines of a reader. Raises InputError if there are more than `largest` bytes."""
    for line in TextLines(reader).each:
        if reader.taken > largest:
            raise InputError(f"{reader.name} has more than {largest >> 20} MiB; it must be divided into smaller files")
        yield line


class _JsonScanner:
    """Reads a document from its text, part by part, and knows the line of each."""

    def __init__(self, text: str, name: str) -> None:
        self._text = text
        self._name = name
        self._at = 0
        self._counted = 0
        self._line = 1
        self._decoder = strict_decoder(_finite)

    def document(self) -> JsonDocument:
        """Read the whole document. Raises InputError."""
        members: dict[str, Any] = {}
        lines: dict[Path, int] = {}
        cases: tuple[tuple[JsonPlace, Any], ...] = ()
        self._expect("{", "the document must be one object")
        while not members or self._more("}"):
            place, key = self._place(), self._value()
            if not isinstance(key, str):
                raise InputError(f"{place}: a key must be a string")
            if key in members:
                raise InputError(f"{place}: duplicate key {shown(key)}")
            self._expect(":", f"a colon must follow the key {shown(key)}")
            if key == CASES:
                cases = self._elements()
            members[key], lines[key,] = None if key == CASES else self._value(), place.line
        if self._peek():
            raise InputError(f"{self._place()}: something follows the document; a file must hold one object")
        if CASES not in members:
            raise InputError(f"{self._name}: the document has no {CASES!r}")
        del members[CASES]
        return JsonDocument(self._name, members, lines, cases)

    def _elements(self) -> tuple[tuple[JsonPlace, Any], ...]:
        """Read the list of cases, each with its place. Raises InputError."""
        self._expect("[", f"{CASES} must be a list")
        elements: list[tuple[JsonPlace, Any]] = []
        if self._peek() == "]":
            self._at += 1
            return ()
        while not elements or self._more("]"):
            elements.append((self._place(), self._value()))
        return tuple(elements)

    def _value(self) -> Any:  # noqa: ANN401 - JSON
        """Read the value that begins here. Raises InputError if it is not strict JSON."""
        place = self._place()
        try:
            value, self._at = self._decoder.raw_decode(self._text, self._at)
        except json.JSONDecodeError as error:
            raise self._not_json(error.pos, json_trouble(error)) from None
        except RecursionError:
            raise InputError(f"{place}: nested too deeply") from None
        except ValueError as error:
            raise InputError(f"{place}: {error}") from None
        return value

    def _more(self, end: str) -> bool:
        """Step over a comma (True), or over the end of the list or object (False). Else raises InputError."""
        character = self._peek()
        if character not in (",", end) or not character:
            raise self._not_json(self._at, f"expecting ',' or '{end}'")
        self._at += 1
        self._peek()
        return character == ","

    def _expect(self, character: str, otherwise: str) -> None:
        """Step over a character that must follow. Raises InputError with the sentence `otherwise`."""
        if self._peek() != character:
            raise self._not_json(self._at, otherwise)
        self._at += 1
        self._peek()

    def _peek(self) -> str:
        """Go to the next character that is not a blank, and return it; "" at the end."""
        blanks = _BLANKS.match(self._text, self._at)
        self._at = blanks.end() if blanks else self._at
        return self._text[self._at : self._at + 1]

    def _place(self) -> JsonPlace:
        """Return the place where reading stands."""
        self._line += self._text.count("\n", self._counted, self._at)
        self._counted = self._at
        return JsonPlace(self._name, self._line)

    def _not_json(self, at: int, reason: str) -> InputError:
        """Make the error that the text is not JSON at a place, for a reason."""
        self._at = max(min(at, len(self._text)), self._counted)
        cut = " (the file may have been cut off)" if self._at >= len(self._text.rstrip()) else ""
        return InputError(f"{self._place()}: not a JSON document of cases: {reason}{cut}")


def _finite(text: str) -> Literal:
    """Read a number with its text. Raises ValueError if it is too large for float64."""
    number = Literal(text)
    if abs(number) == float("inf"):
        raise ValueError(f"{shown(text, quoted=False)} is too large for float64")
    return number
