"""The stage in fixed point: what its numbers stand for, the bounds of what is cut, and the functions in C."""

from __future__ import annotations

import ctypes
import itertools
from fractions import Fraction

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from hypcheck.derivation.evaluation import EXACT, evaluate, outputs
from hypcheck.derivation.pencil import SYMBOLIC
from hypcheck.derivation.program import Program, program_of
from hypcheck.kernel.programs import fixed
from hypcheck.vectors.families import FAMILIES
from tests.kernel.compiling import HEADER, needs_compiler, shared_library
from tests.support import inside
from tests.support.inside import INTEGERS, header

HALF, WHOLE = 2**64, 2**128


def test_the_value_middle_of_the_fixed_point_program_is_the_scaled_cubic_at_its_inflection():
    N, n2, n1, ps = sympy.symbols("N n2 n1 ps")
    names = dict(zip(("N", "n2", "n1", "ps"), (N, n2, n1, ps), strict=True))
    delta, middle = outputs(fixed.DISCRIMINANT, SYMBOLIC, names, ("delta", "middle"))
    x = sympy.Symbol("x")
    cubic = N * x**3 + n2 * x**2 + n1 * x - ps
    assert sympy.expand(delta - 3 * sympy.discriminant(cubic, x)) == 0
    assert sympy.expand(middle - 27 * N**2 * cubic.subs(x, -n2 / (3 * N))) == 0


def test_terms_of_the_fixed_point_program_are_multiples_of_those_of_the_integers_program():
    sides = dict(zip(("alpha", "gamma", "b", "d", "x", "y", "z"), sympy.symbols("alpha gamma b d x y z"), strict=True))
    wanted = ("p", "q", "s", "t", "xx", "yy", "S")
    squares = dict(zip(wanted, outputs(INTEGERS, SYMBOLIC, sides, wanted), strict=True))
    whole = {name: squares[of] for name, of in fixed.WHOLE.items()}
    radial_2, axial_2, n1, N, ps, R, *products = outputs(
        fixed.TERMS,
        SYMBOLIC,
        squares | whole,
        ("radial_2", "axial_2", "n1", "N", "ps", "R", "p_t", "s_t", "q_s", "p_q"),
    )
    n2 = radial_2 - axial_2
    for found, name in ((n2, "n2"), (n1, "n1"), (N, "N"), (ps, "ps")):
        assert sympy.expand(found - outputs(INTEGERS, SYMBOLIC, sides, (name,))[0]) == 0
    inputs = squares | {"R": R, "n2": n2} | dict(zip(("p_t", "s_t", "q_s", "p_q"), products, strict=True))
    for pole, factor in (("B", squares["t"]), ("A", squares["q"])):
        for name in (f"offset_at_{pole}", f"slope_at_{pole}"):
            (found,) = outputs(fixed.POLES, SYMBOLIC, inputs, (name,))
            assert sympy.expand(factor * found - outputs(INTEGERS, SYMBOLIC, sides, (name,))[0]) == 0


