(** The C that is printed in hypcheck.h is the programs: Coq reads both and compares them, step by step.

    HeaderText.v holds the text between "printed from the program" and "end of the program", copied from the header by
    build.py when the proofs are built. *)

Require Import List String Ascii ZArith Bool.
From Hypcheck Require Import Steps.
From Hypcheck Require Programs HeaderText.
Import ListNotations.
Open Scope string_scope.
Open Scope list_scope.

(** The exact integers are printed in parts: what one part needs, less what was there before. *)
Definition further (wanted before : list string) program :=
  let known := map name (needed before program) in
  filter (fun s => negb (is_in (name s) known)) (needed wanted program).

Definition exact := ["delta"; "n2"; "n1"].
Definition integers := needed exact Programs.integers
  ++ further ["offset_at_B"; "slope_at_B"] exact Programs.integers
  ++ further ["offset_at_A"; "slope_at_A"] exact Programs.integers
  ++ further ["slope_at_B"; "ring_excess"] exact Programs.integers.

(** Products of "fixed-terms" that the poles need are made again there, and moved down. *)
Definition moves := [("p_t", "mul by_t"); ("s_t", "mul by_t"); ("q_s", "mul by_q"); ("p_q", "mul by_q")].
Definition moved (wanted : list string) :=
  let read := flat_map reads (needed wanted Programs.fixed_poles) in
  flat_map (fun m => match filter (fun s => String.eqb (name s) (fst m)) Programs.fixed_terms with
    | [s] => if is_in (fst m) read then [Step (name s) (snd m) (arguments s)] else [] | _ => [] end) moves.
Definition at_pole wanted := moved wanted ++ needed wanted Programs.fixed_poles.

(** A tangency: what M and e do not change, two equations, the third and where the root lies; and all for short lengths. *)
Definition before := ["D_K"; "n2"; "inner"].
Definition equations := ["r1"; "r2"].
Definition last_of_tangency := ["r3"; "room_within"; "beyond"; "room_without"].
Definition guessed_from := ["D"; "K"; "inner"].
Definition of_waist := ["W"; "opposite"; "p_2"; "q_2"].

Definition decided := ["exterior"; "interior"; "decided"].
Definition kept := ["p"; "q"; "s"; "t"; "k0"; "k1"; "k2"; "minus_f0"; "f1"; "f2"; "f3"; "f4"].

(** The multiplier is chosen in C between two parts of "tilted": behind so many of its steps. *)
Definition tilted := needed decided Programs.tilted.
Definition before_multiplier := 52.

(** By the dialect of C: constants, or numbers that calls fill. *)
Inductive row := Constants (program : string) (steps : list step) | Fillings (program : string) (steps : list step).

Definition accepts (r : row) (part : string * string) := match r with
  | Constants n steps => String.eqb n (fst part) && agrees (declarations (snd part)) steps
  | Fillings n steps => String.eqb n (fst part) && agrees (fillings (snd part)) steps end.

Definition line_total := "R_plus_T".
Definition asked := [[line_total; "exterior"; "interior"; "decided"]; [line_total; "exterior"; "exterior_decided"];
  [line_total; "interior"; "interior_decided"]; [line_total; "contact"; "decided"]].

(** What the header must hold, in its order. *)
Definition expected := [
  Fillings "integers" integers;
  Constants "fixed-terms" (needed ["R"; "radial_2"; "axial_2"; "n1"; "N"; "ps"] Programs.fixed_terms);
  Constants "fixed-discriminant" (needed ["delta"; "middle"] Programs.fixed_discriminant);
  Constants "fixed-poles" (at_pole ["offset_at_B"; "slope_at_B"]);
  Constants "fixed-poles" (at_pole ["offset_at_A"; "slope_at_A"]);
  Constants "tangency, what M and e do not change" (needed before Programs.tangency);
  Constants "tangency, two equations" (further equations before Programs.tangency);
  Constants "tangency, the third, and where the root lies" (further last_of_tangency (before ++ equations) Programs.tangency);
  Constants "tangency, for short lengths" (needed guessed_from Programs.tangency);
  Constants "tangency, the equations for short lengths" (further (equations ++ last_of_tangency) guessed_from Programs.tangency);
  Constants "waist, W" (needed of_waist Programs.waist);
  Constants "waist, the discriminant" (further ["excess"] of_waist Programs.waist);
  Constants "waist, where the roots lie" (further ["W_p_2"; "room"] ("excess" :: of_waist) Programs.waist);
  Constants "tilted-quartic" (needed kept Programs.tilted_quartic);
  Constants "tilted-invariants" (needed ["I"; "J"] Programs.tilted_invariants);
  Constants "tilted-discriminant" (needed ["delta"] Programs.tilted_discriminant);
  Constants "single" (needed ["A"; "B"; "BB"; "P_plus_Q"; "c1"; "e1"; "c2"; "e2"; "delta_3"; "E"] Programs.single);
  Constants "tangent-beyond" (needed ["K_most"; "M_most"; "gap_least"] Programs.tangent_beyond);
  Constants "tangent-within" (needed ["K_least"; "M_least"; "across_least"] Programs.tangent_within);
  Constants "chord" (needed ["below"; "above"] Programs.chord);
  Constants "tangent-high" (needed ["across_least"; "fall_most"; "M_least"] Programs.tangent_high);
  Constants "piece" (needed ["here"; "slope"; "bend"; "size"] Programs.piece);
  Constants "certified" (needed decided Programs.certified)]
  ++ map (fun wanted => Constants "one-line" (needed wanted Programs.one_line)) asked
  ++ map (fun wanted => Constants "two-lines" (needed wanted Programs.two_lines)) asked
  ++ [Constants "tilted, its first part" (firstn before_multiplier tilted);
      Constants "tilted, the rest" (skipn before_multiplier tilted);
      Constants "one-plane" (needed ("distance" :: decided) Programs.one_plane);
      Constants "two-planes" (needed ("distance" :: decided) Programs.two_planes)].

Fixpoint verdicts (rows : list row) (parts : list (string * string)) : list bool := match rows, parts with
  | r :: rows', p :: parts' => accepts r p :: verdicts rows' parts'
  | [], [] => [] | _, _ => [false] end.

Theorem printed_text_is_the_programs : forallb id (verdicts expected HeaderText.parts) = true.
Proof. vm_compute; reflexivity. Qed.

(** ** Changes of the text, for `make prove` to see that they are refused. *)

Fixpoint with_line (text : string) (line : nat) (new : string) : string := match text, line with
  | EmptyString, _ => EmptyString
  | String c rest, S k => String c (with_line rest (if Ascii.eqb c "010" then k else line) new)
  | String c rest, O => if Ascii.eqb c "010" then (new ++ text)%string else with_line rest O new end.

(** Whether a part is accepted with one line changed. *)
Definition accepted_with (change : nat * nat * string) := let '(part, line, new) := change in
  match nth_error expected part, nth_error HeaderText.parts part with
  | Some r, Some (n, text) => accepts r (n, with_line text line new) | _, _ => true end.
