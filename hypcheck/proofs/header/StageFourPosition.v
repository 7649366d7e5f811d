(** Stage 4: what the text of hc_position_beside_tangency returns on a valid row is what Stages.v answers, or 2.

    It rests on what the functions that it calls return: of hc_position_in_plane, hc_touches_by_short and hc_touches_by their texts do
    (StageFourPlane.v, StageFourShort.v, StageFourTouches.v). *)

Require Import List String ZArith Reals Lra Lia Bool.
From Hypcheck Require Import Geometry Geometry Tangency Steps Fixed FixedRuns Limbs Trees StageThreeRuns StageThreeAnswers StageThreeNumbers StageThreePosition
  Stages Positions StageFour StageFourSteps StageFourGuesses StageFourBeside.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** ** Tangencies and hairs. *)

Section Hairs.
Variables alpha gamma b d x y z x0 y0 z0 : R.
Hypotheses (Ha : (0 < alpha)%R) (Hg : (0 < gamma)%R) (Hb : (0 < b)%R) (Hd : (0 < d)%R).
Open Scope R_scope.
Lemma touching_squares inner x1 y1 z1 : x1 ^ 2 = x ^ 2 -> y1 ^ 2 = y ^ 2 -> z1 ^ 2 = z ^ 2 -> touching inner alpha gamma b d x1 y1 z1 -> touching inner alpha gamma b d x y z.
Proof.
  intros X Y Z (M & e & T); exists M, e; destruct inner; (destruct T as ((E1 & E2 & E3) & T); split; [| exact T]);
    unfold tangency_equations, n2_of, n1_of in *; rewrite <- X, <- Y, <- Z; repeat split; assumption.
Qed.

(** A row of which x and y, or z, may be hairs that were left out: a side from which the bare one touches. *)
Definition answer_beside (inner radial axial : bool) := if inner then if axial then Interior else Contact else if radial then Exterior else Contact.
Theorem beside_is_answered inner radial axial : touching inner alpha gamma b d x0 y0 z0 -> radial && axial = false ->
  (if radial then (x0 = x \/ (x0 = 0 /\ x ^ 2 <= b ^ 2 / 2)) /\ (y0 = y \/ (y0 = 0 /\ y ^ 2 <= b ^ 2 / 2)) /\ x0 ^ 2 + y0 ^ 2 < x ^ 2 + y ^ 2 else x0 = x /\ y0 = y) ->
  (if axial then z0 = 0 /\ z <> 0 /\ z ^ 2 * alpha <= 4 * b * gamma ^ 2 else z0 = z) -> answers alpha gamma b d x y z (answer_beside inner radial axial).
Proof.
  intros (M & e & T) Both Rad Ax; unfold answer_beside; destruct inner, radial, axial; try discriminate Both; cbn [andb] in *.
  - subst z0; destruct Rad as (X & Y & L); apply hair_outwards with x0 y0 M e; [exact T | lra |].
    assert (Q : forall r s, s = r \/ (s = 0 /\ r ^ 2 <= b ^ 2 / 2) -> (r - s) ^ 2 <= b ^ 2 / 2).
    { intros r s [-> | [-> H]]; [replace (r - r) with 0 by ring; pose proof (pow2_ge_0 b); lra | rewrite Rminus_0_r; exact H]. }
    pose proof (Q x x0 X); pose proof (Q y y0 Y); lra.
  - destruct Rad as [-> ->], Ax as (-> & Z & _); apply hair_inside with M e; assumption.
  - destruct Rad as [-> ->]; subst z0; apply touching_within with M e; exact T.
  - destruct Rad as (X & Y & L); subst z0; apply hair_outside with x0 y0 M e; assumption.
  - destruct Rad as [-> ->], Ax as (-> & _ & Z); apply hair_upwards with M e; assumption.
  - destruct Rad as [-> ->]; subst z0; apply touching_without with M e; exact T.
Qed.
End Hairs.

(** ** The run. *)

Section Run.
Variables (m e : string -> Z) (hair : Z -> Z -> Z * Z) (plane short long : list datum -> option datum) (put_lengths : list datum -> option (list datum)) (about : datum).
Hypotheses (About : is_float about) (Sizes : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < m n < 2 ^ 53) (Centre : forall n, In n ["x"; "y"; "z"] -> Z.abs (m n) < 2 ^ 53)
  (Powers : forall n, In n named -> -4096 <= e n <= 2046).
