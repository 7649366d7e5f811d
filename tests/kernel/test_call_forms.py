"""The ways to write a call: all forms of the same pairs have the same answers, whichever kernel is in use."""

from __future__ import annotations

import os
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest

import hypcheck
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair
from tests.support.inside import classify
from tests.support.inside import position as exactly

SIZES = (2.0, 17.8, 0.25, 0.15)
POINTS = np.array([[0.0, 0.0, 5.0], [1.9, 0.0, 5.0], [3.0, 0.0, 5.0], [2.3, 0.1, -1.0]])
AXES = np.array([[0.0, 0.0, 1.0], [0.3, 0.1, 0.9], [1.0, 0.0, 0.0], [0.0, 0.0, -3.0]])


def by_truth(rows):
    return [int(exactly(Pair.from_row(row).lengths)) for row in rows]


ROWS = [(*SIZES, *point) for point in POINTS.tolist()]
TURNED = [(*row, *axis) for row, axis in zip(ROWS, AXES.tolist(), strict=True)]

TABLE = {"alpha": 2, "gamma": 17.8, "b": 0.25, "d": 0.15, "x": POINTS[:, 0], "y": POINTS[:, 1], "z": POINTS[:, 2]}

FORMS = {
    "rows": lambda ask, **more: ask(ROWS, **more),
    "a table": lambda ask, **more: ask(TABLE, **more),
    "sizes and points": lambda ask, **more: ask(SIZES, POINTS, **more),
    "sizes and columns": lambda ask, **more: ask(SIZES, *POINTS.T, **more),
    "numbers and points": lambda ask, **more: ask(*SIZES, POINTS.tolist(), **more),
    "numbers and columns": lambda ask, **more: ask(*SIZES, *POINTS.T, **more),
    "an array of sizes": lambda ask, **more: ask(np.tile(SIZES, (4, 1)), POINTS, **more),
    "a table of points": lambda ask, **more: ask(
        {"alpha": 2, "gamma": 17.8, "b": 0.25, "d": 0.15, "center": POINTS}, **more
    ),
    "names": lambda ask, **more: ask(alpha=2, gamma=17.8, b=0.25, d=0.15, center=POINTS, **more),
    "sizes and a name": lambda ask, **more: ask(SIZES, center=POINTS, **more),
    "numbers and a name": lambda ask, **more: ask(*SIZES, center=POINTS, **more),
}


@pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)
@pytest.mark.parametrize("ask", [hypcheck.classify, hypcheck.position])
def test_all_forms_of_the_same_pairs_have_the_same_exact_answers(form, ask):
    assert form(ask).tolist() == by_truth(ROWS)
    assert form(ask, axis=AXES).tolist() == by_truth(TURNED)
    one = [(*row, 0.3, 0.1, 0.9) for row in ROWS]
    assert form(ask, axis=(0.3, 0.1, 0.9)).tolist() == by_truth(one)
    ended = [(*row, 0.0, 0.0, 1.0, -1.0, 4.9, 1.0) for row in ROWS]
    assert form(ask, z_min=-1, z_max=4.9, solid=True).tolist() == by_truth(ended)


@pytest.mark.parametrize("ask", [hypcheck.classify, classify])
def test_prepared_sizes_take_points_and_columns_as_sizes_do(ask):
    """`classify` is what C leaves other calls to."""
    for more in ({}, {"threads": 2}):
        assert ask(hypcheck.Prepared(SIZES), POINTS, **more).tolist() == by_truth(ROWS)
        assert ask(hypcheck.Prepared(SIZES), *POINTS.T, **more).tolist() == by_truth(ROWS)


@pytest.mark.parametrize("sizes", [SIZES, hypcheck.Prepared(SIZES), hypcheck.Prepared(SIZES, (0.3, 0.1, 0.9))])
@pytest.mark.parametrize("more", [{}, {"margin": 0.4}])
def test_classify_of_one_spheroid_and_several_heights_answers_as_rows_with_these_heights(sizes, more):
    axis = getattr(sizes, "axis", None) or (0.0, 0.0, 1.0)
    ended = [(*row, *axis, -1.0, top, 1.0) for row, top in zip(ROWS, (4.0, 5.0, 9.0, 2.0), strict=True)]
    expected = hypcheck.classify(ended, **more).tolist() if more else by_truth(ended)
    ends = {"z_min": -1, "z_max": [4, 5, 9, 2], "solid": True}
    for ask in (hypcheck.classify, hypcheck.classify_scene):
        for points in ((POINTS,), POINTS.T):
            out = np.zeros(4, np.int8)
            assert ask(sizes, *points, **ends, **more, out=out) is out
            assert out.tolist() == expected
    alone = hypcheck.classify(sizes, POINTS[0], z_min=-1, z_max=4, solid=1, **more)
    assert (alone, type(alone)) == (expected[0], int)
    assert hypcheck.classify_scene(sizes, POINTS[0], z_min=-1, z_max=4, solid=1, **more).tolist() == expected[:1]


