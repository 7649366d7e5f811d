"""Rows given as a table of columns by name: dicts, structured arrays, and whatever else has names and columns."""

from __future__ import annotations

import numpy as np
import pytest

import hypcheck

NAMES = ("alpha", "gamma", "b", "d", "x", "y", "z")
AXIS = ("axis_x", "axis_y", "axis_z")
ROWS = np.random.default_rng(2).uniform(0.5, 3.0, (50, 10))


class Frame:
    """As a data frame: names by keys(), a column by [name]."""

    def __init__(self, columns):
        self._columns = columns

    def keys(self):  # noqa: D102
        return iter(self._columns)

    def __getitem__(self, name):
        return self._columns[name]


def structured(rows, names):
    table = np.empty(len(rows), dtype=[(name, float) for name in names])
    for name, column in zip(names, rows.T, strict=True):
        table[name] = column
    return table


@pytest.mark.parametrize("names", [NAMES, NAMES + AXIS])
@pytest.mark.parametrize("ask", [hypcheck.classify, lambda rows: hypcheck.clearance(rows).distance_upper])
def test_dicts_frames_and_structured_arrays_are_answered_as_the_rows_that_they_hold(ask, names):
    rows = ROWS[:, : len(names)]
    columns = dict(zip(names, rows.T, strict=True))
    backwards = dict(reversed(columns.items()))
    lists = {name: column.tolist() for name, column in columns.items()}
    expected = ask(rows).tolist()
    for table in (columns, backwards, lists, Frame(columns), structured(rows, names)):
        assert ask(table).tolist() == expected


def test_single_numbers_in_a_table_hold_for_all_rows_and_a_table_of_numbers_only_is_one_pair():
    table = {"alpha": 2, "gamma": 17.8, "b": 0.25, "d": 0.15, "x": [0.0, 1.9, 9.0], "y": 0, "z": np.float32(0)}
    assert hypcheck.classify(table).tolist() == [-1, 0, 1]
    assert hypcheck.classify(table | {"x": 9.0}) == 1
    assert hypcheck.classify(table | {"x": [9.0]}).tolist() == [1]
    assert hypcheck.classify(table | {"x": np.empty(0)}).tolist() == []
    out = np.zeros(3, np.int8)
    assert hypcheck.classify(table, out=out) is out
    assert out.tolist() == [-1, 0, 1]


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"radius": 1}, "there is no column 'radius'; the columns are alpha, gamma, b, d, x, y, z, axis_x"),
        ({"z_top": 3}, "there is no column 'z_top'"),
        ({7: 3}, "there is no column 7"),
        ({"axis_x": 1, "axis_y": 0}, "the column axis_z is missing; a row needs alpha, gamma, b, d, x, y, z, axis_x"),
        ({"x": [1, 2], "y": [1, 2, 3]}, "shapes that do not fit together"),
        ({"x": [[1.0]]}, "it must be|shapes that do not fit"),
        ({"x": "here"}, "x is"),
        ({"alpha": [1.0, -1.0]}, "row 1: alpha is -1.0; a semi-axis must be greater than 0"),
    ],
)
def test_a_wrong_table_is_refused_by_a_sentence_that_states_what_is_needed(change, sentence):
    with pytest.raises(hypcheck.InputError, match=sentence):
        hypcheck.classify(dict.fromkeys(NAMES, 1.0) | change)


def test_missing_columns_are_all_named():
    with pytest.raises(hypcheck.InputError, match="the columns b, d are missing; a row needs alpha, gamma, b, d"):
        hypcheck.classify({"alpha": 1, "gamma": 1, "x": 1, "y": 1, "z": 1})


def test_invalid_rows_of_a_table_are_flagged_if_requested():
    table = dict.fromkeys(NAMES, 1.0) | {"z": [0.0, np.nan]}
    assert hypcheck.classify(table, on_invalid="flag").tolist()[1] == 127
