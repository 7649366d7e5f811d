(** Stage 3: what its truncated products cut, and that its numbers fit 128 bits, for the steps that Coq reads in the C.

    A number is 128 bits in two's complement, a whole number of units. [fits] computes for each step an interval of the number and of
    its error, in whole units, as programs/fixed.py does; [fits_is_right] proves it. At the end are the bounds that the header has. *)

Require Import List String ZArith Reals Lra Lia Psatz Bool.

Import ListNotations.
Open Scope Z_scope.

(** ** Words of 64 bits: carries are right. *)

Definition W := 18446744073709551616.
Definition bits128 := W * W.
Definition carry a b := if a <? b then 1 else 0.
Record number := Words { low_word : Z; high_word : Z }.
Definition is_number n := 0 <= low_word n < W /\ 0 <= high_word n < W.
Definition pattern n := low_word n + W * high_word n.

(** hc_fixed_plus and hc_fixed_minus *)
Definition plus l r := let low := (low_word l + low_word r) mod W in
  Words low ((high_word l + high_word r + carry low (low_word l)) mod W).
Definition minus l r := Words ((low_word l - low_word r) mod W)
  ((high_word l - high_word r - carry (low_word l) (low_word r)) mod W).

Ltac euclid := Z.to_euclidean_division_equations.

Lemma plus_is_right l r : is_number l -> is_number r -> pattern (plus l r) = (pattern l + pattern r) mod bits128.
Proof.
  intros [L1 L2] [R1 R2]; unfold pattern, plus, carry, bits128, W in *; cbn [low_word high_word].
  destruct (Z.ltb_spec ((low_word l + low_word r) mod 18446744073709551616) (low_word l)); euclid; lia.
Qed.

Lemma minus_is_right l r : is_number l -> is_number r -> pattern (minus l r) = (pattern l - pattern r) mod bits128.
Proof.
  intros [L1 L2] [R1 R2]; unfold pattern, minus, carry, bits128, W in *; cbn [low_word high_word].
  destruct (Z.ltb_spec (low_word l) (low_word r)); euclid; lia.
Qed.

(** hc_fixed_product: the product of the high words, and the high words of the mixed products *)
Definition product l r :=
  let mixed := high_word l * low_word r / W in let other := low_word l * high_word r / W in
  let full := high_word l * high_word r in
  let low1 := (full mod W + mixed) mod W in let high1 := (full / W + carry low1 mixed) mod W in
  let low2 := (low1 + other) mod W in Words low2 ((high1 + carry low2 other) mod W).

Definition truncated p q := high_word p * high_word q + high_word p * low_word q / W + low_word p * high_word q / W.

Lemma products l r : is_number l -> is_number r ->
  let t := truncated l r in 0 <= t /\ bits128 * t <= pattern l * pattern r < bits128 * (t + 3).
Proof.
  intros [[A0 A1] [B0 B1]] [[C0 C1] [D0 D1]] t; unfold t, truncated, pattern, bits128.
  destruct l as [a b], r as [c e]; cbn [low_word high_word] in *.
  pose proof (Z.mul_nonneg_nonneg a c A0 C0); pose proof (Z.mul_nonneg_nonneg b c B0 C0).
  pose proof (Z.mul_nonneg_nonneg a e A0 D0); pose proof (Z.mul_nonneg_nonneg b e B0 D0).
  assert (a * c < W * W) by (apply Z.mul_lt_mono_nonneg; assumption).
  assert (W0 : 0 < W) by reflexivity.
  pose proof (Z.div_mod (b * c) W); pose proof (Z.mod_pos_bound (b * c) W W0).
  pose proof (Z.div_mod (a * e) W); pose proof (Z.mod_pos_bound (a * e) W W0).
  pose proof (Z.div_pos (b * c) W); pose proof (Z.div_pos (a * e) W).
  set (m := b * c / W) in *; set (o := a * e / W) in *.
  replace ((a + W * b) * (c + W * e)) with (a * c + W * (a * e) + W * (b * c) + W * W * (b * e)) by ring.
  split; [lia |]; unfold W in *; lia.
Qed.