def test_an_argument_that_prepared_sizes_exclude_is_refused_and_not_ignored():
    prepared = hypcheck.Prepared(SIZES)
    for axis in ({"axis": (1, 0, 0)}, {"axis_x": 1, "axis_y": 0, "axis_z": 0}):
        with pytest.raises(InputError, match=r"axis is given, and the scene was prepared with its own"):
            hypcheck.classify(prepared, POINTS, **axis)
    with pytest.raises(InputError, match="there is no argument 'height' here"):
        hypcheck.classify(prepared, POINTS, height=3)
    with pytest.raises(InputError, match="z_min must be less than z_max"):
        hypcheck.classify(prepared, POINTS, z_min=3, z_max=1)


def test_all_forms_have_the_same_answers_without_the_compiled_kernel():
    code = (
        "import hypcheck, tests.kernel.test_call_forms as t\n"
        "for form in t.FORMS.values():\n"
        "    for ask in (hypcheck.classify, hypcheck.position):\n"
        "        assert form(ask).tolist() == t.by_truth(t.ROWS)\n"
        "        assert form(ask, axis=t.AXES).tolist() == t.by_truth(t.TURNED)\n"
        "assert hypcheck.position(2, 17.8, 1, 1, 9, 0, 0) == hypcheck.classify((2, 17.8, 1, 1), [9, 0, 0]) == 1\n"
    )
    environment = {**os.environ, "HYPCHECK_KERNEL": "numpy"}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment, timeout=60)


SWEPT = {
    "sizes and points": lambda: hypcheck.passage(SIZES, POINTS, (0, 0, 5)),
    "numbers and points": lambda: hypcheck.passage(*SIZES, POINTS, (0, 0, 5)),
    "sizes and names": lambda: hypcheck.passage(SIZES, start=POINTS, end=(0, 0, 5)),
    "the end by its name": lambda: hypcheck.passage(SIZES, POINTS, end=(0, 0, 5)),
    "names": lambda: hypcheck.passage(alpha=2, gamma=17.8, b=0.25, d=0.15, start=POINTS, end=(0, 0, 5)),
    "an array of sizes": lambda: hypcheck.passage(np.tile(SIZES, (4, 1)), POINTS, (0, 0, 5)),
    "a table": lambda: hypcheck.passage({**TABLE, "x1": 0, "y1": 0, "z1": 5}),
    "rows": lambda: hypcheck.passage([[*row, 0, 0, 5] for row in ROWS]),
}


@pytest.mark.parametrize("form", SWEPT.values(), ids=SWEPT)
def test_all_forms_of_the_same_sweeps_have_the_same_answers(form):
    """The first point and the way to itself are within the wall, and clear; all others cross the wall."""
    found = form()
    assert found.hit.tolist() == [False, True, True, True]
    assert found.first_lower[1] == 0
    assert found.index.tolist() == [-1, 0, 0, 0]


SWEEPS = {
    "rows": [[*row, 0, 0, 5] for row in ROWS],
    "a table": {**TABLE, "x1": 0, "y1": 0, "z1": 5},
    "the protocol's names": {
        **{name + "0" * (name in "xyz"): TABLE[name] for name in TABLE},
        "x1": 0,
        "y1": 0,
        "z1": 5,
    },
}


@pytest.mark.parametrize("sweeps", SWEEPS.values(), ids=SWEEPS)
def test_passage_of_rows_of_sweeps_uses_an_axis_and_heights_given_by_name(sweeps):
    axis, ends = (1, 0, 0), {"z_min": -1, "z_max": [9, 6, 4, 9]}
    expected = [
        hypcheck.passage(SIZES, point, (0, 0, 5), axis, z_min=-1, z_max=top).hit
        for point, top in zip(POINTS.tolist(), ends["z_max"], strict=True)
    ]
    assert sorted(set(expected)) == [False, True]
    assert hypcheck.passage(sweeps, axis=axis, **ends).hit.tolist() == expected


