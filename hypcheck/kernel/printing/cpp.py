"""C++11 and later: as C99, with `bool` for truth values and the overloads of <cmath>.

Compile without -ffast-math; what printing/c.py says about contraction holds here too.
"""

from __future__ import annotations

from functools import cache

from hypcheck.derivation.program import Program
from hypcheck.kernel.printing.spelling import BITWISE, INFIX, Spelling, literal, statements

SUFFIXES = {"double": "", "float": "F"}
"""What ends a literal of each type of numbers."""

_KEYWORDS = """
alignas alignof and and_eq asm auto bitand bitor bool break case catch char class compl const constexpr const_cast
continue decltype default delete do double dynamic_cast else enum explicit export extern false float for friend goto if
inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public register
reinterpret_cast return short signed sizeof static static_assert static_cast struct switch template this thread_local
throw true try typedef typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq
"""


def cpp_statements(program: Program, wanted: tuple[str, ...], *, number: str = "double") -> tuple[str, ...]:
    """The needed part of the program: one declaration a step, `const double name = left + right;`.

    The inputs are in scope under their own names, as `number`s ("double" or "float"); truth values are bool. `abs` and
    `sqrt` need <cmath>. Raises ValueError for another type and for names that C++ reserves, and KeyError where a wanted
    name does not exist.
    """
    if number not in SUFFIXES:
        raise ValueError(f"no C++ type of numbers {number!r}; there are {', '.join(SUFFIXES)}")
    return statements(program, wanted, _spelling(number))


@cache
def _spelling(number: str) -> Spelling:
    return Spelling(
        operations={
            **INFIX,
            **BITWISE,
            "not": "!{0}",
            "abs": "std::abs({0})",
            "sqrt": "std::sqrt({0})",
            "select": "{0} ? {1} : {2}",
        },
        number=number,
        boolean="bool",
        declaration="const {type} {name} = {value};",
        constant=literal(SUFFIXES[number]),
        reserved=frozenset(_KEYWORDS.split()),
    )
