"""hypcheck.classify and hypcheck.classify_scene: exact answers, and no output unless all rows are valid."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

import hypcheck
from hypcheck.errors import InputError
from hypcheck.kernel.classify import classify

ROWS = [[1, 2, 1, 1, 2.5, 0, 0], [1, 2, 1, 1, 2, 0, 0], [4, 4, 1, 1, 0, 0, 0]]


def test_classify_takes_lists_and_other_types_of_numbers():
    assert hypcheck.classify(ROWS).tolist() == [1, 0, -1]
    assert hypcheck.classify(np.asfortranarray(np.array(ROWS, dtype=np.float32))[::-1]).tolist() == [-1, 0, 1]
    assert hypcheck.classify_scene((1, 2, 1, 1), [2.5, 2, -2.5], 0, 0.0).tolist() == [1, 0, 1]
    assert hypcheck.classify_scene(np.float32([1, 2, 1, 1]), 2.5, 0, 0).tolist() == [1]


def test_classify_fills_the_given_out_array_and_returns_it():
    out = np.full(3, 99, dtype=np.int8)
    assert hypcheck.classify(ROWS, out=out) is out
    assert out.tolist() == [1, 0, -1]
    strided = np.full(6, 99, dtype=np.int8)
    hypcheck.classify_scene((1, 2, 1, 1), [2.5, 2, 0], 0, 0, out=strided[::2])
    assert strided.tolist() == [1, 99, 0, 99, 0, 99]


def test_classify_accepts_an_out_array_that_overlaps_the_rows():
    rows = np.array(ROWS)
    assert hypcheck.classify(rows, out=rows.view(np.int8)[0, :3]).tolist() == [1, 0, -1]
    x, y, z = np.ascontiguousarray(np.tile([[9, 0, 0], [2, 0, 0], [0, 0, 9.0]], (500, 1)).T)
    for column in (x, y, z):
        kept, out = column.copy(), column.view(np.int8)[:1500]
        for threads in (None, 2):
            assert hypcheck.classify_scene((3, 9, 1, 2), x, y, z, out, threads=threads).tolist() == [1, 0, -1] * 500
            column[:] = kept


BAD = {
    "gamma is nan": (1, np.nan),
    "z is inf": (6, np.inf),
    "alpha is 0.0": (0, 0.0),
    "d is -1.0": (3, -1.0),
}


@pytest.mark.parametrize(("said", "change"), BAD.items())
def test_classify_names_the_first_invalid_row_and_leaves_out_unchanged(said, change):
    rows, out = np.array(ROWS), np.full(3, 99, dtype=np.int8)
    rows[1:, change[0]] = change[1]
    with pytest.raises(InputError, match=f"^row 1: {said};"):
        hypcheck.classify(rows, out=out)
    assert out.tolist() == [99] * 3
    assert hypcheck.classify(rows, out=out, on_invalid="flag").tolist() == [1, 127, 127]


@pytest.mark.parametrize("value", [np.nan, -np.inf])
def test_classify_scene_names_the_first_invalid_centre_and_leaves_out_unchanged(value):
    out = np.full(3, 99, dtype=np.int8)
    with pytest.raises(InputError, match=f"^row 1: y is {value}; it must be finite"):
        hypcheck.classify_scene((1, 2, 1, 1), [1, 2, value], [1, value, 0], 0, out=out)
    assert out.tolist() == [99] * 3
    flagged = hypcheck.classify_scene((1, 2, 1, 1), [2.5, 2, value], [0, value, 0], 0, out=out, on_invalid="flag")
    assert flagged is out
    assert out.tolist() == [1, 127, 127]
    with pytest.raises(InputError, match="d is -1"):
        hypcheck.classify_scene((1, 2, 1, -1), 1, 2, 3, on_invalid="flag")


@pytest.mark.parametrize(
    ("out", "found"),
    [
        (np.empty(2, np.int8), r"an array of int8 and of shape \(2,\)"),
        (np.empty(3, np.int16), r"an array of int16 and of shape \(3,\)"),
        (np.empty((3, 1), np.int8), r"an array of int8 and of shape \(3, 1\)"),
        ([0, 0, 0], "of type list"),
        (np.broadcast_to(np.int8(0), 3), "read-only"),
        (np.lib.stride_tricks.as_strided(np.zeros(1, np.int8), (3,), (0,)), "an array whose elements share one byte"),
    ],
)
def test_classify_refuses_an_out_array_of_another_shape_or_type(out, found):
    for call in (
        lambda: hypcheck.classify(ROWS, out=out),
        lambda: hypcheck.classify(ROWS, out=out, on_invalid="flag"),
        lambda: hypcheck.classify_scene((1, 2, 1, 1), [1, 2, 3], 0, 0, out=out),
    ):
        with pytest.raises(
            InputError, match=rf"out is {found}; it must be a writable int8 array of shape \(3,\), a byte"
        ):
            call()


@pytest.mark.parametrize(
    ("sizes", "center", "sentence"),
    [
        ((1, 2, 1), (1, 2, 3), "the sizes are of shape"),
        ((1, 2, 1, -1), (1, 2, 3), "d is -1.0; a semi-axis must be greater than 0"),
        ((1, 2, 1, np.nan), (1, 2, 3), "d is nan; it must be finite"),
        ((1, 2, 1, "1"), (1, 2, 3), "the sizes are .*; they must be four numbers: alpha, gamma, b, d"),
        ((1, [2, 3], 1, 1), (1, 2, 3), r"the sizes are \(1, \[2, 3\], 1, 1\); they must be four numbers"),
        (
            (1, 2, 1, 1),
            (1, [[1], [1, 2]], 3),
            r"y is \[\[1\], \[1, 2\]\]; it must be a number or an array \(n,\) of numbers",
        ),
        ((1, 2, 1, 1), ([1, 2], [1, 2, 3], 3), r"x \(2,\), y \(3,\), z \(1,\) have shapes that do not fit together"),
        ((1, 2, 1, 1), ([[1, 2]], 1, 3), r"x \(1, 2\), y \(1,\), z \(1,\) have shapes that do not fit together"),
        ((1, 2, 1, 1), (1, 2j, 3), "y is 2j; it must be a number"),
        ((1, 2, 1, 1), (1, np.array([2j]), 3), "y is an array of complex128; it must be a number"),
        ((1, 2, 1, 1), (1, "2", 3), "y is '2'; it must be a number"),
        ((1, 2, 1, 1), (1, 2, 10**400), "z is 1000"),
        ((1, 2, 1, 1), (True, 2, 3), "x is True; it must be a number"),
    ],
)
def test_classify_scene_refuses_invalid_sizes_and_centres(sizes, center, sentence):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(InputError, match=sentence):
            hypcheck.classify_scene(sizes, *center)


def test_classify_refuses_masked_values_and_takes_an_empty_mask():
    masked = np.ma.masked_array(ROWS, mask=False)
    assert hypcheck.classify(masked).tolist() == [1, 0, -1]
    masked[1, 2] = np.ma.masked
    with pytest.raises(InputError, match="the rows are masked in 1 place; fill it, with nan or a number"):
        hypcheck.classify(masked)
    with pytest.raises(InputError, match="y is masked in 1 place;"):
        hypcheck.classify_scene((1, 2, 1, 1), 1, masked[1], 3)


@pytest.mark.parametrize("shape", [(0,), (3, 6), (7, 3), (1, 2, 7)])
def test_classify_refuses_rows_of_another_shape(shape):
    with pytest.raises(InputError, match=rf"the rows have shape {re.escape(str(shape))}; it must be \(n, 7\)"):
        hypcheck.classify(np.ones(shape))


def test_classify_of_no_rows_is_an_empty_array():
    assert hypcheck.classify(np.empty((0, 7))).tolist() == []
    assert hypcheck.classify_scene((1, 2, 1, 1), [], [], []).tolist() == []
    assert hypcheck.classify_scene((1, 2, 1, 1), [], 0, 0, on_invalid="flag").tolist() == []


@pytest.mark.parametrize("unit", [5e-324, 1e-300, 1e-160, 1e300])
def test_classify_is_exact_at_the_ends_of_the_float64_range(unit):
    """Spheres beside a hyperboloid of waist α: clear at 3 α, tangent at 2 α."""
    rows = np.array([[1, 1, 1, 1, 3, 0, 0], [1, 1, 1, 1, 2, 0, 0]]) * unit
    assert hypcheck.classify(rows).tolist() == [1, 0]
    many = np.resize(rows[:, 4], 20_000)
    found = hypcheck.classify_scene(tuple(rows[0, :4].tolist()), many, 0, 0)
    assert found.tolist() == [1, 0] * 10_000


def test_classify_refuses_an_unknown_on_invalid():
    with pytest.raises(InputError, match="on_invalid is None; it must be 'raise' or 'flag'"):
        hypcheck.classify(ROWS, on_invalid=None)
    with pytest.raises(InputError, match="on_invalid is array"):
        hypcheck.classify(ROWS, on_invalid=np.ones(2))
    with pytest.raises(InputError, match="on_invalid is 'ignore'; it must be 'raise' or 'flag'"):
        hypcheck.classify(ROWS, on_invalid="ignore")
    with pytest.raises(InputError, match="on_invalid is 'ignore'; it must be 'raise' or 'flag'"):
        hypcheck.classify_scene((1, 2, 1, 1), 1, 2, 3, on_invalid="ignore")


def test_invalid_rows_are_flagged_if_requested_and_else_refused():
    good, bad = [2.0, 3.0, 0.5, 0.5, 9.0, 0.0, 0.0, 0.0, 1.0, 1.0], [2.0, 3.0, -0.5, 0.5, 9.0, 0.0, 0.0, 0.0, 1.0, 1.0]
    rows = np.array([good, bad])
    for given in (rows, rows[:, :7], rows.tolist()):
        for asked in (hypcheck.classify, classify):
            assert asked(given, on_invalid="flag").tolist() == [1, 127]
            with pytest.raises(InputError, match=r"row 1: b is -0\.5"):
                asked(given)
