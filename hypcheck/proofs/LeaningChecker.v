(** The checker for any axis, and for straight sweeps, in rational numbers, and its soundness.

    It does what hypcheck/truth/certificate.py does for rows of ten and of thirteen numbers (of seven and of
    ten where the axis is vertical). Lengths are first counted in a unit that makes them whole, if the caller knows one: the
    answer is proved for the row as it was given, whatever that unit is. *)

Require Import Reals Lra QArith Qreals List Bool.
From Hypcheck Require Import Geometry Certificates UnitBall Checker Leaning.
Import ListNotations.

Open Scope Q_scope.

(** The four sizes and the axis of a row; centres come apart. *)
Record sizes := Sizes { s_alpha : Q; s_gamma : Q; s_b : Q; s_d : Q; s_axis : spot }.
Inductive witness := Clear (l : Q) | Touch (m : Q) (X u : spot) | Among (points : list spot).

Definition q_x (X : spot) := fst (fst X).
Definition q_y (X : spot) := snd (fst X).
Definition q_z (X : spot) := snd X.
Definition q_dot (u v : spot) := q_x u * q_x v + q_y u * q_y v + q_z u * q_z v.

Definition valid_sizes r := less 0 (s_alpha r) && less 0 (s_gamma r) && less 0 (s_b r) && less 0 (s_d r)
  && less 0 (q_dot (s_axis r) (s_axis r)).

Definition square (q : Q) := q * q.
Definition q_mass r (i j : spot -> Q) same := square (s_d r) * q_dot (s_axis r) (s_axis r) * same
  + (square (s_b r) - square (s_d r)) * i (s_axis r) * j (s_axis r).
Definition q_factor r := square (s_alpha r) * square (s_gamma r).
Definition q_weight r := square (s_b r) * square (s_d r) * q_dot (s_axis r) (s_axis r).
Definition q_xx r l := q_factor r * q_mass r q_x q_x 1 + l * q_weight r * square (s_gamma r).
Definition q_yy r l := q_factor r * q_mass r q_y q_y 1 + l * q_weight r * square (s_gamma r).
Definition q_zz r l := q_factor r * q_mass r q_z q_z 1 - l * q_weight r * square (s_alpha r).
Definition q_xy r := q_factor r * q_mass r q_x q_y 0.
Definition q_xz r := q_factor r * q_mass r q_x q_z 0.
Definition q_yz r := q_factor r * q_mass r q_y q_z 0.
Definition q_pull r (i : spot -> Q) (sx sy sz : Q) (C : spot) := - (q_factor r
  * (q_mass r i q_x sx * q_x C + q_mass r i q_y sy * q_y C + q_mass r i q_z sz * q_z C)).
Definition q_pulls r (C : spot) : spot := (q_pull r q_x 1 0 0 C, q_pull r q_y 0 1 0 C, q_pull r q_z 0 0 1 C).
Definition q_rest r l (E p : spot) := - q_dot E p - q_factor r * q_weight r * (1 + l).

Definition q_between1 ss st tt := less 0 ss && less 0 tt && (Qle_bool 0 st || less (st * st) (ss * tt)).
Definition q_between2 e s t ss st tt := less 0 e && q_between1 (e * ss - s * s) (e * st - s * t) (e * tt - t * t).
Definition q_between3 e11 e12 e22 s1 s2 t1 t2 ss st tt := less 0 e11 &&
  q_between2 (e11 * e22 - e12 * e12) (e11 * s2 - e12 * s1) (e11 * t2 - e12 * t1)
    (e11 * ss - s1 * s1) (e11 * st - s1 * t1) (e11 * tt - t1 * t1).
Definition q_between4 e11 e12 e13 e22 e23 e33 (s t : spot) ss st tt := less 0 e11 &&
  q_between3 (e11 * e22 - e12 * e12) (e11 * e23 - e12 * e13) (e11 * e33 - e13 * e13)
    (e11 * q_y s - e12 * q_x s) (e11 * q_z s - e13 * q_x s) (e11 * q_y t - e12 * q_x t) (e11 * q_z t - e13 * q_x t)
    (e11 * ss - q_x s * q_x s) (e11 * st - q_x s * q_x t) (e11 * tt - q_x t * q_x t).

