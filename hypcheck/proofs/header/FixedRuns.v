(** Stage 3, continued: the steps that Coq reads in the C, run on words, stay within the intervals that are computed for them.

    LimbsRuns.v proves that the functions of the header compute what is said of words here. *)

Require Import List String ZArith Reals Lra Lia Psatz Bool.
From Hypcheck Require Import Steps Fixed.
From Hypcheck Require Programs HeaderText Printed.
Import ListNotations.
Open Scope string_scope.
Open Scope list_scope.
Open Scope Z_scope.

Ltac numbers := change (bits128 / 2) with 170141183460469231731687303715884105728 in *;
  change bits128 with 340282366920938463463374607431768211456 in *; change (W / 2) with 9223372036854775808 in *;
  change W with 18446744073709551616 in *.

(** hc_fixed_negative, as a choice: the number where the other one is < 0, else 0 *)
Definition masked sign n := if W / 2 <=? high_word sign then n else Words 0 0.
Definition signed_product l r := minus (product l r) (masked l r).
Definition both_signed_product l r := minus (signed_product l r) (masked r l).
Definition size n := if W / 2 <=? high_word n then minus (Words 0 0) n else n.
Definition square n := let a := size n in let mixed := high_word a * low_word a / W in
  let full := high_word a * high_word a in let twice := (2 * mixed) mod W in let low := (full mod W + twice) mod W in
  Words low ((full / W + mixed / (W / 2) + carry low twice) mod W).

(** 128 bits stand for a whole number, signed or not. *)
Definition stands n k := is_number n /\ pattern n = k mod bits128.

Lemma word_mod k : 0 <= k mod W < W.
Proof. apply Z.mod_pos_bound; reflexivity. Qed.

Lemma plus_stands l r j k : stands l j -> stands r k -> stands (plus l r) (j + k).
Proof.
  intros [L EL] [R ER]; split; [split; apply word_mod |].
  rewrite plus_is_right, EL, ER by assumption; symmetry; apply Z.add_mod; discriminate.
Qed.
Lemma minus_stands l r j k : stands l j -> stands r k -> stands (minus l r) (j - k).
Proof.
  intros [L EL] [R ER]; split; [split; apply word_mod |].
  rewrite minus_is_right, EL, ER by assumption; symmetry; apply Zminus_mod.
Qed.

