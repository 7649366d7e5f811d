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
Proof. vm_cast_no_check (eq_refl (map Some functions)). Qed.

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

(** A condition that is true or false. *)
Definition bit (b : bool) := if b then 1 else 0.

(** What is left to run, and what is to be shown of its end: statements are taken off one after another, and never copied. *)
Section Ends.
Variables (known : list (string * (list datum -> option datum))) (procedures : list (string * (nat * (list datum -> option (list datum))))).
Variable Post : option (option datum * environment) -> Prop.
Definition ends f now l := Post (go known procedures f now l).
Lemma put_ends f now t n e rest v w now' : is_new t n now = true -> eval known now e = Some v -> held t v = Some w -> bound n w now = now' ->
  ends f now' rest -> ends (S f) now (Set_ t n e :: rest).
Proof. intros N E H B; unfold ends; cbn [go]; rewrite N, E, H, B; exact (fun P => P). Qed.
Lemma if_ends f now c yes no rest x : eval known now c = Some (Of Int (bit x)) -> (x = true -> ends f now (yes ++ rest)%list) ->
  (x = false -> ends f now (no ++ rest)%list) -> ends (S f) now (If c yes no :: rest).
Proof. intros E Y N; unfold ends; cbn [go]; rewrite E; destruct x; [apply Y | apply N]; reflexivity. Qed.
Lemma calling_ends f now g given rest k m l got now' : look g procedures = Some (k, m) -> every (map (eval known now) (firstn k given)) = Some l ->
  m l = Some got -> bound_all (skipn k given) got now = Some now' -> ends f now' rest -> ends (S f) now (Calling g given :: rest).
Proof. intros K L M B; unfold ends; cbn [go]; rewrite K, L, M, B; exact (fun P => P). Qed.
Lemma return_ends f now e rest v : eval known now e = Some v -> Post (Some (Some v, now)) -> ends (S f) now (Returns e :: rest).
Proof. intros E; unfold ends; cbn [go]; rewrite E; exact (fun P => P). Qed.
End Ends.

Lemma eval_infix known now o l r t x u y v : is_in o ["&&"; "||"] = false -> eval known now l = Some (Of t x) -> eval known now r = Some (Of u y) ->
  plain_infix o t x u y = v -> eval known now (Infix o l r) = v.
Proof.
  intros O L R <-; cbn [eval]; rewrite L, R; cbn [is_in existsb] in O; apply orb_false_elim in O as [O1 O2]; apply orb_false_elim in O2 as [O2 _].
  rewrite O1, O2; reflexivity.
Qed.
Lemma eval_called known now f given m l v : look f known = Some m -> every (map (eval known now) given) = Some l -> m l = v ->
  eval known now (Called f given) = v.
Proof. intros F G <-; cbn [eval]; rewrite F, G; reflexivity. Qed.

Lemma provided_is {A} c (v : A) : c = true -> provided c v = Some v.
Proof. intros ->; reflexivity. Qed.

Ltac further := lazymatch goal with |- ?text = ?answer => let v := value text in change (v = answer) end.

(** By inequalities alone: lia would read every equation. *)
Ltac bounds := repeat match goal with H : ?P |- _ => lazymatch P with _ <= _ => fail | _ < _ => fail | _ /\ _ => fail | Z => fail | _ => clear H end end;
  lia.

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

(** ** A function that puts one value after another. *)

(** What it does is known when each value is: they are asked for all at once, each in the variables that stand before it. *)

Section Straight.
Variable known : list (string * (list datum -> option datum)).
Fixpoint asked_values now (l : list tree) (values : list datum) : list (option datum * datum) := match l, values with
  | Set_ t n e :: rest, w :: values' => (try v <- eval known now e; held t v, w) :: asked_values (bound n w now) rest values' | _, _ => [] end.
Fixpoint after now (l : list tree) (values : list datum) : environment := match l, values with
  | Set_ t n e :: rest, w :: values' => after (bound n w now) rest values' | _, _ => now end.
Fixpoint all_new now (l : list tree) (values : list datum) := match l, values with
  | Set_ t n e :: rest, w :: values' => is_new t n now && all_new (bound n w now) rest values' | [], [] => true | _, _ => false end.
Definition is_asked (p : option datum * datum) := fst p = Some (snd p).

