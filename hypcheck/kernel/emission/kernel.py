"""A kernel from a plan, in one of the languages: a template, its constants, its description, and printed statements.

The description is what a kernel says of itself: a text of JSON, or an object of its language, a line for each setting.
Searches, and what they call, are printed from routines.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

from hypcheck.errors import InputError
from hypcheck.kernel.emission.dialects import DIALECTS, Dialect
from hypcheck.kernel.emission.functions import OPEN, batch_function, setting_function
from hypcheck.kernel.emission.plan_text import comment_text, header
from hypcheck.kernel.emission.routines import routines_text
from hypcheck.kernel.specialise.last_stages import GEOMETRIC_STEPS, DoubleDouble, DualSearch, TiltedSearch
from hypcheck.kernel.specialise.plan import ScenePlan, Stages
from hypcheck.kernel.specialise.settings import Setting
from hypcheck.kernel.specialise.tilted_search import FREE_SEARCH, HAS_DIRECTION, SEARCH, SETTING, search_of
from hypcheck.messages import escaped
from hypcheck.scene.model import FREE
from hypcheck.version import VERSION

LONGEST = 4095
"""Characters in a string that every compiler of ISO C takes."""

_BY_PARTS = """static const char *const parts[] = {{
    {parts},
}};
static char text[{size}];  /* ISO C has no strings of more than {longest} characters */
size_t end = 0;
for (size_t part = 0; part < sizeof parts / sizeof *parts; part++)
    for (const char *from = parts[part]; *from; from++) text[end++] = *from;
return text;"""


def description_in_language(value: dict[str, Any], language: str, prefix: str) -> str:
    """The description in a language: in C the body of the function that returns it, in Rust the whole function."""
    if language == "python":
        return "\n    ".join(line.rstrip() for line in _lines(value, repr))
    lines = list(_lines(value, partial(json.dumps, separators=(",", ":"))))  # adapters look for "tilt":true
    if language == "javascript":
        return "\n    ".join(line.rstrip() for line in lines)
    quoted = [json.dumps(line) for line in lines]  # C, C++ and Rust escape quotation marks and backslashes alike
    if language == "rust":
        return in_rust(quoted, prefix, *(("tilted", 10) if "tilt" in value else ("predicate", 7)))
    if language == "c" and sum(map(len, lines)) > LONGEST:
        size = sum(map(len, lines)) + 1
        return _BY_PARTS.format(parts=",\n    ".join(quoted), size=size, longest=LONGEST)
    return "return " + "\n    ".join(quoted) + ";"


def in_rust(quoted: Sequence[str], prefix: str, predicate: str, width: int) -> str:
    """The description in Rust, with the names that the adapter of `hypcheck init` takes from a module.

    `predicate` is that function, `width` the numbers of a row; another function is there and answers none.
    """
    columns = str(width)
    other, other_columns = ("tilted", "10") if predicate == "predicate" else ("predicate", "7")
    named = {"asked": predicate, "columns": columns, "other": other, "other_columns": other_columns}
    parts = {"description": ",\n".join(quoted), "prefix": prefix, **named}
    return DIALECTS["rust"].filled("description", parts).strip("\n")


def _lines(value: dict[str, Any], written: Callable[[Any], str]) -> Iterator[str]:
    """The text of a value in pieces: the part before its domain's settings, each setting, the end."""
    settings = value["domain"]["settings"]
    text = written({**value, "domain": {"settings": []}})  # the settings come last: the text ends with []}}
    yield text[:-3]
    for place, setting in enumerate(settings, start=1):
        yield written(setting) + (", " if place < len(settings) else "")
    yield text[-3:]


PREFIX = "hypcheck"
"""With it the functions have the names that `verify library:` asks for."""

_PREFIX, _LONGEST_PREFIX = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*", re.ASCII), 40


