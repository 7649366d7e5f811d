"""The printed C of hypcheck.h as Coq's own text, and changes of it that Coq must refuse.

Steps.v reads the text between two marks of the header into steps, and Printed.v compares them with the programs. A
change is one word of one line: a constant, an operation or a name. Those that mean the same, a product with its factors
in the other order, are not made.
"""

from __future__ import annotations

import random
import re
from collections.abc import Iterator
from pathlib import Path

HEADER = Path(__file__).parents[1] / "kernel" / "core" / "hypcheck.h"

_PART = re.compile(
    r'^ */\* printed from the program "([^"]+)"(?:, the bits counted from it|(, [^*]*?))? \*/\n'
    r"(.*?)^ */\* end of the program",
    re.MULTILINE | re.DOTALL,
)
_BOUND = re.compile(r"^#define HC_(?:fixed_)?(coefficient|pole|delta|middle|MOST_GROWN) (\d+)$", re.MULTILINE)
_SUMS_AND_PRODUCTS = (
    *("hc_fixed_full", "hc_fixed_full_signed", "hc_fixed_plus", "hc_fixed_minus", "hc_fixed_negative"),
    *("hc_fixed_product", "hc_fixed_signed_product", "hc_fixed_both_signed_product", "hc_fixed_square"),
    *("hc_long_product", "hc_long_sum", "hc_long_signed_product"),
)
_SHIFTS_AND_SIGNS = (
    *("hc_highest_bit", "hc_fixed_up", "hc_fixed_down", "hc_fixed_times", "hc_fixed_bits", "hc_fixed_sign"),
    *("hc_long_is_zero", "hc_long_is_negative"),
)
FUNCTIONS = (*_SUMS_AND_PRODUCTS, *_SHIFTS_AND_SIGNS)
"""The functions of the header that compute with numbers of 128 and 256 bits."""

_FIXED_TERMS = ("hc_fixed_whole", "hc_fixed_terms_of")
_FIXED_ANSWERS = ("hc_fixed_cubic_of", "hc_fixed_at_B", "hc_fixed_at_A", "hc_fixed_position")
_BY_INTEGERS = ("hc_least", "hc_position_by_integers")
_STAGE_BY_STAGE = ("hc_exact_position", "hc_position_of")
DECIDING = (*_FIXED_TERMS, *_FIXED_ANSWERS, *_BY_INTEGERS, *_STAGE_BY_STAGE)
"""The functions of the header that decide: with branches, shift counts and calls."""

_SIZES = ("hc_compare_sizes", "hc_add_sizes", "hc_subtract_sizes", "hc_combine", "hc_add", "hc_subtract")
_PRODUCTS = ("hc_add_row", "hc_multiply", "hc_scale")
INTEGERS = (*_SIZES, *_PRODUCTS, "hc_in_units")
"""The functions of the header that compute with long integers."""

ROOM = "HC_INTEGER"
"""The macro that declares a long integer: how many limbs it has room for is read as a function of its bits."""

OF_DOUBLES = ("hc_parts_of", "hc_fixed_parts_of", "hc_valid")
"""The functions of the header that read the bits of doubles."""

BESIDE_TANGENCY = (
    *("hc_position_in_plane", "hc_touches_by_short", "hc_touches_by"),
    "hc_position_beside_tangency",
)
"""The functions of the header that decide beside an exact tangency."""

FLOATS = ("hc_single", "hc_certified")
"""The functions of the header that decide by floats; the second is one of each level."""

TANGENTS = ("hc_tangent_beyond", "hc_tangent_within")
"""The functions of the header that make the half planes of a scene."""

MACROS = ("HC_MAX_OF", "HC_MIN_OF")
"""The macros of two ints that they use, read as functions."""

PROVED_IN = {
    **dict.fromkeys(_SUMS_AND_PRODUCTS, "LimbsRuns"),
    **dict.fromkeys(_SHIFTS_AND_SIGNS, "ShiftRuns"),
    **dict.fromkeys((*MACROS, *_FIXED_TERMS), "StageThreeRuns"),
    **dict.fromkeys(_FIXED_ANSWERS, "StageThreeAnswers"),
    **dict.fromkeys(_BY_INTEGERS, "StageFiveAnswers"),
    **dict.fromkeys(_STAGE_BY_STAGE, "StagesRuns"),
    **dict.fromkeys(_SIZES, "LongSums"),
    **dict.fromkeys(_PRODUCTS, "LongProducts"),
    "hc_in_units": "LongUnits",
    ROOM: "StageFiveLimbs",
    **dict.fromkeys(OF_DOUBLES, "Doubles"),
    "hc_position_in_plane": "StageFourPlane",
    "hc_single": "FloatTexts",
    "hc_certified": "CertifiedText",
    "hc_touches_by_short": "StageFourShort",
    "hc_touches_by": "StageFourTurns",
    "hc_position_beside_tangency": "StageFourBeside",
    **dict.fromkeys(TANGENTS, "TangentTexts"),
}
"""The Coq file that says what each of them computes."""

