(* The extracted checker as a command. Reading the files is not proved; every decision is Checker's (checker.ml).

   check_cases FILE...   accept or refuse every case of vector files; ends with 1 where one is refused, 2 where a file
                         cannot be read
   check_cases --rows    read lines "position kind seven-hex-floats numbers...", write 1 or 0 for each *)

type json =
  | Null
  | Bool of bool
  | Number of string
  | String of string
  | List of json list
  | Object of (string * json) list

exception Unreadable of string

let unreadable format = Printf.ksprintf (fun text -> raise (Unreadable text)) format

(* A reader of JSON, by recursive descent. Numbers stay text, so that none is rounded here. *)
let json_of text =
  let at = ref 0 in
  let length = String.length text in
  let peek () = if !at < length then text.[!at] else unreadable "the file ends in the middle of a value" in
  let rec skip () = if !at < length && String.contains " \t\r\n" text.[!at] then (incr at; skip ()) in
  let expect c =
    skip ();
    if peek () <> c then unreadable "byte %d: %C is expected, not %C" !at c (peek ());
    incr at in
  let word name value =
    let n = String.length name in
    if !at + n > length || String.sub text !at n <> name then unreadable "byte %d: not a JSON value" !at;
    at := !at + n; value in
  let string () =
    expect '"';
    let out = Buffer.create 16 in
    let rec go () =
      let c = peek () in
      incr at;
      if c = '\\' then begin
        let e = peek () in
        incr at;
        (match e with
         | 'n' -> Buffer.add_char out '\n'
         | 't' -> Buffer.add_char out '\t'
         | 'u' -> Buffer.add_string out "\\u"  (* no name or number that is read here has one *)
         | e -> Buffer.add_char out e);
        go ()
      end
      else if c <> '"' then (Buffer.add_char out c; go ()) in
    go ();
    Buffer.contents out in
  let number () =
    let start = !at in
    while !at < length && String.contains "+-.0123456789eE" text.[!at] do incr at done;
    if !at = start then unreadable "byte %d: not a JSON value" start;
    Number (String.sub text start (!at - start)) in
  let rec value () =
    skip ();
    match peek () with
    | '{' -> Object (members '}' (fun () -> let name = string () in expect ':'; (name, value ())))
    | '[' -> List (members ']' value)
    | '"' -> String (string ())
    | 't' -> word "true" (Bool true)
    | 'f' -> word "false" (Bool false)
    | 'n' -> word "null" Null
    | _ -> number ()
  and members : 'a. char -> (unit -> 'a) -> 'a list = fun close member ->
    incr at;
    skip ();
    if peek () = close then (incr at; [])
    else
      let rec go found =
        skip ();
        let found = member () :: found in
        skip ();
        if peek () = close then (incr at; List.rev found) else (expect ','; go found) in
      go [] in
  let result = value () in
  skip ();
  if !at < length then unreadable "byte %d: something follows the value" !at;
  result

let field name = function
  | Object members -> (try List.assoc name members with Not_found -> unreadable "there is no %S" name)
  | _ -> unreadable "%S is asked of something that is no object" name

let has name = function Object members -> List.mem_assoc name members | _ -> false
let list = function List values -> values | _ -> unreadable "a list is expected"
let text = function String s -> s | _ -> unreadable "a string is expected"

(* A float64 as whole * 2^exponent, from its bits. *)
let exact x : Checker.q =
  let bits = Int64.bits_of_float x in
  let exponent = Int64.to_int (Int64.logand (Int64.shift_right_logical bits 52) 0x7FFL) in
  let fraction = Int64.logand bits 0xFFFFFFFFFFFFFL in
  if exponent = 0x7FF then unreadable "a number is not finite";
  let whole = if exponent = 0 then fraction else Int64.logor fraction 0x10000000000000L in
  let whole = if Int64.compare bits 0L < 0 then Int64.neg whole else whole in
  Checker.dyadic (Z.of_int64 whole) (Z.of_int ((if exponent = 0 then 1 else exponent) - 1075))

let float_of s = match float_of_string_opt s with Some x -> x | None -> unreadable "%S is no number" s

(* "3/4" or "-2" *)
let rational s : Checker.q =
  let numerator, denominator = match String.split_on_char '/' s with
    | [ n ] -> (n, "1") | [ n; d ] -> (n, d) | _ -> unreadable "%S is no rational" s in
  match Z.of_string numerator, Z.of_string denominator with
  | n, d when Z.sign d > 0 -> { Checker.qnum = n; qden = d }
  | _ -> unreadable "%S is no rational" s
  | exception Invalid_argument _ -> unreadable "%S is no rational" s

