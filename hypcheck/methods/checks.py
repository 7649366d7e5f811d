"""Checks of foreign values that a description and a domain share: each returns the value or raises InputError."""

from __future__ import annotations

from hypcheck.errors import InputError
from hypcheck.visible import visible


def shown(value: object) -> str:
    """The value as a message shows it."""
    return visible(repr(value), 80)


def two_numbers(value: object, where: str) -> tuple[float, float]:
    """The least and the greatest of a range."""
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise InputError(f"{where} is {shown(value)}; it must be two numbers, the least and the greatest")
    low, high = (number(each, where) for each in value)
    return low, high


def number(value: object, where: str) -> float:
    """A number of float64; whole numbers are numbers, truth values are none."""
    try:
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return float(value)
    except OverflowError:
        pass
    raise InputError(f"{where} holds {shown(value)}; it must be two numbers of float64")
