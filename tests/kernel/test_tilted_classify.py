"""The public functions for tilted spheroids: exact answers, any axis that has a direction, refusals."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest

import hypcheck
from hypcheck.errors import InputError
from hypcheck.scene.model import QUESTIONS
from tests.kernel.test_tilted_integers import RINGS, small_rows, wide_rows
from tests.support.inside import (
    choice,
    exact_position,
    integers_whole_position,
    kernel,
    kernel_classify,
    numpy_kernel,
    positions,
)

KERNELS = [numpy_kernel, kernel()] if choice().kernel == "compiled" else [numpy_kernel]
SIZES = (2.0, 3.0, 0.5, 1.5)
AXES = (
    (0.3, -0.2, 0.9),
    (1.0, 0.0, 0.0),
    (5e-324, -1e-323, 1.5e-323),
    (1e300, 1.7e308, -1e300),
    (1e300, 1.0, 1e20),
    (1e-20, 0.0, 1.0),
)
MIXED = (1e-300, 1e300, 1.0)  # which floats have no room for


@pytest.fixture(scope="module")
def rows():
    small = small_rows(21, 160)
    vertical = [[*row[:7], 0.0, -0.0, -3.0] for row in small[:60]]
    spheres = [[*row[:3], row[2], *row[4:]] for row in small[:60]]
    stretched = [[*row[:7], *(each * 2.0**-1060 for each in row[7:])] for row in small[:60]]
    return np.array([*(row for row, _ in RINGS), *small, *vertical, *spheres, *stretched, *wide_rows(22, 40)])


@pytest.fixture(scope="module")
def truth(rows):
    return positions(rows)


@pytest.fixture(scope="module")
def centres():
    random = np.random.default_rng(23)
    return random.uniform(-5, 5, (3, 700))


def scene_rows(axis, centres):
    return np.column_stack([np.tile(SIZES, (centres.shape[1], 1)), centres.T, np.tile(axis, (centres.shape[1], 1))])


@pytest.mark.parametrize("each", KERNELS)
@pytest.mark.parametrize("question", QUESTIONS)
def test_rows_of_ten_numbers_are_answered_exactly_by_every_kernel(each, question, rows, truth):
    yes = {"position": truth, "exterior": truth == 1, "interior": truth == -1, "contact": truth == 0}
    found, refused = each.answer_rows(rows, question)
    assert (found.tolist(), refused) == (yes[question].astype(int).tolist(), 0)


@pytest.mark.parametrize("axis", AXES)
def test_classify_scene_with_one_axis_is_exact_in_every_kernel(axis, centres):
    truth = positions(scene_rows(axis, centres))
    many = np.tile(centres, 4)  # enough for half spaces
    for question, wanted in (
        ("position", truth),
        ("exterior", truth == 1),
        ("interior", truth == -1),
        ("contact", truth == 0),
    ):
        for each, (columns, count) in itertools.product(KERNELS, ((centres, 1), (many, 4))):
            found, refused = each.answer_scene(SIZES, tuple(columns), question, None, axis)
            assert (found.tolist(), refused) == (np.tile(wanted, count).astype(int).tolist(), 0)


@pytest.mark.parametrize("each", KERNELS)
def test_classify_scene_is_exact_with_an_axis_of_very_different_magnitudes(each, centres):
    some = centres[:, :25]
    found, refused = each.answer_scene(SIZES, tuple(some), "position", None, MIXED)
    assert (found.tolist(), refused) == (positions(scene_rows(MIXED, some)).tolist(), 0)


def test_classify_scene_takes_one_axis_or_one_for_each_centre(centres):
    random = np.random.default_rng(24)
    axes = random.normal(size=(centres.shape[1], 3)) * 10.0 ** random.integers(-300, 300, (centres.shape[1], 1))
    truth = positions(np.column_stack([np.tile(SIZES, (len(axes), 1)), centres.T, axes])).tolist()
    x, y, z = centres
    assert hypcheck.classify_scene(SIZES, x, y, z, axis=axes).tolist() == truth
    assert hypcheck.classify_scene(SIZES, x[::-1], y[::-1], z[::-1], axis=axes[::-1]).tolist() == truth[::-1]
    assert hypcheck.classify_scene(SIZES, x, y, z, axis=np.asfortranarray(axes), threads=3).tolist() == truth
    assert hypcheck.classify_scene(SIZES, x[0], y[0], z[0], axis=axes[:1]).tolist() == truth[:1]
    out = np.full(2 * len(x), 99, np.int8)
    assert hypcheck.classify_scene(SIZES, x, y, z, out[::2], axis=axes).base is out
    assert out[::2].tolist() == truth
    one = hypcheck.classify_scene(SIZES, x, y, z, axis=[3, 0, 1])
    assert hypcheck.classify_scene(SIZES, x, y, z, axis=np.float32([[3, 0, 1]])).tolist() == one.tolist()
    assert hypcheck.classify_scene(SIZES, x, y, z, axis=[[3, 0, 1]] * len(x)).tolist() == one.tolist()
    several = hypcheck.classify_scene(SIZES, 2.25, 0, 0, axis=np.eye(3))
    assert several.tolist() == [hypcheck.position(*SIZES, 2.25, 0.0, 0.0, axis=axis) for axis in np.eye(3)]
    assert hypcheck.classify_scene(SIZES, [], 0, 0, axis=np.empty((0, 3))).tolist() == []


def test_classify_scene_with_an_axis_for_each_centre_works_in_several_parts(centres, monkeypatch):
    axes = np.random.default_rng(25).normal(size=(centres.shape[1], 3))
    whole = hypcheck.classify_scene(SIZES, *centres, axis=axes)
    monkeypatch.setattr(kernel_classify, "ROWS_AT_A_TIME", 64)
    assert (hypcheck.classify_scene(SIZES, *centres, axis=axes) == whole).all()
    axes[300] = 0
    with pytest.raises(
        InputError, match=r"^row 300: axis_x, axis_y, axis_z are 0, 0, 0; an axis must have a direction"
    ):
        hypcheck.classify_scene(SIZES, *centres, axis=axes)


BAD = {
    "axis_x, axis_y, axis_z are 0, 0, 0; an axis must have a direction": (0.0, -0.0, 0.0),
    "axis_y is nan; it must be finite": (1.0, np.nan, 0.0),
    "axis_z is -inf; it must be finite": (0.0, 0.0, -np.inf),
}


@pytest.mark.parametrize(("sentence", "axis"), BAD.items())
@pytest.mark.parametrize("d", [1.5, 0.5], ids=["spheroid", "sphere"])
def test_classify_refuses_an_invalid_axis_or_marks_it_with_127(sentence, axis, d):
    rows, out = np.array([[2, 3, 0.5, d, 1, 0, 0, 0, 1, 1]] * 3), np.full(3, 99, np.int8)
    rows[1, 7:] = axis
    right = hypcheck.classify(rows[:1]).tolist()
    sizes = (2.0, 3.0, 0.5, d)
    for call in (
        lambda: hypcheck.classify(rows, out=out),
        lambda: hypcheck.classify_scene(sizes, 1, 0, 0, out, axis=rows[:, 7:]),
    ):
        with pytest.raises(InputError, match=f"^row 1: {re.escape(sentence)}$"):
            call()
    assert out.tolist() == [99] * 3
    for position in (hypcheck.position, exact_position):
        with pytest.raises(InputError, match=f"^{re.escape(sentence)}$"):
            position(*sizes, 1.0, 0.0, 0.0, axis=axis)
    with pytest.raises(InputError, match=f"^{re.escape(sentence)}$"):
        hypcheck.classify_scene(sizes, [1, 2, 3], 0, 0, out, axis=axis)
    marked = [*right, 127, *right]
    assert hypcheck.classify(rows, on_invalid="flag", out=out).tolist() == marked
    assert hypcheck.classify_scene(sizes, 1, 0, 0, axis=rows[:, 7:], on_invalid="flag").tolist() == marked
    assert hypcheck.classify_scene(sizes, [1, 2, 3], 0, 0, axis=axis, on_invalid="flag").tolist() == [127] * 3
    for each in KERNELS:
        for question in QUESTIONS:
            found, refused = each.answer_rows(rows, question)
            assert (found[1], refused) == (127, 1)
            found, refused = each.answer_scene(sizes, tuple(rows[:, 4:7].T), question, None, axis)
            assert (found.tolist(), refused) == ([127] * 3, 3)


@pytest.mark.parametrize(
    ("axis", "found"),
    [
        ((1.0, 2.0), r"of shape \(2,\)"),
        (np.ones((2, 2)), r"of shape \(2, 2\)"),
        (np.ones((2, 1, 3)), r"of shape \(2, 1, 3\)"),
        (3.0, r"of shape \(\)"),
        ("up", "'up'"),
        ((1, None, 2), r"\(1, None, 2\)"),
        ((True, False, True), r"\(True, False, True\)"),
    ],
)
def test_classify_scene_refuses_an_axis_of_another_shape_or_type(axis, found):
    with pytest.raises(InputError, match=rf"^axis is {found}; it must be three numbers, axis_x, axis_y, axis_z, or an"):
        hypcheck.classify_scene(SIZES, [1, 2], 0, 0, axis=axis)
    with pytest.raises(InputError, match=r"^axis(_[xyz])? is .*; it must be "):
        hypcheck.position(*SIZES, 1.0, 0.0, 0.0, axis=axis)


def test_classify_scene_refuses_another_number_of_axes_than_centres():
    with pytest.raises(InputError, match=r"x \(2,\), .* axis_x \(3,\), .* have shapes that do not fit together"):
        hypcheck.classify_scene(SIZES, [1, 2], 0, 0, axis=np.eye(3))


def test_position_refuses_columns_that_are_unknown_or_given_twice():
    with pytest.raises(InputError, match="there is no argument 'tilt' here; the names are alpha, gamma"):
        hypcheck.position(*SIZES, 1.0, 0.0, 0.0, tilt=(1.0, 0.0, 0.0))
    with pytest.raises(InputError, match="z is given twice; it must be given once"):
        hypcheck.position(*SIZES, 1.0, 0.0, 0.0, axis=(1.0, 0.0, 0.0), z=3.0)


@pytest.mark.parametrize(("row", "expected"), RINGS)
def test_integers_tell_a_clear_pair_whose_quartic_has_a_double_root_at_a_pole_from_one_that_touches(row, expected):
    assert integers_whole_position(row) == expected
