"""Writes the kernels of a scene in a language, from its plan: one for its pairs of sizes, one for the whole scene.

Searches and the routines that they call are printed by dialects.py.

**The whole scene.** Its kernel also has the hyperboloids and their places, heights, the mover's parts, and the loop
over them. Settings whose functions differ only in their numbers share one, a *shape*, which reads the numbers from a
table; its statements, and so its arithmetic, are those of the functions that functions.py writes. So a kernel grows by
a line a hyperboloid, and there may be as many as a scene has.

The kernel computes the position for each pair of sizes, as any kernel does that `verify` tests. It combines them as
hypcheck.Scene does (kernel/scene.py): contact with any hyperboloid is contact, else inside any is interior, else
exterior. The parts are tested where the mover has contact. The offset from a hyperboloid's centre is rounded once,
which changes that coordinate by one unit more. If a spheroid reaches over an end, only the bounds of
kernel/scene_pairs.py are used; where they do not decide, the answer is 2.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import radians
from sys import float_info
from typing import Any

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import AXIS, SIZES
from hypcheck.kernel.choice import NUMBER_OF, POSITION_OF
from hypcheck.kernel.emission.dialects import (
    PREFIX,
    Dialect,
    description_in_language,
    dialect_of,
    require_prefix,
    routines_text,
)
from hypcheck.kernel.emission.functions import OPEN, batch_function, setting_function
from hypcheck.kernel.emission.plan_text import comment_text, header, whole_header
from hypcheck.kernel.scene_index import bodies_of, reaches
from hypcheck.kernel.specialise.last_stages import GEOMETRIC_STEPS, DoubleDouble, DualSearch, TiltedSearch
from hypcheck.kernel.specialise.plan import ScenePlan, Stages, plan_of
from hypcheck.kernel.specialise.tilted_search import FREE_SEARCH, HAS_DIRECTION, SEARCH, SETTING, search_of
from hypcheck.scene.model import FREE, Hyperboloid, SceneModel, Span
from hypcheck.version import VERSION


def emitted(plan: ScenePlan, language: str, command: Sequence[str], prefix: str = PREFIX) -> str:
    """Return the text of the kernel; its header names `command` as the command that wrote it. Raises InputError.

    Its exported functions are `prefix`_classify, `prefix`_classify_scene and `prefix`_describe.
    """
    dialect = dialect_of(language)
    functions = [setting_function(plan, stages, place, dialect) for place, stages in _numbered(plan)]
    parts = {
        "header": header(plan, command, dialect.comment),
        **_common_parts(plan, dialect, prefix),
        **_axis_parts(plan, dialect),
        "imports": "\n".join(
            ["import math"] * bool(_searched(plan) or plan.free) + ["from collections.abc import Iterable"]
        ),
        "settings": dialect.between.join([*_settings(plan, dialect), *functions]),
        "many": "\n\n".join(batch_function(plan, stages, place, dialect) for place, stages in _numbered(plan))
        if dialect.by_block
        else "",
        "open": dialect.literal(float(OPEN), plan.format.name),
        "choose": "\n".join(_choices(plan, dialect)),
    }
    return dialect.filled("kernel", parts).strip("\n") + "\n"


def _common_parts(plan: ScenePlan, dialect: Dialect, prefix: str) -> dict[str, str]:
    """Return the texts for the marks that the templates of pairs and of whole scenes share.

    Raises InputError for a wrong prefix.
    """
    require_prefix(prefix, dialect.name)
    phrases = ("includes", "linkage", "end_linkage") if dialect.by_block else ()
    return {
        "prefix": prefix,
        "number": dialect.number_of(plan.format.name),
        "round": "Math.fround" if plan.format.name == "float32" else "Number",
        "arithmetic": dialect.asked_of_compiler,
        **{phrase: dialect.say(phrase) for phrase in phrases},
        "search": _searches_text(plan, dialect),
        "description": description_in_language(
            description(plan, dialect.name),
            dialect.name,
            prefix,
            ("predicate", 7) if plan.axis is None else ("tilted", 10),
            (",", ":"),  # adapters look for "tilt":true
        ),
    }


def description(plan: ScenePlan, language: str) -> dict[str, Any]:
    """Return the kernel's description of itself, in the form of docs/protocol.md."""
    settings = [
        {"sizes": list(setting.sizes), **setting.spans, **setting.named_axis}
        for setting in (stages.setting for stages in plan.settings)
    ]
    return {
        "protocol": 1,
        "name": f"{comment_text(plan.scene.name)} ({language}, {plan.format.name})",
        "version": VERSION,
        "language": language,
        "precision": plan.format.name,
        "question": plan.question,
        **({} if plan.axis is None else {"tilt": True}),
        "domain": {"settings": settings},
    }


