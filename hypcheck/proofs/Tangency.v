(** Stage 4: a double root proved by whole numbers, the plane of the waist, and coordinates of a hair's breadth.

    With D = b d, K = alpha gamma and N = D^2 the stage looks for M and e with M e = D K, n2 = -(2 D M + e^2) and
    n1 = M^2 + 2 K e, where n2 = N c2 and n1 = N c1. *)

Require Import Reals Lra Psatz.
From Hypcheck Require Import Geometry Certificates UnitBall AnyAxis Completeness Rule Positions HalfPlanes.
Open Scope R_scope.

Section Upright.

Variables alpha gamma b d x y z : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d).

Let p := upright alpha gamma b d x y z.
Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let P := (x ^ 2 + y ^ 2) / b ^ 2.
Let Q := (z / d) ^ 2.
Let D := b * d.
Let K := alpha * gamma.

Definition n2_of := (alpha ^ 2 + b ^ 2 - (x ^ 2 + y ^ 2)) * d ^ 2 - (gamma ^ 2 + z ^ 2) * b ^ 2.
Definition n1_of := (d ^ 2 - gamma ^ 2 - z ^ 2) * alpha ^ 2 + (x ^ 2 + y ^ 2 - b ^ 2) * gamma ^ 2.

Let HA : 0 < A.
Proof. apply A_pos; assumption. Qed.
Let HB : 0 < B.
Proof. apply B_pos; assumption. Qed.
Let HP : 0 <= P.
Proof. apply P_ge_0; assumption. Qed.
Let HQ : 0 <= Q.
Proof. apply Q_ge_0. Qed.
Let HD : 0 < D.
Proof. apply Rmult_lt_0_compat; assumption. Qed.
Let HK : 0 < K.
Proof. apply Rmult_lt_0_compat; assumption. Qed.

Lemma n2_is_c2 : n2_of = D ^ 2 * c2 A B P Q.
Proof. unfold n2_of, D, c2, A, B, P, Q; field; lra. Qed.
Lemma n1_is_c1 : n1_of = D ^ 2 * c1 A B P Q.
Proof. unfold n1_of, D, c1, A, B, P, Q; field; lra. Qed.

Variables M e : R.

(** What the stage asks: the three equations, and that the double root lies between the poles and is no ring. *)
Definition tangency_equations := M * e = D * K /\ n2_of = - (2 * D * M + e ^ 2) /\ n1_of = M ^ 2 + 2 * K * e.

Hypothesis T : tangency_equations.

Lemma cubic_factors l : D ^ 4 * g A B P Q l = (D * l - M) ^ 2 * (D ^ 2 * l - e ^ 2).
Proof.
  destruct T as (E0 & E2 & E1).
  assert (K0 : D ^ 2 * c0 A B P Q = - K ^ 2) by (unfold c0, A, B, D, K; field; lra).
  rewrite g_expanded.
  replace (D ^ 4 * (l ^ 3 + c2 A B P Q * l ^ 2 + c1 A B P Q * l + c0 A B P Q))
    with (D ^ 2 * (D ^ 2 * l ^ 3 + (D ^ 2 * c2 A B P Q) * l ^ 2 + (D ^ 2 * c1 A B P Q) * l + D ^ 2 * c0 A B P Q)) by ring.
  rewrite <- n2_is_c2, <- n1_is_c1, E2, E1, K0.
  replace ((D * l - M) ^ 2 * (D ^ 2 * l - e ^ 2))
    with (D ^ 2 * (D ^ 2 * l ^ 3 - (2 * D * M + e ^ 2) * l ^ 2) + D ^ 2 * M ^ 2 * l + 2 * D * (M * e) * e * l - (M * e) ^ 2)
    by ring.
  rewrite E0; ring.
Qed.

Let root := M / D.

