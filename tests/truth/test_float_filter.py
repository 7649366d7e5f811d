"""The batch decides as the single decision does, and its filter never proves a wrong answer."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.geometry.pair import Pair
from tests.support.corpus import questions
from tests.support.inside import filtered, float_filter, positions
from tests.support.inside import position as exact_position


@pytest.mark.parametrize("spread", [1, 4, 9, 25])
def test_the_float_filter_decides_most_rows_and_none_wrongly(spread):
    rows = 2.0 ** np.random.default_rng(spread).uniform(-spread, spread, (3000, 7))
    proved = filtered(rows)
    expected = np.array([exact_position(Pair.from_row(row).lengths) for row in rows.tolist()])
    decided = proved != float_filter.UNDECIDED
    assert (proved[decided] == expected[decided]).all()
    assert decided.mean() > 0.9


@pytest.mark.parametrize("exponent", [-52, -51, -50, -45, -40, -30])
@pytest.mark.parametrize("sign", [-1, 1])
def test_next_to_a_tangency_the_float_filter_is_undecided_or_right(exponent, sign):
    """r − a = 1 + sign 2^exponent at the waist, for many a: contact below, exterior above."""
    a = np.arange(1.0, 400.0)
    x = a + 1 + sign * 2.0**exponent
    kept = np.abs(x - a - 1) == 2.0**exponent
    rows = np.zeros((kept.sum(), 7))
    rows[:, 0], rows[:, 1], rows[:, 2:4], rows[:, 4] = a[kept], 1000.0, 1.0, x[kept]
    expected = 1 if sign > 0 else 0
    assert set(filtered(rows).tolist()) <= {expected, float_filter.UNDECIDED}
    assert set(positions(rows).tolist()) <= {expected}


def test_the_float_filter_decides_ordinary_rows_of_every_position():
    """Rows of one order of size, of which it leaves half a percent or more without any witness that has no stand-in."""
    rows = 2.0 ** np.random.default_rng(6).uniform(-2, 2, (4000, 7))
    rows[:, 4:] *= np.random.default_rng(7).choice((-1, 1), (4000, 3))
    proved = filtered(rows)
    expected = np.array([exact_position(Pair.from_row(row).lengths) for row in rows.tolist()])
    for position in (-1, 0, 1):
        assert (proved[expected == position] == position).mean() > 0.999


def test_the_float_filter_treats_rows_with_heights_and_an_axis_of_equal_components_as_tilted():
    rows = np.array([[*row, 1.0, 1.0, 1.0, -3.0, np.inf, 0.0] for row in questions("axis").rows[:60, :7].tolist()])
    assert positions(rows).tolist() == [exact_position(Pair.from_row(row).lengths) for row in rows.tolist()]
    upright = rows.copy()
    upright[:, 7:9] = 0
    assert (positions(rows) != positions(upright)).any()
