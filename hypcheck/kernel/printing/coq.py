"""Prints programs for Coq: StageTwo.v and Programs.v about the fast path, and the proof of an emitted kernel.

A program becomes definitions of type `expr` (hypcheck/proofs/Rounding.v), one a step, in the program's order. The proof
of an emitted kernel states its steps, constants and bound, and proves by hypcheck/proofs/Region.v that beyond the bound
the computed number has the sign of the discriminant of g. `python -m hypcheck.proofs FILE` has Coq check it.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from textwrap import fill

from hypcheck.derivation.program import Argument, Program, Step, cut, line_of, needed
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Sizes
from hypcheck.kernel.programs import fixed, integers, lines, tilted
from hypcheck.kernel.programs.certified import CERTIFIED, SINGLE
from hypcheck.kernel.specialise.last_stages import Discriminant, exact_constants
from hypcheck.kernel.specialise.plan import ScenePlan
from hypcheck.kernel.specialise.settings import scaled

REACH = 1 + Fraction(1, 2**20)
"""The exact R or z² is less than this times the computed one, which the kernel compares with its limit: four roundings
at most."""

_HEAD = """(** The discriminants that the kernel of the scene "{scene}" computes in {format}, and what their signs say.

    Made by `hypcheck emit --proof`. u = 2^-{bits}: rounding to nearest, nothing over- or underflows. *)

Require Import Reals Lra QArith Qreals List ZArith.
From Hypcheck Require Import UnitBall Cubic Rounding Region.
Import ListNotations.
"""

_THEOREM = """
Lemma exact_c2 RR zz : value (env constants RR zz) Step.c2 = c2 A B (RR / bb) (zz / dd) / s.
Proof. unfold c2, A, B, bb, dd, s; simpl; unfold Q2R; simpl; lra. Qed.
Lemma exact_c1 RR zz : value (env constants RR zz) Step.c1 = c1 A B (RR / bb) (zz / dd) / s ^ 2.
Proof. unfold c1, A, B, bb, dd, s; simpl; unfold Q2R; simpl; lra. Qed.
Lemma exact_c0 RR zz : value (env constants RR zz) Step.c0 = c0 A B (RR / bb) (zz / dd) / s ^ 3.
Proof. unfold c0, A, B, s; simpl; unfold Q2R; simpl; lra. Qed.

Lemma suffices : bound_suffices unit constants widest highest bound Step.delta_3 = true.
Proof. vm_compute; reflexivity. Qed.

