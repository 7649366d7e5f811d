"""What an implementation says of itself: name, precision, question, domain. A misspelt key is refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

from hypcheck.errors import InputError
from hypcheck.methods.checks import shown
from hypcheck.methods.domain import Domain
from hypcheck.methods.domain_reading import domain_of
from hypcheck.methods.questions import PRECISIONS, QUESTIONS
from hypcheck.tables.strict_json import object_of, refused_constant, strict_decoder
from hypcheck.visible import visible

PROTOCOL = 1
LONGEST = 1 << 16
"""Bytes of a description."""


@dataclass(frozen=True, slots=True)
class Description:
    """An implementation's claims. `refuses`: invalid rows are answered 127; `binary`, `time`: what a command offers."""

    name: str
    version: str = ""
    language: str = ""
    precision: str = "float64"
    question: str = "position"
    domain: Domain = Domain()  # noqa: RUF009 - frozen
    refuses: bool = False
    binary: bool = False
    time: bool = False

    def overridden(
        self, precision: str | None = None, question: str | None = None, domain: Domain | None = None
    ) -> Description:
        """The description with what the caller says instead; raises InputError where that is not possible."""
        return replace(
            self,
            precision=self.precision if precision is None else _one_of(PRECISIONS)(precision, "the precision"),
            question=self.question if question is None else _one_of(QUESTIONS)(question, "the question"),
            domain=domain or self.domain,
        )


def described(raw: object, defaults: Description, required: tuple[str, ...] = ()) -> Description:
    """The description that a mapping holds, completed from `defaults`; raises InputError naming key and value."""
    said = object_of(raw, "the description", tuple(_KEYS), required)
    values: dict[str, Any] = {key: _KEYS[key](value, f"the description's {key}") for key, value in said.items()}
    values.pop("protocol", None)
    return replace(defaults, **values)


def described_by_json(text: str | bytes, defaults: Description, required: tuple[str, ...] = ()) -> Description:
    """The description in a JSON text; raises InputError."""
    return described(_json(text, "the description"), defaults, required)


def parse_domain(text: str) -> Domain:
    """A domain as the command line has it, in JSON; raises InputError."""
    return domain_of(_json(text, "the domain"), "the domain")


def _unbounded(text: str) -> float:
    """Infinity, which Python and TOML write where a domain has no end; raises ValueError on NaN."""
    return refused_constant(text) if text == "NaN" else float(text)


_STRICT = strict_decoder(constant=_unbounded)


def _json(text: str | bytes, where: str) -> object:
    if len(text) > LONGEST:
        raise InputError(f"{where} is longer than {LONGEST} bytes")
    try:
        return _STRICT.decode(text if isinstance(text, str) else text.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        unreadable = isinstance(error, UnicodeError | RecursionError)
        why = "it cannot be read" if unreadable else visible(f"{error}", 120)
        shown = text if isinstance(text, str) else text.decode("utf-8", "replace")
        raise InputError(f"{where} is '{visible(shown, 80)}'; it must be JSON ({why})") from None


def _text(value: object, where: str) -> str:
    if not isinstance(value, str):
        raise InputError(f"{where} is {shown(value)}; it must be a text")
    return visible(value, 200)


def _name(value: object, where: str) -> str:
    name = _text(value, where)
    if not name:
        raise InputError(f"{where} is empty; it must be a name")
    return name


def _truth_value(value: object, where: str) -> bool:
    if not isinstance(value, bool):
        raise InputError(f"{where} is {shown(value)}; it must be true or false")
    return value


def _one_of(choices: tuple[str, ...]) -> Callable[[object, str], str]:
    def check(value: object, where: str) -> str:
        if value not in choices:
            raise InputError(f"{where} is {shown(value)}; it must be one of {', '.join(choices)}")
        return str(value)

    return check


def _protocol(value: object, where: str) -> int:
    if value != PROTOCOL or isinstance(value, bool):
        raise InputError(f"{where} is {shown(value)}; it must be {PROTOCOL}, the only one there is")
    return PROTOCOL


_KEYS: Mapping[str, Callable[[object, str], object]] = MappingProxyType(
    {
        "protocol": _protocol,
        "name": _name,
        "version": _text,
        "language": _text,
        "precision": _one_of(PRECISIONS),
        "question": _one_of(QUESTIONS),
        "domain": domain_of,
        "refuses": _truth_value,
        "binary": _truth_value,
        "time": _truth_value,
    }
)
