(** A checker of certificates that computes in rational numbers, proved sound, and extracted to OCaml (Extraction.v).

    It does what hypcheck/truth/certificate.py does, and asks of a frozen vector's certificate that it prove tangency, or
    crossing, as well. If it says true, the claim holds of the two bodies as Geometry.v defines them. *)

Require Import Reals Lra QArith Qreals List Bool.
From Hypcheck Require Import Geometry Certificates UnitBall.
Import ListNotations.

Open Scope Q_scope.

(** The seven numbers of a row, and what proves an answer about it. *)
Record row := Row { q_alpha : Q; q_gamma : Q; q_b : Q; q_d : Q; q_x : Q; q_y : Q; q_z : Q }.
Definition spot : Type := Q * Q * Q.
Inductive certificate := Multiplier (l : Q) | DoubleRoot (m : Q) | Points (points : list spot).
Inductive position := Exterior | Contact | Interior.

(** A float64 is a whole number times a power of two. *)
Definition dyadic (whole exponent : Z) : Q :=
  match exponent with
  | Zneg p => whole # (2 ^ p)
  | e => inject_Z (whole * 2 ^ e)
  end.

Definition less (u v : Q) : bool := negb (Qle_bool v u).

Definition valid_row (r : row) : bool :=
  less 0 (q_alpha r) && less 0 (q_gamma r) && less 0 (q_b r) && less 0 (q_d r).

Definition q_A r := (q_alpha r / q_b r) * (q_alpha r / q_b r).
Definition q_B r := (q_gamma r / q_d r) * (q_gamma r / q_d r).
Definition q_P r := (q_x r * q_x r + q_y r * q_y r) / (q_b r * q_b r).
Definition q_Q r := (q_z r / q_d r) * (q_z r / q_d r).

Definition q_g A B P Q l := (A + l) * (B - l) * (P + Q - 1 - l) - A * P * (B - l) - B * Q * (A + l).
Definition q_c2 A B P Q := A - B + 1 - P - Q.
Definition q_c1 A B P Q := B * P - A * Q + A - B - A * B.
Definition q_slope A B P Q l := 3 * (l * l) + 2 * q_c2 A B P Q * l + q_c1 A B P Q.

Definition check_exterior r l :=
  let A := q_A r in let B := q_B r in less 0 l && less l B && less 0 (q_g A B (q_P r) (q_Q r) l).

Definition check_interior r l :=
  let A := q_A r in let B := q_B r in less (- A) l && less l 0 && less 0 (q_g A B (q_P r) (q_Q r) l).

Definition check_double_root r m :=
  let A := q_A r in let B := q_B r in let P := q_P r in let Q := q_Q r in
  negb (Qeq_bool m 0) && Qle_bool (- A) m && Qle_bool m B
  && Qeq_bool (q_g A B P Q m) 0 && Qeq_bool (q_slope A B P Q m) 0
  && negb (Qeq_bool m B && less (- q_c2 A B P Q - 2 * m) B).

Definition q_depth r (X : spot) := let '(x, y, z) := X in
  ((x - q_x r) * (x - q_x r) + (y - q_y r) * (y - q_y r)) / (q_b r * q_b r)
  + (z - q_z r) * (z - q_z r) / (q_d r * q_d r) - 1.

Definition q_height r (X : spot) := let '(x, y, z) := X in
  (x * x + y * y) / (q_alpha r * q_alpha r) - z * z / (q_gamma r * q_gamma r) - 1.

Definition check_points r points :=
  forallb (fun X => Qle_bool (q_depth r X) 0) points
  && existsb (fun X => Qle_bool (q_height r X) 0) points && existsb (fun X => Qle_bool 0 (q_height r X)) points.

(** The same as truth/certificate.py: whether the certificate proves the position. *)
Definition check (r : row) (claim : position) (proof : certificate) : bool :=
  valid_row r && match claim, proof with
  | Exterior, Multiplier l => check_exterior r l
  | Interior, Multiplier l => check_interior r l
  | Contact, DoubleRoot m => check_double_root r m
  | Contact, Points points => check_points r points
  | _, _ => false
  end.

(** Two points on different sides, or one of the inside on the hyperboloid: the surfaces do more than touch. *)
Definition check_crossing r points :=
  forallb (fun X => Qle_bool (q_depth r X) 0) points
  && ((existsb (fun X => less (q_height r X) 0) points && existsb (fun X => less 0 (q_height r X)) points)
      || existsb (fun X => Qeq_bool (q_height r X) 0 && less (q_depth r X) 0) points).

(** A frozen vector gives its points as offsets from the centre, in semi-axes. *)
Definition placed r (offset : spot) : spot := let '(s, t, w) := offset in
  (q_x r + q_b r * s, q_y r + q_b r * t, q_z r + q_d r * w).

