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

open Witnesses

exception Unreadable of string

(* A contact beside an end that rests on the exact rule in the height alone, and of which no point is found. *)
exception Without_certificate

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

(* ---- Rows with an axis, and sweeps. *)

let triple = function [ x; y; z ] -> ((x, y), z) | _ -> unreadable "three numbers are expected"

(* The parts of a row by its layout: sizes, places, axis. *)
let rec split n l = if n = 0 then ([], l) else match l with
  | [] -> unreadable "a row is too short" | x :: rest -> let a, b = split (n - 1) rest in (x :: a, b)

type place = { sizes : Checker.sizes; all : Checker.q list; spots : Checker.spot list; numbers : Q.t list }

let zero = Checker.dyadic Z.zero Z.zero
let upright = [ zero; zero; Checker.dyadic Z.one Z.zero ]

let placed ~tilted ~sweep numbers =
  let sizes, rest = split 4 numbers in
  let start, rest = split 3 rest in
  let finish, rest = if sweep then split 3 rest else (start, rest) in
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

let tilted_accepted case =
  let place = placed ~tilted:true ~sweep:false (numbers_of_case case) in
  let centre = List.hd place.spots in
  Checker.check_tilted place.sizes centre (unit_of place.all) (axis_unit place) (position (number (field "position" case)))
    (truth (field "tangent" case)) (witness place centre (field "certificate" case))

let at_time (a, b) time = Q.add a (Q.mul time (Q.sub b a))

let sweep_accepted ~tilted case =
  let place = placed ~tilted ~sweep:true (numbers_of_case case) in
  let start, finish = match place.spots with [ s; e ] -> (s, e) | _ -> assert false in
  let certificate = field "certificate" case in
  let pieces = List.map (fun piece -> match list piece with
      | [ l; till ] -> (rational (text l), rational (text till)) | _ -> unreadable "a piece has two numbers")
      (list (field "pieces" certificate)) in
  let times = List.map (fun (_, till) -> till) pieces in
  let exact_hex s = exact (float_of (text s)) in
  let claim, times = match field "first" case with
    | Null -> if truth (field "hit" case) then unreadable "a hit has a first contact"; (Checker.NoContact, times)
    | _ when not (truth (field "hit" case)) -> unreadable "a clear sweep has no first contact"
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
let tilted_refused ~tilted ~sweep case =
  let numbers = numbers_of_refusal case in
  not (List.for_all Float.is_finite numbers && Checker.valid_sizes (placed ~tilted ~sweep (List.map exact numbers)).sizes)

(* ---- Rows with heights. *)

let ended_of floats =
  let numbers, heights = split 10 floats in
  let place = placed ~tilted:true ~sweep:false (List.map exact numbers) in
  let end_of z = if Float.is_finite z then Some (exact z) else None in
  match heights with
  | [ low; high; solid ] -> (place, { Checker.h_low = end_of low; h_high = end_of high; h_solid = solid = 1. })
  | _ -> unreadable "a row with heights has 13 numbers"

(* That all numbers but the ends are finite, the ends are none of them on the wrong side, and solid is 0 or 1. *)
let plain_ends floats =
  let numbers, heights = split 10 floats in
  List.for_all Float.is_finite numbers && match heights with
  | [ low; high; solid ] -> low < infinity && high > neg_infinity && (solid = 0. || solid = 1.)
  | _ -> unreadable "a row with heights has 13 numbers"

let float_in = function Number s | String s -> float_of s | _ -> unreadable "a row has numbers"

(* A piece: its ends, the multiplier, the number for the plane. *)
let piece_of piece = match List.map text (list piece) with
  | [ low; high; l; mu ] ->
    let end_of infinite s = if s = infinite then None else Some (rational s) in
    (end_of "-inf" low, end_of "inf" high, rational l, rational mu)
  | _ -> unreadable "a piece has four numbers"

