"""The octaves that floats find are those that exact changes find, of every family and next to every power of two."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hypcheck.geometry.pair import Pair
from hypcheck.runs import judge
from hypcheck.vectors.families import FAMILIES
from tests.support.inside import decide, distance_exponents, exponent, flip_exponents, positions


def one_by_one(rows):
    octaves = []
    for row in rows.tolist():
        pair = Pair.from_row(row)
        truth = decide(pair.lengths)
        targets = judge.right_positions(truth.position, 0, truth.position.name.lower())
        octaves.append(min(exponent(pair, truth, target) for target in targets))
    return octaves


@pytest.mark.slow
@pytest.mark.parametrize("name", FAMILIES)
def test_distance_exponents_of_a_block_equal_those_computed_exactly_row_by_row(name):
    rows = FAMILIES[name].rows(11, 7)
    assert flip_exponents(rows).tolist() == one_by_one(rows)


def test_fewer_than_5_percent_of_ordinary_rows_need_an_exact_distance_exponent():
    for name in ("tower-body", "uniform", "forest-type-2"):
        rows = FAMILIES[name].rows(12, 1000)
        assert np.isnan(distance_exponents(rows, positions(rows))).mean() < 0.05


@pytest.mark.parametrize("sign", [-1, 1])
def test_distance_exponents_are_nan_or_right_if_the_distance_is_near_a_power_of_two(sign):
    """x = α + b + δ at the waist: the distance is about δ/(α + b + x), here about a power of two."""
    steps = np.concatenate([2.0 ** np.arange(-12, -6), -(2.0 ** np.arange(-12, -6)), [0.0]])
    rows = np.zeros((20 * len(steps), 7))
    for place, (power, step) in enumerate((k, step) for k in range(-42, -2, 2) for step in steps):
        rows[place, :4] = 2.0, 1000.0, 1.0, 1.0
        rows[place, 4] = 3 + sign * 6 * 2.0**power * (1 + step)
    found = distance_exponents(rows, positions(rows))
    told = ~np.isnan(found)
    assert 0.3 < told.mean() < 1
    assert found[told].tolist() == np.array(one_by_one(rows))[told].tolist()


def test_a_tangency_has_no_distance_exponent():
    rows = np.array([[2.0, 1000.0, 1.0, 1.0, 3.0, 0.0, 0.0]])
    assert flip_exponents(rows).tolist() == [-math.inf]
