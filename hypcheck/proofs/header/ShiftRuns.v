(** The functions of the header that shift numbers of two words, count their bits and ask for their sign are those that the other
    files speak of: products by powers of two, rounded down, and comparisons with a bound. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed Long Limbs FixedRuns LimbsRuns.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** Their text. *)
Definition functions := Eval vm_compute in
  match every (map (fun text => function_of true (string_of text)) HeaderText.functions) with Some l => l | None => [] end.

(** What they call: __builtin_clzll counts the zeros before the highest bit of a word that is not 0, as compilers say. *)
Definition models := (LimbsRuns.models ++ [("__builtin_clzll", OfBits (fun a => 63 - Z.log2 a)); ("hc_highest_bit", OfBits Z.log2);
  ("hc_fixed_up", OfShift shifted_up)])%list.
Definition called n given := try f <- look n functions; result models f given.

Ltac value text := eval cbv -[Z.add Z.sub Z.mul Z.div Z.modulo Z.pow Z.land Z.lor Z.lxor Z.log2 carry same chosen counted unless_zero in_int
  W bits128 negative plus shifted_up long_pattern] in text.
(** A little further, where something was found out. *)
Ltac further := lazymatch goal with |- ?text = ?answer => let v := value text in change (v = answer) end.
Ltac text_called := unfold called; lazymatch goal with |- context [look ?n ?l] => let f := eval vm_compute in (look n l) in change (look n l) with f end.
Ltac run := text_called; further.

Lemma in_int_is z : - 2 ^ 31 <= z < 2 ^ 31 -> in_int z = true.
Proof. intros [L H]; unfold in_int; apply andb_true_intro; split; [apply Z.leb_le | apply Z.ltb_lt]; assumption. Qed.
Lemma counted_is {A} t k (z : option A) : 0 <= k < width t -> counted t k z = z.
Proof. intros [L H]; unfold counted; rewrite (proj2 (Z.leb_le 0 k) L), (proj2 (Z.ltb_lt k _) H); reflexivity. Qed.
Lemma not_zero_is {A} k (z : option A) : k <> 0 -> unless_zero k z = z.
Proof. intros N; unfold unless_zero; rewrite (proj2 (Z.eqb_neq k 0) N); reflexivity. Qed.

(** Shifts and ints are within what C defines. *)
Ltac defined := repeat (first [rewrite in_int_is by lia | rewrite counted_is by (cbn [width]; lia)]; further).

(** One statement after another. *)
Lemma run_declares known now k n e rest v c r : value_of known now e = Some v -> kept k v = Some c -> Limbs.run known ((n, c) :: now) rest = r ->
  Limbs.run known now (Declare k n (Some e) :: rest) = r.
Proof. intros E K <-; cbn [Limbs.run]; rewrite E, K; reflexivity. Qed.
Lemma run_names known now k n rest r :
  Limbs.run known ((n, match k with Plain t => Plainly t None | Struct s => Fields (repeat None s) end) :: now) rest = r ->
  Limbs.run known now (Declare k n None :: rest) = r.
Proof. intros E; exact E. Qed.
Lemma run_puts known now target o e rest now' r : put known now target o e = Some now' -> Limbs.run known now' rest = r ->
  Limbs.run known now (Put target o e :: rest) = r.
Proof. intros E <-; cbn [Limbs.run]; rewrite E; reflexivity. Qed.
Lemma run_returns known now e rest r : value_of known now e = r -> Limbs.run known now (Return e :: rest) = r.
Proof. intros E; exact E. Qed.
Lemma result_is known f given now v w :
  every (map (fun p => try c <- kept (fst (fst p)) (snd p); Some (snd (fst p), c)) (combine (parameters f) given)) = Some now ->
  Limbs.run known now (body f) = Some v -> match returns f, v with
    | Plain t, Val u z => try x <- converted u t z; Some (Val t x)
    | Struct n, Record r => if Nat.eqb (List.length r) n then Some v else None | _, _ => None end = w ->
  result known f given = w.
