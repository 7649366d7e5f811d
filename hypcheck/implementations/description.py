"""The description of an implementation: name, precision, question, and the domain where it claims to be right.

Rows outside the domain are skipped, not judged. Descriptions come from foreign code as JSON; an unknown key or a wrong
value raises InputError, which names the key, the value, and what would be right.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Literal

from hypcheck import strict
from hypcheck.errors import InputError
from hypcheck.geometry import rows
from hypcheck.geometry.pair import CENTER, GROUPS, HEIGHTS, SIZES, Groups, Position, Sizes, trouble_with
from hypcheck.implementations.domain import ORDINARY, PRECISIONS, Domain
from hypcheck.implementations.frames import WIDTH
from hypcheck.isolation.launch import masked
from hypcheck.messages import escaped
from hypcheck.strict import Check, Origin, StrictTable, dotted
from hypcheck.tables.strict_json import refused_constant, strict_decoder
from hypcheck.toml import Path


@dataclass(frozen=True, slots=True)
class Question:
    """A question to an implementation: its name, its answers besides CANNOT_SAY, and the columns of its rows.

    `contact` is the answer on which a caller must stop a motion, since it claims contact or does not exclude it.
    `position` is the position that a question with the answers yes and no is about; None if the answer is the position
    itself, or a hit. `layout` has the columns of its rows. `entry` is part of the names of a library's functions:
    hypcheck_ENTRY and hypcheck_ENTRY_tilted. `forms` come before "text" and "binary" in the protocol of commands, for
    upright and for tilted spheroids. `times` says that an implementation may give a time with each answer 1.
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
"""The questions by name: the position, whether it is a certain one, and whether there is contact on a sweep."""


def foreign_text(text: object, width: int = WIDTH) -> str:
    """Return a text of a foreign program on one line, as messages.escaped, without the secrets of our environment."""
    return escaped(masked(str(text)), width)


PROTOCOL = 1
LONGEST = 1 << 16
"""The most bytes of a description."""


@dataclass(frozen=True, slots=True)
class Description:
    """An implementation's description of itself.

    `domain` is where it claims to be right. `refuses` says that it answers invalid rows with 127. `binary` and `time`
    say which optional parts of the protocol a command offers. `tilt` says that its rows have the spheroid's axis after
    the other numbers, `heights` that their last columns are the heights between which the hyperboloid exists. `times`
    says that it gives a time with each answer 1.
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
    def groups(self) -> Groups:
        """The groups of columns that it takes."""
        takes = {"end": self.asked.layout.has_end, "axis": self.tilt, "heights": self.heights}
        return frozenset(name for name, taken in takes.items() if taken)

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns of the rows that the implementation gets."""
        layout = self.asked.layout
        return (layout.tilted if self.tilt else layout.upright) + (HEIGHTS if self.heights else ())

    def overridden(
        self, precision: str | None = None, question: str | None = None, domain: Domain | None = None
    ) -> Description:
        """Return the description with values of the caller.

        Raises InputError if there is no such precision or question, and if the question is about rows with other
        columns than those that the description declares.
        """
        changed = replace(
            self,
            precision=self.precision if precision is None else _chosen("the precision", precision, PRECISIONS),
            question=self.question if question is None else _chosen("the question", question, QUESTIONS),
            domain=domain or self.domain,
        )
        if changed.asked.layout != self.asked.layout:
            raise InputError(
                f"the question is {changed.question!r}, but {self.name} describes itself as answering "
                f'{self.question!r}, about other rows; its description must say "question": "{changed.question}"'
            )
        return changed


def described(raw: object, defaults: Description, required: tuple[str, ...] = ()) -> Description:
    """Return the description in a mapping, completed from `defaults`; raises InputError naming key and value."""
    table = StrictTable(_Foreign("the description"), (), raw, _KEYS)
    for key in required:
        table.required(key, _CHECKS[key])
    values, taken = table.present(_CHECKS), table.optional("takes", _groups, ())
    values.pop("protocol", None)
    domain = table.table("domain", DOMAIN_KEYS)
    if domain is not None:
        values["domain"] = _domain(domain)
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
    """Return the description in a JSON text; raises InputError."""
    return described(_json(text, "the description"), defaults, required)


def parse_domain(text: str) -> Domain:
    """Return the domain in a JSON text of the command line; raises InputError."""
    return domain_of(_json(text, "the domain"))


def domain_of(value: object) -> Domain:
    """Return the domain in a mapping; raises InputError naming key and value."""
    return _domain(StrictTable(_Foreign("the domain"), (), value, DOMAIN_KEYS))


def _unbounded(text: str) -> float:
    """Infinity, which Python and TOML write for the end of an unbounded range; raises ValueError on NaN."""
    return refused_constant(text) if text == "NaN" else float(text)


_STRICT = strict_decoder(constant=_unbounded)


