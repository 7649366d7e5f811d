"""Running a program in any arithmetic: exact numbers, machine numbers of a given format, symbols."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import cache
from typing import Any

from hypcheck.derivation.program import Program, needed


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


class Evaluator:
    """A program made ready for one arithmetic: a function from inputs by name to the wanted values, in their order.

    Only the steps that the wanted names depend on are evaluated, and only the inputs that these read are asked for;
    `inputs` names them. `given` are values by name that stay the same from call to call, converted once. Names are
    looked up once, so that a call on small arrays spends its time on arithmetic; an intermediate value is let go after
    its last use, so that large arrays take no more memory than they must.

    Raises KeyError where a wanted name does not exist, and ValueError where the arithmetic lacks an operation. A call
    raises ValueError where an input is missing; further names among its inputs are ignored.
    """

    def __init__(
        self,
        program: Program,
        arithmetic: Arithmetic,
        wanted: Iterable[str],
        given: Mapping[str, Any] | None = None,
    ) -> None:
        layout = _layout(program, tuple(wanted))
        fixed = given or {}
        self.inputs = tuple(name for name in layout.inputs if name not in fixed)
        self._program, self._arithmetic, self._wanted = program, arithmetic, layout.wanted
        self._varying = tuple((name, layout.places[name]) for name in self.inputs)
        self._moves = tuple((_operation(arithmetic, move.operation), *move.places) for move in layout.moves)
        self._cells: list[Any] = [None] * len(layout.places)
        with arithmetic.guard():
            for constant in layout.constants:
                self._cells[layout.places[constant]] = arithmetic.convert(constant)
            for name in layout.inputs:
                if name in fixed:
                    self._cells[layout.places[name]] = arithmetic.convert(fixed[name])

    def __call__(self, inputs: Mapping[str, Any]) -> tuple[Any, ...]:
        """The wanted values."""
        missing = [name for name in self.inputs if name not in inputs]
        if missing:
            raise ValueError(f"program {self._program.name} needs a value for {', '.join(missing)}")
        cells = self._cells.copy()
        with self._arithmetic.guard():
            for name, place in self._varying:
                cells[place] = self._arithmetic.convert(inputs[name])
            for operation, takes, gives, spends in self._moves:
                cells[gives] = operation(*[cells[place] for place in takes])
                for place in spends:
                    cells[place] = None
        return tuple([cells[place] for place in self._wanted])


def evaluate(program: Program, arithmetic: Arithmetic, inputs: Mapping[str, Any]) -> dict[str, Any]:
    """The value of every input, as converted, and of every step, by name and in order.

    `inputs` needs a value for each of the program's inputs; others are ignored. Raises ValueError where one is missing.
    """
    names = (*program.inputs, *(step.name for step in program.steps))
    return dict(zip(names, outputs(program, arithmetic, inputs, names), strict=True))


def outputs(
    program: Program, arithmetic: Arithmetic, inputs: Mapping[str, Any], wanted: Iterable[str]
) -> tuple[Any, ...]:
    """The values of the wanted names alone, as an Evaluator gives them; for a program that is evaluated once."""
    return Evaluator(program, arithmetic, wanted)(inputs)


@dataclass(frozen=True, slots=True)
class _Move:
    """A step by places: those it takes, the one it gives, and those that no later step takes."""

    operation: str
    places: tuple[tuple[int, ...], int, tuple[int, ...]]


@dataclass(frozen=True)
class _Layout:
    """Where the values of a program stand in a list: the inputs that are read, constants, and each needed step."""

    inputs: tuple[str, ...]
    constants: tuple[int, ...]
    places: Mapping[str | int, int]
    moves: tuple[_Move, ...]
    wanted: tuple[int, ...]


@cache
def _layout(program: Program, wanted: tuple[str, ...]) -> _Layout:
    steps = needed(program, wanted)
    read = {name for step in steps for name in step.reads} | set(wanted)
    inputs = tuple(name for name in program.inputs if name in read)
    constants = sorted({argument for step in steps for argument in step.arguments if isinstance(argument, int)})
    labels: list[str | int] = [*inputs, *constants, *(step.name for step in steps)]
    places = {label: place for place, label in enumerate(labels)}
    last_use = {name: number for number, step in enumerate(steps) for name in step.reads if name not in wanted}
    moves = tuple(
        _Move(
            step.operation,
            (
                tuple(places[argument] for argument in step.arguments),
                places[step.name],
                tuple(places[name] for name in dict.fromkeys(step.reads) if last_use.get(name) == number),
            ),
        )
        for number, step in enumerate(steps)
    )
    return _Layout(inputs, tuple(constants), places, moves, tuple(places[name] for name in wanted))


def _operation(arithmetic: Arithmetic, name: str) -> Callable[..., Any]:
    operation = arithmetic.operations.get(name)
    if operation is None:
        raise ValueError(f"{arithmetic.name} arithmetic has no {name}")
    return operation
