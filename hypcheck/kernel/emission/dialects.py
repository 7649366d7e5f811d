"""The forms of an emitted kernel in each language: templates, constants, conditions, answers, tables, statements.

In a template ${name} within a line is replaced by its text; on a line of its own, by its lines with the same indent.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import resources

from hypcheck.derivation.program import Program
from hypcheck.derivation.routines import ANSWER, PAIR
from hypcheck.errors import InputError
from hypcheck.kernel.printing.languages import statements_in

_MARK = re.compile(r"^( *)\$\{(\w+)\}$|\$\{(\w+)\}", re.MULTILINE)


def filled(package: str, name: str, parts: Mapping[str, str]) -> str:
    """The template of a package with its marks filled in; text of a part that looks like a mark stays.

    Raises KeyError for a mark that has no part.
    """

    def part(match: re.Match[str]) -> str:
        indent, alone, within = match.groups()
        if within:
            return parts[within]
        return "\n".join(f"{indent}{line}" if line else "" for line in parts[alone].splitlines())

    return _MARK.sub(part, resources.files(package).joinpath("templates", name).read_text(encoding="utf-8"))


@dataclass(frozen=True)
class Dialect:
    """A language: its types of numbers, and its phrases.

    `extension` is that of its source files, `templates` that of its templates, which C and C++ share. `comment` begins
    a line of the head. `numbers` has the type for each format that the language computes in, as printing/languages.py
    has it. `phrases` are templates with {name}, {value}, {condition}, {left} and {right}; the keys are those of
    _C_LIKE. `suffixes` end literals of a format. `axis` has what a kernel's text says besides where it takes an axis:
    how one is declared, given on, read from a row. `exports`: its kernels have functions that a linker sees; the
    others' names are their module's. `by_block`: they have loops over many centres that compilers make vectors of.
    `types` are those of pairs and of answers, `capitals` whether types are CalledSo.
    """

    name: str
    extension: str
    templates: str
    comment: str
    numbers: Mapping[str, str]
    phrases: Mapping[str, str]
    axis: Mapping[str, str]
    suffixes: Mapping[str, str] = field(default_factory=dict)
    exports: bool = False
    by_block: bool = False
    types: Mapping[str, str] = field(default_factory=lambda: {PAIR: "", ANSWER: ""})
    capitals: bool = False

    def number_of(self, precision: str) -> str:
        """The type of numbers for a format; raises InputError where the language has none."""
        if precision not in self.numbers:
            raise InputError(f"{self.name} has no {precision}; it computes in {' or '.join(self.numbers)}")
        return self.numbers[precision]

    def literal(self, value: float, precision: str) -> str:
        """A number of the format, in decimals that read back as that very number."""
        return f"{value!r}{self.suffixes.get(precision, '')}"

    def statements(self, program: Program, wanted: tuple[str, ...], precision: str) -> tuple[str, ...]:
        """The needed part of the program, in numbers of the format; a statement for each step."""
        return statements_in(self.name, program, wanted, number=self.number_of(precision))

    def filled(self, name: str, parts: Mapping[str, str]) -> str:
        """The language's template of that name with its marks filled in, as `filled` does. Raises KeyError."""
        return filled("hypcheck.kernel.emission", f"{name}.{self.templates}.tmpl", parts)

    def say(self, phrase: str, **words: object) -> str:
        """A phrase with its words filled in; {place} is the setting's number and {number} the type of numbers."""
        return self.phrases[phrase].format(**words)


_CHOOSE = (
    "if (has_sizes(sizes, {sizes}){also}) {{\n    *one = position_{place}, *many = many_{place};\n    return TRUE;\n}}"
)

_SUM = "Double-double: the sum of two doubles, the second at most half a unit in the last place of the first."
_DOUBLES_ALONE = """#if FLT_EVAL_METHOD != 0
#error "compile for doubles that are computed as doubles, as with -msse2: double-double rests on it"
#endif
"""

