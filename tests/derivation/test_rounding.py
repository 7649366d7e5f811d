"""Counted rounding bounds against exact rationals: never exceeded, nearly reached, refused where none is derived."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hypcheck.derivation.evaluation import EXACT, evaluate
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.program import OPERATIONS, program_of
from hypcheck.derivation.rounding import gamma, relative_error_counts
from hypcheck.geometry.pair import COLUMNS

UNIT = {"float16": Fraction(1, 2**11), "float32": Fraction(1, 2**24), "float64": Fraction(1, 2**53)}
TINIEST_NORMAL = {"float16": Fraction(1, 2**14), "float32": Fraction(1, 2**126), "float64": Fraction(1, 2**1022)}
NUMBERS = {
    "table-2": ("c0", "c1", "c2", "delta"),
    "procedure-1": ("c0", "c1", "c2", "delta"),
    "procedure-2a-spheroid": ("c0", "c1", "c2", "delta"),
    "coefficients": ("slope_at_B", "slope_at_minus_A", "three_A", "minus_three_B", "BB"),
    "hessian": ("h1", "h2", "h3", "delta_3"),
    "shared": ("E", "c1", "c2", "delta_3"),
}


def ratios(program, wanted, format_name, inputs, input_roundings=0):
    """|computed − exact|/(γ_k M) of every step of the bound (0 where both are 0); None after over- or underflow."""
    counted = relative_error_counts(program, wanted, input_roundings=input_roundings)
    computed = evaluate(program, float_arithmetic(format_name), inputs)
    exact = evaluate(program, EXACT, inputs)
    magnitudes = evaluate(counted.program, EXACT, inputs)
    if any(not np.isfinite(computed[name]) for name in counted.counts):
        return None
    rationals = {name: Fraction(float(computed[name])) for name in counted.counts}
    if _underflows(program, rationals, TINIEST_NORMAL[format_name]):
        return None
    found = {}
    for name, count in counted.counts.items():
        magnitude = magnitudes[counted.magnitudes[name]]
        bound = gamma(count, UNIT[format_name]) * magnitude
        error = abs(rationals[name] - exact[name])
        found[name] = error / bound if bound else Fraction(bool(error)) * 10**9
    return found


def _underflows(program, values, tiniest):
    """Whether an operation's exact result, of the operands as computed, is too small to be rounded relatively."""
    for step in program.steps:
        if step.name in values and step.operation in {"mul", "div"}:
            left, right = (values[a] if isinstance(a, str) else Fraction(a) for a in step.arguments)
            result = EXACT.operations[step.operation](left, right)
            if result != 0 and abs(result) < tiniest:
                return True
    return False


def floats(format_name, low, high):
    width = int(format_name.removeprefix("float"))
    return st.floats(low, high, width=width, allow_subnormal=False)


@st.composite
def scenes(draw):
    """A format, and seven numbers of it: anything, or a place next to the cancellations at r = a and r = a + 1."""
    format_name = draw(st.sampled_from(sorted(UNIT)))
    reach = 4.0 if format_name == "float16" else 64.0
    sizes = [draw(floats(format_name, 0.25, reach)) for _ in range(4)]
    centre = [draw(floats(format_name, -reach, reach)) for _ in range(3)]
    if draw(st.booleans()):
        of_format = np.dtype(format_name).type
        near = of_format(sizes[0] + draw(st.sampled_from([-1, 0, 1])) * sizes[2])
        centre = [float(np.nextafter(near, of_format(np.inf))), 0.0, draw(st.sampled_from([0.0, centre[2]]))]
    return format_name, dict(zip(COLUMNS, (*sizes, *centre), strict=True))


@pytest.mark.parametrize("name", NUMBERS)
@given(scene=scenes())
def test_every_value_that_a_formula_computes_in_floats_is_within_its_error_bound(name, scene):
    format_name, inputs = scene
    found = ratios(FORMULAS[name].program, NUMBERS[name], format_name, inputs)
    assume(found is not None)
    assert max(found.values()) <= 1


@given(st.lists(st.floats(0.25, 4), min_size=7, max_size=7))
def test_the_error_bound_for_rounded_inputs_with_one_rounding_more_is_never_exceeded(values):
    inputs = dict(zip(COLUMNS, values, strict=True))
    found = ratios(FORMULAS["table-2"].program, ("c1", "c2"), "float16", inputs, input_roundings=1)
    assume(found is not None)
    assert max(found.values()) <= 1


ARITHMETIC = {
    "+": lambda left, right: left + right,
    "-": lambda left, right: left - right,
    "*": lambda left, right: left * right,
}


@st.composite
def random_programs(draw):
    """Sums, products, quotients by products, and roots of squares, over inputs of both signs."""
    names, lines = ["x", "y", "w", "2", "3", "-4"], []
    definite = ["w", "3", "2", "-4"]
    for index in range(draw(st.integers(3, 9))):
        left, right = draw(st.sampled_from(names)), draw(st.sampled_from(names))
        sign = draw(st.sampled_from("+-*/"))
        if sign == "/":
            right = draw(st.sampled_from(definite))
        lines.append(f"v{index} = {left} {sign} {right}")
        names.append(f"v{index}")
        if sign in "*/" and left in definite and right in definite:
            definite.append(f"v{index}")
    return program_of("random", ("x", "y", "w"), "\n".join(lines))