(** RR is x^2 + y^2 and zz is z^2, in the kernel's units. *)
Theorem sign RR zz v : 0 <= RR <= Q2R widest -> 0 <= zz <= Q2R highest ->
  computes (Q2R unit) entries (env constants RR zz) Step.delta_3 v ->
  let P := RR / bb in let Q := zz / dd in
  (Q2R bound < v -> 0 < disc (c2 A B P Q) (c1 A B P Q) (c0 A B P Q))
  /\\ (v < - Q2R bound -> disc (c2 A B P Q) (c1 A B P Q) (c0 A B P Q) < 0).
Proof.
  intros R1 Z1 C P Q; apply (sign_of_discriminant unit constants widest highest bound Step.delta_3 RR zz v A B P Q s);
    try assumption; [exact suffices | unfold s; lra |].
  unfold P, Q; rewrite <- exact_c2, <- exact_c1, <- exact_c0; apply hessian_form; reflexivity.
Qed.
"""


def proof_of(plan: ScenePlan) -> str:
    """Return the text of the file with the proof of the discriminants of a plan.

    Raises InputError if the mover is tilted, and if no setting of the plan has a discriminant.
    """
    if plan.axis is not None:
        raise InputError(
            "--proof: where the mover is tilted, Coq has no proof of the kernel; docs/plans.md has the one of its bound"
        )
    parts = [
        part
        for number, stages in enumerate(plan.settings, 1)
        if stages.discriminant is not None
        for part in _setting(number, plan, stages.setting.sizes, stages.discriminant)
    ]
    if not parts:
        raise InputError("--proof: this kernel decides without a discriminant, so there is no bound to prove")
    head = _HEAD.format(scene=plan.scene.name, format=plan.format.name, bits=plan.format.bits)
    return "\n".join((head, *parts, ""))


def _setting(number: int, plan: ScenePlan, sizes: Sizes, stage: Discriminant) -> Iterator[str]:
    """Yield the lines about one setting: its constants, limits and bound, the steps, the theorem."""
    measures = scaled(sizes, plan.format)
    unit, constants = exact_constants(measures)
    yield f"Module Setting_{number}."
    yield "Open Scope Q_scope."
    yield f"Definition unit : Q := {_rational(plan.format.unit)}."
    yield f"Definition constants : list Q := [{'; '.join(map(_rational, constants.values()))}]."
    for name, value in (("widest", stage.widest), ("highest", stage.highest)):
        yield f"Definition {name} : Q := {_rational(Fraction(value) * REACH)}."
    yield f"Definition bound : Q := {_rational(Fraction(stage.bound))}."
    yield "Close Scope Q_scope."
    yield "Module Step."
    yield from definitions(stage.program, ("c0", "c1", "c2", "delta_3"))
    yield "End Step."
    yield "Open Scope R_scope."
    for name in ("A", "B", "bb", "dd"):
        yield f"Definition {name} := {_real(getattr(measures, name))}."
    yield f"Definition s := {_real(unit)}."
    yield _THEOREM
    yield "Close Scope R_scope."
    yield f"End Setting_{number}."


def _rational(value: Fraction) -> str:
    """Return a fraction as a term of type Q."""
    return f"({value.numerator} # {value.denominator})"


def _real(value: Fraction) -> str:
    """Return a fraction as a term of type R."""
    return f"{value.numerator} / {value.denominator}"


_WORDS = {"add": "Add", "sub": "Sub", "mul": "Mul", "div": "Div", "neg": "Neg"}
"""The constructors of `expr`, by operation."""

STAGE_TWO = "hypcheck/proofs/StageTwo.v"
"""The file that holds the coefficients and the discriminant as the kernel's floats compute them."""


def definitions(program: Program, wanted: tuple[str, ...]) -> list[str]:
    """Return the definitions of the inputs, by their places, then of the steps that the wanted names need.

    Raises ValueError for a step without a bound: a comparison, a selection, a root.
    """
    steps = needed(program, wanted)
    inputs = [f"Definition {name} := Input {place}." for place, name in enumerate(program.inputs)]
    return [*inputs, *(f"Definition {step.name} := {_expression(step)}." for step in steps)]


def _expression(step: Step) -> str:
    """Return a step as a term of type expr. Raises ValueError for a step without a bound."""
    if step.operation not in _WORDS:
        raise ValueError(f"step {step.name}: no bound is proved for {step.operation}")
    first = step.arguments[0]
    if step.operation == "mul" and isinstance(first, int) and first > 0 and first & (first - 1) == 0:
        return f"Scale {first.bit_length() - 1} {_argument(step.arguments[1])}"
    return " ".join((_WORDS[step.operation], *map(_argument, step.arguments)))


def _argument(argument: Argument) -> str:
    """Return a name, or an integer as a term of type expr."""
    return argument if isinstance(argument, str) else f"(Whole ({argument})%Z)"


def stage_two() -> str:
    """Return the text of the file STAGE_TWO."""
    modules = (
        ("Parts", cut(CERTIFIED, ("c0", "c1", "c2"), ("h1", "h2", "h3")), ("h1", "h2", "h3")),
        ("Last", cut(CERTIFIED, ("h1", "h2", "h3"), ("delta_3",)), ("delta_3",)),
        ("Slopes", cut(CERTIFIED, ("c1", "c2"), _SLOPES), _SLOPES),
        ("Bound", cut(CERTIFIED, _KNOWN, ("E", *_SLOPE_BOUNDS)), ("e0", "e1", "e2", "E", *_SLOPE_BOUNDS)),
    )
    lines = definitions(SINGLE, ("c0", "c1", "c2", "delta_3"))
    for name, program, wanted in modules:
        lines += ["", f"Module {name}.", *definitions(program, wanted), f"End {name}."]
    return "\n".join(
        (_STAGE_TWO_HEAD, "Require Import ZArith.", "From Hypcheck Require Import Rounding.", "", *lines, "")
    )


_STAGE_TWO_HEAD = """(** What the kernel's floats compute, printed from the kernel's own programs by

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

PROGRAMS = "hypcheck/proofs/Programs.v"
"""The file that holds the listings of all programs that the header is printed from."""

_PRINTED = {
    "single": SINGLE,
    "certified": CERTIFIED,
    "fixed_terms": fixed.TERMS,
    "fixed_discriminant": fixed.DISCRIMINANT,
    "fixed_poles": fixed.POLES,
    "tangency": integers.TANGENCY,
    "waist": integers.WAIST,
    "integers": integers.INTEGERS,
    "one_line": lines.ONE_LINE,
    "two_lines": lines.TWO_LINES,
    "tangent_beyond": lines.TANGENT_BEYOND,
    "tangent_within": lines.TANGENT_WITHIN,
    "tangent_high": lines.TANGENT_HIGH,
    "chord": lines.CHORD,
    "piece": lines.PIECE,
    "tilted_quartic": integers.QUARTIC,
    "tilted_invariants": integers.INVARIANTS,
    "tilted_discriminant": integers.DISCRIMINANT,
    "tilted": tilted.TILTED,
    "one_plane": lines.ONE_PLANE,
    "two_planes": lines.TWO_PLANES,
}
"""The programs that the header is printed from, by their names in PROGRAMS."""

_PROGRAMS_HEAD = """(** The programs from which the C is printed, as listings that Steps.v reads. Printed itself, by

        python -m hypcheck.kernel.printing.coq *)

Require Import String.
From Hypcheck Require Import Steps.
Open Scope string_scope.
"""


def programs() -> str:
    """Return the text of the file PROGRAMS: every program as its listing, with a semicolon after each step."""
    listings = {name: " ".join(f"{line_of(step)};" for step in program.steps) for name, program in _PRINTED.items()}
    definitions = (f'Definition {name} := steps_of "\n{fill(text, 118)}".\n' for name, text in listings.items())
    return "\n".join((_PROGRAMS_HEAD, *definitions))


if __name__ == "__main__":
    from pathlib import Path

    Path(STAGE_TWO).write_text(stage_two(), encoding="utf-8")
    Path(PROGRAMS).write_text(programs(), encoding="utf-8")
