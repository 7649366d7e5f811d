(** Stage 5 on limbs: the text that decides by integers, its integers in memory and the text of each function of long integers run for
    each call, returns what it returns with whole numbers; so it returns the position. Limbs have 64 or 32 bits.

    Every call satisfies what the theorems of LongSums.v, LongProducts.v and LongUnits.v ask for: the result is another number than
    the arguments, which fit its room, and a product leaves a limb free. *)

Require Import List String Ascii ZArith Reals Lia Bool.
From Hypcheck Require Import Geometry Positions Steps Fixed Limbs Trees LongIntegers LongRuns LongOutcomes LongSums LongProducts LongUnits
  StageThreeRuns StageThreeAnswers StageThreeNumbers StageThreePosition StageFive StageFiveAnswers StageFiveLimbs.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Section Integers.
Variable bits : Z.
Hypothesis Bits : bits = 32 \/ bits = 64.
Notation B := (2 ^ bits).
Let base : 1 < B.
Proof. destruct Bits as [-> | ->]; reflexivity. Qed.
Variable rooms : list (string * Z).
Variable zeros : Z -> Z.
Hypothesis Rooms : forallb (fun p => (0 <=? snd p) && (snd p <? 2 ^ 20)) rooms = true.
Hypothesis Named_ : forallb (fun p => is_named (fst p)) rooms = true.
Notation limbs_for := (StageFiveLimbs.limbs_for bits).
Notation address := (StageFiveLimbs.address rooms).
Notation room := (StageFiveLimbs.room bits rooms).
Notation call := (StageFiveLimbs.call bits rooms).
Notation known := (of_integers zeros).
Notation signed := (StageFiveLimbs.signed rooms).
Notation evaluated := (StageFiveLimbs.evaluated rooms zeros).
Notation given_plainly := (StageFiveLimbs.given_plainly rooms zeros).
Notation given_to := (StageFiveLimbs.given_to rooms zeros).
Notation goes := (StageFiveLimbs.goes bits rooms zeros).
Notation is_integer := (StageFiveLimbs.is_integer rooms).
Notation is_plain := (StageFiveLimbs.is_plain rooms).
Notation plainly := (StageFiveLimbs.plainly rooms).
Notation of_signs := (StageFiveLimbs.of_signs rooms).
Notation is_other := (StageFiveLimbs.is_other rooms).
Notation is_shorter := (StageFiveLimbs.is_shorter rooms).
Notation fills_right := (StageFiveLimbs.fills_right rooms).
Notation is_right_text := (StageFiveLimbs.is_right_text rooms).

(** ** The two runs. *)

