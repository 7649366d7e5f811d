(** Guards and the range of float64: what each step of the C can be, as powers of two, whatever the rounding and the contraction.

    [sizes] goes through the steps that Coq reads in the C, and gives for each an exponent that its value does not exceed, and, of
    positive numbers, one that it is not below. Stage 2's guards are taken as C asks them, of computed numbers: an overflow in
    what they are computed from counts as a number of 2^1023 or more, which the guards refuse. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Flocq Require Import Core.
From Hypcheck Require Import Geometry Floats Steps FixedRuns.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Notation pow := (bpow radix2).

(** ** Sizes. *)

Record size := Size { low : option Z; positive : bool; high : Z }.
Definition within s v := Rabs v <= pow (high s) /\ (positive s = true -> 0 <= v)
  /\ match low s with Some l => pow l <= v | None => True end.

(** One correct rounding, in any mode. *)
Definition rounded p v := exists rnd, Valid_rnd rnd /\ v = round radix2 binary64 rnd p.

#[local] Instance its_exponents : Valid_exp binary64.
Proof. apply FLT_exp_valid; reflexivity. Qed.

Lemma power_is_float e : (-1074 <= e)%Z -> generic_format radix2 binary64 (pow e).
Proof. intros E; apply generic_format_bpow; unfold binary64, FLT_exp; lia. Qed.

Lemma stays_above p v e : rounded p v -> (-1074 <= e)%Z -> pow e <= p -> pow e <= v.
Proof. intros (rnd & V & ->) E H; apply round_ge_generic; [exact its_exponents | exact V | apply power_is_float; exact E | exact H]. Qed.
Lemma stays_below p v e : rounded p v -> (-1074 <= e)%Z -> p <= pow e -> v <= pow e.
Proof. intros (rnd & V & ->) E H; apply round_le_generic; [exact its_exponents | exact V | apply power_is_float; exact E | exact H]. Qed.
Lemma stays_positive p v : rounded p v -> 0 <= p -> 0 <= v.
Proof. intros (rnd & V & ->) H; apply round_ge_generic; [exact its_exponents | exact V | apply generic_format_0 | exact H]. Qed.
Lemma stays_small p v e : rounded p v -> (-1074 <= e)%Z -> Rabs p <= pow e -> Rabs v <= pow e.
Proof. intros (rnd & V & ->) E H; apply abs_round_le_generic; [exact its_exponents | exact V | apply power_is_float; exact E | exact H]. Qed.

(** What a processor makes of an exact result p: p rounded; or 0, where p is below the normal range and is flushed; or, where p
    overflows, the greatest float or infinity, which are here numbers of 2^1023 or more with the sign of p. *)
Definition returned p v := rounded p v \/ (Rabs p < pow (-1022) /\ v = 0) \/ (pow 1023 < Rabs p /\ pow 1023 <= Rabs v /\ 0 <= p * v).

(** Powers that are floats: none overflows, and those below are normal or are not told. *)
Definition fit s := (-1074 <=? high s)%Z && (high s <=? 1023)%Z && match low s with Some l => (-1022 <=? l)%Z | None => true end.

Lemma rounding_within s p v : fit s = true -> returned p v -> within s p -> within s v.
Proof.
  unfold fit; intros F R (H & P & L); apply andb_prop in F as [F FL]; apply andb_prop in F as [F1 F2]; apply Z.leb_le in F1, F2.
  pose proof (bpow_le radix2 _ _ F2); destruct R as [R | [[T ->] | [T _]]]; [| | lra]; repeat split.
  - apply stays_small with p; assumption.
  - intros E; apply stays_positive with p; auto.
  - destruct (low s) as [l |]; [| exact I]; apply Z.leb_le in FL; apply stays_above with p; try assumption; lia.
  - rewrite Rabs_R0; apply bpow_ge_0.
  - intros _; lra.
  - destruct (low s) as [l |]; [| exact I]; apply Z.leb_le in FL; pose proof (bpow_le radix2 _ _ FL); pose proof (Rle_abs p); lra.
Qed.

Definition no_less (a c : option Z) := match a, c with Some l, Some k => Some (Z.max l k) | Some l, None | None, Some l => Some l | None, None => None end.
Definition both (f : Z -> Z -> Z) (a c : option Z) := match a, c with Some l, Some k => Some (f l k) | _, _ => None end.

Definition add s t := Size (if positive s && positive t then no_less (low s) (low t) else None) (positive s && positive t) (Z.max (high s) (high t) + 1).
Definition sub s t := Size None false (Z.max (high s) (high t) + 1).
Definition mul s t := Size (if positive s && positive t then both Z.add (low s) (low t) else None) (positive s && positive t) (high s + high t).
Definition div s t := match low t with
  | Some l => Some (Size (if positive s then match low s with Some k => Some (k - high t)%Z | None => None end else None) (positive s) (high s - l))
  | None => None end.
Definition neg s := Size None false (high s).
Definition abs s := Size (low s) true (high s).

Lemma double e : pow e + pow e = pow (e + 1).
Proof. rewrite bpow_plus; change (pow 1) with 2; ring. Qed.
Lemma at_most a c : (a <= c)%Z -> pow a <= pow c.
Proof. apply bpow_le. Qed.

Lemma sum_small v w s t : Rabs v <= pow (high s) -> Rabs w <= pow (high t) -> Rabs (v + w) <= pow (Z.max (high s) (high t) + 1).
Proof.
  intros H K; rewrite <- double; pose proof (Rabs_triang v w); pose proof (at_most _ _ (Z.le_max_l (high s) (high t)));
    pose proof (at_most _ _ (Z.le_max_r (high s) (high t))); lra.
Qed.

Lemma add_within s t v w : within s v -> within t w -> within (add s t) (v + w).
Proof.
  intros (H & P & L) (K & Q & M); unfold add; repeat split; cbn [high positive low].
  - apply sum_small; assumption.
  - intros E; apply andb_prop in E as [E1 E2]; specialize (P E1); specialize (Q E2); lra.
  - destruct (positive s); [| exact I]; destruct (positive t); [| exact I]; cbn; specialize (P eq_refl); specialize (Q eq_refl).
    destruct (low s) as [l |], (low t) as [k |]; cbn; try lra.
    destruct (Z.max_spec l k) as [[_ ->] | [_ ->]]; lra.
Qed.
Lemma sub_within s t v w : within s v -> within t w -> within (sub s t) (v - w).
Proof.
  intros (H & _) (K & _); repeat split; cbn; [| discriminate]; apply (sum_small v (- w)); [exact H | rewrite Rabs_Ropp; exact K].
Qed.
Lemma mul_within s t v w : within s v -> within t w -> within (mul s t) (v * w).
Proof.
  intros (H & P & L) (K & Q & M); unfold mul; repeat split; cbn [high positive low].
  - rewrite Rabs_mult, bpow_plus; apply Rmult_le_compat; auto using Rabs_pos.
  - intros E; apply andb_prop in E as [E1 E2]; apply Rmult_le_pos; auto.
  - destruct (positive s && positive t); [| exact I]; destruct (low s), (low t); cbn; try exact I.
    rewrite bpow_plus; apply Rmult_le_compat; auto using bpow_ge_0.
Qed.
Lemma div_within s t v w r : div s t = Some r -> within s v -> within t w -> within r (v / w).
Proof.
  unfold div; intros E (H & P & L) (K & Q & M); destruct (low t) as [l |]; [| discriminate]; injection E as <-.
  assert (W : 0 < w) by (pose proof (bpow_gt_0 radix2 l); lra).
  assert (I1 : / w <= pow (- l)).
  { rewrite bpow_opp; apply Rinv_le_contravar; [apply bpow_gt_0 | exact M]. }
  assert (I0 : 0 < / w) by (apply Rinv_0_lt_compat; exact W).
  repeat split; cbn [high positive low].
  - unfold Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ w)) by lra; unfold Z.sub; rewrite bpow_plus.
    apply Rmult_le_compat; auto using Rabs_pos; lra.
  - intros E; apply over_pos; auto.
  - destruct (positive s); [| exact I]; destruct (low s) as [k |]; [| exact I]; unfold Z.sub; rewrite bpow_plus.
    apply Rmult_le_compat; auto using bpow_ge_0; rewrite bpow_opp; apply Rinv_le_contravar; [exact W |].
    rewrite Rabs_pos_eq in K by lra; exact K.
