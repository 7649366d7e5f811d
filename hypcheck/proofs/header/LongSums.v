(** The functions of the header that compare, add and subtract long integers: Coq reads their text and runs it, for limbs of 32 and of
    64 bits and any number of them. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Limbs LongIntegers LongRuns.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** Their text. *)
Definition texts := map (fun text => routine_of (string_of text)) HeaderText.integers.
Definition routines := Eval vm_compute in match every texts with Some l => l | None => [] end.
Theorem texts_are_read : texts = map Some routines.
Proof. vm_cast_no_check (eq_refl (map Some routines)). Qed.

Section Sums.
Variable bits : Z.
Hypothesis Bits : bits = 32 \/ bits = 64.
Variables owned room : Z -> Z.
Hypothesis Few : forall b, room b < 2 ^ 20.
Notation B := (2 ^ bits).
Let base : 1 < B.
Proof. destruct Bits as [-> | ->]; reflexivity. Qed.
Notation called := (called bits owned room routines).
Notation has_size := (has_size B owned room).
Notation is_value := (is_value B owned room).
Notation changes_only := (changes_only owned room).

(** The sum of sizes. *)
Theorem add_sizes_text d m p q r n f k g (K : option content -> memory -> Prop) :
  owned q <> owned p -> owned r <> owned p -> has_size m q n f -> has_size m r k g -> (k <= n)%nat -> 0 <= room (owned p) ->
  total B f n + total B g k < B ^ room (owned p) ->
  (forall m' l h, has_size m' p l h -> total B h l = total B f n + total B g k -> changes_only p m m' -> K None m') ->
  called (S d) "hc_add_sizes" [To p; To q; To r] m K.