Lemma go_straight procedures f rest l : forall now values, all_new now l values = true -> Forall is_asked (asked_values now l values) ->
  go known procedures (List.length l + f) now (l ++ rest)%list = go known procedures f (after now l values) rest.
Proof.
  induction l as [| s l IH]; intros now [| w values] N F; [reflexivity | discriminate | destruct s; discriminate |]; destruct s; try discriminate.
  match goal with |- context [Set_ ?a ?b ?c :: l] => rename a into t, b into n, c into e end.
  cbn [all_new asked_values] in N, F; apply andb_prop in N as [N1 N2]; pose proof (Forall_inv F) as E; apply Forall_inv_tail in F.
  unfold is_asked in E; cbn [fst snd] in E; cbn [List.length Nat.add app after]; destruct (eval known now e) as [v |] eqn:V; [| discriminate].
  rewrite (go_put known procedures _ now t n e _ v w N1 V E); apply IH; assumption.
Qed.

Variables (functions : list (string * deciding)) (procedures : list (string * (nat * (list datum -> option (list datum))))).
Variables (n : string) (given : list datum) (f : deciding) (l : list tree) (now : environment) (values : list datum).
Hypotheses (Text : look n functions = Some f) (Begin : bound_all (map Named (firstn (List.length given) (takes f))) given constants = Some now)
  (Short : (List.length l <= 98)%nat) (New : all_new now l values = true) (Asked : Forall is_asked (asked_values now l values)).
Theorem straight_called e v : does f = (l ++ [Returns e])%list -> eval known (after now l values) e = Some v ->
  called functions known procedures n given = Some v.
Proof.
  intros D E; unfold called; rewrite Text, Begin, D; replace steps with (List.length l + S (99 - List.length l))%nat by (unfold steps; lia).
  rewrite (go_straight procedures _ _ l now values New Asked); cbn [go]; rewrite E; reflexivity.
Qed.
Theorem straight_puts k : does f = l -> every (map (fun p => look p (after now l values)) (skipn (List.length given) (takes f))) = Some k ->
  puts functions known procedures n given = Some k.
Proof.
  intros D E; unfold puts; rewrite Text, Begin, D, <- (app_nil_r l) at 1.
  replace steps with (List.length l + S (99 - List.length l))%nat by (unfold steps; lia).
  rewrite (go_straight procedures _ _ l now values New Asked); cbn [go]; exact E.
Qed.
End Straight.

(** The values by the names that the equations have for them: whole numbers, and numbers of words. *)
Definition field_of n := match index 0 "." n with Some k => substring (S k) (String.length n) n | None => n end.
Definition values_of (given : list (string * datum)) (num : string -> number) (l : list tree) : list datum :=
  flat_map (fun s => match s with
    | Set_ _ n _ => [match look (field_of n) given with Some v => v | None => Fix (num (field_of n)) end] | _ => [] end) l.

(** Operators of ints, where they stay in their range. *)
Lemma int_sum a c : - 2 ^ 31 <= a + c < 2 ^ 31 -> plain_infix "+" Int a Int c = Some (Of Int (a + c)).
Proof. intros B; cbn -[in_int Z.pow]; rewrite in_int_is by exact B; reflexivity. Qed.
Lemma int_difference a c : - 2 ^ 31 <= a - c < 2 ^ 31 -> plain_infix "-" Int a Int c = Some (Of Int (a - c)).
Proof. intros B; cbn -[in_int Z.pow]; rewrite in_int_is by exact B; reflexivity. Qed.
Lemma int_product a c : - 2 ^ 31 <= a * c < 2 ^ 31 -> plain_infix "*" Int a Int c = Some (Of Int (a * c)).
Proof. intros B; unfold plain_infix; cbn -[in_int Z.pow Z.mul]; rewrite in_int_is by exact B; reflexivity. Qed.
Lemma int_quotient a c : c <> 0 -> - 2 ^ 31 <= Z.quot a c < 2 ^ 31 -> plain_infix "/" Int a Int c = Some (Of Int (Z.quot a c)).
Proof. intros N B; unfold plain_infix; cbn -[in_int Z.pow]; rewrite (proj2 (Z.eqb_neq c 0) N), in_int_is by exact B; reflexivity. Qed.

