(** Functions of the header that compute with words: Coq reads their text and runs it by the rules of C for integers.

    The part of C that they are written in: declarations, assignments, loops a fixed number of times, and expressions without side
    effects. A value is undefined, None, where C says that it is: a variable that nothing was put into, a shift by as many bits as the
    type has, an int that leaves its range. *)

Require Import List String Ascii ZArith Bool.
From Hypcheck Require Import Steps Fixed Long.
Import ListNotations.
Open Scope string_scope.
Open Scope Z_scope.

Notation "'try' p <- o ; k" := (match o with Some p => k | None => None end) (at level 200, p pattern, right associativity).

(** ** The text. *)

Inductive type := Int | U32 | U64 | Wide.
(** A plain number, or a struct of so many words. *)
Inductive kind := Plain (t : type) | Struct (words : nat).

Inductive expression := Named (n : string) | Constant (t : type) (z : Z) | Infix (o : string) (l r : expression)
  | Choice (c a b : expression) | Called (f : string) (given : list expression) | Part (e i : expression) | As (t : type) (e : expression)
  | Braces (l : list expression).
Inductive statement := Declare (k : kind) (n : string) (value : option expression) | Put (target : expression) (o : string) (e : expression)
  | Return (e : expression).
Record function := Function { returns : kind; parameters : list (kind * string); body : list statement }.

(** A limb, in LongIntegers.v of any width, takes the place of U32, the type of masks here. *)
Definition type_of w := look w [("int", Int); ("uint64_t", U64); ("hc_wide", Wide); ("hc_limb", U32)].
Definition kind_of w := match type_of w with Some t => Some (Plain t) | None => look w [("hc_fixed", Struct 2); ("hc_long", Struct 4)] end.
Definition precedence o := look o [("*", 10%nat); ("/", 10); ("+", 9); ("-", 9); ("<<", 8); (">>", 8); ("<", 7); (">", 7); ("<=", 7); (">=", 7);
  ("==", 6); ("!=", 6); ("&", 5); ("^", 4); ("|", 3); ("&&", 2); ("||", 1)]%nat.
Definition unary := 11%nat.

Fixpoint hexadecimal (s : string) (known : Z) : option Z := match s with
  | EmptyString | "u" => Some known
  | String c rest => let n := nat_of_ascii c in
    if Nat.leb 48 n && Nat.leb n 57 then hexadecimal rest (16 * known + Z.of_nat n - 48)
    else if Nat.leb 97 n && Nat.leb n 102 then hexadecimal rest (16 * known + Z.of_nat n - 87) else None end.

(** "left.high" is a part of left; another field is a name with a dot. *)
Fixpoint named (s before : string) : option expression := match s with
  | EmptyString => Some (Named before)
  | String "." rest => match look rest [("low", Part (Named before) (Constant Int 0)); ("high", Part (Named before) (Constant Int 1)); ("words", Named before)] with
    | Some e => Some e | None => named rest (before ++ ".") end
  | String c rest => named rest (before ++ String c "") end.

Definition atom (w : string) : option expression := match w with
  | String "0" (String "x" rest) => try z <- hexadecimal rest 0; Some (Constant U32 z)
  | _ => try a <- argument_of w; match a with Number z => Some (Constant Int z) | Name n => named n "" end end.

(** Words that begin with a shape: what stands at "", and the rest. *)
Fixpoint behind (shape ws : list string) : option (list string * list string) := match shape, ws with
  | [], _ => Some ([], ws)
  | s :: shape', w :: ws' => try (l, rest) <- behind shape' ws';
    if String.eqb s "" then Some (w :: l, rest) else if String.eqb s w then Some (l, rest) else None
  | _, [] => None end.
Definition is s w := String.eqb s w.

