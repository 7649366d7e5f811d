(** Stage 5: the function of the header that decides by integers of any length, run by Coq: what its text returns on a valid row is
    the position.

    The integers are declared with the room and filled with the steps that StageFive.v speaks of; here it is proved that each fits
    its room, and which sign answers what. A function that fills an integer computes what is said of it in [of_integers], and nothing
    where the room does not suffice. *)

Require Import List String ZArith Reals Lra Lia Bool.
From Hypcheck Require Import Geometry Positions Steps Fixed FixedRuns Computed Limbs Trees StageThreeRuns StageThreeAnswers StageThreeNumbers StageThreePosition StageFive.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** The text of the functions. *)
Definition functions := Eval vm_compute in
  match every (map (fun text => deciding_of (string_of text)) HeaderText.deciding) with Some l => l | None => [] end.

Theorem least_text a c : called functions [] [] "hc_least" [Of Int a; Of Int c] = Some (Of Int (Z.min a c)).
Proof.
  unfold called; function "hc_least"; further; unfold carry; destruct (Z.ltb_spec a c); cbv iota; [rewrite Z.min_l | rewrite Z.min_r]; lia || reflexivity.
Qed.

(** ** What is called. *)

(** So many zeros are below the lowest bit of a number other than 0, or fewer: any count that this holds of. *)
Variant counts_zeros (zeros : Z -> Z) : Prop := Counts (_ : forall m, m <> 0 -> 0 <= zeros m /\ (2 ^ zeros m | m)).

Definition exponent_of (zeros : Z -> Z) m e := if m =? 0 then 2048 else e - 1075 + zeros m.
Definition mantissa_of (zeros : Z -> Z) m := Z.abs m / 2 ^ zeros m.
Definition parts_of_double zeros m e := [("sign", Of Int (Z.sgn m)); ("exponent", Of Int (exponent_of zeros m e)); ("mantissa", Of U64 (mantissa_of zeros m))].

Definition in_room k z := provided (Z.abs z <? 2 ^ k) (Whole z).
Definition filling f (given : list datum) := match given with [Room k; Whole a; Whole c] => in_room k (f a c) | _ => None end.
Definition in_units s e a unit := s * (a * 2 ^ (e - unit)).
(** A sign, and for a number other than 0 a word that is not 0. *)
Definition are_parts s a := (s =? 0) || (Z.abs s =? 1) && (0 <? a) && (a <? 2 ^ 64).
Definition of_integers zeros : list (string * (list datum -> option datum)) := [
  ("HC_INTEGER", fun given => match given with [Of Int k] => Some (Room k) | _ => None end);
  ("hc_add", filling Z.add); ("hc_subtract", filling Z.sub); ("hc_multiply", filling Z.mul);
  ("hc_scale", fun given => match given with [Room k; Of Int c; Whole a] => if 0 <? c then in_room k (c * a) else None | _ => None end);
  ("hc_in_units", fun given => match given with
    | [Room k; Rec [(_, Of Int s); (_, Of Int e); (_, Of U64 a)]; Of Int unit] =>
      if are_parts s a && ((s =? 0) || (unit <=? e)) then in_room k (in_units s e a unit) else None
    | _ => None end);
  ("hc_parts_of", fun given => match given with [Double m e] => Some (Rec (parts_of_double zeros m e)) | _ => None end);
  ("hc_least", ints Z.min)].

(** As [called], with more steps. *)
Definition steps_of_run := 300%nat.
Definition called_within (functions : list (string * deciding)) known procedures n given : option datum := try f <- look n functions;
  try now <- bound_all (map Named (firstn (List.length given) (takes f))) given constants;
  try (v, _) <- go known procedures steps_of_run now (does f); v.

(** ** Its integers: the steps of StageFive.v, in their order. *)

Definition C_fillings := Eval vm_compute in match every (filled StageFive.text) with Some l => l | None => [] end.
Definition room_of s := match look (name s) C_rooms with Some k => k | None => 0 end.
Definition read_as a := match a with Name n => Named n | Number z => Constant Int z end.
Definition declares n k := Set_ "hc_integer" n (Called "HC_INTEGER" [Constant Int k]).
Definition fills s := [declares (name s) (room_of s); Set_ "" (name s) (Called (operation s) (Named (name s) :: map read_as (arguments s)))].
Definition part from count := flat_map fills (firstn count (skipn from C_fillings)).

(** The names of an environment, and which of them are integers. *)
Definition names (now : environment) := map (fun p => (fst p, match snd p with Whole _ => true | _ => false end)) now.
Definition is_whole known n := match look n known with Some true => true | _ => false end.
Definition is_new_name (known : list (string * bool)) n := match look n known with None => true | _ => false end.
Definition is_filled known s := match arguments s with
  | [Name a; Name c] => is_in (operation s) ["hc_add"; "hc_subtract"; "hc_multiply"] && is_whole known a && is_whole known c
  | [Number z; Name c] => is "hc_scale" (operation s) && (0 <? z) && is_whole known c
  | _ => false end.
