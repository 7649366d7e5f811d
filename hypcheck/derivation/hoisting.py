"""Taking out of the loop what does not change in it, as the paper's Table 2 does with the sizes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from hypcheck.derivation.evaluation import Arithmetic, outputs
from hypcheck.derivation.program import NUMBER, Program, cut, kind_of, needed


def hoisted(
    program: Program, arithmetic: Arithmetic, constants: Mapping[str, Any], wanted: Iterable[str]
) -> Callable[[Mapping[str, Any]], tuple[Any, ...]]:
    """The loop's body: from the other inputs to the wanted names, as evaluation.outputs gives them, bit for bit.

    Every number that depends on the constants alone is computed here, once. The constants may be arrays (the sizes of
    many trees). Raises KeyError where a wanted name does not exist, and so does the body where an input is missing.
    """
    names = tuple(wanted)
    fixed = _fixed(program, constants, names)
    with arithmetic.guard():
        values = {name: arithmetic.convert(value) for name, value in constants.items()}
    values |= dict(zip(fixed, outputs(program, arithmetic, constants, fixed), strict=True))
    return _body(cut(program, (*constants, *fixed), names), arithmetic, values, names)


def _fixed(program: Program, constants: Iterable[str], wanted: tuple[str, ...]) -> list[str]:
    """The needed steps that depend on the constants alone; a comparison stays in the loop, as inputs are numbers."""
    kinds = dict.fromkeys(program.inputs, NUMBER)
    known = set(constants)
    fixed = []
    for step in needed(program, wanted):
        kinds[step.name] = kind_of(step, kinds)
        if known.issuperset(step.reads) and kinds[step.name] == NUMBER:
            known.add(step.name)
            fixed.append(step.name)
    return fixed


def _body(
    program: Program, arithmetic: Arithmetic, values: Mapping[str, Any], names: tuple[str, ...]
) -> Callable[[Mapping[str, Any]], tuple[Any, ...]]:
    """The program with every name looked up beforehand: short loops over small arrays spend their time on names."""
    places: dict[str | int, int] = {}
    cells: list[Any] = []

    def place(argument: str | int) -> int:
        if argument not in places:
            places[argument] = len(cells)
            constant = isinstance(argument, int)
            cells.append(arithmetic.convert(argument) if constant else values.get(str(argument)))
        return places[argument]

    steps = [
        (arithmetic.operations[step.operation], [place(argument) for argument in step.arguments], place(step.name))
        for step in program.steps
    ]
    varying = [(name, place(name)) for name in program.inputs if name not in values]
    results = [place(name) for name in names]

    def run(inputs: Mapping[str, Any]) -> tuple[Any, ...]:
        held = cells.copy()
        with arithmetic.guard():
            for name, at in varying:
                held[at] = arithmetic.convert(inputs[name])
            for operation, arguments, at in steps:
                held[at] = operation(*[held[argument] for argument in arguments])
        return tuple(held[at] for at in results)

    return run
