(** The running bounds of the kernel's second stage cover the errors of 3 delta, of the slopes at the poles and of the
    offsets from them, whatever was rounded and contracted. *)

Require Import Reals Lra Lia List Arith.
From Hypcheck Require Import Geometry UnitBall Cubic Rounding Kernel.
From Hypcheck Require StageTwo.
Import ListNotations.
Open Scope R_scope.

(** ** Sums of positive terms are their exact value times a factor. *)

Fixpoint positive env e : Prop := match e with
  | Input n => 0 <= env n | Whole z => 0 <= IZR z | Neg _ | Sub _ _ => False | Scale _ a => positive env a
  | Add a b => positive env a /\ positive env b
  | Mul a b => (positive env a /\ positive env b) \/ (a = b /\ one_term a = true /\ divides_well env a)
  | Div a b => positive env a /\ positive env b /\ 0 < value env b end.

Lemma positive_value env e : positive env e -> 0 <= value env e.
Proof.
  induction e; simpl; intros H; try contradiction; try assumption.
  - apply Rmult_le_pos; [apply pow_le; lra | auto].
  - destruct H; apply Rplus_le_le_0_compat; auto.
  - destruct H as [[H1 H2] | (-> & _ & _)]; [apply Rmult_le_pos; auto | pose proof (pow2_ge_0 (value env e2)); lra].
  - destruct H as (H1 & H2 & H3); apply over_pos; auto.
Qed.

Lemma factor_weaken u j k f : 0 <= u < 1 -> (j <= k)%nat -> factor u j f -> factor u k f.
Proof.
  intros U L F; replace k with (j + (k - j))%nat by lia; rewrite <- (Rmult_1_r f).
  apply factor_mul; [assumption | assumption | apply factor_1; assumption].
Qed.

(** A weighted mean of factors is a factor. *)
Lemma factor_mean u k v w f g : 0 <= u < 1 -> 0 <= v -> 0 <= w -> factor u k f -> factor u k g ->
  exists m, factor u k m /\ v * f + w * g = (v + w) * m.
Proof.
  intros U V W F G; destruct (Req_dec (v + w) 0) as [Z | Z].
  - exists 1; split; [apply factor_1; assumption |]; assert (v = 0) by lra; assert (w = 0) by lra; subst; ring.
  - exists ((v * f + w * g) / (v + w)); split; [| field; assumption].
    destruct F as [L1 H1]; destruct G as [L2 H2].
    split; apply Rmult_le_reg_r with (v + w); try lra; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by assumption; nra.
Qed.

Theorem positive_factor u entry env e x : 0 <= u < 1 -> positive env e -> computes u entry env e x ->
  exists f, factor u (count entry e) f /\ x = value env e * f.
Proof.
  intros U P C; induction C; simpl in P; try contradiction; simpl.
  - exists f; auto.
  - exists 1; split; [apply factor_1; assumption | ring].
  - destruct (IHC P) as (f & F & ->); exists f; split; [assumption | ring].
  - destruct P as [P1 P2]; destruct (IHC1 P1) as (f & F & ->); destruct (IHC2 P2) as (h & G & ->).
    destruct (factor_mean u (max (count entry a) (count entry b)) (value env a) (value env b) f h U) as (m & M & E);
      auto using positive_value.
    + apply factor_weaken with (count entry a); auto; lia.
    + apply factor_weaken with (count entry b); auto; lia.
    + exists (m * (1 + t)); split; [| rewrite E; ring].
      rewrite <- Nat.add_1_r; apply factor_mul; [assumption | assumption | apply factor_of_rounding; assumption].
  - assert (K : exists f h, factor u (count entry a) f /\ factor u (count entry b) h
                            /\ x = value env a * f /\ y = value env b * h).
    { destruct P as [[P1 P2] | (<- & O & D)].
      - destruct (IHC1 P1) as (f & F & ->); destruct (IHC2 P2) as (h & G & ->); exists f, h; auto.
      - destruct (one_term_factor u entry env U a x O D C1) as (f & F & ->).
        destruct (one_term_factor u entry env U a y O D C2) as (h & G & ->); exists f, h; auto. }
    destruct K as (f & h & F & G & -> & ->); exists (f * h * (1 + t)); split; [| ring].
    rewrite <- Nat.add_1_r; apply factor_mul; [assumption | | apply factor_of_rounding; assumption].
    apply factor_mul; assumption.
  - destruct P as (P1 & P2 & N); destruct (IHC1 P1) as (f & F & ->); destruct (IHC2 P2) as (h & G & ->).
    pose proof (factor_pos u U _ _ G); exists (f * / h * (1 + t)); split; [| field; lra].
    rewrite <- Nat.add_1_r; apply factor_mul; [assumption | | apply factor_of_rounding; assumption].
    apply factor_mul; [assumption | assumption | apply factor_inv; assumption].
Qed.

(** ** How errors go through products. *)

Lemma product_error x v ex y w ey : Rabs (x - v) <= ex -> Rabs (y - w) <= ey ->
  Rabs (x * y - v * w) <= (Rabs x + ex) * ey + (Rabs y + ey) * ex.
Proof.
  intros X Y; pose proof (Rabs_pos (x - v)); pose proof (Rabs_pos (y - w)).
  replace (x * y - v * w) with (x * (y - w) + w * (x - v)) by ring.
  apply Rle_trans with (Rabs x * Rabs (y - w) + Rabs w * Rabs (x - v)).
  - rewrite <- !Rabs_mult; apply Rabs_triang.
  - assert (W : Rabs w <= Rabs y + ey).
    { replace w with (y - (y - w)) by ring; pose proof (Rabs_triang y (- (y - w))).
      rewrite Rabs_Ropp in *; unfold Rminus at 1; lra. }
    pose proof (Rabs_pos x); pose proof (Rabs_pos w).
    apply Rplus_le_compat; apply Rmult_le_compat; lra.
Qed.

Lemma sum_error x v ex y w ey : Rabs (x - v) <= ex -> Rabs (y - w) <= ey -> Rabs (x - y - (v - w)) <= ex + ey.
Proof.
  intros X Y; replace (x - y - (v - w)) with ((x - v) + - (y - w)) by ring.
  pose proof (Rabs_triang (x - v) (- (y - w))); rewrite Rabs_Ropp in *; lra.
Qed.

Lemma scaled_error c x v ex : 0 <= c -> Rabs (x - v) <= ex -> Rabs (c * x - c * v) <= c * ex.
Proof.
  intros C X; rewrite <- Rmult_minus_distr_l, Rabs_mult, (Rabs_pos_eq c) by assumption.
  apply Rmult_le_compat_l; assumption.
Qed.

Lemma chain_error x v w e f : Rabs (x - v) <= e -> Rabs (v - w) <= f -> Rabs (x - w) <= e + f.
Proof.
  intros X Y; replace (x - w) with ((x - v) + (v - w)) by ring; pose proof (Rabs_triang (x - v) (v - w)); lra.
Qed.

Section Bound.

Variables alpha gamma b d x y z u : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d) (U : 0 <= u <= / 2 ^ 52).

Let row n := nth n [alpha; gamma; b; d; x; y; z] 0.
Let returns := computes u exact_inputs row.

Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let P := (x ^ 2 + y ^ 2) / b ^ 2.
Let Q := (z / d) ^ 2.

