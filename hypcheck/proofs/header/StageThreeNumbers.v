(** Stage 3: the numbers of a run, and the exact values that they stand for: squares of lengths, balanced numbers, and what the steps
    compute of those with which a run begins. StageThreePosition.v has the row. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Hypcheck Require Import Steps Fixed FixedRuns LimbsRuns ShiftRuns Computed StageThreeRuns.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** ** Powers of two, squares of lengths, and balanced numbers. *)

Definition power k : R := powerRZ 2 k.
Lemma power_positive k : (0 < power k)%R.
Proof. apply powerRZ_lt; lra. Qed.
Lemma power_sum j k : power (j + k) = (power j * power k)%R.
Proof. apply powerRZ_add; lra. Qed.
Lemma power_whole k : 0 <= k -> IZR (2 ^ k) = power k.
Proof. intros K; rewrite <- (Z2Nat.id k K) at 1; rewrite <- pow_IZR; unfold power; rewrite <- (Z2Nat.id k K) at 2; apply pow_powerRZ. Qed.

(** The square of a mantissa, in units of 2^-126. *)
Definition units k := k ^ 2 * 2 ^ 20.
Lemma whole_stands k : Z.abs k < 2 ^ 53 -> stands (whole (Z.abs k)) (units k) /\ 0 <= units k <= longest.
Proof.
  intros K; assert (R : 0 <= units k <= longest).
  { unfold units, longest; rewrite (Z.pow_even_abs k 2) by (exists 1; reflexivity); split.
    - apply Z.mul_nonneg_nonneg; [apply Z.pow_nonneg; lia | discriminate].
    - apply Z.mul_le_mono_nonneg_r; [discriminate |]; apply Z.pow_le_mono_l; lia. }
  split; [| exact R]; assert (L : longest < bits128) by reflexivity.
  replace (whole (Z.abs k)) with (words_of (units k mod bits128)); [apply words_stand |].
  rewrite Z.mod_small by lia; unfold whole, full, words_of.
  replace (Z.abs k * 2 ^ 10 * (Z.abs k * 2 ^ 10)) with (units k); [reflexivity |].
  unfold units; rewrite (Z.pow_even_abs k 2) by (exists 1; reflexivity); ring.
Qed.

(** The ranges of what is balanced. *)
Definition kept_in r least most := (least <=? low r) && (high r <=? most) && (under r <=? 0) && (0 <=? over r).
Lemma kept_is r least most : kept_in r least most = true -> (least <= low r /\ high r <= most) /\ under r <= 0 <= over r.
Proof. unfold kept_in; rewrite !andb_true_iff, !Z.leb_le; tauto. Qed.
Lemma kept_ranges : (kept_in (term "N") 0 (2 ^ 124) = true /\ kept_in (term "ps") 0 (2 ^ 124) = true)
  /\ kept_in n2_range (- 2 ^ 126) (2 ^ 126 - 1) = true /\ kept_in (term "n1") (- 2 ^ 126) (2 ^ 126 - 1) = true.
Proof. vm_compute; repeat split; reflexivity. Qed.

Section Numbers.
Variables (num : string -> number) (x : string -> R).

Lemma whole_holds n k : num n = whole (Z.abs k) -> x n = IZR (units k) -> 2 ^ 52 <= k < 2 ^ 53 -> holds num x n (Range (2 ^ 124) longest 0 0).
Proof.
  intros N X K; destruct (whole_stands k ltac:(lia)) as (S & _ & U); exists (units k); rewrite N, X; split; [exact S |].
  split; [| reflexivity]; split; cbn [low high under over]; [| rewrite Rminus_diag_eq by reflexivity; lra].
  split; [| exact U]; unfold units; change (2 ^ 124) with ((2 ^ 52) ^ 2 * 2 ^ 20); apply Z.mul_le_mono_nonneg_r; [discriminate |].
  apply Z.pow_le_mono_l; lia.
Qed.

Lemma square_holds n k s : num n = shifted_down (whole (Z.abs k)) s -> x n = (IZR (units k) / IZR (2 ^ s))%R -> Z.abs k < 2 ^ 53 -> 0 <= s ->
  holds num x n (Range 0 longest (-1) 0).
