"""A kernel from a plan, in one of the languages: a template, its constants, and statements printed from programs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from hypcheck.derivation.program import Program
from hypcheck.errors import InputError
from hypcheck.kernel.emission.batch import OPEN, many
from hypcheck.kernel.emission.body import function
from hypcheck.kernel.emission.describing import described
from hypcheck.kernel.emission.dialects import DIALECTS, Dialect
from hypcheck.kernel.emission.filling import filled, template
from hypcheck.kernel.emission.header import header, safe
from hypcheck.kernel.specialise import search as searching
from hypcheck.kernel.specialise.plan import Plan
from hypcheck.kernel.specialise.search import GEOMETRIC_STEPS
from hypcheck.version import VERSION
from hypcheck.visible import visible

COMMENTS = {"c": " * ", "cpp": "// ", "rust": "//! ", "javascript": "// ", "python": ""}
EXTENSIONS = {"c": "c", "cpp": "cpp", "rust": "rs", "javascript": "mjs", "python": "py"}
EXPORTING = ("c", "cpp", "rust")
"""Languages whose kernels have functions that a linker sees; the others' names are their module's."""

PREFIX = "hypcheck"
"""With it the functions have the names that `verify library:` asks for."""

_PREFIX, _LONGEST_PREFIX = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*", re.ASCII), 40

BY_BLOCK = ("c", "cpp")
"""Languages whose kernels have loops over many centres that compilers make vectors of."""

SETTING = ("A", "B", "PR", "QZ", "AR", "CZ", "low_a", "low_b")
"""The constants of a search, in the order in which a kernel holds them."""


def require_prefix(prefix: str, language: str) -> None:
    """Raise InputError unless functions of a kernel in this language can begin with `prefix`."""
    if prefix != PREFIX and language not in EXPORTING:
        raise InputError(
            f"--prefix is for {', '.join(EXPORTING)}: a {language} kernel is a module with names of its own"
        )
    if not _PREFIX.fullmatch(prefix) or len(prefix) > _LONGEST_PREFIX:
        raise InputError(
            f"the prefix is {visible(repr(prefix), 60)}; it must be a letter, then letters, digits and single "
            f"underscores between them, {_LONGEST_PREFIX} characters at most"
        )


def emitted(plan: Plan, language: str, command: Sequence[str], prefix: str = PREFIX) -> str:
    """The text of the kernel; `command` is what its header says made it. Raises InputError.

    Its exported functions are `prefix`_classify, `prefix`_classify_scene and `prefix`_describe.
    """
    if language not in DIALECTS:
        raise InputError(f"the language is {language!r}; it must be one of {', '.join(DIALECTS)}")
    require_prefix(prefix, language)
    dialect = DIALECTS[language]
    number = dialect.number_of(plan.format.name)
    extension = EXTENSIONS[language]
    functions = [function(plan, stages, place, dialect) for place, stages in _numbered(plan)]
    parts = {
        "header": header(plan, command, COMMENTS[language]),
        "prefix": prefix,
        "number": number,
        "search": _search(plan, dialect, extension) if _searches(plan) else "",
        "imports": "\n".join(["import math"] * _searches(plan) + ["from collections.abc import Iterable"]),
        "settings": ("\n\n\n" if language == "python" else "\n\n").join([*_settings(plan, dialect), *functions]),
        "many": "\n\n".join(many(plan, stages, place, dialect) for place, stages in _numbered(plan))
        if language in BY_BLOCK
        else "",
        "open": dialect.literal(float(OPEN), plan.format.name),
        "choose": "\n".join(_choices(plan, dialect)),
        "round": "Math.fround" if plan.format.name == "float32" else "Number",
        "description": described(description(plan, language), language),
    }
    return filled(template(f"kernel.{extension}.tmpl"), parts).strip("\n") + "\n"


def description(plan: Plan, language: str) -> dict[str, Any]:
    """What the kernel says of itself, as docs/protocol.md has it."""
    return {
        "protocol": 1,
        "name": f"{safe(plan.scene.name)} ({language}, {plan.format.name})",
        "version": VERSION,
        "language": language,
        "precision": plan.format.name,
        "question": plan.question,
        "domain": {"settings": [_domain(stages.setting) for stages in plan.settings]},
    }


def _domain(setting: Any) -> dict[str, Any]:  # noqa: ANN401
    spans = {name: [span.low, span.high] for name, span in zip("xyz", setting.box.spans, strict=True) if span}
    return {"sizes": list(setting.sizes), **spans}


def _numbered(plan: Plan) -> list[tuple[int, Any]]:
    return list(enumerate(plan.settings, start=1))


def _searches(plan: Plan) -> bool:
    return any(stages.search is not None for stages in plan.settings)


def _settings(plan: Plan, dialect: Dialect) -> list[str]:
    """The tables of constants that searches take."""
    found = []
    for place, stages in _numbered(plan):
        if stages.search is not None:
            values = ((name, dialect.literal(stages.search.constants[name], plan.format.name)) for name in SETTING)
            fields = ",\n    ".join(dialect.say("field", name=name, value=value) for name, value in values)
            found.append(dialect.say("setting", place=place, values=f"\n    {fields},\n"))
    return found


def _choices(plan: Plan, dialect: Dialect) -> list[str]:
    return [
        dialect.say("choose", place=place, sizes=", ".join(map(repr, stages.setting.sizes)), of=stages.setting.sizes)
        for place, stages in _numbered(plan)
    ]


def _search(plan: Plan, dialect: Dialect, extension: str) -> str:
    """The search that all settings share."""

    def printed(program: Program, *wanted: str) -> str:
        return "\n".join(dialect.printer(program, wanted, dialect.number_of(plan.format.name)))

    parts = {
        "number": dialect.number_of(plan.format.name),
        "place": printed(searching.PLACE, "to_a", "to_b"),
        "place_all": printed(searching.PLACE, "to_a", "to_b", "lambda_"),
        "falls": printed(searching.falls(), "past"),
        "falls_at_zero": printed(searching.falls("_zero"), "past_zero"),
        "geometric": printed(searching.GEOMETRIC, "middle"),
        "arithmetic": printed(searching.ARITHMETIC, "middle"),
        "start": printed(searching.START, "P", "Q", "ar", "cz"),
        "half": printed(searching.HALF, "half"),
        "phi": printed(searching.PHI, "above_zero"),
        "one": dialect.literal(1.0, plan.format.name),
        "zero": dialect.literal(0.0, plan.format.name),
        "steps": str(GEOMETRIC_STEPS + plan.format.bits + 3),
        "geometric_steps": str(GEOMETRIC_STEPS),
    }
    return filled(template(f"search.{extension}.tmpl"), parts) + "\n"
