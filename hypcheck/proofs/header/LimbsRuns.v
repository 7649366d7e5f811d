(** The functions of the header that add and multiply numbers of two and four words are those that the other files speak of.

    Coq reads their text and runs it on any words: the carries, masks and order of the C are proved, not written down. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed Long Limbs FixedRuns.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** Their text, where limbs have 64 bits. *)
Definition texts := map (fun text => function_of true (string_of text)) HeaderText.functions.
Definition functions := Eval vm_compute in match every texts with Some l => l | None => [] end.
Theorem texts_are_read : texts = map Some functions.
Proof. vm_cast_no_check (eq_refl (map Some functions)). Qed.

(** What they compute. *)
Definition full a b := Words (a * b mod W) (a * b / W).
Definition negative n := if W / 2 <=? high_word n then W - 1 else 0.
Definition models := [("hc_fixed_full", OfWords full); ("hc_fixed_full_signed", OfWords full_signed);
  ("hc_fixed_plus", OfNumbers plus); ("hc_fixed_minus", OfNumbers minus); ("hc_fixed_negative", OfNumber negative);
  ("hc_fixed_product", OfNumbers product); ("hc_fixed_signed_product", OfNumbers signed_product);
  ("hc_fixed_both_signed_product", OfNumbers both_signed_product); ("hc_long_product", OfProducts long_product); ("hc_long_sum", OfLongs long_sum)].

(** A call of a function: its text is run, and those that it calls compute what is said of them. *)
Definition called n given := try f <- look n functions; result models f given.

Ltac run := unfold called; match goal with |- context [look ?n ?l] => let f := eval vm_compute in (look n l) in change (look n l) with f end;
  match goal with |- ?text = ?answer => let v := eval cbv -[Z.add Z.sub Z.mul Z.div Z.modulo Z.pow Z.land Z.lor Z.lxor carry same
    W bits128 negative plus minus product signed_product both_signed_product long_product long_sum] in text in change (v = answer) end.

(** Both sides written out, for which Coq need not compute. *)
Ltac alike := cbv [record long_record low_word high_word w0 w1 w2 w3]; reflexivity.

(** ** Lemmas of words. *)

Lemma small_mod_W k : 0 <= k <= 2 -> k mod W = k.
Proof. intros H; apply Z.mod_small; unfold W; lia. Qed.
Lemma carry_word a c : carry a c mod W = carry a c.
Proof. apply small_mod_W; unfold carry; destruct (a <? c); lia. Qed.
Lemma carries_word a c d e : (carry a c + carry d e) mod W = carry a c + carry d e.
Proof. apply small_mod_W; unfold carry; destruct (a <? c), (d <? e); lia. Qed.
Lemma either_carry a c d e : Z.lor (carry a c) (carry d e) = Z.max (carry a c) (carry d e).
Proof. unfold carry; destruct (a <? c), (d <? e); reflexivity. Qed.
Lemma most_carry_word a c d e : Z.max (carry a c) (carry d e) mod W = Z.max (carry a c) (carry d e).
Proof. apply small_mod_W; unfold carry; destruct (a <? c), (d <? e); lia. Qed.
Lemma same_word a c : same a c mod W = same a c.
Proof. apply small_mod_W; unfold same; destruct (a =? c); lia. Qed.

Lemma all_bits a : is_word a -> Z.land a (W - 1) = a.
Proof. intros A; change (W - 1) with (Z.ones 64); rewrite Z.land_ones by lia; apply Z.mod_small; exact A. Qed.
Lemma turned a : is_word a -> Z.lxor a (W - 1) = W - 1 - a.
Proof.
  intros A; assert (E : Z.lxor a (W - 1) + a = W - 1); [| lia].
  rewrite Z.add_nocarry_lxor.
  - rewrite (Z.lxor_comm a), Z.lxor_assoc, Z.lxor_nilpotent; apply Z.lxor_0_r.
  - apply Z.bits_inj'; intros n N; rewrite Z.land_spec, Z.lxor_spec, Z.bits_0; change (W - 1) with (Z.ones 64).
    rewrite Z.testbit_ones_nonneg by lia; destruct (Z.ltb_spec n 64); [destruct (Z.testbit a n); reflexivity |].
    rewrite (Z.bits_above_log2 a n), andb_false_r; [reflexivity | apply A |].
    destruct (Z.eq_dec a 0) as [-> | Z0]; [simpl; lia |].
    apply Z.lt_le_trans with 64; [apply Z.log2_lt_pow2; unfold is_word, W in *; lia | lia].
