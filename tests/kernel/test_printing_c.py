"""C printed from a program: the same value to the bit for every step of every formula, and refused programs."""

from __future__ import annotations

import ctypes

import numpy as np
import pytest

from hypcheck.derivation.program import OPERATIONS, program_of
from hypcheck.kernel.printing.languages import c_statements
from tests.kernel.compiling import needs_compiler, shared_library
from tests.kernel.printing_samples import EVERYTHING, PROGRAMS, assert_same_bits, columns

FORMATS = {"double": "float64", "float": "float32", "long double": "longdouble"}


def as_function(program, number):
    """A C function that reads columns of inputs and writes columns of every step, truth values as 0 and 1."""
    steps = tuple(step.name for step in program.steps)
    inputs = [f"const {number} {name} = in[{k} * n + i];" for k, name in enumerate(program.inputs)]
    results = [f"out[{k} * n + i] = ({number}){name};" for k, name in enumerate(steps)]
    body = "\n".join([*inputs, *c_statements(program, steps, number=number), *results])
    unused = "".join(f"(void){name};" for name in program.inputs)
    return (
        "#include <math.h>\n#include <stddef.h>\n"
        f"void run(size_t n, const {number} *in, {number} *out) {{ for (size_t i = 0; i < n; i++) {{\n"
        f"{body}\n{unused}}} }}\n"
    )


@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize(
    ("number", "name"),
    [*(("double", name) for name in PROGRAMS), ("float", "everything"), ("long double", "everything")],
)
def test_every_step_printed_in_c_gives_the_same_bits_as_its_program(number, name, tmp_path):
    program = PROGRAMS[name]
    inputs = columns(program, FORMATS[number])
    library = shared_library(tmp_path, as_function(program, number), "-ffp-contract=off")
    found = np.empty((len(program.steps), inputs.shape[1]), inputs.dtype)
    library.run(
        ctypes.c_size_t(inputs.shape[1]), ctypes.c_void_p(inputs.ctypes.data), ctypes.c_void_p(found.ctypes.data)
    )
    assert_same_bits(program, FORMATS[number], inputs, found)


def test_c_statements_prints_one_declaration_per_step_in_the_order_of_the_program():
    assert c_statements(EVERYTHING, ("number", "truth", "r")) == (
        "const double d = x - (-3.0);",
        "const double q = x / y;",
        "const double four = -(-4.0);",
        "const double a = fabs(d);",
        "const double r = sqrt(a);",
        "const int gt = x > y;",
        "const int lt = x < y;",
        "const int ge = x >= y;",
        "const int le = x <= y;",
        "const int eq = x == y;",
        "const int ne = x != 0.0;",
        "const int both = gt & ge;",
        "const int either = lt | eq;",
        "const int neither = !either;",
        "const double number = neither ? q : four;",
        "const int truth = both ? ne : le;",
    )


def test_c_statements_prints_literals_and_functions_of_the_chosen_type():
    assert c_statements(EVERYTHING, ("r",), number="float") == (
        "const float d = x - (-3.0F);",
        "const float a = fabsf(d);",
        "const float r = sqrtf(a);",
    )
    assert c_statements(EVERYTHING, ("m",), number="long double") == ("const long double m = 2048.0L * y;",)


def test_c_statements_prints_nothing_for_an_input():
    assert c_statements(EVERYTHING, ("x",)) == ()


def test_printing_an_unknown_type_or_a_reserved_name_in_c_raises_an_error():
    with pytest.raises(ValueError, match="c has no type of numbers 'half'; it has double, float, long double"):
        c_statements(EVERYTHING, ("r",), number="half")
    with pytest.raises(KeyError, match="has no nothing"):
        c_statements(EVERYTHING, ("nothing",))
    with pytest.raises(ValueError, match="step short: short is no name in the language"):
        c_statements(program_of("p", ("x",), "short = x + 1"), ("short",))
    with pytest.raises(ValueError, match="step y: double is no name"):
        c_statements(program_of("p", ("double",), "y = double + 1"), ("y",))


def test_the_program_printed_in_these_tests_has_every_operation():
    assert {step.operation for step in EVERYTHING.steps} == set(OPERATIONS)
