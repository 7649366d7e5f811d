(** Stage 4: the function of the header that proves a tangency by Newton's method and numbers of 256 bits, run by Coq: where it answers
    with a side, the row touches from there, whatever the floats are that lead to the numbers M and e. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed FixedRuns Long Limbs LimbsRuns Computed Trees PlainerTexts StageThreeRuns StageThreeAnswers StageFour StageFourSteps StageFourGuesses.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** The text of the functions. *)
Definition functions := Eval vm_compute in
  match every (map (fun text => read_from (string_of text)) HeaderText.beside_tangency) with Some l => l | None => [] end.

(** The steps before the side, before the guess, of a turn and of its last. *)
Definition before_guess := Eval vm_compute in firstn 18 C_tangency.
Definition behind_guess := Eval vm_compute in skipn 18 C_tangency.
Definition before_side := Eval vm_compute in firstn 14 before_guess.
Definition behind_side := Eval vm_compute in skipn 15 before_guess.
Definition two_equations := Eval vm_compute in firstn 9 behind_guess.
Definition third_equation := Eval vm_compute in skipn 9 behind_guess.
Definition side_widths := Eval vm_compute in widths_after (of_lengths 7) before_side.
Definition first_widths := Eval vm_compute in widths_after side_widths behind_side.
Definition guess_widths := ("e", 128) :: ("M", 128) :: first_widths.
Definition turn_widths := Eval vm_compute in widths_after guess_widths two_equations.
Definition last_widths := Eval vm_compute in widths_after turn_widths third_equation.

Definition two := Constant Int 2.
Definition minus_one := Infix "-" (Constant Int 0) (Constant Int 1).
Definition opposite e := Infix "-" (Constant Int 0) e.
Definition is_side_inner := Set_ "int" "inner" (Infix "<" (Named "about") (Constant Int 0)).
Definition in_range := Infix "&&" (Infix "&&" (Infix ">" (Named "size") (Constant Int 0)) (Infix "<" (Named "m_") (Named "most"))) (Infix "<" (Named "e_") (Named "most")).
Definition as_float n := Called "hc_fixed_value" [Named n].
Definition nearest_to n := Called "hc_fixed_nearest" [Named n].
Definition guess := [Set_ "double" "d_" (as_float "D"); Set_ "double" "k_" (as_float "K"); Set_ "double" "size" (Choice (Named "inner") (opposite (Named "about")) (Named "about"));
  Set_ "double" "most" (Named "_4.2535295865117308e37"); Set_ "double" "m_" (Infix "*" (Named "size") (Named "d_")); Set_ "double" "e_" (Infix "/" (Named "k_") (Named "size"));
  If (Infix "==" in_range (Constant Int 0)) [Returns two] []; Set_ "" "M" (nearest_to "m_"); Set_ "" "e" (nearest_to "e_")].

Definition is_zero_long n := Called "hc_long_is_zero" [Named n].
Definition answers_side := [If (Infix "==" (is_zero_long "r3") (Constant Int 0)) [Returns two] [];
  If (Named "inner") [Returns (Choice (is_negative_long "room_within") two minus_one)] [];
  Returns (Choice (Infix "||" (is_negative_long "beyond") (is_negative_long "room_without")) two (Constant Int 1))].
Definition signed_float n := Choice (Named "inner") (opposite (as_float n)) (as_float n).
Definition within_most n := [Infix "<" (Named n) (Named "most"); Infix ">" (Named n) (opposite (Named "most"))].
Definition newton := [Set_ "" "r1_" (Called "hc_long_value" [Named "r1"]); Set_ "" "half" (Infix "*" (Named "_0.5") (Called "hc_long_value" [Named "r2"]));
  Set_ "" "m_" (signed_float "M"); Set_ "" "e_" (signed_float "e"); Set_ "" "det" (Infix "-" (Infix "*" (Named "e_") (Named "e_")) (Infix "*" (Named "m_") (Named "d_")));
  Set_ "" "dM" (Infix "/" (Infix "+" (Infix "*" (Named "e_") (Named "r1_")) (Infix "*" (Named "m_") (Named "half"))) (Named "det"));
  Set_ "" "de" (Infix "/" (opposite (Infix "+" (Infix "*" (Named "e_") (Named "half")) (Infix "*" (Named "d_") (Named "r1_")))) (Named "det"));
  If (Named "inner") [Set_ "" "dM" (opposite (Named "dM")); Set_ "" "de" (opposite (Named "de"))] []].
