(** Stage 4: guesses of a double root, and what is proved of them.

    What floats are is not said: every operation with them may give any value. What proves a tangency are whole numbers, whatever
    guessed them. Here are floats as values without meaning, the numbers of the steps for any guess M and e, and what it says that they
    pass: the row touches. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Hypcheck Require Import Geometry Tangency Steps Fixed FixedRuns Long Limbs LimbsRuns Computed Trees StageThreeRuns Stages StageFour StageFourSteps.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** ** Floats. *)

(** A call, by the values of its arguments. *)
Lemma eval_given known now f given m l v : look f known = Some m -> every (map (eval known now) given) = Some l -> m l = v -> eval known now (Called f given) = v.
Proof. intros F G <-; cbn [eval]; rewrite F, G; reflexivity. Qed.
Lemma given_more known now e given v l : eval known now e = Some v -> every (map (eval known now) given) = Some l -> every (map (eval known now) (e :: given)) = Some (v :: l).
Proof. intros E G; cbn [map every]; rewrite E, G; reflexivity. Qed.

Section Floats.
Variables (float : string -> list datum -> Z) (less : datum -> datum -> bool) (nearest word : Z -> Z).

Definition made_by o given := Opaque "" (float o given).
Definition operation_of o (given : list datum) := match given with [_; _] => Some (made_by o given) | _ => None end.
Definition conversion o (given : list datum) := match given with [_] => Some (made_by o given) | _ => None end.
Definition of_floats : list (string * (list datum -> option datum)) := [
  ("+", operation_of "+"); ("-", operation_of "-"); ("*", operation_of "*"); ("/", operation_of "/");
  ("<", fun given => match given with [a; c] => Some (Of Int (if less a c then 1 else 0)) | _ => None end);
  (">", fun given => match given with [a; c] => Some (Of Int (if less c a then 1 else 0)) | _ => None end);
  ("as_double", conversion "as_double"); ("hc_fixed_value", conversion "hc_fixed_value"); ("hc_long_value", conversion "hc_long_value");
  ("as_word", fun given => match given with [Opaque _ k] => Some (Of U64 (word k mod W)) | _ => None end);
  ("hc_fixed_nearest", fun given => match given with [Opaque _ k] => Some (Fix (words_of (nearest k mod bits128))) | _ => None end)].
Definition of_touching := (of_longs ++ of_floats)%list.
Definition literals : environment := map (fun n => ("_" ++ n, Opaque n 0)) ["0.5"; "70368744177664.0"; "4.2535295865117308e37"].

Lemma longs_are_known n f : look n of_longs = Some f -> look n of_touching = Some f.
Proof. unfold of_touching; generalize of_longs as l; induction l as [| [m g] l IH]; cbn; [discriminate |]; destruct (String.eqb m n); [trivial | exact IH]. Qed.

(** A function that is called with the literals known. *)
Definition called_on (functions : list (string * deciding)) n given : option datum := try f <- look n functions;
  try now <- bound_all (map Named (takes f)) given literals; try (v, _) <- go of_touching [] steps now (does f); v.

(** A float of any kind, and what is made of it with one that is opaque, a word or an int. *)
Definition is_float d := match d with Opaque _ _ | Double _ _ => True | _ => False end.
Definition is_double d := match d with Double _ _ => true | _ => false end.
Lemma eval_float now o l r d c m : is_float d -> is_double d && is_double c = false -> eval of_touching now l = Some d -> eval of_touching now r = Some c ->
  look o of_touching = Some m -> eval of_touching now (Infix o l r) = m [d; c].
Proof. intros F B L R M; cbn [eval]; rewrite L, R, M; destruct d; try contradiction; [destruct c; try reflexivity; discriminate | reflexivity]. Qed.
Lemma eval_operation now o l r d c : is_in o ["+"; "-"; "*"; "/"] = true -> is_float d -> is_double d && is_double c = false ->
  eval of_touching now l = Some d -> eval of_touching now r = Some c -> eval of_touching now (Infix o l r) = Some (made_by o [d; c]).
Proof.
  intros O F B L R; rewrite (eval_float now o l r d c (operation_of o) F B L R); [reflexivity |]; unfold is_in in O; cbn [existsb] in O.
  repeat (apply orb_prop in O as [O | O]; [apply String.eqb_eq in O; subst o; reflexivity |]); discriminate.
Qed.
Lemma eval_below now l r d c : is_float d -> is_double d && is_double c = false -> eval of_touching now l = Some d -> eval of_touching now r = Some c ->
  eval of_touching now (Infix "<" l r) = Some (Of Int (if less d c then 1 else 0)) /\ eval of_touching now (Infix ">" l r) = Some (Of Int (if less c d then 1 else 0)).
