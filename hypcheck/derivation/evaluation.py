"""Evaluate programs in any arithmetic; here in exact numbers p + q√h with rational p, q and h.

Floats and symbols have modules of their own.

Exact arithmetic decides signs and never estimates them. One square root is all that a formula here takes (the local
maximum of g), so a second, different root is refused. Division by zero and the root of a negative number give
UNDEFINED, which like NaN goes through every operation and makes every comparison false: a straight-line program
evaluates also the branch that it does not select.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

from hypcheck.derivation.program import Program, needed, split
from hypcheck.geometry.arithmetic import QuadraticSurd, exact_root


@dataclass(frozen=True)
class Arithmetic:
    """An arithmetic: a function for each operation of a program.

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

    Only the steps that the wanted names depend on are evaluated, and only the inputs that these read are needed;
    `inputs` names them. `fixed_values` are values by name that every call uses, converted once. Names are
    looked up once, so that a call on small arrays spends its time on arithmetic; an intermediate value is freed after
    its last use, so that large arrays take no more memory than they must.

    Raises KeyError where a wanted name does not exist, and ValueError where the arithmetic lacks an operation. A call
    raises ValueError where an input is missing; further names among its inputs are ignored.
    """

    def __init__(
        self,
        program: Program,
        arithmetic: Arithmetic,
        wanted: Iterable[str],
        fixed_values: Mapping[str, Any] | None = None,
    ) -> None:
        layout = _layout(program, tuple(wanted))
        fixed = fixed_values or {}
        self.inputs = tuple(name for name in layout.inputs if name not in fixed)
        self._program, self._arithmetic, self._wanted = program, arithmetic, layout.wanted
        self._varying = tuple((name, layout.places[name]) for name in self.inputs)
        self._moves = tuple(
            (_operation(arithmetic, name), takes, gives, spends) for name, takes, gives, spends in layout.moves
        )
        self._cells: list[Any] = [None] * len(layout.places)
        with arithmetic.guard():
            for constant in layout.constants:
                self._cells[layout.places[constant]] = arithmetic.convert(constant)
            for name in layout.inputs:
                if name in fixed:
                    self._cells[layout.places[name]] = arithmetic.convert(fixed[name])

    def __call__(self, inputs: Mapping[str, Any]) -> tuple[Any, ...]:
        """Return the wanted values, in their order, for these inputs by name."""
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
    """Compute the value of every input, as converted, and of every step, by name and in order.

    `inputs` needs a value for each of the program's inputs; others are ignored. Raises ValueError where one is missing.
    """
    names = (*program.inputs, *(step.name for step in program.steps))
    return dict(zip(names, outputs(program, arithmetic, inputs, names), strict=True))


def outputs(
    program: Program, arithmetic: Arithmetic, inputs: Mapping[str, Any], wanted: Iterable[str]
) -> tuple[Any, ...]:
    """Compute the values of the wanted names, as an Evaluator does; for a program that is evaluated once."""
    return Evaluator(program, arithmetic, wanted)(inputs)


def loop_body(
    program: Program, arithmetic: Arithmetic, constants: Mapping[str, Any], wanted: Iterable[str]
) -> Evaluator:
    """Prepare the part of a program that depends on more than the `constants`: a function from the other inputs.

    The result is an Evaluator; a call of it returns the wanted values, the same to the bit as those of the whole
    program. Every number that depends on the constants alone is computed here, once. The constants may be arrays (the
    sizes of many trees). Raises KeyError where a wanted name does not exist.
    """
    names = tuple(wanted)
    before, body = split(program, names, tuple(constants))
    known = tuple(step.name for step in before.steps)
    values = Evaluator(before, arithmetic, known)(constants)
    return Evaluator(body, arithmetic, names, {**constants, **dict(zip(known, values, strict=True))})


_Move = tuple[str, tuple[int, ...], int, tuple[int, ...]]
"""A step whose values are places in a list: its operation, the places of its arguments, the place of its result, and
the places that no later step reads."""


@dataclass(frozen=True)
class _ValueLayout:
    """The place of each value of a program in a list: first the inputs that are read, then constants, then steps.

    `places` has the place of each name and of each constant, `moves` the needed steps, `wanted` the places of the
    wanted values.
    """

    inputs: tuple[str, ...]
    constants: tuple[int, ...]
    places: Mapping[str | int, int]
    moves: tuple[_Move, ...]
    wanted: tuple[int, ...]


@cache
def _layout(program: Program, wanted: tuple[str, ...]) -> _ValueLayout:
    """Assign a place to each value that the wanted names depend on."""
    steps = needed(program, wanted)
    read = {name for step in steps for name in step.reads} | set(wanted)
    inputs = tuple(name for name in program.inputs if name in read)
    constants = sorted({argument for step in steps for argument in step.arguments if isinstance(argument, int)})
    labels: list[str | int] = [*inputs, *constants, *(step.name for step in steps)]
    places = {label: place for place, label in enumerate(labels)}
    last_use = {name: number for number, step in enumerate(steps) for name in step.reads if name not in wanted}
    moves = tuple(
        (
            step.operation,
            tuple(places[argument] for argument in step.arguments),
            places[step.name],
            tuple(places[name] for name in dict.fromkeys(step.reads) if last_use.get(name) == number),
        )
        for number, step in enumerate(steps)
    )
    return _ValueLayout(inputs, tuple(constants), places, moves, tuple(places[name] for name in wanted))


def _operation(arithmetic: Arithmetic, name: str) -> Callable[..., Any]:
    """Return the function of an operation. Raises ValueError where the arithmetic has none."""
    operation = arithmetic.operations.get(name)
    if operation is None:
        raise ValueError(f"{arithmetic.name} arithmetic has no {name}")
    return operation


OPERATORS: Mapping[str, Callable[..., Any]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
    "abs": abs,
    "gt": operator.gt,
    "lt": operator.lt,
    "ge": operator.ge,
    "le": operator.le,
    "eq": operator.eq,
    "ne": operator.ne,
    "and": operator.and_,
    "or": operator.or_,
}
"""The operations that mean the same in every arithmetic. Each one adds its own roots, functions and selection."""


class Undefined:
    """The result of an operation that has no value, such as a division by 0.

    Every operation on it gives it again, and every comparison with it is false but !=.
    """

    def _undefined(self, *_others: object) -> Undefined:
        return self

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = _undefined
    __neg__ = __abs__ = _undefined

    def _false(self, _other: object) -> bool:
        return False

    __lt__ = __le__ = __gt__ = __ge__ = _false

    def __eq__(self, _other: object) -> bool:
        return False

    def __ne__(self, _other: object) -> bool:
        return True

    def __hash__(self) -> int:
        return id(self)

    def __repr__(self) -> str:
        return "undefined"


UNDEFINED = Undefined()


def square_root(number: Any) -> Fraction | QuadraticSurd | Undefined:
    """Return the exact root of a rational number, or UNDEFINED if it is negative.

    Raises TypeError for the root of an irrational number.
    """
    if isinstance(number, Undefined):
        return UNDEFINED
    rational = Fraction(number)
    return UNDEFINED if rational < 0 else exact_root(rational)


EXACT = Arithmetic(
    name="exact",
    convert=Fraction,
    operations={
        **OPERATORS,
        "div": lambda dividend, divisor: UNDEFINED if divisor == 0 else dividend / divisor,
        "sqrt": square_root,
        "not": operator.not_,
        "select": lambda condition, yes, no: yes if condition else no,
    },
)
"""Inputs may be int, Fraction or float (its exact value)."""
