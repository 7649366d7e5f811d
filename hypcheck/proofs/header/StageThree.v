(** Stage 3: where the numbers of the fixed point lie beyond their bounds, the C answers with the position.

    First the discriminant of g and its inflection, then the coefficients and what is asked at the poles, then the answer. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Hypcheck Require Import Geometry UnitBall Cubic Rule Positions Stages Steps Fixed FixedRuns.
Import ListNotations.
Open Scope string_scope.

Section Fixed_point.

Variables (num : string -> number) (x : string -> R) (shift : string -> Z).
Hypothesis Runs : Forall (runs num x shift) C_discriminant.

Let step_of n : option step := find (fun s => String.eqb (name s) n) C_discriminant.
Let run_of n s : step_of n = Some s -> runs num x shift s.
Proof. intros E; apply (proj1 (Forall_forall _ _) Runs); apply (find_some _ _ E). Qed.

Ltac equation n := let s := eval vm_compute in (step_of n) in match s with Some ?k =>
  let H := fresh "E" in assert (H : runs num x shift k) by (apply (run_of n); vm_compute; reflexivity);
  cbv [runs call_of look arguments operation name String.eqb Ascii.eqb Bool.eqb halves] in H;
  repeat match type of H with _ /\ _ => apply proj2 in H end end.

Open Scope R_scope.
Let unit := IZR bits128.

Theorem exact_numbers :
  unit ^ 3 * x "delta" = 4 * (x "n2" ^ 2 - 3 * (x "N" * x "n1")) * (x "n1" ^ 2 + 3 * (x "n2" * x "ps"))
    - (x "n2" * x "n1" + 9 * (x "N" * x "ps")) ^ 2
  /\ unit ^ 2 * x "middle" = 2 * (x "n2" * (x "n2" ^ 2 - 3 * (x "N" * x "n1")))
    - 3 * (x "N" * (x "n2" * x "n1" + 9 * (x "N" * x "ps"))).
Proof.
  assert (U : IZR bits128 <> 0) by (apply not_0_IZR; discriminate).
  equation "n2_n2"; equation "N_n1"; equation "N_n1_3"; equation "h1"; equation "n2_n1"; equation "N_ps"; equation "N_ps_9";
    equation "h2"; equation "n1_n1"; equation "n2_ps"; equation "n2_ps_3"; equation "h3"; equation "h1_h3"; equation "h1_h3_4";
    equation "h2_h2"; equation "delta"; equation "n2_h1"; equation "n2_h1_2"; equation "N_h2"; equation "N_h2_3"; equation "middle".
  unfold unit; repeat match goal with H : x ?n = _ |- context [x ?n] => rewrite H end.
  generalize dependent (IZR bits128); intros u U; clear; split; field; exact U.
Qed.

(** The balance: N, n2, n1 and ps of the row times powers of two do not change the signs. *)
Variables A B P Q N m r : R.
Hypotheses (N0 : 0 < N) (M0 : 0 < m) (R0 : 0 < r).
Hypotheses (XN : x "N" = m * r ^ 3 * N) (X2 : x "n2" = m * r ^ 2 * (N * c2 A B P Q)) (X1 : x "n1" = m * r * (N * c1 A B P Q))
  (X0 : x "ps" = m * - (N * c0 A B P Q)).

Let unit_positive : 0 < unit.
Proof. apply IZR_lt; reflexivity. Qed.

Lemma delta_is : unit ^ 3 * x "delta" = m ^ 4 * r ^ 6 * N ^ 4 * (3 * delta A B P Q).
Proof. rewrite (proj1 exact_numbers), XN, X2, X1, X0; unfold delta, disc; ring. Qed.

Lemma middle_is : unit ^ 2 * x "middle" = m ^ 3 * r ^ 6 * N ^ 3 * (27 * g A B P Q (- c2 A B P Q / 3)).
Proof. rewrite (proj2 exact_numbers), XN, X2, X1, X0, g_expanded; field. Qed.

Let same_sign k v w j : 0 < k -> 0 < j -> k * v = j * w -> (0 < v -> 0 < w) /\ (v < 0 -> w < 0).
Proof. intros K J E; split; intros H; apply Rmult_lt_reg_l with j; try assumption; nra. Qed.

Theorem delta_decides grown : (0 <= grown <= most_grown)%Z -> all_hold num x (balanced grown) ->
  let v := signed_value (num "delta") in ((said "delta" * 2 ^ grown < v)%Z -> 0 < delta A B P Q)
    /\ ((v < - (said "delta" * 2 ^ grown))%Z -> delta A B P Q < 0).
Proof.
  intros G K; destruct (sign_of_delta num x shift grown G K Runs) as (S1 & S2); cbv zeta.
  assert (k1 : 0 < unit ^ 3) by (apply pow_lt; assumption).
  assert (k2 : 0 < m ^ 4 * r ^ 6 * N ^ 4) by (apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat |]; apply pow_lt; assumption).
  destruct (same_sign _ _ _ _ k1 k2 delta_is) as [D1 D2].
  split; intros H; [apply S1 in H; apply D1 in H | apply S2 in H; apply D2 in H]; lra.
