"""What users depend on, as a list: names and signatures, options, exit codes, schemas, what the C header declares.

`make surface` prints the list into docs/surface.txt, and a test compares. A change of the list is one that users see:
docs/stability.md says what each kind of change asks for.
"""

from __future__ import annotations

import hashlib
import inspect
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click

import hypcheck
from hypcheck.cli.commands import hypcheck as command_line
from hypcheck.errors import Exit

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "surface.txt"
HEADER = ROOT / "hypcheck" / "kernel" / "core" / "hypcheck.h"
SCHEMAS = ROOT / "hypcheck" / "report" / "schemas"


def _signature(value: Any) -> str:
    """Its parameters and their defaults, without types and without `self`."""
    signature = inspect.signature(value)
    kept = [part.replace(annotation=part.empty) for part in signature.parameters.values() if part.name != "self"]
    return str(signature.replace(parameters=kept, return_annotation=signature.empty))


def _members(kind: type) -> Iterator[str]:
    """The public attributes and methods that a class has from hypcheck, a line each."""
    fields = getattr(kind, "__dataclass_fields__", {})
    own = {name for each in kind.__mro__ if each.__module__.startswith("hypcheck") for name in vars(each)}
    for name in sorted(name for name in {*own, *fields} if not name.startswith("_")):
        value = inspect.getattr_static(kind, name, None)
        made = value.__func__ if isinstance(value, (classmethod, staticmethod)) else value
        yield f"    {name}{_signature(getattr(kind, name)) if inspect.isfunction(made) else ''}"


def python() -> Iterator[str]:
    """The public names of the package, with the members of its classes."""
    for name in sorted(hypcheck.__all__):
        value = getattr(hypcheck, name)
        yield f"{name}{_signature(value) if callable(value) else ''}"
        if isinstance(value, type):
            yield from _members(value)


def _parameter(parameter: click.Parameter) -> str:
    names = "/".join([*parameter.opts, *parameter.secondary_opts])
    choices = f" [{'|'.join(map(str, parameter.type.choices))}]" if isinstance(parameter.type, click.Choice) else ""
    return f"    {names if isinstance(parameter, click.Option) else parameter.human_readable_name}{choices}"


def options(command: click.Command = command_line, path: str = "hypcheck") -> Iterator[str]:
    """The commands, each with its arguments and options."""
    yield path
    yield from sorted(_parameter(each) for each in command.params if not getattr(each, "hidden", False))
    if isinstance(command, click.Group):
        context = click.Context(command)
        for name in sorted(command.list_commands(context)):
            below = command.get_command(context, name)
            if below is not None:
                yield from options(below, f"{path} {name}")


def exit_codes() -> Iterator[str]:
    """The exit codes."""
    return (f"{code:d} {code.name}" for code in Exit)


def schemas() -> Iterator[str]:
    """The published schemas, each with the first digits of its SHA-256: what was published stays."""
    for path in sorted(SCHEMAS.glob("*.json")):
        yield f"{path.name} {hashlib.sha256(path.read_bytes()).hexdigest()[:16]}"


def header() -> Iterator[str]:
    """What hypcheck.h declares, without its comments."""
    contract, _, _ = HEADER.read_text(encoding="utf-8").partition("#if defined(HYPCHECK_IMPLEMENTATION)")
    code = re.sub(r"/\*.*?\*/|^#(?!define HYPCHECK_VERSION).*?$", "", contract, flags=re.DOTALL | re.MULTILINE)
    code = code.replace("#define HYPCHECK_VERSION", ";HYPCHECK_VERSION").replace('extern "C" {', "")
    code = re.sub(r'"[\d.]+"', ";", code)
    for part in re.findall(r"typedef struct {.*?} \w+;|[^;{}]+(?:{[^}]*})?;", code, re.DOTALL):
        line = " ".join(part.split()).strip("; ")
        if line:
            yield line


PARTS = {"Python": python, "Command line": options, "Exit codes": exit_codes, "Schemas": schemas, "C": header}


def surface() -> str:
    """The whole list."""
    parts = (f"{title}\n{'=' * len(title)}\n" + "\n".join(lines()) + "\n" for title, lines in PARTS.items())
    return "What users depend on; made by `make surface`, explained in docs/stability.md.\n\n" + "\n".join(parts)


if __name__ == "__main__":
    PAGE.write_text(surface(), encoding="utf-8")
    sys.exit(0)