Lemma product_is_right l r : is_number l -> is_number r -> pattern (product l r) = truncated l r.
Proof.
  intros L R; destruct (products l r L R) as (T0 & T1 & _); destruct L as [L1 L2]; destruct R as [R1 R2].
  assert (T : truncated l r < bits128).
  { assert (pattern l * pattern r < bits128 * bits128); [| unfold bits128, W in *; lia].
    apply Z.mul_lt_mono_nonneg; unfold pattern, bits128, W in *; lia. }
  unfold pattern, product, truncated, carry, bits128 in *; cbn [low_word high_word].
  assert (0 <= high_word l * low_word r / W < W).
  { split; [apply Z.div_pos; [apply Z.mul_nonneg_nonneg; lia | reflexivity] |].
    apply Z.div_lt_upper_bound; [reflexivity |]; apply Z.mul_lt_mono_nonneg; lia. }
  assert (0 <= low_word l * high_word r / W < W).
  { split; [apply Z.div_pos; [apply Z.mul_nonneg_nonneg; lia | reflexivity] |].
    apply Z.div_lt_upper_bound; [reflexivity |]; apply Z.mul_lt_mono_nonneg; lia. }
  set (m := high_word l * low_word r / W) in *; set (o := low_word l * high_word r / W) in *.
  assert (F : 0 <= high_word l * high_word r) by (apply Z.mul_nonneg_nonneg; lia).
  set (f := high_word l * high_word r) in *; clearbody f m o; clear - T0 T H H0 F; unfold W in *.
  repeat match goal with |- context [if ?x <? ?y then _ else _] => destruct (Z.ltb_spec x y) end; euclid; lia.
Qed.

(** ** Intervals. *)

Record range := Range { low : Z; high : Z; under : Z; over : Z }.

(** A number of units v and the exact value x that it stands for. *)
Definition within (r : range) (v : Z) (x : R) :=
  low r <= v <= high r /\ (IZR (under r) <= IZR v - x <= IZR (over r))%R.

Definition sum a b := Range (low a + low b) (high a + high b) (under a + under b) (over a + over b).
Definition negative a := Range (- high a) (- low a) (- over a) (- under a).
Definition times k a := Range (k * low a) (k * high a) (k * under a) (k * over a).
Definition moved_down a := Range (Z.min 0 (low a)) (Z.max 0 (high a)) (Z.min 0 (under a) - 1) (Z.max 0 (over a)).

Definition least a b c d := Z.min (Z.min a b) (Z.min c d).
Definition most a b c d := Z.max (Z.max a b) (Z.max c d).
Definition corners (f : Z -> Z -> Z -> Z -> Z) p q r s := f (p * r) (p * s) (q * r) (q * s).

(** The least and the greatest of them, each product made once. *)
Definition ends p q r s := let a := p * r in let b := p * s in let c := q * r in let d := q * s in (least a b c d, most a b c d).
Lemma ends_are p q r s : ends p q r s = (corners least p q r s, corners most p q r s).
Proof. reflexivity. Qed.

(** Divided by 2^128 and rounded down, which Coq computes fastest as a shift. *)
Definition divided k := Z.shiftr k 128.
Lemma divided_is k : divided k = k / bits128.
Proof. apply (Z.shiftr_div_pow2 k 128); discriminate. Qed.

Definition cut := 3.
Definition times_range a b :=
  let '(box_least, box_most) := ends (low a) (high a) (low b) (high b) in
  let '(mixed_least, mixed_most) := ends (low a) (high a) (under b) (over b) in
  let '(other_least, other_most) := ends (low b) (high b) (under a) (over a) in
  let '(both_least, both_most) := ends (under a) (over a) (under b) (over b) in
  let lowest := divided box_least - cut in
  Range (if (0 <=? low a) && (0 <=? low b) then Z.max 0 lowest else lowest) (divided box_most)
    (divided (mixed_least + other_least - both_most) - cut)
    (- divided (- (mixed_most + other_most - both_least))).

(** What a product may return of v w: cut by less than [cut] units, and not below 0 for numbers that are not. *)
Definition is_product v w p := bits128 * p <= v * w < bits128 * (p + cut) /\ (0 <= v -> 0 <= w -> 0 <= p).

Lemma sum_within a b v w x y : within a v x -> within b w y -> within (sum a b) (v + w) (x + y).
Proof. unfold within, sum; cbn; rewrite !plus_IZR; intros [A1 A2] [B1 B2]; split; [lia | lra]. Qed.
Lemma negative_within a v x : within a v x -> within (negative a) (- v) (- x).
Proof. unfold within, negative; cbn; rewrite !opp_IZR; intros [A1 A2]; split; [lia | lra]. Qed.
Lemma times_within k a v x : 0 <= k -> within a v x -> within (times k a) (k * v) (IZR k * x).
Proof.
  unfold within, times; cbn [low high under over]; rewrite !mult_IZR; intros K [[A1 A0] A2]; split;
    [split; apply Z.mul_le_mono_nonneg_l; assumption |]; apply IZR_le in K.
  replace (IZR k * IZR v - IZR k * x)%R with (IZR k * (IZR v - x))%R by ring.
  split; apply Rmult_le_compat_l; lra.
