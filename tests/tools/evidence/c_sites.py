"""Mutants of the C header: comparisons, junctions, constants and guards, all in one text that a number chooses from.

A place of the header becomes `(hc_mutant == 17 ? changed : unchanged)`: one compilation serves all of them. What
is printed from a program several times is one place. Left out are loops, what chooses an instruction set, and functions
that only guess where a proof is looked for: any result of theirs is safe (GUESSES).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from tests.tools.evidence.parts import ROOT

HEADER = ROOT / "hypcheck/kernel/core/hypcheck.h"

OTHER = {"<": "<=", ">": ">=", "<=": "<", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&"}
PRINTED = {"GT": "GE", "LT": "LE", "GE": "GT", "LE": "LT", "AND": "OR", "OR": "AND"}
_MACRO = re.compile(r"HC_(GT|LT|GE|LE|AND|OR)(?=\()")
GUESSES = {
    "hc_about_inverse_avx512",
    "hc_about_root_avx512",
    "hc_aim",
    "hc_aim_at_least",
    "hc_best_multiplier",
    "hc_direction_of",
    "hc_edge",
    "hc_ended_multiplier",
    "hc_fine_root",
    "hc_gaps",
    "hc_tilted_sweep_multiplier",
    "hc_rough_root",
    "hc_sample_Q",
    "hc_sample_heights",
    "hc_share_of_pole",
    "hc_tilted_multiplier",
    "hc_touches",
    "hc_sweep_multiplier",
}
OF_THE_MACHINE = {
    "hc_best_level",
    "hc_level",
    "hc_level_of",
    "hypcheck_level",
    "hypcheck_use_level",
    "hypcheck_version",
    "hc_lowest_bit",
    "hc_spread",
}
_OTHERS = "BLOCK STRIP LIMB_BITS WIDTH LEVEL PRECISE FLOATS_DECIDE X86 NEON AHEAD FAR_FROM LINES_FROM PLANES_FROM guess"
_SIZES = rf"HC_(?:{_OTHERS.replace(' ', '|')}|\w*TURNS|\w*LIMBS|TOO_MANY_\w+|\w*settled)"
"""Constants that sizes of arrays are made of, or that choose a shortcut alone."""

NAMED = {
    ("hc_known_point", "point.R < HC_cap && hc_position_of(row) != side"): ("hc_position_of(row) != side",),
    ("hc_make_scene", "under[2].T * HC_less"): ("(under[2].T * HC_more)",),
    ("hc_short", "((uint64_t)1 << 27) - 1"): ("(((uint64_t)1 << 20) - 1)",),
    ("hc_parts_of", "2048"): ("1000",),
}
"""Changes that no rule makes, by function and expression: a cap left out, a reach with its margin reversed, a number
with 33 bits for one with 26, and 0 with an exponent that is not above all others."""

_OPERATOR = re.compile(r"(?<= )(<=|>=|==|!=|<|>|&&|\|\|)(?= )")
_NUMBER = re.compile(r"(?<![\w.\[])(\d+\.\d+(?:e[+-]?\d+)?|\d+e[+-]?\d+|\d+)(?![\w.\]])")
_OF_SIDES = re.compile(r"\bside [<>] 0$")
"""A side is 1 or -1: with 0 among the less or the greater ones the same is said."""
_LEFT_OUT = re.compile(r"\bfor \(|\bstatic\b|\bcase\b|\w\[.*\];$")
_GUARD = re.compile(r"\bif \(")
FUNCTION = re.compile(r"^(?:HC_TARGET )?(?:[\w*]+ )*?\*?(?:HC_NAME\()?(\w+)\)?\([^;]*$", re.MULTILINE)


_CHOSEN = "#ifndef HC_CHOSEN\n#define HC_CHOSEN\nstatic volatile int hc_mutant;\n#endif\n"
"""The header includes itself."""


@dataclass(frozen=True)
class Mutant:
    """A change: its number, the function it is in, what stands there, and what is put there."""

    number: int
    function: str
    before: str
    after: str

    @property
    def name(self) -> str:
        """How tables name it."""
        return f"{self.function}: {self.before} → {self.after}"


@dataclass(frozen=True)
class _Place:
    """A stretch of the text, and what may stand in its place."""

    start: int
    end: int
    function: str
    others: tuple[str, ...]


def schemata(source: str) -> tuple[str, list[Mutant]]:
    """The header with all mutants in it, and which they are; mutant 0 is the header as it is."""
    code = _code(source)
    mutants: list[Mutant] = []
    known: dict[tuple[str, str], int] = {}
    pieces, at = [], 0
    for place in _places(source, code):
        before = source[place.start : place.end]
        text = before
        for other in place.others:
            key = (_program(place.function), f"{before}→{other}")
            if key not in known:
                known[key] = len(mutants) + 1
                mutants.append(Mutant(known[key], key[0], *(" ".join(each.split()) for each in (before, other))))
            text = f"(hc_mutant == {known[key]} ? {other} : {text})"
        pieces += [source[at : place.start], text]
        at = place.end
    return _CHOSEN + "".join(pieces) + source[at:], mutants


def _program(function: str) -> str:
    """One name for what is printed for each question."""
    return re.sub(r"(_lines?)_(position|exterior|interior|contact)$", r"\1", function)


def _code(source: str) -> str:
    """The text with comments, and what comes before the implementation, blanked; places stay."""
    start = source.index("#if defined(HYPCHECK_IMPLEMENTATION)")

    def blank(match: re.Match[str]) -> str:
        return re.sub(r"[^\n]", " ", match[0])

    return re.sub(r"[^\n]", " ", source[:start]) + re.sub(r"/\*.*?\*/", blank, source[start:], flags=re.DOTALL)


def _places(source: str, code: str) -> Iterator[_Place]:
    """The places that are changed, in order, none within another."""
    end = 0
    for start, stop, function in sorted(_stretches(code)):
        if start < end:
            continue
        end = stop
        named = NAMED.get((function, code[start:stop]), ())
        others = tuple(dict.fromkeys([*_others(code[start:stop]), *named]))
        if others:
            yield _Place(start, stop, function, others)


def _stretches(code: str) -> Iterator[tuple[int, int, str]]:
    """Where the expressions are that have an operator, a guard or a constant in them, and the function around each."""
    starts = [(match.start(), match[1]) for match in FUNCTION.finditer(code) if not match[0].startswith(("#", " "))]
    for line in re.finditer(r"[^\n]+", code):
        text = line[0]
        if text.startswith("#"):
            define = re.match(r"#define (HC_\w+) (-?[\d.]+(?:e[+-]?\d+)?)\s*$", text)
            if define and not re.fullmatch(_SIZES, define[1]):
                yield line.start() + define.start(2), line.start() + define.end(2), define[1]
            continue
        function = next((name for start, name in reversed(starts) if start <= line.start()), "")
        if function in GUESSES | OF_THE_MACHINE or _LEFT_OUT.search(text) or not text.startswith(" "):
            continue
        for expression in (expression for name, expression in NAMED if name == function):
            if expression in text:
                at = line.start() + text.index(expression)
                yield at, at + len(expression), function
        for match in [*_OPERATOR.finditer(text), *_MACRO.finditer(text), *_numbers(text)]:
            at = line.start() + match.start()
            yield (*_expression(code, at, at), function)
        for match in _GUARD.finditer(text):
            inside = line.start() + match.end()
            yield (*_expression(code, inside, inside), function)


def _numbers(text: str) -> Iterator[re.Match[str]]:
    return (match for match in _NUMBER.finditer(text) if "." in match[1] or "e" in match[1])


def _expression(code: str, start: int, end: int) -> tuple[int, int]:
    """The longest expression around a place that has no comma, assignment or choice outside of its own parentheses."""
    depth = 0
    while True:
        before = code[start - 1]
        depth += {")": 1, "]": 1, "(": -1, "[": -1}.get(before, 0)
        if depth < 0 or (depth == 0 and _begins(code, start)):
            break
        start -= 1
    depth = 0
    while True:
        after = code[end]
        depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(after, 0)
        if depth < 0 or (depth == 0 and after in ",;{}?:"):
            break
        end += 1
    while code[start].isspace():
        start += 1
    while code[end - 1].isspace():
        end -= 1
    return start, end


def _begins(code: str, at: int) -> bool:
    """Whether an expression can begin here."""
    before = code[at - 1]
    assigns = before == "=" and code[at] == " " and code[at - 2] not in "=!<>"
    return before in ",;{}?:" or assigns or code.startswith(("return ", "  else "), at - 7)


def _others(text: str) -> Iterator[str]:
    """What may stand in place of an expression."""
    if re.fullmatch(_NUMBER, text):
        yield from _values(text)
        return
    for match in _OPERATOR.finditer(text):
        if _OF_SIDES.search(text[: match.end() + 2]):
            continue
        yield f"({text[: match.start()]}{OTHER[match[1]]}{text[match.end() :]})"
    for match in _MACRO.finditer(text):
        yield f"({text[: match.start()]}HC_{PRINTED[match[1]]}{text[match.end() :]})"
    compared = _OPERATOR.search(text)
    if compared:
        yield "0"
    for match in _NUMBER.finditer(text):
        if "." in match[1] or "e" in match[1] or (compared and match[1] not in "01"):
            yield from (f"({text[: match.start()]}{value}{text[match.end() :]})" for value in _values(match[1]))


def _values(number: str) -> tuple[str, ...]:
    """Half and twice of a float other than 0, one less and one more of a whole number."""
    if re.fullmatch(r"0\.0*", number):
        return ()
    if re.fullmatch(r"\d+", number):
        return (str(int(number) - 1), str(int(number) + 1))
    return (repr(float(number) / 2), repr(float(number) * 2))
