"""The part `python-mutants`: small changes of the truth, the Python kernel, the record and the score, against tests."""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

from tests.tools.evidence.mutant_runs import USUAL_S
from tests.tools.evidence.mutations import Mutation, mutations
from tests.tools.evidence.parts import ROOT, Figures, Unavailable
from tests.tools.evidence.python_coverage import DATA

TITLE = "Mutants of the Python code"

SEED = "25"

SAMPLES = {
    "truth": (1000, ["hypcheck/truth/**/*.py"]),
    "kernel": (
        600,
        [
            "hypcheck/kernel/*.py",
            "hypcheck/kernel/specialise/*.py",
            *(f"hypcheck/kernel/programs/{name}.py" for name in ("tilted", "ways", "dual")),
        ],
    ),
    "record and score": (
        450,
        [
            "hypcheck/record/*.py",
            "hypcheck/geometry/*.py",
            *(f"hypcheck/runs/{name}.py" for name in ("score", "judge", "tally")),
        ],
    ),
}
"""How many mutants are drawn of which files. The kernel's constants and what is printed have parts of their own."""

MOST, SECONDS = 16, 1.0
"""Tests that a mutant meets at first, and what they take under coverage; one that survives meets more."""

MOST_AGAIN, SECONDS_AGAIN = 60, 15.0
"""These are the longest that fit, which try the most."""

EXPLAINED = Path(__file__).with_name("explained_mutants.json")
"""Survivors that are no gap of the tests, by module, function and changed code, with the reason."""

RESULTS = DATA.parent / "mutants.json"
"""What became of each mutant the last time. It counts again while the module and the tests that judged it are the same,
and that of an explained survivor while the module is. Else the test that killed it is tried first. A run without this
file only takes longer."""


def measure() -> Figures:
    """Draw the mutants, run their tests, run more tests against the survivors that are not explained."""
    ran = _contexts(sorted(DATA.glob("*/c")))
    reasons = json.loads(EXPLAINED.read_text(encoding="utf-8"))
    figures: Figures = {}
    for name, (count, patterns) in SAMPLES.items():
        first = tried(f"{name}-first", draw(ran, count, patterns), ran, MOST, SECONDS)
        left = [each for each in first if each["outcome"] == "survived" and each["mutation"]["key"] not in reasons]
        again = [Mutation(**each["mutation"]) for each in left]
        second = tried(f"{name}-again", again, ran, MOST_AGAIN, SECONDS_AGAIN, longest=True)
        figures[name] = summary([each for each in first if each not in left] + second, reasons)
    return with_totals(figures) | {"tests": len(_breadth(ran))}


Contexts = dict[str, dict[int, set[str]]]
"""Which tests ran a line, by file and line."""


def _contexts(data: Iterable[Path]) -> Contexts:
    try:
        from coverage import CoverageData
    except ImportError:
        raise Unavailable("coverage is missing; the extra `dev` has it") from None
    found: Contexts = defaultdict(lambda: defaultdict(set))
    for path in data:
        each = CoverageData(basename=str(path))
        each.read()
        for file in each.measured_files():
            name = str(Path(file).relative_to(ROOT)) if Path(file).is_absolute() else file
            for line, tests in each.contexts_by_lineno(file).items():
                found[name][line] |= set(tests) - {""}
    if not found:
        raise Unavailable("it needs what python-coverage keeps; measure that first")
    return found


def draw(ran: Contexts, count: int, patterns: Iterable[str]) -> list[Mutation]:
    """So many mutants of the lines that a test runs; the others are listed by python-coverage."""
    files = sorted({str(path.relative_to(ROOT)) for pattern in patterns for path in ROOT.glob(pattern)})
    every = [
        each
        for file in files
        for each in mutations(file, (ROOT / file).read_text(encoding="utf-8"))
        if ran[file].get(each.line)
    ]
    return sorted(every, key=_lot)[:count]


def _lot(mutation: Mutation) -> bytes:
    """A mutant's place in the draw, which depends on its own text alone: an edit of other code draws no others."""
    return hashlib.sha256(f"{SEED} {mutation.key}".encode()).digest()


def tried(
    name: str, mutants: list[Mutation], ran: Contexts, most: int, seconds: float, *, longest: bool = False
) -> list[dict[str, Any]]:
    """What became of the mutants, each against so many of its tests that take so many seconds of a processor."""
    took, breadth = _seconds(), _breadth(ran)
    before = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    reasons = json.loads(EXPLAINED.read_text(encoding="utf-8"))
    tasks, known = [], []
    for each in mutants:
        tests = chosen(each.module, ran[each.module][each.line], most, seconds, took, breadth, longest=longest)
        last = before.get(each.key, {"outcome": "", "by": "", "mark": "", "module": ""})
        same = last["mark"] == _mark(each.module, [last["by"]] if last["by"] else tests)
        if same or (last["outcome"] == "survived" and each.key in reasons and last["module"] == _mark(each.module, ())):
            known.append({**last, "mutation": asdict(each)})
        else:
            tasks.append({"mutation": asdict(each), "tests": tests, "first": last["by"]})
    for task, found in zip(tasks, _run(name, tasks, took), strict=True):
        mark = _mark(found["mutation"]["module"], [found["by"]] if found["by"] else task["tests"])
        module = _mark(found["mutation"]["module"], ())
        before[found["mutation"]["key"]] = {
            "outcome": found["outcome"], "by": found["by"], "mark": mark, "module": module,
        }  # fmt: skip
        known.append(found)
    RESULTS.write_text(json.dumps(before, indent=1), encoding="utf-8")
    return known


