"""Numbers, lists and rows as a person reads them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from hypcheck.errors import InputError
from hypcheck.pairs import COLUMNS
from hypcheck.visible import counted

__all__ = ["classify_command", "counted", "figure", "from_hex", "listed", "short_row", "with_interval"]


def listed(items: Sequence[str], last: str = "and") -> str:
    """The items as a sentence has them: "a, b and c"."""
    return f" {last} ".join(part for part in (", ".join(items[:-1]), *items[-1:]) if part)


def figure(value: float) -> str:
    """A measured value to three digits: 0, 0.8, 12.3, 4,820, 3.1e7, ∞."""
    if math.isinf(value):
        return "∞"
    if value == 0:
        return "0"
    if 1e-3 <= abs(value) < 999.5:
        return f"{value:.3g}"
    if 999.5 <= abs(value) < 1e6:
        return f"{float(f'{value:.3g}'):,.0f}"
    mantissa, _, exponent = f"{value:.1e}".partition("e")
    return f"{mantissa}e{int(exponent)}"


def with_interval(value: float, interval: Sequence[float] | None) -> str:
    """A value with the ends of its interval, where it has one: "1.2 (1.1 to 1.3)"."""
    return figure(value) if interval is None else f"{figure(value)} ({' to '.join(map(figure, interval))})"


def from_hex(row: Sequence[str]) -> tuple[float, ...]:
    """The seven numbers of a row as a record keeps it. Raises InputError where one is beyond float64."""
    try:
        return tuple(float.fromhex(value) for value in row)
    except OverflowError:
        raise InputError(f"the record has a number that is too large for float64 in the row {', '.join(row)}") from None


def short_row(row: Sequence[float]) -> str:
    """A row to six digits, enough to see what is meant: "alpha 2, gamma 17.8, b 0.25, d 0.15, centre (3, 0, 0)"."""
    sizes = ", ".join(f"{name} {value:.6g}" for name, value in zip(COLUMNS[:4], row[:4], strict=True))
    return f"{sizes}, centre ({', '.join(f'{value:.6g}' for value in row[4:])})"


def classify_command(row: Sequence[float]) -> str:
    """The command that decides a row exactly and proves it; the decimals read back as the same float64."""
    sizes = " ".join(f"--{name} {value!r}" for name, value in zip(COLUMNS[:4], row[:4], strict=True))
    return f"hypcheck classify {sizes} --center {' '.join(map(repr, row[4:]))}"
