"""C99: a `const` declaration a step, in an order and a form that a compiler may vectorise and must not rearrange.

Compile without -ffast-math. Contraction (FMA) leaves roundings out; where results must be the same to the bit,
-ffp-contract=off, and a machine that evaluates in the type itself (FLT_EVAL_METHOD 0, as everywhere but on x87).

Truth values are `int`, joined by & and |, so that no step is a branch. gcc 12 makes vectors of such a loop at -O3 with
-fno-trapping-math -fno-math-errno; for SSE2 alone it asks in addition for an answer selected and stored as a number,
narrowed in a loop of its own.
"""

from __future__ import annotations

from functools import cache

from hypcheck.derivation.program import Program
from hypcheck.kernel.printing.spelling import BITWISE, INFIX, Spelling, literal, statements

SUFFIXES = {"double": "", "float": "f", "long double": "l"}
"""What ends the name of a function of math.h for each type of numbers, and, in upper case, a literal."""

_KEYWORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int long register
restrict return short signed sizeof static struct switch typedef union unsigned void volatile while I NULL
"""


def c_statements(program: Program, wanted: tuple[str, ...], *, number: str = "double") -> tuple[str, ...]:
    """The needed part of the program as C99: one declaration a step, `const double name = left + right;`.

    The inputs are in scope under their own names, as `number`s ("double", "float" or "long double"); truth values are
    int. `abs` and `sqrt` need math.h. Raises ValueError for another type and for names that C reserves, and KeyError
    where a wanted name does not exist.
    """
    if number not in SUFFIXES:
        raise ValueError(f"no C type of numbers {number!r}; there are {', '.join(SUFFIXES)}")
    return statements(program, wanted, _spelling(number))


@cache
def _spelling(number: str) -> Spelling:
    suffix = SUFFIXES[number]
    return Spelling(
        operations={
            **INFIX,
            **BITWISE,
            "not": "!{0}",
            "abs": f"fabs{suffix}({{0}})",
            "sqrt": f"sqrt{suffix}({{0}})",
            "select": "{0} ? {1} : {2}",
        },
        number=number,
        boolean="int",
        declaration="const {type} {name} = {value};",
        constant=literal(suffix.upper()),
        reserved=frozenset(_KEYWORDS.split()),
    )
