(** What the paper prints and is false, each refuted by its witness. The repaired statements are in Rule.v. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry Certificates UnitBall Duality Cubic Rule.
Open Scope R_scope.

(** The unit ball about (r, 0, z) and the hyperboloid of semi-axes a and c: by Theorem 1 every pair is one. *)
Definition body a c r z := upright a c 1 1 r 0 z.

Definition Delta a c r z := delta (a ^ 2) (c ^ 2) (r ^ 2) (z ^ 2).
Definition C2 a c r z := c2 (a ^ 2) (c ^ 2) (r ^ 2) (z ^ 2).
Definition C1 a c r z := c1 (a ^ 2) (c ^ 2) (r ^ 2) (z ^ 2).

Definition proposition_3_1_as_printed := forall a c r z, 0 < a -> 0 < c -> a <= c ^ 2 ->
  (exterior (body a c r z) <-> 0 < Delta a c r z /\ C2 a c r z < 0 /\ 0 < C1 a c r z).

Definition proposition_3_2_as_printed := forall a c r z, 0 < a -> 0 < c -> a <= c ^ 2 ->
  Delta a c r z <= 0 -> contact (body a c r z).

Definition three_different_positive_roots f :=
  exists u v w, 0 < u < v /\ v < w /\ forall l, f l = (l - u) * (l - v) * (l - w).

Definition roots_in_the_proof_of_3_as_printed := forall a c r z, 0 < a -> 0 < c -> a <= c ^ 2 ->
  (exterior (body a c r z) <-> three_different_positive_roots (g (a ^ 2) (c ^ 2) (r ^ 2) (z ^ 2))).

Definition signs_in_the_proof_of_3_as_printed := forall a c r z, 0 < a -> 0 < c -> a <= c ^ 2 ->
  (C2 a c r z < 0 /\ 0 < C1 a c r z <-> forall l, g (a ^ 2) (c ^ 2) (r ^ 2) (z ^ 2) l = 0 -> 0 < l).

Definition proposition_5_1_as_printed := forall a c r z, 1 < a -> 0 < c ->
  (interior (body a c r z) <-> 0 < Delta a c r z
    /\ ((0 < C2 a c r z /\ C1 a c r z <> 0) \/ (C2 a c r z < 0 /\ C1 a c r z < 0))).

Definition proposition_5_2_as_printed := forall a c r z, 1 < a -> 0 < c ->
  Delta a c r z <= 0 -> contact (body a c r z).

(** Procedure 1 outside its regime, and what the caption of Table 4 needs to be "valid for both cases". *)
Definition procedure_1_without_hypothesis := forall a c r z, 0 < a -> 0 < c ->
  0 < Delta a c r z /\ C2 a c r z < 0 /\ 0 < C1 a c r z -> ~ contact (body a c r z).

Definition contact_means_no_discriminant := forall a c r z, 0 < a -> 0 < c ->
  contact (body a c r z) -> Delta a c r z <= 0.

Ltac compute_delta := unfold Delta, C2, C1, delta, disc, c2, c1, c0; lra.

Lemma ring_of_radius_5_2 : exterior (body 1 2 (5 / 2) 0).
Proof. apply exterior_by_g with 1; unfold g; lra. Qed.

Lemma ring_of_radius_10 : exterior (body 7 7 10 0).
Proof. apply exterior_by_g with 20; unfold g; lra. Qed.

Lemma interior_with_c2_0 : interior (body 3 3 1 0).
Proof. apply interior_by_g with (-2); unfold g; lra. Qed.

Lemma interior_with_c1_0 : interior (body 4 1 1 0).
Proof. apply interior_by_g with (-4); unfold g; lra. Qed.

Lemma crossing_in_the_groove : contact (body 2 (1 / 2) 4 0).
Proof.
  apply contact_by_points with (Point 3 0 0) (Point (17 / 5) 0 (4 / 5));
    [apply upright_valid; lra | | |]; unfold in_spheroid, depth, height, norm2, along, dot, sub; simpl; lra.
Qed.

Lemma contact_with_positive_delta : contact (body 1 (1 / 4) 2 (1 / 2)).
Proof.
  apply contact_by_points with (Point 2 0 (1 / 2)) (Point 3 0 (1 / 2));
    [apply upright_valid; lra | | |]; unfold in_spheroid, depth, height, norm2, along, dot, sub; simpl; lra.
Qed.

Theorem proposition_3_1_is_false : ~ proposition_3_1_as_printed.
Proof.
  intros H; destruct (H 1 2 (5 / 2) 0) as [D _]; try lra.
  destruct (D ring_of_radius_5_2) as (D0 & _); revert D0; compute_delta.
Qed.

Theorem proposition_3_2_is_false : ~ proposition_3_2_as_printed.
Proof.
  intros H; destruct (positions_exclude_each_other (body 1 2 (5 / 2) 0)) as (X & _); apply X.
  split; [apply ring_of_radius_5_2 | apply H; try lra; compute_delta].
Qed.

Theorem roots_in_the_proof_of_3_are_false : ~ roots_in_the_proof_of_3_as_printed.
Proof.
  intros H; destruct (H 1 2 (5 / 2) 0) as [D _]; try lra.
  destruct (D ring_of_radius_5_2) as (u & v & w & [U V] & W & F).
  assert (G : forall l, g (1 ^ 2) (2 ^ 2) ((5 / 2) ^ 2) (0 ^ 2) l = (l - 4) ^ 2 * (l - 1 / 4)) by (intros; unfold g; field).
  assert (R : forall l, (l - u) * (l - v) * (l - w) = 0 -> l = 4 \/ l = 1 / 4).
  { intros l E; rewrite <- F, G in E; apply Rmult_integral in E; destruct E as [E | E]; [left | right; lra].
    assert (l - 4 = 0) by (apply Rsqr_0_uniq; rewrite Rsqr_pow2; assumption); lra. }
  destruct (R u), (R v), (R w); try ring; lra.
Qed.

Theorem signs_in_the_proof_of_3_are_false : ~ signs_in_the_proof_of_3_as_printed.
Proof.
  intros H; destruct (H 1 1 1 0) as [_ D]; try lra.
  destruct D as [D _]; [| revert D; unfold C2, c2; lra].
  intros l E; assert (G : l ^ 3 = 1) by (unfold g in E; lra).
  apply Rnot_le_lt; intro N; assert (0 <= - l * l ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]).
  replace (- l * l ^ 2) with (- l ^ 3) in H0 by ring; lra.
