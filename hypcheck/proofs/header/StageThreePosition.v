(** Stage 3: what the text of the C answers is the position, for every valid row.

    StageThreeRuns.v and StageThreeAnswers.v run the text; StageThree.v leads from numbers beyond their bounds to the position. Here
    the numbers of the run are shown to be such as StageThree.v asks: squares of lengths in two units, and balanced ones. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Hypcheck Require Import Geometry UnitBall Rule Positions Steps Fixed FixedRuns Limbs ShiftRuns Computed Trees StageThree StageThreeRuns
  StageThreeAnswers StageThreeNumbers.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** A valid row: its doubles are whole numbers times powers of two. The centre may be 0. *)

Section Row.
Variables m e : string -> Z.
Hypotheses (Powers : forall n, In n lengths -> -4096 <= e n <= 2046)
  (Lengths : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 2 ^ 52 <= m n < 2 ^ 53) (Centre : forall n, In n ["x"; "y"; "z"] -> Z.abs (m n) < 2 ^ 53).
Lemma mantissas n : In n lengths -> Z.abs (m n) < 2 ^ 53.
Proof.
  assert (L : forall k, In k ["alpha"; "gamma"; "b"; "d"] -> Z.abs (m k) < 2 ^ 53) by (intros k I; pose proof (Lengths k I); lia).
  intros [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]; solve [apply L; cbn; tauto | apply Centre; cbn; tauto].
Qed.
Definition value_of n : R := (IZR (m n) * power (e n - 1075))%R.

(** What the C shifts by. *)
Let radial := Z.max (Z.max (e "alpha") (e "b")) (Z.max (e "x") (e "y")).
Let axial := Z.max (Z.max (e "gamma") (e "d")) (e "z").
Let small_p := 2 * (radial - e "alpha").
Let small_q := 2 * (radial - e "b").
Let small_s := 2 * (axial - e "gamma").
Let small_t := 2 * (axial - e "d").
Let small := Z.min small_q small_t.
Let by_q := small_q - small.
Let by_t := small_t - small.
Let shift n := if String.eqb n "by_q" then by_q else if String.eqb n "by_t" then by_t else 0.
Let top_3 := 0 - small_q - small_t.
Let top_0 := 0 - small_p - small_s.

Lemma below_most : (e "alpha" <= radial /\ e "b" <= radial /\ e "x" <= radial /\ e "y" <= radial)
  /\ e "gamma" <= axial /\ e "d" <= axial /\ e "z" <= axial.
Proof.
  unfold radial, axial; repeat split; repeat (first [reflexivity | apply Z.max_case_strong; intros; lia]).
Qed.
Lemma most_bounded : radial <= 2046 /\ axial <= 2046.
Proof. unfold radial, axial; split; repeat apply Z.max_lub; apply Powers; cbn; tauto. Qed.

Lemma powers_bounded : (0 <= small_p /\ 0 <= small_q /\ 0 <= small_s /\ 0 <= small_t)
  /\ (0 <= small <= 12284 /\ 0 <= by_q /\ 0 <= by_t) /\ (-24568 <= top_3 <= 0 /\ -24568 <= top_0 <= 0)
  /\ 0 <= 2 * (radial - e "x") /\ 0 <= 2 * (radial - e "y") /\ 0 <= 2 * (axial - e "z").
Proof.
  pose proof (Powers "alpha" ltac:(cbn; tauto)); pose proof (Powers "gamma" ltac:(cbn; tauto)); pose proof (Powers "b" ltac:(cbn; tauto));
    pose proof (Powers "d" ltac:(cbn; tauto)); destruct below_most as ((? & ? & ? & ?) & ? & ? & ?), most_bounded.
  unfold top_3, top_0, by_q, by_t, small, small_p, small_q, small_s, small_t; clearbody radial axial; lia.
