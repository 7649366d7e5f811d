(** Stage 3: the functions of the header, run by Coq. Shift counts, the balance, what is asked of which number with which bound, and
    which comparison answers what are read in the C.

    The functions of words that they call compute what LimbsRuns.v and ShiftRuns.v prove of their text; a double is read as its 53
    bits and its power. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed FixedRuns Long Limbs LimbsRuns ShiftRuns Computed Trees.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** Their text. *)
Definition texts := map (fun text => deciding_of (string_of text)) HeaderText.deciding.
Definition functions := Eval vm_compute in match every texts with Some l => l | None => [] end.
Theorem texts_are_read : texts = map Some functions.
Proof. vm_compute; reflexivity. Qed.

(** ** What they call. *)

Definition sign_int (c : comparison) := match c with Gt => 1 | Lt => -1 | Eq => 0 end.
Definition provided {A} (c : bool) (v : A) : option A := if c then Some v else None.
Definition bounded error grown := (0 <=? error) && (0 <=? grown) && (grown <? 128) && (error * 2 ^ grown <? bits128).
Definition numbers f (given : list datum) := match given with [Fix a; Fix c] => Some (Fix (f a c)) | _ => None end.

Definition of_words : list (string * (list datum -> option datum)) := [
  ("hc_fixed_plus", numbers plus); ("hc_fixed_minus", numbers minus); ("hc_fixed_product", numbers product);
  ("hc_fixed_signed_product", numbers signed_product); ("hc_fixed_both_signed_product", numbers both_signed_product);
  ("hc_fixed_square", fun given => match given with [Fix a] => Some (Fix (square a)) | _ => None end);
  ("hc_fixed_full", fun given => match given with [Of U64 a; Of U64 c] => Some (Fix (full a c)) | _ => None end);
  ("hc_fixed_up", fun given => match given with [Fix a; Of Int k] => counted Wide k (Some (Fix (shifted_up a k))) | _ => None end);
  ("hc_fixed_down", fun given => match given with [Fix a; Of Int k] => provided (0 <=? k) (Fix (shifted_down a k)) | _ => None end);
  ("hc_fixed_times", fun given => match given with [Of Int k; Fix a] => provided (existsb (Z.eqb k) factors) (Fix (times_of k a)) | _ => None end);
  ("hc_fixed_bits", fun given => match given with [Fix a] => Some (Of Int (bits_of a)) | _ => None end);
  ("hc_fixed_sign", fun given => match given with
    | [Fix a; Of Int error; Of Int grown] => provided (bounded error grown) (Of Int (sign_int (sign_of a (error * 2 ^ grown)))) | _ => None end)].

(** The square of a length. *)
Definition whole m := full (m * 2 ^ 10) (m * 2 ^ 10).

(** The 53 bits and the power of a double. *)
Definition parts_of := ("hc_fixed_parts_of", fun given => match given with
  | [Double m e] => Some (Rec [("sign", Of Int 1); ("exponent", Of Int e); ("mantissa", Of U64 (Z.abs m))]) | _ => None end).

(** What the header defines by name. *)
Definition constants : environment := ("HC_MOST_GROWN", Of Int most_grown) ::
  map (fun n => ("HC_fixed_" ++ n, Of Int (said n))) ["coefficient"; "pole"; "delta"; "middle"].

(** A function that is called: it returns a value, or puts some where its last parameters lead. *)
Section Called.
Variable functions : list (string * deciding).
Variable known : list (string * (list datum -> option datum)).
Variable procedures : list (string * (nat * (list datum -> option (list datum)))).
Definition called n (given : list datum) : option datum := try f <- look n functions;
  try now <- bound_all (map Named (firstn (List.length given) (takes f))) given constants;
  try (v, _) <- go known procedures steps now (does f); v.
