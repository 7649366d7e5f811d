(** Stage 4: the function of the header that proves a tangency of short lengths, run by Coq: where it answers with a side, the row
    touches from there, whatever the guess of the double root is. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed FixedRuns Long Limbs LimbsRuns Trees PlainerTexts StageThreeRuns StageThreeAnswers StageFour StageFourSteps StageFourGuesses.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** The text of the functions. *)
Definition functions := Eval vm_compute in
  match every (map (fun text => read_from (string_of text)) HeaderText.beside_tangency) with Some l => l | None => [] end.

Definition before_guess := Eval vm_compute in firstn 3 C_short.
Definition behind_guess := Eval vm_compute in skipn 3 C_short.
Definition products := Eval vm_compute in skipn 1 before_guess.
Definition with_products := Eval vm_compute in widths_after (of_lengths 7) products.
Definition guess_widths := ("e", 64) :: ("M", 64) :: with_products.

Definition two := Constant Int 2.
Definition minus_one := Infix "-" (Constant Int 0) (Constant Int 1).
Definition most := Named "_70368744177664.0".
Definition in_range := Infix "&&" (Infix "&&" (Infix ">" (Named "size") (Constant Int 0)) (Infix "<" (Named "m_") (Named "most"))) (Infix "<" (Named "e_") (Named "most")).
Definition half_more n := Called "as_word" [Infix "+" (Named n) (Named "_0.5")].
Definition words n := [Part (Named n) (Constant Int 0); Part (Named n) (Constant Int 1)].
Definition any_word := fold_left (Infix "|") (tl (words "r1") ++ words "r2" ++ words "r3")%list (Part (Named "r1") (Constant Int 0)).
Definition guess := [
  Set_ "double" "size" (Choice (Named "inner") (Infix "-" (Constant Int 0) (Named "about")) (Named "about"));
  Set_ "double" "m_" (Infix "*" (Named "size") (Called "as_double" [Named "D"])); Set_ "double" "e_" (Infix "/" (Called "as_double" [Named "K"]) (Named "size"));
  Set_ "double" "most" most; If (Infix "==" in_range (Constant Int 0)) [Returns two] []; Set_ "" "M" (half_more "m_"); Set_ "" "e" (half_more "e_")].
Definition verdict := [If any_word [Returns two] []; If (Named "inner") [Returns (Choice (is_negative_fixed "room_within") two minus_one)] [];
  Returns (Choice (Infix "||" (is_negative_fixed "beyond") (is_negative_fixed "room_without")) two (Constant Int 1))].
Theorem text_is : look "hc_touches_by_short" functions = Some (Deciding ["lengths"; "about"] (names_lengths 7
  ++ Set_ "int" "inner" (Infix "<" (Named "about") (Constant Int 0)) :: steps_in (of_lengths 7) products ++ guess ++ steps_in guess_widths behind_guess ++ verdict)).
Proof. vm_compute; reflexivity. Qed.

(** Its run, for any floats. *)
Section Run.
Variables (float : string -> list datum -> Z) (less : datum -> datum -> bool) (nearest word : Z -> Z) (ls : string -> Z) (about : datum).
Hypotheses (About : is_float about) (Lengths : forall n, In n named -> 0 <= ls n < 2 ^ 23).
Notation known := (of_touching float less nearest word).
Notation made_by := (made_by float).
Definition inner := less about (Of Int 0).

(** Patterns before the guess, and with it. *)
Variables base base_v num v : string -> Z.
Hypotheses (Begins : forall n, In n named -> base n = ls n) (Base_runs : Forall (runs base base_v inner) products)
  (Runs : Forall (runs num v inner) behind_guess) (Alike : forall n w, In (n, w) with_products -> num n = base n).