(** Whether the multiplier proves the spheroid clear on the whole sweep from one centre to another. *)
Definition check_sweep r l (C E : spot) := let s := q_pulls r C in let t := q_pulls r E in
  negb (Qeq_bool l 0) && q_between4 (q_xx r l) (q_xy r) (q_xz r) (q_yy r l) (q_yz r) (q_zz r l) s t
    (q_rest r l C s) (q_rest r l E s) (q_rest r l E t).

Definition q_semi2 e11 e12 e22 := (less 0 e11 && Qle_bool 0 (e11 * e22 - e12 * e12))
  || (Qeq_bool e11 0 && Qeq_bool e12 0 && Qle_bool 0 e22).
Definition q_semi3 e11 e12 e13 e22 e23 e33 :=
  (less 0 e11 && q_semi2 (e11 * e22 - e12 * e12) (e11 * e23 - e12 * e13) (e11 * e33 - e13 * e13))
  || (Qeq_bool e11 0 && Qeq_bool e12 0 && Qeq_bool e13 0 && q_semi2 e22 e23 e33).

(** Depth and height, times numbers > 0. *)
Definition q_deep r (C X : spot) := let '(x, y, z) := X in let u := (x - q_x C, y - q_y C, z - q_z C) in
  let along := square (q_dot u (s_axis r)) in
  square (s_d r) * (q_dot (s_axis r) (s_axis r) * q_dot u u - along) + square (s_b r) * along - q_weight r.
Definition q_high r (X : spot) :=
  square (s_gamma r) * (square (q_x X) + square (q_y X)) - square (s_alpha r) * square (q_z X) - q_factor r.

Definition times r l (X : spot) : spot := (q_xx r l * q_x X + q_xy r * q_y X + q_xz r * q_z X,
  q_xy r * q_x X + q_yy r l * q_y X + q_yz r * q_z X, q_xz r * q_x X + q_yz r * q_y X + q_zz r l * q_z X).
Definition are_0 (X : spot) := Qeq_bool (q_x X) 0 && Qeq_bool (q_y X) 0 && Qeq_bool (q_z X) 0.

Definition check_touch r m (C X u : spot) := let p := q_pulls r C in let F := times r m X in
  negb (Qeq_bool m 0) && q_semi3 (q_xx r m) (q_xy r) (q_xz r) (q_yy r m) (q_yz r) (q_zz r m)
  && are_0 (q_x F + q_x p, q_y F + q_y p, q_z F + q_z p)
  && Qeq_bool (q_factor r * q_deep r C X + m * q_weight r * q_high r X) 0 && Qle_bool (q_deep r C X) 0
  && (Qeq_bool (q_high r X) 0 || (less 0 (q_dot u u) && are_0 (times r m u))).

Definition inside r C points := forallb (fun X => Qle_bool (q_deep r C X) 0) points.
Definition check_meeting r C points := inside r C points
  && existsb (fun X => Qle_bool (q_high r X) 0) points && existsb (fun X => Qle_bool 0 (q_high r X)) points.
Definition check_through r C points := inside r C points
  && ((existsb (fun X => less (q_high r X) 0) points && existsb (fun X => less 0 (q_high r X)) points)
      || existsb (fun X => Qeq_bool (q_high r X) 0 && less (q_deep r C X) 0) points).

(** ** Soundness, in one unit. *)

Open Scope R_scope.

Definition real (X : spot) := Point (Q2R (q_x X)) (Q2R (q_y X)) (Q2R (q_z X)).
Definition tilted_in r C := tilted (Q2R (s_alpha r)) (Q2R (s_gamma r)) (Q2R (s_b r)) (Q2R (s_d r)) (real (s_axis r)) (real C).

Lemma square_is q : Q2R (square q) = Q2R q ^ 2.
Proof. unfold square; rewrite Q2R_mult; ring. Qed.
Lemma dot_is u v : Q2R (q_dot u v) = dot (real u) (real v).
Proof. unfold q_dot, dot, real; cbn [px py pz]; to_reals; ring. Qed.

Ltac bools := repeat match goal with
  | H : (_ && _)%bool = true |- _ => apply andb_prop in H; destruct H
  | H : less _ _ = true |- _ => apply less_true in H
  | H : Qle_bool _ _ = true |- _ => apply le_true in H
  | H : Qeq_bool _ _ = true |- _ => apply eq_true in H
  | H : negb _ = true |- _ => apply negb_true_iff in H
  | H : Qeq_bool _ _ = false |- _ => apply eq_false in H end.

