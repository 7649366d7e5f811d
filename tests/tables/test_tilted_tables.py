"""Tables of spheroids whose axis leans: ten columns or keys, mixed lines, and what is refused."""

from __future__ import annotations

import json

import numpy as np
import pytest

from hypcheck.answer import answer
from hypcheck.answers import answers
from hypcheck.cli.main import main
from hypcheck.geometry.pair import COLUMNS, TILTED_COLUMNS, Pair
from hypcheck.truth.tilted.pair import TiltedPair

ROWS = (
    (1.0, 2.0, 1.0, 0.5, 2.2, 0.0, 0.0, 1.0, 0.0, 0.5),
    (1.0, 2.0, 1.0, 0.5, 1.25, 0.0, 0.0, 5e-324, 0.0, 1e300),
    (4.0, 1.0, 2.0, 1.0, 3.0, 0.0, 0.0, -3.0, 0.0, 0.0),  # touches
    (35.0, 35.0, 25.0, 15.0, 16.0, 0.0, -4.0, 1.0, 0.0, 1.0),
    (1.0, 2.0, 1.0, 0.5, 2.0, 0.0, 0.0, 0.0, 0.0, -7.0),  # upright, and touches
    (4.0, 4.0, 1.0, 1.0, 3.0, 0.0, 0.0, 1.0, 2.0, 3.0),  # a sphere that touches
)


@pytest.fixture
def wanted():
    return [answer(TiltedPair.from_row(row)) for row in ROWS]


def test_answers_about_tilted_rows_equal_answers_about_each_tilted_pair(wanted):
    found = answers(np.array(ROWS))
    assert found.positions.tolist() == [each.decision.position for each in wanted] == [1, 0, 0, -1, 0, 0]
    assert (
        found.tangent.tolist() == [each.decision.tangent for each in wanted] == [False, False, True, False, True, True]
    )
    assert found.clearance.tolist() == [each.clearance for each in wanted]


@pytest.mark.slow
def test_csv_columns_of_the_axis_are_found_in_any_order_and_other_columns_are_kept(tmp_path, wanted):
    names = ("note", *reversed(TILTED_COLUMNS))
    lines = [",".join(names), *(",".join(["a b", *map(repr, reversed(row))]) for row in ROWS)]
    (tmp_path / "in.csv").write_text("\n".join(lines))
    assert main(["classify", "--input", str(tmp_path / "in.csv"), "--output", str(tmp_path / "out.csv")]) == 0
    header, *found = (tmp_path / "out.csv").read_text().splitlines()
    assert header == lines[0] + ",position,label,tangent,clearance"
    for line, text, each in zip(found, lines[1:], wanted, strict=True):
        tangent = "true" if each.decision.tangent else "false"
        label = each.decision.position.label
        assert line == f"{text},{int(each.decision.position)},{label},{tangent},{each.clearance!r}"


def test_npy_of_tilted_rows_is_classified_into_npy_csv_and_jsonl(tmp_path, wanted):
    np.save(tmp_path / "in.npy", np.asfortranarray(np.array(ROWS)))
    for name in ("out.npy", "out.csv", "out.jsonl"):
        assert main(["classify", "--input", str(tmp_path / "in.npy"), "--output", str(tmp_path / name)]) == 0
    positions = [int(each.decision.position) for each in wanted]
    assert np.load(tmp_path / "out.npy").tolist() == positions
    assert (tmp_path / "out.csv").read_text().startswith(",".join(TILTED_COLUMNS) + ",position,")
    objects = [json.loads(line) for line in (tmp_path / "out.jsonl").read_text().splitlines()]
    assert [tuple(each[name] for name in TILTED_COLUMNS) for each in objects] == list(ROWS)
    assert [each["position"] for each in objects] == positions


