(** The stages one after another: the text of hc_exact_position and of hc_position_of, run by Coq, returns the answer of the first
    stage that answers, and that is the position.

    Of the stages of integers the text is run, too: StageThreePosition.v, StageFiveAnswers.v. Of stage 4, of stage 2 and of one pair
    it is assumed that they answer as Stages.v says, or with the position, or not at all. *)

Require Import List String ZArith Reals Lia Bool.
From Hypcheck Require Import Steps Fixed FixedRuns Computed Limbs Trees StageThreeRuns StageThreeAnswers StageThreeNumbers StageThreePosition
  StageFiveAnswers Geometry Stages Positions.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** The text of the functions. *)
Definition functions := Eval vm_compute in
  match every (map (fun text => deciding_of (string_of text)) HeaderText.deciding) with Some l => l | None => [] end.

Definition or_else (o : option answer) (a : answer) := match o with Some c => c | None => a end.

Lemma decided_ends known procedures Post f now c yes no rest t z : eval known now c = Some (Of t z) ->
  ends known procedures Post f now ((if z =? 0 then no else yes) ++ rest)%list -> ends known procedures Post (S f) now (If c yes no :: rest).
Proof. intros E; unfold ends; cbn [go]; rewrite E; exact (fun P => P). Qed.

Section Texts.
Variables m e : string -> Z.

Ltac open text := eval cbv -[Z.eqb said most_grown] in text.
Ltac opened := lazymatch goal with |- ?text = ?answer => let v := open text in change (v = answer) end.
(** What is called is rewritten; whole numbers are compared. *)
Ltac evaluated := opened; repeat (first [match goal with H : ?l = _ |- context [?l] => rewrite H end
  | progress repeat match goal with |- context [Z.eqb ?a ?c] => let v := eval vm_compute in (Z.eqb a c) in
      lazymatch v with true => idtac | false => idtac end; change (Z.eqb a c) with v end]; opened); reflexivity.
Ltac next := lazymatch goal with
  | |- ends _ _ _ _ _ (Calling _ _ :: _) => eapply calling_ends;
    [reflexivity | evaluated | evaluated | cbv [bound_all skipn bound app map fst snd append]; reflexivity |]
  | |- ends _ _ _ _ _ (Set_ _ _ _ :: _) => eapply put_ends;
    [reflexivity | evaluated | reflexivity | cbv [bound app map fst snd append]; reflexivity |]
  | |- ends _ _ _ _ _ (If _ _ _ :: _) => eapply decided_ends; [evaluated | cbn [Z.eqb Pos.eqb app]]
  | |- ends _ _ _ _ _ (Returns _ :: _) => eapply return_ends; [evaluated | reflexivity] end.
Ltac runs := repeat next.

(** Stages 3, 4 and 5. *)
Section Exact.
Variables (fixed : list datum -> option (list datum)) (tangency integers : list datum -> option datum).
Variables (o3 o4 : option answer) (a5 : answer) (guess power_of_guess : Z).
Hypotheses (Third : fixed [row m e] = Some [Of Int (code o3); Double guess power_of_guess])
  (Fourth : o3 = None -> tangency [row m e; Double guess power_of_guess] = Some (Of Int (code o4)))
  (Fifth : o3 = None -> o4 = None -> integers [row m e] = Some (Of Int (code (Some a5)))).
Definition exact_calls := [("hc_position_beside_tangency", tangency); ("hc_position_by_integers", integers)].
Definition exact_procedures := [("hc_fixed_position", (1%nat, fixed))].

Theorem exact_text : called functions exact_calls exact_procedures "hc_exact_position" [row m e] = Some (Of Int (code (Some (or_else o3 (or_else o4 a5))))).
Proof.
  cbv [row lengths map combine fst snd] in *; begins_to_end "hc_exact_position".
  destruct o3 as [[| |] |]; [clear Fourth Fifth; cbv [code] in Third; runs .. |]; specialize (Fourth eq_refl); specialize (Fifth eq_refl).
  destruct o4 as [[| |] |]; [clear Fifth; cbv [code] in Third, Fourth; runs .. |]; specialize (Fifth eq_refl); cbv [code] in Third, Fourth; destruct a5; cbv [code] in Fifth; runs.
Qed.
End Exact.

(** One pair, stage 2, and the exact stages; where floats do not decide, these alone. *)
Section Asked.
Variables (single certified valid exact : list datum -> option datum) (floats : Z) (is_valid : bool).
Variables (o1 o2 : option answer) (a : answer) (other_plus other_minus other_decided : Z).