@given(random_programs(), st.tuples(floats("float32", -8, 8), floats("float32", -8, 8), floats("float32", 0.125, 8)))
def test_random_programs_in_floats_stay_within_their_counted_error_bounds(program, values):
    counted_for = tuple(step.name for step in program.steps)
    inputs = dict(zip(program.inputs, values, strict=True))
    counted = relative_error_counts(program, counted_for, positive={"w"})
    computed = evaluate(program, float_arithmetic("float32"), inputs)
    assume(all(np.isfinite(computed[name]) for name in counted_for))
    rationals = {name: Fraction(float(value)) for name, value in computed.items()}
    assume(not _underflows(program, rationals, TINIEST_NORMAL["float32"]))
    exact, magnitudes = evaluate(program, EXACT, inputs), evaluate(counted.program, EXACT, inputs)
    for name in counted_for:
        magnitude = counted.magnitudes[name]
        bound = gamma(counted.counts[name], UNIT["float32"]) * (
            magnitudes[magnitude] if isinstance(magnitude, str) else magnitude
        )
        assert abs(rationals[name] - exact[name]) <= bound


@pytest.mark.parametrize(
    ("name", "step", "format_name", "at_least"),
    [
        ("table-2", "c1", "float16", 0.15),
        ("table-2", "c2", "float16", 0.2),
        ("shared", "E", "float32", 0.3),
        # Forty roundings seldom point the same way, so random rows come no nearer than this.
        ("table-2", "delta", "float32", 0.04),
        ("hessian", "delta_3", "float64", 0.02),
    ],
)
def test_the_greatest_rounding_error_of_a_formula_on_random_inputs_comes_near_its_bound(
    name, step, format_name, at_least
):
    random = np.random.default_rng(20)
    worst = Fraction(0)
    for _ in range(400):
        values = random.uniform(0.5, 3, 7).astype(format_name).astype(float).tolist()
        found = ratios(FORMULAS[name].program, (step,), format_name, dict(zip(COLUMNS, values, strict=True)))
        worst = max(worst, found[step])
    assert at_least < worst <= 1


def test_an_error_bound_with_one_rounding_less_is_exceeded_by_an_example():
    program = program_of("sum", ("x", "y", "z"), "s = x + y\nt = s + z")
    unit = UNIT["float32"]
    inputs = {"x": 1.0, "y": float(unit), "z": float(unit)}  # both additions are ties that fall back to 1
    counted = relative_error_counts(program, ("t",))
    error = abs(Fraction(float(evaluate(program, float_arithmetic("float32"), inputs)["t"])) - 1 - 2 * unit)
    magnitude = evaluate(counted.program, EXACT, inputs)[counted.magnitudes["t"]]
    assert counted.counts["t"] == 2
    assert gamma(1, unit) * magnitude < error <= gamma(2, unit) * magnitude


def test_relative_error_counts_are_those_worked_out_by_hand():
    program = program_of(
        "p", ("b", "x", "y"), "u = x * x\nv = y * y\nw = u + v\nq = w / b\nr = sqrt w\nn = - q\nt = 4 * n\nm = t - x"
    )
    counted = relative_error_counts(program, ("r", "m"))
    steps = {"u": 1, "v": 1, "w": 2, "q": 3, "r": 2, "n": 3, "t": 3, "m": 4}
    assert counted.counts == {"b": 0, "x": 0, "y": 0, **steps}
    values = evaluate(counted.program, EXACT, {"b": 2, "x": -3, "y": 4})
    assert values[counted.magnitudes["m"]] == 4 * Fraction(25, 2) + 3
    rounded = relative_error_counts(program, ("w",), input_roundings=1)
    assert (rounded.counts["x"], rounded.counts["u"], rounded.counts["w"]) == (1, 3, 4)


@pytest.mark.parametrize(
    ("listing", "complaint"),
    [
        ("s = b - x\nq = b / s", "step q: the divisor"),
        ("s = x + x\nq = b / s", "step q: the divisor"),
        ("s = b - d\nt = s * s\nq = b / t", "step q: the divisor"),
        ("r = sqrt x", "step r: the root's argument"),
        ("s = b - x\nr = abs s", "step r: the absolute value"),
        ("p = x > 0\nq = p ? x : b", "step q: no bound is derived for select"),
    ],
)
def test_relative_error_counts_raises_an_error_for_a_step_without_a_rule(listing, complaint):
    program = program_of("p", ("b", "d", "x"), listing)
    with pytest.raises(ValueError, match=complaint):
        relative_error_counts(program, (program.steps[-1].name,))


def test_relative_error_counts_covers_a_divisor_whose_terms_have_one_sign():
    program = program_of(
        "p", ("b", "d", "x"), "u = x * x\nv = b + u\nn = - d\nw = v - n\ns = b - d\nq = s / w\nr = s / x"
    )
    counted = relative_error_counts(program, ("q", "r"))
    assert (counted.counts["w"], counted.counts["q"], counted.counts["r"]) == (3, 5, 2)


def test_gamma_raises_an_error_for_too_many_roundings():
    with pytest.raises(ValueError, match="bound nothing"):
        gamma(2048, UNIT["float16"])
    assert gamma(10, Fraction(1, 1000)) == Fraction(1, 99)


@pytest.mark.parametrize("step", OPERATIONS)
def test_every_operation_that_gives_a_number_has_a_rounding_rule_except_selections(step):
    """A new operation must be thought about: it has a rule, or it is a truth value or a selection."""
    from hypcheck.derivation.rounding import RULES

    assert (step in RULES) == (OPERATIONS[step].gives == "number" and step != "select")
