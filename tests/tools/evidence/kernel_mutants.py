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
from tests.tools.evidence.parts import Figures

TITLE = "Mutants of the compiled kernel"

MANY = "HYPCHECK_EVIDENCE" in os.environ
"""Whether what lives is asked all questions: hours where a machine is busy."""


def measure() -> Figures:
    """Runs every mutant against few questions, and those that live against many."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        text, mutants = schemata(HEADER.read_text(encoding="utf-8"))
        (folder / "hypcheck.h").write_text(text, encoding="utf-8")
        program = built(folder, folder, "-DHC_MUTANTS")
        told: Counter[str] = Counter()
        living = mutants
        for questions in _stages(folder):
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


def _stages(folder: Path) -> Iterator[Path]:
    """The guards alone, then some frozen questions, then those at the borders too."""
    (folder / "none").write_bytes(b"")
    yield folder / "none"
    yield write(folder / "few", 12, ())
    if MANY:
        yield write(folder / "many", 1, (5,))


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
`<` to `<=`, `&&` to `||`, a condition to 0, a constant to half and twice, a whole number by 1. Loops, what chooses an
instruction set, and functions that only guess where a proof is looked for are left alone. The plain level is asked
about each guard at its limit and about frozen vectors, in all rounding modes (`tests/tools/evidence/battery/`).

| told by | mutants |
| --- | --- |
| a wrong answer, or a guard that says other than it should | {by.get("wrong", 0)} |
| a crash | {by.get("crash", 0)} |
| no end | {by.get("endless", 0)} |
| right answers, and stages that decide more or fewer of them | {by.get("counts", 0)} |
| nothing | {len(figures["living"])} |

What nothing tells has not been sorted one by one. Among it are these kinds. *It is the same program*: an equality
that the line before excludes, a sign that is 0 where the header proves that it decides nothing, the longer of two
of one length. *It is slower*: a shortcut before an exact decision, a branch that waits for more rows. *It has room*: a
constant of a bound, which a test of its derivation tells (next section). *It meets no row*: two floats would have to be
equal to the last bit. And there are those that ask for a test. `figures.json` lists them all; by function:
{places}.
"""


if __name__ == "__main__":
    found = measure()
    sys.stdout.write(section(found) + "\n".join(found["living"]) + "\n")
