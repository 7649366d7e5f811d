(** One pair: Coq runs the text of hc_single, whatever its comparisons say.

    Its steps are those that Ranges.v reads between the marks of the header; [greater] says which comparison holds. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Ranges Steps Limbs Trees FloatSteps.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Definition texts := map (fun text => deciding_of (string_of text)) HeaderText.floats.
Definition functions := Eval vm_compute in match every texts with Some l => l | None => [] end.
Theorem texts_are_read : texts = map Some functions.
Proof. vm_cast_no_check (eq_refl (map Some functions)). Qed.
Definition does n := match look n functions with Some f => Trees.does f | None => [] end.

Definition inputs := ["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"].

Lemma go_put known procedures f now t n e rest v w : is_new t n now = true -> eval known now e = Some v -> held t v = Some w ->
  go known procedures (S f) now (Set_ t n e :: rest) = go known procedures f (bound n w now) rest.
Proof. intros N E H; cbn [go]; rewrite N, E, H; reflexivity. Qed.
Lemma go_return known procedures f now e rest v : eval known now e = Some v -> go known procedures (S f) now (Returns e :: rest) = Some (Some v, now).
Proof. intros E; cbn [go]; rewrite E; reflexivity. Qed.

Definition are_new (names : list string) (now : environment) := forallb (fun n => match look n now with None => true | Some _ => false end) names.
Lemma is_in_In n l : is_in n l = true <-> In n l.
Proof. unfold is_in; rewrite existsb_exists; split; [intros (m & I & E); apply String.eqb_eq in E; subst; exact I | intros I; exists n; rewrite String.eqb_refl; auto]. Qed.
Lemma new_ones names now n : are_new names now = true -> In n names -> look n now = None.
Proof. unfold are_new; rewrite forallb_forall; intros H I; specialize (H n I); destruct (look n now); [discriminate | reflexivity]. Qed.

(** What the header defines by name, without its prefix. *)
Definition constants := ["u_4"; "u_8"; "u_12"; "u_16"; "u_1536"; "slack"; "least"; "greatest"; "farthest"].
Definition defined : environment := map (fun n => ("HC_" ++ n, Opaque n always)) constants.

Lemma eval_named known now n v : look n now = Some v -> eval known now (Named n) = Some v.
Proof. intros E; cbn [eval]; rewrite E; reflexivity. Qed.
Lemma eval_called known now f given m l v : look f known = Some m -> every (map (eval known now) given) = Some l -> m l = v ->
  eval known now (Called f given) = v.
Proof. intros F G <-; cbn [eval]; rewrite F, G; reflexivity. Qed.
Lemma eval_ints known now o l r t x u y : is_in o ["&&"; "||"] = false -> eval known now l = Some (Of t x) -> eval known now r = Some (Of u y) ->
  eval known now (Infix o l r) = plain_infix o t x u y.
Proof.
  intros O L R; cbn [is_in existsb] in O; apply orb_false_elim in O as [O1 O]; apply orb_false_elim in O as [O2 _]; cbn [eval]; rewrite L, R, O1, O2; reflexivity.
Qed.

(** A function for these arguments, in at most so many steps. *)
Definition called_with functions (fuel : nat) known (defined : environment) n given : option datum := try f <- look n functions;
  try now <- bound_all (map Named (takes f)) given defined; try (v, _) <- go known [] fuel now (Trees.does f); v.

(** ** One pair. *)

Section Single.

Variable greater : argument -> argument -> bool.
Definition bit (b : bool) := if b then 1 else 0.
Definition compared f (given : list datum) : option datum := match every (map argument_in given) with Some [a; c] => Some (Of Int (bit (f a c))) | _ => None end.

(** The last of these have no name in the C. *)
Definition steps_of_single := (C_single ++ [Step "slack_A" "mul" [Name "slack"; Name "A"]; Step "minus_E" "neg" [Name "E"];
  Step "minus_e1" "neg" [Name "e1"]; Step "minus_e2" "neg" [Name "e2"]])%list.
Definition of_comparisons := [(">", compared greater); ("<", compared (fun a c => greater c a))].
Definition known_single := (of_floats [] steps_of_single ++ of_comparisons)%list.

Definition row := Rec (combine (map snd places) (map (fun n => Opaque n always) inputs)).
Definition text_of_single := called_with functions (10 + (List.length C_single + 10)) known_single defined "hc_single" [row].

Let g a c := greater (Name a) (Name c).
Definition sizes_fit := greater (Name "alpha") (Number 0) && greater (Name "gamma") (Number 0) && g "b" "least" && g "greatest" "b" && g "d" "least" && g "greatest" "d".
Definition ratios_fit := g "A" "slack" && g "greatest" "A" && g "B" "least" && g "greatest" "B" && g "BB" "slack_A".
Definition one_root := g "minus_E" "delta_3".
Definition apart := g "delta_3" "E".
Definition is_outside := g "minus_e2" "c2" && g "c1" "e1".
Definition is_inside := g "c2" "e2" || g "minus_e1" "c1".
Definition says_single := if sizes_fit && ratios_fit && g "farthest" "P_plus_Q" && (one_root || apart && (is_outside || is_inside))
  then bit apart * (bit is_outside - bit is_inside) else 2.

Definition steps_in_single := Eval vm_compute in firstn (List.length C_single) (skipn 10 (does "hc_single")).
Definition first_of_single := Eval vm_compute in firstn 10 (does "hc_single").
Definition last_of_single := Eval vm_compute in skipn (10 + List.length C_single) (does "hc_single").
Lemma steps_are_those : map step_in steps_in_single = map Some C_single.
Proof. vm_compute; reflexivity. Qed.

Let known := known_single.
Definition is_opaque d := match d with Opaque _ _ => true | _ => false end.
Lemma eval_more now l r a c p q : eval known now l = Some p -> eval known now r = Some q -> is_opaque p = true -> argument_in p = Some a -> argument_in q = Some c ->
  eval known now (Infix ">" l r) = Some (Of Int (bit (greater a c))) /\ eval known now (Infix "<" l r) = Some (Of Int (bit (greater c a))).
Proof.
  intros L R O A C; destruct p; try discriminate; injection A as <-; cbn [eval]; rewrite L, R.
  assert (G : look ">" known = Some (compared greater) /\ look "<" known = Some (compared (fun a c => greater c a))) by (split; reflexivity).
  destruct G as [-> ->]; unfold compared; cbn [map every argument_in]; rewrite C; auto.
Qed.
Lemma eval_and now l r a c : eval known now l = Some (Of Int (bit a)) -> eval known now r = Some (Of Int (bit c)) -> eval known now (Infix "&" l r) = Some (Of Int (bit (a && c))).
Proof. intros L R; cbn [eval]; rewrite L, R; destruct a, c; reflexivity. Qed.
Lemma eval_or now l r a c : eval known now l = Some (Of Int (bit a)) -> eval known now r = Some (Of Int (bit c)) -> eval known now (Infix "|" l r) = Some (Of Int (bit (a || c))).
Proof. intros L R; cbn [eval]; rewrite L, R; destruct a, c; reflexivity. Qed.
Lemma eval_not now e a : eval known now e = Some (Of Int (bit a)) -> eval known now (Infix "==" e (Constant Int 0)) = Some (Of Int (bit (negb a))).
Proof. intros E; cbn [eval]; rewrite E; destruct a; reflexivity. Qed.

(** What is known of the floats behind the steps, by their names in the C. *)
Definition floats_of_single := Eval vm_compute in
  (map (fun n => (n, n)) (inputs ++ ["u_8"; "u_12"; "u_1536"] ++ map name C_single) ++ map (fun n => ("HC_" ++ n, n)%string) constants)%list.
Definition has_floats now := forall n m, look n floats_of_single = Some m -> look n now = Some (Opaque m always).
Lemma eval_unnamed now : look "HC_slack" now = Some (Opaque "slack" always) -> look "A" now = Some (Opaque "A" always) ->
  eval known now (Infix "*" (Named "HC_slack") (Named "A")) = Some (Opaque "slack_A" always).
Proof. intros L R; cbn [eval]; rewrite L, R; vm_compute; reflexivity. Qed.
Lemma eval_opposite now n m : In (n, m) [("E", "minus_E"); ("e1", "minus_e1"); ("e2", "minus_e2")] -> look n now = Some (Opaque n always) ->
  eval known now (Infix "-" (Constant Int 0) (Named n)) = Some (Opaque m always).
Proof. intros I L; cbn [eval]; rewrite L; cbn [In] in I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; vm_compute; reflexivity. Qed.
Lemma eval_answer now a c e : look "apart" now = Some (Of Int (bit a)) -> look "outside" now = Some (Of Int (bit c)) -> look "inside" now = Some (Of Int (bit e)) ->
  eval known now (Infix "*" (Named "apart") (Infix "-" (Named "outside") (Named "inside"))) = Some (Of Int (bit a * (bit c - bit e))).
Proof. intros A C E; cbn [eval]; rewrite A, C, E; destruct a, c, e; reflexivity. Qed.
Lemma go_if f now c yes no rest x : eval known now c = Some (Of Int (bit x)) ->
  go known [] (S f) now (If c yes no :: rest) = go known [] f now ((if x then yes else no) ++ rest)%list.
Proof. intros E; cbn [go]; rewrite E; destruct x; reflexivity. Qed.

Definition start := bound "row" row defined.
Definition read_before := (inputs ++ ["u_8"; "u_12"; "u_1536"])%list.
Definition later := given_floats always (map name C_single) (given_floats always read_before start).
Lemma floats_given : has_floats later.
Proof.
  assert (H : forallb (fun p => match look (fst p) later with Some (Opaque m k) => String.eqb m (snd p) && (k =? always) | _ => false end) floats_of_single = true)
    by (vm_compute; reflexivity).
  rewrite forallb_forall in H; intros n m E; apply look_in in E; specialize (H _ E); cbn [fst snd] in H.
  destruct (look n later) as [[] |]; try discriminate; apply andb_prop in H as [H1 H2]; apply String.eqb_eq in H1; apply Z.eqb_eq in H2; subst; reflexivity.
Qed.

Definition names_of_ints := ["sizes_fit"; "ratios_fit"; "contact"; "apart"; "outside"; "inside"].
Lemma ints_are_new n : is_in n names_of_ints = true -> look n later = None.
Proof. intros I; apply (new_ones names_of_ints); [vm_compute; reflexivity | apply is_in_In; exact I]. Qed.

Ltac float F := lazymatch goal with
  | |- eval _ _ (Named ?n) = _ => apply eval_named; exact (F n _ eq_refl)
  | |- eval _ _ (Constant _ _) = _ => reflexivity
  | |- eval _ _ (Infix "*" (Named "HC_slack") (Named "A")) = _ => apply eval_unnamed; [exact (F "HC_slack" _ eq_refl) | exact (F "A" _ eq_refl)]
  | |- eval _ _ (Infix "-" (Constant Int 0) (Named ?n)) = _ => eapply eval_opposite; [cbn [In]; tauto | exact (F n _ eq_refl)] end.
Ltac answered := lazymatch goal with |- eval _ _ (Infix "*" (Named "apart") (Infix "-" (Named "outside") (Named "inside"))) = _ =>
  apply eval_answer; reflexivity end.
Ltac compared F := eapply eval_more; [float F | float F | reflexivity | reflexivity | reflexivity].
Ltac bits F := lazymatch goal with
  | |- eval _ _ (Infix "&" _ _) = _ => apply eval_and; bits F
  | |- eval _ _ (Infix "|" _ _) = _ => apply eval_or; bits F
  | |- eval _ _ (Infix "==" _ _) = _ => apply eval_not; bits F
  | |- eval _ _ (Infix ">" _ _) = _ => compared F
  | |- eval _ _ (Infix "<" _ _) = _ => compared F
  | |- eval _ _ (Named _) = _ => apply eval_named; reflexivity end.
Ltac next_int F N := lazymatch goal with |- context [Set_ _ ?n _ :: _] =>
  let H := fresh in pose proof (N n eq_refl) as H; erewrite go_put; [| unfold is_new; cbn [look]; cbn; rewrite H; reflexivity | bits F | reflexivity]; clear H; cbn [bound] end.

Theorem single_text : text_of_single = Some (Of Int says_single).
Proof.
  unfold text_of_single, called_with.
  change (match go known [] (10 + (List.length C_single + 10)) start (first_of_single ++ (steps_in_single ++ last_of_single)) with Some (v, _) => v | None => None end
    = Some (Of Int says_single)).
  assert (E : forall f rest, go known [] (10 + f) start (first_of_single ++ rest) = go known [] f (given_floats always read_before start) rest).
  { intros f rest; unfold first_of_single; cbn [app Nat.add]; do 10 (erewrite go_put; [| reflexivity | reflexivity | reflexivity]; cbn [bound]); reflexivity. }
  rewrite E; clear E; change known with (of_floats [] steps_of_single ++ of_comparisons)%list.
  rewrite (go_steps steps_of_single [] [] always []) with (steps := C_single) (have := read_before); [| exact steps_are_those | vm_compute; reflexivity | |].
  - pose proof floats_given as F; pose proof ints_are_new as N; fold later; set (now := later) in *; clearbody now.
    change (of_floats [] steps_of_single ++ of_comparisons)%list with known; unfold last_of_single.
    do 6 next_int F N.
    erewrite go_if by bits F.
    unfold says_single, sizes_fit, ratios_fit, one_root, apart, is_outside, is_inside, g; lazymatch goal with |- context [if negb ?c then _ else _] => destruct c end;
      cbv beta iota delta [negb]; cbn [app].
    + erewrite (go_return known []); [| answered]; reflexivity.
    + erewrite (go_return known []); [| reflexivity]; reflexivity.
  - intros n I; rewrite look_given, I; reflexivity.
  - intros s I; apply (new_ones (map name C_single)); [vm_compute; reflexivity | apply in_map; exact I].
Qed.
End Single.