Definition with_name n (known : list (string * bool)) := (n ++ ".sign", false) :: (n, true) :: (n, false) :: known.
Fixpoint in_order known (l : list step) := match l with
  | [] => true | s :: rest => is_new_name known (name s) && is_filled known s && in_order (with_name (name s) known) rest end.

Section Integers.
Variables (zeros : Z -> Z) (procedures : list (string * (nat * (list datum -> option (list datum))))) (v : string -> Z).
Let known := of_integers zeros.

Definition sound (now : environment) := Forall (fun p => match snd p with Whole z => z = v (fst p) | _ => True end) now.
Definition after_step now s : environment := bound (name s) (Whole (v (name s))) ((name s, Room (room_of s)) :: now).

Lemma names_look n now : look n (names now) = option_map (fun d => match d with Whole _ => true | _ => false end) (look n now).
Proof. induction now as [| [k d] now IH]; [reflexivity |]; cbn; destruct (String.eqb k n); [reflexivity | exact IH]. Qed.
Lemma is_there now n : sound now -> is_whole (names now) n = true -> look n now = Some (Whole (v n)).
Proof.
  unfold is_whole; rewrite names_look; intros S; destruct (look n now) as [d |] eqn:E; cbn; [| discriminate].
  destruct d; try discriminate; intros _; apply look_in in E; apply (proj1 (Forall_forall _ _) S) in E; cbn in E; subst; reflexivity.
Qed.
Lemma is_unknown now n : is_new_name (names now) n = true -> look n now = None.
Proof. unfold is_new_name; rewrite names_look; destruct (look n now) as [d |]; [destruct d; discriminate | reflexivity]. Qed.

Lemma in_room_is k z : Z.abs z < 2 ^ k -> in_room k z = Some (Whole z).
Proof. intros H; apply Z.ltb_lt in H; unfold in_room; rewrite H; reflexivity. Qed.

(** One step: the integer is declared, and filled. *)
Lemma go_filled now s f rest : is_new_name (names now) (name s) = true -> is_filled (names now) s = true -> sound now -> is_right v (meaning s) ->
  Z.abs (v (name s)) < 2 ^ room_of s -> go known procedures (S (S f)) now (fills s ++ rest)%list = go known procedures f (after_step now s) rest.
Proof.
  intros N F S R B; pose proof (is_unknown now (name s) N) as L.
  assert (value : eval known ((name s, Room (room_of s)) :: now) (Called (operation s) (Named (name s) :: map read_as (arguments s))) = Some (Whole (v (name s)))).
  { assert (there : forall n, is_whole (names now) n = true -> eval known ((name s, Room (room_of s)) :: now) (Named n) = Some (Whole (v n))).
    { intros n W; pose proof (is_there now n S W) as E; cbn [eval look]; destruct (String.eqb_spec (name s) n) as [<- | D]; [congruence | rewrite E; reflexivity]. }
    assert (room : eval known ((name s, Room (room_of s)) :: now) (Named (name s)) = Some (Room (room_of s))) by (cbn [eval look]; rewrite String.eqb_refl; reflexivity).
    destruct s as [n o l]; cbn [name operation arguments] in *; unfold is_filled in F; cbn [arguments operation] in F.
    destruct l as [| [a | z] [| [c | y] [| ? ?]]]; try discriminate; apply andb_prop in F as [F C]; apply andb_prop in F as [F A].
    - assert (O : In o ["hc_add"; "hc_subtract"; "hc_multiply"]) by (apply existsb_exists in F as (k & I & E); apply String.eqb_eq in E; subst; exact I).
      eapply eval_called with (l := [Room (room_of (Step n o [Name a; Name c])); Whole (v a); Whole (v c)]) (m := fun given => match look o known with Some m => m given | None => None end).
      + destruct O as [<- | [<- | [<- | []]]]; reflexivity.
      + cbn [map read_as every]; rewrite room, (there a A), (there c C); reflexivity.
      + destruct O as [<- | [<- | [<- | []]]]; cbn [known of_integers look String.eqb Ascii.eqb Bool.eqb filling]; rewrite in_room_is; cbn in R; rewrite <- R; trivial.
    - unfold is in F; apply String.eqb_eq in F; subst o.
      eapply eval_called with (l := [Room (room_of (Step n "hc_scale" [Number z; Name c])); Of Int z; Whole (v c)]); [reflexivity | |].
      + cbn [map read_as every]; rewrite room, (there c C); reflexivity.
      + cbv beta iota; rewrite A; cbn in R; rewrite in_room_is; rewrite <- R; trivial. }
  unfold fills, declares; cbn [app].
  rewrite (go_put _ _ _ _ "hc_integer" _ _ _ (Room (room_of s)) (Room (room_of s))); [| unfold is_new; rewrite L; reflexivity | reflexivity | reflexivity].
  rewrite (go_put _ _ _ _ "" _ _ _ _ _ eq_refl value eq_refl); reflexivity.
