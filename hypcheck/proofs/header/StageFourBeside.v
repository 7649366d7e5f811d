(** Stage 4: the function of the header that decides beside a tangency, run by Coq: where its text returns a position, it is one that
    Stages.v answers.

    A coordinate is a hair where its size is below the product of 10^-18 and b, or gamma, which floats compute: of that product it is
    assumed that it is no more than 2^-31 of b, or gamma. The lengths as whole numbers are what hc_short_lengths puts; what it returns is
    assumed here. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Hypcheck Require Import Geometry Tangency Steps Fixed FixedRuns Limbs Trees PlainerTexts StageThreeRuns StageThreeAnswers StageThreeNumbers StageThreePosition
  Stages Positions StageFour StageFourSteps StageFourGuesses.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** The text of the functions. *)
Definition functions := Eval vm_compute in
  match every (map (fun text => read_from (string_of text)) HeaderText.beside_tangency) with Some l => l | None => [] end.

(** ** What it calls. *)

Section Calls.
Variables (hair : Z -> Z -> Z * Z) (plane short long : list datum -> option datum).
Definition of_beside : list (string * (list datum -> option datum)) := [
  ("<", fun given => match given with [Double m e; Of Int 0] => Some (Of Int (carry m 0)) | _ => None end);
  (">", fun given => match given with [Double m e; Of Int 0] => Some (Of Int (carry 0 m)) | _ => None end);
  ("-", fun given => match given with [Of Int 0; Double m e] => Some (Double (- m) e) | _ => None end);
  ("*", fun given => match given with [Opaque _ 0; Double m e] => Some (Double (fst (hair m e)) (snd (hair m e))) | _ => None end);
  ("hc_position_in_plane", plane); ("hc_touches_by_short", short); ("hc_touches_by", long)].
End Calls.

Definition two := Constant Int 2.
Definition is_two n := Infix "==" (Named n) two.
Definition hair_of n := Infix "*" (Named "_1e-18") n.
Definition in_row i := Part (Named "row") i.
Definition a_turn := [Set_ "double" "size" (Choice (Infix "<" (in_row (Named "i")) (Constant Int 0)) (Infix "-" (Constant Int 0) (in_row (Named "i"))) (in_row (Named "i")));
  If (Infix "&&" (Infix ">" (Named "size") (Constant Int 0)) (Infix "<" (Named "size") (hair_of (in_row (Choice (Infix "==" (Named "i") (Constant Int 6)) (Constant Int 1) two)))))
    [Place "bare" (Named "i") (Constant Int 0); If (Infix "==" (Named "i") (Constant Int 6)) [Set_ "" "axial" (Constant Int 1)] [Set_ "" "radial" (Constant Int 1)]] []].
Definition turns := Turns "i" (Constant Int 7) (Constant Int 1) a_turn.
Definition asks := [If (Infix "&&" (Named "radial") (Named "axial")) [Set_ "" "bits" (Constant Int 64)] [Calling "hc_short_lengths" [Named "bare"; Named "bits"; Named "lengths"]];
  If (Infix ">" (Named "bits") (Constant Int 62)) [Returns two] [];
  Set_ "" "side" (Choice (Infix "||" (Infix "||" (Named "radial") (Named "axial")) (Part (Named "lengths") (Constant Int 6))) two (Called "hc_position_in_plane" [Named "lengths"]));
  If (Infix "!=" (Named "side") two) [Returns (Named "side")] [];
  Set_ "" "side" (Choice (Infix "<=" (Named "bits") (Constant Int 23)) (Called "hc_touches_by_short" [Named "lengths"; Named "about"]) (Called "hc_touches_by" [Named "lengths"; Named "about"]));
  If (is_two "side") [Returns two] [];
  Returns (Choice (Choice (Infix ">" (Named "side") (Constant Int 0)) (Named "radial") (Named "axial")) (Named "side") (Constant Int 0))].