Ltac real_numbers := repeat first
  [ rewrite Q2R_plus in * | rewrite Q2R_minus in * | rewrite Q2R_mult in * | rewrite Q2R_opp in * | rewrite Q2R_0 in * ].

Lemma between1_true ss st tt : q_between1 ss st tt = true -> between1 (Q2R ss) (Q2R st) (Q2R tt).
Proof.
  unfold q_between1, between1; intros H; bools; match goal with H : (_ || _)%bool = true |- _ => apply orb_prop in H; destruct H end; bools;
    real_numbers; tauto.
Qed.
Lemma between2_true e s t ss st tt : q_between2 e s t ss st tt = true ->
  between2 (Q2R e) (Q2R s) (Q2R t) (Q2R ss) (Q2R st) (Q2R tt).
Proof.
  unfold q_between2, between2; intros H; bools; match goal with H : q_between1 _ _ _ = true |- _ => apply between1_true in H end.
  real_numbers; tauto.
Qed.
Lemma between3_true e11 e12 e22 s1 s2 t1 t2 ss st tt : q_between3 e11 e12 e22 s1 s2 t1 t2 ss st tt = true ->
  between3 (Q2R e11) (Q2R e12) (Q2R e22) (Q2R s1) (Q2R s2) (Q2R t1) (Q2R t2) (Q2R ss) (Q2R st) (Q2R tt).
Proof.
  unfold q_between3, between3; intros H; bools; match goal with H : q_between2 _ _ _ _ _ _ = true |- _ => apply between2_true in H end.
  real_numbers; tauto.
Qed.
Lemma between4_true e11 e12 e13 e22 e23 e33 s t ss st tt : q_between4 e11 e12 e13 e22 e23 e33 s t ss st tt = true ->
  between4 (Q2R e11) (Q2R e12) (Q2R e13) (Q2R e22) (Q2R e23) (Q2R e33) (Q2R (q_x s)) (Q2R (q_y s)) (Q2R (q_z s))
    (Q2R (q_x t)) (Q2R (q_y t)) (Q2R (q_z t)) (Q2R ss) (Q2R st) (Q2R tt).
Proof.
  unfold q_between4, between4; intros H; bools;
    match goal with H : q_between3 _ _ _ _ _ _ _ _ _ _ = true |- _ => apply between3_true in H end.
  real_numbers; tauto.
Qed.
Lemma semi2_true e11 e12 e22 : q_semi2 e11 e12 e22 = true -> semi2 (Q2R e11) (Q2R e12) (Q2R e22).
Proof. unfold q_semi2, semi2; intros H; apply orb_prop in H; destruct H as [H | H]; bools; real_numbers; tauto. Qed.
Lemma semi3_true e11 e12 e13 e22 e23 e33 : q_semi3 e11 e12 e13 e22 e23 e33 = true ->
  semi3 (Q2R e11) (Q2R e12) (Q2R e13) (Q2R e22) (Q2R e23) (Q2R e33).
Proof.
  unfold q_semi3, semi3; intros H; apply orb_prop in H; destruct H as [H | H]; bools;
    match goal with H : q_semi2 _ _ _ = true |- _ => apply semi2_true in H end; real_numbers; tauto.
Qed.

Section One_unit.

Variable r : sizes.
Hypothesis Valid : valid_sizes r = true.

Let al := Q2R (s_alpha r).
Let ga := Q2R (s_gamma r).
Let bb := Q2R (s_b r).
Let dd := Q2R (s_d r).
Let v := real (s_axis r).

Lemma sizes_positive : 0 < al /\ 0 < ga /\ 0 < bb /\ 0 < dd /\ 0 < dot v v.
Proof. unfold valid_sizes in Valid; bools; rewrite dot_is, Q2R_0 in *; repeat split; assumption. Qed.

Let pa : 0 < al. Proof. apply sizes_positive. Qed.
Let pg : 0 < ga. Proof. apply sizes_positive. Qed.
Let pb : 0 < bb. Proof. apply sizes_positive. Qed.
Let pd : 0 < dd. Proof. apply sizes_positive. Qed.
Let pv : 0 < dot v v. Proof. apply sizes_positive. Qed.

