(** Certificates for any axis, and along a straight sweep: the forms behind the checker of LeaningChecker.v.

    The pencil of a pair, times a number > 0, is a form with whole coefficients where lengths are whole. Elimination without
    division keeps them whole. On a sweep from one centre to another the linear part is linear in the time, and the constant is
    quadratic: [ss], [st] and [tt] are its coefficients for the two ends, as Bernstein writes them. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry Certificates.
Open Scope R_scope.

(** ** Positive on the whole sweep. The time w is 0 at the centre with s1, s2, s3 and 1 at that with t1, t2, t3. *)

Definition between1 ss st tt := 0 < ss /\ 0 < tt /\ (0 <= st \/ st * st < ss * tt).
Definition between2 e s t ss st tt := 0 < e /\ between1 (e * ss - s * s) (e * st - s * t) (e * tt - t * t).
Definition between3 e11 e12 e22 s1 s2 t1 t2 ss st tt := 0 < e11 /\
  between2 (e11 * e22 - e12 * e12) (e11 * s2 - e12 * s1) (e11 * t2 - e12 * t1)
    (e11 * ss - s1 * s1) (e11 * st - s1 * t1) (e11 * tt - t1 * t1).
Definition between4 e11 e12 e13 e22 e23 e33 s1 s2 s3 t1 t2 t3 ss st tt := 0 < e11 /\
  between3 (e11 * e22 - e12 * e12) (e11 * e23 - e12 * e13) (e11 * e33 - e13 * e13)
    (e11 * s2 - e12 * s1) (e11 * s3 - e13 * s1) (e11 * t2 - e12 * t1) (e11 * t3 - e13 * t1)
    (e11 * ss - s1 * s1) (e11 * st - s1 * t1) (e11 * tt - t1 * t1).

Section Sweep.

Variable w : R.
Hypothesis W : 0 <= w <= 1.

Definition mixed (s t : R) := (1 - w) * s + w * t.
Definition mixed_twice (ss st tt : R) := (1 - w) ^ 2 * ss + 2 * w * (1 - w) * st + w ^ 2 * tt.

Lemma between1_positive ss st tt : between1 ss st tt -> 0 < mixed_twice ss st tt.
Proof.
  intros (S & T & M); unfold mixed_twice.
  assert (P1 : 0 <= (1 - w) ^ 2) by apply pow2_ge_0; assert (P2 : 0 <= w ^ 2) by apply pow2_ge_0.
  destruct M as [M | M].
  - assert (0 <= 2 * w * (1 - w) * st) by (apply Rmult_le_pos; [apply Rmult_le_pos; lra | exact M]).
    destruct (Req_dec w 1) as [-> | N]; [lra |].
    assert (0 < (1 - w) ^ 2 * ss) by (apply Rmult_lt_0_compat; [apply pow_lt; lra | exact S]).
    assert (0 <= w ^ 2 * tt) by (apply Rmult_le_pos; lra); lra.
  - apply Rmult_lt_reg_l with ss; [exact S |]; rewrite Rmult_0_r.
    replace (ss * ((1 - w) ^ 2 * ss + 2 * w * (1 - w) * st + w ^ 2 * tt))
      with (((1 - w) * ss + w * st) ^ 2 + w ^ 2 * (ss * tt - st * st)) by ring.
    assert (P3 : 0 <= ((1 - w) * ss + w * st) ^ 2) by apply pow2_ge_0.
    destruct (Req_dec w 0) as [-> | N].
    + replace (((1 - 0) * ss + 0 * st) ^ 2 + 0 ^ 2 * (ss * tt - st * st)) with (ss ^ 2) by ring; apply pow_lt; exact S.
    + assert (0 < w ^ 2 * (ss * tt - st * st)) by (apply Rmult_lt_0_compat; [apply pow_lt |]; lra); lra.
Qed.

Ltac positive_by e square rest := apply Rmult_lt_reg_l with e; [assumption |]; rewrite Rmult_0_r;
  match goal with |- 0 < ?f => replace f with (square ^ 2 + rest) by (unfold mixed, mixed_twice; ring) end;
  pose proof (pow2_ge_0 square); lra.

Lemma between2_positive e s t ss st tt x : between2 e s t ss st tt ->
  0 < e * x ^ 2 + 2 * mixed s t * x + mixed_twice ss st tt.
Proof.
  intros [E B]; pose proof (between1_positive _ _ _ B) as P.
  positive_by e (e * x + mixed s t) (mixed_twice (e * ss - s * s) (e * st - s * t) (e * tt - t * t)).
Qed.

Lemma between3_positive e11 e12 e22 s1 s2 t1 t2 ss st tt x y : between3 e11 e12 e22 s1 s2 t1 t2 ss st tt ->
  0 < e11 * x ^ 2 + 2 * e12 * x * y + e22 * y ^ 2 + 2 * mixed s1 t1 * x + 2 * mixed s2 t2 * y + mixed_twice ss st tt.
Proof.
  intros [E B]; pose proof (between2_positive _ _ _ _ _ _ y B) as P.
  positive_by e11 (e11 * x + e12 * y + mixed s1 t1) ((e11 * e22 - e12 * e12) * y ^ 2
    + 2 * mixed (e11 * s2 - e12 * s1) (e11 * t2 - e12 * t1) * y
    + mixed_twice (e11 * ss - s1 * s1) (e11 * st - s1 * t1) (e11 * tt - t1 * t1)).
Qed.

Lemma between4_positive e11 e12 e13 e22 e23 e33 s1 s2 s3 t1 t2 t3 ss st tt x y z :
  between4 e11 e12 e13 e22 e23 e33 s1 s2 s3 t1 t2 t3 ss st tt ->
  0 < e11 * x ^ 2 + 2 * e12 * x * y + 2 * e13 * x * z + e22 * y ^ 2 + 2 * e23 * y * z + e33 * z ^ 2
    + 2 * mixed s1 t1 * x + 2 * mixed s2 t2 * y + 2 * mixed s3 t3 * z + mixed_twice ss st tt.
Proof.
  intros [E B]; pose proof (between3_positive _ _ _ _ _ _ _ _ _ _ y z B) as P.
  positive_by e11 (e11 * x + e12 * y + e13 * z + mixed s1 t1) ((e11 * e22 - e12 * e12) * y ^ 2
    + 2 * (e11 * e23 - e12 * e13) * y * z + (e11 * e33 - e13 * e13) * z ^ 2
    + 2 * mixed (e11 * s2 - e12 * s1) (e11 * t2 - e12 * t1) * y
    + 2 * mixed (e11 * s3 - e13 * s1) (e11 * t3 - e13 * t1) * z
    + mixed_twice (e11 * ss - s1 * s1) (e11 * st - s1 * t1) (e11 * tt - t1 * t1)).
Qed.

End Sweep.

(** ** Nowhere negative. *)

Definition semi2 e11 e12 e22 := (0 < e11 /\ 0 <= e11 * e22 - e12 * e12) \/ (e11 = 0 /\ e12 = 0 /\ 0 <= e22).
Definition semi3 e11 e12 e13 e22 e23 e33 :=
  (0 < e11 /\ semi2 (e11 * e22 - e12 * e12) (e11 * e23 - e12 * e13) (e11 * e33 - e13 * e13))
  \/ (e11 = 0 /\ e12 = 0 /\ e13 = 0 /\ semi2 e22 e23 e33).

Lemma semi2_form e11 e12 e22 x y : semi2 e11 e12 e22 -> 0 <= e11 * x ^ 2 + 2 * e12 * x * y + e22 * y ^ 2.
Proof.
  intros [[E D] | (-> & -> & E)]; pose proof (pow2_ge_0 y) as Y.
  - apply Rmult_le_reg_l with e11; [exact E |]; rewrite Rmult_0_r.
    replace (e11 * (e11 * x ^ 2 + 2 * e12 * x * y + e22 * y ^ 2))
      with ((e11 * x + e12 * y) ^ 2 + (e11 * e22 - e12 * e12) * y ^ 2) by ring.
    pose proof (pow2_ge_0 (e11 * x + e12 * y)); pose proof (Rmult_le_pos _ _ D Y); lra.
  - pose proof (Rmult_le_pos _ _ E Y); lra.
Qed.

Lemma semi3_form e11 e12 e13 e22 e23 e33 x y z : semi3 e11 e12 e13 e22 e23 e33 ->
  0 <= e11 * x ^ 2 + 2 * e12 * x * y + 2 * e13 * x * z + e22 * y ^ 2 + 2 * e23 * y * z + e33 * z ^ 2.
Proof.
  intros [[E D] | (-> & -> & -> & D)]; pose proof (semi2_form _ _ _ y z D) as P; [| lra].
  apply Rmult_le_reg_l with e11; [exact E |]; rewrite Rmult_0_r.
  replace (e11 * (e11 * x ^ 2 + 2 * e12 * x * y + 2 * e13 * x * z + e22 * y ^ 2 + 2 * e23 * y * z + e33 * z ^ 2))
    with ((e11 * x + e12 * y + e13 * z) ^ 2 + ((e11 * e22 - e12 * e12) * y ^ 2 + 2 * (e11 * e23 - e12 * e13) * y * z
      + (e11 * e33 - e13 * e13) * z ^ 2)) by ring.
  pose proof (pow2_ge_0 (e11 * x + e12 * y + e13 * z)); lra.
Qed.

(** ** The pencil as such a form. *)

Section Pair.

Variables alpha gamma b d : R.
Variable v : point.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d) (Hv : 0 < dot v v).

