(** The position of a spheroid relative to a hyperboloid that ends, and what is enough to prove it, for any axis.

    The hyperboloid ends at a lowest and at a highest height; [None] is an end infinitely far away. Open, it is a wall and
    nothing else. Solid, it is the wall, what is inside it, and the flat ends. *)

Require Import Reals Lra.
From Hypcheck Require Import Geometry Certificates Leaning.
Open Scope R_scope.

Definition above (low : option R) z := match low with Some l => l <= z | None => True end.
Definition below (high : option R) z := match high with Some u => z <= u | None => True end.
Definition well_above (low : option R) z := match low with Some l => l < z | None => True end.
Definition well_below (high : option R) z := match high with Some u => z < u | None => True end.

Definition at_heights low high (X : point) := above low (pz X) /\ below high (pz X).
Definition on_wall p low high X := on_hyperboloid p X /\ at_heights low high X.
Definition in_body p low high X := height p X <= 0 /\ at_heights low high X.
Definition deep_in_body p low high X := height p X < 0 /\ well_above low (pz X) /\ well_below high (pz X).

(** The border of the solid body: the wall and the two flat ends. *)
Definition on_border p low high X := in_body p low high X /\ ~ deep_in_body p low high X.

Definition open_contact p low high := exists X, in_spheroid p X /\ on_wall p low high X.
Definition open_exterior p low high := ~ open_contact p low high /\ ~ in_body p low high (centre p).
Definition open_interior p low high := ~ open_contact p low high /\ in_body p low high (centre p).

Definition solid_contact p low high := exists X, in_spheroid p X /\ on_border p low high X.
Definition solid_exterior p low high := forall X, in_spheroid p X -> ~ in_body p low high X.
Definition solid_interior p low high := forall X, in_spheroid p X -> deep_in_body p low high X.

(** ** At most one position holds; ends infinitely far away change none. *)

Theorem open_positions_exclude_each_other p low high :
  ~ (open_exterior p low high /\ open_contact p low high) /\ ~ (open_interior p low high /\ open_contact p low high)
  /\ ~ (open_exterior p low high /\ open_interior p low high).
Proof. unfold open_exterior, open_interior; tauto. Qed.

Theorem solid_positions_exclude_each_other p low high :
  ~ (solid_exterior p low high /\ solid_contact p low high) /\ ~ (solid_interior p low high /\ solid_contact p low high)
  /\ ~ (solid_exterior p low high /\ solid_interior p low high).
Proof.
  unfold solid_exterior, solid_interior, solid_contact, on_border; repeat split.
  - intros [E (X & S & K & _)]; exact (E X S K).
  - intros [D (X & S & _ & N)]; exact (N (D X S)).
  - intros [E N]; pose proof (N _ (centre_in p)) as (H & A & B); apply (E _ (centre_in p)).
    split; [lra |]; split; [destruct low | destruct high]; simpl in *; try exact I; lra.
Qed.

Lemma one_side p X Y : valid p -> ~ contact p -> in_spheroid p X -> in_spheroid p Y -> 0 < height p X * height p Y.
Proof.
  intros V N HX HY; destruct (Rlt_le_dec 0 (height p X * height p Y)) as [L | L]; [exact L |].
  destruct N; apply contact_by_points with X Y; assumption.
Qed.

Theorem open_without_ends p : valid p -> (open_exterior p None None <-> exterior p)
  /\ (open_contact p None None <-> contact p) /\ (open_interior p None None <-> interior p).
Proof.
  intros V; assert (C : open_contact p None None <-> contact p).
  { split; [intros (X & S & H & _) | intros (X & S & H)]; [apply Geometry.solid_contact with X; assumption |].
    exists X; unfold on_wall, at_heights, in_spheroid, on_spheroid in *; simpl; repeat split; auto; lra. }
  pose proof (positions_exclude_each_other p) as (N1 & N2 & _); pose proof (centre_in p) as M.
  unfold open_exterior, open_interior, in_body, at_heights; simpl; rewrite C; split; [| split; [tauto |]]; split.
  - intros [N H] X HX; pose proof (one_side p X (centre p) V N HX M); nra.
  - intros E; pose proof (E _ M); split; [tauto | lra].
  - intros [N (H & _)] X HX; pose proof (one_side p X (centre p) V N HX M); nra.
  - intros I; pose proof (I _ M); split; [tauto | repeat split; lra].
