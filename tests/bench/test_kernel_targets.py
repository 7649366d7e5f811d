"""The kernels' targets: every one is measured and said, against baselines that answer as they should."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import hypcheck
from hypcheck.bench import kernel
from hypcheck.bench.kernel import compiled, expressions, python, targets
from hypcheck.bench.kernel.baselines import LEVEL_FLAGS, baselines
from hypcheck.bench.kernel.rows import SIZES, touching, uniform
from hypcheck.bench.kernel.target import Target
from hypcheck.errors import UnavailableError
from hypcheck.kernel.choice import LEVELS, choice
from hypcheck.record import SCHEMA
from hypcheck.record.fields import as_json
from hypcheck.record.measurements import Absent, Kernel
from hypcheck.truth.nearest import clearances
from tests.schemas import violations

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
        (compiled, {"MANY": 4096, "CACHED": 2048, "WORST": 64, "AGAIN": 2, "PART": 1024, "PARTS": 2, "LEAST_PARTS": 2}),
        (python, {"MANY": 20_000, "CALLS": 20, "FEW": 3, "TRIANGLES": 60}),
        (targets, {"QUICK_ROUNDS": 2, "QUICK_STREAM": 10_240}),
    ):
        for name, value in sizes.items():
            monkeypatch.setattr(module, name, value)


@COMPILER
def test_every_target_has_a_line_of_the_record_s_schema(small):
    pytest.importorskip("hypcheck.kernel._compiled")
    recorder, advanced = Recorder(), []
    kernel.run(recorder, advanced.append, quick=True)
    assert sum(advanced) == kernel.steps()
    found = [line for line in recorder.lines if isinstance(line, Kernel)]
    names = [line.name for line in found]
    assert len(set(names)) == len(names) == 15
    definition = json.loads(PUBLISHED.read_text(encoding="utf-8"))
    for line in found:
        assert not violations(as_json(line), definition, closed=True)
        assert line.ci95[0] <= line.measured <= line.ci95[1]


def test_without_a_compiler_or_a_compiled_kernel_the_rest_is_measured(small, monkeypatch):
    def missing(*_arguments):
        raise UnavailableError("no C compiler is found")

    monkeypatch.setattr(compiled, "baselines", missing)
    recorder = Recorder()
    kernel.run(recorder, lambda _: None, quick=True)
    said = {line.what for line in recorder.lines if isinstance(line, Absent)}
    if choice().kernel == "compiled":
        assert "C compiler" in said
    monkeypatch.setenv("HYPCHECK_KERNEL", "numpy")
    choice.cache_clear()
    try:
        recorder = Recorder()
        kernel.run(recorder, lambda _: None, quick=True)
    finally:
        monkeypatch.delenv("HYPCHECK_KERNEL")
        choice.cache_clear()
    names = {line.name for line in recorder.lines if isinstance(line, Kernel)}
    assert names >= {"fallback, powers", "fallback, products", "one pair, plain Python"}
    assert "memory speed" not in names
    assert "compiled kernel" in {line.what for line in recorder.lines if isinstance(line, Absent)}


def test_a_target_is_met_by_the_median():
    least, most = Target("speed", "", 2.0), Target("time", "", 2.0, at_most=True)
    assert [least.line([1.0, 3.0, 4.0], "").met, most.line([1.0, 3.0, 4.0], "").met] == [True, False]
    assert least.line([2.0], "says").measured == 2.0


@COMPILER
@pytest.mark.parametrize("level", LEVELS)
def test_the_plain_formula_in_c_does_its_work(level, tmp_path):
    """On these rows it is never wrong, so a faster wrong answer cannot stand for it."""
    if level in ("avx512", "avx2") and choice().level not in (level, "avx512"):
        pytest.skip(f"this machine has no {level}")
    columns = uniform(5000)
    exterior = hypcheck.classify_scene(SIZES, *columns, question="exterior")
    found = baselines(tmp_path, level)
    assert len(found) == len(LEVEL_FLAGS[level])
    for each in found:
        out = np.full(5000, 9, np.int8)
        took, checksum = each.plain(np.array(SIZES), *columns, out)(2)
        assert (out == exterior).all()
        assert checksum == int(exterior.sum())
        mixed = np.bitwise_xor.reduce(np.concatenate(columns).view(np.uint64))
        assert each.read_only(*columns)(1)[1] == int(mixed) & 0xFFFF
        assert took > 0
        assert each.read_by_the_clock(*columns, threads=1)(1)[1] == int(mixed) & 0xFFFF


@COMPILER
def test_the_kernel_over_and_over_answers_its_rows(tmp_path):
    pytest.importorskip("hypcheck.kernel._compiled")
    columns, out = uniform(5000), np.full(5000, 9, np.int8)
    baselines(tmp_path, "plain")[0].over_and_over(np.array(SIZES), *columns, out, times=3)
    assert (out == hypcheck.classify_scene(SIZES, *columns)).all()


def test_the_numpy_expressions_do_their_work():
    columns = uniform(5000)
    exterior = hypcheck.classify_scene(SIZES, *columns, question="exterior")
    for expression in (expressions.with_powers, expressions.with_products):
        assert (expression(SIZES, *columns) == exterior).all()


def test_rows_said_to_touch_are_within_1e_15_of_contact():
    rows = np.column_stack([*(np.full(400, size) for size in SIZES), *touching(400)])
    found = np.abs(clearances(rows).clearance)
    assert np.median(found) < 1e-15
    assert found.max() < 1e-14


def test_a_long_array_repeats_the_rows_of_the_workload():
    from hypcheck.bench.kernel import rows

    x, y, z = rows.uniform(rows.DISTINCT + 3)
    assert len(x) == len(y) == len(z) == rows.DISTINCT + 3
    assert x[-3:].tolist() == x[:3].tolist()
