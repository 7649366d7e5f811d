(** Stage 4: the whole numbers of the C fit their words, and what it compares proves a tangency, or the position in the waist's plane.

    A number of w bits is its pattern, from 0 to 2^w; what may be negative is in two's complement. [intervals] computes for each step
    that Coq reads in the C what its exact value can be, and refuses a product of unsigned words for what may be negative, a sum of
    numbers of two widths, and what does not fit. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Hypcheck Require Import Geometry Positions Tangency Stages Steps FixedRuns.
Import ListNotations.
Open Scope string_scope.
Open Scope list_scope.
Open Scope Z_scope.

Inductive call := Sum | Difference | Wrapped | Whole | Signed.

(** What a word of C does, and the bits of its arguments. *)
Definition calls := [("add", (Sum, 64)); ("sub", (Difference, 64)); ("mul", (Wrapped, 64));
  ("hc_fixed_plus", (Sum, 128)); ("hc_fixed_minus", (Difference, 128)); ("hc_fixed_full", (Whole, 64)); ("hc_fixed_full_signed", (Signed, 64));
  ("hc_long_plus", (Sum, 256)); ("hc_long_minus", (Difference, 256)); ("hc_long_product", (Whole, 128)); ("hc_long_signed_product", (Signed, 128))].

Section Run.

(** Patterns, exact values, and the choice between two sides. *)
Variables (num v : string -> Z) (inner : bool).

Definition runs (s : step) : Prop := let n := name s in match look (operation s) calls, arguments s with
  | Some (Sum, w), [Name a; Name c] => num n = (num a + num c) mod 2 ^ w /\ v n = v a + v c
  | Some (Difference, w), [Name a; Name c] => num n = (num a - num c) mod 2 ^ w /\ v n = v a - v c
  | Some (Wrapped, w), [Name a; Name c] => num n = (num a * num c) mod 2 ^ w /\ v n = v a * v c
  | Some (Whole, w), [Name a; Name c] => num n = num a * num c /\ v n = v a * v c
  | Some (Signed, w), [Name a; Name c] =>
    num n = (num a * num c - (if 2 ^ (w - 1) <=? num a then num c * 2 ^ w else 0)) mod 2 ^ (2 * w) /\ v n = v a * v c
  | None, [Name side; Name a; Name c] =>
    num n = (if inner then num a else num c) /\ v n = (if inner then v a else v c) /\ operation s = "select" /\ side = "inner"
  | None, [Name a; Number 0] => operation s = "lt" /\ n = "inner" /\ a = "about"
  | _, _ => False end.

(** The bits of a number, its least and its greatest value. *)
Record interval := Interval { bits : Z; least : Z; most : Z }.
Definition fit i := (0 <? bits i) && if 0 <=? least i then most i <? 2 ^ bits i
  else (- 2 ^ (bits i - 1) <=? least i) && (most i <? 2 ^ (bits i - 1)).
Definition signed i := (0 <? bits i) && (- 2 ^ (bits i - 1) <=? least i) && (most i <? 2 ^ (bits i - 1)).
Definition products w i j := Interval w (Z.min (Z.min (least i * least j) (least i * most j)) (Z.min (most i * least j) (most i * most j)))
  (Z.max (Z.max (least i * least j) (least i * most j)) (Z.max (most i * least j) (most i * most j))).

Definition interval_of known (s : step) : option interval := match look (operation s) calls, arguments s with
  | Some (c, w), [Name a; Name e] => match look a known, look e known with
    | Some i, Some j => if (bits i =? w) && (bits j =? w) then match c with
      | Sum => Some (Interval w (least i + least j) (most i + most j))
      | Difference => Some (Interval w (least i - most j) (most i - least j))
      | Wrapped => Some (products w i j)
      | Whole => if (0 <=? least i) && (0 <=? least j) then Some (products (2 * w) i j) else None
      | Signed => if (least i <? 0) && signed i && (0 <=? least j) then Some (products (2 * w) i j) else None end else None
    | _, _ => None end
  | None, [Name _; Name a; Name e] => match look a known, look e known with
    | Some i, Some j => if bits i =? bits j then Some (Interval (bits i) (Z.min (least i) (least j)) (Z.max (most i) (most j))) else None
    | _, _ => None end
  | _, _ => None end.

Fixpoint intervals known (l : list step) : option (list (string * interval)) := match l with
  | [] => Some known
  | s :: rest => if String.eqb (operation s) "lt" then intervals known rest else match interval_of known s with
    | Some i => if fit i then intervals ((name s, i) :: known) rest else None | None => None end end.

Definition holds n i := num n = v n mod 2 ^ bits i /\ least i <= v n <= most i /\ fit i = true.
Definition all_hold known := forall n i, look n known = Some i -> holds n i.

Lemma products_hold w i j x y : least i <= x <= most i -> least j <= y <= most j ->
  least (products w i j) <= x * y <= most (products w i j).
Proof.
  intros X Y; unfold products; cbn [least most].
  assert (L : forall a c d z, a <= z <= c -> Z.min (a * d) (c * d) <= z * d <= Z.max (a * d) (c * d)).
  { intros a c d z Z; destruct (Z.le_gt_cases 0 d); [assert (a * d <= z * d <= c * d) by nia | assert (c * d <= z * d <= a * d) by nia]; lia. }
  pose proof (L _ _ y x X); pose proof (L _ _ (least i) y Y); pose proof (L _ _ (most i) y Y); lia.
Qed.

Lemma fit_unsigned i : fit i = true -> 0 <= least i -> most i < 2 ^ bits i.
Proof.
  unfold fit; intros F L; apply andb_prop in F as [_ F]; destruct (Z.leb_spec 0 (least i)); [apply Z.ltb_lt; exact F | lia].
Qed.

Lemma unsigned_pattern n i : holds n i -> 0 <= least i -> num n = v n.
Proof.
  intros (E & I & F) L; rewrite E; apply Z.mod_small; pose proof (fit_unsigned i F L); lia.
Qed.

Lemma step_holds known s i : all_hold known -> runs s -> interval_of known s = Some i -> fit i = true -> holds (name s) i.
Proof.
  intros K R E F; unfold runs, interval_of in *.
  destruct (look (operation s) calls) as [[c w] |].
  - destruct (arguments s) as [| [a |] [| [e |] [|]]]; try discriminate.
    destruct (look a known) as [p |] eqn:A; [| discriminate]; destruct (look e known) as [q |] eqn:C; [| discriminate].
    apply K in A; apply K in C; destruct ((bits p =? w) && (bits q =? w)) eqn:B; [| discriminate].
    apply andb_prop in B as [B1 B2]; apply Z.eqb_eq in B1; apply Z.eqb_eq in B2; subst w.
    pose proof A as (NA & IA & FA); pose proof C as (NC & IC & FC); rewrite B2 in NC.
    assert (W0 : 2 ^ bits p <> 0) by (apply Z.pow_nonzero; [lia |]; unfold fit in FA; apply andb_prop in FA as [FA _]; apply Z.ltb_lt in FA; lia).
    destruct c; [| | | destruct ((0 <=? least p) && (0 <=? least q)) eqn:S; [| discriminate]
      | destruct ((least p <? 0) && signed p && (0 <=? least q)) eqn:S; [| discriminate]];
      injection E as <-; destruct R as [RN RV]; unfold holds; rewrite RN, RV.
    + cbn [bits least most]; rewrite NA, NC, <- Z.add_mod by exact W0; repeat split; try exact F; lia.
    + cbn [bits least most]; rewrite NA, NC, <- Zminus_mod; repeat split; try exact F; lia.
    + change (bits (products (bits p) p q)) with (bits p); rewrite NA, NC, <- Z.mul_mod by exact W0; repeat split; try exact F; apply (products_hold (bits p) p q); assumption.
    + change (bits (products (2 * bits p) p q)) with (2 * bits p); apply andb_prop in S as [S1 S2]; apply Z.leb_le in S1; apply Z.leb_le in S2.
      rewrite (unsigned_pattern a p A S1), (unsigned_pattern e q C S2).
      pose proof (products_hold (2 * bits p) p q _ _ IA IC) as PH; split; [| split; [exact PH | exact F]].
      symmetry; apply Z.mod_small; assert (L : 0 <= least (products (2 * bits p) p q)).
      { unfold products; cbn [least]; repeat apply Z.min_glb; apply Z.mul_nonneg_nonneg; lia. }
      split; [apply Z.le_trans with (1 := L); apply PH | apply Z.le_lt_trans with (1 := proj2 PH); exact (fit_unsigned _ F L)].
    + change (bits (products (2 * bits p) p q)) with (2 * bits p); apply andb_prop in S as [S S2]; apply andb_prop in S as [S0 S1];
        apply Z.leb_le in S2.
      pose proof (products_hold (2 * bits p) p q _ _ IA IC) as PH; split; [| split; [exact PH | exact F]].
      rewrite (unsigned_pattern e q C S2); unfold signed in S1.
      apply andb_prop in S1 as [S1 S3]; apply andb_prop in S1 as [P0 S1]; apply Z.leb_le in S1; apply Z.ltb_lt in S3; apply Z.ltb_lt in P0.
      assert (H : 2 ^ bits p = 2 * 2 ^ (bits p - 1)) by (rewrite <- Z.pow_succ_r by lia; f_equal; lia).
      assert (HH : 2 ^ (2 * bits p) = 2 ^ bits p * 2 ^ bits p) by (rewrite <- Z.pow_add_r by lia; f_equal; lia).
      assert (PP : 0 < 2 ^ (bits p - 1)) by (apply Z.pow_pos_nonneg; lia).
      destruct (Z.lt_ge_cases (v a) 0) as [N | N].
      * assert (NA' : num a = v a + 2 ^ bits p) by (rewrite NA; symmetry; apply Z.mod_unique with (-1); [left | ring]; lia).
        rewrite NA'; destruct (Z.leb_spec (2 ^ (bits p - 1)) (v a + 2 ^ bits p)); [| lia]; f_equal; ring.
      * assert (NA' : num a = v a) by (rewrite NA; apply Z.mod_small; lia).
        rewrite NA'; destruct (Z.leb_spec (2 ^ (bits p - 1)) (v a)); [lia |]; f_equal; ring.
  - destruct (arguments s) as [| [side |] [| [a |] [| [e |] [|]]]]; try discriminate.
    destruct (look a known) as [p |] eqn:A; [| discriminate]; destruct (look e known) as [q |] eqn:C; [| discriminate].
    apply K in A as (NA & IA & FA); apply K in C as (NC & IC & FC); destruct (Z.eqb_spec (bits p) (bits q)) as [B |]; [| discriminate].
    injection E as <-; destruct R as (RN & RV & _); unfold holds; rewrite RN, RV; cbn [bits least most].
    destruct inner; repeat split; try exact F; try exact NA; try (rewrite B; exact NC); lia.
Qed.

Theorem intervals_hold l : forall known found, all_hold known -> Forall runs l -> intervals known l = Some found -> all_hold found.
Proof.
  induction l as [| s l IH]; cbn [intervals]; intros known found K R E; [injection E as <-; exact K |].
  inversion R; subst; destruct (String.eqb (operation s) "lt"); [apply (IH known); assumption |].
  destruct (interval_of known s) as [i |] eqn:G; [| discriminate]; destruct (fit i) eqn:F; [| discriminate].
  apply (IH ((name s, i) :: known)); try assumption.
  intros n q L; cbn [look] in L; destruct (String.eqb_spec (name s) n) as [<- | N]; [injection L as <- | apply K; exact L].
  apply step_holds with known; assumption.
Qed.

(** What C asks of a number: whether all its words are 0, and its highest bit. *)
Definition is_0 n := num n = 0.
Definition is_negative n i := 2 ^ (bits i - 1) <= num n.

Lemma asked n i : holds n i -> signed i = true -> (is_0 n <-> v n = 0) /\ (is_negative n i <-> v n < 0).
Proof.
  intros (E & I & _) S; unfold signed, is_0, is_negative in *.
  apply andb_prop in S as [S S3]; apply andb_prop in S as [P0 S1]; apply Z.leb_le in S1; apply Z.ltb_lt in S3; apply Z.ltb_lt in P0.
  assert (H : 2 ^ bits i = 2 * 2 ^ (bits i - 1)) by (rewrite <- Z.pow_succ_r by lia; f_equal; lia).
  destruct (Z.lt_ge_cases (v n) 0) as [N | N].
  - assert (X : num n = v n + 2 ^ bits i) by (rewrite E; symmetry; apply Z.mod_unique with (-1); [left | ring]; lia); lia.
  - assert (X : num n = v n) by (rewrite E; apply Z.mod_small; lia); lia.
Qed.

End Run.

(** ** The steps of the C. *)

Definition C_tangency := Eval vm_compute in part 5 ++ part 6 ++ part 7.
Definition C_short := Eval vm_compute in part 8 ++ part 9.
Definition C_waist := Eval vm_compute in part 10 ++ part 11 ++ part 12.
Theorem steps_are_read : C_tangency ++ C_short ++ C_waist = flat_map part [5; 6; 7; 8; 9; 10; 11; 12]%nat.
Proof. vm_compute; reflexivity. Qed.

Definition lengths w := map (fun n => (n, Interval 64 0 (2 ^ w - 1))) ["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"].
Definition long_inputs := ("M", Interval 128 0 (2 ^ 126 - 1)) :: ("e", Interval 128 0 (2 ^ 126 - 1)) :: lengths 62.
Definition short_inputs := ("M", Interval 64 0 (2 ^ 46)) :: ("e", Interval 64 0 (2 ^ 46)) :: lengths 23.
Definition waist_inputs := ("size", Interval 128 0 (2 ^ 126 - 1)) :: lengths 62.

(** Every number fits, and what is compared with 0 has a sign and so many bits. *)
Definition all_fit inputs l asked bits_of := match intervals inputs l with
  | Some known => forallb (fun n => match look n known with Some i => signed i && (bits i =? bits_of n) | None => false end) asked
  | None => false end.

Definition twice_M inputs := Z.mul 2 (match look "M" inputs with Some i => bits i | None => 0 end).
Definition bits_of n := if existsb (String.eqb n) ["excess"; "room"] then 256 else 128.

Definition of_tangency := ["r1"; "r2"; "r3"; "room_within"; "beyond"; "room_without"].
Definition of_waist := ["W"; "opposite"; "excess"; "W_p_2"; "room"].

Theorem widths_suffice : all_fit long_inputs C_tangency of_tangency (fun _ => twice_M long_inputs) = true
  /\ all_fit short_inputs C_short of_tangency (fun _ => twice_M short_inputs) = true
  /\ all_fit waist_inputs C_waist of_waist bits_of = true.
Proof. vm_compute; repeat split; reflexivity. Qed.

(** ** What the comparisons say. *)

Section Touch.

Variables (num v : string -> Z) (inner : bool) (inputs : list (string * interval)) (l : list step).
Hypotheses (Steps : (inputs = long_inputs /\ l = C_tangency) \/ (inputs = short_inputs /\ l = C_short))
  (Inputs : all_hold num v inputs) (Runs : Forall (runs num v inner) l).
Hypotheses (Ia : 0 < v "alpha") (Ig : 0 < v "gamma") (Ib : 0 < v "b") (Id : 0 < v "d").

(** The bits of the numbers that C compares with 0. *)
Let wide := twice_M inputs.
Let not_negative n := ~ 2 ^ (wide - 1) <= num n.

Lemma compared n : In n of_tangency -> (is_0 num n <-> v n = 0) /\ (not_negative n <-> 0 <= v n).
Proof.
  intros I; assert (A : all_fit inputs l of_tangency (fun _ => twice_M inputs) = true)
    by (destruct widths_suffice as (W1 & W2 & _); destruct Steps as [[-> ->] | [-> ->]]; assumption).
  unfold all_fit in A; destruct (intervals inputs l) as [known |] eqn:K; [| discriminate].
  pose proof (intervals_hold num v inner l inputs known Inputs Runs K) as H; rewrite forallb_forall in A; specialize (A n I).
  destruct (look n known) as [i |] eqn:L; [| discriminate]; apply andb_prop in A as [A B]; apply Z.eqb_eq in B; fold wide in B.
  destruct (asked num v n i (H n i L) A) as [Z N]; split; [exact Z |].
  unfold not_negative, is_negative in *; rewrite B in N; lia.
Qed.

Let step_in n s : find (fun s => String.eqb (name s) n) l = Some s -> runs num v inner s.
Proof. intros E; apply (proj1 (Forall_forall _ _) Runs); apply (find_some _ _ E). Qed.

Ltac exact_value n := let H := fresh "E" in
  match goal with Q : l = ?k |- _ => let s := eval vm_compute in (find (fun s => String.eqb (name s) n) k) in match s with Some ?t =>
    assert (H : runs num v inner t) by (apply (step_in n); rewrite Q; vm_compute; reflexivity) end end;
  cbv [runs calls look arguments operation name String.eqb Ascii.eqb Bool.eqb] in H; apply proj2 in H; try apply proj1 in H;
  apply (f_equal IZR) in H; rewrite ?plus_IZR, ?minus_IZR, ?mult_IZR in H.

(** The lengths in two units. *)
Variables u w : R.
Hypotheses (U : (0 < u)%R) (V : (0 < w)%R).

Open Scope R_scope.
Let I n := IZR (v n).
Let alpha := I "alpha" * u.
Let gamma := I "gamma" * w.
Let b := I "b" * u.
Let d := I "d" * w.
Let x := I "x" * u.
Let y := I "y" * u.
Let z := I "z" * w.
Let side := if inner then - 1 else 1.
Let M := side * I "M" * (u * w).
Let e := side * I "e" * (u * w).

Lemma residuals : I "r1" = I "b" * I "d" * (I "alpha" * I "gamma") - I "M" * I "e"
  /\ (u * w) ^ 2 * I "r2" = n2_of alpha gamma b d x y z + 2 * (b * d) * M + e ^ 2
  /\ (u * w) ^ 2 * I "r3" = M ^ 2 + 2 * (alpha * gamma) * e - n1_of alpha gamma b d x y z
  /\ I "room_within" = I "alpha" ^ 2 * (I "b" * I "d") - I "M" * I "b" ^ 2
  /\ I "beyond" = I "e" ^ 2 - I "b" * I "d" * I "M"
  /\ I "room_without" = I "gamma" ^ 2 * (I "b" * I "d") - I "M" * I "d" ^ 2.
Proof.
  assert (S2 : side ^ 2 = 1) by (unfold side; destruct inner; ring).
  destruct Steps as [[_ L] | [_ L]].
  all: exact_value "p"; exact_value "q"; exact_value "s"; exact_value "t"; exact_value "xx"; exact_value "yy"; exact_value "R"; exact_value "S";
    exact_value "p_plus_q"; exact_value "p_q_R"; exact_value "s_plus_S"; exact_value "radial_2"; exact_value "axial_2"; exact_value "n2";
    exact_value "t_minus_s"; exact_value "t_s_S"; exact_value "R_minus_q"; exact_value "axial_1"; exact_value "radial_1"; exact_value "n1";
    exact_value "D"; exact_value "K"; exact_value "D_K"; exact_value "M_e"; exact_value "e_e"; exact_value "D_M"; exact_value "r1";
    exact_value "n2_e_e"; exact_value "D_M_2"; exact_value "r2_outer"; exact_value "r2_inner"; exact_value "r2";
    exact_value "K_e"; exact_value "M_M"; exact_value "M_M_n1"; exact_value "K_e_2"; exact_value "r3_outer"; exact_value "r3_inner"; exact_value "r3";
    exact_value "p_D"; exact_value "M_q"; exact_value "room_within"; exact_value "beyond"; exact_value "s_D"; exact_value "M_t";
    exact_value "room_without"; clear L; unfold n2_of, n1_of, alpha, gamma, b, d, x, y, z, M, e, side, I in *; clear S2; destruct inner;
    repeat match goal with H : IZR (v _) = _ |- _ => rewrite ?H; clear H end; repeat split; ring.
Qed.

Hypotheses (Z1 : is_0 num "r1") (Z2 : is_0 num "r2") (Z3 : is_0 num "r3") (Room : if inner then not_negative "room_within"
  else not_negative "beyond" /\ not_negative "room_without").

Let zero n : In n of_tangency -> is_0 num n -> I n = 0.
Proof. intros IN Z; unfold I; apply (f_equal IZR), (compared n IN), Z. Qed.
Let room n : In n of_tangency -> not_negative n -> 0 <= I n.
Proof. intros IN Z; unfold I; apply (IZR_le 0), (compared n IN), Z. Qed.

(** The row touches: what the stage answers where no coordinate is a hair, and what its answer for a hair rests on. *)
Theorem proved_tangency : if inner
  then tangency_equations alpha gamma b d x y z M e /\ M < 0 /\ - M * b ^ 2 <= alpha ^ 2 * (b * d)
  else tangency_equations alpha gamma b d x y z M e /\ 0 < M /\ b * d * M <= e ^ 2 /\ M * d ^ 2 <= gamma ^ 2 * (b * d).
Proof.
  destruct residuals as (R1 & R2 & R3 & R4 & R5 & R6).
  assert (in_list : forall n, existsb (String.eqb n) of_tangency = true -> In n of_tangency)
    by (intros n H; apply existsb_exists in H; destruct H as (k & IN & E); apply String.eqb_eq in E; subst k; exact IN).
  rewrite (zero "r1") in R1; [| apply in_list; reflexivity | exact Z1].
  rewrite (zero "r2"), Rmult_0_r in R2; [| apply in_list; reflexivity | exact Z2].
  rewrite (zero "r3"), Rmult_0_r in R3; [| apply in_list; reflexivity | exact Z3].
  assert (P : 0 < I "alpha" /\ 0 < I "gamma" /\ 0 < I "b" /\ 0 < I "d") by (unfold I; repeat split; apply IZR_lt; assumption).
  destruct P as (Pa & Pg & Pb & Pd); assert (UW : 0 < u * w) by (apply Rmult_lt_0_compat; assumption).
  assert (M0 : 0 < I "M").
  { assert (ML : 0 <= I "M").
    { assert (H : exists i, look "M" inputs = Some i /\ (0 <= least i)%Z)
        by (destruct Steps as [[-> _] | [-> _]]; eexists; split; [reflexivity | cbn; lia | reflexivity | cbn; lia]).
      destruct H as (i & HL & HM); apply Inputs in HL; destruct HL as (_ & HI & _); unfold I; apply (IZR_le 0); lia. }
    destruct ML as [ML | ML]; [exact ML |]; rewrite <- ML in R1.
    assert (0 < I "b" * I "d" * (I "alpha" * I "gamma")) by (repeat apply Rmult_lt_0_compat; assumption); lra. }
  assert (E : tangency_equations alpha gamma b d x y z M e).
  { unfold tangency_equations; repeat split; [| lra | lra]; unfold M, e, alpha, gamma, b, d.
    assert (S2 : side * side = 1) by (unfold side; destruct inner; ring).
    transitivity (side * side * (I "M" * I "e") * (u * w) ^ 2); [ring |]; rewrite S2; replace (I "M" * I "e") with (I "b" * I "d" * (I "alpha" * I "gamma")) by lra; ring. }
  assert (MUW : 0 < I "M" * (u * w)) by (apply Rmult_lt_0_compat; assumption).
  clear R1 R2 R3; revert Room E; unfold M, side; destruct inner; intros Room E.
  - pose proof (room "room_within" ltac:(apply in_list; reflexivity) Room) as RW; rewrite R4 in RW.
    split; [exact E |]; split; [lra |]; unfold alpha, b, d.
    assert (K : 0 <= (I "alpha" ^ 2 * (I "b" * I "d") - I "M" * I "b" ^ 2) * (u ^ 2 * (u * w)))
      by (apply Rmult_le_pos; [exact RW | apply Rmult_le_pos; [apply pow2_ge_0 | lra]]); lra.
  - destruct Room as [B W]; pose proof (room "beyond" ltac:(apply in_list; reflexivity) B) as RB; rewrite R5 in RB.
    pose proof (room "room_without" ltac:(apply in_list; reflexivity) W) as RW; rewrite R6 in RW.
    split; [exact E |]; split; [lra |]; unfold gamma, b, d, e, side.
    assert (K1 : 0 <= (I "e" ^ 2 - I "b" * I "d" * I "M") * (u * w) ^ 2) by (apply Rmult_le_pos; [exact RB | apply pow2_ge_0]).
    assert (K2 : 0 <= (I "gamma" ^ 2 * (I "b" * I "d") - I "M" * I "d" ^ 2) * (w ^ 2 * (u * w)))
      by (apply Rmult_le_pos; [exact RW | apply Rmult_le_pos; [apply pow2_ge_0 | lra]]); split; lra.
Qed.

Theorem touching_row_is_contact : answers alpha gamma b d x y z Contact.
Proof.
  pose proof proved_tangency as T; destruct inner; [apply touching_within with M e | apply touching_without with M e]; exact T.
Qed.

End Touch.

Section Waist.

Variables (num v : string -> Z) (inner : bool).
Hypotheses (Inputs : all_hold num v waist_inputs) (Runs : Forall (runs num v inner) C_waist).
Hypotheses (Ia : 0 < v "alpha") (Ig : 0 < v "gamma") (Ib : 0 < v "b") (Id : 0 < v "d").
(** C takes the one of W and -W that is not negative. *)
Hypothesis Size : v "size" = Z.abs (v "W").

Let negative n w := 2 ^ (w - 1) <= num n.

Lemma waist_compared n : In n of_waist -> (negative n (bits_of n) <-> v n < 0).
Proof.
  intros I; assert (A : all_fit waist_inputs C_waist of_waist bits_of = true) by apply widths_suffice.
  unfold all_fit in A; destruct (intervals waist_inputs C_waist) as [known |] eqn:K; [| discriminate].
  pose proof (intervals_hold num v inner C_waist waist_inputs known Inputs Runs K) as H; rewrite forallb_forall in A; specialize (A n I).
  destruct (look n known) as [i |] eqn:L; [| discriminate]; apply andb_prop in A as [A B]; apply Z.eqb_eq in B.
  destruct (asked num v n i (H n i L) A) as [_ N]; unfold negative, is_negative in *; rewrite B in N; exact N.
Qed.

Let step_in n s : find (fun s => String.eqb (name s) n) C_waist = Some s -> runs num v inner s.
Proof. intros E; apply (proj1 (Forall_forall _ _) Runs); apply (find_some _ _ E). Qed.

Ltac exact_value n := let H := fresh "E" in
  let s := eval vm_compute in (find (fun s => String.eqb (name s) n) C_waist) in match s with Some ?t =>
    assert (H : runs num v inner t) by (apply (step_in n); vm_compute; reflexivity) end;
  cbv [runs calls look arguments operation name String.eqb Ascii.eqb Bool.eqb] in H; apply proj2 in H;
  apply (f_equal IZR) in H; rewrite ?plus_IZR, ?minus_IZR, ?mult_IZR in H.

Variables u w : R.
Hypotheses (U : (0 < u)%R) (V : (0 < w)%R).

Open Scope R_scope.
Let I n := IZR (v n).
Let q := (I "b" * u) ^ 2.
Let A := (I "alpha" * u / (I "b" * u)) ^ 2.
Let B := (I "gamma" * w / (I "d" * w)) ^ 2.
Let P := ((I "x" * u) ^ 2 + (I "y" * u) ^ 2) / (I "b" * u) ^ 2.

Lemma waist_values : I "W" * u ^ 2 = (P - 1 - A) * q /\ I "excess" * u ^ 4 = (4 * A - (P - 1 - A) ^ 2) * q ^ 2
  /\ I "W_p_2" * u ^ 2 = (P - 1 - A + 2 * A) * q /\ I "room" = (2 * B - (P - 1 - A)) * (I "b" ^ 2 * I "d" ^ 2).
Proof.
  assert (Pb : I "b" <> 0) by (apply Rgt_not_eq; unfold I; apply IZR_lt; exact Ib).
  assert (Pd : I "d" <> 0) by (apply Rgt_not_eq; unfold I; apply IZR_lt; exact Id).
  exact_value "p"; exact_value "q"; exact_value "xx"; exact_value "yy"; exact_value "R"; exact_value "R_less_q"; exact_value "W";
    exact_value "p_2"; exact_value "q_2"; exact_value "four_A"; exact_value "square"; exact_value "excess"; exact_value "W_p_2";
    exact_value "s"; exact_value "t"; exact_value "q_2_s"; exact_value "W_t"; exact_value "room".
  assert (S : IZR (v "size") * IZR (v "size") = IZR (v "W") * IZR (v "W")) by (rewrite <- !mult_IZR, Size; f_equal; lia).
  rewrite S in *; unfold A, B, P, q, I in *.
  repeat match goal with H : IZR (v ?n) = _ |- context [IZR (v ?n)] => rewrite H end.
  repeat split; field; repeat split; try assumption; lra.
Qed.

(** What C answers in the plane z = 0: contact, interior, exterior, or nothing. *)
Definition in_plane (excess_negative W_negative W_p_2_negative room_negative : bool) :=
  if negb excess_negative then Some Contact
  else if W_negative then Some (if W_p_2_negative then Contact else Interior)
  else if room_negative then None else Some Exterior.

Let asks n (c : bool) := if c then negative n (bits_of n) else ~ negative n (bits_of n).

Theorem waist_is_right e n o r a x y : asks "excess" e -> asks "W" n -> asks "W_p_2" o -> asks "room" r -> in_plane e n o r = Some a ->
  x ^ 2 = (I "x" * u) ^ 2 -> y ^ 2 = (I "y" * u) ^ 2 -> answers (I "alpha" * u) (I "gamma" * w) (I "b" * u) (I "d" * w) x y 0 a.
Proof.
  intros H1 H2 H3 H4 F X Y; destruct waist_values as (E1 & E2 & E3 & E4).
  assert (Pb : 0 < I "b" /\ 0 < I "d" /\ 0 < I "alpha" /\ 0 < I "gamma") by (unfold I; repeat split; apply IZR_lt; assumption).
  destruct Pb as (Pb & Pd & Pa & Pg).
  assert (q0 : 0 < q) by (apply pow_lt, Rmult_lt_0_compat; assumption); assert (q2 : 0 < q ^ 2) by (apply pow_lt; exact q0).
  assert (u2 : 0 < u ^ 2) by (apply pow_lt; exact U); assert (u4 : 0 < u ^ 4) by (apply pow_lt; exact U).
  assert (bd : 0 < I "b" ^ 2 * I "d" ^ 2) by (apply Rmult_lt_0_compat; apply pow_lt; assumption).
  assert (sign : forall n c, In n of_waist -> asks n c -> if c then I n < 0 else 0 <= I n).
  { intros m c IN H; pose proof (waist_compared m IN) as W; unfold asks in H; unfold I; destruct c;
      [apply (IZR_lt _ 0), W, H | apply (IZR_le 0); destruct (Z.lt_ge_cases (v m) 0) as [N | N]; [contradiction H; apply W, N | exact N]]. }
  apply sign in H1; [| cbn; tauto]; apply sign in H2; [| cbn; tauto]; apply sign in H3; [| cbn; tauto]; apply sign in H4; [| cbn; tauto].
  assert (by_factor : forall k j m c, 0 < k -> 0 < j -> m * k = c * j -> (m < 0 -> c < 0) /\ (0 <= m -> 0 <= c)).
  { intros k j m c K J E; split; intros H.
    - apply Rmult_lt_reg_r with j; [exact J |]; rewrite Rmult_0_l, <- E; assert (0 < - m * k) by (apply Rmult_lt_0_compat; lra); lra.
    - apply Rmult_le_reg_r with j; [exact J |]; rewrite Rmult_0_l, <- E; apply Rmult_le_pos; lra. }
  destruct (by_factor _ _ _ _ u2 q0 E1) as [W1 W2]; destruct (by_factor _ _ _ _ u4 q2 E2) as [X1 X2].
  destruct (by_factor _ _ _ _ u2 q0 E3) as [O1 O2]; destruct (by_factor 1 _ _ _ Rlt_0_1 bd ltac:(rewrite Rmult_1_r; exact E4)) as [R1 R2].
  unfold in_plane in F; destruct e; cbn [negb] in F.
  - apply X1 in H1; destruct n; [apply W1 in H2; destruct o; injection F as <- | apply W2 in H2; destruct r; [discriminate |]; injection F as <-].
    + apply waist_crossing; [reflexivity |]; rewrite X, Y; fold A P; apply O1 in H3; right; lra.
    + apply waist_inside; try reflexivity; rewrite X, Y; fold A P; apply O2 in H3; lra.
    + apply waist_clear; try reflexivity; rewrite ?X, ?Y; fold A B P; apply R2 in H4; try lra.
      destruct H2 as [H2 | H2]; [exact H2 |]; rewrite <- H2 in H1; assert (0 < A) by (apply pow_lt, over_lt; apply Rmult_lt_0_compat; assumption); lra.
  - injection F as <-; apply waist_crossing; [reflexivity |]; rewrite X, Y; fold A P; apply X2 in H1; left; lra.
Qed.

End Waist.