ONE = {"alpha": 2, "gamma": 17.8, "b": 0.25, "d": 0.15, "x": 3, "y": 0, "z": 5, "x1": 0, "y1": 0, "z1": 5}


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda: hypcheck.passage(SIZES, (3, 0, 5), (0, 0, 5), alpha=100), "alpha"),
        (lambda: hypcheck.passage(SIZES, (3, 0, 5), (0, 0, 5), x1=0), "x1"),
        (lambda: hypcheck.passage(*SIZES, (3, 0, 5), (0, 0, 5), x0=9), "x"),
        (lambda: hypcheck.passage(SIZES, (3, 0, 5), (0, 0, 5), end=(9, 9, 9)), "end"),
        (lambda: hypcheck.passage(SIZES, (3, 0, 5), (0, 0, 5), (1, 0, 0), axis=(0, 0, 1)), "axis"),
        (lambda: hypcheck.passage(SIZES, (3, 0, 5), (0, 0, 5), (1, 0, 0), (0, 0, 1), upward=(0, 1, 1)), "upward"),
        (lambda: hypcheck.passage(SIZES, (3, 0, 5), (0, 0, 5), axis=(1, 0, 0), axis_x=0, axis_y=0, axis_z=1), "axis_x"),
        (lambda: hypcheck.passage({**ONE, "z_max": 5}, z_max=-1), "z_max"),
        (lambda: hypcheck.passage({**ONE, "x0": 9}), "x"),
        (lambda: hypcheck.passage(ONE, gamma=1), "gamma"),
        (lambda: hypcheck.passage([[*ROWS[2], 0, 0, 5, 1, 0, 0]], axis=(1, 0, 0)), "axis_x"),
        (lambda: hypcheck.classify(SIZES, (3, 0, 5), center=(9, 0, 0)), "center"),
        (lambda: hypcheck.classify(SIZES, (3, 0, 5), x=9), "x"),
        (lambda: hypcheck.clearance(ROWS, b=1), "b"),
    ],
)
def test_a_value_that_is_given_twice_is_refused_by_its_name(call, name):
    with pytest.raises(InputError, match=rf"^{name} is given twice; it must be given once"):
        call()


@pytest.mark.parametrize(
    "form",
    [
        lambda: hypcheck.passage([*ROWS[2], 0, 0, 5]),
        lambda: hypcheck.passage(SIZES, start=POINTS[2], end=(0, 0, 5)),
        lambda: hypcheck.passage(SIZES, np.array([3, 0, 5]), np.array([0, 0, 5], np.float32), z_max=np.float32(9)),
        lambda: hypcheck.passage(alpha=2, gamma=17.8, b=0.25, d=0.15, start=(3, 0, 5), end=(0, 0, 5)),
        lambda: hypcheck.passage({**TABLE, "x": 3, "y": 0, "z": 5, "x1": 0, "y1": 0, "z1": 5}),
    ],
)
def test_one_sweep_in_any_form_is_answered_with_numbers_and_not_arrays(form):
    found = form()
    assert (found.hit, found.index) == (True, 0)
    assert type(found.first_lower) is float or np.ndim(found.first_lower) == 0
    assert 0.22 < found.first_lower <= found.first_upper < 0.23


def test_one_sweep_with_several_values_of_z_max_has_one_answer_for_each_value():
    tops = [4, 5, 6]
    for z_max in (tops, np.array(tops)):
        assert hypcheck.passage(SIZES, (3, 0, 5), (1.5, 0, 5), z_max=z_max).hit.tolist() == [False, True, True]


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: hypcheck.passage(SIZES, start=POINTS), "passage takes .*; end is missing"),
        (lambda: hypcheck.passage(SIZES, end=POINTS), "1 argument: passage takes .sizes, start, end."),
        (lambda: hypcheck.passage(SIZES, POINTS, (0, 0, 5), margin=1), "there is no argument 'margin' here"),
        (lambda: hypcheck.clearance(SIZES, POINTS, margin=1), "there is no argument 'margin' here"),
        (lambda: hypcheck.classify(TABLE | {"axis_x": 1}), "the columns axis_y, axis_z are missing"),
        (lambda: hypcheck.classify(TABLE | {"axis_x": [1] * 4, "axis_z": 0}), "the column axis_y is missing"),
        (hypcheck.passage, "there are no arguments: passage takes"),
        (lambda: hypcheck.passage({**TABLE, "x": 3, "y": 0, "z": 5, "x1": 0, "y1": np.nan, "z1": 5}), "^y1 is nan"),
        (lambda: hypcheck.passage({"alpha": 1}), "columns gamma, b, d, x, y, z, x1, y1, z1 are missing"),
    ],
)
def test_an_argument_that_no_call_takes_is_refused_by_its_name(call, sentence):
    with pytest.raises(InputError, match=sentence):
        call()


