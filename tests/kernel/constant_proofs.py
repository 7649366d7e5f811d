"""For each constant of hypcheck.h: whether its derivation holds with a value in its place, in rational arithmetic.

A constant that bounds an error is covered by what the derivation counts, and is not twice as large as that. A constant
that limits a range may be any for which nothing is lost or overflows within it: another one of these leaves more rows,
or fewer, to the exact stages.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

from hypcheck.derivation.program import cut, program_of
from hypcheck.derivation.rounding import gamma, relative_error_counts
from hypcheck.kernel.programs import fixed
from tests.support.inside import (
    CERTIFIED,
    CERTIFIED_CONSTANTS,
    CONSTANTS,
    TILTED,
    certified,
    core,
    generate,
    lines,
    tilted,
)

U = Fraction(certified.U)
GREATEST, LEAST_NORMAL = Fraction(sys.float_info.max), Fraction(sys.float_info.min)
CAP, GREATEST_SLOPE, LEAST_CONSTANT = (
    Fraction(each) for each in (lines.CAP, lines.GREATEST_SLOPE, lines.LEAST_CONSTANT)
)
LEVEL = Path(core.__file__).parent / "parts" / "level.h"

Proof = Callable[[Fraction], bool]


def covers(needed: Fraction) -> Proof:
    """The bound of an error: at least what is needed, and less than twice that."""
    return lambda value: needed <= value < 2 * needed


def _count(program: str, step: str) -> Fraction:
    """The bound that the roundings counted in a step need, with one unit for the second order."""
    found = {"certified": CERTIFIED, "single": certified.SINGLE}[program]
    return (relative_error_counts(found, [step]).counts[step] + 1) * U


def _parts(names: tuple[str, ...], known: tuple[str, ...]) -> Fraction:
    """The most that the roundings of these steps can do, counted from what is known."""
    counts = (relative_error_counts(cut(CERTIFIED, known, (name,)), (name,)).counts[name] for name in names)
    return gamma(max(counts), U)


def _tilted(name: str) -> Fraction:
    """The roundings of a value of a tilted row, and one unit for what underflows."""
    return gamma(tilted.counted().counts[name], U) + U


def _less_sure(value: Fraction) -> bool:
    """Below it by no more than a thousandth, and by more than what both sides of its comparison are rounded by."""
    known = ("minus_F_least", "d_least", "psi", "e_psi", "p", "s_along", "t")
    part = cut(TILTED, known, ("room", "slope_most"))
    counts = relative_error_counts(part, ("room", "slope_most")).counts
    count = counts["room"] + counts["slope_most"] + 2  # the product with it, and s_along
    return 1 - Fraction(1, 1000) < value <= (1 - U) ** count


def _greatest_l(value: Fraction) -> bool:
    """With the squares at their limits no value overflows, and what underflows is within a unit of the least bound."""
    square, far = (Fraction(CONSTANTS[name]) for name in ("greatest_square", "farthest_square"))
    p = s = t = square
    k = p * s + value * (s * (t + 1) + p * (t + 1) + t * value)
    d, m = (p + value) * k, t * far + (t + 1) * far
    g = s * far + p * far + value * m
    N, N_slope = value * (t + 1) * (s + p) * far + (p + value) * g, (t + 1) * (s + p) * far + g + (p + value) * m
    k_slope = s * (t + 1) + p * (t + 1) + 2 * t * value
    psi = d * (N + value * N_slope + d) + value * N * (k + (p + value) * k_slope)
    least = Fraction(CONSTANTS["least_square"])
    lost = LEAST_NORMAL * 2 * psi * Fraction(CONSTANTS["greatest_axis"])
    return psi * (p + s * (t + 1) / least) < GREATEST and lost < U * least**6


def _lost(value: Fraction) -> bool:
    """It covers what a number and the 4 products in its bound lose at most, a least normal number each, 2¹⁰ times.

    The room is for a quotient, whose bound is divided by less than 1: what its product loses is below 2⁻²⁰ of a bound
    of 2⁻¹⁰⁰⁰, which that already has.
    """
    return 5 * LEAST_NORMAL * 2**10 <= value <= LEAST_CONSTANT**3


def _height(value: Fraction) -> bool:
    """What underflows in its square is below a unit of it, and what is above `cap` is left to the next stage."""
    return 2 * LEAST_NORMAL < U * value**2 and value**2 < CAP and GREATEST_SLOPE * value**2 < GREATEST


def _seen(value: Fraction) -> bool:
    """What contract.h says of a time: 2⁻⁴³ (1 + S) larger there is contact, the slack of the centre included."""
    return (value + 1) * Fraction(CERTIFIED_CONSTANTS["u_4"]) * (1 + 20 * U) <= Fraction(1, 2**43)


def widths() -> list[int]:
    """Doubles in a vector of each level."""
    return [int(each) for each in re.findall(r"#define HC_WIDTH (\d+)", LEVEL.read_text(encoding="utf-8"))]


def _sweep(value: Fraction) -> bool:
    """Coordinates of a sweep below it keep x² + y² + z² below `cap`, whatever the time."""
    return 3 * (2 * value) ** 2 < CAP


_TOUCH = program_of(
    "touch",
    ("alpha", "b", "d", "x", "y", "scale", "T", "S"),
    """
    bd = b * d
    sizes = 1 / bd
    per_b = sizes * d
    a = alpha * per_b
    A = a * a
    TS = T * S
    poles = 1 / TS
    per_T = poles * S
    to_radius = A * per_T
    shrunk = 1 / scale
    x_share = x * shrunk
    y_share = y * shrunk
    xx = x_share * x_share
    yy = y_share * y_share
    square = xx + yy
    length = sqrt square
    off = scale * length
    r = off * per_b
    radius = to_radius * r
    metres = radius * b
    inverse = 1 / length
    cosine = x_share * inverse
    place = metres * cosine
