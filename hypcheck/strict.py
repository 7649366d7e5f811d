"""Tables that users and foreign programs write, read strictly: each value is checked, and no key is left over.

A check makes something of a value, or raises ValueError, whose text says what the value must be. The refusal of a value
is one sentence: where it is, what it is, and what it must be. Scenes, settings and known failures in TOML are read so,
and vector files and the descriptions of implementations in JSON.
"""

from __future__ import annotations

import json
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import repeat
from typing import Any, NoReturn, TypeVar

from hypcheck import toml
from hypcheck.errors import InputError
from hypcheck.messages import suggestion
from hypcheck.toml import Path

Value = TypeVar("Value")
Other = TypeVar("Other")
Check = Callable[[object], Value]
"""A function that checks a value of a table and converts it. It raises ValueError, whose text ends "it must be …".

It may also raise InputError, whose text is then the whole sentence.
"""


class PartError(ValueError):
    """The refusal of a value within a checked one: its path, the value, and the requirement as text."""

    def __init__(self, path: Path, value: object, wanted: str) -> None:
        super().__init__(wanted)
        self.path, self.value = path, value


def _at_fault(error: ValueError, value: object) -> tuple[Path, object]:
    """Return the path and the value at fault if a check refused `value` with this error: a part of it, or all of it."""
    return (error.path, error.value) if isinstance(error, PartError) else ((), value)


class Origin(ABC):
    """The source of tables; it names them and their values in messages. `title` names the outermost table."""

    title: str
    table_kind = "an object"
    """The noun for a table."""

    def where(self, path: Path) -> str:  # noqa: ARG002 - most origins have places for paths
        """Return the place of a value (a file, a line), which begins a sentence about it; "" if it cannot be named."""
        return ""

    def refuse(self, path: Path, sentence: str) -> NoReturn:
        """Raise InputError about the value at the path."""
        where = self.where(path)
        raise InputError(f"{where}: {sentence}" if where else sentence)

    def named(self, path: Path) -> str:
        """Return the table or the value at a path, as a sentence names it."""
        return dotted(path) or self.title

    def named_value(self, path: Path) -> str:
        """Return the value at a path, as the beginning of a sentence about it."""
        return self.named(path)

    @abstractmethod
    def shown(self, value: object) -> str:
        """Return a value on one line, short."""

    def checked(self, path: Path, value: object, check: Check[Value]) -> Value:
        """Check the value at the path, and return what the check makes of it. Raises InputError."""
        try:
            return check(value)
        except ValueError as error:
            within, part = _at_fault(error, value)
            where = (*path, *within)
            self.refuse(where, f"{self.named_value(where)} is {self.shown(part)}; it must be {error}")
        except InputError as error:
            self.refuse(path, str(error))


def dotted(path: Path) -> str:
    """Return the path as programs write it: domain.settings[0].sizes."""
    return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in path).removeprefix(".")


_LONGEST = 60
"""The most characters of a value that a message shows."""


@dataclass(frozen=True)
class TomlSource(Origin):
    """A file's name and its text; messages name tables as the file writes them, and tables of arrays by number."""

    title: str
    name: str
    text: str

    table_kind = "a table"

    @cached_property
    def lines(self) -> dict[Path, int]:
        """The line of each value; computed only for an error."""
        return toml.lines_of(self.text)

    def where(self, path: Path) -> str:
        """Return the file and the line."""
        line = toml.nearest_line(self.lines, path)
        return self.name if line is None else f"{self.name}, line {line}"

    def named(self, path: Path) -> str:
        """Return the table at a path: [mover], [flight].start, hyperboloid 3, [mover] part 1."""
        if not path:
            return self.title
        *outer, last = path
        if isinstance(last, int):
            *outer, key = outer
            return f"{f'{self.named((*outer,))} ' if outer else ''}{str(key).replace('_', ' ')} {last + 1}"
        return f"{self.named((*outer,))}.{last}" if outer else f"[{last}]"

    def named_value(self, path: Path) -> str:
        """Return the value at a path: its key, after the name of its table unless that is the whole file."""
        *outer, key = path
        return f"{self.named((*outer,))}: {key}" if outer else f"{key}"

    def shown(self, value: object) -> str:
        """Return a value, short, and written as in the file if possible."""
        shown = json.dumps(value, ensure_ascii=False, default=str).replace("NaN", "nan").replace("Infinity", "inf")
        return shown if len(shown) <= _LONGEST else shown[:_LONGEST] + "…"


