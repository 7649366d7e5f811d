"""A JSON document with a list of cases, read strictly, each part with the line it stands on.

Python's own reader takes 1e999 for infinity and forgets where a value stood. Here every number is finite and keeps its
text, and every message names a line.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from hypcheck.errors import InputError
from hypcheck.tables.lines import BYTE_ORDER_MARK, text_lines
from hypcheck.tables.numbers import Literal, shown
from hypcheck.tables.streams import Reader, reading
from hypcheck.tables.strict_json import object_of, strict_decoder

CASES = "cases"
LARGEST = 256 << 20
"""Bytes of a document, which is held in memory: two hundred thousand cases, or the beginning of a pipe without end."""

_BLANKS = re.compile(r"[ \t\n\r]*")


@dataclass(frozen=True, slots=True)
class Place:
    """Where something stands, for messages: a file, a line of it, and the id of a case."""

    file: str
    line: int
    case: str | None = None

    def __str__(self) -> str:
        case = f", case {shown(self.case, quoted=False)}" if self.case is not None else ""
        return f"{self.file}, line {self.line}{case}"


@dataclass(frozen=True, slots=True)
class Document:
    """The members of a document but for its cases, and these, each with its place."""

    members: Mapping[str, tuple[Place, Any]]
    cases: tuple[tuple[Place, Any], ...]


def scan(path: str) -> Document:
    """The document in the file at `path` ("-" is standard input). Raises InputError where it is none."""
    with reading(path) as reader:
        text = "".join(_bounded(reader))
        return _Scanner(text.removeprefix(BYTE_ORDER_MARK), reader.name).document()


def fields_of(value: Any, names: tuple[str, ...], place: Place, what: str) -> tuple[Any, ...]:  # noqa: ANN401 - JSON
    """The members of an object that has these and no others, in the order of `names`. Raises InputError."""
    members = object_of(value, f"{place}: {what}", names)
    return tuple(members[name] for name in names)


def _bounded(reader: Reader) -> Iterator[str]:
    for line in text_lines(reader):
        if reader.taken > LARGEST:
            raise InputError(f"{reader.name} has more than {LARGEST >> 20} MiB; it must be divided into smaller files")
        yield line


class _Scanner:
    """A place in a text that moves on as parts of the document are read."""

    def __init__(self, text: str, name: str) -> None:
        self._text = text
        self._name = name
        self._at = 0
        self._counted = 0
        self._line = 1
        self._decoder = strict_decoder(_finite)

    def document(self) -> Document:
        members: dict[str, tuple[Place, Any]] = {}
        cases: tuple[tuple[Place, Any], ...] = ()
        self._expect("{", "the document must be one object")
        while not members or self._more("}"):
            place, key = self._place(), self._value()
            if not isinstance(key, str):
                raise InputError(f"{place}: a key must be a string")
            if key in members:
                raise InputError(f"{place}: key {shown(key)} stands twice; it must stand once")
            self._expect(":", f"a colon must follow the key {shown(key)}")
            if key == CASES:
                cases = self._elements()
            members[key] = (place, None if key == CASES else self._value())
        if self._peek():
            raise InputError(f"{self._place()}: something follows the document; a file must hold one object")
        if members.pop(CASES, None) is None:
            raise InputError(f"{self._name}: the document has no {CASES!r}")
        return Document(members, cases)

    def _elements(self) -> tuple[tuple[Place, Any], ...]:
        self._expect("[", f"{CASES} must be a list")
        found: list[tuple[Place, Any]] = []
        if self._peek() == "]":
            self._at += 1
            return ()
        while not found or self._more("]"):
            found.append((self._place(), self._value()))
        return tuple(found)

    def _value(self) -> Any:  # noqa: ANN401 - JSON
        place = self._place()
        try:
            value, self._at = self._decoder.raw_decode(self._text, self._at)
        except json.JSONDecodeError as error:
            raise self._not_json(error.pos, error.msg.lower()) from None
        except RecursionError:
            raise InputError(f"{place}: nested too deeply") from None
        except ValueError as error:
            raise InputError(f"{place}: {error}") from None
        return value

    def _more(self, end: str) -> bool:
        """Whether a comma, and not the end, follows."""
        found = self._peek()
        if found not in (",", end) or not found:
            raise self._not_json(self._at, f"expecting ',' or '{end}'")
        self._at += 1
        self._peek()
        return found == ","

    def _expect(self, character: str, otherwise: str) -> None:
        if self._peek() != character:
            raise self._not_json(self._at, otherwise)
        self._at += 1
        self._peek()

    def _peek(self) -> str:
        """The next character that is no blank, "" at the end."""
        blanks = _BLANKS.match(self._text, self._at)
        self._at = blanks.end() if blanks else self._at
        return self._text[self._at : self._at + 1]

    def _place(self) -> Place:
        self._line += self._text.count("\n", self._counted, self._at)
        self._counted = self._at
        return Place(self._name, self._line)

    def _not_json(self, at: int, reason: str) -> InputError:
        self._at = max(min(at, len(self._text)), self._counted)
        cut = " (the file may have been cut off)" if self._at >= len(self._text.rstrip()) else ""
        return InputError(f"{self._place()}: not a JSON document of cases: {reason}{cut}")


def _finite(text: str) -> Literal:
    number = Literal(text)
    if abs(number) == float("inf"):
        raise ValueError(f"{shown(text, quoted=False)} is too large for float64")
    return number
