(** Whatever stage answers, the answer is the position: the theorems of the stages in one.

    A stage compares computed numbers with bounds of their errors, or exact numbers with 0. That the bounds hold is proved in
    Kernel.v and RunningBound.v for stage 2, in FixedRuns.v for stage 3; [certain] is what a comparison with such a bound says. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry UnitBall AnyAxis Rule Positions HalfPlanes Tangency.
Open Scope R_scope.

(** The computed number exceeds its bound, so that the exact one is positive, or negative. *)
Definition certainly_positive v := exists X E, Rabs (X - v) <= E /\ E < X.
Definition certainly_negative v := exists X E, Rabs (X - v) <= E /\ X < - E.

Lemma is_positive v : certainly_positive v -> 0 < v.
Proof. intros (X & E & H & C); pose proof (Rle_abs (X - v)); lra. Qed.
Lemma is_negative v : certainly_negative v -> v < 0.
Proof. intros (X & E & H & C); pose proof (Rle_abs (- (X - v))); rewrite Rabs_Ropp in *; lra. Qed.

Section Row.

Variables alpha gamma b d x y z : R.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d).

Let p := upright alpha gamma b d x y z.
Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let P := (x ^ 2 + y ^ 2) / b ^ 2.
Let Q := (z / d) ^ 2.
Let a2 := c2 A B P Q.
Let a1 := c1 A B P Q.
Let two_negative := certainly_positive a2 \/ certainly_negative a1.

Let at_centre := upright alpha gamma b d.
Let touches_without M e x y z := tangency_equations alpha gamma b d x y z M e /\ 0 < M /\ b * d * M <= e ^ 2
  /\ M * d ^ 2 <= gamma ^ 2 * (b * d).
Let touches_within M e x y z := tangency_equations alpha gamma b d x y z M e /\ M < 0 /\ - M * b ^ 2 <= alpha ^ 2 * (b * d).

(** What the stages may answer, a line for each place in the code that answers. A factor > 0 of a number, such as 3 of 3 delta
    or N of N c2, does not change what a comparison says. *)
Inductive answers : answer -> Prop :=
(* stage 1 *)
| beyond_line K M l : 0 < l < B -> beyond_K alpha b l <= K -> beyond_M alpha gamma b d l <= M ->
    K + M * z ^ 2 < x ^ 2 + y ^ 2 -> answers Exterior
| within_line K M m : 0 < m < A -> K <= within_K alpha b m -> M <= within_M alpha gamma b d m ->
    x ^ 2 + y ^ 2 < K + M * z ^ 2 -> answers Interior
| between_chords K M K' M' x1 y1 z1 x2 y2 z2 x3 y3 z3 x4 y4 z4 :
    ~ exterior (at_centre x1 y1 z1) -> ~ exterior (at_centre x2 y2 z2) -> z1 ^ 2 <= z ^ 2 <= z2 ^ 2 ->
    K + M * z1 ^ 2 <= x1 ^ 2 + y1 ^ 2 -> K + M * z2 ^ 2 <= x2 ^ 2 + y2 ^ 2 -> x ^ 2 + y ^ 2 <= K + M * z ^ 2 ->
    ~ interior (at_centre x3 y3 z3) -> ~ interior (at_centre x4 y4 z4) -> z3 ^ 2 <= z ^ 2 <= z4 ^ 2 ->
    x3 ^ 2 + y3 ^ 2 <= K' + M' * z3 ^ 2 -> x4 ^ 2 + y4 ^ 2 <= K' + M' * z4 ^ 2 -> K' + M' * z ^ 2 <= x ^ 2 + y ^ 2 ->
    answers Contact
(* stages 2 and 3 *)
| by_coefficients_exterior : certainly_positive (3 * delta A B P Q) -> certainly_negative a2 -> certainly_positive a1 ->
    certainly_positive (3 * B + a2) \/ certainly_negative (slope A B P Q B) -> answers Exterior
| by_coefficients_interior : certainly_positive (3 * delta A B P Q) -> two_negative -> certainly_positive (3 * A - a2) ->
    certainly_positive (slope A B P Q (- A)) -> answers Interior
