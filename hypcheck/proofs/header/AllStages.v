(** All stages of one row, from the bits of its doubles and the text of the C to the position: of floats, of 128-bit numbers, and of long
    integers in limbs of 64 or of 32 bits.

    The row is seven words that the text of hc_valid accepts; the lengths of the pair are Flocq's values of these bits. Of the floats of
    one pair and of stage 2 is supposed what StagesOfFloats.v supposes; of those of stage 4, that 10^-18 and its products with b and γ
    are rounded in some mode, and of the first guess of a double root, that its whole number is no greater than the test before it
    allows. Of hc_short_lengths is supposed that it puts the lengths as whole numbers. *)

Require Import List String ZArith Reals Lia Bool.
From Flocq Require Import Core IEEE754.Binary IEEE754.Bits.
From Hypcheck Require Import Geometry Positions Stages Steps FixedRuns Long Limbs Trees LongIntegers StageThreeRuns StageThreeAnswers StageThreeNumbers
  StageThreePosition StageFiveAnswers StageFiveIntegers Doubles StagesRuns StagesOnDoubles DoubleValues StagesOfFloats StageFourGuesses
  StageFourExact StageFourHair.
From Hypcheck Require FloatTexts CertifiedText Ranges StageFourShort StageFourTouches StageFourPosition.
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
(** Stage 4: its floats, which are numbers that it takes for guesses; its products with 10^-18; and what puts lengths as whole numbers. *)
Variables (float : string -> list datum -> Z) (less : datum -> datum -> bool) (nearest word : Z -> Z) (hair : Z -> Z -> Z * Z) (factor : R)
  (put_lengths : list datum -> option (list datum)).
Hypotheses
  (Half_up : forall size n, is_float size -> 0 <= n < 2 ^ 46 -> less (Of Int 0) size = true ->
    StageFourShort.cut_half_up float less word (made_by float "*" [size; StageFourShort.double_of float n])
    /\ StageFourShort.cut_half_up float less word (made_by float "/" [StageFourShort.double_of float n; size]))
  (Nearest : forall size n, is_float size -> 0 <= n < 2 ^ 124 -> less (Of Int 0) size = true ->
    StageFourTouches.is_nearest less nearest (made_by float "*" [size; StageFourTouches.value_of float n])
    /\ StageFourTouches.is_nearest less nearest (made_by float "/" [StageFourTouches.value_of float n; size]))
  (Factor : Ranges.rounded (1 / 10 ^ 18)%R factor)
  (Products : forall n, In n ["b"; "gamma"] -> Ranges.returned (factor * value n)%R (StageFourPosition.hair_value m e hair n))
  (Puts : StageFourPosition.puts_lengths put_lengths).
Let tangency := text_of_tangency float less nearest word hair put_lengths.
(** The guess of a double root that stage 3 leaves to stage 4, and whether floats decide. *)
Variables (guessed power_guessed : list datum -> Z) (guess power_of_guess : Z) (floats : Z).
Hypothesis Floats : floats <> 0 -> single_runs m e x pre greater /\ stage_two_runs m e x' pre' mask.

Let bits_value n := value_of_bits (w n).
Lemma fourth : exists o, tangency [row m e; Double guess power_of_guess] = Some (Of Int (code o)) /\ forall a, o = Some a -> answers
  (bits_value "alpha") (bits_value "gamma") (bits_value "b") (bits_value "d") (bits_value "x") (bits_value "y") (bits_value "z") a.
Proof.
  destruct (valid_row w Words (accepted_is_valid w Accepted)) as (L & C & P & M), (values_are w Words) as (Ea & Eg & Eb & Ed & Ex & Ey & Ez).
  assert (H : StageFourPosition.hairs_are_short m e hair).
  { apply (products_are_short m e lowest lowest_counts L P M hair factor Factor).
    intros n I; assert (E : value_of m e n = value n) by (destruct I as [<- | [<- | []]]; (etransitivity; [exact Eb || exact Eg | apply value_on_bits; cbn; tauto])).
    rewrite E; exact (Products n I). }
  unfold bits_value; rewrite <- Ea, <- Eg, <- Eb, <- Ed, <- Ex, <- Ey, <- Ez.
  exact (fourth_is_right m e L C P float less nearest word hair Half_up Nearest H put_lengths Puts (Double guess power_of_guess) I).
Qed.

Theorem position_is_right : exists a, called_with floats functions (stage_calls (text_of_single greater) (text_of_certified mask) (valid_on_bits w)
  (exact_on_limbs integers guessed power_guessed guess power_of_guess tangency)) [] "hc_position_of" [row m e] = Some (Of Int (code (Some a))) /\ is_position pair a.
Proof.
  rewrite <- pair_on_bits.
  apply (stages_on_doubles w Words Accepted bits memory integers Bits On_limbs guessed power_guessed guess power_of_guess tangency).
  - exact fourth.
  - intros F; destruct (single_answers m e x pre greater (proj1 (Floats F))) as (o & E & A); exists o; split; [exact E |].
    intros a H; rewrite <- (pair_is w Words); exact (A a H).
  - intros F; destruct (stage_two_answers m e x' pre' mask Masks (proj2 (Floats F))) as (o & plus & minus & E & A); exists o, plus, minus; split; [exact E |].
    intros a H; rewrite <- (pair_is w Words); exact (A a H).
  - intros _; exact (stage_two_ends m e mask Masks).
Qed.
End Row.
