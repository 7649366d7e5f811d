"""The numpy kernel is exact: against proofs, along the borders, and where floats cannot decide."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.geometry.pair import Pair
from hypcheck.kernel import integers, numpy_kernel, scene_lines
from hypcheck.kernel.numpy_kernel import Buffers, chunks
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
def test_every_answer_of_the_numpy_kernel_has_a_certificate_that_holds(some):
    rows = np.array([pair.row for pair in some])
    for pair, position in zip(some, numpy_kernel.positions(rows).tolist(), strict=True):
        certificate = prove(pair)
        assert certificate.position == position
        assert check_certificate(pair, certificate)


@pytest.mark.slow
@given(pairs, st.lists(st.tuples(*[st.floats(-1e6, 1e6)] * 3), min_size=1, max_size=20))
def test_the_numpy_kernel_answers_a_scene_as_its_rows(pair, centers):
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
def test_the_numpy_kernel_is_exact_within_a_few_units_of_a_tangency(exponent, sign):
    """r − a = 1 + sign 2^exponent at the waist; the walls are steep, so the nearest point is there."""
    a = np.arange(1.0, 200.0)
    x = a + 1 + sign * 2.0**exponent
    kept = x - a - 1 == sign * 2.0**exponent
    rows = np.zeros((kept.sum(), 7))
    rows[:, 0], rows[:, 1], rows[:, 2:4], rows[:, 4] = a[kept], 1000.0, 1.0, x[kept]
    assert set(numpy_kernel.positions(rows).tolist()) <= {1 if sign > 0 else 0}


def test_the_numpy_kernel_answers_rows_of_several_chunks():
    count = 2 * numpy_kernel.CHUNK + 3
    rows = np.tile([2.0, 5.0, 1.0, 1.0, 9.0, 0.0, 0.0], (count, 1))
    rows[-1, 4] = 0.5
    found = numpy_kernel.positions(rows)
    assert found[:-1].tolist() == [1] * (count - 1)
    assert found[-1] == -1


@pytest.mark.thorough
def test_the_numpy_kernel_is_exact_for_heights_and_sizes_without_lines():
    random = np.random.default_rng(2)
    x, y, z = random.uniform(-4, 4, (3, numpy_kernel.LINES_FROM))
    z[::1000] *= 1e5  # beyond every height of the sample, or the highest of it
    for sizes in ((2.0, 17.8, 0.25, 0.15), (0.5, 3.0, 1.0, 1.0), (9.0, 1.0, 1.0, 1.0), (2e-40, 2e-40, 1e-40, 1e-40)):
        rows = np.column_stack([*(np.full(len(x), size) for size in sizes), x, y, z])
        rows[:, 4:] *= sizes[2]
        columns = np.ascontiguousarray(rows[:, 4:].T)
        assert (numpy_kernel.positions_of_scene(sizes, *columns) == float_filter.positions(rows)).all()


SCENES = [
    # Sizes, and the least shares of interior, contact and exterior that the first and the second kind of lines decide.
    ((2.0, 17.8, 0.25, 0.15), (0.98, 0.97, 0.985), (0.996, 0.991, 0.996)),
    ((1.0, 4.0, 1.0, 1.0), (0, 0, 0.99), (0, 0, 0.997)),
    ((3.0, 1.0, 1.0, 2.0), (0.99, 0.997, 0), (0.998, 0.998, 0)),
    ((5.0, 2.0, 0.3, 1.5), (0.14, 0.98, 0), (0.97, 0.996, 0)),
    ((0.5, 3.0, 1.0, 0.2), (0, 0, 0.99), (0, 0, 0.997)),
    ((40.0, 30.0, 2.0, 3.0), (0.92, 0.88, 0.92), (0.98, 0.965, 0.975)),
]


@pytest.mark.parametrize(("sizes", "parallel", "two"), SCENES)
def test_lines_of_the_numpy_kernel_decide_most_centres_near_the_surface_and_none_wrongly(sizes, parallel, two):
    alpha, gamma, b, _ = sizes
    draw, count = np.random.default_rng(1), 8192
    z = draw.uniform(-1.5 * gamma, 1.5 * gamma, count)
    away, angle = draw.uniform(-3, 3, count) * b, draw.uniform(0, 6.28, count)
    r = alpha * np.sqrt(1 + (z / gamma) ** 2) + away
    columns = r * np.cos(angle), r * np.sin(angle), z
    truth = float_filter.positions(np.column_stack([np.tile(sizes, (count, 1)), *columns]))
    lines = scene_lines.lines_of(sizes, z)
    numbers = chunks.PLANE_BUFFERS[0] + chunks.PARALLEL_LINES_BUFFERS[0], chunks.PARALLEL_LINES_BUFFERS[1]
    for ask, constants, buffers, shares in (
        (numpy_kernel._by_parallel_lines, lines.parallel, Buffers(numbers, count, np.float32), parallel),
        (numpy_kernel._by_two_lines, lines.two, Buffers(chunks.TWO_LINES_BUFFERS, count, np.float64), two),
    ):
        found, decided = np.empty(count, np.int8), np.ones(count, np.bool_)
        decided[ask(constants, columns, buffers, found)] = False
        assert (found[decided] == truth[decided]).all()
        for position, share in zip((-1, 0, 1), shares, strict=True):
            assert not share or decided[truth == position].mean() >= share


def test_lines_of_is_none_for_extreme_sizes_and_gives_lines_for_heights_of_zero():
    assert scene_lines.lines_of((1.0, 1e300, 1.0, 1.0), np.array([1.0])) is None
    for z in (np.zeros(3), np.array([5e-324]), np.array([np.nan, np.inf, 1e200])):
        lines = scene_lines.lines_of((2.0, 17.8, 0.25, 0.15), z)
        assert lines.two["reach"] > 0
        assert lines.parallel is None


@pytest.mark.parametrize("up", [False, True])
def test_a_shortened_height_has_a_square_without_rounding(up):
    for value in (1.0, 0.1, 17.8 * 1.0625, 2.0**-60 / 3, 2.0**90 / 7):
        short = scene_lines._short(value, up=up)
        assert Fraction(short) ** 2 == Fraction(short * short)
        assert (value <= short <= value * (1 + 2.0**-24)) if up else (value * (1 - 2.0**-24) <= short <= value)


def test_thresholds_of_lines_are_on_the_safe_side_of_the_lines_at_both_ends():
    lines = {"beyond": (3.0, 0.5), "under": (2.5, 0.375), "within": (1.5, 0.25), "above": None}
    reach = 7.0
    found = scene_lines.thresholds(lines, reach)
    assert found["K_above"] == np.inf
    assert found["reach"] <= reach
    for T in (0.0, reach):
        assert 3.0 + 0.5 * T < found["K_beyond"] + found["M_outer"] * T < (3.0 + 0.5 * T) * 1.0001 + 0.125 * reach
        assert 2.5 + 0.375 * T - 0.125 * reach < found["K_under"] + found["M_outer"] * T < 2.5 + 0.375 * T
        assert (1.5 + 0.25 * T) * 0.9999 < found["K_within"] + found["M_inner"] * T < 1.5 + 0.25 * T
    nothing = dict.fromkeys(lines)
    found = scene_lines.thresholds(nothing, reach)
    assert [found[f"K_{name}"] for name in nothing] == [np.inf, -np.inf, -np.inf, np.inf]
    assert scene_lines.thresholds(lines, 1e-30) is None
    assert scene_lines.thresholds(lines, 1e30) is None
    assert scene_lines.thresholds(lines | {"under": (2.5, 1e20)}, reach) is None
