(** Stage 5 on limbs: what the text that decides by integers means where its integers lie in memory, in limbs of 64 or 32 bits, and
    functions of long integers are called.

    HC_INTEGER(n, k) makes the number 0 with as many limbs as the header says there, each number apart from the others. A function
    that is called gets the addresses of numbers, ints, and the three parts of a double, and does what its text does. What must hold
    of the text so that every call has what LongSums.v, LongProducts.v and LongUnits.v ask for is said so that Coq computes it. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed Limbs Trees LongIntegers LongRuns LongOutcomes LongSums LongProducts LongUnits
  StageThreeRuns StageFive StageFiveAnswers.
From Hypcheck Require HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** The text of what is called. *)
Definition routines := Eval vm_compute in match every (map (fun text => routine_of (string_of text)) HeaderText.integers) with Some l => l | None => [] end.

(** The address of a number is its place among those that are declared. *)
Fixpoint address_in (l : list (string * Z)) n : Z := match l with [] => 0 | (k, _) :: rest => if String.eqb k n then 0 else 1 + address_in rest n end.
Lemma address_positive l n : 0 <= address_in l n.
Proof. induction l as [| [k j] l IH]; cbn [address_in]; [lia |]; destruct (String.eqb k n); lia. Qed.
Lemma addresses_apart l n x : look n l <> None -> n <> x -> address_in l n <> address_in l x.
Proof.
  induction l as [| [y j] l IH]; cbn [look address_in]; [congruence |]; intros N D; pose proof (address_positive l n); pose proof (address_positive l x).
  destruct (String.eqb_spec y n), (String.eqb_spec y x); try lia; [congruence |]; specialize (IH N D); lia.
Qed.

Section Integers.
Variable bits : Z.
Notation B := (2 ^ bits).

(** ** The numbers in memory. *)

Definition limbs_for k := (k + bits - 1) / bits + 1.
Fixpoint room_in (l : list (string * Z)) a : Z := match l with [] => 0 | (_, k) :: rest => if a =? 0 then limbs_for k else room_in rest (a - 1) end.

Lemma room_of_address l n k : look n l = Some k -> room_in l (address_in l n) = limbs_for k.
Proof.
  induction l as [| [x j] l IH]; cbn [look address_in room_in]; [discriminate |]; destruct (String.eqb x n); [intros E; injection E as ->; reflexivity |].
  intros E; pose proof (address_positive l n); destruct (Z.eqb_spec (1 + address_in l n) 0); [lia |]; replace (1 + address_in l n - 1) with (address_in l n) by ring; auto.
Qed.
Hypothesis Bits : bits = 32 \/ bits = 64.

Lemma limbs_suffice k : 0 <= k -> 0 <= limbs_for k - 1 /\ 2 ^ k <= B ^ (limbs_for k - 1) /\ 2 ^ k <= B ^ limbs_for k.
Proof.
  intros K; unfold limbs_for; set (q := (k + bits - 1) / bits); assert (b : 0 < bits) by (destruct Bits; subst; reflexivity).
  assert (q0 : 0 <= q) by (apply Z.div_pos; lia); assert (k <= bits * q) by (pose proof (Z.mul_succ_div_gt (k + bits - 1) bits b); fold q in H; lia).
  rewrite Z.add_simpl_r, <- !Z.pow_mul_r by lia; split; [exact q0 |]; split; apply Z.pow_le_mono_r; lia.
Qed.
Lemma rooms_bounded l : forallb (fun p => (0 <=? snd p) && (snd p <? 2 ^ 20)) l = true -> forall a, 0 <= room_in l a < 2 ^ 20.
Proof.
  induction l as [| [n k] l IH]; cbn [forallb room_in snd]; intros H a; [lia |]; apply andb_prop in H as [K H]; apply andb_prop in K as [K0 K1].
  apply Z.leb_le in K0; apply Z.ltb_lt in K1; destruct (a =? 0); [| apply IH; exact H]; pose proof (limbs_suffice k K0) as [L _]; split; [lia |].
  unfold limbs_for; assert ((k + bits - 1) / bits < 2 ^ 19) by (apply Z.div_lt_upper_bound; destruct Bits; subst; lia); lia.
Qed.

