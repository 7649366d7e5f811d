"""The numpy kernel is exact: against proofs, along the borders, and where floats cannot decide."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.geometry.pair import Pair
from hypcheck.kernel import integers, numpy_kernel
from hypcheck.truth import float_filter
from hypcheck.truth.certificate import check_certificate
from hypcheck.truth.prove import prove
from tests.support.pairs import WITNESSES, pairs


@pytest.mark.parametrize(("row", "position", "clearance", "why"), WITNESSES)
def test_the_numpy_kernel_is_right_on_known_witnesses(row, position, clearance, why):
    rows = np.array([row], dtype=float)
    assert numpy_kernel.positions(rows).tolist() == [position], why
    assert integers.position(Pair.from_row(row).lengths) is position, why


@pytest.mark.thorough
@given(st.lists(pairs, min_size=1, max_size=20))
def test_every_answer_has_a_checked_proof(some):
    rows = np.array([pair.row for pair in some])
    for pair, position in zip(some, numpy_kernel.positions(rows).tolist(), strict=True):
        certificate = prove(pair)
        assert certificate.position == position
        assert check_certificate(pair, certificate)


@given(pairs, st.lists(st.tuples(*[st.floats(-1e6, 1e6)] * 3), min_size=1, max_size=20))
def test_positions_of_a_scene_are_those_of_its_rows(pair, centers):
    x, y, z = np.array(centers).T
    rows = np.column_stack([*(np.full(len(x), size) for size in pair.row[:4]), x, y, z])
    found = numpy_kernel.positions_of_scene(pair.row[:4], x, y, z)
    assert found.tolist() == numpy_kernel.positions(rows).tolist()


@pytest.mark.parametrize("spread", [1, 5, 12, 30])
def test_the_numpy_kernel_is_right_on_random_rows_of_all_regimes(spread):
    rows = 2.0 ** np.random.default_rng(spread).uniform(-spread, spread, (4000, 7))
    expected = [integers.position(Pair.from_row(row).lengths) for row in rows.tolist()]
    assert numpy_kernel.positions(rows).tolist() == expected


@pytest.mark.parametrize("exponent", range(-52, -20, 4))
@pytest.mark.parametrize("sign", [-1, 0, 1])
def test_the_certified_stage_leaves_tangencies_undecided(exponent, sign):
    """r − a = 1 + sign 2^exponent at the waist; the walls are steep, so the nearest point is there."""
    a = np.arange(1.0, 200.0)
    x = a + 1 + sign * 2.0**exponent
    kept = x - a - 1 == sign * 2.0**exponent
    rows = np.zeros((kept.sum(), 7))
    rows[:, 0], rows[:, 1], rows[:, 2:4], rows[:, 4] = a[kept], 1000.0, 1.0, x[kept]
    assert set(numpy_kernel.positions(rows).tolist()) <= {1 if sign > 0 else 0}


def test_rows_of_a_chunk_and_beyond_are_all_answered():
    count = 2 * numpy_kernel.CHUNK + 3
    rows = np.tile([2.0, 5.0, 1.0, 1.0, 9.0, 0.0, 0.0], (count, 1))
    rows[-1, 4] = 0.5
    found = numpy_kernel.positions(rows)
    assert found[:-1].tolist() == [1] * (count - 1)
    assert found[-1] == -1


@pytest.mark.thorough
def test_heights_that_no_line_covers_and_sizes_that_allow_none_are_answered_too():
    random = np.random.default_rng(2)
    x, y, z = random.uniform(-4, 4, (3, numpy_kernel.LINES_FROM))
    z[::1000] *= 1e5  # beyond every height of the sample, or the highest of it
    for sizes in ((2.0, 17.8, 0.25, 0.15), (0.5, 3.0, 1.0, 1.0), (9.0, 1.0, 1.0, 1.0), (2e-40, 2e-40, 1e-40, 1e-40)):
        rows = np.column_stack([*(np.full(len(x), size) for size in sizes), x, y, z])
        rows[:, 4:] *= sizes[2]
        columns = np.ascontiguousarray(rows[:, 4:].T)
        assert (numpy_kernel.positions_of_scene(sizes, *columns) == float_filter.positions(rows)).all()