_C_LIKE = {
    "constant": "const {number} {name} = {value};",
    "begin": "static int position_{place}({number} x, {number} y, {number} z{axis})\n{{",
    "end": "}}",
    "return": "return {value};",
    "return if": "if ({condition}) return {value};",
    "if": "if ({condition}) {{",
    "end if": "}}",
    "and": "{left} && {right}",
    "not": "!{value}",
    "select": "{condition} ? {left} : {right}",
    "truth": "{condition}",
    "search": "search(R, zz, height, &setting_{place})",
    "setting": "static const setting setting_{place} = {{{values}}};",
    "frame": "static const frame frame_{place} = {{{values}}};",
    "sizes": "static const sizes_of_frame sizes_{place} = {{{values}}};",
    "fixed search": "tilted_search(x, y, z, &frame_{place})",
    "found": "const int found = {value};",
    "free search": "tilted_search_free(x, y, z, axis[0], axis[1], axis[2], &sizes_{place})",
    "has axis": " && axis[0] == {axis[0]} && axis[1] == {axis[1]} && axis[2] == {axis[2]}",
    "field": ".{name} = {value}",
    "choose": _CHOOSE.replace("TRUE", "1"),
    "note": "/* {text} */",
    "unused": "(void){name};",
    "function": "/* {meaning} */\nstatic {type} {name}({inputs})\n{{",
    "input": "{type} {name}",
    "record": "typedef struct {{\n{fields}\n}} {record};",
    "record field": "{type} {name};",
    "given record": ", const {record} *of",
    "unpack": "const {type} {name} = of->{name};",
    "pair type": f"{_DOUBLES_ALONE}\n/* {_SUM} */\ntypedef struct {{{{\n    double hi, lo;\n}}}} dd;",
    "pair": "(dd){{{high}, {low}}}",
    "high": "{pair}.hi",
    "low": "{pair}.lo",
    "both": "",
    "stored": "const volatile {type} {name} = {value};",
    "opaque": "const volatile {type} {name} = {value};",
    "includes": "#include <math.h>\n#include <stddef.h>\n#include <stdint.h>",
    "linkage": "",
    "end linkage": "",
    "keep": "{number} {name} = {value};",
    "keep on": "{name} = {value};",
    "loop": "for (int round = 0; round < {times}; round++) {{",
    "leave if": "if ({condition}) break;",
    "table": "static const {number} {name}[{rows}][{columns}] = {{\n{body}\n}};",
    "table row": "{{{values}}}",
    "loop over": "for (int round = 0; round < {times}; round++) {{",
    "cell": "const {number} {name} = {table}[round][{index}];",
    "told": "const double told = {value};",
}

_CPP = {
    **_C_LIKE,
    "constant": "constexpr {number} {name} = {value};",
    "search": "search(R, zz, height, setting_{place})",
    "setting": "constexpr Setting setting_{place} = {{{values}}};",
    "frame": "constexpr Frame frame_{place} = {{{values}}};",
    "sizes": "constexpr SizesOfFrame sizes_{place} = {{{values}}};",
    "fixed search": "tilted_search(x, y, z, frame_{place})",
    "free search": "tilted_search_free(x, y, z, axis[0], axis[1], axis[2], sizes_{place})",
    "field": "{value}",
    "choose": _CHOOSE.replace("TRUE", "true"),
    "note": "// {text}",
    "function": "// {meaning}\nstatic {type} {name}({inputs})\n{{",
    "includes": "#include <cmath>\n#include <math.h>\n#include <stddef.h>\n#include <stdint.h>",
    "linkage": 'extern "C" {{',
    "end linkage": "}}",
    "record": "struct {record} {{\n{fields}\n}};",
    "given record": ", const {record} &of",
    "unpack": "const {type} {name} = of.{name};",
    "pair type": f"{_DOUBLES_ALONE}\n// {_SUM}\nstruct dd {{{{\n    double hi, lo;\n}}}};",
    "pair": "{{{high}, {low}}}",
}

