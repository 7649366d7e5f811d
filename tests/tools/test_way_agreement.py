"""The tool that compares answers about ways agrees with a sample of them, and sees answers that are wrong."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import islice

import pytest

from hypcheck.vectors import frozen
from tests.tools import way_agreement
from tests.tools.way_agreement import Said, compared, faults, generated_ways

SAMPLE = {
    "way-tunnelling": 3,
    "way-grazing": 7,
    "way-near-graze": 5,
    "way-ring": 108,
    "way-end": 1,
    "way-short": 2,
    "tilted-way-small-integers": 3,
}
"""A case of each family that the suite looks at."""


def said(name):
    case = frozen.load(name).cases[SAMPLE[name]]
    return Said(case.id, case.row, case.first and tuple(map(Fraction, case.first)))


@pytest.mark.parametrize("name", SAMPLE)
def test_roots_in_time_and_samples_confirm_a_frozen_sweep(name):
    assert faults(said(name), 8) == []


def test_roots_in_time_and_samples_confirm_generated_sweeps(capsys):
    ways = list(islice(generated_ways(22, 5), 2))
    assert compared(ways, [faults(each, 4) for each in ways]) == 0
    assert "together                        2 ways, " in capsys.readouterr().out


def test_agreement_check_finds_wrong_answers_about_sweeps(capsys):
    graze = said("way-grazing")
    assert faults(replace(graze, first=None), 8)[-1].endswith("and is said to be at no time")
    late = tuple(each + Fraction(1, 64) for each in graze.first)
    assert "and is said to be at t = " in faults(replace(graze, first=late), 8)[-1]
    through = replace(said("way-tunnelling"), first=None)
    found = faults(through, 64)
    assert "the position is 0, at the start" in found[0]
    assert compared([through], [found]) == 1
    assert through.name in capsys.readouterr().out
    ring = replace(said("way-ring"), first=(Fraction(1, 2), Fraction(1, 2)))
    assert faults(ring, 2) == ["contact is first at no time, and is said to be at t = 0.5 … 0.5"]


def test_sweep_that_the_discriminant_cannot_decide_is_counted_as_undecided(monkeypatch, capsys):
    graze = said("way-grazing")
    nothing = way_agreement.polynomial(Fraction(0))
    monkeypatch.setattr(way_agreement, "discriminant", lambda row: nothing)
    assert faults(graze, 4) is None
    assert compared([graze], [None]) == 0
    assert "1 left undecided by the discriminant" in capsys.readouterr().out
