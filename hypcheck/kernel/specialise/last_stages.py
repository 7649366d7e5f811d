"""The last stages of a specialised kernel: the Hessian discriminant with a fixed error bound, and the search on φ.

R = x² + y² and Z = z² (`zz` in programs) are those of the centre (x, y, z) in the kernel's units. A = (α/b)², B =
(γ/d)², P = R/b² and Q = Z/d². c0, c1, c2 are the coefficients of the cubic g in λ, and Δ is its discriminant. u is the
unit roundoff of the format.

The discriminant of a setting has an error bound that is one number, fixed for a box of centres. With s a power of two
near (AB)^⅓ and λ = s μ, the cubic is μ³ + (c2/s) μ² + (c1/s²) μ + c0/s³, whose discriminant is Δ/s⁶: the sign stays and
the magnitudes come near 1. In R and Z its coefficients are

    c1/s² = V + VR R − VZ Z,  V = (c0 + A − B)/s²,  VR = B/(b² s²),  VZ = A/(d² s²)
    c2/s  = K − KR R − KZ Z,  K = (A − B + 1)/s,    KR = 1/(b² s),   KZ = 1/(d² s),     c0/s³ = −AB/s³.

Bound. derivation/rounding.py counts k rounding factors for every term of 3Δ/s⁶, the roundings of x, y, z and of the
constants included, so that |computed − exact| ≤ γ_k M, where M is the sum of the terms' magnitudes. M grows with |x|,
|y| and |z|: its exact value at the far corner of a box holds in all of it. A computed value beyond that has the sign of
Δ.

What the sign says. Δ < 0: contact, whatever the sizes. Δ > 0: clear, where a ≥ 1 and c² ≥ a (the pair of roots below
the largest can then be nowhere but between the poles: docs/mathematics.md), on the side on which the centre is
(first_stages.py). Elsewhere Δ > 0 decides nothing, and the search follows.

The search finds the sign of the dual function φ at the λ where it is largest; nothing in it cancels. Its slope F = φ' =
(a r/(A+λ))² − (c z/(B−λ))² − 1, where a = α/b, c = γ/d and here r² = P, z² = Q, falls from one pole to the other. The
sign of F at 0 tells on which side of 0 its root lies; the sign half way to the pole tells whether the root is nearer to
0 or to the pole. That distance is the unknown. First its exponent is halved, then the distance; the two other distances
are sums with it (docs/mathematics.md).

All operations that round are in the programs below; a kernel adds the loop, and the choice of a half.

Bound. φ is computed as a sum whose terms P λ/(A+λ), Q λ/(B−λ), 1 and λ carry few factors (1+δ), |δ| ≤ u: with k of them
on the first and second and j on the others, the computed sign is the sign of φ for P and Q changed by at most (k + j)u
relative to 1 + λ. A claim of clear is thus right for inputs changed by half of that, wherever λ is. Where φ is not
positive at the λ found, that λ is the true maximum for P and Q changed by the few u of F's own count; since φ is
stationary there, the true maximum is larger by the square of that only, far below one u of the terms. So the answer
"contact" is right for inputs changed by half of (k + j)u too, up to a share of order √u. `backward_bound` counts.

Range. That holds as long as nothing overflows. The limits `widest` of R and `highest` of Z ensure that: with P and Q so
bounded that P, Q times 1, A or B, 2⁸ P/A and 2⁸ Q/B stay below M = 2^(greatest − 2), so do the values of F at 0 and
beside the other pole, and at the λ found the terms, of which one is at most √(P Q B/A) < M, the other √(A P (1 + Q/B))
< 2 M. Towards a pole F's own term may overflow: it is then the larger one. What underflows is the square of a
coordinate that is nothing beside the semi-axes, or a term that is nothing beside 1 + λ: at most 2^least/A or 2^least/B
(`_least_square`).

Beginning. The λ of the maximum can be arbitrarily near to 0 or to a pole. The search begins at a distance e > 0, and
results in e if the maximum is nearer. Next to 0 that is as good where e ≤ 1/(2 + 2 P/A) on the one side and 1/(2 + 2
Q/B) on the other: up to there φ ≤ P e/A − 1, or Q e/B + e − 1, is negative, at the maximum too. Next to a pole, λ and
with it 1 + λ and the other pole's term change by a share of e/A or e/B, which is u/1024, and this pole's term becomes
smaller.

Where a spheroid is tilted, the search is in double-double. Its programs, and what they prove, are in tilted.py; here is
what it holds: its frame, or the squares of the sizes where each query names an axis. The frame of a fixed axis is made
in rational numbers, far more precisely than its bound needs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from hypcheck.derivation.evaluation import EXACT, OPERATORS, Arithmetic, evaluate, outputs
from hypcheck.derivation.float_arithmetic import FloatFormat, power_of_two_near
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.listings import HESSIAN_DISCRIMINANT
from hypcheck.derivation.program import Program, cut, program_of
from hypcheck.derivation.rounding import gamma, relative_error_counts
from hypcheck.geometry.pair import Sizes
from hypcheck.kernel.specialise import tilted
from hypcheck.kernel.specialise.first_stages import UNSCALED, entry
from hypcheck.kernel.specialise.settings import ScaledSetting
from hypcheck.scene.model import Point

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
"""The steps to the coefficients c1/s² and c2/s, from R and zz."""

SLACK = 1 + Fraction(1, 2**20)
"""Covers that M is computed from rounded constants, each up to a relative u from its exact value."""


@dataclass(frozen=True)
class Discriminant:
    """The stage that decides by the discriminant: beyond ± `bound`, delta_3 certainly has the sign of Δ.

    delta_3 is a step of `program`, whose inputs are R = x² + y², zz = z² and the constants. The bound holds for centres
    with R ≤ `widest` and zz ≤ `highest`. `clear_where_positive`: Δ > 0 means clear for these sizes, on the side of the
    hyperboloid on which the centre is.
    """

    program: Program
    constants: dict[str, float]
    bound: float
    widest: float
    highest: float
    clear_where_positive: bool


def discriminant(
    scaled: ScaledSetting,
    form: FloatFormat,
    entry: Program,
    entry_constants: dict[str, float],
    corner: tuple[Fraction, Fraction],
) -> Discriminant | None:
    """Return the stage for centres with |x|, |y| ≤ corner[0] and |z| ≤ corner[1], in the scene's units.

    Returns None if a constant or a magnitude leaves the format.
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