(** What the machine has computed before the bound. *)
Variables fA fB fAB fBP fAQ fP fQ f1 f2 : R.
Hypotheses (CA : returns StageTwo.A fA) (CB : returns StageTwo.B fB) (CAB : returns StageTwo.AB fAB)
  (CBP : returns StageTwo.BP fBP) (CAQ : returns StageTwo.AQ fAQ) (CP : returns StageTwo.P fP)
  (CQ : returns StageTwo.Q fQ) (C1 : returns StageTwo.c1 f1) (C2 : returns StageTwo.c2 f2).

Let coefficients n := nth n [- fAB; f1; f2] 0.
Variables g1 g2 g3 : R.
Hypotheses (G1 : computes u exact_inputs coefficients StageTwo.Parts.h1 g1)
  (G2 : computes u exact_inputs coefficients StageTwo.Parts.h2 g2)
  (G3 : computes u exact_inputs coefficients StageTwo.Parts.h3 g3).

Let hessian n := nth n [g1; g2; g3] 0.
Variable delta_3 : R.
Hypothesis CD : computes u exact_inputs hessian StageTwo.Last.delta_3 delta_3.

(** The constants of the header: u there is 2^-52, and the slack is 1 + 2^-20. *)
Definition unit := / 2 ^ 52.
Definition slack := 1 + / 2 ^ 20.

Let known n := nth n [fA; fB; fAB; fBP; fAQ; fP; fQ; Rabs f1; Rabs f2; Rabs g1; Rabs g2; Rabs g3;
                      4 * unit * slack; 8 * unit * slack; 12 * unit * slack; slack; 16 * unit * slack] 0.
Variable E : R.
Hypothesis CE : computes u exact_inputs known StageTwo.Bound.E E.

Let U1 : 0 <= u < 1.
Proof. split; [lra |]; apply Rle_lt_trans with (/ 2 ^ 52); [lra |]; simpl; lra. Qed.

Let Hunit : unit = / 4503599627370496.
Proof. unfold unit; f_equal; simpl; lra. Qed.
Let Hslack : slack = 1 + / 1048576.
Proof. unfold slack; f_equal; f_equal; simpl; lra. Qed.
Let Uu : 0 <= u <= / 4503599627370496.
Proof. rewrite <- Hunit; exact U. Qed.

(** The slack makes up for as many as 200 factors. *)
Let slack_covers k f : (k <= 200)%nat -> factor u k f -> 1 <= slack * f.
Proof.
  intros K [L _]; pose proof (bernoulli u k ltac:(lra)) as N; apply le_INR in K; simpl in K.
  pose proof (pos_INR k); assert (INR k * u <= 200 * / 4503599627370496) by (apply Rmult_le_compat; lra).
  rewrite Hslack; apply Rle_trans with ((1 + / 1048576) * (1 - 200 * / 4503599627370496)); [lra |].
  apply Rmult_le_compat_l; lra.
Qed.

Let no_zero : b <> 0 /\ d <> 0 /\ b * b <> 0.
Proof. repeat split; try lra; apply Rmult_integral_contrapositive; lra. Qed.

(** What was computed of positive terms, times the slack, is at least the exact value. *)
Let at_least e v X : positive row e -> (count exact_inputs e <= 200)%nat -> returns e X -> value row e = v ->
  0 <= X /\ v <= slack * X.
Proof.
  intros PE K C V; destruct (positive_factor u exact_inputs row e X U1 PE C) as (f & F & ->).
  pose proof (positive_value row e PE) as V0; pose proof (slack_covers _ _ K F); pose proof (factor_pos u U1 _ _ F).
  split; [apply Rmult_le_pos; lra |]; rewrite <- V; nra.
Qed.

Let row_positive : positive row StageTwo.A /\ positive row StageTwo.B /\ positive row StageTwo.P /\ positive row StageTwo.Q.
Proof.
  destruct no_zero as (N1 & N2 & N3); assert (0 < b * b) by (apply Rmult_lt_0_compat; lra).
  unfold row; simpl; repeat split; try lra; try tauto.
  all: right; repeat split; auto; tauto.
Qed.

Let has_A : 0 <= fA /\ A <= slack * fA.
Proof. apply (at_least StageTwo.A); [apply row_positive | vm_compute; lia | exact CA |]. unfold A, row; simpl; field; lra. Qed.
Let has_B : 0 <= fB /\ B <= slack * fB.
Proof. apply (at_least StageTwo.B); [apply row_positive | vm_compute; lia | exact CB |]. unfold B, row; simpl; field; lra. Qed.
Let has_P : 0 <= fP /\ P <= slack * fP.
Proof. apply (at_least StageTwo.P); [apply row_positive | vm_compute; lia | exact CP |]. unfold P, row; simpl; field; lra. Qed.
Let has_Q : 0 <= fQ /\ Q <= slack * fQ.
Proof. apply (at_least StageTwo.Q); [apply row_positive | vm_compute; lia | exact CQ |]. unfold Q, row; simpl; field; lra. Qed.
Let has_AB : 0 <= fAB /\ A * B <= slack * fAB.
Proof.
  apply (at_least StageTwo.AB); [left; split; apply row_positive | vm_compute; lia | exact CAB |].
  unfold A, B, row; simpl; field; lra.
Qed.
Let has_BP : 0 <= fBP /\ B * P <= slack * fBP.
Proof.
  apply (at_least StageTwo.BP); [left; split; apply row_positive | vm_compute; lia | exact CBP |].
  unfold B, P, row; simpl; field; lra.
Qed.
Let has_AQ : 0 <= fAQ /\ A * Q <= slack * fAQ.
Proof.
  apply (at_least StageTwo.AQ); [left; split; apply row_positive | vm_compute; lia | exact CAQ |].
  unfold A, Q, row; simpl; field; lra.
Qed.

