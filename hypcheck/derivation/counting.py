"""How much work a program is, and which part of it depends on sizes alone and leaves the loop over positions."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from hypcheck.derivation.program import Program, Step

_FIELD_OF = {
    "add": "additions",
    "sub": "additions",
    "mul": "multiplications",
    "div": "divisions",
    "sqrt": "square_roots",
    "cos": "functions",
    "arccos": "functions",
    "gt": "comparisons",
    "lt": "comparisons",
    "ge": "comparisons",
    "le": "comparisons",
    "eq": "comparisons",
    "ne": "comparisons",
    "and": "logical",
    "or": "logical",
    "not": "logical",
    "select": "selections",
}
# neg and abs only touch the sign bit and are not counted.


@dataclass(frozen=True, slots=True)
class Operations:
    """Operations by kind; a subtraction counts as an addition, a sign change as nothing.

    `functions` are cosines and their inverses.
    """

    additions: int = 0
    multiplications: int = 0
    divisions: int = 0
    square_roots: int = 0
    functions: int = 0
    comparisons: int = 0
    logical: int = 0
    selections: int = 0

    @property
    def rounded(self) -> int:
        """Those that round: + − × ÷ √, cos, arccos."""
        return self.additions + self.multiplications + self.divisions + self.square_roots + self.functions


@dataclass(frozen=True, slots=True)
class Hoisting:
    """A program's steps in two parts: those that depend on fixed inputs alone, and those that move with the rest."""

    outside: tuple[Step, ...]
    inside: tuple[Step, ...]


def count(steps: Iterable[Step]) -> Operations:
    """The operations in `steps`."""
    counts: dict[str, int] = {}
    for step in steps:
        field = _FIELD_OF.get(step.operation)
        if field is not None:
            counts[field] = counts.get(field, 0) + 1
    return Operations(**counts)


def hoisted(program: Program, fixed_inputs: Collection[str]) -> Hoisting:
    """The program's steps, parted by whether they depend on `fixed_inputs` (and constants) alone.

    Raises ValueError where one of these is no input of the program.
    """
    unknown = sorted(set(fixed_inputs) - set(program.inputs))
    if unknown:
        raise ValueError(f"program {program.name} has no input {', '.join(unknown)}")
    fixed = set(fixed_inputs)
    outside, inside = [], []
    for step in program.steps:
        if fixed.issuperset(step.reads):
            fixed.add(step.name)
            outside.append(step)
        else:
            inside.append(step)
    return Hoisting(tuple(outside), tuple(inside))
