"""How many operations a program takes, by kind."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from hypcheck.derivation.program import Step

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


def count(steps: Iterable[Step]) -> Operations:
    """The operations in `steps`."""
    counts: dict[str, int] = {}
    for step in steps:
        field = _FIELD_OF.get(step.operation)
        if field is not None:
            counts[field] = counts.get(field, 0) + 1
    return Operations(**counts)
