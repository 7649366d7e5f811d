(** Functions of the header that have arrays, pointers into them, casts of floats or numbers with a point: Coq reads their text in
    plainer words, as Trees.v does. *)

Require Import List String Ascii ZArith Bool.
From Hypcheck Require Import Steps Limbs Trees.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** A number with a point or a power is a name for Coq, "_0.5". *)
Definition is_digit c := match digit c with Some _ => true | None => false end.
Fixpoint some_letter (p : ascii -> bool) s := match s with EmptyString => false | String c rest => p c || some_letter p rest end.
Fixpoint ends_with (c : ascii) s := match s with EmptyString => false | String a EmptyString => Ascii.eqb a c | String _ rest => ends_with c rest end.
Definition begins_with (p : ascii -> bool) s := match s with String c _ => p c | EmptyString => false end.

(** In plainer words: casts are calls, memcpy of a whole array is =, arrays of seven places, or of two with
    their values, are declared without their sizes, "a[i].field" is a place of
    an array "a.field", and a pointer into an array, "int *const p = a + i;", is the number "p.at" of a place: *p is a[p.at]. What a
    shape finds is written with other words; the pointers are known from then on. *)
Definition pointers := list (string * string).
Definition written := option (list string * pointers * list string).
Definition shaped_as shape ws (k : list string -> option (list string * pointers)) : written :=
  match behind shape ws with Some (l, rest) => try (out, more) <- k l; Some (out, more, rest) | None => None end.
Definition unless_found (a b : written) : written := match a with Some _ => a | None => b end.
Definition float_word ws : written := match ws with
  | w :: rest => if begins_with is_digit w && some_letter (Ascii.eqb ".") w then Some (["_" ++ w], [], rest) else None | [] => None end.
Definition in_plain_words (known : pointers) ws : written := fold_right unless_found None [
  shaped_as ["("; "double"; ")"; "("; "int64_t"; ")"; ""] ws (fun l => match l with [n] => Some (["as_double"; "("; n; ")"], []) | _ => None end);
  shaped_as ["("; "uint64_t"; ")"; "("; "int64_t"; ")"; "("] ws (fun _ => Some (["as_word"; "("], []));
  shaped_as ["memcpy"; "("; ""; ","; ""; ","; "sizeof"; ""; ")"] ws (fun l => match l with [a; c; b] => if is a b then Some ([a; "="; c], []) else None | _ => None end);
  shaped_as ["int"; "*"; "const"; ""; "="; ""; "+"] ws (fun l => match l with [p; a] => Some (["const"; "int"; p ++ ".at"; "="], [(p, a)]) | _ => None end);
  shaped_as [","; ""; "["; ""; "]"; "="; "{"] ws (fun l => match l with [n; k] => if is "2" k then Some ([";"; n; "="; "{"], []) else None | _ => None end);
  shaped_as [""; ""; "["; ""; "]"; ";"] ws (fun l => match l with [t; n; k] => if is_in t types && is "7" k then Some ([t; n; ";"], []) else None | _ => None end);
  shaped_as [""; "["; ""; "]"; ""] ws (fun l => match l with
    | [a; i; field] => if begins_with (Ascii.eqb ".") field then Some ([a ++ field; "["; i; "]"], []) else None | _ => None end);
  shaped_as [""; "*"; ""] ws (fun l => match l with
    | [q; p] => if is_in q ["("; ";"; "{"; "}"] then try a <- look p known; Some ([q; a; "["; p ++ ".at"; "]"], []) else None | _ => None end);
  shaped_as [""; "-"; ""] ws (fun l => match l with
    | [m; k] => if begins_with is_digit m && ends_with "e" m && begins_with is_digit k then Some (["_" ++ m ++ "-" ++ k], []) else None | _ => None end);
  float_word ws].
Fixpoint plainer (fuel : nat) (known : pointers) (ws : list string) : list string := match fuel, ws with
  | S f, w :: rest => match in_plain_words known ws with
    | Some (out, more, further) => (out ++ plainer f (more ++ known) further)%list | None => w :: plainer f known rest end
  | _, _ => [] end.

Definition read_from (text : string) : option (string * deciding) := let ws := words text in
  match without_storage (tidy (plainer (List.length ws) [] ws)) with
  | _ :: n :: "(" :: rest => try (p, inner) <- parameters_named rest ""; try (l, last) <- trees_of (List.length inner) inner;
    match last with [] => Some (n, Deciding p l) | _ => None end
  | _ => None end.