Lemma root_is_double : g A B P Q root = 0 /\ slope A B P Q root = 0.
Proof.
  assert (D4 : 0 < D ^ 4) by (apply pow_lt; assumption).
  assert (D2 : 0 < D ^ 2) by (apply pow_lt; assumption).
  assert (R0 : D * root = M) by (unfold root; field; lra).
  split.
  - apply Rmult_eq_reg_l with (D ^ 4); [| lra]; rewrite cubic_factors, R0; ring.
  - destruct T as (E0 & E2 & E1); apply Rmult_eq_reg_l with (D ^ 2); [| lra]; unfold slope.
    replace (D ^ 2 * (3 * root ^ 2 + 2 * c2 A B P Q * root + c1 A B P Q))
      with (3 * (D * root) ^ 2 + 2 * (D ^ 2 * c2 A B P Q) * root + D ^ 2 * c1 A B P Q) by ring.
    rewrite <- n2_is_c2, <- n1_is_c1, E2, E1, R0.
    replace (3 * M ^ 2 + 2 * - (2 * D * M + e ^ 2) * root + (M ^ 2 + 2 * K * e))
      with (4 * M ^ 2 - 4 * (D * root) * M - 2 * (e ^ 2 * root - K * e)) by ring.
    assert (X : e * root = K) by (apply Rmult_eq_reg_l with D; [| lra]; unfold root; rewrite <- E0; field; lra).
    replace (e ^ 2 * root) with (e * (e * root)) by ring; rewrite R0, X; ring.
Qed.

Let root_not_0 : root <> 0.
Proof.
  destruct T as (E0 & _); intro Z; assert (M = 0) by (unfold root in Z; apply Rmult_eq_reg_r with (/ D);
    [rewrite Rmult_0_l; exact Z | apply Rinv_neq_0_compat; lra]).
  assert (0 < D * K) by (apply Rmult_lt_0_compat; assumption); rewrite H in E0; lra.
Qed.

Let third : - c2 A B P Q - 2 * root = e ^ 2 / D ^ 2.
Proof.
  destruct T as (_ & E2 & _); rewrite n2_is_c2 in E2; unfold root.
  apply Rmult_eq_reg_l with (D ^ 2); [| apply Rgt_not_eq, pow_lt; assumption].
  replace (D ^ 2 * (- c2 A B P Q - 2 * (M / D))) with (- (D ^ 2 * c2 A B P Q) - 2 * D * M) by (field; lra).
  rewrite E2; field; lra.
Qed.

(** Without: 0 < M, M/D <= B, and the simple root is not below it. Within: M < 0 and -A <= M/D. *)
Theorem touches_from_without : 0 < M -> D * M <= e ^ 2 -> M * d ^ 2 <= gamma ^ 2 * D -> tangent_outside p.
Proof.
  intros M0 S R; destruct root_is_double as [G SL].
  assert (W : D * root = M) by (unfold root; field; lra).
  assert (R0 : 0 < root) by (unfold root; apply over_lt; lra).
  assert (RB : root <= B).
  { unfold B; apply Rmult_le_reg_l with (D * d ^ 2); [apply Rmult_lt_0_compat; [| apply pow_lt]; assumption |].
    replace (D * d ^ 2 * (gamma / d) ^ 2) with (gamma ^ 2 * D) by (field; lra).
    replace (D * d ^ 2 * root) with (D * root * d ^ 2) by ring; rewrite W; exact R. }
  apply (tangent_by_double_root alpha gamma b d x y z Ha Hg Hb Hd root root_not_0); try assumption; [fold A B; lra |].
  fold A B P Q; rewrite third; intros [E N].
  assert (root <= e ^ 2 / D ^ 2); [| lra].
  apply Rmult_le_reg_l with (D ^ 2); [apply pow_lt; assumption |].
  replace (D ^ 2 * (e ^ 2 / D ^ 2)) with (e ^ 2) by (field; lra).
  replace (D ^ 2 * root) with (D * (D * root)) by ring; rewrite W; exact S.
Qed.

Theorem touches_from_within : M < 0 -> - M * b ^ 2 <= alpha ^ 2 * D -> tangent_inside p.
Proof.
  intros M0 R; destruct root_is_double as [G SL].
  assert (W : D * root = M) by (unfold root; field; lra).
  assert (R0 : root < 0) by (unfold root, Rdiv; pose proof (Rinv_0_lt_compat D HD); nra).
  assert (RA : - A <= root).
  { unfold A; apply Rmult_le_reg_l with (D * b ^ 2); [apply Rmult_lt_0_compat; [| apply pow_lt]; assumption |].
    replace (D * b ^ 2 * - (alpha / b) ^ 2) with (- (alpha ^ 2 * D)) by (field; lra).
    replace (D * b ^ 2 * root) with (D * root * b ^ 2) by ring; rewrite W; lra. }
  apply (tangent_by_double_root alpha gamma b d x y z Ha Hg Hb Hd root root_not_0); try assumption; fold A B; lra.
Qed.

