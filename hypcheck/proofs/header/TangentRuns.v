(** The half plane of a tangent from its C: the line that hc_tangent_beyond makes has the margin that StageOne.v asks for.

    As in StageTwoRuns.v: [x] has the number that each step gives, each rounded in a mode of its own, contracted or not, flushed to 0
    below the normal range or not. The sizes are those that hc_make_scene lets through. A line whose constant is beyond 2^400 answers
    nothing below the cap. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Flocq Require Import Core.
From Hypcheck Require Import Geometry HalfPlanes Rounding Floats Steps FixedRuns Kernel RunningBound Ranges Underflow FloatTexts TangentTexts.
From Hypcheck Require StageTwoRuns StageOne.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Lemma stays_high p v e : returned p v -> (-1022 <= e <= 1023)%Z -> pow e <= p -> pow e <= v.
Proof.
  intros R [E1 E2] H; pose proof (bpow_gt_0 radix2 e); pose proof (at_most _ _ E1); pose proof (at_most _ _ E2); destruct R as [R | [[T _] | (T & V & PV)]].
  - apply stays_above with p; [exact R | lia | exact H].
  - rewrite Rabs_pos_eq in T by lra; lra.
  - assert (0 <= v) by (apply Rmult_le_reg_l with p; lra); rewrite Rabs_pos_eq in V by assumption; lra.
Qed.
Lemma stays_signed p v : returned p v -> (0 <= p -> 0 <= v) /\ (0 < v -> 0 < p).
Proof.
  pose proof (bpow_gt_0 radix2 1023); intros [R | [[_ ->] | (T & V & PV)]]; split; intros H0; try lra.
  - apply stays_positive with p; assumption.
  - apply Rnot_le_lt; intros N; destruct R as (rnd & VR & ->); assert (W : round radix2 binary64 rnd p <= 0) by (apply round_le_generic; [exact its_exponents | exact VR | apply generic_format_0 | exact N]); lra.
  - rewrite Rabs_pos_eq in T by exact H0; apply Rmult_le_reg_l with p; lra.
  - apply Rnot_le_lt; intros N; rewrite Rabs_left1 in T by exact N; assert (p * v < 0) by (apply Ropp_lt_cancel; rewrite Ropp_mult_distr_l, Ropp_0; apply Rmult_lt_0_compat; lra); lra.
Qed.

Definition names_of f l := map name (filter (fun s => match kind_of s with Some k => f k | None => false end) l).
Definition multiplied := Eval vm_compute in names_of (fun k => match k with Times | Negated => true | _ => false end) C_beyond.
Definition floats := Eval vm_compute in names_of (fun k => match k with Plus | Minus | Times | Over => true | _ => false end) C_beyond.
Definition given_sizes := [("alpha", between (-100) 100); ("gamma", between (-100) 100); ("b", between (-100) 100); ("d", between (-100) 100);
  ("lambda_", between (-602) 401); ("u_8", between (-49) (-48)); ("more", between 0 1); ("K", between (-602) 401)].
Definition guarded_twice := ([("gap_least", between (-602) 603); ("M", between (-804) 401)] ++ given_sizes)%list.
Definition before_gap := firstn 15 C_beyond.
Definition known := Eval vm_compute in match Ranges.sizes guarded_twice C_beyond with Some t => t | None => [] end.
Definition known_before := Eval vm_compute in match Ranges.sizes given_sizes before_gap with Some t => t | None => [] end.
Lemma known_is_reached : Ranges.sizes guarded_twice C_beyond = Some known /\ Ranges.sizes given_sizes before_gap = Some known_before.
Proof. vm_compute; auto. Qed.
Definition from_inputs := StageTwoRuns.given_as [("alpha", 0); ("gamma", 1); ("b", 2); ("d", 3); ("lambda_", 4); ("u_8", 5); ("more", 6); ("gap_least", 7)]%nat.
Definition from_row := StageTwoRuns.given_as [("alpha", 0); ("gamma", 1); ("b", 2); ("d", 3); ("lambda_", 4); ("u_8", 5); ("more", 6)]%nat.

Local Notation by_search := ltac:(vm_compute; reflexivity) (only parsing).
Notation u := unit_of_any_mode.

Section Beyond.

Variables (x pre : string -> R) (greater at_least : argument -> argument -> bool).
Definition constants := [("u_8", 8 * unit * slack); ("more", 1 + 32 * unit); ("least_constant", pow (-300)); ("greatest_slope", pow 400)].
Hypotheses (Runs : Forall (runs multiplied x pre) C_beyond)
  (More : forall a c p q, greater a c = true -> has x a p -> has x c q -> q < p) (Least : forall a c p q, at_least a c = true -> has x a p -> has x c q -> q <= p)
  (Constants : forall n v, In (n, v) constants -> x n = v) (Inputs : forall n, In n ["alpha"; "gamma"; "b"; "d"; "lambda_"; "u_8"; "more"] -> pre n = x n)
  (Sizes : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> pow (-100) < x n < pow 100)
  (Proves : proves_beyond greater at_least = true).

Section Low.
Hypothesis Low : x "K_most" <= pow 400.

Definition step_of n := find (fun s => String.eqb (name s) n) C_beyond.
Lemma runs_of n s : step_of n = Some s -> runs multiplied x pre s.
Proof. intros E; apply find_some in E as [I _]; apply (proj1 (Forall_forall _ _) Runs s I). Qed.
Lemma product_of n a c : step_of n = Some (Step n "mul" [Name a; Name c]) -> pre n = x a * x c /\ returned (pre n) (x n).
Proof. intros E; destruct (runs_of n _ E) as (p & q & -> & -> & H); exact H. Qed.
Lemma quotient_of n a c : step_of n = Some (Step n "div" [Name a; Name c]) -> pre n = x a / x c /\ returned (pre n) (x n).
Proof. intros E; destruct (runs_of n _ E) as (p & q & -> & -> & H); exact H. Qed.
Definition taken n p := p = x n \/ p = pre n.
Lemma sum_of n a c : step_of n = Some (Step n "add" [Name a; Name c]) -> (exists p q, taken a p /\ taken c q /\ pre n = p + q) /\ returned (pre n) (x n).
Proof. intros E; destruct (runs_of n _ E) as (p & q & P & Q & H & G); split; [exists p, q; repeat split; [destruct P as [P | [_ P]] | destruct Q as [Q | [_ Q]] |]; unfold taken; auto | exact G]. Qed.
Lemma difference_of n a c : step_of n = Some (Step n "sub" [Name a; Name c]) -> (exists p q, taken a p /\ taken c q /\ pre n = p - q) /\ returned (pre n) (x n).
Proof. intros E; destruct (runs_of n _ E) as (p & q & P & Q & H & G); split; [exists p, q; repeat split; [destruct P as [P | [_ P]] | destruct Q as [Q | [_ Q]] |]; unfold taken; auto | exact G]. Qed.

Let powers a c : pow (a + c) = pow a * pow c := bpow_plus radix2 a c.
Let product_high a c p q : pow a <= p -> pow c <= q -> pow (a + c) <= p * q.
Proof. intros P Q; rewrite powers; apply Rmult_le_compat; auto using bpow_ge_0. Qed.

Lemma asked : 0 < x "lambda_" /\ 0 < x "gap_least" /\ pow (-300) <= x "K_most" /\ x "M_most" <= pow 400.
Proof.
  pose proof Proves as P; unfold proves_beyond in P; apply andb_prop in P as [P P4]; apply andb_prop in P as [P P3]; apply andb_prop in P as [P1 P2].
  assert (L : x "least_constant" = pow (-300)) by (apply Constants, look_in; reflexivity); assert (G : x "greatest_slope" = pow 400) by (apply Constants, look_in; reflexivity).
  rewrite <- L, <- G; repeat split; [apply (More _ _ _ _ P1) | apply (More _ _ _ _ P2) | apply (Least _ _ _ _ P3) | apply (Least _ _ _ _ P4)]; reflexivity.
Qed.

Let more_is : 1 <= x "more".
Proof. rewrite (Constants "more" (1 + 32 * unit)) by (apply look_in; reflexivity); unfold unit; simpl; lra. Qed.

(** Whatever lambda is, by what is asked of the results. *)
Lemma in_range : pow (-602) <= x "lambda_" <= pow 401 /\ (pow (-602) <= x "K" <= pow 401 /\ pow (-602) <= pre "K" <= pow 401)
  /\ (pow (-601) <= x "gap_least" /\ pow (-602) <= pre "gap_least") /\ (x "M" <= pow 401 /\ pre "M" <= pow 401) /\ pow (-200) <= x "across".
Proof.
  destruct asked as (L0 & G0 & K0 & M0).
  assert (size : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> pow (-100) <= x n /\ x n <= pow 100) by (intros n I; pose proof (Sizes n I); lra).
  assert (square : forall n a, step_of n = Some (Step n "mul" [Name a; Name a]) -> In a ["alpha"; "gamma"; "b"; "d"] -> forall p, taken n p -> pow (-200) <= p <= pow 200).
  { intros n a E I; destruct (product_of n a a E) as [EP RP]; destruct (size a I) as [S1 S2]; pose proof (bpow_gt_0 radix2 (-100)).
    assert (W : pow (-200) <= pre n <= pow 200).
    { rewrite EP; split; [apply (product_high (-100) (-100)); assumption |]; change 200%Z with (100 + 100)%Z; rewrite powers; apply Rmult_le_compat; lra. }
    intros p [-> | ->]; [| exact W]; split; [apply stays_high with (pre n); [exact RP | lia | lra] | apply no_more with (pre n); [exact RP | | lia | lra]].
    pose proof (bpow_gt_0 radix2 (-200)); lra. }
  pose proof (square "p" "alpha" by_search ltac:(cbn; tauto)) as Sp; pose proof (square "q" "b" by_search ltac:(cbn; tauto)) as Sq.
  pose proof (square "s" "gamma" by_search ltac:(cbn; tauto)) as Ss; pose proof (square "t" "d" by_search ltac:(cbn; tauto)) as St; clear square.
  pose proof (bpow_gt_0 radix2 (-200)) as W200.
  destruct (product_of "q_lambda" _ _ by_search) as [Eql Rql]; destruct (Sq (x "q") (or_introl eq_refl)) as [q1 _].
  assert (ql : forall p, taken "q_lambda" p -> 0 <= p).
  { assert (W : 0 <= pre "q_lambda") by (rewrite Eql; apply Rmult_le_pos; lra); intros p [-> | ->]; [apply (stays_signed _ _ Rql); exact W | exact W]. }
  destruct (sum_of "across" _ _ by_search) as [(p' & ql' & Tp & Tq & Ea) Ra]; specialize (Sp p' Tp); specialize (ql ql' Tq).
  assert (A1 : pow (-200) <= x "across") by (apply stays_high with (pre "across"); [exact Ra | lia | lra]).
  assert (O1 : pow 0 <= x "one_plus_lambda").
  { destruct (runs_of "one_plus_lambda" _ by_search) as (o & l & To & Tl & Eo & Ro); cbn [takes name] in To, Tl, Eo, Ro; apply stays_high with (pre "one_plus_lambda"); [exact Ro | lia |].
    rewrite Eo, To; destruct Tl as [-> | [N _]]; [cbn; lra | discriminate N]. }
  destruct (product_of "product" _ _ by_search) as [Epr Rpr].
  assert (P1 : pow (-200) <= x "product").
  { apply stays_high with (pre "product"); [exact Rpr | lia |]; rewrite Epr; apply (product_high (-200) 0); assumption. }
  (* the gap bounds lambda from above *)
  destruct (product_of "t_lambda" _ _ by_search) as [Etl Rtl]; destruct (St (x "t") (or_introl eq_refl)) as [t1 _].
  assert (tl0 : 0 <= pre "t_lambda") by (rewrite Etl; apply Rmult_le_pos; lra); pose proof (proj1 (stays_signed _ _ Rtl) tl0) as tl0'.
  destruct (sum_of "gap_terms" _ _ by_search) as [(s1 & tl1 & Ts1 & Ttl1 & Egt) Rgt]; pose proof (Ss s1 Ts1) as S1.
  assert (gt0 : 0 <= x "gap_terms") by (apply (stays_signed _ _ Rgt); rewrite Egt; destruct Ttl1 as [-> | ->]; lra).
  destruct (product_of "gap_error" _ _ by_search) as [Ege Rge].
  assert (U8 : 0 <= x "u_8") by (rewrite (Constants "u_8" (8 * unit * slack)) by (apply look_in; reflexivity); unfold unit, slack; simpl; lra).
  assert (ge0 : 0 <= pre "gap_error") by (rewrite Ege; apply Rmult_le_pos; assumption); pose proof (proj1 (stays_signed _ _ Rge) ge0) as ge0'.
  destruct (runs_of "gap_least" _ by_search) as (g' & e' & Tg & Te & Egl & Rgl); cbn [takes name] in Tg, Te, Egl, Rgl; pose proof (proj2 (stays_signed _ _ Rgl) G0) as GL0.
  destruct Tg as [-> | [N _]]; [| discriminate N].
  assert (E0 : 0 <= e') by (destruct Te as [-> | [_ ->]]; assumption).
  destruct (difference_of "gap" _ _ by_search) as [(s2 & tl2 & Ts2 & Ttl2 & Egap) Rgap]; pose proof (Ss s2 Ts2) as S2.
  pose proof (proj2 (stays_signed _ _ Rgap) ltac:(lra)) as gap0.
  pose proof (at_most 200 400 ltac:(lia)) as W400.
  assert (TL : pre "t_lambda" < pow 201).
  { pose proof (bpow_lt radix2 200 201 ltac:(lia)); destruct Ttl2 as [E2 | E2]; [apply (below _ _ 201 Rtl tl0 ltac:(lia)); lra | lra]. }
  assert (LH : x "lambda_" <= pow 401).
  { apply Rmult_le_reg_l with (pow (-200)); [exact W200 |]; rewrite <- powers; change (-200 + 401)%Z with 201%Z.
    apply Rle_trans with (x "t" * x "lambda_"); [apply Rmult_le_compat_r; lra | lra]. }
  (* and the constant from below *)
  destruct (product_of "K_most" _ _ by_search) as [Ekm Rkm]; destruct (quotient_of "K" _ _ by_search) as [Ek Rk].
  assert (k0 : 0 < pre "K") by (rewrite Ek; apply Rdiv_lt_0_compat; lra); pose proof (proj1 (stays_signed _ _ Rk) ltac:(lra)) as k0'.
  assert (half : forall n, pow 400 < pow 401 -> n <= pow 400 -> n < pow 401) by (intros; lra); specialize (fun n => half n (bpow_lt radix2 400 401 ltac:(lia))).
  assert (up : forall v, 0 <= v -> v <= x "more" * v) by (intros v V; pose proof (Rmult_le_compat_r v 1 (x "more") V more_is); lra).
  pose proof (below _ _ 401 Rkm ltac:(rewrite Ekm; apply Rmult_le_pos; lra) ltac:(lia) (half _ Low)) as KM.
  pose proof (up (x "K") k0') as KU; rewrite Ekm in KM; assert (KX : x "K" < pow 401) by lra; pose proof (below _ _ 401 Rk ltac:(lra) ltac:(lia) KX) as KP.
  assert (over : forall a v, 0 < v -> a / v < pow 401 -> pow (-200) <= a -> pow (-601) <= v).
  { intros a v V Q H; apply Rmult_le_reg_r with (pow 401); [apply bpow_gt_0 |]; rewrite <- powers; change (-601 + 401)%Z with (-200)%Z.
    apply Rle_trans with (1 := H); left; apply Rmult_lt_reg_r with (/ v); [apply Rinv_0_lt_compat; exact V |].
    apply Rlt_le_trans with (1 := Q); right; field; lra. }
  rewrite Ek in KP; pose proof (over _ _ L0 KP P1) as LL.
  assert (KL : pow (-602) <= x "product" / x "lambda_").
  { change (-602)%Z with (-201 + -401)%Z; pose proof (at_most (-201) (-200) ltac:(lia)); unfold Rdiv; apply product_high; [lra |].
    rewrite bpow_opp with (e := 401%Z); apply Rinv_le_contravar; assumption. }
  (* the slope bounds the gap *)
  destruct (product_of "M_most" _ _ by_search) as [Emm Rmm]; destruct (quotient_of "M" _ _ by_search) as [Em Rm].
  assert (m0 : 0 < pre "M") by (rewrite Em; apply Rdiv_lt_0_compat; lra); pose proof (proj1 (stays_signed _ _ Rm) ltac:(lra)) as m0'.
  pose proof (below _ _ 401 Rmm ltac:(rewrite Emm; apply Rmult_le_pos; lra) ltac:(lia) (half _ M0)) as MM.
  pose proof (up (x "M") m0') as MU; rewrite Emm in MM; assert (MX : x "M" < pow 401) by lra; pose proof (below _ _ 401 Rm ltac:(lra) ltac:(lia) MX) as MP.
  rewrite Em in MP; pose proof (over _ _ G0 MP A1) as GL; pose proof (bpow_lt radix2 (-602) (-601) ltac:(lia)).
  assert (KL' : pow (-602) <= x "K") by (apply stays_high with (pre "K"); [exact Rk | lia | rewrite Ek; exact KL]).
  pose proof (above _ _ (-602) Rgl ltac:(lra) ltac:(lia) ltac:(lra)) as GP.
  rewrite Ek, Em; repeat split; lra.
Qed.

Let between_is l h v : pow l <= v <= pow h -> within (between l h) v.
Proof. intros [L H]; pose proof (bpow_gt_0 radix2 l); repeat split; cbn; [rewrite Rabs_pos_eq | |]; lra. Qed.
Let constant n v : In (n, v) constants -> In n ["u_8"; "more"] -> x n = v /\ pre n = v.
Proof. intros I J; split; [apply Constants; exact I |]; rewrite Inputs; [apply Constants; exact I | cbn [In] in J |- *; tauto]. Qed.

Lemma sizes_given : all_hold x pre given_sizes.
Proof.
  destruct in_range as (L & (K1 & K2) & _ & _ & _); intros n s H; unfold given_sizes in H; cbn [look] in H.
  repeat match type of H with (if String.eqb ?a n then Some ?t else _) = Some s => destruct (String.eqb_spec a n) as [<- | _]; [injection H as <- |] end; [.. | discriminate].
  1-4: rewrite Inputs by (cbn; tauto); match goal with |- within _ (x ?n) /\ _ => pose proof (Sizes n ltac:(cbn; tauto)) end; split; apply between_is; lra.
  - rewrite Inputs by (cbn; tauto); split; apply between_is; exact L.
  - destruct (constant "u_8" (8 * unit * slack)) as [-> ->]; [apply look_in; reflexivity | cbn; tauto |]; unfold unit, slack; split; apply between_is; simpl; lra.
  - destruct (constant "more" (1 + 32 * unit)) as [-> ->]; [apply look_in; reflexivity | cbn; tauto |]; unfold unit; split; apply between_is; simpl; lra.
  - split; apply between_is; assumption.
Qed.

Lemma all_known : all_hold x pre known.
Proof.
  destruct known_is_reached as [R1 R2]; destruct in_range as (_ & _ & (G1 & G2) & (M1 & M2) & A1); destruct asked as (_ & G0 & _ & _).
  assert (F : Forall (runs multiplied x pre) before_gap) by (apply Forall_forall; intros s I; apply (proj1 (Forall_forall _ _) Runs); revert I; unfold before_gap; rewrite <- (firstn_skipn 15 C_beyond) at 2; intros I; apply in_or_app; auto).
  destruct (sizes_hold multiplied x pre before_gap given_sizes known_before sizes_given F R2 "gap_least" _ eq_refl) as [(H1 & _) (H2 & _)]; cbn [high] in H1, H2.
  pose proof (Rle_abs (x "gap_least")); pose proof (Rle_abs (pre "gap_least")).
  apply (sizes_hold multiplied x pre C_beyond guarded_twice known); [| exact Runs | exact R1].
  destruct (quotient_of "M" _ _ by_search) as [Em Rm].
  assert (ML : pow (-804) <= pre "M").
  { rewrite Em; change (-804)%Z with (-201 + -603)%Z; pose proof (at_most (-201) (-200) ltac:(lia)); unfold Rdiv; apply product_high; [lra |].
    rewrite bpow_opp with (e := 603%Z); apply Rinv_le_contravar; lra. }
  pose proof (at_most (-602) (-601) ltac:(lia)); assert (MX : pow (-804) <= x "M") by (apply stays_high with (pre "M"); [exact Rm | lia | exact ML]).
  intros n s H'; unfold guarded_twice in H'; cbn [app look] in H'.
  destruct (String.eqb_spec "gap_least" n) as [<- | _]; [injection H' as <-; split; apply between_is; lra |].
  destruct (String.eqb_spec "M" n) as [<- | _]; [injection H' as <-; split; apply between_is; lra |].
  exact (sizes_given n s H').
Qed.

Lemma known_high n r : look n known = Some r -> (high r <= 1023)%Z.
Proof.
  assert (H : forallb (fun p => (high (snd p) <=? 1023)%Z) known = true) by (vm_compute; reflexivity).
  intros E; apply look_in in E; rewrite forallb_forall in H; apply Z.leb_le, (H (n, r) E).
Qed.
Lemma all_float n : is_in n floats = true -> float (x n).
Proof.
  intros I; assert (KN : forallb (fun n => match look n known with Some _ => true | None => false end) floats = true) by (vm_compute; reflexivity).
  apply is_in_In in I; rewrite forallb_forall in KN; specialize (KN n I); destruct (look n known) as [r |] eqn:L; [| discriminate].
  destruct (all_known n r L) as [_ (W & _)]; pose proof (at_most _ _ (known_high n r L)).
  apply (returned_float (pre n)); [| lra]; clear - I Runs; change floats with (names_of (fun k => match k with Plus | Minus | Times | Over => true | _ => false end) C_beyond) in I.
  unfold names_of in I; apply in_map_iff in I as (s & <- & I); apply filter_In in I as [I E]; pose proof (proj1 (Forall_forall _ _) Runs s I) as H.
  unfold runs in H; destruct (kind_of s) as [[] |]; try discriminate; destruct (arguments (meaning s)) as [| a [| c [|]]]; try contradiction;
    destruct H as (p & q & _ & _ & _ & H); exact H.
Qed.

(** ** The margin. *)

Let env k := nth k (map x ["alpha"; "gamma"; "b"; "d"; "lambda_"; "u_8"; "more"; "gap_least"]) 0.
Let stands_given l : (forall n k, In (n, k) l -> env k = x n) -> all_stand multiplied x pre exact_inputs env (StageTwoRuns.given_as l).
Proof.
  intros H n c E; apply look_in in E; unfold StageTwoRuns.given_as in E; apply in_map_iff in E as ([m k] & E & I); injection E as <- <-; cbn [fst snd].
  split; [| discriminate]; exists (env k * 1); split; [apply c_input | cbn [tree loss loses]; rewrite (H m k I); ring].
  assert (U : 0 <= u < 1) by (unfold unit_of_any_mode; simpl; lra); apply factor_1; exact U.
Qed.
Let computed l n c : (forall n k, In (n, k) l -> env k = x n) -> look n (cells multiplied floats known (StageTwoRuns.given_as l) C_beyond) = Some c ->
  exists w, computes u exact_inputs env (tree c) w /\ loses (loss c) (x n - w).
Proof.
  intros H E; apply (cells_stand multiplied floats x pre exact_inputs env all_float known C_beyond _ all_known known_high Runs (stands_given l H) n c E).
Qed.

Let u_is : u = / 4503599627370496.
Proof. unfold unit_of_any_mode; simpl; lra. Qed.
Let unit_is : unit = / 4503599627370496.
Proof. unfold unit; f_equal; simpl; lra. Qed.
Let slack_is : slack = 1 + / 1048576.
Proof. unfold slack; f_equal; f_equal; simpl; lra. Qed.
Let U : 0 <= u < 1.
Proof. rewrite u_is; lra. Qed.
Let few k f : (k <= 8)%nat -> factor u k f -> 1 - 8 * u <= f.
Proof.
  intros L [F1 F2]; pose proof (bernoulli u k ltac:(lra)) as B; apply le_INR in L; rewrite (INR_IZR_INZ 8) in L; simpl in L; pose proof (pos_INR k) as P0.
  assert (INR k * u <= 8 * u) by (apply Rmult_le_compat_r; lra); lra.
Qed.

Let A := (x "alpha" / x "b") ^ 2.
Let B := (x "gamma" / x "d") ^ 2.

(** The gap that is computed is no more than the exact one. *)
Lemma gap_is_less : x "gap_least" <= x "gamma" * x "gamma" - x "d" * x "d" * x "lambda_".
Proof.
  destruct (computed [("alpha", 0); ("gamma", 1); ("b", 2); ("d", 3); ("lambda_", 4); ("u_8", 5); ("more", 6)]%nat "gap_least"
    (Cell (Sub (Sub (Mul (Input 1) (Input 1)) (Mul (Mul (Input 3) (Input 3)) (Input 4))) (Mul (Input 5) (Add (Mul (Input 1) (Input 1)) (Mul (Mul (Input 3) (Input 3)) (Input 4)))))
      (Some (-1021)%Z) true)) as (w & C & D); [intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity | vm_compute; reflexivity |].
  cbn [tree loss loses] in C, D; pose proof (fun V => error_bound u exact_inputs env U _ w V C) as H; specialize (H ltac:(cbn; tauto)).
  set (s := x "gamma" * x "gamma") in *; set (t := x "d" * x "d" * x "lambda_") in *.
  destruct asked as (L0 & _); pose proof (Sizes "gamma" ltac:(cbn; tauto)) as Hg; pose proof (Sizes "d" ltac:(cbn; tauto)) as Hd; pose proof (bpow_gt_0 radix2 (-100)).
  assert (S1 : pow (-200) <= s) by (apply (product_high (-100) (-100)); lra); assert (T0 : 0 <= t) by (unfold t; repeat apply Rmult_le_pos; lra).
  assert (U8 : x "u_8" = 8 * unit * slack) by (apply Constants, look_in; reflexivity).
  change (Rabs (w - (s - t - x "u_8" * (s + t))) <= growth u 5 * (Rabs (x "gamma") * Rabs (x "gamma") + Rabs (x "d") * Rabs (x "d") * Rabs (x "lambda_")
    + Rabs (x "u_8") * (Rabs (x "gamma") * Rabs (x "gamma") + Rabs (x "d") * Rabs (x "d") * Rabs (x "lambda_")))) in H.
  rewrite (Rabs_pos_eq (x "gamma")), (Rabs_pos_eq (x "d")), (Rabs_pos_eq (x "lambda_")), (Rabs_pos_eq (x "u_8")) in H by (rewrite ?U8, ?unit_is, ?slack_is; lra); fold s t in H.
  assert (G : growth u 5 <= 6 * u) by (apply Rle_trans with ((INR 5 + 1) * u); [apply growth_is_small; [exact U | rewrite u_is; simpl; lra] | apply Rmult_le_compat_r; [lra | simpl; lra]]).
  assert (V : 0 <= s + t + x "u_8" * (s + t)) by (rewrite U8, unit_is, slack_is; assert (0 <= s + t) by (pose proof (bpow_gt_0 radix2 (-200)); lra); lra).
  assert (H' : growth u 5 * (s + t + x "u_8" * (s + t)) <= 6 * u * (s + t + x "u_8" * (s + t))) by (apply Rmult_le_compat_r; assumption).
  assert (W : pow (-1021) <= u * s).
  { apply Rle_trans with (pow (-52 + -200)); [apply at_most; lia | rewrite powers; apply Rmult_le_compat_l; [apply bpow_ge_0 | exact S1]]. }
  pose proof (Rle_abs (w - (s - t - x "u_8" * (s + t)))); pose proof (Rle_abs (x "gap_least" - w)); rewrite U8, unit_is, slack_is, u_is in *; lra.
Qed.

Let tree_across := Add (Mul (Input 0) (Input 0)) (Mul (Mul (Input 2) (Input 2)) (Input 4)).
Let tree_K := Mul (Input 6) (Div (Mul tree_across (Add (Whole 1) (Input 4))) (Input 4)).
Let tree_M := Mul (Input 6) (Div tree_across (Input 7)).

(** **The line that is made proves**: what it says is said by a multiplier, with the margin on its safe side. *)
Theorem beyond_has_margin : pow (-300) <= x "K_most" <= pow 400 /\ 0 <= x "M_most" <= pow 400 /\ 0 < x "lambda_" < B
  /\ beyond_K (x "alpha") (x "b") (x "lambda_") <= (1 - 8 * u) * x "K_most" /\ beyond_M (x "alpha") (x "gamma") (x "b") (x "d") (x "lambda_") <= (1 - 8 * u) * x "M_most".
Proof.
  destruct asked as (L0 & G0 & K0 & M0); pose proof gap_is_less as GL.
  pose proof (Sizes "alpha" ltac:(cbn; tauto)) as Ha; pose proof (Sizes "gamma" ltac:(cbn; tauto)) as Hg; pose proof (Sizes "b" ltac:(cbn; tauto)) as Hb;
    pose proof (Sizes "d" ltac:(cbn; tauto)) as Hd; pose proof (bpow_gt_0 radix2 (-100)) as W.
  set (a := x "alpha") in *; set (c := x "gamma") in *; set (b := x "b") in *; set (d := x "d") in *; set (l := x "lambda_") in *.
  set (gap := c * c - d * d * l) in *; set (across := a * a + b * b * l).
  assert (gap0 : 0 < gap) by lra; assert (across0 : 0 < across) by (unfold across; pose proof (Rmult_lt_0_compat a a ltac:(lra) ltac:(lra)); pose proof (Rmult_lt_0_compat (b * b) l ltac:(apply Rmult_lt_0_compat; lra) L0); lra).
  assert (dd : 0 < d * d) by (apply Rmult_lt_0_compat; lra).
  assert (LB : l < B).
  { unfold B; fold c d; apply Rmult_lt_reg_l with (d * d); [exact dd |]; replace (d * d * (c / d) ^ 2) with (c * c) by (field; lra); unfold gap in gap0; lra. }
  assert (more : x "more" = 1 + 32 * unit) by (apply Constants, look_in; reflexivity).
  assert (KE : beyond_K a b l = across * (1 + l) / l) by (unfold beyond_K, across; field; lra).
  assert (ME : beyond_M a c b d l = across / gap).
  { unfold beyond_M, across; fold B; unfold B in LB |- *; fold c d in LB |- *; unfold gap in gap0 |- *; field; repeat split; try lra. }
  assert (K1 : 0 <= beyond_K a b l) by (rewrite KE; left; apply Rdiv_lt_0_compat; [apply Rmult_lt_0_compat |]; lra).
  assert (M1 : 0 <= beyond_M a c b d l) by (rewrite ME; left; apply Rdiv_lt_0_compat; assumption).
  assert (margin : forall v w f, 0 <= v -> v <= w -> 1 - 8 * u <= f -> v <= (1 - 8 * u) * (x "more" * w * f)).
  { intros v w f V VW F; apply Rle_trans with ((1 - 8 * u) * (x "more" * v * (1 - 8 * u))).
    - rewrite more, unit_is, u_is; assert (1 <= (1 - 8 * / 4503599627370496) * ((1 + 32 * / 4503599627370496) * (1 - 8 * / 4503599627370496))) by lra.
      pose proof (Rmult_le_compat_l v _ _ V H); lra.
    - apply Rmult_le_compat_l; [rewrite u_is; lra |]; apply Rmult_le_compat; [| rewrite u_is; lra | apply Rmult_le_compat_l |exact F]; try (rewrite more, unit_is; try apply Rmult_le_pos); lra. }
  assert (positive_across : RunningBound.positive env tree_across) by (cbn; fold a b l; repeat split; left; repeat split; try left; repeat split; lra).
  split; [split; [exact K0 | exact Low] |]; split; [split; [| exact M0] |]; [| split; [split; [exact L0 | exact LB] |]].
  - destruct (all_known "M_most" _ eq_refl) as [(_ & P & _) _]; apply P; reflexivity.
  - split.
    + destruct (computed [("alpha", 0); ("gamma", 1); ("b", 2); ("d", 3); ("lambda_", 4); ("u_8", 5); ("more", 6)]%nat "K_most" (Cell tree_K None true)) as (w & C & D);
        [intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity | vm_compute; reflexivity |].
      cbn [tree loss loses] in C, D; assert (P : RunningBound.positive env tree_K).
      { unfold tree_K; cbn [RunningBound.positive]; left; split; [cbn; rewrite more, unit_is; lra |]; repeat split; [left; split; [exact positive_across | cbn; fold l; repeat split; lra] | cbn; fold l; lra | cbn; fold l; lra]. }
      destruct (positive_factor u exact_inputs env tree_K w U P C) as (f & F & EQ); replace (x "K_most") with w by lra; rewrite EQ.
      change (value env tree_K) with (x "more" * (across * (1 + l) / l)); apply margin; [exact K1 | rewrite KE; lra |].
      refine (few _ f _ F); vm_compute; lia.
    + destruct (computed [("alpha", 0); ("gamma", 1); ("b", 2); ("d", 3); ("lambda_", 4); ("u_8", 5); ("more", 6); ("gap_least", 7)]%nat "M_most" (Cell tree_M None true)) as (w & C & D);
        [intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity | vm_compute; reflexivity |].
      cbn [tree loss loses] in C, D; assert (P : RunningBound.positive env tree_M).
      { unfold tree_M; cbn [RunningBound.positive]; left; split; [cbn; rewrite more, unit_is; lra | split; [exact positive_across | split; [cbn; lra | cbn; exact G0]]]. }
      destruct (positive_factor u exact_inputs env tree_M w U P C) as (f & F & EQ); replace (x "M_most") with w by lra; rewrite EQ.
      change (value env tree_M) with (x "more" * (across / x "gap_least")); apply margin; [exact M1 | rewrite ME |].
      * unfold Rdiv; apply Rmult_le_compat_l; [lra |]; apply Rinv_le_contravar; lra.
      * refine (few _ f _ F); vm_compute; lia.
Qed.
End Low.

(** ** **What the C answers beyond such a line is the position.** *)

Section Row.

Variables (l : list step) (y pre_y : string -> R) (n : string).
Hypotheses (Steps : Forall (runs StageOne.multiplied y pre_y) l) (Cap : y "R_plus_T" < pow 400) (Place : StageOne.place l) (Line : StageOne.line l n)
  (K_is : y ("K_" ++ n)%string = x "K_most") (M_is : y ("M_" ++ n)%string = x "M_most").

Theorem made_line_is_beyond : x "K_most" <= pow 400 -> StageOne.beyond l y (x "alpha") (x "gamma") (x "b") (x "d") n.
Proof.
  intros Low; destruct (beyond_has_margin Low) as (K & M & L & HK & HM); unfold StageOne.beyond, StageOne.usable; rewrite K_is, M_is.
  split; [exact Line |]; split; [auto |]; exists (x "lambda_"); auto.
Qed.

Theorem beyond_made_line_is_exterior : y ("line_" ++ n) < y "R" -> exterior (upright (x "alpha") (x "gamma") (x "b") (x "d") (y "x") (y "y") (y "z")).
Proof.
  intros H; assert (size : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < x n) by (intros m I; pose proof (Sizes m I); pose proof (bpow_gt_0 radix2 (-100)); lra).
  destruct (Rle_or_lt (x "K_most") (pow 400)) as [Low | High].
  - apply (StageOne.exterior_beyond l y pre_y (x "alpha") (x "gamma") (x "b") (x "d") Steps Cap) with (n := n); try (apply size; cbn; tauto); [exact Place | apply made_line_is_beyond; exact Low | exact H].
  - exfalso; destruct Place as (_ & _ & P3 & P4 & P5 & _), Line as (L1 & L2 & L3).
    destruct (StageOne.product_of l y pre_y Steps _ _ _ P4) as [ET RT]; destruct (StageOne.product_of l y pre_y Steps _ _ _ L1) as [ER RR].
    destruct (StageOne.sum_of l y pre_y Steps _ _ _ P5) as (r & t & Tr & Tt & VS); destruct (StageOne.sum_of l y pre_y Steps _ _ _ L2) as (k & i & Tk & Ti & VL).
    assert (r = y "R") by (destruct Tr as [-> | [N _]]; [reflexivity | discriminate N]); subst r.
    assert (k = x "K_most") by (destruct Tk as [-> | [N _]]; [exact K_is | rewrite L3 in N; discriminate N]); subst k.
    assert (T0 : 0 <= pre_y "T") by (rewrite ET; pose proof (pow2_ge_0 (y "z")); lra); pose proof (proj1 (stays_signed _ _ RT) T0) as T1.
    assert (t0 : 0 <= t) by (destruct Tt as [-> | [_ ->]]; assumption).
    destruct asked as (_ & G0 & _ & _).
    assert (M0 : 0 <= x "M_most").
    { destruct (product_of "M_most" _ _ by_search) as [Em Rm]; destruct (quotient_of "M" _ _ by_search) as [E R'].
      apply (stays_signed _ _ Rm); rewrite Em; apply Rmult_le_pos; [rewrite (Constants "more" (1 + 32 * unit)) by (apply look_in; reflexivity); unfold unit; simpl; lra |].
      apply (stays_signed _ _ R'); rewrite E; apply over_pos; [| exact G0]; destruct (sum_of "across" _ _ by_search) as [(a & c & Ta & Tc & Ea) Ra].
      destruct (product_of "p" _ _ by_search) as [Ep Rp]; destruct (product_of "q_lambda" _ _ by_search) as [Eq Rq]; destruct (product_of "q" _ _ by_search) as [Eqq Rqq].
      assert (Q0 : 0 <= x "q") by (apply (stays_signed _ _ Rqq); rewrite Eqq; pose proof (pow2_ge_0 (x "b")); lra).
      assert (P0 : 0 <= pre "p") by (rewrite Ep; pose proof (pow2_ge_0 (x "alpha")); lra).
      destruct asked as (L0 & _); assert (Q1 : 0 <= pre "q_lambda") by (rewrite Eq; apply Rmult_le_pos; lra).
      apply (stays_signed _ _ Ra); rewrite Ea; pose proof (proj1 (stays_signed _ _ Rp) P0); pose proof (proj1 (stays_signed _ _ Rq) Q1); destruct Ta as [-> | ->], Tc as [-> | ->]; lra. }
    assert (R0 : 0 <= pre_y ("rise_" ++ n)%string) by (rewrite ER, M_is; apply Rmult_le_pos; assumption); pose proof (proj1 (stays_signed _ _ RR) R0).
    assert (i0 : 0 <= i) by (destruct Ti as [-> | [_ ->]]; assumption).
    pose proof (stays_high _ _ 400 VL ltac:(lia) ltac:(lra)) as LH.
    pose proof (below _ _ 400 VS ltac:(pose proof (bpow_gt_0 radix2 400); lra) ltac:(lia) Cap); lra.
Qed.

End Row.
End Beyond.
