(** The table of root patterns is complete, every row of it occurs, and every row means what it says.

    After [10], re-derived. A row is a kind, its meaning, and the real roots of g in ascending order: where each stands
    to -A, 0 and B, and its multiplicity. A single simple root stands for a complex pair beside it. The rows are those
    of hypcheck/truth/roots.py; a test compares the two. *)

Require Import Reals Lra List String.
From Hypcheck Require Import Geometry Certificates UnitBall Duality AnyAxis Completeness Cubic Rule.
Import ListNotations.
Open Scope R_scope.

Inductive place := Below | AtMinusA | Inner | Outer | AtB | Above.
Inductive meaning := ClearInside | TouchesInside | Crosses | TouchesOutside | ClearOutside.

Definition pattern := list (place * nat).
Definition row : Type := string * meaning * pattern.

Definition table : list row :=
  Eval compute in [
    ("interior", ClearInside, [(Inner, 1); (Inner, 1); (AtB, 1)]);
    ("interior", ClearInside, [(Inner, 1); (Inner, 1); (Above, 1)]);
    ("interior", ClearInside, [(AtMinusA, 1); (Inner, 1); (AtB, 1)]);
    ("interior", ClearInside, [(AtMinusA, 1); (Inner, 1); (Above, 1)]);
    ("interior-tangent-point", TouchesInside, [(Inner, 2); (AtB, 1)]);
    ("interior-tangent-point", TouchesInside, [(Inner, 2); (Above, 1)]);
    ("interior-tangent-circle", TouchesInside, [(AtMinusA, 2); (AtB, 1)]);
    ("interior-tangent-circle", TouchesInside, [(AtMinusA, 2); (Above, 1)]);
    ("crossing-throat-two-curves", Crosses, [(Below, 1); (Below, 1); (AtB, 1)]);
    ("crossing-throat-two-curves", Crosses, [(Below, 1); (Below, 1); (Above, 1)]);
    ("crossing-throat-two-curves", Crosses, [(Below, 1); (AtMinusA, 1); (AtB, 1)]);
    ("crossing-throat-two-curves", Crosses, [(Below, 1); (AtMinusA, 1); (Above, 1)]);
    ("crossing-throat-node", Crosses, [(Below, 2); (AtB, 1)]);
    ("crossing-throat-node", Crosses, [(Below, 2); (Above, 1)]);
    ("crossing-one-curve", Crosses, [(AtB, 1)]);
    ("crossing-one-curve", Crosses, [(Above, 1)]);
    ("exterior", ClearOutside, [(Outer, 1); (Outer, 1); (AtB, 1)]);
    ("exterior", ClearOutside, [(Outer, 1); (Outer, 1); (Above, 1)]);
    ("exterior", ClearOutside, [(Outer, 1); (AtB, 1); (Above, 1)]);
    ("exterior-ring", ClearOutside, [(Outer, 1); (AtB, 2)]);
    ("exterior-tangent-point", TouchesOutside, [(Outer, 2); (AtB, 1)]);
    ("exterior-tangent-point", TouchesOutside, [(Outer, 2); (Above, 1)]);
    ("exterior-tangent-two-points", TouchesOutside, [(AtB, 2); (Above, 1)]);
    ("exterior-tangent-osculating", TouchesOutside, [(AtB, 3)]);
    ("crossing-groove-two-curves", Crosses, [(AtB, 1); (Above, 1); (Above, 1)]);
    ("crossing-groove-two-curves", Crosses, [(Above, 1); (Above, 1); (Above, 1)]);
    ("crossing-groove-isolated-point", Crosses, [(Above, 2); (Above, 1)]);
    ("crossing-groove-node", Crosses, [(AtB, 1); (Above, 2)]);
    ("crossing-groove-node", Crosses, [(Above, 1); (Above, 2)]);
    ("crossing-groove-cusp", Crosses, [(Above, 3)])
  ]%string%nat.

Section Table.

Variables A B P Q : R.
Hypotheses (HA : 0 < A) (HB : 0 < B) (HP : 0 <= P) (HQ : 0 <= Q).

