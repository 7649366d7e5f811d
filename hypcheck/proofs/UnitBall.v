(** The unit ball about (x, y, z) and the hyperboloid X1^2/A1 + X2^2/A2 - X3^2/B = 1.

    An upright pair is one with A1 = A2 after Theorem 1; a tilted one is brought to three different numbers by a linear
    map (Tilted.v). Here are the identity on which all rests, and the cubic g of an upright pair. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry Certificates.
Open Scope R_scope.

Definition ball (x y z X1 X2 X3 : R) := (X1 - x) ^ 2 + (X2 - y) ^ 2 + (X3 - z) ^ 2 - 1.
Definition wall (A1 A2 B X1 X2 X3 : R) := X1 ^ 2 / A1 + X2 ^ 2 / A2 - X3 ^ 2 / B - 1.

(** The identity: where (Y1, Y2, Y3) makes ball + t wall stationary, the pencil is its value there plus squares. *)
Lemma stationary A1 A2 B x y z t Y1 Y2 Y3 X1 X2 X3 : 0 < A1 -> 0 < A2 -> 0 < B ->
  (A1 + t) * Y1 = A1 * x -> (A2 + t) * Y2 = A2 * y -> (B - t) * Y3 = B * z ->
  ball x y z X1 X2 X3 + t * wall A1 A2 B X1 X2 X3
  = ball x y z Y1 Y2 Y3 + t * wall A1 A2 B Y1 Y2 Y3
    + (A1 + t) / A1 * (X1 - Y1) ^ 2 + (A2 + t) / A2 * (X2 - Y2) ^ 2 + (B - t) / B * (X3 - Y3) ^ 2.
Proof.
  intros HA1 HA2 HB E1 E2 E3; unfold ball, wall.
  replace x with ((A1 + t) * Y1 / A1) by (rewrite E1; field; lra).
  replace y with ((A2 + t) * Y2 / A2) by (rewrite E2; field; lra).
  replace z with ((B - t) * Y3 / B) by (rewrite E3; field; lra).
  field; lra.
Qed.

(** Between the poles the squares count positively. *)
Lemma pencil_above A1 A2 B x y z t Y1 Y2 Y3 X1 X2 X3 : 0 < A1 -> 0 < A2 -> 0 < B ->
  - A1 <= t -> - A2 <= t -> t <= B ->
  (A1 + t) * Y1 = A1 * x -> (A2 + t) * Y2 = A2 * y -> (B - t) * Y3 = B * z ->
  ball x y z Y1 Y2 Y3 + t * wall A1 A2 B Y1 Y2 Y3 <= ball x y z X1 X2 X3 + t * wall A1 A2 B X1 X2 X3.
Proof.
  intros HA1 HA2 HB T1 T2 T3 E1 E2 E3.
  rewrite (stationary A1 A2 B x y z t Y1 Y2 Y3 X1 X2 X3) by assumption.
  assert (0 <= (A1 + t) / A1 * (X1 - Y1) ^ 2) by (apply Rmult_le_pos; [apply over_pos; lra | apply pow2_ge_0]).
  assert (0 <= (A2 + t) / A2 * (X2 - Y2) ^ 2) by (apply Rmult_le_pos; [apply over_pos; lra | apply pow2_ge_0]).
  assert (0 <= (B - t) / B * (X3 - Y3) ^ 2) by (apply Rmult_le_pos; [apply over_pos; lra | apply pow2_ge_0]).
  lra.
Qed.

(** ** The cubic of an upright pair: equation (12) of the paper, put right. P = x^2 + y^2 and Q = z^2 in radii. *)

Definition g (A B P Q l : R) := (A + l) * (B - l) * (P + Q - 1 - l) - A * P * (B - l) - B * Q * (A + l).
Definition c2 (A B P Q : R) := A - B + 1 - P - Q.
Definition c1 (A B P Q : R) := B * P - A * Q + A - B - A * B.
Definition c0 (A B P Q : R) := - (A * B).
Definition slope (A B P Q l : R) := 3 * l ^ 2 + 2 * c2 A B P Q * l + c1 A B P Q.

Lemma g_expanded A B P Q l : g A B P Q l = l ^ 3 + c2 A B P Q * l ^ 2 + c1 A B P Q * l + c0 A B P Q.
Proof. unfold g, c2, c1, c0; ring. Qed.

(** det (lambda H + S) of the two 4 x 4 matrices, the outer columns expanded: equation (11), denominator A^2 B. *)
Definition pencil_determinant (A B x y z l : R) :=
  let e := 1 + l / A in let f := 1 - l / B in
  e * (e * (f * (x ^ 2 + y ^ 2 + z ^ 2 - 1 - l) - z ^ 2) - y ^ 2 * f) - x ^ 2 * e * f.

Lemma determinant_is_cubic A B x y z l : 0 < A -> 0 < B ->
  pencil_determinant A B x y z l = (A + l) * g A B (x ^ 2 + y ^ 2) (z ^ 2) l / (A ^ 2 * B).
Proof. intros; unfold pencil_determinant, g; field; lra. Qed.

Lemma g_at_minus_A A B P Q : g A B P Q (- A) = - (A * P * (A + B)).
Proof. unfold g; ring. Qed.
Lemma g_at_0 A B P Q : g A B P Q 0 = - (A * B).
Proof. unfold g; ring. Qed.
Lemma g_at_B A B P Q : g A B P Q B = - (B * Q * (A + B)).
Proof. unfold g; ring. Qed.

(** The least value of the pencil at l, between the poles. *)
Lemma least_of_pencil A B x y z l : 0 < A -> 0 < B -> - A < l -> l < B ->
  let Y1 := A * x / (A + l) in let Y2 := A * y / (A + l) in let Y3 := B * z / (B - l) in
  ball x y z Y1 Y2 Y3 + l * wall A A B Y1 Y2 Y3 = g A B (x ^ 2 + y ^ 2) (z ^ 2) l / ((A + l) * (B - l)).
Proof. intros; unfold ball, wall, g, Y1, Y2, Y3; field; lra. Qed.

Lemma g_positive_means A B x y z l : 0 < A -> 0 < B -> - A < l -> l < B ->
  (0 < g A B (x ^ 2 + y ^ 2) (z ^ 2) l <-> forall X1 X2 X3, 0 < ball x y z X1 X2 X3 + l * wall A A B X1 X2 X3).
Proof.
  intros HA HB H1 H2; pose proof (least_of_pencil A B x y z l HA HB H1 H2) as E; cbv zeta in E.
  assert (N : 0 < (A + l) * (B - l)) by (apply Rmult_lt_0_compat; lra); split; intros H.
  - intros X1 X2 X3.
    apply Rlt_le_trans with (g A B (x ^ 2 + y ^ 2) (z ^ 2) l / ((A + l) * (B - l))); [apply over_lt; assumption |].
    rewrite <- E; apply pencil_above; try lra; field; lra.
  - specialize (H (A * x / (A + l)) (A * y / (A + l)) (B * z / (B - l))); rewrite E in H.
    apply Rmult_lt_reg_r with (/ ((A + l) * (B - l))); [apply Rinv_0_lt_compat; assumption |].
    unfold Rdiv in H; lra.
Qed.

(** ** The double root of g gives a touching point. *)

Lemma touching A B x y z m : 0 < A -> 0 < B -> m <> 0 -> - A <= m <= B ->
  g A B (x ^ 2 + y ^ 2) (z ^ 2) m = 0 -> slope A B (x ^ 2 + y ^ 2) (z ^ 2) m = 0 ->
  ~ (m = B /\ - c2 A B (x ^ 2 + y ^ 2) (z ^ 2) - 2 * m < B) ->
  exists Y1 Y2 Y3, ball x y z Y1 Y2 Y3 = 0 /\ wall A A B Y1 Y2 Y3 = 0
    /\ (A + m) * Y1 = A * x /\ (A + m) * Y2 = A * y /\ (B - m) * Y3 = B * z.
Proof.
  intros HA HB M [[L | L] [U | U]] G S R.
  - (* between the poles: the stationary point itself *)
    set (Y1 := A * x / (A + m)); set (Y2 := A * y / (A + m)); set (Y3 := B * z / (B - m)).
    assert (W : wall A A B Y1 Y2 Y3 = 0).
    { transitivity ((slope A B (x ^ 2 + y ^ 2) (z ^ 2) m * ((A + m) * (B - m))
        - g A B (x ^ 2 + y ^ 2) (z ^ 2) m * ((B - m) - (A + m))) / ((A + m) * (B - m)) ^ 2).
      - unfold wall, slope, g, c2, c1, Y1, Y2, Y3; field; lra.
      - rewrite G, S; field; lra. }
    pose proof (least_of_pencil A B x y z m HA HB L U) as E; cbv zeta in E; fold Y1 Y2 Y3 in E.
    rewrite W, G in E; exists Y1, Y2, Y3; repeat split; [| assumption | | |]; try (unfold Y1, Y2, Y3; field; lra).
    unfold Rdiv in E; lra.
  - (* at B: two points, above and below the plane of the waist *)
    subst m; rewrite g_at_B in G.
    assert (Z : z = 0).
    { assert (K : z ^ 2 = 0) by (apply Rmult_eq_reg_l with (B * (A + B)); [lra |]; apply Rgt_not_eq; nra).
      apply Rsqr_0_uniq; rewrite Rsqr_pow2; assumption. }
    subst z; set (P := x ^ 2 + y ^ 2) in *.
    assert (EP : P = (1 + B) * (A + B) / B).
    { apply Rmult_eq_reg_l with B; [| lra].
      transitivity ((1 + B) * (A + B)); [unfold slope, c2, c1 in S; lra | field; lra]. }
    assert (N : B <= A / B).
    { apply Rnot_lt_le; intro K; apply R; split; [reflexivity |]. unfold c2; rewrite EP.
      replace (- (A - B + 1 - (1 + B) * (A + B) / B - 0 ^ 2) - 2 * B) with (A / B) by (field; lra). assumption. }
    set (h := B * (A * P / (A + B) ^ 2 - 1)).
    assert (Hh : h = B * (A / B - B) / (A + B)) by (unfold h; rewrite EP; field; lra).
    assert (0 <= h) by (rewrite Hh; apply over_pos; [apply Rmult_le_pos; lra | lra]).
    exists (A * x / (A + B)), (A * y / (A + B)), (sqrt h); repeat split; try (field; lra); try ring.
    + unfold ball; replace ((sqrt h - 0) ^ 2) with h by (rewrite <- (sqrt_sqrt h) at 1 by assumption; ring).
      transitivity (B ^ 2 * P / (A + B) ^ 2 + h - 1); [unfold P; field; lra | rewrite Hh, EP; field; lra].
    + unfold wall; rewrite <- Rsqr_pow2 with (x := sqrt h), Rsqr_sqrt by assumption.
      transitivity (A * P / (A + B) ^ 2 - h / B - 1); [unfold P; field; lra | unfold h; field; lra].
  - (* at -A: a circle *)
    subst m; rewrite g_at_minus_A in G; set (Z := B * z / (A + B)).
    assert (P0 : x ^ 2 + y ^ 2 = 0) by (apply Rmult_eq_reg_l with (A * (A + B)); [lra |]; apply Rgt_not_eq; nra).
    assert (x = 0 /\ y = 0) as [-> ->] by (split; nra).
    assert (ES : z ^ 2 * A = (A + B) * (1 - A)).
    { unfold slope, c2, c1 in S; ring_simplify in S. nra. }
    exists (sqrt (A * (1 + Z ^ 2 / B))), 0, Z.
    assert (0 <= Z ^ 2 / B) by (apply over_pos; [apply pow2_ge_0 | assumption]).
    assert (0 <= A * (1 + Z ^ 2 / B)) by (apply Rmult_le_pos; lra).
    repeat split; try ring.
    + unfold ball; rewrite Rminus_0_r, <- (Rsqr_pow2 (sqrt _)), Rsqr_sqrt by assumption; unfold Z.
      transitivity (A - 1 + z ^ 2 * A / (A + B)); [field; lra | rewrite ES; field; lra].
    + unfold wall; rewrite <- (Rsqr_pow2 (sqrt _)), Rsqr_sqrt by assumption; field; lra.
    + unfold Z; field; lra.
  - lra.
Qed.

(** ** From the numbers of an upright pair to A, B, P, Q, and back to the geometry. *)

Section Upright.

Variables alpha gamma b d x y z : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d).