_TANGENCY_MACRO = re.compile(
    r"^#define (HC_NAMED_LENGTHS\(lengths\)|HC_TANGENCY_BITS|HC_TANGENCY_TURNS|HC_HAIR)[\s\\]+(.*?)(?: +/\*.*)?$",
    re.MULTILINE,
)
_FUNCTION = r"^static (?:inline )?\w+ {}\((?:[^\n]*\}}$|.*?^\}}$)"
_OF_LEVEL = r"^HC_TARGET static (\w+) HC_NAME\({}\)(\([^\n]*\{{$.*?^\}}$)"
_HEAD = "Require Import List String ZArith.\nImport ListNotations.\nOpen Scope string_scope.\n"
_OPERATORS = {"+": "-", "-": "+", "*": "/", "/": "*", ">": "<", "<": ">", ">=": "<=", "<=": ">="}
_CALLS = {
    **{f"HC_{left}": f"HC_{right}" for left, right in (("GT", "GE"), ("LT", "GT"), ("LE", "LT"), ("GE", "GT"))},
    "HC_AND": "HC_OR",
    "HC_OR": "HC_AND",
    "hc_add": "hc_subtract",
    "hc_subtract": "hc_add",
    "hc_multiply": "hc_add",
    "hc_fixed_plus": "hc_fixed_minus",
    "hc_fixed_minus": "hc_fixed_plus",
    "hc_fixed_product": "hc_fixed_plus",
    "hc_fixed_square": "hc_fixed_negative",
    "hc_product": "hc_multiple",
    "hc_fixed_signed_product": "hc_fixed_plus",
    "hc_fixed_both_signed_product": "hc_fixed_minus",
    "hc_multiple": "hc_product",
    "hc_fixed_full": "hc_fixed_plus",
    "hc_fixed_full_signed": "hc_fixed_plus",
    "hc_long_product": "hc_fixed_plus",
    "hc_long_signed_product": "hc_fixed_plus",
    "hc_scale": "hc_multiply",
    "by_t": "by_q",
    "by_q": "by_t",
}
_WORD = {
    **dict(zip("+-*&^|<>", "-++|&&><", strict=True)),
    **dict(zip(("<<", ">>", "+=", "-=", ".low", ".high"), (">>", "<<", "-=", "+=", ".high", ".low"), strict=True)),
    **dict(zip(("==", "!=", "&&", "||"), ("!=", "==", "||", "&&"), strict=True)),
}
_CHANGED = re.compile(
    r"(?<= )(?:[-+*&^|<>]|<<|>>|[-+]=|[=!]=|&&|\|\|)(?= )|(?<![\w.])(?<![^{]\{)\d+\b(?!}}|, 0}})|\.(?:low|high)\b"
)
_MEANS_THE_SAME = (
    *("by < 128 ?", "mask << 0 <<", "*about = delta ? 1"),
    *("right_sign >= 1", "order < 1 ? right : left", "order < 1 ? left : right"),
)
"""Changes of hc_fixed_down that change no value, 127 bits and the sign in a bit that already has it; a guess; in
hc_combine a number without limbs subtracted, not added, and one of two equal sizes for the other."""

_DEFINED = re.compile(r"^(?:const \w+ |HC_INTEGER\()(\w+)", re.MULTILINE)
_STATEMENT = re.compile(r"const \w+ \w+ = |HC_INTEGER\(\w+, \d+\); ")

Change = tuple[int, int, str]
"""The number of a part, the number of a line in it, and the line that is put in its place."""

UNCHANGED: Change = (1, 10**3, "")
"""No change: there is no such line. Coq must accept it, or its refusals would mean nothing."""


def parts(header: str) -> list[tuple[str, str]]:
    """The printed parts of the header, in its order: the program's name, and its lines without indentation."""
    found = [(name + (further or ""), text) for name, further, text in _PART.findall(header)]
    return [(name, "".join(f"{line.strip()}\n" for line in text.splitlines())) for name, text in found]


def functions(header: str) -> list[str]:
    """The texts of the functions that compute with words."""
    return _texts(FUNCTIONS, header)