Definition stands (p : place) (r : R) := match p with
  | Below => r < - A | AtMinusA => r = - A | Inner => - A < r < 0
  | Outer => 0 < r < B | AtB => r = B | Above => B < r end.

Definition has_pattern (s : pattern) := match s with
  | [(p, 1%nat)] => exists r m e, 0 < e /\ stands p r /\ forall l, g A B P Q l = (l - r) * ((l - m) ^ 2 + e)
  | [(p, 1%nat); (q, 1%nat); (t, 1%nat)] => exists u v w, u < v < w /\ stands p u /\ stands q v /\ stands t w
      /\ forall l, g A B P Q l = (l - u) * (l - v) * (l - w)
  | [(p, 2%nat); (q, 1%nat)] => exists u w, u < w /\ stands p u /\ stands q w
      /\ forall l, g A B P Q l = (l - u) * (l - u) * (l - w)
  | [(p, 1%nat); (q, 2%nat)] => exists u w, u < w /\ stands p u /\ stands q w
      /\ forall l, g A B P Q l = (l - u) * (l - w) * (l - w)
  | [(p, 3%nat)] => exists u, stands p u /\ forall l, g A B P Q l = (l - u) * (l - u) * (l - u)
  | _ => False end.

(** ** One root is at least B; the others are complex or real. *)

Lemma roots_of_g : (exists r m e, 0 < e /\ B <= r /\ forall l, g A B P Q l = (l - r) * ((l - m) ^ 2 + e))
  \/ (exists u v w, u <= v <= w /\ B <= w /\ forall l, g A B P Q l = (l - u) * (l - v) * (l - w)).
