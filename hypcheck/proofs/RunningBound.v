(** The running bounds of the kernel's second stage cover the errors of 3 delta, of the slopes at the poles and of the
    offsets from them, whatever was rounded and contracted, and what little was lost besides: by underflow. *)

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

(** A number that lies within l of one that is computed so. *)
Definition nearly (C : R -> Prop) l v := exists w, C w /\ Rabs (v - w) <= l.

(** Inputs that may be a product before it is rounded, where an operation is contracted with it. *)
Definition products_unrounded (n : nat) := 1%nat.

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
Variables fA fB fAB fBP fAQ fP fQ f1 f2 lost : R.
Hypotheses (CA : returns StageTwo.A fA) (CB : returns StageTwo.B fB) (CAB : returns StageTwo.AB fAB)
  (CBP : nearly (returns StageTwo.BP) lost fBP) (CAQ : nearly (returns StageTwo.AQ) lost fAQ) (CP : nearly (returns StageTwo.P) lost fP)
  (CQ : nearly (returns StageTwo.Q) lost fQ) (C1 : nearly (returns StageTwo.c1) lost f1) (C2 : nearly (returns StageTwo.c2) lost f2).
Hypotheses (BP0 : 0 <= fBP) (AQ0 : 0 <= fAQ) (P0 : 0 <= fP) (Q0 : 0 <= fQ).

(** What is lost is small beside these. *)
Let small := / 2 ^ 52 * / 2 ^ 52 * / 2 ^ 52.
Hypotheses (L1 : 0 <= lost <= small) (LA : lost <= small * fA) (LAB : lost <= small * fAB) (LABB : lost <= small * (fAB * fAB)).

Let coefficients n := nth n [- fAB; f1; f2] 0.
Variables g1 g2 g3 : R.
Hypotheses (G1 : nearly (computes u exact_inputs coefficients StageTwo.Parts.h1) lost g1)
  (G2 : nearly (computes u exact_inputs coefficients StageTwo.Parts.h2) lost g2)
  (G3 : nearly (computes u exact_inputs coefficients StageTwo.Parts.h3) lost g3).

Let hessian n := nth n [g1; g2; g3] 0.
Variable delta_3 : R.
Hypothesis CD : nearly (computes u exact_inputs hessian StageTwo.Last.delta_3) lost delta_3.

(** The constants of the header: u there is 2^-52, and the slack is 1 + 2^-20. *)
Definition unit := / 2 ^ 52.
Definition slack := 1 + / 2 ^ 20.

Let known n := nth n [fA; fB; fAB; fBP; fAQ; fP; fQ; Rabs f1; Rabs f2; Rabs g1; Rabs g2; Rabs g3;
                      4 * unit * slack; 8 * unit * slack; 12 * unit * slack; slack; 16 * unit * slack] 0.
Variable E : R.
Hypothesis CE : computes u products_unrounded known StageTwo.Bound.E E.

Let U1 : 0 <= u < 1.
Proof. split; [lra |]; apply Rle_lt_trans with (/ 2 ^ 52); [lra |]; simpl; lra. Qed.

Let Hunit : unit = / 4503599627370496.
Proof. unfold unit; f_equal; simpl; lra. Qed.
Let Hslack : slack = 1 + / 1048576.
Proof. unfold slack; f_equal; f_equal; simpl; lra. Qed.
Let Uu : 0 <= u <= / 4503599627370496.
Proof. rewrite <- Hunit; exact U. Qed.

Let Hsmall : small = / 4503599627370496 * / 4503599627370496 * / 4503599627370496.
Proof. unfold small; fold unit; rewrite Hunit; reflexivity. Qed.

(** The slack makes up for as many as 400 factors, and has half of itself to spare. *)
Let reserve := / 2097152.
Let slack_has_reserve k f : (k <= 400)%nat -> factor u k f -> 1 <= (slack - reserve) * f.
Proof.
  intros K [L _]; pose proof (bernoulli u k ltac:(lra)) as N; apply le_INR in K; rewrite (INR_IZR_INZ 400) in K; simpl in K.
  pose proof (pos_INR k); assert (INR k * u <= 400 * / 4503599627370496) by (apply Rmult_le_compat; lra).
  rewrite Hslack; unfold reserve; apply Rle_trans with ((1 + / 1048576 - / 2097152) * (1 - 400 * / 4503599627370496)); [lra |].
  apply Rmult_le_compat_l; lra.
Qed.
Let slack_covers k f : (k <= 400)%nat -> factor u k f -> 1 <= slack * f.
Proof.
  intros K F; pose proof (slack_has_reserve k f K F) as H; pose proof (factor_pos u U1 _ _ F) as P0'.
  assert (0 <= reserve * f) by (apply Rmult_le_pos; unfold reserve; lra); lra.
Qed.

Let no_zero : b <> 0 /\ d <> 0 /\ b * b <> 0.
Proof. repeat split; try lra; apply Rmult_integral_contrapositive; lra. Qed.

