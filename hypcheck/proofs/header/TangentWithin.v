(** The half plane of a tangent within from its C: the line that hc_tangent_within makes has the margin that StageOne.v asks for.

    As in TangentRuns.v, of which this is the other side: the position within such a line is interior. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Flocq Require Import Core.
From Hypcheck Require Import Geometry HalfPlanes Rounding Floats Steps FixedRuns Kernel RunningBound Ranges Underflow FloatTexts TangentTexts TangentRuns.
From Hypcheck Require StageTwoRuns StageOne.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Definition multiplied := Eval vm_compute in names_of (fun k => match k with Times | Negated => true | _ => false end) C_within.
Definition floats := Eval vm_compute in names_of (fun k => match k with Plus | Minus | Times | Over => true | _ => false end) C_within.
Definition given_sizes := [("alpha", between (-100) 100); ("gamma", between (-100) 100); ("b", between (-100) 100); ("d", between (-100) 100);
  ("mu", between 0 401); ("u_8", between (-49) (-48)); ("less", between (-1) 0)].
Definition guarded_more := ([("across_least", between (-304) 603); ("mu_minus_one", between (-906) 402); ("product", between (-302) 1005)] ++ given_sizes)%list.
Definition known := Eval vm_compute in match Ranges.sizes guarded_more C_within with Some t => t | None => [] end.
Definition before_least := firstn 7 C_within.
Definition known_before := Eval vm_compute in match Ranges.sizes given_sizes before_least with Some t => t | None => [] end.
Lemma known_is_reached : Ranges.sizes guarded_more C_within = Some known /\ Ranges.sizes given_sizes before_least = Some known_before.
Proof. vm_compute; auto. Qed.

Local Notation by_search := ltac:(vm_compute; reflexivity) (only parsing).
Notation u := unit_of_any_mode.

Section Within.

Variables (x pre : string -> R) (greater at_least : argument -> argument -> bool).
Definition constants := [("u_8", 8 * unit * slack); ("less", 1 - 32 * unit); ("least_constant", pow (-300)); ("greatest_slope", pow 400)].
Hypotheses (Runs : Forall (runs multiplied x pre) C_within)
  (More : forall a c p q, greater a c = true -> has x a p -> has x c q -> q < p) (Least : forall a c p q, at_least a c = true -> has x a p -> has x c q -> q <= p)
  (Constants : forall n v, In (n, v) constants -> x n = v) (Inputs : forall n, In n ["alpha"; "gamma"; "b"; "d"; "mu"; "u_8"; "less"] -> pre n = x n)
  (Sizes : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> pow (-100) < x n < pow 100)
  (Proves : proves_within greater at_least = true).

Definition step_of n := find (fun s => String.eqb (name s) n) C_within.
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

Lemma asked : 1 < x "mu" /\ 0 < x "across_least" /\ pow (-300) <= x "K_least" /\ x "M_least" <= pow 400.
Proof.
  pose proof Proves as P; unfold proves_within in P; apply andb_prop in P as [P P4]; apply andb_prop in P as [P P3]; apply andb_prop in P as [P1 P2].
  assert (L : x "least_constant" = pow (-300)) by (apply Constants, look_in; reflexivity); assert (G : x "greatest_slope" = pow 400) by (apply Constants, look_in; reflexivity).
  rewrite <- L, <- G; repeat split; [apply (More _ _ _ _ P1) | apply (More _ _ _ _ P2) | apply (Least _ _ _ _ P3) | apply (Least _ _ _ _ P4)]; reflexivity.
Qed.
Let less_is : / 2 <= x "less" <= 1.
Proof. rewrite (Constants "less" (1 - 32 * unit)) by (apply look_in; reflexivity); unfold unit; simpl; lra. Qed.

(** mu is bounded by what is left across. *)
Lemma mu_in_range : x "mu" <= pow 401.
Proof.
  destruct asked as (L0 & G0 & _ & _).
  pose proof (Sizes "alpha" ltac:(cbn; tauto)) as Ha; pose proof (Sizes "b" ltac:(cbn; tauto)) as Hb; pose proof (bpow_gt_0 radix2 (-100)) as W100; pose proof (bpow_gt_0 radix2 (-200)) as W200.
  destruct (product_of "p" _ _ by_search) as [Ep Rp]; destruct (product_of "q" _ _ by_search) as [Eq Rq]; destruct (product_of "q_mu" _ _ by_search) as [Eqm Rqm].
  assert (P1 : 0 <= pre "p" <= pow 200).
  { rewrite Ep; split; [apply Rmult_le_pos; lra |]; change 200%Z with (100 + 100)%Z; rewrite powers; apply Rmult_le_compat; lra. }
  assert (P2 : 0 <= x "p" <= pow 200) by (split; [apply (stays_signed _ _ Rp); lra | apply no_more with (pre "p"); [exact Rp | lra | lia | lra]]).
  assert (Q1 : pow (-200) <= x "q") by (apply stays_high with (pre "q"); [exact Rq | lia | rewrite Eq; apply (product_high (-100) (-100)); lra]).
  assert (QM : 0 <= pre "q_mu") by (rewrite Eqm; apply Rmult_le_pos; lra); pose proof (proj1 (stays_signed _ _ Rqm) QM) as QM'.
  destruct (sum_of "across_terms" _ _ by_search) as [(p1 & q1 & Tp1 & Tq1 & Et) Rt].
  assert (T0 : 0 <= x "across_terms") by (apply (stays_signed _ _ Rt); rewrite Et; destruct Tp1 as [-> | ->], Tq1 as [-> | ->]; lra).
  destruct (product_of "across_error" _ _ by_search) as [Ee Re].
  assert (U8 : 0 <= x "u_8") by (rewrite (Constants "u_8" (8 * unit * slack)) by (apply look_in; reflexivity); unfold unit, slack; simpl; lra).
  assert (E0 : 0 <= pre "across_error") by (rewrite Ee; apply Rmult_le_pos; assumption); pose proof (proj1 (stays_signed _ _ Re) E0) as E0'.
  destruct (runs_of "across_least" _ by_search) as (g & e & Tg & Te & El & Rl); cbn [takes name] in Tg, Te, El, Rl; pose proof (proj2 (stays_signed _ _ Rl) G0) as L1.
  destruct Tg as [-> | [N _]]; [| discriminate N].
  assert (e0 : 0 <= e) by (destruct Te as [-> | [_ ->]]; assumption).
  destruct (difference_of "across" _ _ by_search) as [(p2 & q2 & Tp2 & Tq2 & Ea) Ra]; pose proof (proj2 (stays_signed _ _ Ra) ltac:(lra)) as A0.
  assert (QB : pre "q_mu" < pow 201).
  { pose proof (bpow_lt radix2 200 201 ltac:(lia)); assert (p2 <= pow 200) by (destruct Tp2 as [-> | ->]; lra).
    destruct Tq2 as [-> | ->]; [apply (below _ _ 201 Rqm QM ltac:(lia)); lra | lra]. }
  apply Rmult_le_reg_l with (pow (-200)); [exact W200 |]; rewrite <- powers; change (-200 + 401)%Z with 201%Z.
  apply Rle_trans with (x "q" * x "mu"); [apply Rmult_le_compat_r; lra | lra].
Qed.

Let between_is l h v : pow l <= v <= pow h -> within (between l h) v.
Proof. intros [L H]; pose proof (bpow_gt_0 radix2 l); repeat split; cbn; [rewrite Rabs_pos_eq | |]; lra. Qed.
Let constant n v : In (n, v) constants -> In n ["u_8"; "less"] -> x n = v /\ pre n = v.
Proof. intros I J; split; [apply Constants; exact I |]; rewrite Inputs; [apply Constants; exact I | cbn [In] in J |- *; tauto]. Qed.

Lemma sizes_given : all_hold x pre given_sizes.
Proof.
  destruct asked as (L0 & _); pose proof mu_in_range as L; intros n s H; unfold given_sizes in H; cbn [look] in H.
  repeat match type of H with (if String.eqb ?a n then Some ?t else _) = Some s => destruct (String.eqb_spec a n) as [<- | _]; [injection H as <- |] end; [.. | discriminate].
  1-4: rewrite Inputs by (cbn; tauto); match goal with |- within _ (x ?n) /\ _ => pose proof (Sizes n ltac:(cbn; tauto)) end; split; apply between_is; lra.
  - rewrite Inputs by (cbn; tauto); split; apply between_is; change (pow 0) with 1; lra.
  - destruct (constant "u_8" (8 * unit * slack)) as [-> ->]; [apply look_in; reflexivity | cbn; tauto |]; unfold unit, slack; split; apply between_is; simpl; lra.
  - destruct (constant "less" (1 - 32 * unit)) as [-> ->]; [apply look_in; reflexivity | cbn; tauto |]; unfold unit; split; apply between_is; simpl; lra.
Qed.

(** What the constant says of its factors. *)
Lemma factors_in_range : (pow (-304) <= x "across_least" <= pow 603 /\ pow (-304) <= pre "across_least" <= pow 603)
  /\ (pow (-906) <= x "mu_minus_one" <= pow 402 /\ pow (-906) <= pre "mu_minus_one" <= pow 402) /\ (pow (-302) <= x "product" <= pow 1005 /\ pow (-302) <= pre "product" <= pow 1005)
  /\ x "mu_minus_one" <= x "mu" * (1 + u) /\ (x "mu" - 1) * (1 - u) <= x "mu_minus_one" <= (x "mu" - 1) * (1 + u).
Proof.
  destruct asked as (L0 & G0 & K0 & _); pose proof mu_in_range as L; destruct known_is_reached as [_ R2].
  assert (F : Forall (runs multiplied x pre) before_least) by (apply Forall_forall; intros s I; apply (proj1 (Forall_forall _ _) Runs); revert I; unfold before_least; rewrite <- (firstn_skipn 7 C_within) at 2; intros I; apply in_or_app; auto).
  destruct (sizes_hold multiplied x pre before_least given_sizes known_before sizes_given F R2 "across_least" _ eq_refl) as [(H1 & _) (H2 & _)]; cbn [high] in H1, H2.
  pose proof (Rle_abs (x "across_least")); pose proof (Rle_abs (pre "across_least")).
  destruct (runs_of "mu_minus_one" _ by_search) as (m & o & Tm & To & Em & Rm); cbn [takes name] in Tm, To, Em, Rm; destruct Tm as [-> | [N _]]; [| discriminate N]; subst o.
  assert (M0 : 0 < pre "mu_minus_one") by lra; pose proof (proj1 (stays_signed _ _ Rm) ltac:(lra)) as M1.
  destruct (product_of "product" _ _ by_search) as [Ep Rp]; destruct (quotient_of "K" _ _ by_search) as [Ek Rk]; destruct (product_of "K_least" _ _ by_search) as [El Rl].
  assert (P0 : 0 <= pre "product") by (rewrite Ep; apply Rmult_le_pos; lra); pose proof (proj1 (stays_signed _ _ Rp) P0) as P1.
  assert (k0 : 0 <= pre "K") by (rewrite Ek; apply over_pos; lra); pose proof (proj1 (stays_signed _ _ Rk) k0) as k1.
  pose proof (bpow_lt radix2 (-301) (-300) ltac:(lia)) as W.
  pose proof (above _ _ (-301) Rl ltac:(rewrite El; apply Rmult_le_pos; lra) ltac:(lia) ltac:(lra)) as KL; rewrite El in KL.
  assert (KX : pow (-301) < x "K") by (assert (x "less" * x "K" <= 1 * x "K") by (apply Rmult_le_compat_r; lra); lra).
  pose proof (above _ _ (-301) Rk k0 ltac:(lia) KX) as KP; rewrite Ek in KP.
  assert (PX : x "mu" * pow (-301) < x "product").
  { apply Rmult_lt_reg_r with (/ x "mu"); [apply Rinv_0_lt_compat; lra |]; apply Rle_lt_trans with (pow (-301)); [right; field; lra | exact KP]. }
  (* the rounding of mu - 1 and of the product *)
  assert (U : 0 < u <= / 1024) by (unfold unit_of_any_mode; simpl; lra).
  assert (MP : x "mu" * pow (-302) <= pre "product").
  { assert (R : Rabs (pre "product") <= pow 1023 \/ pow 1023 < pre "product") by (rewrite Rabs_pos_eq by exact P0; destruct (Rle_or_lt (pre "product") (pow 1023)); auto).
    pose proof (Rmult_le_compat_r (pow (-302)) _ _ (bpow_ge_0 radix2 (-302)) L) as ML; rewrite <- powers in ML; change (401 + -302)%Z with 99%Z in ML.
    destruct R as [R | R]; [| pose proof (bpow_lt radix2 99 1023 ltac:(lia)); lra].
    destruct (rounding_loses _ _ Rp R) as (t & T & D & _); pose proof (Rle_abs t); pose proof (Rle_abs (x "product" - pre "product" * (1 + t))).
    pose proof (Ranges.double (-302)) as DD; change (-302 + 1)%Z with (-301)%Z in DD; rewrite <- DD in PX.
    assert (SM : pow (-1022) <= / 4 * pow (-302)) by (change (/ 4) with (pow (-2)); rewrite <- powers; apply at_most; lia).
    assert (mu1 : pow (-302) <= x "mu" * pow (-302)) by (pose proof (Rmult_le_compat_r (pow (-302)) 1 (x "mu") (bpow_ge_0 radix2 (-302)) ltac:(lra)); lra).
    assert (pre "product" * (1 + t) <= pre "product" * (1 + / 1024)) by (apply Rmult_le_compat_l; lra); lra. }
  assert (mu0 : pow (-302) <= x "mu" * pow (-302)) by (pose proof (Rmult_le_compat_r (pow (-302)) 1 (x "mu") (bpow_ge_0 radix2 (-302)) ltac:(lra)); lra).
  assert (ML : pow (-905) <= x "mu_minus_one").
  { apply Rmult_le_reg_l with (pow 603); [apply bpow_gt_0 |]; rewrite <- powers; change (603 + -905)%Z with (-302)%Z.
    apply Rle_trans with (pre "product"); [lra |]; rewrite Ep; apply Rmult_le_compat_r; lra. }
  pose proof (bpow_lt radix2 (-906) (-905) ltac:(lia)); pose proof (above _ _ (-906) Rm ltac:(lra) ltac:(lia) ltac:(lra)) as MPre.
  pose proof (bpow_lt radix2 401 402 ltac:(lia)); pose proof (bpow_lt radix2 402 1023 ltac:(lia)); pose proof (bpow_lt radix2 (-1022) (-906) ltac:(lia)).
  destruct (rounding_loses _ _ Rm ltac:(rewrite Rabs_pos_eq; lra)) as (t & T & _ & EQ); specialize (EQ ltac:(rewrite Rabs_pos_eq; lra)).
  pose proof (Rle_abs t); pose proof (Rle_abs (- t)) as T'; rewrite Rabs_Ropp in T'.
  assert (B1 : (x "mu" - 1) * (1 - u) <= x "mu_minus_one") by (rewrite EQ, Em; apply Rmult_le_compat_l; lra).
  assert (B2 : x "mu_minus_one" <= (x "mu" - 1) * (1 + u)) by (rewrite EQ, Em; apply Rmult_le_compat_l; lra).
  assert (B3 : x "mu_minus_one" <= x "mu" * (1 + u)) by lra.
  assert (AL : pow (-303) <= x "across_least").
  { apply Rmult_le_reg_r with (x "mu" * (1 + u)); [apply Rmult_lt_0_compat; lra |]; apply Rle_trans with (x "mu" * pow (-302)).
    - pose proof (Ranges.double (-303)) as DD; change (-303 + 1)%Z with (-302)%Z in DD; rewrite <- DD; pose proof (bpow_gt_0 radix2 (-303)); assert (pow (-303) * x "mu" * (1 + u) <= pow (-303) * x "mu" * 2) by (apply Rmult_le_compat_l; [apply Rmult_le_pos |]; lra); lra.
    - apply Rle_trans with (1 := MP); rewrite Ep; apply Rmult_le_compat_l; lra. }
  destruct (runs_of "across_least" _ by_search) as (g & e & _ & _ & _ & Ra); cbn [name] in Ra.
  pose proof (bpow_lt radix2 (-304) (-303) ltac:(lia)); pose proof (above _ _ (-304) Ra ltac:(left; apply (stays_signed _ _ Ra); exact G0) ltac:(lia) ltac:(lra)) as AP.
  pose proof (Ranges.double 401) as D4; change (401 + 1)%Z with 402%Z in D4; assert (x "mu" * (1 + u) <= x "mu" * 2) by (apply Rmult_le_compat_l; lra).
  assert (PH : pre "product" <= pow 1005) by (rewrite Ep; change 1005%Z with (603 + 402)%Z; rewrite powers; apply Rmult_le_compat; lra).
  pose proof (no_more _ _ 1005 Rp P0 ltac:(lia) PH); pose proof (stays_high _ _ (-302) Rp ltac:(lia) ltac:(lra)); repeat split; lra.
Qed.

Lemma all_known : all_hold x pre known.
Proof.
  destruct known_is_reached as [R1 _]; destruct factors_in_range as (A & M & P & _).
  apply (sizes_hold multiplied x pre C_within guarded_more known); [| exact Runs | exact R1].
  intros n s H'; unfold guarded_more in H'; cbn [app look] in H'.
  destruct (String.eqb_spec "across_least" n) as [<- | _]; [injection H' as <-; split; apply between_is; apply A |].
  destruct (String.eqb_spec "mu_minus_one" n) as [<- | _]; [injection H' as <-; split; apply between_is; apply M |].
  destruct (String.eqb_spec "product" n) as [<- | _]; [injection H' as <-; split; apply between_is; apply P |].
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
  apply (returned_float (pre n)); [| lra]; clear - I Runs; change floats with (names_of (fun k => match k with Plus | Minus | Times | Over => true | _ => false end) C_within) in I.
  unfold names_of in I; apply in_map_iff in I as (s & <- & I); apply filter_In in I as [I E]; pose proof (proj1 (Forall_forall _ _) Runs s I) as H.
  unfold runs in H; destruct (kind_of s) as [[] |]; try discriminate; destruct (arguments (meaning s)) as [| a [| c [|]]]; try contradiction;
    destruct H as (p & q & _ & _ & _ & H); exact H.
Qed.

(** ** The margin. *)

Let env k := nth k (map x ["alpha"; "gamma"; "b"; "d"; "mu"; "u_8"; "less"; "across_least"; "mu_minus_one"]) 0.
Let stands_given l : (forall n k, In (n, k) l -> env k = x n) -> all_stand multiplied x pre exact_inputs env (StageTwoRuns.given_as l).
Proof.
  intros H n c E; apply look_in in E; unfold StageTwoRuns.given_as in E; apply in_map_iff in E as ([m k] & E & I); injection E as <- <-; cbn [fst snd].
  split; [| discriminate]; exists (env k * 1); split; [apply c_input | cbn [tree loss loses]; rewrite (H m k I); ring].
  assert (U : 0 <= u < 1) by (unfold unit_of_any_mode; simpl; lra); apply factor_1; exact U.
Qed.
Let computed l n c : (forall n k, In (n, k) l -> env k = x n) -> look n (cells multiplied floats known (StageTwoRuns.given_as l) C_within) = Some c ->
  exists w, computes u exact_inputs env (tree c) w /\ loses (loss c) (x n - w).
Proof.
  intros H E; apply (cells_stand multiplied floats x pre exact_inputs env all_float known C_within _ all_known known_high Runs (stands_given l H) n c E).
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


Definition row_names := [("alpha", 0); ("gamma", 1); ("b", 2); ("d", 3); ("mu", 4); ("u_8", 5); ("less", 6)]%nat.

Let few_above k f : (k <= 8)%nat -> factor u k f -> 0 < f /\ f * (1 - 8 * u) <= 1.
Proof.
  intros L F; pose proof (few k f L F); destruct F as [F1 F2]; split; [rewrite u_is in *; lra |].
  pose proof (bernoulli u k ltac:(lra)) as B; apply le_INR in L; rewrite (INR_IZR_INZ 8) in L; simpl in L; pose proof (pos_INR k) as P0.
  assert (INR k * u <= 8 * u) by (apply Rmult_le_compat_r; lra); assert (P : 0 < (1 - u) ^ k) by (apply pow_lt; lra).
  apply Rle_trans with (f * (1 - u) ^ k); [apply Rmult_le_compat_l; [rewrite u_is in *; lra | lra] |].
  apply Rle_trans with (/ (1 - u) ^ k * (1 - u) ^ k); [apply Rmult_le_compat_r; lra | rewrite Rinv_l; lra].
Qed.
Let A := (x "alpha" / x "b") ^ 2.

(** What is left across by the computation is no more than what is. *)
Lemma across_is_less : x "across_least" <= x "alpha" * x "alpha" - x "b" * x "b" * x "mu".
Proof.
  destruct (computed row_names "across_least"
    (Cell (Sub (Sub (Mul (Input 0) (Input 0)) (Mul (Mul (Input 2) (Input 2)) (Input 4))) (Mul (Input 5) (Add (Mul (Input 0) (Input 0)) (Mul (Mul (Input 2) (Input 2)) (Input 4)))))
      (Some (-1021)%Z) true)) as (w & C & D); [intros n k I; cbn [row_names In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity | vm_compute; reflexivity |].
  cbn [tree loss loses] in C, D; pose proof (fun V => error_bound u exact_inputs env U _ w V C) as H; specialize (H ltac:(cbn; tauto)).
  set (s := x "alpha" * x "alpha") in *; set (t := x "b" * x "b" * x "mu") in *.
  destruct asked as (L0 & _); pose proof (Sizes "alpha" ltac:(cbn; tauto)) as Hg; pose proof (Sizes "b" ltac:(cbn; tauto)) as Hd; pose proof (bpow_gt_0 radix2 (-100)).
  assert (S1 : pow (-200) <= s) by (apply (product_high (-100) (-100)); lra); assert (T0 : 0 <= t) by (unfold t; repeat apply Rmult_le_pos; lra).
  assert (U8 : x "u_8" = 8 * unit * slack) by (apply Constants, look_in; reflexivity).
  change (Rabs (w - (s - t - x "u_8" * (s + t))) <= growth u 5 * (Rabs (x "alpha") * Rabs (x "alpha") + Rabs (x "b") * Rabs (x "b") * Rabs (x "mu")
    + Rabs (x "u_8") * (Rabs (x "alpha") * Rabs (x "alpha") + Rabs (x "b") * Rabs (x "b") * Rabs (x "mu")))) in H.
  rewrite (Rabs_pos_eq (x "alpha")), (Rabs_pos_eq (x "b")), (Rabs_pos_eq (x "mu")), (Rabs_pos_eq (x "u_8")) in H by (rewrite ?U8, ?unit_is, ?slack_is; lra); fold s t in H.
  assert (G : growth u 5 <= 6 * u) by (apply Rle_trans with ((INR 5 + 1) * u); [apply growth_is_small; [exact U | rewrite u_is; simpl; lra] | apply Rmult_le_compat_r; [lra | simpl; lra]]).
  assert (V : 0 <= s + t + x "u_8" * (s + t)) by (rewrite U8, unit_is, slack_is; assert (0 <= s + t) by (pose proof (bpow_gt_0 radix2 (-200)); lra); lra).
  assert (H' : growth u 5 * (s + t + x "u_8" * (s + t)) <= 6 * u * (s + t + x "u_8" * (s + t))) by (apply Rmult_le_compat_r; assumption).
  assert (W : pow (-1021) <= u * s).
  { apply Rle_trans with (pow (-52 + -200)); [apply at_most; lia | rewrite powers; apply Rmult_le_compat_l; [apply bpow_ge_0 | exact S1]]. }
  pose proof (Rle_abs (w - (s - t - x "u_8" * (s + t)))); pose proof (Rle_abs (x "across_least" - w)); rewrite U8, unit_is, slack_is, u_is in *; lra.
Qed.

Let tree_K := Mul (Input 6) (Div (Mul (Input 7) (Input 8)) (Input 4)).
Let tree_M := Mul (Input 6) (Div (Input 7) (Add (Mul (Input 1) (Input 1)) (Mul (Mul (Input 3) (Input 3)) (Input 4)))).
Definition all_names := (row_names ++ [("across_least", 7); ("mu_minus_one", 8)]%nat)%list.

(** **The line that is made proves**: what it says is said by a multiplier, with the margin on its safe side. *)
Theorem within_has_margin : pow (-300) <= x "K_least" <= pow 400 /\ 0 <= x "M_least" <= pow 400 /\ 0 < x "mu" < A
  /\ (1 + 9 * u) * x "K_least" <= within_K (x "alpha") (x "b") (x "mu") /\ (1 + 9 * u) * x "M_least" <= within_M (x "alpha") (x "gamma") (x "b") (x "d") (x "mu").
Proof.
  destruct asked as (L0 & G0 & K0 & M0); pose proof across_is_less as GL; destruct factors_in_range as (_ & _ & _ & _ & B1 & B2).
  pose proof (Sizes "alpha" ltac:(cbn; tauto)) as Ha; pose proof (Sizes "gamma" ltac:(cbn; tauto)) as Hg; pose proof (Sizes "b" ltac:(cbn; tauto)) as Hb;
    pose proof (Sizes "d" ltac:(cbn; tauto)) as Hd; pose proof (bpow_gt_0 radix2 (-100)) as W.
  set (a := x "alpha") in *; set (c := x "gamma") in *; set (b := x "b") in *; set (d := x "d") in *; set (m := x "mu") in *.
  set (across := a * a - b * b * m) in *; set (along := c * c + d * d * m).
  assert (bb : 0 < b * b) by (apply Rmult_lt_0_compat; lra); assert (dd : 0 < d * d * m) by (repeat apply Rmult_lt_0_compat; lra).
  assert (cc : 0 < c * c) by (apply Rmult_lt_0_compat; lra).
  assert (MA : m < A).
  { unfold A; fold a b; apply Rmult_lt_reg_l with (b * b); [exact bb |]; replace (b * b * (a / b) ^ 2) with (a * a) by (field; lra); unfold across in GL; lra. }
  assert (less : x "less" = 1 - 32 * unit) by (apply Constants, look_in; reflexivity).
  assert (KE : within_K a b m = across * ((m - 1) / m)) by (unfold within_K, across; field; lra).
  assert (ME : within_M a c b d m = across / along).
  { unfold within_M, across, along; field; repeat split; try lra; replace (c ^ 2 + m * d ^ 2) with (c * c + d * d * m) by ring; lra. }
  assert (margin : forall v w f, 0 <= w -> w <= v * (1 + u) -> 0 < f -> f * (1 - 8 * u) <= 1 -> (1 + 9 * u) * (x "less" * w * f) <= v).
  { intros v w f W0 VW F0 F; assert (V0 : 0 <= v) by (rewrite u_is in VW; lra); rewrite less, unit_is; rewrite u_is in *.
    assert (E : (1 + 9 * / 4503599627370496) * (1 - 32 * / 4503599627370496) * (1 + / 4503599627370496) <= 1 - 8 * / 4503599627370496) by lra.
    assert (w * f <= v * (1 + / 4503599627370496) * f) by (apply Rmult_le_compat_r; lra).
    assert (0 <= v * f) by (apply Rmult_le_pos; lra).
    apply Rle_trans with (v * f * (1 - 8 * / 4503599627370496)); [| apply Rle_trans with (v * 1); [rewrite Rmult_assoc; apply Rmult_le_compat_l; lra | lra]].
    apply Rle_trans with (v * f * ((1 + 9 * / 4503599627370496) * (1 - 32 * / 4503599627370496) * (1 + / 4503599627370496))); [| apply Rmult_le_compat_l; lra]; lra. }
  assert (I8 : forall n k, In (n, k) all_names -> env k = x n).
  { intros n k I; cbn [all_names row_names app In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity. }
  assert (q1 : 0 <= (m - 1) / m <= 1).
  { split; [apply over_pos; lra |]; apply Rmult_le_reg_r with m; [lra |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra. }
  assert (KM : (1 + 9 * u) * x "K_least" <= within_K a b m).
  { destruct (computed all_names "K_least" (Cell tree_K None true) I8 by_search) as (w & C & D); cbn [tree loss loses] in C, D.
    assert (P : RunningBound.positive env tree_K).
    { unfold tree_K; cbn [RunningBound.positive]; left; split; [cbn; rewrite less, unit_is; lra | split; [left; split; cbn; rewrite ?u_is in *; lra | split; cbn; fold m; lra]]. }
    destruct (positive_factor u exact_inputs env tree_K w U P C) as (f & F & EQ); replace (x "K_least") with w by lra; rewrite EQ.
    change (value env tree_K) with (x "less" * (x "across_least" * x "mu_minus_one" / m)); pose proof (fun L => few_above _ f L F) as FF; destruct (FF ltac:(vm_compute; lia)) as [F1 F2].
    assert (i : 0 < / m) by (apply Rinv_0_lt_compat; lra); assert (z : 0 <= x "mu_minus_one") by (rewrite u_is in B1; lra).
    apply margin; [unfold Rdiv; repeat apply Rmult_le_pos; lra | | exact F1 | exact F2].
    rewrite KE; unfold Rdiv; replace (across * ((m - 1) * / m) * (1 + u)) with (across * ((m - 1) * (1 + u)) * / m) by ring.
    apply Rmult_le_compat_r; [lra |]; apply Rmult_le_compat; lra. }
  split; [split; [exact K0 |] |]; [| split; [split; [| exact M0] |]; [| split; [split; [lra | exact MA] |]; split; [exact KM |]]].
  - assert (within_K a b m <= across * 1) by (rewrite KE; apply Rmult_le_compat_l; lra).
    assert (a * a <= pow 200) by (change 200%Z with (100 + 100)%Z; rewrite powers; apply Rmult_le_compat; lra).
    pose proof (at_most 200 400 ltac:(lia)); pose proof (bpow_gt_0 radix2 (-300)); assert (0 < b * b * m) by (apply Rmult_lt_0_compat; lra).
    assert (x "K_least" <= (1 + 9 * u) * x "K_least") by (rewrite u_is; lra); unfold across in *; lra.
  - destruct (all_known "M_least" _ eq_refl) as [(_ & P & _) _]; apply P; reflexivity.
  - destruct (computed all_names "M_least" (Cell tree_M None true) I8 by_search) as (w & C & D); cbn [tree loss loses] in C, D.
    assert (P : RunningBound.positive env tree_M).
    { unfold tree_M; cbn [RunningBound.positive]; left; split; [cbn; rewrite less, unit_is; lra |]; cbn; fold a b c d m; repeat split; try (left; repeat split; try left; repeat split); try lra; try exact dd. }
    destruct (positive_factor u exact_inputs env tree_M w U P C) as (f & F & EQ); replace (x "M_least") with w by lra; rewrite EQ.
    change (value env tree_M) with (x "less" * (x "across_least" / along)); pose proof (fun L => few_above _ f L F) as FF; destruct (FF ltac:(vm_compute; lia)) as [F1 F2].
    assert (i : 0 < / along) by (apply Rinv_0_lt_compat; unfold along; lra).
    apply margin; [unfold Rdiv; apply Rmult_le_pos; lra | | exact F1 | exact F2].
    rewrite ME; unfold Rdiv; assert (across * / along <= across * / along * (1 + u)) by (rewrite <- (Rmult_1_r (across * / along)) at 1; apply Rmult_le_compat_l; [apply Rmult_le_pos; lra | rewrite u_is; lra]).
    apply Rle_trans with (across * / along); [apply Rmult_le_compat_r; lra | assumption].
Qed.

(** **What the C answers within such a line is the position.** *)
Theorem made_line_is_within l y n : StageOne.line l n -> y ("K_" ++ n)%string = x "K_least" -> y ("M_" ++ n)%string = x "M_least" ->
  StageOne.within l y (x "alpha") (x "gamma") (x "b") (x "d") n.
Proof.
  intros Line K_is M_is; destruct within_has_margin as (K & M & L & HK & HM); unfold StageOne.within, StageOne.usable; rewrite K_is, M_is.
  split; [exact Line |]; split; [auto |]; exists (x "mu"); auto.
Qed.

Theorem within_made_line_is_interior l y pre_y n : Forall (runs StageOne.multiplied y pre_y) l -> y "R_plus_T" < pow 400 -> StageOne.place l -> StageOne.line l n ->
  y ("K_" ++ n)%string = x "K_least" -> y ("M_" ++ n)%string = x "M_least" -> y "R" < y ("line_" ++ n)%string ->
  interior (upright (x "alpha") (x "gamma") (x "b") (x "d") (y "x") (y "y") (y "z")).
Proof.
  intros Steps Cap Place Line K_is M_is H.
  assert (size : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < x n) by (intros k I; pose proof (Sizes k I); pose proof (bpow_gt_0 radix2 (-100)); lra).
  apply (StageOne.interior_within l y pre_y (x "alpha") (x "gamma") (x "b") (x "d") Steps Cap) with (n := n); try (apply size; cbn; tauto);
    [exact Place | apply made_line_is_within; assumption | exact H].
Qed.
End Within.
