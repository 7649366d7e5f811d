(** Stage 2, on any number of rows by vectors of any width: Coq runs the text of hc_certified, whatever its comparisons say.

    Its steps are those that Ranges.v reads between the marks of the header. [mask] has the bits of a truth, one for each row of a turn
    of the loop; HC_LOAD loads as many rows of a column, and a column begins [stride] places behind the one before. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Ranges Steps Fixed Limbs Trees FloatSteps FloatTexts.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Definition texts := map (fun text => deciding_of (string_of text)) HeaderText.floats.
Definition functions := Eval vm_compute in match every texts with Some l => l | None => [] end.
Definition does n := match look n functions with Some f => Trees.does f | None => [] end.

Section Certified.

(** The bits of a truth in the turn that begins with row [at_]; the width of a vector, the rows and the stride. *)
Variables (mask : Z -> string -> Z) (width count stride : Z).
Hypotheses (Width : 1 <= width <= 64) (Count : 0 <= count <= 64) (Stride : count <= stride < 2 ^ 60)
  (Masks : forall at_ n, 0 <= mask at_ n < 2 ^ width).

Definition load (given : list datum) : option datum := match given with
  | [Opaque n z] => if is "columns" n then try p <- nth_error inputs (Z.to_nat (z / stride)); Some (Opaque p (z mod stride)) else None | _ => None end.
Definition bits_of (given : list datum) : option datum := match given with [Opaque n k] => Some (Of U64 (mask k n)) | _ => None end.
Definition of_vectors := [("HC_LOAD", load); ("HC_BITS", bits_of)].
Definition known_certified := (of_floats ["columns"] C_certified ++ of_vectors)%list.
Definition turns := 64%nat.
Definition given_columns := [Opaque "columns" 0; Of U64 stride; Of Int count].
Definition steps_of_certified := (10 + (turns + (S (8 + (List.length C_certified + 3)) + 0)))%nat.
Definition defined_here := ("HC_WIDTH", Of Int width) :: defined.
Definition text_of_certified := called_with functions steps_of_certified known_certified defined_here "hc_certified" given_columns.

Definition outer := ["u_4"; "u_8"; "u_12"; "u_16"; "slack"; "least"; "greatest"; "farthest"].
Definition before_loop := Eval vm_compute in firstn 10 (does "hc_certified").
Definition turn := Eval vm_compute in match nth_error (does "hc_certified") 10 with Some (Turns _ _ _ l) => l | _ => [] end.
Lemma body_is : does "hc_certified" = (before_loop ++ [Turns "at" (Named "count") (Named "HC_WIDTH") turn; Returns (Named "found")])%list.
Proof. reflexivity. Qed.

Definition column (k : Z) := Infix "+" (Infix "+" (Named "columns") (Infix "*" (Constant Int k) (Named "stride"))) (Named "at").
Definition loading (p : Z * string) := Set_ "HC_NUMBER" (snd p) (Called "HC_LOAD" [column (fst p)]).
Definition collecting (p : string * string) := let field := ("found." ++ fst p) in
  Set_ "" field (Infix "|" (Named field) (Infix "<<" (Called "HC_BITS" [Named (snd p)]) (Named "at"))).
Definition loads := combine [0; 1; 2; 3; 4; 5; 6] inputs.
Definition collected := [("plus", "exterior"); ("minus", "interior"); ("decided", "decided")].
Definition steps_in_turn := Eval vm_compute in firstn (List.length C_certified) (skipn 7 turn).
Lemma turn_is : turn = (map loading loads ++ (steps_in_turn ++ map collecting collected))%list.
Proof. reflexivity. Qed.
Lemma turn_reads : map step_in steps_in_turn = map Some C_certified.
Proof. vm_compute; reflexivity. Qed.

Let known := known_certified.

(** What is known of the variables at the beginning of a turn. *)
Definition locals := (inputs ++ map name C_certified)%list.
Record ready at_ p m d (now : environment) := Ready {
  has_columns : look "columns" now = Some (Opaque "columns" 0); has_stride : look "stride" now = Some (Of U64 stride);
  has_count : look "count" now = Some (Of Int count); has_width : look "HC_WIDTH" now = Some (Of Int width);
  has_outer : forall n, In n outer -> look n now = Some (Opaque n always); has_at : look "at" now = Some (Of Int at_);
  has_plus : look "found.plus" now = Some (Of U64 p); has_minus : look "found.minus" now = Some (Of U64 m);
  has_decided : look "found.decided" now = Some (Of U64 d); no_found : look "found" now = None;
  no_locals : forall n, In n locals -> look n now = None }.

Lemma loads_are k n : In (k, n) loads -> 0 <= k <= 6 /\ nth_error inputs (Z.to_nat k) = Some n /\ In n inputs.
Proof. cbn; intros I; repeat destruct I as [I | I]; try contradiction; injection I as <- <-; (split; [lia | split; [reflexivity | tauto]]). Qed.

Lemma load_is now at_ k n : look "columns" now = Some (Opaque "columns" 0) -> look "stride" now = Some (Of U64 stride) -> look "at" now = Some (Of Int at_) ->
  0 <= at_ < count -> In (k, n) loads -> eval known now (Called "HC_LOAD" [column k]) = Some (Opaque n at_).
Proof.
  intros C S A T I; destruct (loads_are k n I) as (K & N & _).
  assert (M : eval known now (Infix "*" (Constant Int k) (Named "stride")) = Some (Of U64 (k * stride))).
  { cbn [eval]; rewrite S; change (plain_infix "*" Int k U64 stride) with (Some (Of U64 ((k mod W * stride) mod W))); rewrite !Z.mod_small by (rewrite ?Z.mod_small; unfold W; nia); reflexivity. }
  assert (add : forall e e' j t z, eval known now e = Some (Opaque "columns" j) -> eval known now e' = Some (Of t z) -> eval known now (Infix "+" e e') = Some (Opaque "columns" (j + z))).
  { intros e e' j t z E E'; cbn [eval]; rewrite E, E'; reflexivity. }
  pose proof (add _ _ _ _ _ (add _ _ _ _ _ (eval_named known now "columns" _ C) M) (eval_named known now "at" _ A)) as E.
  apply (eval_called known) with (m := load) (l := [Opaque "columns" (0 + k * stride + at_)]); [reflexivity | cbn [map every]; unfold column; rewrite E; reflexivity |].
  unfold load; change (is "columns" "columns") with true; cbv iota.
  assert (Q : (0 + k * stride + at_) / stride = k) by (symmetry; apply Z.div_unique with at_; lia).
  assert (R : (0 + k * stride + at_) mod stride = at_) by (symmetry; apply Z.mod_unique with k; lia).
  rewrite Q, R, N; reflexivity.
Qed.

Lemma go_loads at_ : 0 <= at_ < count -> forall l now f rest, (forall p, In p l -> In p loads) -> NoDup (map snd l) -> (forall p, In p l -> look (snd p) now = None) ->
  look "columns" now = Some (Opaque "columns" 0) -> look "stride" now = Some (Of U64 stride) -> look "at" now = Some (Of Int at_) ->
  go known [] (List.length l + f) now (map loading l ++ rest) = go known [] f (given_floats at_ (map snd l) now) rest.
Proof.
  intros T; induction l as [| [k n] l IH]; intros now f rest I D N C S A; [reflexivity |].
  pose proof (I (k, n) (or_introl eq_refl)) as J; pose proof (N (k, n) (or_introl eq_refl)) as NN; cbn [snd] in NN.
  cbn [map List.length Nat.add app]; unfold loading at 1; cbn [fst snd]; rewrite (go_put known) with (v := Opaque n at_) (w := Opaque n at_);
    [| unfold is_new; rewrite NN; reflexivity | apply load_is; assumption | reflexivity].
  cbn [map] in D; apply NoDup_cons_iff in D as [D1 D2]; cbn [snd] in D1; cbn [bound given_floats fold_left map snd].
  assert (O : forall m, In m ["columns"; "stride"; "at"] -> String.eqb n m = false).
  { destruct (loads_are k n J) as (_ & _ & IN); intros i IM.
    assert (H : forallb (fun n => forallb (fun i => negb (String.eqb n i)) ["columns"; "stride"; "at"]) inputs = true) by reflexivity.
    rewrite forallb_forall in H; specialize (H n IN); rewrite forallb_forall in H; apply negb_true_iff, (H i IM). }
  apply (IH ((n, Opaque n at_) :: now)); try assumption; [intros p P; apply I; right; exact P | | | |].
  - intros p P; cbn [look]; destruct (String.eqb_spec n (snd p)) as [E | E]; [| apply N; right; exact P]; exfalso; apply D1; rewrite E; apply in_map; exact P.
  - cbn [look]; rewrite O by (cbn; tauto); exact C.
  - cbn [look]; rewrite O by (cbn; tauto); exact S.
  - cbn [look]; rewrite O by (cbn; tauto); exact A.
Qed.

Lemma collect_is now at_ field t v : 0 <= at_ < 64 -> look field now = Some (Of U64 v) -> look t now = Some (Opaque t at_) -> look "at" now = Some (Of Int at_) ->
  eval known now (Infix "|" (Named field) (Infix "<<" (Called "HC_BITS" [Named t]) (Named "at"))) = Some (Of U64 (Z.lor v ((mask at_ t * 2 ^ at_) mod W))).
Proof.
  intros T F B A.
  assert (H : eval known now (Called "HC_BITS" [Named t]) = Some (Of U64 (mask at_ t))).
  { apply (eval_called known) with (m := bits_of) (l := [Opaque t at_]); [reflexivity | cbn [map every]; rewrite (eval_named known now t _ B); reflexivity | reflexivity]. }
  assert (S : eval known now (Infix "<<" (Called "HC_BITS" [Named t]) (Named "at")) = Some (Of U64 ((mask at_ t * 2 ^ at_) mod W))).
  { rewrite (eval_ints known now "<<" _ _ U64 (mask at_ t) Int at_ eq_refl H (eval_named known now "at" _ A)).
    change (plain_infix "<<" U64 (mask at_ t) Int at_) with (match (match counted U64 at_ (Some ((mask at_ t * 2 ^ at_) mod W)) with Some z => Some (Val U64 z) | None => None end) with Some (Val v z) => Some (Of v z) | _ => None end).
    unfold counted; cbn [Limbs.width]; replace ((0 <=? at_) && (at_ <? 64)) with true by (symmetry; apply andb_true_intro; split; [apply Z.leb_le | apply Z.ltb_lt]; lia); reflexivity. }
  rewrite (eval_ints known now "|" _ _ U64 v U64 _ eq_refl (eval_named known now field _ F) S); reflexivity.
Qed.

Lemma look_outside l n : forall now, look n (outside l now) = if is_in n (declared l) then None else look n now.
Proof.
  unfold outside; induction now as [| [m v] now IH]; cbn [filter fst look]; [destruct (is_in n _); reflexivity |].
  destruct (is_in m (declared l)) eqn:M; cbn [negb look]; rewrite IH; destruct (String.eqb_spec m n) as [<- | N]; try reflexivity; rewrite M; reflexivity.
Qed.
Lemma declared_in_turn : declared turn = locals.
Proof. vm_compute; reflexivity. Qed.

Lemma after_turn at_ p m d now : ready at_ p m d now -> 0 <= at_ < count ->
  let collect v t := Z.lor v ((mask at_ t * 2 ^ at_) mod W) in
  exists now', (forall f, go known [] (7 + (List.length C_certified + (3 + S f))) now turn = Some (None, now'))
    /\ eval known (outside turn now') (Infix "+" (Named "at") (Named "HC_WIDTH")) = Some (Of Int (at_ + width))
    /\ ready (at_ + width) (collect p "exterior") (collect m "interior") (collect d "decided") (bound "at" (Of Int (at_ + width)) (outside turn now')).
Proof.
  intros [C S N Wd O A P M D F L] T collect.
  set (later := given_floats at_ (map name C_certified) (given_floats at_ inputs now)).
  assert (LL : forall n, look n later = if is_in n locals then Some (Opaque n at_) else look n now).
  { intros n; unfold later, locals; rewrite !look_given; unfold is_in; rewrite existsb_app; destruct (existsb _ inputs), (existsb _ (map name C_certified)); reflexivity. }
  set (put := fun field v (e : environment) => (field, Of U64 v) :: e).
  exists (put "found.decided" (collect d "decided") (put "found.minus" (collect m "interior") (put "found.plus" (collect p "exterior") later))).
  assert (R : forall f, go known [] (7 + (List.length C_certified + (3 + Datatypes.S f))) now turn
    = Some (None, put "found.decided" (collect d "decided") (put "found.minus" (collect m "interior") (put "found.plus" (collect p "exterior") later)))).
  { intros f; rewrite turn_is.
    rewrite (go_loads at_ T loads); try assumption; [| auto | vm_compute; repeat constructor; cbn; intuition discriminate
      | intros [k n] I; cbn [snd]; apply L; unfold locals; apply in_or_app; left; apply (loads_are k n I)].
    change (map snd loads) with inputs; change known with (of_floats ["columns"] C_certified ++ of_vectors)%list.
    rewrite (go_steps C_certified ["columns"] outer at_ []) with (steps := C_certified) (have := (outer ++ inputs)%list);
      [| exact turn_reads | vm_compute; reflexivity | |].
    - change (of_floats ["columns"] C_certified ++ of_vectors)%list with known; fold later.
      assert (field : forall n, is_in n locals = false -> look n later = look n now) by (intros n I; rewrite LL, I; reflexivity).
      assert (local : forall n, is_in n locals = true -> look n later = Some (Opaque n at_)) by (intros n I; rewrite LL, I; reflexivity).
      unfold collected; cbn [map]; unfold collecting; cbn [fst snd append Nat.add].
      erewrite go_put; [| reflexivity | apply (collect_is _ at_ _ _ p); [lia | | |]; cbn [look]; [rewrite field; [exact P | vm_compute; reflexivity] | apply local; vm_compute; reflexivity | rewrite field; [exact A | vm_compute; reflexivity]] | reflexivity].
      erewrite go_put; [| reflexivity | apply (collect_is _ at_ _ _ m); [lia | | |]; cbn [bound];
        [change (look ("found." ++ "minus") later = Some (Of U64 m)); rewrite field; [exact M | vm_compute; reflexivity]
        | change (look "interior" later = Some (Opaque "interior" at_)); apply local; vm_compute; reflexivity
        | change (look "at" later = Some (Of Int at_)); rewrite field; [exact A | vm_compute; reflexivity]] | reflexivity].
      erewrite go_put; [| reflexivity | apply (collect_is _ at_ _ _ d); [lia | | |]; cbn [bound];
        [change (look ("found." ++ "decided") later = Some (Of U64 d)); rewrite field; [exact D | vm_compute; reflexivity]
        | change (look "decided" later = Some (Opaque "decided" at_)); apply local; vm_compute; reflexivity
        | change (look "at" later = Some (Of Int at_)); rewrite field; [exact A | vm_compute; reflexivity]] | reflexivity].
      reflexivity.
    - intros n I; rewrite look_given; unfold float_of; apply is_in_In, in_app_or in I.
      destruct (is_in n inputs) eqn:J; [| destruct I as [I | I]; [| apply is_in_In in I; congruence]].
      + assert (K : is_in n outer = false); [| rewrite K; reflexivity].
        apply is_in_In in J; cbn in J; repeat destruct J as [<- | J]; try contradiction; reflexivity.
      + rewrite (O n I); apply is_in_In in I; rewrite I; reflexivity.
    - intros s I; rewrite look_given.
      assert (K : forallb (fun n => negb (is_in n inputs)) (map name C_certified) = true) by (vm_compute; reflexivity).
      rewrite forallb_forall in K; specialize (K (name s) (in_map name _ s I)); apply negb_true_iff in K; rewrite K.
      apply L; unfold locals; apply in_or_app; right; apply in_map; exact I. }
  set (now' := put _ _ _) in *; clearbody collect.
  assert (V : forall n, is_in n ["found.plus"; "found.minus"; "found.decided"] = false -> look n (outside turn now') = if is_in n locals then None else look n now).
  { intros n I; rewrite look_outside, declared_in_turn; destruct (is_in n locals) eqn:J; [reflexivity |]; unfold now', put; cbn [look].
    cbn [is_in existsb] in I; apply orb_false_elim in I as [I1 I]; apply orb_false_elim in I as [I2 I]; apply orb_false_elim in I as [I3 _].
    rewrite String.eqb_sym in I1, I2, I3; rewrite I1, I2, I3, LL, J; reflexivity. }
  split; [exact R |]; split.
  - rewrite (eval_ints known (outside turn now') "+" _ _ Int at_ Int width eq_refl).
    + change (plain_infix "+" Int at_ Int width) with (match (match (if in_int (at_ + width) then Some (at_ + width) else None) with Some k => Some (Val Int k) | None => None end)
        with Some (Val v z) => Some (Of v z) | _ => None end).
      unfold in_int; replace ((- 2 ^ 31 <=? at_ + width) && (at_ + width <? 2 ^ 31)) with true by (symmetry; apply andb_true_intro; split; [apply Z.leb_le | apply Z.ltb_lt]; lia); reflexivity.
    + apply eval_named; rewrite V by reflexivity; exact A.
    + apply eval_named; rewrite V by reflexivity; exact Wd.
  - assert (U : forall n, is_in n ["at"; "found.plus"; "found.minus"; "found.decided"] = false ->
      look n (bound "at" (Of Int (at_ + width)) (outside turn now')) = if is_in n locals then None else look n now).
    { intros n I; change (is_in n ["at"; "found.plus"; "found.minus"; "found.decided"]) with (String.eqb n "at" || is_in n ["found.plus"; "found.minus"; "found.decided"]) in I.
      apply orb_false_elim in I as [I1 I2]; cbn [bound look]; rewrite String.eqb_sym, I1; apply V; exact I2. }
    assert (Y : forall n, In n (["columns"; "stride"; "count"; "HC_WIDTH"; "found"] ++ outer) -> look n (bound "at" (Of Int (at_ + width)) (outside turn now')) = look n now).
    { intros n I; assert (G : forallb (fun n => negb (is_in n (["at"; "found.plus"; "found.minus"; "found.decided"] ++ locals))) (["columns"; "stride"; "count"; "HC_WIDTH"; "found"] ++ outer) = true)
        by (vm_compute; reflexivity).
      rewrite forallb_forall in G; specialize (G n I); apply negb_true_iff in G; unfold is_in in G; rewrite existsb_app in G; apply orb_false_elim in G as [G1 G2].
      rewrite U by exact G1; unfold is_in; rewrite G2; reflexivity. }
    assert (Z : forall n v, look n now' = Some v -> is_in n locals = false -> is_in n ["at"] = false -> look n (bound "at" (Of Int (at_ + width)) (outside turn now')) = Some v).
    { intros n v E I1 I2; cbn [bound look]; cbn [is_in existsb] in I2; apply orb_false_elim in I2 as [I2 _]; rewrite String.eqb_sym, I2, look_outside, declared_in_turn, I1; exact E. }
    constructor.
    + rewrite Y by (cbn; tauto); exact C.
    + rewrite Y by (cbn; tauto); exact S.
    + rewrite Y by (cbn; tauto); exact N.
    + rewrite Y by (cbn; tauto); exact Wd.
    + intros n I; rewrite Y by (apply in_or_app; right; exact I); apply O; exact I.
    + reflexivity.
    + apply Z; reflexivity.
    + apply Z; reflexivity.
    + apply Z; reflexivity.
    + rewrite Y by (cbn; tauto); exact F.
    + intros n I; rewrite U.
      * apply is_in_In in I; rewrite I; reflexivity.
      * assert (G : forallb (fun n => negb (is_in n ["at"; "found.plus"; "found.minus"; "found.decided"])) locals = true) by (vm_compute; reflexivity).
        rewrite forallb_forall in G; apply negb_true_iff, (G n I).
Qed.

(** The bits of the rows before [at_]: row i is one of the turn that begins with i - i mod width. *)
Definition bit_of t i := Z.testbit (mask (i / width * width) t) (i mod width).
Definition collects at_ v t := forall i, 0 <= i -> Z.testbit v i = (i <? at_) && (i <? 64) && bit_of t i.

Lemma collects_more at_ v t : 0 <= at_ < count -> at_ mod width = 0 -> collects at_ v t -> collects (at_ + width) (Z.lor v ((mask at_ t * 2 ^ at_) mod W)) t.
Proof.
  intros T Q H i I; rewrite Z.lor_spec, (H i I); change W with (2 ^ 64); unfold bit_of.
  destruct (Z.ltb_spec i 64); [| rewrite Z.mod_pow2_bits_high by lia; rewrite !andb_false_r; reflexivity].
  rewrite Z.mod_pow2_bits_low by lia; rewrite Z.mul_pow2_bits by lia.
  destruct (Z.ltb_spec i at_); [rewrite (Z.testbit_neg_r _ (i - at_)) by lia; replace (i <? at_ + width) with true by (symmetry; apply Z.ltb_lt; lia); apply orb_false_r |].
  cbn [andb orb]; destruct (Z.ltb_spec i (at_ + width)).
  - assert (E : at_ = width * (at_ / width)) by (apply Z_div_exact_full_2; [lia | exact Q]).
    assert (D : i / width = at_ / width) by (symmetry; apply Z.div_unique with (i - at_); lia).
    rewrite D, (Z.mod_eq i width), D by lia; replace (at_ / width * width) with at_ by lia; replace (i - width * (at_ / width)) with (i - at_) by lia; reflexivity.
  - destruct (Masks at_ t) as [M1 M2]; rewrite <- (Z.mod_small (mask at_ t) (2 ^ width)) by lia; apply Z.mod_pow2_bits_high; lia.
Qed.

Lemma go_last f now rest i c by_ l : eval known now (Infix "<" (Named i) c) = Some (Of Int 0) ->
  go known [] (Datatypes.S f) now (Turns i c by_ l :: rest) = go known [] f now rest.
Proof. intros E; cbn [go]; rewrite E; reflexivity. Qed.
Lemma go_turn f now now' rest i c by_ l j : eval known now (Infix "<" (Named i) c) = Some (Of Int 1) -> go known [] f now l = Some (None, now') ->
  eval known (outside l now') (Infix "+" (Named i) by_) = Some j ->
  go known [] (Datatypes.S f) now (Turns i c by_ l :: rest) = go known [] f (bound i j (outside l now')) (Turns i c by_ l :: rest).
Proof. intros E G P; cbn [go]; rewrite E; cbn [Z.eqb]; rewrite G; cbv beta iota; rewrite P; reflexivity. Qed.
Lemma compare_is at_ p m d now : ready at_ p m d now -> eval known now (Infix "<" (Named "at") (Named "count")) = Some (Of Int (if at_ <? count then 1 else 0)).
Proof.
  intros R; rewrite (eval_ints known now "<" _ _ Int at_ Int count eq_refl); [reflexivity | apply eval_named; apply (has_at _ _ _ _ _ R) | apply eval_named; apply (has_count _ _ _ _ _ R)].
Qed.

Lemma loop_runs rest : forall times at_ p m d now g, ready at_ p m d now -> 0 <= at_ -> at_ mod width = 0 -> count <= at_ + Z.of_nat times * width -> at_ < count + width ->
  collects at_ p "exterior" -> collects at_ m "interior" -> collects at_ d "decided" ->
  exists f end_ p' m' d' now', ready end_ p' m' d' now' /\ (count <= end_ < count + width /\ end_ mod width = 0) /\ collects end_ p' "exterior" /\ collects end_ m' "interior" /\ collects end_ d' "decided"
    /\ go known [] (times + (Datatypes.S (8 + (List.length C_certified + 3)) + g)) now (Turns "at" (Named "count") (Named "HC_WIDTH") turn :: rest) = go known [] (Datatypes.S f) now' rest.
Proof.
  induction times as [| times IH]; intros at_ p m d now g R A Q C C' CP CM CD.
  - exists (7 + (List.length C_certified + 3) + g)%nat, at_, p, m, d, now.
    split; [exact R |]; split; [lia |]; split; [exact CP |]; split; [exact CM |]; split; [exact CD |].
    pose proof (compare_is _ _ _ _ _ R) as E; replace (at_ <? count) with false in E by (symmetry; apply Z.ltb_ge; lia); exact (go_last _ now rest _ _ _ turn E).
  - rewrite Nat2Z.inj_succ, Z.mul_succ_l in C; pose proof (compare_is _ _ _ _ _ R) as E; destruct (Z.lt_ge_cases at_ count) as [L | L].
    + destruct (after_turn at_ p m d now R ltac:(lia)) as (now' & G & P & R'); cbv zeta in R'.
      destruct (IH (at_ + width) _ _ _ _ g R') as (f & end_ & p' & m' & d' & now'' & W1 & W2 & W3 & W4 & W5 & W6);
        [lia | rewrite <- Zplus_mod_idemp_l, Q; apply Z_mod_same_full | lia | lia | apply collects_more; [lia | assumption ..] .. |].
      exists f, end_, p', m', d', now''; split; [exact W1 |]; split; [exact W2 |]; split; [exact W3 |]; split; [exact W4 |]; split; [exact W5 |]; rewrite <- W6; clear W6.
      replace (at_ <? count) with true in E by (symmetry; apply Z.ltb_lt; lia); specialize (G (1 + (times + g))%nat).
      replace (Datatypes.S times + (Datatypes.S (8 + (List.length C_certified + 3)) + g))%nat with (Datatypes.S (times + (Datatypes.S (8 + (List.length C_certified + 3)) + g)))%nat by lia.
      apply go_turn with (j := Of Int (at_ + width)); [exact E | | exact P]; rewrite <- G; f_equal; lia.
    + exists (times + (8 + (List.length C_certified + 3)) + g)%nat, at_, p, m, d, now.
      split; [exact R |]; split; [lia |]; split; [exact CP |]; split; [exact CM |]; split; [exact CD |].
      replace (at_ <? count) with false in E by (symmetry; apply Z.ltb_ge; lia).
      replace (Datatypes.S times + (Datatypes.S (8 + (List.length C_certified + 3)) + g))%nat with (Datatypes.S (Datatypes.S (times + (8 + (List.length C_certified + 3)) + g)))%nat by lia.
      apply go_last; exact E.
Qed.

(** The struct that is returned. *)
Definition bits_of_struct (v : option datum) : option (Z * Z * Z) := match v with
  | Some (Rec l) => match look "plus" l, look "minus" l, look "decided" l with
    | Some (Of U64 p), Some (Of U64 m), Some (Of U64 d) => Some (p, m, d) | _, _, _ => None end
  | _ => None end.

Lemma prefixed_is q s f : prefixed q s = Some f <-> s = (q ++ f)%string.
Proof.
  revert s; induction q as [| a q IH]; intros s; cbn [prefixed append]; [split; [intros E; injection E as ->; reflexivity | intros ->; reflexivity] |].
  destruct s as [| c s]; [split; discriminate |]; destruct (Ascii.eqb_spec a c) as [<- | N].
  - rewrite IH; split; [intros ->; reflexivity | intros E; injection E as ->; reflexivity].
  - split; [discriminate | intros E; injection E as E _; congruence].
Qed.
Lemma look_fields n f now : look f (fields n now) = look (n ++ "." ++ f) now.
Proof.
  unfold fields; induction now as [| [k v] now IH]; [reflexivity |]; cbn [flat_map fst snd look].
  assert (E : (n ++ "." ++ f = (n ++ ".") ++ f)%string) by (clear; induction n as [| a n IH]; cbn; [reflexivity | rewrite <- IH; reflexivity]).
  destruct (prefixed (n ++ ".") k) as [g |] eqn:P; cbn [app look].
  - apply prefixed_is in P; subst k; rewrite E; destruct (String.eqb_spec g f) as [-> | N]; [rewrite String.eqb_refl; reflexivity |].
    destruct (String.eqb_spec ((n ++ ".") ++ g) ((n ++ ".") ++ f)) as [X |]; [| rewrite <- E; exact IH].
    exfalso; apply N; revert X; generalize (n ++ ".")%string; clear; induction s as [| a s IH]; cbn; [auto | intros X; injection X as X; auto].
  - rewrite IH; destruct (String.eqb_spec k (n ++ "." ++ f)) as [-> | N]; [| reflexivity].
    rewrite E in P; rewrite (proj2 (prefixed_is _ _ f) eq_refl) in P; discriminate.
Qed.

(** All bits: of rows that there are, and of those that the last vector reads behind them. *)
Definition behind_all := (count + width - 1) / width * width.
Definition all_bits v t := forall i, 0 <= i -> Z.testbit v i = (i <? behind_all) && (i <? 64) && bit_of t i.
Definition collected_bits p m d := all_bits p "exterior" /\ all_bits m "interior" /\ all_bits d "decided".

Theorem certified_text : exists p m d, bits_of_struct text_of_certified = Some (p, m, d) /\ collected_bits p m d.
Proof.
  unfold text_of_certified, called_with; set (now := ("count", Of Int count) :: ("stride", Of U64 stride) :: ("columns", Opaque "columns" 0) :: ("HC_WIDTH", Of Int width) :: defined).
  change (exists p m d, bits_of_struct (match go known [] steps_of_certified now (does "hc_certified") with Some (v, _) => v | None => None end) = Some (p, m, d) /\ collected_bits p m d).
  rewrite body_is; unfold steps_of_certified.
  set (now' := ("at", Of Int 0) :: fold_left (fun now n => (n, Opaque n always) :: now) outer
    (("found.plus", Of U64 0) :: ("found.minus", Of U64 0) :: ("found.decided", Of U64 0) :: now)).
  assert (B : forall f rest, go known [] (10 + f) now (before_loop ++ rest) = go known [] f now' rest).
  { intros f rest; unfold before_loop; cbn [app Nat.add]; do 10 (erewrite go_put; [| reflexivity | reflexivity | reflexivity]; cbn [bound app map fst snd append]); reflexivity. }
  assert (R : ready 0 0 0 0 now').
  { constructor; try reflexivity.
    - intros n I; cbn in I; repeat destruct I as [<- | I]; try contradiction; reflexivity.
    - intros n I; apply (new_ones locals); [vm_compute; reflexivity | exact I]. }
  assert (Z : forall t, collects 0 0 t) by (intros t i I; rewrite Z.testbit_0_l by lia; replace (i <? 0) with false by (symmetry; apply Z.ltb_ge; lia); reflexivity).
  rewrite B; destruct (loop_runs [Returns (Named "found")] turns 0 0 0 0 now' 0 R) as (f & end_ & p & m & d & last & R' & E & CP & CM & CD & G); try apply Z; try lia;
    [apply Z.mod_0_l; lia | unfold turns; lia |].
  rewrite G; assert (F : eval known last (Named "found") = Some (Rec (fields "found" last))).
  { cbn [eval]; rewrite (no_found _ _ _ _ _ R'); pose proof (look_fields "found" "plus" last) as P.
    change ("found" ++ "." ++ "plus")%string with "found.plus" in P; rewrite (has_plus _ _ _ _ _ R') in P; destruct (fields "found" last); [discriminate P | reflexivity]. }
  rewrite (go_return known [] f last _ [] _ F); exists p, m, d; split.
  - unfold bits_of_struct; rewrite !look_fields; change ("found" ++ "." ++ "plus")%string with "found.plus"; change ("found" ++ "." ++ "minus")%string with "found.minus";
      change ("found" ++ "." ++ "decided")%string with "found.decided"; rewrite (has_plus _ _ _ _ _ R'), (has_minus _ _ _ _ _ R'), (has_decided _ _ _ _ _ R'); reflexivity.
  - destruct E as [[E1 E2] E3]; assert (EQ : end_ = behind_all); [| subst end_; repeat split; assumption].
    assert (E4 : end_ = width * (end_ / width)) by (apply Z_div_exact_full_2; [lia | exact E3]); unfold behind_all.
    replace ((count + width - 1) / width) with (end_ / width); [lia |]; apply Z.div_unique with (count + width - 1 - end_); lia.
Qed.
End Certified.
