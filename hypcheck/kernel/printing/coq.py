"""Programs as Coq: each step a definition of type `expr` (hypcheck/proofs/Rounding.v), in the program's order."""

from __future__ import annotations

from hypcheck.derivation.program import Argument, Program, Step, cut, needed
from hypcheck.kernel.programs.certified import CERTIFIED
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
    modules = (
        ("Parts", cut(CERTIFIED, ("c0", "c1", "c2"), ("h1", "h2", "h3")), ("h1", "h2", "h3")),
        ("Last", cut(CERTIFIED, ("h1", "h2", "h3"), ("delta_3",)), ("delta_3",)),
        ("Slopes", cut(CERTIFIED, ("c1", "c2"), _SLOPES), _SLOPES),
        ("Bound", cut(CERTIFIED, _KNOWN, ("E", *_SLOPE_BOUNDS)), ("e0", "e1", "e2", "E", *_SLOPE_BOUNDS)),
    )
    lines = definitions(SINGLE, ("c0", "c1", "c2", "delta_3"))
    for name, program, wanted in modules:
        lines += ["", f"Module {name}.", *definitions(program, wanted), f"End {name}."]
    return "\n".join((_HEAD, "Require Import ZArith.", "From Hypcheck Require Import Rounding.", "", *lines, ""))


_HEAD = """(** What the kernel's floats compute, printed from the kernel's own programs by

        python -m hypcheck.kernel.printing.coq

    First c0, c1, c2 and 3 delta from a row; then, in modules, what leads from the coefficients to h1, h2, h3, from
    these to 3 delta, and from computed numbers to the running bound E. Kernel.v and RunningBound.v have the proofs. *)
"""

_SLOPES = ("slope_B", "slope_A", "offset_B", "offset_A")
_SLOPE_BOUNDS = ("bound_B", "bound_A", "offset_bound_B", "offset_bound_A")

_KNOWN = (
    *("A", "B", "AB", "BP", "AQ", "P", "Q", "size_c1", "size_c2", "size_h1", "size_h2", "size_h3"),
    *("u_4", "u_8", "u_12", "slack"),
)
"""The numbers from which the bound is computed, in this order the inputs of the module Bound."""


if __name__ == "__main__":
    from pathlib import Path

    Path(STAGE_TWO).write_text(stage_two(), encoding="utf-8")
