"""Mutants of the compiled kernel: all of its comparisons, junctions, guards and constants, and what tells each one."""

from __future__ import annotations

import os
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

from tests.tools.evidence.battery import Outcome, asked, built
from tests.tools.evidence.battery.questions import write
from tests.tools.evidence.c_sites import HEADER, Mutant, schemata
from tests.tools.evidence.kernel_explained import reason, rules, told_by_proof
from tests.tools.evidence.parts import Figures

TITLE = "Mutants of the compiled kernel"

MANY = "HYPCHECK_EVIDENCE" in os.environ
"""Whether what lives is asked all questions: hours where a machine is busy."""


def measure() -> Figures:
    """Asks few questions of every mutant, then proofs and explanations, and many questions of what lives."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        text, mutants = schemata(HEADER.read_text(encoding="utf-8"))
        (folder / "hypcheck.h").write_text(text, encoding="utf-8")
        program = built(folder, folder, "-DHC_MUTANTS", "-w")
        told: Counter[str] = Counter()
        living = mutants
        for questions in _few(folder):
            living = _asked(program, questions, living, told)
        living, explained = sorted_out(living, told)
        if MANY:
            living = _asked(program, write(folder / "many", 1, (5,)), living, told)
    return {
        "mutants": len(mutants),
        "told by": dict(sorted(told.items())),
        "explained": len(explained),
        "living": [mutant.name for mutant in living],
        "count": len(living),
    }


def _asked(program: Path, questions: Path, mutants: list[Mutant], told: Counter[str]) -> list[Mutant]:
    """Those that nothing tells; the others are counted."""
    living = []
    for mutant, what in outcomes(program, questions, mutants):
        if what == "nothing":
            living.append(mutant)
        else:
            told[what] += 1
    return living


def sorted_out(mutants: list[Mutant], told: Counter[str]) -> tuple[list[Mutant], list[Mutant]]:
    """Those that no proof tells and nothing explains, and those that are explained; what a proof tells is counted."""
    table, left, explained = rules(), [], []
    for mutant in mutants:
        what = told_by_proof(mutant)
        if what is not None:
            told[what] += 1
        elif reason(mutant, table) is not None:
            explained.append(mutant)
        else:
            left.append(mutant)
    return left, explained


def _few(folder: Path) -> Iterator[Path]:
    """The guards alone, then some frozen questions."""
    (folder / "none").write_bytes(b"")
    yield folder / "none"
    yield write(folder / "few", 12, ())


def outcomes(program: Path, questions: Path, mutants: Iterable[Mutant]) -> Iterator[tuple[Mutant, str]]:
    """Each mutant, and what tells it from the header: "wrong", "crash", "endless", "counts" or "nothing"."""
    right = asked(program, questions)
    if right.what != "right":
        raise AssertionError(f"the header as it is: {right.says}")
    for mutant in mutants:
        what = told(asked(program, questions, mutant.number), right)
        yield mutant, what


def told(found: Outcome, right: Outcome) -> str:
    """What differs: the answers, or how much each stage decided."""
    if found.what != "right":
        return found.what
    return "nothing" if found.says == right.says else "counts"


def section(figures: Figures) -> str:
    """Figures, and where the survivors are."""
    by = figures["told by"]
    counts = Counter(name.partition(":")[0] for name in figures["living"])
    places = ", ".join(f"`{name}` {count}" for name, count in counts.most_common())
    return f"""\
Every comparison, junction, guard and float constant of `hypcheck.h` is changed, {figures["mutants"]} changes in all:
`<` to `<=`, `&&` to `||`, a condition to 0, a constant to half and twice, an integer by 1. Loops, the choice of an
instruction set, and functions that only guess where to look for a proof are not changed. The plain level answers frozen
vectors and rows at the limit of each guard, in all rounding modes (`tests/tools/evidence/battery/`).

| detected by | mutants |
| --- | --- |
| a wrong answer, or a wrong decision of a guard | {by.get("wrong", 0)} |
| a crash | {by.get("crash", 0)} |
| a run without end | {by.get("endless", 0)} |
| right answers, and stages that decide more or fewer of them | {by.get("counts", 0)} |
| the rule of a program for all signs, or its limits, in exact arithmetic | {by.get("rule", 0)} |
| the derivation of a constant | {by.get("derivation", 0)} |
| nothing, with an explanation | {figures["explained"]} |
| nothing, without one | {len(figures["living"])} |

No row can detect the explained mutants; `explained_kernel_mutants.json` has the reasons:

{_reasons()}
{_not_sorted(places) if figures["living"] else ""}"""


def _reasons() -> str:
    """The table of explanations, by the functions and their reasons."""
    return "".join(f"- `{rule.functions}`: {rule.reason}\n" for rule in rules())


def _not_sorted(places: str) -> str:
    return f"""\
A mutant that is neither detected nor explained needs a test; `figures.json` lists them. By function:
{places}.
"""


if __name__ == "__main__":
    found = measure()
    sys.stdout.write(section(found) + "\n".join(found["living"]) + "\n")