(** Evaluation but for the operators. *)
Ltac partly text := eval cbv -[plain_infix Z.leb Z.land Z.lor Z.lxor Z.add Z.sub Z.mul Z.div Z.modulo Z.pow Z.quot Z.max Z.min Z.abs carry same in_int
  counted provided bounded bits_of sign_of sign_int said most_grown W bits128 plus minus product signed_product both_signed_product square full
  shifted_up shifted_down times_of whole called puts] in text.
Ltac part := lazymatch goal with |- ?text = ?answer => let v := partly text in change (v = answer) end.
(** One value: what C leaves undefined does not happen, and the equations have it. *)
Ltac in_range := lazymatch goal with
  | |- context [plain_infix "+" Int ?a Int ?c] => rewrite (int_sum a c) by bounds
  | |- context [plain_infix "-" Int ?a Int ?c] => rewrite (int_difference a c) by bounds
  | |- context [plain_infix "*" Int ?a Int ?c] => rewrite (int_product a c) by bounds
  | |- context [plain_infix "/" Int ?a Int ?c] => rewrite (int_quotient a c) by (discriminate || bounds)
  | |- context [counted ?t ?k ?v] => rewrite (counted_is t k v) by (cbn [width]; bounds)
  | |- context [provided ?c ?v] => rewrite (provided_is c v) by (reflexivity || (apply Z.leb_le; bounds)) end.
Ltac one_value := unfold is_asked; cbn [fst snd]; repeat (in_range; part);
  first [reflexivity | match goal with H : ?v = ?value |- Some (_ ?value) = Some (_ ?v) => rewrite H; reflexivity end].
Ltac all_values := lazymatch goal with |- Forall is_asked ?l => let v := partly l in change (Forall is_asked v) end;
  repeat (apply Forall_cons; [one_value |]); apply Forall_nil.
Ltac text_of n l := lazymatch eval vm_compute in (look n l) with Some ?f => f end.
(** A function that returns a value, or puts some, after statements that put values; the table has those that are no numbers of words. *)
Ltac returns_straight table num := lazymatch goal with |- called ?functions _ _ ?name _ = _ => let text := text_of name functions in
  let body := eval cbv [removelast does] in (removelast (does text)) in
  lazymatch eval cbv [last does] in (last (does text) (Returns (Named ""))) with Returns ?answer =>
    eapply straight_called with (f := text) (l := body) (values := values_of table num body) (e := answer);
      [vm_compute; reflexivity | part; reflexivity | apply Nat.leb_le; reflexivity | vm_compute; reflexivity | all_values | reflexivity
      | part; reflexivity] end end.
Ltac puts_straight table num := lazymatch goal with |- puts ?functions _ _ ?name _ = _ => let text := text_of name functions in
  let body := eval cbv [does] in (does text) in
  eapply straight_puts with (f := text) (l := body) (values := values_of table num body);
    [vm_compute; reflexivity | part; reflexivity | apply Nat.leb_le; reflexivity | vm_compute; reflexivity | all_values | reflexivity
    | part; reflexivity] end.

(** The text of a function, and what it begins with. *)
Ltac begins n := unfold called, puts; function n; cbv beta iota;
  match goal with |- context [bound_all ?a ?b ?c] => let v := value (bound_all a b c) in change (bound_all a b c) with v end; cbv iota beta;
  cbn [does]; change steps with 100%nat.
(** It as statements that are left. *)
Ltac begins_to_end n := begins n; lazymatch goal with |- context [go ?k ?p ?f ?now ?l] =>
  pattern (go k p f now l); lazymatch goal with |- ?Post _ => change (ends k p Post f now l) end end.

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

(** What the function puts that is no number of words. *)
Definition first_terms := (
  map (fun n => (n, Rec [("sign", Of Int 1); ("exponent", Of Int (e n)); ("mantissa", Of U64 (Z.abs (m n)))])) lengths
  ++ map (fun p => (fst p, Of Int (snd p))) [("radial", radial); ("axial", axial); ("small_p", small_p); ("small_q", small_q); ("small_s", small_s);
    ("small_t", small_t); ("small", small); ("by_q", by_q); ("by_t", by_t); ("top_N", 0 - small_q - small_t); ("top_ps", 0 - small_p - small_s)])%list.

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
  returns_straight first_terms num.
Qed.

End Terms.

