"""Ordinary calls, which C answers alone: the same answers as step by step, in place, and nothing for invalid rows."""

from __future__ import annotations

import inspect
import pickle

import numpy as np
import pytest

import hypcheck
from hypcheck.errors import InputError
from hypcheck.geometry.rows import tilted_rows
from tests.support.inside import LEVELS, choice, classify, compiled_kernel
from tests.support.inside import kernel_classify as step_by_step

core = pytest.importorskip("hypcheck.kernel._compiled")
if choice().kernel != "compiled":
    pytest.skip("the compiled kernel is not in use", allow_module_level=True)

LEFT = "left to Python"

SIZES = (2.0, 17.8, 0.25, 0.15)
COUNTS = (1, 10, 63, 64, 65, 255, 256, 300, 1023, 1024, 1025, 5000)


@pytest.fixture
def alone():
    """The functions in C, which say it where they leave a call to Python."""
    assert hypcheck.classify is core.classify  # from now on C knows numpy's arrays
    core.set_slow_calls(lambda *_call, **_options: LEFT, lambda *_call, **_options: LEFT, hypcheck.Prepared)
    yield core
    core.set_slow_calls(classify, step_by_step.classify_scene, hypcheck.Prepared)


@pytest.fixture(scope="module")
def columns():
    """Centres about the tower, the first ones in contact with it."""
    random = np.random.default_rng(3)
    x, y, z = random.uniform(-4, 4, 5000), random.uniform(-4, 4, 5000), random.uniform(-18, 18, 5000)
    turn = random.uniform(0, 6.3, 100)
    x[::50], y[::50], z[::50] = 2.25 * np.cos(turn), 2.25 * np.sin(turn), 0.0
    return x, y, z


@pytest.mark.parametrize("count", COUNTS)
def test_an_ordinary_call_of_the_c_entry_answers_as_the_python_code(columns, count, alone):
    x, y, z = (column[:count] for column in columns)
    expected = step_by_step.classify_scene(SIZES, x, y, z)
    rows = tilted_rows(SIZES, (x, y, z), (0.3, 0.1, 0.9))
    for found in (
        alone.classify_scene(SIZES, x, y, z, None, threads=None),
        alone.classify_scene(list(SIZES), x, y, z, np.full(count, 99, np.int8), threads=1),
        alone.classify(np.ascontiguousarray(rows[:, :7]), out=None, threads=None),
        alone.classify(np.ascontiguousarray(rows[:, :7]), out=np.full(count, 99, np.int8), threads=1),
    ):
        assert found.dtype == np.int8
        assert found.tolist() == expected.tolist()
    tilted = classify(rows).tolist()
    assert alone.classify(rows, out=np.full(count, 99, np.int8), threads=None).tolist() == tilted
    assert step_by_step.classify_scene(SIZES, x, y, z, axis=(0.3, 0.1, 0.9)).tolist() == tilted
    assert alone.classify_scene(SIZES, x, y, z, axis=(0.3, 0.1, 0.9)).tolist() == tilted
    assert alone.classify_scene(SIZES, x, y, z, np.full(count, 99, np.int8), axis=[0.3, 0.1, 0.9]).tolist() == tilted
    assert alone.classify_scene(SIZES, x, y, z, axis=(0.0, 0.0, 0.0)) == LEFT


def test_classify_scene_in_c_takes_a_number_in_place_of_a_column(columns, alone):
    x = columns[0][:1000]
    expected = step_by_step.classify_scene(SIZES, x, 0.5, 3.0)
    assert alone.classify_scene(SIZES, x, 0.5, np.float64(3), None, threads=None).tolist() == expected.tolist()
    assert alone.classify_scene(SIZES, 2.25, 0.0, 0.0, None, threads=None).tolist() == [0]
    many = step_by_step.classify_scene(SIZES, columns[0], np.full(5000, 0.5), np.full(5000, 3.0)).tolist()
    assert alone.classify_scene(SIZES, columns[0], 0.5, 3.0, None, threads=None).tolist() == many


