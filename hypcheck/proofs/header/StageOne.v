(** Stage 1: what the rounded comparison of R = x^2 + y^2 with a line K + M z^2 says of the exact one, and so of the position.

    The steps are those that Coq reads in the C, each rounded in a mode of its own, contracted or not, flushed to 0 or not. The line that a
    comparison proves something by is (1 - 8u) or (1 + 9u) times the one that is compared with: this is the margin that a scene's
    constants need. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Flocq Require Import Core.
From Hypcheck Require Import Geometry UnitBall Rule HalfPlanes Rounding Floats Steps FixedRuns Ranges Underflow.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Definition C_one_line := Eval vm_compute in steps_in "one-line".
Definition C_two_lines := Eval vm_compute in steps_in "two-lines".
Theorem lines_are_read : [C_one_line; C_two_lines] = map steps_in ["one-line"; "two-lines"].
Proof. vm_compute; reflexivity. Qed.

Notation u := unit_of_any_mode.
Notation least := (pow (-1022)).

Lemma u_is : u = / 4503599627370496.
Proof. unfold unit_of_any_mode; simpl; lra. Qed.

(** Close to an exact number >= 0: by a factor, and by what underflow loses. *)
Definition close k m v w := Rabs (v - w) <= k * u * w + m.

Lemma close_rounded p v : returned p v -> 0 <= p -> p <= pow 1023 -> close 1 least v p.
Proof.
  intros R P H; destruct (rounding_loses p v R ltac:(rewrite Rabs_pos_eq; lra)) as (t & T & E & _); unfold close.
  replace (v - p) with (p * t + (v - p * (1 + t))) by ring; pose proof (Rabs_triang (p * t) (v - p * (1 + t))) as H1.
  rewrite Rabs_mult, (Rabs_pos_eq p) in H1 by exact P; assert (p * Rabs t <= p * u) by (apply Rmult_le_compat_l; assumption); lra.
Qed.

Section Numbers.

Variables x y z K M fxx fyy fR fT fS p q s r frise fline : R.
Let X := x * x.
Let Y := y * y.
Let Z := z * z.
Hypotheses (Vxx : returned X fxx) (Vyy : returned Y fyy) (VT : returned Z fT)
  (Tp : p = fxx \/ p = X) (Tq : q = fyy \/ q = Y) (VR : returned (p + q) fR)
  (Ts : s = fT \/ s = Z) (VS : returned (fR + s) fS) (Cap : fS < pow 400)
  (Vrise : returned (M * fT) frise) (Tr : r = frise \/ r = M * fT) (Vline : returned (K + r) fline)
  (HM : 0 <= M <= pow 400) (HK : pow (-300) <= K <= pow 400).

Let sq v : 0 <= v * v.
Proof. pose proof (pow2_ge_0 v); lra. Qed.
Let tiny : 0 < least.
Proof. apply bpow_gt_0. Qed.
Let positive_returned v w : returned v w -> 0 <= v -> 0 <= w.
Proof.
  intros [R | [[_ ->] | (T & _ & PV)]] P; [apply stays_positive with v; assumption | lra |].
  pose proof (bpow_gt_0 radix2 1023); rewrite Rabs_pos_eq in T by exact P; apply Rmult_le_reg_l with v; lra.
Qed.

(** By the cap nothing overflows. *)
Let in_range : 0 <= X <= pow 400 /\ 0 <= Y <= pow 400 /\ 0 <= Z <= pow 400 /\ 0 <= p /\ 0 <= q /\ p + q <= pow 400 /\ 0 <= fT <= pow 400.
Proof.
  pose proof (sq x : 0 <= X) as X0; pose proof (sq y : 0 <= Y) as Y0; pose proof (sq z : 0 <= Z) as Z0.
  pose proof (positive_returned _ _ Vxx X0); pose proof (positive_returned _ _ Vyy Y0); pose proof (positive_returned _ _ VT Z0).
  assert (P0 : 0 <= p) by (destruct Tp; subst p; assumption); assert (Q0 : 0 <= q) by (destruct Tq; subst q; assumption).
  assert (S0 : 0 <= s) by (destruct Ts; subst s; assumption); pose proof (positive_returned _ _ VR ltac:(lra)) as R0.
  pose proof (below _ _ 400 VS ltac:(lra) ltac:(lia) Cap) as B; pose proof (below _ _ 400 VR ltac:(lra) ltac:(lia) ltac:(lra)) as BR.
  assert (part : forall v w t, returned v w -> 0 <= v -> t = w \/ t = v -> t < pow 400 -> v <= pow 400 /\ w <= pow 400).
  { intros v w t V V0 [-> | ->] L; [pose proof (below _ _ 400 V V0 ltac:(lia) L); lra |].
    split; [lra |]; apply no_more with v; [exact V | exact V0 | lia | lra]. }
  destruct (part _ _ p Vxx X0 Tp ltac:(lra)); destruct (part _ _ q Vyy Y0 Tq ltac:(lra)); destruct (part _ _ s VT Z0 Ts ltac:(lra)).
  repeat split; assumption || lra.
Qed.

Let H400 : pow 400 + pow 400 <= pow 1023 /\ pow 400 * pow 400 + pow 400 + pow 400 <= pow 1023.
Proof.
  rewrite <- bpow_plus, !Ranges.double; change (400 + 400)%Z with 800%Z; pose proof (bpow_le radix2 (400 + 1) 1023 ltac:(lia)).
  pose proof (bpow_le radix2 400 800 ltac:(lia)); pose proof (Ranges.double 800); pose proof (Ranges.double 801).
  pose proof (bpow_le radix2 802 1023 ltac:(lia)); change (800 + 1)%Z with 801%Z in *; change (801 + 1)%Z with 802%Z in *; split; lra.
Qed.

Let R_close : Rabs (fR - (X + Y)) <= 3 * u * (X + Y) + 4 * least.
Proof.
  destruct in_range as (HX & HY & HZ & P0 & Q0 & PQ & HT); destruct H400 as [H1 H2].
  assert (CX : close 1 least p X).
  { destruct Tp; subst p; [apply close_rounded; [exact Vxx | lra | lra] |]; unfold close; rewrite Rminus_diag_eq, Rabs_R0 by reflexivity; rewrite u_is; lra. }
  assert (CY : close 1 least q Y).
  { destruct Tq; subst q; [apply close_rounded; [exact Vyy | lra | lra] |]; unfold close; rewrite Rminus_diag_eq, Rabs_R0 by reflexivity; rewrite u_is; lra. }
  pose proof (close_rounded _ _ VR ltac:(lra) ltac:(lra)) as C; unfold close in *.
  pose proof (Rabs_triang (p - X) (q - Y)) as T1; pose proof (Rabs_triang (fR - (p + q)) ((p - X) + (q - Y))) as T2.
  replace (fR - (p + q) + (p - X + (q - Y))) with (fR - (X + Y)) in T2 by ring; pose proof (Rle_abs (p - X + (q - Y))); rewrite u_is in *; lra.
Qed.

Let line_close : Rabs (fline - (K + M * Z)) <= 4 * u * (K + M * Z) + u * K - 4 * least.
Proof.
  destruct in_range as (HX & HY & HZ & P0 & Q0 & PQ & HT); destruct H400 as [H1 H2].
  pose proof (close_rounded _ _ VT ltac:(lra) ltac:(lra)) as CT; unfold close in CT.
  assert (M1 : 0 <= M * Z) by (apply Rmult_le_pos; lra); assert (M2 : 0 <= M * fT) by (apply Rmult_le_pos; lra).
  assert (M3 : M * fT <= pow 400 * pow 400) by (apply Rmult_le_compat; lra); pose proof (bpow_gt_0 radix2 400).
  assert (CM : Rabs (M * fT - M * Z) <= u * (M * Z) + M * least).
  { rewrite <- Rmult_minus_distr_l, Rabs_mult, (Rabs_pos_eq M) by lra; apply Rle_trans with (M * (1 * u * Z + least)); [apply Rmult_le_compat_l; lra | lra]. }
  assert (CR : close 1 least r (M * fT)).
  { destruct Tr; subst r; [apply close_rounded; [exact Vrise | lra | lra] |]; unfold close; rewrite Rminus_diag_eq, Rabs_R0 by reflexivity; rewrite u_is; lra. }
  assert (K0 : 0 < K) by (pose proof (bpow_gt_0 radix2 (-300)); lra); assert (r0 : 0 <= r) by (destruct Tr; subst r; [apply (positive_returned _ _ Vrise M2) | exact M2]).
  assert (r1 : r <= pow 400 * pow 400).
  { destruct Tr; subst r; [| exact M3]; rewrite <- bpow_plus in M3 |- *; apply no_more with (M * fT); [exact Vrise | exact M2 | lia | exact M3]. }
  pose proof (close_rounded _ _ Vline ltac:(lra) ltac:(lra)) as CL; unfold close in CL, CR.
  (* what underflows is less than u K / 2 *)
  assert (L1 : M * least <= / 16 * u * K).
  { apply Rle_trans with (pow 400 * least); [apply Rmult_le_compat_r; lra |]; apply Rle_trans with (/ 16 * u * pow (-300)); [| apply Rmult_le_compat_l; [rewrite u_is |]; lra].
    replace (/ 16) with (pow (-4)) by reflexivity; unfold unit_of_any_mode; rewrite <- !bpow_plus; apply bpow_le; lia. }
  assert (L2 : least <= / 16 * u * K).
  { apply Rle_trans with (/ 16 * u * pow (-300)); [| apply Rmult_le_compat_l; [rewrite u_is |]; lra].
    replace (/ 16) with (pow (-4)) by reflexivity; unfold unit_of_any_mode; rewrite <- !bpow_plus; apply bpow_le; lia. }
  pose proof (Rabs_triang (fline - (K + r)) (r - M * Z)) as T1; replace (fline - (K + r) + (r - M * Z)) with (fline - (K + M * Z)) in T1 by ring.
  pose proof (Rabs_triang (r - M * fT) (M * fT - M * Z)) as T2; replace (r - M * fT + (M * fT - M * Z)) with (r - M * Z) in T2 by ring.
  pose proof (Rle_abs (r - M * Z)); pose proof (Rle_abs (M * fT - M * Z)); rewrite u_is in *; lra.
Qed.

Lemma beyond_computed : fline <= fR -> (1 - 8 * u) * (K + M * Z) < X + Y.
Proof.
  intros H; destruct in_range as (HX & HY & HZ & _); pose proof R_close as A; pose proof line_close as B.
  assert (M1 : 0 <= M * Z) by (apply Rmult_le_pos; lra); pose proof (bpow_gt_0 radix2 (-300)).
  pose proof (Rle_abs (fR - (X + Y))); pose proof (Rle_abs (- (fline - (K + M * Z)))) as C; rewrite Rabs_Ropp in C; rewrite u_is in *; lra.
Qed.
Lemma within_computed : fR < fline -> X + Y < (1 + 9 * u) * (K + M * Z).
Proof.
  intros H; destruct in_range as (HX & HY & HZ & _); pose proof R_close as A; pose proof line_close as B.
  assert (M1 : 0 <= M * Z) by (apply Rmult_le_pos; lra); pose proof (bpow_gt_0 radix2 (-300)).
  pose proof (Rle_abs (fline - (K + M * Z))); pose proof (Rle_abs (- (fR - (X + Y)))) as C; rewrite Rabs_Ropp in C; rewrite u_is in *; lra.
Qed.

End Numbers.

(** ** The steps. *)

Definition multiplied := Eval vm_compute in
  map name (filter (fun s => match kind_of s with Some Times => true | _ => false end) (C_one_line ++ C_two_lines)%list).

Local Notation by_search := ltac:(vm_compute; reflexivity) (only parsing).

Section Row.

Variables (l : list step) (x pre : string -> R) (holds : string -> Prop) (alpha gamma b d : R).
Hypotheses (Runs : Forall (runs multiplied x pre) l) (Compares : Forall (compares x holds) l) (Cap : x "R_plus_T" < pow 400).
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d).