Theorem text_is : look "hc_position_beside_tangency" functions = Some (Deciding ["row"; "about"] ([Set_ "int" "radial" (Constant Int 0); Set_ "int" "axial" (Constant Int 0);
  Set_ "" "bare" (Named "row"); Set_ "" "i" (Constant Int 4); turns] ++ asks)).
Proof. vm_compute; reflexivity. Qed.

(** ** Behind the loop. *)

Lemma go_calls known procedures f now g given rest k m l got now' : look g procedures = Some (k, m) -> every (map (eval known now) (firstn k given)) = Some l ->
  m l = Some got -> bound_all (skipn k given) got now = Some now' -> go known procedures (S f) now (Calling g given :: rest) = go known procedures f now' rest.
Proof. intros K L M B; cbn [go]; rewrite K, L, M, B; reflexivity. Qed.

Section Asked.
Variables (hair : Z -> Z -> Z * Z) (plane short long : list datum -> option datum) (put_lengths : list datum -> option (list datum)).
Notation known := (of_beside hair plane short long).
Definition procedures := [("hc_short_lengths", (1%nat, put_lengths))].
Variables (now : environment) (radial axial : bool) (l : list (string * datum)) (about : datum) (bits : Z) (got : list (string * datum)) (ls : string -> Z) (o : option answer) (by_short by_long : Z).
Hypotheses (Radial : look "radial" now = Some (Of Int (bit radial))) (Axial : look "axial" now = Some (Of Int (bit axial)))
  (Bare : eval known now (Named "bare") = Some (Rec l)) (About : look "about" now = Some about) (New : look "lengths" now = None /\ fields "lengths" now = [])
  (Put : radial && axial = false -> put_lengths [Rec l] = Some [Of Int bits; Rec got]) (Got : bits <= 62 -> got = words_of_lengths ls)
  (Plane : bits <= 62 -> plane [Rec (words_of_lengths ls)] = Some (Of Int (code o))) (Short : bits <= 23 -> short [Rec (words_of_lengths ls); about] = Some (Of Int by_short))
  (Long : bits <= 62 -> long [Rec (words_of_lengths ls); about] = Some (Of Int by_long)).

Definition side := if bits <=? 23 then by_short else by_long.
Definition of_side := if side =? 2 then 2 else if (if 0 <? side then radial else axial) then side else 0.
Definition answered := if radial && axial then 2 else if 62 <? bits then 2
  else if negb (radial || axial || negb (ls "z" =? 0)) && negb (code o =? 2) then code o else of_side.

