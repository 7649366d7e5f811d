"""Bench about spheroids that lean: its workloads, a small run, scenes whose mover leans, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hypcheck
from hypcheck.bench import foreign
from hypcheck.bench.contender import InPython
from hypcheck.bench.contenders import contenders
from hypcheck.bench.plan import TILTED_REFERENCE, BenchPlan
from hypcheck.bench.workloads import TILTED_WORKLOADS, scene_of, scene_workloads
from hypcheck.errors import InputError
from hypcheck.geometry.rows import first_trouble
from hypcheck.implementations.meshes import COAL
from hypcheck.implementations.session import Limits
from hypcheck.record.measurements import AbsentLine, AccuracyLine, BoundingLine, SpeedLine, StabilityLine, WorkloadLine
from hypcheck.report import markdown
from hypcheck.runs import judge
from hypcheck.truth.tilted import batch
from tests.bench.test_run import ended
from tests.tools.miniatures import QUICK, command

pytestmark = pytest.mark.usefixtures("text_reports")

SCENE = """
name = "pitching"

[[hyperboloid]]
name = "tower"
alpha = 2.0
gamma = 17.8
height = [-17.8, 17.8]
{leaning}

[mover]
b = 0.25
d = 0.15
axis = {axis}
"""


def scene(folder, axis, leaning=""):
    path = folder / "scene.toml"
    path.write_text(SCENE.format(axis=axis, leaning=leaning), encoding="utf-8")
    return str(path)


@pytest.mark.parametrize("name", TILTED_WORKLOADS)
def test_rows_are_valid_and_a_shorter_call_is_the_beginning_of_a_longer_one(name):
    rows = TILTED_WORKLOADS[name].rows(3, 1500)
    assert rows.shape == (1500, 10)
    assert first_trouble(rows) is None
    assert (rows[:, 7:9] != 0).any(axis=1).all()
    assert (TILTED_WORKLOADS[name].rows(3, 90) == rows[:90]).all()
    assert (TILTED_WORKLOADS[name].rows(4, 90) != rows[:90]).any()
    assert TILTED_WORKLOADS[name].rows(3, 0).shape == (0, 10)


def test_only_the_workload_of_one_axis_is_a_scene():
    assert [name for name, each in TILTED_WORKLOADS.items() if scene_of(each.rows(1, 100)) is not None] == ["one-axis"]


def test_near_contact_has_all_positions_at_distances_from_1e_17_to_half():
    rows = TILTED_WORKLOADS["near-contact"].rows(1, 150)
    assert set(batch.positions(rows).tolist()) == {-1, 0, 1}
    exponents = judge.flip_exponents(rows)
    assert exponents.min() < -53
    assert exponents.max() > -7


def test_an_estimated_distance_lies_between_the_proved_ends_of_it_or_near_them():
    rows = TILTED_WORKLOADS["near-contact"].rows(2, 12)
    clear = hypcheck.classify(rows) != 0
    assert clear.sum() > 3
    for row in rows[clear][:3].tolist():
        low, high = judge.ends_of(row, 0, "position")
        assert low / 2 <= judge.about_error_of(row, 0, "position") <= 2 * high


def test_a_scene_of_one_axis_is_asked_by_scene_and_others_by_rows():
    asked = []

    def function(rows):
        asked.append("rows")
        return hypcheck.classify(rows)

    def by_scene(sizes, x, y, z, axis):
        asked.append(axis)
        return hypcheck.classify_scene(sizes, x, y, z, axis=axis)

    for name in ("one-axis", "an-axis-each"):
        rows = TILTED_WORKLOADS[name].rows(1, 50)
        assert (InPython(function, by_scene).batch(rows).answers() == hypcheck.classify(rows)).all()
    assert asked == [tuple(TILTED_WORKLOADS["one-axis"].rows(1, 1)[0, 7:]), "rows"]


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    methods = "fast-numpy,exact-oracle,upright,bounding-sphere"
    return ended(tmp_path_factory.mktemp("tilted"), "--tilted", "--methods", methods)


def test_a_run_compares_error_and_time_with_the_reference_for_leaning_spheroids(small):
    code, record = small
    assert code == 0
    assert record.header.options["reference"] == TILTED_REFERENCE
    assert [line.workload for line in record.of(WorkloadLine)] == list(TILTED_WORKLOADS)
    judged = {(line.method, line.workload): line for line in record.of(AccuracyLine)}
    assert judged["fast-numpy", "near-contact"].wrong == judged["exact-oracle", "near-contact"].wrong == 0
    assert judged["upright", "near-contact"].wrong > judged[TILTED_REFERENCE, "near-contact"].wrong
    assert judged["upright", "near-contact"].false_clear > 0
    assert judged["bounding-sphere", "near-contact"].false_clear == 0
    timed = {(line.method, line.workload): line for line in record.of(SpeedLine) if line.mode == "batch"}
    assert {name for _, name in timed} == {"one-axis", "an-axis-each", "near-contact"}
    assert timed[TILTED_REFERENCE, "one-axis"].ratio == 1.0
    assert timed["upright", "an-axis-each"].ratio < 1
    assert not record.of(StabilityLine)
    assert not record.of(BoundingLine)


def test_the_report_shows_the_methods_for_leaning_spheroids(small):
    text = markdown.render(small[1]).decode()
    assert "leaning one way around the tower" in text
    assert "The reference, of ratio 1, is `eigh`." in text


@pytest.mark.parametrize("axis", ["[0.3, 0.1, 1.0]", '"free"'])
def test_a_scene_whose_mover_leans_is_asked_with_its_axis_in_its_region_and_near_contact(tmp_path, axis):
    name = scene(tmp_path, axis)
    for each in scene_workloads(name).values():
        rows = each.rows(1, 200)
        assert (rows[:, :4] == (2.0, 17.8, 0.25, 0.15)).all()
        assert (np.abs(rows[:, 6]) <= 17.8 + 0.3).all()
        assert len(np.unique(rows[:, 7:], axis=0)) == (1 if axis != '"free"' else 200)
    code, record = ended(tmp_path, "--scene", name, "--methods", "fast-numpy,exact-oracle")
    assert code == 0
    assert {line.workload for line in record.of(AccuracyLine)} == {"region", "near-contact"}
    assert all(not line.wrong for line in record.of(AccuracyLine) if line.method in ("fast-numpy", "exact-oracle"))


def test_a_scene_with_a_leaning_hyperboloid_is_refused(tmp_path):
    name = scene(tmp_path, '"free"', "axis = [0.1, 0.0, 1.0]")
    with pytest.raises(InputError, match="the hyperboloid 'tower' leans"):
        ended(tmp_path, "--scene", name)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--tilted", "--kernel"), "--kernel measures the fast path and nothing else"),
        (("--tilted", "--scene", "tower"), "--tilted is about movers that lean, and none does in the scene 'tower'"),
        (("--tilted", "--workloads", "uniform"), "there is no workload 'uniform'"),
        (("--tilted", "--methods", "fast-c"), "there is no method 'fast-c'"),
    ],
)
def test_a_choice_that_tilted_does_not_have_is_refused(tmp_path, options, message):
    with pytest.raises(InputError, match=message):
        ended(tmp_path, *options)


def test_a_leaning_scene_is_measured_alone(tmp_path):
    with pytest.raises(InputError, match="leans; measure that scene alone"):
        ended(tmp_path, "--scene", scene(tmp_path, '"free"'), "--scene", "tower")


def test_a_spec_takes_part_if_its_description_says_tilt():
    limits = replace(Limits(), **QUICK) if isinstance(QUICK, dict) else Limits()
    found = foreign.foreign_method(command("tilted", "binary"), limits, [], tilted=True)
    plan = BenchPlan(tilted=True, foreign=(found,))
    assert found.name in contenders(plan)
    with pytest.raises(InputError, match='its description has no "tilt": true'):
        foreign.foreign_method(command("right", "binary"), limits, [], tilted=True)


def test_coal_is_named_with_the_reason_where_it_is_not_installed(tmp_path):
    if COAL.trouble() is None:
        pytest.skip("coal is installed")
    _, record = ended(tmp_path, "--tilted", "--methods", "coal-*", "--workloads", "one-axis")
    assert [line.what for line in record.of(AbsentLine)] == [COAL.title]
