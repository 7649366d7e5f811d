"""JavaScript: a `const` a step. Its numbers are binary64; binary32 is that rounded once more by Math.fround.

Rounding twice is rounding once for + − × ÷ √ of binary32 numbers, since 53 ≥ 2·24 + 2.
"""

from __future__ import annotations

from functools import cache

from hypcheck.derivation.program import NUMBER, OPERATIONS, Program
from hypcheck.kernel.printing.spelling import INFIX, Spelling, literal, statements

NUMBERS = ("number", "float32")

_EXACT = frozenset({"neg", "abs", "select"})
"""Operations that round nothing, whatever the format."""

_KEYWORDS = """
arguments await break case catch class const continue debugger default delete do else enum eval export extends false
finally for function if implements import in instanceof interface let new null package private protected public return
static super switch this throw true try typeof undefined var void while with yield Infinity NaN
"""


def javascript_statements(program: Program, wanted: tuple[str, ...], *, number: str = "number") -> tuple[str, ...]:
    """The needed part of the program: one `const name = left + right;` a step.

    The inputs are in scope under their own names: numbers, and of binary32 where `number` is "float32" rather than
    "number"; truth values are booleans. Raises ValueError for another type and for names that JavaScript reserves, and
    KeyError where a wanted name does not exist.
    """
    if number not in NUMBERS:
        raise ValueError(f"no JavaScript format of numbers {number!r}; there are {', '.join(NUMBERS)}")
    return statements(program, wanted, _spelling(number))


@cache
def _spelling(number: str) -> Spelling:
    operations = {
        **INFIX,
        "eq": "{0} === {1}",
        "ne": "{0} !== {1}",
        "and": "{0} && {1}",
        "or": "{0} || {1}",
        "not": "!{0}",
        "abs": "Math.abs({0})",
        "sqrt": "Math.sqrt({0})",
        "select": "{0} ? {1} : {2}",
    }
    if number == "float32":
        for name, operation in OPERATIONS.items():
            if operation.gives == NUMBER and name not in _EXACT:
                operations[name] = f"Math.fround({operations[name]})"
    return Spelling(
        operations=operations,
        number="",
        boolean="",
        declaration="const {name} = {value};",
        constant=literal(),
        reserved=frozenset(_KEYWORDS.split()),
    )
