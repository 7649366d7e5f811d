"""The proof that goes with a kernel: what the sign of its discriminant says in its region, as a file for Coq.

The file states the kernel's own steps, constants and bound, and proves by hypcheck/proofs/Region.v that beyond the
bound the computed number has the sign of the discriminant of g. `python -m hypcheck.proofs FILE` has Coq check it.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from hypcheck.errors import InputError
from hypcheck.kernel.printing.coq import definitions
from hypcheck.kernel.specialise.discriminant import Discriminant, exact_constants
from hypcheck.kernel.specialise.plan import Plan
from hypcheck.kernel.specialise.scale import scaled

REACH = 1 + Fraction(1, 2**20)
"""A computed R or z² that the kernel lets in is less than this times its exact value: four roundings."""

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


def proof_of(plan: Plan) -> str:
    """The file. Raises InputError where no setting of the plan has a discriminant: there is nothing to prove."""
    parts = [
        part
        for number, stages in enumerate(plan.settings, 1)
        if stages.discriminant is not None
        for part in _setting(number, plan, stages.setting.sizes, stages.discriminant)
    ]
    if not parts:
        raise InputError("--proof: this kernel decides without a discriminant, so that no bound is to be proved")
    head = _HEAD.format(scene=plan.scene.name, format=plan.format.name, bits=plan.format.bits)
    return "\n".join((head, *parts, ""))


def _setting(number: int, plan: Plan, sizes: tuple[float, float, float, float], stage: Discriminant) -> Iterator[str]:
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
    return f"({value.numerator} # {value.denominator})"


def _real(value: Fraction) -> str:
    return f"{value.numerator} / {value.denominator}"