(** The bits of stage 2: those of an answer, or any with none decided. *)
Definition bits_of_stage plus minus decided := Rec [("plus", Of U64 plus); ("minus", Of U64 minus); ("decided", Of U64 decided)].
Definition found := match o2 with Some Exterior => bits_of_stage 1 0 1 | Some Interior => bits_of_stage 0 1 1 | Some Contact => bits_of_stage 0 0 1
  | None => bits_of_stage other_plus other_minus 0 end.
Hypotheses (Single : floats <> 0 -> single [row m e] = Some (Of Int (code o1)))
  (Certified : exists bits, certified [row m e; Of Int 1; Of Int 1] = Some bits /\ (bits = found \/ (floats = 0 /\ bits = bits_of_stage other_plus other_minus other_decided)))
  (Valid : valid [row m e] = Some (Of Int (bit is_valid))) (Exact : is_valid = true -> exact [row m e] = Some (Of Int (code (Some a)))).
Definition stage_calls := [("hc_single", single); ("hc_certified_plain", certified); ("hc_valid", valid); ("hc_exact_position", exact)].

(** A function that asks whether floats decide. *)
Definition called_with (functions : list (string * deciding)) known procedures n given : option datum := try f <- look n functions;
  try now <- bound_all (map Named (firstn (List.length given) (takes f))) given (("HC_FLOATS_DECIDE", Of Int floats) :: constants);
  try (v, _) <- go known procedures steps now (does f); v.

Definition refused := 127.
Definition exact_or_refused := if is_valid then code (Some a) else refused.
Definition answer_of_all := if floats =? 0 then exact_or_refused else match o1 with Some c => code (Some c)
  | None => match o2 with Some c => code (Some c) | None => exact_or_refused end end.

Theorem position_text : called_with functions stage_calls [] "hc_position_of" [row m e] = Some (Of Int answer_of_all).
Proof.
  unfold answer_of_all, exact_or_refused; destruct Certified as (bits & C & B); clear Certified; cbv [row lengths map combine fst snd] in *.
  unfold called_with; begins_to_end "hc_position_of".
  destruct (Z.eqb_spec floats 0) as [F | F].
  - clear Single; assert (N : (floats =? 0) = true) by (apply Z.eqb_eq; exact F); clear F.
    assert (K : exists p q d, bits = bits_of_stage p q d).
    { destruct B as [-> | [_ ->]]; [unfold found; destruct o2 as [[| |] |] |]; repeat eexists. }
    destruct K as (p & q & d & ->); cbv [bits_of_stage] in C; destruct is_valid; cbv [bit] in Valid; [specialize (Exact eq_refl); destruct a; cbv [code] in Exact |]; clear B; runs.
  - assert (N : (floats =? 0) = false) by (apply Z.eqb_neq; exact F); specialize (Single F); destruct B as [-> | [Z0 _]]; [| contradiction]; clear F.
    destruct o1 as [[| |] |]; cbv [code] in Single; [clear C Valid Exact; runs .. |].
    cbv [found bits_of_stage] in C; destruct o2 as [[| |] |]; [clear Valid Exact; runs .. |].
    destruct is_valid; cbv [bit] in Valid; [specialize (Exact eq_refl); destruct a; cbv [code] in Exact |]; runs.
Qed.
End Asked.
End Texts.

(** ** The position. *)

(** Names of texts are unfolded before what runs them. *)
Strategy 100 [called called_within called_with].

Section Position.
Variables (m e : string -> Z) (zeros : Z -> Z).
(** A valid row, as stage 3 and stage 5 read it. *)
Hypotheses (Zeros : counts_zeros zeros) (Lengths : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 2 ^ 52 <= m n < 2 ^ 53)
  (Centre : forall n, In n ["x"; "y"; "z"] -> Z.abs (m n) < 2 ^ 53) (Powers : forall n, In n lengths -> -4096 <= e n <= 2046)
  (Multiples : forall n, In n lengths -> m n <> 0 -> 1 <= e n + zeros (m n)).
Let p := upright (value_of m e "alpha") (value_of m e "gamma") (value_of m e "b") (value_of m e "d") (value_of m e "x") (value_of m e "y") (value_of m e "z").
Definition right_if_any (o : option answer) := forall a, o = Some a -> is_position p a.

(** The texts of stages 3 and 5; the guess of a double root that stage 3 leaves may be any. *)
Variables (guessed power_guessed : list datum -> Z) (guess power_of_guess : Z) (tangency : list datum -> option datum).
Definition text_of_fixed (given : list datum) := try v <- called StageThreeAnswers.functions
  (position_calls (of_terms "hc_fixed_terms_of") (of_terms "hc_fixed_cubic_of") sign_function guessed power_guessed)
  (position_procedures (puts StageThreeAnswers.functions known [] "hc_fixed_at_B") (puts StageThreeAnswers.functions known [] "hc_fixed_at_A")) "hc_fixed_position" given;
  Some [v; Double guess power_of_guess].