Qed.
Lemma neg_within s v : within s v -> within (neg s) (- v).
Proof. intros (H & _); repeat split; cbn; [rewrite Rabs_Ropp; exact H | discriminate]. Qed.
Lemma abs_within s v : within s v -> within (abs s) (Rabs v).
Proof.
  intros (H & P & L); repeat split; cbn; [rewrite Rabs_Rabsolu; exact H | intros _; apply Rabs_pos |].
  destruct (low s) as [l |]; [| exact I]; pose proof (Rle_abs v); lra.
Qed.

Definition whole z := Size (Some (Z.log2 z)) true (Z.log2_up z).
Lemma whole_within z : (0 < z)%Z -> within (whole z) (IZR z).
Proof.
  intros Z0; assert (P : 0 <= IZR z) by (apply (IZR_le 0); lia); repeat split; cbn.
  - rewrite Rabs_pos_eq by exact P; rewrite <- IZR_Zpower by apply Z.log2_up_nonneg; apply IZR_le.
    destruct (Z.le_gt_cases z 1) as [O | O]; [replace z with 1%Z by lia; cbn; lia | apply (Z.log2_up_spec z O)].
  - intros _; exact P.
  - rewrite <- IZR_Zpower by apply Z.log2_nonneg; apply IZR_le; apply (Z.log2_spec z Z0).