def _numbered(plan: ScenePlan) -> list[tuple[int, Stages]]:
    """Return the settings of the plan with their numbers, from 1."""
    return list(enumerate(plan.settings, start=1))


def _searched(plan: ScenePlan) -> list[tuple[int, DualSearch | TiltedSearch]]:
    """Return the searches of the settings that have one, each with the setting's number."""
    ends = ((place, stages.last) for place, stages in _numbered(plan))
    return [(place, last) for place, last in ends if isinstance(last, DualSearch | TiltedSearch)]


def _axis_parts(plan: ScenePlan, dialect: Dialect) -> dict[str, str]:
    """Return the texts for the marks about an axis, which are empty if the spheroid is upright.

    Marks that begin with `fixed_` are filled if the kernel has one axis, those with `free_` if each query names an
    axis, and those with `any_` in both cases.
    """
    axis = plan.axis
    parts = {"tilted": "", "columns": "7", "number_word": "seven", "predicate": "predicate"}
    if axis is not None:
        parts |= {"tilted": "_tilted", "columns": "10", "number_word": "ten", "predicate": "tilted"}
    for kind, has in (("fixed", axis is not None and axis != FREE), ("free", axis == FREE), ("any", axis is not None)):
        parts |= {f"{kind}_{name}": text if has else "" for name, text in dialect.axis.items()}
    return parts


def _settings(plan: ScenePlan, dialect: Dialect) -> list[str]:
    """Return the code of the constants that the searches of a plan read, one text for each setting with a search."""
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
    """Return the code that finds the function of a setting by its sizes, and by its axis if the kernel has one."""
    axis, choices, also = plan.axis, [], ""
    if axis is not None and not isinstance(axis, str):
        also = dialect.say("has_axis", **dict(zip(AXIS, axis, strict=True)))
    for place, stages in _numbered(plan):
        sizes = dict(zip(SIZES, map(repr, stages.setting.sizes), strict=True))
        choices.append(dialect.say("choose", place=place, sizes=", ".join(sizes.values()), also=also, **sizes))
    return choices


def _searches_text(plan: ScenePlan, dialect: Dialect) -> str:
    """Return the code of the search that all settings share, and of the check of a free axis; empty without both."""
    searches = [search for _, search in _searched(plan)]
    routines = [HAS_DIRECTION] if plan.free else []
    if searches and isinstance(searches[0], TiltedSearch):
        routines.append(FREE_SEARCH if searches[0].free else SEARCH)
    elif searches:
        routines.append(search_of(GEOMETRIC_STEPS + plan.format.bits + 3))
    return f"\n{routines_text(routines, dialect, plan.format.name)}\n" if routines else ""


def _frame(of: TiltedSearch, place: int, dialect: Dialect) -> str:
    """Return the code of a setting's constants: its frame or, if the axis is free, the sizes for computing one."""
    fields = [(name, _pair(value, dialect)) for name, value in of.constants.items()]
    fields += [(name, dialect.literal(value, "float64")) for name, value in (("most", of.most), ("omega", of.omega))]
    values = ",\n    ".join(dialect.say("field", name=name, value=value) for name, value in fields)
    return dialect.say("sizes" if of.free else "frame", place=place, values=f"\n    {values},\n")


def _pair(value: DoubleDouble, dialect: Dialect) -> str:
    """Return a double-double as a constant of the language."""
    high, low = (dialect.literal(part, "float64") for part in value)
    return dialect.say("constant_pair", high=high, low=low)


MOST_SETTINGS = 20_000
"""The most hyperboloids, equal to the limit of a scene file."""