def _json(text: str | bytes, where: str) -> object:
    """Return the value of a JSON text. Raises InputError, which begins with `where`."""
    if len(text) > LONGEST:
        raise InputError(f"{where} is longer than {LONGEST} bytes")
    try:
        return _STRICT.decode(text if isinstance(text, str) else text.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        unreadable = isinstance(error, UnicodeError | RecursionError)
        why = "it cannot be read" if unreadable else foreign_text(f"{error}", 120)
        shown = text if isinstance(text, str) else text.decode("utf-8", "replace")
        raise InputError(f"{where} is '{foreign_text(shown, 80)}'; it must be JSON ({why})") from None


@dataclass(frozen=True)
class _Foreign(Origin):
    """A description by foreign code, whose texts may hold secrets and control characters."""

    title: str

    def named(self, path: Path) -> str:
        """Return the table or the value at a path: the description's domain.ratio."""
        return f"{self.title}'s {dotted(path)}" if path else self.title

    def shown(self, value: object) -> str:
        """Return the value as Python writes it, short and masked."""
        return foreign_text(repr(value), 80)


def _chosen(title: str, name: str, choices: Collection[str]) -> str:
    """Return the name, if it is one of the choices. Raises InputError."""
    return _Foreign(title).checked((), name, strict.one_of(*choices))


def _protocol(value: object) -> int:
    """Return the version of the protocol. Raises ValueError with what it must be, as all checks here do."""
    if value != PROTOCOL or isinstance(value, bool):
        raise ValueError(f"{PROTOCOL}, the only version")
    return PROTOCOL


def _text(value: object) -> str:
    """Return a text, masked and on one line."""
    if not isinstance(value, str):
        raise ValueError("a text")  # noqa: TRY004 - turned into a sentence about the value
    return foreign_text(value, 200)


def _name(value: object) -> str:
    """Return a text that is not empty, masked and on one line."""
    if not isinstance(value, str) or not _text(value):
        raise ValueError("a text that is not empty")
    return _text(value)


def _groups(value: object) -> tuple[str, ...]:
    """Return names of groups of columns, in any order."""
    names = value if isinstance(value, list) else [None]
    if len(set(map(str, names))) != len(names) or not all(isinstance(name, str) and name in GROUPS for name in names):
        raise ValueError(f"a list of {', '.join(GROUPS)}, of none, some or all of them, each once")
    return tuple(names)


def _sizes(value: object) -> Sizes:
    """Return four numbers, which may be infinite."""
    wanted = f"four numbers, {', '.join(SIZES)}"
    alpha, gamma, b, d = strict.numbers_of(value, len(SIZES), wanted, infinite=True)
    return alpha, gamma, b, d


def _range(value: object) -> tuple[float, float]:
    """Return two numbers, which may be infinite."""
    low, high = strict.numbers_of(value, 2, "two numbers, [least, greatest]", infinite=True)
    return low, high


def _span(value: object) -> tuple[float, float]:
    """Return two numbers, the least first."""
    low, high = _range(value)
    if not low <= high:
        raise ValueError("two numbers, [least, greatest], the least first")
    return low, high


def _axis(value: object) -> tuple[float, float, float] | Literal["free"] | None:
    """Return an axis, the word free, or None."""
    return None if value is None else _AXIS(value)


_FREE: Literal["free"] = "free"
_AXIS = strict.or_word(_FREE, strict.direction)

DOMAIN_KEYS = ("regimes", "ratio", "magnitude", "settings")


def _domain(table: StrictTable) -> Domain:
    """Return the domain in a table. Raises InputError."""
    wanted = "a list of mappings with sizes, and optionally x, y, z, axis"
    settings = table.tables("settings", ("sizes", *CENTER, "axis"), wanted, least=1)
    return Domain(
        regimes=table.optional("regimes", strict.texts("a list of names", least=0), ()),
        ratio=table.optional("ratio", _range, None),
        magnitude=table.optional("magnitude", _range, None),
        settings=tuple(map(_setting, settings)),
    )


def _setting(table: StrictTable) -> rows.FixedSizes:
    """Return the sizes in a table, with the ranges of their centres. Raises InputError."""
    sizes = table.required("sizes", _sizes)
    for name, size in zip(SIZES, sizes, strict=True):
        trouble = trouble_with(name, size)
        if trouble is not None:
            table.refuse(f"{table.named('sizes')}: {trouble}", "sizes")
    spans = table.present(dict.fromkeys(CENTER, _span))
    return rows.FixedSizes(sizes, **spans, axis=table.optional("axis", _axis, None))


_CHECKS: Mapping[str, Check[Any]] = MappingProxyType(
    {
        "protocol": _protocol,
        "name": _name,
        "version": _text,
        "language": _text,
        "precision": strict.one_of(*PRECISIONS),
        "question": strict.one_of(*QUESTIONS),
        **dict.fromkeys(("refuses", "binary", "time", "tilt", "times"), strict.truth),
    }
)
_KEYS = (*_CHECKS, "domain", "takes")