Proof.
  intros N X K S; destruct (whole_stands k K) as (W & U0 & U1); assert (L : longest < bits128 / 2) by reflexivity.
  exists (units k / 2 ^ s); rewrite N, X; split.
  - rewrite <- (signed_value_is _ _ W) by (numbers; lia); apply down_stands.
  - split; [| reflexivity]; apply (moved_within (Range 0 longest 0 0) (units k) (IZR (units k)) s S).
    split; cbn [low high under over]; [lia | rewrite Rminus_diag_eq by reflexivity; lra].
Qed.

Lemma each_holds l : Forall (fun p => holds num x (fst p) (snd p)) l -> all_hold num x l.
Proof.
  induction l as [| [n r] l IH]; intros F k q L; [discriminate |]; cbn [look] in L; destruct (String.eqb_spec n k) as [<- | N].
  - injection L as <-; exact (Forall_inv F).
  - exact (IH (Forall_inv_tail F) k q L).
Qed.

(** The whole number that the words stand for. *)
Lemma value_within n q : holds num x n q -> - 2 ^ 127 <= low q -> high q < 2 ^ 127 ->
  within q (signed_value (num n)) (x n) /\ stands (num n) (signed_value (num n)).
Proof.
  intros (v & S & I & _) L H; rewrite (signed_value_is (num n) v S); [split; assumption |].
  destruct I as [I _]; change (bits128 / 2) with (2 ^ 127); lia.
Qed.

Lemma bits_within n q : holds num x n q -> - 2 ^ 126 <= low q -> high q < 2 ^ 126 -> 1 <= bits_of (num n) <= 126.
Proof.
  intros H L T; destruct (value_within n q H) as ((I & _) & _); [lia | lia |]; unfold bits_of; set (v := signed_value (num n)) in *.
  set (k := if v <? 0 then - v - 1 else v); assert (K : 0 <= k <= 2 ^ 126 - 1) by (unfold k; destruct (Z.ltb_spec v 0); lia).
  pose proof (Z.log2_nonneg k); pose proof (Z.log2_le_mono k (2 ^ 126 - 1) ltac:(apply K)) as M; change (Z.log2 (2 ^ 126 - 1)) with 125 in M; lia.
Qed.

(** Moved up and down, as a number is balanced. *)
Variables (num' : string -> number) (x' : string -> R).
Lemma balanced_holds n q f u d : holds num x n q -> - 2 ^ 127 <= low q -> high q < 2 ^ 127 -> under q <= 0 <= over q -> 0 <= u -> 0 <= d ->
  2 ^ u <= f * 2 ^ d -> (let v := signed_value (num n) * 2 ^ u in - 2 ^ 126 <= v <= 2 ^ 126 /\ - 2 ^ 125 * 2 ^ d <= v <= 2 ^ 125 * 2 ^ d) ->
  num' n = shifted_down (shifted_up (num n) u) d -> x' n = (x n * IZR (2 ^ u) / IZR (2 ^ d))%R -> holds num' x' n (balanced_range q f).
Proof.
  intros H L T [E0 E1] U0 D0 F [R1 R2] N X; destruct (value_within n q H L T) as (((I0 & I1) & I2 & I3) & S); set (v := signed_value (num n)) in *.
  assert (V : signed_value (shifted_up (num n) u) = v * 2 ^ u).
  { apply signed_value_is; [| change (bits128 / 2) with (2 ^ 127); lia]; unfold shifted_up; rewrite (proj2 S), Z.mul_mod_idemp_l by discriminate.
    apply words_stand. }
  exists (v * 2 ^ u / 2 ^ d); rewrite N, X; split; [rewrite <- V; apply down_stands |]; split.
  2: { unfold fits, balanced_range; cbn [low high]; destruct (low q <? 0); reflexivity. }
  assert (PD : 0 < 2 ^ d) by (apply Z.pow_pos_nonneg; lia); assert (PU : 0 < 2 ^ u) by (apply Z.pow_pos_nonneg; lia).
  pose proof (Z.mul_div_le (v * 2 ^ u) (2 ^ d) PD) as D1; pose proof (Z.mul_succ_div_gt (v * 2 ^ u) (2 ^ d) PD) as D2; unfold Z.succ in D2.
  unfold within, balanced_range; cbn [low high under over]; split; [split |].
  - destruct (Z.ltb_spec (low q) 0); [apply Z.div_le_lower_bound; lia | apply Z.div_pos; [apply Z.mul_nonneg_nonneg; lia | exact PD]].
  - apply Z.div_le_upper_bound; lia.
  - set (w := v * 2 ^ u / 2 ^ d) in *; clearbody w v; clear - D1 D2 E0 E1 F PD PU I2 I3.
    apply IZR_le in D1; apply IZR_lt in D2; apply IZR_le in F; apply IZR_lt in PD; apply IZR_lt in PU; apply IZR_le in E0; apply IZR_le in E1.
    rewrite minus_IZR; rewrite !mult_IZR in *; rewrite plus_IZR in D2; revert D1 D2 E0 E1 F PD PU I2 I3.
    generalize (IZR (2 ^ d)) as D; generalize (IZR (2 ^ u)) as U; generalize (x n) as a; intros a U D D1 D2 E0 E1 F PD PU I2 I3.
    assert (Y : (a * U = a * U / D * D)%R) by (field; lra); set (y := (a * U / D)%R) in *; clearbody y.
    split; apply Rmult_le_reg_r with D; try assumption.
    + assert (IZR (under q) * (IZR f * D) <= IZR (under q) * U)%R by nra; nra.
    + assert (IZR (over q) * U <= IZR (over q) * (IZR f * D))%R by nra; nra.
