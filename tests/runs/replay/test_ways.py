"""Replays of ways: what happens on them, the answer, its time, and how wrong they are."""

from __future__ import annotations

import json

import pytest

from hypcheck.cli.main import main

GRAZES = "1,2,1,1,2,-3,0,2,3,0"
THROUGH = "1,2,1,1,4,0,0,0,0,0"


def replayed(capsys, *words):
    code = main(["replay", *words])
    return code, capsys.readouterr()


def test_replay_shows_the_first_contact_and_a_late_time_in_radii(capsys):
    code, said = replayed(capsys, THROUGH, "builtin:passage-sampled-4")
    assert code == 1
    lines = dict(line.split(maxsplit=1) for line in said.out.splitlines() if line)
    assert lines["length"] == "4 spheroid radii"
    assert lines["truth"] == "in contact on the way"
    assert lines["ends"] == "exterior at the start, contact at the end"
    assert lines["answer"] == "1, in contact on the way, first at 0.6666666666666666"
    assert lines["judged"] == "wrong; late by 0.6667 spheroid radii of the way"


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


def test_generated_way_is_replayed_by_its_id(capsys):
    code, said = replayed(capsys, "way-tunnelling/1/1/3", "builtin:passage-exact")
    assert code == 0
    assert "judged      right" in said.out


@pytest.mark.slow
def test_replay_calls_an_answer_to_an_invalid_way_wrong_unless_it_is_refused(capsys):
    off = ("--isolate", "off")  # these implementations answer by hypcheck
    code, said = replayed(capsys, "way-invalid-0040", "python:tests.runs.moving:exact", *off)
    assert code == 0
    assert "truth       invalid row (" in said.out
    assert "answer      127, refused" in said.out
    lost = ("python:tests.runs.moving:clear_from_infinity", "--json", *off)
    code, said = replayed(capsys, "tilted-way-invalid-0004", *lost)
    assert code == 0
    code, said = replayed(capsys, "way-invalid-0044", *lost)
    told = json.loads(said.out)
    assert (code, told["truth"], told["status"], told["answer"]) == (1, None, "wrong", 0)
    assert told["reason"] == "an invalid row must be refused with 127"


@pytest.mark.parametrize(
    ("case", "spec", "sentence"),
    [
        ("way-invalid-0003", "builtin:passage-exact", "is an invalid row (alpha), and passage-exact does not declare"),
        ("way-invalid-0003", "builtin:fast", "way-invalid-0003 is a way between two positions, and fast answers"),
        ("2,5,1,1,3,0,0", "builtin:passage-exact", "the given row is a position, and passage-exact"),
        ("way-tunnelling/1/1/3", "builtin:fast", "is a way between two positions, and fast answers 'position'"),
        ("ring/1/42/7", "builtin:passage-exact", "ring/1/42/7 is a position, and passage-exact answers 'passage'"),
        ("1,2,1,1,4,0,0,0,0,inf", "builtin:passage-exact", "is 'inf'; it must be finite"),
        ("1,2,1,1,4,0,0,0,0,0,0,0,1", "builtin:passage-exact", "has an axis, but passage-exact takes only upright"),
    ],
)
def test_replay_refuses_a_case_that_does_not_match_the_question_about_ways_in_one_sentence(
    case, spec, sentence, capsys
):
    code, said = replayed(capsys, case, spec)
    assert code == 2
    assert sentence in said.err


def test_replay_refuses_a_formula_for_a_way(capsys):
    code, said = replayed(capsys, THROUGH, "builtin:passage-exact", "--formula", "table-2")
    assert code == 2
    assert "--formula is 'table-2', but the given row is about a way, which no formula takes" in said.err
