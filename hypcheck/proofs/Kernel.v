(** The error constants of the kernel: 8u, 12u and 1536u cover the roundings of c0 and c2, of c1, and of 3 delta.

    [computes u exact_inputs] are the values that floats may return for StageTwo.v's program, in any order of contraction;
    Floats.v shows it for float64 with u = 2^-52 in any rounding mode. *)

Require Import Reals Lra Lia.
From Hypcheck Require Import Geometry UnitBall Cubic Rounding.
From Hypcheck Require StageTwo.
Open Scope R_scope.

(** A bound of the growth that is easy to compare. *)
Lemma bernoulli u k : 0 <= u <= 1 -> 1 - INR k * u <= (1 - u) ^ k.
Proof.
  intros U; induction k as [| k IH]; [simpl; lra |]; rewrite S_INR; simpl.
  apply Rle_trans with ((1 - u) * (1 - INR k * u)); [| apply Rmult_le_compat_l; lra].
  pose proof (pos_INR k); nra.
Qed.

Lemma growth_is_small u k : 0 <= u < 1 -> INR k * (INR k + 1) * u <= 1 -> growth u k <= (INR k + 1) * u.
Proof.
  intros U S; unfold growth; pose proof (pos_INR k) as K; pose proof (bernoulli u k ltac:(lra)) as B.
  assert (Q : 0 < (1 - u) ^ k) by (apply pow_lt; lra).
  assert (1 <= (1 + (INR k + 1) * u) * (1 - INR k * u)) by nra.
  assert (0 <= 1 + (INR k + 1) * u) by nra.
  apply Rplus_le_reg_r with 1; replace (/ (1 - u) ^ k - 1 + 1) with (/ (1 - u) ^ k) by ring.
  apply Rmult_le_reg_l with ((1 - u) ^ k); [assumption |]; rewrite Rinv_r by lra; nra.
Qed.

Section Kernel.

Variables alpha gamma b d x y z u : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d) (U : 0 <= u <= / 2 ^ 52).

(** What the inputs of the program stand for, in its order; the constants after them are not read here. *)
Let env n := List.nth n (alpha :: gamma :: b :: d :: x :: y :: z :: nil)%list 0.

Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let P := (x ^ 2 + y ^ 2) / b ^ 2.
Let Q := (z / d) ^ 2.

Let HA : 0 < A := A_pos alpha b Ha Hb.
Let HB : 0 < B := B_pos gamma d Hg Hd.
Let HP : 0 <= P := P_ge_0 b x y Hb.
Let HQ : 0 <= Q := Q_ge_0 d z.

Let U1 : 0 <= u < 1.
Proof. split; [lra |]; apply Rle_lt_trans with (/ 2 ^ 52); [lra |]; simpl; lra. Qed.

Let small k c : INR k * (INR k + 1) <= 10000 -> INR k + 1 <= c -> growth u k <= c * u.
Proof.
  intros K C; pose proof (pos_INR k); apply Rle_trans with ((INR k + 1) * u).
  - apply growth_is_small; [exact U1 |]; apply Rle_trans with (10000 * / 2 ^ 52); [| simpl; lra].
    apply Rmult_le_compat; try lra; nra.
  - apply Rmult_le_compat_r; lra.
Qed.

(** ** What the program computes without rounding: the coefficients of g and its discriminant. *)

Lemma value_c0 : value env StageTwo.c0 = UnitBall.c0 A B P Q.
Proof. unfold UnitBall.c0, env, A, B; simpl; field; lra. Qed.
Lemma value_c1 : value env StageTwo.c1 = UnitBall.c1 A B P Q.
Proof. unfold UnitBall.c1, env, A, B, P, Q; simpl; field; lra. Qed.
Lemma value_c2 : value env StageTwo.c2 = UnitBall.c2 A B P Q.
Proof. unfold UnitBall.c2, env, A, B, P, Q; simpl; field; lra. Qed.

Lemma value_delta_3 : value env StageTwo.delta_3
  = 3 * disc (UnitBall.c2 A B P Q) (UnitBall.c1 A B P Q) (UnitBall.c0 A B P Q).
