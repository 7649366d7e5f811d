"""The line of each value in a TOML text, which a reader of TOML does not give.

The text is known to be valid TOML 1.0 (tomllib has read it), so this scanner finds its way and judges nothing.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Path = tuple[str | int, ...]
"""How to get to a value: keys of tables, and places in arrays counted from 0."""

_BLANK = re.compile(r"[ \t\r\n]*")
_COMMENT = re.compile(r"#[^\n]*")
_SPACE = re.compile(r"[ \t]*")
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_BARE_VALUE = re.compile(r"[^,\]}#\n]+")
_WITHIN = {'"': re.compile(r'[^"\\]+'), "'": re.compile(r"[^']+")}
"""What stands in a text between its marks and escapes. No pattern repeats a group: that takes memory each time."""


def lines_of(text: str) -> dict[Path, int]:
    """The line, counted from 1, of every table, array and value in a valid TOML text, by its path."""
    return _TomlScanner(text).scan()


def nearest_line(lines: Mapping[Path, int], path: Path) -> int | None:
    """The line of the value at the path, else of the innermost table or array around it that is known."""
    while path and path not in lines:
        path = path[:-1]
    return lines.get(path)


class _TomlScanner:
    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0
        self._lines: dict[Path, int] = {}
        self._counts: dict[Path, int] = {}
        """How many tables each array of tables has so far."""
        self._counted, self._line_there = 0, 1
        """Up to where lines were counted, and the line there."""

    def scan(self) -> dict[Path, int]:
        table: Path = ()
        self._blank()
        while self._at < len(self._text):
            if self._text[self._at] == "[":
                table = self._header()
            else:
                self._pair(table)
            self._blank()
        return self._lines

    def _header(self) -> Path:
        """The table that [a.b] or [[a.b]] begins."""
        line, several = self._line(), self._text.startswith("[[", self._at)
        self._at += 2 if several else 1
        keys = self._keys()
        self._at += 2 if several else 1
        table: Path = ()
        for key in keys[:-1]:
            table = self._inner(table, key)
        if several:
            array = (*table, keys[-1])
            self._lines.setdefault(array, line)
            self._counts[array] = self._counts.get(array, 0) + 1
        table = self._inner(table, keys[-1])
        self._lines[table] = line
        return table

    def _inner(self, table: Path, key: str) -> Path:
        """The table of that key; of an array of tables, its last one."""
        path: Path = (*table, key)
        return (*path, self._counts[path] - 1) if path in self._counts else path

    def _pair(self, table: Path) -> None:
        """A key and its value; each table on the way of a dotted key begins where it is first named."""
        line = self._line()
        path = table
        for key in self._keys():
            path = (*path, key)
            self._lines.setdefault(path, line)
        self._at += 1  # the equals sign
        self._skip(_SPACE)
        self._value(path)

    def _value(self, path: Path) -> None:
        self._lines[path] = self._line()
        opening = self._text[self._at]
        if opening == "[":
            self._sequence("]", path)
        elif opening == "{":
            self._sequence("}", path)
        else:
            self._quoted() if opening in _WITHIN else self._skip(_BARE_VALUE)

    def _sequence(self, closing: str, path: Path) -> None:
        """What stands between brackets, with commas between."""
        place = 0
        self._at += 1
        self._blank()
        while self._text[self._at] != closing:
            if closing == "]":
                self._value((*path, place))
            else:
                self._pair(path)
            place += 1
            self._blank()
            if self._text[self._at] == ",":
                self._at += 1
                self._blank()
        self._at += 1

    def _keys(self) -> tuple[str, ...]:
        """The parts of a dotted key; the scanner stands on what follows it then."""
        keys = []
        while True:
            self._skip(_SPACE)
            keys.append(self._key())
            self._skip(_SPACE)
            if self._text[self._at] != ".":
                return tuple(keys)
            self._at += 1

    def _key(self) -> str:
        """A key without its quotation marks and escapes."""
        begin = self._at
        if self._text[begin] not in _WITHIN:
            return self._take(_BARE_KEY)
        self._quoted()
        return str(tomllib.loads(f"key = {self._text[begin : self._at]}")["key"])

    def _quoted(self) -> None:
        """A text in one quotation mark, or in three and with one or two of its own before the last three."""
        quote = self._text[self._at]
        mark = 3 * quote if self._text.startswith(3 * quote, self._at) else quote
        self._at += len(mark)
        while not self._text.startswith(mark, self._at):
            if self._text[self._at] == "\\" and quote == '"':
                self._at += 2
            elif self._text[self._at] == quote:
                self._at += 1
            else:
                self._skip(_WITHIN[quote])
        self._at += len(mark)
        for _ in range(len(mark) - 1):
            self._at += self._text.startswith(quote, self._at)

    def _blank(self) -> None:
        """Blanks, ends of lines and comments."""
        self._skip(_BLANK)
        while self._text.startswith("#", self._at):
            self._skip(_COMMENT)
            self._skip(_BLANK)

    def _line(self) -> int:
        self._line_there += self._text.count("\n", self._counted, self._at)
        self._counted = self._at
        return self._line_there

    def _take(self, pattern: re.Pattern[str]) -> str:
        match = pattern.match(self._text, self._at)
        if match is None:
            raise AssertionError("a text that is no TOML was to be scanned")
        self._at = match.end()
        return match.group()

    def _skip(self, pattern: re.Pattern[str]) -> None:
        self._take(pattern)