Proof. intros E R <-; unfold result; rewrite E, R; reflexivity. Qed.
(** All of them; what they return is left to be shown the same. *)
Ltac gets := further; defined; reflexivity.
Ltac statement := lazymatch goal with
  | |- Limbs.run _ _ (Declare _ _ (Some _) :: _) = _ => eapply run_declares; [gets | gets |]
  | |- Limbs.run _ _ (Declare _ _ None :: _) = _ => apply run_names; cbn [repeat]
  | |- Limbs.run _ _ (Put _ _ _ :: _) = _ => eapply run_puts; [gets |]
  | |- Limbs.run _ _ (Return _ :: _) = _ => apply run_returns; gets end.
Ltac runs := text_called; cbv iota; eapply eq_trans; [eapply result_is; [gets | cbn [body]; repeat statement | gets] |].

(** ** Sizes and signs. *)

(** A number in two's complement, by the sign of its high word. *)
Lemma signed_is a b : signed_value (Words a b) = a + W * b + bits128 * (if W / 2 <=? b then -1 else 0).
Proof. unfold signed_value, pattern; cbn [low_word high_word]; destruct (W / 2 <=? b); ring. Qed.
Lemma signed_range n : is_number n -> - 2 ^ 127 <= signed_value n < 2 ^ 127 /\ (signed_value n <? 0) = (W / 2 <=? high_word n).
Proof.
  destruct n as [a b]; intros [A B]; rewrite signed_is; cbn [low_word high_word] in *; change (2 ^ 127) with 170141183460469231731687303715884105728; numbers.
  destruct (Z.leb_spec 9223372036854775808 b); match goal with |- context [?x <? 0] => destruct (Z.ltb_spec x 0) end; split; (lia || reflexivity).
Qed.

(** The words of a number, or of -1 less it where it is below 0, as the C turns them over. *)
Lemma turned_words a b : is_word a -> is_word b -> let n := Words a b in let h := Z.lxor b (negative n) in let l := Z.lxor a (negative n) in
  is_word l /\ is_word h /\ l + W * h = if signed_value n <? 0 then - signed_value n - 1 else signed_value n.
Proof.
  intros A B n h l; rewrite (proj2 (signed_range n (conj A B))), ?signed_is; unfold h, l, n, negative; rewrite signed_is; cbn [high_word].
  destruct (W / 2 <=? b); [rewrite (turned a A), (turned b B) | rewrite !Z.lxor_0_r]; unfold is_word, bits128 in *; repeat split; lia.
Qed.

Lemma log2_of_word a : is_word a -> 0 <= Z.log2 a < 64.
Proof.
  intros [A0 A1]; split; [apply Z.log2_nonneg |]; destruct (Z.eq_dec a 0) as [-> | N]; [reflexivity |]; apply Z.log2_lt_pow2; [lia | exact A1].
Qed.
Lemma log2_of_words l h : is_word l -> is_word h -> h <> 0 -> Z.log2 (l + W * h) = 64 + Z.log2 h.
Proof.
  intros L H N; destruct (Z.log2_spec h) as [P Q]; [unfold is_word in H; lia |]; pose proof (log2_of_word h H).
  apply Z.log2_unique; [lia |]; unfold Z.succ in *; rewrite <- Z.add_assoc, !(Z.pow_add_r 2 64) by lia; change (2 ^ 64) with W.
  unfold is_word in *; nia.
Qed.

Theorem highest_bit_text a : is_word a -> a <> 0 -> called "hc_highest_bit" [Val U64 a] = Some (Val Int (Z.log2 a)).
Proof.
  intros A N; pose proof (log2_of_word a A); run; rewrite not_zero_is by exact N; further; defined; repeat f_equal; ring.
Qed.

Theorem bits_text n : is_number n -> called "hc_fixed_bits" [record n] = Some (Val Int (bits_of n)).
Proof.
  destruct n as [a b]; intros [A B]; cbn [low_word high_word] in A, B; unfold bits_of; destruct (turned_words a b A B) as (L & H & E).
  rewrite <- E; clear E; run; change (1 mod W) with 1; set (h := Z.lxor b _) in *; set (l := Z.lxor a _) in *; clearbody h l.
  assert (L1 : Z.log2 (Z.lor l 1) = Z.log2 l).
  { rewrite Z.log2_lor by (unfold is_word in L; lia); change (Z.log2 1) with 0; apply Z.max_l, Z.log2_nonneg. }
  assert (L0 : Z.lor l 1 <> 0) by (intros Z0; apply Z.lor_eq_0_iff in Z0; lia).
  rewrite (not_zero_is (Z.lor l 1)) by exact L0; rewrite L1; pose proof (log2_of_word l L); pose proof (log2_of_word h H).
  destruct (Z.eq_dec h 0) as [-> | N].
  - change (unless_zero 0 ?v) with (@None value); further; defined.
    rewrite Z.mul_0_r, Z.add_0_r; reflexivity.
  - rewrite not_zero_is by exact N; further; defined; rewrite log2_of_words by assumption.
    unfold chosen; rewrite (proj2 (Z.eqb_neq h 0) N); replace (65 + Z.log2 h) with (1 + (64 + Z.log2 h)) by ring; reflexivity.
Qed.

(** What the bits say. *)
Theorem bits_hold n : - 2 ^ bits_of n <= signed_value n < 2 ^ bits_of n.
Proof.
  unfold bits_of; set (v := signed_value n); set (k := if v <? 0 then - v - 1 else v); rewrite Z.add_comm; fold (Z.succ (Z.log2 k)).
  assert (K : 0 <= k) by (unfold k; destruct (Z.ltb_spec v 0); lia); assert (S : k < 2 ^ Z.succ (Z.log2 k)).
  { destruct (Z.eq_dec k 0) as [-> | N]; [reflexivity | apply Z.log2_spec; lia]. }
  revert S; generalize (2 ^ Z.succ (Z.log2 k)); unfold k; intros; destruct (Z.ltb_spec v 0); lia.
Qed.

(** The first difference of words, from the highest on, is that of the numbers. *)
Lemma words_compare l h l' h' : is_word l -> is_word l' ->
  chosen (carry h' h) 1 (chosen (chosen (same h h') (chosen (carry l' l) 1 0) 0) 1 0) = if l' + W * h' <? l + W * h then 1 else 0.
Proof.
  intros [L0 L1] [M0 M1]; unfold chosen, carry, same, W in *.
  destruct (Z.ltb_spec h' h), (Z.eqb_spec h h'), (Z.ltb_spec l' l); cbn [Z.eqb];
    match goal with |- context [if ?x <? ?y then _ else _] => destruct (Z.ltb_spec x y) end; lia.
Qed.

Theorem sign_text n error grown : is_number n -> 0 <= error -> 0 <= grown < 128 -> error * 2 ^ grown < bits128 ->
  called "hc_fixed_sign" [record n; Val U64 error; Val Int grown]
  = Some (Val Int match sign_of n (error * 2 ^ grown) with Gt => 1 | Lt => -1 | Eq => 0 end).
Proof.
  destruct n as [a b]; intros [A B] E0 G L; cbn [low_word high_word] in A, B; destruct (turned_words a b A B) as (LW & _ & E).
  pose proof (proj2 (signed_range (Words a b) (conj A B))) as S; cbn [high_word] in S.
  runs; unfold shifted_up, pattern, words_of; cbn [low_word high_word]; change (0 mod W) with 0; rewrite Z.mul_0_r, Z.add_0_r.
  assert (P : 0 <= error * 2 ^ grown) by (apply Z.mul_nonneg_nonneg; [exact E0 | apply Z.pow_nonneg; lia]).
  set (bound := error * 2 ^ grown) in *; rewrite (Z.mod_small bound bits128) by lia.
  rewrite words_compare by (exact LW || apply word_mod); rewrite E, <- (Z.add_comm (W * _)), <- Z.div_mod by discriminate.
  unfold sign_of, negative; cbn [high_word]; rewrite <- S; clearbody bound; clear - P; set (v := signed_value _) in *.
  destruct (Z.ltb_spec v 0).
  - destruct (Z.ltb_spec bound (- v - 1)), (Z.ltb_spec bound v), (Z.ltb_spec v (- bound - 1)); try lia; reflexivity.
  - destruct (Z.ltb_spec bound v), (Z.ltb_spec v (- bound - 1)); try lia; reflexivity.
Qed.

Theorem zero_text n : is_long n -> called "hc_long_is_zero" [long_record n] = Some (Val Int (if long_pattern n =? 0 then 1 else 0)).
Proof.
  destruct n as [a b c d]; intros (A & B & C & D); cbn [w0 w1 w2 w3] in A, B, C, D; run; change (0 mod W) with 0; unfold same, long_pattern; cbn [w0 w1 w2 w3].
  destruct (Z.eqb_spec (Z.lor (Z.lor (Z.lor a b) c) d) 0) as [E | N].
  - rewrite !Z.lor_eq_0_iff in E; destruct E as [[[-> ->] ->] ->]; reflexivity.
  - destruct (Z.eqb_spec (a + W * (b + W * (c + W * d))) 0); [| reflexivity]; exfalso; apply N; rewrite !Z.lor_eq_0_iff; unfold is_word, W in *; lia.
Qed.

Theorem is_negative_text n : is_long n ->
  called "hc_long_is_negative" [long_record n] = Some (Val Int (if bits256 / 2 <=? long_pattern n then 1 else 0)).
Proof.
  destruct n as [a b c d]; intros (A & B & C & D); cbn [w0 w1 w2 w3] in A, B, C, D.
  assert (S : 0 <= d / 2 ^ 63 <= 1) by (rewrite (sign_bit d D); destruct (W / 2 <=? d); lia); runs; rewrite (sign_bit d D); clear S.
  replace (bits256 / 2 <=? long_pattern _) with (W / 2 <=? d); [destruct (W / 2 <=? d); reflexivity |].
  unfold long_pattern, bits256, bits128; cbn [w0 w1 w2 w3]; change (W / 2) with 9223372036854775808; change (W * W * (W * W) / 2) with (9223372036854775808 * W * W * W).
  unfold is_word, W in *; match goal with |- (?x <=? ?y) = (?z <=? ?t) => destruct (Z.leb_spec x y), (Z.leb_spec z t) end; lia.
Qed.

(** ** Shifts. *)

(** hc_fixed_times: by 2, 4 or 8, and the number once more. *)
Lemma up_is_right n k : is_number (shifted_up n k) /\ pattern (shifted_up n k) = (pattern n * 2 ^ k) mod bits128.
Proof. destruct (words_stand (pattern n * 2 ^ k)) as [N E]; split; [exact N | exact E]. Qed.
Lemma once_more n k : is_number n -> is_number (plus (shifted_up n k) n) /\ pattern (plus (shifted_up n k) n) = ((2 ^ k + 1) * pattern n) mod bits128.
Proof.
  intros N; destruct (up_is_right n k) as [U E]; split; [split; apply word_mod |].
  rewrite plus_is_right, E by assumption; rewrite Z.add_mod_idemp_l by discriminate; f_equal; ring.
Qed.

Definition times_of k n := let m := shifted_up n (if k =? 9 then 3 else if k =? 4 then 2 else 1) in if Z.odd k then plus m n else m.
Definition factors := [2; 3; 4; 9].
Theorem times_text k n : In k factors -> called "hc_fixed_times" [Val Int k; record n] = Some (record (times_of k n)).
Proof.
  intros K; destruct n as [a b]; destruct K as [<- | [<- | [<- | [<- | []]]]];
    unfold times_of; cbn [Z.eqb Z.odd Pos.eqb]; cbv zeta; run; cbv [same chosen Z.eqb Pos.eqb Z.land Pos.land]; further; defined.
  all: match goal with |- context [shifted_up ?m ?k] => destruct (shifted_up m k) end; alike.
Qed.
Theorem times_is_right k n : is_number n -> In k factors -> is_number (times_of k n) /\ pattern (times_of k n) = (k * pattern n) mod bits128.
Proof.
  intros N K; destruct K as [<- | [<- | [<- | [<- | []]]]]; unfold times_of; cbn [Z.eqb Z.odd Pos.eqb]; cbv zeta;
    first [exact (once_more n _ N) | rewrite Z.mul_comm; exact (up_is_right n _)].
Qed.

(** The factors in the C. *)
Theorem factors_are_known : forallb (fun s => match call_of s with Times k _ => existsb (Z.eqb k) factors | _ => true end)
  (C_terms ++ C_discriminant ++ C_at_B ++ C_at_A)%list = true.
Proof. vm_compute; reflexivity. Qed.

(** Bits that another number has none of. *)
Lemma lor_is x y k : 0 <= k -> 0 <= y < 2 ^ k -> Z.lor (x * 2 ^ k) y = x * 2 ^ k + y.
Proof.
  intros K Y; assert (E : Z.land (x * 2 ^ k) y = 0).
  { apply Z.bits_inj'; intros n N; rewrite Z.land_spec, Z.bits_0; destruct (Z.lt_ge_cases n k).
    - rewrite Z.mul_pow2_bits_low by assumption; reflexivity.
    - rewrite <- (Z.mod_small y (2 ^ k)), Z.mod_pow2_bits_high by lia; apply andb_false_r. }
  rewrite <- Z.lxor_lor, Z.add_nocarry_lxor by exact E; reflexivity.
Qed.

(** The bits of a word that a shift to the left keeps. *)
Lemma kept_is b k : 0 <= k <= 64 -> (b * 2 ^ k) mod W = b mod 2 ^ (64 - k) * 2 ^ k.
Proof.
  intros K; replace W with (2 ^ (64 - k) * 2 ^ k) by (rewrite <- Z.pow_add_r by lia; replace (64 - k + k) with 64 by ring; reflexivity).
  apply Z.mul_mod_distr_r; apply Z.pow_nonzero; lia.
Qed.
Lemma in_two_is b r : 0 <= r <= 63 -> ((b * 2 ^ 1) mod W * 2 ^ (63 - r)) mod W = b mod 2 ^ r * 2 ^ (64 - r).
Proof.
  intros R; rewrite Z.mul_mod_idemp_l by discriminate; rewrite <- Z.mul_assoc, <- Z.pow_add_r by lia.
  replace (1 + (63 - r)) with (64 - r) by ring; rewrite kept_is by lia; replace (64 - (64 - r)) with r by ring; reflexivity.
Qed.
Lemma out_in_two_is a r : 0 <= r <= 63 -> a / 2 ^ 1 / 2 ^ (63 - r) = a / 2 ^ (64 - r).
Proof.
  intros R; rewrite Z.div_div by (try apply Z.pow_pos_nonneg; try apply Z.pow_nonzero; lia); rewrite <- Z.pow_add_r by lia.
  replace (1 + (63 - r)) with (64 - r) by ring; reflexivity.
Qed.

(** How many words, and how many bits besides. *)
Definition shifts := map Z.of_nat (seq 0 128).
Lemma at_every_shift f : forallb f shifts = true -> forall k, 0 <= k < 128 -> f k = true.
Proof.
  intros H k K; rewrite forallb_forall in H; apply H; unfold shifts; rewrite <- (Z2Nat.id k) by lia; apply in_map, in_seq; lia.
Qed.
Lemma rest_is k : 0 <= k < 128 -> Z.land k 63 = if k <? 64 then k else k - 64.
Proof. intros K; apply Z.eqb_eq; apply (at_every_shift (fun k => Z.land k 63 =? if k <? 64 then k else k - 64)); [vm_compute; reflexivity | exact K]. Qed.
Lemma words_are k : 0 <= k < 128 -> Z.land k 64 = if k <? 64 then 0 else 64.
Proof. intros K; apply Z.eqb_eq; apply (at_every_shift (fun k => Z.land k 64 =? if k <? 64 then 0 else 64)); [vm_compute; reflexivity | exact K]. Qed.

(** Two words are those of a number modulo 2^128. *)
Lemma are_words a b v q : is_word a -> is_word b -> v = a + W * b + bits128 * q -> Words a b = words_of (v mod bits128).
Proof.
  intros A B E; replace (v mod bits128) with (a + W * b); unfold words_of; unfold is_word in *.
  - f_equal; [apply Z.mod_unique with b | apply Z.div_unique with a]; try left; lia.
  - apply Z.mod_unique with q; [left |]; unfold bits128, W in *; lia.
Qed.

(** The bounds of what a shift by r bits leaves and moves over. *)
Lemma split_at a r : is_word a -> 0 <= r <= 63 -> let p := 2 ^ r in let q := 2 ^ (64 - r) in
  0 < p /\ 0 < q /\ W = p * q /\ a = p * (a / p) + a mod p /\ 0 <= a mod p < p /\ 0 <= a / p < q
  /\ a = q * (a / q) + a mod q /\ 0 <= a mod q < q /\ 0 <= a / q < p.
Proof.
  intros A R p q; assert (P : 0 < p) by (apply Z.pow_pos_nonneg; lia); assert (Q : 0 < q) by (apply Z.pow_pos_nonneg; lia).
  assert (E : W = p * q) by (unfold p, q; rewrite <- Z.pow_add_r by lia; replace (r + (64 - r)) with 64 by ring; reflexivity).
  unfold is_word in A; pose proof (Z.div_mod a p ltac:(lia)); pose proof (Z.mod_pos_bound a p P); pose proof (Z.div_mod a q ltac:(lia));
    pose proof (Z.mod_pos_bound a q Q).
  assert (0 <= a / p < q) by (split; [apply Z.div_pos | apply Z.div_lt_upper_bound]; lia).
  assert (0 <= a / q < p) by (split; [apply Z.div_pos | apply Z.div_lt_upper_bound]; lia).
  repeat split; lia.
Qed.

(** The words that a shift leaves out, and the bits besides. *)
Lemma parts_of_shift k : 0 <= k < 128 -> exists r, Z.land k 63 = r /\ 0 <= r <= 63
  /\ ((k = r /\ Z.land k 64 = 0) \/ (k = 64 + r /\ Z.land k 64 = 64)).
Proof.
  intros K; pose proof (rest_is k K) as R; pose proof (words_are k K) as V; exists (Z.land k 63); rewrite R, V; split; [reflexivity |].
  destruct (Z.ltb_spec k 64); lia.
Qed.

Lemma recorded x y m : Words x y = m -> Some (Record [x; y]) = Some (record m).
Proof. intros <-; reflexivity. Qed.

Theorem up_text n k : is_number n -> 0 <= k < 128 -> called "hc_fixed_up" [record n; Val Int k] = Some (record (shifted_up n k)).
Proof.
  destruct n as [a b]; intros [A B] K; cbn [low_word high_word] in A, B; destruct (parts_of_shift k K) as (r & ER & R & O).
  runs; rewrite ER; rewrite !kept_is, out_in_two_is by lia.
  destruct O as [(E & ->) | (E & ->)]; cbn [chosen Z.eqb];
    destruct (split_at a r A R) as (P & Q & EW & _ & _ & _ & EA & A1 & A2); destruct (split_at b r B R) as (_ & _ & _ & _ & _ & _ & EB & B1 & B2);
    apply recorded; unfold shifted_up, pattern; cbn [low_word high_word].
  - rewrite lor_is by lia; subst k; set (p := 2 ^ r) in *; set (q := 2 ^ (64 - r)) in *.
    apply are_words with (b / q); [unfold is_word; nia | unfold is_word; nia |].
    rewrite EA at 1; rewrite EB at 1; unfold bits128; rewrite EW; ring.
  - subst k; rewrite Z.pow_add_r by lia; change (2 ^ 64) with W; set (p := 2 ^ r) in *; set (q := 2 ^ (64 - r)) in *.
    apply are_words with (a / q + p * b); [unfold is_word, W; change (0 mod 18446744073709551616) with 0; lia | unfold is_word; nia |].
    change (0 mod W) with 0; rewrite EA at 1; unfold bits128; rewrite EW; ring.
Qed.

Lemma far_down v k : - 2 ^ 127 <= v < 2 ^ 127 -> 0 <= k -> v / 2 ^ k = v / 2 ^ Z.min k 127.
Proof.
  intros V K; destruct (Z.le_ge_cases k 127) as [H | H]; [rewrite Z.min_l by exact H; reflexivity | rewrite Z.min_r by exact H].
  assert (P : 2 ^ 127 <= 2 ^ k) by (apply Z.pow_le_mono_r; lia); destruct (Z.lt_ge_cases v 0).
  - transitivity (-1); [symmetry; apply Z.div_unique with (v + 2 ^ k); [left |]; lia | apply Z.div_unique with (v + 2 ^ 127); [left |]; lia].
  - rewrite !Z.div_small by lia; reflexivity.
Qed.

(** The quotients of a number in two's complement, s being 0 or -1. *)
Lemma down_by_bits a a' b b' p q s : 0 <= a' < p -> (p * a + a' + p * q * (p * b + b') + p * q * (p * q) * s) / p = a + q * b' + p * q * (b + q * s).
Proof. intros A; symmetry; apply Z.div_unique with a'; [left; exact A | ring]. Qed.
Lemma down_by_words a b b' p q s : 0 <= a < p * q -> 0 <= b' < p -> (a + p * q * (p * b + b') + p * q * (p * q) * s) / (p * q * p) = b + q * s.
Proof. intros A B; symmetry; apply Z.div_unique with (a + p * q * b'); [left; nia | ring]. Qed.

Theorem down_text n k : is_number n -> 0 <= k -> called "hc_fixed_down" [record n; Val Int k] = Some (record (shifted_down n k)).
Proof.
  intros N K; unfold shifted_down; rewrite (far_down _ k (proj1 (signed_range n N)) K).
  assert (M : 0 <= chosen (carry k 127) k 127 < 128 /\ chosen (carry k 127) k 127 = Z.min k 127)
    by (unfold chosen, carry; destruct (Z.ltb_spec k 127); cbn [Z.eqb]; lia).
  destruct n as [a b], N as [A B]; cbn [low_word high_word] in A, B; destruct M as [M <-], (parts_of_shift _ M) as (r & ER & R & O).
  runs; rewrite signed_is, ER; set (m := chosen (carry k 127) k 127) in *; clearbody m; rewrite !in_two_is by lia.
  destruct (split_at a r A R) as (P & Q & EW & EA & A1 & A2 & _); destruct (split_at b r B R) as (_ & _ & _ & EB & B1 & B2 & _).
  assert (N : is_word (negative (Words a b))) by (unfold negative; cbn [high_word]; destruct (W / 2 <=? b); split; reflexivity || discriminate).
  assert (H : is_word (negative (Words a b) mod 2 ^ r * 2 ^ (64 - r) + b / 2 ^ r)).
  { pose proof (Z.mod_pos_bound (negative (Words a b)) (2 ^ r) P); unfold is_word; nia. }
  destruct O as [(E & ->) | (E & ->)]; cbn [chosen Z.eqb]; rewrite !(Z.lor_comm (_ / _)), !lor_is by lia; apply recorded; subst m.
  all: assert (S : exists s, (if W / 2 <=? b then -1 else 0) = s /\ negative (Words a b) = s + (if W / 2 <=? b then W else 0)
    /\ negative (Words a b) mod 2 ^ r * 2 ^ (64 - r) = 2 ^ (64 - r) * s + (if W / 2 <=? b then W else 0) /\ s * W = - (if W / 2 <=? b then W else 0)).
  1, 3: eexists; split; [reflexivity |]; unfold negative; cbn [high_word]; destruct (W / 2 <=? b); [| rewrite Z.mod_0_l by lia; repeat split; lia].
  1, 2: replace ((W - 1) mod 2 ^ r) with (2 ^ r - 1) by (apply Z.mod_unique with (2 ^ (64 - r) - 1); [left; lia | rewrite EW; ring]);
    split; [ring | split; [rewrite EW; ring | ring]].
  all: destruct S as (s & -> & S1 & S2 & S3); rewrite S2 in *; set (p := 2 ^ r) in *; set (q := 2 ^ (64 - r)) in *; set (e := if W / 2 <=? b then W else 0) in *.
  - apply are_words with s; [unfold is_word; nia | exact H |].
    replace ((a + W * b + bits128 * s) / p) with (a / p + q * (b mod p) + W * (b / p + q * s)).
    2: { pose proof (down_by_bits (a / p) (a mod p) (b / p) (b mod p) p q s A1) as D; rewrite <- EA, <- EB, <- EW in D; symmetry; exact D. }
    unfold bits128; replace (W * W * s) with (W * (s * W)) by ring; rewrite S3; ring.
  - rewrite Z.pow_add_r by lia; change (2 ^ 64) with W; fold p; apply are_words with s; [exact H | exact N |].
    replace ((a + W * b + bits128 * s) / (W * p)) with (b / p + q * s).
    2: { pose proof (down_by_words a (b / p) (b mod p) p q s ltac:(lia) B1) as D; rewrite <- EB, <- EW in D; symmetry; exact D. }
    unfold bits128; rewrite S1; replace (W * W * s) with (W * (s * W)) by ring; rewrite S3; clearbody e; lia.
Qed.