Qed.

Theorem middle_decides grown : (0 <= grown <= most_grown)%Z -> all_hold num x (balanced grown) ->
  (said "middle" * 2 ^ grown < signed_value (num "middle"))%Z -> 0 < g A B P Q (- c2 A B P Q / 3).
Proof.
  intros G K; destruct (sign_of_middle num x shift grown G K Runs) as (S1 & _).
  assert (k1 : 0 < unit ^ 2) by (apply pow_lt; assumption).
  assert (k2 : 0 < m ^ 3 * r ^ 6 * N ^ 3) by (apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat |]; apply pow_lt; assumption).
  destruct (same_sign _ _ _ _ k1 k2 middle_is) as [D1 _]; intros H; apply S1 in H; apply D1 in H; lra.
Qed.

End Fixed_point.

(** ** The coefficients, and what is asked at the poles. *)

Section Poles.

Variables (num : string -> number) (x : string -> R) (shift : string -> Z).
Hypotheses (Terms : Forall (runs num x shift) C_terms) (At_B : Forall (runs num x shift) C_at_B) (At_A : Forall (runs num x shift) C_at_A).
Hypothesis Squares : all_hold num x squares.

(** n2, as the C makes it of two of the terms. *)
Hypotheses (S0 : (0 <= shift "by_t")%Z) (S1 : (0 <= shift "by_q")%Z)
  (Number_2 : num "n2" = minus (shifted_down (num "radial_2") (shift "by_t")) (shifted_down (num "axial_2") (shift "by_q")))
  (Value_2 : x "n2" = (x "radial_2" / IZR (2 ^ shift "by_t") - x "axial_2" / IZR (2 ^ shift "by_q"))%R).

(** A number moved down. *)
Lemma moved_holds n q k : holds num x n q -> (high q < bits128 / 2)%Z -> (0 <= k)%Z ->
  exists v, stands (shifted_down (num n) k) v /\ within (moved_down q) v (x n / IZR (2 ^ k)).
Proof.
  intros (v & S & I & F) H K; exists (v / 2 ^ k)%Z; assert (V : signed_value (num n) = v).
  { apply signed_value_is; [exact S |]; destruct I as [I _]; unfold fits in F; destruct (Z.ltb_spec (low q) 0);
      [apply andb_prop in F as [F _]; apply Z.leb_le in F |]; numbers; lia. }
  rewrite <- V; split; [apply down_stands |]; rewrite V; exact (moved_within q v (x n) k K I).
Qed.

Lemma difference_holds q t : holds num x "radial_2" q -> holds num x "axial_2" t -> (high q < bits128 / 2)%Z -> (high t < bits128 / 2)%Z ->
  fits (sum (moved_down q) (negative (moved_down t))) = true -> holds num x "n2" (sum (moved_down q) (negative (moved_down t))).
