(** What is enough to prove a position, for any axis of the spheroid.

    The pencil of a pair is depth + lambda height. One lambda at which it is positive everywhere proves that the
    spheroid is clear; two points prove contact. Positivity is read from the pivots of a symmetric 4 x 4 matrix. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry.
Open Scope R_scope.

Definition pencil (p : pair) (lambda : R) (X : point) := depth p X + lambda * height p X.

(** ** A multiplier proves exterior and interior. *)

Theorem exterior_by_multiplier p lambda : 0 < lambda -> (forall X, 0 < pencil p lambda X) -> exterior p.
Proof.
  intros L H X HX; specialize (H X); unfold in_spheroid, pencil in *.
  apply Rmult_lt_reg_l with lambda; lra.
Qed.

Theorem interior_by_multiplier p lambda : lambda < 0 -> (forall X, 0 < pencil p lambda X) -> interior p.
Proof.
  intros L H X HX; specialize (H X); unfold in_spheroid, pencil in *.
  apply Rmult_lt_reg_l with (- lambda); lra.
Qed.

(** ** Two points of the solid spheroid, not on one side of the hyperboloid, prove contact of the two surfaces. *)

Theorem contact_by_points p X Y : valid p -> in_spheroid p X -> in_spheroid p Y ->
  height p X * height p Y <= 0 -> contact p.
Proof.
  intros V HX HY S; destruct (solid_meets p X Y V HX HY S) as (Z & HZ & E).
  exact (solid_contact p Z V HZ E).
Qed.

(** ** A line on which the pencil vanishes proves contact; if the pencil is nowhere negative, it is a tangency.

    At a double root of the pencil that is no pole the line shrinks to one rational point; at a pole the touching
    points may be irrational, and the line through them is rational. *)

Theorem contact_by_line p m X u : valid p -> m <> 0 -> in_spheroid p X -> 0 < dot u u ->
  (forall t, pencil p m (add X (scale t u)) = 0) -> contact p.
Proof.
  intros V M HX U L; destruct (line_meets_spheroid p X u V HX U) as [t T].
  exists (add X (scale t u)); split; [assumption |].
  specialize (L t); unfold pencil, on_spheroid, on_hyperboloid in *; rewrite T in L.
  apply Rmult_eq_reg_l with m; lra.
Qed.

Theorem tangent_outside_by_multiplier p m : 0 < m -> (forall X, 0 <= pencil p m X) -> contact p -> tangent_outside p.
Proof.
  intros M H C; split; [assumption |]; intros X HX; specialize (H X); unfold in_spheroid, pencil in *.
  apply Rmult_le_reg_l with m; lra.
Qed.

Theorem tangent_inside_by_multiplier p m : m < 0 -> (forall X, 0 <= pencil p m X) -> contact p -> tangent_inside p.
Proof.
  intros M H C; split; [assumption |]; intros X HX; specialize (H X); unfold in_spheroid, pencil in *.
  apply Rmult_le_reg_l with (- m); lra.
Qed.

(** ** Positivity by pivots. The names of the entries are their places; only the upper triangle is given. *)

Definition positive1 e11 := 0 < e11.
Definition positive2 e11 e12 e22 := 0 < e11 /\ positive1 (e22 - e12 * e12 / e11).
Definition positive3 e11 e12 e13 e22 e23 e33 :=
  0 < e11 /\ positive2 (e22 - e12 * e12 / e11) (e23 - e12 * e13 / e11) (e33 - e13 * e13 / e11).
Definition positive4 e11 e12 e13 e14 e22 e23 e24 e33 e34 e44 :=
  0 < e11 /\ positive3 (e22 - e12 * e12 / e11) (e23 - e12 * e13 / e11) (e24 - e12 * e14 / e11)
                       (e33 - e13 * e13 / e11) (e34 - e13 * e14 / e11) (e44 - e14 * e14 / e11).

Lemma positive1_form e x : positive1 e -> 0 <= e * x ^ 2.
Proof. intros H; apply Rmult_le_pos; [left; assumption | apply pow2_ge_0]. Qed.

Lemma positive2_form e11 e12 e22 x y : positive2 e11 e12 e22 -> 0 <= e11 * x ^ 2 + 2 * e12 * x * y + e22 * y ^ 2.
Proof.
  intros [H P]; pose proof (positive1_form _ y P); pose proof (positive1_form e11 (x + e12 * y / e11) H).
  replace (e11 * x ^ 2 + 2 * e12 * x * y + e22 * y ^ 2)
    with (e11 * (x + e12 * y / e11) ^ 2 + (e22 - e12 * e12 / e11) * y ^ 2) by (field; lra).
  lra.
Qed.

(** The last coordinate of a point is 1, so the last pivot is positive by itself. *)

Lemma positive2_at_1 e11 e12 e22 x : positive2 e11 e12 e22 -> 0 < e11 * x ^ 2 + 2 * e12 * x + e22.
Proof.
  intros [H P]; pose proof (positive1_form e11 (x + e12 / e11) H); unfold positive1 in P.
  replace (e11 * x ^ 2 + 2 * e12 * x + e22)
    with (e11 * (x + e12 / e11) ^ 2 + (e22 - e12 * e12 / e11)) by (field; lra).
  lra.
Qed.

Lemma positive3_at_1 e11 e12 e13 e22 e23 e33 x y : positive3 e11 e12 e13 e22 e23 e33 ->
  0 < e11 * x ^ 2 + 2 * e12 * x * y + 2 * e13 * x + e22 * y ^ 2 + 2 * e23 * y + e33.
Proof.
  intros [H P]; pose proof (positive2_at_1 _ _ _ y P); pose proof (positive1_form e11 (x + (e12 * y + e13) / e11) H).
  match goal with |- 0 < ?f => replace f with (e11 * (x + (e12 * y + e13) / e11) ^ 2
    + ((e22 - e12 * e12 / e11) * y ^ 2 + 2 * (e23 - e12 * e13 / e11) * y + (e33 - e13 * e13 / e11))) by (field; lra) end.
  lra.
Qed.

Lemma positive4_at_1 e11 e12 e13 e14 e22 e23 e24 e33 e34 e44 x y z :
  positive4 e11 e12 e13 e14 e22 e23 e24 e33 e34 e44 ->
  0 < e11 * x ^ 2 + 2 * e12 * x * y + 2 * e13 * x * z + 2 * e14 * x + e22 * y ^ 2 + 2 * e23 * y * z + 2 * e24 * y
      + e33 * z ^ 2 + 2 * e34 * z + e44.
Proof.
  intros [H P]; pose proof (positive3_at_1 _ _ _ _ _ _ y z P).
  pose proof (positive1_form e11 (x + (e12 * y + e13 * z + e14) / e11) H).
  match goal with |- 0 < ?f => replace f with (e11 * (x + (e12 * y + e13 * z + e14) / e11) ^ 2
    + ((e22 - e12 * e12 / e11) * y ^ 2 + 2 * (e23 - e12 * e13 / e11) * y * z + 2 * (e24 - e12 * e14 / e11) * y
       + (e33 - e13 * e13 / e11) * z ^ 2 + 2 * (e34 - e13 * e14 / e11) * z + (e44 - e14 * e14 / e11))) by (field; lra) end.
  lra.
Qed.

(** The matrix of the norm: I/b^2 + (1/d^2 - 1/b^2) v v^T / (v.v). *)
Definition entry (p : pair) (i j : point -> R) (same : R) :=
  same / b p ^ 2 + (1 / d p ^ 2 - 1 / b p ^ 2) * i (axis p) * j (axis p) / dot (axis p) (axis p).

(** The matrix of the pencil, S + lambda H, by its entries, has positive pivots. *)
Definition positive_pencil (p : pair) (lambda : R) :=
  let xx := entry p px px 1 in let xy := entry p px py 0 in let xz := entry p px pz 0 in
  let yy := entry p py py 1 in let yz := entry p py pz 0 in let zz := entry p pz pz 1 in
  let C := centre p in
  let x1 := xx * px C + xy * py C + xz * pz C in
  let y1 := xy * px C + yy * py C + yz * pz C in
  let z1 := xz * px C + yz * py C + zz * pz C in
  positive4 (xx + lambda / alpha p ^ 2) xy xz (- x1) (yy + lambda / alpha p ^ 2) yz (- y1)
            (zz - lambda / gamma p ^ 2) (- z1) (px C * x1 + py C * y1 + pz C * z1 - 1 - lambda).

Theorem pencil_positive p lambda X : valid p -> positive_pencil p lambda -> 0 < pencil p lambda X.
Proof.
  intros (Ha & Hg & Hb & Hd & Hv) P; pose proof (positive4_at_1 _ _ _ _ _ _ _ _ _ _ (px X) (py X) (pz X) P) as H.
  match goal with H : 0 < ?f |- _ => replace (pencil p lambda X) with f; [exact H |] end.
  clear H P; unfold pencil, depth, height, norm2, along, entry.
  assert (dot (axis p) (axis p) <> 0) by lra; clear Hv; generalize dependent (dot (axis p) (axis p)); intros n Hn.
  unfold dot, sub; simpl; field; lra.
Qed.

Theorem exterior_by_pivots p lambda : valid p -> 0 < lambda -> positive_pencil p lambda -> exterior p.
Proof. intros V L P; apply exterior_by_multiplier with lambda; [| intros; apply pencil_positive]; assumption. Qed.

Theorem interior_by_pivots p lambda : valid p -> lambda < 0 -> positive_pencil p lambda -> interior p.
Proof. intros V L P; apply interior_by_multiplier with lambda; [| intros; apply pencil_positive]; assumption. Qed.
