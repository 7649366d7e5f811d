"""The part `python-coverage`: lines and branches of the package that the tests and their children run."""

from __future__ import annotations

import ast
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tests.tools.evidence.parts import ROOT, Figures, Unavailable

TITLE = "Lines and branches of the Python package"

DATA = ROOT / "build" / "evidence" / "coverage"
"""What each room's tests ran: the mutants' tests are chosen by it."""

PACKAGE = "hypcheck"

LEFT = Path(__file__).with_name("uncovered.json")
"""Why no test runs some lines or branches of a function, a sentence by file and function."""

KINDS = {
    "assertion": "an assertion that what the lines before it exclude does not happen",
    "mistake": "an error about a wrong call of our own functions, which no test that ran makes",
    "failing system": "the system would have to fail in a way that no test that ran provokes",
    "command": "the command that writes a file anew; a test compares the file with what it would write",
    "loop": "no test that ran has an input for which the loop runs out",
    "system": "another system, another Python, or an installation without a C compiler",
}
"""The reasons that the code itself tells."""


def measure() -> Figures:
    """The tests of each room under coverage, two rooms at a time; `rooms` names what is measured."""
    try:
        import coverage  # noqa: F401 - only asked for
    except ImportError:
        raise Unavailable("coverage is missing; the extra `dev` has it") from None
    shutil.rmtree(DATA, ignore_errors=True)
    measure_rooms(rooms())
    return kept_figures()


def rooms() -> dict[str, list[str]]:
    """The tests of each room; those beside the rooms have the name top."""
    folders = sorted(path for path in (ROOT / "tests").iterdir() if any(path.glob("**/test_*.py")))
    found = {path.name: [f"tests/{path.name}"] for path in folders}
    return found | {"top": [f"tests/{path.name}" for path in sorted((ROOT / "tests").glob("test_*.py"))]}


def measure_rooms(chosen: Mapping[str, Iterable[str]]) -> None:
    """Run the tests of these rooms; what other rooms covered stays kept."""
    with ThreadPoolExecutor(LANES) as lanes:
        for done in [lanes.submit(ran, room, paths) for room, paths in chosen.items()]:
            done.result()


LANES = 2
"""So many rooms are measured at a time."""

CONTEXTS, CHILDREN = "tests.tools.evidence.contexts", "tests.tools.evidence.children"


def ran(room: str, paths: Iterable[str]) -> None:
    """Run the tests of a room; what they covered is kept in DATA.

    What `make test` runs is kept by test, for the mutants; the thorough tests, which no mutant meets, apart from it.
    """
    paths = [*paths]
    _ran(room, "-m", "not thorough", "-p", CONTEXTS, *paths)
    _ran(f"{room}-thorough", "-m", "thorough", *paths)


def ran_in_part(room: str, paths: Iterable[str]) -> None:
    """Run all tests of some files of a room, where its thorough ones together take too long; they are kept apart."""
    _ran(f"{room}-part", *paths)


def _ran(name: str, *words: str) -> None:
    place = DATA / name
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    _coverage(place, "run", "-m", "pytest", "-q", "-p", "no:xdist", "-p", "no:cacheprovider", "-p", CHILDREN, *words)
    if any(place.glob("c.*")):
        _coverage(place, "combine", "-q", str(place))