Lemma eval_bit n b e : look n e = Some (Of Int (bit b)) -> eval known e (Named n) = Some (Of Int (bit b)).
Proof. apply eval_named. Qed.
Theorem asks_run f : exists now', go known procedures (12 + f) now asks = Some (Some (Of Int answered), now').
Proof.
  unfold asks, answered; cbn [Nat.add].
  rewrite (go_if _ _ _ _ _ _ _ _ (radial && axial) (eval_both known now _ _ _ _ (eval_bit _ _ _ Radial) (eval_bit _ _ _ Axial))).
  destruct (radial && axial) eqn:Both; cbn [app].
  { erewrite (go_put _ _ _ _ "" "bits"); [| reflexivity | reflexivity | reflexivity]; eexists; reflexivity. }
  rewrite (go_calls _ _ _ _ "hc_short_lengths" [Named "bare"; Named "bits"; Named "lengths"] _ 1%nat put_lengths [Rec l] [Of Int bits; Rec got]
    (map (fun f => ("lengths" ++ "." ++ fst f, snd f)%string) got ++ ("bits", Of Int bits) :: now)%list); [| reflexivity | cbn [firstn map every]; rewrite Bare; reflexivity | exact (Put eq_refl) | reflexivity].
  set (now1 := (map _ got ++ _)%list).
  assert (B : look "bits" now1 = Some (Of Int bits)).
  { unfold now1; rewrite look_pushed; [reflexivity |].
    assert (P : forall k : list (string * datum), is_in "bits" (map fst (map (fun f => ("lengths" ++ "." ++ fst f, snd f)%string) k)) = false)
      by (induction k as [| p k IH]; [reflexivity |]; cbn; exact IH); apply P. }
  assert (C : eval known now1 (Infix ">" (Named "bits") (Constant Int 62)) = Some (Of Int (bit (62 <? bits))))
    by (eapply eval_infix; [reflexivity | apply eval_named, B | reflexivity | unfold plain_infix; cbn; unfold carry; destruct (62 <? bits); reflexivity]).
  rewrite (go_if _ _ _ _ _ _ _ _ _ C); clear C; destruct (62 <? bits) eqn:L; cbn [app]; [eexists; reflexivity |]; apply Z.ltb_ge in L.
  assert (E1 : now1 = (map (fun f => ("lengths" ++ "." ++ fst f, snd f)%string) (words_of_lengths ls) ++ ("bits", Of Int bits) :: now)%list) by (unfold now1; rewrite (Got L); reflexivity).
  clearbody now1; subst now1; set (now1 := (map _ (words_of_lengths ls) ++ _)%list) in *.
  assert (R1 : look "radial" now1 = Some (Of Int (bit radial))) by exact Radial; assert (A1 : look "axial" now1 = Some (Of Int (bit axial))) by exact Axial;
    assert (O1 : look "about" now1 = Some about) by exact About.
  assert (Z1 : eval known now1 (Part (Named "lengths") (Constant Int 6)) = Some (Of U64 (ls "z"))).
  { cbn [eval]; change (look "lengths" now1) with (look "lengths" now); rewrite (proj1 New); reflexivity. }
  assert (L1 : eval known now1 (Named "lengths") = Some (Rec (words_of_lengths ls))).
  { cbn [eval]; change (look "lengths" now1) with (look "lengths" now); rewrite (proj1 New).
    change (fields "lengths" now1) with (words_of_lengths ls ++ fields "lengths" now)%list; rewrite (proj2 New); reflexivity. }
  clearbody now1.
  (* the plane *)
  set (beside := radial || axial || negb (ls "z" =? 0)).
  assert (D : eval known now1 (Infix "||" (Infix "||" (Named "radial") (Named "axial")) (Part (Named "lengths") (Constant Int 6))) = Some (Of Int (bit beside))).
  { rewrite (eval_or _ _ _ _ _ _ _ _ (eval_or _ _ _ _ _ _ _ _ (eval_bit _ _ _ R1) (eval_bit _ _ _ A1)) Z1); unfold beside; destruct radial, axial, (ls "z" =? 0); reflexivity. }
  assert (P : eval known now1 (Called "hc_position_in_plane" [Named "lengths"]) = Some (Of Int (code o)))
    by (eapply eval_given; [reflexivity | apply given_more; [exact L1 | reflexivity] | exact (Plane L)]).
  set (first := if beside then 2 else code o).
  assert (S1 : eval known now1 (Choice (Infix "||" (Infix "||" (Named "radial") (Named "axial")) (Part (Named "lengths") (Constant Int 6))) two (Called "hc_position_in_plane" [Named "lengths"]))
    = Some (Of Int first)) by (rewrite (eval_chosen _ _ _ _ _ _ _ D); unfold first; destruct beside; [reflexivity | exact P]).
  rewrite (go_put _ _ _ _ "" "side" _ _ _ _ eq_refl S1 eq_refl); cbn [bound]; set (now2 := ("side", _) :: now1).
  assert (N : eval known now2 (Infix "!=" (Named "side") two) = Some (Of Int (bit (negb (first =? 2))))).
  { eapply eval_infix; [reflexivity | apply eval_named; reflexivity | reflexivity | unfold plain_infix; cbn; unfold same; destruct (first =? 2); reflexivity]. }
  rewrite (go_if _ _ _ _ _ _ _ _ _ N); clear N.
  assert (first_is : negb beside && negb (code o =? 2) = negb (first =? 2)) by (unfold first; destruct beside; reflexivity).
  rewrite first_is; destruct (first =? 2) eqn:F; cbn [negb app]; [| erewrite go_return by (apply eval_named; reflexivity)].
  2: { unfold first in *; destruct beside; [discriminate |]; eexists; reflexivity. }
  (* a tangency *)
  assert (B2 : eval known now2 (Infix "<=" (Named "bits") (Constant Int 23)) = Some (Of Int (bit (bits <=? 23)))).
  { eapply eval_infix; [reflexivity | apply eval_named; exact B | reflexivity | unfold plain_infix; cbn; unfold carry; destruct (Z.ltb_spec 23 bits), (Z.leb_spec bits 23); (reflexivity || lia)]. }
  assert (L2 : eval known now2 (Named "lengths") = Some (Rec (words_of_lengths ls))) by exact L1.
  assert (O2 : eval known now2 (Named "about") = Some about) by (apply eval_named; exact O1).
  assert (S2 : eval known now2 (Choice (Infix "<=" (Named "bits") (Constant Int 23)) (Called "hc_touches_by_short" [Named "lengths"; Named "about"]) (Called "hc_touches_by" [Named "lengths"; Named "about"]))
    = Some (Of Int side)).
  { rewrite (eval_chosen _ _ _ _ _ _ _ B2); unfold side; destruct (Z.leb_spec bits 23); cbn [bit Z.eqb];
      (eapply eval_given; [reflexivity | apply given_more; [exact L2 | apply given_more; [exact O2 | reflexivity]] |]); [apply Short | apply Long]; assumption. }
  rewrite (go_put _ _ _ _ "" "side" _ _ _ _ eq_refl S2 eq_refl); cbn [bound]; set (now3 := ("side", _) :: now2).
  assert (T : eval known now3 (is_two "side") = Some (Of Int (bit (side =? 2)))).
  { eapply eval_infix; [reflexivity | apply eval_named; reflexivity | reflexivity | unfold plain_infix; cbn; unfold same; destruct (side =? 2); reflexivity]. }
  rewrite (go_if _ _ _ _ _ _ _ _ _ T); clear T; unfold of_side; destruct (side =? 2); cbn [app]; [eexists; reflexivity |].
  assert (G : eval known now3 (Infix ">" (Named "side") (Constant Int 0)) = Some (Of Int (bit (0 <? side)))).
  { eapply eval_infix; [reflexivity | apply eval_named; reflexivity | reflexivity | unfold plain_infix; cbn; unfold carry; destruct (0 <? side); reflexivity]. }
  assert (H : eval known now3 (Choice (Infix ">" (Named "side") (Constant Int 0)) (Named "radial") (Named "axial")) = Some (Of Int (bit (if 0 <? side then radial else axial)))).
  { rewrite (eval_chosen _ _ _ _ _ _ _ G); destruct (0 <? side); apply eval_named; [exact R1 | exact A1]. }
  eexists; rewrite (go_return _ _ _ _ _ _ (Of Int (if (if 0 <? side then radial else axial) then side else 0))); [reflexivity |].
  rewrite (eval_chosen _ _ _ _ _ _ _ H); destruct (if 0 <? side then radial else axial); [apply eval_named |]; reflexivity.
