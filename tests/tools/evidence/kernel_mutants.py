"""Mutants of the compiled kernel: all of its comparisons, junctions, guards and constants, and what tells each one."""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

from tests.tools.evidence.battery import Outcome, asked, built
from tests.tools.evidence.battery.questions import write
from tests.tools.evidence.c_sites import HEADER, Mutant, schemata
from tests.tools.evidence.parts import Figures

TITLE = "Mutants of the compiled kernel"


def measure() -> Figures:
    """Runs every mutant against few questions, and those that live against many."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        text, mutants = schemata(HEADER.read_text(encoding="utf-8"))
        (folder / "hypcheck.h").write_text(text, encoding="utf-8")
        program = built(folder, folder, "-DHC_MUTANTS")
        told: Counter[str] = Counter()
        living = mutants
        for questions in (write(folder / "few", 6, ()), write(folder / "many", 1, (5,))):
            still = []
            for mutant, what in outcomes(program, questions, living):
                told[what] += 1
                if what == "nothing":
                    still.append(mutant)
            told.pop("nothing", None)
            living = still
    return {
        "mutants": len(mutants),
        "told by": dict(sorted(told.items())),
        "living": [mutant.name for mutant in living],
    }


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
    """Figures and survivors."""
    return f"{figures['mutants']} mutants; told by {figures['told by']}; living {len(figures['living'])}\n"


if __name__ == "__main__":
    found = measure()
    sys.stdout.write(section(found) + "\n".join(found["living"]) + "\n")
