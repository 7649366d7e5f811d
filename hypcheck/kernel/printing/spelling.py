"""How languages write the operations of a program, and the one function that writes them down.

A printer fills in a Spelling; `statements` does the rest. Nothing is reordered, merged or folded: what stands in the
program is what the printed text rounds, and in that order.
"""

from __future__ import annotations

import keyword
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from hypcheck.derivation.program import NUMBER, Argument, Program, Step, kind_of, needed

INFIX = {
    "add": "{0} + {1}",
    "sub": "{0} - {1}",
    "mul": "{0} * {1}",
    "div": "{0} / {1}",
    "neg": "-{0}",
    "gt": "{0} > {1}",
    "lt": "{0} < {1}",
    "ge": "{0} >= {1}",
    "le": "{0} <= {1}",
    "eq": "{0} == {1}",
    "ne": "{0} != {1}",
}
"""The operations that the languages of this folder write alike; {0}, {1} and {2} are the arguments."""

BITWISE = {"and": "{0} & {1}", "or": "{0} | {1}"}
"""Truth values joined without a branch, where a language has that for its type of them."""


@dataclass(frozen=True)
class Spelling:
    """A language, or a dialect of one.

    `operations` has a template for every operation of derivation/program.py. `number` and `boolean` are the types, and
    `declaration` is the template of a statement, with {type}, {name} and {value}. `constant` writes an integer as a
    number of the type. `reserved` are names that a step or an input must not have.
    """

    operations: Mapping[str, str]
    number: str
    boolean: str
    declaration: str
    constant: Callable[[int], str]
    reserved: frozenset[str] = frozenset(keyword.kwlist)


def literal(suffix: str = "") -> Callable[[int], str]:
    """A writer of integers as numbers with a decimal point and the suffix; what is negative stands in parentheses."""

    def constant(value: int) -> str:
        text = f"{abs(value)}.0{suffix}"
        return f"(-{text})" if value < 0 else text

    return constant


def statements(program: Program, wanted: tuple[str, ...], spelling: Spelling) -> tuple[str, ...]:
    """One declaration for each step that the wanted names depend on, in the program's order.

    The inputs are in scope under their own names. Raises KeyError where a wanted name does not exist, and ValueError
    for a name that the language reserves or an operation it has no template for.
    """
    kinds = dict.fromkeys(program.inputs, NUMBER)
    lines = []
    for step in needed(program, wanted):
        kinds[step.name] = kind_of(step, kinds)
        reserved = sorted(spelling.reserved.intersection((step.name, *step.reads)))
        if reserved:
            raise ValueError(f"program {program.name}: step {step.name}: {reserved[0]} is no name in the language")
        lines.append(
            spelling.declaration.format(
                type=spelling.number if kinds[step.name] == NUMBER else spelling.boolean,
                name=step.name,
                value=_value(program, step, spelling),
            )
        )
    return tuple(lines)


def _value(program: Program, step: Step, spelling: Spelling) -> str:
    template = spelling.operations.get(step.operation)
    if template is None:
        raise ValueError(f"program {program.name}: step {step.name}: the language has no {step.operation}")
    return template.format(*(_argument(argument, spelling) for argument in step.arguments))


def _argument(argument: Argument, spelling: Spelling) -> str:
    return argument if isinstance(argument, str) else spelling.constant(argument)
