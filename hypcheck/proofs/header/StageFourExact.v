(** Stage 4 among the exact stages: what StagesRuns.v supposes of it is proved of its text, and so the exact stages answer with the
    position.

    Assumed are: of floats what Half_up, Nearest and Hair say, which IEEE 754 has in double precision; and that hc_short_lengths puts
    whole numbers of the lengths, in units of their kind, with so many bits as it says. *)

Require Import List String ZArith Reals Lia Bool.
From Hypcheck Require Import Geometry Positions Stages Steps FixedRuns Limbs Trees StageThreeRuns StageThreeAnswers StageThreeNumbers StageThreePosition
  StageFiveAnswers StagesRuns StageFourSteps StageFourGuesses StageFourBeside StageFourPosition.
From Hypcheck Require StageFourPlane StageFourShort StageFourTurns StageFourTouches.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Section Exact.
Variables (m e : string -> Z) (zeros : Z -> Z).
Hypotheses (Zeros : counts_zeros zeros) (Lengths : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 2 ^ 52 <= m n < 2 ^ 53)
  (Centre : forall n, In n ["x"; "y"; "z"] -> Z.abs (m n) < 2 ^ 53) (Powers : forall n, In n StageThreeRuns.lengths -> -4096 <= e n <= 2046)
  (Multiples : forall n, In n StageThreeRuns.lengths -> m n <> 0 -> 1 <= e n + zeros (m n)).

(** Floats, as far as it matters what they are. *)
Variables (float : string -> list datum -> Z) (less : datum -> datum -> bool) (nearest word : Z -> Z) (hair : Z -> Z -> Z * Z).
Hypotheses (Half_up : forall size n, is_float size -> 0 <= n < 2 ^ 46 -> less (Of Int 0) size = true ->
    StageFourShort.cut_half_up float less word (made_by float "*" [size; StageFourShort.double_of float n])
    /\ StageFourShort.cut_half_up float less word (made_by float "/" [StageFourShort.double_of float n; size]))
  (Nearest : forall size n, is_float size -> 0 <= n < 2 ^ 124 -> less (Of Int 0) size = true ->
    StageFourTouches.is_nearest less nearest (made_by float "*" [size; StageFourTouches.value_of float n])
    /\ StageFourTouches.is_nearest less nearest (made_by float "/" [StageFourTouches.value_of float n; size]))
  (Hair : hairs_are_short m e hair).
Variable put_lengths : list datum -> option (list datum).
Hypothesis Puts : puts_lengths put_lengths.

Definition text_of_plane := called StageFourPlane.functions of_longs [] "hc_position_in_plane".
Definition text_of_short := called_on float less nearest word StageFourShort.functions "hc_touches_by_short".
Definition text_of_touching := called_on float less nearest word StageFourTurns.functions "hc_touches_by".
Definition text_of_tangency := called_beside hair text_of_plane text_of_short text_of_touching put_lengths.

(** Stage 4 answers as Stages.v says, or not at all. *)
Theorem fourth_is_right about : is_float about -> exists o, text_of_tangency [row m e; about] = Some (Of Int (code o)) /\ forall a, o = Some a ->
  answers (value_of m e "alpha") (value_of m e "gamma") (value_of m e "b") (value_of m e "d") (value_of m e "x") (value_of m e "y") (value_of m e "z") a.
Proof.
  intros About; apply (beside_is_right m e hair text_of_plane text_of_short text_of_touching put_lengths about About); try assumption.
  - intros n I; pose proof (Lengths n I); lia.
  - intros ls L S; destruct (StageFourPlane.plane_text ls L S) as (o & E & A); exists o; split; [exact E | intros a u w x y U W; apply A; assumption].
  - intros ls L S; exact (StageFourShort.short_text float less nearest word ls about About L S Half_up).
  - intros ls L S; exact (StageFourTouches.touches_text float less nearest word ls about About L S Nearest).
Qed.

(** The exact stages answer with the position. *)
Variables (guessed power_guessed : list datum -> Z) (guess power_of_guess : Z).
Corollary exact_texts_are_right : exists a, exact_answer_of_text zeros guessed power_guessed guess power_of_guess text_of_tangency [row m e] = Some (Of Int (code (Some a)))
  /\ is_position (upright (value_of m e "alpha") (value_of m e "gamma") (value_of m e "b") (value_of m e "d") (value_of m e "x") (value_of m e "y") (value_of m e "z")) a.
Proof.
  apply (exact_stages_are_right m e zeros Zeros Lengths Centre Powers Multiples guessed power_guessed guess power_of_guess text_of_tangency).
  exact (fourth_is_right (Double guess power_of_guess) I).
Qed.
End Exact.