Lemma mass_is i j same (I : point -> R) (J : point -> R) : (forall X, Q2R (i X) = I (real X)) -> (forall X, Q2R (j X) = J (real X)) ->
  Q2R (q_mass r i j same) = mass bb dd v I J (Q2R same).
Proof.
  intros H K; unfold q_mass, mass, V; to_reals; rewrite !square_is, dot_is, H, K; reflexivity.
Qed.

Let on_x X : Q2R (q_x X) = px (real X).
Proof. reflexivity. Qed.
Let on_y X : Q2R (q_y X) = py (real X).
Proof. reflexivity. Qed.
Let on_z X : Q2R (q_z X) = pz (real X).
Proof. reflexivity. Qed.

Lemma factor_is : Q2R (q_factor r) = factor al ga.
Proof. unfold q_factor, factor; to_reals; rewrite !square_is; reflexivity. Qed.
Lemma weight_is : Q2R (q_weight r) = weight bb dd v.
Proof. unfold q_weight, weight, V; to_reals; rewrite !square_is, dot_is; reflexivity. Qed.

Ltac entries := to_reals; rewrite ?factor_is, ?weight_is, ?square_is, ?(mass_is _ _ _ px px on_x on_x), ?(mass_is _ _ _ py py on_y on_y),
  ?(mass_is _ _ _ pz pz on_z on_z), ?(mass_is _ _ _ px py on_x on_y), ?(mass_is _ _ _ px pz on_x on_z), ?(mass_is _ _ _ py pz on_y on_z),
  ?(mass_is _ _ _ py px on_y on_x), ?(mass_is _ _ _ pz px on_z on_x), ?(mass_is _ _ _ pz py on_z on_y); to_reals.

Lemma xx_is l : Q2R (q_xx r l) = entry_xx al ga bb dd v (Q2R l).
Proof. unfold q_xx, entry_xx; entries; reflexivity. Qed.
Lemma yy_is l : Q2R (q_yy r l) = entry_yy al ga bb dd v (Q2R l).
Proof. unfold q_yy, entry_yy; entries; reflexivity. Qed.
Lemma zz_is l : Q2R (q_zz r l) = entry_zz al ga bb dd v (Q2R l).
Proof. unfold q_zz, entry_zz; entries; reflexivity. Qed.
Lemma xy_is : Q2R (q_xy r) = factor al ga * mass bb dd v px py 0.
Proof. unfold q_xy; entries; reflexivity. Qed.
Lemma xz_is : Q2R (q_xz r) = factor al ga * mass bb dd v px pz 0.
Proof. unfold q_xz; entries; reflexivity. Qed.
Lemma yz_is : Q2R (q_yz r) = factor al ga * mass bb dd v py pz 0.
Proof. unfold q_yz; entries; reflexivity. Qed.
Lemma pulls_are C : real (q_pulls r C) = Point (pull_x al ga bb dd v (real C)) (pull_y al ga bb dd v (real C)) (pull_z al ga bb dd v (real C)).
Proof.
  unfold real at 1, q_pulls, pull_x, pull_y, pull_z, pull, q_pull; cbn [q_x q_y q_z fst snd]; f_equal; entries; rewrite ?on_x, ?on_y, ?on_z; reflexivity.
Qed.
Lemma rest_is l C E : Q2R (q_rest r l E (q_pulls r C)) = rest al ga bb dd v (Q2R l) (real C) (real E).
Proof. unfold q_rest, rest; to_reals; rewrite dot_is, pulls_are; entries; unfold dot; cbn [px py pz]; ring. Qed.

Theorem check_sweep_sound l C E w : check_sweep r l C E = true -> 0 <= w <= 1 ->
  (0 < Q2R l -> exterior (tilted al ga bb dd v (between (real C) (real E) w)))
  /\ (Q2R l < 0 -> interior (tilted al ga bb dd v (between (real C) (real E) w))).
Proof.
  unfold check_sweep; intros H W; bools.
  match goal with H : q_between4 _ _ _ _ _ _ _ _ _ _ _ = true |- _ => apply between4_true in H end.
  rewrite xx_is, xy_is, xz_is, yy_is, yz_is, zz_is, !rest_is, !on_x, !on_y, !on_z, !pulls_are in *; cbn [px py pz] in *.
  split; intros L; [apply exterior_on_the_sweep with (Q2R l) | apply interior_on_the_sweep with (Q2R l)]; assumption.
