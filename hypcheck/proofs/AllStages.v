(** All stages of one row, from the bits of its doubles and the text of the C to the position: of floats, of 128-bit numbers, and of long
    integers in limbs of 64 or of 32 bits.

    The row is seven words that the text of hc_valid accepts; the lengths of the pair are Flocq's values of these bits. Of floats is
    supposed what StagesOfFloats.v supposes, of stage 4 what StagesRuns.v supposes. *)

Require Import List String ZArith Reals Lia Bool.
From Flocq Require Import Core IEEE754.Binary IEEE754.Bits.
From Hypcheck Require Import Geometry Positions Stages Steps FixedRuns Long Limbs Trees LongIntegers StageThreeRuns StageThreeAnswers StageThreeNumbers
  StageThreePosition StageFiveAnswers StageFiveIntegers Doubles StagesRuns StagesOnDoubles DoubleValues StagesOfFloats.
From Hypcheck Require FloatTexts CertifiedText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Section Row.
Variable w : string -> Z.
Hypotheses (Words : forall n, In n lengths -> is_word (w n)) (Accepted : returned "hc_valid" [words_of w] = Some (Of Int 1)).
Definition value n := B2R 53 1024 (b64_of_bits (w n)).
Definition pair := upright (value "alpha") (value "gamma") (value "b") (value "d") (value "x") (value "y") (value "z").
Let m n := whole_of (w n).
Let e n := power_of (w n).

Lemma value_on_bits n : In n lengths -> value_of_bits (w n) = value n.
Proof. intros I; symmetry; apply value_is_binary64; [exact (Words n I) | apply (valid_words w (accepted_is_valid w Accepted) n I)]. Qed.
Lemma values_on_bits : value_of_bits (w "alpha") = value "alpha" /\ value_of_bits (w "gamma") = value "gamma" /\ value_of_bits (w "b") = value "b"
  /\ value_of_bits (w "d") = value "d" /\ value_of_bits (w "x") = value "x" /\ value_of_bits (w "y") = value "y" /\ value_of_bits (w "z") = value "z".
Proof. repeat split; apply value_on_bits; cbn; tauto. Qed.
Lemma pair_on_bits : pair_of_bits w = pair.
Proof. unfold pair_of_bits, pair; destruct values_on_bits as (-> & -> & -> & -> & -> & -> & ->); reflexivity. Qed.

(** The floats of one pair and of stage 2. *)
Variables (x pre x' pre' : string -> R) (greater : argument -> argument -> bool) (mask : Z -> string -> Z).
Hypothesis Masks : forall at_ n, 0 <= mask at_ n < 2 ^ 1.
(** What stage 5 returns, its integers in limbs and anything in memory. *)
Variables (bits : Z) (memory : memory) (integers : list datum -> option datum).
Hypotheses (Bits : bits = 32 \/ bits = 64)
  (On_limbs : forall v, ends_on_limbs lowest bits StageFiveAnswers.functions "hc_position_by_integers" [row m e] memory (fun y => y = v) -> integers [row m e] = Some v).
(** Stage 4, the guess that stage 3 leaves to it, and whether floats decide. *)
Variables (guessed power_guessed : list datum -> Z) (guess power_of_guess : Z) (tangency : list datum -> option datum) (floats : Z).
Hypotheses
  (Fourth : exists o, tangency [row m e; Double guess power_of_guess] = Some (Of Int (code o)) /\ forall a, o = Some a ->
    answers (value "alpha") (value "gamma") (value "b") (value "d") (value "x") (value "y") (value "z") a)
  (Floats : floats <> 0 -> single_runs m e x pre greater /\ stage_two_runs m e x' pre' mask).

Theorem position_is_right : exists a, called_with floats functions (stage_calls (text_of_single greater) (text_of_certified mask) (valid_on_bits w)
  (exact_on_limbs integers guessed power_guessed guess power_of_guess tangency)) [] "hc_position_of" [row m e] = Some (Of Int (code (Some a))) /\ is_position pair a.
Proof.
  rewrite <- pair_on_bits.
  apply (stages_on_doubles w Words Accepted bits memory integers Bits On_limbs guessed power_guessed guess power_of_guess tangency).
  - destruct values_on_bits as (-> & -> & -> & -> & -> & -> & ->); exact Fourth.
  - intros F; destruct (single_answers m e x pre greater (proj1 (Floats F))) as (o & E & A); exists o; split; [exact E |].
    intros a H; rewrite <- (pair_is w Words); exact (A a H).
  - intros F; destruct (stage_two_answers m e x' pre' mask Masks (proj2 (Floats F))) as (o & plus & minus & E & A); exists o, plus, minus; split; [exact E |].
    intros a H; rewrite <- (pair_is w Words); exact (A a H).
  - intros _; exact (stage_two_ends m e mask Masks).
Qed.
End Row.
