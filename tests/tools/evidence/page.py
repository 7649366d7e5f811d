"""docs/evidence.md, printed from the kept figures."""

from __future__ import annotations

from tests.tools.evidence.parts import PARTS, Figures, part

OPENING = """\
# Evidence about our own code

The suite judges implementations by mutants, by fuzzing and by proofs. This page says what the same means find in
our own code. `make evidence` measures every figure anew and prints this page; one part alone is
`python -m tests.tools.evidence PART --write`. Continuous integration asks cheap forms of them, and does not let a
figure fall below its floor (`tests/tools/evidence/floors.py`).
"""


def page(figures: dict[str, Figures]) -> str:
    """The text of docs/evidence.md."""
    sections = [f"## {part(name).TITLE}\n\n{part(name).section(figures[name]).strip()}\n" for name in PARTS]
    return "\n".join([OPENING, *sections])