Proof. intros F B L R; split; erewrite (eval_float now _ l r d c) by (eassumption || reflexivity); reflexivity. Qed.
Lemma held_float d : is_float d -> held "double" d = Some d.
Proof. destruct d; try contradiction; reflexivity. Qed.
Lemma bound_float n d now : is_float d -> bound n d now = (n, d) :: now.
Proof. destruct d; try contradiction; reflexivity. Qed.

(** An expression whose value is a float, or a truth. *)
Definition gives_float now e := exists n k, eval of_touching now e = Some (Opaque n k).
Definition gives_bit now e := exists c : bool, eval of_touching now e = Some (Of Int (if c then 1 else 0)).
Definition is_operation o := is_in o ["+"; "-"; "*"; "/"] = true.

Lemma float_named now n m k : look n now = Some (Opaque m k) -> gives_float now (Named n).
Proof. intros E; exists m, k; apply eval_named; exact E. Qed.
Lemma float_infix now o l r : is_operation o -> gives_float now l -> gives_float now r -> gives_float now (Infix o l r).
Proof.
  intros O (n & k & L) (m & j & R); unfold gives_float; cbn [eval]; rewrite L, R; unfold is_operation, is_in in O; cbn [existsb] in O.
  repeat (apply orb_prop in O as [O | O]; [apply String.eqb_eq in O; subst o; eexists; eexists; reflexivity |]); discriminate.
Qed.
Lemma float_opposite now e : gives_float now e -> gives_float now (Infix "-" (Constant Int 0) e).
Proof. intros (n & k & E); unfold gives_float; cbn [eval]; rewrite E; eexists; eexists; reflexivity. Qed.
Lemma float_choice now c a b (x : bool) : eval of_touching now c = Some (Of Int (if x then 1 else 0)) -> gives_float now a -> gives_float now b -> gives_float now (Choice c a b).
Proof. intros C A B; unfold gives_float; rewrite (eval_chosen _ _ _ _ _ _ _ C); destruct x; assumption. Qed.
Lemma bit_less now o l r : is_in o ["<"; ">"] = true -> gives_float now l -> gives_float now r -> gives_bit now (Infix o l r).
Proof.
  intros O (n & k & L) (m & j & R); unfold gives_bit; cbn [eval]; rewrite L, R; unfold is_in in O; cbn [existsb] in O.
  repeat (apply orb_prop in O as [O | O]; [apply String.eqb_eq in O; subst o; eexists; reflexivity |]); discriminate.
Qed.
Lemma bit_both now l r : gives_bit now l -> gives_bit now r -> gives_bit now (Infix "&&" l r).
Proof. intros (a & L) (c & R); unfold gives_bit; cbn [eval]; rewrite L; destruct a; [rewrite R; exists c; destruct c; reflexivity | exists false; reflexivity]. Qed.
Lemma bit_not now e : gives_bit now e -> gives_bit now (Infix "==" e (Constant Int 0)).
Proof. intros (a & E); exists (negb a); eapply eval_infix; [reflexivity | exact E | reflexivity |]; destruct a; reflexivity. Qed.
End Floats.

(** ** The numbers, for any guess. *)

Section Guesses.
Variables (inner : bool) (l1 l2 : list step) (ls : string -> Z).

Definition first_of_lengths n := if is_in n named then ls n else 0.
Definition before := computed (pattern_of inner) first_of_lengths l1.
Definition before_v := computed (exact_value inner) first_of_lengths l1.
Definition with_guess (num : string -> Z) M e := put (put num "M" M) "e" e.
Definition guessed M e := computed (pattern_of inner) (with_guess before M e) l2.
Definition guessed_v M e := computed (exact_value inner) (with_guess before_v M e) l2.

Definition is_later n := existsb (fun s => String.eqb (name s) n) l2 || is_in n ["M"; "e"].
Definition reads_of s := name s :: operands s.
Hypotheses (Ordered : ordered l1 = true /\ ordered l2 = true) (Apart : forallb (fun s => forallb (fun n => negb (is_later n)) (reads_of s)) l1 = true).

Lemma guessed_before M e n : is_later n = false -> guessed M e n = before n /\ guessed_v M e n = before_v n.
Proof.
  intros L; apply orb_false_elim in L as [L G]; unfold is_in in G; cbn [existsb] in G; apply orb_false_elim in G as [G1 G2]; apply orb_false_elim in G2 as [G2 _].
  rewrite String.eqb_sym in G1, G2; unfold guessed, guessed_v, with_guess; rewrite !computed_same, !put_other by assumption; split; reflexivity.