Definition puts n (given : list datum) : option (list datum) := try f <- look n functions;
  try now <- bound_all (map Named (firstn (List.length given) (takes f))) given constants;
  try (v, now') <- go known procedures steps now (does f);
  match v with None => every (map (fun p => look p now') (skipn (List.length given) (takes f))) | Some _ => None end.
End Called.

Ltac function n := lazymatch goal with |- context [look n ?l] => let f := eval vm_compute in (look n l) in change (look n l) with f end.

(** Evaluation, with what is known of numbers left as it is. *)
Ltac value text := eval cbv -[Z.leb Z.land Z.lor Z.lxor Z.add Z.sub Z.mul Z.div Z.modulo Z.pow Z.quot Z.max Z.min Z.abs carry same in_int counted provided bounded bits_of sign_of sign_int
  said most_grown W bits128 plus minus product signed_product both_signed_product square full shifted_up shifted_down times_of whole called puts] in text.

Lemma go_put known procedures f now t n e rest v w : is_new t n now = true -> eval known now e = Some v -> held t v = Some w ->
  go known procedures (S f) now (Set_ t n e :: rest) = go known procedures f (bound n w now) rest.
Proof. intros N E H; cbn [go]; rewrite N, E, H; reflexivity. Qed.

Lemma eval_infix known now o l r t x u y v : is_in o ["&&"; "||"] = false -> eval known now l = Some (Of t x) -> eval known now r = Some (Of u y) ->
  plain_infix o t x u y = v -> eval known now (Infix o l r) = v.
Proof.
  intros O L R <-; cbn [eval]; rewrite L, R; cbn [is_in existsb] in O; apply orb_false_elim in O as [O1 O2]; apply orb_false_elim in O2 as [O2 _].
  rewrite O1, O2; reflexivity.
Qed.
Lemma eval_called known now f given m l v : look f known = Some m -> every (map (eval known now) given) = Some l -> m l = v ->
  eval known now (Called f given) = v.
Proof. intros F G <-; cbn [eval]; rewrite F, G; reflexivity. Qed.
Lemma every_more known now e given v l : eval known now e = Some v -> every (map (eval known now) given) = Some l ->
  every (map (eval known now) (e :: given)) = Some (v :: l).
Proof. intros E G; cbn [map every]; rewrite E, G; reflexivity. Qed.

Lemma provided_is {A} c (v : A) : c = true -> provided c v = Some v.
Proof. intros ->; reflexivity. Qed.

Ltac further := lazymatch goal with |- ?text = ?answer => let v := value text in change (v = answer) end.

(** An equation that lia does not see. *)
Inductive apart (P : Prop) : Prop := Apart (p : P).
Ltac set_apart H := apply Apart in H.
Ltac bounds := repeat match goal with H : ?P |- _ => lazymatch P with _ <= _ => fail | _ < _ => fail | _ /\ _ => fail | Z => fail | _ => clear H end end; lia.

Ltac defined := repeat (first [rewrite in_int_is by bounds | rewrite counted_is by (cbn [width]; bounds)
  | rewrite provided_is by (apply Z.leb_le; bounds) | rewrite provided_is by reflexivity]; further).

(** The two macros. *)
Theorem max_text a c : called functions of_words [] "HC_MAX_OF" [Of Int a; Of Int c] = Some (Of Int (Z.max a c)).
Proof.
  unfold called; function "HC_MAX_OF"; further; unfold carry; destruct (Z.ltb_spec c a); cbv iota; [rewrite Z.max_l | rewrite Z.max_r]; lia || reflexivity.
Qed.
Theorem min_text a c : called functions of_words [] "HC_MIN_OF" [Of Int a; Of Int c] = Some (Of Int (Z.min a c)).
Proof.
  unfold called; function "HC_MIN_OF"; further; unfold carry; destruct (Z.ltb_spec a c); cbv iota; [rewrite Z.min_l | rewrite Z.min_r]; lia || reflexivity.
Qed.

Theorem whole_text m e : 0 <= m < 2 ^ 53 ->
  called functions of_words [] "hc_fixed_whole" [Rec [("sign", Of Int 1); ("exponent", Of Int e); ("mantissa", Of U64 m)]] = Some (Fix (whole m)).
Proof.
  intros M; unfold called; function "hc_fixed_whole"; further; rewrite counted_is by (cbn [width]; lia); further.
  unfold whole; rewrite Z.mod_small by (unfold W; lia); reflexivity.
Qed.

Definition ints f (given : list datum) := match given with [Of Int a; Of Int c] => Some (Of Int (f a c)) | _ => None end.
Definition known := (of_words ++ [parts_of; ("HC_MAX_OF", ints Z.max); ("HC_MIN_OF", ints Z.min);
  ("hc_fixed_whole", fun given => match given with [Rec [_; _; (_, Of U64 m)]] => Some (Fix (whole m)) | _ => None end)])%list.


(** One statement: its value, where what C leaves undefined does not happen, by the name that the equations have for it. *)
Ltac named_by_equation := repeat match goal with
  | H : apart (?v = ?value) |- Some (_ ?value) = _ => let E := fresh in pose proof H as [E]; rewrite <- E; clear E end.
Ltac computes := further; defined; named_by_equation; reflexivity.
Ltac evaluates := lazymatch goal with
  | |- eval _ _ (Infix _ _ _) = _ => eapply eval_infix; [reflexivity | evaluates | evaluates | computes]
  | |- eval _ _ (Called _ _) = _ => eapply eval_called; [further; reflexivity | evaluate_all | computes]
  | |- eval _ _ _ = _ => computes end
with evaluate_all := lazymatch goal with
  | |- every (map _ (_ :: _)) = _ => eapply every_more; [evaluates | evaluate_all]
  | |- every (map _ []) = _ => reflexivity end.
Ltac statement := erewrite go_put; [| vm_compute; reflexivity | evaluates | further; reflexivity];
  cbv [bound app map fst snd append].

Ltac begins n := unfold called, puts; function n; cbv beta iota;
  match goal with |- context [bound_all ?a ?b ?c] => let v := value (bound_all a b c) in change (bound_all a b c) with v end; cbv iota beta;
  cbn [does]; change steps with 100%nat.

(** All statements, and what is returned or put. *)
Ltac runs_through := repeat statement; lazymatch goal with |- context [go _ _ _ _ (Set_ _ _ _ :: _)] => fail "a statement is left" | _ => further; defined; reflexivity end.
(** The equations of printed steps. *)
Ltac equations F := repeat match type of F with
  | Forall _ (_ :: _) => let E := fresh "E" in pose proof (Forall_inv F) as E; apply Forall_inv_tail in F;
    cbv [is_computed number_of call_of look arguments operation name String.eqb Ascii.eqb Bool.eqb] in E end; clear F.

(** ** The terms. *)

Definition lengths := ["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"].

Section Terms.

(** A length is a whole number of 53 bits times 2^(power - 1075); 0 has a power below all others. *)
Variables m e : string -> Z.
Definition row := Rec (map (fun p => (fst p, Double (m (snd p)) (e (snd p)))) (combine ["0"; "1"; "2"; "3"; "4"; "5"; "6"] lengths)).
Hypothesis Powers : forall n, In n lengths -> -4096 <= e n <= 2046.

Variables (num : string -> number) (shift : string -> Z).
Variables radial axial small_p small_q small_s small_t small by_q by_t : Z.
Hypotheses (Eradial : radial = Z.max (Z.max (e "alpha") (e "b")) (Z.max (e "x") (e "y")))
  (Eaxial : axial = Z.max (Z.max (e "gamma") (e "d")) (e "z"))
  (Ep : small_p = 2 * (radial - e "alpha")) (Eq : small_q = 2 * (radial - e "b")) (Es : small_s = 2 * (axial - e "gamma"))
  (Et : small_t = 2 * (axial - e "d")) (Esmall : small = Z.min small_q small_t) (Eby_q : by_q = small_q - small) (Eby_t : by_t = small_t - small).
(** The numbers before the printed steps, and n2 after them. *)
Hypotheses (Wp : num "whole_p" = whole (Z.abs (m "alpha"))) (Wq : num "whole_q" = whole (Z.abs (m "b")))
  (Ws : num "whole_s" = whole (Z.abs (m "gamma"))) (Wt : num "whole_t" = whole (Z.abs (m "d")))
  (Np : num "p" = shifted_down (num "whole_p") small_p) (Nq : num "q" = shifted_down (num "whole_q") small_q)
  (Ns : num "s" = shifted_down (num "whole_s") small_s) (Nt : num "t" = shifted_down (num "whole_t") small_t)
  (Nx : num "xx" = shifted_down (whole (Z.abs (m "x"))) (2 * (radial - e "x"))) (Ny : num "yy" = shifted_down (whole (Z.abs (m "y"))) (2 * (radial - e "y")))
  (NS : num "S" = shifted_down (whole (Z.abs (m "z"))) (2 * (axial - e "z")))
  (N2 : num "n2" = minus (shifted_down (num "radial_2") by_t) (shifted_down (num "axial_2") by_q)).
Hypothesis Steps : Forall (is_computed shift num) C_terms.

Definition terms_fields := [("top_ps", Of Int (0 - small_p - small_s)); ("top_N", Of Int (0 - small_q - small_t)); ("small", Of Int small);
  ("by_t", Of Int by_t); ("by_q", Of Int by_q); ("n2", Fix (num "n2")); ("ps", Fix (num "ps")); ("n1", Fix (num "n1")); ("N", Fix (num "N"));
  ("whole_t", Fix (num "whole_t")); ("whole_q", Fix (num "whole_q")); ("R", Fix (num "R")); ("S", Fix (num "S")); ("t", Fix (num "t"));
  ("s", Fix (num "s")); ("q", Fix (num "q")); ("p", Fix (num "p"))].

Theorem terms_text : called functions known [] "hc_fixed_terms_of" [row] = Some (Rec terms_fields).
Proof.
  pose proof (Powers "alpha" ltac:(cbn; tauto)); pose proof (Powers "gamma" ltac:(cbn; tauto)); pose proof (Powers "b" ltac:(cbn; tauto));
    pose proof (Powers "d" ltac:(cbn; tauto)); pose proof (Powers "x" ltac:(cbn; tauto)); pose proof (Powers "y" ltac:(cbn; tauto));
    pose proof (Powers "z" ltac:(cbn; tauto)).
  unfold C_terms in Steps; equations Steps.
  assert (bounds : -4096 <= radial <= 2046 /\ e "alpha" <= radial /\ e "b" <= radial /\ e "x" <= radial /\ e "y" <= radial) by (clear - H H1 H3 H4 Eradial; lia).
  assert (bounds' : -4096 <= axial <= 2046 /\ e "gamma" <= axial /\ e "d" <= axial /\ e "z" <= axial) by (clear - H0 H2 H5 Eaxial; lia).
  assert (small_bounds : 0 <= small_p <= 12284 /\ 0 <= small_q <= 12284 /\ 0 <= small_s <= 12284 /\ 0 <= small_t <= 12284)
    by (clear - H H0 H1 H2 bounds bounds' Ep Eq Es Et; lia).
  assert (shared : 0 <= small <= 12284 /\ small <= small_q /\ small <= small_t) by (clear - small_bounds Esmall; lia).
  assert (apart_bounds : 0 <= by_q <= 12284 /\ 0 <= by_t <= 12284) by (clear - small_bounds shared Eby_q Eby_t; lia).
  repeat match goal with E : _ = _ |- _ => set_apart E end.
  begins "hc_fixed_terms_of"; runs_through.
Qed.

End Terms.

