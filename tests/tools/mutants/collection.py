"""The collection: every implementation of the modules, with its sentence and what the gate must say of it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from importlib import import_module
from inspect import getsource
from types import ModuleType

from tests.tools.mutants.expectation import Expectation, Function, expectation_of

MODULES = (
    "signs",
    "slips",
    "lengths",
    "shapes",
    "answers",
    "regimes",
    "thresholds",
    "rounding",
    "floats",
    "ranges",
    "lookups",
    "batches",
    "memory",
    "refusals",
    "extremes",
    "tilted",
    "passages",
    "ended",
    "ended_sweeps",
    "correct",
)
"""Small modules, each with one kind of mistake; the last with none. In those of tilted pairs, sweeps and ends some are
right."""


@dataclass(frozen=True, slots=True)
class Mutant:
    """One implementation: its module and function, what it does in a sentence, and what must become of it."""

    module: str
    function: str
    sentence: str
    expectation: Expectation

    @property
    def name(self) -> str:
        """As it is called on the command line and in the table."""
        return f"{self.module}.{self.function}"

    @property
    def spec(self) -> str:
        """As `hypcheck verify` finds it from the root of the tree."""
        return f"python:tests.tools.mutants.{self.module}:{self.function}"

    @property
    def isolation(self) -> tuple[str, ...]:
        """The option without which it would not see hypcheck, if its module imports that: isolated programs do not."""
        text = getsource(imported(self.module))
        return ("--isolate", "off") if re.search(r"^\s*(?:from|import) hypcheck\b", text, re.MULTILINE) else ()


def mutants() -> tuple[Mutant, ...]:
    """All of them, module by module, in the order in which they stand there."""
    return tuple(
        Mutant(module.__name__.rpartition(".")[2], name, sentence(function), expectation)
        for module in map(imported, MODULES)
        for name, function in public_functions(module).items()
        if (expectation := expectation_of(function)) is not None
    )


def imported(name: str) -> ModuleType:
    """A module of the collection."""
    return import_module(f"tests.tools.mutants.{name}")


def public_functions(module: ModuleType) -> dict[str, Function]:
    """The functions that the module itself defines, helpers with a leading underscore left out."""
    return {
        name: value
        for name, value in vars(module).items()
        if callable(value) and not name.startswith("_") and getattr(value, "__module__", "") == module.__name__
    }


def sentence(function: Function) -> str:
    """The function's docstring in one line."""
    return " ".join((function.__doc__ or "").split())
