(** The error bound of an emitted kernel: one number for a region, checked by a computation in rational numbers.

    `hypcheck emit --proof` writes a file that states the bound of its kernel and proves it by these lemmas. *)

Require Import Reals Lra Lia QArith Qreals List Bool.
From Hypcheck Require Import Geometry UnitBall Cubic Checker Rounding.
Import ListNotations.
Open Scope R_scope.

(** The inputs of an emitted discriminant: R = x^2 + y^2 and z^2, then constants, each rounded once from its exact value. *)
Definition env (constants : list Q) (RR zz : R) (n : nat) := match n with
  | 0%nat => RR | 1%nat => zz | S (S m) => Q2R (nth m constants 0%Q) end.

(** Roundings on entry: x, y, z may be rounded once themselves, so R has four and z^2 three; a constant has one. *)
Definition entries (n : nat) := match n with 0 => 4 | 1 => 3 | _ => 1 end%nat.

Definition far (constants : list Q) (widest highest : Q) (n : nat) : Q := match n with
  | 0%nat => widest | 1%nat => highest | S (S m) => Qabs.Qabs (nth m constants 0%Q) end.

Fixpoint division_free e := match e with
  | Input _ | Whole _ => true | Neg a | Scale _ a => division_free a
  | Add a b | Sub a b | Mul a b => division_free a && division_free b | Div _ _ => false end.

Fixpoint q_magnitude (at_most : nat -> Q) e : Q := match e with
  | Input n => at_most n | Whole z => inject_Z (Z.abs z) | Neg a => q_magnitude at_most a
  | Scale n a => Qred (inject_Z (2 ^ Z.of_nat n) * q_magnitude at_most a)
  | Add a b | Sub a b => Qred (q_magnitude at_most a + q_magnitude at_most b)
  | Mul a b => Qred (q_magnitude at_most a * q_magnitude at_most b) | Div _ _ => 0 end%Q.

Fixpoint q_pow (q : Q) k : Q := match k with O => 1 | S m => q * q_pow q m end%Q.

Definition bound_suffices (u : Q) constants widest highest bound e : bool :=
  division_free e && less 0 (1 - u) && Qle_bool 0 u && Qle_bool 0 widest && Qle_bool 0 highest
  && Qle_bool (q_magnitude (far constants widest highest) e)
              ((bound + q_magnitude (far constants widest highest) e) * q_pow (1 - u) (count entries e))%Q.

Lemma Q2R_pow q k : Q2R (q_pow q k) = Q2R q ^ k.
Proof. induction k as [| k IH]; [apply Q2R_1 | simpl; rewrite Q2R_mult, IH; reflexivity]. Qed.

Lemma Q2R_red q : Q2R (Qred q) = Q2R q.
Proof. apply Qeq_eqR, Qred_correct. Qed.

Lemma Q2R_whole z : Q2R (inject_Z z) = IZR z.
Proof. unfold Q2R; simpl; field. Qed.

Local Arguments Qred : simpl never.
Local Arguments inject_Z : simpl never.

Lemma magnitude_ge_0 f e : division_free e = true -> 0 <= magnitude f e.
Proof.
  induction e; simpl; intros D; try discriminate; try apply Rabs_pos; auto.
  - apply Rmult_le_pos; [apply pow_le; lra | auto].
  - apply andb_prop in D; destruct D; apply Rplus_le_le_0_compat; auto.
  - apply andb_prop in D; destruct D; apply Rplus_le_le_0_compat; auto.
  - apply andb_prop in D; destruct D; apply Rmult_le_pos; auto.
Qed.

Lemma magnitude_within f at_most e : division_free e = true -> (forall n, Rabs (f n) <= Q2R (at_most n)) ->
  magnitude f e <= Q2R (q_magnitude at_most e).