Qed.

Theorem solid_without_ends p : valid p -> (solid_exterior p None None <-> exterior p)
  /\ (solid_contact p None None <-> contact p) /\ (solid_interior p None None <-> interior p).
Proof.
  intros V; unfold solid_exterior, solid_interior, solid_contact, on_border, in_body, deep_in_body, at_heights; simpl.
  split; [| split]; split.
  - intros H X HX; specialize (H X HX); destruct (Rlt_le_dec 0 (height p X)); [assumption | tauto].
  - intros H X HX; specialize (H X HX); lra.
  - intros (X & S & (H & _) & N); apply Geometry.solid_contact with X; [exact V | exact S |]; unfold on_hyperboloid.
    destruct (Rlt_le_dec (height p X) 0); [tauto | lra].
  - intros (X & S & H); exists X; unfold in_spheroid, on_spheroid, on_hyperboloid in *; repeat split; lra.
  - intros H X HX; apply H, HX.
  - intros H X HX; specialize (H X HX); tauto.
Qed.

(** ** Two points of the solid spheroid prove contact. *)

Lemma heights_convex low high X Y t : at_heights low high X -> at_heights low high Y -> 0 <= t <= 1 ->
  at_heights low high (between X Y t).
Proof.
  intros [A B] [A' B'] T; unfold at_heights, between, add, scale, sub; cbn [pz].
  split; [destruct low | destruct high]; simpl in *; try exact I; nra.
Qed.

Theorem open_contact_by_points p low high X Y : valid p -> in_spheroid p X -> in_spheroid p Y ->
  at_heights low high X -> at_heights low high Y -> height p X * height p Y <= 0 -> open_contact p low high.
Proof.
  intros V HX HY AX AY S; destruct (segment_meets p X Y S) as (t & T & E); exists (between X Y t).
  split; [apply spheroid_convex; assumption | split; [exact E | apply heights_convex; assumption]].
Qed.

(** The touching points may be irrational: then a level line through them is rational. *)
Theorem open_contact_by_line p low high m X u : valid p -> m <> 0 -> in_spheroid p X -> at_heights low high X ->
  0 < dot u u -> pz u = 0 -> (forall t, pencil p m (add X (scale t u)) = 0) -> open_contact p low high.
Proof.
  intros V M HX A U L P; destruct (line_meets_spheroid p X u V HX U) as [t T]; exists (add X (scale t u)).
  specialize (P t); unfold pencil, on_spheroid, in_spheroid, on_wall, on_hyperboloid, at_heights in *; rewrite T in P |- *.
  replace (pz (add X (scale t u))) with (pz X) by (unfold add, scale; cbn [pz]; rewrite L; ring).
  split; [lra | split; [apply Rmult_eq_reg_l with m; lra | exact A]].
Qed.

Definition larger (a b : R) := (a + b + Rabs (a - b)) / 2.

Lemma larger_is a b : (larger a b = a /\ b <= a) \/ (larger a b = b /\ a <= b).
Proof. unfold larger, Rabs; destruct (Rcase_abs (a - b)); [right | left]; lra. Qed.

Lemma larger_continuous f g : continuity f -> continuity g -> continuity (fun t => larger (f t) (g t)).
Proof.
  intros F G; unfold larger, Rdiv; apply (continuity_mult (fun t => f t + g t + Rabs (f t - g t)) (fun _ => / 2)).
  - apply (continuity_plus (fun t => f t + g t)); [apply continuity_plus; assumption |].
    apply (continuity_comp (fun t => f t - g t) Rabs); [apply continuity_minus; assumption | exact Rcontinuity_abs].
  - apply continuity_const; unfold constant; reflexivity.
Qed.

Theorem solid_contact_by_points p low high X Y : valid p -> in_spheroid p X -> in_spheroid p Y ->
  in_body p low high X -> ~ deep_in_body p low high Y -> solid_contact p low high.