Qed.

Lemma deep_is C X : Q2R (q_deep r C X) = weight bb dd v * depth (tilted_in r C) (real X).
Proof.
  destruct X as [[x y] z]; unfold q_deep; to_reals; rewrite weight_is, !square_is, !dot_is; fold bb dd v.
  unfold depth, norm2, along, tilted_in, tilted, weight, V; cbn [axis centre b d]; fold bb dd v; pose proof pv as N.
  replace (sub (real (x, y, z)) (real C)) with (real ((x - q_x C)%Q, (y - q_y C)%Q, (z - q_z C)%Q))
    by (unfold real, sub, q_x, q_y, q_z; cbn [fst snd px py pz]; f_equal; to_reals; reflexivity).
  generalize dependent (dot v v); generalize (real ((x - q_x C)%Q, (y - q_y C)%Q, (z - q_z C)%Q)); intros u n N.
  generalize (dot u u) (dot u v); intros; field; pose proof pb; pose proof pd; lra.
Qed.

Lemma high_is C X : Q2R (q_high r X) = factor al ga * height (tilted_in r C) (real X).
Proof.
  unfold q_high; to_reals; rewrite factor_is, !square_is; unfold height, factor, tilted_in, tilted, real; cbn [alpha gamma px py pz]; fold al ga.
  field; pose proof pa; pose proof pg; lra.
Qed.

Let factor_positive : 0 < factor al ga.
Proof. unfold factor; apply Rmult_lt_0_compat; apply pow_lt; [exact pa | exact pg]. Qed.
Let weight_positive : 0 < weight bb dd v.
Proof.
  unfold weight, V; apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; apply pow_lt; [exact pb | exact pd] | exact pv].
Qed.

Let sign k x y : 0 < k -> y = k * x -> (0 <= y -> 0 <= x) /\ (y <= 0 -> x <= 0) /\ (0 < y -> 0 < x) /\ (y < 0 -> x < 0) /\ (y = 0 -> x = 0).
Proof. intros K ->; repeat split; intros H; nra. Qed.

Definition depth_sign C X := sign _ _ _ weight_positive (deep_is C X).
Definition height_sign C X := sign _ _ _ factor_positive (high_is C X).

Lemma are_0_true X : are_0 X = true -> px (real X) = 0 /\ py (real X) = 0 /\ pz (real X) = 0.
Proof. unfold are_0; intros H; bools; rewrite Q2R_0 in *; auto. Qed.

Lemma times_is l X : real (times r l X) = let e := real X in Point
  (entry_xx al ga bb dd v (Q2R l) * px e + factor al ga * mass bb dd v px py 0 * py e + factor al ga * mass bb dd v px pz 0 * pz e)
  (factor al ga * mass bb dd v px py 0 * px e + entry_yy al ga bb dd v (Q2R l) * py e + factor al ga * mass bb dd v py pz 0 * pz e)
  (factor al ga * mass bb dd v px pz 0 * px e + factor al ga * mass bb dd v py pz 0 * py e + entry_zz al ga bb dd v (Q2R l) * pz e).
Proof.
  unfold real at 1, times; cbn [q_x q_y q_z fst snd]; to_reals; rewrite xx_is, yy_is, zz_is, xy_is, xz_is, yz_is; reflexivity.
Qed.

Theorem check_touch_sound m C X u : check_touch r m C X u = true ->
  tangent_outside (tilted_in r C) \/ tangent_inside (tilted_in r C).
