(** Stage 1: half planes of R = x^2 + y^2 over T = z^2 prove positions, a line for each multiplier and a chord for contact. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry UnitBall AnyAxis Completeness Rule Positions.
Open Scope R_scope.

Section Scene.

Variables alpha gamma b d : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d).

Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let at_centre x y z := upright alpha gamma b d x y z.

Let HA : 0 < A.
Proof. apply A_pos; assumption. Qed.
Let HB : 0 < B.
Proof. apply B_pos; assumption. Qed.

(** The line of one multiplier: beyond it (l in (0, B)) positions are exterior, within it (m in (0, A)) interior. *)
Definition beyond_K l := b ^ 2 * (A + l) * (1 + 1 / l).
Definition beyond_M l := b ^ 2 / d ^ 2 * (A + l) / (B - l).
Definition within_K m := b ^ 2 * (A - m) * (1 - 1 / m).
Definition within_M m := b ^ 2 / d ^ 2 * (A - m) / (B + m).

Let product_sign k v : 0 < k -> (0 < k * v <-> 0 < v).
Proof.
  intros K; split; intros H; [| apply Rmult_lt_0_compat; assumption].
  apply Rmult_lt_reg_l with k; [assumption |]; rewrite Rmult_0_r; assumption.
Qed.

Lemma exterior_half_plane x y z : exterior (at_centre x y z) <->
  exists l, 0 < l < B /\ beyond_K l + beyond_M l * z ^ 2 < x ^ 2 + y ^ 2.
Proof.
  unfold at_centre; rewrite (exterior_rule alpha gamma b d x y z Ha Hg Hb Hd); fold A B.
  assert (E : forall l, 0 < l < B -> (0 < g A B ((x ^ 2 + y ^ 2) / b ^ 2) ((z / d) ^ 2) l
    <-> beyond_K l + beyond_M l * z ^ 2 < x ^ 2 + y ^ 2)).
  { intros l [L U].
    assert (K : 0 < l * (B - l) / b ^ 2) by (apply over_lt; [apply Rmult_lt_0_compat; lra | apply pow_lt2; assumption]).
    replace (g A B ((x ^ 2 + y ^ 2) / b ^ 2) ((z / d) ^ 2) l)
      with (l * (B - l) / b ^ 2 * (x ^ 2 + y ^ 2 - (beyond_K l + beyond_M l * z ^ 2)))
      by (unfold g, beyond_K, beyond_M; field; lra).
    rewrite (product_sign _ _ K); lra. }
  split; intros (l & I & H); exists l; (split; [exact I |]); apply (E l I); exact H.
Qed.

Lemma interior_half_plane x y z : interior (at_centre x y z) <->
  exists m, 0 < m < A /\ x ^ 2 + y ^ 2 < within_K m + within_M m * z ^ 2.
Proof.
  unfold at_centre; rewrite (interior_rule alpha gamma b d x y z Ha Hg Hb Hd); fold A B.
  assert (E : forall m, 0 < m < A -> (0 < g A B ((x ^ 2 + y ^ 2) / b ^ 2) ((z / d) ^ 2) (- m)
    <-> x ^ 2 + y ^ 2 < within_K m + within_M m * z ^ 2)).
  { intros m [L U].
    assert (K : 0 < m * (B + m) / b ^ 2) by (apply over_lt; [apply Rmult_lt_0_compat; lra | apply pow_lt2; assumption]).
    replace (g A B ((x ^ 2 + y ^ 2) / b ^ 2) ((z / d) ^ 2) (- m))
      with (m * (B + m) / b ^ 2 * (within_K m + within_M m * z ^ 2 - (x ^ 2 + y ^ 2)))
      by (unfold g, within_K, within_M; field; lra).
    rewrite (product_sign _ _ K); lra. }
  split.
  - intros (l & I & H); exists (- l); assert (J : 0 < - l < A) by lra; split; [exact J |].
    apply (E _ J); rewrite Ropp_involutive; exact H.
  - intros (m & I & H); exists (- m); split; [lra | apply (E m I); exact H].
Qed.

(** Any line on the safe side of a proved one is a proof. *)
Theorem exterior_beyond_line K M l x y z : 0 < l < B -> beyond_K l <= K -> beyond_M l <= M ->
  K + M * z ^ 2 < x ^ 2 + y ^ 2 -> exterior (at_centre x y z).
Proof.
  intros I HK HM H; apply exterior_half_plane; exists l; split; [exact I |].
  assert (beyond_M l * z ^ 2 <= M * z ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | assumption]); lra.