Proof.
  intros V HX HY KX KY.
  set (l := match low with Some l => l | None => Rmin (pz X) (pz Y) - 1 end).
  set (u := match high with Some u => u | None => Rmax (pz X) (pz Y) + 1 end).
  set (z := fun t => pz X + t * (pz Y - pz X)); set (h := fun t => height p (between X Y t)).
  set (f := fun t => larger (h t) (larger (l - z t) (z t - u))).
  assert (Cz : continuity z) by (unfold z; reg).
  assert (C : continuity f).
  { unfold f; apply larger_continuous; [| apply larger_continuous].
    - unfold h, height, between, add, scale, sub, Rdiv; simpl; reg.
    - apply (continuity_minus (fun _ => l)); [apply continuity_const; unfold constant; reflexivity | exact Cz].
    - apply (continuity_minus z); [exact Cz | apply continuity_const; unfold constant; reflexivity]. }
  assert (H0 : h 0 = height p X) by (unfold h, height, between, add, scale, sub, Rdiv; simpl; ring).
  assert (H1 : h 1 = height p Y) by (unfold h, height, between, add, scale, sub, Rdiv; simpl; ring).
  assert (Z0 : z 0 = pz X) by (unfold z; ring); assert (Z1 : z 1 = pz Y) by (unfold z; ring).
  assert (ML : Rmin (pz X) (pz Y) <= pz X /\ Rmin (pz X) (pz Y) <= pz Y) by (split; [apply Rmin_l | apply Rmin_r]).
  assert (MR : pz X <= Rmax (pz X) (pz Y) /\ pz Y <= Rmax (pz X) (pz Y)) by (split; [apply Rmax_l | apply Rmax_r]).
  assert (F : forall t, f t = h t /\ l - z t <= h t /\ z t - u <= h t
    \/ f t = l - z t /\ h t <= l - z t /\ z t - u <= l - z t \/ f t = z t - u /\ h t <= z t - u /\ l - z t <= z t - u).
  { intros t; unfold f; destruct (larger_is (l - z t) (z t - u)) as [[-> A] | [-> A]];
      [destruct (larger_is (h t) (l - z t)) as [[-> B] | [-> B]] | destruct (larger_is (h t) (z t - u)) as [[-> B] | [-> B]]]; lra. }
  assert (S : f 0 <= 0).
  { destruct KX as (K & A & B); pose proof (F 0) as F0; rewrite H0, Z0 in F0; unfold l, u in F0; destruct low, high; simpl in *; lra. }
  assert (N : 0 <= f 1).
  { destruct (Rle_lt_dec 0 (f 1)) as [L | L]; [exact L | destruct KY].
    pose proof (F 1) as F1; rewrite H1, Z1 in F1; unfold l, u in F1.
    split; [lra |]; split; [destruct low | destruct high]; simpl in *; try exact I; lra. }
  destruct (IVT_cor f 0 1 C) as (t & T & E); [lra | nra |].
  exists (between X Y t); split; [apply spheroid_convex; assumption |].
  assert (Zt : pz (between X Y t) = z t) by reflexivity; assert (Ht : height p (between X Y t) = h t) by reflexivity.
  assert (Bl : low = None -> l < z t) by (intros EL; unfold l, z; rewrite EL; nra).
  assert (Bu : high = None -> z t < u) by (intros EU; unfold u, z; rewrite EU; nra).
  pose proof (F t) as Ft; unfold on_border, in_body, deep_in_body, at_heights; rewrite Zt, Ht.
  assert (Ends : l <= z t <= u /\ h t <= 0) by lra; split.
  - split; [tauto |]; split; [destruct low | destruct high]; simpl; try exact I; unfold l, u in Ends; lra.
  - intros (D & A & B).
    assert (l < z t) by (destruct low; [exact A | auto]); assert (z t < u) by (destruct high; [exact B | auto]); lra.
Qed.

(** ** A piece between two heights, with a multiplier and a number mu >= 0, proves that the wall is missed there. *)

(** Not positive between the heights. *)
Definition beyond low high z := match low, high with
  | Some l, Some u => (z - l) * (z - u) | Some l, None => l - z | None, Some u => z - u | None, None => 0 end.

Lemma not_beyond low high X : at_heights low high X -> beyond low high (pz X) <= 0.
Proof. intros [A B]; destruct low, high; simpl in *; try lra; nra. Qed.

Definition clear_there p low high l mu := 0 <= mu /\ forall X, 0 < pencil p l X + mu * beyond low high (pz X).