Qed.

(** Doubled and moved down, as N and ps; or made as large as 126 bits hold, and moved down, as n2 and n1. *)
Lemma doubled_holds n r down : holds num x n r -> kept_in r 0 (2 ^ 124) = true -> 0 <= down ->
  num' n = shifted_down (shifted_up (num n) 1) down /\ x' n = (x n * IZR (2 ^ 1) / IZR (2 ^ down))%R -> holds num' x' n (balanced_range r 2).
Proof.
  intros H I D [N V]; apply kept_is in I as ((L & T) & E); assert (F : 1 <= 2 ^ down) by (pose proof (Z.pow_pos_nonneg 2 down ltac:(lia) D); lia).
  apply (balanced_holds n r 2 1 down H); try assumption; try lia; cbv zeta.
  destruct (value_within n r H) as ((I & _) & _); [lia | lia |]; clear - L T I F; change (2 ^ 1) with 2; nia.
Qed.
Lemma filled_holds n r down grown : holds num x n r -> kept_in r (- 2 ^ 126) (2 ^ 126 - 1) = true -> 0 <= down -> 0 <= grown ->
  let bits := bits_of (num n) in 1 <= bits <= 126 -> 126 - bits <= grown + (down + 1) ->
  num' n = shifted_down (shifted_up (num n) (126 - bits)) (down + 1) /\ x' n = (x n * IZR (2 ^ (126 - bits)) / IZR (2 ^ (down + 1)))%R ->
  holds num' x' n (balanced_range r (2 ^ grown)).