Definition size_of_guess := if inner then made_by "-" [Of Int 0; about] else about.
Definition double_of n := made_by "as_double" [Of U64 n].
Definition m_of_guess := made_by "*" [size_of_guess; double_of (base "D")].
Definition e_of_guess := made_by "/" [double_of (base "K"); size_of_guess].
Definition limit := Opaque "70368744177664.0" 0.
Definition is_in_range := less (Of Int 0) size_of_guess && less m_of_guess limit && less e_of_guess limit.
Definition rounded d := word (float "+" [d; Opaque "0.5" 0]) mod W.
Hypothesis Guess : is_in_range = true -> num "M" = rounded m_of_guess /\ num "e" = rounded e_of_guess.

Definition side := if inner then if 2 ^ 127 <=? num "room_within" then 2 else -1
  else if (2 ^ 127 <=? num "beyond") || (2 ^ 127 <=? num "room_without") then 2 else 1.
Definition all_zero := (num "r1" =? 0) && (num "r2" =? 0) && (num "r3" =? 0).
Definition answer := if is_in_range && all_zero then side else 2.

Definition begun : environment := ("inner", Of Int (if inner then 1 else 0)) :: fold_left (fun now n => (n, Of U64 (ls n)) :: now) named
  (("about", about) :: map (fun p => (String.append "lengths." (fst p), snd p)) (words_of_lengths ls) ++ literals)%list.

Lemma beginning_runs f rest now : bound_all (map Named ["lengths"; "about"]) [Rec (words_of_lengths ls); about] literals = Some now ->
  go known [] (8 + f) now (names_lengths 7 ++ Set_ "int" "inner" (Infix "<" (Named "about") (Constant Int 0)) :: rest)%list = go known [] f begun rest.
Proof.
  cbn [bound_all map]; rewrite (bound_float _ _ _ About); intros E; injection E as <-.
  cbv [names_lengths named StageThreeRuns.lengths combine map firstn app fst snd words_of_lengths bound append]; cbn [Nat.add].
  do 7 (erewrite go_put; [| reflexivity | reflexivity | reflexivity]; cbv [bound app map fst snd append]).
  rewrite (go_put _ _ _ _ "int" "inner" _ _ (Of Int (if inner then 1 else 0)) (Of Int (if inner then 1 else 0))); [reflexivity | reflexivity | | destruct inner; reflexivity].
  refine (proj1 (eval_below float less nearest word _ (Named "about") (Constant Int 0) about (Of Int 0) About (andb_false_r _) _ _)); reflexivity.
Qed.
Lemma begun_sound : sound base (of_lengths 7) begun.
Proof.
  intros n w E; apply look_in, in_map_iff in E as (k & E & I); injection E as -> <-; assert (J : In n named) by (cbn in I |- *; tauto).
  split; [left; reflexivity |]; rewrite (Begins n J); split; [| pose proof (Lengths n J); lia].
  clear J; cbn in I; repeat destruct I as [<- | I]; try contradiction; reflexivity.
Qed.

Definition multiplied := after base (of_lengths 7) products begun.
Lemma products_run f rest : go known [] (2 + f) begun (steps_in (of_lengths 7) products ++ rest)%list = go known [] f multiplied rest /\ sound base with_products multiplied.
Proof.
  apply (steps_run base base_v inner [] known (longs_are_known float less nearest word) products (of_lengths 7) with_products); [vm_compute; reflexivity | exact begun_sound | discriminate
    | vm_compute; reflexivity | vm_compute; reflexivity | exact Base_runs].
Qed.

(** The floats, and the guess. *)
Lemma half_more_is now n o given : look n now = Some (made_by o given) -> look "_0.5" now = Some (Opaque "0.5" 0) -> eval known now (half_more n) = Some (Of U64 (rounded (made_by o given))).
Proof.
  intros E H; eapply eval_given with (l := [made_by "+" [made_by o given; Opaque "0.5" 0]]); [reflexivity | | reflexivity].
  apply given_more; [| reflexivity]; apply eval_operation; [reflexivity | exact I | reflexivity | apply eval_named, E | apply eval_named, H].
