(** The checker beside ends, in rational numbers, and its soundness.

    It does what hypcheck/truth/certificate.py does for rows with heights, of any axis: the position, open or solid. That a
    contact is no more than a touch is not proved. *)

Require Import Reals Lra QArith Qreals List Bool ZArith.
From Hypcheck Require Import Geometry Certificates UnitBall Checker Leaning LeaningChecker RowChecker Ends.
Import ListNotations.

Open Scope Q_scope.

(** [None] is an end infinitely far away. *)
Record heights := Heights { h_low : option Q; h_high : option Q; h_solid : bool }.

Definition valid_heights h := match h_low h, h_high h with Some l, Some u => less l u | _, _ => true end.

(** Heights from [p_low] to [p_high], with the multiplier and the number >= 0 that prove them clear. *)
Record piece := Piece { p_low : option Q; p_high : option Q; p_multiplier : Q; p_plane : Q }.

(** [Within]: a multiplier for all heights, and a number for what lies below the lower and above the upper end. [Level]: the
    pencil with this multiplier is 0 on the level line from a point in a direction. *)
Inductive end_witness := Pieces (pieces : list piece) | Within (l beneath over : Q) | Places (offsets : list spot)
  | Level (m : Q) (offset u : spot).

Definition q_above (low : option Q) z := match low with Some l => Qle_bool l z | None => true end.
Definition q_below (high : option Q) z := match high with Some u => Qle_bool z u | None => true end.
Definition q_well_above (low : option Q) z := match low with Some l => less l z | None => true end.
Definition q_well_below (high : option Q) z := match high with Some u => less z u | None => true end.
Definition q_at_heights low high (X : spot) := q_above low (q_z X) && q_below high (q_z X).
Definition q_in_body r low high X := Qle_bool (q_high r X) 0 && q_at_heights low high X.
Definition q_deep_in_body r low high X := less (q_high r X) 0 && q_well_above low (q_z X) && q_well_below high (q_z X).

