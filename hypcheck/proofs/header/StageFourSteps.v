(** Stage 4: the printed steps, run in the text of the functions that hold them.

    A number of 64, 128 or 256 bits is a word, two words or four: [datum_of] its bits and its pattern. Where patterns are what the
    steps compute (StageFour.runs), the statements of the C put them under their names. From what a function begins with, patterns and
    exact values are computed here, too. *)

Require Import List String ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed FixedRuns Long Limbs LimbsRuns ShiftRuns Computed Trees StageThreeRuns StageFour.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** ** Numbers of 256 bits. *)

Definition long_of z := Long (z mod W) (z / W mod W) (z / W / W mod W) (z / W / W / W mod W).

Lemma division_of_words w r : is_word w -> (w + W * r) mod W = w /\ (w + W * r) / W = r.
Proof.
  intros H; rewrite (Z.add_comm w), (Z.mul_comm W), Z.div_add_l, Z.div_small, Z.add_0_r by (exact H || discriminate).
  rewrite Z.add_comm, Z.mod_add by discriminate; split; [apply Z.mod_small; exact H | reflexivity].
Qed.
Lemma long_of_pattern n : is_long n -> long_of (long_pattern n) = n.
Proof.
  destruct n as [a b c d]; intros (A & B & C & D); cbn [w0 w1 w2 w3] in *; unfold long_of, long_pattern; cbn [w0 w1 w2 w3].
  destruct (division_of_words a (b + W * (c + W * d)) A) as [-> ->], (division_of_words b (c + W * d) B) as [-> ->],
    (division_of_words c d C) as [-> ->]; rewrite (Z.mod_small d) by exact D; reflexivity.
Qed.
Lemma long_of_is z : 0 <= z < bits256 -> is_long (long_of z) /\ long_pattern (long_of z) = z.
Proof.
  intros Z0; split; [repeat split; apply mod_word |]; unfold long_of, long_pattern; cbn [w0 w1 w2 w3].
  assert (T : 0 <= z / W / W / W < W).
  { rewrite !Z.div_div by (discriminate || reflexivity); split; [apply Z.div_pos; [lia | reflexivity] | apply Z.div_lt_upper_bound; [reflexivity |]].
    unfold bits256, bits128 in Z0; lia. }
  rewrite (Z.mod_small (z / W / W / W)) by exact T.
  rewrite (Z.add_comm (z / W / W mod W)), <- Z.div_mod, (Z.add_comm (z / W mod W)), <- Z.div_mod, (Z.add_comm (z mod W)), <- Z.div_mod by discriminate.
  reflexivity.
Qed.
Lemma words_of_pattern n : is_number n -> words_of (pattern n) = n.
Proof.
  destruct n as [a b]; intros [A B]; cbn [low_word high_word] in *; unfold words_of, pattern; cbn [low_word high_word].
  destruct (division_of_words a b A) as [-> ->]; reflexivity.
Qed.
Lemma words_of_is z : 0 <= z < bits128 -> is_number (words_of z) /\ pattern (words_of z) = z.
Proof. intros H; pose proof (words_stand z) as [N P]; rewrite (Z.mod_small z) in N, P by exact H; split; assumption. Qed.

(** ** What is called, as LimbsRuns.v and ShiftRuns.v prove of its text. *)

Definition of_longs : list (string * (list datum -> option datum)) := [
  ("hc_fixed_plus", numbers plus); ("hc_fixed_minus", numbers minus);
  ("hc_fixed_full", fun given => match given with [Of U64 a; Of U64 c] => Some (Fix (full a c)) | _ => None end);
  ("hc_fixed_full_signed", fun given => match given with [Of U64 a; Of U64 c] => Some (Fix (full_signed a c)) | _ => None end);
  ("hc_fixed_negative", fun given => match given with [Fix a] => Some (Of U64 (negative a)) | _ => None end);
  ("hc_long_sum", fun given => match given with
    | [Lng a; Lng c; Of Int k] => if k =? 0 then Some (Lng (long_sum a c false)) else if k =? 1 then Some (Lng (long_sum a c true)) else None | _ => None end);
  ("hc_long_product", fun given => match given with [Fix a; Fix c] => Some (Lng (long_product a c)) | _ => None end);
  ("hc_long_signed_product", fun given => match given with [Fix a; Fix c] => Some (Lng (long_signed_product a c)) | _ => None end);
  ("hc_long_is_zero", fun given => match given with [Lng a] => Some (Of Int (if long_pattern a =? 0 then 1 else 0)) | _ => None end);
  ("hc_long_is_negative", fun given => match given with [Lng a] => Some (Of Int (if bits256 / 2 <=? long_pattern a then 1 else 0)) | _ => None end)].