(* What the certificate has, in units of 1/unit. *)
let end_witness (place, { Checker.h_low; h_high; h_solid }) claim pieces unit certificate : Checker.end_witness =
  let in_unit q = of_q (Q.mul (in_q q) (Q.of_bigint unit)) in
  let piece (low, high, l, mu) =
    let power = if low <> None && high <> None then 2 else 1 in
    { Checker.p_low = Option.map in_unit low; p_high = Option.map in_unit high; p_multiplier = l;
      p_plane = of_q (Q.div (in_q mu) (Q.of_bigint (Z.pow unit power))) } in
  if has "pieces" certificate then Pieces (List.map piece pieces)
  else if has "points" certificate then
    Places (List.map (fun p -> spot (List.map (fun s -> rational (text s)) (list p))) (list (field "points" certificate)))
  else if has "multiplier" certificate then begin
    let l = rational (text (field "multiplier" certificate)) in
    let height = snd (List.hd place.spots) in
    let beyond upper lower = beyond_reach place.numbers (vector place.sizes.s_axis) unit (Q.sub (in_q upper) (in_q lower)) in
    let beneath = Option.map (beyond height) h_low and over = Option.map (fun high -> beyond high height) h_high in
    if h_solid && claim = Checker.Interior then Within (l, Option.value ~default:zero beneath, Option.value ~default:zero over)
    else Pieces [ { Checker.p_low = None; p_high = None; p_multiplier = l; p_plane = zero } ]
  end
  else unreadable "a certificate has a multiplier, pieces, points or a rule"

let ended_accepted case =
  let hex = List.map float_in (list (field "hex" case)) and decimal = List.map float_in (list (field "row" case)) in
  if List.map Int64.bits_of_float hex <> List.map Int64.bits_of_float decimal then unreadable "row and hex are not the same numbers";
  if not (plain_ends hex) then unreadable "a number is not finite, or solid is neither 0 nor 1";
  let place, heights = ended_of hex in
  let claim = position (number (field "position" case)) and certificate = field "certificate" case in
  let pieces = if has "pieces" certificate then List.map piece_of (list (field "pieces" certificate)) else [] in
  let ends = (heights.h_low, heights.h_high) :: List.map (fun (low, high, _, _) -> (low, high)) pieces in
  let unit = unit_of (place.all @ List.concat_map (fun (low, high) -> Option.to_list low @ Option.to_list high) ends) in
  let centre = List.hd place.spots in
  let proves = Checker.check_ended place.sizes centre heights unit (axis_unit place) claim in
  if has "rule" certificate && text (field "rule" certificate) = "height" then begin
    let low = Option.map in_q heights.h_low and high = Option.map in_q heights.h_high in
    let tried = near_touch place.numbers (vector place.sizes.s_axis) (vector centre) low high in
    claim = Checker.Contact && (List.exists (fun points -> proves (Places points)) tried || raise Without_certificate)
  end
  else proves (end_witness (place, heights) claim pieces unit certificate)

(* A row that must be refused: also where an end is infinite on the wrong side, or not below the other. *)
let ended_refused case =
  let numbers = numbers_of_refusal case in
  not (plain_ends numbers && let place, heights = ended_of numbers in
    Checker.valid_sizes place.sizes && Checker.valid_heights heights)

let read path =
  let channel = try open_in_bin path with Sys_error reason -> unreadable "%s" reason in
  Fun.protect ~finally:(fun () -> close_in channel) (fun () -> really_input_string channel (in_channel_length channel))

let check_file sums path =
  let file = json_of (read path) in
  let valid = "is a valid row" and unproved = "the certificate does not prove the label" in
  let right, claim = match text (field "content" file) with
    | "positions" -> (accepted, unproved)
    | "tilted-positions" -> (tilted_accepted, unproved)
    | "ways" -> (sweep_accepted ~tilted:false, unproved)
    | "tilted-ways" -> (sweep_accepted ~tilted:true, unproved)
    | "ended-positions" -> (ended_accepted, unproved)
    | "refusals" -> (refused, valid)
    | "tilted-refusals" -> (tilted_refused ~tilted:true ~sweep:false, valid)
    | "way-refusals" -> (tilted_refused ~tilted:false ~sweep:true, valid)
    | "tilted-way-refusals" -> (tilted_refused ~tilted:true ~sweep:true, valid)
    | "ended-refusals" -> (ended_refused, valid)
    | content -> unreadable "the checker reads no content %S" content in
  List.fold_left (fun (cases, wrong, without) case ->
      let id = text (field "id" case) in
      match right case with
      | true -> (cases + 1, wrong, without)
      | false -> Printf.printf "%s, case %s: %s\n" path id claim; (cases + 1, wrong + 1, without)
      | exception Without_certificate -> (cases, wrong, without + 1)
      | exception Unreadable reason -> unreadable "case %s: %s" id reason)
    sums (list (field "cases" file))

let check_files paths =
  let cases, wrong, without = List.fold_left (fun sums path ->
      try check_file sums path with Unreadable reason -> unreadable "%s: %s" path reason) (0, 0, 0) paths in
  Printf.printf "%d cases checked by the proved checker, %s with a wrong label\n" cases
    (if wrong = 0 then "none" else string_of_int wrong);
  if without > 0 then Printf.printf "%d contacts beside an end have no certificate and are not checked\n" without;
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