def exact_constants(scaled: ScaledSetting) -> tuple[Fraction, dict[str, Fraction]]:
    """Return the power of two s, and the constants of the discriminant before they are rounded."""
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


def _bound(program: Program, entry: Program, corner: Mapping[str, Fraction], form: FloatFormat) -> Fraction:
    """Compute γ_k M at the corner. Raises OverflowError if an intermediate number could overflow."""
    whole = Program("stage", _inputs(program, entry), (*entry.steps, *program.steps))
    names = tuple(step.name for step in whole.steps)
    counts = relative_error_counts(whole, names, frozenset(), input_roundings=1)
    values = evaluate(counts.program, EXACT, corner)
    if any(value >= Fraction(2) ** form.greatest for value in values.values()):
        raise OverflowError("an intermediate can overflow")
    magnitude = Fraction(values[str(counts.magnitudes["delta_3"])])
    return gamma(counts.counts["delta_3"], form.unit) * magnitude * SLACK**8


def _inputs(program: Program, entry: Program) -> tuple[str, ...]:
    """Return the inputs of the entry, then those of the program that the entry does not compute."""
    made = {step.name for step in entry.steps}
    return tuple(dict.fromkeys((*entry.inputs, *(name for name in program.inputs if name not in made))))


GEOMETRIC_STEPS = 15
"""So often the exponent is halved: the 2040 octaves with which a search in float64 can begin become a tenth of one."""

SPARE = 10
"""A distance to a pole that is smaller than the pole by so many bits more than the format has changes no answer."""

