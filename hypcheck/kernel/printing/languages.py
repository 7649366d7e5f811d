"""Prints programs in C, C++, Rust, JavaScript and Python.

Each language fills in a Spelling, from which `statements` prints. Nothing is reordered, merged or computed in advance:
the printed text rounds exactly the operations of the program, in their order.

C99: a `const` declaration for each step, in an order and a form that a compiler may vectorise and must not rearrange.
Compile without -ffast-math. Contraction (FMA) leaves roundings out; where results must be the same to the bit,
-ffp-contract=off, and a machine that evaluates in the type itself (FLT_EVAL_METHOD 0, as everywhere but on x87). Truth
values are `int`, joined by & and |, so that no step is a branch. gcc 12 makes vectors of such a loop at -O3 with
-fno-trapping-math -fno-math-errno; for SSE2 alone, the answer must in addition be selected and stored as a number,
which another loop narrows.

C++11 and later: as C99, with `bool` for truth values and the overloads of <cmath>.

Rust: a `let` for each step. Its arithmetic is that of the type itself on every platform, and nothing is contracted.

JavaScript: a `const` for each step. Its numbers are binary64; binary32 is that rounded once more by Math.fround.
Rounding twice is rounding once for + − × ÷ √ of binary32 numbers, since 53 ≥ 2·24 + 2.

Python: an assignment for each step, in binary64, the only format its floats have. Unlike the other languages, Python
raises ZeroDivisionError and ValueError where IEEE 754 gives an infinity or a NaN: a program for Python must not divide
by a number that can be zero, or take the root of one that can be negative.
"""

from __future__ import annotations

import keyword
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, partial

from hypcheck.derivation.program import NUMBER, OPERATIONS, Argument, Program, Step, kind_of, needed

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
"""The operations that join truth values without a branch, for languages that have them."""


@dataclass(frozen=True)
class Spelling:
    """How a language writes programs with one type of numbers.

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
    """Return a function that writes an integer with a decimal point and the suffix, a negative one in parentheses."""

    def constant(value: int) -> str:
        text = f"{abs(value)}.0{suffix}"
        return f"(-{text})" if value < 0 else text

    return constant


def statements(program: Program, wanted: tuple[str, ...], spelling: Spelling) -> tuple[str, ...]:
    """Return one declaration for each step that the wanted names depend on, in the program's order.

    The inputs are in scope under their own names. Raises KeyError where a wanted name does not exist, and ValueError
    for a name that the language reserves or an operation it has no template for.
    """
    kinds = dict.fromkeys(program.inputs, NUMBER)
    lines = []
    for step in needed(program, wanted):
        kinds[step.name] = kind_of(step, kinds)
        reserved = sorted(spelling.reserved.intersection((step.name, *step.reads)))
        if reserved:
            raise ValueError(f"program {program.name}: step {step.name}: {reserved[0]} is not a name in the language")
        if step.operation not in spelling.operations:
            raise ValueError(f"program {program.name}: step {step.name}: the language has no {step.operation}")
        kind = spelling.number if kinds[step.name] == NUMBER else spelling.boolean
        lines.append(spelling.declaration.format(type=kind, name=step.name, value=value_of(step, spelling)))
    return tuple(lines)


def value_of(step: Step, spelling: Spelling) -> str:
    """Return the expression of a step. Raises KeyError for an operation without a template in this language."""
    return spelling.operations[step.operation].format(*(argument_of(argument, spelling) for argument in step.arguments))


def argument_of(argument: Argument, spelling: Spelling) -> str:
    """Return a name, or an integer as the language writes it."""
    return argument if isinstance(argument, str) else spelling.constant(argument)


NUMBERS = {
    "c": ("double", "float", "long double"),
    "cpp": ("double", "float"),
    "rust": ("f64", "f32"),
    "javascript": ("number", "float32"),
    "python": ("float",),
}
"""The types of numbers of each language; the first is that of binary64."""


def statements_in(
    language: str, program: Program, wanted: tuple[str, ...], *, number: str | None = None
) -> tuple[str, ...]:
    """Return the needed steps of the program in a language of NUMBERS, as declarations: `const double a = x + y;`.

    The inputs are in scope under their own names, as `number`s, by default of binary64. `abs` and `sqrt` need math.h in
    C, <cmath> in C++ and `import math` in Python; a lint of Rust that wants snake_case has to allow A, B, P and Q.
    Raises ValueError for another type and for names that the language reserves, and KeyError where a wanted name does
    not exist.
    """
    numbers = NUMBERS[language]
    if number is not None and number not in numbers:
        raise ValueError(f"{language} has no type of numbers {number!r}; it has {', '.join(numbers)}")
    return statements(program, wanted, spelling_of(language, number or numbers[0]))


c_statements = partial(statements_in, "c")


@cache
def spelling_of(language: str, number: str) -> Spelling:
    """Return the spelling of a language for this type of numbers."""
    return _SPELLINGS[language](number)


C_SUFFIXES = {"double": "", "float": "f", "long double": "l"}
"""What ends the name of a function of math.h for each type of numbers, and, in upper case, a literal."""

_C_KEYWORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int long register
restrict return short signed sizeof static struct switch typedef union unsigned void volatile while I NULL
"""

