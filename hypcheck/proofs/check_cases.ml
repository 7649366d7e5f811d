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

(* The row of a case: the hexadecimal numbers, and the decimal ones must be the same. *)
let row_of_case case =
  let hex = List.map (fun s -> float_of (text s)) (list (field "hex" case)) in
  let decimal = List.map (function Number s -> float_of s | _ -> unreadable "a row has numbers") (list (field "row" case)) in
  if List.map Int64.bits_of_float hex <> List.map Int64.bits_of_float decimal then
    unreadable "row and hex are not the same numbers";
  row_of (List.map exact hex)

let proof_of certificate : Checker.certificate =
  if has "multiplier" certificate then Multiplier (rational (text (field "multiplier" certificate)))
  else if has "double_root" certificate then DoubleRoot (rational (text (field "double_root" certificate)))
  else Points (List.map (fun p -> spot (List.map (fun s -> rational (text s)) (list p))) (list (field "points" certificate)))

let number = function Number s -> s | _ -> unreadable "a number is expected"
let truth = function Bool b -> b | _ -> unreadable "true or false is expected"

let accepted case =
  let row = row_of_case case in
  let claim = position (number (field "position" case)) in
  let tangent = truth (field "tangent" case) in
  Checker.check_vector row claim tangent (proof_of (field "certificate" case))

(* A row that must be refused: a number that is not finite, or a semi-axis that is not positive. *)
let refused case =
  let numbers = List.map (function Number s | String s -> float_of s | _ -> unreadable "a row has numbers")
      (list (field "row" case)) in
  not (List.for_all Float.is_finite numbers && Checker.valid_row (row_of (List.map exact numbers)))

let read path =
  let channel = try open_in_bin path with Sys_error reason -> unreadable "%s" reason in
  Fun.protect ~finally:(fun () -> close_in channel) (fun () -> really_input_string channel (in_channel_length channel))

let check_file (cases, wrong) path =
  let file = json_of (read path) in
  let right, claim = if text (field "content" file) = "refusals" then (refused, "is a valid row")
    else (accepted, "the certificate does not prove the label") in
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
