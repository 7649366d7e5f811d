(** What is true of every monic cubic k: its two extremes, its discriminant, its roots. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry Duality.
Open Scope R_scope.

Section Cubic.

Variables b2 b1 b0 : R.

Definition k x := x ^ 3 + b2 * x ^ 2 + b1 * x + b0.
Definition slope_of x := 3 * x ^ 2 + 2 * b2 * x + b1.
Definition h := b2 ^ 2 - 3 * b1.
Definition disc := b1 ^ 2 * (b2 ^ 2 - 4 * b1) + b0 * (b2 * (18 * b1 - 4 * b2 ^ 2) - 27 * b0).

(** Where k has a local maximum and a local minimum, if h > 0. *)
Definition low := (- b2 - sqrt h) / 3.
Definition high := (- b2 + sqrt h) / 3.

Lemma h_square : 0 <= h -> b1 = (b2 ^ 2 - sqrt h ^ 2) / 3.
Proof. intros H; rewrite sq_sqrt by assumption; unfold h; field. Qed.

Lemma low_lt_high : 0 < h -> low < high.
Proof. intros H; pose proof (sqrt_lt_R0 h H); unfold low, high; lra. Qed.

Lemma slope_factors x : 0 <= h -> slope_of x = 3 * (x - low) * (x - high).
Proof. intros H; unfold slope_of, low, high; rewrite (h_square H) at 1; field. Qed.

Lemma from_low x : 0 <= h -> k x = k low + (x - low) ^ 2 * (x - low - sqrt h).
Proof. intros H; unfold k, low; rewrite (h_square H) at 1 2; field. Qed.

Lemma from_high x : 0 <= h -> k x = k high + (x - high) ^ 2 * (x - high + sqrt h).
Proof. intros H; unfold k, high; rewrite (h_square H) at 1 2; field. Qed.

Lemma extremes_differ : 0 <= h -> k low - k high = 4 * sqrt h ^ 3 / 27.
Proof. intros H; unfold k, low, high; rewrite (h_square H) at 1 2; field. Qed.

Lemma disc_of_extremes : 0 <= h -> disc = - (27 * (k low * k high)).
Proof. intros H; unfold disc, k, low, high; rewrite (h_square H) at 1 2 3 4 5; field. Qed.

(** 3 disc = 4 h1 h3 - h2^2: the form with the fewest operations. *)
Lemma disc_hessian : 3 * disc = 4 * h * (b1 ^ 2 - 3 * b2 * b0) - (b2 * b1 - 9 * b0) ^ 2.
Proof. unfold disc, h; ring. Qed.

Lemma disc_pos_h : 0 < disc -> 0 < h.
Proof.
  intros D; apply Rnot_le_lt; intro H.
  assert (E : 27 * disc = 4 * h ^ 3 - (2 * b2 ^ 3 - 9 * b2 * b1 + 27 * b0) ^ 2) by (unfold disc, h; ring).
  pose proof (pow2_ge_0 (2 * b2 ^ 3 - 9 * b2 * b1 + 27 * b0)).
  assert (0 <= - h * h ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]).
  replace (- h * h ^ 2) with (- h ^ 3) in H1 by ring; lra.
Qed.

(** disc > 0 exactly if the maximum is above 0 and the minimum below. *)
Lemma disc_pos_iff : 0 < disc <-> 0 < h /\ k high < 0 < k low.
Proof.
  split.
  - intros D; assert (H := disc_pos_h D); split; [assumption |].
    rewrite disc_of_extremes in D by lra; pose proof (extremes_differ ltac:(lra)) as X.
    assert (0 < sqrt h ^ 3) by (apply pow_lt, sqrt_lt_R0; assumption).
    assert (N : k low * k high < 0) by lra.
    destruct (Rtotal_order (k low) 0) as [L | [L | L]].
    + assert (0 < - k low * - k high) by (apply Rmult_lt_0_compat; lra); lra.
    + rewrite L in N; lra.
    + split; [| assumption]; apply Rnot_le_lt; intro M.
      assert (0 <= k low * k high) by (apply Rmult_le_pos; lra); lra.
  - intros (H & L & U); rewrite disc_of_extremes by lra.
    assert (0 < k low * - k high) by (apply Rmult_lt_0_compat; lra); lra.
Qed.

(** Between two places where k is not positive, it can be positive only if the local maximum is there too. *)
Theorem maximum_between x l y : x < l < y -> k x <= 0 -> k y <= 0 -> 0 < k l ->
  0 < h /\ x < low < y /\ 0 < k low.
