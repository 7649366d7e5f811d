"""`hypcheck replay` of tilted spheroids: the row with its axis, the proof, and the two ends of each error."""

from __future__ import annotations

import json

import pytest

from hypcheck.cli.main import main
from tests.runs import leaning

BESIDE = "2,5,1,0.5,2.5,0,0,1,0,1"
SPEC = "python:tests.runs.leaning:"


def replayed(capsys, *words):
    code = main(["replay", *words, "--isolate", "off"])  # these implementations answer by hypcheck
    return code, capsys.readouterr()


@pytest.fixture
def spec_of(built_in):
    """The SPEC of a function that takes tilt."""
    return lambda function: built_in(function, tilt=True, refuses=True)


@pytest.mark.slow
def test_tilted_row_is_replayed_with_its_axis_a_proof_and_two_bounds_of_each_flip_distance(capsys):
    code, said = replayed(capsys, BESIDE, f"{SPEC}exact")
    assert code == 0
    assert "axis_x      1                       0x1p+0" in said.out
    assert "truth       contact" in said.out
    assert "two points of the spheroid (s ≤ 1) lie on different sides" in said.out
    assert "answer      0, contact" in said.out
    assert "values" not in said.out


@pytest.mark.slow
def test_a_wrong_answer_about_a_tilted_spheroid_is_judged_as_a_run_judges_it(capsys, spec_of):
    code, said = replayed(capsys, "tilted-uniform/1/1/5", spec_of(leaning.upright), "--json")
    told = json.loads(said.out)
    assert code == 1
    assert len(told["row"]) == len(told["row_hex"]) == 10
    assert (told["status"], told["mistake"]) == ("wrong", "false-clear")
    low, high = told["truth"]["flips"]["interior"]
    assert 0 < low == told["backward_error"] <= high
    assert told["truth"]["kind"] is told["values"] is None


@pytest.mark.slow
def test_a_row_of_ten_numbers_with_a_vertical_axis_is_replayed_as_an_upright_one(capsys, spec_of):
    told = [
        json.loads(replayed(capsys, row, spec_of(leaning.exact), "--json")[1].out)["truth"]
        for row in ("2,5,1,0.5,2.5,0,0", "2,5,1,0.5,2.5,0,0,0,0,-3")
    ]
    assert told[0] == told[1]
    assert told[0]["kind"] == "crossing-one-curve"


@pytest.mark.slow
def test_invalid_tilted_row_is_replayed_by_its_id(capsys, spec_of):
    code, said = replayed(capsys, "tilted-invalid-0000", spec_of(leaning.exact))
    assert code == 0
    assert "axis_z" in said.out
    assert "refused" in said.out
    code, said = replayed(capsys, "tilted-invalid-0000", spec_of(leaning.refuses_upright_rows_alone))
    assert code == 1
    assert "an invalid row must be refused with 127" in said.out