let row_of = function
  | [ q_alpha; q_gamma; q_b; q_d; q_x; q_y; q_z ] -> { Checker.q_alpha; q_gamma; q_b; q_d; q_x; q_y; q_z }
  | numbers -> unreadable "a row has 7 numbers, not %d" (List.length numbers)

let spot = function [ s; t; w ] -> ((s, t), w) | _ -> unreadable "a point has 3 numbers"

let position = function
  | "1" -> Checker.Exterior | "0" -> Checker.Contact | "-1" -> Checker.Interior
  | p -> unreadable "position %s is none of 1, 0, -1" p

(* The numbers of a case: the hexadecimal ones, and the decimal ones must be the same. *)
let numbers_of_case case =
  let hex = List.map (fun s -> float_of (text s)) (list (field "hex" case)) in
  let decimal = List.map (function Number s -> float_of s | _ -> unreadable "a row has numbers") (list (field "row" case)) in
  if List.map Int64.bits_of_float hex <> List.map Int64.bits_of_float decimal then
    unreadable "row and hex are not the same numbers";
  List.map exact hex

let numbers_of_refusal case =
  List.map (function Number s | String s -> float_of s | _ -> unreadable "a row has numbers") (list (field "row" case))

let proof_of certificate : Checker.certificate =
  if has "multiplier" certificate then Multiplier (rational (text (field "multiplier" certificate)))
  else if has "double_root" certificate then DoubleRoot (rational (text (field "double_root" certificate)))
  else Points (List.map (fun p -> spot (List.map (fun s -> rational (text s)) (list p))) (list (field "points" certificate)))

let number = function Number s -> s | _ -> unreadable "a number is expected"
let truth = function Bool b -> b | _ -> unreadable "true or false is expected"

let accepted case =
  let row = row_of (numbers_of_case case) in
  let claim = position (number (field "position" case)) in
  let tangent = truth (field "tangent" case) in
  Checker.check_vector row claim tangent (proof_of (field "certificate" case))

(* A row that must be refused: a number that is not finite, or a semi-axis that is not positive. *)
let refused case =
  let numbers = numbers_of_refusal case in
  not (List.for_all Float.is_finite numbers && Checker.valid_row (row_of (List.map exact numbers)))

(* ---- Rows with an axis, and ways: what the certificate leaves to be found is found here. None of it is trusted: the checker
   asks that a unit of length be positive, and of a touch that the point be one. *)

(* The least denominator that makes numbers whole: a unit in which the checker computes faster. *)
let unit_of numbers = List.fold_left (fun d { Checker.qden; _ } -> Z.lcm d qden) Z.one numbers

(* A solution of linear equations, rows with the right side last, and vectors that span those of the right side 0. *)
let solutions rows n =
  let rows = Array.map Array.copy rows in
  let pivots = ref [] and at = ref 0 in
  for column = 0 to n - 1 do
    let found = ref (-1) in
    for i = Array.length rows - 1 downto !at do if Q.sign rows.(i).(column) <> 0 then found := i done;
    if !found >= 0 then begin
      let row = rows.(!found) in
      rows.(!found) <- rows.(!at);
      rows.(!at) <- Array.map (fun x -> Q.div x row.(column)) row;
      Array.iteri (fun i other -> if i <> !at then
          rows.(i) <- Array.mapi (fun k x -> Q.sub x (Q.mul other.(column) rows.(!at).(k))) other) rows;
      pivots := (column, !at) :: !pivots;
      incr at
    end
  done;
  let value of_row = Array.init n (fun c -> match List.assoc_opt c !pivots with Some i -> of_row c i | None -> Q.zero) in
  let free = List.filter (fun c -> not (List.mem_assoc c !pivots)) (List.init n Fun.id) in
  let direction f =
    let v = value (fun _ i -> Q.neg rows.(i).(f)) in
    v.(f) <- Q.one; v in
  (value (fun _ i -> rows.(i).(n)), List.map direction free)

let sum f = Q.(List.fold_left (fun s i -> s + f i) zero [ 0; 1; 2 ])

