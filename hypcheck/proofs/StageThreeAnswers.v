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
  repeat match goal with E : _ = _ |- _ => set_apart E end.
  begins "hc_fixed_at_B"; runs_through.
Qed.

Theorem at_A_text : Forall (is_computed shift num) C_at_A -> shift "by_q" = by_q -> shift "by_t" = by_t -> 0 <= by_q -> 0 <= by_t ->
  puts functions known [] "hc_fixed_at_A" [terms] = Some [asked "offset_at_A"; asked "slope_at_A"].
Proof.
  intros F Q T Q0 T0; unfold C_at_A in F; equations F; rewrite Q, T in *; clear Q T.
  repeat match goal with E : _ = _ |- _ => set_apart E end.
  begins "hc_fixed_at_A"; runs_through.
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
  assert (Q2 : -60000 <= Z.quot (top_0 - top_2) 2 <= 60000) by (rewrite <- Eq1; apply Q1).
  assert (Q3 : -60000 <= Z.quot (top_1 - top_3) 2 <= 60000) by (rewrite <- Eq2; apply Q1).
  assert (Q4 : -60000 <= Z.quot (top_0 - top_3) 3 <= 60000) by (rewrite <- Eq3; apply Q1).
  assert (L : -60000 <= least <= 60000 /\ -60000 <= most <= 60000) by (clear - Eleast Emost T1 T2 Q1; lia).
  assert (K : -60000 <= k <= 60000) by (clear - Ek L; lia).
  assert (D : 0 <= down_3 /\ 0 <= down_2 /\ 0 <= down_1 /\ 0 <= down_0) by (clear - Etop Edown_3 Edown_2 Edown_1 Edown_0; lia).
  assert (T : -300000 <= top <= 300000) by (clear - Etop T1 T2 B0 B3 K; lia).
  assert (D' : down_3 <= 600000 /\ down_2 <= 600000 /\ down_1 <= 600000 /\ down_0 <= 600000) by (clear - T K T1 T2 B0 B3 Edown_3 Edown_2 Edown_1 Edown_0; lia).
  assert (U : 0 <= up_2 <= 125 /\ 0 <= up_1 <= 125) by (clear - R2 R1 Eup_2 Eup_1; lia).
  unfold C_discriminant in Steps; equations Steps.
  repeat match goal with E : _ = _ |- _ => set_apart E end.
  begins "hc_fixed_cubic_of"; runs_through.
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
Definition bit (b : bool) := if b then 1 else 0.
Lemma eval_choice known now c a b x v w : eval known now c = Some (Of Int (bit x)) -> eval known now a = Some v -> eval known now b = Some w ->
  eval known now (Choice c a b) = Some (if x then v else w).
Proof. intros E F G; cbn [eval]; rewrite E; destruct x; [exact F | exact G]. Qed.
Lemma eval_both_no known now l r x : eval known now l = Some (Of Int (bit x)) -> x = false -> eval known now (Infix "&&" l r) = Some (Of Int (bit false)).
Proof. intros E ->; cbn [eval]; rewrite E; reflexivity. Qed.
Lemma eval_both known now l r x y : eval known now l = Some (Of Int (bit x)) -> eval known now r = Some (Of Int (bit y)) ->
  eval known now (Infix "&&" l r) = Some (Of Int (bit (x && y))).
Proof. intros E F; cbn [eval]; rewrite E; destruct x; [rewrite F; destruct y |]; reflexivity. Qed.
Lemma eval_either known now l r x y : eval known now l = Some (Of Int (bit x)) -> eval known now r = Some (Of Int (bit y)) ->
  eval known now (Infix "||" l r) = Some (Of Int (bit (x || y))).
Proof. intros E F; cbn [eval]; rewrite E; destruct x; [| rewrite F; destruct y]; reflexivity. Qed.
Lemma go_if known procedures f now c yes no rest x : eval known now c = Some (Of Int (bit x)) ->
  go known procedures (S f) now (If c yes no :: rest) = go known procedures f now ((if x then yes else no) ++ rest)%list.
Proof. intros E; cbn [go]; rewrite E; destruct x; reflexivity. Qed.
Lemma go_calling known procedures f now g given rest k m l got now' : look g procedures = Some (k, m) ->
  every (map (eval known now) (firstn k given)) = Some l -> m l = Some got -> bound_all (skipn k given) got now = Some now' ->
  go known procedures (S f) now (Calling g given :: rest) = go known procedures f now' rest.
Proof. intros K L M B; cbn [go]; rewrite K, L, M, B; reflexivity. Qed.

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

Ltac open text := eval cbv -[Z.ltb compare_doubles said most_grown sign_int] in text.
Ltac opened := lazymatch goal with |- ?text = ?answer => let v := open text in change (v = answer) end.
(** Comparisons of signs that are known. *)
Ltac settled := repeat match goal with |- context [Z.ltb ?a ?c] =>
  let v := eval vm_compute in (Z.ltb a c) in lazymatch v with true => idtac | false => idtac end; change (Z.ltb a c) with v end.
Ltac known_calls := match goal with
  | H : ?l = _ |- context [?l] => rewrite H end.
Ltac evaluated := opened; repeat (first [known_calls | progress settled]; opened); reflexivity.
Ltac to_bit := opened; repeat (first [known_calls | progress settled]; opened); lazymatch goal with
  | |- Some (Of Int 0) = _ => exact (eq_refl (Some (Of Int (bit false))))
  | |- Some (Of Int 1) = _ => exact (eq_refl (Some (Of Int (bit true))))
  | |- Some (Of Int (if ?x then 1 else 0)) = _ => exact (eq_refl (Some (Of Int (bit x)))) end.
Ltac in_bits := lazymatch goal with
  | |- eval _ _ (Choice _ _ _) = _ => eapply eval_choice; [in_bits | evaluated | evaluated]
  | |- eval _ _ (Infix "&&" _ _) = _ => first [eapply eval_both_no; [in_bits | solve [reflexivity | apply andb_false_r]] | eapply eval_both; [in_bits | in_bits]]
  | |- eval _ _ (Infix "||" _ _) = _ => eapply eval_either; [in_bits | in_bits]
  | |- _ => first [eapply eval_infix; [reflexivity | evaluated | evaluated | to_bit] | to_bit] end.
Ltac evaluated_constant := lazymatch goal with |- eval _ _ (Choice _ _ _) = _ => fail | _ => evaluated end.
Ltac next := match goal with
  | |- context [go _ _ _ _ (Set_ _ _ _ :: _)] => erewrite go_put; [| reflexivity | evaluated | reflexivity]; cbv [bound app map fst snd append]
  | |- context [go _ _ _ _ (If _ _ _ :: _)] => erewrite go_if; [| in_bits]
  | |- context [go _ _ _ _ (Returns _ :: _)] => erewrite go_return; [| first [evaluated_constant | in_bits]]; cbv beta iota
  | |- context [go _ _ _ _ (Calling _ _ :: _)] => erewrite go_calling; [| reflexivity | evaluated | evaluated | reflexivity];
    cbv [bound_all skipn bound app map fst snd append] end.

Theorem position_text : called functions position_calls position_procedures "hc_fixed_position" [row m e] = Some (Of Int (code tree_answer)).
Proof.
  unfold sign_asked, certain, struct in *.
  cbv [row struct_of cubic_of map combine fst snd lengths] in Terms, Cubic, At_B, At_A.
  unfold called; function "hc_fixed_position"; cbv beta iota;
  match goal with |- context [bound_all ?a ?b ?c] => let v := open (bound_all a b c) in change (bound_all a b c) with v end; cbv iota beta;
  cbn [does]; change steps with 100%nat.
  unfold tree_answer; destruct (Z.ltb_spec most_grown grown) as [L | L];
    [apply Z.ltb_lt in L; clear SD SM | specialize (SD L); specialize (SM L); apply Z.ltb_ge in L].
  all: do 3 next; [.. | destruct sD].
  all: do 4 next; cbn [app].
  Ltac branches := repeat (cbn [app]; match goal with
    | |- context [if true then ?a else ?b] => change (if true then a else b) with a
    | |- context [if false then ?a else ?b] => change (if false then a else b) with b
    | |- context [((if ?x then _ else _) ++ _)%list] => destruct x eqn:? end); cbn [app].
  all: branches.
  all: repeat (next; branches).
  all: clear L; repeat match goal with H : @eq bool _ _ |- _ => revert H end; clear; destruct s2, s1; try (cbv [sign_int Z.ltb Z.compare andb orb]; intros; discriminate);
    cbn [fixed_answer code].
  all: repeat match goal with s : comparison |- _ => clear s | s : bool |- _ => clear s end.
  all: try destruct oB; try destruct sB; try destruct oA; try destruct sA; try destruct sM; try destruct wide; cbv [sign_int code Z.ltb Z.compare andb orb]; intros; reflexivity || discriminate.
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