def highest(left: int, right: int) -> int:
    """The product as the kernel cuts it: without the lower halves' product and the lower halves of the mixed ones."""
    a, b = left % WHOLE, right % WHOLE
    cut = (a // HALF) * (b // HALF) + (a // HALF) * (b % HALF) // HALF + (a % HALF) * (b // HALF) // HALF
    return cut - (right if left < 0 else 0) - (left if right < 0 else 0) - (WHOLE if left < 0 and right < 0 else 0)


def cut_and_exact(program: Program, inputs: dict[str, tuple[int, Fraction]]) -> dict[str, tuple[int, Fraction]]:
    """Each step in fixed point and exactly, in its unit."""
    known = dict(inputs)
    for step in program.steps:
        (a, exact_a), (b, exact_b) = (known.get(str(each), (each, Fraction(0))) for each in step.arguments)
        if isinstance(step.arguments[0], int):
            known[step.name] = (a * b, a * exact_b)
        elif step.operation == "mul":
            known[step.name] = (highest(a, b), exact_a * exact_b / WHOLE)
        else:
            sign = 1 if step.operation == "add" else -1
            known[step.name] = (a + sign * b, exact_a + sign * exact_b)
    return known


PROGRAMS = {"terms": fixed.TERMS, "discriminant": fixed.DISCRIMINANT, "poles": fixed.POLES}


@settings(max_examples=20)
@given(st.sampled_from(sorted(PROGRAMS)), st.data())
def test_values_and_errors_of_a_fixed_point_program_stay_in_their_computed_ranges(name, data):
    program, ranges = PROGRAMS[name], fixed.RANGES[name]
    inputs = {}
    for each in program.inputs:
        told = ranges[each]
        value = data.draw(st.one_of(st.integers(told.low, told.high), st.sampled_from([told.low, told.high])))
        error = data.draw(st.sampled_from([told.under, told.over, 0]))
        inputs[each] = (value, Fraction(value - error))
    for step, (value, exact) in cut_and_exact(program, inputs).items():
        told = ranges[step]
        if step not in {"radial_2", "axial_2", "p_t", "s_t", "q_s", "p_q"}:  # these are moved behind the program
            assert told.low <= value <= told.high, step
        assert told.under <= value - exact <= told.over, step


def test_fixed_point_errors_are_whole_units_and_cover_the_computed_ranges():
    assert fixed.ERRORS == {"coefficient": 8, "pole": 22, "delta": 31, "middle": 39}
    for name in ("delta", "middle"):
        assert fixed.RANGES["discriminant"][name].error <= fixed.ERRORS[name]


@pytest.mark.parametrize(
    ("listing", "high", "trouble"),
    [
        ("r = a + a\ns = r - a", 2**127, "step r may leave 128 bits"),
        ("r = a / a", 1, "div is not an operation in fixed point"),
    ],
)
def test_fixed_point_errors_refuse_a_program_that_cannot_run_in_fixed_point(listing, high, trouble):
    with pytest.raises(ValueError, match=trouble):
        fixed.errors(program_of("odd", ("a",), listing), {"a": fixed.Range(0, high)})


FUNCTIONS = """
#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"
void of_two(hc_fixed *a, hc_fixed *b, hc_fixed *to) {
    const int a_sign = (int)(a->high >> 63), b_sign = (int)(b->high >> 63);
    to[0] = hc_fixed_plus(*a, *b);
    to[1] = hc_fixed_minus(*a, *b);
    to[2] = b_sign   ? hc_fixed_both_signed_product(*a, *b)
            : a_sign ? hc_fixed_signed_product(*a, *b)
                     : hc_fixed_product(*a, *b);
    to[3] = hc_fixed_square(*a);
}
void of_one(hc_fixed *a, int by, hc_fixed *to, int *bits) {
    to[0] = hc_fixed_up(*a, by);
    to[1] = hc_fixed_down(*a, by);
    to[2] = hc_fixed_times(2, *a), to[3] = hc_fixed_times(3, *a);
    to[4] = hc_fixed_times(4, *a), to[5] = hc_fixed_times(9, *a);
    *bits = hc_fixed_bits(*a);
}
int sign(hc_fixed *a, uint64_t error, int grown) { return hc_fixed_sign(*a, error, grown); }
int of_row(double *row) {
    double about;
    return hc_fixed_position(row, &about);
}
"""


def built(folder, *options, **errors):
    text = HEADER.read_text(encoding="utf-8")
    for name, value in errors.items():
        assert text.count(f"#define HC_fixed_{name} {fixed.ERRORS[name]}\n") == 1
        text = text.replace(f"#define HC_fixed_{name} {fixed.ERRORS[name]}\n", f"#define HC_fixed_{name} {value}\n")
    (folder / "hypcheck.h").write_text(text, encoding="utf-8")
    return shared_library(folder, FUNCTIONS, "-DHYPCHECK_PLAIN", "-O0", *options)


@pytest.fixture(scope="module", params=[(), ("-DHYPCHECK_SMALL_LIMBS",)], ids=["64-bit-limbs", "32-bit-limbs"])
def library(request, tmp_path_factory):
    return built(tmp_path_factory.mktemp("fixed"), *request.param)


def words(number: int) -> ctypes.Array:
    return (ctypes.c_uint64 * 2)(number % HALF, number // HALF % HALF)


def numbers(found: ctypes.Array) -> list[int]:
    pairs = list(zip(found[::2], found[1::2], strict=True))
    return [low + HALF * high - (WHOLE if high >> 63 else 0) for low, high in pairs]


def wrapped(number: int) -> int:
    return (number + WHOLE // 2) % WHOLE - WHOLE // 2


EDGES = [0, 1, -1, 2**63, 2**64 - 1, 2**64, -(2**64), 2**126 + 3, -(2**126) - 7, 2**127 - 1, -(2**127) + 1]


@pytest.mark.slow
@needs_compiler
def test_the_fixed_point_functions_in_c_compute_as_python_integers(library):
    random = np.random.default_rng(4)
    drawn = [int.from_bytes(random.bytes(16), "little", signed=True) >> int(random.integers(0, 120)) for _ in range(40)]
    for a, b in itertools.product(EDGES + drawn, repeat=2):
        to = (ctypes.c_uint64 * 8)()
        library.of_two(words(a), words(b), to)
        expected = [wrapped(each) for each in (a + b, a - b, highest(a, b))]
        assert numbers(to)[:3] == expected, (a, b)
        assert numbers(to)[3] == square(a)
        assert 0 <= Fraction(a * b, WHOLE) - highest(a, b) < fixed.CUT
    for a, by in itertools.product(EDGES + drawn, [0, 1, 2, 62, 63, 64, 65, 126, 127]):
        to, bits = (ctypes.c_uint64 * 12)(), ctypes.c_int()
        library.of_one(words(a), by, to, ctypes.byref(bits))
        assert numbers(to) == [wrapped(each) for each in (a << by, a >> by, 2 * a, 3 * a, 4 * a, 9 * a)], (a, by)
        assert bits.value == max(1, (a if a >= 0 else ~a).bit_length())
    for a in EDGES + drawn:
        to = (ctypes.c_uint64 * 12)()
        library.of_one(words(a), 5000, to, ctypes.byref(ctypes.c_int()))
        assert numbers(to)[1] == (-1 if a < 0 else 0)


def square(number: int) -> int:
    size = abs(number)
    return (size // HALF) ** 2 + 2 * ((size // HALF) * (size % HALF) // HALF)


@needs_compiler
def test_the_fixed_point_sign_in_c_is_0_unless_the_number_exceeds_its_error(library):
    library.sign.argtypes = (ctypes.c_void_p, ctypes.c_uint64, ctypes.c_int)
    for error, grown in ((31, 0), (31, 100), (8, 60)):
        limit = error << grown
        for number, expected in ((limit, 0), (limit + 1, 1), (-limit, 0), (-limit - 2, -1), (0, 0), (3 * limit, 1)):
            assert library.sign(words(number), error, grown) == expected


def rows_of(*names: str, count: int = 20) -> np.ndarray:
    return np.concatenate([FAMILIES[name].rows(11, count) for name in names])


def answers(library, rows) -> np.ndarray:
    return np.array([library.of_row((ctypes.c_double * 7)(*row)) for row in rows.tolist()])


@pytest.mark.slow
@needs_compiler
def test_the_fixed_point_stage_is_never_wrong_and_decides_nearly_all_rows_but_tangencies(library):
    rows = rows_of(*FAMILIES, count=5)
    truth, found = inside.positions(rows), answers(library, rows)
    assert (found == truth)[found != 2].all()
    told = rows_of("ring", "near-tangent-outside", "near-tangent-inside", "tower-body", "extreme-magnitude", "waist")
    assert (answers(library, told) != 2).mean() > 0.97
    assert (answers(library, rows_of("tangent")) == 2).mean() > 0.9


@pytest.mark.thorough
@needs_compiler
def test_the_fixed_point_stage_without_its_error_bound_answers_some_tangencies_wrongly(tmp_path):
    rows = rows_of("tangent")
    found = answers(built(tmp_path, delta=0), rows)
    assert (found != inside.positions(rows))[found != 2].any()


def test_the_header_computes_every_result_of_the_fixed_point_programs():
    text = header()
    for program, wanted in ((fixed.TERMS, fixed.TERM_RESULTS), (fixed.DISCRIMINANT, ("delta", "middle"))):
        for name in wanted:
            assert f"const hc_fixed {name} = " in text, (program.name, name)
    assert evaluate(fixed.DISCRIMINANT, EXACT, {"N": 1, "n2": -3, "n1": 3, "ps": 1})["delta"] == 0
