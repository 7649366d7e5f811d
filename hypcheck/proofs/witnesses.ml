(* What a certificate leaves to be found for the extracted checker. Nothing in this file is trusted: the checker asks that a
   unit of length be positive, that a point be where it is said to be, and that a number prove what it is for. *)

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
  let found, free = solutions rows 3 in
  let product u v = sum (fun i -> sum (fun j -> Q.mul u.(i) (Q.mul (ball i j) v.(j)))) in
  let free = Array.of_list free in
  let n = Array.length free in
  let shares, _ = solutions (Array.init n (fun i -> Array.init (n + 1) (fun j ->
      if j = n then Q.neg (product free.(i) found) else product free.(i) free.(j)))) n in
  let nearest = Array.init 3 (fun i -> Array.fold_left Q.add found.(i) (Array.init n (fun k -> Q.mul shares.(k) free.(k).(i)))) in
  (nearest, if n = 0 then Array.make 3 Q.zero else free.(0))

let in_q { Checker.qnum; qden } = Q.make qnum qden
let of_q q = { Checker.qnum = Q.num q; qden = Q.den q }
let spot_of a = ((of_q a.(0), of_q a.(1)), of_q a.(2))
let vector ((x, y), z) = [| in_q x; in_q y; in_q z |]

(* The number that proves best that a spheroid reaches no farther up or down than [away], in units of 1/[unit]. *)
let beyond_reach sizes axis unit away =
  let b, d = match sizes with [ _; _; b; d ] -> (b, d) | _ -> assert false in
  let reach_squared = Q.(b * b + (d * d - b * b) * axis.(2) * axis.(2) / sum (fun i -> axis.(i) * axis.(i))) in
  of_q Q.(of_int 2 * away / reach_squared / of_bigint unit)