Definition q_curve_2 (low high : option Q) := match low, high with Some _, Some _ => 1 | _, _ => 0 end.
Definition q_curve_1 low high := match low, high with
  | Some l, Some u => - ((l + u) * (1 # 2)) | Some _, None => - (1 # 2) | None, Some _ => 1 # 2 | None, None => 0 end.
Definition q_curve_0 low high := match low, high with
  | Some l, Some u => l * u | Some l, None => l | None, Some u => - u | None, None => 0 end.

Definition check_piece r (C : spot) (piece : piece) := let 'Piece low high l mu := piece in
  let s := q_pulls r C in let k := q_factor r * q_weight r * mu in
  let pull : spot := (q_x s, q_y s, q_z s + k * q_curve_1 low high) in let rest := q_rest r l C s + k * q_curve_0 low high in
  Qle_bool 0 mu && q_between4 (q_xx r l) (q_xy r) (q_xz r) (q_yy r l) (q_yz r) (q_zz r l + k * q_curve_2 low high)
    pull pull rest rest rest.

(** Whether pieces are clear, and cover all heights from [reached] to [high]. *)
Fixpoint check_cover r C reached (pieces : list piece) high : bool := match pieces with
  | [] => false
  | piece :: others => check_piece r C piece
      && match p_low piece, reached with None, _ => true | Some l, Some z => Qle_bool l z | Some _, None => false end
      && match p_high piece, high with
         | None, _ => true
         | Some u, Some z => Qle_bool z u || check_cover r C (Some u) others high
         | Some u, None => check_cover r C (Some u) others high end end.

Definition on_line r m (C X u : spot) := let F := times r m X in let p := q_pulls r C in
  negb (Qeq_bool m 0) && Qle_bool (q_deep r C X) 0 && less 0 (q_dot u u) && Qeq_bool (q_z u) 0
  && are_0 (q_x F + q_x p, q_y F + q_y p, q_z F + q_z p) && are_0 (times r m u)
  && Qeq_bool (q_factor r * q_deep r C X + m * q_weight r * q_high r X) 0.

Definition check_open r C low high claim proof := match claim, proof with
  | Exterior, Pieces pieces => check_cover r C low pieces high && negb (q_in_body r low high C)
  | Interior, Pieces pieces => check_cover r C low pieces high && q_in_body r low high C
  | Contact, Places offsets => let points := map (place_of r C) offsets in
      inside r C points && forallb (q_at_heights low high) points
      && existsb (fun X => Qle_bool (q_high r X) 0) points && existsb (fun X => Qle_bool 0 (q_high r X)) points
  | Contact, Level m offset u => let X := place_of r C offset in q_at_heights low high X && on_line r m C X u
  | _, _ => false end.

Definition check_solid r C low high claim proof := match claim, proof with
  | Exterior, Pieces pieces => check_cover r C low pieces high && forallb (fun piece => Qle_bool 0 (p_multiplier piece)) pieces
  | Interior, Within l beneath over => less l 0 && check_piece r C (Piece None None l 0)
      && match low with Some _ => check_piece r C (Piece None low 0 beneath) | None => true end
      && match high with Some _ => check_piece r C (Piece high None 0 over) | None => true end
  | Contact, Places offsets => let points := map (place_of r C) offsets in
      inside r C points && existsb (q_in_body r low high) points && existsb (fun X => negb (q_deep_in_body r low high X)) points
  | Contact, Level m offset u => let X := place_of r C offset in q_at_heights low high X && on_line r m C X u
  | _, _ => false end.

(** Lengths are counted in units of 1/D, the axis in units of 1/J; the numbers of the witness too. *)
Definition check_ended (row : sizes) (centre : spot) (h : heights) (D J : Z) (claim : position) (proof : end_witness) : bool :=
  let r := sizes_in D J row in let C := spot_in D centre in
  let low := option_map (in_unit D) (h_low h) in let high := option_map (in_unit D) (h_high h) in
  (0 <? D)%Z && (0 <? J)%Z && valid_sizes r && valid_heights h
  && (if h_solid h then check_solid else check_open) r C low high claim proof.

(** ** Soundness, in one unit. *)

Open Scope R_scope.

Definition end_at := option_map Q2R.

Lemma at_heights_true low high X : q_at_heights low high X = true -> at_heights (end_at low) (end_at high) (real X).
Proof.
  unfold q_at_heights, at_heights; intros H; bools; split; [destruct low | destruct high]; simpl in *; bools; auto.
Qed.

Lemma at_heights_false low high X : q_at_heights low high X = false -> ~ at_heights (end_at low) (end_at high) (real X).
Proof.
  unfold q_at_heights, at_heights; intros H [A B]; apply andb_false_iff in H; destruct H as [H | H];
    [destruct low | destruct high]; simpl in *; try discriminate;
    apply Rle_Qle, Qle_bool_iff in A + apply Rle_Qle, Qle_bool_iff in B; congruence.
Qed.

Lemma curve_2_is low high : Q2R (q_curve_2 low high) = curve_2 (end_at low) (end_at high).
Proof. destruct low, high; simpl; rewrite ?Q2R_0, ?Q2R_1; reflexivity. Qed.
Lemma curve_1_is low high : Q2R (q_curve_1 low high) = curve_1 (end_at low) (end_at high).
Proof.
  assert (H : Q2R (1 # 2) = / 2) by (unfold Q2R; simpl; lra).
  destruct low, high; unfold q_curve_1, curve_1, end_at, option_map; to_reals; rewrite ?H; lra.
Qed.
Lemma curve_0_is low high : Q2R (q_curve_0 low high) = curve_0 (end_at low) (end_at high).
Proof. destruct low, high; simpl; to_reals; reflexivity. Qed.

Section One_unit.

Variable r : sizes.
Hypothesis Valid : valid_sizes r = true.
Variable C : spot.
Let p := tilted_in r C.

Lemma check_piece_sound piece : check_piece r C piece = true ->
  clear_there p (end_at (p_low piece)) (end_at (p_high piece)) (Q2R (p_multiplier piece)) (Q2R (p_plane piece)).
Proof.
  destruct piece as [low high l mu]; cbn [p_low p_high p_multiplier p_plane]; unfold check_piece; intros H; bools; rewrite Q2R_0 in *.
  match goal with H : q_between4 _ _ _ _ _ _ _ _ _ _ _ = true |- _ => apply between4_true in H; rename H into B end.
  destruct (sizes_positive r Valid) as (H1 & H2 & H3 & H4 & H5); apply clear_by_form; try assumption; unfold piece_form.
  cbn [q_x q_y q_z fst snd] in B; revert B; to_reals.
  rewrite (xx_is r), (xy_is r), (xz_is r), (yy_is r), (yz_is r), (zz_is r), (rest_is r), (factor_is r), (weight_is r).
  rewrite curve_2_is, curve_1_is, curve_0_is.
  pose proof (f_equal px (pulls_are r C)) as E1; pose proof (f_equal py (pulls_are r C)) as E2; pose proof (f_equal pz (pulls_are r C)) as E3.
  cbn [real px py pz] in E1, E2, E3.
  rewrite E1, E2, E3; intros B; exact B.
Qed.

Let low_sound low X l reached : match low, reached with None, _ => true | Some l, Some z => Qle_bool l z | Some _, None => false end = l ->
  l = true -> above (end_at reached) (pz X) -> above (end_at low) (pz X).
Proof. intros <-; destruct low, reached; simpl; intros H A; try exact I; try discriminate; bools; lra. Qed.

Theorem check_cover_sound pieces : forall reached high, check_cover r C reached pieces high = true ->
  forall X, at_heights (end_at reached) (end_at high) X -> exists piece, In piece pieces
    /\ at_heights (end_at (p_low piece)) (end_at (p_high piece)) X
    /\ clear_there p (end_at (p_low piece)) (end_at (p_high piece)) (Q2R (p_multiplier piece)) (Q2R (p_plane piece)).
Proof.
  induction pieces as [| piece others IH]; cbn [check_cover]; intros reached high H X [A B]; [discriminate |].
  rewrite !andb_true_iff in H; destruct H as [[P L] U]; apply check_piece_sound in P.
  pose proof (low_sound _ X _ _ eq_refl L A) as A'.
  assert (N : below (end_at (p_high piece)) (pz X) \/ exists u, p_high piece = Some u /\ Q2R u <= pz X /\ check_cover r C (Some u) others high = true).
  { destruct (p_high piece) as [u |]; [| left; exact I]; destruct high as [z |].
    - destruct (Rle_lt_dec (pz X) (Q2R u)) as [K | K]; [left; exact K |].
      apply orb_prop in U; destruct U as [U | U]; [| right; exists u; repeat split; [lra | exact U]].
      bools; simpl in B; left; simpl; lra.
    - destruct (Rle_lt_dec (pz X) (Q2R u)) as [K | K]; [left; exact K |].
      right; exists u; repeat split; [lra | exact U]. }
  destruct N as [N | (u & _ & K & N)].
  - exists piece; split; [left; reflexivity | split; [split; assumption | exact P]].
  - destruct (IH (Some u) high N X) as (other & I & R); [split; assumption |].
    exists other; split; [right; exact I | exact R].
Qed.

Lemma cover_true low high pieces : check_cover r C low pieces high = true -> covered p (end_at low) (end_at high) false.
Proof.
  intros H X A; destruct (check_cover_sound _ _ _ H X A) as (piece & _ & B & P).
  exists (end_at (p_low piece)), (end_at (p_high piece)), (Q2R (p_multiplier piece)), (Q2R (p_plane piece)).
  repeat split; try apply B; try apply P; discriminate.
Qed.

Lemma cover_true_solid low high pieces : check_cover r C low pieces high = true ->
  forallb (fun piece => Qle_bool 0 (p_multiplier piece)) pieces = true -> covered p (end_at low) (end_at high) true.
Proof.
  intros H L X A; destruct (check_cover_sound _ _ _ H X A) as (piece & I & B & P).
  exists (end_at (p_low piece)), (end_at (p_high piece)), (Q2R (p_multiplier piece)), (Q2R (p_plane piece)).
  rewrite forallb_forall in L; specialize (L piece I); apply le_true in L; rewrite Q2R_0 in L.
  repeat split; try apply B; try apply P; intros; exact L.
Qed.

Lemma in_body_true low high X : q_in_body r low high X = true -> in_body p (end_at low) (end_at high) (real X).
Proof.
  unfold q_in_body, in_body; intros H; bools; rewrite Q2R_0 in *; split; [apply (height_sign r Valid C X) | apply at_heights_true]; assumption.
Qed.

Lemma in_body_false low high X : q_in_body r low high X = false -> ~ in_body p (end_at low) (end_at high) (real X).
Proof.
  unfold q_in_body, in_body; intros H [N A]; apply andb_false_iff in H; destruct H as [H | H]; [| exact (at_heights_false _ _ _ H A)].
  assert (K : ~ Q2R (q_high r X) <= 0) by (rewrite <- Q2R_0; intros K; apply Rle_Qle, Qle_bool_iff in K; congruence).
  apply Rnot_le_lt, (height_sign r Valid C X) in K; fold p in K; lra.
Qed.

Lemma deep_false low high X : q_deep_in_body r low high X = false -> ~ deep_in_body p (end_at low) (end_at high) (real X).
Proof.
  unfold q_deep_in_body, deep_in_body; intros H (N & A & B); rewrite !andb_false_iff in H; destruct H as [[H | H] | H].
  - unfold less in H; apply negb_false_iff, le_true in H; rewrite Q2R_0 in H; apply (height_sign r Valid C X) in H; fold p in H; lra.
  - destruct low; simpl in *; [unfold less in H; apply negb_false_iff, le_true in H; lra | discriminate].
  - destruct high; simpl in *; [unfold less in H; apply negb_false_iff, le_true in H; lra | discriminate].
Qed.

Lemma on_line_sound m X u : on_line r m C X u = true -> Q2R m <> 0 /\ in_spheroid p (real X) /\ 0 < dot (real u) (real u)
  /\ pz (real u) = 0 /\ forall t, pencil p (Q2R m) (add (real X) (scale t (real u))) = 0.
Proof.
  unfold on_line; intros H; rewrite !andb_true_iff in H; destruct H as [[[[[[M I] U] L] G] E] Z].
  apply negb_true_iff, eq_false in M; apply le_true in I; apply less_true in U; apply eq_true in L; apply eq_true in Z.
  apply are_0_true in G; apply are_0_true in E; rewrite Q2R_0 in *; rewrite dot_is in U; rewrite times_is in E.
  destruct G as (G1 & G2 & G3); unfold real in G1, G2, G3; cbn [q_x q_y q_z fst snd px py pz] in G1, G2, G3; revert G1 G2 G3; to_reals.
  pose proof (f_equal px (pulls_are r C)) as P1; pose proof (f_equal py (pulls_are r C)) as P2; pose proof (f_equal pz (pulls_are r C)) as P3.
  pose proof (f_equal px (times_is r m X)) as T1; pose proof (f_equal py (times_is r m X)) as T2; pose proof (f_equal pz (times_is r m X)) as T3.
  cbn [real px py pz] in P1, P2, P3, T1, T2, T3; rewrite P1, P2, P3, T1, T2, T3; intros G1 G2 G3.
  destruct (sizes_positive r Valid) as (H1 & H2 & H3 & H4 & H5).
  split; [exact M |]; split; [apply (depth_sign r Valid C X), I |]; split; [exact U |]; split; [exact L |]; intros t.
  apply zero_along; try assumption; revert Z; to_reals; rewrite (deep_is r Valid), (high_is r Valid C), (factor_is r), (weight_is r); intros Z.
  pose proof (scale_positive _ _ _ _ (real (s_axis r)) H1 H2 H3 H4 H5) as K; unfold pencil.
  apply Rmult_eq_reg_l with (factor (Q2R (s_alpha r)) (Q2R (s_gamma r)) * weight (Q2R (s_b r)) (Q2R (s_d r)) (real (s_axis r)));
    [| lra]; rewrite Rmult_0_r, <- Z; unfold tilted_in; ring.
Qed.

Theorem check_open_sound low high claim proof : check_open r C low high claim proof = true -> match claim with
  | Exterior => open_exterior p (end_at low) (end_at high) | Contact => open_contact p (end_at low) (end_at high)
  | Interior => open_interior p (end_at low) (end_at high) end.
Proof.
  unfold check_open; destruct claim, proof; intros H; try discriminate; rewrite !andb_true_iff in H.
  - destruct H as [H N]; apply negb_true_iff, in_body_false in N; split; [| exact N].
    apply wall_missed with false, cover_true with pieces; exact H.
  - destruct H as [[[I A] L] U]; rewrite existsb_exists in L, U; destruct L as (X & IX & HX), U as (Y & IY & HY).
    apply le_true in HX; apply le_true in HY; rewrite Q2R_0 in HX, HY; rewrite forallb_forall in A.
    apply (height_sign r Valid C X) in HX; apply (height_sign r Valid C Y) in HY.
    apply open_contact_by_points with (real X) (real Y); [apply its_valid, Valid | | | | |].
    + eapply inside_all; eassumption.
    + eapply inside_all; eassumption.
    + apply at_heights_true, A, IX.
    + apply at_heights_true, A, IY.
    + fold p in HX, HY; nra.
  - destruct H as [A H]; apply on_line_sound in H; destruct H as (M & S & U & L & Z).
    apply open_contact_by_line with (Q2R m) (real (place_of r C offset)) (real u); try assumption;
      [apply its_valid, Valid | apply at_heights_true, A].
  - destruct H as [H N]; apply in_body_true in N; split; [| exact N].
    apply wall_missed with false, cover_true with pieces; exact H.
Qed.

Lemma on_wall_on_border q low high X : on_wall q low high X -> on_border q low high X.
Proof. unfold on_wall, on_hyperboloid, on_border, in_body, deep_in_body; intros [H A]; repeat split; try apply A; lra. Qed.

Theorem check_solid_sound low high claim proof : check_solid r C low high claim proof = true -> match claim with
  | Exterior => solid_exterior p (end_at low) (end_at high) | Contact => solid_contact p (end_at low) (end_at high)
  | Interior => solid_interior p (end_at low) (end_at high) end.
Proof.
  unfold check_solid; destruct claim, proof; intros H; try discriminate; rewrite !andb_true_iff in H.
  - destruct H as [H L]; apply body_missed, cover_true_solid with pieces; assumption.
  - destruct H as [[I K] N]; rewrite existsb_exists in K, N; destruct K as (X & IX & KX), N as (Y & IY & NY).
    apply negb_true_iff, deep_false in NY; apply in_body_true in KX.
    apply solid_contact_by_points with (real X) (real Y); [apply its_valid, Valid | | | exact KX | exact NY];
      eapply inside_all; eassumption.
  - destruct H as [A H]; apply on_line_sound in H; destruct H as (M & S & U & L & Z).
    destruct (open_contact_by_line p (end_at low) (end_at high) (Q2R m) (real (place_of r C offset)) (real u)) as (Y & SY & WY);
      try assumption; [apply its_valid, Valid | apply at_heights_true, A |].
    exists Y; split; [exact SY | apply on_wall_on_border, WY].
  - destruct H as [[[L P] B] O]; apply less_true in L; rewrite Q2R_0 in L; apply check_piece_sound in P; destruct P as [_ P]; cbn in P.
    apply solid_interior_by_pieces.
    + apply interior_by_multiplier with (Q2R l); [exact L |]; intros X; specialize (P X); lra.
    + intros z E; destruct low as [low |]; [| discriminate]; apply check_piece_sound in B; cbn in B; rewrite Q2R_0 in B.
      injection E as E; rewrite E in B; exists (Q2R beneath); exact B.
    + intros z E; destruct high as [high |]; [| discriminate]; apply check_piece_sound in O; cbn in O; rewrite Q2R_0 in O.
      injection E as E; rewrite E in O; exists (Q2R over); exact O.
Qed.

End One_unit.

(** What a row with heights says of the two bodies. *)
Definition ended_holds row C h claim := let p := given row (real C) in let low := end_at (h_low h) in let high := end_at (h_high h) in
  match h_solid h, claim with
  | false, Exterior => open_exterior p low high | false, Contact => open_contact p low high
  | false, Interior => open_interior p low high
  | true, Exterior => solid_exterior p low high | true, Contact => solid_contact p low high
  | true, Interior => solid_interior p low high end.

Theorem check_ended_sound row C h D J claim proof : check_ended row C h D J claim proof = true -> ended_holds row C h claim.
Proof.
  unfold check_ended; intros H; rewrite !andb_true_iff in H; destruct H as [[[[HD HJ] Valid] _] H].
  assert (K : 0 < IZR D) by (apply IZR_lt, Z.ltb_lt; exact HD); assert (J0 : 0 < IZR J) by (apply IZR_lt, Z.ltb_lt; exact HJ).
  pose proof (same_ended_positions (given row (real C)) (IZR D) (IZR J) (end_at (h_low h)) (end_at (h_high h)) K J0
    (given_valid row D J HD HJ Valid (real C))) as S.
  pose proof (units_are row D J (real C) (spot_in D C) (spot_in_is D C)) as U; cbv zeta in U; rewrite <- U in S.
  assert (E : forall z, option_map (Rmult (IZR D)) (end_at z) = end_at (option_map (in_unit D) z)).
  { intros [z |]; [| reflexivity]; cbn; rewrite in_unit_is; reflexivity. }
  rewrite !E in S; unfold ended_holds; destruct (h_solid h).
  - apply check_solid_sound in H; [| exact Valid]; destruct claim; apply S; exact H.
  - apply check_open_sound in H; [| exact Valid]; destruct claim; apply S; exact H.
Qed.