Qed.

(** The sign of a word, as the mask that the header makes of it. *)
Lemma sign_bit a : is_word a -> a / 2 ^ 63 = if W / 2 <=? a then 1 else 0.
Proof.
  intros [A0 A1]; change (W / 2) with (2 ^ 63); change W with (2 * 2 ^ 63) in A1; set (h := 2 ^ 63) in *.
  assert (0 < h) by reflexivity; destruct (Z.leb_spec h a).
  - symmetry; apply Z.div_unique with (a - h); [left |]; lia.
  - apply Z.div_small; lia.
Qed.
Lemma mask_is a : is_word a -> (0 mod W - a / 2 ^ 63) mod W = if W / 2 <=? a then W - 1 else 0.
Proof. intros A; rewrite sign_bit by exact A; destruct (W / 2 <=? a); reflexivity. Qed.
Lemma masked_word a c : is_word a -> Z.land a (if c : bool then W - 1 else 0) = if c then a else 0.
Proof. intros A; destruct c; [apply all_bits; exact A | apply Z.land_0_r]. Qed.

Ltac words := rewrite ?carry_word, ?carries_word, ?same_word, ?either_carry, ?most_carry_word.

Theorem plus_text l r : called "hc_fixed_plus" [record l; record r] = Some (record (plus l r)).
Proof.
  destruct l as [a b], r as [c d]; unfold plus; run; words; rewrite Z.add_mod_idemp_l by discriminate; reflexivity.
Qed.
Theorem minus_text l r : called "hc_fixed_minus" [record l; record r] = Some (record (minus l r)).
Proof.
  destruct l as [a b], r as [c d]; unfold minus; run; words; rewrite Zminus_mod_idemp_l; reflexivity.
Qed.
Theorem negative_text n : is_number n -> called "hc_fixed_negative" [record n] = Some (Val U64 (negative n)).
Proof. destruct n as [a b]; intros [_ N]; run; rewrite mask_is by exact N; reflexivity. Qed.

Lemma products_fit a c : is_word a -> is_word c -> a * c mod bits128 = a * c /\ a * c / 2 ^ 64 mod W = a * c / W.
Proof.
  intros A C; destruct (word_product a c A C) as [P Q]; split; apply Z.mod_small; [| exact Q].
  split; [exact P |]; apply Z.mul_lt_mono_nonneg; unfold is_word in *; lia.
Qed.
Theorem full_text a c : is_word a -> is_word c -> called "hc_fixed_full" [Val U64 a; Val U64 c] = Some (record (full a c)).
Proof. intros A C; destruct (products_fit a c A C) as [P Q]; run; rewrite P, Q; reflexivity. Qed.

Theorem full_signed_text a c : is_word a -> is_word c -> called "hc_fixed_full_signed" [Val U64 a; Val U64 c] = Some (record (full_signed a c)).
Proof. intros A C; unfold full_signed; run; rewrite mask_is, masked_word by assumption; reflexivity. Qed.

Theorem product_text l r : called "hc_fixed_product" [record l; record r] = Some (record (product l r)).
Proof. destruct l as [a b], r as [c d]; unfold product; run; words; reflexivity. Qed.

Theorem signed_product_text l r : is_number r -> called "hc_fixed_signed_product" [record l; record r] = Some (record (signed_product l r)).
Proof.
  destruct l as [a b], r as [c d]; intros [R1 R2]; cbn [low_word high_word] in R1, R2; unfold signed_product, masked; run; unfold negative; cbn [high_word].
  rewrite (masked_word c _ R1), (masked_word d _ R2); destruct (W / 2 <=? b); alike.
