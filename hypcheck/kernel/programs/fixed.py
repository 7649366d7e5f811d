"""The programs of the stage before the integers: the same rule in 128-bit fixed point, with a bound of the lost bits.

p, q, s, t are the squares of α, b, γ, d, R = x² + y² and S = z². n2 and n1 are N c2 and N c1, with N = q t and c2, c1
the coefficients of the cubic g; ps = p s is −N c0. Δ is the discriminant of g, A and B are p/q and s/t.

Each number is a whole number of units, in two's complement; a product keeps the highest 128 of its 256 bits. Nothing is
rounded by the machine's floats, so one bound holds under every rounding mode.

Units. Lengths of one kind (α, b, x, y, or γ, d, z) are measured by the power of two above the longest of them, so each
square is below 1; it is a number of units of 2⁻¹²⁶, and at most one unit of it is cut off. `whole_p` is p times the
power of four that makes it at least 1/4: nothing of it is cut off, so N, ps and the factors of n2 are as exact for
short lengths as for long ones. A product of numbers in units of 2⁻ᶠ and 2⁻ᵍ is in units of 2¹²⁸⁻ᶠ⁻ᵍ.

Balance. The discriminants of g(λ) and g(2ᵏλ) have the same sign; so N, n2, n1, ps may be multiplied by 2^(3k+a),
2^(2k+a), 2^(k+a) and 2^a. Any k and a are right. With 2ᵏ near |n1/n2|, which is within a factor of two of a double
root, n2, n1 and ps become about 1, the unit is 2⁻¹²⁵, and the discriminant, a sum of three terms of one size, keeps
some 100 bits. If n2 or n1 is multiplied by 2^grown in that, so is its error.

`errors` follows through every step how much is cut off and how large a number can be, in whole units. ERRORS has the
bounds for the numbers that the stage compares with 0; those of `delta` and `middle` are multiplied by 2^grown.

What decides. `delta` is that of INTEGERS, 3 N⁴ Δ; `middle` is 27 N³ g(−c2/3), g at its inflection. Near a tangency the
two lower roots are close and the third is not: `middle` < 0. On the ring and near it the two upper ones are close,
delta vanishes, and `middle` > 0 is a proof of exterior where −c2/3 lies in (0, B). The signs at the poles prove contact
whatever delta is, where they contradict a clear position (docs/mathematics.md, "The coefficient rule for all regimes").
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from hypcheck.derivation.program import Argument, Program, cut, program_of, steps_of
from hypcheck.kernel.programs.integers import INTEGERS

BITS = 128
SQUARE, BALANCED = 126, 125
"""A square is a number of units of 2⁻¹²⁶, so N, n2, n1 and ps are of 2⁻¹²⁴; balanced they are of 2⁻¹²⁵."""

MOST_GROWN = 100
"""The greatest `grown`: n2 and n1 may be multiplied by 2^100 at most."""

WHOLE = {"whole_p": "p", "whole_q": "q", "whole_s": "s", "whole_t": "t"}
"""The squares from which nothing is cut off, each with the square that it is a multiple of."""

TERMS = program_of(
    "fixed-terms",
    ("p", "q", "s", "t", "xx", "yy", "S", *WHOLE),
    """
    R = xx + yy
    p_plus_q = p + q
    p_q_R = p_plus_q - R
    radial_2 = p_q_R * whole_t
    s_plus_S = s + S
    axial_2 = s_plus_S * whole_q
    t_minus_s = t - s
    t_s_S = t_minus_s - S
    axial_1 = t_s_S * p
    R_minus_q = R - q
    radial_1 = R_minus_q * s
    n1 = axial_1 + radial_1
    N = whole_q * whole_t
    ps = whole_p * whole_s
    p_t = p * whole_t
    s_t = s * whole_t
    q_s = s * whole_q
    p_q = p * whole_q
