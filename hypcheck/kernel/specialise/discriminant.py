"""The Hessian discriminant of a setting with an error bound that is one number: fixed for a box of centres.

With s a power of two near (AB)^⅓ and λ = s μ, the cubic is μ³ + (c2/s) μ² + (c1/s²) μ + c0/s³, whose discriminant is
Δ/s⁶: the sign stays and the magnitudes come near 1. In R and Z (scale.py) its coefficients are

    c1/s² = V + VR R − VZ Z,  V = (c0 + A − B)/s²,  VR = B/(b² s²),  VZ = A/(d² s²)
    c2/s  = K − KR R − KZ Z,  K = (A − B + 1)/s,    KR = 1/(b² s),   KZ = 1/(d² s),     c0/s³ = −AB/s³.

Bound. derivation/rounding.py counts k factors for every term of 3Δ/s⁶, the roundings of x, y, z and of the constants
included, so that |computed − exact| ≤ γ_k M, where M is the sum of the terms' magnitudes. M grows with |x|, |y| and
|z|: its exact value at the far corner of a box holds in all of it. A computed value beyond that has the sign of Δ.

What the sign says. Δ < 0: contact, whatever the sizes. Δ > 0: clear, where a ≥ 1 and c² ≥ a (the pair of roots below
the largest can then be nowhere but between the poles: docs/mathematics.md), on the side on which the centre is
(centre.py). Elsewhere Δ > 0 settles nothing, and the search is asked.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.derivation.coefficient_listings import HESSIAN_DISCRIMINANT
from hypcheck.derivation.evaluation import evaluate
from hypcheck.derivation.exact_arithmetic import EXACT
from hypcheck.derivation.listing import program_of
from hypcheck.derivation.program import Program
from hypcheck.derivation.rounding import gamma, relative_error_counts
from hypcheck.kernel.specialise.formats import Format, power_of_two_near
from hypcheck.kernel.specialise.scale import Scaled

COEFFICIENTS = """
    V_across = VR * R
    V_plus = V + V_across
    V_up = VZ * zz
    c1 = V_plus - V_up
    K_across = KR * R
    K_minus = K - K_across
    K_up = KZ * zz
    c2 = K_minus - K_up
"""

SLACK = 1 + Fraction(1, 2**20)
"""Covers constants that are up to u away from their exact values where M is formed of them."""


@dataclass(frozen=True)
class Discriminant:
    """`program` takes R, zz and the constants; beyond ± `bound`, its step delta_3 has the sign of Δ for certain.

    That holds for centres with R ≤ `widest` and zz ≤ `highest`. `clear_where_positive`: the regime lets Δ > 0 mean
    clear, on the side on which the centre is.
    """

    program: Program
    constants: dict[str, float]
    bound: float
    widest: float
    highest: float
    clear_where_positive: bool


def discriminant(
    scaled: Scaled, form: Format, entry: Program, entry_constants: dict[str, float], corner: tuple[Fraction, Fraction]
) -> Discriminant | None:
    """The stage for centres with |x|, |y| ≤ corner[0] and |z| ≤ corner[1], in the scene's units.

    None where a constant or a magnitude leaves the format.
    """
    try:
        _, exact = exact_constants(scaled)
        constants = {name: form.rounded(value) for name, value in exact.items()}
        program = program_of("discriminant", ("R", "zz", *constants), COEFFICIENTS, HESSIAN_DISCRIMINANT)
        fixed = {name: Fraction(value) for name, value in (*entry_constants.items(), *constants.items())}
        bound = form.rounded(
            _bound(program, entry, {**fixed, "x": corner[0], "y": corner[0], "z": corner[1]}, form), "up"
        )
        far_radial, far_axial = corner[0] * scaled.radial, corner[1] * scaled.axial
        widest, highest = form.rounded(2 * far_radial**2, "down"), form.rounded(far_axial**2, "down")
    except OverflowError:
        return None
    clear = scaled.A >= 1 and scaled.B**2 >= scaled.A
    return Discriminant(program, constants, bound, widest, highest, clear)


def exact_constants(scaled: Scaled) -> tuple[Fraction, dict[str, Fraction]]:
    """The power of two s, and the constants before they are rounded."""
    A, B, bb, dd = scaled.A, scaled.B, scaled.bb, scaled.dd
    s = power_of_two_near(A * B)
    s = Fraction(2) ** round((s.numerator.bit_length() - s.denominator.bit_length()) / 3)
    return s, {
        "V": (A - B - A * B) / s**2,
        "VR": B / (bb * s**2),
        "VZ": A / (dd * s**2),
        "K": (A - B + 1) / s,
        "KR": 1 / (bb * s),
        "KZ": 1 / (dd * s),
        "c0": -A * B / s**3,
    }


def _bound(program: Program, entry: Program, corner: Mapping[str, Fraction], form: Format) -> Fraction:
    """γ_k M at the corner; raises OverflowError where an intermediate could overflow."""
    whole = Program("stage", _inputs(program, entry), (*entry.steps, *program.steps))
    names = tuple(step.name for step in whole.steps)
    counts = relative_error_counts(whole, names, frozenset(), input_roundings=1)
    values = evaluate(counts.program, EXACT, corner)
    if any(value >= Fraction(2) ** form.greatest for value in values.values()):
        raise OverflowError("an intermediate can overflow")
    magnitude = Fraction(values[str(counts.magnitudes["delta_3"])])
    return gamma(counts.counts["delta_3"], form.unit) * magnitude * SLACK**8


def _inputs(program: Program, entry: Program) -> tuple[str, ...]:
    made = {step.name for step in entry.steps}
    return tuple(dict.fromkeys((*entry.inputs, *(name for name in program.inputs if name not in made))))
