(** The proved checker as OCaml. Whole numbers become Zarith's (GMP); booleans, lists and pairs become OCaml's own. *)

From Hypcheck Require Import Checker LeaningChecker RowChecker EndsChecker.
Require Import Extraction ExtrOcamlBasic ExtrOcamlZBigInt.

Extraction "checker.ml" dyadic check check_vector valid_sizes check_tilted check_passage
  valid_heights check_ended.