def _run(name: str, tasks: list[dict[str, Any]], took: Mapping[str, float]) -> list[dict[str, Any]]:
    if not tasks:
        return []
    names = {test for task in tasks for test in (*task["tests"], task["first"]) if test}
    files = sorted(file for file in {each.partition("::")[0] for each in names} if (ROOT / file).exists())
    place, results = DATA.parent / f"{name}.json", DATA.parent / f"{name}.jsonl"
    found = {"files": files, "mutants": tasks, "seconds": {each: took.get(each, USUAL_S) for each in names}}
    place.write_text(json.dumps(found), encoding="utf-8")
    results.unlink(missing_ok=True)
    subprocess.run([sys.executable, "-m", "tests.tools.evidence.mutant_runs", place, results], cwd=ROOT, check=False)
    return [json.loads(line) for line in results.read_text(encoding="utf-8").splitlines()]


@cache
def _text(file: str) -> str:
    path = ROOT / file
    return path.read_text(encoding="utf-8") if path.exists() else ""


def _mark(module: str, tests: Iterable[str]) -> str:
    """A checksum of a module, of tests, and of their files."""
    names = sorted(tests)
    texts = [_text(file) for file in (module, *sorted({each.partition("::")[0] for each in names}))]
    return hashlib.sha256("\0".join([*texts, *names]).encode()).hexdigest()[:16]


def _breadth(ran: Contexts) -> Counter[str]:
    """How many lines each test runs."""
    return Counter(test for lines in ran.values() for tests in lines.values() for test in tests)


def _seconds() -> dict[str, float]:
    """What each test took under coverage."""
    found: dict[str, float] = {}
    for path in sorted(DATA.glob("*/seconds.json")):
        found |= json.loads(path.read_text(encoding="utf-8"))
    return found


def chosen(
    module: str,
    tests: Iterable[str],
    most: int,
    seconds: float,
    took: Mapping[str, float],
    breadth: Mapping[str, int],
    *,
    longest: bool = False,
) -> list[str]:
    """The tests to try: those that run the fewest lines first, which ask for little else; at most six of a function.

    Or, of the same room first, the longest, which try the most: none may take more than two fifths of the time, and at
    most two are of a function.
    """
    room = f"tests/{'/'.join(module.split('/')[1:-1])}/"
    most_of_one, most_alike = (0.4 * seconds, 2) if longest else (seconds, 6)

    def order(test: str) -> tuple[float, float, str]:
        time = took.get(test, USUAL_S)
        return (not test.startswith(room), -time, test) if longest else (breadth[test], time, test)

    alike: Counter[str] = Counter()
    found: list[str] = []
    for test in sorted(tests, key=order):
        function = test.partition("[")[0]
        if alike[function] < most_alike and len(found) < most and took.get(test, USUAL_S) <= min(seconds, most_of_one):
            alike[function] += 1
            found.append(test)
            seconds -= took.get(test, USUAL_S)
    return found


def summary(results: list[dict[str, Any]], reasons: Mapping[str, str]) -> Figures:
    """Counts, and the survivors that are not explained."""
    made = [each for each in results if each["outcome"] != "not-made"]
    survived = [each["mutation"]["key"] for each in made if each["outcome"] == "survived"]
    killed = len(made) - len(survived)
    explained = sorted(each for each in survived if each in reasons)
    return {
        "mutants": len(made),
        "killed": killed,
        "percent killed": round(100 * killed / max(1, len(made)), 1),
        "explained": {each: reasons[each] for each in explained},
        "left": sorted(set(survived) - set(explained)),
    }


def with_totals(figures: Figures) -> Figures:
    """The figures with those of all samples together."""
    mutants, killed = (sum(each[key] for each in figures.values()) for key in ("mutants", "killed"))
    return {
        "mutants": mutants,
        "killed": killed,
        "percent killed": round(100 * killed / mutants, 1),
        "explained": sum(len(each["explained"]) for each in figures.values()),
        "left": sum(len(each["left"]) for each in figures.values()),
        "samples": figures,
    }


def section(figures: Figures) -> str:
    """The text about mutants."""
    rows = [
        f"| {name} | {each['mutants']} | {each['killed']} | {each['percent killed']} % | {len(each['explained'])} |"
        f" {len(each['left'])} |"
        for name, each in figures["samples"].items()
    ]
    explained = [
        f"- `{place}`: {why}" for each in figures["samples"].values() for place, why in each["explained"].items()
    ]
    left = [f"- `{place}`" for each in figures["samples"].values() for place in each["left"]]
    return "\n".join(
        [
            OPENING.format(share=figures["percent killed"], **figures),
            *rows,
            "\nExplained:\n",
            *explained,
            "\nNo test has killed these yet:\n",
            *left,
        ]
    )


OPENING = """\
A mutant changes an operator, a comparison, a constant or a condition, or leaves out a statement, in a loaded function.
The tests that run the changed line judge it: first those that run the fewest lines, then longer ones for the survivors.
Of {mutants} mutants, drawn by a checksum of their text, {killed} were killed ({share} %): a test failed, or took
several times as long. {explained} survivors have an explanation; {left} have none yet. Functions that run only when a
module is loaded, and `strict=` of zip, are not changed. Only the {tests} tests whose lines coverage has recorded can
judge; others, such as most of `make thorough`, were not run.

| code | mutants | killed | share | explained | left |
| --- | --- | --- | --- | --- | --- |"""