Qed.
Lemma shifts n : 0 <= shift n.
Proof. destruct powers_bounded as (_ & (_ & Q & T) & _); unfold shift; destruct (String.eqb n "by_q"); [exact Q |]; destruct (String.eqb n "by_t"); [exact T | lia]. Qed.

Let whole_of n := (whole (Z.abs (m n)), IZR (units (m n))).
Let moved_of n by_ := (shifted_down (whole (Z.abs (m n))) by_, (IZR (units (m n)) / IZR (2 ^ by_))%R).
Let first_terms : beginnings := [("whole_p", whole_of "alpha"); ("whole_q", whole_of "b"); ("whole_s", whole_of "gamma"); ("whole_t", whole_of "d");
  ("p", moved_of "alpha" small_p); ("q", moved_of "b" small_q); ("s", moved_of "gamma" small_s); ("t", moved_of "d" small_t);
  ("xx", moved_of "x" (2 * (radial - e "x"))); ("yy", moved_of "y" (2 * (radial - e "y"))); ("S", moved_of "z" (2 * (axial - e "z")))].

Lemma first_terms_numbers n : is_number (first_number first_terms n).
Proof.
  assert (W : forall k, In k ["alpha"; "gamma"; "b"; "d"] -> is_number (whole (Z.abs (m k)))).
  { intros k I; apply (whole_stands (m k)); pose proof (Lengths k I); lia. }
  apply first_are_numbers; unfold first_terms, whole_of, moved_of; repeat apply Forall_cons; [.. | apply Forall_nil]; cbn [fst snd];
    match goal with |- is_number (whole _) => apply W; cbn; tauto | |- _ => apply down_stands end.
Qed.

(** A square of the row, in the unit that its kind has. *)
Lemma scaled n most : e n <= most ->
  IZR (units (m n)) = (value_of n ^ 2 * power (2170 - 2 * most) * power (2 * (most - e n)))%R.
Proof.
  intros L; unfold units, value_of; rewrite mult_IZR, Z.pow_2_r, mult_IZR, (power_whole 20) by lia.
  replace (power 20) with (power (e n - 1075) * power (e n - 1075) * power (2170 - 2 * most) * power (2 * (most - e n)))%R; [ring |].
  rewrite <- !power_sum; f_equal; ring.
Qed.
Lemma scaled_down n most : e n <= most ->
  (IZR (units (m n)) / IZR (2 ^ (2 * (most - e n))))%R = (value_of n ^ 2 * power (2170 - 2 * most))%R.
Proof.
  intros L; rewrite (scaled n most L), power_whole by lia; pose proof (power_positive (2 * (most - e n))); field; lra.
Qed.

Section Run.
Variables (num : string -> number) (x : string -> R).
Hypotheses (Begins : begins first_terms num x)
  (Terms : Forall (runs num x shift) C_terms) (At_B : Forall (runs num x shift) C_at_B) (At_A : Forall (runs num x shift) C_at_A)
  (Number_2 : num "n2" = minus (shifted_down (num "radial_2") by_t) (shifted_down (num "axial_2") by_q))
  (Value_2 : x "n2" = (x "radial_2" / IZR (2 ^ by_t) - x "axial_2" / IZR (2 ^ by_q))%R).

