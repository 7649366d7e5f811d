(** Programs as text: Coq reads the listing of a program, and the C that is printed from it, into the same list of steps.

    A step is a name, an operation and its arguments. The listing has one step a line, closed by a semicolon here:
    "h1 = c2_squared - three_c1;". The C has the same as "const double h1 = c2_squared - three_c1;", or with a call for the
    operation, "const HC_TRUTH far = HC_GT(a, b);", or as a number and a call that fills it: "HC_INTEGER(p, 42);
    hc_multiply(&p, &alpha, &alpha);". Nothing nests, so that reading needs no grammar but words. *)

Require Import List String Ascii ZArith Bool.
Import ListNotations.
Open Scope string_scope.

(** Long texts as bytes, which Coq reads several times as fast as strings. *)
Inductive text := Text (bytes : list Byte.byte).
Definition text_of (bytes : list Byte.byte) := Text bytes.
Definition bytes_of (t : text) := let 'Text bytes := t in bytes.
Definition string_of (t : text) := string_of_list_byte (bytes_of t).
Declare Scope text_scope.
Delimit Scope text_scope with text.
String Notation text text_of bytes_of : text_scope.

Inductive argument := Name (n : string) | Number (z : Z).
Record step := Step { name : string; operation : string; arguments : list argument }.

(** ** Words. *)

Definition is_letter (c : ascii) := match c with
  | "0" | "1" | "2" | "3" | "4" | "5" | "6" | "7" | "8" | "9"
  | "A" | "B" | "C" | "D" | "E" | "F" | "G" | "H" | "I" | "J" | "K" | "L" | "M" | "N" | "O" | "P" | "Q" | "R" | "S" | "T" | "U" | "V" | "W" | "X" | "Y" | "Z"
  | "a" | "b" | "c" | "d" | "e" | "f" | "g" | "h" | "i" | "j" | "k" | "l" | "m" | "n" | "o" | "p" | "q" | "r" | "s" | "t" | "u" | "v" | "w" | "x" | "y" | "z"
  | "_" | "." => true
  | _ => false end%char.
Definition is_space (c : ascii) := match c with " " | "010" | "009" => true | _ => false end%char.

Definition close (word : string) (rest : list string) := match word with EmptyString => rest | _ => word :: rest end.

(** Two signs that are one operator of C. *)
Definition joined := ["<<"; ">>"; "->"; "<="; ">="; "=="; "!="; "&&"; "||"; "++"; "+="; "-="].
Definition is_in (s : string) := existsb (String.eqb s).

Fixpoint words_from (text word : string) : list string := match text with
  | EmptyString => close word []
  | String c rest =>
    if is_letter c then words_from rest (word ++ String c "")
    else if is_space c then close word (words_from rest "")
    else close word (match rest with
      | String e rest' => let two := String c (String e "") in
        if is_in two joined then two :: words_from rest' "" else String c "" :: words_from rest ""
      | EmptyString => [String c ""] end) end.

(** Remarks of C, which hold no word. *)
Fixpoint uncommented (text : string) (inside : bool) : string := match text with
  | String "/" (String "*" rest) => if inside then uncommented rest true else uncommented rest true
  | String "*" (String "/" rest) => if inside then String " " (uncommented rest false) else String "*" (String "/" (uncommented rest false))
  | String c rest => if inside then uncommented rest true else String c (uncommented rest false)
  | EmptyString => EmptyString end.

Definition words text := words_from (uncommented text false) "".

(** The statements: what lies between a semicolon or a brace and the next semicolon. Words behind the last semicolon are one more. *)
Fixpoint statements_from (ws : list string) (now : list string) : list (list string) := match ws with
  | [] => match now with [] => [] | _ => [rev now] end
  | ";" :: rest => rev now :: statements_from rest []
  | "{" :: rest | "}" :: rest => statements_from rest []
  | w :: rest => statements_from rest (w :: now) end.

Definition statements text := statements_from (words text) [].

(** ** Arguments. *)

Definition digit (c : ascii) : option Z := let n := nat_of_ascii c in
  if Nat.leb 48 n && Nat.leb n 57 then Some (Z.of_nat n - 48)%Z else None.

(** A whole number, "3" or "3.0". *)
Fixpoint whole (s : string) (known : Z) : option Z := match s with
  | EmptyString => Some known
  | ".0" => Some known
  | String c rest => match digit c with Some k => whole rest (10 * known + k)%Z | None => None end end.

Definition argument_of (w : string) : option argument := match w with
  | EmptyString => None
  | String c _ => match digit c with
    | Some _ => match whole w 0 with Some z => Some (Number z) | None => None end
    | None => if is_letter c then Some (Name w) else None end end.

Fixpoint every {A} (l : list (option A)) : option (list A) := match l with
  | [] => Some []
  | Some a :: rest => match every rest with Some k => Some (a :: k) | None => None end
  | None :: _ => None end.

(** The arguments of a call behind its bracket, to the closing one. *)
Fixpoint call_arguments (ws : list string) : list (option argument) := match ws with
  | [w; ")"] => [argument_of w]
  | w :: "," :: rest => argument_of w :: call_arguments rest
  | _ => [None] end.

(** What a vector of one number, an address or a sign of a sum is written with: HC_SET(3.0), &delta, -1. *)
Fixpoint plain (ws : list string) : list string := match ws with
  | "HC_SET" :: "(" :: w :: ")" :: rest => w :: plain rest
  | "(" :: "&" :: rest => "(" :: plain rest
  | "," :: "&" :: rest => "," :: plain rest
  | "," :: "-" :: "1" :: rest => "," :: "minus" :: plain rest
  | w :: rest => w :: plain rest
  | [] => [] end.

(** ** Values. *)

Definition infix := [("+", "add"); ("-", "sub"); ("*", "mul"); ("/", "div"); (">", "gt"); ("<", "lt"); (">=", "ge");
  ("<=", "le"); ("==", "eq"); ("!=", "ne"); ("and", "and"); ("or", "or"); ("&", "and"); ("|", "or")].
Definition prefix := [("-", "neg"); ("abs", "abs"); ("sqrt", "sqrt"); ("not", "not")].
Definition calls := [("HC_GT", "gt"); ("HC_LT", "lt"); ("HC_GE", "ge"); ("HC_LE", "le"); ("HC_AND", "and"); ("HC_OR", "or");
  ("HC_ABS", "abs"); ("hc_size", "abs"); ("hc_fixed_plus", "add"); ("hc_fixed_minus", "sub"); ("hc_fixed_times", "mul");
  ("hc_fixed_square", "mul"); ("hc_fixed_product", "mul"); ("hc_fixed_signed_product", "mul"); ("hc_fixed_both_signed_product", "mul");
  ("hc_fixed_product by_t", "mul by_t"); ("hc_fixed_product by_q", "mul by_q"); ("hc_product", "mul");
  ("hc_multiple", "mul"); ("hc_fixed_full", "mul"); ("hc_fixed_full_signed", "mul"); ("hc_long_product", "mul"); ("hc_long_signed_product", "mul");
  ("hc_long_plus", "add"); ("hc_long_minus", "sub"); ("HC_SELECT", "select"); ("hc_add", "add"); ("hc_subtract", "sub"); ("hc_multiply", "mul"); ("hc_scale", "mul")].

Fixpoint look {A} (key : string) (table : list (string * A)) : option A := match table with
  | [] => None | (k, v) :: rest => if String.eqb k key then Some v else look key rest end.
Lemma look_in {A} n (l : list (string * A)) a : look n l = Some a -> In (n, a) l.
Proof.
  induction l as [| [m c] l IH]; cbn; [discriminate |]; destruct (String.eqb_spec m n) as [<- |]; [intros E; injection E as <-; auto | auto].
Qed.

Definition made (n : string) (operation : option string) (given : option (list argument)) : option step :=
  match operation, given with Some o, Some l => Some (Step n o l) | _, _ => None end.

(** Values of more than a call or an operator: how they are written, and the operation. "" in the place of a word is an argument,
    and "_" any word. *)
Definition shapes := [
  ([""; "?"; ""; ":"; ""], "select");
  (["hc_product"; "("; "_"; ","; ""; ","; ""; ")"], "hc_product");
  (["hc_multiple"; "("; "_"; ","; ""; ","; ""; ")"], "hc_multiple");
  (["hc_sum"; "("; "_"; ","; ""; ","; ""; ","; "1"; ")"], "add");
  (["hc_sum"; "("; "_"; ","; ""; ","; ""; ","; "minus"; ")"], "sub");
  (["hc_long_sum"; "("; ""; ","; ""; ","; "0"; ")"], "hc_long_plus");
  (["hc_long_sum"; "("; ""; ","; ""; ","; "1"; ")"], "hc_long_minus");
  (["hc_fixed_down"; "("; "hc_fixed_product"; "("; ""; ","; ""; ")"; ","; "terms"; "->"; "by_t"; ")"], "hc_fixed_product by_t");
  (["hc_fixed_down"; "("; "hc_fixed_product"; "("; ""; ","; ""; ")"; ","; "terms"; "->"; "by_q"; ")"], "hc_fixed_product by_q")].

(** The arguments of words that are written so. *)
Fixpoint written (shape ws : list string) : option (list string) := match shape, ws with
  | [], [] => Some []
  | s :: shape', w :: ws' => match written shape' ws' with
    | Some l => if String.eqb s "" then Some (w :: l) else if String.eqb s "_" || String.eqb s w then Some l else None
    | None => None end
  | _, _ => None end.
Fixpoint shaped (table : list (list string * string)) (ws : list string) : option (string * list string) := match table with
  | [] => None
  | (shape, o) :: rest => match written shape ws with Some l => Some (o, l) | None => shaped rest ws end end.

Definition valued (n : string) (value : list string) : option step := match shaped shapes value, value with
  | Some (o, l), _ => made n (Some o) (every (map argument_of l))
  | None, [l; o; r] => made n (look o infix) (every [argument_of l; argument_of r])
  | None, [o; l] => made n (look o prefix) (every [argument_of l])
  | None, f :: bracket :: rest =>
    if String.eqb bracket "(" && is_in f (map fst calls) then made n (Some f) (every (call_arguments rest)) else None
  | None, _ => None end.

(** A statement of a listing. *)
Definition listed (s : list string) : option step := match s with n :: "=" :: value => valued n value | _ => None end.

(** A statement of C that declares a constant. *)
Definition declared (s : list string) : option step := match s with
  | "const" :: _ :: n :: "=" :: value => valued n (plain value) | _ => None end.

(** Two statements of C: a number with room for its bits, and the call that fills it. Others are no steps. *)
Fixpoint filled (l : list (list string)) : list (option step) := match l with
  | [] => []
  | ["HC_INTEGER"; "("; n; ","; bits; ")"] :: ((f :: "(" :: "&" :: m :: "," :: rest) :: more) as later =>
    if String.eqb n m then made n (if is_in f (map fst calls) then Some f else None) (every (call_arguments (tl (plain ("," :: rest))))) :: filled more else filled later
  | _ :: more => filled more end.

Definition listing text := every (map listed (statements text)).
Definition declarations text := every (map declared (statements text)).
Definition fillings text := every (filled (statements text)).

(** The room of each number of the exact integers. *)
Fixpoint rooms (l : list (list string)) : list (option (string * Z)) := match l with
  | [] => []
  | ["HC_INTEGER"; "("; n; ","; bits; ")"] :: more =>
    match whole bits 0 with Some z => Some (n, z) | None => None end :: rooms more
  | _ :: more => rooms more end.

(** ** The comparison. A product may have its factors in either order. *)

Definition same_argument a c := match a, c with
  | Name n, Name m => String.eqb n m | Number y, Number z => Z.eqb y z | _, _ => false end.

Fixpoint same_list {A} (same : A -> A -> bool) (l k : list A) := match l, k with
  | [], [] => true | a :: l', c :: k' => same a c && same_list same l' k' | _, _ => false end.

(** Factors that must be a number are no names, and the other way round. *)
Definition fits_call (s : step) := match look (operation s) [("hc_scale", true); ("hc_multiple", true); ("hc_fixed_times", true);
    ("hc_fixed_full", false); ("hc_fixed_full_signed", false); ("hc_long_product", false); ("hc_long_signed_product", false);
    ("hc_multiply", false); ("hc_product", false); ("hc_fixed_product", false); ("hc_fixed_signed_product", false);
    ("hc_fixed_both_signed_product", false); ("hc_fixed_square", false)], arguments s with
  | Some true, Number _ :: _ | Some false, Name _ :: _ | None, _ => true | _, _ => false end.

(** What a step of C means as a step of a program; a square is the product of a number with itself. *)
Definition meaning (s : step) := match String.eqb (operation s) "hc_fixed_square", arguments s with
  | true, [a] => Step (name s) "mul" [a; a]
  | true, _ => Step (name s) "no square" []
  | false, _ => Step (name s) (match look (operation s) calls with Some o => o | None => operation s end) (arguments s) end.

Definition same_step c a := let m := meaning c in fits_call c
  && String.eqb (name m) (name a) && String.eqb (operation m) (operation a)
  && (same_list same_argument (arguments m) (arguments a)
      || (String.eqb (operation m) "mul" && same_list same_argument (rev (arguments m)) (arguments a))).

(** The steps of a program that lead to the wanted names, in its order. *)
Definition reads (s : step) := flat_map (fun a => match a with Name n => [n] | _ => [] end) (arguments s).
Fixpoint alive (backwards : list step) (wanted : list string) : list step := match backwards with
  | [] => []
  | s :: rest => if is_in (name s) wanted then s :: alive rest (reads s ++ wanted) else alive rest wanted end.
Definition needed (wanted : list string) (program : list step) := rev (alive (rev program) wanted).

Definition agrees (read : option (list step)) (program : list step) := match read with
  | Some steps => same_list same_step steps program | None => false end.

Definition steps_of text := match listing text with Some l => l | None => [] end.
