"""Python: an assignment a step, in binary64, the only format its floats have.

Unlike the other languages, Python raises ZeroDivisionError and ValueError where IEEE 754 gives an infinity or a NaN: a
caller divides by nothing that can be zero, and takes no root of what can be negative.
"""

from __future__ import annotations

from hypcheck.derivation.program import Program
from hypcheck.kernel.printing.spelling import INFIX, Spelling, literal, statements

_SPELLING = Spelling(
    operations={
        **INFIX,
        "and": "{0} and {1}",
        "or": "{0} or {1}",
        "not": "not {0}",
        "abs": "abs({0})",
        "sqrt": "math.sqrt({0})",
        "select": "{1} if {0} else {2}",
    },
    number="float",
    boolean="bool",
    declaration="{name} = {value}",
    constant=literal(),
)


def python_statements(program: Program, wanted: tuple[str, ...]) -> tuple[str, ...]:
    """The needed part of the program: one `name = left + right` a step.

    The inputs are in scope under their own names, as floats; truth values are bool. `sqrt` needs `import math`. Raises
    ValueError for names that Python reserves, and KeyError where a wanted name does not exist.
    """
    return statements(program, wanted, _SPELLING)