Qed.
End Asked.

(** ** The loop. *)

Lemma eval_op known now o l r d c f : is_float d -> is_double d && is_double c = false -> eval known now l = Some d -> eval known now r = Some c ->
  look o known = Some f -> eval known now (Infix o l r) = f [d; c].
Proof. intros F B L R M; cbn [eval]; rewrite L, R, M; destruct d; try contradiction; [destruct c; try reflexivity; discriminate | reflexivity]. Qed.
Lemma eval_int_op known now o l r t x k j f : is_in o ["&&"; "||"] = false -> eval known now l = Some (Of t x) -> eval known now r = Some (Double k j) ->
  look o known = Some f -> eval known now (Infix o l r) = f [Of t x; Double k j].
Proof.
  intros O L R M; unfold is_in in O; cbn [existsb] in O; apply orb_false_elim in O as [O1 O2]; apply orb_false_elim in O2 as [O2 _].
  cbn [eval]; rewrite L, O1, O2, R, M; reflexivity.
Qed.
Lemma eval_compared known now o l r k p j q z : eval known now l = Some (Double k p) -> eval known now r = Some (Double j q) -> compare_doubles o k p j q = Some z ->
  eval known now (Infix o l r) = Some (Of Int z).
Proof. intros L R C; cbn [eval]; rewrite L, R, C; reflexivity. Qed.