Proof.
  intros H I D G0 bits B G [N V]; apply kept_is in I as ((L & T) & E).
  apply (balanced_holds n r (2 ^ grown) (126 - bits) (down + 1) H); try assumption; try lia; cbv zeta.
  - rewrite <- Z.pow_add_r by lia; apply Z.pow_le_mono_r; lia.
  - pose proof (bits_hold (num n)) as [V0 V1]; fold bits in V0, V1.
    assert (F : 2 ^ bits * 2 ^ (126 - bits) = 2 ^ 126) by (rewrite <- Z.pow_add_r by lia; f_equal; ring).
    assert (D' : 1 <= 2 ^ down) by (pose proof (Z.pow_pos_nonneg 2 down ltac:(lia) D); lia).
    assert (U : 0 < 2 ^ (126 - bits)) by (apply Z.pow_pos_nonneg; lia).
    replace (2 ^ 125 * 2 ^ (down + 1)) with (2 ^ 126 * 2 ^ down) by (rewrite Z.pow_add_r by lia; ring).
    replace (- 2 ^ 125 * 2 ^ (down + 1)) with (- 2 ^ 126 * 2 ^ down) by (rewrite Z.pow_add_r by lia; ring).
    clear - V0 V1 F D' U; revert V0 V1 F U; generalize (2 ^ bits) as b, (2 ^ (126 - bits)) as u, (signed_value (num n)) as v; intros; rewrite <- F.
    assert (- (b * u) <= v * u <= b * u) by nia; assert (b * u * 1 <= b * u * 2 ^ down) by (apply Z.mul_le_mono_nonneg_l; nia); lia.
Qed.

End Numbers.

(** ** The numbers of a run, and the exact values that they stand for. *)

(** The steps at both poles; those that both have are the same. *)
Definition given_name l n := existsb (fun t => String.eqb (name t) n) l.
Definition C_poles := Eval vm_compute in (C_at_B ++ filter (fun s => negb (given_name C_at_B (name s))) C_at_A)%list.
Lemma found_in l k : map (fun s => find (fun t => String.eqb (name t) (name s)) k) l = map Some l -> incl l k.
Proof.
  intros E s I; apply (in_map Some) in I; rewrite <- E in I; apply in_map_iff in I as (t & F & _); apply (find_some _ _ F).
Qed.
Lemma poles_have : incl C_at_B C_poles /\ incl C_at_A C_poles.
Proof. split; apply found_in; vm_compute; reflexivity. Qed.

(** What the steps at the poles leave as it is; they come after n2, which is no step. *)
Definition stays n := negb (String.eqb "n2" n) && negb (given_name C_poles n).

Section Kept.
Variables (shift : string -> Z) (num num' : string -> number) (x x' : string -> R) (l : list step).
Hypotheses (Same : forall n, stays n = true -> num' n = num n /\ x' n = x n)
  (Stays : forallb (fun s => forallb stays (name s :: operands s)) l = true).

Lemma runs_kept : Forall (runs num x shift) l -> Forall (runs num' x' shift) l.
Proof.
  rewrite !Forall_forall; intros F s I; specialize (F s I); rewrite forallb_forall in Stays; specialize (Stays s I); rewrite forallb_forall in Stays.
  assert (K : forall n, In n (name s :: operands s) -> num' n = num n /\ x' n = x n) by (intros n J; apply Same, Stays, J).
  unfold runs, operands, halves in *; destruct (K (name s) (or_introl eq_refl)) as [-> ->]; destruct (call_of s) as [a c | a c | k a | a c | a c | a c | a | b a c |];
    try (destruct (K a ltac:(cbn; tauto)) as [-> ->]); try (destruct (K c ltac:(cbn; tauto)) as [-> ->]); exact F.
Qed.
Lemma computed_kept : Forall (is_computed shift num) l -> Forall (is_computed shift num') l.
Proof.
  rewrite !Forall_forall; intros F s I; specialize (F s I); rewrite forallb_forall in Stays; specialize (Stays s I); rewrite forallb_forall in Stays.
  assert (K : forall n, In n (name s :: operands s) -> num' n = num n /\ x' n = x n) by (intros n J; apply Same, Stays, J).
  unfold is_computed, number_of, operands in *; destruct (K (name s) (or_introl eq_refl)) as [-> _]; destruct (call_of s) as [a c | a c | k a | a c | a c | a c | a | b a c |];
    try (destruct (K a ltac:(cbn; tauto)) as [-> _]); try (destruct (K c ltac:(cbn; tauto)) as [-> _]); exact F.
Qed.
End Kept.

(** What a run begins with: numbers with their exact values, by name. *)
Definition beginnings := list (string * (number * R)).
Definition first_number (l : beginnings) n := match look n l with Some p => fst p | None => Words 0 0 end.
Definition first_value (l : beginnings) n : R := match look n l with Some p => snd p | None => 0 end.
Definition begins (l : beginnings) (num : string -> number) (x : string -> R) := forall n v y, look n l = Some (v, y) -> num n = v /\ x n = y.

Lemma first_are_numbers l : Forall (fun p => is_number (fst (snd p))) l -> forall n, is_number (first_number l n).
Proof.
  intros F n; unfold first_number; destruct (look n l) as [p |] eqn:E; [| repeat split; discriminate].
  apply look_in in E; rewrite Forall_forall in F; exact (F _ E).
Qed.

Section Begun.
Variable shift : string -> Z.
Hypothesis Shifts : forall n, 0 <= shift n.
Variable l : beginnings.
Hypothesis Numbers : forall n, is_number (first_number l n).

Lemma begun_discriminant : forallb (fun p => negb (given_name C_discriminant (fst p))) l = true -> exists num x, begins l num x
  /\ Forall (is_computed shift num) C_discriminant /\ Forall (runs num x shift) C_discriminant.
Proof.
  intros B; exists (computed shift (first_number l) C_discriminant), (exacts shift (first_value l) C_discriminant); split; [| split].
  - intros n v y L; assert (N : given_name C_discriminant n = false).
    { rewrite forallb_forall in B; apply look_in in L; specialize (B _ L); apply negb_true_iff in B; exact B. }
    rewrite computed_other, exacts_other by exact N; unfold first_number, first_value; rewrite L; split; reflexivity.
  - apply computed_is; vm_compute; reflexivity.
  - apply computed_runs; [exact Shifts | exact Numbers | vm_compute; reflexivity].
Qed.

Lemma begun_terms : forallb (fun p => stays (fst p) && negb (given_name C_terms (fst p))) l = true -> exists num x, begins l num x
  /\ (Forall (is_computed shift num) C_terms /\ Forall (is_computed shift num) C_at_B /\ Forall (is_computed shift num) C_at_A)
  /\ (Forall (runs num x shift) C_terms /\ Forall (runs num x shift) C_at_B /\ Forall (runs num x shift) C_at_A)
  /\ num "n2" = minus (shifted_down (num "radial_2") (shift "by_t")) (shifted_down (num "axial_2") (shift "by_q"))
  /\ x "n2" = (x "radial_2" / IZR (2 ^ shift "by_t") - x "axial_2" / IZR (2 ^ shift "by_q"))%R.
Proof.
  intros B; set (num1 := computed shift (first_number l) C_terms); set (x1 := exacts shift (first_value l) C_terms).
  set (num2 := put num1 "n2" (minus (shifted_down (num1 "radial_2") (shift "by_t")) (shifted_down (num1 "axial_2") (shift "by_q")))).
  set (x2 := put x1 "n2" (x1 "radial_2" / IZR (2 ^ shift "by_t") - x1 "axial_2" / IZR (2 ^ shift "by_q"))%R).
  assert (N1 : forall n, is_number (num1 n)) by (apply computed_numbers; exact Numbers).
  assert (N2 : forall n, is_number (num2 n)) by (intros n; unfold num2, put; destruct (String.eqb "n2" n); [apply minus_number | apply N1]).
  assert (K : forall n, stays n = true -> computed shift num2 C_poles n = num1 n /\ exacts shift x2 C_poles n = x1 n).
  { intros n S; apply andb_prop in S as [S1 S2]; apply negb_true_iff in S1; apply negb_true_iff in S2.
    rewrite computed_other, exacts_other by exact S2; unfold num2, x2; rewrite !put_other by exact S1; split; reflexivity. }
  exists (computed shift num2 C_poles), (exacts shift x2 C_poles).
  pose proof (computed_is shift C_poles num2 ltac:(vm_compute; reflexivity)) as P.
  pose proof (computed_runs shift Shifts C_poles num2 x2 N2 ltac:(vm_compute; reflexivity)) as Q.
  assert (T : Forall (is_computed shift num1) C_terms) by (apply computed_is; vm_compute; reflexivity).
  assert (U : Forall (runs num1 x1 shift) C_terms) by (apply computed_runs; [exact Shifts | exact Numbers | vm_compute; reflexivity]).
  split; [| split; [| split]].
  - intros n v y L; rewrite forallb_forall in B; pose proof (B _ (look_in _ _ _ L)) as S; apply andb_prop in S as [S C]; apply negb_true_iff in C.
    destruct (K n S) as [-> ->]; unfold num1, x1; rewrite computed_other, exacts_other by exact C; unfold first_number, first_value; rewrite L; split; reflexivity.
  - split; [apply (computed_kept shift num1 _ x1 _ C_terms K); [vm_compute; reflexivity | exact T] |].
    split; apply (incl_Forall (proj1 poles_have)) || apply (incl_Forall (proj2 poles_have)); exact P.
  - split; [apply (runs_kept shift num1 _ x1 _ C_terms K); [vm_compute; reflexivity | exact U] |].
    split; apply (incl_Forall (proj1 poles_have)) || apply (incl_Forall (proj2 poles_have)); exact Q.
  - rewrite (computed_other shift C_poles num2 "n2" eq_refl), (exacts_other shift C_poles x2 "n2" eq_refl).
    destruct (K "radial_2" eq_refl) as [-> ->], (K "axial_2" eq_refl) as [-> ->]; unfold num2, x2; rewrite !put_same; split; reflexivity.
Qed.
End Begun.