NO_POSITION = 9
"""Takes the place of the position that means yes if the question is the position itself; equal to no position."""

_NUMBER_IN_NOTE = re.compile(r"^lambda = \S+ proves")


@dataclass(frozen=True)
class _Recording(Dialect):
    """A language whose literals are read from the table c. `values` collects the numbers, in the order of c."""

    values: list[float] = field(default_factory=list)

    def literal(self, value: float, precision: str) -> str:  # noqa: ARG002 - as the language has it
        self.values.append(value)
        return f"c[{len(self.values) - 1}]"

    def say(self, phrase: str, **words: object) -> str:
        if phrase == "note":
            words["text"] = _NUMBER_IN_NOTE.sub("lambda proves", str(words["text"]))
        return super().say(phrase, **words)


@dataclass(frozen=True)
class _Shapes:
    """The functions that settings share, called shapes, and the tables of their numbers.

    `texts` are the functions, `rows` the rows of each one's table. Of each setting, `shape` has the place of its
    function in `texts`, and `row` the place of its numbers in that function's table.
    """

    texts: list[str]
    rows: list[list[list[float]]]
    shape: list[int]
    row: list[int]


def whole_plan(scene: SceneModel, precision: str = "float64") -> ScenePlan:
    """Return the plan for all pairs of sizes, with positions as answers. Raises InputError if there is none."""
    bodies = tuple(_taller(body, scene.mover.d) for body in scene.hyperboloids)
    plan = plan_of(replace(scene, question="position", hyperboloids=bodies), precision, MOST_SETTINGS)
    if plan.axis is not None:
        raise InputError(
            "no kernel is made for a whole scene whose mover is tilted; without --whole there is one for its pairs"
        )
    return plan


def _taller(body: Hyperboloid, reach: float) -> Hyperboloid:
    """Return the hyperboloid without flat ends, longer at both ends by `reach`, how far the mover extends up."""
    if body.height is None:
        return body
    far = reach * (1 + 2.0**-40)
    low, high = np.nextafter((body.height.low - far, body.height.high + far), (-np.inf, np.inf)).tolist()
    return replace(body, height=Span(low, high), solid=False)


def emitted_whole(
    scene: SceneModel, plan: ScenePlan, language: str, command: Sequence[str], prefix: str = PREFIX
) -> str:
    """Return the text of the kernel of a whole scene; `plan` is that of whole_plan. Raises InputError."""
    dialect = dialect_of(language)
    tabled = replace(dialect, phrases={**dialect.phrases, **dialect.whole})
    shapes = _shapes(plan, tabled)
    places = range(len(shapes.texts))
    parts = {
        "header": whole_header(plan, scene, command, dialect.comment),
        **_common_parts(plan, dialect, prefix),
        "tables": "\n\n".join(_tables(scene, plan, shapes, tabled)),
        "shapes": dialect.between.join(shapes.texts),
        "cases": "\n".join(tabled.say("case", place=place) for place in places),
        "settings": str(len(plan.settings)),
        "hyperboloids": str(len(_used(scene, plan))),
        "columns": str(1 + len(scene.mover.parts)),
        "region": _region(scene, dialect),
        "question": str(NUMBER_OF[scene.question]),
        "yes": str(POSITION_OF.get(scene.question, NO_POSITION)),
        "radian": repr(radians(1.0)),
        "constants": ", ".join(f"constants_{place}" for place in places) + ",",
    }
    return dialect.filled("whole", parts).strip("\n") + "\n"


def _shapes(plan: ScenePlan, dialect: Dialect) -> _Shapes:
    """Return the shapes of a plan: settings whose functions differ only in numbers share one."""
    shapes, known = _Shapes([], [], [], []), dict[str, int]()
    for stages in plan.settings:
        recording = _Recording(**vars(dialect))
        key = setting_function(plan, stages, 0, recording, shared=True)
        place = known.setdefault(key, len(known))
        if place == len(shapes.texts):
            shapes.texts.append(setting_function(plan, stages, place, _Recording(**vars(dialect)), shared=True))
            shapes.rows.append([])
        shapes.shape.append(place)
        shapes.row.append(len(shapes.rows[place]))
        shapes.rows[place].append(recording.values or [0.0])
    return shapes