_RUST = {
    **_C_LIKE,
    "constant": "const {name}: {number} = {value};",
    "begin": "fn position_{place}(x: {number}, y: {number}, z: {number}{axis}) -> i8 {{",
    "return if": "if {condition} {{\n    return {value};\n}}",
    "if": "if {condition} {{",
    "select": "if {condition} {{ {left} }} else {{ {right} }}",
    "truth": "i8::from({condition})",
    "search": "search(R, zz, height, &SETTING_{place})",
    "setting": "const SETTING_{place}: Setting = Setting {{{values}}};",
    "frame": "const FRAME_{place}: Frame = Frame {{{values}}};",
    "sizes": "const SIZES_{place}: SizesOfFrame = SizesOfFrame {{{values}}};",
    "fixed search": "tilted_search(x, y, z, &FRAME_{place})",
    "found": "let found = {value};",
    "free search": "tilted_search_free(x, y, z, axis[0], axis[1], axis[2], &SIZES_{place})",
    "has axis": " && axis == &[{axis[0]}, {axis[1]}, {axis[2]}]",
    "field": "{name}: {value}",
    "unused": "let _ = {name};",
    "choose": "if has_sizes(sizes, [{sizes}]){also} {{\n    return Some(position_{place});\n}}",
    "note": "// {text}",
    "function": "/// {meaning}\nfn {name}({inputs}) -> {type} {{",
    "input": "{name}: {type}",
    "record": "struct {record} {{\n{fields}\n}}",
    "record field": "{name}: {type},",
    "given record": ", of: &{record}",
    "unpack": "let {name} = of.{name};",
    "pair type": f"/// {_SUM}\n#[derive(Clone, Copy)]\nstruct Dd {{{{\n    hi: f64,\n    lo: f64,\n}}}}",
    "pair": "Dd {{ hi: {high}, lo: {low} }}",
    "stored": "let {name} = {value};",
    "opaque": "let {name} = std::hint::black_box({value});",
    "keep": "let mut {name} = {value};",
    "loop": "for _ in 0..{times} {{",
    "leave if": "if {condition} {{\n    break;\n}}",
    "table": "static {name}: [[{number}; {columns}]; {rows}] = [\n{body}\n];",
    "table row": "[{values}]",
    "loop over": "for row in &{table} {{",
    "cell": "let {name} = row[{index}];",
    "told": "let told = {value};",
}

_JAVASCRIPT = {
    **_C_LIKE,
    "constant": "const {name} = {value};",
    "begin": "function position_{place}(x, y, z{axis}) {{",
    "truth": "{condition} ? 1 : 0",
    "search": "search(R, zz, height, setting_{place})",
    "setting": "const setting_{place} = {{{values}}};",
    "frame": "const frame_{place} = {{{values}}};",
    "sizes": "const sizes_{place} = {{{values}}};",
    "fixed search": "tilted_search(x, y, z, frame_{place})",
    "found": "const found = {value};",
    "free search": "tilted_search_free(x, y, z, axis[0], axis[1], axis[2], sizes_{place})",
    "has axis": " && axisX === {axis[0]} && axisY === {axis[1]} && axisZ === {axis[2]}",
    "field": "{name}: {value}",
    "unused": "",
    "choose": "if (alpha === {of[0]} && gamma === {of[1]} && b === {of[2]} && d === {of[3]}{also}) "
    "return position_{place};",
    "note": "// {text}",
    "function": "/** {meaning} */\nfunction {name}({inputs}) {{",
    "input": "{name}",
    "pair type": f"// {_SUM}",
    "pair": "[{high}, {low}]",
    "high": "{pair}[0]",
    "low": "{pair}[1]",
    "stored": "const {name} = {value};",
    "opaque": "const {name} = new Float64Array([{value}])[0];",
    "record": "",
    "record field": "",
    "given record": ", {{ {inputs} }}",
    "unpack": "",
    "keep": "let {name} = {value};",
    "told": "const told = {value};",
    "table": "const {name} = [\n{body}\n];",
    "table row": "[{values}]",
    "loop over": "for (const row of {table}) {{",
    "cell": "const {name} = row[{index}];",
    "loop": "for (let round = 0; round < {times}; round++) {{",
}