Section Row.
Variables (m e : string -> Z) (hair : Z -> Z -> Z * Z) (plane short long : list datum -> option datum) (put_lengths : list datum -> option (list datum)) (about : datum).
Notation known := (of_beside hair plane short long).
Notation procedures := (procedures put_lengths).

Definition below k p j q := in_unit k p q <? in_unit j q p.
Definition is_hair n w := (0 <? Z.abs (m n)) && below (Z.abs (m n)) (e n) (fst (hair (m w) (e w))) (snd (hair (m w) (e w))).
Definition is_bare n := if is_in n ["x"; "y"] then is_hair n "b" else if is "z" n then is_hair n "gamma" else false.
Definition bare_m n := if is_bare n then 0 else m n.
Definition bare_e n := if is_bare n then -4096 else e n.

Lemma go_turn f now rest l now' j i k : look i now = Some (Of Int k) -> k < 7 -> go known procedures f now l = Some (None, now') ->
  eval known (outside l now') (Infix "+" (Named i) (Constant Int 1)) = Some (Of Int j) ->
  go known procedures (S f) now (Turns i (Constant Int 7) (Constant Int 1) l :: rest)
    = go known procedures f ((i, Of Int j) :: outside l now') (Turns i (Constant Int 7) (Constant Int 1) l :: rest).
Proof.
  intros I K G J; cbn [go].
  assert (E : eval known now (Infix "<" (Named i) (Constant Int 7)) = Some (Of Int 1)).
  { eapply eval_infix; [reflexivity | apply eval_named, I | reflexivity |]; unfold plain_infix; cbn; unfold carry; rewrite (proj2 (Z.ltb_lt k 7) K); reflexivity. }
  rewrite E; cbn [Z.eqb]; rewrite G, J; reflexivity.
Qed.

Lemma go_turns_end f now rest l i k : look i now = Some (Of Int k) -> k = 7 -> go known procedures (S f) now (Turns i (Constant Int 7) (Constant Int 1) l :: rest) = go known procedures f now rest.
Proof.
  intros I ->; cbn [go]; assert (E : eval known now (Infix "<" (Named i) (Constant Int 7)) = Some (Of Int 0))
    by (eapply eval_infix; [reflexivity | apply eval_named, I | reflexivity | reflexivity]); rewrite E; reflexivity.
Qed.
Lemma same_environment f now now' rest : now = now' -> go known procedures f now rest = go known procedures f now' rest.
Proof. intros ->; reflexivity. Qed.

Definition begun_row : environment := [("about", about); ("row.0", Double (m "alpha") (e "alpha")); ("row.1", Double (m "gamma") (e "gamma")); ("row.2", Double (m "b") (e "b"));
  ("row.3", Double (m "d") (e "d")); ("row.4", Double (m "x") (e "x")); ("row.5", Double (m "y") (e "y")); ("row.6", Double (m "z") (e "z")); ("_1e-18", Opaque "1e-18" 0)].

(** One turn, for a coordinate and the length that it is a hair of. *)
Definition turned p n w flag (now : environment) : environment := let size := ("size", Double (Z.abs (m n)) (e n)) in
  if is_hair n w then (flag, Of Int 1) :: ("bare." ++ p, Double 0 (-4096)) :: size :: now else size :: now.
Lemma turn_runs f now i p n w q flag : look "i" now = Some (Of Int i) -> place i = Some p -> look "row" now = None -> look p (fields "row" now) = Some (Double (m n) (e n)) ->
  (if i =? 6 then q = "1" /\ flag = "axial" else q = "2" /\ flag = "radial") -> look q (fields "row" now) = Some (Double (m w) (e w)) ->
  look "_1e-18" now = Some (Opaque "1e-18" 0) -> look "size" now = None -> (exists k j, look ("bare." ++ p) now = Some (Double k j)) ->
  go known procedures (6 + f) now a_turn = Some (None, turned p n w flag now).
Proof.
  intros I P R X Q B H S (k & j & E); unfold a_turn; cbn [Nat.add].
  assert (row_at : forall a now1 t r d, eval known now1 a = Some (Of Int t) -> place t = Some r -> look "row" now1 = None -> look r (fields "row" now1) = Some d ->
    eval known now1 (Part (Named "row") a) = Some d).
  { intros a now1 t r d A T N L; cbn [eval]; rewrite A, N; destruct (fields "row" now1); [discriminate |]; rewrite T; exact L. }
  pose proof (row_at (Named "i") now i p _ (eval_named _ _ _ _ I) P R X) as X0.
  assert (V : eval known now (Choice (Infix "<" (in_row (Named "i")) (Constant Int 0)) (Infix "-" (Constant Int 0) (in_row (Named "i"))) (in_row (Named "i"))) = Some (Double (Z.abs (m n)) (e n))).
  { unfold in_row; rewrite (eval_chosen _ _ _ _ _ Int (carry (m n) 0)).
    - unfold carry; destruct (Z.ltb_spec (m n) 0); cbn [Z.eqb].
      + eapply eq_trans; [eapply eval_int_op; [reflexivity | reflexivity | exact X0 | reflexivity] |]; cbn; rewrite Z.abs_neq by lia; reflexivity.
      + rewrite Z.abs_eq by lia; exact X0.
    - eapply eq_trans; [eapply (eval_op _ _ _ _ _ (Double (m n) (e n)) (Of Int 0)); [exact Logic.I | reflexivity | exact X0 | reflexivity | reflexivity] | reflexivity]. }
  assert (New : is_new "double" "size" now = true) by (unfold is_new; rewrite S; reflexivity).
  rewrite (go_put _ _ _ _ "double" "size" _ _ _ (Double (Z.abs (m n)) (e n)) New V eq_refl); cbn [bound]; set (now1 := ("size", _) :: now).
  assert (Size : eval known now1 (Named "size") = Some (Double (Z.abs (m n)) (e n))) by (apply eval_named; reflexivity).
  assert (C1 : eval known now1 (Infix ">" (Named "size") (Constant Int 0)) = Some (Of Int (bit (0 <? Z.abs (m n)))))
    by (eapply eq_trans; [eapply (eval_op _ _ _ _ _ (Double (Z.abs (m n)) (e n)) (Of Int 0)); [exact Logic.I | reflexivity | exact Size | reflexivity | reflexivity] | reflexivity]).
  assert (index : eval known now1 (Choice (Infix "==" (Named "i") (Constant Int 6)) (Constant Int 1) two) = Some (Of Int (if i =? 6 then 1 else 2))).
  { rewrite (eval_chosen _ _ _ _ _ Int (same i 6)); [unfold same; destruct (i =? 6); reflexivity |].
    eapply eval_infix; [reflexivity | apply eval_named; exact I | reflexivity | reflexivity]. }
  assert (B1 : eval known now1 (in_row (Choice (Infix "==" (Named "i") (Constant Int 6)) (Constant Int 1) two)) = Some (Double (m w) (e w))).
  { eapply row_at; [exact index | | exact R | exact B]; destruct (i =? 6), Q as [-> _]; reflexivity. }
  assert (C2 : eval known now1 (Infix "<" (Named "size") (hair_of (in_row (Choice (Infix "==" (Named "i") (Constant Int 6)) (Constant Int 1) two))))
    = Some (Of Int (bit (below (Z.abs (m n)) (e n) (fst (hair (m w) (e w))) (snd (hair (m w) (e w))))))).
  { assert (Product : eval known now1 (hair_of (in_row (Choice (Infix "==" (Named "i") (Constant Int 6)) (Constant Int 1) two))) = Some (Double (fst (hair (m w) (e w))) (snd (hair (m w) (e w))))).
    { unfold hair_of; eapply eq_trans; [eapply (eval_op _ _ _ _ _ (Opaque "1e-18" 0) (Double (m w) (e w))); [exact Logic.I | reflexivity | apply eval_named; exact H | exact B1 | reflexivity] | reflexivity]. }
    eapply eval_compared; [exact Size | exact Product | reflexivity]. }
  rewrite (go_if _ _ _ _ _ _ _ _ _ (eval_both known now1 _ _ _ _ C1 C2)); fold (is_hair n w); unfold turned; destruct (is_hair n w); cbn [app]; [| reflexivity].
  assert (Put : forall f rest, go known procedures (Datatypes.S f) now1 (Place "bare" (Named "i") (Constant Int 0) :: rest) = go known procedures f (("bare." ++ p, Double 0 (-4096))%string :: now1) rest).
  { intros f0 rest; cbn [go]; change (eval known now1 (Named "i")) with (eval known now (Named "i")); rewrite (eval_named known now _ _ I); cbn [eval]; rewrite P; unfold placed.
    change (look ("bare" ++ "." ++ p)%string now1) with (look ("bare." ++ p)%string now); rewrite E; reflexivity. }
  rewrite Put; set (now2 := ("bare." ++ p, _)%string :: now1).
  assert (C3 : eval known now2 (Infix "==" (Named "i") (Constant Int 6)) = Some (Of Int (bit (i =? 6)))).
  { eapply eval_infix; [reflexivity | apply eval_named; exact I | reflexivity | unfold plain_infix; cbn; unfold same; destruct (i =? 6); reflexivity]. }
  rewrite (go_if _ _ _ _ _ _ _ _ _ C3); destruct (i =? 6), Q as [_ ->]; cbn [app];
    (erewrite (go_put _ _ _ _ ""); [| reflexivity | reflexivity | reflexivity]; reflexivity).
Qed.

(** All three. *)
Definition with_i k (now : environment) := ("i", Of Int k) :: now.
Definition before_loop : environment := ("i", Of Int 4) :: map (fun p => (String.append "bare." (fst p), snd p)) (map (fun p => (fst p, Double (m (snd p)) (e (snd p)))) (combine ["0"; "1"; "2"; "3"; "4"; "5"; "6"] named))
  ++ ("axial", Of Int 0) :: ("radial", Of Int 0) :: begun_row.
Definition behind_turn n p w flag k (now : environment) := with_i (k + 1) (outside a_turn (turned p n w flag now)).
Definition behind_loop := behind_turn "z" "6" "gamma" "axial" 6 (behind_turn "y" "5" "b" "radial" 5 (behind_turn "x" "4" "b" "radial" 4 before_loop)).
Lemma loop_run f rest : go known procedures (4 + (6 + f)) before_loop (turns :: rest) = go known procedures (6 + f) behind_loop rest.
Proof.
  unfold turns, behind_loop, behind_turn, turned; cbn [Nat.add]; destruct (is_hair "x" "b") eqn:HX, (is_hair "y" "b") eqn:HY, (is_hair "z" "gamma") eqn:HZ.
  Ltac one_turn n p w flag k H := lazymatch goal with |- go _ _ (Datatypes.S ?g) ?now _ = _ =>
    rewrite (go_turn g now _ a_turn (turned p n w flag now) (k + 1) "i" k); [
      | reflexivity | reflexivity
      | apply (turn_runs _ now k p n w (if k =? 6 then "1" else "2") flag); try reflexivity; [split; reflexivity | do 2 eexists; reflexivity]
      | unfold turned; rewrite H; reflexivity ]; unfold turned; rewrite H end.
  all: one_turn "x" "4" "b" "radial" 4 HX; one_turn "y" "5" "b" "radial" 5 HY; one_turn "z" "6" "gamma" "axial" 6 HZ.
  all: rewrite (go_turns_end _ _ _ _ "i" 7) by reflexivity; apply same_environment; reflexivity.
Qed.
End Row.