Let body := upright alpha gamma b d (x "x") (x "y") (x "z").
Let A := (alpha / b) ^ 2.
Let B := (gamma / d) ^ 2.
Let K n := x ("K_" ++ n).
Let M n := x ("M_" ++ n).

Definition step_of n := find (fun s => String.eqb (name s) n) l.
Definition place := step_of "xx" = Some (Step "xx" "mul" [Name "x"; Name "x"]) /\ step_of "yy" = Some (Step "yy" "mul" [Name "y"; Name "y"])
  /\ step_of "R" = Some (Step "R" "add" [Name "xx"; Name "yy"]) /\ step_of "T" = Some (Step "T" "mul" [Name "z"; Name "z"])
  /\ step_of "R_plus_T" = Some (Step "R_plus_T" "add" [Name "R"; Name "T"]) /\ step_of "in_reach" = Some (Step "in_reach" "HC_LE" [Name "T"; Name "reach"]).
Hypothesis Place : place.
Definition line n := step_of ("rise_" ++ n) = Some (Step ("rise_" ++ n) "mul" [Name ("M_" ++ n); Name "T"])
  /\ step_of ("line_" ++ n) = Some (Step ("line_" ++ n) "add" [Name ("K_" ++ n); Name ("rise_" ++ n)]) /\ is_in ("K_" ++ n) multiplied = false.