Qed.
Lemma guess_run f rest : go known [] (7 + f) multiplied (guess ++ rest)%list =
  if is_in_range then go known [] f ([("e", Of U64 (num "e")); ("M", Of U64 (num "M")); ("most", limit); ("e_", e_of_guess); ("m_", m_of_guess); ("size", size_of_guess)] ++ multiplied)%list rest
  else Some (Some (Of Int 2), ([("most", limit); ("e_", e_of_guess); ("m_", m_of_guess); ("size", size_of_guess)] ++ multiplied)%list).
Proof.
  pose proof (proj2 (products_run 0 [])) as S; assert (F : is_float size_of_guess) by (unfold size_of_guess; destruct inner; [exact I | exact About]).
  assert (D_is : look "D" multiplied = Some (Of U64 (base "D"))) by (apply (S "D" 64); reflexivity).
  assert (K_is : look "K" multiplied = Some (Of U64 (base "K"))) by (apply (S "K" 64); reflexivity).
  assert (about_is : look "about" multiplied = Some about) by reflexivity.
  assert (inner_is : look "inner" multiplied = Some (Of Int (if inner then 1 else 0))) by reflexivity.
  unfold guess; cbn [Nat.add app].
  rewrite (go_put _ _ _ _ "double" "size" _ _ size_of_guess size_of_guess); [| reflexivity | | apply held_float, F].
  2: { rewrite (eval_chosen _ _ _ _ _ _ _ (eval_named known _ _ _ inner_is)); unfold size_of_guess; destruct inner; cbn [Z.eqb]; [| apply eval_named; exact about_is].
    cbn [eval]; rewrite about_is; destruct about; try contradiction; reflexivity. }
  rewrite bound_float by exact F.
  rewrite (go_put _ _ _ _ "double" "m_" _ _ m_of_guess m_of_guess); [| reflexivity | | reflexivity].
  2: { apply eval_operation; [reflexivity | exact F | apply andb_false_r | reflexivity |].
    cbn [eval map every look String.eqb Ascii.eqb Bool.eqb]; rewrite D_is; reflexivity. }
  change (bound "m_" m_of_guess ?now) with (("m_", m_of_guess) :: now).
  rewrite (go_put _ _ _ _ "double" "e_" _ _ e_of_guess e_of_guess); [| reflexivity | | reflexivity].
  2: { apply eval_operation; [reflexivity | exact I | reflexivity | | reflexivity].
    cbn [eval map every look String.eqb Ascii.eqb Bool.eqb]; rewrite K_is; reflexivity. }
  rewrite (go_put _ _ _ _ "double" "most" _ _ limit limit); [| reflexivity | reflexivity | reflexivity].
  change (bound "most" limit (bound "e_" e_of_guess ?now)) with (("most", limit) :: ("e_", e_of_guess) :: now).
  set (now := ("most", limit) :: _).
  assert (C : eval known now in_range = Some (Of Int (if is_in_range then 1 else 0))).
  { pose proof (proj2 (eval_below float less nearest word now (Named "size") (Constant Int 0) size_of_guess (Of Int 0) F (andb_false_r _) eq_refl eq_refl)) as C1.
    pose proof (proj1 (eval_below float less nearest word now (Named "m_") (Named "most") m_of_guess limit I eq_refl eq_refl eq_refl)) as C2.
    pose proof (proj1 (eval_below float less nearest word now (Named "e_") (Named "most") e_of_guess limit I eq_refl eq_refl eq_refl)) as C3.
    exact (eval_both known now _ _ _ _ (eval_both known now _ _ _ _ C1 C2) C3). }
  assert (N : eval known now (Infix "==" in_range (Constant Int 0)) = Some (Of Int (if is_in_range then 0 else 1)))
    by (eapply eval_infix; [reflexivity | exact C | reflexivity |]; destruct is_in_range; reflexivity).
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ N); destruct is_in_range eqn:R; cbn [Z.eqb app]; [| reflexivity].
  destruct (Guess eq_refl) as [EM Ee].
  rewrite (go_put _ _ _ _ "" "M" _ _ (Of U64 (num "M")) (Of U64 (num "M"))); [| reflexivity | | reflexivity].
  2: { rewrite EM; apply half_more_is; reflexivity. }
  rewrite (go_put _ _ _ _ "" "e" _ _ (Of U64 (num "e")) (Of U64 (num "e"))); [reflexivity | reflexivity | | reflexivity].
  rewrite Ee; apply half_more_is; reflexivity.