Definition words n := [Part (Named n) (Constant Int 0); Part (Named n) (Constant Int 1)].
Definition next_guess := [
  If (Infix "==" (Infix "&&" (Infix "&&" (Infix "&&" (Infix "<" (Named "dM") (Named "most")) (Infix ">" (Named "dM") (opposite (Named "most")))) (Infix "<" (Named "de") (Named "most")))
    (Infix ">" (Named "de") (opposite (Named "most")))) (Constant Int 0)) [Returns two] [];
  Set_ "hc_fixed" "by_M" (nearest_to "dM"); Set_ "hc_fixed" "by_e" (nearest_to "de");
  If (Infix "==" (fold_left (Infix "|") (tl (words "by_M") ++ words "by_e")%list (Part (Named "by_M") (Constant Int 0))) (Constant Int 0)) [Returns two] [];
  Set_ "" "M" (Called "hc_fixed_plus" [Named "M"; Named "by_M"]); Set_ "" "e" (Called "hc_fixed_plus" [Named "e"; Named "by_e"]);
  If (Infix ">>" (Infix "|" (Part (Named "M") (Constant Int 1)) (Part (Named "e") (Constant Int 1))) (Constant Int 62)) [Returns two] []].
Definition a_turn := (steps_in guess_widths two_equations ++ If (Infix "&&" (is_zero_long "r1") (is_zero_long "r2"))
  (steps_in turn_widths third_equation ++ answers_side) [] :: newton ++ next_guess)%list.
Definition turns := Turns "turn" (Constant Int 4) (Constant Int 1) a_turn.
Theorem text_is : look "hc_touches_by" functions = Some (Deciding ["lengths"; "about"] (names_lengths 7 ++ steps_in (of_lengths 7) before_side
  ++ is_side_inner :: steps_in side_widths behind_side ++ guess ++ [Set_ "" "turn" (Constant Int 0); turns; Returns two])).
Proof. vm_compute; reflexivity. Qed.

(** Names that a turn gives anew. *)
Definition changed := (declared a_turn ++ ["r1_"; "half"; "m_"; "e_"; "det"; "dM"; "de"; "M"; "e"])%list.
Definition keeps (now now' : environment) := forall n, is_in n changed = false -> look n now' = look n now.

Lemma look_outside l now n : look n (outside l now) = if is_in n (declared l) then None else look n now.
Proof.
  unfold outside; induction now as [| [m d] now IH]; cbn [filter look fst]; [destruct (is_in n (declared l)); reflexivity |].
  destruct (is_in m (declared l)) eqn:D; cbn [negb look]; destruct (String.eqb_spec m n) as [<- | N]; try (rewrite D in *); [exact IH | exact IH | reflexivity | exact IH].
Qed.

Section Run.
Variables (float : string -> list datum -> Z) (less : datum -> datum -> bool) (nearest word : Z -> Z) (inside : bool).
Notation known := (of_touching float less nearest word).
Notation gives_float := (gives_float float less nearest word).
Notation gives_bit := (gives_bit float less nearest word).

Definition is_opaque now n := exists m k, look n now = Some (Opaque m k).
Definition holds_number (now : environment) n z := look n now = Some (Fix (words_of z)) /\ 0 <= z < 2 ^ 126.

(** Behind the floats of a turn: the numbers of the next, or no answer. *)
Lemma go_float f now x e rest : gives_float now e -> exists m k, go known [] (S f) now (Set_ "" x e :: rest) = go known [] f ((x, Opaque m k) :: now) rest.
Proof. intros (m & k & E); exists m, k; exact (go_put known [] f now "" x e rest _ _ eq_refl E eq_refl). Qed.
Lemma go_unless f now c rest : gives_bit now c -> exists b : bool, go known [] (S (S f)) now (If (Infix "==" c (Constant Int 0)) [Returns two] [] :: rest)
  = if b then go known [] (S f) now rest else Some (Some (Of Int 2), now).
Proof.
  intros (b & E); exists b; assert (N : eval known now (Infix "==" c (Constant Int 0)) = Some (Of Int (if b then 0 else 1)))
    by (eapply eval_infix; [reflexivity | exact E | reflexivity |]; destruct b; reflexivity).
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ N); destruct b; reflexivity.
Qed.
Lemma eval_nearest now n : is_opaque now n -> exists z, 0 <= z < bits128 /\ eval known now (nearest_to n) = Some (Fix (words_of z)).
Proof.
  intros (m & k & E); exists (nearest k mod bits128); split; [apply Z.mod_pos_bound; reflexivity |].
  unfold nearest_to; eapply eval_given; [reflexivity | apply given_more; [apply eval_named, E | reflexivity] | reflexivity].