Proof.
  intros [XL LY] KX KY KL.
  set (X := x + b2 / 3); set (L := l + b2 / 3); set (Y := y + b2 / 3).
  assert (D1 : h / 3 < L ^ 2 + L * X + X ^ 2).
  { apply Rmult_lt_reg_l with (l - x); [lra |].
    assert (k l - k x = (l - x) * (L ^ 2 + L * X + X ^ 2 - h / 3)) by (unfold k, h, L, X; field); lra. }
  assert (D2 : Y ^ 2 + Y * L + L ^ 2 < h / 3).
  { apply Rmult_lt_reg_l with (y - l); [lra |].
    assert (k y - k l = (y - l) * (Y ^ 2 + Y * L + L ^ 2 - h / 3)) by (unfold k, h, L, Y; field); lra. }
  assert (H : 0 < h).
  { replace (Y ^ 2 + Y * L + L ^ 2) with ((Y + L / 2) ^ 2 + 3 * (L / 2) ^ 2) in D2 by field.
    pose proof (pow2_ge_0 (Y + L / 2)); pose proof (pow2_ge_0 (L / 2)); lra. }
  set (s := sqrt h / 3); assert (S : 0 < s) by (unfold s; pose proof (sqrt_lt_R0 h H); lra).
  assert (Eh : h / 3 = 3 * s ^ 2) by (unfold s; rewrite <- (sq_sqrt h) at 1 by lra; field).
  rewrite Eh in D1, D2.
  assert (L1 : L < s) by (apply Rnot_le_lt; intro N; assert (s < Y) by (unfold Y, L in *; lra); nra).
  assert (Y1 : - s < Y) by (apply Rnot_le_lt; intro N; assert (L < - s) by (unfold Y, L in *; lra); nra).
  assert (X1 : X < - s).
  { apply Rnot_le_lt; intro N; assert (- s < L) by (unfold X, L in *; lra).
    assert (X < s) by (unfold X, L in *; lra).
    assert (X ^ 2 <= s ^ 2) by nra; assert (L ^ 2 <= s ^ 2) by nra; assert (L * X <= s ^ 2) by nra; lra. }
  assert (P : low = - s - b2 / 3) by (unfold low, s; field).
  split; [assumption |]; split; [unfold X, Y in *; lra |].
  rewrite (from_low l) in KL by lra.
  assert (0 <= (l - low) ^ 2 * (low + sqrt h - l)).
  { apply Rmult_le_pos; [apply pow2_ge_0 |]; unfold L, s in *; lra. }
  lra.
Qed.

(** ** Three roots. *)

Lemma k_continuous : continuity k.
Proof. unfold k; reg. Qed.

Lemma k_large : exists M, 0 < M /\ (forall x, M <= x -> 0 < k x) /\ (forall x, x <= - M -> k x < 0).
Proof.
  set (M := 1 + Rabs b2 + Rabs b1 + Rabs b0); exists M.
  pose proof (Rabs_pos b2); pose proof (Rabs_pos b1); pose proof (Rabs_pos b0).
  assert (U : forall c x, M <= x -> - (Rabs c * x) <= c * x <= Rabs c * x).
  { intros c x X; pose proof (Rle_abs c); pose proof (Rle_abs (- c)); rewrite Rabs_Ropp in *.
    assert (0 < x) by (unfold M in X; lra).
    assert (c * x <= Rabs c * x) by (apply Rmult_le_compat_r; lra).
    assert (- c * x <= Rabs c * x) by (apply Rmult_le_compat_r; lra); lra. }
  assert (W : forall c2 c1 c0 x, Rabs c2 <= Rabs b2 -> Rabs c1 <= Rabs b1 -> Rabs c0 <= Rabs b0 -> M <= x ->
              0 < x ^ 3 + c2 * x ^ 2 + c1 * x + c0).
  { intros a2 a1 a0 x A2 A1 A0 X; assert (1 <= x) by (unfold M in X; lra).
    pose proof (Rle_abs (- a2)); pose proof (Rle_abs (- a1)); pose proof (Rle_abs (- a0)); rewrite Rabs_Ropp in *.
    assert (x <= x ^ 2) by nra; assert (1 <= x ^ 2) by nra.
    assert (- Rabs b2 * x ^ 2 <= a2 * x ^ 2) by (apply Rmult_le_compat_r; lra).
    assert (- Rabs b1 * x ^ 2 <= a1 * x).
    { apply Rle_trans with (- Rabs b1 * x); [| apply Rmult_le_compat_r; lra].
      rewrite !Ropp_mult_distr_l_reverse; apply Ropp_le_contravar, Rmult_le_compat_l; lra. }
    assert (- Rabs b0 * x ^ 2 <= a0).
    { apply Rle_trans with (- Rabs b0 * 1); [| lra].
      rewrite !Ropp_mult_distr_l_reverse; apply Ropp_le_contravar, Rmult_le_compat_l; lra. }
    assert (M * x ^ 2 <= x * x ^ 2) by (apply Rmult_le_compat_r; lra).
    replace (x ^ 3) with (x * x ^ 2) by ring; unfold M in *; lra. }
  split; [unfold M; lra | split].
  - intros x X; apply W; auto using Rle_refl.
  - intros x X; assert (0 < (- x) ^ 3 + - b2 * (- x) ^ 2 + b1 * - x + - b0).
    { apply W; try rewrite Rabs_Ropp; try apply Rle_refl; lra. }
    unfold k; replace ((- x) ^ 3 + - b2 * (- x) ^ 2 + b1 * - x + - b0) with (- (x ^ 3 + b2 * x ^ 2 + b1 * x + b0)) in *
      by ring; lra.
Qed.

(** A root x splits off; the other two are those of a quadratic, or there are none. *)
Lemma split_off r : k r = 0 ->
  (exists u v, u <= v /\ forall x, k x = (x - r) * (x - u) * (x - v))
  \/ (exists m e, 0 < e /\ forall x, k x = (x - r) * ((x - m) ^ 2 + e)).
Proof.
  intros R; set (m := - (b2 + r) / 2); set (D := m ^ 2 - (b1 + r * (b2 + r))).
  assert (F : forall x, k x = (x - r) * ((x - m) ^ 2 - D)).
  { intros x; replace (k x) with (k x - k r) by lra; unfold k, D, m; field. }
  destruct (Rle_lt_dec 0 D) as [P | N].
  - left; exists (m - sqrt D), (m + sqrt D); pose proof (sqrt_pos D); split; [lra |].
    intros x; rewrite F; transitivity ((x - r) * ((x - m) ^ 2 - sqrt D ^ 2)); [rewrite sq_sqrt by assumption |]; ring.
  - right; exists m, (- D); split; [lra |]; intros x; rewrite F; ring.
Qed.

End Cubic.