START = program_of(
    "start",
    ("R", "zz", "height", "PR", "QZ", "AR", "CZ"),
    """
    P = PR * R
    Q = QZ * zz
    r = sqrt R
    ar = AR * r
    cz = CZ * height
    """,
)
"""The program from R, zz and |z| to P, Q, a r and c z."""

HALF = program_of("half", ("pole",), "half = pole / 2")


FALLS = program_of(
    "falls",
    ("ar", "cz", "to_a", "to_b"),
    """
    across = ar / to_a
    along = cz / to_b
    across_squared = across * across
    along_squared = along * along
    along_side = along_squared + 1
    past = across_squared <= along_side
    """,
)
"""The program that computes `past`: whether F ≤ 0 at A + λ = to_a, B − λ = to_b. Then φ is largest at or before λ."""

GEOMETRIC = program_of(
    "geometric", ("low", "high"), "root_low = sqrt low\n root_high = sqrt high\n middle = root_low * root_high"
)
"""The program to the geometric mean, which halves the exponent."""

ARITHMETIC = program_of("arithmetic", ("low", "high"), "sum_of_both = low + high\n middle = sum_of_both / 2")
"""The program to the arithmetic mean, which halves the distance."""

PLACE = program_of(
    "place",
    ("pole", "other", "distance", "near_zero", "inside"),
    tilted.FROM_POLE,
    """
    to_other = other + from_zero
    to_a = is_inside ? to_pole : to_other
    to_b = is_inside ? to_other : to_pole
    minus_from_zero = - from_zero
    lambda_ = is_inside ? minus_from_zero : from_zero
    """,
)
"""The program from `distance`, to 0 (near_zero = 1) or to the pole (0), to λ, A + λ and B − λ."""


PHI = cut(FORMULAS["dual"].program, ("P", "Q", "lambda_", "A_plus_lambda", "B_minus_lambda"), ("above_zero",))
"""The program from P, Q, λ, A + λ and B − λ to `above_zero`, whether φ > 0: the steps of the formula "dual"."""


@dataclass(frozen=True)
class DualSearch:
    """The search of an upright setting: its constants, its number of halvings `steps`, and its limits.

    The constants are A and B, the factors PR, QZ, AR and CZ that lead from R = x² + y², zz = z² and |z| to P, Q, a r
    and c z, and the distances low_a and low_b where the search begins. It answers where R ≤ `widest` and
    zz ≤ `highest`; beyond that a number may overflow.
    """

    constants: dict[str, float]
    steps: int
    widest: float
    highest: float


def search(scaled: ScaledSetting, form: FloatFormat, corner: tuple[Fraction, Fraction]) -> DualSearch:
    """Return the search for centres with |x|, |y| ≤ corner[0] and |z| ≤ corner[1], in the scene's units.

    Raises OverflowError if a constant leaves the format, or if a number computed for such a centre may leave it.
    """
    A, B, bb, dd = scaled.A, scaled.B, scaled.bb, scaled.dd
    if min(A, B) < _least_square(form):
        raise OverflowError(f"the spheroid is so much larger than the hyperboloid that terms are lost in {form.name}")
    widest, highest = _farthest(scaled, form)
    if 2 * (corner[0] * scaled.radial) ** 2 > widest or (corner[1] * scaled.axial) ** 2 > highest:
        raise OverflowError(f"products of the lengths in the region leave {form.name}")
    exact = {
        "A": A,
        "B": B,
        "PR": 1 / bb,
        "QZ": 1 / dd,
    }
    constants = {name: form.rounded(value) for name, value in exact.items()}
    constants["low_a"] = form.rounded(search_begin(A, highest / dd / B, form), "down")
    constants["low_b"] = form.rounded(search_begin(B, widest / bb / A, form), "down")
    # a r = (α/b²) √R and c z = (γ/d²) |z|: square roots of A/b² and B/d², rounded to nearest.
    constants["AR"], constants["CZ"] = _root(A / bb, form), _root(B / dd, form)
    ends = (form.rounded(widest, "down"), form.rounded(highest, "down"))
    return DualSearch(constants, GEOMETRIC_STEPS + form.bits + 3, *ends)


