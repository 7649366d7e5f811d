(** Functions of the header that compute with long integers: Coq reads their text, and says what it means for limbs of any width.

    As in Limbs.v and Trees.v, but loops have bounds that are variables, and numbers lie in memory: a struct has a sign, a length and
    a pointer to limbs. The meaning is what must hold for a statement to end with all of C's rules kept, and with what is wanted
    afterwards: each value exists, each index lies in its array, each int in its range, each shift is below the width. *)

Require Import List String Ascii ZArith Lia Bool.
From Hypcheck Require Import Steps Fixed Long Limbs Trees.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** ** The text. *)

(** A number of a type, a pointer to a number, or a pointer to limbs. A limb is read as U32, which no function here has besides. *)
Inductive form := Is (t : type) | ToNumber | ToLimbs.
Notation Limb := U32.

Inductive act := Skip | Then (a b : act) | Block (a : act)
  | Names (f : form) (n : string) (e : option expression) (* a new variable *)
  | Puts (target : expression) (o : string) (e : expression) (* "" puts the value itself *)
  | PutsNext (limbs i : string) (e : expression) (* limbs[i++] = e *)
  | Calls (f : string) (given : list expression) | Branch (c : expression) (yes no : act)
  | Loop (c : expression) (next body : act) | Gives (e : option expression).
Record routine := Routine { gives : option type; gets : list (form * string); acts : act }.

Definition form_of (ws : list string) : option (form * list string) := match ws with
  | "hc_integer" :: "*" :: "const" :: rest | "hc_integer" :: "*" :: rest => Some (ToNumber, rest)
  | "hc_limb" :: "*" :: "const" :: rest | "hc_limb" :: "*" :: rest => Some (ToLimbs, rest)
  | t :: rest => try u <- type_of t; Some (Is u, rest)
  | [] => None end.
Definition unless_const (ws : list string) := match ws with "const" :: rest => rest | _ => ws end.

Fixpoint new_names (fuel : nat) (k : form) (ws : list string) : option (act * list string) := match fuel, ws with
  | S f, n :: rest =>
    try (e, more) <- match behind ["="] rest with
      | Some (_, value) => try (e, more) <- expression_of enough 0 value; Some (Some e, more) | None => Some (None, rest) end;
    match behind [";"] more, behind [","] more with
    | Some (_, last), _ => Some (Names k n e, last)
    | _, Some (_, others) => try (l, last) <- new_names f k others; Some (Then (Names k n e) l, last)
    | _, _ => None end
  | _, _ => None end.

(** An assignment, up to what closes it. *)
Definition assignment closing (ws : list string) : option (act * list string) :=
  let one o rest t := try (_, last) <- behind [closing] rest; Some (Puts t o (Constant Int 1), last) in
  let value o t rest := try (e, last) <- expression_to closing rest; Some (Puts t o e, last) in
  match behind [closing] ws, behind [""; "["; ""; "++"; "]"; "="] ws with
  | Some (_, last), _ => Some (Skip, last)
  | _, Some ([a; i], rest) => try (e, last) <- expression_to closing rest; Some (PutsNext a i e, last)
  | _, _ => try (t, more) <- expression_of enough unary ws; match more with
    | "++" :: rest => one "+" rest t
    | "-" :: "-" :: rest => one "-" rest t
    | "=" :: rest => value "" t rest
    | "+=" :: rest => value "+" t rest
    | "-=" :: rest => value "-" t rest
    | ">>" :: "=" :: rest => value ">>" t rest
    | _ => None end end.

