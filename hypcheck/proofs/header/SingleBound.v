(** One pair: its bound of 3 delta is larger than the running bound of stage 2, whatever was rounded and contracted.

    M0, M1, M2 are the exact sums of the sizes of all terms of c0, c1, c2, as in Kernel.v. The running bound E of RunningBound.v is at most
    1440 units of (M2 M1)^2, where what it is made of lies within a hundredth of them; one pair compares with 1536 units. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry UnitBall Kernel.
Open Scope R_scope.

Lemma product_le a b c d : 0 <= a <= b -> 0 <= c <= d -> 0 <= a * c <= b * d.
Proof. intros [A B] [C D]; split; [apply Rmult_le_pos | apply Rmult_le_compat]; assumption. Qed.

Section Sizes.

Variables A B P Q : R.
Hypotheses (HA : 0 <= A) (HB : 0 <= B) (HP : 0 <= P) (HQ : 0 <= Q).
Let M0 := A * B.
Let M1 := A * B + A + B + B * P + A * Q.
Let M2 := A + B + 1 + P + Q.
Let T s t : 0 <= s -> 0 <= t -> 0 <= s * t := Rmult_le_pos s t.
Let S s : 0 <= s * s.
Proof. pose proof (pow2_ge_0 s); lra. Qed.

Lemma sizes_small : 2 * M1 <= M2 * M2 /\ 2 * (M2 * M0) <= M1 * M1 /\ 9 * M0 <= M2 * M1.
Proof.
  pose proof (T B P HB HP); pose proof (T A Q HA HQ); pose proof (T A P HA HP); pose proof (T B Q HB HQ); pose proof (T P Q HP HQ); pose proof (T A B HA HB).
  unfold M0, M1, M2; repeat split.
  - pose proof (S A); pose proof (S B); pose proof (S P); pose proof (S Q); lra.
  - pose proof (S (A * B)); pose proof (S A); pose proof (S B); pose proof (S (B * P)); pose proof (S (A * Q)).
    pose proof (T (A * B) (B * P)); pose proof (T (A * B) (A * Q)); pose proof (T A (A * Q)); pose proof (T B (B * P)); pose proof (T (B * P) (A * Q)); lra.
  - assert (0 <= A * ((B - 1) * (B - 1))) by (apply T; [lra | apply S]); assert (0 <= B * ((A - 1) * (A - 1))) by (apply T; [lra | apply S]).
    assert (0 <= (A + B + 1) * (B * P + A * Q)) by (apply T; lra); assert (0 <= (P + Q) * (A * B + A + B + B * P + A * Q)) by (apply T; lra).
    pose proof (S (A - B)); lra.
Qed.

End Sizes.

Section Bound.

Variables M0 M1 M2 q q4 e0 e1 e2 fAB F1 F2 G1 G2 G3 : R.
Hypotheses (H0 : 0 <= M0) (H1 : 0 <= M1) (H2 : 1 <= M2) (S1 : 2 * M1 <= M2 * M2) (S2 : 2 * (M2 * M0) <= M1 * M1) (S3 : 9 * M0 <= M2 * M1)
  (Hq : 0 <= q <= / 2 ^ 40) (Hq4 : 0 <= q4 <= (401 / 100) * q) (E0 : 0 <= e0 <= (809 / 100) * q * M0) (E1 : 0 <= e1 <= (1213 / 100) * q * M1) (E2 : 0 <= e2 <= (809 / 100) * q * M2)
  (HAB : 0 <= fAB <= (101 / 100) * M0) (HF1 : 0 <= F1 <= (101 / 100) * M1) (HF2 : 0 <= F2 <= (101 / 100) * M2).
Hypotheses (HG1 : 0 <= G1 <= (1001 / 1000) * (F2 * F2 + 3 * F1) + q) (HG2 : 0 <= G2 <= (1001 / 1000) * (F2 * F1 + 9 * fAB) + q * M0) (HG3 : 0 <= G3 <= (1001 / 1000) * (F1 * F1 + 3 * (F2 * fAB)) + q * M0).
Let m0 := fAB + e0.
Let m1 := F1 + e1.
Let m2 := F2 + e2.
Let B1 := m2 * (2 * e2 + q4 * m2) + 3 * (e1 + q4 * m1).
Let B2 := m2 * (e1 + q4 * m1) + m1 * e2 + 9 * (e0 + q4 * m0).
Let B3 := m1 * (2 * e1 + q4 * m1) + 3 * (m2 * (e0 + q4 * m0) + m0 * e2).
Let a1 := G1 + B1.
Let a2 := G2 + B2.
Let a3 := G3 + B3.

Theorem running_bound_small : 0 <= 4 * (a1 * (B3 + q4 * a3) + a3 * B1) + a2 * (2 * B2 + q4 * a2) <= 1440 * q * (M2 * M1 * (M2 * M1)).
Proof.
  assert (Q : q <= / 1000000) by (apply Rle_trans with (/ 2 ^ 40); [apply Hq |]; apply Rinv_le_contravar; simpl; lra).
  assert (qM : forall M, 0 <= M -> 0 <= q * M <= / 1000000 * M) by (intros M H; split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_r; lra]).
  pose proof (qM M0 H0); pose proof (qM M1 H1); pose proof (qM M2 ltac:(lra)).
  assert (K0 : 0 <= m0 <= (1011 / 1000) * M0) by (unfold m0; lra); assert (K1 : 0 <= m1 <= (1011 / 1000) * M1) by (unfold m1; lra); assert (K2 : 0 <= m2 <= (1011 / 1000) * M2) by (unfold m2; lra).
  pose proof (product_le _ _ _ _ Hq4 K0) as U0; pose proof (product_le _ _ _ _ Hq4 K1) as U1; pose proof (product_le _ _ _ _ Hq4 K2) as U2.
  assert (D2 : 0 <= 2 * e2 + q4 * m2 <= q * M2 * (203 / 10)) by lra; assert (D1 : 0 <= e1 + q4 * m1 <= q * M1 * (163 / 10)) by lra.
  assert (D0 : 0 <= e0 + q4 * m0 <= q * M0 * (122 / 10)) by lra; assert (D3 : 0 <= 2 * e1 + q4 * m1 <= q * M1 * (284 / 10)) by lra.
  set (s2 := M2 * M2) in *; set (s1 := M1 * M1) in *; set (p := M2 * M1) in *; set (p0 := M2 * M0) in *.
  assert (Z2 : 0 <= s2) by (unfold s2; apply Rmult_le_pos; lra); assert (Z1 : 0 <= s1) by (unfold s1; apply Rmult_le_pos; lra).
  assert (Zp : 0 <= p) by (unfold p; apply Rmult_le_pos; lra); assert (Zp0 : 0 <= p0) by (unfold p0; apply Rmult_le_pos; lra).
  pose proof (product_le _ _ _ _ K2 D2) as X1; replace ((1011 / 1000) * M2 * (q * M2 * (203 / 10))) with ((1011 / 1000) * (203 / 10) * (q * s2)) in X1 by (unfold s2; ring).
  pose proof (product_le _ _ _ _ K2 D1) as X2; replace ((1011 / 1000) * M2 * (q * M1 * (163 / 10))) with ((1011 / 1000) * (163 / 10) * (q * p)) in X2 by (unfold p; ring).
  pose proof (product_le _ _ _ _ K1 E2) as X3; replace ((1011 / 1000) * M1 * ((809 / 100) * q * M2)) with ((1011 / 1000) * (809 / 100) * (q * p)) in X3 by (unfold p; ring).
  pose proof (product_le _ _ _ _ K1 D3) as X4; replace ((1011 / 1000) * M1 * (q * M1 * (284 / 10))) with ((1011 / 1000) * (284 / 10) * (q * s1)) in X4 by (unfold s1; ring).
  pose proof (product_le _ _ _ _ K2 D0) as X5; replace ((1011 / 1000) * M2 * (q * M0 * (122 / 10))) with ((1011 / 1000) * (122 / 10) * (q * p0)) in X5 by (unfold p0; ring).
  pose proof (product_le _ _ _ _ K0 E2) as X6; replace ((1011 / 1000) * M0 * ((809 / 100) * q * M2)) with ((1011 / 1000) * (809 / 100) * (q * p0)) in X6 by (unfold p0; ring).
  assert (Y1 : q * (2 * M1) <= q * s2) by (apply Rmult_le_compat_l; lra); assert (Y2 : q * (2 * p0) <= q * s1) by (apply Rmult_le_compat_l; lra).
  assert (Y3 : q * (9 * M0) <= q * p) by (apply Rmult_le_compat_l; lra).
  assert (L1 : 0 <= B1 <= (451 / 10) * (q * s2)) by (unfold B1; lra).
  assert (L2 : 0 <= B2 <= (369 / 10) * (q * p)) by (unfold B2; lra).
  assert (L3 : 0 <= B3 <= (596 / 10) * (q * s1)) by (unfold B3; lra).
  assert (F22 : 0 <= F2 * F2 <= (10201 / 10000) * s2) by (pose proof (product_le _ _ _ _ HF2 HF2) as W; replace ((101 / 100) * M2 * ((101 / 100) * M2)) with ((10201 / 10000) * s2) in W by (unfold s2; field); exact W).
  assert (F21 : 0 <= F2 * F1 <= (10201 / 10000) * p) by (pose proof (product_le _ _ _ _ HF2 HF1) as W; replace ((101 / 100) * M2 * ((101 / 100) * M1)) with ((10201 / 10000) * p) in W by (unfold p; field); exact W).
  assert (F11 : 0 <= F1 * F1 <= (10201 / 10000) * s1) by (pose proof (product_le _ _ _ _ HF1 HF1) as W; replace ((101 / 100) * M1 * ((101 / 100) * M1)) with ((10201 / 10000) * s1) in W by (unfold s1; field); exact W).
  assert (F20 : 0 <= F2 * fAB <= (10201 / 10000) * p0) by (pose proof (product_le _ _ _ _ HF2 HAB) as W; replace ((101 / 100) * M2 * ((101 / 100) * M0)) with ((10201 / 10000) * p0) in W by (unfold p0; field); exact W).
  assert (s2_1 : 1 <= s2) by (unfold s2; pose proof (product_le 1 M2 1 M2 ltac:(lra) ltac:(lra)); lra).
  assert (p0_0 : M0 <= p0) by (unfold p0; pose proof (Rmult_le_compat_r M0 1 M2 H0 H2); lra).
  pose proof (qM s2 Z2) as V2; pose proof (qM s1 Z1) as V1; pose proof (qM p Zp) as Vp.
  assert (A1 : 0 <= a1 <= (256 / 100) * s2) by (unfold a1; lra).
  assert (A2 : 0 <= a2 <= (205 / 100) * p) by (unfold a2; lra).
  assert (A3 : 0 <= a3 <= (256 / 100) * s1) by (unfold a3; lra).
  pose proof (product_le _ _ _ _ Hq4 A3) as W3; pose proof (product_le _ _ _ _ Hq4 A2) as W2.
  assert (C3 : 0 <= B3 + q4 * a3 <= 70 * (q * s1)) by lra; assert (C2 : 0 <= 2 * B2 + q4 * a2 <= (821 / 10) * (q * p)) by lra.
  pose proof (product_le _ _ _ _ A1 C3) as R1; pose proof (product_le _ _ _ _ A3 L1) as R2; pose proof (product_le _ _ _ _ A2 C2) as R3.
  assert (PP : s2 * s1 = p * p) by (unfold s2, s1, p; ring).
  replace ((256 / 100) * s2 * (70 * (q * s1))) with ((256 / 100) * 70 * (q * (p * p))) in R1 by (rewrite <- PP; ring).
  replace ((256 / 100) * s1 * ((451 / 10) * (q * s2))) with ((256 / 100) * (451 / 10) * (q * (p * p))) in R2 by (rewrite <- PP; ring).
  replace ((205 / 100) * p * ((821 / 10) * (q * p))) with ((205 / 100) * (821 / 10) * (q * (p * p))) in R3 by ring.
  assert (0 <= q * (p * p)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]); lra.
Qed.

End Bound.