Theorem touching_is_contact : (0 < M /\ D * M <= e ^ 2 /\ M * d ^ 2 <= gamma ^ 2 * D)
  \/ (M < 0 /\ - M * b ^ 2 <= alpha ^ 2 * D) -> contact p.
Proof.
  intros [(M0 & S & R) | (M0 & R)]; [apply touches_from_without | apply touches_from_within]; assumption.
Qed.

End Upright.

(** ** A hair: one coordinate more, too short to lead through contact to the other side. *)

Section Hair.

Variables alpha gamma b d : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d).

Let at_centre x y z := upright alpha gamma b d x y z.

Let contact_unless x y z : ~ exterior (at_centre x y z) -> ~ interior (at_centre x y z) -> contact (at_centre x y z).
Proof. apply (contact_between_chords alpha gamma b d Ha Hg Hb Hd). Qed.

Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let HA : 0 < A.
Proof. apply A_pos; assumption. Qed.
Let HB : 0 < B.
Proof. apply B_pos; assumption. Qed.

Lemma beyond_M_pos l : 0 < l < B -> 0 < beyond_M alpha gamma b d l.
Proof.
  intros [L U]; unfold beyond_M; fold A B; apply over_lt; [| lra].
  apply Rmult_lt_0_compat; [apply over_lt; apply pow_lt; assumption | lra].
Qed.
Lemma within_M_pos m : 0 < m < A -> 0 < within_M alpha gamma b d m.
Proof.
  intros [L U]; unfold within_M; fold A B; apply over_lt; [| lra].
  apply Rmult_lt_0_compat; [apply over_lt; apply pow_lt; assumption | lra].
Qed.