(* Where S + mH is least, as an offset in multiples of b, nearest to the centre if there are many; and a direction of them. *)
let touching sizes axis centre m =
  let alpha, gamma, b, d = match sizes with [ a; g; b; d ] -> (a, g, b, d) | _ -> assert false in
  let square x = Q.mul x x in
  let v2 = sum (fun i -> square axis.(i)) in
  let across = Q.inv (square b) in
  let more = Q.div (Q.sub (Q.inv (square d)) across) v2 in
  let ball i j = Q.add (if i = j then across else Q.zero) (Q.mul more (Q.mul axis.(i) axis.(j))) in
  let level i = if i = 2 then Q.neg (Q.inv (square gamma)) else Q.inv (square alpha) in
  let rows = Array.init 3 (fun i -> Array.init 4 (fun j ->
      if j = 3 then Q.neg (Q.mul m (Q.mul (level i) centre.(i)))
      else Q.mul b (Q.add (ball i j) (if i = j then Q.mul m (level i) else Q.zero)))) in
  let found, ways = solutions rows 3 in
  let product u v = sum (fun i -> sum (fun j -> Q.mul u.(i) (Q.mul (ball i j) v.(j)))) in
  let ways = Array.of_list ways in
  let n = Array.length ways in
  let shares, _ = solutions (Array.init n (fun i -> Array.init (n + 1) (fun j ->
      if j = n then Q.neg (product ways.(i) found) else product ways.(i) ways.(j)))) n in
  let nearest = Array.init 3 (fun i -> Array.fold_left Q.add found.(i) (Array.init n (fun k -> Q.mul shares.(k) ways.(k).(i)))) in
  (nearest, if n = 0 then Array.make 3 Q.zero else ways.(0))

let in_q { Checker.qnum; qden } = Q.make qnum qden
let of_q q = { Checker.qnum = Q.num q; qden = Q.den q }
let spot_of a = ((of_q a.(0), of_q a.(1)), of_q a.(2))
let triple = function [ x; y; z ] -> ((x, y), z) | _ -> unreadable "three numbers are expected"
let vector ((x, y), z) = [| in_q x; in_q y; in_q z |]

(* The parts of a row by its layout: sizes, places, axis. *)
let rec split n l = if n = 0 then ([], l) else match l with
  | [] -> unreadable "a row is too short" | x :: rest -> let a, b = split (n - 1) rest in (x :: a, b)

type place = { sizes : Checker.sizes; all : Checker.q list; spots : Checker.spot list; numbers : Q.t list }

let upright = [ Checker.dyadic Z.zero Z.zero; Checker.dyadic Z.zero Z.zero; Checker.dyadic Z.one Z.zero ]

let placed ~tilted ~way numbers =
  let sizes, rest = split 4 numbers in
  let start, rest = split 3 rest in
  let finish, rest = if way then split 3 rest else (start, rest) in
  let axis, rest = if tilted then split 3 rest else (upright, rest) in
  if rest <> [] then unreadable "a row is too long";
  match sizes with
  | [ s_alpha; s_gamma; s_b; s_d ] -> { sizes = { Checker.s_alpha; s_gamma; s_b; s_d; s_axis = triple axis };
      all = sizes @ start @ finish; spots = [ triple start; triple finish ]; numbers = List.map in_q sizes }
  | _ -> assert false

let witness place centre certificate : Checker.witness =
  let given name = has name certificate && field name certificate <> Null in
  if given "multiplier" then Clear (rational (text (field "multiplier" certificate)))
  else if given "double_root" then begin
    let m = rational (text (field "double_root" certificate)) in
    let at, along = touching place.numbers (vector place.sizes.s_axis) (vector centre) (in_q m) in
    Touch (m, spot_of at, spot_of along)
  end
  else Among (List.map (fun p -> spot (List.map (fun s -> rational (text s)) (list p))) (list (field "points" certificate)))

let axis_unit place = let (x, y), z = place.sizes.s_axis in unit_of [ x; y; z ]

let leaning_accepted case =
  let place = placed ~tilted:true ~way:false (numbers_of_case case) in
  let centre = List.hd place.spots in
  Checker.check_leaning place.sizes centre (unit_of place.all) (axis_unit place) (position (number (field "position" case)))
    (truth (field "tangent" case)) (witness place centre (field "certificate" case))

let at_time (a, b) time = Q.add a (Q.mul time (Q.sub b a))