Definition check_vector (r : row) (claim : position) (tangent : bool) (proof : certificate) : bool :=
  valid_row r && match claim, tangent, proof with
  | Exterior, false, Multiplier l => check_exterior r l
  | Interior, false, Multiplier l => check_interior r l
  | Contact, true, DoubleRoot m => check_double_root r m
  | Contact, false, Points offsets => check_crossing r (map (placed r) offsets)
  | _, _, _ => false
  end.

(** ** Soundness. *)

Open Scope R_scope.

Definition body (r : row) :=
  upright (Q2R (q_alpha r)) (Q2R (q_gamma r)) (Q2R (q_b r)) (Q2R (q_d r)) (Q2R (q_x r)) (Q2R (q_y r)) (Q2R (q_z r)).

Definition holds (r : row) (claim : position) := match claim with
  | Exterior => exterior (body r) | Contact => contact (body r) | Interior => interior (body r) end.

Definition crosses_at p := exists X Y, in_spheroid p X /\ in_spheroid p Y /\ height p X < 0 < height p Y.
Definition crosses_inside p := exists X, depth p X < 0 /\ on_hyperboloid p X.

Definition label_holds (r : row) (claim : position) (tangent : bool) := match claim, tangent with
  | Contact, true => tangent_outside (body r) \/ tangent_inside (body r)
  | Contact, false => contact (body r) /\ (crosses_at (body r) \/ crosses_inside (body r))
  | claim, _ => holds r claim end.

Lemma Q2R_0 : Q2R 0 = 0.
Proof. unfold Q2R; simpl; field. Qed.
Lemma Q2R_1 : Q2R 1 = 1.
Proof. unfold Q2R; simpl; field. Qed.
Lemma Q2R_2 : Q2R 2 = 2.
Proof. unfold Q2R; simpl; field. Qed.
Lemma Q2R_3 : Q2R 3 = 3.
Proof. unfold Q2R; simpl; field. Qed.

Theorem dyadic_is_exact whole exponent : Q2R (dyadic whole exponent) = IZR whole * powerRZ 2 exponent.
Proof.
  destruct exponent as [| p | p]; unfold dyadic, Q2R; simpl.
  - rewrite Z.mul_1_r; field.
  - rewrite mult_IZR, Rinv_1, Rmult_1_r; f_equal.
    change (Z.pow_pos 2 p) with (2 ^ Zpos p)%Z; rewrite <- (positive_nat_Z p), <- pow_IZR; reflexivity.
  - f_equal; f_equal; rewrite Pos2Z.inj_pow, <- (positive_nat_Z p), <- pow_IZR; reflexivity.
Qed.

Lemma less_true u v : less u v = true -> Q2R u < Q2R v.
Proof.
  unfold less; intros H; apply negb_true_iff in H; apply Qlt_Rlt, Qnot_le_lt; intro K.
  apply Qle_bool_iff in K; rewrite K in H; discriminate.
Qed.

Lemma le_true u v : Qle_bool u v = true -> Q2R u <= Q2R v.
Proof. intros H; apply Qle_Rle, Qle_bool_iff; assumption. Qed.

Lemma eq_true u v : Qeq_bool u v = true -> Q2R u = Q2R v.
Proof. intros H; apply Qeq_eqR, Qeq_bool_iff; assumption. Qed.

Lemma eq_false u v : Qeq_bool u v = false -> Q2R u <> Q2R v.
Proof. intros H E; apply eqR_Qeq, Qeq_bool_iff in E; rewrite E in H; discriminate. Qed.

Lemma positive_not_0 q : less 0 q = true -> ~ (q == 0)%Q.
Proof. intros H E; apply less_true in H; apply Qeq_eqR in E; lra. Qed.

Lemma product_not_0 q : ~ (q == 0)%Q -> ~ (q * q == 0)%Q.
Proof. intros H E; apply Qmult_integral in E; tauto. Qed.

Ltac to_reals := repeat first
  [ rewrite Q2R_plus | rewrite Q2R_minus | rewrite Q2R_mult | rewrite Q2R_opp
  | rewrite Q2R_div by auto using product_not_0 | rewrite Q2R_0 | rewrite Q2R_1 | rewrite Q2R_2 | rewrite Q2R_3 ].

Section Soundness.

Variable r : row.
Hypothesis Valid : valid_row r = true.

Let al := Q2R (q_alpha r).
Let ga := Q2R (q_gamma r).
Let bb := Q2R (q_b r).
Let dd := Q2R (q_d r).

