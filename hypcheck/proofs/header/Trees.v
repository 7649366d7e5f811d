(** Functions of the header that decide: Coq reads their text, with its branches, and runs it.

    As in Limbs.v, but a number of words is one value, whatever its words are, structs have fields by name, and arguments that are
    addresses of variables get what the function called puts there. A function that is called computes what is said of it. What is
    read declares constants and variables, puts values into them and into arrays, calls functions, branches, counts and returns. An integer
    of any length has room for so many bits, and is a whole number with a sign as soon as a function has filled it. An array of structs
    is a struct of arrays.

    A float that a step computes is known by the name of that step alone, and what operators make of it is said of them as of functions. *)

Require Import List String Ascii ZArith Bool.
From Hypcheck Require Import Steps Fixed Long Limbs.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

(** ** The text. *)

Inductive tree := Set_ (type : string) (n : string) (e : expression) (* "" for a variable that is there *)
  | Calling (f : string) (given : list expression) | If (c : expression) (yes no : list tree)
  | Turns (i : string) (count by_ : expression) (l : list tree) (* for (; i < count; i += by) *)
  | Place (a : string) (i e : expression) (* a[i] = e *) | Returns (e : expression).
Record deciding := Deciding { takes : list string; does : list tree }.

(** Fields of what a pointer leads to are named like others, and so is what it points at; an address is a name. *)
Fixpoint tidy (ws : list string) : list string := match ws with
  | w :: "->" :: field :: rest => (w ++ "." ++ field) :: tidy rest
  | "(" :: "&" :: rest => "(" :: tidy rest
  | "," :: "&" :: rest => "," :: tidy rest
  | ";" :: "*" :: rest => ";" :: tidy rest
  | w :: rest => w :: tidy rest
  | [] => [] end.

Definition types := ["int"; "uint64_t"; "double"; "hc_fixed"; "hc_long"; "hc_parts"; "hc_fixed_terms"; "hc_fixed_cubic"; "hc_bits"; "HC_NUMBER"; "HC_TRUTH"].

(** A function that returns a value and puts others: the value is the first that it puts. *)
Definition answering := ["hc_fixed_position"; "hc_short_lengths"].
Definition setting t n e := match e with
  | Called f (given :: rest) => if is_in f answering then Calling f (given :: Named n :: rest) else Set_ t n e
  | Choice c a (Called f (given :: rest)) => if is_in f answering then If c [Set_ t n a] [Calling f (given :: Named n :: rest)] else Set_ t n e
  | _ => Set_ t n e end.

(** Names behind a type, those with values; and assignments. *)
Fixpoint names_of (fuel : nat) (t : string) (ws : list string) : option (list tree * list string) := match fuel, ws with
  | S f, n :: rest =>
    try (l, more) <- match behind ["="] rest with
      | Some (_, value) => try (e, more) <- expression_of enough 0 value; Some ([setting t n e], more)
      | None => if is "" t then None else Some ([], rest) end;
    match behind [";"] more, behind [","] more with
    | Some (_, last), _ => Some (l, last)
    | _, Some (_, others) => try (k, last) <- names_of f t others; Some (l ++ k, last)%list
    | _, _ => None end
  | _, _ => None end.

(** "HC_INTEGER(p, 42);" declares an integer, and "hc_add(&p, &a, &b);" fills it, by what room there is. *)
Definition fillings := ["hc_add"; "hc_subtract"; "hc_multiply"; "hc_scale"; "hc_in_units"].
Definition calling f given := match given with
  | Named n :: rest => if is "HC_INTEGER" f then Set_ "hc_integer" n (Called f rest)
    else if is_in f fillings then Set_ "" n (Called f given) else Calling f given
  | _ => Calling f given end.