Qed.

(** ** The run: [pre] is a result before it is rounded. A sum or difference may take that of a product in its place: they are contracted. *)

Section Run.

Variables (multiplied : list string) (x pre : string -> R).

Definition has (a : argument) p := match a with Name n => p = x n | Number z => p = IZR z end.
Definition takes (a : argument) p := match a with Name n => p = x n \/ (is_in n multiplied = true /\ p = pre n) | Number z => p = IZR z end.

Lemma has_taken a p : has a p -> takes a p.
Proof. destruct a; cbn; auto. Qed.

Inductive kind := Plus | Minus | Times | Over | Negated | Sized.
Definition kind_of (s : step) := look (operation (meaning s)) [("add", Plus); ("sub", Minus); ("mul", Times); ("div", Over); ("neg", Negated);
  ("abs", Sized)].

Definition runs (s : step) : Prop := let n := name s in match kind_of s, arguments (meaning s) with
  | Some Plus, [a; c] => exists p q, takes a p /\ takes c q /\ pre n = p + q /\ returned (pre n) (x n)
  | Some Minus, [a; c] => exists p q, takes a p /\ takes c q /\ pre n = p - q /\ returned (pre n) (x n)
  | Some Times, [a; c] => exists p q, has a p /\ has c q /\ pre n = p * q /\ returned (pre n) (x n)
  | Some Over, [a; c] => exists p q, has a p /\ has c q /\ pre n = p / q /\ returned (pre n) (x n)
  | Some Negated, [a] => exists p q, takes a p /\ has a q /\ pre n = - p /\ x n = - q
  | Some Sized, [a] => exists p, has a p /\ pre n = Rabs p /\ x n = Rabs p
  | Some _, _ => False | None, _ => True end.

(** What the comparisons of the C mean, where [holds] says which of them hold. *)
Definition compares (holds : string -> Prop) (s : step) : Prop := match operation (meaning s), arguments (meaning s) with
  | "gt", [a; c] => holds (name s) -> forall p q, has a p -> has c q -> q < p
  | "lt", [a; c] => holds (name s) -> forall p q, has a p -> has c q -> p < q
  | "ge", [a; c] => holds (name s) -> forall p q, has a p -> has c q -> q <= p
  | "le", [a; c] => holds (name s) -> forall p q, has a p -> has c q -> p <= q
  | "and", [Name a; Name c] => holds (name s) -> holds a /\ holds c
  | "or", [Name a; Name c] => holds (name s) -> holds a \/ holds c
  | _, _ => True end.

Definition of_argument known a := match a with Name n => look n known | Number z => if (0 <? z)%Z then Some (whole z) else None end.
Definition two known a c (f : size -> size -> option size) := match of_argument known a, of_argument known c with
  | Some s, Some t => f s t | _, _ => None end.

Definition size_of known (s : step) : option size := match kind_of s, arguments (meaning s) with
  | Some Plus, [a; c] => two known a c (fun s t => Some (add s t))
  | Some Minus, [a; c] => two known a c (fun s t => Some (sub s t))
  | Some Times, [a; c] => two known a c (fun s t => Some (mul s t))
  | Some Over, [a; c] => two known a c div
  | Some Negated, [a] => two known a a (fun s _ => Some (neg s))
  | Some Sized, [a] => two known a a (fun s _ => Some (abs s))
  | _, _ => None end.

(** Comparisons are no numbers, and what the guards give is known. *)
Fixpoint sizes known (l : list step) : option (list (string * size)) := match l with
  | [] => Some known
  | s :: rest => match kind_of s with None => sizes known rest | Some _ => match look (name s) known with
    | Some _ => sizes known rest
    | None => match size_of known s with
      | Some r => if fit r then sizes ((name s, r) :: known) rest else None | None => None end end end end.

Definition all_hold known := forall n s, look n known = Some s -> within s (x n) /\ within s (pre n).

Lemma argument_within known a s p : all_hold known -> of_argument known a = Some s -> takes a p -> within s p.
Proof.
  intros K; destruct a as [n | z]; cbn; intros E T.
  - apply K in E as [E1 E2]; destruct T as [-> | [_ ->]]; assumption.
  - destruct (Z.ltb_spec 0 z); [| discriminate]; injection E as <-; subst p; apply whole_within; assumption.
Qed.

Lemma step_within known s r : all_hold known -> runs s -> size_of known s = Some r -> fit r = true ->
  within r (x (name s)) /\ within r (pre (name s)).