Proof.
  unfold check_touch; intros H; bools.
  match goal with H : q_semi3 _ _ _ _ _ _ = true |- _ => apply semi3_true in H; rename H into S end.
  match goal with H : are_0 _ = true |- _ => apply are_0_true in H; destruct H as (G1 & G2 & G3) end.
  match goal with H : (_ || _)%bool = true |- _ => apply orb_prop in H; rename H into E end.
  match goal with H : Q2R m <> _ |- _ => rewrite Q2R_0 in H; rename H into M end.
  match goal with H : Q2R (q_deep _ _ _) <= _ |- _ => rewrite Q2R_0 in H; apply (proj1 (proj2 (depth_sign C X))) in H; rename H into I end.
  match goal with H : Q2R (_ + _) = _ |- _ => revert H; to_reals; intros Z; rewrite deep_is, (high_is C), factor_is, weight_is in Z end.
  rewrite xx_is, yy_is, zz_is, xy_is, xz_is, yz_is in S.
  unfold real in G1, G2, G3; cbn [q_x q_y q_z fst snd px py pz] in G1, G2, G3; revert G1 G2 G3; to_reals.
  rewrite !on_x, !on_y, !on_z, !times_is, !pulls_are; cbn [px py pz]; intros G1 G2 G3.
  unfold tilted_in; fold al ga bb dd v.
  apply (touch al ga bb dd v pa pg pb pd pv (Q2R m) (real C) (real X) (real u)); try assumption.
  - unfold pencil; fold (tilted_in r C); apply Rmult_eq_reg_l with (factor al ga * weight bb dd v);
      [| apply Rgt_not_eq, Rmult_lt_0_compat; assumption].
    rewrite Rmult_0_r; change (tilted al ga bb dd v (real C)) with (tilted_in r C); rewrite <- Z; ring.
  - destruct E as [E | E]; bools.
    + left; rewrite Q2R_0 in E; apply (height_sign C X); exact E.
    + right; rewrite Q2R_0, dot_is in *; split; [assumption |].
      match goal with H : are_0 _ = true |- _ => apply are_0_true in H; rewrite times_is in H; exact H end.
Qed.

Lemma inside_all C points X : inside r C points = true -> In X points -> in_spheroid (tilted_in r C) (real X).
Proof.
  unfold inside; intros H I; rewrite forallb_forall in H; specialize (H X I); apply le_true in H; rewrite Q2R_0 in H.
  apply (proj1 (proj2 (depth_sign C X))); exact H.
Qed.

Lemma its_valid C : valid (tilted_in r C).
Proof. apply tilted_valid; [exact pa | exact pg | exact pb | exact pd | exact pv]. Qed.

Theorem check_meeting_sound C points : check_meeting r C points = true -> contact (tilted_in r C).
Proof.
  unfold check_meeting; rewrite !andb_true_iff, !existsb_exists; intros [[D (X & IX & HX)] (Y & IY & HY)].
  apply le_true in HX; apply le_true in HY; rewrite Q2R_0 in HX, HY.
  apply (proj1 (proj2 (height_sign C X))) in HX; apply (proj1 (height_sign C Y)) in HY.
  apply contact_by_points with (real X) (real Y); [apply its_valid | apply inside_all with points; assumption | apply inside_all with points; assumption |].
  rewrite <- (Rmult_0_r (height (tilted_in r C) (real X))); apply Rmult_le_compat_neg_l; assumption.
Qed.

Theorem check_through_sound C points : check_through r C points = true ->
  contact (tilted_in r C) /\ (crosses_at (tilted_in r C) \/ crosses_inside (tilted_in r C)).
Proof.
  unfold check_through; rewrite andb_true_iff, orb_true_iff, andb_true_iff, !existsb_exists.
  intros [D [[(X & IX & HX) (Y & IY & HY)] | (X & IX & HX)]].
  - apply less_true in HX; apply less_true in HY; rewrite Q2R_0 in HX, HY.
    apply (height_sign C X) in HX; apply (height_sign C Y) in HY.
    pose proof (inside_all C points X D IX) as DX; pose proof (inside_all C points Y D IY) as DY; split.
    + apply contact_by_points with (real X) (real Y); try assumption; [apply its_valid |].
      rewrite <- (Rmult_0_r (height (tilted_in r C) (real X))); apply Rmult_le_compat_neg_l; lra.
    + left; exists (real X), (real Y); repeat split; assumption.
  - rewrite andb_true_iff in HX; destruct HX as [HX DX]; apply eq_true in HX; apply less_true in DX; rewrite Q2R_0 in HX, DX.
    apply (height_sign C X) in HX; apply (depth_sign C X) in DX; split.
    + apply solid_contact with (real X); [apply its_valid | unfold in_spheroid; lra | exact HX].
    + right; exists (real X); split; assumption.
Qed.

End One_unit.
