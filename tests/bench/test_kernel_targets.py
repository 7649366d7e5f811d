"""The targets of the kernels: each is measured and recorded, against baselines that answer rightly."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import hypcheck
from hypcheck.bench import call_targets, targets, yardsticks
from hypcheck.bench.c_library import LEVEL_FLAGS, TOWER_SIZES, WORDS, c_baselines
from hypcheck.bench.yardsticks import KernelTarget, Measuring, target, touching_columns, tower_rows, uniform_columns
from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import tilted_rows
from hypcheck.implementations.alternatives import by_eigenvectors
from hypcheck.record import SCHEMA
from hypcheck.record.fields import as_json
from hypcheck.record.measurements import AbsentLine, KernelLine
from hypcheck.runs.timing import Samples
from tests.support.inside import LEVELS, choice, clearances, nearest
from tests.support.records import violations

PUBLISHED = Path(hypcheck.__file__).parent / "report" / "schemas" / f"record-{SCHEMA}.json"
COMPILER = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")


class Recorder:
    """Keeps the lines."""

    def __init__(self):
        self.lines = []

    def add(self, line):
        """As Recorder.add."""
        self.lines.append(line)


@pytest.fixture
def small(monkeypatch):
    """The same measurements of far fewer rows: what they find is of no interest here."""
    for module, sizes in (
        (targets, {"MANY": 4096, "CACHED": 2048, "FEW": 64, "WORST": 64, "REPEATED": 2}),
        (targets, {"PART": 1024, "PARTS": 2, "LEAST_PARTS": 2, "AGAIN": 0}),
        (targets, {"PACED": 200, "ORDINARY": 40, "NEAR": 20, "QUICK_STREAM": 10_240}),
        (call_targets, {"MILLION": 4096, "EACH_AXIS": 256, "ONE_BY_ONE": 3, "TRIANGLES": 60}),
        (call_targets, {"MOST": 10_000, "CALLS": 20, "BATCHES": (1000,)}),
        (yardsticks, {"EACH": 4, "TURNS": 1, "NEIGHBOURS": 1, "QUICK_ROUNDS": 2}),
    ):
        for name, value in sizes.items():
            monkeypatch.setattr(module, name, value)


def test_targets_for_rows_near_contact_state_the_bits_of_the_multiplied_integers():
    for name in ("near contact", "near contact, tilted"):
        assert target(name).text.endswith(f"in products of integers of {32 * WORDS} bits")
        assert target(name).at_most


@COMPILER
def test_every_kernel_target_has_a_line_that_fits_the_record_schema(small):
    pytest.importorskip("hypcheck.kernel._compiled")
    recorder, advanced = Recorder(), []
    targets.run(recorder, advanced.append, quick=True)
    assert sum(advanced) == targets.steps()
    found = [line for line in recorder.lines if isinstance(line, KernelLine)]
    names = [line.name for line in found]
    assert len(set(names)) == len(names) == 66
    definition = json.loads(PUBLISHED.read_text(encoding="utf-8"))
    for line in found:
        assert not violations(as_json(line), definition, closed=True)
        assert line.ci95[0] <= line.measured <= line.ci95[1]


def test_kernel_targets_that_need_no_compiler_are_measured_without_one(small, monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    recorder = Recorder()
    targets.run(recorder, lambda _: None, quick=True)
    said = {line.what for line in recorder.lines if isinstance(line, AbsentLine)}
    if choice().kernel == "compiled":
        assert "C compiler" in said
    monkeypatch.setenv("HYPCHECK_KERNEL", "numpy")
    choice.cache_clear()
    try:
        recorder = Recorder()
        targets.run(recorder, lambda _: None, quick=True)
    finally:
        monkeypatch.delenv("HYPCHECK_KERNEL")
        choice.cache_clear()
    names = {line.name for line in recorder.lines if isinstance(line, KernelLine)}
    assert names >= {"fallback, powers", "fallback, products", "one pair, plain Python"}
    assert "memory speed" not in names
    assert "compiled kernel" in {line.what for line in recorder.lines if isinstance(line, AbsentLine)}


def test_the_numpy_baseline_with_eigh_answers_as_the_kernel_away_from_contact():
    rows = tilted_rows(TOWER_SIZES, uniform_columns(3000), (*yardsticks.axes(3000).T,))
    found = hypcheck.classify(rows)
    assert (by_eigenvectors(rows, 30) == found).all()
    assert {-1, 0, 1} == set(found.tolist())


def test_touching_rows_of_the_tilted_targets_are_within_4e_14_of_contact():
    rows = yardsticks.touching_rows(40)
    clearance = [nearest(Pair.from_row(row)).clearance for row in rows.tolist()]
    assert 0 < max(map(abs, clearance)) < 4e-14


def test_target_of_undecided_rows_beside_ends_is_missed_with_a_count_for_each_family(monkeypatch):
    """One row in two of one family is open: its share is the target's, and the sentence names it."""
    pytest.importorskip("hypcheck.kernel._compiled")
    monkeypatch.setattr(targets, "ORDINARY", 10)
    monkeypatch.setattr(targets, "NEAR", 10)
    asked = targets.answer_sweeps
    monkeypatch.setattr(targets, "answer_sweeps", lambda rows: (np.resize([2, 0], len(rows)), asked(rows)[1]))
    ordinary, near = targets.left_open(Measuring(Path(), quick=True))
    assert (ordinary.measured, near.measured, ordinary.met, near.met) == (0.5, 0.5, False, False)
    assert "ended-way-uniform 5" in ordinary.says
    assert "ended-way-touch 5" in near.says
    assert "ended-rim" not in near.says


