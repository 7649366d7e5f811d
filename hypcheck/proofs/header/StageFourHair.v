(** Stage 4: what floats compute for 10^-18 b, or γ, is no more than 2^-31 of it, or no coordinate is shorter.

    The product is rounded in any mode, flushed to 0 or not, of doubles in any range, and so is 10^-18 itself. Where b is so small that
    the product is below the least double, it is rounded to that or to 0, and a coordinate that is not 0 is no shorter than that. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Flocq Require Import Core.
From Hypcheck Require Import Geometry Steps Fixed FixedRuns Long Trees Ranges StageThreeRuns StageThreeAnswers StageThreeNumbers StageThreePosition StageFiveAnswers
  StageFourBeside StageFourPosition DoubleValues.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Section Hair.
Variables (m e : string -> Z) (zeros : Z -> Z).
Hypotheses (Zeros : counts_zeros zeros) (Lengths : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 2 ^ 52 <= m n < 2 ^ 53)
  (Powers : forall n, In n lengths -> -4096 <= e n <= 2046) (Multiples : forall n, In n lengths -> m n <> 0 -> 1 <= e n + zeros (m n)).
Notation V := (value_of m e).

Lemma least n : In n lengths -> m n <> 0 -> (pow (-1074) <= Rabs (V n))%R.
Proof.
  intros I N; destruct Zeros as [C]; destruct (C (m n) N) as [Z0 D]; apply Z.divide_abs_r, Z.divide_pos_le in D; [| lia].
  pose proof (Multiples n I N).
  rewrite (size_is m e); apply Rle_trans with (IZR (2 ^ zeros (m n)) * power (e n - 1075))%R.
  - rewrite <- power_is, power_whole, <- power_sum by lia; rewrite !power_is; apply bpow_le; lia.
  - apply Rmult_le_compat_r; [apply Rlt_le, power_positive | apply IZR_le, D].
Qed.
Lemma greatest n : In n ["b"; "gamma"] -> (0 < V n <= pow 1024)%R.
Proof.
  intros I; pose proof (Lengths n ltac:(cbn in *; tauto)) as [L G]; pose proof (Powers n ltac:(cbn in *; tauto)) as [_ P].
  assert (0 < power (e n - 1075))%R by apply power_positive; split; [apply Rmult_lt_0_compat; [apply IZR_lt; lia | assumption] |].
  apply Rle_trans with (IZR (2 ^ 53) * power (e n - 1075))%R; [apply Rmult_le_compat_r; [lra | apply IZR_le; lia] |].
  rewrite power_whole, <- power_sum by lia; rewrite power_is; apply bpow_le; lia.
Qed.

(** 10^-18 as a double, and its products. *)
Variables (hair : Z -> Z -> Z * Z) (factor : R).
Hypotheses (Factor : rounded (1 / 10 ^ 18)%R factor)
  (Products : forall n, In n ["b"; "gamma"] -> Ranges.returned (factor * V n)%R (hair_value m e hair n)).

Lemma factor_between : (0 <= factor <= pow (-59))%R.
Proof.
  assert (P : (0 < 10 ^ 18)%R) by lra; split.
  - apply stays_positive with (1 / 10 ^ 18)%R; [exact Factor |]; apply Rlt_le, Rdiv_lt_0_compat; lra.
  - apply stays_below with (1 / 10 ^ 18)%R; [exact Factor | lia |]; change (pow (-59)) with (/ IZR (2 ^ 59))%R.
    unfold Rdiv; rewrite Rmult_1_l; apply Rinv_le; [apply IZR_lt; reflexivity |]; rewrite pow_IZR; apply IZR_le; vm_compute; discriminate.
Qed.

Theorem products_are_short : hairs_are_short m e hair.
Proof.
  intros n w I H; destruct (hair_between m e hair n w H) as [N L]; pose proof factor_between as [F0 F].
  assert (W : In w ["b"; "gamma"]) by (clear - I; cbn in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; cbn; tauto).
  assert (J : In n lengths) by (clear - I; cbn in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; cbn; tauto).
  pose proof (greatest w W) as [P G]; pose proof (least n J ltac:(lia)) as Least; pose proof (Products w W) as R.
  set (v := V w) in *; set (h := hair_value m e hair w) in *.
  destruct (mag radix2 v) as [q Q]; specialize (Q ltac:(lra)); rewrite Rabs_pos_eq in Q by lra.
  assert (below : (0 <= factor * v <= pow (q - 59))%R).
  { split; [apply Rmult_le_pos; lra |]; replace (q - 59) with (-59 + q) by ring; rewrite bpow_plus; apply Rmult_le_compat; lra. }
  destruct R as [R | [[_ R] | [R _]]].
  - destruct (Z_le_gt_dec (-1074) (q - 59)) as [B | B].
    + apply Rle_trans with (pow (q - 59)); [apply stays_below with (factor * v)%R; tauto |].
      replace (q - 59) with (q - 1 + -58) by ring; rewrite bpow_plus; unfold Rdiv; apply Rmult_le_compat; try apply bpow_ge_0; [tauto |].
      change (pow (-58)) with (/ IZR (2 ^ 58))%R; apply Rinv_le; [lra |]; rewrite pow_IZR; apply IZR_le; vm_compute; discriminate.
    + exfalso; assert (h <= pow (-1074))%R; [| lra]; apply stays_below with (factor * v)%R; [exact R | lia |].
      apply Rle_trans with (pow (q - 59)); [tauto | apply bpow_le; lia].
  - rewrite R; lra.
  - exfalso; rewrite Rabs_pos_eq in R by tauto; assert (factor * v <= pow (-59) * pow 1024)%R by (apply Rmult_le_compat; lra).
    rewrite <- bpow_plus in *; pose proof (bpow_lt radix2 (-59 + 1024) 1023 ltac:(lia)); lra.
Qed.
End Hair.
