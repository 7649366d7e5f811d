"""A project's settings: `hypcheck.toml` in the working directory. Each key sets an option of the command line.

Options on the command line take precedence. An unknown key or an invalid value is refused.
"""

from __future__ import annotations

import json
import operator
import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from hypcheck import strict, toml
from hypcheck.cli.options import LARGEST_COUNT, LARGEST_SEED, LIMITS, integer_wanted
from hypcheck.errors import InputError
from hypcheck.messages import escaped
from hypcheck.strict import Check

if TYPE_CHECKING:
    from hypcheck.record.lines import SettingsPart

FILE = "hypcheck.toml"

ABOUT_ONE = ("tolerance", "precision", "question", "domain", *LIMITS)
"""The keys about how an implementation is opened and judged. All commands of COMMANDS read them."""

COMMANDS = ("verify", "replay", "hunt", "minimise")
"""The commands that read the settings: verify reads all keys, the others read ABOUT_ONE."""

_BYTES = re.compile(r"[0-9]+[KMGT]?", re.ASCII | re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class ProjectSettings:
    """The settings of a file.

    specs: what verify gates if no SPEC is given.
    options: values by the names of the options' parameters.
    """

    specs: tuple[str, ...]
    options: Mapping[str, Any]

    @property
    def default_map(self) -> dict[str, dict[str, Any]]:
        """The values by command, for click."""
        about_one = {name: value for name, value in self.options.items() if name in ABOUT_ONE}
        return {command: dict(self.options) if command == "verify" else about_one for command in COMMANDS}


_UNSET: Mapping[str, Any] = MappingProxyType(
    {
        "families": "all but the extreme ones",
        "isolate": "auto",
        "precision": "as declared",
        "question": "as declared",
        "domain": "as declared",
        "known_failures": "none",
        "see": "nothing",
        "max_slowdown": 1.1,  # hypcheck.bench.plan.MAX_SLOWDOWN; its module is not loaded here
    }
)
"""The value that applies if an option is not given, as it is shown."""


def in_effect(context: click.Context, unused: Collection[str] = ()) -> SettingsPart | None:
    """Return the settings for a record's header; None if there are none.

    They are the file that was read, and each option that weakens the gate of this run. `unused` are options that the
    run does not have.
    """
    from hypcheck.isolation.launch import VARIABLE, usual_mode

    settings, weakened = context.find_object(ProjectSettings), []
    by_variable = {} if context.params.get("isolate") else {"isolate": usual_mode()}
    for option in context.command.params:
        name = str(option.name)
        value, default = by_variable.get(name, context.params.get(name)), _UNSET.get(name, option.default)
        weakens = _WEAKENS.get(name)
        if name not in unused and weakens is not None and value is not None and weakens(value, default):
            from_file = context.get_parameter_source(name) is ParameterSource.DEFAULT_MAP
            source = VARIABLE if name in by_variable else FILE if from_file else "command line"
            shown = {"value": _as_text(value), "default": _as_text(default)}
            weakened.append({"option": option.opts[0], **shown, "source": source})
    if settings is None and not weakened:
        return None
    from hypcheck.record.lines import SettingsPart, WeakenedPart

    return SettingsPart(
        file=None if settings is None else FILE, weakened=[WeakenedPart(**option) for option in weakened]
    )


def print_settings(settings: SettingsPart | None) -> None:
    """Print the settings in effect to standard error."""
    from hypcheck.report.messages import settings_facts

    for fact in settings_facts(settings):
        click.echo(f"hypcheck: {escaped(fact)}", err=True)


def print_file_settings() -> None:
    """Print the settings that came from the file, for a command that makes no report."""
    from msgspec.structs import replace

    part = in_effect(click.get_current_context())
    if part is not None and part.file is not None:
        print_settings(replace(part, weakened=[option for option in part.weakened if option.source == part.file]))


def _leaves_out_families(value: str) -> bool:
    """Return whether the chosen families lack one that is tested by default. An empty choice is refused later."""
    from hypcheck.vectors.families import select

    try:
        return not set(select()) <= set(select([name for name in map(str.strip, value.split(",")) if name]))
    except InputError:
        return True


_WEAKENS: Mapping[str, Callable[[Any, Any], bool]] = MappingProxyType(
    {
        **dict.fromkeys(("tolerance", "max_abstained", "max_slowdown"), operator.gt),
        **dict.fromkeys(("count", "judged", "roots", "meshes"), operator.lt),
        **dict.fromkeys(("fail_on", "oracles", "precision", "question", "domain", "known_failures"), operator.ne),
        "isolate": lambda value, _: bool(value == "off"),
        "see": lambda value, _: bool(value),
        "families": lambda value, _: _leaves_out_families(value),
    }
)
"""For each option that can weaken a gate: a function that says whether a value does, from the value and the default."""


def _as_text(value: object) -> str:
    """Return a value of an option as text."""
    if isinstance(value, tuple):
        return ", ".join(map(str, value))
    return f"{value:.17g}" if isinstance(value, float) else str(value)


def read_settings(path: Path) -> ProjectSettings | None:
    """Read the settings in a file; None if there is no such file. Raises InputError naming file, line and key."""
    try:
        text = toml.text_of(str(path))
    except FileNotFoundError:
        return None
    options = strict.table_of(text, str(path), "the file", tuple(_KEYS)).present(_KEYS)
    return ProjectSettings(options.pop("specs", ()), options)


def _names(wanted: str) -> Check[str]:
    """Return a check for a list of names or a text of them; it makes the form of the option, separated by commas."""
    listed = strict.texts(wanted)

    def check(value: object) -> str:
        names = listed([value] if isinstance(value, str) else value)
        if not all(map(str.strip, names)):
            raise ValueError(wanted)
        return ",".join(names)

    return check


def _path(value: object) -> str:
    """Check that a value is the text of a path, and return it."""
    if not isinstance(value, str) or not value or "\0" in value:
        raise ValueError("the text of a path")
    return value


def _integer(least: int, greatest: int = LARGEST_COUNT) -> Check[int]:
    """Return a check for a whole number from `least` to `greatest`."""

    def check(value: object) -> int:
        if isinstance(value, float) and value.is_integer():  # 1e9 is a float in TOML
            value = int(value)
        if isinstance(value, int) and not isinstance(value, bool) and least <= value <= greatest:
            return value
        raise ValueError(integer_wanted(least, greatest))

    return check


def _bytes(value: object) -> str:
    """Check that a value is a size in bytes, and return it as text."""
    if isinstance(value, int) and not isinstance(value, bool) and value > 0:
        return str(value)
    if not isinstance(value, str) or not _BYTES.fullmatch(value):
        raise ValueError('a size such as "512M" or "4G", or a whole number of bytes')
    return value


def _precision(value: object) -> str:
    """Check that a value is the name of a precision, and return it."""
    from hypcheck.implementations.domain import PRECISIONS

    return strict.one_of(*PRECISIONS)(value)


def _question(value: object) -> str:
    """Check that a value is the name of a question, and return it."""
    from hypcheck.implementations.description import QUESTIONS

    return strict.one_of(*QUESTIONS)(value)


def _domain(value: object) -> str:
    """Check the table of a domain, and return it in the form of the option, JSON. Raises InputError too."""
    from hypcheck.implementations.description import parse_domain

    if not isinstance(value, dict):
        raise ValueError('a table such as { regimes = ["a>=1"], ratio = [1e-3, 1e3], magnitude = [1e-6, 1e6] }')  # noqa: TRY004
    text = json.dumps(value, default=str)
    parse_domain(text)
    return text


_KEYS: Mapping[str, Check[Any]] = MappingProxyType(
    {
        "specs": strict.texts('a list of texts, such as ["command:./adapter"]'),
        "out": _path,
        "families": _names('names and globs, such as ["ring", "tower-*"]'),
        "count": _integer(0),
        "seed": _integer(0, LARGEST_SEED),
        "tolerance": strict.not_negative,
        "precision": _precision,
        "question": _question,
        "domain": _domain,
        "max_abstained": _integer(0),
        "fail_on": strict.one_of("wrong", "false-clear"),
        "deterministic": strict.truth,
        "known_failures": _path,
        "startup_timeout": strict.positive,
        "timeout": strict.positive,
        "restarts": _integer(0),
        "memory": _bytes,
        "isolate": strict.one_of("auto", "on", "off"),
        "pass_env": _names('names of environment variables, such as ["LANG", "LD_LIBRARY_PATH"]'),
        "see": strict.texts('a list of paths, such as ["vendor/lib"]'),
    }
)
"""The check of each key, which gives the value the form of its option."""