def deciding(header: str) -> list[str]:
    """The texts of the functions that decide, the macros that they use written as functions."""
    macros = [re.search(rf"^#define ({name})\(a, b\) (.*)$", header, re.MULTILINE) for name in MACROS]
    found = [f"static int {macro[1]}(int a, int b) {{ return {macro[2]}; }}" for macro in macros if macro]
    return [*found, *_texts(DECIDING, header)]


def beside_tangency(header: str) -> list[str]:
    """The texts of the functions that decide beside a tangency, the macros of their lengths and numbers written out."""
    texts = _texts(BESIDE_TANGENCY, header)
    for macro, value in _TANGENCY_MACRO.findall(header):
        texts = [text.replace(macro, value) for text in texts]
    return texts


def integers(header: str) -> list[str]:
    """The texts of the functions that compute with long integers, and of the room that one is declared with."""
    room = re.search(rf"^#define {ROOM}\(name, bits\)\s+\\\n +hc_limb name##_limbs\[(.*)\]; \\$", header, re.MULTILINE)
    declared = [f"static int {ROOM}(int bits) {{ return {room[1]}; }}"] if room else []
    return [*_texts(INTEGERS, header), *declared]


def floats(header: str) -> list[str]:
    """The texts of the functions that decide by floats, those of a level by their names without it."""
    of_level = [re.search(_OF_LEVEL.format(name), header, re.MULTILINE | re.DOTALL) for name in FLOATS]
    found = [f"static {text[1]} {name}{text[2]}" for name, text in zip(FLOATS, of_level, strict=True) if text]
    return [*_texts(FLOATS, header), *found]


def of_doubles(header: str) -> list[str]:
    """The texts of the functions that read the bits of doubles."""
    return _texts(OF_DOUBLES, header)


def tangents(header: str) -> list[str]:
    """The texts of the functions that make half planes."""
    return _texts(TANGENTS, header)


def _texts(names: tuple[str, ...], header: str) -> list[str]:
    found = [re.search(_FUNCTION.format(name), header, re.MULTILINE | re.DOTALL) for name in names]
    return [text[0] for text in found if text]


def header_text() -> str:
    """HeaderText.v: the printed parts, and the functions that compute with words, as texts of Coq."""
    text = HEADER.read_text(encoding="utf-8")
    rows = ";\n".join(f"  ({_quoted(name)}, {_quoted(part)}%text)" for name, part in parts(text))
    bounds = "; ".join(f'("{name.lower()}", {value})' for name, value in _BOUND.findall(text))
    words, trees, beside, long, doubles, of_floats, of_tangents = (
        ";\n".join(f"  {_quoted(function)}%text" for function in found)
        for found in (
            *(functions(text), deciding(text), beside_tangency(text), integers(text)),
            *(of_doubles(text), floats(text), tangents(text)),
        )
    )
    return (
        f"From Hypcheck Require Import Steps.\n{_HEAD}Definition fixed_bounds : list (string * Z) := [{bounds}]%Z.\n"
        f"Definition texts : list (string * text) := [\n{rows}].\n"
        f"Definition functions : list text := [\n{words}].\n"
        f"Definition deciding : list text := [\n{trees}].\n"
        f"Definition beside_tangency : list text := [\n{beside}].\n"
        f"Definition integers : list text := [\n{long}].\n"
        f"Definition of_doubles : list text := [\n{doubles}].\n"
        f"Definition floats : list text := [\n{of_floats}].\n"
        f"Definition tangents : list text := [\n{of_tangents}].\n"
        "Definition parts := map (fun part => (fst part, string_of (snd part))) texts.\n"
    )


def _quoted(text: str) -> str:
    return '"' + text.replace('"', '""') + '"'


def changes(each: int, seed: int) -> list[Change]:
    """Up to `each` changes of a constant, of an operation and of a name in every part, drawn by the seed."""
    draw = random.Random(seed)  # noqa: S311 - no secret
    found = []
    for number, (_, text) in enumerate(parts(HEADER.read_text(encoding="utf-8"))):
        lines = text.splitlines()
        names = sorted(set(_DEFINED.findall(text)))
        for kind in (_constants, _operations, _names):
            all_of_kind = [(number, at, new) for at, line in enumerate(lines) for new in kind(line, names)]
            found += draw.sample(all_of_kind, min(each, len(all_of_kind)))
    return found


