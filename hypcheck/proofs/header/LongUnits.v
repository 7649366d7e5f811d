(** The function of the header that makes a whole number of a length in its unit: Coq reads its text and runs it, for limbs of 32 and of
    64 bits and any length. *)

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

Section Units.
Variable bits : Z.
Hypothesis Bits : bits = 32 \/ bits = 64.
Variables owned room : Z -> Z.
Hypothesis Few : forall b, room b < 2 ^ 20.
Notation B := (2 ^ bits).
Let base : 1 < B.
Proof. destruct Bits as [-> | ->]; reflexivity. Qed.
Notation called := (called bits owned room routines).

(** A word has no more limbs than two; so many limbs a rest has. *)
Definition counts left r := match left with O => r = 0 | S k => B ^ Z.of_nat k <= r < B ^ Z.of_nat (S k) end.
Lemma counted r : 0 <= r < 2 ^ 64 -> exists left, counts left r.
Proof.
  intros R; destruct (Z.eq_dec r 0) as [E | N]; [exists O; exact E |]; destruct (Z.lt_ge_cases r B) as [L | L]; [exists 1%nat | exists 2%nat];
    cbn [counts]; change (Z.of_nat 0) with 0; change (Z.of_nat 1) with 1; change (Z.of_nat 2) with 2; rewrite ?Z.pow_0_r, ?Z.pow_1_r; [lia |].
  split; [exact L |]; destruct Bits as [-> | ->]; change ((2 ^ 32) ^ 2) with (2 ^ 64) || change ((2 ^ 64) ^ 2) with (2 ^ 128); lia.
Qed.
Lemma counts_less left r : counts (S left) r -> counts left (r / B).
Proof.
  cbn [counts]; rewrite power_S; intros [L U]; destruct left as [| k]; cbn [counts].
  - change (Z.of_nat 0) with 0 in *; rewrite Z.pow_0_r in *; apply Z.div_small; lia.
  - rewrite (power_S B k) in L; split; [apply Z.div_le_lower_bound | apply Z.div_lt_upper_bound]; lia.
Qed.
Lemma halved : 0 < bits ÷ 2 < 64 /\ 0 < bits <= 64 /\ forall r, 0 <= r -> 0 <= r / 2 ^ (bits ÷ 2) /\ r / 2 ^ (bits ÷ 2) / 2 ^ (bits ÷ 2) = r / B.
Proof.
  assert (H : 0 < bits ÷ 2 < 64 /\ 0 < bits <= 64 /\ bits = bits ÷ 2 + bits ÷ 2) by (destruct Bits as [-> | ->]; repeat split; reflexivity || discriminate).
  destruct H as (H & L & E); split; [exact H |]; split; [exact L |]; intros r R; pose proof (Z.pow_pos_nonneg 2 (bits ÷ 2)); split; [apply Z.div_pos; lia |].
  rewrite Z.div_div, <- Z.pow_add_r, <- E by lia; reflexivity.
Qed.
Lemma shifted_out M k : 0 < k < bits -> M / 2 ^ (bits - k) = M * 2 ^ k / B.
Proof.
  intros K; replace B with (2 ^ (bits - k) * 2 ^ k) by (rewrite <- Z.pow_add_r by lia; f_equal; lia).
  pose proof (Z.pow_pos_nonneg 2 k); pose proof (Z.pow_pos_nonneg 2 (bits - k)); symmetry; apply Z.div_mul_cancel_r; lia.
Qed.
Lemma low_limb w : (w mod 2 ^ 64) mod B = w mod B.
Proof.
  destruct Bits as [-> | ->]; [symmetry; apply Znumtheory.Zmod_div_mod; [reflexivity | reflexivity | exists (2 ^ 32); reflexivity] | apply Z.mod_mod; discriminate].
Qed.

(** number = the parts in units of 2^unit *)
Theorem in_units_text d m p s e M unit (K : option content -> memory -> Prop) : is_sign s -> 0 <= room (owned p) ->
  (s <> 0 -> 0 < M < 2 ^ 64 /\ 0 <= e - unit < 2 ^ 30) -> Z.abs (s * (M * 2 ^ (e - unit))) < B ^ room (owned p) ->
  (forall m', is_value B owned room m' p (s * (M * 2 ^ (e - unit))) -> changes_only owned room p m m' -> K None m') ->
  called (S d) "hc_in_units" [To p; Holds Int s; Holds Int e; Holds U64 M; Holds Int unit] m K.
