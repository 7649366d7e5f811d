(** The meaning of functions of long integers, LongIntegers.v, says what must hold for a text to end with what is wanted. Here: no text ends
    with everything, and of two things that it is proved to end with both hold of one outcome. So what is proved to be returned is the
    one thing that is. *)

Require Import List String Ascii ZArith Lia Bool.
From Hypcheck Require Import Steps Limbs Trees LongIntegers.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** Both hold of one. *)
Definition meet {A} (P Q : A -> Prop) := exists a, P a /\ Q a.
Definition meet2 {A B} (P Q : A -> B -> Prop) := exists a b, P a b /\ Q a b.

Section Meaning.
Variable bits : Z.
Variables owned room : Z -> Z.

Lemma made_one t z K K' : made bits t z K -> made bits t z K' -> meet K K'.
Proof. unfold made, meet; destruct t; intros H H'; try (destruct H, H'); eexists; split; eassumption. Qed.
Lemma turned_one t u z K K' : turned bits t u z K -> turned bits t u z K' -> meet K K'.
Proof. unfold turned; destruct (same_type t u); [intros H H'; exists z; split; assumption |]; destruct t, u; try exact (made_one _ z K K'); intros H H'; exists z; split; assumption. Qed.
Lemma of_meet {A B} (f : A -> B) (K K' : B -> Prop) : meet (fun a => K (f a)) (fun a => K' (f a)) -> meet K K'.
Proof. intros (a & H & H'); exists (f a); split; assumption. Qed.
Ltac split_match := match goal with
  | H : False |- _ => contradiction
  | H : context [match ?x with _ => _ end] |- _ => lazymatch x with context [match _ with _ => _ end] => fail | _ => destruct x end end.
Lemma arithmetic_one o t a b K K' : arithmetic bits o t a b K -> arithmetic bits o t a b K' -> meet K K'.
Proof.
  unfold arithmetic, of_type, truth; intros H H'.
  repeat (split_match; try contradiction; try solve [exact (of_meet _ _ _ (made_one _ _ _ _ H H')) | exact (of_meet _ _ _ (made_one _ _ _ _ (proj2 H) (proj2 H'))) | eexists; split; eassumption]).
Qed.
Lemma shifted_one o t a k K K' : shifted bits o t a k K -> shifted bits o t a k K' -> meet K K'.
Proof.
  unfold shifted, of_type; intros (_ & _ & H) (_ & _ & H'); destruct (o =? "<<")%string; [exact (of_meet _ _ _ (made_one _ _ _ _ H H')) | eexists; split; eassumption].
