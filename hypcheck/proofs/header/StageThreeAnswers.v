(** Stage 3: what the C asks at the poles, the balance of the discriminant, and which comparison answers what. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed FixedRuns Long Limbs LimbsRuns ShiftRuns Computed Trees StageThreeRuns StageThree Geometry Stages Positions.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** The text of the functions. *)
Definition functions := Eval vm_compute in
  match every (map (fun text => deciding_of (string_of text)) HeaderText.deciding) with Some l => l | None => [] end.

(** The struct of the terms. *)
Definition struct_of (num : string -> number) (small by_q by_t top_N top_ps : Z) := Rec [("top_ps", Of Int top_ps); ("top_N", Of Int top_N); ("small", Of Int small);
  ("by_t", Of Int by_t); ("by_q", Of Int by_q); ("n2", Fix (num "n2")); ("ps", Fix (num "ps")); ("n1", Fix (num "n1")); ("N", Fix (num "N"));
  ("whole_t", Fix (num "whole_t")); ("whole_q", Fix (num "whole_q")); ("R", Fix (num "R")); ("S", Fix (num "S")); ("t", Fix (num "t"));
  ("s", Fix (num "s")); ("q", Fix (num "q")); ("p", Fix (num "p"))].

Section Terms.
Variables (num : string -> number) (shift : string -> Z) (small by_q by_t top_N top_ps : Z).
Let terms := struct_of num small by_q by_t top_N top_ps.

(** What is put where the offset and the slope are wanted. *)
Definition sign_at n := sign_of (num n) (said "pole" * 2 ^ 0).
Definition asked n := Of Int (sign_int (sign_at n)).

Theorem at_B_text : Forall (is_computed shift num) C_at_B -> shift "by_q" = by_q -> shift "by_t" = by_t -> 0 <= by_q -> 0 <= by_t ->
  puts functions known [] "hc_fixed_at_B" [terms] = Some [asked "offset_at_B"; asked "slope_at_B"].
Proof.
  intros F Q T Q0 T0; unfold C_at_B in F; equations F; rewrite Q, T in *; clear Q T.
  puts_straight [("offset", asked "offset_at_B"); ("slope", asked "slope_at_B")] num.
Qed.

Theorem at_A_text : Forall (is_computed shift num) C_at_A -> shift "by_q" = by_q -> shift "by_t" = by_t -> 0 <= by_q -> 0 <= by_t ->
  puts functions known [] "hc_fixed_at_A" [terms] = Some [asked "offset_at_A"; asked "slope_at_A"].
Proof.
  intros F Q T Q0 T0; unfold C_at_A in F; equations F; rewrite Q, T in *; clear Q T.
  puts_straight [("offset", asked "offset_at_A"); ("slope", asked "slope_at_A")] num.
Qed.

End Terms.

(** ** The balance. *)

