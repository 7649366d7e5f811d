(** The stages on the bits of doubles: a row that the text of hc_valid accepts is answered with the position of the pair whose lengths
    are the values of these doubles.

    What stages 3 and 5 read of a double is what the texts of hc_fixed_parts_of and hc_parts_of make of its bits: Doubles.v. Of one pair,
    of stage 2 and of stage 4 it is assumed what StagesRuns.v assumes. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Hypcheck Require Import LongIntegers Doubles Steps Fixed Long Limbs Trees StageThreeRuns StageThreeAnswers StageThreeNumbers StageThreePosition StageFive StageFiveAnswers
  StageFiveLimbs StageFiveIntegers StagesRuns Geometry Stages Positions.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** The value of a double, as IEEE 754 says. *)
Definition value_of_bits w : R := ((if sign_bit w =? 0 then 1 else -1) * IZR (raw_size w) * power (raw_power w - 1075))%R.

Theorem whole_is_value w : is_word w -> (IZR (whole_of w) * power (power_of w - 1075) = value_of_bits w)%R.
Proof.
  intros Word; unfold value_of_bits.
  assert (S : (IZR (size_of w) * power (power_of w - 1075) = IZR (raw_size w) * power (raw_power w - 1075))%R).
  { unfold size_of, power_of, raw_size, raw_power; destruct (Z.eqb_spec (exponent_bits w) 0) as [E |]; [| reflexivity]; destruct (Z.eqb_spec (fraction w) 0) as [-> | F]; [rewrite !Rmult_0_l; reflexivity |].
    destruct (shifted_size w Word F) as [K _]; rewrite mult_IZR, power_whole by lia; rewrite Rmult_assoc, <- power_sum; do 2 f_equal; ring. }
  unfold whole_of; destruct (sign_bit w =? 0); [rewrite S; ring | rewrite opp_IZR, Ropp_mult_distr_l_reverse, S; ring].
Qed.

(** The models of the two functions are what their text makes of the bits. *)
Theorem fixed_parts_are w : is_word w -> parts_in (returned "hc_fixed_parts_of" [Of U64 w]) = parts_in (snd parts_of [Double (whole_of w) (power_of w)]).
Proof. exact (fixed_parts_text w). Qed.
Definition model_of_parts zeros := look "hc_parts_of" (of_integers zeros).
Theorem parts_are w : is_word w -> parts_in (returned "hc_parts_of" [Of U64 w]) = parts_in (try f <- model_of_parts lowest; f [Double (whole_of w) (power_of w)]).
Proof. exact (parts_text w). Qed.
Theorem lowest_counts : counts_zeros lowest.
Proof. split; exact lowest_divides. Qed.

Section Rows.
(** The bits of seven doubles that hc_valid accepts. *)
Variable w : string -> Z.
Hypotheses (Words : forall n, In n lengths -> is_word (w n)) (Accepted : returned "hc_valid" [words_of w] = Some (Of Int 1)).
Let m n := whole_of (w n).
Let e n := power_of (w n).
Let value n := value_of_bits (w n).
Definition pair_of_bits := upright (value "alpha") (value "gamma") (value "b") (value "d") (value "x") (value "y") (value "z").

Lemma accepted_is_valid : is_valid w = true.
Proof. rewrite valid_text in Accepted; destruct (is_valid w); [reflexivity | discriminate]. Qed.
Lemma value_is n : In n lengths -> value_of m e n = value n.
Proof. intros I; exact (whole_is_value (w n) (Words n I)). Qed.
Lemma values_are : value_of m e "alpha" = value "alpha" /\ value_of m e "gamma" = value "gamma" /\ value_of m e "b" = value "b" /\ value_of m e "d" = value "d"
  /\ value_of m e "x" = value "x" /\ value_of m e "y" = value "y" /\ value_of m e "z" = value "z".
Proof. repeat split; apply value_is; cbn; tauto. Qed.
Ltac values := destruct values_are as (-> & -> & -> & -> & -> & -> & ->).
Lemma pair_is : upright (value_of m e "alpha") (value_of m e "gamma") (value_of m e "b") (value_of m e "d") (value_of m e "x") (value_of m e "y") (value_of m e "z") = pair_of_bits.
Proof. values; reflexivity. Qed.

(** Stage 5 on limbs. *)
Theorem limbs_on_doubles bits memory : bits = 32 \/ bits = 64 -> exists a, is_position pair_of_bits a
  /\ ends_on_limbs lowest bits StageFiveAnswers.functions "hc_position_by_integers" [row m e] memory (fun v => v = Of Int (code (Some a))).
Proof.
  intros Bits; destruct (valid_row w Words accepted_is_valid) as (L & C & P & M).
  destruct (limbs_answer_the_position m e lowest lowest_counts) with (bits := bits) (memory := memory) as (a & _ & E & R); try exact Bits.
  - intros n I; specialize (L n I); unfold m; lia.
  - exact (mantissas m L C).
  - intros n I N; split; [apply P; exact I | exact (M n I N)].
  - exists a; rewrite <- pair_is; split; assumption.
Qed.

(** The stages one after another. *)
Section Stages.
Variables (guessed power_guessed : list datum -> Z) (guess power_of_guess : Z) (tangency single certified : list datum -> option datum) (floats : Z).
Hypotheses
  (Fourth : exists o, tangency [row m e; Double guess power_of_guess] = Some (Of Int (code o)) /\ forall a, o = Some a ->
    answers (value "alpha") (value "gamma") (value "b") (value "d") (value "x") (value "y") (value "z") a)
  (Single : floats <> 0 -> exists o, single [row m e] = Some (Of Int (code o)) /\ forall a, o = Some a -> is_position pair_of_bits a)
  (Certified : floats <> 0 -> exists o plus minus, certified [row m e; Of Int 1; Of Int 1] = Some (found o plus minus) /\ forall a, o = Some a -> is_position pair_of_bits a)
  (Undecided : floats = 0 -> exists plus minus decided, certified [row m e; Of Int 1; Of Int 1] = Some (bits_of_stage plus minus decided)).
Definition valid_on_bits (given : list datum) := returned "hc_valid" [words_of w].

Theorem stages_on_doubles : exists a, called_with floats functions (stage_calls single certified valid_on_bits
  (exact_answer_of_text lowest guessed power_guessed guess power_of_guess tangency)) [] "hc_position_of" [row m e] = Some (Of Int (code (Some a))) /\ is_position pair_of_bits a.
Proof.
  destruct (valid_row w Words accepted_is_valid) as (L & C & P & M); rewrite <- pair_is in *.
  apply (stages_are_right m e lowest lowest_counts L C P M guessed power_guessed guess power_of_guess tangency); try assumption.
  values; exact Fourth.
Qed.
End Stages.
End Rows.
