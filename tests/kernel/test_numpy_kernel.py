"""The numpy kernel is exact: against proofs, along the borders, and where floats cannot decide."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import hypcheck
from hypcheck.geometry.pair import Pair
from tests.support import inside
from tests.support.inside import Buffers, choice, chunks, kernel_classify, numpy_kernel, positions_of_scene, scene_lines


@pytest.mark.thorough
def test_the_numpy_kernel_is_exact_for_heights_and_sizes_without_lines():
    random = np.random.default_rng(2)
    x, y, z = random.uniform(-4, 4, (3, numpy_kernel.LINES_FROM))
    z[::1000] *= 1e5  # beyond every height of the sample, or the highest of it
    for sizes in ((2.0, 17.8, 0.25, 0.15), (0.5, 3.0, 1.0, 1.0), (9.0, 1.0, 1.0, 1.0), (2e-40, 2e-40, 1e-40, 1e-40)):
        rows = np.column_stack([*(np.full(len(x), size) for size in sizes), x, y, z])
        rows[:, 4:] *= sizes[2]
        columns = np.ascontiguousarray(rows[:, 4:].T)
        assert (positions_of_scene(sizes, *columns) == inside.positions(rows)).all()


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
    truth = inside.positions(np.column_stack([np.tile(sizes, (count, 1)), *columns]))
    lines = scene_lines.lines_of(sizes, z)
    numbers = chunks.PLANE_BUFFERS[0] + chunks.PARALLEL_LINES_BUFFERS[0], chunks.PARALLEL_LINES_BUFFERS[1]
    for ask, constants, buffers, shares in (
        (numpy_kernel.by_parallel_lines, lines.parallel, Buffers(numbers, count, np.float32), parallel),
        (numpy_kernel.by_two_lines, lines.two, Buffers(chunks.TWO_LINES_BUFFERS, count, np.float64), two),
    ):
        found, decided = np.empty(count, np.int8), np.ones(count, np.bool_)
        decided[ask(constants, columns, buffers, found)] = False
        assert (found[decided] == truth[decided]).all()
        for position, share in zip((-1, 0, 1), shares, strict=True):
            assert not share or decided[truth == position].mean() >= share


def test_lines_of_is_none_for_extreme_sizes_and_returns_lines_for_zero_tiny_and_infinite_heights():
    assert scene_lines.lines_of((1.0, 1e300, 1.0, 1.0), np.array([1.0])) is None
    for z in (np.zeros(3), np.array([5e-324]), np.array([np.nan, np.inf, 1e200])):
        lines = scene_lines.lines_of((2.0, 17.8, 0.25, 0.15), z)
        assert lines.two["reach"] > 0
        assert lines.parallel is None


@pytest.mark.parametrize("up", [False, True])
def test_the_square_of_a_shortened_height_is_exact_in_float64(up):
    """A step of the proof that heights up to the top are within the reach of the lines."""
    for value in (1.0, 0.1, 17.8 * 1.0625, 2.0**-60 / 3, 2.0**90 / 7):
        short = scene_lines.shortened(value, up=up)
        assert Fraction(short) ** 2 == Fraction(short * short)
        assert (value <= short <= value * (1 + 2.0**-24)) if up else (value * (1 - 2.0**-24) <= short <= value)


def test_thresholds_are_on_the_safe_side_of_their_lines_at_height_0_and_at_the_greatest_height():
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


@pytest.mark.parametrize("axis", [None, (0.3, 0.1, 0.9)])
def test_rows_in_a_last_chunk_that_is_not_full_are_answered_rightly(axis):
    draw = np.random.default_rng(1)
    count = (numpy_kernel.LINES_CHUNK if axis is None else numpy_kernel.TILTED_CHUNK) + 7
    sizes, columns = (2.0, 17.8, 0.25, 0.15), draw.uniform(-4, 4, (3, count))
    rows = np.column_stack(
        [np.tile(sizes, (count, 1)), columns.T, *([] if axis is None else [np.tile(axis, (count, 1))])]
    )
    expected = hypcheck.classify(rows)
    assert (numpy_kernel.positions(rows) == expected).all()
    assert (positions_of_scene(sizes, *columns, axis) == expected).all()


def test_a_tilted_spheroid_with_b_equal_to_x_is_not_taken_for_a_sphere():
    """b = x: a sphere has b = d, and nothing else makes an axis count for nothing."""
    row = (0.125, 2.0, 1.5, 0.25, 1.5, 0.0, 0.0, 1.0, 0.0, 0.0)
    assert inside.position(Pair.from_row(row).lengths) == 1
    assert numpy_kernel.positions(np.array([row])).tolist() == [1]


@pytest.mark.parametrize(
    ("centre", "expected"),
    [
        ((0.0, 0.0, -1.25), -1),  # farther than its reach from both ends
        ((0.0, 0.0, 0.25), 2),  # it reaches over the upper end
        ((0.0, 0.0, 1.75), 2),
        ((0.0, 0.0, 2.25), 1),
        ((0.0, 0.0, -2.5), 2),
        ((0.0, 0.0, -4.5), 1),
        ((9.0, 0.0, 0.25), 2),
    ],
)
def test_the_numpy_kernel_leaves_a_spheroid_that_reaches_over_an_end_undecided(centre, expected):
    """Between -3 and 1, with a reach of 1."""
    row = (3.0, 2.0, 0.5, 1.0, *centre, 0.0, 0.0, 1.0, -3.0, 1.0, 0.0)
    assert numpy_kernel.answer_ended(np.array([row])).tolist() == [expected]


@pytest.mark.parametrize("heights", [(), (-3.0, 1.0, 0.0), (-3.0, 1.0, 1.0)])
def test_a_sweep_whose_ends_are_on_different_sides_is_contact_in_the_numpy_kernel_unless_there_is_an_opening(heights):
    sizes, axis = (3.0, 2.0, 0.5, 1.0), (0.0, 0.0, 1.0) if heights else ()
    out = (0.0, 0.0, -1.0, 0.0, 0.0, 9.0) if heights else (0.0, 0.0, -1.0, 9.0, 0.0, 0.0)
    stays = (0.0, 0.0, -1.0, 0.0, 0.0, -1.5)
    hits, _ = numpy_kernel.answer_sweeps(np.array([(*sizes, *way, *axis, *heights) for way in (out, stays)]))
    assert hits.tolist() == [2 if heights and not heights[2] else 1, 2]


def test_buffers_for_a_chunk_have_the_length_of_the_chunk():
    buffers = Buffers((2, 1), 8, np.float64)
    for rows in (3, 8):
        numbers, truths = buffers.of(rows)
        assert [len(part) for part in (*numbers, *truths)] == [rows] * 3


def test_classify_scene_fills_the_given_out_array_without_the_compiled_kernel_too(monkeypatch):
    """A unit ball before a wall at 1: it touches where its centre is at 2."""
    out = np.full(4, 9, np.int8)
    monkeypatch.setenv("HYPCHECK_KERNEL", "numpy")
    choice.cache_clear()
    x = np.array([2.5, 2.0, 1.0, 9.0])
    found = kernel_classify.classify_scene((1.0, 2.0, 1.0, 1.0), x, np.zeros(4), np.zeros(4), out=out)
    choice.cache_clear()
    assert np.shares_memory(found, out)
    assert out.tolist() == [1, 0, 0, 1]