Lemma squares_hold : all_hold num x squares.
Proof.
  destruct powers_bounded as ((P & Q & S & T) & _ & _ & X & Y & Z).
  assert (W : forall n k, In k ["alpha"; "gamma"; "b"; "d"] -> num n = whole (Z.abs (m k)) /\ x n = IZR (units (m k)) -> holds num x n (Range (2 ^ 124) longest 0 0)).
  { intros n k I [N V]; apply (whole_holds num x n (m k) N V), Lengths, I. }
  assert (M : forall n k s, In k lengths -> 0 <= s -> num n = shifted_down (whole (Z.abs (m k))) s /\ x n = (IZR (units (m k)) / IZR (2 ^ s))%R
    -> holds num x n (Range 0 longest (-1) 0)).
  { intros n k s I S0 [N V]; refine (square_holds num x n (m k) s N V _ S0); apply mantissas, I. }
  apply each_holds; unfold squares; cbn [map app]; repeat constructor; cbn [fst snd].
  - apply (M "p" "alpha" small_p ltac:(cbn; tauto) P), Begins; reflexivity.
  - apply (M "q" "b" small_q ltac:(cbn; tauto) Q), Begins; reflexivity.
  - apply (M "s" "gamma" small_s ltac:(cbn; tauto) S), Begins; reflexivity.
  - apply (M "t" "d" small_t ltac:(cbn; tauto) T), Begins; reflexivity.
  - apply (M "xx" "x" _ ltac:(cbn; tauto) X), Begins; reflexivity.
  - apply (M "yy" "y" _ ltac:(cbn; tauto) Y), Begins; reflexivity.
  - apply (M "S" "z" _ ltac:(cbn; tauto) Z), Begins; reflexivity.
  - apply (W "whole_p" "alpha" ltac:(cbn; tauto)), Begins; reflexivity.
  - apply (W "whole_q" "b" ltac:(cbn; tauto)), Begins; reflexivity.
  - apply (W "whole_s" "gamma" ltac:(cbn; tauto)), Begins; reflexivity.
  - apply (W "whole_t" "d" ltac:(cbn; tauto)), Begins; reflexivity.
Qed.

Lemma two_hold : holds num x "n2" n2_range /\ holds num x "n1" (term "n1") /\ holds num x "N" (term "N") /\ holds num x "ps" (term "ps").
Proof.
  destruct powers_bounded as (_ & (_ & Q & T) & _).
  destruct (terms_hold num x shift Terms squares_hold T Q Number_2 Value_2) as (_ & _ & _ & H1 & H2 & _); split; [exact H2 | split; [exact H1 |]].
  pose proof (ranges_hold num x shift C_terms squares _ squares_hold Terms (proj1 terms_are)) as H; split; apply H; vm_compute; reflexivity.
Qed.

(** The exact values, in one unit. *)
Let in_radial := power (2170 - 2 * radial).
Let in_axial := power (2170 - 2 * axial).
Let scale := (in_radial * in_axial * value_of "b" ^ 2 * value_of "d" ^ 2)%R.
Let A := ((value_of "alpha" / value_of "b") ^ 2)%R.
Let B := ((value_of "gamma" / value_of "d") ^ 2)%R.
Let P := ((value_of "x" ^ 2 + value_of "y" ^ 2) / value_of "b" ^ 2)%R.
Let Q := ((value_of "z" / value_of "d") ^ 2)%R.

Lemma positive n : In n ["alpha"; "gamma"; "b"; "d"] -> (0 < value_of n)%R.
Proof.
  intros I; apply Rmult_lt_0_compat; [| apply power_positive]; apply IZR_lt; pose proof (Lengths n I); lia.
Qed.

Lemma squares_are : ((x "p" = value_of "alpha" ^ 2 * in_radial /\ x "q" = value_of "b" ^ 2 * in_radial)
  /\ (x "s" = value_of "gamma" ^ 2 * in_axial /\ x "t" = value_of "d" ^ 2 * in_axial) /\ x "xx" = value_of "x" ^ 2 * in_radial
  /\ x "yy" = value_of "y" ^ 2 * in_radial /\ x "S" = value_of "z" ^ 2 * in_axial)%R.
Proof.
  destruct below_most as ((M1 & M2 & M3 & M4) & M5 & M6 & M7).
  repeat split; match goal with |- x ?n = _ => rewrite (proj2 (Begins n _ _ eq_refl)) end; apply scaled_down; assumption.
Qed.
Lemma whole_are : (x "whole_p" = value_of "alpha" ^ 2 * in_radial * power small_p /\ x "whole_q" = value_of "b" ^ 2 * in_radial * power small_q
  /\ x "whole_s" = value_of "gamma" ^ 2 * in_axial * power small_s /\ x "whole_t" = value_of "d" ^ 2 * in_axial * power small_t)%R.