@pytest.mark.parametrize("extra", ["", ' "note": "axis_",'])
def test_json_lines_with_and_without_an_axis_are_classified_in_one_file(extra, tmp_path, wanted):
    objects = [dict(zip(TILTED_COLUMNS, row, strict=True)) for row in ROWS]
    upright = dict(zip(COLUMNS, ROWS[0], strict=False))
    lines = [f"{{{extra}{json.dumps(each)[1:]}" for each in [*objects, upright]]
    (tmp_path / "in.jsonl").write_text("\n".join(lines))
    assert main(["classify", "--input", str(tmp_path / "in.jsonl"), "--output", str(tmp_path / "out.jsonl")]) == 0
    found = [json.loads(line) for line in (tmp_path / "out.jsonl").read_text().splitlines()]
    expected = [*wanted, answer(Pair.from_row(ROWS[0][:7]))]
    assert [each["clearance"] for each in found] == [each.clearance for each in expected]


@pytest.mark.parametrize(
    ("axis", "sentence"),
    [
        ("0,-0,0", "axis_x, axis_y, axis_z are 0, 0, 0; an axis must have a direction"),
        ("nan,0,0", "axis_x is 'nan'; it must be finite"),
        ("0,1e999,0", "axis_y is 1e999, which is too large for float64"),
        ("0,0,", "axis_z is empty; it must be a number"),
    ],
)
def test_tilted_row_whose_axis_has_no_direction_is_refused_or_flagged(axis, sentence, tmp_path, capsys):
    table = tmp_path / "in.csv"
    table.write_text(f"{','.join(TILTED_COLUMNS)}\n1,2,1,1,2.5,0,0,0,0,1\n1,2,1,1,2.5,0,0,{axis}\n")
    command = ["classify", "--input", str(table), "--output", str(tmp_path / "out.csv")]
    assert main(command) == 2
    assert f"row 2 (line 3): {sentence}" in capsys.readouterr().err
    assert not (tmp_path / "out.csv").exists()
    assert main([*command, "--on-invalid", "flag"]) == 0
    lines = (tmp_path / "out.csv").read_text().splitlines()
    assert lines[1].endswith(",1,exterior,false,0.5")
    assert lines[2].endswith(",127,refused,,")


@pytest.mark.parametrize(
    ("names", "sentence"),
    [
        (("axis_x", "axis_z"), "column axis_y is missing; an axis needs axis_x, axis_y, axis_z"),
        (("axis_x", "Axis_Y", "axis_z"), "column axis_y is missing; 'Axis_Y' must be written axis_y"),
        (("axis_x", "axis_y", "axis_z", "axis_x"), "column 'axis_x' stands twice; it must stand once"),
    ],
)
def test_csv_with_only_some_columns_of_the_axis_is_refused(names, sentence, tmp_path, capsys):
    table = tmp_path / "in.csv"
    table.write_text(f"{','.join((*COLUMNS, *names))}\n1,2,1,1,2.5,0,0{',1' * len(names)}\n")
    assert main(["classify", "--input", str(table), "--output", str(tmp_path / "out.csv")]) == 2
    assert sentence in capsys.readouterr().err


def test_json_line_with_only_some_keys_of_the_axis_is_refused(tmp_path, capsys):
    row = dict(zip(COLUMNS, ROWS[0], strict=False))
    for more, missing in (
        ({"axis_z": 1}, "keys axis_x, axis_y are"),
        ({"Axis_x": 1, "axis_y": 0, "axis_z": 1}, "key axis_x is"),
    ):
        (tmp_path / "in.jsonl").write_text(json.dumps(row | more))
        assert main(["classify", "--input", str(tmp_path / "in.jsonl"), "--output", "-"]) == 2
        assert f"{missing} missing" in capsys.readouterr().err
    (tmp_path / "in.jsonl").write_text("\n".join(json.dumps(row | {"AXIS_X": 1}) for _ in range(3)))
    assert main(["classify", "--input", str(tmp_path / "in.jsonl"), "--output", "-"]) == 2
    assert "'AXIS_X' must be written axis_x" in capsys.readouterr().err


def test_npy_of_tilted_rows_that_is_cut_off_is_refused_naming_the_number_of_rows(tmp_path, capsys):
    np.save(tmp_path / "in.npy", np.array(ROWS))
    data = (tmp_path / "in.npy").read_bytes()
    (tmp_path / "in.npy").write_bytes(data[:-81])
    assert main(["classify", "--input", str(tmp_path / "in.npy"), "--output", str(tmp_path / "out.npy")]) == 2
    assert "its header says 6 rows, and the data ends after 4 of them" in capsys.readouterr().err
