(** The rule that needs no hypothesis, for upright pairs: the cubic g decides, and every answer has a certificate.

    exterior: a rational l in (0, B) with g(l) > 0; interior: a rational l in (-A, 0) with g(l) > 0; contact: two points
    of the solid spheroid with rational coordinates on two sides of the hyperboloid, or the double root of g. *)

Require Import Reals Lra QArith Qreals.
From Hypcheck Require Import Geometry Certificates UnitBall Duality AnyAxis.
Open Scope R_scope.

(** Near a place where two continuous functions are positive there is a rational where both are. *)
Lemma rational_near f h x : continuity f -> continuity h -> 0 < f x -> 0 < h x ->
  exists q, 0 < f (Q2R q) /\ 0 < h (Q2R q).
Proof.
  intros Cf Ch Hf Hh.
  destruct (Cf x (f x) Hf) as (u & U & Nu); destruct (Ch x (h x) Hh) as (v & V & Nv).
  assert (W : 0 < Rmin u v) by (apply Rmin_pos; assumption).
  destruct (rational_between x (x + Rmin u v)) as [q [Q1 Q2]]; [lra |].
  pose proof (Rmin_l u v); pose proof (Rmin_r u v); exists q.
  assert (K : forall k, k < u \/ k < v -> D_x no_cond x (Q2R q)) by (intros; split; [exact I | lra]).
  split.
  - specialize (Nu (Q2R q)); simpl in Nu; unfold R_dist in Nu.
    assert (D : Rabs (f (Q2R q) - f x) < f x) by (apply Nu; split; [split; [exact I | lra] | rewrite Rabs_pos_eq; lra]).
    apply Rabs_def2 in D; lra.
  - specialize (Nv (Q2R q)); simpl in Nv; unfold R_dist in Nv.
    assert (D : Rabs (h (Q2R q) - h x) < h x) by (apply Nv; split; [split; [exact I | lra] | rewrite Rabs_pos_eq; lra]).
    apply Rabs_def2 in D; lra.
Qed.

Definition rational_point X := exists x y z, X = Point (Q2R x) (Q2R y) (Q2R z).

(** The same for points: the inside of the spheroid and the sides of the hyperboloid are open. *)
Lemma rational_point_near p side X : depth p X < 0 -> 0 < side * height p X ->
  exists Y, rational_point Y /\ depth p Y < 0 /\ 0 < side * height p Y.
Proof.
  destruct X as [x y z]; intros D H.
  destruct (rational_near (fun t => - depth p (Point t y z)) (fun t => side * height p (Point t y z)) x)
    as (qx & D1 & H1); try lra; try (unfold depth, height, norm2, along, dot, sub, Rdiv; simpl; reg).
  destruct (rational_near (fun t => - depth p (Point (Q2R qx) t z)) (fun t => side * height p (Point (Q2R qx) t z)) y)
    as (qy & D2 & H2); try lra; try (unfold depth, height, norm2, along, dot, sub, Rdiv; simpl; reg).
  destruct (rational_near (fun t => - depth p (Point (Q2R qx) (Q2R qy) t))
                          (fun t => side * height p (Point (Q2R qx) (Q2R qy) t)) z)
    as (qz & D3 & H3); try lra; try (unfold depth, height, norm2, along, dot, sub, Rdiv; simpl; reg).
  exists (Point (Q2R qx) (Q2R qy) (Q2R qz)); split; [exists qx, qy, qz; reflexivity |]; split; [lra | assumption].
Qed.

(** Where a point of the hyperboloid is within the spheroid, points of both sides are: move along the ray from 0. *)
Lemma both_sides p Y : depth p Y < 0 -> on_hyperboloid p Y -> forall side, side <> 0 ->
  exists X, rational_point X /\ depth p X < 0 /\ 0 < side * height p X.