Qed.

Lemma go_all_filled l : forall now f rest, in_order (names now) l = true -> sound now -> Forall (fun s => is_right v (meaning s)) l ->
  Forall (fun s => Z.abs (v (name s)) < 2 ^ room_of s) l ->
  go known procedures (List.length l * 2 + f) now (flat_map fills l ++ rest)%list = go known procedures f (fold_left after_step l now) rest.
Proof.
  induction l as [| s l IH]; intros now f rest O S R B; [reflexivity |]; cbn [in_order] in O; apply andb_prop in O as [O I]; apply andb_prop in O as [N F].
  inversion R; inversion B; subst; cbn [flat_map fold_left List.length Nat.mul Nat.add]; rewrite <- app_assoc, go_filled by assumption.
  apply IH; try assumption; unfold after_step, sound; cbn [bound]; repeat apply Forall_cons; cbn; trivial.
Qed.
End Integers.

(** ** The run: a row, and the integers that it gives. *)

Section Run.
Variables (m e : string -> Z) (zeros : Z -> Z) (v : string -> Z).
Let exponent n := exponent_of zeros (m n) (e n).
Let radial := Z.min (Z.min (exponent "alpha") (exponent "b")) (Z.min (exponent "x") (exponent "y")).
Let axial := Z.min (Z.min (exponent "gamma") (exponent "d")) (exponent "z").
Definition unit_of n := if is_in n ["gamma"; "d"; "z"] then axial else radial.
Definition length_of n := in_units (Z.sgn (m n)) (exponent n) (mantissa_of zeros (m n)) (unit_of n).
Hypotheses (Begins : forall n, In n lengths -> v n = length_of n) (Right : Forall (is_right v) C_integers)
  (Fits : forall n, In n lengths -> Z.abs (v n) < 2 ^ 2098) (Parts : forall n, In n lengths -> are_parts (Z.sgn (m n)) (mantissa_of zeros (m n)) = true).

Lemma name_stays s : name (meaning s) = name s.
Proof. unfold meaning; destruct (String.eqb _ _); [destruct (arguments s) as [| ? [|]] |]; reflexivity. Qed.
Lemma all_fit : Forall (fun s => Z.abs (v (name s)) < 2 ^ room_of s) C_fillings.
Proof.
  assert (G : bounded v given).
  { intros n i; change given with (map (fun n => (n, 2098)) lengths); intros E; apply look_in, in_map_iff in E as (k & E & I); injection E as <- <-.
    split; [lia | apply Fits; exact I]. }
  apply Forall_forall; intros s I; destruct (rooms_suffice v (meaning s) G Right) as (k & E & B).
  - change C_integers with (map meaning C_fillings); apply in_map; exact I.
  - rewrite name_stays in *; unfold room_of; rewrite E; exact B.
Qed.
Lemma all_right : Forall (fun s => is_right v (meaning s)) C_fillings.
Proof. apply Forall_map; exact Right. Qed.

Definition sign n := Z.compare (v n) 0.
Definition answer_by_signs := exact_answer (sign "delta") (sign "n2") (sign "n1") (sign "offset_at_B") (sign "slope_at_B") (sign "offset_at_A")
  (sign "slope_at_A") (sign "z") (sign "ring_excess").

Let known := of_integers zeros.
Lemma length_is n : In n lengths -> (if are_parts (Z.sgn (m n)) (mantissa_of zeros (m n)) && ((Z.sgn (m n) =? 0) || (unit_of n <=? exponent n)) then in_room 2098 (length_of n) else None) = Some (Whole (v n)).
Proof.
  intros I; rewrite Parts by exact I; replace (unit_of n <=? exponent n) with true.
  - cbn [andb]; rewrite orb_true_r, <- Begins, in_room_is by auto; reflexivity.
  - symmetry; apply Z.leb_le; destruct I as [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]; unfold unit_of; cbn [is_in existsb String.eqb Ascii.eqb Bool.eqb orb];
      unfold axial, radial; lia.
Qed.

(** The text. *)
Let of_sign n o := Infix o (Named (n ++ ".sign")) (Constant Int 0).
Let minus_one := Infix "-" (Constant Int 0) (Constant Int 1).
Definition beginning := (map (fun p => Set_ "hc_parts" (snd p ++ "_parts") (Called "hc_parts_of" [Part (Named "row") (Constant Int (fst p))])) (combine [0; 1; 2; 3; 4; 5; 6] lengths)
  ++ (let exponent n := Named (n ++ "_parts.exponent") in let least a c := Called "hc_least" [a; c] in
    [Set_ "int" "radial_unit" (least (least (exponent "alpha") (exponent "b")) (least (exponent "x") (exponent "y")));
     Set_ "int" "axial_unit" (least (least (exponent "gamma") (exponent "d")) (exponent "z"))])
  ++ map (fun n => declares n 2098) lengths
  ++ map (fun p => Set_ "" (fst p) (Called "hc_in_units" [Named (fst p); Named (fst p ++ "_parts"); Named (snd p)]))
    (combine ["alpha"; "b"; "x"; "y"; "gamma"; "d"; "z"] ["radial_unit"; "radial_unit"; "radial_unit"; "radial_unit"; "axial_unit"; "axial_unit"; "axial_unit"]))%list.
