(** What the proofs of LongSums.v and LongProducts.v share: the number that limbs are, memory with other limbs, and one step of C. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Limbs LongIntegers.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Section Totals.
Variable B : Z.
Hypothesis Base : 1 < B.

(** The number that the first n limbs are. *)
Fixpoint total (f : Z -> Z) (n : nat) : Z := match n with O => 0 | S k => total f k + f (Z.of_nat k) * B ^ Z.of_nat k end.
Definition are_digits f n := forall i, 0 <= i < n -> 0 <= f i < B.

Lemma of_S n : Z.of_nat (S n) = Z.of_nat n + 1.
Proof. lia. Qed.
Lemma power_S n : B ^ Z.of_nat (S n) = B * B ^ Z.of_nat n.
Proof. rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia; reflexivity. Qed.
Lemma power_positive n : 0 < B ^ Z.of_nat n.
Proof. apply Z.pow_pos_nonneg; lia. Qed.

Lemma total_same f g n : (forall i, 0 <= i < Z.of_nat n -> f i = g i) -> total f n = total g n.
Proof.
  induction n as [| n IH]; intros E; [reflexivity |]; cbn [total]; rewrite IH by (intros i I; apply E; lia); rewrite E by lia; reflexivity.
Qed.
Lemma total_put f n x : total (put_at f (Z.of_nat n) x) (S n) = total f n + x * B ^ Z.of_nat n.
Proof.
  cbn [total]; unfold put_at at 2; rewrite Z.eqb_refl; f_equal; apply total_same; intros j J; unfold put_at; destruct (Z.eqb_spec j (Z.of_nat n)); [lia | reflexivity].
Qed.
Lemma total_bounds f n : are_digits f (Z.of_nat n) -> 0 <= total f n < B ^ Z.of_nat n.
Proof.
  induction n as [| n IH]; intros D; [cbn; lia |].
  pose proof (power_positive n); pose proof (D (Z.of_nat n) ltac:(lia)).
  assert (0 <= total f n < B ^ Z.of_nat n) by (apply IH; intros i I; apply D; lia).
  cbn [total]; rewrite power_S; nia.
Qed.

(** A sum of limbs and of a carry is one more limb, and the next carry. *)
Lemma total_digit h n w : total (put_at h (Z.of_nat n) (w mod B)) (S n) + w / B * B ^ Z.of_nat (S n) = total h n + w * B ^ Z.of_nat n.
Proof. rewrite total_put, power_S; pose proof (Z.div_mod w B ltac:(lia)); nia. Qed.

(** Limbs behind the last are 0. *)
Definition up_to n (f : Z -> Z) i := if i <? n then f i else 0.
Lemma total_up_to f n k : total (up_to (Z.of_nat n) f) (n + k) = total f n.
Proof.
  induction k as [| k IH].
  - rewrite Nat.add_0_r; apply total_same; intros i I; unfold up_to; destruct (Z.ltb_spec i (Z.of_nat n)); lia.
  - rewrite Nat.add_succ_r; cbn [total]; rewrite IH; unfold up_to; destruct (Z.ltb_spec (Z.of_nat (n + k)) (Z.of_nat n)); lia.
Qed.
Lemma total_zeros f n k : (forall i, Z.of_nat n <= i < Z.of_nat (n + k) -> f i = 0) -> total f (n + k) = total f n.
Proof.
  induction k as [| k IH]; intros E; [rewrite Nat.add_0_r; reflexivity |]; rewrite Nat.add_succ_r in *; cbn [total].
  rewrite IH by (intros i I; apply E; lia); rewrite E by lia; lia.
Qed.
Lemma total_split f n k : total f (n + k) = total f n + B ^ Z.of_nat n * total (fun i => f (Z.of_nat n + i)) k.
Proof.
  induction k as [| k IH]; [rewrite Nat.add_0_r; cbn [total]; lia |]; rewrite Nat.add_succ_r; cbn [total]; rewrite IH, Nat2Z.inj_add, Z.pow_add_r by lia; ring.
Qed.
(** A row of n limbs and a carry behind j limbs. *)
Definition with_row (h h' : Z -> Z) c j n i := if i <? j then h i else if i <? j + n then h' (i - j) else c.
Lemma total_with_row h h' c j n : total (with_row h h' c (Z.of_nat j) (Z.of_nat n)) (j + S n) = total h j + B ^ Z.of_nat j * (total h' n + c * B ^ Z.of_nat n).
Proof.
  rewrite total_split; cbn [total]; f_equal; [| f_equal; f_equal].
  - apply total_same; intros i I; unfold with_row; destruct (Z.ltb_spec i (Z.of_nat j)); [reflexivity | lia].
  - apply total_same; intros i I; unfold with_row; destruct (Z.ltb_spec (Z.of_nat j + i) (Z.of_nat j)); [lia |].
    destruct (Z.ltb_spec (Z.of_nat j + i) (Z.of_nat j + Z.of_nat n)); [f_equal; lia | lia].
  - f_equal; unfold with_row; destruct (Z.ltb_spec (Z.of_nat j + Z.of_nat n) (Z.of_nat j)); [lia |].
    destruct (Z.ltb_spec (Z.of_nat j + Z.of_nat n) (Z.of_nat j + Z.of_nat n)); [lia | reflexivity].
Qed.

(** The last limb is no 0 where the number is as great as one of so many limbs. *)
Definition no_leading_zero (f : Z -> Z) n := n <> O -> f (Z.of_nat n - 1) <> 0.
Lemma least_size f n : are_digits f (Z.of_nat n) -> no_leading_zero f n -> n <> O -> B ^ (Z.of_nat n - 1) <= total f n.
Proof.
  intros D T N; destruct n as [| n]; [contradiction |]; specialize (T N); rewrite of_S, Z.add_simpl_r in *; cbn [total].
  assert (D' : are_digits f (Z.of_nat n)) by (intros i I; apply D; lia).
  pose proof (total_bounds f n D'); pose proof (power_positive n); pose proof (D (Z.of_nat n) ltac:(lia)); nia.
Qed.
Lemma no_zero_by_size f n : are_digits f (Z.of_nat n) -> (n <> O -> B ^ (Z.of_nat n - 1) <= total f n) -> no_leading_zero f n.
Proof.
  intros D S N; destruct n as [| n]; [contradiction |]; specialize (S N); rewrite of_S, Z.add_simpl_r in *; cbn [total] in S.
  assert (D' : are_digits f (Z.of_nat n)) by (intros i I; apply D; lia); pose proof (total_bounds f n D'); intros E; rewrite E in S; lia.
Qed.
Lemma length_fits f n r : are_digits f (Z.of_nat n) -> no_leading_zero f n -> 0 <= r -> total f n < B ^ r -> Z.of_nat n <= r.
Proof.
  intros D T R L; destruct n as [| n]; [exact R |]; pose proof (least_size f (S n) D T ltac:(discriminate)) as P.
  rewrite of_S, Z.add_simpl_r in *; assert (B ^ Z.of_nat n < B ^ r) by lia.
  apply Z.pow_lt_mono_r_iff in H; lia.
Qed.
Lemma top_limb h n : are_digits h (Z.of_nat (S n)) -> (n <> O -> B ^ (Z.of_nat n - 1) <= total h (S n)) ->
  (h (Z.of_nat n) <> 0 -> no_leading_zero h (S n)) /\ (h (Z.of_nat n) = 0 -> no_leading_zero h n /\ total h n = total h (S n)).
Proof.
  intros D L; split.
  - intros N _; rewrite of_S, Z.add_simpl_r; exact N.
  - intros E; assert (T : total h n = total h (S n)) by (cbn [total]; rewrite E; lia); split; [| exact T].
    apply no_zero_by_size; [intros i I; apply D; lia | rewrite T; exact L].
Qed.
Lemma product_least f n g k : are_digits f (Z.of_nat n) -> are_digits g (Z.of_nat k) -> no_leading_zero f n -> no_leading_zero g k -> n <> O -> k <> O ->
  B ^ (Z.of_nat n + Z.of_nat k - 2) <= total f n * total g k.
Proof.
  intros D D' T T' N K; replace (Z.of_nat n + Z.of_nat k - 2) with (Z.of_nat n - 1 + (Z.of_nat k - 1)) by ring; rewrite Z.pow_add_r by lia.
  apply Z.mul_le_mono_nonneg; try (apply Z.pow_nonneg; lia); apply least_size; assumption.
Qed.
Lemma product_fits f n g k r : are_digits f (Z.of_nat n) -> are_digits g (Z.of_nat k) -> no_leading_zero f n -> no_leading_zero g k -> n <> O -> k <> O ->
  total f n * total g k < B ^ (r - 1) -> Z.of_nat n + Z.of_nat k <= r.
Proof.
  intros D D' T T' N K L; pose proof (product_least f n g k D D' T T' N K) as P; destruct (Z.lt_ge_cases (r - 1) 0) as [R | R].
  - rewrite (Z.pow_neg_r B (r - 1) R) in L; pose proof (Z.pow_pos_nonneg B (Z.of_nat n + Z.of_nat k - 2) ltac:(lia) ltac:(lia)); lia.
  - assert (Q : B ^ (Z.of_nat n + Z.of_nat k - 2) < B ^ (r - 1)) by lia; apply Z.pow_lt_mono_r_iff in Q; lia.
Qed.
(** The highest limb that differs decides. *)
Lemma total_less f g i n : (i < n)%nat -> are_digits f (Z.of_nat n) -> are_digits g (Z.of_nat n) -> (forall j, Z.of_nat i < j < Z.of_nat n -> f j = g j) ->
  f (Z.of_nat i) < g (Z.of_nat i) -> total f n < total g n.
Proof.
  induction n as [| n IH]; intros I D D' E L; [lia |].
  assert (are_digits f (Z.of_nat n) /\ are_digits g (Z.of_nat n)) as [F G] by (split; intros j J; [apply D | apply D']; lia).
  cbn [total]; destruct (Nat.eq_dec i n) as [-> | N].
  - pose proof (total_bounds f n F); pose proof (total_bounds g n G); nia.
  - rewrite (E (Z.of_nat n)) by lia; apply Z.add_lt_mono_r, IH; try assumption; [lia | intros j J; apply E; lia].
Qed.
Lemma shorter_less f g n k : (n < k)%nat -> are_digits f (Z.of_nat n) -> are_digits g (Z.of_nat k) -> no_leading_zero g k -> total f n < total g k.
Proof.
  intros L D D' T; pose proof (total_bounds f n D); pose proof (least_size g k D' T ltac:(lia)).
  pose proof (Z.pow_le_mono_r B (Z.of_nat n) (Z.of_nat k - 1) ltac:(lia) ltac:(lia)); lia.
Qed.
Lemma total_zero f n : are_digits f (Z.of_nat n) -> no_leading_zero f n -> total f n = 0 -> n = O.
Proof. intros D T E; destruct n as [| n]; [reflexivity |]; pose proof (least_size f (S n) D T ltac:(discriminate)) as P;
  rewrite of_S, Z.add_simpl_r, E in P; pose proof (power_positive n); lia. Qed.
End Totals.

Section Memory.
Variable B : Z.

(** The l limbs of an array behind its k-th. *)
Definition limbs m b k l f := forall i, 0 <= i < l -> limb_at m b (k + i) = Some (f i) /\ 0 <= f i < B.

(** Nothing else changed but limbs of one array, from one to another. *)
Definition only_limbs b low high m m' := (forall p, sign_at m' p = sign_at m p) /\ (forall p, length_at m' p = length_at m p)
  /\ forall c k, c <> b \/ k < low \/ high <= k -> limb_at m' c k = limb_at m c k.

Lemma only_limbs_none b low high m : only_limbs b low high m m.
Proof. repeat split; reflexivity. Qed.
Lemma only_limbs_put b low high high' m m' k x : only_limbs b low high m m' -> high <= high' -> low <= k < high' -> only_limbs b low high' m (with_limb m' b k x).
Proof.
  intros (S & L & E) H K; repeat split; [exact S | exact L |]; intros c j C; cbn [limb_at with_limb]; unfold put_at.
  destruct (Z.eqb_spec c b) as [-> |]; [destruct (Z.eqb_spec j k) as [-> |]; [lia |] |]; apply E; lia.
Qed.
Lemma only_limbs_trans b low high low' high' m m' m'' : only_limbs b low high m m' -> only_limbs b low' high' m' m'' -> low <= low' -> high' <= high -> only_limbs b low high m m''.
Proof.
  intros (S & L & E) (S' & L' & E') Low High; split; [| split]; intros; [rewrite S'; apply S | rewrite L'; apply L | rewrite E' by lia; apply E; assumption].
Qed.
Lemma limbs_with_row m m' b j n h h' c : 0 <= j -> 0 <= n -> (0 < j -> limbs m b 0 (j + n) h) -> only_limbs b j (j + n) m m' -> limbs m' b j n h' -> 0 <= c < B ->
  limbs (with_limb m' b (0 + (n + j)) c) b 0 (j + (n + 1)) (with_row h h' c j n).
Proof.
  intros J N H (_ & _ & E) H' C i I; cbn [limb_at with_limb]; unfold put_at, with_row; rewrite Z.eqb_refl.
  destruct (Z.eqb_spec (0 + i) (0 + (n + j))), (Z.ltb_spec i j), (Z.ltb_spec i (j + n)); try lia; [split; [reflexivity | exact C] | |].
  - rewrite E by lia; apply H; lia.
  - replace (0 + i) with (j + (i - j)) by ring; apply H'; lia.
Qed.
Lemma limbs_elsewhere b low high m m' c k l f : only_limbs b low high m m' -> c <> b -> limbs m c k l f -> limbs m' c k l f.
Proof. intros (_ & _ & E) C H i I; rewrite E by (left; exact C); apply H; exact I. Qed.
Lemma limbs_more m b k n h x : limbs m b k n h -> 0 <= x < B -> 0 <= n -> limbs (with_limb m b (k + n) x) b k (n + 1) (put_at h n x).
Proof.
  intros H X N i I; cbn [limb_at with_limb]; unfold put_at; rewrite Z.eqb_refl.
  destruct (Z.eqb_spec i n), (Z.eqb_spec (k + i) (k + n)); try lia; [split; [reflexivity | exact X] |]; apply H; lia.
Qed.
Lemma limbs_fewer m b k n l h : limbs m b k l h -> n <= l -> limbs m b k n h.
Proof. intros H N i I; apply H; lia. Qed.
Lemma limbs_digits m b k l f : limbs m b k l f -> are_digits B f l.
Proof. intros H i I; apply H; exact I. Qed.
End Memory.

(** ** Numbers. *)

Section Numbers.
Variables (B : Z) (owned room : Z -> Z).

(** The limbs of a number, the last no 0; and the number itself. *)
Definition has_size m p n f := length_at m p = Some (Z.of_nat n) /\ limbs B m (owned p) 0 (Z.of_nat n) f /\ no_leading_zero f n
  /\ Z.of_nat n <= room (owned p).
Definition is_value m p z := exists s n f, sign_at m p = Some s /\ (s = -1 \/ s = 0 \/ s = 1) /\ (s = 0 <-> n = O) /\ has_size m p n f /\ z = s * total B f n.

(** Nothing else changed but a number: no other number, and no limb outside its room. *)
Definition changes_only p m m' := (forall q, q <> p -> sign_at m' q = sign_at m q /\ length_at m' q = length_at m q)
  /\ forall c k, c <> owned p \/ k < 0 \/ room c <= k -> limb_at m' c k = limb_at m c k.

Lemma changes_of_limbs p high m m' : only_limbs (owned p) 0 high m m' -> high <= room (owned p) -> changes_only p m m'.
Proof. intros (S & L & E) H; split; [intros q _; split; [apply S | apply L] |]; intros c k C; apply E; destruct (Z.eq_dec c (owned p)) as [-> |]; lia. Qed.
Lemma changes_with_length p m m' z : changes_only p m m' -> changes_only p m (with_length m' p z).
Proof.
  intros (N & E); split; [| exact E]; intros q Q; cbn [sign_at length_at with_length]; unfold put_at; destruct (Z.eqb_spec q p); [contradiction | apply N; exact Q].
Qed.
Lemma changes_with_sign p m m' z : changes_only p m m' -> changes_only p m (with_sign m' p z).
Proof.
  intros (N & E); split; [| exact E]; intros q Q; cbn [sign_at length_at with_sign]; unfold put_at; destruct (Z.eqb_spec q p); [contradiction | apply N; exact Q].
Qed.
Lemma changes_trans p m m' m'' : changes_only p m m' -> changes_only p m' m'' -> changes_only p m m''.
Proof.
  intros (N & E) (N' & E'); split; [intros q Q; destruct (N' q Q) as [-> ->]; exact (N q Q) |].
  intros c k C; rewrite E' by exact C; apply E; exact C.
Qed.
Lemma size_elsewhere p m m' q n f : changes_only p m m' -> q <> p -> owned q <> owned p -> has_size m q n f -> has_size m' q n f.
Proof.
  intros (N & E) Q O (L & F & T & R); split; [rewrite (proj2 (N q Q)); exact L | split; [| split; assumption]].
  intros i I; rewrite E by (left; exact O); apply F; exact I.
Qed.
Lemma value_elsewhere p m m' q z : changes_only p m m' -> q <> p -> owned q <> owned p -> is_value m q z -> is_value m' q z.
Proof.
  intros C Q O (s & n & f & S & S1 & S0 & H & E); exists s, n, f; rewrite (proj1 (proj1 C q Q)).
  pose proof (size_elsewhere p m m' q n f C Q O H); tauto.
Qed.

(** The carry behind the last limb becomes a limb unless it is 0, and the length is set. *)
Lemma last_carry p m m' n h c z (Base : 1 < B) : 0 <= room (owned p) -> only_limbs (owned p) 0 (Z.of_nat n) m m' -> limbs B m' (owned p) 0 (Z.of_nat n) h ->
  Z.of_nat n <= room (owned p) -> 0 <= c < B -> total B h n + c * B ^ Z.of_nat n = z -> z < B ^ room (owned p) -> (n <> O -> B ^ (Z.of_nat n - 1) <= z) ->
  (c = 0 -> let m'' := with_length m' p (Z.of_nat n) in has_size m'' p n h /\ total B h n = z /\ changes_only p m m'')
  /\ (c <> 0 -> Z.of_nat n < room (owned p) /\ let m'' := with_length (with_limb m' (owned p) (0 + Z.of_nat n) c) p (Z.of_nat n + 1) in
    has_size m'' p (S n) (put_at h (Z.of_nat n) c) /\ total B (put_at h (Z.of_nat n) c) (S n) = z /\ changes_only p m m'').
Proof.
  intros P Only H N C E Fits Least; pose proof (limbs_digits _ _ _ _ _ _ H) as D; split.
  - intros ->; rewrite Z.mul_0_l, Z.add_0_r in E; split; [| split; [exact E | apply changes_with_length, changes_of_limbs with (Z.of_nat n); assumption]].
    split; [cbn; unfold put_at; rewrite Z.eqb_refl; reflexivity |]; split; [exact H |]; split; [| exact N].
    apply (no_zero_by_size B Base h n D); rewrite E; exact Least.
  - intros NZ; pose proof (limbs_more B m' (owned p) 0 (Z.of_nat n) h c H ltac:(lia) ltac:(lia)) as H'; rewrite <- of_S in H'.
    assert (E' : total B (put_at h (Z.of_nat n) c) (S n) = z) by (rewrite total_put; exact E).
    assert (T : no_leading_zero (put_at h (Z.of_nat n) c) (S n)) by (intros _; rewrite of_S, Z.add_simpl_r; unfold put_at; rewrite Z.eqb_refl; exact NZ).
    pose proof (length_fits B Base _ (S n) (room (owned p)) (limbs_digits _ _ _ _ _ _ H') T P ltac:(lia)) as F.
    split; [lia |]; rewrite <- of_S; split; [split; [cbn [length_at with_length]; unfold put_at; rewrite Z.eqb_refl; reflexivity |]; split; [exact H' | split; assumption] |].
    split; [exact E' |]; apply changes_with_length, changes_of_limbs with (Z.of_nat (S n)); [apply only_limbs_put with (Z.of_nat n); [exact Only | lia | lia] | exact F].
Qed.
Lemma size_zero m p n f (Base : 1 < B) : has_size m p n f -> (n = O <-> total B f n = 0).
Proof. intros (_ & F & T & _); split; [intros ->; reflexivity | apply (total_zero B Base f n (limbs_digits _ _ _ _ _ _ F) T)]. Qed.
Lemma value_signed m p s n f : has_size m p n f -> s = -1 \/ s = 0 \/ s = 1 -> (s = 0 <-> n = O) -> is_value (with_sign m p s) p (s * total B f n).
Proof. intros H S Z; exists s, n, f; repeat (split; [solve [assumption | cbn [sign_at with_sign]; unfold put_at; rewrite Z.eqb_refl; reflexivity] |]); reflexivity. Qed.
End Numbers.

(** Signs of sums: alike, and opposite. *)
Definition order_of a c := match Z.compare a c with Lt => -1 | Eq => 0 | Gt => 1 end.
Definition is_sign s := s = -1 \/ s = 0 \/ s = 1.
Lemma alike_signs s r F G : is_sign s -> is_sign r -> 0 <= F -> 0 <= G -> (s = 0 <-> F = 0) -> (r = 0 <-> G = 0) -> 0 <= s * r ->
  let t := if s =? 0 then r else s in Z.abs (s * F + r * G) = F + G /\ is_sign t /\ (t = 0 <-> F + G = 0) /\ s * F + r * G = t * (F + G).
Proof. intros [-> | [-> | ->]] [-> | [-> | ->]]; unfold is_sign; cbn [Z.eqb]; cbv zeta; lia. Qed.
Lemma opposite_signs s r F G : is_sign s -> is_sign r -> s * r < 0 -> s * F + r * G = s * (F - G) /\ s * F + r * G = r * (G - F) /\ s <> 0 /\ r <> 0.
Proof. intros [-> | [-> | ->]] [-> | [-> | ->]]; lia. Qed.

(** ** One step. *)

Section Steps.
Variables (bits : Z) (owned room : Z -> Z).
Variable call : string -> list content -> memory -> (option content -> memory -> Prop) -> Prop.
Notation ends := (ends bits owned room call).
Variables (now : variables) (m : memory) (Q : variables -> memory -> Prop) (R : option content -> memory -> Prop).

Lemma ends_skip : Q now m -> ends Skip now m Q R.
Proof. exact (fun H => H). Qed.
Lemma ends_then a b : ends a now m (fun now m => ends b now m Q R) R -> ends (Then a b) now m Q R.
Proof. exact (fun H => H). Qed.
Lemma ends_block a : ends a now m (fun now' m => Q (skipn (List.length now' - List.length now) now') m) R -> ends (Block a) now m Q R.
Proof. exact (fun H => H). Qed.
Lemma ends_new t n : Q ((n, Nothing t) :: now) m -> ends (Names (Is t) n None) now m Q R.
Proof. exact (fun H => H). Qed.
Lemma ends_names k n e : result bits owned room call now m e (fun v m => as_form bits k v (fun c => Q ((n, c) :: now) m)) -> ends (Names k n (Some e)) now m Q R.
Proof. intros H; destruct k; exact H. Qed.
Lemma ends_puts t e : result bits owned room call now m e (fun v m => put_into bits owned room now m t v Q) -> ends (Puts t "" e) now m Q R.
Proof. exact (fun H => H). Qed.
Lemma ends_puts_by t o e : is "" o = false -> value bits owned room now m t (fun x => value bits owned room now m e (fun y =>
  infixed bits room o x y (fun v => put_into bits owned room now m t v Q))) -> ends (Puts t o e) now m Q R.
Proof. cbn; intros ->; exact (fun H => H). Qed.
Lemma ends_next b i e : mentions i e = false -> value bits owned room now m e (fun v => put_into bits owned room now m (Part (Named b) (Named i)) v (fun now m =>
  value bits owned room now m (Infix "+" (Named i) (Constant Int 1)) (fun v => put_into bits owned room now m (Named i) v Q))) -> ends (PutsNext b i e) now m Q R.
Proof. split; assumption. Qed.
Lemma ends_calls f given : values bits owned room now m given (fun l => call f l m (fun _ m => Q now m)) -> ends (Calls f given) now m Q R.
Proof. exact (fun H => H). Qed.
Lemma ends_branch c a b : value bits owned room now m c (fun x => match x with
  | Holds _ z => if z =? 0 then ends b now m Q R else ends a now m Q R | _ => False end) -> ends (Branch c a b) now m Q R.
Proof. exact (fun H => H). Qed.
Lemma ends_gives : R None m -> ends (Gives None) now m Q R.
Proof. exact (fun H => H). Qed.
Lemma ends_gives_value e : value bits owned room now m e (fun v => R (Some v) m) -> ends (Gives (Some e)) now m Q R.
Proof. exact (fun H => H). Qed.
End Steps.

(** What a wide number has room for. *)
Lemma wide_small bits z : 0 <= bits -> 0 <= z < 2 ^ bits * 2 ^ bits -> z mod 2 ^ (2 * bits) = z.
Proof. intros P H; apply Z.mod_small; replace (2 * bits) with (bits + bits) by ring; rewrite Z.pow_add_r by assumption; exact H. Qed.
Lemma carry_small B w : 1 < B -> 0 <= w < B * B -> 0 <= w / B < B.
Proof. intros H W; split; [apply Z.div_pos | apply Z.div_lt_upper_bound]; lia. Qed.
Lemma row_fits B a factor t c : 0 <= a < B -> 0 <= factor < B -> 0 <= t < B -> 0 <= c < B -> 0 <= a * factor < B * B /\ 0 <= a * factor + t < B * B /\ 0 <= c + (a * factor + t) < B * B.
Proof. intros; nia. Qed.

(** One limb of a difference, and the borrow. *)
Lemma one_mod B : 1 < B -> 1 mod B = 1.
Proof. intros H; apply Z.mod_small; lia. Qed.
Lemma borrow_step B a t c : 1 < B -> 0 <= a < B -> 0 <= t < B -> 0 <= c <= 1 -> exists x c', ((a - t) mod B - c) mod B = x
  /\ Z.lor (if a <? t then 1 else 0) (if (a - t) mod B <? c then 1 else 0) mod B = c' /\ 0 <= x < B /\ 0 <= c' <= 1 /\ a - t - c = x - c' * B.
Proof.
  intros H A T C.
  assert (rest : (a - t) mod B = if a <? t then a - t + B else a - t).
  { destruct (Z.ltb_spec a t); [symmetry; apply Z.mod_unique with (-1); lia | apply Z.mod_small; lia]. }
  rewrite rest; destruct (Z.ltb_spec a t).
  - destruct (Z.ltb_spec (a - t + B) c); [lia |]; exists (a - t + B - c), 1; cbn [Z.lor]; rewrite (Z.mod_small (_ - c)), one_mod by lia; lia.
  - destruct (Z.ltb_spec (a - t) c); [exists (B - 1), 1 | exists (a - t - c), 0]; cbn [Z.lor]; rewrite ?one_mod, ?Zmod_0_l by lia.
    + replace (a - t - c) with (-1) by lia; replace ((-1) mod B) with (B - 1) by (apply Z.mod_unique with (-1); lia); lia.
    + rewrite Z.mod_small by lia; lia.
Qed.

(** Values of expressions, of which the numbers stay as they are. *)
Ltac evaluated := cbv [result values value named_value infixed arithmetic shifted made turned of_type truth same_type common_type size put_into with_content
  as_form type_in in_common field_of append is is_in existsb look String.eqb Ascii.eqb Bool.eqb orb negb andb skipn List.length Nat.sub bind_all];
  cbn [sign_at length_at limb_at with_limb with_sign with_length].

Ltac act := lazymatch goal with
  | |- ends _ _ _ _ Skip _ _ _ _ => apply ends_skip
  | |- ends _ _ _ _ (Then _ _) _ _ _ _ => apply ends_then
  | |- ends _ _ _ _ (Block _) _ _ _ _ => apply ends_block
  | |- ends _ _ _ _ (Names _ _ None) _ _ _ _ => apply ends_new
  | |- ends _ _ _ _ (Names _ _ _) _ _ _ _ => apply ends_names
  | |- ends _ _ _ _ (Puts _ "" _) _ _ _ _ => apply ends_puts
  | |- ends _ _ _ _ (Puts _ _ _) _ _ _ _ => apply ends_puts_by; [reflexivity |]
  | |- ends _ _ _ _ (PutsNext _ _ _) _ _ _ _ => apply ends_next; [reflexivity |]
  | |- ends _ _ _ _ (Calls _ _) _ _ _ _ => apply ends_calls
  | |- ends _ _ _ _ (Branch _ _ _) _ _ _ _ => apply ends_branch
  | |- ends _ _ _ _ (Gives None) _ _ _ _ => apply ends_gives
  | |- ends _ _ _ _ (Gives _) _ _ _ _ => apply ends_gives_value end; evaluated.

(** What C asks of numbers. *)
Ltac sides := repeat lazymatch goal with |- _ /\ _ => split; [lia |] end.

(** What holds before the first turn of a loop over limbs. *)
Ltac starts := split; [lia |]; split; [apply only_limbs_none |]; split; [intros ? ?; lia |]; split; [lia |]; split; [cbn; lia | reflexivity].

(** A call of a function of a list: its text. *)
Lemma called_text bits owned room l d n r given m K : look n l = Some r ->
  bind_all bits (gets r) given (fun now => ends bits owned room (called bits owned room l d) (acts r) now m (fun _ m => K None m)
    (fun v m => match v, gives r with None, None => K None m | Some c, Some t => as_form bits (Is t) c (fun c => K (Some c) m) | _, _ => False end)) ->
  called bits owned room l (S d) n given m K.
Proof. intros E H; cbn [called]; rewrite E; exact H. Qed.
(** Two calls are the same where their arguments are: no text is run to compare them, so that a wrong text is refused at once. *)
Global Opaque called.
Ltac begins l n := let r := eval vm_compute in (look n l) in lazymatch r with
  | Some ?r => apply (called_text _ _ _ l _ n r); [vm_compute; reflexivity |]; cbn [gets acts gives]; evaluated end.
