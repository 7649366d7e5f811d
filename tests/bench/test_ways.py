"""Bench about ways: its workloads, a small run, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hypcheck.bench import foreign
from hypcheck.bench.accuracy import WorkloadTruth, workload_truths
from hypcheck.bench.contenders import contenders
from hypcheck.bench.plan import PASSAGE, PASSAGE_REFERENCE, QUICK, BenchPlan
from hypcheck.bench.workloads import WAY_WORKLOADS, frozen_ways, scene_of
from hypcheck.errors import InputError
from hypcheck.geometry.rows import SWEEPS, first_trouble
from hypcheck.implementations.builtin import passage_methods
from hypcheck.implementations.sweeps import SWEEP_SOLVERS
from hypcheck.record.fields import as_json
from hypcheck.record.measurements import AccuracyLine, PlacesLine, SpeedLine, WorkloadLine
from hypcheck.vectors.families import SWEEP_FAMILIES
from tests.bench.test_run import RECORD, ended
from tests.support.inside import size_error
from tests.support.records import violations
from tests.support.without_drawing import draw_nothing
from tests.tools.miniatures import NOT_ISOLATED, command


@pytest.mark.parametrize("name", WAY_WORKLOADS)
def test_way_workload_rows_are_valid_and_fewer_rows_are_the_first_of_more(name):
    rows = WAY_WORKLOADS[name].rows(3, 300)
    assert rows.shape == (300, 10)
    assert first_trouble(rows, layout=SWEEPS) is None
    assert (WAY_WORKLOADS[name].rows(3, 90) == rows[:90]).all()
    assert WAY_WORKLOADS[name].rows(3, 0).shape == (0, 10)
    assert (scene_of(rows, SWEEPS) is not None) == (name == "tower")


def test_the_frozen_ways_come_from_all_families_of_upright_spheroids_in_turn():
    upright = [family for family in SWEEP_FAMILIES.values() if not family.tilted]
    rows = frozen_ways()
    assert len(rows) > 1500
    assert len(np.unique(rows[: 4 * len(upright)], axis=0)) == 4 * len(upright)


def test_bench_compares_all_built_in_methods_for_ways_but_two_in_a_quick_run():
    every = {*passage_methods(), *SWEEP_SOLVERS}
    found = contenders(BenchPlan(question=PASSAGE))
    assert set(found) == every
    assert next(iter(found)) == PASSAGE_REFERENCE
    quick = contenders(BenchPlan(question=PASSAGE, quick=True, amounts=QUICK))
    assert every - set(quick) == {"passage-advancement", "passage-capsule"}


def test_the_distance_of_a_judged_way_is_near_its_size_error():
    plan = BenchPlan(question=PASSAGE, workloads=("grazing",), amounts=replace(QUICK, judged=144))
    (truth,) = workload_truths(plan, None)
    assert isinstance(truth, WorkloadTruth)
    for row, hit, exponent in zip(truth.rows.tolist(), truth.positions.tolist(), truth.exponents, strict=True):
        error = size_error(row, not hit)
        if exponent == -np.inf or error.upper == 0:
            assert error.upper == 0
        elif 2.0**-30 < error.lower < 0.5:
            assert 2.0 ** (exponent - 1) <= error.lower <= 2.0 ** (exponent + 2)


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    chosen = ("--methods", "passage-sampled-4", "--workloads", "tower,tunnelling", "--processes", "1", "--rounds", "1")
    with pytest.MonkeyPatch.context() as patch:
        draw_nothing(patch)
        return ended(tmp_path_factory.mktemp("ways"), "--question", "passage", *chosen)


@pytest.mark.slow
def test_bench_of_ways_counts_missed_and_false_contacts_and_records_times(small):
    code, record = small
    assert code == 0
    for line in record.lines:
        assert violations(as_json(line), RECORD, closed=True) == []
    assert record.header.options["reference"] == PASSAGE_REFERENCE
    assert not record.header.settings  # the option replaces no declaration
    assert [(line.workload, line.scene is None) for line in record.of(WorkloadLine)] == [
        ("tower", False),
        ("tunnelling", True),
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
        (("--tilted",), "--question passage compares methods for sweeps of upright spheroids; leave out --tilted"),
        (("--kernel",), "leave out --kernel"),
        (("--workloads", "uniform"), "there is no workload 'uniform'"),
        (("--methods", "fast-c"), "there is no method 'fast-c'"),
    ],
)
def test_bench_of_ways_refuses_methods_and_workloads_that_ways_do_not_have(tmp_path, options, message):
    with pytest.raises(InputError, match=message):
        ended(tmp_path, "--question", "passage", *options)


@pytest.mark.slow
def test_bench_takes_a_spec_only_if_it_answers_the_question_of_the_run():
    found = foreign.foreign_method(command("passage", "binary"), NOT_ISOLATED, [], layout=SWEEPS)
    assert found.name in contenders(BenchPlan(question=PASSAGE, foreign=(found,)))
    with pytest.raises(InputError, match="answers the question passage; it is measured with --question passage"):
        foreign.foreign_method(command("passage", "binary"), NOT_ISOLATED, [])
    with pytest.raises(InputError, match="answers the question position; it is measured without --question passage"):
        foreign.foreign_method(command("right", "binary"), NOT_ISOLATED, [], layout=SWEEPS)