Definition all_positive := Infix "&&" (Infix "&&" (of_sign "delta" ">") (of_sign "n2" "<")) (of_sign "n1" ">").
Definition beyond_B := part 38 9.
Definition above_A := part 47 9.
Definition of_ring := part 56 14.
Definition decisions := [
  If all_positive (beyond_B ++ [Returns (Choice (Infix "&&" (of_sign "offset_at_B" "<") (of_sign "slope_at_B" ">")) (Constant Int 0) (Constant Int 1))]) [];
  If (of_sign "delta" ">") (above_A ++ [Returns (Choice (Infix "&&" (of_sign "offset_at_A" ">") (of_sign "slope_at_A" ">")) minus_one (Constant Int 0))]) [];
  If (Infix "&&" (of_sign "delta" "==") (of_sign "z" "=="))
    (of_ring ++ [Returns (Choice (Infix "&&" (of_sign "slope_at_B" "==") (of_sign "ring_excess" ">")) (Constant Int 1) (Constant Int 0))]) [];
  Returns (Constant Int 0)]%list.
Theorem text_is : look "hc_position_by_integers" functions = Some (Deciding ["row"] (beginning ++ part 0 38 ++ decisions)).
Proof. vm_compute; reflexivity. Qed.

(** The environment behind the beginning. *)
Definition with_lengths now := fold_left (fun now n => bound n (Whole (v n)) now) ["alpha"; "b"; "x"; "y"; "gamma"; "d"; "z"]
  (fold_left (fun now n => bound n (Room 2098) now) lengths now).
Definition begun := with_lengths (bound "axial_unit" (Of Int axial) (bound "radial_unit" (Of Int radial)
  (fold_left (fun now n => bound (n ++ "_parts") (Rec (parts_of_double zeros (m n) (e n))) now) lengths
    (match bound_all [Named "row"] [row m e] constants with Some now => now | None => [] end)))).

Ltac open text := eval cbv -[Z.min Z.sgn Z.eqb Z.leb exponent_of mantissa_of in_room in_units are_parts provided said most_grown W] in text.
Lemma held_as_is {A} (o : option A) w : o = Some w -> (try v <- o; Some v) = Some w.
Proof. intros ->; reflexivity. Qed.
Ltac of_length n := exact (held_as_is _ _ (length_is n ltac:(cbn; tauto))).
Definition begun_values := (map (fun n => Rec (parts_of_double zeros (m n) (e n))) lengths ++ [Of Int radial; Of Int axial] ++ map (fun _ => Room 2098) lengths
  ++ map (fun n => Whole (v n)) ["alpha"; "b"; "x"; "y"; "gamma"; "d"; "z"])%list.

Lemma beginning_runs f rest now : bound_all [Named "row"] [row m e] constants = Some now ->
  go known [] (23 + f) now (beginning ++ rest)%list = go known [] f begun rest.
Proof.
  intros E; unfold begun; rewrite E; vm_compute in E; injection E as <-.
  rewrite (go_straight known [] f rest beginning _ begun_values); [reflexivity | vm_compute; reflexivity |].
  lazymatch goal with |- Forall is_asked ?l => let v := open l in change (Forall is_asked v) end.
  repeat (apply Forall_cons; [unfold is_asked; cbn [fst snd]; first [reflexivity | of_length "alpha" | of_length "b" | of_length "x" | of_length "y"
    | of_length "gamma" | of_length "d" | of_length "z"] |]); apply Forall_nil.
Qed.

(** Which sign answers what. *)
Definition is_sign n o : bool := match o, sign n with ">", Gt | "<", Lt | "==", Eq => true | _, _ => false end.
Definition has_sign n (now : environment) := look (n ++ ".sign") now = Some (Of Int (Z.sgn (v n))).
Lemma answer_is : code (Some answer_by_signs) = if is_sign "delta" ">" && is_sign "n2" "<" && is_sign "n1" ">"
  then if is_sign "offset_at_B" "<" && is_sign "slope_at_B" ">" then 0 else 1
  else if is_sign "delta" ">" then if is_sign "offset_at_A" ">" && is_sign "slope_at_A" ">" then -1 else 0
  else if is_sign "delta" "==" && is_sign "z" "==" then if is_sign "slope_at_B" "==" && is_sign "ring_excess" ">" then 1 else 0 else 0.
Proof.
  unfold answer_by_signs, is_sign; destruct (sign "delta"), (sign "n2"), (sign "n1"); cbn [exact_answer andb]; try reflexivity;
    repeat match goal with |- context [match sign ?n with _ => _ end] => destruct (sign n) end; reflexivity.