def search_begin(pole: Fraction, steepest: Fraction, form: FloatFormat) -> Fraction:
    """Return the distance to 0 or to the pole at which the search begins (Beginning, above).

    `steepest` is the largest value that P/A, or Q/B, can have.
    """
    beside_pole: Fraction = pole / Fraction(2) ** (form.bits + SPARE)
    return min(beside_pole, 1 / (2 * (1 + steepest)))


def _least_square(form: FloatFormat) -> Fraction:
    """Return the lower limit of A and B: 2^least is far below u times it, and a search begins at a normal number."""
    return Fraction(2) ** (form.least + form.bits + SPARE + 1)


def _farthest(scaled: ScaledSetting, form: FloatFormat) -> tuple[Fraction, Fraction]:
    """Return the greatest R = x² + y² and zz = z² at which no number of the search overflows."""
    A, B, bb, dd = scaled.A, scaled.B, scaled.bb, scaled.dd
    most = Fraction(2) ** (form.greatest - 2)
    P, Q = (most / max(Fraction(1), A, B, 2**8 / own) for own in (A, B))
    return min(most, P * bb), min(most, Q * dd)


def _root(value: Fraction, form: FloatFormat) -> float:
    """Compute √value in the format, with an error of about one unit u at most."""
    shift = 2 * (form.bits + 64)
    exponent = (value.denominator.bit_length() - value.numerator.bit_length()) // 2 * 2 + shift
    whole = isqrt(int(value * Fraction(2) ** exponent))
    return form.rounded(Fraction(whole) / Fraction(2) ** (exponent // 2))


def backward_bound() -> Fraction:
    """Count the units u of backward error that the search can have: half of (k + j) in the section Bound above.

    Products by the units of settings.py are by powers of two and round nothing, so the unscaled entry is counted.
    """
    first, _ = entry(UNSCALED)
    steps = (*first.steps, *(step for step in START.steps if step.name in {"P", "Q"}), *PHI.steps)
    inputs = (*first.inputs, "PR", "QZ", "lambda_", "A_plus_lambda", "B_minus_lambda")
    whole = Program("bound", inputs, tuple(step for step in steps if step.name != "above_zero"))
    positive = frozenset({"PR", "QZ", "A_plus_lambda", "B_minus_lambda"})
    counts = relative_error_counts(whole, ("P_term", "Q_term", "one_plus_lambda"), positive, input_roundings=1).counts
    sums = 2  # P_term − Q_term and the last subtraction
    distances = 1  # λ and a distance to a pole carry three roundings together at most; two are counted as inputs
    on_terms = max(counts["P_term"], counts["Q_term"]) + distances + sums
    on_others = counts["one_plus_lambda"] + 1
    return Fraction(on_terms + on_others, 2)


DoubleDouble = tuple[float, float]
"""The sum of two float64, the second at most half a unit in the last place of the first."""

_LEAST, _GREATEST = Fraction(1, 2**40), Fraction(2**40)
_LEAST_T, _GREATEST_T = Fraction(1, 2**24), Fraction(2**24)
_LEAST_B, _GREATEST_B = Fraction(1, 2**60), Fraction(2**60)
_FARTHEST = Fraction(2**40)
"""The greatest distance of a centre, in units of b."""

_NOTHING = Fraction(1, 2**620)
"""Less than this counts as 0: times 2⁴⁰ b, the farthest centre, it is less than tilted.LOST."""


@dataclass(frozen=True)
class TiltedSearch:
    """The search of a setting whose spheroid is tilted: its constants, errors, number of halvings `steps`, and limits.

    The constants are double-doubles: the frame of a fixed axis, or the sizes p, s, t and b if the axis is `free`.
    `most` is above every number of the frame's rows, and `omega` bounds their relative errors. It answers where
    R = x² + y² ≤ `widest` and zz = z² ≤ `highest`.
    """

    constants: Mapping[str, DoubleDouble]
    free: bool
    most: float
    omega: float
    steps: int
    widest: float
    highest: float


def tilted_search(sizes: Sizes, axis: Point | None) -> TiltedSearch:
    """Return the search for a spheroid of these sizes and this axis, which is free if `axis` is None.

    Raises OverflowError if the sizes are too far apart.
    """
    alpha, gamma, b, d = map(Fraction, sizes)
    p, s, t = (alpha / b) ** 2, (gamma / b) ** 2, (d / b) ** 2
    limits = ((p, _LEAST, _GREATEST), (s, _LEAST, _GREATEST), (t, _LEAST_T, _GREATEST_T), (b, _LEAST_B, _GREATEST_B))
    if not all(least <= value <= greatest for value, least, greatest in limits):
        raise OverflowError(
            "where a spheroid is tilted, alpha/b and gamma/b must be from 2^-20 to 2^20, d/b from 2^-12 to 2^12 and b "
            "from 2^-60 to 2^60"
        )
    exact = dict(zip(tilted.SIZE_NAMES, (p, s, t, b), strict=True))
    constants = exact if axis is None else frame_of(axis, exact)
    end = float((_FARTHEST * b) ** 2)
    free = axis is None
    return TiltedSearch(
        constants={name: split(value) for name, value in constants.items()},
        free=free,
        most=_most(t) / float(b),
        omega=tilted.OMEGA["free" if free else "fixed"],
        steps=tilted.GEOMETRIC_STEPS + tilted.ARITHMETIC_STEPS,
        widest=end,
        highest=end,
    )


def _most(t: Fraction) -> float:
    """Return a bound, times b, of every number of the rows at any axis.

    Each row is a column of an inverse square root of the matrix M of the spheroid:
    |rᵢ|² = r̂ᵀ M r̂ for a unit vector r̂ of M's own metric is at most the greatest eigenvalue of M, 1 or 1/t.
    """
    return 2.0 * float(max(Fraction(1), 1 / t))


def frame_of(axis: Point, sizes: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """Compute the frame of an axis: each number within a relative 2⁻²⁰⁰, or within 2⁻⁴⁰⁰ of 0."""
    vx, vy, vz = map(Fraction, axis)
    hx, hy = (vx, vy) if vx or vy else (Fraction(1), Fraction(0))
    values = outputs(
        tilted.FRAME, _PRECISE, {"hx": hx, "hy": hy, "vx": vx, "vy": vy, "vz": vz, **sizes}, tilted.FRAME_NAMES
    )
    return dict(zip(tilted.FRAME_NAMES, values, strict=True))


def split(value: Fraction) -> DoubleDouble:
    """Return the double-double nearest to a number; 0 if the number is so small that LOST covers it."""
    if abs(value) < _NOTHING:
        return 0.0, 0.0
    high = float(value)
    return high, float(value - Fraction(high))


_BITS = 512
"""The significant bits of numbers in _PRECISE."""


def _short(value: Fraction) -> Fraction:
    """Round a number to about _BITS significant bits."""
    step = Fraction(2) ** (value.numerator.bit_length() - value.denominator.bit_length() - _BITS)
    return round(value / step) * step


def _precise_root(value: Fraction) -> Fraction:
    """Compute a square root to about _BITS significant bits."""
    half = (value.denominator.bit_length() - value.numerator.bit_length()) // 2 + _BITS
    return Fraction(isqrt(int(value * Fraction(4) ** half))) / Fraction(2) ** half


_PRECISE = Arithmetic(
    name="precise",
    convert=Fraction,
    operations={
        **OPERATORS,
        "mul": lambda one, other: _short(one * other),
        "div": lambda dividend, divisor: _short(dividend / divisor),
        "sqrt": _precise_root,
        "select": lambda condition, yes, no: yes if condition else no,
    },
)
"""The arithmetic in which the frame of a fixed axis is computed: fractions, rounded to about _BITS bits."""
