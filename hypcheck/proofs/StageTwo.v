(** The coefficients of g and 3 delta as the kernel computes them, printed from the kernel's own program
    by `python -m hypcheck.kernel.printing.coq`; do not edit. Kernel.v has what is proved of it. *)

Require Import ZArith.
From Hypcheck Require Import Rounding.

Definition alpha := Input 0.
Definition gamma := Input 1.
Definition b := Input 2.
Definition d := Input 3.
Definition x := Input 4.
Definition y := Input 5.
Definition z := Input 6.
Definition u_8 := Input 7.
Definition u_12 := Input 8.
Definition u_1536 := Input 9.
Definition alpha_over_b := Div alpha b.
Definition A := Mul alpha_over_b alpha_over_b.
Definition gamma_over_d := Div gamma d.
Definition B := Mul gamma_over_d gamma_over_d.
Definition AB := Mul A B.
Definition c0 := Neg AB.
Definition c0_plus_A := Add c0 A.
Definition C := Sub c0_plus_A B.
Definition xx := Mul x x.
Definition yy := Mul y y.
Definition rr := Add xx yy.
Definition bb := Mul b b.
Definition P := Div rr bb.
Definition z_over_d := Div z d.
Definition Q := Mul z_over_d z_over_d.
Definition BP := Mul B P.
Definition C_plus_BP := Add C BP.
Definition AQ := Mul A Q.
Definition c1 := Sub C_plus_BP AQ.
Definition A_minus_B := Sub A B.
Definition K := Add A_minus_B (Whole (1)%Z).
Definition K_minus_P := Sub K P.
Definition c2 := Sub K_minus_P Q.
Definition c2_squared := Mul c2 c2.
Definition three_c1 := Mul (Whole (3)%Z) c1.
Definition h1 := Sub c2_squared three_c1.
Definition c2c1 := Mul c2 c1.
Definition nine_c0 := Mul (Whole (9)%Z) c0.
Definition h2 := Sub c2c1 nine_c0.
Definition c1_squared := Mul c1 c1.
Definition c2c0 := Mul c2 c0.
Definition three_c2c0 := Mul (Whole (3)%Z) c2c0.
Definition h3 := Sub c1_squared three_c2c0.
Definition h1h3 := Mul h1 h3.
Definition h1h3_4 := Scale 2 h1h3.
Definition h2_squared := Mul h2 h2.
Definition delta_3 := Sub h1h3_4 h2_squared.
