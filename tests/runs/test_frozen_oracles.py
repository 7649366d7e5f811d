"""The self-check asks oracles frozen vectors of tilted spheroids and of ends, and a wrong oracle is noticed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hypcheck.geometry.pair import Position
from hypcheck.runs import oracles
from hypcheck.runs.findings import SelfCheckPlan, batch_of
from hypcheck.runs.oracles import ORACLES, Opinion
from hypcheck.vectors import frozen
from hypcheck.vectors.families import FAMILIES, case_id, select

PLAN = SelfCheckPlan()
ASKED = ("exact", "nearest", "roots", "mesh")
ENDED = ("exact", "nearest", "heights", "mesh")
TANGENT = Opinion(Position.CONTACT, tangent=True)


def first(count):
    """The first frozen vectors of all families of tilted spheroids that are asked."""
    return [
        oracles.frozen_batch(family, count)
        for family in oracles.frozen_families(PLAN)
        if "heights" not in family.groups
    ]


@pytest.fixture(scope="module")
def batches():
    return first(6)


@pytest.mark.slow
def test_tilted_oracles_decide_the_frozen_vectors_of_every_family_except_the_extreme_one(batches):
    assert [batch.chunk.family for batch in batches] == [n for n in frozen.TILTED_NAMES if not n.startswith("extreme")]
    assert all(batch.rows.shape == (6, 10) for batch in batches)
    assert batches[0].chunk.name(3) == "tilted-uniform-0003"
    assert oracles.frozen_families(SelfCheckPlan(families=("ring",))) == ()


@pytest.fixture(scope="module")
def ended():
    """The first frozen vectors of all families of hyperboloids that end."""
    return [oracles.frozen_batch(family, 4) for family in oracles.frozen_families(PLAN) if "heights" in family.groups]


@pytest.mark.skipif(ORACLES["mesh"].available() is not None, reason="python-fcl is not installed")
def test_four_oracles_decide_frozen_vectors_and_agree_with_the_labels(batches, ended):
    """Of three families each; tests/test_corpus.py asks all oracles about all."""
    assert {batch.chunk.family for batch in ended} == set(frozen.ENDED_NAMES)
    for names, some in ((ASKED, batches[:3]), (ENDED, ended[:3])):
        for batch in some:
            found = oracles.oracle_lines(batch, {name: int(name in names) for name in ORACLES})
            assert [(line.oracle, line.asked) for line in found] == [(name, 1) for name in names]
            assert all(line.disagreements == [] for line in found), found
            assert all(line.undecided == 0 or line.oracle in ("nearest", "mesh") for line in found), found


@pytest.mark.parametrize("name", ENDED)
def test_wrong_oracle_for_hyperboloids_that_end_is_reported_with_their_heights(monkeypatch, ended, name):
    wrong = replace(ORACLES[name], ask=lambda rows: [Opinion(Position.INTERIOR)] * len(rows))
    monkeypatch.setitem(oracles.ORACLES, name, wrong)
    opening = next(batch for batch in ended if batch.chunk.family == "ended-rim")
    (found,) = oracles.oracle_lines(opening, {name: 4})
    assert found.disagreeing == sum(decision.position is not Position.INTERIOR for decision in opening.decisions) > 0
    assert len(found.disagreements[0].heights) == 3


def test_roots_oracle_gets_all_upright_rows_a_tenth_as_many_tilted_rows_and_no_rows_with_ends():
    families = [*select(PLAN.families), *oracles.frozen_families(PLAN)]

    def share(name):
        return oracles.shares(PLAN, next(family for family in families if family.name == name), families)

    assert share("ring")["roots"] >= PLAN.count
    assert share("tilted-ring")["roots"] == -(-share("ring")["roots"] // 10)
    assert share("ended-rim")["roots"] == 0
    assert share("ended-rim")["exact"] == share("ended-rim")["nearest"] == PLAN.count
    assert share("ended-rim")["heights"] == PLAN.count
    assert sum(share(family.name)["mesh"] for family in families) >= PLAN.meshes


@pytest.mark.parametrize("name", ASKED)
def test_wrong_oracle_for_tilted_spheroids_is_reported_as_disagreeing(monkeypatch, batches, name):
    wrong = replace(ORACLES[name], ask=lambda rows: [Opinion(Position.CONTACT, tangent=False)] * len(rows))
    monkeypatch.setitem(oracles.ORACLES, name, wrong)
    ring = next(batch for batch in batches if batch.chunk.family == "tilted-ring")
    (found,) = oracles.oracle_lines(ring, {name: 4})
    assert len(found.disagreements) == found.asked == 4
    assert found.disagreements[0].case == "tilted-ring-0000"
    assert len(found.disagreements[0].axis) == 3
    assert found.disagreements[0].opinion == "contact, tangent: False, None"


def test_a_tangency_that_an_oracle_calls_a_crossing_is_a_disagreement(monkeypatch, batches):
    wrong = replace(ORACLES["roots"], ask=lambda rows: [Opinion(Position.CONTACT, tangent=False)] * len(rows))
    monkeypatch.setitem(oracles.ORACLES, "roots", wrong)
    tangent = next(batch for batch in batches if batch.chunk.family == "tilted-tangent")
    (found,) = oracles.oracle_lines(tangent, {"roots": 4})
    assert found.disagreeing == found.asked == 4


def test_oracle_decides_only_cases_of_a_later_batch_that_are_among_the_first_of_the_family():
    uniform = FAMILIES["uniform"]
    later, none = batch_of(uniform, 1, 400, 410), batch_of(uniform, 1, 403, 410)
    assert [line.asked for line in oracles.oracle_lines(later, {"exact": 405, "roots": 403})] == [5, 3]
    assert oracles.oracle_lines(none, {"roots": 403}) == []
    assert none.chunk.name(0) == case_id(uniform, 1, 403)
    assert none.rows.tolist() == uniform.rows(1, 410)[403:].tolist()


def test_merged_line_of_an_oracle_adds_up_the_parts_of_a_family(monkeypatch):
    wrong = replace(ORACLES["exact"], ask=lambda rows: [Opinion(None, stage="lost")] + [TANGENT] * (len(rows) - 1))
    monkeypatch.setitem(oracles.ORACLES, "exact", wrong)
    parts = [batch_of(FAMILIES["uniform"], 1, *cases) for cases in ((12, 24), (0, 12), (24, 30))]
    found = [line for part in parts for line in oracles.oracle_lines(part, {"exact": 30})]
    (line,) = oracles.merged_lines(found)
    assert (line.asked, line.undecided, line.disagreeing, len(line.disagreements)) == (30, 3, 27, 20)
    assert line.stages == {"": 27, "lost": 3}
    assert line.seconds == sum(part.seconds for part in found)
    assert [each.case for each in line.disagreements] == sorted(each.case for each in line.disagreements)
