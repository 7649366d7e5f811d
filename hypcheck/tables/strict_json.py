"""JSON read strictly: a key stands once, every number is finite JSON, and an object has the members it may have.

Python's own reader takes the last of two equal keys and accepts NaN, and readers disagree about both.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NoReturn

from hypcheck.errors import InputError
from hypcheck.tables.columns import first_double
from hypcheck.tables.numbers import shown, shown_json

_LONGEST_INTEGER = 400
"""Digits of what is still made an int; more are beyond float64 anyway, and Python refuses to convert some of them."""


def refused_constant(text: str) -> NoReturn:
    """Raise ValueError, the end of a sentence, for NaN and the infinities."""
    raise ValueError(f"{text} is not JSON; every number must be finite")


def strict_decoder(
    number: Callable[[str], float] | None = None, constant: Callable[[str], float] = refused_constant
) -> json.JSONDecoder:
    """A decoder that raises ValueError, the end of a sentence, on what is not strict JSON.

    `number`, where given, makes a number of its text, but for integers of ordinary length; `constant` one of NaN,
    Infinity and -Infinity.
    """
    if number is None:
        return json.JSONDecoder(object_pairs_hook=_members, parse_constant=constant)

    def integer(text: str) -> float:
        return int(text) if len(text) <= _LONGEST_INTEGER else number(text)

    return json.JSONDecoder(object_pairs_hook=_members, parse_constant=constant, parse_float=number, parse_int=integer)


def _members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) < len(pairs):
        raise ValueError(f"key {first_double([name for name, _ in pairs])}")
    return members


def object_of(
    value: object, what: str, names: Sequence[str], required: Sequence[str] | None = None
) -> Mapping[str, Any]:
    """The value, once it is known to be an object with `required` members (None: all of `names`) and no others.

    Raises InputError, beginning with `what`.
    """
    if not isinstance(value, Mapping):
        raise InputError(f"{what} is {shown_json(value)}; it must be an object with {', '.join(names)}")
    unknown = [name for name in value if name not in names]
    if unknown:
        raise InputError(f"{what} has the key {shown(str(unknown[0]))}; it may have {', '.join(names)}")
    missing = [name for name in (names if required is None else required) if name not in value]
    if missing:
        raise InputError(f"{what} lacks {missing[0]}")
    return value
