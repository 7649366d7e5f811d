(** From signs to the position: what each stage of the kernel asks of an upright pair, and that its answer is right.

    The signs are those of exact numbers here: of the discriminant and the coefficients of g, of its slopes and of the place
    of its inflection; of the equations of a tangency; of half planes. Stages.v has the numbers that are computed. *)

Require Import Reals Lra Psatz.
From Hypcheck Require Import Geometry Certificates UnitBall Duality Cubic AnyAxis Completeness Rule.
Open Scope R_scope.

Inductive answer := Exterior | Contact | Interior.

Definition is_position p a := match a with Exterior => exterior p | Contact => contact p | Interior => interior p end.

Lemma one_answer_is_right p a c : is_position p a -> is_position p c -> a = c.
Proof.
  pose proof (positions_exclude_each_other p); destruct a, c; simpl; intros; try reflexivity; tauto.
Qed.

Section Upright.

Variables alpha gamma b d x y z : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d).

Let p := upright alpha gamma b d x y z.
Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let P := (x ^ 2 + y ^ 2) / b ^ 2.
Let Q := (z / d) ^ 2.

Let a2 := c2 A B P Q.
Let a1 := c1 A B P Q.
Let D := delta A B P Q.
Let slope_at l := slope A B P Q l.

Let HA : 0 < A.
Proof. apply A_pos; assumption. Qed.
Let HB : 0 < B.
Proof. apply B_pos; assumption. Qed.
Let HP : 0 <= P.
Proof. apply P_ge_0; assumption. Qed.
Let HQ : 0 <= Q.
Proof. apply Q_ge_0. Qed.
Let by_g : (exterior p <-> outside A B P Q) /\ (interior p <-> inside A B P Q) /\ (contact p <-> neither A B P Q).
Proof. apply positions_by_g; assumption. Qed.

Let contact_unless : ~ exterior p -> ~ interior p -> contact p.
Proof.
  intros E I; apply (proj2 (proj2 by_g)); split; [rewrite <- (proj1 by_g) | rewrite <- (proj1 (proj2 by_g))]; assumption.
Qed.

Let exterior_coefficients := exterior_by_coefficients alpha gamma b d x y z Ha Hg Hb Hd.
Let interior_coefficients := interior_by_coefficients alpha gamma b d x y z Ha Hg Hb Hd.

(** On the ring three roots are positive. *)
Let ring_signs : ring A B P Q -> a2 < 0 /\ 0 < a1.
Proof.
  intros R; apply (ring_is_outside A B P Q HA HB) in R; apply (outside_by_maximum A B P Q HA HB HP HQ) in R.
  destruct R as (H & [M _] & _); apply (maximum_positive A B P Q H); assumption.
Qed.

(** ** Stages 2, 3 and 5: the rule by the coefficients. *)

Theorem exterior_by_signs : 0 < D -> a2 < 0 -> 0 < a1 -> - 3 * B < a2 \/ slope_at B < 0 -> exterior p.
Proof.
  intros S S2 S1 N; apply exterior_coefficients; left; repeat split; try assumption.
  intros [K2 K1]; change (a2 < - 3 * B) in K2; change (0 < slope_at B) in K1; lra.
Qed.

Theorem interior_by_signs : 0 < D -> 0 < a2 \/ a1 < 0 -> a2 < 3 * A -> 0 < slope_at (- A) -> interior p.
Proof.
  intros S N SA SL; apply interior_coefficients; repeat split; try assumption; intros [K2 K1]; change (a2 < 0) in K2; change (0 < a1) in K1; lra.
Qed.

