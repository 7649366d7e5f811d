"""Rust: a `let` a step. Its arithmetic is that of the type itself on every platform, and nothing is contracted."""

from __future__ import annotations

from functools import cache

from hypcheck.derivation.program import Program
from hypcheck.kernel.printing.spelling import BITWISE, INFIX, Spelling, statements

NUMBERS = ("f64", "f32")

_KEYWORDS = """
Self abstract as async await become box break const continue crate do dyn else enum extern false final fn for gen if
impl in let loop macro match mod move mut override priv pub ref return self static struct super trait true try type
typeof unsafe unsized use virtual where while yield
"""


def rust_statements(program: Program, wanted: tuple[str, ...], *, number: str = "f64") -> tuple[str, ...]:
    """The needed part of the program: one `let name: f64 = left + right;` a step.

    The inputs are in scope under their own names, as `number`s ("f64" or "f32"); truth values are bool. A lint that
    wants snake_case has to allow A, B, P and Q. Raises ValueError for another type and for names that Rust reserves,
    and KeyError where a wanted name does not exist.
    """
    if number not in NUMBERS:
        raise ValueError(f"no Rust type of numbers {number!r}; there are {', '.join(NUMBERS)}")
    return statements(program, wanted, _spelling(number))


@cache
def _spelling(number: str) -> Spelling:
    return Spelling(
        operations={
            **INFIX,
            **BITWISE,
            "not": "!{0}",
            "neg": "-({0})",
            "abs": f"{number}::abs({{0}})",
            "sqrt": f"{number}::sqrt({{0}})",
            "select": "if {0} {{ {1} }} else {{ {2} }}",
        },
        number=number,
        boolean="bool",
        declaration="let {name}: {type} = {value};",
        constant=lambda value: f"{value}.0_{number}",  # parentheses around a negative one would be warned of
        reserved=frozenset(_KEYWORDS.split()),
    )