Qed.

Definition guessed_env := ([("e", Of U64 (num "e")); ("M", Of U64 (num "M")); ("most", limit); ("e_", e_of_guess); ("m_", m_of_guess); ("size", size_of_guess)] ++ multiplied)%list.
Definition equations_env := after num guess_widths behind_guess guessed_env.
Hypothesis Fit : 0 <= num "M" < 2 ^ 64 /\ 0 <= num "e" < 2 ^ 64.
Lemma guess_sound : sound num guess_widths guessed_env.
Proof.
  pose proof (sound_alike base num with_products multiplied (proj2 (products_run 0 [])) Alike) as S.
  assert (S' : sound num with_products guessed_env) by (apply sound_pushed; [exact S | vm_compute; reflexivity]).
  intros n w E; cbn [guess_widths look] in E; destruct (String.eqb_spec "e" n) as [<- | De]; [injection E as <-; split; [left; reflexivity | split; [reflexivity | apply Fit]] |].
  destruct (String.eqb_spec "M" n) as [<- | DM]; [injection E as <-; split; [left; reflexivity | split; [reflexivity | apply Fit]] | exact (S' n w E)].
Qed.
Lemma equations_run f rest : go known [] (List.length behind_guess + f) guessed_env (steps_in guess_widths behind_guess ++ rest)%list = go known [] f equations_env rest
  /\ sound num (widths_after guess_widths behind_guess) equations_env.
Proof.
  apply (steps_run num v inner [] known (longs_are_known float less nearest word) behind_guess guess_widths (widths_after guess_widths behind_guess));
    [vm_compute; reflexivity | exact guess_sound | intros _; reflexivity | vm_compute; reflexivity | vm_compute; reflexivity | exact Runs].
Qed.

(** What is answered. *)
Lemma words_are now n : there num now n 128 -> (eval known now (Part (Named n) (Constant Int 0)) = Some (Of U64 (num n mod W))
  /\ eval known now (Part (Named n) (Constant Int 1)) = Some (Of U64 (num n / W))) /\ 0 <= num n < bits128.
Proof. intros (_ & L & B); split; [split; cbn [eval]; rewrite L; reflexivity | exact B]. Qed.
Lemma words_joined now l r x y : eval known now l = Some (Of U64 x) -> eval known now r = Some (Of U64 y) -> eval known now (Infix "|" l r) = Some (Of U64 (Z.lor x y)).
Proof. intros L R; eapply eval_infix; [reflexivity | exact L | exact R | reflexivity]. Qed.
Lemma no_word z : 0 <= z -> z mod W = 0 /\ z / W = 0 <-> z = 0.
Proof. intros Z0; pose proof (Z.div_mod z W ltac:(discriminate)); split; [lia | intros ->; split; reflexivity]. Qed.
Lemma any_word_is now : there num now "r1" 128 -> there num now "r2" 128 -> there num now "r3" 128 ->
  exists z, eval known now any_word = Some (Of U64 z) /\ (z =? 0) = all_zero.
Proof.
  intros T1 T2 T3; destruct (words_are now "r1" T1) as [[A1 A2] B1], (words_are now "r2" T2) as [[A3 A4] B2], (words_are now "r3" T3) as [[A5 A6] B3].
  eexists; split; [exact (words_joined _ _ _ _ _ (words_joined _ _ _ _ _ (words_joined _ _ _ _ _ (words_joined _ _ _ _ _ (words_joined _ _ _ _ _ A1 A2) A3) A4) A5) A6) |].
  unfold all_zero; apply eq_true_iff_eq; rewrite !andb_true_iff, !Z.eqb_eq, !Z.lor_eq_0_iff.
  rewrite <- (no_word (num "r1")), <- (no_word (num "r2")), <- (no_word (num "r3")) by lia; tauto.
Qed.
Theorem run_text : called_on float less nearest word functions "hc_touches_by_short" [Rec (words_of_lengths ls); about] = Some (Of Int answer).
Proof.
  unfold called_on; rewrite text_is; cbn [takes does].
  destruct (bound_all (map Named ["lengths"; "about"]) [Rec (words_of_lengths ls); about] literals) as [now |] eqn:E; [| exfalso; revert E; cbn [bound_all map]; rewrite (bound_float _ _ _ About); discriminate].
  change steps with (8 + (2 + (7 + (List.length behind_guess + 39))))%nat; rewrite (beginning_runs _ _ _ E), (proj1 (products_run _ _)), guess_run; clear E now.
  unfold answer; destruct is_in_range; [cbn [andb] | reflexivity].
  fold guessed_env; rewrite (proj1 (equations_run _ _)); pose proof (proj2 (equations_run 0 [])) as S; set (now := equations_env) in *.
  destruct (any_word_is now) as (z & E & Z0); try (apply S; vm_compute; reflexivity).
  change 39%nat with (Datatypes.S 38); unfold verdict; rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ E), Z0; clear E Z0 z; destruct all_zero; cbn [app]; [| reflexivity].
  assert (side_is : eval known now (Named "inner") = Some (Of Int (if inner then 1 else 0))).
  { apply eval_named; unfold now, equations_env; rewrite after_other by (vm_compute; reflexivity); reflexivity. }
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ side_is); clear side_is; unfold side.
  assert (T : forall n, look n (widths_after guess_widths behind_guess) = Some 128 -> eval known now (is_negative_fixed n) = Some (Of U64 (if 2 ^ 127 <=? num n then W - 1 else 0)))
    by (intros n L; apply (ask_fixed num known (longs_are_known float less nearest word)), S, L).
  destruct inner; cbn [Z.eqb app].
  - rewrite (go_return _ _ _ _ _ _ (Of Int (if 2 ^ 127 <=? num "room_within" then 2 else -1))); [reflexivity |].
    rewrite (eval_chosen _ _ _ _ _ _ _ (T "room_within" ltac:(vm_compute; reflexivity))); destruct (2 ^ 127 <=? num "room_within"); reflexivity.
  - rewrite (go_return _ _ _ _ _ _ (Of Int (if (2 ^ 127 <=? num "beyond") || (2 ^ 127 <=? num "room_without") then 2 else 1))); [reflexivity |].
    pose proof (T "beyond" ltac:(vm_compute; reflexivity)) as B; pose proof (T "room_without" ltac:(vm_compute; reflexivity)) as C; clear T.
    rewrite (eval_chosen _ _ _ _ _ _ _ (eval_or _ _ _ _ _ _ _ _ B C)); destruct (2 ^ 127 <=? num "beyond"), (2 ^ 127 <=? num "room_without"); reflexivity.
Qed.

Lemma answer_is_side : (num "r1" = 0 -> num "r2" = 0 -> num "r3" = 0 -> (if inner then ~ 2 ^ 127 <= num "room_within"
  else ~ 2 ^ 127 <= num "beyond" /\ ~ 2 ^ 127 <= num "room_without") -> touches inner ls) -> is_side ls answer.
Proof.
  unfold answer, all_zero, side; clear; intros T; destruct is_in_range; [cbn [andb] | left; reflexivity].
  destruct (Z.eqb_spec (num "r1") 0) as [Z1 |], (Z.eqb_spec (num "r2") 0) as [Z2 |], (Z.eqb_spec (num "r3") 0) as [Z3 |]; cbn [andb]; try (left; reflexivity).
  specialize (T Z1 Z2 Z3); destruct inner.
  - destruct (Z.leb_spec (2 ^ 127) (num "room_within")); [left; reflexivity | right; exists true; split; [reflexivity | apply T; lia]].
  - destruct (Z.leb_spec (2 ^ 127) (num "beyond")), (Z.leb_spec (2 ^ 127) (num "room_without")); cbn [orb]; try (left; reflexivity).
    right; exists false; split; [reflexivity | apply T; lia].
Qed.
End Run.

(** What its text returns, where a guess below 2^46, rounded as a half more and cut, is a whole number up to 2^46: a side from which the
    row touches, or 2. *)
Section Short.
Variables (float : string -> list datum -> Z) (less : datum -> datum -> bool) (nearest word : Z -> Z) (ls : string -> Z) (about : datum).
Hypotheses (About : is_float about) (Lengths : forall n, In n named -> 0 <= ls n < 2 ^ 23) (Sizes : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < ls n).
Notation made_by := (made_by float).
Definition cut_half_up d := let k := word (float "+" [d; Opaque "0.5" 0]) in less d limit = true -> 0 <= k <= 2 ^ 46.
Hypothesis Half_up : forall size n, is_float size -> 0 <= n < 2 ^ 46 -> less (Of Int 0) size = true ->
  cut_half_up (made_by "*" [size; double_of float n]) /\ cut_half_up (made_by "/" [double_of float n; size]).

Definition inside := inner less about.
Definition base_here := before inside before_guess ls.
Definition in_range_here := is_in_range float less about base_here.
Definition M_here := if in_range_here then rounded float word (m_of_guess float less about base_here) else 0.
Definition e_here := if in_range_here then rounded float word (e_of_guess float less about base_here) else 0.
Definition num_here := guessed inside before_guess behind_guess ls M_here e_here.

Lemma products_below : 0 <= base_here "D" < 2 ^ 46 /\ 0 <= base_here "K" < 2 ^ 46.
Proof.
  assert (D : base_here "D" = (ls "b" * ls "d") mod 2 ^ 64) by reflexivity; assert (K : base_here "K" = (ls "alpha" * ls "gamma") mod 2 ^ 64) by reflexivity.
  assert (P : forall n k, In n named -> In k named -> 0 <= ls n * ls k < 2 ^ 46)
    by (intros n k I J; pose proof (Lengths n I); pose proof (Lengths k J); change (2 ^ 46) with (2 ^ 23 * 2 ^ 23); split; [lia | apply Z.mul_lt_mono_nonneg; lia]).
  pose proof (P "b" "d" ltac:(cbn; tauto) ltac:(cbn; tauto)); pose proof (P "alpha" "gamma" ltac:(cbn; tauto) ltac:(cbn; tauto)).
  rewrite D, K, !Z.mod_small by lia; split; assumption.
Qed.
Lemma guess_below : 0 <= M_here <= 2 ^ 46 /\ 0 <= e_here <= 2 ^ 46.
Proof.
  unfold M_here, e_here; destruct in_range_here eqn:R; [| split; lia]; unfold in_range_here, is_in_range in R; apply andb_prop in R as [R Re]; apply andb_prop in R as [R Rm].
  assert (F : is_float (size_of_guess float less about)) by (unfold size_of_guess; destruct (inner less about); [exact I | exact About]).
  destruct products_below as [D K], (Half_up _ _ F D R) as [B _], (Half_up _ _ F K R) as [_ C]; specialize (B Rm); specialize (C Re).
  unfold rounded, m_of_guess, e_of_guess in *; assert (2 ^ 46 < W) by reflexivity; rewrite !Z.mod_small by lia; split; assumption.
Qed.

Lemma base_begins n : In n named -> base_here n = ls n.
Proof. intros I; unfold base_here, before; rewrite computed_same; destruct I as [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]; reflexivity. Qed.

Local Opaque guessed guessed_v before before_v.
Definition v_here := guessed_v inside before_guess behind_guess ls M_here e_here.
Lemma steps_ordered : ordered before_guess = true /\ ordered behind_guess = true.
Proof. split; vm_compute; reflexivity. Qed.
Lemma guess_apart : forallb (fun s => forallb (fun n => negb (is_later behind_guess n)) (reads_of s)) before_guess = true.
Proof. vm_compute; reflexivity. Qed.
Lemma runs_here : Forall (runs num_here v_here inside) behind_guess.
Proof. exact (proj2 (proj1 (Forall_app _ _ _) (guessed_runs inside before_guess behind_guess ls steps_ordered guess_apart M_here e_here))). Qed.
Lemma guess_here : (num_here "M" = M_here /\ v_here "M" = M_here) /\ num_here "e" = e_here /\ v_here "e" = e_here.
Proof. apply guess_is; vm_compute; reflexivity. Qed.
Lemma alike_here n w : In (n, w) with_products -> num_here n = base_here n.
Proof.
  intros I; refine (proj1 (guessed_before inside before_guess behind_guess ls M_here e_here n _)).
  assert (A : forallb (fun p => negb (is_later behind_guess (fst p))) with_products = true) by (vm_compute; reflexivity).
  rewrite forallb_forall in A; apply negb_true_iff, (A (n, w) I).
Qed.
Lemma steps_here : (short_inputs = long_inputs /\ (before_guess ++ behind_guess)%list = C_tangency /\ 23 = 62 /\ 2 ^ 46 = 2 ^ 126 - 1)
  \/ (short_inputs = short_inputs /\ (before_guess ++ behind_guess)%list = C_short /\ 23 = 23 /\ 2 ^ 46 = 2 ^ 46).
Proof. right; repeat split; reflexivity. Qed.
Lemma passed_here : num_here "r1" = 0 -> num_here "r2" = 0 -> num_here "r3" = 0 -> (if inside then ~ 2 ^ 127 <= num_here "room_within"
  else ~ 2 ^ 127 <= num_here "beyond" /\ ~ 2 ^ 127 <= num_here "room_without") -> touches inside ls.
Proof.
  exact (passed inside ls M_here e_here 23 (2 ^ 46) short_inputs before_guess behind_guess steps_here steps_ordered guess_apart Lengths Sizes (proj1 guess_below) (proj2 guess_below)).
Qed.
Lemma text_here : called_on float less nearest word functions "hc_touches_by_short" [Rec (words_of_lengths ls); about] = Some (Of Int (answer float less about base_here num_here)).
Proof.
  destruct guess_below as [BM Be], guess_here as ((NM & _) & Ne & _).
  apply (run_text float less nearest word ls about About Lengths base_here (before_v inside before_guess ls) num_here v_here base_begins).
  - exact (Forall_inv_tail (before_runs inside before_guess behind_guess ls steps_ordered)).
  - exact runs_here.
  - exact alike_here.
  - rewrite NM, Ne; unfold M_here, e_here; intros R; fold in_range_here in R; rewrite R; split; reflexivity.
  - rewrite NM, Ne; lia.
Qed.

Theorem short_text : exists r, called_on float less nearest word functions "hc_touches_by_short" [Rec (words_of_lengths ls); about] = Some (Of Int r) /\ is_side ls r.
Proof.
  exists (answer float less about base_here num_here); split; [exact text_here | exact (answer_is_side float less ls about base_here num_here passed_here)].
Qed.
End Short.

(** Each of its answers occurs, where a guess of 1 is right: for a unit sphere 2 from the axis of the unit hyperboloid, which touches it
    from without, one in its centre, which touches it from within, and one that crosses it. *)
Definition answer_at (less : datum -> datum -> bool) l := called_on (fun _ _ => 0) less (fun _ => 1) (fun _ => 1) functions "hc_touches_by_short"
  [Rec (words_of_lengths (fun n => match look n (combine named l) with Some z => z | None => 0 end)); Opaque "" 0].
Definition above_0 (_ c : datum) := match c with Of _ _ => false | _ => true end.
Theorem every_answer_occurs : [answer_at above_0 [1; 1; 1; 1; 2; 0; 0]; answer_at (fun _ _ => true) [1; 1; 1; 1; 0; 0; 0]; answer_at above_0 [1; 1; 1; 1; 1; 0; 0]]
  = map (fun z => Some (Of Int z)) [1; -1; 2].
Proof. vm_compute; reflexivity. Qed.
