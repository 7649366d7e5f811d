"""Programs printed in C, C++, Rust, JavaScript and Python: the same value to the bit for every step, and refusals."""

from __future__ import annotations

import ctypes
import math
import shutil
import subprocess

import numpy as np
import pytest

from hypcheck.derivation.program import OPERATIONS, program_of
from hypcheck.kernel.printing.languages import NUMBERS, c_statements, statements_in
from tests.kernel.printing_samples import EVERYTHING, PROGRAMS, assert_same_bits, columns

FORMATS = {
    "double": "float64",
    "f64": "float64",
    "number": "float64",
    "float": "float32",
    "f32": "float32",
    "long double": "longdouble",
}
CASES = [(True, "everything"), (True, "coefficients"), (False, "everything")]


def needs(tool):
    return pytest.mark.skipif(shutil.which(tool) is None, reason=f"there is no {tool}")


def names_of(program):
    return tuple(step.name for step in program.steps)


def by_library(command, path, source, inputs, count):
    path.write_text(source, encoding="utf-8")
    library = path.with_suffix(".so")
    done = subprocess.run([*command, str(path), "-o", str(library)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found = np.empty((count, inputs.shape[1]), inputs.dtype)
    ctypes.CDLL(str(library)).run(
        ctypes.c_size_t(inputs.shape[1]), ctypes.c_void_p(inputs.ctypes.data), ctypes.c_void_p(found.ctypes.data)
    )
    return found


def as_function(language, program, number):
    """A function in C or C++ that reads columns of inputs and writes columns of every step, truth values as 0 and 1."""
    steps = names_of(program)
    inputs = [f"const {number} {name} = in[{k} * n + i]; (void){name};" for k, name in enumerate(program.inputs)]
    results = [f"out[{k} * n + i] = ({number}){name};" for k, name in enumerate(steps)]
    body = "\n".join([*inputs, *statements_in(language, program, steps, number=number), *results])
    heads, begin = ("math.h", "stddef.h"), ""
    if language == "cpp":
        heads, begin = ("cmath", "cstddef"), 'extern "C" '
    return (
        "".join(f"#include <{head}>\n" for head in heads)
        + f"{begin}void run(size_t n, const {number} *in, {number} *out) {{ for (size_t i = 0; i < n; i++) {{\n"
        f"{body}\n}} }}\n"
    )


STRICT = ("-pedantic", "-Wall", "-Wextra", "-Werror", "-O2", "-shared", "-fPIC", "-ffp-contract=off")


@needs("g++")
@pytest.mark.parametrize(
    ("language", "number", "name"),
    [
        *(("c", "double" if wide else "float", name) for wide, name in CASES),
        ("c", "long double", "everything"),
        *(("cpp", "double" if wide else "float", name) for wide, name in CASES),
    ],
)
def test_every_step_printed_in_c_and_cpp_gives_the_same_bits_as_its_program(language, number, name, tmp_path):
    program = PROGRAMS[name]
    inputs = columns(program, FORMATS[number])
    command = ["gcc", "-std=c99"] if language == "c" else ["g++", "-std=c++11"]
    source = as_function(language, program, number)
    found = by_library([*command, *STRICT], tmp_path / f"source.{language}", source, inputs, len(program.steps))
    assert_same_bits(program, FORMATS[number], inputs, found)


def test_printing_a_step_that_does_not_exist_or_reads_a_reserved_name_raises_an_error():
    with pytest.raises(KeyError, match="has no nothing"):
        c_statements(EVERYTHING, ("nothing",))
    with pytest.raises(ValueError, match="step y: double is not a name"):
        c_statements(program_of("p", ("double",), "y = double + 1"), ("y",))


def test_the_program_printed_in_these_tests_has_every_operation():
    assert {step.operation for step in EVERYTHING.steps} == set(OPERATIONS)


@needs("rustc")
@pytest.mark.parametrize(("wide", "name"), CASES)
def test_every_step_printed_in_rust_gives_the_same_bits_as_its_program(wide, name, tmp_path):
    program, number = PROGRAMS[name], "f64" if wide else "f32"
    inputs, steps = columns(program, FORMATS[number]), names_of(program)
    kinds = {line.split(":")[0].removeprefix("let "): ": bool =" in line for line in rust_lines(program, number)}
    body = "\n".join(
        [
            *(f"let {each}: {number} = *input.add({k} * n + i);" for k, each in enumerate(program.inputs)),
            *rust_lines(program, number),
            *(
                f"*output.add({k} * n + i) = {each}{f' as u8 as {number}' if kinds[each] else ''};"
                for k, each in enumerate(steps)
            ),
        ]
    )
    source = (
        "#![allow(non_snake_case)]\n#![deny(warnings)]\n#[no_mangle]\n"
        f'pub unsafe extern "C" fn run(n: usize, input: *const {number}, output: *mut {number}) {{\n'
        f"for i in 0..n {{\n{body}\n}} }}\n"
    )
    command = ["rustc", "--edition", "2021", "-O", "--crate-type", "cdylib"]
    found = by_library(command, tmp_path / "source.rs", source, inputs, len(steps))
    assert_same_bits(program, FORMATS[number], inputs, found)


def rust_lines(program, number):
    return statements_in("rust", program, names_of(program), number=number)


@needs("node")
@pytest.mark.parametrize(("wide", "name"), CASES)
def test_every_step_printed_in_javascript_gives_the_same_bits_as_its_program(wide, name, tmp_path):
    program, number = PROGRAMS[name], "number" if wide else "float32"
    format_name = "float64" if wide else "float32"
    inputs, steps = columns(program, format_name), names_of(program)
    body = "\n".join(
        [
            *(f"const {each} = input[{k} * n + i];" for k, each in enumerate(program.inputs)),
            *statements_in("javascript", program, steps, number=number),
            *(f"output[{k} * n + i] = Number({each});" for k, each in enumerate(steps)),
        ]
    )
    array = "Float64Array" if wide else "Float32Array"
    source = (
        '"use strict";\nconst { readFileSync, writeFileSync } = require("fs");\n'
        f"const bytes = readFileSync('in');\nconst n = {inputs.shape[1]};\n"
        f"const input = new {array}(bytes.buffer, bytes.byteOffset, bytes.length / {array}.BYTES_PER_ELEMENT);\n"
        f"const output = new {array}({len(steps)} * n);\nfor (let i = 0; i < n; i++) {{\n{body}\n}}\n"
        "writeFileSync('out', Buffer.from(output.buffer));\n"
    )
    (tmp_path / "run.js").write_text(source, encoding="utf-8")
    (tmp_path / "in").write_bytes(inputs.tobytes())
    done = subprocess.run(
        [str(shutil.which("node")), "run.js"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found = np.frombuffer((tmp_path / "out").read_bytes(), inputs.dtype).reshape(len(steps), -1)
    assert_same_bits(program, format_name, inputs, found)


@pytest.mark.parametrize("name", ["everything", "coefficients"])
def test_every_step_printed_in_python_gives_the_same_bits_as_its_program(name):
    program = PROGRAMS[name]
    inputs, steps = columns(program, "float64"), names_of(program)
    code = compile("\n".join(statements_in("python", program, steps)), name, "exec")
    kept, found = [], []
    for index, values in enumerate(inputs.T.tolist()):
        scope = {"math": math, **dict(zip(program.inputs, values, strict=True))}
        try:
            exec(code, scope)  # noqa: S102 - what was printed just now
        except (ZeroDivisionError, ValueError):
            continue  # Python has no infinities and NaNs there
        kept.append(index)
        found.append([float(scope[each]) for each in steps])
    assert len(kept) > 100
    assert_same_bits(program, "float64", inputs[:, kept], np.array(found).T)


@pytest.mark.parametrize(
    ("language", "reserved"),
    [("c", "short"), ("cpp", "new"), ("rust", "loop"), ("javascript", "let"), ("python", "def")],
)
def test_printing_a_step_named_as_a_reserved_word_raises_an_error(language, reserved):
    with pytest.raises(ValueError, match=f"step {reserved}: {reserved} is not a name in the language"):
        statements_in(language, program_of("p", ("x",), f"{reserved} = x + 1"), (reserved,))


@pytest.mark.parametrize("language", NUMBERS)
def test_printing_an_unknown_type_of_numbers_raises_an_error(language):
    with pytest.raises(
        ValueError, match=f"^{language} has no type of numbers 'half'; it has {', '.join(NUMBERS[language])}$"
    ):
        statements_in(language, EVERYTHING, ("r",), number="half")
