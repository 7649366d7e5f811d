(** Stage 4: the function of the header that proves a tangency by Newton's method, run by Coq from its beginning, turn after turn: what its
    text returns is a side from which the row touches, or 2. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed FixedRuns Long Limbs LimbsRuns Computed Trees StageThreeRuns StageThreeAnswers StageFour StageFourSteps StageFourGuesses StageFourTurns.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Section Run.
Variables (float : string -> list datum -> Z) (less : datum -> datum -> bool) (nearest word : Z -> Z) (ls : string -> Z) (inside : bool).
Hypotheses (Lengths : forall n, In n named -> 0 <= ls n < 2 ^ 62) (Sizes : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < ls n).
Notation known := (of_touching float less nearest word).
Let Known := longs_are_known float less nearest word.

(** ** A turn. *)

Definition base := before inside before_guess ls.
Definition new_names (now : environment) := forallb (fun n => match look n now with None => true | _ => false end) (declared a_turn).
Record in_turn (now : environment) (k M e : Z) : Prop := InTurn { turn_base : sound base first_widths now; turn_side : side_is_known inside now; turn_M : holds_number now "M" M; turn_e : holds_number now "e" e;
  turn_k : look "turn" now = Some (Of Int k); turn_d : is_opaque now "d_"; turn_most : is_opaque now "most"; turn_half : look "_0.5" now = Some (Opaque "0.5" 0);
  turn_new : new_names now = true }.

Lemma steps_ordered : ordered before_guess = true /\ ordered behind_guess = true.
Proof. split; vm_compute; reflexivity. Qed.
Lemma guess_apart : forallb (fun s => forallb (fun n => negb (is_later behind_guess n)) (reads_of s)) before_guess = true.
Proof. vm_compute; reflexivity. Qed.
Lemma steps_are : (long_inputs = long_inputs /\ (before_guess ++ behind_guess)%list = C_tangency /\ 62 = 62 /\ 2 ^ 126 - 1 = 2 ^ 126 - 1)
  \/ (long_inputs = short_inputs /\ (before_guess ++ behind_guess)%list = C_short /\ 62 = 23 /\ 2 ^ 126 - 1 = 2 ^ 46).
Proof. left; repeat split; reflexivity. Qed.
Lemma is_new_name now n : new_names now = true -> is_in n (declared a_turn) = true -> look n now = None.
Proof.
  intros N I; unfold new_names in N; rewrite forallb_forall in N; unfold is_in in I; apply existsb_exists in I as (m & I & E); apply String.eqb_eq in E; subst m.
  specialize (N n I); destruct (look n now); [discriminate | reflexivity].
Qed.

(** Names that are not changed. *)
Lemma is_in_less n l l' : forallb (fun m => is_in m l) l' = true -> is_in n l = false -> is_in n l' = false.
Proof.
  intros F N; destruct (is_in n l') eqn:E; [| reflexivity]; unfold is_in in E; apply existsb_exists in E as (m & I & E); apply String.eqb_eq in E; subst m.
  rewrite forallb_forall in F; rewrite (F n I) in N; discriminate.
Qed.
Lemma next_state now now' M e M' e' k : keeps now now' -> holds_number now' "M" M' -> holds_number now' "e" e' -> in_turn now k M e -> in_turn (outside a_turn now') k M' e'.
Proof.
  intros Keep LM Le S.
  assert (same : forall n, is_in n changed = false -> look n (outside a_turn now') = look n now).
  { intros n N; rewrite look_outside, (is_in_less n changed (declared a_turn) ltac:(vm_compute; reflexivity) N); apply Keep, N. }
  destruct S as [B Side _ _ K (d & d' & D) (t & t' & T) H _]; constructor.
  - intros n w E; destruct (B n w E) as (Kw & L & R); split; [exact Kw |]; split; [| exact R].
    assert (A : forallb (fun p => negb (is_in (fst p) changed)) first_widths = true) by (vm_compute; reflexivity).
    apply look_in in E; rewrite forallb_forall in A; rewrite same; [exact L | apply negb_true_iff, (A (n, w) E)].
  - unfold side_is_known; rewrite same by (vm_compute; reflexivity); exact Side.
  - destruct LM as [LM BM]; split; [| exact BM]; rewrite look_outside; exact LM.
  - destruct Le as [Le Be]; split; [| exact Be]; rewrite look_outside; exact Le.
  - rewrite same by (vm_compute; reflexivity); exact K.
  - exists d, d'; rewrite same by (vm_compute; reflexivity); exact D.
  - exists t, t'; rewrite same by (vm_compute; reflexivity); exact T.
  - rewrite same by (vm_compute; reflexivity); exact H.
  - unfold new_names; apply forallb_forall; intros n I; rewrite look_outside.
    assert (E : is_in n (declared a_turn) = true) by (unfold is_in; apply existsb_exists; exists n; split; [exact I | apply String.eqb_refl]); rewrite E; reflexivity.
Qed.

Section Turn.
Variables (M e : Z) (now : environment).
Hypothesis State : exists k, in_turn now k M e.
Definition num_in_turn := guessed inside before_guess behind_guess ls M e.
Definition v_in_turn := guessed_v inside before_guess behind_guess ls M e.
Notation num := num_in_turn.
Local Opaque guessed guessed_v before before_v.

Lemma turn_runs_steps l from count : l = firstn count (skipn from behind_guess) -> Forall (runs num v_in_turn inside) l.
Proof.
  intros ->; apply Forall_forall; intros s I.
  refine (proj1 (Forall_forall _ _) (guessed_runs inside before_guess behind_guess ls steps_ordered guess_apart M e) s _).
  apply in_or_app; right; rewrite <- (firstn_skipn from behind_guess); apply in_or_app; right; rewrite <- (firstn_skipn count (skipn from behind_guess)); apply in_or_app; left; exact I.
Qed.
Lemma guess_in_turn : num "M" = M /\ num "e" = e.
Proof.
  assert (G : (num "M" = M /\ v_in_turn "M" = M) /\ num "e" = e /\ v_in_turn "e" = e) by (apply guess_is; vm_compute; reflexivity).
  split; apply G.
Qed.
Lemma alike_in_turn n w : In (n, w) first_widths -> num n = base n.
Proof.
  intros I; refine (proj1 (guessed_before inside before_guess behind_guess ls M e n _)).
  assert (A : forallb (fun p => negb (is_later behind_guess (fst p))) first_widths = true) by (vm_compute; reflexivity).
  rewrite forallb_forall in A; apply negb_true_iff, (A (n, w) I).
Qed.
Lemma turn_begins : sound num guess_widths now.
Proof.
  destruct State as (k & [B _ [LM BM] [Le Be] _ _ _ _ _]); pose proof (sound_alike base num first_widths now B alike_in_turn) as S; destruct guess_in_turn as [EM Ee].
  intros n w E; cbn [guess_widths look] in E; destruct (String.eqb_spec "e" n) as [<- | De].
  - injection E as <-; split; [right; left; reflexivity |]; rewrite Ee; split; [exact Le | split; [apply Be | apply Z.lt_trans with (2 ^ 126); [apply Be | reflexivity]]].
  - destruct (String.eqb_spec "M" n) as [<- | DM]; [| exact (S n w E)].
    injection E as <-; split; [right; left; reflexivity |]; rewrite EM; split; [exact LM | split; [apply BM | apply Z.lt_trans with (2 ^ 126); [apply BM | reflexivity]]].
Qed.
Lemma new_steps l : forallb (fun s => is_in (name s) (declared a_turn)) l = true -> forallb (fun s => match look (name s) now with None => true | _ => false end) l = true.
Proof.
  destruct State as (k & S); intros H; apply forallb_forall; intros s I; rewrite forallb_forall in H; rewrite (is_new_name now _ (turn_new _ _ _ _ S) (H s I)); reflexivity.
Qed.

Definition now_two := after num guess_widths two_equations now.
Lemma two_run f rest : go known [] (9 + f) now (steps_in guess_widths two_equations ++ rest)%list = go known [] f now_two rest /\ sound num turn_widths now_two.
Proof.
  destruct State as (k & S).
  apply (steps_run num v_in_turn inside [] known Known two_equations guess_widths turn_widths); [vm_compute; reflexivity | exact turn_begins | intros _; exact (turn_side _ _ _ _ S)
    | apply new_steps; vm_compute; reflexivity | vm_compute; reflexivity | apply (turn_runs_steps _ 0 9); reflexivity].
Qed.
Definition now_three := after num turn_widths third_equation now_two.
Lemma three_run f rest : go known [] (20 + f) now_two (steps_in turn_widths third_equation ++ rest)%list = go known [] f now_three rest /\ sound num last_widths now_three.
Proof.
  destruct State as (k & S).
  apply (steps_run num v_in_turn inside [] known Known third_equation turn_widths last_widths); [vm_compute; reflexivity | exact (proj2 (two_run 0 []))
    | intros _; unfold knows_side, now_two; rewrite after_other by (vm_compute; reflexivity); exact (turn_side _ _ _ _ S)
    | | vm_compute; reflexivity | apply (turn_runs_steps _ 9 20); reflexivity].
  assert (A : forallb (fun s => negb (existsb (fun t => String.eqb (name t) (name s)) two_equations)) third_equation = true) by (vm_compute; reflexivity).
  apply forallb_forall; intros s I; unfold now_two; rewrite after_other by (apply negb_true_iff, (proj1 (forallb_forall _ _) A s I)).
  exact (proj1 (forallb_forall _ _) (new_steps third_equation ltac:(vm_compute; reflexivity)) s I).
Qed.

(** What a turn answers, or the numbers of the next. *)
Definition all_zero := (num "r1" =? 0) && (num "r2" =? 0).
Lemma side_in_three : eval known now_three (Named "inner") = Some (Of Int (if inside then 1 else 0)).
Proof.
  destruct State as (k & S); apply eval_named; unfold now_three, now_two; rewrite !after_other by (vm_compute; reflexivity); exact (turn_side _ _ _ _ S).
Qed.
Definition answer_in_turn := if num "r3" =? 0 then if inside then if 2 ^ 255 <=? num "room_within" then 2 else -1
  else if (2 ^ 255 <=? num "beyond") || (2 ^ 255 <=? num "room_without") then 2 else 1 else 2.
Lemma answers_run f rest : go known [] (3 + f) now_three (answers_side ++ rest)%list = Some (Some (Of Int answer_in_turn), now_three).
Proof.
  pose proof (proj2 (three_run 0 [])) as S; pose proof side_in_three as Side; set (now3 := now_three) in *; clearbody now3.
  unfold answers_side, answer_in_turn; cbn [Nat.add app].
  assert (Third : eval known now3 (Infix "==" (is_zero_long "r3") (Constant Int 0)) = Some (Of Int (if num "r3" =? 0 then 0 else 1))).
  { eapply eval_infix; [reflexivity | apply (ask_zero num known Known), S; vm_compute; reflexivity | reflexivity |]; destruct (num "r3" =? 0); reflexivity. }
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ Third); destruct (num "r3" =? 0); cbn [Z.eqb app]; [| reflexivity].
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ Side).
  assert (T : forall n, look n last_widths = Some 256 -> eval known now3 (is_negative_long n) = Some (Of Int (if 2 ^ 255 <=? num n then 1 else 0)))
    by (intros n L; apply (ask_long num known Known), S, L).
  destruct inside; cbn [Z.eqb app].
  - rewrite (go_return _ _ _ _ _ _ (Of Int (if 2 ^ 255 <=? num "room_within" then 2 else -1))); [reflexivity |].
    rewrite (eval_chosen _ _ _ _ _ _ _ (T "room_within" ltac:(vm_compute; reflexivity))); destruct (2 ^ 255 <=? num "room_within"); reflexivity.
  - rewrite (go_return _ _ _ _ _ _ (Of Int (if (2 ^ 255 <=? num "beyond") || (2 ^ 255 <=? num "room_without") then 2 else 1))); [reflexivity |].
    pose proof (T "beyond" ltac:(vm_compute; reflexivity)) as B; pose proof (T "room_without" ltac:(vm_compute; reflexivity)) as C.
    rewrite (eval_chosen _ _ _ _ _ _ _ (eval_or _ _ _ _ _ _ _ _ B C)); destruct (2 ^ 255 <=? num "beyond"), (2 ^ 255 <=? num "room_without"); reflexivity.
Qed.
Lemma answer_is_side : all_zero = true -> is_side ls answer_in_turn.
Proof.
  destruct State as (k & S); pose proof (turn_M _ _ _ _ S) as [_ BM]; pose proof (turn_e _ _ _ _ S) as [_ Be].
  assert (T : num "r1" = 0 -> num "r2" = 0 -> num "r3" = 0 -> (if inside then ~ 2 ^ 255 <= num "room_within"
    else ~ 2 ^ 255 <= num "beyond" /\ ~ 2 ^ 255 <= num "room_without") -> touches inside ls)
    by exact (passed inside ls M e 62 (2 ^ 126 - 1) long_inputs before_guess behind_guess steps_are steps_ordered guess_apart Lengths Sizes
      (conj (proj1 BM) (proj1 (Z.lt_le_pred _ _) (proj2 BM))) (conj (proj1 Be) (proj1 (Z.lt_le_pred _ _) (proj2 Be)))).
  unfold all_zero, answer_in_turn; generalize dependent num_in_turn; clear; intros num T A; apply andb_prop in A as [Z1 Z2]; apply Z.eqb_eq in Z1, Z2.
  destruct (Z.eqb_spec (num "r3") 0) as [Z3 |]; [| left; reflexivity]; specialize (T Z1 Z2 Z3); destruct inside.
  - destruct (Z.leb_spec (2 ^ 255) (num "room_within")); [left; reflexivity | right; exists true; split; [reflexivity | apply T; lia]].
  - destruct (Z.leb_spec (2 ^ 255) (num "beyond")), (Z.leb_spec (2 ^ 255) (num "room_without")); cbn [orb]; try (left; reflexivity).
    right; exists false; split; [reflexivity | apply T; lia].
Qed.

Theorem turn_run F : (48 <= F)%nat -> (exists r now', go known [] F now a_turn = Some (Some (Of Int r), now') /\ is_side ls r) \/
  exists M' e' now', go known [] F now a_turn = Some (None, now') /\ forall k, in_turn now k M e -> in_turn (outside a_turn now') k M' e'.
Proof.
  intros Fuel; replace F with (9 + S (20 + (18 + (F - 48))))%nat by lia; set (f := (F - 48)%nat); clearbody f; clear F Fuel.
  assert (G : go known [] (9 + S (20 + (18 + f))) now a_turn = go known [] (S (20 + (18 + f))) now_two (If (Infix "&&" (is_zero_long "r1") (is_zero_long "r2"))
    (steps_in turn_widths third_equation ++ answers_side) [] :: newton ++ next_guess)%list) by apply two_run.
  rewrite G; clear G; pose proof (proj2 (two_run 0 [])) as S2.
  assert (both : eval known now_two (Infix "&&" (is_zero_long "r1") (is_zero_long "r2")) = Some (Of Int (bit all_zero))).
  { apply eval_both; apply (ask_zero num known Known), S2; vm_compute; reflexivity. }
  rewrite (go_if _ _ _ _ _ _ _ _ _ both); destruct all_zero eqn:A.
  - left; exists answer_in_turn, now_three; split; [| apply answer_is_side; exact A].
    rewrite <- app_assoc, (proj1 (three_run _ _)); change (18 + f)%nat with (3 + (15 + f))%nat; apply answers_run.
  - destruct State as (k & S); cbn [app]; change (20 + (18 + f))%nat with (10 + (8 + (20 + f)))%nat.
    destruct (S2 "r1" 256 ltac:(vm_compute; reflexivity)) as (_ & L1 & _), (S2 "r2" 256 ltac:(vm_compute; reflexivity)) as (_ & L2 & _).
    assert (kept : forall n, existsb (fun s => String.eqb (name s) n) two_equations = false -> look n now_two = look n now) by (intros n N; exact (after_other num two_equations guess_widths now n N)).
    destruct (turn_d _ _ _ _ S) as (d & d' & D), (turn_most _ _ _ _ S) as (t & t' & T), (turn_M _ _ _ _ S) as [LM BM], (turn_e _ _ _ _ S) as [Le Be].
    destruct (newton_run float less nearest word inside (20 + f) now_two M e _ _ d d' t t' L1 L2) as [(now' & ->) | (M' & e' & now' & -> & HM & He & Keep)];
      try (rewrite kept by (vm_compute; reflexivity)).
    + exact D.
    + exact T.
    + exact (turn_half _ _ _ _ S).
    + unfold side_is_known; rewrite kept by (vm_compute; reflexivity); exact (turn_side _ _ _ _ S).
    + split; [rewrite kept by (vm_compute; reflexivity); exact LM | exact BM].
    + split; [rewrite kept by (vm_compute; reflexivity); exact Le | exact Be].
    + apply is_new_name; [exact (turn_new _ _ _ _ S) | vm_compute; reflexivity].
    + apply is_new_name; [exact (turn_new _ _ _ _ S) | vm_compute; reflexivity].
    + left; exists 2, now'; split; [reflexivity | left; reflexivity].
    + right; exists M', e', now'; split; [reflexivity |]; intros j; apply next_state; [| exact HM | exact He].
      intros n N; rewrite Keep by (apply (is_in_less n changed); [vm_compute; reflexivity | exact N]); apply kept.
      pose proof (is_in_less n changed (map name two_equations) ltac:(vm_compute; reflexivity) N) as O; unfold is_in in O.
      apply not_true_iff_false; intros E; apply existsb_exists in E as (x & I & E); apply String.eqb_eq in E; subst n.
      apply not_true_iff_false in O; apply O, existsb_exists; exists (name x); split; [apply in_map; exact I | apply String.eqb_refl].
Qed.
End Turn.

(** All turns. *)
Lemma turn_counted now k j M e : in_turn now k M e -> in_turn (("turn", Of Int j) :: now) j M e.
Proof.
  intros [B Side LM Le _ D T H New]; constructor; try assumption; try reflexivity.
  - intros n w E; destruct (B n w E) as (K & L & R); split; [exact K |]; split; [| exact R].
    assert (A : forallb (fun p => negb (String.eqb "turn" (fst p))) first_widths = true) by (vm_compute; reflexivity).
    apply look_in in E; rewrite forallb_forall in A; specialize (A (n, w) E); apply negb_true_iff in A; cbn [fst] in A; cbn [look]; rewrite A; exact L.
Qed.
Theorem turns_run left : forall F now k M e, in_turn now k M e -> 0 <= k <= 4 -> Z.of_nat left = 4 - k -> (S left + 48 <= F)%nat ->
  exists r now', go known [] F now [turns; Returns two] = Some (Some (Of Int r), now') /\ is_side ls r.
Proof.
  induction left as [| n IH]; intros F now k M e State K Left Fuel; destruct F as [| F]; try lia; unfold turns; cbn [go].
  - assert (E : eval known now (Infix "<" (Named "turn") (Constant Int 4)) = Some (Of Int 0)).
    { eapply eval_infix; [reflexivity | apply eval_named, (turn_k _ _ _ _ State) | reflexivity |]; replace k with 4 by lia; reflexivity. }
    rewrite E; cbn [Z.eqb]; destruct F as [| F]; try lia; exists 2, now; split; [reflexivity | left; reflexivity].
  - assert (E : eval known now (Infix "<" (Named "turn") (Constant Int 4)) = Some (Of Int 1)).
    { eapply eval_infix; [reflexivity | apply eval_named, (turn_k _ _ _ _ State) | reflexivity |].
      unfold plain_infix; cbn; unfold carry; rewrite (proj2 (Z.ltb_lt k 4)) by lia; reflexivity. }
    rewrite E; cbn [Z.eqb]; destruct (turn_run M e now (ex_intro _ k State) F ltac:(lia)) as [(r & now' & -> & Side) | (M' & e' & now' & -> & Next)]; [exists r, now'; split; [reflexivity | exact Side] |].
    pose proof (Next k State) as S; clear Next.
    assert (P : eval known (outside a_turn now') (Infix "+" (Named "turn") (Constant Int 1)) = Some (Of Int (k + 1))).
    { eapply eval_infix; [reflexivity | apply eval_named, (turn_k _ _ _ _ S) | reflexivity |]; unfold plain_infix; cbn.
      unfold in_int; rewrite (proj2 (Z.leb_le _ _)), (proj2 (Z.ltb_lt _ _)) by lia; reflexivity. }
    rewrite P; cbn [bound]; apply (IH F (("turn", Of Int (k + 1)) :: outside a_turn now') (k + 1) M' e'); [exact (turn_counted _ _ _ _ _ S) | lia | lia | lia].
Qed.
End Run.

(** ** From its beginning. *)

Section Text.
Variables (float : string -> list datum -> Z) (less : datum -> datum -> bool) (nearest word : Z -> Z) (ls : string -> Z) (about : datum).
Hypotheses (About : is_float about) (Lengths : forall n, In n named -> 0 <= ls n < 2 ^ 62) (Sizes : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < ls n).
Notation known := (of_touching float less nearest word).
Notation made_by := (made_by float).
Let Known := longs_are_known float less nearest word.
(** A guess below 2^125 is nearest to a whole number below 2^126. *)
Definition limit := Opaque "4.2535295865117308e37" 0.
Definition value_of n := made_by "hc_fixed_value" [Fix (words_of n)].
Definition is_nearest d := match d with Opaque _ k => less d limit = true -> 0 <= nearest k < 2 ^ 126 | _ => True end.
Hypothesis Nearest : forall size n, is_float size -> 0 <= n < 2 ^ 124 -> less (Of Int 0) size = true -> is_nearest (made_by "*" [size; value_of n]) /\ is_nearest (made_by "/" [value_of n; size]).

Definition side_of_guess := less about (Of Int 0).
Notation num := (base ls side_of_guess).
Notation num_v := (before_v side_of_guess before_guess ls).

Definition begun : environment := fold_left (fun now n => (n, Of U64 (ls n)) :: now) named
  (("about", about) :: map (fun p => (String.append "lengths." (fst p), snd p)) (words_of_lengths ls) ++ literals)%list.
Lemma beginning_runs f rest now : bound_all (map Named ["lengths"; "about"]) [Rec (words_of_lengths ls); about] literals = Some now ->
  go known [] (7 + f) now (names_lengths 7 ++ rest)%list = go known [] f begun rest.
Proof.
  cbn [bound_all map]; rewrite (bound_float _ _ _ About); intros E; injection E as <-.
  cbv [names_lengths named StageThreeRuns.lengths combine map firstn app fst snd words_of_lengths bound append]; cbn [Nat.add].
  do 7 (erewrite go_put; [| reflexivity | reflexivity | reflexivity]; cbv [bound app map fst snd append]); reflexivity.
Qed.
Lemma num_begins n : In n named -> num n = ls n.
Proof. intros I; unfold base, before; rewrite computed_same; destruct I as [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]; reflexivity. Qed.
Lemma products_below : 0 <= num "D" < 2 ^ 124 /\ 0 <= num "K" < 2 ^ 124.
Proof.
  assert (D : num "D" = ls "b" * ls "d") by reflexivity; assert (K : num "K" = ls "alpha" * ls "gamma") by reflexivity; rewrite D, K; change (2 ^ 124) with (2 ^ 62 * 2 ^ 62).
  pose proof (Lengths "b" ltac:(cbn; tauto)); pose proof (Lengths "d" ltac:(cbn; tauto)); pose proof (Lengths "alpha" ltac:(cbn; tauto)); pose proof (Lengths "gamma" ltac:(cbn; tauto)).
  split; split; first [apply Z.mul_nonneg_nonneg; lia | apply Z.mul_lt_mono_nonneg; lia].
Qed.
Local Opaque before before_v base.
Lemma begun_sound : sound num (of_lengths 7) begun.
Proof.
  intros n w E; apply look_in, in_map_iff in E as (k & E & I); injection E as -> <-; assert (J : In n named) by (cbn in I |- *; tauto).
  split; [left; reflexivity |]; rewrite (num_begins n J); split; [| pose proof (Lengths n J); lia].
  clear J; cbn in I; repeat destruct I as [<- | I]; try contradiction; reflexivity.
Qed.
Lemma first_runs l : (forall s, In s l -> In s before_guess) -> Forall (runs num num_v side_of_guess) l.
Proof. intros H; apply Forall_forall; intros s I; exact (proj1 (Forall_forall _ _) (before_runs side_of_guess before_guess behind_guess ls steps_ordered) s (H s I)). Qed.

Definition sided := ("inner", Of Int (if side_of_guess then 1 else 0)) :: after num (of_lengths 7) before_side begun.
Definition multiplied := after num side_widths behind_side sided.
Lemma before_runs_here f rest : go known [] (14 + S (3 + f)) begun (steps_in (of_lengths 7) before_side ++ is_side_inner :: steps_in side_widths behind_side ++ rest)%list
  = go known [] f multiplied rest /\ sound num first_widths multiplied.
Proof.
  destruct (steps_run num num_v side_of_guess [] known Known before_side (of_lengths 7) side_widths (steps_in (of_lengths 7) before_side) begun (S (3 + f))
    (is_side_inner :: steps_in side_widths behind_side ++ rest)%list) as [G S1]; [vm_compute; reflexivity | exact begun_sound | discriminate | vm_compute; reflexivity | vm_compute; reflexivity | |].
  { apply first_runs; intros s I; change before_guess with (before_side ++ skipn 14 before_guess)%list; apply in_or_app; left; exact I. }
  change (List.length before_side) with 14%nat in G; rewrite G; clear G; unfold is_side_inner.
  rewrite (go_put _ _ _ _ "int" "inner" _ _ (Of Int (if side_of_guess then 1 else 0)) (Of Int (if side_of_guess then 1 else 0))); [| vm_compute; reflexivity | | destruct side_of_guess; reflexivity].
  2: { refine (proj1 (eval_below float less nearest word _ (Named "about") (Constant Int 0) about (Of Int 0) About (andb_false_r _) _ _)); [apply eval_named | reflexivity].
    rewrite after_other by (vm_compute; reflexivity); reflexivity. }
  change (bound "inner" ?d ?now) with (("inner", d) :: now); fold sided.
  apply (steps_run num num_v side_of_guess [] known Known behind_side side_widths first_widths (steps_in side_widths behind_side) sided f rest);
    [vm_compute; reflexivity | | discriminate | vm_compute; reflexivity | vm_compute; reflexivity |].
  - exact (sound_pushed num side_widths [("inner", Of Int (if side_of_guess then 1 else 0))] _ S1 ltac:(vm_compute; reflexivity)).
  - apply first_runs; intros s I; change before_guess with (firstn 15 before_guess ++ behind_side)%list; apply in_or_app; right; exact I.
Qed.

(** The floats, and the first M and e. *)
Definition size_of_guess := if side_of_guess then made_by "-" [Of Int 0; about] else about.
Definition m_of_guess := made_by "*" [size_of_guess; value_of (num "D")].
Definition e_of_guess := made_by "/" [value_of (num "K"); size_of_guess].
Definition is_in_range := less (Of Int 0) size_of_guess && less m_of_guess limit && less e_of_guess limit.
Definition floats_of_guess := [("e_", e_of_guess); ("m_", m_of_guess); ("most", limit); ("size", size_of_guess); ("k_", value_of (num "K")); ("d_", value_of (num "D"))].
Lemma size_is_float : is_float size_of_guess.
Proof. unfold size_of_guess; destruct side_of_guess; [exact I | exact About]. Qed.
Lemma nearest_is now n o given : look n now = Some (made_by o given) -> 0 <= nearest (float o given) < 2 ^ 126 -> eval known now (nearest_to n) = Some (Fix (words_of (nearest (float o given)))).
Proof.
  intros E B; unfold nearest_to; eapply eval_given; [reflexivity | apply given_more; [apply eval_named, E | reflexivity] |]; cbn.
  rewrite Z.mod_small; [reflexivity |]; split; [apply B | apply Z.lt_trans with (2 ^ 126); [apply B | reflexivity]].
Qed.
Lemma guess_run f rest : (exists now', go known [] (9 + f) multiplied (guess ++ rest)%list = Some (Some (Of Int 2), now')) \/
  exists M e, 0 <= M < 2 ^ 126 /\ 0 <= e < 2 ^ 126 /\ go known [] (9 + f) multiplied (guess ++ rest)%list
    = go known [] f (("e", Fix (words_of e)) :: ("M", Fix (words_of M)) :: floats_of_guess ++ multiplied)%list rest.
Proof.
  pose proof (proj2 (before_runs_here 0 [])) as S; pose proof size_is_float as F; destruct products_below as [BD BK].
  assert (D_is : look "D" multiplied = Some (Fix (words_of (num "D")))) by (apply (S "D" 128); vm_compute; reflexivity).
  assert (K_is : look "K" multiplied = Some (Fix (words_of (num "K")))) by (apply (S "K" 128); vm_compute; reflexivity).
  assert (about_is : look "about" multiplied = Some about) by (vm_compute; reflexivity).
  assert (inner_is : look "inner" multiplied = Some (Of Int (if side_of_guess then 1 else 0))) by (vm_compute; reflexivity).
  assert (most_is : look "_4.2535295865117308e37" multiplied = Some limit) by (vm_compute; reflexivity).
  assert (New : forall n, In n ["d_"; "k_"; "size"; "most"; "m_"; "e_"] -> look n multiplied = None)
    by (intros n I; repeat destruct I as [<- | I]; try contradiction; vm_compute; reflexivity).
  clear S; unfold floats_of_guess; set (now := multiplied) in *; clearbody now; unfold guess; cbn [Nat.add app].
  Ltac is_new_in New := lazymatch goal with |- is_new _ ?n _ = true => unfold is_new; cbn [look String.eqb Ascii.eqb Bool.eqb]; rewrite (New n ltac:(cbn; tauto)); reflexivity end.
  assert (value_is : forall now n z, look n now = Some (Fix (words_of z)) -> eval known now (as_float n) = Some (value_of z))
    by (intros a n z E; unfold as_float; eapply eval_given; [reflexivity | apply given_more; [apply eval_named, E | reflexivity] | reflexivity]).
  rewrite (go_put _ _ _ _ "double" "d_" _ _ (value_of (num "D")) (value_of (num "D"))); [| is_new_in New | apply value_is, D_is | reflexivity].
  change (bound "d_" ?d ?a) with (("d_", d) :: a).
  rewrite (go_put _ _ _ _ "double" "k_" _ _ (value_of (num "K")) (value_of (num "K"))); [| is_new_in New | apply value_is; exact K_is | reflexivity].
  change (bound "k_" ?d ?a) with (("k_", d) :: a).
  rewrite (go_put _ _ _ _ "double" "size" _ _ size_of_guess size_of_guess); [| is_new_in New | | apply held_float, F].
  2: { rewrite (eval_chosen _ _ _ _ _ Int (if side_of_guess then 1 else 0)) by (apply eval_named; exact inner_is); unfold size_of_guess; destruct side_of_guess; cbn [Z.eqb]; [| apply eval_named; exact about_is].
    unfold opposite; cbn [eval look String.eqb Ascii.eqb Bool.eqb]; rewrite about_is; destruct about; try contradiction; reflexivity. }
  rewrite bound_float by exact F.
  rewrite (go_put _ _ _ _ "double" "most" _ _ limit limit); [| is_new_in New | apply eval_named; exact most_is | reflexivity].
  change (bound "most" ?d ?a) with (("most", d) :: a).
  rewrite (go_put _ _ _ _ "double" "m_" _ _ m_of_guess m_of_guess); [| is_new_in New | | reflexivity].
  2: { apply eval_operation; [reflexivity | exact F | apply andb_false_r | reflexivity | reflexivity]. }
  change (bound "m_" ?d ?a) with (("m_", d) :: a).
  rewrite (go_put _ _ _ _ "double" "e_" _ _ e_of_guess e_of_guess); [| is_new_in New | | reflexivity].
  2: { apply eval_operation; [reflexivity | exact I | reflexivity | reflexivity | reflexivity]. }
  change (bound "e_" ?d ?a) with (("e_", d) :: a).
  set (now2 := ("e_", _) :: _).
  assert (C : eval known now2 in_range = Some (Of Int (bit is_in_range))).
  { pose proof (proj2 (eval_below float less nearest word now2 (Named "size") (Constant Int 0) size_of_guess (Of Int 0) F (andb_false_r _) eq_refl eq_refl)) as C1.
    pose proof (proj1 (eval_below float less nearest word now2 (Named "m_") (Named "most") m_of_guess limit I eq_refl eq_refl eq_refl)) as C2.
    pose proof (proj1 (eval_below float less nearest word now2 (Named "e_") (Named "most") e_of_guess limit I eq_refl eq_refl eq_refl)) as C3.
    exact (eval_both known now2 _ _ _ _ (eval_both known now2 _ _ _ _ C1 C2) C3). }
  assert (N : eval known now2 (Infix "==" in_range (Constant Int 0)) = Some (Of Int (if is_in_range then 0 else 1)))
    by (eapply eval_infix; [reflexivity | exact C | reflexivity |]; destruct is_in_range; reflexivity).
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ N); clear C N; destruct is_in_range eqn:R; cbn [Z.eqb app]; [right | left; eexists; reflexivity].
  unfold is_in_range in R; apply andb_prop in R as [R Re]; apply andb_prop in R as [R Rm].
  destruct (Nearest size_of_guess (num "D") F BD R) as [NM _], (Nearest size_of_guess (num "K") F BK R) as [_ Ne]; specialize (NM Rm); specialize (Ne Re).
  exists (nearest (float "*" [size_of_guess; value_of (num "D")])), (nearest (float "/" [value_of (num "K"); size_of_guess])).
  split; [exact NM |]; split; [exact Ne |].
  rewrite (go_put _ _ _ _ "" "M" _ _ _ _ eq_refl (nearest_is now2 "m_" "*" [size_of_guess; value_of (num "D")] eq_refl NM) eq_refl); cbn [bound].
  rewrite (go_put _ _ _ _ "" "e" _ _ _ _ eq_refl (nearest_is (("M", _) :: now2) "e_" "/" [value_of (num "K"); size_of_guess] eq_refl Ne) eq_refl); reflexivity.
Qed.

(** What its text returns, for lengths below 2^62: a side from which the row touches, or 2. *)
Theorem touches_text : exists r, called_on float less nearest word functions "hc_touches_by" [Rec (words_of_lengths ls); about] = Some (Of Int r) /\ is_side ls r.
Proof.
  unfold called_on; rewrite text_is; cbn [takes does].
  destruct (bound_all (map Named ["lengths"; "about"]) [Rec (words_of_lengths ls); about] literals) as [now |] eqn:E;
    [| exfalso; revert E; cbn [bound_all map]; rewrite (bound_float _ _ _ About); discriminate].
  change steps with (7 + (14 + S (3 + (9 + 66))))%nat; rewrite (beginning_runs _ _ _ E), (proj1 (before_runs_here _ _)); clear E now.
  destruct (guess_run 66 [Set_ "" "turn" (Constant Int 0); turns; Returns two]) as [(now & ->) | (M & e & BM & Be & ->)]; [exists 2; split; [reflexivity | left; reflexivity] |].
  change 66%nat with (S 65); erewrite (go_put _ _ _ _ "" "turn"); [| reflexivity | reflexivity | reflexivity]; cbn [bound].
  set (pushed := ("turn", Of Int 0) :: ("e", Fix (words_of e)) :: ("M", Fix (words_of M)) :: floats_of_guess); change (("turn", Of Int 0) :: _) with (pushed ++ multiplied)%list.
  assert (State : in_turn ls side_of_guess (pushed ++ multiplied)%list 0 M e).
  { constructor.
    - exact (sound_pushed num first_widths pushed multiplied (proj2 (before_runs_here 0 [])) ltac:(vm_compute; reflexivity)).
    - unfold side_is_known; rewrite look_pushed by (vm_compute; reflexivity); vm_compute; reflexivity.
    - split; [reflexivity | exact BM].
    - split; [reflexivity | exact Be].
    - reflexivity.
    - do 2 eexists; reflexivity.
    - do 2 eexists; reflexivity.
    - rewrite look_pushed by (vm_compute; reflexivity); vm_compute; reflexivity.
    - vm_compute; reflexivity. }
  destruct (turns_run float less nearest word ls side_of_guess Lengths Sizes 4 65 _ 0 M e State ltac:(lia) ltac:(lia) ltac:(lia)) as (r & now & -> & Side).
  exists r; split; [reflexivity | exact Side].
Qed.
End Text.

(** Each of its answers occurs, where a guess of 1 is right: for a unit sphere 2 from the axis of the unit hyperboloid, which touches it
    from without, one in its centre, which touches it from within, and one that crosses it. *)
Definition answer_at (less : datum -> datum -> bool) l := called_on (fun _ _ => 0) less (fun _ => 1) (fun _ => 1) functions "hc_touches_by"
  [Rec (words_of_lengths (fun n => match look n (combine named l) with Some z => z | None => 0 end)); Opaque "" 0].
Definition above_0 (_ c : datum) := match c with Of _ _ => false | _ => true end.
Theorem every_answer_occurs : [answer_at above_0 [1; 1; 1; 1; 2; 0; 0]; answer_at (fun _ _ => true) [1; 1; 1; 1; 0; 0; 0]; answer_at above_0 [1; 1; 1; 1; 1; 0; 0]]
  = map (fun z => Some (Of Int z)) [1; -1; 2].
Proof. vm_compute; reflexivity. Qed.
