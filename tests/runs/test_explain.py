"""`hypcheck explain`: what each cause is, why, and a row that shows it, of which truth and answer are checked."""

from __future__ import annotations

import json

import pytest

import hypcheck
from hypcheck.cli.main import main
from hypcheck.paper.ledger.book import statement
from hypcheck.runs.diagnosis import CAUSES
from hypcheck.runs.explain import BY_ID
from tests.support.fractions_truth import exact_position
from tests.support.remedies import TABLE_2, positions

IDS = tuple(BY_ID)


def printed(capsys, *words):
    assert main(["explain", *words]) == 0
    return capsys.readouterr().out


def as_json(capsys, *words):
    return json.loads(printed(capsys, *words, "--format", "json"))


@pytest.mark.parametrize("name", IDS)
def test_text_and_json_of_a_cause_say_the_same_and_its_row_has_the_proved_truth_and_a_wrong_answer(name, capsys):
    text, shown = printed(capsys, name), as_json(capsys, name)
    witness, about = shown["witness"], shown["about"]
    row = witness["row"]
    assert [float.fromhex(each) for each in witness["hex"]] == row
    if about == "way":
        passage = hypcheck.passage(row[:4], row[4:7], row[7:])
        assert passage.hit == witness["truth"]
        if "time" in witness:
            assert not passage.first_lower <= witness["time"] <= passage.first_upper
            assert 0 <= witness["time"] <= 1
    elif about == "tilted":
        assert hypcheck.position(*row[:7], axis=row[7:]) == witness["truth"]
    else:
        assert exact_position(row) == witness["truth"]
    assert witness["answer"] != witness["truth"] or "time" in witness
    assert text.startswith(f"{name} (")
    for part in ("why", "remedy", "recognise"):
        assert shown[part]
        assert f"{shown[part]}." in text
    assert shown["sentence"][1:] in text
    assert ",".join(repr(value).removesuffix(".0") for value in shown["witness"]["row"]) in text
    assert shown["witness"]["case"] in text


def test_list_of_causes_has_each_id_once_with_its_sentence(capsys):
    lines = printed(capsys).split("\n")
    for cause in CAUSES:
        assert [line for line in lines if line.split()[:1] == [cause.name]] == [
            f"  {cause.name:{max(map(len, IDS))}}  {cause.sentence}"
        ]
    assert [each["id"] for each in as_json(capsys)] == list(IDS)


def test_claim_of_a_cause_is_one_of_the_ledger_that_does_not_hold(capsys):
    claims = {name: as_json(capsys, name)["claim"] for name in IDS if BY_ID[name].claim}
    assert claims["ring"] == "Proposition 3.2"
    assert all(statement(claim).verdict for claim in claims.values())


def test_row_of_the_ring_is_one_where_table_2_says_contact(capsys):
    witness = as_json(capsys, "ring")["witness"]
    assert witness["truth"] == 1
    assert positions(TABLE_2, (tuple(witness["row"]),)) == [witness["answer"]] == [0]