_PYTHON = {
    "constant": "{name} = {value}",
    "begin": "def position_{place}(x: float, y: float, z: float{axis}) -> int:",
    "end": "",
    "return": "return {value}",
    "return if": "if {condition}:\n    return {value}",
    "if": "if {condition}:",
    "end if": "",
    "and": "{left} and {right}",
    "not": "not {value}",
    "select": "{left} if {condition} else {right}",
    "truth": "int({condition})",
    "search": "search(R, zz, height, *SETTING_{place})",
    "setting": "SETTING_{place} = ({values})",
    "frame": "FRAME_{place} = ({values})",
    "sizes": "SIZES_{place} = ({values})",
    "fixed search": "tilted_search(x, y, z, *FRAME_{place})",
    "found": "found = {value}",
    "free search": "tilted_search_free(x, y, z, axis[0], axis[1], axis[2], *SIZES_{place})",
    "has axis": ", {axis[0]}, {axis[1]}, {axis[2]}",
    "field": "{value}",
    "choose": "({sizes}{also}): position_{place},",
    "note": "# {text}",
    "unused": "",
    "function": 'def {name}({inputs}) -> {type}:\n    """{meaning}"""',
    "input": "{name}: {type}",
    "pair type": f'DoubleDouble = tuple[float, float]\n"""{_SUM}"""',
    "pair": "{high}, {low}",
    "high": "{pair}[0]",
    "low": "{pair}[1]",
    "both": "{high}, {low} = {pair}",
    "stored": "{name} = {value}",
    "opaque": "{name} = {value}",
    "record": "",
    "record field": "",
    "given record": ", {inputs}",
    "unpack": "",
    "keep": "{name} = {value}",
    "keep on": "{name} = {value}",
    "loop": "for _ in range({times}):",
    "leave if": "if {condition}:\n    break",
    "table": "{name} = (\n{body}\n)",
    "table row": "({values},)",
    "loop over": "for row in {table}:",
    "cell": "{name} = row[{index}]",
    "told": "told = {value}",
}


_C_AXIS = {
    "checked": " && has_direction(axis[0], axis[1], axis[2])",
    "checked_row": " && has_direction(row[7], row[8], row[9])",
    "axis": ", const double axis[3]",
    "given": ", axis",
    "row": ", row + 7",
    "header": "#include <float.h>\n",
}
_RUST_AXIS = {
    "checked": ".filter(|_| has_direction(axis[0], axis[1], axis[2]))",
    "axis": ", axis: &[f64; 3]",
    "given": ", axis",
    "row": ", &[row[7], row[8], row[9]]",
    "type": ", &[f64; 3]",
    "columns": ", axis_x, axis_y, axis_z",
    "pointer": "axis: *const f64, ",
    "safety": "`axis` 3, ",
    "read": "let axis = &*axis.cast::<[f64; 3]>();\n    ",
}
_JAVASCRIPT_AXIS = {
    "checked": " && has_direction(axisX, axisY, axisZ)",
    "axis": ", axis",
    "given": ", axis",
    "row": ", [axisX, axisY, axisZ]",
    "names": ", axisX, axisY, axisZ",
}
_PYTHON_AXIS = {
    "checked": " or not has_direction(axis_x, axis_y, axis_z)",
    "axis": ", axis: tuple[float, float, float]",
    "given": ", axis",
    "row": ", (axis_x, axis_y, axis_z)",
    "names": ", axis_x, axis_y, axis_z",
    "open": "\n    ",
    "parameters": ",\n    axis_x: float, axis_y: float, axis_z: float,\n",
}


_C_TYPES, _RUST_TYPES = {PAIR: "dd", ANSWER: "int"}, {PAIR: "Dd", ANSWER: "i8"}
_PYTHON_TYPES = {PAIR: "DoubleDouble", ANSWER: "int"}
_C_NUMBERS = {"float64": "double", "float32": "float"}
_C_SUFFIXES = {"float32": "F"}
_RUST_NUMBERS = {"float64": "f64", "float32": "f32"}
_JAVASCRIPT_NUMBERS = {"float64": "number", "float32": "float32"}

DIALECTS = {
    dialect.name: dialect
    for dialect in (
        Dialect("c", "c", "c", " * ", _C_NUMBERS, _C_LIKE, _C_AXIS, _C_SUFFIXES, True, True, _C_TYPES),
        Dialect("cpp", "cpp", "c", " * ", _C_NUMBERS, _CPP, _C_AXIS, _C_SUFFIXES, True, True, _C_TYPES, capitals=True),
        Dialect(
            "rust", "rs", "rs", "//! ", _RUST_NUMBERS, _RUST, _RUST_AXIS, {}, True, False, _RUST_TYPES, capitals=True
        ),
        Dialect("javascript", "mjs", "mjs", "// ", _JAVASCRIPT_NUMBERS, _JAVASCRIPT, _JAVASCRIPT_AXIS),
        Dialect("python", "py", "py", "", {"float64": "float"}, _PYTHON, _PYTHON_AXIS, types=_PYTHON_TYPES),
    )
}
"""By name: what `emit --language` takes."""
