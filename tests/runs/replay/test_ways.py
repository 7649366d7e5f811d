"""Replays of ways: what happens on them, the answer, its time, and how wrong they are."""

from __future__ import annotations

import json

import pytest

from hypcheck.cli.main import main
from tests.runs import moving

GRAZES = "1,2,1,1,2,-3,0,2,3,0"


def replayed(capsys, *words):
    code = main(["replay", *words])
    return code, capsys.readouterr()


def test_replay_in_json_names_the_mistake_and_its_size(capsys):
    code, said = replayed(capsys, "1,2,1,1,2.5,-3,0,2.5,3,0", "builtin:passage-capsule", "--json")
    assert code == 0
    code, said = replayed(capsys, "1,2,1,0.5,2.25,0,-1,2.25,0,1", "builtin:passage-sampled-4", "--json")
    told = json.loads(said.out)
    assert (told["status"], told["truth"]["hit"], told["answer"]) == ("right", False, 0)
    code, said = replayed(capsys, GRAZES, "builtin:passage-sampled-4", "--json")
    told = json.loads(said.out)
    assert code == 0
    assert (told["status"], told["mistake"], told["truth"]["grazes"]) == ("tolerated", "false-clear", True)
    assert told["used"] == {"name": "passage-sampled-4", "question": "passage", "precision": "float64"}
    assert told["truth"]["first"][0] <= 0.5 <= told["truth"]["first"][1]


def test_replay_says_of_a_sweep_without_contact_that_it_is_clear_and_nothing_of_a_first_time(capsys):
    code, said = replayed(capsys, "1,2,1,0.5,2.25,0,-1,2.25,0,1", "builtin:passage-sampled-4")
    assert code == 0
    assert "truth       clear on the sweep\nends        exterior at the start, exterior at the end\n\n" in said.out


@pytest.mark.slow
def test_replay_calls_an_answer_to_an_invalid_sweep_wrong_unless_it_is_refused(capsys, built_in):
    off = ("--isolate", "off")  # this implementation answers by hypcheck
    code, said = replayed(capsys, "way-invalid-0040", "python:tests.runs.moving:exact", *off)
    assert code == 0
    assert "truth       invalid row (" in said.out
    assert "answer      127, refused" in said.out
    lost = (built_in(moving.clear_from_infinity, **moving.hypcheck), "--json")
    code, said = replayed(capsys, "tilted-way-invalid-0004", *lost)
    assert code == 0
    code, said = replayed(capsys, "way-invalid-0044", *lost)
    told = json.loads(said.out)
    assert (code, told["truth"], told["status"], told["answer"]) == (1, None, "wrong", 0)
    assert told["reason"] == "an invalid row must be refused with 127"
