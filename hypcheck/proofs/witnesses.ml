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

let square x = Q.mul x x

(* The entries of S but the last row and column. *)
let ball b d axis =
  let across = Q.inv (square b) in
  let more = Q.div (Q.sub (Q.inv (square d)) across) (sum (fun i -> square axis.(i))) in
  fun i j -> Q.add (if i = j then across else Q.zero) (Q.mul more (Q.mul axis.(i) axis.(j)))

(* Where S + mH is least, as an offset in multiples of b, nearest to the centre if there are many; and a direction of them. *)
let touching sizes axis centre m =
  let alpha, gamma, b, d = match sizes with [ a; g; b; d ] -> (a, g, b, d) | _ -> assert false in
  let ball = ball b d axis in
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

(* ---- A contact beside an end that is a touch, or a hair from one: points that may prove it. *)

(* The root rounded down to many bits, or exactly where it is rational. *)
let root q =
  let exact = Q.make (Z.sqrt (Q.num q)) (Z.sqrt (Q.den q)) in
  if Q.equal (square exact) q then (exact, true)
  else (Q.make (Z.sqrt (Z.div (Z.shift_left (Q.num q) 600) (Q.den q))) (Z.shift_left Z.one 300), false)

(* Where a function that changes its sign between two heights does so, to 200 halvings. *)
let sign_change f low high =
  let rec halve low high n = if n = 0 then low else
      let middle = Q.div_2exp (Q.add low high) 1 in
      if Q.sign (f middle) = Q.sign (f low) then halve middle high (n - 1) else halve low middle (n - 1) in
  if Q.sign (f low) * Q.sign (f high) < 0 then [ halve low high 200 ] else []

(* The circle of the hyperboloid and the disc of the spheroid at a height w meet where Q(w) <= 0 or F(w) = Q(w)^2 - 4 R r(w)^2 <= 0,
   with R the squared distance of the centre from the axis: the heights at which F is least, between the lowest and the highest
   point of the spheroid. *)
let nearest_heights (alpha, gamma, b, d) (x, y, z) =
  let open Q in
  let far = square x + square y and steep = square (alpha / gamma) and flat = square (b / d) in
  let q2 = steep + flat and q1 = of_int (-2) * flat * z in
  let q0 = square alpha - square b + flat * square z + far in
  let slope w = (q2 * square w + q1 * w + q0) * (of_int 2 * q2 * w + q1) - of_int 4 * far * steep * w in
  let bends = square q1 - of_int 4 * q2 * q0 + of_int 8 * far * steep in
  let middle = neg q1 / (of_int 2 * q2) in
  let half = if bends <= zero then zero else fst (root (bends / (of_int 12 * square q2))) in
  let inner = List.filter (fun w -> z - d < w && w < z + d) [ middle - half; middle + half ] in
  let rec pairs = function u :: (v :: _ as rest) -> sign_change slope u v @ pairs rest | _ -> [] in
  pairs ((z - d :: inner) @ [ z + d ])

(* Points in a direction (u, v), its squared length given, at a height: one on the hyperboloid where it is rational, or two beside it. *)
let beside_the_wall (alpha, gamma, _, _) (u, v, length) w =
  let open Q in
  let k, exact = root (square alpha * (one + square (w / gamma)) / length) in
  let at factor = [| k * factor * u; k * factor * v; w |] in
  let hair e = make Z.one (Z.shift_left Z.one e) in
  (if exact then [ [ at one ] ] else [])
  @ List.map (fun e -> [ at (one - hair e); at (one + hair e) ]) [ 250; 200; 150; 120; 100; 80; 70; 60; 50; 40 ]

(* The directions in which the circle at a height is nearest to the spheroid, in its norm, of any axis. *)
let nearest_directions (alpha, gamma, b, d) axis centre w =
  let open Q in
  let ball = ball b d axis and r = fst (root (square alpha * (one + square (w / gamma)))) in
  let direction side t = let l = one + square t in (side * (one - square t) / l, side * (t + t) / l, one) in
  let turn side t =
    let u, v, _ = direction side t in
    let away = [| r * u - centre.(0); r * v - centre.(1); w - centre.(2) |] and along = [| neg v; u; zero |] in
    sum (fun i -> sum (fun j -> away.(i) * ball i j * along.(j))) in
  let steps = List.init 64 (fun i -> of_ints (Stdlib.( - ) i 32) 32) in
  List.concat_map (fun side -> List.concat_map (fun t ->
      List.map (direction side) (sign_change (turn side) t (t + of_ints 1 32))) steps) [ one; minus_one ]

let near_touch sizes axis centre low high =
  let (_, _, b, _) as sizes = match sizes with [ a; g; b; d ] -> (a, g, b, d) | _ -> assert false in
  let x, y, z = (centre.(0), centre.(1), centre.(2)) in
  let ends = List.filter_map Fun.id [ low; high ] in
  let within w = Option.fold ~none:true ~some:(fun l -> Q.leq l w) low && Option.fold ~none:true ~some:(fun u -> Q.leq w u) high in
  let far = Q.add (square x) (square y) in
  let ray = if Q.sign far = 0 then (Q.one, Q.zero, Q.one) else (x, y, far) in
  let places =
    if Q.sign axis.(0) = 0 && Q.sign axis.(1) = 0 then
      List.map (fun w -> [ [| x; y; w |] ]) ends
      @ List.concat_map (beside_the_wall sizes ray) (List.filter within (ends @ nearest_heights sizes (x, y, z)))
    else List.concat_map (fun w -> List.concat_map (fun towards -> beside_the_wall sizes towards w) (nearest_directions sizes axis centre w)) ends in
  let offset place = spot_of (Array.mapi (fun i p -> Q.div (Q.sub p centre.(i)) b) place) in
  List.map (List.map offset) places