Proof.
  destruct below_most as ((M1 & M2 & M3 & M4) & M5 & M6 & M7).
  repeat split; match goal with |- x ?n = _ => rewrite (proj2 (Begins n _ _ eq_refl)) end; apply scaled; assumption.
Qed.
Lemma whole_moved : (x "whole_q" = x "q" * (power small * IZR (2 ^ shift "by_q")) /\ x "whole_t" = x "t" * (power small * IZR (2 ^ shift "by_t")))%R.
Proof.
  destruct squares_are as ((_ & Eq) & (_ & Et) & _), whole_are as (_ & Wq & _ & Wt), powers_bounded as (_ & (_ & Q0 & T0) & _).
  change (shift "by_q") with by_q; change (shift "by_t") with by_t; rewrite Eq, Et, Wq, Wt, !power_whole, <- !power_sum by assumption.
  split; do 2 f_equal; unfold by_q, by_t; ring.
Qed.

Lemma exact_values : (x "n2" = power small * scale / IZR bits128 * c2 A B P Q /\ x "n1" = scale / IZR bits128 * c1 A B P Q
  /\ x "N" = power (- top_3) * scale / IZR bits128 /\ x "ps" = power (- top_0) * scale / IZR bits128 * (A * B))%R.
Proof.
  destruct squares_are as ((Vp & Vq) & (Vs & Vt) & Vx & Vy & Vz), whole_are as (Wp & Wq & Ws & Wt), whole_moved as (Mq & Mt).
  destruct powers_bounded as (_ & (_ & Q0 & T0) & _).
  pose proof (positive "alpha" ltac:(cbn; tauto)) as Ha; pose proof (positive "gamma" ltac:(cbn; tauto)) as Hg;
    pose proof (positive "b" ltac:(cbn; tauto)) as Hb; pose proof (positive "d" ltac:(cbn; tauto)) as Hd.
  assert (U : IZR bits128 <> 0%R) by (apply not_0_IZR; discriminate).
  destruct (exact_at_the_poles num x shift Terms At_B At_A T0 Q0 Value_2 _ _ _ _ _ _ _ _ _ (power small) Hb Hd Vp Vq Vs Vt Vx Vy Vz Mq Mt)
    as (E2 & E1 & _); split; [exact E2 | split; [exact E1 |]].
  assert (T3 : power (- top_3) = (power small_q * power small_t)%R) by (rewrite <- power_sum; f_equal; unfold top_3; ring).
  assert (T1 : power (- top_0) = (power small_p * power small_s)%R) by (rewrite <- power_sum; f_equal; unfold top_0; ring).
  assert (E : forall i s, nth_error C_terms i = Some s -> runs num x shift s) by (intros i s F; apply (proj1 (Forall_forall _ _) Terms), (nth_error_In _ i F)).
  assert (EN : (x "N" = x "whole_q" * x "whole_t" / IZR bits128)%R) by exact (proj2 (E 12%nat _ eq_refl)).
  assert (EP : (x "ps" = x "whole_p" * x "whole_s" / IZR bits128)%R) by exact (proj2 (E 13%nat _ eq_refl)).
  rewrite EN, EP, Wp, Wq, Ws, Wt, T3, T1; unfold scale, A, B; generalize dependent (IZR bits128); intros; split; field; repeat split; lra.
Qed.