(** The number that the C takes 128 bits for, in two's complement. *)
Definition signed_value n := if W / 2 <=? high_word n then pattern n - bits128 else pattern n.

Definition fits r := if low r <? 0 then (- (bits128 / 2) <=? low r) && (high r <? bits128 / 2) else high r <? bits128.

Lemma pattern_range n : is_number n -> 0 <= pattern n < bits128.
Proof. intros [A B]; unfold pattern, bits128, W in *; lia. Qed.

Lemma pattern_of_unsigned n k : stands n k -> 0 <= k < bits128 -> pattern n = k.
Proof. intros [_ E] K; rewrite E; apply Z.mod_small; exact K. Qed.
Lemma pattern_of_negative n k : stands n k -> - (bits128 / 2) <= k < 0 -> pattern n = k + bits128.
Proof.
  intros [_ E] K; rewrite E; symmetry; apply Z.mod_unique with (-1); [left | ring].
  numbers; lia.
Qed.

Lemma signed_value_is n k : stands n k -> - (bits128 / 2) <= k < bits128 / 2 -> signed_value n = k.
Proof.
  intros S K; unfold signed_value; pose proof S as [[L H] _]; destruct (Z.lt_ge_cases k 0) as [N | N].
  - pose proof (pattern_of_negative n k S ltac:(lia)) as P; destruct (Z.leb_spec (W / 2) (high_word n)); unfold pattern in *; numbers; lia.
  - pose proof (pattern_of_unsigned n k S ltac:(numbers; lia)) as P; destruct (Z.leb_spec (W / 2) (high_word n)); unfold pattern in *; numbers; lia.
Qed.

(** The words of so many bits; hc_fixed_up and hc_fixed_down, products by powers of two, these rounded down. *)
Definition words_of m := Words (m mod W) (m / W).
Definition shifted_up n k := words_of ((pattern n * 2 ^ k) mod bits128).
Definition shifted_down n k := words_of ((signed_value n / 2 ^ k) mod bits128).

Lemma words_stand k : stands (words_of (k mod bits128)) k.
Proof.
  unfold stands, is_number, pattern, words_of; cbn [low_word high_word].
  assert (R : 0 <= k mod bits128 < bits128) by (apply Z.mod_pos_bound; reflexivity).
  set (m := k mod bits128) in *; clearbody m; pose proof (Z.div_mod m W ltac:(discriminate)).
  split; [split; [apply word_mod | split; [apply Z.div_pos; [lia | reflexivity] | apply Z.div_lt_upper_bound; [reflexivity | exact (proj2 R)]]] | lia].
Qed.
Lemma down_stands n k : stands (shifted_down n k) (signed_value n / 2 ^ k).
Proof. apply words_stand. Qed.

(** hc_fixed_sign: 1 or -1 for a number that is farther from 0 than the bound; -bound - 1 is taken for no farther. *)
Definition sign_of n bound : comparison := let v := signed_value n in if bound <? v then Gt else if v <? - bound - 1 then Lt else Eq.
(** hc_fixed_bits: those of the number, or of -1 less it, and 1 for none. *)
Definition bits_of n := let v := signed_value n in 1 + Z.log2 (if v <? 0 then - v - 1 else v).

Lemma masked_is_right n k m : stands n k -> - (bits128 / 2) <= k < bits128 / 2 ->
  masked n m = if k <? 0 then m else Words 0 0.
Proof.
  intros S K; unfold masked; pose proof S as [[L H] _].
  destruct (Z.ltb_spec k 0) as [N | N].
  - pose proof (pattern_of_negative n k S ltac:(lia)) as P; destruct (Z.leb_spec (W / 2) (high_word n)); [reflexivity |].
    unfold pattern in *; numbers; lia.
  - pose proof (pattern_of_unsigned n k S ltac:(numbers; lia)) as P.
    destruct (Z.leb_spec (W / 2) (high_word n)); [| reflexivity]; unfold pattern in *; numbers; lia.
Qed.

Lemma zero_stands : stands (Words 0 0) 0.
Proof. repeat split; try discriminate; reflexivity. Qed.

Lemma truncated_stands l r : is_number l -> is_number r -> stands (product l r) (truncated l r).
Proof.
  intros L R; split; [split; apply word_mod |]; rewrite product_is_right by assumption; symmetry; apply Z.mod_small.
  destruct (products l r L R) as (T0 & T1 & _); split; [exact T0 |].
  pose proof (pattern_range l L); pose proof (pattern_range r R).
  assert (pattern l * pattern r < bits128 * bits128) by (apply Z.mul_lt_mono_nonneg; lia).
  assert (0 < bits128) by reflexivity; nia.
Qed.

Lemma product_stands l r j k : stands l j -> stands r k -> 0 <= j < bits128 -> 0 <= k < bits128 ->
  exists p, stands (product l r) p /\ is_product j k p.
Proof.
  intros L R J K; exists (truncated l r); split; [apply truncated_stands; [apply L | apply R] |].
  destruct (products l r (proj1 L) (proj1 R)) as (T0 & T); rewrite (pattern_of_unsigned l j L J), (pattern_of_unsigned r k R K) in T.
  split; [exact T | intros; exact T0].
Qed.

Lemma signed_product_stands l r j k : stands l j -> stands r k -> - (bits128 / 2) <= j < bits128 / 2 -> 0 <= k < bits128 ->
  exists p, stands (signed_product l r) p /\ is_product j k p.
Proof.
  intros L R J K; unfold signed_product; rewrite (masked_is_right l j r L J).
  destruct (products l r (proj1 L) (proj1 R)) as (T0 & T); rewrite (pattern_of_unsigned r k R K) in T.
  destruct (Z.ltb_spec j 0) as [N | N].
  - rewrite (pattern_of_negative l j L ltac:(lia)) in T; exists (truncated l r - k); split.
    + apply minus_stands; [apply truncated_stands; [apply L | apply R] | exact R].
    + unfold is_product; split; [unfold cut; lia | lia].
  - rewrite (pattern_of_unsigned l j L ltac:(numbers; lia)) in T; exists (truncated l r - 0); split.
    + apply minus_stands; [apply truncated_stands; [apply L | apply R] | exact zero_stands].
    + unfold is_product, cut; split; lia.
Qed.

Lemma both_signed_product_stands l r j k : stands l j -> stands r k -> - (bits128 / 2) <= j < bits128 / 2 ->
  - (bits128 / 2) <= k < bits128 / 2 -> exists p, stands (both_signed_product l r) p /\ is_product j k p.
Proof.
  intros L R J K; unfold both_signed_product; rewrite (masked_is_right r k l R K); destruct (Z.ltb_spec k 0) as [N | N].
  - assert (R' : stands r (k + bits128)).
    { split; [apply R |]; rewrite (proj2 R); rewrite <- (Z.mul_1_l bits128) at 2; symmetry; apply Z_mod_plus_full. }
    destruct (signed_product_stands l r j (k + bits128) L R' J ltac:(numbers; lia)) as (p & P & Q1 & Q2).
    exists (p - j); split; [apply minus_stands; assumption |].
    unfold is_product, cut in *; split; [lia | intros; lia].
  - destruct (signed_product_stands l r j k L R J ltac:(numbers; lia)) as (p & P & Q).
    exists (p - 0); split; [apply minus_stands; [assumption | exact zero_stands] |].
    rewrite Z.sub_0_r; exact Q.
Qed.

Lemma square_stands n k : stands n k -> - (bits128 / 2) <= k < bits128 / 2 ->
  exists p, stands (square n) p /\ is_product k k p.
Proof.
  intros N K; set (a := size n).
  assert (A : stands a (Z.abs k)).
  { unfold a, size; pose proof (masked_is_right n k (Words 1 0) N K) as M; unfold masked in M.
    destruct (W / 2 <=? high_word n); destruct (Z.ltb_spec k 0); try discriminate M.
    - replace (Z.abs k) with (0 - k) by lia; apply minus_stands; [exact zero_stands | exact N].
    - replace (Z.abs k) with k by lia; exact N. }
  assert (KA : 0 <= Z.abs k <= bits128 / 2) by lia.
  pose proof (pattern_of_unsigned a (Z.abs k) A ltac:(numbers; lia)) as P.
  destruct A as [[A0 A1] _]; unfold pattern in P.
  set (h := high_word a) in *; set (l := low_word a) in *.
  assert (hl : 0 <= h * l) by (apply Z.mul_nonneg_nonneg; lia); assert (hh : 0 <= h * h) by (apply Z.mul_nonneg_nonneg; lia).
  assert (ll : 0 <= l * l) by (apply Z.mul_nonneg_nonneg; lia).
  assert (ll' : l * l < W * W) by (apply Z.mul_lt_mono_nonneg; lia).
  set (m := h * l / W).
  assert (M : 0 <= m /\ W * m <= h * l < W * (m + 1)).
  { unfold m; repeat split; [apply Z.div_pos; [assumption | reflexivity] | apply Z.mul_div_le; reflexivity |].
    replace (h * l / W + 1) with (Z.succ (h * l / W)) by lia; apply Z.mul_succ_div_gt; reflexivity. }
  exists (h * h + 2 * m).
  assert (S : Z.abs k * Z.abs k = h * h * (W * W) + 2 * (W * (h * l)) + l * l) by (rewrite <- P; ring).
  assert (KK : k * k = Z.abs k * Z.abs k) by (destruct (Z.abs_spec k) as [[_ ->] | [_ ->]]; ring).
  assert (KM : Z.abs k * Z.abs k <= bits128 / 2 * (bits128 / 2)) by (apply Z.mul_le_mono_nonneg; lia).
  assert (T : h * h + 2 * m < bits128).
  { rewrite S in KM; numbers; lia. }
  split.
  - split; [split; apply word_mod |]; rewrite Z.mod_small by lia.
    unfold square; fold a h l m; unfold pattern, carry; cbn [low_word high_word].
    set (f := h * h) in *; clearbody f m; clear - hh M T; numbers.
    match goal with |- context [if ?x <? ?y then _ else _] => destruct (Z.ltb_spec x y) end; euclid; lia.
  - unfold is_product, cut; split; [rewrite KK, S; numbers; lia | lia].
Qed.

(** ** The run of a list of steps. [num] are the words, [x] the exact values that they stand for. *)

Section Run.

(** [shift] are the bits by which numbers are moved, by the name that the C gives them. *)
Variables (num : string -> number) (x : string -> R) (shift : string -> Z).

Definition halves (a b : string) := (x a * x b / IZR bits128)%R.

(** The call of C, with its arguments. *)
Inductive call := Plus (a c : string) | Minus (a c : string) | Times (k : Z) (a : string) | Product (a c : string)
  | Signed (a c : string) | BothSigned (a c : string) | Square (a : string) | Moved (by_name a c : string) | Other.

Definition call_of (s : step) := match look (operation s) [("hc_fixed_plus", Plus); ("hc_fixed_minus", Minus);
    ("hc_fixed_product", Product); ("hc_fixed_signed_product", Signed); ("hc_fixed_both_signed_product", BothSigned);
    ("hc_fixed_product by_t", Moved "by_t"); ("hc_fixed_product by_q", Moved "by_q")], arguments s with
  | Some f, [Name a; Name c] => f a c
  | None, [Name a] => if String.eqb (operation s) "hc_fixed_square" then Square a else Other
  | None, [Number k; Name a] => if String.eqb (operation s) "hc_fixed_times" then Times k a else Other
  | _, _ => Other end.

Definition runs (s : step) : Prop := let n := name s in match call_of s with
  | Plus a c => num n = plus (num a) (num c) /\ x n = (x a + x c)%R
  | Minus a c => num n = minus (num a) (num c) /\ x n = (x a - x c)%R
  | Times k a => is_number (num n) /\ pattern (num n) = (k * pattern (num a)) mod bits128 /\ x n = (IZR k * x a)%R
  | Product a c => num n = product (num a) (num c) /\ x n = halves a c
  | Signed a c => num n = signed_product (num a) (num c) /\ x n = halves a c
  | BothSigned a c => num n = both_signed_product (num a) (num c) /\ x n = halves a c
  | Square a => num n = square (num a) /\ x n = halves a a
  | Moved by_name a c => let k := shift by_name in 0 <= k /\ num n = shifted_down (product (num a) (num c)) k
    /\ x n = (halves a c / IZR (2 ^ k))%R
  | Other => False end.

Definition with_two known a c (f : range -> range -> option range) := match look a known, look c known with
  | Some r, Some q => f r q | _, _ => None end.
Definition provided (c : bool) (r : range) := if c then Some r else None.

(** A product for numbers that are never negative is asked for such numbers alone, and likewise the others. *)
Definition range_of known (s : step) : option range := match call_of s with
  | Plus a c => with_two known a c (fun r q => Some (sum r q))
  | Minus a c => with_two known a c (fun r q => Some (sum r (negative q)))
  | Times k a => with_two known a a (fun r _ => provided (0 <=? k) (times k r))
  | Product a c => with_two known a c (fun r q => provided ((0 <=? low r) && (0 <=? low q)) (times_range r q))
  | Signed a c => with_two known a c (fun r q => provided ((low r <? 0) && (0 <=? low q)) (times_range r q))
  | BothSigned a c => with_two known a c (fun r q => provided ((low r <? 0) && (low q <? 0)) (times_range r q))
  | Square a => with_two known a a (fun r _ => provided (low r <? 0) (times_range r r))
  | Moved _ a c => with_two known a c (fun r q =>
      provided ((0 <=? low r) && (0 <=? low q) && (high (times_range r q) <? bits128 / 2)) (moved_down (times_range r q)))
  | Other => None end.

Fixpoint ranges known (l : list step) : option (list (string * range)) := match l with
  | [] => Some known
  | s :: rest => match range_of known s with
    | Some r => if fits r then ranges ((name s, r) :: known) rest else None | None => None end end.

Definition holds n r := exists k, stands (num n) k /\ within r k (x n) /\ fits r = true.
Definition all_hold known := forall n r, look n known = Some r -> holds n r.

Lemma fits_signed r k v : fits r = true -> low r < 0 -> within r k v -> - (bits128 / 2) <= k < bits128 / 2.
Proof.
  unfold fits; intros F N [I _]; destruct (Z.ltb_spec (low r) 0); [| lia].
  apply andb_prop in F; destruct F as [F1 F2]; apply Z.leb_le in F1; apply Z.ltb_lt in F2; lia.
Qed.
Lemma fits_unsigned r k v : fits r = true -> 0 <= low r -> within r k v -> 0 <= k < bits128.
Proof.
  unfold fits; intros F N [I _]; destruct (Z.ltb_spec (low r) 0); [lia |]; apply Z.ltb_lt in F; lia.
Qed.

Lemma two known a c f r : all_hold known -> with_two known a c f = Some r ->
  exists p q, holds a p /\ holds c q /\ f p q = Some r.
Proof.
  unfold with_two; intros K E; destruct (look a known) eqn:A; [| discriminate]; destruct (look c known) eqn:C; [| discriminate].
  apply K in A; apply K in C; eauto.
Qed.
Lemma provided_is c p r : provided c p = Some r -> c = true /\ p = r.
Proof. destruct c; [| discriminate]; intros E; injection E; auto. Qed.

Lemma step_holds known s r : all_hold known -> runs s -> range_of known s = Some r -> fits r = true -> holds (name s) r.
Proof.
  intros K R E F; unfold runs, range_of in R, E; destruct (call_of s) as [a c | a c | m a | a c | a c | a c | a | m a c |];
    try contradiction; apply two in E; try exact K; destruct E as (p & q & (v & S & I & G) & (w & T & J & H) & E);
    try (apply provided_is in E; destruct E as [C E]; repeat (apply andb_prop in C as [C ?])); try injection E as E; subst r;
    repeat match goal with X : (0 <=? _) = true |- _ => apply Z.leb_le in X | X : (_ <? 0) = true |- _ => apply Z.ltb_lt in X end.
  - destruct R as [RN RX]; exists (v + w); unfold holds; rewrite RN, RX; split; [apply plus_stands; assumption |].
    split; [apply sum_within |]; assumption.
  - destruct R as [RN RX]; exists (v - w); rewrite RN, RX; split; [apply minus_stands; assumption |].
    split; [apply (sum_within p (negative q) v (- w) (x a) (- x c)); [| apply negative_within] |]; assumption.
  - destruct R as (RN & RP & RX); exists (m * v); rewrite RX; split; [| split; [apply times_within |]; assumption].
    split; [exact RN |]; rewrite RP, (proj2 S); apply Z.mul_mod_idemp_r; discriminate.
  - destruct R as [RN RX]; destruct (product_stands (num a) (num c) v w S T) as (k & U & V);
      [apply (fits_unsigned p v (x a)) | apply (fits_unsigned q w (x c)) |]; try assumption.
    exists k; rewrite RN, RX; split; [exact U | split; [apply product_within with v w |]; assumption].
  - destruct R as [RN RX]; destruct (signed_product_stands (num a) (num c) v w S T) as (k & U & V);
      [apply (fits_signed p v (x a)) | apply (fits_unsigned q w (x c)) |]; try assumption.
    exists k; rewrite RN, RX; split; [exact U | split; [apply product_within with v w |]; assumption].
  - destruct R as [RN RX]; destruct (both_signed_product_stands (num a) (num c) v w S T) as (k & U & V);
      [apply (fits_signed p v (x a)) | apply (fits_signed q w (x c)) |]; try assumption.
    exists k; rewrite RN, RX; split; [exact U | split; [apply product_within with v w |]; assumption].
  - destruct R as [RN RX]; destruct (square_stands (num a) v S) as (k & U & V); [apply (fits_signed p v (x a)); assumption |].
    exists k; rewrite RN, RX; split; [exact U | split; [apply product_within with v v |]; assumption].
  - set (k := shift m) in R; destruct R as (K0 & RN & RX); destruct (product_stands (num a) (num c) v w S T) as (t & U & V);
      [apply (fits_unsigned p v (x a)) | apply (fits_unsigned q w (x c)) |]; try assumption.
    assert (TI : within (times_range p q) t (halves a c)) by (apply product_within with v w; assumption).
    assert (T0 : 0 <= t).
    { destruct V as [_ V]; apply V; destruct I as [I _]; destruct J as [J _]; lia. }
    assert (TP : 0 <= t < bits128 / 2).
    { split; [exact T0 |]; destruct TI as [[_ TI] _]; match goal with X : (_ <? bits128 / 2) = true |- _ => apply Z.ltb_lt in X; lia end. }
    exists (t / 2 ^ k); rewrite RX; split; [| split; [apply moved_within |]; assumption].
    rewrite RN, <- (signed_value_is _ t U ltac:(numbers; lia)); apply down_stands.
Qed.

Theorem ranges_hold l : forall known found, all_hold known -> Forall runs l -> ranges known l = Some found -> all_hold found.
Proof.
  induction l as [| s l IH]; cbn [ranges]; intros known found K R E; [injection E as <-; exact K |].
  inversion R; subst; destruct (range_of known s) eqn:G; [| discriminate]; destruct (fits r) eqn:F; [| discriminate].
  apply (IH ((name s, r) :: known)); try assumption.
  intros n q L; cbn [look] in L; destruct (String.eqb_spec (name s) n) as [<- | N]; [injection L as <- | apply K; exact L].
  apply step_holds with known; assumption.
Qed.

End Run.

(** ** The bounds of the header. *)

Definition part n := match nth_error HeaderText.parts n with Some (_, t) => match declarations t with Some l => l | None => [] end | None => [] end.
Definition C_terms := Eval vm_compute in part 1.
Definition C_discriminant := Eval vm_compute in part 2.
Definition C_at_B := Eval vm_compute in part 3.
Definition C_at_A := Eval vm_compute in part 4.
Theorem steps_are_read : [C_terms; C_discriminant; C_at_B; C_at_A] = map part [1; 2; 3; 4]%nat.
Proof. vm_compute; reflexivity. Qed.

(** Squares of lengths are below 1 in units of 2^-126, and at most one unit of them is cut; what is whole is 1/4 at least. *)
Definition longest := (2 ^ 53 - 1) ^ 2 * 2 ^ 20.
Definition squares : list (string * range) := map (fun n => (n, Range 0 longest (-1) 0)) ["p"; "q"; "s"; "t"; "xx"; "yy"; "S"]
  ++ map (fun n => (n, Range (2 ^ 124) longest 0 0)) ["whole_p"; "whole_q"; "whole_s"; "whole_t"].

Definition found known l n := match ranges known l with Some t => look n t | None => None end.
Definition none := Range 1 0 0 0.
Definition sure r := match r with Some q => q | None => none end.

Definition term n := sure (found squares C_terms n).
(** n2 is radial_2 moved down less axial_2 moved down. *)
Definition n2_range := sum (moved_down (term "radial_2")) (negative (moved_down (term "axial_2"))).

Definition error r := Z.max (- under r) (over r).

Definition poles := ("n2", n2_range) :: ("R", term "R") :: squares.

(** Balanced: below 2^125 in size; N and ps are doubled, n2 and n1 moved up by 2^grown at most. *)
Definition balanced_range r factor := Range (if low r <? 0 then - 2 ^ 125 else 0) (2 ^ 125) (factor * under r - 1) (factor * over r).
Definition balanced grown := [("N", balanced_range (term "N") 2); ("ps", balanced_range (term "ps") 2);
  ("n2", balanced_range n2_range (2 ^ grown)); ("n1", balanced_range (term "n1") (2 ^ grown))].

(** What the header says, by name: HC_fixed_coefficient, HC_fixed_pole, HC_fixed_delta, HC_fixed_middle. *)
Definition said n := match look n HeaderText.fixed_bounds with Some k => k | None => -1 end.
Definition most_grown := match look "most_grown" HeaderText.fixed_bounds with Some k => k | None => 0 end.

Definition covers bounds known := forallb (fun p => match look (fst p) known with
  | Some r => (low r <? 0) && (error r <=? snd p) | None => false end) bounds.
Definition covered known l bounds := match ranges known l with Some t => covers bounds t | None => false end.
Definition all_grown := map Z.of_nat (seq 0 (S (Z.to_nat most_grown))).

Theorem header_covers_coefficients : (error n2_range <=? said "coefficient") && (error (term "n1") <=? said "coefficient") = true.
Proof. vm_compute; reflexivity. Qed.
Theorem header_covers_poles : covered poles C_at_B (map (fun n => (n, said "pole")) ["offset_at_B"; "slope_at_B"])
  && covered poles C_at_A (map (fun n => (n, said "pole")) ["offset_at_A"; "slope_at_A"]) = true.
Proof. vm_compute; reflexivity. Qed.
Theorem header_covers_cubic : forallb (fun g => covered (balanced g) C_discriminant
  [("delta", said "delta" * 2 ^ g); ("middle", said "middle" * 2 ^ g)]) all_grown = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

(** A number farther from 0 than its bound has the sign of the exact value. *)
Lemma covered_sign num x shift known l bounds n bound : all_hold num x known -> Forall (runs num x shift) l -> covered known l bounds = true ->
  In (n, bound) bounds -> let v := signed_value (num n) in (bound < v -> (0 < x n)%R) /\ (v < - bound -> (x n < 0)%R).
Proof.
  unfold covered, covers; intros K R C IN; destruct (ranges known l) as [t |] eqn:E; [| discriminate].
  rewrite forallb_forall in C; specialize (C _ IN); cbn [fst snd] in C.
  destruct (look n t) as [r |] eqn:L; [| discriminate]; apply andb_prop in C as [C0 C]; apply Z.ltb_lt in C0; apply Z.leb_le in C; unfold error in C.
  destruct (ranges_hold num x shift l known t K R E n r L) as (v & S & I & F); cbv zeta.
  rewrite (signed_value_is (num n) v S (fits_signed r v (x n) F C0 I)); destruct I as [_ [I1 I2]].
  assert (U : (- IZR bound <= IZR (under r))%R) by (rewrite <- opp_IZR; apply IZR_le; lia).
  assert (O : (IZR (over r) <= IZR bound)%R) by (apply IZR_le; lia).
  split; intros H; apply IZR_lt in H; [| rewrite opp_IZR in H]; lra.
Qed.

Lemma at_every_move f : forallb f all_grown = true -> forall g, 0 <= g <= most_grown -> f g = true.
Proof.
  intros H g G; rewrite forallb_forall in H; apply H; unfold all_grown; rewrite <- (Z2Nat.id g) by apply G.
  apply in_map, in_seq; split; [apply Nat.le_0_l |]; apply le_n_S, Z2Nat.inj_le; [apply G | apply Z.le_trans with g; apply G | apply G].
Qed.

Theorem sign_of_delta num x shift grown : 0 <= grown <= most_grown -> all_hold num x (balanced grown) ->
  Forall (runs num x shift) C_discriminant -> let v := signed_value (num "delta") in
    (said "delta" * 2 ^ grown < v -> (0 < x "delta")%R) /\ (v < - (said "delta" * 2 ^ grown) -> (x "delta" < 0)%R).
Proof.
  intros G K R; pose proof (at_every_move _ header_covers_cubic grown G) as C; cbv beta in C.
  exact (covered_sign num x shift (balanced grown) C_discriminant _ "delta" _ K R C (or_introl eq_refl)).
Qed.

Theorem sign_of_middle num x shift grown : 0 <= grown <= most_grown -> all_hold num x (balanced grown) ->
  Forall (runs num x shift) C_discriminant -> let v := signed_value (num "middle") in
    (said "middle" * 2 ^ grown < v -> (0 < x "middle")%R) /\ (v < - (said "middle" * 2 ^ grown) -> (x "middle" < 0)%R).
Proof.
  intros G K R; pose proof (at_every_move _ header_covers_cubic grown G) as C; cbv beta in C.
  exact (covered_sign num x shift (balanced grown) C_discriminant _ "middle" _ K R C (or_intror (or_introl eq_refl))).
Qed.

Theorem signs_at_the_poles num x shift l n : (l = C_at_B /\ In n ["offset_at_B"; "slope_at_B"])
  \/ (l = C_at_A /\ In n ["offset_at_A"; "slope_at_A"]) -> all_hold num x poles -> Forall (runs num x shift) l ->
  let v := signed_value (num n) in (said "pole" < v -> (0 < x n)%R) /\ (v < - said "pole" -> (x n < 0)%R).
Proof.
  intros L K R; pose proof header_covers_poles as H; apply andb_prop in H; destruct H as [H1 H2].
  destruct L as [[-> I] | [-> I]]; destruct I as [<- | [<- | []]].
  - exact (covered_sign num x shift poles C_at_B _ _ _ K R H1 (or_introl eq_refl)).
  - exact (covered_sign num x shift poles C_at_B _ _ _ K R H1 (or_intror (or_introl eq_refl))).
  - exact (covered_sign num x shift poles C_at_A _ _ _ K R H2 (or_introl eq_refl)).
  - exact (covered_sign num x shift poles C_at_A _ _ _ K R H2 (or_intror (or_introl eq_refl))).
Qed.