(** The product of 10^-18 and a length, as floats compute it, where a coordinate is shorter: a hair. *)
Definition hair_value w := (IZR (fst (hair (m w) (e w))) * power (snd (hair (m w) (e w)) - 1075))%R.
Definition hairs_are_short := forall n w, In (n, w) [("x", "b"); ("y", "b"); ("z", "gamma")] -> is_hair m e hair n w = true -> (hair_value w <= value_of m e w / 2 ^ 31)%R.
Hypothesis Hair : hairs_are_short.

Definition holds_row (l : list (string * datum)) (m e : string -> Z) := forall p n, In (p, n) (combine ["0"; "1"; "2"; "3"; "4"; "5"; "6"] named) -> look p l = Some (Double (m n) (e n)).
Definition is_row (m e : string -> Z) := (forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < m n) /\ (forall n, In n named -> Z.abs (m n) < 2 ^ 53) /\ forall n, In n named -> -4096 <= e n <= 2046.
Definition are_lengths (m e : string -> Z) (ls : string -> Z) bits u w := (forall n, In n named -> 0 <= ls n < 2 ^ bits) /\ (0 < u)%R /\ (0 < w)%R
  /\ forall n, In n named -> (IZR (ls n) * (if is_in n ["gamma"; "d"; "z"] then w else u) = Rabs (value_of m e n))%R.
Definition puts_lengths := forall l m e, holds_row l m e -> is_row m e -> exists bits got ls, put_lengths [Rec l] = Some [Of Int bits; Rec got]
  /\ (bits <= 62 -> got = words_of_lengths ls /\ exists u w, are_lengths m e ls bits u w).
Definition decides_in_plane := forall ls, (forall n, In n named -> 0 <= ls n < 2 ^ 62) -> (forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < ls n) ->
  exists o, plane [Rec (words_of_lengths ls)] = Some (Of Int (code o)) /\
    forall a u w x y, (0 < u)%R -> (0 < w)%R -> o = Some a -> (x ^ 2 = (IZR (ls "x") * u) ^ 2)%R -> (y ^ 2 = (IZR (ls "y") * u) ^ 2)%R ->
    answers (IZR (ls "alpha") * u) (IZR (ls "gamma") * w) (IZR (ls "b") * u) (IZR (ls "d") * w) x y 0 a.
Definition decides_touching (f : list datum -> option datum) bits := forall ls, (forall n, In n named -> 0 <= ls n < 2 ^ bits) -> (forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < ls n) ->
  exists r, f [Rec (words_of_lengths ls); about] = Some (Of Int r) /\ is_side ls r.
Hypotheses (Lengths : puts_lengths) (Plane : decides_in_plane) (Short : decides_touching short 23) (Long : decides_touching long 62).

Definition called_beside (given : list datum) : option datum := try f <- look "hc_position_beside_tangency" functions;
  try now <- bound_all (map Named (takes f)) given [("_1e-18", Opaque "1e-18" 0)];
  try (v, _) <- go (of_beside hair plane short long) (procedures put_lengths) steps now (does f); v.
Notation hx := (is_hair m e hair "x" "b").
Notation hy := (is_hair m e hair "y" "b").
Notation hz := (is_hair m e hair "z" "gamma").
Notation bare_m := (bare_m m e hair).
Notation bare_e := (bare_e m e hair).

Lemma bare_row : holds_row (fields "bare" (behind_loop m e hair about)) bare_m bare_e /\ eval (of_beside hair plane short long) (behind_loop m e hair about) (Named "bare") = Some (Rec (fields "bare" (behind_loop m e hair about)))
  /\ look "radial" (behind_loop m e hair about) = Some (Of Int (bit (hx || hy))) /\ look "axial" (behind_loop m e hair about) = Some (Of Int (bit hz))
  /\ look "about" (behind_loop m e hair about) = Some about /\ look "lengths" (behind_loop m e hair about) = None /\ fields "lengths" (behind_loop m e hair about) = [].
