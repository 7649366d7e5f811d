"""TOML files that users write: read if they are not too large or too deep, and the line of each value.

A reader of TOML does not give lines. The scanner at the end finds them in a text that is known to be valid TOML 1.0
(tomllib has read it), so it judges nothing.
"""

from __future__ import annotations

import os
import re
import stat
import sys
from collections.abc import Mapping
from functools import cache
from typing import Any

from hypcheck.errors import InputError, system_reason

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

LARGEST = 1 << 20
"""The most bytes of a file: enough for ten thousand trees of a scene. A larger file that is slow to read would take
minutes and gigabytes."""


def text_of(path: str) -> str:
    """Return the text of a regular file, without a byte order mark. Raises FileNotFoundError, else InputError."""
    try:
        # Non-blocking: opening a pipe would wait until another process writes to it.
        with open(os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0)), "rb") as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise InputError(f"cannot read {path}: it is a pipe or a device; it must be a regular file")
            content = file.read(LARGEST + 1)
    except FileNotFoundError:
        raise
    except OSError as error:
        raise InputError(f"cannot read {path}: {system_reason(error)}") from None
    except ValueError as error:  # a NUL in the name
        raise InputError(f"cannot read {path}: {error}") from None
    if len(content) > LARGEST:
        raise InputError(f"{path}: has more than {LARGEST >> 20} MiB; it must be smaller")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path}, line {line}: is not UTF-8 text: {error.reason} at byte {error.start}; save it as UTF-8"
        ) from None


_LONG_INTEGER = re.compile(r"0[xob][0-9A-Fa-f_]{400}")
_TOO_LONG = "has an integer with too many digits; a number must fit into float64"

MOST_DOTS = 100
"""The most dots of a line, without decimal points and runs of dots: the parser's time and memory grow with the square
of the number of parts of a key such as a.b.c, which is on one line."""

_NO_KEY = re.compile(r"(?<![\w.])\d+\.\d+(?:[eE][+-]?\d+)?(?!\s*[\w.])|\.{2,}")


def parsed(text: str, name: str) -> dict[str, Any]:
    """Return the content of a TOML text; `name` is that of its file. Raises InputError."""
    if _LONG_INTEGER.search(text):  # Python would read it, and could not print it in a message
        raise InputError(f"{name}: {_TOO_LONG}")
    for number, line in enumerate(text.split("\n"), start=1):
        if line.count(".") > MOST_DOTS and _NO_KEY.sub("", line).count(".") > MOST_DOTS:
            raise InputError(f"{name}, line {number}: has more than {MOST_DOTS} dots; a key or text must be shorter")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{name}: is not valid TOML: {error}") from None
    except RecursionError:
        raise InputError(f"{name}: cannot be read as TOML: it is nested too deeply") from None
    except ValueError:  # an integer of more than 4300 digits
        raise InputError(f"{name}: {_TOO_LONG}") from None


@cache
def shipped(package: str, name: str) -> dict[str, Any]:
    """Read a TOML file that is installed beside the modules of one of our packages. The caller must not change it."""
    from importlib import resources  # noqa: PLC0415 - slow to load, and no command needs it to read its options

    return parsed(resources.files(package).joinpath(name).read_text(encoding="utf-8"), name)


Path = tuple[str | int, ...]
"""The path to a value: keys of tables, and places in arrays counted from 0."""

_BLANK = re.compile(r"[ \t\r\n]*")
_COMMENT = re.compile(r"#[^\n]*")
_SPACE = re.compile(r"[ \t]*")
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_BARE_VALUE = re.compile(r"[^,\]}#\n]+")
_WITHIN = {'"': re.compile(r'[^"\\]+'), "'": re.compile(r"[^']+")}
"""The parts of a text between its quotation marks and escapes. No pattern repeats a group, which would take memory."""


def lines_of(text: str) -> dict[Path, int]:
    """Return the line, counted from 1, of every table, array and value in a valid TOML text, by its path.

    The result is empty if the text is nested so deeply that only tomllib, which had more of the stack left, could read
    it.
    """
    try:
        return _TomlScanner(text).scan()
    except RecursionError:
        return {}


def nearest_line(lines: Mapping[Path, int], path: Path) -> int | None:
    """Return the line of the value at the path, else of the innermost table or array around it that is known."""
    while path and path not in lines:
        path = path[:-1]
    return lines.get(path)


class _TomlScanner:
    """Finds the line of each value in a valid TOML text, from its beginning to its end."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0
        self._lines: dict[Path, int] = {}
        self._counts: dict[Path, int] = {}
        """The number of tables that each array of tables has so far."""
        self._counted, self._line_there = 0, 1
        """The place up to which lines were counted, and the line there."""

    def scan(self) -> dict[Path, int]:
        """Read the whole text, and return the line of each value by its path."""
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
        """Read a header, [a.b] or [[a.b]], and return the path of the table that it begins."""
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
        """Return the path of the table with that key; if it is an array of tables, of the last one."""
        path: Path = (*table, key)
        return (*path, self._counts[path] - 1) if path in self._counts else path

    def _pair(self, table: Path) -> None:
        """Read a key and its value. Each table within a dotted key begins where it is first named."""
        line = self._line()
        path = table
        for key in self._keys():
            path = (*path, key)
            self._lines.setdefault(path, line)
        self._at += 1  # the equals sign
        self._skip(_SPACE)
        self._value(path)

    def _value(self, path: Path) -> None:
        """Read a value, and keep its line."""
        self._lines[path] = self._line()
        opening = self._text[self._at]
        if opening == "[":
            self._sequence("]", path)
        elif opening == "{":
            self._sequence("}", path)
        else:
            self._quoted() if opening in _WITHIN else self._skip(_BARE_VALUE)

    def _sequence(self, closing: str, path: Path) -> None:
        """Read the values between brackets, separated by commas."""
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
        """Read a dotted key, and return its parts."""
        keys = []
        while True:
            self._skip(_SPACE)
            keys.append(self._key())
            self._skip(_SPACE)
            if self._text[self._at] != ".":
                return tuple(keys)
            self._at += 1

    def _key(self) -> str:
        """Read one part of a key, and return it without its quotation marks and escapes."""
        begin = self._at
        if self._text[begin] not in _WITHIN:
            return self._take(_BARE_KEY)
        self._quoted()
        return str(parsed(f"key = {self._text[begin : self._at]}", "a key")["key"])

    def _quoted(self) -> None:
        """Read a text in one quotation mark or three. One or two marks before the last three belong to the text."""
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
        """Skip blanks, ends of lines and comments."""
        self._skip(_BLANK)
        while self._text.startswith("#", self._at):
            self._skip(_COMMENT)
            self._skip(_BLANK)

    def _line(self) -> int:
        """Return the number of the current line."""
        self._line_there += self._text.count("\n", self._counted, self._at)
        self._counted = self._at
        return self._line_there

    def _take(self, pattern: re.Pattern[str]) -> str:
        """Read what the pattern matches here, and return it."""
        match = pattern.match(self._text, self._at)
        if match is None:
            raise AssertionError("a text that is not valid TOML was to be scanned")
        self._at = match.end()
        return match.group()

    def _skip(self, pattern: re.Pattern[str]) -> None:
        """Read what the pattern matches here."""
        self._take(pattern)
