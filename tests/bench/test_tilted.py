"""Bench about tilted spheroids: its workloads, a small run, scenes whose mover is tilted, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hypcheck
from hypcheck.bench.contenders import contenders, foreign_method
from hypcheck.bench.loaded import InPython
from hypcheck.bench.plan import POSITION, TILTED_REFERENCE, BenchPlan
from hypcheck.bench.workloads import listed, scene_of, scene_workloads
from hypcheck.errors import InputError
from hypcheck.geometry.rows import first_trouble
from hypcheck.implementations.meshes import COAL
from hypcheck.implementations.session import Limits
from hypcheck.record.measurements import AbsentLine, AccuracyLine, BoundingLine, SpeedLine, StabilityLine, WorkloadLine
from hypcheck.report import markdown
from hypcheck.runs import judge
from tests.bench.test_run import ended
from tests.support import inside
from tests.support.inside import flip_exponents
from tests.support.judging import ends_of
from tests.tools.miniatures import QUICK, command

pytestmark = pytest.mark.usefixtures("text_reports")

SCENE = """
name = "pitching"

[[hyperboloid]]
name = "tower"
alpha = 2.0
gamma = 17.8
height = [-17.8, 17.8]
{tilted}

[mover]
b = 0.25
d = 0.15
axis = {axis}
"""


def scene(folder, axis, tilted=""):
    path = folder / "scene.toml"
    path.write_text(SCENE.format(axis=axis, tilted=tilted), encoding="utf-8")
    return str(path)


TILTED_WORKLOADS = listed(POSITION, tilted=True)


@pytest.mark.parametrize("name", TILTED_WORKLOADS)
def test_tilted_workload_rows_are_valid_and_a_short_workload_is_the_beginning_of_a_longer_one(name):
    rows = TILTED_WORKLOADS[name].rows(3, 1500)
    assert rows.shape == (1500, 10)
    assert first_trouble(rows) is None
    assert (rows[:, 7:9] != 0).any(axis=1).all()
    assert (TILTED_WORKLOADS[name].rows(3, 90) == rows[:90]).all()
    assert (TILTED_WORKLOADS[name].rows(4, 90) != rows[:90]).any()
    assert TILTED_WORKLOADS[name].rows(3, 0).shape == (0, 10)


def test_one_axis_is_the_only_tilted_workload_that_has_a_single_scene():
    assert [name for name, each in TILTED_WORKLOADS.items() if scene_of(each.rows(1, 100)) is not None] == ["one-axis"]


def test_tilted_near_contact_workload_has_all_positions_at_distances_from_1e_16_to_1e_2():
    rows = TILTED_WORKLOADS["near-contact"].rows(1, 150)
    assert set(inside.positions(rows).tolist()) == {-1, 0, 1}
    exponents = flip_exponents(rows)
    assert exponents.min() < -53
    assert exponents.max() > -7


def test_estimated_distance_of_a_tilted_row_is_within_twice_its_proved_interval():
    rows = TILTED_WORKLOADS["near-contact"].rows(2, 12)
    clear = hypcheck.classify(rows) != 0
    assert clear.sum() > 3
    for row in rows[clear][:3].tolist():
        low, high = ends_of(row, 0)
        assert low / 2 <= judge.about_error_of(row, 0, "position") <= 2 * high


def test_rows_with_one_axis_are_sent_by_scene_and_rows_with_several_by_rows():
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


def test_bench_tilted_compares_errors_and_times_with_the_reference(small):
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


def test_the_report_of_bench_tilted_names_its_workload_and_reference(small):
    text = markdown.render(small[1]).decode()
    assert "tilted one way around the tower" in text
    assert "as long as eigh" in text or "as fast as eigh" in text


@pytest.mark.parametrize("axis", ["[0.3, 0.1, 1.0]", '"free"'])
def test_bench_scene_with_a_tilted_mover_has_rows_in_its_region_and_near_contact(tmp_path, axis):
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


def test_bench_refuses_a_scene_in_whose_region_no_hyperboloid_is(tmp_path):
    name = scene(tmp_path, '"free"')
    with open(name, "a", encoding="utf-8") as file:
        file.write("[region]\nz = [90, 99]\n")
    with pytest.raises(InputError, match="'pitching' is not measured: no hyperboloid's height meets its region"):
        ended(tmp_path, "--scene", name)


def test_bench_refuses_a_scene_with_a_tilted_hyperboloid(tmp_path):
    name = scene(tmp_path, '"free"', "axis = [0.1, 0.0, 1.0]")
    with pytest.raises(InputError, match="the hyperboloid 'tower' is tilted"):
        ended(tmp_path, "--scene", name)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--tilted", "--kernel"), "--kernel measures only the fast path"),
        (
            ("--tilted", "--scene", "tower"),
            "--tilted measures tilted movers; the mover of the scene 'tower' is not",
        ),
        (("--tilted", "--workloads", "uniform"), "there is no workload 'uniform'"),
        (("--tilted", "--methods", "fast-c"), "there is no method 'fast-c'"),
    ],
)
def test_bench_tilted_refuses_methods_and_workloads_that_it_does_not_have(tmp_path, options, message):
    with pytest.raises(InputError, match=message):
        ended(tmp_path, *options)


def test_bench_refuses_a_tilted_scene_together_with_another_scene(tmp_path):
    with pytest.raises(InputError, match="is tilted; measure that scene alone"):
        ended(tmp_path, "--scene", scene(tmp_path, '"free"'), "--scene", "tower")


def test_bench_tilted_takes_a_spec_only_if_its_description_says_tilt():
    limits = replace(Limits(), **QUICK) if isinstance(QUICK, dict) else Limits()
    found = foreign_method(command("tilted", "binary"), limits, [], tilted=True)
    plan = BenchPlan(tilted=True, foreign=(found,))
    assert found.name in contenders(plan)
    with pytest.raises(InputError, match='its description has no "tilt": true'):
        foreign_method(command("right", "binary"), limits, [], tilted=True)


def test_bench_tilted_records_that_coal_is_missing_where_it_is_not_installed(tmp_path):
    if COAL.trouble() is None:
        pytest.skip("coal is installed")
    _, record = ended(tmp_path, "--tilted", "--methods", "coal-*", "--workloads", "one-axis")
    assert [line.what for line in record.of(AbsentLine)] == [COAL.title]
