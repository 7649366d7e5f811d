"""Running a program in any arithmetic: exact numbers, machine numbers of a given format, symbols."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import cache
from typing import Any

from hypcheck.derivation.program import Argument, Program, Step, needed


@dataclass(frozen=True)
class Arithmetic:
    """What the operations of a program mean.

    `convert` brings an input or an integer constant into the arithmetic; for machine numbers it rounds, and it is the
    first operation. `operations` has a function for each operation the arithmetic knows, by its name in
    program.KNOWN. `integers` turns an answer (an integer value or a truth value) into int or an int8 array.
    `guard` surrounds an evaluation.
    """

    name: str
    convert: Callable[[Any], Any]
    operations: Mapping[str, Callable[..., Any]]
    integers: Callable[[Any], Any] = int
    guard: Callable[[], AbstractContextManager[Any]] = nullcontext


def evaluate(program: Program, arithmetic: Arithmetic, inputs: Mapping[str, Any]) -> dict[str, Any]:
    """The value of every input, as converted, and of every step, by name and in order.

    `inputs` needs a value for each of the program's inputs; others are ignored. Raises ValueError where one is missing.
    """
    with arithmetic.guard():
        values = _converted(program, arithmetic, inputs, program.inputs)
        for step in program.steps:
            values[step.name] = _perform(step, arithmetic, values)
    return values


def outputs(
    program: Program, arithmetic: Arithmetic, inputs: Mapping[str, Any], wanted: Iterable[str]
) -> tuple[Any, ...]:
    """The values of the wanted names alone.

    Steps they do not depend on are not evaluated, inputs they do not depend on may be missing, and each intermediate
    value is let go after its last use, so that arrays take no more memory than they must.
    """
    names = tuple(wanted)
    read, schedule = _schedule(program, names)
    with arithmetic.guard():
        values = _converted(program, arithmetic, inputs, read)
        for step, spent in schedule:
            values[step.name] = _perform(step, arithmetic, values)
            for name in spent:
                del values[name]
        return tuple(values[name] for name in names)


@cache
def _schedule(
    program: Program, wanted: tuple[str, ...]
) -> tuple[tuple[str, ...], tuple[tuple[Step, tuple[str, ...]], ...]]:
    """The inputs that are read, and each needed step with the names that no later step reads."""
    steps = needed(program, wanted)
    last_use = {name: index for index, step in enumerate(steps) for name in step.reads}
    spent: list[list[str]] = [[] for _ in steps]
    for name, index in last_use.items():
        if name not in wanted:
            spent[index].append(name)
    read = tuple(name for name in program.inputs if name in last_use or name in wanted)
    return read, tuple((step, tuple(names)) for step, names in zip(steps, spent, strict=True))


def _converted(
    program: Program, arithmetic: Arithmetic, inputs: Mapping[str, Any], names: tuple[str, ...]
) -> dict[str, Any]:
    missing = [name for name in names if name not in inputs]
    if missing:
        raise ValueError(f"program {program.name} needs a value for {', '.join(missing)}")
    return {name: arithmetic.convert(inputs[name]) for name in names}


def _perform(step: Step, arithmetic: Arithmetic, values: Mapping[str, Any]) -> Any:
    operation = arithmetic.operations.get(step.operation)
    if operation is None:
        raise ValueError(f"{arithmetic.name} arithmetic has no {step.operation}")
    return operation(*(_value(argument, arithmetic, values) for argument in step.arguments))


def _value(argument: Argument, arithmetic: Arithmetic, values: Mapping[str, Any]) -> Any:
    return values[argument] if isinstance(argument, str) else arithmetic.convert(argument)