Definition tilted (C : point) := Pair alpha gamma b d v C.

Lemma tilted_valid C : valid (tilted C).
Proof. repeat split; assumption. Qed.

Definition V := dot v v.
Definition mass (i j : point -> R) same := d ^ 2 * V * same + (b ^ 2 - d ^ 2) * i v * j v.
Definition factor := alpha ^ 2 * gamma ^ 2.
Definition weight := b ^ 2 * d ^ 2 * V.
Definition entry_xx l := factor * mass px px 1 + l * weight * gamma ^ 2.
Definition entry_yy l := factor * mass py py 1 + l * weight * gamma ^ 2.
Definition entry_zz l := factor * mass pz pz 1 - l * weight * alpha ^ 2.
Definition pull (i : point -> R) (sx sy sz : R) (C : point) :=
  - (factor * (mass i px sx * px C + mass i py sy * py C + mass i pz sz * pz C)).
Definition pull_x := pull px 1 0 0.
Definition pull_y := pull py 0 1 0.
Definition pull_z := pull pz 0 0 1.
Definition rest l (C E : point) := - (px E * pull_x C + py E * pull_y C + pz E * pull_z C) - factor * weight * (1 + l).

Definition form l (pull1 pull2 pull3 constant x y z : R) :=
  entry_xx l * x ^ 2 + 2 * (factor * mass px py 0) * x * y + 2 * (factor * mass px pz 0) * x * z
  + entry_yy l * y ^ 2 + 2 * (factor * mass py pz 0) * y * z + entry_zz l * z ^ 2
  + 2 * pull1 * x + 2 * pull2 * y + 2 * pull3 * z + constant.