Proof.
  intros D H side S; unfold on_hyperboloid in H.
  assert (K : forall k, height p (scale k Y) = k ^ 2 - 1).
  { intros k; transitivity (k ^ 2 * height p Y + (k ^ 2 - 1)); [unfold height, scale, Rdiv; simpl; ring | rewrite H; ring]. }
  assert (C : continuity (fun k => - depth p (scale k Y)))
    by (unfold depth, norm2, along, dot, sub, scale, Rdiv; simpl; reg).
  assert (D1 : 0 < - depth p (scale 1 Y)) by (replace (scale 1 Y) with Y by (apply point_eq; simpl; ring); lra).
  destruct (C 1 _ D1) as (u & U & N); set (h := Rmin u 1 / 2).
  assert (M : 0 < Rmin u 1) by (apply Rmin_pos; lra); pose proof (Rmin_l u 1); pose proof (Rmin_r u 1).
  assert (E : forall k, k <> 1 -> Rabs (k - 1) < u -> depth p (scale k Y) < 0).
  { intros k K1 K2; specialize (N k); simpl in N; unfold R_dist in N.
    assert (W : Rabs (- depth p (scale k Y) - - depth p (scale 1 Y)) < - depth p (scale 1 Y))
      by (apply N; split; [split; [exact I | lra] | assumption]).
    apply Rabs_def2 in W; lra. }
  destruct (Rdichotomy _ _ S) as [L | L].
  - apply rational_point_near with (scale (1 - h) Y); [apply E; [unfold h; lra |] |].
    + rewrite Rabs_left; unfold h; lra.
    + rewrite K; replace (side * ((1 - h) ^ 2 - 1)) with (- side * (h * (2 - h))) by ring.
      repeat apply Rmult_lt_0_compat; unfold h; lra.
  - apply rational_point_near with (scale (1 + h) Y); [apply E; [unfold h; lra |] |].
    + rewrite Rabs_pos_eq; unfold h; lra.
    + rewrite K; replace (side * ((1 + h) ^ 2 - 1)) with (side * (h * (2 + h))) by ring.
      repeat apply Rmult_lt_0_compat; unfold h; lra.
Qed.