def _used(scene: SceneModel, plan: ScenePlan) -> list[tuple[int, list[int]]]:
    """Return the number of each hyperboloid that the mover can reach, with the settings of mover and parts there."""
    places = {stages.setting.sizes: place for place, stages in enumerate(plan.settings)}
    mover, used = scene.mover, []
    spheroids = [(mover.b, mover.d), *((part.b, part.d) for part in mover.parts)]
    for number, body in enumerate(scene.hyperboloids):
        sizes = [(body.alpha, body.gamma, *spheroid) for spheroid in spheroids]
        if all(size in places for size in sizes):
            used.append((number, [places[size] for size in sizes]))
    return used


def _tables(scene: SceneModel, plan: ScenePlan, shapes: _Shapes, dialect: Dialect) -> list[str]:
    """Return the code of the tables: of the settings, of the hyperboloids, and of the constants of searches."""
    precision = plan.format.name
    number, index = dialect.number_of(precision), dialect.types["index"]
    wide = dialect.number_of("float64")

    def table(name: str, rows: Sequence[Sequence[float]], kind: str, own: bool = False) -> str:
        texts = [", ".join(dialect.literal(v, precision) if own else repr(v) for v in row) for row in rows]
        body = "\n".join(f"    {dialect.say('table_row', values=text)}," for text in texts)
        return dialect.say("table", name=name, number=kind, rows=len(rows), columns=len(rows[0]), body=body)

    def column(name: str, values: Sequence[float], kind: str) -> str:
        body = "\n".join(f"    {value!r}," for value in values)
        return dialect.say("list", name=name, number=kind, rows=len(values), body=body)

    used = _used(scene, plan)
    bodies = bodies_of([scene.hyperboloids[number] for number, _ in used])
    far = reaches(bodies, scene.mover, scene.region.z)
    with np.errstate(over="ignore"):
        ends = np.where(np.isinf(bodies.heights), 0, np.abs(bodies.heights)).max(axis=1)
        loose = 2.0**-45 * (ends + np.abs(bodies.origins[:, 2]) + scene.mover.d)
        limits = np.stack(
            [*bodies.origins.T, *bodies.heights.T, loose, bodies.solid, far * far * (1 + 2.0**-40)], axis=1
        )
    limits = np.clip(limits, -float_info.max, float_info.max)
    tables = [
        table("sizes_of", [list(stages.setting.sizes) for stages in plan.settings], wide),
        column("shape", shapes.shape, index),
        column("row", shapes.row, index),
        *(table(f"constants_{place}", rows, number, own=True) for place, rows in enumerate(shapes.rows)),
        table("places", limits.tolist(), wide),
        table("settings_of", [places for _, places in used], index),
        table("arms", [[0.0, 0.0], *([part.arm, radians(part.angle)] for part in scene.mover.parts)], wide),
    ]
    return [*tables, _searches(plan, dialect)] if _searched(plan) else tables


def _searches(plan: ScenePlan, dialect: Dialect) -> str:
    """Return the table of the constants of the searches, a row for each setting; rows without a search hold 1."""

    def row(search: object) -> str:
        constants = search.constants if isinstance(search, DualSearch) else dict.fromkeys(SETTING, 1.0)
        fields = ((name, dialect.literal(constants[name], plan.format.name)) for name in SETTING)
        values = ", ".join(dialect.say("field", name=name, value=value) for name, value in fields)
        return f"    {dialect.say('search_row', values=values)},"

    body = "\n".join(row(stages.last) for stages in plan.settings)
    return dialect.say("searches", rows=len(plan.settings), body=body)


def _region(scene: SceneModel, dialect: Dialect) -> str:
    """Return the condition that a centre is in the region; where the region is open, that it is finite."""
    spans = zip("xyz", scene.region.spans, strict=True)
    most = float_info.max
    ends = [(name, *((-most, most) if span is None else (span.low, span.high))) for name, span in spans]
    conditions = [condition for name, low, high in ends for condition in (f"{name} >= {low!r}", f"{name} <= {high!r}")]
    return dialect.say("and", left="", right="").join(conditions)