class StrictTable:
    """A table at a path, which may have these keys."""

    def __init__(self, origin: Origin, path: Path, content: object, keys: Sequence[str]) -> None:
        self.origin, self._path = origin, path
        if not isinstance(content, Mapping):
            shown = origin.shown(content)
            self.refuse(f"{self.title} is {shown}; it must be {origin.table_kind} with {', '.join(keys)}")
        self._content: Mapping[str, Any] = content
        for key in content:
            if key not in keys:
                hint = suggestion(str(key), keys, most=1, otherwise="it may have")
                self.refuse(f"{self.title} has the key {origin.shown(key)}, which is not known; {hint}", key)

    @property
    def title(self) -> str:
        """The table, as messages name it."""
        return self.origin.named(self._path)

    def named(self, key: str) -> str:
        """Return the value of a key, as messages name it."""
        return self.origin.named_value((*self._path, key))

    def refuse(self, sentence: str, *keys: str | int) -> NoReturn:
        """Raise InputError about the table, or about a value in it."""
        self.origin.refuse((*self._path, *keys), sentence)

    def __len__(self) -> int:
        return len(self._content)

    def __iter__(self) -> Iterator[str]:
        return iter(self._content)

    def check(self, name: str, value: object, check: Check[Value]) -> Value:
        """Check a part of the table, and return what the check makes of it; messages use `name`. Raises InputError."""
        return self.origin.checked((*self._path, name), value, check)

    def required(self, key: str, check: Check[Value]) -> Value:
        """Check the value of a key that must be there, and return it. Raises InputError."""
        if key not in self._content:
            self.refuse(f"{self.title} has no {key}; it must be {_wanted(check)}")
        return self.check(key, self._content[key], check)

    def optional(self, key: str, check: Check[Value], default: Other) -> Value | Other:
        """Return the checked value of a key, or the default if it is absent."""
        return self.check(key, self._content[key], check) if key in self._content else default

    def present(self, checks: Mapping[str, Check[Any]]) -> dict[str, Any]:
        """Return the checked value of each key that is there and has a check, in the order of the table."""
        return {key: self.check(key, value, checks[key]) for key, value in self._content.items() if key in checks}

    def table(self, key: str, keys: Sequence[str]) -> StrictTable | None:
        """Return the table of that key; None if it is absent."""
        if key not in self._content:
            return None
        return StrictTable(self.origin, (*self._path, key), self._content[key], keys)

    def tables(
        self, key: str, keys: Sequence[str], wanted: str, *, least: int = 0, most: int | None = None
    ) -> list[StrictTable]:
        """Return the array of tables of that key, from `least` to `most` of them; empty if the key is absent.

        `wanted` says what the value must be.
        """
        if key not in self._content:
            return []
        array, path = self._content[key], (*self._path, key)
        if not isinstance(array, list) or len(array) < least:
            self.refuse(f"{self.named(key)} is {self.origin.shown(array)}; it must be {wanted}", key)
        if most is not None and len(array) > most:
            self.refuse(f"{self.title} has {len(array):,} tables {key}; a file may have {most:,} at most", key)
        return [StrictTable(self.origin, (*path, place), content, keys) for place, content in enumerate(array)]

    def required_table(self, key: str, keys: Sequence[str]) -> StrictTable:
        """Return the table of a key that must be there."""
        table = self.table(key, keys)
        if table is None:
            self.refuse(f"{self.title} has no {key}; it must be {self.origin.table_kind} with {', '.join(keys)}")
        return table


def _wanted(check: Check[Any]) -> str:
    """Return what a check requires: the text with which it refuses an impossible value."""
    try:
        check(object())
    except ValueError as error:
        return str(error)
    raise AssertionError("a check let nothing pass for something")


def table_of(text: str, name: str, title: str, keys: Sequence[str]) -> StrictTable:
    """Read the outermost table of a TOML text, which may have these keys.

    Messages name the file `name` and the table `title`. Raises InputError.
    """
    return StrictTable(TomlSource(title, name, text), (), toml.parsed(text, name), keys)


LONGEST_TEXT = 1000
"""The most characters of a text."""


def text(value: object) -> str:
    """Check that a value is a text that is not blank or too long, and return it. Raises ValueError."""
    if not isinstance(value, str) or not value.strip() or len(value) > LONGEST_TEXT:
        raise ValueError(f"a text that is not empty, of at most {LONGEST_TEXT:,} characters")
    return value


def one_of(*choices: str) -> Check[str]:
    """Return a check for one of these words."""
    wanted = choices[0] if len(choices) == 1 else f"one of {', '.join(choices)}"

    def check(value: object) -> str:
        if not isinstance(value, str) or value not in choices:
            raise ValueError(wanted)
        return value

    return check


