"""Minimisation reaches the simplest row that is wrong in the same way."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import PAIRS
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.implementation import open_implementation
from hypcheck.runs.hunt import target_of
from hypcheck.runs.judge import Status
from hypcheck.runs.minimise import characters, complexity, minimise, rounded, same_query, simpler_than, small_pairs
from hypcheck.runs.replay import ReplayCase
from hypcheck.vectors.families import FAMILIES
from tests.support.fractions_truth import exact_position
from tests.support.inside import Kind, decide


def minimised(spec, row, domain=None, **claims):
    with open_implementation(f"builtin:{spec}", domain=domain) as implementation:
        return minimise(target_of(spec, implementation, **claims), ReplayCase("the given row", tuple(row)))


@pytest.fixture(scope="module")
def refused_rings():
    """Rows of the family ring, all of them exterior, that Table 2 in float64 calls not exterior."""
    rows = FAMILIES["ring"].rows(3, 200)
    with open_implementation("builtin:table-2-float64") as implementation:
        return rows[implementation.classify(rows).answers == 0].tolist()


def check(run):
    """The last row is wrong in the way of the first, by the definitions."""
    first, last = run.first.case, run.last.case
    assert exact_position(last.row) == last.truth == first.truth
    assert (last.answer, last.mistake) == (first.answer, first.mistake)
    assert last.status is Status.WRONG
    assert run.last.place.cause == run.first.place.cause
    assert run.target.claimed(np.array([last.row])).tolist() == [0]
    assert run.target.implementation.classify(np.array([last.row])).answers[0] == last.answer
    steps = [complexity(step.case.row) for step in run.steps]
    assert all(after < before for before, after in pairwise(steps))


@pytest.mark.parametrize("place", range(5))
def test_every_ring_case_is_minimised_to_a_ring_of_single_digits(refused_rings, place):
    run = minimised("table-2-float64", refused_rings[place])
    check(run)
    assert decide(Pair.from_row(run.last.case.row).lengths).kind is Kind.EXTERIOR_RING
    total, longest, _ = complexity(run.last.case.row)
    assert total <= 7  # (1, 2, 1, 1, 2.5, 0, 0) has 7
    assert longest == 1


def test_minimised_row_stays_in_the_domain_of_the_implementation():
    """With α/b and γ/d in 5 … 1000 the ring (7, 7, 1, 1, 10, 0, 0) is about the simplest."""
    run = minimised("table-2-float64", (7, 11, 1, 1, 8, 114 / 11, 0), Domain(ratio=(5.0, 1000.0)))
    check(run)
    alpha, gamma, b, d = run.last.case.row[:4]
    assert alpha / b >= 5
    assert gamma / d >= 5
    assert complexity(run.last.case.row)[0] < complexity(run.first.case.row)[0]


def test_minimised_row_is_still_wrong_beyond_the_tolerance():
    sizes = (1.358995682045953, 0.05380053815595681, 1.2878085719496009, 0.052372349017701395)
    row = (*sizes, -2.4977900109670843, -0.8755459253855836, -2.1774468648097007e-06)
    run = minimised("table-2-float64", row, tolerance=5 * 10**9)
    check(run)
    assert run.last.error_u > 5e9


def test_minimise_leaves_the_simplest_row_unchanged():
    run = minimised("table-2-float64", (1, 1, 2, 1, 3, 1, 0))
    assert len(run.steps) == 1
    assert run.last.case.row == (1, 1, 2, 1, 3, 1, 0)


@pytest.mark.parametrize(
    ("spec", "row", "most", "claims"),
    [
        # c1 = 0 and c2 = 0 exactly: Procedure 2.a forgets them.
        ("procedure-2a-spheroid-float64", (494.818359375, 0.125, 2**-8, 0.125, 0, 2**-8, 0), 6, {}),
        (
            "procedure-2a-spheroid-float64",
            (15.8701171875, 2**-5, 0.5126953125, 0.46875, -1.7431640625, 14.673828125, 5.3125),
            6,
            {},
        ),
        # A sphere too round for the groove, called clear.
        ("procedure-1-float64", (6.17385, 0.000398, 0.0390625, 35.1515, 0, -6.1953, 35.0708), 7, {"regimes": ()}),
        # A tower of 30 m and a drone of 1 cm in float32.
        ("table-2-float32", (30.125, 70.5, 0.0101, 0.0103, 34.5, 2.25, 3.125), 10, {}),
        # Rounding at the border of contact, where digits cannot be spared altogether.
        (
            "local-maximum-float64",
            (
                *(60.0706571767595, 28.34703435225913, 0.5041032971887296, 2.596786277141259),
                *(23.687345995534695, -55.75133403053211, 1.738408851492935e-09),
            ),
            20,
            {},
        ),
    ],
)
def test_minimise_shortens_rows_of_failures_off_the_ring_too(spec, row, most, claims):
    run = minimised(spec, row, **claims)
    check(run)
    assert complexity(row)[0] > 3 * most
    assert complexity(run.last.case.row)[0] <= most
    assert run.asked < 250_000


@pytest.mark.parametrize(
    ("row", "claims", "sentence"),
    [
        ((2, 5, 1, 1, 4, 0, 0), {}, "is not wrong"),
        ((2, 0.5, 1, 1, 4, 0, 0), {}, "does not claim"),
        ((1, 2, 1, 1, 2.5, 0, 0), {"tolerance": 10**15 * 2}, "within tolerance"),
    ],
)
def test_minimise_refuses_a_row_that_is_answered_rightly(row, claims, sentence):
    with pytest.raises(InputError, match=sentence):
        minimised("table-2-float64", row, **claims)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_complexity_counts_the_characters_of_the_shortest_text_of_a_number(value):
    count = characters(value)
    if value == 0:
        assert count == 0
        return
    assert count <= len(repr(value).removesuffix(".0"))
    digits = 17 if count > 17 else count
    texts = {f"{value:.{precision}e}" for precision in range(17)} | {f"{value:.{places}f}" for places in range(20)}
    written = {_without_zeros(text) for text in texts if float(text) == value}
    assert min(map(len, written)) == count or digits == 17


def _without_zeros(text):
    mantissa, e, exponent = text.partition("e")
    mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
    return f"{mantissa}e{int(exponent)}" if e else mantissa


@pytest.mark.parametrize(
    ("value", "count"), [(1.0, 1), (-2.5, 4), (0.1, 3), (1e-7, 4), (6000.0, 3), (100.0, 3), (1 / 3, 18), (5e-324, 6)]
)
def test_characters_counts_those_of_the_shortest_decimal(value, count):
    assert characters(value) == count


def test_roundings_of_a_value_are_numbers_beside_it_with_more_and_more_digits():
    values = list(rounded(2.718281828459045))
    assert values[:6] == [3, 4, 2, 2.7, 2.8, 2.6]
    assert all(abs(value - 2.718281828459045) < 2 for value in values)


def test_the_same_pair_in_other_coordinates_has_the_same_position():
    for row in map(tuple, FAMILIES["small-integers"].rows(4, 20).tolist()):
        mirrored = list(same_query(row, PAIRS))[:8]  # radii and units are rounded
        assert {exact_position(other) for other in mirrored} == {exact_position(row)}
        assert all(min(other[4:7]) >= 0 for other in mirrored)


def test_small_pairs_simpler_than_a_limit_are_distinct_and_sorted_by_complexity():
    rows = [tuple(row) for row in simpler_than(small_pairs(), (6, 1, 9)).tolist()]
    assert len(set(rows)) == len(rows) > 1000
    complexities = [complexity(row) for row in rows]
    assert complexities == sorted(complexities)
    ring = (1, 1, 2, 1, 3, 1, 0)  # of complexity (6, 1, 9) itself
    assert ring not in rows
    assert ring in {tuple(row) for row in simpler_than(small_pairs(), (6, 1, 10)).tolist()}


def test_simpler_than_keeps_each_valid_simpler_row_once():
    good, invalid = (1, 1, 1, 1, 2, 0, 0), (1, 1, 0, 1, 2, 0, 0)
    rows = simpler_than([(1, 1, 1, 1, 2.5, 0, 0), good, good, invalid, (1, 1, 1, 1, math.inf, 0, 0)], (6, 1, 1))
    assert rows.tolist() == [list(good)]