| by_coefficients_wide : certainly_positive (3 * delta A B P Q) -> two_negative -> b <= alpha -> answers Interior
| one_root : certainly_negative (3 * delta A B P Q) -> answers Contact
| groove : certainly_negative a2 -> certainly_positive a1 -> certainly_negative (3 * B + a2) ->
    certainly_positive (slope A B P Q B) -> answers Contact
| throat : two_negative -> certainly_negative (3 * A - a2) \/ certainly_negative (slope A B P Q (- A)) -> answers Contact
| inflection : certainly_negative a2 -> certainly_positive (3 * B + a2) -> certainly_positive (27 * g A B P Q (- a2 / 3)) ->
    answers Exterior
(* stage 4 *)
| touching_without M e : touches_without M e x y z -> answers Contact
| touching_within M e : touches_within M e x y z -> answers Contact
| hair_outside x0 y0 M e : touches_without M e x0 y0 z -> x0 ^ 2 + y0 ^ 2 < x ^ 2 + y ^ 2 -> answers Exterior
| hair_upwards M e : touches_without M e x y 0 -> z ^ 2 * alpha <= 4 * b * gamma ^ 2 -> answers Contact
| hair_inside M e : touches_within M e x y 0 -> z <> 0 -> answers Interior
| hair_outwards x0 y0 M e : touches_within M e x0 y0 z -> x0 ^ 2 + y0 ^ 2 <= x ^ 2 + y ^ 2 ->
    (x - x0) ^ 2 + (y - y0) ^ 2 <= b ^ 2 -> answers Contact
| waist_clear : z = 0 -> 0 < P - 1 - A -> 4 * A < (P - 1 - A) ^ 2 -> P - 1 - A <= 2 * B -> answers Exterior
| waist_inside : z = 0 -> P - 1 - A < 0 -> 4 * A < (P - 1 - A) ^ 2 -> - 2 * A <= P - 1 - A -> answers Interior
| waist_crossing : z = 0 -> (P - 1 - A) ^ 2 <= 4 * A \/ P - 1 - A < - 2 * A -> answers Contact
(* stage 5 *)
| by_integers sD s2 s1 oB sB oA sA sz rx : sign_is sD (delta A B P Q) -> sign_is s2 a2 -> sign_is s1 a1 ->
    sign_is oB (3 * B + a2) -> sign_is sB (slope A B P Q B) -> sign_is oA (3 * A - a2) -> sign_is sA (slope A B P Q (- A)) ->
    sign_is sz z -> sign_is rx (B ^ 2 - A) -> answers (exact_answer sD s2 s1 oB sB oA sA sz rx).

Let cleared : two_negative -> 0 < a2 \/ a1 < 0.
Proof. intros [H | H]; [left; apply is_positive | right; apply is_negative]; exact H. Qed.

Ltac signs := repeat match goal with
  | H : certainly_positive _ |- _ => apply is_positive in H | H : certainly_negative _ |- _ => apply is_negative in H
  | H : certainly_positive _ \/ certainly_negative _ |- _ => destruct H
  | H : certainly_negative _ \/ certainly_negative _ |- _ => destruct H end.

