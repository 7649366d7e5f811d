"""What takes which columns of a row: each command and function is called with every set of groups.

`make seams` prints the table into docs/rows.md. What refuses a set says why; the reasons are below the table, word for
word but for the numbers and the paths in them.
"""

from __future__ import annotations

import io
import itertools
import json
import re
import sys
import tempfile
from collections.abc import Callable, Mapping
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path

import numpy as np

import hypcheck
from hypcheck.cli.main import main
from hypcheck.errors import InputError
from hypcheck.vectors import frozen

PAGE = Path(__file__).parents[2] / "docs" / "rows.md"
BEGIN, END = "<!-- what takes which groups: make seams -->\n", "<!-- end -->\n"

ROW = {"alpha": 1.0, "gamma": 2.0, "b": 1.0, "d": 0.5, "x": 2.5, "y": 0.0, "z": 0.25}
GROUPS: Mapping[str, Mapping[str, float]] = {
    "end": {"x1": 3.0, "y1": 1.0, "z1": 0.5},
    "axis": {"axis_x": 1.0, "axis_y": 0.0, "axis_z": 2.0},
    "heights": {"z_min": -3.0, "z_max": 3.0, "solid": 0.0},
}
SETS = [chosen for count in range(len(GROUPS) + 1) for chosen in itertools.combinations(GROUPS, count)]

Groups = tuple[str, ...]


class RefusedError(Exception):
    """A set of groups is refused; the text is the reason."""


def columns(groups: Groups) -> dict[str, float]:
    """The row with these groups, by name."""
    return ROW | {name: value for group in groups for name, value in GROUPS[group].items()}


def vector(group: str) -> tuple[float, ...]:
    """The numbers of a group."""
    return tuple(GROUPS[group].values())


def command(*words: str) -> None:
    """Run hypcheck with these words. Raises RefusedError with what it says where it ends with 2."""
    said = io.StringIO()
    with redirect_stdout(io.StringIO()), redirect_stderr(said):
        code = main(list(words))
    if code == 2:
        lines = [line for line in said.getvalue().splitlines() if "error: " in line]
        raise RefusedError(lines[-1].partition("error: ")[2] if lines else said.getvalue())


def one_pair(groups: Groups) -> None:
    """`hypcheck classify` with options."""
    options = {"end": "--end", "axis": "--axis"}
    words = [word for name in ("alpha", "gamma", "b", "d") for word in (f"--{name}", repr(ROW[name]))]
    words += ["--center", *(repr(ROW[name]) for name in "xyz")]
    for group in groups:
        words += [options.get(group, "--z-min"), *map(repr, vector(group)[: 1 if group == "heights" else 3])]
    command("classify", *words)


def table(ending: str) -> Callable[[Groups], None]:
    """`hypcheck classify --input` of a table."""

    def ask(groups: Groups) -> None:
        row, path = columns(groups), Path(f"in.{ending}")
        if ending == "csv":
            path.write_text(f"{','.join(row)}\n{','.join(map(repr, row.values()))}\n")
        else:
            path.write_text(json.dumps(row) + "\n")
        command("classify", "--input", str(path), "--output", f"out.{ending}")

    return ask


def keywords(
    function: Callable[..., object], taken: Mapping[str, Callable[[], Mapping[str, object]]]
) -> Callable[[Groups], None]:
    """A function that names groups by keywords; of others it has no word."""

    def ask(groups: Groups) -> None:
        for group in groups:
            if group not in taken:
                raise RefusedError("it has no argument for them")
        function(**{name: value for group in groups for name, value in taken[group]().items()})

    return ask


SIZES = (1.0, 2.0, 1.0, 0.5)
AXIS = {"axis": lambda: {"axis": vector("axis")}}


def rows_of_arrays(function: Callable[[np.ndarray], object]) -> Callable[[Groups], None]:
    """A function of an array of rows without names: seven numbers, ten with an axis, thirteen with heights behind."""

    def ask(groups: Groups) -> None:
        if "end" in groups:
            raise RefusedError("an array has no names of columns: ten numbers are a pair with an axis")
        filled = ("axis", "heights") if "heights" in groups else groups
        function(np.array([list(columns(filled).values())]))

    return ask


def passage(groups: Groups) -> None:
    """`hypcheck.passage`, which is about a sweep."""
    if "end" not in groups:
        raise RefusedError("it is about a sweep; without an end ask position")
    axis = vector("axis") if "axis" in groups else None
    heights = GROUPS["heights"] if "heights" in groups else {}
    hypcheck.passage(SIZES, (2.5, 0.0, 0.25), vector("end"), axis, **heights)


SCENE = """
name = "s"
question = "position"
[[hyperboloid]]
alpha = 1.0
gamma = 2.0
{height}
[mover]
b = 1.0
d = 0.5
{axis}
{part}
"""


def scene(method: str, *, part: bool = False) -> Callable[[Groups], None]:
    """A method of Scene; the axis is the mover's."""

    def ask(groups: Groups) -> None:
        if ("end" in groups) != (method == "passage"):
            raise RefusedError("Scene.passage is about sweeps, the other methods are about positions")
        axis = f"axis = {list(vector('axis'))}" if "axis" in groups else ""
        height = "height = [-3.0, 3.0]" if "heights" in groups else ""
        parts = "[[mover.part]]\nb = 0.2\nd = 0.1\narm = 0.5\n" if part else ""
        here = hypcheck.Scene.from_text(SCENE.format(axis=axis, height=height, part=parts))
        if method == "passage":
            here.passage((2.5, 0.0, 0.25), vector("end"))
        else:
            getattr(here, method)(2.5, 0.0, 0.25)

    return ask