Qed.
Lemma of_sign_is n o now : is_in o [">"; "<"; "=="] = true -> has_sign n now -> eval known now (of_sign n o) = Some (Of Int (bit (is_sign n o))).
Proof.
  intros O H; unfold is_in in O; apply existsb_exists in O as (k & I & E); apply String.eqb_eq in E; subst k.
  unfold of_sign, is_sign, sign; eapply eval_infix; [| cbn [eval]; unfold has_sign in H; rewrite H; reflexivity | reflexivity |];
    destruct I as [<- | [<- | [<- | []]]]; try reflexivity; destruct (v n); reflexivity.
Qed.

Lemma part_runs from count f now rest : in_order (names now) (firstn count (skipn from C_fillings)) = true -> sound v now ->
  List.length (firstn count (skipn from C_fillings)) = count ->
  go known [] (count * 2 + f) now (part from count ++ rest)%list = go known [] f (fold_left (after_step v) (firstn count (skipn from C_fillings)) now) rest.
Proof.
  intros O S L; rewrite <- L at 1; apply go_all_filled; trivial.
  all: apply Forall_forall; intros s I; assert (J : In s C_fillings) by (rewrite <- (firstn_skipn from C_fillings); apply in_or_app; right;
    rewrite <- (firstn_skipn count (skipn from C_fillings)); apply in_or_app; left; exact I).
  - exact (proj1 (Forall_forall _ _) all_right s J).
  - exact (proj1 (Forall_forall _ _) all_fit s J).
Qed.
Lemma sound_after l : forall now, sound v now -> sound v (fold_left (after_step v) l now).
Proof. induction l as [| s l IH]; intros now S; [exact S |]; apply IH; unfold after_step, sound; cbn [bound]; repeat apply Forall_cons; cbn; trivial. Qed.
Lemma begun_sound : sound v begun.
Proof.
  unfold sound; match goal with |- Forall ?P ?l => let now := open l in change (Forall P now) end; repeat (apply Forall_cons; [cbn; trivial |]); apply Forall_nil.
Qed.

Let computed := fold_left (after_step v) (firstn 38 C_fillings) begun.
Theorem tree_text : called_within functions known [] "hc_position_by_integers" [row m e] = Some (Of Int (code (Some answer_by_signs))).
Proof.
  unfold called_within; rewrite text_is; cbn [takes does List.length firstn map].
  destruct (bound_all [Named "row"] [row m e] constants) as [now |] eqn:E; [| discriminate].
  change steps_of_run with (23 + (38 * 2 + 201))%nat; rewrite (beginning_runs _ _ _ E), part_runs; [| vm_compute; reflexivity | apply begun_sound | reflexivity].
  change (fold_left _ _ begun) with computed; unfold decisions.
  assert (Sound : sound v computed) by apply sound_after, begun_sound.
  assert (D : has_sign "delta" computed) by (vm_compute; reflexivity); assert (N2 : has_sign "n2" computed) by (vm_compute; reflexivity);
    assert (N1 : has_sign "n1" computed) by (vm_compute; reflexivity); assert (Z0 : has_sign "z" computed) by (vm_compute; reflexivity).
  assert (O1 : in_order (names computed) (firstn 9 (skipn 38 C_fillings)) = true) by (vm_compute; reflexivity).
  assert (O2 : in_order (names computed) (firstn 9 (skipn 47 C_fillings)) = true) by (vm_compute; reflexivity).
  assert (O3 : in_order (names computed) (firstn 14 (skipn 56 C_fillings)) = true) by (vm_compute; reflexivity).
  rewrite answer_is; change 201%nat with (S (9 * 2 + S 181))%nat; rewrite go_if with (x := is_sign "delta" ">" && is_sign "n2" "<" && is_sign "n1" ">")
    by (unfold all_positive; repeat apply eval_both; apply of_sign_is; trivial).
  Ltac returned a c := erewrite go_return; [| eapply eval_choice with (x := a && c);
    [apply eval_both; apply of_sign_is; solve [reflexivity | vm_compute; reflexivity] | reflexivity | reflexivity]];
    destruct (a && c); reflexivity.
  destruct (is_sign "delta" ">" && is_sign "n2" "<" && is_sign "n1" ">") eqn:C1; cbv iota.
  { unfold beyond_B; rewrite <- app_assoc, part_runs by trivial; cbn [app].
    returned (is_sign "offset_at_B" "<") (is_sign "slope_at_B" ">"). }
  cbn [app]; change (9 * 2 + S 181)%nat with (S (9 * 2 + S 180))%nat; rewrite go_if with (x := is_sign "delta" ">") by (apply of_sign_is; trivial).
  destruct (is_sign "delta" ">") eqn:C2; cbv iota.
  { unfold above_A; rewrite <- app_assoc, part_runs by trivial; cbn [app].
    returned (is_sign "offset_at_A" ">") (is_sign "slope_at_A" ">"). }
  cbn [app]; change (9 * 2 + S 180)%nat with (S (14 * 2 + S 169))%nat; rewrite go_if with (x := is_sign "delta" "==" && is_sign "z" "==")
    by (apply eval_both; apply of_sign_is; trivial).
  destruct (is_sign "delta" "==" && is_sign "z" "==") eqn:C3; cbv iota.
  { unfold of_ring; rewrite <- app_assoc, part_runs by trivial; cbn [app].
    returned (is_sign "slope_at_B" "==") (is_sign "ring_excess" ">"). }
  cbn [app]; change (14 * 2 + S 169)%nat with 198%nat; erewrite go_return by reflexivity; reflexivity.