Fixpoint act_of (fuel : nat) (ws : list string) : option (act * list string) := match fuel, ws with
  | S f, w :: rest =>
    if is "{" w then try (a, more) <- acts_of f rest; Some (Block a, more)
    else if is "return" w then match behind [";"] rest with
      | Some (_, more) => Some (Gives None, more)
      | None => try (e, more) <- expression_to ";" rest; Some (Gives (Some e), more) end
    else if is "if" w then
      try (_, inner) <- behind ["("] rest; try (c, more) <- expression_to ")" inner; try (yes, more') <- act_of f more;
      match behind ["else"] more' with
      | Some (_, other) => try (no, last) <- act_of f other; Some (Branch c yes no, last)
      | None => Some (Branch c yes Skip, more') end
    else if is "for" w then
      try (_, inner) <- behind ["("] rest; try (first, more) <- assignment ";" inner; try (c, more') <- expression_to ";" more;
      try (next, more'') <- assignment ")" more'; try (body, last) <- act_of f more''; Some (Then first (Loop c next body), last)
    else match form_of (unless_const ws) with
    | Some (k, names) => new_names enough k names
    | None => match behind [""; "("] ws with
      | Some (_, inner) => try (l, more) <- listed_to enough ")" inner; try (_, last) <- behind [";"] more; Some (Calls w l, last)
      | None => assignment ";" ws end end
  | _, _ => None end
with acts_of (fuel : nat) (ws : list string) : option (act * list string) := match fuel, ws with
  | S f, w :: rest => if is "}" w then Some (Skip, rest)
    else try (a, more) <- act_of f ws; try (b, last) <- acts_of f more; Some (Then a b, last)
  | _, _ => None end.

(** Parameters; the parts of a double are three. *)
Fixpoint given_forms (fuel : nat) (ws : list string) : option (list (form * string) * list string) := match fuel with O => None | S f =>
  try (l, more) <- match ws with
    | "hc_parts" :: n :: rest => Some ([(Is Int, n ++ ".sign"); (Is Int, n ++ ".exponent"); (Is U64, n ++ ".mantissa")], rest)
    | _ => try (k, more) <- form_of (unless_const ws); match more with n :: rest => Some ([(k, n)], rest) | [] => None end end;
  match more with
  | ")" :: "{" :: rest => Some (l, rest)
  | "," :: rest => try (l', last) <- given_forms f rest; Some (l ++ l', last)%list
  | _ => None end end.

(** The name, and what is read. *)
Definition routine_of (text : string) : option (string * routine) := match tidy (words text) with
  | "static" :: t :: n :: "(" :: rest => try (p, inner) <- given_forms enough rest;
    try k <- (if is "void" t then Some None else try u <- type_of t; Some (Some u));
    try (a, last) <- acts_of (List.length inner) inner; match last with [] => Some (n, Routine k p a) | _ => None end
  | _ => None end.

(** ** Its meaning. *)

(** What a variable holds: a number of its type, none yet, a pointer to a number, or one to the k-th limb of an array. *)
Inductive content := Holds (t : type) (z : Z) | Nothing (t : type) | To (p : Z) | Into (a k : Z).
Definition variables := list (string * content).
Record memory := Memory { sign_at : Z -> option Z; length_at : Z -> option Z; limb_at : Z -> Z -> option Z }.

Definition put_at {A} (f : Z -> A) p v := fun q => if q =? p then v else f q.
Definition with_sign m p z := Memory (put_at (sign_at m) p (Some z)) (length_at m) (limb_at m).
Definition with_length m p z := Memory (sign_at m) (put_at (length_at m) p (Some z)) (limb_at m).
Definition with_limb m a k z := Memory (sign_at m) (length_at m) (put_at (limb_at m) a (put_at (limb_at m a) k (Some z))).

(** "left.sign" is a field of what left points to. *)
Fixpoint field_of (n before : string) : option (string * string) := match n with
  | EmptyString => None | String "." f => Some (before, f) | String c rest => field_of rest (before ++ String c "") end.
Fixpoint with_content n c (now : variables) : variables := match now with
  | [] => [] | (m, old) :: rest => if String.eqb m n then (m, c) :: rest else (m, old) :: with_content n c rest end.

Fixpoint mentions n (e : expression) : bool := match e with
  | Named m => is n m | Constant _ _ => false | Infix _ l r | Part l r => mentions n l || mentions n r
  | Choice c a b => mentions n c || mentions n a || mentions n b | As _ e => mentions n e | Called _ _ | Braces _ => true end.

Section Meaning.

(** The bits of a limb; a wide number has twice as many. *)
Variable bits : Z.
(** The array to which the limbs of a number lead, and how many limbs it has. *)
Variables owned room : Z -> Z.

Definition size t := match t with Int => 32 | Limb => bits | U64 => 64 | Wide => 2 * bits end.
Definition same_type t u := match t, u with Int, Int | Limb, Limb | U64, U64 | Wide, Wide => true | _, _ => false end.
Definition common_type t u := if same_type t u then Some t else match t, u with
  | Int, v | v, Int => Some v | Limb, Wide | Wide, Limb => Some Wide | _, _ => None end.

(** A result, or a number put into a type. *)
Definition made t z (K : Z -> Prop) := match t with Int => - 2 ^ 31 <= z < 2 ^ 31 /\ K z | _ => K (z mod 2 ^ size t) end.
Definition turned t u z K := if same_type t u then K z else match t, u with Limb, Wide => K z | _, _ => made u z K end.

Definition truth (c : bool) (K : content -> Prop) := K (Holds Int (if c then 1 else 0)).
Definition of_type t (K : content -> Prop) z := K (Holds t z).
Definition arithmetic o t a b (K : content -> Prop) : Prop := match o with
  | "+" => made t (a + b) (of_type t K) | "-" => made t (a - b) (of_type t K) | "*" => made t (a * b) (of_type t K)
  | "/" => b <> 0 /\ made t (Z.quot a b) (of_type t K) | "|" => of_type t K (Z.lor a b)
  | "<" => truth (a <? b) K | ">" => truth (b <? a) K | "<=" => truth (a <=? b) K | ">=" => truth (b <=? a) K
  | "==" => truth (a =? b) K | "!=" => truth (negb (a =? b)) K | _ => False end.
Definition shifted o t a k (K : content -> Prop) := 0 <= k < size t /\ 0 <= a /\
  if String.eqb o "<<" then made t (a * 2 ^ k) (of_type t K) else of_type t K (a / 2 ^ k).
Definition infixed o (x y : content) (K : content -> Prop) : Prop := match x, y with
  | Into a k, Holds Int j => String.eqb o "+" = true /\ 0 <= k + j <= room a /\ K (Into a (k + j))
  | Holds t a, Holds u b => if is_in o ["<<"; ">>"] then shifted o t a b K
    else match common_type t u with Some v => turned t v a (fun a => turned u v b (fun b => arithmetic o v a b K)) | None => False end
  | _, _ => False end.

(** The type that a choice has, whichever it takes; a pointer has none. *)
Fixpoint type_in (now : variables) (e : expression) : option type := match e with
  | Named n => match look n now, field_of n "" with
    | Some (Holds t _), _ | Some (Nothing t), _ => Some t | None, Some (_, "limbs") => None | None, Some _ => Some Int | _, _ => None end
  | Constant t _ | As t _ => Some t
  | Infix o l r => if is_in o ["<<"; ">>"] then type_in now l
    else if is_in o ["+"; "-"; "*"; "/"; "|"] then match type_in now l, type_in now r with Some t, Some u => common_type t u | _, _ => None end else Some Int
  | Choice _ a b => match type_in now a, type_in now b with Some t, Some u => common_type t u | _, _ => None end
  | Part _ _ => Some Limb
  | _ => None end.
Definition in_common j k (K : content -> Prop) v : Prop := match v, j, k with
  | Holds t z, Some u, Some w => match common_type u w with Some s => turned t s z (of_type s K) | None => False end
  | Holds _ _, _, _ | Nothing _, _, _ => False
  | _, None, None => K v | _, _, _ => False end.

Definition named_value (now : variables) m n (K : content -> Prop) : Prop := match look n now, field_of n "" with
  | Some (Nothing _), _ => False
  | Some v, _ => K v
  | None, Some (p, f) => match look p now with
    | Some (To q) => match f with
      | "sign" => exists z, sign_at m q = Some z /\ K (Holds Int z) | "length" => exists z, length_at m q = Some z /\ K (Holds Int z)
      | "limbs" => K (Into (owned q) 0) | _ => False end
    | _ => False end
  | None, None => if is n "HC_LIMB_BITS" then K (Holds Int bits) else False end.

Fixpoint value (now : variables) m (e : expression) (K : content -> Prop) : Prop := match e with
  | Named n => named_value now m n K
  | Constant t z => K (Holds t z)
  | Infix o l r => value now m l (fun x => value now m r (fun y => infixed o x y K))
  | Choice c a b => value now m c (fun x => match x with
    | Holds _ z => let K' := in_common (type_in now a) (type_in now b) K in if z =? 0 then value now m b K' else value now m a K'
    | _ => False end)
  | As t e => value now m e (fun x => match x with Holds u z => turned u t z (of_type t K) | _ => False end)
  | Part a i => value now m a (fun x => value now m i (fun y => match x, y with
    | Into b k, Holds Int j => 0 <= k + j < room b /\ exists z, limb_at m b (k + j) = Some z /\ K (Holds Limb z) | _, _ => False end))
  | Called _ _ | Braces _ => False end.

Definition put_into (now : variables) m target v (K : variables -> memory -> Prop) : Prop := match target, v with
  | Named n, Holds u z => match look n now, field_of n "" with
    | Some (Holds t _), _ | Some (Nothing t), _ => turned u t z (fun x => K (with_content n (Holds t x) now) m)
    | None, Some (p, f) => match look p now with
      | Some (To q) => turned u Int z (fun x => match f with "sign" => K now (with_sign m q x) | "length" => K now (with_length m q x) | _ => False end)
      | _ => False end
    | _, _ => False end
  | Part a i, Holds u z => value now m a (fun x => value now m i (fun y => match x, y with
    | Into b k, Holds Int j => 0 <= k + j < room b /\ turned u Limb z (fun x => K now (with_limb m b (k + j) x)) | _, _ => False end))
  | _, _ => False end.

(** A value as a new variable holds it. *)
Definition as_form k v (K : content -> Prop) : Prop := match k, v with
  | Is t, Holds u z => turned u t z (of_type t K) | ToNumber, To _ | ToLimbs, Into _ _ => K v | _, _ => False end.
Fixpoint values (now : variables) m (l : list expression) (K : list content -> Prop) : Prop := match l with
  | [] => K [] | e :: rest => value now m e (fun v => values now m rest (fun l => K (v :: l))) end.
Fixpoint bind_all (l : list (form * string)) (given : list content) (K : variables -> Prop) : Prop := match l, given with
  | [], [] => K []
  | (k, n) :: rest, v :: others => as_form k v (fun c => bind_all rest others (fun now => K ((n, c) :: now)))
  | _, _ => False end.

Section Calls.

(** A function that is called: what it returns, if anything, and the memory afterwards. *)
Variable call : string -> list content -> memory -> (option content -> memory -> Prop) -> Prop.

Definition result now m e (K : content -> memory -> Prop) : Prop := match e with
  | Called f given => values now m given (fun l => call f l m (fun v m' => match v with Some c => K c m' | None => False end))
  | _ => value now m e (fun v => K v m) end.

(** It ends: by what is wanted behind it, or of what is returned. *)
Fixpoint ends (a : act) (now : variables) (m : memory) (Q : variables -> memory -> Prop) (R : option content -> memory -> Prop) : Prop := match a with
  | Skip => Q now m
  | Then a b => ends a now m (fun now m => ends b now m Q R) R
  | Block a => ends a now m (fun now' m => Q (skipn (List.length now' - List.length now) now') m) R
  | Names (Is t) n None => Q ((n, Nothing t) :: now) m
  | Names _ n None => False
  | Names k n (Some e) => result now m e (fun v m => as_form k v (fun c => Q ((n, c) :: now) m))
  | Puts target o e => if is "" o then result now m e (fun v m => put_into now m target v Q)
    else value now m target (fun x => value now m e (fun y => infixed o x y (fun v => put_into now m target v Q)))
  | PutsNext b i e => mentions i e = false /\ value now m e (fun v => put_into now m (Part (Named b) (Named i)) v (fun now m =>
      value now m (Infix "+" (Named i) (Constant Int 1)) (fun v => put_into now m (Named i) v Q)))
  | Calls f given => values now m given (fun l => call f l m (fun _ m => Q now m))
  | Branch c yes no => value now m c (fun x => match x with Holds _ z => if z =? 0 then ends no now m Q R else ends yes now m Q R | _ => False end)
  | Loop c next body => exists times : nat, (fix turn times now m : Prop := value now m c (fun x => match x with
      | Holds _ z => if z =? 0 then Q now m else match times with
        | S k => ends body now m (fun now m => ends next now m (turn k) R) R | O => False end
      | _ => False end)) times now m
  | Gives None => R None m
  | Gives (Some e) => value now m e (fun v => R (Some v) m) end.
End Calls.

Variable routines : list (string * routine).

(** Functions that call each other no deeper than so. *)
Fixpoint called (deep : nat) f given m (K : option content -> memory -> Prop) : Prop := match deep, look f routines with
  | S d, Some r => bind_all (gets r) given (fun now => ends (called d) (acts r) now m (fun _ m => K None m)
      (fun v m => match v, gives r with
        | None, None => K None m | Some c, Some t => as_form (Is t) c (fun c => K (Some c) m) | _, _ => False end))
  | _, _ => False end.

End Meaning.

(** A loop whose turns are counted downwards. *)
Lemma loop_ends bits owned room call c next body (Q : variables -> memory -> Prop) R (I : nat -> variables -> memory -> Prop) n now m : I n now m ->
  (forall k now m (K : variables -> memory -> Prop), I (S k) now m -> (forall now m, I k now m -> K now m) -> value bits owned room now m c (fun x => match x with
    | Holds _ z => if z =? 0 then Q now m else ends bits owned room call body now m (fun now m => ends bits owned room call next now m K R) R
    | _ => False end)) ->
  (forall now m, I O now m -> value bits owned room now m c (fun x => match x with Holds _ z => if z =? 0 then Q now m else False | _ => False end)) ->
  ends bits owned room call (Loop c next body) now m Q R.
Proof.
  intros H turns last; exists n; revert now m H; induction n as [| k IH]; intros now m H; cbn [ends]; [exact (last now m H) |].
  apply turns with (k := k); [exact H | exact IH].
Qed.