Qed.
Lemma eval_plus now n m z y : look n now = Some (Fix (words_of z)) -> look m now = Some (Fix (words_of y)) -> 0 <= z < bits128 -> 0 <= y < bits128 ->
  eval known now (Called "hc_fixed_plus" [Named n; Named m]) = Some (Fix (words_of ((z + y) mod bits128))).
Proof.
  intros N M Z0 Y0; eapply eval_given; [reflexivity | apply given_more; [apply eval_named, N | apply given_more; [apply eval_named, M | reflexivity]] |].
  destruct (words_of_is _ Z0) as [NA PA], (words_of_is _ Y0) as [NC PC]; cbn [numbers]; do 2 f_equal.
  apply fixed_is; [apply plus_number | rewrite plus_is_right, PA, PC by assumption; reflexivity].
Qed.
Lemma words_of_name now n z : look n now = Some (Fix (words_of z)) -> eval known now (Part (Named n) (Constant Int 0)) = Some (Of U64 (z mod W))
  /\ eval known now (Part (Named n) (Constant Int 1)) = Some (Of U64 (z / W)).
Proof. intros E; split; cbn [eval]; rewrite E; reflexivity. Qed.
Lemma words_joined now l r x y : eval known now l = Some (Of U64 x) -> eval known now r = Some (Of U64 y) -> eval known now (Infix "|" l r) = Some (Of U64 (Z.lor x y)).
Proof. intros L R; eapply eval_infix; [reflexivity | exact L | exact R | reflexivity]. Qed.
Lemma below_126 z y : 0 <= z < bits128 -> 0 <= y < bits128 -> Z.lor (z / W) (y / W) / 2 ^ 62 = 0 -> 0 <= z < 2 ^ 126 /\ 0 <= y < 2 ^ 126.
Proof.
  intros Z0 Y0 E; rewrite <- Z.shiftr_div_pow2, Z.shiftr_lor, Z.lor_eq_0_iff, !Z.shiftr_div_pow2 in E by lia; destruct E as [A B].
  assert (H : forall k, 0 <= k -> k / W / 2 ^ 62 = 0 -> k < 2 ^ 126).
  { intros k K D; rewrite Z.div_div in D by (discriminate || reflexivity); change (W * 2 ^ 62) with (2 ^ 126) in D.
    apply Z.div_small_iff in D; [lia | discriminate]. }
  split; split; try lia; apply H; (lia || assumption).
Qed.

Lemma next_run f now M e : is_opaque now "dM" -> is_opaque now "de" -> is_opaque now "most" -> holds_number now "M" M -> holds_number now "e" e ->
  look "by_M" now = None -> look "by_e" now = None ->
  (exists now', go known [] (8 + f) now next_guess = Some (Some (Of Int 2), now')) \/
  exists M' e' now', go known [] (8 + f) now next_guess = Some (None, now') /\ holds_number now' "M" M' /\ holds_number now' "e" e' /\
    forall n, is_in n ["by_M"; "by_e"; "M"; "e"] = false -> look n now' = look n now.