IMPLEMENTATION = """
import numpy as np
hypcheck = {description!r}
def answers(rows):
    return np.zeros(len(rows), dtype=int)
"""


def spec(*words: str) -> Callable[[Groups], None]:
    """A command with a SPEC whose description takes the groups, CASE being a frozen case of that kind."""

    def ask(groups: Groups) -> None:
        takes = [group for group in groups if group != "end"]
        description = {"takes": takes, "question": "passage" if "end" in groups else "position"}
        Path("taking.py").write_text(IMPLEMENTATION.format(description=description))
        ended = "heights" in groups and "end" not in groups
        kind = "way-uniform" if "end" in groups else "ended-uniform" if ended else "uniform"
        kind = ("tilted-" if "axis" in groups else "") + kind
        case = next(case.id for case in frozen.load(kind).cases if case.answer)  # 0 is wrong, so it can be minimised
        places = {"SPEC": "python:taking.py:answers", "CASE": case, "FAMILY": kind}
        places["WORKLOAD"] = "frozen" if "end" in groups else "stiff" if "axis" in groups else "ring"
        extra = []
        if words[0] == "bench":
            extra = ["--question", "passage"] if "end" in groups else []
            extra += ["--tilted"] if "axis" in groups else []
        command(*(places.get(word, word) for word in words), *extra, "--isolate", "off")

    return ask


def emit(groups: Groups) -> None:
    """`hypcheck emit`, of a scene; with an end, about sweeps in it."""
    sweeps = ["--sweeps"] if "end" in groups else []
    axis = f"axis = {list(vector('axis'))}" if "axis" in groups else ""
    height = "height = [-3.0, 3.0]" if "heights" in groups else ""
    Path("scene.toml").write_text(SCENE.format(axis=axis, height=height, part=""))
    command("emit", "--scene", "scene.toml", "--language", "c", "--output", "kernel.c", *sweeps)


ASKED: Mapping[str, Callable[[Groups], None]] = {
    "`hypcheck classify`, one row": one_pair,
    "`hypcheck classify`, CSV": table("csv"),
    "`hypcheck classify`, JSON lines": table("jsonl"),
    "`hypcheck.classify(rows)`": rows_of_arrays(hypcheck.classify),
    "`hypcheck.classify` of columns by name": lambda groups: hypcheck.classify(columns(groups)),
    "`hypcheck.clearance(rows)`": rows_of_arrays(hypcheck.clearance),
    "`hypcheck.classify_scene`": keywords(
        lambda **others: hypcheck.classify_scene(SIZES, 2.5, 0.0, 0.25, **others),
        {**AXIS, "heights": lambda: GROUPS["heights"]},
    ),
    "`hypcheck.clearance` of columns by name": lambda groups: hypcheck.clearance(columns(groups)),
    "`hypcheck.position`": keywords(
        lambda **others: hypcheck.position(*SIZES, 2.5, 0.0, 0.25, **others),
        {**AXIS, "heights": lambda: GROUPS["heights"]},
    ),
    "`hypcheck.passage`": passage,
    "`Scene.classify`, `Scene.position`": scene("classify"),
    "`Scene.classify`, a mover with parts": scene("classify", part=True),
    "`Scene.nearest`": scene("nearest"),
    "`Scene.passage`": scene("passage"),
    "`hypcheck verify SPEC`": spec("verify", "SPEC", "--families", "FAMILY", "--count", "2", "--out", "verified"),
    "`hypcheck replay`": spec("replay", "CASE", "SPEC"),
    "`hypcheck minimise`": spec("minimise", "SPEC", "CASE"),
    "`hypcheck hunt`": spec("hunt", "SPEC", "--queries", "200"),
    "`hypcheck bench SPEC`": spec("bench", "SPEC", "--quick", "--workloads", "WORKLOAD", "--out", "measured"),
    "`hypcheck emit`": emit,
}

_OURS = re.compile(r"(?<=')[^']*(?=taking\.py)|\S*(?=taking\.py)")


def reason_of(ask: Callable[[Groups], None], groups: Groups) -> str | None:
    """Why a set of groups is refused; None where it is taken."""
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        try:
            ask(groups)
        except (RefusedError, InputError) as error:
            return _OURS.sub("", str(error))
    return None


def page_table() -> str:
    """The table with its reasons, in Markdown."""
    reasons: dict[str, int] = {}
    lines = [
        f"| | {' | '.join(', '.join(groups) or 'none' for groups in SETS)} |",
        f"| --- |{' --- |' * len(SETS)}",
    ]
    for name, ask in ASKED.items():
        cells = []
        for groups in SETS:
            reason = reason_of(ask, groups)
            cells.append("yes" if reason is None else str(reasons.setdefault(reason, len(reasons) + 1)))
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join([*lines, "", *(f"{number}. {reason}" for reason, number in reasons.items())]) + "\n"


def page(text: str) -> str:
    """The page with the table of today in it."""
    before, _, rest = text.partition(BEGIN)
    return f"{before}{BEGIN}\n{page_table()}\n{END}{rest.partition(END)[2]}"


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    sys.exit(0)