Qed.

Lemma runs_alike s num v num' v' : (forall n, In n (reads_of s) -> num' n = num n /\ v' n = v n) -> runs num v inner s -> runs num' v' inner s.
Proof.
  unfold runs, reads_of, operands; intros H; destruct (H (name s) (or_introl eq_refl)) as [-> ->].
  assert (other : forall n, In (Name n) (arguments s) -> num' n = num n /\ v' n = v n).
  { intros n I; apply H; right; apply in_flat_map; exists (Name n); split; [exact I | left; reflexivity]. }
  destruct (look (operation s) calls) as [[c w] |]; destruct (arguments s) as [| [a | a] [| [e | e] [| [f | f] [|]]]]; trivial;
    try (destruct c; trivial); try (destruct (other a ltac:(cbn; tauto)) as [-> ->]); try (destruct (other e ltac:(cbn; tauto)) as [-> ->]); try (destruct (other f ltac:(cbn; tauto)) as [-> ->]); trivial.
Qed.

Theorem before_runs : Forall (runs before before_v inner) l1.
Proof. apply computed_run, Ordered. Qed.
Theorem guessed_runs M e : Forall (runs (guessed M e) (guessed_v M e) inner) (l1 ++ l2).
Proof.
  apply Forall_app; split; [| apply computed_run, Ordered].
  apply Forall_forall; intros s I; apply runs_alike with before before_v; [| exact (proj1 (Forall_forall _ _) before_runs s I)].
  intros n J; apply guessed_before; rewrite forallb_forall in Apart; specialize (Apart s I); rewrite forallb_forall in Apart; apply negb_true_iff, Apart, J.
Qed.

Lemma guess_is M e : existsb (fun s => String.eqb (name s) "M") l2 = false -> existsb (fun s => String.eqb (name s) "e") l2 = false ->
  (guessed M e "M" = M /\ guessed_v M e "M" = M) /\ guessed M e "e" = e /\ guessed_v M e "e" = e.
Proof.
  intros L R; unfold guessed, guessed_v, with_guess; rewrite !computed_same by assumption.
  rewrite !put_same, !(put_other _ "e" _ "M"), !put_same by reflexivity; repeat split.
Qed.
Lemma guessed_lengths M e n : In n named -> existsb (fun s => String.eqb (name s) n) (l1 ++ l2) = false -> guessed M e n = ls n /\ guessed_v M e n = ls n.
Proof.
  rewrite existsb_app; intros I L; apply orb_false_elim in L as [L1 L2].
  assert (F : first_of_lengths n = ls n) by (destruct I as [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]; reflexivity).
  destruct (guessed_before M e n) as [-> ->]; [unfold is_later; rewrite L2; destruct I as [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]; reflexivity |].
  unfold before, before_v; rewrite !computed_same, F by assumption; split; reflexivity.
Qed.
End Guesses.

(** ** A row that touches, from within or from without. *)

Definition touching (inner : bool) alpha gamma b d x y z : Prop := exists M e, if inner
  then (tangency_equations alpha gamma b d x y z M e /\ M < 0 /\ - M * b ^ 2 <= alpha ^ 2 * (b * d))%R
  else (tangency_equations alpha gamma b d x y z M e /\ 0 < M /\ b * d * M <= e ^ 2 /\ M * d ^ 2 <= gamma ^ 2 * (b * d))%R.
Definition touches (inner : bool) (ls : string -> Z) := forall u w, (0 < u)%R -> (0 < w)%R ->
  touching inner (IZR (ls "alpha") * u) (IZR (ls "gamma") * w) (IZR (ls "b") * u) (IZR (ls "d") * w) (IZR (ls "x") * u) (IZR (ls "y") * u) (IZR (ls "z") * w).
(** 2, or the side. *)
Definition is_side ls r := r = 2 \/ exists inner : bool, r = (if inner then -1 else 1) /\ touches inner ls.

Section Verdict.
Variables (inner : bool) (ls : string -> Z) (M e : Z) (bits most : Z) (inputs : list (string * interval)) (l1 l2 : list step).
Hypotheses (Steps : (inputs = long_inputs /\ (l1 ++ l2)%list = C_tangency /\ bits = 62 /\ most = 2 ^ 126 - 1)
    \/ (inputs = short_inputs /\ (l1 ++ l2)%list = C_short /\ bits = 23 /\ most = 2 ^ 46))
  (Ordered : ordered l1 = true /\ ordered l2 = true) (Apart : forallb (fun s => forallb (fun n => negb (is_later l2 n)) (reads_of s)) l1 = true).
