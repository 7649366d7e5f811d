"""The exact stage for tilted spheroids: its programs, Python's integers and C's, against fractions."""

from __future__ import annotations

import ctypes
import random
import sys
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.derivation.evaluation import EXACT, evaluate
from hypcheck.geometry.pair import TILTED_COLUMNS, Pair
from hypcheck.kernel import integers
from tests.kernel.compiling import HEADER, IMPLEMENTATION, needs_compiler, shared_library
from tests.support.inside import COEFFICIENTS, DISCRIMINANT, INVARIANTS, QUARTIC, generate, integers_position


def small_rows(seed, count):
    """Rows of small numbers: half of them positions of every kind, the rest with a centre in the plane of the axes."""
    draw, rows = random.Random(seed), []  # noqa: S311
    while len(rows) < count:
        most = draw.choice([2, 3, 6, 12])
        row = [draw.randint(1, most) for _ in range(4)]
        row += [draw.randint(-2 * most, 2 * most) / draw.choice([1, 2]) for _ in range(3)]
        row += [draw.randint(-3, 3) for _ in range(3)]
        if draw.random() < 0.3:
            row[4:6] = [row[7] * draw.choice([0.5, 1, 2, -1]), row[8]]
        if row[2] != row[3] and (row[7] or row[8]):
            rows.append([float(each) for each in row])
    return rows


def wide_rows(seed, count):
    """Rows over all of float64, most of them too far apart to touch, some at its very limits."""
    draw = random.Random(seed)  # noqa: S311
    limits = (5e-324, sys.float_info.max, 1.0, 2.0, 3e-310)

    def size():
        return 2 ** draw.uniform(-1070, 1020) if draw.random() < 0.5 else draw.choice(limits)

    def signed():
        return draw.choice([-1, 1, 0]) * (2 ** draw.uniform(-1074, 1023.9) if draw.random() < 0.5 else size())

    return [[*(size() for _ in range(4)), *(signed() for _ in range(5)), size()] for _ in range(count)]


@pytest.mark.parametrize("roots", [(1, 2, 3, -4), (1, 1, 5, -2), (Fraction(1, 2), 7, -3, -9)])
def test_the_tilted_discriminant_is_27_times_the_product_of_squared_root_differences(roots):
    poly, lead = [Fraction(3)], Fraction(3)
    for root in roots:
        poly = [a - root * b for a, b in zip([Fraction(0), *poly], [*poly, Fraction(0)], strict=True)]
    right = 27 * lead**6
    for k, root in enumerate(roots):
        for other in roots[:k]:
            right *= (root - other) ** 2
    inputs = dict(zip(COEFFICIENTS, (-poly[0], *poly[1:]), strict=True))
    invariants = evaluate(INVARIANTS, EXACT, inputs)
    assert evaluate(DISCRIMINANT, EXACT, {"I": invariants["I"], "J": invariants["J"]})["delta"] == right
    assert integers.discriminant(tuple(poly)) == right


RINGS = (  # a pole is a double root of the quartic, and the pair is clear; the last two touch at such a pole
    ((2.0, 4.0, 2.0, 4.0, 0.0, 5.0, 0.0, 1.0, 0.0, 0.0), 1),
    ((35.0, 35.0, 25.0, 15.0, 16.0, 0.0, -4.0, 1.0, 0.0, 1.0), -1),
    ((2.0, 2.0, 1.0, 2.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0), 0),
    ((4.0, 1.0, 2.0, 1.0, 3.0, 0.0, 0.0, 1.0, 0.0, 0.0), 0),
)


def reference(row):
    """The position by Python's integers, which are asked all frozen cases."""
    if row[2] == row[3] or row[7] == row[8] == 0:
        return int(integers_position(Pair.from_row(row[:7]).lengths))
    return int(integers.position(row))


@needs_compiler
@pytest.mark.parametrize("options", [(), ("-DHYPCHECK_PLAIN", "-DHYPCHECK_SMALL_LIMBS")], ids=["levels", "small-limbs"])
def test_tilted_integers_in_c_decide_as_those_in_python(options, tmp_path):
    (tmp_path / "hypcheck.h").write_text(_without_floats(), encoding="utf-8")
    library = shared_library(tmp_path, IMPLEMENTATION, *options)
    rows = [*(row for row, _ in RINGS), *small_rows(3, 1500), *wide_rows(4, 60)]
    rows += [[*row[:7], 0.0, -0.0, 3.0] for row in small_rows(5, 30)]
    rows += [[*row[:3], row[2], *row[4:]] for row in small_rows(6, 30)]
    values, answers = np.array(rows), np.full(len(rows), 99, np.int8)
    pointers = (ctypes.c_void_p(each.ctypes.data) for each in (values, answers))
    library.hypcheck_classify_tilted(ctypes.c_size_t(len(rows)), *pointers)
    assert answers.tolist() == [reference(row) for row in rows]


def _without_floats():
    return HEADER.read_text(encoding="utf-8").replace("#define HC_FLOATS_DECIDE 1", "#define HC_FLOATS_DECIDE 0")


def test_the_memory_of_the_tilted_integers_suffices_for_the_longest_numbers():
    """What is counted is what numbers of 2,098 bits take; the sanitizers watch that nothing is written beyond it."""
    bits, numbers = generate.pool_bits()
    counted = evaluate(QUARTIC, EXACT, dict.fromkeys(TILTED_COLUMNS, Fraction(2**2098 - 1)))
    assert bits > sum(int(value).bit_length() for value in counted.values())
    assert numbers > len(counted) - 1