Lemma missed_on_piece p low high l mu X : clear_there p low high l mu -> at_heights low high X ->
  height p X = 0 \/ 0 <= l /\ height p X <= 0 -> 0 < depth p X.
Proof.
  intros [M P] A H; specialize (P X); pose proof (not_beyond _ _ _ A) as B; unfold pencil in P.
  assert (mu * beyond low high (pz X) <= 0) by nra.
  destruct H as [H | [L H]]; [rewrite H in P; lra |]; assert (l * height p X <= 0) by nra; lra.
Qed.

(** Every height of the wall is one of a piece. *)
Definition covered p low high solid := forall X, at_heights low high X ->
  exists from till l mu, at_heights from till X /\ clear_there p from till l mu /\ (solid = true -> 0 <= l).

Theorem wall_missed p low high solid : covered p low high solid -> ~ open_contact p low high.
Proof.
  intros C (X & S & H & A); destruct (C X A) as (from & till & l & mu & B & P & _).
  pose proof (missed_on_piece _ _ _ _ _ _ P B (or_introl H)); unfold in_spheroid in S; lra.
Qed.

Theorem body_missed p low high : covered p low high true -> solid_exterior p low high.
Proof.
  intros C X S (H & A); destruct (C X A) as (from & till & l & mu & B & P & L).
  pose proof (missed_on_piece _ _ _ _ _ _ P B (or_intror (conj (L eq_refl) H))); unfold in_spheroid in S; lra.
Qed.

(** With the multiplier 0 such a piece proves that the spheroid does not reach its heights. *)
Definition not_reached p low high := exists mu, clear_there p low high 0 mu.

Lemma never_there p low high X : not_reached p low high -> in_spheroid p X -> ~ at_heights low high X.
Proof.
  intros (mu & M & P) S A; specialize (P X); pose proof (not_beyond _ _ _ A); unfold pencil, in_spheroid in *; nra.
Qed.

Theorem solid_interior_by_pieces p low high : interior p -> (forall l, low = Some l -> not_reached p None (Some l)) ->
  (forall u, high = Some u -> not_reached p (Some u) None) -> solid_interior p low high.
Proof.
  intros N L U X S; split; [apply N, S |]; split.
  - destruct low as [l |]; simpl; [| exact I]; pose proof (never_there _ _ _ _ (L l eq_refl) S) as F.
    unfold at_heights in F; simpl in F; lra.
  - destruct high as [u |]; simpl; [| exact I]; pose proof (never_there _ _ _ _ (U u eq_refl) S) as F.
    unfold at_heights in F; simpl in F; lra.
Qed.

(** ** The form of a piece: that of the pencil, and a quadratic in the height. *)

Definition curve_2 (low high : option R) := match low, high with Some _, Some _ => 1 | _, _ => 0 end.
Definition curve_1 low high := match low, high with
  | Some l, Some u => - ((l + u) / 2) | Some _, None => - (1 / 2) | None, Some _ => 1 / 2 | None, None => 0 end.
Definition curve_0 low high := match low, high with
  | Some l, Some u => l * u | Some l, None => l | None, Some u => - u | None, None => 0 end.

Lemma beyond_is low high z : beyond low high z = curve_2 low high * z ^ 2 + 2 * curve_1 low high * z + curve_0 low high.
Proof. destruct low, high; simpl; lra. Qed.

Section Form.

Variables alpha gamma b d : R.
Variable v : point.
Hypotheses (Ha : 0 < alpha) (Hg : 0 < gamma) (Hb : 0 < b) (Hd : 0 < d) (Hv : 0 < dot v v).

Let all := factor alpha gamma * weight b d v.

Definition piece_form low high l mu (C : point) :=
  let xy := factor alpha gamma * mass b d v px py 0 in let xz := factor alpha gamma * mass b d v px pz 0 in
  let yz := factor alpha gamma * mass b d v py pz 0 in let s1 := pull_x alpha gamma b d v C in let s2 := pull_y alpha gamma b d v C in
  let s3 := pull_z alpha gamma b d v C + all * mu * curve_1 low high in
  let s0 := rest alpha gamma b d v l C C + all * mu * curve_0 low high in
  between4 (entry_xx alpha gamma b d v l) xy xz (entry_yy alpha gamma b d v l) yz
    (entry_zz alpha gamma b d v l + all * mu * curve_2 low high) s1 s2 s3 s1 s2 s3 s0 s0 s0.