Lemma parts_positive : 0 < al /\ 0 < ga /\ 0 < bb /\ 0 < dd.
Proof.
  unfold valid_row in Valid; rewrite !andb_true_iff in Valid; destruct Valid as [[[H1 H2] H3] H4].
  apply less_true in H1; apply less_true in H2; apply less_true in H3; apply less_true in H4.
  rewrite Q2R_0 in *; repeat split; assumption.
Qed.

Lemma parts_not_0 : ~ (q_alpha r == 0)%Q /\ ~ (q_gamma r == 0)%Q /\ ~ (q_b r == 0)%Q /\ ~ (q_d r == 0)%Q.
Proof.
  unfold valid_row in Valid; rewrite !andb_true_iff in Valid; destruct Valid as [[[H1 H2] H3] H4].
  repeat split; apply positive_not_0; assumption.
Qed.

Lemma body_valid : Geometry.valid (body r).
Proof. destruct parts_positive as (H1 & H2 & H3 & H4); apply upright_valid; assumption. Qed.

Lemma A_is : Q2R (q_A r) = (al / bb) ^ 2.
Proof. destruct parts_not_0 as (N1 & N2 & N3 & N4); unfold q_A; to_reals; unfold al, bb; ring. Qed.
Lemma B_is : Q2R (q_B r) = (ga / dd) ^ 2.
Proof. destruct parts_not_0 as (N1 & N2 & N3 & N4); unfold q_B; to_reals; unfold ga, dd; ring. Qed.
Lemma P_is : Q2R (q_P r) = (Q2R (q_x r) ^ 2 + Q2R (q_y r) ^ 2) / bb ^ 2.
Proof.
  destruct parts_not_0 as (N1 & N2 & N3 & N4); destruct parts_positive as (H1 & H2 & H3 & H4).
  unfold q_P; to_reals; unfold bb in H3 |- *; field; lra.
Qed.
Lemma Q_is : Q2R (q_Q r) = (Q2R (q_z r) / dd) ^ 2.
Proof. destruct parts_not_0 as (N1 & N2 & N3 & N4); unfold q_Q; to_reals; unfold dd; ring. Qed.

Lemma g_is A B P Q l : Q2R (q_g A B P Q l) = g (Q2R A) (Q2R B) (Q2R P) (Q2R Q) (Q2R l).
Proof. unfold q_g, g; to_reals; ring. Qed.
Lemma slope_is A B P Q l : Q2R (q_slope A B P Q l) = slope (Q2R A) (Q2R B) (Q2R P) (Q2R Q) (Q2R l).
Proof. unfold q_slope, q_c2, q_c1, slope, c2, c1; to_reals; ring. Qed.
Lemma c2_is A B P Q : Q2R (q_c2 A B P Q) = c2 (Q2R A) (Q2R B) (Q2R P) (Q2R Q).
Proof. unfold q_c2, c2; to_reals; ring. Qed.

Theorem check_exterior_sound l : check_exterior r l = true -> exterior (body r).
Proof.
  unfold check_exterior; rewrite !andb_true_iff; intros [[L U] G].
  apply less_true in L; apply less_true in U; apply less_true in G.
  rewrite g_is, A_is, B_is, P_is, Q_is, Q2R_0 in G; rewrite B_is in U; rewrite Q2R_0 in L.
  destruct parts_positive as (H1 & H2 & H3 & H4); apply exterior_by_g with (Q2R l); assumption.
Qed.

Theorem check_interior_sound l : check_interior r l = true -> interior (body r).
Proof.
  unfold check_interior; rewrite !andb_true_iff; intros [[L U] G].
  apply less_true in L; apply less_true in U; apply less_true in G.
  rewrite g_is, A_is, B_is, P_is, Q_is, Q2R_0 in G; rewrite Q2R_opp, A_is in L; rewrite Q2R_0 in U.
  destruct parts_positive as (H1 & H2 & H3 & H4); apply interior_by_g with (Q2R l); assumption.
Qed.

Theorem check_double_root_sound m : check_double_root r m = true ->
  tangent_outside (body r) \/ tangent_inside (body r).
Proof.
  unfold check_double_root; rewrite !andb_true_iff, !negb_true_iff, andb_false_iff.
  intros [[[[[M L] U] G] S] R].
  apply eq_false in M; apply le_true in L; apply le_true in U; apply eq_true in G; apply eq_true in S.
  rewrite Q2R_0 in *; rewrite Q2R_opp, A_is in L; rewrite B_is in U.
  rewrite g_is, A_is, B_is, P_is, Q_is in G; rewrite slope_is, A_is, B_is, P_is, Q_is in S.
  destruct parts_positive as (H1 & H2 & H3 & H4).
  destruct (tangent_by_double_root al ga bb dd (Q2R (q_x r)) (Q2R (q_y r)) (Q2R (q_z r)) H1 H2 H3 H4 (Q2R m))
    as [TO TI]; try assumption; [split; assumption | |].
  - intros [E K]; destruct R as [R | R].
    + apply eq_false in R; rewrite B_is in R; contradiction.
    + apply negb_false_iff, le_true in R; revert R; to_reals; rewrite c2_is, A_is, B_is, P_is, Q_is; intros R.
      fold al bb ga dd in R, K; lra.
  - destruct (Rlt_dec 0 (Q2R m)); [left; apply TO | right; apply TI]; lra.
