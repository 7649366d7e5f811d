"""The limits of the kernel that its proofs need, and the rules by which comparisons become answers."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction
from math import isqrt

import pytest

from hypcheck.derivation.evaluation import EXACT, outputs
from hypcheck.geometry.pair import Lengths, Pair, Position, to_integers
from tests.kernel import program_rules
from tests.kernel.compiling import STRICT, needs_compiler, program
from tests.support import inside
from tests.support.inside import (
    CERTIFIED,
    CERTIFIED_CONSTANTS,
    FLOAT64_BITS,
    TILTED,
    certified,
    integers_position,
    lines,
    scene_lines,
)

GREATEST = Fraction(sys.float_info.max)
LEAST_NORMAL = Fraction(sys.float_info.min)
U = Fraction(certified.U)


@pytest.mark.slow
def test_the_certified_stage_decides_by_the_exact_rule_for_all_combinations_of_signs():
    assert program_rules.wrong_signs(CERTIFIED) == []


def test_the_stage_for_tilted_rows_decides_by_the_exact_rule_for_all_combinations_of_signs():
    assert program_rules.wrong_signs_of_tilted_rows(TILTED) == []


@pytest.mark.parametrize("program", [CERTIFIED, TILTED], ids=lambda program: program.name)
def test_the_float_stages_decide_only_rows_within_their_limits(program):
    assert program_rules.wrong_limits(program) == []


def test_no_product_overflows_on_rows_that_the_certified_stage_decides():
    """With every size and centre at its limit the largest product of the bound is far from the largest float64."""
    most, far = (Fraction(CERTIFIED_CONSTANTS[name]) for name in ("greatest", "farthest"))
    m2 = 2 * (2 * most + 1 + far)
    m1 = 2 * (most * most + 2 * most + most * far)
    m0 = 2 * most * most
    a1, a2, a3 = 2 * (m2 * m2 + 3 * m1), 2 * (m2 * m1 + 9 * m0), 2 * (m1 * m1 + 3 * m2 * m0)
    assert 4 * (4 * a1 * a3 + a2 * a2) < GREATEST
    assert 2 * (3 * most + 2 * m2) * most + m1 < GREATEST
    assert 64 * (m2 * m1) ** 2 < GREATEST
    assert GREATEST / (2 * most * most) > far  # what x² + y² becomes when it overflows is seen


def test_underflow_in_the_certified_stage_is_less_than_the_unit_that_its_bound_keeps_in_reserve():
    least, most = (Fraction(CERTIFIED_CONSTANTS[name]) for name in ("least", "greatest"))
    lost = 4 * most * 2 * LEAST_NORMAL / least**2  # of c1, where x², y² and z² are lost
    assert lost < U * least * least  # AB, the least of the terms' sum that e1 is measured by


def test_no_product_overflows_or_underflows_in_the_stage_of_lines():
    slope, constant, cap = (Fraction(each) for each in (lines.GREATEST_SLOPE, lines.LEAST_CONSTANT, lines.CAP))
    assert slope * cap * 2 < GREATEST
    assert 64 * cap < GREATEST
    assert 2 * LEAST_NORMAL * (1 + slope) < U * constant


def test_squares_that_underflow_in_single_precision_are_below_the_constant_tiny():
    least_normal = Fraction(1, 2**126)
    lost = 2 * 2 * least_normal * (1 + Fraction(lines.FLOAT32_GREATEST_SLOPE))
    assert lost < Fraction(lines.FLOAT32_TINY)
    beside_the_axis = scene_lines.thresholds({"beyond": None, "under": None, "within": None, "above": (0.0, 0.0)}, 1.0)
    assert beside_the_axis is not None
    assert beside_the_axis["K_above"] >= lines.FLOAT32_TINY


@pytest.mark.parametrize("at", [0, 1])
def test_the_chord_program_compares_both_ends_of_the_chord(at):
    """K + M T is 1 at T = 0 and 3 at T = 1; one end has room on either side, the other on none."""
    inputs = {"K": 1, "M": 2, "T_0": 0, "T_1": 1, "less": lines.LESS, "more": lines.MORE}
    heights = [1, 3]
    for factor, below, above in ((2, True, False), (Fraction(1, 2), False, True)):
        both = {f"R_{k}": height * factor for k, height in enumerate(heights)}
        assert outputs(lines.CHORD, EXACT, {**inputs, **both}, ("below", "above")) == (below, above)
        one = {**both, f"R_{at}": heights[at] / Fraction(factor)}
        assert outputs(lines.CHORD, EXACT, {**inputs, **one}, ("below", "above")) == (False, False)


def test_the_longest_integer_from_float64_lengths_has_the_counted_number_of_bits():
    longest = Pair(sys.float_info.max, 1.0, 5e-324, 1.0, 5e-324, 0.0, 0.0).lengths.alpha
    assert longest.bit_length() == FLOAT64_BITS
    assert integers_position(Lengths(longest, 1, 0, 0, 1, 1, 0)) is Position.INTERIOR


def test_integers_answer_contact_for_a_tangency_whose_slope_at_the_pole_is_0():
    """The ring asks for the slope 0 at B, and for the height 0: here it is 26, and a double root lies below B."""
    alpha, gamma, b, d, x, y, z = 48, 72, 35, 35, 6, 87, 26
    A, B, P, Q = Fraction(alpha, b) ** 2, Fraction(gamma, d) ** 2, Fraction(x * x + y * y, b * b), Fraction(z, d) ** 2
    c2, c1 = A - B + 1 - P - Q, -A * B + A - B + B * P - A * Q
    double = Fraction(1440, 1225)
    assert double**3 + c2 * double**2 + c1 * double - A * B == 3 * double**2 + 2 * c2 * double + c1 == 0
    assert 3 * B**2 + 2 * c2 * B + c1 == 0
    assert 0 < double < B
    assert integers_position(Lengths(alpha, b, x, y, gamma, d, z)) is Position.CONTACT


SCENE = """
#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"
#include <stdio.h>
int main(void) {
    double sizes[4], top;
    while (scanf("%la %la %la %la %la", sizes, sizes + 1, sizes + 2, sizes + 3, &top) == 5) {
        const double z[2] = {0.0, top};
        hc_scene scene;
        int made = hc_make_scene(&scene, sizes, 2, z), i, k;
        const hc_line *sides[4] = {scene.beyond, scene.within, scene.under, scene.above};
        printf("%d %a %a %a", made, hc_short(1.0625 * top, 1), hc_short(top, 0), scene.reach);
        for (k = 0; k < 4; k++)
            for (i = 0; i < 3; i++) printf(" %a %a", sides[k][i].K, sides[k][i].M);
        puts("");
    }
    return 0;
}
"""
SIZES = (
    (2.0, 17.8, 0.25, 0.15),
    (0.4, 8.0, 0.3, 0.9),
    (3.0, 1.0, 1.0, 1.0),
    (1.0, 4.0, 1.0, 2.0),
    (30.0, 70.0, 1e-3, 5e-4),
)
PROVES_NOTHING = (sys.float_info.max, -1.0)


def position_at(sizes: tuple[float, ...], R: Fraction, z: Fraction, *, above: bool) -> Position:
    """The exact position at a height, hardly above or below that R; on the axis where R is below 0."""
    root = Fraction(isqrt(int(max(R, Fraction(0)) * 4**120)), 2**120)
    x = (root + Fraction(1, 2**119)) if above else root * (1 - Fraction(1, 2**100))
    alpha, gamma, b, d = map(Fraction, sizes)
    radial, axial = to_integers((alpha, b, x)), to_integers((gamma, d, z))
    return inside.position(Lengths(*radial, 0, *axial))


@pytest.mark.thorough
@needs_compiler
def test_lines_of_a_compiled_scene_prove_right_positions_at_height_0_and_at_their_greatest_height(tmp_path):
    """At T = 0 and at the greatest T the exact position just beside each line is the one that the line claims."""
    binary = program(tmp_path, SCENE, *STRICT, "-Wno-unused-function", "-O1")
    asked = [(*sizes, size * 1.37) for sizes in SIZES for size in (sizes[1], sizes[3])]
    text = "\n".join(" ".join(each.hex() for each in row) for row in asked)
    done = subprocess.run([binary], input=text, capture_output=True, text=True, check=True)
    checked = 0
    for (*sizes, _), line in zip(asked, done.stdout.splitlines(), strict=True):
        made, top, short, reach, *numbers = (float.fromhex(each) for each in line.split())
        assert made == 1
        assert all(Fraction(each) ** 2 == Fraction(each * each) for each in (top, short))  # squares without a rounding
        assert Fraction(reach) * (1 + 2 * U) <= Fraction(top) ** 2  # a computed T up to it is one below the greatest
        for place, (K, M) in enumerate(zip(numbers[::2], numbers[1::2], strict=True)):
            side, part = ("beyond", "within", "under", "above")[place // 3], place % 3
            if K in PROVES_NOTHING or (
                side in ("under", "above") and part
            ):  # chords of one part end at half the height
                continue
            for z in (Fraction(0), Fraction(top)):
                found = position_at(tuple(sizes), K + M * z * z, z, above=side in ("beyond", "above"))
                assert (found is Position.EXTERIOR) == (side == "beyond") or side in ("within", "above"), (sizes, side)
                assert (found is Position.INTERIOR) == (side == "within") or side in ("beyond", "under"), (sizes, side)
                checked += 1
    assert checked > 100
