(** What AllStages.v supposes can be met, all of it at once and for every row that the text of hc_valid accepts: floats that are rounded to
    nearest, even, comparisons that hold where they hold of the numbers, and what the text of stage 5 returns on limbs.

    Of stage 4, what is taken for a guess may be anything; here no comparison of it holds. At the end a row is run by all texts: it
    touches, which stage 4 finds. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Flocq Require Import Core.
From Hypcheck Require Import Geometry Positions Stages Steps FixedRuns Computed Long Limbs Trees LongIntegers Ranges StageThreeRuns StageThreeAnswers StageThreeNumbers
  StageThreePosition StageFiveAnswers StageFiveIntegers Doubles StagesRuns StagesOnDoubles DoubleValues StagesOfFloats StageFourGuesses StageFourExact AllStages.
From Hypcheck Require FloatTexts CertifiedText CertifiedAnswers SingleRuns StageTwoRuns StageFourSteps StageFourShort StageFourTouches StageFourPosition.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Notation put := Computed.put.

(** ** Steps one after another, each from those before. *)

Definition names_in s := flat_map (fun a => match a with Name n => [n] | Number _ => [] end) (arguments (meaning s)).
Fixpoint in_turn l := match l with [] => true
  | s :: rest => negb (is_in (name s) (names_in s)) && forallb (fun t => negb (is_in (name t) (name s :: names_in s))) rest && in_turn rest end.

Section Made.
Variables (A : Type) (value : (string -> A) -> step -> A).
Hypothesis Alike : forall f g s, (forall n, In n (names_in s) -> f n = g n) -> value f s = value g s.
Fixpoint made l f := match l with [] => f | s :: rest => made rest (put f (name s) (value f s)) end.

Lemma made_other l : forall f n, existsb (fun t => String.eqb (name t) n) l = false -> made l f n = f n.
Proof.
  induction l as [| s l IH]; intros f n N; [reflexivity |]; cbn [existsb] in N; apply orb_false_elim in N as [N M]; cbn [made].
  rewrite IH by exact M; apply put_other; exact N.
Qed.
Lemma not_among l names n : forallb (fun t => negb (is_in (name t) names)) l = true -> In n names -> existsb (fun t => String.eqb (name t) n) l = false.
Proof.
  intros H I; apply not_true_iff_false; intros E; apply existsb_exists in E as (t & T & E); apply String.eqb_eq in E; subst n.
  rewrite forallb_forall in H; specialize (H t T); apply negb_true_iff in H; unfold is_in in H; rewrite <- not_true_iff_false in H; apply H.
  apply existsb_exists; exists (name t); split; [exact I | apply String.eqb_refl].
Qed.
Lemma made_value l : forall f s, in_turn l = true -> In s l -> made l f (name s) = value (made l f) s.
Proof.
  induction l as [| t l IH]; intros f s T I; [destruct I |]; cbn [in_turn] in T; apply andb_prop in T as [T L]; apply andb_prop in T as [N T]; cbn [made].
  destruct I as [-> | I]; [| apply IH; assumption].
  rewrite made_other by (apply (not_among _ _ _ T); left; reflexivity); rewrite put_same; apply Alike; intros n M.
  rewrite made_other by (apply (not_among _ _ _ T); right; exact M); symmetry; apply put_other.
  apply negb_true_iff in N; apply not_true_iff_false; intros E; apply String.eqb_eq in E; subst n; unfold is_in in N; rewrite <- not_true_iff_false in N; apply N.
  apply existsb_exists; exists (name s); split; [exact M | apply String.eqb_refl].
Qed.
Lemma found_in l s : in_turn l = true -> In s l -> find (fun t => String.eqb (name t) (name s)) l = Some s.
Proof.
  induction l as [| t l IH]; intros T I; [destruct I |]; cbn [in_turn] in T; apply andb_prop in T as [T L]; apply andb_prop in T as [_ T]; cbn [find].
  destruct I as [-> | I]; [rewrite String.eqb_refl; reflexivity |]; destruct (String.eqb_spec (name t) (name s)) as [E | _]; [| apply IH; assumption].
  rewrite forallb_forall in T; specialize (T s I); unfold is_in in T; cbn [existsb] in T; rewrite E, String.eqb_refl in T; discriminate.
Qed.
End Made.

(** ** Floats rounded to nearest, even. *)

Definition nearest_even p := round radix2 Floats.binary64 ZnearestE p.
Definition number x a := match a with Name n => x n | Number z => IZR z end.
Definition exact x s : R := match kind_of s, arguments (meaning s) with
  | Some Plus, [a; c] => number x a + number x c | Some Minus, [a; c] => number x a - number x c | Some Times, [a; c] => number x a * number x c
  | Some Over, [a; c] => number x a / number x c | Some Negated, [a] => - number x a | Some Sized, [a] => Rabs (number x a) | _, _ => 0 end.
Definition float_of x s := match kind_of s with Some Negated | Some Sized => exact x s | _ => nearest_even (exact x s) end.
Definition has_arity s := match kind_of s, arguments (meaning s) with
  | Some (Plus | Minus | Times | Over), [_; _] | Some (Negated | Sized), [_] | None, _ => true | _, _ => false end.

Lemma number_alike f g s a : (forall n, In n (names_in s) -> f n = g n) -> In a (arguments (meaning s)) -> number f a = number g a.
Proof. intros H I; destruct a as [n |]; [| reflexivity]; apply H; unfold names_in; apply in_flat_map; exists (Name n); split; [exact I | left; reflexivity]. Qed.
Lemma exact_alike f g s : (forall n, In n (names_in s) -> f n = g n) -> exact f s = exact g s.
Proof.
  intros H; pose proof (number_alike f g s) as N; unfold exact; destruct (kind_of s) as [k |]; [| reflexivity].
  destruct (arguments (meaning s)) as [| a [| c [|]]]; destruct k; try reflexivity; rewrite !N by (cbn; tauto); reflexivity.
Qed.
Lemma float_alike f g s : (forall n, In n (names_in s) -> f n = g n) -> float_of f s = float_of g s.
Proof. intros H; unfold float_of; rewrite (exact_alike f g s H); reflexivity. Qed.

Section Floats.
Variables (l : list step) (start : string -> R) (multiplied : list string).
Hypotheses (Turn : in_turn l = true) (Arity : forallb has_arity l = true).
Definition floats_of := made R float_of l start.
Definition exacts_of n := match find (fun s => String.eqb (name s) n) l with Some s => exact floats_of s | None => start n end.

Lemma has_number x a : has x a (number x a).
Proof. destruct a; reflexivity. Qed.
Lemma is_returned p : Ranges.returned p (nearest_even p).
Proof. left; exists ZnearestE; split; [apply valid_rnd_N | reflexivity]. Qed.
Theorem floats_run : Forall (runs multiplied floats_of exacts_of) l.
Proof.
  apply Forall_forall; intros s I; rewrite forallb_forall in Arity; specialize (Arity s I).
  assert (X : floats_of (name s) = float_of floats_of s) by (apply made_value; [exact float_alike | exact Turn | exact I]).
  assert (P : exacts_of (name s) = exact floats_of s) by (unfold exacts_of; rewrite found_in by assumption; reflexivity).
  unfold runs; rewrite X, P; unfold float_of, exact, has_arity in *; pose proof (fun a => has_number floats_of a) as N.
  pose proof (fun a => has_taken multiplied floats_of exacts_of _ _ (N a)) as T.
  destruct (kind_of s) as [k |]; [| exact Logic.I]; destruct k, (arguments (meaning s)) as [| a [| c [|]]]; try discriminate;
    first [do 2 eexists; repeat split; [apply N || apply T | apply N || apply T | apply is_returned] | do 2 eexists; repeat split; [apply T | apply N] | eexists; split; [apply N | split; reflexivity]].
Qed.
Lemma stays n : existsb (fun t => String.eqb (name t) n) l = false -> floats_of n = start n /\ exacts_of n = start n.
Proof.
  intros N; split; [apply made_other; exact N |]; unfold exacts_of; destruct (find _ l) as [s |] eqn:F; [| reflexivity].
  apply find_some in F as [I E]; exfalso; rewrite <- not_true_iff_false in N; apply N, existsb_exists; exists s; split; assumption.
Qed.

(** Comparisons that hold where they hold of the numbers. *)
Definition above p q := if Rlt_dec q p then true else false.
Definition truth (h : string -> bool) s := match look (operation (meaning s)) [("gt", 0); ("lt", 1); ("ge", 2); ("le", 3); ("and", 4); ("or", 5)], arguments (meaning s) with
  | Some 0, [a; c] => above (number floats_of a) (number floats_of c) | Some 1, [a; c] => above (number floats_of c) (number floats_of a)
  | Some 4, [Name a; Name c] => h a && h c | Some 5, [Name a; Name c] => h a || h c | _, _ => false end.
Lemma above_is p q : above p q = true -> (q < p)%R.
Proof. unfold above; destruct (Rlt_dec q p); [trivial | discriminate]. Qed.
Lemma truth_alike f g s : (forall n, In n (names_in s) -> f n = g n) -> truth f s = truth g s.
Proof.
  unfold truth, names_in; intros H; destruct (look _ _) as [z |]; [| reflexivity]; destruct (arguments (meaning s)) as [| [a | a] [| [c | c] [|]]]; try reflexivity.
  rewrite (H a), (H c) by (cbn; tauto); reflexivity.
Qed.
Definition truths_of := made bool truth l (fun _ => false).
Definition mask_of (at_ : Z) n := if truths_of n then 1 else 0.

Lemma is_number x a p : has x a p -> p = number x a.
Proof. destruct a; trivial. Qed.
Definition operations := ["abs"; "gt"; "lt"; "and"; "or"; "div"; "sub"; "add"; "mul"; "neg"].
Lemma holds_if_true t : CertifiedAnswers.holds_in_row mask_of t -> truths_of t = true.
Proof. unfold CertifiedAnswers.holds_in_row, mask_of; destruct (truths_of t); [trivial | discriminate]. Qed.
Lemma true_holds t : truths_of t = true -> CertifiedAnswers.holds_in_row mask_of t.
Proof. unfold CertifiedAnswers.holds_in_row, mask_of; intros ->; reflexivity. Qed.
Theorem truths_compare : forallb (fun s => is_in (operation (meaning s)) operations) l = true -> Forall (compares floats_of (CertifiedAnswers.holds_in_row mask_of)) l.
Proof.
  intros O; apply Forall_forall; intros s I; rewrite forallb_forall in O; specialize (O s I).
  assert (T : truths_of (name s) = truth truths_of s) by (apply made_value; [exact truth_alike | exact Turn | exact I]).
  unfold compares; unfold truth in T; unfold is_in in O; cbn [existsb operations] in O.
  repeat (apply orb_prop in O as [O | O]; [apply String.eqb_eq in O; rewrite O in *; cbn [look String.eqb Ascii.eqb Bool.eqb] in T; try exact Logic.I |]); [.. | discriminate].
  all: destruct (arguments (meaning s)) as [| [a | a] [| [c | c] [|]]]; try exact Logic.I; intros H; apply holds_if_true in H; rewrite T in H.
  all: try (intros p q P Q; apply is_number in P, Q; subst p q; apply above_is; exact H).
  1: apply andb_prop in H as [L R]; split; apply true_holds; assumption.
  apply orb_prop in H as [L | L]; [left | right]; apply true_holds; exact L.
Qed.
End Floats.

(** ** The hypotheses, for a row that is accepted. *)

Section Row.
Variable w : string -> Z.
Hypotheses (Words : forall n, In n lengths -> is_word (w n)) (Accepted : returned "hc_valid" [words_of w] = Some (Of Int 1)).
Let m n := whole_of (w n).
Let e n := power_of (w n).

Definition start n := match look n StageTwoRuns.constants with Some v => v | None => value_of m e n end.
Lemma constant_starts n v : In (n, v) StageTwoRuns.constants -> start n = v.
Proof. intros I; unfold StageTwoRuns.constants in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; reflexivity. Qed.
Lemma length_starts n : In n lengths -> start n = value_of m e n.
Proof. intros I; repeat destruct I as [<- | I]; try contradiction; reflexivity. Qed.

Definition apart l := forallb (fun n => negb (existsb (fun t => String.eqb (name t) n) l)) (lengths ++ map fst StageTwoRuns.constants).
Lemma inputs_stay l n : apart l = true -> In n (lengths ++ map fst StageTwoRuns.constants) -> floats_of l start n = start n /\ exacts_of l start n = start n.
Proof. unfold apart; rewrite forallb_forall; intros H I; apply stays, negb_true_iff, H, I. Qed.
Lemma constants_among n v : In (n, v) StageTwoRuns.constants -> In n (lengths ++ map fst StageTwoRuns.constants).
Proof. intros I; apply in_or_app; right; apply (in_map fst _ _ I). Qed.

Notation x := (floats_of FloatTexts.steps_of_single start).
Notation pre := (exacts_of FloatTexts.steps_of_single start).
Notation x' := (floats_of C_certified start).
Notation pre' := (exacts_of C_certified start).
Definition greater a c := above (number x a) (number x c).
Notation mask := (mask_of C_certified start).

Lemma single_in_turn : in_turn FloatTexts.steps_of_single && forallb has_arity FloatTexts.steps_of_single = true.
Proof. vm_compute; reflexivity. Qed.
Lemma certified_in_turn : in_turn C_certified && forallb has_arity C_certified = true.
Proof. vm_compute; reflexivity. Qed.
Lemma single_apart : apart FloatTexts.steps_of_single = true.
Proof. reflexivity. Qed.
Lemma certified_apart : apart C_certified = true.
Proof. reflexivity. Qed.

Theorem single_meets : single_runs m e x pre greater.
Proof.
  pose proof single_in_turn as T; apply andb_prop in T as [T A]; pose proof (fun n => inputs_stay _ n single_apart) as S; repeat split.
  - intros n I; rewrite (proj1 (S n ltac:(apply in_or_app; left; exact I))); apply length_starts, I.
  - apply floats_run; assumption.
  - intros a c p q G P Q; apply is_number in P, Q; subst p q; apply above_is; exact G.
  - intros n v I; rewrite (proj1 (S n (constants_among n v I))); apply constant_starts, I.
  - intros n I; destruct (S n I) as [-> ->]; reflexivity.
Qed.
Theorem stage_two_meets : stage_two_runs m e x' pre' mask.
Proof.
  pose proof certified_in_turn as T; apply andb_prop in T as [T A]; pose proof (fun n => inputs_stay _ n certified_apart) as S; repeat split.
  - intros n I; rewrite (proj1 (S n ltac:(apply in_or_app; left; exact I))); apply length_starts, I.
  - apply floats_run; assumption.
  - apply truths_compare; [exact T | vm_compute; reflexivity].
  - intros n v I; rewrite (proj1 (S n (constants_among n v I))); apply constant_starts, I.
  - intros n I; destruct (S n I) as [-> ->]; reflexivity.
Qed.

(** 10^-18 and its products, to nearest; the float as a whole number and a power. *)
Definition factor := nearest_even (1 / 10 ^ 18).
Definition hair k p := let r := nearest_even (factor * (IZR k * power (p - 1075))) in (Ztrunc (scaled_mantissa radix2 Floats.binary64 r), cexp radix2 Floats.binary64 r + 1075).
Lemma hair_is_rounded n : StageFourPosition.hair_value m e hair n = nearest_even (factor * value_of m e n).
Proof.
  unfold StageFourPosition.hair_value, hair, value_of; cbn [fst snd]; set (r := nearest_even _); rewrite Z.add_simpl_r, power_is.
  symmetry; exact (@generic_format_round radix2 Floats.binary64 its_exponents ZnearestE (valid_rnd_N _) _).
Qed.
Lemma products_meet n : In n ["b"; "gamma"] -> Ranges.returned (factor * value w n) (StageFourPosition.hair_value m e hair n).
Proof.
  intros I; rewrite hair_is_rounded; assert (J : In n lengths) by (clear - I; cbn in *; tauto).
  assert (E : value_of m e n = value w n) by (etransitivity; [exact (whole_is_value (w n) (Words n J)) | exact (value_on_bits w Words Accepted n J)]).
  rewrite E; apply is_returned.
Qed.

(** Guesses of stage 4 of which no comparison holds, and lengths that are too long. *)
Definition silent (a c : datum) := false.
Definition no_float (o : string) (given : list datum) := 0.
Definition as_is (k : Z) := k.
Definition no_lengths (given : list datum) := Some [Of Int 63; Rec []].
Lemma silent_meets : (forall size n, is_float size -> 0 <= n < 2 ^ 46 -> silent (Of Int 0) size = true ->
    StageFourShort.cut_half_up no_float silent as_is (made_by no_float "*" [size; StageFourShort.double_of no_float n])
    /\ StageFourShort.cut_half_up no_float silent as_is (made_by no_float "/" [StageFourShort.double_of no_float n; size]))
  /\ (forall size n, is_float size -> 0 <= n < 2 ^ 124 -> silent (Of Int 0) size = true ->
    StageFourTouches.is_nearest silent as_is (made_by no_float "*" [size; StageFourTouches.value_of no_float n])
    /\ StageFourTouches.is_nearest silent as_is (made_by no_float "/" [StageFourTouches.value_of no_float n; size])).
Proof. split; discriminate. Qed.
Lemma no_lengths_meet : StageFourPosition.puts_lengths no_lengths.
Proof. intros l m0 e0 _ _; exists 63, [], (fun _ => 0); split; [reflexivity | lia]. Qed.

(** With these floats, and with what the text of stage 5 returns on limbs, hc_position_of returns the position. *)
Theorem nearest_floats_answer bits memory guessed power_guessed guess power_of_guess : bits = 32 \/ bits = 64 -> exists integers,
  (forall v, ends_on_limbs lowest bits StageFiveAnswers.functions "hc_position_by_integers" [row m e] memory (fun y => y = v) -> integers [row m e] = Some v) /\
  exists a, called_with 1 StagesRuns.functions (stage_calls (text_of_single greater) (text_of_certified mask) (valid_on_bits w)
    (exact_on_limbs integers guessed power_guessed guess power_of_guess (text_of_tangency no_float silent as_is as_is hair no_lengths))) [] "hc_position_of" [row m e]
  = Some (Of Int (code (Some a))) /\ is_position (pair w) a.
Proof.
  intros Bits; destruct (function_on_limbs w Words Accepted bits memory Bits) as (integers & On_limbs); exists integers; split; [exact On_limbs |].
  destruct silent_meets as [Half_up Nearest].
  apply (position_is_right w Words Accepted x pre x' pre' greater mask) with (bits := bits) (memory := memory) (factor := factor); try assumption.
  - intros at_ n; unfold mask_of; destruct (truths_of C_certified start n); split; reflexivity || discriminate.
  - exists ZnearestE; split; [apply valid_rnd_N | reflexivity].
  - exact products_meet.
  - exact no_lengths_meet.
  - intros _; split; [exact single_meets | exact stage_two_meets].
Qed.
End Row.

(** ** A row that touches: one pair, stage 2 and stage 3 do not decide it, and stage 4 answers contact. *)

Definition touching_word n := if String.eqb n "x" then 4611686018427387904 (* 2.0 *) else if is_in n ["y"; "z"] then 0 else 4607182418800017408 (* 1.0 *).
Definition touching_lengths (given : list datum) :=
  Some [Of Int 2; Rec (StageFourSteps.words_of_lengths (fun n => if String.eqb n "x" then 2 else if is_in n ["y"; "z"] then 0 else 1))].
Section Touching.
Let m n := whole_of (touching_word n).
Let e n := power_of (touching_word n).
Let undecided (given : list datum) := Some (Of Int 2).
Definition touching_tangency := text_of_tangency no_float silent as_is as_is (fun _ _ => (0, 0)) touching_lengths.
Definition answer_of_touching tangency := called_with 1 StagesRuns.functions (stage_calls (text_of_single (fun _ _ => false)) (text_of_certified (fun _ _ => 0))
  (valid_on_bits touching_word) (exact_on_limbs undecided (fun _ => 0) (fun _ => 0) 0 0 tangency)) [] "hc_position_of" [row m e].

Theorem touching_is_accepted : (forall n, In n lengths -> is_word (touching_word n)) /\ returned "hc_valid" [words_of touching_word] = Some (Of Int 1).
Proof. split; [| vm_compute; reflexivity]; intros n I; repeat destruct I as [<- | I]; try contradiction; split; vm_compute; reflexivity || discriminate. Qed.
Theorem touching_is_answered : answer_of_touching touching_tangency = Some (Of Int 0) /\ answer_of_touching undecided = Some (Of Int 2).
Proof. vm_compute; split; reflexivity. Qed.
End Touching.
