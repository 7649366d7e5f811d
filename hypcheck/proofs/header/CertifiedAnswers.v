(** Stage 2: what the text of hc_certified returns is the position, for each row whose bit says that it is decided.

    Of the floats it is assumed what StageTwoRuns.v assumes, for the steps and comparisons of each row: those of the row i are in the turn
    of the loop that begins with i - i mod width, and its truths in the bit i mod width. *)

Require Import List String ZArith Reals Lia Bool.
From Hypcheck Require Import Geometry Positions Ranges Steps Trees FloatTexts CertifiedText.
From Hypcheck Require StageTwoRuns.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** The answer that three bits say, 0 or 1 as true or false. *)
Definition said (plus minus decided : bool) : option answer :=
  if decided then if plus then Some Exterior else if minus then Some Interior else Some Contact else None.

(** What the floats of a row are: they are rounded, compared and guarded as the steps say, and begin with the row's own numbers. *)
Definition runs_on (x pre : string -> R) (holds : string -> Prop) :=
  Forall (runs StageTwoRuns.multiplied x pre) C_certified /\ Forall (compares x holds) C_certified
  /\ (forall n v, In (n, v) StageTwoRuns.constants -> x n = v) /\ (forall n, In n (inputs ++ map fst StageTwoRuns.constants) -> pre n = x n).
Definition body_of (x : string -> R) := upright (x "alpha") (x "gamma") (x "b") (x "d") (x "x") (x "y") (x "z").

Lemma said_is_right x pre holds plus minus decided : runs_on x pre holds -> (plus = true <-> holds "exterior") -> (minus = true <-> holds "interior") ->
  (decided = true <-> holds "decided") -> (decided = true -> plus && minus = false) /\ forall a, said plus minus decided = Some a -> is_position (body_of x) a.
Proof.
  intros (R & C & K & I) P M D; unfold said.
  assert (X : holds "exterior" -> exterior (body_of x)) by (intros H; exact (StageTwoRuns.exterior_is_right x pre holds R C K I H)).
  assert (Y : holds "interior" -> interior (body_of x)) by (intros H; exact (StageTwoRuns.interior_is_right x pre holds R C K I H)).
  pose proof (positions_exclude_each_other (body_of x)) as Z.
  assert (N : plus && minus = false) by (destruct plus, minus; try reflexivity; exfalso; specialize (X (proj1 P eq_refl)); specialize (Y (proj1 M eq_refl)); tauto).
  split; [auto |]; destruct decided; [| discriminate]; intros a E.
  destruct (StageTwoRuns.decided_is_right x pre holds R C K I (proj1 D eq_refl)) as [[H _] | [[H _] | [_ H]]].
  - rewrite (proj2 P H) in E; injection E as <-; exact (X H).
  - rewrite (proj2 M H) in *; destruct plus; [discriminate N |]; injection E as <-; exact (Y H).
  - destruct plus; [exfalso; specialize (X (proj1 P eq_refl)); unfold body_of in *; tauto |].
    destruct minus; [exfalso; specialize (Y (proj1 M eq_refl)); unfold body_of in *; tauto |]; injection E as <-; exact H.
Qed.

Section Rows.

Variables (mask : Z -> string -> Z) (width count stride : Z).
Hypotheses (Width : 1 <= width <= 64) (Count : 0 <= count <= 64) (Stride : count <= stride < 2 ^ 60) (Masks : forall at_ n, 0 <= mask at_ n < 2 ^ width).

Lemma row_bit v t i : 0 <= i < count -> all_bits mask width count v t -> Z.testbit v i = bit_of mask width t i.
Proof.
  intros I A; rewrite (A i) by lia; replace (i <? 64) with true by (symmetry; apply Z.ltb_lt; lia); rewrite andb_true_r.
  replace (i <? behind_all width count) with true; [reflexivity |]; symmetry; apply Z.ltb_lt; unfold behind_all.
  pose proof (Z.mul_succ_div_gt (count + width - 1) width ltac:(lia)); lia.
Qed.

(** **Rows by vectors**: each row that is decided has its position in the bits. *)
Theorem rows_are_right : exists p m d, bits_of_struct (text_of_certified mask width count stride) = Some (p, m, d) /\
  forall i x pre, 0 <= i < count -> runs_on x pre (fun t => bit_of mask width t i = true) ->
    forall a, said (Z.testbit p i) (Z.testbit m i) (Z.testbit d i) = Some a -> is_position (body_of x) a.
Proof.
  destruct (certified_text mask width count stride Width Count Stride Masks) as (p & m & d & E & P & M & D); exists p, m, d; split; [exact E |].
  intros i x pre I R; apply (said_is_right x pre (fun t => bit_of mask width t i = true)); [exact R | | |].
  - rewrite (row_bit p "exterior" i I P); reflexivity.
  - rewrite (row_bit m "interior" i I M); reflexivity.
  - rewrite (row_bit d "decided" i I D); reflexivity.
Qed.

End Rows.

(** One row: the bits are numbers, 1 or 0. *)
Section Row.
Variable mask : Z -> string -> Z.
Hypothesis Masks : forall at_ n, 0 <= mask at_ n < 2 ^ 1.
Definition holds_in_row t := mask 0 t = 1.

Lemma one_bit v t : all_bits mask 1 1 v t -> v = mask 0 t.
Proof.
  intros A; apply Z.bits_inj'; intros i I; rewrite (A i I); unfold bit_of.
  destruct (Z.eq_dec i 0) as [-> | N]; [reflexivity |]; assert (B : (i <? behind_all 1 1) = false) by (apply Z.ltb_ge; change (behind_all 1 1) with 1; lia).
  rewrite B; cbn [andb]; rewrite <- (Z.mod_small (mask 0 t) (2 ^ 1)) by apply Masks; symmetry; apply Z.mod_pow2_bits_high; lia.
Qed.

Theorem row_is_right : exists p m d, bits_of_struct (text_of_certified mask 1 1 1) = Some (p, m, d) /\ 0 <= p < 2 /\ 0 <= m < 2 /\ 0 <= d < 2 /\
  forall x pre, runs_on x pre holds_in_row -> (d = 1 -> p = 0 \/ m = 0) /\ forall a, said (p =? 1) (m =? 1) (d =? 1) = Some a -> is_position (body_of x) a.
Proof.
  destruct (certified_text mask 1 1 1 ltac:(lia) ltac:(lia) ltac:(lia) Masks) as (p & m & d & E & P & M & D); apply one_bit in P, M, D.
  exists p, m, d; split; [exact E |]; subst p m d; repeat split; try apply Masks; [| intros a].
  - intros D; destruct (said_is_right x pre holds_in_row (mask 0 "exterior" =? 1) (mask 0 "interior" =? 1) (mask 0 "decided" =? 1)) as [N _]; try (apply Z.eqb_eq); [assumption |].
    rewrite D in N; specialize (N eq_refl); pose proof (Masks 0 "exterior"); pose proof (Masks 0 "interior"); apply andb_false_iff in N; rewrite !Z.eqb_neq in N; lia.
  - apply (said_is_right x pre holds_in_row); try (apply Z.eqb_eq); assumption.
Qed.
End Row.
