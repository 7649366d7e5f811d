"""What options of several commands are read as."""

from __future__ import annotations

import math
from typing import Any

import click

from hypcheck.errors import InputError
from hypcheck.tables.numbers import is_number


class FiniteRange(click.FloatRange):
    """A number within a range that is one: click takes nan for a number of every range, and inf for one of some."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:  # noqa: ANN401 - click's
        """The number. Raises click.BadParameter."""
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{number} is not a finite number.", param, ctx)
        return number


_SUFFIXES = {"K": 10, "M": 20, "G": 30, "T": 40}


def bytes_of(text: str) -> int:
    """A size such as 4G, 512M or 1000000 in bytes. Raises InputError."""
    known = text[-1:].upper() in _SUFFIXES
    number, exponent = (text[:-1], _SUFFIXES[text[-1].upper()]) if known else (text, 0)
    size = float(number) * 2**exponent if is_number(number) else math.inf
    if math.isinf(size):
        raise InputError(f"--memory is {text!r}; it must be a size such as 512M or 4G")
    return int(size)