def test_an_empty_list_of_points_has_no_answers_and_an_empty_list_is_refused_as_an_axis():
    assert hypcheck.classify(SIZES, []).tolist() == []
    assert hypcheck.passage(SIZES, [], (0, 0, 5)).hit.tolist() == []
    with pytest.raises(InputError, match=r"axis is of shape \(0,\); it must be three numbers"):
        hypcheck.classify(SIZES, POINTS, axis=[])


@pytest.mark.parametrize("form", [list, tuple, np.array])
def test_four_sizes_may_be_a_list_a_tuple_or_an_array(form):
    assert hypcheck.classify(form(SIZES), [(3.0, 0.0, 0.0)]).tolist() == [1]


@pytest.mark.parametrize("form", [list, tuple, np.array])
def test_three_sizes_are_refused_and_the_message_states_their_number(form):
    with pytest.raises(InputError, match="the sizes are 3; they must be four"):
        hypcheck.classify(form(SIZES[:3]), POINTS)


def test_a_list_of_one_number_is_refused_as_a_point():
    with pytest.raises(InputError, match=r"is of shape \(1,\); it must be three numbers, x, y, z, or an array"):
        hypcheck.classify(SIZES, [1.0])


def test_invalid_rows_of_a_table_are_answered_127_if_on_invalid_is_flag():
    table = {"alpha": 2, "gamma": 17.8, "b": [0.25, 0.0], "d": 0.15, "x": 3, "y": 0, "z": 5}
    assert hypcheck.classify(table, on_invalid="flag").tolist() == [1, 127]


def test_the_second_of_two_axes_given_to_passage_is_that_of_the_hyperboloid():
    """A ball on the x axis is outside of an upright hyperboloid, and inside of one that lies along that axis."""
    way = (2.0, 17.8, 0.25, 0.25), (5.0, 0.0, 0.0), (4.0, 0.0, 0.0)
    assert [hypcheck.passage(*way, (0, 0, 1), axis).start for axis in ((0, 0, 1), (1, 0, 0))] == [1, -1]
    assert hypcheck.passage(*way, upward=(1, 0, 0)).start == -1


def test_z_max_may_be_a_column_with_a_value_for_each_point():
    tops = np.array([4.0, 6.0, 4.0, 6.0])
    rows = [(*row, 0.0, 0.0, 1.0, -np.inf, top, 0.0) for row, top in zip(ROWS, tops.tolist(), strict=True)]
    assert hypcheck.classify(SIZES, POINTS, z_max=tops).tolist() == by_truth(rows)


@pytest.mark.parametrize(
    ("arguments", "named", "sentence"),
    [
        ((), {}, "there are no arguments: it takes rows, a table of columns by name"),
        ((1, 2, 3), {}, r"3 arguments: it takes rows, .* or \(alpha, gamma, b, d, x, y, z\)"),
        ((SIZES[:3], POINTS), {}, "the sizes are 3; they must be four: alpha, gamma, b, d"),
        (("sizes", POINTS), {}, "the sizes are 'sizes'; they must be four"),
        ((np.ones((4, 3)), POINTS), {}, r"the sizes are of shape \(4, 3\); they must be four: .* or an array \(n, 4\)"),
        (
            (SIZES, POINTS),
            {"centre": POINTS},
            "there is no argument 'centre' here; the names are alpha",
        ),
        ((SIZES, POINTS[:, :2]), {}, r"the centre is of shape \(4, 2\); it must be three numbers, x, y, z"),
        ((SIZES, POINTS), {"axis": [1, 2]}, r"axis is of shape \(2,\); it must be three numbers, axis_x"),
        ((SIZES, POINTS), {"axis": AXES[:3]}, "have shapes that do not fit together"),
        ((SIZES, POINTS), {"center": POINTS}, "center is given twice; it must be given once"),
        ((ROWS,), {"x": 3}, "x is given twice"),
        ((SIZES, POINTS), {"out": [1]}, "out is of type list"),
        (([1, 2, 1, 1, 2.5, 0, 0],), {"out": np.zeros(1, np.int8)}, "the answer to one pair is a number"),
        ((SIZES, [9, 0, np.nan]), {}, "z is nan; it must be finite"),
        (([1, 2, 1, -1, 2.5, 0, 0],), {}, "^d is -1.0; a semi-axis must be greater than 0"),
        ((SIZES, POINTS), {"z_min": 2, "z_max": 1}, "z_min must be less than z_max"),
        ((SIZES, POINTS), {"margin": -1}, "margin is -1; it must be 0 or more"),
        ((SIZES, POINTS), {"margin": "wide"}, "margin is 'wide'; it must be a number"),
    ],
)
def test_a_call_with_wrong_arguments_is_refused_by_a_sentence_that_states_the_right_ones(arguments, named, sentence):
    with pytest.raises(InputError, match=sentence):
        hypcheck.classify(*arguments, **named)


