(** Stage 4: its numbers of four words. LimbsRuns.v proves that the functions of the header compute them. *)

Require Import ZArith Lia.
From Hypcheck Require Import Fixed.
Open Scope Z_scope.

Definition is_word w := 0 <= w < W.
Record long := Long { w0 : Z; w1 : Z; w2 : Z; w3 : Z }.
Definition is_long n := is_word (w0 n) /\ is_word (w1 n) /\ is_word (w2 n) /\ is_word (w3 n).
Definition long_pattern n := w0 n + W * (w1 n + W * (w2 n + W * w3 n)).
Definition bits256 := bits128 * bits128.

(** A sum of words, and whether it went over: in C, whether it is below one of them. *)
Lemma carried p q : is_word p -> is_word q -> p + q = (p + q) mod W + W * carry ((p + q) mod W) q.
Proof.
  unfold is_word, carry, W; intros P Q; destruct (Z.ltb_spec ((p + q) mod 18446744073709551616) q); euclid; lia.
Qed.
Lemma mod_word k : is_word (k mod W).
Proof. apply Z.mod_pos_bound; reflexivity. Qed.
Lemma parts k : k = k mod W + W * (k / W).
Proof. rewrite (Z.div_mod k W) at 1 by discriminate; ring. Qed.

(** hc_long_product *)
Definition long_product l r :=
  let low := low_word l * low_word r in let high := high_word l * high_word r in
  let mixed := low_word l * high_word r in let other := high_word l * low_word r in
  let p1 := (low / W + mixed mod W) mod W in let q1 := (p1 + other mod W) mod W in
  let over := carry p1 (mixed mod W) + carry q1 (other mod W) in
  let p2 := (high mod W + over) mod W in let q2 := (p2 + mixed / W) mod W in let s2 := (q2 + other / W) mod W in
  Long (low mod W) q1 s2 ((high / W + carry p2 over + carry q2 (mixed / W) + carry s2 (other / W)) mod W).

Lemma word_product a c : is_word a -> is_word c -> 0 <= a * c /\ is_word (a * c / W).
Proof.
  unfold is_word; intros A C; split; [apply Z.mul_nonneg_nonneg; lia |]; split.
  - apply Z.div_pos; [apply Z.mul_nonneg_nonneg; lia | reflexivity].
  - apply Z.div_lt_upper_bound; [reflexivity |]; apply Z.mul_lt_mono_nonneg; lia.
Qed.

Lemma carry_small s q : 0 <= carry s q <= 1.
Proof. unfold carry; destruct (s <? q); lia. Qed.

Theorem long_product_is_right l r : is_number l -> is_number r ->
  is_long (long_product l r) /\ long_pattern (long_product l r) = pattern l * pattern r.
