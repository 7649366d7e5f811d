"""One number from a person's text or a JSON value, by the same rules on the command line and in every table.

A number is decimal: an optional sign, ASCII digits with an optional point, an optional exponent, blanks around it. It
is rounded to the nearest float64, as every reader of decimals does. Python's float() takes more ("1_000", digits of
other scripts, "infinity"); none of that is a number here.
"""

from __future__ import annotations

import json
import re

from hypcheck.pairs import SIZES, trouble_with
from hypcheck.visible import visible

CHARACTERS = b"0123456789+-.eE \t"
"""All that a number is written with: text of these alone that float() accepts is a number by the rules above."""

LONGEST_SHOWN = 40
_DECIMAL = re.compile(r"[ \t]*[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?[ \t]*", re.ASCII)
"""Of digits in one group alone, or the time to refuse them would grow with the square of their number."""
_NOT_ZERO = re.compile(r"^[^eE]*[1-9]")
"""A digit other than 0 before the exponent."""
_UNBOUNDED = re.compile(r"\s*[+-]?(nan|inf|infinity)\s*", re.ASCII | re.IGNORECASE)


def number_of_text(name: str, text: str) -> float:
    """The float64 nearest to `text`, valid in column `name`. Raises ValueError, the end of a sentence that says why."""
    if not text.strip():
        raise ValueError(f"{name} is empty; it must be a number")
    if _UNBOUNDED.fullmatch(text):
        raise ValueError(f"{name} is {shown(text)}; it must be finite")
    if not is_number(text):
        raise ValueError(f"{name} is {shown(text)}; it must be a decimal number such as 2.5 or -1e-3")
    return _valid(name, float(text), shown(text.strip(" \t"), quoted=False))


def is_number(text: str) -> bool:
    """Whether `text` is written as a number, of whatever value."""
    return _DECIMAL.fullmatch(text) is not None


class Literal(float):
    """A JSON number that remembers its text: 1e999 is not to be called inf in a message."""

    text: str

    def __new__(cls, text: str) -> Literal:
        """The float64 nearest to `text`."""
        number = super().__new__(cls, text)
        number.text = text
        return number


def number_of_json(name: str, value: object) -> float:
    """The float64 nearest to a JSON number (Literal, float or int), as number_of_text. Raises ValueError."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"{name} is {shown_json(value)}; it must be a number")  # noqa: TRY004 - the value is at fault
    try:
        number = float(value)
    except OverflowError:
        number = float("inf")
    return _valid(name, number, shown_json(value))


def _valid(name: str, number: float, text: str) -> float:
    if abs(number) == float("inf"):
        raise ValueError(f"{name} is {text}, which is too large for float64")
    if number == 0 and name in SIZES and _NOT_ZERO.search(text):
        raise ValueError(f"{name} is {text}, which is too small for float64; it must be greater than 0")
    trouble = trouble_with(name, number)
    if trouble is not None:
        asked = trouble.partition("; ")[2]
        raise ValueError(f"{name} is {text}; {asked}")
    return number


def shown(text: str, *, quoted: bool = True) -> str:
    """`text` as a message shows it: on one line, quoted, and cut where it is long."""
    cut = text if len(text) <= LONGEST_SHOWN else text[:LONGEST_SHOWN] + "…"
    return repr(cut) if quoted else visible(cut)


def shown_json(value: object) -> str:
    """A JSON value as a message shows it: as JSON writes it, cut where it is long."""
    text = value.text if isinstance(value, Literal) else json.dumps(value, ensure_ascii=False, default=repr)
    return shown(text, quoted=False)