def function_changes() -> Iterator[tuple[str, str, str]]:
    """Every change of a constant, an operation or a part of a number in the functions.

    It is given as the function, Coq's list of all texts, and what is changed. Not changed is a number in whose place
    another is put before it is read: the last two words of `{{0, 0, 0, 0}}`, the first of `{0, 0}`. Nor is what
    means the same.
    """
    yield from _changes_of(FUNCTIONS, functions(HEADER.read_text(encoding="utf-8")))


def deciding_changes() -> Iterator[tuple[str, str, str]]:
    """The same of the functions that decide, and of the macros that they use."""
    yield from _changes_of((*MACROS, *DECIDING), deciding(HEADER.read_text(encoding="utf-8")))


def tangency_changes() -> Iterator[tuple[str, str, str]]:
    """The same of the functions that decide beside a tangency."""
    yield from _changes_of(BESIDE_TANGENCY, beside_tangency(HEADER.read_text(encoding="utf-8")))


def float_changes() -> Iterator[tuple[str, str, str]]:
    """The same of the functions that decide by floats."""
    yield from _changes_of(FLOATS, floats(HEADER.read_text(encoding="utf-8")))


def tangent_changes() -> Iterator[tuple[str, str, str]]:
    """The same of the functions that make half planes."""
    yield from _changes_of(TANGENTS, tangents(HEADER.read_text(encoding="utf-8")))


def integer_changes() -> Iterator[tuple[str, str, str]]:
    """The same of the functions that compute with long integers, and of the room of one."""
    yield from _changes_of((*INTEGERS, ROOM), integers(HEADER.read_text(encoding="utf-8")))


def double_changes() -> Iterator[tuple[str, str, str]]:
    """The same of the functions that read the bits of doubles."""
    yield from _changes_of(OF_DOUBLES, of_doubles(HEADER.read_text(encoding="utf-8")))


def _changes_of(names: tuple[str, ...], texts: list[str]) -> Iterator[tuple[str, str, str]]:
    for place, (name, text) in enumerate(zip(names, texts, strict=True)):
        start = text.index("\n", text.index("#if")) if "#if" in text else text.index("{") + 1
        stop = text.index("#else") if "#else" in text else len(text)
        for word in _CHANGED.finditer(text, start, stop):
            if _is_remark(text, word.start()):
                continue
            for new in [_WORD[word[0]]] if word[0] in _WORD else _numbers_beside(word[0]):
                changed = text[: word.start()] + new + text[word.end() :]
                if any(same in changed for same in _MEANS_THE_SAME):
                    continue
                listed = [*texts[:place], changed, *texts[place + 1 :]]
                rows = "; ".join(f"text_of (list_byte_of_string {_quoted(row)})" for row in listed)
                yield name, f"[{rows}]", f"{new} for {word[0]} in {name}, character {word.start()}"


def _is_remark(text: str, at: int) -> bool:
    return text.rfind("/*", 0, at) > text.rfind("*/", 0, at)


def _numbers_beside(number: str) -> list[str]:
    return [str(int(number) + by) for by in (1, -1) if int(number) + by >= 0]


def _value(line: str) -> tuple[str, str] | None:
    start = _STATEMENT.match(line)
    return (line[: start.end()], line[start.end() :]) if start else None


def _constants(line: str, _names: list[str]) -> Iterator[str]:
    before, value = _value(line) or ("", "")
    for number in re.finditer(r"(?<![\w.])\d+(?=\b)", value):
        yield before + value[: number.start()] + str(int(number[0]) + 1) + value[number.end() :]


def _operations(line: str, _names: list[str]) -> Iterator[str]:
    before, value = _value(line) or ("", "")
    for word in re.finditer(r"(?<= )(?:[-+*/]|[<>]=?)(?= )|\b\w+\b", value):
        new = _OPERATORS.get(word[0]) or _CALLS.get(word[0])
        if new:
            yield before + value[: word.start()] + new + value[word.end() :]


def _names(line: str, names: list[str]) -> Iterator[str]:
    before, value = _value(line) or ("", "")
    for word in re.finditer(r"\b\w+\b", value):
        if word[0] in names:
            other = names[(names.index(word[0]) + 1) % len(names)]
            new = value[: word.start()] + other + value[word.end() :]
            if other != word[0] and sorted(re.findall(r"\w+", new)) != sorted(re.findall(r"\w+", value)):
                yield before + new


def question(found: list[Change]) -> str:
    """A Coq file that prints for each change whether Printed.v accepts it."""
    texts = "; ".join(f"({part}, {line}, {_quoted(new)})" for part, line, new in found)
    return f"""From Hypcheck Require Import Printed.
{_HEAD}Eval vm_compute in map accepted_with [{texts}].
"""
