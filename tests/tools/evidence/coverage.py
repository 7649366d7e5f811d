"""Branch coverage and MC/DC of the C header, by clang, under the battery's questions on every instruction set here."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.tools.evidence.battery import CORE, DRIVER
from tests.tools.evidence.battery.questions import write
from tests.tools.evidence.c_sites import FUNCTION
from tests.tools.evidence.gaps import reason
from tests.tools.evidence.parts import Figures, Unavailable

TITLE = "Coverage of the compiled kernel"

VERSIONS = (20, 19, 18)
"""Of clang; 18 is the first that measures MC/DC."""

LEVELS = ("plain", "sse2", "avx2", "avx512")
OPTIONS = [
    *("-g", "-O1", "-w", "-std=gnu99", "-ffp-contract=off"),
    *("-fprofile-instr-generate", "-fcoverage-mapping", "-fcoverage-mcdc", "-Xclang", "-fmcdc-max-conditions=12"),
]


@dataclass(frozen=True)
class Tools:
    """clang and what reads its counts, of one version."""

    clang: str
    merge: str
    show: str


def tools() -> Tools:
    """The newest that are here. Raises Unavailable."""
    for version in VERSIONS:
        paths = [shutil.which(f"{name}-{version}") for name in ("clang", "llvm-profdata", "llvm-cov")]
        if all(paths):
            return Tools(*map(str, paths))
    raise Unavailable("there is no clang 18 or later with llvm-profdata and llvm-cov")


def measure() -> Figures:
    """Compiles, asks every question at every level, and reads what was reached."""
    found = tools()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program, questions = folder / "driver", write(folder / "questions", 1, (5, 6))
        command = [found.clang, *OPTIONS, f"-I{CORE}", str(DRIVER), "-lm", "-o", str(program)]
        subprocess.run(command, check=True)
        levels = [level for level in LEVELS if _asked(program, questions, level)]
        _asked(program, questions, "")
        exported = _exported(found, program, sorted(folder.glob("*.profraw")), folder)
    (file,) = (each for each in exported["files"] if each["filename"].endswith("hypcheck.h"))
    gaps = sorted(set(gaps_of(file)))
    unexplained = [gap for gap in gaps if reason(gap) is None]
    counted = {name: _counted(file["summary"][name]) for name in ("functions", "branches", "mcdc")}
    return {"levels": levels, **counted, "gaps": gaps, "unexplained": unexplained, "count": len(unexplained)}


def _asked(program: Path, questions: Path, level: str) -> bool:
    """Whether the machine has the level; "" is the one that the header chooses."""
    environment = {**os.environ, "LLVM_PROFILE_FILE": str(program.with_name(f"{level or 'chosen'}.profraw"))}
    done = subprocess.run(
        [program, questions, "0", *filter(None, [level])], env=environment, stdout=subprocess.DEVNULL, check=False
    )
    if done.returncode not in (0, 3):  # 3: this machine lacks the level
        raise AssertionError(f"the battery's questions are answered wrong at the level {level}")
    return done.returncode == 0


def _exported(found: Tools, program: Path, profiles: list[Path], folder: Path) -> dict[str, Any]:
    merged = folder / "merged"
    subprocess.run([found.merge, "merge", *profiles, "-o", merged], check=True)
    command = [found.show, "export", "-format=text", f"-instr-profile={merged}", program]
    return json.loads(subprocess.run(command, capture_output=True, check=True).stdout)["data"][0]


def _counted(summary: dict[str, int]) -> dict[str, float]:
    count, covered = summary["count"], summary["covered"]
    return {"count": count, "covered": covered, "share": round(100 * covered / count, 2)}


def gaps_of(file: dict[str, Any]) -> Iterator[str]:
    """What was never true, never false, or in a decision never shown to matter: the function, and text of the source.

    A branch is [line, column, end line, end column, times true, times false, …], a decision ends in a list of whether
    each of its conditions was shown to matter.
    """
    source = Path(file["filename"]).read_text(encoding="utf-8")
    lines, functions = source.split("\n"), _functions(source)
    for line, column, end_line, end, true, false, *_ in file["branches"]:
        text = lines[line - 1][column - 1 : end - 1 if line == end_line else None].strip()
        if not true:
            yield f"{functions[line - 1]}: never true: {text}"
        if not false:
            yield f"{functions[line - 1]}: never false: {text}"
    for line, column, end_line, end, *_, conditions in file["mcdc_records"]:
        text = lines[line - 1][column - 1 : end - 1 if line == end_line else None].strip()
        missing = (n for n, shown in enumerate(conditions, 1) if not shown)
        yield from (f"{functions[line - 1]}: MC/DC of condition {n}: {text}" for n in missing)


def _functions(source: str) -> list[str]:
    """The function that each line belongs to."""
    found, name = [], ""
    for line in source.split("\n"):
        begun = None if line.startswith(("#", " ")) else FUNCTION.match(line)
        name = begun[1] if begun else name
        found.append(name)
    return found


def section(figures: Figures) -> str:
    """Figures, and every gap with its reason."""
    rows = "\n".join(
        f"| {title} | {figures[name]['count']} | {figures[name]['covered']} | {figures[name]['share']:.2f} % |"
        for name, title in (("functions", "functions"), ("branches", "branches"), ("mcdc", "conditions, MC/DC"))
    )
    gaps = "\n".join(
        f"- {why or 'no reason is known; a row has still to be found'}:\n"
        + "\n".join(f"  - `{gap}`" for gap in figures["gaps"] if reason(gap) == why)
        for why in dict.fromkeys(map(reason, figures["gaps"]))
    )
    return f"""\
clang compiles `hypcheck.h` with `-fcoverage-mcdc`. The inputs are the frozen vectors, scenes made of them, rows and
scenes at the borders, all in several rounding modes, and each guard at its limit (`tests/tools/evidence/battery/`), on
the instruction sets {", ".join(figures["levels"])}. Code that is printed for several instruction
sets is counted for each.

| | count | reached | share |
| --- | --- | --- | --- |
{rows}

Code that no input reaches, with the reason ({figures["count"]} of {len(figures["gaps"])} have none yet):

{gaps}
"""