""",
)
"""The longest way to a coordinate of a place of touch in core/parts/near_level.h."""


def _rounded() -> Fraction:
    """Its roundings; a root in plain C is within three units and not one, and is met twice."""
    count = relative_error_counts(_TOUCH, ("place",), positive=set(_TOUCH.inputs)).counts["place"]
    return gamma(count + 4, U) + U


def _cut_bits(value: Fraction) -> bool:
    """4 I³ − J² of coefficients up to 2ⁿ, each off by less than 1, is off by less than 2^(5n+20); the pool has room."""
    n = int(value)
    most = 2**n
    off_I, off_J = 16 * (2 * most + 1), 137 * (3 * most**2 + 3 * most + 1)
    I, J = 16 * most**2, 137 * most**3  # noqa: E741 - the names of the invariants
    off = 4 * (3 * I**2 * off_I + 3 * I * off_I**2 + off_I**3) + 2 * J * off_J + off_J**2
    return off < 2 ** (5 * n + 20) and n <= generate.CUT_BITS + 63


def _tangency_bits(value: Fraction) -> bool:
    """Lengths below 2ⁿ: x² + y² less squares has 127 bits, and what is compared in 256 has 255, M and e being 2¹²⁵."""
    n, guess = int(value), 2**125
    square = 2 ** (2 * n)
    n2 = 2 * square * square + 2 * square * square
    return 2 * square <= 2**127 and n2 + 2 * square * guess + guess**2 < 2**255 and n - 53 < 64


def _hair(value: Fraction) -> bool:
    """A z below γ times it widens α by less than 2b, which is 2⁻⁶¹ α at least; so do x and y below b times it."""
    return 0 < value and value**2 / 2 < Fraction(1, 2**61) and 2 * value < 2


PROOFS: dict[str, Proof] = {
    "u_4": covers(_parts(("h1", "h2", "h3"), ("c0", "c1", "c2"))),
    "u_8": covers(_count("certified", "c2")),
    "u_12": covers(_count("certified", "c1")),
    "u_16": covers(_parts(("slope_A", "slope_B", "offset_A", "offset_B"), ("c1", "c2"))),
    "u_1536": covers(32 * _count("single", "delta_3")),
    **{f"u_{name}": covers(_tilted(name)) for name in tilted.BOUNDED},
    "less_sure": _less_sure,
    "greatest_l": _greatest_l,
    "lost": _lost,
    "least_height": _height,
    "greatest_height": _height,
    "less_than": lambda value: 1 - Fraction(1, 1000) < value <= (1 - U) ** 4,
    "WIDEST": lambda value: value == math.lcm(*widths()),
    "FARTHEST_SWEEP": _sweep,
    "SEEN": _seen,
    "rounded": covers(_rounded()),
    "least_offset": lambda value: LEAST_NORMAL <= value <= Fraction(lines.LEAST_SIZE),
    "CUT_BITS": _cut_bits,
    "TANGENCY_BITS": _tangency_bits,
    "HAIR": _hair,
    "MOST_GROWN": lambda value: 0 < value <= 127 - max(fixed.ERRORS.values()).bit_length(),
    "GREATEST_SLACK": lambda value: 0 < value < 1,
    **{f"fixed_{name}": lambda value, worst=worst: value == worst for name, worst in fixed.ERRORS.items()},
}
"""By the name of a constant, without HC_: whether the derivation holds with a value."""
