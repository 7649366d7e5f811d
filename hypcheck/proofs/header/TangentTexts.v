(** The half planes of a scene: Coq runs the text of hc_tangent_beyond and of hc_tangent_within, whatever their comparisons say.

    A line gets the constants that the printed steps compute where four comparisons hold, and else those of a line that proves nothing.
    [greater] and [at_least] say which comparison holds. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Ranges Steps Limbs Trees FloatSteps FloatTexts.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Definition texts := map (fun text => deciding_of (string_of text)) HeaderText.tangents.
Definition functions := Eval vm_compute in match every texts with Some l => l | None => [] end.
Definition does n := match look n functions with Some f => Trees.does f | None => [] end.

Definition C_beyond := Eval vm_compute in steps_in "tangent-beyond".
Definition C_within := Eval vm_compute in steps_in "tangent-within".
Theorem steps_are_read : [C_beyond; C_within] = map steps_in ["tangent-beyond"; "tangent-within"].
Proof. vm_compute; reflexivity. Qed.

(** What a text puts into the two fields of the line. *)
Definition puts_line functions (fuel : nat) known defined n given : option (datum * datum) := try f <- look n functions;
  try now <- bound_all (map Named (firstn 2 (takes f))) given defined; try (v, now') <- go known [] fuel now (Trees.does f);
  match v, look "line.K" now', look "line.M" now' with None, Some k, Some m => Some (k, m) | _, _, _ => None end.

Section Texts.

Variables greater at_least : argument -> argument -> bool.
Definition of_comparisons := [(">", compared greater); (">=", compared at_least); ("<=", compared (fun a c => at_least c a))].
Definition known_beyond := (of_floats [] C_beyond ++ of_comparisons)%list.
Definition known_within := (of_floats [] C_within ++ of_comparisons)%list.
Definition sizes := Rec (combine (map snd places) (map (fun n => Opaque n always) ["alpha"; "gamma"; "b"; "d"])).
Definition of_lines : environment := map (fun n => ("HC_" ++ n, Opaque n always)%string) ["u_8"; "more"; "less"; "least_constant"; "greatest_slope"; "NEVER"].
Definition text_of_beyond := puts_line functions (6 + (List.length C_beyond + 4)) known_beyond of_lines "hc_tangent_beyond" [sizes; Opaque "lambda_" always].
Definition text_of_within := puts_line functions (6 + (List.length C_within + 4)) known_within of_lines "hc_tangent_within" [sizes; Opaque "mu" always].

Definition proves_beyond := greater (Name "lambda_") (Number 0) && greater (Name "gap_least") (Number 0) && at_least (Name "K_most") (Name "least_constant")
  && at_least (Name "greatest_slope") (Name "M_most").
Definition proves_within := greater (Name "mu") (Number 1) && greater (Name "across_least") (Number 0) && at_least (Name "K_least") (Name "least_constant")
  && at_least (Name "greatest_slope") (Name "M_least").

Lemma eval_and known now l r a c : eval known now l = Some (Of Int (bit a)) -> eval known now r = Some (Of Int (bit c)) ->
  eval known now (Infix "&&" l r) = Some (Of Int (bit (a && c))).
Proof. intros L R; cbn [eval]; rewrite L, R; destruct a, c; reflexivity. Qed.
Lemma eval_first known now c a b v : eval known now c = Some (Of Int (bit true)) -> eval known now a = Some v -> eval known now (Choice c a b) = Some v.
Proof. intros E F; cbn [eval]; rewrite E; exact F. Qed.
Lemma eval_second known now c a b v : eval known now c = Some (Of Int (bit false)) -> eval known now b = Some v -> eval known now (Choice c a b) = Some v.
Proof. intros E F; cbn [eval]; rewrite E; exact F. Qed.
Lemma eval_compared known now o f l r a c p q : eval known now l = Some p -> eval known now r = Some q -> is_opaque p = true -> argument_in p = Some a -> argument_in q = Some c ->
  look o known = Some (compared f) -> eval known now (Infix o l r) = Some (Of Int (bit (f a c))).
Proof. intros L R O A C G; destruct p; try discriminate; injection A as <-; cbn [eval]; rewrite L, R, G; unfold compared; cbn [map every argument_in]; rewrite C; reflexivity. Qed.

(** Floats by their names in the C. *)
Definition has_floats (floats : list (string * string)) now := forall n m, look n floats = Some m -> look n now = Some (Opaque m always).
Lemma floats_given floats now : forallb (fun p => match look (fst p) now with Some (Opaque m k) => String.eqb m (snd p) && (k =? always) | _ => false end) floats = true -> has_floats floats now.
Proof.
  rewrite forallb_forall; intros H n m E; apply look_in in E; specialize (H _ E); cbn [fst snd] in H.
  destruct (look n now) as [[] |]; try discriminate; apply andb_prop in H as [H1 H2]; apply String.eqb_eq in H1; apply Z.eqb_eq in H2; subst; reflexivity.
Qed.

Ltac float F := lazymatch goal with |- eval _ _ (Named ?n) = _ => apply eval_named; exact (F n _ eq_refl) | _ => reflexivity end.
Ltac conditions F := lazymatch goal with
  | |- eval _ _ (Infix "&&" _ _) = _ => apply eval_and; conditions F
  | _ => eapply eval_compared; [float F | float F | reflexivity | reflexivity | reflexivity | reflexivity] end.

Definition floats_of (n steps : list string) := (map (fun n => (n, n)) (n ++ steps) ++ map (fun n => ("HC_" ++ n, n)%string) ["u_8"; "more"; "less"; "least_constant"; "greatest_slope"; "NEVER"])%list.

Definition beyond_floats := Eval vm_compute in floats_of ["lambda_"; "alpha"; "gamma"; "b"; "d"; "u_8"; "more"] (map name C_beyond).
Definition first_of_beyond := Eval vm_compute in firstn 6 (does "hc_tangent_beyond").
Definition steps_of_beyond := Eval vm_compute in firstn (List.length C_beyond) (skipn 6 (does "hc_tangent_beyond")).
Definition last_of_beyond := Eval vm_compute in skipn (List.length C_beyond) (skipn 6 (does "hc_tangent_beyond")).
Definition within_floats := Eval vm_compute in floats_of ["mu"; "alpha"; "gamma"; "b"; "d"; "u_8"; "less"] (map name C_within).
Definition first_of_within := Eval vm_compute in firstn 6 (does "hc_tangent_within").
Definition steps_of_within := Eval vm_compute in firstn (List.length C_within) (skipn 6 (does "hc_tangent_within")).
Definition last_of_within := Eval vm_compute in skipn (List.length C_within) (skipn 6 (does "hc_tangent_within")).

Theorem beyond_text : text_of_beyond = Some (if proves_beyond then (Opaque "K_most" always, Opaque "M_most" always) else (Opaque "NEVER" always, Of Int 0)).
Proof.
  set (read := ["alpha"; "gamma"; "b"; "d"; "u_8"; "more"]); set (now := ("lambda_", Opaque "lambda_" always) :: bound "sizes" sizes of_lines).
  set (later := given_floats always (map name C_beyond) (given_floats always read now)).
  assert (F : has_floats beyond_floats later) by (apply floats_given; vm_compute; reflexivity).
  assert (N : look "proves" later = None) by (vm_compute; reflexivity).
  unfold text_of_beyond, puts_line; change (match go known_beyond [] (6 + (List.length C_beyond + 4)) now (first_of_beyond ++ (steps_of_beyond ++ last_of_beyond)) with
    Some (v, now') => match v, look "line.K" now', look "line.M" now' with None, Some k, Some m => Some (k, m) | _, _, _ => None end | None => None end
    = Some (if proves_beyond then (Opaque "K_most" always, Opaque "M_most" always) else (Opaque "NEVER" always, Of Int 0))).
  assert (E : forall f rest, go known_beyond [] (6 + f) now (first_of_beyond ++ rest) = go known_beyond [] f (given_floats always read now) rest).
  { intros f rest; unfold first_of_beyond; cbn [app Nat.add]; do 6 (erewrite go_put; [| reflexivity | reflexivity | reflexivity]; cbn [bound]); reflexivity. }
  rewrite E; clear E; unfold known_beyond at 1.
  rewrite (go_steps C_beyond [] [] always []) with (steps := C_beyond) (have := ("lambda_" :: read)%list); [| vm_compute; reflexivity | vm_compute; reflexivity | |].
  - fold known_beyond later; clearbody later; unfold last_of_beyond.
    erewrite go_put; [| unfold is_new; rewrite N; reflexivity | conditions F | reflexivity]; cbn [bound]; fold proves_beyond; destruct proves_beyond.
    + erewrite go_put; [| reflexivity | apply eval_first; [apply eval_named; reflexivity | float F] | reflexivity]; cbn [bound].
      erewrite go_put; [| reflexivity | apply eval_first; [apply eval_named; reflexivity | float F] | reflexivity]; reflexivity.
    + erewrite go_put; [| reflexivity | apply eval_second; [apply eval_named; reflexivity | float F] | reflexivity]; cbn [bound].
      erewrite go_put; [| reflexivity | apply eval_second; [apply eval_named; reflexivity | float F] | reflexivity]; reflexivity.
  - intros n I; rewrite look_given; destruct (is_in n read) eqn:J; [reflexivity |].
    change (is_in n ("lambda_" :: read)) with (String.eqb n "lambda_" || is_in n read) in I; rewrite J, orb_false_r in I; apply String.eqb_eq in I; subst n; reflexivity.
  - intros s I; apply (new_ones (map name C_beyond)); [vm_compute; reflexivity | apply in_map; exact I].
Qed.

Theorem within_text : text_of_within = Some (if proves_within then (Opaque "K_least" always, Opaque "M_least" always) else (Of Int (-1), Of Int 0)).
Proof.
  set (read := ["alpha"; "gamma"; "b"; "d"; "u_8"; "less"]); set (now := ("mu", Opaque "mu" always) :: bound "sizes" sizes of_lines).
  set (later := given_floats always (map name C_within) (given_floats always read now)).
  assert (F : has_floats within_floats later) by (apply floats_given; vm_compute; reflexivity).
  assert (N : look "proves" later = None) by (vm_compute; reflexivity).
  unfold text_of_within, puts_line; change (match go known_within [] (6 + (List.length C_within + 4)) now (first_of_within ++ (steps_of_within ++ last_of_within)) with
    Some (v, now') => match v, look "line.K" now', look "line.M" now' with None, Some k, Some m => Some (k, m) | _, _, _ => None end | None => None end
    = Some (if proves_within then (Opaque "K_least" always, Opaque "M_least" always) else (Of Int (-1), Of Int 0))).
  assert (E : forall f rest, go known_within [] (6 + f) now (first_of_within ++ rest) = go known_within [] f (given_floats always read now) rest).
  { intros f rest; unfold first_of_within; cbn [app Nat.add]; do 6 (erewrite go_put; [| reflexivity | reflexivity | reflexivity]; cbn [bound]); reflexivity. }
  rewrite E; clear E; unfold known_within at 1.
  rewrite (go_steps C_within [] [] always []) with (steps := C_within) (have := ("mu" :: read)%list); [| vm_compute; reflexivity | vm_compute; reflexivity | |].
  - fold known_within later; clearbody later; unfold last_of_within.
    erewrite go_put; [| unfold is_new; rewrite N; reflexivity | conditions F | reflexivity]; cbn [bound]; fold proves_within; destruct proves_within.
    + erewrite go_put; [| reflexivity | apply eval_first; [apply eval_named; reflexivity | float F] | reflexivity]; cbn [bound].
      erewrite go_put; [| reflexivity | apply eval_first; [apply eval_named; reflexivity | float F] | reflexivity]; reflexivity.
    + erewrite go_put; [| reflexivity | apply eval_second; [apply eval_named; reflexivity | float F] | reflexivity]; cbn [bound].
      erewrite go_put; [| reflexivity | apply eval_second; [apply eval_named; reflexivity | float F] | reflexivity]; reflexivity.
  - intros n I; rewrite look_given; destruct (is_in n read) eqn:J; [reflexivity |].
    change (is_in n ("mu" :: read)) with (String.eqb n "mu" || is_in n read) in I; rewrite J, orb_false_r in I; apply String.eqb_eq in I; subst n; reflexivity.
  - intros s I; apply (new_ones (map name C_within)); [vm_compute; reflexivity | apply in_map; exact I].
Qed.

End Texts.
