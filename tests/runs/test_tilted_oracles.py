"""The self-check asks the oracles for tilted spheroids about frozen vectors, and a wrong oracle is noticed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hypcheck.geometry.pair import Position
from hypcheck.runs import oracles
from hypcheck.runs.findings import SelfCheckPlan
from hypcheck.runs.oracles import ORACLES, Opinion, TiltedBatch
from hypcheck.vectors import frozen

PLAN = SelfCheckPlan(count=6, roots=60, meshes=60)
ASKED = ("exact", "nearest", "roots", "mesh")


@pytest.fixture(scope="module")
def batches():
    return oracles.tilted_batches(PLAN)


def tallied(task, batch):
    opinions, seconds = oracles.ask_oracle(task)
    return oracles.oracle_line(task.oracle, batch, opinions, seconds)


@pytest.mark.slow
def test_tilted_oracles_are_asked_the_frozen_vectors_of_every_family_except_the_extreme_one(batches):
    assert [batch.family.name for batch in batches] == [n for n in frozen.TILTED_NAMES if not n.startswith("extreme")]
    assert all(batch.rows.shape == (6, 10) for batch in batches)
    assert batches[0].name(3) == "tilted-uniform-0003"
    assert oracles.tilted_batches(SelfCheckPlan(families=("ring",))) == ()


@pytest.mark.slow
@pytest.mark.skipif(ORACLES["mesh"].available() is not None, reason="python-fcl is not installed")
def test_four_oracles_are_asked_about_tilted_spheroids_and_agree_with_the_labels(batches):
    tasks = oracles.oracle_tasks(PLAN, batches)
    assert {task.oracle for task in tasks} == set(ASKED)
    for task in tasks:
        found = tallied(task, batches[task.batch])
        assert found.disagreements == [], found
        assert found.undecided == 0 or task.oracle == "mesh", found


@pytest.mark.parametrize("name", ASKED)
def test_wrong_oracle_for_tilted_spheroids_is_reported_as_disagreeing(monkeypatch, batches, name):
    wrong = replace(ORACLES[name], ask_tilted=lambda rows: [Opinion(Position.CONTACT, tangent=False)] * len(rows))
    monkeypatch.setitem(oracles.ORACLES, name, wrong)
    ring: TiltedBatch = next(batch for batch in batches if batch.family.name == "tilted-ring")
    (task,) = (each for each in oracles.oracle_tasks(PLAN, [ring]) if each.oracle == name)
    found = tallied(task, ring)
    assert len(found.disagreements) == len(task.rows)
    assert found.disagreements[0].case == "tilted-ring-0000"
    assert len(found.disagreements[0].axis) == 3
    assert found.disagreements[0].opinion == "contact, tangent: False, None"


def test_a_tangency_that_an_oracle_calls_a_crossing_is_a_disagreement(monkeypatch, batches):
    wrong = replace(ORACLES["roots"], ask_tilted=lambda rows: [Opinion(Position.CONTACT, tangent=False)] * len(rows))
    monkeypatch.setitem(oracles.ORACLES, "roots", wrong)
    tangent = next(batch for batch in batches if batch.family.name == "tilted-tangent")
    (task,) = (each for each in oracles.oracle_tasks(PLAN, [tangent]) if each.oracle == "roots")
    assert len(tallied(task, tangent).disagreements) == len(task.rows)