Proof.
  intros HQ HT Q0 T0 F; destruct (moved_holds _ _ _ HQ Q0 S0) as (v & V & IV); destruct (moved_holds _ _ _ HT T0 S1) as (w & U & IU).
  exists (v - w)%Z; rewrite Number_2, Value_2; split; [apply minus_stands; assumption | split; [| exact F]].
  exact (sum_within _ (negative (moved_down t)) v (- w)%Z _ (- (x "axial_2" / IZR (2 ^ shift "by_q")))%R IV (negative_within _ _ _ IU)).
Qed.

(** What is computed of the terms once. *)
Definition terms_found := match ranges squares C_terms with Some t => t | None => [] end.
Lemma terms_are : ranges squares C_terms = Some terms_found /\ ((high (term "radial_2") <? bits128 / 2) && (high (term "axial_2") <? bits128 / 2)
    && fits n2_range && (low n2_range <? 0) && (low (term "n1") <? 0))%Z%bool = true
  /\ look "radial_2" terms_found = Some (term "radial_2") /\ look "axial_2" terms_found = Some (term "axial_2")
  /\ look "R" terms_found = Some (term "R") /\ look "n1" terms_found = Some (term "n1").
Proof. vm_compute; repeat split; reflexivity. Qed.

Lemma terms_hold : holds num x "radial_2" (term "radial_2") /\ holds num x "axial_2" (term "axial_2") /\ holds num x "R" (term "R")
  /\ holds num x "n1" (term "n1") /\ holds num x "n2" n2_range /\ (low n2_range < 0)%Z /\ (low (term "n1") < 0)%Z.
Proof.
  destruct terms_are as (E & F & L1 & L2 & L3 & L4); pose proof (ranges_hold num x shift C_terms squares _ Squares Terms E) as H.
  pose proof (H _ _ L1) as H1; pose proof (H _ _ L2) as H2; pose proof (H _ _ L3) as H3; pose proof (H _ _ L4) as H4.
  clear E L1 L2 L3 L4 H; unfold n2_range in *; revert F H1 H2 H3 H4.
  generalize (term "radial_2") as q; generalize (term "axial_2") as t; generalize (term "R") as i; generalize (term "n1") as j.
  intros j i t q F H1 H2 H3 H4; apply andb_prop in F as [F F5]; apply andb_prop in F as [F F4]; apply andb_prop in F as [F F3];
    apply andb_prop in F as [F1 F2]; apply Z.ltb_lt in F1; apply Z.ltb_lt in F2; apply Z.ltb_lt in F4; apply Z.ltb_lt in F5.
  pose proof (difference_holds q t H1 H2 F1 F2 F3); repeat split; assumption.
Qed.