Proof.
  destruct (g_poles A B P Q HA HB HP HQ) as (_ & _ & GB).
  set (a2 := c2 A B P Q); set (a1 := c1 A B P Q); set (a0 := c0 A B P Q).
  assert (GK : forall l, g A B P Q l = k a2 a1 a0 l) by (intros; unfold k, a2, a1, a0; rewrite g_expanded; reflexivity).
  destruct (k_large a2 a1 a0) as (T & T0 & TU & _).
  assert (BT : B < T) by (apply Rnot_le_lt; intro N; specialize (TU _ N); rewrite <- GK in TU; lra).
  destruct (root_between (k a2 a1 a0) B T (k_continuous _ _ _)) as (r & R & E); [lra | |].
  { apply opposite'; [rewrite <- GK; assumption | left; apply TU; lra]. }
  destruct (split_off a2 a1 a0 r E) as [(u & v & UV & F) | (m & e & He & F)].
  - right; destruct (Rle_lt_dec v r) as [V | V]; [exists u, v, r | destruct (Rle_lt_dec u r); [exists u, r, v | exists r, u, v]];
      (split; [lra |]; split; [lra |]; intros l; rewrite GK, F; ring).
  - left; exists r, m, e; split; [assumption |]; split; [lra |]; intros l; rewrite GK; apply F.
Qed.

(** ** Completeness: the pattern of every pair is in the table. *)

Definition listed := exists r, In r table /\ has_pattern (snd r).

Lemma listed_row n : Nat.ltb n (List.length table) = true ->
  has_pattern (snd (nth n table (EmptyString, Crosses, nil))) -> listed.
Proof. intros N H; eexists; split; [apply nth_In, PeanoNat.Nat.ltb_lt; exact N | exact H]. Qed.

Ltac listed n := apply (listed_row n); [reflexivity | simpl].
Ltac simple_roots n u v w F := listed n; exists u, v, w; repeat split; try lra; exact F.
Ltac double_first n u w F := listed n; exists u, w; repeat split; try lra; intros l; rewrite F; subst; ring.
Ltac double_last n u w F := listed n; exists u, w; repeat split; try lra; intros l; rewrite F; subst; ring.

Theorem table_is_complete : listed.
Proof.
  destruct (g_poles A B P Q HA HB HP HQ) as (GA & G0 & GB).
  destruct roots_of_g as [(r & m & e & He & R & F) | (u & v & w & UVW & W & F)].
  { destruct R as [R | R]; [listed 15%nat | listed 14%nat]; exists r, m, e; repeat split; try lra; exact F. }
  rewrite F in GA, G0, GB.
  assert (N0 : 0 < u * v).
  { apply Rmult_lt_reg_r with w; [lra |]. replace (u * v * w) with (- ((0 - u) * (0 - v) * (0 - w))) by ring; lra. }
  assert (NA : 0 <= (A + u) * (A + v)).
  { apply Rmult_le_reg_r with (A + w); [lra |].
    replace ((A + u) * (A + v) * (A + w)) with (- ((- A - u) * (- A - v) * (- A - w))) by ring; lra. }
  assert (NB : B < w -> 0 <= (B - u) * (B - v)).
  { intros BW; apply Rmult_le_reg_r with (w - B); [lra |].
    replace ((B - u) * (B - v) * (w - B)) with (- ((B - u) * (B - v) * (B - w))) by ring; lra. }
  destruct (Rlt_le_dec u 0) as [U0 | U0].
  - (* two negative roots *)
    assert (V0 : v < 0) by (apply Rnot_le_lt; intro N; assert (0 <= - u * v) by (apply Rmult_le_pos; lra); lra).
    destruct (Rtotal_order u (- A)) as [UA | [UA | UA]].
    + assert (VA : v <= - A).
      { apply Rnot_lt_le; intro N; assert (0 < - (A + u) * (A + v)) by (apply Rmult_lt_0_compat; lra); lra. }
      destruct VA as [VA | VA].
      * destruct (proj1 UVW) as [UV | UV]; destruct W as [BW | BW].
        -- simple_roots 9%nat u v w F.
        -- simple_roots 8%nat u v w F.
        -- double_first 13%nat u w F.
        -- double_first 12%nat u w F.
      * destruct W as [BW | BW]; [simple_roots 11%nat u v w F | simple_roots 10%nat u v w F].
    + destruct (proj1 UVW) as [UV | UV]; destruct W as [BW | BW].
      * simple_roots 3%nat u v w F.
      * simple_roots 2%nat u v w F.
      * double_first 7%nat u w F.
      * double_first 6%nat u w F.
    + destruct (proj1 UVW) as [UV | UV]; destruct W as [BW | BW].
      * simple_roots 1%nat u v w F.
      * simple_roots 0%nat u v w F.
      * double_first 5%nat u w F.
      * double_first 4%nat u w F.
  - (* no negative root; 0 is none *)
    assert (U1 : 0 < u) by (destruct U0 as [U1 | U1]; [assumption | rewrite <- U1 in N0; lra]).
    destruct W as [BW | BW].
    + specialize (NB BW); destruct (Rtotal_order v B) as [VB | [VB | VB]].
      * destruct (proj1 UVW) as [UV | UV]; [simple_roots 17%nat u v w F | double_first 21%nat u w F].
      * destruct (proj1 UVW) as [UV | UV]; [simple_roots 18%nat u v w F | double_first 22%nat u w F].
      * assert (UB : B <= u).
        { apply Rnot_lt_le; intro N; assert (0 < (B - u) * (v - B)) by (apply Rmult_lt_0_compat; lra); lra. }
        destruct UB as [UB | UB]; destruct (proj1 UVW) as [UV | UV]; destruct (proj2 UVW) as [VW | VW]; try lra.
        -- simple_roots 25%nat u v w F.
        -- double_last 28%nat u w F.
        -- double_first 26%nat u w F.
        -- listed 29%nat; exists u; split; [lra | intros l; rewrite F; subst; ring].
        -- simple_roots 24%nat u v w F.
        -- double_last 27%nat u w F.
    + destruct (proj1 UVW) as [UV | UV]; destruct (proj2 UVW) as [VW | VW].
      * simple_roots 16%nat u v w F.
      * double_last 19%nat u w F.
      * double_first 20%nat u w F.
      * listed 23%nat; exists u; split; [lra | intros l; rewrite F; subst; ring].
Qed.

(** ** What a pattern means. *)

Definition touches_at m := m <> 0 /\ - A <= m <= B /\ g A B P Q m = 0 /\ slope A B P Q m = 0
  /\ ~ (m = B /\ - c2 A B P Q - 2 * m < B).

Definition means (s : meaning) := match s with
  | ClearInside => inside A B P Q
  | ClearOutside => outside A B P Q
  | TouchesInside => exists m, m < 0 /\ touches_at m
  | TouchesOutside => exists m, 0 < m /\ touches_at m
  | Crosses => neither A B P Q /\ forall m, ~ touches_at m end.

Lemma vieta u v w : (forall l, g A B P Q l = (l - u) * (l - v) * (l - w)) ->
  c2 A B P Q = - (u + v + w) /\ c1 A B P Q = u * v + u * w + v * w.
Proof.
  intros F; assert (F0 := F 0); assert (F1 := F 1); assert (F2 := F (-1)); rewrite g_expanded in F0, F1, F2; lra.
Qed.

Lemma slope_of_roots u v w l : (forall l, g A B P Q l = (l - u) * (l - v) * (l - w)) ->
  slope A B P Q l = (l - u) * (l - v) + (l - u) * (l - w) + (l - v) * (l - w).
Proof. intros F; destruct (vieta u v w F) as [E2 E1]; unfold slope; rewrite E2, E1; ring. Qed.

Lemma double_is_two u v w m : (forall l, g A B P Q l = (l - u) * (l - v) * (l - w)) -> touches_at m ->
  (m = u /\ m = v) \/ (m = u /\ m = w) \/ (m = v /\ m = w).
Proof.
  intros F (_ & _ & G & S & _); rewrite F in G; rewrite (slope_of_roots u v w m F) in S.
  apply Rmult_integral in G; destruct G as [G | G]; [apply Rmult_integral in G; destruct G as [G | G] |].
  - rewrite G in S; assert (K : (m - v) * (m - w) = 0) by lra; apply Rmult_integral in K; lra.
  - rewrite G in S; assert (K : (m - u) * (m - w) = 0) by lra; apply Rmult_integral in K; lra.
  - rewrite G in S; assert (K : (m - u) * (m - v) = 0) by lra; apply Rmult_integral in K; lra.
Qed.

Lemma inside_between u v w : (forall l, g A B P Q l = (l - u) * (l - v) * (l - w)) ->
  - A <= u -> u < v -> v < 0 -> 0 < w -> inside A B P Q.
Proof.
  intros F; exists ((u + v) / 2); split; [lra |]; rewrite F.
  replace (((u + v) / 2 - u) * ((u + v) / 2 - v) * ((u + v) / 2 - w))
    with ((v - u) / 2 * ((v - u) / 2) * (w - (u + v) / 2)) by field.
  repeat apply Rmult_lt_0_compat; lra.
Qed.

Lemma outside_between u v w : (forall l, g A B P Q l = (l - u) * (l - v) * (l - w)) ->
  0 < u -> u < v -> v <= B -> v <= w -> outside A B P Q.
Proof.
  intros F; exists ((u + v) / 2); split; [lra |]; rewrite F.
  replace (((u + v) / 2 - u) * ((u + v) / 2 - v) * ((u + v) / 2 - w))
    with ((v - u) / 2 * ((v - u) / 2) * (w - (u + v) / 2)) by field.
  repeat apply Rmult_lt_0_compat; lra.
Qed.

Lemma never_positive u v w : (forall l, g A B P Q l = (l - u) * (l - v) * (l - w)) ->
  B <= w -> (u <= v /\ v <= - A) \/ (B <= u /\ B <= v) -> neither A B P Q.
Proof.
  intros F W C.
  assert (K : forall l, - A < l < B -> g A B P Q l <= 0).
  { intros l L; rewrite F; assert (0 <= (l - u) * (l - v) * (w - l)); [| lra].
    apply Rmult_le_pos; [| lra]; destruct C as [C | C]; [apply Rmult_le_pos; lra |].
    replace ((l - u) * (l - v)) with ((u - l) * (v - l)) by ring; apply Rmult_le_pos; lra. }
  split; intros (l & L & G); specialize (K l); lra.
Qed.

Lemma crosses u v w : (forall l, g A B P Q l = (l - u) * (l - v) * (l - w)) -> B <= w ->
  (u <= v /\ v <= - A /\ u < - A) \/ (B <= u /\ u <= v /\ v <= w /\ B < v /\ (u < v \/ B < u)) -> means Crosses.
Proof.
  intros F W C; split; [apply (never_positive u v w F W); lra |].
  intros m T; pose proof (double_is_two u v w m F T) as D; destruct T as (_ & M & _); lra.
Qed.

Lemma touches u w : (forall l, g A B P Q l = (l - u) * (l - u) * (l - w)) -> u <> 0 -> - A <= u <= B -> B <= w ->
  touches_at u.
Proof.
  intros F N U W; unfold touches_at; repeat split; try lra.
  - rewrite F; ring.
  - rewrite (slope_of_roots u u w u F); ring.
  - destruct (vieta u u w F) as [E _]; rewrite E; lra.
Qed.

Lemma crosses_once r m e : (forall l, g A B P Q l = (l - r) * ((l - m) ^ 2 + e)) -> 0 < e -> B <= r -> means Crosses.
Proof.
  intros F He R.
  assert (S : forall l, slope A B P Q l = (l - m) ^ 2 + e + 2 * (l - r) * (l - m)).
  { intros l; assert (F0 := F 0); assert (F1 := F 1); assert (F2 := F (-1)); rewrite g_expanded in F0, F1, F2.
    unfold slope; replace (c2 A B P Q) with (- (r + 2 * m)) by lra.
    replace (c1 A B P Q) with (m ^ 2 + e + 2 * r * m) by lra; ring. }
  assert (K : forall l, l < B -> g A B P Q l < 0).
  { intros l L; rewrite F; assert (0 < (r - l) * ((l - m) ^ 2 + e)); [| lra].
    apply Rmult_lt_0_compat; [lra | pose proof (pow2_ge_0 (l - m)); lra]. }
  split; [split; intros (l & L & G); specialize (K l); lra |].
  intros t (_ & _ & G & S0 & _); rewrite F in G; rewrite S in S0; pose proof (pow2_ge_0 (t - m)).
  apply Rmult_integral in G; destruct G as [G | G]; [rewrite G in S0 |]; lra.
Qed.

Theorem table_is_true r : In r table -> has_pattern (snd r) -> means (snd (fst r)).
Proof.
  simpl; intros I H; repeat (destruct I as [<- | I]; [cbv beta iota delta [has_pattern stands fst snd] in H |]); try contradiction;
    cbn [fst snd]; repeat match goal with H : exists _, _ |- _ => destruct H | H : _ /\ _ |- _ => destruct H end;
    match goal with
    | F : forall l, g A B P Q l = (l - ?r) * ((l - ?m) ^ 2 + ?e) |- _ => apply (crosses_once r m e F); lra
    | F : forall l, g A B P Q l = (l - ?u) * (l - ?v) * (l - ?w) |- _ => first
      [ apply (inside_between u v w F); lra
      | apply (outside_between u v w F); lra
      | apply (crosses u v w F); lra
      | exists u; split; [lra | apply (touches u w F); lra] ] end.
Qed.

End Table.

(** ** Every row of the table occurs. *)

Ltac witness := repeat match goal with |- exists _, _ => eexists end.

Theorem every_row_occurs r : In r table ->
  exists A B P Q, 0 < A /\ 0 < B /\ 0 <= P /\ 0 <= Q /\ has_pattern A B P Q (snd r).
Proof.
  Ltac numbers A B P Q := exists A, B, P, Q; do 4 (split; [lra |]); simpl.
  Ltac found := repeat split; try lra; intros l; unfold g; field.
  simpl; intros I; repeat (destruct I as [<- | I]; [simpl |]); try contradiction.
  - numbers 3 1 (1/2) 0; exists (-2), (-3/2), 1; found.
  - numbers 4 2 2 2; exists (-2), (-1), 4; found.
  - numbers 2 1 0 0; exists (-2), (-1), 1; found.
  - numbers 1 (1/2) 0 1; exists (-1), (-1/2), 1; found.
  - numbers 4 1 1 0; exists (-2), 1; found.
  - numbers 1 (1/2) (1/2) 2; exists (-1/2), 2; found.
  - numbers 1 1 0 0; exists (-1), 1; found.
  - numbers (1/2) (1/2) 0 1; exists (-1/2), 1; found.
  - numbers (1/3) 1 (1/6) 0; exists (-2/3), (-1/2), 1; found.
  - numbers (1/4) (1/2) (1/9) (5/9); exists (-1/2), (-1/3), (3/4); found.
  - numbers (1/2) 1 0 0; exists (-1), (-1/2), 1; found.
  - numbers (1/3) (1/2) 0 1; exists (-1/2), (-1/3), 1; found.
  - numbers (1/4) 1 (1/4) 0; exists (-1/2), 1; found.
  - numbers (1/3) (1/2) (1/10) (2/5); exists (-1/2), (2/3); found.
  - numbers 1 1 2 0; exists 1, 0, 1; found.
  - numbers 1 (1/2) 2 (1/2); exists 1, 0, (1/2); found.
  - numbers (1/2) 2 3 0; exists (1/2), 1, 2; found.
  - numbers 1 2 5 (1/2); exists (1/2), 1, 4; found.
  - numbers (2/3) 1 4 0; exists (1/3), 1, 2; found.
  - numbers (1/2) 1 3 0; exists (1/2), 1; found.
  - numbers 1 2 4 0; exists 1, 2; found.
  - numbers (1/4) (1/2) 3 (1/4); exists (1/4), 2; found.
  - numbers (1/2) (1/2) 3 0; exists (1/2), 1; found.
  - numbers 1 1 4 0; exists 1; found.
  - numbers (1/2) (1/3) 3 0; exists (1/3), (1/2), 1; found.
  - numbers 3 (1/3) 7 (1/6); exists (1/2), 1, 2; found.
  - numbers 5 (1/3) 9 (1/3); exists 1, (5/3); found.
  - numbers 1 (1/2) 4 0; exists (1/2), 1; found.
  - numbers (3/4) (1/4) (13/4) (1/12); exists (1/3), (3/4); found.
  - numbers (1/2) (1/4) (8/3) (1/12); exists (1/2); found.
Qed.

(** ** The meanings, said of the bodies: this is the table's column of positions. *)

Definition body_means p (s : meaning) := match s with
  | ClearInside => interior p
  | ClearOutside => exterior p
  | TouchesInside => tangent_inside p
  | TouchesOutside => tangent_outside p
  | Crosses => exists X Y, in_spheroid p X /\ in_spheroid p Y /\ height p X < 0 < height p Y end.

Theorem meaning_of_bodies alpha gamma b d x y z r : 0 < alpha -> 0 < gamma -> 0 < b -> 0 < d -> In r table ->
  has_pattern ((alpha / b) ^ 2) ((gamma / d) ^ 2) ((x ^ 2 + y ^ 2) / b ^ 2) ((z / d) ^ 2) (snd r) ->
  body_means (upright alpha gamma b d x y z) (snd (fst r)).
Proof.
  intros Ha Hg Hb Hd I H; pose proof (positions_by_g alpha gamma b d x y z Ha Hg Hb Hd) as (E1 & E2 & E3).
  apply table_is_true in H; try assumption.
  2: { apply A_pos; assumption. }
  2: { apply B_pos; assumption. }
  clear I; destruct (snd (fst r)); simpl in *.
  - apply E2; assumption.
  - destruct H as (m & M & N & R & G & S & K).
    apply (tangent_by_double_root alpha gamma b d x y z Ha Hg Hb Hd m N R G S K); assumption.
  - destruct H as [N T]; apply E3 in N.
    destruct (contact_has_certificate alpha gamma b d x y z Ha Hg Hb Hd N)
      as [(X & Y & _ & _ & DX & DY & HXY) | (m & M)]; [exists X, Y; auto | destruct (T m M)].
  - destruct H as (m & M & N & R & G & S & K).
    apply (tangent_by_double_root alpha gamma b d x y z Ha Hg Hb Hd m N R G S K); assumption.
  - apply E1; assumption.
Qed.
