(** Every pair, whatever the axis of its spheroid, has exactly one of the three positions, and a multiplier that
    proves it where it is clear.

    A linear change of coordinates turns the spheroid into the unit ball and leaves the hyperboloid without mixed
    terms: turn about z until the axis lies in a plane with z, divide by the semi-axes, turn in that plane. *)

Require Import Reals Lra QArith Qreals.
From Hypcheck Require Import Geometry Certificates UnitBall Duality.
Open Scope R_scope.

(** ** The eigenvectors of a symmetric 2 x 2 matrix with one positive and one negative eigenvalue. *)

Lemma eigenvectors p q r : p * r - q ^ 2 < 0 -> exists k l mu nu, k ^ 2 + l ^ 2 = 1 /\ 0 < mu /\ 0 < nu
  /\ p = mu * k ^ 2 - nu * l ^ 2 /\ q = (mu + nu) * (k * l) /\ r = mu * l ^ 2 - nu * k ^ 2.
Proof.
  intros D; set (delta := sqrt (((p - r) / 2) ^ 2 + q ^ 2)).
  assert (D2 : delta ^ 2 = ((p - r) / 2) ^ 2 + q ^ 2).
  { apply sq_sqrt; apply Rplus_le_le_0_compat; apply pow2_ge_0. }
  assert (D0 : 0 <= delta) by apply sqrt_pos.
  assert (D1 : ((p + r) / 2) ^ 2 < delta ^ 2) by (rewrite D2; lra).
  assert (Dp : Rabs ((p + r) / 2) < Rabs delta) by (apply Rsqr_lt_abs_0; rewrite !Rsqr_pow2; assumption).
  rewrite (Rabs_pos_eq delta D0) in Dp; apply Rabs_def2 in Dp.
  assert (Dm : Rabs ((p - r) / 2) <= Rabs delta).
  { apply Rsqr_le_abs_0; rewrite !Rsqr_pow2, D2; pose proof (pow2_ge_0 q); lra. }
  rewrite (Rabs_pos_eq delta D0) in Dm; pose proof (Rle_abs ((p - r) / 2)); pose proof (Rle_abs (- ((p - r) / 2))) as Dn; rewrite Rabs_Ropp in Dn.
  set (mu := (p + r) / 2 + delta); set (nu := delta - (p + r) / 2).
  assert (Hmu : 0 < mu) by (unfold mu; lra); assert (Hnu : 0 < nu) by (unfold nu; lra).
  set (K := (p + nu) / (mu + nu)); set (L := (r + nu) / (mu + nu)).
  assert (HK : 0 <= K) by (apply over_pos; unfold mu, nu in *; lra).
  assert (HL : 0 <= L) by (apply over_pos; unfold mu, nu in *; lra).
  assert (KL : K * L = (q / (mu + nu)) ^ 2).
  { unfold K, L; transitivity ((p + nu) * (r + nu) / (mu + nu) ^ 2); [field; lra |].
    replace ((p + nu) * (r + nu)) with (q ^ 2); [field; lra |].
    unfold nu; replace (q ^ 2) with (delta ^ 2 - ((p - r) / 2) ^ 2) by lra; field. }
  assert (SK := sq_sqrt K HK); assert (SL := sq_sqrt L HL).
  assert (E1 : K + L = 1) by (unfold K, L, mu, nu; field; unfold mu, nu in *; lra).
  assert (E2 : p = mu * K - nu * L) by (unfold K, L, mu, nu; field; unfold mu, nu in *; lra).
  assert (E3 : r = mu * L - nu * K) by (unfold K, L, mu, nu; field; unfold mu, nu in *; lra).
  assert (M : sqrt K * sqrt L = Rabs (q / (mu + nu))).
  { rewrite <- sqrt_mult, KL, <- Rsqr_pow2, sqrt_Rsqr_abs by assumption; reflexivity. }
  destruct (Rle_lt_dec 0 q) as [Q | Q].
  - exists (sqrt K), (sqrt L), mu, nu; rewrite SK, SL; repeat split; try assumption.
    rewrite M, Rabs_pos_eq by (apply over_pos; lra); field; lra.
  - exists (sqrt K), (- sqrt L), mu, nu; rewrite SK, <- Rsqr_pow2, <- Rsqr_neg, Rsqr_pow2, SL.
    repeat split; try assumption.
    replace (sqrt K * - sqrt L) with (- (sqrt K * sqrt L)) by ring.
    rewrite M, Rabs_left; [field; lra |]; unfold Rdiv; rewrite Rmult_comm, <- (Rmult_0_r (/ (mu + nu))).
    apply Rmult_lt_compat_l; [apply Rinv_0_lt_compat; lra | assumption].
