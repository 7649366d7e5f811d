"""The witnesses against the printed procedures are quadcopters that could fly, and the programs err at them."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from functools import cache

import pytest

import hypcheck
from hypcheck.geometry.pair import Position
from hypcheck.paper.ledger import statements as say
from hypcheck.paper.ledger.book import entries
from hypcheck.paper.ledger.points import Point, counterexample, facts
from hypcheck.paper.ledger.statements import PROCEDURE_2A, Quadcopter, program_says, quadcopters, refused_though_inside


@cache
def ledger():
    return {entry.number: entry for entry in entries()}


def hull_of(number):
    hull, _ = ledger()[number].evidence[0].witnesses
    return hull.facts


@pytest.mark.parametrize("number", ["Table 4", "Table 4, caption"])
def test_the_rotors_of_the_witness_are_inside_and_the_movement_is_refused(number):
    hull = hull_of(number)
    found = refused_though_inside(hull)
    assert found is not None
    assert not found.answer
    a, c, r, z = (float(value) for value in (hull.point.a, hull.point.c, hull.point.r, hull.point.z))
    arm, size = float(found.arm), float(found.size)
    for rotor in range(4):
        angle = math.pi / 4 + rotor * math.pi / 2
        row = [a, c, size, size, r + arm * math.cos(angle), arm * math.sin(angle), z]
        assert hypcheck.classify([row]).tolist() == [Position.INTERIOR]


def test_caption_of_table_4_is_wrong_for_a_low_hyperboloid_and_its_procedure_for_a_tall_one():
    low, tall = hull_of("Table 4, caption"), hull_of("Table 4")
    assert say.wide(low)
    assert not say.tall(low)
    assert say.contact(low)
    assert low.delta > 0
    assert say.tall(tall)
    assert say.interior(tall)
    assert 0 in (tall.c1, tall.c2)


def test_rotors_lie_in_the_hull_and_apart_from_each_other():
    hull = facts(Point(*map(Fraction, (3, 3, 0, 0))))
    assert len(quadcopters(hull)) == 4
    for each in quadcopters(hull):
        assert each.fits
        assert each.arm + each.size <= 1
        assert each.arm * Fraction(7, 5) >= 2 * each.size  # 7/5 < √2: neighbours' centres are arm·√2 apart
    assert not Quadcopter(hull, Fraction(1), Fraction(1, 8)).fits
    assert not Quadcopter(hull, Fraction(1, 4), Fraction(1, 4)).fits


def test_procedure_2b_is_right_about_ordinary_interior_and_contact_positions():
    inside, across = facts(Point(*map(Fraction, (5, 7, 1, 1)))), facts(Point(*map(Fraction, (5, 7, 5, 1))))
    assert inside.position is Position.INTERIOR
    assert across.position is Position.CONTACT
    assert quadcopters(inside)[0].answer
    assert not Quadcopter(across, Fraction(1, 2), Fraction(1, 4)).answer
    assert refused_though_inside(inside) is None
    assert refused_though_inside(across) is None


def test_every_rotor_is_at_most_as_far_from_the_axis_as_the_farthest_point_of_the_witness():
    hull = hull_of("Table 4, caption")
    for each in quadcopters(hull):
        reach = max(
            math.hypot(float(hull.point.r) + float(each.arm) * math.cos(angle), float(each.arm) * math.sin(angle))
            for angle in (math.pi / 4 + quarter * math.pi / 2 for quarter in range(4))
        )
        assert reach <= float(each.farthest.r * each.size) + 1e-15


def test_built_in_procedure_1_and_table_2_are_wrong_at_the_ring_witness_and_right_beside_it():
    ring = ledger()["Table 1"].evidence[0].witnesses[0].facts
    for name in ("procedure-1", "table-2"):
        assert program_says(name, ring) == 0
        beside = facts(replace(ring.point, r=ring.point.r + Fraction(1, 64)))
        assert program_says(name, beside) == 1
        assert beside.position is ring.position is Position.EXTERIOR


def test_procedure_2a_is_tested_with_rotors_on_arms():
    found = counterexample(PROCEDURE_2A).found
    assert found.point.r > 0
    assert say.interior(found)
    assert 0 in (found.c1, found.c2)