def truth(value: object) -> bool:
    """Check that a value is true or false, and return it. Raises ValueError."""
    if not isinstance(value, bool):
        raise ValueError("true or false")  # noqa: TRY004 - turned into a sentence about the value
    return value


def list_with(wanted: str, least: int = 0, most: int | None = None) -> Check[list[Any]]:
    """Return a check for a list of `least` to `most` values; `wanted` ends the sentence of a refusal."""

    def check(value: object) -> list[Any]:
        if not isinstance(value, list) or len(value) < least or (most is not None and len(value) > most):
            raise ValueError(wanted)
        return value

    return check


def parts(values: Sequence[object], checks: Iterable[Check[Any]]) -> tuple[Any, ...]:
    """Check each value by its own check; return what the checks make of them. Raises PartError with the place."""
    checked = enumerate(zip(values, checks, strict=False))
    return tuple(_part(place, value, check) for place, (value, check) in checked)


def _part(place: int, value: object, check: Check[Value]) -> Value:
    """Check one value of several. Raises PartError with its place."""
    try:
        return check(value)
    except ValueError as error:
        within, part = _at_fault(error, value)
        raise PartError((place, *within), part, str(error)) from None


def list_of(check: Check[Value], wanted: str, least: int = 0, most: int | None = None) -> Check[tuple[Value, ...]]:
    """Return a check for a list of `least` to `most` values, each checked by `check`; `wanted` says what it must be."""
    listed = list_with(wanted, least, most)
    return lambda value: parts(listed(value), repeat(check))


def texts(wanted: str, *, least: int = 1) -> Check[tuple[str, ...]]:
    """Return a check for a list of `least` texts or more, none empty; `wanted` ends the sentence of a refusal."""
    listed = list_with(wanted, least)

    def check(value: object) -> tuple[str, ...]:
        values = listed(value)
        if not all(isinstance(part, str) and part for part in values):
            raise ValueError(wanted)
        return tuple(values)

    return check


def integer(value: object) -> int:
    """Return the value, checked to be a whole number from 0 to 2³¹ − 1. Raises ValueError."""
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 2**31:
        raise ValueError("a whole number, 0 or more and below 2^31")
    return value


def number_of(value: object, wanted: str, *, infinite: bool = False) -> float:
    """Return the number, as float64. Raises ValueError with the text `wanted` if it is not a number or not finite."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(wanted)  # noqa: TRY004 - turned into a sentence about the value
    try:
        result = float(value) + 0.0  # + 0.0 turns −0.0 into 0.0
    except OverflowError:
        raise ValueError(f"{wanted} that float64 holds") from None
    if math.isnan(result) or (math.isinf(result) and not infinite):
        raise ValueError(wanted)
    return result


def number_with(
    wanted: str, low: float = -math.inf, high: float = math.inf, *, above: bool = False, infinite: bool = False
) -> Check[float]:
    """Return a check for a number from `low` to `high`, not `low` itself if `above`; `wanted` ends a refusal."""

    def check(value: object) -> float:
        result = number_of(value, wanted, infinite=infinite)
        if not low <= result <= high or (above and result == low):
            raise ValueError(wanted)
        return result

    return check


number = number_with("a finite number")
positive = number_with("a finite number above 0", 0, above=True)
"""A check for the length of a body."""

not_negative = number_with("a finite number, 0 or more", 0)
"""A check for a distance."""


def numbers_of(value: object, count: int, wanted: str, *, infinite: bool = False) -> tuple[float, ...]:
    """Check that a value is a list of `count` numbers, and return them as float64. Raises ValueError with `wanted`."""
    return tuple(number_of(part, wanted, infinite=infinite) for part in list_with(wanted, count, count)(value))


def point(value: object, wanted: str = "three finite numbers, [x, y, z]") -> tuple[float, float, float]:
    """Check that a value is three finite numbers, and return them. Raises ValueError."""
    x, y, z = numbers_of(value, 3, wanted)
    return x, y, z


def direction(value: object) -> tuple[float, float, float]:
    """Check that a value is a vector that is not 0, and return it. Raises ValueError."""
    wanted = "three finite numbers, [x, y, z], not all 0"
    vector = point(value, wanted)
    if not any(vector):
        raise ValueError(wanted)
    return vector


def or_word(word: Other, check: Check[Value]) -> Check[Value | Other]:
    """Return a check that accepts one word, or any value that the other check accepts."""

    def with_word(value: object) -> Value | Other:
        if value == word:
            return word
        try:
            return check(value)
        except ValueError as error:
            raise ValueError(f'{error}, or "{word}"') from None

    return with_word