Qed.

(** A vector other than 0 by its length, its azimuth (m1, m2) and its tilt (s, c). *)
Lemma polar v : 0 < dot v v -> exists n m1 m2 s c, 0 < n /\ m1 ^ 2 + m2 ^ 2 = 1 /\ s ^ 2 + c ^ 2 = 1
  /\ px v = n * m1 * s /\ py v = n * m2 * s /\ pz v = n * c.
Proof.
  intros H; set (h2 := px v ^ 2 + py v ^ 2).
  assert (Hh : 0 <= h2) by (apply Rplus_le_le_0_compat; apply pow2_ge_0).
  set (n := sqrt (dot v v)); assert (Hn : 0 < n) by (apply sqrt_lt_R0; assumption).
  assert (Sn : n ^ 2 = dot v v) by (apply sq_sqrt; lra).
  set (h := sqrt h2); assert (Sh : h ^ 2 = h2) by (apply sq_sqrt; assumption).
  assert (U : (h / n) ^ 2 + (pz v / n) ^ 2 = 1).
  { transitivity ((h ^ 2 + pz v ^ 2) / n ^ 2); [field; lra |].
    rewrite Sh, Sn; unfold h2, dot in *; field; lra. }
  destruct (Req_dec h 0) as [Z | Z].
  - assert (h2 = 0) by (rewrite <- Sh, Z; ring).
    assert (px v = 0 /\ py v = 0) as [X Y] by (unfold h2 in *; split; nra).
    exists n, 1, 0, (h / n), (pz v / n); repeat split; try assumption; try ring.
    + rewrite X, Z; field; lra.
    + rewrite Y; ring.
    + field; lra.
  - exists n, (px v / h), (py v / h), (h / n), (pz v / n); repeat split; try assumption; try (field; lra).
    transitivity (h2 / h ^ 2); [unfold h2; field; assumption | rewrite Sh; field; rewrite <- Sh; apply pow_nonzero; assumption].
Qed.

(** ** Coordinates in which the spheroid is the unit ball and the hyperboloid has no mixed terms. *)

Definition diagonal p := exists A1 A2 B x y z (f1 f2 f3 : point -> R) (back : R -> R -> R -> point),
  0 < A1 /\ 0 < A2 /\ 0 < B
  /\ (forall X, depth p X = ball x y z (f1 X) (f2 X) (f3 X))
  /\ (forall X, height p X = wall A1 A2 B (f1 X) (f2 X) (f3 X))
  /\ (forall Y1 Y2 Y3, f1 (back Y1 Y2 Y3) = Y1 /\ f2 (back Y1 Y2 Y3) = Y2 /\ f3 (back Y1 Y2 Y3) = Y3)
  /\ f1 (centre p) = x /\ f2 (centre p) = y /\ f3 (centre p) = z.

