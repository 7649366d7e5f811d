(** Stage 3: the numbers that its steps compute, and the exact values that they stand for, from those that they begin with. *)

Require Import List String ZArith Reals Lia Bool.
From Hypcheck Require Import Steps Fixed FixedRuns ShiftRuns.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Definition put {A} (f : string -> A) n v : string -> A := fun m => if String.eqb n m then v else f m.

Section Computed.
Variable shift : string -> Z.

Definition number_of (num : string -> number) (s : step) : number := match call_of s with
  | Plus a c => plus (num a) (num c) | Minus a c => minus (num a) (num c) | Times k a => times_of k (num a)
  | Product a c => product (num a) (num c) | Signed a c => signed_product (num a) (num c)
  | BothSigned a c => both_signed_product (num a) (num c) | Square a => square (num a)
  | Moved b a c => shifted_down (product (num a) (num c)) (shift b) | Other => Words 0 0 end.
Definition exact_of (x : string -> R) (s : step) : R := match call_of s with
  | Plus a c => x a + x c | Minus a c => x a - x c | Times k a => IZR k * x a
  | Product a c | Signed a c | BothSigned a c => halves x a c | Square a => halves x a a
  | Moved b a c => halves x a c / IZR (2 ^ shift b) | Other => 0 end%R.

Fixpoint computed (num : string -> number) (l : list step) := match l with
  | [] => num | s :: rest => computed (put num (name s) (number_of num s)) rest end.
Fixpoint exacts (x : string -> R) (l : list step) := match l with
  | [] => x | s :: rest => exacts (put x (name s) (exact_of x s)) rest end.

(** No name is given twice, or read before it is given. *)
Definition operands s := match call_of s with
  | Plus a c | Minus a c | Product a c | Signed a c | BothSigned a c | Moved _ a c => [a; c] | Times _ a | Square a => [a] | Other => [] end.
Definition is_known s := match call_of s with Times k _ => existsb (Z.eqb k) factors | Other => false | _ => true end.
Fixpoint in_order (l : list step) := match l with
  | [] => true
  | s :: rest => is_known s && forallb (fun n => negb (existsb (fun t => String.eqb (name t) n) (s :: rest))) (operands s)
    && negb (existsb (fun t => String.eqb (name t) (name s)) rest) && in_order rest end.

Lemma put_same {A} (f : string -> A) n v : put f n v n = v.
Proof. unfold put; rewrite String.eqb_refl; reflexivity. Qed.
Lemma put_other {A} (f : string -> A) n v m : String.eqb n m = false -> put f n v m = f m.
Proof. unfold put; intros ->; reflexivity. Qed.

Lemma computed_other l : forall num n, existsb (fun t => String.eqb (name t) n) l = false -> computed num l n = num n.
Proof.
  induction l as [| s l IH]; intros num n H; [reflexivity |]; cbn [existsb] in H; apply orb_false_elim in H as [H1 H2].
  cbn [computed]; rewrite IH by exact H2; apply put_other; exact H1.
Qed.
Lemma exacts_other l : forall x n, existsb (fun t => String.eqb (name t) n) l = false -> exacts x l n = x n.
Proof.
  induction l as [| s l IH]; intros x n H; [reflexivity |]; cbn [existsb] in H; apply orb_false_elim in H as [H1 H2].
  cbn [exacts]; rewrite IH by exact H2; apply put_other; exact H1.
Qed.

Lemma plus_number a c : is_number (plus a c).
Proof. split; apply word_mod. Qed.
Lemma minus_number a c : is_number (minus a c).
Proof. split; apply word_mod. Qed.
Lemma times_number k a : is_number (times_of k a).
Proof. unfold times_of; cbv zeta; destruct (Z.odd k); [apply plus_number | apply words_stand]. Qed.
Lemma number_is num s : is_number (number_of num s).
Proof.
  unfold number_of; destruct (call_of s); first [split; apply word_mod | apply minus_number | apply times_number | apply words_stand
    | repeat split; discriminate].
Qed.
Lemma computed_numbers l : forall num, (forall n, is_number (num n)) -> forall n, is_number (computed num l n).
Proof.
  induction l as [| s l IH]; intros num H n; [apply H |]; cbn [computed]; apply IH; intros m; unfold put.
  destruct (String.eqb (name s) m); [apply number_is | apply H].
Qed.

(** A step whose name has the number that it computes. *)
Definition is_computed (num : string -> number) s := num (name s) = number_of num s.
Theorem computed_is l : forall num, in_order l = true -> Forall (is_computed (computed num l)) l.
Proof.
  induction l as [| s l IH]; intros num O; [constructor |]; cbn [in_order] in O; rewrite !andb_true_iff in O.
  destruct O as (((K & A) & N) & O); constructor; [| apply IH; exact O].
  apply negb_true_iff in N; rewrite forallb_forall in A; unfold is_computed.
  assert (other : forall n, In n (operands s) -> computed num (s :: l) n = num n).
  { intros n I; specialize (A n I); apply negb_true_iff in A; apply computed_other; exact A. }
  transitivity (number_of num s); [cbn [computed]; rewrite computed_other, put_same by exact N; reflexivity |].
  clear A N O IH; unfold number_of, operands in *.
  destruct (call_of s) as [a c | a c | m a | a c | a c | a c | a | m a c |];
    try rewrite (other a ltac:(cbn; tauto)); try rewrite (other c ltac:(cbn; tauto)); reflexivity.
Qed.

Hypothesis Shifts : forall n, 0 <= shift n.

Theorem computed_runs l : forall num x, (forall n, is_number (num n)) -> in_order l = true ->
  Forall (runs (computed num l) (exacts x l) shift) l.
Proof.
  induction l as [| s l IH]; intros num x H O; [constructor |]; cbn [in_order] in O; rewrite !andb_true_iff in O.
  destruct O as (((K & A) & N) & O); constructor; [| apply IH; [| exact O]].
  2: { intros m; unfold put; destruct (String.eqb (name s) m); [apply number_is | apply H]. }
  apply negb_true_iff in N; rewrite forallb_forall in A.
  assert (other : forall n, In n (operands s) -> computed num (s :: l) n = num n /\ exacts x (s :: l) n = x n).
  { intros n I; specialize (A n I); apply negb_true_iff in A; split; [apply computed_other | apply exacts_other]; exact A. }
  assert (own : computed num (s :: l) (name s) = number_of num s /\ exacts x (s :: l) (name s) = exact_of x s).
  { cbn [computed exacts]; rewrite computed_other, exacts_other by exact N; rewrite !put_same; split; reflexivity. }
  destruct own as [ON OX]; unfold runs; rewrite ON, OX; clear ON OX A N O IH; unfold number_of, exact_of, operands, is_known, halves in *.
  destruct (call_of s) as [a c | a c | m a | a c | a c | a c | a | m a c |];
    try (pose proof (other a ltac:(cbn; tauto)) as [-> ->]); try (pose proof (other c ltac:(cbn; tauto)) as [-> ->]);
    try (split; reflexivity); try discriminate K.
  - apply existsb_exists in K as (k & I & E); apply Z.eqb_eq in E; subst k; destruct (times_is_right m (num a) (H a) I) as [T P].
    split; [exact T | split; [exact P | reflexivity]].
  - cbv zeta; split; [apply Shifts | split; reflexivity].
Qed.

End Computed.