(** The balance. *)
Let bits_2 := bits_of (num "n2").
Let bits_1 := bits_of (num "n1").
Let top_2 := bits_2 - 124 - small.
Let top_1 := bits_1 - 124.
Let least := Z.max (top_1 - top_2) (Z.quot (top_0 - top_2) 2).
Let most := Z.max (Z.quot (top_1 - top_3) 2) (Z.quot (top_0 - top_3) 3).
Let k := Z.min least most.
Let top := Z.max (Z.max (top_3 + 3 * k) (top_2 + 2 * k)) (Z.max (top_1 + k) top_0).
Let down_3 := top - top_3 - 3 * k.
Let down_2 := top - top_2 - 2 * k.
Let down_1 := top - top_1 - k.
Let down_0 := top - top_0.
Let up_2 := 126 - bits_2.
Let up_1 := 126 - bits_1.
Let grown := Z.max 0 (Z.max (up_2 - down_2) (up_1 - down_1) - 1).
Let moved n up down := (shifted_down (shifted_up (num n) up) down, (x n * IZR (2 ^ up) / IZR (2 ^ down))%R).
Let first_cubic : beginnings := [("N", moved "N" 1 down_3); ("ps", moved "ps" 1 down_0); ("n2", moved "n2" up_2 (down_2 + 1)); ("n1", moved "n1" up_1 (down_1 + 1))].

Lemma first_cubic_numbers n : is_number (first_number first_cubic n).
Proof. apply first_are_numbers; unfold first_cubic, moved; repeat apply Forall_cons; [.. | apply Forall_nil]; apply down_stands. Qed.

Lemma bits_bounded : 1 <= bits_2 <= 126 /\ 1 <= bits_1 <= 126.
Proof.
  destruct kept_ranges as (_ & K2 & K1), two_hold as (H2 & H1 & _); revert H2 H1 K2 K1; generalize n2_range as r, (term "n1") as q; intros r q H2 H1 K2 K1.
  apply kept_is in K2 as ((? & ?) & _); apply kept_is in K1 as ((? & ?) & _); split; [apply (bits_within num x "n2" r H2) | apply (bits_within num x "n1" q H1)]; lia.
Qed.
Lemma downs : (0 <= down_3 /\ 0 <= down_2 /\ 0 <= down_1 /\ 0 <= down_0) /\ 0 <= grown /\ up_2 <= grown + (down_2 + 1) /\ up_1 <= grown + (down_1 + 1).
Proof.
  assert (T : (top_3 + 3 * k <= top /\ top_2 + 2 * k <= top) /\ top_1 + k <= top /\ top_0 <= top).
  { unfold top; clearbody k top_0 top_1 top_2 top_3; clear; lia. }
  assert (D : 0 <= down_3 /\ 0 <= down_2 /\ 0 <= down_1 /\ 0 <= down_0).
  { unfold down_3, down_2, down_1, down_0; clearbody top k top_0 top_1 top_2 top_3; clear - T; lia. }
  split; [exact D |]; unfold grown; clearbody down_2 down_1 up_2 up_1; clear; lia.
Qed.

Lemma ups : (0 <= up_2 /\ 0 <= up_1) /\ 0 <= down_2 + 1 /\ 0 <= down_1 + 1.
Proof. destruct bits_bounded as [B2 B1], downs as ((_ & D2 & D1 & _) & _); unfold up_2, up_1; clearbody bits_2 bits_1 down_2 down_1; clear - B2 B1 D2 D1; lia. Qed.

Section Cubic.
Variables (num' : string -> number) (x' : string -> R).
Hypotheses (Begins' : begins first_cubic num' x') (Steps' : Forall (runs num' x' shift) C_discriminant).

Lemma balanced_all : all_hold num' x' (balanced grown).
Proof.
  destruct kept_ranges as ((KN & KP) & K2 & K1), two_hold as (H2 & H1 & HN & HP).
  destruct downs as ((D3 & D2 & D1 & D0) & G0 & G2 & G1), bits_bounded as (B2 & B1).
  apply each_holds; unfold balanced; repeat apply Forall_cons; [.. | apply Forall_nil]; cbn [fst snd].
  - apply (doubled_holds num x num' x' "N" _ down_3 HN KN D3), Begins'; reflexivity.
  - apply (doubled_holds num x num' x' "ps" _ down_0 HP KP D0), Begins'; reflexivity.
  - apply (filled_holds num x num' x' "n2" _ down_2 grown H2 K2 D2 G0 B2 G2), Begins'; reflexivity.
  - apply (filled_holds num x num' x' "n1" _ down_1 grown H1 K1 D1 G0 B1 G1), Begins'; reflexivity.