Qed.

End Run.

(** ** The position. *)

(** The integers of the steps, by those that they begin with. *)
Definition value_of_step (v : string -> Z) (s : step) := match arguments s with
  | [a; c] => if String.eqb (operation s) "add" then integer v a + integer v c
    else if String.eqb (operation s) "sub" then integer v a - integer v c else integer v a * integer v c
  | _ => 0 end.
Fixpoint computed_by (v : string -> Z) (l : list step) := match l with [] => v | s :: rest => computed_by (Computed.put v (name s) (value_of_step v s)) rest end.
Definition are_named (l : list step) n := existsb (fun t => String.eqb (name t) n) l.
Definition is_step (s : step) := match arguments s with [_; _] => is_in (operation s) ["add"; "sub"; "mul"] | _ => false end.
Fixpoint each_once (l : list step) := match l with
  | [] => true
  | s :: rest => is_step s && negb (are_named rest (name s)) && forallb (fun a => match a with Name n => negb (are_named (s :: rest) n) | Number _ => true end) (arguments s)
    && each_once rest end.

Lemma computed_not_named l : forall v n, are_named l n = false -> computed_by v l n = v n.
Proof.
  induction l as [| s l IH]; intros v n H; [reflexivity |]; cbn in H; apply orb_false_elim in H as [H1 H2]; cbn [computed_by].
  rewrite IH by exact H2; apply put_other; exact H1.
Qed.
Lemma computed_right l : forall v, each_once l = true -> Forall (is_right (computed_by v l)) l.
Proof.
  induction l as [| s l IH]; intros v H; [apply Forall_nil |]; cbn [each_once] in H; apply andb_prop in H as [H L]; apply andb_prop in H as [H A];
    apply andb_prop in H as [S N]; apply negb_true_iff in N.
  apply Forall_cons; [| apply IH; exact L]; cbn [computed_by]; unfold is_right, is_step in *; destruct (arguments s) as [| a [| c [|]]] eqn:E; try discriminate.
  cbn [forallb] in A; apply andb_prop in A as [A C]; apply andb_prop in C as [C _].
  assert (same : forall w, match w with Name n => negb (are_named (s :: l) n) | Number _ => true end = true ->
    integer (computed_by (Computed.put v (name s) (value_of_step v s)) l) w = integer v w).
  { intros [n | z] K; [| reflexivity]; apply negb_true_iff in K; cbn in K; apply orb_false_elim in K as [K1 K2]; cbn.
    rewrite computed_not_named by exact K2; apply put_other; exact K1. }
  rewrite (same a A), (same c C), computed_not_named, put_same by exact N; unfold value_of_step; rewrite E.
  unfold is_in in S; cbn [existsb] in S.
  destruct (String.eqb (operation s) "add"); [reflexivity |]; destruct (String.eqb (operation s) "sub"); [reflexivity |];
    destruct (String.eqb (operation s) "mul"); [reflexivity | discriminate].
Qed.

Section Position.
Variables (m e : string -> Z) (zeros : Z -> Z).
(** A valid row: doubles of 53 bits, multiples of 2^-1074 below 2^1024. *)
Hypotheses (Zeros : counts_zeros zeros) (Sizes : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < m n) (Mantissas : forall n, In n lengths -> Z.abs (m n) < 2 ^ 53)
  (Powers : forall n, In n lengths -> m n <> 0 -> e n <= 2046 /\ 1 <= e n + zeros (m n)).

(** The steps without those that the C repeats in the branch of the ring. *)
Definition distinct := (firstn 56 C_integers ++ skipn 65 C_integers)%list.
Let v := computed_by (length_of m e zeros) distinct.

Lemma right_integers : Forall (is_right v) C_integers.
Proof.
  pose proof (computed_right distinct (length_of m e zeros) eq_refl) as R; fold v in R; apply Forall_app in R as [F L].
  rewrite <- (firstn_skipn 56 C_integers); apply Forall_app; split; [exact F |].
  rewrite <- (firstn_skipn 9 (skipn 56 C_integers)); apply Forall_app; split; [| exact L].
  change (firstn 9 (skipn 56 C_integers)) with (firstn 9 (skipn 38 (firstn 56 C_integers))).
  apply Forall_forall; intros s I; apply (proj1 (Forall_forall _ _) F).
  rewrite <- (firstn_skipn 38 (firstn 56 C_integers)); apply in_or_app; right; rewrite <- (firstn_skipn 9 (skipn 38 _)); apply in_or_app; left; exact I.
