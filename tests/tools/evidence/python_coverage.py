"""The part `python-coverage`: lines and branches of the package that the tests and their children run."""

from __future__ import annotations

import json
import os
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

LEFT = {
    "hypcheck/engines": "`make engines` runs it, with engines that are not installed here",
    "hypcheck/report/plots": "pictures that `make thorough` and `make figures` draw",
    "hypcheck/proofs": "Coq, where it is not installed; `make prove` runs it",
    "hypcheck/bench": "what `make thorough` compiles and times, and peers that are missing here",
    "hypcheck/isolation": "systems without namespaces, Landlock or limits; one machine has one of each choice",
    "hypcheck/paper": "what `make thorough` runs",
    "hypcheck/runs/cluster.py": "clusters, which `make thorough` runs",
    "hypcheck/runs/dask_executor.py": "clusters, which `make thorough` runs",
}
"""Why most of what is left in a folder, or in a file, is left."""


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
        name: {"lines": _stretches(found["missing_lines"]), "branches": len(found["missing_branches"])}
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
        "missing": missing,
    }


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
    rows = [
        f"| `{name}` | {found['lines'] or '-'} | {found['branches']} | {reason(name)} |"
        for name, found in figures["missing"].items()
    ]
    lines, branches, both = (figures[key] for key in ("percent of lines", "percent of branches", "percent"))
    text = f"""\
The tests, without {figures["left out"]},
run {lines} % of the {figures["statements"]} statements and {branches} % of the {figures["branches"]} branches of the
package, {both} % of both together; processes that the tests start count, if they have the same environment. What is
under `[tool.coverage]` in `pyproject.toml` does not count. What is left, and why where the reason is one of a folder:

| file | lines | branches | reason |
| --- | --- | --- | --- |
"""
    return text + "\n".join(rows)


def reason(name: str) -> str:
    """Why lines of a file are left."""
    known = [why for place, why in LEFT.items() if name == place or name.startswith(f"{place}/")]
    return known[-1] if known else "not explained yet"


if __name__ == "__main__":  # `python -m tests.tools.evidence.python_coverage ROOM...` measures these rooms anew
    measure_rooms({room: rooms()[room] for room in sys.argv[1:]})