(** ** Lengths by their names. *)

Definition named := StageThreeRuns.lengths.
Definition words_of_lengths (ls : string -> Z) := combine ["0"; "1"; "2"; "3"; "4"; "5"; "6"] (map (fun n => Of U64 (ls n)) named).
Definition names_lengths count := map (fun p => Set_ "uint64_t" (snd p) (Part (Named "lengths") (Constant Int (fst p)))) (firstn count (combine [0; 1; 2; 3; 4; 5; 6] named)).

(** ** A step as a statement. *)

Definition datum_of w z := if w =? 64 then Of U64 z else if w =? 128 then Fix (words_of z) else Lng (long_of z).
Definition type_of_bits w := if w =? 64 then "uint64_t" else if w =? 128 then "hc_fixed" else "hc_long".
Definition widths := list (string * Z).

(** The bits of a step's number, where those of its arguments are as its call wants them. *)
Definition width_of (kinds : widths) (s : step) : option Z := match look (operation s) calls, arguments s with
  | Some (c, w), [Name a; Name e] => match look a kinds, look e kinds with
    | Some i, Some j => if (i =? w) && (j =? w) then Some (match c with Whole | Signed => 2 * w | _ => w end) else None | _, _ => None end
  | None, [Name side; Name a; Name e] => match look a kinds, look e kinds with
    | Some i, Some j => if (i =? j) && is "inner" side then Some i else None | _, _ => None end
  | _, _ => None end.
Definition value_of_step (s : step) : expression := match arguments s with
  | [Name side; Name a; Name c] => Choice (Named side) (Named a) (Named c)
  | [Name a; Name c] => match look (operation s) [("add", "+"); ("sub", "-"); ("mul", "*")], look (operation s) [("hc_long_plus", 0); ("hc_long_minus", 1)] with
    | Some o, _ => Infix o (Named a) (Named c)
    | _, Some k => Called "hc_long_sum" [Named a; Named c; Constant Int k]
    | _, _ => Called (operation s) [Named a; Named c] end
  | _ => Braces [] end.
Fixpoint statements_of (kinds : widths) (l : list step) : option (list tree * widths) := match l with
  | [] => Some ([], kinds)
  | s :: rest => try w <- width_of kinds s;
    if existsb (fun t => String.eqb (name t) (name s)) rest then None else
    try (k, last) <- statements_of ((name s, w) :: kinds) rest; Some (Set_ (type_of_bits w) (name s) (value_of_step s) :: k, last) end.

Definition steps_in kinds l := match statements_of kinds l with Some (k, _) => k | None => [] end.
Definition widths_after kinds l := match statements_of kinds l with Some (_, last) => last | None => [] end.
Definition of_lengths count : widths := map (fun n => (n, 64)) (firstn count named).

(** Whether a number is below 0. *)
Lemma negative_fixed z : 0 <= z < 2 ^ 128 -> negative (words_of z) = if 2 ^ 127 <=? z then W - 1 else 0.
Proof.
  intros [Z0 Z1]; unfold negative, words_of; cbn [high_word]; pose proof (Z.div_mod z W ltac:(discriminate)); pose proof (mod_word z) as [M0 M1].
  change (W / 2) with 9223372036854775808; change (2 ^ 127) with (9223372036854775808 * W).
  destruct (Z.leb_spec 9223372036854775808 (z / W)), (Z.leb_spec (9223372036854775808 * W) z); try reflexivity; unfold W in *; lia.
Qed.
Lemma negative_long z : 0 <= z < 2 ^ 256 -> (bits256 / 2 <=? long_pattern (long_of z)) = (2 ^ 255 <=? z).
Proof. intros H; rewrite (proj2 (long_of_is z H)); reflexivity. Qed.

Definition is_negative_fixed n := Called "hc_fixed_negative" [Named n].
Definition is_negative_long n := Called "hc_long_is_negative" [Named n].

Section Run.
Variables (num v : string -> Z) (inner : bool) (procedures : list (string * (nat * (list datum -> option (list datum))))).
Variable known : list (string * (list datum -> option datum)).
(** The functions above are known, and others perhaps. *)
Hypothesis Known : forall n f, look n of_longs = Some f -> look n known = Some f.

Definition is_width w := w = 64 \/ w = 128 \/ w = 256.
Definition there (now : environment) n w := is_width w /\ look n now = Some (datum_of w (num n)) /\ 0 <= num n < 2 ^ w.
Definition sound (kinds : widths) (now : environment) := forall n w, look n kinds = Some w -> there now n w.
Definition knows_side (now : environment) := look "inner" now = Some (Of Int (if inner then 1 else 0)).

(** The environment after steps. *)
Fixpoint after (kinds : widths) (l : list step) (now : environment) : environment := match l with
  | [] => now
  | s :: rest => match width_of kinds s with
    | Some w => after ((name s, w) :: kinds) rest ((name s, datum_of w (num (name s))) :: now) | None => now end end.
Lemma after_other l : forall kinds now n, existsb (fun s => String.eqb (name s) n) l = false -> look n (after kinds l now) = look n now.
Proof.
  induction l as [| s l IH]; intros kinds now n H; [reflexivity |]; cbn [existsb] in H; apply orb_false_elim in H as [H1 H2].
  cbn [after]; destruct (width_of kinds s) as [w |]; [| reflexivity]; rewrite IH by exact H2; cbn [look]; rewrite H1; reflexivity.
Qed.

Lemma power_64 : 2 ^ 64 = W. Proof. reflexivity. Qed.
Lemma power_128 : 2 ^ 128 = bits128. Proof. reflexivity. Qed.
Lemma power_256 : 2 ^ 256 = bits256. Proof. reflexivity. Qed.

(** A number by its pattern. *)
Lemma fixed_is n z : is_number n -> pattern n = z -> n = words_of z.
Proof. intros N <-; symmetry; apply words_of_pattern; exact N. Qed.
Lemma long_is n z : is_long n -> long_pattern n = z -> n = long_of z.
Proof. intros N <-; symmetry; apply long_of_pattern; exact N. Qed.
Lemma long_signed_product_is_long l r : is_number l -> is_number r -> is_long (long_signed_product l r).
Proof.
  intros L R; unfold long_signed_product; apply long_sum_is_right; [apply long_product_is_right; assumption |].
  assert (Z0 : is_word 0) by (unfold is_word, W; lia); destruct R as [R1 R2]; destruct (W / 2 <=? high_word l); repeat split; cbn [w0 w1 w2 w3 low_word high_word]; (apply Z0 || apply R1 || apply R2).
Qed.
Lemma full_signed_is_number a c : is_number (full_signed a c).
Proof. split; apply mod_word. Qed.
Lemma full_is_number a c : is_word a -> is_word c -> full a c = words_of (a * c) /\ 0 <= a * c < bits128.
Proof.
  intros A C; split; [reflexivity |]; destruct (word_product a c A C) as [P _]; split; [exact P |].
  apply Z.mul_lt_mono_nonneg; unfold is_word in *; lia.
Qed.

Lemma step_value kinds now s w : sound kinds now -> (is "select" (operation s) = true -> knows_side now) -> runs num v inner s -> width_of kinds s = Some w ->
  is_width w /\ eval known now (value_of_step s) = Some (datum_of w (num (name s))) /\ 0 <= num (name s) < 2 ^ w.
Proof.
  intros S Side R E; destruct s as [n o l]; unfold width_of, runs, value_of_step in *; cbn [name operation arguments] in *.
  destruct (look o calls) as [[c k] |] eqn:O.
  - destruct l as [| [a | ?] [| [e | ?] [| ? ?]]]; try discriminate.
    destruct (look a kinds) as [i |] eqn:A; [| discriminate]; destruct (look e kinds) as [j |] eqn:C; [| discriminate].
    destruct ((i =? k) && (j =? k)) eqn:IJ; [| discriminate]; apply andb_prop in IJ as [I J]; apply Z.eqb_eq in I; apply Z.eqb_eq in J; subst i j.
    apply S in A as (_ & LA & RA); apply S in C as (_ & LC & RC); injection E as <-.
    apply look_in in O; cbv [calls In] in O.
    repeat match type of O with _ \/ _ => destruct O as [O | O] end; try contradiction; injection O as <- <- <-; destruct R as [RN _]; rewrite RN; clear RN S Side v;
      (split; [unfold is_width; lia |]); cbn [look String.eqb Ascii.eqb Bool.eqb eval map every]; rewrite LA, LC; clear LA LC.
    + split; [| apply Z.mod_pos_bound; reflexivity]; reflexivity.
    + split; [| apply Z.mod_pos_bound; reflexivity]; reflexivity.
    + split; [| apply Z.mod_pos_bound; reflexivity]; reflexivity.
    + rewrite (Known "hc_fixed_plus" _ eq_refl); cbn [datum_of Z.eqb Pos.eqb numbers]; rewrite power_128 in *.
      split; [| apply Z.mod_pos_bound; reflexivity]; destruct (words_of_is _ RA) as [NA PA], (words_of_is _ RC) as [NC PC].
      do 2 f_equal; apply fixed_is; [apply plus_number | rewrite plus_is_right, PA, PC by assumption; reflexivity].
    + rewrite (Known "hc_fixed_minus" _ eq_refl); cbn [datum_of Z.eqb Pos.eqb numbers]; rewrite power_128 in *.
      split; [| apply Z.mod_pos_bound; reflexivity]; destruct (words_of_is _ RA) as [NA PA], (words_of_is _ RC) as [NC PC].
      do 2 f_equal; apply fixed_is; [apply minus_number | rewrite minus_is_right, PA, PC by assumption; reflexivity].
    + rewrite (Known "hc_fixed_full" _ eq_refl); destruct (full_is_number _ _ RA RC) as [F B]; split; [| exact B]; cbn [datum_of Z.eqb Pos.eqb Z.mul Pos.mul]; rewrite F; reflexivity.
    + rewrite (Known "hc_fixed_full_signed" _ eq_refl); split; [| apply Z.mod_pos_bound; reflexivity]; cbn [datum_of Z.eqb Pos.eqb Z.mul Pos.mul].
      do 2 f_equal; apply fixed_is; [apply full_signed_is_number | rewrite full_signed_is_right by assumption; reflexivity].
    + rewrite (Known "hc_long_sum" _ eq_refl); cbn [datum_of Z.eqb Pos.eqb]; rewrite power_256 in *.
      split; [| apply Z.mod_pos_bound; reflexivity]; destruct (long_of_is _ RA) as [NA PA], (long_of_is _ RC) as [NC PC].
      destruct (long_sum_is_right _ _ false NA NC) as [NS PS]; do 2 f_equal; apply long_is; [exact NS | rewrite PS, PA, PC; reflexivity].
    + rewrite (Known "hc_long_sum" _ eq_refl); cbn [datum_of Z.eqb Pos.eqb]; rewrite power_256 in *.
      split; [| apply Z.mod_pos_bound; reflexivity]; destruct (long_of_is _ RA) as [NA PA], (long_of_is _ RC) as [NC PC].
      destruct (long_sum_is_right _ _ true NA NC) as [NS PS]; do 2 f_equal; apply long_is; [exact NS | rewrite PS, PA, PC; reflexivity].
    + rewrite (Known "hc_long_product" _ eq_refl); cbn [datum_of Z.eqb Pos.eqb Z.mul Pos.mul]; rewrite power_128 in *.
      destruct (words_of_is _ RA) as [NA PA], (words_of_is _ RC) as [NC PC], (long_product_is_right _ _ NA NC) as [NS PS]; rewrite PA, PC in PS.
      split; [do 2 f_equal; apply long_is; assumption |]; rewrite power_256; change bits256 with (bits128 * bits128).
      split; [apply Z.mul_nonneg_nonneg; lia | apply Z.mul_lt_mono_nonneg; lia].
    + rewrite (Known "hc_long_signed_product" _ eq_refl); cbn [datum_of Z.eqb Pos.eqb Z.mul Pos.mul]; rewrite power_128 in *.
      split; [| apply Z.mod_pos_bound; reflexivity]; destruct (words_of_is _ RA) as [NA PA], (words_of_is _ RC) as [NC PC].
      do 2 f_equal; apply long_is; [apply long_signed_product_is_long; assumption | rewrite long_signed_product_is_right, PA, PC by assumption; reflexivity].
  - destruct l as [| [side | ?] [| [a | ?] [| [e | ?] [| ? ?]]]]; try discriminate.
    destruct (look a kinds) as [i |] eqn:A; [| discriminate]; destruct (look e kinds) as [j |] eqn:C; [| discriminate].
    destruct ((i =? j) && is "inner" side) eqn:IJ; [| discriminate]; apply andb_prop in IJ as [I J]; apply Z.eqb_eq in I; apply String.eqb_eq in J; subst j side.
    injection E as <-; apply S in A as (K & LA & RA); apply S in C as (_ & LC & RC); destruct R as (RN & _ & RO & _); rewrite RN; split; [exact K |].
    cbn [operation] in *; unfold is in Side; rewrite RO in Side; specialize (Side eq_refl); cbn [eval]; unfold knows_side in Side; rewrite Side; destruct inner; cbn [Z.eqb]; [rewrite LA | rewrite LC]; split; trivial.
Qed.

(** More names, and other numbers. *)
Lemma look_pushed {A} (pushed now : list (string * A)) n : is_in n (map fst pushed) = false -> look n (pushed ++ now) = look n now.
Proof.
  induction pushed as [| [m d] pushed IH]; intros H; [reflexivity |]; cbn in H; apply orb_false_elim in H as [H1 H2].
  cbn [app look]; rewrite String.eqb_sym, H1; exact (IH H2).
Qed.
Lemma sound_pushed kinds pushed now : sound kinds now -> forallb (fun p => negb (is_in (fst p) (map fst pushed))) kinds = true -> sound kinds (pushed ++ now)%list.
Proof.
  intros S O n w E; destruct (S n w E) as (K & L & B); split; [exact K |]; rewrite look_pushed; [split; assumption |].
  apply look_in in E; rewrite forallb_forall in O; apply negb_true_iff, (O (n, w) E).
Qed.

(** Questions to a number that is there. *)
Lemma ask_fixed now n : there now n 128 -> eval known now (is_negative_fixed n) = Some (Of U64 (if 2 ^ 127 <=? num n then W - 1 else 0)).
Proof.
  intros (_ & L & B); rewrite <- negative_fixed by exact B; unfold is_negative_fixed; cbn [eval map every]; rewrite L, (Known "hc_fixed_negative" _ eq_refl); reflexivity.
Qed.
Lemma ask_long now n : there now n 256 -> eval known now (is_negative_long n) = Some (Of Int (if 2 ^ 255 <=? num n then 1 else 0)).
Proof.
  intros (_ & L & B); rewrite <- negative_long by exact B; unfold is_negative_long; cbn [eval map every]; rewrite L, (Known "hc_long_is_negative" _ eq_refl); reflexivity.
Qed.

Lemma ask_zero now n : there now n 256 -> eval known now (Called "hc_long_is_zero" [Named n]) = Some (Of Int (if num n =? 0 then 1 else 0)).
Proof.
  intros (_ & L & B); cbn [eval map every]; rewrite L, (Known "hc_long_is_zero" _ eq_refl); cbn [datum_of Z.eqb Pos.eqb].
  rewrite (proj2 (long_of_is (num n) B)); reflexivity.
Qed.

Lemma held_datum w z : is_width w -> held (type_of_bits w) (datum_of w z) = Some (datum_of w z).
Proof. intros [-> | [-> | ->]]; reflexivity. Qed.
Lemma bound_datum n w z now : is_width w -> bound n (datum_of w z) now = (n, datum_of w z) :: now.
Proof. intros [-> | [-> | ->]]; reflexivity. Qed.

Theorem steps_run l : forall kinds last k now f rest, statements_of kinds l = Some (k, last) -> sound kinds now ->
  (existsb (fun s => is "select" (operation s)) l = true -> knows_side now) ->
  forallb (fun s => match look (name s) now with None => true | _ => false end) l = true -> forallb (fun s => negb (String.eqb (name s) "inner")) l = true ->
  Forall (runs num v inner) l ->
  go known procedures (List.length l + f) now (k ++ rest)%list = go known procedures f (after kinds l now) rest /\ sound last (after kinds l now).
Proof.
  induction l as [| s l IH]; intros kinds last k now f rest E S Side New Other R; cbn [statements_of] in E; [injection E as <- <-; split; [reflexivity | exact S] |].
  destruct (width_of kinds s) as [w |] eqn:Wd; [| discriminate]; destruct (existsb (fun t => String.eqb (name t) (name s)) l) eqn:Once; [discriminate |].
  destruct (statements_of _ l) as [[k' last'] |] eqn:G; [| discriminate]; injection E as <- <-.
  cbn [forallb] in New, Other; apply andb_prop in New as [N New]; apply andb_prop in Other as [O Other]; inversion R as [| ? ? Rs Rl]; subst.
  assert (Side' : is "select" (operation s) = true -> knows_side now) by (intros C; apply Side; cbn [existsb]; rewrite C; reflexivity).
  destruct (step_value kinds now s w S Side' Rs Wd) as (K & V & B).
  assert (N' : look (name s) now = None) by (destruct (look (name s) now); [discriminate | reflexivity]).
  cbn [List.length Nat.add app after]; rewrite Wd.
  assert (P : is_new (type_of_bits w) (name s) now = true) by (unfold is_new; rewrite N'; destruct K as [-> | [-> | ->]]; reflexivity).
  rewrite (go_put _ _ _ _ _ _ _ _ _ _ P V (held_datum w _ K)), bound_datum by exact K.
  apply IH; try assumption.
  - intros m u L; cbn [look] in L; destruct (String.eqb_spec (name s) m) as [<- | D].
    + injection L as <-; split; [exact K |]; cbn [look]; rewrite String.eqb_refl; split; [reflexivity | exact B].
    + destruct (S m u L) as (K' & L' & B'); split; [exact K' |]; cbn [look]; rewrite (proj2 (String.eqb_neq _ _) D); split; assumption.
  - intros C; unfold knows_side in *; cbn [look]; apply negb_true_iff in O; rewrite O; apply Side; cbn [existsb]; rewrite C; apply orb_true_r.
  - apply forallb_forall; intros t I; cbn [look]; destruct (String.eqb_spec (name s) (name t)) as [D | D]; [| exact (proj1 (forallb_forall _ _) New t I)].
    rewrite <- not_true_iff_false in Once; contradiction Once; apply existsb_exists; exists t; split; [exact I | apply String.eqb_eq; symmetry; exact D].
Qed.
End Run.

Lemma sound_alike num num' kinds now : sound num kinds now -> (forall n w, In (n, w) kinds -> num' n = num n) -> sound num' kinds now.
Proof. intros S A n w E; destruct (S n w E) as (K & L & B); split; [exact K |]; rewrite (A n w (look_in _ _ _ E)); split; assumption. Qed.

(** A name, a choice and a branch. *)
Lemma eval_named known now n d : look n now = Some d -> eval known now (Named n) = Some d.
Proof. intros E; cbn [eval]; rewrite E; reflexivity. Qed.
Lemma eval_chosen known now c a b t z : eval known now c = Some (Of t z) -> eval known now (Choice c a b) = if z =? 0 then eval known now b else eval known now a.
Proof. intros E; cbn [eval]; rewrite E; reflexivity. Qed.
Lemma eval_or known now l r t x u y : eval known now l = Some (Of t x) -> eval known now r = Some (Of u y) ->
  eval known now (Infix "||" l r) = Some (Of Int (if x =? 0 then if y =? 0 then 0 else 1 else 1)).
Proof. intros L R; cbn [eval]; rewrite L; destruct (x =? 0); [rewrite R; cbn; destruct (y =? 0) |]; reflexivity. Qed.
Lemma go_chosen known procedures f now c yes no rest t z : eval known now c = Some (Of t z) ->
  go known procedures (S f) now (If c yes no :: rest) = go known procedures f now ((if z =? 0 then no else yes) ++ rest)%list.
Proof. intros E; cbn [go]; rewrite E; reflexivity. Qed.

(** ** From what the steps begin with. *)

Section Computing.
Variable inner : bool.
Definition pattern_of (num : string -> Z) (s : step) : Z := match look (operation s) calls, arguments s with
  | Some (Sum, w), [Name a; Name c] => (num a + num c) mod 2 ^ w
  | Some (Difference, w), [Name a; Name c] => (num a - num c) mod 2 ^ w
  | Some (Wrapped, w), [Name a; Name c] => (num a * num c) mod 2 ^ w
  | Some (Whole, w), [Name a; Name c] => num a * num c
  | Some (Signed, w), [Name a; Name c] => (num a * num c - (if 2 ^ (w - 1) <=? num a then num c * 2 ^ w else 0)) mod 2 ^ (2 * w)
  | None, [Name side; Name a; Name c] => if inner then num a else num c
  | _, _ => 0 end.
Definition exact_value (v : string -> Z) (s : step) : Z := match look (operation s) calls, arguments s with
  | Some (Sum, w), [Name a; Name c] => v a + v c
  | Some (Difference, w), [Name a; Name c] => v a - v c
  | Some (_, w), [Name a; Name c] => v a * v c
  | None, [Name side; Name a; Name c] => if inner then v a else v c
  | _, _ => 0 end.
Fixpoint computed (of : (string -> Z) -> step -> Z) (num : string -> Z) (l : list step) := match l with
  | [] => num | s :: rest => computed of (put num (name s) (of num s)) rest end.

Definition operands s := flat_map (fun a => match a with Name n => [n] | _ => [] end) (arguments s).
Definition is_known s := match look (operation s) calls, arguments s with
  | Some _, [Name _; Name _] => true
  | None, [Name side; Name _; Name _] => is "select" (operation s) && is "inner" side
  | None, [Name a; Number 0] => is "lt" (operation s) && is "inner" (name s) && is "about" a
  | _, _ => false end.
(** No name is given twice, or read before it is given. *)
Fixpoint ordered (l : list step) := match l with
  | [] => true
  | s :: rest => is_known s && forallb (fun n => negb (existsb (fun t => String.eqb (name t) n) (s :: rest))) (match look (operation s) calls with Some _ => operands s | None => tl (operands s) end)
    && negb (existsb (fun t => String.eqb (name t) (name s)) rest) && ordered rest end.

Lemma computed_same of l : forall num n, existsb (fun t => String.eqb (name t) n) l = false -> computed of num l n = num n.
Proof.
  induction l as [| s l IH]; intros num n H; [reflexivity |]; cbn [existsb] in H; apply orb_false_elim in H as [H1 H2].
  cbn [computed]; rewrite IH by exact H2; apply put_other; exact H1.
Qed.

Theorem computed_run l : forall num v, ordered l = true -> Forall (runs (computed pattern_of num l) (computed exact_value v l) inner) l.
Proof.
  induction l as [| s l IH]; intros num v O; [constructor |]; cbn [ordered] in O; rewrite !andb_true_iff in O.
  destruct O as (((K & A) & N) & O); constructor; [| apply IH; exact O].
  apply negb_true_iff in N; rewrite forallb_forall in A.
  assert (own : computed pattern_of num (s :: l) (name s) = pattern_of num s /\ computed exact_value v (s :: l) (name s) = exact_value v s)
    by (cbn [computed]; rewrite !computed_same, !put_same by exact N; split; reflexivity).
  assert (other : forall n, In n (match look (operation s) calls with Some _ => operands s | None => tl (operands s) end) ->
    computed pattern_of num (s :: l) n = num n /\ computed exact_value v (s :: l) n = v n)
    by (intros n I; specialize (A n I); apply negb_true_iff in A; split; apply computed_same; exact A).
  unfold runs; rewrite (proj1 own), (proj2 own); clear own A N O IH; unfold pattern_of, exact_value, operands, is_known in *.
  destruct (look (operation s) calls) as [[c w] |].
  - destruct (arguments s) as [| [a | ?] [| [e | ?] [| ? ?]]]; try discriminate.
    destruct (other a ltac:(cbn; tauto)) as [-> ->], (other e ltac:(cbn; tauto)) as [-> ->]; destruct c; split; reflexivity.
  - destruct (arguments s) as [| [side | ?] [| [a | [| |]] [| [e | ?] [| ? ?]]]]; try discriminate; rewrite !andb_true_iff in K; unfold is in K; rewrite !String.eqb_eq in K.
    + destruct (other a ltac:(cbn; tauto)) as [-> ->], (other e ltac:(cbn; tauto)) as [-> ->]; destruct K as [K1 K2]; repeat split; symmetry; assumption.
    + destruct K as [[K1 K2] K3]; repeat split; symmetry; assumption.
Qed.
End Computing.
