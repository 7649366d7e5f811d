(** The checker on rows as files have them: any axis, and sweeps, in whatever unit makes the numbers whole. *)

Require Import Reals Lra QArith Qreals List Bool ZArith.
From Hypcheck Require Import Geometry UnitBall Checker Leaning LeaningChecker.
Import ListNotations.

Open Scope Q_scope.

(** The same number, as a whole one if it is. *)
Definition lowest (q : Q) : Q := let n := inject_Z (Qnum q / QDen q) in if Qeq_bool n q then n else q.

Definition in_unit (D : Z) q := lowest (q * inject_Z D).
Definition spot_in D (X : spot) : spot := (in_unit D (q_x X), in_unit D (q_y X), in_unit D (q_z X)).
Definition sizes_in D J r := Sizes (in_unit D (s_alpha r)) (in_unit D (s_gamma r)) (in_unit D (s_b r)) (in_unit D (s_d r))
  (spot_in J (s_axis r)).

(** Points are given as offsets from the centre, in multiples of b. *)
Definition place_of r (C o : spot) : spot := (q_x C + s_b r * q_x o, q_y C + s_b r * q_y o, q_z C + s_b r * q_z o).

(** Lengths are counted in units of 1/D, the axis in units of 1/J. *)
Definition check_tilted (row : sizes) (centre : spot) (D J : Z) (claim : position) (tangent : bool) (proof : witness) : bool :=
  let r := sizes_in D J row in let C := spot_in D centre in
  (0 <? D)%Z && (0 <? J)%Z && valid_sizes r && match claim, tangent, proof with
  | Exterior, false, Clear l => less 0 l && check_sweep r l C C
  | Interior, false, Clear l => less l 0 && check_sweep r l C C
  | Contact, true, Touch m X u => check_touch r m C (place_of r C X) u
  | Contact, false, Among offsets => check_through r C (map (place_of r C) offsets)
  | _, _, _ => false end.

Definition at_time (S E : spot) t : spot := (lowest (q_x S + t * (q_x E - q_x S)), lowest (q_y S + t * (q_y E - q_y S)),
  lowest (q_z S + t * (q_z E - q_z S))).

(** Pieces of a sweep, each a multiplier and the time at which the piece ends: clear from [from] to [target]. *)
Fixpoint check_pieces r S E from (pieces : list (Q * Q)) target : bool := match pieces with
  | [] => false
  | (l, till) :: rest => less from till && check_sweep r l (at_time S E from) (at_time S E till)
      && (Qle_bool target till || check_pieces r S E till rest target) end.

Definition check_contact r C (proof : witness) := match proof with
  | Touch m X u => check_touch r m C (place_of r C X) u
  | Among offsets => check_meeting r C (map (place_of r C) offsets)
  | Clear _ => false end.

(** Clear on the whole sweep, or the first contact between two times, with contact at a time between them. *)
Inductive passage := NoContact | FirstBetween (lower upper time : Q) (proof : witness).

Definition check_passage (row : sizes) (start finish : spot) (D J : Z) (pieces : list (Q * Q)) (claim : passage) : bool :=
  let r := sizes_in D J row in let S := spot_in D start in let E := spot_in D finish in
  (0 <? D)%Z && (0 <? J)%Z && valid_sizes r && match claim with
  | NoContact => check_pieces r S E 0 pieces 1
  | FirstBetween lower upper time proof => Qle_bool 0 lower && Qle_bool upper 1 && Qle_bool lower time && Qle_bool time upper
      && check_contact r (at_time S E time) proof && (Qeq_bool lower 0 || check_pieces r S E 0 pieces lower) end.

(** ** Soundness. *)

Open Scope R_scope.

Lemma lowest_is q : Q2R (lowest q) = Q2R q.
Proof.
  unfold lowest; destruct (Qeq_bool (inject_Z (Qnum q / QDen q)) q) eqn:E; [apply eq_true in E; exact E | reflexivity].