Lemma poles_hold : all_hold num x poles.
Proof.
  destruct terms_hold as (_ & _ & HR & _ & H2 & _); unfold poles; revert HR H2; generalize (term "R") as i; generalize n2_range as j; intros j i HR H2.
  intros n r L; cbn [look] in L; destruct (String.eqb_spec "n2" n) as [<- | N]; [injection L as <-; exact H2 |].
  destruct (String.eqb_spec "R" n) as [<- | N']; [injection L as <-; exact HR | exact (Squares n r L)].
Qed.

(** A coefficient beyond its bound has the sign of the exact one. *)
Theorem sign_of_coefficient n : n = "n2" \/ n = "n1" -> let v := signed_value (num n) in
  ((said "coefficient" < v)%Z -> (0 < x n)%R) /\ ((v < - said "coefficient")%Z -> (x n < 0)%R).
Proof.
  intros O; assert (H : exists r, holds num x n r /\ (error r <= said "coefficient")%Z /\ (low r < 0)%Z).
  { pose proof header_covers_coefficients as H; apply andb_prop in H as [H2 H1]; apply Z.leb_le in H1; apply Z.leb_le in H2.
    destruct terms_hold as (_ & _ & _ & T1 & T2 & L2 & L1); destruct O as [-> | ->]; [exists n2_range | exists (term "n1")]; auto. }
  destruct H as (r & (v & S & I & F) & E & L); cbv zeta; rewrite (signed_value_is (num n) v S (fits_signed r v (x n) F L I)).
  destruct I as [_ [I1 I2]]; unfold error in E.
  assert (U : (- IZR (said "coefficient") <= IZR (under r))%R) by (rewrite <- opp_IZR; apply IZR_le; lia).
  assert (O' : (IZR (over r) <= IZR (said "coefficient"))%R) by (apply IZR_le; lia).
  split; intros H; apply IZR_lt in H; [| rewrite opp_IZR in H]; lra.
Qed.

Theorem sign_at_a_pole n : In n ["offset_at_B"; "slope_at_B"; "offset_at_A"; "slope_at_A"] -> let v := signed_value (num n) in
  ((said "pole" < v)%Z -> (0 < x n)%R) /\ ((v < - said "pole")%Z -> (x n < 0)%R).
Proof.
  intros I; destruct I as [<- | [<- | [<- | [<- | []]]]].
  1, 2: apply (signs_at_the_poles num x shift C_at_B); [left; cbn; tauto | exact poles_hold | exact At_B].
  1, 2: apply (signs_at_the_poles num x shift C_at_A); [right; cbn; tauto | exact poles_hold | exact At_A].
Qed.

(** The lengths: what is squared is a multiple of a square of the row, and what is whole was not divided. *)
Variables alpha gamma b d cx cy cz radial axial k : R.
Hypotheses (Ha : (0 < alpha)%R) (Hg : (0 < gamma)%R) (Hb : (0 < b)%R) (Hd : (0 < d)%R) (HR : (0 < radial)%R) (HA : (0 < axial)%R) (HK : (0 < k)%R).
Hypotheses (Vp : x "p" = (alpha ^ 2 * radial)%R) (Vq : x "q" = (b ^ 2 * radial)%R) (Vs : x "s" = (gamma ^ 2 * axial)%R)
  (Vt : x "t" = (d ^ 2 * axial)%R) (Vx : x "xx" = (cx ^ 2 * radial)%R) (Vy : x "yy" = (cy ^ 2 * radial)%R) (Vz : x "S" = (cz ^ 2 * axial)%R)
  (Wq : x "whole_q" = (x "q" * (k * IZR (2 ^ shift "by_q")))%R) (Wt : x "whole_t" = (x "t" * (k * IZR (2 ^ shift "by_t")))%R).

Let step_in l n : option step := find (fun s => String.eqb (name s) n) l.
Let run_in l n s : Forall (runs num x shift) l -> step_in l n = Some s -> runs num x shift s.
Proof. intros F E; apply (proj1 (Forall_forall _ _) F); apply (find_some _ _ E). Qed.

Ltac equation F l n := let s := eval vm_compute in (step_in l n) in match s with Some ?t =>
  let H := fresh "E" in assert (H : runs num x shift t) by (apply (run_in l n); [exact F | vm_compute; reflexivity]);
  cbv [runs call_of look arguments operation name String.eqb Ascii.eqb Bool.eqb halves] in H;
  repeat match type of H with _ /\ _ => apply proj2 in H end end.

Open Scope R_scope.
Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let P := (cx ^ 2 + cy ^ 2) / b ^ 2.
Let Q := (cz / d) ^ 2.
Let unit := IZR bits128.
Let scale := radial * axial * b ^ 2 * d ^ 2.

Theorem exact_at_the_poles : x "n2" = k * scale / unit * c2 A B P Q /\ x "n1" = scale / unit * c1 A B P Q
  /\ x "offset_at_B" = k * scale / unit * (3 * B + c2 A B P Q) /\ x "slope_at_B" = k * scale * (axial * d ^ 2) / unit ^ 2 * slope A B P Q B
  /\ x "offset_at_A" = k * scale / unit * (3 * A - c2 A B P Q) /\ x "slope_at_A" = k * scale * (radial * b ^ 2) / unit ^ 2 * slope A B P Q (- A).
Proof.
  assert (U : IZR bits128 <> 0) by (apply not_0_IZR; discriminate).
  assert (T0 : IZR (2 ^ shift "by_t") <> 0) by (apply not_0_IZR, Z.pow_nonzero; [discriminate | exact S0]).
  assert (Q0 : IZR (2 ^ shift "by_q") <> 0) by (apply not_0_IZR, Z.pow_nonzero; [discriminate | exact S1]).
  assert (n2 : x "n2" = k * scale / unit * c2 A B P Q).
  { equation Terms C_terms "R"; equation Terms C_terms "p_plus_q"; equation Terms C_terms "p_q_R"; equation Terms C_terms "radial_2";
      equation Terms C_terms "s_plus_S"; equation Terms C_terms "axial_2".
    rewrite Value_2; repeat match goal with H : x ?n = _ |- context [x ?n] => rewrite H end.
    unfold scale, unit, c2, A, B, P, Q; generalize dependent (IZR bits128); generalize dependent (IZR (2 ^ shift "by_t"));
      generalize dependent (IZR (2 ^ shift "by_q")); intros; field; repeat split; lra. }
  assert (n1 : x "n1" = scale / unit * c1 A B P Q).
  { equation Terms C_terms "R"; equation Terms C_terms "t_minus_s"; equation Terms C_terms "t_s_S"; equation Terms C_terms "axial_1";
      equation Terms C_terms "R_minus_q"; equation Terms C_terms "radial_1"; equation Terms C_terms "n1".
    repeat match goal with H : x ?n = _ |- context [x ?n] => rewrite H end.
    unfold scale, unit, c1, A, B, P, Q; generalize dependent (IZR bits128); intros; field; repeat split; lra. }
  split; [exact n2 | split; [exact n1 |]]; equation Terms C_terms "R"; rewrite Vx, Vy in E.
  split; [| split; [| split]].
  - equation At_B C_at_B "q_s"; equation At_B C_at_B "q_s_3"; equation At_B C_at_B "offset_at_B".
    rewrite E2, E1, E0, n2, Vs, Wq, Vq; unfold scale, unit, c2, A, B, P, Q; generalize dependent (IZR bits128);
      generalize dependent (IZR (2 ^ shift "by_q")); intros; field; repeat split; lra.
  - clear n2 n1; equation At_B C_at_B "p_t"; equation At_B C_at_B "s_t"; equation At_B C_at_B "q_s"; equation At_B C_at_B "p_t_q_s";
      equation At_B C_at_B "t_plus_s"; equation At_B C_at_B "rise_at_B"; equation At_B C_at_B "q_s_2"; equation At_B C_at_B "p_t_q_s_2";
      equation At_B C_at_B "axial_fall"; equation At_B C_at_B "radial_fall"; equation At_B C_at_B "rise_less_axial"; equation At_B C_at_B "slope_at_B".
    repeat match goal with H : x ?n = _ |- context [x ?n] => rewrite H end.
    unfold scale, unit, slope, c2, c1, A, B, P, Q; generalize dependent (IZR bits128); generalize dependent (IZR (2 ^ shift "by_t"));
      generalize dependent (IZR (2 ^ shift "by_q")); intros; field; repeat split; lra.
  - equation At_A C_at_A "p_t"; equation At_A C_at_A "p_t_3"; equation At_A C_at_A "offset_at_A".
    rewrite E2, E1, E0, n2, Vp, Wt, Vt; unfold scale, unit, c2, A, B, P, Q; generalize dependent (IZR bits128);
      generalize dependent (IZR (2 ^ shift "by_t")); intros; field; repeat split; lra.
  - clear n2 n1; equation At_A C_at_A "p_t"; equation At_A C_at_A "q_s"; equation At_A C_at_A "p_q"; equation At_A C_at_A "p_t_q_s";
      equation At_A C_at_A "p_t_2"; equation At_A C_at_A "p_t_2_q_s"; equation At_A C_at_A "radial_rise"; equation At_A C_at_A "axial_rise";
      equation At_A C_at_A "p_less_q"; equation At_A C_at_A "width_at_A"; equation At_A C_at_A "rise_at_A"; equation At_A C_at_A "slope_at_A".
    repeat match goal with H : x ?n = _ |- context [x ?n] => rewrite H end.
    unfold scale, unit, slope, c2, c1, A, B, P, Q; generalize dependent (IZR bits128); generalize dependent (IZR (2 ^ shift "by_t"));
      generalize dependent (IZR (2 ^ shift "by_q")); intros; field; repeat split; lra.
Qed.

(** What the C answers by the signs; nothing where they do not tell. *)
Definition fixed_answer (delta c2 c1 offset_B slope_B offset_A slope_A middle : comparison) (wide : bool) : option answer :=
  match delta, c2, c1 with
  | Lt, _, _ => Some Contact
  | _, Lt, Gt => match delta, offset_B, slope_B, middle with
    | Gt, Gt, _, _ | Gt, _, Lt, _ => Some Exterior
    | _, Lt, Gt, _ => Some Contact
    | _, Gt, _, Gt => Some Exterior
    | _, _, _, _ => None end
  | _, Gt, _ | _, _, Lt => if match delta with Gt => wide | _ => false end then Some Interior
    else match offset_A, slope_A, delta with
    | Lt, _, _ | _, Lt, _ => Some Contact
    | Gt, Gt, Gt => Some Interior
    | _, _, _ => None end
  | _, _, _ => None end.

Let certain_positive v : 0 < v -> certainly_positive v.
Proof. intros H; exists v, 0; rewrite Rminus_diag_eq, Rabs_R0 by reflexivity; lra. Qed.
Let certain_negative v : v < 0 -> certainly_negative v.
Proof. intros H; exists v, 0; rewrite Rminus_diag_eq, Rabs_R0 by reflexivity; lra. Qed.

Let by_sign n bound (v w j : R) : 0 < j -> v = j * w -> ((bound < signed_value n)%Z -> 0 < v) /\ ((signed_value n < - bound)%Z -> v < 0) ->
  match sign_of n bound with Gt => 0 < w | Lt => w < 0 | Eq => True end.
Proof.
  intros J E [G1 G2]; unfold sign_of; destruct (Z.ltb_spec bound (signed_value n)) as [H | _].
  - apply G1 in H; apply Rmult_lt_reg_l with j; lra.
  - destruct (Z.ltb_spec (signed_value n) (- bound - 1)) as [H | _]; [| exact I]; assert (H' : (signed_value n < - bound)%Z) by lia; apply G2 in H'; apply Rmult_lt_reg_l with j; lra.
Qed.

(** What the signs answer is the position, whatever tells the sign of the discriminant, and that g > 0 at its inflection. *)
Theorem signs_are_right (sD sM : comparison) (wide : bool) a :
  match sD with Gt => 0 < delta A B P Q | Lt => delta A B P Q < 0 | Eq => True end ->
  (sM = Gt -> 0 < g A B P Q (- c2 A B P Q / 3)) -> (wide = true -> b <= alpha) ->
  fixed_answer sD (sign_of (num "n2") (said "coefficient"))
    (sign_of (num "n1") (said "coefficient")) (sign_of (num "offset_at_B") (said "pole")) (sign_of (num "slope_at_B") (said "pole"))
    (sign_of (num "offset_at_A") (said "pole")) (sign_of (num "slope_at_A") (said "pole")) sM wide = Some a ->
  is_position (upright alpha gamma b d cx cy cz) a.
Proof.
  intros KD KM Wide F; apply (whatever_stage_answers alpha gamma b d cx cy cz Ha Hg Hb Hd).
  destruct exact_at_the_poles as (E2 & E1 & EoB & EsB & EoA & EsA).
  assert (u0 : 0 < unit) by (apply IZR_lt; reflexivity); assert (c0 : 0 < scale).
  { assert (0 < b ^ 2) by (apply pow_lt; exact Hb); assert (0 < d ^ 2) by (apply pow_lt; exact Hd).
    unfold scale; repeat (apply Rmult_lt_0_compat; [| assumption]); assumption. }
  assert (over : forall v w, 0 < v -> 0 < w -> 0 < v / w) by (intros; apply Rmult_lt_0_compat; [| apply Rinv_0_lt_compat]; assumption).
  assert (f2 : 0 < unit ^ 2) by (apply pow_lt; exact u0); assert (ks : 0 < k * scale) by (apply Rmult_lt_0_compat; assumption).
  assert (kt : 0 < k * scale * (axial * d ^ 2)) 
    by (apply Rmult_lt_0_compat; [exact ks | apply Rmult_lt_0_compat; [assumption | apply pow_lt; assumption]]).
  assert (kq : 0 < k * scale * (radial * b ^ 2)) 
    by (apply Rmult_lt_0_compat; [exact ks | apply Rmult_lt_0_compat; [assumption | apply pow_lt; assumption]]).
  pose proof (by_sign _ _ _ _ _ (over _ _ ks u0) E2 (sign_of_coefficient "n2" (or_introl eq_refl))) as K2.
  pose proof (by_sign _ _ _ _ _ (over _ _ c0 u0) E1 (sign_of_coefficient "n1" (or_intror eq_refl))) as K1.
  pose proof (by_sign _ _ _ _ _ (over _ _ ks u0) EoB (sign_at_a_pole "offset_at_B" ltac:(cbn; tauto))) as KoB.
  pose proof (by_sign _ _ _ _ _ (over _ _ kt f2) EsB (sign_at_a_pole "slope_at_B" ltac:(cbn; tauto))) as KsB.
  pose proof (by_sign _ _ _ _ _ (over _ _ ks u0) EoA (sign_at_a_pole "offset_at_A" ltac:(cbn; tauto))) as KoA.
  pose proof (by_sign _ _ _ _ _ (over _ _ kq f2) EsA (sign_at_a_pole "slope_at_A" ltac:(cbn; tauto))) as KsA.
  revert F K2 K1 KoB KsB KoA KsA KD KM.
  generalize (sign_of (num "n2") (said "coefficient")) as s2;
    generalize (sign_of (num "n1") (said "coefficient")) as s1; generalize (sign_of (num "offset_at_B") (said "pole")) as oB;
    generalize (sign_of (num "slope_at_B") (said "pole")) as sB; generalize (sign_of (num "offset_at_A") (said "pole")) as oA;
    generalize (sign_of (num "slope_at_A") (said "pole")) as sA.
  clear - Ha Hg Hb Hd Wide certain_positive certain_negative; intros sA oA sB oB s1 s2 F K2 K1 KoB KsB KoA KsA KD KM.
  assert (C1 : sD = Lt -> certainly_negative (3 * delta A B P Q)) by (intros ->; apply certain_negative; lra).
  assert (C2 : sD = Gt -> certainly_positive (3 * delta A B P Q)) by (intros ->; apply certain_positive; lra).
  assert (N2 : s2 = Lt -> certainly_negative (c2 A B P Q)) by (intros ->; auto).
  assert (N1 : s1 = Gt -> certainly_positive (c1 A B P Q)) by (intros ->; auto).
  assert (NN : s2 = Gt \/ s1 = Lt -> certainly_positive (c2 A B P Q) \/ certainly_negative (c1 A B P Q)) by (intros [-> | ->]; auto).
  assert (beyond : oB = Gt -> certainly_positive (3 * B + c2 A B P Q)) by (intros ->; auto).
  assert (below : oB = Lt -> certainly_negative (3 * B + c2 A B P Q)) by (intros ->; auto).
  assert (rises : sB = Gt -> certainly_positive (slope A B P Q B)) by (intros ->; auto).
  assert (falls : sB = Lt -> certainly_negative (slope A B P Q B)) by (intros ->; auto).
  assert (above_A : oA = Gt -> certainly_positive (3 * A - c2 A B P Q)) by (intros ->; auto).
  assert (below_A : oA = Lt -> certainly_negative (3 * A - c2 A B P Q)) by (intros ->; auto).
  assert (rises_A : sA = Gt -> certainly_positive (slope A B P Q (- A))) by (intros ->; auto).
  assert (falls_A : sA = Lt -> certainly_negative (slope A B P Q (- A))) by (intros ->; auto).
  assert (ring : sM = Gt -> certainly_positive (27 * g A B P Q (- c2 A B P Q / 3))) by (intros H; apply certain_positive; specialize (KM H); lra).
  clear K2 K1 KoB KsB KoA KsA KD KM certain_positive certain_negative.
  assert (away : s2 = Gt \/ s1 = Lt -> (if match sD with Gt => wide | _ => false end then Some Interior
    else match oA, sA, sD with Lt, _, _ | _, Lt, _ => Some Contact | Gt, Gt, Gt => Some Interior | _, _, _ => None end) = Some a -> sD <> Lt ->
    answers alpha gamma b d cx cy cz a).
  { intros T G NL; specialize (NN T); destruct sD; [| contradiction NL; reflexivity |].
    - destruct oA, sA; try discriminate; injection G as <-; apply throat; auto.
    - destruct wide; [injection G as <-; apply by_coefficients_wide; auto |].
      destruct oA, sA; try discriminate; injection G as <-; try (apply throat; auto; fail); apply by_coefficients_interior; auto. }
  unfold fixed_answer in F; destruct sD; [| injection F as <-; apply one_root; auto |].
  - destruct s2, s1; try discriminate; try (apply away; [auto | exact F | discriminate]).
    destruct oB, sB, sM; try discriminate; injection F as <-; try (apply groove; auto; fail); apply inflection; auto.
  - destruct s2, s1; try discriminate; try (apply away; [auto | exact F | discriminate]).
    destruct oB, sB, sM; try discriminate; injection F as <-; try (apply groove; auto; fail); apply by_coefficients_exterior; auto.
Qed.

(** The balanced numbers of the discriminant: multiples, by powers of two, of the same N, n2, n1 and ps. *)
Variables (num' : string -> number) (x' : string -> R) (shift' : string -> Z) (grown : Z).
Hypotheses (Grown : (0 <= grown <= most_grown)%Z) (Balanced : all_hold num' x' (balanced grown))
  (Discriminant : Forall (runs num' x' shift') C_discriminant).
Variables m r N : R.
Hypotheses (N0 : 0 < N) (M0 : 0 < m) (R0 : 0 < r) (XN : x' "N" = m * r ^ 3 * N) (X2 : x' "n2" = m * r ^ 2 * (N * c2 A B P Q))
  (X1 : x' "n1" = m * r * (N * c1 A B P Q)) (XP : x' "ps" = m * - (N * c0 A B P Q)).

(** Stage 3 of the C answers with the position. *)
Theorem stage_three_is_right (wide : bool) a : (wide = true -> b <= alpha) ->
  fixed_answer (sign_of (num' "delta") (said "delta" * 2 ^ grown)) (sign_of (num "n2") (said "coefficient"))
    (sign_of (num "n1") (said "coefficient")) (sign_of (num "offset_at_B") (said "pole")) (sign_of (num "slope_at_B") (said "pole"))
    (sign_of (num "offset_at_A") (said "pole")) (sign_of (num "slope_at_A") (said "pole"))
    (sign_of (num' "middle") (said "middle" * 2 ^ grown)) wide = Some a ->
  is_position (upright alpha gamma b d cx cy cz) a.
Proof.
  intros Wide F; refine (signs_are_right _ _ wide a _ _ Wide F).
  - pose proof (delta_decides num' x' shift' Discriminant A B P Q N m r N0 M0 R0 XN X2 X1 XP grown Grown Balanced) as D.
    exact (by_sign _ _ (delta A B P Q) (delta A B P Q) 1 Rlt_0_1 ltac:(ring) D).
  - intros H; apply (middle_decides num' x' shift' Discriminant A B P Q N m r N0 M0 R0 XN X2 X1 XP grown Grown Balanced).
    revert H; unfold sign_of; match goal with |- context [Z.ltb ?v ?w] => destruct (Z.ltb_spec v w) end; [auto |].
    match goal with |- context [if ?c then _ else _] => destruct c; discriminate end.
Qed.

End Poles.