Fixpoint expression_of (fuel least : nat) (ws : list string) : option (expression * list string) := match fuel, ws with
  | S f, w :: rest =>
    let part (e : expression) (ws : list string) := match ws with
      | w :: rest => if is ".low" w then Some (Part e (Constant Int 0), rest) else if is ".high" w then Some (Part e (Constant Int 1), rest)
        else if is "[" w then try (i, more) <- expression_of f 0 rest; try (_, more') <- behind ["]"] more; Some (Part e i, more')
        else Some (e, ws)
      | [] => Some (e, []) end in
    try (e, ws') <- (
      if is "{" w then try (l, more) <- listed_to f "}" rest; Some (Braces l, more)
      else if is "-" w then try (e, more) <- expression_of f unary rest; Some (Infix "-" (Constant Int 0) e, more)
      else if is "!" w then try (e, more) <- expression_of f unary rest; Some (Infix "==" e (Constant Int 0), more)
      else if is "(" w then
        match (match behind [""; ")"] rest with Some ([t], more) => try k <- type_of t; Some (k, more) | _ => None end) with
        | Some (t, more) => try (e, more') <- expression_of f unary more; Some (As t e, more')
        | None => try (e, more) <- expression_of f 0 rest; try (_, more') <- behind [")"] more; part e more' end
      else match behind ["("] rest with
        | Some (_, more) => try (l, more') <- listed_to f ")" more; part (Called w l) more'
        | None => try e <- atom w; part e rest end);
    further f least e ws'
  | _, _ => None end
with further (fuel least : nat) (l : expression) (ws : list string) : option (expression * list string) := match fuel, ws with
  | S f, o :: rest =>
    if is "?" o then if Nat.eqb least 0 then
        try (a, more) <- expression_of f 0 rest; try (_, more') <- behind [":"] more; try (b, last) <- expression_of f 0 more'; Some (Choice l a b, last)
      else Some (l, ws)
    else match precedence o with
      | Some p => if Nat.leb least p then try (r, more) <- expression_of f (S p) rest; further f least (Infix o l r) more else Some (l, ws)
      | None => Some (l, ws) end
  | S _, [] => Some (l, [])
  | O, _ => None end
with listed_to (fuel : nat) (closing : string) (ws : list string) : option (list expression * list string) := match fuel with O => None | S f =>
  try (e, more) <- expression_of f 0 ws; match more with
  | w :: rest => if is "," w then try (l, last) <- listed_to f closing rest; Some (e :: l, last) else if is closing w then Some ([e], rest) else None
  | [] => None end end.

Definition enough := 100%nat.
Definition expression_to closing ws := try (e, more) <- expression_of enough 0 ws; try (_, rest) <- behind [closing] more; Some (e, rest).

(** What stands behind a type: names, with values or without. *)
Fixpoint declared_by (fuel : nat) (k : kind) (ws : list string) : option (list statement * list string) := match fuel, ws with
  | S f, n :: rest =>
    try (e, more) <- match behind ["="] rest with
      | Some (_, value) => try (e, more) <- expression_of enough 0 value; Some (Some e, more) | None => Some (None, rest) end;
    match behind [";"] more, behind [","] more with
    | Some (_, last), _ => Some ([Declare k n e], last)
    | _, Some (_, others) => try (l, last) <- declared_by f k others; Some (Declare k n e :: l, last)
    | _, _ => None end
  | _, _ => None end.

(** The statements up to a closing brace; a loop is written out. *)
Definition loop := ["for"; "("; ""; "="; "0"; ";"; ""; "<"; ""; ";"; ""; "++"; ")"; "{"].
Fixpoint block (fuel : nat) (ws : list string) : option (list statement * list string) := match fuel, ws with
  | S f, w :: rest =>
    let declared k names := try (l, more) <- declared_by f k names; try (after, last) <- block f more; Some (l ++ after, last)%list in
    if is "}" w then Some ([], rest)
    else if is "return" w then try (e, more) <- expression_to ";" rest; try (l, last) <- block f more; Some (Return e :: l, last)
    else if is "const" w then match rest with t :: names => try k <- kind_of t; declared k names | [] => None end
    else match kind_of w, behind loop ws with
    | Some k, _ => declared k rest
    | _, Some ([i; i'; count; i''], inner) =>
      try z <- whole count 0; try (l, more) <- block f inner; try (after, last) <- block f more;
      if is i i' && is i i'' then
        Some (flat_map (fun k => Put (Named i) "=" (Constant Int (Z.of_nat k)) :: l) (seq 0 (Z.to_nat z)) ++ after, last)%list else None
    | _, _ => try (target, more) <- expression_of enough unary ws; match more with
      | o :: value => try operation <- look o [("=", "="); ("+=", "+"); ("-=", "-")]; try (e, more') <- expression_to ";" value;
        try (after, last) <- block f more'; Some (Put target operation e :: after, last)
      | [] => None end end
  | _, _ => None end.

Fixpoint parameters_of (fuel : nat) (ws : list string) : option (list (kind * string) * list string) := match fuel, ws with
  | S f, t :: n :: rest => try k <- kind_of t; match behind [")"; "{"] rest, behind [","] rest with
    | Some (_, last), _ => Some ([(k, n)], last)
    | _, Some (_, others) => try (l, last) <- parameters_of f others; Some ((k, n) :: l, last)
    | _, _ => None end
  | _, _ => None end.

Fixpoint without_storage (ws : list string) := match ws with
  | w :: rest => if is_in w ["static"; "inline"] then without_storage rest else ws | [] => [] end.

(** Text for limbs of 64 bits, or for others; and for compilers that have __builtin_clzll. *)
Definition builtins := ["#"; "if"; "defined"; "("; "__GNUC__"; ")"; "||"; "defined"; "("; "__clang__"; ")"].
Fixpoint lines_for (fuel : nat) (limbs keeps : bool) (ws : list string) : list string := match fuel, ws with
  | S f, w :: rest => match behind ["#"; "if"; "HC_LIMB_BITS"; "=="; "64"] ws, behind ["#"; "else"] ws, behind ["#"; "endif"] ws, behind builtins ws with
    | Some (_, more), _, _, _ => lines_for f limbs limbs more
    | _, Some (_, more), _, _ => lines_for f limbs (negb keeps) more
    | _, _, Some (_, more), _ | _, _, _, Some (_, more) => lines_for f limbs true more
    | _, _, _, _ => if keeps then w :: lines_for f limbs keeps rest else lines_for f limbs keeps rest end
  | _, _ => [] end.

(** The name, and what is read. *)
Definition function_of (limbs : bool) (text : string) : option (string * function) :=
  let ws := words text in match without_storage (lines_for (List.length ws) limbs true ws) with
  | t :: n :: rest => try k <- kind_of t; try (_, rest') <- behind ["("] rest; try (p, inner) <- parameters_of enough rest';
    try (l, last) <- block enough inner; match last with [] => Some (n, Function k p l) | _ => None end
  | _ => None end.

(** ** Its meaning. *)

Inductive value := Val (t : type) (z : Z) | Record (l : list Z).
Inductive cell := Plainly (t : type) (z : option Z) | Fields (l : list (option Z)).

Definition width t := match t with Int | U32 => 32 | U64 => 64 | Wide => 128 end.
Definition rank t := match t with Int => 0%nat | U32 => 1 | U64 => 2 | Wide => 3 end%nat.
Definition wider t u := if Nat.leb (rank t) (rank u) then u else t.

(** A result, or a number put into a type: modulo 2^width, but for ints. *)
Definition in_int z := (- 2 ^ 31 <=? z) && (z <? 2 ^ 31).
Definition made_of t z : option Z := match t with
  | Int => if in_int z then Some z else None
  | U32 => Some (z mod 2 ^ 32) | U64 => Some (z mod W) | Wide => Some (z mod bits128) end.
(** A number >= 0 that is put into a wider type is the same. *)
Definition converted t u z : option Z := match t with
  | Int => match u with Int => Some z | _ => made_of u z end
  | _ => if Nat.leb (rank t) (rank u) then Some z else made_of u z end.
Definition counted {A} t k (z : option A) := if (0 <=? k) && (k <? width t) then z else None.
Definition unless_zero {A} k (z : option A) := if k =? 0 then None else z.

Definition same a b := if a =? b then 1 else 0.
Definition chosen c (a b : Z) := if c =? 0 then b else a.

Definition infix_of o t x u y : option value := let v := wider t u in
  if is_in o ["<<"; ">>"] then try y' <- converted u u y;
    try z <- counted t y' (if String.eqb o "<<" then made_of t (x * 2 ^ y') else Some (x / 2 ^ y')); Some (Val t z)
  else if is_in o ["&&"; "||"] then Some (Val Int (if String.eqb o "&&" then chosen x (chosen y 1 0) 0 else chosen x 1 (chosen y 1 0)))
  else try a <- converted t v x; try b <- converted u v y;
    match look o [("+", a + b); ("-", a - b); ("*", a * b)], look o [("&", Z.land a b); ("|", Z.lor a b); ("^", Z.lxor a b)],
      look o [("<", carry a b); (">", carry b a); ("<=", 1 - carry b a); (">=", 1 - carry a b); ("==", same a b); ("!=", 1 - same a b)] with
    | Some z, _, _ => try k <- made_of v z; Some (Val v k)
    | _, Some z, _ => Some (Val v z)
    | _, _, Some z => Some (Val Int z)
    | _, _, _ => None end.

(** What a function that is called computes. *)
Inductive model := OfWords (f : Z -> Z -> number) | OfNumbers (f : number -> number -> number) | OfNumber (f : number -> Z)
  | OfProducts (f : number -> number -> long) | OfLongs (f : long -> long -> bool -> long)
  | OfBits (f : Z -> Z) (* of a word that is not 0 *) | OfShift (f : number -> Z -> number) (* by 0 .. 127 *).
Definition kind_of_answer m := match m with
  | OfNumber _ => Plain U64 | OfBits _ => Plain Int | OfProducts _ | OfLongs _ => Struct 4 | OfWords _ | OfNumbers _ | OfShift _ => Struct 2 end.

Definition record n := Record [low_word n; high_word n].
Definition long_record n := Record [w0 n; w1 n; w2 n; w3 n].
Definition answer (m : model) (given : list value) : option value := match m, given with
  | OfWords f, [Val U64 a; Val U64 b] => Some (record (f a b))
  | OfNumbers f, [Record [a; b]; Record [c; d]] => Some (record (f (Words a b) (Words c d)))
  | OfNumber f, [Record [a; b]] => Some (Val U64 (f (Words a b)))
  | OfProducts f, [Record [a; b]; Record [c; d]] => Some (long_record (f (Words a b) (Words c d)))
  | OfLongs f, [Record [a; b; c; d]; Record [e; g; h; i]; Val Int k] => match k with
    | 0 => Some (long_record (f (Long a b c d) (Long e g h i) false)) | 1 => Some (long_record (f (Long a b c d) (Long e g h i) true))
    | _ => None end
  | OfBits f, [Val U64 a] => unless_zero a (Some (Val Int (f a)))
  | OfShift f, [Record [a; b]; Val Int k] => counted Wide k (Some (record (f (Words a b) k)))
  | _, _ => None end.

(** What a choice has for its kind, whichever it is; the other one may be undefined. *)
Definition common j k := match j, k with
  | Some (Plain t), Some (Plain u) => Some (Plain (wider t u))
  | Some (Struct m), Some (Struct n) => if Nat.eqb m n then j else None
  | _, _ => None end.
Definition of_kind k v := match k, v with
  | Plain t, Some (Val u z) => try x <- converted u t z; Some (Val t x) | Struct _, Some (Record _) => v | _, _ => None end.
Definition either z v w := match v, w with
  | Some (Val t x), Some (Val _ y) => Some (Val t (chosen z x y))
  | Some (Record l), Some (Record m) => Some (Record (map (fun p => chosen z (fst p) (snd p)) (combine l m)))
  | _, _ => if z =? 0 then w else v end.

Section Meaning.
Variable known : list (string * model).

Definition cells := list (string * cell).

Fixpoint kind_in (now : cells) (e : expression) : option kind := match e with
  | Named n => try c <- look n now; match c with Plainly t _ => Some (Plain t) | Fields l => Some (Struct (List.length l)) end
  | Constant t _ | As t _ => Some (Plain t)
  | Infix o l r => if is_in o ["<<"; ">>"] then kind_in now l
    else if is_in o ["+"; "-"; "*"; "&"; "|"; "^"] then common (kind_in now l) (kind_in now r) else Some (Plain Int)
  | Choice _ a b => common (kind_in now a) (kind_in now b)
  | Called f _ => try m <- look f known; Some (kind_of_answer m)
  | Part _ _ => Some (Plain U64)
  | Braces _ => None end.

Fixpoint value_of (now : cells) (e : expression) : option value := match e with
  | Named n => try c <- look n now; match c with
    | Plainly t z => try k <- z; Some (Val t k) | Fields l => try k <- every l; Some (Record k) end
  | Constant t z => Some (Val t z)
  | Infix o l r => try a <- value_of now l; try b <- value_of now r; match a, b with Val t x, Val u y => infix_of o t x u y | _, _ => None end
  | Choice c a b => match value_of now c, common (kind_in now a) (kind_in now b) with
    | Some (Val _ z), Some k => either z (of_kind k (value_of now a)) (of_kind k (value_of now b)) | _, _ => None end
  | Called f given => try m <- look f known; try l <- every (map (value_of now) given); answer m l
  | Part e i => match value_of now i with Some (Val Int k) => match e with
    | Named n => match look n now with Some (Fields l) => try z <- nth_error l (Z.to_nat k); try x <- z; Some (Val U64 x) | _ => None end
    | _ => match value_of now e with Some (Record l) => try x <- nth_error l (Z.to_nat k); Some (Val U64 x) | _ => None end end | _ => None end
  | As t e => match value_of now e with Some (Val u z) => try x <- converted u t z; Some (Val t x) | _ => None end
  | Braces l => try k <- every (map (value_of now) l); match k with
    | [Record r] => Some (Record r)
    | _ => try r <- every (map (fun v => match v with Val t z => converted t U64 z | Record _ => None end) k); Some (Record r) end end.

Fixpoint with_cell n c (now : cells) : option cells := match now with
  | [] => None
  | (m, old) :: rest => if String.eqb m n then Some ((m, c) :: rest) else try l <- with_cell n c rest; Some ((m, old) :: l) end.
Fixpoint with_field {A} i (a : A) (l : list A) : option (list A) := match l, i with
  | [], _ => None | _ :: rest, O => Some (a :: rest) | b :: rest, S k => try r <- with_field k a rest; Some (b :: r) end.

(** A value as a kind of variable holds it. *)
Definition kept (k : kind) (v : value) : option cell := match k, v with
  | Plain t, Val u z => try x <- converted u t z; Some (Plainly t (Some x))
  | Struct n, Record l => if Nat.eqb (List.length l) n then Some (Fields (map Some l)) else None
  | _, _ => None end.

Definition put (now : cells) target o e : option cells :=
  try v <- (if String.eqb o "=" then value_of now e else value_of now (Infix o target e));
  match target with
  | Named n => match look n now with
    | Some (Plainly t _) => try c <- kept (Plain t) v; with_cell n c now
    | Some (Fields l) => try c <- kept (Struct (List.length l)) v; with_cell n c now | None => None end
  | Part (Named n) i => match look n now, value_of now i, v with
    | Some (Fields l), Some (Val Int k), Val u z => try x <- converted u U64 z; try l' <- with_field (Z.to_nat k) (Some x) l; with_cell n (Fields l') now
    | _, _, _ => None end
  | _ => None end.

Fixpoint run (now : cells) (l : list statement) : option value := match l with
  | [] => None
  | Return e :: _ => value_of now e
  | Declare k n None :: rest => run ((n, match k with Plain t => Plainly t None | Struct s => Fields (repeat None s) end) :: now) rest
  | Declare k n (Some e) :: rest => try v <- value_of now e; try c <- kept k v; run ((n, c) :: now) rest
  | Put target o e :: rest => try now' <- put now target o e; run now' rest end.

(** What a function returns for arguments of the types that it declares. *)
Definition result (f : function) (given : list value) : option value :=
  try l <- every (map (fun p => try c <- kept (fst (fst p)) (snd p); Some (snd (fst p), c)) (combine (parameters f) given));
  try v <- run l (body f);
  match returns f, v with
  | Plain t, Val u z => try x <- converted u t z; Some (Val t x)
  | Struct n, Record r => if Nat.eqb (List.length r) n then Some v else None
  | _, _ => None end.
End Meaning.
