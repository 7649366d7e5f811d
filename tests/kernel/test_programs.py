"""The kernel's programs: the formulas in them, the roundings that their constants allow for, terms of the bounds."""

from __future__ import annotations

from fractions import Fraction

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from hypcheck.derivation.evaluation import EXACT, evaluate, outputs
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.pencil import SYMBOLIC, A, B, P, Q
from hypcheck.derivation.program import cut, needed
from hypcheck.derivation.rounding import gamma, relative_error_counts
from hypcheck.geometry.pair import COLUMNS
from tests.support.inside import CERTIFIED, CERTIFIED_CONSTANTS, INTEGERS, SLACK, bits_counted, certified, lines

U = Fraction(certified.U)
WITHOUT_MARGINS = {"u_8": 0, "more": 1, "less": 1}
positives = st.fractions(Fraction(1, 64), 64, max_denominator=64)
sevens = st.tuples(*[positives] * 7)


@pytest.mark.parametrize("program", [CERTIFIED, certified.SINGLE], ids=lambda program: program.name)
def test_the_discriminant_of_the_kernel_programs_is_that_of_the_proved_formula(program):
    """Step for step the discriminant of the formula "hessian", which the derivation proves equal to g's."""
    proved = needed(FORMULAS["hessian"].program, ("delta_3", "c1", "c2", "c0"))
    assert needed(program, ("delta_3", "c1", "c2", "c0")) == proved


def test_the_magnitude_of_the_discriminant_is_at_most_the_product_in_its_error_bound():
    """The counted magnitude of 3Δ is 4 H1 H3 + H2²; 32 (M2 M1)² less that has no negative coefficient."""
    a, c, r, h = sympy.symbols("a c r h", positive=True)
    zero, one = sympy.Integer(0), sympy.Integer(1)
    row = dict(zip(COLUMNS, (a, c, one, one, r, zero, h), strict=True)) | certified.SINGLE_CONSTANTS
    counted = relative_error_counts(certified.SINGLE, ("delta_3",))
    (magnitude,) = outputs(counted.program, SYMBOLIC, row, (counted.magnitudes["delta_3"],))
    (product_squared,) = outputs(certified.SINGLE, SYMBOLIC, row, ("product_squared",))
    assert min(sympy.Poly(sympy.expand(32 * product_squared - magnitude), a, c, r, h).coeffs()) > 0


@pytest.mark.slow
@given(sevens)
def test_terms_of_the_error_bounds_are_the_counted_magnitudes(values):
    row = dict(zip(COLUMNS, values, strict=True))
    inputs = {**row, **CERTIFIED_CONSTANTS, **certified.SINGLE_CONSTANTS}
    for program, names in (
        (CERTIFIED, {"c1": "terms_1", "c2": "terms_2", "c0": "AB"}),
        (certified.SINGLE, {"c1": "M1", "c2": "M2"}),
    ):
        counted = relative_error_counts(program, tuple(names))
        magnitudes = evaluate(counted.program, EXACT, inputs)
        written = evaluate(program, EXACT, inputs)
        for step, name in names.items():
            assert written[name] == magnitudes[counted.magnitudes[step]]


letters = {name: sympy.Symbol(name, positive=True) for name in ("e0", "e1", "e2", "m0", "m1", "m2", "u_4")}


@pytest.mark.parametrize("step", ["E1", "E2", "E3", "E"])
def test_error_bounds_of_the_discriminant_are_those_of_the_kernel_page(step):
    e0, e1, e2, m0, m1, m2, u4 = letters.values()
    a1, a2, a3, E1, E2, E3 = (sympy.Symbol(name, positive=True) for name in ("a1", "a2", "a3", "E1", "E2", "E3"))
    page = {
        "E1": 2 * m2 * e2 + 3 * e1 + u4 * (m2**2 + 3 * m1),
        "E2": m2 * e1 + m1 * e2 + 9 * e0 + u4 * (m2 * m1 + 9 * m0),
        "E3": 2 * m1 * e1 + 3 * (m2 * e0 + m0 * e2) + u4 * (m1**2 + 3 * m2 * m0),
        "E": 4 * (a1 * E3 + a3 * E1) + 2 * a2 * E2 + u4 * (4 * a1 * a3 + a2**2),
    }
    known = tuple(letters) if step != "E" else ("a1", "a2", "a3", "E1", "E2", "E3", "u_4", "slack")
    part = cut(CERTIFIED, known, (step,))
    inputs = {**letters, **{str(s): s for s in (a1, a2, a3, E1, E2, E3)}, "slack": sympy.Integer(1)}
    (value,) = outputs(part, SYMBOLIC, inputs, (step,))
    assert sympy.expand(value - page[step]) == 0