Proof.
  intros Apart Apart' (Length & F & Leading & Room) (Length' & G & Leading' & Room') Shorter P Fits Post.
  pose proof (Few (owned p)) as few; pose proof (Few (owned q)) as few'.
  pose proof (limbs_digits _ _ _ _ _ _ F) as Digits; pose proof (total_bounds B base f n Digits) as Size.
  pose proof (limbs_digits _ _ _ _ _ _ G) as Digits'; pose proof (total_bounds B base g k Digits') as Size'.
  assert (n_fits : Z.of_nat n <= room (owned p)) by (apply (length_fits B base f); try assumption; lia).
  set (g' := up_to (Z.of_nat k) g).
  assert (T' : total B g' n = total B g k) by (unfold g'; replace n with (k + (n - k))%nat by lia; apply total_up_to).
  set (I := fun left (now : variables) m' => exists i h c, (i + left = n)%nat /\ only_limbs (owned p) 0 (Z.of_nat i) m m' /\ limbs B m' (owned p) 0 (Z.of_nat i) h
    /\ 0 <= c <= 1 /\ total B h i + c * B ^ Z.of_nat i = total B f i + total B g' i
    /\ now = [("i", Holds Int (Z.of_nat i)); ("carry", Holds Wide c); ("sum", To p); ("longer", To q); ("shorter", To r)]).
  begins routines "hc_add_sizes"; do 5 act; rewrite Zmod_0_l; act.
  apply loop_ends with (I := I) (n := n).
  - exists 0%nat, f, 0; starts.
  - intros left now m' K' (i & h & c & N & Only & H & C & E & ->) Next; evaluated.
    exists (Z.of_nat n); split; [rewrite (proj1 (proj2 Only)); exact Length |]; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat n)) as [_ |]; [cbn [Z.eqb] | lia].
    destruct (limbs_elsewhere _ _ _ _ _ _ _ _ _ _ Only Apart F (Z.of_nat i) ltac:(lia)) as [R D].
    assert (turn : 0 <= g' (Z.of_nat i) < B -> let w := c + f (Z.of_nat i) + g' (Z.of_nat i) in
      K' [("i", Holds Int (Z.of_nat i + 1)); ("carry", Holds Wide (w / B)); ("sum", To p); ("longer", To q); ("shorter", To r)]
        (with_limb m' (owned p) (0 + Z.of_nat i) (w mod B))).
    { intros D' w; apply Next; exists (S i), (put_at h (Z.of_nat i) (w mod B)), (w / B); rewrite total_digit, !of_S by exact base.
      split; [lia |]; split; [eapply only_limbs_put; [exact Only | lia | lia] |].
      split; [apply limbs_more; [exact H | apply Z.mod_pos_bound; lia | lia] |].
      split; [split; [apply Z.div_pos | apply Z.lt_succ_r, Z.div_lt_upper_bound]; lia |].
      split; [cbn [total]; lia | reflexivity]. }
    assert (square : 4 * B <= B * B) by (destruct Bits as [-> | ->]; discriminate).
    do 3 act; sides; exists (f (Z.of_nat i)); split; [exact R |]; rewrite wide_small by lia.
    do 2 act; exists (Z.of_nat k); split; [rewrite (proj1 (proj2 Only)); exact Length' |].
    assert (V : g' (Z.of_nat i) = if Z.of_nat i <? Z.of_nat k then g (Z.of_nat i) else 0) by reflexivity; rewrite V in turn; clear V.
    destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat k)) as [In_ | Out]; cbn [Z.eqb].
    + destruct (limbs_elsewhere _ _ _ _ _ _ _ _ _ _ Only Apart' G (Z.of_nat i) ltac:(lia)) as [R' D'].
      act; sides; exists (g (Z.of_nat i)); split; [exact R' |]; rewrite wide_small by lia.
      do 2 act; sides; do 2 act; sides; do 2 act; sides. exact (turn D').
    + do 3 act; sides; do 2 act; sides; do 2 act; sides. rewrite Z.add_0_r in turn; apply turn; lia.
  - intros now m' (i & h & c & N & Only & H & C & E & ->); evaluated.
    exists (Z.of_nat n); split; [rewrite (proj1 (proj2 Only)); exact Length |]; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat n)) as [| _]; [lia | cbn [Z.eqb]].
    replace i with n in * by lia; rewrite T' in E.
    destruct (last_carry B owned room p m m' n h c _ base P Only H n_fits ltac:(lia) E Fits) as [None_ Some_].
    { intros N0; pose proof (least_size B base f n Digits Leading N0); lia. }
    do 2 act; destruct (Z.eqb_spec c 0) as [-> | NZ].
    + destruct (None_ eq_refl) as (S & T & Ch); do 4 act; exact (Post _ _ _ S T Ch).
    + destruct (Some_ NZ) as (Room'' & S & T & Ch); act; rewrite (Z.mod_small c) by lia; sides; do 3 act; exact (Post _ _ _ S T Ch).
Qed.

(** The difference of sizes. *)
Theorem subtract_sizes_text d m p q r n f k g (K : option content -> memory -> Prop) :
  owned q <> owned p -> owned r <> owned p -> has_size m q n f -> has_size m r k g -> (k <= n)%nat -> Z.of_nat n <= room (owned p) ->
  total B g k <= total B f n ->
  (forall m' l h, has_size m' p l h -> total B h l = total B f n - total B g k -> changes_only p m m' -> K None m') ->
  called (S d) "hc_subtract_sizes" [To p; To q; To r] m K.
Proof.
  intros Apart Apart' (Length & F & Leading & Room) (Length' & G & Leading' & Room') Shorter n_fits Order Post.
  pose proof (Few (owned p)) as few; pose proof (Few (owned q)) as few'.
  pose proof (limbs_digits _ _ _ _ _ _ F) as Digits; pose proof (total_bounds B base f n Digits) as Size.
  pose proof (limbs_digits _ _ _ _ _ _ G) as Digits'.
  set (g' := up_to (Z.of_nat k) g).
  assert (T' : total B g' n = total B g k) by (unfold g'; replace n with (k + (n - k))%nat by lia; apply total_up_to).
  set (I := fun left (now : variables) m' => exists i h c, (i + left = n)%nat /\ only_limbs (owned p) 0 (Z.of_nat i) m m' /\ limbs B m' (owned p) 0 (Z.of_nat i) h
    /\ 0 <= c <= 1 /\ total B h i - c * B ^ Z.of_nat i = total B f i - total B g' i
    /\ exists l, (l <= i)%nat /\ no_leading_zero h l /\ (forall j, Z.of_nat l <= j < Z.of_nat i -> h j = 0)
    /\ now = [("length", Holds Int (Z.of_nat l)); ("i", Holds Int (Z.of_nat i)); ("borrow", Holds Limb c); ("difference", To p); ("larger", To q); ("smaller", To r)]).
  begins routines "hc_subtract_sizes"; do 7 act; rewrite Zmod_0_l; act.
  apply loop_ends with (I := I) (n := n).
  - exists 0%nat, f, 0; split; [lia |]; split; [apply only_limbs_none |]; split; [intros ? ?; lia |]; split; [lia |]; split; [cbn; lia |].
    exists 0%nat; split; [lia |]; split; [intros E; contradiction |]; split; [lia | reflexivity].
  - intros left now m' K' (i & h & c & N & Only & H & C & E & l & L & Lead & Zeros & ->) Next; evaluated.
    exists (Z.of_nat n); split; [rewrite (proj1 (proj2 Only)); exact Length |]; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat n)) as [_ |]; [cbn [Z.eqb] | lia].
    destruct (limbs_elsewhere _ _ _ _ _ _ _ _ _ _ Only Apart F (Z.of_nat i) ltac:(lia)) as [R D].
    assert (V : g' (Z.of_nat i) = if Z.of_nat i <? Z.of_nat k then g (Z.of_nat i) else 0) by reflexivity.
    do 4 act; sides; exists (f (Z.of_nat i)); split; [exact R |]; act; exists (Z.of_nat k); split; [rewrite (proj1 (proj2 Only)); exact Length' |].
    assert (D' : 0 <= g' (Z.of_nat i) < B).
    { rewrite V; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat k)); [apply Digits'; lia | lia]. }
    destruct (borrow_step B (f (Z.of_nat i)) (g' (Z.of_nat i)) c base D D' C) as (x & c' & X & C'' & X0 & C0 & E').
    assert (turn : forall e, (e <= S i)%nat -> no_leading_zero (put_at h (Z.of_nat i) x) e -> (forall j, Z.of_nat e <= j < Z.of_nat (S i) -> put_at h (Z.of_nat i) x j = 0) ->
      K' [("length", Holds Int (Z.of_nat e)); ("i", Holds Int (Z.of_nat i + 1)); ("borrow", Holds Limb c'); ("difference", To p); ("larger", To q); ("smaller", To r)]
        (with_limb m' (owned p) (0 + Z.of_nat i) x)).
    { intros e L' Lead' Zeros'; apply Next; exists (S i), (put_at h (Z.of_nat i) x), c'; rewrite total_put, power_S, !of_S by exact base.
      split; [lia |]; split; [eapply only_limbs_put; [exact Only | lia | lia] |]; split; [apply limbs_more; [exact H | exact X0 | lia] |]; split; [exact C0 |].
      split; [cbn [total]; apply (f_equal (fun z => z * B ^ Z.of_nat i)) in E'; lia |].
      exists e; split; [exact L' |]; split; [exact Lead' |]; rewrite <- of_S; split; [exact Zeros' | reflexivity]. }
    destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat k)) as [In_ | Out]; cbn [Z.eqb];
      [destruct (limbs_elsewhere _ _ _ _ _ _ _ _ _ _ Only Apart' G (Z.of_nat i) ltac:(lia)) as [R' _]; sides; exists (g (Z.of_nat i)); split; [exact R' |]
      | rewrite Zmod_0_l]; rewrite <- V.
    all: do 4 act; rewrite X; do 2 act; rewrite C''; do 2 act; sides; do 2 act; destruct (Z.eqb_spec x 0) as [-> | NZ];
      [do 3 act; sides; apply turn; [lia | |] | act; sides; do 2 act; sides; rewrite <- (of_S i) at 1; apply turn; [lia | |]].
    1, 5: intros L0; unfold put_at; destruct (Z.eqb_spec (Z.of_nat l - 1) (Z.of_nat i)); [lia | exact (Lead L0)].
    1, 4: intros j J; unfold put_at; destruct (Z.eqb_spec j (Z.of_nat i)); [reflexivity | apply Zeros; lia].
    1, 3: intros _; rewrite of_S, Z.add_simpl_r; unfold put_at; rewrite Z.eqb_refl; exact NZ.
    all: intros j J; lia.
  - intros now m' (i & h & c & N & Only & H & C & E & l & L & Lead & Zeros & ->); evaluated.
    exists (Z.of_nat n); split; [rewrite (proj1 (proj2 Only)); exact Length |]; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat n)) as [| _]; [lia | cbn [Z.eqb]].
    replace i with n in * by lia; rewrite T' in E; pose proof (total_bounds B base h n (limbs_digits _ _ _ _ _ _ H)) as Size'.
    assert (c = 0) by (assert (cases : c = 0 \/ c = 1) by lia; destruct cases; subst c; lia); subst c.
    assert (T : total B h l = total B f n - total B g k).
    { pose proof (total_zeros B h l (n - l)) as Z'; replace (l + (n - l))%nat with n in Z' by lia; rewrite <- Z' by exact Zeros; lia. }
    do 3 act; refine (Post _ l h _ T _).
    + split; [cbn [length_at with_length]; unfold put_at; rewrite Z.eqb_refl; reflexivity |]; split; [eapply limbs_fewer; [exact H | lia] |].
      split; [exact Lead | lia].
    + apply changes_with_length, changes_of_limbs with (Z.of_nat n); assumption.
Qed.

(** Which size is less: -1, 0 or 1. Both may be the same number. *)
Theorem compare_sizes_text d m q r n f k g (K : option content -> memory -> Prop) : has_size m q n f -> has_size m r k g ->
  K (Some (Holds Int (order_of (total B f n) (total B g k)))) m -> called (S d) "hc_compare_sizes" [To q; To r] m K.
Proof.
  intros (Length & F & Leading & Room) (Length' & G & Leading' & Room') Post.
  pose proof (limbs_digits _ _ _ _ _ _ F) as Digits; pose proof (limbs_digits _ _ _ _ _ _ G) as Digits'.
  pose proof (Few (owned q)) as few; pose proof (Few (owned r)) as few'.
  assert (less : total B f n < total B g k -> K (Some (Holds Int (-1))) m) by (intros L; unfold order_of in Post; rewrite (proj2 (Z.compare_lt_iff _ _) L) in Post; exact Post).
  assert (more : total B g k < total B f n -> K (Some (Holds Int 1)) m) by (intros L; unfold order_of in Post; rewrite (proj2 (Z.compare_gt_iff _ _) L) in Post; exact Post).
  begins routines "hc_compare_sizes"; do 4 act; exists (Z.of_nat n); split; [exact Length |]; exists (Z.of_nat k); split; [exact Length' |].
  destruct (Z.eqb_spec (Z.of_nat n) (Z.of_nat k)) as [Same | Differ]; cbn [negb Z.eqb].
  2: { act; exists (Z.of_nat n); split; [exact Length |]; exists (Z.of_nat k); split; [exact Length' |].
    destruct (Z.ltb_spec (Z.of_nat n) (Z.of_nat k)); cbn [Z.eqb]; sides.
    - apply less, shorter_less; assumption || lia.
    - apply more, shorter_less; assumption || lia. }
  apply Nat2Z.inj in Same; subst k; do 4 act; exists (Z.of_nat n); split; [exact Length |]; sides.
  apply loop_ends with (I := fun left (now : variables) m' => (left <= n)%nat /\ m' = m /\ (forall j, Z.of_nat left <= j < Z.of_nat n -> f j = g j)
    /\ now = [("i", Holds Int (Z.of_nat left - 1)); ("left", To q); ("right", To r)]) (n := n).
  - split; [lia |]; split; [reflexivity |]; split; [lia | reflexivity].
  - intros left now m' K' (L & -> & E & ->) Next; rewrite of_S, Z.add_simpl_r; evaluated; destruct (Z.leb_spec 0 (Z.of_nat left)) as [_ |]; [cbn [Z.eqb] | lia].
    destruct (F (Z.of_nat left) ltac:(lia)) as [R D]; destruct (G (Z.of_nat left) ltac:(lia)) as [R' D'].
    act; sides; exists (f (Z.of_nat left)); split; [exact R |]; sides; exists (g (Z.of_nat left)); split; [exact R' |].
    destruct (Z.eqb_spec (f (Z.of_nat left)) (g (Z.of_nat left))) as [Same | Differ]; cbn [negb Z.eqb].
    + do 2 act; sides; apply Next; split; [lia |]; split; [reflexivity |]; split; [| reflexivity].
      intros j J; destruct (Z.eq_dec j (Z.of_nat left)) as [-> |]; [exact Same | apply E; lia].
    + act; sides; exists (f (Z.of_nat left)); split; [exact R |]; sides; exists (g (Z.of_nat left)); split; [exact R' |].
      destruct (Z.ltb_spec (f (Z.of_nat left)) (g (Z.of_nat left))); cbn [Z.eqb]; sides.
      * apply less, (total_less B base f g left n L Digits Digits'); [intros j J; apply E; lia | assumption].
      * apply more, (total_less B base g f left n L Digits' Digits); [intros j J; symmetry; apply E; lia | lia].
  - intros now m' (_ & -> & E & ->); evaluated; change (0 <=? Z.of_nat 0 - 1) with false; cbn [Z.eqb]; do 2 act; unfold order_of in Post; rewrite (total_same B f g n) in Post by (intros j J; apply E; lia).
    rewrite Z.compare_refl in Post; exact Post.
Qed.

(** sum = left + sign right, where the sum is neither; left and right may be the same number. *)
Theorem combine_text d m p q r x y sign (K : option content -> memory -> Prop) :
  q <> p -> r <> p -> owned q <> owned p -> owned r <> owned p -> sign = 1 \/ sign = -1 -> is_value m q x -> is_value m r y ->
  0 <= room (owned p) -> Z.abs x < B ^ room (owned p) -> Z.abs y < B ^ room (owned p) -> Z.abs (x + sign * y) < B ^ room (owned p) ->
  (forall m', is_value m' p (x + sign * y) -> changes_only p m m' -> K None m') ->
  called (S (S d)) "hc_combine" [To p; To q; To r; Holds Int sign] m K.
Proof.
  intros Q R Apart Apart' Signed (s & n & f & Sign & Signs & Zero & F & ->) (t & k & g & Sign' & Signs' & Zero' & G & ->) P X Y Sum Post.
  pose proof F as (Length & F' & Leading & _); pose proof G as (Length' & G' & Leading' & _).
  pose proof (limbs_digits _ _ _ _ _ _ F') as Digits; pose proof (total_bounds B base f n Digits) as Size.
  pose proof (limbs_digits _ _ _ _ _ _ G') as Digits'; pose proof (total_bounds B base g k Digits') as Size'.
  rewrite (size_zero _ _ _ _ _ _ _ base F) in Zero; rewrite (size_zero _ _ _ _ _ _ _ base G) in Zero'.
  assert (Signs'' : is_sign (sign * t)) by (clear - Signed Signs'; unfold is_sign; destruct Signed as [-> | ->]; lia).
  assert (Zero'' : sign * t = 0 <-> total B g k = 0) by (rewrite <- Zero'; clear - Signed; destruct Signed as [-> | ->]; lia).
  assert (Product : -1 <= s * (sign * t) <= 1) by (clear - Signs Signs''; destruct Signs as [-> | [-> | ->]], Signs'' as [-> | [-> | ->]]; lia).
  rewrite Z.mul_assoc in Sum, Post.
  assert (ended : forall m' l h u, has_size m' p l h -> is_sign u -> (u = 0 <-> total B h l = 0) -> u * total B h l = s * total B f n + sign * t * total B g k ->
    changes_only p m m' -> K None (with_sign m' p u)).
  { intros m' l h u H U Zu T Ch; apply Post; [rewrite <- T; apply value_signed; [exact H | exact U |] | apply changes_with_sign; exact Ch].
    rewrite (size_zero _ _ _ _ _ _ _ base H); exact Zu. }
  set (right_sign := sign * t) in *.
  begins routines "hc_combine"; do 2 act; exists t; split; [exact Sign' |]; fold right_sign; split; [clear - Signs''; unfold is_sign in *; lia |].
  do 2 act; exists s; split; [exact Sign |]; split; [clear - Product; lia |]; destruct (Z.leb_spec 0 (s * right_sign)) as [Alike | Opposite]; cbn [Z.eqb].
  - destruct (alike_signs s right_sign (total B f n) (total B g k) Signs Signs'' ltac:(clear - Size; lia) ltac:(clear - Size'; lia) Zero Zero'' Alike) as (Abs & T1 & T2 & T3).
    rewrite Abs in Sum.
    do 3 act; exists (Z.of_nat n); split; [exact Length |]; exists (Z.of_nat k); split; [exact Length' |]; do 2 act.
    destruct (Z.ltb_spec (Z.of_nat n) (Z.of_nat k)) as [Less | Not]; cbn [Z.eqb];
      [apply (add_sizes_text d m p r q k g n f); try assumption; [clear - Less; lia | clear - Sum; lia |]
      | apply (add_sizes_text d m p q r n f k g); try assumption; [clear - Not; lia |]].
    all: intros m' l h H T Ch; rewrite ?(Z.add_comm (total B g k)) in T; do 2 act; exists s; split; [rewrite (proj1 (proj1 Ch q Q)); exact Sign |].
    all: destruct (Z.eqb_spec s 0) as [S0 | S1]; [| exists s; split; [rewrite (proj1 (proj1 Ch q Q)); exact Sign |]]; do 2 act; apply (ended _ l h); try assumption; rewrite T; try assumption; symmetry; assumption.
  - destruct (opposite_signs s right_sign (total B f n) (total B g k) Signs Signs'' Opposite) as (T1 & T2 & S0 & S1).
    assert (t <> 0) by (intros E; apply S1; unfold right_sign; rewrite E; apply Z.mul_0_r).
    assert (n_fits : Z.of_nat n <= room (owned p)).
    { apply (length_fits B base f); try assumption; clear - X Signs S0 Size; destruct Signs as [-> | [-> | ->]]; lia. }
    assert (k_fits : Z.of_nat k <= room (owned p)).
    { apply (length_fits B base g); try assumption; clear - Y Signs' H Size'; destruct Signs' as [-> | [-> | ->]]; lia. }
    clear X Y Sum Post Product Zero Zero' Zero'' Opposite Signed.
    assert (n_longer : total B g k <= total B f n -> (k <= n)%nat).
    { intros L; destruct (Nat.le_gt_cases k n) as [| N]; [assumption |]; pose proof (shorter_less B base f g n k N Digits Digits' Leading'); clear - L H0; lia. }
    assert (k_longer : total B f n < total B g k -> (n <= k)%nat).
    { intros L; destruct (Nat.le_gt_cases n k) as [| N]; [assumption |]; pose proof (shorter_less B base g f k n N Digits' Digits Leading); clear - L H0; lia. }
    do 3 act; apply compare_sizes_text with (n := n) (f := f) (k := k) (g := g); try assumption; evaluated; do 2 act.
    unfold order_of; destruct (Z.compare_spec (total B f n) (total B g k)) as [E | L | L]; cbn [Z.ltb Z.compare Z.eqb].
    + apply (subtract_sizes_text d m p q r n f k g); try assumption; [apply n_longer; clear - E; lia | clear - E; lia |]; intros m' l h H' T Ch; do 2 act; cbn [Z.ltb Z.compare Z.eqb]; do 2 act.
      apply (ended _ l h); try assumption; [unfold is_sign; tauto | rewrite T, E, Z.sub_diag; tauto | rewrite T1, E, Z.sub_diag, Z.mul_0_r; reflexivity].
    + apply (subtract_sizes_text d m p r q k g n f); try assumption; [apply k_longer; exact L | clear - L; lia |]; intros m' l h H' T Ch; do 2 act; cbn [Z.ltb Z.compare Z.eqb]; do 2 act.
      apply (ended _ l h); try assumption; [rewrite T; clear - L S0 S1; split; [contradiction | lia] | rewrite T; symmetry; exact T2].
    + apply (subtract_sizes_text d m p q r n f k g); try assumption; [apply n_longer; clear - L; lia | clear - L; lia |]; intros m' l h H' T Ch; do 2 act; cbn [Z.ltb Z.compare Z.eqb].
      exists s; split; [rewrite (proj1 (proj1 Ch q Q)); exact Sign |]; do 2 act.
      apply (ended _ l h); try assumption; [rewrite T; clear - L S0 S1; split; [contradiction | lia] | rewrite T; symmetry; exact T1].
Qed.

Section Both.
Variables (d : nat) (m : memory) (p q r x y : Z) (K : option content -> memory -> Prop).
Hypotheses (Q : q <> p) (R : r <> p) (Apart : owned q <> owned p) (Apart' : owned r <> owned p) (X : is_value m q x) (Y : is_value m r y).
Hypotheses (P : 0 <= room (owned p)) (X_fits : Z.abs x < B ^ room (owned p)) (Y_fits : Z.abs y < B ^ room (owned p)).

Theorem add_text : Z.abs (x + y) < B ^ room (owned p) -> (forall m', is_value m' p (x + y) -> changes_only p m m' -> K None m') ->
  called (S (S (S d))) "hc_add" [To p; To q; To r] m K.
Proof.
  intros F Post; begins routines "hc_add"; do 2 act; apply combine_text with (x := x) (y := y); try assumption; rewrite ?Z.mul_1_l; [left; reflexivity | exact F |].
  intros m' V C; act; exact (Post m' V C).
Qed.
Theorem subtract_text : Z.abs (x - y) < B ^ room (owned p) -> (forall m', is_value m' p (x - y) -> changes_only p m m' -> K None m') ->
  called (S (S (S d))) "hc_subtract" [To p; To q; To r] m K.
Proof.
  intros F Post; begins routines "hc_subtract"; do 2 act; split; [lia |]; change (0 - 1) with (-1).
  apply combine_text with (x := x) (y := y); try assumption; right; reflexivity.
Qed.
End Both.
End Sums.
