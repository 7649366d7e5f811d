"""The description of an implementation: name, precision, question, and the domain where it claims to be right.

Rows outside the domain are skipped, not judged. Descriptions come from foreign code as JSON; an unknown key or a wrong
value raises InputError, which names the key, the value, and what would be right.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.geometry.pair import AXIS, CENTER, GROUPS, HEIGHTS, SIZES, trouble_with
from hypcheck.geometry.rows import (
    ORDINARY_MAGNITUDE,
    ORDINARY_RATIO,
    PAIRS,
    UNBOUNDED,
    WAYS,
    FixedSizes,
    Layout,
    Mask,
    Range,
    Rows,
    within,
)
from hypcheck.messages import escaped
from hypcheck.tables.strict_json import object_of, refused_constant, strict_decoder


@dataclass(frozen=True, slots=True)
class Question:
    """A question to an implementation: its name, its answers besides CANNOT_SAY, and the columns of its rows.

    `entry` is what a library's function is called after: hypcheck_ENTRY and hypcheck_ENTRY_tilted. `forms` stand before
    "text" and "binary" in the protocol of commands, for upright and for tilted spheroids. `times` says that a time may
    go with each answer 1.
    """

    name: str
    answers: tuple[int, ...] = (0, 1)
    layout: Layout = PAIRS
    entry: str = "classify"
    forms: tuple[str, str] = ("", "tilted-")
    times: bool = False


QUESTIONS: Mapping[str, Question] = MappingProxyType(
    {
        each.name: each
        for each in (
            Question("position", (-1, 0, 1)),
            Question("exterior"),
            Question("interior"),
            Question("contact"),
            Question("passage", layout=WAYS, entry="passage", forms=("passage-", "passage-"), times=True),
        )
    }
)
"""The position itself, whether it is one of the three, and whether there is contact on the way between two."""

UNIT_ROUNDOFF = {
    "float16": Fraction(1, 2**11),
    "bfloat16": Fraction(1, 2**8),
    "float32": Fraction(1, 2**24),
    "float64": Fraction(1, 2**53),
    "x87": Fraction(1, 2**64),
    "binary128": Fraction(1, 2**113),
    "exact": Fraction(0),
}
"""The unit u of each precision that an implementation can declare: half the distance from 1 to the next number."""

PRECISIONS = tuple(UNIT_ROUNDOFF)


REGIMES = ("a>=1", "c2>=a")
"""The hypotheses of the paper: α/b ≥ 1, and (γ/d)² ≥ α/b."""

NORMAL_RANGE: dict[str, Range] = {
    "float16": (2.0**-14, 65504.0),
    "bfloat16": (2.0**-126, (2 - 2.0**-7) * 2.0**127),
    "float32": (2.0**-126, (2 - 2.0**-23) * 2.0**127),
    "float64": (2.0**-1022, float(np.finfo(np.float64).max)),
}
"""The least and the greatest normal number of each format; wider formats hold every float64 as a normal number."""


_CORNERS = np.array([(*sizes, *[center] * 9) for *sizes, center in product((0, 1), repeat=5)])
"""Least or greatest, of four sizes and of all other numbers: of centres and of the axis."""


@dataclass(frozen=True, slots=True)
class Domain:
    """The rows that a method claims: all `regimes` hold, α/b and γ/d lie in `ratio`, lengths in `magnitude`.

    Bounds are inclusive, as in rows.within. None is a range that was not declared: the ordinary range, or for extreme
    families an unbounded one. `settings` are the only allowed sizes, each with the ranges of its centre; a range that
    was not declared is then unbounded. Raises InputError if a regime is unknown or a range is empty.
    """

    regimes: tuple[str, ...] = ()
    ratio: Range | None = None
    magnitude: Range | None = None
    settings: tuple[FixedSizes, ...] = ()

    def __post_init__(self) -> None:
        for regime in self.regimes:
            if regime not in REGIMES:
                raise InputError(f"the domain names the regime {regime!r}; it must be one of {', '.join(REGIMES)}")
        for name, limits in (("ratio", self.ratio), ("magnitude", self.magnitude)):
            if limits is not None and not 0 <= limits[0] <= limits[1]:
                shown = f"[{limits[0]}, {limits[1]}]"
                raise InputError(f"the domain's {name} is {shown}; it must be two numbers with 0 ≤ low ≤ high")

    def holds(self, rows: Rows, *, extreme: bool = False, layout: Layout = PAIRS) -> Mask:
        """A mask (n,) of the rows inside the domain.

        `extreme` rows belong to a family that is asked only on request; then ranges that were not declared are
        unbounded.
        """
        unbounded = extreme or self.settings
        ratio, magnitude = (UNBOUNDED, UNBOUNDED) if unbounded else (ORDINARY_RATIO, ORDINARY_MAGNITUDE)
        inside = within(rows, self.ratio or ratio, self.magnitude or magnitude, layout)
        for regime in self.regimes:
            inside &= in_regime(rows, regime)
        if self.settings:
            inside &= np.logical_or.reduce([setting.holds(rows, layout) for setting in self.settings])
        return inside


ORDINARY, EVERYWHERE = Domain(), Domain(ratio=UNBOUNDED, magnitude=UNBOUNDED)


def in_regime(rows: Rows, regime: str) -> Mask:
    """A mask (n,) of the rows in a regime of REGIMES, decided exactly."""
    alpha, gamma, b, d = rows[:, :4].T
    if regime == "a>=1":
        return np.asarray(alpha >= b)
    with np.errstate(all="ignore"):
        left, right = (gamma / d) ** 2, alpha / b
        # At most 4 roundings between the two sides, if nothing under- or overflows: beyond 16u floats decide.
        trusted = (left > 2.0**-900) & (left < 2.0**900) & (right > 2.0**-900) & (right < 2.0**900)
        margin = 1 + 16 * 2.0**-53
        holds, fails = trusted & (left > margin * right), trusted & (right > margin * left)
    for index in np.flatnonzero(~(holds | fails)):
        sizes = [Fraction(value) for value in rows[index, :4].tolist()]
        holds[index] = (sizes[1] / sizes[3]) ** 2 >= sizes[0] / sizes[2]
    return np.asarray(holds)


def representable(rows: Rows, precision: str, *, subnormal: bool = False) -> Mask:
    """A mask (n,) of the rows in which every number is zero or normal in the declared precision.

    With `subnormal` also of those with subnormal numbers, if the precision holds these exactly.
    """
    limits = NORMAL_RANGE.get(precision)
    if limits is None:
        return np.ones(len(rows), dtype=bool)
    lengths, (least, greatest) = np.abs(rows), limits
    held = ((lengths >= least) & (lengths <= greatest)) | (rows == 0)
    if subnormal:
        step = least * float(2 * UNIT_ROUNDOFF[precision])  # 2u is the distance from 1 to the next number
        held |= (lengths < least) & (np.fmod(lengths, step) == 0)
    return np.asarray(held.all(axis=1))


def claimed(
    rows: Rows,
    domain: Domain,
    precision: str,
    *,
    extreme: bool = False,
    subnormal: bool = False,
    layout: Layout = PAIRS,
) -> NDArray[np.intp]:
    """The ascending indices of the rows that lie in the domain and are representable in the declared precision.

    `extreme` is as in Domain.holds, `subnormal` as in representable.
    """
    with np.errstate(all="ignore"):
        if not domain.settings:
            corners = _corners(rows)
            if (domain.holds(corners, extreme=extreme, layout=layout) & representable(corners, precision)).all():
                return np.arange(len(rows))
        inside = domain.holds(rows, extreme=extreme, layout=layout)
        return np.flatnonzero(inside & representable(rows, precision, subnormal=subnormal))


def _corners(rows: Rows) -> Rows:
    """Rows (32, their columns) of the extremes of |rows|: all combinations of sizes, least and greatest of the others.

    Each condition of a domain except its settings is monotone in each length. So is the range of a precision, except
    for zero, which is always representable. Hence a condition that holds for these rows holds for all.
    """
    lengths = np.abs(rows.T)
    least, greatest = lengths.min(axis=1, initial=np.inf), lengths.max(axis=1, initial=0.0)
    for index in np.flatnonzero(least == 0):
        least[index] = lengths[index][lengths[index] > 0].min(initial=greatest[index])
    columns = rows.shape[1]
    return np.asarray(np.stack([least, greatest])[_CORNERS[:, :columns], np.arange(columns)])


PROTOCOL = 1
LONGEST = 1 << 16
"""The most bytes of a description."""


@dataclass(frozen=True, slots=True)
class Description:
    """An implementation's description of itself.

    `domain` is where it claims to be right. `refuses` says that it answers invalid rows with 127. `binary` and `time`
    say what a command offers of the protocol. `tilt` says that rows have the spheroid's axis after the other numbers,
    `heights` that they have the heights between which the hyperboloid ends, at last. `times` says that a time goes with
    each answer 1.
    """

    name: str
    version: str = ""
    language: str = ""
    precision: str = "float64"
    question: str = "position"
    domain: Domain = ORDINARY
    refuses: bool = False
    binary: bool = False
    time: bool = False
    tilt: bool = False
    times: bool = False
    heights: bool = False

    def __post_init__(self) -> None:
        if not self.tilt and any(setting.axis is not None for setting in self.domain.settings):
            raise InputError('the domain\'s settings name an axis; the description must say "tilt": true then')

    @property
    def asked(self) -> Question:
        """The question."""
        return QUESTIONS[self.question]

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns of the rows that it is asked."""
        layout = self.asked.layout
        return (layout.tilted if self.tilt else layout.upright) + (HEIGHTS if self.heights else ())

    def overridden(
        self, precision: str | None = None, question: str | None = None, domain: Domain | None = None
    ) -> Description:
        """The description with values of the caller; raises InputError if there is no such precision or question.

        It also raises that if the question is about other rows than those that the description declares.
        """
        found = replace(
            self,
            precision=self.precision if precision is None else _one_of(PRECISIONS)(precision, "the precision"),
            question=self.question if question is None else _one_of(QUESTIONS)(question, "the question"),
            domain=domain or self.domain,
        )
        if found.asked.layout != self.asked.layout:
            raise InputError(
                f"the question is {found.question!r}, but {self.name} describes itself as answering {self.question!r}, "
                f'about other rows; its description must say "question": "{found.question}"'
            )
        return found


