"""The ledger's witnesses that lean: simplest pairs, certified, whose answer the upright spheroid gets wrong."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hypcheck.cli.main import main
from hypcheck.geometry.pair import Position
from hypcheck.paper.ledger.book import entries
from hypcheck.paper.ledger.points import first_change
from tests.support.tilted_fractions import exact_position


@pytest.fixture(scope="module")
def evidence():
    (row,) = (entry for entry in entries() if entry.number == "Section 3.2, pitch")
    (found,) = (each for each in row.evidence if each.tilted)
    return found


def test_ledger_row_about_pitch_has_one_witness_of_a_false_interior_and_one_of_a_false_contact(evidence):
    assert evidence.holds
    dangerous, needless = evidence.tilted
    assert (dangerous.vertical.position, dangerous.certificate.position) == (Position.INTERIOR, Position.CONTACT)
    assert (needless.vertical.position, needless.certificate.position) == (Position.CONTACT, Position.INTERIOR)
    for witness in evidence.tilted:
        alpha, _, b, d = witness.pair.row[:4]
        assert alpha >= b > d
        assert abs(witness.pair.axis_x) <= witness.pair.axis_z


def test_upright_and_pitched_positions_of_witnesses_agree_with_independent_arithmetic(evidence):
    for witness in evidence.tilted:
        upright = (*witness.pair.row[:7], 0.0, 0.0, 1.0)
        assert exact_position(witness.pair.row) == witness.certificate.position
        assert exact_position(upright) == witness.vertical.position


def test_pitch_witness_with_a_proof_of_another_position_does_not_hold(evidence):
    dangerous, needless = evidence.tilted
    assert not replace(dangerous, certificate=needless.certificate).holds
    assert not replace(dangerous, vertical=needless.vertical).holds
    assert not replace(dangerous, pair=needless.pair).holds


def test_pitch_witness_search_without_a_result_returns_the_number_of_tried_pairs():
    search = first_change(Position.CONTACT, Position.EXTERIOR, "never", largest=2)
    assert search.found is None
    assert search.tried > 0


def test_each_pitch_witness_is_shown_with_a_classify_command_that_gives_its_position(evidence, capsys):
    assert main(["derive", "--claim", "Section 3.2, pitch"]) == 0
    commands = [line.split() for line in capsys.readouterr().out.splitlines() if "hypcheck classify" in line]
    assert len(commands) == len(evidence.tilted)
    for command, witness in zip(commands, evidence.tilted, strict=True):
        main(command[1:])
        assert capsys.readouterr().out.splitlines()[0] == witness.certificate.position.label
