"""Values out of a parsed TOML table: each is checked, none is left over, and every refusal names its line."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NoReturn, TypeVar

from hypcheck.errors import InputError
from hypcheck.messages import suggestion
from hypcheck.scene.model import FREE, Point, Span
from hypcheck.scene.positions import Path, lines_of, nearest_line

Value = TypeVar("Value")
Check = Callable[[object], Value]
"""From what the file holds to what the scene holds; raises ValueError, whose text ends "it must be …"."""

_LONGEST = 60
"""Characters of a value that a message shows."""

LONGEST_TEXT = 1000
"""Characters of a text."""


@dataclass(frozen=True)
class TomlSource:
    """A file's name and its text."""

    name: str
    text: str

    @cached_property
    def lines(self) -> dict[Path, int]:
        """The line of everything in it; asked for only where something is wrong."""
        return lines_of(self.text)

    def refuse(self, path: Path, sentence: str) -> NoReturn:
        """Raise InputError about what stands at the path."""
        line = nearest_line(self.lines, path)
        raise InputError(f"{self.name}{'' if line is None else f', line {line}'}: {sentence}")


class TomlTable:
    """A table of a file. `title` says which one it is, as messages name it."""

    def __init__(self, source: TomlSource, path: Path, title: str, content: object, keys: Sequence[str]) -> None:
        self._source, self._path, self._title = source, path, title
        if not isinstance(content, dict):
            self.refuse(f"{title} is {shown(content)}; it must be a table with {_listed(keys)}")
        self._content: dict[str, Any] = content
        for key in content:
            if key not in keys:
                hint = suggestion(key, keys, most=1, otherwise="it may have")
                self.refuse(f"{title} has the key {shown(key)}, which is not known; {hint}", key)

    def refuse(self, sentence: str, *keys: str | int) -> NoReturn:
        """Raise InputError about the table, or about a value in it."""
        self._source.refuse((*self._path, *keys), sentence)

    def required(self, key: str, check: Check[Value]) -> Value:
        """The checked value of a key that must be there."""
        if key not in self._content:
            self.refuse(f"{self._title} has no {key}; it must be {_wanted(check)}")
        return self._checked(key, check)

    def optional(self, key: str, check: Check[Value], default: Value) -> Value:
        """The checked value of a key, or the default where it is not there."""
        return self._checked(key, check) if key in self._content else default

    def table(self, key: str, keys: Sequence[str]) -> TomlTable | None:
        """The table of that key, None where it is not there."""
        if key not in self._content:
            return None
        title = f"{self._title}.{key}" if self._path else f"[{key}]"
        return TomlTable(self._source, (*self._path, key), title, self._content[key], keys)

    def tables(self, key: str, keys: Sequence[str], most: int) -> list[TomlTable]:
        """The array of tables of that key, `most` at most, each entitled by its number from 1; empty without one."""
        array = self._content.get(key, [])
        if not isinstance(array, list):
            name = ".".join([*map(str, self._path), key])
            self.refuse(f"{key} is {shown(array)}; it must be an array of tables, [[{name}]]", key)
        if len(array) > most:
            self.refuse(f"{self._title} has {len(array):,} tables {key}; a file may have {most:,} at most", key)
        title = f"{self._title} {key}" if self._path else key
        return [
            TomlTable(self._source, (*self._path, key, place), f"{title} {place + 1}", content, keys)
            for place, content in enumerate(array)
        ]

    def _checked(self, key: str, check: Check[Value]) -> Value:
        value = self._content[key]
        try:
            return check(value)
        except ValueError as error:
            self.refuse(f"{self._title}: {key} is {shown(value)}; it must be {error}", key)


def shown(value: object) -> str:
    """A value as a message shows it: short, and as it stands in the file where that can be."""
    text = json.dumps(value, ensure_ascii=False, default=str).replace("NaN", "nan").replace("Infinity", "inf")
    return text if len(text) <= _LONGEST else text[:_LONGEST] + "…"


def text(value: object) -> str:
    """A text with something in it."""
    if not isinstance(value, str) or not value.strip() or len(value) > LONGEST_TEXT:
        raise ValueError(f"a text that is not empty, of at most {LONGEST_TEXT:,} characters")
    return value


def one_of(*choices: str) -> Check[str]:
    """One of some words."""

    def check(value: object) -> str:
        if not isinstance(value, str) or value not in choices:
            raise ValueError(f"one of {', '.join(choices)}")
        return value

    return check


def _number_with(wanted: str, low: float = -math.inf, high: float = math.inf, *, above: bool = False) -> Check[float]:
    """A check for a finite number from `low` to `high`, or `above` low; `wanted` ends the sentence of a refusal."""

    def check(value: object) -> float:
        result = _number(value, wanted)
        if not low <= result <= high or (above and result == low):
            raise ValueError(wanted)
        return result

    return check


number = _number_with("a finite number")
positive = _number_with("a finite number above 0", 0, above=True)
"""A length of a body."""

not_negative = _number_with("a finite number, 0 or more", 0)
"""A distance."""

turn = _number_with("a number of degrees, from -180 to 180", -180, 180)
"""An angle, in degrees."""

share = _number_with("a number from 0 to 1", 0, 1)
"""A chance."""


def integer(value: object) -> int:
    """How many of something."""
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 2**31:
        raise ValueError("a whole number, 0 or more and below 2^31")
    return value


def truth(value: object) -> bool:
    """Whether something is so."""
    if not isinstance(value, bool):
        raise ValueError("true or false")  # noqa: TRY004 - as in _number
    return value


def point(value: object) -> Point:
    """Three coordinates."""
    wanted = "three finite numbers, [x, y, z]"
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError(wanted)
    x, y, z = (_number(each, wanted) for each in value)
    return x, y, z


def axis(value: object) -> Point:
    """A direction, of any length."""
    wanted = "three finite numbers, [x, y, z], not all 0"
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError(wanted)
    x, y, z = (_number(each, wanted) for each in value)
    if x == y == z == 0:
        raise ValueError(wanted)
    return x, y, z


def axis_or_free(value: object) -> Point | Literal["free"]:
    """A direction, or that each query names one."""
    if value == FREE:
        return FREE
    try:
        return axis(value)
    except ValueError as error:
        raise ValueError(f'{error}, or "{FREE}"') from None


def span(value: object) -> Span:
    """A range of more than one number."""
    wanted = "two finite numbers, [low, high] with low < high"
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError(wanted)
    low, high = (_number(each, wanted) for each in value)
    if not low < high:
        raise ValueError(wanted)
    return Span(low, high)


def span_or_number(value: object) -> Span:
    """A range, or a single number that fixes it."""
    if isinstance(value, list):
        return span(value)
    only = _number(value, "a finite number, or two, [low, high] with low < high")
    return Span(only, only)


def _number(value: object, wanted: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(wanted)  # noqa: TRY004 - turned into a sentence about the value
    try:
        result = float(value) + 0.0  # + 0.0 turns −0.0 into 0.0
    except OverflowError:
        raise ValueError(f"{wanted} that float64 holds") from None
    if not math.isfinite(result):
        raise ValueError(wanted)
    return result


def _wanted(check: Check[Any]) -> str:
    """What a check asks for: the sentence with which it refuses what is nothing at all."""
    try:
        check(None)
    except ValueError as error:
        return str(error)
    raise AssertionError("a check let nothing pass for something")


def _listed(keys: Sequence[str]) -> str:
    return ", ".join(keys)
