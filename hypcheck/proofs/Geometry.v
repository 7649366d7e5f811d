(** What a hyperboloid, a spheroid and their relative position are, in the coordinates of the user.

    The hyperboloid of one sheet stands on the z axis and has the semi-axes alpha, alpha, gamma. The spheroid has the
    semi-axis d along any vector [axis] other than 0, and b across it. Positions are statements about points; nothing
    here knows of a pencil, a polynomial or a discriminant. *)

Require Import Reals Lra.
Open Scope R_scope.

Record point := Point { px : R; py : R; pz : R }.

Definition add (u v : point) := Point (px u + px v) (py u + py v) (pz u + pz v).
Definition sub (u v : point) := Point (px u - px v) (py u - py v) (pz u - pz v).
Definition scale (k : R) (u : point) := Point (k * px u) (k * py u) (k * pz u).
Definition dot (u v : point) := px u * px v + py u * py v + pz u * pz v.

Record pair := Pair { alpha : R; gamma : R; b : R; d : R; axis : point; centre : point }.

Definition valid (p : pair) := 0 < alpha p /\ 0 < gamma p /\ 0 < b p /\ 0 < d p /\ 0 < dot (axis p) (axis p).

(** Positive outside the hyperboloid, negative inside (where its axis is), 0 on it. *)
Definition height (p : pair) (X : point) :=
  px X ^ 2 / alpha p ^ 2 + py X ^ 2 / alpha p ^ 2 - pz X ^ 2 / gamma p ^ 2 - 1.

(** The squared length of [u] along the axis, and the square of the norm whose unit ball is the spheroid about 0. *)
Definition along (p : pair) (u : point) := dot u (axis p) ^ 2 / dot (axis p) (axis p).
Definition norm2 (p : pair) (u : point) := (dot u u - along p u) / b p ^ 2 + along p u / d p ^ 2.

(** Negative within the spheroid, 0 on it, positive outside. *)
Definition depth (p : pair) (X : point) := norm2 p (sub X (centre p)) - 1.

Definition on_hyperboloid p X := height p X = 0.
Definition on_spheroid p X := depth p X = 0.
Definition in_spheroid p X := depth p X <= 0.

Definition exterior p := forall X, in_spheroid p X -> 0 < height p X.
Definition interior p := forall X, in_spheroid p X -> height p X < 0.
Definition contact p := exists X, on_spheroid p X /\ on_hyperboloid p X.

(** A tangency: the surfaces share a point, and the solid spheroid stays on one side of the hyperboloid. *)
Definition tangent_outside p := contact p /\ forall X, in_spheroid p X -> 0 <= height p X.
Definition tangent_inside p := contact p /\ forall X, in_spheroid p X -> height p X <= 0.

(** An upright pair: the two axes are parallel. These are the seven numbers of the vectors. *)
Definition upright (alpha gamma b d x y z : R) := Pair alpha gamma b d (Point 0 0 1) (Point x y z).

Lemma point_eq u v : px u = px v -> py u = py v -> pz u = pz v -> u = v.
Proof. destruct u, v; simpl; intros; subst; reflexivity. Qed.

Lemma square_pos x : x <> 0 -> 0 < x ^ 2.
Proof. intros; rewrite <- Rsqr_pow2; apply Rsqr_pos_lt; assumption. Qed.

Lemma over_pos x y : 0 <= x -> 0 < y -> 0 <= x / y.
Proof. intros; unfold Rdiv; apply Rmult_le_pos; [|left; apply Rinv_0_lt_compat]; assumption. Qed.

Lemma over_lt x y : 0 < x -> 0 < y -> 0 < x / y.
Proof. intros; unfold Rdiv; apply Rmult_lt_0_compat; [|apply Rinv_0_lt_compat]; assumption. Qed.

Lemma pow_lt2 x : 0 < x -> 0 < x ^ 2.
Proof. intros; apply pow_lt; assumption. Qed.

(** ** The norm of the spheroid is positive definite, and the solid spheroid is convex. *)

Lemma dot_self u : 0 <= dot u u.
Proof. unfold dot; nra. Qed.