def test_rounding_of_the_certified_error_bounds_is_within_their_slack():
    """Counted from the numbers they are built on, which are not negative, every bound has fewer than 100 factors."""
    known = ("A", "B", "AB", "BP", "AQ", "P", "Q", "c1", "c2", "h1", "h2", "h3", *CERTIFIED_CONSTANTS)
    for step in ("E", "bound_A", "bound_B", "offset_bound_A", "offset_bound_B", "e1", "e2"):
        part = cut(CERTIFIED, known, (step,))
        counts = relative_error_counts(part, (step,), positive=set(part.inputs) - {"c1", "c2", "h1", "h2", "h3"})
        assert counts.counts[step] < 100
        assert (1 - U) ** -100 < Fraction(SLACK)


@pytest.mark.slow
@given(sevens, st.fractions(Fraction(1, 64), 8, max_denominator=64))
def test_tangent_lines_of_the_kernel_programs_have_the_formulas_of_the_kernel_page(values, multiplier):
    alpha, gamma_, b, d = values[:4]
    a, c = alpha / b, gamma_ / d
    sizes = dict(zip(COLUMNS, values, strict=True)) | WITHOUT_MARGINS
    if multiplier != c**2:
        K, M = outputs(lines.TANGENT_BEYOND, EXACT, sizes | {"lambda_": multiplier}, ("K_most", "M_most"))
        assert K == b**2 * (a**2 + multiplier) * (1 + 1 / multiplier)
        assert M == (b / d) ** 2 * (a**2 + multiplier) / (c**2 - multiplier)
    K, M = outputs(lines.TANGENT_WITHIN, EXACT, sizes | {"mu": multiplier}, ("K_least", "M_least"))
    assert K == b**2 * (a**2 - multiplier) * (1 - 1 / multiplier)
    assert M == (b / d) ** 2 * (a**2 - multiplier) / (c**2 + multiplier)
    fall, M_high = outputs(lines.TANGENT_HIGH, EXACT, sizes | {"mu": multiplier}, ("fall_most", "M_least"))
    assert (fall, M_high) == (-K, M)


@pytest.mark.slow
@given(st.tuples(*[st.fractions(-8, 8, max_denominator=64)] * 7), positives, st.sampled_from([1, -1]))
def test_the_piece_program_gives_the_offset_of_a_sweep_from_a_line_as_a_quadratic(numbers, M, side):
    x, y, z, u, v, w, K = numbers
    inputs = dict(zip(("x", "y", "z", "u", "v", "w", "K"), numbers, strict=True)) | {"M": M, "side": side, "u_8": 0}
    here, slope, bend = outputs(lines.PIECE, EXACT, inputs, ("here", "slope", "bend"))
    for s in (Fraction(0), Fraction(1, 3), Fraction(1)):
        R, T = (x + s * u) ** 2 + (y + s * v) ** 2, (z + s * w) ** 2
        assert here + 2 * slope * s + bend * s * s == side * (R - M * T - K)


@pytest.mark.parametrize("part", ["", "_slope", "_bend"])
def test_the_error_that_the_piece_program_subtracts_covers_its_roundings(part):
    """4 factors in the gap, as many in the size, one for the difference: fewer than the 8 of u_8."""
    gap, size = f"gap{part}", f"size{part or '_here'}"
    count = relative_error_counts(lines.PIECE, [gap], positive={"M"}).counts[gap]
    assert count <= 4
    counted = relative_error_counts(cut(lines.PIECE, ("K", "R", "rise"), (size,)) if not part else lines.PIECE, [size])
    assert counted.counts[size] <= 4
    assert gamma(count, U) + U < Fraction(CERTIFIED_CONSTANTS["u_8"]) * (1 - gamma(5, U)) - 2 * U


@pytest.mark.parametrize(
    ("program", "step", "most"),
    [
        (lines.ONE_LINE, "R", 2),
        (lines.ONE_LINE, "line_beyond_0", 3),
        (lines.TWO_LINES, "line_above_2", 3),
        (lines.TANGENT_BEYOND, "K", 6),
        (lines.TANGENT_BEYOND, "across", 3),
        (lines.TANGENT_BEYOND, "gap_terms", 3),
        (lines.TANGENT_WITHIN, "across_terms", 3),
        (lines.TANGENT_WITHIN, "along", 3),
        (lines.TANGENT_HIGH, "one_minus_mu", 1),
        (lines.TANGENT_HIGH, "across_terms", 3),
        (lines.TANGENT_HIGH, "along", 3),
        (lines.CHORD, "line_0", 2),
    ],
)
def test_roundings_of_the_comparison_with_a_line_are_within_its_margins(program, step, most):
    """The comparison has 2 + 3 factors, a tangent's constants 8 and a chord's check 2 + 2: all within 2 MARGIN."""
    positive = {*program.inputs} - {"x", "y", "z"}
    assert relative_error_counts(program, [step], positive=positive).counts[step] <= most
    assert Fraction(lines.MARGIN) == 16 * U
    assert Fraction(lines.LESS) * (1 + 15 * U) <= 1 - 16 * U
    assert Fraction(lines.MORE) * (1 - 15 * U) >= 1 + 16 * U