Theorem clear_by_form low high l mu C : 0 <= mu -> piece_form low high l mu C -> clear_there (tilted alpha gamma b d v C) low high l mu.
Proof.
  intros M B; split; [exact M |]; intros X; unfold piece_form in B.
  assert (W : 0 <= 0 <= 1) by lra; pose proof (between4_positive 0 W _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ (px X) (py X) (pz X) B) as P.
  assert (K : 0 < all) by (unfold all; apply scale_positive; assumption).
  apply Rmult_lt_reg_l with all; [exact K |]; rewrite Rmult_0_r, Rmult_plus_distr_l, beyond_is; unfold all at 1.
  rewrite <- form_is_pencil by assumption.
  match type of P with 0 < ?k => match goal with |- 0 < ?f => replace f with k; [exact P |] end end.
  unfold form, mixed, mixed_twice, all; ring.
Qed.

End Form.

(** ** Another unit of length, and an axis of another length, change no position. *)

Section Unit.

Variables (p : pair) (k j : R) (low high : option R).
Hypotheses (K : 0 < k) (J : 0 < j) (Valid : valid p).
Let p' := Pair (k * alpha p) (k * gamma p) (k * b p) (k * d p) (scale j (axis p)) (scale k (centre p)).
Let low' := option_map (Rmult k) low.
Let high' := option_map (Rmult k) high.

Let same X : (in_spheroid p' (scale k X) <-> in_spheroid p X) /\ (on_wall p' low' high' (scale k X) <-> on_wall p low high X)
  /\ (in_body p' low' high' (scale k X) <-> in_body p low high X)
  /\ (deep_in_body p' low' high' (scale k X) <-> deep_in_body p low high X).
Proof.
  unfold in_spheroid, on_wall, in_body, deep_in_body, on_hyperboloid, at_heights.
  pose proof (same_depth p k j K J Valid X) as D; pose proof (same_height p k j K Valid X) as H; fold p' in D, H; rewrite D, H.
  assert (A : (above low' (pz (scale k X)) <-> above low (pz X)) /\ (well_above low' (pz (scale k X)) <-> well_above low (pz X))).
  { unfold low', scale; destruct low; cbn [option_map above well_above pz]; split; try tauto; split; intros; nra. }
  assert (B : (below high' (pz (scale k X)) <-> below high (pz X)) /\ (well_below high' (pz (scale k X)) <-> well_below high (pz X))).
  { unfold high', scale; destruct high; cbn [option_map below well_below pz]; split; try tauto; split; intros; nra. }
  tauto.
Qed.

Let there Y : Y = scale k (scale (/ k) Y).
Proof. apply point_eq; unfold scale; cbn; field; lra. Qed.

Let its_centre : centre p' = scale k (centre p).
Proof. reflexivity. Qed.

Theorem same_ended_positions : (open_contact p' low' high' -> open_contact p low high)
  /\ (open_exterior p' low' high' -> open_exterior p low high) /\ (open_interior p' low' high' -> open_interior p low high)
  /\ (solid_contact p' low' high' -> solid_contact p low high)
  /\ (solid_exterior p' low' high' -> solid_exterior p low high) /\ (solid_interior p' low' high' -> solid_interior p low high).
Proof.
  assert (C : open_contact p' low' high' <-> open_contact p low high).
  { split; intros (Y & S & W).
    - rewrite (there Y) in S, W; apply same in S; apply same in W; exists (scale (/ k) Y); tauto.
    - exists (scale k Y); split; apply same; assumption. }
  pose proof (same (centre p)) as (_ & _ & M & _); rewrite <- its_centre in M.
  unfold open_exterior, open_interior; rewrite C, M; split; [tauto |]; split; [tauto |]; split; [tauto |]; split; [| split].
  - intros (Y & S & W & N); rewrite (there Y) in S, W, N; apply same in S; apply same in W.
    exists (scale (/ k) Y); repeat split; try apply W; try exact S; intros Q; apply N, same, Q.
  - intros H X S W; apply (H (scale k X)); apply same; assumption.
  - intros H X S; apply same, H, same, S.
Qed.

End Unit.
