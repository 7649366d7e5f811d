(** Steps of floats in the functions of the header that decide: what Trees.v reads of them is a list of steps, and to run it gives
    each name the float that the step of that name gives.

    Nothing is said here of what a float is. An operator or a call finds the step that has it with these arguments; there must be one
    alone. In a loop a float belongs to a turn of it, unless it was there before, [outer]; floats of two turns do not meet. A place in
    an array, one of [arrays], moves by whole numbers. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Limbs Trees.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** ** The text: declarations as steps, by the operations that Steps.v gives them. *)

Definition operand (e : expression) : option argument := match e with
  | Named n => Some (Name n) | Constant Int z => Some (Number z)
  | Called f [Constant Int z] => if is "HC_SET" f then Some (Number z) else None | _ => None end.
Definition arithmetic := [("+", "add"); ("-", "sub"); ("*", "mul"); ("/", "div")].
Definition comparisons := ["HC_GT"; "HC_LT"; "HC_GE"; "HC_LE"; "HC_AND"; "HC_OR"; "HC_ABS"].
Definition is_zero (e : expression) := match operand e with Some (Number 0) => true | _ => false end.
Definition value_in n (e : expression) : option step := match e with
  | Infix o l r => if is "-" o && is_zero l then made n (Some "neg") (every [operand r])
    else made n (look o arithmetic) (every [operand l; operand r])
  | Called f given => if is_in f comparisons then made n (Some f) (every (map operand given)) else None
  | _ => None end.
Definition step_in (t : tree) : option step := match t with
  | Set_ t n e => if is_in t ["double"; "HC_NUMBER"; "HC_TRUTH"] then value_in n e else None | _ => None end.

(** ** The meaning. *)

(** The turn of what no turn computes. *)
Definition always := -1.
Definition agreed j k := if j =? always then Some k else if k =? always then Some j else if j =? k then Some j else None.
Fixpoint turn_of (given : list datum) : option Z := match given with
  | [] => Some always | Opaque _ k :: rest => try j <- turn_of rest; agreed k j | _ :: rest => turn_of rest end.
Definition argument_in d := match d with Opaque n _ => Some (Name n) | Of Int z => Some (Number z) | _ => None end.

Definition find_step (l : list step) o given := find (fun s => String.eqb (operation s) o && same_list same_argument (arguments s) given) l.
Definition by_steps l o (given : list datum) : option datum :=
  try a <- every (map argument_in given); try k <- turn_of given; try s <- find_step l o a; Some (Opaque (name s) k).
Definition minus_by_steps l (given : list datum) := match given with [Of Int 0; v] => by_steps l "neg" [v] | _ => by_steps l "sub" given end.
Definition plus_by_steps arrays l (given : list datum) := match given with
  | [Opaque n j; Of _ z] => if is_in n arrays then Some (Opaque n (j + z)) else by_steps l "add" given | _ => by_steps l "add" given end.
Definition itself (given : list datum) := match given with [v] => Some v | _ => None end.
Definition of_floats arrays l : list (string * (list datum -> option datum)) := [("HC_SET", itself); ("+", plus_by_steps arrays l); ("-", minus_by_steps l);
  ("*", by_steps l "mul"); ("/", by_steps l "div")] ++ map (fun f => (f, by_steps l f)) comparisons.

(** ** What a step that is read so computes. *)

Section Run.

Variables (l : list step) (arrays outer : list string) (k : Z) (procedures : list (string * (nat * (list datum -> option (list datum))))).
Variable further : list (string * (list datum -> option datum)).
Let known := (of_floats arrays l ++ further)%list.

Definition float_of n := Opaque n (if is_in n outer then always else k).
Definition datum_of a := match a with Name n => float_of n | Number z => Of Int z end.

(** One step alone has this operation with these arguments, and one of these is of the turn. *)
Definition alone (s : step) := match find_step l (operation s) (arguments s) with Some t => String.eqb (name t) (name s) | None => false end.
Definition in_turn (s : step) := existsb (fun a => match a with Name n => negb (is_in n outer) | _ => false end) (arguments s).