(** Where alpha >= b nothing needs to be asked at the pole. *)
Theorem interior_by_signs_wide : b <= alpha -> 0 < D -> 0 < a2 \/ a1 < 0 -> interior p.
Proof.
  intros W S N; apply (proj1 (proj2 by_g)); apply proposition_5_repaired; try assumption.
  - unfold A; replace 1 with (1 ^ 2) by ring; apply pow_incr; split; [lra |].
    apply Rmult_le_reg_r with b; [assumption |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra.
  - split; [exact S | intros [K2 K1]; change (a2 < 0) in K2; change (0 < a1) in K1; lra].
Qed.

Theorem contact_by_discriminant : D < 0 -> contact p.
Proof.
  intros S; apply contact_unless.
  - intros E; apply exterior_coefficients in E; destruct E as [(K & _) | R]; [change (0 < D) in K; lra |].
    apply ring_has_delta_0 in R; try assumption; change (D = 0) in R; lra.
  - intros I; apply interior_coefficients in I; destruct I as (K & _); change (0 < D) in K; lra.
Qed.

(** Whatever the discriminant is: both crossings lie beyond B. *)
Theorem contact_by_groove : a2 < 0 -> 0 < a1 -> a2 < - 3 * B -> 0 < slope_at B -> contact p.
Proof.
  intros S2 S1 O S; apply contact_unless.
  - intros E; apply exterior_coefficients in E; destruct E as [(_ & _ & _ & N) | (_ & R & _)].
    + apply N; split; assumption.
    + change (slope_at B = 0) in R; lra.
  - intros I; apply interior_coefficients in I; destruct I as (_ & N & _); apply N; split; assumption.
Qed.

(** Whatever the discriminant is: both crossings lie below -A. *)
Theorem contact_by_throat : 0 < a2 \/ a1 < 0 -> 3 * A < a2 \/ slope_at (- A) < 0 -> contact p.
Proof.
  intros S N; apply contact_unless.
  - intros E; apply exterior_coefficients in E; destruct E as [(_ & S2 & S1 & _) | R]; [change (a2 < 0) in S2; change (0 < a1) in S1; lra |].
    apply ring_signs in R; lra.
  - intros I; apply interior_coefficients in I; destruct I as (_ & _ & O & K); change (a2 < 3 * A) in O; change (0 < slope_at (- A)) in K; lra.
Qed.

(** g > 0 at its inflection, which lies between 0 and B: the ring, and what is near it. *)
Theorem exterior_by_inflection : a2 < 0 -> - 3 * B < a2 -> 0 < g A B P Q (- a2 / 3) -> exterior p.
Proof.
  intros L U G; apply (exterior_by_g alpha gamma b d x y z Ha Hg Hb Hd (- a2 / 3)); [lra | fold B; lra | exact G].
Qed.

(** The exact rule, as the last stage asks it. *)
Definition exact_answer (sign_of_delta sign_2 sign_1 offset_B slope_B offset_A slope_A sign_z ring_excess : comparison) :=
  match sign_of_delta, sign_2, sign_1 with
  | Gt, Lt, Gt => match offset_B, slope_B with Lt, Gt => Contact | _, _ => Exterior end
  | Gt, _, _ => match offset_A, slope_A with Gt, Gt => Interior | _, _ => Contact end
  | Eq, _, _ => match sign_z, slope_B, ring_excess with Eq, Eq, Gt => Exterior | _, _, _ => Contact end
  | Lt, _, _ => Contact end.

Definition sign_is (s : comparison) v := match s with Lt => v < 0 | Eq => v = 0 | Gt => 0 < v end.

Theorem exact_answer_is_right sD s2 s1 oB sB oA sA sz rx :
  sign_is sD D -> sign_is s2 a2 -> sign_is s1 a1 -> sign_is oB (3 * B + a2) -> sign_is sB (slope_at B) ->
  sign_is oA (3 * A - a2) -> sign_is sA (slope_at (- A)) -> sign_is sz z -> sign_is rx (B ^ 2 - A) ->
  is_position p (exact_answer sD s2 s1 oB sB oA sA sz rx).
Proof.
  intros SD S2 S1 OB SB OA SA SZ RX.
  assert (three : 0 < D -> ~ (a2 < 0 /\ 0 < a1) -> is_position p (match oA, sA with Gt, Gt => Interior | _, _ => Contact end)).
  { intros S N.
    assert (no : ~ (a2 < 3 * A /\ 0 < slope_at (- A)) -> contact p).
    { intros K; apply contact_unless.
      - intros E; apply exterior_coefficients in E; destruct E as [(_ & K2 & K1 & _) | R].
        + apply N; split; assumption.
        + apply ring_signs in R; tauto.
      - intros I; apply interior_coefficients in I; destruct I as (_ & _ & O & L); apply K; split; assumption. }
    destruct oA, sA; simpl in OA, SA; try (apply no; lra).
    apply interior_coefficients; repeat split; try assumption; change (a2 < 3 * A); lra. }
  destruct sD; simpl in SD.
  - assert (Z : ~ ring A B P Q -> contact p).
    { intros R; apply contact_unless; intros K; [apply exterior_coefficients in K | apply interior_coefficients in K];
        [destruct K as [[K _] | K]; [| tauto] | destruct K as [K _]]; change (0 < D) in K; lra. }
    assert (at_B : g A B P Q B = - (B * Q * (A + B))) by apply g_at_B.
    simpl; destruct sz, sB, rx; simpl in SZ, SB, RX; simpl;
      try (apply Z; intros (GB & R & E); change (slope_at B = 0) in R; change (A < B ^ 2) in E; try lra).
    + apply exterior_coefficients; right; repeat split; [| exact SB | change (A < B ^ 2); lra].
      change (g A B P Q B = 0); rewrite at_B; unfold Q; rewrite SZ; unfold Rdiv; ring.
    + change (g A B P Q B = 0) in GB; rewrite at_B in GB.
      assert (0 < Q) by (unfold Q; apply square_pos; apply Rmult_integral_contrapositive; split; [lra | apply Rinv_neq_0_compat; lra]).
      assert (0 < B * Q * (A + B)) by (apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; assumption | lra]); lra.
    + change (g A B P Q B = 0) in GB; rewrite at_B in GB.
      assert (0 < Q) by (unfold Q; apply square_pos; apply Rmult_integral_contrapositive; split; [lra | apply Rinv_neq_0_compat; lra]).
      assert (0 < B * Q * (A + B)) by (apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; assumption | lra]); lra.
  - apply contact_by_discriminant; exact SD.
  - destruct s2, s1; simpl in S2, S1; try (apply three; [exact SD | lra]).
    assert (yes : ~ (a2 < - 3 * B /\ 0 < slope_at B) -> exterior p).
    { intros N; apply exterior_coefficients; left; repeat split; assumption. }
    simpl; destruct oB, sB; simpl in OB, SB; simpl; try (apply yes; lra).
    apply contact_by_groove; lra.
Qed.

End Upright.
