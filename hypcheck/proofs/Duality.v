(** There is no duality gap: a nearest point of the hyperboloid comes with its multiplier, in every case.

    For the unit ball about (x, y, z) and the hyperboloid X1^2/A1 + X2^2/A2 - X3^2/B = 1 there are a multiplier t
    between the poles (poles included) and a point Y of the hyperboloid at which ball + t wall is stationary. By
    UnitBall.pencil_above no point of the hyperboloid is nearer to the centre than Y. The sign of t is the side of
    the centre. The proof is by cases and by the intermediate value theorem for polynomials. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry UnitBall.
Open Scope R_scope.

Definition nearest_with (A1 A2 B x y z t Y1 Y2 Y3 : R) :=
  - A1 <= t /\ - A2 <= t /\ t <= B /\ wall A1 A2 B Y1 Y2 Y3 = 0
  /\ (A1 + t) * Y1 = A1 * x /\ (A2 + t) * Y2 = A2 * y /\ (B - t) * Y3 = B * z.

Lemma root_between f lo hi : continuity f -> lo <= hi -> f lo * f hi <= 0 -> exists t, lo <= t <= hi /\ f t = 0.
Proof. intros C L S; destruct (IVT_cor f lo hi C L S) as [t T]; exists t; exact T. Qed.

Lemma opposite u v : 0 <= u -> v <= 0 -> u * v <= 0.
Proof. intros; rewrite <- (Rmult_0_r u); apply Rmult_le_compat_l; assumption. Qed.

Lemma opposite' u v : u <= 0 -> 0 <= v -> u * v <= 0.
Proof. intros; rewrite Rmult_comm; apply opposite; assumption. Qed.

Lemma sq_sqrt h : 0 <= h -> sqrt h ^ 2 = h.
Proof. intros; rewrite <- Rsqr_pow2; apply Rsqr_sqrt; assumption. Qed.

Lemma prod2 u v : 0 < u -> 0 < v -> 0 < u * v.
Proof. apply Rmult_lt_0_compat. Qed.

Ltac pos := repeat first [assumption | apply square_pos; assumption | apply pow_lt2 | apply prod2]; try lra.

(** The wall at the stationary point of t, times the squares of the distances to the poles. *)
Definition G A1 A2 B x y z t :=
  A1 * x ^ 2 * (A2 + t) ^ 2 * (B - t) ^ 2 + A2 * y ^ 2 * (A1 + t) ^ 2 * (B - t) ^ 2
  - B * z ^ 2 * (A1 + t) ^ 2 * (A2 + t) ^ 2 - (A1 + t) ^ 2 * (A2 + t) ^ 2 * (B - t) ^ 2.

Lemma G_continuous A1 A2 B x y z : continuity (G A1 A2 B x y z).
Proof. unfold G; reg. Qed.

Lemma G_wall A1 A2 B x y z t : 0 < A1 -> 0 < A2 -> 0 < B -> 0 < A1 + t -> 0 < A2 + t -> 0 < B - t ->
  wall A1 A2 B (A1 * x / (A1 + t)) (A2 * y / (A2 + t)) (B * z / (B - t))
  = G A1 A2 B x y z t / ((A1 + t) ^ 2 * (A2 + t) ^ 2 * (B - t) ^ 2).
Proof. intros; unfold wall, G; field; lra. Qed.

Lemma G_at_0 A1 A2 B x y z : 0 < A1 -> 0 < A2 -> 0 < B ->
  G A1 A2 B x y z 0 = (A1 * A2 * B) ^ 2 * wall A1 A2 B x y z.
Proof. intros; unfold wall, G; field; lra. Qed.

(** Where G vanishes between the poles, all is found. *)
Lemma nearest_inside A1 A2 B x y z t : 0 < A1 -> 0 < A2 -> 0 < B -> 0 < A1 + t -> 0 < A2 + t -> 0 < B - t ->
  G A1 A2 B x y z t = 0 ->
  nearest_with A1 A2 B x y z t (A1 * x / (A1 + t)) (A2 * y / (A2 + t)) (B * z / (B - t)).
Proof.
  intros; unfold nearest_with; repeat split; try lra; [| field; lra | field; lra | field; lra].
  rewrite G_wall, H5 by assumption; field; lra.
Qed.

Lemma nearest_of_outer A1 A2 B x y z : 0 < A1 -> 0 < A2 -> 0 < B -> 0 < wall A1 A2 B x y z ->
  exists t Y1 Y2 Y3, 0 < t /\ nearest_with A1 A2 B x y z t Y1 Y2 Y3.
Proof.
  intros H1 H2 H3 W; pose proof (G_at_0 A1 A2 B x y z H1 H2 H3) as G0.
  assert (G0' : 0 < G A1 A2 B x y z 0) by (rewrite G0; pos).
  destruct (Req_dec z 0) as [Z | Z].
  - (* in the plane of the waist *)
    subst z; set (F := fun t => A1 * x ^ 2 * (A2 + t) ^ 2 + A2 * y ^ 2 * (A1 + t) ^ 2 - (A1 + t) ^ 2 * (A2 + t) ^ 2).
    assert (FC : continuity F) by (unfold F; reg).
    assert (F0 : 0 < F 0).
    { apply Rmult_lt_reg_l with (B ^ 2); [pos |]. replace (B ^ 2 * F 0) with (G A1 A2 B x y 0 0) by (unfold F, G; ring). lra. }
    destruct (Rle_lt_dec (F B) 0) as [K | K].
    + destruct (root_between F 0 B FC) as [t [T E]]; [lra | apply opposite; lra |].
      assert (T0 : t <> 0) by (intro; subst t; lra).
      exists t, (A1 * x / (A1 + t)), (A2 * y / (A2 + t)), 0; split; [lra |].
      unfold nearest_with; repeat split; try lra; try (field; lra).
      transitivity (F t / ((A1 + t) ^ 2 * (A2 + t) ^ 2)); [unfold wall, F; field; lra | rewrite E; field; lra].
    + set (h := B * F B / ((A1 + B) ^ 2 * (A2 + B) ^ 2)).
      assert (0 <= h) by (left; apply over_lt; pos).
      exists B, (A1 * x / (A1 + B)), (A2 * y / (A2 + B)), (sqrt h); split; [lra |].
      unfold nearest_with; repeat split; try lra; try (field; lra).
      unfold wall; rewrite sq_sqrt by assumption; unfold h, F; field; lra.
  - (* G falls below 0 towards the pole B *)
    assert (GB : G A1 A2 B x y z B < 0).
    { replace (G A1 A2 B x y z B) with (- (B * z ^ 2 * ((A1 + B) ^ 2 * (A2 + B) ^ 2))) by (unfold G; ring).
      assert (0 < B * z ^ 2 * ((A1 + B) ^ 2 * (A2 + B) ^ 2)) by pos; lra. }
    destruct (root_between (G A1 A2 B x y z) 0 B (G_continuous _ _ _ _ _ _)) as [t [T E]]; [lra | apply opposite; lra |].
    assert (t <> 0) by (intro; subst t; lra); assert (t <> B) by (intro; subst t; lra).
    exists t, (A1 * x / (A1 + t)), (A2 * y / (A2 + t)), (B * z / (B - t)); split; [lra |].
    apply nearest_inside; try assumption; lra.
Qed.

Lemma nearest_of_inner_ordered A1 A2 B x y z : 0 < A1 -> 0 < A2 -> 0 < B -> A1 <= A2 -> wall A1 A2 B x y z < 0 ->
  exists t Y1 Y2 Y3, t < 0 /\ nearest_with A1 A2 B x y z t Y1 Y2 Y3.
Proof.
  intros H1 H2 H3 L W; pose proof (G_at_0 A1 A2 B x y z H1 H2 H3) as G0.
  assert (G0' : G A1 A2 B x y z 0 < 0).
  { rewrite G0; apply Ropp_lt_cancel; rewrite Ropp_0, Ropp_mult_distr_r; pos. }
  destruct L as [L | L].
  - destruct (Req_dec x 0) as [X | X].
    + (* the smaller radial pole may be reached *)
      subst x; set (F := fun t => A2 * y ^ 2 * (B - t) ^ 2 - B * z ^ 2 * (A2 + t) ^ 2 - (A2 + t) ^ 2 * (B - t) ^ 2).
      assert (FC : continuity F) by (unfold F; reg).
      assert (F0 : F 0 < 0).
      { apply Rmult_lt_reg_l with (A1 ^ 2); [pos |].
        replace (A1 ^ 2 * F 0) with (G A1 A2 B 0 y z 0) by (unfold F, G; ring). lra. }
      destruct (Rle_lt_dec 0 (F (- A1))) as [K | K].
      * destruct (root_between F (- A1) 0 FC) as [t [T E]]; [lra | apply opposite; lra |].
        assert (t <> 0) by (intro; subst t; lra).
        exists t, 0, (A2 * y / (A2 + t)), (B * z / (B - t)); split; [lra |].
        unfold nearest_with; repeat split; try lra; try (field; lra).
        transitivity (F t / ((A2 + t) ^ 2 * (B - t) ^ 2)); [unfold wall, F; field; lra | rewrite E; field; lra].
      * set (h := A1 * - F (- A1) / ((A2 - A1) ^ 2 * (B + A1) ^ 2)).
        assert (0 <= h) by (left; apply over_lt; pos).
        exists (- A1), (sqrt h), (A2 * y / (A2 - A1)), (B * z / (B + A1)); split; [lra |].
        unfold nearest_with; repeat split; try lra; try (field; lra).
        unfold wall; rewrite sq_sqrt by assumption; unfold h, F; field; lra.
    + assert (GA : 0 < G A1 A2 B x y z (- A1)).
      { replace (G A1 A2 B x y z (- A1)) with (A1 * x ^ 2 * ((A2 - A1) ^ 2 * (B + A1) ^ 2)) by (unfold G; ring). pos. }
      destruct (root_between (G A1 A2 B x y z) (- A1) 0 (G_continuous _ _ _ _ _ _)) as [t [T E]];
        [lra | apply opposite; lra |].
      assert (t <> 0) by (intro; subst t; lra); assert (t <> - A1) by (intro; subst t; lra).
      exists t, (A1 * x / (A1 + t)), (A2 * y / (A2 + t)), (B * z / (B - t)); split; [lra |].
      apply nearest_inside; try assumption; lra.
  - (* round about the axis *)
    subst A2; set (F := fun t => A1 * (x ^ 2 + y ^ 2) * (B - t) ^ 2 - (A1 + t) ^ 2 * (B * z ^ 2 + (B - t) ^ 2)).
    assert (FC : continuity F) by (unfold F; reg).
    assert (F0 : F 0 < 0).
    { apply Rmult_lt_reg_l with (A1 ^ 2); [pos |].
      replace (A1 ^ 2 * F 0) with (G A1 A1 B x y z 0) by (unfold F, G; ring). lra. }
    pose proof (pow2_ge_0 x); pose proof (pow2_ge_0 y).
    destruct (Req_dec (x ^ 2 + y ^ 2) 0) as [X | X].
    + (* a circle of nearest points *)
      assert (x = 0 /\ y = 0) as [-> ->] by (split; nra).
      set (Z := B * z / (B + A1)).
      assert (0 <= Z ^ 2 / B) by (apply over_pos; [apply pow2_ge_0 | assumption]).
      assert (0 <= A1 * (1 + Z ^ 2 / B)) by (apply Rmult_le_pos; lra).
      exists (- A1), (sqrt (A1 * (1 + Z ^ 2 / B))), 0, Z; split; [lra |].
      unfold nearest_with; repeat split; try lra.
      * unfold wall; rewrite sq_sqrt by assumption; field; lra.
      * unfold Z; field; lra.
    + assert (FA : 0 < F (- A1)).
      { replace (F (- A1)) with (A1 * (x ^ 2 + y ^ 2) * (B + A1) ^ 2) by (unfold F; ring).
        assert (0 < x ^ 2 + y ^ 2) by lra; pos. }
      destruct (root_between F (- A1) 0 FC) as [t [T E]]; [lra | apply opposite; lra |].
      assert (t <> 0) by (intro; subst t; lra); assert (t <> - A1) by (intro; subst t; lra).
      exists t, (A1 * x / (A1 + t)), (A1 * y / (A1 + t)), (B * z / (B - t)); split; [lra |].
      apply nearest_inside; try assumption; try lra.
      replace (G A1 A1 B x y z t) with ((A1 + t) ^ 2 * F t) by (unfold F, G; ring). rewrite E; ring.
Qed.

Lemma nearest_of_inner A1 A2 B x y z : 0 < A1 -> 0 < A2 -> 0 < B -> wall A1 A2 B x y z < 0 ->
  exists t Y1 Y2 Y3, t < 0 /\ nearest_with A1 A2 B x y z t Y1 Y2 Y3.
Proof.
  intros H1 H2 H3 W; destruct (Rle_lt_dec A1 A2) as [L | L]; [apply nearest_of_inner_ordered; assumption |].
  destruct (nearest_of_inner_ordered A2 A1 B y x z) as (t & Y2 & Y1 & Y3 & T & N); try assumption; try lra.
  { unfold wall in *; lra. }
  exists t, Y1, Y2, Y3; split; [assumption |]; unfold nearest_with, wall in *; repeat split; try apply N; lra.
Qed.

Theorem nearest_exists A1 A2 B x y z : 0 < A1 -> 0 < A2 -> 0 < B ->
  exists t Y1 Y2 Y3, nearest_with A1 A2 B x y z t Y1 Y2 Y3
    /\ (0 < wall A1 A2 B x y z -> 0 < t) /\ (wall A1 A2 B x y z < 0 -> t < 0)
    /\ (wall A1 A2 B x y z = 0 -> Y1 = x /\ Y2 = y /\ Y3 = z).
Proof.
  intros H1 H2 H3; destruct (Rtotal_order (wall A1 A2 B x y z) 0) as [W | [W | W]].
  - destruct (nearest_of_inner A1 A2 B x y z H1 H2 H3 W) as (t & Y1 & Y2 & Y3 & T & N).
    exists t, Y1, Y2, Y3; split; [assumption | repeat split; lra].
  - exists 0, x, y, z; unfold nearest_with; repeat split; lra.
  - destruct (nearest_of_outer A1 A2 B x y z H1 H2 H3) as (t & Y1 & Y2 & Y3 & T & N); [lra |].
    exists t, Y1, Y2, Y3; split; [assumption | repeat split; lra].
Qed.
