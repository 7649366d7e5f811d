(** The rules that decide a position by the coefficients of g: local maximum, coefficients for all sizes, the ring, and
    the paper's propositions 3 and 5 put right. At the end each is said of the bodies themselves. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry Certificates UnitBall Duality AnyAxis Completeness Cubic.
Open Scope R_scope.

Section Rule.

Variables A B P Q : R.
Hypotheses (HA : 0 < A) (HB : 0 < B) (HP : 0 <= P) (HQ : 0 <= Q).

Definition outside := exists l, 0 < l < B /\ 0 < g A B P Q l.
Definition inside := exists l, - A < l < 0 /\ 0 < g A B P Q l.
Definition neither := ~ outside /\ ~ inside.

Let a2 := c2 A B P Q.
Let a1 := c1 A B P Q.
Let a0 := c0 A B P Q.

Definition delta := disc (c2 A B P Q) (c1 A B P Q) (c0 A B P Q).
Definition h1 := h (c2 A B P Q) (c1 A B P Q).
Definition maximum := low (c2 A B P Q) (c1 A B P Q).

(** The ring: g has the double root B and the simple root A/B below it. Clear, though delta = 0. *)
Definition ring := g A B P Q B = 0 /\ slope A B P Q B = 0 /\ A < B ^ 2.

Let gk l : g A B P Q l = k a2 a1 a0 l.
Proof. unfold k, a2, a1, a0; rewrite g_expanded; reflexivity. Qed.

Let sk l : slope A B P Q l = slope_of a2 a1 l.
Proof. reflexivity. Qed.

Lemma g_poles : g A B P Q (- A) <= 0 /\ g A B P Q 0 < 0 /\ g A B P Q B <= 0.
Proof.
  rewrite g_at_minus_A, g_at_0, g_at_B.
  assert (0 <= A * P * (A + B)) by (repeat apply Rmult_le_pos; lra).
  assert (0 <= B * Q * (A + B)) by (repeat apply Rmult_le_pos; lra).
  assert (0 < A * B) by (apply Rmult_lt_0_compat; assumption); lra.
Qed.

(** ** The local maximum decides. *)

Theorem outside_by_maximum : outside <-> 0 < h1 /\ 0 < maximum < B /\ 0 < g A B P Q maximum.
Proof.
  destruct g_poles as (_ & G0 & GX); split; [| intros (_ & I & G); exists maximum; split; assumption].
  intros (l & I & G); rewrite gk in G, G0, GX |- *; unfold h1, maximum.
  apply maximum_between with l; try assumption; unfold a2, a1, a0 in *; lra.
Qed.

Theorem inside_by_maximum : inside <-> 0 < h1 /\ - A < maximum < 0 /\ 0 < g A B P Q maximum.
Proof.
  destruct g_poles as (GX & G0 & _); split; [| intros (_ & I & G); exists maximum; split; assumption].
  intros (l & I & G); rewrite gk in G, G0, GX |- *; unfold h1, maximum.
  apply maximum_between with l; try assumption; unfold a2, a1, a0 in *; lra.
Qed.

(** ** The coefficient rule for all sizes. *)

(** The signs of the coefficients tell the side of the maximum. *)
Lemma maximum_positive : 0 < h1 -> (0 < maximum <-> a2 < 0 /\ 0 < a1).
Proof.
  intros H; pose proof (low_lt_high a2 a1 H) as L; unfold maximum; fold a2 a1.
  assert (S : low a2 a1 + high a2 a1 = - (2 * a2 / 3)) by (unfold low, high; field).
  assert (M : low a2 a1 * high a2 a1 = a1 / 3).
  { unfold low, high; rewrite (h_square a2 a1) at 3 by (unfold h1 in H; fold a2 a1 in H; lra); field. }
  split.
  - intros M0; assert (0 < low a2 a1 * high a2 a1) by (apply Rmult_lt_0_compat; lra); lra.
  - intros [N2 N1]; apply Rnot_le_lt; intro N.
    assert (0 <= - low a2 a1 * high a2 a1) by (apply Rmult_le_pos; lra); lra.
Qed.

(** Whether B is left of both extremes, and whether -A is. *)
Lemma left_of_maximum c : 0 < h1 -> (c < maximum <-> a2 < - 3 * c /\ 0 < slope A B P Q c).
Proof.
  intros H; pose proof (low_lt_high a2 a1 H) as L; unfold maximum; fold a2 a1.
  assert (S : low a2 a1 + high a2 a1 = - (2 * a2 / 3)) by (unfold low, high; field).
  rewrite sk, (slope_factors a2 a1 c) by (unfold h1 in H; fold a2 a1 in H; lra); split.
  - intros M; split; [lra |]; assert (0 < (low a2 a1 - c) * (high a2 a1 - c)) by (apply Rmult_lt_0_compat; lra); lra.
  - intros [M N]; apply Rnot_le_lt; intro K.
    assert (0 <= (c - low a2 a1) * (high a2 a1 - c)) by (apply Rmult_le_pos; lra); lra.
Qed.

Let delta_iff : 0 < delta <-> 0 < h1 /\ g A B P Q (high a2 a1) < 0 < g A B P Q maximum.
Proof. unfold delta, h1, maximum; rewrite !gk; fold a2 a1 a0; apply disc_pos_iff. Qed.

Lemma ring_factors : ring -> forall l, g A B P Q l = (l - B) ^ 2 * (l - A / B).
Proof.
  intros (GB & SB & _) l.
  assert (E : B * Q * (A + B) = 0) by (rewrite g_at_B in GB; lra).
  assert (Q0 : Q = 0) by (apply Rmult_eq_reg_l with (B * (A + B)); [lra |]; apply Rgt_not_eq, Rmult_lt_0_compat; lra).
  assert (P0 : P = (1 + B) * (A + B) / B).
  { apply Rmult_eq_reg_l with B; [| lra]; transitivity ((1 + B) * (A + B)); [| field; lra].
    unfold slope, c2, c1 in SB; rewrite Q0 in SB; lra. }
  rewrite Q0, P0; unfold g; field; lra.
Qed.

Lemma ring_is_outside : ring -> outside.
Proof.
  intros R; pose proof R as (_ & _ & AB).
  assert (N : A / B < B) by (apply Rmult_lt_reg_r with B; [lra |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l; lra).
  assert (N0 : 0 < A / B) by (apply over_lt; assumption).
  exists ((A / B + B) / 2); split; [lra |]; rewrite (ring_factors R).
  apply Rmult_lt_0_compat; [apply square_pos | ]; lra.
Qed.

Lemma ring_has_delta_0 : ring -> delta = 0.
Proof.
  intros R; pose proof (ring_factors R) as F; unfold delta; fold a2 a1 a0.
  assert (E0 : a0 = - (A * B)) by reflexivity.
  assert (F1 := F 1); assert (F2 := F 2); rewrite gk in F1, F2; unfold k in F1, F2; rewrite E0 in F1, F2.
  assert (X2 : a2 = - (2 * B + A / B)).
  { assert (2 * a2 = - (2 * (2 * B + A / B))); [| lra].
    transitivity ((2 ^ 3 + a2 * 2 ^ 2 + a1 * 2 + - (A * B)) - 2 * (1 ^ 3 + a2 * 1 ^ 2 + a1 * 1 + - (A * B)) - 6 - A * B);
      [ring | rewrite F1, F2; field; lra]. }
  assert (X1 : a1 = B ^ 2 + 2 * A).
  { transitivity ((1 ^ 3 + a2 * 1 ^ 2 + a1 * 1 + - (A * B)) - 1 - a2 + A * B); [ring_simplify; ring | ].
    rewrite F1, X2; field; lra. }
  rewrite X2, X1, E0; unfold disc; field; lra.
Qed.

(** The ring in lengths: in the plane of the waist, r^2 = (B + 1)(A + B)/B. *)
Theorem ring_in_lengths : ring <-> Q = 0 /\ B * P = (1 + B) * (A + B) /\ A < B ^ 2.
Proof.
  unfold ring; rewrite g_at_B; split; intros (E & S & L).
  - assert (E' : B * Q * (A + B) = 0) by lra.
    assert (Q0 : Q = 0) by (apply Rmult_eq_reg_l with (B * (A + B)); [lra |]; apply Rgt_not_eq, Rmult_lt_0_compat; lra).
    repeat split; try assumption; unfold slope, c2, c1 in S; rewrite Q0 in S; lra.
  - rewrite E; repeat split; try assumption; [ring |]; unfold slope, c2, c1; lra.
Qed.

Theorem outside_by_coefficients : outside <->
  (0 < delta /\ a2 < 0 /\ 0 < a1 /\ ~ (a2 < - 3 * B /\ 0 < slope A B P Q B)) \/ ring.
Proof.
  destruct g_poles as (_ & G0 & GB); split.
  - intros O; apply outside_by_maximum in O; destruct O as (H & [M0 MB] & G).
    pose proof (proj1 (maximum_positive H) M0) as [S2 S1].
    assert (L : ~ (a2 < - 3 * B /\ 0 < slope A B P Q B)) by (intro K; apply (left_of_maximum B H) in K; lra).
    assert (Hs : 0 < sqrt (h a2 a1)) by (apply sqrt_lt_R0; exact H).
    assert (HH : 0 <= h a2 a1) by (left; exact H).
    assert (F : k a2 a1 a0 B = k a2 a1 a0 (high a2 a1) + (B - high a2 a1) ^ 2 * (B - high a2 a1 + sqrt (h a2 a1)))
      by (apply from_high; assumption).
    assert (W : 0 < B - high a2 a1 + sqrt (h a2 a1)) by (unfold maximum, low in MB; fold a2 a1 in MB; unfold high; lra).
    pose proof (pow2_ge_0 (B - high a2 a1)) as SQ.
    assert (SW : 0 <= (B - high a2 a1) ^ 2 * (B - high a2 a1 + sqrt (h a2 a1))) by (apply Rmult_le_pos; lra).
    rewrite <- gk in F; destruct (Rlt_le_dec (k a2 a1 a0 (high a2 a1)) 0) as [N | N].
    + left; repeat split; try assumption; apply delta_iff; rewrite gk; repeat split; assumption.
    + right; assert (Z : (B - high a2 a1) ^ 2 * (B - high a2 a1 + sqrt (h a2 a1)) = 0) by lra.
      assert (D : B = high a2 a1).
      { apply Rmult_integral in Z; destruct Z as [Z | Z]; [| lra].
        assert (B - high a2 a1 = 0) by (apply Rsqr_0_uniq; rewrite Rsqr_pow2; assumption); lra. }
      assert (SB : slope A B P Q B = 0) by (rewrite sk, slope_factors, <- D by assumption; ring).
      assert (GB0 : g A B P Q B = 0) by lra.
      assert (F1 : forall l, k a2 a1 a0 l = (l - B) ^ 2 * (l - B + sqrt (h a2 a1))).
      { intros l; rewrite (from_high a2 a1 a0 l HH), <- D, <- gk, GB0; ring. }
      assert (R1 : B - sqrt (h a2 a1) = A / B).
      { assert (E := F1 0); unfold k in E; replace a0 with (- (A * B)) in E by reflexivity.
        apply Rmult_eq_reg_r with (B ^ 2); [| apply pow_nonzero; lra].
        transitivity (A * B); [ring_simplify in E; lra | field; lra]. }
      unfold ring; repeat split; try assumption.
      assert (A / B < B) by lra.
      assert (A / B * B < B * B) by (apply Rmult_lt_compat_r; assumption).
      replace (A / B * B) with A in * by (field; lra); lra.
  - intros [(D & S2 & S1 & L) | R]; [| apply ring_is_outside; assumption].
    apply delta_iff in D; destruct D as (H & _ & G).
    apply outside_by_maximum; split; [assumption |]; split; [split |]; [apply maximum_positive; auto | | assumption].
    destruct (Rtotal_order maximum B) as [M | [M | M]]; [assumption | rewrite M in G; lra |].
    exfalso; apply L, left_of_maximum; assumption.
Qed.

Theorem inside_by_coefficients : inside <->
  0 < delta /\ ~ (a2 < 0 /\ 0 < a1) /\ a2 < 3 * A /\ 0 < slope A B P Q (- A).
Proof.
  destruct g_poles as (GA & G0 & _); split.
  - intros I; apply inside_by_maximum in I; destruct I as (H & [MA M0] & G).
    assert (HH : 0 <= h a2 a1) by (left; exact H).
    apply (left_of_maximum (- A) H) in MA; destruct MA as [SA SL].
    repeat split; try lra; [| intro K; apply (maximum_positive H) in K; lra].
    apply delta_iff; repeat split; try assumption.
    rewrite gk, (from_high a2 a1 a0 0 HH) in G0; rewrite gk.
    pose proof (sqrt_pos (h a2 a1)).
    assert (W : 0 <= 0 - high a2 a1 + sqrt (h a2 a1)) by (unfold maximum, low in M0; fold a2 a1 in M0; unfold high; lra).
    assert (0 <= (0 - high a2 a1) ^ 2 * (0 - high a2 a1 + sqrt (h a2 a1))) by (apply Rmult_le_pos; [apply pow2_ge_0 | exact W]).
    lra.
  - intros (D & S & SA & SL); apply delta_iff in D; destruct D as (H & _ & G).
    apply inside_by_maximum; split; [assumption |]; split; [split |]; [apply left_of_maximum; auto; split; lra | | assumption].
    destruct (Rtotal_order maximum 0) as [M | [M | M]]; [assumption | rewrite M in G; lra |].
    exfalso; apply S, (maximum_positive H); assumption.
Qed.

(** ** Propositions 3 and 5 put right. *)

(** c^2 >= a, that is A <= B^2: three positive roots are never all above B. *)
Theorem proposition_3_repaired : A <= B ^ 2 -> (outside <-> (0 < delta /\ a2 < 0 /\ 0 < a1) \/ ring).
Proof.
  intros AB; rewrite outside_by_coefficients.
  assert (N : ~ (a2 < - 3 * B /\ 0 < slope A B P Q B)); [| tauto].
  intros [S2 SL]; destruct g_poles as (_ & _ & GB).
  assert (E : g A B P Q B = - (A * B) + B ^ 3 - (3 * B + a2) * B ^ 2 + slope A B P Q B * B)
    by (rewrite gk, sk; unfold k, slope_of, a0, c0; ring).
  assert (0 < - (3 * B + a2) * B ^ 2) by (apply Rmult_lt_0_compat; [lra | apply pow_lt2; assumption]).
  assert (0 < slope A B P Q B * B) by (apply Rmult_lt_0_compat; assumption).
  assert (A * B <= B ^ 2 * B) by (apply Rmult_le_compat_r; lra).
  replace (B ^ 2 * B) with (B ^ 3) in * by ring; lra.
Qed.

(** a >= 1, that is A >= 1: two negative roots are never both below -A. *)
Theorem proposition_5_repaired : 1 <= A -> (inside <-> 0 < delta /\ ~ (a2 < 0 /\ 0 < a1)).
Proof.
  intros A1; split; [intros I; apply inside_by_coefficients in I; tauto |].
  intros [D S]; pose proof D as D'; apply delta_iff in D'; destruct D' as (H & GH & G).
  destruct g_poles as (GA & G0 & GB); apply inside_by_maximum; split; [assumption |]; split; [| assumption].
  assert (M0 : maximum < 0).
  { destruct (Rtotal_order maximum 0) as [M | [M | M]]; [assumption | rewrite M in G; lra |].
    exfalso; apply S, (maximum_positive H); assumption. }
  split; [| assumption].
  destruct (Rtotal_order maximum (- A)) as [M | [M | M]]; [exfalso | rewrite M in G; lra | assumption].
  (* a root below the maximum, hence below -A *)
  destruct (k_large a2 a1 a0) as (T & T0 & _ & TL).
  assert (TM : - T < maximum).
  { apply Rnot_le_lt; intro K; specialize (TL _ K); rewrite <- gk in TL; lra. }
  destruct (root_between (k a2 a1 a0) (- T) maximum (k_continuous _ _ _)) as (n1 & N1 & R1); [lra | |].
  { apply opposite'; [left; apply TL; lra | rewrite <- gk; lra]. }
  assert (N1A : n1 < - A) by lra.
  destruct (split_off a2 a1 a0 n1 R1) as [(n2 & n3 & N23 & F) | (m & e & He & F)].
  - (* two roots at or below -A, so the third is at most B / A, yet g(B) <= 0 *)
    rewrite gk, F in GA; rewrite gk, F in GB.
    assert (F0 := F 0); unfold k in F0; assert (V : n1 * n2 * n3 = A * B).
    { replace (n1 * n2 * n3) with (- ((0 - n1) * (0 - n2) * (0 - n3))) by ring; rewrite <- F0; unfold a0, c0; ring. }
    assert (X : (A + n2) * (A + n3) <= 0).
    { apply Rmult_le_reg_l with (- A - n1); [lra |].
      replace ((- A - n1) * ((A + n2) * (A + n3))) with ((- A - n1) * (- A - n2) * (- A - n3)) by ring; lra. }
    assert (N2 : n2 <= - A).
    { apply Rnot_lt_le; intro K; assert (0 < (A + n2) * (A + n3)) by (apply Rmult_lt_0_compat; lra); lra. }
    assert (Y : A * A < n1 * n2).
    { apply Rlt_le_trans with (- n1 * A); [apply Rmult_lt_compat_r; lra |].
      replace (n1 * n2) with (- n1 * - n2) by ring; apply Rmult_le_compat_l; lra. }
    assert (N3 : 0 < n3).
    { apply Rnot_le_lt; intro K; assert (0 <= n1 * n2 * - n3) by (pose proof (Rle_0_sqr A); unfold Rsqr in *; apply Rmult_le_pos; lra).
      assert (0 < A * B) by (apply Rmult_lt_0_compat; assumption); lra. }
    assert (Z : n3 < B).
    { apply Rmult_lt_reg_l with (A * A); [apply Rmult_lt_0_compat; assumption |].
      apply Rlt_le_trans with (n1 * n2 * n3); [apply Rmult_lt_compat_r; assumption |]; rewrite V.
      apply Rmult_le_compat_r; [lra |]; rewrite <- (Rmult_1_r A) at 1; apply Rmult_le_compat_l; lra. }
    assert (0 < (B - n1) * (B - n2) * (B - n3)) by (repeat apply Rmult_lt_0_compat; lra); lra.
  - assert (0 < (- A - n1) * ((- A - m) ^ 2 + e)).
    { apply Rmult_lt_0_compat; [lra |]; pose proof (pow2_ge_0 (- A - m)); lra. }
    rewrite gk, F in GA; lra.
Qed.

(** delta <= 0 means contact or the ring, for all sizes. *)
Theorem no_discriminant : delta <= 0 -> neither \/ ring.
Proof.
  intros D; destruct (Req_dec (g A B P Q B) 0) as [GB | GB].
  - destruct (Req_dec (slope A B P Q B) 0) as [SB | SB].
    + destruct (Rlt_le_dec A (B ^ 2)) as [AB | AB].
      * right; unfold ring; repeat split; assumption.
      * left; split; intro K; [apply outside_by_coefficients in K; unfold ring in K | apply inside_by_coefficients in K];
          destruct K; lra.
    + left; split; intro K; [apply outside_by_coefficients in K; unfold ring in K | apply inside_by_coefficients in K];
        destruct K; lra.
  - left; split; intro K; [apply outside_by_coefficients in K; unfold ring in K | apply inside_by_coefficients in K];
      destruct K; lra.
Qed.

End Rule.

(** The clearance of the ring: the nearest points are the waist's, at distance r - a from the centre. *)
Lemma ring_clearance a c r : 0 < a -> 0 < c -> 0 < r -> c ^ 2 * r ^ 2 = (1 + c ^ 2) * (a ^ 2 + c ^ 2) ->
  r - a - 1 = (c ^ 2 - a) ^ 2 / (c ^ 2 * (r + a + 1)).
Proof.
  intros Ha Hc Hr E; apply Rmult_eq_reg_r with (c ^ 2 * (r + a + 1)); [| apply Rgt_not_eq, Rmult_lt_0_compat; nra].
  transitivity (c ^ 2 * r ^ 2 - c ^ 2 * (a + 1) ^ 2); [ring | rewrite E; field; nra].
Qed.

(** ** The rules said of the bodies. *)

Section Bodies.

Variables alpha gamma b d x y z : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d).

Let p := upright alpha gamma b d x y z.
Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let P := (x ^ 2 + y ^ 2) / b ^ 2.
Let Q := (z / d) ^ 2.

Theorem positions_by_g : (exterior p <-> outside A B P Q) /\ (interior p <-> inside A B P Q)
                         /\ (contact p <-> neither A B P Q).
Proof.
  pose proof (exterior_rule alpha gamma b d x y z Ha Hg Hb Hd) as E.
  pose proof (interior_rule alpha gamma b d x y z Ha Hg Hb Hd) as I.
  destruct (positions_exclude_each_other p) as (X1 & X2 & _).
  pose proof (one_position_holds p (upright_valid alpha gamma b d x y z Ha Hg Hb Hd)) as O.
  fold p A B P Q in E, I; unfold outside, inside, neither; fold (outside A B P Q) (inside A B P Q) in *; tauto.
Qed.

Theorem exterior_by_coefficients : exterior p <->
  (0 < delta A B P Q /\ c2 A B P Q < 0 /\ 0 < c1 A B P Q /\ ~ (c2 A B P Q < - 3 * B /\ 0 < slope A B P Q B))
  \/ ring A B P Q.
Proof.
  rewrite (proj1 positions_by_g); apply outside_by_coefficients.
  - apply A_pos; assumption.
  - apply B_pos; assumption.
  - apply P_ge_0; assumption.
  - apply Q_ge_0.
Qed.

Theorem interior_by_coefficients : interior p <->
  0 < delta A B P Q /\ ~ (c2 A B P Q < 0 /\ 0 < c1 A B P Q) /\ c2 A B P Q < 3 * A /\ 0 < slope A B P Q (- A).
Proof.
  rewrite (proj1 (proj2 positions_by_g)); apply inside_by_coefficients.
  - apply A_pos; assumption.
  - apply B_pos; assumption.
  - apply P_ge_0; assumption.
  - apply Q_ge_0.
Qed.

Theorem contact_by_maximum : contact p <->
  ~ (0 < h1 A B P Q /\ - A < maximum A B P Q < B /\ 0 < g A B P Q (maximum A B P Q)).
Proof.
  assert (HA : 0 < A) by (apply A_pos; assumption); assert (HB : 0 < B) by (apply B_pos; assumption).
  assert (HP : 0 <= P) by (apply P_ge_0; assumption); assert (HQ : 0 <= Q) by apply Q_ge_0.
  rewrite (proj2 (proj2 positions_by_g)); unfold neither; rewrite outside_by_maximum, inside_by_maximum by assumption.
  destruct (g_poles A B P Q HA HB HP HQ) as (_ & G0 & _); split; [| intros N; split; intros (H & M & G); apply N; repeat split; lra].
  intros [N1 N2] (H & M & G); destruct (Rtotal_order (maximum A B P Q) 0) as [K | [K | K]].
  - apply N2; repeat split; lra.
  - rewrite K in G; lra.
  - apply N1; repeat split; lra.
Qed.

End Bodies.