Proof.
  intros D H; induction e; simpl in *; try discriminate; auto.
  - rewrite Q2R_whole, abs_IZR; lra.
  - rewrite Q2R_red, Q2R_mult, Q2R_whole, <- pow_IZR.
    apply Rmult_le_compat_l; [apply pow_le; lra | auto].
  - apply andb_prop in D; destruct D; rewrite Q2R_red, Q2R_plus; apply Rplus_le_compat; auto.
  - apply andb_prop in D; destruct D; rewrite Q2R_red, Q2R_plus; apply Rplus_le_compat; auto.
  - apply andb_prop in D; destruct D; rewrite Q2R_red, Q2R_mult.
    apply Rmult_le_compat; auto using magnitude_ge_0.
Qed.

Lemma divides_well_without f e : division_free e = true -> divides_well f e.
Proof. induction e; simpl; intros D; try discriminate; auto; apply andb_prop in D; destruct D; auto. Qed.

Theorem bound_holds u constants widest highest bound e RR zz v :
  bound_suffices u constants widest highest bound e = true ->
  0 <= RR <= Q2R widest -> 0 <= zz <= Q2R highest ->
  computes (Q2R u) entries (env constants RR zz) e v ->
  Rabs (v - value (env constants RR zz) e) <= Q2R bound.
Proof.
  unfold bound_suffices; rewrite !andb_true_iff; intros [[[[[D U1] U0] W] H] B] R1 Z1 C.
  apply less_true in U1; apply le_true in U0; apply le_true in B.
  rewrite Q2R_minus, Q2R_0, Q2R_1 in U1; rewrite Q2R_0 in U0.
  rewrite Q2R_mult, Q2R_plus, Q2R_pow, Q2R_minus, Q2R_1 in B.
  assert (U : 0 <= Q2R u < 1) by lra.
  assert (M : magnitude (env constants RR zz) e <= Q2R (q_magnitude (far constants widest highest) e)).
  { apply magnitude_within; [assumption |]; intros [| [| m]]; simpl.
    - rewrite Rabs_pos_eq; lra.
    - rewrite Rabs_pos_eq; lra.
    - apply Rabs_le; pose proof (Qabs.Qle_Qabs (nth m constants 0%Q)) as L1; apply Qle_Rle in L1.
      pose proof (Qabs.Qle_Qabs (- nth m constants 0%Q)) as L2; apply Qle_Rle in L2.
      rewrite (Qeq_eqR _ _ (Qabs.Qabs_opp _)), Q2R_opp in L2; lra. }
  set (m := Q2R (q_magnitude (far constants widest highest) e)) in *.
  apply Rle_trans with (growth (Q2R u) (count entries e) * magnitude (env constants RR zz) e).
  - apply error_bound; [exact U | apply divides_well_without; assumption | assumption].
  - apply Rle_trans with (growth (Q2R u) (count entries e) * m).
    + apply Rmult_le_compat_l; [apply growth_ge_0; exact U | assumption].
    + unfold growth; assert (P : 0 < (1 - Q2R u) ^ count entries e) by (apply pow_lt; lra).
      set (q := (1 - Q2R u) ^ count entries e) in *.
      apply Rmult_le_reg_l with q; [assumption |]; rewrite <- Rmult_assoc, Rmult_minus_distr_l, Rinv_r by lra; lra.
Qed.

(** R as the kernel computes it, from coordinates that may be rounded on entry, is R times a factor of four roundings. *)
Lemma computed_R u x y f h t1 t2 t3 : 0 <= u < 1 -> factor u 1 f -> factor u 1 h ->
  Rabs t1 <= u -> Rabs t2 <= u -> Rabs t3 <= u ->
  exists k, factor u 4 k
    /\ (x * f * (x * f) * (1 + t1) + y * h * (y * h) * (1 + t2)) * (1 + t3) = (x ^ 2 + y ^ 2) * k.
