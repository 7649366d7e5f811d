"""Whole numbers as a person writes them on the command line: in digits, or large ones as 1e9, 2.5e6 or 1_000_000."""

from __future__ import annotations

import re
from typing import Any

import click

from hypcheck.tables.numbers import shown

LARGEST_SEED = 2**63 - 1

LARGEST_COUNT = 10**15
"""More than anybody can wait for."""

MOST_PROCESSES = 1024
"""More would only take each other's time, and the system's memory."""

_WHOLE = re.compile(r"\d{1,20}(_\d{1,20}){0,9}(\.\d{1,20})?([eE]\+?\d{1,2})?", re.ASCII)
"""Of few digits, and with a small exponent: the number itself has as many digits as that says."""


class Whole(click.types.IntParamType):
    """A whole number from `least` to `greatest`."""

    def __init__(self, least: int, greatest: int = LARGEST_COUNT) -> None:
        self.least = least
        self.greatest = greatest

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:  # noqa: ANN401 - click's
        """The number. Raises click.BadParameter."""
        number = whole_of(str(value))
        if number is None or not self.least <= number <= self.greatest:
            self.fail(f"{shown(str(value))} must be {wanted(self.least, self.greatest)}.", param, ctx)
        return number


def whole_of(text: str) -> int | None:
    """The whole number that a text writes, exactly; None where it writes none."""
    from fractions import Fraction

    if not _WHOLE.fullmatch(text):
        return None
    number = Fraction(text.replace("_", ""))
    return number.numerator if number.denominator == 1 else None


def wanted(least: int, greatest: int) -> str:
    """What a number must be, for the end of a sentence."""
    digits = str(greatest)
    power = len(digits) > 6 and not digits[1:].strip("0") and digits[0] == "1"
    return f"a whole number, at least {least} and at most {f'1e{len(digits) - 1}' if power else digits}"
