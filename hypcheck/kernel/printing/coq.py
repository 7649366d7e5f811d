"""Programs as Coq: each step a definition of type `expr` (hypcheck/proofs/Rounding.v), in the program's order."""

from __future__ import annotations

from hypcheck.derivation.program import Argument, Program, Step, needed
from hypcheck.kernel.programs.single import SINGLE

_WORDS = {"add": "Add", "sub": "Sub", "mul": "Mul", "div": "Div", "neg": "Neg"}

STAGE_TWO = "hypcheck/proofs/StageTwo.v"
"""The file that holds the coefficients and the discriminant as the kernel's floats compute them."""


def definitions(program: Program, wanted: tuple[str, ...]) -> list[str]:
    """The inputs by their places, then the steps that the wanted ones need, one definition a line.

    Raises ValueError for a step that has no bound: a comparison, a selection, a root.
    """
    steps = needed(program, wanted)
    inputs = [f"Definition {name} := Input {place}." for place, name in enumerate(program.inputs)]
    return [*inputs, *(f"Definition {step.name} := {_expression(step)}." for step in steps)]


def _expression(step: Step) -> str:
    if step.operation not in _WORDS:
        raise ValueError(f"step {step.name}: no bound is proved for {step.operation}")
    first = step.arguments[0]
    if step.operation == "mul" and isinstance(first, int) and first > 0 and first & (first - 1) == 0:
        return f"Scale {first.bit_length() - 1} {_argument(step.arguments[1])}"
    return " ".join((_WORDS[step.operation], *map(_argument, step.arguments)))


def _argument(argument: Argument) -> str:
    return argument if isinstance(argument, str) else f"(Whole ({argument})%Z)"


def stage_two() -> str:
    """The text of STAGE_TWO."""
    lines = definitions(SINGLE, ("c0", "c1", "c2", "delta_3"))
    return "\n".join(
        (
            "(** The coefficients of g and 3 delta as the kernel computes them, printed from the kernel's own program",
            "    by `python -m hypcheck.kernel.printing.coq`; do not edit. Kernel.v has what is proved of it. *)",
            "",
            "Require Import ZArith.",
            "From Hypcheck Require Import Rounding.",
            "",
            *lines,
            "",
        )
    )


if __name__ == "__main__":
    from pathlib import Path

    Path(STAGE_TWO).write_text(stage_two(), encoding="utf-8")