Proof.
  intros U F H T1 T2 T3.
  assert (F3 : factor u 3 (f * f * (1 + t1))).
  { change 3%nat with (1 + 1 + 1)%nat; repeat apply factor_mul; auto using factor_of_rounding. }
  assert (H3 : factor u 3 (h * h * (1 + t2))).
  { change 3%nat with (1 + 1 + 1)%nat; repeat apply factor_mul; auto using factor_of_rounding. }
  set (s := f * f * (1 + t1)) in *; set (r := h * h * (1 + t2)) in *.
  assert (E : (x * f * (x * f) * (1 + t1) + y * h * (y * h) * (1 + t2)) = x ^ 2 * s + y ^ 2 * r)
    by (unfold s, r; ring).
  rewrite E; pose proof (pow2_ge_0 x) as X; pose proof (pow2_ge_0 y) as Y.
  destruct (Req_dec (x ^ 2 + y ^ 2) 0) as [Z | Z].
  - assert (x ^ 2 = 0) by lra; assert (y ^ 2 = 0) by lra.
    exists 1; split; [apply factor_1; assumption |]; rewrite H0, H1; ring.
  - exists ((x ^ 2 * s + y ^ 2 * r) / (x ^ 2 + y ^ 2) * (1 + t3)); split; [| field; assumption].
    change 4%nat with (3 + 1)%nat; apply factor_mul; [assumption | | apply factor_of_rounding; assumption].
    destruct F3 as [L1 G1]; destruct H3 as [L2 G2]; unfold factor.
    split; apply Rmult_le_reg_r with (x ^ 2 + y ^ 2); try lra; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by assumption; nra.
Qed.

(** ** What the sign of the computed discriminant says. *)

Lemma disc_scaled b2 b1 b0 s : s <> 0 -> disc (b2 / s) (b1 / s ^ 2) (b0 / s ^ 3) = disc b2 b1 b0 / s ^ 6.
Proof. intros; unfold disc; field; assumption. Qed.

(** 3 delta in its form with the fewest operations. *)
Lemma hessian_form f e2 e1 e0 e : value f e
    = 2 ^ 2 * ((value f e2 * value f e2 - 3 * value f e1) * (value f e1 * value f e1 - 3 * (value f e2 * value f e0)))
      - (value f e2 * value f e1 - 9 * value f e0) * (value f e2 * value f e1 - 9 * value f e0) ->
  value f e = 3 * disc (value f e2) (value f e1) (value f e0).
Proof. intros ->; rewrite disc_hessian; unfold h; ring. Qed.

Theorem sign_of_discriminant u constants widest highest bound e RR zz v A B P Q s :
  bound_suffices u constants widest highest bound e = true ->
  0 <= RR <= Q2R widest -> 0 <= zz <= Q2R highest -> 0 < s ->
  value (env constants RR zz) e = 3 * disc (c2 A B P Q / s) (c1 A B P Q / s ^ 2) (c0 A B P Q / s ^ 3) ->
  computes (Q2R u) entries (env constants RR zz) e v ->
  (Q2R bound < v -> 0 < disc (c2 A B P Q) (c1 A B P Q) (c0 A B P Q))
  /\ (v < - Q2R bound -> disc (c2 A B P Q) (c1 A B P Q) (c0 A B P Q) < 0).
Proof.
  intros S R1 Z1 Hs E C; pose proof (bound_holds _ _ _ _ _ _ _ _ _ S R1 Z1 C) as H; rewrite E in H.
  rewrite disc_scaled in H by lra; set (D := disc (c2 A B P Q) (c1 A B P Q) (c0 A B P Q)) in *.
  assert (P6 : 0 < s ^ 6) by (apply pow_lt; assumption).
  pose proof (Rle_abs (v - 3 * (D / s ^ 6))); pose proof (Rle_abs (- (v - 3 * (D / s ^ 6)))); rewrite Rabs_Ropp in *.
  split; intros K.
  - assert (0 < D / s ^ 6) by lra; replace D with (D / s ^ 6 * s ^ 6) by (field; lra); apply Rmult_lt_0_compat; assumption.
  - assert (0 < - (D / s ^ 6)) by lra.
    assert (0 < - (D / s ^ 6) * s ^ 6) by (apply Rmult_lt_0_compat; assumption).
    replace (- (D / s ^ 6) * s ^ 6) with (- D) in * by (field; lra); lra.
Qed.