(** A touching point with a multiplier between the poles makes the multiplier a double root of g, not the ring's. *)
Lemma touching_gives_double_root A B x y z t Y1 Y2 Y3 : 0 < A -> 0 < B -> nearest_with A A B x y z t Y1 Y2 Y3 ->
  ball x y z Y1 Y2 Y3 = 0 ->
  g A B (x ^ 2 + y ^ 2) (z ^ 2) t = 0 /\ slope A B (x ^ 2 + y ^ 2) (z ^ 2) t = 0
  /\ ~ (t = B /\ - c2 A B (x ^ 2 + y ^ 2) (z ^ 2) - 2 * t < B).
Proof.
  intros HA HB (T1 & T2 & T3 & W & E1 & E2 & E3) S.
  destruct T1 as [T1 | T1]; [destruct T3 as [T3 | T3] |].
  - (* between the poles *)
    assert (F1 : Y1 = A * x / (A + t)) by (apply Rmult_eq_reg_l with (A + t); [rewrite E1; field |]; lra).
    assert (F2 : Y2 = A * y / (A + t)) by (apply Rmult_eq_reg_l with (A + t); [rewrite E2; field |]; lra).
    assert (F3 : Y3 = B * z / (B - t)) by (apply Rmult_eq_reg_l with (B - t); [rewrite E3; field |]; lra).
    assert (N : (A + t) * (B - t) <> 0) by (apply Rmult_integral_contrapositive; lra).
    pose proof (least_of_pencil A B x y z t HA HB ltac:(lra) T3) as G; cbv zeta in G.
    rewrite <- F1, <- F2, <- F3, S, W in G.
    assert (G0 : g A B (x ^ 2 + y ^ 2) (z ^ 2) t = 0).
    { apply Rmult_eq_reg_r with (/ ((A + t) * (B - t))); [| apply Rinv_neq_0_compat; assumption].
      unfold Rdiv in G; rewrite <- G; ring. }
    split; [assumption |]; split; [| lra].
    assert (K : slope A B (x ^ 2 + y ^ 2) (z ^ 2) t * ((A + t) * (B - t))
                = wall A A B Y1 Y2 Y3 * ((A + t) * (B - t)) ^ 2
                  + g A B (x ^ 2 + y ^ 2) (z ^ 2) t * ((B - t) - (A + t))).
    { rewrite F1, F2, F3; unfold wall, slope, g, c2, c1; field; lra. }
    rewrite W, G0 in K; apply Rmult_eq_reg_r with ((A + t) * (B - t)); [rewrite K; ring | assumption].
  - (* at B *)
    subst t; assert (Z : z = 0) by (apply Rmult_eq_reg_l with B; lra); subst z.
    assert (F1 : Y1 = A * x / (A + B)) by (apply Rmult_eq_reg_l with (A + B); [rewrite E1; field |]; lra).
    assert (F2 : Y2 = A * y / (A + B)) by (apply Rmult_eq_reg_l with (A + B); [rewrite E2; field |]; lra).
    set (P := x ^ 2 + y ^ 2); assert (HY : 0 <= Y3 ^ 2) by apply pow2_ge_0.
    assert (W' : A * P / (A + B) ^ 2 = 1 + Y3 ^ 2 / B).
    { transitivity (wall A A B Y1 Y2 Y3 + 1 + Y3 ^ 2 / B); [rewrite F1, F2; unfold wall, P; field; lra | rewrite W; ring]. }
    assert (S' : B ^ 2 * P / (A + B) ^ 2 = 1 - Y3 ^ 2).
    { transitivity (ball x y 0 Y1 Y2 Y3 + 1 - Y3 ^ 2); [rewrite F1, F2; unfold ball, P; field; lra | rewrite S; ring]. }
    assert (EP : B * P = (1 + B) * (A + B)).
    { transitivity ((A + B) * (B ^ 2 * P / (A + B) ^ 2 + B * (A * P / (A + B) ^ 2))); [field; lra |].
      rewrite W', S'; field; lra. }
    assert (EY : Y3 ^ 2 = (A - B ^ 2) / (A + B)).
    { replace P with ((1 + B) * (A + B) / B) in W' by (rewrite <- EP; field; lra).
      transitivity (B * (1 + Y3 ^ 2 / B) - B); [field; lra | rewrite <- W'; field; lra]. }
    split; [| split].
    + rewrite g_at_B; ring.
    + unfold slope, c2, c1; lra.
    + intros [_ K]; unfold c2 in K.
      replace P with ((1 + B) * (A + B) / B) in K by (rewrite <- EP; field; lra).
      replace (- (A - B + 1 - (1 + B) * (A + B) / B - 0 ^ 2) - 2 * B) with (A / B) in K by (field; lra).
      assert (A / B * B < B * B) by (apply Rmult_lt_compat_r; assumption).
      replace (A / B * B) with A in H by (field; lra).
      assert (0 < (B ^ 2 - A) / (A + B)) by (apply over_lt; lra).
      replace ((B ^ 2 - A) / (A + B)) with (- ((A - B ^ 2) / (A + B))) in H0 by (field; lra); lra.
  - (* at -A *)
    subst t; assert (X : x = 0) by (apply Rmult_eq_reg_l with A; lra).
    assert (Y : y = 0) by (apply Rmult_eq_reg_l with A; lra); subst x y.
    assert (F3 : Y3 = B * z / (A + B)) by (apply Rmult_eq_reg_l with (A + B); [transitivity (B * z); [rewrite <- E3; ring | field] |]; lra).
    assert (K : 1 - A = z ^ 2 * A / (A + B)).
    { transitivity (1 - A + (ball 0 0 z Y1 Y2 Y3 - A * wall A A B Y1 Y2 Y3)); [rewrite S, W; ring |].
      rewrite F3; unfold ball, wall; field; lra. }
    split; [| split].
    + rewrite g_at_minus_A; ring.
    + assert (K' : (A + B) * (1 - A) = z ^ 2 * A) by (rewrite K; field; lra).
      unfold slope, c2, c1; lra.
    + lra.
Qed.

Section Upright.

Variables alpha gamma b d x y z : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d).

Let p := upright alpha gamma b d x y z.
Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let P := (x ^ 2 + y ^ 2) / b ^ 2.
Let Q := (z / d) ^ 2.

Let HA : 0 < A := A_pos alpha b Ha Hb.
Let HB : 0 < B := B_pos gamma d Hg Hd.
Let V : valid p := upright_valid alpha gamma b d x y z Ha Hg Hb Hd.

(** The nearest point in the user's coordinates. *)
Lemma upright_nearest : exists t Y, - A <= t <= B /\ on_hyperboloid p Y /\ (forall X, depth p Y <= pencil p t X)
  /\ (0 < height p (centre p) -> 0 < t) /\ (height p (centre p) < 0 -> t < 0)
  /\ (height p (centre p) = 0 -> depth p Y = -1)
  /\ (depth p Y = 0 -> g A B P Q t = 0 /\ slope A B P Q t = 0 /\ ~ (t = B /\ - c2 A B P Q - 2 * t < B)).
Proof.
  destruct (nearest_exists A A B (x / b) (y / b) (z / d) HA HA HB) as (t & Y1 & Y2 & Y3 & N & S1 & S2 & S3).
  pose proof N as (T1 & T2 & T3 & W & E1 & E2 & E3).
  assert (HH : forall X, height p X = wall A A B (px X / b) (py X / b) (pz X / d))
    by (intros; apply height_is_wall; assumption).
  assert (HD : forall X, depth p X = ball (x / b) (y / b) (z / d) (px X / b) (py X / b) (pz X / d))
    by (intros; apply depth_is_ball; assumption).
  set (Y := Point (Y1 * b) (Y2 * b) (Y3 * d)); exists t, Y.
  assert (DY : depth p Y = ball (x / b) (y / b) (z / d) Y1 Y2 Y3).
  { rewrite HD; unfold Y; simpl; f_equal; field; lra. }
  assert (HY : height p Y = 0) by (rewrite HH, <- W; unfold Y; simpl; f_equal; field; lra).
  repeat split; try assumption.
  - intros X; unfold pencil; rewrite DY, HD, HH, <- (Rplus_0_r (ball _ _ _ Y1 Y2 Y3)), <- (Rmult_0_r t), <- W.
    apply pencil_above; assumption.
  - rewrite HH; assumption.
  - rewrite HH; assumption.
  - rewrite HH; intros E; destruct (S3 E) as (-> & -> & ->); rewrite DY; unfold ball; ring.
  - rewrite DY in H; unfold P, Q; rewrite (P_scaled b x y Hb).
    apply (touching_gives_double_root A B (x / b) (y / b) (z / d) t Y1 Y2 Y3 HA HB N H).
  - rewrite DY in H; unfold P, Q; rewrite (P_scaled b x y Hb).
    apply (touching_gives_double_root A B (x / b) (y / b) (z / d) t Y1 Y2 Y3 HA HB N H).
  - rewrite DY in H; unfold P, Q; rewrite (P_scaled b x y Hb).
    apply (touching_gives_double_root A B (x / b) (y / b) (z / d) t Y1 Y2 Y3 HA HB N H).
Qed.

Lemma pencil_gives_g l : - A < l -> l < B -> (forall X, 0 < pencil p l X) -> 0 < g A B P Q l.
Proof.
  intros L U H; unfold P, Q; rewrite (P_scaled b x y Hb); apply g_positive_means; try assumption.
  intros X1 X2 X3; specialize (H (Point (X1 * b) (X2 * b) (X3 * d))).
  unfold p in H; rewrite pencil_is in H by assumption; simpl in H; fold A B in H.
  replace (X1 * b / b) with X1 in H by (field; lra); replace (X2 * b / b) with X2 in H by (field; lra);
  replace (X3 * d / d) with X3 in H by (field; lra); assumption.
Qed.

Theorem exterior_has_rational_multiplier : exterior p -> exists q, 0 < Q2R q < B /\ 0 < g A B P Q (Q2R q).
Proof.
  intros E; destruct upright_nearest as (t & Y & [T1 T2] & HY & HP & S1 & _).
  assert (T : 0 < t) by (apply S1, E, centre_in).
  assert (D : 0 < depth p Y) by (apply Rnot_le_lt; intro D; specialize (E Y D); unfold on_hyperboloid in HY; lra).
  destruct (rational_multiplier p t (depth p Y) V) as (q & [Q1 Q2] & PP); try assumption; [lra |].
  assert (0 < Q2R q / t * t) by (apply Rmult_lt_0_compat; assumption).
  assert (Q2R q / t * t < 1 * t) by (apply Rmult_lt_compat_r; assumption).
  replace (Q2R q / t * t) with (Q2R q) in * by (field; lra).
  exists q; split; [lra |]; apply pencil_gives_g; [lra | lra |]; intros X; apply pencil_positive; assumption.
Qed.

Theorem interior_has_rational_multiplier : interior p -> exists q, - A < Q2R q < 0 /\ 0 < g A B P Q (Q2R q).
Proof.
  intros I; destruct upright_nearest as (t & Y & [T1 T2] & HY & HP & _ & S2 & _).
  assert (T : t < 0) by (apply S2, I, centre_in).
  assert (D : 0 < depth p Y) by (apply Rnot_le_lt; intro D; specialize (I Y D); unfold on_hyperboloid in HY; lra).
  destruct (rational_multiplier p t (depth p Y) V) as (q & [Q1 Q2] & PP); try assumption; [lra |].
  assert (0 < Q2R q / t * - t) by (apply Rmult_lt_0_compat; lra).
  assert (Q2R q / t * - t < 1 * - t) by (apply Rmult_lt_compat_r; lra).
  replace (Q2R q / t * - t) with (- Q2R q) in * by (field; lra).
  exists q; split; [lra |]; apply pencil_gives_g; [lra | lra |]; intros X; apply pencil_positive; assumption.
Qed.

Theorem contact_has_certificate : contact p ->
  (exists X Y, rational_point X /\ rational_point Y /\ in_spheroid p X /\ in_spheroid p Y
               /\ height p X < 0 < height p Y)
  \/ (exists m, m <> 0 /\ - A <= m <= B /\ g A B P Q m = 0 /\ slope A B P Q m = 0
                /\ ~ (m = B /\ - c2 A B P Q - 2 * m < B)).
Proof.
  intros (Z & S & H); destruct upright_nearest as (t & Y & T & HY & HP & S1 & S2 & S3 & R).
  assert (D : depth p Y <= 0).
  { specialize (HP Z); unfold pencil, on_spheroid, on_hyperboloid in *; rewrite S, H in HP; lra. }
  destruct D as [D | D].
  - left; destruct (both_sides p Y D HY (-1)) as (X1 & R1 & D1 & H1); [lra |].
    destruct (both_sides p Y D HY 1) as (X2 & R2 & D2 & H2); [lra |].
    exists X1, X2; unfold in_spheroid; repeat split; try assumption; lra.
  - right; exists t; destruct (R D) as (G & K & N); repeat split; try assumption; try apply T.
    intro Z0; subst t; rewrite g_at_0 in G; assert (0 < A * B) by (apply Rmult_lt_0_compat; assumption); lra.
Qed.

(** ** The rule of docs/mathematics.md, for all sizes. *)

Theorem exterior_rule : exterior p <-> exists l, 0 < l < B /\ 0 < g A B P Q l.
Proof.
  split; [intros E; destruct (exterior_has_rational_multiplier E) as [q K]; exists (Q2R q); exact K |].
  intros (l & [L U] & G); exact (exterior_by_g alpha gamma b d x y z Ha Hg Hb Hd l L U G).
Qed.

Theorem interior_rule : interior p <-> exists l, - A < l < 0 /\ 0 < g A B P Q l.
Proof.
  split; [intros I; destruct (interior_has_rational_multiplier I) as [q K]; exists (Q2R q); exact K |].
  intros (l & [L U] & G); exact (interior_by_g alpha gamma b d x y z Ha Hg Hb Hd l L U G).
Qed.

Theorem contact_rule : contact p <-> ~ (exists l, - A < l < B /\ 0 < g A B P Q l).
Proof.
  destruct (positions_exclude_each_other p) as (X1 & X2 & _); split.
  - intros C (l & [L U] & G); destruct (Rtotal_order l 0) as [K | [K | K]].
    + apply X2; split; [apply interior_rule; exists l; repeat split; assumption | assumption].
    + subst l; rewrite g_at_0 in G; assert (0 < A * B) by (apply Rmult_lt_0_compat; assumption); lra.
    + apply X1; split; [apply exterior_rule; exists l; repeat split; assumption | assumption].
  - intros N; destruct (one_position_holds p V) as [E | [C | I]]; [exfalso | assumption | exfalso]; apply N.
    + apply exterior_rule in E; destruct E as (l & [L U] & G); exists l; repeat split; try assumption; lra.
    + apply interior_rule in I; destruct I as (l & [L U] & G); exists l; repeat split; try assumption; lra.
Qed.

End Upright.

(** ** The double root is rational where the coefficients are: this is its formula. *)

Lemma double_root_formula b2 b1 b0 m : m ^ 3 + b2 * m ^ 2 + b1 * m + b0 = 0 -> 3 * m ^ 2 + 2 * b2 * m + b1 = 0 ->
  2 * (b2 ^ 2 - 3 * b1) * m = 9 * b0 - b1 * b2 /\ (b2 ^ 2 - 3 * b1 = 0 -> m = - b2 / 3).
Proof.
  intros G S; split.
  - apply Rminus_diag_uniq.
    transitivity ((3 * m + b2) * (3 * m ^ 2 + 2 * b2 * m + b1) - 9 * (m ^ 3 + b2 * m ^ 2 + b1 * m + b0) + 0); [ring |].
    rewrite G, S; ring.
  - intros H; assert (E : (3 * m + b2) ^ 2 = 0).
    { transitivity (3 * (3 * m ^ 2 + 2 * b2 * m + b1) + (b2 ^ 2 - 3 * b1)); [ring | rewrite S, H; ring]. }
    assert (3 * m + b2 = 0) by (apply Rsqr_0_uniq; rewrite Rsqr_pow2; assumption); lra.
Qed.
