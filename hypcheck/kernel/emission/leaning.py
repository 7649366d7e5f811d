"""The text of the last stage of a kernel for a spheroid whose axis leans: double-double, frame, search, decision."""

from __future__ import annotations

from dataclasses import replace

from hypcheck.derivation.program import Program
from hypcheck.kernel.emission.dialects import Dialect
from hypcheck.kernel.printing.languages import Spelling, statements
from hypcheck.kernel.specialise import leaning
from hypcheck.kernel.specialise.leaning_search import DoubleDouble, LeaningSearch

_CALLS = {
    "add": "dd_add({0}, {1})",
    "sub": "dd_sub({0}, {1})",
    "mul": "dd_mul({0}, {1})",
    "div": "dd_div({0}, {1})",
    "neg": "dd_neg({0})",
    "abs": "dd_abs({0})",
    "sqrt": "dd_sqrt({0})",
    "gt": "{0}.hi > {1}.hi",
    "lt": "{0}.hi < {1}.hi",
    "select": "{0} ? {1} : {2}",
}


def _whole(value: int) -> str:
    return f"whole({value}.0)"


_C = Spelling(_CALLS, "dd", "int", "const {type} {name} = {value};", _whole)
_PARTS = {"gt": "{0}[0] > {1}[0]", "lt": "{0}[0] < {1}[0]"}

SPELLINGS = {
    "c": _C,
    "cpp": replace(_C, boolean="bool"),
    "rust": replace(
        _C,
        operations={**_CALLS, "select": "if {0} {{ {1} }} else {{ {2} }}"},
        number="Dd",
        boolean="bool",
        declaration="let {name}: {type} = {value};",
    ),
    "javascript": replace(_C, operations={**_CALLS, **_PARTS}, declaration="const {name} = {value};"),
    "python": replace(
        _C, operations={**_CALLS, **_PARTS, "select": "{1} if {0} else {2}"}, declaration="{name} = {value}"
    ),
}
"""How each language writes a program in double-double: calls of functions that its template has."""

_PAIRS = {"c": "{{{0}, {1}}}", "cpp": "{{{0}, {1}}}", "rust": "Dd {{ hi: {0}, lo: {1} }}", "python": "({0}, {1})"}


def table(of: LeaningSearch, place: int, dialect: Dialect) -> str:
    """The constants of a setting: its frame, or what a free axis' frame is made of."""
    fields = [(name, _pair(value, dialect)) for name, value in of.constants.items()]
    fields += [(name, dialect.literal(value, "float64")) for name, value in (("most", of.most), ("omega", of.omega))]
    values = ",\n    ".join(dialect.say("field", name=name, value=value) for name, value in fields)
    return dialect.say("sizes" if of.free else "frame", place=place, values=f"\n    {values},\n")


def _pair(value: DoubleDouble, dialect: Dialect) -> str:
    high, low = (dialect.literal(part, "float64") for part in value)
    return _PAIRS.get(dialect.name, "[{0}, {1}]").format(high, low)


def parts(dialect: Dialect) -> dict[str, str]:
    """What the marks of the templates leaning.* and free.* stand for."""

    def doubles(program: Program, *wanted: str) -> str:
        return "\n".join(dialect.statements(program, wanted, "float64"))

    def double_doubles(program: Program, *wanted: str) -> str:
        return "\n".join(statements(program, wanted, SPELLINGS[dialect.name]))

    return {
        "components": double_doubles(leaning.COMPONENTS, "c1", "c2", "c3"),
        "lambda": double_doubles(leaning.LAMBDA, "lambda_"),
        "phi": double_doubles(leaning.PHI, "phi", "to_a1", "to_a2", "to_b"),
        "place": doubles(leaning.PLACE, "to_a1", "to_a2", "to_b"),
        "falls": doubles(leaning.falls(), "past"),
        "decision": doubles(leaning.DECISION, "clear", "contact"),
        "frame": double_doubles(leaning.FRAME, *leaning.FRAME_NAMES),
        "constants": "\n".join(
            dialect.say("constant", number=dialect.number_of("float64"), name=name, value=repr(value))
            for name, value in leaning.DECISION_CONSTANTS.items()
        ),
        "start": repr(leaning.START),
        "steps": str(leaning.GEOMETRIC_STEPS + leaning.ARITHMETIC_STEPS),
        "geometric_steps": str(leaning.GEOMETRIC_STEPS),
        "rows": _fields(leaning.ROWS),
        "frame_names": _fields(leaning.FRAME_NAMES),
        "size_names": _fields(leaning.SIZE_NAMES),
        "frame_fields": "\n".join(f"{name}: Dd," for name in leaning.FRAME_NAMES),
        "size_fields": "\n".join(f"{name}: Dd," for name in leaning.SIZE_NAMES),
    }


def _fields(names: tuple[str, ...]) -> str:
    return ", ".join(names)
