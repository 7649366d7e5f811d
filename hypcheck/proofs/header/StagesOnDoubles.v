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
Lemma values_positive : (0 < value "alpha" /\ 0 < value "gamma" /\ 0 < value "b" /\ 0 < value "d")%R.
Proof.
  destruct (valid_row w Words accepted_is_valid) as (L & _).
  repeat split; rewrite <- value_is by (cbn; tauto); apply (sizes_positive m e L); cbn; tauto.
Qed.
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

(** So there is a function that returns what the text returns on limbs. *)
Corollary function_on_limbs bits memory : bits = 32 \/ bits = 64 -> exists integers : list datum -> option datum, forall v,
  ends_on_limbs lowest bits StageFiveAnswers.functions "hc_position_by_integers" [row m e] memory (fun x => x = v) -> integers [row m e] = Some v.
Proof.
  intros Bits; destruct (limbs_on_doubles bits memory Bits) as (a & _ & E); exists (fun _ => Some (Of Int (code (Some a)))); intros v H.
  destruct (one_is_returned _ _ _ _ _ _ _ _ E H) as (x & -> & <-); reflexivity.
Qed.

(** The stages one after another, with the text of stage 5 on limbs. *)
Section Stages.
Variables (bits : Z) (memory : memory) (integers : list datum -> option datum).
Hypothesis Bits : bits = 32 \/ bits = 64.
Hypothesis On_limbs : forall v, ends_on_limbs lowest bits StageFiveAnswers.functions "hc_position_by_integers" [row m e] memory (fun x => x = v) -> integers [row m e] = Some v.
Variables (guessed power_guessed : list datum -> Z) (guess power_of_guess : Z) (tangency single certified : list datum -> option datum) (floats : Z).
Hypotheses
  (Fourth : exists o, tangency [row m e; Double guess power_of_guess] = Some (Of Int (code o)) /\ forall a, o = Some a ->
    answers (value "alpha") (value "gamma") (value "b") (value "d") (value "x") (value "y") (value "z") a)
  (Single : floats <> 0 -> exists o, single [row m e] = Some (Of Int (code o)) /\ forall a, o = Some a -> is_position pair_of_bits a)
  (Certified : floats <> 0 -> exists o plus minus, certified [row m e; Of Int 1; Of Int 1] = Some (found o plus minus) /\ forall a, o = Some a -> is_position pair_of_bits a)
  (Undecided : floats = 0 -> exists plus minus decided, certified [row m e; Of Int 1; Of Int 1] = Some (bits_of_stage plus minus decided)).
Definition valid_on_bits (given : list datum) := returned "hc_valid" [words_of w].
Definition exact_on_limbs given := called functions (exact_calls tangency integers) (exact_procedures (text_of_fixed guessed power_guessed guess power_of_guess)) "hc_exact_position" given.

Lemma exact_on_limbs_is_right : exists a, exact_on_limbs [row m e] = Some (Of Int (code (Some a))) /\ is_position pair_of_bits a.
Proof.
  destruct (valid_row w Words accepted_is_valid) as (L & C & P & _), (limbs_on_doubles bits memory Bits) as (a5 & R5 & E5); apply On_limbs in E5.
  destruct (text_answers_the_position m e P L C guessed power_guessed) as (o3 & E3 & R3), Fourth as (o4 & E4 & R4); rewrite pair_is in R3.
  exists (or_else o3 (or_else o4 a5)); split.
  - assert (F3 : text_of_fixed guessed power_guessed guess power_of_guess [row m e] = Some [Of Int (code o3); Double guess power_of_guess])
      by (unfold text_of_fixed; unfold answer_of_text in E3; rewrite E3; reflexivity).
    exact (exact_text m e _ tangency integers o3 o4 a5 guess power_of_guess F3 (fun _ => E4) (fun _ _ => E5)).
  - destruct o3 as [a |]; [exact (R3 a eq_refl) |]; destruct o4 as [a |]; [| exact R5]; cbn [or_else].
    destruct values_positive as (A & G & B & D); exact (whatever_stage_answers _ _ _ _ _ _ _ A G B D a (R4 a eq_refl)).
Qed.
Theorem stages_on_doubles : exists a, called_with floats functions (stage_calls single certified valid_on_bits exact_on_limbs) [] "hc_position_of" [row m e] =
  Some (Of Int (code (Some a))) /\ is_position pair_of_bits a.
Proof.
  destruct exact_on_limbs_is_right as (a & E & R); destruct (Z.eq_dec floats 0) as [F | F].
  - destruct (Undecided F) as (plus & minus & decided & C); exists a; split; [| exact R].
    rewrite (position_text m e single certified valid_on_bits exact_on_limbs floats true None None a plus minus decided); [| contradiction | exists (bits_of_stage plus minus decided); auto | exact Accepted | auto].
    unfold answer_of_all, exact_or_refused; rewrite (proj2 (Z.eqb_eq floats 0) F); reflexivity.
  - destruct (Single F) as (o1 & E1 & R1), (Certified F) as (o2 & plus & minus & E2 & R2); exists (or_else o1 (or_else o2 a)); split.
    + rewrite (position_text m e single certified valid_on_bits exact_on_limbs floats true o1 o2 a plus minus 0); [| auto | exists (found o2 plus minus); auto | exact Accepted | auto].
      unfold answer_of_all, exact_or_refused; rewrite (proj2 (Z.eqb_neq floats 0) F); destruct o1, o2; reflexivity.
    + destruct o1 as [c |]; [exact (R1 c eq_refl) |]; destruct o2 as [c |]; [exact (R2 c eq_refl) | exact R].
Qed.
End Stages.
End Rows.

(** A row that is not valid is refused, unless one pair or stage 2 answers. *)
Theorem invalid_is_refused w m e single certified exact floats o1 o2 plus minus : returned "hc_valid" [words_of w] = Some (Of Int 0) ->
  single [row m e] = Some (Of Int (code o1)) -> certified [row m e; Of Int 1; Of Int 1] = Some (found o2 plus minus) -> floats = 0 \/ o1 = None /\ o2 = None ->
  called_with floats functions (stage_calls single certified (valid_on_bits w) exact) [] "hc_position_of" [row m e] = Some (Of Int refused).
Proof.
  intros V S C A; rewrite (position_text m e single certified (valid_on_bits w) exact floats false o1 o2 Contact plus minus 0); [| auto | exists (found o2 plus minus); auto | exact V | discriminate].
  unfold answer_of_all, exact_or_refused; destruct (Z.eqb_spec floats 0) as [| N]; [reflexivity |]; destruct A as [| [-> ->]]; [contradiction | reflexivity].
Qed.