Let p := upright alpha gamma b d x y z.
Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let P := (x ^ 2 + y ^ 2) / b ^ 2.
Let Q := (z / d) ^ 2.

Lemma upright_valid : valid p.
Proof. unfold valid, p, upright, dot; simpl; repeat split; try assumption; lra. Qed.

Lemma A_pos : 0 < A.
Proof. apply pow_lt2, over_lt; assumption. Qed.
Lemma B_pos : 0 < B.
Proof. apply pow_lt2, over_lt; assumption. Qed.
Lemma P_ge_0 : 0 <= P.
Proof. apply over_pos; [pose proof (pow2_ge_0 x); pose proof (pow2_ge_0 y); lra | apply pow_lt2; assumption]. Qed.
Lemma Q_ge_0 : 0 <= Q.
Proof. apply pow2_ge_0. Qed.

Lemma P_scaled : P = (x / b) ^ 2 + (y / b) ^ 2.
Proof. unfold P; field; lra. Qed.

Lemma depth_is_ball X : depth p X = ball (x / b) (y / b) (z / d) (px X / b) (py X / b) (pz X / d).
Proof. unfold depth, norm2, along, dot, sub, ball, p; simpl; field; lra. Qed.

Lemma height_is_wall X : height p X = wall A A B (px X / b) (py X / b) (pz X / d).
Proof. unfold height, wall, A, B, p; simpl; field; lra. Qed.

