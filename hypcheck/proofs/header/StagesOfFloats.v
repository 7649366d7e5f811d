(** All stages of one row from the text of the C, those of floats too: hc_position_of returns the position.

    StagesRuns.v supposes of one pair and of stage 2 that they answer with the position or not at all. Here their texts are run, and of
    floats alone is supposed what SingleRuns.v and StageTwoRuns.v do: that each step rounds in some mode, that comparisons which hold
    hold of the numbers, and that the constants are the header's. A double of the row is known to these texts by its name; its value is
    the one that the exact stages read. *)

Require Import List String ZArith Reals Lia Bool.
From Hypcheck Require Import Geometry Positions Stages Steps FixedRuns Limbs Trees StageThreeRuns StageThreeAnswers StageThreeNumbers StageThreePosition
  StageFiveAnswers StagesRuns CertifiedAnswers.
From Hypcheck Require Ranges FloatTexts CertifiedText SingleRuns StageTwoRuns.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Section Row.

Variables (m e : string -> Z) (zeros : Z -> Z).
Hypotheses (Zeros : counts_zeros zeros) (Lengths : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 2 ^ 52 <= m n < 2 ^ 53)
  (Centre : forall n, In n ["x"; "y"; "z"] -> Z.abs (m n) < 2 ^ 53) (Powers : forall n, In n lengths -> -4096 <= e n <= 2046)
  (Multiples : forall n, In n lengths -> m n <> 0 -> 1 <= e n + zeros (m n)).
Let p := upright (value_of m e "alpha") (value_of m e "gamma") (value_of m e "b") (value_of m e "d") (value_of m e "x") (value_of m e "y") (value_of m e "z").

(** The floats of one pair and their comparisons, those of stage 2 and the bits of its truths. *)
Variables (x pre x' pre' : string -> R) (greater : argument -> argument -> bool) (mask : Z -> string -> Z).
Definition is_of_row (x : string -> R) := forall n, In n lengths -> x n = value_of m e n.
Definition single_runs := is_of_row x /\ Forall (Ranges.runs SingleRuns.multiplied x pre) FloatTexts.steps_of_single
  /\ (forall a c p q, greater a c = true -> Ranges.has x a p -> Ranges.has x c q -> (q < p)%R) /\ (forall n v, In (n, v) StageTwoRuns.constants -> x n = v)
  /\ (forall n, In n (FloatTexts.inputs ++ map fst StageTwoRuns.constants) -> pre n = x n).
Definition stage_two_runs := is_of_row x' /\ runs_on x' pre' (holds_in_row mask).
Hypothesis Masks : forall at_ n, 0 <= mask at_ n < 2 ^ 1.

Definition text_of_single (given : list datum) := match given with [Rec _] => FloatTexts.text_of_single greater | _ => None end.
Definition text_of_certified (given : list datum) := match given with
  | [Rec _; Of Int stride; Of Int count] => match CertifiedText.bits_of_struct (CertifiedText.text_of_certified mask 1 count stride) with
    | Some (plus, minus, decided) => Some (bits_of_stage plus minus decided) | None => None end
  | _ => None end.

Lemma body_is x0 : is_of_row x0 -> body_of x0 = p.
Proof. intros G; unfold body_of, p; rewrite !G by (cbn; tauto); reflexivity. Qed.

Lemma single_answers : single_runs -> exists o, text_of_single [row m e] = Some (Of Int (code o)) /\ right_if_any m e o.
Proof.
  intros (G & R & C & K & I); destruct (SingleRuns.single_is_right x pre greater R C K I) as (o & E & A); exists o; split.
  - change (FloatTexts.text_of_single greater = Some (Of Int (code o))); rewrite FloatTexts.single_text, E; destruct o as [[| |] |]; reflexivity.
  - intros a H; pose proof (A a H) as P; change (is_position (body_of x) a) in P; rewrite (body_is x G) in P; exact P.
Qed.

Lemma stage_two_ends : exists plus minus decided, text_of_certified [row m e; Of Int 1; Of Int 1] = Some (bits_of_stage plus minus decided).
Proof.
  destruct (row_is_right mask Masks) as (plus & minus & decided & E & _); exists plus, minus, decided.
  change (match CertifiedText.bits_of_struct (CertifiedText.text_of_certified mask 1 1 1) with Some (a, b, c) => Some (bits_of_stage a b c) | None => None end
    = Some (bits_of_stage plus minus decided)); rewrite E; reflexivity.
Qed.

Lemma stage_two_answers : stage_two_runs -> exists o plus minus, text_of_certified [row m e; Of Int 1; Of Int 1] = Some (found o plus minus) /\ right_if_any m e o.
Proof.
  intros (G & R); destruct (row_is_right mask Masks) as (plus & minus & decided & E & B1 & B2 & B3 & H); destruct (H x' pre' R) as [N A].
  exists (said (plus =? 1) (minus =? 1) (decided =? 1)), plus, minus; split.
  - change (match CertifiedText.bits_of_struct (CertifiedText.text_of_certified mask 1 1 1) with Some (a, b, c) => Some (bits_of_stage a b c) | None => None end
      = Some (found (said (plus =? 1) (minus =? 1) (decided =? 1)) plus minus)); rewrite E.
    assert (P : plus = 0 \/ plus = 1) by lia; assert (M : minus = 0 \/ minus = 1) by lia; assert (D : decided = 0 \/ decided = 1) by lia.
    destruct D as [-> | ->]; [reflexivity |]; specialize (N eq_refl); destruct P as [-> | ->], M as [-> | ->]; try reflexivity; lia.
  - intros a S; pose proof (A a S) as P; rewrite (body_is x' G) in P; exact P.
Qed.

(** Stage 4, the guess that stage 3 leaves to it, and whether floats decide on this machine. *)
Variables (guessed power_guessed : list datum -> Z) (guess power_of_guess : Z) (tangency valid : list datum -> option datum) (floats : Z).
Hypothesis Fourth : exists o, tangency [row m e; Double guess power_of_guess] = Some (Of Int (code o)) /\ forall a, o = Some a ->
  answers (value_of m e "alpha") (value_of m e "gamma") (value_of m e "b") (value_of m e "d") (value_of m e "x") (value_of m e "y") (value_of m e "z") a.
Hypotheses (Floats : floats <> 0 -> single_runs /\ stage_two_runs) (Valid : valid [row m e] = Some (Of Int 1)).

Theorem all_stages_are_right : exists a, called_with floats functions
  (stage_calls text_of_single text_of_certified valid (exact_answer_of_text zeros guessed power_guessed guess power_of_guess tangency)) [] "hc_position_of" [row m e]
  = Some (Of Int (code (Some a))) /\ is_position p a.
Proof.
  apply (stages_are_right m e zeros Zeros Lengths Centre Powers Multiples guessed power_guessed guess power_of_guess tangency Fourth); [| | | exact Valid].
  - intros F; apply single_answers, Floats, F.
  - intros F; apply stage_two_answers, Floats, F.
  - intros _; exact stage_two_ends.
Qed.

End Row.