Proof.
  unfold behind_loop, behind_turn, turned, StageFourBeside.bare_m, StageFourBeside.bare_e; destruct hx eqn:X, hy eqn:Y, hz eqn:Z.
  all: split; [| repeat split; reflexivity].
  all: intros p n I; cbv [combine named StageThreeRuns.lengths In] in I; repeat (destruct I as [I | I]; [injection I as <- <-; unfold is_bare; cbn [is_in is existsb String.eqb Ascii.eqb Bool.eqb orb]; rewrite ?X, ?Y, ?Z; reflexivity |]); contradiction.
Qed.

(** Hairs as lengths. *)
Notation V := (value_of m e).
Notation V0 := (value_of bare_m bare_e).
Lemma below_is k p j q : below k p j q = true -> (IZR k * power (p - 1075) < IZR j * power (q - 1075))%R.
Proof.
  unfold below, in_unit; intros H; apply Z.ltb_lt, IZR_lt in H; rewrite !mult_IZR, !power_whole in H by lia.
  set (u := Z.min p q) in *; replace (Z.min q p) with u in H by (unfold u; lia).
  replace (p - 1075) with (p - u + (u - 1075)) by ring; replace (q - 1075) with (q - u + (u - 1075)) by ring.
  rewrite !power_sum, <- !Rmult_assoc; apply Rmult_lt_compat_r; [apply power_positive | exact H].
Qed.
Lemma size_is n : Rabs (V n) = (IZR (Z.abs (m n)) * power (e n - 1075))%R.
Proof. unfold value_of; rewrite Rabs_mult, <- abs_IZR, (Rabs_pos_eq (power _)); [reflexivity | apply Rlt_le, power_positive]. Qed.
Lemma hair_between n w : is_hair m e hair n w = true -> 0 < Z.abs (m n) /\ (Rabs (V n) < hair_value w)%R.
Proof. intros H; apply andb_prop in H as [N B]; apply Z.ltb_lt in N; apply below_is in B; rewrite <- size_is in B; split; [exact N | exact B]. Qed.
Lemma hair_is n w : In (n, w) [("x", "b"); ("y", "b"); ("z", "gamma")] -> is_hair m e hair n w = true -> (V n <> 0 /\ V n ^ 2 <= (V w / 2 ^ 31) ^ 2)%R.
Proof.
  intros W H; pose proof (Hair n w W H) as L; apply hair_between in H as [N B]; split.
  - intros Z0; unfold value_of in Z0; apply Rmult_integral in Z0 as [Z0 | Z0]; [apply eq_IZR in Z0; lia | pose proof (power_positive (e n - 1075)); lra].
  - rewrite <- (pow2_abs (V n)); apply pow_incr; split; [apply Rabs_pos | lra].
Qed.
Lemma bare_values n : V0 n = if is_bare m e hair n then 0%R else V n.
Proof. unfold value_of, StageFourBeside.bare_m, StageFourBeside.bare_e; destruct (is_bare m e hair n); [apply Rmult_0_l | reflexivity]. Qed.
Lemma bare_is_row : is_row bare_m bare_e.
Proof.
  unfold is_row, StageFourBeside.bare_m, StageFourBeside.bare_e; split; [| split].
  - intros n I; assert (B : is_bare m e hair n = false) by (destruct I as [<- | [<- | [<- | [<- | []]]]]; reflexivity); rewrite B; apply Sizes, I.
  - intros n I; destruct (is_bare m e hair n); [reflexivity |]; destruct I as [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]];
      first [apply Centre; cbn; tauto | rewrite Z.abs_eq by (apply Z.lt_le_incl, Sizes; cbn; tauto); apply Sizes; cbn; tauto].
  - intros n I; destruct (is_bare m e hair n); [lia | apply Powers, I].
Qed.
Lemma size_positive n : In n ["alpha"; "gamma"; "b"; "d"] -> (0 < V n)%R.
Proof. intros I; apply Rmult_lt_0_compat; [apply IZR_lt, Sizes, I | apply power_positive]. Qed.