Lemma pencil_is l X : pencil p l X = ball (x / b) (y / b) (z / d) (px X / b) (py X / b) (pz X / d)
                                     + l * wall A A B (px X / b) (py X / b) (pz X / d).
Proof. unfold pencil; rewrite depth_is_ball, height_is_wall; reflexivity. Qed.

Lemma g_proves_pencil l : - A < l -> l < B -> 0 < g A B P Q l -> forall X, 0 < pencil p l X.
Proof.
  intros L U G X; rewrite pencil_is; revert X; rewrite P_scaled in G; unfold Q in G.
  intros X; apply g_positive_means; auto using A_pos, B_pos.
Qed.

Theorem exterior_by_g l : 0 < l -> l < B -> 0 < g A B P Q l -> exterior p.
Proof.
  intros L U G; apply exterior_by_multiplier with l; [assumption |].
  apply g_proves_pencil; try assumption; pose proof A_pos; lra.
Qed.

Theorem interior_by_g l : - A < l -> l < 0 -> 0 < g A B P Q l -> interior p.
Proof.
  intros L U G; apply interior_by_multiplier with l; [assumption |].
  apply g_proves_pencil; try assumption; pose proof B_pos; lra.
Qed.

Theorem tangent_by_double_root m : m <> 0 -> - A <= m <= B -> g A B P Q m = 0 -> slope A B P Q m = 0 ->
  ~ (m = B /\ - c2 A B P Q - 2 * m < B) -> (0 < m -> tangent_outside p) /\ (m < 0 -> tangent_inside p).
