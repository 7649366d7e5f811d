"""A kernel for a whole scene: its hyperboloids and their places, heights, the mover's parts, and the loop over them.

Settings whose functions differ only in their numbers share one, a *shape*, which reads the numbers from a table; its
statements, and so its arithmetic, are those of the functions that functions.py writes. So a kernel grows by a line a
hyperboloid, and there may be as many as a scene has.

Each pair of sizes is asked for its position, as `verify` asks of any kernel. The whole is put together as
hypcheck.Scene does it (kernel/scene.py): contact with any hyperboloid is contact, else inside any is interior, else
exterior; parts are asked where the mover has contact. The offset from a hyperboloid's centre is rounded once, a change
of that coordinate by a unit more. Of a spheroid that reaches over an end only bounds are asked, those of
kernel/scene_pairs.py; where they do not tell, the answer is 2.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import radians
from sys import float_info

import numpy as np

from hypcheck.errors import InputError
from hypcheck.kernel.choice import NUMBER_OF, POSITION_OF
from hypcheck.kernel.emission import kernel
from hypcheck.kernel.emission.dialects import DIALECTS, Dialect
from hypcheck.kernel.emission.functions import setting_function
from hypcheck.kernel.emission.plan_text import whole_header
from hypcheck.kernel.scene_index import bodies_of, reaches
from hypcheck.kernel.specialise.last_stages import DualSearch
from hypcheck.kernel.specialise.plan import ScenePlan, plan_of
from hypcheck.kernel.specialise.tilted_search import SETTING
from hypcheck.scene.model import Hyperboloid, SceneModel, Span

MOST_SETTINGS = 20_000
"""The most hyperboloids, equal to the limit of a scene file."""

NO_POSITION = 9
"""Stands for the position that answers yes, where the question is the position itself and nothing is compared."""

_NUMBER_IN_NOTE = re.compile(r"^lambda = \S+ proves")

_SHAPE = {
    "c": {
        "begin": "static int shape_{place}({number} x, {number} y, {number} z, const {number} *c, int s)\n{{",
        "constant": "const {number} {name} = {value};",
        "search": "search(R, zz, height, &searches[s])",
    },
    "cpp": {
        "begin": "static int shape_{place}({number} x, {number} y, {number} z, const {number} *c, int s)\n{{",
        "constant": "const {number} {name} = {value};",
        "search": "search(R, zz, height, searches[s])",
    },
    "rust": {
        "begin": "fn shape_{place}(x: {number}, y: {number}, z: {number}, c: &[{number}], s: usize) -> i8 {{",
        "constant": "let {name}: {number} = {value};",
        "search": "search(R, zz, height, &SEARCHES[s])",
    },
    "javascript": {
        "begin": "function shape_{place}(x, y, z, c, s) {{",
        "search": "search(R, zz, height, searches[s])",
    },
    "python": {
        "begin": "def shape_{place}(x: float, y: float, z: float, c: tuple[float, ...], s: int) -> int:",
        "search": "search(R, zz, height, *SEARCHES[s])",
    },
}

_TABLES = {
    "c": {
        "table": "static const {type} {name}[{rows}][{columns}] = {{\n{body}\n}};",
        "list": "static const {type} {name}[{rows}] = {{\n{body}\n}};",
        "row": "{{{values}}}",
        "searches": "static const setting searches[{rows}] = {{\n{body}\n}};",
        "case": "case {place}: return shape_{place}(x, y, z, constants_{place}[row[s]], s);",
    },
    "rust": {
        "table": "static {name}: [[{type}; {columns}]; {rows}] = [\n{body}\n];",
        "list": "static {name}: [{type}; {rows}] = [\n{body}\n];",
        "row": "[{values}]",
        "searches": "static SEARCHES: [Setting; {rows}] = [\n{body}\n];",
        "case": "{place} => shape_{place}(x, y, z, &constants_{place}[row[s]], s),",
    },
    "javascript": {
        "table": "const {name} = [\n{body}\n];",
        "list": "const {name} = [\n{body}\n];",
        "row": "[{values}]",
        "searches": "const searches = [\n{body}\n];",
        "case": "case {place}: return shape_{place}(x, y, z, constants_{place}[row[s]], s);",
    },
    "python": {
        "table": "{name} = (\n{body}\n)",
        "list": "{name} = (\n{body}\n)",
        "row": "({values},)",
        "searches": "SEARCHES = (\n{body}\n)",
        "case": "shape_{place},",
    },
}
_TABLES["cpp"] = {
    **_TABLES["c"],
    "table": "constexpr {type} {name}[{rows}][{columns}] = {{\n{body}\n}};",
    "list": "constexpr {type} {name}[{rows}] = {{\n{body}\n}};",
    "searches": "constexpr Setting searches[{rows}] = {{\n{body}\n}};",
}
_WHOLE_NUMBERS = {"rust": "usize"}
_SEARCH_ROW = {"rust": "Setting {{{values}}}", "javascript": "{{{values}}}"}


@dataclass(frozen=True)
class _Recording(Dialect):
    """A language in which every number of a setting is read from the table c, and is kept in `values`."""

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
    """The functions that settings share, the tables of their numbers, and of each setting which it has, and its row."""

    texts: list[str]
    rows: list[list[list[float]]]
    shape: list[int]
    row: list[int]


def whole_plan(scene: SceneModel, precision: str = "float64") -> ScenePlan:
    """The plan for all pairs of sizes, with positions as answers. Raises InputError if the scene has no such kernel."""
    bodies = tuple(_taller(body, scene.mover.d) for body in scene.hyperboloids)
    plan = plan_of(replace(scene, question="position", hyperboloids=bodies), precision, MOST_SETTINGS)
    if plan.axis is not None:
        raise InputError(
            "no kernel is made for a whole scene whose mover is tilted; without --whole there is one for its pairs"
        )
    return plan


def _taller(body: Hyperboloid, reach: float) -> Hyperboloid:
    """The open hyperboloid, longer at both ends by `reach`, which is how far the mover extends up and down."""
    if body.height is None:
        return body
    far = reach * (1 + 2.0**-40)
    low, high = np.nextafter((body.height.low - far, body.height.high + far), (-np.inf, np.inf)).tolist()
    return replace(body, height=Span(low, high), solid=False)


def whole(
    scene: SceneModel, plan: ScenePlan, language: str, command: Sequence[str], prefix: str = kernel.PREFIX
) -> str:
    """The text of the kernel of a scene, whose plan is whole_plan's. Raises InputError."""
    kernel.require_prefix(prefix, language)
    dialect = DIALECTS[language]
    searched = any(isinstance(stages.last, DualSearch) for stages in plan.settings)
    shapes = _shapes(plan, dialect)
    parts = {
        "header": whole_header(plan, scene, command, dialect.comment),
        "prefix": prefix,
        **kernel.prologue(dialect),
        "number": dialect.number_of(plan.format.name),
        "round": "Math.fround" if plan.format.name == "float32" else "Number",
        "search": kernel.search_text(plan, dialect) if searched else "",
        "tables": "\n\n".join(_tables(scene, plan, shapes, searched, dialect)),
        "shapes": ("\n\n\n" if language == "python" else "\n\n").join(shapes.texts),
        "cases": "\n".join(_TABLES[language]["case"].format(place=place) for place in range(len(shapes.texts))),
        "settings": str(len(plan.settings)),
        "hyperboloids": str(len(_used(scene, plan))),
        "columns": str(1 + len(scene.mover.parts)),
        "region": _region(scene, language),
        "question": str(NUMBER_OF[scene.question]),
        "yes": str(POSITION_OF.get(scene.question, NO_POSITION)),
        "radian": repr(radians(1.0)),
        "constants": ", ".join(f"constants_{place}" for place in range(len(shapes.texts))) + ",",
        "description": kernel.description_in_language(kernel.description(plan, language), language, prefix),
    }
    return dialect.filled("whole", parts).strip("\n") + "\n"


