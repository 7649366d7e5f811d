"""Programs and inputs on which every printer is tried, with the expected values of their steps."""

from __future__ import annotations

import numpy as np

from hypcheck.derivation.evaluation import evaluate
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.program import program_of

EVERYTHING = program_of(
    "everything",
    ("x", "y"),
    """
    s = x + y
    d = x - -3
    m = 2048 * y
    q = x / y
    four = - -4
    a = abs d
    r = sqrt a
    gt = x > y
    lt = x < y
    ge = x >= y
    le = x <= y
    eq = x == y
    ne = x != 0
    both = gt and ge
    either = lt or eq
    neither = not either
    number = neither ? q : four
    truth = both ? ne : le
    """,
)
PROGRAMS = {"everything": EVERYTHING, **{name: formula.program for name, formula in FORMULAS.items()}}


def columns(program, format_name):
    """Inputs of many sizes and signs, and at the ends of the format."""
    random = np.random.default_rng(len(program.steps))
    shape = (len(program.inputs), 300)
    values = np.ldexp(random.uniform(-1, 1, shape), random.integers(-20, 20, shape)).astype(format_name)
    limits = np.finfo(np.dtype(format_name))
    ends = [0.0, -0.0, 1.0, np.inf, -np.inf, np.nan, limits.tiny, limits.smallest_subnormal, limits.max]
    values[:, :9], values[:, 20:29] = ends, np.abs(values[:, 20:29])
    return np.ascontiguousarray(values)


def assert_same_bits(program, format_name, inputs, found):
    """Every row of `found` is what the step of that place comes to in the format, zeros with their sign and NaNs."""
    expected = evaluate(program, float_arithmetic(format_name), dict(zip(program.inputs, inputs, strict=True)))
    for step, row in zip((each.name for each in program.steps), found, strict=True):
        right = np.broadcast_to(np.asarray(expected[step], dtype=inputs.dtype), row.shape)
        alike = (row == right) & (np.signbit(row) == np.signbit(right)) | (np.isnan(row) & np.isnan(right))
        assert alike.all(), step
