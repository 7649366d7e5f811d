(** What the kernel's floats compute, printed from the kernel's own programs by

        python -m hypcheck.kernel.printing.coq

    First c0, c1, c2 and 3 delta from a row; then, in modules, what leads from the coefficients to h1, h2, h3, from
    these to 3 delta, and from computed numbers to the running bound E. Kernel.v and RunningBound.v have the proofs. *)

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

Module Parts.
Definition c0 := Input 0.
Definition c1 := Input 1.
Definition c2 := Input 2.
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
End Parts.

Module Last.
Definition h1 := Input 0.
Definition h2 := Input 1.
Definition h3 := Input 2.
Definition h1h3 := Mul h1 h3.
Definition h1h3_4 := Scale 2 h1h3.
Definition h2_squared := Mul h2 h2.
Definition delta_3 := Sub h1h3_4 h2_squared.
End Last.

Module Slopes.
Definition c1 := Input 0.
Definition c2 := Input 1.
Definition alpha := Input 2.
Definition gamma := Input 3.
Definition b := Input 4.
Definition d := Input 5.
Definition alpha_over_b := Div alpha b.
Definition A := Mul alpha_over_b alpha_over_b.
Definition gamma_over_d := Div gamma d.
Definition B := Mul gamma_over_d gamma_over_d.
Definition two_c2 := Scale 1 c2.
Definition thrice_B := Mul (Whole (3)%Z) B.
Definition chord_B := Add thrice_B two_c2.
Definition rise_B := Mul chord_B B.
Definition slope_B := Add rise_B c1.
Definition offset_B := Add thrice_B c2.
Definition thrice_A := Mul (Whole (3)%Z) A.
Definition chord_A := Sub thrice_A two_c2.
Definition rise_A := Mul chord_A A.
Definition slope_A := Add rise_A c1.
Definition offset_A := Sub thrice_A c2.
End Slopes.

Module Bound.
Definition A := Input 0.
Definition B := Input 1.
Definition AB := Input 2.
Definition BP := Input 3.
Definition AQ := Input 4.
Definition P := Input 5.
Definition Q := Input 6.
Definition size_c1 := Input 7.
Definition size_c2 := Input 8.
Definition size_h1 := Input 9.
Definition size_h2 := Input 10.
Definition size_h3 := Input 11.
Definition u_4 := Input 12.
Definition u_8 := Input 13.
Definition u_12 := Input 14.
Definition slack := Input 15.
Definition u_16 := Input 16.
Definition P_plus_Q := Add P Q.
Definition A_plus_B := Add A B.
Definition sizes_1 := Add A_plus_B AB.
Definition BP_plus_AQ := Add BP AQ.
Definition terms_1 := Add sizes_1 BP_plus_AQ.
Definition sizes_2 := Add A_plus_B (Whole (1)%Z).
Definition terms_2 := Add sizes_2 P_plus_Q.
Definition e1 := Mul u_12 terms_1.
Definition e2 := Mul u_8 terms_2.
Definition e0 := Mul u_8 AB.
Definition m0 := Add AB e0.
Definition m1 := Add size_c1 e1.
Definition m2 := Add size_c2 e2.
Definition u_m0 := Mul u_4 m0.
Definition f0 := Add e0 u_m0.
Definition u_m1 := Mul u_4 m1.
Definition f1 := Add e1 u_m1.
Definition u_m2 := Mul u_4 m2.
Definition twice_e2 := Scale 1 e2.
Definition f2 := Add twice_e2 u_m2.
Definition m2_f2 := Mul m2 f2.
Definition thrice_f1 := Mul (Whole (3)%Z) f1.
Definition E1 := Add m2_f2 thrice_f1.
Definition m2_f1 := Mul m2 f1.
Definition m1_e2 := Mul m1 e2.
Definition cross_21 := Add m2_f1 m1_e2.
Definition ninefold_f0 := Mul (Whole (9)%Z) f0.
Definition E2 := Add cross_21 ninefold_f0.
Definition twice_e1 := Scale 1 e1.
Definition f3 := Add twice_e1 u_m1.
Definition m1_f3 := Mul m1 f3.
Definition m2_f0 := Mul m2 f0.
Definition m0_e2 := Mul m0 e2.
Definition cross_20 := Add m2_f0 m0_e2.
Definition thrice_cross_20 := Mul (Whole (3)%Z) cross_20.
Definition E3 := Add m1_f3 thrice_cross_20.
Definition a1 := Add size_h1 E1.
Definition a2 := Add size_h2 E2.
Definition a3 := Add size_h3 E3.
Definition u_a3 := Mul u_4 a3.
Definition F3 := Add E3 u_a3.
Definition a1_F3 := Mul a1 F3.
Definition a3_E1 := Mul a3 E1.
Definition cross_13 := Add a1_F3 a3_E1.
Definition fourfold_cross_13 := Scale 2 cross_13.
Definition u_a2 := Mul u_4 a2.
Definition twice_E2 := Scale 1 E2.
Definition F2 := Add twice_E2 u_a2.
Definition a2_F2 := Mul a2 F2.
Definition E_sum := Add fourfold_cross_13 a2_F2.
Definition E := Mul slack E_sum.
Definition twice_m2 := Scale 1 m2.
Definition thrice_B := Mul (Whole (3)%Z) B.
Definition size_chord_B := Add thrice_B twice_m2.
Definition size_rise_B := Mul size_chord_B B.
Definition size_slope_B := Add size_rise_B m1.
Definition u_slope_B := Mul u_16 size_slope_B.
Definition carried_B := Mul twice_e2 B.
Definition carried_1_B := Add carried_B e1.
Definition error_B := Add carried_1_B u_slope_B.
Definition bound_B := Mul slack error_B.
Definition size_offset_B := Add B m2.
Definition u_offset_B := Mul u_16 size_offset_B.
Definition offset_error_B := Add e2 u_offset_B.
Definition offset_bound_B := Mul slack offset_error_B.
Definition thrice_A := Mul (Whole (3)%Z) A.
Definition size_chord_A := Add thrice_A twice_m2.
Definition size_rise_A := Mul size_chord_A A.
Definition size_slope_A := Add size_rise_A m1.
Definition u_slope_A := Mul u_16 size_slope_A.
Definition carried_A := Mul twice_e2 A.
Definition carried_1_A := Add carried_A e1.
Definition error_A := Add carried_1_A u_slope_A.
Definition bound_A := Mul slack error_A.
Definition size_offset_A := Add A m2.
Definition u_offset_A := Mul u_16 size_offset_A.
Definition offset_error_A := Add e2 u_offset_A.
Definition offset_bound_A := Mul slack offset_error_A.
End Bound.