Definition known_in have a := match a with Name n => is_in n have && negb (is_in n arrays) | Number _ => true end.
Fixpoint fits (have : list string) (steps : list step) : bool := match steps with
  | [] => true
  | s :: rest => forallb (known_in have) (arguments s)
    && negb (is_in (name s) have) && negb (is_in (name s) outer) && alone s && in_turn s && fits (name s :: have) rest end.

Lemma agreed_turn j i : (j = always \/ j = k) -> (i = always \/ i = k) -> agreed j i = Some (if j =? always then i else k).
Proof.
  unfold agreed; intros [-> | ->] [-> | ->]; rewrite ?Z.eqb_refl; try reflexivity;
    destruct (Z.eqb_spec k always) as [-> |]; rewrite ?Z.eqb_refl; reflexivity.
Qed.

Lemma turn_of_data given : exists j, turn_of (map datum_of given) = Some j /\ (j = always \/ j = k)
  /\ (existsb (fun a => match a with Name n => negb (is_in n outer) | _ => false end) given = true -> j = k).
Proof.
  induction given as [| [n | z] given (j & IH & J & T)]; [exists always; repeat split; auto; discriminate | |].
  - cbn [map turn_of datum_of float_of existsb]; unfold float_of; rewrite IH; destruct (is_in n outer); cbn [negb orb].
    + rewrite agreed_turn by auto; exists j; auto.
    + rewrite agreed_turn by auto; exists (if k =? always then j else k); split; [reflexivity |].
      destruct (Z.eqb_spec k always) as [E |]; [| split; auto]; rewrite E in *; destruct J; auto.
  - exists j; auto.
Qed.

Lemma data_named given : every (map argument_in (map datum_of given)) = Some given.
Proof. induction given as [| [n | z] given IH]; cbn; rewrite ?IH; reflexivity. Qed.

Lemma found_alone s : alone s = true -> in_turn s = true -> by_steps l (operation s) (map datum_of (arguments s)) = Some (Opaque (name s) k).
Proof.
  unfold alone, in_turn, by_steps; intros A T; rewrite data_named; destruct (turn_of_data (arguments s)) as (j & -> & _ & J); rewrite (J T).
  destruct (find_step l _ _) as [t |]; [| discriminate]; apply String.eqb_eq in A; rewrite A; reflexivity.
Qed.

Section Now.
Variable now : environment.
Definition has_all (have : list string) := forall n, is_in n have = true -> look n now = Some (float_of n).

Lemma operand_is have e a : has_all have -> operand e = Some a -> known_in have a = true -> eval known now e = Some (datum_of a).
Proof.
  intros H E I; destruct e as [n | t z | | | f given | | |]; try discriminate.
  - injection E as <-; apply andb_prop in I as [I _]; cbn [eval]; rewrite (H n I); reflexivity.
  - destruct t; try discriminate; injection E as <-; reflexivity.
  - cbn [operand] in E; destruct given as [| [| [] z | | | | | |] [|]]; try discriminate; destruct (String.eqb_spec "HC_SET" f) as [<- | N].
    + injection E as <-; reflexivity.
    + unfold is in E; apply String.eqb_neq in N; rewrite N in E; discriminate.
Qed.
Lemma operands_are have : has_all have -> forall given l, every (map operand given) = Some l -> forallb (known_in have) l = true ->
  every (map (eval known now) given) = Some (map datum_of l).
