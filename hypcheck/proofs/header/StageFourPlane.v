(** Stage 4: the function of the header that decides in the plane of the waist, run by Coq: what its text returns is the position, or
    nothing, for all lengths below 2^62. *)

Require Import List String ZArith Reals Lia Bool.
From Hypcheck Require Import Steps Fixed FixedRuns Long Limbs LimbsRuns Computed Trees PlainerTexts StageThreeRuns StageThreeAnswers Stages Positions StageFour StageFourSteps.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** The text of the functions. *)
Definition texts := map (fun text => read_from (string_of text)) HeaderText.beside_tangency.
Definition functions := Eval vm_compute in match every texts with Some l => l | None => [] end.
Theorem texts_are_read : texts = map Some functions.
Proof. vm_cast_no_check (eq_refl (map Some functions)). Qed.

(** The bits of a number whose interval is computed. *)
Lemma found_pattern num v inner inputs l n w : all_hold num v inputs -> Forall (runs num v inner) l ->
  match intervals inputs l with Some known => match look n known with Some i => bits i =? w | None => false end | None => false end = true ->
  num n = v n mod 2 ^ w.
Proof.
  intros I R E; destruct (intervals inputs l) as [known |] eqn:K; [| discriminate]; destruct (look n known) as [i |] eqn:L; [| discriminate].
  apply Z.eqb_eq in E; subst w; exact (proj1 (intervals_hold num v inner l inputs known I R K n i L)).
Qed.

(** ** The plane. *)

Definition minus_one := Infix "-" (Constant Int 0) (Constant Int 1).
(** The steps before W, the discriminant and the sides. *)
Definition before_size := firstn 11 C_waist.
Definition of_excess := firstn 3 (skipn 11 C_waist).
Definition of_sides := firstn 6 (skipn 14 C_waist).
Definition with_size := ("size", 128) :: widths_after (of_lengths 6) before_size.
Definition sides := [If (is_negative_fixed "W") [Returns (Choice (is_negative_fixed "W_p_2") (Constant Int 0) minus_one)] [];
  Returns (Choice (is_negative_long "room") (Constant Int 2) (Constant Int 1))].
Theorem text_is : look "hc_position_in_plane" functions = Some (Deciding ["lengths"] (names_lengths 6 ++ steps_in (of_lengths 6) before_size
  ++ Set_ "hc_fixed" "size" (Choice (is_negative_fixed "W") (Named "opposite") (Named "W")) :: steps_in with_size of_excess
  ++ If (Infix "==" (is_negative_long "excess") (Constant Int 0)) [Returns (Constant Int 0)] [] :: steps_in (widths_after with_size of_excess) of_sides ++ sides)).
Proof. vm_compute; reflexivity. Qed.

(** Its run, where the patterns are what the steps compute. *)
Section Run.
Variables ls num v : string -> Z.
Hypotheses (Lengths : forall n, In n named -> 0 <= ls n < 2 ^ 62) (Begins : forall n, In n named -> num n = ls n)
  (Runs : Forall (runs num v false) C_waist) (Size : num "size" = if 2 ^ 127 <=? num "W" then num "opposite" else num "W").

Definition begun := match bound_all [Named "lengths"] [Rec (words_of_lengths ls)] constants with
  | Some now => fold_left (fun now n => (n, Of U64 (ls n)) :: now) (firstn 6 named) now | None => [] end.
Lemma beginning_runs f rest now : bound_all [Named "lengths"] [Rec (words_of_lengths ls)] constants = Some now ->
  go of_longs [] (6 + f) now (names_lengths 6 ++ rest)%list = go of_longs [] f begun rest.
Proof.
  intros E; unfold begun; rewrite E; vm_compute in E; injection E as <-; cbv [names_lengths named StageThreeRuns.lengths combine map firstn app fst snd]; cbn [Nat.add].
  do 6 (erewrite go_put; [| reflexivity | reflexivity | reflexivity]; cbv [bound app map fst snd append]); reflexivity.
Qed.
Lemma begun_sound : sound num (of_lengths 6) begun.
Proof.
  intros n w E; apply look_in, in_map_iff in E as (k & E & I); injection E as -> <-; assert (J : In n named) by (cbn in I |- *; tauto).
  split; [left; reflexivity |]; rewrite (Begins n J); split; [| pose proof (Lengths n J); lia].
  clear J; cbn in I; repeat destruct I as [<- | I]; try contradiction; reflexivity.
Qed.

Lemma run_of l from : Forall (runs num v false) (firstn l (skipn from C_waist)).
Proof.
  apply Forall_forall; intros s I; apply (proj1 (Forall_forall _ _) Runs); rewrite <- (firstn_skipn from C_waist); apply in_or_app; right.
  rewrite <- (firstn_skipn l (skipn from C_waist)); apply in_or_app; left; exact I.