Qed.
Lemma begins n : In n lengths -> v n = length_of m e zeros n.
Proof. intros [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]; apply computed_not_named; reflexivity. Qed.

Let exponent n := exponent_of zeros (m n) (e n).
Lemma units_bounded n : -1074 <= unit_of m e zeros n.
Proof.
  assert (each : forall k, In k lengths -> -1074 <= exponent k).
  { intros k I; unfold exponent, exponent_of; destruct (Z.eqb_spec (m k) 0) as [E | E]; [lia | pose proof (Powers k I E); lia]. }
  pose proof (each "alpha" ltac:(cbn; tauto)); pose proof (each "gamma" ltac:(cbn; tauto)); pose proof (each "b" ltac:(cbn; tauto));
    pose proof (each "d" ltac:(cbn; tauto)); pose proof (each "x" ltac:(cbn; tauto)); pose proof (each "y" ltac:(cbn; tauto)); pose proof (each "z" ltac:(cbn; tauto)).
  unfold unit_of; fold (exponent "alpha") (exponent "gamma") (exponent "b") (exponent "d") (exponent "x") (exponent "y") (exponent "z");
    clearbody exponent; destruct (is_in _ _); lia.
Qed.
Lemma units_below n : In n lengths -> unit_of m e zeros n <= exponent n.
Proof.
  intros [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]; unfold unit_of; cbn [is_in existsb String.eqb Ascii.eqb Bool.eqb orb];
    fold (exponent "alpha") (exponent "gamma") (exponent "b") (exponent "d") (exponent "x") (exponent "y") (exponent "z"); clearbody exponent; lia.
Qed.

Lemma are_parts_all n : In n lengths -> are_parts (Z.sgn (m n)) (mantissa_of zeros (m n)) = true.
Proof.
  intros I; unfold are_parts; destruct (Z.eqb_spec (m n) 0) as [E | E]; [rewrite E; reflexivity |].
  destruct Zeros as [C]; destruct (C _ E) as [Z0 Z1]; pose proof (Mantissas n I) as M; pose proof (Z.pow_pos_nonneg 2 (zeros (m n)) ltac:(lia) Z0) as P.
  assert (A : 0 < mantissa_of zeros (m n)).
  { apply Z.div_str_pos; split; [exact P | apply Z.divide_pos_le; [lia | apply Z.divide_abs_r; exact Z1]]. }
  assert (L : mantissa_of zeros (m n) <= Z.abs (m n)) by (apply Z.div_le_upper_bound; [exact P | nia]).
  rewrite (proj2 (Z.ltb_lt _ _) A), (proj2 (Z.ltb_lt (mantissa_of zeros (m n)) (2 ^ 64))) by (apply Z.le_lt_trans with (Z.abs (m n)); [exact L | apply Z.lt_trans with (2 ^ 53); [exact M | reflexivity]]).
  destruct (m n); [congruence | reflexivity | reflexivity].
Qed.

Lemma lengths_fit n : In n lengths -> Z.abs (v n) < 2 ^ 2098.
Proof.
  intros I; rewrite begins by exact I; unfold length_of, in_units; destruct (Z.eqb_spec (m n) 0) as [E | E].
  - rewrite E; cbn [Z.sgn]; rewrite Z.mul_0_l; reflexivity.
  - destruct Zeros as [C]; destruct (C _ E) as [Z0 Z1], (Powers n I E) as [P _]; pose proof (Mantissas n I) as M; pose proof (units_bounded n) as U;
      pose proof (units_below n I) as B.
    assert (X : exponent n = e n - 1075 + zeros (m n)) by (unfold exponent, exponent_of; rewrite (proj2 (Z.eqb_neq _ _) E); reflexivity).
    fold (exponent n); set (k := exponent n - unit_of m e zeros n) in *; assert (K : 0 <= k <= 2045 + zeros (m n)) by (unfold k; lia).
    assert (A : 0 <= mantissa_of zeros (m n)) by (apply Z.div_pos; [lia | apply Z.pow_pos_nonneg; lia]).
    assert (W : mantissa_of zeros (m n) * 2 ^ zeros (m n) = Z.abs (m n)).
    { unfold mantissa_of; rewrite Z.mul_comm; symmetry; apply Z_div_exact_2; [apply Z.lt_gt, Z.pow_pos_nonneg; lia |].
      apply Z.mod_divide; [apply Z.pow_nonzero; lia | apply Z.divide_abs_r; exact Z1]. }
    assert (S : Z.abs (Z.sgn (m n)) = 1) by (destruct (m n); [congruence | reflexivity | reflexivity]).
    rewrite Z.abs_mul, S, Z.mul_1_l, Z.abs_eq by (apply Z.mul_nonneg_nonneg; [exact A | apply Z.pow_nonneg; lia]).
    apply Z.le_lt_trans with (Z.abs (m n) * 2 ^ 2045).
    + rewrite <- W, <- Z.mul_assoc, <- Z.pow_add_r by lia; apply Z.mul_le_mono_nonneg_l; [exact A |]; apply Z.pow_le_mono_r; lia.
    + replace 2098 with (53 + 2045) by reflexivity; rewrite Z.pow_add_r by lia; apply Z.mul_lt_mono_pos_r; [apply Z.pow_pos_nonneg; lia | exact M].