Qed.
Lemma whole_is z : Q2R (inject_Z z) = IZR z.
Proof. unfold Q2R; cbn; field. Qed.
Lemma in_unit_is D q : Q2R (in_unit D q) = IZR D * Q2R q.
Proof. unfold in_unit; rewrite lowest_is, Q2R_mult, whole_is; ring. Qed.
Lemma spot_in_is D X : real (spot_in D X) = scale (IZR D) (real X).
Proof. unfold real, spot_in, scale; cbn [q_x q_y q_z fst snd px py pz]; rewrite !in_unit_is; reflexivity. Qed.
Lemma at_time_is S E t : real (at_time S E t) = between (real S) (real E) (Q2R t).
Proof.
  unfold real, at_time, between, add, scale, sub; cbn [q_x q_y q_z fst snd px py pz]; rewrite !lowest_is; to_reals; reflexivity.
Qed.

Section Units.

Variables (row : sizes) (D J : Z).
Hypotheses (HD : (0 <? D)%Z = true) (HJ : (0 <? J)%Z = true) (Valid : valid_sizes (sizes_in D J row) = true).
Let r := sizes_in D J row.
Let k := IZR D.
Let j := IZR J.

Let K : 0 < k.
Proof. apply IZR_lt, Z.ltb_lt; exact HD. Qed.
Let J0 : 0 < j.
Proof. apply IZR_lt, Z.ltb_lt; exact HJ. Qed.

Definition given (C : point) := tilted (Q2R (s_alpha row)) (Q2R (s_gamma row)) (Q2R (s_b row)) (Q2R (s_d row)) (real (s_axis row)) C.

Lemma given_valid C : valid (given C).
Proof.
  destruct (sizes_positive r Valid) as (H1 & H2 & H3 & H4 & H5); unfold r, sizes_in in H1, H2, H3, H4, H5;
    cbn [s_alpha s_gamma s_b s_d s_axis] in *; rewrite !in_unit_is in *; rewrite spot_in_is in H5; fold k j in H1, H2, H3, H4, H5.
  assert (P : forall x, 0 < k * x -> 0 < x) by (intros x H; apply Rmult_lt_reg_l with k; lra).
  unfold given, tilted; repeat split; cbn [alpha gamma b d axis]; try (apply P; assumption).
  apply Rmult_lt_reg_l with (j * j); [apply Rmult_lt_0_compat; exact J0 |]; rewrite Rmult_0_r.
  replace (j * j * dot (real (s_axis row)) (real (s_axis row))) with (dot (scale j (real (s_axis row))) (scale j (real (s_axis row))))
    by (unfold dot, scale; cbn [px py pz]; ring); exact H5.
Qed.

Lemma units_are C C' : real C' = scale k C -> tilted_in r C' = let p := given C in
  Pair (k * alpha p) (k * gamma p) (k * b p) (k * d p) (scale j (axis p)) (scale k (centre p)).
Proof.
  intros E; unfold tilted_in, tilted, r, sizes_in; cbn [s_alpha s_gamma s_b s_d s_axis given tilted alpha gamma b d axis centre].
  rewrite !in_unit_is, spot_in_is, E; reflexivity.
Qed.

