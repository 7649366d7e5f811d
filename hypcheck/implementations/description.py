"""The description of an implementation: name, precision, question, and the domain where it claims to be right.

Rows outside the domain are skipped, not judged. Descriptions come from foreign code as JSON; an unknown key or a wrong
value raises InputError, which names the key, the value, and what would be right.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Literal

from hypcheck.errors import InputError
from hypcheck.geometry import rows
from hypcheck.geometry.pair import AXIS, CENTER, GROUPS, HEIGHTS, SIZES, Position, trouble_with
from hypcheck.implementations.domain import ORDINARY, PRECISIONS, Domain
from hypcheck.implementations.output import foreign_text
from hypcheck.tables.strict_json import object_of, refused_constant, strict_decoder


@dataclass(frozen=True, slots=True)
class Question:
    """A question to an implementation: its name, its answers besides CANNOT_SAY, and the columns of its rows.

    `contact` is the answer after which a program stops, since it claims contact or does not exclude it. `position` is
    the one that is asked about, by yes or no; None: the answer is the truth itself, a position or a hit.
    `entry` is what a library's function is called after: hypcheck_ENTRY and hypcheck_ENTRY_tilted. `forms` stand before
    "text" and "binary" in the protocol of commands, for upright and for tilted spheroids. `times` says that a time may
    go with each answer 1.
    """

    name: str
    answers: tuple[int, ...] = (0, 1)
    contact: int = 0
    position: Position | None = None
    layout: rows.Layout = rows.PAIRS
    entry: str = "classify"
    forms: tuple[str, str] = ("", "tilted-")
    times: bool = False


QUESTIONS: Mapping[str, Question] = MappingProxyType(
    {
        question.name: question
        for question in (
            Question("position", (-1, 0, 1)),
            Question("exterior", position=Position.EXTERIOR),
            Question("interior", position=Position.INTERIOR),
            Question("contact", contact=1, position=Position.CONTACT),
            Question(
                "passage", contact=1, layout=rows.SWEEPS, entry="passage", forms=("passage-", "passage-"), times=True
            ),
        )
    }
)
"""The position itself, whether it is one of the three, and whether there is contact on the sweep between two."""

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
        changed = replace(
            self,
            precision=self.precision if precision is None else _one_of(PRECISIONS)(precision, "the precision"),
            question=self.question if question is None else _one_of(QUESTIONS)(question, "the question"),
            domain=domain or self.domain,
        )
        if changed.asked.layout != self.asked.layout:
            raise InputError(
                f"the question is {changed.question!r}, but {self.name} describes itself as answering "
                f'{self.question!r}, about other rows; its description must say "question": "{changed.question}"'
            )
        return changed


def described(raw: object, defaults: Description, required: tuple[str, ...] = ()) -> Description:
    """The description in a mapping, completed from `defaults`; raises InputError naming key and value."""
    content = object_of(raw, "the description", tuple(_KEYS), required)
    values: dict[str, Any] = {key: _KEYS[key](value, f"the description's {key}") for key, value in content.items()}
    values.pop("protocol", None)
    taken = values.pop("takes", ())
    if "axis" in taken and values.get("tilt") is False:
        raise InputError("the description takes an axis, but its tilt is false; leave tilt out, or make it true")
    values |= {name: True for name, group in (("tilt", "axis"), ("heights", "heights")) if group in taken}
    description = replace(defaults, **values)
    if "end" in taken and not description.asked.layout.has_end:
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
        why = "it cannot be read" if unreadable else foreign_text(f"{error}", 120)
        shown = text if isinstance(text, str) else text.decode("utf-8", "replace")
        raise InputError(f"{where} is '{foreign_text(shown, 80)}'; it must be JSON ({why})") from None


def _wrong(value: object, where: str, wanted: str) -> InputError:
    """The error about a value: `where` it stands, what it is, and what it must be."""
    return InputError(f"{where} is {_shown(value)}; it must be {wanted}")


def _shown(value: object) -> str:
    return foreign_text(repr(value), 80)


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
    lambda value: isinstance(value, list) and all(isinstance(name, str) for name in value), "a list of names"
)


def _text(value: object, where: str) -> str:
    if not isinstance(value, str):
        raise _wrong(value, where, "a text")
    return foreign_text(value, 200)


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


def _settings(value: object, where: str) -> tuple[rows.FixedSizes, ...]:
    if not isinstance(value, list) or not value:
        raise _wrong(value, where, "a list of mappings with sizes, and optionally x, y, z, axis")
    return tuple(_setting(item, f"{where}[{place}]") for place, item in enumerate(value))


def _setting(value: object, where: str) -> rows.FixedSizes:
    content = object_of(value, where, ("sizes", *CENTER, "axis"), required=("sizes",))
    listed = _list(content["sizes"], len(SIZES), f"{where}'s sizes", f"four numbers, {', '.join(SIZES)}")
    alpha, gamma, b, d = (_number(size, f"{where}'s sizes") for size in listed)
    for name, size in zip(SIZES, (alpha, gamma, b, d), strict=True):
        trouble = trouble_with(name, size)
        if trouble is not None:
            raise InputError(f"{where}'s sizes: {trouble}")
    spans = {key: _range(content[key], f"{where}'s {key}") for key in CENTER if key in content}
    for key, (low, high) in spans.items():
        if not low <= high:
            raise InputError(f"{where}'s {key} is [{low}, {high}]; it must be two numbers, the least first")
    return rows.FixedSizes((alpha, gamma, b, d), **spans, axis=_axis(content.get("axis"), f"{where}'s axis"))


def _axis(value: object, where: str) -> tuple[float, float, float] | Literal["free"] | None:
    if value is None or value == "free":
        return "free" if value else None
    x, y, z = (_number(number, where) for number in _list(value, len(AXIS), where, 'three numbers, or "free"'))
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
    content = object_of(value, where, tuple(_DOMAIN_KEYS), required=())
    return Domain(**{key: _DOMAIN_KEYS[key](item, f"{where}'s {key}") for key, item in content.items()})


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