Qed.

Lemma linear_low (m a b s k : R) : (a <= s <= b -> m <= a * k -> m <= b * k -> m <= s * k)%R.
Proof. intros; destruct (Rle_dec 0 k); nra. Qed.
Lemma box_low (m a b c d s t : R) : (a <= s <= b -> c <= t <= d -> m <= a * c -> m <= a * d -> m <= b * c -> m <= b * d ->
  m <= s * t)%R.
Proof.
  intros S T H1 H2 H3 H4; rewrite Rmult_comm; apply linear_low with c d; try assumption; rewrite Rmult_comm;
    apply linear_low with a b; assumption.
Qed.
Lemma box_high (m a b c d s t : R) : (a <= s <= b -> c <= t <= d -> a * c <= m -> a * d <= m -> b * c <= m -> b * d <= m ->
  s * t <= m)%R.
Proof.
  intros S T H1 H2 H3 H4; assert (- m <= (- s) * t)%R; [| lra].
  apply box_low with (- b)%R (- a)%R c d; try assumption; lra.
Qed.

Lemma corners_least p q r s (v x : R) : (IZR p <= v <= IZR q -> IZR r <= x <= IZR s -> IZR (corners least p q r s) <= v * x)%R.
Proof.
  intros; apply box_low with (IZR p) (IZR q) (IZR r) (IZR s); try assumption; rewrite <- mult_IZR; apply IZR_le; unfold corners, least; lia.
Qed.
Lemma corners_most p q r s (v x : R) : (IZR p <= v <= IZR q -> IZR r <= x <= IZR s -> v * x <= IZR (corners most p q r s))%R.
Proof.
  intros; apply box_high with (IZR p) (IZR q) (IZR r) (IZR s); try assumption; rewrite <- mult_IZR; apply IZR_le; unfold corners, most; lia.
Qed.

Lemma product_within a b v w p x y : within a v x -> within b w y -> is_product v w p ->
  within (times_range a b) p (x * y / IZR bits128).