Proof.
  intros H; induction given as [| e given IH]; intros r E I; [injection E as <-; reflexivity |]; cbn [map every] in *.
  destruct (operand e) as [a |] eqn:O; [| discriminate]; destruct (every (map operand given)) as [r' |] eqn:G; [| discriminate]; injection E as <-.
  cbn [forallb] in I; apply andb_prop in I as [I1 I2]; rewrite (operand_is have e a H O I1), (IH r' eq_refl I2); reflexivity.
Qed.

Lemma made_is n o given s : made n o given = Some s -> exists w a, o = Some w /\ given = Some a /\ s = Step n w a.
Proof. unfold made; destruct o as [w |], given as [a |]; try discriminate; intros E; injection E as <-; eauto. Qed.

Lemma looked o f : look o (of_floats arrays l) = Some f -> look o known = Some f.
Proof. unfold known; generalize (of_floats arrays l) as t; induction t as [| [m g] t IH]; cbn; [discriminate |]; destruct (String.eqb m o); auto. Qed.

Lemma value_is have n e s : has_all have -> value_in n e = Some s -> forallb (known_in have) (arguments s) = true ->
  alone s = true -> in_turn s = true -> eval known now e = Some (Opaque (name s) k).
Proof.
  intros H E I A T; pose proof (found_alone s A T) as F.
  destruct e as [| | o l' r | | f given | | |]; try discriminate; cbn [value_in] in E.
  - destruct (is "-" o && is_zero l') eqn:N.
    + apply andb_prop in N as [N1 N2]; apply String.eqb_eq in N1; subst o; unfold is_zero in N2.
      destruct (operand l') as [[| []] |] eqn:Z; try discriminate; pose proof (operand_is have l' _ H Z eq_refl) as EZ; cbn [datum_of] in EZ.
      apply made_is in E as (w & a & W & G & ->); injection W as <-; cbn [every] in G; destruct (operand r) as [p |] eqn:P; [injection G as <- | discriminate].
      cbn [arguments forallb] in I; apply andb_prop in I as [I _]; pose proof (operand_is have r p H P I) as EL.
      destruct p as [m | z]; [| discriminate T]; change (datum_of (Name m)) with (float_of m) in EL; unfold float_of in EL.
      cbn [eval]; rewrite EZ, EL; exact F.
    + apply made_is in E as (w & a & W & G & ->); cbn [every] in G.
      destruct (operand l') as [p |] eqn:P; [| discriminate]; destruct (operand r) as [q |] eqn:Q; [injection G as <- | discriminate].
      cbn [arguments forallb] in I; apply andb_prop in I as [I1 I2]; apply andb_prop in I2 as [I2 _].
      pose proof (operand_is have l' p H P I1) as EL; pose proof (operand_is have r q H Q I2) as ER.
      assert (K : exists g, look o known = Some g /\ g [datum_of p; datum_of q] = by_steps l w [datum_of p; datum_of q] /\ String.eqb o "&&" = false /\ String.eqb o "||" = false).
      { unfold arithmetic in W; cbn [look] in W; repeat match type of W with (if String.eqb ?c o then _ else _) = _ =>
          destruct (String.eqb_spec c o) as [<- | _]; [injection W as <- |] end; [.. | discriminate]; (eexists; split; [apply looked; reflexivity |]); repeat split; try reflexivity.
        - unfold plus_by_steps; destruct p as [m | z], q as [m' | z']; cbn [datum_of]; try reflexivity; unfold float_of.
          apply andb_prop in I1 as [_ I1]; apply negb_true_iff in I1; rewrite I1; reflexivity.
        - unfold minus_by_steps; destruct p as [m | []]; cbn [datum_of]; try reflexivity; unfold is_zero in N; rewrite P in N; discriminate N. }
      destruct K as (g & G & V & O1 & O2); cbn [eval]; rewrite EL, ER; unfold is in *; rewrite O1, O2, G.
      cbn [in_turn arguments existsb] in T; cbn [operation arguments map name] in F; rewrite <- V in F.
      destruct p as [m | z], q as [m' | z']; cbn [datum_of] in F |- *; unfold float_of in *; try exact F; discriminate T.
  - destruct (is_in f comparisons) eqn:C; [| discriminate]; apply made_is in E as (w & a & W & G & ->); injection W as <-.
    cbn [eval]; rewrite (operands_are have H given a G I).
    assert (K : look f known = Some (by_steps l f)).
    { apply looked; unfold comparisons, is_in in C; cbn [existsb] in C; repeat (apply orb_prop in C as [C | C]; [apply String.eqb_eq in C; subst f; reflexivity |]); discriminate. }
    rewrite K; exact F.
Qed.
End Now.

(** The variables after the steps. *)
Definition given_floats (names : list string) (now : environment) : environment := fold_left (fun now n => (n, Opaque n k) :: now) names now.

Lemma look_given n : forall names now, look n (given_floats names now) = if is_in n names then Some (Opaque n k) else look n now.
Proof.
  induction names as [| m names IH]; intros now; [reflexivity |]; cbn [given_floats fold_left]; fold (given_floats names ((m, Opaque m k) :: now)); rewrite IH; cbn [look].
  change (is_in n (m :: names)) with (String.eqb n m || is_in n names); rewrite String.eqb_sym; destruct (String.eqb_spec n m) as [-> |]; destruct (is_in _ names); reflexivity.
Qed.

Lemma fits_new : forall steps have, fits have steps = true -> forall s, In s steps -> is_in (name s) have = false.
Proof.
  induction steps as [| t steps IH]; intros have F s I; [destruct I |]; cbn [fits] in F; repeat (apply andb_prop in F as [F ?F]).
  destruct I as [<- | I]; [apply negb_true_iff; assumption |]; pose proof (IH (name t :: have) ltac:(assumption) s I) as G.
  cbn [is_in existsb] in G; apply orb_false_elim in G as [_ G]; exact G.
Qed.

Theorem go_steps : forall steps trees have now f rest, map step_in trees = map Some steps -> fits have steps = true -> has_all now have ->
  (forall s, In s steps -> look (name s) now = None) ->
  go known procedures (List.length steps + f) now (trees ++ rest) = go known procedures f (given_floats (map name steps) now) rest.
Proof.
  induction steps as [| s steps IH]; intros trees have now f rest E F H N; destruct trees as [| t trees]; try discriminate; [reflexivity |].
  cbn [map] in E; injection E as E1 E2; cbn [fits] in F; repeat (apply andb_prop in F as [F ?F]).
  destruct t as [ty n e | | | | |]; try discriminate; cbn [step_in] in E1; destruct (is_in ty ["double"; "HC_NUMBER"; "HC_TRUTH"]) eqn:Y; [| discriminate].
  pose proof (value_is now have n e s H E1 F F2 F1) as V; assert (M : name s = n).
  { destruct e; try discriminate; cbn [value_in] in E1; [destruct (is "-" o && is_zero e1) | destruct (is_in f0 comparisons); [| discriminate]];
      apply made_is in E1 as (w & a & _ & _ & ->); reflexivity. }
  cbn [List.length Nat.add app go]; unfold is_new; rewrite <- M, (N s (or_introl eq_refl)), orb_true_r; rewrite V.
  assert (W : held ty (Opaque (name s) k) = Some (Opaque (name s) k)).
  { unfold is_in in Y; cbn [existsb] in Y; repeat (apply orb_prop in Y as [Y | Y]; [apply String.eqb_eq in Y; subst ty; reflexivity |]); discriminate. }
  rewrite W; cbn [bound given_floats map fold_left]; apply (IH trees (name s :: have)); try assumption.
  - intros q I; change (is_in q (name s :: have)) with (String.eqb q (name s) || is_in q have) in I; cbn [look].
    destruct (String.eqb_spec (name s) q) as [D | D]; [subst q |].
    + unfold float_of; apply negb_true_iff in F3; rewrite F3; reflexivity.
    + apply not_eq_sym, String.eqb_neq in D; rewrite D in I; apply H; exact I.
  - intros s' I; cbn [look]; destruct (String.eqb_spec (name s) (name s')) as [D |]; [| apply N; right; exact I].
    pose proof (fits_new _ _ F0 s' I) as D'; cbn [is_in existsb] in D'; rewrite <- D, String.eqb_refl in D'; discriminate.
Qed.
End Run.