Hypotheses (Lengths : forall n, In n named -> 0 <= ls n < 2 ^ bits) (Sizes : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < ls n)
  (BM : 0 <= M <= most) (Be : 0 <= e <= most).
Let num := guessed inner l1 l2 ls M e.
Let v := guessed_v inner l1 l2 ls M e.
Let wide := twice_M inputs.

Lemma not_a_step n : In n ("M" :: "e" :: named) -> existsb (fun s => String.eqb (name s) n) (l1 ++ l2) = false.
Proof.
  intros I; destruct Steps as [(_ & -> & _) | (_ & -> & _)]; destruct I as [<- | [<- | [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]]]; vm_compute; reflexivity.
Qed.
Lemma begins n : In n named -> num n = ls n /\ v n = ls n.
Proof. intros I; apply guessed_lengths; [exact I | apply not_a_step; right; right; exact I]. Qed.
Lemma begins_guess : (num "M" = M /\ v "M" = M) /\ num "e" = e /\ v "e" = e.
Proof.
  apply guess_is; [pose proof (not_a_step "M" (or_introl eq_refl)) as N | pose proof (not_a_step "e" (or_intror (or_introl eq_refl))) as N];
    rewrite existsb_app in N; apply orb_false_elim in N; apply N.
Qed.
Lemma inputs_hold : all_hold num v inputs.
Proof.
  destruct begins_guess as ((NM & VM) & Ne & Ve).
  assert (G : forall n, (n = "M" \/ n = "e") -> num n = v n /\ 0 <= v n <= most) by (intros n [-> | ->]; [rewrite NM, VM | rewrite Ne, Ve]; split; trivial).
  assert (L : forall n, In n named -> num n = v n /\ 0 <= v n < 2 ^ bits) by (intros n I; destruct (begins n I) as [-> ->]; split; [reflexivity | apply Lengths; exact I]).
  assert (held : forall n w m, num n = v n /\ 0 <= v n <= m -> m < 2 ^ w -> 0 < w -> holds num v n (Interval w 0 m)).
  { intros n w m [E B] F P; unfold holds; cbn [StageFour.bits least StageFour.most]; rewrite E; split; [symmetry; apply Z.mod_small; lia |]; split; [exact B |].
    unfold fit; cbn [StageFour.bits least StageFour.most]; apply andb_true_intro; split; apply Z.ltb_lt; assumption. }
  intros n i E; apply look_in in E; destruct Steps as [(-> & _ & EB & EM) | (-> & _ & EB & EM)]; rewrite EB, EM in *;
    cbn [long_inputs short_inputs StageFour.lengths map In] in E; destruct E as [E | [E | E]];
    try (injection E as <- <-; apply held; [apply G; auto | reflexivity | reflexivity]).
  all: assert (I : In n named) by (clear - E; repeat destruct E as [E | E]; try contradiction; injection E as <- <-; cbn; tauto).
  all: repeat destruct E as [E | E]; try contradiction; injection E as <- <-; (apply held; [| reflexivity | reflexivity]); destruct (L _ I); split; lia.
Qed.

Let zero n := num n = 0.
Let not_negative n := ~ 2 ^ (wide - 1) <= num n.
Theorem passed : zero "r1" -> zero "r2" -> zero "r3" -> (if inner then not_negative "room_within" else not_negative "beyond" /\ not_negative "room_without") -> touches inner ls.
Proof.
  intros Z1 Z2 Z3 Room u w U V; unfold touching.
  assert (pos : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < v n) by (intros n I; rewrite (proj2 (begins n ltac:(clear - I; cbn in *; tauto))); apply Sizes, I).
  assert (same : forall n, In n named -> IZR (ls n) = IZR (v n)) by (intros n I; rewrite (proj2 (begins n I)); reflexivity).
  rewrite !same by (cbn; tauto).
  assert (St : (inputs = long_inputs /\ (l1 ++ l2)%list = C_tangency) \/ (inputs = short_inputs /\ (l1 ++ l2)%list = C_short)) by (destruct Steps as [(A & B & _) | (A & B & _)]; auto).
  pose proof (proved_tangency num v inner inputs (l1 ++ l2)%list St inputs_hold (guessed_runs inner l1 l2 ls Ordered Apart M e)
    (pos "alpha" ltac:(cbn; tauto)) (pos "gamma" ltac:(cbn; tauto)) (pos "b" ltac:(cbn; tauto)) (pos "d" ltac:(cbn; tauto)) u w U V Z1 Z2 Z3 Room) as T.
  destruct inner; eexists; eexists; exact T.
Qed.
End Verdict.