def require_prefix(prefix: str, language: str) -> None:
    """Raise InputError unless functions of a kernel in this language can begin with `prefix`."""
    if prefix != PREFIX and not DIALECTS[language].exports:
        exporting = ", ".join(dialect.name for dialect in DIALECTS.values() if dialect.exports)
        raise InputError(f"--prefix is for {exporting}: a {language} kernel is a module with names of its own")
    if not _PREFIX.fullmatch(prefix) or len(prefix) > _LONGEST_PREFIX:
        raise InputError(
            f"the prefix is {escaped(repr(prefix), 60)}; it must be a letter, then letters, digits and single "
            f"underscores between them, {_LONGEST_PREFIX} characters at most"
        )


def emitted(plan: ScenePlan, language: str, command: Sequence[str], prefix: str = PREFIX) -> str:
    """The text of the kernel; its header names `command` as the command that wrote it. Raises InputError.

    Its exported functions are `prefix`_classify, `prefix`_classify_scene and `prefix`_describe.
    """
    require_prefix(prefix, language)
    dialect = DIALECTS[language]
    number = dialect.number_of(plan.format.name)
    functions = [setting_function(plan, stages, place, dialect) for place, stages in _numbered(plan)]
    parts = {
        "header": header(plan, command, dialect.comment),
        "prefix": prefix,
        "number": number,
        **prologue(dialect),
        "search": _searches_text(plan, dialect),
        **_axis_parts(plan, dialect),
        "imports": "\n".join(
            ["import math"] * bool(_searched(plan) or plan.free) + ["from collections.abc import Iterable"]
        ),
        "settings": ("\n\n\n" if language == "python" else "\n\n").join([*_settings(plan, dialect), *functions]),
        "many": "\n\n".join(batch_function(plan, stages, place, dialect) for place, stages in _numbered(plan))
        if dialect.by_block
        else "",
        "open": dialect.literal(float(OPEN), plan.format.name),
        "choose": "\n".join(_choices(plan, dialect)),
        "round": "Math.fround" if plan.format.name == "float32" else "Number",
        "description": description_in_language(description(plan, language), language, prefix),
    }
    return dialect.filled("kernel", parts).strip("\n") + "\n"


def prologue(dialect: Dialect) -> dict[str, str]:
    """The beginning of C and C++ files: headers, refusal of forbidden compiler options, export of functions."""
    phrases = ("includes", "linkage", "end linkage") if dialect.by_block else ()
    texts = {phrase.replace(" ", "_"): dialect.say(phrase) for phrase in phrases}
    return {"arithmetic": asked_of_compiler(dialect), **texts}


def asked_of_compiler(dialect: Dialect) -> str:
    """The options that a compiler must not be given; nothing in languages whose arithmetic no option changes."""
    return DIALECTS["c"].filled("arithmetic", {}) if dialect.by_block else ""


def description(plan: ScenePlan, language: str) -> dict[str, Any]:
    """The kernel's description of itself, in the form of docs/protocol.md."""
    return {
        "protocol": 1,
        "name": f"{comment_text(plan.scene.name)} ({language}, {plan.format.name})",
        "version": VERSION,
        "language": language,
        "precision": plan.format.name,
        "question": plan.question,
        **({} if plan.axis is None else {"tilt": True}),
        "domain": {"settings": [_domain(stages.setting) for stages in plan.settings]},
    }


def _domain(setting: Setting) -> dict[str, Any]:
    spans = {name: [span.low, span.high] for name, span in zip("xyz", setting.box.spans, strict=True) if span}
    axis = {} if setting.axis is None else {"axis": setting.axis if setting.axis == FREE else list(setting.axis)}
    return {"sizes": list(setting.sizes), **spans, **axis}


def _numbered(plan: ScenePlan) -> list[tuple[int, Stages]]:
    return list(enumerate(plan.settings, start=1))


