"""What is compared in C: the formulas, the dual form and the roots, printed and compiled when bench begins."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path

from hypcheck.bench.contenders.c_library import InC, bodies
from hypcheck.bench.contenders.c_source import FAST
from hypcheck.bench.contenders.contender import Contender, of_method
from hypcheck.bench.contenders.numpy_tier import BISECTED, CERTIFIED, PAPER, THIRTEEN
from hypcheck.methods.builtin import builtin_methods

_KINDS = {
    "table-2": ("paper", PAPER),
    "trigonometric": ("roots", THIRTEEN),
    "fast": ("certified", CERTIFIED),
    "dual": ("algebraic", BISECTED),
}


COMPILER = "C compiler"
"""What these need."""

SINGLES = 4096
"""A branch predictor learns the branches of 64 rows, and the dual form's search then runs several times as fast."""


def contenders(library: Path | None) -> Iterable[Contender]:
    """Each method of the library, which may yet have to be made; it is named as in numpy, with -c behind."""
    methods = builtin_methods()
    for place, body in enumerate(bodies(), start=1):
        if body.name in methods:  # a long double that is no more than float64 is left out
            kind, note = _KINDS.get(_without_format(body.name), ("algebraic", ""))
            found = of_method(methods[body.name], "C", kind, name=f"{body.name}-c", note=note)
            if body.name == FAST.name:
                found = replace(found, title="the fast path, compiled with the others and called from C")
            yield replace(found, load=partial(InC, library or Path(), place), singles=SINGLES, needs=COMPILER)


def _without_format(name: str) -> str:
    return name.rpartition("-")[0] or name
