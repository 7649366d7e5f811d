(** Stage 3: what the number `delta` and the number `middle` of the fixed point say of the discriminant of g and of its inflection. *)

Require Import List String ZArith Reals Lra.
From Hypcheck Require Import UnitBall Cubic Rule Steps Fixed FixedRuns.
Import ListNotations.
Open Scope string_scope.

Section Fixed_point.

Variables (num : string -> number) (x : string -> R).
Hypothesis Runs : Forall (runs num x) C_discriminant.

Let step_of n : option step := find (fun s => String.eqb (name s) n) C_discriminant.
Let run_of n s : step_of n = Some s -> runs num x s.
Proof. intros E; apply (proj1 (Forall_forall _ _) Runs); apply (find_some _ _ E). Qed.

Ltac equation n := let s := eval vm_compute in (step_of n) in match s with Some ?k =>
  let H := fresh "E" in assert (H : runs num x k) by (apply (run_of n); vm_compute; reflexivity);
  cbv [runs call_of look arguments operation name String.eqb Ascii.eqb Bool.eqb halves] in H;
  repeat match type of H with _ /\ _ => apply proj2 in H end end.

Open Scope R_scope.
Let unit := IZR bits128.

Theorem exact_numbers :
  unit ^ 3 * x "delta" = 4 * (x "n2" ^ 2 - 3 * (x "N" * x "n1")) * (x "n1" ^ 2 + 3 * (x "n2" * x "ps"))
    - (x "n2" * x "n1" + 9 * (x "N" * x "ps")) ^ 2
  /\ unit ^ 2 * x "middle" = 2 * (x "n2" * (x "n2" ^ 2 - 3 * (x "N" * x "n1")))
    - 3 * (x "N" * (x "n2" * x "n1" + 9 * (x "N" * x "ps"))).
Proof.
  assert (U : IZR bits128 <> 0) by (apply not_0_IZR; discriminate).
  equation "n2_n2"; equation "N_n1"; equation "N_n1_3"; equation "h1"; equation "n2_n1"; equation "N_ps"; equation "N_ps_9";
    equation "h2"; equation "n1_n1"; equation "n2_ps"; equation "n2_ps_3"; equation "h3"; equation "h1_h3"; equation "h1_h3_4";
    equation "h2_h2"; equation "delta"; equation "n2_h1"; equation "n2_h1_2"; equation "N_h2"; equation "N_h2_3"; equation "middle".
  unfold unit; repeat match goal with H : x ?n = _ |- context [x ?n] => rewrite H end.
  generalize dependent (IZR bits128); intros u U; clear; split; field; exact U.
Qed.

(** The balance: N, n2, n1 and ps of the row times powers of two do not change the signs. *)
Variables A B P Q N m r : R.
Hypotheses (N0 : 0 < N) (M0 : 0 < m) (R0 : 0 < r).
Hypotheses (XN : x "N" = m * r ^ 3 * N) (X2 : x "n2" = m * r ^ 2 * (N * c2 A B P Q)) (X1 : x "n1" = m * r * (N * c1 A B P Q))
  (X0 : x "ps" = m * - (N * c0 A B P Q)).

Let unit_positive : 0 < unit.
Proof. apply IZR_lt; reflexivity. Qed.

Lemma delta_is : unit ^ 3 * x "delta" = m ^ 4 * r ^ 6 * N ^ 4 * (3 * delta A B P Q).
Proof. rewrite (proj1 exact_numbers), XN, X2, X1, X0; unfold delta, disc; ring. Qed.

Lemma middle_is : unit ^ 2 * x "middle" = m ^ 3 * r ^ 6 * N ^ 3 * (27 * g A B P Q (- c2 A B P Q / 3)).
Proof. rewrite (proj2 exact_numbers), XN, X2, X1, X0, g_expanded; field. Qed.

Let same_sign k v w j : 0 < k -> 0 < j -> k * v = j * w -> (0 < v -> 0 < w) /\ (v < 0 -> w < 0).
Proof. intros K J E; split; intros H; apply Rmult_lt_reg_l with j; try assumption; nra. Qed.

Theorem delta_decides grown : (0 <= grown <= most_grown)%Z -> all_hold num x (balanced grown) ->
  exists v, stands (num "delta") v /\ ((said "delta" * 2 ^ grown < v)%Z -> 0 < delta A B P Q)
    /\ ((v < - (said "delta" * 2 ^ grown))%Z -> delta A B P Q < 0).
Proof.
  intros G K; destruct (sign_of_delta num x grown G K Runs) as (v & S & S1 & S2); exists v; split; [exact S |].
  assert (k1 : 0 < unit ^ 3) by (apply pow_lt; assumption).
  assert (k2 : 0 < m ^ 4 * r ^ 6 * N ^ 4) by (apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat |]; apply pow_lt; assumption).
  destruct (same_sign _ _ _ _ k1 k2 delta_is) as [D1 D2].
  split; intros H; [apply S1 in H; apply D1 in H | apply S2 in H; apply D2 in H]; lra.
Qed.

Theorem middle_decides grown : (0 <= grown <= most_grown)%Z -> all_hold num x (balanced grown) ->
  exists v, stands (num "middle") v /\ ((said "middle" * 2 ^ grown < v)%Z -> 0 < g A B P Q (- c2 A B P Q / 3)).
Proof.
  intros G K; destruct (sign_of_middle num x grown G K Runs) as (v & S & S1 & _); exists v; split; [exact S |].
  assert (k1 : 0 < unit ^ 2) by (apply pow_lt; assumption).
  assert (k2 : 0 < m ^ 3 * r ^ 6 * N ^ 3) by (apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat |]; apply pow_lt; assumption).
  destruct (same_sign _ _ _ _ k1 k2 middle_is) as [D1 _]; intros H; apply S1 in H; apply D1 in H; lra.
Qed.

End Fixed_point.