Proof.
  intros [[A1 A2] [A3 A4]] [[B1 B2] [B3 B4]] [[P1 P2] P0].
  apply IZR_le in A1 as A1'; apply IZR_le in A2 as A2'; apply IZR_le in B1 as B1'; apply IZR_le in B2 as B2'.
  pose proof (corners_least (low a) (high a) (low b) (high b) (IZR v) (IZR w) (conj A1' A2') (conj B1' B2')) as BL.
  pose proof (corners_most (low a) (high a) (low b) (high b) (IZR v) (IZR w) (conj A1' A2') (conj B1' B2')) as BM.
  pose proof (corners_least (low a) (high a) (under b) (over b) (IZR v) (IZR w - y) (conj A1' A2') (conj B3 B4)) as ML.
  pose proof (corners_most (low a) (high a) (under b) (over b) (IZR v) (IZR w - y) (conj A1' A2') (conj B3 B4)) as MM.
  pose proof (corners_least (low b) (high b) (under a) (over a) (IZR w) (IZR v - x) (conj B1' B2') (conj A3 A4)) as OL.
  pose proof (corners_most (low b) (high b) (under a) (over a) (IZR w) (IZR v - x) (conj B1' B2') (conj A3 A4)) as OM.
  pose proof (corners_least (under a) (over a) (under b) (over b) (IZR v - x) (IZR w - y) (conj A3 A4) (conj B3 B4)) as EL.
  pose proof (corners_most (under a) (over a) (under b) (over b) (IZR v - x) (IZR w - y) (conj A3 A4) (conj B3 B4)) as EM.
  rewrite <- mult_IZR in BL, BM; apply le_IZR in BL; apply le_IZR in BM.
  assert (S0 : 0 < bits128) by reflexivity; assert (S1 : (0 < IZR bits128)%R) by (apply IZR_lt; reflexivity).
  unfold within, times_range; rewrite !ends_are; cbn [low high under over]; rewrite !divided_is.
  set (bl := corners least (low a) (high a) (low b) (high b)) in *; set (bm := corners most (low a) (high a) (low b) (high b)) in *.
  set (ml := corners least (low a) (high a) (under b) (over b)) in *; set (mm := corners most (low a) (high a) (under b) (over b)) in *.
  set (ol := corners least (low b) (high b) (under a) (over a)) in *; set (om := corners most (low b) (high b) (under a) (over a)) in *.
  set (el := corners least (under a) (over a) (under b) (over b)) in *; set (em := corners most (under a) (over a) (under b) (over b)) in *.
  split.
  - assert (L : bl / bits128 - cut <= p).
    { unfold cut in *; assert (bl / bits128 < p + 3); [| lia]; apply Z.div_lt_upper_bound; lia. }
    split; [| apply Z.div_le_lower_bound; lia].
    destruct ((0 <=? low a) && (0 <=? low b)) eqn:C; [| exact L].
    apply andb_prop in C; destruct C as [C1 C2]; apply Z.leb_le in C1; apply Z.leb_le in C2; lia.
  - apply IZR_le in P1; apply IZR_lt in P2; rewrite !mult_IZR in P1, P2; rewrite plus_IZR in P2.
    assert (E : (IZR v * IZR w - x * y = IZR v * (IZR w - y) + IZR w * (IZR v - x) - (IZR v - x) * (IZR w - y))%R) by ring.
    assert (X : (IZR bits128 * (x * y / IZR bits128) = x * y)%R) by (field; lra).
    split.
    + apply Rmult_le_reg_l with (IZR bits128); [assumption |]; rewrite Rmult_minus_distr_l, X, minus_IZR, Rmult_minus_distr_l.
      assert (D : (IZR bits128 * IZR ((ml + ol - em) / bits128) <= IZR (ml + ol - em))%R)
        by (rewrite <- mult_IZR; apply IZR_le, Z.mul_div_le; assumption).
      rewrite minus_IZR, plus_IZR in D; lra.
    + apply Rmult_le_reg_l with (IZR bits128); [assumption |]; rewrite Rmult_minus_distr_l, X.
      assert (D : (IZR (mm + om - el) <= IZR bits128 * IZR (- (- (mm + om - el) / bits128)))%R).
      { rewrite <- mult_IZR; apply IZR_le; pose proof (Z.mul_div_le (- (mm + om - el)) bits128 S0); lia. }
      rewrite minus_IZR, plus_IZR in D; lra.
Qed.

Lemma moved_within a v x k : 0 <= k -> within a v x -> within (moved_down a) (v / 2 ^ k) (x / IZR (2 ^ k)).
Proof.
  intros K [[A1 A2] [A3 A4]]; unfold within, moved_down; cbn [low high under over].
  assert (P0 : 0 < 2 ^ k) by (apply Z.pow_pos_nonneg; lia).
  assert (Q0 : (1 <= IZR (2 ^ k))%R) by (apply (IZR_le 1); lia).
  pose proof (Z.mul_div_le v (2 ^ k) P0) as D1; pose proof (Z.mul_succ_div_gt v (2 ^ k) P0) as D2; unfold Z.succ in D2.
  set (u := v / 2 ^ k) in *; set (q := 2 ^ k) in *; clearbody q u.
  split; [split; nia |].
  apply IZR_le in D1; apply IZR_lt in D2; rewrite mult_IZR in D1, D2; rewrite plus_IZR in D2; rewrite minus_IZR.
  assert (X : (x = IZR q * (x / IZR q))%R) by (field; lra).
  set (y := (x / IZR q)%R) in *; clearbody y; set (Q := IZR q) in *; clearbody Q; subst x.
  assert (U : (IZR (Z.min 0 (under a)) <= 0)%R) by (apply (IZR_le _ 0); lia).
  assert (U' : (IZR (Z.min 0 (under a)) <= IZR (under a))%R) by (apply IZR_le; lia).
  assert (O : (0 <= IZR (Z.max 0 (over a)))%R) by (apply (IZR_le 0); lia).
  assert (O' : (IZR (over a) <= IZR (Z.max 0 (over a)))%R) by (apply IZR_le; lia).
  set (mu := IZR (Z.min 0 (under a))) in *; set (mo := IZR (Z.max 0 (over a))) in *; clearbody mu mo.
  split; apply Rmult_le_reg_l with Q; try lra; nra.
Qed.