def _searched(plan: ScenePlan) -> list[tuple[int, DualSearch | TiltedSearch]]:
    """The searches of the settings that have one, with the settings' numbers."""
    ends = ((place, stages.last) for place, stages in _numbered(plan))
    return [(place, last) for place, last in ends if isinstance(last, DualSearch | TiltedSearch)]


def _axis_parts(plan: ScenePlan, dialect: Dialect) -> dict[str, str]:
    """The parts of a kernel's functions that concern an axis: empty if the spheroid is upright.

    Marks that begin with `fixed` are filled where the kernel has one axis, with `free` where it asks for any, and
    with `any` in both.
    """
    axis = plan.axis
    parts = {"tilted": "", "columns": "7", "number_word": "seven", "predicate": "predicate"}
    if axis is not None:
        parts |= {"tilted": "_tilted", "columns": "10", "number_word": "ten", "predicate": "tilted"}
    for kind, has in (("fixed", axis is not None and axis != FREE), ("free", axis == FREE), ("any", axis is not None)):
        parts |= {f"{kind}_{name}": text if has else "" for name, text in dialect.axis.items()}
    return parts


def _settings(plan: ScenePlan, dialect: Dialect) -> list[str]:
    """The code of the tables of constants that the searches of a plan read."""
    texts = []
    for place, search in _searched(plan):
        if isinstance(search, TiltedSearch):
            texts.append(_frame(search, place, dialect))
        else:
            values = ((name, dialect.literal(search.constants[name], plan.format.name)) for name in SETTING)
            fields = ",\n    ".join(dialect.say("field", name=name, value=value) for name, value in values)
            texts.append(dialect.say("setting", place=place, values=f"\n    {fields},\n"))
    return texts


def _choices(plan: ScenePlan, dialect: Dialect) -> list[str]:
    fixed = plan.axis is not None and plan.axis != FREE
    also = dialect.say("has axis", axis=plan.axis) if fixed else ""
    return [
        dialect.say(
            "choose", place=place, sizes=", ".join(map(repr, stages.setting.sizes)), of=stages.setting.sizes, also=also
        )
        for place, stages in _numbered(plan)
    ]


def _searches_text(plan: ScenePlan, dialect: Dialect) -> str:
    """The search that all settings share, and whether a free axis is one."""
    searches = [search for _, search in _searched(plan)]
    routines = [HAS_DIRECTION] if plan.free else []
    if searches and isinstance(searches[0], TiltedSearch):
        routines.append(FREE_SEARCH if searches[0].free else SEARCH)
    elif searches:
        routines.append(search_of(GEOMETRIC_STEPS + plan.format.bits + 3))
    return f"\n{routines_text(routines, dialect, plan.format.name)}\n" if routines else ""


def search_text(plan: ScenePlan, dialect: Dialect) -> str:
    """The search for an upright spheroid, with the record of its constants."""
    return "\n" + routines_text([search_of(GEOMETRIC_STEPS + plan.format.bits + 3)], dialect, plan.format.name) + "\n"


_PAIRS = {"c": "{{{0}, {1}}}", "cpp": "{{{0}, {1}}}", "rust": "Dd {{ hi: {0}, lo: {1} }}", "python": "({0}, {1})"}


def _frame(of: TiltedSearch, place: int, dialect: Dialect) -> str:
    """The code of a setting's constants: its frame or, if the axis is free, the sizes that a frame is computed from."""
    fields = [(name, _pair(value, dialect)) for name, value in of.constants.items()]
    fields += [(name, dialect.literal(value, "float64")) for name, value in (("most", of.most), ("omega", of.omega))]
    values = ",\n    ".join(dialect.say("field", name=name, value=value) for name, value in fields)
    return dialect.say("sizes" if of.free else "frame", place=place, values=f"\n    {values},\n")


def _pair(value: DoubleDouble, dialect: Dialect) -> str:
    high, low = (dialect.literal(part, "float64") for part in value)
    return _PAIRS.get(dialect.name, "[{0}, {1}]").format(high, low)