Proof.
  intros K R E F; unfold runs, size_of, two in *.
  assert (finish : forall v, returned (pre (name s)) (x (name s)) -> pre (name s) = v -> within r v ->
    within r (x (name s)) /\ within r (pre (name s))).
  { intros v RO EV W; rewrite <- EV in W; split; [apply rounding_within with (pre (name s)) |]; assumption. }
  destruct (kind_of s) as [[] |]; [| | | | | | discriminate];
    destruct (arguments (meaning s)) as [| a [| c [|]]]; try discriminate; try contradiction;
    destruct (of_argument known a) as [sa |] eqn:A; try discriminate;
    try (destruct (of_argument known c) as [sc |] eqn:C; [| discriminate]; destruct R as (p & q & TA & TC & PRE & RO);
      try apply has_taken in TA; try apply has_taken in TC;
      pose proof (argument_within known a sa p K A TA) as WA; pose proof (argument_within known c sc q K C TC) as WC).
  - injection E as <-; apply finish with (p + q); [exact RO | exact PRE | apply add_within; assumption].
  - injection E as <-; apply finish with (p - q); [exact RO | exact PRE | apply sub_within; assumption].
  - injection E as <-; apply finish with (p * q); [exact RO | exact PRE | apply mul_within; assumption].
  - apply finish with (p / q); [exact RO | exact PRE | apply (div_within sa sc p q r E); assumption].
  - destruct R as (p & q & TA & HA & -> & ->); injection E as <-; apply has_taken in HA.
    split; apply neg_within; [apply (argument_within known a sa q K A HA) | apply (argument_within known a sa p K A TA)].
  - destruct R as (p & TA & -> & ->); apply has_taken in TA; injection E as <-; pose proof (argument_within known a sa p K A TA) as WA.
    split; apply abs_within; exact WA.
Qed.

Theorem sizes_hold l : forall known found, all_hold known -> Forall runs l -> sizes known l = Some found -> all_hold found.
Proof.
  induction l as [| s l IH]; cbn [sizes]; intros known found K R E; [injection E as <-; exact K |].
  inversion R; subst; destruct (kind_of s) eqn:O; [| apply (IH known); assumption].
  destruct (look (name s) known) eqn:L; [apply (IH known); assumption |].
  destruct (size_of known s) as [r |] eqn:G; [| discriminate]; destruct (fit r) eqn:F; [| discriminate].
  apply (IH ((name s, r) :: known)); try assumption.
  intros n q M; cbn [look] in M; destruct (String.eqb_spec (name s) n) as [<- | N]; [injection M as <- | apply K; exact M].
  apply step_within with known; assumption.
Qed.

End Run.

(** ** Stage 2. *)

Definition steps_in n := match find (fun p => String.eqb (fst p) n) HeaderText.parts with
  | Some (_, t) => match declarations t with Some l => l | None => [] end | None => [] end.
Definition C_certified := Eval vm_compute in steps_in "certified".
Definition C_single := Eval vm_compute in steps_in "single".
Theorem steps_are_read : [C_certified; C_single] = map steps_in ["certified"; "single"].
Proof. vm_cast_no_check (eq_refl [C_certified; C_single]). Qed.

Definition between l h := Size (Some l) true h.
Definition to h := Size None true h.
Definition about h := Size None false h.

Definition guarded := [("b", between (-100) 100); ("d", between (-100) 100); ("A", between (-100) 100); ("B", between (-100) 100);
  ("alpha_over_b", between (-50) 50); ("gamma_over_d", between (-50) 50); ("xx", to 400); ("yy", to 400); ("rr", to 400);
  ("z_over_d", about 101); ("P", to 200); ("Q", to 200); ("P_plus_Q", to 200); ("u_4", between (-50) (-49)); ("u_8", between (-49) (-48));
  ("u_12", between (-49) (-48)); ("u_16", between (-48) (-47)); ("u_1536", between (-42) (-41)); ("slack", between 0 1)].

Lemma below p v e : returned p v -> 0 <= p -> (-1022 <= e <= 1023)%Z -> v < pow e -> p < pow e.
Proof.
  intros R P0 [E1 E2] H; destruct R as [R | [[T ->] | (T & V & PV)]].
  - apply Rnot_le_lt; intro N; pose proof (stays_above p v e R ltac:(lia) N); lra.
  - pose proof (at_most _ _ E1); rewrite Rabs_pos_eq in T by exact P0; lra.
  - pose proof (at_most _ _ E2); rewrite Rabs_pos_eq in T by exact P0; pose proof (bpow_gt_0 radix2 1023).
    assert (0 <= v) by (apply Rmult_le_reg_l with p; lra); rewrite Rabs_pos_eq in V by assumption; lra.
Qed.
Lemma above p v e : returned p v -> 0 <= p -> (-1022 <= e < 1023)%Z -> pow e < v -> pow e < p.
Proof.
  intros R P0 [E1 E2] H; pose proof (bpow_gt_0 radix2 e); destruct R as [R | [[T ->] | (T & V & PV)]]; [| lra |].
  - apply Rnot_le_lt; intro N; pose proof (stays_below p v e R ltac:(lia) N); lra.
  - rewrite Rabs_pos_eq in T by exact P0; pose proof (bpow_lt radix2 e 1023 E2); lra.