def test_a_kernel_target_is_missed_only_if_the_whole_interval_misses_it():
    least, most = KernelTarget("speed", "", 2.0), KernelTarget("time", "", 2.0, at_most=True)
    for rounds, fast, slow in (
        ([3.0, 3.1, 3.2], True, False),
        ([1.0, 1.1, 1.2], False, True),
        ([1.0, 3.0], True, True),
    ):
        assert [least.line(rounds, "").met, most.line(rounds, "").met] == [fast, slow]
    assert least.line([2.0], "says").measured == 2.0


def test_a_missed_target_is_measured_again_and_passes_if_the_miss_was_by_chance():
    target, other = KernelTarget("speed", "", 2.0), KernelTarget("more speed", "", 2.0)
    found = iter([1.0, 3.0, 1.5, 1.0, 2.5, 1.0])

    def group():
        return [target.line([next(found)], ""), other.line([next(found)], "")]

    lines = targets.confirmed_lines(group)
    assert [(line.measured, line.met) for line in lines] == [(2.5, True), (3.0, True)]

    def slow():
        calls.append(1)
        return [target.line([1.0], "")]

    calls = []
    assert [line.met for line in targets.confirmed_lines(slow)] == [False]
    assert len(calls) == 1 + targets.AGAIN


def test_kernel_targets_that_are_all_met_are_measured_once():
    target, calls = KernelTarget("speed", "", 2.0), []

    def fast():
        calls.append(1)
        return [target.line([3.0], "")]

    assert [line.met for line in targets.confirmed_lines(fast)] == [True]
    assert len(calls) == 1


def test_the_time_of_reading_the_columns_limits_the_speed_ratio_that_a_numpy_target_demands():
    target = call_targets.numpy_targets()[0]
    found = {
        name: Samples(name, 1, 1, 0, samples_ns=[time])
        for name, time in (("kernel", 1.0), ("reading", 0.9), ("products", 40.0))
    }
    assert target.line("products", found, "").measured == 40 / 30
    found["products"].samples_ns = [20.0]
    assert target.line("products", found, "").measured == pytest.approx(20 / (0.75 * 20 / 0.9))


def test_large_pages_reports_the_setting_of_the_operating_system(tmp_path):
    for said, words in (
        ("always [madvise] never\n", "where asked for"),
        ("[always] never", "always"),
        ("?", "not reported"),
    ):
        (tmp_path / "enabled").write_text(said, encoding="ascii")
        assert words in call_targets.large_pages(tmp_path / "enabled")
    assert "not reported" in call_targets.large_pages(tmp_path / "none")


def test_the_plain_python_baseline_answers_as_table_2_in_numpy():
    columns = uniform_columns(2000)
    rows = zip(*(column.tolist() for column in columns), strict=True)
    expected = call_targets.with_products(TOWER_SIZES, *columns)
    assert [call_targets.textbook(*TOWER_SIZES, *row) for row in rows] == expected.tolist()


@COMPILER
@pytest.mark.parametrize("level", LEVELS)
def test_the_plain_c_baseline_answers_as_the_kernel_on_uniform_rows(level, tmp_path):
    """On these rows it is never wrong, so a faster wrong answer cannot stand for it."""
    if level in ("avx512", "avx2") and choice().level not in (level, "avx512"):
        pytest.skip(f"this machine has no {level}")
    columns = uniform_columns(5000)
    exterior = hypcheck.classify_scene(TOWER_SIZES, *columns, question="exterior")
    found = c_baselines(tmp_path, level)
    assert len(found) == len(LEVEL_FLAGS[level])
    for each in found:
        out = np.full(5000, 9, np.int8)
        took, checksum = each.plain(columns, out)(2)
        assert (out == exterior).all()
        assert checksum == int(exterior.sum())
        mixed = np.bitwise_xor.reduce(np.concatenate(columns).view(np.uint64))
        assert each.read(columns)(1)[1] == int(mixed) & 0xFFFF
        assert took > 0


@COMPILER
def test_the_loop_in_which_bench_times_the_kernel_writes_right_answers(tmp_path):
    pytest.importorskip("hypcheck.kernel._compiled")
    columns, out = uniform_columns(5000), np.full(5000, 9, np.int8)
    library = c_baselines(tmp_path, "plain")[0]
    library.of_scene(columns, out)(3)
    expected = hypcheck.classify_scene(TOWER_SIZES, *columns)
    assert (out == expected).all()
    rows = tower_rows(columns)
    out.fill(9)
    library.of_rows(rows, out)(3)
    assert (out == expected).all()
    library.reading(columns)(2)
    assert library.product()(1000)[0] > 20 * WORDS  # no compiler leaves the work out


def test_the_numpy_baselines_answer_as_the_kernel_on_uniform_rows():
    columns = uniform_columns(5000)
    exterior = hypcheck.classify_scene(TOWER_SIZES, *columns, question="exterior")
    for expression in (call_targets.with_powers, call_targets.with_products):
        assert (expression(TOWER_SIZES, *columns) == exterior).all()


def test_touching_rows_of_the_upright_targets_are_within_1e_14_of_contact():
    rows = tower_rows(touching_columns(400))
    found = np.abs(clearances(rows).clearance)
    assert np.median(found) < 1e-15
    assert found.max() < 1e-14


def test_uniform_columns_repeat_their_rows_in_a_long_array():
    x, y, z = yardsticks.uniform_columns(yardsticks.DISTINCT + 3)
    assert len(x) == len(y) == len(z) == yardsticks.DISTINCT + 3
    assert x[-3:].tolist() == x[:3].tolist()