Qed.

Let N := (scale / IZR bits128)%R.
Lemma balanced_values : (x' "N" = power (1 - top) * power k ^ 3 * N /\ x' "n2" = power (1 - top) * power k ^ 2 * (N * c2 A B P Q)
  /\ x' "n1" = power (1 - top) * power k * (N * c1 A B P Q) /\ x' "ps" = power (1 - top) * - (N * c0 A B P Q))%R.
Proof.
  destruct exact_values as (E2 & E1 & EN & EP), downs as ((D3 & _ & _ & D0) & _), ups as ((U2 & U1) & D2 & D1).
  assert (M : forall n up down v w, 0 <= up -> 0 <= down -> x' n = (x n * IZR (2 ^ up) / IZR (2 ^ down))%R -> x n = (power v * w)%R ->
    x' n = (power (v + up - down) * w)%R).
  { intros n up down v w U D -> ->; rewrite !power_whole by assumption; pose proof (power_positive down).
    replace (power v * w * power up)%R with (power (v + up - down + down) * w)%R by (replace (v + up - down + down) with (v + up) by ring; rewrite power_sum; ring).
    rewrite power_sum; field; lra. }
  assert (F : (power k ^ 3 = power (3 * k) /\ power k ^ 2 = power (2 * k))%R).
  { split; [replace (3 * k) with (k + k + k) by ring | replace (2 * k) with (k + k) by ring]; rewrite !power_sum; ring. }
  destruct F as [-> ->]; rewrite <- !power_sum; unfold N, c0; repeat split.
  - rewrite (M "N" 1 down_3 (- top_3) (scale / IZR bits128)%R Z.le_0_1 D3 (proj2 (Begins' "N" _ _ eq_refl))) by (rewrite EN; unfold Rdiv; ring).
    f_equal; f_equal; unfold down_3; ring.
  - rewrite (M "n2" up_2 (down_2 + 1) small (scale / IZR bits128 * c2 A B P Q)%R U2 D2 (proj2 (Begins' "n2" _ _ eq_refl)))
      by (rewrite E2; unfold Rdiv; ring).
    f_equal; f_equal; unfold down_2, up_2, top_2; ring.
  - rewrite (M "n1" up_1 (down_1 + 1) 0 (scale / IZR bits128 * c1 A B P Q)%R U1 D1 (proj2 (Begins' "n1" _ _ eq_refl)))
      by (rewrite E1; change (power 0) with 1%R; ring).
    f_equal; f_equal; unfold down_1, up_1, top_1; ring.
  - rewrite (M "ps" 1 down_0 (- top_0) (scale / IZR bits128 * (A * B))%R Z.le_0_1 D0 (proj2 (Begins' "ps" _ _ eq_refl))) by (rewrite EP; unfold Rdiv; ring).
    rewrite Ropp_mult_distr_r, Ropp_involutive; f_equal; f_equal; unfold down_0; ring.
Qed.

(** Stage 3 on this row, with the signs of delta and at the inflection where grown lets the C ask for them. *)
Lemma tree_is_right wide a : (wide = true -> (value_of "b" <= value_of "alpha")%R) ->
  tree_answer grown (sign_of (num' "delta") (said "delta" * 2 ^ grown)) (sign_of (num "n2") (said "coefficient"))
    (sign_of (num "n1") (said "coefficient")) (sign_of (num "offset_at_B") (said "pole")) (sign_of (num "slope_at_B") (said "pole"))
    (sign_of (num "offset_at_A") (said "pole")) (sign_of (num "slope_at_A") (said "pole"))
    (sign_of (num' "middle") (said "middle" * 2 ^ grown)) wide = Some a ->
  is_position (upright (value_of "alpha") (value_of "gamma") (value_of "b") (value_of "d") (value_of "x") (value_of "y") (value_of "z")) a.
Proof.
  intros W; destruct squares_are as ((Vp & Vq) & (Vs & Vt) & Vx & Vy & Vz), whole_moved as (Mq & Mt), powers_bounded as (_ & (_ & Q0 & T0) & _).
  pose proof (positive "alpha" ltac:(cbn; tauto)) as Ha; pose proof (positive "gamma" ltac:(cbn; tauto)) as Hg;
    pose proof (positive "b" ltac:(cbn; tauto)) as Hb; pose proof (positive "d" ltac:(cbn; tauto)) as Hd.
  destruct balanced_values as (XN & X2 & X1 & XP); unfold tree_answer; destruct (Z.ltb_spec most_grown grown) as [G | G].
  - apply (signs_are_right num x shift Terms At_B At_A squares_hold T0 Q0 Number_2 Value_2 _ _ _ _ _ _ _ in_radial in_axial (power small)
      Ha Hg Hb Hd (power_positive _) (power_positive _) (power_positive _) Vp Vq Vs Vt Vx Vy Vz Mq Mt); [exact I | discriminate | exact W].
  - assert (N0 : (0 < N)%R).
    { apply Rmult_lt_0_compat; [| apply Rinv_0_lt_compat, IZR_lt; reflexivity].
      unfold scale; apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; apply power_positive |] |]; apply pow_lt; assumption. }
    apply (stage_three_is_right num x shift Terms At_B At_A squares_hold T0 Q0 Number_2 Value_2 _ _ _ _ _ _ _ in_radial in_axial (power small)
      Ha Hg Hb Hd (power_positive _) (power_positive _) (power_positive _) Vp Vq Vs Vt Vx Vy Vz Mq Mt num' x' shift grown
      (conj (proj1 (proj2 downs)) G) balanced_all Steps' (power (1 - top)) (power k) N N0 (power_positive _) (power_positive _) XN X2 X1 XP wide a W).
Qed.

(** What the text returns on it. *)
Variables guessed power_guessed : list datum -> Z.
Hypotheses (Computed : Forall (is_computed shift num) C_terms /\ Forall (is_computed shift num) C_at_B /\ Forall (is_computed shift num) C_at_A)
  (Computed' : Forall (is_computed shift num') C_discriminant).
Ltac begun H := lazymatch goal with
  | |- num ?n = shifted_down (num ?w) _ => rewrite (proj1 (H w _ _ eq_refl)); exact (proj1 (H n _ _ eq_refl))
  | |- _ ?n = _ => exact (proj1 (H n _ _ eq_refl)) end.
Lemma text_returns : answer_of_text m e guessed power_guessed = Some (Of Int (code (tree_answer grown (beyond_grown num' grown "delta")
  (beyond num "n2" "coefficient") (beyond num "n1" "coefficient") (beyond num "offset_at_B" "pole") (beyond num "slope_at_B" "pole")
  (beyond num "offset_at_A" "pole") (beyond num "slope_at_A" "pole") (beyond_grown num' grown "middle") (not_shorter m e)))).
Proof.
  destruct Computed as (T & TB & TA), powers_bounded as (_ & (S & Q0 & T0) & (B3 & B0) & _), bits_bounded as (R2 & R1).
  apply answer_is_fixed_answer with (shift := shift) (small := small) (top_N := top_3) (top_ps := top_0) (k := k).
  - apply (terms_text m e Powers num shift radial axial small_p small_q small_s small_t small by_q by_t); try reflexivity; try exact Number_2;
      try exact T; begun Begins.
  - apply (cubic_text num num' shift small by_q by_t top_3 top_0 S B3 B0 bits_2 bits_1 top_2 top_1 (Z.quot (top_0 - top_2) 2)
      (Z.quot (top_1 - top_3) 2) (Z.quot (top_0 - top_3) 3) least most k top down_3 down_2 down_1 down_0 up_2 up_1 grown eq_refl eq_refl R2 R1);
      try reflexivity; try exact Computed'; begun Begins'.
  - exact TB.
  - exact TA.
  - exact Q0.
  - exact T0.
  - exact (proj1 (proj2 downs)).
Qed.
End Cubic.
End Run.

(** What the C compares with >=. *)
Lemma shorter_is : not_shorter m e = true -> (value_of "b" <= value_of "alpha")%R.
Proof.
  unfold not_shorter, value_of, in_unit; intros H; apply negb_true_iff, Z.ltb_ge, IZR_le in H; rewrite !mult_IZR, !power_whole in H by lia.
  set (u := Z.min (e "alpha") (e "b")) in *; replace (Z.min (e "b") (e "alpha")) with u in H by (unfold u; lia).
  replace (e "b" - 1075) with (e "b" - u + (u - 1075)) by ring; replace (e "alpha" - 1075) with (e "alpha" - u + (u - 1075)) by ring.
  rewrite !power_sum, <- !Rmult_assoc; apply Rmult_le_compat_r; [apply Rlt_le, power_positive | exact H].
Qed.

(** ** The text of stage 3 answers with the position, or not at all, whatever the guess of a double root is. *)

Variables guessed power_guessed : list datum -> Z.
Let returned := answer_of_text m e guessed power_guessed.
Let p := upright (value_of "alpha") (value_of "gamma") (value_of "b") (value_of "d") (value_of "x") (value_of "y") (value_of "z").
Theorem text_answers_the_position : exists o, returned = Some (Of Int (code o)) /\ forall a, o = Some a -> is_position p a.
Proof.
  destruct (begun_terms shift shifts first_terms first_terms_numbers eq_refl) as (num & x & Begins & T & (RT & RB & RA) & N2 & V2).
  destruct (begun_discriminant shift shifts _ (first_cubic_numbers num x) eq_refl) as (num' & x' & Begins' & T' & R').
  eexists; split; [exact (text_returns num x Begins RT N2 V2 num' x' Begins' guessed power_guessed T T') |].
  intros a; exact (tree_is_right num x Begins RT RB RA N2 V2 num' x' Begins' R' (not_shorter m e) a shorter_is).
Qed.

Corollary returned_is_right : (returned = Some (Of Int 1) -> exterior p) /\ (returned = Some (Of Int (-1)) -> interior p)
  /\ (returned = Some (Of Int 0) -> contact p).
Proof.
  destruct text_answers_the_position as (o & E & H); rewrite E; destruct o as [[| |] |]; repeat split; intros F; try discriminate; exact (H _ eq_refl).
Qed.
End Row.

(** Each of them occurs: beside a unit hyperboloid, for a unit sphere 4 from its axis, a sphere of 1/4 in its centre and a unit sphere whose
    centre is 1 from the axis; and 2 for the unit sphere in its centre, which touches it. *)
Definition one := (2 ^ 52, 1023).
Definition zero := (0, -4096).
Definition text_at (l : list (Z * Z)) := let of_row n := match look n (combine lengths l) with Some v => v | None => zero end in
  answer_of_text (fun n => fst (of_row n)) (fun n => snd (of_row n)) (fun _ => 0) (fun _ => 0).
Theorem every_answer_occurs : map text_at [[one; one; one; one; (2 ^ 52, 1025); zero; zero];
  [one; one; (2 ^ 52, 1021); (2 ^ 52, 1021); zero; zero; zero]; [one; one; one; one; one; zero; zero]; [one; one; one; one; zero; zero; zero]]
  = map (fun a => Some (Of Int a)) [1; -1; 0; 2].
Proof. vm_compute; reflexivity. Qed.