Qed.
Theorem run_text : called functions of_longs [] "hc_position_in_plane" [Rec (words_of_lengths ls)]
  = Some (Of Int (code (in_plane (2 ^ 255 <=? num "excess") (2 ^ 127 <=? num "W") (2 ^ 127 <=? num "W_p_2") (2 ^ 255 <=? num "room")))).
Proof.
  unfold called; rewrite text_is; cbn [takes does List.length firstn map].
  destruct (bound_all [Named "lengths"] [Rec (words_of_lengths ls)] constants) as [now |] eqn:E; [| discriminate].
  change steps with (6 + (11 + S (3 + S (6 + 72))))%nat; rewrite (beginning_runs _ _ _ E); clear E now.
  destruct (steps_run num v false [] of_longs (fun n f E => E) before_size (of_lengths 6) (widths_after (of_lengths 6) before_size) (steps_in (of_lengths 6) before_size) begun
    (S (3 + S (6 + 72))) (Set_ "hc_fixed" "size" (Choice (is_negative_fixed "W") (Named "opposite") (Named "W")) :: steps_in with_size of_excess
    ++ If (Infix "==" (is_negative_long "excess") (Constant Int 0)) [Returns (Constant Int 0)] [] :: steps_in (widths_after with_size of_excess) of_sides ++ sides)%list)
    as [G S1]; [vm_compute; reflexivity | exact begun_sound | discriminate | vm_compute; reflexivity | vm_compute; reflexivity | exact (run_of 11 0) |].
  change (List.length before_size) with 11%nat in G; rewrite G; clear G; set (now := after num (of_lengths 6) before_size begun) in *.
  assert (there_W : there num now "W" 128) by (apply S1; vm_compute; reflexivity).
  assert (there_opposite : there num now "opposite" 128) by (apply S1; vm_compute; reflexivity).
  assert (value : eval of_longs now (Choice (is_negative_fixed "W") (Named "opposite") (Named "W")) = Some (datum_of 128 (num "size"))).
  { rewrite (eval_chosen _ _ _ _ _ _ _ (ask_fixed num of_longs (fun n f E => E) now "W" there_W)), Size; destruct (2 ^ 127 <=? num "W"); apply eval_named; [apply there_opposite | apply there_W]. }
  assert (Size_fits : 0 <= num "size" < 2 ^ 128) by (rewrite Size; destruct (2 ^ 127 <=? num "W"); [apply there_opposite | apply there_W]).
  cbn [app].
  erewrite (go_put _ _ _ _ "hc_fixed" "size"); [| vm_compute; reflexivity | exact value | reflexivity].
  rewrite bound_datum by (right; left; reflexivity); set (now' := ("size", datum_of 128 (num "size")) :: now) in *.
  assert (S' : sound num with_size now').
  { intros n w L; cbn [with_size look] in L; destruct (String.eqb_spec "size" n) as [<- | D].
    - injection L as <-; split; [right; left; reflexivity |]; split; [reflexivity | exact Size_fits].
    - destruct (S1 n w L) as (K & L' & B); split; [exact K |]; unfold now'; cbn [look]; rewrite (proj2 (String.eqb_neq _ _) D); split; assumption. }
  destruct (steps_run num v false [] of_longs (fun n f E => E) of_excess with_size (widths_after with_size of_excess) (steps_in with_size of_excess) now'
    (S (6 + 72)) (If (Infix "==" (is_negative_long "excess") (Constant Int 0)) [Returns (Constant Int 0)] [] :: steps_in (widths_after with_size of_excess) of_sides ++ sides)%list)
    as [G S2]; [vm_compute; reflexivity | exact S' | discriminate | vm_compute; reflexivity | vm_compute; reflexivity | exact (run_of 3 11) |].
  change (List.length of_excess) with 3%nat in G; rewrite G; clear G; set (now2 := after num with_size of_excess now') in *.
  assert (asked : eval of_longs now2 (Infix "==" (is_negative_long "excess") (Constant Int 0)) = Some (Of Int (if 2 ^ 255 <=? num "excess" then 0 else 1))).
  { eapply eval_infix; [reflexivity | apply (ask_long num of_longs (fun n f E => E)), S2; vm_compute; reflexivity | reflexivity |]; destruct (2 ^ 255 <=? num "excess"); reflexivity. }
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ asked); clear asked; unfold in_plane; destruct (2 ^ 255 <=? num "excess"); cbn [Z.eqb negb app];
    [| change (6 + 72)%nat with (S 77); erewrite go_return by reflexivity; reflexivity].
  destruct (steps_run num v false [] of_longs (fun n f E => E) of_sides (widths_after with_size of_excess) (widths_after (widths_after with_size of_excess) of_sides)
    (steps_in (widths_after with_size of_excess) of_sides) now2 72 sides) as [G S3];
    [vm_compute; reflexivity | exact S2 | discriminate | vm_compute; reflexivity | vm_compute; reflexivity | exact (run_of 6 14) |].
  change (List.length of_sides) with 6%nat in G; rewrite G; clear G; set (now3 := after num _ of_sides now2) in *; unfold sides.
  assert (asked : eval of_longs now3 (is_negative_fixed "W") = Some (Of U64 (if 2 ^ 127 <=? num "W" then W - 1 else 0))) by (apply (ask_fixed num of_longs (fun n f E => E)), S3; vm_compute; reflexivity).
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ asked); clear asked; destruct (2 ^ 127 <=? num "W"); cbn [Z.eqb app].
  - change (W - 1 =? 0) with false; cbv iota; cbn [app].
    rewrite (go_return _ _ _ _ _ _ (Of Int (if 2 ^ 127 <=? num "W_p_2" then 0 else -1))); [destruct (2 ^ 127 <=? num "W_p_2"); reflexivity |].
    rewrite (eval_chosen _ _ _ _ _ _ _ (ask_fixed num of_longs (fun n f E => E) now3 "W_p_2" ltac:(apply S3; vm_compute; reflexivity))); destruct (2 ^ 127 <=? num "W_p_2"); reflexivity.
  - rewrite (go_return _ _ _ _ _ _ (Of Int (if 2 ^ 255 <=? num "room" then 2 else 1))); [destruct (2 ^ 255 <=? num "room"); reflexivity |].
    rewrite (eval_chosen _ _ _ _ _ _ _ (ask_long num of_longs (fun n f E => E) now3 "room" ltac:(apply S3; vm_compute; reflexivity))); destruct (2 ^ 255 <=? num "room"); reflexivity.
Qed.
End Run.

Section Plane.
Variable ls : string -> Z.
Hypotheses (Lengths : forall n, In n named -> 0 <= ls n < 2 ^ 62) (Sizes : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < ls n).

(** Patterns and exact values; what C takes for the size of W begins them. *)
Definition excess_of_centre := ls "x" * ls "x" + ls "y" * ls "y" - ls "b" * ls "b" - ls "alpha" * ls "alpha".
Definition first_of_plane n := if is_in n named then ls n else if is "size" n then Z.abs excess_of_centre else 0.
Let num := computed (pattern_of false) first_of_plane C_waist.
Let v := computed (exact_value false) first_of_plane C_waist.

Lemma plane_runs : Forall (runs num v false) C_waist.
Proof. apply computed_run; vm_compute; reflexivity. Qed.
Lemma plane_begins n : In n named -> num n = ls n /\ v n = ls n.
Proof.
  intros I; unfold num, v; rewrite !computed_same; unfold first_of_plane.
  all: destruct I as [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]; (reflexivity || (split; reflexivity)).
Qed.
Lemma plane_size : num "size" = Z.abs (v "W") /\ v "size" = Z.abs (v "W") /\ Z.abs (v "W") < 2 ^ 126.
Proof.
  assert (E : v "W" = excess_of_centre) by (unfold v; cbv -[Z.add Z.mul Z.sub Z.abs excess_of_centre]; unfold excess_of_centre; ring).
  split; [| split]; rewrite E; [reflexivity | reflexivity |]; unfold excess_of_centre.
  assert (B : forall n, In n named -> 0 <= ls n * ls n < 2 ^ 124)
    by (intros n I; pose proof (Lengths n I); split; [lia | change (2 ^ 124) with (2 ^ 62 * 2 ^ 62); apply Z.mul_lt_mono_nonneg; lia]).
  pose proof (B "x" ltac:(cbn; tauto)); pose proof (B "y" ltac:(cbn; tauto)); pose proof (B "b" ltac:(cbn; tauto)); pose proof (B "alpha" ltac:(cbn; tauto)); lia.
Qed.
Lemma plane_opposite : v "opposite" = - v "W".
Proof. unfold v; cbv -[Z.add Z.mul Z.sub Z.opp]; ring. Qed.
Lemma plane_inputs : all_hold num v waist_inputs.
Proof.
  destruct plane_size as (N & V & B).
  intros n i E; apply look_in in E; cbn [waist_inputs StageFour.lengths map In] in E; destruct E as [E | E].
  - injection E as <- <-; unfold holds; cbn [bits least most]; rewrite N, V; pose proof (Z.abs_nonneg (v "W")).
    split; [symmetry; apply Z.mod_small; lia |]; split; [lia | reflexivity].
  - assert (I : In n named /\ i = Interval 64 0 (2 ^ 62 - 1))
      by (clear - E; repeat destruct E as [E | E]; try contradiction; injection E as <- <-; split; [cbn; tauto | reflexivity | ..]; cbn; tauto).
    destruct I as [I ->]; pose proof (Lengths n I); unfold holds; cbn [bits least most]; destruct (plane_begins n I) as [-> ->].
    split; [symmetry; apply Z.mod_small; lia |]; split; [lia | reflexivity].
Qed.

(** What the text of the C returns, for lengths in two units: the position, or nothing. *)
Theorem plane_text : exists o, called functions of_longs [] "hc_position_in_plane" [Rec (words_of_lengths ls)] = Some (Of Int (code o)) /\
  forall a u w x y, (0 < u)%R -> (0 < w)%R -> o = Some a -> (x ^ 2 = (IZR (ls "x") * u) ^ 2)%R -> (y ^ 2 = (IZR (ls "y") * u) ^ 2)%R ->
  answers (IZR (ls "alpha") * u) (IZR (ls "gamma") * w) (IZR (ls "b") * u) (IZR (ls "d") * w) x y 0 a.
Proof.
  pose proof plane_runs as Runs; pose proof plane_begins as Begin; pose proof plane_inputs as Inputs; destruct plane_size as (Size & Exact & _).
  assert (Size' : num "size" = if 2 ^ 127 <=? num "W" then num "opposite" else num "W").
  { rewrite Size; pose proof plane_opposite as O; destruct plane_size as (_ & _ & B).
    rewrite (found_pattern num v false waist_inputs C_waist "W" 128 Inputs Runs), (found_pattern num v false waist_inputs C_waist "opposite" 128 Inputs Runs), O by (vm_compute; reflexivity).
    clearbody num v; generalize dependent (v "W"); clear; intros w _ _ _ B; destruct (Z.lt_ge_cases w 0) as [L | L].
    - rewrite <- (Z.mod_add w 1) by discriminate; rewrite !Z.mod_small by lia; destruct (Z.leb_spec (2 ^ 127) (w + 1 * 2 ^ 128)); lia.
    - rewrite (Z.mod_small w) by lia; destruct (Z.leb_spec (2 ^ 127) w); lia. }
  exists (in_plane (2 ^ 255 <=? num "excess") (2 ^ 127 <=? num "W") (2 ^ 127 <=? num "W_p_2") (2 ^ 255 <=? num "room")); split.
  - exact (run_text ls num v Lengths (fun n I => proj1 (Begin n I)) Runs Size').
  - intros a u w x y U V E X Y.
    assert (same : forall n, In n named -> IZR (ls n) = IZR (v n)) by (intros n I; rewrite (proj2 (Begin n I)); reflexivity).
    assert (pos : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < v n) by (intros n I; rewrite (proj2 (Begin n ltac:(clear - I; cbn in *; tauto))); apply Sizes, I).
    rewrite !same in * by (cbn; tauto).
    apply (waist_is_right num v false Inputs Runs (pos "alpha" ltac:(cbn; tauto)) (pos "gamma" ltac:(cbn; tauto)) (pos "b" ltac:(cbn; tauto)) (pos "d" ltac:(cbn; tauto))
      (eq_trans Exact eq_refl) u w U V (2 ^ 255 <=? num "excess") (2 ^ 127 <=? num "W") (2 ^ 127 <=? num "W_p_2") (2 ^ 255 <=? num "room")); [| | | | exact E | exact X | exact Y].
    all: match goal with |- context [?c <=? ?x] => destruct (Z.leb_spec c x) end; [assumption | apply Zlt_not_le; assumption].
Qed.
End Plane.

(** Each of its answers occurs: for a unit sphere 4 from the axis of a hyperboloid with alpha 1 and gamma 3, one in the centre of a
    hyperboloid of twice its size, and one 1 from the axis of one of its own size; and 2 for that 4 from its axis. *)
Definition answer_at l := called functions of_longs [] "hc_position_in_plane" [Rec (words_of_lengths (fun n => match look n (combine named l) with Some z => z | None => 0 end))].
Theorem every_answer_occurs : map answer_at [[1; 3; 1; 1; 4; 0; 0]; [2; 2; 1; 1; 0; 0; 0]; [1; 1; 1; 1; 1; 0; 0]; [1; 1; 1; 1; 4; 0; 0]] = map (fun z => Some (Of Int z)) [1; -1; 0; 2].
Proof. vm_compute; reflexivity. Qed.