Lemma runs_of n s : step_of n = Some s -> runs multiplied x pre s.
Proof. intros E; apply find_some in E as [I _]; apply (proj1 (Forall_forall _ _) Runs s I). Qed.
Lemma compares_of n s : step_of n = Some s -> compares x holds s.
Proof. intros E; apply find_some in E as [I _]; apply (proj1 (Forall_forall _ _) Compares s I). Qed.
Lemma product_of n a c : step_of n = Some (Step n "mul" [Name a; Name c]) -> pre n = x a * x c /\ returned (pre n) (x n).
Proof. intros E; destruct (runs_of n _ E) as (p & q & -> & -> & H); exact H. Qed.
Lemma sum_of n a c : step_of n = Some (Step n "add" [Name a; Name c]) ->
  exists p q, takes multiplied x pre (Name a) p /\ takes multiplied x pre (Name c) q /\ returned (p + q) (x n).
Proof. intros E; destruct (runs_of n _ E) as (p & q & P & Q & H & G); exists p, q; rewrite <- H; auto. Qed.

Definition usable n := pow (-300) <= K n <= pow 400 /\ 0 <= M n <= pow 400.

Lemma line_decides n : line n -> usable n ->
  (x ("line_" ++ n) <= x "R" -> (1 - 8 * u) * (K n + M n * x "z" ^ 2) < x "x" ^ 2 + x "y" ^ 2)
  /\ (x "R" < x ("line_" ++ n) -> x "x" ^ 2 + x "y" ^ 2 < (1 + 9 * u) * (K n + M n * x "z" ^ 2)).