Qed.

Definition real_point (X : spot) := let '(x, y, z) := X in Point (Q2R x) (Q2R y) (Q2R z).

Lemma depth_is X : Q2R (q_depth r X) = depth (body r) (real_point X).
Proof.
  destruct parts_not_0 as (N1 & N2 & N3 & N4); destruct parts_positive as (H1 & H2 & H3 & H4).
  destruct X as [[x y] z]; unfold q_depth, depth, norm2, along, dot, sub; simpl; to_reals.
  unfold bb, dd in H3, H4 |- *; field; lra.
Qed.

Lemma height_is X : Q2R (q_height r X) = height (body r) (real_point X).
Proof.
  destruct parts_not_0 as (N1 & N2 & N3 & N4); destruct parts_positive as (H1 & H2 & H3 & H4).
  destruct X as [[x y] z]; unfold q_height, height; simpl; to_reals; unfold al, ga in H1, H2 |- *; field; lra.
Qed.

Lemma all_inside points X : forallb (fun X => Qle_bool (q_depth r X) 0) points = true -> In X points ->
  in_spheroid (body r) (real_point X).
Proof.
  intros H I; rewrite forallb_forall in H; specialize (H X I); apply le_true in H.
  rewrite depth_is, Q2R_0 in H; exact H.
Qed.

Theorem check_points_sound points : check_points r points = true -> contact (body r).
Proof.
  unfold check_points; rewrite !andb_true_iff, !existsb_exists; intros [[D (X & IX & HX)] (Y & IY & HY)].
  apply le_true in HX; apply le_true in HY; rewrite height_is, Q2R_0 in *.
  apply contact_by_points with (real_point X) (real_point Y);
    [apply body_valid | apply all_inside with points; assumption | apply all_inside with points; assumption |].
  rewrite <- (Rmult_0_r (height (body r) (real_point X))); apply Rmult_le_compat_neg_l; assumption.
Qed.

Theorem check_crossing_sound points : check_crossing r points = true ->
  contact (body r) /\ (crosses_at (body r) \/ crosses_inside (body r)).
Proof.
  unfold check_crossing; rewrite andb_true_iff, orb_true_iff, andb_true_iff, !existsb_exists.
  intros [D [[(X & IX & HX) (Y & IY & HY)] | (X & IX & HX)]].
  - apply less_true in HX; apply less_true in HY; rewrite height_is, Q2R_0 in *.
    pose proof (all_inside points X D IX) as DX; pose proof (all_inside points Y D IY) as DY; split.
    + apply contact_by_points with (real_point X) (real_point Y); try assumption; [apply body_valid |].
      rewrite <- (Rmult_0_r (height (body r) (real_point X))); apply Rmult_le_compat_neg_l; lra.
    + left; exists (real_point X), (real_point Y); repeat split; assumption.
  - rewrite andb_true_iff in HX; destruct HX as [HX DX]; apply eq_true in HX; apply less_true in DX.
    rewrite height_is, Q2R_0 in HX; rewrite depth_is, Q2R_0 in DX; split.
    + apply solid_contact with (real_point X); [apply body_valid | unfold in_spheroid; lra | exact HX].
    + right; exists (real_point X); split; assumption.
Qed.

End Soundness.

Theorem check_sound r claim proof : check r claim proof = true -> holds r claim.
Proof.
  unfold check; rewrite andb_true_iff; intros [V C].
  destruct claim, proof; try discriminate; simpl.
  - apply check_exterior_sound with l; assumption.
  - destruct (check_double_root_sound r V m C) as [[T _] | [T _]]; exact T.
  - apply check_points_sound with points; assumption.
  - apply check_interior_sound with l; assumption.
Qed.

Theorem check_vector_sound r claim tangent proof :
  check_vector r claim tangent proof = true -> label_holds r claim tangent.
Proof.
  unfold check_vector; rewrite andb_true_iff; intros [V C].
  destruct claim, tangent, proof; try discriminate; simpl.
  - apply check_exterior_sound with l; assumption.
  - apply check_double_root_sound with m; assumption.
  - apply check_crossing_sound with (map (placed r) points); assumption.
  - apply check_interior_sound with l; assumption.
Qed.