""",
)
"""The program of the coefficients. Results with the factor `whole_t` are then divided by a power of two, those with
`whole_q` by another; one of the two is 1."""

TERM_RESULTS = ("R", "radial_2", "axial_2", "n1", "N", "ps")

_BALANCED = ("N", "n2", "n1", "ps")

DISCRIMINANT = Program(
    "fixed-discriminant",
    _BALANCED,
    cut(INTEGERS, _BALANCED, ("delta",)).steps
    + steps_of("""
    n2_h1 = n2 * h1
    n2_h1_2 = 2 * n2_h1
    N_h2 = N * h2
    N_h2_3 = 3 * N_h2
    middle = n2_h1_2 - N_h2_3
"""),
)
"""The program that computes delta = 3 N⁴ Δ and middle = 27 N³ g(−c2/3)."""

POLES = program_of(
    "fixed-poles",
    ("n2", "p_t", "q_s", "s_t", "p_q", "p", "q", "s", "t", "R", "S"),
    """
    q_s_3 = 3 * q_s
    offset_at_B = q_s_3 + n2
    p_t_q_s = p_t + q_s
    t_plus_s = t + s
    rise_at_B = p_t_q_s * t_plus_s
    q_s_2 = 2 * q_s
    p_t_q_s_2 = p_t + q_s_2
    axial_fall = p_t_q_s_2 * S
    radial_fall = s_t * R
    rise_less_axial = rise_at_B - axial_fall
    slope_at_B = rise_less_axial - radial_fall
    p_t_3 = 3 * p_t
    offset_at_A = p_t_3 - n2
    p_t_2 = 2 * p_t
    p_t_2_q_s = p_t_2 + q_s
    radial_rise = p_t_2_q_s * R
    axial_rise = p_q * S
    p_less_q = p - q
    width_at_A = p_less_q * p_t_q_s
    rise_at_A = radial_rise + axial_rise
    slope_at_A = rise_at_A + width_at_A
