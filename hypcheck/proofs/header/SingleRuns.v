(** One pair from its C: what hc_single returns is the position, or that it cannot say.

    As in StageTwoRuns.v: [x] has the number that each step gives, each rounded in a mode of its own, contracted or not, flushed to 0
    below the normal range or not; [greater] says which comparison of the C holds. That nothing overflows, and that what underflows is
    less than the bounds have to spare, is proved, by the guards that the C asks. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Flocq Require Import Core.
From Hypcheck Require Import Geometry UnitBall Cubic Rule Rounding Positions Floats Steps FixedRuns Kernel RunningBound Stages Ranges Underflow FloatTexts SingleBound.
From Hypcheck Require StageTwo StageTwoRuns.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Definition names_of f := map name (filter (fun s => match kind_of s with Some k => f k | None => false end) steps_of_single).
Definition multiplied := Eval vm_compute in names_of (fun k => match k with Times | Negated => true | _ => false end).
Definition floats := Eval vm_compute in names_of (fun k => match k with Plus | Minus | Times | Over => true | _ => false end).
Definition known := Eval vm_compute in match sizes guarded steps_of_single with Some t => t | None => [] end.

Lemma known_is_reached : sizes guarded steps_of_single = Some known.
Proof. vm_compute; reflexivity. Qed.
Lemma known_high n r : look n known = Some r -> (high r <= 1023)%Z.
Proof.
  assert (H : forallb (fun p => (high (snd p) <=? 1023)%Z) known = true) by (vm_compute; reflexivity).
  intros E; apply look_in in E; rewrite forallb_forall in H; apply Z.leb_le, (H (n, r) E).
Qed.
Lemma floats_known n : is_in n floats = true -> exists r, look n known = Some r.
Proof.
  assert (H : forallb (fun n => match look n known with Some _ => true | None => false end) floats = true) by (vm_compute; reflexivity).
  intros I; rewrite forallb_forall in H; specialize (H n (proj1 (is_in_In n floats) I)); destruct (look n known) as [r |]; [eauto | discriminate].
Qed.

Local Notation by_search := ltac:(vm_compute; reflexivity) (only parsing).

Section Single.

Variables (x pre : string -> R) (greater : argument -> argument -> bool).
Hypotheses (Runs : Forall (runs multiplied x pre) steps_of_single)
  (Compares : forall a c p q, greater a c = true -> has x a p -> has x c q -> q < p)
  (Constants : forall n v, In (n, v) StageTwoRuns.constants -> x n = v)
  (Inputs : forall n, In n (inputs ++ map fst StageTwoRuns.constants) -> pre n = x n).

Let body := upright (x "alpha") (x "gamma") (x "b") (x "d") (x "x") (x "y") (x "z").

(** ** Steps by their names. *)

Definition step_of n := find (fun s => String.eqb (name s) n) steps_of_single.
Lemma runs_of n s : step_of n = Some s -> runs multiplied x pre s.
Proof. intros E; apply find_some in E as [I _]; apply (proj1 (Forall_forall _ _) Runs s I). Qed.
Lemma product_of n a c : step_of n = Some (Step n "mul" [Name a; Name c]) -> pre n = x a * x c /\ returned (pre n) (x n).
Proof. intros E; destruct (runs_of n _ E) as (p & q & -> & -> & H); exact H. Qed.
Lemma quotient_of n a c : step_of n = Some (Step n "div" [Name a; Name c]) -> pre n = x a / x c /\ returned (pre n) (x n).
Proof. intros E; destruct (runs_of n _ E) as (p & q & -> & -> & H); exact H. Qed.
Lemma sum_of n a c : step_of n = Some (Step n "add" [Name a; Name c]) ->
  (exists p q, takes multiplied x pre (Name a) p /\ takes multiplied x pre (Name c) q /\ pre n = p + q) /\ returned (pre n) (x n).
Proof. intros E; destruct (runs_of n _ E) as (p & q & P & Q & H & G); split; [exists p, q; auto | exact G]. Qed.
Ltac by_its_step := match goal with
  | |- pre ?n = x ?a * x ?c => exact (proj1 (product_of n a c by_search))
  | |- pre ?n = x ?a / x ?c => exact (proj1 (quotient_of n a c by_search))
  | |- exists p q, takes _ _ _ (Name ?a) p /\ takes _ _ _ (Name ?c) q /\ pre ?n = p + q => exact (proj1 (sum_of n a c by_search))
  | |- returned (pre ?n) _ => first [exact (proj2 (product_of n _ _ by_search)) | exact (proj2 (quotient_of n _ _ by_search)) | exact (proj2 (sum_of n _ _ by_search))]
  end.
Lemma opposite_of n a : step_of n = Some (Step n "neg" [Name a]) -> x n = - x a.
Proof. intros E; destruct (runs_of n _ E) as (p & q & _ & -> & _ & H); exact H. Qed.
Lemma more a c : greater (Name a) (Name c) = true -> x c < x a.
Proof. intros H; apply (Compares _ _ _ _ H); reflexivity. Qed.

(** ** The guards. *)

Let constant n v : In (n, v) StageTwoRuns.constants -> x n = v /\ pre n = v.
Proof.
  intros I; split; [apply Constants; exact I |]; rewrite Inputs; [apply Constants; exact I |].
  apply in_or_app; right; apply (in_map fst StageTwoRuns.constants (n, v) I).
Qed.
Let in_range l h v : pow l <= v <= pow h -> within (between l h) v.
Proof.
  intros [L H]; pose proof (bpow_gt_0 radix2 l); repeat split; cbn [low high positive between]; [rewrite Rabs_pos_eq | |]; lra.
Qed.

Section Fit.

Hypotheses (Sizes : sizes_fit greater = true) (Ratios : ratios_fit greater = true) (Near : greater (Name "farthest") (Name "P_plus_Q") = true).

Lemma guards : 0 < x "alpha" /\ 0 < x "gamma" /\ pow (-100) < x "b" < pow 100 /\ pow (-100) < x "d" < pow 100
  /\ slack < x "A" < pow 100 /\ pow (-100) < x "B" < pow 100 /\ x "P_plus_Q" < pow 200 /\ x "slack_A" < x "BB".
Proof.
  assert (L : x "least" = pow (-100)) by (apply Constants, look_in; reflexivity); assert (G : x "greatest" = pow 100) by (apply Constants, look_in; reflexivity).
  assert (F : x "farthest" = pow 200) by (apply Constants, look_in; reflexivity); assert (K : x "slack" = slack) by (apply Constants, look_in; reflexivity).
  unfold sizes_fit in Sizes; unfold ratios_fit in Ratios; repeat match goal with H : _ && _ = true |- _ => apply andb_prop in H as [? ?] end.
  repeat match goal with H : greater (Name _) (Name _) = true |- _ => apply more in H end.
  assert (0 < x "alpha") by (apply (Compares (Name "alpha") (Number 0)); [assumption | reflexivity | reflexivity]).
  assert (0 < x "gamma") by (apply (Compares (Name "gamma") (Number 0)); [assumption | reflexivity | reflexivity]).
  rewrite <- L, <- G, <- F, <- K; repeat split; assumption.
Qed.

Let K : all_hold x pre known.
Proof.
  destruct guards as (G1 & G2 & G3 & G4 & G5 & G6 & G7 & _).
  apply (sizes_hold multiplied x pre steps_of_single guarded known); [| exact Runs | exact known_is_reached].
  assert (one : pow (-100) < slack) by (unfold slack; simpl; lra).
  apply (guards_give multiplied x pre); try assumption; try by_its_step; try (split; lra).
  - intros n I; apply Inputs; apply in_or_app; left; exact I.
  - intros n s I; assert (W : exists v l h, In (n, v) StageTwoRuns.constants /\ s = between l h /\ pow l <= v <= pow h).
    { unfold StageTwoRuns.constants, unit, slack; cbn [In] in I |- *; repeat destruct I as [I | I]; try contradiction; injection I as <- <-.
      - exists (4 * / 2 ^ 52 * (1 + / 2 ^ 20)), (-50)%Z, (-49)%Z; repeat split; [tauto | simpl; lra ..].
      - exists (8 * / 2 ^ 52 * (1 + / 2 ^ 20)), (-49)%Z, (-48)%Z; repeat split; [tauto | simpl; lra ..].
      - exists (12 * / 2 ^ 52 * (1 + / 2 ^ 20)), (-49)%Z, (-48)%Z; repeat split; [tauto | simpl; lra ..].
      - exists (16 * / 2 ^ 52 * (1 + / 2 ^ 20)), (-48)%Z, (-47)%Z; repeat split; [tauto | simpl; lra ..].
      - exists (1536 * / 2 ^ 52 * (1 + / 2 ^ 20)), (-42)%Z, (-41)%Z; repeat split; [tauto | simpl; lra ..].
      - exists (1 + / 2 ^ 20), 0%Z, 1%Z; repeat split; [tauto | simpl; lra ..]. }
    destruct W as (v & l & h & J & -> & B); destruct (constant n v J) as [-> ->]; split; apply in_range; exact B.
  - destruct (sum_of "P_plus_Q" _ _ eq_refl) as [(p & q & P & Q & E) _]; exists q; split; [exact Q |]; rewrite E; f_equal; destruct P as [P | P]; [exact P |]; destruct P as [N _]; discriminate N.
Qed.

Lemma all_float n : is_in n floats = true -> float (x n).
Proof.
  intros I; destruct (floats_known n I) as [r L]; destruct (K n r L) as [_ (W & _)]; pose proof (at_most _ _ (known_high n r L)).
  apply is_in_In in I; apply (returned_float (pre n)); [| lra]; clear - I Runs; change floats with (names_of (fun k => match k with Plus | Minus | Times | Over => true | _ => false end)) in I.
  unfold names_of in I; apply in_map_iff in I as (s & <- & I); apply filter_In in I as [I E]; pose proof (proj1 (Forall_forall _ _) Runs s I) as H.
  unfold runs in H; destruct (kind_of s) as [[] |]; try discriminate; destruct (arguments (meaning s)) as [| a [| c [|]]]; try contradiction;
    destruct H as (p & q & _ & _ & _ & H); exact H.
Qed.

(** ** What the steps compute, layer by layer. *)

Notation u := unit_of_any_mode.
Notation lost := StageTwoRuns.lost.
Notation given_as := StageTwoRuns.given_as.

Lemma given_stand l entry env : (forall n k, In (n, k) l -> env k = x n) -> all_stand multiplied x pre entry env (given_as l).
Proof.
  intros H n c E; apply look_in in E; unfold given_as in E; apply in_map_iff in E as ([m k] & E & I); injection E as <- <-; cbn [fst snd].
  split; [| discriminate]; exists (env k * 1); split; [apply c_input | cbn; rewrite (H m k I); ring].
  assert (U : 0 <= u < 1) by (unfold unit_of_any_mode; simpl; lra); apply factor_1; exact U.
Qed.

Definition table l := cells multiplied floats known l steps_of_single.
Let all_cells entry env l : all_stand multiplied x pre entry env l -> all_stand multiplied x pre entry env (table l).
Proof. intros H; apply cells_stand; [exact all_float | exact K | exact known_high | exact Runs | exact H]. Qed.

Lemma nearly_runs entry env l n c : all_stand multiplied x pre entry env l -> look n (table l) = Some c -> StageTwoRuns.is_little c = true ->
  nearly (computes u entry env (tree c)) lost (x n).
Proof.
  intros H E L; destruct (all_cells entry env l H n c E) as [(w & C & D) _]; exists w; split; [exact C |]; unfold StageTwoRuns.is_little in L.
  destruct (loss c) as [k |]; cbn in D; [| rewrite D, Rabs_R0; apply bpow_ge_0]; apply Z.leb_le in L; pose proof (at_most _ _ L); unfold StageTwoRuns.lost; lra.
Qed.
Lemma runs_so entry env l n e b : all_stand multiplied x pre entry env l -> look n (table l) = Some (Cell e None b) -> computes u entry env e (x n).
Proof. intros H E; destruct (all_cells entry env l H n _ E) as [(w & C & D) _]; cbn in D, C; replace (x n) with w by lra; exact C. Qed.

Notation row := (fun k => nth k (map x ["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"]) 0).
Lemma taken_nearly n c p p' : takes multiplied x pre (Name n) p -> all_stand multiplied x pre exact_inputs row StageTwoRuns.row_inputs ->
  look n (table StageTwoRuns.row_inputs) = Some c -> unrounded c = true -> match loss c with Some k => (k <=? -701)%Z | None => true end = true ->
  Rabs (p' - p) <= pow (-1021) -> nearly (computes u exact_inputs row (tree c)) lost p'.
Proof.
  intros T I E A L D; destruct (all_cells _ _ _ I n c E) as [S1 S2].
  assert (S : stands exact_inputs row c p) by (destruct T as [-> | [M ->]]; auto).
  destruct S as (w & C & W); exists w; split; [exact C |]; replace (p' - w) with ((p' - p) + (p - w)) by ring; pose proof (Rabs_triang (p' - p) (p - w)) as TR.
  assert (Z : Rabs (p - w) <= pow (-701)).
  { destruct (loss c) as [k |]; cbn in W; [apply Z.leb_le in L; pose proof (at_most _ _ L); lra | rewrite W, Rabs_R0; apply bpow_ge_0]. }
  pose proof (bpow_lt radix2 (-1021) (-701) ltac:(lia)); pose proof (Ranges.double (-701)) as DB; change (-701 + 1)%Z with (-700)%Z in DB; unfold StageTwoRuns.lost; lra.
Qed.
Lemma positive_taken n r p : takes multiplied x pre (Name n) p -> look n known = Some r -> positive r = true -> 0 <= p.
Proof. intros T E P; destruct (K n r E) as [(_ & P1 & _) (_ & P2 & _)]; destruct T as [-> | [_ ->]]; auto. Qed.
Lemma unrounded_factor n r : look n known = Some r -> is_normal_size r = true -> returned (pre n) (x n) -> exists f, factor u 1 f /\ pre n = x n * f.
Proof.
  intros E N R; destruct (K n r E) as [_ (H & P & L)]; pose proof (at_most _ _ (known_high n r E)); unfold is_normal_size in N.
  destruct (low r) as [k |]; [| discriminate]; apply Z.leb_le in N; pose proof (at_most _ _ N); pose proof (Rle_abs (pre n)).
  destruct (rounding_loses _ _ R ltac:(lra)) as (t & T & _ & X); rewrite X by lra.
  assert (U : 0 <= u < 1) by (unfold unit_of_any_mode; simpl; lra); pose proof (factor_of_rounding u U t T) as F; pose proof (factor_pos u U 1 _ F).
  exists (/ (1 + t)); split; [apply factor_inv; assumption | field; lra].
Qed.

Let unit_is : unit = / 4503599627370496.
Proof. unfold unit; f_equal; simpl; lra. Qed.
Let slack_is : slack = 1 + / 1048576.
Proof. unfold slack; f_equal; f_equal; simpl; lra. Qed.
Let u_is : u = / 4503599627370496.
Proof. unfold unit_of_any_mode; simpl; lra. Qed.
Let U : 0 <= u < 1.
Proof. rewrite u_is; lra. Qed.

(** A few roundings are hardly any change. *)
Let few k f : (k <= 50)%nat -> factor u k f -> 1 - 50 * u <= f /\ f * (1 - 50 * u) <= 1.
Proof.
  intros L [F1 F2]; pose proof (bernoulli u k ltac:(lra)) as B; apply le_INR in L; rewrite (INR_IZR_INZ 50) in L; simpl in L; pose proof (pos_INR k) as P0.
  assert (INR k * u <= 50 * u) by (apply Rmult_le_compat_r; lra); assert (P : 0 < (1 - u) ^ k) by (apply pow_lt; lra); split; [lra |].
  assert (0 < f) by lra; apply Rle_trans with (f * (1 - u) ^ k); [apply Rmult_le_compat_l; lra |].
  apply Rle_trans with (/ (1 - u) ^ k * (1 - u) ^ k); [apply Rmult_le_compat_r; lra | rewrite Rinv_l; lra].
Qed.

Let A := (x "alpha" / x "b") ^ 2.
Let B := (x "gamma" / x "d") ^ 2.
Let P := (x "x" ^ 2 + x "y" ^ 2) / x "b" ^ 2.
Let Q := (x "z" / x "d") ^ 2.

Let row_positive : 0 < x "b" -> 0 < x "d" -> 0 < x "alpha" -> 0 < x "gamma" ->
  RunningBound.positive row StageTwo.A /\ RunningBound.positive row StageTwo.B /\ RunningBound.positive row StageTwo.P /\ RunningBound.positive row StageTwo.Q.
Proof.
  intros; assert (x "b" <> 0 /\ x "d" <> 0 /\ x "b" * x "b" <> 0) as (N1 & N2 & N3) by (repeat split; try lra; apply Rmult_integral_contrapositive; lra).
  assert (0 < x "b" * x "b") by (apply Rmult_lt_0_compat; lra); simpl; repeat split; try lra; try tauto.
  all: right; repeat split; auto; tauto.
Qed.

(** What is computed of positive terms is close to its value, and what is computed at all no larger than the sizes of its terms. *)
Let close e v w : RunningBound.positive row e -> (count exact_inputs e <= 50)%nat -> computes u exact_inputs row e w -> value row e = v ->
  v * (1 - 50 * u) <= w /\ w * (1 - 50 * u) <= v.
Proof.
  intros PE C W V; destruct (positive_factor u exact_inputs row e w U PE W) as (f & F & ->); pose proof (positive_value row e PE) as V0; rewrite V in *.
  destruct (few _ _ C F) as [F1 F2]; split; [apply Rmult_le_compat_l; lra |]; rewrite Rmult_assoc; apply Rle_trans with (v * 1); [apply Rmult_le_compat_l |]; lra.
Qed.
Let close_nearly e v w : RunningBound.positive row e -> (count exact_inputs e <= 50)%nat -> nearly (computes u exact_inputs row e) lost w -> value row e = v ->
  (v - lost) * (1 - 50 * u) <= w + lost /\ (w - lost) * (1 - 50 * u) <= v.
Proof.
  intros PE C (w' & W & L) V; destruct (close e v w' PE C W V) as [H1 H2]; pose proof (Rle_abs (w - w')); pose proof (Rle_abs (- (w - w'))) as H4; rewrite Rabs_Ropp in H4.
  assert (0 <= lost) by (apply bpow_ge_0); rewrite u_is in *; split; lra.
Qed.
Let no_larger env e w : divides_well env e -> (count exact_inputs e <= 50)%nat -> nearly (computes u exact_inputs env e) lost w ->
  Rabs w <= 1001 / 1000 * magnitude env e + lost.
Proof.
  intros D C (w' & W & L); pose proof (near_size u _ _ _ _ (counted u exact_inputs env U e w' D W)) as H.
  assert (M0 : 0 <= magnitude env e) by (destruct (counted u exact_inputs env U e w' D W) as [V _]; pose proof (Rabs_pos (value env e)); lra).
  assert (G : growth u (count exact_inputs e) <= / 1000).
  { pose proof (pos_INR (count exact_inputs e)); pose proof C as C'; apply le_INR in C'; rewrite (INR_IZR_INZ 50) in C'; simpl in C'.
    apply Rle_trans with ((INR (count exact_inputs e) + 1) * u); [apply growth_is_small; [exact U |] |].
    - apply Rle_trans with (50 * (50 + 1) * u); [| rewrite u_is; lra]; apply Rmult_le_compat_r; [lra |]; apply Rmult_le_compat; lra.
    - apply Rle_trans with (51 * u); [apply Rmult_le_compat_r; lra | rewrite u_is; lra]. }
  replace w with (w' + (w - w')) by ring; pose proof (Rabs_triang w' (w - w')).
  assert ((1 + growth u (count exact_inputs e)) * magnitude env e <= 1001 / 1000 * magnitude env e) by (apply Rmult_le_compat_r; lra); lra.
Qed.

Let computes_value entry env e : computes u entry env e (value env e).
Proof.
  assert (Z : Rabs 0 <= u) by (rewrite Rabs_R0; lra); induction e; cbn [value].
  - rewrite <- (Rmult_1_r (env n)); apply c_input, factor_1, U.
  - apply c_whole.
  - apply c_neg; assumption.
  - apply c_scale; assumption.
  - replace (value env e1 + value env e2) with ((value env e1 + value env e2) * (1 + 0)) by ring; apply c_add; assumption.
  - replace (value env e1 - value env e2) with ((value env e1 - value env e2) * (1 + 0)) by ring; apply c_sub; assumption.
  - replace (value env e1 * value env e2) with (value env e1 * value env e2 * (1 + 0)) by ring; apply c_mul; assumption.
  - replace (value env e1 / value env e2) with (value env e1 / value env e2 * (1 + 0)) by ring; apply c_div; assumption.
Qed.

Lemma sums_positive env e : (forall n, 0 <= env n) -> only_sums e = true -> RunningBound.positive env e.
Proof.
  intros Positive; induction e; cbn [only_sums RunningBound.positive]; intros O; try discriminate; auto.
  - apply IZR_le, Z.leb_le; assumption.
  - apply andb_prop in O; destruct O; auto.
  - apply andb_prop in O; destruct O; auto.
Qed.

(** An expression that divides by b, d and b b alone. *)
Definition is_divisor e := match e with Input 2%nat | Input 3%nat | Mul (Input 2%nat) (Input 2%nat) => true | _ => false end.
Fixpoint divides_by_these e : bool := match e with
  | Input _ | Whole _ => true | Neg a | Scale _ a => divides_by_these a
  | Add a b | Sub a b | Mul a b => divides_by_these a && divides_by_these b | Div a b => divides_by_these a && is_divisor b end.

Definition five := [("BP_plus_AQ", Cell (Add (Input 3) (Input 4)) None false); ("P_plus_Q", Cell (Add (Input 5) (Input 6)) None false);
  ("A", Cell (Input 0) None true); ("B", Cell (Input 1) None true); ("AB", Cell (Input 2) None true)]%nat.

Theorem bounds_cover : Rabs (x "delta_3" - 3 * delta A B P Q) <= x "E" /\ Rabs (x "c1" - c1 A B P Q) <= x "e1" /\ Rabs (x "c2" - c2 A B P Q) <= x "e2".
Proof.
  destruct guards as (G1 & G2 & G3 & G4 & G5 & G6 & G7 & _).
  assert (b0 : 0 < x "b") by (pose proof (bpow_gt_0 radix2 (-100)); lra); assert (d0 : 0 < x "d") by (pose proof (bpow_gt_0 radix2 (-100)); lra).
  assert (sum : forall n a c r, step_of n = Some (Step n "add" [Name a; Name c]) -> look n known = Some r ->
    forall ra rc, look a known = Some ra -> look c known = Some rc -> Ranges.positive ra = true -> Ranges.positive rc = true ->
    exists p q p' q' t, takes multiplied x pre (Name a) p /\ takes multiplied x pre (Name c) q /\ 0 <= p' /\ 0 <= q'
      /\ Rabs (p' - p) <= pow (-1021) /\ Rabs (q' - q) <= pow (-1021) /\ Rabs t <= u /\ x n = (p' + q') * (1 + t)).
  { intros n a' c r E L ra rc LA LC PA PC; destruct (sum_of n a' c E) as ((p & q & TP & TQ & EQ) & RT).
    destruct (K n r L) as [_ (H & _)]; pose proof (at_most _ _ (known_high n r L)); pose proof (Rle_abs (p + q)); rewrite EQ in RT, H.
    destruct (StageTwoRuns.sum_without_loss p q (x n)) as (p' & q' & t & S1 & S2 & S3 & S4 & S5 & S6); [| | lra | exact RT |].
    - apply (positive_taken a' ra p TP LA PA).
    - apply (positive_taken c rc q TQ LC PC).
    - exists p, q, p', q', t; repeat split; assumption. }
  destruct (sum "BP_plus_AQ" _ _ _ eq_refl eq_refl _ _ eq_refl eq_refl eq_refl eq_refl) as (p1 & q1 & fBP & fAQ & t1 & TP1 & TQ1 & BP0 & AQ0 & DP1 & DQ1 & T1 & S1).
  destruct (sum "P_plus_Q" _ _ _ eq_refl eq_refl _ _ eq_refl eq_refl eq_refl eq_refl) as (p2 & q2 & fP & fQ & t2 & TP2 & TQ2 & P0 & Q0 & DP2 & DQ2 & T2 & S2).
  clear sum.
  assert (IR : all_stand multiplied x pre exact_inputs row StageTwoRuns.row_inputs).
  { apply given_stand; intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity. }
  set (co := fun k => nth k [- x "AB"; x "c1"; x "c2"] 0).
  assert (IC : all_stand multiplied x pre exact_inputs co StageTwoRuns.coefficients).
  { apply given_stand; intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; try reflexivity.
    symmetry; apply (opposite_of "c0" _ by_search). }
  set (he := fun k => nth k [x "h1"; x "h2"; x "h3"] 0).
  assert (IH : all_stand multiplied x pre exact_inputs he StageTwoRuns.hessian).
  { apply given_stand; intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity. }
  assert (IB : forall kn further, (forall k, (k < 7)%nat -> kn k = nth k [x "A"; x "B"; x "AB"; fBP; fAQ; fP; fQ] 0) -> (forall n k, In (n, k) further -> kn k = x n) ->
    all_stand multiplied x pre products_unrounded kn (five ++ given_as further)%list).
  { intros kn further H HF.
    assert (one : forall k, computes u products_unrounded kn (Input k) (kn k)).
    { intros k; rewrite <- (Rmult_1_r (kn k)); apply c_input; apply factor_1; exact U. }
    assert (whole : forall n k, kn k = x n -> stands products_unrounded kn (Cell (Input k) None true) (x n)).
    { intros n k E; exists (kn k); split; [apply one | cbn [loss loses]; rewrite E; ring]. }
    assert (off : forall n k r, kn k = x n -> look n known = Some r -> is_normal_size r = true -> returned (pre n) (x n) -> stands products_unrounded kn (Cell (Input k) None true) (pre n)).
    { intros n k r E L N R; destruct (unrounded_factor n r L N R) as (f & F & EQ); exists (kn k * f); split; [apply c_input; exact F | cbn [loss loses]; rewrite E, EQ; ring]. }
    intros n c E; unfold five in E; cbn [app look] in E.
    destruct (String.eqb_spec "BP_plus_AQ" n) as [<- | _]; [injection E as <- | destruct (String.eqb_spec "P_plus_Q" n) as [<- | _]; [injection E as <- |
      destruct (String.eqb_spec "A" n) as [<- | _]; [injection E as <- | destruct (String.eqb_spec "B" n) as [<- | _]; [injection E as <- |
      destruct (String.eqb_spec "AB" n) as [<- | _]; [injection E as <- |]]]]].
    - split; [| discriminate]; exists ((kn 3%nat + kn 4%nat) * (1 + t1)); split; [apply c_add; auto | cbn [loss loses]; rewrite S1, !H by lia; cbn [nth]; ring].
    - split; [| discriminate]; exists ((kn 5%nat + kn 6%nat) * (1 + t2)); split; [apply c_add; auto | cbn [loss loses]; rewrite S2, !H by lia; cbn [nth]; ring].
    - split; [apply whole; apply (H 0%nat); lia | intros _ _; eapply off; [apply (H 0%nat); lia | reflexivity | reflexivity | by_its_step]].
    - split; [apply whole; apply (H 1%nat); lia | intros _ _; eapply off; [apply (H 1%nat); lia | reflexivity | reflexivity | by_its_step]].
    - split; [apply whole; apply (H 2%nat); lia | intros _ _; eapply off; [apply (H 2%nat); lia | reflexivity | reflexivity | by_its_step]].
    - assert (G : all_stand multiplied x pre products_unrounded kn (given_as further)); [| exact (G n c E)].
      intros m e F; apply look_in in F; unfold given_as in F; apply in_map_iff in F as ([m' k] & F & I); injection F as <- <-; cbn [fst snd].
      split; [| discriminate]; exists (kn k); split; [apply one | cbn [loss loses]; rewrite (HF m' k I); ring]. }
  set (kn := fun k => nth k [x "A"; x "B"; x "AB"; fBP; fAQ; fP; fQ; Rabs (x "c1"); Rabs (x "c2"); Rabs (x "h1"); Rabs (x "h2"); Rabs (x "h3");
                      4 * unit * slack; 8 * unit * slack; 12 * unit * slack; slack; 16 * unit * slack] 0).
  set (ke := fun k => nth k [x "A"; x "B"; x "AB"; fBP; fAQ; fP; fQ; 1536 * unit * slack] 0).
  assert (Ik : all_stand multiplied x pre products_unrounded kn (five ++ given_as [("u_8", 13); ("u_12", 14)]%nat)%list).
  { apply IB; [intros k L; do 7 (destruct k as [| k]; [reflexivity |]); lia |]; intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-;
      symmetry; apply Constants, look_in; reflexivity. }
  assert (Ie : all_stand multiplied x pre products_unrounded ke (five ++ given_as [("u_1536", 7)]%nat)%list).
  { apply IB; [intros k L; do 7 (destruct k as [| k]; [reflexivity |]); lia |]; intros n k I; cbn [In] in I; destruct I as [I | []]; injection I as <- <-;
      symmetry; apply Constants, look_in; reflexivity. }
  clear IB.
  assert (little : forall n env l e c, all_stand multiplied x pre exact_inputs env l -> look n (table l) = Some c -> tree c = e -> StageTwoRuns.is_little c = true ->
    nearly (computes u exact_inputs env e) lost (x n)) by (intros n env l e c I L <- T; apply (nearly_runs _ _ l); assumption).
  assert (CA : computes u exact_inputs row StageTwo.A (x "A")) by (eapply (runs_so _ _ StageTwoRuns.row_inputs "A"); [exact IR | vm_compute; reflexivity]).
  assert (CB : computes u exact_inputs row StageTwo.B (x "B")) by (eapply (runs_so _ _ StageTwoRuns.row_inputs "B"); [exact IR | vm_compute; reflexivity]).
  assert (CAB : computes u exact_inputs row StageTwo.AB (x "AB")) by (eapply (runs_so _ _ StageTwoRuns.row_inputs "AB"); [exact IR | vm_compute; reflexivity]).
  assert (CBP : nearly (computes u exact_inputs row StageTwo.BP) lost fBP) by (eapply (taken_nearly "BP" (Cell StageTwo.BP _ true)); [exact TP1 | exact IR | vm_compute; reflexivity | reflexivity | reflexivity | exact DP1]).
  assert (CAQ : nearly (computes u exact_inputs row StageTwo.AQ) lost fAQ) by (eapply (taken_nearly "AQ" (Cell StageTwo.AQ _ true)); [exact TQ1 | exact IR | vm_compute; reflexivity | reflexivity | reflexivity | exact DQ1]).
  assert (CP : nearly (computes u exact_inputs row StageTwo.P) lost fP) by (eapply (taken_nearly "P" (Cell StageTwo.P _ true)); [exact TP2 | exact IR | vm_compute; reflexivity | reflexivity | reflexivity | exact DP2]).
  assert (CQ : nearly (computes u exact_inputs row StageTwo.Q) lost fQ) by (eapply (taken_nearly "Q" (Cell StageTwo.Q _ true)); [exact TQ2 | exact IR | vm_compute; reflexivity | reflexivity | reflexivity | exact DQ2]).
  assert (C1 : nearly (computes u exact_inputs row StageTwo.c1) lost (x "c1")) by (eapply (little "c1" _ StageTwoRuns.row_inputs); [exact IR | vm_compute; reflexivity | reflexivity | reflexivity]).
  assert (C2 : nearly (computes u exact_inputs row StageTwo.c2) lost (x "c2")) by (eapply (little "c2" _ StageTwoRuns.row_inputs); [exact IR | vm_compute; reflexivity | reflexivity | reflexivity]).
  assert (H1 : nearly (computes u exact_inputs co StageTwo.Parts.h1) lost (x "h1")) by (eapply (little "h1" co StageTwoRuns.coefficients); [exact IC | vm_compute; reflexivity | reflexivity | reflexivity]).
  assert (H2 : nearly (computes u exact_inputs co StageTwo.Parts.h2) lost (x "h2")) by (eapply (little "h2" co StageTwoRuns.coefficients); [exact IC | vm_compute; reflexivity | reflexivity | reflexivity]).
  assert (H3 : nearly (computes u exact_inputs co StageTwo.Parts.h3) lost (x "h3")) by (eapply (little "h3" co StageTwoRuns.coefficients); [exact IC | vm_compute; reflexivity | reflexivity | reflexivity]).
  assert (CD : nearly (computes u exact_inputs he StageTwo.Last.delta_3) lost (x "delta_3")) by (eapply (little "delta_3" he StageTwoRuns.hessian); [exact IH | vm_compute; reflexivity | reflexivity | reflexivity]).
  assert (Ce1 : computes u products_unrounded kn StageTwo.Bound.e1 (x "e1")) by (eapply (runs_so _ _ _ "e1"); [exact Ik | vm_compute; reflexivity]).
  assert (Ce2 : computes u products_unrounded kn StageTwo.Bound.e2 (x "e2")) by (eapply (runs_so _ _ _ "e2"); [exact Ik | vm_compute; reflexivity]).
  destruct (row_positive b0 d0 G1 G2) as (PA & PB & PP & PQ).
  assert (NZ : x "b" <> 0 /\ x "d" <> 0 /\ x "b" * x "b" <> 0) by (repeat split; try lra; apply Rmult_integral_contrapositive; lra).
  assert (A0 : 0 < A) by (apply A_pos; assumption); assert (B0 : 0 < B) by (apply B_pos; assumption).
  assert (XP : 0 <= P) by (apply P_ge_0; assumption); assert (XQ : 0 <= Q) by apply Q_ge_0.
  set (M0 := A * B); set (M1 := A * B + A + B + B * P + A * Q); set (M2 := A + B + 1 + P + Q).
  assert (XB : 0 <= M0 /\ 0 <= B * P /\ 0 <= A * Q) by (unfold M0; repeat split; apply Rmult_le_pos; lra).
  (* what is lost *)
  pose proof (bpow_gt_0 radix2 (-200)) as W200; pose proof (bpow_gt_0 radix2 (-100)) as W100.
  assert (wA : 1 <= x "A") by (unfold slack in G5; simpl in G5; lra).
  assert (wAB : pow (-200) <= x "AB") by (destruct (K "AB" _ eq_refl) as [(_ & _ & W) _]; exact W).
  assert (SM : / 2 ^ 52 * / 2 ^ 52 * / 2 ^ 52 = pow (-156)).
  { replace (/ 2 ^ 52) with u by (unfold unit_of_any_mode; simpl; lra); unfold unit_of_any_mode; rewrite <- !bpow_plus; reflexivity. }
  assert (lose : forall k v, pow k <= v -> (-544 <= k)%Z -> lost <= / 2 ^ 52 * / 2 ^ 52 * / 2 ^ 52 * v).
  { intros k v V L; rewrite SM; apply Rle_trans with (pow (-156) * pow k); [rewrite <- bpow_plus; apply at_most; lia |].
    apply Rmult_le_compat_l; [apply bpow_ge_0 | exact V]. }
  assert (L1 : 0 <= lost <= / 2 ^ 52 * / 2 ^ 52 * / 2 ^ 52) by (rewrite <- (Rmult_1_r (_ * _ * _)); split; [apply bpow_ge_0 | apply (lose 0%Z); [cbn; lra | lia]]).
  assert (LA : lost <= / 2 ^ 52 * / 2 ^ 52 * / 2 ^ 52 * x "A") by (apply (lose 0%Z); [cbn; lra | lia]).
  assert (LAB : lost <= / 2 ^ 52 * / 2 ^ 52 * / 2 ^ 52 * x "AB") by (apply (lose (-200)%Z); [exact wAB | lia]).
  assert (LABB : lost <= / 2 ^ 52 * / 2 ^ 52 * / 2 ^ 52 * (x "AB" * x "AB")).
  { apply (lose (-400)%Z); [change (-400)%Z with (-200 + -200)%Z; rewrite bpow_plus; apply Rmult_le_compat; lra | lia]. }
  assert (U52 : 0 <= u <= / 2 ^ 52) by (rewrite u_is; simpl; lra).
  assert (two : / 2 ^ 52 = / 4503599627370496) by (f_equal; simpl; lra).
  split; [| split].
  - pose proof (running_bound_covers_the_error (x "alpha") (x "gamma") (x "b") (x "d") (x "x") (x "y") (x "z") u G1 G2 b0 d0 U52
      (x "A") (x "B") (x "AB") fBP fAQ fP fQ (x "c1") (x "c2") lost CA CB CAB CBP CAQ CP CQ C1 C2 BP0 AQ0 P0 Q0 L1 LA LAB LABB (x "h1") (x "h2") (x "h3") H1 H2 H3
      (x "delta_3") CD (value kn StageTwo.Bound.E) (computes_value _ _ _)) as H.
    apply Rle_trans with (1 := H); clear H.
    (* how close the computed sizes are *)
    assert (close_A := close StageTwo.A A (x "A") PA ltac:(vm_compute; lia) CA ltac:(unfold A; simpl; field; lra)).
    assert (close_B := close StageTwo.B B (x "B") PB ltac:(vm_compute; lia) CB ltac:(unfold B; simpl; field; lra)).
    assert (close_AB := close StageTwo.AB M0 (x "AB") (or_introl (conj PA PB)) ltac:(vm_compute; lia) CAB ltac:(unfold M0, A, B; simpl; field; lra)).
    assert (close_BP := close_nearly StageTwo.BP (B * P) fBP (or_introl (conj PB PP)) ltac:(vm_compute; lia) CBP ltac:(unfold B, P; simpl; field; lra)).
    assert (close_AQ := close_nearly StageTwo.AQ (A * Q) fAQ (or_introl (conj PA PQ)) ltac:(vm_compute; lia) CAQ ltac:(unfold A, Q; simpl; field; lra)).
    assert (close_P := close_nearly StageTwo.P P fP PP ltac:(vm_compute; lia) CP ltac:(unfold P; simpl; field; lra)).
    assert (close_Q := close_nearly StageTwo.Q Q fQ PQ ltac:(vm_compute; lia) CQ ltac:(unfold Q; simpl; field; lra)).
    rewrite two in L1, LA, LAB, LABB; rewrite u_is in close_A, close_B, close_AB, close_BP, close_AQ, close_P, close_Q.
    set (N1 := x "A" + x "B" + x "AB" + (fBP + fAQ)); set (N2 := x "A" + x "B" + 1 + (fP + fQ)).
    assert (near_1 : 99 / 100 * M1 <= N1 <= 101 / 100 * M1) by (unfold N1, M1; fold M0; lra).
    assert (near_2 : 99 / 100 * M2 <= N2 <= 101 / 100 * M2) by (unfold N2, M2; lra).
    assert (near_0 : 0 <= x "AB" <= 101 / 100 * M0) by lra.
    assert (divides_c : forall e, divides_by_these e = true -> divides_well row e).
    { assert (divisor : forall e, is_divisor e = true -> divides_well row e /\ one_term e = true /\ value row e <> 0).
      { destruct NZ as (NZ1 & NZ2 & NZ3).
        intros [[| [| [| [| n]]]] | | | | | | [[| [| [| n]]] | | | | | | |] [[| [| [| m]]] | | | | | | |] |]; try discriminate; intros _; repeat split; assumption. }
      induction e as [| | | | e1 IH1 e2 IH2 | e1 IH1 e2 IH2 | e1 IH1 e2 IH2 | e1 IH1 e2 IH2]; cbn [divides_by_these divides_well]; intros O; try exact I; auto;
        apply andb_prop in O as [O1 O2]; auto; destruct (divisor e2 O2) as (V1 & V2 & V3); auto. }
    assert (F1 : Rabs (x "c1") <= 101 / 100 * M1).
    { pose proof (no_larger row StageTwo.c1 (x "c1") (divides_c StageTwo.c1 eq_refl) ltac:(vm_compute; lia) C1) as H.
      pose proof (size_c1 (x "alpha") (x "gamma") (x "b") (x "d") (x "x") (x "y") (x "z") G1 G2 b0 d0) as S; cbn [map] in H; rewrite S in H; unfold Kernel.M1 in H.
      fold A B P Q in H; fold M1 in H; assert (lost <= M1 / 1000) by (unfold M1; fold M0; lra); lra. }
    assert (F2 : Rabs (x "c2") <= 101 / 100 * M2).
    { pose proof (no_larger row StageTwo.c2 (x "c2") (divides_c StageTwo.c2 eq_refl) ltac:(vm_compute; lia) C2) as H.
      pose proof (size_c2 (x "alpha") (x "gamma") (x "b") (x "d") (x "x") (x "y") (x "z") G1 G2 b0 d0) as S; cbn [map] in H; rewrite S in H; unfold Kernel.M2 in H.
      fold A B P Q in H; fold M2 in H; assert (lost <= M2 / 1000) by (unfold M2; lra); lra. }
    assert (R3 : Rabs 3 = 3) by (apply Rabs_pos_eq; lra); assert (R9 : Rabs 9 = 9) by (apply Rabs_pos_eq; lra).
    assert (RB : Rabs (- x "AB") = x "AB") by (rewrite Rabs_Ropp; apply Rabs_pos_eq; lra).
    pose proof (no_larger co StageTwo.Parts.h1 (x "h1") ltac:(simpl; tauto) ltac:(vm_compute; lia) H1) as g1.
    pose proof (no_larger co StageTwo.Parts.h2 (x "h2") ltac:(simpl; tauto) ltac:(vm_compute; lia) H2) as g2.
    pose proof (no_larger co StageTwo.Parts.h3 (x "h3") ltac:(simpl; tauto) ltac:(vm_compute; lia) H3) as g3.
    unfold co in g1, g2, g3; simpl in g1, g2, g3; rewrite R3 in g1, g3; rewrite R9, RB in g2; rewrite RB in g3.
    destruct (sizes_small A B P Q ltac:(lra) ltac:(lra) XP XQ) as (Z1 & Z2 & Z3); fold M0 M1 M2 in Z1, Z2, Z3.
    assert (M1_1 : 99 / 100 <= M1) by (unfold M1; fold M0; lra); assert (M2_1 : 1 <= M2) by (unfold M2; lra).
    set (q4 := 4 * unit * slack); set (e0 := 8 * unit * slack * x "AB"); set (e1 := 12 * unit * slack * N1); set (e2 := 8 * unit * slack * N2).
    set (m0 := x "AB" + e0); set (m1 := Rabs (x "c1") + e1); set (m2 := Rabs (x "c2") + e2).
    set (B1 := m2 * (2 * e2 + q4 * m2) + 3 * (e1 + q4 * m1)); set (B2 := m2 * (e1 + q4 * m1) + m1 * e2 + 9 * (e0 + q4 * m0)).
    set (B3 := m1 * (2 * e1 + q4 * m1) + 3 * (m2 * (e0 + q4 * m0) + m0 * e2)).
    set (a1 := Rabs (x "h1") + B1); set (a2 := Rabs (x "h2") + B2); set (a3 := Rabs (x "h3") + B3).
    assert (EV : value kn StageTwo.Bound.E = slack * (4 * (a1 * (B3 + q4 * a3) + a3 * B1) + a2 * (2 * B2 + q4 * a2))).
    { assert (V1 : value kn StageTwo.Bound.E1 = B1) by (transitivity (m2 * (2 ^ 1 * e2 + q4 * m2) + 3 * (e1 + q4 * m1)); [reflexivity | unfold B1; ring]).
      assert (V2 : value kn StageTwo.Bound.E2 = B2) by reflexivity.
      assert (V3 : value kn StageTwo.Bound.E3 = B3) by (transitivity (m1 * (2 ^ 1 * e1 + q4 * m1) + 3 * (m2 * (e0 + q4 * m0) + m0 * e2)); [reflexivity | unfold B3; ring]).
      transitivity (slack * (2 ^ 2 * ((Rabs (x "h1") + value kn StageTwo.Bound.E1) * (value kn StageTwo.Bound.E3 + q4 * (Rabs (x "h3") + value kn StageTwo.Bound.E3))
        + (Rabs (x "h3") + value kn StageTwo.Bound.E3) * value kn StageTwo.Bound.E1)
        + (Rabs (x "h2") + value kn StageTwo.Bound.E2) * (2 ^ 1 * value kn StageTwo.Bound.E2 + q4 * (Rabs (x "h2") + value kn StageTwo.Bound.E2)))); [reflexivity |].
      rewrite V1, V2, V3; fold a1 a2 a3; ring. }
    assert (small : 0 <= 4 * (a1 * (B3 + q4 * a3) + a3 * B1) + a2 * (2 * B2 + q4 * a2) <= 1440 * unit * (M2 * M1 * (M2 * M1))).
    { pose proof (Rabs_pos (x "c1")); pose proof (Rabs_pos (x "c2")); pose proof (Rabs_pos (x "h1")); pose proof (Rabs_pos (x "h2")); pose proof (Rabs_pos (x "h3")).
      apply (running_bound_small M0 M1 M2 unit q4 e0 e1 e2 (x "AB") (Rabs (x "c1")) (Rabs (x "c2")) (Rabs (x "h1")) (Rabs (x "h2")) (Rabs (x "h3"))); try assumption;
        unfold q4, e0, e1, e2; rewrite ?unit_is, ?slack_is; lra. }
    rewrite EV; clear EV; clearbody a1 a2 a3 B1 B2 B3.
    assert (CE : computes u products_unrounded ke (Mul (Input 7) (Mul (Mul (Add (Add (Add (Input 0) (Input 1)) (Whole 1)) (Add (Input 5) (Input 6)))
      (Add (Add (Add (Input 0) (Input 1)) (Input 2)) (Add (Input 3) (Input 4)))) (Mul (Add (Add (Add (Input 0) (Input 1)) (Whole 1)) (Add (Input 5) (Input 6)))
      (Add (Add (Add (Input 0) (Input 1)) (Input 2)) (Add (Input 3) (Input 4)))))) (x "E")).
    { eapply (runs_so _ _ _ "E"); [exact Ie | vm_compute; reflexivity]. }
    assert (KE : forall n, 0 <= ke n).
    { intros n; do 8 (destruct n as [| n]; [unfold ke; cbn [nth]; rewrite ?unit_is, ?slack_is; lra |]); unfold ke; destruct n; cbn [nth]; lra. }
    pose proof (fun PE => positive_factor u products_unrounded ke _ _ U PE CE) as PF; destruct (PF ltac:(apply sums_positive; [exact KE | reflexivity])) as (f & F & EE).
    pose proof (fun L => few _ f L F) as FF; destruct (FF ltac:(vm_compute; lia)) as [F0 _]; clear FF PF; unfold ke in EE; cbn [value nth] in EE; fold N1 N2 in EE.
    assert (NN : 96 / 100 * (M2 * M1 * (M2 * M1)) <= N2 * N1 * (N2 * N1)).
    { destruct (product_le (99 / 100 * M2) N2 (99 / 100 * M1) N1 ltac:(lra) ltac:(lra)) as [W0 W1].
      destruct (product_le _ _ _ _ (conj W0 W1) (conj W0 W1)) as [W2 W3].
      replace (99 / 100 * M2 * (99 / 100 * M1) * (99 / 100 * M2 * (99 / 100 * M1))) with (96059601 / 100000000 * (M2 * M1 * (M2 * M1))) in W2, W3 by field; lra. }
    rewrite EE; set (m := M2 * M1 * (M2 * M1)) in *; set (n := N2 * N1 * (N2 * N1)) in *.
    assert (m0' : 0 <= m) by (unfold m; apply Rmult_le_pos; apply Rmult_le_pos; lra).
    rewrite unit_is, slack_is in *; rewrite u_is in F0.
    apply Rle_trans with ((1 + / 1048576) * (1440 * / 4503599627370496 * m)); [apply Rmult_le_compat_l; lra |].
    assert (nf : n * (999 / 1000) <= n * f) by (apply Rmult_le_compat_l; lra); lra.
  - eapply bound_covers_c1; eassumption.
  - eapply bound_covers_c2; eassumption.
Qed.

Lemma not_negative : 0 <= x "E" /\ 0 <= x "e1" /\ 0 <= x "e2".
Proof. repeat split; [apply (K "E" _ eq_refl) | apply (K "e1" _ eq_refl) | apply (K "e2" _ eq_refl)]; reflexivity. Qed.

(** What is asked of the ratios holds of the exact ones. *)
Theorem ratios_hold : 1 < A /\ A < B ^ 2.
Proof.
  destruct guards as (G1 & G2 & G3 & G4 & G5 & G6 & _ & G8).
  assert (b0 : 0 < x "b") by (pose proof (bpow_gt_0 radix2 (-100)); lra); assert (d0 : 0 < x "d") by (pose proof (bpow_gt_0 radix2 (-100)); lra).
  assert (A0 : 0 < A) by (apply A_pos; assumption); assert (B0 : 0 < B) by (apply B_pos; assumption).
  assert (IR : all_stand multiplied x pre exact_inputs row StageTwoRuns.row_inputs).
  { apply given_stand; intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity. }
  assert (CA : computes u exact_inputs row StageTwo.A (x "A")) by (eapply (runs_so _ _ StageTwoRuns.row_inputs "A"); [exact IR | vm_compute; reflexivity]).
  assert (CB : computes u exact_inputs row (Mul StageTwo.B StageTwo.B) (x "BB")) by (eapply (runs_so _ _ StageTwoRuns.row_inputs "BB"); [exact IR | vm_compute; reflexivity]).
  destruct (row_positive b0 d0 G1 G2) as (PA & PB & _ & _).
  destruct (close StageTwo.A A (x "A") PA ltac:(vm_compute; lia) CA ltac:(unfold A; simpl; field; lra)) as [LA HA].
  destruct (close (Mul StageTwo.B StageTwo.B) (B ^ 2) (x "BB") (or_introl (conj PB PB)) ltac:(vm_compute; lia) CB ltac:(unfold B; simpl; field; lra)) as [LB HB].
  destruct (product_of "slack_A" "slack" "A" by_search) as [EP RP]; destruct (K "slack_A" _ eq_refl) as [_ (W1 & _ & W2)]; cbn [low high] in W1, W2.
  pose proof (bpow_lt radix2 101 1023 ltac:(lia)); pose proof (Rle_abs (pre "slack_A")); pose proof (at_most (-1022) (-100) ltac:(lia)).
  destruct (rounding_loses _ _ RP ltac:(lra)) as (t & T & _ & E); specialize (E ltac:(lra)).
  assert (SL : x "slack" = slack) by (apply Constants, look_in; reflexivity); rewrite SL in EP; rewrite EP in E.
  rewrite u_is, slack_is in *; pose proof (Rle_abs (- t)) as T'; rewrite Rabs_Ropp in T'; split; [lra |].
  assert (x "A" * (1 - / 4503599627370496) <= x "A" * (1 + t)) by (apply Rmult_le_compat_l; lra).
  lra.
Qed.
End Fit.

(** **What hc_single answers is the position.** *)
Theorem single_is_right : exists o, says_single greater = match o with Some Exterior => 1 | Some Interior => -1 | Some Contact => 0 | None => 2 end%Z
  /\ forall a, o = Some a -> is_position body a.
Proof.
  unfold says_single; destruct (sizes_fit greater) eqn:Sizes; [| exists None; split; [reflexivity | discriminate]].
  destruct (ratios_fit greater) eqn:Ratios; [| exists None; split; [reflexivity | discriminate]].
  destruct (greater (Name "farthest") (Name "P_plus_Q")) eqn:Near; [| exists None; split; [reflexivity | discriminate]]; cbn [andb].
  destruct (bounds_cover Sizes Ratios Near) as (D & D1 & D2); destruct (ratios_hold Sizes Ratios Near) as [A1 AB]; destruct (not_negative Sizes Ratios Near) as (E0 & E1 & E2).
  destruct (guards Sizes Ratios Near) as (Ha & Hg & G3 & G4 & _); assert (Hb : 0 < x "b") by (pose proof (bpow_gt_0 radix2 (-100)); lra);
    assert (Hd : 0 < x "d") by (pose proof (bpow_gt_0 radix2 (-100)); lra).
  set (A := (x "alpha" / x "b") ^ 2) in *; set (B := (x "gamma" / x "d") ^ 2) in *; set (P := (x "x" ^ 2 + x "y" ^ 2) / x "b" ^ 2) in *; set (Q := (x "z" / x "d") ^ 2) in *.
  assert (HA : 0 < A) by lra; assert (HB : 0 < B) by (apply B_pos; assumption); assert (HP : 0 <= P) by (apply P_ge_0; assumption); assert (HQ : 0 <= Q) by apply Q_ge_0.
  destruct (positions_by_g (x "alpha") (x "gamma") (x "b") (x "d") (x "x") (x "y") (x "z") Ha Hg Hb Hd) as (ByE & ByI & _); fold A B P Q body in ByE, ByI.
  assert (up : forall X E v, Rabs (X - v) <= E -> E < X -> 0 < v) by (intros X E v H C; pose proof (Rle_abs (X - v)); lra).
  assert (low : forall X E v, Rabs (X - v) <= E -> X < - E -> v < 0) by (intros X E v H C; pose proof (Rle_abs (- (X - v))) as C'; rewrite Rabs_Ropp in C'; lra).
  assert (N0 : greater (Name "minus_E") (Name "delta_3") = true -> contact body).
  { intros H; apply more in H; rewrite (opposite_of "minus_E" _ by_search) in H; pose proof (low _ _ _ D H).
    apply contact_by_discriminant; try assumption; fold A B P Q; lra. }
  assert (N1 : apart greater = true -> 0 < delta A B P Q) by (intros H; apply more in H; pose proof (up _ _ _ D H); lra).
  assert (N2 : is_outside greater = true -> c2 A B P Q < 0 /\ 0 < c1 A B P Q /\ x "c2" < - x "e2" /\ x "e1" < x "c1").
  { intros H; apply andb_prop in H as [H1 H2]; apply more in H1, H2; rewrite (opposite_of "minus_e2" _ by_search) in H1; repeat split; try assumption; [exact (low _ _ _ D2 H1) | exact (up _ _ _ D1 H2)]. }
  assert (N3 : is_inside greater = true -> (0 < c2 A B P Q \/ c1 A B P Q < 0) /\ (x "e2" < x "c2" \/ x "c1" < - x "e1")).
  { intros H; apply orb_prop in H as [H | H]; apply more in H; [split; [left; exact (up _ _ _ D2 H) | auto] |].
    rewrite (opposite_of "minus_e1" _ by_search) in H; split; [right; exact (low _ _ _ D1 H) | auto]. }
  change (FloatTexts.one_root greater) with (greater (Name "minus_E") (Name "delta_3")).
  assert (N4 : apart greater = true -> greater (Name "minus_E") (Name "delta_3") = true -> False).
  { intros H C; apply more in H, C; rewrite (opposite_of "minus_E" _ by_search) in C; lra. }
  destruct (apart greater) eqn:Apart; cbn [andb].
  - destruct (is_outside greater) eqn:Out, (is_inside greater) eqn:In.
    + exfalso; destruct (N2 eq_refl) as (_ & _ & K2 & K1); destruct (N3 eq_refl) as [_ [K | K]]; lra.
    + exists (Some Exterior); rewrite orb_true_r; split; [reflexivity |]; intros a H; injection H as <-; destruct (N2 eq_refl) as (K2 & K1 & _).
      apply ByE, (proposition_3_repaired A B P Q HA HB HP HQ); [lra |]; left; auto.
    + exists (Some Interior); rewrite orb_true_r; split; [reflexivity |]; intros a H; injection H as <-; destruct (N3 eq_refl) as [K _].
      apply ByI, (proposition_5_repaired A B P Q HA HB HP HQ); [lra |]; split; [auto | intros [K2 K1]; lra].
    + rewrite orb_false_r; destruct (greater (Name "minus_E") (Name "delta_3")) eqn:C; [exfalso; auto | exists None; split; [reflexivity | discriminate]].
  - rewrite orb_false_r; destruct (greater (Name "minus_E") (Name "delta_3")) eqn:C; [| exists None; split; [reflexivity | discriminate]].
    exists (Some Contact); split; [reflexivity |]; intros a H; injection H as <-; exact (N0 eq_refl).
Qed.

End Single.