def described(raw: object, defaults: Description, required: tuple[str, ...] = ()) -> Description:
    """The description in a mapping, completed from `defaults`; raises InputError naming key and value."""
    found = object_of(raw, "the description", tuple(_KEYS), required)
    values: dict[str, Any] = {key: _KEYS[key](value, f"the description's {key}") for key, value in found.items()}
    values.pop("protocol", None)
    taken = values.pop("takes", ())
    if "axis" in taken and values.get("tilt") is False:
        raise InputError("the description takes an axis, but its tilt is false; leave tilt out, or make it true")
    values |= {name: True for name, group in (("tilt", "axis"), ("heights", "heights")) if group in taken}
    description = replace(defaults, **values)
    if "end" in taken and description.asked.layout is not WAYS:
        raise InputError(
            f"the description takes an end, but its question is {description.question!r}; the end of a straight motion "
            'belongs to the question "passage"'
        )
    if description.times and not description.asked.times:
        with_times = " or ".join(name for name, question in QUESTIONS.items() if question.times)
        raise InputError(
            f"the description's times is true, but its question is {description.question!r}; times belong to the "
            f"question {with_times}"
        )
    return description


def described_by_json(text: str | bytes, defaults: Description, required: tuple[str, ...] = ()) -> Description:
    """The description in a JSON text; raises InputError."""
    return described(_json(text, "the description"), defaults, required)