(** The header's own count, which is asked for when the program is compiled. *)
Theorem room_text owned room d m k (K : option content -> memory -> Prop) : 0 <= k < 2 ^ 20 -> K (Some (Holds Int (limbs_for k))) m ->
  LongIntegers.called bits owned room routines (S d) "HC_INTEGER" [Holds Int k] m K.
Proof.
  intros R Post; LongRuns.begins routines "HC_INTEGER".
  assert (Q : 0 <= Z.quot (k + bits - 1) bits < 2 ^ 20).
  { rewrite Z.quot_div_nonneg by (destruct Bits; lia); split; [apply Z.div_pos | apply Z.div_lt_upper_bound]; destruct Bits; lia. }
  do 2 LongRuns.act; destruct Bits; LongRuns.sides; rewrite Z.quot_div_nonneg in * by lia; sides; exact Post.
Qed.

(** ** Running the text on limbs. *)

(** The integers that it declares, and the bits of each. *)
Variable rooms : list (string * Z).
Variable zeros : Z -> Z.
Definition address := address_in rooms.
Definition room := room_in rooms.
Definition owned (p : Z) := p.
Definition call := LongIntegers.called bits owned room routines 3.
(** What is called besides: of doubles and of ints. No variable holds a whole number here. *)
Notation known := (of_integers zeros).

(** The sign of an integer is read where the integer lies. *)
Definition signed_by n := match LongIntegers.field_of n "" with Some (x, f) => if is "sign" f then Some x else None | None => None end.
Fixpoint signed (now : environment) m e := match e with
  | Named n => match signed_by n with
    | Some x => match look x now, LongIntegers.sign_at m (address x) with Some (Room _), Some s => Constant Int s | _, _ => e end
    | None => e end
  | Infix o l r => Infix o (signed now m l) (signed now m r)
  | Choice c a b => Choice (signed now m c) (signed now m a) (signed now m b)
  | _ => e end.
Definition evaluated now m e := eval known now (signed now m e).

Definition given_plainly (now : environment) m e := match evaluated now m e with
  | Some (Of t z) => Some [Holds t z]
  | Some (Rec [(_, Of Int s); (_, Of Int e); (_, Of U64 a)]) => Some [Holds Int s; Holds Int e; Holds U64 a]
  | _ => None end.
Definition given_to (now : environment) m e := match e with
  | Named n => match look n now with Some (Room _) => Some [To (address n)] | _ => given_plainly now m e end
  | _ => given_plainly now m e end.

(** A call that fills an integer. *)
Definition filling_of t n e := match e with
  | Called f (Named k :: given) => if is "" t && is n k && is_in f fillings then Some (f, given) else None | _ => None end.

(** It ends, and what it returns is as wanted. *)
Fixpoint goes (fuel : nat) (now : environment) m (l : list tree) (R : datum -> Prop) : Prop := match fuel, l with
  | S _, Returns e :: _ => match evaluated now m e with Some v => R v | None => False end
  | S f, Set_ t n e :: rest =>
    if is "hc_integer" t then match e with
      | Called h [Constant Int k] => is "HC_INTEGER" h = true /\ look n now = None /\ room (address n) = limbs_for k
        /\ goes f ((n, Room k) :: now) (with_length (with_sign m (address n) 0) (address n) 0) rest R
      | _ => False end
    else match filling_of t n e with
      | Some (f', given) => match every (map (given_to now m) (Named n :: given)) with
        | Some l => call f' (List.concat l) m (fun _ m' => goes f now m' rest R) | None => False end
      | None => is_new t n now = true /\ match evaluated now m e with
        | Some v => match held t v with Some w => goes f (bound n w now) m rest R | None => False end
        | None => False end end
  | S f, If c yes no :: rest => match evaluated now m c with
    | Some (Of _ z) => goes f now m ((if z =? 0 then no else yes) ++ rest)%list R | _ => False end
  | _, _ => False end.

(** It returns one thing. *)
Theorem goes_one f : forall now m l R R', goes f now m l R -> goes f now m l R' -> meet R R'.
Proof.
  induction f as [| f IH]; intros now m l R R' H H'; cbn [goes] in H, H'; [contradiction |]; destruct l as [| [t n e | g given | c yes no | i count by_ turn | a i e | e] rest]; try contradiction.
  - destruct (is "hc_integer" t).
    + destruct e as [| | | | h given | | |]; try contradiction; destruct given as [| g given]; try contradiction; destruct g as [| u k | | | | | |]; try contradiction.
      destruct u; try contradiction; destruct given; try contradiction; destruct H as (_ & _ & _ & H), H' as (_ & _ & _ & H'); exact (IH _ _ _ _ _ H H').
    + destruct (filling_of t n e) as [[g given] |].
      * destruct (every (map (given_to now m) (Named n :: given))) as [l |]; [| contradiction].
        destruct (called_one _ _ _ _ _ _ _ _ _ _ H H') as (v & m' & X & X'); exact (IH _ _ _ _ _ X X').
      * destruct H as [_ H], H' as [_ H'], (evaluated now m e) as [v |]; try contradiction; destruct (held t v) as [w |]; [exact (IH _ _ _ _ _ H H') | contradiction].
  - destruct (evaluated now m c) as [d |]; [| contradiction]; destruct d; try contradiction; exact (IH _ _ _ _ _ H H').
  - destruct (evaluated now m e) as [v |]; [exists v; split; assumption | contradiction].
Qed.

(** ** What must hold of the text, by computation. *)

Definition is_integer n := match look n rooms with Some _ => true | None => false end.
Definition is_none {A} (o : option A) := match o with None => true | Some _ => false end.
Definition are_apart (n x : string) := negb (String.eqb n x) && negb (String.eqb n (x ++ ".sign")) && is_none (prefixed (n ++ ".") x) && is_none (prefixed (n ++ ".") (x ++ ".sign")).
Definition is_plain n := match signed_by n with Some x => negb (is_integer x) | None => true end && forallb (fun p => are_apart n (fst p)) rooms.
Fixpoint plainly e : bool := match e with
  | Named n => is_plain n | Constant _ _ => true | Infix _ l r | Part l r => plainly l && plainly r
  | Choice c a b => plainly c && plainly a && plainly b | As _ e => plainly e
  | Called f given => is_in f ["hc_parts_of"; "hc_least"] && forallb plainly given | Braces _ => false end.
Definition is_sign_of_integer n := match signed_by n with Some x => is_integer x && String.eqb n (x ++ ".sign") | None => false end.
Fixpoint of_signs e : bool := plainly e || match e with
  | Infix o l r => match l, r with Named n, Constant _ _ => is_sign_of_integer n | _, _ => of_signs l && of_signs r end
  | Choice c a b => of_signs c && of_signs a && of_signs b | _ => false end.

Definition is_other n a := match a with Named x => negb (String.eqb x n) && is_integer x | _ => false end.
Definition is_shorter k n a := is_other n a && match a with Named x => match look x rooms with Some j => j <=? k | None => false end | _ => false end.
Definition fills_right n f given := match look n rooms, given with
  | Some k, [a; c] => if is_in f ["hc_add"; "hc_subtract"] then is_shorter k n a && is_shorter k n c
    else if is "hc_multiply" f then is_other n a && is_other n c
    else if is "hc_scale" f then match a with Constant Int z => z <? 2 ^ 32 | _ => false end && is_other n c
    else is "hc_in_units" f && plainly a && plainly c
  | _, _ => false end.
Fixpoint is_right_text (fuel : nat) (l : list tree) : bool := match fuel, l with
  | S _, Returns e :: _ => of_signs e
  | S f, Set_ t n e :: rest => is_right_text f rest &&
    if is "hc_integer" t then match e with Called h [Constant Int k] => is "HC_INTEGER" h && match look n rooms with Some j => k =? j | None => false end | _ => false end
    else match filling_of t n e with
      | Some (f', given) => fills_right n f' given 
      | None => (is "int" t || is "hc_parts" t && match e with Called h _ => is "hc_parts_of" h | _ => false end) && is_plain n && plainly e end
  | S f, If c yes no :: rest => of_signs c && is_right_text f (yes ++ rest) && is_right_text f (no ++ rest)
  | _, _ => false end.
Definition is_named n := is_none (LongIntegers.field_of n "") && match signed_by (n ++ ".sign") with Some x => String.eqb x n | None => false end.

End Integers.