Qed.

Lemma value_is n : In n lengths -> (IZR (v n) * power (unit_of m e zeros n) = value_of m e n)%R.
Proof.
  intros I; rewrite begins by exact I; unfold length_of, in_units, value_of; destruct (Z.eqb_spec (m n) 0) as [E | E].
  - rewrite E; cbn [Z.sgn]; rewrite Z.mul_0_l, !Rmult_0_l; reflexivity.
  - destruct Zeros as [C]; destruct (C _ E) as [Z0 Z1]; pose proof (units_below n I) as B.
    assert (X : exponent n = e n - 1075 + zeros (m n)) by (unfold exponent, exponent_of; rewrite (proj2 (Z.eqb_neq _ _) E); reflexivity).
    assert (W : m n = Z.sgn (m n) * (2 ^ zeros (m n) * mantissa_of zeros (m n))).
    { unfold mantissa_of; rewrite <- Z_div_exact_2; [rewrite Z.mul_comm; symmetry; apply Z.abs_sgn | apply Z.lt_gt, Z.pow_pos_nonneg; lia |].
      apply Z.mod_divide; [apply Z.pow_nonzero; lia | apply Z.divide_abs_r; exact Z1]. }
    fold (exponent n); apply (f_equal IZR) in W; rewrite W; rewrite !mult_IZR, !power_whole by (fold (exponent n) in B |- *; lia).
    replace (power (e n - 1075)) with (power (exponent n - unit_of m e zeros n) * power (unit_of m e zeros n) * power (- zeros (m n)))%R
      by (rewrite <- !power_sum; f_equal; rewrite X; ring).
    assert (O : (power (zeros (m n)) * power (- zeros (m n)) = 1)%R) by (rewrite <- power_sum, Z.add_opp_diag_r; reflexivity).
    set (a := power (zeros (m n))) in *; set (c := power (- zeros (m n))) in *.
    transitivity (IZR (Z.sgn (m n)) * (IZR (mantissa_of zeros (m n)) * power (exponent n - unit_of m e zeros n)) * power (unit_of m e zeros n) * (a * c))%R; [rewrite O |]; ring.
Qed.

Let p := upright (value_of m e "alpha") (value_of m e "gamma") (value_of m e "b") (value_of m e "d") (value_of m e "x") (value_of m e "y") (value_of m e "z").
Definition answer_of_integers := called_within functions (of_integers zeros) [] "hc_position_by_integers" [row m e].
Theorem text_answers_by_integers : exists a, answer_of_integers = Some (Of Int (code (Some a))) /\ is_position p a.
Proof.
  eexists; split; [exact (tree_text m e zeros v begins right_integers lengths_fit are_parts_all) |].
  assert (pos : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < v n).
  { intros n I; assert (J : In n lengths) by (clear - I; destruct I as [<- | [<- | [<- | [<- | []]]]]; cbn; tauto); apply lt_IZR; apply Rmult_lt_reg_r with (power (unit_of m e zeros n)); [apply power_positive |].
    rewrite Rmult_0_l, value_is by exact J; apply Rmult_lt_0_compat; [apply IZR_lt, Sizes, I | apply power_positive]. }
  pose proof begins as Begin; pose proof right_integers as Right; pose proof value_is as Value; clearbody v.
  pose proof (last_stage_is_right v Right (power (unit_of m e zeros "alpha")) (power (unit_of m e zeros "gamma")) (power_positive _) (power_positive _)
    (pos "alpha" ltac:(cbn; tauto)) (pos "gamma" ltac:(cbn; tauto)) (pos "b" ltac:(cbn; tauto)) (pos "d" ltac:(cbn; tauto))) as L.
  unfold p; rewrite <- (Value "alpha"), <- (Value "gamma"), <- (Value "b"), <- (Value "d"), <- (Value "x"), <- (Value "y"), <- (Value "z") by (cbn; tauto).
  exact L.
Qed.

Corollary integers_are_right : (answer_of_integers = Some (Of Int 1) -> exterior p) /\ (answer_of_integers = Some (Of Int (-1)) -> interior p)
  /\ (answer_of_integers = Some (Of Int 0) -> contact p).
Proof. destruct text_answers_by_integers as (a & E & H); revert E; generalize answer_of_integers; intros o ->; destruct a; repeat split; intros F; try discriminate; exact H. Qed.
End Position.
