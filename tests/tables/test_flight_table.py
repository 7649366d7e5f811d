"""Flights as CSV: what is read, and each thing that is refused, with its line."""

from __future__ import annotations

import pytest

from hypcheck.errors import InputError
from hypcheck.tables.csv_table import read_flights


def read(tmp_path, text):
    path = tmp_path / "path.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_flights(str(path))


def test_columns_are_found_by_name_and_rows_of_one_flight_belong_together(tmp_path):
    table = read(
        tmp_path, "flight,z,y,x,heading,note\na,3,2,1,10,-\na,6,5,4,20,-\nb,9,8,7,30,-\n\nc,1,1,1,40,-\nc,2,2,2,50,-\n"
    )
    assert table.names == ["a", "b", "c"]
    assert [path.tolist() for path in table.paths] == [[[1, 2, 3], [4, 5, 6]], [[7, 8, 9]], [[1, 1, 1], [2, 2, 2]]]
    assert table.headings.tolist() == [10, 30, 40]
    assert table.axes is None


def test_the_axis_of_a_row_of_a_flight_table_belongs_to_the_segment_that_begins_there(tmp_path):
    table = read(tmp_path, "x,y,z,axis_x,axis_y,axis_z\n0,0,0,1,0,0\n1,0,0,0,1,0\n2,0,0,0,0,1\n")
    assert table.axes.tolist() == [[1, 0, 0], [0, 1, 0]]
    assert table.headings is None


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is empty"),
        ("x,y,z\n", "has no rows"),
        ("x,y\n1,2\n", "no column z"),
        ("x,x,y,z\n1,1,1,1\n", "duplicate column .x."),
        ("x,y,z\n1,2\n", "line 2: there are 2 cells; there must be 3"),
        ("x,y,z\n1,2,3\n1,2,inf\n", "line 3: z is 'inf'; it must be finite"),
        ("x,y,z\n1,2,north\n", "line 2: z is 'north'"),
        ("x,y,z\n1,2,1e999\n", "line 2: z is 1e999"),
        ("x,y,z,axis_x\n1,2,3,4\n", "no column axis_y, axis_z"),
        ("x,y,z,axis_x,axis_y,axis_z\n1,2,3,0,0,0\n", "line 2: "),
        ('x,y,z\n1,2,"3\n', "line 2: "),
        (b"x,y,z\n1,2,\xff\n", "is not UTF-8"),
    ],
)
def test_a_value_that_is_not_a_flight_is_refused_by_a_sentence(tmp_path, text, says):
    with pytest.raises(InputError, match=says):
        read(tmp_path, text)