Proof.
  intros [A B] [C E]; destruct l as [a b], r as [c e]; cbn [low_word high_word] in *.
  unfold long_product; cbn [low_word high_word].
  destruct (word_product a c A C) as [_ L]; destruct (word_product b e B E) as [_ H];
    destruct (word_product a e A E) as [_ M]; destruct (word_product b c B C) as [_ O].
  set (low := a * c) in *; set (high := b * e) in *; set (mixed := a * e) in *; set (other := b * c) in *.
  set (p1 := (low / W + mixed mod W) mod W); set (q1 := (p1 + other mod W) mod W).
  set (over := carry p1 (mixed mod W) + carry q1 (other mod W)).
  set (p2 := (high mod W + over) mod W); set (q2 := (p2 + mixed / W) mod W); set (s2 := (q2 + other / W) mod W).
  set (top := high / W + carry p2 over + carry q2 (mixed / W) + carry s2 (other / W)).
  assert (OV : is_word over).
  { unfold over; pose proof (carry_small p1 (mixed mod W)); pose proof (carry_small q1 (other mod W)); assert (2 < W) by reflexivity; unfold is_word; lia. }
  pose proof (carried (low / W) (mixed mod W) L (mod_word _)) as K1; fold p1 in K1.
  pose proof (carried p1 (other mod W) (mod_word _) (mod_word _)) as K2; fold q1 in K2.
  pose proof (carried (high mod W) over (mod_word _) OV) as K3; fold p2 in K3.
  pose proof (carried p2 (mixed / W) (mod_word _) M) as K4; fold q2 in K4.
  pose proof (carried q2 (other / W) (mod_word _) O) as K5; fold s2 in K5.
  pose proof (parts low) as D1; pose proof (parts high) as D2; pose proof (parts mixed) as D3; pose proof (parts other) as D4.
  pose proof (parts top) as D5.
  split; [repeat split; apply mod_word |].
  unfold long_pattern, pattern; cbn [w0 w1 w2 w3 low_word high_word].
  assert (T : low mod W + W * (q1 + W * (s2 + W * top)) = (a + W * b) * (c + W * e)).
  { replace ((a + W * b) * (c + W * e)) with (low + W * mixed + W * other + W * W * high) by (unfold low, mixed, other, high; ring).
    unfold top; clear D5 top; unfold over in K3 at 1; clearbody over p1 q1 p2 q2 s2 low high mixed other.
    generalize dependent (carry s2 (other / W)); generalize dependent (carry q2 (mixed / W)); generalize dependent (carry p2 over);
      generalize dependent (carry q1 (other mod W)); generalize dependent (carry p1 (mixed mod W)); intros.
    clear - D1 D2 D3 D4 K1 K2 K3 K4 K5; generalize dependent (low mod W); generalize dependent (low / W);
      generalize dependent (high mod W); generalize dependent (high / W); generalize dependent (mixed mod W);
      generalize dependent (mixed / W); generalize dependent (other mod W); generalize dependent (other / W); intros; unfold W in *; lia. }
  assert (Small : top < W).
  { assert ((a + W * b) * (c + W * e) < bits128 * bits128) by (apply Z.mul_lt_mono_nonneg; unfold is_word, bits128, W in *; lia).
    assert (0 <= low mod W /\ 0 <= q1 /\ 0 <= s2) by (repeat split; apply mod_word); unfold bits128, W in *; lia. }
  assert (0 <= top).
  { unfold top; pose proof (carry_small p2 over); pose proof (carry_small q2 (mixed / W)); pose proof (carry_small s2 (other / W)).
    destruct H; lia. }
  rewrite (Z.mod_small top) by lia; exact T.
Qed.

(** hc_long_sum: the words of -right are those of right turned over, and one more. *)
Definition adder a t c := let part := (a + t) mod W in let s := (part + c) mod W in (s, Z.max (carry part t) (carry s c)).
Definition long_sum l r (minus : bool) :=
  let term k := if minus then W - 1 - k else k in
  let (s0, c0) := adder (w0 l) (term (w0 r)) (if minus then 1 else 0) in let (s1, c1) := adder (w1 l) (term (w1 r)) c0 in
  let (s2, c2) := adder (w2 l) (term (w2 r)) c1 in let (s3, _) := adder (w3 l) (term (w3 r)) c2 in Long s0 s1 s2 s3.

Lemma adder_is_right a t c s c' : is_word a -> is_word t -> 0 <= c <= 1 -> adder a t c = (s, c') ->
  a + t + c = s + W * c' /\ is_word s /\ 0 <= c' <= 1.
Proof.
  unfold adder, is_word, carry, W; intros A T C E; injection E as <- <-.
  set (p := (a + t) mod 18446744073709551616); set (s := (p + c) mod 18446744073709551616).
  destruct (Z.ltb_spec p t); destruct (Z.ltb_spec s c); unfold s, p in *; clear s p; euclid; lia.
Qed.

Theorem long_sum_is_right l r minus : is_long l -> is_long r -> is_long (long_sum l r minus) /\
  long_pattern (long_sum l r minus) = (long_pattern l + (if minus then - long_pattern r else long_pattern r)) mod bits256.