Proof.
  rewrite disc_hessian, <- value_c2, <- value_c1, <- value_c0; unfold h.
  set (v2 := value env StageTwo.c2); set (v1 := value env StageTwo.c1); set (v0 := value env StageTwo.c0).
  transitivity (2 ^ 2 * ((v2 * v2 - 3 * v1) * (v1 * v1 - 3 * (v2 * v0))) - (v2 * v1 - 9 * v0) * (v2 * v1 - 9 * v0));
    [reflexivity | ring].
Qed.

(** ** The sums of the sizes of all terms. *)

Definition M0 := A * B.
Definition M1 := A * B + A + B + B * P + A * Q.
Definition M2 := A + B + 1 + P + Q.

Let size_A : magnitude env StageTwo.A = A.
Proof.
  unfold A, env; simpl; rewrite (Rabs_pos_eq alpha), (Rabs_pos_eq b) by lra; field; lra.
Qed.
Let size_B : magnitude env StageTwo.B = B.
Proof.
  unfold B, env; simpl; rewrite (Rabs_pos_eq gamma), (Rabs_pos_eq d) by lra; field; lra.
Qed.
Let size_P : magnitude env StageTwo.P = P.
Proof.
  unfold P, env; simpl; rewrite (Rabs_pos_eq b) by lra.
  replace (Rabs x * Rabs x) with (x * x) by (rewrite <- Rabs_mult, Rabs_pos_eq; nra).
  replace (Rabs y * Rabs y) with (y * y) by (rewrite <- Rabs_mult, Rabs_pos_eq; nra). field; lra.
Qed.
Let size_Q : magnitude env StageTwo.Q = Q.
Proof.
  unfold Q, env; simpl; rewrite (Rabs_pos_eq d) by lra.
  replace (Rabs z / d * (Rabs z / d)) with (Rabs z * Rabs z / (d * d)) by (field; lra).
  rewrite <- Rabs_mult, Rabs_pos_eq by nra; field; lra.
Qed.

Lemma size_c0 : magnitude env StageTwo.c0 = M0.
Proof. change (magnitude env StageTwo.A * magnitude env StageTwo.B = M0); rewrite size_A, size_B; reflexivity. Qed.

Lemma size_c1 : magnitude env StageTwo.c1 = M1.
Proof.
  change (magnitude env StageTwo.A * magnitude env StageTwo.B + magnitude env StageTwo.A + magnitude env StageTwo.B
    + magnitude env StageTwo.B * magnitude env StageTwo.P + magnitude env StageTwo.A * magnitude env StageTwo.Q = M1).
  rewrite size_A, size_B, size_P, size_Q; reflexivity.
Qed.

Lemma size_c2 : magnitude env StageTwo.c2 = M2.
Proof.
  change (magnitude env StageTwo.A + magnitude env StageTwo.B + Rabs 1 + magnitude env StageTwo.P
    + magnitude env StageTwo.Q = M2).
  rewrite size_A, size_B, size_P, size_Q, Rabs_R1; reflexivity.
Qed.

Lemma size_delta_3 : magnitude env StageTwo.delta_3
  = 4 * ((M2 * M2 + 3 * M1) * (M1 * M1 + 3 * (M2 * M0))) + (M2 * M1 + 9 * M0) * (M2 * M1 + 9 * M0).
Proof.
  rewrite <- size_c0, <- size_c1, <- size_c2.
  assert (R3 : Rabs 3 = 3) by (apply Rabs_pos_eq; lra); assert (R9 : Rabs 9 = 9) by (apply Rabs_pos_eq; lra).
  set (m2 := magnitude env StageTwo.c2); set (m1 := magnitude env StageTwo.c1); set (m0 := magnitude env StageTwo.c0).
  transitivity (2 ^ 2 * ((m2 * m2 + Rabs 3 * m1) * (m1 * m1 + Rabs 3 * (m2 * m0)))
                + (m2 * m1 + Rabs 9 * m0) * (m2 * m1 + Rabs 9 * m0)); [reflexivity | rewrite R3, R9; ring].
Qed.

Let M0_pos : 0 < M0.
Proof. apply Rmult_lt_0_compat; assumption. Qed.

Let products : 0 <= B * P /\ 0 <= A * Q /\ 0 <= A * P /\ 0 <= B * Q /\ 0 <= P * Q.
Proof. repeat split; apply Rmult_le_pos; lra. Qed.

Let M1_pos : 0 < M1.
Proof. destruct products as (H1 & H2 & _); pose proof M0_pos; unfold M1, M0 in *; lra. Qed.