Fixpoint statement_of (fuel : nat) (ws : list string) : option (list tree * list string) := match fuel, ws with
  | S f, w :: rest =>
    if is "{" w then trees_of f rest
    else if is "return" w then try (e, more) <- expression_to ";" rest; Some ([Returns e], more)
    else if is "if" w then
      try (_, inner) <- behind ["("] rest; try (c, more) <- expression_to ")" inner; try (yes, more') <- statement_of f more;
      match behind ["else"] more' with
      | Some (_, other) => try (no, last) <- statement_of f other; Some ([If c yes no], last)
      | None => Some ([If c yes []], more') end
    else if is "for" w then match behind ["("; ""; "="; ""; ";"; ""; "<"] rest with
      | Some ([i; first; j], inner) => try start <- atom first; try (count, more) <- expression_to ";" inner;
        try (k, by_, body) <- match behind [""; "+="] more, behind [""; "++"; ")"] more with
          | Some ([k], more'), _ => try (by_, body) <- expression_to ")" more'; Some (k, by_, body)
          | _, Some ([k], body) => Some (k, Constant Int 1, body)
          | _, _ => None end;
        try (l, last) <- statement_of f body; if is i j && is i k then Some ([Set_ "" i start; Turns i count by_ l], last) else None
      | _ => None end
    else if is "const" w then match rest with t :: names => if is_in t types then names_of enough t names else None | [] => None end
    else if is_in w types then names_of enough w rest
    else match behind ["|"; "="] rest, behind ["["] rest with
    | Some (_, value), _ => try (e, more) <- expression_to ";" value; Some ([Set_ "" w (Infix "|" (Named w) e)], more)
    | _, Some (_, inner) => try (i, more) <- expression_to "]" inner; try (_, value) <- behind ["="] more;
      try (e, last) <- expression_to ";" value; Some ([Place w i e], last)
    | _, _ => match behind ["("] rest with
    | Some (_, inner) => try (l, more) <- listed_to enough ")" inner; try (_, last) <- behind [";"] more; Some ([calling w l], last)
    | None => names_of enough "" ws end end
  | _, _ => None end
with trees_of (fuel : nat) (ws : list string) : option (list tree * list string) := match fuel, ws with
  | S f, w :: rest => if is "}" w then Some ([], rest)
    else try (l, more) <- statement_of f ws; try (k, last) <- trees_of f more; Some (l ++ k, last)%list
  | _, _ => None end.

(** The names of parameters: the last word of each, but for brackets. *)
Fixpoint parameters_named (ws : list string) (last : string) : option (list string * list string) := match ws with
  | "," :: rest => try (l, more) <- parameters_named rest ""; Some (last :: l, more)
  | ")" :: "{" :: rest => Some ([last], rest)
  | "[" :: _ :: "]" :: rest => parameters_named rest last
  | "*" :: rest => parameters_named rest last
  | w :: rest => parameters_named rest w
  | [] => None end.

Definition deciding_of (text : string) : option (string * deciding) := match without_storage (tidy (words text)) with
  | _ :: n :: "(" :: rest => try (p, inner) <- parameters_named rest ""; try (l, last) <- trees_of (List.length inner) inner;
    match last with [] => Some (n, Deciding p l) | _ => None end
  | _ => None end.

(** ** Its meaning. *)

(** A double is a whole number times 2^(power - 1075). Opaque is a float, or a vector of them, that a step of this name gives in its turn
    of a loop, or a place in an array, by its number. *)
Inductive datum := Of (t : type) (z : Z) | Fix (n : number) | Lng (n : long) | Double (whole power : Z) | Rec (l : list (string * datum))
  | Room (bits : Z) | Whole (z : Z) | Opaque (n : string) (turn : Z).
Definition environment := list (string * datum).

Fixpoint prefixed (p s : string) : option string := match p, s with
  | EmptyString, _ => Some s
  | String a p', String c s' => if Ascii.eqb a c then prefixed p' s' else None
  | _, _ => None end.
Definition fields n (now : environment) := flat_map (fun v => match prefixed (n ++ ".") (fst v) with Some f => [(f, snd v)] | None => [] end) now.
Definition bound n v (now : environment) : environment := match v with
  | Rec l => app (map (fun f => (n ++ "." ++ fst f, snd f)) l) now
  | Whole z => (n ++ ".sign", Of Int (Z.sgn z)) :: (n, v) :: now | _ => (n, v) :: now end.

Definition places := [(0, "0"); (1, "1"); (2, "2"); (3, "3"); (4, "4"); (5, "5"); (6, "6")].
Definition place k := match find (fun p => fst p =? k) places with Some p => Some (snd p) | None => None end.

(** Two doubles in one unit. *)
Definition in_unit m e k := m * 2 ^ (e - Z.min e k).
Definition compare_doubles o m e n k := let a := in_unit m e k in let b := in_unit n k e in
  look o [("<", carry a b); (">", carry b a); ("<=", 1 - carry b a); (">=", 1 - carry a b); ("==", same a b); ("!=", 1 - same a b)].

Definition plain_infix o t x u y : option datum := if String.eqb o "/" then
    match t, u with Int, Int => if y =? 0 then None else try z <- made_of Int (Z.quot x y); Some (Of Int z) | _, _ => None end
  else match infix_of o t x u y with Some (Val v z) => Some (Of v z) | _ => None end.

Definition truth v := match v with Of _ z => Some (Of Int (if z =? 0 then 0 else 1)) | _ => None end.

Section Meaning.
Variable known : list (string * (list datum -> option datum)).
(** So many arguments are values; what the others get. *)
Variable procedures : list (string * (nat * (list datum -> option (list datum)))).

Fixpoint eval (now : environment) (e : expression) : option datum := match e with
  | Named n => match look n now with Some v => Some v | None => match fields n now with [] => None | l => Some (Rec l) end end
  | Constant t z => Some (Of t z)
  | Infix o l r => match eval now l with
    | Some (Of t x) =>
      if String.eqb o "&&" then if x =? 0 then Some (Of Int 0) else try v <- eval now r; truth v
      else if String.eqb o "||" then if x =? 0 then try v <- eval now r; truth v else Some (Of Int 1)
      else match eval now r with Some (Of u y) => plain_infix o t x u y
        | Some v => try m <- look o known; m [Of t x; v] | None => None end
    | Some (Opaque n k) => try v <- eval now r; try m <- look o known; m [Opaque n k; v]
    | Some (Double m k) => match eval now r with Some (Double n j) => try z <- compare_doubles o m k n j; Some (Of Int z)
      | Some v => try f <- look o known; f [Double m k; v] | None => None end
    | _ => None end
  | Choice c a b => match eval now c with Some (Of _ z) => if z =? 0 then eval now b else eval now a | _ => None end
  | Called f given => try m <- look f known; try l <- every (map (eval now) given); m l
  | Part e i => match eval now i, eval now e with
    | Some (Of Int k), Some (Fix n) => Some (Of U64 (if k =? 0 then low_word n else high_word n))
    | Some (Of Int k), Some (Rec l) => try f <- place k; look f l
    | _, _ => None end
  | As t e => match eval now e with Some (Of u z) => try x <- converted u t z; Some (Of t x) | _ => None end
  | Braces l => try k <- every (map (eval now) l); Some (Rec (combine (map snd places) k)) end.

(** A value as a variable of a type holds it. *)
Definition held t v := match t, v with
  | "", _ => Some v
  | "int", Of u z => try x <- converted u Int z; Some (Of Int x)
  | "uint64_t", Of u z => try x <- converted u U64 z; Some (Of U64 x)
  | "double", Double _ _ | "double", Opaque _ _ | "HC_NUMBER", Opaque _ _ | "HC_TRUTH", Opaque _ _ | "hc_fixed", Fix _ | "hc_long", Lng _ => Some v
  | "hc_integer", Room _ | "hc_parts", Rec _ | "hc_fixed_terms", Rec _ | "hc_fixed_cubic", Rec _ => Some v
  | "hc_bits", Rec [(_, Of t a); (_, Of u b); (_, Of v c)] => try x <- converted t U64 a; try y <- converted u U64 b; try z <- converted v U64 c;
    Some (Rec [("plus", Of U64 x); ("minus", Of U64 y); ("decided", Of U64 z)])
  | _, _ => None end.
Definition is_new t n (now : environment) := is "" t || match look n now with Some _ => false | None => true end.

(** Without the variables that a block declares. *)
Fixpoint declared_in (s : tree) : list string := match s with
  | Set_ t n _ => if is "" t then [] else [n] | If _ yes no => flat_map declared_in yes ++ flat_map declared_in no
  | Turns _ _ _ l => flat_map declared_in l | _ => [] end.
Definition declared (l : list tree) := flat_map declared_in l.
Definition outside l (now : environment) := filter (fun v => negb (is_in (fst v) (declared l))) now.

(** A place in an array: an int that is put into one of doubles is 0; where there was no value yet, it is not below 0. *)
Definition placed a p v (now : environment) : option environment := let n := a ++ "." ++ p in match v with
  | Rec l => Some (app (map (fun f => (a ++ "." ++ fst f ++ "." ++ p, snd f)) l) now)
  | Of u z => match look n now with
    | Some (Of t _) => try x <- converted u t z; Some ((n, Of t x) :: now)
    | Some (Double _ _) => if z =? 0 then Some ((n, Double 0 (-4096)) :: now) else None
    | _ => if 0 <=? z then Some ((n, v) :: now) else None end
  | _ => Some ((n, v) :: now) end.

Fixpoint bound_all (given : list expression) (got : list datum) (now : environment) : option environment := match given, got with
  | [], [] => Some now
  | Named n :: given', v :: got' => bound_all given' got' (bound n v now)
  | _, _ => None end.

(** What is returned, if anything is, and the variables. *)
Fixpoint go (fuel : nat) (now : environment) (l : list tree) : option (option datum * environment) := match fuel, l with
  | S _, [] => Some (None, now)
  | S _, Returns e :: _ => try v <- eval now e; Some (Some v, now)
  | S f, Set_ t n e :: rest => if is_new t n now then try v <- eval now e; try w <- held t v; go f (bound n w now) rest else None
  | S f, Calling g given :: rest => try (k, m) <- look g procedures; try l <- every (map (eval now) (firstn k given));
    try got <- m l; try now' <- bound_all (skipn k given) got now; go f now' rest
  | S f, If c yes no :: rest => match eval now c with
    | Some (Of _ z) => go f now ((if z =? 0 then no else yes) ++ rest)%list | _ => None end
  | S f, (Turns i count by_ l :: rest) as turn => match eval now (Infix "<" (Named i) count) with
    | Some (Of _ z) => if z =? 0 then go f now rest else try (v, now') <- go f now l; match v with
      | Some _ => Some (v, now')
      | None => let now'' := outside l now' in try j <- eval now'' (Infix "+" (Named i) by_); go f (bound i j now'') turn end
    | _ => None end
  | S f, Place a i e :: rest => match eval now i with
    | Some (Of Int k) => try v <- eval now e; try p <- place k; try now' <- placed a p v now; go f now' rest | _ => None end
  | O, _ => None end.

Definition steps := 100%nat.
End Meaning.
