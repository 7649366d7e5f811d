(** The functions of the header that multiply long integers: Coq reads their text and runs it, for limbs of 32 and of
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

Section Products.
Variable bits : Z.
Hypothesis Bits : bits = 32 \/ bits = 64.
Variables owned room : Z -> Z.
Hypothesis Few : forall b, room b < 2 ^ 20.
Notation B := (2 ^ bits).
Let base : 1 < B.
Proof. destruct Bits as [-> | ->]; reflexivity. Qed.
Notation called := (called bits owned room routines).

(** to += factor from, or to = factor from for the first one; the carry is returned. *)
Theorem add_row_text d m to k from j n f g factor first (K : option content -> memory -> Prop) :
  from <> to -> limbs B m from j (Z.of_nat n) f -> 0 <= factor < B ->
  0 <= k -> k + Z.of_nat n <= room to -> 0 <= j -> j + Z.of_nat n <= room from ->
  first = 1 /\ (forall i, g i = 0) \/ first = 0 /\ limbs B m to k (Z.of_nat n) g ->
  (forall m' h c, only_limbs to k (k + Z.of_nat n) m m' -> limbs B m' to k (Z.of_nat n) h -> 0 <= c < B ->
    total B h n + c * B ^ Z.of_nat n = total B f n * factor + total B g n -> K (Some (Holds Limb c)) m') ->
  called (S d) "hc_add_row" [Into to k; Into from j; Holds Int (Z.of_nat n); Holds Limb factor; Holds Int first] m K.
Proof.
  intros Apart F Factor K0 K1 J0 J1 First Post; begins routines "hc_add_row".
  pose proof (Few to) as few.
  do 5 act; rewrite Zmod_0_l.
  set (I := fun left (now : variables) m' => exists i h c, (i + left = n)%nat /\ only_limbs to k (k + Z.of_nat i) m m' /\ limbs B m' to k (Z.of_nat i) h
    /\ 0 <= c < B /\ total B h i + c * B ^ Z.of_nat i = total B f i * factor + total B g i
    /\ now = [("i", Holds Int (Z.of_nat i)); ("carry", Holds Wide c); ("to", Into to k); ("from", Into from j); ("length", Holds Int (Z.of_nat n));
      ("factor", Holds Limb factor); ("first", Holds Int first)]).
  assert (turn : forall left m' (K' : variables -> memory -> Prop) i h w, (i + S left)%nat = n -> only_limbs to k (k + Z.of_nat i) m m' -> limbs B m' to k (Z.of_nat i) h ->
    total B h i + w * B ^ Z.of_nat i = total B f (S i) * factor + total B g (S i) -> 0 <= w < B * B -> (forall now m, I left now m -> K' now m) ->
    K' [("i", Holds Int (Z.of_nat i + 1)); ("carry", Holds Wide (w / B)); ("to", Into to k); ("from", Into from j); ("length", Holds Int (Z.of_nat n));
      ("factor", Holds Limb factor); ("first", Holds Int first)] (with_limb m' to (k + Z.of_nat i) (w mod B))).
  { intros left m' K' i h w N Only H E W Next; apply Next.
    exists (S i), (put_at h (Z.of_nat i) (w mod B)), (w / B); rewrite total_digit, !of_S by exact base.
    split; [lia |]; split; [eapply only_limbs_put; [exact Only | lia | lia] |].
    split; [apply limbs_more; [exact H | apply Z.mod_pos_bound; lia | lia] |]; split; [apply carry_small; assumption |].
    split; [exact E | reflexivity]. }
  destruct First as [[-> G] | [-> G]]; act; cbn [Z.eqb]; do 4 act.
  - apply loop_ends with (I := I) (n := n).
    + exists 0%nat, f, 0; starts.
    + intros left now m' K' (i & h & c & N & Only & H & C & E & ->) Next; evaluated; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat n)) as [_ |]; [cbn [Z.eqb] | lia].
      destruct (limbs_elsewhere _ _ _ _ _ _ _ _ _ _ Only Apart F (Z.of_nat i) ltac:(lia)) as [R D].
      destruct (row_fits B _ factor 0 c D Factor ltac:(lia) C) as (W1 & W2 & W3); rewrite Z.add_0_r in W2, W3.
      do 3 act; sides; exists (f (Z.of_nat i)); split; [exact R |]; rewrite (wide_small bits (_ * _)), wide_small by (lia || assumption).
      do 2 act; sides; do 2 act; sides; do 2 act; sides.
      eapply turn; try eassumption; cbn [total]; rewrite G; lia.
    + intros now m' (i & h & c & N & Only & H & C & E & ->); evaluated; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat n)) as [| _]; [lia | cbn [Z.eqb]].
      replace i with n in * by lia; do 3 act; rewrite Z.mod_small by exact C; eapply Post; eassumption.
  - apply loop_ends with (I := I) (n := n).
    + exists 0%nat, f, 0; starts.
    + intros left now m' K' (i & h & c & N & Only & H & C & E & ->) Next; evaluated; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat n)) as [_ |]; [cbn [Z.eqb] | lia].
      destruct (limbs_elsewhere _ _ _ _ _ _ _ _ _ _ Only Apart F (Z.of_nat i) ltac:(lia)) as [R D]; destruct (G (Z.of_nat i) ltac:(lia)) as [R' D'].
      destruct (row_fits B _ factor _ c D Factor D' C) as (W1 & W2 & W3).
      do 3 act; sides; exists (f (Z.of_nat i)); split; [exact R |]; sides; exists (g (Z.of_nat i)); split; [rewrite (proj2 (proj2 Only)) by lia; exact R' |].
      rewrite (wide_small bits (_ * _)), (wide_small bits (_ * _ + _)), wide_small by (lia || assumption).
      do 2 act; sides; do 2 act; sides; do 2 act; sides.
      eapply turn; try eassumption; cbn [total]; lia.
    + intros now m' (i & h & c & N & Only & H & C & E & ->); evaluated; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat n)) as [| _]; [lia | cbn [Z.eqb]].
      replace i with n in * by lia; do 3 act; rewrite Z.mod_small by exact C; eapply Post; eassumption.
Qed.

(** product = factor number *)
Theorem scale_text d m p q factor t z (K : option content -> memory -> Prop) :
  owned q <> owned p -> p <> q -> t = Int \/ t = Limb -> 0 < factor < B -> is_value B owned room m q z -> 0 <= room (owned p) -> Z.abs (factor * z) < B ^ room (owned p) ->
  (forall m', is_value B owned room m' p (factor * z) -> changes_only owned room p m m' -> K None m') ->
  called (S d) "hc_scale" [To p; Holds t factor; To q] m K.
Proof.
  intros Apart Other Typed Factor (s & n & f & Sign & Signs & Zero & (Length & F & Leading & Room) & ->) P Fits Post.
  pose proof (Few (owned p)) as few; pose proof (Few (owned q)) as few'.
  pose proof (limbs_digits _ _ _ _ _ _ F) as Digits; pose proof (total_bounds B base f n Digits) as Size.
  assert (absolute : Z.abs (factor * (s * total B f n)) = factor * total B f n).
  { destruct Signs as [-> | [-> | ->]]; [lia | | lia]; rewrite (proj1 Zero eq_refl); cbn [total]; lia. }
  assert (n_fits : Z.of_nat n <= room (owned p)).
  { destruct n as [| k]; [exact P |]; apply (length_fits B base f); try assumption; nia. }
  set (I := fun left (now : variables) m' => exists i h c, (i + left = n)%nat /\ only_limbs (owned p) 0 (Z.of_nat i) m m' /\ limbs B m' (owned p) 0 (Z.of_nat i) h
    /\ 0 <= c < B /\ total B h i + c * B ^ Z.of_nat i = factor * total B f i
    /\ now = [("i", Holds Int (Z.of_nat i)); ("carry", Holds Wide c); ("product", To p); ("factor", Holds Limb factor); ("number", To q)]).
  assert (run : called (S d) "hc_scale" [To p; Holds Limb factor; To q] m K).
  2: { destruct Typed as [-> | ->]; [| exact run]; begins routines "hc_scale"; rewrite (Z.mod_small factor) by lia; with_strategy transparent [LongIntegers.called] (exact run). }
  begins routines "hc_scale"; do 5 act; rewrite Zmod_0_l; act.
  apply loop_ends with (I := I) (n := n).
  - exists 0%nat, f, 0; starts.
  - intros left now m' K' (i & h & c & N & Only & H & C & E & ->) Next; evaluated.
    exists (Z.of_nat n); split; [rewrite (proj1 (proj2 Only)); exact Length |]; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat n)) as [_ |]; [cbn [Z.eqb] | lia].
    destruct (limbs_elsewhere _ _ _ _ _ _ _ _ _ _ Only Apart F (Z.of_nat i) ltac:(lia)) as [R D].
    destruct (row_fits B _ factor 0 c D ltac:(lia) ltac:(lia) C) as (W1 & W2 & W3); rewrite Z.add_0_r in W2, W3.
    do 3 act; sides; exists (f (Z.of_nat i)); split; [exact R |]; rewrite (wide_small bits (_ * _)), wide_small by (lia || assumption).
    set (w := c + f (Z.of_nat i) * factor) in *.
    do 2 act; sides; do 2 act; sides; do 2 act; sides.
    apply Next; exists (S i), (put_at h (Z.of_nat i) (w mod B)), (w / B); rewrite total_digit, !of_S by exact base.
    split; [lia |]; split; [eapply only_limbs_put; [exact Only | lia | lia] |].
    split; [apply limbs_more; [exact H | apply Z.mod_pos_bound; lia | lia] |]; split; [apply carry_small; assumption |].
    split; [unfold w; cbn [total]; lia | reflexivity].
  - intros now m' (i & h & c & N & Only & H & C & E & ->); evaluated.
    exists (Z.of_nat n); split; [rewrite (proj1 (proj2 Only)); exact Length |]; destruct (Z.ltb_spec (Z.of_nat i) (Z.of_nat n)) as [| _]; [lia | cbn [Z.eqb]].
    replace i with n in * by lia.
    destruct (last_carry B owned room p m m' n h c _ base P Only H n_fits C E) as [None_ Some_].
    { rewrite <- absolute; exact Fits. }
    { intros N0; pose proof (least_size B base f n Digits Leading N0); nia. }
    assert (ended : forall m'' k h', has_size B owned room m'' p k h' -> total B h' k = factor * total B f n -> (k = O <-> n = O) -> changes_only owned room p m m'' ->
      K None (with_sign m'' p s)).
    { intros m'' k h' S T Zk Ch; apply Post; [| apply changes_with_sign; exact Ch].
      replace (factor * (s * total B f n)) with (s * total B h' k) by (rewrite T; ring); apply value_signed; [exact S | exact Signs | rewrite Zk; exact Zero]. }
    do 2 act; destruct (Z.eqb_spec c 0) as [-> | NZ].
    + destruct (None_ eq_refl) as (S & T & Ch); do 5 act; exists s; split; [cbn [sign_at with_length with_limb]; rewrite (proj1 Only); exact Sign |]; act.
      apply (ended _ n h S T); [apply iff_refl | exact Ch].
    + destruct (Some_ NZ) as (Room' & S & T & Ch); act; rewrite (Z.mod_small c) by exact C; sides; do 4 act; exists s; split; [cbn [sign_at with_length with_limb]; rewrite (proj1 Only); exact Sign |]; act.
      apply (ended _ _ _ S T); [| exact Ch]. split; [discriminate | intros ->]; cbn in E; lia.
Qed.

(** product = left right, where the product is neither; left and right may be the same number. *)
Theorem multiply_text d m p q r x y (K : option content -> memory -> Prop) :
  q <> p -> r <> p -> owned q <> owned p -> owned r <> owned p -> is_value B owned room m q x -> is_value B owned room m r y ->
  0 <= room (owned p) -> Z.abs (x * y) < B ^ (room (owned p) - 1) ->
  (forall m', is_value B owned room m' p (x * y) -> changes_only owned room p m m' -> K None m') ->
  called (S (S d)) "hc_multiply" [To p; To q; To r] m K.
Proof.
  intros Q R Apart Apart' (s & n & f & Sign & Signs & Zero & F & ->) (t & k & g & Sign' & Signs' & Zero' & G & ->) P Fits Post.
  pose proof (Few (owned p)) as few.
  assert (Product : s * t = -1 \/ s * t = 0 \/ s * t = 1) by (clear - Signs Signs'; destruct Signs as [-> | [-> | ->]], Signs' as [-> | [-> | ->]]; lia).
  assert (Fits' : s * t <> 0 -> total B f n * total B g k < B ^ (room (owned p) - 1)).
  { intros N; replace (s * total B f n * (t * total B g k)) with (s * t * (total B f n * total B g k)) in Fits by ring.
    clear - Product N Fits; destruct Product as [E | [E | E]]; rewrite E in Fits; lia. }
  clear Fits.
  begins routines "hc_multiply".
  lazymatch goal with |- ends ?b ?o ?e ?c (Then _ (Then _ ?rest)) ?now ?m ?Q ?R =>
    assert (rows : forall u v n' f' k' g', owned u <> owned p -> owned v <> owned p -> has_size B owned room m u n' f' -> has_size B owned room m v k' g' ->
      (s * t = 0 <-> n' = O \/ k' = O) -> total B f' n' * total B g' k' = total B f n * total B g k ->
      ends b o e c rest (("shorter", To v) :: ("longer", To u) :: now) m Q R) end.
  2: { destruct F as (Length & F), G as (Length' & G).
    assert (empty : s * t = 0 <-> n = O \/ k = O) by (rewrite <- Zero, <- Zero'; apply Z.mul_eq_0).
    do 2 act; exists (Z.of_nat n); split; [exact Length |]; exists (Z.of_nat k); split; [exact Length' |].
    destruct (Z.ltb_spec (Z.of_nat n) (Z.of_nat k)) as [Less | Not]; cbn [Z.eqb].
    all: do 2 act; exists (Z.of_nat n); split; [exact Length |]; exists (Z.of_nat k); split; [exact Length' |].
    - rewrite (proj2 (Z.ltb_lt _ _) Less); cbn [Z.eqb]; apply (rows r q k g n f); try assumption; try (split; assumption); [rewrite or_comm; exact empty | apply Z.mul_comm].
    - rewrite (proj2 (Z.ltb_ge _ _) Not); cbn [Z.eqb]; apply (rows q r n f k g); try assumption; try (split; assumption); reflexivity. }
  intros u v n' f' k' g' Au Av (Lu & Fu & Hu & Ru) (Lv & Fv & Hv & Rv) Empty Value.
  do 4 act; exists (Z.of_nat n'); split; [exact Lu |]; do 4 act; exists s; split; [exact Sign |]; exists t; split; [exact Sign' |]; split; [clear - Product; lia |].
  set (m1 := with_length (with_sign m p (s * t)) p 0).
  assert (Ch : changes_only owned room p m m1) by (apply changes_with_length, changes_with_sign, changes_of_limbs with 0; [apply only_limbs_none | exact P]).
  assert (Here : sign_at m1 p = Some (s * t)) by (cbn; unfold put_at; rewrite Z.eqb_refl; reflexivity).
  assert (Lv' : length_at m1 v = Some (Z.of_nat k')) by (cbn; unfold put_at; destruct (Z.eqb_spec v p) as [-> |]; [contradiction | exact Lv]).
  do 4 act; fold m1; exists (s * t); split; [exact Here |].
  destruct (Z.eqb_spec (s * t) 0) as [Z0 | NZ]; cbn [Z.eqb].
  { act; apply Post; [| exact Ch]; exists (s * t), 0%nat, f; split; [exact Here |]; split; [exact Product |]; split; [split; [reflexivity | intros _; exact Z0] |].
    split; [split; [cbn; unfold put_at; rewrite Z.eqb_refl; reflexivity |]; split; [intros i I; lia | split; [intros E; contradiction | exact P]] |].
    replace (s * total B f n * (t * total B g k)) with (s * t * (total B f n * total B g k)) by ring; rewrite Z0; reflexivity. }
  assert (n' <> O /\ k' <> O) as [N0 K0] by (clear - NZ Empty; tauto); specialize (Fits' NZ); rewrite <- Value in Fits'.
  pose proof (limbs_digits _ _ _ _ _ _ Fu) as Du; pose proof (limbs_digits _ _ _ _ _ _ Fv) as Dv.
  pose proof (product_least B base f' n' g' k' Du Dv Hu Hv N0 K0) as Least; pose proof (product_fits B base f' n' g' k' _ Du Dv Hu Hv N0 K0 Fits') as Room.
  clear Fits' Empty Zero Zero'.
  assert (finish : forall m' h l, only_limbs (owned p) 0 (room (owned p)) m1 m' -> limbs B m' (owned p) 0 (Z.of_nat l) h -> total B h l = total B f' n' * total B g' k' ->
    (l <= n' + k')%nat -> no_leading_zero h l -> forall w, (w = m' \/ w = with_length m' p (Z.of_nat n' + Z.of_nat k')) -> K None (with_length w p (Z.of_nat l))).
  { intros m' h l Only H T L Lead w W.
    assert (C : changes_only owned room p m w).
    { apply changes_trans with m1; [exact Ch |]; destruct W as [-> | ->]; [| apply changes_with_length]; apply changes_of_limbs with (room (owned p)); try assumption; apply Z.le_refl. }
    apply Post; [| apply changes_with_length; exact C].
    exists (s * t), l, h; split; [destruct W as [-> | ->]; cbn [sign_at with_length]; rewrite (proj1 Only); exact Here |]; split; [exact Product |].
    split; [| split; [| rewrite T, Value; ring]].
    - split; [contradiction |]; intros ->; exfalso; cbn [total] in T; rewrite <- T in Least.
      pose proof (Z.pow_pos_nonneg B (Z.of_nat n' + Z.of_nat k' - 2)); clear - Least H0 base N0 K0; lia.
    - split; [cbn [length_at with_length]; unfold put_at; rewrite Z.eqb_refl; reflexivity |].
      split; [destruct W as [-> | ->]; exact H |]; split; [exact Lead | clear - L Room; lia]. }
  assert (top : forall h, are_digits B h (Z.of_nat (k' + n')) -> total B h (k' + n') = total B f' n' * total B g' k' ->
    (h (Z.of_nat n' + Z.of_nat k' - 1) <> 0 -> no_leading_zero h (k' + n'))
    /\ (h (Z.of_nat n' + Z.of_nat k' - 1) = 0 -> no_leading_zero h (k' + n' - 1) /\ total B h (k' + n' - 1) = total B h (k' + n'))).
  { intros h D T; replace (k' + n')%nat with (S (k' + n' - 1)) in * by (clear - N0; lia).
    replace (Z.of_nat n' + Z.of_nat k' - 1) with (Z.of_nat (k' + n' - 1)) by (clear - N0; lia).
    replace (S (k' + n' - 1) - 1)%nat with (k' + n' - 1)%nat by (clear; lia); apply (top_limb B base); [exact D |]; intros _; rewrite T.
    replace (Z.of_nat (k' + n' - 1) - 1) with (Z.of_nat n' + Z.of_nat k' - 2) by (clear - N0; lia); exact Least. }
  clear Product Least Value NZ Signs Signs' Post.
  do 4 act.
  set (I := fun left (now : variables) m' => exists j h, (j + left = k')%nat /\ only_limbs (owned p) 0 (room (owned p)) m1 m'
    /\ (j = O /\ (forall i, h i = 0) \/ j <> O /\ limbs B m' (owned p) 0 (Z.of_nat (j + n')) h) /\ total B h (j + n') = total B f' n' * total B g' j
    /\ now = [("j", Holds Int (Z.of_nat j)); ("length", Holds Int (Z.of_nat n')); ("limbs", Into (owned p) 0); ("shorter", To v); ("longer", To u);
      ("product", To p); ("left", To q); ("right", To r)]).
  apply loop_ends with (I := I) (n := k').
  - exists 0%nat, (fun _ => 0); split; [lia |]; split; [apply only_limbs_none |]; split; [left; split; reflexivity |]; split; [| reflexivity].
    rewrite Nat.add_0_l; pose proof (total_zeros B (fun _ => 0) 0 n' ltac:(reflexivity)) as Z'; cbn [Nat.add] in Z'; rewrite Z'; cbn [total]; lia.
  - intros left now m' K' (j & h & N & Only & H & E & ->) Next; evaluated.
    exists (Z.of_nat k'); split; [rewrite (proj1 (proj2 Only)); exact Lv' |]; destruct (Z.ltb_spec (Z.of_nat j) (Z.of_nat k')) as [_ |]; [cbn [Z.eqb] | lia].
    destruct (limbs_elsewhere _ _ _ _ _ _ _ _ _ _ Only Av Fv (Z.of_nat j) ltac:(lia)) as [R' D].
    pose proof (limbs_elsewhere _ _ _ _ _ _ _ _ _ _ Only Au Fu) as Fu'.
    assert (J : 0 <= Z.of_nat j < Z.of_nat k') by lia.
    act; split; [reflexivity |]; sides; exists (g' (Z.of_nat j)); split; [exact R' |].
    apply (add_row_text d m' (owned p) (0 + Z.of_nat j) (owned u) 0 n' f' (fun i => h (Z.of_nat j + i)) (g' (Z.of_nat j))); try assumption; try lia.
    + destruct H as [[-> Hz] | [Hj H]]; [left; split; [reflexivity | intros i; apply Hz] | right].
      split; [destruct (Z.eqb_spec (Z.of_nat j) 0); [lia | reflexivity] |]; intros i J'; rewrite Z.add_0_l; apply H; lia.
    + intros m'' h' c Only' H' C T; rewrite Z.add_0_l in Only', H'; sides; act; sides; apply Next.
      exists (S j), (with_row h h' c (Z.of_nat j) (Z.of_nat n')); split; [lia |]; split.
      { apply only_limbs_put with (room (owned p)); [| lia | lia].
        exact (only_limbs_trans _ _ _ _ _ _ _ _ Only Only' ltac:(lia) ltac:(lia)). }
      split; [right; split; [discriminate |]; replace (Z.of_nat (S j + n')) with (Z.of_nat j + (Z.of_nat n' + 1)) by lia; apply limbs_with_row with m'; try assumption; try lia |].
      { intros J0; destruct H as [[-> _] | [_ H]]; [lia |]; rewrite <- Nat2Z.inj_add; exact H. }
      split; [| rewrite of_S; reflexivity].
      replace (S j + n')%nat with (j + S n')%nat by lia; rewrite total_with_row, T by exact base; rewrite (total_split B h j n') in E by exact base; cbn [total].
      rewrite (Z.mul_add_distr_l (total B f' n')), <- E; ring.
  - intros now m' (j & h & N & Only & H & E & ->); evaluated.
    exists (Z.of_nat k'); split; [rewrite (proj1 (proj2 Only)); exact Lv' |]; destruct (Z.ltb_spec (Z.of_nat j) (Z.of_nat k')) as [| _]; [lia | cbn [Z.eqb]].
    rewrite Nat.add_0_r in N; subst j; destruct H as [[-> _] | [_ H]]; [contradiction |].
    do 2 act; exists (Z.of_nat k'); split; [rewrite (proj1 (proj2 Only)); exact Lv' |]; sides; do 2 act.
    destruct (top h (limbs_digits _ _ _ _ _ _ H) E) as [NotZero IsZero]; destruct (H (Z.of_nat n' + Z.of_nat k' - 1) ltac:(lia)) as [R' D].
    exists (Z.of_nat n' + Z.of_nat k'); split; [unfold put_at; rewrite Z.eqb_refl; reflexivity |]; sides; exists (h (Z.of_nat n' + Z.of_nat k' - 1)); split; [exact R' |].
    rewrite Zmod_0_l; destruct (Z.eqb_spec (h (Z.of_nat n' + Z.of_nat k' - 1)) 0) as [E0 | E1]; cbn [Z.eqb].
    + act; exists (Z.of_nat n' + Z.of_nat k'); split; [unfold put_at; rewrite Z.eqb_refl; reflexivity |]; sides; act.
      destruct (IsZero E0) as [Lead T]; replace (Z.of_nat n' + Z.of_nat k' - 1) with (Z.of_nat (k' + n' - 1)) by lia.
      apply (finish m' h); try assumption; [eapply limbs_fewer; [exact H | lia] | rewrite T; exact E | lia | right; reflexivity].
    + do 2 act; replace (Z.of_nat n' + Z.of_nat k') with (Z.of_nat (k' + n')) by lia.
      apply (finish m' h); try assumption; [lia | exact (NotZero E1) | left; reflexivity].
Qed.
End Products.