let way_accepted ~tilted case =
  let place = placed ~tilted ~way:true (numbers_of_case case) in
  let start, finish = match place.spots with [ s; e ] -> (s, e) | _ -> assert false in
  let certificate = field "certificate" case in
  let pieces = List.map (fun piece -> match list piece with
      | [ l; till ] -> (rational (text l), rational (text till)) | _ -> unreadable "a piece has two numbers")
      (list (field "pieces" certificate)) in
  let times = List.map (fun (_, till) -> till) pieces in
  let exact_hex s = exact (float_of (text s)) in
  let claim, times = match field "first" case with
    | Null -> if truth (field "hit" case) then unreadable "a hit has a first contact"; (Checker.NoContact, times)
    | _ when not (truth (field "hit" case)) -> unreadable "a clear way has no first contact"
    | _ -> match List.map exact_hex (list (field "first_hex" case)) with
      | [ lower; upper ] ->
        let time = rational (text (field "time" certificate)) in
        let s = vector start and e = vector finish in
        let centre = spot_of (Array.init 3 (fun i -> at_time (s.(i), e.(i)) (in_q time))) in
        (Checker.FirstBetween (lower, upper, time, witness place centre certificate), time :: times)
      | _ -> unreadable "a first contact has two bounds" in
  let unit = Z.mul (unit_of place.all) (unit_of times) in
  Checker.check_passage place.sizes start finish unit (axis_unit place) pieces claim

(* A row that must be refused: a number that is not finite, a semi-axis that is not positive, an axis that is none. *)
let leaning_refused ~tilted ~way case =
  let numbers = numbers_of_refusal case in
  not (List.for_all Float.is_finite numbers && Checker.valid_sizes (placed ~tilted ~way (List.map exact numbers)).sizes)

let read path =
  let channel = try open_in_bin path with Sys_error reason -> unreadable "%s" reason in
  Fun.protect ~finally:(fun () -> close_in channel) (fun () -> really_input_string channel (in_channel_length channel))

let check_file (cases, wrong) path =
  let file = json_of (read path) in
  let valid = "is a valid row" and unproved = "the certificate does not prove the label" in
  let right, claim = match text (field "content" file) with
    | "positions" -> (accepted, unproved)
    | "tilted-positions" -> (leaning_accepted, unproved)
    | "ways" -> (way_accepted ~tilted:false, unproved)
    | "tilted-ways" -> (way_accepted ~tilted:true, unproved)
    | "refusals" -> (refused, valid)
    | "tilted-refusals" -> (leaning_refused ~tilted:true ~way:false, valid)
    | "way-refusals" -> (leaning_refused ~tilted:false ~way:true, valid)
    | "tilted-way-refusals" -> (leaning_refused ~tilted:true ~way:true, valid)
    | content -> unreadable "the checker reads no content %S" content in
  List.fold_left (fun (cases, wrong) case ->
      let id = text (field "id" case) in
      match right case with
      | true -> (cases + 1, wrong)
      | false -> Printf.printf "%s, case %s: %s\n" path id claim; (cases + 1, wrong + 1)
      | exception Unreadable reason -> unreadable "case %s: %s" id reason)
    (cases, wrong) (list (field "cases" file))

let check_files paths =
  let cases, wrong = List.fold_left (fun sum path ->
      try check_file sum path with Unreadable reason -> unreadable "%s: %s" path reason) (0, 0) paths in
  Printf.printf "%d cases checked by the proved checker, %s with a wrong label\n" cases
    (if wrong = 0 then "none" else string_of_int wrong);
  exit (if wrong = 0 then 0 else 1)

let rec spots = function
  | [] -> [] | u :: v :: w :: rest -> spot [ u; v; w ] :: spots rest | _ -> unreadable "a point has 3 numbers"

let check_line line = match String.split_on_char ' ' line with
  | claim :: kind :: a :: g :: b :: d :: x :: y :: z :: numbers ->
    let row = row_of (List.map (fun s -> exact (float_of s)) [ a; g; b; d; x; y; z ]) in
    let numbers = List.map rational (List.filter (( <> ) "") numbers) in
    let proof : Checker.certificate = match kind, numbers with
      | "multiplier", [ l ] -> Multiplier l | "double_root", [ m ] -> DoubleRoot m
      | "points", numbers -> Points (spots numbers) | _ -> unreadable "%S is no certificate" kind in
    Checker.check row (position claim) proof
  | _ -> unreadable "a line has a position, a kind, 7 numbers and those of the certificate"

let check_rows () =
  try while true do print_string (if check_line (input_line stdin) then "1\n" else "0\n") done
  with End_of_file -> ()

let () =
  try match List.tl (Array.to_list Sys.argv) with
    | [ "--rows" ] -> check_rows ()
    | [] -> unreadable "name the vector files to check"
    | paths -> check_files paths
  with Unreadable reason -> flush stdout; prerr_endline ("check_cases: " ^ reason); exit 2
