(** The functions of the header that read the bits of doubles: Coq reads their text and runs it on the 64 bits of a double.

    A double is given as its bits, a word, which memcpy copies. Its sign, power and fraction are those of IEEE 754. What
    hc_fixed_parts_of makes of it, hc_parts_of and hc_valid, is proved for every word. As in ShiftRuns.v the compiler's own count of
    zeros, here of those below the lowest bit, is trusted. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed Long Limbs LimbsRuns ShiftRuns Trees StageThreeRuns.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** ** The text. *)

(** Words up to a semicolon, and behind it; up to the brace that closes a block. *)
Fixpoint until_semicolon (ws : list string) : list string * list string := match ws with
  | [] => ([], []) | w :: rest => if is ";" w then ([], rest) else let (l, last) := until_semicolon rest in (w :: l, last) end.
Fixpoint until_closed (deep : nat) (ws : list string) : list string * list string := match ws with
  | [] => ([], [])
  | w :: rest => match (if is "{" w then S deep else if is "}" w then pred deep else deep) with
    | O => ([], rest) | S k => let (l, last) := until_closed (S k) rest in (w :: l, last) end end.

(** "a += e;" is "a = a + (e);", memcpy copies the bits of a double, and a loop a fixed number of times is written out. *)
Definition changing := [(["+="], "+"); (["-="], "-"); (["|"; "="], "|"); (["<<"; "="], "<<"); ([">>"; "="], ">>")].
Fixpoint changed_by (l : list (list string * string)) (ws : list string) : option (string * list string) := match l with
  | [] => None
  | (shape, o) :: others => match behind shape ws with Some (_, rest) => Some (o, rest) | None => changed_by others ws end end.