Lemma form_is_pencil l C X : form l (pull_x C) (pull_y C) (pull_z C) (rest l C C) (px X) (py X) (pz X)
  = factor * weight * pencil (tilted C) l X.
Proof.
  assert (N : V <> 0) by (unfold V; lra).
  unfold form, pencil, depth, height, norm2, along, entry_xx, entry_yy, entry_zz, rest, pull_x, pull_y, pull_z, pull, mass, factor,
    weight, tilted; cbn [axis centre Geometry.alpha Geometry.gamma Geometry.b Geometry.d].
  fold V; unfold V in N |- *; unfold dot, sub in *; cbn [px py pz]; field; lra.
Qed.

Lemma scale_positive : 0 < factor * weight.
Proof.
  assert (0 < alpha ^ 2 /\ 0 < gamma ^ 2 /\ 0 < b ^ 2 /\ 0 < d ^ 2) as (P1 & P2 & P3 & P4) by (repeat split; apply pow_lt; assumption).
  unfold factor, weight, V; generalize dependent (alpha ^ 2); generalize dependent (gamma ^ 2); generalize dependent (b ^ 2);
    generalize dependent (d ^ 2); generalize dependent (dot v v); intros; repeat apply Rmult_lt_0_compat; assumption.
Qed.

Definition on_the_sweep l C E := between4 (entry_xx l) (factor * mass px py 0) (factor * mass px pz 0) (entry_yy l)
  (factor * mass py pz 0) (entry_zz l) (pull_x C) (pull_y C) (pull_z C) (pull_x E) (pull_y E) (pull_z E)
  (rest l C C) (rest l C E) (rest l E E).

Theorem sweep_positive l C E w X : on_the_sweep l C E -> 0 <= w <= 1 -> 0 < pencil (tilted (between C E w)) l X.
Proof.
  intros B W; pose proof (between4_positive w W _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ (px X) (py X) (pz X) B) as P.
  apply Rmult_lt_reg_l with (factor * weight); [apply scale_positive |]; rewrite Rmult_0_r, <- form_is_pencil.
  match goal with H : 0 < ?k |- 0 < ?f => replace f with k; [exact H |] end.
  unfold form, mixed, mixed_twice, rest, pull_x, pull_y, pull_z, pull, mass, between, add, scale, sub; cbn [px py pz]; ring.
Qed.

