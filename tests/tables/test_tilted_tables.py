"""Tables of tilted spheroids: ten columns or keys, mixed lines, and what is refused."""

from __future__ import annotations

import json

import numpy as np
import pytest

from hypcheck.answer import answer
from hypcheck.answers import answers
from hypcheck.cli.main import main
from hypcheck.geometry.pair import COLUMNS, TILTED_COLUMNS, Pair

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
    return [answer(Pair.from_row(row)) for row in ROWS]


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