Qed.

Theorem interior_within_line K M m x y z : 0 < m < A -> K <= within_K m -> M <= within_M m ->
  x ^ 2 + y ^ 2 < K + M * z ^ 2 -> interior (at_centre x y z).
Proof.
  intros I HK HM H; apply interior_half_plane; exists m; split; [exact I |].
  assert (M * z ^ 2 <= within_M m * z ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | assumption]); lra.
Qed.

(** ** Chords. Two positions that are not exterior: none below their chord is. *)

Let chord_below k1 m1 k2 m2 t1 t2 t : t1 <= t <= t2 ->
  k1 + m1 * t1 <= k2 + m2 * t1 -> k1 + m1 * t2 <= k2 + m2 * t2 -> k1 + m1 * t <= k2 + m2 * t.
Proof.
  intros [L U] H1 H2; destruct (Rle_lt_dec m1 m2) as [M | M].
  - assert ((m2 - m1) * t1 <= (m2 - m1) * t) by (apply Rmult_le_compat_l; lra); lra.
  - assert ((m1 - m2) * t <= (m1 - m2) * t2) by (apply Rmult_le_compat_l; lra); lra.
Qed.

Theorem not_exterior_under_chord K M x1 y1 z1 x2 y2 z2 x y z :
  ~ exterior (at_centre x1 y1 z1) -> ~ exterior (at_centre x2 y2 z2) -> z1 ^ 2 <= z ^ 2 <= z2 ^ 2 ->
  K + M * z1 ^ 2 <= x1 ^ 2 + y1 ^ 2 -> K + M * z2 ^ 2 <= x2 ^ 2 + y2 ^ 2 ->
  x ^ 2 + y ^ 2 <= K + M * z ^ 2 -> ~ exterior (at_centre x y z).
Proof.
  intros N1 N2 T H1 H2 H E; apply exterior_half_plane in E; destruct E as (l & I & E).
  assert (L1 : x1 ^ 2 + y1 ^ 2 <= beyond_K l + beyond_M l * z1 ^ 2)
    by (apply Rnot_lt_le; intro C; apply N1, exterior_half_plane; exists l; split; assumption).
  assert (L2 : x2 ^ 2 + y2 ^ 2 <= beyond_K l + beyond_M l * z2 ^ 2)
    by (apply Rnot_lt_le; intro C; apply N2, exterior_half_plane; exists l; split; assumption).
  pose proof (chord_below K M (beyond_K l) (beyond_M l) (z1 ^ 2) (z2 ^ 2) (z ^ 2) T ltac:(lra) ltac:(lra)); lra.
Qed.

Theorem not_interior_above_chord K M x1 y1 z1 x2 y2 z2 x y z :
  ~ interior (at_centre x1 y1 z1) -> ~ interior (at_centre x2 y2 z2) -> z1 ^ 2 <= z ^ 2 <= z2 ^ 2 ->
  x1 ^ 2 + y1 ^ 2 <= K + M * z1 ^ 2 -> x2 ^ 2 + y2 ^ 2 <= K + M * z2 ^ 2 ->
  K + M * z ^ 2 <= x ^ 2 + y ^ 2 -> ~ interior (at_centre x y z).
Proof.
  intros N1 N2 T H1 H2 H E; apply interior_half_plane in E; destruct E as (m & I & E).
  assert (L1 : within_K m + within_M m * z1 ^ 2 <= x1 ^ 2 + y1 ^ 2)
    by (apply Rnot_lt_le; intro C; apply N1, interior_half_plane; exists m; split; assumption).
  assert (L2 : within_K m + within_M m * z2 ^ 2 <= x2 ^ 2 + y2 ^ 2)
    by (apply Rnot_lt_le; intro C; apply N2, interior_half_plane; exists m; split; assumption).
  pose proof (chord_below (within_K m) (within_M m) K M (z1 ^ 2) (z2 ^ 2) (z ^ 2) T ltac:(lra) ltac:(lra)); lra.
Qed.

Theorem contact_between_chords x y z :
  ~ exterior (at_centre x y z) -> ~ interior (at_centre x y z) -> contact (at_centre x y z).
Proof.
  intros E I; destruct (positions_by_g alpha gamma b d x y z Ha Hg Hb Hd) as (GE & GI & GC).
  apply GC; split; [rewrite <- GE | rewrite <- GI]; assumption.
Qed.

End Scene.
