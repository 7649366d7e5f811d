"""The methods in C give the same answers as the same programs in numpy, to the bit."""

from __future__ import annotations

import json
import os
import stat

import numpy as np
import pytest

from hypcheck.bench import c_library
from hypcheck.bench.c_library import FLAGS, compiled
from hypcheck.bench.contenders import contenders
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.run import plan_with_needs
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.errors import UnavailableError
from hypcheck.record import Recorder
from hypcheck.vectors.families import FAMILIES, select
from tests.support.records import GrowingText

TIMED_ALONE = ("table-2-reciprocal-float64", "procedure-1-repaired-float64")
"""Compiled for the claims about costs, and compared with numpy there (test_claims.py)."""

NAMES = [f"{body.name}-c" for body in c_library.bodies() if body.name not in TIMED_ALONE]
NUMPY = {"fast-c": "fast-numpy"}


@pytest.fixture(scope="session")
def library(tmp_path_factory):
    return compiled(tmp_path_factory.mktemp("c"))[0]


@pytest.fixture(scope="module")
def methods(library):
    return contenders(BenchPlan(compiled=library))


@pytest.fixture(scope="module")
def rows():
    return np.concatenate([family.rows(9, 120) for family in select(("*", "extreme"))])


@pytest.mark.parametrize("name", [name for name in NAMES if not name.startswith("trigonometric")])
def test_a_method_in_c_answers_as_the_same_method_in_numpy(name, methods, rows):
    assert (
        methods[name].load().answer(rows) == methods[NUMPY.get(name, name.removesuffix("-c"))].load().answer(rows)
    ).all()


@pytest.mark.parametrize("name", ["trigonometric-float32-c", "trigonometric-float64-c"])
def test_cosine_methods_in_c_and_in_numpy_answer_alike_on_the_tower(name, methods):
    tower = FAMILIES["tower-body"].rows(2, 2000)
    assert (methods[name].load().answer(tower) == methods[name.removesuffix("-c")].load().answer(tower)).all()


@pytest.mark.parametrize("name", NAMES)
def test_a_method_in_c_gives_the_same_answers_by_scene_by_rows_and_row_by_row(name, methods):
    way = methods[name].load()
    tower = FAMILIES["tower-body"].rows(2, 700)
    right = way.answer(tower)
    batch, single = way.batch(tower), way.single(tower[:64])
    assert (batch.answers() == right).all()
    assert (single.answers() == right[:64]).all()
    assert batch.run(3)[1] == right.sum(dtype=int)
    assert single.run(2)[1] == right[:64].sum(dtype=int)
    mixed = WORKLOADS["near-contact"].rows(1, 300)
    assert (way.batch(mixed).answers() == way.answer(mixed)).all()


def test_the_empty_call_of_a_method_in_c_has_the_checksum_0(methods, rows):
    for mode in ("batch", "single"):
        empty = methods[NAMES[0]].load().empty(rows, mode)
        assert empty.name == "C"
        assert empty.ready.run(5)[1] == 0


def test_compiler_flags_do_not_change_the_answers_of_methods_in_c():
    assert "-ffp-contract=off" in FLAGS
    assert not {flag for flag in FLAGS if "fast" in flag or "unsafe" in flag or flag == "-Ofast"}


def test_a_missing_c_compiler_is_reported_in_one_sentence(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    with pytest.raises(UnavailableError, match="no C compiler is found"):
        compiled(tmp_path)


def test_an_error_of_the_compiler_is_quoted_in_the_message(tmp_path, monkeypatch):
    broken = tmp_path / "broken-cc"
    broken.write_text("#!/bin/sh\necho 'no space left for code' >&2\nexit 1\n", encoding="ascii")
    broken.chmod(broken.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("CC", str(broken))
    monkeypatch.setenv("PATH", os.pathsep.join([str(tmp_path), os.environ["PATH"]]))
    with pytest.raises(UnavailableError, match="no space left for code"):
        compiled(tmp_path)


def test_bench_without_a_c_compiler_keeps_the_other_methods_and_records_what_is_missing(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    stream = GrowingText()
    plan, recorder = BenchPlan(methods=("table-2-float64*",), folder=tmp_path), Recorder(stream, {})
    found = plan_with_needs(plan_with_needs(plan, recorder), recorder)
    assert list(contenders(found)) == ["table-2-float64"]
    (absent,) = map(json.loads, stream.text.splitlines()[1:])
    assert (absent["type"], absent["what"]) == ("absent", "C compiler")
    assert "no C compiler is found" in absent["reason"]
