"""Each way to ask a method gives the same answers: rows at once, one by one, by numbers, by a mesh built once."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from hypcheck import toml
from hypcheck.bench import accuracy, run
from hypcheck.bench.contenders import Contender, contenders
from hypcheck.bench.loaded import InEngine, InPython, InScalars
from hypcheck.bench.plan import QUICK, BenchPlan
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.errors import Exit
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations import builtin
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.meshes import FCL, scene_mesh
from hypcheck.record import Recorder
from hypcheck.record.measurements import KernelLine
from tests.support.fractions_truth import exact_position
from tests.support.records import GrowingText
from tests.support.tilted_fractions import exact_position as exact_tilted

SIZES, OTHER = (2.0, 3.0, 0.25, 0.15), (1.0, 2.0, 0.25, 0.15)
CENTRES = ((2.1, 0.0, 0.5), (5.0, 0.0, 1.0), (0.5, 0.0, 0.0), (0.0, 2.2, -0.5))
ROWS = np.array([(*SIZES, *centre) for centre in CENTRES])
TWO_SCENES = np.vstack([ROWS, [(*OTHER, *centre) for centre in CENTRES]])
RIGHT, RIGHT_OF_TWO = ([exact_position(tuple(row)) for row in rows.tolist()] for rows in (ROWS, TWO_SCENES))


def contender(**changes):
    given = {"name": "mine", "title": "", "tier": "python", "kind": "exact", "precision": "float64"}
    return Contender(**{**given, "question": "position", "domain": Domain(), "load": partial(InPython, len), **changes})


def test_a_scalar_function_gives_the_same_answers_for_a_batch_and_one_by_one():
    way = contenders(BenchPlan(amounts=QUICK))["position-python"].load()
    assert isinstance(way, InScalars)
    for answers in (way.answer(ROWS), way.batch(ROWS).answers(), way.single(ROWS).answers()):
        assert answers.tolist() == RIGHT
    _, total = way.single(ROWS).run(3)
    assert total == sum(RIGHT)
    assert way.build(ROWS) is None
    assert way.empty(ROWS, "batch") is None
    assert way.empty(ROWS, "single").ready.answers().tolist() == [0] * len(ROWS)
    way.close()


@pytest.mark.skipif(FCL.trouble() is not None, reason="python-fcl is not installed")
def test_an_engine_builds_the_mesh_of_a_scene_once_and_answers_rows_of_several_scenes():
    built = []

    def make(sizes, high):
        built.append(sizes)
        return scene_mesh(FCL, "sphere", sizes, high, triangles=5000)

    way = InEngine(make)
    assert way.answer(TWO_SCENES).tolist() == RIGHT_OF_TWO
    assert way.batch(TWO_SCENES).answers().tolist() == RIGHT_OF_TWO
    assert way.single(TWO_SCENES).answers().tolist() == RIGHT_OF_TWO
    assert sorted(set(built)) == sorted([SIZES, OTHER])
    assert len(built) == 2
    assert way.batch(ROWS).answers().tolist() == way.single(ROWS).answers().tolist() == RIGHT
    assert way.build(TWO_SCENES) is None
    work = way.build(ROWS)
    known = work.answers().tolist()
    assert work.run(1)[1] == known[0] == way.mesh(SIZES, ROWS).triangles
    assert len(built) >= 3
    assert way.empty(ROWS, "build") is None
    assert way.empty(ROWS, "batch") is not None
    way.close()
    assert way.meshes == {}


def test_nearest_point_method_for_tilted_spheroids_answers_as_exact_fractions_do():
    rows = np.array([(*row, 1.0, 0.0, 1.0) for row in ROWS.tolist()])
    way = contenders(BenchPlan(amounts=QUICK, tilted=True))["nearest-point"].load()
    answers = way.answer(rows).tolist()
    assert CANNOT_SAY not in answers
    assert answers == [exact_tilted(tuple(row)) for row in rows.tolist()]


def test_bench_does_not_ask_a_method_about_rows_of_more_scenes_than_it_takes():
    assert contender(scenes=2).asked(TWO_SCENES).tolist() == list(range(len(TWO_SCENES)))
    assert contender(scenes=1).asked(TWO_SCENES).tolist() == []


def test_memory_line_reports_the_memory_that_a_method_needs_in_addition_to_its_rows():
    def greedy(rows):
        held = np.ones(8_000_000 if len(rows) > 1 else 1)
        return np.full(len(rows), int(held[-1]), dtype=np.int8)

    line = accuracy.memory_line(contender(load=partial(InPython, greedy)), TWO_SCENES)
    assert (line.method, line.rows) == ("mine", len(TWO_SCENES))
    assert 60e6 < line.peak_bytes < 90e6


def test_every_method_that_the_listing_names_is_built_in():
    """Others are left out in silence, as those that do not run here are."""
    listing = toml.shipped("hypcheck.bench", "contenders.toml")["contenders"]
    named = {
        entry.get("of", name.removesuffix("-c"))
        for entries in listing.values()
        for entry in entries
        for name in entry["methods"]
    }
    assert named - builtin.methods().keys() == ({"table-2-longdouble"} if builtin.LONG_DOUBLE is None else set())


def test_a_missing_requirement_is_recorded_once_however_often_it_is_reported():
    recorder = Recorder(GrowingText(), {})
    for what in ("FCL", "Coal", "FCL"):
        run.note_absent(recorder, what, "it is not there")
    assert [line.what for line in recorder.lines] == ["FCL", "Coal"]


def test_a_method_for_one_scene_is_timed_only_on_rows_of_the_first_scene():
    several = WORKLOADS["near-contact"]
    rows = accuracy.timed_rows(BenchPlan(amounts=QUICK), contender(scenes=1, timed=100), several)
    assert len(rows) == 100
    assert len(np.unique(rows[:, :4], axis=0)) == 1
    assert len(np.unique(several.rows(1, 100)[:, :4], axis=0)) > 1


def test_bench_kernel_ends_with_slower_if_a_kernel_misses_a_target():
    fast, slow = (
        KernelLine(name="it", target="", wanted=2.0, measured=1.0, ci95=None, met=met, says="") for met in (True, False)
    )
    assert run.codes_of([fast]) == set()
    assert run.codes_of([fast, slow]) == {Exit.SLOWER}
