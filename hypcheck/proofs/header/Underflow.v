(** Underflow in the steps that Coq reads in the C: each value lies near one of a run in which nothing underflows.

    [cells] goes through the steps and gives for each name the expression that it computes, and an exponent: a run of that expression
    with relative roundings alone, as Rounding.v supposes, ends within that power of two, or, where no exponent is given, with
    the same value. [Ranges.sizes] says how large the values are, and which results are normal. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Flocq Require Import Core.
From Hypcheck Require Import Geometry Rounding Floats Steps FixedRuns RunningBound Ranges.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

(** One operation: a relative error, and what underflow loses; no more than the least normal number, and nothing of a normal result. *)
Lemma rounding_loses p v : returned p v -> Rabs p <= pow 1023 -> exists t, Rabs t <= unit_of_any_mode /\ Rabs (v - p * (1 + t)) <= pow (-1022)
  /\ (pow (-1022) <= Rabs p -> v = p * (1 + t)).
Proof.
  intros R H; pose proof (bpow_gt_0 radix2 (-1022)) as W; assert (U0 : 0 <= unit_of_any_mode) by apply bpow_ge_0.
  destruct (Rle_or_lt (pow (-1022)) (Rabs p)) as [N | N].
  - destruct R as [(rnd & V & ->) | [[T _] | [T _]]]; [| lra | lra].
    destruct (any_mode_rounds rnd p V (or_intror N)) as (t & T & E); exists t; rewrite E; repeat split; [exact T |].
    rewrite Rminus_diag_eq, Rabs_R0 by reflexivity; lra.
  - exists 0; rewrite Rabs_R0, Rplus_0_r, Rmult_1_r; repeat split; [exact U0 | | lra].
    assert (S : forall q w, 0 <= q <= pow (-1022) -> 0 <= w <= pow (-1022) -> Rabs (w - q) <= pow (-1022)) by (intros; apply Rabs_le; lra).
    destruct R as [R | [[_ ->] | [T _]]]; [| replace (0 - p) with (- p) by ring; rewrite Rabs_Ropp; lra
      | pose proof (bpow_lt radix2 (-1022) 1023 ltac:(lia)); lra].
    pose proof (stays_small p v (-1022) R ltac:(lia) ltac:(lra)) as B; destruct (Rle_or_lt 0 p) as [P | P].
    + pose proof (stays_positive p v R P); rewrite Rabs_pos_eq in N, B by assumption; apply S; lra.
    + assert (V : v <= 0) by (destruct R as (rnd & VR & ->); apply round_le_generic; [exact its_exponents | exact VR | apply generic_format_0 | lra]).
      rewrite Rabs_left1 in N, B by lra; replace (v - p) with (- (- v - - p)) by ring; rewrite Rabs_Ropp; apply S; lra.
Qed.

Definition float := generic_format radix2 binary64.

Lemma returned_float p v : returned p v -> Rabs p <= pow 1023 -> float v.
Proof.
  intros [(rnd & V & ->) | [[_ ->] | [T _]]] H; [apply generic_format_round; [exact its_exponents | exact V] | apply generic_format_0 | lra].
Qed.

#[local] Instance bits_53 : Prec_gt_0 53 := eq_refl.

(** A float times a power of two is a float, and rounded to itself. *)
Lemma doubled_float k v : (0 <= k)%Z -> float v -> float (pow k * v).
Proof.
  intros K F; destruct (FLT_format_generic radix2 (-1074) 53 v F) as [[m e] E1 E2 E3]; cbn [Fnum Fexp] in *.
  apply generic_format_FLT; apply (FLT_spec radix2 (-1074) 53 _ (Float radix2 m (k + e))); cbn [Fnum Fexp]; [| exact E2 | lia].
  rewrite E1; unfold F2R; cbn [Fnum Fexp]; rewrite bpow_plus; ring.
Qed.

Lemma float_stays p v : returned p v -> Rabs p <= pow 1023 -> float p -> Rabs (v - p) <= pow (-1022) /\ (pow (-1022) <= Rabs p -> v = p).
Proof.
  pose proof (bpow_gt_0 radix2 (-1022)) as W; intros [(rnd & V & ->) | [[T ->] | [T _]]] H F; [| | lra].
  - rewrite round_generic by assumption; rewrite Rminus_diag_eq, Rabs_R0 by reflexivity; lra.
  - replace (0 - p) with (- p) by ring; rewrite Rabs_Ropp; lra.
Qed.

(** ** What is lost: nothing, or a power of two at most. *)

Definition loses (l : option Z) d := match l with None => d = 0 | Some k => Rabs d <= pow k end.
Definition joined (a c : option Z) := match a, c with None, l | l, None => l | Some k, Some m => Some (Z.max k m + 1)%Z end.
Definition times k (a : option Z) := match a with None => None | Some l => Some (k + l)%Z end.

Lemma loses_none a : loses a 0.
Proof. destruct a; cbn; [rewrite Rabs_R0; apply bpow_ge_0 | reflexivity]. Qed.
Lemma joined_loses a c d e : loses a d -> loses c e -> loses (joined a c) (d + e).
Proof.
  destruct a as [k |], c as [m |]; cbn [loses joined]; intros H K; try subst d; try subst e; rewrite ?Rplus_0_l, ?Rplus_0_r; try assumption; [| reflexivity].
  rewrite <- double; pose proof (Rabs_triang d e); pose proof (at_most _ _ (Z.le_max_l k m)); pose proof (at_most _ _ (Z.le_max_r k m)); lra.
Qed.
Lemma joined_left a c d : loses a d -> loses (joined a c) d.
Proof. intros H; rewrite <- (Rplus_0_r d); apply joined_loses; [exact H | apply loses_none]. Qed.
Lemma times_loses k a v d : Rabs v <= pow k -> loses a d -> loses (times k a) (v * d).
Proof.
  intros V; destruct a as [l |]; cbn [loses times]; intros H; [| subst d; ring].
  rewrite Rabs_mult, bpow_plus; apply Rmult_le_compat; auto using Rabs_pos.
Qed.
Lemma times_1_loses a d : loses a d -> loses (times 1 a) d.
Proof. destruct a as [k |]; cbn [loses times]; [| auto]; intros H; pose proof (at_most k (1 + k) ltac:(lia)); lra. Qed.
Lemma loses_opposite a d : loses a d -> loses a (- d).
Proof. destruct a; cbn; intros H; [rewrite Rabs_Ropp; exact H | lra]. Qed.

(** ** The steps. *)

Record cell := Cell { tree : expr; loss : option Z; unrounded : bool }.

Section Cells.

Variables (multiplied floats : list string) (x pre : string -> R) (entry : nat -> nat) (env : nat -> R).
Notation u := unit_of_any_mode.

Definition stands c v := exists w, computes u entry env (tree c) w /\ loses (loss c) (v - w).

Definition of_given table (a : argument) := match a with Name n => look n table | Number z => Some (Cell (Whole z) None true) end.
Definition of_taken table (a : argument) := match a with
  | Name n => match look n table with Some c => if negb (is_in n multiplied) || unrounded c then Some c else None | None => None end
  | Number z => Some (Cell (Whole z) None true) end.

Definition is_normal_size r := match low r with Some k => (-1022 <=? k)%Z | None => false end.
Definition by_rounding r := if is_normal_size r then None else Some (-1022)%Z.
Definition after r l := joined (times 1 l) (by_rounding r).

(** A factor of 2 or 4 rounds no float. *)
Definition shift a c := match a, c with
  | Number z, Name n => if is_in n floats then if (z =? 2)%Z then Some 1%nat else if (z =? 4)%Z then Some 2%nat else None else None
  | _, _ => None end.

(** How large what a run without losses has in the place of a value of this size can be. *)
Definition reach s l := match l with None => high s | Some k => (Z.max (high s) k + 1)%Z end.

(** What a product loses of what its factors have lost. *)
Definition of_product known a c l k : option (option Z) := match l, k, of_argument known a, of_argument known c with
  | None, None, _, _ => Some None
  | _, _, Some s, Some t => Some (joined (times (high s) k) (times (reach t k) l))
  | _, _, _, _ => None end.

Definition cell_of known table (s : step) : option cell := match kind_of s, arguments (meaning s), look (name s) known with
  | Some Plus, [a; c], Some r => match of_taken table a, of_taken table c with
    | Some p, Some q => Some (Cell (Add (tree p) (tree q)) (after r (joined (loss p) (loss q))) true) | _, _ => None end
  | Some Minus, [a; c], Some r => match of_taken table a, of_taken table c with
    | Some p, Some q => Some (Cell (Sub (tree p) (tree q)) (after r (joined (loss p) (loss q))) true) | _, _ => None end
  | Some Times, [a; c], Some r => match of_given table a, of_given table c with
    | Some p, Some q => match shift a c, of_product known a c (loss p) (loss q) with
      | Some k, _ => Some (Cell (Scale k (tree q)) (joined (times (Z.of_nat k) (loss q)) (by_rounding r)) true)
      | None, Some l => Some (Cell (Mul (tree p) (tree q)) (after r l) true)
      | None, None => None end
    | _, _ => None end
  | Some Over, [a; c], Some r => match of_given table a, of_given table c, of_argument known c with
    | Some p, Some q, Some t => match loss q, low t with
      | None, Some k => Some (Cell (Div (tree p) (tree q)) (after r (times (- k) (loss p))) true) | _, _ => None end
    | _, _, _ => None end
  | Some Negated, [a], _ => match of_given table a, of_taken table a with
    | Some p, Some _ => Some (Cell (Neg (tree p)) (loss p) true) | _, _ => None end
  | _, _, _ => None end.

Fixpoint cells known table (l : list step) := match l with
  | [] => table
  | s :: rest => match look (name s) table, cell_of known table s with
    | None, Some c => cells known ((name s, c) :: table) rest
    | _, _ => cells known table rest end end.

Definition all_stand table := forall n c, look n table = Some c ->
  stands c (x n) /\ (unrounded c = true -> is_in n multiplied = true -> stands c (pre n)).

Hypothesis Floats : forall n, is_in n floats = true -> float (x n).

Lemma given_stands table a c p : all_stand table -> of_given table a = Some c -> has x a p -> stands c p.
Proof.
  intros T; destruct a as [n | z]; cbn; intros E H; subst p.
  - apply T; exact E.
  - injection E as <-; exists (IZR z); split; [apply c_whole | cbn; ring].
Qed.
Lemma taken_stands table a c p : all_stand table -> of_taken table a = Some c -> takes multiplied x pre a p -> stands c p.
Proof.
  intros T; destruct a as [n | z]; cbn; intros E H.
  - destruct (look n table) as [q |] eqn:L; [| discriminate]; destruct (negb (is_in n multiplied) || unrounded q) eqn:M; [| discriminate].
    injection E as <-; destruct (T n q L) as [T1 T2]; destruct H as [-> | [H ->]]; [exact T1 |].
    rewrite H in M; apply T2; assumption.
  - subst p; injection E as <-; exists (IZR z); split; [apply c_whole | cbn; ring].
Qed.

(** A result whose exact value lies near that of a run without losses lies near the rounded one. *)
Lemma after_rounding r l p v w : within r p -> (high r <= 1023)%Z -> returned p v -> loses l (p - w) ->
  exists t, Rabs t <= u /\ loses (after r l) (v - w * (1 + t)).
Proof.
  intros (H & P & L) F R D; pose proof (at_most _ _ F).
  destruct (rounding_loses p v R ltac:(lra)) as (t & T & E & N); exists t; split; [exact T |].
  replace (v - w * (1 + t)) with ((1 + t) * (p - w) + (v - p * (1 + t))) by ring; apply joined_loses.
  - apply times_loses; [| exact D]; change (pow 1) with 2; pose proof (Rabs_triang 1 t); rewrite Rabs_R1 in *.
    assert (u <= 1) by (unfold unit_of_any_mode; simpl; lra); lra.
  - unfold by_rounding, is_normal_size; destruct (low r) as [k |]; [| exact E]; destruct (Z.leb_spec (-1022) k) as [K |]; [| exact E].
    cbn; rewrite N; [ring |]; pose proof (at_most _ _ K); pose proof (Rle_abs p); lra.
Qed.

Lemma zero_error : Rabs 0 <= u.
Proof. rewrite Rabs_R0; apply bpow_ge_0. Qed.

Lemma product_loses known a c l k r v w v' w' p : all_hold x pre known -> of_product known a c l k = Some r ->
  has x a v -> has x c w -> loses l (v - v') -> loses k (w - w') -> p = v * w -> loses r (p - v' * w').
Proof.
  intros K E HA HC LV LW ->; replace (v * w - v' * w') with (v * (w - w') + w' * (v - v')) by ring.
  unfold of_product in E; assert (G : l = None /\ k = None \/ exists s t, of_argument known a = Some s /\ of_argument known c = Some t
    /\ r = joined (times (high s) k) (times (reach t k) l)).
  { destruct l, k, (of_argument known a) as [s |], (of_argument known c) as [t |]; try discriminate; auto;
      injection E as <-; right; exists s, t; auto. }
  destruct G as [[-> ->] | (s & t & SA & SC & ->)].
  - assert (R0 : r = None) by (destruct (of_argument known a), (of_argument known c); congruence); subst r.
    cbn in *; rewrite LV, LW; ring.
  - destruct (argument_within multiplied x pre known a s v K SA (has_taken _ _ _ _ _ HA)) as (H1 & _).
    destruct (argument_within multiplied x pre known c t w K SC (has_taken _ _ _ _ _ HC)) as (H2 & _).
    apply joined_loses; apply times_loses; try assumption.
    unfold reach; destruct k as [k |]; cbn [loses] in LW; [| replace w' with w by lra; exact H2].
    rewrite <- double; replace w' with (w + - (w - w')) by ring; pose proof (Rabs_triang w (- (w - w'))); rewrite Rabs_Ropp in *.
    pose proof (at_most _ _ (Z.le_max_l (high t) k)); pose proof (at_most _ _ (Z.le_max_r (high t) k)); lra.
Qed.

Lemma step_stands known table s c : all_hold x pre known -> (forall n r, look n known = Some r -> (high r <= 1023)%Z) ->
  all_stand table -> runs multiplied x pre s -> cell_of known table s = Some c ->
  stands c (x (name s)) /\ stands c (pre (name s)).
Proof.
  intros K F T R E; unfold cell_of in E; unfold runs in R.
  assert (keep : forall l r d, loses l d -> loses (after r l) d) by (intros; apply joined_left, times_1_loses; assumption).
  destruct (kind_of s) as [[] |]; try discriminate; destruct (arguments (meaning s)) as [| a [| a' [|]]]; try discriminate; try contradiction.
  - destruct (look (name s) known) as [r |] eqn:S; [| discriminate]; destruct (K _ _ S) as [_ W]; pose proof (F _ _ S) as FR.
    destruct (of_taken table a) as [p |] eqn:A; [| discriminate]; destruct (of_taken table a') as [q |] eqn:C; [| discriminate].
    injection E as <-; destruct R as (v & w & TA & TC & PRE & RO).
    destruct (taken_stands _ _ _ _ T A TA) as (v' & V & LV); destruct (taken_stands _ _ _ _ T C TC) as (w' & V2 & LW).
    assert (D : loses (joined (loss p) (loss q)) (pre (name s) - (v' + w'))).
    { rewrite PRE; replace (v + w - (v' + w')) with ((v - v') + (w - w')) by ring; apply joined_loses; assumption. }
    split.
    + destruct (after_rounding r _ _ _ _ W FR RO D) as (t & T1 & T2); exists ((v' + w') * (1 + t)); split; [apply c_add; assumption | exact T2].
    + exists ((v' + w') * (1 + 0)); split; [apply c_add; auto using zero_error | rewrite Rplus_0_r, Rmult_1_r; apply keep; exact D].
  - destruct (look (name s) known) as [r |] eqn:S; [| discriminate]; destruct (K _ _ S) as [_ W]; pose proof (F _ _ S) as FR.
    destruct (of_taken table a) as [p |] eqn:A; [| discriminate]; destruct (of_taken table a') as [q |] eqn:C; [| discriminate].
    injection E as <-; destruct R as (v & w & TA & TC & PRE & RO).
    destruct (taken_stands _ _ _ _ T A TA) as (v' & V & LV); destruct (taken_stands _ _ _ _ T C TC) as (w' & V2 & LW).
    assert (D : loses (joined (loss p) (loss q)) (pre (name s) - (v' - w'))).
    { rewrite PRE; replace (v - w - (v' - w')) with ((v - v') + - (w - w')) by ring; apply joined_loses; [| apply loses_opposite]; assumption. }
    split.
    + destruct (after_rounding r _ _ _ _ W FR RO D) as (t & T1 & T2); exists ((v' - w') * (1 + t)); split; [apply c_sub; assumption | exact T2].
    + exists ((v' - w') * (1 + 0)); split; [apply c_sub; auto using zero_error | rewrite Rplus_0_r, Rmult_1_r; apply keep; exact D].
  - destruct (look (name s) known) as [r |] eqn:S; [| discriminate]; destruct (K _ _ S) as [_ W]; pose proof (F _ _ S) as FR.
    destruct (of_given table a) as [p |] eqn:A; [| discriminate]; destruct (of_given table a') as [q |] eqn:C; [| discriminate].
    destruct R as (v & w & TA & TC & PRE & RO).
    destruct (given_stands _ _ _ _ T A TA) as (v' & V & LV); destruct (given_stands _ _ _ _ T C TC) as (w' & V2 & LW).
    destruct (shift a a') as [k |] eqn:SH; [injection E as <- | destruct (of_product known a a' (loss p) (loss q)) as [l |] eqn:L; [injection E as <- | discriminate]].
    + assert (P2 : v = pow (Z.of_nat k) /\ float w).
      { unfold shift in SH; destruct a as [| z]; [discriminate |]; destruct a' as [n |]; [| discriminate].
        destruct (is_in n floats) eqn:I; [| discriminate]; cbn in TA, TC; subst v w; split; [| apply Floats; exact I].
        destruct (Z.eqb_spec z 2) as [-> |]; [injection SH as <-; reflexivity |]; destruct (Z.eqb_spec z 4) as [-> |]; [injection SH as <-; reflexivity | discriminate]. }
      destruct P2 as [-> FW]; assert (FP : float (pow (Z.of_nat k) * w)) by (apply doubled_float; [lia | exact FW]); rewrite <- PRE in FP.
      assert (EQ : 2 ^ k = pow (Z.of_nat k)) by (rewrite <- IZR_Zpower by lia; rewrite pow_IZR; reflexivity).
      assert (D : loses (times (Z.of_nat k) (loss q)) (pre (name s) - 2 ^ k * w')).
      { rewrite PRE, EQ, <- Rmult_minus_distr_l; apply times_loses; [rewrite Rabs_pos_eq by apply bpow_ge_0; lra | exact LW]. }
      destruct W as (HW & PW & LOW); pose proof (at_most _ _ FR); destruct (float_stays _ _ RO ltac:(lra) FP) as [G1 G2].
      split; exists (2 ^ k * w'); (split; [apply c_scale; exact V2 |]); [| apply joined_left; exact D].
      replace (x (name s) - 2 ^ k * w') with ((pre (name s) - 2 ^ k * w') + (x (name s) - pre (name s))) by ring.
      apply joined_loses; [exact D |]; unfold by_rounding, is_normal_size; destruct (low r) as [m |]; [| exact G1].
      destruct (Z.leb_spec (-1022) m) as [M |]; [| exact G1]; cbn; rewrite G2; [ring |].
      pose proof (at_most _ _ M); pose proof (Rle_abs (pre (name s))); lra.
    + assert (D : loses l (pre (name s) - v' * w')).
      { apply product_loses with known a a' (loss p) (loss q) v w; assumption. }
      split.
      * destruct (after_rounding r _ _ _ _ W FR RO D) as (t & T1 & T2); exists (v' * w' * (1 + t)); split; [apply c_mul; assumption | exact T2].
      * exists (v' * w' * (1 + 0)); split; [apply c_mul; auto using zero_error | rewrite Rplus_0_r, Rmult_1_r; apply keep; exact D].
  - destruct (look (name s) known) as [r |] eqn:S; [| discriminate]; destruct (K _ _ S) as [_ W]; pose proof (F _ _ S) as FR.
    destruct (of_given table a) as [p |] eqn:A; [| discriminate]; destruct (of_given table a') as [q |] eqn:C; [| discriminate].
    destruct (of_argument known a') as [sc |] eqn:SC; [| discriminate]; destruct (loss q) eqn:LQ; [discriminate |].
    destruct (low sc) as [k |] eqn:LC; [| discriminate]; injection E as <-; destruct R as (v & w & TA & TC & PRE & RO).
    destruct (given_stands _ _ _ _ T A TA) as (v' & V & LV); destruct (given_stands _ _ _ _ T C TC) as (w' & V2 & LW).
    rewrite LQ in LW; cbn in LW; assert (w' = w) by lra; subst w'.
    destruct (argument_within multiplied x pre known a' sc w K SC (has_taken _ _ _ _ _ TC)) as (_ & _ & HC); rewrite LC in HC.
    pose proof (bpow_gt_0 radix2 k); assert (I1 : Rabs (/ w) <= pow (- k)).
    { rewrite Rabs_pos_eq by (left; apply Rinv_0_lt_compat; lra); rewrite bpow_opp; apply Rinv_le_contravar; assumption. }
    assert (D : loses (times (- k) (loss p)) (pre (name s) - v' / w)).
    { rewrite PRE; replace (v / w - v' / w) with (/ w * (v - v')) by (unfold Rdiv; ring); apply times_loses; assumption. }
    split.
    + destruct (after_rounding r _ _ _ _ W FR RO D) as (t & T1 & T2); exists (v' / w * (1 + t)); split; [apply c_div; assumption | exact T2].
    + exists (v' / w * (1 + 0)); split; [apply c_div; auto using zero_error | rewrite Rplus_0_r, Rmult_1_r; apply keep; exact D].
  - destruct (of_given table a) as [p |] eqn:A; [| discriminate]; destruct (of_taken table a) as [q |] eqn:C; [| discriminate].
    injection E as <-; destruct R as (v & w & TA & HA & -> & ->).
    assert (PQ : q = p).
    { destruct a as [n | z]; cbn in A, C; [| congruence]; rewrite A in C; destruct (negb _ || _); congruence. }
    subst q; split; [destruct (given_stands _ _ _ _ T A HA) as (w' & V & L) | destruct (taken_stands _ _ _ _ T C TA) as (w' & V & L)];
      exists (- w'); (split; [apply c_neg; exact V |]); cbn [loss].
    + replace (- w - - w') with (- (w - w')) by ring; apply loses_opposite; exact L.
    + replace (- v - - w') with (- (v - w')) by ring; apply loses_opposite; exact L.
Qed.

Theorem cells_stand known l : forall table, all_hold x pre known -> (forall n r, look n known = Some r -> (high r <= 1023)%Z) ->
  Forall (runs multiplied x pre) l -> all_stand table -> all_stand (cells known table l).
Proof.
  induction l as [| s l IH]; cbn [cells]; intros table K F R T; [exact T |]; inversion R; subst.
  destruct (look (name s) table); [apply IH; assumption |]; destruct (cell_of known table s) as [c |] eqn:E; [| apply IH; assumption].
  apply IH; try assumption; intros n q M; cbn [look] in M; destruct (String.eqb_spec (name s) n) as [<- | N]; [injection M as <- | apply T; exact M].
  destruct (step_stands known table s c K F T) as [S1 S2]; auto.
Qed.

End Cells.