(** ** The values of the bound's steps, and what they cover. *)

Let V := value known.

Let E0 : V StageTwo.Bound.e0 = 8 * unit * slack * fAB.
Proof. reflexivity. Qed.
Let E1 : V StageTwo.Bound.e1 = 12 * unit * slack * (fA + fB + fAB + (fBP + fAQ)).
Proof. reflexivity. Qed.
Let E2 : V StageTwo.Bound.e2 = 8 * unit * slack * (fA + fB + 1 + (fP + fQ)).
Proof. reflexivity. Qed.

Let unit_pos : 0 < unit.
Proof. rewrite Hunit; lra. Qed.

Let covers c X M : 0 <= c -> 0 <= M -> M <= slack * X -> c * u * M <= c * unit * slack * X.
Proof.
  intros C M0 H; rewrite (Rmult_assoc (c * unit)).
  apply Rmult_le_compat; [apply Rmult_le_pos; lra | lra | | assumption].
  apply Rmult_le_compat_l; [assumption | unfold unit; lra].
Qed.

Let error_0 : Rabs (- fAB - UnitBall.c0 A B P Q) <= V StageTwo.Bound.e0.
Proof.
  assert (C0 : returns StageTwo.c0 (- fAB)) by (apply c_neg; exact CAB).
  pose proof (error_of_c0 alpha gamma b d x y z u Ha Hg Hb Hd U (- fAB) C0) as H; rewrite E0.
  apply Rle_trans with (1 := H); destruct has_AB; apply covers; [lra | | assumption].
  apply Rmult_le_pos; [apply Rlt_le, A_pos | apply Rlt_le, B_pos]; assumption.
Qed.

Let error_1 : Rabs (f1 - UnitBall.c1 A B P Q) <= V StageTwo.Bound.e1.
Proof.
  pose proof (error_of_c1 alpha gamma b d x y z u Ha Hg Hb Hd U f1 C1) as H; rewrite E1.
  apply Rle_trans with (1 := H); destruct has_A, has_B, has_AB, has_BP, has_AQ; apply covers; [lra | |].
  - assert (0 <= A) by (apply Rlt_le, A_pos; assumption); assert (0 <= B) by (apply Rlt_le, B_pos; assumption).
    assert (0 <= P) by (apply P_ge_0; assumption); assert (0 <= Q) by apply Q_ge_0.
    unfold Kernel.M1; fold A B P Q.
    assert (0 <= A * B) by (apply Rmult_le_pos; lra); assert (0 <= B * P) by (apply Rmult_le_pos; lra).
    assert (0 <= A * Q) by (apply Rmult_le_pos; lra); lra.
  - unfold Kernel.M1; fold A B P Q; lra.
Qed.

Let error_2 : Rabs (f2 - UnitBall.c2 A B P Q) <= V StageTwo.Bound.e2.
Proof.
  pose proof (error_of_c2 alpha gamma b d x y z u Ha Hg Hb Hd U f2 C2) as H; rewrite E2.
  apply Rle_trans with (1 := H); destruct has_A, has_B, has_P, has_Q.
  assert (S1 : 1 <= slack) by (rewrite Hslack; lra).
  apply covers; [lra | |]; unfold Kernel.M2; fold A B P Q.
  - assert (0 <= A) by (apply Rlt_le, A_pos; assumption); assert (0 <= B) by (apply Rlt_le, B_pos; assumption).
    assert (0 <= P) by (apply P_ge_0; assumption); assert (0 <= Q) by apply Q_ge_0; lra.
  - lra.
Qed.

Let few k c : INR k * (INR k + 1) <= 100 -> INR k + 1 <= c -> growth u k <= c * u.
Proof.
  intros K C; pose proof (pos_INR k); apply Rle_trans with ((INR k + 1) * u); [apply growth_is_small; [exact U1 |] |].
  - apply Rle_trans with (100 * / 4503599627370496); [apply Rmult_le_compat; try lra; apply Rmult_le_pos; lra | lra].
  - apply Rmult_le_compat_r; lra.
Qed.

(** Two roundings in each of h1, h2, h3 and 3 delta: 4u of the sizes covers them. *)
Let two_roundings env e X : divides_well env e -> count exact_inputs e = 2%nat -> computes u exact_inputs env e X ->
  Rabs (X - value env e) <= 4 * unit * slack * magnitude env e.
Proof.
  intros D K C; pose proof (error_bound u exact_inputs env U1 e X D C) as H; rewrite K in H.
  destruct (counted u exact_inputs env U1 e X D C) as [VM _]; pose proof (Rabs_pos (value env e)).
  apply Rle_trans with (1 := H); apply Rmult_le_compat_r; [lra |].
  apply Rle_trans with (3 * u); [apply (few 2); simpl; lra |].
  rewrite Hunit, Hslack; lra.
Qed.

Let q4 := 4 * unit * slack.
Let e0 := V StageTwo.Bound.e0.
Let e1 := V StageTwo.Bound.e1.
Let e2 := V StageTwo.Bound.e2.
Let m0 := fAB + e0.
Let m1 := Rabs f1 + e1.
Let m2 := Rabs f2 + e2.

Let v0 := UnitBall.c0 A B P Q.
Let v1 := UnitBall.c1 A B P Q.
Let v2 := UnitBall.c2 A B P Q.

Let sizes : 0 <= e0 /\ 0 <= e1 /\ 0 <= e2 /\ 0 <= q4 /\ 0 <= m0 /\ 0 <= m1 /\ 0 <= m2 /\ Rabs (- fAB) = fAB.
Proof.
  pose proof error_0; pose proof error_1; pose proof error_2; destruct has_AB as [AB0 _].
  pose proof (Rabs_pos (- fAB - UnitBall.c0 A B P Q)); pose proof (Rabs_pos (f1 - UnitBall.c1 A B P Q));
  pose proof (Rabs_pos (f2 - UnitBall.c2 A B P Q)); pose proof (Rabs_pos f1); pose proof (Rabs_pos f2).
  assert (0 <= q4) by (unfold q4; rewrite Hunit, Hslack; lra).
  unfold m0, m1, m2, e0, e1, e2; rewrite Rabs_Ropp, (Rabs_pos_eq fAB) by assumption; repeat split; lra.
Qed.

Let B1 := V StageTwo.Bound.E1.
Let B2 := V StageTwo.Bound.E2.
Let B3 := V StageTwo.Bound.E3.

Let B1_is : B1 = m2 * (2 * e2 + q4 * m2) + 3 * (e1 + q4 * m1).
Proof. transitivity (m2 * (2 ^ 1 * e2 + q4 * m2) + 3 * (e1 + q4 * m1)); [reflexivity | ring]. Qed.
Let B2_is : B2 = m2 * (e1 + q4 * m1) + m1 * e2 + 9 * (e0 + q4 * m0).
Proof. reflexivity. Qed.
Let B3_is : B3 = m1 * (2 * e1 + q4 * m1) + 3 * (m2 * (e0 + q4 * m0) + m0 * e2).
Proof. transitivity (m1 * (2 ^ 1 * e1 + q4 * m1) + 3 * (m2 * (e0 + q4 * m0) + m0 * e2)); [reflexivity | ring]. Qed.

Let size_below f e : 0 <= e -> Rabs f <= Rabs f + e.
Proof. lra. Qed.

Let product_below p q r s : 0 <= p <= r -> 0 <= q <= s -> q4 * (p * q) <= q4 * (r * s).
Proof. destruct sizes as (_ & _ & _ & Q4 & _); intros; apply Rmult_le_compat_l; [assumption |]; apply Rmult_le_compat; lra. Qed.

Let part_1 : Rabs (g1 - (v2 * v2 - 3 * v1)) <= B1.
Proof.
  destruct sizes as (S0 & S1 & S2 & Q4 & T0 & T1 & T2 & SA); rewrite B1_is.
  apply Rle_trans with (q4 * (Rabs f2 * Rabs f2 + 3 * Rabs f1) + ((m2 * e2 + m2 * e2) + 3 * e1)).
  - apply chain_error with (f2 * f2 - 3 * f1).
    + pose proof (two_roundings coefficients StageTwo.Parts.h1 g1) as H; unfold coefficients in H; simpl in H.
      rewrite (Rabs_pos_eq 3) in H by lra; apply H; auto; simpl; tauto.
    + apply sum_error; [apply product_error; apply error_2 | apply scaled_error; [lra | apply error_1]].
  - pose proof (product_below (Rabs f2) (Rabs f2) m2 m2) as K; pose proof (Rabs_pos f2); pose proof (Rabs_pos f1).
    assert (q4 * (Rabs f2 * Rabs f2) <= q4 * (m2 * m2)) by (apply K; unfold m2; lra).
    assert (q4 * Rabs f1 <= q4 * m1) by (apply Rmult_le_compat_l; unfold m1; lra). lra.
Qed.

Let part_2 : Rabs (g2 - (v2 * v1 - 9 * v0)) <= B2.
Proof.
  destruct sizes as (S0 & S1 & S2 & Q4 & T0 & T1 & T2 & SA); rewrite B2_is.
  apply Rle_trans with (q4 * (Rabs f2 * Rabs f1 + 9 * fAB) + ((m2 * e1 + m1 * e2) + 9 * e0)).
  - apply chain_error with (f2 * f1 - 9 * - fAB).
    + pose proof (two_roundings coefficients StageTwo.Parts.h2 g2) as H; unfold coefficients in H; simpl in H.
      rewrite (Rabs_pos_eq 9), SA in H by lra; apply H; auto; simpl; tauto.
    + apply sum_error; [apply product_error; [apply error_2 | apply error_1] | apply scaled_error; [lra | apply error_0]].
  - pose proof (product_below (Rabs f2) (Rabs f1) m2 m1) as K; pose proof (Rabs_pos f2); pose proof (Rabs_pos f1).
    assert (q4 * (Rabs f2 * Rabs f1) <= q4 * (m2 * m1)) by (apply K; unfold m2, m1; lra).
    assert (q4 * fAB <= q4 * m0) by (apply Rmult_le_compat_l; unfold m0; lra). lra.
Qed.

Let part_3 : Rabs (g3 - (v1 * v1 - 3 * (v2 * v0))) <= B3.
Proof.
  destruct sizes as (S0 & S1 & S2 & Q4 & T0 & T1 & T2 & SA); destruct has_AB as [F0 _]; rewrite B3_is.
  apply Rle_trans with (q4 * (Rabs f1 * Rabs f1 + 3 * (Rabs f2 * fAB)) + ((m1 * e1 + m1 * e1) + 3 * (m2 * e0 + m0 * e2))).
  - apply chain_error with (f1 * f1 - 3 * (f2 * - fAB)).
    + pose proof (error_bound u exact_inputs coefficients U1 StageTwo.Parts.h3 g3) as H; unfold coefficients in H; simpl in H.
      assert (D : divides_well coefficients StageTwo.Parts.h3) by (simpl; tauto); specialize (H D G3).
      rewrite (Rabs_pos_eq 3), SA in H by lra; apply Rle_trans with (1 := H).
      apply Rmult_le_compat_r.
      * pose proof (Rabs_pos f1); pose proof (Rabs_pos f2).
        assert (0 <= Rabs f1 * Rabs f1) by (apply Rmult_le_pos; lra).
        assert (0 <= Rabs f2 * fAB) by (apply Rmult_le_pos; lra); lra.
      * apply Rle_trans with (4 * u); [apply (few 3); simpl; lra |].
        unfold q4; rewrite Hunit, Hslack; lra.
    + apply sum_error; [apply product_error; apply error_1 | apply scaled_error; [lra |]].
      replace (m2 * e0 + m0 * e2) with ((Rabs f2 + e2) * e0 + (Rabs (- fAB) + e0) * e2) by (rewrite SA; reflexivity).
      apply product_error; [apply error_2 | apply error_0].
  - pose proof (product_below (Rabs f1) (Rabs f1) m1 m1) as K1; pose proof (product_below (Rabs f2) fAB m2 m0) as K2.
    pose proof (Rabs_pos f2); pose proof (Rabs_pos f1).
    assert (q4 * (Rabs f1 * Rabs f1) <= q4 * (m1 * m1)) by (apply K1; unfold m1; lra).
    assert (q4 * (Rabs f2 * fAB) <= q4 * (m2 * m0)) by (apply K2; unfold m2, m0; lra). lra.
Qed.

Let a1 := Rabs g1 + B1.
Let a2 := Rabs g2 + B2.
Let a3 := Rabs g3 + B3.

Let E_is : V StageTwo.Bound.E = slack * (4 * (a1 * (B3 + q4 * a3) + a3 * B1) + a2 * (2 * B2 + q4 * a2)).
Proof.
  transitivity (slack * (2 ^ 2 * (a1 * (B3 + q4 * a3) + a3 * B1) + a2 * (2 ^ 1 * B2 + q4 * a2))); [reflexivity | ring].
Qed.

Let exact_bound : Rabs (delta_3 - 3 * disc v2 v1 v0) <= V StageTwo.Bound.E / slack.
Proof.
  assert (S : 0 < slack) by (rewrite Hslack; lra).
  replace (V StageTwo.Bound.E / slack) with (4 * (a1 * (B3 + q4 * a3) + a3 * B1) + a2 * (2 * B2 + q4 * a2))
    by (rewrite E_is; field; lra).
  rewrite disc_hessian; unfold h.
  replace (4 * (v2 ^ 2 - 3 * v1) * (v1 ^ 2 - 3 * v2 * v0) - (v2 * v1 - 9 * v0) ^ 2)
    with (4 * ((v2 * v2 - 3 * v1) * (v1 * v1 - 3 * (v2 * v0))) - (v2 * v1 - 9 * v0) * (v2 * v1 - 9 * v0)) by ring.
  apply Rle_trans with (q4 * (4 * (Rabs g1 * Rabs g3) + Rabs g2 * Rabs g2)
                        + (4 * (a1 * B3 + a3 * B1) + (a2 * B2 + a2 * B2))).
  - apply chain_error with (4 * (g1 * g3) - g2 * g2).
    + pose proof (two_roundings hessian StageTwo.Last.delta_3 delta_3) as H; unfold hessian in H; simpl in H.
      replace (2 * (2 * 1)) with 4 in H by ring; apply H; auto; simpl; tauto.
    + apply sum_error; [apply scaled_error; [lra |] |]; apply product_error; auto using part_1, part_2, part_3.
  - pose proof part_1; pose proof part_2; pose proof part_3.
    pose proof (Rabs_pos (g1 - (v2 * v2 - 3 * v1))); pose proof (Rabs_pos (g2 - (v2 * v1 - 9 * v0)));
    pose proof (Rabs_pos (g3 - (v1 * v1 - 3 * (v2 * v0)))); pose proof (Rabs_pos g1); pose proof (Rabs_pos g2);
    pose proof (Rabs_pos g3).
    pose proof (product_below (Rabs g1) (Rabs g3) a1 a3) as K1; pose proof (product_below (Rabs g2) (Rabs g2) a2 a2) as K2.
    assert (q4 * (Rabs g1 * Rabs g3) <= q4 * (a1 * a3)) by (apply K1; unfold a1, a3; lra).
    assert (q4 * (Rabs g2 * Rabs g2) <= q4 * (a2 * a2)) by (apply K2; unfold a2; lra). lra.
Qed.

(** The bound itself is computed of positive terms, with fewer roundings than the slack covers. *)
Let known_positive n : 0 <= known n.
Proof.
  assert (S : 0 <= slack) by (rewrite Hslack; lra).
  assert (W : forall c, 0 <= c -> 0 <= c * unit * slack) by (intros; repeat apply Rmult_le_pos; lra).
  destruct has_A, has_B, has_AB, has_BP, has_AQ, has_P, has_Q.
  do 17 (destruct n as [| n]; [unfold known; simpl; auto using Rabs_pos; apply W; lra |]).
  unfold known; destruct n; simpl; lra.
Qed.

Fixpoint only_sums e := match e with
  | Input _ => true | Whole z => (0 <=? z)%Z | Scale _ a => only_sums a
  | Add a b | Mul a b => only_sums a && only_sums b | _ => false end%bool.

Let sums_positive e : only_sums e = true -> positive known e.
Proof.
  induction e; simpl; intros O; try discriminate; auto.
  - apply IZR_le, Z.leb_le; assumption.
  - apply andb_prop in O; destruct O; auto.
  - apply andb_prop in O; destruct O; auto.
Qed.

Theorem running_bound_covers_the_error :
  Rabs (delta_3 - 3 * disc (UnitBall.c2 A B P Q) (UnitBall.c1 A B P Q) (UnitBall.c0 A B P Q)) <= E.
Proof.
  apply Rle_trans with (1 := exact_bound).
  assert (PE : positive known StageTwo.Bound.E) by (apply sums_positive; vm_compute; reflexivity).
  destruct (positive_factor u exact_inputs known _ _ U1 PE CE) as (f & F & ->).
  assert (K : (count exact_inputs StageTwo.Bound.E <= 200)%nat) by (vm_compute; lia).
  pose proof (slack_covers _ _ K F) as S; pose proof (positive_value known _ PE) as V0; fold V in V0 |- *.
  assert (S0 : 0 < slack) by (rewrite Hslack; lra).
  apply Rmult_le_reg_l with slack; [assumption |].
  replace (slack * (V StageTwo.Bound.E / slack)) with (V StageTwo.Bound.E) by (field; lra).
  replace (slack * (V StageTwo.Bound.E * f)) with (V StageTwo.Bound.E * (slack * f)) by ring.
  rewrite <- (Rmult_1_r (V StageTwo.Bound.E)) at 1; apply Rmult_le_compat_l; assumption.
Qed.

Corollary running_bound_decides :
  (E < delta_3 -> 0 < disc (UnitBall.c2 A B P Q) (UnitBall.c1 A B P Q) (UnitBall.c0 A B P Q))
  /\ (delta_3 < - E -> disc (UnitBall.c2 A B P Q) (UnitBall.c1 A B P Q) (UnitBall.c0 A B P Q) < 0).
Proof.
  pose proof running_bound_covers_the_error as H; set (D := disc _ _ _) in *.
  pose proof (Rle_abs (delta_3 - 3 * D)); pose proof (Rle_abs (- (delta_3 - 3 * D))); rewrite Rabs_Ropp in *.
  split; intros; lra.
Qed.

(** ** The coefficients: what the machine computes of their bounds covers them too. *)

Let at_least_still e v X : positive row e -> (count exact_inputs e <= 30)%nat -> returns e X -> value row e = v ->
  forall k f, (k <= 100)%nat -> factor u k f -> v <= slack * f * X.
Proof.
  intros PE K C EV k f L F; destruct (positive_factor u exact_inputs row e X U1 PE C) as (t & T & ->).
  pose proof (positive_value row e PE) as V0; rewrite EV in *.
  assert (S : 1 <= slack * (f * t)) by (apply slack_covers with (k + count exact_inputs e)%nat; [lia | apply factor_mul; assumption]).
  replace (slack * f * (v * t)) with (slack * (f * t) * v) by ring.
  rewrite <- (Rmult_1_l v) at 1; apply Rmult_le_compat_r; assumption.
Qed.

Let still k f : (k <= 100)%nat -> factor u k f -> A <= slack * f * fA /\ B <= slack * f * fB /\ P <= slack * f * fP /\ Q <= slack * f * fQ
  /\ A * B <= slack * f * fAB /\ B * P <= slack * f * fBP /\ A * Q <= slack * f * fAQ.
Proof.
  intros K F; repeat split.
  - apply (at_least_still StageTwo.A) with k; [apply row_positive | vm_compute; lia | exact CA | | exact K | exact F]; unfold A, row; simpl; field; lra.
  - apply (at_least_still StageTwo.B) with k; [apply row_positive | vm_compute; lia | exact CB | | exact K | exact F]; unfold B, row; simpl; field; lra.
  - apply (at_least_still StageTwo.P) with k; [apply row_positive | vm_compute; lia | exact CP | | exact K | exact F]; unfold P, row; simpl; field; lra.
  - apply (at_least_still StageTwo.Q) with k; [apply row_positive | vm_compute; lia | exact CQ | | exact K | exact F]; unfold Q, row; simpl; field; lra.
  - apply (at_least_still StageTwo.AB) with k; [left; split; apply row_positive | vm_compute; lia | exact CAB | | exact K | exact F];
      unfold A, B, row; simpl; field; lra.
  - apply (at_least_still StageTwo.BP) with k; [left; split; apply row_positive | vm_compute; lia | exact CBP | | exact K | exact F];
      unfold B, P, row; simpl; field; lra.
  - apply (at_least_still StageTwo.AQ) with k; [left; split; apply row_positive | vm_compute; lia | exact CAQ | | exact K | exact F];
      unfold A, Q, row; simpl; field; lra.
Qed.

Let exact_sizes : 0 <= A /\ 0 <= B /\ 0 <= P /\ 0 <= Q /\ 0 <= A * B /\ 0 <= B * P /\ 0 <= A * Q.
Proof.
  assert (0 <= A) by (apply Rlt_le, A_pos; assumption); assert (0 <= B) by (apply Rlt_le, B_pos; assumption).
  assert (0 <= P) by (apply P_ge_0; assumption); assert (0 <= Q) by apply Q_ge_0; repeat split; try assumption;
    apply Rmult_le_pos; assumption.
Qed.

Theorem bound_covers_c1 X : computes u exact_inputs known StageTwo.Bound.e1 X -> Rabs (f1 - UnitBall.c1 A B P Q) <= X.
Proof.
  intros C; destruct (positive_factor u exact_inputs known _ X U1 (sums_positive StageTwo.Bound.e1 eq_refl) C) as (f & F & ->).
  assert (K : (count exact_inputs StageTwo.Bound.e1 <= 100)%nat) by (vm_compute; lia).
  destruct (still _ f K F) as (SA & SB & _ & _ & SAB & SBP & SAQ); destruct exact_sizes as (A0 & B0 & _ & _ & AB0 & BP0 & AQ0).
  apply Rle_trans with (1 := error_of_c1 alpha gamma b d x y z u Ha Hg Hb Hd U f1 C1).
  change (value known StageTwo.Bound.e1) with (V StageTwo.Bound.e1); rewrite E1.
  replace (12 * unit * slack * (fA + fB + fAB + (fBP + fAQ)) * f)
    with (12 * unit * (slack * f * fA + slack * f * fB + slack * f * fAB + slack * f * fBP + slack * f * fAQ)) by ring.
  unfold Kernel.M1; fold A B P Q; apply Rmult_le_compat; try lra; unfold unit; lra.
Qed.

Theorem bound_covers_c2 X : computes u exact_inputs known StageTwo.Bound.e2 X -> Rabs (f2 - UnitBall.c2 A B P Q) <= X.
Proof.
  intros C; destruct (positive_factor u exact_inputs known _ X U1 (sums_positive StageTwo.Bound.e2 eq_refl) C) as (f & F & ->).
  assert (K : (count exact_inputs StageTwo.Bound.e2 <= 100)%nat) by (vm_compute; lia).
  pose proof (slack_covers _ f ltac:(apply Nat.le_trans with (1 := K); lia) F) as S1.
  destruct (still _ f K F) as (SA & SB & SP & SQ & _); destruct exact_sizes as (A0 & B0 & P0 & Q0 & _).
  apply Rle_trans with (1 := error_of_c2 alpha gamma b d x y z u Ha Hg Hb Hd U f2 C2).
  change (value known StageTwo.Bound.e2) with (V StageTwo.Bound.e2); rewrite E2.
  replace (8 * unit * slack * (fA + fB + 1 + (fP + fQ)) * f)
    with (8 * unit * (slack * f * fA + slack * f * fB + slack * f + slack * f * fP + slack * f * fQ)) by ring.
  unfold Kernel.M2; fold A B P Q; apply Rmult_le_compat; try lra; unfold unit; lra.
Qed.

(** ** The slopes at the poles, g'(B) and g'(-A), and the offsets 3B + c2 and 3A - c2. *)

Let growth_sharp k : (k <= 20)%nat -> growth u k <= INR k * unit * slack.
Proof.
  intros K; apply le_INR in K; simpl in K; pose proof (pos_INR k) as K0; pose proof (bernoulli u k ltac:(lra)) as N.
  assert (Q0 : 0 < (1 - u) ^ k) by (apply pow_lt; lra).
  assert (KU : 0 <= INR k * u <= 20 * / 4503599627370496)
    by (split; [apply Rmult_le_pos; lra | apply Rmult_le_compat; lra]).
  assert (KS : INR k * u <= INR k * unit) by (apply Rmult_le_compat_l; [lra | unfold unit; lra]).
  unfold growth; apply Rplus_le_reg_r with 1; replace (/ (1 - u) ^ k - 1 + 1) with (/ (1 - u) ^ k) by ring.
  apply Rle_trans with (1 + INR k * u * slack); [| rewrite Hslack; lra].
  assert (1 <= (1 + INR k * u * slack) * (1 - INR k * u)).
  { rewrite Hslack; set (v := INR k * u) in *; clearbody v; clear - KU.
    replace ((1 + v * (1 + / 1048576)) * (1 - v)) with (1 + v * (/ 1048576 - (1 + / 1048576) * v)) by field.
    assert (0 <= v * (/ 1048576 - (1 + / 1048576) * v)) by (apply Rmult_le_pos; lra); lra. }
  apply Rmult_le_reg_l with ((1 - u) ^ k); [assumption |]; rewrite Rinv_r by lra.
  apply Rle_trans with ((1 - INR k * u) * (1 + INR k * u * slack)); [lra |].
  apply Rmult_le_compat_r; [rewrite Hslack; lra | assumption].
Qed.

(** How a bound that is computed from a rounded pole p' = p / r covers what is needed of the exact pole p. *)
Let pole_covered k p p' f : (k <= 190)%nat -> (exists t, factor u 3 t /\ p' = p * t) -> 0 < p -> factor u k f ->
  p <= slack * f * p' /\ 1 <= slack * f /\ p * p <= 8 / 5 * (slack * f * (p' * p')) /\ 0 < p'.
Proof.
  intros K (t & T & ->) Hp F; pose proof (factor_pos u U1 _ _ T); pose proof (factor_pos u U1 _ _ F).
  assert (H1 : 1 <= slack * f) by (apply slack_covers with k; [lia | assumption]).
  assert (H2 : 1 <= slack * (f * t)) by (apply slack_covers with (k + 3)%nat; [lia | apply factor_mul; assumption]).
  assert (H3 : 1 <= slack * (f * (t * t))).
  { apply slack_covers with (k + (3 + 3))%nat; [lia |]; repeat apply factor_mul; assumption. }
  repeat split; [| assumption | | apply Rmult_lt_0_compat; assumption].
  { replace (slack * f * (p * t)) with (slack * (f * t) * p) by ring.
    rewrite <- (Rmult_1_l p) at 1; apply Rmult_le_compat_r; lra. }
  replace (slack * f * (p * t * (p * t))) with (slack * (f * (t * t)) * (p * p)) by ring.
  assert (PP : 0 < p * p) by (apply Rmult_lt_0_compat; assumption).
  apply Rle_trans with (1 * (p * p)); [lra |]; apply Rle_trans with (slack * (f * (t * t)) * (p * p)).
  - apply Rmult_le_compat_r; lra.
  - assert (0 <= slack * (f * (t * t)) * (p * p)) by (apply Rmult_le_pos; lra); lra.
Qed.

Let slopes n := nth n [f1; f2; alpha; gamma; b; d] 0.

Let A_pos' : 0 < A := A_pos alpha b Ha Hb.
Let B_pos' : 0 < B := B_pos gamma d Hg Hd.

Let is_A : exists t, factor u 3 t /\ fA = A * t.
Proof.
  destruct (one_term_factor u exact_inputs row U1 StageTwo.A fA eq_refl) as (t & T & ->);
    [unfold row; simpl; repeat split; auto; apply no_zero | exact CA |].
  exists t; split; [exact T |]; unfold A, row; simpl; field; lra.
Qed.
Let is_B : exists t, factor u 3 t /\ fB = B * t.
Proof.
  destruct (one_term_factor u exact_inputs row U1 StageTwo.B fB eq_refl) as (t & T & ->);
    [unfold row; simpl; repeat split; auto; apply no_zero | exact CB |].
  exists t; split; [exact T |]; unfold B, row; simpl; field; lra.
Qed.

(** The sizes of slope and offset for a pole p, and the bounds as the kernel forms them from p'. *)
Let slope_bound p := slack * (2 * e2 * p + e1 + 16 * unit * slack * ((3 * p + 2 * m2) * p + m1)).
Let offset_bound p := slack * (e2 + 16 * unit * slack * (p + m2)).

Let slope_needs p := 2 * e2 * p + e1 + 10 * unit * slack * ((3 * p + 2 * m2) * p + m1).
Let offset_needs p := e2 + 5 * unit * slack * (3 * p + m2).

Let slope_suffices k p p' f : (k <= 190)%nat -> (exists t, factor u 3 t /\ p' = p * t) -> 0 < p -> factor u k f ->
  slope_needs p <= slope_bound p' * f /\ offset_needs p <= offset_bound p' * f.
Proof.
  intros K T Hp F; destruct (pole_covered k p p' f K T Hp F) as (H1 & H2 & H3 & H4).
  destruct sizes as (_ & S1 & S2 & Q4 & _ & T1 & T2 & _); set (h := slack * f) in *.
  assert (W : 0 <= unit * slack) by (rewrite Hunit, Hslack; lra); unfold slope_needs, slope_bound, offset_needs, offset_bound.
  assert (X1 : e2 * p <= e2 * (h * p')) by (apply Rmult_le_compat_l; assumption).
  assert (X2 : m2 * p <= m2 * (h * p')) by (apply Rmult_le_compat_l; assumption).
  assert (G : forall v, 0 <= v -> v <= h * v).
  { intros v V0; rewrite <- (Rmult_1_l v) at 1; apply Rmult_le_compat_r; assumption. }
  pose proof (G e1 S1) as X3; pose proof (G m1 T1) as X4; pose proof (G e2 S2) as X5; pose proof (G m2 T2) as X6.
  assert (X7 : 0 <= m2 * (h * p')) by (apply Rmult_le_pos; [assumption | apply Rmult_le_pos; lra]).
  split.
  - replace (slack * (2 * e2 * p' + e1 + 16 * unit * slack * ((3 * p' + 2 * m2) * p' + m1)) * f)
      with (2 * (e2 * (h * p')) + h * e1 + unit * slack * (16 * (3 * (h * (p' * p')) + 2 * (m2 * (h * p')) + h * m1)))
      by (unfold h; ring).
    replace (10 * unit * slack * ((3 * p + 2 * m2) * p + m1))
      with (unit * slack * (10 * (3 * (p * p) + 2 * (m2 * p) + m1))) by ring.
    assert (unit * slack * (10 * (3 * (p * p) + 2 * (m2 * p) + m1))
            <= unit * slack * (16 * (3 * (h * (p' * p')) + 2 * (m2 * (h * p')) + h * m1)))
      by (apply Rmult_le_compat_l; [assumption | lra]).
    lra.
  - replace (slack * (e2 + 16 * unit * slack * (p' + m2)) * f)
      with (h * e2 + unit * slack * (16 * (h * p' + h * m2))) by (unfold h; ring).
    replace (5 * unit * slack * (3 * p + m2)) with (unit * slack * (5 * (3 * p + m2))) by ring.
    assert (unit * slack * (5 * (3 * p + m2)) <= unit * slack * (16 * (h * p' + h * m2)))
      by (apply Rmult_le_compat_l; [assumption | lra]).
    lra.
Qed.

(** The error of a slope and of an offset; s is 1 at B and -1 at -A. *)
Let slope_error p s X v M : 0 < p -> s = 1 \/ s = -1 -> v = (3 * p + s * (2 * f2)) * p + f1 ->
  M = (3 * p + 2 * Rabs f2) * p + Rabs f1 -> Rabs (X - v) <= growth u 10 * M ->
  Rabs (X - ((3 * p + s * (2 * v2)) * p + v1)) <= slope_needs p.
Proof.
  intros Hp S -> -> H; destruct sizes as (_ & S1 & S2 & _ & _ & T1 & T2 & _).
  pose proof (growth_sharp 10 ltac:(lia)) as G; simpl in G; pose proof (Rabs_pos f1); pose proof (Rabs_pos f2).
  assert (M0 : 0 <= (3 * p + 2 * Rabs f2) * p + Rabs f1) by (apply Rplus_le_le_0_compat; [apply Rmult_le_pos |]; lra).
  apply Rle_trans with (10 * unit * slack * ((3 * p + 2 * Rabs f2) * p + Rabs f1) + (2 * e2 * p + e1)).
  - apply chain_error with ((3 * p + s * (2 * f2)) * p + f1).
    + apply Rle_trans with (1 := H); apply Rmult_le_compat_r; lra.
    + replace ((3 * p + s * (2 * f2)) * p + f1 - ((3 * p + s * (2 * v2)) * p + v1))
        with (2 * p * s * (f2 - v2) + (f1 - v1)) by ring.
      pose proof (Rabs_triang (2 * p * s * (f2 - v2)) (f1 - v1)) as TR; rewrite Rabs_mult in TR.
      assert (PS : Rabs (2 * p * s) = 2 * p).
      { destruct S; subst s; [rewrite Rmult_1_r, Rabs_pos_eq by lra; reflexivity |].
        replace (2 * p * -1) with (- (2 * p)) by ring; rewrite Rabs_Ropp, Rabs_pos_eq by lra; reflexivity. }
      rewrite PS in TR; pose proof error_1 as Y1; pose proof error_2 as Y2; fold v1 e1 in Y1; fold v2 e2 in Y2.
      assert (2 * p * Rabs (f2 - v2) <= 2 * p * e2) by (apply Rmult_le_compat_l; lra); lra.
  - unfold slope_needs; assert (W : 0 <= 10 * unit * slack) by (rewrite Hunit, Hslack; lra).
    assert (10 * unit * slack * ((3 * p + 2 * Rabs f2) * p + Rabs f1) <= 10 * unit * slack * ((3 * p + 2 * m2) * p + m1)).
    { apply Rmult_le_compat_l; [assumption |]; apply Rplus_le_compat; [apply Rmult_le_compat_r |]; unfold m1, m2; lra. }
    lra.
Qed.

Let offset_error p s X v M : 0 < p -> s = 1 \/ s = -1 -> v = 3 * p + s * f2 -> M = 3 * p + Rabs f2 ->
  Rabs (X - v) <= growth u 5 * M -> Rabs (X - (3 * p + s * v2)) <= offset_needs p.
Proof.
  intros Hp S -> -> H; destruct sizes as (_ & S1 & S2 & _ & _ & T1 & T2 & _).
  pose proof (growth_sharp 5 ltac:(lia)) as G; simpl in G; pose proof (Rabs_pos f2).
  apply Rle_trans with (5 * unit * slack * (3 * p + Rabs f2) + e2).
  - apply chain_error with (3 * p + s * f2).
    + apply Rle_trans with (1 := H); apply Rmult_le_compat_r; lra.
    + replace (3 * p + s * f2 - (3 * p + s * v2)) with (s * (f2 - v2)) by ring; rewrite Rabs_mult.
      assert (PS : Rabs s = 1) by (destruct S; subst s; [apply Rabs_R1 | rewrite Rabs_left; lra]).
      rewrite PS, Rmult_1_l; apply error_2.
  - unfold offset_needs; assert (W : 0 <= 5 * unit * slack) by (rewrite Hunit, Hslack; lra).
    assert (5 * unit * slack * (3 * p + Rabs f2) <= 5 * unit * slack * (3 * p + m2))
      by (apply Rmult_le_compat_l; [assumption | unfold m2; lra]). lra.
Qed.

Let bounded e X : divides_well slopes e -> computes u exact_inputs slopes e X ->
  Rabs (X - value slopes e) <= growth u (count exact_inputs e) * magnitude slopes e.
Proof. intros D C; apply error_bound; assumption. Qed.

Let size_of_pole_A : magnitude slopes StageTwo.Slopes.A = A.
Proof. unfold slopes, A; simpl; rewrite (Rabs_pos_eq alpha), (Rabs_pos_eq b) by lra; field; lra. Qed.
Let size_of_pole_B : magnitude slopes StageTwo.Slopes.B = B.
Proof. unfold slopes, B; simpl; rewrite (Rabs_pos_eq gamma), (Rabs_pos_eq d) by lra; field; lra. Qed.
Let pole_A : value slopes StageTwo.Slopes.A = A.
Proof. unfold slopes, A; simpl; field; lra. Qed.
Let pole_B : value slopes StageTwo.Slopes.B = B.
Proof. unfold slopes, B; simpl; field; lra. Qed.

Let divides : forall e, e = StageTwo.Slopes.A \/ e = StageTwo.Slopes.B -> divides_well slopes e.
Proof. intros e [-> | ->]; unfold slopes; simpl; repeat split; auto; lra. Qed.
Let divides_A := divides StageTwo.Slopes.A (or_introl eq_refl).
Let divides_B := divides StageTwo.Slopes.B (or_intror eq_refl).

Variables X_bound : R.

Let bound_computed e v : only_sums e = true -> (count exact_inputs e <= 190)%nat -> V e = v ->
  computes u exact_inputs known e X_bound -> exists f, factor u (count exact_inputs e) f /\ X_bound = v * f.
Proof.
  intros O K <- C; exact (positive_factor u exact_inputs known e X_bound U1 (sums_positive e O) C).
Qed.

Theorem bound_covers_slope_at_B X : computes u exact_inputs slopes StageTwo.Slopes.slope_B X ->
  computes u exact_inputs known StageTwo.Bound.bound_B X_bound ->
  Rabs (X - slope A B P Q B) <= X_bound.
Proof.
  intros C CB'; destruct (bound_computed StageTwo.Bound.bound_B (slope_bound fB) ltac:(vm_compute; reflexivity) ltac:(vm_compute; lia)) as (f & F & XB);
    [transitivity (slack * (2 ^ 1 * e2 * fB + e1 + 16 * unit * slack * ((3 * fB + 2 ^ 1 * m2) * fB + m1)));
     [reflexivity | unfold slope_bound; ring] | exact CB' |].
  rewrite XB; apply Rle_trans with (slope_needs B); [| apply (slope_suffices (count exact_inputs StageTwo.Bound.bound_B) B fB f ltac:(vm_compute; lia) is_B B_pos' F)].
  replace (slope A B P Q B) with ((3 * B + 1 * (2 * v2)) * B + v1) by (unfold slope, v2, v1; ring).
  apply slope_error with (3 := eq_refl) (4 := eq_refl); auto.
  assert (R3 : Rabs 3 = 3) by (apply Rabs_pos_eq; lra).
  pose proof (bounded StageTwo.Slopes.slope_B X (conj (conj (conj (conj I divides_B) I) divides_B) I) C) as H.
  replace (value slopes StageTwo.Slopes.slope_B) with ((3 * B + 1 * (2 * f2)) * B + f1) in H.
  2: { rewrite <- pole_B; transitivity ((3 * value slopes StageTwo.Slopes.B + 2 ^ 1 * f2) * value slopes StageTwo.Slopes.B + f1);
       [ring | reflexivity]. }
  replace (magnitude slopes StageTwo.Slopes.slope_B) with ((3 * B + 2 * Rabs f2) * B + Rabs f1) in H; [exact H |].
  transitivity ((Rabs 3 * magnitude slopes StageTwo.Slopes.B + 2 ^ 1 * Rabs f2)
                * magnitude slopes StageTwo.Slopes.B + Rabs f1); [rewrite size_of_pole_B, R3; ring | reflexivity].
Qed.

Theorem bound_covers_slope_at_minus_A X : computes u exact_inputs slopes StageTwo.Slopes.slope_A X ->
  computes u exact_inputs known StageTwo.Bound.bound_A X_bound ->
  Rabs (X - slope A B P Q (- A)) <= X_bound.
Proof.
  intros C CB'; destruct (bound_computed StageTwo.Bound.bound_A (slope_bound fA) ltac:(vm_compute; reflexivity) ltac:(vm_compute; lia)) as (f & F & XB);
    [transitivity (slack * (2 ^ 1 * e2 * fA + e1 + 16 * unit * slack * ((3 * fA + 2 ^ 1 * m2) * fA + m1)));
     [reflexivity | unfold slope_bound; ring] | exact CB' |].
  rewrite XB; apply Rle_trans with (slope_needs A); [| apply (slope_suffices (count exact_inputs StageTwo.Bound.bound_A) A fA f ltac:(vm_compute; lia) is_A A_pos' F)].
  replace (slope A B P Q (- A)) with ((3 * A + -1 * (2 * v2)) * A + v1) by (unfold slope, v2, v1; ring).
  apply slope_error with (3 := eq_refl) (4 := eq_refl); auto.
  assert (R3 : Rabs 3 = 3) by (apply Rabs_pos_eq; lra).
  pose proof (bounded StageTwo.Slopes.slope_A X (conj (conj (conj (conj I divides_A) I) divides_A) I) C) as H.
  replace (value slopes StageTwo.Slopes.slope_A) with ((3 * A + -1 * (2 * f2)) * A + f1) in H.
  2: { rewrite <- pole_A; transitivity ((3 * value slopes StageTwo.Slopes.A - 2 ^ 1 * f2) * value slopes StageTwo.Slopes.A + f1);
       [ring | reflexivity]. }
  replace (magnitude slopes StageTwo.Slopes.slope_A) with ((3 * A + 2 * Rabs f2) * A + Rabs f1) in H; [exact H |].
  transitivity ((Rabs 3 * magnitude slopes StageTwo.Slopes.A + 2 ^ 1 * Rabs f2)
                * magnitude slopes StageTwo.Slopes.A + Rabs f1); [rewrite size_of_pole_A, R3; ring | reflexivity].
Qed.

Theorem bound_covers_offset_at_B X : computes u exact_inputs slopes StageTwo.Slopes.offset_B X ->
  computes u exact_inputs known StageTwo.Bound.offset_bound_B X_bound ->
  Rabs (X - (3 * B + UnitBall.c2 A B P Q)) <= X_bound.
Proof.
  intros C CB'; destruct (bound_computed StageTwo.Bound.offset_bound_B (offset_bound fB) ltac:(vm_compute; reflexivity) ltac:(vm_compute; lia)) as (f & F & XB);
    [reflexivity | exact CB' |].
  rewrite XB; apply Rle_trans with (offset_needs B); [| apply (slope_suffices (count exact_inputs StageTwo.Bound.offset_bound_B) B fB f ltac:(vm_compute; lia) is_B B_pos' F)].
  replace (3 * B + UnitBall.c2 A B P Q) with (3 * B + 1 * v2) by (unfold v2; ring).
  apply offset_error with (3 := eq_refl) (4 := eq_refl); auto.
  pose proof (bounded StageTwo.Slopes.offset_B X (conj (conj I divides_B) I) C) as H.
  replace (value slopes StageTwo.Slopes.offset_B) with (3 * B + 1 * f2) in H by (rewrite <- pole_B, Rmult_1_l; reflexivity).
  replace (magnitude slopes StageTwo.Slopes.offset_B) with (3 * B + Rabs f2) in H; [exact H |].
  transitivity (Rabs 3 * magnitude slopes StageTwo.Slopes.B + Rabs f2); [| reflexivity].
  rewrite size_of_pole_B, (Rabs_pos_eq 3) by lra; reflexivity.
Qed.

Theorem bound_covers_offset_at_minus_A X : computes u exact_inputs slopes StageTwo.Slopes.offset_A X ->
  computes u exact_inputs known StageTwo.Bound.offset_bound_A X_bound ->
  Rabs (X - (3 * A - UnitBall.c2 A B P Q)) <= X_bound.
Proof.
  intros C CB'; destruct (bound_computed StageTwo.Bound.offset_bound_A (offset_bound fA) ltac:(vm_compute; reflexivity) ltac:(vm_compute; lia)) as (f & F & XB);
    [reflexivity | exact CB' |].
  rewrite XB; apply Rle_trans with (offset_needs A); [| apply (slope_suffices (count exact_inputs StageTwo.Bound.offset_bound_A) A fA f ltac:(vm_compute; lia) is_A A_pos' F)].
  replace (3 * A - UnitBall.c2 A B P Q) with (3 * A + -1 * v2) by (unfold v2; ring).
  apply offset_error with (3 := eq_refl) (4 := eq_refl); auto.
  pose proof (bounded StageTwo.Slopes.offset_A X (conj (conj I divides_A) I) C) as H.
  replace (value slopes StageTwo.Slopes.offset_A) with (3 * A + -1 * f2) in H.
  2: { rewrite <- pole_A; transitivity (3 * value slopes StageTwo.Slopes.A - f2); [ring | reflexivity]. }
  replace (magnitude slopes StageTwo.Slopes.offset_A) with (3 * A + Rabs f2) in H; [exact H |].
  transitivity (Rabs 3 * magnitude slopes StageTwo.Slopes.A + Rabs f2); [| reflexivity].
  rewrite size_of_pole_A, (Rabs_pos_eq 3) by lra; reflexivity.
Qed.

End Bound.
