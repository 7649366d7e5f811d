(** How far a straight-line program in floats can be from its exact value: the count of hypcheck/derivation/rounding.py.

    Every operation returns its exact result times 1 + delta with |delta| <= u: rounding without overflow or underflow,
    in any mode for which u is the unit. delta may be 0, so a product that is contracted into a fused multiply-add, and
    not rounded, is covered as well. *)

Require Import Reals Lra Lia ZArith.
From Hypcheck Require Import Geometry.
Open Scope R_scope.

Inductive expr :=
| Input (n : nat)
| Whole (z : Z)
| Neg (a : expr)
| Scale (n : nat) (a : expr)    (* times 2^n, which rounds nothing *)
| Add (a b : expr)
| Sub (a b : expr)
| Mul (a b : expr)
| Div (a b : expr).

Fixpoint value (env : nat -> R) e := match e with
  | Input n => env n | Whole z => IZR z | Neg a => - value env a | Scale n a => 2 ^ n * value env a
  | Add a b => value env a + value env b | Sub a b => value env a - value env b
  | Mul a b => value env a * value env b | Div a b => value env a / value env b end.

(** The sum of the sizes of all terms. *)
Fixpoint magnitude (env : nat -> R) e := match e with
  | Input n => Rabs (env n) | Whole z => Rabs (IZR z) | Neg a => magnitude env a
  | Scale n a => 2 ^ n * magnitude env a
  | Add a b | Sub a b => magnitude env a + magnitude env b
  | Mul a b => magnitude env a * magnitude env b | Div a b => magnitude env a / magnitude env b end.

(** The roundings that a term has at most; [entry n] are those of input n: 0 where it is a float. *)
Fixpoint count (entry : nat -> nat) e := match e with
  | Input n => entry n | Whole _ => 0 | Neg a | Scale _ a => count entry a
  | Add a b | Sub a b => S (max (count entry a) (count entry b))
  | Mul a b | Div a b => S (count entry a + count entry b) end%nat.

(** One term only: no sum. Only such expressions may be divided by. *)
Fixpoint one_term e := match e with
  | Input _ | Whole _ => true | Neg a | Scale _ a => one_term a
  | Add _ _ | Sub _ _ => false | Mul a b | Div a b => one_term a && one_term b end%bool.

Fixpoint divides_well (env : nat -> R) e := match e with
  | Input _ | Whole _ => True | Neg a | Scale _ a => divides_well env a
  | Add a b | Sub a b | Mul a b => divides_well env a /\ divides_well env b
  | Div a b => divides_well env a /\ divides_well env b /\ one_term b = true /\ value env b <> 0 end.

(** Inputs that are floats. *)
Definition exact_inputs (n : nat) := 0%nat.

Section Counting.

Variables (u : R) (entry : nat -> nat) (env : nat -> R).
Hypothesis U : 0 <= u < 1.

(** A product of at most k factors 1 + delta, or of their inverses. *)
Definition factor (k : nat) f := (1 - u) ^ k <= f <= / (1 - u) ^ k.

(** What the program may return. *)
Inductive computes : expr -> R -> Prop :=
| c_input n f : factor (entry n) f -> computes (Input n) (env n * f)
| c_whole z : computes (Whole z) (IZR z)
| c_neg a x : computes a x -> computes (Neg a) (- x)
| c_scale n a x : computes a x -> computes (Scale n a) (2 ^ n * x)
| c_add a b x y t : computes a x -> computes b y -> Rabs t <= u -> computes (Add a b) ((x + y) * (1 + t))
| c_sub a b x y t : computes a x -> computes b y -> Rabs t <= u -> computes (Sub a b) ((x - y) * (1 + t))
| c_mul a b x y t : computes a x -> computes b y -> Rabs t <= u -> computes (Mul a b) (x * y * (1 + t))
| c_div a b x y t : computes a x -> computes b y -> Rabs t <= u -> computes (Div a b) (x / y * (1 + t)).

Let q_pow k : 0 < (1 - u) ^ k.
Proof. apply pow_lt; lra. Qed.

Let q_pow_le_1 k : (1 - u) ^ k <= 1.
Proof. pose proof (pow_incr (1 - u) 1 k ltac:(lra)) as H; rewrite pow1 in H; exact H. Qed.