Theorem in_any_unit C C' : real C' = scale k C ->
  (exterior (tilted_in r C') -> exterior (given C)) /\ (interior (tilted_in r C') -> interior (given C))
  /\ (contact (tilted_in r C') -> contact (given C)) /\ (tangent_outside (tilted_in r C') -> tangent_outside (given C))
  /\ (tangent_inside (tilted_in r C') -> tangent_inside (given C)).
Proof. intros E; rewrite (units_are C C' E); apply same_positions; [exact K | exact J0 | apply given_valid]. Qed.

Theorem crossing_in_any_unit C C' : real C' = scale k C -> crosses_at (tilted_in r C') \/ crosses_inside (tilted_in r C') ->
  crosses_at (given C) \/ crosses_inside (given C).
Proof.
  intros E; rewrite (units_are C C' E); pose proof (same_crossing (given C) k j K J0 (given_valid C)) as [S1 S2].
  intros [H | H]; [left; apply S1 | right; apply S2]; exact H.
Qed.

Definition is_clear p := exterior p \/ interior p.

Lemma mixed_place S E f t w : real f = scale k S -> real t = scale k E -> between (real f) (real t) w = scale k (between S E w).
Proof. intros -> ->; apply point_eq; unfold between, add, scale, sub; cbn [px py pz]; ring. Qed.

Lemma clear_piece l C E S T w : real C = scale k S -> real E = scale k T -> check_sweep r l C E = true -> 0 <= w <= 1 ->
  is_clear (given (between S T w)) /\ (0 < Q2R l -> exterior (given (between S T w))) /\ (Q2R l < 0 -> interior (given (between S T w))).
Proof.
  intros HC HE H W; destruct (check_sweep_sound r Valid l C E w H W) as [P N]; rewrite (mixed_place S T C E w HC HE) in P, N.
  assert (U : tilted (Q2R (s_alpha r)) (Q2R (s_gamma r)) (Q2R (s_b r)) (Q2R (s_d r)) (real (s_axis r)) (scale k (between S T w))
    = let p := given (between S T w) in
      Pair (k * alpha p) (k * gamma p) (k * b p) (k * d p) (scale j (axis p)) (scale k (centre p))).
  { unfold tilted, r, sizes_in; cbn [s_alpha s_gamma s_b s_d s_axis given tilted alpha gamma b d axis centre].
    rewrite !in_unit_is, spot_in_is; reflexivity. }
  rewrite U in P, N; pose proof (same_positions (given (between S T w)) k j K J0 (given_valid _)) as (X & I & _).
  assert (P' : 0 < Q2R l -> exterior (given (between S T w))) by (intros L; apply X, P, L).
  assert (N' : Q2R l < 0 -> interior (given (between S T w))) by (intros L; apply I, N, L).
  repeat split; try assumption; unfold check_sweep in H; bools; rewrite Q2R_0 in *; unfold is_clear.
  destruct (Rdichotomy (Q2R l) 0 ltac:(assumption)); [right | left]; auto.
Qed.

Variables S E : spot.
Let at_real t := between (real S) (real E) t.

Lemma time_in_units t : real (at_time (spot_in D S) (spot_in D E) t) = scale k (at_real (Q2R t)).
Proof.
  rewrite at_time_is, !spot_in_is; fold k; unfold at_real; apply point_eq; unfold between, add, scale, sub; cbn [px py pz]; ring.
Qed.

Theorem pieces_are_clear pieces : forall from target t, check_pieces r (spot_in D S) (spot_in D E) from pieces target = true ->
  Q2R from <= t <= Q2R target -> is_clear (given (at_real t)).
Proof.
  induction pieces as [| [l till] rest IH]; cbn [check_pieces]; intros from target t H T; [discriminate |]; bools.
  destruct (Rle_dec t (Q2R till)) as [L | N].
  - match goal with H : check_sweep _ _ _ _ = true |- _ =>
      destruct (clear_piece l _ _ _ _ ((t - Q2R from) / (Q2R till - Q2R from)) (time_in_units from) (time_in_units till) H) as [P _] end.
    + split; [apply over_pos; lra |]; apply Rmult_le_reg_r with (Q2R till - Q2R from); [lra |].
      unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra.
    + match type of P with is_clear (given ?c) => replace (at_real t) with c; [exact P |] end.
      unfold at_real; apply point_eq; unfold between, add, scale, sub; cbn [px py pz]; field; lra.
  - match goal with H : (_ || _)%bool = true |- _ => apply orb_prop in H; destruct H as [H | H] end; [bools; lra |].
    apply (IH till target); [assumption | lra].
Qed.

Theorem contact_is_there C C' proof : real C' = scale k C -> check_contact r C' proof = true -> contact (given C).
Proof.
  intros U H; destruct (in_any_unit C C' U) as (_ & _ & X & _); apply X; destruct proof; cbn [check_contact] in H; [discriminate | |].
  - destruct (check_touch_sound r Valid _ _ _ _ H) as [[T _] | [T _]]; exact T.
  - apply (check_meeting_sound r Valid) with (map (place_of r C') points); exact H.
Qed.

End Units.

(** What a row with a label says of the two bodies. *)
Definition tilted_label row C claim tangent := let p := given row (real C) in match claim, tangent with
  | Exterior, _ => exterior p | Interior, _ => interior p
  | Contact, true => tangent_outside p \/ tangent_inside p
  | Contact, false => contact p /\ (crosses_at p \/ crosses_inside p) end.

Theorem check_tilted_sound row C D J claim tangent proof :
  check_tilted row C D J claim tangent proof = true -> tilted_label row C claim tangent.
Proof.
  unfold check_tilted; intros H; bools.
  match goal with HD : (0 <? D)%Z = true, HJ : (0 <? J)%Z = true, V : valid_sizes _ = true |- _ =>
    pose proof (in_any_unit row D J HD HJ V (real C) (spot_in D C) (spot_in_is D C)) as (X & I & CC & TO & TI);
    pose proof (crossing_in_any_unit row D J HD HJ V (real C) (spot_in D C) (spot_in_is D C)) as CR;
    pose proof (clear_piece row D J HD HJ V) as CP; rename V into Valid end.
  assert (Same : between (real C) (real C) 0 = real C) by (apply point_eq; unfold between, add, scale, sub; cbn [px py pz]; ring).
  destruct claim, tangent, proof; try discriminate; cbn [tilted_label]; bools; rewrite ?Q2R_0 in *.
  - match goal with H : check_sweep _ _ _ _ = true |- _ =>
      destruct (CP l _ _ (real C) (real C) 0 (spot_in_is D C) (spot_in_is D C) H ltac:(lra)) as (_ & P & _) end.
    rewrite Same in P; apply P; assumption.
  - match goal with H : check_touch _ _ _ _ _ = true |- _ => destruct (check_touch_sound _ Valid _ _ _ _ H) as [T | T] end;
      [left; apply TO | right; apply TI]; exact T.
  - match goal with H : check_through _ _ _ = true |- _ => destruct (check_through_sound _ Valid _ _ H) as [A B] end.
    split; [apply CC; exact A | apply CR; exact B].
  - match goal with H : check_sweep _ _ _ _ = true |- _ =>
      destruct (CP l _ _ (real C) (real C) 0 (spot_in_is D C) (spot_in_is D C) H ltac:(lra)) as (_ & _ & P) end.
    rewrite Same in P; apply P; assumption.
Qed.

(** What an answer about a sweep says: of the position at every time t, or up to the first contact. *)
Definition passage_holds row S E claim := let at_t t := given row (between (real S) (real E) t) in match claim with
  | NoContact => forall t, 0 <= t <= 1 -> is_clear (at_t t)
  | FirstBetween lower upper _ _ => (forall t, 0 <= t < Q2R lower -> is_clear (at_t t))
      /\ exists t, 0 <= t <= 1 /\ Q2R lower <= t <= Q2R upper /\ contact (at_t t) end.

Theorem check_passage_sound row S E D J pieces claim :
  check_passage row S E D J pieces claim = true -> passage_holds row S E claim.
Proof.
  unfold check_passage; intros H; bools.
  match goal with HD : (0 <? D)%Z = true, HJ : (0 <? J)%Z = true, V : valid_sizes _ = true |- _ =>
    pose proof (pieces_are_clear row D J HD HJ V S E pieces) as PC;
    pose proof (contact_is_there row D J HD HJ V) as CT end.
  destruct claim as [| lower upper time proof]; cbn [passage_holds].
  - intros t T; apply (PC 0%Q 1%Q); [assumption |]; rewrite Q2R_0, Q2R_1; exact T.
  - bools; rewrite ?Q2R_0, ?Q2R_1 in *; split.
    + intros t T; match goal with H : (_ || _)%bool = true |- _ => apply orb_prop in H; destruct H as [H | H] end.
      * bools; rewrite Q2R_0 in *; lra.
      * apply (PC 0%Q lower); [assumption |]; rewrite Q2R_0; lra.
    + exists (Q2R time); repeat split; try lra.
      apply (CT _ (at_time (spot_in D S) (spot_in D E) time) proof); [apply time_in_units | assumption].
Qed.
