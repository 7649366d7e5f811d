"""Types of the fields of a record's lines, and how a line is decoded from JSON and encoded again."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Protocol, TypeVar

import numpy as np
from msgspec import UNSET, Meta, Struct, UnsetType, ValidationError, convert, to_builtins
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS
from hypcheck.geometry.rows import PAIRS, SWEEPS, Layout
from hypcheck.messages import shortened

FARTHEST = 9999
"""The greatest distance of a bin's number from 0.

The number is the floor of log2 of a float64, of a ratio of two, or of a product of a few, which is always nearer to 0.
"""

_OCTAVE = re.compile(r"-?\d{1,4}|-?inf", re.ASCII)
_HEX = r"-?0x[01](\.[0-9a-f]+)?p[+-][0-9]+"


class Extended(float):
    """A float that may be infinite; JSON holds an infinity as the string "inf" or "-inf"."""


class Unsigned(Extended):
    """An Extended that is not negative."""


class Histogram:
    """Counts by bin: `table` (n, 4) is ascending; a row has the bin's two numbers, its cases, and those not right.

    JSON holds a list of its rows. It is no dataclass, since msgspec takes those for JSON objects.
    """

    def __init__(self, table: NDArray[np.int64] | None = None) -> None:
        self.table = np.empty((0, 4), dtype=np.int64) if table is None else table

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Histogram) and np.array_equal(self.table, other.table)

    __hash__ = None  # type: ignore[assignment]  # arrays can change

    def as_lists(self) -> list[list[int]]:
        """Return the rows [first, second, cases, not right] as the record has them."""
        lists: list[list[int]] = self.table.tolist()
        return lists

    @classmethod
    def of_lists(cls, lists: list[list[int]]) -> Histogram:
        """Make a histogram of such rows."""
        return cls(np.array(lists, dtype=np.int64).reshape(-1, 4))


Kind = TypeVar("Kind")


def decoded(value: object, kind: type[Kind]) -> Kind:
    """Decode a value of that kind from dicts, lists, texts and numbers, or from the attributes of an object.

    Raises msgspec.ValidationError.
    """
    try:
        return convert(value, kind, dec_hook=_custom, from_attributes=True)
    except UnicodeEncodeError:  # msgspec compares texts in UTF-8
        raise ValidationError("a text has half of a character, a lone surrogate") from None


def as_json(value: LinePart) -> Any:  # noqa: ANN401 - whatever JSON holds
    """Encode a line or a part of one for JSON, infinities as texts."""
    return plain(to_builtins(value, enc_hook=_builtin))


def plain(value: Any) -> Any:  # noqa: ANN401  any value that a line holds
    """Convert a value for JSON: infinities become the strings "inf" and "-inf", also inside mappings and sequences."""
    if value is None or isinstance(value, (int, str)):  # most values: an abstract class is slow to ask
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    return [plain(item) for item in value]


def _custom(kind: type, value: object) -> object:
    """Decode a value of a type that JSON does not have. Raises ValueError, to which msgspec adds the path."""
    if kind is Histogram:
        try:
            bins = convert(value, list[SmallBin])
        except ValidationError as error:
            raise ValueError(str(error)) from None
        require_possible("", bins)
        return Histogram.of_lists(bins)
    if not issubclass(kind, Extended):
        raise TypeError(f"no field of a line has the type {kind.__name__}")
    least = "" if kind is Unsigned else ', "-inf"'
    if value not in ("inf", "-inf") and (isinstance(value, bool) or not isinstance(value, (int, float))):
        raise ValueError(f'Expected `float`{least} or "inf"')
    number = kind(value)
    if kind is Unsigned and not number >= 0:
        raise ValueError('Expected `float` >= 0 or "inf"')
    return number


def _builtin(value: object) -> object:
    """Encode a value of a type that JSON does not have."""
    if isinstance(value, Histogram):
        return value.as_lists()
    if not isinstance(value, float):
        raise TypeError(f"no line has a {type(value).__name__}")
    return float(value)


def one_of(*names: str) -> Meta:
    """Make the constraint that a text is one of these names."""
    return Meta(pattern=f"^({'|'.join(names)})$", extra_json_schema={"enum": list(names)})


Count = Annotated[int, Meta(ge=0)]
Counts = dict[str, Count]
Amount = Annotated[float, Meta(ge=0)]
"""A time, a size, a ratio of times."""
Share = Annotated[float, Meta(ge=0, le=1)]

Interval = tuple[float, float]
Sizes = tuple[float, float, float, float]
"""α, γ, b, d."""

Limits = tuple[Unsigned, Unsigned] | None
"""The least and the greatest; None: not declared."""

Span = tuple[Extended, Extended] | None
_Finite = Annotated[str, Meta(pattern=f"^{_HEX}$")]
_Any = Annotated[str, Meta(pattern=f"^({_HEX}|-?inf|nan)$")]
_SEVEN, _THREE = Meta(min_length=7, max_length=7), Meta(min_length=3, max_length=3)

Row = Annotated[tuple[_Finite, ...], _SEVEN]
"""α, γ, b, d, x, y, z as hexadecimal floats, which read back exactly."""

Centre = Annotated[tuple[_Finite, ...], _THREE]
"""x, y, z of the end of a sweep; the row has the centre at its start."""

Axis = Annotated[tuple[_Finite, ...], _THREE]
"""axis_x, axis_y, axis_z of a row of ten numbers; `row` has the other seven."""

Heights = Annotated[tuple[_Any, ...], _THREE]
"""z_min, z_max, solid of a row about a hyperboloid that ends; the first two may be infinite."""

InvalidRow = Annotated[tuple[_Any, ...], _SEVEN]
"""Like a row, but NaN and infinities are allowed: rows that must be refused."""

InvalidCentre = Annotated[tuple[_Any, ...], _THREE]
InvalidAxis = Annotated[tuple[_Any, ...], _THREE]

Bin = Annotated[list[int], Meta(min_length=4, max_length=4)]
"""The two numbers of a bin, its cases, and how many of them did not end as right."""

SmallBin = Annotated[list[Annotated[int, Meta(ge=-(1 << 60), le=1 << 60)]], Meta(min_length=4, max_length=4)]
"""A Bin of numbers that fit into int64."""

Truth = Annotated[int, Meta(ge=-1, le=1)]
TruthKey = Annotated[str, one_of("-1", "0", "1")]
AnswerKey = Annotated[str, one_of("-1", "0", "1", "2", "none")]
"""The truth about a row, and the given answer, as numbers of the protocol; "none" if no valid answer was given."""

Question = Annotated[str, one_of("position", "exterior", "interior", "contact", "passage")]
Precision = Annotated[str, one_of("float16", "bfloat16", "float32", "float64", "x87", "binary128", "exact")]
Mistake = Annotated[str, one_of("false-clear", "false-contact", "wrong-side", "late", "early")]


class LinePart(Struct, frozen=True, kw_only=True):
    """A value within a line."""


def _type_of(name: str) -> str:
    """Return the type of a line, from the name of its struct: speed for SpeedLine."""
    return name.removesuffix("Line").lower()


class _CasePart(Protocol):
    @property
    def row(self) -> tuple[str, ...]: ...
    @property
    def end(self) -> tuple[str, ...] | UnsetType: ...
    @property
    def axis(self) -> tuple[str, ...] | UnsetType: ...
    @property
    def heights(self) -> tuple[str, ...] | UnsetType: ...


def numbers_of(case: _CasePart) -> tuple[str, ...]:
    """Return all numbers of a case's row: of the position, the end of a sweep, the axis if tilted, and the heights."""
    return (*case.row, *(case.end or ()), *(case.axis or ()), *(case.heights or ()))


