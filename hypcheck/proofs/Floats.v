(** Float64 arithmetic, as Flocq defines it, rounds as Rounding.v supposes: u = 2^-52 in every mode, u = 2^-53 to nearest.

    The results are those of IEEE 754 as long as no operation underflows (asked for below) or overflows (real numbers here
    have no largest exponent, so the kernel excludes it by its range). *)

Require Import Reals Lra ZArith.
From Flocq Require Import Core Relative.
From Hypcheck Require Import Geometry Rounding.
Open Scope R_scope.

Definition binary64 := FLT_exp (-1074) 53.
Definition unit_of_any_mode := bpow radix2 (-52).
Definition unit_to_nearest := / 2 * bpow radix2 (-52).

#[local] Instance binary64_valid : Valid_exp binary64.
Proof. apply FLT_exp_valid; reflexivity. Qed.

(** The exact result of an operation is 0 or a number of the normal range. *)
Definition normal x := x = 0 \/ bpow radix2 (-1022) <= Rabs x.

Lemma as_factor x y u : x <> 0 -> Rabs (y - x) <= u * Rabs x -> exists t, Rabs t <= u /\ y = x * (1 + t).
Proof.
  intros N H; exists ((y - x) / x); split; [| field; assumption].
  unfold Rdiv; rewrite Rabs_mult, Rabs_inv.
  assert (P : 0 < Rabs x) by (apply Rabs_pos_lt; assumption).
  apply Rmult_le_reg_r with (Rabs x); [assumption |]; rewrite Rmult_assoc, Rinv_l by lra; lra.
Qed.

Theorem any_mode_rounds rnd x : Valid_rnd rnd -> normal x ->
  exists t, Rabs t <= unit_of_any_mode /\ round radix2 binary64 rnd x = x * (1 + t).
Proof.
  intros V [-> | N].
  - exists 0; rewrite round_0, Rabs_R0 by assumption; split; [apply bpow_ge_0 | ring].
  - apply as_factor; [intro Z; subst x; rewrite Rabs_R0 in N; pose proof (bpow_gt_0 radix2 (-1022)); lra |].
    left; unfold binary64, unit_of_any_mode; apply (relative_error_FLT radix2 (-1074) 53 eq_refl rnd x N).
Qed.

Theorem nearest_rounds choice x : normal x ->
  exists t, Rabs t <= unit_to_nearest /\ round radix2 binary64 (Znearest choice) x = x * (1 + t).
Proof.
  intros [-> | N].
  - exists 0; rewrite round_0, Rabs_R0 by auto with typeclass_instances; split; [| ring].
    unfold unit_to_nearest; pose proof (bpow_ge_0 radix2 (-52)); lra.
  - apply as_factor; [intro Z; subst x; rewrite Rabs_R0 in N; pose proof (bpow_gt_0 radix2 (-1022)); lra |].
    apply (relative_error_N_FLT radix2 (-1074) 53 eq_refl choice x N).
Qed.

(** ** A program in float64, each operation rounded by a function of its own: the mode may even change on the way. *)

Section Programs.

Variables (env : nat -> R) (u : R) (rounded : R -> R -> Prop).
Hypothesis U : 0 <= u < 1.
Hypothesis Rounded : forall x y, normal x -> rounded x y -> exists t, Rabs t <= u /\ y = x * (1 + t).

(** What a machine may return; [fused] is a product that goes unrounded into the operation around it. *)
Inductive returns : expr -> R -> Prop :=
| r_input n : returns (Input n) (env n)
| r_whole z : returns (Whole z) (IZR z)
| r_neg a x : returns a x -> returns (Neg a) (- x)
| r_scale n a x : returns a x -> returns (Scale n a) (2 ^ n * x)
| r_add a b x y z : operand a x -> operand b y -> normal (x + y) -> rounded (x + y) z -> returns (Add a b) z
| r_sub a b x y z : operand a x -> operand b y -> normal (x - y) -> rounded (x - y) z -> returns (Sub a b) z
| r_mul a b x y z : returns a x -> returns b y -> normal (x * y) -> rounded (x * y) z -> returns (Mul a b) z
| r_div a b x y z : returns a x -> returns b y -> normal (x / y) -> rounded (x / y) z -> returns (Div a b) z
with operand : expr -> R -> Prop :=
| o_rounded a x : returns a x -> operand a x
| o_fused a b x y : returns a x -> returns b y -> operand (Mul a b) (x * y).

Scheme returns_mut := Induction for returns Sort Prop with operand_mut := Induction for operand Sort Prop.

Ltac factored := match goal with
  N : normal ?v, H : rounded ?v ?z |- _ => destruct (Rounded v z N H) as (t & T & ->) end.

Theorem returns_is_covered e x : returns e x -> computes u exact_inputs env e x.
Proof.
  intros H; apply (returns_mut (fun e x _ => computes u exact_inputs env e x) (fun e x _ => computes u exact_inputs env e x));
    intros; try assumption.
  - rewrite <- (Rmult_1_r (env n)); apply c_input; unfold factor; simpl; lra.
  - apply c_whole.
  - apply c_neg; assumption.
  - apply c_scale; assumption.
  - factored; apply c_add; assumption.
  - factored; apply c_sub; assumption.
  - factored; apply c_mul; assumption.
  - factored; apply c_div; assumption.
  - replace (x0 * y) with (x0 * y * (1 + 0)) by ring; apply c_mul; try assumption; rewrite Rabs_R0; lra.
Qed.

End Programs.

(** In any mode, and with any contraction. *)
Theorem float64_in_any_mode env e x :
  returns env (fun x y => exists rnd, Valid_rnd rnd /\ y = round radix2 binary64 rnd x) e x ->
  computes unit_of_any_mode exact_inputs env e x.
Proof.
  apply returns_is_covered; [split; [apply bpow_ge_0 |] |].
  - unfold unit_of_any_mode; simpl; lra.
  - intros y z N (rnd & V & ->); apply any_mode_rounds; assumption.
Qed.

Theorem float64_to_nearest env e x :
  returns env (fun x y => exists choice, y = round radix2 binary64 (Znearest choice) x) e x ->
  computes unit_to_nearest exact_inputs env e x.
Proof.
  apply returns_is_covered; [split |].
  - unfold unit_to_nearest; pose proof (bpow_ge_0 radix2 (-52)); lra.
  - unfold unit_to_nearest; simpl; lra.
  - intros y z N (choice & ->); apply nearest_rounds; assumption.
Qed.