def _coverage(place: Path, *words: str) -> None:
    """Run coverage on the data of a place; what it prints is added to the log there."""
    environment = os.environ | {"HYPCHECK_COVERAGE": str(place / "c")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # a thousand processes would compile all modules
    with open(place / "log", "a", encoding="utf-8") as log:
        command = [sys.executable, "-m", "coverage", *words]
        done = subprocess.run(command, cwd=ROOT, env=environment, stdout=log, stderr=log, check=False)
    if done.returncode not in (0, 1, NO_TESTS):  # 1: a test failed, as a slow one may
        raise Unavailable(f"`coverage {words[0]}` ended with {done.returncode}; {place / 'log'} says more")


NO_TESTS = 5
"""The exit code of pytest where no test is chosen, as in a room without thorough tests."""


def kept_figures() -> Figures:
    """The figures of what all rooms covered that are kept."""
    return figures_of(sorted(DATA.glob("*/c")))


def figures_of(data: list[Path]) -> Figures:
    """The figures of what several rooms covered together."""
    whole = DATA.parent / "whole"
    shutil.rmtree(whole, ignore_errors=True)
    whole.mkdir(parents=True)
    _coverage(whole, "combine", "-q", "--keep", *map(str, data))
    _coverage(whole, "json", "-q", "-o", str(whole / "report.json"))
    report = json.loads((whole / "report.json").read_text(encoding="utf-8"))
    totals = report["totals"]
    missing = {
        name: by_function(name, found["missing_lines"], found["missing_branches"])
        for name, found in sorted(report["files"].items())
        if found["missing_lines"] or found["missing_branches"]
    }
    return {
        "statements": totals["num_statements"],
        "statements covered": totals["covered_lines"],
        "branches": totals["num_branches"],
        "branches covered": totals["covered_branches"],
        "percent": round(totals["percent_covered"], 1),
        "percent of lines": round(100 * totals["covered_lines"] / totals["num_statements"], 1),
        "percent of branches": round(100 * totals["covered_branches"] / totals["num_branches"], 1),
        "files": sorted(report["files"]),
        "as of": _commit(),
        "left out": left_out(),
        "in part": sorted(path.parent.name.removesuffix("-part") for path in DATA.glob("*-part/c")),
        "missing": missing,
    }


def _commit() -> str:
    command = ["git", "log", "-1", "--format=%h"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip() or "an unknown commit"


def left_out() -> list[str]:
    """The rooms whose tests are not measured, or whose thorough ones are not."""
    names = [name for room in rooms() for name in (room, f"{room}-thorough")]
    return [name for name in names if not (DATA / name / "c").exists()]


def by_function(name: str, lines: list[int], branches: list[list[int]]) -> dict[str, Figures]:
    """What is left of a file, by function; a branch from or to a line that is left is not named beside that line."""
    tree = ast.parse((ROOT / name).read_text(encoding="utf-8"))
    inner = _innermost(tree)
    left: dict[str, tuple[list[int], list[int]]] = {}
    for line in lines:
        left.setdefault(inner.get(line, "the module"), ([], []))[0].append(line)
    for start, end in branches:
        if not {start, end} & {*lines}:
            left.setdefault(inner.get(start, "the module"), ([], []))[1].append(start)
    kinds = _kinds(tree)
    found: dict[str, Figures] = {}
    for function, (here, starts) in left.items():
        told = {*(kinds["lines"].get(line) for line in here), *(kinds["branches"].get(start) for start in starts)}
        found[function] = {
            "lines": _stretches(here),
            "branches": [*map(str, starts)],
            "kinds": sorted(map(str, told)) if None not in told else [],
        }
    return found


def _innermost(tree: ast.Module) -> dict[int, str]:
    """The name of the innermost function of each line, with its class."""
    found: dict[int, str] = {}

    def visit(node: ast.AST, outer: str) -> None:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
                name = f"{outer}.{child.name}" if outer else child.name
                found.update(dict.fromkeys(range(child.lineno, (child.end_lineno or 0) + 1), name))
                visit(child, name)
            else:
                visit(child, outer)

    visit(tree, "")
    return found


def _kinds(tree: ast.Module) -> dict[str, dict[int, str]]:
    """Lines and branches whose reason the code itself tells, by the names of KINDS."""
    lines: dict[int, str] = {}
    branches: dict[int, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Raise):
            name = ast.unparse(node).removeprefix("raise ").partition("(")[0]
            if name == "AssertionError":
                _mark(lines, [node], "assertion")
            elif name in {"TypeError", "ValueError", "KeyError", "ArithmeticError", "NotImplementedError"}:
                _mark(lines, [node], "mistake")
        elif isinstance(node, ast.For):
            branches[node.lineno] = "loop"
        elif isinstance(node, ast.If) and ast.unparse(node.test) == "__name__ == '__main__'":
            _mark(lines, node.body, "command")
        elif isinstance(node, ast.If) and _SYSTEM.search(ast.unparse(node.test)):
            branches[node.lineno] = "system"
            _mark(lines, [*node.body, *node.orelse], "system")
        elif isinstance(node, ast.ExceptHandler) and "_calls = None" in ast.unparse(node):
            _mark(lines, [node], "system")
        elif isinstance(node, ast.ExceptHandler) and node.type and ast.unparse(node.type) in _OF_THE_SYSTEM:
            _mark(lines, [node], "failing system")
    return {"lines": lines, "branches": branches}


_SYSTEM = re.compile(r"sys\.(platform|version_info)|hasattr\((signal|util|os|sys)")
_OF_THE_SYSTEM = {"OSError", "BlockingIOError", "ProcessLookupError", "ChildProcessError", "BrokenPipeError"}


def _mark(lines: dict[int, str], nodes: Iterable[ast.stmt | ast.ExceptHandler], kind: str) -> None:
    for node in nodes:
        lines.update(dict.fromkeys(range(node.lineno, (node.end_lineno or 0) + 1), kind))


def _stretches(lines: list[int]) -> str:
    """Ascending numbers as stretches: 3-5, 9."""
    found: list[list[int]] = []
    for line in lines:
        if found and line == found[-1][1] + 1:
            found[-1][1] = line
        else:
            found.append([line, line])
    return ", ".join(str(first) if first == last else f"{first}-{last}" for first, last in found)


def section(figures: Figures) -> str:
    """The text about lines and branches."""
    reasons = reasons_of(figures)
    rows = [
        f"| `{name}` | {function} | {found['lines'] or '-'} | {', '.join(found['branches']) or '-'} "
        f"| {reasons[f'{name}:{function}']} |"
        for name, functions in figures["missing"].items()
        for function, found in functions.items()
    ]
    lines, branches, both = (figures[key] for key in ("percent of lines", "percent of branches", "percent"))
    left, part = {*figures["left out"]}, {*figures["in part"]}
    whole = {name for name in left if not name.endswith("-thorough")}
    thorough = {name.removesuffix("-thorough") for name in left} - whole
    but = f", without those of {', '.join(sorted(whole - part))}" if whole - part else ""
    but += f", without the thorough ones of {', '.join(sorted(thorough - part))}" if thorough - part else ""
    but += f", with only some of those of {', '.join(sorted(whole & part))}" if whole & part else ""
    but += f", with only some of the thorough ones of {', '.join(sorted(thorough & part))}" if thorough & part else ""
    text = f"""\
All tests, including the thorough ones{but},
run {lines} % of the {figures["statements"]} statements and {branches} % of the {figures["branches"]} branches of the
package, {both} % of both together. Processes that the tests start are counted, except isolated ones. Code excluded
under `[tool.coverage]` in `pyproject.toml` is not counted. The table lists the lines that no test runs, and the lines
with a branch that no test takes, as of {figures["as of"]}.

| file | function | lines | branches | reason |
| --- | --- | --- | --- | --- |
"""
    return text + "\n".join(rows)


UNEXPLAINED = "not explained yet"


def reasons_of(figures: Figures) -> dict[str, str]:
    """Why no test runs what is left, by file and function."""
    known: dict[str, str] = json.loads(LEFT.read_text(encoding="utf-8"))
    return {
        f"{name}:{function}": known.get(
            f"{name}:{function}", "; ".join(KINDS[each] for each in found["kinds"]) or UNEXPLAINED
        )
        for name, functions in figures["missing"].items()
        for function, found in functions.items()
    }


if __name__ == "__main__":  # ROOM... measures these rooms anew, and PATH... these tests in part
    measure_rooms({room: rooms()[room] for room in sys.argv[1:] if "/" not in room})
    for room in rooms():
        if paths := [path for path in sys.argv[1:] if path.startswith(f"tests/{room}/")]:
            ran_in_part(room, paths)