Proof.
  intros Sign P Range Fits Post; pose proof (Few (owned p)) as few.
  set (m1 := with_length (with_sign m p s) p 0).
  assert (Ch : changes_only owned room p m m1) by (apply changes_with_length, changes_with_sign, changes_of_limbs with 0; [apply only_limbs_none | exact P]).
  assert (Here : sign_at m1 p = Some s) by (cbn; unfold put_at; rewrite Z.eqb_refl; reflexivity).
  begins routines "hc_in_units"; do 12 act; fold m1.
  destruct (Z.eqb_spec s 0) as [S0 | NZ]; cbn [Z.eqb].
  { act; apply Post; [| exact Ch]; exists s, 0%nat, (fun _ => 0); split; [exact Here |]; split; [exact Sign |]; split; [split; [reflexivity | intros _; exact S0] |].
    split; [split; [cbn; unfold put_at; rewrite Z.eqb_refl; reflexivity |]; split; [intros i I; lia | split; [intros E; contradiction | exact P]] |].
    rewrite S0; reflexivity. }
  destruct (Range NZ) as [Mantissa Shift]; clear Range.
  set (V := M * 2 ^ (e - unit)) in *; assert (V0 : 0 < V) by (apply Z.mul_pos_pos; [lia | apply Z.pow_pos_nonneg; lia]).
  assert (Fits' : V < B ^ room (owned p)) by (clear - Fits Sign NZ V0; destruct Sign as [-> | [-> | ->]]; lia); clear Fits.
  assert (finish : forall m' h i, only_limbs (owned p) 0 (Z.of_nat i) m1 m' -> limbs B m' (owned p) 0 (Z.of_nat i) h -> total B h i = V -> i <> O ->
    B ^ (Z.of_nat i - 1) <= V -> Z.of_nat i <= room (owned p) -> K None (with_length m' p (Z.of_nat i))).
  { intros m' h i Only H T I0 Least R; apply Post; [| apply changes_with_length, changes_trans with m1; [exact Ch | apply changes_of_limbs with (Z.of_nat i); assumption]].
    exists s, i, h; split; [cbn [sign_at with_length]; rewrite (proj1 Only); exact Here |]; split; [exact Sign |]; split; [tauto |].
    split; [split; [cbn [length_at with_length]; unfold put_at; rewrite Z.eqb_refl; reflexivity |]; split; [exact H |]; split; [| exact R] | rewrite T; reflexivity].
    apply (no_zero_by_size B base h i (limbs_digits _ _ _ _ _ _ H)); intros _; rewrite T; exact Least. }
  clear Sign Post; set (D := e - unit) in *.
  set (n := Z.to_nat (D / bits)); set (shift := D - bits * Z.of_nat n).
  destruct halved as (half & bits_are & halves).
  assert (n_is : Z.of_nat n = D / bits) by (apply Z2Nat.id, Z.div_pos; lia).
  assert (S1 : 0 <= shift < bits) by (unfold shift; rewrite n_is; pose proof (Z.mod_pos_bound D bits ltac:(lia)); pose proof (Z.div_mod D bits ltac:(lia)); lia).
  assert (V_is : V = M * 2 ^ shift * B ^ Z.of_nat n).
  { unfold V; rewrite <- Z.pow_mul_r, <- Z.mul_assoc, <- Z.pow_add_r by lia; f_equal; f_equal; unfold shift; lia. }
  assert (W0 : 0 < 2 ^ shift) by (apply Z.pow_pos_nonneg; lia).
  assert (fits : forall i, B ^ Z.of_nat i <= V -> Z.of_nat i < room (owned p)).
  { intros i L; apply (Z.pow_lt_mono_r_iff B); lia. }
  assert (n_fits : Z.of_nat n < room (owned p)).
  { apply fits; rewrite V_is, <- (Z.mul_1_l (B ^ Z.of_nat n)) at 1; pose proof (power_positive B base n).
    apply Z.mul_le_mono_nonneg_r; [lia |]; pose proof (Z.mul_pos_pos M (2 ^ shift) ltac:(lia) W0); lia. }
  assert (D_bounds : 0 <= bits * Z.of_nat n <= D) by (clear - S1 n_is bits_are Shift; unfold shift in *; lia).
  do 3 act; split; [clear - Shift; lia |].
  set (rest_ := [("number", To p); ("parts.sign", Holds Int s); ("parts.exponent", Holds Int e); ("parts.mantissa", Holds U64 M); ("unit", Holds Int unit)]).
  apply loop_ends with (n := n) (I := fun left (now : variables) m' => exists i h, (i + left = n)%nat /\ only_limbs (owned p) 0 (Z.of_nat i) m1 m'
    /\ limbs B m' (owned p) 0 (Z.of_nat i) h /\ total B h i = 0 /\ now = ("shift", Holds Int (D - bits * Z.of_nat i)) :: ("i", Holds Int (Z.of_nat i)) :: ("rest", Nothing U64) :: rest_).
  - exists 0%nat, (fun _ => 0); split; [lia |]; split; [apply only_limbs_none |]; split; [intros i I; lia |]; split; [reflexivity |]; cbn [Z.of_nat]; rewrite Z.mul_0_r, Z.sub_0_r; reflexivity.
  - intros left now m' K' (i & h & N & Only & H & T & ->) Next; unfold rest_; evaluated.
    assert (J : bits * Z.of_nat i + bits <= D /\ Z.of_nat i < Z.of_nat n) by (clear - N D_bounds bits_are; nia).
    destruct (Z.leb_spec bits (D - bits * Z.of_nat i)) as [_ | L]; [cbn [Z.eqb] | lia].
    act; sides; rewrite Zmod_0_l; sides; do 1 act; split; [clear - J Shift bits_are; nia |].
    apply Next; exists (S i), (put_at h (Z.of_nat i) 0); rewrite total_put, !of_S by exact base; split; [lia |].
    split; [eapply only_limbs_put; [exact Only | lia | lia] |]; split; [apply limbs_more; [exact H | lia | lia] |]; split; [rewrite T; reflexivity |].
    unfold rest_; replace (D - bits * Z.of_nat i - bits) with (D - bits * (Z.of_nat i + 1)) by ring; reflexivity.
  - intros now m' (i & h & N & Only & H & T & ->); unfold rest_; evaluated; rewrite Nat.add_0_r in N; subst i; fold shift.
    destruct (Z.leb_spec bits shift) as [L | _]; [lia | cbn [Z.eqb]].
    do 2 act; sides; rewrite low_limb; sides; do 2 act; set (w := M * 2 ^ shift) in *.
    assert (w0 : 0 < w) by (apply Z.mul_pos_pos; lia).
    lazymatch goal with |- if _ then _ else (_ /\ _ /\ _ /\ ends ?b ?o ?e ?c ?a (?x :: ?y :: _ :: ?now) ?m ?Q ?R) =>
      assert (further : ends b o e c a (x :: y :: ("rest", Holds U64 (w / B)) :: now) m Q R) end.
    2: { destruct (Z.eqb_spec shift 0) as [E | N].
      - destruct (halves M ltac:(lia)) as [H0 H1]; sides; rewrite H1; replace (M / B) with (w / B); [exact further |]; unfold w; rewrite E, Z.mul_1_r; reflexivity.
      - sides; rewrite shifted_out by lia; exact further. }
    do 3 act.
    assert (w1 : 0 <= w / B < 2 ^ 64).
    { split; [apply Z.div_pos; lia | apply Z.div_lt_upper_bound; [lia |]]; pose proof (Z.pow_lt_mono_r 2 shift bits ltac:(lia) ltac:(lia) ltac:(lia)); unfold w; nia. }
    destruct (counted (w / B) w1) as [turns Turns].
    apply loop_ends with (n := turns) (I := fun left (now : variables) m'' => exists i h r, only_limbs (owned p) 0 (Z.of_nat i) m1 m'' /\ limbs B m'' (owned p) 0 (Z.of_nat i) h
      /\ (0 <= r < 2 ^ 64 /\ counts left r) /\ total B h i + r * B ^ Z.of_nat i = V /\ (i <> O /\ B ^ (Z.of_nat i - 1) <= V /\ Z.of_nat i <= room (owned p))
      /\ now = ("shift", Holds Int shift) :: ("i", Holds Int (Z.of_nat i)) :: ("rest", Holds U64 r) :: rest_).
    + exists (S n), (put_at h (Z.of_nat n) (w mod B)), (w / B); rewrite total_digit, of_S, Z.add_simpl_r, T by exact base.
      split; [eapply only_limbs_put; [exact Only | lia | lia] |]; split; [apply limbs_more; [exact H | apply Z.mod_pos_bound; lia | lia] |].
      split; [split; assumption |]; split; [rewrite V_is; reflexivity |]; split; [| reflexivity].
      split; [discriminate |]; split; [rewrite V_is | lia]; pose proof (power_positive B base n); clear - w0 H0; nia.
    + intros left now m'' K' (i & h' & r & Only' & H' & (r1 & Left) & T' & (I0 & Least & Room) & ->) Next; unfold rest_; evaluated.
      destruct (Z.eqb_spec r 0) as [E | N].
      { exfalso; cbn [counts] in Left; pose proof (power_positive B base left); lia. }
      assert (more : B ^ Z.of_nat i <= V).
      { rewrite <- T'; pose proof (total_bounds B base h' i (limbs_digits _ _ _ _ _ _ H')); pose proof (power_positive B base i); clear - H0 H1 N r1; nia. }
      pose proof (fits i more) as Room'; destruct (halves r ltac:(lia)) as [H0 H1].
      act; sides; do 1 act; sides; rewrite H1. apply Next; exists (S i), (put_at h' (Z.of_nat i) (r mod B)), (r / B).
      rewrite total_digit, of_S, Z.add_simpl_r by exact base.
      split; [eapply only_limbs_put; [exact Only' | lia | lia] |]; split; [apply limbs_more; [exact H' | apply Z.mod_pos_bound; lia | lia] |].
      split; [split; [split; [apply Z.div_pos; lia | apply Z.div_lt_upper_bound; [lia |]; clear - r1 base; nia] | exact (counts_less left r Left)] |].
      split; [exact T' |]; split; [split; [discriminate |]; split; [exact more | lia] | reflexivity].
    + intros now m'' (i & h' & r & Only' & H' & (_ & Left) & T' & (I0 & Least & Room) & ->); unfold rest_; evaluated; cbn [counts] in Left; subst r; cbn [Z.eqb].
      do 3 act; apply (finish m'' h' i); try assumption; rewrite <- T'; ring.
Qed.
End Units.
