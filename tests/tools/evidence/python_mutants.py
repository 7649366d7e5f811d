"""The part `python-mutants`: small changes of the truth, the Python kernel, the record and the score, against tests."""

from __future__ import annotations

import json
import random
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

from tests.tools.evidence.mutant_runs import USUAL_S
from tests.tools.evidence.mutations import Mutation, mutations
from tests.tools.evidence.parts import ROOT, Figures, Unavailable
from tests.tools.evidence.python_coverage import DATA

TITLE = "Mutants of the Python code"

SEED = 25

SAMPLES = {
    "truth": (1000, ["hypcheck/truth/**/*.py"]),
    "kernel": (600, ["hypcheck/kernel/*.py", "hypcheck/kernel/specialise/*.py"]),
    "record and score": (
        450,
        [
            "hypcheck/record/*.py",
            "hypcheck/geometry/*.py",
            *(f"hypcheck/runs/{name}.py" for name in ("score", "judge", "tally")),
        ],
    ),
}
"""How many mutants are drawn of which files. The kernel's programs and what they print have a part of their own."""

MOST, SECONDS = 10, 1.6
"""Tests that a mutant meets at first; one that survives meets more."""

MOST_AGAIN, SECONDS_AGAIN = 60, 12.0

EXPLAINED = Path(__file__).with_name("explained_mutants.json")
"""Survivors that are no gap of the tests, by place and change, with the reason."""


def measure() -> Figures:
    """Draw the mutants, run their tests, run more tests against the survivors."""
    ran = _contexts(sorted(DATA.glob("*/c")))
    figures: Figures = {}
    for name, (count, patterns) in SAMPLES.items():
        drawn = draw(ran, count, patterns)
        first = tried(f"{name}-first", drawn, ran, MOST, SECONDS)
        left = [Mutation(**each["mutation"]) for each in first if each["outcome"] == "survived"]
        second = tried(f"{name}-again", left, ran, MOST_AGAIN, SECONDS_AGAIN)
        figures[name] = summary([each for each in first if each["outcome"] != "survived"] + second)
    return with_totals(figures)


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
    dice = random.Random(SEED)  # noqa: S311
    dice.shuffle(every)
    return every[:count]


def tried(name: str, mutants: list[Mutation], ran: Contexts, most: int, seconds: float) -> list[dict[str, object]]:
    """What became of the mutants, each against so many of its tests that take so many seconds of a processor."""
    tasks = [
        {"mutation": asdict(each), "tests": chosen(each.module, ran[each.module][each.line], most, seconds)}
        for each in mutants
    ]
    if not tasks:
        return []
    files = sorted({test.partition("::")[0] for task in tasks for test in task["tests"]})
    place, results = DATA.parent / f"{name}.json", DATA.parent / f"{name}.jsonl"
    place.write_text(json.dumps({"files": files, "mutants": tasks, "seconds": {}}), encoding="utf-8")
    results.unlink(missing_ok=True)
    subprocess.run([sys.executable, "-m", "tests.tools.evidence.mutant_runs", place, results], cwd=ROOT, check=False)
    return [json.loads(line) for line in results.read_text(encoding="utf-8").splitlines()]


def chosen(module: str, tests: Iterable[str], most: int, seconds: float) -> list[str]:
    """The tests to try, those of the module's own file first, at most two of one function."""
    folder, own = "/".join(module.split("/")[1:-1]), f"test_{Path(module).name}"

    def far(test: str) -> tuple[int, str]:
        file = test.partition("::")[0]
        near = file.startswith(f"tests/{folder}/")
        return (0 if near and file.endswith(f"/{own}") else 1 if near else 2, test)

    alike: Counter[str] = Counter()
    found: list[str] = []
    for test in sorted(tests, key=far):
        function = test.partition("[")[0]
        if alike[function] < 2 and len(found) < min(most, seconds / USUAL_S):
            alike[function] += 1
            found.append(test)
    return found


def summary(results: list[dict[str, object]]) -> Figures:
    """Counts, and the survivors that are not explained."""
    made = [each for each in results if each["outcome"] != "not-made"]
    reasons = json.loads(EXPLAINED.read_text(encoding="utf-8"))
    survived = [place_of(each["mutation"]) for each in made if each["outcome"] == "survived"]
    killed = len(made) - len(survived)
    explained = sorted(each for each in survived if each in reasons)
    return {
        "mutants": len(made),
        "killed": killed,
        "percent killed": round(100 * killed / max(1, len(made)), 1),
        "explained": {each: reasons[each] for each in explained},
        "left": sorted(set(survived) - set(explained)),
    }


def place_of(mutation: dict[str, object]) -> str:
    """A mutant's file, line and change."""
    return f"{mutation['module']}:{mutation['line']}:{mutation['column']} {mutation['what']}"


def with_totals(figures: Figures) -> Figures:
    """The figures with those of all samples together."""
    mutants, killed = (sum(each[key] for each in figures.values()) for key in ("mutants", "killed"))
    return {
        "mutants": mutants,
        "killed": killed,
        "percent killed": round(100 * killed / mutants, 1),
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
            OPENING.format(mutants=figures["mutants"], killed=figures["killed"], share=figures["percent killed"]),
            *rows,
            "\nExplained:\n",
            *explained,
            "\nNo test has killed these yet:\n",
            *left,
        ]
    )


OPENING = """\
An operator, a comparison, a constant or a condition is changed, or a statement left out, in a function that is loaded;
the tests that run its line judge it (those that python-coverage found; a few at first, many against what survives). Of
{mutants} mutants, drawn with a seed, {killed} were killed ({share} %): a test failed, or took several times as long.
What is left is not explained yet; tests of `make thorough` were not asked.

| code | mutants | killed | share | explained | left |
| --- | --- | --- | --- | --- | --- |"""