Qed.
Lemma infixed_one o x y K K' : infixed bits room o x y K -> infixed bits room o x y K' -> meet K K'.
Proof.
  unfold infixed; destruct x as [t a | | | b k]; try contradiction; destruct y as [u c | | |]; try contradiction.
  - destruct (is_in o ["<<"; ">>"]); [apply shifted_one |]; destruct (common_type t u) as [v |]; [| contradiction]; intros H H'.
    destruct (turned_one _ _ _ _ _ H H') as (x & X & X'), (turned_one _ _ _ _ _ X X') as (y & Y & Y'); exact (arithmetic_one _ _ _ _ _ _ Y Y').
  - destruct u; try contradiction; intros (_ & _ & H) (_ & _ & H'); eexists; split; eassumption.
Qed.
Lemma in_common_one j k K K' v : in_common bits j k K v -> in_common bits j k K' v -> meet K K'.
Proof.
  unfold in_common, of_type; destruct v as [t z | | |], j as [u |], k as [w |]; try contradiction; try (intros H H'; eexists; split; eassumption).
  destruct (common_type u w); [| contradiction]; intros H H'; exact (of_meet _ _ _ (turned_one _ _ _ _ _ H H')).
Qed.
Lemma named_one now m n K K' : named_value bits owned now m n K -> named_value bits owned now m n K' -> meet K K'.
Proof.
  unfold named_value; destruct (look n now) as [v |]; [destruct v; try contradiction; intros H H'; eexists; split; eassumption |].
  destruct (field_of n "") as [[p f] |]; [| destruct (is n "HC_LIMB_BITS"); [intros H H'; eexists; split; eassumption | contradiction]].
  destruct (look p now) as [v |]; [| contradiction]; destruct v; try contradiction; intros H H'.
  repeat (split_match; try contradiction; try solve [destruct H as (z & E & H), H' as (z' & E' & H'); rewrite E in E'; injection E' as <-; eexists; split; eassumption | eexists; split; eassumption]).
Qed.

Notation value := (value bits owned room).
Theorem value_one e : forall now m K K', value now m e K -> value now m e K' -> meet K K'.
Proof.
  induction e as [n | t z | o l IHl r IHr | c IHc a IHa b IHb | f given | a IHa i IHi | t a IHa | l]; intros now m K K' H H'; cbn [LongIntegers.value] in H, H'; try contradiction.
  - exact (named_one _ _ _ _ _ H H').
  - eexists; split; eassumption.
  - destruct (IHl _ _ _ _ H H') as (x & X & X'), (IHr _ _ _ _ X X') as (y & Y & Y'); exact (infixed_one _ _ _ _ _ Y Y').
  - destruct (IHc _ _ _ _ H H') as (x & X & X'); destruct x; try contradiction; destruct (z =? 0).
    + destruct (IHb _ _ _ _ X X') as (y & Y & Y'); exact (in_common_one _ _ _ _ _ Y Y').
    + destruct (IHa _ _ _ _ X X') as (y & Y & Y'); exact (in_common_one _ _ _ _ _ Y Y').
  - destruct (IHa _ _ _ _ H H') as (x & X & X'), (IHi _ _ _ _ X X') as (y & Y & Y'); destruct x; try contradiction; destruct y; try contradiction; destruct t; try contradiction.
    destruct Y as (_ & z' & E & Y), Y' as (_ & z'' & E' & Y'); rewrite E in E'; injection E' as <-; eexists; split; eassumption.
  - destruct (IHa _ _ _ _ H H') as (x & X & X'); destruct x; try contradiction; exact (of_meet _ _ _ (turned_one _ _ _ _ _ X X')).
Qed.
Lemma as_form_one k v K K' : as_form bits k v K -> as_form bits k v K' -> meet K K'.
Proof.
  unfold as_form; destruct k, v; try contradiction; intros H H'; try (eexists; split; eassumption); exact (of_meet _ _ _ (turned_one _ _ _ _ _ H H')).
Qed.
Lemma put_into_one now m t v K K' : put_into bits owned room now m t v K -> put_into bits owned room now m t v K' -> meet2 K K'.
Proof.
  unfold put_into; destruct t as [n | | | | | a i | |]; try contradiction; destruct v as [u z | | |]; try contradiction; intros H H'.
  - assert (named : forall t, turned bits u t z (fun x => K (with_content n (Holds t x) now) m) -> turned bits u t z (fun x => K' (with_content n (Holds t x) now) m) -> meet2 K K').
    { intros t G G'; destruct (turned_one _ _ _ _ _ G G') as (x & X & X'); do 2 eexists; split; eassumption. }
    destruct (look n now) as [[] |]; try contradiction; eauto; destruct (field_of n "") as [[p f] |]; try contradiction; destruct (look p now) as [[] |]; try contradiction.
    destruct (turned_one _ _ _ _ _ H H') as (x & X & X'); clear H H' named.
    repeat (split_match; try contradiction; try solve [do 2 eexists; split; eassumption]).
  - destruct (value_one _ _ _ _ _ H H') as (x & X & X'), (value_one _ _ _ _ _ X X') as (y & Y & Y'); destruct x; try contradiction; destruct y; try contradiction; destruct t; try contradiction.
    destruct Y as (_ & Y), Y' as (_ & Y'); destruct (turned_one _ _ _ _ _ Y Y') as (w & W & W'); do 2 eexists; split; eassumption.
Qed.
Lemma values_one l : forall now m K K', values bits owned room now m l K -> values bits owned room now m l K' -> meet K K'.
Proof.
  induction l as [| e l IH]; intros now m K K' H H'; cbn [values] in H, H'; [eexists; split; eassumption |].
  destruct (value_one _ _ _ _ _ H H') as (x & X & X'), (IH _ _ _ _ X X') as (y & Y & Y'); eexists; split; eassumption.
Qed.
Lemma bind_all_one l : forall given K K', LongIntegers.bind_all bits l given K -> LongIntegers.bind_all bits l given K' -> meet K K'.
Proof.
  induction l as [| [k n] l IH]; intros [| v given] K K' H H'; cbn [LongIntegers.bind_all] in H, H'; try contradiction; [eexists; split; eassumption |].
  destruct (as_form_one _ _ _ _ H H') as (x & X & X'), (IH _ _ _ X X') as (y & Y & Y'); eexists; split; eassumption.
Qed.

(** Statements: both go on behind them, or both return. *)
Section Calls.
Variable call : string -> list content -> memory -> (option content -> memory -> Prop) -> Prop.
Hypothesis One : forall f l m K K', call f l m K -> call f l m K' -> meet2 K K'.
Notation ends := (ends bits owned room call).

Lemma result_one now m e K K' : result bits owned room call now m e K -> result bits owned room call now m e K' -> meet2 K K'.
Proof.
  intros H H'; destruct e; cbn [result] in H, H'; try (destruct (value_one _ _ _ _ _ H H') as (x & X & X'); do 2 eexists; split; eassumption).
  destruct (values_one _ _ _ _ _ H H') as (l & L & L'), (One _ _ _ _ _ L L') as (v & m' & V & V'); destruct v; [do 2 eexists; split; eassumption | contradiction].
Qed.
Theorem ends_one a : forall now m Q Q' R R', ends a now m Q R -> ends a now m Q' R' -> meet2 Q Q' \/ meet2 R R'.
Proof.
  induction a as [| a IHa b IHb | a IHa | k n e | t o e | b i e | f given | c yes IHyes no IHno | c next IHnext body IHbody | e]; intros now m Q Q' R R' H H'; cbn [LongIntegers.ends] in H, H'.
  - left; do 2 eexists; split; eassumption.
  - destruct (IHa _ _ _ _ _ _ H H') as [(now' & m' & X & X') | W]; [exact (IHb _ _ _ _ _ _ X X') | right; exact W].
  - destruct (IHa _ _ _ _ _ _ H H') as [(now' & m' & X & X') | W]; [left; do 2 eexists; split; eassumption | right; exact W].
  - assert (named : forall e, result bits owned room call now m e (fun v m => as_form bits k v (fun c => Q ((n, c) :: now) m)) ->
      result bits owned room call now m e (fun v m => as_form bits k v (fun c => Q' ((n, c) :: now) m)) -> meet2 Q Q').
    { intros e' G G'; destruct (result_one _ _ _ _ _ G G') as (v & m' & V & V'), (as_form_one _ _ _ _ V V') as (x & X & X'); do 2 eexists; split; eassumption. }
    left; destruct e as [e |]; [destruct k; exact (named e H H') |]; destruct k; try contradiction; do 2 eexists; split; eassumption.
  - left; destruct (is "" o).
    + destruct (result_one _ _ _ _ _ H H') as (v & m' & V & V'); exact (put_into_one _ _ _ _ _ _ V V').
    + destruct (value_one _ _ _ _ _ H H') as (x & X & X'), (value_one _ _ _ _ _ X X') as (y & Y & Y'), (infixed_one _ _ _ _ _ Y Y') as (v & V & V').
      exact (put_into_one _ _ _ _ _ _ V V').
  - left; destruct H as [_ H], H' as [_ H'], (value_one _ _ _ _ _ H H') as (v & V & V'), (put_into_one _ _ _ _ _ _ V V') as (now' & m' & X & X').
    destruct (named_one _ _ _ _ _ X X') as (y & Y & Y'), (infixed_one _ _ _ _ _ Y Y') as (z & Z & Z'); exact (put_into_one _ _ (Named i) _ _ _ Z Z').
  - left; destruct (values_one _ _ _ _ _ H H') as (l & L & L'), (One _ _ _ _ _ L L') as (v & m' & V & V'); do 2 eexists; split; eassumption.
  - destruct (value_one _ _ _ _ _ H H') as (x & X & X'); destruct x; try contradiction; destruct (z =? 0); [exact (IHno _ _ _ _ _ _ X X') | exact (IHyes _ _ _ _ _ _ X X')].
  - destruct H as (times & H), H' as (times' & H'); revert times' now m H H'; induction times as [| k IH]; intros [| k'] now m H H';
      destruct (value_one _ _ _ _ _ H H') as (x & X & X'); destruct x; try contradiction; destruct (z =? 0); try contradiction; try (left; do 2 eexists; split; eassumption).
    destruct (IHbody _ _ _ _ _ _ X X') as [(now' & m' & Y & Y') | W]; [| right; exact W].
    destruct (IHnext _ _ _ _ _ _ Y Y') as [(now'' & m'' & Z & Z') | W]; [exact (IH _ _ _ Z Z') | right; exact W].
  - right; destruct e as [e |]; [destruct (value_one _ _ _ _ _ H H') as (v & V & V'); do 2 eexists; split; eassumption | do 2 eexists; split; eassumption].
Qed.
End Calls.

(** Functions: of two things that one is proved to end with, both hold of what it returns. *)
Theorem called_one l d : forall f given m K K', LongIntegers.called bits owned room l d f given m K -> LongIntegers.called bits owned room l d f given m K' -> meet2 K K'.
Proof.
  induction d as [| d IH]; intros f given m K K' H H'; cbn [LongIntegers.called] in H, H'; [contradiction |]; destruct (look f l) as [r |]; [| contradiction].
  destruct (bind_all_one _ _ _ _ H H') as (now & N & N'), (ends_one _ IH _ _ _ _ _ _ _ N N') as [(now' & m' & X & X') | (v & m' & X & X')]; [do 2 eexists; split; eassumption |].
  destruct v as [v |], (gives r); try contradiction; [| do 2 eexists; split; eassumption].
  destruct (as_form_one _ _ _ _ X X') as (x & Y & Y'); do 2 eexists; split; eassumption.
Qed.
Corollary never_everything l d f given m : ~ LongIntegers.called bits owned room l d f given m (fun _ _ => False).
Proof. intros H; destruct (called_one _ _ _ _ _ _ _ H H) as (_ & _ & N & _); exact N. Qed.
End Meaning.