Definition counts_of (n : string) := try z <- Steps.whole n 0; if z <=? Z.of_nat (List.length places) then Some (map snd (firstn (Z.to_nat z) places)) else None.
Fixpoint plainer (fuel : nat) (ws : list string) : list string := match fuel, ws with
  | S f, w :: rest => match behind ["memcpy"; "("; ""; ","; ""] ws, behind loop ws, changed_by changing rest with
    | Some ([x; a], more), _, _ => match behind [","; "sizeof"; ""; ")"] more, behind ["+"; ""; ","; "sizeof"; ""; ")"] more with
      | Some ([y], last), _ => if is x y then (x :: "=" :: "bits_of" :: "(" :: a :: ")" :: plainer f last)%list else ws
      | _, Some ([i; y], last) => if is x y then (x :: "=" :: "bits_of" :: "(" :: a :: "[" :: i :: "]" :: ")" :: plainer f last)%list else ws
      | _, _ => ws end
    | _, Some ([i; i'; n; i''], inner), _ => let (l, last) := until_closed 1 inner in
      match counts_of n with
      | Some turns => if is i i' && is i i'' then (flat_map (fun k => i :: "=" :: k :: ";" :: plainer f l) turns ++ plainer f last)%list else ws
      | None => ws end
    | _, _, Some (o, more) => let (e, last) := until_semicolon more in (w :: "=" :: w :: o :: "(" :: e ++ ")" :: ";" :: plainer f last)%list
    | _, _, _ => w :: plainer f rest end
  | _, _ => ws end.
Definition reading_of (text : string) : option (string * deciding) := let ws := tidy (words text) in
  match without_storage (plainer (List.length ws) ws) with
  | _ :: n :: "(" :: rest => try (p, inner) <- parameters_named rest ""; try (l, last) <- trees_of (List.length inner) inner;
    match last with [] => Some (n, Deciding p l) | _ => None end
  | _ => None end.

Definition texts := map (fun text => reading_of (string_of text)) HeaderText.of_doubles.
Definition readings := Eval vm_compute in match every texts with Some l => l | None => [] end.
Theorem texts_are_read : texts = map Some readings.
Proof. vm_cast_no_check (eq_refl (map Some readings)). Qed.

(** ** What a double is. *)

(** The zeros below the lowest bit of a number other than 0. *)
Fixpoint zeros_of p := match p with xO q => 1 + zeros_of q | _ => 0 end.
Definition lowest m := match m with Z0 => 0 | Zpos p | Zneg p => zeros_of p end.

Definition sign_bit w := w / 2 ^ 63.
Definition exponent_bits w := w / 2 ^ 52 mod 2 ^ 11.
Definition fraction w := w mod 2 ^ 52.
(** A double is so many units of 2^(power - 1075): 53 bits and a sign, or 0. *)
Definition zeros_above w := 52 - Z.log2 (fraction w).
Definition size_of w := if exponent_bits w =? 0 then if fraction w =? 0 then 0 else fraction w * 2 ^ zeros_above w else fraction w + 2 ^ 52.
Definition whole_of w := if sign_bit w =? 0 then size_of w else - size_of w.
Definition power_of w := if exponent_bits w =? 0 then if fraction w =? 0 then -4096 else 1 - zeros_above w else exponent_bits w.

(** As the bits have it, without the shift of a subnormal number. *)
Definition raw_size w := if exponent_bits w =? 0 then fraction w else fraction w + 2 ^ 52.
Definition raw_power w := if exponent_bits w =? 0 then 1 else exponent_bits w.

Lemma zeros_positive p : 0 <= zeros_of p.
Proof. induction p; cbn [zeros_of]; lia. Qed.
Lemma lowest_divides m : m <> 0 -> 0 <= lowest m /\ (2 ^ lowest m | m).
Proof.
  assert (P : forall p, (2 ^ zeros_of p | Zpos p)).
  { induction p as [p _ | p IH |]; cbn [zeros_of]; try apply Z.divide_1_l; rewrite Z.pow_add_r by (pose proof (zeros_positive p); lia).
    change (Zpos (xO p)) with (2 * Zpos p); apply Z.mul_divide_mono_l; exact IH. }
  intros N; destruct m as [| p | p]; [congruence | |]; cbn [lowest]; (split; [apply zeros_positive |]); [apply P |].
  change (Zneg p) with (- Zpos p); apply Z.divide_opp_r, P.
Qed.
Lemma lowest_opp m : lowest (- m) = lowest m.
Proof. destruct m; reflexivity. Qed.
Lemma lowest_shifted m k : 0 <= k -> m <> 0 -> lowest (m * 2 ^ k) = lowest m + k.
Proof.
  intros K N; pattern k; apply natlike_ind; [rewrite Z.mul_1_r; ring | | exact K]; clear k K; intros k K IH.
  rewrite Z.pow_succ_r by exact K; replace (m * (2 * 2 ^ k)) with (2 * (m * 2 ^ k)) by ring.
  assert (m * 2 ^ k <> 0) by (pose proof (Z.pow_pos_nonneg 2 k ltac:(lia) K); nia).
  revert IH H; generalize (m * 2 ^ k); intros [| p | p] IH H; [congruence | |]; cbn [lowest zeros_of Z.mul Pos.mul] in *; lia.
Qed.

(** ** The runs. *)

Definition known : list (string * (list datum -> option datum)) := [
  ("bits_of", fun given => match given with [Of U64 a] => Some (Of U64 a) | _ => None end);
  ("hc_lowest_bit", fun given => match given with [Of U64 a] => unless_zero a (Some (Of Int (lowest a))) | _ => None end);
  ("hc_highest_bit", fun given => match given with [Of U64 a] => unless_zero a (Some (Of Int (Z.log2 a))) | _ => None end)].
Definition returned n (given : list datum) : option datum := try f <- look n readings;
  try now <- bound_all (map Named (takes f)) given []; try (v, _) <- go known [] steps now (does f); v.
(** The parts that are returned, each once. *)
Definition parts_in v := match v with
  | Some (Rec l) => match look "sign" l, look "exponent" l, look "mantissa" l with
    | Some (Of Int s), Some (Of Int e), Some (Of U64 a) => Some (s, e, a) | _, _, _ => None end
  | _ => None end.

Lemma exponent_is w : Z.land (w / 2 ^ 52) 2047 = exponent_bits w.
Proof. change 2047 with (Z.ones 11); apply Z.land_ones; discriminate. Qed.
Lemma fraction_is w : Z.land w 4503599627370495 = fraction w.
Proof. change 4503599627370495 with (Z.ones 52); apply Z.land_ones; discriminate. Qed.

Lemma go_decided f now c yes no rest t z : eval known now c = Some (Of t z) ->
  go known [] (S f) now (If c yes no :: rest) = go known [] f now ((if z =? 0 then no else yes) ++ rest)%list.
Proof. intros E; cbn [go]; rewrite E; reflexivity. Qed.
Lemma go_returned f now e rest v : eval known now e = Some v -> go known [] (S f) now (Returns e :: rest) = Some (Some v, now).
Proof. intros E; cbn [go]; rewrite E; reflexivity. Qed.

Ltac open text := eval cbv -[Z.land Z.lor Z.eqb Z.add Z.sub Z.mul Z.div Z.modulo Z.pow Z.log2 in_int counted lowest raw_size raw_power exponent_bits fraction sign_bit zeros_above W unless_zero] in text.
Ltac opened := lazymatch goal with |- ?l = ?r => let v := open l in change (v = r) end.
(** What is defined and what does not leave its type. *)
Lemma mod_small a : 0 <= a < W -> a mod W = a.
Proof. exact (Z.mod_small a W). Qed.
Ltac eqbs := repeat match goal with
  | |- context [Z.eqb 1 0] => change (1 =? 0) with false | |- context [Z.eqb 0 0] => change (0 =? 0) with true
  | |- context [Z.eqb 2047 2047] => change (2047 =? 2047) with true
  | H : ?a = ?b |- context [Z.eqb ?a ?b] => rewrite (proj2 (Z.eqb_eq a b) H) | H : ?a <> ?b |- context [Z.eqb ?a ?b] => rewrite (proj2 (Z.eqb_neq a b) H) end.
Ltac evaluated := opened; repeat (first [rewrite exponent_is | rewrite fraction_is | lazymatch goal with |- context [?a / 2 ^ 63] => change (a / 2 ^ 63) with (sign_bit a) end | progress eqbs | rewrite in_int_is by lia | rewrite not_zero_is by assumption
  | rewrite counted_is by (cbn [width]; lia) | rewrite mod_small by (unfold W; lia)]; opened); reflexivity.
Ltac next := eqbs; cbv iota; cbn [app]; match goal with
  | |- context [go _ _ _ _ (Set_ _ _ _ :: _)] => erewrite go_put; [| reflexivity | evaluated | reflexivity]; cbv [bound app map fst snd append]
  | |- context [go _ _ _ _ (If _ _ _ :: _)] => erewrite go_decided; [| evaluated]
  | |- context [go _ _ _ _ (Returns _ :: _)] => erewrite go_returned; [| evaluated] end.
Ltac starts n := unfold returned; lazymatch goal with |- context [look n readings] => let f := eval vm_compute in (look n readings) in change (look n readings) with f end;
  cbv beta iota delta [takes does map bound_all bound]; change steps with 100%nat.

Section Word.
Variable w : Z.
Hypothesis Word : is_word w.

Lemma parts_bounded : (sign_bit w = 0 \/ sign_bit w = 1) /\ 0 <= exponent_bits w < 2 ^ 11 /\ 0 <= fraction w < 2 ^ 52.
Proof.
  unfold sign_bit, exponent_bits, fraction; split; [| split; apply Z.mod_pos_bound; reflexivity].
  assert (0 <= w / 2 ^ 63 < 2) by (destruct Word; split; [apply Z.div_pos | apply Z.div_lt_upper_bound]; unfold W in *; lia); lia.
Qed.
Lemma fraction_size : fraction w <> 0 -> 2 ^ Z.log2 (fraction w) <= fraction w < 2 ^ (Z.log2 (fraction w) + 1) /\ 0 <= Z.log2 (fraction w) < 52.
Proof.
  destruct parts_bounded as (_ & _ & F); intros N; pose proof (Z.log2_spec (fraction w) ltac:(lia)) as L; split; [exact L |].
  split; [apply Z.log2_nonneg | apply Z.log2_lt_pow2; lia].
Qed.
(** A subnormal number has 53 bits after the shift. *)
Lemma shifted_size : fraction w <> 0 -> 1 <= zeros_above w <= 52 /\ 2 ^ 52 <= fraction w * 2 ^ zeros_above w < 2 ^ 53.
Proof.
  intros N; destruct (fraction_size N) as [[A C] L]; unfold zeros_above; set (l := Z.log2 (fraction w)) in *; split; [lia |].
  pose proof (Z.pow_pos_nonneg 2 (52 - l) ltac:(lia) ltac:(lia)) as P.
  assert (E : 2 ^ l * 2 ^ (52 - l) = 2 ^ 52) by (rewrite <- Z.pow_add_r by lia; f_equal; lia).
  assert (E' : 2 ^ (l + 1) * 2 ^ (52 - l) = 2 ^ 53) by (rewrite <- Z.pow_add_r by lia; f_equal; lia); rewrite <- E, <- E'; nia.
Qed.

(** ** The parts. *)

Lemma leading_is : (1 mod W * 2 ^ 52) mod W = 2 ^ 52.
Proof. reflexivity. Qed.
Lemma mantissa_is : Z.lor (fraction w) (2 ^ 52) = fraction w + 2 ^ 52.
Proof. rewrite Z.lor_comm; rewrite <- (Z.mul_1_l (2 ^ 52)) at 1; rewrite lor_is by (try apply parts_bounded; lia); ring. Qed.
Lemma absolute : Z.abs (whole_of w) = size_of w.
Proof.
  assert (0 <= size_of w).
  { unfold size_of; destruct parts_bounded as (_ & _ & F); destruct (exponent_bits w =? 0), (Z.eqb_spec (fraction w) 0); try lia; destruct (shifted_size n); lia. }
  unfold whole_of; destruct (sign_bit w =? 0); lia.
Qed.

(** As stage 3 asks for the parts of a double: 53 bits and a power. *)
Theorem fixed_parts_text : parts_in (returned "hc_fixed_parts_of" [Of U64 w]) = Some (1, power_of w, Z.abs (whole_of w)).
Proof.
  destruct parts_bounded as (_ & E & F); rewrite absolute; starts "hc_fixed_parts_of"; next; rewrite leading_is; do 4 next.
  next; unfold size_of, power_of; destruct (Z.eqb_spec (exponent_bits w) 0) as [E0 | E1].
  - next; destruct (Z.eqb_spec (fraction w) 0) as [F0 | F1].
    + do 2 next; cbn [parts_in look String.eqb Ascii.eqb Bool.eqb]; rewrite F0; reflexivity.
    + destruct (shifted_size F1) as [K M]; destruct (fraction_size F1) as [_ L].
      next; change (52 - Z.log2 (fraction w)) with (zeros_above w); do 3 next; reflexivity.
  - next; rewrite mantissa_is; next; reflexivity.
Qed.

(** As stage 5 asks for them: an odd number and a power of two. *)
Definition odd_power m e := if m =? 0 then 2048 else e - 1075 + lowest m.
Definition odd_part m := Z.abs m / 2 ^ lowest m.
Lemma size_zero : size_of w = 0 <-> exponent_bits w = 0 /\ fraction w = 0.
Proof.
  unfold size_of; destruct parts_bounded as (_ & E & F); destruct (Z.eqb_spec (exponent_bits w) 0), (Z.eqb_spec (fraction w) 0); try lia.
  destruct (shifted_size n); lia.
Qed.
Lemma sign_is : Z.sgn (whole_of w) = if size_of w =? 0 then 0 else if sign_bit w =? 0 then 1 else -1.
Proof.
  pose proof absolute as A; unfold whole_of in *; destruct (Z.eqb_spec (size_of w) 0) as [-> |]; [destruct (sign_bit w =? 0); reflexivity |].
  destruct (sign_bit w =? 0); lia.
Qed.
Lemma odd_is : raw_size w <> 0 -> 0 <= lowest (raw_size w) < 53 /\ 0 < raw_size w < 2 ^ 53 /\ size_of w <> 0
  /\ odd_power (whole_of w) (power_of w) = raw_power w - 1075 + lowest (raw_size w) /\ odd_part (whole_of w) = raw_size w / 2 ^ lowest (raw_size w).
Proof.
  intros N; assert (lowest_abs : lowest (whole_of w) = lowest (size_of w)) by (unfold whole_of; destruct (sign_bit w =? 0); [reflexivity | apply lowest_opp]).
  destruct parts_bounded as (_ & E & F); assert (B : 0 < raw_size w < 2 ^ 53) by (unfold raw_size in *; destruct (exponent_bits w =? 0); lia).
  destruct (lowest_divides _ N) as [L D]; assert (U : lowest (raw_size w) < 53).
  { apply Z.pow_lt_mono_r_iff with 2; [lia | lia |]; apply Z.divide_pos_le in D; lia. }
  assert (Z0 : size_of w <> 0) by (rewrite size_zero; unfold raw_size in N; destruct (Z.eqb_spec (exponent_bits w) 0); lia).
  split; [lia |]; split; [exact B |]; split; [exact Z0 |]; unfold odd_power, odd_part; rewrite absolute, lowest_abs.
  destruct (Z.eqb_spec (whole_of w) 0) as [W0 | _]; [pose proof absolute as A; rewrite W0 in A; cbn in A; lia |].
  unfold size_of, power_of, raw_size, raw_power in *; destruct (Z.eqb_spec (exponent_bits w) 0) as [E0 | E1]; [| split; reflexivity].
  destruct (Z.eqb_spec (fraction w) 0) as [F0 | F1]; [lia |]; destruct (shifted_size F1) as [K _].
  rewrite lowest_shifted by lia; split; [ring |]; rewrite Z.pow_add_r by lia; apply Z.div_mul_cancel_r; apply Z.pow_nonzero; lia.
Qed.

Theorem parts_text : parts_in (returned "hc_parts_of" [Of U64 w]) =
  Some (Z.sgn (whole_of w), odd_power (whole_of w) (power_of w), odd_part (whole_of w)).
Proof.
  destruct parts_bounded as (S & E & F); starts "hc_parts_of"; do 2 next.
  assert (R : exponent_bits w = 0 /\ raw_size w = fraction w /\ raw_power w = 1 \/ exponent_bits w <> 0 /\ raw_size w = fraction w + 2 ^ 52 /\ raw_power w = exponent_bits w).
  { unfold raw_size, raw_power; destruct (Z.eqb_spec (exponent_bits w) 0); [left | right]; auto. }
  assert (zero : raw_size w = 0 -> Some (0, 2048, raw_size w) = Some (Z.sgn (whole_of w), odd_power (whole_of w) (power_of w), odd_part (whole_of w))).
  { intros N; assert (Z0 : size_of w = 0) by (apply size_zero; unfold raw_size in N; destruct (Z.eqb_spec (exponent_bits w) 0); lia).
    assert (W0 : whole_of w = 0) by (unfold whole_of; rewrite Z0; destruct (sign_bit w =? 0); reflexivity); rewrite W0, N; reflexivity. }
  rewrite (go_put _ _ _ _ "" "parts.mantissa" _ _ (Of U64 (raw_size w)) (Of U64 (raw_size w))); [| reflexivity | | reflexivity].
  2: { destruct R as [(E0 & R & _) | (E1 & R & _)]; rewrite R; opened; rewrite fraction_is; eqbs; opened; [rewrite Z.lor_0_r; reflexivity |].
    rewrite counted_is by (cbn [width]; lia); opened; rewrite leading_is, mantissa_is; reflexivity. }
  cbn [bound]; rewrite (go_put _ _ _ _ "" "parts.exponent" _ _ (Of Int (raw_power w - 1075)) (Of Int (raw_power w - 1075))); [| reflexivity | | reflexivity].
  2: { destruct R as [(E0 & _ & R) | (E1 & _ & R)]; rewrite R; evaluated. }
  assert (P : 1 <= raw_power w < 2 ^ 11) by (destruct R as [(E0 & _ & ->) | (E1 & _ & ->)]; lia); clear R.
  cbn [bound]; destruct (Z.eq_dec (raw_size w) 0) as [N | N]; [do 5 next; exact (zero N) |]; clear zero.
  destruct (odd_is N) as (L & B & Z0 & -> & ->); rewrite sign_is; destruct (Z.eq_dec (sign_bit w) 0) as [S0 | S1]; do 7 next; reflexivity.
Qed.

(** What is read of a double fits, whatever its bits are. *)
Lemma size_bounded : 0 <= size_of w < 2 ^ 53 /\ (size_of w <> 0 -> 2 ^ 52 <= size_of w).
Proof.
  destruct parts_bounded as (_ & E & F); unfold size_of; destruct (exponent_bits w =? 0); [| lia]; destruct (Z.eqb_spec (fraction w) 0) as [| N]; [lia |].
  destruct (shifted_size N); lia.
Qed.
Lemma power_bounded : exponent_bits w <> 2047 -> -4096 <= power_of w <= 2046.
Proof.
  intros N; destruct parts_bounded as (_ & E & F); unfold power_of; destruct (exponent_bits w =? 0); [| lia]; destruct (Z.eqb_spec (fraction w) 0) as [| F1]; [lia |].
  destruct (shifted_size F1); lia.
Qed.
Lemma multiple : whole_of w <> 0 -> 1 <= power_of w + lowest (whole_of w).
Proof.
  intros N; assert (R : raw_size w <> 0).
  { intros R; apply N; assert (Z0 : size_of w = 0) by (apply size_zero; destruct parts_bounded as (_ & E & F); unfold raw_size in R; destruct (Z.eqb_spec (exponent_bits w) 0); lia).
    unfold whole_of; rewrite Z0; destruct (sign_bit w =? 0); reflexivity. }
  destruct (odd_is R) as (L & _ & _ & P & _); destruct parts_bounded as (_ & E & _).
  unfold odd_power in P; rewrite (proj2 (Z.eqb_neq _ _) N) in P; unfold raw_power in P; destruct (Z.eqb_spec (exponent_bits w) 0); lia.
Qed.
Lemma positive_size : sign_bit w = 0 -> w <> 0 -> 2 ^ 52 <= whole_of w < 2 ^ 53.
Proof.
  intros S N; unfold whole_of; rewrite S; change (0 =? 0) with true; cbv iota; destruct size_bounded as [B1 B2]; split; [| lia]; apply B2; intros Z0; apply size_zero in Z0 as [E F].
  apply N; unfold sign_bit, exponent_bits, fraction in *.
  pose proof (Z.div_mod w (2 ^ 52) ltac:(discriminate)) as D; pose proof (Z.div_mod (w / 2 ^ 52) (2 ^ 11) ltac:(discriminate)) as D'.
  rewrite Z.div_div in D' by (discriminate || reflexivity); change (2 ^ 52 * 2 ^ 11) with (2 ^ 63) in D'; rewrite S, E in D'; lia.
Qed.
End Word.

(** ** A valid row: seven finite doubles, of which the four sizes are positive. *)

Definition valid_word k a := negb (exponent_bits a =? 2047) && ((4 <=? k) || (sign_bit a =? 0) && negb (a =? 0)).
Definition of_row := combine [0; 1; 2; 3; 4; 5; 6] StageThreeRuns.lengths.
Definition is_valid (w : string -> Z) := forallb (fun p => valid_word (fst p) (w (snd p))) of_row.
Definition words_of (w : string -> Z) := Rec (combine (map snd places) (map (fun n => Of U64 (w n)) StageThreeRuns.lengths)).

(** One turn of the loop. *)
Definition turn k := let exponent := Infix "&" (Infix ">>" (Named "bits") (Constant Int 52)) (Constant U32 2047) in [
  Set_ "" "i" (Constant Int k); Set_ "" "bits" (Called "bits_of" [Part (Named "row") (Named "i")]);
  If (Infix "==" exponent (Constant U32 2047)) [Returns (Constant Int 0)] [];
  If (Infix "&&" (Infix "<" (Named "i") (Constant Int 4)) (Infix "||" (Infix ">>" (Named "bits") (Constant Int 63)) (Infix "==" (Named "bits") (Constant Int 0))))
    [Returns (Constant Int 0)] []].
Theorem turns_are_read : look "hc_valid" readings = Some (Deciding ["row"] (flat_map turn [0; 1; 2; 3; 4; 5; 6] ++ [Returns (Constant Int 1)])).
Proof. reflexivity. Qed.

Lemma both_is now l r (x y : bool) : eval known now l = Some (Of Int (if x then 1 else 0)) -> eval known now r = Some (Of Int (if y then 0 else 1)) ->
  eval known now (Infix "&&" l r) = Some (Of Int (if x && negb y then 1 else 0)).
Proof. intros E F; cbn [eval]; rewrite E; destruct x; [rewrite F; destruct y |]; reflexivity. Qed.
Definition value_in {A} (o : option (option datum * A)) := try (v, _) <- o; v.
Lemma turn_runs f now k a rest : eval known (("i", Of Int k) :: now) (Part (Named "row") (Named "i")) = Some (Of U64 a) ->
  value_in (go known [] (5 + f) now (turn k ++ rest)%list) =
  if valid_word k a then value_in (go known [] (S f) (("bits", Of U64 a) :: ("i", Of Int k) :: now) rest) else Some (Of Int 0).
Proof.
  intros A; unfold turn, valid_word, value_in; cbn [app Nat.add]; rewrite Z.leb_antisym, <- (negb_involutive (_ || _)), negb_orb, negb_involutive.
  rewrite (go_put _ _ _ _ "" "i" _ _ (Of Int k) (Of Int k)) by reflexivity; cbn [bound].
  rewrite (go_put _ _ _ _ "" "bits" _ _ (Of U64 a) (Of U64 a)); [| reflexivity | eapply eval_called with (l := [Of U64 a]); [reflexivity | cbn [map every]; rewrite A; reflexivity | reflexivity] | reflexivity].
  cbn [bound]; destruct (Z.eq_dec (exponent_bits a) 2047) as [? | ?]; next; [next; eqbs; reflexivity |]; eqbs; cbn [negb andb].
  assert (C : eval known (("bits", Of U64 a) :: ("i", Of Int k) :: now) (Infix "<" (Named "i") (Constant Int 4)) = Some (Of Int (if k <? 4 then 1 else 0))) by reflexivity.
  assert (D : eval known (("bits", Of U64 a) :: ("i", Of Int k) :: now) (Infix "||" (Infix ">>" (Named "bits") (Constant Int 63)) (Infix "==" (Named "bits") (Constant Int 0))) =
    Some (Of Int (if (sign_bit a =? 0) && negb (a =? 0) then 0 else 1))).
  { destruct (Z.eq_dec (sign_bit a) 0) as [? | ?]; [destruct (Z.eq_dec a 0) as [? | ?] |]; evaluated. }
  cbn [app]; rewrite (go_decided _ _ _ _ _ _ _ _ (both_is _ _ _ _ _ C D)); destruct ((k <? 4) && negb ((sign_bit a =? 0) && negb (a =? 0))); reflexivity.
Qed.
Lemma row_turns f now k a ks rest : eval known (("i", Of Int k) :: now) (Part (Named "row") (Named "i")) = Some (Of U64 a) ->
  value_in (go known [] (5 + f) now (flat_map turn (k :: ks) ++ rest)%list) =
  if valid_word k a then value_in (go known [] (S f) (("bits", Of U64 a) :: ("i", Of Int k) :: now) (flat_map turn ks ++ rest)%list) else Some (Of Int 0).
Proof. intros A; cbn [flat_map]; rewrite <- app_assoc; apply turn_runs; exact A. Qed.

Lemma returned_is n f given now : look n readings = Some f -> bound_all (map Named (takes f)) given [] = Some now ->
  returned n given = value_in (go known [] steps now (does f)).
Proof. intros L N; unfold returned, value_in; rewrite L, N; reflexivity. Qed.

Theorem valid_text w : returned "hc_valid" [words_of w] = Some (Of Int (if is_valid w then 1 else 0)).
Proof.
  assert (E : bound_all [Named "row"] [words_of w] [] = Some [("row.0", Of U64 (w "alpha")); ("row.1", Of U64 (w "gamma")); ("row.2", Of U64 (w "b"));
    ("row.3", Of U64 (w "d")); ("row.4", Of U64 (w "x")); ("row.5", Of U64 (w "y")); ("row.6", Of U64 (w "z"))]) by reflexivity.
  rewrite (returned_is "hc_valid" _ _ _ turns_are_read E); unfold is_valid, of_row, StageThreeRuns.lengths; cbn [combine forallb fst snd does].
  replace steps with (5 + 95)%nat by reflexivity.
  Ltac one a f := rewrite (row_turns f _ _ a) by reflexivity; destruct (valid_word _ a); [cbn [andb] | reflexivity].
  one (w "alpha") 95%nat; change 96%nat with (5 + 91)%nat; one (w "gamma") 91%nat; change 92%nat with (5 + 87)%nat; one (w "b") 87%nat; change 88%nat with (5 + 83)%nat; one (w "d") 83%nat;
    change 84%nat with (5 + 79)%nat; one (w "x") 79%nat; change 80%nat with (5 + 75)%nat; one (w "y") 75%nat; change 76%nat with (5 + 71)%nat; one (w "z") 71%nat; reflexivity.
Qed.

(** What stages 3 and 5 ask for of a valid row. *)
Section Row.
Variable w : string -> Z.
Hypotheses (Words : forall n, In n StageThreeRuns.lengths -> is_word (w n)) (Valid : is_valid w = true).
Let m n := whole_of (w n).
Let e n := power_of (w n).

Lemma valid_word_is k a : valid_word k a = true -> exponent_bits a <> 2047 /\ (k < 4 -> sign_bit a = 0 /\ a <> 0).
Proof.
  unfold valid_word; destruct (Z.eqb_spec (exponent_bits a) 2047), (Z.leb_spec 4 k), (Z.eqb_spec (sign_bit a) 0), (Z.eqb_spec a 0); try discriminate; intros _; split; auto; lia.
Qed.
Lemma valid_words n : In n StageThreeRuns.lengths -> exponent_bits (w n) <> 2047 /\ (In n ["alpha"; "gamma"; "b"; "d"] -> sign_bit (w n) = 0 /\ w n <> 0).
Proof.
  intros I; unfold is_valid in Valid; rewrite forallb_forall in Valid.
  assert (V : exists k, valid_word k (w n) = true /\ (In n ["alpha"; "gamma"; "b"; "d"] -> k < 4)).
  { assert (J : exists k, In (k, n) of_row /\ (In n ["alpha"; "gamma"; "b"; "d"] -> k < 4)).
    { destruct I as [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]; eexists; (split; [cbv; tauto |]); cbn [In]; first [reflexivity | intros [D | [D | [D | [D | []]]]]; discriminate]. }
    destruct J as (k & J & K); exists k; split; [exact (Valid _ J) | exact K]. }
  destruct V as (k & V & K); apply valid_word_is in V as [V1 V2]; auto.
Qed.

Theorem valid_row : (forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 2 ^ 52 <= m n < 2 ^ 53) /\ (forall n, In n ["x"; "y"; "z"] -> Z.abs (m n) < 2 ^ 53)
  /\ (forall n, In n StageThreeRuns.lengths -> -4096 <= e n <= 2046) /\ (forall n, In n StageThreeRuns.lengths -> m n <> 0 -> 1 <= e n + lowest (m n)).
Proof.
  split; [| split; [| split]]; intros n I.
  - assert (J : In n StageThreeRuns.lengths) by (destruct I as [<- | [<- | [<- | [<- | []]]]]; cbv; tauto); destruct (valid_words n J) as [_ V]; destruct (V I).
    apply positive_size; auto.
  - assert (J : In n StageThreeRuns.lengths) by (destruct I as [<- | [<- | [<- | []]]]; cbv; tauto); unfold m; rewrite absolute by auto; apply size_bounded; auto.
  - apply power_bounded; [auto | apply valid_words; exact I].
  - intros N; apply multiple; auto.
Qed.
End Row.