Definition returned bits ls o by_short by_long := answered (hx || hy) hz bits ls o by_short by_long.
Lemma beside_text bits got ls o by_short by_long : put_lengths [Rec (fields "bare" (behind_loop m e hair about))] = Some [Of Int bits; Rec got] -> (bits <= 62 -> got = words_of_lengths ls) ->
  (bits <= 62 -> plane [Rec (words_of_lengths ls)] = Some (Of Int (code o))) -> (bits <= 23 -> short [Rec (words_of_lengths ls); about] = Some (Of Int by_short)) ->
  (bits <= 62 -> long [Rec (words_of_lengths ls); about] = Some (Of Int by_long)) -> called_beside [row m e; about] = Some (Of Int (returned bits ls o by_short by_long)).
Proof.
  intros P G A B C; destruct bare_row as (_ & Bare & R & X & O & N1 & N2); unfold called_beside; rewrite text_is; cbn [takes does].
  assert (Begun : bound_all (map Named ["row"; "about"]) [row m e; about] [("_1e-18", Opaque "1e-18" 0)] = Some (begun_row m e about)) by (cbn [bound_all map]; rewrite (bound_float _ _ _ About); reflexivity).
  rewrite Begun; change steps with (4 + (4 + (6 + (6 + 80))))%nat.
  assert (First : forall f rest, go (of_beside hair plane short long) (procedures put_lengths) (4 + f) (begun_row m e about) ([Set_ "int" "radial" (Constant Int 0); Set_ "int" "axial" (Constant Int 0);
    Set_ "" "bare" (Named "row"); Set_ "" "i" (Constant Int 4)] ++ rest)%list = go (of_beside hair plane short long) (procedures put_lengths) f (before_loop m e about) rest).
  { intros f rest; cbn [app Nat.add]; do 4 (erewrite go_put; [| reflexivity | reflexivity | reflexivity]; cbv [bound app map fst snd append]); reflexivity. }
  change ([Set_ "int" "radial" (Constant Int 0); Set_ "int" "axial" (Constant Int 0); Set_ "" "bare" (Named "row"); Set_ "" "i" (Constant Int 4); turns] ++ asks)%list
    with ([Set_ "int" "radial" (Constant Int 0); Set_ "int" "axial" (Constant Int 0); Set_ "" "bare" (Named "row"); Set_ "" "i" (Constant Int 4)] ++ turns :: asks)%list.
  rewrite First, loop_run.
  destruct (asks_run hair plane short long put_lengths (behind_loop m e hair about) (hx || hy) hz (fields "bare" (behind_loop m e hair about)) about bits got ls o by_short by_long R X Bare) with (f := 80%nat) as (now & N);
    [exact O | split; assumption | intros _; exact P | assumption .. |].
  change (6 + (6 + 80))%nat with (12 + 80)%nat; rewrite N; reflexivity.
Qed.

(** What the text returns is what Stages.v answers, or 2. *)
Theorem beside_is_right : exists o, called_beside [row m e; about] = Some (Of Int (code o)) /\
  forall a, o = Some a -> answers (V "alpha") (V "gamma") (V "b") (V "d") (V "x") (V "y") (V "z") a.
