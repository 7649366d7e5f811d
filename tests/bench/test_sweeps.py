"""Bench about sweeps: its workloads, a small run, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hypcheck.bench.accuracy import WorkloadTruth, workload_truths
from hypcheck.bench.contenders import contenders, foreign_method
from hypcheck.bench.plan import PASSAGE, PASSAGE_REFERENCE, QUICK, BenchPlan
from hypcheck.bench.workloads import listed, scene_of
from hypcheck.errors import InputError
from hypcheck.geometry.rows import SWEEPS, first_trouble
from hypcheck.implementations.builtin import methods
from hypcheck.implementations.sweeps import SWEEP_SOLVERS
from hypcheck.record.fields import as_json
from hypcheck.record.measurements import AccuracyLine, PlacesLine, SpeedLine, WorkloadLine
from hypcheck.vectors.families import SWEEP_FAMILIES
from tests.bench.test_run import FEW, RECORD, ended
from tests.support.inside import size_error
from tests.support.records import violations
from tests.tools.miniatures import NOT_ISOLATED, command

SWEEPS_UPRIGHT, SWEEPS_TILTED = listed(PASSAGE), listed(PASSAGE, tilted=True)


@pytest.mark.parametrize(("workloads", "width"), [(SWEEPS_UPRIGHT, 10), (SWEEPS_TILTED, 13)])
@pytest.mark.parametrize("name", SWEEPS_UPRIGHT)
def test_sweep_workload_rows_are_valid_and_a_short_workload_is_the_beginning_of_a_longer_one(workloads, width, name):
    assert list(workloads) == list(SWEEPS_UPRIGHT)
    rows = workloads[name].rows(3, 240)
    assert rows.shape == (240, width)
    assert first_trouble(rows, layout=SWEEPS) is None
    assert (workloads[name].rows(3, 90) == rows[:90]).all()
    assert workloads[name].rows(3, 0).shape == (0, width)
    assert (scene_of(rows, SWEEPS) is not None) == (name == "tower" and width == 10)


@pytest.mark.parametrize(("tilted", "count"), [(False, 1500), (True, 200)])
def test_the_frozen_sweeps_come_from_all_families_of_their_kind_in_turn(tilted, count):
    families = [family for family in SWEEP_FAMILIES.values() if family.frozen and ("axis" in family.groups) == tilted]
    rows = listed(PASSAGE, tilted=tilted)["frozen"].rows(1, 100_000)
    assert len(rows) > count
    assert len(np.unique(rows[: 4 * len(families)], axis=0)) == 4 * len(families)


def test_bench_of_sweeps_omits_two_methods_in_a_quick_run_and_the_engines_for_tilted_sweeps():
    every = {name for name, method in methods().items() if method.question == PASSAGE}
    found = contenders(BenchPlan(question=PASSAGE))
    assert set(found) == every
    assert next(iter(found)) == PASSAGE_REFERENCE
    quick = contenders(BenchPlan(question=PASSAGE, quick=True, amounts=QUICK))
    assert every - set(quick) == {"passage-advancement", "passage-capsule"}
    assert set(contenders(BenchPlan(question=PASSAGE, tilted=True))) == every - set(SWEEP_SOLVERS)


@pytest.mark.parametrize(("tilted", "workload"), [(False, "grazing"), (True, "tunnelling"), (True, "anywhere")])
def test_the_distance_of_a_judged_sweep_is_near_its_size_error(tilted, workload):
    plan = BenchPlan(question=PASSAGE, tilted=tilted, workloads=(workload,), amounts=replace(QUICK, judged=96))
    (truth,) = workload_truths(plan, None)
    assert isinstance(truth, WorkloadTruth)
    for row, hit, exponent in zip(truth.rows.tolist(), truth.positions.tolist(), truth.exponents, strict=True):
        error = size_error(row, not hit)
        if exponent == -np.inf or error.upper == 0:
            assert error.upper == 0
        elif 2.0**-30 < error.lower < 0.5:
            assert 2.0 ** (exponent - 1) <= error.lower <= 2.0 ** (exponent + 2)


FEWER = replace(FEW, judged=100)


@pytest.fixture(scope="module", params=[(), ("--tilted",)], ids=["upright", "tilted"])
def small(request, tmp_path_factory):
    chosen = ("--methods", "passage-sampled-4", "--workloads", "tower,tunnelling", "--processes", "1", "--rounds", "1")
    return ended(tmp_path_factory.mktemp("sweeps"), "--question", "passage", *request.param, *chosen, amounts=FEWER)


@pytest.mark.slow
def test_bench_of_sweeps_counts_missed_and_false_contacts_and_records_times(small):
    code, record = small
    assert code == 0
    for line in record.lines:
        assert violations(as_json(line), RECORD, closed=True) == []
    assert record.header.options["reference"] == PASSAGE_REFERENCE
    assert not record.header.settings  # the option replaces no declaration
    one_scene = ["tower"] if not record.header.options["tilted"] else []  # a scene has one axis
    assert [(line.workload, line.scene is None) for line in record.of(WorkloadLine)] == [
        (name, name not in one_scene) for name in ("tower", "tunnelling")
    ]
    judged = {(line.method, line.workload): line for line in record.of(AccuracyLine)}
    assert judged[PASSAGE_REFERENCE, "tunnelling"].wrong == 0
    jumping = judged["passage-sampled-4", "tunnelling"]
    assert jumping.false_clear > jumping.asked / 4
    assert jumping.false_contact == jumping.wrong_side == 0
    assert jumping.worst[0].end
    timed = {(line.method, line.mode) for line in record.of(SpeedLine) if line.workload == "tower"}
    assert (PASSAGE_REFERENCE, "single") in timed
    assert ("passage-sampled-4", "batch") in timed
    assert not record.of(PlacesLine)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--kernel",), "--question passage compares methods for sweeps; leave out --kernel"),
        (("--workloads", "uniform"), "there is no workload 'uniform'"),
        (("--methods", "fast-c"), "there is no method 'fast-c'"),
    ],
)
def test_bench_of_sweeps_refuses_methods_and_workloads_that_sweeps_do_not_have(tmp_path, options, message):
    with pytest.raises(InputError, match=message):
        ended(tmp_path, "--question", "passage", *options)


@pytest.mark.slow
def test_bench_takes_a_spec_only_if_it_answers_the_question_of_the_run():
    found = foreign_method(command("passage", "binary"), NOT_ISOLATED, [], layout=SWEEPS)
    assert found.name in contenders(BenchPlan(question=PASSAGE, foreign=(found,)))
    with pytest.raises(InputError, match="answers the question passage; it is measured with --question passage"):
        foreign_method(command("passage", "binary"), NOT_ISOLATED, [])
    with pytest.raises(InputError, match="answers the question position; it is measured without --question passage"):
        foreign_method(command("right", "binary"), NOT_ISOLATED, [], layout=SWEEPS)