Theorem diagonalisable p : valid p -> diagonal p.
Proof.
  intros (Ha & Hg & Hb & Hd & Hv).
  destruct (polar (axis p) Hv) as (n & m1 & m2 & s & c & Hn & M & S & V1 & V2 & V3).
  set (al := alpha p) in *; set (ga := gamma p) in *; set (bb := b p) in *; set (dd := d p) in *.
  assert (N : dot (axis p) (axis p) = n ^ 2).
  { unfold dot; rewrite V1, V2, V3.
    transitivity (n ^ 2 * ((m1 ^ 2 + m2 ^ 2) * s ^ 2 + c ^ 2)); [ring | rewrite M, Rmult_1_l, S; ring]. }
  destruct (eigenvectors (bb ^ 2 * (c ^ 2 / al ^ 2 - s ^ 2 / ga ^ 2)) (bb * dd * (c * s / al ^ 2 + c * s / ga ^ 2))
                         (dd ^ 2 * (s ^ 2 / al ^ 2 - c ^ 2 / ga ^ 2)))
    as (k & l & mu & nu & KL & Hmu & Hnu & E1 & E2 & E3).
  { match goal with |- ?f < 0 => replace f with (- ((bb * dd / (al * ga)) ^ 2 * (s ^ 2 + c ^ 2) ^ 2)) by (field; lra) end.
    rewrite S, pow1, Rmult_1_r; assert (0 < (bb * dd / (al * ga)) ^ 2); [| lra].
    apply pow_lt2, over_lt; apply Rmult_lt_0_compat; assumption. }
  (* across the plane of the axes; in the plane, across and along the spheroid's axis; all in semi-axes *)
  set (w := fun X => (m1 * py X - m2 * px X) / bb).
  set (e := fun X => ((m1 * px X + m2 * py X) * c - pz X * s) / bb).
  set (f := fun X => ((m1 * px X + m2 * py X) * s + pz X * c) / dd).
  set (C := centre p).
  set (back := fun Y1 Y2 Y3 => let E := k * Y2 - l * Y3 in let F := l * Y2 + k * Y3 in
       let across := bb * c * E + dd * s * F in
       Point (m1 * across - m2 * bb * Y1) (m2 * across + m1 * bb * Y1) (dd * c * F - bb * s * E)).
  assert (Back : forall Y1 Y2 Y3, e (back Y1 Y2 Y3) = k * Y2 - l * Y3 /\ f (back Y1 Y2 Y3) = l * Y2 + k * Y3).
  { intros Y1 Y2 Y3; unfold e, f.
    assert (W : m1 * px (back Y1 Y2 Y3) + m2 * py (back Y1 Y2 Y3)
                = bb * c * (k * Y2 - l * Y3) + dd * s * (l * Y2 + k * Y3)).
    { unfold back; simpl.
      transitivity ((m1 ^ 2 + m2 ^ 2) * (bb * c * (k * Y2 - l * Y3) + dd * s * (l * Y2 + k * Y3)));
        [ring | rewrite M; ring]. }
    rewrite W; unfold back; simpl; split.
    - transitivity ((s ^ 2 + c ^ 2) * (k * Y2 - l * Y3)); [field; lra | rewrite S; ring].
    - transitivity ((s ^ 2 + c ^ 2) * (l * Y2 + k * Y3)); [field; lra | rewrite S; ring]. }
  exists (al ^ 2 / bb ^ 2), (/ mu), (/ nu), (w C), (k * e C + l * f C), (- l * e C + k * f C),
    w, (fun X => k * e X + l * f X), (fun X => - l * e X + k * f X), back.
  repeat split; try (apply Rinv_0_lt_compat; assumption).
  - apply over_lt; apply pow_lt2; assumption.
  - (* the spheroid *)
    intros X; unfold depth, norm2, along; rewrite N.
    set (U := sub X C).
    assert (D : dot U (axis p) ^ 2 / n ^ 2 = (f X - f C) ^ 2 * dd ^ 2).
    { unfold dot; rewrite V1, V2, V3; unfold f, U, sub; simpl; field; lra. }
    assert (T : dot U U = (w X - w C) ^ 2 * bb ^ 2 + (e X - e C) ^ 2 * bb ^ 2 + (f X - f C) ^ 2 * dd ^ 2).
    { transitivity ((m1 ^ 2 + m2 ^ 2) * (px U ^ 2 + py U ^ 2) + pz U ^ 2); [rewrite M; unfold dot; ring |].
      transitivity ((m1 * py U - m2 * px U) ^ 2 + ((m1 * px U + m2 * py U) ^ 2 + pz U ^ 2) * (s ^ 2 + c ^ 2));
        [rewrite S; ring |].
      unfold w, e, f, U, sub; simpl; field; lra. }
    fold C; fold U; rewrite T, D; fold bb; fold dd; unfold ball.
    transitivity ((w X - w C) ^ 2 + (k ^ 2 + l ^ 2) * ((e X - e C) ^ 2 + (f X - f C) ^ 2) - 1);
      [rewrite KL; field; lra | ring].
  - (* the hyperboloid *)
    intros X; unfold height, wall; fold al; fold ga.
    transitivity (w X ^ 2 / (al ^ 2 / bb ^ 2) + ((mu * k ^ 2 - nu * l ^ 2) * e X ^ 2
       + 2 * ((mu + nu) * (k * l)) * e X * f X + (mu * l ^ 2 - nu * k ^ 2) * f X ^ 2) - 1).
    + rewrite <- E1, <- E2, <- E3.
      transitivity (((m1 ^ 2 + m2 ^ 2) * (px X ^ 2 + py X ^ 2)) / al ^ 2 - pz X ^ 2 / ga ^ 2 - 1);
        [rewrite M; field; lra |].
      transitivity ((m1 * py X - m2 * px X) ^ 2 / al ^ 2 + (m1 * px X + m2 * py X) ^ 2 * (s ^ 2 + c ^ 2) ^ 2 / al ^ 2
                    - pz X ^ 2 * (s ^ 2 + c ^ 2) ^ 2 / ga ^ 2 - 1); [rewrite S; field; lra |].
      unfold w, e, f; field; lra.
    + field; lra.
  - unfold w; simpl; match goal with |- ?u = _ => transitivity ((m1 ^ 2 + m2 ^ 2) * Y1); [field; lra | rewrite M; ring] end.
  - destruct (Back Y1 Y2 Y3) as [-> ->].
    transitivity ((k ^ 2 + l ^ 2) * Y2); [ring | rewrite KL; ring].
  - destruct (Back Y1 Y2 Y3) as [-> ->].
    transitivity ((k ^ 2 + l ^ 2) * Y3); [ring | rewrite KL; ring].
Qed.

(** ** Duality for every pair: a nearest point of the hyperboloid and its multiplier. *)

Theorem duality p : valid p -> exists t Y, on_hyperboloid p Y /\ (forall X, depth p Y <= pencil p t X)
  /\ (0 < height p (centre p) -> 0 < t) /\ (height p (centre p) < 0 -> t < 0)
  /\ (height p (centre p) = 0 -> depth p Y = -1).
Proof.
  intros V; destruct (diagonalisable p V)
    as (A1 & A2 & B & x & y & z & f1 & f2 & f3 & back & H1 & H2 & H3 & HD & HH & HB & <- & <- & <-).
  destruct (nearest_exists A1 A2 B (f1 (centre p)) (f2 (centre p)) (f3 (centre p)) H1 H2 H3)
    as (t & Y1 & Y2 & Y3 & (T1 & T2 & T3 & W & E1 & E2 & E3) & S1 & S2 & S3).
  destruct (HB Y1 Y2 Y3) as (B1 & B2 & B3); exists t, (back Y1 Y2 Y3).
  assert (HY : height p (back Y1 Y2 Y3) = 0) by (rewrite HH, B1, B2, B3; assumption).
  assert (DY : depth p (back Y1 Y2 Y3) = ball (f1 (centre p)) (f2 (centre p)) (f3 (centre p)) Y1 Y2 Y3)
    by (rewrite HD, B1, B2, B3; reflexivity).
  repeat split; try assumption.
  - intros X; unfold pencil; rewrite DY, HD, HH; rewrite <- (Rplus_0_r (ball _ _ _ Y1 Y2 Y3)), <- (Rmult_0_r t), <- W.
    apply pencil_above; assumption.
  - rewrite HH; assumption.
  - rewrite HH; assumption.
  - rewrite HH; intros E; destruct (S3 E) as (-> & -> & ->); rewrite DY, <- HD; apply depth_centre.
Qed.

Corollary clear_by_duality p t Y : (forall X, depth p Y <= pencil p t X) -> 0 < depth p Y ->
  (0 < t -> exterior p) /\ (t < 0 -> interior p).
Proof.
  intros H D; assert (N : forall X, 0 < pencil p t X) by (intros X; specialize (H X); lra).
  split; intros; [apply exterior_by_multiplier with t | apply interior_by_multiplier with t]; assumption.
Qed.

(** ** Exactly one of the three positions holds. *)

Theorem one_position_holds p : valid p -> exterior p \/ contact p \/ interior p.
Proof.
  intros V; destruct (duality p V) as (t & Y & HY & HP & S1 & S2 & S3).
  destruct (Rle_lt_dec (depth p Y) 0) as [D | D]; [right; left; exact (solid_contact p Y V D HY) |].
  destruct (clear_by_duality p t Y HP D) as [E I].
  destruct (Rtotal_order (height p (centre p)) 0) as [W | [W | W]]; [right; right; auto | | left; auto].
  specialize (S3 W); lra.
Qed.

(** ** Where a pair is clear, a rational multiplier proves it, by pivots. *)

Lemma rational_between x y : x < y -> exists q, x < Q2R q < y.
Proof.
  intros H; assert (W : 0 < / (y - x)) by (apply Rinv_0_lt_compat; lra).
  destruct (archimed (/ (y - x))) as [N _]; set (n := up (/ (y - x))) in *.
  assert (Pn : (0 < n)%Z) by (apply lt_IZR; lra).
  destruct (archimed (x * IZR n)) as [M1 M2]; set (m := up (x * IZR n)) in *.
  assert (Rn : 0 < IZR n) by (apply IZR_lt; assumption).
  assert (K : 1 < (y - x) * IZR n).
  { replace 1 with ((y - x) * / (y - x)) by (field; lra). apply Rmult_lt_compat_l; lra. }
  exists (m # Z.to_pos n)%Q; unfold Q2R; simpl; rewrite Z2Pos.id by assumption.
  split; apply Rmult_lt_reg_r with (IZR n); try assumption; rewrite Rmult_assoc, Rinv_l, Rmult_1_r; lra.
Qed.

Lemma leading_coefficient a l c : (forall s, 0 <= a * s ^ 2 + l * s + c) -> 0 <= a.
Proof.
  intros H; apply Rnot_lt_le; intro N; pose proof (H 0) as C.
  set (s := sqrt ((c + 1) / - a)).
  assert (S : s ^ 2 = (c + 1) / - a) by (apply sq_sqrt, over_pos; lra).
  pose proof (H s) as U; pose proof (H (- s)) as D.
  replace ((- s) ^ 2) with (s ^ 2) in D by ring; rewrite S in U, D.
  replace (a * ((c + 1) / - a)) with (- (c + 1)) in U, D by (field; lra); lra.
Qed.

Section Converse.

Definition form2 e11 e12 e22 x y := e11 * x ^ 2 + 2 * e12 * x * y + e22 * y ^ 2.
Definition form3 e11 e12 e13 e22 e23 e33 x y z :=
  e11 * x ^ 2 + 2 * e12 * x * y + 2 * e13 * x * z + e22 * y ^ 2 + 2 * e23 * y * z + e33 * z ^ 2.
Definition form4 e11 e12 e13 e14 e22 e23 e24 e33 e34 e44 x y z w :=
  e11 * x ^ 2 + 2 * e12 * x * y + 2 * e13 * x * z + 2 * e14 * x * w + e22 * y ^ 2 + 2 * e23 * y * z + 2 * e24 * y * w
  + e33 * z ^ 2 + 2 * e34 * z * w + e44 * w ^ 2.

Lemma pivots2 e11 e12 e22 : (forall x y, x <> 0 \/ y <> 0 -> 0 < form2 e11 e12 e22 x y) -> positive2 e11 e12 e22.
Proof.
  unfold form2; intros H; assert (E : 0 < e11) by (specialize (H 1 0); lra).
  split; [assumption |]; unfold positive1; specialize (H (- e12 / e11) 1).
  replace (e22 - e12 * e12 / e11) with (e11 * (- e12 / e11) ^ 2 + 2 * e12 * (- e12 / e11) * 1 + e22 * 1 ^ 2)
    by (field; lra).
  apply H; right; lra.
Qed.

Lemma pivots3 e11 e12 e13 e22 e23 e33 :
  (forall x y z, x <> 0 \/ y <> 0 \/ z <> 0 -> 0 < form3 e11 e12 e13 e22 e23 e33 x y z) ->
  positive3 e11 e12 e13 e22 e23 e33.
Proof.
  unfold form3; intros H; assert (E : 0 < e11) by (specialize (H 1 0 0); lra).
  split; [assumption |]; apply pivots2; intros y z N; unfold form2; specialize (H (- (e12 * y + e13 * z) / e11) y z).
  match type of H with _ -> 0 < ?f => match goal with |- 0 < ?h => replace h with f by (field; lra) end end.
  apply H; right; exact N.
Qed.

Lemma pivots4 e11 e12 e13 e14 e22 e23 e24 e33 e34 e44 :
  (forall x y z w, x <> 0 \/ y <> 0 \/ z <> 0 \/ w <> 0 ->
     0 < form4 e11 e12 e13 e14 e22 e23 e24 e33 e34 e44 x y z w) ->
  positive4 e11 e12 e13 e14 e22 e23 e24 e33 e34 e44.
Proof.
  unfold form4; intros H; assert (E : 0 < e11) by (specialize (H 1 0 0 0); lra).
  split; [assumption |]; apply pivots3; intros y z w N; unfold form3.
  specialize (H (- (e12 * y + e13 * z + e14 * w) / e11) y z w).
  match type of H with _ -> 0 < ?f => match goal with |- 0 < ?h => replace h with f by (field; lra) end end.
  apply H; right; exact N.
Qed.

End Converse.

(** If the pencil stays above a positive number and grows with the norm, its pivots are positive. *)
Lemma pivots_of_growth p lambda k eps : valid p -> 0 < k -> 0 < eps ->
  (forall X, k + eps * norm2 p (sub X (centre p)) <= pencil p lambda X) -> positive_pencil p lambda.
Proof.
  intros V K E H; pose proof V as (Ha & Hg & Hb & Hd & Hv).
  apply pivots4; intros x y z w N; destruct (Req_dec w 0) as [W | W].
  - (* no last coordinate: the quadratic part along (x, y, z) *)
    subst w; set (u := Point x y z).
    assert (U : 0 < dot u u).
    { unfold dot, u; simpl; pose proof (pow2_ge_0 x); pose proof (pow2_ge_0 y); pose proof (pow2_ge_0 z).
      destruct N as [N | [N | [N | N]]]; [| | | lra]; apply square_pos in N; lra. }
    set (quad := norm2 p u + lambda * (height p (add (Point 0 0 0) u) + 1)).
    assert (L : 0 <= quad - eps * norm2 p u).
    { apply leading_coefficient with
        (l := lambda * (2 * px (centre p) * x / alpha p ^ 2 + 2 * py (centre p) * y / alpha p ^ 2
                        - 2 * pz (centre p) * z / gamma p ^ 2))
        (c := -1 + lambda * height p (centre p) - k).
      intros s; specialize (H (add (centre p) (scale s u))).
      match goal with |- 0 <= ?f => replace f with (pencil p lambda (add (centre p) (scale s u))
        - (k + eps * norm2 p (sub (add (centre p) (scale s u)) (centre p)))) end; [lra |].
      clear H; unfold quad, pencil, depth, height, norm2, along.
      assert (dot (axis p) (axis p) <> 0) by lra; clear Hv V; generalize dependent (dot (axis p) (axis p)); intros n Hn.
      unfold dot, u, sub, add, scale; simpl; field; lra. }
    assert (0 < eps * norm2 p u) by (apply Rmult_lt_0_compat; [assumption | apply norm2_pos; assumption]).
    match goal with |- 0 < ?f => replace f with quad; [lra |] end.
    clear H L; unfold quad, height, norm2, along, form4, entry.
    assert (dot (axis p) (axis p) <> 0) by lra; clear Hv V; generalize dependent (dot (axis p) (axis p)); intros n Hn.
    unfold dot, u, add; simpl; field; lra.
  - (* a point, its coordinates multiplied by w *)
    set (X := Point (x / w) (y / w) (z / w)); specialize (H X); pose proof (norm2_ge_0 p (sub X (centre p)) V).
    assert (0 <= eps * norm2 p (sub X (centre p))) by (apply Rmult_le_pos; lra).
    match goal with |- 0 < ?f => replace f with (w ^ 2 * pencil p lambda X) end.
    { apply Rmult_lt_0_compat; [apply square_pos; assumption | lra]. }
    clear H H0 H1; unfold pencil, depth, height, norm2, along, form4, entry.
    assert (dot (axis p) (axis p) <> 0) by lra; clear Hv V N; generalize dependent (dot (axis p) (axis p)); intros n Hn.
    unfold dot, sub, X; simpl; field; lra.
Qed.

(** A little nearer to 0 than the multiplier of the nearest point, the pencil grows with the norm. *)
Lemma growth_nearer_to_0 p t m eps : (forall X, m <= pencil p t X) -> 0 <= eps <= 1 ->
  forall X, ((1 - eps) * m - eps) + eps * norm2 p (sub X (centre p)) <= pencil p ((1 - eps) * t) X.
Proof.
  intros H E X; specialize (H X).
  replace (pencil p ((1 - eps) * t) X) with ((1 - eps) * pencil p t X + eps * depth p X) by (unfold pencil; ring).
  unfold depth; assert ((1 - eps) * m <= (1 - eps) * pencil p t X) by (apply Rmult_le_compat_l; lra).
  lra.
Qed.

Lemma rational_multiplier p t m : valid p -> t <> 0 -> 0 < m -> (forall X, m <= pencil p t X) ->
  exists q, 0 < Q2R q / t < 1 /\ positive_pencil p (Q2R q).
Proof.
  intros V T M H; set (e := m / (1 + m)).
  assert (E : 0 < e < 1).
  { split; [apply over_lt; lra |]. apply Rmult_lt_reg_r with (1 + m); [lra |].
    unfold e, Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra. }
  assert (F : exists q, 1 - e < Q2R q / t < 1).
  { destruct (Rlt_le_dec 0 t) as [P | P].
    - destruct (rational_between ((1 - e) * t) t) as [q [Q1 Q2]]; [nra |]; exists q.
      split; apply Rmult_lt_reg_r with t; try assumption; unfold Rdiv; rewrite Rmult_assoc, Rinv_l; lra.
    - assert (N : t < 0) by lra; destruct (rational_between t ((1 - e) * t)) as [q [Q1 Q2]]; [nra |]; exists q.
      split; apply Rmult_lt_reg_r with (- t); try lra;
        replace (Q2R q / t * - t) with (- Q2R q) by (field; assumption); lra. }
  destruct F as [q [Q1 Q2]]; exists q; split; [lra |].
  set (eps := 1 - Q2R q / t); replace (Q2R q) with ((1 - eps) * t) by (unfold eps; field; assumption).
  apply pivots_of_growth with ((1 - eps) * m - eps) eps; try assumption; [| unfold eps; lra |].
  - assert (eps * (1 + m) < e * (1 + m)) by (apply Rmult_lt_compat_r; unfold eps; lra).
    replace (e * (1 + m)) with m in H0 by (unfold e; field; lra); lra.
  - apply growth_nearer_to_0; [assumption | unfold eps; lra].
Qed.

Theorem exterior_iff_rational_pivots p : valid p ->
  (exterior p <-> exists q, 0 < Q2R q /\ positive_pencil p (Q2R q)).
Proof.
  intros V; split; [| intros (q & L & P); apply exterior_by_pivots with (Q2R q); assumption].
  intros E; destruct (duality p V) as (t & Y & HY & HP & S1 & _).
  assert (T : 0 < t) by (apply S1, E, centre_in).
  assert (D : 0 < depth p Y) by (apply Rnot_le_lt; intro D; specialize (E Y D); unfold on_hyperboloid in HY; lra).
  destruct (rational_multiplier p t (depth p Y) V) as (q & [Q _] & P); try assumption; [lra |].
  exists q; split; [| assumption].
  replace (Q2R q) with (Q2R q / t * t) by (field; lra); apply Rmult_lt_0_compat; assumption.
Qed.

Theorem interior_iff_rational_pivots p : valid p ->
  (interior p <-> exists q, Q2R q < 0 /\ positive_pencil p (Q2R q)).
Proof.
  intros V; split; [| intros (q & L & P); apply interior_by_pivots with (Q2R q); assumption].
  intros I; destruct (duality p V) as (t & Y & HY & HP & _ & S2 & _).
  assert (T : t < 0) by (apply S2, I, centre_in).
  assert (D : 0 < depth p Y) by (apply Rnot_le_lt; intro D; specialize (I Y D); unfold on_hyperboloid in HY; lra).
  destruct (rational_multiplier p t (depth p Y) V) as (q & [Q _] & P); try assumption; [lra |].
  exists q; split; [| assumption].
  assert (0 < Q2R q / t * - t) by (apply Rmult_lt_0_compat; lra).
  replace (Q2R q / t * - t) with (- Q2R q) in H by (field; lra); lra.
Qed.
