(** The value that is read of the bits of a finite double is the number that Flocq says the bits are, of the format binary64 of IEEE 754. *)

Require Import ZArith Reals Lra Lia Bool.
From Flocq Require Import Core IEEE754.Binary IEEE754.Bits.
From Hypcheck Require Import Long Limbs Doubles StageThreeNumbers StagesOnDoubles.
Open Scope Z_scope.

Lemma power_is e : power e = bpow radix2 e.
Proof. unfold power; rewrite bpow_powerRZ; reflexivity. Qed.

Theorem value_is_binary64 w : is_word w -> exponent_bits w <> 2047 -> B2R 53 1024 (b64_of_bits w) = value_of_bits w.
Proof.
  intros Word Finite; unfold b64_of_bits, binary_float_of_bits; rewrite B2R_FF2B; unfold binary_float_of_bits_aux, split_bits.
  change (2 ^ 52) with 4503599627370496; change (w / 4503599627370496 mod 2 ^ 11) with (exponent_bits w); change (w mod 4503599627370496) with (fraction w).
  assert (sign : (4503599627370496 * 2 ^ 11 <=? w) = negb (sign_bit w =? 0)).
  { change (4503599627370496 * 2 ^ 11) with (2 ^ 63); unfold sign_bit; destruct (Z.leb_spec (2 ^ 63) w) as [L | L], (Z.eqb_spec (w / 2 ^ 63) 0) as [E | E]; try reflexivity.
    - apply Z.div_small_iff in E; lia.
    - elim E; apply Z.div_small; destruct Word; lia. }
  rewrite sign; change (SpecFloat.emin (52 + 1) (2 ^ (11 - 1))) with (-1074); change (2 ^ 11 - 1) with 2047.
  assert (number : forall p e, FF2R radix2 (F754_finite (negb (sign_bit w =? 0)) p e) = ((if sign_bit w =? 0 then 1 else -1) * IZR (Zpos p) * power e)%R).
  { intros p e; rewrite power_is; cbn [FF2R]; unfold F2R; cbn [Fnum Fexp]; destruct (sign_bit w =? 0); cbn [negb cond_Zopp]; [| rewrite opp_IZR]; ring. }
  destruct (parts_bounded w Word) as (_ & E & F); unfold value_of_bits, raw_size, raw_power; pose proof (Zeq_bool_if (exponent_bits w) 0) as Z0; pose proof (Zeq_bool_if (exponent_bits w) 2047) as Z1.
  destruct (Zeq_bool (exponent_bits w) 0); [rewrite Z0; change (0 =? 0) with true | rewrite (proj2 (Z.eqb_neq _ _) Z0)]; cbv iota.
  - destruct (fraction w) as [| p | p]; [cbn [FF2R]; ring | exact (number p (-1074)) | lia].
  - destruct (Zeq_bool (exponent_bits w) 2047); [contradiction |]; change (fraction w + 2 ^ 52) with (fraction w + 4503599627370496).
    destruct (fraction w + 4503599627370496) as [| p | p] eqn:P; [lia | rewrite number; do 2 f_equal; lia | lia].
Qed.