Let row_positive : positive row StageTwo.A /\ positive row StageTwo.B /\ positive row StageTwo.P /\ positive row StageTwo.Q.
Proof.
  destruct no_zero as (N1 & N2 & N3); assert (0 < b * b) by (apply Rmult_lt_0_compat; lra).
  unfold row; simpl; repeat split; try lra; try tauto.
  all: right; repeat split; auto; tauto.
Qed.

(** What was computed of positive terms, times the slack and what a bound's own roundings make of it, is at least the exact value. *)
Let spared e v X : positive row e -> (count exact_inputs e <= 30)%nat -> returns e X -> value row e = v ->
  forall k f, (k <= 200)%nat -> factor u k f -> 0 <= X /\ v + reserve * f * X <= slack * f * X.
Proof.
  intros PE K C EV k f L F; destruct (positive_factor u exact_inputs row e X U1 PE C) as (t & T & ->).
  pose proof (positive_value row e PE) as V0; rewrite EV in *; pose proof (factor_pos u U1 _ _ T).
  assert (S : 1 <= (slack - reserve) * (f * t)) by (apply slack_has_reserve with (k + count exact_inputs e)%nat; [lia | apply factor_mul; assumption]).
  split; [apply Rmult_le_pos; lra |].
  assert (H1 : 1 * v <= (slack - reserve) * (f * t) * v) by (apply Rmult_le_compat_r; assumption).
  replace (slack * f * (v * t)) with ((slack - reserve) * (f * t) * v + reserve * f * (v * t)) by ring; lra.
Qed.
Let spared_nearly e v X : positive row e -> (count exact_inputs e <= 30)%nat -> nearly (returns e) lost X -> value row e = v ->
  forall k f, (k <= 200)%nat -> factor u k f -> v <= slack * f * (X + lost).
Proof.
  intros PE K (w & C & L) V k f KF F; destruct (spared e v w PE K C V k f KF F) as [W H]; pose proof (factor_pos u U1 _ _ F).
  assert (0 <= reserve * f * w) by (repeat apply Rmult_le_pos; unfold reserve; lra).
  assert (0 <= slack * f) by (apply Rmult_le_pos; rewrite ?Hslack; lra).
  pose proof (Rle_abs (- (X - w))) as T; rewrite Rabs_Ropp in T.
  apply Rle_trans with (slack * f * w); [lra | apply Rmult_le_compat_l; lra].
Qed.

Let still k f : (k <= 200)%nat -> factor u k f ->
  (0 <= fA /\ A + reserve * f * fA <= slack * f * fA) /\ (0 <= fB /\ B + reserve * f * fB <= slack * f * fB)
  /\ (0 <= fAB /\ A * B + reserve * f * fAB <= slack * f * fAB) /\ P <= slack * f * (fP + lost) /\ Q <= slack * f * (fQ + lost)
  /\ B * P <= slack * f * (fBP + lost) /\ A * Q <= slack * f * (fAQ + lost).
Proof.
  intros K F; refine (conj _ (conj _ (conj _ (conj _ (conj _ (conj _ _)))))).
  - apply (spared StageTwo.A) with k; [apply row_positive | vm_compute; lia | exact CA | | exact K | exact F]; unfold A, row; simpl; field; lra.
  - apply (spared StageTwo.B) with k; [apply row_positive | vm_compute; lia | exact CB | | exact K | exact F]; unfold B, row; simpl; field; lra.
  - apply (spared StageTwo.AB) with k; [left; split; apply row_positive | vm_compute; lia | exact CAB | | exact K | exact F]; unfold A, B, row; simpl; field; lra.
  - apply (spared_nearly StageTwo.P) with k; [apply row_positive | vm_compute; lia | exact CP | | exact K | exact F]; unfold P, row; simpl; field; lra.
  - apply (spared_nearly StageTwo.Q) with k; [apply row_positive | vm_compute; lia | exact CQ | | exact K | exact F]; unfold Q, row; simpl; field; lra.
  - apply (spared_nearly StageTwo.BP) with k; [left; split; apply row_positive | vm_compute; lia | exact CBP | | exact K | exact F]; unfold B, P, row; simpl; field; lra.
  - apply (spared_nearly StageTwo.AQ) with k; [left; split; apply row_positive | vm_compute; lia | exact CAQ | | exact K | exact F]; unfold A, Q, row; simpl; field; lra.
Qed.

Let has_A : 0 <= fA.
Proof. apply (still 0 1 ltac:(lia) (factor_1 u U1 0)). Qed.
Let has_B : 0 <= fB.
Proof. apply (still 0 1 ltac:(lia) (factor_1 u U1 0)). Qed.
Let has_AB : 0 <= fAB.
Proof. apply (still 0 1 ltac:(lia) (factor_1 u U1 0)). Qed.

Let exact_sizes : 0 <= A /\ 0 <= B /\ 0 <= P /\ 0 <= Q /\ 0 <= A * B /\ 0 <= B * P /\ 0 <= A * Q.
Proof.
  assert (0 <= A) by (apply Rlt_le, A_pos; assumption); assert (0 <= B) by (apply Rlt_le, B_pos; assumption).
  assert (0 <= P) by (apply P_ge_0; assumption); assert (0 <= Q) by apply Q_ge_0; repeat split; try assumption;
    apply Rmult_le_pos; assumption.
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

Let error_0 : Rabs (- fAB - UnitBall.c0 A B P Q) <= V StageTwo.Bound.e0.
Proof.
  assert (C0 : returns StageTwo.c0 (- fAB)) by (apply c_neg; exact CAB).
  pose proof (error_of_c0 alpha gamma b d x y z u Ha Hg Hb Hd U (- fAB) C0) as H; rewrite E0.
  destruct (still 0 1 ltac:(lia) (factor_1 u U1 0)) as (_ & _ & [N SAB] & _); destruct exact_sizes as (_ & _ & _ & _ & AB0 & _).
  assert (0 <= reserve * 1 * fAB) by (repeat apply Rmult_le_pos; unfold reserve; lra).
  apply Rle_trans with (1 := H); replace (8 * unit * slack * fAB) with (8 * unit * (slack * 1 * fAB)) by ring.
  unfold Kernel.M0; fold A B; apply Rmult_le_compat; unfold unit; lra.
Qed.

Let at_least_half k f : (k <= 200)%nat -> factor u k f -> / 2 <= f.
Proof.
  intros K F; pose proof (slack_covers k f ltac:(lia) F) as H; rewrite Hslack in H; lra.
Qed.

Let error_with_1 k f : (k <= 200)%nat -> factor u k f -> Rabs (f1 - UnitBall.c1 A B P Q) <= 12 * unit * slack * (fA + fB + fAB + (fBP + fAQ)) * f.
Proof.
  intros K F; destruct C1 as (w & C & L).
  pose proof (error_of_c1 alpha gamma b d x y z u Ha Hg Hb Hd U w C) as H; pose proof (at_least_half k f K F) as HF.
  destruct (still k f K F) as ([A0 SA] & [B0 SB] & [AB0 SAB] & _ & _ & SBP & SAQ); destruct exact_sizes as (XA & XB & _ & _ & XAB & XBP & XAQ).
  assert (M : 12 * u * Kernel.M1 alpha gamma b d x y z <= 12 * unit * Kernel.M1 alpha gamma b d x y z).
  { unfold Kernel.M1; fold A B P Q; apply Rmult_le_compat_r; [lra | unfold unit; lra]. }
  assert (R1 : 0 <= reserve * f * fB) by (repeat apply Rmult_le_pos; unfold reserve; lra).
  assert (R2 : 0 <= reserve * f * fAB) by (repeat apply Rmult_le_pos; unfold reserve; lra).
  assert (N : Kernel.M1 alpha gamma b d x y z + reserve * f * fA <= slack * f * (fA + fB + fAB + (fBP + fAQ)) + slack * f * (2 * lost))
    by (unfold Kernel.M1; fold A B P Q; lra).
  assert (G : lost + 12 * unit * (slack * f * (2 * lost)) <= 12 * unit * (reserve * f * fA)).
  { rewrite Hunit, Hslack; unfold reserve; rewrite Hsmall in LA.
    assert (0 <= lost * f) by (apply Rmult_le_pos; lra).
    assert (lost * f <= / 4503599627370496 * / 4503599627370496 * / 4503599627370496 * fA * f) by (apply Rmult_le_compat_r; lra).
    assert (/ 2 * fA <= f * fA) by (apply Rmult_le_compat_r; lra); lra. }
  pose proof (chain_error f1 w (UnitBall.c1 A B P Q) _ _ L H) as EE; apply Rle_trans with (1 := EE).
  assert (T : 12 * unit * (Kernel.M1 alpha gamma b d x y z + reserve * f * fA)
    <= 12 * unit * (slack * f * (fA + fB + fAB + (fBP + fAQ)) + slack * f * (2 * lost))) by (apply Rmult_le_compat_l; [lra | exact N]).
  lra.
Qed.

Let error_with_2 k f : (k <= 200)%nat -> factor u k f -> Rabs (f2 - UnitBall.c2 A B P Q) <= 8 * unit * slack * (fA + fB + 1 + (fP + fQ)) * f.
Proof.
  intros K F; destruct C2 as (w & C & L).
  pose proof (error_of_c2 alpha gamma b d x y z u Ha Hg Hb Hd U w C) as H; pose proof (at_least_half k f K F) as HF.
  destruct (still k f K F) as ([A0 SA] & [B0 SB] & _ & SP & SQ & _); destruct exact_sizes as (XA & XB & XP & XQ & _).
  assert (M : 8 * u * Kernel.M2 alpha gamma b d x y z <= 8 * unit * Kernel.M2 alpha gamma b d x y z).
  { unfold Kernel.M2; fold A B P Q; apply Rmult_le_compat_r; [lra | unfold unit; lra]. }
  pose proof (slack_has_reserve k f ltac:(lia) F) as S1.
  assert (R1 : 0 <= reserve * f * fB) by (repeat apply Rmult_le_pos; unfold reserve; lra).
  assert (R2 : 0 <= reserve * f * fA) by (repeat apply Rmult_le_pos; unfold reserve; lra).
  assert (N : Kernel.M2 alpha gamma b d x y z + reserve * f <= slack * f * (fA + fB + 1 + (fP + fQ)) + slack * f * (2 * lost))
    by (unfold Kernel.M2; fold A B P Q; lra).
  assert (G : lost + 8 * unit * (slack * f * (2 * lost)) <= 8 * unit * (reserve * f)).
  { rewrite Hunit, Hslack; unfold reserve; rewrite Hsmall in L1.
    assert (0 <= lost * f) by (apply Rmult_le_pos; lra).
    assert (lost * f <= / 4503599627370496 * / 4503599627370496 * / 4503599627370496 * f) by (apply Rmult_le_compat_r; lra); lra. }
  pose proof (chain_error f2 w (UnitBall.c2 A B P Q) _ _ L H) as EE; apply Rle_trans with (1 := EE).
  assert (T : 8 * unit * (Kernel.M2 alpha gamma b d x y z + reserve * f)
    <= 8 * unit * (slack * f * (fA + fB + 1 + (fP + fQ)) + slack * f * (2 * lost))) by (apply Rmult_le_compat_l; [lra | exact N]).
  lra.
Qed.

Let error_1 : Rabs (f1 - UnitBall.c1 A B P Q) <= V StageTwo.Bound.e1.
Proof. rewrite E1, <- (Rmult_1_r (12 * _ * _ * _)); apply (error_with_1 0 1 ltac:(lia) (factor_1 u U1 0)). Qed.

Let error_2 : Rabs (f2 - UnitBall.c2 A B P Q) <= V StageTwo.Bound.e2.
Proof. rewrite E2, <- (Rmult_1_r (8 * _ * _ * _)); apply (error_with_2 0 1 ltac:(lia) (factor_1 u U1 0)). Qed.

Let few k c : INR k * (INR k + 1) <= 100 -> INR k + 1 <= c -> growth u k <= c * u.
Proof.
  intros K C; pose proof (pos_INR k); apply Rle_trans with ((INR k + 1) * u); [apply growth_is_small; [exact U1 |] |].
  - apply Rle_trans with (100 * / 4503599627370496); [apply Rmult_le_compat; try lra; apply Rmult_le_pos; lra | lra].
  - apply Rmult_le_compat_r; lra.
Qed.

(** Two roundings in each of h1, h2, h3 and 3 delta: 4u of the sizes covers them. *)
Let two_roundings env e X : divides_well env e -> count exact_inputs e = 2%nat -> nearly (computes u exact_inputs env e) lost X ->
  Rabs (X - value env e) <= lost + 4 * unit * slack * magnitude env e.
Proof.
  intros D K (w & C & L); apply chain_error with w; [exact L |]; clear X L; rename w into X; pose proof (error_bound u exact_inputs env U1 e X D C) as H; rewrite K in H.
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
  pose proof error_0; pose proof error_1; pose proof error_2; pose proof has_AB as AB0.
  pose proof (Rabs_pos (- fAB - UnitBall.c0 A B P Q)); pose proof (Rabs_pos (f1 - UnitBall.c1 A B P Q));
  pose proof (Rabs_pos (f2 - UnitBall.c2 A B P Q)); pose proof (Rabs_pos f1); pose proof (Rabs_pos f2).
  assert (0 <= q4) by (unfold q4; rewrite Hunit, Hslack; lra).
  unfold m0, m1, m2, e0, e1, e2; rewrite Rabs_Ropp, (Rabs_pos_eq fAB) by assumption; repeat split; lra.
Qed.

(** What is lost is less than a rounding of the errors that the sizes hold. *)
Let little : lost <= q4 * (3 * e1) /\ lost <= q4 * (9 * e0) /\ lost <= q4 * (3 * (e2 * fAB)) /\ lost <= q4 * (9 * e0 * (9 * e0))
  /\ lost <= q4 * e1 /\ lost <= q4 * e2.
Proof.
  destruct sizes as (S0 & S1 & S2 & Q4 & _); pose proof has_A as A0; pose proof has_B as B0; pose proof has_AB as AB0.
  assert (Qs : 4 * / 4503599627370496 <= q4) by (unfold q4; rewrite Hunit, Hslack; lra).
  assert (X0 : 8 * / 4503599627370496 * fAB <= e0) by (unfold e0; rewrite E0, Hunit, Hslack; lra).
  assert (X1 : 12 * / 4503599627370496 * fA <= e1) by (unfold e1; rewrite E1, Hunit, Hslack; lra).
  assert (X2 : 8 * / 4503599627370496 <= e2) by (unfold e2; rewrite E2, Hunit, Hslack; lra).
  assert (le : forall X Y, X <= Y -> 0 <= X -> 4 * / 4503599627370496 * X <= q4 * Y) by (intros; apply Rmult_le_compat; lra).
  pose proof (le _ _ X0 ltac:(lra)) as Y0; pose proof (le _ _ X1 ltac:(lra)) as Y1;
    pose proof (le _ _ X2 ltac:(lra)) as Y2.
  assert (X3 : 8 * / 4503599627370496 * fAB <= e2 * fAB) by (apply Rmult_le_compat_r; assumption).
  pose proof (le _ _ X3 ltac:(lra)) as Y3.
  assert (X4 : 8 * / 4503599627370496 * fAB * (8 * / 4503599627370496 * fAB) <= e0 * e0) by (apply Rmult_le_compat; lra).
  assert (F0 : 0 <= fAB * fAB) by (apply Rmult_le_pos; assumption).
  pose proof (le _ _ X4 ltac:(lra)) as Y4; rewrite Hsmall in LA, LAB, LABB, L1; repeat split; lra.
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
  apply Rle_trans with (lost + q4 * (Rabs f2 * Rabs f2 + 3 * Rabs f1) + ((m2 * e2 + m2 * e2) + 3 * e1)).
  - apply chain_error with (f2 * f2 - 3 * f1).
    + pose proof (two_roundings coefficients StageTwo.Parts.h1 g1) as H; unfold coefficients in H; simpl in H.
      rewrite (Rabs_pos_eq 3) in H by lra; apply H; auto; simpl; tauto.
    + apply sum_error; [apply product_error; apply error_2 | apply scaled_error; [lra | apply error_1]].
  - pose proof (product_below (Rabs f2) (Rabs f2) m2 m2) as K; pose proof (Rabs_pos f2); pose proof (Rabs_pos f1).
    assert (q4 * (Rabs f2 * Rabs f2) <= q4 * (m2 * m2)) by (apply K; unfold m2; lra).
    assert (q4 * (Rabs f1 + e1) = q4 * m1) by reflexivity; destruct little as [LE _]. lra.
Qed.

Let part_2 : Rabs (g2 - (v2 * v1 - 9 * v0)) <= B2.
Proof.
  destruct sizes as (S0 & S1 & S2 & Q4 & T0 & T1 & T2 & SA); rewrite B2_is.
  apply Rle_trans with (lost + q4 * (Rabs f2 * Rabs f1 + 9 * fAB) + ((m2 * e1 + m1 * e2) + 9 * e0)).
  - apply chain_error with (f2 * f1 - 9 * - fAB).
    + pose proof (two_roundings coefficients StageTwo.Parts.h2 g2) as H; unfold coefficients in H; simpl in H.
      rewrite (Rabs_pos_eq 9), SA in H by lra; apply H; auto; simpl; tauto.
    + apply sum_error; [apply product_error; [apply error_2 | apply error_1] | apply scaled_error; [lra | apply error_0]].
  - pose proof (product_below (Rabs f2) (Rabs f1) m2 m1) as K; pose proof (Rabs_pos f2); pose proof (Rabs_pos f1).
    assert (q4 * (Rabs f2 * Rabs f1) <= q4 * (m2 * m1)) by (apply K; unfold m2, m1; lra).
    assert (q4 * (fAB + e0) = q4 * m0) by reflexivity; destruct little as (_ & LE & _). lra.
Qed.

Let part_3 : Rabs (g3 - (v1 * v1 - 3 * (v2 * v0))) <= B3.
Proof.
  destruct sizes as (S0 & S1 & S2 & Q4 & T0 & T1 & T2 & SA); pose proof has_AB as F0; rewrite B3_is.
  apply Rle_trans with (lost + q4 * (Rabs f1 * Rabs f1 + 3 * (Rabs f2 * fAB)) + ((m1 * e1 + m1 * e1) + 3 * (m2 * e0 + m0 * e2))).
  - apply chain_error with (f1 * f1 - 3 * (f2 * - fAB)).
    + destruct G3 as (w & C & L); apply chain_error with w; [exact L |].
      pose proof (error_bound u exact_inputs coefficients U1 StageTwo.Parts.h3 w) as H; unfold coefficients in H; simpl in H.
      assert (D : divides_well coefficients StageTwo.Parts.h3) by (simpl; tauto); specialize (H D C).
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
  - pose proof (product_below (Rabs f1) (Rabs f1) m1 m1) as K1.
    pose proof (Rabs_pos f2); pose proof (Rabs_pos f1).
    assert (q4 * (Rabs f1 * Rabs f1) <= q4 * (m1 * m1)) by (apply K1; unfold m1; lra).
    assert (W : (Rabs f2 + e2) * fAB <= m2 * m0) by (apply Rmult_le_compat; unfold m2, m0; lra).
    pose proof (Rmult_le_compat_l q4 _ _ Q4 W); destruct little as (_ & _ & LE & _). lra.
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
  apply Rle_trans with (lost + q4 * (4 * (Rabs g1 * Rabs g3) + Rabs g2 * Rabs g2)
                        + (4 * (a1 * B3 + a3 * B1) + (a2 * B2 + a2 * B2))).
  - apply chain_error with (4 * (g1 * g3) - g2 * g2).
    + pose proof (two_roundings hessian StageTwo.Last.delta_3 delta_3) as H; unfold hessian in H; simpl in H.
      replace (2 * (2 * 1)) with 4 in H by ring; apply H; auto; simpl; tauto.
    + apply sum_error; [apply scaled_error; [lra |] |]; apply product_error; auto using part_1, part_2, part_3.
  - pose proof part_1; pose proof part_2; pose proof part_3.
    pose proof (Rabs_pos (g1 - (v2 * v2 - 3 * v1))); pose proof (Rabs_pos (g2 - (v2 * v1 - 9 * v0)));
    pose proof (Rabs_pos (g3 - (v1 * v1 - 3 * (v2 * v0)))); pose proof (Rabs_pos g1); pose proof (Rabs_pos g2);
    pose proof (Rabs_pos g3).
    pose proof (product_below (Rabs g1) (Rabs g3) a1 a3) as K1.
    assert (q4 * (Rabs g1 * Rabs g3) <= q4 * (a1 * a3)) by (apply K1; unfold a1, a3; lra).
    assert (N2 : 9 * e0 <= B2).
    { destruct sizes as (S0 & S1 & S2 & Q4 & T0 & T1 & T2 & _); rewrite B2_is.
      assert (0 <= m2 * (e1 + q4 * m1)) by (apply Rmult_le_pos; [lra |]; pose proof (Rmult_le_pos _ _ Q4 T1); lra).
      pose proof (Rmult_le_pos _ _ T1 S2); pose proof (Rmult_le_pos _ _ Q4 T0); lra. }
    destruct sizes as (S0 & _ & _ & Q4 & _).
    assert (W : Rabs g2 * Rabs g2 + 9 * e0 * (9 * e0) <= a2 * a2).
    { assert (9 * e0 * (9 * e0) <= B2 * B2) by (apply Rmult_le_compat; lra).
      assert (0 <= Rabs g2 * B2) by (apply Rmult_le_pos; lra); unfold a2; lra. }
    pose proof (Rmult_le_compat_l q4 _ _ Q4 W); destruct little as (_ & _ & _ & LE & _). lra.
Qed.

(** The bound itself is computed of positive terms, with fewer roundings than the slack covers. *)
Let known_positive n : 0 <= known n.
Proof.
  assert (S : 0 <= slack) by (rewrite Hslack; lra).
  assert (W : forall c, 0 <= c -> 0 <= c * unit * slack) by (intros; repeat apply Rmult_le_pos; lra).
  pose proof has_A; pose proof has_B; pose proof has_AB.
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
  destruct (positive_factor u products_unrounded known _ _ U1 PE CE) as (f & F & ->).
  assert (K : (count products_unrounded StageTwo.Bound.E <= 400)%nat) by (vm_compute; lia).
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

Theorem bound_covers_c1 X : computes u products_unrounded known StageTwo.Bound.e1 X -> Rabs (f1 - UnitBall.c1 A B P Q) <= X.
Proof.
  intros C; destruct (positive_factor u products_unrounded known _ X U1 (sums_positive StageTwo.Bound.e1 eq_refl) C) as (f & F & ->).
  change (value known StageTwo.Bound.e1) with (V StageTwo.Bound.e1); rewrite E1.
  apply (error_with_1 (count products_unrounded StageTwo.Bound.e1)); [vm_compute; lia | exact F].
Qed.

Theorem bound_covers_c2 X : computes u products_unrounded known StageTwo.Bound.e2 X -> Rabs (f2 - UnitBall.c2 A B P Q) <= X.
Proof.
  intros C; destruct (positive_factor u products_unrounded known _ X U1 (sums_positive StageTwo.Bound.e2 eq_refl) C) as (f & F & ->).
  change (value known StageTwo.Bound.e2) with (V StageTwo.Bound.e2); rewrite E2.
  apply (error_with_2 (count products_unrounded StageTwo.Bound.e2)); [vm_compute; lia | exact F].
Qed.

(** ** The slopes at the poles, g'(B) and g'(-A), and the offsets 3B + c2 and 3A - c2. *)

Let growth_sharp k : (k <= 20)%nat -> growth u k <= INR k * unit * slack.
Proof.
  intros K; apply le_INR in K; simpl in K; pose proof (pos_INR k) as K0; pose proof (bernoulli u k ltac:(lra)) as N.
  assert (PK : 0 < (1 - u) ^ k) by (apply pow_lt; lra).
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
  M = (3 * p + 2 * Rabs f2) * p + Rabs f1 -> Rabs (X - v) <= lost + growth u 10 * M ->
  Rabs (X - ((3 * p + s * (2 * v2)) * p + v1)) <= slope_needs p.
Proof.
  intros Hp S -> -> H; destruct sizes as (_ & S1 & S2 & _ & _ & T1 & T2 & _).
  pose proof (growth_sharp 10 ltac:(lia)) as G; simpl in G; pose proof (Rabs_pos f1); pose proof (Rabs_pos f2).
  assert (M0 : 0 <= (3 * p + 2 * Rabs f2) * p + Rabs f1) by (apply Rplus_le_le_0_compat; [apply Rmult_le_pos |]; lra).
  apply Rle_trans with (lost + 10 * unit * slack * ((3 * p + 2 * Rabs f2) * p + Rabs f1) + (2 * e2 * p + e1)).
  - apply chain_error with ((3 * p + s * (2 * f2)) * p + f1).
    + apply Rle_trans with (1 := H); apply Rplus_le_compat_l; apply Rmult_le_compat_r; lra.
    + replace ((3 * p + s * (2 * f2)) * p + f1 - ((3 * p + s * (2 * v2)) * p + v1))
        with (2 * p * s * (f2 - v2) + (f1 - v1)) by ring.
      pose proof (Rabs_triang (2 * p * s * (f2 - v2)) (f1 - v1)) as TR; rewrite Rabs_mult in TR.
      assert (PS : Rabs (2 * p * s) = 2 * p).
      { destruct S; subst s; [rewrite Rmult_1_r, Rabs_pos_eq by lra; reflexivity |].
        replace (2 * p * -1) with (- (2 * p)) by ring; rewrite Rabs_Ropp, Rabs_pos_eq by lra; reflexivity. }
      rewrite PS in TR; pose proof error_1 as Y1; pose proof error_2 as Y2; fold v1 e1 in Y1; fold v2 e2 in Y2.
      assert (2 * p * Rabs (f2 - v2) <= 2 * p * e2) by (apply Rmult_le_compat_l; lra); lra.
  - unfold slope_needs; assert (W : 0 <= 10 * unit * slack) by (rewrite Hunit, Hslack; lra).
    assert (10 * unit * slack * ((3 * p + 2 * Rabs f2) * p + Rabs f1 + e1) <= 10 * unit * slack * ((3 * p + 2 * m2) * p + m1)).
    { apply Rmult_le_compat_l; [assumption |]; rewrite Rplus_assoc; apply Rplus_le_compat; [apply Rmult_le_compat_r |]; unfold m1, m2; lra. }
    pose proof (Rmult_le_pos _ _ W S1).
    destruct little as (_ & _ & _ & _ & LE & _); unfold q4 in LE; lra.
Qed.

Let offset_error p s X v M : 0 < p -> s = 1 \/ s = -1 -> v = 3 * p + s * f2 -> M = 3 * p + Rabs f2 ->
  Rabs (X - v) <= lost + growth u 5 * M -> Rabs (X - (3 * p + s * v2)) <= offset_needs p.
Proof.
  intros Hp S -> -> H; destruct sizes as (_ & S1 & S2 & _ & _ & T1 & T2 & _).
  pose proof (growth_sharp 5 ltac:(lia)) as G; simpl in G; pose proof (Rabs_pos f2).
  apply Rle_trans with (lost + 5 * unit * slack * (3 * p + Rabs f2) + e2).
  - apply chain_error with (3 * p + s * f2).
    + apply Rle_trans with (1 := H); apply Rplus_le_compat_l; apply Rmult_le_compat_r; lra.
    + replace (3 * p + s * f2 - (3 * p + s * v2)) with (s * (f2 - v2)) by ring; rewrite Rabs_mult.
      assert (PS : Rabs s = 1) by (destruct S; subst s; [apply Rabs_R1 | rewrite Rabs_left; lra]).
      rewrite PS, Rmult_1_l; apply error_2.
  - unfold offset_needs; assert (W : 0 <= 5 * unit * slack) by (rewrite Hunit, Hslack; lra).
    assert (5 * unit * slack * (3 * p + Rabs f2 + e2) <= 5 * unit * slack * (3 * p + m2))
      by (apply Rmult_le_compat_l; [assumption | unfold m2; lra]).
    pose proof (Rmult_le_pos _ _ W S2).
    destruct little as (_ & _ & _ & _ & _ & LE); unfold q4 in LE; lra.
Qed.

Let bounded e X : divides_well slopes e -> nearly (computes u exact_inputs slopes e) lost X ->
  Rabs (X - value slopes e) <= lost + growth u (count exact_inputs e) * magnitude slopes e.
Proof. intros D (w & C & L); apply chain_error with w; [exact L | apply error_bound; assumption]. Qed.

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

Let bound_computed e v : only_sums e = true -> (count products_unrounded e <= 190)%nat -> V e = v ->
  computes u products_unrounded known e X_bound -> exists f, factor u (count products_unrounded e) f /\ X_bound = v * f.
Proof.
  intros O K <- C; exact (positive_factor u products_unrounded known e X_bound U1 (sums_positive e O) C).
Qed.

Theorem bound_covers_slope_at_B X : nearly (computes u exact_inputs slopes StageTwo.Slopes.slope_B) lost X ->
  computes u products_unrounded known StageTwo.Bound.bound_B X_bound ->
  Rabs (X - slope A B P Q B) <= X_bound.
Proof.
  intros C CB'; destruct (bound_computed StageTwo.Bound.bound_B (slope_bound fB) ltac:(vm_compute; reflexivity) ltac:(vm_compute; lia)) as (f & F & XB);
    [transitivity (slack * (2 ^ 1 * e2 * fB + e1 + 16 * unit * slack * ((3 * fB + 2 ^ 1 * m2) * fB + m1)));
     [reflexivity | unfold slope_bound; ring] | exact CB' |].
  rewrite XB; apply Rle_trans with (slope_needs B); [| apply (slope_suffices (count products_unrounded StageTwo.Bound.bound_B) B fB f ltac:(vm_compute; lia) is_B B_pos' F)].
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

Theorem bound_covers_slope_at_minus_A X : nearly (computes u exact_inputs slopes StageTwo.Slopes.slope_A) lost X ->
  computes u products_unrounded known StageTwo.Bound.bound_A X_bound ->
  Rabs (X - slope A B P Q (- A)) <= X_bound.
Proof.
  intros C CB'; destruct (bound_computed StageTwo.Bound.bound_A (slope_bound fA) ltac:(vm_compute; reflexivity) ltac:(vm_compute; lia)) as (f & F & XB);
    [transitivity (slack * (2 ^ 1 * e2 * fA + e1 + 16 * unit * slack * ((3 * fA + 2 ^ 1 * m2) * fA + m1)));
     [reflexivity | unfold slope_bound; ring] | exact CB' |].
  rewrite XB; apply Rle_trans with (slope_needs A); [| apply (slope_suffices (count products_unrounded StageTwo.Bound.bound_A) A fA f ltac:(vm_compute; lia) is_A A_pos' F)].
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

Theorem bound_covers_offset_at_B X : nearly (computes u exact_inputs slopes StageTwo.Slopes.offset_B) lost X ->
  computes u products_unrounded known StageTwo.Bound.offset_bound_B X_bound ->
  Rabs (X - (3 * B + UnitBall.c2 A B P Q)) <= X_bound.
Proof.
  intros C CB'; destruct (bound_computed StageTwo.Bound.offset_bound_B (offset_bound fB) ltac:(vm_compute; reflexivity) ltac:(vm_compute; lia)) as (f & F & XB);
    [reflexivity | exact CB' |].
  rewrite XB; apply Rle_trans with (offset_needs B); [| apply (slope_suffices (count products_unrounded StageTwo.Bound.offset_bound_B) B fB f ltac:(vm_compute; lia) is_B B_pos' F)].
  replace (3 * B + UnitBall.c2 A B P Q) with (3 * B + 1 * v2) by (unfold v2; ring).
  apply offset_error with (3 := eq_refl) (4 := eq_refl); auto.
  pose proof (bounded StageTwo.Slopes.offset_B X (conj (conj I divides_B) I) C) as H.
  replace (value slopes StageTwo.Slopes.offset_B) with (3 * B + 1 * f2) in H by (rewrite <- pole_B, Rmult_1_l; reflexivity).
  replace (magnitude slopes StageTwo.Slopes.offset_B) with (3 * B + Rabs f2) in H; [exact H |].
  transitivity (Rabs 3 * magnitude slopes StageTwo.Slopes.B + Rabs f2); [| reflexivity].
  rewrite size_of_pole_B, (Rabs_pos_eq 3) by lra; reflexivity.
Qed.

Theorem bound_covers_offset_at_minus_A X : nearly (computes u exact_inputs slopes StageTwo.Slopes.offset_A) lost X ->
  computes u products_unrounded known StageTwo.Bound.offset_bound_A X_bound ->
  Rabs (X - (3 * A - UnitBall.c2 A B P Q)) <= X_bound.
Proof.
  intros C CB'; destruct (bound_computed StageTwo.Bound.offset_bound_A (offset_bound fA) ltac:(vm_compute; reflexivity) ltac:(vm_compute; lia)) as (f & F & XB);
    [reflexivity | exact CB' |].
  rewrite XB; apply Rle_trans with (offset_needs A); [| apply (slope_suffices (count products_unrounded StageTwo.Bound.offset_bound_A) A fA f ltac:(vm_compute; lia) is_A A_pos' F)].
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