Qed.
Theorem both_signed_product_text l r : is_number l -> called "hc_fixed_both_signed_product" [record l; record r] = Some (record (both_signed_product l r)).
Proof.
  destruct l as [a b], r as [c d]; intros [R1 R2]; cbn [low_word high_word] in R1, R2; unfold both_signed_product, masked; run; unfold negative; cbn [high_word].
  rewrite (masked_word a _ R1), (masked_word b _ R2); destruct (W / 2 <=? d); alike.
Qed.

Ltac finish_square := rewrite (Z.mul_comm _ 2); match goal with |- context [((?x + ?y / 2 ^ 63) mod W + ?c) mod W] =>
  rewrite (Zplus_mod_idemp_l (x + y / 2 ^ 63) c W) end; reflexivity.
Theorem square_text n : is_number n -> called "hc_fixed_square" [record n] = Some (record (square n)).
Proof.
  destruct n as [a b]; intros [N1 N2]; cbn [low_word high_word] in *; unfold square, size, minus; cbn [low_word high_word]; run; unfold negative; cbn [high_word]; words;
    change (0 mod W) with 0; change (2 ^ 1) with 2.
  destruct (W / 2 <=? b).
  - rewrite (turned a N1), (turned b N2); rewrite !(Z.land_comm (W - 1)), !all_bits by (unfold same, is_word, W; destruct (_ =? _); lia).
    replace ((W - 1 - a - (W - 1)) mod W) with ((0 - a) mod W) by (f_equal; ring).
    replace ((W - 1 - b + same ((0 - a) mod W) 0) mod W) with ((0 - b - carry 0 a) mod W); [finish_square |].
    rewrite <- (Z.mod_add (0 - b - carry 0 a) 1) by discriminate; f_equal.
    unfold same, carry, is_word in *; destruct (Z.ltb_spec 0 a), (Z.eqb_spec ((0 - a) mod W) 0); unfold W in *; euclid; lia.
  - rewrite !Z.lxor_0_r, !Z.land_0_l, Z.sub_0_r, Z.add_0_r, (Z.mod_small a), (Z.mod_small b) by assumption; finish_square.
Qed.

Theorem long_product_text l r : called "hc_long_product" [record l; record r] = Some (long_record (long_product l r)).
Proof.
  destruct l as [a b], r as [c d]; unfold long_product; run; words.
  match goal with |- context [(((?p / W + ?x) mod W + ?y) mod W + ?z) mod W] =>
    rewrite (Zplus_mod_idemp_l ((p / W + x) mod W + y) z), <- (Z.add_assoc ((p / W + x) mod W) y z), (Zplus_mod_idemp_l (p / W + x) (y + z)),
      (Z.add_assoc (p / W + x) y z) end; reflexivity.
Qed.
Theorem long_sum_text l r (minus : bool) : is_long r ->
  called "hc_long_sum" [long_record l; long_record r; Val Int (if minus then 1 else 0)] = Some (long_record (long_sum l r minus)).
Proof.
  destruct l as [a b c d], r as [e f g h]; intros (R0 & R1 & R2 & R3); cbn [w0 w1 w2 w3] in *; destruct minus; run; words.
  - change ((0 mod W - 1 mod W) mod W) with (W - 1); change (1 mod W) with 1;
      rewrite (turned e R0), (turned f R1), (turned g R2), (turned h R3); cbv [long_sum adder]; alike.
  - change ((0 mod W - 0 mod W) mod W) with 0; change (0 mod W) with 0; rewrite !Z.lxor_0_r; cbv [long_sum adder]; alike.
Qed.

Theorem long_signed_product_text l r : is_number r ->
  called "hc_long_signed_product" [record l; record r] = Some (long_record (long_signed_product l r)).
Proof.
  destruct l as [a b], r as [c d]; intros [R1 R2]; unfold long_signed_product; cbn [low_word high_word] in *; run; unfold negative; cbn [high_word].
  rewrite (masked_word c _ R1), (masked_word d _ R2); destruct (W / 2 <=? b); alike.
Qed.