Qed.

Theorem proposition_5_1_is_false_where_c2_is_0 : ~ proposition_5_1_as_printed.
Proof.
  intros H; destruct (H 3 3 1 0) as [D _]; try lra.
  destruct (D interior_with_c2_0) as [_ [[D0 _] | [D0 _]]]; revert D0; unfold C2, c2; lra.
Qed.

Theorem proposition_5_1_is_false_where_c1_is_0 : ~ proposition_5_1_as_printed.
Proof.
  intros H; destruct (H 4 1 1 0) as [D _]; try lra.
  destruct (D interior_with_c1_0) as [_ [[_ D0] | [_ D0]]]; revert D0; unfold C1, c1; lra.
Qed.

Theorem proposition_5_2_is_false : ~ proposition_5_2_as_printed.
Proof.
  intros H; destruct (positions_exclude_each_other (body 7 7 10 0)) as (X & _); apply X.
  split; [apply ring_of_radius_10 | apply H; try lra; compute_delta].
Qed.

Theorem procedure_1_needs_its_hypothesis : ~ procedure_1_without_hypothesis.
Proof. intros H; apply (H 2 (1 / 2) 4 0); [lra | lra | compute_delta | apply crossing_in_the_groove]. Qed.

Theorem caption_of_table_4_is_false : ~ contact_means_no_discriminant.
Proof.
  intros H; assert (D := H 1 (1 / 4) 2 (1 / 2) ltac:(lra) ltac:(lra) contact_with_positive_delta).
  revert D; compute_delta.
Qed.

(** Equation (11) as printed has the denominator a^2 c^2 = A B. *)
Theorem equation_11_is_misprinted : ~ forall A B x y z l, 0 < A -> 0 < B ->
  pencil_determinant A B x y z l = (A + l) * g A B (x ^ 2 + y ^ 2) (z ^ 2) l / (A * B).
Proof. intros H; specialize (H 2 1 0 0 0 0 ltac:(lra) ltac:(lra)); revert H; unfold pencil_determinant, g; lra. Qed.

(** Equation (12) as printed lacks - z^2 in the coefficient of l^2. *)
Theorem equation_12_is_misprinted : ~ forall A B P Q l, 0 < A -> 0 < B ->
  g A B P Q l = l ^ 3 + (A - B + 1 - P) * l ^ 2 + c1 A B P Q * l + c0 A B P Q.
Proof. intros H; specialize (H 1 1 0 1 1 ltac:(lra) ltac:(lra)); revert H; unfold g, c1, c0; lra. Qed.