Section Cubic.
Variables (num num' : string -> number) (shift : string -> Z) (small by_q by_t top_3 top_0 : Z).
Hypotheses (Bsmall : 0 <= small <= 12284) (B3 : -24568 <= top_3 <= 0) (B0 : -24568 <= top_0 <= 0).
Variables bits_2 bits_1 top_2 top_1 q1 q2 q3 least most k top down_3 down_2 down_1 down_0 up_2 up_1 grown : Z.
Hypotheses (Ebits_2 : bits_2 = bits_of (num "n2")) (Ebits_1 : bits_1 = bits_of (num "n1"))
  (R2 : 1 <= bits_2 <= 126) (R1 : 1 <= bits_1 <= 126)
  (Etop_2 : top_2 = bits_2 - 124 - small) (Etop_1 : top_1 = bits_1 - 124)
  (Eq1 : q1 = Z.quot (top_0 - top_2) 2) (Eq2 : q2 = Z.quot (top_1 - top_3) 2) (Eq3 : q3 = Z.quot (top_0 - top_3) 3)
  (Eleast : least = Z.max (top_1 - top_2) q1) (Emost : most = Z.max q2 q3)
  (Ek : k = Z.min least most)
  (Etop : top = Z.max (Z.max (top_3 + 3 * k) (top_2 + 2 * k)) (Z.max (top_1 + k) top_0))
  (Edown_3 : down_3 = top - top_3 - 3 * k) (Edown_2 : down_2 = top - top_2 - 2 * k) (Edown_1 : down_1 = top - top_1 - k) (Edown_0 : down_0 = top - top_0)
  (Eup_2 : up_2 = 126 - bits_2) (Eup_1 : up_1 = 126 - bits_1) (Egrown : grown = Z.max 0 (Z.max (up_2 - down_2) (up_1 - down_1) - 1)).
Hypotheses (NN : num' "N" = shifted_down (shifted_up (num "N") 1) down_3) (Nps : num' "ps" = shifted_down (shifted_up (num "ps") 1) down_0)
  (N2 : num' "n2" = shifted_down (shifted_up (num "n2") up_2) (down_2 + 1)) (N1 : num' "n1" = shifted_down (shifted_up (num "n1") up_1) (down_1 + 1))
  (Steps : Forall (is_computed shift num') C_discriminant).

Definition cubic_of (num' : string -> number) k grown := Rec [("grown", Of Int grown); ("k", Of Int k); ("n2", Fix (num' "n2")); ("N", Fix (num' "N"));
  ("h2", Fix (num' "h2")); ("h1", Fix (num' "h1")); ("middle", Fix (num' "middle")); ("delta", Fix (num' "delta"))].

Definition counts := map (fun p => (fst p, Of Int (snd p))) [("bits_2", bits_2); ("bits_1", bits_1); ("top_2", top_2); ("top_1", top_1);
  ("top_0", top_0); ("top_3", top_3); ("least", least); ("most", most); ("k", k); ("top", top); ("down_3", down_3); ("down_2", down_2);
  ("down_1", down_1); ("down_0", down_0); ("up_2", up_2); ("up_1", up_1); ("grown", grown)].

Lemma halved a : Z.abs (Z.quot a 2) <= Z.abs a.
Proof. clear; Z.to_euclidean_division_equations; lia. Qed.
Lemma third a : Z.abs (Z.quot a 3) <= Z.abs a.
Proof. clear; Z.to_euclidean_division_equations; lia. Qed.

Theorem cubic_text : called functions known [] "hc_fixed_cubic_of" [struct_of num small by_q by_t top_3 top_0] = Some (cubic_of num' k grown).
Proof.
  assert (T2 : -13000 <= top_2 <= 2) by (clear - Etop_2 R2 Bsmall; lia); assert (T1 : -123 <= top_1 <= 2) by (clear - Etop_1 R1; lia).
  assert (Q1 : -60000 <= q1 <= 60000 /\ -60000 <= q2 <= 60000 /\ -60000 <= q3 <= 60000).
  { pose proof (halved (top_0 - top_2)) as H1; pose proof (halved (top_1 - top_3)) as H2;
      pose proof (third (top_0 - top_3)) as H3; rewrite <- Eq1 in H1; rewrite <- Eq2 in H2; rewrite <- Eq3 in H3;
      clear - H1 H2 H3 T1 T2 B0 B3; lia. }
  rewrite Eq1, Eq2, Eq3 in *; clear Eq1 Eq2 Eq3.
  assert (L : -60000 <= least <= 60000 /\ -60000 <= most <= 60000) by (clear - Eleast Emost T1 T2 Q1; lia).
  assert (K : -60000 <= k <= 60000) by (clear - Ek L; lia).
  assert (D : 0 <= down_3 /\ 0 <= down_2 /\ 0 <= down_1 /\ 0 <= down_0) by (clear - Etop Edown_3 Edown_2 Edown_1 Edown_0; lia).
  assert (T : -300000 <= top <= 300000) by (clear - Etop T1 T2 B0 B3 K; lia).
  assert (D' : down_3 <= 600000 /\ down_2 <= 600000 /\ down_1 <= 600000 /\ down_0 <= 600000) by (clear - T K T1 T2 B0 B3 Edown_3 Edown_2 Edown_1 Edown_0; lia).
  assert (U : 0 <= up_2 <= 125 /\ 0 <= up_1 <= 125) by (clear - R2 R1 Eup_2 Eup_1; lia).
  unfold C_discriminant in Steps; equations Steps.
  returns_straight counts num'.
Qed.
End Cubic.

(** ** The answer. *)

(** What the C answers for a position; 2 for none. *)
Definition code (a : option answer) := match a with Some Exterior => 1 | Some Interior => -1 | Some Contact => 0 | None => 2 end.

(** ** How the tree is run: one statement after another, its conditions as true or false. *)

Lemma go_return known procedures f now e rest v : eval known now e = Some v ->
  go known procedures (S f) now (Returns e :: rest) = Some (Some v, now).
Proof. intros E; cbn [go]; rewrite E; reflexivity. Qed.

(** Conditions whose parts are true or false. *)
Lemma not_bit (b : bool) : Some (Of Int (1 - (if b then 1 else 0))) = Some (Of Int (bit (negb b))).
Proof. destruct b; reflexivity. Qed.
Lemma eval_choice known now c a b x v w : eval known now c = Some (Of Int (bit x)) -> eval known now a = Some v -> eval known now b = Some w ->
  eval known now (Choice c a b) = Some (if x then v else w).
Proof. intros E F G; cbn [eval]; rewrite E; destruct x; [exact F | exact G]. Qed.
Lemma eval_chosen known now c a b x v : eval known now c = Some (Of Int (bit x)) -> (x = true -> eval known now a = Some v) ->
  (x = false -> eval known now b = Some v) -> eval known now (Choice c a b) = Some v.
Proof. intros E F G; cbn [eval]; rewrite E; destruct x; [exact (F eq_refl) | exact (G eq_refl)]. Qed.
Lemma eval_if known now c a b t z v w : eval known now c = Some (Of t z) -> eval known now a = Some v -> eval known now b = Some w ->
  eval known now (Choice c a b) = Some (if z =? 0 then w else v).
Proof. intros E F G; cbn [eval]; rewrite E; destruct (z =? 0); [exact G | exact F]. Qed.
Lemma eval_guarded known now l r x y : eval known now l = Some (Of Int (bit x)) -> (x = true -> eval known now r = Some (Of Int (bit y))) ->
  eval known now (Infix "&&" l r) = Some (Of Int (bit (x && y))).
Proof. intros E F; cbn [eval]; rewrite E; destruct x; [rewrite (F eq_refl); destruct y |]; reflexivity. Qed.
Lemma eval_both known now l r x y : eval known now l = Some (Of Int (bit x)) -> eval known now r = Some (Of Int (bit y)) ->
  eval known now (Infix "&&" l r) = Some (Of Int (bit (x && y))).
Proof. intros E F; cbn [eval]; rewrite E; destruct x; [rewrite F; destruct y |]; reflexivity. Qed.
Lemma eval_either known now l r x y : eval known now l = Some (Of Int (bit x)) -> eval known now r = Some (Of Int (bit y)) ->
  eval known now (Infix "||" l r) = Some (Of Int (bit (x || y))).
Proof. intros E F; cbn [eval]; rewrite E; destruct x; [| rewrite F; destruct y]; reflexivity. Qed.
Lemma go_if known procedures f now c yes no rest x : eval known now c = Some (Of Int (bit x)) ->
  go known procedures (S f) now (If c yes no :: rest) = go known procedures f now ((if x then yes else no) ++ rest)%list.
Proof. intros E; cbn [go]; rewrite E; destruct x; reflexivity. Qed.

(** The text of hc_fixed_position, for any shift and any lengths, where what it calls gives these signs of its numbers. *)
Section Answer.
Variables (m e : string -> Z) (num num' : string -> number) (small by_q by_t top_N top_ps k grown : Z).
Variables (terms cubic sign : list datum -> option datum) (at_B at_A : list datum -> option (list datum)) (guessed power : list datum -> Z).
Variables (sD s2 s1 oB sB oA sA sM : comparison) (wide : bool).
Let struct := struct_of num small by_q by_t top_N top_ps.
Let sign_asked n bound by_ := sign [Fix n; Of Int (said bound); Of Int by_].
Let certain s := Some (Of Int (sign_int s)).
Hypotheses (Terms : terms [row m e] = Some struct) (Cubic : cubic [struct] = Some (cubic_of num' k grown))
  (At_B : at_B [struct] = Some [Of Int (sign_int oB); Of Int (sign_int sB)]) (At_A : at_A [struct] = Some [Of Int (sign_int oA); Of Int (sign_int sA)])
  (S2 : sign_asked (num "n2") "coefficient" 0 = certain s2) (S1 : sign_asked (num "n1") "coefficient" 0 = certain s1)
  (SD : grown <= most_grown -> sign_asked (num' "delta") "delta" grown = certain sD)
  (SM : grown <= most_grown -> sign_asked (num' "middle") "middle" grown = certain sM)
  (Wide : compare_doubles ">=" (m "alpha") (e "alpha") (m "b") (e "b") = Some (if wide then 1 else 0)).

Definition position_calls := [("hc_fixed_terms_of", terms); ("hc_fixed_cubic_of", cubic);
  ("hc_fixed_double_root", fun given => Some (Double (guessed given) (power given))); ("hc_fixed_sign", sign)].
Definition position_procedures := [("hc_fixed_at_B", (1%nat, at_B)); ("hc_fixed_at_A", (1%nat, at_A))].

(** The answer by the signs; beyond the greatest shift without those of delta and at the inflection. *)
Definition tree_answer := if most_grown <? grown then fixed_answer Datatypes.Eq s2 s1 oB sB oA sA Datatypes.Eq wide
  else fixed_answer sD s2 s1 oB sB oA sA sM wide.

(** The two that are not asked for beyond it. *)
Let delta := if most_grown <? grown then Eq else sD.
Let middle := if most_grown <? grown then Eq else sM.
Lemma tree_answer_is : tree_answer = fixed_answer delta s2 s1 oB sB oA sA middle wide.
Proof. unfold tree_answer, delta, middle; destruct (_ <? _); reflexivity. Qed.

Ltac open text := eval cbv -[Z.ltb Z.sub compare_doubles said most_grown sign_int] in text.
Ltac opened := lazymatch goal with |- ?text = ?answer => let v := open text in change (v = answer) end.
Ltac known_calls := match goal with
  | H : ?l = _ |- context [?l] => rewrite H end.
Ltac evaluated := opened; repeat (known_calls; opened); reflexivity.
Ltac to_bit := opened; repeat (known_calls; opened); lazymatch goal with
  | |- Some (Of Int (if ?x then 1 else 0)) = _ => exact (eq_refl (Some (Of Int (bit x))))
  | |- Some (Of Int (1 - (if ?x then 1 else 0))) = _ => exact (not_bit x) end.
Ltac in_bits := lazymatch goal with
  | |- eval _ _ (Infix "&&" _ _) = _ => eapply eval_both; [in_bits | in_bits]
  | |- eval _ _ (Infix "||" _ _) = _ => eapply eval_either; [in_bits | in_bits]
  | |- _ => first [eapply eval_infix; [reflexivity | evaluated | evaluated | to_bit] | to_bit] end.
Ltac put_by evaluated := eapply put_ends; [reflexivity | evaluated | reflexivity | cbv [bound app map fst snd append]; reflexivity |].
Ltac branch := eapply if_ends; [in_bits | let H := fresh "Yes" in intros H | let H := fresh "No" in intros H]; cbn [app].
Ltac calls := eapply calling_ends; [reflexivity | evaluated | evaluated | cbv [bound_all skipn bound app map fst snd append]; reflexivity |].
Ltac returns := eapply return_ends; [| cbv beta iota].
(** What is returned is the answer, for all signs that lead there. *)
Ltac for_all_signs := repeat match goal with H : @eq bool _ _ |- _ => revert H end; clear; cbv [sign_int fixed_answer];
  let settled := try (cbv [Z.ltb Z.compare andb orb negb]; intros; (discriminate || reflexivity)) in
  repeat match goal with |- context [match ?s with _ => _ end] => is_var s; destruct s; settled end.

Theorem position_text : called functions position_calls position_procedures "hc_fixed_position" [row m e] = Some (Of Int (code tree_answer)).
Proof.
  rewrite tree_answer_is; unfold sign_asked, certain, struct in *.
  cbv [row struct_of cubic_of map combine fst snd lengths] in Terms, Cubic, At_B, At_A.
  begins_to_end "hc_fixed_position".
  do 2 put_by evaluated.
  put_by ltac:(eapply eval_chosen with (x := most_grown <? grown) (v := Of Int (sign_int delta));
    [in_bits | intros L; unfold delta; rewrite L; reflexivity | intros L; unfold delta; rewrite L; apply Z.ltb_ge, SD in L; evaluated]).
  do 2 put_by evaluated.
  eapply put_ends; [reflexivity | eapply eval_if; evaluated | reflexivity | |].
  { match goal with |- bound ?n ?v ?now = _ => instantiate (1 := (n, v) :: now) end; destruct (_ =? 0); reflexivity. }
  cbv beta; branch; [| branch; [calls; branch; [| branch] | branch; [branch; [| calls; branch] |]]].
  all: lazymatch goal with |- ends _ _ _ _ _ (Returns (Choice _ _ _) :: _) => idtac | _ => returns; [evaluated |] end.
  4: returns; [eapply eval_choice; [eapply eval_guarded; [in_bits | intros L] | evaluated | evaluated] |].
  4: { apply andb_prop in L as [_ L]; apply negb_true_iff, Z.ltb_ge, SM in L; in_bits. }
  7: returns; [eapply eval_choice; [in_bits | evaluated | evaluated] |].
  all: unfold delta, middle in *; destruct (most_grown <? grown).
  all: for_all_signs.
Qed.
End Answer.

(** The same of the functions that it calls, run too: each sign is that of its number beyond its own bound. *)
Section Signs.
Variables (m e : string -> Z) (num num' : string -> number) (shift : string -> Z) (small top_N top_ps k grown : Z).
Variables guessed power : list datum -> Z.
Let struct := struct_of num small (shift "by_q") (shift "by_t") top_N top_ps.
Definition of_terms n given := called functions known [] n given.
Definition sign_function := match look "hc_fixed_sign" of_words with Some f => f | None => fun _ => None end.
Definition answer_of_text := called functions
  (position_calls (of_terms "hc_fixed_terms_of") (of_terms "hc_fixed_cubic_of") sign_function guessed power)
  (position_procedures (puts functions known [] "hc_fixed_at_B") (puts functions known [] "hc_fixed_at_A")) "hc_fixed_position" [row m e].
Hypotheses (Terms : of_terms "hc_fixed_terms_of" [row m e] = Some struct) (Cubic : of_terms "hc_fixed_cubic_of" [struct] = Some (cubic_of num' k grown))
  (At_B : Forall (is_computed shift num) C_at_B) (At_A : Forall (is_computed shift num) C_at_A)
  (Q0 : 0 <= shift "by_q") (T0 : 0 <= shift "by_t") (Grown : 0 <= grown).

Definition beyond (num : string -> number) n bound := sign_of (num n) (said bound).
Definition beyond_grown n := sign_of (num' n) (said n * 2 ^ grown).
Definition not_shorter := negb (in_unit (m "alpha") (e "alpha") (e "b") <? in_unit (m "b") (e "b") (e "alpha")).

Lemma bounded_is n : In n ["delta"; "middle"] -> grown <= most_grown -> bounded (said n) grown = true.
Proof.
  intros I L; assert (P : 0 < 2 ^ grown <= 2 ^ most_grown) by (split; [apply Z.pow_pos_nonneg; lia | apply Z.pow_le_mono_r; lia]).
  assert (S : 0 <= said n /\ said n * 2 ^ most_grown < bits128 /\ most_grown < 128) by (destruct I as [<- | [<- | []]]; vm_compute; repeat split; discriminate).
  unfold bounded; rewrite !andb_true_iff, !Z.leb_le, !Z.ltb_lt; nia.
Qed.

Theorem answer_is_fixed_answer : answer_of_text = Some (Of Int (code (tree_answer grown (beyond_grown "delta") (beyond num "n2" "coefficient")
  (beyond num "n1" "coefficient") (beyond num "offset_at_B" "pole") (beyond num "slope_at_B" "pole") (beyond num "offset_at_A" "pole")
  (beyond num "slope_at_A" "pole") (beyond_grown "middle") not_shorter))).
Proof.
  assert (P : forall n, asked num n = Of Int (sign_int (beyond num n "pole"))) by (intros n; unfold asked, sign_at, beyond; rewrite Z.mul_1_r; reflexivity).
  apply (position_text m e num num' small (shift "by_q") (shift "by_t") top_N top_ps k grown).
  - exact Terms.
  - exact Cubic.
  - rewrite <- !P; apply at_B_text with shift; trivial.
  - rewrite <- !P; apply at_A_text with shift; trivial.
  - unfold beyond; rewrite <- (Z.mul_1_r (said "coefficient")) at 2; reflexivity.
  - unfold beyond; rewrite <- (Z.mul_1_r (said "coefficient")) at 2; reflexivity.
  - intros L; cbn -[bounded said Z.mul Z.pow most_grown]; rewrite bounded_is by (cbn; tauto || exact L); reflexivity.
  - intros L; cbn -[bounded said Z.mul Z.pow most_grown]; rewrite bounded_is by (cbn; tauto || exact L); reflexivity.
  - unfold not_shorter; cbn -[in_unit carry]; unfold carry; destruct (_ <? _); reflexivity.
Qed.
End Signs.