def parse_domain(text: str) -> Domain:
    """The domain in a JSON text of the command line; raises InputError."""
    return domain_of(_json(text, "the domain"), "the domain")


def _unbounded(text: str) -> float:
    """Infinity, which Python and TOML write for the end of an unbounded range; raises ValueError on NaN."""
    return refused_constant(text) if text == "NaN" else float(text)


_STRICT = strict_decoder(constant=_unbounded)


def _json(text: str | bytes, where: str) -> object:
    if len(text) > LONGEST:
        raise InputError(f"{where} is longer than {LONGEST} bytes")
    try:
        return _STRICT.decode(text if isinstance(text, str) else text.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        unreadable = isinstance(error, UnicodeError | RecursionError)
        why = "it cannot be read" if unreadable else escaped(f"{error}", 120)
        shown = text if isinstance(text, str) else text.decode("utf-8", "replace")
        raise InputError(f"{where} is '{escaped(shown, 80)}'; it must be JSON ({why})") from None


def _wrong(value: object, where: str, wanted: str) -> InputError:
    """The error about a value: `where` it stands, what it is, and what it must be."""
    return InputError(f"{where} is {_shown(value)}; it must be {wanted}")


def _shown(value: object) -> str:
    return escaped(repr(value), 80)


def _checked(holds: Callable[[Any], bool], wanted: str) -> Callable[[object, str], Any]:
    """A reader of values for which that holds."""

    def read(value: object, where: str) -> object:
        if not holds(value):
            raise _wrong(value, where, wanted)
        return value

    return read


def _one_of(choices: Collection[str]) -> Callable[[object, str], str]:
    return _checked(lambda value: isinstance(value, str) and value in choices, f"one of {', '.join(choices)}")


_truth_value = _checked(lambda value: isinstance(value, bool), "true or false")
_protocol = _checked(lambda value: value == PROTOCOL and not isinstance(value, bool), f"{PROTOCOL}, the only version")
_names = _checked(
    lambda value: isinstance(value, list) and all(isinstance(each, str) for each in value), "a list of names"
)


def _text(value: object, where: str) -> str:
    if not isinstance(value, str):
        raise _wrong(value, where, "a text")
    return escaped(value, 200)


def _name(value: object, where: str) -> str:
    name = _text(value, where)
    if not name:
        raise InputError(f"{where} is empty; it must be a name")
    return name


def _list(value: object, length: int, where: str, wanted: str) -> list[Any]:
    if not isinstance(value, list) or len(value) != length:
        raise _wrong(value, where, wanted)
    return value


def _number(value: object, where: str) -> float:
    """A number of float64; integers are numbers, truth values are not."""
    try:
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return float(value)
    except OverflowError:
        pass
    raise InputError(f"{where} holds {_shown(value)}; it must be two numbers of float64")


def _range(value: object, where: str) -> tuple[float, float]:
    low, high = _list(value, 2, where, "two numbers, the least and the greatest")
    return _number(low, where), _number(high, where)


def _settings(value: object, where: str) -> tuple[FixedSizes, ...]:
    if not isinstance(value, list) or not value:
        raise _wrong(value, where, "a list of mappings with sizes, and optionally x, y, z, axis")
    return tuple(_setting(each, f"{where}[{place}]") for place, each in enumerate(value))


def _setting(value: object, where: str) -> FixedSizes:
    found = object_of(value, where, ("sizes", *CENTER, "axis"), required=("sizes",))
    listed = _list(found["sizes"], len(SIZES), f"{where}'s sizes", f"four numbers, {', '.join(SIZES)}")
    alpha, gamma, b, d = (_number(each, f"{where}'s sizes") for each in listed)
    for name, size in zip(SIZES, (alpha, gamma, b, d), strict=True):
        trouble = trouble_with(name, size)
        if trouble is not None:
            raise InputError(f"{where}'s sizes: {trouble}")
    spans = {key: _range(found[key], f"{where}'s {key}") for key in CENTER if key in found}
    for key, (low, high) in spans.items():
        if not low <= high:
            raise InputError(f"{where}'s {key} is [{low}, {high}]; it must be two numbers, the least first")
    return FixedSizes((alpha, gamma, b, d), **spans, axis=_axis(found.get("axis"), f"{where}'s axis"))


def _axis(value: object, where: str) -> tuple[float, float, float] | Literal["free"] | None:
    if value is None or value == "free":
        return "free" if value else None
    x, y, z = (_number(each, where) for each in _list(value, len(AXIS), where, 'three numbers, or "free"'))
    if not all(map(math.isfinite, (x, y, z))) or not (x or y or z):
        raise _wrong(value, where, "three finite numbers, not all of them 0")
    return x, y, z


def _groups(value: object, where: str) -> tuple[str, ...]:
    """Names of groups of columns, in any order."""
    names = value if isinstance(value, list) else [None]
    if len(set(map(str, names))) != len(names) or not all(isinstance(name, str) and name in GROUPS for name in names):
        raise _wrong(value, where, f"a list of {', '.join(GROUPS)}, of none, some or all of them, each once")
    return tuple(names)


_DOMAIN_KEYS: Mapping[str, Callable[[object, str], Any]] = MappingProxyType(
    {
        "regimes": lambda value, where: tuple(_names(value, where)),
        "ratio": _range,
        "magnitude": _range,
        "settings": _settings,
    }
)


def domain_of(value: object, where: str) -> Domain:
    """The domain in a mapping; raises InputError naming key and value."""
    found = object_of(value, where, tuple(_DOMAIN_KEYS), required=())
    return Domain(**{key: _DOMAIN_KEYS[key](each, f"{where}'s {key}") for key, each in found.items()})


_KEYS: Mapping[str, Callable[[object, str], object]] = MappingProxyType(
    {
        "protocol": _protocol,
        "name": _name,
        "version": _text,
        "language": _text,
        "precision": _one_of(PRECISIONS),
        "question": _one_of(QUESTIONS),
        "domain": domain_of,
        **dict.fromkeys(("refuses", "binary", "time", "tilt", "times"), _truth_value),
        "takes": _groups,
    }
)
