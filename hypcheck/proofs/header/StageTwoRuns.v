(** Stage 2 from its C: what the steps of the header compute and compare in float64, and the guards among them, is the position.

    [x] has the number that each step gives, [holds] whether each comparison does. Every operation may round in a mode of its own, take a
    product unrounded, flush to 0 below the normal range, or overflow: that nothing overflows and that what underflows does no harm is proved,
    by the guards that the C asks. The inputs are numbers, so neither infinite nor NaN. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Flocq Require Import Core.
From Hypcheck Require Import Geometry UnitBall Cubic Rule Rounding Positions Floats Steps FixedRuns RunningBound Stages StageTwoAnswers Ranges Underflow.
From Hypcheck Require StageTwo.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Definition names_of f := map name (filter (fun s => match kind_of s with Some k => f k | None => false end) C_certified).
Definition multiplied := Eval vm_compute in names_of (fun k => match k with Times | Negated => true | _ => false end).
Definition floats := Eval vm_compute in names_of (fun k => match k with Plus | Minus | Times | Over => true | _ => false end).
Definition known := Eval vm_compute in reached C_certified.

Lemma known_is_reached : sizes guarded C_certified = Some known.
Proof. vm_compute; reflexivity. Qed.
Lemma known_below : forallb (fun p => (high (snd p) <=? 1023)%Z) known = true.
Proof. vm_compute; reflexivity. Qed.
Lemma floats_known : forallb (fun n => match look n known with Some _ => true | None => false end) floats = true.
Proof. vm_compute; reflexivity. Qed.

Lemma known_high n r : look n known = Some r -> (high r <= 1023)%Z.
Proof. intros E; apply look_in in E; pose proof known_below as H; rewrite forallb_forall in H; apply Z.leb_le, (H (n, r) E). Qed.

(** A sum of two numbers >= 0 is the sum of two others, hardly different, with a relative error alone. *)
Lemma sum_without_loss p q v : 0 <= p -> 0 <= q -> p + q <= pow 1023 -> returned (p + q) v ->
  exists p' q' t, 0 <= p' /\ 0 <= q' /\ Rabs (p' - p) <= pow (-1021) /\ Rabs (q' - q) <= pow (-1021)
    /\ Rabs t <= unit_of_any_mode /\ v = (p' + q') * (1 + t).
Proof.
  intros P Q H R; pose proof (bpow_gt_0 radix2 (-1022)); pose proof (Ranges.double (-1022)) as D; change (-1022 + 1)%Z with (-1021)%Z in D.
  destruct (rounding_loses _ _ R ltac:(rewrite Rabs_pos_eq; lra)) as (t & T & E & N).
  destruct (Rle_or_lt (pow (-1022)) (p + q)) as [L | L].
  - exists p, q, t; rewrite !Rminus_diag_eq, Rabs_R0 by reflexivity; repeat split; try lra; apply N; rewrite Rabs_pos_eq; lra.
  - assert (V : 0 <= v <= pow (-1022)).
    { destruct R as [R | [[_ ->] | [T' _]]]; [| lra | rewrite Rabs_pos_eq in T' by lra; pose proof (bpow_lt radix2 (-1022) 1023 ltac:(lia)); lra].
      split; [apply stays_positive with (p + q); [exact R | lra] | apply stays_below with (p + q); [exact R | lia | lra]]. }
    exists v, 0, 0; repeat split; try lra; try (apply Rabs_le; lra); rewrite ?Rabs_R0; apply bpow_ge_0.
Qed.

Local Notation by_search := ltac:(vm_compute; reflexivity) (only parsing).

Section Certified.

Variables (x pre : string -> R) (holds : string -> Prop).

(** The constants of the header, and that inputs are not computed. *)
Definition constants := [("u_4", 4 * unit * slack); ("u_8", 8 * unit * slack); ("u_12", 12 * unit * slack); ("slack", slack);
  ("u_16", 16 * unit * slack); ("u_1536", 1536 * unit * slack); ("least", pow (-100)); ("greatest", pow 100); ("farthest", pow 200)].
Hypotheses (Runs : Forall (runs multiplied x pre) C_certified) (Compares : Forall (compares x holds) C_certified)
  (Constants : forall n v, In (n, v) constants -> x n = v)
  (Inputs : forall n, In n (["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"] ++ map fst constants) -> pre n = x n).

Let body := upright (x "alpha") (x "gamma") (x "b") (x "d") (x "x") (x "y") (x "z").

(** ** Steps by their names. *)

Definition step_of n := find (fun s => String.eqb (name s) n) C_certified.

Lemma runs_of n s : step_of n = Some s -> runs multiplied x pre s.
Proof. intros E; apply find_some in E as [I _]; apply (proj1 (Forall_forall _ _) Runs s I). Qed.
Lemma means_of n s : step_of n = Some s -> compares x holds s.
Proof. intros E; apply find_some in E as [I _]; apply (proj1 (Forall_forall _ _) Compares s I). Qed.

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
Lemma size_of n a : step_of n = Some (Step n "HC_ABS" [Name a]) -> x n = Rabs (x a).
Proof. intros E; destruct (runs_of n _ E) as (p & -> & _ & H); exact H. Qed.
Lemma opposite_of n a : step_of n = Some (Step n "neg" [Name a]) -> x n = - x a.
Proof. intros E; destruct (runs_of n _ E) as (p & q & _ & -> & _ & H); exact H. Qed.
Lemma both_hold n a c : step_of n = Some (Step n "HC_AND" [Name a; Name c]) -> holds n -> holds a /\ holds c.
Proof. intros E; exact (means_of n _ E). Qed.
Lemma one_holds n a c : step_of n = Some (Step n "HC_OR" [Name a; Name c]) -> holds n -> holds a \/ holds c.
Proof. intros E; exact (means_of n _ E). Qed.
Lemma greater n a c : step_of n = Some (Step n "HC_GT" [Name a; Name c]) -> holds n -> x c < x a.
Proof. intros E H; apply (means_of n _ E H); reflexivity. Qed.
Lemma greater_0 n a : step_of n = Some (Step n "HC_GT" [Name a; Number 0]) -> holds n -> 0 < x a.
Proof. intros E H; apply (means_of n _ E H); reflexivity. Qed.
Lemma less n a c : step_of n = Some (Step n "HC_LT" [Name a; Name c]) -> holds n -> x a < x c.
Proof. intros E H; apply (means_of n _ E H); reflexivity. Qed.

(** ** The guards. *)

Let constant n v : In (n, v) constants -> x n = v /\ pre n = v.
Proof.
  intros I; split; [apply Constants; exact I |]; rewrite Inputs; [apply Constants; exact I |].
  apply in_or_app; right; apply (in_map fst constants (n, v) I).
Qed.

Lemma guards : holds "usable" -> 0 < x "alpha" /\ 0 < x "gamma" /\ pow (-100) < x "b" < pow 100 /\ pow (-100) < x "d" < pow 100
  /\ pow (-100) < x "A" < pow 100 /\ pow (-100) < x "B" < pow 100 /\ x "P_plus_Q" < pow 200.
Proof.
  intros H; destruct (both_hold "usable" _ _ by_search H) as [H1 H2]; destruct (both_hold "sizes_usable" _ _ by_search H1) as [H3 H4].
  destruct (both_hold "positive_radial" _ _ by_search H3) as [H5 H6]; destruct (both_hold "ratios_usable" _ _ by_search H4) as [H7 H8].
  destruct (both_hold "radial_usable" _ _ by_search H7) as [H9 H10]; destruct (both_hold "axial_usable" _ _ by_search H8) as [H11 H12].
  destruct (both_hold "b_usable" _ _ by_search H9) as [B1 B2]; destruct (both_hold "A_usable" _ _ by_search H10) as [A1 A2].
  destruct (both_hold "d_usable" _ _ by_search H11) as [D1 D2]; destruct (both_hold "B_usable" _ _ by_search H12) as [C1 C2].
  assert (L : x "least" = pow (-100)) by (apply Constants, look_in; reflexivity); assert (G : x "greatest" = pow 100) by (apply Constants, look_in; reflexivity).
  assert (F : x "farthest" = pow 200) by (apply Constants, look_in; reflexivity); rewrite <- L, <- G, <- F.
  repeat split; [apply (greater_0 "alpha_usable" _ by_search H5) | apply (greater_0 "gamma_usable" _ by_search H6)
    | apply (greater "b_not_small" _ _ by_search B1) | apply (less "b_not_large" _ _ by_search B2)
    | apply (greater "d_not_small" _ _ by_search D1) | apply (less "d_not_large" _ _ by_search D2)
    | apply (greater "A_not_small" _ _ by_search A1) | apply (less "A_not_large" _ _ by_search A2)
    | apply (greater "B_not_small" _ _ by_search C1) | apply (less "B_not_large" _ _ by_search C2) | apply (less "not_too_far" _ _ by_search H2)].
Qed.

Let in_range l h v : pow l <= v <= pow h -> within (between l h) v.
Proof.
  intros [L H]; pose proof (bpow_gt_0 radix2 l); repeat split; cbn [low high positive between]; [rewrite Rabs_pos_eq | |]; lra.
Qed.

Lemma all_known : holds "usable" -> all_hold x pre known.
Proof.
  intros H; destruct (guards H) as (G1 & G2 & G3 & G4 & G5 & G6 & G7).
  apply (sizes_hold multiplied x pre C_certified guarded known); [| exact Runs | exact known_is_reached].
  apply (guards_give multiplied x pre); try assumption; try by_its_step.
  - intros n I; apply Inputs; apply in_or_app; left; exact I.
  - intros n s I; assert (W : exists v l h, In (n, v) constants /\ s = between l h /\ pow l <= v <= pow h).
    { unfold constants, unit, slack; cbn [In] in I |- *; repeat destruct I as [I | I]; try contradiction; injection I as <- <-.
      - exists (4 * / 2 ^ 52 * (1 + / 2 ^ 20)), (-50)%Z, (-49)%Z; repeat split; [tauto | simpl; lra ..].
      - exists (8 * / 2 ^ 52 * (1 + / 2 ^ 20)), (-49)%Z, (-48)%Z; repeat split; [tauto | simpl; lra ..].
      - exists (12 * / 2 ^ 52 * (1 + / 2 ^ 20)), (-49)%Z, (-48)%Z; repeat split; [tauto | simpl; lra ..].
      - exists (16 * / 2 ^ 52 * (1 + / 2 ^ 20)), (-48)%Z, (-47)%Z; repeat split; [tauto | simpl; lra ..].
      - exists (1536 * / 2 ^ 52 * (1 + / 2 ^ 20)), (-42)%Z, (-41)%Z; repeat split; [tauto | simpl; lra ..].
      - exists (1 + / 2 ^ 20), 0%Z, 1%Z; repeat split; [tauto | simpl; lra ..]. }
    destruct W as (v & l & h & J & -> & B); destruct (constant n v J) as [-> ->]; split; apply in_range; exact B.
  - destruct (sum_of "P_plus_Q" _ _ eq_refl) as [(p & q & P & Q & E) _]; exists q; split; [exact Q |]; rewrite E; f_equal; destruct P as [P | P]; [exact P |]; destruct P as [N _]; discriminate N.
Qed.

Section Usable.

Hypothesis Usable : holds "usable".
Let K : all_hold x pre known := all_known Usable.

Lemma all_float n : is_in n floats = true -> float (x n).
Proof.
  intros I; pose proof floats_known as KN; rewrite forallb_forall in KN; unfold is_in in I; apply existsb_exists in I as (m & I & E).
  apply String.eqb_eq in E; subst m; specialize (KN n I); destruct (look n known) as [r |] eqn:L; [| discriminate].
  destruct (K n r L) as [_ (W & _)]; pose proof (at_most _ _ (known_high n r L)).
  apply (returned_float (pre n)); [| lra]; clear - I Runs; change floats with (names_of (fun k => match k with Plus | Minus | Times | Over => true | _ => false end)) in I.
  unfold names_of in I; apply in_map_iff in I as (s & <- & I); apply filter_In in I as [I E]; pose proof (proj1 (Forall_forall _ _) Runs s I) as H.
  unfold runs in H; destruct (kind_of s) as [[] |]; try discriminate; destruct (arguments (meaning s)) as [| a [| c [|]]]; try contradiction;
    destruct H as (p & q & _ & _ & _ & H); exact H.
Qed.

(** ** What the steps compute, layer by layer: nearly what a run without underflow does. *)

Notation u := unit_of_any_mode.
Definition lost := pow (-700).

Definition given_as (l : list (string * nat)) := map (fun p => (fst p, Cell (Input (snd p)) None false)) l.

Lemma given_stand l entry env : (forall n k, In (n, k) l -> env k = x n) -> all_stand multiplied x pre entry env (given_as l).
Proof.
  intros H n c E; apply look_in in E; unfold given_as in E; apply in_map_iff in E as ([m k] & E & I); injection E as <- <-; cbn [fst snd].
  split; [| discriminate]; exists (env k * 1); split; [apply c_input | cbn; rewrite (H m k I); ring].
  assert (U : 0 <= u < 1) by (unfold unit_of_any_mode; simpl; lra); apply factor_1; exact U.
Qed.

Definition table l := cells multiplied floats known l C_certified.

Let all_cells entry env l : all_stand multiplied x pre entry env l -> all_stand multiplied x pre entry env (table l).
Proof. intros H; apply cells_stand; [exact all_float | exact K | exact known_high | exact Runs | exact H]. Qed.

Definition is_little c := match loss c with None => true | Some k => (k <=? -700)%Z end.

Lemma nearly_runs entry env l n c : all_stand multiplied x pre entry env l -> look n (table l) = Some c -> is_little c = true ->
  nearly (computes u entry env (tree c)) lost (x n).
Proof.
  intros H E L; destruct (all_cells entry env l H n c E) as [(w & C & D) _]; exists w; split; [exact C |]; unfold is_little in L.
  destruct (loss c) as [k |]; cbn in D; [| rewrite D, Rabs_R0; apply bpow_ge_0]; apply Z.leb_le in L; pose proof (at_most _ _ L); unfold lost; lra.
Qed.
Lemma runs_so entry env l n e b : all_stand multiplied x pre entry env l -> look n (table l) = Some (Cell e None b) -> computes u entry env e (x n).
Proof. intros H E; destruct (all_cells entry env l H n _ E) as [(w & C & D) _]; cbn in D, C; replace (x n) with w by lra; exact C. Qed.

Definition row_inputs := given_as [("alpha", 0); ("gamma", 1); ("b", 2); ("d", 3); ("x", 4); ("y", 5); ("z", 6)]%nat.
Definition coefficients := given_as [("c0", 0); ("c1", 1); ("c2", 2)]%nat.
Definition hessian := given_as [("h1", 0); ("h2", 1); ("h3", 2)]%nat.
Definition slope_inputs := given_as [("c1", 0); ("c2", 1); ("alpha", 2); ("gamma", 3); ("b", 4); ("d", 5)]%nat.
Definition bound_inputs := ([("BP_plus_AQ", Cell (Add (Input 3) (Input 4)) None false); ("P_plus_Q", Cell (Add (Input 5) (Input 6)) None false);
  ("A", Cell (Input 0) None true); ("B", Cell (Input 1) None true); ("AB", Cell (Input 2) None true)]
  ++ given_as [("size_c1", 7); ("size_c2", 8); ("size_h1", 9); ("size_h2", 10); ("size_h3", 11); ("u_4", 12); ("u_8", 13); ("u_12", 14);
               ("slack", 15); ("u_16", 16)]%nat)%list.

(** Inputs of the bounds that are products before they are rounded: off by one rounding. *)
Lemma unrounded_factor n r : look n known = Some r -> is_normal_size r = true -> returned (pre n) (x n) -> exists f, factor u 1 f /\ pre n = x n * f.
Proof.
  intros E N R; destruct (K n r E) as [_ (H & P & L)]; pose proof (at_most _ _ (known_high n r E)); unfold is_normal_size in N.
  destruct (low r) as [k |]; [| discriminate]; apply Z.leb_le in N; pose proof (at_most _ _ N); pose proof (Rle_abs (pre n)).
  destruct (rounding_loses _ _ R ltac:(lra)) as (t & T & _ & X); rewrite X by lra.
  assert (U : 0 <= u < 1) by (unfold unit_of_any_mode; simpl; lra); pose proof (factor_of_rounding u U t T) as F; pose proof (factor_pos u U 1 _ F).
  exists (/ (1 + t)); split; [apply factor_inv; assumption | field; lra].
Qed.

Lemma taken_nearly n c p p' : takes multiplied x pre (Name n) p -> all_stand multiplied x pre exact_inputs (fun k => nth k (map x ["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"]) 0) row_inputs ->
  look n (table row_inputs) = Some c -> unrounded c = true -> match loss c with Some k => (k <=? -701)%Z | None => true end = true ->
  Rabs (p' - p) <= pow (-1021) -> nearly (computes u exact_inputs (fun k => nth k (map x ["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"]) 0) (tree c)) lost p'.
Proof.
  intros T I E A L D; destruct (all_cells _ _ _ I n c E) as [S1 S2].
  assert (S : stands exact_inputs (fun k => nth k (map x ["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"]) 0) c p) by (destruct T as [-> | [M ->]]; auto).
  destruct S as (w & C & W); exists w; split; [exact C |]; replace (p' - w) with ((p' - p) + (p - w)) by ring; pose proof (Rabs_triang (p' - p) (p - w)) as TR.
  assert (Z : Rabs (p - w) <= pow (-701)).
  { destruct (loss c) as [k |]; cbn in W; [apply Z.leb_le in L; pose proof (at_most _ _ L); lra | rewrite W, Rabs_R0; apply bpow_ge_0]. }
  pose proof (bpow_lt radix2 (-1021) (-701) ltac:(lia)); pose proof (Ranges.double (-701)) as DB; change (-701 + 1)%Z with (-700)%Z in DB; unfold lost; lra.
Qed.

Lemma positive_taken n r p : takes multiplied x pre (Name n) p -> look n known = Some r -> positive r = true -> 0 <= p.
Proof. intros T E P; destruct (K n r E) as [(_ & P1 & _) (_ & P2 & _)]; destruct T as [-> | [_ ->]]; auto. Qed.

Definition answer a := says (x "c1") (x "c2") (x "delta_3") (x "slope_B") (x "offset_B") (x "slope_A") (x "offset_A") (x "E") (x "e1") (x "e2")
  (x "bound_B") (x "offset_bound_B") (x "bound_A") (x "offset_bound_A") a.

Lemma answer_is_right a : answer a -> is_position body a.
Proof.
  destruct (guards Usable) as (G1 & G2 & G3 & G4 & G5 & G6 & G7).
  assert (b0 : 0 < x "b") by (pose proof (bpow_gt_0 radix2 (-100)); lra); assert (d0 : 0 < x "d") by (pose proof (bpow_gt_0 radix2 (-100)); lra).
  assert (U2 : u = / 2 ^ 52) by (unfold unit_of_any_mode; simpl; lra).
  assert (sum : forall n a c r, step_of n = Some (Step n "add" [Name a; Name c]) -> look n known = Some r ->
    forall ra rc, look a known = Some ra -> look c known = Some rc -> positive ra = true -> positive rc = true ->
    exists p q p' q' t, takes multiplied x pre (Name a) p /\ takes multiplied x pre (Name c) q /\ 0 <= p' /\ 0 <= q'
      /\ Rabs (p' - p) <= pow (-1021) /\ Rabs (q' - q) <= pow (-1021) /\ Rabs t <= u /\ x n = (p' + q') * (1 + t)).
  { intros n a' c r E L ra rc LA LC PA PC; destruct (sum_of n a' c E) as ((p & q & TP & TQ & EQ) & RT).
    destruct (K n r L) as [_ (H & _)]; pose proof (at_most _ _ (known_high n r L)); pose proof (Rle_abs (p + q)); rewrite EQ in RT, H.
    destruct (sum_without_loss p q (x n)) as (p' & q' & t & S1 & S2 & S3 & S4 & S5 & S6); [| | lra | exact RT |].
    - apply (positive_taken a' ra p TP LA PA).
    - apply (positive_taken c rc q TQ LC PC).
    - exists p, q, p', q', t; repeat split; assumption. }
  destruct (sum "BP_plus_AQ" _ _ _ eq_refl eq_refl _ _ eq_refl eq_refl eq_refl eq_refl) as (p1 & q1 & fBP & fAQ & t1 & TP1 & TQ1 & BP0 & AQ0 & DP1 & DQ1 & T1 & S1).
  destruct (sum "P_plus_Q" _ _ _ eq_refl eq_refl _ _ eq_refl eq_refl eq_refl eq_refl) as (p2 & q2 & fP & fQ & t2 & TP2 & TQ2 & P0 & Q0 & DP2 & DQ2 & T2 & S2).
  clear sum.
  set (row := fun k => nth k (map x ["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"]) 0).
  assert (IR : all_stand multiplied x pre exact_inputs row row_inputs).
  { apply given_stand; intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity. }
  set (co := fun k => nth k [- x "AB"; x "c1"; x "c2"] 0).
  assert (IC : all_stand multiplied x pre exact_inputs co coefficients).
  { apply given_stand; intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; try reflexivity.
    symmetry; apply (opposite_of "c0" _ by_search). }
  set (he := fun k => nth k [x "h1"; x "h2"; x "h3"] 0).
  assert (IH : all_stand multiplied x pre exact_inputs he hessian).
  { apply given_stand; intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity. }
  set (sl := fun k => nth k [x "c1"; x "c2"; x "alpha"; x "gamma"; x "b"; x "d"] 0).
  assert (IS : all_stand multiplied x pre exact_inputs sl slope_inputs).
  { apply given_stand; intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity. }
  set (kn := fun k => nth k [x "A"; x "B"; x "AB"; fBP; fAQ; fP; fQ; Rabs (x "c1"); Rabs (x "c2"); Rabs (x "h1"); Rabs (x "h2"); Rabs (x "h3");
                      4 * unit * slack; 8 * unit * slack; 12 * unit * slack; slack; 16 * unit * slack] 0).
  assert (IB : all_stand multiplied x pre products_unrounded kn bound_inputs).
  { assert (U1 : 0 <= u < 1) by (rewrite U2; simpl; lra).
    assert (one : forall k, computes u products_unrounded kn (Input k) (kn k)).
    { intros k; rewrite <- (Rmult_1_r (kn k)); apply c_input; apply factor_1; exact U1. }
    assert (whole : forall n k, kn k = x n -> stands products_unrounded kn (Cell (Input k) None true) (x n)).
    { intros n k E; exists (kn k); split; [apply one | cbn [loss loses]; rewrite E; ring]. }
    assert (off : forall n k r, kn k = x n -> look n known = Some r -> is_normal_size r = true -> returned (pre n) (x n) -> stands products_unrounded kn (Cell (Input k) None true) (pre n)).
    { intros n k r E L N R; destruct (unrounded_factor n r L N R) as (f & F & EQ); exists (kn k * f); split; [apply c_input; exact F | cbn [loss loses]; rewrite E, EQ; ring]. }
    intros n c E; unfold bound_inputs in E; cbn [app look] in E.
    destruct (String.eqb_spec "BP_plus_AQ" n) as [<- | _]; [injection E as <- | destruct (String.eqb_spec "P_plus_Q" n) as [<- | _]; [injection E as <- |
      destruct (String.eqb_spec "A" n) as [<- | _]; [injection E as <- | destruct (String.eqb_spec "B" n) as [<- | _]; [injection E as <- |
      destruct (String.eqb_spec "AB" n) as [<- | _]; [injection E as <- |]]]]].
    - split; [| discriminate]; exists ((kn 3%nat + kn 4%nat) * (1 + t1)); split; [apply c_add; auto | cbn [loss loses]; rewrite S1; unfold kn; cbn [nth]; ring].
    - split; [| discriminate]; exists ((kn 5%nat + kn 6%nat) * (1 + t2)); split; [apply c_add; auto | cbn [loss loses]; rewrite S2; unfold kn; cbn [nth]; ring].
    - split; [apply whole; reflexivity | intros _ _; eapply off; [reflexivity | reflexivity | reflexivity | by_its_step]].
    - split; [apply whole; reflexivity | intros _ _; eapply off; [reflexivity | reflexivity | reflexivity | by_its_step]].
    - split; [apply whole; reflexivity | intros _ _; eapply off; [reflexivity | reflexivity | reflexivity | by_its_step]].
    - refine (given_stand _ _ _ _ n c E); clear n c E; intros n k I; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-;
        unfold kn; cbn [nth]; symmetry; match goal with
        | |- x ?n = Rabs (x ?a) => exact (size_of n a by_search) | |- x ?n = _ => apply Constants, look_in; reflexivity end. }
  assert (little : forall n env l e c, all_stand multiplied x pre exact_inputs env l -> look n (table l) = Some c -> tree c = e -> is_little c = true ->
    nearly (computes u exact_inputs env e) lost (x n)) by (intros n env l e c I L <- T; apply (nearly_runs _ _ l); assumption).
  assert (wA : pow (-100) <= x "A") by lra.
  assert (wAB : pow (-200) <= x "AB") by (destruct (K "AB" _ eq_refl) as [(_ & _ & W) _]; exact W).
  pose proof (bpow_gt_0 radix2 (-200)); pose proof (bpow_gt_0 radix2 (-100)).
  assert (SM : / 2 ^ 52 * / 2 ^ 52 * / 2 ^ 52 = pow (-156)).
  { rewrite <- U2; unfold unit_of_any_mode; rewrite <- !bpow_plus; reflexivity. }
  assert (lose : forall k v, pow k <= v -> (-544 <= k)%Z -> lost <= / 2 ^ 52 * / 2 ^ 52 * / 2 ^ 52 * v).
  { intros k v V L; rewrite SM; apply Rle_trans with (pow (-156) * pow k); [rewrite <- bpow_plus; apply at_most; lia |].
    apply Rmult_le_compat_l; [apply bpow_ge_0 | exact V]. }
  apply (stage_two_is_right (x "alpha") (x "gamma") (x "b") (x "d") (x "x") (x "y") (x "z") u G1 G2 b0 d0) with
    (fA := x "A") (fB := x "B") (fAB := x "AB") (fBP := fBP) (fAQ := fAQ) (fP := fP) (fQ := fQ) (lost := lost) (h1 := x "h1") (h2 := x "h2") (h3 := x "h3");
    try assumption.
  - rewrite U2; split; [left; apply Rinv_0_lt_compat, pow_lt; lra | apply Rle_refl].
  - eapply (runs_so _ _ row_inputs "A"); [exact IR | vm_compute; reflexivity].
  - eapply (runs_so _ _ row_inputs "B"); [exact IR | vm_compute; reflexivity].
  - eapply (runs_so _ _ row_inputs "AB"); [exact IR | vm_compute; reflexivity].
  - eapply (taken_nearly "BP" (Cell StageTwo.BP _ true)); [exact TP1 | exact IR | vm_compute; reflexivity | reflexivity | reflexivity | exact DP1].
  - eapply (taken_nearly "AQ" (Cell StageTwo.AQ _ true)); [exact TQ1 | exact IR | vm_compute; reflexivity | reflexivity | reflexivity | exact DQ1].
  - eapply (taken_nearly "P" (Cell StageTwo.P _ true)); [exact TP2 | exact IR | vm_compute; reflexivity | reflexivity | reflexivity | exact DP2].
  - eapply (taken_nearly "Q" (Cell StageTwo.Q _ true)); [exact TQ2 | exact IR | vm_compute; reflexivity | reflexivity | reflexivity | exact DQ2].
  - eapply (little "c1" row row_inputs); [exact IR | vm_compute; reflexivity | reflexivity | reflexivity].
  - eapply (little "c2" row row_inputs); [exact IR | vm_compute; reflexivity | reflexivity | reflexivity].
  - rewrite <- (Rmult_1_r (_ * _ * _)); split; [apply bpow_ge_0 | apply (lose 0%Z); [cbn; lra | lia]].
  - apply (lose (-100)%Z); [exact wA | lia].
  - apply (lose (-200)%Z); [exact wAB | lia].
  - apply (lose (-400)%Z); [change (-400)%Z with (-200 + -200)%Z; rewrite bpow_plus; apply Rmult_le_compat; lra | lia].
  - eapply (little "h1" co coefficients); [exact IC | vm_compute; reflexivity | reflexivity | reflexivity].
  - eapply (little "h2" co coefficients); [exact IC | vm_compute; reflexivity | reflexivity | reflexivity].
  - eapply (little "h3" co coefficients); [exact IC | vm_compute; reflexivity | reflexivity | reflexivity].
  - eapply (little "delta_3" he hessian); [exact IH | vm_compute; reflexivity | reflexivity | reflexivity].
  - eapply (little "slope_B" sl slope_inputs); [exact IS | vm_compute; reflexivity | reflexivity | reflexivity].
  - eapply (little "offset_B" sl slope_inputs); [exact IS | vm_compute; reflexivity | reflexivity | reflexivity].
  - eapply (little "slope_A" sl slope_inputs); [exact IS | vm_compute; reflexivity | reflexivity | reflexivity].
  - eapply (little "offset_A" sl slope_inputs); [exact IS | vm_compute; reflexivity | reflexivity | reflexivity].
  - eapply (runs_so _ _ bound_inputs "E"); [exact IB | vm_compute; reflexivity].
  - eapply (runs_so _ _ bound_inputs "e1"); [exact IB | vm_compute; reflexivity].
  - eapply (runs_so _ _ bound_inputs "e2"); [exact IB | vm_compute; reflexivity].
  - eapply (runs_so _ _ bound_inputs "bound_B"); [exact IB | vm_compute; reflexivity].
  - eapply (runs_so _ _ bound_inputs "offset_bound_B"); [exact IB | vm_compute; reflexivity].
  - eapply (runs_so _ _ bound_inputs "bound_A"); [exact IB | vm_compute; reflexivity].
  - eapply (runs_so _ _ bound_inputs "offset_bound_A"); [exact IB | vm_compute; reflexivity].
Qed.

End Usable.

(** ** The comparisons. *)

Let three_roots : holds "three_roots" -> holds "usable" /\ x "E" < x "delta_3".
Proof.
  intros H; destruct (both_hold "three_roots" _ _ by_search H) as [D U]; split; [exact U | apply (greater "distinct" _ _ by_search D)].
Qed.
Let all_positive : holds "all_positive" -> holds "usable" /\ x "E" < x "delta_3" /\ x "c2" < - x "e2" /\ x "e1" < x "c1".
Proof.
  intros H; destruct (both_hold "all_positive" _ _ by_search H) as [T F]; destruct (both_hold "falling_then_rising" _ _ by_search F) as [N P].
  destruct (three_roots T) as [U D]; rewrite <- (opposite_of "minus_e2" _ by_search); repeat split; try assumption;
    [apply (less "c2_negative" _ _ by_search N) | apply (greater "c1_positive" _ _ by_search P)].
Qed.
Let two_negative : holds "two_negative" -> holds "usable" /\ x "E" < x "delta_3" /\ (x "e2" < x "c2" \/ x "c1" < - x "e1").
Proof.
  intros H; destruct (both_hold "two_negative" _ _ by_search H) as [T F]; destruct (three_roots T) as [U D]; repeat split; try assumption.
  rewrite <- (opposite_of "minus_e1" _ by_search); destruct (one_holds "some_sign_differs" _ _ by_search F) as [P | N];
    [left; apply (greater "c2_positive" _ _ by_search P) | right; apply (less "c1_negative" _ _ by_search N)].
Qed.

(** **What stage 2 answers is the position**: all that is supposed is what the steps of the C compute and compare. *)
Theorem exterior_is_right : holds "exterior" -> exterior body.
Proof.
  intros H; destruct (both_hold "exterior" _ _ by_search H) as [P S]; destruct (all_positive P) as (U & A).
  apply (answer_is_right U Exterior); apply says_exterior; [exact A |]; rewrite <- (opposite_of "below_B" _ by_search).
  destruct (one_holds "some_below_B" _ _ by_search S) as [I | F];
    [left; apply (greater "inflection_inside_B" _ _ by_search I) | right; apply (less "falls_B" _ _ by_search F)].
Qed.

Theorem interior_is_right : holds "interior" -> interior body.
Proof.
  intros H; destruct (both_hold "interior" _ _ by_search H) as [N S]; destruct (two_negative N) as (U & A).
  destruct (both_hold "both_above_A" _ _ by_search S) as [I R]; apply (answer_is_right U Interior); apply says_interior; [exact A | |];
    [apply (greater "inflection_inside_A" _ _ by_search I) | apply (greater "rises_A" _ _ by_search R)].
Qed.

Theorem contact_is_right : holds "contact" -> contact body.
Proof.
  intros H; destruct (one_holds "contact" _ _ by_search H) as [C | S].
  - destruct (both_hold "crossing" _ _ by_search C) as [O U]; apply (answer_is_right U Contact); apply says_crossing.
    rewrite <- (opposite_of "minus_E" _ by_search); apply (less "one_root" _ _ by_search O).
  - destruct (one_holds "several_curves" _ _ by_search S) as [G | T].
    + destruct (both_hold "groove" _ _ by_search G) as [P B]; destruct (all_positive P) as (U & A); destruct (both_hold "none_below_B" _ _ by_search B) as [I R].
      apply (answer_is_right U Contact); apply says_groove; [exact A | |]; rewrite <- ?(opposite_of "offset_below_B" _ by_search);
        [apply (less "inflection_beyond_B" _ _ by_search I) | apply (greater "rises_B" _ _ by_search R)].
    + destruct (both_hold "throat" _ _ by_search T) as [N B]; destruct (two_negative N) as (U & A).
      apply (answer_is_right U Contact); apply says_throat; [exact A |].
      rewrite <- (opposite_of "offset_below_A" _ by_search), <- (opposite_of "below_A" _ by_search).
      destruct (one_holds "none_above_A" _ _ by_search B) as [I | F];
        [left; apply (less "inflection_beyond_A" _ _ by_search I) | right; apply (less "falls_A" _ _ by_search F)].
Qed.

(** Decided, and neither: contact. *)
Theorem decided_is_right : holds "decided" ->
  holds "exterior" /\ exterior body \/ holds "interior" /\ interior body \/ holds "contact" /\ contact body.
Proof.
  intros H; destruct (one_holds "decided" _ _ by_search H) as [C | C]; [destruct (one_holds "clear" _ _ by_search C) as [E | I] |];
    auto using exterior_is_right, interior_is_right, contact_is_right.
Qed.

End Certified.