Qed.
Lemma no_more p v e : returned p v -> 0 <= p -> (-1022 <= e <= 1023)%Z -> p <= pow e -> v <= pow e.
Proof.
  intros R P0 [E1 E2] H; destruct R as [R | [[T ->] | (T & V & PV)]].
  - apply stays_below with p; [exact R | lia | exact H].
  - apply bpow_ge_0.
  - rewrite Rabs_pos_eq in T by exact P0; pose proof (at_most _ _ E2); lra.
Qed.
Lemma root_below r e : 0 <= r -> r * r < pow (2 * e) -> r < pow e.
Proof.
  intros P H; replace (2 * e)%Z with (e + e)%Z in H by lia; rewrite bpow_plus in H; apply Rnot_le_lt; intro N.
  pose proof (Rmult_le_compat _ _ _ _ (bpow_ge_0 radix2 e) (bpow_ge_0 radix2 e) N N); lra.
Qed.
Lemma root_above r e : 0 <= r -> pow (2 * e) < r * r -> pow e < r.
Proof.
  intros P H; replace (2 * e)%Z with (e + e)%Z in H by lia; rewrite bpow_plus in H; apply Rnot_le_lt; intro N.
  pose proof (Rmult_le_compat _ _ _ _ P P N N); lra.
Qed.

Section Guards.

Variables (multiplied : list string) (x pre : string -> R).

(** Inputs are floats, each step of which the guards are made returns its result, and the constants are those of the header. *)
Hypotheses (Inputs : forall n, In n ["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"] -> pre n = x n)
  (Constants : forall n s, In (n, s) [("u_4", between (-50) (-49)); ("u_8", between (-49) (-48)); ("u_12", between (-49) (-48));
    ("u_16", between (-48) (-47)); ("u_1536", between (-42) (-41)); ("slack", between 0 1)] -> within s (x n) /\ within s (pre n)).
Hypotheses
  (Ra : pre "alpha_over_b" = x "alpha" / x "b") (Va : returned (pre "alpha_over_b") (x "alpha_over_b"))
  (Rg : pre "gamma_over_d" = x "gamma" / x "d") (Vg : returned (pre "gamma_over_d") (x "gamma_over_d"))
  (RA : pre "A" = x "alpha_over_b" * x "alpha_over_b") (VA : returned (pre "A") (x "A"))
  (RB : pre "B" = x "gamma_over_d" * x "gamma_over_d") (VB : returned (pre "B") (x "B"))
  (Rx : pre "xx" = x "x" * x "x") (Vx : returned (pre "xx") (x "xx")) (Ry : pre "yy" = x "y" * x "y") (Vy : returned (pre "yy") (x "yy"))
  (Rr : exists p q, takes multiplied x pre (Name "xx") p /\ takes multiplied x pre (Name "yy") q /\ pre "rr" = p + q) (Vr : returned (pre "rr") (x "rr"))
  (Rb : pre "bb" = x "b" * x "b") (Vb : returned (pre "bb") (x "bb"))
  (RP : pre "P" = x "rr" / x "bb") (VP : returned (pre "P") (x "P"))
  (Rz : pre "z_over_d" = x "z" / x "d") (Vz : returned (pre "z_over_d") (x "z_over_d"))
  (RQ : pre "Q" = x "z_over_d" * x "z_over_d") (VQ : returned (pre "Q") (x "Q"))
  (RS : exists q, takes multiplied x pre (Name "Q") q /\ pre "P_plus_Q" = x "P" + q) (VS : returned (pre "P_plus_Q") (x "P_plus_Q")).

(** The guards, as the step "usable" asks them. *)
Hypotheses (Ga : 0 < x "alpha") (Gg : 0 < x "gamma") (Gb : pow (-100) < x "b" < pow 100) (Gd : pow (-100) < x "d" < pow 100)
  (GA : pow (-100) < x "A" < pow 100) (GB : pow (-100) < x "B" < pow 100) (GS : x "P_plus_Q" < pow 200).

Let given n s := within s (x n) /\ within s (pre n).

Let between_is l h v : pow l <= v -> v <= pow h -> within (between l h) v.
Proof. intros L H; pose proof (bpow_gt_0 radix2 l); repeat split; cbn; [rewrite Rabs_pos_eq | |]; lra. Qed.
Let to_is h v : 0 <= v -> v <= pow h -> within (to h) v.
Proof. intros L H; repeat split; cbn; [rewrite Rabs_pos_eq |]; lra. Qed.
Let about_is h v : Rabs v <= pow h -> within (about h) v.
Proof. intros H; repeat split; cbn; [exact H | discriminate]. Qed.