Proof.
  intros (L0 & L1 & L2 & L3) (R0 & R1 & R2 & R3); unfold long_sum.
  assert (T : forall k, is_word k -> is_word (if minus then W - 1 - k else k)) by (intros k K; unfold is_word in *; destruct minus; lia).
  destruct (adder (w0 l) (if minus then W - 1 - w0 r else w0 r) (if minus then 1 else 0)) as [s0 c0] eqn:A0.
  apply adder_is_right in A0; [| assumption | apply T; assumption | destruct minus; lia]; destruct A0 as (E0 & S0 & C0).
  destruct (adder (w1 l) (if minus then W - 1 - w1 r else w1 r) c0) as [s1 c1] eqn:A1.
  apply adder_is_right in A1; [| assumption | apply T; assumption | assumption]; destruct A1 as (E1 & S1 & C1).
  destruct (adder (w2 l) (if minus then W - 1 - w2 r else w2 r) c1) as [s2 c2] eqn:A2.
  apply adder_is_right in A2; [| assumption | apply T; assumption | assumption]; destruct A2 as (E2 & S2 & C2).
  destruct (adder (w3 l) (if minus then W - 1 - w3 r else w3 r) c2) as [s3 c3] eqn:A3.
  apply adder_is_right in A3; [| assumption | apply T; assumption | assumption]; destruct A3 as (E3 & S3 & C3).
  split; [exact (conj S0 (conj S1 (conj S2 S3))) |]; unfold long_pattern; cbn [w0 w1 w2 w3].
  apply Z.mod_unique with (if minus then c3 - 1 else c3); [left |]; unfold is_word, bits256, bits128, W in *; destruct minus; lia.
Qed.

(** hc_long_signed_product: a number of two words below 0 is taken for 2^128 more. *)
Definition long_signed_product l r :=
  long_sum (long_product l r) (Long 0 0 (low_word (if W / 2 <=? high_word l then r else Words 0 0))
    (high_word (if W / 2 <=? high_word l then r else Words 0 0))) true.

Theorem long_signed_product_is_right l r : is_number l -> is_number r ->
  long_pattern (long_signed_product l r)
  = (pattern l * pattern r - (if 2 ^ 127 <=? pattern l then pattern r * 2 ^ 128 else 0)) mod bits256.
Proof.
  intros L R; destruct (long_product_is_right l r L R) as [P E]; unfold long_signed_product.
  assert (Z0 : is_word 0) by (unfold is_word, W; lia).
  assert (H : (W / 2 <=? high_word l) = (2 ^ 127 <=? pattern l)).
  { destruct L as [L0 L1]; unfold pattern; change (W / 2) with 9223372036854775808; change (2 ^ 127) with 170141183460469231731687303715884105728.
    unfold W in *; destruct (Z.leb_spec 9223372036854775808 (high_word l));
      destruct (Z.leb_spec 170141183460469231731687303715884105728 (low_word l + 18446744073709551616 * high_word l)); lia. }
  rewrite H; set (n := if 2 ^ 127 <=? pattern l then r else Words 0 0).
  assert (N : is_number n) by (unfold n; destruct (2 ^ 127 <=? pattern l); [exact R | split; exact Z0]).
  destruct (long_sum_is_right (long_product l r) (Long 0 0 (low_word n) (high_word n)) true P) as [_ S].
  { destruct N as [N1 N2]; exact (conj Z0 (conj Z0 (conj N1 N2))). }
  rewrite S, E; f_equal; unfold long_pattern, n; cbn [w0 w1 w2 w3].
  change (2 ^ 128) with (W * W); destruct (2 ^ 127 <=? pattern l); unfold pattern; cbn [low_word high_word]; ring.
Qed.

(** hc_fixed_full_signed: the product of two words, of which the first may be below 0. *)
Definition full_signed left right := let full := left * right in
  Words (full mod W) ((full / W - (if W / 2 <=? left then right else 0)) mod W).

Theorem full_signed_is_right left right : is_word left -> is_word right ->
  pattern (full_signed left right) = (left * right - (if 2 ^ 63 <=? left then right * 2 ^ 64 else 0)) mod bits128.
Proof.
  intros L R; destruct (word_product left right L R) as [F H]; unfold full_signed, pattern; cbn [low_word high_word].
  change (W / 2) with (2 ^ 63); change (2 ^ 64) with W; set (e := if 2 ^ 63 <=? left then right else 0).
  replace (if 2 ^ 63 <=? left then right * W else 0) with (e * W) by (unfold e; destruct (2 ^ 63 <=? left); ring).
  pose proof (parts (left * right)) as D; pose proof (parts (left * right / W - e)) as X.
  pose proof (mod_word (left * right)); pose proof (mod_word (left * right / W - e)).
  apply Z.mod_unique with ((left * right / W - e) / W); [left |].
  - unfold is_word, bits128, W in *; lia.
  - clear - D X; generalize dependent ((left * right / W - e) mod W); generalize dependent ((left * right / W - e) / W).
    generalize dependent (left * right mod W); generalize dependent (left * right / W); generalize dependent (left * right); intros.
    unfold bits128, W in *; lia.
Qed.