Notation is_value := (is_value B owned room).
Definition as_whole (now now' : environment) m n := match look n now with
  | None => look n now' = None /\ look (n ++ ".sign") now = None
  | Some (Room k) => look n now' = Some (Room k) /\ look n rooms = Some k /\ look (n ++ ".sign") now = None
  | Some (Whole z) => exists k, look n now' = Some (Room k) /\ look n rooms = Some k /\ Z.abs z < 2 ^ k /\ is_value m (address n) z
    /\ look (n ++ ".sign") now = Some (Of Int (Z.sgn z))
  | _ => False end.
Definition agree now now' m := (forall n, is_plain n = true -> look n now = look n now' /\ fields n now = fields n now')
  /\ (forall n k, look n now' = Some (Room k) -> is_integer n = true) /\ forall n, is_integer n = true -> as_whole now now' m n.

Lemma integer_in n : is_integer n = true -> exists k, look n rooms = Some k /\ In (n, k) rooms /\ 0 <= k < 2 ^ 20 /\ is_named n = true.
Proof.
  unfold StageFiveLimbs.is_integer; destruct (look n rooms) as [k |] eqn:E; [| discriminate]; intros _; exists k; apply look_in in E as I; split; [reflexivity |].
  pose proof (proj1 (forallb_forall _ _) Rooms _ I) as K; pose proof (proj1 (forallb_forall _ _) Named_ _ I) as N; cbn in K, N.
  apply andb_prop in K as [K K']; apply Z.leb_le in K; apply Z.ltb_lt in K'; auto.
Qed.
Lemma names_differ n x : is_integer n = true -> is_integer x = true -> n ++ ".sign" <> x /\ (n <> x -> n ++ ".sign" <> x ++ ".sign").
Proof.
  intros N X; destruct (integer_in n N) as (_ & _ & _ & _ & A), (integer_in x X) as (_ & _ & _ & _ & C); unfold is_named in *.
  apply andb_prop in A as [_ A]; apply andb_prop in C as [D C].
  destruct (signed_by (n ++ ".sign")) as [n' |] eqn:E; [apply String.eqb_eq in A; subst n' | discriminate].
  destruct (signed_by (x ++ ".sign")) as [x' |] eqn:F; [apply String.eqb_eq in C; subst x' | discriminate]; split; [| congruence].
  intros G; rewrite G in E; unfold signed_by in E; destruct (LongIntegers.field_of x ""); discriminate.
Qed.
Lemma plain_apart n x : is_plain n = true -> is_integer x = true -> n <> x /\ n <> x ++ ".sign" /\ prefixed (n ++ ".") x = None /\ prefixed (n ++ ".") (x ++ ".sign") = None.
Proof.
  intros P X; destruct (integer_in x X) as (k & _ & I & _); apply andb_prop in P as [_ P]; pose proof (proj1 (forallb_forall _ _) P _ I) as A; cbn in A; unfold are_apart in A.
  apply andb_prop in A as [A A4]; apply andb_prop in A as [A A3]; apply andb_prop in A as [A1 A2].
  destruct (String.eqb_spec n x), (String.eqb_spec n (x ++ ".sign")); try discriminate.
  destruct (prefixed (n ++ ".") x), (prefixed (n ++ ".") (x ++ ".sign")); try discriminate; auto.
Qed.

(** Values. *)
Lemma plain_same now now' : (forall n, is_plain n = true -> look n now = look n now' /\ fields n now = fields n now') ->
  forall e, plainly e = true -> eval known now e = eval known now' e.
Proof.
  intros Same; fix IH 1; intros [n | t z | o l r | c a b | f given | a i | t a | l] H; cbn [StageFiveLimbs.plainly] in H; cbn [eval]; try discriminate H; try reflexivity;
    repeat match type of H with _ && _ = true => apply andb_prop in H as [H ?] end.
  - destruct (Same n H) as [-> ->]; reflexivity.
  - rewrite (IH l), (IH r) by assumption; reflexivity.
  - rewrite (IH c), (IH a), (IH b) by assumption; reflexivity.
  - assert (E : map (eval known now) given = map (eval known now') given).
    { clear H; induction given as [| e given IHg]; [reflexivity |]; cbn [forallb] in H0; apply andb_prop in H0 as [H1 H2]; cbn [map]; f_equal; [apply IH; exact H1 | apply IHg; exact H2]. }
    rewrite E; reflexivity.
  - rewrite (IH i), (IH a) by assumption; reflexivity.
  - rewrite (IH a) by assumption; reflexivity.
Qed.
Lemma signed_plain now m e : (forall n k, look n now = Some (Room k) -> is_integer n = true) -> plainly e = true -> signed now m e = e.
Proof.
  intros A; induction e as [n | t z | o l IHl r IHr | c IHc a IHa b IHb | f given | a IHa i IHi | t a IHa | l]; cbn [StageFiveLimbs.plainly StageFiveLimbs.signed]; intros H; try reflexivity;
    repeat match type of H with _ && _ = true => apply andb_prop in H as [H ?] end.
  - unfold StageFiveLimbs.is_plain in H; destruct (signed_by n) as [x |]; [| reflexivity]; apply andb_prop in H as [H _]; apply negb_true_iff in H.
    destruct (look x now) as [[] |] eqn:E; try reflexivity; rewrite (A _ _ E) in H; discriminate.
  - rewrite IHl, IHr by assumption; reflexivity.
  - rewrite IHc, IHa, IHb by assumption; reflexivity.
Qed.
Lemma sign_is m p z : is_value m p z -> LongIntegers.sign_at m p = Some (Z.sgn z).
Proof.
  intros (s & n & f & S & S1 & S0 & H & ->); rewrite S; f_equal; pose proof (size_zero B owned room m p n f base H) as E.
  pose proof (total_bounds B base f n (limbs_digits _ _ _ _ _ _ (proj1 (proj2 H)))) as T.
  destruct S1 as [-> | [-> | ->]]; destruct (Z.eq_dec (total B f n) 0); lia.
Qed.
Lemma shown_is now now' m : agree now now' m -> forall e v, of_signs e = true -> eval known now e = Some v -> evaluated now' m e = Some v.
Proof.
  intros (Same & Rooms_ & Wholes); unfold StageFiveLimbs.evaluated.
  induction e as [n | t z | o l IHl r IHr | c IHc a IHa b IHb | f given | a IHa i IHi | t a IHa | l]; intros v H E; cbn [StageFiveLimbs.of_signs] in H; apply orb_prop in H as [H | H];
    try (rewrite signed_plain, <- (plain_same now now') by assumption; exact E); try discriminate H.
  - assert (both : of_signs l = true -> of_signs r = true -> eval known now' (signed now' m (Infix o l r)) = Some v).
    { intros L R; cbn [StageFiveLimbs.signed]; cbn [eval] in E |- *; destruct (eval known now l) as [x |] eqn:X; [rewrite (IHl x L eq_refl) | discriminate].
      assert (right : forall y, eval known now r = Some y -> eval known now' (signed now' m r) = Some y) by (intros y Y; exact (IHr y R Y)).
      destruct x as [t x | | | whole power | | | | n k]; try discriminate; destruct (eval known now r) as [y |]; try rewrite (right y eq_refl); try exact E;
        destruct (o =? "&&")%string, (o =? "||")%string; try discriminate; destruct (x =? 0); solve [exact E | discriminate]. }
    destruct l as [n | | | | | | |]; try (apply andb_prop in H as [H1 H2]; exact (both H1 H2)).
    destruct r as [| t z | | | | | |]; try (apply andb_prop in H as [H1 H2]; exact (both H1 H2)); clear both IHl IHr.
    unfold is_sign_of_integer in H; destruct (signed_by n) as [x |] eqn:S; [| discriminate]; apply andb_prop in H as [I N]; apply String.eqb_eq in N.
    cbn [StageFiveLimbs.signed]; rewrite S; pose proof (Wholes x I) as W; unfold as_whole in W; destruct (look x now) as [[] |] eqn:X; try contradiction.
    + destruct W as (_ & _ & W); rewrite <- N in W; cbn [eval] in E; rewrite W in E; destruct (fields n now); discriminate.
    + destruct W as (k & X' & _ & _ & V & W); rewrite X', (sign_is _ _ _ V); rewrite <- N in W; cbn [eval] in E |- *; rewrite W in E; exact E.
    + destruct W as (_ & W); rewrite <- N in W; cbn [eval] in E; rewrite W in E; destruct (fields n now); discriminate.
  - apply andb_prop in H as [H Hb]; apply andb_prop in H as [Hc Ha]; cbn [StageFiveLimbs.signed]; cbn [eval] in E |- *.
    destruct (eval known now c) as [x |] eqn:X; [rewrite (IHc x Hc eq_refl) | discriminate]; destruct x; try discriminate; destruct (z =? 0); auto.
Qed.

(** A declaration, a value, and a call. *)
Lemma look_app {A} n (a b : list (string * A)) : look n (a ++ b)%list = match look n a with Some v => Some v | None => look n b end.
Proof. induction a as [| [k v] a IH]; [reflexivity |]; cbn; destruct (String.eqb k n); [reflexivity | exact IH]. Qed.
Lemma look_none {A} n (a : list (string * A)) : (forall k v, In (k, v) a -> k <> n) -> look n a = None.
Proof. intros H; destruct (look n a) as [v |] eqn:E; [| reflexivity]; apply look_in in E; exfalso; exact (H n v E eq_refl). Qed.
Lemma prefixed_there n f : prefixed (n ++ ".") (n ++ "." ++ f) = Some f.
Proof. induction n as [| c n IH]; cbn; [reflexivity |]; rewrite Ascii.eqb_refl; exact IH. Qed.

Lemma agree_more now now' m n a : agree now now' m -> is_plain n = true -> (forall k v, In (k, v) a -> (k = n \/ exists f, k = n ++ "." ++ f) /\ forall j, v <> Room j) ->
  agree (a ++ now)%list (a ++ now')%list m.
Proof.
  intros (Same & Rooms_ & Wholes) P A; split; [| split].
  - intros q Q; rewrite !look_app; unfold fields; rewrite !flat_map_app; destruct (Same q Q) as [-> F]; unfold fields in F; rewrite F; split; reflexivity.
  - intros q k; rewrite look_app; destruct (look q a) as [v |] eqn:E; [| apply Rooms_]; apply look_in, A in E as (_ & E); intros F; injection F as ->; destruct (E k eq_refl).
  - intros x X; destruct (plain_apart n x P X) as (D1 & D2 & D3 & D4); specialize (Wholes x X); unfold as_whole in *.
    assert (N1 : look x a = None) by (apply look_none; intros k v I <-; destruct (A _ _ I) as [[E | [f E]] _]; [congruence | rewrite E, prefixed_there in D3; discriminate]).
    assert (N2 : look (x ++ ".sign") a = None) by (apply look_none; intros k v I E'; destruct (A _ _ I) as [[E | [f E]] _]; [congruence | rewrite <- E', E, prefixed_there in D4; discriminate]).
    rewrite !look_app, N1, N2; exact Wholes.
Qed.
Lemma agree_plain now now' m t n v w : agree now now' m -> is_plain n = true -> t = "int" \/ t = "hc_parts" -> held t v = Some w -> 
  (forall l k x, v = Rec l -> In (k, x) l -> forall j, x <> Room j) -> agree (bound n w now) (bound n w now') m.
Proof.
  intros A P T H Parts.
  assert (W : (exists z, w = Of Int z) \/ exists l, w = Rec l /\ v = Rec l).
  { destruct T as [-> | ->]; cbn in H; destruct v; try discriminate.
    - destruct (converted t Int z); [| discriminate]; injection H as <-; left; eexists; reflexivity.
    - injection H as <-; right; eexists; split; reflexivity. }
  destruct W as [[z ->] | (l & -> & ->)]; cbn [bound].
  - apply (agree_more now now' m n [(n, Of Int z)]); [exact A | exact P |]; intros k v' [E | []]; injection E as <- <-; split; [left; reflexivity | discriminate].
  - apply (agree_more now now' m n (map (fun f => (n ++ "." ++ fst f, snd f)) l)); [exact A | exact P |]; intros k x I; apply in_map_iff in I as ([f y] & E & I); injection E as <- <-.
    split; [right; eexists; reflexivity | exact (Parts l f y eq_refl I)].
Qed.
Lemma agree_declared now now' m n k : agree now now' m -> look n rooms = Some k -> look n now = None ->
  agree ((n, Room k) :: now) ((n, Room k) :: now') (with_length (with_sign m (address n) 0) (address n) 0).
Proof.
  intros (Same & Rooms_ & Wholes) R N; assert (I : is_integer n = true) by (unfold StageFiveLimbs.is_integer; rewrite R; reflexivity).
  assert (Ch : changes_only owned room (address n) m (with_length (with_sign m (address n) 0) (address n) 0)).
  { apply changes_with_length, changes_with_sign; split; [intros; split; reflexivity | reflexivity]. }
  split; [| split].
  - intros q Q; destruct (plain_apart q n Q I) as (D1 & _ & D3 & _), (Same q Q) as [E F]; unfold fields in *; cbn [look flat_map fst].
    rewrite D3; destruct (String.eqb_spec n q); [congruence |]; split; assumption.
  - intros q j; cbn [look]; destruct (String.eqb_spec n q) as [<- |]; [intros _; exact I | apply Rooms_].
  - intros x X; destruct (names_differ n x I X) as [D1 D2], (names_differ x n X I) as [D3 D4]; specialize (Wholes x X); unfold as_whole in *; cbn [look].
    destruct (String.eqb_spec n (x ++ ".sign")) as [E | _]; [congruence |]; destruct (String.eqb_spec n x) as [<- | D].
    + rewrite N in Wholes; tauto.
    + destruct (look x now) as [[] |]; try exact Wholes; destruct Wholes as (j & L & L' & Z & V & S); exists j; repeat (split; [assumption |]); split; [| exact S].
      assert (address x <> address n) by (apply addresses_apart; [rewrite L'; discriminate | congruence]).
      apply (value_elsewhere B owned room (address n) m); assumption.
Qed.
Lemma agree_filled now now' m m' n k z : agree now now' m -> look n now = Some (Room k) -> is_integer n = true -> Z.abs z < 2 ^ k -> is_value m' (address n) z -> 
  changes_only owned room (address n) m m' -> agree (bound n (Whole z) now) now' m'.
Proof.
  intros (Same & Rooms_ & Wholes) N I Z V Ch; cbn [bound]; pose proof (Wholes n I) as W; unfold as_whole in W; rewrite N in W; destruct W as (N' & R & _).
  split; [| split; [exact Rooms_ |]].
  - intros q Q; destruct (plain_apart q n Q I) as (D1 & D2 & D3 & D4), (Same q Q) as [E F]; unfold fields in *; cbn [look flat_map fst].
    rewrite D3, D4; destruct (String.eqb_spec n q); [congruence |]; destruct (String.eqb_spec (n ++ ".sign") q); [congruence |]; split; assumption.
  - intros x X; destruct (names_differ n x I X) as [D1 D2], (names_differ x n X I) as [D3 D4]; specialize (Wholes x X); unfold as_whole in *; cbn [look].
    destruct (String.eqb_spec (n ++ ".sign") x); [congruence |]; destruct (String.eqb_spec n (x ++ ".sign")) as [E | _]; [congruence |]; destruct (String.eqb_spec n x) as [<- | D].
    + rewrite String.eqb_refl; exists k; tauto.
    + destruct (String.eqb_spec (n ++ ".sign") (x ++ ".sign")) as [E | _]; [destruct (D2 D E) |].
      destruct (look x now) as [[] |]; try exact Wholes; destruct Wholes as (j & L & L' & Z' & V' & S); exists j; repeat (split; [assumption |]); split; [| exact S].
      assert (address x <> address n) by (apply addresses_apart; [rewrite L'; discriminate | congruence]).
      apply (value_elsewhere B owned room (address n) m); assumption.
Qed.

(** What a call gets. *)
Lemma other_is now now' m n a z : agree now now' m -> is_other n a = true -> eval known now a = Some (Whole z) -> exists x j, a = Named x /\ x <> n /\ look x rooms = Some j
  /\ given_to now' m a = Some [To (address x)] /\ is_value m (address x) z /\ Z.abs z < 2 ^ j.
Proof.
  intros (_ & _ & Wholes) O E; destruct a as [x | | | | | | |]; try discriminate; cbn [StageFiveLimbs.is_other] in O; apply andb_prop in O as [D I].
  exists x; specialize (Wholes x I); unfold as_whole in Wholes; cbn [eval] in E; destruct (look x now) as [v |].
  - injection E as ->; destruct Wholes as (j & L & L' & Z & V & S); exists j; cbn [StageFiveLimbs.given_to]; rewrite L; destruct (String.eqb_spec x n); [discriminate | tauto].
  - destruct (fields x now); discriminate.
Qed.
Lemma plain_given now now' m e v : agree now now' m -> plainly e = true -> eval known now e = Some v -> evaluated now' m e = Some v /\ given_to now' m e = given_plainly now' m e.
Proof.
  intros A P E; split; [apply (shown_is now now' m A e v); [destruct e; cbn [StageFiveLimbs.of_signs]; rewrite P; reflexivity | exact E] |].
  destruct A as (_ & Rooms_ & _), e as [n | | | | | | |]; try reflexivity; cbn [StageFiveLimbs.given_to]; destruct (look n now') as [[] |] eqn:L; try reflexivity.
  apply Rooms_ in L; destruct (plain_apart n n P L) as [D _]; congruence.
Qed.
Lemma filled_is now now' m n k j : agree now now' m -> look n rooms = Some j -> eval known now (Named n) = Some (Room k) ->
  k = j /\ look n now = Some (Room k) /\ given_to now' m (Named n) = Some [To (address n)] /\ room (owned (address n)) = limbs_for k.
Proof.
  intros (_ & _ & Wholes) R E; assert (I : is_integer n = true) by (unfold StageFiveLimbs.is_integer; rewrite R; reflexivity); specialize (Wholes n I); unfold as_whole in Wholes; cbn [eval StageFiveLimbs.given_to] in *.
  destruct (look n now) as [v |].
  - injection E as ->; destruct Wholes as (L & L' & _); rewrite L; rewrite R in L'; injection L' as ->; repeat split; apply room_of_address; exact R.
  - destruct (fields n now); discriminate.
Qed.

Lemma filling_args f x0 x1 x2 v : filling f [x0; x1; x2] = Some v -> exists k a c, x0 = Room k /\ x1 = Whole a /\ x2 = Whole c /\ in_room k (f a c) = Some v.
Proof. destruct x0; try discriminate; destruct x1; try discriminate; destruct x2; try discriminate; intros E; do 3 eexists; repeat split; exact E. Qed.
Lemma parts_are {A} (K : Z -> Z -> Z -> Z -> option A) x u v :
  match x with Rec [(_, Of Int s); (_, Of Int e); (_, Of U64 a)] => match u with Of Int unit => K s e a unit | _ => None end | _ => None end = Some v ->
  exists n1 n2 n3 s e a unit, x = Rec [(n1, Of Int s); (n2, Of Int e); (n3, Of U64 a)] /\ u = Of Int unit /\ K s e a unit = Some v.
Proof.
  destruct x; try discriminate; destruct l as [| [n1 d1] l]; try discriminate; destruct d1; try discriminate; destruct t; try discriminate.
  destruct l as [| [n2 d2] l]; try discriminate; destruct d2; try discriminate; destruct t; try discriminate; destruct l as [| [n3 d3] l]; try discriminate; destruct d3; try discriminate.
  destruct t; try discriminate; destruct l; try discriminate; destruct u; try discriminate; destruct t; try discriminate; intros E; do 7 eexists; repeat split; exact E.
Qed.
Lemma shift_below s M d k : LongRuns.is_sign s -> s <> 0 -> 0 < M -> 0 <= d -> Z.abs (s * (M * 2 ^ d)) < 2 ^ k -> d < k.
Proof.
  intros S N P D H; pose proof (Z.pow_pos_nonneg 2 d ltac:(lia) D); rewrite Z.abs_mul, (Z.abs_eq (M * _)) in H by (apply Z.mul_nonneg_nonneg; lia).
  replace (Z.abs s) with 1 in H by (destruct S as [-> | [-> | ->]]; [reflexivity | congruence | reflexivity]).
  assert (2 ^ d < 2 ^ k) by nia; destruct (Z.lt_ge_cases k 0); [rewrite (Z.pow_neg_r 2 k) in * by assumption; lia | apply Z.pow_lt_mono_r_iff in H1; lia].
Qed.
Lemma filling_is t n e f given : filling_of t n e = Some (f, given) -> t = "" /\ e = Called f (Named n :: given) /\ is_in f fillings = true.
Proof.
  destruct e as [| | | | h [| [k | | | | | | |] l] | | |]; try discriminate; cbn [filling_of]; destruct (is "" t && is n k && is_in h fillings) eqn:C; [| discriminate].
  intros E; injection E as <- <-; apply andb_prop in C as [C I]; apply andb_prop in C as [T N]; apply String.eqb_eq in T, N; subst; auto.
Qed.

Lemma fills now now' m n f given v : agree now now' m -> is_in f fillings = true -> fills_right n f given = true ->
  eval known now (Called f (Named n :: given)) = Some v -> exists z l, v = Whole z /\ every (map (given_to now' m) (Named n :: given)) = Some l
  /\ forall K : option content -> memory -> Prop, (forall m', agree (bound n v now) now' m' -> K None m') -> call f (List.concat l) m K.
Proof.
  intros A F R E; unfold StageFiveLimbs.fills_right in R; destruct (look n rooms) as [k |] eqn:L; [| discriminate]; destruct given as [| a [| c [|]]]; try discriminate.
  pose proof (rooms_bounded bits Bits rooms Rooms) as bounded; assert (Few : forall a, room a < 2 ^ 20) by (intros b; apply bounded).
  assert (P : 0 <= room (owned (address n))) by apply bounded; assert (I : is_integer n = true) by (unfold StageFiveLimbs.is_integer; rewrite L; reflexivity).
  assert (K0 : 0 <= k < 2 ^ 20) by (destruct (integer_in n I) as (j & E' & _ & K0 & _); congruence); destruct (limbs_suffice bits Bits k (proj1 K0)) as (_ & Suffice & Suffice').
  assert (apart : forall x, x <> n -> look x rooms <> None -> address x <> address n) by (intros x D X; apply addresses_apart; assumption).
  change (eval known now (Called f [Named n; a; c])) with
    (try m <- look f known; try l <- every [eval known now (Named n); eval known now a; eval known now c]; m l) in E.
  destruct (eval known now (Named n)) as [x0 |] eqn:E0; [| destruct (look f known); discriminate].
  destruct (eval known now a) as [x1 |] eqn:E1; [| destruct (look f known); discriminate].
  destruct (eval known now c) as [x2 |] eqn:E2; [| destruct (look f known); discriminate]; cbn [every] in E.
  assert (shorter : forall e, is_shorter k n e = true -> is_other n e = true /\ forall x j, e = Named x -> look x rooms = Some j -> j <= k).
  { intros e H; apply andb_prop in H as [H1 H2]; split; [exact H1 |]; intros x j -> Ej; rewrite Ej in H2; apply Z.leb_le; exact H2. }
  assert (less : forall x j, j <= k -> Z.abs x < 2 ^ j -> Z.abs x < B ^ room (owned (address n))).
  { intros x j J X; unfold StageFiveLimbs.room, owned, StageFiveLimbs.address; rewrite (room_of_address bits _ _ _ L); pose proof (Z.pow_le_mono_r 2 j k ltac:(lia) J); lia. }
  assert (done : forall z m', k = k -> look n now = Some (Room k) -> Z.abs z < 2 ^ k -> is_value m' (address n) z -> changes_only owned room (address n) m m' ->
    agree (bound n (Whole z) now) now' m').
  { intros z m' _ N Z V Ch; apply (agree_filled now now' m m' n k z); assumption. }
  apply existsb_exists in F as (f' & F & G); apply String.eqb_eq in G; subst f'.
  Ltac of_number A H E := destruct (other_is _ _ _ _ _ _ A H E) as (?x & ?j & -> & ?D & ?L & ?G & ?V & ?Z).
  Ltac in_its_room E := unfold in_room, provided in E; lazymatch type of E with context [Z.ltb ?z ?k] => destruct (Z.ltb_spec z k) as [Fits |]; [| discriminate] end; injection E as <-.
  destruct F as [<- | [<- | [<- | [<- | [<- | []]]]]].
  - change (look "hc_add" known) with (Some (filling Z.add)) in E; cbn in R; apply andb_prop in R as [Ra Rc].
    apply filling_args in E as (k' & z1 & z2 & -> & -> & -> & E); destruct (filled_is _ _ _ _ _ _ A L E0) as (-> & N & Gn & Rn); in_its_room E; destruct (shorter _ Ra) as [Oa Sa], (shorter _ Rc) as [Oc Sc].
    of_number A Oa E1; of_number A Oc E2; eexists; eexists; split; [reflexivity |]; cbn [map]; rewrite Gn, G, G0; split; [reflexivity |]; cbn [List.concat app]; intros K Post.
    unfold StageFiveLimbs.call; eapply (add_text bits Bits owned room Few 0 m (address n) (address x) (address x0)); try apply apart; try congruence; try eassumption.
    + apply less with j; eauto.
    + apply less with j0; eauto.
    + apply less with k; [lia | exact Fits].
    + intros m' V' Ch; apply Post, done; auto.
  - change (look "hc_subtract" known) with (Some (filling Z.sub)) in E; cbn in R; apply andb_prop in R as [Ra Rc].
    apply filling_args in E as (k' & z1 & z2 & -> & -> & -> & E); destruct (filled_is _ _ _ _ _ _ A L E0) as (-> & N & Gn & Rn); in_its_room E; destruct (shorter _ Ra) as [Oa Sa], (shorter _ Rc) as [Oc Sc].
    of_number A Oa E1; of_number A Oc E2; eexists; eexists; split; [reflexivity |]; cbn [map]; rewrite Gn, G, G0; split; [reflexivity |]; cbn [List.concat app]; intros K Post.
    unfold StageFiveLimbs.call; eapply (subtract_text bits Bits owned room Few 0 m (address n) (address x) (address x0)); try apply apart; try congruence; try eassumption.
    + apply less with j; eauto.
    + apply less with j0; eauto.
    + apply less with k; [lia | exact Fits].
    + intros m' V' Ch; apply Post, done; auto.
  - change (look "hc_multiply" known) with (Some (filling Z.mul)) in E; cbn in R; apply andb_prop in R as [Ra Rc].
    apply filling_args in E as (k' & z1 & z2 & -> & -> & -> & E); destruct (filled_is _ _ _ _ _ _ A L E0) as (-> & N & Gn & Rn); in_its_room E.
    of_number A Ra E1; of_number A Rc E2; eexists; eexists; split; [reflexivity |]; cbn [map]; rewrite Gn, G, G0; split; [reflexivity |]; cbn [List.concat app]; intros K Post.
    unfold StageFiveLimbs.call; change routines with LongProducts.routines.
    eapply (multiply_text bits Bits owned room Few 1 m (address n) (address x) (address x0)); try apply apart; try congruence; try eassumption.
    + unfold StageFiveLimbs.room at 1; unfold owned at 1; unfold StageFiveLimbs.address at 1; rewrite (room_of_address bits _ _ _ L); lia.
    + intros m' V' Ch; apply Post, done; auto.
  - cbn in R; apply andb_prop in R as [Ra Rc]; destruct a as [| ta za | | | | | |]; try discriminate; destruct ta; try discriminate; apply Z.ltb_lt in Ra; cbn [eval] in E1; injection E1 as <-.
    cbn [of_integers look String.eqb Ascii.eqb Bool.eqb] in E; destruct x0 as [| | | | | k' | |]; try discriminate; destruct x2 as [| | | | | | z2 |]; try discriminate.
    destruct (Z.ltb_spec 0 za) as [za0 |]; [| discriminate]; destruct (filled_is _ _ _ _ _ _ A L E0) as (-> & N & Gn & Rn); in_its_room E; of_number A Rc E2.
    eexists; eexists; split; [reflexivity |]; cbn [map]; rewrite Gn, G; split; [reflexivity |]; cbn [List.concat app]; intros K Post.
    unfold StageFiveLimbs.call; change routines with LongProducts.routines.
    eapply (scale_text bits Bits owned room Few 2 m (address n) (address x) za Int); try apply apart; try congruence; try eassumption.
    + pose proof (apart x D ltac:(congruence)); congruence.
    + left; reflexivity.
    + split; [exact za0 |]; apply Z.lt_le_trans with (2 ^ 32); [exact Ra |]; apply Z.pow_le_mono_r; destruct Bits; lia.
    + apply less with k; [lia | exact Fits].
    + intros m' V' Ch; apply Post, done; auto.
  - cbn in R; apply andb_prop in R as [Ra Rc].
    cbn [of_integers look String.eqb Ascii.eqb Bool.eqb] in E; destruct x0 as [| | | | | k' | |]; try discriminate.
    apply parts_are in E as (n1 & n2 & n3 & s & e & M & unit & -> & -> & E); destruct (are_parts s M && ((s =? 0) || (unit <=? e))) eqn:C; [| discriminate]; apply andb_prop in C as [C Units].
    destruct (filled_is _ _ _ _ _ _ A L E0) as (-> & N & Gn & Rn); in_its_room E; unfold in_units in *.
    assert (G1 : given_to now' m a = Some [Holds Int s; Holds Int e; Holds U64 M]).
    { destruct (plain_given _ _ m _ _ A Ra E1) as [E' ->]; unfold StageFiveLimbs.given_plainly; rewrite E'; reflexivity. }
    assert (G2 : given_to now' m c = Some [Holds Int unit]).
    { destruct (plain_given _ _ m _ _ A Rc E2) as [E' ->]; unfold StageFiveLimbs.given_plainly; rewrite E'; reflexivity. }
    eexists; eexists; split; [reflexivity |]; cbn [map]; rewrite Gn, G1, G2; split; [reflexivity |]; cbn [List.concat app]; intros K Post.
    assert (S : LongRuns.is_sign s /\ (s <> 0 -> 0 < M < 2 ^ 64 /\ unit <= e)).
    { unfold are_parts in C; destruct (Z.eqb_spec s 0) as [-> |]; [split; [right; left; reflexivity | congruence] |]; cbn [orb] in *.
      apply andb_prop in C as [C M1]; apply andb_prop in C as [S1 M0]; apply Z.eqb_eq in S1; apply Z.ltb_lt in M0, M1; apply Z.leb_le in Units; unfold LongRuns.is_sign; lia. }
    destruct S as [S S']; unfold StageFiveLimbs.call; change routines with LongUnits.routines.
    eapply (in_units_text bits Bits owned room Few 2 m (address n) s e M unit); try eassumption.
    + intros NZ; destruct (S' NZ) as [M0 U]; split; [exact M0 |]; split; [lia |].
      pose proof (shift_below s M (e - unit) k S NZ ltac:(lia) ltac:(lia) Fits); lia.
    + apply less with k; [lia | exact Fits].
    + intros m' V' Ch; apply Post, done; auto.
Qed.

(** What whole numbers answer, limbs answer. *)
Theorem goes_as_whole f : forall now now' m l v now'' (R : datum -> Prop), is_right_text f l = true -> agree now now' m -> go known [] f now l = Some (Some v, now'') -> R v -> goes f now' m l R.
Proof.
  induction f as [| f IH]; intros now now' m l v now'' R T A G Post; [discriminate |]; destruct l as [| [t n e | g given | c yes no | i count by_ turn | a i e | e] rest]; try discriminate; cbn [StageFiveLimbs.is_right_text go StageFiveLimbs.goes] in *.
  - apply andb_prop in T as [Rest T]; destruct (is_new t n now) eqn:New; [| discriminate].
    destruct (eval known now e) as [x |] eqn:E; [| discriminate]; destruct (held t x) as [w |] eqn:H; [| discriminate].
    destruct (is "hc_integer" t) eqn:I.
    + apply String.eqb_eq in I; subst t; destruct e as [| | | | h [| [| [] k | | | | | |] [|]] | | |]; try discriminate; apply andb_prop in T as [T L].
      destruct (look n rooms) as [j |] eqn:L'; [| discriminate]; apply Z.eqb_eq in L; subst j; split; [exact T |]; apply String.eqb_eq in T; subst h.
      cbn in E; injection E as <-; cbn in H; injection H as <-; unfold is_new in New; cbn in New; destruct (look n now) as [d |] eqn:N; [discriminate |].
      split; [pose proof (proj2 (proj2 A) n) as W; unfold StageFiveLimbs.is_integer, as_whole in W; rewrite L', N in W; apply W; reflexivity |].
      split; [apply room_of_address; exact L' |]; apply (IH ((n, Room k) :: now) _ _ rest v now''); try assumption; apply agree_declared; assumption.
    + destruct (filling_of t n e) as [[g given] |] eqn:F.
      * apply filling_is in F as (-> & -> & F); cbn in H; injection H as <-; destruct (fills now now' m n g given x A F T E) as (z & l & _ & -> & Ends).
        apply Ends; intros m' A'; apply (IH (bound n x now) now' m' rest v now''); assumption.
      * apply andb_prop in T as [T Pe]; apply andb_prop in T as [T Pn]; destruct (plain_given now now' m e x A Pe E) as [-> _]; rewrite H.
        split; [unfold is_new in *; rewrite <- (proj1 (proj1 A n Pn)); exact New |].
        apply (IH (bound n w now) _ _ rest v now''); try assumption; apply agree_plain with (t := t) (v := x); try assumption.
        { apply orb_prop in T as [T | T]; [left | apply andb_prop in T as [T _]; right]; apply String.eqb_eq in T; congruence. }
        intros l k y -> Y j ->; apply orb_prop in T as [T | T]; [apply String.eqb_eq in T; subst t; discriminate H |].
        apply andb_prop in T as [_ T]; destruct e as [| | | | h given | | |]; try discriminate; apply String.eqb_eq in T; subst h; cbn in E.
        destruct (every (map (eval known now) given)) as [[| [] [|]] |]; try discriminate; injection E as <-; destruct Y as [Y | [Y | [Y | []]]]; discriminate.
  - apply andb_prop in T as [T No]; apply andb_prop in T as [C Yes]; destruct (eval known now c) as [d |] eqn:E; [| discriminate]; destruct d as [u z | | | | | | |]; try discriminate.
    rewrite (shown_is now now' m A c _ C E); apply (IH now now' m _ v now''); try assumption; destruct (z =? 0); assumption.
  - destruct (eval known now e) as [x |] eqn:E; [| discriminate]; injection G as <- <-; rewrite (shown_is now now' m A e x T E); exact Post.
Qed.

End Integers.

(** ** The position. *)

(** Names of texts are unfolded before what runs them. *)
Strategy 100 [called_within].

Section Position.
Variables (m e : string -> Z) (zeros : Z -> Z).
(** A valid row, as in StageFiveAnswers.v. *)
Hypotheses (Zeros : counts_zeros zeros) (Sizes : forall n, In n ["alpha"; "gamma"; "b"; "d"] -> 0 < m n) (Mantissas : forall n, In n lengths -> Z.abs (m n) < 2 ^ 53)
  (Powers : forall n, In n lengths -> m n <> 0 -> e n <= 2046 /\ 1 <= e n + zeros (m n)).
Let p := upright (value_of m e "alpha") (value_of m e "gamma") (value_of m e "b") (value_of m e "d") (value_of m e "x") (value_of m e "y") (value_of m e "z").

(** The text with its integers in limbs, whatever lies in memory before. *)
Definition ends_on_limbs bits functions n given memory (R : datum -> Prop) := match look n functions with
  | Some f => match bound_all (map Named (firstn (List.length given) (takes f))) given constants with
    | Some now => goes bits C_rooms zeros steps_of_run now memory (does f) R | None => False end
  | None => False end.

Theorem one_is_returned bits functions n given memory R R' : ends_on_limbs bits functions n given memory R -> ends_on_limbs bits functions n given memory R' -> meet R R'.
Proof. unfold ends_on_limbs; destruct (look n functions); [destruct (bound_all _ _ _); [apply goes_one | contradiction] | contradiction]. Qed.

Theorem text_is_right : exists f, look "hc_position_by_integers" StageFiveAnswers.functions = Some f /\ takes f = ["row"] /\ is_right_text C_rooms steps_of_run (does f) = true
  /\ forallb (fun p => (0 <=? snd p) && (snd p <? 2 ^ 20)) C_rooms = true /\ forallb (fun p => is_named (fst p)) C_rooms = true.
Proof. eexists; split; [exact text_is |]; vm_compute; repeat split; reflexivity. Qed.

Lemma begins_alike bits now memory : bound_all [Named "row"] [row m e] constants = Some now -> agree bits C_rooms now now memory.
Proof.
  intros E; assert (F : forallb (fun p => is_none (look (fst p) now) && is_none (look (fst p ++ ".sign") now)) C_rooms = true).
  { vm_compute in E; injection E as <-; vm_compute; reflexivity. }
  assert (NR : forallb (fun p => match snd p with Room _ => false | _ => true end) now = true) by (vm_compute in E; injection E as <-; vm_compute; reflexivity).
  split; [split; reflexivity |]; split.
  - intros n k L; apply look_in in L; apply (proj1 (forallb_forall _ _) NR) in L; discriminate L.
  - intros n I; unfold is_integer in I; destruct (look n C_rooms) as [k |] eqn:L; [| discriminate]; apply look_in in L; apply (proj1 (forallb_forall _ _) F) in L.
    apply andb_prop in L as [L1 L2]; cbn [fst] in *; unfold as_whole; destruct (look n now); [discriminate |]; destruct (look (n ++ ".sign") now); [discriminate | auto].
Qed.

Lemma whole_to_limbs bits functions n f v memory (R : datum -> Prop) : bits = 32 \/ bits = 64 -> look n functions = Some f -> takes f = ["row"] ->
  is_right_text C_rooms steps_of_run (does f) = true -> called_within functions (of_integers zeros) [] n [row m e] = Some v -> R v -> ends_on_limbs bits functions n [row m e] memory R.
Proof.
  intros Bits L One T E Post; unfold ends_on_limbs, called_within in *; rewrite L, One in *; cbn [List.length firstn map] in *.
  destruct (bound_all [Named "row"] [row m e] constants) as [now |] eqn:N; [| discriminate].
  destruct (go (of_integers zeros) [] steps_of_run now (does f)) as [[w now''] |] eqn:G; [| discriminate]; subst w; destruct text_is_right as (_ & _ & _ & _ & Rooms & Named_).
  exact (goes_as_whole bits Bits C_rooms zeros Rooms Named_ _ now now memory _ _ now'' R T (begins_alike bits now memory N) G Post).
Qed.

(** Limbs answer what whole numbers answer, and that is the position. *)
Theorem limbs_answer_the_position bits memory : bits = 32 \/ bits = 64 -> exists a, answer_of_integers m e zeros = Some (Of Int (code (Some a)))
  /\ ends_on_limbs bits StageFiveAnswers.functions "hc_position_by_integers" [row m e] memory (fun v => v = Of Int (code (Some a))) /\ is_position p a.
Proof.
  intros Bits; destruct (text_answers_by_integers m e zeros Zeros Sizes Mantissas Powers) as (a & E & P); exists a; split; [exact E |]; split; [| exact P].
  destruct text_is_right as (f & L & One & T & _); unfold answer_of_integers in E; exact (whole_to_limbs bits _ _ f _ memory _ Bits L One T E eq_refl).
Qed.
End Position.
