(** Stage 5: every integer that Coq reads in the C fits its bits, and has the sign that the exact rule asks for. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Hypcheck Require Import Geometry UnitBall Cubic Rule Positions Steps.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.

(** ** The steps of the C, and the bits of each number. *)

Definition text := match HeaderText.parts with (_, t) :: _ => statements t | [] => [] end.
Definition C_integers := Eval vm_compute in match every (filled text) with Some l => map meaning l | None => [] end.
Definition C_rooms := Eval vm_compute in match every (rooms text) with Some l => l | None => [] end.
Theorem steps_are_read : every (filled text) <> None /\ every (rooms text) = Some C_rooms
  /\ Some C_integers = option_map (map meaning) (every (filled text)).
Proof. vm_compute; repeat split; discriminate. Qed.

(** The integers by name, each step right. *)
Definition integer (v : string -> Z) a := match a with Name n => v n | Number z => z end.
Definition is_right (v : string -> Z) (s : step) : Prop := match arguments s with
  | [a; c] => if String.eqb (operation s) "add" then v (name s) = (integer v a + integer v c)%Z
    else if String.eqb (operation s) "sub" then v (name s) = (integer v a - integer v c)%Z
    else if String.eqb (operation s) "mul" then v (name s) = (integer v a * integer v c)%Z else False
  | _ => False end.

Section Rooms.

Open Scope Z_scope.

Definition lengths := ["alpha"; "gamma"; "b"; "d"; "x"; "y"; "z"].

(** The bits of a number by those of its arguments: its size is below 2^bits. *)
Definition bits_of_argument (known : list (string * Z)) a := match a with Name n => look n known | Number z => Some (Z.log2 (Z.abs z) + 1) end.
Definition bits_of known (s : step) := match arguments s with
  | [a; c] => match bits_of_argument known a, bits_of_argument known c with
    | Some i, Some j => if String.eqb (operation s) "mul" then Some (i + j) else Some (Z.max i j + 1) | _, _ => None end
  | _ => None end.

(** Every number has room for its bits. *)
Fixpoint counted known (l : list step) : option (list (string * Z)) := match l with
  | [] => Some known
  | s :: rest => match bits_of known s, look (name s) C_rooms with
    | Some i, Some k => if (0 <=? i) && (i <=? k) then counted ((name s, i) :: known) rest else None | _, _ => None end end.

Variable v : string -> Z.
Definition below k z := 0 <= k /\ Z.abs z < 2 ^ k.
Definition bounded known := forall n i, look n known = Some i -> below i (v n).

Lemma size_holds known s i : bounded known -> is_right v s -> bits_of known s = Some i -> below i (v (name s)).
Proof.
  intros K R; unfold bits_of, is_right in *; destruct (arguments s) as [| a [| c [|]]]; try discriminate.
  assert (arg : forall e j, bits_of_argument known e = Some j -> below j (integer v e)).
  { intros [n | z] j; cbn; [apply K | intros H; injection H as <-]; unfold below; pose proof (Z.log2_nonneg (Z.abs z)); split; [lia |].
    destruct (Z.eq_dec z 0) as [-> | N]; [reflexivity | apply Z.log2_spec; lia]. }
  destruct (bits_of_argument known a) as [p |] eqn:Ea; [| discriminate]; destruct (bits_of_argument known c) as [q |] eqn:Ec; [| discriminate].
  apply arg in Ea as [P0 P]; apply arg in Ec as [Q0 Q].
  assert (sums : forall z, Z.abs z <= Z.abs (integer v a) + Z.abs (integer v c) -> below (Z.max p q + 1) z).
  { intros z H; split; [lia |]; rewrite Z.pow_add_r by lia; pose proof (Z.pow_le_mono_r 2 p (Z.max p q)); pose proof (Z.pow_le_mono_r 2 q (Z.max p q)); lia. }
  destruct (String.eqb (operation s) "add") eqn:O1.
  - apply String.eqb_eq in O1; rewrite O1; cbn; intros H; injection H as <-; apply sums; lia.
  - destruct (String.eqb (operation s) "sub") eqn:O2.
    + apply String.eqb_eq in O2; rewrite O2; cbn; intros H; injection H as <-; apply sums; lia.
    + destruct (String.eqb (operation s) "mul"); [| contradiction]; intros H; injection H as <-.
      split; [lia |]; rewrite R, Z.abs_mul, Z.pow_add_r by assumption; apply Z.mul_lt_mono_nonneg; lia.
Qed.

Theorem counts_hold l : forall known found, bounded known -> Forall (is_right v) l -> counted known l = Some found ->
  forall s, In s l -> exists k, look (name s) C_rooms = Some k /\ Z.abs (v (name s)) < 2 ^ k.
Proof.
  induction l as [| s l IH]; cbn [counted]; intros known found K R E; [contradiction |].
  inversion R; subst; destruct (bits_of known s) as [i |] eqn:G; [| discriminate]; destruct (look (name s) C_rooms) as [k |] eqn:L; [| discriminate].
  destruct ((0 <=? i) && (i <=? k)) eqn:F; [| discriminate]; apply andb_prop in F as [_ F]; apply Z.leb_le in F.
  pose proof (size_holds known s i K ltac:(assumption) G) as [B0 B]; pose proof (Z.pow_le_mono_r 2 i k).
  intros t [<- | T]; [exists k; split; [exact L | lia] | apply (IH ((name s, i) :: known) found); try assumption].
  intros n j M; cbn [look] in M; destruct (String.eqb_spec (name s) n) as [<- | N]; [injection M as <-; split; assumption | apply K; exact M].
Qed.

(** The bits that the C gives a length. *)
Definition given := flat_map (fun n => match look n C_rooms with Some k => [(n, k)] | None => [] end) lengths.
Theorem rooms_are_counted : map fst given = lengths /\ counted given C_integers <> None.
Proof. vm_compute; split; [reflexivity | discriminate]. Qed.

(** Where the lengths fit the bits that the C gives them, each number fits its own. *)
Theorem rooms_suffice s : bounded given -> Forall (is_right v) C_integers -> In s C_integers ->
  exists k, look (name s) C_rooms = Some k /\ Z.abs (v (name s)) < 2 ^ k.
Proof.
  intros H R I; pose proof (proj2 rooms_are_counted) as C; destruct (counted given C_integers) as [found |] eqn:E; [| contradiction].
  exact (counts_hold C_integers given found H R E s I).
Qed.

End Rooms.

Section Integers.

Variable v : string -> Z.
Hypothesis Right : Forall (is_right v) C_integers.

(** The lengths in two units. *)
Variables u w : R.
Hypotheses (U : (0 < u)%R) (V : (0 < w)%R) (Ia : (0 < v "alpha")%Z) (Ig : (0 < v "gamma")%Z) (Ib : (0 < v "b")%Z) (Id : (0 < v "d")%Z).

Open Scope R_scope.
Let I n := IZR (v n).
Let A := (I "alpha" * u / (I "b" * u)) ^ 2.
Let B := (I "gamma" * w / (I "d" * w)) ^ 2.
Let P := ((I "x" * u) ^ 2 + (I "y" * u) ^ 2) / (I "b" * u) ^ 2.
Let Q := (I "z" * w / (I "d" * w)) ^ 2.

Let right_of n : option step := find (fun s => String.eqb (name s) n) C_integers.
Let right n s : right_of n = Some s -> is_right v s.
Proof. intros E; apply (proj1 (Forall_forall _ _) Right); apply (find_some _ _ E). Qed.

Ltac equation n := let s := eval vm_compute in (right_of n) in match s with Some ?k =>
  let H := fresh "E" in assert (H : is_right v k) by (apply (right n); vm_compute; reflexivity);
  cbv [is_right arguments operation name String.eqb Ascii.eqb Bool.eqb integer] in H;
  apply (f_equal IZR) in H; rewrite ?plus_IZR, ?minus_IZR, ?mult_IZR in H end.

Let N := I "N".

Lemma squares : I "p" = I "alpha" ^ 2 /\ I "q" = I "b" ^ 2 /\ I "s" = I "gamma" ^ 2 /\ I "t" = I "d" ^ 2
  /\ I "R" = I "x" ^ 2 + I "y" ^ 2 /\ I "S" = I "z" ^ 2 /\ I "N" = I "b" ^ 2 * I "d" ^ 2.
Proof.
  equation "p"; equation "q"; equation "s"; equation "t"; equation "xx"; equation "yy"; equation "R"; equation "S"; equation "N".
  unfold I; repeat split; repeat match goal with H : IZR (v _) = _ |- _ => rewrite H; clear H end; ring.
Qed.

Let pos : 0 < I "alpha" /\ 0 < I "gamma" /\ 0 < I "b" /\ 0 < I "d".
Proof. unfold I; repeat split; apply IZR_lt; assumption. Qed.

Lemma N_positive : 0 < N.
Proof.
  destruct squares as (_ & _ & _ & _ & _ & _ & E); destruct pos as (_ & _ & Pb & Pd); unfold N; rewrite E.
  apply Rmult_lt_0_compat; apply pow_lt; assumption.
Qed.

Lemma coefficients : I "n2" = N * c2 A B P Q /\ I "n1" = N * c1 A B P Q /\ I "ps" = - (N * c0 A B P Q).
Proof.
  destruct squares as (Ep & Eq & Es & Et & ER & ES & EN); destruct pos as (Pa & Pg & Pb & Pd).
  equation "p_plus_q"; equation "p_q_R"; equation "s_plus_S"; equation "radial_2"; equation "axial_2"; equation "n2";
    equation "t_minus_s"; equation "t_s_S"; equation "R_minus_q"; equation "axial_1"; equation "radial_1"; equation "n1"; equation "ps".
  fold (I "p") (I "q") (I "s") (I "t") (I "R") (I "S") (I "p_plus_q") (I "p_q_R") (I "s_plus_S") (I "radial_2") (I "axial_2")
    (I "n2") (I "t_minus_s") (I "t_s_S") (I "R_minus_q") (I "axial_1") (I "radial_1") (I "n1") (I "ps") in *.
  unfold N, c2, c1, c0, A, B, P, Q; rewrite EN.
  repeat split; repeat match goal with H : I ?n = _ |- context [I ?n] => rewrite H end; field; lra.
Qed.

Theorem integers_have_the_signs : I "delta" = 3 * N ^ 4 * delta A B P Q
  /\ I "offset_at_B" = N * I "t" * (3 * B + c2 A B P Q) /\ I "slope_at_B" = N * I "t" ^ 2 * slope A B P Q B
  /\ I "offset_at_A" = N * I "q" * (3 * A - c2 A B P Q) /\ I "slope_at_A" = N * I "q" ^ 2 * slope A B P Q (- A)
  /\ I "ring_excess" = I "q" * I "t" ^ 2 * (B ^ 2 - A).
Proof.
  destruct squares as (Ep & Eq & Es & Et & ER & ES & EN); destruct pos as (Pa & Pg & Pb & Pd); destruct coefficients as (C2 & C1 & C0).
  assert (EB : I "s" = B * I "t") by (rewrite Es, Et; unfold B; field; lra).
  assert (EA : I "p" = A * I "q") by (rewrite Ep, Eq; unfold A; field; lra).
  equation "n2_n2"; equation "N_n1"; equation "N_n1_3"; equation "h1"; equation "n2_n1"; equation "N_ps"; equation "N_ps_9"; equation "h2";
    equation "n1_n1"; equation "n2_ps"; equation "n2_ps_3"; equation "h3"; equation "h1_h3"; equation "h1_h3_4"; equation "h2_h2"; equation "delta";
    equation "N_s"; equation "N_s_3"; equation "n2_t"; equation "offset_at_B"; equation "offset_and_n2_t"; equation "rise_at_B";
    equation "n1_t"; equation "n1_tt"; equation "slope_at_B"; equation "N_p"; equation "N_p_3"; equation "n2_q"; equation "offset_at_A";
    equation "offset_less_n2_q"; equation "rise_at_A"; equation "n1_q"; equation "n1_qq"; equation "slope_at_A"; equation "p_t"; equation "p_tt";
    equation "q_s"; equation "q_ss"; equation "ring_excess".
  clear Ep Eq Es Et ER ES EN; unfold N, I in C2, C1, C0, EB, EA |- *.
  unfold Rule.delta, disc, slope; set (k2 := c2 A B P Q) in *; set (k1 := c1 A B P Q) in *; set (k0 := c0 A B P Q) in *.
  clearbody k2 k1 k0 A B.
  repeat split; repeat match goal with H : IZR (v ?n) = _ |- context [IZR (v ?n)] => rewrite H end; ring.
Qed.

Let sign_of k r m : 0 < r -> IZR k = r * m -> sign_is (Z.compare k 0) m.
Proof.
  intros R0 E; destruct (Z.compare_spec k 0) as [H | H | H]; cbn; [subst k | apply IZR_lt in H | apply IZR_lt in H].
  - symmetry in E; apply Rmult_integral in E; lra.
  - apply Rmult_lt_reg_l with r; lra.
  - apply Rmult_lt_reg_l with r; lra.
Qed.

(** The last stage answers by the signs of its integers, and that is the position. *)
Theorem last_stage_is_right : let s n := Z.compare (v n) 0 in
  is_position (upright (I "alpha" * u) (I "gamma" * w) (I "b" * u) (I "d" * w) (I "x" * u) (I "y" * u) (I "z" * w))
    (exact_answer (s "delta") (s "n2") (s "n1") (s "offset_at_B") (s "slope_at_B") (s "offset_at_A") (s "slope_at_A") (s "z")
      (s "ring_excess")).
Proof.
  intros s; destruct pos as (Pa & Pg & Pb & Pd); pose proof N_positive as N0.
  destruct squares as (_ & Eq & _ & Et & _); destruct coefficients as (C2 & C1 & _).
  destruct integers_have_the_signs as (X1 & X2 & X3 & X4 & X5 & X6).
  assert (q0 : 0 < I "q") by (rewrite Eq; apply pow_lt; assumption).
  assert (t0 : 0 < I "t") by (rewrite Et; apply pow_lt; assumption).
  assert (q2 : 0 < I "q" ^ 2) by (apply pow_lt; assumption); assert (t2 : 0 < I "t" ^ 2) by (apply pow_lt; assumption).
  assert (N4 : 0 < N ^ 4) by (apply pow_lt; assumption).
  apply exact_answer_is_right; try (apply Rmult_lt_0_compat; assumption); fold A B P Q.
  - apply sign_of with (3 * N ^ 4); [lra | exact X1].
  - apply sign_of with N; assumption.
  - apply sign_of with N; assumption.
  - apply sign_of with (N * I "t"); [apply Rmult_lt_0_compat; assumption | exact X2].
  - apply sign_of with (N * I "t" ^ 2); [apply Rmult_lt_0_compat; assumption | exact X3].
  - apply sign_of with (N * I "q"); [apply Rmult_lt_0_compat; assumption | exact X4].
  - apply sign_of with (N * I "q" ^ 2); [apply Rmult_lt_0_compat; assumption | exact X5].
  - apply sign_of with (/ w); [apply Rinv_0_lt_compat; assumption |]; unfold I; field; lra.
  - apply sign_of with (I "q" * I "t" ^ 2); [apply Rmult_lt_0_compat; assumption | exact X6].
Qed.

End Integers.
