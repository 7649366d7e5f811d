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

(** The text of hc_fixed_position where what it calls gives these signs: of each of four numbers, told apart by their low words, if it
    is asked with the bound and the shift that belong to it. *)
Section Answer.
Variables (delta c2 c1 offset_B slope_B offset_A slope_A middle : comparison) (grown alpha b : Z).

Definition asked_with (number bound shift : Z) := match find (fun p => (fst (fst (fst p)) =? number) && (snd (fst (fst p)) =? bound) && (snd (fst p) =? shift))
  [(1, said "coefficient", 0, c1); (2, said "coefficient", 0, c2); (3, said "delta", grown, delta); (4, said "middle", grown, middle)] with
  | Some p => Some (Of Int (sign_int (snd p))) | None => None end.
Definition signs : list (string * (list datum -> option datum)) := [
  ("hc_fixed_terms_of", fun _ => Some (Rec [("n1", Fix (Words 1 0)); ("n2", Fix (Words 2 0))]));
  ("hc_fixed_cubic_of", fun _ => Some (Rec [("delta", Fix (Words 3 0)); ("middle", Fix (Words 4 0)); ("grown", Of Int grown)]));
  ("hc_fixed_double_root", fun _ => Some (Double 0 0));
  ("hc_fixed_sign", fun given => match given with [Fix n; Of Int bound; Of Int shift] => asked_with (low_word n) bound shift | _ => None end)].
Definition at_poles : list (string * (nat * (list datum -> option (list datum)))) := [
  ("hc_fixed_at_B", (1%nat, fun _ => Some [Of Int (sign_int offset_B); Of Int (sign_int slope_B)]));
  ("hc_fixed_at_A", (1%nat, fun _ => Some [Of Int (sign_int offset_A); Of Int (sign_int slope_A)]))].
Definition sizes := Rec [("0", Double alpha 0); ("1", Double 1 0); ("2", Double b 0); ("3", Double 1 0); ("4", Double 0 0); ("5", Double 0 0); ("6", Double 0 0)].
Definition tree_of_answers := called functions signs at_poles "hc_fixed_position" [sizes].
End Answer.

(** The tree is that of fixed_answer, without the signs of delta and at the inflection beyond the greatest shift: for all signs, at the
    greatest shift with alpha below b and at b, and at the next shift. *)
Definition is_so sD s2 s1 oB sB oA sA sM grown alpha := match tree_of_answers sD s2 s1 oB sB oA sA sM grown alpha 2 with
  | Some (Of Int z) => z =? code (if most_grown <? grown
    then fixed_answer Datatypes.Eq s2 s1 oB sB oA sA Datatypes.Eq (2 <=? alpha) else fixed_answer sD s2 s1 oB sB oA sA sM (2 <=? alpha))
  | _ => false end.
Definition at_each f := forallb f [Datatypes.Eq; Lt; Gt].

Theorem answers_are_fixed_answer : forallb (fun at_shift => at_each (fun sD => at_each (fun s2 => at_each (fun s1 => at_each (fun oB => at_each (fun sB =>
  at_each (fun oA => at_each (fun sA => at_each (fun sM => is_so sD s2 s1 oB sB oA sA sM (fst at_shift) (snd at_shift))))))))))
  [(most_grown, 1); (most_grown, 2); (most_grown + 1, 2)] = true.
Proof. vm_cast_no_check (eq_refl true). Qed.