def _shapes(plan: ScenePlan, dialect: Dialect) -> _Shapes:
    shapes, known = _Shapes([], [], [], []), dict[str, int]()
    phrases = {**dialect.phrases, **_SHAPE[dialect.name]}
    for stages in plan.settings:
        recording = _Recording(**{**vars(dialect), "phrases": phrases})
        key = setting_function(plan, stages, 0, recording, shared=True)
        place = known.setdefault(key, len(known))
        if place == len(shapes.texts):
            again = _Recording(**{**vars(dialect), "phrases": phrases})
            shapes.texts.append(setting_function(plan, stages, place, again, shared=True))
            shapes.rows.append([])
        shapes.shape.append(place)
        shapes.row.append(len(shapes.rows[place]))
        shapes.rows[place].append(recording.values or [0.0])
    return shapes


def _used(scene: SceneModel, plan: ScenePlan) -> list[tuple[int, list[int]]]:
    """The hyperboloids that the mover can reach, and the settings of the mover and its parts beside each."""
    places = {stages.setting.sizes: place for place, stages in enumerate(plan.settings)}
    mover, used = scene.mover, []
    spheroids = [(mover.b, mover.d), *((part.b, part.d) for part in mover.parts)]
    for number, body in enumerate(scene.hyperboloids):
        sizes = [(body.alpha, body.gamma, *spheroid) for spheroid in spheroids]
        if all(size in places for size in sizes):
            used.append((number, [places[size] for size in sizes]))
    return used