Theorem exterior_on_the_sweep l C E w : on_the_sweep l C E -> 0 < l -> 0 <= w <= 1 -> exterior (tilted (between C E w)).
Proof. intros B L W; apply exterior_by_multiplier with l; [exact L |]; intros X; apply sweep_positive; assumption. Qed.

Theorem interior_on_the_sweep l C E w : on_the_sweep l C E -> l < 0 -> 0 <= w <= 1 -> interior (tilted (between C E w)).
Proof. intros B L W; apply interior_by_multiplier with l; [exact L |]; intros X; apply sweep_positive; assumption. Qed.

(** ** A touch: the pencil is nowhere negative, and 0 in X, where the gradient vanishes. *)

Definition gradient_x l C X := entry_xx l * px X + factor * mass px py 0 * py X + factor * mass px pz 0 * pz X + pull_x C.
Definition gradient_y l C X := factor * mass px py 0 * px X + entry_yy l * py X + factor * mass py pz 0 * pz X + pull_y C.
Definition gradient_z l C X := factor * mass px pz 0 * px X + factor * mass py pz 0 * py X + entry_zz l * pz X + pull_z C.

Definition even l (u : point) := (* the matrix times u is 0 *)
  entry_xx l * px u + factor * mass px py 0 * py u + factor * mass px pz 0 * pz u = 0
  /\ factor * mass px py 0 * px u + entry_yy l * py u + factor * mass py pz 0 * pz u = 0
  /\ factor * mass px pz 0 * px u + factor * mass py pz 0 * py u + entry_zz l * pz u = 0.

Variables (m : R) (C X u : point).
Hypotheses (M : m <> 0) (Semi : semi3 (entry_xx m) (factor * mass px py 0) (factor * mass px pz 0) (entry_yy m)
  (factor * mass py pz 0) (entry_zz m)) (Gx : gradient_x m C X = 0) (Gy : gradient_y m C X = 0) (Gz : gradient_z m C X = 0)
  (Zero : pencil (tilted C) m X = 0) (Inside : in_spheroid (tilted C) X)
  (Meets : height (tilted C) X = 0 \/ (0 < dot u u /\ even m u)).

Let about Y : factor * weight * pencil (tilted C) m (add X Y)
  = entry_xx m * px Y ^ 2 + 2 * (factor * mass px py 0) * px Y * py Y + 2 * (factor * mass px pz 0) * px Y * pz Y
    + entry_yy m * py Y ^ 2 + 2 * (factor * mass py pz 0) * py Y * pz Y + entry_zz m * pz Y ^ 2.
Proof.
  pose proof (form_is_pencil m C X) as F; rewrite Zero, Rmult_0_r in F; rewrite <- form_is_pencil.
  assert (E : form m (pull_x C) (pull_y C) (pull_z C) (rest m C C) (px (add X Y)) (py (add X Y)) (pz (add X Y))
    = form m (pull_x C) (pull_y C) (pull_z C) (rest m C C) (px X) (py X) (pz X)
      + 2 * (px Y * gradient_x m C X + py Y * gradient_y m C X + pz Y * gradient_z m C X)
      + (entry_xx m * px Y ^ 2 + 2 * (factor * mass px py 0) * px Y * py Y + 2 * (factor * mass px pz 0) * px Y * pz Y
        + entry_yy m * py Y ^ 2 + 2 * (factor * mass py pz 0) * py Y * pz Y + entry_zz m * pz Y ^ 2))
    by (unfold form, gradient_x, gradient_y, gradient_z, add; cbn [px py pz]; ring).
  rewrite E, F, Gx, Gy, Gz; ring.
Qed.

(** The pencil is 0 on a line along which its form is 0. *)
Lemma zero_along t w : even m w -> pencil (tilted C) m (add X (scale t w)) = 0.
Proof.
  intros (E1 & E2 & E3); apply Rmult_eq_reg_l with (factor * weight); [| apply Rgt_not_eq, scale_positive].
  rewrite Rmult_0_r, about; unfold scale; cbn [px py pz].
  transitivity (t ^ 2 * (px w * (entry_xx m * px w + factor * mass px py 0 * py w + factor * mass px pz 0 * pz w)
    + py w * (factor * mass px py 0 * px w + entry_yy m * py w + factor * mass py pz 0 * pz w)
    + pz w * (factor * mass px pz 0 * px w + factor * mass py pz 0 * py w + entry_zz m * pz w))); [ring |].
  rewrite E1, E2, E3; ring.
Qed.

Let nowhere_negative Y : 0 <= pencil (tilted C) m Y.
Proof.
  pose proof (about (sub Y X)) as E; pose proof scale_positive as K.
  replace (add X (sub Y X)) with Y in E by (apply point_eq; unfold add, sub; cbn [px py pz]; ring).
  apply Rmult_le_reg_l with (factor * weight); [exact K |]; rewrite Rmult_0_r, E; apply semi3_form; exact Semi.