Proof.
  intros DM De Most [LM BM] [Le Be] NM Ne; unfold next_guess; cbn [Nat.add].
  assert (F : forall n, is_opaque now n -> gives_float now (Named n)) by (intros n (m & k & E); exact (float_named _ _ _ _ _ _ _ _ E)).
  assert (B128 : 2 ^ 126 < bits128) by reflexivity.
  lazymatch goal with |- context [go _ _ (S (S ?g)) now (If (Infix "==" ?c _) _ _ :: ?rest)] => destruct (go_unless g now c rest) as ([|] & ->) end.
  { repeat apply bit_both; apply bit_less; try reflexivity; try (apply float_opposite); apply F; assumption. }
  2: { left; eexists; reflexivity. }
  destruct (eval_nearest now "dM" DM) as (X & BX & EX); assert (New_M : is_new "hc_fixed" "by_M" now = true) by (unfold is_new; rewrite NM; reflexivity).
  rewrite (go_put _ _ _ _ _ _ _ _ _ _ New_M EX eq_refl); cbn [bound].
  destruct (eval_nearest (("by_M", Fix (words_of X)) :: now) "de") as (Y & BY & EY); [destruct De as (m & k & E); exists m, k; exact E |].
  assert (New : is_new "hc_fixed" "by_e" (("by_M", Fix (words_of X)) :: now) = true) by (unfold is_new; cbn [look String.eqb Ascii.eqb Bool.eqb]; rewrite Ne; reflexivity).
  rewrite (go_put _ _ _ _ _ _ _ _ _ _ New EY eq_refl); cbn [bound].
  set (now1 := ("by_e", _) :: _).
  destruct (words_of_name now1 "by_M" X eq_refl) as [A1 A2], (words_of_name now1 "by_e" Y eq_refl) as [A3 A4].
  pose proof (words_joined _ _ _ _ _ (words_joined _ _ _ _ _ (words_joined _ _ _ _ _ A1 A2) A3) A4) as J.
  lazymatch type of J with _ = Some (Of U64 ?z) => assert (N : eval known now1 (Infix "==" (fold_left (Infix "|") (tl (words "by_M") ++ words "by_e")%list (Part (Named "by_M") (Constant Int 0))) (Constant Int 0))
    = Some (Of Int (same z (0 mod W)))) by (eapply eval_infix; [reflexivity | exact J | reflexivity | reflexivity]) end.
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ N); destruct (same _ _ =? 0); cbn [app]; [| left; eexists; reflexivity].
  pose proof (eval_plus now1 "M" "by_M" M X LM eq_refl ltac:(lia) BX) as PM.
  rewrite (go_put _ _ _ _ "" "M" _ _ _ _ eq_refl PM eq_refl); cbn [bound]; set (M' := (M + X) mod bits128) in *.
  pose proof (eval_plus (("M", Fix (words_of M')) :: now1) "e" "by_e" e Y Le eq_refl ltac:(lia) BY) as Pe.
  rewrite (go_put _ _ _ _ "" "e" _ _ _ _ eq_refl Pe eq_refl); cbn [bound]; set (e' := (e + Y) mod bits128) in *; set (now2 := ("e", _) :: _).
  assert (BM' : 0 <= M' < bits128) by (apply Z.mod_pos_bound; reflexivity); assert (Be' : 0 <= e' < bits128) by (apply Z.mod_pos_bound; reflexivity).
  assert (H : eval known now2 (Infix ">>" (Infix "|" (Part (Named "M") (Constant Int 1)) (Part (Named "e") (Constant Int 1))) (Constant Int 62))
    = Some (Of U64 (Z.lor (M' / W) (e' / W) / 2 ^ 62))).
  { eapply eval_infix; [reflexivity | exact (words_joined _ _ _ _ _ (proj2 (words_of_name now2 "M" M' eq_refl)) (proj2 (words_of_name now2 "e" e' eq_refl))) | reflexivity | reflexivity]. }
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ H); destruct (Z.eqb_spec (Z.lor (M' / W) (e' / W) / 2 ^ 62) 0) as [E |]; cbn [app]; [| left; eexists; reflexivity].
  destruct (below_126 M' e' BM' Be' E) as [FM Fe]; right; exists M', e', now2; split; [reflexivity |].
  split; [split; [reflexivity | exact FM] |]; split; [split; [reflexivity | exact Fe] |].
  intros n D; unfold is_in in D; cbn [existsb] in D; repeat (apply orb_false_elim in D as [?H D]); unfold now2, now1; cbn [look].
  repeat match goal with K : String.eqb n ?m = false |- _ => rewrite String.eqb_sym in K; rewrite K; clear K end; reflexivity.
Qed.

Definition given_in_newton := ["by_M"; "by_e"; "M"; "e"; "r1_"; "half"; "m_"; "e_"; "det"; "dM"; "de"].
Definition side_is_known now := look "inner" now = Some (Of Int (if inside then 1 else 0)).
Ltac leaf := cbn [look String.eqb Ascii.eqb Bool.eqb]; first [eassumption | reflexivity].
Ltac floats := lazymatch goal with
  | |- StageFourGuesses.gives_float _ _ _ _ _ (Infix "-" (Constant Int 0) _) => apply float_opposite; floats
  | |- StageFourGuesses.gives_float _ _ _ _ _ (Infix _ _ _) => apply float_infix; [reflexivity | floats | floats]
  | |- StageFourGuesses.gives_float _ _ _ _ _ (Choice _ _ _) => eapply float_choice; [apply eval_named; leaf | floats | floats]
  | |- StageFourGuesses.gives_float _ _ _ _ _ (Called _ _) => do 2 eexists; eapply eval_given; [reflexivity | apply given_more; [apply eval_named; leaf | reflexivity] | reflexivity]
  | |- StageFourGuesses.gives_float _ _ _ _ _ (Named _) => eapply float_named; leaf end.
Ltac float_step := lazymatch goal with |- context [go _ _ (S ?f) ?now (Set_ "" ?x ?e :: ?rest)] =>
  let G := fresh in assert (G : gives_float now e) by (unfold signed_float, as_float, opposite; floats); destruct (go_float f now x e rest G) as (? & ? & ->); clear G end.
Ltac named_apart := unfold given_in_newton, is_in in *; cbn [existsb] in *; repeat match goal with D : _ || _ = false |- _ => apply orb_false_elim in D as [?H D] end.
Ltac next_numbers LM Le := lazymatch goal with |- context [go _ _ (8 + ?f) ?now next_guess] =>
  lazymatch type of LM with holds_number _ _ ?m => lazymatch type of Le with holds_number _ _ ?e =>
    destruct (next_run f now m e) as [(? & ->) | (? & ? & ? & -> & ? & ? & K)]; [do 2 eexists; leaf | do 2 eexists; leaf | do 2 eexists; leaf
      | split; [leaf | apply LM] | split; [leaf | apply Le] | leaf | leaf | left; eexists; reflexivity
      | right; do 3 eexists; split; [reflexivity |]; split; [eassumption |]; split; [eassumption |]; intros n Dn; rewrite K;
        [named_apart; cbn [look]; repeat match goal with E : String.eqb n ?m = false |- context [String.eqb ?m n] => rewrite String.eqb_sym in E; rewrite E end; reflexivity
        | named_apart; repeat match goal with E : String.eqb n _ = false |- _ => rewrite E; clear E end; reflexivity]] end end end.

Lemma newton_run f now M e r1 r2 d0 d1 t0 t1 : look "r1" now = Some r1 -> look "r2" now = Some r2 -> look "d_" now = Some (Opaque d0 d1) -> look "most" now = Some (Opaque t0 t1) ->
  look "_0.5" now = Some (Opaque "0.5" 0) -> side_is_known now -> holds_number now "M" M -> holds_number now "e" e -> look "by_M" now = None -> look "by_e" now = None ->
  (exists now', go known [] (10 + (8 + f))%nat now (newton ++ next_guess) = Some (Some (Of Int 2), now')) \/
  exists M' e' now', go known [] (10 + (8 + f))%nat now (newton ++ next_guess) = Some (None, now') /\ holds_number now' "M" M' /\ holds_number now' "e" e' /\
    forall n, is_in n given_in_newton = false -> look n now' = look n now.
Proof.
  change (10 + (8 + f))%nat with (S (S (S (S (S (S (S (S (S (S (8 + f))))))))))); intros R1 R2 D Most Half Side LM Le NM Ne; pose proof (proj1 LM) as M_is; pose proof (proj1 Le) as e_is; unfold side_is_known in Side; unfold newton; cbn [app].
  do 7 float_step.
  lazymatch goal with |- context [go _ _ _ ?now (If (Named "inner") _ _ :: _)] => assert (S1 : look "inner" now = Some (Of Int (if inside then 1 else 0))) by leaf end.
  rewrite (go_chosen _ _ _ _ _ _ _ _ _ _ (eval_named known _ _ _ S1)); clear S1; destruct inside; cbn [Z.eqb app].
  - do 2 float_step; next_numbers LM Le.
  - change (S (S (8 + f))) with (8 + S (S f))%nat; next_numbers LM Le.
Qed.
End Run.