(** Nearer to the axis, or at a greater height, what is not exterior stays so; the other way round for interior. *)
Theorem stays_not_exterior x y z x' y' z' : x' ^ 2 + y' ^ 2 <= x ^ 2 + y ^ 2 -> z ^ 2 <= z' ^ 2 ->
  ~ exterior (at_centre x y z) -> ~ exterior (at_centre x' y' z').
Proof.
  intros R T N E; apply N; apply (exterior_half_plane alpha gamma b d Ha Hg Hb Hd) in E; destruct E as (l & I & H).
  apply (exterior_half_plane alpha gamma b d Ha Hg Hb Hd); exists l; split; [exact I |].
  pose proof (beyond_M_pos l I).
  assert (beyond_M alpha gamma b d l * z ^ 2 <= beyond_M alpha gamma b d l * z' ^ 2) by (apply Rmult_le_compat_l; lra); lra.
Qed.

Theorem stays_not_interior x y z x' y' z' : x ^ 2 + y ^ 2 <= x' ^ 2 + y' ^ 2 -> z' ^ 2 <= z ^ 2 ->
  ~ interior (at_centre x y z) -> ~ interior (at_centre x' y' z').
Proof.
  intros R T N E; apply N; apply (interior_half_plane alpha gamma b d Ha Hg Hb Hd) in E; destruct E as (m & I & H).
  apply (interior_half_plane alpha gamma b d Ha Hg Hb Hd); exists m; split; [exact I |].
  pose proof (within_M_pos m I).
  assert (within_M alpha gamma b d m * z' ^ 2 <= within_M alpha gamma b d m * z ^ 2) by (apply Rmult_le_compat_l; lra); lra.
Qed.

(** From without, farther from the axis: exterior. *)
Theorem farther_is_exterior x y z x' y' m : let P := (x ^ 2 + y ^ 2) / b ^ 2 in let Q := (z / d) ^ 2 in
  0 < m <= B -> g A B P Q m = 0 -> slope A B P Q m = 0 -> x ^ 2 + y ^ 2 < x' ^ 2 + y' ^ 2 -> exterior (at_centre x' y' z).
Proof.
  intros P Q [M0 MB] G S R.
  assert (b2 : 0 < b ^ 2) by (apply pow_lt; assumption).
  destruct MB as [MB | MB].
  - apply (exterior_half_plane alpha gamma b d Ha Hg Hb Hd); exists m; split; [split; assumption |]; fold A B.
    assert (K : 0 < m * (B - m) / b ^ 2) by (apply over_lt; [apply Rmult_lt_0_compat; lra | assumption]).
    replace (g A B P Q m) with (m * (B - m) / b ^ 2 * (x ^ 2 + y ^ 2 - (beyond_K alpha b m + beyond_M alpha gamma b d m * z ^ 2))) in G
      by (unfold g, beyond_K, beyond_M, P, Q; fold A B; field; lra).
    apply Rmult_integral in G; unfold beyond_K, beyond_M in *; fold A B in G |- *; lra.
  - subst m; rewrite g_at_B in G; assert (Q0 : Q = 0).
    { apply Rmult_eq_reg_l with (B * (A + B)); [lra |]; apply Rgt_not_eq, Rmult_lt_0_compat; lra. }
    assert (P0 : B * P = (1 + B) * (A + B)) by (unfold slope, c2, c1 in S; rewrite Q0 in S; lra).
    set (P' := (x' ^ 2 + y' ^ 2) / b ^ 2).
    assert (PP : P < P') by (unfold P, P'; apply Rmult_lt_compat_r; [apply Rinv_0_lt_compat; assumption | assumption]).
    (* l = B - s *)
    set (s := Rmin (B / 2) ((P' - P) * B ^ 2 / (4 * A))).
    assert (S0 : 0 < s).
    { unfold s; apply Rmin_pos; [lra |]; apply over_lt; [| lra]; apply Rmult_lt_0_compat; [lra | apply pow_lt; assumption]. }
    assert (S1 : s <= B / 2) by apply Rmin_l.
    assert (S2 : s * (4 * A) <= (P' - P) * B ^ 2).
    { assert (s <= (P' - P) * B ^ 2 / (4 * A)) by apply Rmin_r.
      replace ((P' - P) * B ^ 2) with ((P' - P) * B ^ 2 / (4 * A) * (4 * A)) by (field; lra).
      apply Rmult_le_compat_r; lra. }
    apply (exterior_by_g alpha gamma b d x' y' z Ha Hg Hb Hd (B - s)); fold A B; [lra | lra |]; fold P'; change ((z / d) ^ 2) with Q.
    rewrite Q0; unfold g.
    replace ((A + (B - s)) * (B - (B - s)) * (P' + 0 - 1 - (B - s)) - A * P' * (B - (B - s)) - B * 0 * (A + (B - s)))
      with (s * ((B - s) * (P' - P) + (B * P - (1 + B) * (A + B)) - s * (P - (1 + B) - (A + B)) - s ^ 2)) by ring.
    rewrite P0; apply Rmult_lt_0_compat; [assumption |].
    assert (X : P - (1 + B) - (A + B) = A / B - B).
    { apply Rmult_eq_reg_l with B; [| lra].
      replace (B * (A / B - B)) with (A - B * B) by (field; lra); lra. }
    rewrite X.
    assert (Y : s * (A / B) <= (P' - P) * B / 4).
    { apply Rmult_le_reg_r with (4 * B); [lra |].
      replace (s * (A / B) * (4 * B)) with (s * (4 * A)) by (field; lra).
      replace ((P' - P) * B / 4 * (4 * B)) with ((P' - P) * B ^ 2) by field; exact S2. }
    assert (Z : (P' - P) * B / 2 <= (B - s) * (P' - P)).
    { replace ((P' - P) * B / 2) with (B / 2 * (P' - P)) by field; apply Rmult_le_compat_r; lra. }
    assert (V : 0 < (P' - P) * B) by (apply Rmult_lt_0_compat; lra).
    assert (W : 0 <= s * (B - s)) by (apply Rmult_le_pos; lra); lra.
Qed.

(** From within, higher than the waist: interior. *)
Theorem higher_is_interior x y z' m : let P := (x ^ 2 + y ^ 2) / b ^ 2 in
  - A <= m < 0 -> g A B P 0 m = 0 -> slope A B P 0 m = 0 -> z' <> 0 -> interior (at_centre x y z').
Proof.
  intros P [MA M0] G S Z.
  set (Q' := (z' / d) ^ 2).
  assert (QQ : 0 < Q').
  { unfold Q'; apply square_pos; apply Rmult_integral_contrapositive; split; [assumption | apply Rinv_neq_0_compat; lra]. }
  destruct MA as [MA | MA].
  - apply (interior_by_g alpha gamma b d x y z' Ha Hg Hb Hd m); fold A B; [lra | lra |]; fold P Q'.
    replace (g A B P Q' m) with (g A B P 0 m + - m * (A + m) * Q') by (unfold g; ring); rewrite G, Rplus_0_l.
    apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; lra | assumption].
  - subst m; rewrite g_at_minus_A in G.
    assert (P0 : P = 0).
    { apply Rmult_eq_reg_l with (A * (A + B)); [lra |]; apply Rgt_not_eq, Rmult_lt_0_compat; lra. }
    assert (A1 : A = 1).
    { unfold slope, c2, c1 in S; rewrite P0 in S; apply Rmult_eq_reg_l with (A + B); lra. }
    set (s := Rmin (/ 2) (Q' / (4 * (B + 1)))).
    assert (S0 : 0 < s) by (unfold s; apply Rmin_pos; [lra | apply over_lt; lra]).
    assert (S1 : s <= / 2) by apply Rmin_l.
    assert (S2 : s * (4 * (B + 1)) <= Q').
    { assert (s <= Q' / (4 * (B + 1))) by apply Rmin_r; replace Q' with (Q' / (4 * (B + 1)) * (4 * (B + 1))) by (field; lra).
      apply Rmult_le_compat_r; lra. }
    apply (interior_by_g alpha gamma b d x y z' Ha Hg Hb Hd (s - 1)); fold A B; [lra | lra |]; fold P Q'.
    rewrite P0, A1; unfold g.
    replace ((1 + (s - 1)) * (B - (s - 1)) * (0 + Q' - 1 - (s - 1)) - 1 * 0 * (B - (s - 1)) - B * Q' * (1 + (s - 1)))
      with (s * ((1 - s) * Q' - s * (B + 1 - s))) by ring.
    apply Rmult_lt_0_compat; [assumption |].
    assert (X : / 2 * Q' <= (1 - s) * Q') by (apply Rmult_le_compat_r; lra).
    assert (Y : 0 <= s * s) by (apply Rmult_le_pos; lra); lra.
Qed.

(** From without in the plane of the waist, and z' a hair: it does not lead through contact to the inner side. *)
Theorem hair_along_axis x y z' : tangent_outside (at_centre x y 0) -> z' ^ 2 * alpha <= 4 * b * gamma ^ 2 ->
  contact (at_centre x y z').
Proof.
  intros [C T] H; apply contact_unless.
  - apply (stays_not_exterior x y 0); [lra | pose proof (pow2_ge_0 z'); lra |].
    intros E; apply (proj1 (positions_exclude_each_other (at_centre x y 0))); split; assumption.
  - intros I; set (r := sqrt (x ^ 2 + y ^ 2)).
    assert (R0 : 0 <= x ^ 2 + y ^ 2) by (pose proof (pow2_ge_0 x); pose proof (pow2_ge_0 y); lra).
    assert (RR : r ^ 2 = x ^ 2 + y ^ 2) by (unfold r; rewrite <- Rsqr_pow2; apply Rsqr_sqrt; assumption).
    assert (r0 : 0 <= r) by apply sqrt_pos.
    assert (a2 : 0 < alpha ^ 2) by (apply pow_lt; assumption).
    assert (b2 : 0 < b ^ 2) by (apply pow_lt; assumption).
    assert (g2 : 0 < gamma ^ 2) by (apply pow_lt; assumption).
    assert (in_bare : forall X Y, (X - x) ^ 2 + (Y - y) ^ 2 <= b ^ 2 -> alpha ^ 2 <= X ^ 2 + Y ^ 2).
    { intros X Y L; specialize (T (Point X Y 0)); unfold in_spheroid, depth, height, norm2, along, dot, sub in T; simpl in T.
      assert (K : (X * (X * 1)) / (alpha * (alpha * 1)) + Y * (Y * 1) / (alpha * (alpha * 1)) - 0 * (0 * 1) / (gamma * (gamma * 1)) - 1
        = (X ^ 2 + Y ^ 2 - alpha ^ 2) / alpha ^ 2) by (field; lra).
      rewrite K in T; assert (0 <= (X ^ 2 + Y ^ 2 - alpha ^ 2) / alpha ^ 2).
      { apply T; match goal with |- ?v <= 0 => replace v with (((X - x) ^ 2 + (Y - y) ^ 2 - b ^ 2) / b ^ 2) by (field; lra) end.
        apply Rmult_le_reg_r with (b ^ 2); [assumption |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra. }
      apply Rnot_lt_le; intro N; assert ((X ^ 2 + Y ^ 2 - alpha ^ 2) / alpha ^ 2 < 0); [| lra].
      apply Rmult_lt_reg_r with (alpha ^ 2); [assumption |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra. }
    assert (RB : b < r).
    { apply Rnot_le_lt; intro L; pose proof (in_bare 0 0) as K.
      assert ((0 - x) ^ 2 + (0 - y) ^ 2 <= b ^ 2) by (replace ((0 - x) ^ 2 + (0 - y) ^ 2) with (r ^ 2) by (rewrite RR; ring);
        apply pow_incr; lra).
      specialize (K H0); lra. }
    assert (unit_vector : forall k, (x * k) ^ 2 + (y * k) ^ 2 = r ^ 2 * k ^ 2) by (intros; rewrite RR; ring).
    assert (RA : alpha + b <= r).
    { assert (alpha ^ 2 <= (r - b) ^ 2).
      { replace ((r - b) ^ 2) with ((x * (1 - b / r)) ^ 2 + (y * (1 - b / r)) ^ 2) by (rewrite unit_vector; field; lra).
        apply in_bare; replace (x * (1 - b / r) - x) with (x * (- b / r)) by (field; lra).
        replace (y * (1 - b / r) - y) with (y * (- b / r)) by (field; lra); rewrite unit_vector.
        right; field; lra. }
      apply Rnot_lt_le; intro N; assert ((r - b) ^ 2 < alpha ^ 2); [| lra].
      apply pow_lt_compat_l || (rewrite <- !Rsqr_pow2; apply Rsqr_incrst_1; lra). }
    specialize (I (Point (x * (1 + b / r)) (y * (1 + b / r)) z')).
    unfold in_spheroid, depth, norm2, along, dot, sub, height in I; simpl in I.
    match type of I with ?v <= 0 -> ?w < 0 =>
      replace v with 0 in I; [replace w with ((r + b) ^ 2 / alpha ^ 2 - z' ^ 2 / gamma ^ 2 - 1) in I |] end.
    2: { replace ((r + b) ^ 2) with ((x * (1 + b / r)) ^ 2 + (y * (1 + b / r)) ^ 2) by (rewrite unit_vector; field; lra); field; lra. }
    2: { apply Rmult_eq_reg_r with (b ^ 2 * r ^ 2); [| apply Rgt_not_eq, Rmult_lt_0_compat; [| apply pow_lt]; lra].
         match goal with |- _ = ?w * _ => replace (w * (b ^ 2 * r ^ 2)) with (b ^ 2 * (x ^ 2 + y ^ 2 - r ^ 2)) by (field; lra) end.
         rewrite RR; ring. }
    specialize (I (Rle_refl 0)).
    assert (J : (r + b) ^ 2 < alpha ^ 2 + alpha * (4 * b)).
    { apply Rlt_le_trans with (alpha ^ 2 + alpha ^ 2 * (z' ^ 2 / gamma ^ 2)).
      - apply Rmult_lt_reg_r with (/ alpha ^ 2); [apply Rinv_0_lt_compat; assumption |].
        replace ((alpha ^ 2 + alpha ^ 2 * (z' ^ 2 / gamma ^ 2)) * / alpha ^ 2) with (1 + z' ^ 2 / gamma ^ 2) by (field; lra).
        unfold Rdiv in I |- *; lra.
      - apply Rplus_le_compat_l; replace (alpha ^ 2 * (z' ^ 2 / gamma ^ 2)) with (alpha * (z' ^ 2 * alpha / gamma ^ 2)) by (field; lra).
        apply Rmult_le_compat_l; [lra |]; apply Rmult_le_reg_r with (gamma ^ 2); [assumption |].
        replace (z' ^ 2 * alpha / gamma ^ 2 * gamma ^ 2) with (z' ^ 2 * alpha) by (field; lra); lra. }
    assert ((alpha + 2 * b) ^ 2 <= (r + b) ^ 2) by (apply pow_incr; lra).
    assert (0 < b * b) by (apply Rmult_lt_0_compat; assumption); lra.
Qed.

(** From within, and the centre moved away from the axis by less than the spheroid reaches: not through to the outer side. *)
Theorem hair_across_axis x y z x' y' : tangent_inside (at_centre x y z) -> x ^ 2 + y ^ 2 <= x' ^ 2 + y' ^ 2 ->
  (x' - x) ^ 2 + (y' - y) ^ 2 <= b ^ 2 -> contact (at_centre x' y' z).
Proof.
  intros [C T] R H; apply contact_unless.
  - intros E; assert (b2 : 0 < b ^ 2) by (apply pow_lt; assumption).
    assert (K : in_spheroid (at_centre x y z) (Point x' y' z)).
    { unfold in_spheroid, depth, norm2, along, dot, sub; simpl.
      match goal with |- ?v <= 0 => replace v with (((x' - x) ^ 2 + (y' - y) ^ 2 - b ^ 2) / b ^ 2) by (field; lra) end.
      apply Rmult_le_reg_r with (b ^ 2); [assumption |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra. }
    specialize (T _ K); specialize (E (Point x' y' z)).
    assert (in_spheroid (at_centre x' y' z) (Point x' y' z)).
    { pose proof (depth_centre (at_centre x' y' z)) as X; simpl in X; unfold in_spheroid; rewrite X; lra. }
    specialize (E H0); unfold height in *; simpl in *; lra.
  - apply (stays_not_interior x y z); [assumption | lra |].
    intros I; apply (proj1 (proj2 (positions_exclude_each_other (at_centre x y z)))); split; assumption.
Qed.

(** ** The plane of the waist: g = (B - l) (w l - l^2 - A) with w = P - 1 - A. *)

Section Waist.

Variables x y : R.
Let P := (x ^ 2 + y ^ 2) / b ^ 2.
Let w := P - 1 - A.
Let HP : 0 <= P.
Proof. apply P_ge_0; assumption. Qed.

Let cubic l : g A B P ((0 / d) ^ 2) l = (B - l) * (w * l - l ^ 2 - A).
Proof. unfold g, w; replace (0 / d) with 0 by (field; lra); ring. Qed.

Let never : (forall l, - A < l < B -> w * l - l ^ 2 - A <= 0) -> contact (at_centre x y 0).
Proof.
  intros N; apply (contact_rule alpha gamma b d x y 0 Ha Hg Hb Hd); intros (l & I & G); fold A B P in I, G.
  rewrite cubic in G; specialize (N l I); assert (0 <= (B - l) * - (w * l - l ^ 2 - A)) by (apply Rmult_le_pos; lra); lra.
Qed.

Theorem waist_contact : w ^ 2 <= 4 * A -> contact (at_centre x y 0).
Proof. intros W; apply never; intros l _; pose proof (pow2_ge_0 (l - w / 2)); lra. Qed.

Theorem waist_exterior : 0 < w -> 4 * A < w ^ 2 -> w <= 2 * B -> exterior (at_centre x y 0).
Proof.
  intros W0 W WB.
  assert (L : 2 * A / w < w / 2).
  { apply Rmult_lt_reg_r with (2 * w); [lra |]; replace (2 * A / w * (2 * w)) with (4 * A) by (field; lra).
    replace (w / 2 * (2 * w)) with (w ^ 2) by field; exact W. }
  assert (L0 : 0 < 2 * A / w) by (apply over_lt; lra).
  apply (exterior_by_g alpha gamma b d x y 0 Ha Hg Hb Hd (2 * A / w)); fold A B P; [lra | lra |].
  rewrite cubic; apply Rmult_lt_0_compat; [lra |].
  replace (w * (2 * A / w) - (2 * A / w) ^ 2 - A) with (A * (w ^ 2 - 4 * A) / w ^ 2) by (field; lra).
  apply over_lt; [apply Rmult_lt_0_compat; lra | apply pow_lt; assumption].
Qed.

Theorem waist_interior : w < 0 -> 4 * A < w ^ 2 -> - 2 * A <= w -> interior (at_centre x y 0).
Proof.
  intros W0 W [WA | WA].
  - apply (interior_by_g alpha gamma b d x y 0 Ha Hg Hb Hd (w / 2)); fold A B P; [lra | lra |].
    rewrite cubic; apply Rmult_lt_0_compat; lra.
  - rewrite <- WA in W; assert (A <= 1) by (unfold w in WA; lra).
    assert (A * A <= A * 1) by (apply Rmult_le_compat_l; lra); lra.
Qed.

Theorem waist_contact_below : w < - 2 * A -> contact (at_centre x y 0).
Proof.
  intros W; apply never; intros l [L _].
  replace (w * l - l ^ 2 - A) with (- (A * P) - (A + l) * (l - A - w)) by (unfold w; ring).
  assert (0 <= A * P) by (apply Rmult_le_pos; lra); assert (0 <= (A + l) * (l - A - w)) by (apply Rmult_le_pos; lra); lra.
Qed.

End Waist.

End Hair.