Let q_pow_anti j k : (j <= k)%nat -> (1 - u) ^ k <= (1 - u) ^ j.
Proof.
  intros L; replace k with (j + (k - j))%nat by lia; rewrite pow_add.
  rewrite <- (Rmult_1_r ((1 - u) ^ j)) at 2; apply Rmult_le_compat_l; [left; apply q_pow | apply q_pow_le_1].
Qed.

Let inverse_ge_1 k : 1 <= / (1 - u) ^ k.
Proof.
  pose proof (q_pow k); pose proof (q_pow_le_1 k).
  apply Rmult_le_reg_l with ((1 - u) ^ k); [assumption |]; rewrite Rinv_r by lra; lra.
Qed.

(** The bound's growth: 1 / (1 - u)^k - 1. *)
Definition growth k := / (1 - u) ^ k - 1.

Lemma growth_ge_0 k : 0 <= growth k.
Proof.
  unfold growth; pose proof (inverse_ge_1 k); lra.
Qed.

Lemma growth_mono j k : (j <= k)%nat -> growth j <= growth k.
Proof.
  intros L; unfold growth; assert (/ (1 - u) ^ j <= / (1 - u) ^ k); [| lra].
  apply Rinv_le_contravar; [apply q_pow | apply q_pow_anti; assumption].
Qed.

Lemma growth_sum j k : 1 + growth (j + k) = (1 + growth j) * (1 + growth k).
Proof.
  unfold growth; rewrite pow_add, Rinv_mult; ring.
Qed.

Lemma factor_of_rounding t : Rabs t <= u -> factor 1 (1 + t).
Proof.
  intros T; pose proof (Rle_abs t); pose proof (Rle_abs (- t)); rewrite Rabs_Ropp in *; unfold factor; simpl.
  rewrite Rmult_1_r; split; [lra |].
  apply Rmult_le_reg_l with (1 - u); [lra |]; rewrite Rinv_r by lra; nra.
Qed.

Lemma factor_pos k f : factor k f -> 0 < f.
Proof. intros [L _]; pose proof (q_pow k); lra. Qed.

Lemma factor_1 k : factor k 1.
Proof.
  split; [apply q_pow_le_1 | apply inverse_ge_1].
Qed.

Lemma factor_mul j k f h : factor j f -> factor k h -> factor (j + k) (f * h).
Proof.
  intros [L1 U1] [L2 U2]; pose proof (q_pow j); pose proof (q_pow k); unfold factor.
  rewrite pow_add, Rinv_mult; split.
  - apply Rmult_le_compat; lra.
  - apply Rmult_le_compat; lra.
Qed.

Lemma factor_inv k f : factor k f -> factor k (/ f).
Proof.
  intros [L H]; pose proof (q_pow k); split.
  - rewrite <- (Rinv_inv ((1 - u) ^ k)); apply Rinv_le_contravar; lra.
  - apply Rinv_le_contravar; lra.
Qed.

Lemma factor_off k f : factor k f -> Rabs (f - 1) <= growth k.
Proof.
  intros [L H]; pose proof (q_pow k); unfold growth; apply Rabs_le; split; [| lra].
  assert (2 <= (1 - u) ^ k + / (1 - u) ^ k); [| lra].
  set (p := (1 - u) ^ k) in *; apply Rmult_le_reg_l with p; [assumption |].
  rewrite Rmult_plus_distr_l, Rinv_r by lra; pose proof (pow2_ge_0 (p - 1)); lra.
Qed.

(** An expression of one term is its exact value times a factor. *)
Lemma one_term_factor e x : one_term e = true -> divides_well env e -> computes e x ->
  exists f, factor (count entry e) f /\ x = value env e * f.
Proof.
  intros O D C; induction C; simpl in *; try discriminate.
  - exists f; auto.
  - exists 1; split; [apply factor_1 | ring].
  - destruct IHC as (f & F & ->); auto; exists f; split; [assumption | ring].
  - destruct IHC as (f & F & ->); auto; exists f; split; [assumption | ring].
  - apply andb_prop in O; destruct O as [O1 O2]; destruct D as [D1 D2].
    destruct IHC1 as (f & F & ->); auto; destruct IHC2 as (h & G & ->); auto.
    exists (f * h * (1 + t)); split; [| ring].
    replace (S (count entry a + count entry b)) with (count entry a + count entry b + 1)%nat by lia.
    apply factor_mul; [apply factor_mul | apply factor_of_rounding]; assumption.
  - apply andb_prop in O; destruct O as [O1 O2]; destruct D as (D1 & D2 & _ & N).
    destruct IHC1 as (f & F & ->); auto; destruct IHC2 as (h & G & ->); auto; pose proof (factor_pos _ _ G).
    exists (f * / h * (1 + t)); split; [| field; lra].
    replace (S (count entry a + count entry b)) with (count entry a + count entry b + 1)%nat by lia.
    apply factor_mul; [apply factor_mul | apply factor_of_rounding]; try assumption; apply factor_inv; assumption.
Qed.

Lemma one_term_magnitude e : one_term e = true -> magnitude env e = Rabs (value env e).
Proof.
  induction e; simpl; intros O; try discriminate; try reflexivity.
  - rewrite Rabs_Ropp; auto.
  - rewrite Rabs_mult, IHe by assumption; f_equal; symmetry; apply Rabs_pos_eq, pow_le; lra.
  - apply andb_prop in O; destruct O; rewrite Rabs_mult, IHe1, IHe2 by assumption; reflexivity.
  - apply andb_prop in O; destruct O; unfold Rdiv; rewrite Rabs_mult, IHe1, IHe2 by assumption; f_equal.
    destruct (Req_dec (value env e2) 0) as [Z | Z].
    + rewrite Z, Rabs_R0, Rinv_0, Rabs_R0; reflexivity.
    + symmetry; apply Rabs_inv.
Qed.

(** ** The claim. *)

Definition near k M v x := Rabs v <= M /\ Rabs (x - v) <= growth k * M.

Lemma near_size k M v x : near k M v x -> Rabs x <= (1 + growth k) * M.
Proof.
  intros [V X]; replace x with (v + (x - v)) by ring; pose proof (Rabs_triang v (x - v)); lra.
Qed.

Lemma near_mono j k M v x : (j <= k)%nat -> near j M v x -> near k M v x.
Proof.
  intros L [V X]; split; [assumption |]; apply Rle_trans with (growth j * M); [assumption |].
  apply Rmult_le_compat_r; [pose proof (Rabs_pos v); lra | apply growth_mono; assumption].
Qed.

Lemma near_factor k j M v x f : near k M v x -> factor j f -> near (k + j) M v (x * f).
Proof.
  intros N F; pose proof (near_size _ _ _ _ N) as S; destruct N as [V X]; split; [assumption |].
  replace (x * f - v) with (x * (f - 1) + (x - v)) by ring.
  apply Rle_trans with ((1 + growth k) * M * growth j + growth k * M).
  - apply Rle_trans with (Rabs (x * (f - 1)) + Rabs (x - v)); [apply Rabs_triang |]; rewrite Rabs_mult.
    apply Rplus_le_compat; [| assumption].
    apply Rmult_le_compat; try apply Rabs_pos; [assumption | apply factor_off; assumption].
  - replace (growth (k + j)) with ((1 + growth k) * (1 + growth j) - 1) by (rewrite <- growth_sum; ring).
    right; ring.
Qed.

Lemma near_add k M v x M' v' x' : near k M v x -> near k M' v' x' -> near k (M + M') (v + v') (x + x').
Proof.
  intros [V X] [V' X']; split.
  - apply Rle_trans with (Rabs v + Rabs v'); [apply Rabs_triang | lra].
  - replace (x + x' - (v + v')) with ((x - v) + (x' - v')) by ring.
    apply Rle_trans with (Rabs (x - v) + Rabs (x' - v')); [apply Rabs_triang | lra].
Qed.

Lemma near_opp k M v x : near k M v x -> near k M (- v) (- x).
Proof.
  intros [V X]; split; [rewrite Rabs_Ropp; assumption |].
  replace (- x - - v) with (- (x - v)) by ring; rewrite Rabs_Ropp; assumption.
Qed.

Lemma near_mul j k M v x M' v' x' : near j M v x -> near k M' v' x' -> near (j + k) (M * M') (v * v') (x * x').
Proof.
  intros N N'; pose proof (near_size _ _ _ _ N) as S; destruct N as [V X]; destruct N' as [V' X']; split.
  - rewrite Rabs_mult; apply Rmult_le_compat; auto using Rabs_pos.
  - replace (x * x' - v * v') with (x * (x' - v') + (x - v) * v') by ring.
    apply Rle_trans with ((1 + growth j) * M * (growth k * M') + growth j * M * M').
    + apply Rle_trans with (Rabs (x * (x' - v')) + Rabs ((x - v) * v')); [apply Rabs_triang |]; rewrite !Rabs_mult.
      apply Rplus_le_compat; apply Rmult_le_compat; auto using Rabs_pos.
    + replace (growth (j + k)) with ((1 + growth j) * (1 + growth k) - 1) by (rewrite <- growth_sum; ring).
      right; ring.
Qed.

Theorem counted e x : divides_well env e -> computes e x -> near (count entry e) (magnitude env e) (value env e) x.
Proof.
  intros D C; induction C; simpl in *.
  - rewrite <- (Nat.add_0_l (entry n)); apply near_factor; [| assumption].
    split; [lra |]; rewrite Rminus_diag_eq, Rabs_R0 by reflexivity.
    apply Rmult_le_pos; [apply growth_ge_0 | apply Rabs_pos].
  - split; [lra |]; rewrite Rminus_diag_eq, Rabs_R0 by reflexivity.
    apply Rmult_le_pos; [apply growth_ge_0 | apply Rabs_pos].
  - apply near_opp; auto.
  - destruct (IHC D) as [V X]; assert (P : 0 <= 2 ^ n) by (apply pow_le; lra); split.
    + rewrite Rabs_mult, (Rabs_pos_eq (2 ^ n)) by assumption; apply Rmult_le_compat_l; assumption.
    + replace (2 ^ n * x - 2 ^ n * value env a) with (2 ^ n * (x - value env a)) by ring.
      rewrite Rabs_mult, (Rabs_pos_eq (2 ^ n)) by assumption.
      replace (growth (count entry a) * (2 ^ n * magnitude env a))
        with (2 ^ n * (growth (count entry a) * magnitude env a)) by ring.
      apply Rmult_le_compat_l; assumption.
  - destruct D as [D1 D2]; rewrite <- Nat.add_1_r; apply near_factor; [| apply factor_of_rounding; assumption].
    apply near_add; [apply near_mono with (count entry a) | apply near_mono with (count entry b)]; auto; lia.
  - destruct D as [D1 D2]; rewrite <- Nat.add_1_r; apply near_factor; [| apply factor_of_rounding; assumption].
    apply near_add; [| apply near_opp];
      [apply near_mono with (count entry a) | apply near_mono with (count entry b)]; auto; lia.
  - destruct D as [D1 D2]; rewrite <- Nat.add_1_r; apply near_factor; [| apply factor_of_rounding; assumption].
    apply near_mul; auto.
  - destruct D as (D1 & D2 & O & N); rewrite <- Nat.add_1_r; apply near_factor; [| apply factor_of_rounding; assumption].
    destruct (one_term_factor b y O D2 C2) as (f & F & ->); pose proof (factor_pos _ _ F) as FP.
    rewrite (one_term_magnitude b O).
    replace (x / (value env b * f)) with (x * / f * / value env b) by (field; lra).
    assert (K : near (count entry a + count entry b) (magnitude env a) (value env a) (x * / f))
      by (apply near_factor; [auto | apply factor_inv; assumption]).
    destruct K as [V X]; assert (P : 0 < / Rabs (value env b)) by (apply Rinv_0_lt_compat, Rabs_pos_lt; assumption).
    unfold Rdiv; split.
    + rewrite Rabs_mult, Rabs_inv; apply Rmult_le_compat_r; lra.
    + rewrite <- Rmult_minus_distr_r, Rabs_mult, Rabs_inv.
      rewrite <- Rmult_assoc; apply Rmult_le_compat_r; lra.
Qed.

Corollary error_bound e x : divides_well env e -> computes e x ->
  Rabs (x - value env e) <= growth (count entry e) * magnitude env e.
Proof. intros D C; apply (counted e x D C). Qed.

(** A computed value beyond the bound has the sign of the exact one. *)
Corollary sign_is_right e x bound : divides_well env e -> computes e x ->
  growth (count entry e) * magnitude env e <= bound ->
  (bound < x -> 0 < value env e) /\ (x < - bound -> value env e < 0).
Proof.
  intros D C B; pose proof (error_bound e x D C) as E.
  pose proof (Rle_abs (x - value env e)); pose proof (Rle_abs (- (x - value env e))); rewrite Rabs_Ropp in *.
  split; intros; lra.
Qed.

End Counting.