def row_of(case: _CasePart) -> tuple[float, ...]:
    """Return all numbers of a case's row as floats."""
    return tuple(map(float.fromhex, numbers_of(case)))


def row_fields(row: Sequence[float], layout: Layout = PAIRS) -> dict[str, Any]:
    """Return the fields row, end, axis and heights of a row of this layout."""
    others, axis, heights = layout.split(tuple(value.hex() for value in row))
    parts = {"end": others[len(COLUMNS) :], "axis": axis, "heights": heights}
    return {"row": others[: len(COLUMNS)]} | {name: part or UNSET for name, part in parts.items()}


def row_parts(case: _CasePart) -> dict[str, Any]:
    """Return the fields row, end, axis and heights of a case, for another struct about it."""
    return {"row": case.row, "end": case.end, "axis": case.axis, "heights": case.heights}


def layout_of(case: _CasePart) -> Layout:
    """Return the layout of a case's row: that of a sweep if it has an end."""
    return SWEEPS if case.end else PAIRS


class RecordLine(LinePart, frozen=True, kw_only=True, tag_field="type", tag=_type_of):
    """A line of a record; its first field is its type."""

    @property
    def type(self) -> str:
        """The type of the line."""
        return str(self.__struct_config__.tag)


def require_possible(name: str, bins: Sequence[Bin]) -> None:
    """Raise ValueError if a bin lies beyond FARTHEST, or has more wrong answers than cases."""
    for number, (across, up, cases, wrong) in enumerate(bins):
        require_places((across, up), f"{name}[{number}]")
        require_counts(cases, wrong, f"{name}[{number}]")


def require_places(places: Sequence[int], where: str) -> None:
    """Raise ValueError if one of these numbers is farther than FARTHEST from 0; `where` names what has them."""
    for place in places:
        if abs(place) > FARTHEST:
            shown = shortened(str(place), 20)
            raise ValueError(f"{where} is at {shown}; it must be between −{FARTHEST} and {FARTHEST}")


def require_counts(cases: int, wrong: int, where: str) -> None:
    """Raise ValueError if there are more wrong answers than cases; `where` names what has them."""
    if not 0 <= wrong <= cases:
        few, many = shortened(str(wrong), 20), shortened(str(cases), 20)
        raise ValueError(f"{where} has {few} wrong answers of {many}")


def require_octaves(octaves: Mapping[str, object]) -> None:
    """Raise ValueError if a key is not an octave: a floor of log2, or an infinity."""
    for octave in octaves:
        if not _OCTAVE.fullmatch(octave):
            shown = shortened(repr(octave), 20)
            raise ValueError(f"octaves has {shown}, which is neither a small whole number nor inf or -inf")