Theorem whatever_stage_answers a : answers a -> is_position p a.
Proof.
  assert (D0 : 0 < b * d) by (apply Rmult_lt_0_compat; assumption).
  intros H; destruct H; cbn [is_position].
  - apply (exterior_beyond_line alpha gamma b d Ha Hg Hb Hd K M l); assumption.
  - apply (interior_within_line alpha gamma b d Ha Hg Hb Hd K M m); assumption.
  - apply (contact_between_chords alpha gamma b d Ha Hg Hb Hd).
    + apply (not_exterior_under_chord alpha gamma b d Ha Hg Hb Hd K M x1 y1 z1 x2 y2 z2); assumption.
    + apply (not_interior_above_chord alpha gamma b d Ha Hg Hb Hd K' M' x3 y3 z3 x4 y4 z4); assumption.
  - signs; apply (exterior_by_signs alpha gamma b d x y z Ha Hg Hb Hd); fold A B P Q a2 a1; lra.
  - signs; apply (interior_by_signs alpha gamma b d x y z Ha Hg Hb Hd); fold A B P Q a2 a1; try apply cleared; auto; lra.
  - signs; apply (interior_by_signs_wide alpha gamma b d x y z Ha Hg Hb Hd); fold A B P Q a2 a1; try apply cleared; auto; lra.
  - signs; apply (contact_by_discriminant alpha gamma b d x y z Ha Hg Hb Hd); fold A B P Q; lra.
  - signs; apply (contact_by_groove alpha gamma b d x y z Ha Hg Hb Hd); fold A B P Q a2 a1; lra.
  - apply (contact_by_throat alpha gamma b d x y z Ha Hg Hb Hd); [apply cleared; assumption |].
    fold A B P Q a2; destruct H0 as [K | K]; apply is_negative in K; lra.
  - signs; apply (exterior_by_inflection alpha gamma b d x y z Ha Hg Hb Hd); fold A B P Q a2; lra.
  - destruct H as (T & M0 & S & R); exact (proj1 (touches_from_without alpha gamma b d x y z Ha Hg Hb Hd M e T M0 S R)).
  - destruct H as (T & M0 & R); exact (proj1 (touches_from_within alpha gamma b d x y z Ha Hg Hb Hd M e T M0 R)).
  - destruct H as (T & M0 & S & R); destruct (root_is_double alpha gamma b d x0 y0 z Hb Hd M e T) as [G L].
    apply (farther_is_exterior alpha gamma b d Ha Hg Hb Hd x0 y0 z x y (M / (b * d))); try assumption.
    split; [apply over_lt; assumption |]; unfold B; apply Rmult_le_reg_r with (b * d * d ^ 2);
      [apply Rmult_lt_0_compat; [| apply pow_lt]; assumption |].
    replace (M / (b * d) * (b * d * d ^ 2)) with (M * d ^ 2) by (field; lra).
    replace ((gamma / d) ^ 2 * (b * d * d ^ 2)) with (gamma ^ 2 * (b * d)) by (field; lra); exact R.
  - destruct H as (T & M0 & S & R); apply (hair_along_axis alpha gamma b d Ha Hg Hb Hd); [| assumption].
    exact (touches_from_without alpha gamma b d x y 0 Ha Hg Hb Hd M e T M0 S R).
  - destruct H as (T & M0 & R); destruct (root_is_double alpha gamma b d x y 0 Hb Hd M e T) as [G L].
    replace ((0 / d) ^ 2) with 0 in G, L by (field; lra).
    apply (higher_is_interior alpha gamma b d Ha Hg Hb Hd x y z (M / (b * d))); try assumption.
    assert (W : 0 < / (b * d)) by (apply Rinv_0_lt_compat; assumption); split.
    + unfold A; apply Rmult_le_reg_r with (b * d * b ^ 2); [apply Rmult_lt_0_compat; [| apply pow_lt]; assumption |].
      replace (M / (b * d) * (b * d * b ^ 2)) with (M * b ^ 2) by (field; lra).
      replace (- (alpha / b) ^ 2 * (b * d * b ^ 2)) with (- (alpha ^ 2 * (b * d))) by (field; lra); lra.
    + assert (0 < - M * / (b * d)) by (apply Rmult_lt_0_compat; lra); unfold Rdiv; lra.
  - destruct H as (T & M0 & R); apply (hair_across_axis alpha gamma b d Ha Hg Hb Hd x0 y0 z); try assumption.
    exact (touches_from_within alpha gamma b d x0 y0 z Ha Hg Hb Hd M e T M0 R).
  - subst z; apply (waist_exterior alpha gamma b d Ha Hg Hb Hd); assumption.
  - subst z; apply (waist_interior alpha gamma b d Ha Hg Hb Hd); assumption.
  - subst z; destruct H0; [apply (waist_contact alpha gamma b d Ha Hg Hb Hd) | apply (waist_contact_below alpha gamma b d Ha Hg Hb Hd)];
      assumption.
  - apply (exact_answer_is_right alpha gamma b d x y z Ha Hg Hb Hd); assumption.
Qed.

(** Hence no two stages disagree. *)
Corollary stages_agree a c : answers a -> answers c -> a = c.
Proof. intros H K; apply (one_answer_is_right p); apply whatever_stage_answers; assumption. Qed.

End Row.
