"""Maps of errors over sizes and places, other shapes, convergence of meshes, and memory."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from hypcheck.bench import accuracy, error_maps
from hypcheck.bench.contenders import contenders
from hypcheck.bench.plan import QUICK, BenchPlan
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.implementations import alternatives
from hypcheck.implementations.builtin import builtin
from hypcheck.implementations.meshes import FCL
from tests.support import inside

PLAN = BenchPlan(quick=True, amounts=replace(QUICK, cell=4, map_lines=15, judged=400, most_triangles=300))


def test_the_stability_map_shows_overflow_of_float32_and_no_error_of_the_fast_method():
    found = {
        name: line for name in ("fast-numpy", "table-2-float32") for line in error_maps.stability_lines((PLAN, name))
    }
    exact = found["fast-numpy"].bins
    assert len(exact) == 400
    assert all(asked == 4 and wrong == 0 for _, _, asked, wrong in exact)
    coarse = {(i, j): wrong / asked for i, j, asked, wrong in found["table-2-float32"].bins}
    assert coarse[0, 3] == 0.0  # α/b of 1 to 3, γ/d of 30 to 100
    assert max(coarse[i, j] for i, j in coarse if i >= 10 and j >= 10) > 0.5  # both beyond 1e5


def test_each_cell_of_the_stability_map_holds_rows_of_its_size_ratios():
    rows, cells = error_maps.stability_rows(PLAN)
    side = error_maps.LAST - error_maps.FIRST + 1
    a, c = rows[:, 0] / rows[:, 2], rows[:, 1] / rows[:, 3]
    assert (np.abs(2 * np.log10(a) - (error_maps.FIRST + cells // side + 0.5)) <= 0.5 + 1e-9).all()
    assert (np.abs(2 * np.log10(c) - (error_maps.FIRST + cells % side + 0.5)) <= 0.5 + 1e-9).all()
    assert set(Counter(inside.positions(rows).tolist())) == {-1, 0, 1}


def test_the_place_maps_show_the_errors_of_float32_on_the_ring():
    whole, ring = error_maps.place_lines((PLAN, "table-2-float32"))
    assert (whole.region, ring.region) == ("whole", "ring")
    for line, columns in ((whole, 29), (ring, 15)):
        assert len(line.wrong) == line.z[2] == 15
        assert {len(text) for text in line.wrong} == {columns} == {line.r[2]}
        assert line.z[0] == -line.z[1]
    assert "w" in ring.wrong[7]  # at z = 0 it calls contact what is clear
    assert set("".join(whole.wrong[:5])) == {"."}


def test_a_place_map_marks_each_kind_of_wrong_answer_with_its_own_letter():
    r, z = error_maps.mapped_regions(PLAN)["whole"]
    rows = error_maps.grid(r, z)
    truth = inside.positions(rows)
    lines = error_maps.letters_of(np.zeros_like(truth), rows, "position", r[2])
    assert "".join(lines).count("w") == np.count_nonzero(truth)
    lines = error_maps.letters_of(np.ones_like(truth), rows, "position", r[2])
    assert "".join(lines).count("c") == np.count_nonzero(truth == 0)
    assert "".join(lines).count("s") == np.count_nonzero(truth == -1)
    assert set("".join(error_maps.letters_of(truth, rows, "position", r[2]))) == {"."}


def test_bounding_shapes_give_false_contacts_where_they_fit_badly_and_no_false_clear():
    lines = list(error_maps.bounding_lines(PLAN))
    assert {(line.shape, line.workload) for line in lines} == {
        (shape, workload) for shape in ("sphere", "cylinder") for workload in ("uniform", "flight")
    }
    for line in lines:
        assert line.false_clear == 0
        assert line.false_contact == sum(row[2] for row in line.overlap)
        assert line.asked == sum(row[1] for row in line.overlap)
    sphere = {row[0]: row for row in lines[0].overlap}
    assert sphere[1.0][2] == 0
    assert sphere[1.0][3] is None
    assert sphere[16.0][2] > sphere[2.0][2] >= 0
    assert sphere[16.0][3] > 0


def test_bounding_line_counts_false_clear_answers_of_a_shape_that_does_not_enclose():
    rows = WORKLOADS["uniform"].rows(1, 300)
    assert (
        error_maps.bounding_line(rows, lambda some: np.ones(len(some), dtype=np.int8), "sphere", "uniform").false_clear
        > 0
    )
    assert error_maps.bounding_line(rows, alternatives.bounding_sphere, "sphere", "uniform").false_clear == 0


@pytest.mark.slow
@pytest.mark.skipif(FCL.trouble() is not None, reason="python-fcl has no wheel here")
def test_convergence_lines_show_fewer_errors_with_more_triangles():
    lines = list(error_maps.convergence_lines(PLAN))
    assert [line.method for line in lines] == ["fcl-point"] * 2 + ["fcl-sphere"] * 2 + ["fcl-ellipsoid"] * 2
    assert len(lines) == error_maps.convergence_steps(PLAN)
    assert lines[1].deviation < lines[0].deviation
    assert lines[1].wrong < lines[0].wrong < lines[0].asked
    assert lines[0].build_ns > 0
    assert lines[0].query_ns > 0


@pytest.mark.slow
def test_memory_lines_report_the_peak_memory_of_one_batch():
    names = ["table-2-float64", "bounding-cylinder"]
    found = {line.method: line for line in accuracy.memory_lines(replace(PLAN, workers=2), names)}
    answers = found["bounding-cylinder"].rows
    assert answers == QUICK.timed
    # The cylinder makes arrays of all rows, Table 2 of a chunk at a time.
    assert found["bounding-cylinder"].peak_bytes > 2 * 8 * answers
    assert found["table-2-float64"].peak_bytes < 100_000_000


def test_the_error_maps_leave_out_methods_too_slow_for_many_rows():
    found = contenders(PLAN)
    assert "table-2-float32" in error_maps.stability_methods(found)
    assert "fast-numpy" in error_maps.stability_methods(found)
    assert not {name for name in error_maps.stability_methods(found) if name.startswith(("mpmath", "fcl", "bounding"))}
    assert {"bounding-sphere", "fcl-point-1000"} & set(error_maps.place_methods(found)) == {
        "bounding-sphere",
        "fcl-point-1000",
    }
    assert not {name for name in error_maps.place_methods(found) if name.endswith("-c")}
    assert builtin("mpmath-roots-15").max_rows is not None