def test_the_margin_of_thresholds_in_single_precision_covers_their_roundings():
    """4 factors on R and on M T, the rounding of x, y, z included, and one more: 5, and MARGIN is three times that."""
    plane, compared = lines.PLANE, lines.PARALLEL_LINES
    u, of_inputs = Fraction(lines.FLOAT32_U), 2
    counts = relative_error_counts(plane, ["R", "T"]).counts
    assert (counts["R"] + of_inputs, counts["T"] + of_inputs) == (4, 3)
    for step in ("outer", "inner"):
        after = relative_error_counts(compared, [step]).counts[step]
        assert after == 2  # of which R has the difference's alone
        assert gamma(max(counts["R"] + of_inputs + 1, counts["T"] + of_inputs + after), u) < 6 * u
    assert Fraction(lines.FLOAT32_MARGIN) == 16 * u
    assert Fraction(lines.FLOAT32_LESS) * (1 + 6 * u) < 1


def test_the_integers_program_gives_the_cubic_times_squares_of_b_and_d():
    names = ("N", "n2", "n1", "ps", "delta", "slope_at_B", "slope_at_A", "ring_excess", "offset_at_A", "offset_at_B")
    # With b = d = 1: alpha = a, gamma = c, x² = P, z² = Q.
    a, c, r, h = sympy.symbols("a c r h", positive=True)
    inputs = {
        "alpha": a,
        "gamma": c,
        "b": sympy.Integer(1),
        "d": sympy.Integer(1),
        "x": r,
        "y": sympy.Integer(0),
        "z": h,
    }
    N, n2, n1, ps, delta, at_B, at_A, ring, offset_A, offset_B = outputs(INTEGERS, SYMBOLIC, inputs, names)
    here = {A: a**2, B: c**2, P: r**2, Q: h**2}
    c2 = (A - B + 1 - P - Q).subs(here)
    c1 = (-A * B + A - B + B * P - A * Q).subs(here)
    t = sympy.Symbol("t")
    g = t**3 + c2 * t**2 + c1 * t - (A * B).subs(here)
    expected = {
        N: 1,
        n2: c2,
        n1: c1,
        ps: a**2 * c**2,
        delta: 3 * sympy.discriminant(g, t),
        at_B: sympy.diff(g, t).subs(t, c**2),
        at_A: sympy.diff(g, t).subs(t, -(a**2)),
        ring: c**4 - a**2,
        offset_A: 3 * a**2 - c2,
        offset_B: 3 * c**2 + c2,
    }
    for found, right in expected.items():
        assert sympy.expand(found - right) == 0


@settings(max_examples=30)
@given(sevens)
def test_each_value_of_the_integers_program_has_the_stated_powers_of_b_and_d(values):
    alpha, gamma_, b, d, x, y, z = values
    q, t = b * b, d * d
    N, A_, B_ = q * t, alpha**2 / q, gamma_**2 / t
    P_, Q_ = (x * x + y * y) / q, z * z / t
    c2, c1, c0 = A_ - B_ + 1 - P_ - Q_, -A_ * B_ + A_ - B_ + B_ * P_ - A_ * Q_, -A_ * B_
    expected = {
        "N": N,
        "n2": N * c2,
        "n1": N * c1,
        "ps": -N * c0,
        "delta": N**4 * (4 * (c2**2 - 3 * c1) * (c1**2 - 3 * c2 * c0) - (c2 * c1 - 9 * c0) ** 2),
        "slope_at_B": N * t * t * (3 * B_**2 + 2 * c2 * B_ + c1),
        "slope_at_A": N * q * q * (3 * A_**2 - 2 * c2 * A_ + c1),
        "offset_at_B": N * t * (3 * B_ + c2),
        "offset_at_A": N * q * (3 * A_ - c2),
        "ring_excess": q * t * t * (B_**2 - A_),
    }
    found = evaluate(INTEGERS, EXACT, dict(zip(COLUMNS, values, strict=True)))
    assert {name: found[name] for name in expected} == expected


@given(st.tuples(*[st.integers(-(2**40), 2**40)] * 7))
def test_no_value_of_the_integers_program_is_longer_than_counted(values):
    counted = bits_counted(INTEGERS, 41)
    for name, value in evaluate(INTEGERS, EXACT, dict(zip(COLUMNS, values, strict=True))).items():
        assert int(value).bit_length() <= counted[name]