Proof.
  destruct bare_row as (Row & _); destruct (Lengths _ _ _ Row bare_is_row) as (bits & got & ls & P & G).
  destruct (Z.le_gt_cases bits 62) as [B | B].
  2: { exists None; split; [| discriminate]; rewrite (beside_text bits got ls None 2 2 P) by (intros; lia); unfold returned, answered; destruct ((hx || hy) && hz); [reflexivity |].
    rewrite (proj2 (Z.ltb_lt 62 bits)) by lia; reflexivity. }
  destruct (G B) as (EG & u & w & Fit & U & W & Same).
  assert (Fit62 : forall n, In n named -> 0 <= ls n < 2 ^ 62).
  { intros n I; pose proof (Fit n I); assert (2 ^ bits <= 2 ^ 62) by (apply Z.pow_le_mono_r; lia); lia. }
  assert (same_size : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> (IZR (ls n) * (if is_in n ["gamma"; "d"; "z"] then w else u) = V n)%R).
  { intros n I; rewrite Same by (clear - I; cbn in *; tauto); rewrite bare_values.
    assert (E : is_bare m e hair n = false) by (destruct I as [<- | [<- | [<- | [<- | []]]]]; reflexivity); rewrite E; apply Rabs_pos_eq, Rlt_le, size_positive, I. }
  assert (positive : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < ls n).
  { intros n I; apply lt_IZR; apply Rmult_lt_reg_r with (if is_in n ["gamma"; "d"; "z"] then w else u); [destruct (is_in n _); assumption |].
    rewrite Rmult_0_l, same_size by exact I; apply size_positive, I. }
  destruct (Plane ls Fit62 positive) as (o & EP & AP), (Long ls Fit62 positive) as (rl & EL & SL).
  assert (S23 : exists r, (bits <= 23 -> short [Rec (words_of_lengths ls); about] = Some (Of Int r)) /\ (bits <= 23 -> is_side ls r)).
  { destruct (Z.le_gt_cases bits 23) as [B23 | B23]; [| exists 2; split; intros; lia].
    destruct (Short ls) as (r & E & Si); [| exact positive | exists r; split; intros _; assumption].
    intros n I; pose proof (Fit n I); assert (2 ^ bits <= 2 ^ 23) by (apply Z.pow_le_mono_r; lia); lia. }
  destruct S23 as (rs & ES & SS).
  rewrite (beside_text bits got ls o rs rl P (fun _ => EG) (fun _ => EP) ES (fun _ => EL)); unfold returned, answered.
  rewrite (proj2 (Z.ltb_ge 62 bits) B); destruct ((hx || hy) && hz) eqn:Both; [exists None; split; [reflexivity | discriminate] |].
  pose proof (same_size "alpha" ltac:(cbn; tauto)) as Ea; pose proof (same_size "gamma" ltac:(cbn; tauto)) as Eg; pose proof (same_size "b" ltac:(cbn; tauto)) as Eb; pose proof (same_size "d" ltac:(cbn; tauto)) as Ed.
  pose proof (Same "x" ltac:(cbn; tauto)) as Ex; pose proof (Same "y" ltac:(cbn; tauto)) as Ey; pose proof (Same "z" ltac:(cbn; tauto)) as Ez.
  cbn [is_in existsb String.eqb Ascii.eqb Bool.eqb orb] in Ea, Eg, Eb, Ed, Ex, Ey, Ez.
  assert (sq : forall k v, (k = Rabs v -> k ^ 2 = v ^ 2)%R) by (intros k v ->; apply pow2_abs).
  apply sq in Ex as Qx; apply sq in Ey as Qy; apply sq in Ez as Qz; rewrite bare_values in Qx, Qy, Qz, Ez; unfold is_bare in Qx, Qy, Qz, Ez;
    cbn [is is_in existsb String.eqb Ascii.eqb Bool.eqb orb] in Qx, Qy, Qz, Ez.
  destruct (negb (hx || hy || hz || negb (ls "z" =? 0)) && negb (code o =? 2)) eqn:In_plane.
  - exists o; split; [reflexivity |]; intros a E; apply andb_prop in In_plane as [H _]; apply negb_true_iff in H; apply orb_false_elim in H as [H Z0]; apply orb_false_elim in H as [H Hz];
      apply orb_false_elim in H as [Hx Hy]; apply negb_false_iff, Z.eqb_eq in Z0; rewrite Hx in Qx; rewrite Hy in Qy; rewrite Hz, Z0, Rmult_0_l in Ez.
    assert (V "z" = 0%R) as -> by (destruct (Req_dec (V "z") 0) as [E0 | E0]; [exact E0 | apply Rabs_no_R0 in E0; congruence]).
    rewrite <- Ea, <- Eg, <- Eb, <- Ed; apply (AP a u w); congruence || assumption.
  - assert (Si : is_side ls (side bits rs rl)) by (unfold side; destruct (Z.leb_spec bits 23); [apply SS | apply SL]; assumption).
    unfold of_side; destruct Si as [-> | (inner & -> & T)]; [exists None; split; [reflexivity | discriminate] |].
    exists (Some (answer_beside inner (hx || hy) hz)); split; [destruct inner, (hx || hy), hz; reflexivity |]; intros a E; injection E as <-.
    specialize (T u w U W); rewrite Ea, Eg, Eb, Ed in T.
    apply (beside_is_answered _ _ _ _ _ _ _ (if hx then 0 else V "x")%R (if hy then 0 else V "y")%R (if hz then 0 else V "z")%R); try (apply size_positive; cbn; tauto); try assumption.
    + exact (touching_squares _ _ _ _ _ _ _ inner _ _ _ Qx Qy Qz T).
    + assert (small : forall n, In n ["x"; "y"] -> is_hair m e hair n "b" = true -> (V n <> 0 /\ V n ^ 2 <= V "b" ^ 2 / 2)%R).
      { intros n In_ H; destruct (hair_is n "b") as [N L]; [destruct In_ as [<- | [<- | []]]; cbn; tauto | exact H |]; split; [exact N |]; pose proof (pow2_ge_0 (V "b")).
        replace ((V "b" / 2 ^ 31) ^ 2)%R with (V "b" ^ 2 / 2 ^ 62)%R in L by field; lra. }
      destruct hx eqn:HX, hy eqn:HY; cbn [orb]; try (split; reflexivity).
      * destruct (small "x" ltac:(cbn; tauto) HX) as [NX LX], (small "y" ltac:(cbn; tauto) HY) as [NY LY]; split; [right; split; [reflexivity | exact LX] |]; split; [right; split; [reflexivity | exact LY] |].
        pose proof (pow2_ge_0 (V "y")); assert (0 < V "x" ^ 2)%R by (apply square_pos; exact NX); lra.
      * destruct (small "x" ltac:(cbn; tauto) HX) as [NX LX]; split; [right; split; [reflexivity | exact LX] |]; split; [left; reflexivity |]; assert (0 < V "x" ^ 2)%R by (apply square_pos; exact NX); lra.
      * destruct (small "y" ltac:(cbn; tauto) HY) as [NY LY]; split; [left; reflexivity |]; split; [right; split; [reflexivity | exact LY] |]; assert (0 < V "y" ^ 2)%R by (apply square_pos; exact NY); lra.
    + destruct hz eqn:HZ; [| reflexivity]; destruct (hair_is "z" "gamma" ltac:(cbn; tauto) HZ) as [N L]; split; [reflexivity |]; split; [exact N |].
      assert (A62 : (V "alpha" <= V "b" * 2 ^ 62)%R).
      { rewrite <- Ea, <- Eb; pose proof (Fit62 "alpha" ltac:(cbn; tauto)) as [_ La]; pose proof (positive "b" ltac:(cbn; tauto)) as Lb.
        assert (IZR (ls "alpha") <= 2 ^ 62)%R by (rewrite (pow_IZR 2 62); apply IZR_le; change (2 ^ Z.of_nat 62)%Z with (2 ^ 62)%Z; lia).
        assert (1 <= IZR (ls "b"))%R by (apply (IZR_le 1); lia).
        apply Rle_trans with (2 ^ 62 * u)%R; [apply Rmult_le_compat_r; lra |].
        replace (IZR (ls "b") * u * 2 ^ 62)%R with (IZR (ls "b") * (2 ^ 62 * u))%R by ring; assert (0 <= 2 ^ 62 * u)%R by (apply Rmult_le_pos; lra).
        rewrite <- (Rmult_1_l (2 ^ 62 * u)) at 1; apply Rmult_le_compat_r; assumption. }
      replace ((V "gamma" / 2 ^ 31) ^ 2)%R with (V "gamma" ^ 2 / 2 ^ 62)%R in L by field.
      pose proof (size_positive "alpha" ltac:(cbn; tauto)); pose proof (size_positive "b" ltac:(cbn; tauto)); pose proof (pow2_ge_0 (V "gamma")).
      apply Rle_trans with (V "gamma" ^ 2 / 2 ^ 62 * (V "b" * 2 ^ 62))%R; [apply Rmult_le_compat; try lra; apply pow2_ge_0 |].
      replace (V "gamma" ^ 2 / 2 ^ 62 * (V "b" * 2 ^ 62))%R with (V "b" * V "gamma" ^ 2)%R by field.
      assert (0 <= V "b" * V "gamma" ^ 2)%R by (apply Rmult_le_pos; lra); lra.
Qed.
End Run.