_C_LIKE = {**INFIX, **BITWISE, "not": "!{0}", "select": "{0} ? {1} : {2}"}


def _c(number: str) -> Spelling:
    """Return the spelling of C."""
    suffix = C_SUFFIXES[number]
    return Spelling(
        operations={**_C_LIKE, "abs": f"fabs{suffix}({{0}})", "sqrt": f"sqrt{suffix}({{0}})"},
        number=number,
        boolean="int",
        declaration="const {type} {name} = {value};",
        constant=literal(suffix.upper()),
        reserved=frozenset(_C_KEYWORDS.split()),
    )


_CPP_KEYWORDS = """
alignas alignof and and_eq asm auto bitand bitor bool break case catch char class compl const constexpr const_cast
continue decltype default delete do double dynamic_cast else enum explicit export extern false float for friend goto if
inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public register
reinterpret_cast return short signed sizeof static static_assert static_cast struct switch template this thread_local
throw true try typedef typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq
"""


def _cpp(number: str) -> Spelling:
    """Return the spelling of C++."""
    return Spelling(
        operations={**_C_LIKE, "abs": "std::abs({0})", "sqrt": "std::sqrt({0})"},
        number=number,
        boolean="bool",
        declaration="const {type} {name} = {value};",
        constant=literal(C_SUFFIXES[number].upper()),
        reserved=frozenset(_CPP_KEYWORDS.split()),
    )


_RUST_KEYWORDS = """
Self abstract as async await become box break const continue crate do dyn else enum extern false final fn for gen if
impl in let loop macro match mod move mut override priv pub ref return self static struct super trait true try type
typeof unsafe unsized use virtual where while yield
"""


def _rust(number: str) -> Spelling:
    """Return the spelling of Rust."""
    operations = {
        "neg": "-({0})",
        "abs": f"{number}::abs({{0}})",
        "sqrt": f"{number}::sqrt({{0}})",
        "select": "if {0} {{ {1} }} else {{ {2} }}",
    }
    return Spelling(
        operations={**_C_LIKE, **operations},
        number=number,
        boolean="bool",
        declaration="let {name}: {type} = {value};",
        constant=lambda value: f"{value}.0_{number}",  # parentheses around a negative one would be warned of
        reserved=frozenset(_RUST_KEYWORDS.split()),
    )


_JAVASCRIPT_EXACT = frozenset({"neg", "abs", "select"})
"""Operations that round nothing, whatever the format."""

_JAVASCRIPT_KEYWORDS = """
arguments await break case catch class const continue debugger default delete do else enum eval export extends false
finally for function if implements import in instanceof interface let new null package private protected public return
static super switch this throw true try typeof undefined var void while with yield Infinity NaN
"""


def _javascript(number: str) -> Spelling:
    """Return the spelling of JavaScript."""
    operations = {
        **_C_LIKE,
        "eq": "{0} === {1}",
        "ne": "{0} !== {1}",
        "and": "{0} && {1}",
        "or": "{0} || {1}",
        "abs": "Math.abs({0})",
        "sqrt": "Math.sqrt({0})",
    }
    if number == "float32":
        for name, operation in OPERATIONS.items():
            if operation.gives == NUMBER and name not in _JAVASCRIPT_EXACT:
                operations[name] = f"Math.fround({operations[name]})"
    return Spelling(
        operations=operations,
        number="",
        boolean="",
        declaration="const {name} = {value};",
        constant=literal(),
        reserved=frozenset(_JAVASCRIPT_KEYWORDS.split()),
    )


def _python(number: str) -> Spelling:
    """Return the spelling of Python."""
    operations = {
        "and": "{0} and {1}",
        "or": "{0} or {1}",
        "not": "not {0}",
        "abs": "abs({0})",
        "sqrt": "math.sqrt({0})",
        "select": "{1} if {0} else {2}",
    }
    return Spelling({**INFIX, **operations}, number, "bool", "{name} = {value}", literal())


_SPELLINGS: dict[str, Callable[[str], Spelling]] = {
    "c": _c,
    "cpp": _cpp,
    "rust": _rust,
    "javascript": _javascript,
    "python": _python,
}