(** Lagrange's identity. *)
Lemma cauchy_schwarz u v : dot u v ^ 2 <= dot u u * dot v v.
Proof.
  replace (dot u u * dot v v) with (dot u v ^ 2 + ((px u * py v - py u * px v) ^ 2
    + (py u * pz v - pz u * py v) ^ 2 + (pz u * px v - px u * pz v) ^ 2)) by (unfold dot; ring).
  pose proof (pow2_ge_0 (px u * py v - py u * px v)); pose proof (pow2_ge_0 (py u * pz v - pz u * py v));
  pose proof (pow2_ge_0 (pz u * px v - px u * pz v)); lra.
Qed.

Lemma along_bounds p u : valid p -> 0 <= along p u <= dot u u.
Proof.
  intros (_ & _ & _ & _ & H); unfold along; split.
  - apply over_pos; [apply pow2_ge_0 | assumption].
  - apply Rmult_le_reg_r with (dot (axis p) (axis p)); [assumption |].
    unfold Rdiv; rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra. apply cauchy_schwarz.
Qed.

Lemma norm2_ge_0 p u : valid p -> 0 <= norm2 p u.
Proof.
  intros V; destruct (along_bounds p u V); destruct V as (_ & _ & Hb & Hd & _).
  apply Rplus_le_le_0_compat; apply over_pos; try lra; apply pow_lt2; assumption.
Qed.

Lemma norm2_pos p u : valid p -> 0 < dot u u -> 0 < norm2 p u.
Proof.
  intros V H; destruct (along_bounds p u V) as [[K | K] L]; destruct V as (_ & _ & Hb & Hd & _); unfold norm2.
  - apply Rplus_le_lt_0_compat; [apply over_pos | apply over_lt]; try lra; apply pow_lt2; assumption.
  - rewrite <- K; apply Rplus_lt_le_0_compat; [apply over_lt | apply over_pos]; try lra; apply pow_lt2; assumption.
Qed.

Lemma depth_centre p : depth p (centre p) = -1.
Proof. unfold depth, norm2, along, dot, sub, Rdiv; simpl; ring. Qed.

(** The point a part [t] of the way from X to Y. *)
Definition between (X Y : point) (t : R) := add X (scale t (sub Y X)).

Lemma depth_between p X Y t : valid p ->
  depth p (between X Y t) = (1 - t) * depth p X + t * depth p Y - t * (1 - t) * norm2 p (sub Y X).
Proof.
  intros (_ & _ & Hb & Hd & Hv); unfold depth, norm2, along, between.
  assert (dot (axis p) (axis p) <> 0) by lra; assert (b p <> 0) by lra; assert (d p <> 0) by lra.
  generalize dependent (dot (axis p) (axis p)); intros n Hn1 Hn2.
  unfold dot, sub, add, scale; simpl; field; auto.
Qed.

Lemma spheroid_convex p X Y t : valid p -> 0 <= t <= 1 ->
  in_spheroid p X -> in_spheroid p Y -> in_spheroid p (between X Y t).
Proof.
  unfold in_spheroid; intros V T HX HY; rewrite depth_between by assumption.
  pose proof (norm2_ge_0 p (sub Y X) V).
  assert (0 <= (1 - t) * - depth p X) by (apply Rmult_le_pos; lra).
  assert (0 <= t * - depth p Y) by (apply Rmult_le_pos; lra).
  assert (0 <= t * (1 - t) * norm2 p (sub Y X)) by (repeat apply Rmult_le_pos; lra).
  lra.
Qed.

(** ** Where a segment of the solid has its ends on two sides of the hyperboloid, the solid meets the hyperboloid. *)

Lemma segment_meets p X Y : height p X * height p Y <= 0 ->
  exists t, 0 <= t <= 1 /\ on_hyperboloid p (between X Y t).
Proof.
  intros H; set (f := fun t => height p (between X Y t)).
  assert (C : continuity f) by (unfold f, height, between, add, scale, sub, Rdiv; simpl; reg).
  destruct (IVT_cor f 0 1 C) as [t [T E]]; [lra | | exists t; split; assumption].
  replace (f 0) with (height p X) by (unfold f, height, between, add, scale, sub, Rdiv; simpl; ring).
  replace (f 1) with (height p Y) by (unfold f, height, between, add, scale, sub, Rdiv; simpl; ring).
  assumption.
Qed.

Lemma solid_meets p X Y : valid p -> in_spheroid p X -> in_spheroid p Y -> height p X * height p Y <= 0 ->
  exists Z, in_spheroid p Z /\ on_hyperboloid p Z.
Proof.
  intros V HX HY S; destruct (segment_meets p X Y S) as [t [T E]].
  exists (between X Y t); split; [apply spheroid_convex |]; assumption.
Qed.

(** ** Where the solid meets the hyperboloid the surfaces meet: follow a straight line that lies on the hyperboloid. *)

Lemma quadratic_root a k c : 0 < a -> c <= 0 -> exists t, a * t ^ 2 + k * t + c = 0.
Proof.
  intros Ha Hc; exists ((- k + sqrt (k ^ 2 - 4 * a * c)) / (2 * a)).
  assert (0 <= k ^ 2 - 4 * a * c) by (pose proof (pow2_ge_0 k); nra).
  pose proof (sqrt_sqrt _ H) as S; set (s := sqrt _) in *.
  apply Rmult_eq_reg_l with (4 * a); [| lra]. field_simplify; [| lra].
  replace (s ^ 2) with (k ^ 2 - 4 * a * c) by (rewrite <- S; ring). field; lra.
Qed.

(** The straight lines of the hyperboloid. *)
Lemma ruling p X : valid p -> on_hyperboloid p X ->
  exists u, 0 < dot u u /\ forall t, on_hyperboloid p (add X (scale t u)).
Proof.
  intros (Ha & Hg & _) H; unfold on_hyperboloid, height in H.
  set (x := px X / alpha p); set (y := py X / alpha p); set (z := pz X / gamma p).
  assert (E : x ^ 2 + y ^ 2 = 1 + z ^ 2) .
  { apply Rminus_diag_uniq; rewrite <- H; unfold x, y, z; field; lra. }
  assert (N : 0 < 1 + z ^ 2) by (pose proof (pow2_ge_0 z); lra).
  set (v := (x * z - y) / (1 + z ^ 2)); set (w := (y * z + x) / (1 + z ^ 2)).
  assert (U : v ^ 2 + w ^ 2 = 1).
  { replace (v ^ 2 + w ^ 2) with ((x ^ 2 + y ^ 2) / (1 + z ^ 2)) by (unfold v, w; field; lra). rewrite E; field; lra. }
  assert (T : x * v + y * w = z).
  { replace (x * v + y * w) with (z * ((x ^ 2 + y ^ 2) / (1 + z ^ 2))) by (unfold v, w; field; lra). rewrite E; field; lra. }
  exists (Point (alpha p * v) (alpha p * w) (gamma p)); split.
  - unfold dot; simpl. pose proof (pow2_ge_0 (alpha p * v)); pose proof (pow2_ge_0 (alpha p * w)); nra.
  - intros t; unfold on_hyperboloid, height, add, scale; simpl.
    replace (px X) with (alpha p * x) by (unfold x; field; lra).
    replace (py X) with (alpha p * y) by (unfold y; field; lra).
    replace (pz X) with (gamma p * z) by (unfold z; field; lra).
    transitivity ((x ^ 2 + y ^ 2) + 2 * t * (x * v + y * w) + t ^ 2 * (v ^ 2 + w ^ 2) - z ^ 2 - 2 * t * z - t ^ 2 - 1).
    + field; lra.
    + rewrite E, T, U; ring.
Qed.

Lemma line_meets_spheroid p X u : valid p -> in_spheroid p X -> 0 < dot u u ->
  exists t, on_spheroid p (add X (scale t u)).
Proof.
  intros V H U.
  set (k := 2 * ((dot (sub X (centre p)) u - dot (sub X (centre p)) (axis p) * dot u (axis p) / dot (axis p) (axis p))
                 / b p ^ 2 + dot (sub X (centre p)) (axis p) * dot u (axis p) / dot (axis p) (axis p) / d p ^ 2)).
  destruct (quadratic_root (norm2 p u) k (depth p X) (norm2_pos p u V U) H) as [t T]; exists t.
  unfold on_spheroid; rewrite <- T; unfold k, depth, norm2, along; destruct V as (_ & _ & Hb & Hd & Hv).
  assert (dot (axis p) (axis p) <> 0) by lra; assert (b p <> 0) by lra; assert (d p <> 0) by lra.
  clear - H0 H1 H2; generalize dependent (dot (axis p) (axis p)); intros n Hn.
  unfold dot, sub, add, scale; simpl; field; auto.
Qed.

Theorem solid_contact p X : valid p -> in_spheroid p X -> on_hyperboloid p X -> contact p.
Proof.
  intros V HX HH; destruct (ruling p X V HH) as [u [U L]].
  destruct (line_meets_spheroid p X u V HX U) as [t T]; exists (add X (scale t u)); split; [assumption | apply L].
Qed.

(** ** At most one of the three positions holds. *)

Lemma centre_in p : in_spheroid p (centre p).
Proof. unfold in_spheroid; rewrite depth_centre; lra. Qed.

Theorem positions_exclude_each_other p :
  ~ (exterior p /\ contact p) /\ ~ (interior p /\ contact p) /\ ~ (exterior p /\ interior p).
Proof.
  unfold exterior, interior, contact, on_spheroid, on_hyperboloid; repeat split.
  - intros [E (X & S & H)]; specialize (E X); unfold in_spheroid in E; lra.
  - intros [E (X & S & H)]; specialize (E X); unfold in_spheroid in E; lra.
  - intros [E I]; specialize (E _ (centre_in p)); specialize (I _ (centre_in p)); lra.
Qed.

(** ** Theorem 1 of the paper: dividing x and y by b and z by d turns the spheroid into the unit ball, and changes no
    position. *)

Definition scaled alpha gamma b d x y z := upright (alpha / b) (gamma / d) 1 1 (x / b) (y / b) (z / d).
Definition shrink (b d : R) (X : point) := Point (px X / b) (py X / b) (pz X / d).
Definition grow (b d : R) (X : point) := Point (px X * b) (py X * b) (pz X * d).

Lemma grow_shrink b d X : 0 < b -> 0 < d -> grow b d (shrink b d X) = X.
Proof. intros; apply point_eq; simpl; field; lra. Qed.

Lemma shrink_grow b d X : 0 < b -> 0 < d -> shrink b d (grow b d X) = X.
Proof. intros; apply point_eq; simpl; field; lra. Qed.

Lemma height_shrink alpha gamma b d x y z X : 0 < alpha -> 0 < gamma -> 0 < b -> 0 < d ->
  height (scaled alpha gamma b d x y z) (shrink b d X) = height (upright alpha gamma b d x y z) X.
Proof. intros; unfold height; simpl; field; lra. Qed.

Lemma depth_shrink alpha gamma b d x y z X : 0 < b -> 0 < d ->
  depth (scaled alpha gamma b d x y z) (shrink b d X) = depth (upright alpha gamma b d x y z) X.
Proof. intros; unfold depth, norm2, along, dot, sub; simpl; field; lra. Qed.

Theorem scaling alpha gamma b d x y z : 0 < alpha -> 0 < gamma -> 0 < b -> 0 < d ->
  let p := upright alpha gamma b d x y z in
  let q := scaled alpha gamma b d x y z in
  (exterior p <-> exterior q) /\ (interior p <-> interior q) /\ (contact p <-> contact q).
Proof.
  intros Ha Hg Hb Hd p q.
  assert (HH : forall X, height q (shrink b d X) = height p X) by (intros; apply height_shrink; assumption).
  assert (HD : forall X, depth q (shrink b d X) = depth p X) by (intros; apply depth_shrink; assumption).
  assert (HH' : forall X, height q X = height p (grow b d X)) by (intros; rewrite <- HH, shrink_grow; auto).
  assert (HD' : forall X, depth q X = depth p (grow b d X)) by (intros; rewrite <- HD, shrink_grow; auto).
  unfold exterior, interior, contact, in_spheroid, on_spheroid, on_hyperboloid; repeat split.
  - intros E X; rewrite HH', HD'; apply E.
  - intros E X; rewrite <- HH, <- HD; apply E.
  - intros E X; rewrite HH', HD'; apply E.
  - intros E X; rewrite <- HH, <- HD; apply E.
  - intros (X & S & H); exists (shrink b d X); rewrite HH, HD; auto.
  - intros (X & S & H); exists (grow b d X); rewrite <- HH', <- HD'; auto.
Qed.