Proof.
  rewrite P_scaled; intros M I G S R; pose proof A_pos as PA; pose proof B_pos as PB.
  destruct (touching A B (x / b) (y / b) (z / d) m PA PB M I G S R) as (Y1 & Y2 & Y3 & HB & HW & E1 & E2 & E3).
  assert (N : forall X, 0 <= pencil p m X).
  { intros X; rewrite pencil_is.
    replace 0 with (ball (x / b) (y / b) (z / d) Y1 Y2 Y3 + m * wall A A B Y1 Y2 Y3) by (rewrite HB, HW; ring).
    apply pencil_above; try assumption; lra. }
  assert (C : contact p).
  { exists (Point (Y1 * b) (Y2 * b) (Y3 * d)); unfold on_spheroid, on_hyperboloid.
    rewrite depth_is_ball, height_is_wall; simpl.
    replace (Y1 * b / b) with Y1 by (field; lra); replace (Y2 * b / b) with Y2 by (field; lra);
    replace (Y3 * d / d) with Y3 by (field; lra); split; assumption. }
  split; intros; [apply tangent_outside_by_multiplier with m | apply tangent_inside_by_multiplier with m]; assumption.
Qed.

Theorem contact_by_double_root m : m <> 0 -> - A <= m <= B -> g A B P Q m = 0 -> slope A B P Q m = 0 ->
  ~ (m = B /\ - c2 A B P Q - 2 * m < B) -> contact p.
Proof.
  intros M I G S R; destruct (tangent_by_double_root m M I G S R) as [H K].
  destruct (Rlt_dec 0 m); [apply H | apply K]; lra.
Qed.

End Upright.