def _tables(scene: SceneModel, plan: ScenePlan, shapes: _Shapes, searched: bool, dialect: Dialect) -> list[str]:
    say, precision = _TABLES[dialect.name], plan.format.name
    number, index = dialect.number_of(precision), _WHOLE_NUMBERS.get(dialect.name, "int")
    wide = dialect.number_of("float64")

    def table(name: str, rows: Sequence[Sequence[float]], kind: str, own: bool = False) -> str:
        texts = [", ".join(dialect.literal(v, precision) if own else repr(v) for v in row) for row in rows]
        body = "\n".join(f"    {say['row'].format(values=text)}," for text in texts)
        return say["table"].format(name=name, type=kind, rows=len(rows), columns=len(rows[0]), body=body)

    def column(name: str, values: Sequence[float], kind: str) -> str:
        body = "\n".join(f"    {value!r}," for value in values)
        return say["list"].format(name=name, type=kind, rows=len(values), body=body)

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
    return [*tables, _searches(plan, dialect)] if searched else tables


def _searches(plan: ScenePlan, dialect: Dialect) -> str:
    """The table of the constants of the searches, a row for each setting; rows without a search hold 1."""

    def row(search: object) -> str:
        constants = search.constants if isinstance(search, DualSearch) else dict.fromkeys(SETTING, 1.0)
        fields = ((name, dialect.literal(constants[name], plan.format.name)) for name in SETTING)
        values = ", ".join(dialect.say("field", name=name, value=value) for name, value in fields)
        shape = _SEARCH_ROW.get(dialect.name, _TABLES[dialect.name]["row"])
        return f"    {shape.format(values=values)},"

    body = "\n".join(row(stages.last) for stages in plan.settings)
    return _TABLES[dialect.name]["searches"].format(rows=len(plan.settings), body=body)


def _region(scene: SceneModel, language: str) -> str:
    """The condition under which a centre is in the region: finite at least."""
    spans = zip("xyz", (scene.region.x, scene.region.y, scene.region.z), strict=True)
    most = float_info.max
    ends = [(name, *((-most, most) if span is None else (span.low, span.high))) for name, span in spans]
    joined = " and " if language == "python" else " && "
    return joined.join(f"{name} >= {json.dumps(low)}{joined}{name} <= {json.dumps(high)}" for name, low, high in ends)