@pytest.mark.parametrize("count", [3, 1025, 5000])
@pytest.mark.parametrize("options", [{}, {"threads": 1}, {"threads": 2}, {"axis": (0.3, 0.1, 0.9)}])
def test_classify_scene_in_c_fills_out_or_leaves_it_unchanged_if_a_row_is_invalid(columns, count, options):
    x, y, z = (column[:count].copy() for column in columns)
    expected = hypcheck.classify_scene(SIZES, x, y, z, threads=2, axis=options.get("axis"))
    out = np.full(count, 99, np.int8)
    assert hypcheck.classify_scene(SIZES, x, y, z, out=out, **options) is out
    assert (out == expected).all()
    for place in (0, count // 2, count - 1):
        out[:], before = 98, z[place]
        z[place] = np.nan
        with pytest.raises(InputError, match=f"row {place}: z is nan"):
            hypcheck.classify_scene(SIZES, x, y, z, out=out, **options)
        with pytest.raises(InputError, match=f"row {place}: z is nan"):
            hypcheck.classify_scene(SIZES, x, y, z, **options)
        z[place] = before
        assert (out == 98).all()


def test_classify_in_c_leaves_out_unchanged_if_a_row_is_invalid():
    rows = np.tile([2.0, 17.8, 0.25, 0.15, 1.0, 2.0, 3.0], (3000, 1))
    rows[2999, 0], out = -1, np.full(3000, 98, np.int8)
    with pytest.raises(InputError, match=r"row 2999: alpha is -1\.0"):
        hypcheck.classify(rows, out=out)
    assert (out == 98).all()


UNUSUAL = {
    "another byte order": lambda x, out: (x.astype(">f8"), out),
    "masked": lambda x, out: (np.ma.masked_array(x, mask=False), out),
    "a subclass": lambda x, out: (x.view(np.recarray), out),
    "half precision": lambda x, out: (x.astype(np.float16), out),
    "texts": lambda x, out: ([str(each) for each in x], out),
    "truth values": lambda x, out: (x > 0, out),
    "a truth value": lambda _x, out: (True, out),
    "a whole number beyond 2^53": lambda _x, out: (2**53 + 1, out),
    "whole numbers beyond 2^53": lambda x, out: (np.where(x == x[3], 2**53 + 1, 1), out),
    "subnormal float32": lambda x, out: (np.where(x == x[3], np.float32(1e-40), np.float32(1)), out),
    "two dimensions": lambda x, out: (x[None], out),
    "too few": lambda x, out: (x[:-1], out),
    "out of strides": lambda x, out: (x, np.repeat(out, 2)[::2]),
    "out of another type": lambda x, out: (x, out.view(np.uint8)),
    "out too long": lambda x, out: (x, np.append(out, np.int8(0))),
    "out a list": lambda x, out: (x, [*out]),
}


@pytest.mark.parametrize("change", UNUSUAL.values(), ids=UNUSUAL)
def test_the_c_entry_leaves_arrays_of_other_types_to_python_and_changes_nothing(columns, change, alone):
    x, y, z = (column[:20].copy() for column in columns)
    x, out = change(x, np.full(20, 97, np.int8))
    before, kept = np.array(x), np.array(out)
    assert alone.classify_scene(SIZES, x, y, z, out, threads=None) == LEFT
    assert (np.array(out) == kept).all()
    assert (np.array(x) == before).all()


COLUMNS = {
    "a list": lambda x: [*x],
    "a tuple of numpy's scalars": lambda x: (*x.astype(np.float32),),
    "a subclass of float": lambda x: [np.float64(each) for each in x],
    "every other number": lambda x: np.repeat(x, 2)[::2],
    "the other way round": lambda x: x[::-1].copy()[::-1],
    "float32": lambda x: x.astype(np.float32),
    "float32 with strides": lambda x: np.repeat(x.astype(np.float32), 3)[::3],
    "unaligned": lambda x: np.frombuffer(b"-" + x.tobytes(), dtype=np.int8)[1:].view(np.float64),
    "one number for all": lambda x: np.broadcast_to(x[:1], x.shape),
    **{kind: lambda x, kind=kind: x.astype(kind) for kind in ("i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8")},
}


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("change", COLUMNS.values(), ids=COLUMNS)
def test_the_c_entry_answers_strided_and_converted_columns_as_contiguous_float64_columns(columns, change, level, alone):
    used = core.level()
    if not core.use_level(level):
        pytest.skip(f"this machine has no {level}")
    try:
        for count in (1, 7, 64, 300, 1024, 1025, 1152, 5000):
            given = [change(abs(column[:count])) for column in columns]
            if isinstance(given[0], (list, tuple)) and count > 1024:
                continue  # the room for lists has an end
            plain = [np.array(column, np.float64) for column in given]
            for axis in (None, (0.3, 0.1, 0.9)):
                expected = step_by_step.classify_scene(SIZES, *plain, axis=axis).tolist()
                assert alone.classify_scene(SIZES, *given, axis=axis).tolist() == expected
                out = np.full(count, 99, np.int8)
                assert alone.classify_scene(SIZES, *given, out, axis=axis).tolist() == expected
            yes = step_by_step.classify_scene(SIZES, *plain, question="exterior").tolist()
            assert alone.classify_scene(SIZES, *given, question="exterior").tolist() == yes
            assert (
                alone.classify_scene(hypcheck.Prepared(SIZES), *given).tolist()
                == step_by_step.classify_scene(SIZES, *plain).tolist()
            )
    finally:
        core.use_level(used)


@pytest.mark.parametrize("count", [1, 5, 64, 100, 5000])
@pytest.mark.parametrize("level", LEVELS)
def test_the_c_entry_answers_points_that_each_have_an_axis_as_rows_of_ten_numbers(columns, count, level, alone):
    used = core.level()
    if not core.use_level(level):
        pytest.skip(f"this machine has no {level}")
    try:
        points = np.column_stack([column[:count] for column in columns])
        random = np.random.default_rng(5)
        axes = np.where(random.random((count, 1)) < 0.5, [0.0, 0.0, -2.0], random.normal(size=(count, 3)))
        rows = tilted_rows(SIZES, (*points.T,), (*axes.T,))
        upright, tilted = classify(rows[:, :7].copy()).tolist(), classify(rows).tolist()
        for given in (points, np.asfortranarray(points), points.astype(object).tolist() if count <= 100 else points):
            assert alone.classify_scene(SIZES, given).tolist() == upright
            assert alone.classify(SIZES, given).tolist() == upright
            assert alone.classify(*SIZES, given).tolist() == upright
            assert alone.classify(*SIZES, given, axis=axes).tolist() == tilted
            assert alone.classify_scene(SIZES, given, axis=axes.astype(np.float32).astype(float)).shape == (count,)
        assert alone.classify(*SIZES, *points.T).tolist() == upright
        for form in (np.asfortranarray(rows), np.repeat(rows, 2, axis=0)[::2], np.repeat(rows, 2, axis=1)[:, ::2]):
            assert alone.classify(form).tolist() == tilted
            assert alone.classify(form[:, :7]).tolist() == upright
        flagged = rows.copy()
        flagged[0, 7:] = 0
        marked = alone.classify(*SIZES, flagged[:, 4:7], axis=flagged[:, 7:], on_invalid="flag").tolist()
        assert marked == [127, *tilted[1:]]
    finally:
        core.use_level(used)


def test_sizes_may_be_columns_in_c(columns, alone):
    x, y, z = (column[:200] for column in columns)
    alpha, d = np.linspace(1, 3, 200), np.linspace(0.1, 2, 200)
    rows = np.column_stack([alpha, np.full(200, 17.8), np.full(200, 0.25), d, x, y, z])
    expected = classify(rows).tolist()
    assert alone.classify(alpha, 17.8, 0.25, d, x, y, z).tolist() == expected
    axis = (0.3, 0.1, 0.9)
    tilted = classify(np.hstack([rows, np.tile(axis, (200, 1))])).tolist()
    assert alone.classify(alpha, 17.8, 0.25, d, x, y, z, axis=axis).tolist() == tilted


def test_the_c_entry_answers_a_single_row_with_an_int_and_not_an_array(alone):
    row = [1, 2, 1, 1, 2.5, 0, 0]
    sizes, center = row[:4], row[4:]
    for call in ((row,), (np.array(row),), (*row,), (sizes, center), (*sizes, tuple(center)), (sizes, *center)):
        answer = alone.classify(*call)
        assert answer == 1
        assert type(answer) is int
    assert alone.classify([row]).tolist() == [1]
    assert alone.classify(row, out=np.zeros(1, np.int8)) == LEFT


@pytest.mark.parametrize(
    "sizes", [SIZES[:3], (True, 17.8, 0.25, 0.15), (2.0, 17.8, 0.0, 0.15), None, b"", (2**60, 1, 1, 1)]
)
def test_the_c_entry_does_not_answer_sizes_of_unusual_types_and_leaves_them_to_python(sizes, alone):
    assert alone.classify_scene(sizes, 1.0, 2.0, 3.0, None, threads=None) == LEFT


@pytest.mark.parametrize("sizes", [(2, 17.8, 0.25, 0.15), np.array(SIZES), [np.float32(2), 17.8, 0.25, 0.15]])
def test_the_c_entry_takes_sizes_of_every_type_of_number(sizes, alone):
    assert alone.classify_scene(sizes, [1.0, 2.0], 0, 3, None, threads=None).tolist() == [-1, 0]


def test_classify_scene_refuses_a_read_only_out():
    out = np.zeros(1, np.int8)
    out.flags.writeable = False
    with pytest.raises(InputError, match="out is read-only"):
        hypcheck.classify_scene(SIZES, 1.0, 2.0, 3.0, out=out)


@pytest.mark.parametrize("level", LEVELS)
def test_the_c_loop_that_collects_answers_as_bits_gives_the_answers_of_the_other_loop(level, columns):
    used = core.level()
    if not core.use_level(level):
        pytest.skip(f"this machine has no {level}")
    try:
        for axis in (None, (0.3, 0.1, 0.9)):
            for count in (1, 64, 700, 4096, 5000):
                these = tuple(column[:count] for column in columns)
                out, expected = np.full(count, 99, np.int8), np.full(count, 99, np.int8)
                assert compiled_kernel.fill_valid_scene(SIZES, these, out, 3, axis)
                compiled_kernel.fill_scene(SIZES, these, expected, "position", 1, axis)
                assert (out == expected).all()
    finally:
        core.use_level(used)


@pytest.mark.parametrize(
    "options",
    [
        {"question": "inside"},
        {"on_invalid": "no"},
        {"threads": 2},
        {"threads": True},
        {"threads": 10**30},
        {"axis": [0, 1]},
        {"margin": 1.0},
    ],
)
def test_the_c_entry_leaves_calls_with_other_options_to_python(options, alone):
    assert alone.classify_scene(SIZES, 1.0, 2.0, 3.0, **options) == LEFT
    assert alone.classify(np.ones((1, 7)), **options) == LEFT


def test_the_public_functions_in_c_have_the_signatures_and_docstrings_of_the_python_ones():
    for name in ("classify", "classify_scene"):
        public, written = getattr(hypcheck, name), getattr(step_by_step, name)
        said, told = (inspect.signature(each).parameters.values() for each in (public, written))
        assert [(each.name, each.kind, each.default) for each in said] == [
            (each.name, each.kind, each.default) for each in told
        ]
        assert inspect.getdoc(public) == inspect.getdoc(written)
        assert pickle.loads(pickle.dumps(public)) is public  # noqa: S301 - as a pool of processes does


@pytest.mark.parametrize("axis", [None, (0.3, 0.1, 0.9), (0.0, 0.0, -2.0)])
@pytest.mark.parametrize("known", [False, True], ids=["no-centre-known", "centres-known"])
def test_classify_scene_with_prepared_sizes_answers_as_with_the_sizes(axis, known, columns, alone):
    prepared = hypcheck.Prepared(SIZES, axis, columns if known else ((), (), ()))
    for count in COUNTS:
        x, y, z = (column[:count] for column in columns)
        expected = step_by_step.classify_scene(SIZES, x, y, z, axis=axis).tolist()
        assert alone.classify_scene(prepared, x, y, z).tolist() == expected
        assert alone.classify_scene(prepared, x, y, z, np.full(count, 99, np.int8)).tolist() == expected
        assert step_by_step.classify_scene(prepared, x, y, z).tolist() == expected


def test_prepared_data_differ_if_sample_centres_are_given(columns):
    assert hypcheck.Prepared(SIZES, like=columns).kept != hypcheck.Prepared(SIZES).kept


def test_pickled_prepared_sizes_omit_their_data_which_are_computed_again_on_loading():
    """What is kept means something to the build that made it alone: another, given it, would answer wrongly."""
    prepared = hypcheck.Prepared(SIZES, (0.3, 0.1, 0.9))
    sent = pickle.dumps(prepared)
    assert prepared.kept not in sent
    arrived = pickle.loads(sent)  # noqa: S301 - as a pool of processes does
    assert (arrived, arrived.kept) == (prepared, prepared.kept)


def test_prepared_sizes_compare_by_value_and_refuse_invalid_sizes_and_axes():
    prepared = hypcheck.Prepared([2, 17.8, 0.25, 0.15], [[0.3, 0.1, 0.9]])
    assert prepared == hypcheck.Prepared(SIZES, (0.3, 0.1, 0.9), ([1.0], [2.0], [3.0]))
    assert repr(prepared) == "Prepared(sizes=(2.0, 17.8, 0.25, 0.15), axis=(0.3, 0.1, 0.9))"
    with pytest.raises(InputError, match="d is -1"):
        hypcheck.Prepared((1, 2, 1, -1))
    with pytest.raises(InputError, match="axis_x, axis_y, axis_z are 0, 0, 0"):
        hypcheck.Prepared(SIZES, (0, 0, 0))
    with pytest.raises(InputError, match=r"axis is of shape \(2, 3\)"):
        hypcheck.Prepared(SIZES, [[0, 0, 1], [1, 0, 0]])
    with pytest.raises(InputError, match="axis is given, and the scene was prepared with its own"):
        hypcheck.classify_scene(prepared, 1.0, 2.0, 3.0, axis=(0, 0, 1))
    with pytest.raises(InputError, match="row 0: y is nan"):
        hypcheck.classify_scene(prepared, 1.0, np.nan, 3.0)
