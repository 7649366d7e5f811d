"""The tool that compares clearances with the oracle agrees with right ones, and sees wrong ones."""

from __future__ import annotations

from dataclasses import replace

from hypcheck import clearance
from tests.tools.clearance_agreement import drawn, faults, main


def test_agreement_check_finds_no_fault_in_right_clearances(capsys):
    assert main(["--rows", "300", "--points", "20"]) == 0
    assert "300 clearances and 15 places of touch compared, 0 wrong" in capsys.readouterr().out


def test_agreement_check_finds_wrong_bounds_positions_and_places_of_touch():
    (rows,) = drawn(1, 200)
    said = clearance(rows)
    assert len(list(faults(rows, replace(said, upper=said.lower - 1), 1000))) == 200
    assert len(list(faults(rows, replace(said, position=-said.position - 1), 1000))) > 100
    assert len(list(faults(rows, replace(said, touch=said.touch + 2 * said.touch_error[:, None]), 5))) > 10