Let returned_positive p v : returned p v -> 0 <= p -> 0 <= v.
Proof.
  intros [R | [[_ ->] | (T & _ & PV)]] P; [apply stays_positive with p; assumption | lra |].
  pose proof (bpow_gt_0 radix2 1023); rewrite Rabs_pos_eq in T by exact P; apply Rmult_le_reg_l with p; lra.
Qed.

Let ratio r A : pre A = x r * x r -> 0 <= pre r -> 0 <= x r -> returned (pre r) (x r) -> returned (pre A) (x A) -> pow (-100) < x A < pow 100 ->
  given r (between (-50) 50) /\ given A (between (-100) 100).
Proof.
  intros E P0 P VR VA' [L H]; assert (PA : 0 <= pre A) by (rewrite E; apply Rmult_le_pos; assumption).
  pose proof (below _ _ 100 VA' PA ltac:(lia) H) as H'; pose proof (above _ _ (-100) VA' PA ltac:(lia) L) as L'.
  rewrite E in H', L'; pose proof (root_below _ 50 P H') as RH; pose proof (root_above _ (-50) P L') as RL.
  pose proof (below _ _ 50 VR P0 ltac:(lia) RH) as QH; pose proof (above _ _ (-50) VR P0 ltac:(lia) RL) as QL.
  repeat split; try (apply between_is); rewrite ?E; lra.
Qed.

Theorem guards_give : all_hold x pre guarded.
Proof.
  assert (b0 : 0 < x "b") by (pose proof (bpow_gt_0 radix2 (-100)); lra); assert (d0 : 0 < x "d") by (pose proof (bpow_gt_0 radix2 (-100)); lra).
  assert (pa0 : 0 <= pre "alpha_over_b") by (rewrite Ra; apply over_pos; lra); pose proof (returned_positive _ _ Va pa0) as pa.
  assert (pg0 : 0 <= pre "gamma_over_d") by (rewrite Rg; apply over_pos; lra); pose proof (returned_positive _ _ Vg pg0) as pg.
  destruct (ratio "alpha_over_b" "A" RA pa0 pa Va VA GA) as [Ka KA].
  destruct (ratio "gamma_over_d" "B" RB pg0 pg Vg VB GB) as [Kg KB].
  (* the squares are not negative *)
  assert (sq : forall v, 0 <= v * v) by (intros v; pose proof (pow2_ge_0 v); lra).
  assert (px : 0 <= pre "xx") by (rewrite Rx; apply sq); assert (py : 0 <= pre "yy") by (rewrite Ry; apply sq).
  pose proof (returned_positive _ _ Vx px) as qx; pose proof (returned_positive _ _ Vy py) as qy.
  destruct Rr as (rp & rq & Tp & Tq & Er); assert (p1 : 0 <= rp) by (destruct Tp as [-> | [_ ->]]; assumption);
    assert (p2 : 0 <= rq) by (destruct Tq as [-> | [_ ->]]; assumption).
  assert (pr : 0 <= pre "rr") by (rewrite Er; lra); pose proof (returned_positive _ _ Vr pr) as qr.
  (* b squared *)
  assert (B2 : pow (-200) < x "b" * x "b" < pow 200).
  { change (-200)%Z with (-100 + -100)%Z; change 200%Z with (100 + 100)%Z; rewrite !bpow_plus; pose proof (bpow_gt_0 radix2 (-100)).
    split; apply Rmult_gt_0_lt_compat; lra. }
  assert (Bb : pow (-200) <= x "bb" <= pow 200).
  { assert (W : within (between (-200) 200) (x "bb")).
    { apply rounding_within with (pre "bb"); [reflexivity | exact Vb |]; apply between_is; rewrite Rb; lra. }
    destruct W as (W1 & W2 & W3); cbn [low high positive between] in W1, W2, W3; rewrite Rabs_pos_eq in W1 by (apply W2; reflexivity); lra. }
  assert (bb0 : 0 < x "bb") by (pose proof (bpow_gt_0 radix2 (-200)); lra).
  assert (pP : 0 <= pre "P") by (rewrite RP; apply over_pos; lra); pose proof (returned_positive _ _ VP pP) as qP.
  assert (pQ : 0 <= pre "Q") by (rewrite RQ; apply sq); pose proof (returned_positive _ _ VQ pQ) as qQ.
  destruct RS as (sq' & Ts & Es); assert (ps : 0 <= sq') by (destruct Ts as [-> | [_ ->]]; assumption).
  assert (pS : 0 <= pre "P_plus_Q") by (rewrite Es; lra).
  pose proof (below _ _ 200 VS pS ltac:(lia) GS) as S1; rewrite Es in S1.
  pose proof (below _ _ 200 VP pP ltac:(lia) ltac:(lra)) as P1.
  assert (Q1 : pre "Q" <= pow 200 /\ x "Q" <= pow 200).
  { destruct Ts as [-> | [_ ->]].
    - pose proof (below _ _ 200 VQ pQ ltac:(lia) ltac:(lra)); lra.
    - split; [lra |]; apply no_more with (pre "Q"); [exact VQ | exact pQ | lia | lra]. }
  assert (r1 : x "rr" < pow 400).
  { rewrite RP in P1; apply Rmult_lt_reg_r with (/ x "bb"); [apply Rinv_0_lt_compat; exact bb0 |].
    apply Rlt_le_trans with (pow 200); [exact P1 |]; apply Rmult_le_reg_r with (x "bb"); [exact bb0 |].
    rewrite Rmult_assoc, Rinv_l by lra; change 400%Z with (200 + 200)%Z; rewrite bpow_plus, Rmult_1_r.
    apply Rmult_le_compat_l; [apply bpow_ge_0 | lra]. }
  pose proof (below _ _ 400 Vr pr ltac:(lia) r1) as r2; rewrite Er in r2.
  assert (part : forall n p, takes multiplied x pre (Name n) p -> returned (pre n) (x n) -> 0 <= pre n -> p < pow 400 -> x n <= pow 400 /\ pre n <= pow 400).
  { intros n p [-> | [_ ->]] V P0 H; [pose proof (below _ _ 400 V P0 ltac:(lia) H); lra |].
    split; [| lra]; apply no_more with (pre n); [exact V | exact P0 | lia | lra]. }
  destruct (part "xx" rp Tp Vx px ltac:(lra)) as [x1 x2]; destruct (part "yy" rq Tq Vy py ltac:(lra)) as [y1 y2].
  assert (zs : Rabs (x "z_over_d") <= pow 100 /\ Rabs (pre "z_over_d") <= pow 101).
  { assert (H : Rabs (x "z_over_d") <= pow 100).
    { apply Rnot_lt_le; intro N; pose proof (Rmult_gt_0_lt_compat (pow 100) (Rabs (x "z_over_d")) (pow 100) (Rabs (x "z_over_d"))
        ltac:(apply bpow_gt_0) ltac:(apply bpow_gt_0 || (pose proof (bpow_gt_0 radix2 100); lra)) N N) as M.
      rewrite <- bpow_plus, <- Rabs_mult, Rabs_pos_eq in M by apply sq; rewrite <- RQ in M; change (100 + 100)%Z with 200%Z in M; lra. }
    split; [exact H |]; pose proof (bpow_lt radix2 100 1023 ltac:(lia)); destruct Vz as [V | [[V _] | (_ & V & _)]]; [| | lra].
    2: { pose proof (bpow_lt radix2 (-1022) 101 ltac:(lia)); lra. }
    apply Rnot_lt_le; intro N; destruct V as (rnd & VR & E).
    pose proof (abs_round_ge_generic radix2 binary64 rnd (pow 101) (pre "z_over_d") (power_is_float 101 ltac:(lia)) ltac:(lra)) as M.
    rewrite <- E in M; pose proof (bpow_lt radix2 100 101 ltac:(lia)); lra. }
  intros n s H; unfold guarded in H.
  cbn [look] in H.
  repeat match type of H with (if String.eqb ?a n then Some ?t else _) = Some s =>
    destruct (String.eqb_spec a n) as [<- | _]; [injection H as <- |] end; [.. | discriminate].
  - rewrite Inputs by (cbn; tauto); split; apply between_is; lra.
  - rewrite Inputs by (cbn; tauto); split; apply between_is; lra.
  - exact KA.
  - exact KB.
  - exact Ka.
  - exact Kg.
  - split; apply to_is; assumption.
  - split; apply to_is; assumption.
  - split; apply to_is; try assumption; rewrite ?Er; lra.
  - pose proof (bpow_lt radix2 100 101 ltac:(lia)); split; apply about_is; lra.
  - split; apply to_is; lra.
  - split; apply to_is; lra.
  - split; apply to_is; rewrite ?Es; try lra; apply (returned_positive _ _ VS); rewrite Es; lra.
  - apply Constants; cbn; tauto.
  - apply Constants; cbn; tauto.
  - apply Constants; cbn; tauto.
  - apply Constants; cbn; tauto.
  - apply Constants; cbn; tauto.
  - apply Constants; cbn; tauto.
Qed.

End Guards.

(** ** What follows. A value of at most 2^1023 is no overflow, in any mode. *)

Definition reached l := match sizes guarded l with Some t => t | None => [] end.
Definition never_overflows l := forallb (fun s => match kind_of s with None => true | Some _ => is_in (name s) (map fst (reached l)) end) l.

Theorem stage_two_is_in_range : never_overflows C_certified = true /\ never_overflows C_single = true
  /\ (0 < List.length C_certified)%nat /\ (0 < List.length C_single)%nat.
Proof.
  split; [| split; [| split]]; [vm_cast_no_check (eq_refl true) | vm_cast_no_check (eq_refl true) | apply Nat.ltb_lt; reflexivity ..].
Qed.

(** Guards imply that no step overflows. *)
Theorem no_overflow multiplied x pre l s k : (l = C_certified \/ l = C_single) -> all_hold x pre guarded -> Forall (runs multiplied x pre) l ->
  In s l -> kind_of s = Some k -> Rabs (x (name s)) < pow 1024 /\ Rabs (pre (name s)) < pow 1024.
Proof.
  intros L K R I O; assert (N : never_overflows l = true).
  { destruct stage_two_is_in_range as (N1 & N2 & _); destruct L as [-> | ->]; [exact N1 | exact N2]. }
  unfold never_overflows in N; rewrite forallb_forall in N; specialize (N s I); rewrite O in N.
  assert (T : exists t, look (name s) (reached l) = Some t).
  { revert N; generalize (reached l) (name s); clear; intros t n; induction t as [| [m r] t IH]; cbn; [discriminate |].
    rewrite String.eqb_sym; destruct (String.eqb m n); cbn; eauto. }
  destruct T as [t T]; assert (S : sizes guarded l = Some (reached l)).
  { unfold reached in *; destruct (sizes guarded l); [reflexivity | discriminate]. }
  assert (F : forall known l found, (forall n r, look n known = Some r -> (high r <= 1023)%Z) -> sizes known l = Some found ->
    forall n r, look n found = Some r -> (high r <= 1023)%Z).
  { clear; intros known l; revert known; induction l as [| s l IH]; cbn [sizes]; intros known found H E; [injection E as <-; exact H |].
    destruct (kind_of s); [| apply (IH known); assumption]; destruct (look (name s) known); [apply (IH known); assumption |].
    destruct (size_of known s) as [r |]; [| discriminate]; destruct (fit r) eqn:F; [| discriminate].
    apply (IH ((name s, r) :: known)); [| exact E]; intros n q M; cbn [look] in M.
    destruct (String.eqb (name s) n); [injection M as <- | apply (H n q M)].
    unfold fit in F; apply andb_prop in F as [F _]; apply andb_prop in F as [_ F]; apply Z.leb_le; exact F. }
  assert (H : (high t <= 1023)%Z).
  { apply (F guarded l (reached l)) with (name s); [| exact S | exact T]; intros n r M.
    unfold guarded in M; cbn [look] in M; repeat match type of M with (if ?c then _ else _) = _ => destruct c; [injection M as <-; cbn; lia |] end; discriminate. }
  destruct (sizes_hold multiplied x pre l guarded (reached l) K R S (name s) t T) as [(W1 & _) (W2 & _)].
  pose proof (at_most _ _ H); pose proof (bpow_lt radix2 1023 1024 ltac:(lia)); split; lra.
Qed.

(** The products of the bounds are normal: none underflows. Those of the values may, where a coordinate or a coefficient is tiny. *)
Definition products l := filter (fun s => match kind_of s with Some Times | Some Over => true | _ => false end) l.
Definition is_normal l n := match look n (reached l) with Some s => match low s with Some k => (-1022 <=? k)%Z | None => false end | None => false end.
Definition may_underflow l := filter (fun n => negb (is_normal l n)) (map name (products l)).

Theorem what_may_underflow : may_underflow C_certified = ["xx"; "yy"; "P"; "z_over_d"; "Q"; "BP"; "AQ"; "c2_squared"; "three_c1"; "c2c1";
    "nine_c0"; "c1_squared"; "c2c0"; "three_c2c0"; "h1h3"; "h1h3_4"; "h2_squared"; "two_c2"; "rise_B"; "rise_A"].
Proof. lazymatch goal with |- _ = ?l => vm_cast_no_check (eq_refl l) end. Qed.

Theorem others_are_normal multiplied x pre l s : all_hold x pre guarded -> Forall (runs multiplied x pre) l -> In s (products l) -> is_normal l (name s) = true ->
  normal (pre (name s)).
Proof.
  intros K R I N; unfold is_normal in N; destruct (look (name s) (reached l)) as [t |] eqn:T; [| discriminate].
  destruct (low t) as [k |] eqn:L; [| discriminate]; apply Z.leb_le in N.
  assert (S : sizes guarded l = Some (reached l)) by (unfold reached in *; destruct (sizes guarded l); [reflexivity | discriminate]).
  destruct (sizes_hold multiplied x pre l guarded (reached l) K R S (name s) t T) as [_ (_ & _ & W)]; rewrite L in W.
  right; pose proof (at_most _ _ N); pose proof (Rle_abs (pre (name s))); lra.
Qed.