def distance_of_a_sphere(alpha, gamma, centre, radius):
    """From a sphere to the wall, by the least over a dense curve in the plane of both: good to 1e-6."""
    x, y, z = centre
    height = np.linspace(-4 * gamma, 4 * gamma, 400_001)
    wall = alpha * np.sqrt(1 + (height / gamma) ** 2)
    return np.sqrt(np.hypot(wall - np.hypot(x, y), height - z).min() ** 2) - radius


@pytest.mark.parametrize("centre", [(3.0, 0.0, 5.0), (0.5, 0.4, -3.0), (5.0, 1.0, 0.0)])
def test_a_spheroid_nearer_than_the_margin_is_in_contact_and_a_farther_one_keeps_its_position(centre):
    far = distance_of_a_sphere(2.0, 17.8, centre, 0.25)
    sizes = (2.0, 17.8, 0.25, 0.25)
    without = hypcheck.position(*sizes, *centre)
    assert without != 0
    for margin, expected in ((far - 1e-5, without), (far + 1e-5, 0), (far / 2, without), (2 * far, 0)):
        assert hypcheck.position(*sizes, *centre, margin=margin) == expected
        assert hypcheck.classify(sizes, [centre], margin=margin).tolist() == [expected]
        assert hypcheck.classify_scene(sizes, [centre], margin=margin).tolist() == [expected]
        yes = hypcheck.classify(sizes, [centre], margin=margin, question="contact")
        assert yes.tolist() == [int(expected == 0)]


def test_margins_apply_to_tilted_spheroids_and_beside_ends_and_invalid_rows_stay_127():
    rows = np.array([(*row, *axis) for row in ROWS for axis in AXES.tolist()])
    near = hypcheck.clearance(rows)
    for margin in (0.01, 0.3, 0.7, 5.0):
        found = hypcheck.classify(rows, margin=margin)
        assert (found[near.distance_upper < margin] == 0).all()
        sure = near.distance_lower >= margin
        assert (found[sure] == near.position[sure]).all()
    assert hypcheck.position(2, 17.8, 0.25, 0.25, 0, 0, 19.0, z_max=17.8, margin=0.9) == 1
    assert hypcheck.position(2, 17.8, 0.25, 0.25, 0, 0, 19.0, z_max=17.8, solid=True, margin=0.9) == 1
    assert hypcheck.position(2, 17.8, 0.25, 0.25, 0, 0, 19.0, z_max=17.8, solid=True, margin=1.0) == 0
    marked = hypcheck.classify([[1, 2, 1, 1, 9, 0, 0], [1, 2, 1, -1, 9, 0, 0]], margin=1, on_invalid="flag")
    assert marked.tolist() == [1, 127]


def test_a_fraction_that_float64_does_not_hold_is_refused_as_a_number():
    with pytest.raises(InputError):
        hypcheck.classify(SIZES, Fraction(1, 3), 0, 0)


def test_sizes_and_heights_given_as_single_numbers_hold_for_every_row():
    heights = {"z_min": -1.0, "z_max": 2.0, "solid": True}
    for points in (POINTS, [[1.9, 0.0, 2.1], [0.0, 0.0, 2.2]]):
        rows = [(*SIZES, *point, 0.0, 0.0, 1.0, -1.0, 2.0, 1.0) for point in np.asarray(points).tolist()]
        assert hypcheck.classify(SIZES, points, **heights).tolist() == by_truth(rows)


def test_sizes_without_a_centre_and_a_centre_without_sizes_are_refused():
    with pytest.raises(InputError, match="the columns alpha, gamma, b, d are missing"):
        hypcheck.classify(x=1.0, y=2.0, z=3.0)
    with pytest.raises(InputError, match="the columns x, y, z are missing"):
        hypcheck.classify(alpha=1.0, gamma=2.0, b=3.0, d=4.0)