""",
)
"""The program of the slopes q t² g'(B), q² t g'(−A) and the offsets q t (3B + c2), q t (3A − c2) at the poles: those of
INTEGERS without a common factor t or q."""


@dataclass(frozen=True, slots=True)
class Range:
    """The range of a computed number: from `low` to `high` units. Its error is from `under` to `over` units."""

    low: int
    high: int
    under: int = 0
    over: int = 0

    @property
    def error(self) -> int:
        """The most that the number differs from the exact value."""
        return max(-self.under, self.over)


def errors(program: Program, inputs: Mapping[str, Range]) -> dict[str, Range]:
    """Return the range of every input and step of the program, by name.

    Raises ValueError if a number may leave the 128 bits (unsigned if it is never negative), and for an operation that
    fixed point does not have.
    """
    known = dict(inputs)

    def of(argument: Argument) -> Range:
        return known[argument] if isinstance(argument, str) else Range(argument, argument)

    for step in program.steps:
        left, right = (of(argument) for argument in step.arguments)
        rule = _RULES.get("scale" if isinstance(step.arguments[0], int) else step.operation)
        if rule is None:
            raise ValueError(
                f"program {program.name}: step {step.name}: {step.operation} is not an operation in fixed point"
            )
        value = rule(left, right)
        limit = 2 ** (BITS - (value.low < 0))
        if value.high >= limit or value.low < -limit:
            raise ValueError(f"program {program.name}: step {step.name} may leave {BITS} bits")
        known[step.name] = value
    return known


def _sum(left: Range, right: Range) -> Range:
    """Return the range of a sum."""
    return Range(left.low + right.low, left.high + right.high, left.under + right.under, left.over + right.over)


def _negative(number: Range) -> Range:
    """Return the range of the number with the other sign."""
    return Range(-number.high, -number.low, -number.over, -number.under)


def _scaled(factor: Range, number: Range) -> Range:
    """Return the range of a product with a positive integer, which rounds nothing."""
    k = factor.low
    return Range(k * number.low, k * number.high, k * number.under, k * number.over)


CUT = 3
"""So many units a product can lose: it omits the product of both lower halves, and the lower halves of the two mixed
products."""


def _product(left: Range, right: Range) -> Range:
    """Return the range of a product, of which 128 bits are cut off, rounded down, and up to CUT units more.

    With â = a + ea and b̂ = b + eb the computed factors, âb̂ − ab = â eb + b̂ ea − ea eb.
    """
    values = [a * b for a in (left.low, left.high) for b in (right.low, right.high)]
    mixed = [a * e for a in (left.low, left.high) for e in (right.under, right.over)]
    other = [b * e for b in (right.low, right.high) for e in (left.under, left.over)]
    both = [d * e for d in (left.under, left.over) for e in (right.under, right.over)]
    scale = 2**BITS
    low = min(values) // scale - CUT
    return Range(
        low if min(values) < 0 else max(0, low),
        max(values) // scale,
        (min(mixed) + min(other) - max(both)) // scale - CUT,
        -(-(max(mixed) + max(other) - min(both)) // scale),
    )


_RULES: dict[str, Callable[[Range, Range], Range]] = {
    "add": _sum,
    "sub": lambda left, right: _sum(left, _negative(right)),
    "mul": _product,
    "scale": _scaled,
}


def moved_down(number: Range) -> Range:
    """Return the range of the number divided by any power of two, 1 included, and rounded down."""
    return Range(min(0, number.low), max(0, number.high), min(0, number.under) - 1, max(0, number.over))


def _terms() -> dict[str, Range]:
    """Return the ranges in TERMS, whose results are then moved down by shifts."""
    most = (2**53 - 1) ** 2 * 2 ** (SQUARE - 106)
    square, whole = Range(0, most, -1, 0), Range(2 ** (SQUARE - 2), most)
    terms = errors(TERMS, {name: whole if name in WHOLE else square for name in TERMS.inputs})
    for name in ("radial_2", "axial_2", "p_t", "s_t", "q_s", "p_q"):
        terms[name] = moved_down(terms[name])
    return terms


def _balanced(terms: Mapping[str, Range], grown: int) -> dict[str, Range]:
    """Return the ranges of the inputs of DISCRIMINANT, below 2^125 in size.

    N and ps are doubled, n2 and n1 multiplied by up to 2^grown.
    """

    def moved(number: Range, factor: int) -> Range:
        most = 2**BALANCED
        return Range(-most if number.low < 0 else 0, most, factor * number.under - 1, factor * number.over)

    return {name: moved(terms[name], 2**grown if name in {"n2", "n1"} else 2) for name in _BALANCED}


def _ranges() -> dict[str, dict[str, Range]]:
    """Return the ranges of all numbers of TERMS, DISCRIMINANT and POLES."""
    terms = _terms()
    terms["n2"] = _sum(terms["radial_2"], _negative(terms["axial_2"]))
    poles = errors(POLES, {name: terms[name] for name in POLES.inputs})
    return {"terms": terms, "discriminant": errors(DISCRIMINANT, _balanced(terms, 0)), "poles": poles}


RANGES = _ranges()
"""By program, the range of each number: the printer reads whether it is ever negative."""


def _errors() -> dict[str, int]:
    """Compute ERRORS.

    An error is at most c0 + c1 2^grown + c2 4^grown with c0, c1, c2 ≥ 0, so divided by 2^grown it is largest at an end.
    """
    terms, poles = RANGES["terms"], RANGES["poles"]
    grown = {end: errors(DISCRIMINANT, _balanced(terms, end)) for end in (0, MOST_GROWN)}
    return {
        "coefficient": max(terms[name].error for name in ("n2", "n1")),
        "pole": max(poles[f"{part}_at_{pole}"].error for part in ("offset", "slope") for pole in "AB"),
        **{
            name: max(-(-of_terms[name].error // 2**end) for end, of_terms in grown.items())
            for name in ("delta", "middle")
        },
    }


ERRORS = _errors()
"""The greatest errors, in units: of n2 and n1, of offsets and slopes at the poles, and, to be multiplied by 2^grown, of
delta and of middle."""