Definition text_of_integers := called_within StageFiveAnswers.functions (of_integers zeros) [] "hc_position_by_integers".
Definition exact_answer_of_text given := called functions (exact_calls tangency text_of_integers) (exact_procedures text_of_fixed) "hc_exact_position" given.
(** Stage 4 answers as Stages.v says, or not at all. *)
Hypothesis Fourth : exists o, tangency [row m e; Double guess power_of_guess] = Some (Of Int (code o)) /\ forall a, o = Some a ->
  answers (value_of m e "alpha") (value_of m e "gamma") (value_of m e "b") (value_of m e "d") (value_of m e "x") (value_of m e "y") (value_of m e "z") a.

Lemma sizes_positive n : In n ["alpha"; "gamma"; "b"; "d"] -> (0 < value_of m e n)%R.
Proof. intros I; apply Rmult_lt_0_compat; [apply IZR_lt; pose proof (Lengths n I); lia | apply power_positive]. Qed.

Theorem exact_stages_are_right : exists a, exact_answer_of_text [row m e] = Some (Of Int (code (Some a))) /\ is_position p a.
Proof.
  destruct (text_answers_the_position m e Powers Lengths Centre guessed power_guessed) as (o3 & E3 & R3), Fourth as (o4 & E4 & R4).
  destruct (text_answers_by_integers m e zeros Zeros) as (a5 & E5 & R5).
  - intros n I; pose proof (Lengths n I); lia.
  - exact (mantissas m Lengths Centre).
  - intros n I N; split; [apply Powers; exact I | apply Multiples; assumption].
  - exists (or_else o3 (or_else o4 a5)); split.
    + assert (F3 : text_of_fixed [row m e] = Some [Of Int (code o3); Double guess power_of_guess])
        by (unfold text_of_fixed; unfold answer_of_text in E3; rewrite E3; reflexivity).
      assert (F5 : text_of_integers [row m e] = Some (Of Int (code (Some a5)))) by (unfold text_of_integers; unfold answer_of_integers in E5; exact E5).
      unfold exact_answer_of_text; exact (exact_text m e text_of_fixed tangency text_of_integers o3 o4 a5 guess power_of_guess F3 (fun _ => E4) (fun _ _ => F5)).
    + destruct o3 as [a |]; [exact (R3 a eq_refl) |]; destruct o4 as [a |]; [| exact R5]; cbn [or_else].
      apply (whatever_stage_answers (value_of m e "alpha") (value_of m e "gamma") (value_of m e "b") (value_of m e "d")); try (apply sizes_positive; cbn; tauto).
      exact (R4 a eq_refl).
Qed.

Variables (single certified valid : list datum -> option datum) (floats : Z).
Hypotheses (Single : floats <> 0 -> exists o, single [row m e] = Some (Of Int (code o)) /\ right_if_any o)
  (Certified : floats <> 0 -> exists o plus minus, certified [row m e; Of Int 1; Of Int 1] = Some (found o plus minus) /\ right_if_any o)
  (Undecided : floats = 0 -> exists plus minus decided, certified [row m e; Of Int 1; Of Int 1] = Some (bits_of_stage plus minus decided))
  (Valid : valid [row m e] = Some (Of Int 1)).
Theorem stages_are_right : exists a, called_with floats functions (stage_calls single certified valid exact_answer_of_text) [] "hc_position_of" [row m e] =
  Some (Of Int (code (Some a))) /\ is_position p a.
Proof.
  destruct exact_stages_are_right as (a & E & R); destruct (Z.eq_dec floats 0) as [F | F].
  - destruct (Undecided F) as (plus & minus & decided & C); exists a; split; [| exact R].
    rewrite (position_text m e single certified valid exact_answer_of_text floats true None None a plus minus decided); [| contradiction | exists (bits_of_stage plus minus decided); auto | exact Valid | auto].
    unfold answer_of_all, exact_or_refused; rewrite (proj2 (Z.eqb_eq floats 0) F); reflexivity.
  - destruct (Single F) as (o1 & E1 & R1), (Certified F) as (o2 & plus & minus & E2 & R2).
    exists (or_else o1 (or_else o2 a)); split.
    + rewrite (position_text m e single certified valid exact_answer_of_text floats true o1 o2 a plus minus 0); [| auto | exists (found o2 plus minus); auto | exact Valid | auto].
      unfold answer_of_all, exact_or_refused; rewrite (proj2 (Z.eqb_neq floats 0) F); destruct o1, o2; reflexivity.
    + destruct o1 as [c |]; [exact (R1 c eq_refl) |]; destruct o2 as [c |]; [exact (R2 c eq_refl) | exact R].
Qed.
End Position.