Proof.
  intros (L1 & L2 & L3) [HK HM]; destruct Place as (S1 & S2 & S3 & S4 & S5 & _).
  destruct (product_of _ _ _ S1) as [E1 V1]; destruct (product_of _ _ _ S2) as [E2 V2]; destruct (product_of _ _ _ S4) as [E4 V4].
  destruct (product_of _ _ _ L1) as [E6 V6]; rewrite E1 in V1; rewrite E2 in V2; rewrite E4 in V4; rewrite E6 in V6.
  destruct (sum_of _ _ _ S3) as (p & q & Tp & Tq & VR); destruct (sum_of _ _ _ S5) as (r' & s & Tr' & Ts & VS); destruct (sum_of _ _ _ L2) as (k & r & Tk & Tr & VL).
  assert (r' = x "R") by (destruct Tr' as [-> | [N _]]; [reflexivity | discriminate N]); subst r'.
  assert (k = K n) by (destruct Tk as [-> | [N _]]; [reflexivity | rewrite L3 in N; discriminate N]); subst k.
  assert (Tp' : p = x "xx" \/ p = x "x" * x "x") by (destruct Tp as [-> | [_ ->]]; auto).
  assert (Tq' : q = x "yy" \/ q = x "y" * x "y") by (destruct Tq as [-> | [_ ->]]; auto).
  assert (Ts' : s = x "T" \/ s = x "z" * x "z") by (destruct Ts as [-> | [_ ->]]; auto).
  assert (Tr2 : r = x ("rise_" ++ n) \/ r = M n * x "T") by (destruct Tr as [-> | [_ ->]]; auto).
  rewrite <- !Rsqr_pow2; unfold Rsqr; split; intros H.
  - eapply beyond_computed with (fxx := x "xx") (fyy := x "yy") (fR := x "R"); eassumption.
  - eapply within_computed with (fxx := x "xx") (fyy := x "yy") (fR := x "R"); eassumption.
Qed.

(** A scene's constants: the line of a multiplier, or of a chord over the heights between two, with the margin on its safe side. *)
Definition beyond n := line n /\ usable n /\ exists m, 0 < m < B /\ beyond_K alpha b m <= (1 - 8 * u) * K n
  /\ beyond_M alpha gamma b d m <= (1 - 8 * u) * M n.
Definition within n := line n /\ usable n /\ exists m, 0 < m < A /\ (1 + 9 * u) * K n <= within_K alpha b m
  /\ (1 + 9 * u) * M n <= within_M alpha gamma b d m.
Definition under n low high := line n /\ usable n /\ exists x1 y1 z1 x2 y2 z2,
  ~ exterior (upright alpha gamma b d x1 y1 z1) /\ ~ exterior (upright alpha gamma b d x2 y2 z2) /\ z1 ^ 2 <= low /\ high <= z2 ^ 2
  /\ (1 + 9 * u) * (K n + M n * z1 ^ 2) <= x1 ^ 2 + y1 ^ 2 /\ (1 + 9 * u) * (K n + M n * z2 ^ 2) <= x2 ^ 2 + y2 ^ 2.
(** Above 0 all positions are. *)
Definition above n low high := line n /\ (usable n \/ K n = 0 /\ M n = 0) /\ exists x1 y1 z1 x2 y2 z2,
  ~ interior (upright alpha gamma b d x1 y1 z1) /\ ~ interior (upright alpha gamma b d x2 y2 z2) /\ z1 ^ 2 <= low /\ high <= z2 ^ 2
  /\ x1 ^ 2 + y1 ^ 2 <= (1 - 8 * u) * (K n + M n * z1 ^ 2) /\ x2 ^ 2 + y2 ^ 2 <= (1 - 8 * u) * (K n + M n * z2 ^ 2).

Theorem exterior_beyond n : beyond n -> x ("line_" ++ n) < x "R" -> exterior body.
Proof.
  intros (L & U & m & I & HK & HM) H; destruct (line_decides n L U) as [D _].
  apply (exterior_beyond_line alpha gamma b d Ha Hg Hb Hd ((1 - 8 * u) * K n) ((1 - 8 * u) * M n) m); try assumption; pose proof (D ltac:(lra)); lra.
Qed.

Theorem interior_within n : within n -> x "R" < x ("line_" ++ n) -> interior body.
Proof.
  intros (L & U & m & I & HK & HM) H; destruct (line_decides n L U) as [_ D].
  apply (interior_within_line alpha gamma b d Ha Hg Hb Hd ((1 + 9 * u) * K n) ((1 + 9 * u) * M n) m); try assumption; pose proof (D H); lra.
Qed.

Theorem not_exterior_under n low high : under n low high -> low <= x "z" ^ 2 <= high -> x "R" < x ("line_" ++ n) -> ~ exterior body.
Proof.
  intros (L & U & x1 & y1 & z1 & x2 & y2 & z2 & N1 & N2 & Z1 & Z2 & H1 & H2) Z H; destruct (line_decides n L U) as [_ D]; pose proof (D H).
  apply (not_exterior_under_chord alpha gamma b d Ha Hg Hb Hd ((1 + 9 * u) * K n) ((1 + 9 * u) * M n) x1 y1 z1 x2 y2 z2); try assumption; lra.
Qed.

Theorem not_interior_above n low high : above n low high -> low <= x "z" ^ 2 <= high -> x ("line_" ++ n) <= x "R" -> ~ interior body.
Proof.
  intros (L & U & x1 & y1 & z1 & x2 & y2 & z2 & N1 & N2 & Z1 & Z2 & H1 & H2) Z H.
  assert (D : (1 - 8 * u) * (K n + M n * x "z" ^ 2) <= x "x" ^ 2 + x "y" ^ 2).
  { destruct U as [U | [-> ->]]; [destruct (line_decides n L U) as [D _]; left; apply D; exact H |].
    rewrite Rmult_0_l, Rplus_0_l, Rmult_0_r; pose proof (pow2_ge_0 (x "x")); pose proof (pow2_ge_0 (x "y")); lra. }
  apply (not_interior_above_chord alpha gamma b d Ha Hg Hb Hd ((1 - 8 * u) * K n) ((1 - 8 * u) * M n) x1 y1 z1 x2 y2 z2); try assumption; lra.
Qed.

(** The rounded height within reach: the exact one within a little more. *)
Lemma height_in_reach : pow (-300) <= x "reach" -> x "reach" < pow 400 -> holds "in_reach" -> 0 <= x "z" ^ 2 <= (1 + 3 * u) * x "reach".
Proof.
  intros R0 R1 H; destruct Place as (_ & _ & _ & S4 & _ & S6); destruct (product_of _ _ _ S4) as [E V]; rewrite E in V.
  pose proof (compares_of _ _ S6 H _ _ eq_refl eq_refl) as T; cbn in T; rewrite <- Rsqr_pow2; unfold Rsqr in *.
  assert (Z0 : 0 <= x "z" * x "z") by (pose proof (pow2_ge_0 (x "z")); lra); split; [exact Z0 |].
  pose proof (below _ _ 400 V Z0 ltac:(lia) ltac:(lra)) as Z1; pose proof (bpow_le radix2 400 1023 ltac:(lia)).
  pose proof (close_rounded _ _ V Z0 ltac:(lra)) as C; unfold close in C; pose proof (Rle_abs (- (x "T" - x "z" * x "z"))) as C'; rewrite Rabs_Ropp in C'.
  assert (L : least <= / 16 * u * x "reach").
  { apply Rle_trans with (/ 16 * u * pow (-300)); [| apply Rmult_le_compat_l; [rewrite u_is |]; lra].
    replace (/ 16) with (pow (-4)) by reflexivity; unfold unit_of_any_mode; rewrite <- !bpow_plus; apply bpow_le; lia. }
  assert (0 < x "reach") by (pose proof (bpow_gt_0 radix2 (-300)); lra); rewrite u_is in *; lra.
Qed.

End Row.

(** ** **What the C answers is the position**, where the lines that it compares with have the margin. *)

Section Answers.

Variables (x pre : string -> R) (holds : string -> Prop) (alpha gamma b d : R).
Hypotheses (Cap : x "R_plus_T" < pow 400) (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d)
  (Reach : pow (-300) <= x "reach" < pow 400).

Let body := upright alpha gamma b d (x "x") (x "y") (x "z").
Let highest := (1 + 3 * u) * x "reach".

Lemma places : place C_one_line /\ place C_two_lines.
Proof. repeat split; vm_compute; reflexivity. Qed.

Section One.

Hypotheses (Runs : Forall (runs multiplied x pre) C_one_line) (Compares : Forall (compares x holds) C_one_line).
Let P := proj1 places.
Let asks n s : step_of C_one_line n = Some s -> compares x holds s := compares_of C_one_line x holds Compares n s.

Theorem one_line_exterior : beyond C_one_line x alpha gamma b d "beyond_0" -> holds "exterior" -> exterior body.
Proof.
  intros L H; apply (exterior_beyond C_one_line x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P "beyond_0" L).
  apply (asks "exterior" _ eq_refl H); reflexivity.
Qed.

Theorem one_line_interior : within C_one_line x alpha gamma b d "within_0" -> holds "interior" -> interior body.
Proof.
  intros L H; apply (interior_within C_one_line x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P "within_0" L).
  apply (asks "interior" _ eq_refl H); reflexivity.
Qed.

Theorem one_line_contact : under C_one_line x alpha gamma b d "under_0" 0 highest -> above C_one_line x alpha gamma b d "above_0" 0 highest ->
  holds "contact" -> contact body.
Proof.
  intros U V H; destruct (asks "contact" _ eq_refl H) as [C R]; destruct (asks "contact_in_reach" _ eq_refl C) as [C1 C2].
  pose proof (height_in_reach C_one_line x pre holds Runs Compares P ltac:(lra) ltac:(lra) R) as Z.
  apply contact_between_chords; try assumption.
  - apply (not_exterior_under C_one_line x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P "under_0" 0 highest U Z), (asks "is_under" _ eq_refl C1); reflexivity.
  - apply (not_interior_above C_one_line x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P "above_0" 0 highest V Z), (asks "is_above" _ eq_refl C2); reflexivity.
Qed.

End One.

Section Two.

Hypotheses (Runs : Forall (runs multiplied x pre) C_two_lines) (Compares : Forall (compares x holds) C_two_lines).
Let P := proj2 places.
Let asks n s : step_of C_two_lines n = Some s -> compares x holds s := compares_of C_two_lines x holds Compares n s.

Theorem two_lines_exterior : beyond C_two_lines x alpha gamma b d "beyond_1" -> beyond C_two_lines x alpha gamma b d "beyond_2" ->
  holds "exterior" -> exterior body.
Proof.
  intros L1 L2 H; destruct (asks "exterior" _ eq_refl H) as [C | C].
  - apply (exterior_beyond C_two_lines x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P "beyond_1" L1), (asks "exterior_1" _ eq_refl C); reflexivity.
  - apply (exterior_beyond C_two_lines x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P "beyond_2" L2), (asks "exterior_2" _ eq_refl C); reflexivity.
Qed.

Theorem two_lines_interior : within C_two_lines x alpha gamma b d "within_1" -> within C_two_lines x alpha gamma b d "within_2" ->
  holds "interior" -> interior body.
Proof.
  intros L1 L2 H; destruct (asks "interior" _ eq_refl H) as [C | C].
  - apply (interior_within C_two_lines x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P "within_1" L1), (asks "interior_1" _ eq_refl C); reflexivity.
  - apply (interior_within C_two_lines x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P "within_2" L2), (asks "interior_2" _ eq_refl C); reflexivity.
Qed.

(** One chord up to a height, the other from there, in either order, for each side. *)
Theorem two_lines_contact low high n m i j : (n = "under_1" /\ m = "under_2" \/ n = "under_2" /\ m = "under_1") ->
  (i = "above_1" /\ j = "above_2" \/ i = "above_2" /\ j = "above_1") ->
  under C_two_lines x alpha gamma b d n 0 low -> under C_two_lines x alpha gamma b d m low highest ->
  above C_two_lines x alpha gamma b d i 0 high -> above C_two_lines x alpha gamma b d j high highest ->
  holds "contact" -> contact body.
Proof.
  intros N I U1 U2 V1 V2 H; destruct (asks "contact" _ eq_refl H) as [C R]; destruct (asks "contact_in_reach" _ eq_refl C) as [C1 C2].
  destruct (asks "is_under" _ eq_refl C1) as [D1 D2]; destruct (asks "is_above" _ eq_refl C2) as [E1 E2].
  pose proof (asks "is_under_1" _ eq_refl D1 _ _ eq_refl eq_refl) as F1; pose proof (asks "is_under_2" _ eq_refl D2 _ _ eq_refl eq_refl) as F2.
  pose proof (asks "is_above_1" _ eq_refl E1 _ _ eq_refl eq_refl) as G1; pose proof (asks "is_above_2" _ eq_refl E2 _ _ eq_refl eq_refl) as G2.
  cbn [has] in F1, F2, G1, G2; pose proof (height_in_reach C_two_lines x pre holds Runs Compares P ltac:(lra) ltac:(lra) R) as Z.
  assert (W1 : x "R" < x ("line_" ++ n) /\ x "R" < x ("line_" ++ m)) by (destruct N as [[-> ->] | [-> ->]]; split; assumption).
  assert (W2 : x ("line_" ++ i) <= x "R" /\ x ("line_" ++ j) <= x "R") by (destruct I as [[-> ->] | [-> ->]]; split; assumption).
  apply contact_between_chords; try assumption.
  - destruct (Rle_or_lt (x "z" ^ 2) low).
    + apply (not_exterior_under C_two_lines x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P n 0 low U1); [lra | apply W1].
    + apply (not_exterior_under C_two_lines x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P m low highest U2); [unfold highest; lra | apply W1].
  - destruct (Rle_or_lt (x "z" ^ 2) high).
    + apply (not_interior_above C_two_lines x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P i 0 high V1); [lra | apply W2].
    + apply (not_interior_above C_two_lines x pre alpha gamma b d Runs Cap Ha Hg Hb Hd P j high highest V2); [unfold highest; lra | apply W2].
Qed.

End Two.

End Answers.
