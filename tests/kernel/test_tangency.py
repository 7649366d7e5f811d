"""Exact tangencies proved by a double root, a hair beside them, and what a row costs at most."""

from __future__ import annotations

import ctypes
import re

import numpy as np
import pytest
import sympy

from hypcheck.derivation.program import needed
from hypcheck.vectors.families import FAMILIES
from tests.kernel.compiling import HEADER, needs_compiler, shared_library
from tests.kernel.test_page import PAGE
from tests.support import inside
from tests.support.inside import FLOAT64_BITS, INTEGERS, bits_counted

UNSURE = 2

ASKED = ("delta", "slope_at_B", "ring_excess")
"""What the rule asks of a row at most: where there is no ring it is less."""


def limb_products(of_inputs):
    """The most products of two limbs that INTEGERS takes for a row, by the method of school."""
    bits = bits_counted(INTEGERS, of_inputs)

    def limbs(argument):
        return -(-(bits[argument] if isinstance(argument, str) else abs(argument).bit_length()) // 64)

    products = (step.arguments for step in needed(INTEGERS, ASKED) if step.operation == "mul")
    return sum(limbs(left) * limbs(right) for left, right in products)


def test_the_cubic_with_a_double_root_has_the_coefficients_that_the_kernel_compares():
    """(D l - M)² (l - e²/D²) with M e = D K has the coefficients that the kernel compares."""
    D, K, M, x = sympy.symbols("D K M x")
    e = D * K / M
    cubic = sympy.expand((D * x - M) ** 2 * (x - e**2 / D**2))
    n2, n1 = -(2 * D * M + e**2), M**2 + 2 * K * e
    assert sympy.simplify(cubic - (D**2 * x**3 + n2 * x**2 + n1 * x - K**2)) == 0


FUNCTIONS = """
#include <stddef.h>
static size_t counted;
#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"
int beside(double *row) {
    double about;
    return hc_fixed_position(row, &about) == 2 ? hc_position_beside_tangency(row, about) : 2;
}
int with_lengths(double *row, int bits) {
    uint64_t lengths[7];
    double about;
    if (hc_fixed_position(row, &about) != 2 || hc_short_lengths(row, lengths) != bits) return 2;
    return hc_touches_by(lengths, about);
}
int bits_of(double *row) {
    uint64_t lengths[7];
    return hc_short_lengths(row, lengths);
}
int in_plane(double *row) {
    uint64_t lengths[7];
    return hc_short_lengths(row, lengths) > HC_TANGENCY_BITS ? 2 : hc_position_in_plane(lengths);
}
int exact(double *row) { return hc_exact_position(row); }
size_t count(void) {
    const size_t so_many = counted;
    counted = 0;
    return so_many;
}
"""

COUNTED = {
    "    const hc_wide wide = (hc_wide)left * right;\n": "counted++;",
    "    hc_wide carry = 0;\n    int i;\n    if (first) {\n": "counted += (size_t)length;",
    "static void hc_scale(hc_integer *product, hc_limb factor, const hc_integer *number) {\n    hc_wide carry = 0;\n": (
        "counted += (size_t)number->length;"
    ),
}


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """The kernel with a counter beside each product of two limbs."""
    text = HEADER.read_text(encoding="utf-8")
    for place, counting in COUNTED.items():
        assert text.count(place) == 1
        text = text.replace(place, f"{place}    {counting}\n")
    folder = tmp_path_factory.mktemp("tangency")
    (folder / "hypcheck.h").write_text(text, encoding="utf-8")
    return shared_library(folder, FUNCTIONS, "-std=c11", "-DHYPCHECK_PLAIN", "-O0", "-Wno-declaration-after-statement")


def asked(function, rows, *more) -> np.ndarray:
    return np.array([function((ctypes.c_double * 7)(*row), *more) for row in rows.tolist()])


@pytest.mark.slow
@needs_compiler
def test_the_tangency_stage_answers_tangencies_and_not_rows_one_ulp_beside_them(library):
    rows = FAMILIES["tangent"].rows(3, 60)
    found = asked(library.beside, rows)
    assert (found != UNSURE).mean() > 0.9
    assert (found[found != UNSURE] == 0).all()
    assert len(set(asked(library.bits_of, rows) > 23)) == 2  # by 128 bits and by 256
    for column in (0, 1, 2, 3, 4):
        beside = rows[rows[:, column] != 0]
        beside[:, column] = np.nextafter(beside[:, column], np.inf)
        found = asked(library.beside, beside)
        assert (found[beside[:, 6] != 0] == UNSURE).mean() > 0.5
        assert (found == inside.positions(beside))[found != UNSURE].all()


@needs_compiler
@pytest.mark.parametrize("hair", [1e-20, 1e-60, 1e-300])
def test_the_tangency_stage_is_right_on_tangencies_moved_by_a_tiny_length(library, hair):
    rows = FAMILIES["tangent"].rows(4, 60)
    for column in (4, 5, 6):
        moved = rows[rows[:, column] == 0]
        moved[:, column] = hair * moved[:, 1 if column == 6 else 2]
        found, truth = asked(library.beside, moved), inside.positions(moved)
        assert (found == truth)[found != UNSURE].all()
        assert (found != UNSURE).mean() > 0.8
        assert len(set(truth.tolist())) > 1


@needs_compiler
def test_the_tangency_stage_decides_most_rows_in_the_plane_of_the_waist_rightly(library):
    random = np.random.default_rng(8)
    whole = random.integers(1, 6, (300, 4)) * [1.0, 5.0, 1.0, 1.0]
    rows = np.column_stack([whole, random.integers(0, 20, (300, 2)) / 4, np.zeros(300)])
    found, truth = asked(library.in_plane, rows), inside.positions(rows)
    assert (found == truth)[found != UNSURE].all()
    assert (found != UNSURE).mean() > 0.8
    assert set(found.tolist()) == {-1, 0, 1, UNSURE}


def told() -> dict[str, int]:
    """The bounds that the page tells: for fixed point, for tangencies, and for lengths of so many bits."""
    rows = re.findall(r"^\| ([^|]+) \| ([\d,]+) \|$", PAGE, flags=re.MULTILINE)
    return {name: int(number.replace(",", "")) for name, number in rows}


def test_the_kernel_page_states_the_most_limb_products_of_the_integer_stage():
    page = told()
    for bits in (62, 128, FLOAT64_BITS):
        assert page[f"integers, lengths of {bits} bits"] == limb_products(bits)


@needs_compiler
def test_no_row_takes_more_limb_products_than_the_kernel_page_states(library):
    page, most = told(), 0
    names = ("tangent", "osculation", "ring", "near-axis", "extreme-float64", "extreme-hair", "tower-body")
    rows = np.concatenate([FAMILIES[name].rows(6, 12) for name in names])
    library.count.restype = ctypes.c_size_t
    before = page["fixed point"] + page["a tangency"]
    for row in rows:
        library.count()
        library.exact((ctypes.c_double * 7)(*row))
        taken = library.count()
        bits = longest(row)
        assert taken <= before + limb_products(bits), row.tolist()
        most = max(most, taken / (before + limb_products(bits)))
    assert most > 0.5


def longest(row: np.ndarray) -> int:
    """The bits of the longest length, in units of the lowest bit of its kind."""
    found = 0
    for kind in ([0, 2, 4, 5], [1, 3, 6]):
        pairs = [abs(float(value)).as_integer_ratio() for value in row[kind]]
        unit = max(below for _, below in pairs)
        whole = [above * (unit // below) for above, below in pairs]
        low = min(value & -value for value in whole if value)
        found = max(found, max(whole).bit_length() - low.bit_length() + 1)
    return found