Let M2_ge_1 : 1 <= M2.
Proof. unfold M2; lra. Qed.

(** M1 <= M2^2 / 2, M2 M0 <= M1^2 / 2 and 9 M0 <= M2 M1: then the sum of sizes is at most 29 (M2 M1)^2. *)
Let M1_small : 2 * M1 <= M2 * M2.
Proof.
  destruct products as (H1 & H2 & H3 & H4 & H5); unfold M1, M2.
  replace ((A + B + 1 + P + Q) * (A + B + 1 + P + Q)) with
    (2 * (A * B + A + B + B * P + A * Q) + (A * A + B * B + 1 + P * P + Q * Q
      + 2 * (A * P) + 2 * (B * Q) + 2 * P + 2 * Q + 2 * (P * Q))) by ring.
  assert (0 <= A * A /\ 0 <= B * B /\ 0 <= P * P /\ 0 <= Q * Q) by (repeat split; apply Rmult_le_pos; lra); lra.
Qed.

Let M2_M0_small : 2 * (M2 * M0) <= M1 * M1.
Proof.
  destruct products as (H1 & H2 & H3 & H4 & H5); unfold M1, M2, M0.
  assert (E : (A * B + A + B + B * P + A * Q) * (A * B + A + B + B * P + A * Q) - 2 * ((A + B + 1 + P + Q) * (A * B))
    = (A * B) * (A * B) + A * A + B * B + (B * P) * (B * P) + (A * Q) * (A * Q)
      + 2 * ((A * B) * (B * P)) + 2 * ((A * B) * (A * Q)) + 2 * (A * (A * Q)) + 2 * (B * (B * P))
      + 2 * ((B * P) * (A * Q)) ) by ring.
  assert (T : forall s t, 0 <= s -> 0 <= t -> 0 <= s * t) by (intros; apply Rmult_le_pos; assumption).
  assert (0 <= A * B) by (apply T; lra).
  pose proof (T (A * B) (A * B)); pose proof (T A A); pose proof (T B B); pose proof (T (B * P) (B * P));
  pose proof (T (A * Q) (A * Q)); pose proof (T (A * B) (B * P)); pose proof (T (A * B) (A * Q));
  pose proof (T A (A * Q)); pose proof (T B (B * P)); pose proof (T (B * P) (A * Q)); lra.
Qed.

Let M0_small : 9 * M0 <= M2 * M1.
Proof.
  destruct products as (H1 & H2 & H3 & H4 & H5); unfold M1, M2, M0.
  assert (T : forall s t, 0 <= s -> 0 <= t -> 0 <= s * t) by (intros; apply Rmult_le_pos; assumption).
  assert (E : (A + B + 1 + P + Q) * (A * B + A + B + B * P + A * Q) - 9 * (A * B)
    = A * ((B - 1) * (B - 1)) + B * ((A - 1) * (A - 1)) + (A - B) * (A - B)
      + ((A + B + 1) * (B * P + A * Q) + (P + Q) * (A * B + A + B + B * P + A * Q))) by ring.
  assert (S : forall s, 0 <= s * s) by (intros s; pose proof (pow2_ge_0 s); lra).
  assert (X1 : 0 <= A * ((B - 1) * (B - 1))) by (apply T; [lra | apply S]).
  assert (X2 : 0 <= B * ((A - 1) * (A - 1))) by (apply T; [lra | apply S]).
  assert (X3 : 0 <= (A + B + 1) * (B * P + A * Q)) by (apply T; lra).
  assert (X4 : 0 <= A * B) by (apply T; lra).
  assert (X5 : 0 <= (P + Q) * (A * B + A + B + B * P + A * Q)) by (apply T; lra).
  pose proof (S (A - B)); lra.
Qed.

