(** Stage 2: where its computed numbers lie beyond their computed bounds, the answer is the position.

    Every operation returns its exact result times 1 + t, |t| <= u, whatever was rounded and contracted; what underflows besides moves a
    value by [lost] at most. StageTwoRuns.v says that the steps of the C are such, by its guards. *)

Require Import Reals Lra List.
From Hypcheck Require Import Geometry UnitBall Cubic Rule Rounding Kernel RunningBound Positions Stages.
From Hypcheck Require StageTwo.
Import ListNotations.
Open Scope R_scope.

Section Row.

Variables alpha gamma b d x y z u : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d) (U : 0 <= u <= / 2 ^ 52).

Let row n := nth n [alpha; gamma; b; d; x; y; z] 0.
Let computed env := computes u exact_inputs env.

(** The numbers by their names in the program. *)
Variables fA fB fAB fBP fAQ fP fQ f1 f2 lost : R.
Hypotheses (CA : computed row StageTwo.A fA) (CB : computed row StageTwo.B fB) (CAB : computed row StageTwo.AB fAB)
  (CBP : nearly (computed row StageTwo.BP) lost fBP) (CAQ : nearly (computed row StageTwo.AQ) lost fAQ)
  (CP : nearly (computed row StageTwo.P) lost fP) (CQ : nearly (computed row StageTwo.Q) lost fQ)
  (C1 : nearly (computed row StageTwo.c1) lost f1) (C2 : nearly (computed row StageTwo.c2) lost f2).
Hypotheses (BP0 : 0 <= fBP) (AQ0 : 0 <= fAQ) (P0 : 0 <= fP) (Q0 : 0 <= fQ).
Let small := / 2 ^ 52 * / 2 ^ 52 * / 2 ^ 52.
Hypotheses (L1 : 0 <= lost <= small) (LA : lost <= small * fA) (LAB : lost <= small * fAB) (LABB : lost <= small * (fAB * fAB)).

Let coefficients n := nth n [- fAB; f1; f2] 0.
Variables h1 h2 h3 delta_3 : R.
Hypotheses (H1 : nearly (computed coefficients StageTwo.Parts.h1) lost h1) (H2 : nearly (computed coefficients StageTwo.Parts.h2) lost h2)
  (H3 : nearly (computed coefficients StageTwo.Parts.h3) lost h3) (CD : nearly (computed (fun n => nth n [h1; h2; h3] 0) StageTwo.Last.delta_3) lost delta_3).

Let slopes n := nth n [f1; f2; alpha; gamma; b; d] 0.
Variables slope_B offset_B slope_A offset_A : R.
Hypotheses (KB : nearly (computed slopes StageTwo.Slopes.slope_B) lost slope_B) (KB' : nearly (computed slopes StageTwo.Slopes.offset_B) lost offset_B)
  (KA : nearly (computed slopes StageTwo.Slopes.slope_A) lost slope_A) (KA' : nearly (computed slopes StageTwo.Slopes.offset_A) lost offset_A).

(** Their bounds, computed too. *)
Let known n := nth n [fA; fB; fAB; fBP; fAQ; fP; fQ; Rabs f1; Rabs f2; Rabs h1; Rabs h2; Rabs h3;
                      4 * unit * slack; 8 * unit * slack; 12 * unit * slack; slack; 16 * unit * slack] 0.
Variables E e1 e2 bound_B offset_bound_B bound_A offset_bound_A : R.
Let bounded := computes u products_unrounded known.
Hypotheses (BE : bounded StageTwo.Bound.E E) (B1 : bounded StageTwo.Bound.e1 e1) (B2 : bounded StageTwo.Bound.e2 e2)
  (BB : bounded StageTwo.Bound.bound_B bound_B) (BB' : bounded StageTwo.Bound.offset_bound_B offset_bound_B)
  (BA : bounded StageTwo.Bound.bound_A bound_A) (BA' : bounded StageTwo.Bound.offset_bound_A offset_bound_A).

Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let P := (x ^ 2 + y ^ 2) / b ^ 2.
Let Q := (z / d) ^ 2.

Lemma bounds_cover : Rabs (delta_3 - 3 * delta A B P Q) <= E /\ Rabs (f1 - c1 A B P Q) <= e1 /\ Rabs (f2 - c2 A B P Q) <= e2
  /\ Rabs (slope_B - slope A B P Q B) <= bound_B /\ Rabs (offset_B - (3 * B + c2 A B P Q)) <= offset_bound_B
  /\ Rabs (slope_A - slope A B P Q (- A)) <= bound_A /\ Rabs (offset_A - (3 * A - c2 A B P Q)) <= offset_bound_A.
Proof.
  repeat split.
  - eapply running_bound_covers_the_error; eassumption.
  - eapply bound_covers_c1; eassumption.
  - eapply bound_covers_c2; eassumption.
  - eapply bound_covers_slope_at_B; eassumption.
  - eapply bound_covers_offset_at_B; eassumption.
  - eapply bound_covers_slope_at_minus_A; eassumption.
  - eapply bound_covers_offset_at_minus_A; eassumption.
Qed.

(** The comparisons, as the program "certified" makes and joins them, without its guards. *)
Let three_roots := E < delta_3.
Let all_positive := three_roots /\ f2 < - e2 /\ e1 < f1.
Let two_negative := three_roots /\ (e2 < f2 \/ f1 < - e1).

Inductive says : answer -> Prop :=
| says_exterior : all_positive -> offset_bound_B < offset_B \/ slope_B < - bound_B -> says Exterior
| says_interior : two_negative -> offset_bound_A < offset_A -> bound_A < slope_A -> says Interior
| says_crossing : delta_3 < - E -> says Contact
| says_groove : all_positive -> offset_B < - offset_bound_B -> bound_B < slope_B -> says Contact
| says_throat : two_negative -> offset_A < - offset_bound_A \/ slope_A < - bound_A -> says Contact.

Theorem stage_two_is_right a : says a -> is_position (upright alpha gamma b d x y z) a.
Proof.
  destruct bounds_cover as (D & D1 & D2 & SB & OB & SA & OA).
  assert (up : forall X e v, Rabs (X - v) <= e -> e < X -> certainly_positive v) by (intros X e v H K; exists X, e; auto).
  assert (low : forall X e v, Rabs (X - v) <= e -> X < - e -> certainly_negative v) by (intros X e v H K; exists X, e; auto).
  intros S; apply (whatever_stage_answers alpha gamma b d x y z Ha Hg Hb Hd); destruct S as [[T [N2 N1]] O | [T N] O S | T | [T [N2 N1]] O S | [T N] O].
  - apply by_coefficients_exterior; [eapply up | eapply low | eapply up | destruct O; [left; eapply up | right; eapply low]]; eassumption.
  - apply by_coefficients_interior; [eapply up; eassumption | destruct N; [left; eapply up | right; eapply low]; eassumption
      | eapply up; eassumption | eapply up; eassumption].
  - apply one_root; eapply low; eassumption.
  - apply groove; [eapply low | eapply up | eapply low | eapply up]; eassumption.
  - apply throat; [destruct N; [left; eapply up | right; eapply low] | destruct O; [left; eapply low | right; eapply low]]; eassumption.
Qed.

End Row.