Qed.

Let meets : contact (tilted C).
Proof.
  destruct Meets as [H | [U (E1 & E2 & E3)]].
  - apply solid_contact with X; [apply tilted_valid | exact Inside | exact H].
  - apply contact_by_line with m X u; [apply tilted_valid | exact M | exact Inside | exact U |]; intros t.
    apply zero_along; repeat split; assumption.
Qed.

Theorem touch : tangent_outside (tilted C) \/ tangent_inside (tilted C).
Proof.
  destruct (Rlt_dec 0 m) as [P | N]; [left | right].
  - apply tangent_outside_by_multiplier with m; [exact P | exact nowhere_negative | exact meets].
  - apply tangent_inside_by_multiplier with m; [lra | exact nowhere_negative | exact meets].
Qed.

End Pair.

(** ** Another unit of length, and an axis of another length, change no position. *)

Section Unit.

Variables (p : pair) (k j : R).
Hypotheses (K : 0 < k) (J : 0 < j) (Valid : valid p).
Let p' := Pair (k * alpha p) (k * gamma p) (k * b p) (k * d p) (scale j (axis p)) (scale k (centre p)).

Lemma same_height X : height p' (scale k X) = height p X.
Proof. destruct Valid as (H1 & H2 & _); unfold height, scale, p'; cbn; field; lra. Qed.

Lemma same_depth X : depth p' (scale k X) = depth p X.
Proof.
  destruct Valid as (_ & _ & H3 & H4 & H5); unfold depth, norm2, along, p'; cbn [axis centre b d].
  assert (E : dot (scale j (axis p)) (scale j (axis p)) = j * j * dot (axis p) (axis p)) by (unfold dot, scale; cbn; ring).
  assert (F : dot (sub (scale k X) (scale k (centre p))) (scale j (axis p)) = k * j * dot (sub X (centre p)) (axis p))
    by (unfold dot, sub, scale; cbn; ring).
  assert (G : dot (sub (scale k X) (scale k (centre p))) (sub (scale k X) (scale k (centre p)))
    = k * k * dot (sub X (centre p)) (sub X (centre p))) by (unfold dot, sub, scale; cbn; ring).
  rewrite E, F, G; field; lra.
Qed.

Let there Y : Y = scale k (scale (/ k) Y).
Proof. apply point_eq; unfold scale; cbn; field; lra. Qed.

Theorem same_positions : (exterior p' -> exterior p) /\ (interior p' -> interior p) /\ (contact p' -> contact p)
  /\ (tangent_outside p' -> tangent_outside p) /\ (tangent_inside p' -> tangent_inside p).
Proof.
  assert (S : forall X, in_spheroid p X -> in_spheroid p' (scale k X)) by (unfold in_spheroid; intros; rewrite same_depth; assumption).
  assert (C : contact p' -> contact p).
  { intros (Y & HY & EY); rewrite (there Y) in HY, EY; exists (scale (/ k) Y).
    unfold on_spheroid, on_hyperboloid in *; rewrite same_depth in HY; rewrite same_height in EY; split; assumption. }
  repeat split; try (apply C; apply H); try exact C.
  - intros H X HX; rewrite <- same_height; apply H, S, HX.
  - intros H X HX; rewrite <- same_height; apply H, S, HX.
  - intros X HX; rewrite <- same_height; apply (proj2 H), S, HX.
  - intros X HX; rewrite <- same_height; apply (proj2 H), S, HX.
Qed.

Theorem same_crossing : ((exists X Y, in_spheroid p' X /\ in_spheroid p' Y /\ height p' X < 0 < height p' Y) ->
    exists X Y, in_spheroid p X /\ in_spheroid p Y /\ height p X < 0 < height p Y)
  /\ ((exists X, depth p' X < 0 /\ on_hyperboloid p' X) -> exists X, depth p X < 0 /\ on_hyperboloid p X).
Proof.
  unfold in_spheroid, on_hyperboloid; split.
  - intros (X & Y & HX & HY & H); rewrite (there X) in HX, H; rewrite (there Y) in HY, H.
    rewrite same_depth in HX, HY; rewrite !same_height in H; exists (scale (/ k) X), (scale (/ k) Y); auto.
  - intros (X & HX & H); rewrite (there X) in HX, H; rewrite same_depth in HX; rewrite same_height in H.
    exists (scale (/ k) X); auto.
Qed.

End Unit.