Lemma size_of_delta_3_at_most : magnitude env StageTwo.delta_3 <= 32 * (M2 * M1 * (M2 * M1)).
Proof.
  rewrite size_delta_3; set (m := M2 * M1); pose proof M1_pos; pose proof M2_ge_1; assert (0 < m) by (apply Rmult_lt_0_compat; lra).
  pose proof M1_small; pose proof M2_M0_small; pose proof M0_small; pose proof M1_pos; pose proof M0_pos; pose proof M2_ge_1.
  assert (0 <= M2 * M0) by (apply Rmult_le_pos; lra); assert (0 <= M2 * M2) by exact (Rle_0_sqr M2).
  assert (F1 : 0 <= M2 * M2 + 3 * M1 <= 5 / 2 * (M2 * M2)) by lra.
  assert (F3 : 0 <= M1 * M1 + 3 * (M2 * M0) <= 5 / 2 * (M1 * M1)) by (pose proof (Rle_0_sqr M1); unfold Rsqr in *; lra).
  assert (F2 : 0 <= m + 9 * M0 <= 2 * m) by (unfold m in *; lra).
  assert (G : (M2 * M2 + 3 * M1) * (M1 * M1 + 3 * (M2 * M0)) <= 5 / 2 * (M2 * M2) * (5 / 2 * (M1 * M1)))
    by (apply Rmult_le_compat; lra).
  assert (K : (m + 9 * M0) * (m + 9 * M0) <= 2 * m * (2 * m)) by (apply Rmult_le_compat; lra).
  replace (5 / 2 * (M2 * M2) * (5 / 2 * (M1 * M1))) with (25 / 4 * (m * m)) in G by (unfold m; field).
  assert (0 <= m * m) by exact (Rle_0_sqr m); lra.
Qed.

(** ** The constants. *)

Let fine e : divides_well env e -> forall k c X, count exact_inputs e = k -> INR k * (INR k + 1) <= 10000 -> INR k + 1 <= c ->
  computes u exact_inputs env e X -> Rabs (X - value env e) <= c * u * magnitude env e.
Proof.
  intros D k c X K S C E; pose proof (error_bound u exact_inputs env U1 e X D E) as H; rewrite K in H.
  apply Rle_trans with (growth u k * magnitude env e); [assumption |].
  destruct (counted u exact_inputs env U1 e X D E) as [V _].
  apply Rmult_le_compat_r; [pose proof (Rabs_pos (value env e)); lra | apply small; assumption].
Qed.

Let no_zero_divisor : b <> 0 /\ d <> 0 /\ b * b <> 0.
Proof. repeat split; try lra; apply Rmult_integral_contrapositive; lra. Qed.

Theorem error_of_c0 X : computes u exact_inputs env StageTwo.c0 X -> Rabs (X - UnitBall.c0 A B P Q) <= 8 * u * M0.
Proof.
  rewrite <- value_c0, <- size_c0; apply fine with (k := 7%nat); [| reflexivity | simpl; lra | simpl; lra].
  destruct no_zero_divisor as (N1 & N2 & N3); unfold env; simpl; repeat split; assumption.
Qed.

Theorem error_of_c1 X : computes u exact_inputs env StageTwo.c1 X -> Rabs (X - UnitBall.c1 A B P Q) <= 12 * u * M1.
Proof.
  rewrite <- value_c1, <- size_c1; apply fine with (k := 11%nat); [| reflexivity | simpl; lra | simpl; lra].
  destruct no_zero_divisor as (N1 & N2 & N3); unfold env; simpl; repeat split; assumption.
Qed.

Theorem error_of_c2 X : computes u exact_inputs env StageTwo.c2 X -> Rabs (X - UnitBall.c2 A B P Q) <= 8 * u * M2.
Proof.
  rewrite <- value_c2, <- size_c2; apply fine with (k := 7%nat); [| reflexivity | simpl; lra | simpl; lra].
  destruct no_zero_divisor as (N1 & N2 & N3); unfold env; simpl; repeat split; assumption.
Qed.

Theorem error_of_delta_3 X : computes u exact_inputs env StageTwo.delta_3 X ->
  Rabs (X - 3 * disc (UnitBall.c2 A B P Q) (UnitBall.c1 A B P Q) (UnitBall.c0 A B P Q))
  <= 1536 * u * (M2 * M1 * (M2 * M1)).
Proof.
  intros C; rewrite <- value_delta_3; apply Rle_trans with (48 * u * magnitude env StageTwo.delta_3).
  - revert C; apply fine with (k := 42%nat); [| reflexivity | simpl; lra | simpl; lra].
    destruct no_zero_divisor as (N1 & N2 & N3); unfold env; simpl; repeat split; assumption.
  - pose proof size_of_delta_3_at_most; replace (1536 * u * (M2 * M1 * (M2 * M1)))
      with (48 * u * (32 * (M2 * M1 * (M2 * M1)))) by ring.
    apply Rmult_le_compat_l; lra.
Qed.

End Kernel.
